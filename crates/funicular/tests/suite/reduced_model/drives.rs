//! Reduced models of robots whose cables run to winches with inertia and control, against the full model.

use funicular::cable::catenary_dynamic::DriveSignal;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{CDMat, Complex, DMat, Vec3};
use funicular::modes;
use funicular::reduced_model::{
    ControlModel, DampingAt, ReductionError, RequestedModel, RequestedStateSpace, SecondOrder, StateSpace,
    StateSpaceSize, control_model, reduce,
};
use funicular::response::{self, FrameInput, Port, Quantity, Signal};
use funicular::robot::{Control, Damping, DrumSide, Robot, Servo, State, StretchLoss, Winch};
use funicular::statics::{self, Equilibrium, StaticModel};
use std::f64::consts::TAU;

/// Limit of the models [Hz].
const BELOW: f64 = 6.0;

/// A body of 12 kg as a point, hung from two cables over pulleys to winches, which are below the pulleys.
const TWO_CABLES: &str = "name = \"two\"\ngravity_m_s2 = [0, 0, -9.81]\n[platform]\nmass_kg = 12.0\nmotion = \
     \"point-mass\"\n\
     [materials.rope]\naxial_stiffness_n = 2e5\nmass_kg_per_m = 0.07\ndamping_ratio = 0.005\n\
     [pulleys.wheel]\nradius_m = 0.05\nentry_direction = [0, 0, 1]\ninertia_kg_m2 = 2e-4\n\
     swivel_inertia_kg_m2 = 1e-3\n[winches.drum]\ndrum_side_length_m = 3.0\n\
     [[cables]]\nname = \"1\"\nmaterial = \"rope\"\npulley = \"wheel\"\nwinch = \"drum\"\nanchor_m = [-4, 0.3, 4]\n\
     unstrained_length_m = 8.05\n\
     [[cables]]\nname = \"2\"\nmaterial = \"rope\"\npulley = \"wheel\"\nwinch = \"drum\"\nanchor_m = [5, 0, 4.4]\n\
     unstrained_length_m = 9.1\n";

/// Robot at equilibrium, linearised.
struct WinchRobot {
    name: &'static str,
    robot: Robot,
    rest: Equilibrium,
    dynamics: Dynamics,
}

/// Loss of the stretch of ropes with this damping, which matrices have as exactly.
fn loss_beside(damping: Damping) -> StretchLoss {
    match damping {
        Damping::Ratio(_) => StretchLoss { factor: 0.004, time: 0.0 },
        Damping::Viscous(_) => StretchLoss { factor: 0.0, time: 4e-4 },
    }
}

impl WinchRobot {
    /// Two cables, whose winches `change` gives inertia and control.
    fn new(name: &'static str, damping: Damping, change: impl Fn(&mut Winch)) -> Self {
        Self::of(name, TWO_CABLES, damping, change)
    }

    fn of(name: &'static str, text: &str, damping: Damping, change: impl Fn(&mut Winch)) -> Self {
        let mut robot = Robot::from_toml(text).unwrap();
        for cable in &mut robot.cables {
            cable.material.damping = damping;
            cable.material.stretch_loss = loss_beside(damping);
            change(cable.anchor.winch.as_mut().unwrap());
        }
        Self::at_rest(name, robot)
    }

    /// Two cables that end at fixed points.
    fn fixed(damping: Damping) -> Self {
        let mut robot = Robot::from_toml(TWO_CABLES).unwrap();
        for cable in &mut robot.cables {
            cable.material.damping = damping;
            cable.material.stretch_loss = loss_beside(damping);
            (cable.anchor.pulley, cable.anchor.winch) = (None, None);
        }
        // The drum side is not part of the cables.
        let State::Lengths(lengths) = &mut robot.state else { panic!("its file gives lengths") };
        for length in lengths.iter_mut() {
            *length -= 3.0;
        }
        Self::at_rest("fixed", robot)
    }

