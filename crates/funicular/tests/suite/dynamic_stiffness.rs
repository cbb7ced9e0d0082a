//! Ropes that are stiffer in vibration: the robot that vibrates against robots of one stiffness, solved separately.

use funicular::dynamics::{Dynamics, DynamicsError, Linearisation};
use funicular::modes;
use funicular::robot::{Robot, State};
use funicular::statics::{self, Equilibrium, StaticModel};

/// Robot of the library whose ropes are stiffer in vibration by this factor, at rest.
fn stiffer(text: &str, factor: f64) -> (Robot, Equilibrium) {
    let mut robot = Robot::from_toml(text).unwrap();
    for rope in robot.cables.iter_mut().map(|cable| &mut cable.material) {
        rope.dynamic_axial_stiffness = Some(factor * rope.axial_stiffness);
    }
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    (robot, rest)
}

/// Lowest natural frequencies [Hz].
fn frequencies(robot: &Robot, rest: &Equilibrium, count: usize) -> Vec<f64> {
    let (_, found) = modes::lowest(robot, rest, Linearisation::default(), count, 1e3).unwrap();
    found.modes.iter().take(count).map(|mode| mode.frequency_hz).collect()
}

/// Largest relative difference of two lists.
fn difference(ours: &[f64], others: &[f64]) -> f64 {
    assert_eq!(ours.len(), others.len());
    ours.iter().zip(others).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max)
}

/// All that is at rest stays, on every robot of the library: pose, tensions at the platform, weight of the cables.
#[test]
fn the_robot_that_vibrates_has_the_tensions_of_the_equilibrium() {
    for (name, text) in funicular_robots::ALL {
        let (robot, rest) = stiffer(text, 1.8);
        let (other, moved) = rest.with_dynamic_stiffness(&robot);
        assert!(!other.has_dynamic_stiffness());
        assert_eq!(moved.pose, rest.pose);
        for (i, (before, after)) in rest.cables.iter().zip(&moved.cables).enumerate() {
            let change = (after.tension_platform / before.tension_platform - 1.0).abs();
            assert!(change < 1e-5, "{name}, cable {i}: {change}");
            let weight = |robot: &Robot, length: f64| robot.cables[i].material.mass_per_length * length;
            let [old, new] = [weight(&robot, before.unstrained_length), weight(&other, after.unstrained_length)];
            assert!((new - old).abs() <= 1e-4 * old, "{name}, cable {i}: {old} {new} kg");
            assert!(after.unstrained_length >= before.unstrained_length || before.is_slack(), "{name}, cable {i}");
        }
        // Equation (27j): strains differ along a cable by less than a tenth of a per cent here.
        assert!(moved.residual < 1e-5, "{name}: {}", moved.residual);
    }
}

/// Tensions of six cables on a free platform follow from balance alone. So a robot whose ropes have the higher
/// stiffness from the beginning has the same tensions at the same pose, and vibrates alike.
#[test]
fn a_robot_of_one_stiffness_at_the_same_pose_vibrates_alike() {
    for text in [funicular_robots::YUAN2014_4MM, funicular_robots::YUAN2014_DYNAMIC_TEST] {
        let (robot, rest) = stiffer(text, 1.6);
        let (vibrating, at_rest) = rest.with_dynamic_stiffness(&robot);
        let ours = frequencies(&vibrating, &at_rest, 30);

        let of_one = |factor: f64| {
            let mut other = robot.clone();
            other.state = State::Pose(rest.pose);
            for (cable, replaced) in other.cables.iter_mut().zip(&vibrating.cables) {
                cable.material = replaced.material.clone();
                cable.material.axial_stiffness *= factor;
            }
            let rest = statics::solve(&other, StaticModel::Catenary, None).unwrap().equilibrium;
            frequencies(&other, &rest, 30)
        };
        let same = difference(&ours, &of_one(1.0));
        // Equation (27j): the mass of the sagging cables moves along them by some 1e-6 of it.
        assert!(same < 5e-6, "{same}");

        // The list sees a stiffness that is 1 % off.
        let off = difference(&ours, &of_one(1.01));
        assert!(off > 1e-4, "{off}");
    }
}

/// With the stiffness of the equilibrium nothing changes.
#[test]
fn the_same_stiffness_twice_is_one_stiffness() {
    for text in [funicular_robots::COGIRO, funicular_robots::COGIRO_WINCHES, funicular_robots::IPANEMA2] {
        let (robot, rest) = stiffer(text, 1.0);
        let (vibrating, at_rest) = rest.with_dynamic_stiffness(&robot);
        let plain = Robot::from_toml(text).unwrap();
        let before = statics::solve(&plain, StaticModel::Catenary, None).unwrap().equilibrium;
        let change = difference(&frequencies(&vibrating, &at_rest, 12), &frequencies(&plain, &before, 12));
        assert!(change < 1e-8, "{change}");
    }
}

/// Analyses of vibration refuse the robot of two stiffnesses itself, so that none uses the wrong one in silence.
#[test]
fn the_robot_of_two_stiffnesses_itself_is_refused() {
    let (robot, rest) = stiffer(funicular_robots::COGIRO, 1.5);
    let refused = Dynamics::about(&robot, &rest, Linearisation::default(), 5.0).unwrap_err();
    assert_eq!(refused, DynamicsError::TwoStiffnesses { rope: "wire-rope-4mm".to_owned() });
    assert!(modes::first(&robot, &rest).is_err());
}
