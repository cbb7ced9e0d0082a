//! Reduced second-order model against the full one.

mod drives;

use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{CDMat, Complex, Vec3};
use funicular::modes;
use funicular::reduced_model::{Coordinate, DampingAt, ReductionError, RequestedModel, SecondOrder, reduce};
use funicular::response::{self, Quantity, Signal};
use funicular::robot::{Damping, Robot, State};
use funicular::statics::{self, Equilibrium, StaticModel};
use std::f64::consts::TAU;

fn at_rest(damping: Damping) -> (Robot, Equilibrium, Dynamics) {
    let mut robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
    for cable in &mut robot.cables {
        cable.material.damping = damping;
    }
    let State::Lengths(lengths) = &robot.state else { panic!("its file gives lengths") };
    let rest = statics::forward(&robot, lengths, StaticModel::Catenary, None).unwrap();
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 6.0).unwrap();
    (robot, rest, dynamics)
}

fn on_platform(direction_w: Vec3) -> Signal {
    Signal::Along { direction_w, point_p: Vec3::new(0.1, 0.0, 0.0) }
}

const REQUESTED: RequestedModel =
    RequestedModel { below_hz: 5.0, tolerance: 1e-3, damping_at: DampingAt::NaturalFrequencies };

fn model(damping: Damping, requested: RequestedModel) -> (SecondOrder, Equilibrium, Dynamics) {
    let (robot, rest, dynamics) = at_rest(damping);
    let inputs = [on_platform(Vec3::z()), on_platform(Vec3::x())];
    let on_cable = Signal::OnCable { cable: 2, fraction: 0.4, direction_w: Vec3::y() };
    let outputs = [
        (on_platform(Vec3::y()), Quantity::Displacement),
        (on_platform(Vec3::z()), Quantity::Acceleration),
        (on_cable, Quantity::Velocity),
    ];
    (reduce(&robot, &rest, &dynamics, &inputs, &outputs, requested, &mut |_| true).unwrap(), rest, dynamics)
}

#[test]
fn with_viscous_damping_it_has_the_responses_and_the_damped_frequencies_of_the_full_model() {
    let (found, rest, dynamics) = model(Damping::Viscous(0.02), RequestedModel { tolerance: 0.0, ..REQUESTED });
    assert!(found.truncation_error.unwrap() < 1e-12 && found.damping_error == Some(0.0));
    assert!(found.frequency_error < 1e-12);
    // Responses, by elimination of all coordinates.
    let z = response::along(&Vec3::z(), &Vec3::new(0.1, 0.0, 0.0), &rest.pose);
    let y = response::along(&Vec3::y(), &Vec3::new(0.1, 0.0, 0.0), &rest.pose);
    for frequency_hz in [0.3, 1.1, 1.19, 2.7, 4.4] {
        let full = response::frf(&dynamics, &[frequency_hz], &z, &y, Quantity::Displacement).unwrap()[0];
        let reduced = found.receptance(frequency_hz * TAU).unwrap()[(0, 0)];
        assert!((full - reduced).norm() < 1e-9 * full.norm(), "{frequency_hz}: {full} {reduced}");
    }
    // Eigenvalues of the state matrix, by a general method that does not use the poles.
    let undamped = modes::below(&dynamics, 5.0);
    let damped = modes::damped::damped_modes(&dynamics, &undamped);
    assert!(damped.certified);
    let eigenvalues = found.state_space().unwrap().a.complex_eigenvalues();
    for mode in &damped.modes {
        let lambda = mode.eigenvalue();
        let nearest = eigenvalues.iter().map(|other| (other - lambda).norm()).fold(f64::INFINITY, f64::min);
        // The state matrix has frequencies up to a thousand times the limit; the error of its eigenvalues is 1e-16 of
        // that squared.
        assert!(nearest < 1e-6 * lambda.norm(), "{lambda}: {nearest:e}");
    }
}