    fn at_rest(name: &'static str, robot: Robot) -> Self {
        let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), BELOW).unwrap();
        Self { name, robot, rest, dynamics }
    }

    /// Second-order model.
    fn second_order(
        &self,
        inputs: &[Signal],
        outputs: &[(Signal, Quantity)],
        tolerance: f64,
    ) -> Result<SecondOrder, ReductionError> {
        let requested = RequestedModel { below_hz: BELOW, tolerance, damping_at: DampingAt::NaturalFrequencies };
        reduce(&self.robot, &self.rest, &self.dynamics, inputs, outputs, requested, &mut |_| true)
    }

    /// State space of few states.
    fn control_model(
        &self,
        inputs: &[Signal],
        outputs: &[(Signal, Quantity)],
        tolerance: f64,
    ) -> Result<ControlModel, ReductionError> {
        let size = StateSpaceSize::Tolerance(tolerance);
        let requested = RequestedStateSpace { below_hz: BELOW, size, damping_at: DampingAt::NaturalFrequencies };
        control_model(&self.robot, &self.rest, &self.dynamics, inputs, outputs, requested, &mut |_| true)
    }

    /// Responses of the full model: one row of outputs×inputs by rows per frequency.
    fn full(&self, inputs: &[Signal], outputs: &[(Signal, Quantity)], frequencies_hz: &[f64]) -> Vec<CDMat> {
        let signals: Vec<Signal> = inputs.iter().copied().chain(outputs.iter().map(|(signal, _)| *signal)).collect();
        let mut ports = Port::all(&self.robot, &self.rest, &self.dynamics, &signals, false).unwrap();
        let to = ports.split_off(inputs.len());
        let to: Vec<_> = to.into_iter().zip(outputs).map(|(port, (_, quantity))| (port, *quantity)).collect();
        let rows = response::matrix(&self.dynamics, frequencies_hz, &ports, &to).unwrap();
        (0..frequencies_hz.len())
            .map(|k| CDMat::from_fn(outputs.len(), inputs.len(), |o, i| rows[o * inputs.len() + i][k]))
            .collect()
    }
}

/// Shafts of finite stiffness between drum and motor, a position control with speed gain and without integral action,
/// and friction. So statics yields by the position gain, as slow vibration does.
fn servo(winch: &mut Winch) {
    (winch.stiffness, winch.drum_mass, winch.motor_mass, winch.damping) = (3e5, 6.0, 50.0, 40.0);
    winch.control = Control::Position(Servo::of_bandwidth(56.0, 3.0, 0.7, false, 0.0));
}

/// Motors of constant torque with friction, rigid shafts.
fn torque(winch: &mut Winch) {
    (winch.drum_mass, winch.motor_mass, winch.damping) = (6.0, 50.0, 60.0);
    winch.control = Control::Torque;
}

/// Rods on the drum side to drums behind shafts, whose motors hold their angle.
fn rods(winch: &mut Winch) {
    (winch.stiffness, winch.drum_mass, winch.drum_side) = (3e5, 6.0, DrumSide::Rod);
}

/// Rods on the drum side to rigid drums.
fn rods_alone(winch: &mut Winch) {
    winch.drum_side = DrumSide::Rod;
}

fn drive(cable: usize, signal: DriveSignal) -> Signal {
    Signal::Drive { cable, signal }
}

fn along(direction_w: Vec3) -> Signal {
    Signal::Along { direction_w, point_p: Vec3::zeros() }
}

/// Frequencies that are not those of any grid of the program [Hz].
fn elsewhere(count: usize) -> Vec<f64> {
    (0..count).map(|i| BELOW * (0.003 + 0.9967 * (i as f64 + 0.317) / count as f64)).collect()
}

