//! Optimality of each rule: no other tensions that hold the platform are better. Sagging ropes, many cables.

use super::{POINT, changed, check, cogiro, cogiro_pose, min_stiffness, spread, tau};
use funicular::math::Vec3;
use funicular::robot::{Pose, Robot};
use funicular::statics::{self, Equilibrium, StaticModel, StaticsError, TensionRange, TensionRule};
use std::fmt::Write as _;

/// Objective that a rule minimises.
fn cost(robot: &Robot, held: &Equilibrium, rule: &TensionRule) -> f64 {
    let ranges = held.cables.iter().enumerate().map(|(i, cable)| TensionRange::of(robot, i, &cable.chord_w()));
    let squares = |wanted: &[f64]| tau(held).iter().zip(wanted).map(|(t, w)| (t - w).powi(2)).sum::<f64>().sqrt();
    match rule {
        TensionRule::Lowest => squares(&ranges.map(|range| range.minimum).collect::<Vec<_>>()),
        TensionRule::Closest(wanted) => squares(&wanted.iter().copied().cycle().take(8).collect::<Vec<_>>()),
        TensionRule::Middle => ranges
            .zip(&held.cables)
            .fold(f64::NEG_INFINITY, |most, (range, cable)| most.max(-range.margin(cable).relative().unwrap())),
        TensionRule::Stiffest => -min_stiffness(held),
        TensionRule::Centre => unreachable!("compared in centre.rs, by its own limits"),
    }
}

#[test]
fn with_sagging_ropes_no_neighbour_is_better_by_any_rule() {
    let rules = [TensionRule::Lowest, TensionRule::Closest(vec![600.0]), TensionRule::Middle, TensionRule::Stiffest];
    let mut tried = 0;
    // From the robot's own rope to ten times its weight: sags up to an eighth of the chord.
    for (mass, minimum) in [(0.064, 30.0), (0.3, 40.0), (0.64, 60.0)] {
        let robot = cogiro(mass, minimum, 1200.0);
        for i in 0..25 {
            let pose = cogiro_pose(i);
            for rule in &rules {
                let held = match statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, rule) {
                    Ok(held) => held,
                    Err(StaticsError::BeyondLimits(_) | StaticsError::NotFoundWithinLimits { .. }) => continue,
                    Err(other) => panic!("{other}: {mass} kg/m, pose {i}, {}", rule.name()),
                };
                check(&robot, &held);
                let best = cost(&robot, &held, rule);
                for k in 0..40 {
                    let reach = [0.01, 0.1, 1.0, 10.0, 100.0][k % 5];
                    let wanted = tau(&held)
                        .into_iter()
                        .enumerate()
                        .map(|(c, t)| (t + reach * (spread(k + 40 * i, c) - 0.5)).max(0.0));
                    let other = TensionRule::Closest(wanted.collect());
                    let other = statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, &other).unwrap();
                    check(&robot, &other);
                    let other = cost(&robot, &other, rule);
                    assert!(other >= best - 1e-6 * best.abs(), "{}: {other} {best} {mass} {i} {k}", rule.name());
                    tried += 1;
                }
            }
        }
    }
    assert!(tried > 4000, "{tried}");
}

#[test]
fn a_point_mass_on_eight_cables_has_five_dimensions_of_choice() {
    let robot = changed(Robot::from_toml(POINT).unwrap(), 0.0256, 20.0, 400.0);
    for rule in [TensionRule::Lowest, TensionRule::Middle, TensionRule::Stiffest, TensionRule::Closest(vec![90.0])] {
        let pose = Pose::new([1.3, 1.1, 1.2], [0.0; 3]);
        let held = statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, &rule).unwrap();
        check(&robot, &held);
        let best = cost(&robot, &held, &rule);
        for k in 0..200 {
            let wanted = (0..8).map(|c| 400.0 * spread(k, c)).collect();
            let other =
                statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, &TensionRule::Closest(wanted))
                    .unwrap();
            assert!(cost(&robot, &other, &rule) >= best - 1e-6 * best.abs(), "{}", rule.name());
        }
    }
}

