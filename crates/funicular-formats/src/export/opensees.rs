//! Export to a script for OpenSeesPy: cables as chains of bars, the platform as masses on a frame of stiff bars.
//!
//! The model has only bars, neither beams nor rigid links. Bars rotate with their ends, so a force on a tilting
//! platform keeps its point of application. A rigid link of OpenSees is linear and loses the moment of this rotation; a
//! frame of stiff beams would add the bending flexibility of the beams.
//!
//! The guide of a planar platform holds every point of the platform along the normal of the plane. Points of a platform
//! that moves in a plane keep their distance from it for any motion, so this is not a linearisation. The normal has to
//! be a coordinate axis: otherwise the complete model is rotated.
//!
//! Nodes of bars take no moments, and on beams OpenSees keeps moments fixed in the world, which makes the tangent
//! unsymmetric. A moment is therefore written as two couples of dead forces at right angles, each with half of it. This
//! moment is semi-tangential with the stiffness ½\[m\]× of the theory (48), so that both statics and frequencies agree
//! with funicular.

use super::chain::Chain;
use super::springs::in_plane;
use super::support::Support;
use super::{first_frequencies, modes_below, one_line};
use anyhow::Result;
use askama::Template;
use funicular::math::{Mat3, Vec3};
use funicular::robot::{Load, PlatformMotion, Robot, Winch};
use funicular_study::at_rest::AtRest;
use serde::Serialize;

/// Number of natural frequencies for the comparison, if no limit is given.
const FREQUENCIES: usize = 10;
/// Ratio of the stiffness of a platform bar to the stiffness EA/L of the stiffest cable. A tenth of it lowers CoGiRo's
/// platform modes by 1e-6; ten times as much costs digits.
const FRAME_STIFFNESS: f64 = 1e6;
/// Relative rounding error of the first frequency above which the user is warned.
const ROUNDING: f64 = 1e-5;
/// Points nearer than this fraction of the frame's size count as one point.
const TOUCHING: f64 = 1e-9;

#[derive(Template)]
#[template(path = "opensees.py", escape = "none")]
struct Script {
    segments: usize,
    name: String,
    source: String,
    gravity: String,
    axes: String,
    guided: Option<usize>,
    platform: String,
    loads: String,
    cables: Vec<String>,
    position: String,
    tensions: String,
    frequencies: String,
    frame_stiffness: f64,
    touching: f64,
    size: f64,
}

/// Data of a cable in the script.
#[derive(Serialize)]
struct CableData<'a> {
    name: &'a str,
    attachment: [f64; 3],
    mass: f64,
    /// Weight and other load of the whole chain [N].
    load: [f64; 3],
    axial_stiffness: f64,
    unstrained_length: f64,
    bar_length: f64,
    nodes: Vec<[f64; 3]>,
    /// Spring at the last joint that stands for pulley, drum side and winch; the joint is fixed without it.
    #[serde(skip_serializing_if = "Option::is_none")]
    support: Option<Support>,
}

