//! Import of the YAML of `cdpr`, a simulator of cable robots in Gazebo.
//!
//! # References
//! The keys have the meaning that the program gives them (github.com/oKermorgant/cdpr): F. Boutin et al., École
//! Centrale de Nantes; SDFormat specification, <http://sdformat.org/spec>, for the angles and for Gazebo's gravity.

use super::draft::{Draft, DraftCable, DraftMotion, DraftPlatform, DraftRope, DraftState};
use super::tree::{Place, Tree};
use anyhow::{Result, bail};
use funicular::math::{Mat3, Rotation, Vec3};
use funicular::robot::Pose;
use funicular_study::request::SourceFile;

/// Gravity of Gazebo's worlds unless they give another [m/s²].
pub(super) const GRAVITY: Vec3 = Vec3::new(0.0, 0.0, -9.8);

/// True for the tree of such a file.
pub(crate) fn is_robot(tree: &Tree) -> bool {
    tree.has(&["points"])
}

/// Reads the robot of a file.
///
/// # Errors
/// The line, the key and the value at fault.
pub(crate) fn read(file: &SourceFile, tree: &Tree) -> Result<Draft> {
    let root = Place::of(file, tree);
    let body = root.required("platform")?;
    let mut lost = Vec::new();
    let mut assumed = Vec::new();
    let inertia_p = body.optional("inertia")?.map(|inertia| tensor(&inertia)).transpose()?;
    if inertia_p.is_some_and(|tensor| tensor != Mat3::from_diagonal(&tensor.diagonal())) {
        assumed.push("that the products in `platform.inertia` are those of xy, xz and yz, in this order".to_owned());
    }

    let cables = cables(&root)?;
    if let Some(cable) = root.optional("cable")? {
        for (key, what) in [
            ("mass", "kg, the mass of a link that stands for a cable in Gazebo"),
            ("radius", "m, with which cables are drawn"),
        ] {
            if let Some(value) = cable.optional_number(key)? {
                lost.push(format!("`cable.{key}` {value} {what}"));
            }
        }
    }
    if let Some(joints) = root.optional("joints")? {
        for key in ["actuated", "passive"] {
            if joints.optional(key)?.is_some() {
                let limits = if key == "actuated" { ", except `effort` and `min`" } else { "" };
                lost.push(format!("`joints.{key}`: damping and limits of joints of Gazebo{limits}"));
            }
        }
    }
    if root.optional("frame")?.is_some() {
        lost.push("`frame`, which is drawn".to_owned());
    }

    Ok(Draft {
        name: file.stem(),
        source: format!("cdpr for Gazebo, {}", file.name()),
        gravity_w: GRAVITY,
        platform: DraftPlatform {
            mass: body.optional_number("mass")?.filter(|mass| *mass > 0.0),
            inertia_p,
            // The program makes a link without a pose of its inertia.
            center_of_mass_p: Some(Vec3::zeros()),
            motion: DraftMotion::Rigid,
            place: body.place(),
        },
        cables,
        state: pose(&body)?.map_or(DraftState::Unknown, DraftState::Pose),
        payload: None,
        notes: vec![
            "Centre of mass: at the origin of the platform, as in Gazebo. Gravity 9.8 m/s² along -z, Gazebo's own"
                .to_owned(),
        ],
        assumed,
        lost,
    })
}

/// Position and angles of the platform; R = Rz Ry Rx, as in a robot file.
fn pose(body: &Place) -> Result<Option<Pose>> {
    let Some(given) = body.optional("position")? else { return Ok(None) };
    let angles = given.optional("rpy")?.map(|rpy| rpy.vector()).transpose()?.unwrap_or_default();
    Ok(Some(Pose {
        position_w: given.required("xyz")?.vector()?,
        rot_wp: Rotation::from_euler_angles(angles.x, angles.y, angles.z),
    }))
}

/// Inertia tensor of the moments and, after them, the products xy, xz and yz.
fn tensor(inertia: &Place) -> Result<Mat3> {
    match inertia.numbers()?[..] {
        [xx, yy, zz] => Ok(Mat3::from_diagonal(&Vec3::new(xx, yy, zz))),
        [xx, yy, zz, xy, xz, yz] => Ok(Mat3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)),
        _ => bail!(inertia.error("`platform.inertia` must hold three moments, or three moments and three products")),
    }
}

fn cables(root: &Place) -> Result<Vec<DraftCable>> {
    let points = root.required("points")?;
    let actuated = match root.optional("joints")? {
        Some(joints) => joints.optional("actuated")?,
        None => None,
    };
    let limit = |key| actuated.as_ref().map_or(Ok(None), |of| of.optional_number(key));
    let limits = [limit("min")?.filter(|limit| *limit > 0.0), limit("effort")?];

    let cables = points.items()?.into_iter().enumerate().map(|(i, point)| {
        Ok(DraftCable {
            name: (i + 1).to_string(),
            anchor_w: point.required("frame")?.vector()?,
            attachment_p: point.required("platform")?.vector()?,
            rope: DraftRope::default(),
            limits,
            unstrained_length: None,
            pulley: None,
            winch: None,
        })
    });
    let cables = cables.collect::<Result<Vec<_>>>()?;
    if cables.is_empty() {
        bail!(points.error("`points` is empty: the robot has no cables"));
    }
    Ok(cables)
}
