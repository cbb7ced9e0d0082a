//! Natural frequencies against other algorithms and identities.

mod command;
mod damped;
mod fundamental;
mod release;
mod rigid_cables;
mod tracking;

use crate::random::any_robot;
use funicular::cable::CableModel;
use funicular::cable::catenary_dynamic::CatenaryDynamicError;
use funicular::dynamics::{Dynamics, DynamicsError, Linearisation};
use funicular::math::{Mat6, Vec3, rotation};
use funicular::modes::{self, Kind};
use funicular::robot::{Pose, Robot, State};
use funicular::statics::{self, Equilibrium, StaticModel};
use proptest::prelude::*;
use std::f64::consts::TAU;

fn load(text: &str) -> (Robot, Vec<f64>) {
    let robot = Robot::from_toml(text).unwrap();
    let State::Lengths(lengths) = robot.state.clone() else { panic!("given by lengths") };
    (robot, lengths)
}

fn yuan() -> (Robot, Equilibrium) {
    let (robot, lengths) = load(funicular_robots::YUAN2014_4MM);
    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
    (robot, rest)
}

#[test]
fn constant_models_give_the_eigenvalues_of_stiffness_and_mass() {
    let (robot, rest) = yuan();
    for cable_model in [CableModel::Spring, CableModel::ShallowStatic, CableModel::CatenaryStatic] {
        let dynamics =
            Dynamics::about(&robot, &rest, Linearisation { cable_model, ..Default::default() }, 20.0).unwrap();
        let found = modes::below(&dynamics, 100.0);
        assert!(found.certified);
        // Independent algorithm: Cholesky factor of M, eigenvalues of L⁻¹ K L⁻ᵀ.
        let factor = dynamics.mass().cholesky().unwrap().l();
        let inverse: Mat6 = factor.try_inverse().unwrap();
        let k = dynamics.stiffness(0.0).map(|k| k.re);
        let mut squares: Vec<f64> =
            (inverse * k * inverse.transpose()).symmetric_eigenvalues().iter().copied().collect();
        squares.sort_by(f64::total_cmp);
        assert_eq!(found.modes.len(), 6);
        for (mode, square) in found.modes.iter().zip(squares) {
            assert!((mode.frequency_hz / (square.sqrt() / TAU) - 1.0).abs() < 1e-10, "{cable_model}");
            assert_eq!(mode.kind, Kind::Platform);
            assert!((mode.platform_energy_fraction - 1.0).abs() < 1e-15);
        }
    }
}

#[test]
fn a_mode_is_a_motion_that_the_dynamic_stiffness_does_not_oppose() {
    let (robot, rest) = yuan();
    let mut quiet = robot.clone();
    for cable in &mut quiet.cables {
        cable.material.damping = funicular::robot::Damping::Ratio(0.0);
    }
    let dynamics = Dynamics::about(&quiet, &rest, Linearisation::default(), 20.0).unwrap();
    for mode in modes::below(&dynamics, 20.0).modes {
        let omega = mode.frequency_hz * TAU;
        let d = dynamics.stiffness(omega).map(|k| k.re) - dynamics.mass() * (omega * omega);
        let x = funicular::math::Vec6::from(mode.shape);
        assert!((d * x).norm() < 1e-6 * d.norm() * x.norm(), "{} Hz", mode.frequency_hz);
        let sum = mode.platform_energy_fraction + mode.cable_energy_fractions.iter().sum::<f64>();
        assert!((sum - 1.0).abs() < 1e-12 && mode.cable_energy_fractions.iter().all(|f| *f > -1e-12));
    }
}

#[test]
fn damping_to_first_order_is_the_width_of_the_resonance() {
    // The half-power width of the response of a well separated mode is 2ζf.
    let (robot, rest) = yuan();
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 20.0).unwrap();
    let found = modes::below(&dynamics, 3.0).modes;
    let mut checked = 0;
    for (i, mode) in found.iter().enumerate() {
        let gap = |j: usize| (found[j].frequency_hz / mode.frequency_hz - 1.0).abs();
        let alone = (i == 0 || gap(i - 1) > 0.03) && (i + 1 == found.len() || gap(i + 1) > 0.03);
        if !alone || mode.platform_energy_fraction < 0.02 {
            continue;
        }
        // Near the mode xᵀ X x has one peak, and |X|² falls to half at ±ζ.
        let x = funicular::math::Vec6::from(mode.shape);
        let f = mode.frequency_hz;
        let level = |f: f64| {
            let mx = dynamics.mass() * x;
            let values =
                funicular::response::frf(&dynamics, &[f], &mx, &mx, funicular::response::Quantity::Displacement);
            values.unwrap()[0].norm()
        };
        let top = level(f);
        let zeta = mode.damping_ratio;
        for side in [-1.0, 1.0] {
            let half = level(f * (1.0 + side * zeta)) / top;
            assert!((half - 0.5f64.sqrt()).abs() < 0.06, "{f} Hz: {half}");
        }
        checked += 1;
    }
    assert!(checked >= 3, "{checked} modes stand alone");
}