/// Checks the stated error of each pair at frequencies that the program did not use.
fn check_stated_errors(case: &WinchRobot, inputs: &[Signal], outputs: &[(Signal, Quantity)], model: &ControlModel) {
    let frequencies = elsewhere(200);
    let full = case.full(inputs, outputs, &frequencies);
    let ours: Vec<CDMat> = frequencies.iter().map(|f| transfer(&model.space, *f)).collect();
    for at in (0..outputs.len()).flat_map(|o| (0..inputs.len()).map(move |i| (o, i))) {
        let stated = &model.responses[at.1 * outputs.len() + at.0];
        let gap = full.iter().zip(&ours).map(|(a, b)| (a[at] - b[at]).norm()).fold(0.0, f64::max);
        // The accuracy to which maxima are searched for.
        assert!(gap <= 1.001 * stated.error * stated.peak, "{} {at:?}: {gap} {stated:?}", case.name);
    }
}

fn transfer(space: &StateSpace, frequency_hz: f64) -> CDMat {
    let n = space.a.nrows();
    let shifted = CDMat::identity(n, n) * Complex::new(0.0, frequency_hz * TAU) - space.a.map(Complex::from);
    let solved = shifted.lu().solve(&space.b.map(Complex::from)).unwrap();
    space.c.map(Complex::from) * solved + space.d.map(Complex::from)
}

/// With all clamped modes the second-order model is the full model: every signal, every kind of drive.
#[test]
fn with_all_modes_every_signal_of_every_drive_is_exact() {
    use DriveSignal::{Drum, DrumTension, Length, Motor, Tension};
    let viscous = Damping::Viscous(0.02);
    let on_cable = Signal::OnCable { cable: 1, fraction: 0.4, direction_w: Vec3::z() };
    // A swivel axis that is not vertical couples the motions in plane and out of plane.
    let inclined = TWO_CABLES.replace("entry_direction = [0, 0, 1]", "entry_direction = [0, 0.3, 1]");
    let cases: [(WinchRobot, &[DriveSignal], &[DriveSignal]); 7] = [
        (WinchRobot::new("servo", viscous, servo), &[Length, Motor], &[Drum, DrumTension]),
        (WinchRobot::new("torque", viscous, torque), &[Drum], &[Motor, Tension]),
        (WinchRobot::new("rods", viscous, rods), &[Length, Drum], &[Drum, DrumTension]),
        (WinchRobot::new("rods alone", viscous, rods_alone), &[Length], &[Tension, DrumTension]),
        (WinchRobot::new("ideal", viscous, |_| ()), &[Length], &[Tension, DrumTension]),
        (WinchRobot::fixed(viscous), &[Length], &[Tension, DrumTension]),
        (WinchRobot::of("inclined", &inclined, viscous, servo), &[Length], &[Motor, Tension]),
    ];
    for (case, from, to) in cases {
        let inputs: Vec<Signal> = [along(Vec3::z())].into_iter().chain(from.iter().map(|s| drive(1, *s))).collect();
        let outputs: Vec<_> = [along(Vec3::new(0.3, 1.0, 0.2)), on_cable]
            .into_iter()
            .chain(to.iter().map(|s| drive(1, *s)))
            .chain([drive(0, Tension)])
            .map(|signal| (signal, Quantity::Displacement))
            .collect();
        let model = case.second_order(&inputs, &outputs, 0.0).unwrap();
        assert!(model.truncation_error.unwrap() < 1e-9, "{}: {:?}", case.name, model.truncation_error);
        assert_eq!(model.damping_error, Some(0.0));

        let frequencies = elsewhere(7);
        let full = case.full(&inputs, &outputs, &frequencies);
        for (full, f) in full.iter().zip(&frequencies) {
            let ours = model.receptance(f * TAU).unwrap();
            for (a, b) in full.iter().zip(ours.iter()) {
                assert!((a - b).norm() < 1e-7 * a.norm(), "{} at {f} Hz: {full} {ours}", case.name);
            }
        }
        check_matrices(&model, case.name);
    }
}

/// M is positive definite, K symmetric and C positive semidefinite.
fn check_matrices(model: &SecondOrder, name: &str) {
    for matrix in [&model.mass, &model.damping, &model.stiffness] {
        assert!((matrix - matrix.transpose()).amax() <= 1e-9 * matrix.amax(), "{name}");
    }
    assert!(model.mass.clone().cholesky().is_some(), "{name}");
    let least = |matrix: &DMat| matrix.clone().symmetric_eigenvalues().min() / matrix.amax();
    assert!(least(&model.damping) > -1e-10, "{name}: {}", least(&model.damping));
}

