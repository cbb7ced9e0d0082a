//! Modes of robots on supports: the closed form of straight cables, the limit of slow vibration, drives, shapes.

use super::{Behind, at_rest, closed_form, cogiro, rigid, taut, with_servos};
use funicular::cable::{CableModel, LocalAxes};
use funicular::cable_motion::CableStations;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Complex, Mat3, Vec3};
use funicular::modes::{self, Kind};
use funicular::robot::{Robot, StretchLoss};
use funicular::statics::{self, StaticModel};
use std::f64::consts::TAU;

#[test]
fn straight_cables_on_supports_have_their_closed_form() {
    let mut robot = taut("damping_ratio = 0.02\n");
    robot.cables[0].material.stretch_loss = StretchLoss { factor: 0.03, time: 0.0 };
    robot.cables[2].material.stretch_loss = StretchLoss { factor: 0.01, time: 1e-4 };
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    assert_eq!(robot.supports[1].name, "post");
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 60.0).unwrap();

    // Damped stiffness of the platform.
    for hz in [0.3, 4.1, 11.3, 23.7, 55.0] {
        let omega = hz * TAU;
        let own = Complex::from(omega * omega);
        let all = closed_form(&robot, &rest, own, own * Complex::new(1.0, -0.02), 1.0);
        let far = all.view((3, 3), (6, 6)).into_owned().lu().solve(&all.view((3, 0), (6, 3)).into_owned()).unwrap();
        let exact = all.view((0, 0), (3, 3)) - all.view((0, 3), (3, 6)) * far;
        let found = dynamics.stiffness(omega) - dynamics.mass().map(|mass| own * mass);
        let gap = (found.fixed_view::<3, 3>(0, 0) - &exact).norm();
        // The error of the cables' discretisation.
        assert!(gap < 1e-8 * exact.norm(), "{hz} Hz: {gap:e} of {:e}", exact.norm());
    }

    // Undamped frequencies are the zeros of the determinant, none missed: a scan of its sign, without double zeros.
    let found = modes::below(&dynamics, 60.0);
    assert!(found.certified && found.modes.len() > 20, "{}", found.modes.len());
    for mode in &found.modes {
        let at = |factor: f64| {
            let own = Complex::from((mode.frequency_hz * TAU * factor).powi(2));
            closed_form(&robot, &rest, own, own, 0.0).map(|entry| entry.re).determinant()
        };
        assert!(at(1.0 - 1e-8) * at(1.0 + 1e-8) < 0.0, "{} Hz", mode.frequency_hz);
        let total: f64 = mode.platform_energy_fraction
            + mode.cable_energy_fractions.iter().sum::<f64>()
            + mode.support_energy_fractions.iter().sum::<f64>();
        assert!((total - 1.0).abs() < 1e-9, "{total}");
    }
    assert!(found.modes.iter().any(|mode| mode.support_energy_fractions[0] > 0.75 && mode.kind == Kind::Drive));

    // Damped frequencies are zeros of the complex determinant.
    let damped = modes::damped::damped_modes(&dynamics, &found);
    assert!(damped.certified);
    for (mode, undamped) in damped.modes.iter().zip(&found.modes) {
        let at = |omega: Complex| {
            let own = omega * omega;
            closed_form(&robot, &rest, own, own * Complex::new(1.0, -0.02), 1.0).determinant()
        };
        // Newton's step by a difference.
        let step = mode.omega * 1e-6;
        let newton = at(mode.omega) / ((at(mode.omega + step) - at(mode.omega - step)) / (step * 2.0));
        assert!(newton.norm() < 1e-8 * mode.omega.norm(), "{:?}: {newton}", mode.omega);
        assert!((mode.damping_ratio() - undamped.damping_ratio).abs() < 2e-3, "{undamped:?}");
    }
}