/// Writes the script.
///
/// # Errors
/// A slack cable, no modes with the model catenary-dynamic, or more modes than a table has rows.
pub(crate) fn script(
    at_rest: &AtRest,
    segments: usize,
    below_hz: Option<f64>,
    warnings: &mut Vec<String>,
) -> Result<String> {
    let AtRest { robot, .. } = at_rest;
    let exported = AtRest { robot: with_held_motors(robot), ..at_rest.clone() };
    if exported.robot != *robot {
        warnings.push(
            "the script has neither the inertia of wheels, drums and motors nor the mass of drum sides nor the control \
             of motors: its motors are held, and so are those of the frequencies to which it compares"
                .to_owned(),
        );
    }
    let at_rest = &exported;
    let AtRest { robot, equilibrium, .. } = at_rest;

    let frequencies = match below_hz {
        None => first_frequencies(at_rest, FREQUENCIES, warnings)?,
        Some(limit) => modes_below(at_rest, limit, warnings)?.1.modes.iter().map(|mode| mode.frequency_hz).collect(),
    };

    let body = mass_points(at_rest);
    let size = body.size;
    let platform: Vec<([f64; 3], f64)> = body.points.iter().map(|(point, mass)| ((*point).into(), *mass)).collect();
    let loads: Vec<[[f64; 3]; 2]> =
        body.loads(at_rest).iter().map(|(point, force)| [(*point).into(), (*force).into()]).collect();
    let (axes, guided) = axes(robot.platform.motion);

    let stiffest = |i: usize| robot.cables[i].material.axial_stiffness / equilibrium.cables[i].free_length();
    let frame_stiffness = FRAME_STIFFNESS * (0..robot.cables.len()).map(stiffest).fold(0.0, f64::max);
    let lost = frequencies.first().map_or(0.0, |first_hz| rounding(&body, frame_stiffness, *first_hz));
    warnings.extend((lost > ROUNDING).then(|| rounding_warning(lost, size, robot)));

    let cables = (0..robot.cables.len()).map(|i| cable(at_rest, i, segments, warnings)).collect::<Result<Vec<_>>>()?;
    let script = Script {
        segments,
        name: json(&robot.name)?,
        source: one_line(&robot.source),
        gravity: json(&<[f64; 3]>::from(robot.gravity_w))?,
        axes: json(&axes.map(<[f64; 3]>::from))?,
        guided,
        platform: json(&platform)?,
        loads: json(&loads)?,
        cables,
        position: json(&<[f64; 3]>::from(equilibrium.pose.position_w))?,
        tensions: json(&equilibrium.cables.iter().map(|c| [c.tension_platform, c.tension_anchor]).collect::<Vec<_>>())?,
        frequencies: json(&frequencies)?,
        frame_stiffness,
        touching: TOUCHING * size,
        size,
    };
    Ok(script.render()? + "\n")
}

/// Warning that OpenSees rounds the lowest frequencies; `lost` is their relative error, `size` the distance of the
/// masses from the centre of mass [m].
fn rounding_warning(lost: f64, size: f64, robot: &Robot) -> String {
    format!(
        "OpenSees will find the lowest frequencies only to about {lost:.0e}: they are low compared with those of the \
         stiff bars between the masses that represent the platform. These masses are {size:.3} m from its centre of \
         mass, the attachments {:.3} m from its origin; if that is wrong, correct inertia_kg_m2",
        robot.platform_length()
    )
}

fn cable(at_rest: &AtRest, i: usize, segments: usize, warnings: &mut Vec<String>) -> Result<String> {
    let (cable, state) = (&at_rest.robot.cables[i], &at_rest.equilibrium.cables[i]);
    let chain = Chain::of(&at_rest.robot, &at_rest.equilibrium, i, segments)?;
    let load_w = at_rest.robot.line_load(i, &state.chord_w()).vector_w() * state.free_length();
    json(&CableData {
        support: Support::of(&at_rest.robot, i, state, &chain, &load_w, warnings)?,
        name: &cable.name,
        attachment: state.attachment_w.into(),
        mass: cable.material.mass_per_length * state.free_length(),
        load: (load_w * chain.weight_factor).into(),
        axial_stiffness: cable.material.axial_stiffness,
        unstrained_length: state.free_length(),
        bar_length: chain.bar_length,
        nodes: chain.nodes_w[1..].iter().map(|node| (*node).into()).collect(),
    })
}

/// Robot whose wheels, drums and motors have no inertia and whose motors are held, with the same equilibrium: a control
/// that yields at rest becomes a part of the winch's stiffness.
fn with_held_motors(robot: &Robot) -> Robot {
    let mut held = robot.clone();
    for anchor in held.cables.iter_mut().map(|cable| &mut cable.anchor) {
        if let Some(pulley) = &mut anchor.pulley {
            (pulley.inertia, pulley.swivel_inertia) = (0.0, 0.0);
        }
        if let Some(winch) = &mut anchor.winch {
            let yields = winch.compliance() > 1.0 / winch.stiffness;
            let stiffness = if yields { 1.0 / winch.compliance() } else { winch.stiffness };
            *winch = Winch { stiffness, ..Winch::rigid(&winch.name, winch.drum_side_length) };
        }
    }
    held
}

