//! Small motion in time is the linear answer of the program: modes, responses to lengths, stops, held cables; and
//! without an event the robot stays at its equilibrium.

use crate::library::{at_rest, independent_robot};
use funicular::cable::catenary_dynamic::DriveSignal;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Complex, DMat, Vec3};
use funicular::modes::{self, CommandedMotions, LengthCommand, damped};
use funicular::response::{self, Port, Quantity, Signal};
use funicular::robot::{Damping, PlatformMotion, Pose, Robot};
use funicular::simulation::{ElementMesh, RobotSample, Simulation, SimulationEvent, SimulationSettings};
use funicular::statics::{self, Equilibrium, StaticModel};
use std::f64::consts::TAU;

/// Settings with which the frequencies of a motion of 1e-5 m are right to 1e-6.
const FINE: SimulationSettings = SimulationSettings {
    mesh: ElementMesh { elements: 3, degree: 8 },
    tolerance: 1e-12,
    damping_frequency_hz: None,
    stretch_damping_time: None,
    platform_is_held: false,
    gust_seed: None,
};

/// Robot with viscous damping of its ropes [N s/m²], which is the same in time and over frequency.
fn viscous(mut robot: Robot, damping: f64) -> Robot {
    for cable in &mut robot.cables {
        cable.material.damping = Damping::Viscous(damping);
    }
    robot
}

fn suspended() -> (Robot, Equilibrium) {
    let robot = viscous(independent_robot("insa-4mm-10.55kg"), 0.01);
    let rest = at_rest(&robot);
    (robot, rest)
}

/// Plate in the xz plane on four cables.
fn plate() -> (Robot, Equilibrium) {
    let cable = |name, [x, z]: [f64; 2], [a, c]: [f64; 2]| {
        format!(
            "[[cables]]\nname = \"{name}\"\nmaterial = \"rope\"\nanchor_m = [{x}, 0.0, {z}]\nattachment_m = [{a}, 0.0, \
             {c}]\n"
        )
    };
    let head = "name = \"plate\"\n[platform]\nmotion = \"planar-xz\"\nmass_kg = 8.0\ninertia_kg_m2 = 0.3\n\
                center_of_mass_m = [0.02, 0.0, -0.05]\n[materials.rope]\naxial_stiffness_n = 5e4\n\
                mass_kg_per_m = 0.05\n";
    let cables = [
        cable("1", [-2.0, 3.0], [-0.3, -0.2]),
        cable("2", [2.5, 3.2], [0.3, -0.2]),
        cable("3", [-2.0, -2.0], [-0.3, 0.2]),
        cable("4", [2.5, -2.0], [0.3, 0.2]),
    ];
    let robot = viscous(Robot::from_toml(&format!("{head}{}", cables.concat())).unwrap(), 0.02);
    held_near(robot, Pose::new([0.1, 0.0, 0.4], [0.0; 3]), 0.998)
}

/// Point mass on four cables.
fn camera() -> (Robot, Equilibrium) {
    let cable = |name, [x, y, z]: [f64; 3]| {
        format!("[[cables]]\nname = \"{name}\"\nmaterial = \"rope\"\nanchor_m = [{x:?}, {y:?}, {z:?}]\n")
    };
    let head = "name = \"camera\"\n[platform]\nmotion = \"point-mass\"\nmass_kg = 12.0\n\
                [materials.rope]\naxial_stiffness_n = 4e4\nmass_kg_per_m = 0.06\n";
    let cables = [
        cable("1", [-4.0, -3.0, 4.0]),
        cable("2", [4.0, -3.2, 4.1]),
        cable("3", [4.2, 3.0, 3.9]),
        cable("4", [-4.0, 3.1, 4.0]),
    ];
    let robot = viscous(Robot::from_toml(&format!("{head}{}", cables.concat())).unwrap(), 0.02);
    held_near(robot, Pose::new([0.3, 0.2, 1.0], [0.0; 3]), 0.999)
}

/// Robot with lengths that are a part of its chords at a pose, at rest.
fn held_near(robot: Robot, pose: Pose, part: f64) -> (Robot, Equilibrium) {
    let lengths: Vec<f64> = robot.cables.iter().map(|cable| part * cable.chord_w(&pose).norm()).collect();
    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, Some(&pose)).unwrap();
    (robot, rest)
}

