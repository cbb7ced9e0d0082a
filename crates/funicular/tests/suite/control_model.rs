//! State space for control: its stated error against an independent evaluation, its order against a search.

use crate::library;
use crate::random::Draw;
use crate::random::campaign::robots;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{CDMat, Complex, DMat, Vec3};
use funicular::modes::{self, Kind};
use funicular::reduced_model::{
    ControlModel, DampingAt, ReductionError, RequestedModel, RequestedStateSpace, STEPS, StateSpace, StateSpaceSize,
    control_model, reduce,
};
use funicular::response::{self, Port, Quantity, Signal};
use funicular::robot::{Damping, Robot};
use funicular::statics::{self, Equilibrium, StaticModel};
use std::f64::consts::TAU;

/// Robot linearised for frequencies up to a limit.
struct LimitedRobot {
    name: String,
    robot: Robot,
    rest: Equilibrium,
    dynamics: Dynamics,
    below_hz: f64,
}

impl LimitedRobot {
    fn new(name: &str, robot: Robot, rest: Equilibrium, below_hz: f64) -> Self {
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), below_hz).unwrap();
        Self { name: name.to_owned(), robot, rest, dynamics, below_hz }
    }

    /// The limit above about `count` modes.
    fn with_modes(name: &str, robot: &Robot, rest: &Equilibrium, count: usize) -> Self {
        let mut below_hz = 0.3;
        loop {
            let case = Self::new(name, robot.clone(), rest.clone(), below_hz);
            if case.dynamics.modes_below(below_hz * TAU) >= count || below_hz > 500.0 {
                return case;
            }
            below_hz *= 1.4;
        }
    }

    fn model(
        &self,
        inputs: &[Signal],
        outputs: &[(Signal, Quantity)],
        size: StateSpaceSize,
    ) -> Result<ControlModel, ReductionError> {
        let requested =
            RequestedStateSpace { below_hz: self.below_hz, size, damping_at: DampingAt::NaturalFrequencies };
        control_model(&self.robot, &self.rest, &self.dynamics, inputs, outputs, requested, &mut |_| true)
    }

    /// Frequencies that share no rule with those of the library: random ones, and several on each peak.
    fn frequencies(&self) -> Vec<f64> {
        let mut draw = Draw(20_140_531);
        let mut all: Vec<f64> = (0..600).map(|_| draw.between(1e-6, 1.0) * self.below_hz).collect();
        for mode in modes::below(&self.dynamics, self.below_hz).modes {
            let around = [0.0, 0.17, -0.17, 0.61, -0.61, 1.1, -1.1, 2.3, -2.3, 7.0, -7.0];
            all.extend(around.map(|t| mode.frequency_hz * (1.0 + t * mode.damping_ratio)));
        }
        all.retain(|f| *f > 0.0 && *f <= self.below_hz);
        all
    }

    /// Response by the full model.
    fn full(&self, input: &Signal, output: &(Signal, Quantity), frequencies_hz: &[f64]) -> Vec<Complex> {
        let loaded = matches!(input, Signal::OnCable { .. });
        let ports = Port::all(&self.robot, &self.rest, &self.dynamics, &[*input, output.0], loaded).unwrap();
        response::between(&self.dynamics, frequencies_hz, &ports[0], &ports[1], output.1).unwrap()
    }

    /// Maximum error of each pair relative to its peak, evaluated from A, B, C, D alone; by columns.
    fn error(&self, inputs: &[Signal], outputs: &[(Signal, Quantity)], model: &ControlModel) -> Vec<f64> {
        let frequencies = self.frequencies();
        let reduced: Vec<CDMat> = frequencies.iter().map(|f| transfer(&model.space, f * TAU)).collect();
        let mut errors = Vec::new();
        for (i, input) in inputs.iter().enumerate() {
            for (o, output) in outputs.iter().enumerate() {
                let full = self.full(input, output, &frequencies);
                let peak = full.iter().map(|g| g.norm()).fold(0.0, f64::max);
                let gap = full.iter().zip(&reduced).map(|(g, r)| (g - r[(o, i)]).norm()).fold(0.0, f64::max);
                let stated = &model.responses[i * outputs.len() + o];
                // Every peak is found: none of these frequencies is above it.
                assert!(peak <= stated.peak * (1.0 + 1e-4), "{} {o} {i}: {peak} {}", self.name, stated.peak);
                errors.push(if stated.coupled { gap / stated.peak } else { 0.0 });
            }
        }
        errors
    }
}

