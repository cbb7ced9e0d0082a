//! Vibration of cables with drives: closed forms of a weightless cable, interlacing, energies, modes of winches.

use super::cogiro;
use funicular::cable::catenary_dynamic::DriveSignal;
use funicular::cable::{CableModel, EndStiffness};
use funicular::cable_motion::CableStations;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Complex, Vec3};
use funicular::modes::{self, Kind};
use funicular::response::{self, FrameInput, Port, Quantity, Signal};
use funicular::robot::{Control, DrumSide, GuideWheel, Pose, Robot, Servo, StretchLoss, Winch, WinchMode};
use funicular::statics::{self, Equilibrium, StaticModel};
use std::f64::consts::TAU;

/// Cable without weight under 100 N, over a pulley of 0.4 m to a winch; `winch` are further keys of the winch.
fn weightless(damping_ratio: f64, winch: &str) -> (Robot, Equilibrium) {
    let robot = Robot::from_toml(&format!(
        "name = \"one\"\ngravity_m_s2 = [0, 0, 0]\n[platform]\nmass_kg = 1.0\nmotion = \"point-mass\"\n\
         [materials.rope]\naxial_stiffness_n = 2e4\nmass_kg_per_m = 0.1\ndamping_ratio = {damping_ratio}\n\
         [pulleys.wheel]\nradius_m = 0.4\nentry_direction = [0, 0, 1]\ninertia_kg_m2 = 0.05\n\
         swivel_inertia_kg_m2 = 0.2\n[winches.drum]\ndrum_side_length_m = 2.0\n{winch}[[cables]]\nname = \"1\"\n\
         material = \"rope\"\npulley = \"wheel\"\nwinch = \"drum\"\nanchor_m = [0, 0, 3]\nunstrained_length_m = 8.0\n\
         [loads]\nforce_n = [80, 0, -60]\n"
    ))
    .unwrap();
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    (robot, rest)
}

/// Dynamic stiffness of a rod or string whose far end has the impedance `end` [N/m].
fn rod(c: Complex, kappa: Complex, length: f64, end: Complex) -> Complex {
    let (sin, cos) = ((kappa * length).sin(), (kappa * length).cos());
    c * kappa * (end * cos - c * kappa * sin) / (end * sin + c * kappa * cos)
}

/// Shaft of 1e4 N/m, drum of 3 kg, motor of 0.5·3² kg with a servo, all at the cable: radius 0.1 m.
const WINCH: &str = "drum_radius_m = 0.1\nstiffness_n_per_m = 1e4\ndrum_inertia_kg_m2 = 0.03\n\
                     motor_inertia_kg_m2 = 0.005\ngear_ratio = 3\ndamping_n_m_s_per_rad = 0.2\ncontrol = \"position\"\n\
                     position_gain_n_m_per_rad = 60\nspeed_gain_n_m_s_per_rad = 2.5\ndelay_s = 0.004\n";

/// Impedance of drum, shaft and motor of [`WINCH`] at the drum [N/m], from theory (76) and (78).
fn at_drum(omega: f64) -> Complex {
    let i = Complex::i();
    let (drum, motor, shaft, gain, speed) = (3.0, 0.5 * 9.0, 1e4, 60.0 / 0.01, 2.5 / 0.01);
    let control = (gain + i * omega * speed) * (-i * omega * 0.004).exp();
    let at_motor = control - omega * omega * motor + i * omega * 0.2 / 0.01;
    -omega * omega * drum + 1.0 / (1.0 / shaft + 1.0 / at_motor)
}

/// Guide wheels of 0.1 m radius on the drum side of [`weightless`]: distance from the entry point [m] and moment of
/// inertia [kg m²].
const GUIDES: [(f64, f64); 2] = [(0.7, 0.02), (1.5, 0.005)];

/// Tables of guide wheels, in another order than the cable runs over them.
fn guides(wheels: &[(f64, f64)]) -> String {
    let table = |(i, (distance, inertia)): (usize, &(f64, f64))| {
        format!(
            "[guide_wheels.post{i}]\nwinch = \"drum\"\ndistance_m = {distance}\nradius_m = 0.1\ninertia_kg_m2 = \
             {inertia}\n"
        )
    };
    wheels.iter().enumerate().rev().map(table).collect()
}