/// Samples of a run, at equal steps.
fn samples(simulation: &mut Simulation, from: f64, until: f64, count: usize) -> Vec<RobotSample> {
    let time = |k: usize| from + (until - from) * k as f64 / (count - 1) as f64;
    (0..count).map(|k| simulation.at(time(k)).unwrap()).collect()
}

/// Best sum of motions `Re((A + t B) e^{λt})` and a constant, by least squares with weights that fade at both ends:
/// (A, B) for each λ.
fn fitted(times: &[f64], values: &[f64], lambdas: &[Complex]) -> Vec<(Complex, Complex)> {
    let (start, length) = (times[0], times[times.len() - 1] - times[0]);
    let weight = |time: f64| 0.5 - 0.5 * (TAU * (time - start) / length).cos();
    let part = |time: f64, column: usize| {
        let Some(lambda) = lambdas.get(column / 4) else { return 1.0 };
        let wave = (lambda * (time - start)).exp() * if column % 4 < 2 { 1.0 } else { (time - start) / length };
        if column.is_multiple_of(2) { wave.re } else { -wave.im }
    };
    // The last rows keep motions small that the history cannot tell apart.
    let (rows, columns) = (times.len(), 4 * lambdas.len() + 1);
    let small = 1e-7 * (rows as f64).sqrt();
    let entry = |j: usize, k: usize| {
        if j < rows { weight(times[j]) * part(times[j], k) } else { small * f64::from(u8::from(j - rows == k)) }
    };
    let matrix = DMat::from_fn(rows + columns, columns, entry);
    let right = DMat::from_fn(rows + columns, 1, |j, _| if j < rows { weight(times[j]) * values[j] } else { 0.0 });
    let qr = matrix.qr();
    let found = qr.r().solve_upper_triangular(&(qr.q().transpose() * right)).unwrap();
    let two = |k: usize| Complex::new(found[(k, 0)], found[(k + 1, 0)]);
    (0..lambdas.len()).map(|k| (two(4 * k), two(4 * k + 2) / length)).collect()
}

/// Largest relative difference of the frequencies of a history from those of the given λ, among those with at least
/// `least` of the largest amplitude and below a limit that no neighbour blurs; and how many these are. `histories` are
/// columns of values.
fn off(times: &[f64], histories: &[Vec<f64>], lambdas: &[Complex], [least, below_hz]: [f64; 2]) -> (f64, usize) {
    let fits: Vec<_> = histories.iter().map(|values| fitted(times, values, lambdas)).collect();
    let power = |k: usize| fits.iter().map(|fit| fit[k].0.norm_sqr()).sum::<f64>();
    let most = (0..lambdas.len()).map(power).fold(0.0, f64::max);
    let apart = 2.0 * TAU / (times[times.len() - 1] - times[0]);
    let is_alone = |k: usize| (0..lambdas.len()).all(|j| j == k || (lambdas[j].im - lambdas[k].im).abs() > apart);
    let counts = |k: &usize| power(*k) > least * least * most && lambdas[*k].im < below_hz * TAU && is_alone(*k);
    let strong: Vec<usize> = (0..lambdas.len()).filter(counts).collect();
    let shift = |k: usize| fits.iter().map(|fit| fit[k].0.conj() * fit[k].1).sum::<Complex>() / power(k);
    let worst = strong.iter().map(|k| (shift(*k).im / lambdas[*k].im).abs()).fold(0.0, f64::max);
    (worst, strong.len())
}

/// Part of the energy of a mode in the platform below which the platform does not show it.
const LEAST_ENERGY: f64 = 1e-6;

/// Poles λ below a limit [Hz], without those of cables whose ends stay at rest.
fn poles(robot: &Robot, rest: &Equilibrium, below_hz: f64) -> Vec<Complex> {
    let dynamics = Dynamics::about(robot, rest, Linearisation::default(), below_hz).unwrap();
    let found = modes::below(&dynamics, below_hz);
    let damped = damped::damped_modes(&dynamics, &found);
    assert!(damped.certified);
    let moves = |k: &usize| found.modes[*k].platform_energy_fraction > LEAST_ENERGY;
    (0..found.modes.len()).filter(moves).map(|k| damped.modes[k].eigenvalue()).collect()
}