/// `C (iω − A)⁻¹ B + D`.
fn transfer(space: &StateSpace, omega: f64) -> CDMat {
    let n = space.a.nrows();
    let shifted = CDMat::identity(n, n) * Complex::new(0.0, omega) - space.a.map(Complex::from);
    let solved = shifted.lu().solve(&space.b.map(Complex::from)).unwrap();
    space.c.map(Complex::from) * solved + space.d.map(Complex::from)
}

fn along(direction_w: Vec3) -> Signal {
    Signal::Along { direction_w, point_p: Vec3::new(0.1, 0.05, -0.02) }
}

/// A few inputs and outputs of every quantity that the platform has.
fn signals(robot: &Robot) -> (Vec<Signal>, Vec<(Signal, Quantity)>) {
    let (free, other) = if robot.platform.motion.components().contains(&1) {
        (Vec3::new(0.2, 0.3, 1.0), Vec3::new(0.1, 1.0, 0.4))
    } else {
        (Vec3::new(0.2, 0.0, 1.0), Vec3::new(1.0, 0.0, 0.1))
    };
    let outputs = vec![
        (along(free), Quantity::Displacement),
        (along(other), Quantity::Velocity),
        (along(free), Quantity::Acceleration),
    ];
    (vec![along(free), along(other)], outputs)
}

/// Robots of the library, and some random ones.
fn held_out() -> Vec<LimitedRobot> {
    let damped = |robot: &Robot| {
        robot.cables.iter().all(|cable| match cable.material.damping {
            Damping::Ratio(c) | Damping::Viscous(c) => c > 0.0,
        })
    };
    let mut cases: Vec<LimitedRobot> = (library::library().into_iter())
        .filter(|(_, robot, _)| damped(robot))
        .map(|(name, robot, rest)| LimitedRobot::with_modes(&name, &robot, &rest, 30))
        .collect();
    for index in 0..12 {
        let sample = robots::sample(index);
        let Ok(rest) = statics::forward(&sample.robot, &sample.lengths, StaticModel::Catenary, None) else { continue };
        let taut = rest.cables.iter().all(|cable| cable.tension_platform > 0.0);
        let stable = matches!(rest.stability, statics::Stability::Stable { .. });
        if taut && stable && damped(&sample.robot) {
            cases.push(LimitedRobot::with_modes(&format!("random {index}"), &sample.robot, &rest, 20));
        }
    }
    // A cable without mass is a spring without damping.
    cases.retain(|case| modes::below(&case.dynamics, case.below_hz).modes.iter().all(|mode| mode.damping_ratio > 1e-9));
    assert!(cases.len() > 12, "{}", cases.len());
    cases
}

#[test]
fn the_stated_error_is_kept_on_other_frequencies_by_every_robot() {
    for case in held_out() {
        let (inputs, outputs) = signals(&case.robot);
        for tolerance in [0.1, 0.01] {
            let model = case.model(&inputs, &outputs, StateSpaceSize::Tolerance(tolerance));
            let model = model.unwrap_or_else(|error| panic!("{}: {error}", case.name));
            assert!(model.error <= tolerance && model.damping_error <= tolerance, "{}: {}", case.name, model.error);
            let largest = case.error(&inputs, &outputs, &model).into_iter().fold(0.0, f64::max);
            println!(
                "{} {tolerance}: {} states of {}, stated {:.2e}, found {largest:.2e}, damping {:.1e}",
                case.name,
                model.space.a.nrows(),
                model.complete_order,
                model.error,
                model.damping_error
            );
            // The maximum is searched for to 1e-4 of itself.
            assert!(largest <= model.error * (1.0 + 1e-4), "{}: {largest} {}", case.name, model.error);
            // Stable: with one block of known eigenvalues per mode, and by a general method.
            assert!(model.space.a.complex_eigenvalues().iter().all(|value| value.re < 0.0), "{}", case.name);
        }
    }
}

