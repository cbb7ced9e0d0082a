//! Rule `centre`: optimality, proof that the centre is the only one, smoothness, and poses without a centre.

use super::{POINT, changed, check, cogiro, cogiro_pose, seven_cables, seven_pose, spread, tau};
use funicular::robot::{Pose, Robot, TensionLimits};
use funicular::statics::{
    self, Equilibrium, StaticModel, StaticsError, TensionCentre, TensionRange, TensionRule, tension_centre,
};

/// Objective (40b1) at tensions τ; infinite beyond a limit.
fn cost(tensions: &[f64], limits: &[[f64; 2]]) -> f64 {
    let log = |room: f64| if room > 0.0 { room.ln() } else { f64::NEG_INFINITY };
    -tensions.iter().zip(limits).map(|(tau, [low, high])| log(tau - low) + log(high - tau)).sum::<f64>()
}

/// Checks balance and limits, and that no tensions nearby that hold the platform are better.
fn check_optimum(robot: &Robot, pose: &Pose, model: StaticModel, found: &TensionCentre, seed: usize) {
    check(robot, &found.equilibrium);
    let best = cost(&found.tensions, &found.limits);
    for k in 0..20 {
        let reach = [0.01, 0.1, 1.0, 10.0][k % 4];
        let wanted = found.tensions.iter().enumerate();
        let wanted = wanted.map(|(c, t)| (t + reach * (spread(k + 20 * seed, c % 8) - 0.5)).max(0.0)).collect();
        let rule = TensionRule::Closest(wanted);
        let other = statics::distribute_tensions(robot, pose, model, &rule).unwrap();
        let other = cost(&tau(&other), &found.limits);
        assert!(other >= best - 1e-10, "{}, {seed}, {k}: {other} {best}", robot.name);
    }
}

/// Pose by its number.
type Poses = fn(usize) -> Pose;

/// CoGiRo with its own rope and with one ten times as heavy, a room with seven cables (one more than the degrees of
/// freedom), a point mass on eight cables, a planar robot.
#[test]
fn no_neighbour_is_nearer_to_the_centre_and_no_other_centre_exists() {
    let (mut tried, mut held) = (0, 0);
    let planar = Robot::from_toml(funicular_robots::KNTU_PLANAR).unwrap();
    let planar = planar.with_tension_limits(TensionLimits { minimum: Some(1.0), maximum: Some(60.0) });
    let point = changed(Robot::from_toml(POINT).unwrap(), 0.0256, 20.0, 400.0);
    let robots: [(Robot, Poses); 5] = [
        (cogiro(0.064, 100.0, 5000.0), cogiro_pose),
        (cogiro(0.64, 120.0, 2000.0), cogiro_pose),
        (seven_cables(0.02, 10.0, 500.0), seven_pose),
        (point, |i| {
            Pose::new([1.0 + 0.6 * spread(i, 0), 1.0 + 0.6 * spread(i, 1), 1.0 + 0.5 * spread(i, 2)], [0.0; 3])
        }),
        (planar, |i| Pose::new([0.3 * spread(i, 0), 0.3 * spread(i, 1), 0.0], [0.0; 3])),
    ];
    for (robot, pose_of) in &robots {
        for model in [StaticModel::Ideal, StaticModel::Spring, StaticModel::Catenary] {
            for i in 0..20 {
                let pose = pose_of(i);
                tried += 1;
                let found = match tension_centre(robot, &pose, model, None) {
                    Ok(found) => found,
                    // Other rules have to find none either.
                    Err(StaticsError::BeyondLimits(_) | StaticsError::NotFoundWithinLimits { .. }) => {
                        let lowest = statics::distribute_tensions(robot, &pose, model, &TensionRule::Lowest);
                        assert!(lowest.is_err(), "{}, {i}, {model:?}", robot.name);
                        continue;
                    }
                    Err(other) => panic!("{}, {i}, {model:?}: {other}", robot.name),
                };
                held += 1;
                assert!(found.certificate.is_unique(), "{}, {i}, {model:?}", robot.name);
                check_optimum(robot, &pose, model, &found, i);

                // From another start the same result.
                let other: Vec<f64> =
                    found.limits.iter().enumerate().map(|(c, [a, b])| a + (b - a) * spread(i, c % 8)).collect();
                let last = TensionCentre { tensions: other, multipliers: vec![0.0; 6], ..found.clone() };
                let again = tension_centre(robot, &pose, model, Some(&last)).unwrap();
                for (one, other) in found.tensions.iter().zip(&again.tensions) {
                    assert!((one - other).abs() < 1e-9 * one, "{}, {i}, {model:?}: {one} {other}", robot.name);
                }
            }
        }
    }
    assert!(held > 150 && held < tried, "{held} of {tried}");
}

/// Differences over steps refined 60-fold fall with the steps: no jump and no kink of tensions and lengths; the rule
/// `middle` jumps by 68 N on this line.
#[test]
fn tensions_are_smooth_along_a_line_on_which_those_of_the_middle_jump() {
    let robot = cogiro(0.064, 100.0, 5000.0);
    let at = |t: f64| {
        let turn = [-0.238899985, 5.835693707, -0.570301491];
        Pose::new([3.198456389 + 2.0 * t, -2.261249935 - t, 3.574254715 + 0.5 * t], turn)
    };
    let tensions = |t: f64| tension_centre(&robot, &at(t), StaticModel::Catenary, None).unwrap().tensions;
    let mut last: Option<f64> = None;
    for step in [1e-2, 1e-2 / 60.0, 1e-2 / 3600.0] {
        // Second differences over the square of the step are those of a smooth curve.
        let worst = (-20..20).fold(0.0_f64, |worst, k| {
            let t = f64::from(k) * step;
            let [before, here, after] = [t - step, t, t + step].map(tensions);
            let bend = |c: usize| (before[c] - 2.0 * here[c] + after[c]).abs() / (step * step);
            (0..8).map(bend).fold(worst, f64::max)
        });
        // Rounding of tensions of 600 N: 1e-13 of them.
        let rounding = 4.0 * 6e-11 / (step * step);
        assert!(worst < 2000.0 + rounding, "{step:e}: {worst}");
        if let Some(last) = last {
            assert!(worst < 2.0 * last + rounding, "{step:e}: {worst} {last}");
        }
        last = Some(worst);
    }
}