fn push(duration: f64, force_w: Vec3, moment_w: Vec3) -> SimulationEvent {
    SimulationEvent::Push { time: 0.0, duration, rise: 0.5 * duration, force_w, moment_w, point_p: Vec3::zeros() }
}

/// Ringing of a robot: for how many cycles of its first mode, with which tolerance [m], by how much the frequencies may
/// be off, and how many modes it must show with which part of the largest amplitude.
pub(super) struct Ring {
    pub(super) cycles: f64,
    pub(super) tolerance: f64,
    pub(super) off: f64,
    pub(super) part: f64,
    pub(super) least: usize,
    /// Largest defect of the books over the work of the push.
    pub(super) books: f64,
}

/// A ring of sixty cycles, whose frequencies are right to 1e-6.
fn long(part: f64, least: usize) -> Ring {
    Ring { cycles: 60.0, tolerance: FINE.tolerance, off: 1e-6, part, least, books: 1e-4 }
}

/// A small push rings down at the damped natural frequencies of the program.
pub(super) fn rings_at_its_modes(
    (robot, rest): &(Robot, Equilibrium),
    first_hz: f64,
    force_w: Vec3,
    moment_w: Vec3,
    of: &Ring,
) {
    let (begin, end) = (0.6 / first_hz, of.cycles / first_hz);
    let settings = SimulationSettings { tolerance: of.tolerance, ..FINE };
    let event = push(begin, force_w, moment_w);
    let mut simulation = Simulation::new(robot, rest, &[event], end, &settings).unwrap();
    let found = samples(&mut simulation, begin, end, 1200);
    let times: Vec<f64> = found.iter().map(|sample| sample.time).collect();
    let turn = |sample: &RobotSample| (sample.pose.rot_wp * rest.pose.rot_wp.inverse()).scaled_axis() * 0.15;
    let histories: Vec<Vec<f64>> = (0..6)
        .map(|k| {
            let of =
                |s: &RobotSample| if k < 3 { (s.pose.position_w - rest.pose.position_w)[k] } else { turn(s)[k - 3] };
            found.iter().map(of).collect()
        })
        .collect();
    let lambdas = poles(robot, rest, 6.0 * first_hz);
    let (worst, strong) = off(&times, &histories, &lambdas, [of.part, f64::INFINITY]);
    assert!(worst < of.off && strong >= of.least, "{worst:.2e} of {strong} modes");
    let (books, defect) = (found[0].energy, found[found.len() - 1].energy.defect());
    assert!(defect.abs() < of.books * books.loads.abs(), "{defect:e} {books:?}");
}

#[test]
fn a_small_push_rings_at_the_modes_of_a_rigid_platform() {
    rings_at_its_modes(&suspended(), 1.0, Vec3::new(4e-2, 3e-2, 6e-2), Vec3::new(6e-3, 8e-3, 8e-3), &long(0.03, 6));
}

#[test]
fn a_small_push_rings_at_the_modes_of_a_planar_platform() {
    rings_at_its_modes(&plate(), 8.0, Vec3::new(0.3, 0.0, 0.5), Vec3::new(0.0, 0.1, 0.0), &long(0.1, 3));
}

#[test]
fn a_small_push_rings_at_the_modes_of_a_point_mass() {
    rings_at_its_modes(&camera(), 3.0, Vec3::new(0.04, 0.06, 0.04), Vec3::zeros(), &long(0.1, 2));
}

/// Without an event nothing moves: the mesh rests at the equilibrium of the catenaries.
#[test]
fn without_an_event_robots_stay_at_their_equilibrium() {
    for (robot, rest) in [suspended(), plate(), camera()] {
        for is_held in [false, true] {
            let settings = SimulationSettings { platform_is_held: is_held, ..FINE };
            let mut simulation = Simulation::new(&robot, &rest, &[], 1.0, &settings).unwrap();
            let found = simulation.at(1.0).unwrap();
            let turn = (found.pose.rot_wp.inverse() * rest.pose.rot_wp).angle();
            let moved = (found.pose.position_w - rest.pose.position_w).norm();
            assert!(moved < 1e-10 && turn < 1e-9, "{}: {moved:e} m, {turn:e}", robot.name);
            assert!(found.velocity_w.norm() < 1e-9 && found.energy.defect().abs() < 1e-9);
            for (cable, at_rest) in found.cables.iter().zip(&rest.cables) {
                let [a, b] = [at_rest.tension_platform, at_rest.tension_anchor];
                assert!((cable.tension_platform / a - 1.0).abs() < 1e-8, "{}: {cable:?}", robot.name);
                assert!((cable.tension_anchor / b - 1.0).abs() < 1e-8, "{}: {cable:?}", robot.name);
            }
        }
    }
}

