//! Export to a MoorDyn input file (version 2), in air.
//!
//! A line of MoorDyn is a chain of bars (see [`super::chain`]). Each line has its own line type, because each has its
//! own mass per length. MoorDyn takes only principal moments of inertia, so the axes of its body are the platform's
//! principal axes. The origin of the body is the origin of the platform.

mod driver;

use super::chain::Chain;
use super::one_line;
use anyhow::{Result, bail};
use askama::Template;
use driver::MoorDynCourse;
use funicular::math::{Mat3, Vec3};
use funicular::robot::{Damping, Material, PlatformMotion, Robot};
use funicular_study::at_rest::AtRest;
use funicular_study::request::Scenario;

#[derive(Template)]
#[template(path = "moordyn.txt", escape = "none")]
struct MoorDynFile {
    name: String,
    source: String,
    segments: usize,
    shortened: f64,
    heavier: f64,
    body_axes: &'static str,
    /// Mass that the platform has released [kg].
    released: f64,
    driven: bool,
    damping: bool,
    types: Vec<LineType>,
    body: Option<BodyRow>,
    points: Vec<MoorDynPointRow>,
    lines: Vec<LineRow>,
    step: f64,
    gravity: f64,
    depth: f64,
}

struct LineType {
    name: String,
    mass_per_length: f64,
    axial_stiffness: f64,
    /// Damping BA [N s].
    damping: f64,
}

struct BodyRow {
    pose: [f64; 6],
    mass: f64,
    center: Vec3,
    moments: Vec3,
}

struct MoorDynPointRow {
    id: usize,
    attachment: &'static str,
    at: Vec3,
    mass: f64,
}

struct LineRow {
    id: usize,
    kind: String,
    ends: [usize; 2],
    unstrained_length: f64,
}

/// Writes the input file.
///
/// # Errors
/// A slack cable, or a feature that MoorDyn lacks: guides, loads, massless lines, gravity in another direction than −z.
pub(crate) fn input(at_rest: &AtRest, segments: usize, warnings: &mut Vec<String>) -> Result<String> {
    input_after(at_rest, 0.0, segments, warnings)
}

/// Refuses a scenario that MoorDyn cannot hold.
///
/// # Errors
/// The event, and why.
pub(crate) fn refuse_scenario(scenario: &Scenario) -> Result<()> {
    driver::refuse(scenario)
}

/// Writes a script that runs a scenario of `duration` [s].
///
/// # Errors
/// Those of [`input`], and an event that cannot happen.
pub(crate) fn script(
    at_rest: &AtRest,
    scenario: &Scenario,
    duration: f64,
    segments: usize,
    warnings: &mut Vec<String>,
) -> Result<String> {
    let course = MoorDynCourse::of(&at_rest.vibrating(), scenario, duration)?;
    let input = input_after(&course.after, course.released, segments, warnings)?;
    course.script(&input, warnings)
}

/// Writes the input file of a robot that has released a mass [kg].
fn input_after(at_rest: &AtRest, released: f64, segments: usize, warnings: &mut Vec<String>) -> Result<String> {
    let AtRest { robot, equilibrium, .. } = at_rest;
    refuse(robot)?;
    warn_of_drives(robot, warnings);
    let body = match robot.platform.motion {
        PlatformMotion::Rigid => Some(BodyFrame::of(at_rest)),
        PlatformMotion::PointMass | PlatformMotion::Planar(_) => None,
    };
    let mut lines = MoorDynLines::of(at_rest, segments, body.as_ref())?;
    if body.is_none() {
        let at = equilibrium.pose.point_w(&robot.platform.center_of_mass_p);
        let id = robot.cables.len() + 1;
        lines.points.push(MoorDynPointRow { id, attachment: "Free", at, mass: robot.platform.mass });
    }
    lines.points.sort_by_key(|point| point.id);

    let input = MoorDynFile {
        name: without_section(&robot.name),
        source: without_section(&robot.source),
        segments,
        shortened: lines.shortened,
        heavier: lines.heavier,
        body_axes: match &body {
            Some(frame) if frame.axes_p != Mat3::identity() => "principal axes of inertia",
            _ => "axes of the platform frame",
        },
        released,
        driven: robot.cables.iter().any(|cable| !cable.anchor.is_fixed()),
        damping: !robot.cables.iter().all(|cable| is_held(&cable.material)),
        types: lines.types,
        body: body.map(|frame| frame.row),
        points: lines.points,
        lines: lines.lines,
        step: lines.step,
        gravity: -robot.gravity_w.z,
        // The seabed lies far below the robot.
        depth: (-10.0 * lines.lowest).max(1000.0),
    };
    Ok(input.render()? + "\n")
}