/// Images of a cable under the symmetry of a robot have the same tension.
#[test]
fn a_symmetric_robot_has_a_symmetric_centre() {
    let mut text = String::from(
        "name = \"square\"\n[platform]\nmass_kg = 50.0\ninertia_kg_m2 = [1.0, 1.0, 1.0]\n[materials.rope]\n\
         axial_stiffness_n = 1e5\nmass_kg_per_m = 0.05\nminimum_tension_n = 20.0\nmaximum_tension_n = 900.0\n",
    );
    for i in 0..8 {
        let [sx, sy] = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]][i % 4];
        let (anchor, attachment) = if i < 4 {
            ([2.5 * sx, 2.0 * sy, 3.0], [0.3 * sx, 0.2 * sy, -0.2])
        } else {
            ([2.5 * sx, 2.0 * sy, 0.0], [0.3 * sx, 0.2 * sy, 0.2])
        };
        let cable = format!(
            "[[cables]]\nname = \"{i}\"\nmaterial = \"rope\"\nanchor_m = {anchor:?}\nattachment_m = {attachment:?}\n"
        );
        text.push_str(&cable);
    }
    let robot = Robot::from_toml(&text).unwrap();
    let pose = Pose::new([0.0, 0.0, 1.5], [0.0; 3]);
    let found = tension_centre(&robot, &pose, StaticModel::Catenary, None).unwrap();
    assert!(found.certificate.is_unique());
    check_optimum(&robot, &pose, StaticModel::Catenary, &found, 0);
    for group in found.tensions.chunks(4) {
        assert!(group.iter().all(|tau| (tau - group[0]).abs() < 1e-10 * tau), "{:?}", found.tensions);
    }
}

/// The border of the workspace of CoGiRo along x: centres up to a thousandth of a millimetre inside, a proof beyond.
#[test]
fn centres_exist_up_to_the_border_and_poses_beyond_are_proved_infeasible() {
    let robot = cogiro(0.064, 100.0, 5000.0);
    let at = |x: f64| {
        let pose = Pose::new([x, 0.0, 1.0], [0.0; 3]);
        statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, &TensionRule::Centre)
    };
    let is_held = |x: f64| {
        let pose = Pose::new([x, 0.0, 1.0], [0.0; 3]);
        statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, &TensionRule::Lowest).is_ok()
    };
    let (mut inside, mut outside) = (5.0, 6.0);
    while outside - inside > 1e-7 {
        let middle = 0.5 * (inside + outside);
        if is_held(middle) { inside = middle } else { outside = middle }
    }
    let margin = |held: &Equilibrium| {
        let of = |(i, cable): (usize, &statics::CableState)| {
            TensionRange::of(&robot, i, &cable.chord_w()).margin(cable).distance()
        };
        held.cables.iter().enumerate().map(of).fold(f64::INFINITY, f64::min)
    };
    let mut last = f64::INFINITY;
    for distance in [1.0, 0.1, 1e-2, 1e-3, 1e-5] {
        let here = margin(&at(inside - distance).unwrap_or_else(|error| panic!("{distance}: {error}")));
        assert!(here > 0.0 && here < last && here < 100.0 * distance, "{distance}: {here}");
        last = here;
    }
    for distance in [1e-3, 0.01, 0.1, 1.0] {
        assert!(matches!(at(outside + distance), Err(StaticsError::BeyondLimits(_))), "{distance}");
    }
}

/// A maximum is needed for every cable, room between the limits as well.
#[test]
fn poses_without_a_centre_say_why() {
    let pose = Pose::new([0.0, 0.0, 1.5], [0.0; 3]);
    let at = |robot: &Robot| {
        statics::distribute_tensions(robot, &pose, StaticModel::Catenary, &TensionRule::Centre).unwrap_err()
    };
    let open = cogiro(0.064, 30.0, f64::INFINITY);
    assert!(matches!(at(&open), StaticsError::NeedsMaximum { rule: "centre", .. }));
    let narrow = cogiro(0.064, 900.0, 900.0);
    assert!(matches!(at(&narrow), StaticsError::LimitsExclude { .. }));

    // The largest and the smallest mass that the limits allow: the tensions have no room there.
    let robot = cogiro(0.064, 100.0, 1000.0);
    let requested = statics::RequestedPayload {
        center_p: robot.platform.center_of_mass_p,
        side: statics::PayloadSide::Maximum,
        prove: false,
    };
    let most = statics::payload_bound(&robot, &pose, StaticModel::Catenary, requested, None).unwrap();
    let heaviest = robot.with_mass(robot.platform.mass + most.mass);
    let error = at(&heaviest);
    assert!(matches!(error, StaticsError::NoCentre { .. } | StaticsError::BeyondLimits(_)), "{error}");
    assert_eq!(error.code(), "tension-limits");
    let lighter = robot.with_mass((robot.platform.mass + most.mass) * (1.0 - 1e-5));
    assert!(statics::distribute_tensions(&lighter, &pose, StaticModel::Catenary, &TensionRule::Centre).is_ok());
}