/// A winch whose length swings a little moves platform and tensions as `frf` says.
#[test]
fn a_small_swing_of_a_length_gives_the_frequency_response() {
    swings_as_its_response(suspended().0, 5e-6);
}

/// Swings a length of a robot at rest, and compares its motion and a tension with the frequency response, whose
/// relative differences have a bound.
pub(super) fn swings_as_its_response(robot: Robot, bound: f64) {
    // Damping so strong that after six seconds only the forced motion is left.
    let mut robot = viscous(robot, 0.5);
    robot.platform.translational_damping_p = Vec3::repeat(60.0);
    robot.platform.rotational_damping_p = Vec3::repeat(1.0);
    let rest = at_rest(&robot);
    let (cable, frequency_hz, size) = (1, 2.2, 2e-5);
    let omega = TAU * frequency_hz;

    // 1 − cos begins at rest.
    let length = rest.cables[cable].unstrained_length;
    let times: Vec<f64> = (0..=3000).map(|k| f64::from(k) / 200.0).collect();
    let path = times.iter().map(|time| length + size * (1.0 - (omega * time).cos())).collect();
    let mut lengths = vec![None; robot.cables.len()];
    lengths[cable] = Some(path);
    let event = SimulationEvent::Follow { time: 0.0, times, lengths };
    let mut simulation = Simulation::new(&robot, &rest, &[event], 15.0, &FINE).unwrap();
    let found = samples(&mut simulation, 6.0, 14.5, 1000);

    // The length swings about a length that is longer by the amplitude.
    let mut lengths: Vec<f64> = rest.cables.iter().map(|cable| cable.unstrained_length).collect();
    lengths[cable] += size;
    let mean = statics::forward(&robot, &lengths, StaticModel::Catenary, Some(&rest.pose)).unwrap();
    let dynamics = Dynamics::about(&robot, &mean, Linearisation::default(), 10.0).unwrap();
    let along = |direction_w| Signal::Along { direction_w, point_p: Vec3::zeros() };
    let tension = Signal::Drive { cable: 4, signal: DriveSignal::Tension };
    let input = Signal::Drive { cable, signal: DriveSignal::Length };
    let signals = [input, along(Vec3::x()), along(Vec3::z()), tension];
    let ports = Port::all(&robot, &mean, &dynamics, &signals, false).unwrap();
    let lambdas = [Complex::new(0.0, omega)];
    let values: [fn(&RobotSample) -> f64; 3] =
        [|of| of.pose.position_w.x, |of| of.pose.position_w.z, |of| of.cables[4].tension_platform];
    let times: Vec<f64> = found.iter().map(|sample| sample.time).collect();
    for (port, value) in ports[1..].iter().zip(values) {
        let values: Vec<f64> = found.iter().map(value).collect();
        let mean = values[0];
        let values: Vec<f64> = values.iter().map(|x| x - mean).collect();
        let (a, _) = fitted(&times, &values, &lambdas)[0];
        // The command is −size e^{iωt} beside a constant, and phases count from the first sample.
        let ours = a / (Complex::new(0.0, omega * times[0]).exp() * -size);
        let exact = response::between(&dynamics, &[frequency_hz], &ports[0], port, Quantity::Displacement).unwrap()[0];
        assert!((ours - exact).norm() < bound * exact.norm(), "{ours} {exact}");
    }
}

