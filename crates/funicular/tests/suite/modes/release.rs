//! Decay after a release against the exponential of complete matrices, and its times of settling against samples.

use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{DMat, Rotation, Vec3, Vec6};
use funicular::modes::{self, Release, damped};
use funicular::reduced_model::{DampingAt, RequestedModel, reduce};
use funicular::response::{Quantity, Signal};
use funicular::robot::{Damping, Pose, Robot, State, StretchLoss};
use funicular::statics::{self, StaticModel, TensionRule};

const BELOW_HZ: f64 = 25.0;

/// Exponential of a matrix times a time: a series for a small fraction of it, squared again and again.
pub(super) fn exponential(matrix: &DMat, time: f64) -> DMat {
    let halvings = (matrix.norm() * time).max(1.0).log2().ceil() as i32 + 2;
    let small = matrix * (time / 2_f64.powi(halvings));
    let n = matrix.nrows();
    let (mut sum, mut term) = (DMat::identity(n, n), DMat::identity(n, n));
    for k in 1..16 {
        term = &term * &small / f64::from(k);
        sum += &term;
    }
    (0..halvings).for_each(|_| sum = &sum * &sum);
    sum
}

/// Release of a downward force on CoGiRo, seen at a point of its platform, whose losses matrices have exactly.
#[test]
fn the_decay_is_that_of_the_complete_matrices() {
    let mut robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    for cable in &mut robot.cables {
        cable.material.damping = Damping::Viscous(0.05);
        cable.material.stretch_loss = StretchLoss { factor: 0.0, time: 6e-4 };
    }
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), BELOW_HZ).unwrap();
    let found = modes::below(&dynamics, BELOW_HZ);
    let damped = damped::damped_modes(&dynamics, &found);
    assert!(damped.certified);
    let point_p = Vec3::new(0.3, -0.2, 0.1);
    let force = Vec3::new(20.0, 10.0, -150.0);
    let wrench = Vec6::new(force.x, force.y, force.z, 0.0, 0.0, 0.0);
    let arm_w = rest.pose.rot_wp * point_p;
    let release = Release::of(&dynamics, &found, &damped, &wrench, &arm_w).unwrap();

    // The complete matrices, their state under the force, and its exponential.
    let requested = RequestedModel { below_hz: BELOW_HZ, tolerance: 0.0, damping_at: DampingAt::NaturalFrequencies };
    let along = |direction_w: Vec3, point_p: Vec3| Signal::Along { direction_w, point_p };
    let outputs = [Vec3::x(), Vec3::y(), Vec3::z()].map(|axis| (along(axis, point_p), Quantity::Displacement));
    let input = [along(force.normalize(), Vec3::zeros())];
    let model = reduce(&robot, &rest, &dynamics, &input, &outputs, requested, &mut |_| true).unwrap();
    let n = model.mass.nrows();
    let held = model.stiffness.clone().lu().solve(&(&model.input * force.norm())).unwrap();
    let inverse = model.mass.clone().cholesky().unwrap().inverse();
    let mut state = DMat::zeros(2 * n, 2 * n);
    state.view_mut((0, n), (n, n)).copy_from(&DMat::identity(n, n));
    state.view_mut((n, 0), (n, n)).copy_from(&(-&inverse * &model.stiffness));
    state.view_mut((n, n), (n, n)).copy_from(&(-&inverse * &model.damping));
    let peak = release.held.norm();
    assert!(((&model.output * &held).norm() / peak - 1.0).abs() < 1e-9);
    assert!((release.decay.at(0.0) - release.held).norm() <= release.omitted);
    let (mut time, mut forward) = (0.1, exponential(&state, 0.1));
    for _ in 0..6 {
        let moved = forward.view((0, 0), (n, n)) * &held;
        let expected = &model.output * moved;
        let expected = Vec3::new(expected[0], expected[1], expected[2]);
        let gap = (release.decay.at(time) - expected).norm();
        assert!(gap <= release.omitted + 1e-6 * peak, "{time} s: {gap:e}, omitted {:e}, {peak:e}", release.omitted);
        (time, forward) = (2.0 * time, &forward * &forward);
    }
    assert!(release.omitted < 2e-3 * peak, "{:e} of {peak:e}", release.omitted);

    // Times of settling: no sample beyond them is farther away.
    for tolerance in [0.5 * peak, 0.02 * peak, 1e-4 * peak] {
        let (exact, sure) = (release.decay.settled(tolerance), release.decay.surely_settled(tolerance));
        assert!(exact <= sure && sure < 100.0, "{exact} {sure}");
        let after = (0..20_000).map(|i| exact + 1e-6 + (sure - exact) * f64::from(i) / 2e4);
        assert!(after.clone().all(|time| release.decay.at(time).norm() < tolerance), "{tolerance}");
        assert!((release.decay.at(exact).norm() / tolerance - 1.0).abs() < 1e-6 || exact == 0.0);
        assert!((release.decay.envelope(sure) / tolerance - 1.0).abs() < 1e-6);
    }
    assert!(release.decay.settled(10.0 * peak) <= 0.0);
}