/// Motions of the base and of an anchor.
fn motions_of_the_frame() -> Vec<Signal> {
    let tilted = Vec3::new(0.4, -0.2, 1.0);
    let anchor = FrameInput::Anchor { cable: 1, direction_w: Vec3::new(0.3, 0.5, 1.0) };
    [FrameInput::BaseAlong(tilted), FrameInput::BaseAbout(tilted), anchor].map(Signal::Frame).to_vec()
}

/// With all clamped modes the second-order model is the full model for motions of the frame, too.
#[test]
fn with_all_modes_motions_of_the_frame_are_exact() {
    use DriveSignal::{Drum, DrumTension, Motor, Tension};
    let viscous = Damping::Viscous(0.02);
    // A swivel axis that is not vertical couples the motions in plane and out of plane.
    let inclined = TWO_CABLES.replace("entry_direction = [0, 0, 1]", "entry_direction = [0, 0.3, 1]");
    let cases: [(WinchRobot, &[DriveSignal]); 4] = [
        (WinchRobot::new("servo", viscous, servo), &[Drum, DrumTension]),
        (WinchRobot::new("rods", viscous, rods), &[Tension, DrumTension]),
        (WinchRobot::fixed(viscous), &[Tension, DrumTension]),
        (WinchRobot::of("inclined", &inclined, viscous, servo), &[Motor, Tension]),
    ];
    for (case, to) in cases {
        let inputs = motions_of_the_frame();
        let on_cable = Signal::OnCable { cable: 1, fraction: 0.4, direction_w: Vec3::new(0.2, 0.5, 1.0) };
        let outputs: Vec<_> = [along(Vec3::new(0.3, 1.0, 0.2)), on_cable]
            .into_iter()
            .chain(to.iter().map(|s| drive(1, *s)))
            .map(|signal| (signal, Quantity::Displacement))
            .collect();
        let model = case.second_order(&inputs, &outputs, 0.0).unwrap();
        assert!(model.truncation_error.unwrap() < 1e-9, "{}: {:?}", case.name, model.truncation_error);

        let frequencies = elsewhere(7);
        let full = case.full(&inputs, &outputs, &frequencies);
        for (full, f) in full.iter().zip(&frequencies) {
            let ours = model.receptance(f * TAU).unwrap();
            for (at, (a, b)) in full.iter().zip(ours.iter()).enumerate() {
                // An anchor does not move the tension of another cable but through the platform.
                let size = full.row(at % outputs.len()).camax();
                assert!((a - b).norm() < 1e-7 * size, "{} at {f} Hz: {full} {ours}", case.name);
            }
        }
    }
}

/// Small models of a moving frame keep the errors that they state, and carry the platform along at rest.
#[test]
fn small_models_follow_the_frame() {
    let inputs = [Signal::Frame(FrameInput::BaseAlong(Vec3::z())), motions_of_the_frame()[2]];
    let outputs = [
        (along(Vec3::z()), Quantity::Displacement),
        (along(Vec3::z()), Quantity::Acceleration),
        (drive(1, DriveSignal::Tension), Quantity::Displacement),
    ];
    for (name, change) in [("servo", servo as fn(&mut Winch)), ("ideal", |_: &mut Winch| ())] {
        let case = WinchRobot::new(name, Damping::Ratio(0.005), change);
        let model = case.control_model(&inputs, &outputs, 0.02).unwrap();
        assert!(model.error <= 0.02 && model.space.a.nrows() < 60, "{name}: {}", model.space.a.nrows());
        check_stated_errors(&case, &inputs, &outputs, &model);
        let gain = transfer(&model.space, 0.0);
        assert!((gain[(0, 0)] - 1.0).norm() < 1e-6 && gain[(1, 0)].norm() < 1e-6, "{name}: {gain}");
    }

    // The second-order form, and its state space for a displacement: the tension contains the acceleration of the
    // input.
    let case = WinchRobot::new("servo", Damping::Viscous(0.02), servo);
    let model = case.second_order(&inputs, &outputs, 1e-3).unwrap();
    assert!(model.truncation_error.unwrap() <= 1e-3 && model.mass.nrows() < 60, "{}", model.mass.nrows());
    assert!(matches!(model.state_space(), Err(ReductionError::Improper { output: 2 | 3, .. })));
    let model = case.second_order(&inputs, &outputs[..1], 1e-3).unwrap();
    let space = model.state_space().unwrap();
    for f in [0.31, 2.2] {
        let (ours, other) = (model.receptance(f * TAU).unwrap(), transfer(&space, f));
        assert!((&ours - &other).camax() < 1e-8 * ours.camax(), "{f} Hz: {ours} {other}");
    }
}