/// Impedance at the exit point along the cable and sideways [N/m], from the series of theory (68), (75) and (76): from
/// the drum towards the exit point, each piece of the drum side and each guide wheel in turn. The axial stiffness of
/// the rope has the factor `h`.
fn impedances(
    rest: &Equilibrium,
    wheels: &[(f64, f64)],
    omega: f64,
    (xi, h): (f64, Complex),
    is_rod: bool,
) -> (Complex, Complex) {
    let (ea, tension): (f64, f64) = (2e4, 100.0);
    let stretch = 1.0 + tension / ea;
    let drive = rest.cables[0].drive.as_ref().unwrap();
    let wrap = drive.contact.unwrap().wrap;

    // Pieces of the drum side: springs, or rods of the length at which they have the same static stiffness.
    let kappa = omega * (0.1 / ea * Complex::new(1.0, -2.0 * xi) / h).sqrt();
    let through = |compliance: f64, behind: Complex| {
        let spring = 1.0 / (stretch * stretch * compliance);
        if is_rod { rod(ea * h, kappa, ea / spring, behind) } else { 1.0 / (1.0 / (spring * h) + 1.0 / behind) }
    };
    let straight = drive.drum_side_length / (ea * stretch * stretch * 2.0);
    let (mut behind, mut end) = (at_drum(omega), 2.0);
    for (distance, inertia) in wheels.iter().rev() {
        behind = through(straight * (end - distance), behind) - omega * omega * inertia / 0.01;
        end = *distance;
    }
    let behind = through(straight * end + 0.4 * wrap / (ea * stretch.powi(3)), behind);

    let distance = 0.8 * (0.5 * wrap).sin().powi(2);
    let swivel = tension / 0.4 / (0.5 * wrap).tan() - omega * omega * 0.2 / (distance * distance);
    (behind - omega * omega * 0.05 / 0.16, swivel.into())
}

const NO_LOSS: StretchLoss = StretchLoss { factor: 0.0, time: 0.0 };
const LOSS: StretchLoss = StretchLoss { factor: 0.05, time: 1e-4 };

/// Factor h of the axial stiffness with a loss of the stretch.
fn factor_of(loss: StretchLoss, omega: f64) -> Complex {
    Complex::new(1.0, loss.factor + omega * loss.time)
}

/// Wheel, guide wheels, drum, shaft, motor, servo with delay, damped cable: all in one closed form, which shares no
/// code.
#[test]
fn a_weightless_cable_ends_in_the_impedance_of_its_drive() {
    let (ea, m, tension): (f64, f64, f64) = (2e4, 0.1, 100.0);
    let stretch = 1.0 + tension / ea;
    let plain = [(0.0, "massless", 0), (0.02, "massless", 0), (0.02, "rod", 0), (0.02, "massless", 1)];
    let plain = plain.into_iter().chain([(0.0, "massless", 2), (0.02, "rod", 2)]).map(|case| (case, NO_LOSS));
    let lossy = [(0.0, "massless", 0), (0.02, "rod", 0), (0.02, "massless", 1), (0.01, "rod", 2)];
    for ((xi, drum_side, count), loss) in plain.chain(lossy.map(|case| (case, LOSS))) {
        let wheels = &GUIDES[..count];
        let (mut robot, rest) = weightless(xi, &format!("{WINCH}drum_side = \"{drum_side}\"\n{}", guides(wheels)));
        robot.cables[0].material.stretch_loss = loss;
        let state = &rest.cables[0];
        let model = CableModel::CatenaryDynamic;
        let found = EndStiffness::new(&robot, 0, state, model, false, WinchMode::AsGiven, 120.0).unwrap();
        let EndStiffness::Dynamic(cable) = found else { panic!("a cable with mass") };

        let e = state.chord_w().normalize();
        for hz in [0.5, 1.3, 7.0, 23.0, 61.0, 103.0] {
            let omega = hz * TAU;
            let k = cable.damped(omega);
            let (re, im) = (k.map(|z| z.re).in_world(cable.axes()), k.map(|z| z.im).in_world(cable.axes()));
            let along = Complex::new(e.dot(&(re * e)), e.dot(&(im * e)));
            let out = Complex::new(re[(1, 1)], im[(1, 1)]);

            let h = factor_of(loss, omega);
            let (slip, swivel) = impedances(&rest, wheels, omega, (xi, h), drum_side == "rod");
            let kappa = |c: Complex| omega * (m / c * Complex::new(1.0, -2.0 * xi)).sqrt();
            let length = state.free_length();
            let axial = rod(ea * h, kappa(ea * h), length, slip);
            let across = Complex::from(tension / stretch);
            let transverse = rod(across, kappa(across), length, swivel);
            for (ours, exact) in [(along, axial), (out, transverse)] {
                // Rounding of the clamped frequencies near their poles.
                let case = format!("ξ {xi}, {drum_side}, {count} wheels");
                assert!((ours - exact).norm() < 1e-8 * exact.norm(), "{case}, {hz} Hz: {ours} {exact}");
            }
        }
    }
}