/// Smallest number of modes that keep a tolerance, by trying all subsets of the highest peaks. The modes are the damped
/// ones of the full model with their residues of first order, which shares nothing with the second-order model.
fn fewest(case: &LimitedRobot, input: &Signal, output: &(Signal, Quantity), tolerance: f64) -> Option<usize> {
    const HIGHEST: usize = 12;
    let undamped = modes::below(&case.dynamics, case.below_hz);
    let damped = modes::damped::damped_modes(&case.dynamics, &undamped);
    let ports = Port::all(&case.robot, &case.rest, &case.dynamics, &[*input, output.0], false).unwrap();
    let frequencies = case.frequencies();
    let full = case.full(input, output, &frequencies);
    let peak = full.iter().map(|g| g.norm()).fold(0.0, f64::max);
    let at_rest = case.full(input, &(output.0, Quantity::Displacement), &[1e-6 * case.below_hz])[0].re;

    let power = match output.1 {
        Quantity::Displacement => 0,
        Quantity::Velocity => 1,
        Quantity::Acceleration => 2,
    };
    let mut parts: Vec<(f64, Vec<Complex>)> = (undamped.modes.iter().zip(&damped.modes))
        .map(|(mode, partner)| {
            let residue =
                [0, 1].iter().map(|i: &usize| ports[*i].in_mode(&case.dynamics, mode).unwrap()).product::<f64>()
                    / mode.modal_mass;
            let omega_n = partner.omega.norm();
            let values: Vec<Complex> = frequencies
                .iter()
                .map(|f| {
                    let s = Complex::new(0.0, f * TAU);
                    let denominator = omega_n * omega_n + s * s + s * (2.0 * partner.damping_ratio() * omega_n);
                    let held = if power == 0 { 1.0 / (omega_n * omega_n) } else { 0.0 };
                    (residue / denominator - residue * held) * s.powi(power)
                })
                .collect();
            (values.iter().map(|v| v.norm()).fold(0.0, f64::max), values)
        })
        .collect();
    parts.sort_by(|a, b| b.0.total_cmp(&a.0));
    parts.truncate(HIGHEST);

    let rest = if power == 0 { at_rest } else { 0.0 };
    let keeps = |subset: u32| {
        frequencies.iter().enumerate().all(|(k, _)| {
            let chosen = parts.iter().enumerate().filter(|(i, _)| subset >> i & 1 == 1);
            let sum: Complex = chosen.map(|(_, (_, values))| values[k]).sum();
            (full[k] - rest - sum).norm() <= tolerance * peak
        })
    };
    let mut subsets: Vec<u32> = (1..1u32 << parts.len()).collect();
    subsets.sort_by_key(|subset| subset.count_ones());
    subsets.into_iter().find(|subset| keeps(*subset)).map(|subset| subset.count_ones() as usize)
}

#[test]
fn the_order_is_at_most_twice_that_of_the_best_subset_of_modes() {
    let (mut compared, mut larger, mut smaller) = (0, 0, 0);
    for case in held_out() {
        let (inputs, outputs) = signals(&case.robot);
        for output in &outputs {
            for tolerance in [0.1, 0.02] {
                let Some(fewest) = fewest(&case, &inputs[0], output, tolerance) else { continue };
                let model = case.model(&inputs[..1], &[*output], StateSpaceSize::Tolerance(tolerance)).unwrap();
                let order = model.space.a.nrows();
                println!("{} {:?} {tolerance}: {order} states, {fewest} modes", case.name, output.1);
                assert!(order <= 4 * fewest, "{}: {order} states, {fewest} modes are enough", case.name);
                compared += 1;
                larger += usize::from(order > 2 * fewest);
                smaller += usize::from(order < 2 * fewest);
            }
        }
    }
    println!("{compared} compared, {larger} larger, {smaller} smaller");
    assert!(compared > 60, "{compared}");
    // Nearly always it is the best subset, or shorter because two close modes become one.
    assert!(5 * larger <= compared, "{larger} of {compared} have more states than the best subset");
}

