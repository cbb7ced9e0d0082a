//! Loss of the stretch of ropes: closed forms of all cable models, limits, and energies to first order.

use funicular::cable::{CableModel, DynamicCable, EndStiffness, Sag};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Complex, Mat3};
use funicular::modes::{self, damped};
use funicular::response;
use funicular::robot::{Damping, Robot, StretchLoss, WinchMode};
use funicular::statics::{self, Equilibrium, StaticModel};
use std::f64::consts::TAU;

const LOSS: StretchLoss = StretchLoss { factor: 0.04, time: 1e-3 };

/// Robot of the library whose ropes have this damping and loss, at rest.
fn lossy(text: &str, damping: Damping, loss: StretchLoss) -> (Robot, Equilibrium) {
    let mut robot = Robot::from_toml(text).unwrap();
    for cable in &mut robot.cables {
        (cable.material.damping, cable.material.stretch_loss) = (damping, loss);
    }
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    (robot, rest)
}

fn linearised(robot: &Robot, rest: &Equilibrium, cable_model: CableModel, below_hz: f64) -> Dynamics {
    Dynamics::about(robot, rest, Linearisation { cable_model, ..Linearisation::default() }, below_hz).unwrap()
}

/// Stiffness of a cable in its model at ω: entries along, coupled and normal in its plane, and out of it.
fn end_stiffness(robot: &Robot, rest: &Equilibrium, model: CableModel, omega: f64) -> ([Complex; 4], DynamicCable) {
    let found = EndStiffness::new(robot, 0, &rest.cables[0], model, false, WinchMode::AsGiven, 20.0).unwrap();
    let EndStiffness::Dynamic(cable) = found else { panic!("a cable with loss") };
    let k = cable.damped(omega);
    ([k.axial, k.coupling, k.normal, k.out_of_plane], cable)
}

fn factor(omega: f64) -> Complex {
    Complex::new(1.0, LOSS.factor + omega * LOSS.time)
}

fn assert_close(ours: &[Complex; 4], exact: &[Complex; 4], tolerance: f64, what: &str) {
    let size = exact.iter().map(|entry| entry.norm()).fold(0.0, f64::max);
    for (ours, exact) in ours.iter().zip(exact) {
        assert!((ours - exact).norm() <= tolerance * size, "{what}: {ours} {exact}, {size}");
    }
}

/// A spring has EA h/L₀ along its chord, a shallow cable Irvine's stiffness with EA h in it.
#[test]
fn springs_and_shallow_cables_at_rest_have_their_closed_form() {
    for text in [funicular_robots::YUAN2014_4MM, funicular_robots::COGIRO] {
        let (robot, rest) = lossy(text, Damping::Ratio(0.003), LOSS);
        let (state, omega) = (&rest.cables[0], 30.0);
        let zero = Complex::from(0.0);
        let (ours, _) = end_stiffness(&robot, &rest, CableModel::Spring, omega);
        let spring = factor(omega) * (robot.cables[0].material.axial_stiffness / state.unstrained_length);
        assert_close(&ours, &[spring, zero, zero, zero], 1e-13, "spring");

        let sag = Sag::of(&robot, 0, state);
        let (h, string) = (factor(omega), Complex::from(sag.tension / sag.chord));
        let axial = h * (sag.axial_stiffness / sag.effective_length) / (h * (sag.lambda2 / 12.0) + 1.0);
        let (ours, _) = end_stiffness(&robot, &rest, CableModel::ShallowStatic, omega);
        assert_close(&ours, &[axial, zero, string, string], 1e-13, "shallow");
    }
}

/// Starossek's closed form with EA h in the place of EA, written out again for complex numbers.
#[test]
fn a_shallow_cable_vibrates_by_its_closed_form() {
    for text in [funicular_robots::YUAN2014_4MM, funicular_robots::COGIRO] {
        let (robot, rest) = lossy(text, Damping::Ratio(0.003), LOSS);
        let sag = Sag::of(&robot, 0, &rest.cables[0]);
        for hz in [0.4, 1.7, 6.0, 14.0] {
            let omega = hz * TAU;
            let h = factor(omega);
            let gamma = Complex::new(1.0, -0.006)
                * (omega * omega * sag.chord * sag.chord * sag.mass_per_length / (4.0 * sag.tension));
            let root = gamma.sqrt();
            let (c, sigma) = (root.cos(), root.sin() / root);
            let q = (sigma - c) / gamma;
            let sagging = q * h * (0.25 * sag.lambda2);
            let along = h * (sag.axial_stiffness / sag.effective_length);
            let string = sag.tension / sag.chord;
            let exact = [
                along * c / (c + sagging),
                along * gamma * q / (c + sagging) * (0.5 * sag.epsilon),
                (c / sigma - gamma * (sigma + sagging) / (c + sagging)) * string,
                (c / sigma - gamma * sigma / c) * string,
            ];
            let (ours, _) = end_stiffness(&robot, &rest, CableModel::ShallowDynamic, omega);
            assert_close(&ours, &exact, 1e-9, &format!("{}, {hz} Hz", robot.name));
        }
    }
}