/// Points along the same cable: `u(s) = cos κs + B sin κs`.
#[test]
fn points_of_a_weightless_cable_move_with_the_drive_behind_it() {
    let (mut robot, rest) = weightless(0.02, WINCH);
    robot.cables[0].material.stretch_loss = LOSS;
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 120.0).unwrap();
    let fractions = [0.2, 0.7, 1.0];
    let e = rest.cables[0].chord_w().normalize();
    let length = rest.cables[0].free_length();
    for loaded in [false, true] {
        let stations = CableStations::new(&robot, &rest, &dynamics, 0, &fractions, loaded).unwrap();
        for hz in [0.5, 7.0, 61.0] {
            let omega = hz * TAU;
            let h = factor_of(LOSS, omega);
            let (slip, _) = impedances(&rest, &[], omega, (0.02, h), false);
            let kappa = omega * (0.1 / 2e4 * Complex::new(1.0, -0.04) / h).sqrt();
            let stiff = 2e4 * h * kappa;
            let (sin, cos) = ((kappa * length).sin(), (kappa * length).cos());
            let b = (stiff * sin - slip * cos) / (stiff * cos + slip * sin);
            for (at, fraction) in fractions.iter().enumerate() {
                let phase = kappa * length * fraction;
                let exact = phase.cos() + b * phase.sin();
                let vector = stations.transmission(&dynamics, at, &e, omega);
                let ours: Complex = (0..3).map(|k| vector[k] * e[k]).sum();
                assert!((ours - exact).norm() < 1e-8, "{hz} Hz, {fraction}: {ours} {exact}");
            }
        }
    }
}

/// Points along the same cable when the base moves with anchor and drum: `u(s) = B sin κs` beside what the platform's
/// motion brings about, the far end moving by the base and by the drive behind it.
#[test]
fn points_of_a_weightless_cable_move_with_the_base() {
    let (mut robot, rest) = weightless(0.02, WINCH);
    robot.cables[0].material.stretch_loss = LOSS;
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 120.0).unwrap();
    let state = &rest.cables[0];
    let (e, length) = (state.chord_w().normalize(), state.free_length());
    let tension = 100.0 / (1.0 + 100.0 / 2e4);
    for loaded in [false, true] {
        let stations = CableStations::new(&robot, &rest, &dynamics, 0, &[0.2, 0.7], loaded).unwrap();
        for (along, is_axial) in [(e, true), (Vec3::y(), false)] {
            let base = Signal::Frame(FrameInput::BaseAlong(along));
            let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
            let of_axis = |direction_w: Vec3| Signal::Along { direction_w, point_p: Vec3::zeros() };
            let on_cable = |fraction: f64| Signal::OnCable { cable: 0, fraction, direction_w: along };
            let signals: Vec<Signal> =
                [base, on_cable(0.2), on_cable(0.7)].into_iter().chain(axes.map(of_axis)).collect();
            let ports = Port::all(&robot, &rest, &dynamics, &signals, loaded).unwrap();
            for hz in [0.5, 7.0, 61.0] {
                let omega = hz * TAU;
                let response = |output: &Port| {
                    response::between(&dynamics, &[hz], &ports[0], output, Quantity::Displacement).unwrap()[0]
                };
                let platform: Vec<Complex> = ports[3..].iter().map(response).collect();

                let h = factor_of(LOSS, omega);
                let (slip, swivel) = impedances(&rest, &[], omega, (0.02, h), false);
                let (c, end) = if is_axial { (2e4 * h, slip) } else { (tension.into(), swivel) };
                let kappa = omega * (0.1 / c * Complex::new(1.0, -0.04)).sqrt();
                let (sin, cos) = ((kappa * length).sin(), (kappa * length).cos());
                let b = end / (c * kappa * cos + end * sin);
                for (at, fraction) in [0.2, 0.7].into_iter().enumerate() {
                    let vector = stations.transmission(&dynamics, at, &along, omega);
                    let through: Complex = (0..3).map(|k| vector[k] * platform[k]).sum();
                    let (ours, exact) = (response(&ports[1 + at]) - through, b * (kappa * length * fraction).sin());
                    assert!((ours - exact).norm() < 1e-8 * b.norm(), "{hz} Hz, {fraction}: {ours} {exact}");
                }
            }
        }
    }
}

