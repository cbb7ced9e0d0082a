//! Every robot of robots/ comes to rest, within its limits, and its modes are certified.

use funicular::dynamics::{Dynamics, Linearisation};
use funicular::modes;
use funicular::robot::{Freedoms, Robot, State};
use funicular::statics::{self, Equilibrium, Stability, StaticModel, TensionRule};
use funicular::validity;

/// Every robot by its file's name, and its equilibrium.
pub(crate) fn library() -> Vec<(String, Robot, Equilibrium)> {
    funicular_robots::ALL
        .into_iter()
        .map(|(name, text)| {
            let robot = Robot::from_toml(text).unwrap();
            let model = StaticModel::Catenary;
            let rest = match &robot.state {
                State::Lengths(lengths) => statics::forward(&robot, lengths, model, None),
                State::Pose(pose) => statics::distribute(&robot, pose, model, &TensionRule::default()),
                State::Unknown => panic!("{name} has no state"),
            };
            (name.to_owned(), robot, rest.unwrap_or_else(|error| panic!("{name}: {error}")))
        })
        .collect()
}

#[test]
fn every_robot_of_the_library_rests_stably_within_its_limits() {
    for (name, robot, rest) in library() {
        assert!(rest.residual < 1e-10, "{name}");
        assert!(matches!(rest.stability, Stability::Stable { .. }), "{name}: {:?}", rest.stability);
        for (cable, state) in robot.cables.iter().zip(&rest.cables) {
            let hanging = &state.hanging.as_ref().unwrap().catenary;
            let limits = cable.limits();
            assert!(hanging.least_tension() >= limits.minimum.unwrap_or(0.0), "{name}, cable {}", cable.name);
            assert!(
                hanging.greatest_tension() <= limits.maximum.unwrap_or(f64::INFINITY),
                "{name}, cable {}",
                cable.name
            );
        }
        // The lengths of the paper's robots are of ideal cables under more load; there the program has to warn.
        if !name.starts_with("yuan2014") {
            assert_eq!(validity::of_statics(&robot, &rest), [], "{name}");
        }
    }
}

#[test]
fn at_the_pose_of_its_state_every_redundant_robot_has_tensions_by_every_rule() {
    let mut redundant = 0;
    for (name, robot, rest) in library() {
        if robot.cables.len() <= robot.platform.freedoms.count() {
            continue;
        }
        redundant += 1;
        for rule in [TensionRule::Lowest, TensionRule::Middle] {
            let has_maximum = robot.cables.iter().all(|cable| cable.limits().maximum.is_some());
            if rule == TensionRule::Middle && !has_maximum {
                continue;
            }
            let found = statics::distribute(&robot, &rest.pose, StaticModel::Catenary, &rule);
            let found = found.unwrap_or_else(|error| panic!("{name}, {rule:?}: {error}"));
            assert!(found.residual < 1e-10, "{name}, {rule:?}");
        }
    }
    assert!(redundant >= 6, "{redundant}");
}

#[test]
fn every_robot_of_the_library_has_a_certified_list_of_modes() {
    for (name, robot, rest) in library() {
        let mut below_hz = 0.25;
        loop {
            let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), below_hz).unwrap();
            let found = modes::below(&dynamics, below_hz);
            assert!(found.certified, "{name} below {below_hz} Hz");
            if found.modes.len() >= 12 {
                break;
            }
            below_hz *= 2.0;
            assert!(below_hz < 1e3, "{name}");
        }
    }
}

#[test]
fn the_lowest_frequencies_of_fast_are_among_those_that_were_measured() {
    // Li, Sun, Li, Yao, Universe 2024, 10(12), 450: 0.12 to 0.2 Hz over the telescope's poses. The rope is assumed, so
    // this is no validation; a wrong sag or mass would be far outside.
    let (_, robot, rest) = library().into_iter().find(|(name, ..)| name == "fast").unwrap();
    assert_eq!(robot.platform.freedoms, Freedoms::Rigid);
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 0.3).unwrap();
    let found = modes::below(&dynamics, 0.3);
    assert!(found.modes.len() >= 6);
    assert!(found.modes[..6].iter().all(|mode| (0.12..0.2).contains(&mode.frequency_hz)), "{:?}", found.modes[0]);
}