/// Warns that the file has neither pulleys nor winches.
fn warn_of_drives(robot: &Robot, warnings: &mut Vec<String>) {
    let driven: Vec<&str> =
        (robot.cables.iter().filter(|cable| !cable.anchor.is_fixed())).map(|cable| cable.name.as_str()).collect();
    if !driven.is_empty() {
        warnings.push(format!(
            "MoorDyn has no pulleys and no winches: the lines of the cables {} end at the exit points, which do not \
             move. Arc, drum side and winch are left out, so that the file has the equilibrium of the robot, and a \
             higher stiffness",
            driven.join(", ")
        ));
    }
}

/// Line types, lines and end points of the cables, with the extreme values for the notes and the time step.
struct MoorDynLines {
    types: Vec<LineType>,
    points: Vec<MoorDynPointRow>,
    lines: Vec<LineRow>,
    /// Largest time step at which every line is stable [s].
    step: f64,
    /// Largest difference of the unstrained length from that of the cable [m].
    shortened: f64,
    /// Largest relative difference of the mass per length from that of the cable.
    heavier: f64,
    /// Height of the lowest point of all lines, at most zero [m].
    lowest: f64,
}

impl MoorDynLines {
    fn of(at_rest: &AtRest, segments: usize, body: Option<&BodyFrame>) -> Result<Self> {
        let AtRest { robot, equilibrium, .. } = at_rest;
        let cables = robot.cables.len();
        let (types, points, lines) = (Vec::new(), Vec::new(), Vec::new());
        let mut all = Self { types, points, lines, step: f64::INFINITY, shortened: 0.0, heavier: 0.0, lowest: 0.0 };

        for (i, (cable, state)) in robot.cables.iter().zip(&equilibrium.cables).enumerate() {
            let chain = Chain::of(robot, equilibrium, i, segments)?;
            let unstrained_length = chain.bar_length * segments as f64;
            let mass_per_length =
                chain.weight_factor * cable.material.mass_per_length * (state.free_length() / unstrained_length);
            let wave = (cable.material.axial_stiffness / cable.material.mass_per_length).sqrt();
            all.heavier = all.heavier.max((mass_per_length / cable.material.mass_per_length - 1.0).abs());
            let crossing = chain.bar_length / wave;
            let loss = cable.material.stretch_loss.time;
            all.step = all.step.min(STEP * crossing).min(STEP * crossing * crossing / loss);
            all.shortened = all.shortened.max(state.free_length() - unstrained_length);
            all.lowest = chain.nodes_w.iter().map(|node| node.z).fold(all.lowest, f64::min);

            let name = type_name(&cable.material.name, i);
            let axial_stiffness = cable.material.axial_stiffness;
            let damping = axial_stiffness * loss;
            all.types.push(LineType { name: name.clone(), mass_per_length, axial_stiffness, damping });
            all.points.push(MoorDynPointRow { id: i + 1, attachment: "Fixed", at: state.anchor_w, mass: 0.0 });
            let mut end = cables + 1;
            if let Some(frame) = body {
                end += i;
                let at = frame.axes_p.transpose() * cable.attachment_p;
                all.points.push(MoorDynPointRow { id: end, attachment: "Body1", at, mass: 0.0 });
            }
            all.lines.push(LineRow { id: i + 1, kind: name, ends: [end, i + 1], unstrained_length });
        }
        Ok(all)
    }
}