/// A drive moves the points of its own cable: at rest as forward statics does, and by the same number as a force on a
/// point moves the drive.
#[test]
fn a_drive_moves_the_points_of_its_cable() {
    let pose = Pose::new([1.0, 2.0, 1.5], [0.0; 3]);
    let plain = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    for (robot, cable) in [(plain, 2), (cogiro(0.06), 0), (driven(Control::Ideal).0, 5)] {
        let rest = statics::inverse(&robot, &pose, StaticModel::Catenary).unwrap();
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 5.0).unwrap();
        let along = Vec3::new(0.2, -0.4, 1.0).normalize();
        let (length, tension) = (DriveSignal::Length, DriveSignal::Tension);
        let drive = |signal: DriveSignal| Signal::Drive { cable, signal };
        let on_cable = Signal::OnCable { cable, fraction: 0.3, direction_w: along };
        let ports = Port::all(&robot, &rest, &dynamics, &[drive(length), on_cable, drive(tension)], true).unwrap();
        let response = |from: usize, to: usize| {
            response::between(&dynamics, &[1e-5], &ports[from], &ports[to], Quantity::Displacement).unwrap()[0].re
        };

        // The point keeps its unstrained distance from the platform.
        let mut lengths: Vec<f64> = rest.cables.iter().map(|cable| cable.unstrained_length).collect();
        let (before, step) = (lengths[cable], 1e-5);
        let at = 0.3 * rest.cables[cable].free_length();
        let mut moved = |by: f64| {
            lengths[cable] = before + by;
            let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, Some(&rest.pose)).unwrap();
            rest.cables[cable].hanging.as_ref().unwrap().point_w(at)
        };
        let by_statics = (moved(step) - moved(-step)).dot(&along) / (2.0 * step);
        // The step's square.
        assert!((response(0, 1) - by_statics).abs() < 1e-5 * by_statics.abs(), "{} {by_statics}", response(0, 1));

        // A point at the platform is the platform: a force there changes the tension by the same number.
        let end = Signal::OnCable { cable, fraction: 0.0, direction_w: along };
        let lever = rest.cables[cable].lever_w;
        let point_p = rest.pose.rot_wp.inverse() * lever;
        let platform = Signal::Along { direction_w: along, point_p };
        let ports = Port::all(&robot, &rest, &dynamics, &[end, platform, drive(tension)], true).unwrap();
        for hz in [0.4, 3.7] {
            let of = |from: usize| {
                response::between(&dynamics, &[hz], &ports[from], &ports[2], Quantity::Displacement).unwrap()[0]
            };
            // At the end itself the held platform takes the force's component along the cable at once.
            let h = rest.cables[cable].hanging.as_ref().unwrap().force_on_start_w().normalize().dot(&along);
            assert!((of(0) - of(1) - h).norm() < 1e-7 * of(1).norm().max(1.0), "{hz}: {} {} {h}", of(0), of(1));
        }
    }

    // A force on the motor, or on a point of its cable.
    let (robot, rest) = driven(servo(5e4, 300.0));
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 5.0).unwrap();
    let on_cable = Signal::OnCable { cable: 3, fraction: 0.6, direction_w: Vec3::new(0.3, -0.5, 1.0) };
    let drive = |signal: DriveSignal| Signal::Drive { cable: 3, signal };
    let signals = [on_cable, drive(DriveSignal::Motor), drive(DriveSignal::Drum)];
    let ports = Port::all(&robot, &rest, &dynamics, &signals, true).unwrap();
    for hz in [0.3, 2.0, 4.4] {
        let response = |from: usize, to: usize| {
            response::between(&dynamics, &[hz], &ports[from], &ports[to], Quantity::Displacement).unwrap()[0]
        };
        for other in [1, 2] {
            let (there, back) = (response(0, other), response(other, 0));
            assert!((there - back).norm() < 1e-9 * there.norm(), "{hz} Hz: {there} {back}");
        }
    }
}

