//! Import of robots of the GRAB laboratory, University of Bologna: JSON with pulleys, winches and platform.
//!
//! # References
//! The keys have the meaning that the laboratory's programs give them (github.com/IRMA-LAB: cdpr_matlab, cable_robot):
//! E. Idà, T. Bruckmann, M. Carricato, Rest-to-rest trajectory planning for underactuated cable-driven parallel robots,
//! IEEE Transactions on Robotics 35, 2019.

use super::draft::{Draft, DraftCable, DraftMotion, DraftPlatform, DraftPulley, DraftRope, DraftState, listed};
use super::tree::{Place, Tree};
use anyhow::{Result, bail};
use funicular::math::Vec3;
use funicular_study::request::SourceFile;
use funicular_study::text::clean;

/// Acceleration of gravity in the laboratory's programs [m/s²]; the file gives its direction.
const GRAVITY: f64 = 9.80665;

/// Names of the keys in the two layouts of the file: of 2019 and later, and before.
struct GrabLayout {
    /// List of the cables.
    cables: &'static str,
    /// Tables within a cable that hold the numbers of the frame and of the platform's side, if there are such tables.
    parts: Option<[&'static str; 2]>,
    anchor: &'static str,
    attachment: &'static str,
    radius: &'static str,
    center: &'static str,
    moment: &'static str,
}

const LAYOUTS: [GrabLayout; 2] = [
    GrabLayout {
        cables: "actuator",
        parts: Some(["pulley", "winch"]),
        anchor: "pos_OD_glob",
        attachment: "pos_PA_loc",
        radius: "radius",
        center: "pos_PG_loc",
        moment: "ext_torque_loc",
    },
    GrabLayout {
        cables: "cable",
        parts: None,
        anchor: "pos_D_glob",
        attachment: "pos_A_loc",
        radius: "swivel_pulley_r",
        center: "pos_G_loc",
        moment: "ext_moments_loc",
    },
];

/// True for the tree of such a file.
pub(crate) fn is_robot(tree: &Tree) -> bool {
    LAYOUTS.iter().any(|layout| tree.has(&["platform", layout.cables]))
}

/// Reads the robot of a file.
///
/// # Errors
/// The line, the key and the value at fault; or the feature of the robot that a robot file cannot hold.
pub(crate) fn read(file: &SourceFile, tree: &Tree) -> Result<Draft> {
    let root = Place::of(file, tree);
    let [new, old] = &LAYOUTS;
    let layout = if tree.has(&[new.cables]) { new } else { old };
    let platform = root.required("platform")?;
    let mut lost = Vec::new();
    let mut notes = vec!["The file has no pose: give ⟪pose⟫ to import or to an analysis".to_owned()];
    let mut assumed = Vec::new();

    refuse_motion(&root)?;
    let axis = platform.optional("gravity_axis")?;
    let up = axis.as_ref().map(Place::vector).transpose()?.unwrap_or_else(Vec3::z);
    let Some(up) = up.try_normalize(0.0) else {
        bail!(platform.error("`platform.gravity_axis` has no length"));
    };
    if axis.is_none() {
        assumed.push("that gravity is along -z: the file does not give its axis".to_owned());
    }
    let gravity_w = -up * GRAVITY;
    notes.push(format!("Gravity {GRAVITY} m/s², as in the laboratory's programs"));

    for (key, what) in [("ext_force_loc", "force"), (layout.moment, "moment")] {
        let given = platform.optional(key)?.map(|load| load.vector()).transpose()?;
        if let Some(load) = given.filter(|load| *load != Vec3::zeros()) {
            let [x, y, z] = load.into();
            lost.push(format!("`{key}` ({x}, {y}, {z}), a {what} that turns with the platform"));
        }
    }

    let cables = cables(&root, layout, &mut lost)?;
    Ok(Draft {
        name: file.stem(),
        source: format!("GRAB, University of Bologna, {}", file.name()),
        gravity_w,
        platform: DraftPlatform {
            mass: platform.optional_number("mass")?.filter(|mass| *mass > 0.0),
            inertia_p: platform.optional("inertia_mat_G_loc")?.map(|inertia| inertia.matrix()).transpose()?,
            center_of_mass_p: platform.optional(layout.center)?.map(|center| center.vector()).transpose()?,
            motion: DraftMotion::Rigid,
            place: platform.place(),
        },
        cables,
        state: DraftState::Unknown,
        payload: None,
        notes,
        assumed,
        lost,
    })
}

/// Refuses motion patterns other than that of a rigid platform.
fn refuse_motion(root: &Place) -> Result<()> {
    let Some(pattern) = root.optional("motion_pattern")? else { return Ok(()) };
    match pattern.text()? {
        "THREE_R_THREE_T" | "3R3T" => Ok(()),
        other => bail!(pattern.error(format!(
            "`motion_pattern` is `{}`; only THREE_R_THREE_T, the rigid platform, is read",
            clean(other)
        ))),
    }
}

/// Cables whose actuator is active.
fn cables(root: &Place, layout: &GrabLayout, lost: &mut Vec<String>) -> Result<Vec<DraftCable>> {
    let list = root.required(layout.cables)?;
    let mut cables = Vec::new();
    let mut inactive = Vec::new();
    let mut ratios = false;
    for (i, item) in list.items()?.iter().enumerate() {
        let name = (i + 1).to_string();
        if !item.optional("active")?.map_or(Ok(true), |active| active.truth())? {
            inactive.push(name);
            continue;
        }

        let [frame, end] = match layout.parts {
            Some([frame, end]) => [item.required(frame)?, item.required(end)?],
            None => [item.clone(), item.clone()],
        };
        for (part, key) in [(&frame, "transmission_ratio"), (&end, "transmission_ratio"), (&end, "motor_cable_tau")] {
            ratios |= part.optional(key)?.is_some();
        }
        cables.push(DraftCable {
            name,
            anchor_w: frame.required(layout.anchor)?.vector()?,
            attachment_p: end.required(layout.attachment)?.vector()?,
            rope: DraftRope::default(),
            limits: [None, None],
            unstrained_length: None,
            pulley: pulley(&frame, layout)?,
            winch: None,
        });
    }

    if cables.is_empty() {
        bail!(list.error(format!("`{}` has no active cable", layout.cables)));
    }
    if !inactive.is_empty() {
        lost.push(format!("actuators {}, which are not active", listed(&inactive)));
    }
    if ratios {
        lost.push("ratios of the encoders, which are numbers of the controller".to_owned());
    }
    Ok(cables)
}

/// Swivelling pulley of a cable; `None` for a radius of zero. The cable enters along the swivel axis `vers_k`.
fn pulley(frame: &Place, layout: &GrabLayout) -> Result<Option<DraftPulley>> {
    let Some(radius) = frame.optional_number(layout.radius)?.filter(|radius| *radius != 0.0) else { return Ok(None) };
    if radius < 0.0 {
        bail!(frame.error(format!("`{}` is {radius} m, it must be positive", layout.radius)));
    }
    let axis = frame.required("vers_k")?;
    let entry_direction_w = axis.vector()?;
    if entry_direction_w == Vec3::zeros() {
        bail!(axis.error("the swivel axis `vers_k` has no length"));
    }
    Ok(Some(DraftPulley { radius, entry_direction_w }))
}