/// Estimate of the relative rounding error of the script's first frequency in double precision. The error comes from
/// the frame's bars, which are far stiffer than the cables.
fn rounding(body: &MassPoints, frame_stiffness: f64, first_hz: f64) -> f64 {
    let heaviest = body.points.iter().fold(0.0, |most: f64, (_, mass)| most.max(*mass));
    f64::EPSILON * frame_stiffness / (heaviest * (std::f64::consts::TAU * first_hz).powi(2))
}

/// World axes of the script's coordinates, and the index of the coordinate that a guide holds.
fn axes(motion: PlatformMotion) -> ([Vec3; 3], Option<usize>) {
    let coordinates = [Vec3::x(), Vec3::y(), Vec3::z()];
    let PlatformMotion::Planar(plane) = motion else { return (coordinates, None) };
    let normal = plane.normal_w();
    if let Some(guided) = coordinates.iter().position(|axis| *axis == normal) {
        return (coordinates, Some(guided));
    }
    let [first, second] = in_plane(&normal);
    ([first, second, normal], Some(2))
}

/// Model of the platform: points with masses.
struct MassPoints {
    /// Positions in the world [m] and masses [kg]: the centre of mass, then a pair of points per arm, one at each end.
    points: Vec<(Vec3, f64)>,
    /// Vectors from the centre of mass to the second point of each pair, world axes [m], at right angles to each other.
    arms: Vec<Vec3>,
    /// Length of the arms [m].
    size: f64,
}

/// Points with the platform's mass, centre of mass and inertia, the inertia only as far as the platform can rotate.
///
/// A pair at ±r along an axis has the second moment of mass about the plane normal to this axis. The centre has the
/// rest of the mass, which is not negative if r² is at least the sum of the second moments divided by the mass.
fn mass_points(at_rest: &AtRest) -> MassPoints {
    let AtRest { robot, equilibrium, .. } = at_rest;
    let Robot { platform, .. } = robot;
    let pose = &equilibrium.pose;
    // Axes, and the second moment of mass along each.
    let axes: Vec<(Vec3, f64)> = match platform.motion {
        PlatformMotion::PointMass => Vec::new(),
        // Only the moment about the normal matters, and the file need not give another; each axis in the plane gets
        // half of it.
        PlatformMotion::Planar(plane) => {
            let normal = plane.normal_w();
            let moment = normal.dot(&(pose.rot_wp * (platform.inertia_p * (pose.rot_wp.inverse() * normal))));
            in_plane(&normal).map(|axis| (axis, 0.5 * moment)).into()
        }
        PlatformMotion::Rigid => {
            let principal = platform.inertia_p.symmetric_eigen();
            let half_trace = 0.5 * principal.eigenvalues.sum();
            let axes_w: Mat3 = pose.rot_wp.to_rotation_matrix() * principal.eigenvectors;
            // The reader of the robot file refuses impossible tensors; for a flat body rounding may still give small
            // negative values.
            let second = principal.eigenvalues.map(|moment| (half_trace - moment).max(0.0));
            (0..3).map(|k| (axes_w.column(k).into_owned(), second[k])).collect()
        }
    };

    let whole: f64 = axes.iter().map(|(_, second)| second).sum();
    let size = robot.platform_length().max((whole / platform.mass).sqrt());
    let center_w = pose.point_w(&platform.center_of_mass_p);
    let mut points = vec![(center_w, (platform.mass - whole / (size * size)).max(0.0))];
    for (axis, second) in &axes {
        let mass = 0.5 * second / (size * size);
        points.extend([(center_w - axis * size, mass), (center_w + axis * size, mass)]);
    }
    MassPoints { points, arms: axes.iter().map(|(axis, _)| axis * size).collect(), size }
}