/// CoGiRo over pulleys, with inertia and a control in all its winches.
pub(super) fn driven(control: Control) -> (Robot, Equilibrium) {
    let mut robot = cogiro(0.06);
    for cable in &mut robot.cables {
        let winch = cable.anchor.winch.as_mut().unwrap();
        (winch.stiffness, winch.drum_mass, winch.motor_mass) = (f64::INFINITY, 20.0, 40.0);
        winch.control = control;
        let pulley = cable.anchor.pulley.as_mut().unwrap();
        (pulley.inertia, pulley.swivel_inertia) = (5e-4, 3e-3);
    }
    let rest = statics::inverse(&robot, &Pose::new([1.0, 2.0, 1.5], [0.0; 3]), StaticModel::Catenary).unwrap();
    (robot, rest)
}

pub(super) fn servo(position_gain: f64, speed_gain: f64) -> Control {
    Control::Position(Servo { position_gain, speed_gain, integral: true, delay: 0.0 })
}

fn listed(robot: &Robot, rest: &Equilibrium, winches: WinchMode, below_hz: f64) -> Vec<f64> {
    let dynamics = Dynamics::about(robot, rest, Linearisation { winches, ..Default::default() }, below_hz).unwrap();
    let found = modes::below(&dynamics, below_hz);
    assert!(found.certified && found.unstable_directions == 0, "{winches:?}");
    found.modes.iter().map(|mode| mode.frequency_hz).collect()
}

/// The position gain is a change of the stiffness of rank m, one per winch: it lifts every frequency, none beyond the
/// one m places above, and clamped motors are its limit. Cables that stick to their pulleys are stiffer still.
#[test]
fn frequencies_interlace_in_the_position_gain() {
    let below_hz = 9.0;
    let (robot, rest) = driven(servo(5e4, 0.0));
    let free = listed(&robot, &rest, WinchMode::Torque, below_hz);
    let mut lower = free.clone();
    for gain in [1e3, 5e4, 1e7] {
        let (robot, rest) = driven(servo(gain, 0.0));
        let higher = listed(&robot, &rest, WinchMode::AsGiven, below_hz);
        for (j, f) in higher.iter().enumerate() {
            assert!(lower.get(j).is_some_and(|lower| *lower <= f * (1.0 + 1e-9)), "gain {gain}, mode {j}");
            assert!(
                free.get(j + robot.cables.len()).is_none_or(|free| *f <= free * (1.0 + 1e-9)),
                "gain {gain}, mode {j}"
            );
        }
        lower = higher;
    }

    let clamped = listed(&robot, &rest, WinchMode::Clamped, below_hz);
    let stuck = listed(&robot, &rest, WinchMode::Stuck, below_hz);
    assert!(stuck.len() <= clamped.len() && clamped.len() <= lower.len() && lower.len() < free.len());
    assert!(stuck.iter().zip(&clamped).all(|(stuck, clamped)| *stuck >= clamped * (1.0 - 1e-9)));

    // A gain of 1e12 N/m is a clamped motor, to the ratio of the stiffnesses.
    let (robot, rest) = driven(servo(1e12, 0.0));
    let stiff = listed(&robot, &rest, WinchMode::AsGiven, below_hz);
    assert!(stiff.len() == clamped.len() && stiff.iter().zip(&clamped).all(|(a, b)| (a / b - 1.0).abs() < 1e-6));
}

#[test]
fn energies_of_platform_cables_and_drives_add_up() {
    let (mut robot, rest) = driven(servo(5e4, 0.0));
    for cable in robot.cables.iter_mut().take(3) {
        let wheel = GuideWheel { name: "post".to_owned(), distance: 2.0, mass: 3.0 };
        cable.anchor.winch.as_mut().unwrap().guide_wheels.push(wheel);
    }
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 12.0).unwrap();
    let found = modes::below(&dynamics, 12.0);
    for mode in &found.modes {
        let parts = [&mode.cable_energy_fractions, &mode.drive_energy_fractions];
        let sum = mode.platform_energy_fraction + parts.iter().flat_map(|part| part.iter()).sum::<f64>();
        assert!((sum - 1.0).abs() < 1e-9, "{} Hz: {sum}", mode.frequency_hz);
        assert!(parts.iter().flat_map(|part| part.iter()).all(|part| *part > -1e-9), "{} Hz", mode.frequency_hz);
    }
    assert!(found.modes.iter().any(|mode| mode.kind == Kind::Drive));

    // The share of a mass is the logarithmic derivative of ω² by it: −Δω²/ω² per relative change of all drives' masses.
    let share = |mode: &modes::Mode| mode.drive_energy_fractions.iter().sum::<f64>();
    let mut heavier = robot.clone();
    let step = 1e-5;
    for cable in &mut heavier.cables {
        let winch = cable.anchor.winch.as_mut().unwrap();
        winch.drum_mass *= 1.0 + step;
        winch.motor_mass *= 1.0 + step;
        winch.guide_wheels.iter_mut().for_each(|wheel| wheel.mass *= 1.0 + step);
        let pulley = cable.anchor.pulley.as_mut().unwrap();
        pulley.inertia *= 1.0 + step;
        pulley.swivel_inertia *= 1.0 + step;
    }
    let moved = listed(&heavier, &rest, WinchMode::AsGiven, 12.0);
    for (mode, moved) in found.modes.iter().zip(&moved).take(12) {
        let change = 2.0 * (mode.frequency_hz / moved).ln() / step;
        // The square of the step, larger where frequencies are close.
        assert!((change - share(mode)).abs() < 1e-3, "{} Hz: {change} {}", mode.frequency_hz, share(mode));
    }
}

