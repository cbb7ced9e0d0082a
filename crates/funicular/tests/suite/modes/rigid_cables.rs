//! Modes of robots on rigid cables: against pendulums, against stiff springs, and the statics that they start from.

use crate::statics::crane;
use funicular::cable::CableModel;
use funicular::dynamics::Linearisation;
use funicular::modes::{self, Modes, RigidCablesError};
use funicular::robot::{Robot, State};
use funicular::statics::{self, Equilibrium, Stability, StaticModel};
use std::f64::consts::TAU;

/// Robot with its lengths.
fn load(text: &str) -> (Robot, Vec<f64>) {
    let robot = Robot::from_toml(text).unwrap();
    let State::Lengths(lengths) = robot.state.clone() else { panic!("given by lengths") };
    (robot, lengths)
}

/// Robots with fewer cables than degrees of freedom: over pulleys and at fixed points.
fn few() -> Vec<(Robot, Vec<f64>)> {
    let pulleys = [funicular_robots::GRAB_2_CABLES, funicular_robots::GRAB_3_CABLES, funicular_robots::GRAB_4_CABLES];
    let cranes = [2, 4].map(|cables| (crane(cables, 0.0), vec![5.0; cables]));
    pulleys.map(load).into_iter().chain(cranes).collect()
}

fn rigid(robot: &Robot, rest: &Equilibrium) -> Modes {
    modes::with_rigid_cables(robot, rest, 1e3).unwrap()
}

/// Modes of the robot with cables that stretch, EA multiplied by `factor`, the lengths stretched as the rigid ones.
fn stiff(robot: &Robot, lengths: &[f64], factor: f64, count: usize) -> (Equilibrium, Vec<f64>) {
    let mut robot = robot.clone();
    for cable in &mut robot.cables {
        cable.material.axial_stiffness *= factor;
    }
    let rest = statics::forward(&robot, lengths, StaticModel::Spring, None).unwrap();
    let linearisation = Linearisation { cable_model: CableModel::CatenaryStatic, ..Linearisation::default() };
    let (_, found) = modes::lowest(&robot, &rest, linearisation, count, 1e6).unwrap();
    (rest, found.modes.iter().take(count).map(|mode| mode.frequency_hz).collect())
}

#[test]
fn a_double_pendulum_of_two_parallel_cables_swings_as_in_closed_form() {
    // A body on two vertical cables of 2 m: along the line of its attachments it does not turn, so that it is a
    // pendulum of the cables' length.
    let text = r#"
        name = "swing"
        [platform]
        mass_kg = 3.0
        inertia_kg_m2 = [0.2, 0.3, 0.4]
        center_of_mass_m = [0.0, 0.0, -0.1]
        [materials.cord]
        axial_stiffness_n = 1e5
        mass_kg_per_m = 0.0
        [[cables]]
        name = "1"
        material = "cord"
        anchor_m = [0.5, 0.0, 3.0]
        attachment_m = [0.5, 0.0, 0.0]
        unstrained_length_m = 2.0
        [[cables]]
        name = "2"
        material = "cord"
        anchor_m = [-0.5, 0.0, 3.0]
        attachment_m = [-0.5, 0.0, 0.0]
        unstrained_length_m = 2.0
    "#;
    let (robot, lengths) = load(text);
    let rest = statics::forward(&robot, &lengths, StaticModel::Ideal, None).unwrap();
    assert!((rest.pose.position_w.z - 1.0).abs() < 1e-13 && rest.residual < 1e-12);
    let found = rigid(&robot, &rest);
    assert!(found.certified && found.modes.len() == 4 && found.unstable_directions == 0);

    // Along x: g/l. About z: m g a²/(I l). Across, with the angles of cables and body: a double pendulum,
    // [m l², m l c; m l c, I + m c²] and [m g l, m g c].
    let (g, l, c, m, i): (f64, f64, f64, f64, f64) = (9.81, 2.0, 0.1, 3.0, 0.2);
    let (m11, m12, m22, k1, k2) = (m * l * l, m * l * c, i + m * c * c, m * g * l, m * g * c);
    // det(K − x M) = a x² − b x + k1 k2.
    let (a, b) = (m11 * m22 - m12 * m12, k1 * m22 + k2 * m11);
    let root = (b * b - 4.0 * a * k1 * k2).sqrt();
    let mut squares = [g / l, m * g * 0.25 / (0.4 * l), (b - root) / (2.0 * a), (b + root) / (2.0 * a)];
    squares.sort_by(f64::total_cmp);
    for (mode, square) in found.modes.iter().zip(squares) {
        let exact = square.sqrt() / TAU;
        assert!((mode.frequency_hz / exact - 1.0).abs() < 1e-11, "{} against {exact}", mode.frequency_hz);
    }
}