/// Without damping every mode keeps its amplitude; the sum of all is the bound for ever.
#[test]
fn what_does_not_decay_keeps_its_amplitude() {
    let mut robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    robot.cables.iter_mut().for_each(|cable| cable.material.damping = Damping::Ratio(0.0));
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 9.0).unwrap();
    let found = modes::below(&dynamics, 9.0);
    let damped = damped::damped_modes(&dynamics, &found);
    let release = Release::of(&dynamics, &found, &damped, &Vec6::z(), &Vec3::zeros()).unwrap();
    let decay = &release.decay;
    assert_eq!(decay.undamped().count(), decay.motions.len());
    assert!((decay.at(0.0) - release.held).norm() <= release.omitted + 1e-9 * release.held.norm());

    let sum = decay.envelope(0.0);
    assert!((decay.envelope(1e6) / sum - 1.0).abs() < 1e-12);
    assert!(decay.settled(0.9 * sum).is_infinite() && decay.surely_settled(0.9 * sum).is_infinite());
    assert!(decay.settled(1.1 * sum) <= 0.0);
    // The motion comes back to most of its first size, however late.
    let late = (0..20_000).map(|i| decay.at(1e3 + 0.01 * f64::from(i)).norm()).fold(0.0, f64::max);
    assert!(late > 0.8 * decay.at(0.0).norm() && late <= sum, "{late} {sum}");
}

/// Robot with four equal sides: its motions along both level axes share their frequencies.
fn symmetric() -> Robot {
    let cables: Vec<String> = (0..8)
        .map(|k| {
            let side = f64::from(k / 2);
            let (anchor, other) = (std::f64::consts::FRAC_PI_2 * (side + 0.5), if k % 2 == 0 { -0.5 } else { 1.5 });
            let end = std::f64::consts::FRAC_PI_2 * (side + other);
            format!(
                "[[cables]]\nname = \"{k}\"\nmaterial = \"rope\"\nanchor_m = [{}, {}, 6.0]\nattachment_m = [{}, {}, \
                 {}]\n",
                7.0 * anchor.cos(),
                7.0 * anchor.sin(),
                0.7 * end.cos(),
                0.7 * end.sin(),
                if k % 2 == 0 { 0.4 } else { -0.4 }
            )
        })
        .collect();
    Robot::from_toml(&format!(
        "name = \"symmetric\"\n[platform]\nmass_kg = 60.0\ninertia_kg_m2 = [9.0, 9.0, 12.0]\n[materials.rope]\n\
         axial_stiffness_n = 4e5\nmass_kg_per_m = 0.05\ndamping_ratio = 0.004\naxial_damping_time_s = 2e-4\n{}",
        cables.concat()
    ))
    .unwrap()
}

/// Motions that share a frequency are found together: the motion is that of a robot whose inertia about
/// one axis is a millionth larger, so that its frequencies differ, and at the release that of all modes.
#[test]
fn motions_that_share_a_frequency_have_a_decay() {
    let released = |robot: &Robot| {
        let pose = State::Pose(Pose { position_w: Vec3::new(0.0, 0.0, 2.0), rot_wp: Rotation::identity() });
        let rest = statics::solve_at(robot, &pose, StaticModel::Catenary, &TensionRule::Lowest).unwrap().equilibrium;
        let dynamics = Dynamics::about(robot, &rest, Linearisation::default(), BELOW_HZ).unwrap();
        let found = modes::below(&dynamics, BELOW_HZ);
        let damped = damped::damped_modes(&dynamics, &found);
        let wrench = Vec6::new(30.0, -12.0, 5.0, 1.0, 2.0, -4.0);
        Release::of(&dynamics, &found, &damped, &wrench, &Vec3::new(0.2, 0.1, 0.3)).unwrap()
    };
    let robot = symmetric();
    let mut other = robot.clone();
    other.platform.inertia_p[(0, 0)] *= 1.0 + 1e-6;
    let [both, apart] = [&robot, &other].map(released);
    let size = both.held.norm();
    assert!(both.decay.motions.len() < apart.decay.motions.len());
    assert!((both.decay.at(0.0) - both.held).norm() <= both.omitted, "{both:?}");
    for time in [0.0, 0.03, 0.4, 1.7, 9.0] {
        let gap = (both.decay.at(time) - apart.decay.at(time)).norm();
        assert!(gap < 1e-3 * size, "{time} s: {gap:e} of {size:e}");
    }
    assert!((both.decay.envelope(0.0)) <= apart.decay.envelope(0.0) * (1.0 + 1e-3));
}