/// Winches that stop within a small move leave the sway that `settle` computes.
#[test]
fn a_stop_of_a_small_move_leaves_the_linear_sway() {
    let (robot, rest) = suspended();
    let changes = vec![1e-5, -0.5e-5, 0.0, 0.7e-5, -1e-5, 0.3e-5];
    let ramp = SimulationEvent::Ramp { time: 0.0, duration: 1.0, changes };
    let stop = SimulationEvent::Stop { time: 0.5, duration: 0.2, cables: (0..6).collect() };
    let mut simulation = Simulation::new(&robot, &rest, &[ramp, stop], 3.0, &FINE).unwrap();
    let moving = samples(&mut simulation, 0.0, 0.7, 1401);
    let after = samples(&mut simulation, 0.7, 3.0, 100);

    let lengths = |of: &RobotSample| of.cables.iter().map(|cable| cable.length.value).collect::<Vec<f64>>();
    let command = LengthCommand::Samples {
        times: moving.iter().map(|sample| sample.time).collect(),
        lengths: moving.iter().map(lengths).collect(),
    };
    let place = statics::forward(&robot, &lengths(&after[0]), StaticModel::Catenary, Some(&rest.pose)).unwrap();
    let dynamics = Dynamics::about(&robot, &place, Linearisation::default(), 12.0).unwrap();
    let found = modes::below(&dynamics, 12.0);
    let damped = damped::damped_modes(&dynamics, &found);
    let sway = CommandedMotions::of(&dynamics, &found, &damped, &Vec3::zeros()).unwrap().after(&command);
    let of = |sample: &RobotSample| sample.pose.position_w - place.pose.position_w;
    let size = after.iter().map(|sample| of(sample).norm()).fold(0.0, f64::max);
    let worst = after.iter().map(|s| (of(s) - sway.at(s.time - 0.7)).norm()).fold(0.0, f64::max);
    assert!(worst < 5e-4 * size, "{worst:e} of {size:e}");
}

/// Cables between a held platform and their anchors ring at their clamped frequencies.
#[test]
fn cables_on_a_held_platform_ring_at_their_clamped_frequencies() {
    let (robot, rest) = suspended();
    let robot = viscous(robot, 0.0);
    let in_plane = Linearisation { in_plane_only: true, ..Linearisation::default() };
    let dynamics = Dynamics::about(&robot, &rest, in_plane, 40.0).unwrap();
    let settings = SimulationSettings { platform_is_held: true, ..FINE };
    // Lengths go a little out and back.
    let parts = [0.0, 1.0, 4.0, 6.0, 4.0, 1.0, 0.0];
    let bump = |length: f64| parts.iter().map(|part| length - 2e-6 * part).collect();
    let lengths = rest.cables.iter().map(|cable| Some(bump(cable.unstrained_length))).collect();
    let event = SimulationEvent::Follow { time: 0.0, times: (0..7).map(|k| 0.1 * f64::from(k)).collect(), lengths };
    let mut simulation = Simulation::new(&robot, &rest, &[event], 20.0, &settings).unwrap();
    let found = samples(&mut simulation, 0.6, 20.0, 2000);
    let times: Vec<f64> = found.iter().map(|sample| sample.time).collect();
    for i in 0..robot.cables.len() {
        let clamped = dynamics.clamped_frequencies_below(40.0 * TAU).into_iter().filter(|of| of.1 == i);
        let lambdas: Vec<Complex> = clamped.map(|(omega, _)| Complex::new(0.0, omega)).collect();
        let values: Vec<f64> =
            found.iter().map(|s| s.cables[i].tension_platform - rest.cables[i].tension_platform).collect();
        let (worst, strong) = off(&times, &[values], &lambdas, [0.1, 6.0]);
        assert!(worst < 2e-6 && strong >= 1, "cable {i}: {worst:e} of {strong}");
    }
}

/// A planar platform leaves its plane by nothing, and a point mass does not turn.
#[test]
fn guides_hold_what_they_guide() {
    let (robot, rest) = plate();
    assert!(matches!(robot.platform.motion, PlatformMotion::Planar { .. }));
    let event = push(0.1, Vec3::new(10.0, 5.0, 20.0), Vec3::new(3.0, 1.0, 2.0));
    let mut simulation = Simulation::new(&robot, &rest, &[event], 1.0, &FINE).unwrap();
    let found = simulation.at(1.0).unwrap();
    assert!(found.pose.position_w.y.abs() < 1e-14 && found.velocity_w[1] == 0.0, "{found:?}");
    assert!(found.velocity_w[3].abs() < 1e-14 && found.velocity_w[5].abs() < 1e-14, "{found:?}");
    assert!(found.energy.defect().abs() < 1e-5 * found.energy.loads.abs(), "{:?}", found.energy);
}