fn example(damping: Damping) -> LimitedRobot {
    let mut robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
    for cable in &mut robot.cables {
        cable.material.damping = damping;
    }
    let rest = library::at_rest(&robot);
    LimitedRobot::new("example", robot, rest, 5.0)
}

#[test]
fn statics_and_feedthrough_are_those_of_physics() {
    let case = example(Damping::Ratio(0.003));
    let z = along(Vec3::z());
    let outputs = [Quantity::Displacement, Quantity::Velocity, Quantity::Acceleration].map(|quantity| (z, quantity));
    for size in [
        StateSpaceSize::Order(2),
        StateSpaceSize::Order(6),
        StateSpaceSize::Tolerance(0.05),
        StateSpaceSize::Tolerance(0.005),
    ] {
        let model = case.model(&[z], &outputs, size).unwrap();
        let at_zero = transfer(&model.space, 0.0);

        // The static displacement is that of the static stiffness, for any number of modes.
        let port = response::along(&Vec3::z(), &Vec3::new(0.1, 0.05, -0.02), &case.rest.pose);
        let stiffness = case.dynamics.stiffness(0.0).map(|k| k.re);
        let expected = port.dot(
            &stiffness
                .try_inverse()
                .unwrap()
                .column_iter()
                .zip(port.iter())
                .fold(port * 0.0, |sum, (column, p)| sum + column * *p),
        );
        assert!((at_zero[(0, 0)].re - expected).abs() < 1e-8 * expected, "{} {expected}", at_zero[(0, 0)]);

        // Nothing moves at a constant force; a velocity has no feedthrough.
        let peak = |k: usize| model.responses[k].peak;
        assert!(at_zero[(1, 0)].norm() < 1e-3 * peak(1) && at_zero[(2, 0)].norm() < 1e-9 * peak(2));
        assert!(model.space.d[(1, 0)].abs() == 0.0);
        // The modes left out are stiff springs: D is positive where the force acts on what is measured. The inverse
        // mass of the modes that are kept is the feedthrough of the acceleration.
        assert!(model.space.d[(0, 0)] > 0.0 && model.space.d[(0, 0)] < expected);
        assert!(model.space.d[(2, 0)] > 0.0);
    }
}

#[test]
fn with_every_mode_the_acceleration_has_the_feedthrough_of_the_mass_matrix() {
    // Springs without mass, and a damped platform: six modes, all of which are kept.
    let mut robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
    for cable in &mut robot.cables {
        cable.material.damping = Damping::Viscous(0.0);
        cable.material.mass_per_length = 0.0;
    }
    robot.platform.translational_damping_p = Vec3::new(3.0, 4.0, 5.0);
    robot.platform.rotational_damping_p = Vec3::new(0.3, 0.2, 0.1);
    let rest = library::at_rest(&robot);
    let case = LimitedRobot::new("springs", robot, rest, 400.0);
    let all: Vec<Signal> = [Vec3::x(), Vec3::y(), Vec3::z()].map(along).to_vec();
    let outputs: Vec<_> = all.iter().map(|signal| (*signal, Quantity::Acceleration)).collect();
    let model = case.model(&all, &outputs, StateSpaceSize::Order(12)).unwrap();
    assert_eq!((model.space.a.nrows(), model.damping_error), (12, 0.0));
    assert!(model.error < 1e-9, "{}", model.error);

    let vectors: Vec<_> = all.iter().map(|signal| signal.platform_vector(&case.rest.pose).unwrap()).collect();
    let inverse = case.dynamics.mass().try_inverse().unwrap();
    for (i, input) in vectors.iter().enumerate() {
        for (o, output) in vectors.iter().enumerate() {
            let expected = output.dot(&(inverse * input));
            assert!((model.space.d[(o, i)] - expected).abs() < 1e-9 * inverse.amax(), "{o} {i}");
        }
    }
}

