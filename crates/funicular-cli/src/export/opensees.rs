//! A script for OpenSeesPy: cables as chains of bars, the platform as masses on a frame of stiff bars.
//!
//! Only bars, no beams and no constraints: bars turn with their ends, so that a force on a platform that tilts keeps
//! its point. A rigid link of OpenSees is linear and loses the moment of that; a frame of stiff beams has their own
//! flexibility against bending.

use super::chain::Chain;
use super::{first_frequencies, modes_below, one_line};
use crate::state::AtRest;
use anyhow::Result;
use askama::Template;
use funicular::math::{Mat3, Vec3};
use funicular::robot::{Freedoms, Robot};
use serde::Serialize;

/// Natural frequencies to compare with, unless a limit is given.
const FREQUENCIES: usize = 10;
/// Stiffness of a bar of the platform over that of the stiffest cable, EA/L. A tenth of it lowers CoGiRo's platform
/// modes by 1e-6, ten times as much costs digits.
const FRAME_STIFFNESS: f64 = 1e6;
/// Points nearer than this part of the frame's size are one.
const TOUCHING: f64 = 1e-9;

#[derive(Template)]
#[template(path = "opensees.py", escape = "none")]
struct Script {
    segments: usize,
    name: String,
    source: String,
    gravity: String,
    platform: String,
    cables: Vec<String>,
    position: String,
    tensions: String,
    frequencies: String,
    frame_stiffness: f64,
    touching: f64,
    size: f64,
}

/// What the script knows of a cable.
#[derive(Serialize)]
struct CableData<'a> {
    name: &'a str,
    attachment: [f64; 3],
    mass: f64,
    weight_factor: f64,
    axial_stiffness: f64,
    unstrained_length: f64,
    bar_length: f64,
    nodes: Vec<[f64; 3]>,
}

/// The script.
///
/// # Errors
/// A slack cable; no equilibrium of exact cables, more modes than a table has rows.
pub(crate) fn script(at_rest: &AtRest, segments: usize, below_hz: Option<f64>) -> Result<String> {
    let AtRest { robot, equilibrium, .. } = at_rest;
    let frequencies = match below_hz {
        None => first_frequencies(at_rest, FREQUENCIES)?,
        Some(limit) => modes_below(at_rest, limit)?.1.modes.iter().map(|mode| mode.frequency_hz).collect(),
    };
    let (points, size) = platform(at_rest);
    let platform: Vec<([f64; 3], f64)> = points.iter().map(|(point, mass)| ((*point).into(), *mass)).collect();
    let stiffest = |i: usize| robot.cables[i].material.axial_stiffness / equilibrium.cables[i].unstrained_length;
    let cables = (0..robot.cables.len()).map(|i| cable(at_rest, i, segments)).collect::<Result<Vec<_>>>()?;
    let script = Script {
        segments,
        name: json(&robot.name)?,
        source: one_line(&robot.source),
        gravity: json(&<[f64; 3]>::from(robot.gravity_w))?,
        platform: json(&platform)?,
        cables,
        position: json(&<[f64; 3]>::from(equilibrium.pose.position_w))?,
        tensions: json(&equilibrium.cables.iter().map(|c| [c.tension_platform, c.tension_anchor]).collect::<Vec<_>>())?,
        frequencies: json(&frequencies)?,
        frame_stiffness: FRAME_STIFFNESS * (0..robot.cables.len()).map(stiffest).fold(0.0, f64::max),
        touching: TOUCHING * size,
        size,
    };
    Ok(script.render()? + "\n")
}

fn cable(at_rest: &AtRest, i: usize, segments: usize) -> Result<String> {
    let (cable, state) = (&at_rest.robot.cables[i], &at_rest.equilibrium.cables[i]);
    let chain = Chain::of(&at_rest.robot, &at_rest.equilibrium, i, segments)?;
    json(&CableData {
        name: &cable.name,
        attachment: state.attachment_w.into(),
        mass: cable.material.mass_per_length * state.unstrained_length,
        weight_factor: chain.weight_factor,
        axial_stiffness: cable.material.axial_stiffness,
        unstrained_length: state.unstrained_length,
        bar_length: chain.bar_length,
        nodes: chain.nodes_w[1..].iter().map(|node| (*node).into()).collect(),
    })
}

