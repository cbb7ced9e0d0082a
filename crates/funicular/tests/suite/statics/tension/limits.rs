//! Tensions within their limits, for limits of all kinds.

use super::{COGIRO, check};
use crate::random::any_robot;
use funicular::robot::{Pose, Robot, TensionLimits};
use funicular::statics::{self, StaticModel, StaticsError, TensionRange, TensionRule};
use proptest::prelude::*;

#[test]
fn without_limits_no_cable_is_slacker_than_shallow_models_allow() {
    let robot = Robot::from_toml(COGIRO).unwrap().with_tension_limits(TensionLimits::default());
    let mut robot = robot;
    robot.cables.iter_mut().for_each(|cable| {
        cable.tension_limits = TensionLimits::default();
        cable.material.tension_limits = TensionLimits::default();
        cable.material.breaking_load = None;
    });
    let held = statics::inverse(&robot, &Pose::new([2.0, 1.0, 2.0], [0.0; 3]), StaticModel::Catenary).unwrap();
    for cable in &held.cables {
        let hanging = cable.hanging.as_ref().unwrap();
        let weight = 0.064 * 9.81 * cable.chord();
        assert!(hanging.catenary.min_tension() >= 2.5 * weight * (1.0 - 1e-6));
    }
}

/// No weight acts in the plane: limits far above what the cables need, and a minimum that only excludes slack cables.
#[test]
fn a_minimum_of_next_to_nothing_is_met() {
    let robot = Robot::from_toml(funicular_robots::KNTU_PLANAR).unwrap();
    let pose = Pose::new([0.0; 3], [0.0; 3]);
    for minimum in [1e-9, 1e-6, 1e-3, 1e-2, 0.1] {
        let robot = robot.with_tension_limits(TensionLimits { minimum: Some(minimum), maximum: Some(60.0) });
        for model in [StaticModel::Spring, StaticModel::Catenary] {
            for rule in [TensionRule::Lowest, TensionRule::Middle, TensionRule::Stiffest] {
                let held = statics::distribute_tensions(&robot, &pose, model, &rule);
                let held = held.unwrap_or_else(|error| panic!("{minimum} N, {model:?}, {}: {error}", rule.name()));
                assert!(held.residual <= statics::RESIDUAL_LIMIT, "{:e}", held.residual);
                for (i, cable) in held.cables.iter().enumerate() {
                    let margin = TensionRange::of(&robot, i, &cable.chord_w()).margin(cable);
                    assert!(
                        margin.distance() >= -1e-6 * minimum,
                        "{minimum} N, {model:?}, {}: {margin:?}",
                        rule.name()
                    );
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None, ..Default::default() })]

    /// Robots with 7 to 9 cables, ropes from thread to 1 kg/m: a valid result, or a reason. If cables may have less
    /// tension than they weigh, they hang in deep curves, the problem is not convex, and the search may report that it
    /// has not converged.
    #[test]
    fn random_robots_are_held_within_their_limits_or_it_is_said_why(
        (robot, _) in any_robot(), at in prop::array::uniform6(-1.0f64..1.0), minimum in 0.0f64..100.0,
        breadth in 1.0f64..4.0,
    ) {
        prop_assume!(robot.cables.len() > 6);
        let robot = robot.with_tension_limits(TensionLimits {
            minimum: Some(minimum),
            maximum: Some(minimum + 10f64.powf(breadth)),
        });
        let pose = Pose::new([at[0], at[1], at[2]], [10.0 * at[3], 10.0 * at[4], 10.0 * at[5]]);
        let weight = robot.cables.iter().enumerate().fold(0.0, |most: f64, (i, cable)| {
            let chord = cable.chord_w(&pose).norm();
            most.max(9.81 * robot.cables[i].material.mass_per_length * chord)
        });
        let mut verdicts = Vec::new();
        for rule in [TensionRule::Lowest, TensionRule::Closest(vec![200.0]), TensionRule::Middle,
            TensionRule::Stiffest] {
            let held = statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, &rule);
            match &held {
                Ok(held) => check(&robot, held),
                Err(StaticsError::BeyondLimits(miss) | StaticsError::NotFoundWithinLimits { miss, .. }) => {
                    prop_assert!(miss.by > 0.0);
                    prop_assert!(miss.minimum_of.len() + miss.maximum_of.len() > 0, "{miss}");
                }
                Err(StaticsError::Singular { .. }) => {}
                Err(StaticsError::TensionsNotConverged { .. }) if minimum < weight => continue,
                Err(other) => prop_assert!(false, "{}: {other}", rule.name()),
            }
            verdicts.push(held.is_ok());
        }
        prop_assert!(verdicts.windows(2).all(|pair| pair[0] == pair[1]), "{verdicts:?}");
    }
}
