//! Derivatives of the centre by time, of both orders, against differences of the eighth order; and the proof that the
//! centre is the only one, on many poses.

use super::{POINT, changed, cogiro, cogiro_pose, pose, seven_cables, seven_pose, spread};
use crate::library::library;
use funicular::catenary::Rope;
use funicular::catenary::space::HangingCable;
use funicular::math::{Rotation, Vec3, Vec6};
use funicular::robot::{Pose, Robot, TensionLimits};
use funicular::statics::{self, CentreMotion, StaticModel, TensionCentre, centre_rates, tension_centre};

/// Motion with numbers without pattern.
fn motion_of(robot: &Robot, size: f64, seed: usize) -> CentreMotion {
    let weight = robot.platform.mass * robot.gravity_w.norm();
    let motion = robot.platform.motion;
    let six = |k: usize, linear: f64, angular: f64| {
        let part = |i: usize| 2.0 * spread(seed + 31 * k, i) - 1.0;
        motion.allowed(&Vec6::from_fn(|i, _| part(i) * if i < 3 { linear } else { angular }))
    };
    CentreMotion {
        velocity_w: six(1, 0.3 * size, 0.2),
        acceleration_w: six(2, 0.3 * size, 0.2),
        load_rate_w: six(3, 0.02 * weight, 0.004 * weight * size),
        load_acceleration_w: six(4, 0.02 * weight, 0.004 * weight * size),
    }
}

/// Centre at a time of a motion.
fn at(robot: &Robot, pose: &Pose, model: StaticModel, motion: &CentreMotion, time: f64) -> Option<TensionCentre> {
    let part = |of: Vec6, first: usize| Vec3::new(of[first], of[first + 1], of[first + 2]);
    let change = motion.velocity_w * time + motion.acceleration_w * (0.5 * time * time);
    let load = motion.load_rate_w * time + motion.load_acceleration_w * (0.5 * time * time);
    let there = Pose {
        position_w: pose.position_w + part(change, 0),
        rot_wp: Rotation::from_scaled_axis(part(change, 3)) * pose.rot_wp,
    };
    let mut loaded = robot.clone();
    // The load of the file acts at its point, which turns with the platform; the change acts at the origin.
    let arm = there.rot_wp * robot.load.point_p;
    loaded.load.force_w += part(load, 0);
    loaded.load.moment_w += part(load, 3) - arm.cross(&part(load, 0));
    tension_centre(&loaded, &there, model, None).ok()
}

/// First and second derivatives by differences of the eighth order.
fn differences(of: impl Fn(f64) -> Option<f64>, step: f64) -> Option<[f64; 2]> {
    let here = of(0.0)?;
    let (mut first, mut second) = (0.0, -205.0 / 72.0 * here);
    let weights =
        [(4.0 / 5.0, 8.0 / 5.0), (-1.0 / 5.0, -1.0 / 5.0), (4.0 / 105.0, 8.0 / 315.0), (-1.0 / 280.0, -1.0 / 560.0)];
    for (k, (odd, even)) in (1_u8..).zip(weights) {
        let [before, after] = [of(-f64::from(k) * step)?, of(f64::from(k) * step)?];
        first += odd * (after - before);
        second += even * (after + before);
    }
    Some([first / step, second / (step * step)])
}

/// Pose by its number.
type PoseByNumber = fn(usize) -> Pose;

