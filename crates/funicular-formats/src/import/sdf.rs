//! Import of SDF: a model of Gazebo or Drake whose cables are springs of Drake, chains of joints, or named frames.
//!
//! # References
//! SDFormat specification, <http://sdformat.org/spec>; the elements `drake:` in the documentation of Drake's
//! `multibody/parsing`.

mod chains;
mod model;

use super::cdpr_gazebo::GRAVITY;
use super::draft::{Draft, DraftCable, DraftMotion, DraftPlatform, DraftRope, DraftState};
use super::pairs::{self, PointOfPair};
use super::xml::{Xml, children, tag};
use anyhow::{Result, bail};
use funicular::math::Vec3;
use funicular_study::text::clean;
use model::SdfModel;
use roxmltree::Node;

/// Reads the robot of a file.
///
/// # Errors
/// The line and the value at fault; or the feature of the robot that a robot file cannot hold.
pub(crate) fn read(xml: &Xml) -> Result<Draft> {
    let root = xml.root();
    let world = xml.optional(root, "world")?;
    let gravity_w = match world.map(|world| xml.optional(world, "gravity")).transpose()?.flatten() {
        Some(gravity) => xml.vector(gravity)?,
        None => GRAVITY,
    };

    let models: Vec<Node> = children(world.unwrap_or(root), "model").collect();
    let Some(&first) = models.first() else { bail!(xml.error(root, "the file has no <model>")) };
    let mut lost = Vec::new();
    let node = models.iter().copied().find(|model| SdfModel::has_platform(*model)).unwrap_or(first);
    let others = models.iter().filter(|model| **model != node);
    lost.extend(others.map(|other| format!("the model `{}`", clean(other.attribute("name").unwrap_or_default()))));

    let model = SdfModel::read(xml, node)?;
    let springs = springs(&model, &mut lost)?;
    let are_springs = !springs.is_empty();
    let cables = if are_springs { springs } else { cables_without_springs(&model, &mut lost)? };
    lost_parts(node, &mut lost);
    let place = xml.place(model.platform.node);
    let mass = model.mass_of_platform()?;
    let mut notes = Vec::new();
    let state = if are_springs {
        notes.push("State: the free lengths of the springs, as unstrained lengths".to_owned());
        DraftState::Lengths
    } else {
        DraftState::Pose(model.platform.pose)
    };
    notes.push("Platform frame: that of the link".to_owned());
    let [x, y, z] = gravity_w.into();
    notes.push(format!("Gravity ({x}, {y}, {z}) m/s²{}", if gravity_w == GRAVITY { ", Gazebo's own" } else { "" }));

    let name = clean(node.attribute("name").unwrap_or_default());
    Ok(Draft {
        name: if name.is_empty() || name == "robot" { xml.file().stem() } else { name },
        source: format!("SDF, {}", xml.file().name()),
        gravity_w,
        platform: DraftPlatform {
            mass: mass.map(|mass| mass.mass),
            inertia_p: mass.and_then(|mass| mass.inertia),
            center_of_mass_p: mass.map(|mass| mass.center),
            motion: DraftMotion::Rigid,
            place,
        },
        cables,
        state,
        payload: None,
        notes,
        assumed: Vec::new(),
        lost,
    })
}

/// Cables from chains of joints, or from frames with their names.
fn cables_without_springs(model: &SdfModel, lost: &mut Vec<String>) -> Result<Vec<DraftCable>> {
    let chains = chains::cables(model)?;
    if !chains.is_empty() {
        lost.push("links and joints that stand for cables, with their masses and limits".to_owned());
        return Ok(chains);
    }
    let (xml, node) = (model.xml, model.node);
    let pairs = pairs::cables(&points(model)?).map_err(|message| xml.error(node, message))?;
    if pairs.is_empty() {
        bail!(xml.error(
            node,
            "the model has no cables: neither <drake:linear_spring_damper> between the frame and the link `platform`, \
             nor chains of joints with a prismatic joint, nor frames `anchor_NAME` and `attachment_NAME`"
        ));
    }
    Ok(pairs)
}

/// Lists what the model has beside links, joints and cables.
fn lost_parts(node: Node, lost: &mut Vec<String>) {
    let plugins = node.descendants().filter(|of| of.is_element() && tag(*of) == "plugin");
    for plugin in plugins {
        lost.push(format!("the plugin `{}`", clean(plugin.attribute("name").unwrap_or_default())));
    }
}

/// Cables from the springs of Drake, which act between a point of the frame and a point of the platform.
fn springs(model: &SdfModel, lost: &mut Vec<String>) -> Result<Vec<DraftCable>> {
    let xml = model.xml;
    let mut cables = Vec::new();
    let mut damped = false;
    for node in children(model.node, "linear_spring_damper") {
        let part = |name: &str| xml.required(node, &format!("linear_spring_damper_{name}"));
        let body = |name: &str| -> Result<String> { Ok(super::xml::content(part(name)?).trim().to_owned()) };
        let mut ends = [(body("body_A")?, xml.vector(part("p_AP")?)?), (body("body_B")?, xml.vector(part("p_BQ")?)?)];
        if ends[0].0 == model.platform.name {
            ends.swap(0, 1);
        }
        let [(frame, anchor), (platform, attachment_p)] = ends;
        if platform != model.platform.name || !model.is_fixed(&frame) {
            bail!(xml.error(
                node,
                format!(
                    "the spring acts between `{}` and `{}`; a cable is between the frame and the link `{}`",
                    clean(&frame),
                    clean(&platform),
                    clean(&model.platform.name)
                )
            ));
        }

        let free_length = xml.number(part("free_length")?)?;
        let stiffness = xml.number(part("stiffness")?)?;
        for (value, what) in [(free_length, "free length"), (stiffness, "stiffness")] {
            if value <= 0.0 {
                bail!(xml.error(node, format!("the {what} of the spring is {value}, it must be positive")));
            }
        }
        damped |=
            xml.optional(node, "linear_spring_damper_damping")?.map(|of| xml.number(of)).transpose()? != Some(0.0);
        let name = clean(node.attribute("name").unwrap_or_default());
        cables.push(DraftCable {
            name: name.strip_prefix("cable_").unwrap_or(&name).to_owned(),
            anchor_w: model.point_of(&frame, &anchor),
            attachment_p,
            rope: DraftRope { axial_stiffness: Some(stiffness * free_length), ..DraftRope::default() },
            limits: [None, None],
            unstrained_length: Some(free_length),
            pulley: None,
            winch: None,
        });
    }
    if damped && !cables.is_empty() {
        lost.push("damping of the springs".to_owned());
    }
    Ok(cables)
}

/// Named frames on the frame of the robot and on the platform.
fn points(model: &SdfModel) -> Result<Vec<PointOfPair>> {
    let mut points = Vec::new();
    for frame in &model.frames {
        let Some(body) = model.body_under(&frame.name)? else { continue };
        let is_on_platform = body == model.platform.name;
        if !is_on_platform && !model.is_fixed(&body) {
            continue;
        }
        let position: Vec3 = if is_on_platform {
            super::frames::compose(&super::frames::inverse(&model.platform.pose), &frame.pose).position_w
        } else {
            frame.pose.position_w
        };
        points.push(PointOfPair { name: frame.name.clone(), position, is_on_platform });
    }
    Ok(points)
}
