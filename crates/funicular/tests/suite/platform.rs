//! Forces and moments on the platform: dead loads, their balance and their stiffness.

use crate::random::any_robot;
use funicular::cable::CableModel;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Mat6, Vec3, Vec6};
use funicular::modes;
use funicular::robot::{Load, PlatformMotion, Pose, Robot, State};
use funicular::statics::{self, Equilibrium, Stability, StaticModel, TensionRule};
use proptest::prelude::*;
use std::f64::consts::TAU;

const YUAN: &str = funicular_robots::YUAN2014_4MM;

const CAMERA: &str = funicular_robots::SAP2000_8_CABLE_POINT_MASS;

fn yuan() -> (Robot, Vec<f64>) {
    let robot = Robot::from_toml(YUAN).unwrap();
    let State::Lengths(lengths) = robot.state.clone() else { panic!("given by lengths") };
    (robot, lengths)
}

fn lengths_of(equilibrium: &Equilibrium) -> Vec<f64> {
    equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect()
}

#[test]
fn a_force_at_the_centre_of_mass_is_weight() {
    let (robot, lengths) = yuan();
    let more = 7.5;
    let center = robot.platform.center_of_mass_p;
    let loaded = robot.with_load(Load { force_w: robot.gravity_w * more, point_p: center, ..Load::default() });
    let heavier = robot.with_mass(robot.platform.mass + more);
    for model in [StaticModel::Ideal, StaticModel::Spring, StaticModel::Catenary] {
        let [a, b] = [&loaded, &heavier].map(|robot| statics::forward(robot, &lengths, model, None).unwrap());
        assert!(statics::pose_distance(&robot, &a.pose, &b.pose) < 1e-10, "{model:?}");
        for (a, b) in a.cables.iter().zip(&b.cables) {
            assert!((a.tension_platform - b.tension_platform).abs() < 1e-7);
        }
        if let (Some(k), Some(expected)) =
            (statics::tangent_stiffness(&loaded, &a), statics::tangent_stiffness(&heavier, &b))
        {
            assert!((k - expected).amax() < 1e-6 * expected.amax());
        }
    }
}

#[test]
fn a_pulled_bifilar_pendulum_swings_faster_and_its_lever_counts() {
    let (mass, inertia, length, pull, lever) = (6.0, 0.35, 2.0, 40.0, 0.3);
    let text = format!(
        "name = \"swing\"\n[platform]\nmotion = \"planar-xz\"\nmass_kg = {mass}\ninertia_kg_m2 = {inertia}\n\
         [materials.rope]\naxial_stiffness_n = 3e9\nmass_kg_per_m = 0\n\
         [[cables]]\nname = \"1\"\nmaterial = \"rope\"\nanchor_m = [0, 0, {length}]\nattachment_m = [0, 0, 0]\n\
         [loads]\nforce_n = [0, 0, {}]\npoint_m = [0, 0, {}]\n",
        -pull, -lever
    );
    let robot = Robot::from_toml(&text).unwrap();
    let rest = statics::forward(&robot, &[length], StaticModel::Spring, None).unwrap();
    let linearisation = Linearisation { cable_model: CableModel::CatenaryStatic, ..Default::default() };
    let found = modes::below(&Dynamics::about(&robot, &rest, linearisation, 20.0).unwrap(), 20.0);
    // The body turns under the force alone; its centre swings under force and weight: two pendulums.
    let tension: f64 = mass * 9.81 + pull;
    let mut expected = [tension / (length * mass), pull * lever / inertia].map(|x: f64| x.sqrt() / TAU);
    expected.sort_by(f64::total_cmp);
    assert_eq!(found.modes.len(), 2, "{found:?}");
    for (mode, expected) in found.modes.iter().zip(expected) {
        assert!((mode.frequency_hz / expected - 1.0).abs() < 1e-6, "{} {expected}", mode.frequency_hz);
    }
}