/// Robots with everything that derivatives follow: limits of all kinds, pulleys with upright and with inclined axes,
/// winches that yield, wind on ropes, loads beside the origin, fewer degrees of freedom, ropes without weight.
fn robots() -> Vec<(&'static str, Robot, PoseByNumber, StaticModel)> {
    let winches = Robot::from_toml(funicular_robots::COGIRO_WINCHES).unwrap();
    let inside = |i| pose(i, [0.0, 0.0, 1.8], [2.5, 1.5, 0.8], 4.0);
    let mut inclined = winches.clone();
    for (i, cable) in inclined.cables.iter_mut().enumerate() {
        let pulley = cable.anchor.pulley.as_mut().unwrap();
        let turn = Rotation::from_scaled_axis(Vec3::new(0.15, 0.1 * spread(i, 0), 0.0));
        pulley.entry_direction_w = turn * pulley.entry_direction_w;
    }
    let mut windy = winches.clone();
    windy.wind.velocity_w = Vec3::new(9.0, -6.0, 1.0);
    windy.wind.air_density = 1.2;
    windy.cables.iter_mut().for_each(|cable| cable.material.drag_width = Some(0.01));
    let mut fixed_windy = cogiro(0.064, 100.0, 5000.0);
    fixed_windy.wind = windy.wind;
    fixed_windy.cables.iter_mut().for_each(|cable| cable.material.drag_width = Some(0.01));
    fixed_windy.load.force_w = Vec3::new(40.0, -30.0, 10.0);
    fixed_windy.load.point_p = Vec3::new(0.2, -0.1, 0.3);
    let mut default_minimum = cogiro(0.64, 0.0, 3000.0);
    default_minimum = default_minimum.with_tension_limits(TensionLimits::default());
    for cable in &mut default_minimum.cables {
        cable.tension_limits.minimum = None;
        cable.material.tension_limits.minimum = None;
    }
    let planar = Robot::from_toml(funicular_robots::KNTU_PLANAR).unwrap();
    let planar = planar.with_tension_limits(TensionLimits { minimum: Some(1.0), maximum: Some(60.0) });
    let catenary = StaticModel::Catenary;
    vec![
        ("cogiro", cogiro(0.064, 100.0, 5000.0), inside, catenary),
        ("heavy ropes as slack as may be", cogiro(0.64, 0.0, 2000.0), inside, catenary),
        ("default minimum", default_minimum, inside, catenary),
        ("springs", cogiro(0.064, 100.0, 5000.0), inside, StaticModel::Spring),
        ("wind", fixed_windy, inside, catenary),
        ("seven cables", seven_cables(0.02, 10.0, 500.0), seven_pose, catenary),
        (
            "point mass",
            changed(Robot::from_toml(POINT).unwrap(), 0.0256, 20.0, 400.0),
            |i| Pose::new([1.0 + 0.3 * spread(i, 0), 1.0 + 0.3 * spread(i, 1), 1.0 + 0.3 * spread(i, 2)], [0.0; 3]),
            catenary,
        ),
        ("planar", planar, |i| Pose::new([0.2 * spread(i, 0), 0.2 * spread(i, 1), 0.0], [0.0; 3]), catenary),
        ("pulleys", winches, inside, catenary),
        ("inclined pulleys", inclined, inside, catenary),
        ("pulleys in wind", windy, inside, catenary),
    ]
}

/// Both derivatives of lengths and tensions; the differences have an error of 1e-12 of the first and, from rounding,
/// 1e-9 of the second.
#[test]
fn rates_and_accelerations_are_those_of_differences() {
    for (name, robot, pose_of, model) in robots() {
        let size = robot.platform_length();
        let (mut compared, mut worst) = (0, [0.0_f64; 6]);
        for i in 0..4 {
            let (pose, motion) = (pose_of(i), motion_of(&robot, size, i));
            let Ok(here) = tension_centre(&robot, &pose, model, None) else { continue };
            let found = centre_rates(&robot, &here, &motion).unwrap();
            let step = 1e-2;
            for k in 0..robot.cables.len() {
                let of = |value: &dyn Fn(&TensionCentre) -> f64| {
                    differences(|time| at(&robot, &pose, model, &motion, time).map(|there| value(&there)), step)
                };
                let wanted = [
                    of(&|there| there.equilibrium.cables[k].unstrained_length),
                    of(&|there| there.equilibrium.cables[k].tension_platform),
                    of(&|there| there.tensions[k]),
                ];
                let of_all = |which: fn(&statics::CentreRates) -> [f64; 2], order: usize| {
                    found.iter().fold(0.0, |most: f64, rates| most.max(which(rates)[order].abs()))
                };
                let parts: [fn(&statics::CentreRates) -> [f64; 2]; 3] =
                    [|rates| rates.length, |rates| rates.tension_platform, |rates| rates.tension_parallel];
                for (which, (part, wanted)) in parts.iter().zip(wanted).enumerate() {
                    let Some(wanted) = wanted else { continue };
                    for order in 0..2 {
                        let error = (part(&found[k])[order] - wanted[order]).abs() / of_all(*part, order);
                        worst[2 * which + order] = worst[2 * which + order].max(error);
                    }
                    compared += 1;
                }
            }
        }
        println!("{name}: {compared}, {worst:?}");
        assert!(compared >= 3 * robot.cables.len(), "{name}: {compared}");
        for (k, error) in worst.iter().enumerate() {
            assert!(*error < [1e-10, 1e-8][k % 2], "{name}: {worst:?}");
        }
    }
}

/// Lagrangian of a cable at τ: the logarithms less `y` times its wrench, from the curve alone.
struct OneCable {
    span: HangingCable,
    lever_w: Vec3,
    /// Multipliers of force and of moment.
    multipliers: [Vec3; 2],
    limits: [f64; 2],
}

impl OneCable {
    fn value(&self, tau: f64) -> f64 {
        let (span, rope) = (&self.span, self.span.catenary.rope());
        let up_w = span.axes_w().1;
        let hung = |length: f64| {
            HangingCable::new(span.start_w, span.end_w, up_w, Rope { unstrained_length: length, ..rope }).unwrap()
        };
        // The parallel tension falls with the length.
        let chord = span.chord_w().norm();
        let (mut short, mut long) = (0.5 * chord, 3.0 * chord);
        for _ in 0..80 {
            let middle = 0.5 * (short + long);
            if hung(middle).catenary.parallel_tension() > tau { short = middle } else { long = middle }
        }
        let force_w = hung(short).force_on_start_w();
        let balanced = self.multipliers[0].dot(&force_w) + self.multipliers[1].dot(&self.lever_w.cross(&force_w));
        -(tau - self.limits[0]).ln() - (self.limits[1] - tau).ln() - balanced
    }
}