#[test]
fn equal_frequencies_take_one_pair_of_states_for_one_direction() {
    // A point mass below the middle of four equal cables: its two horizontal frequencies are equal.
    let cable = |i: usize, x: f64, y: f64| {
        format!(
            "[[cables]]\nname = \"{i}\"\nmaterial = \"rope\"\nanchor_m = [{x}, {y}, 4.0]\nunstrained_length_m = 4.999\n"
        )
    };
    let text = format!(
        "name = \"four\"\ngravity_m_s2 = [0.0, 0.0, -9.81]\n[platform]\nmotion = \"point-mass\"\nmass_kg = 20.0\n\
         [materials.rope]\naxial_stiffness_n = 1e5\nmass_kg_per_m = 0.05\ndamping_ratio = 0.01\n{}{}{}{}",
        cable(1, 3.0, 0.0),
        cable(2, -3.0, 0.0),
        cable(3, 0.0, 3.0),
        cable(4, 0.0, -3.0)
    );
    let robot = Robot::from_toml(&text).unwrap_or_else(|error| panic!("{}", error.render("four", &text, false)));
    let rest = library::at_rest(&robot);
    let case = LimitedRobot::new("four", robot, rest, 30.0);
    let slanted = Signal::Along { direction_w: Vec3::new(0.6, 0.8, 0.0), point_p: Vec3::zeros() };
    let x = Signal::Along { direction_w: Vec3::x(), point_p: Vec3::zeros() };
    let y = Signal::Along { direction_w: Vec3::y(), point_p: Vec3::zeros() };
    let orders: Vec<usize> = [
        case.model(&[slanted], &[(slanted, Quantity::Displacement)], StateSpaceSize::Tolerance(0.01)),
        case.model(
            &[slanted],
            &[(x, Quantity::Displacement), (y, Quantity::Displacement)],
            StateSpaceSize::Tolerance(0.01),
        ),
        case.model(
            &[x, y],
            &[(x, Quantity::Displacement), (y, Quantity::Displacement)],
            StateSpaceSize::Tolerance(0.01),
        ),
    ]
    .into_iter()
    .map(|model| model.unwrap().space.a.nrows())
    .collect();
    assert_eq!(orders[0], orders[1], "{orders:?}");
    assert_eq!(2 * orders[0], orders[2], "{orders:?}");

    // x and y are not coupled, and their numbers are not errors.
    let model =
        case.model(&[x], &[(x, Quantity::Velocity), (y, Quantity::Velocity)], StateSpaceSize::Tolerance(0.01)).unwrap();
    assert_eq!(model.responses.iter().map(|pair| pair.coupled).collect::<Vec<_>>(), [true, false]);
    assert!(model.pointwise.output == 0 && model.error <= 0.01);
}

