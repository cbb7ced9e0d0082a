//! Second-order models and state spaces of robots on supports, against the responses of the full model.

use super::platform_responses;
use funicular::cable::CableModel;
use funicular::cable::catenary_dynamic::DriveSignal;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{CDMat, Complex, Vec3};
use funicular::reduced_model::{
    Coordinate, DampingAt, RequestedModel, RequestedStateSpace, SecondOrder, StateSpace, StateSpaceSize, control_model,
    reduce,
};
use funicular::response::{FrameInput, Quantity, Signal};
use funicular::robot::{Control, Damping, DrumSide, Robot, Servo, Winch};
use funicular::statics::{self, Equilibrium, StaticModel};
use std::f64::consts::TAU;

/// Limit of the models [Hz].
const BELOW: f64 = 3.0;

/// Body of 12 kg as a point, hung from three cables: two on one post and one on a mast. `drive` and `length` are those
/// of each cable, `post` is more of the table of the post.
fn hung(drive: &str, lengths: [f64; 3], post: &str) -> Robot {
    let of_cable = |name: &str, anchor: &str, support: &str, length: f64| {
        format!(
            "[[cables]]\nname = \"{name}\"\nmaterial = \"rope\"\nanchor_m = {anchor}\nsupport = \"{support}\"\n{drive}\
             unstrained_length_m = {length}\n"
        )
    };
    let cables = of_cable("1", "[-4, 0.3, 4]", "post", lengths[0])
        + &of_cable("2", "[-3.8, -0.4, 4.2]", "post", lengths[1])
        + &of_cable("3", "[5, 0, 4.4]", "mast", lengths[2]);
    Robot::from_toml(&format!(
        "name = \"hung\"\n[platform]\nmass_kg = 12.0\nmotion = \"point-mass\"\n[materials.rope]\naxial_stiffness_n = \
         2e5\n\
         mass_kg_per_m = 0.07\n[pulleys.wheel]\nradius_m = 0.05\nentry_direction = [0.1, 0.3, 1]\ninertia_kg_m2 = \
         2e-4\n\
         swivel_inertia_kg_m2 = 1e-3\n[winches.drum]\ndrum_side_length_m = 3.0\n[supports.post]\nmass_kg = 7.0\n{post}\
         stiffness_n_per_m = [[1.5e4, 2e3, 0], [2e3, 2e4, -3e3], [0, -3e3, 9e4]]\n[supports.mast]\nmass_kg = 2.0\n\
         stiffness_n_per_m = 8e3\n{cables}"
    ))
    .unwrap()
}

/// Robot at equilibrium, linearised.
struct SupportedRobot {
    name: &'static str,
    robot: Robot,
    rest: Equilibrium,
    dynamics: Dynamics,
}

impl SupportedRobot {
    /// A robot without pulleys and winches.
    fn plain(name: &'static str, damping: Damping, post: &str) -> Self {
        Self::at_rest(name, hung("", [5.05, 5.0, 6.1], post), damping, CableModel::CatenaryDynamic)
    }

    /// A robot with pulleys and winches, which `change` gives inertia and control.
    fn driven(name: &'static str, damping: Damping, post: &str, change: impl Fn(&mut Winch)) -> Self {
        let mut robot = hung("pulley = \"wheel\"\nwinch = \"drum\"\n", [8.05, 8.0, 9.1], post);
        robot.cables.iter_mut().for_each(|cable| change(cable.anchor.winch.as_mut().unwrap()));
        Self::at_rest(name, robot, damping, CableModel::CatenaryDynamic)
    }

    fn at_rest(name: &'static str, mut robot: Robot, damping: Damping, cable_model: CableModel) -> Self {
        robot.cables.iter_mut().for_each(|cable| cable.material.damping = damping);
        let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
        let linearisation = Linearisation { cable_model, ..Linearisation::default() };
        let dynamics = Dynamics::about(&robot, &rest, linearisation, BELOW).unwrap();
        Self { name, robot, rest, dynamics }
    }

    fn second_order(&self, inputs: &[Signal], outputs: &[Signal], tolerance: f64) -> SecondOrder {
        let requested = RequestedModel { below_hz: BELOW, tolerance, damping_at: DampingAt::NaturalFrequencies };
        let outputs: Vec<_> = outputs.iter().map(|signal| (*signal, Quantity::Displacement)).collect();
        reduce(&self.robot, &self.rest, &self.dynamics, inputs, &outputs, requested, &mut |_| true).unwrap()
    }

    fn full(&self, hz: f64, inputs: &[Signal], outputs: &[Signal]) -> CDMat {
        let all = platform_responses(&self.robot, &self.rest, &self.dynamics, hz, inputs, outputs);
        CDMat::from_fn(outputs.len(), inputs.len(), |o, i| all[o * inputs.len() + i])
    }
}