/// Weak duality: where the certificate holds, the tension of each cable minimises its part of the Lagrangian between
/// its limits, computed without any derivative. Ten thousand poses have the certificate; every hundredth is looked at.
#[test]
fn the_certificate_holds_on_ten_thousand_poses_and_its_tensions_are_the_lowest() {
    let (mut certified, mut without, mut looked_at) = (0, 0, 0);
    let mut robots: Vec<(String, Robot, Pose)> = library()
        .into_iter()
        .filter(|(_, robot, _)| robot.constraint().is_redundant() && !robot.has_supports())
        .map(|(name, robot, rest)| {
            let highest = rest.cables.iter().map(|cable| cable.tension_platform).fold(0.0, f64::max);
            let has_maximum = robot.cables.iter().all(|cable| cable.limits().maximum.is_some());
            let limits = TensionLimits { minimum: None, maximum: Some(3.0 * highest) };
            (name, if has_maximum { robot } else { robot.with_tension_limits(limits) }, rest.pose)
        })
        .collect();
    assert!(robots.len() >= 5, "{}", robots.len());
    robots.sort_by_key(|(_, robot, _)| robot.cables.iter().filter(|cable| cable.anchor.pulley.is_some()).count());
    let each = 12_000 / robots.len();
    for (name, robot, home) in &robots {
        let (size, motion) = (robot.platform_length(), robot.platform.motion);
        let mut most = 0.0_f64;
        for i in 0..each {
            let part = |k: usize| 2.0 * spread(i, k) - 1.0;
            let step = motion.allowed(&Vec6::from_fn(|k, _| part(k) * if k < 3 { 0.8 * size } else { 0.1 }));
            let pose = home.moved(&Vec3::new(step[0], step[1], step[2]), &Vec3::new(step[3], step[4], step[5]));
            let Ok(found) = tension_centre(robot, &pose, StaticModel::Catenary, None) else {
                without += 1;
                continue;
            };
            most = most.max(found.certificate.curvature);
            assert!(found.certificate.is_unique(), "{name}, {i}: {:?}", found.certificate);
            certified += 1;
            let is_fixed = robot.cables.iter().all(|cable| cable.anchor.pulley.is_none());
            if i % 100 == 0 && is_fixed {
                check_lowest(robot, &found, name);
                looked_at += 1;
            }
        }
        println!("{name}: curvature at most {most:.1e}");
    }
    assert!(certified >= 10_000 && looked_at > 50, "{certified} {without} {looked_at}");
}

fn check_lowest(robot: &Robot, found: &TensionCentre, name: &str) {
    let reduced = Vec6::from_fn(|k, _| found.multipliers.get(k).copied().unwrap_or(0.0));
    let expanded = robot.platform.motion.expanded(&reduced);
    let ell = robot.platform_length();
    let multipliers =
        [Vec3::new(expanded[0], expanded[1], expanded[2]), Vec3::new(expanded[3], expanded[4], expanded[5]) / ell];
    for (k, state) in found.equilibrium.cables.iter().enumerate() {
        let (span, limits) = (state.hanging.clone().unwrap(), found.limits[k]);
        if span.catenary.rope().weight_per_length == 0.0 {
            continue;
        }
        let cable = OneCable { span, lever_w: state.lever_w, multipliers, limits };
        let best = cable.value(found.tensions[k]);
        for place in 1..12 {
            let tau = limits[0] + (limits[1] - limits[0]) * f64::from(place) / 12.0;
            let other = cable.value(tau);
            assert!(other >= best - 1e-9 * (1.0 + best.abs()), "{name}, cable {k}: {other} {best}");
        }
    }
}

/// Ropes so heavy, and a load so near to what they hold, that the bound fails; with still heavier ones the convexity
/// fails as well, and no certificate is given.
#[test]
fn heavy_slack_ropes_have_no_certificate() {
    let (mut by_places, mut without) = (0, 0);
    for mass in [0.064, 1.0, 2.0, 4.0, 8.0] {
        for i in 0..60 {
            let robot = cogiro(mass, 0.0, 20_000.0);
            let Ok(found) = tension_centre(&robot, &cogiro_pose(i), StaticModel::Catenary, None) else { continue };
            let proof = found.certificate;
            if mass < 0.1 {
                assert!(proof.is_unique() && proof.convexity.is_none(), "{proof:?}");
            }
            by_places += usize::from(proof.is_unique() && proof.convexity.is_some());
            without += usize::from(!proof.is_unique());
        }
    }
    println!("{by_places} by places, {without} without");
    assert!(by_places > 0 && without > 0, "{by_places} {without}");
}