#[test]
fn turning_the_whole_world_changes_no_frequency() {
    let (robot, lengths) = load(funicular_robots::COGIRO);
    let turn = rotation::from_roll_pitch_yaw_deg(25.0, -40.0, 70.0);
    let mut turned = robot.clone();
    turned.gravity_w = turn * robot.gravity_w;
    for cable in &mut turned.cables {
        cable.anchor = cable.anchor.rotated(&turn);
    }
    let list = |robot: &Robot, start: Option<&Pose>| {
        let rest = statics::forward(robot, &lengths, StaticModel::Catenary, start).unwrap();
        let found = modes::below(&Dynamics::about(robot, &rest, Linearisation::default(), 20.0).unwrap(), 20.0);
        assert!(found.certified);
        (rest.pose, found.modes.iter().map(|m| m.frequency_hz).collect::<Vec<f64>>())
    };
    let (pose, straight) = list(&robot, None);
    let start = Pose { position_w: turn * pose.position_w, rot_wp: turn * pose.rot_wp };
    let (_, other) = list(&turned, Some(&start));
    assert_eq!(straight.len(), other.len());
    for (a, b) in straight.iter().zip(&other) {
        assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    }
}

#[test]
fn an_unstable_robot_says_so_and_still_lists_what_vibrates() {
    // The centre of mass is moved high above the attachments, while the cables keep the forces of the stable
    // equilibrium.
    let (mut robot, _) = load(funicular_robots::YUAN2014_4MM);
    let (_, rest) = yuan();
    robot.platform.center_of_mass_p = Vec3::new(0.0, 0.0, 200.0);
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 20.0).unwrap();
    let found = modes::below(&dynamics, 5.0);
    assert!(found.unstable_directions >= 1);
    assert_eq!(found.modes.len() + found.unstable_directions, found.count_below);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..Default::default() })]

    #[test]
    fn lists_of_random_robots_agree_with_the_count_at_any_frequency(
        (robot, lengths) in any_robot(),
        fractions in prop::collection::vec(0.0f64..1.0, 40),
        in_plane_only in any::<bool>(),
        catenary in any::<bool>(),
    ) {
        let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
        let (cable_model, limit) = if catenary { (CableModel::CatenaryDynamic,
            6.0) } else { (CableModel::ShallowDynamic, 12.0) };
        let linearisation = Linearisation { cable_model, in_plane_only, ..Default::default() };
        let dynamics = match Dynamics::about(&robot, &rest, linearisation, limit) {
            Ok(dynamics) => dynamics,
            // Very slack and heavy cables have hundreds of resonances in this range and are refused with a reason.
            Err(DynamicsError::CatenaryDynamic { reason: CatenaryDynamicError::TooFine { .. }, .. }) => return Ok(()),
            Err(other) => return Err(TestCaseError::fail(other.to_string())),
        };
        let found = modes::below(&dynamics, limit);
        prop_assert!(found.certified, "{} of {}", found.modes.len(), found.count_below);
        prop_assert!(found.modes.windows(2).all(|pair| pair[0].frequency_hz <= pair[1].frequency_hz));
        for fraction in fractions {
            let f = limit * fraction;
            let listed = found.modes.iter().filter(|m| m.frequency_hz < f).count();
            // A frequency drawn within rounding of a mode may fall on either side.
            prop_assume!(found.modes.iter().all(|m| (m.frequency_hz / f - 1.0).abs() > 1e-11));
            prop_assert_eq!(dynamics.modes_below(f * TAU), listed + found.unstable_directions, "below {} Hz", f);
        }
    }
}

#[test]
fn a_list_beyond_the_resolution_of_catenary_dynamic_cables_is_not_certified() {
    let (robot, rest) = yuan();
    let linearisation = Linearisation { cable_model: CableModel::CatenaryDynamic, ..Default::default() };
    let dynamics = Dynamics::about(&robot, &rest, linearisation, 5.0).unwrap();
    assert!(modes::below(&dynamics, 5.0).certified);
    assert!(!modes::below(&dynamics, 6.0).certified);
}