/// A hanging cable at rest: the closed form of its strain, and slow vibration with the moments of the strain. They
/// share neither the integrals nor the motions.
#[test]
fn a_hanging_cable_at_rest_is_the_limit_of_slow_vibration() {
    for text in [funicular_robots::YUAN2014_4MM, funicular_robots::COGIRO, funicular_robots::FAST] {
        let loss = StretchLoss { factor: 0.2, time: 0.0 };
        let (robot, rest) = lossy(text, Damping::Ratio(0.0), loss);
        let omega = 1e-5;
        let (still, cable) = end_stiffness(&robot, &rest, CableModel::CatenaryStatic, omega);
        let (slow, _) = end_stiffness(&robot, &rest, CableModel::CatenaryDynamic, omega);
        assert_close(&slow, &still, 1e-7, &robot.name);
        assert!(still[0].im > 0.0 && cable.clamped_modes_below(1e6) == 0);

        // At 0 Hz nothing is lost.
        let rest_of = |model| end_stiffness(&robot, &rest, model, 0.0).0;
        for entry in [CableModel::CatenaryStatic, CableModel::CatenaryDynamic].map(rest_of).concat() {
            assert!(entry.im == 0.0, "{entry}");
        }
    }
}

/// The direction's integrals by a sum over points.
#[test]
fn directions_add_up_along_the_cable() {
    let (_, rest) = lossy(funicular_robots::YUAN2014_4MM, Damping::Ratio(0.0), LOSS);
    let catenary = &rest.cables[0].hanging.as_ref().unwrap().catenary;
    let (count, rope) = (20_000, catenary.rope());
    let mut sum = [[0.0; 2]; 2];
    for k in 0..count {
        let s = (f64::from(k) + 0.5) / f64::from(count) * rope.unstrained_length;
        let v = catenary.vertical_force_at_start() + rope.weight_per_length * s;
        let (h, tension) = (catenary.horizontal_force(), catenary.tension_at(s));
        let t = [h / tension, v / tension];
        (0..2).for_each(|i| (0..2).for_each(|j| sum[i][j] += t[i] * t[j] * rope.unstrained_length / f64::from(count)));
    }
    for (ours, sum) in catenary.direction_integrals().concat().iter().zip(sum.concat()) {
        assert!((ours - sum).abs() < 1e-8 * rope.unstrained_length, "{ours} {sum}");
    }
}

/// Undamped modes do not change by a bit; to first order the loss adds half of the loss factor times the share of the
/// stretch, and these shares are the derivatives of the frequencies by the axial stiffness in the vibration alone.
#[test]
fn damping_is_half_of_the_loss_factor_times_the_share_of_the_stretch() {
    for (text, below_hz) in [(funicular_robots::YUAN2014_4MM, 5.0), (funicular_robots::COGIRO, 9.0)] {
        let small = StretchLoss { factor: 1e-6, time: 0.0 };
        let (plain, rest) = lossy(text, Damping::Ratio(0.0), StretchLoss::default());
        let (robot, _) = lossy(text, Damping::Ratio(0.0), small);
        let model = CableModel::CatenaryDynamic;
        let found = modes::below(&linearised(&robot, &rest, model, below_hz), below_hz);
        let expected = modes::below(&linearised(&plain, &rest, model, below_hz), below_hz);
        assert!(found.certified && found.count_below == expected.count_below);

        let dynamics = linearised(&robot, &rest, model, below_hz);
        let damped = damped::damped_modes(&dynamics, &found);
        assert!(damped.certified);
        for ((mode, plain), of) in found.modes.iter().zip(&expected.modes).zip(&damped.modes) {
            assert_eq!(mode.frequency_hz.to_bits(), plain.frequency_hz.to_bits());
            assert!(plain.stretching_shares.is_empty() && plain.damping_ratio == 0.0);
            let share: f64 = mode.stretching_shares.iter().sum();
            assert!((0.0..1.0 + 1e-9).contains(&share), "{share}");
            assert!((mode.damping_ratio - 0.5e-6 * share).abs() <= 1e-15, "{} {share}", mode.damping_ratio);
            let error = (of.damping_ratio() - 0.5e-6 * share).abs();
            assert!(error < 1e-4 * 0.5e-6 * share + 1e-14, "{} {share}", of.damping_ratio());
        }
    }
}

