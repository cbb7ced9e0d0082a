//! Natural frequencies against published models, other algorithms and identities.

use crate::random::any_robot;
use funicular::cable::exact::ExactError;
use funicular::cable::{CableModel, EndStiffness};
use funicular::catenary::Rope;
use funicular::catenary::space::HangingCable;
use funicular::dynamics::{Assembly, Dynamics, DynamicsError, Linearisation};
use funicular::math::{Mat6, Vec3, rotation};
use funicular::modes::{self, Kind};
use funicular::robot::{Pose, Robot, State};
use funicular::statics::{self, CableState, Equilibrium, Stability, StaticModel};
use proptest::prelude::*;
use std::f64::consts::TAU;

use crate::reference::{list, number, numbers, rows, table};

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

/// Eight straight cables and a 30 kg point mass in the middle of a 2.5 m cube.
/// Of cables that have no catenary.
const CLOSED_FORM: Linearisation = Linearisation {
    cable_model: CableModel::ClosedForm,
    assembly: funicular::dynamics::Assembly::Consistent,
    in_plane_only: false,
};

#[test]
fn a_point_mass_on_eight_strings_has_every_published_frequency_with_its_multiplicity() {
    let (mut robot, _) = load(funicular_robots::SAP2000_8_CABLE_POINT_MASS);
    // The published model is the linearisation at the middle of the cube with the tensions of its lengths, without sag.
    robot.gravity_w = Vec3::zeros();
    let cube = table("cube_point_mass");
    assert_eq!(rows("cube_point_mass").len(), 2);
    for row in rows("cube_point_mass") {
        let lengths: [f64; 8] = numbers(row, "unstrained_length_m");
        let expected = list(row, "frequencies_hz");
        let pose = Pose::new(numbers(cube, "position_m"), [0.0; 3]);
        let cables = robot.cables.iter().zip(lengths).map(|(cable, unstrained_length)| {
            let axial_stiffness = cable.material.axial_stiffness;
            let rope = Rope { unstrained_length, weight_per_length: 0.0, axial_stiffness };
            let hanging = HangingCable::new(pose.position_w, cable.anchor_w, Vec3::z(), rope).unwrap();
            CableState {
                attachment_w: pose.position_w,
                lever_w: Vec3::zeros(),
                anchor_w: cable.anchor_w,
                unstrained_length,
                force_on_platform_w: hanging.force_on_start_w(),
                tension_platform: hanging.catenary.tension_at_start(),
                tension_anchor: hanging.catenary.tension_at_end(),
                hanging: Some(hanging),
            }
        });
        let state = Equilibrium {
            pose,
            model: StaticModel::Spring,
            cables: cables.collect(),
            residual: 0.0,
            iterations: 0,
            stability: Stability::Rigid,
        };
        let strain = state.cables.iter().map(|c| c.tension_platform).fold(0.0, f64::max)
            / robot.cables[0].material.axial_stiffness;
        let dynamics = Dynamics::about(&robot, &state, CLOSED_FORM, 20.0).unwrap();
        // The lists end before the third family of the strings.
        let limit = number(cube, "limit_hz");
        let found = modes::below(&dynamics, limit);
        assert!(found.certified);
        assert_eq!(found.modes.len(), expected.len());
        for (mode, theirs) in found.modes.iter().zip(expected) {
            // The reference has axial waves, which the closed form leaves out: its axial stiffness is too large by
            // (ω l √(m/EA))²/3 (l = 2.165 m), its frequencies by up to half of that where a mode stretches the cables.
            // Its strings have the mass of the unstrained length spread over the stretched one, ours per length: half
            // of the strain.
            let axial = (TAU * theirs * number(cube, "longest_cable_m")).powi(2) * number(cube, "mass_kg_per_m")
                / number(cube, "axial_stiffness_n");
            let moves = if mode.platform_energy_fraction == 0.0 { 0.0 } else { axial / 6.0 };
            let bound = moves + 0.501 * strain;
            let gap = (mode.frequency_hz / theirs - 1.0).abs();
            assert!(gap < bound, "{} for {theirs}", mode.frequency_hz);
        }
    }
}

#[test]
fn counts_grow_by_one_at_every_listed_frequency_and_nowhere_else() {
    let (robot, rest) = yuan();
    for assembly in [Assembly::Consistent, Assembly::Paper] {
        let dynamics = Dynamics::about(&robot, &rest, Linearisation { assembly, ..Default::default() }, 20.0).unwrap();
        let found = modes::below(&dynamics, 20.0);
        assert!(found.certified);
        for (i, mode) in found.modes.iter().enumerate() {
            let omega = mode.frequency_hz * TAU;
            assert!(dynamics.modes_below(omega * (1.0 - 1e-9)) <= i, "{assembly:?} {i}");
            assert!(dynamics.modes_below(omega * (1.0 + 1e-9)) > i, "{assembly:?} {i}");
        }
    }
}

#[test]
fn constant_models_give_the_eigenvalues_of_stiffness_and_mass() {
    let (robot, rest) = yuan();
    for cable_model in [CableModel::Spring, CableModel::StaticSag, CableModel::CatenaryTangent] {
        let dynamics =
            Dynamics::about(&robot, &rest, Linearisation { cable_model, ..Default::default() }, 20.0).unwrap();
        let found = modes::below(&dynamics, 100.0);
        assert!(found.certified);
        // Another algorithm: Cholesky of M, eigenvalues of L⁻¹ K L⁻ᵀ.
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
        // xᵀ X x about the mode: one peak, |X|² falls to half at ±ζ.
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
        cable.anchor_w = turn * cable.anchor_w;
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
    // The centre of mass high above the attachments, by external hand held at the pose of springs without moment arm.
    let (mut robot, _) = load(funicular_robots::YUAN2014_4MM);
    let (_, rest) = yuan();
    robot.platform.center_of_mass_p = Vec3::new(0.0, 0.0, 200.0);
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 20.0).unwrap();
    let found = modes::below(&dynamics, 5.0);
    assert!(found.unstable_directions >= 1);
    assert_eq!(found.modes.len() + found.unstable_directions, found.count_below);
}

