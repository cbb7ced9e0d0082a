//! Equilibria at held unstrained lengths.

use funicular::robot::{Load, Pose, Robot, State};
use funicular::statics::{self, StaticModel, TensionRule};

fn robots() -> Vec<(&'static str, Pose)> {
    vec![
        (funicular_robots::YUAN2014_4MM, Pose::new([0.3, 0.1, 0.6], [0.0, 2.0, 0.0])),
        (funicular_robots::COGIRO, Pose::new([1.0, 2.0, 1.5], [0.0, 0.0, 5.0])),
        (funicular_robots::IPANEMA2, Pose::new([0.0, 0.0, 1.0], [0.0; 3])),
    ]
}

/// Limit: without any change the platform rests where it was.
#[test]
fn held_lengths_of_the_same_robot_hold_the_pose() {
    for (text, pose) in robots() {
        let robot = Robot::from_toml(text).unwrap();
        let state = State::Pose(pose);
        let held = statics::solve_at(&robot, &state, StaticModel::Catenary, &TensionRule::Lowest).unwrap();
        let rest = statics::solve_held_at(&robot, &robot, &state, StaticModel::Catenary, &TensionRule::Lowest).unwrap();
        let moved = statics::pose_distance(&robot, &rest.equilibrium.pose, &pose);
        assert!(moved < 1e-9, "{}: {moved:e} m", robot.name);
        assert_eq!(rest.held_pose, Some(pose));
        assert_eq!(rest.rule, held.rule);
    }
}

/// Oracle: the static stiffness, whose inverse gives the displacement under a small force.
#[test]
fn a_small_force_at_held_lengths_moves_the_platform_by_the_compliance() {
    for (text, pose) in robots() {
        let robot = Robot::from_toml(text).unwrap();
        let state = State::Pose(pose);
        let solved = |of: &Robot| {
            statics::solve_held_at(&robot, of, &state, StaticModel::Catenary, &TensionRule::Lowest).unwrap().equilibrium
        };
        let stiffness = statics::tangent_stiffness(&robot, &solved(&robot)).unwrap();
        let own = robot.load;
        let force = 1e-3 * robot.platform.mass;
        let lighter = robot.with_load(Load { force_w: own.force_w - funicular::math::Vec3::z() * force, ..own });
        let heavier = robot.with_load(Load { force_w: own.force_w + funicular::math::Vec3::z() * force, ..own });

        // Load changes keep the load of the file at its point: the wrench is a force at that point.
        let lever = pose.rot_wp * own.point_p;
        let moment = lever.cross(&funicular::math::Vec3::z());
        let wrench = funicular::math::Vec6::new(0.0, 0.0, 1.0, moment.x, moment.y, moment.z) * (2.0 * force);
        let expected = stiffness.lu().solve(&wrench).unwrap();
        let moved = solved(&heavier).pose.position_w - solved(&lighter).pose.position_w;
        // Central differences: the error is of second order in a force of a ten thousandth of the weight.
        let error = (moved - expected.fixed_rows::<3>(0)).norm();
        assert!(error < 1e-4 * moved.norm(), "{}: {error:e} of {:e} m", robot.name, moved.norm());
    }
}

/// The lengths are those of the robot without the change.
#[test]
fn the_lengths_of_the_holder_are_held() {
    for (text, pose) in robots() {
        let robot = Robot::from_toml(text).unwrap();
        let state = State::Pose(pose);
        let rule = TensionRule::Lowest;
        let before = statics::solve_at(&robot, &state, StaticModel::Catenary, &rule).unwrap().equilibrium;
        let heavier = robot.with_mass(1.5 * robot.platform.mass);
        let after = statics::solve_held_at(&robot, &heavier, &state, StaticModel::Catenary, &rule).unwrap().equilibrium;
        for (one, other) in before.cables.iter().zip(&after.cables) {
            assert_eq!(one.unstrained_length.to_bits(), other.unstrained_length.to_bits());
        }
        assert!(after.pose.position_w.z < before.pose.position_w.z);
    }
}