#[test]
fn a_small_model_is_as_good_as_it_says() {
    for damping in [Damping::Ratio(0.003), Damping::Ratio(0.03), Damping::Viscous(0.02)] {
        let (found, rest, dynamics) = model(damping, REQUESTED);
        assert!(found.truncation_error.unwrap() <= 1e-3, "{:?}", found.truncation_error);
        // About a hundred clamped modes of the cables, and three per cable for all the others.
        assert!(found.mass.nrows() < 140, "{}", found.mass.nrows());
        let x = response::along(&Vec3::x(), &Vec3::new(0.1, 0.0, 0.0), &rest.pose);
        let z = response::along(&Vec3::z(), &Vec3::new(0.1, 0.0, 0.0), &rest.pose);
        let all = found.damping_error.unwrap() + 1e-3;
        // Damping that is correct at each natural frequency has an error of second order in the response at peaks.
        assert!(all < 0.05, "{damping:?}: {all}");
        for frequency_hz in modes::below(&dynamics, 5.0).modes.iter().map(|mode| mode.frequency_hz).step_by(3) {
            let full = response::frf(&dynamics, &[frequency_hz], &x, &z, Quantity::Displacement).unwrap()[0];
            let reduced = found.receptance(frequency_hz * TAU).unwrap();
            let size = reduced.iter().map(|entry| entry.norm()).fold(0.0, f64::max);
            assert!((full - reduced[(1, 1)]).norm() < 1.5 * all * size, "{damping:?} {frequency_hz}");
        }
    }
}

#[test]
fn the_state_space_gives_motion_velocity_and_acceleration() {
    let (found, _, _) = model(Damping::Ratio(0.01), REQUESTED);
    let space = found.state_space().unwrap();
    let n = space.a.nrows();
    for frequency_hz in [0.7, 1.5, 3.3] {
        let omega = frequency_hz * TAU;
        let i_omega = Complex::new(0.0, omega);
        let shifted = CDMat::identity(n, n) * i_omega - space.a.map(Complex::from);
        let solved = shifted.lu().solve(&space.b.map(Complex::from)).unwrap();
        let transfer = space.c.map(Complex::from) * solved + space.d.map(Complex::from);
        let receptance = found.receptance(omega).unwrap();
        for input in 0..2 {
            for (output, factor) in [Complex::new(1.0, 0.0), i_omega * i_omega, i_omega].into_iter().enumerate() {
                let expected = receptance[(output, input)] * factor;
                assert!((transfer[(output, input)] - expected).norm() < 1e-8 * expected.norm(), "{output} {input}");
            }
        }
    }
}

#[test]
fn damping_at_one_frequency_is_right_there_and_grows_wrong_away_from_it() {
    let ratio = 0.01;
    let at = |damping_at| model(Damping::Ratio(ratio), RequestedModel { damping_at, ..REQUESTED }).0;
    let (own, one) = (at(DampingAt::NaturalFrequencies), at(DampingAt::Hz(2.5)));
    assert!(own.damping_error.unwrap() < 0.2 * one.damping_error.unwrap(), "{own:?}");
    // C for one frequency is 2ξω times the cables' mass: 2ξω for the coordinate of a clamped mode.
    let last = one.mass.nrows() - 1;
    assert!((one.damping[(last, last)] - 2.0 * ratio * 2.5 * TAU).abs() < 1e-12);
    assert!(matches!(one.coordinates[last], Coordinate::Clamped { out_of_plane: true, .. }));
    for matrix in [&own.mass, &own.damping, &own.stiffness] {
        assert!((matrix - matrix.transpose()).amax() <= 1e-9 * matrix.amax());
    }
    assert!(own.damping.symmetric_eigenvalues().min() > -1e-9 * own.damping.amax());
}

#[test]
fn the_closed_form_has_no_reduced_model_and_springs_have_the_platform_alone() {
    use funicular::cable::CableModel;
    let (robot, rest, _) = at_rest(Damping::Ratio(0.003));
    let with = |cable_model| {
        let linearisation = Linearisation { cable_model, ..Linearisation::default() };
        let dynamics = Dynamics::about(&robot, &rest, linearisation, 6.0).unwrap();
        let outputs = [(on_platform(Vec3::z()), Quantity::Displacement)];
        reduce(&robot, &rest, &dynamics, &[on_platform(Vec3::z())], &outputs, REQUESTED, &mut |_| true)
    };
    assert_eq!(with(CableModel::ShallowDynamic).unwrap_err(), ReductionError::Model);
    let spring = with(CableModel::CatenaryStatic).unwrap();
    assert_eq!(spring.mass.nrows(), 6);
    assert!(spring.truncation_error.unwrap() < 1e-12 && spring.damping.amax() == 0.0);
}