/// At rest the vibration has the stiffness of statics, with every model and with drums on supports and on the ground.
#[test]
fn slow_vibration_is_the_static_stiffness() {
    for behind in Behind::ALL {
        let robot = cogiro(behind);
        let rest = at_rest(&robot);
        let still = statics::tangent_stiffness(&robot, &rest).unwrap();
        for cable_model in [CableModel::CatenaryStatic, CableModel::CatenaryDynamic] {
            let linearisation = Linearisation { cable_model, ..Linearisation::default() };
            let dynamics = Dynamics::about(&robot, &rest, linearisation, 12.0).unwrap();
            let slow = dynamics.stiffness(1e-6).map(|entry| entry.re);
            let gap = (slow - still).norm() / still.norm();
            assert!(gap < 1e-9, "{behind:?}, {cable_model}: {gap:e}");
        }
        let slow = |cable_model: CableModel| {
            let linearisation = Linearisation { cable_model, ..Linearisation::default() };
            let dynamics = Dynamics::about(&robot, &rest, linearisation, 12.0).unwrap();
            let certified = modes::below(&dynamics, 6.0).certified;
            (dynamics.stiffness(1e-6).map(|entry| entry.re), certified)
        };
        let ((shallow, certified), (still, _)) = (slow(CableModel::ShallowDynamic), slow(CableModel::ShallowStatic));
        assert!(certified && (shallow - still).norm() < 1e-9 * still.norm(), "{behind:?}");

        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 12.0).unwrap();
        let found = modes::below(&dynamics, 12.0);
        assert!(found.certified && found.unstable_directions == 0);

        // Supports yield: no frequency is above that of the rigid frame there, and the platform's are lower.
        let stiff = Dynamics::about(&rigid(&robot, &rest), &rest, Linearisation::default(), 12.0).unwrap();
        let held = modes::below(&stiff, 12.0);
        for (free, held) in found.modes.iter().zip(&held.modes) {
            assert!(free.frequency_hz <= held.frequency_hz * (1.0 + 1e-12));
        }
        let platform = |found: &modes::Modes| found.modes[found.first_platform(0.5).unwrap()].frequency_hz;
        assert!(platform(&found) < 0.97 * platform(&held), "{} {}", platform(&found), platform(&held));
        let first = modes::first(&robot, &rest).unwrap().frequency_hz;
        assert!((first / found.modes[0].frequency_hz - 1.0).abs() < 1e-11);
    }
}

/// Servos, drum sides with mass and wheels with inertia on supports: every list is certified, and stiff supports
/// without mass are a rigid frame.
#[test]
fn drives_on_supports_are_part_of_the_count() {
    for behind in [Behind::DrumsOnSupports, Behind::DrumsOnGround] {
        let mut robot = with_servos(cogiro(behind));
        let rest = at_rest(&robot);
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 4.0).unwrap();
        let still = statics::tangent_stiffness(&robot, &rest).unwrap();
        let slow = dynamics.stiffness(1e-6).map(|entry| entry.re);
        // The position gain of the servo yields in vibration, but not at rest.
        let yields = (slow - still).norm() / still.norm();
        assert!(yields > 1e-3, "{yields}");

        let found = modes::below(&dynamics, 4.0);
        assert!(found.certified, "{behind:?}: {:?}", found.caveat());
        for mode in &found.modes {
            let all = [&mode.cable_energy_fractions, &mode.drive_energy_fractions, &mode.support_energy_fractions];
            let total = mode.platform_energy_fraction + all.into_iter().flatten().sum::<f64>();
            assert!((total - 1.0).abs() < 1e-9, "{behind:?}, {} Hz: {total}", mode.frequency_hz);
        }
        // Limit of stiff supports.
        let hz = |robot: &Robot| {
            let dynamics = Dynamics::about(robot, &rest, Linearisation::default(), 4.0).unwrap();
            modes::below(&dynamics, 4.0).modes.iter().map(|mode| mode.frequency_hz).collect::<Vec<_>>()
        };
        let frame = hz(&rigid(&robot, &rest));
        for support in &mut robot.supports {
            (support.stiffness_w, support.mass) = (Mat3::identity() * 1e11, 0.0);
        }
        let stiff = hz(&robot);
        assert_eq!(stiff.len(), frame.len());
        for (stiff, frame) in stiff.iter().zip(&frame) {
            assert!((stiff / frame - 1.0).abs() < 1e-5, "{behind:?}: {stiff} and {frame}");
        }
    }
}

/// In a mode, the far end of a cable moves as its support does, and the points between follow without a jump.
#[test]
fn cables_follow_their_supports_in_modes() {
    for behind in Behind::ALL {
        let robot = cogiro(behind);
        let rest = at_rest(&robot);
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 9.0).unwrap();
        let found = modes::below(&dynamics, 9.0);
        let mode = &found.modes[found.first_platform(0.5).unwrap()];
        let fractions: Vec<f64> = (0..=200).map(|k| f64::from(k) / 200.0).collect();
        let [first, second] = [0, 1].map(|cable| {
            let stations = CableStations::new(&robot, &rest, &dynamics, cable, &fractions, false).unwrap();
            let moved = stations.in_mode(&dynamics, mode);
            let LocalAxes { e, n, b } = stations.axes;
            let points_w: Vec<Vec3> = moved.iter().map(|[x, y, z]| e * *x + n * *y + b * *z).collect();
            for pair in points_w.windows(2) {
                assert!((pair[0] - pair[1]).norm() < 0.3);
            }
            points_w[200]
        });
        // Without drives, both cables of a post end at one displacement.
        let size = first.norm();
        assert!(size > 1e-4, "{behind:?}: {size}");
        if behind == Behind::Nothing {
            assert!((first - second).norm() < 1e-9 * size, "{first:?} {second:?}");
        }
    }
}