/// Guide wheels without inertia change nothing, and each one with inertia lowers every frequency, down to those of a
/// drum in its place that does not turn.
#[test]
fn guide_wheels_lie_between_no_wheel_and_a_drum_in_their_place() {
    let (robot, rest) = driven(servo(5e4, 0.0));
    let with = |mass: f64, mode: WinchMode| {
        let mut robot = robot.clone();
        for cable in &mut robot.cables {
            let wheel = |name: &str, distance: f64| GuideWheel { name: name.to_owned(), distance, mass };
            let winch = cable.anchor.winch.as_mut().unwrap();
            winch.guide_wheels = vec![wheel("upper", 1.5), wheel("lower", 4.2)];
        }
        listed(&robot, &rest, mode, 9.0)
    };
    let without = listed(&robot, &rest, WinchMode::AsGiven, 9.0);
    assert_eq!(with(0.0, WinchMode::AsGiven), without);
    let light = with(1e-7, WinchMode::AsGiven);
    assert!(light.len() == without.len() && light.iter().zip(&without).all(|(a, b)| (a / b - 1.0).abs() < 1e-7));
    let mut lower = without;
    for mass in [0.5, 20.0, 500.0] {
        let found = with(mass, WinchMode::AsGiven);
        assert!(found.len() >= lower.len() && lower.iter().zip(&found).all(|(a, b)| *b <= a * (1.0 + 1e-9)), "{mass}");
        lower = found;
    }

    // Wheels that cannot turn hold the cable; beside the first of them there are modes of the others and of the drums.
    let heavy = with(1e9, WinchMode::Clamped);
    let mut held = robot.clone();
    for cable in &mut held.cables {
        *cable.anchor.winch.as_mut().unwrap() = Winch::rigid("wheel", 1.5);
    }
    let rest_of_held = statics::inverse(&held, &rest.pose, StaticModel::Catenary).unwrap();
    let held = listed(&held, &rest_of_held, WinchMode::AsGiven, 9.0);
    // Two wheels per cable have frequencies of nearly zero; the ratio of the masses is 1e-8.
    let heavy = &heavy[2 * robot.cables.len()..];
    assert!(heavy.len() == held.len() && heavy.iter().zip(&held).all(|(a, b)| (a / b - 1.0).abs() < 1e-6));
}

/// A servo's weak speed gain damps to first order as its loss in the undamped mode; a strong one is found, counted, and
/// decays; without losses of the drive nothing changes.
#[test]
fn servos_damp_and_every_mode_has_its_partner() {
    for (speed_gain, is_weak) in [(20.0, true), (2500.0, false)] {
        let (robot, rest) = driven(servo(6e4, speed_gain));
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 8.0).unwrap();
        let found = modes::below(&dynamics, 8.0);
        let damped = modes::damped::damped_modes(&dynamics, &found);
        assert!(damped.certified && damped.modes.len() == found.modes.len(), "gain {speed_gain}");
        assert!(damped.modes.iter().all(|mode| mode.damping_ratio() > 0.0));
        for (mode, partner) in found.modes.iter().zip(&damped.modes).filter(|_| is_weak) {
            let (first_order, ratio) = (mode.damping_ratio, partner.damping_ratio());
            // The second order: the damping over the distance of the next mode.
            assert!((first_order - ratio).abs() < 0.1 * first_order + 1e-6, "{first_order} {ratio}");
        }
    }
}