#[test]
fn rigid_cables_are_the_limit_of_stiff_springs() {
    for (robot, lengths) in few() {
        let rest = statics::forward(&robot, &lengths, StaticModel::Ideal, None).unwrap();
        let found = rigid(&robot, &rest);
        let count = robot.platform.motion.count() - robot.cables.len();
        assert!(found.certified && found.modes.len() == count, "{}", robot.name);

        // The difference falls with 1/EA; a factor of ten leaves a tenth of it.
        let differences = [1e2, 1e3].map(|factor| {
            let (near, frequencies) = stiff(&robot, &lengths, factor, count);
            let moved = (near.pose.position_w - rest.pose.position_w).norm();
            let pairs = frequencies.iter().zip(&found.modes);
            let off = pairs.fold(0.0_f64, |most, (hz, mode)| most.max((hz / mode.frequency_hz - 1.0).abs()));
            (moved, off)
        });
        let [(far, off), (near, less)] = differences;
        assert!(near < 0.11 * far && near < 1e-4, "{}: {far} m, {near} m", robot.name);
        assert!(less < 0.11 * off && less < 1e-4, "{}: {off}, {less}", robot.name);
    }
}

#[test]
fn an_equilibrium_of_springs_has_the_modes_of_rigid_cables_at_any_stiffness() {
    // The forces of straight cables at a pose do not depend on their stiffness.
    for (mut robot, lengths) in few() {
        let rest = statics::forward(&robot, &lengths, StaticModel::Ideal, None).unwrap();
        let exact = rigid(&robot, &rest);
        robot.state = State::Pose(rest.pose);
        let held = statics::solve(&robot, StaticModel::Spring, None).unwrap().equilibrium;
        let found = rigid(&robot, &held);
        for (ours, theirs) in found.modes.iter().zip(&exact.modes) {
            assert!((ours.frequency_hz / theirs.frequency_hz - 1.0).abs() < 1e-9, "{}", robot.name);
        }
    }
}

#[test]
fn few_rigid_cables_come_back_from_their_pose_to_their_lengths() {
    for (mut robot, lengths) in few() {
        let rest = statics::forward(&robot, &lengths, StaticModel::Ideal, None).unwrap();
        assert!(rest.residual < 1e-10 && rest.stability == Stability::Rigid, "{}", robot.name);
        for ((cable, state), length) in robot.cables.iter().zip(&rest.cables).zip(&lengths) {
            // The search ends at 1e-10 of the longest length or below.
            let gap = cable.straight_length(&rest.pose) - length;
            assert!(
                gap.abs() < 1e-10 * length && !state.is_slack(),
                "{}: {gap} m, {} N",
                robot.name,
                state.tension_platform
            );
        }
        robot.state = State::Pose(rest.pose);
        let back = statics::solve(&robot, StaticModel::Ideal, None).unwrap();
        assert!(back.requested_pose.unwrap().1 < 1e-9, "{}", robot.name);
        for (cable, length) in back.equilibrium.cables.iter().zip(&lengths) {
            assert!((cable.unstrained_length - length).abs() < 1e-9, "{}", robot.name);
        }
    }
}

#[test]
fn a_slack_cable_holds_nothing() {
    let (robot, mut lengths) = load(funicular_robots::GRAB_4_CABLES);
    lengths[1] += 1.0;
    lengths[3] += 1.0;
    let rest = statics::forward(&robot, &lengths, StaticModel::Ideal, None).unwrap();
    assert!(rest.cables[1].is_slack() && rest.cables[3].is_slack());
    assert_eq!(rigid(&robot, &rest).modes.len(), 4);
}

#[test]
fn as_many_rigid_cables_as_degrees_of_freedom_leave_no_motion_free() {
    let (robot, lengths) = load(funicular_robots::YUAN2014_4MM);
    let rest = statics::forward(&robot, &lengths, StaticModel::Ideal, None).unwrap();
    let found = rigid(&robot, &rest);
    assert!(found.certified && found.modes.is_empty() && found.count_below == 0);
}

#[test]
fn sagging_cables_are_refused() {
    let (robot, lengths) = load(funicular_robots::YUAN2014_4MM);
    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
    let error = modes::with_rigid_cables(&robot, &rest, 10.0).unwrap_err();
    assert!(error == RigidCablesError::Sagging && error.to_string().contains("static model `ideal`"));
}