fn servo(winch: &mut Winch) {
    (winch.stiffness, winch.drum_mass, winch.motor_mass, winch.damping) = (3e5, 6.0, 50.0, 40.0);
    winch.control = Control::Position(Servo::of_bandwidth(56.0, 3.0, 0.7, false, 0.0));
}

fn rods(winch: &mut Winch) {
    (winch.stiffness, winch.drum_mass, winch.drum_side) = (3e5, 6.0, DrumSide::Rod);
}

fn drive(cable: usize, signal: DriveSignal) -> Signal {
    Signal::Drive { cable, signal }
}

fn along(direction_w: Vec3) -> Signal {
    Signal::Along { direction_w, point_p: Vec3::zeros() }
}

/// Every motion of the frame, a force at the platform, and signals of the drive of a cable on the post.
fn inputs(of_drive: &[DriveSignal]) -> Vec<Signal> {
    let tilted = Vec3::new(0.4, -0.2, 1.0);
    let foot = FrameInput::Anchor { cable: 1, direction_w: Vec3::new(0.3, 0.5, 1.0) };
    let frame = [FrameInput::BaseAlong(tilted), FrameInput::BaseAbout(tilted), foot].map(Signal::Frame);
    frame.into_iter().chain([along(Vec3::z())]).chain(of_drive.iter().map(|signal| drive(0, *signal))).collect()
}

fn outputs(of_drive: &[DriveSignal]) -> Vec<Signal> {
    let on_cable = Signal::OnCable { cable: 1, fraction: 0.4, direction_w: Vec3::new(0.2, 0.5, 1.0) };
    let first = [along(Vec3::new(0.3, 1.0, 0.2)), on_cable, drive(2, DriveSignal::Tension)];
    first.into_iter().chain(of_drive.iter().map(|signal| drive(0, *signal))).collect()
}

/// Damping of the ropes, and a post whose drums stay on the ground.
const VISCOUS: Damping = Damping::Viscous(0.02);
const ON_GROUND: &str = "drums = \"on-ground\"\n";

/// Checks that with all clamped modes and viscous damping the second-order model is the full model, for every signal of
/// platform, cables and frame, and those `from` and `to` a drive.
fn is_exact_with_all_modes(case: &SupportedRobot, from: &[DriveSignal], to: &[DriveSignal]) {
    let (inputs, outputs) = (inputs(from), outputs(to));
    let model = case.second_order(&inputs, &outputs, 0.0);
    assert!(model.truncation_error.unwrap() < 1e-9, "{}: {:?}", case.name, model.truncation_error);
    assert_eq!(model.damping_error, Some(0.0));
    assert!(matches!(model.coordinates.last(), Some(Coordinate::Support { support: 1, axis: 2 })));

    for hz in [0.21, 1.37, 2.71] {
        let (full, ours) = (case.full(hz, &inputs, &outputs), model.receptance(hz * TAU).unwrap());
        for i in 0..inputs.len() {
            for o in 0..outputs.len() {
                // Rounding of the largest response of the output's kind, near resonances.
                let size = full.column(i).iter().skip(usize::from(o > 1) * 2).map(|z| z.norm()).fold(0.0, f64::max);
                let gap = (full[(o, i)] - ours[(o, i)]).norm();
                assert!(gap < 1e-7 * size, "{} at {hz} Hz, {o} {i}: {full} {ours}", case.name);
            }
        }
    }

    // M and C as they have to be.
    for matrix in [&model.mass, &model.damping, &model.stiffness] {
        assert!((matrix - matrix.transpose()).amax() <= 1e-9 * matrix.amax(), "{}", case.name);
    }
    let least = model.damping.clone().symmetric_eigenvalues().min() / model.damping.amax();
    assert!(least > -1e-10, "{}: {least}", case.name);
}

#[test]
fn without_drives_every_signal_is_exact() {
    use DriveSignal::{DrumTension, Length, Tension};
    is_exact_with_all_modes(&SupportedRobot::plain("fixed", VISCOUS, ""), &[Length], &[Tension, DrumTension]);
}

#[test]
fn with_servos_every_signal_is_exact() {
    use DriveSignal::{DrumTension, Length};
    is_exact_with_all_modes(&SupportedRobot::driven("servo", VISCOUS, "", servo), &[Length], &[DrumTension]);
}

#[test]
fn with_servos_on_the_ground_every_signal_is_exact() {
    use DriveSignal::{Drum, DrumTension, Motor};
    let case = SupportedRobot::driven("servo on the ground", VISCOUS, ON_GROUND, servo);
    is_exact_with_all_modes(&case, &[Motor], &[Drum, DrumTension]);
}