#[test]
fn a_drum_without_anything_behind_it_is_refused_where_the_cable_would_run_out() {
    // A long horizontal cable with little tension, which its own weight pulls over the wheel.
    let text = "name = \"one\"\n[platform]\nmass_kg = 0.1\nmotion = \"point-mass\"\n[materials.rope]\n\
                axial_stiffness_n = 2e5\nmass_kg_per_m = 1.0\n[winches.drum]\ndrum_side_length_m = 1\ndrum_radius_m = \
                0.1\n\
                drum_inertia_kg_m2 = 0.01\ncontrol = \"torque\"\n[[cables]]\nname = \"1\"\nmaterial = \"rope\"\n\
                winch = \"drum\"\nanchor_m = [0, 0, 10]\nunstrained_length_m = 26.0\n[loads]\nforce_n = [20, 0, 100]\n";
    let robot = Robot::from_toml(text).unwrap();
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let error = Dynamics::about(&robot, &rest, Linearisation::default(), 2.0).unwrap_err();
    assert!(error.to_string().contains("pull it over its pulley"), "{error}");
    let clamped = Linearisation { winches: WinchMode::Clamped, ..Default::default() };
    assert!(Dynamics::about(&robot, &rest, clamped, 2.0).is_ok());
}

#[test]
fn a_rod_on_the_drum_side_lowers_frequencies_a_little() {
    let (mut robot, rest) = driven(servo(5e4, 0.0));
    let massless = listed(&robot, &rest, WinchMode::AsGiven, 9.0);
    for cable in &mut robot.cables {
        cable.anchor.winch.as_mut().unwrap().drum_side = DrumSide::Rod;
    }
    let rod = listed(&robot, &rest, WinchMode::AsGiven, 9.0);
    assert_eq!(rod.len(), massless.len());
    assert!(rod.iter().zip(&massless).all(|(rod, massless)| *rod <= massless * (1.0 + 1e-12)));
    assert!(rod.iter().zip(&massless).any(|(rod, massless)| *rod < massless * (1.0 - 1e-6)));
}

/// A commanded length moves the platform at rest as forward statics does; with fixed anchors and with winches. A force
/// of a motor moves its drum, and the drum's motion answers to a force on the platform by the same number.
#[test]
fn commanded_lengths_begin_at_the_derivative_of_statics() {
    let pose = Pose::new([1.0, 2.0, 1.5], [0.0; 3]);
    let plain = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    for (robot, cable) in [(plain, 2), (cogiro(0.06), 0), (driven(Control::Ideal).0, 5)] {
        let rest = statics::inverse(&robot, &pose, StaticModel::Catenary).unwrap();
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 5.0).unwrap();
        let signals = [
            Signal::Drive { cable, signal: DriveSignal::Length },
            Signal::Along { direction_w: Vec3::new(0.2, -0.4, 1.0), point_p: Vec3::zeros() },
            Signal::Drive { cable, signal: DriveSignal::Tension },
        ];
        let ports = Port::all(&robot, &rest, &dynamics, &signals, false).unwrap();
        let slow = |output: &Port| {
            response::between(&dynamics, &[1e-5], &ports[0], output, Quantity::Displacement).unwrap()[0].re
        };

        let mut lengths: Vec<f64> = rest.cables.iter().map(|cable| cable.unstrained_length).collect();
        let (length, step) = (lengths[cable], 1e-5);
        let mut moved = |by: f64| {
            lengths[cable] = length + by;
            statics::forward(&robot, &lengths, StaticModel::Catenary, Some(&rest.pose)).unwrap()
        };
        let (ahead, behind) = (moved(step), moved(-step));
        let along = Vec3::new(0.2, -0.4, 1.0).normalize();
        let by_statics = (ahead.pose.position_w - behind.pose.position_w).dot(&along) / (2.0 * step);
        // The step's square.
        assert!((slow(&ports[1]) - by_statics).abs() < 1e-5 * by_statics.abs(), "{} {by_statics}", slow(&ports[1]));
        let tension = |rest: &Equilibrium| rest.cables[cable].tension_platform;
        let by_statics = (tension(&ahead) - tension(&behind)) / (2.0 * step);
        // The force's derivative along the cable: its direction turns by the second order only.
        assert!((slow(&ports[2]) - by_statics).abs() < 1e-4 * by_statics.abs(), "{} {by_statics}", slow(&ports[2]));
    }

    let (robot, rest) = driven(servo(5e4, 300.0));
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 5.0).unwrap();
    let fz = Signal::Along { direction_w: Vec3::z(), point_p: Vec3::zeros() };
    let motor = Signal::Drive { cable: 3, signal: DriveSignal::Motor };
    let ports = Port::all(&robot, &rest, &dynamics, &[fz, motor], false).unwrap();
    for hz in [0.3, 2.0, 4.4] {
        let response = |from: usize, to: usize| {
            response::between(&dynamics, &[hz], &ports[from], &ports[to], Quantity::Displacement).unwrap()[0]
        };
        let (there, back) = (response(0, 1), response(1, 0));
        assert!((there - back).norm() < 1e-9 * there.norm());
        // A force on the motor does work: its motion lags behind it.
        assert!(response(1, 1).im < 0.0);
    }

    let torque = driven(Control::Torque).0;
    let dynamics = Dynamics::about(&torque, &rest, Linearisation::default(), 5.0).unwrap();
    let length = Signal::Drive { cable: 3, signal: DriveSignal::Length };
    let error = Port::all(&torque, &rest, &dynamics, &[length], false).unwrap_err();
    assert!(error.to_string().contains("has no signal `length`"), "{error}");
}