/// True if MoorDyn has all damping of a rope.
fn is_held(material: &Material) -> bool {
    let (Damping::Ratio(coefficient) | Damping::Viscous(coefficient)) = material.damping;
    coefficient == 0.0 && material.stretch_loss.factor == 0.0
}

/// Ratio of the time step to the time that a wave takes along a segment. The Runge-Kutta method of fourth order is
/// stable up to √2; with damping BA it is up to 0.7 times the square of this time over BA/EA.
const STEP: f64 = 0.5;

fn refuse(robot: &Robot) -> Result<()> {
    if matches!(robot.platform.motion, PlatformMotion::Planar(_)) {
        bail!(
            "the platform is planar: MoorDyn's bodies are free in all six degrees of freedom or moved by another \
             program, and nothing guides them in a plane; export it to OpenSees"
        );
    }

    if robot.load.force_w != Vec3::zeros() || robot.load.moment_w != Vec3::zeros() {
        bail!(
            "a load acts on the platform: MoorDyn's input has no forces but weight and water (only its Fortran edition \
             reads EXTERNAL LOADS); leave out [loads], ⟪force_n⟫ and ⟪moment_n_m⟫, or export to OpenSees"
        );
    }

    let along = robot.cables.iter().any(|cable| cable.load_per_length_w != Vec3::zeros());
    if robot.wind.velocity_w != Vec3::zeros() || along {
        bail!(
            "wind or another load acts along the cables: MoorDyn's input has water but no wind; leave out [wind], \
             `load_n_per_m`, ⟪wind_m_s⟫ and ⟪cable_load_n_per_m⟫, or export to OpenSees"
        );
    }

    let g = robot.gravity_w;
    if g.x != 0.0 || g.y != 0.0 || g.z > 0.0 {
        bail!(
            "gravity is ({}, {}, {}) m/s²: MoorDyn has it along -z only; rotate the robot's world axes",
            g.x,
            g.y,
            g.z
        );
    }

    if let Some(cable) = robot.cables.iter().find(|cable| cable.material.mass_per_length == 0.0) {
        bail!("cable \"{}\" has no mass, and MoorDyn divides by it: give its material a `mass_kg_per_m`", cable.name);
    }

    Ok(())
}

/// Maximum number of letters of a rope's name in the name of a line type: enough to recognise the rope, and few enough
/// for readers that accept only short words.
const MAX_ROPE_LETTERS: usize = 64;

/// Name of the line type of cable `i`: the beginning of its rope's name and the number of the cable. Characters that
/// end a word or begin a section are replaced. The number makes the name unique; every cable has its own mass per
/// length.
fn type_name(material: &str, i: usize) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() || "-.".contains(c) { c } else { '_' };
    let rope: String = material.chars().take(MAX_ROPE_LETTERS).map(letter).collect();
    format!("{}_{}", without_section(&rope), i + 1)
}

/// Frame of the MoorDyn body.
struct BodyFrame {
    /// Axes of the body in the platform frame, as columns.
    axes_p: Mat3,
    row: BodyRow,
}

impl BodyFrame {
    fn of(at_rest: &AtRest) -> Self {
        let (platform, pose) = (&at_rest.robot.platform, &at_rest.equilibrium.pose);
        let inertia = platform.inertia_p;
        let (axes_p, moments) = if inertia == Mat3::from_diagonal(&inertia.diagonal()) {
            (Mat3::identity(), inertia.diagonal())
        } else {
            let principal = inertia.symmetric_eigen();
            nearest_frame(&principal.eigenvectors, &principal.eigenvalues)
        };
        let rot_wb = pose.rot_wp.to_rotation_matrix() * axes_p;

        // Roll, pitch and yaw about moving axes, R = Rx Ry Rz.
        let pitch = rot_wb[(0, 2)].clamp(-1.0, 1.0).asin();
        let roll = (-rot_wb[(1, 2)]).atan2(rot_wb[(2, 2)]);
        let yaw = (-rot_wb[(0, 1)]).atan2(rot_wb[(0, 0)]);

        let at = pose.position_w;
        let [roll, pitch, yaw] = [roll, pitch, yaw].map(f64::to_degrees);

        let row = BodyRow {
            pose: [at.x, at.y, at.z, roll, pitch, yaw].map(|x| x + 0.0),
            mass: platform.mass,
            center: axes_p.transpose() * platform.center_of_mass_p,
            moments,
        };

        Self { axes_p, row }
    }
}