#[test]
fn more_states_leave_less_error_and_the_states_are_named_after_their_modes() {
    let case = example(Damping::Ratio(0.003));
    let (z, y) = (along(Vec3::z()), along(Vec3::y()));
    let outputs = [(y, Quantity::Displacement), (z, Quantity::Acceleration)];
    let mut last = f64::INFINITY;
    for order in [2, 4, 8, 16, 32] {
        let model = case.model(&[z, y], &outputs, StateSpaceSize::Order(order)).unwrap();
        assert!(model.space.a.nrows() <= order && model.error <= last * 1.05, "{order}: {} {last}", model.error);
        last = model.error;
    }
    assert!(last < 0.02, "{last}");

    let model = case.model(&[z, y], &outputs, StateSpaceSize::Tolerance(0.02)).unwrap();
    let listed = modes::below(&case.dynamics, 5.0).modes;
    for states in model.states.iter().filter(|states| states.kind.is_some() && states.frequency_hz < 4.9) {
        let near = listed.iter().min_by(|a, b| {
            (a.frequency_hz - states.frequency_hz).abs().total_cmp(&(b.frequency_hz - states.frequency_hz).abs())
        });
        let near = near.unwrap();
        // A pair that stands for two close modes lies between them.
        assert!((near.frequency_hz / states.frequency_hz - 1.0).abs() < 2e-3, "{states:?}");
        assert!((near.damping_ratio / states.damping_ratio - 1.0).abs() < 0.1, "{states:?} {near:?}");
        assert!((near.platform_energy_fraction - states.platform_energy_fraction).abs() < 0.05, "{states:?} {near:?}");
        let block: DMat = model.space.a.view((states.first, states.first), (2, 2)).into_owned();
        let omega = states.frequency_hz * TAU;
        assert!((block[(0, 1)] - omega).abs() < 1e-9 * omega && (block[(1, 0)] + omega).abs() < 1e-9 * omega);
    }
    assert!(model.states.iter().any(|states| states.kind == Some(Kind::Mixed)));
    assert!(model.states.windows(2).all(|pair| pair[0].frequency_hz <= pair[1].frequency_hz));
}

#[test]
fn viscous_ropes_have_no_error_of_damping_and_any_tolerance() {
    let case = example(Damping::Viscous(0.02));
    let z = along(Vec3::z());
    let on_cable = Signal::OnCable { cable: 2, fraction: 0.4, direction_w: Vec3::y() };
    let outputs = [(z, Quantity::Displacement), (on_cable, Quantity::Velocity)];
    let model = case.model(&[z], &outputs, StateSpaceSize::Tolerance(1e-5)).unwrap();
    assert!(model.damping_error == 0.0 && model.error <= 1e-5);
    let largest = case.error(&[z], &outputs, &model).into_iter().fold(0.0, f64::max);
    assert!(largest <= model.error * (1.0 + 1e-4), "{largest} {}", model.error);
}

#[test]
fn a_force_on_a_cable_has_the_static_displacement_beside_it_as_feedthrough() {
    let case = example(Damping::Ratio(0.003));
    let on_cable = Signal::OnCable { cable: 2, fraction: 0.4, direction_w: Vec3::z() };
    let outputs = [(on_cable, Quantity::Displacement), (along(Vec3::z()), Quantity::Acceleration)];
    let model = case.model(&[on_cable], &outputs, StateSpaceSize::Tolerance(0.01)).unwrap();
    let errors = case.error(&[on_cable], &outputs, &model);
    assert!(errors.iter().all(|error| *error <= model.error * (1.0 + 1e-4)), "{errors:?} {}", model.error);
    let at_rest = case.full(&on_cable, &outputs[0], &[1e-5])[0].re;
    assert!((transfer(&model.space, 0.0)[(0, 0)].re / at_rest - 1.0).abs() < 1e-6);
}

#[test]
fn strong_damping_gives_states_that_decay_without_oscillation() {
    let mut case = example(Damping::Ratio(0.003));
    case.robot.platform.translational_damping_p = Vec3::new(2000.0, 2000.0, 2000.0);
    let case = LimitedRobot::new("damped", case.robot, case.rest, 5.0);
    let outputs = [(along(Vec3::z()), Quantity::Displacement), (along(Vec3::x()), Quantity::Velocity)];
    let model = case.model(&[along(Vec3::z())], &outputs, StateSpaceSize::Tolerance(0.01)).unwrap();
    assert!(model.states.iter().any(|states| states.states == 1), "{:?}", model.states);
    let largest = case.error(&[along(Vec3::z())], &outputs, &model).into_iter().fold(0.0, f64::max);
    assert!(largest <= model.error * (1.0 + 1e-4), "{largest} {}", model.error);
}

