//! Reduced models of robots whose cables run to winches with inertia and control, against the full model.

use funicular::cable::catenary_dynamic::DriveSignal;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{CDMat, Complex, DMat, Vec3};
use funicular::modes;
use funicular::reduced_model::{
    ControlModel, DampingAt, ReductionError, RequestedModel, RequestedStateSpace, SecondOrder, Size, StateSpace,
    control_model, reduce,
};
use funicular::response::{self, Port, Quantity, Signal};
use funicular::robot::{Control, Damping, DrumSide, Robot, Servo, Winch};
use funicular::statics::{self, Equilibrium, StaticModel};
use std::f64::consts::TAU;

/// Limit of the models [Hz].
const BELOW: f64 = 6.0;

/// A body of 12 kg as a point, hung from two cables over pulleys to winches, which are below the pulleys.
const TWO_CABLES: &str = "name = \"two\"\ngravity_m_s2 = [0, 0, -9.81]\n[platform]\nmass_kg = 12.0\nmotion = \"point-mass\"\n\
     [materials.rope]\naxial_stiffness_n = 2e5\nmass_kg_per_m = 0.07\ndamping_ratio = 0.005\n\
     [pulleys.wheel]\nradius_m = 0.05\nentry_direction = [0, 0, 1]\ninertia_kg_m2 = 2e-4\n\
     swivel_inertia_kg_m2 = 1e-3\n[winches.drum]\ndrum_side_length_m = 3.0\n\
     [[cables]]\nname = \"1\"\nmaterial = \"rope\"\npulley = \"wheel\"\nwinch = \"drum\"\nanchor_m = [-4, 0.3, 4]\n\
     unstrained_length_m = 8.05\n\
     [[cables]]\nname = \"2\"\nmaterial = \"rope\"\npulley = \"wheel\"\nwinch = \"drum\"\nanchor_m = [5, 0, 4.4]\n\
     unstrained_length_m = 9.1\n";

/// Robot at equilibrium, linearised.
struct Case {
    name: &'static str,
    robot: Robot,
    rest: Equilibrium,
    dynamics: Dynamics,
}

impl Case {
    /// Two cables, whose winches `change` gives inertia and control.
    fn new(name: &'static str, damping: Damping, change: impl Fn(&mut Winch)) -> Self {
        let mut robot = Robot::from_toml(TWO_CABLES).unwrap();
        for cable in &mut robot.cables {
            cable.material.damping = damping;
            change(cable.anchor.winch.as_mut().unwrap());
        }
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
        let size = Size::Tolerance(tolerance);
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

/// Shafts of finite stiffness between drum and motor, a position control with speed gain, and friction.
fn servo(winch: &mut Winch) {
    (winch.stiffness, winch.drum_mass, winch.motor_mass, winch.damping) = (3e5, 6.0, 50.0, 40.0);
    winch.control = Control::Position(Servo::of_bandwidth(56.0, 3.0, 0.7, true, 0.0));
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

/// Largest difference of any pair, relative to the peak of the pair over these frequencies.
fn difference(full: &[CDMat], others: &[CDMat]) -> f64 {
    let (outputs, inputs) = full[0].shape();
    let mut largest: f64 = 0.0;
    for at in (0..outputs).flat_map(|o| (0..inputs).map(move |i| (o, i))) {
        let peak = full.iter().map(|g| g[at].norm()).fold(0.0, f64::max);
        let gap = full.iter().zip(others).map(|(a, b)| (a[at] - b[at]).norm()).fold(0.0, f64::max);
        largest = largest.max(gap / peak);
    }
    largest
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
    use DriveSignal::{Drum, Length, Motor, Tension};
    let viscous = Damping::Viscous(0.02);
    let on_cable = Signal::OnCable { cable: 0, fraction: 0.4, direction_w: Vec3::z() };
    let cases: [(Case, &[DriveSignal], &[DriveSignal]); 5] = [
        (Case::new("servo", viscous, servo), &[Length, Drum, Motor], &[Drum, Motor, Tension]),
        (Case::new("torque", viscous, torque), &[Drum, Motor], &[Drum, Motor, Tension]),
        (Case::new("rods", viscous, rods), &[Length, Drum], &[Drum, Tension]),
        (Case::new("rods alone", viscous, rods_alone), &[Length], &[Tension]),
        (Case::new("ideal", viscous, |_| ()), &[Length], &[Tension]),
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
