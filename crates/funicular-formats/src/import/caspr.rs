//! Import of CASPR models: a file of bodies and a file of cables.
//!
//! # References
//!
//! D. Lau, J. Eden, Y. Tan, D. Oetomo, CASPR: a comprehensive cable-robot analysis and simulation platform for the
//! research of cable-driven parallel robots, IEEE/RSJ IROS 2016. The elements have the meaning that CASPR's own readers
//! give them (github.com/darwinlau/CASPR: BodyModelRigid, JointBase, SystemModelCables, CableAttachmentPoint).

mod bodies;
mod cables;
pub(super) mod trajectories;

use super::draft::{Draft, DraftPlatform, DraftState};
use super::xml::Xml;
use anyhow::Result;
use funicular::math::Vec3;
use funicular_study::text::clean;

/// Gravity [m/s²], fixed in CASPR.
const GRAVITY: Vec3 = Vec3::new(0.0, 0.0, -9.81);

/// Reads the robot of a pair of files with one of its cable sets.
///
/// # Errors
///
/// The line and the value at fault; or the feature of the robot that a robot file cannot hold.
pub(crate) fn read(bodies: &Xml, cables: &Xml, wanted_set: Option<&str>) -> Result<Draft> {
    let body = bodies::read(bodies)?;
    let set = cables::read(cables, wanted_set, &body.center_of_mass_p)?;

    let stem = bodies.file().stem();
    let stem = stem.strip_suffix("_bodies").unwrap_or(&stem);
    let name = if stem.is_empty() { clean(&body.name) } else { stem.to_owned() };

    let mut notes =
        vec!["Platform frame: at the joint of the source's link. Gravity 9.81 m/s² along -z, as in CASPR".to_owned()];
    if body.pose.is_none() {
        notes.push("The file has no pose, q_initial: give ⟪pose⟫ to import or to an analysis".to_owned());
    }

    let mut lost = body.lost;
    lost.extend(set.lost);

    Ok(Draft {
        name: if set.is_only { name } else { format!("{name}, cables {}", set.id) },
        source: format!("CASPR model, {} and {}, cable set {}", bodies.file().name(), cables.file().name(), set.id),
        gravity_w: GRAVITY,
        platform: DraftPlatform {
            mass: body.mass,
            inertia_p: body.inertia_p,
            center_of_mass_p: Some(body.center_of_mass_p),
            motion: body.motion,
            place: body.place,
        },
        cables: set.cables,
        state: body.pose.map_or(DraftState::Unknown, DraftState::Pose),
        payload: None,
        notes,
        assumed: body.assumed,
        lost,
    })
}
