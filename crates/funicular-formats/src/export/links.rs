//! Export to files of links and joints: a world of Gazebo (SDF) and a robot for viewers (URDF), with the frame, the
//! platform at rest and the cables as cylinders.
//!
//! Neither format has cables. In SDF a cable is a spring between two points in the elements that Drake reads; Gazebo
//! passes them over, and a constant wrench holds the platform there until a node publishes forces of cables.
//!
//! # References
//! SDFormat specification 1.9, <http://sdformat.org/spec>; URDF, <https://wiki.ros.org/urdf/XML>; the elements `drake:`
//! in the documentation of Drake's `multibody/parsing`.

use super::mujoco::vector;
use super::springs::SpringRobot;
use super::xml_text::{in_comment, names};
use anyhow::{Result, bail};
use askama::Template;
use funicular::math::{Mat3, Vec3};
use funicular::robot::PlatformMotion;
use funicular::statics::Equilibrium;
use funicular_study::at_rest::AtRest;

/// Sizes of drawn anchors and cables, in sizes of the platform.
const POINT_SIZE: f64 = 0.03;
const CABLE_SIZE: f64 = 0.005;

#[derive(Template)]
#[template(path = "robot.sdf", escape = "html")]
struct SdfWorld {
    parts: Links,
    gravity: String,
    /// Force that holds the weight of the platform [N].
    held: String,
}

#[derive(Template)]
#[template(path = "robot.urdf", escape = "html")]
struct UrdfRobot {
    parts: Links,
    name: String,
    /// Type of the platform's joint, with its axis.
    joint: &'static str,
    axis: Option<String>,
}

/// Frame, platform and cables.
struct Links {
    comment_name: String,
    comment_source: String,
    lost: Vec<String>,
    position: String,
    angles: String,
    mass: f64,
    center: String,
    inertia: Mat3,
    box_center: String,
    box_sides: String,
    point_size: f64,
    cable_size: f64,
    cables: Vec<CableLink>,
}

struct CableLink {
    name: String,
    anchor: String,
    attachment: String,
    middle: String,
    angles: String,
    length: f64,
    stiffness: f64,
    free_length: f64,
    damping: f64,
    unstrained_length: f64,
    tension: f64,
}

/// Writes the world of Gazebo.
///
/// # Errors
/// A planar platform, whose guide SDF does not have.
pub(super) fn sdf(at_rest: &AtRest, given: &Equilibrium, warnings: &mut Vec<String>) -> Result<String> {
    if matches!(at_rest.robot.platform.motion, PlatformMotion::Planar(_)) {
        bail!(
            "the platform is planar: SDF has no joint that guides a body in a plane; export it to MuJoCo, or to URDF \
             for viewers"
        );
    }
    let mut springs = SpringRobot::of(at_rest, given, warnings);
    springs.lost.push(
        "Gazebo has no cables: it draws them where they are at rest, and a constant wrench holds the platform until a \
         node publishes the forces of the cables; Drake reads them as springs, which also push"
            .to_owned(),
    );
    if !springs.dead_forces().is_empty() {
        springs.lost.push("the dead loads on the platform are left out beside the springs".to_owned());
    }
    let robot = springs.robot;
    let (gravity, held) = (vector(&robot.gravity_w), vector(&(-robot.gravity_w * robot.platform.mass)));
    let text = SdfWorld { parts: Links::of(&mut springs)?, gravity, held }.render()?;
    *warnings = springs.lost;
    Ok(text + "\n")
}

/// Writes the robot for viewers.
///
/// # Errors
/// A cable without stiffness.
pub(super) fn urdf(at_rest: &AtRest, given: &Equilibrium, warnings: &mut Vec<String>) -> Result<String> {
    let mut springs = SpringRobot::of(at_rest, given, warnings);
    springs.lost.push("URDF has no cables and no forces: it draws the cables where they are at rest".to_owned());
    let (joint, axis) = match springs.robot.platform.motion {
        PlatformMotion::Rigid | PlatformMotion::PointMass => ("floating", None),
        PlatformMotion::Planar(plane) => {
            ("planar", Some(vector(&(springs.equilibrium.pose.rot_wp.inverse() * plane.normal_w()))))
        }
    };
    let name = names("robot", std::iter::once(springs.robot.name.as_str()), &[], &mut Vec::new()).remove(0);
    let text = UrdfRobot { parts: Links::of(&mut springs)?, name, joint, axis }.render()?;
    *warnings = springs.lost;
    Ok(text + "\n")
}

impl Links {
    fn of(springs: &mut SpringRobot) -> Result<Self> {
        let robot = springs.robot;
        let pulleys = robot.cables.iter().any(|cable| cable.anchor.pulley.is_some());
        springs.lost.extend(pulleys.then(|| {
            "pulleys are left out: a cable ends at its exit point, which does not move; its spring has the stiffness \
             of arc, drum side and winch too"
                .to_owned()
        }));

        let first = springs.frequencies()?.first().copied();
        let mut changed = Vec::new();
        let given = robot.cables.iter().map(|cable| cable.name.as_str());
        let written = names("cable", given, &['/', ':'], &mut changed);
        springs.lost.extend(changed);
        let cables = written.into_iter().enumerate().map(|(i, name)| CableLink::of(springs, i, name, first)).collect();

        let (platform, pose) = (&robot.platform, &springs.equilibrium.pose);
        let [box_center, box_half] = springs.shown_box();
        let inertia = match platform.motion {
            // It does not turn, because all forces act at one point.
            PlatformMotion::PointMass => Mat3::identity() * (platform.mass * box_half.amax().powi(2)),
            PlatformMotion::Rigid => platform.inertia_p,
            PlatformMotion::Planar(plane) => {
                let normal_p = pose.rot_wp.inverse() * plane.normal_w();
                Mat3::identity() * normal_p.dot(&(platform.inertia_p * normal_p))
            }
        };
        let (roll, pitch, yaw) = pose.rot_wp.euler_angles();
        let size = robot.platform_length().min(2.0 * box_half.amax());

        Ok(Self {
            comment_name: in_comment(&robot.name),
            comment_source: in_comment(&robot.source),
            lost: springs.lost.iter().map(|text| in_comment(text)).collect(),
            position: vector(&pose.position_w),
            angles: vector(&Vec3::new(roll, pitch, yaw)),
            mass: platform.mass,
            center: vector(&platform.center_of_mass_p),
            inertia,
            box_center: vector(&box_center),
            box_sides: vector(&(box_half * 2.0)),
            point_size: POINT_SIZE * size,
            cable_size: CABLE_SIZE * size,
            cables,
        })
    }
}

impl CableLink {
    fn of(springs: &SpringRobot, i: usize, name: String, first_hz: Option<f64>) -> Self {
        let (cable, state) = (&springs.robot.cables[i], &springs.equilibrium.cables[i]);
        let spring = springs.spring(i, first_hz);
        let chord = state.chord_w();
        let beyond = state.unstrained_length - state.free_length();
        let slack = state.unstrained_length - beyond;
        Self {
            anchor: vector(&state.anchor_w),
            attachment: vector(&cable.attachment_p),
            middle: vector(&(state.attachment_w + chord * 0.5)),
            // The axis of a cylinder is z.
            angles: vector(&Vec3::new(0.0, chord.xy().norm().atan2(chord.z), chord.y.atan2(chord.x))),
            length: chord.norm(),
            stiffness: spring.stiffness,
            free_length: if spring.tension > 0.0 { chord.norm() - spring.tension / spring.stiffness } else { slack },
            damping: spring.damping,
            unstrained_length: state.unstrained_length,
            tension: spring.tension,
            name,
        }
    }
}