impl MassPoints {
    /// Dead forces that represent the robot's load: point of application [m] and force [N], world axes.
    fn loads(&self, at_rest: &AtRest) -> Vec<(Vec3, Vec3)> {
        let AtRest { robot, equilibrium, .. } = at_rest;
        let Load { force_w, moment_w, point_p } = robot.load;
        let mut loads = Vec::new();

        let of_wind = robot.force_at_mass_centre_w() - robot.gravity_w * robot.platform.mass;
        if of_wind != Vec3::zeros() {
            loads.push((self.points[0].0, of_wind));
        }

        if force_w != Vec3::zeros() {
            loads.push((equilibrium.pose.point_w(&point_p), force_w));
        }

        let center_w = self.points[0].0;
        for (i, a) in self.arms.iter().enumerate() {
            for b in &self.arms[i + 1..] {
                // A planar platform has one pair of arms; the guide takes the other components of the moment.
                let about = moment_w.dot(&a.cross(b)) / self.size.powi(4);
                if about != 0.0 {
                    for (arm, force) in [(a, b * (0.25 * about)), (b, -a * (0.25 * about))] {
                        loads.extend([(center_w + arm, force), (center_w - arm, -force)]);
                    }
                }
            }
        }
        loads
    }
}

/// Python text of a value: numbers, lists and strings of JSON are also valid in Python.
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
        AtRest { robot, equilibrium, requested_pose: None, rule: None, held_pose: None }
    }

    /// Measured on this robot with OpenSees, beyond the error of the bars: the first frequency is off by 4e-5 at 1,600
    /// times its inertia, and by 5.7e-4 at 10,000 times.
    #[test]
    fn the_loss_of_digits_in_opensees_is_predicted() {
        let mut at_rest = at_rest(funicular_robots::YUAN2014_4MM);
        let inertia_p = at_rest.robot.platform.inertia_p;
        let mut lost = |times: f64, first_hz: f64| {
            at_rest.robot.platform.inertia_p = inertia_p * times;
            rounding(&mass_points(&at_rest), 1e6 * 251_327.4 / 5.77, first_hz)
        };
        assert!(lost(1.0, 1.02) < 0.1 * ROUNDING);
        for (times, first_hz, measured) in [(1600.0, 0.0439, 4e-5), (10_000.0, 0.01757, 5.7e-4)] {
            let lost = lost(times, first_hz);
            assert!(lost > measured / 3.0 && lost < 3.0 * measured, "{lost:e} for {measured:e}");
        }
    }

    #[test]
    fn the_points_of_the_platform_have_its_mass_its_centre_and_its_whole_inertia_tensor() {
        for text in [funicular_robots::COGIRO, funicular_robots::YUAN2014_4MM] {
            let at_rest = at_rest(text);
            let points = mass_points(&at_rest).points;
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
    fn the_points_of_a_planar_platform_have_its_mass_its_centre_and_its_moment_about_the_normal() {
        for normal in ["0.0, 1.0, 0.0", "1.0, 2.0, -2.0"] {
            let at_rest = at_rest(&planar(normal));
            let MassPoints { points, size, .. } = mass_points(&at_rest);
            let of = &at_rest.robot.platform;
            let PlatformMotion::Planar(plane) = of.motion else { panic!("it is planar") };
            let center_w = at_rest.equilibrium.pose.point_w(&of.center_of_mass_p);
            let mass: f64 = points.iter().map(|(_, mass)| mass).sum();
            let moment: f64 = points.iter().map(|(point, mass)| mass * (point - center_w).norm_squared()).sum();
            assert!((mass - 3.0).abs() < 1e-14 && (moment - 0.2).abs() < 1e-14, "{mass} {moment}");
            for (point, _) in &points {
                assert!(plane.normal_w().dot(&(point - center_w)).abs() < 1e-15 * size.max(1.0));
            }
            let (axes, guided) = axes(of.motion);
            assert!((axes[guided.unwrap()] - plane.normal_w()).norm() < 1e-15);
            assert!((Mat3::from_columns(&axes).determinant() - 1.0).abs() < 1e-14);
        }
    }

    /// A platform on four cables in a plane through the origin.
    fn planar(normal: &str) -> String {
        let n: Vec<f64> = normal.split(", ").map(|x| x.parse().unwrap()).collect();
        let [u, v] = in_plane(&Vec3::new(n[0], n[1], n[2]).normalize());
        let corner = |a: f64, b: f64| format!("{:?}", (u * a + v * b).as_slice());
        let cables: Vec<String> = [(-2.0, -1.5), (-2.0, 1.5), (2.0, 1.5), (2.0, -1.5)]
            .iter()
            .map(|&(a, b)| {
                let (anchor, attachment) = (corner(a, b), corner(0.1 * a, 0.05 * b));
                format!(
                    "[[cables]]\nname = \"{a} {b}\"\nmaterial = \"r\"\nanchor_m = {anchor}\n\
                         attachment_m = {attachment}\n\
                         unstrained_length_m = 2.28\n"
                )
            })
            .collect();
        format!(
            "name = \"p\"\n[platform]\nmass_kg = 3.0\nmotion = \"planar\"\nplane_normal = [{normal}]\n\
             inertia_kg_m2 = 0.2\ncenter_of_mass_m = [0.05, 0.02, 0.01]\n[materials.r]\naxial_stiffness_n = 1e4\n\
             mass_kg_per_m = 0.02\n{}",
            cables.concat()
        )
    }

    #[test]
    fn the_dead_forces_of_a_load_have_its_wrench_and_its_stiffness() {
        let load = Load {
            force_w: Vec3::new(3.0, -2.0, 5.0),
            moment_w: Vec3::new(0.7, 1.1, -0.4),
            point_p: Vec3::new(0.1, 0.2, -0.1),
        };

        let cross = |v: &Vec3| v.cross_matrix();

        for text in [funicular_robots::YUAN2014_4MM, &planar("1.0, 2.0, -2.0")] {
            let mut at_rest = at_rest(text);
            at_rest.robot.load = load;
            let motion = at_rest.robot.platform.motion;
            // The guide of a planar platform takes the rest of the moment.
            let moment_w = match motion {
                PlatformMotion::Planar(plane) => plane.normal_w() * plane.normal_w().dot(&load.moment_w),
                _ => load.moment_w,
            };

            let pose = &at_rest.equilibrium.pose;
            let lever = pose.rot_wp * load.point_p;
            let (mut force, mut moment, mut stiffness) = (Vec3::zeros(), Vec3::zeros(), Mat3::zeros());

            for (point, dead) in mass_points(&at_rest).loads(&at_rest) {
                let arm = point - pose.position_w;
                force += dead;
                moment += arm.cross(&dead);
                stiffness -= cross(&dead) * cross(&arm);
            }

            assert!((force - load.force_w).norm() < 1e-14);
            assert!((moment - lever.cross(&load.force_w) - moment_w).norm() < 1e-14, "{moment}");

            let wanted = cross(&moment_w) * 0.5 - cross(&load.force_w) * cross(&lever);
            assert!((stiffness - wanted).norm() < 1e-14, "{stiffness}");
        }
    }

    #[test]
    fn a_name_cannot_inject_code_into_the_script() {
        let text = funicular_robots::SAP2000_8_CABLE_POINT_MASS
            .replace("name = \"8-cable", "name = \"\\\"\\\"\\\"; import os #8-cable");
        let script = script(&at_rest(&text), 2, Some(1.0), &mut Vec::new()).unwrap();
        assert!(script.contains(r#"NAME = "\"\"\"; import os #8-cable"#), "{script}");
    }
}