/// Right-handed principal axes and their moments, in the order and with the signs that rotate the frame least (largest
/// trace). An eigenvalue solver leaves order and signs open, and forward statics of an imported robot starts from its
/// frame without rotation.
fn nearest_frame(axes: &Mat3, moments: &Vec3) -> (Mat3, Vec3) {
    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];

    let mut nearest = (Mat3::identity(), *moments);
    let mut largest = f64::NEG_INFINITY;

    for order in ORDERS {
        // A left-handed frame needs one more sign change: on the axis that reduces the trace least.
        let mut frame = Mat3::from_columns(&order.map(|k| axes.column(k).into_owned()));
        for k in 0..3 {
            if frame[(k, k)] < 0.0 {
                frame.column_mut(k).neg_mut();
            }
        }
        if frame.determinant() < 0.0 {
            let least = frame.diagonal().imin();
            frame.column_mut(least).neg_mut();
        }

        if frame.trace() > largest {
            largest = frame.trace();

            nearest = (frame, Vec3::from(order.map(|k| moments[k])));
        }
    }
    nearest
}

/// Puts a text on one line without three hyphens in a row, which would begin a section.
fn without_section(text: &str) -> String {
    let mut text = one_line(text);
    while text.contains("---") {
        text = text.replace("---", "--");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use funicular::math::{Rotation, rotation};

    #[test]
    fn names_of_line_types_differ_whatever_the_ropes_are_called() {
        let long = "rope".repeat(1000);
        let ropes =
            [long.clone(), format!("{long}a"), format!("{long}b"), "a b".to_owned(), "a_b".to_owned(), "索".into()];
        let names: Vec<String> = ropes.iter().enumerate().map(|(i, rope)| type_name(rope, i)).collect();
        for (i, name) in names.iter().enumerate() {
            assert!(!names[..i].contains(name) && name.len() < 80, "{name}");
        }
        assert_eq!(type_name("rope-4mm", 0), "rope-4mm_1");
        assert_eq!(type_name("a ----- b", 2), "a_--_b_3", "three hyphens would begin a section");
    }

    #[test]
    fn the_chosen_principal_axes_rotate_the_frame_least() {
        const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
        for case in 0..200 {
            // All kinds of rotations, and moments that are close to each other, too.
            let angle = |step: f64| 3.0 * (step * f64::from(case)).sin();
            let turn = Vec3::new(angle(0.7), angle(1.3), angle(2.1));
            let rot = rotation::turned(&Rotation::identity(), &turn).to_rotation_matrix();
            let moments = Vec3::new(1.0, 1.0 + 0.01 * f64::from(case % 7 + 1), 1.5);
            let tensor = rot.matrix() * Mat3::from_diagonal(&moments) * rot.matrix().transpose();
            let principal = tensor.symmetric_eigen();
            let (axes, found) = nearest_frame(&principal.eigenvectors, &principal.eigenvalues);
            assert!((axes.determinant() - 1.0).abs() < 1e-12, "{case}");
            assert!((axes * Mat3::from_diagonal(&found) * axes.transpose() - tensor).norm() < 1e-12, "{case}");
            for order in ORDERS {
                for signs in 0..8_u8 {
                    let column = |k: usize| axes.column(order[k]) * if signs >> k & 1 == 1 { -1.0 } else { 1.0 };
                    let other = Mat3::from_columns(&[column(0), column(1), column(2)]);
                    assert!(other.determinant() < 0.0 || other.trace() <= axes.trace() + 1e-12, "{case}");
                }
            }
        }
    }
}