/// A small second-order model keeps the error that it states, at frequencies that its measurement did not use.
#[test]
fn a_small_second_order_model_with_drives_is_as_good_as_it_says() {
    let case = WinchRobot::new("servo", Damping::Viscous(0.02), servo);
    let inputs = [drive(1, DriveSignal::Length), drive(0, DriveSignal::Motor)];
    let outputs = [(along(Vec3::z()), Quantity::Displacement), (drive(1, DriveSignal::Drum), Quantity::Displacement)];
    let model = case.second_order(&inputs, &outputs, 1e-3).unwrap();
    let stated = model.truncation_error.unwrap();
    let complete = case.second_order(&inputs, &outputs, 0.0).unwrap();
    assert!(stated <= 1e-3 && 2 * model.mass.nrows() < complete.mass.nrows());

    let frequencies = elsewhere(40);
    let full = case.full(&inputs, &outputs, &frequencies);
    for (full, f) in full.iter().zip(&frequencies) {
        let ours = model.receptance(f * TAU).unwrap();
        // Each input has outputs of one kind; lengths and forces are kinds of their own.
        for input in 0..2 {
            let size = full.column(input).camax();
            let gap = (full.column(input) - ours.column(input)).camax();
            assert!(gap < 1.05 * stated * size, "{f} Hz, input {input}: {gap:e} {size:e} {stated:e}");
        }
    }
    check_matrices(&model, case.name);

    // Its state space has the same responses, and the damped modes of the full model.
    let space = model.state_space().unwrap();
    for f in [0.31, 2.2] {
        let (ours, other) = (model.receptance(f * TAU).unwrap(), transfer(&space, f));
        assert!((&ours - &other).camax() < 1e-8 * ours.camax(), "{f} Hz: {ours} {other}");
    }
    let undamped = modes::below(&case.dynamics, BELOW);
    let damped = modes::damped::damped_modes(&case.dynamics, &undamped);
    assert!(damped.certified && damped.modes.iter().any(|mode| mode.damping_ratio() > 0.2));
    let eigenvalues = space.a.complex_eigenvalues();
    for mode in &damped.modes {
        let lambda = mode.eigenvalue();
        let nearest = eigenvalues.iter().map(|other| (other - lambda).norm()).fold(f64::INFINITY, f64::min);
        // The response error of the small model.
        assert!(nearest < 1e-3 * lambda.norm(), "{lambda}: {nearest:e}");
    }
}