#[test]
fn a_moment_is_a_force_beside_the_origin_to_statics_and_not_to_stiffness() {
    let (robot, lengths) = yuan();
    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
    let (force_w, point_p) = (Vec3::new(6.0, -4.0, -20.0), Vec3::new(0.05, 0.02, -0.1));
    let moment_w = (rest.pose.rot_wp * point_p).cross(&force_w);
    let beside = robot.with_load(Load { force_w, point_p, ..Load::default() });
    let moved = robot.with_load(Load { force_w, moment_w, ..Load::default() });
    let [a, b] = [&beside, &moved].map(|robot| statics::inverse(robot, &rest.pose, StaticModel::Catenary).unwrap());
    for (a, b) in a.cables.iter().zip(&b.cables) {
        assert!((a.unstrained_length - b.unstrained_length).abs() < 1e-10);
        assert!((a.tension_platform - b.tension_platform).abs() < 1e-6);
    }
    let [k, l] = [(&beside, &a), (&moved, &b)].map(|(robot, at)| statics::tangent_stiffness(robot, at).unwrap());
    assert!((k - k.transpose()).amax() < 1e-8 * k.amax() && (l - l.transpose()).amax() < 1e-8 * l.amax());
    // Theory, (48): the force turns on its lever; of the moment only the half that makes the sum symmetric counts.
    let skew = funicular::math::skew;
    let expected = -skew(&force_w) * skew(&(rest.pose.rot_wp * point_p)) - skew(&moment_w) * 0.5;
    let difference = (k - l).fixed_view::<3, 3>(3, 3).clone_owned();
    assert!((difference - expected).amax() < 1e-6 * k.amax(), "{difference} {expected}");
    // Forward statics finds both again.
    for (robot, at) in [(&beside, &a), (&moved, &b)] {
        let back = statics::forward(robot, &lengths_of(at), StaticModel::Catenary, None).unwrap();
        assert!(statics::pose_distance(robot, &back.pose, &rest.pose) < 1e-8);
    }
}

#[test]
fn forces_pull_a_point_mass_and_a_redundant_robot() {
    let camera = Robot::from_toml(CAMERA).unwrap();
    let State::Lengths(lengths) = camera.state.clone() else { panic!("given by lengths") };
    let pose = statics::forward(&camera, &lengths, StaticModel::Catenary, None).unwrap().pose;
    let pulled = camera.with_load(Load { force_w: Vec3::new(30.0, -20.0, 10.0), ..Load::default() });
    let [free, held] = [&camera, &pulled]
        .map(|robot| statics::distribute_tensions(robot, &pose, StaticModel::Catenary, &TensionRule::Lowest).unwrap());
    let sum = |e: &Equilibrium| e.cables.iter().map(|c| c.force_on_platform_w).sum::<Vec3>();
    assert!((sum(&free) - sum(&held) - pulled.load.force_w).norm() < 1e-6);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 80, failure_persistence: None, ..Default::default() })]

    /// Any load: the pose found balances it, the stiffness is symmetric, and its symmetric part is the derivative of
    /// the wrench.
    #[test]
    fn any_loaded_robot_balances_and_its_stiffness_is_the_differential(
        (robot, lengths) in any_robot(),
        force in prop::array::uniform3(-1.0f64..1.0), moment in prop::array::uniform3(-1.0f64..1.0),
        point in prop::array::uniform3(-0.4f64..0.4), size in 0.0f64..0.5, turning in 0.0f64..0.05,
    ) {
        let weight = robot.platform.mass * 9.81;
        let load = Load {
            force_w: Vec3::from(force) * (size * weight),
            moment_w: Vec3::from(moment) * (turning * weight * robot.platform_length()),
            point_p: Vec3::from(point),
        };
        let robot = robot.with_load(load);
        prop_assert_eq!(robot.platform.motion, PlatformMotion::Rigid);
        let Ok(rest) = statics::forward(&robot, &lengths, StaticModel::Catenary, None) else {
            return Err(TestCaseError::reject("a moment may spin a robot whose cables hang"));
        };
        let wrench = |pose: &Pose| statics::wrench(&robot, pose, &lengths, StaticModel::Catenary).unwrap();
        let forces: f64 = rest.cables.iter().map(|c| c.tension_platform).sum::<f64>() + weight;
        prop_assert!(wrench(&rest.pose).amax() < 1e-9 * forces.max(1.0));
        let k = statics::tangent_stiffness(&robot, &rest).unwrap();
        prop_assert!((k - k.transpose()).amax() < 1e-9 * k.amax().max(forces));
        let h = 1e-6;
        let columns: Vec<Vec6> = (0..6)
            .map(|i| {
                let at = |step: f64| {
                    let d = Vec6::ith(i, step);
                    wrench(&rest.pose.moved(&Vec3::new(d[0], d[1], d[2]), &Vec3::new(d[3], d[4], d[5])))
                };
                (at(-h) - at(h)) / (2.0 * h)
            })
            .collect();
        let slope = Mat6::from_columns(&columns);
        let symmetric = (slope + slope.transpose()) * 0.5;
        prop_assert!((symmetric - k).amax() < 2e-4 * k.amax().max(forces), "{}", symmetric - k);
        if matches!(rest.stability, Stability::Stable { .. }) {
            let dynamics = Dynamics::about(&robot, &rest, Linearisation { cable_model: CableModel::CatenaryStatic,
                ..Default::default() }, 1.0).unwrap();
            let stiffness = dynamics.stiffness(0.0).map(|z| z.re);
            prop_assert!((stiffness - k).amax() < 1e-9 * k.amax().max(forces));
        }
    }
}