/// Points with masses, centre of mass first, then pairs along the principal axes; and the size of the frame [m].
///
/// A pair at ±r along an axis has the second moment of mass about the plane across it; the centre has what is left of the
/// mass, which is not negative if r² is at least the sum of the second moments over the mass.
fn platform(at_rest: &AtRest) -> (Vec<(Vec3, f64)>, f64) {
    let AtRest { robot, equilibrium, .. } = at_rest;
    let Robot { platform, .. } = robot;
    let pose = &equilibrium.pose;
    let center_w = pose.point_w(&platform.center_of_mass_p);
    match platform.freedoms {
        Freedoms::PointMass => (vec![(center_w, platform.mass)], 1.0),
        // A planar one is refused before.
        Freedoms::Rigid | Freedoms::Planar(_) => {
            let principal = platform.inertia_p.symmetric_eigen();
            let moments = principal.eigenvalues;
            let half_trace = 0.5 * moments.sum();
            // The file's reader has refused what is no body; rounding may leave less than nothing of a flat one.
            let second = moments.map(|moment| (half_trace - moment).max(0.0));
            let size = robot.platform_length().max((second.sum() / platform.mass).sqrt());
            let axes_w: Mat3 = pose.rot_wp.to_rotation_matrix() * principal.eigenvectors;
            let at_center = (platform.mass - second.sum() / (size * size)).max(0.0);
            let mut points = vec![(center_w, at_center)];
            for k in 0..3 {
                let arm = axes_w.column(k) * size;
                let mass = 0.5 * second[k] / (size * size);
                points.extend([(center_w - arm, mass), (center_w + arm, mass)]);
            }
            (points, size)
        }
    }
}

/// A value as Python reads it: numbers, lists and texts of JSON are the same there.
fn json(value: &impl Serialize) -> Result<String> {
    Ok(serde_json::to_string(value)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use funicular::robot::State;
    use funicular::statics::{self, StaticModel};

    fn at_rest(text: &str) -> AtRest {
        let robot = Robot::from_toml(text).unwrap();
        let State::Lengths(lengths) = &robot.state else { panic!("it has lengths") };
        let equilibrium = statics::forward(&robot, lengths, StaticModel::Catenary, None).unwrap();
        AtRest { robot, equilibrium, instead_of: None }
    }

    #[test]
    fn the_points_of_the_platform_have_its_mass_its_centre_and_its_whole_inertia_tensor() {
        for text in
            [include_str!("../../../../robots/cogiro.toml"), include_str!("../../../../robots/yuan2014-4mm.toml")]
        {
            let at_rest = at_rest(text);
            let (points, _) = platform(&at_rest);
            let of = &at_rest.robot.platform;
            let rot_wp = at_rest.equilibrium.pose.rot_wp.to_rotation_matrix();
            let center_w = at_rest.equilibrium.pose.point_w(&of.center_of_mass_p);
            let mass: f64 = points.iter().map(|(_, mass)| mass).sum();
            let center: Vec3 = points.iter().map(|(point, mass)| point * (*mass / mass_of(&points))).sum();
            let about = |(point, mass): &(Vec3, f64)| {
                let at = point - center_w;
                (Mat3::identity() * at.norm_squared() - at * at.transpose()) * *mass
            };
            let tensor: Mat3 = points.iter().map(about).sum();
            let wanted = rot_wp.matrix() * of.inertia_p * rot_wp.matrix().transpose();
            assert!((mass / of.mass - 1.0).abs() < 1e-12);
            assert!((center - center_w).norm() < 1e-12);
            assert!((tensor - wanted).norm() < 1e-12 * wanted.norm());
            assert!(points.iter().all(|(_, mass)| *mass >= 0.0));
        }
    }

    fn mass_of(points: &[(Vec3, f64)]) -> f64 {
        points.iter().map(|(_, mass)| mass).sum()
    }

    #[test]
    fn a_name_cannot_leave_its_place_in_the_script() {
        let text = include_str!("../../../../robots/sap2000-8-cable-point-mass.toml")
            .replace("name = \"8-cable", "name = \"\\\"\\\"\\\"; import os #8-cable");
        let script = script(&at_rest(&text), 2, Some(1.0)).unwrap();
        assert!(script.contains(r#"NAME = "\"\"\"; import os #8-cable"#), "{script}");
    }
}