#[test]
fn with_heavy_drum_sides_every_signal_is_exact() {
    use DriveSignal::{DrumTension, Length};
    is_exact_with_all_modes(&SupportedRobot::driven("rods", VISCOUS, "", rods), &[Length], &[DrumTension]);
}

#[test]
fn with_heavy_drum_sides_from_the_ground_every_signal_is_exact() {
    use DriveSignal::{DrumTension, Length};
    let case = SupportedRobot::driven("rods on the ground", VISCOUS, ON_GROUND, rods);
    is_exact_with_all_modes(&case, &[Length], &[DrumTension]);
}

/// A model of few modes is as good as it says, also beside the constant damping ratios of supports and cables; so is
/// its state space for controllers.
#[test]
fn small_models_are_as_good_as_they_say() {
    let text = "damping_ratio = 0.02\ndrums = \"on-ground\"\n";
    let case = SupportedRobot::driven("servo", VISCOUS, text, servo);
    let (from, to) = ([inputs(&[])[0], inputs(&[])[3]], [outputs(&[])[0]]);
    let model = case.second_order(&from, &to, 1e-3);
    let complete = case.second_order(&from, &to, 0.0);
    let (stated, damping) = (model.truncation_error.unwrap(), model.damping_error.unwrap());
    assert!(stated <= 1e-3 && model.mass.nrows() < complete.mass.nrows());
    // The ratio is replaced by viscous damping: exact at a natural frequency, of the order of the ratio beside it.
    assert!(damping > 1e-6 && damping < 0.02, "{damping}");
    for hz in [0.53, 1.9] {
        let (full, ours) = (case.full(hz, &from, &to), model.receptance(hz * TAU).unwrap());
        for i in 0..2 {
            let gap = (full[(0, i)] - ours[(0, i)]).norm() / full[(0, i)].norm();
            assert!(gap < 1e-3 + 0.05, "{hz} Hz, {i}: {gap:e}");
        }
    }

    let requested = RequestedStateSpace {
        below_hz: BELOW,
        size: StateSpaceSize::Tolerance(0.03),
        damping_at: DampingAt::NaturalFrequencies,
    };
    let measured = [(to[0], Quantity::Displacement)];
    let found = control_model(&case.robot, &case.rest, &case.dynamics, &from, &measured, requested, &mut |_| true);
    let found = found.unwrap();
    assert!(found.error <= 0.03 && found.space.a.nrows() < 60, "{}", found.space.a.nrows());
    for hz in [0.31, 1.13, 2.71] {
        let full = case.full(hz, &from, &to);
        let ours = transfer(&found.space, hz);
        for (i, stated) in found.responses.iter().enumerate() {
            let gap = (full[(0, i)] - ours[(0, i)]).norm();
            // The accuracy to which maxima are searched for.
            assert!(gap <= 1.001 * stated.error * stated.peak, "{hz} Hz, {i}: {gap:e} {stated:?}");
        }
    }
    // The platform follows a slow base.
    let follows = Vec3::new(0.4, -0.2, 1.0).normalize().dot(&Vec3::new(0.3, 1.0, 0.2).normalize());
    assert!((transfer(&found.space, 0.0)[(0, 0)].re - follows).abs() < 1e-6);
}

fn transfer(space: &StateSpace, frequency_hz: f64) -> CDMat {
    let n = space.a.nrows();
    let shifted = CDMat::identity(n, n) * Complex::new(0.0, frequency_hz * TAU) - space.a.map(Complex::from);
    let solved = shifted.lu().solve(&space.b.map(Complex::from)).unwrap();
    space.c.map(Complex::from) * solved + space.d.map(Complex::from)
}

/// Supports without mass under cables without mass follow at once. They are no coordinates, and the model is exact.
#[test]
fn supports_without_mass_are_springs() {
    let mut robot = hung("", [5.05, 5.0, 6.1], "");
    robot.supports.iter_mut().for_each(|support| support.mass = 0.0);
    let case = SupportedRobot::at_rest("springs", robot, Damping::Viscous(0.0), CableModel::Spring);
    let (inputs, outputs) = (inputs(&[]), [outputs(&[])[0], outputs(&[])[1]]);
    let model = case.second_order(&inputs, &outputs, 0.0);
    assert_eq!(model.coordinates, [0, 1, 2].map(Coordinate::Platform));
    for hz in [0.21, 1.37, 2.71] {
        let (full, ours) = (case.full(hz, &inputs, &outputs), model.receptance(hz * TAU).unwrap());
        assert!((&full - &ours).camax() < 1e-10 * full.camax(), "{hz} Hz: {full} {ours}");
    }
}