/// The state space of few states has drives as well: its stated error is kept, and its static gain is that of statics.
#[test]
fn the_state_space_of_few_states_commands_lengths() {
    for (name, change) in [("servo", servo as fn(&mut Winch)), ("rods", rods), ("ideal", |_: &mut Winch| ())] {
        let case = WinchRobot::new(name, Damping::Ratio(0.005), change);
        let inputs = [drive(1, DriveSignal::Length)];
        let outputs = [
            (along(Vec3::new(1.0, 0.0, 0.4)), Quantity::Displacement),
            (drive(1, DriveSignal::Tension), Quantity::Displacement),
        ];
        let model = case.control_model(&inputs, &outputs, 0.02).unwrap();
        assert!(model.error <= 0.02, "{name}: {}", model.error);
        assert!(model.space.a.nrows() < 60, "{name}: {} states", model.space.a.nrows());

        check_stated_errors(&case, &inputs, &outputs, &model);

        // Statics with a longer cable.
        let mut lengths: Vec<f64> = case.rest.cables.iter().map(|cable| cable.unstrained_length).collect();
        let step = 1e-5;
        let mut moved = |by: f64| {
            lengths[1] += by;
            statics::forward(&case.robot, &lengths, StaticModel::Catenary, Some(&case.rest.pose)).unwrap()
        };
        let (ahead, behind) = (moved(step), moved(-2.0 * step));
        let u = Vec3::new(1.0, 0.0, 0.4).normalize();
        let by_statics = [
            (ahead.pose.position_w - behind.pose.position_w).dot(&u) / (2.0 * step),
            (ahead.cables[1].tension_platform - behind.cables[1].tension_platform) / (2.0 * step),
        ];
        let gain = transfer(&model.space, 0.0);
        for (o, expected) in by_statics.iter().enumerate() {
            // The square of the step, and the frequency at which the program takes the static response.
            assert!((gain[(o, 0)].re - expected).abs() < 1e-4 * expected.abs(), "{name} {o}: {gain} {by_statics:?}");
        }
    }
}

/// Forces of motors at constant torque, and what has no second-order form.
#[test]
fn motors_push_and_delays_are_refused() {
    let case = WinchRobot::new("torque", Damping::Ratio(0.005), torque);
    let inputs = [drive(0, DriveSignal::Motor), drive(1, DriveSignal::Motor)];
    let outputs = [
        (along(Vec3::new(1.0, 0.0, 0.4)), Quantity::Velocity),
        (along(Vec3::z()), Quantity::Acceleration),
        (drive(0, DriveSignal::Motor), Quantity::Displacement),
    ];
    let model = case.control_model(&inputs, &outputs, 0.02).unwrap();
    check_stated_errors(&case, &inputs, &outputs, &model);

    // Motors without shaft and drums move with the platform on the cables: modes of drives.
    assert!(model.states.iter().any(|of| of.kind == Some(modes::Kind::Drive)), "{:?}", model.states);

    let delayed = WinchRobot::new("delay", Damping::Ratio(0.005), |winch| {
        servo(winch);
        winch.control = Control::Position(Servo::of_bandwidth(56.0, 3.0, 0.7, true, 0.01));
    });
    let error = delayed.second_order(&inputs, &outputs, 1e-3).unwrap_err();
    assert_eq!(error, ReductionError::Delay { cable: "1".to_owned(), delay_s: 0.01 });
    assert!(error.to_string().contains("a delay of 0.01 s") && error.to_string().contains("Padé"), "{error}");
    assert!(!error.is_no_solution());
    assert!(matches!(delayed.control_model(&inputs, &outputs, 0.02), Err(ReductionError::Delay { .. })));

    let massless = WinchRobot::new("massless", Damping::Ratio(0.005), |winch| {
        servo(winch);
        (winch.motor_mass, winch.damping) = (0.0, 40.0);
    });
    let error = massless.second_order(&inputs, &outputs, 1e-3).unwrap_err();
    assert_eq!(error, ReductionError::Massless { cable: "1".to_owned() });
    assert!(error.to_string().contains("`motor_inertia_kg_m2`"), "{error}");

    // The acceleration of the platform contains the rate of the commanded length.
    let case = WinchRobot::new("servo", Damping::Ratio(0.005), servo);
    let (inputs, outputs) = ([drive(1, DriveSignal::Length)], [(along(Vec3::z()), Quantity::Acceleration)]);
    let second_order = case.second_order(&inputs, &outputs, 1e-3).unwrap();
    assert_eq!(second_order.state_space().unwrap_err(), ReductionError::Improper { output: 1, input: 1 });
    let model = case.control_model(&inputs, &outputs, 0.02).unwrap();
    assert!(model.error <= 0.02);
}