#[test]
fn what_cannot_be_is_refused_with_its_reason() {
    let case = example(Damping::Ratio(0.003));
    let z = [along(Vec3::z())];
    let outputs = [(z[0], Quantity::Acceleration)];
    assert_eq!(case.model(&z, &outputs, StateSpaceSize::Order(1)).unwrap_err(), ReductionError::Order(1));
    let refused = case.model(&z, &outputs, StateSpaceSize::Tolerance(1e-12)).unwrap_err();
    let ReductionError::Tolerance { requested, reached, order } = refused else { panic!("{refused}") };
    assert!(requested < reached && reached < 1e-2 && order > 10, "{reached} {order}");
    // This order does reach what is stated.
    let model = case.model(&z, &outputs, StateSpaceSize::Tolerance(1.1 * reached)).unwrap();
    assert!(model.error <= 1.1 * reached);

    let undamped = example(Damping::Viscous(0.0));
    let refused = undamped.model(&z, &outputs, StateSpaceSize::Tolerance(0.01)).unwrap_err();
    assert!(matches!(refused, ReductionError::Undamped { .. }), "{refused}");
    assert!(refused.to_string().contains("give the ropes or the platform damping"), "{refused}");
}

/// Reports of work that runs to its end, and a check that it stops at any of them. `work` returns true if it was
/// stopped.
fn check_reports(mut work: impl FnMut(&mut dyn FnMut(usize) -> bool) -> bool) {
    let mut reports = Vec::new();
    let stopped = work(&mut |done| {
        reports.push(done);
        true
    });
    assert!(!stopped && reports.len() > 10, "{reports:?}");
    assert!(reports.windows(2).all(|pair| pair[0] <= pair[1]) && reports[reports.len() - 1] < STEPS, "{reports:?}");

    for last in (0..reports.len()).step_by(reports.len().div_ceil(12)) {
        let mut calls = 0;
        let stopped = work(&mut |_| {
            calls += 1;
            calls <= last
        });
        assert!(stopped && calls == last + 1, "{calls} {last}");
    }
}

#[test]
fn a_reduction_reports_its_steps_and_stops_at_any_of_them() {
    let case = example(Damping::Ratio(0.01));
    let z = along(Vec3::z());
    let outputs = [(z, Quantity::Displacement)];
    let damping_at = DampingAt::NaturalFrequencies;
    for size in [StateSpaceSize::Tolerance(0.02), StateSpaceSize::Order(8)] {
        let requested = RequestedStateSpace { below_hz: case.below_hz, size, damping_at };
        check_reports(|report| {
            let model = control_model(&case.robot, &case.rest, &case.dynamics, &[z], &outputs, requested, report);
            model.is_err_and(|error| error == ReductionError::Stopped)
        });
    }

    let requested = RequestedModel { below_hz: case.below_hz, tolerance: 1e-3, damping_at };
    check_reports(|report| {
        let model = reduce(&case.robot, &case.rest, &case.dynamics, &[z], &outputs, requested, report);
        model.is_err_and(|error| error == ReductionError::Stopped)
    });
}

#[test]
fn the_complete_second_order_model_has_the_responses_of_a_state_space_with_a_small_error() {
    let case = example(Damping::Viscous(0.02));
    let z = along(Vec3::z());
    let outputs = [(z, Quantity::Displacement), (z, Quantity::Acceleration)];
    let model = case.model(&[z], &outputs, StateSpaceSize::Tolerance(1e-4)).unwrap();
    let requested = RequestedModel { below_hz: 5.0, tolerance: 1e-6, damping_at: DampingAt::NaturalFrequencies };
    let complete = reduce(&case.robot, &case.rest, &case.dynamics, &[z], &outputs, requested, &mut |_| true);
    let complete = complete.unwrap().state_space().unwrap();
    println!("{} states of {}", model.space.a.nrows(), complete.a.nrows());
    assert!(model.space.a.nrows() * 2 < complete.a.nrows());
    for frequency_hz in [0.3, 1.1, 2.7, 4.4] {
        let (small, large) = (transfer(&model.space, frequency_hz * TAU), transfer(&complete, frequency_hz * TAU));
        for k in 0..2 {
            assert!((small[(k, 0)] - large[(k, 0)]).norm() < 1.1e-4 * model.responses[k].peak, "{frequency_hz} {k}");
        }
    }
}