#[test]
fn cables_are_warned_about_outside_the_models_range() {
    use funicular::validity::{self, Warning};
    let (robot, lengths) = load(funicular_robots::YUAN2014_8MM);
    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
    let warnings = validity::of_dynamics(&robot, &rest, CableModel::ClosedForm, 20.0);
    let [Warning::DeepSag { cables, .. }] = &warnings[..] else { panic!("{warnings:?}") };
    assert!(cables.iter().all(|deep| deep.ratio > 0.05 && deep.ratio < 0.07));
    for deep in cables {
        // Measured here: the first clamped frequency in plane of either model.
        let i = robot.cables.iter().position(|cable| cable.name == deep.cable).unwrap();
        let first = |cable_model| {
            let one = EndStiffness::new(&robot, i, &rest.cables[i], cable_model, true, 5.0).unwrap();
            let EndStiffness::Dynamic(form) = one else { panic!("it vibrates") };
            form.clamped_frequencies_below(5.0 * TAU)[0]
        };
        let error = first(CableModel::ClosedForm) / first(CableModel::Exact) - 1.0;
        assert!((deep.error.unwrap() - error).abs() < 1e-9 && error.abs() > 0.01, "{deep:?}");
        assert!(warnings[0].to_string().contains(&format!("first frequency off by {:+.1} %", 100.0 * error)));
    }
    let names: Vec<&str> = cables.iter().map(|deep| deep.cable.as_str()).collect();
    assert_eq!(names, ["5", "6"], "the long cables sag by some 6 % of the chord");
    assert!(warnings[0].to_string().contains("more than 1/20"));
    assert!(validity::of_dynamics(&robot, &rest, CableModel::CatenaryTangent, 20.0).is_empty());
    let axial = validity::of_dynamics(&robot, &rest, CableModel::Spring, 60.0);
    assert!(matches!(&axial[..], [Warning::AxialWaves { .. }]), "{axial:?}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..Default::default() })]

    #[test]
    fn lists_of_random_robots_agree_with_the_count_at_any_frequency(
        (robot, lengths) in any_robot(),
        parts in prop::collection::vec(0.0f64..1.0, 40),
        in_plane_only in any::<bool>(),
        exact in any::<bool>(),
    ) {
        let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
        let (cable_model, limit) = if exact { (CableModel::Exact, 6.0) } else { (CableModel::ClosedForm, 12.0) };
        let linearisation = Linearisation { cable_model, in_plane_only, ..Default::default() };
        let dynamics = match Dynamics::about(&robot, &rest, linearisation, limit) {
            Ok(dynamics) => dynamics,
            // Very slack and heavy cables have hundreds of resonances there: refused with a reason.
            Err(DynamicsError::Exact { reason: ExactError::TooFine { .. }, .. }) => return Ok(()),
            Err(other) => return Err(TestCaseError::fail(other.to_string())),
        };
        let found = modes::below(&dynamics, limit);
        prop_assert!(found.certified, "{} of {}", found.modes.len(), found.count_below);
        prop_assert!(found.modes.windows(2).all(|pair| pair[0].frequency_hz <= pair[1].frequency_hz));
        for part in parts {
            let f = limit * part;
            let listed = found.modes.iter().filter(|m| m.frequency_hz < f).count();
            // A frequency drawn within rounding of a mode may fall on either side.
            prop_assume!(found.modes.iter().all(|m| (m.frequency_hz / f - 1.0).abs() > 1e-11));
            prop_assert_eq!(dynamics.modes_below(f * TAU), listed + found.unstable_directions, "below {} Hz", f);
        }
    }
}

#[test]
fn compare_measures_against_the_closed_form_where_the_exact_cable_is_out_of_reach() {
    use funicular::compare;
    let (robot, mut lengths) = load(funicular_robots::YUAN2014_4MM);
    let reference = |lengths: &[f64], below_hz: f64| {
        let rest = statics::forward(&robot, lengths, StaticModel::Catenary, None).unwrap();
        compare::compare(&robot, &rest, below_hz, Linearisation::default()).unwrap()
    };
    let usual = reference(&lengths, 5.0);
    assert_eq!((usual.reference, usual.advice.model), (CableModel::Exact, CableModel::ClosedForm));
    // A rope of twice its length has hundreds of resonances below 60 Hz.
    lengths[0] = 14.0;
    let slack = reference(&lengths, 60.0);
    assert_eq!(slack.reference, CableModel::ClosedForm);
    let exact = slack.models.iter().find(|m| m.model == CableModel::Exact).unwrap();
    assert!(exact.modes.as_ref().unwrap_err().to_string().contains("unknowns for one cable"));
}

#[test]
fn a_list_beyond_the_resolution_of_exact_cables_is_not_certified() {
    let (robot, rest) = yuan();
    let linearisation = Linearisation { cable_model: CableModel::Exact, ..Default::default() };
    let dynamics = Dynamics::about(&robot, &rest, linearisation, 5.0).unwrap();
    assert!(modes::below(&dynamics, 5.0).certified);
    assert!(!modes::below(&dynamics, 6.0).certified);
}
