//! Tension distribution: robots, poses and checks shared by the files of this folder.

mod centre;
mod centre_rates;
mod continuity;
mod lengths;
mod limits;
mod out_of_reach;
mod payload;
mod rules;
mod straight;

use funicular::math::Vec3;
use funicular::robot::{PlatformMotion, Pose, Robot, TensionLimits};
use funicular::statics::{self, Equilibrium, Stability};

const COGIRO: &str = funicular_robots::COGIRO;
const POINT: &str = funicular_robots::SAP2000_8_CABLE_POINT_MASS;

/// CoGiRo with ropes of this mass per length [kg/m] and these limits [N].
fn cogiro(mass_per_length: f64, minimum: f64, maximum: f64) -> Robot {
    changed(Robot::from_toml(COGIRO).unwrap(), mass_per_length, minimum, maximum)
}

fn changed(mut robot: Robot, mass_per_length: f64, minimum: f64, maximum: f64) -> Robot {
    robot.cables.iter_mut().for_each(|cable| cable.material.mass_per_length = mass_per_length);
    robot.with_tension_limits(TensionLimits { minimum: Some(minimum), maximum: Some(maximum) })
}

/// Platform of 20 kg in a room of 4 m: four cables to the ceiling, three to the floor.
fn seven_cables(mass_per_length: f64, minimum: f64, maximum: f64) -> Robot {
    let mut text = format!(
        "name = \"seven\"\n[platform]\nmass_kg = 20.0\ninertia_kg_m2 = [0.5, 0.5, 0.5]\ncenter_of_mass_m = [0.02, 0.0, \
         0.05]\n\
         [materials.rope]\naxial_stiffness_n = 2e5\nmass_kg_per_m = {mass_per_length}\n\
         minimum_tension_n = {minimum}\nmaximum_tension_n = {maximum}\n"
    );
    for i in 0..7 {
        // Triangle and quadrangle turn the platform in opposite senses.
        let (turn, twist, up) =
            if i < 4 { (0.25 * f64::from(i) + 0.125, 0.13, true) } else { (f64::from(i) / 3.0, -0.13, false) };
        let around = |turn: f64, radius: f64, z: f64| {
            let angle = std::f64::consts::TAU * turn;
            [radius * angle.cos(), radius * angle.sin(), z]
        };
        let anchor = around(turn, 2.5, if up { 3.0 } else { 0.0 });
        let attachment = around(turn + twist, 0.35, if up { -0.2 } else { 0.2 });
        let cable = format!(
            "[[cables]]\nname = \"{i}\"\nmaterial = \"rope\"\nanchor_m = {anchor:?}\nattachment_m = {attachment:?}\n"
        );
        text.push_str(&cable);
    }
    Robot::from_toml(&text).unwrap()
}

/// Sequence without pattern, in [0, 1).
fn spread(i: usize, k: usize) -> f64 {
    const ROOTS: [f64; 8] =
        [1.414213562, 1.732050808, 2.236067977, 2.645751311, 3.316624790, 3.605551275, 4.123105626, 4.358898944];
    ((i as f64 + 1.0) * ROOTS[k]).fract()
}

/// Pose number `i` around a point, within these distances [m] and this angle [degrees].
fn pose(i: usize, middle: [f64; 3], reach: [f64; 3], angle: f64) -> Pose {
    let part = |k: usize| 2.0 * spread(i, k) - 1.0;
    Pose::new(std::array::from_fn(|k| middle[k] + reach[k] * part(k)), std::array::from_fn(|k| angle * part(k + 3)))
}

fn cogiro_pose(i: usize) -> Pose {
    pose(i, [0.0, 0.0, 2.2], [6.5, 4.5, 2.0], 20.0)
}

fn seven_pose(i: usize) -> Pose {
    pose(i, [0.0, 0.0, 1.5], [0.9, 0.9, 0.7], 10.0)
}

/// Checks balance and limits from the forces and the curves alone.
fn check(robot: &Robot, held: &Equilibrium) {
    let g = robot.gravity_w * robot.platform.mass;
    let moment = (held.pose.rot_wp * robot.platform.center_of_mass_p).cross(&g);
    let (mut force, mut turning, mut size) = (g, moment, g.norm());
    for (i, cable) in held.cables.iter().enumerate() {
        force += cable.force_on_platform_w;
        turning += cable.lever_w.cross(&cable.force_on_platform_w);
        size += cable.force_on_platform_w.norm();
        let limits = robot.cables[i].limits();
        let (least, greatest) = match &cable.hanging {
            // All tensions along the curve, not only those at its ends.
            Some(hanging) => (0..=100).fold((f64::INFINITY, 0.0_f64), |(least, most), k| {
                let t = hanging.catenary.tension_at(cable.unstrained_length * f64::from(k) / 100.0);
                (least.min(t), most.max(t))
            }),
            None => (cable.tension_platform, cable.tension_anchor),
        };
        assert!(least >= limits.minimum.unwrap() * (1.0 - 1e-6), "{least} < {:?}", limits.minimum);
        assert!(greatest <= limits.maximum.unwrap() * (1.0 + 1e-6), "{greatest} > {:?}", limits.maximum);
    }
    if robot.platform.motion == PlatformMotion::PointMass {
        turning = Vec3::zeros();
    }
    if matches!(robot.platform.motion, PlatformMotion::Planar(_)) {
        // The planar robot is horizontal: its guide carries the rest.
        (force.z, turning.x, turning.y) = (0.0, 0.0, 0.0);
    }
    let left = force.norm().max(turning.norm() / robot.platform_length()) / size;
    assert!(left <= 1e-10 && held.residual <= statics::RESIDUAL_LIMIT, "{left:e}");
}

fn tau(held: &Equilibrium) -> Vec<f64> {
    held.cables
        .iter()
        .map(|c| c.hanging.as_ref().map_or(c.tension_platform, |h| h.catenary.parallel_tension()))
        .collect()
}

fn min_stiffness(held: &Equilibrium) -> f64 {
    match held.stability {
        Stability::Stable { min_stiffness } | Stability::Unstable { min_stiffness, .. } => min_stiffness,
        Stability::Rigid => panic!("elastic"),
    }
}