/// A delay of the loop takes phase: a servo that is stable with little delay grows with more, in every list that the
/// count certifies. With gains of three times the critical damping some motions no longer ring.
#[test]
fn delays_destabilise_and_strong_gains_stop_ringing() {
    let partners = |speed_gain: f64, delay: f64| {
        let servo = Servo { position_gain: 6e4, speed_gain, integral: true, delay };
        let (robot, rest) = driven(Control::Position(servo));
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 4.0).unwrap();
        modes::damped_partners(&dynamics, &modes::below(&dynamics, 4.0))
    };

    let least = |delay: f64| {
        let (found, caveat) = partners(2500.0, delay);
        let found = found.unwrap();
        assert!(found.certified, "delay {delay}");
        (found.modes.iter().map(modes::damped::DampedMode::damping_ratio).fold(f64::INFINITY, f64::min), caveat)
    };
    let (stable, caveat) = least(0.001);
    assert!(stable > 0.0 && caveat.iter().all(|caveat| !caveat.contains("unstable")));
    let (unstable, caveat) = least(0.06);
    assert!(unstable < -0.01 && caveat[0].contains("the control of the motors is unstable"), "{unstable}");

    let (found, caveat) = partners(12_000.0, 0.0);
    assert!(found.unwrap().overdamped > 0 && caveat[0].contains("do not ring"));
}

/// The tension at the drum moves drum, shaft and motor: theory (76) at any frequency, whatever lies before the drum.
#[test]
fn the_tension_at_the_drum_is_the_impedance_of_the_winch_times_its_motion() {
    for (drum_side, count) in [("massless", 0), ("rod", 0), ("massless", 2), ("rod", 2)] {
        let wheels = guides(&GUIDES[..count]);
        let (mut robot, rest) = weightless(0.01, &format!("{WINCH}drum_side = \"{drum_side}\"\n{wheels}"));
        robot.cables[0].material.stretch_loss = LOSS;
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 120.0).unwrap();
        let drive = |signal: DriveSignal| Signal::Drive { cable: 0, signal };
        let along = |direction_w: Vec3| Signal::Along { direction_w, point_p: Vec3::zeros() };
        let moved = Signal::Frame(FrameInput::Anchor { cable: 0, direction_w: Vec3::new(0.3, 0.1, 0.8) });
        let base = Signal::Frame(FrameInput::BaseAlong(Vec3::new(0.3, 0.1, 0.8)));
        let inputs = [along(Vec3::x()), along(Vec3::z()), drive(DriveSignal::Drum), moved, base];
        let inputs = Port::all(&robot, &rest, &dynamics, &inputs, false).unwrap();
        let outputs = [drive(DriveSignal::DrumTension), drive(DriveSignal::Drum)];
        let outputs = Port::all(&robot, &rest, &dynamics, &outputs, false).unwrap();
        let outputs: Vec<(Port, Quantity)> = outputs.into_iter().map(|port| (port, Quantity::Displacement)).collect();

        for hz in [0.5, 7.0, 23.0, 103.0] {
            let found = response::matrix(&dynamics, &[hz], &inputs, &outputs).unwrap();
            for input in 0..inputs.len() {
                let (tension, motion) = (found[input][0], found[inputs.len() + input][0]);
                let on_drum = if input == 2 { 1.0 } else { 0.0 };
                let expected = at_drum(hz * TAU) * motion - on_drum;
                let size = tension.norm().max(on_drum);
                assert!((tension - expected).norm() < 1e-8 * size, "{drum_side} {hz} Hz {input}: {tension} {expected}");
            }
        }
    }
}