/// Point mass on many cables (an invented robot), its anchors spread evenly on a tube by the golden angle.
fn many_cables(cables: usize, maximum: f64) -> Robot {
    let mut text = String::from(
        "name = \"many\"\n[platform]\nmass_kg = 400.0\nmotion = \"point-mass\"\n[materials.rope]\n\
         axial_stiffness_n = 1e5\nmass_kg_per_m = 0.01\n",
    );
    for i in 0..cables {
        let (angle, height) = (2.399_963 * i as f64, 3.0 + 2.0 * (0.618_034 * i as f64).fract());
        let (x, y) = (5.0 * angle.cos(), 5.0 * angle.sin());
        text.push_str("[[cables]]\nmaterial = \"rope\"\n");
        writeln!(text, "name = \"{i}\"\nanchor_m = [{x}, {y}, {height}]").unwrap();
    }
    changed(Robot::from_toml(&text).unwrap(), 0.01, 1.0, maximum)
}

/// Dual problem instead of a second solver: straight cables have τ_i = max(minimum, minimum + e_i·y) with one y in
/// space, because the sum of squares of the excess over the minimum is smallest there.
#[test]
fn a_thousand_cables_have_the_lowest_tensions_within_a_second_or_so() {
    let robot = many_cables(1000, 1e4);
    let pose = Pose::new([0.5, 0.2, 1.0], [0.0; 3]);
    let held = statics::distribute_tensions(&robot, &pose, StaticModel::Spring, &TensionRule::Lowest).unwrap();
    check(&robot, &held);
    // y by least squares over the cables above their minimum; then all cables are compared with it.
    let above = |tension: f64| tension - 1.0;
    let (mut gram, mut right) = (funicular::math::Mat3::zeros(), Vec3::zeros());
    for cable in held.cables.iter().filter(|cable| above(cable.tension_platform) > 1e-6) {
        let e = cable.chord_w().normalize();
        gram += e * e.transpose();
        right += e * above(cable.tension_platform);
    }
    let y = gram.try_inverse().unwrap() * right;
    for cable in &held.cables {
        let expected = cable.chord_w().normalize().dot(&y).max(0.0);
        let found = above(cable.tension_platform);
        assert!((found - expected).abs() < 1e-6 * (1.0 + expected), "{found} for {expected}");
    }
    let error = statics::distribute_tensions(&robot, &pose, StaticModel::Spring, &TensionRule::Stiffest).unwrap_err();
    assert!(error.to_string().contains("is for up to 200 cables, and the robot has 1000"), "{error}");
}

#[test]
fn what_a_rule_lacks_and_limits_that_exclude_each_other_are_errors_with_numbers() {
    let pose = Pose::new([0.0, 0.0, 1.5], [0.0; 3]);
    let text =
        |robot: &Robot, model, rule| statics::distribute_tensions(robot, &pose, model, &rule).unwrap_err().to_string();
    let catenary = StaticModel::Catenary;
    let robot = cogiro(0.064, 30.0, 900.0);
    assert!(
        text(&robot, catenary, TensionRule::Closest(vec![1.0, 2.0])).contains("2 target tensions given for 8 cables")
    );
    assert!(text(&robot, catenary, TensionRule::Closest(vec![-1.0])).contains("is -1 N"));
    assert!(text(&robot, StaticModel::Ideal, TensionRule::Stiffest).contains("rigid"));
    let open = cogiro(0.064, 30.0, f64::INFINITY);
    assert!(text(&open, catenary, TensionRule::Middle).contains("cable \"1\" has none"));
    let narrow = cogiro(0.064, 900.0, 900.0);
    assert!(
        text(&narrow, catenary, TensionRule::Lowest).contains("minimum tension 900 N is not below its maximum 900 N")
    );
    let weak = cogiro(0.064, 30.0, 100.0);
    let message = text(&weak, catenary, TensionRule::Lowest);
    assert!(
        message.contains("the best tensions violate the limits by ") && message.contains("maximum of cable"),
        "{message}"
    );
    let above = Pose::new([0.0, 0.0, 9.0], [0.0; 3]);
    let miss = statics::distribute_tensions(&robot, &above, catenary, &TensionRule::Lowest).unwrap_err();
    assert!(matches!(miss, StaticsError::BeyondLimits(_)), "{miss}");
    // All anchors in a plane with the point: no cable pulls out of it.
    let flat = Robot::from_toml(POINT).unwrap();
    let mut flat = changed(flat, 0.0, 1.0, 100.0);
    flat.cables.truncate(4);
    let level = Pose::new([1.0, 1.2, 1.25], [0.0; 3]);
    let singular = statics::distribute_tensions(&flat, &level, StaticModel::Spring, &TensionRule::Lowest).unwrap_err();
    assert!(matches!(singular, StaticsError::Singular { obstacle: Some(_) }), "{singular}");
}
