//! Import of MJCF, the models of MuJoCo: spatial tendons between the world and one moving body.
//!
//! # References
//! XML reference of MuJoCo, <https://mujoco.readthedocs.io/en/stable/XMLreference.html>.

mod actuators;
mod bodies;
mod options;
mod tendons;

use super::draft::{Draft, DraftCable, DraftPlatform, DraftState};
use super::frames::attribute_vec;
use super::xml::{Xml, children, tag};
use anyhow::{Result, bail};
use bodies::MujocoBodies;
use funicular::math::Vec3;
use funicular_study::text::clean;
use options::MujocoOptions;
use roxmltree::Node;

/// Gravity of a model that gives none [m/s²].
const GRAVITY: Vec3 = Vec3::new(0.0, 0.0, -9.81);

/// Sections that say nothing about a robot.
const SILENT: [&str; 11] = [
    "compiler",
    "option",
    "worldbody",
    "tendon",
    "visual",
    "asset",
    "size",
    "statistic",
    "default",
    "actuator",
    "sensor",
];

/// Reads the robot of a file.
///
/// # Errors
/// The line and the value at fault; or the feature of the robot that a robot file cannot hold.
pub(crate) fn read(xml: &Xml) -> Result<Draft> {
    let root = xml.root();
    if let Some(include) = root.descendants().find(|node| node.is_element() && tag(*node) == "include") {
        bail!(xml.error(
            include,
            "the model includes another file; let MuJoCo write it as one file (Save xml, mj_saveLastXML)"
        ));
    }
    let options = MujocoOptions::read(xml)?;
    let bodies = MujocoBodies::read(xml, &options)?;
    let (cables, moving) = tendons::cables(xml, &options, &bodies)?;
    let platform = &bodies.moving[moving];

    let mut lost = lost_sections(root);
    lost.extend(actuators::lost(root, &cables));
    if bodies.geoms_of_world > 0 {
        lost.push(format!("{} geometries of the world, which may be obstacles", bodies.geoms_of_world));
    }

    let mut notes = Vec::new();
    let state = if cables.iter().all(|cable| cable.unstrained_length.is_some()) {
        notes.push("State: the lengths at which the tendons have no tension, as unstrained lengths".to_owned());
        DraftState::Lengths
    } else {
        notes.push("State: the pose in which the file has its bodies".to_owned());
        DraftState::Pose(platform.pose)
    };
    let cables: Vec<DraftCable> = cables
        .into_iter()
        .map(|mut cable| {
            cable.unstrained_length = cable.unstrained_length.filter(|_| matches!(state, DraftState::Lengths));
            cable
        })
        .collect();
    notes.push("Platform frame: that of the body".to_owned());

    let name = clean(root.attribute("model").unwrap_or_default());
    let mass = platform.mass;
    Ok(Draft {
        name: if name.is_empty() { xml.file().stem() } else { name },
        source: format!("MuJoCo model, {}", xml.file().name()),
        gravity_w: gravity(xml, root)?,
        platform: DraftPlatform {
            mass: mass.map(|mass| mass.mass),
            inertia_p: mass.and_then(|mass| mass.inertia),
            center_of_mass_p: mass.map(|mass| mass.center),
            motion: platform.motion(xml)?,
            place: xml.place(platform.node),
        },
        cables,
        state,
        payload: None,
        notes,
        assumed: Vec::new(),
        lost,
    })
}

fn gravity(xml: &Xml, root: Node) -> Result<Vec3> {
    let Some(option) = children(root, "option").last() else { return Ok(GRAVITY) };
    Ok(attribute_vec(xml, option, "gravity")?.unwrap_or(GRAVITY))
}

/// Sections of the file that a robot file does not hold.
fn lost_sections(root: Node) -> Vec<String> {
    let names = root.children().filter(Node::is_element).map(|node| tag(node));
    let mut lost: Vec<&str> = names.filter(|name| !SILENT.contains(name)).collect();
    lost.dedup();
    lost.into_iter().map(|name| format!("<{}>", clean(name))).collect()
}