/// Massless ropes: every model with its loss has the same damping as the spring, up to sag, and a Kelvin–Voigt loss is
/// a dashpot beside it.
#[test]
fn light_ropes_are_lossy_springs() {
    let text = funicular_robots::COGIRO.replace("mass_kg_per_m = 0.064", "mass_kg_per_m = 1e-6");
    let (robot, rest) = lossy(&text, Damping::Ratio(0.0), StretchLoss { factor: 0.05, time: 0.0 });
    let ratios = |model: CableModel| -> Vec<f64> {
        let dynamics = linearised(&robot, &rest, model, 20.0);
        let found = modes::below(&dynamics, 20.0);
        let damped = damped::damped_modes(&dynamics, &found);
        assert!(damped.certified && damped.modes.len() >= 6, "{model}: {}", damped.modes.len());
        damped.modes.iter().map(damped::DampedMode::damping_ratio).collect()
    };
    let exact = ratios(CableModel::CatenaryStatic);
    for model in CableModel::ALL {
        // Springs have no stiffness across their chords.
        let tolerance = if model == CableModel::Spring { 2e-2 } else { 1e-6 };
        for (ratio, exact) in ratios(model).iter().zip(&exact) {
            assert!((ratio / exact - 1.0).abs() < tolerance, "{model}: {ratio} {exact}");
        }
    }
}

/// With its strains known, a robot without loss has the same modes, and shares of the stretch.
#[test]
fn shares_of_the_stretch_are_known_without_loss() {
    let (robot, rest) = lossy(funicular_robots::COGIRO, Damping::Ratio(0.003), StretchLoss::default());
    for cable_model in CableModel::ALL.into_iter().filter(|model| *model != CableModel::ShallowDynamic) {
        let linearisation = Linearisation { cable_model, ..Linearisation::default() };
        let dynamics = Dynamics::with_strains(&robot, &rest, linearisation, 9.0).unwrap();
        let found = modes::below(&dynamics, 9.0);
        let plain = modes::below(&Dynamics::about(&robot, &rest, linearisation, 9.0).unwrap(), 9.0);
        assert!(found.certified && found.modes.len() == plain.modes.len());
        for (mode, plain) in found.modes.iter().zip(&plain.modes) {
            assert!((mode.frequency_hz / plain.frequency_hz - 1.0).abs() < 1e-9);
            assert!((mode.damping_ratio - plain.damping_ratio).abs() < 1e-9);
        }
        let first = &found.modes[found.first_platform(0.5).unwrap()];
        let share: f64 = first.stretching_shares.iter().sum();
        assert!(share > 0.9 && share < 1.01, "{cable_model}: {share}");
    }
}

/// Energy is lost at every frequency: the imaginary part of the stiffness is positive semidefinite.
#[test]
fn the_loss_takes_energy_at_every_frequency() {
    let (robot, rest) = lossy(funicular_robots::YUAN2014_4MM, Damping::Ratio(0.0), LOSS);
    for model in CableModel::ALL {
        for hz in [0.1, 0.9, 2.3, 7.7, 15.0] {
            let (k, _) = end_stiffness(&robot, &rest, model, hz * TAU);
            let [a, b, c, o] = k.map(|entry| entry.im);
            let lost = Mat3::new(a, b, 0.0, b, c, 0.0, 0.0, 0.0, o).symmetric_eigenvalues();
            assert!(lost.min() > -1e-9 * lost.max() && lost.max() > 0.0, "{model}, {hz} Hz: {lost}");
        }
    }
}

/// Many frequencies at once use the complex poles of cables with a constant loss factor; one frequency solves with the
/// moments of the strain. Both are the same at every frequency, at rest too, where nothing is lost.
#[test]
fn complex_poles_of_cables_give_the_responses_of_single_frequencies() {
    let models = [CableModel::CatenaryDynamic, CableModel::ShallowDynamic, CableModel::CatenaryStatic];
    for text in [funicular_robots::YUAN2014_4MM, funicular_robots::COGIRO, funicular_robots::COGIRO_WINCHES] {
        for (damping, factor) in [(Damping::Ratio(0.003), 0.02), (Damping::Viscous(0.05), 0.3)] {
            let (robot, rest) = lossy(text, damping, StretchLoss { factor, time: 0.0 });
            for model in models {
                let dynamics = linearised(&robot, &rest, model, 20.0);
                let frequencies: Vec<f64> = (0..1501).map(|k| 0.013 * f64::from(k)).collect();
                let many = response::receptances(&dynamics, &frequencies).unwrap();

                for (hz, matrix) in frequencies.iter().zip(&many).step_by(37) {
                    let one = response::receptance(&dynamics, hz * TAU);
                    let gap = (matrix - one).norm() / one.norm();
                    assert!(gap < 1e-10, "{}, {model}, loss factor {factor}, {hz} Hz: {gap}", robot.name);
                }
            }
        }
    }
}
