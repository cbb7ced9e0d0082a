//! Shallow-dynamic cables with drives, against the closed form with both ends of the span free to move, which shares no
//! code with the poles and residues of the program; and limits of the whole robot.

use super::cogiro;
use super::vibration::{driven, servo};
use funicular::cable::catenary_dynamic::DriveSignal;
use funicular::cable::shallow_dynamic::ShallowDynamic;
use funicular::cable::{CableModel, DynamicCable, EndStiffness, LocalAxes, Sag};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{CDMat, Complex, DMat, Mat3, Vec3, Vec6};
use funicular::modes::{self, Kind};
use funicular::response::{self, FrameInput, Port, Quantity, Signal};
use funicular::robot::{Control, Damping, GuideWheel, Pose, Robot, Servo, WinchMode};
use funicular::statics::{self, CableState, Equilibrium, StaticModel};
use std::f64::consts::TAU;

const SHALLOW: Linearisation = Linearisation {
    cable_model: CableModel::ShallowDynamic,
    assembly: funicular::dynamics::Assembly::Consistent,
    in_plane_only: false,
    winches: WinchMode::AsGiven,
};

/// Stiffness of both ends of a shallow span at ω_c² over (e, n, b) of the platform end and of the far end [N/m].
fn both_ends(sag: &Sag, square: Complex) -> CDMat {
    let Sag { chord, tension, axial_stiffness, mass_per_length, epsilon, effective_length, lambda2 } = *sag;
    let gamma = square * (chord * chord * mass_per_length / (4.0 * tension));
    let root = gamma.sqrt();
    let (c, sigma) = (root.cos(), root.sin() / root);
    let q = (sigma - c) / gamma;
    let along = axial_stiffness / effective_length * c / (c + 0.25 * lambda2 * q);
    let y = gamma * q / c * (0.5 * epsilon);
    let w = [Complex::from(1.0), y, 0.0.into(), Complex::from(-1.0), y, 0.0.into()];
    let mut k = CDMat::from_fn(6, 6, |i, j| along * w[i] * w[j]);
    for axis in [1, 2] {
        let (own, across) = ((c / sigma - gamma * sigma / c) * (tension / chord), tension / chord / (sigma * c));
        for end in [axis, axis + 3] {
            k[(end, end)] += own;
        }
        k[(axis, axis + 3)] -= across;
        k[(axis + 3, axis)] -= across;
    }
    k
}

/// Drive of the robots of this file over (σ, v, w), or (σ, v, w, g) with a guide wheel: rigid winches of 60 kg with
/// this control, wheels and swivels with mass. The guide wheel divides the drum side, from 5 m, at its distance.
fn of_drive(robot: &Robot, state: &CableState, control: Complex, omega: f64) -> CDMat {
    let (anchor, drive) = (&robot.cables[0].anchor, state.drive.as_ref().unwrap());
    let ea = robot.cables[0].material.axial_stiffness;
    let (lambda, at_drum) = (1.0 + state.tension_anchor / ea, 1.0 + drive.tension_drum / ea);
    let ratio = lambda / at_drum;
    let spring = drive.end.force_by_length / lambda;
    let [[slip, coupling], [_, swivel]] = drive.end.stiffness;
    let (pulley, x) = (anchor.pulley.as_ref().unwrap(), omega * omega);
    let distance = drive.contact.unwrap().distance_from_axis();

    let wheel = anchor.winch.as_ref().unwrap().guide_wheels.first();
    let mut z = CDMat::zeros(3 + usize::from(wheel.is_some()), 3 + usize::from(wheel.is_some()));
    z[(0, 0)] = (slip - spring - x * pulley.inertia / pulley.radius.powi(2)).into();
    z[(1, 1)] = (swivel - x * pulley.swivel_inertia / distance.powi(2)).into();
    z[(2, 2)] = control - 60.0 * x;
    (z[(0, 1)], z[(1, 0)]) = (coupling.into(), coupling.into());
    let mut add = |spring: f64, (i, a): (usize, f64), (j, b): (usize, f64)| {
        for (i, j, product) in [(i, i, a * a), (i, j, -a * b), (j, i, -a * b), (j, j, b * b)] {
            z[(i, j)] += spring * product;
        }
    };
    if let Some(wheel) = wheel {
        // Unstrained lengths over EA: pieces of the drum side from the drum to the wheel, and the rest with the arc.
        let to_drum = drive.drum_side_length * (1.0 - wheel.distance / 5.0) / (ea * at_drum.powi(2));
        let behind = 1.0 / (lambda.powi(2) * to_drum);
        add(1.0 / (1.0 / spring - 1.0 / behind), (0, 1.0), (3, ratio));
        add(behind, (3, ratio), (2, ratio));
        z[(3, 3)] -= wheel.mass * x;
    } else {
        add(spring, (0, 1.0), (2, ratio));
    }
    z
}

/// K_BB condensed on the motions (σ, v, w) with the drive: the matrix Y, and the columns of the platform end.
fn with_drive(robot: &Robot, state: &CableState, square: Complex, drive: &CDMat) -> (CDMat, CDMat, CDMat) {
    let axes = LocalAxes::of_cable(robot, 0, state);
    let end = &state.drive.as_ref().unwrap().end;
    let local = |direction: Vec3| [axes.e, axes.n, axes.b].map(|axis| axis.dot(&direction));
    let (t, v) = (local(end.along_w.unwrap()), local(end.sideways_w.unwrap()));
    let columns = [t, v];
    let w = CDMat::from_fn(3, drive.nrows(), |i, j| columns.get(j).map_or(0.0, |column| column[i]).into());
    let k = both_ends(&Sag::of(robot, 0, state), square);
    let block = |i: usize, j: usize| k.view((i, j), (3, 3)).into_owned();
    let y = w.transpose() * block(3, 3) * &w + drive;
    (block(0, 0), block(0, 3) * w, y)
}

/// Robots with upright and with tilted swivel axes; the second has guide wheels.
fn robots(control: Control) -> [(Robot, Equilibrium); 3] {
    let (robot, rest) = driven(control);
    let mut guided = robot.clone();
    for cable in &mut guided.cables {
        let wheel = GuideWheel { name: "post".to_owned(), distance: 1.7, mass: 9.0 };
        cable.anchor.winch.as_mut().unwrap().guide_wheels.push(wheel);
    }
    let mut tilted = robot.clone();
    for cable in &mut tilted.cables {
        cable.anchor.pulley.as_mut().unwrap().entry_direction_w = Vec3::new(0.3, 0.1, 1.0).normalize();
    }
    let inclined = statics::inverse(&tilted, &rest.pose, StaticModel::Catenary).unwrap();
    [(robot, rest.clone()), (guided, rest), (tilted, inclined)]
}

fn dynamic(robot: &Robot, state: &CableState, up_to_hz: f64) -> DynamicCable {
    let model = CableModel::ShallowDynamic;
    let found = EndStiffness::new(robot, 0, state, model, false, WinchMode::AsGiven, up_to_hz).unwrap();
    let EndStiffness::Dynamic(cable) = found else { panic!("a cable with mass") };
    cable
}

/// Wheel, swivel, drum, servo with delay and damping of the rope: poles and residues are the closed form with the drive
/// condensed.
#[test]
fn the_stiffness_is_that_of_the_closed_form_with_both_ends() {
    let control = Control::Position(Servo { position_gain: 6e4, speed_gain: 900.0, integral: true, delay: 0.01 });
    for (mut robot, rest) in robots(control) {
        for damping in [Damping::Ratio(0.0), Damping::Ratio(0.01), Damping::Viscous(0.05)] {
            robot.cables.iter_mut().for_each(|cable| cable.material.damping = damping);
            let state = &rest.cables[0];
            let cable = dynamic(&robot, state, 30.0);
            for hz in [0.2, 1.1, 2.7, 5.3, 9.9, 17.0, 29.0] {
                let omega = hz * TAU;
                let i = Complex::i();
                let law = (6e4 + i * omega * 900.0) * (-i * omega * 0.01).exp();
                let mass = robot.cables[0].material.mass_per_length;
                let square = match damping {
                    Damping::Ratio(xi) => omega * omega * (1.0 - 2.0 * i * xi),
                    Damping::Viscous(c) => omega * omega - i * omega * c / mass,
                };
                let drive = of_drive(&robot, state, law, omega);
                let (own, across, y) = with_drive(&robot, state, square, &drive);
                let exact = own - &across * y.try_inverse().unwrap() * across.transpose();

                let k = cable.damped(omega);
                let [eb, nb] = k.across;
                let ours = [[k.axial, k.coupling, eb], [k.coupling, k.normal, nb], [eb, nb, k.out_of_plane]];
                let size = exact.iter().map(|entry| entry.norm()).fold(0.0, f64::max);
                for (r, row) in ours.iter().enumerate() {
                    for (c, ours) in row.iter().enumerate() {
                        // Rounding of the clamped frequencies near their poles.
                        assert!((ours - exact[(r, c)]).norm() < 1e-8 * size, "{hz} Hz {damping:?}: {ours} {exact}");
                    }
                }
            }
        }
    }
}

/// Number of poles below a frequency: those of the span with both ends held, and the negative eigenvalues of the matrix
/// of slip, swivel and drum.
#[test]
fn the_count_of_poles_is_that_of_the_span_and_of_the_drive() {
    for (robot, rest) in robots(servo(6e4, 0.0)) {
        let state = &rest.cables[0];
        let (cable, sag) = (dynamic(&robot, state, 40.0), Sag::of(&robot, 0, state));
        let span = ShallowDynamic::new(sag, LocalAxes::of_cable(&robot, 0, state), Damping::Ratio(0.0), false);
        let mut last = 0;
        for step in 1..400 {
            let omega = 0.0997 * TAU * f64::from(step);
            let drive = of_drive(&robot, state, Complex::from(6e4), omega);
            let (_, _, y) = with_drive(&robot, state, (omega * omega).into(), &drive);
            let y: DMat = y.map(|entry| entry.re);
            let negative = y.symmetric_eigenvalues().iter().filter(|value| **value < 0.0).count();
            last = span.clamped_modes_below(omega) + negative;
            assert_eq!(cable.clamped_modes_below(omega), last, "{} Hz", omega / TAU);
        }
        assert!(last > 10, "{last}");
    }
}

/// At rest the span is in series with its drive, as the shallow-static model has it.
#[test]
fn at_rest_it_is_the_series_connection_of_shallow_static() {
    for (robot, rest) in robots(Control::Ideal) {
        let with = |cable_model| {
            let linearisation = Linearisation { cable_model, ..SHALLOW };
            Dynamics::about(&robot, &rest, linearisation, 5.0).unwrap().stiffness(1e-4).map(|entry| entry.re)
        };
        let (dynamic, still) = (with(CableModel::ShallowDynamic), with(CableModel::ShallowStatic));
        assert!((dynamic - still).amax() < 1e-9 * still.amax(), "{dynamic} {still}");
    }
}

fn list(robot: &Robot, rest: &Equilibrium, winches: WinchMode, below_hz: f64) -> (Dynamics, modes::Modes) {
    let dynamics = Dynamics::about(robot, rest, Linearisation { winches, ..SHALLOW }, below_hz).unwrap();
    let found = modes::below(&dynamics, below_hz);
    assert!(found.certified && found.unstable_directions == 0, "{winches:?}");
    (dynamics, found)
}

fn frequencies(robot: &Robot, rest: &Equilibrium, winches: WinchMode, below_hz: f64) -> Vec<f64> {
    list(robot, rest, winches, below_hz).1.modes.iter().map(|mode| mode.frequency_hz).collect()
}

/// Without radius and drum side the modes are those of cables that end at fixed points.
#[test]
fn without_radius_and_drum_side_the_modes_are_those_of_fixed_points() {
    let pose = Pose::new([1.0, 2.0, 1.5], [0.0; 3]);
    let of = |robot: &Robot| {
        let rest = statics::inverse(robot, &pose, StaticModel::Catenary).unwrap();
        frequencies(robot, &rest, WinchMode::AsGiven, 12.0)
    };
    let fixed = of(&Robot::from_toml(funicular_robots::COGIRO).unwrap());
    let mut largest = Vec::new();
    for size in [1e-3, 1e-4] {
        let mut robot = cogiro(0.06 * size);
        for cable in &mut robot.cables {
            let winch = cable.anchor.winch.as_mut().unwrap();
            (winch.drum_side_length, winch.stiffness) = (5.0 * size, f64::INFINITY);
        }
        let driven = of(&robot);
        assert_eq!(driven.len(), fixed.len());
        largest.push(driven.iter().zip(&fixed).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max));
    }
    // The change is of first order in the size; 5 m to the drum make 20 %.
    assert!(largest[0] < 1e-3 && largest[1] < 0.11 * largest[0], "{largest:?}");
}

#[test]
fn its_frequencies_interlace_and_its_energies_add_up() {
    let (robot, rest) = driven(servo(5e4, 0.0));
    let free = frequencies(&robot, &rest, WinchMode::Torque, 9.0);
    let mut lower = free.clone();
    for gain in [1e3, 5e4, 1e7] {
        let (robot, rest) = driven(servo(gain, 0.0));
        let higher = frequencies(&robot, &rest, WinchMode::AsGiven, 9.0);
        for (j, f) in higher.iter().enumerate() {
            assert!(lower[j] <= f * (1.0 + 1e-9), "gain {gain}, mode {j}");
            assert!(free.get(j + 8).is_none_or(|free| *f <= free * (1.0 + 1e-9)), "gain {gain}, mode {j}");
        }
        lower = higher;
    }
    let clamped = frequencies(&robot, &rest, WinchMode::Clamped, 9.0);
    let stuck = frequencies(&robot, &rest, WinchMode::Stuck, 9.0);
    assert!(stuck.len() <= clamped.len() && clamped.len() < free.len());
    assert!(stuck.iter().zip(&clamped).all(|(stuck, clamped)| *stuck >= clamped * (1.0 - 1e-9)));

    let (_, found) = list(&robot, &rest, WinchMode::AsGiven, 9.0);
    for mode in &found.modes {
        let parts = [&mode.cable_energy_fractions, &mode.drive_energy_fractions];
        let sum = mode.platform_energy_fraction + parts.iter().flat_map(|part| part.iter()).sum::<f64>();
        assert!((sum - 1.0).abs() < 1e-9, "{} Hz: {sum}", mode.frequency_hz);
    }
    assert!(found.modes.iter().any(|mode| mode.kind == Kind::Drive));
}

/// Every damped mode of a servo is found and counted; a commanded length begins at the derivative of statics.
#[test]
fn damped_modes_and_signals_of_drives_exist() {
    let (robot, rest) = driven(servo(6e4, 2500.0));
    let (dynamics, found) = list(&robot, &rest, WinchMode::AsGiven, 8.0);
    let damped = modes::damped::damped_modes(&dynamics, &found);
    assert!(damped.certified && damped.modes.len() == found.modes.len());
    assert!(damped.modes.iter().all(|mode| mode.damping_ratio() > 0.0));

    let along = Signal::Along { direction_w: Vec3::z(), point_p: Vec3::zeros() };
    let drive = |signal| Signal::Drive { cable: 3, signal };
    let ports = [along, drive(DriveSignal::Motor), drive(DriveSignal::Length), drive(DriveSignal::Tension)];
    let ports = Port::all(&robot, &rest, &dynamics, &ports, false).unwrap();
    let response = |hz: f64, from: usize, to: usize| {
        response::between(&dynamics, &[hz], &ports[from], &ports[to], Quantity::Displacement).unwrap()[0]
    };
    let (there, back) = (response(2.3, 0, 1), response(2.3, 1, 0));
    assert!((there - back).norm() < 1e-9 * there.norm());

    // At rest: the platform's motion by a length, from the series connection of shallow-static.
    let still = Linearisation { cable_model: CableModel::ShallowStatic, winches: WinchMode::Clamped, ..SHALLOW };
    let still = Dynamics::about(&robot, &rest, still, 5.0).unwrap();
    let state = &rest.cables[3];
    let axes = LocalAxes::of_cable(&robot, 3, state);
    let span = funicular::cable::shallow_static::stiffness(&Sag::of(&robot, 3, state)).in_world(&axes);
    let end = &state.drive.as_ref().unwrap().end;
    let (t, v) = (end.along_w.unwrap(), end.sideways_w.unwrap());
    let w = DMat::from_fn(3, 2, |row, column| [t, v][column][row]);
    // The servo yields like a spring of 6e4 N/m behind the drum side.
    let ea = robot.cables[3].material.axial_stiffness;
    let (lambda, at_drum) = (1.0 + state.tension_anchor / ea, 1.0 + state.tension_drum() / ea);
    let spring = end.force_by_length / lambda;
    let series = 1.0 / (1.0 / spring + (lambda / at_drum).powi(2) / 6e4);
    let [[slip, coupling], [_, swivel]] = end.stiffness;
    let s = DMat::from_row_slice(2, 2, &[slip - spring + series, coupling, coupling, swivel]);
    let inner = (s + w.transpose() * span * &w).try_inverse().unwrap();
    let coupled = span * &w * inner;
    let force: Vec3 = coupled.column(0) * (lambda * series);
    let tangent: Mat3 = span - coupled * w.transpose() * span;
    assert!(still.stiffness(0.1).map(|entry| entry.re).amax() > tangent.amax());

    // The wrench of the command, from which the whole robot follows.
    let moment = state.lever_w.cross(&force);
    let wrench = Vec6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z);
    let stiffness = dynamics.stiffness(1e-4).map(|entry| entry.re);
    let expected = stiffness.lu().solve(&wrench).unwrap()[2];
    let found = response(1e-5, 2, 0).re;
    assert!((found - expected).abs() < 1e-6 * expected.abs(), "{found} {expected}");
}

/// A base that is moved slowly carries the platform along, and a fast one does not.
#[test]
fn the_platform_follows_a_slow_base() {
    for (robot, rest) in robots(servo(6e4, 300.0)) {
        let dynamics = Dynamics::about(&robot, &rest, SHALLOW, 20.0).unwrap();
        let along = Vec3::new(0.2, -0.5, 0.8).normalize();
        let base = Signal::Frame(FrameInput::BaseAlong(along));
        let platform = Signal::Along { direction_w: along, point_p: Vec3::zeros() };
        let ports = Port::all(&robot, &rest, &dynamics, &[base, platform], false).unwrap();
        let found = response::between(&dynamics, &[1e-4, 19.0], &ports[0], &ports[1], Quantity::Displacement).unwrap();
        // The ratio of the squares of the frequency and of the first natural one.
        assert!((found[0] - 1.0).norm() < 1e-6 && found[1].norm() < 0.3, "{found:?}");
    }
}

/// With less mass the shallow span with its drive approaches the catenary-dynamic one: by the square of the sag, and by
/// the axial inertia, which is in proportion to the mass.
#[test]
fn taut_cables_with_drives_are_those_of_the_catenary() {
    let gap = |weight: f64| {
        let (mut robot, _) = driven(servo(6e4, 0.0));
        robot.cables.iter_mut().for_each(|cable| cable.material.mass_per_length = weight);
        let rest = statics::inverse(&robot, &Pose::new([1.0, 2.0, 1.5], [0.0; 3]), StaticModel::Catenary).unwrap();
        let sag =
            rest.cables.iter().enumerate().map(|(i, state)| Sag::of(&robot, i, state).ratio()).fold(0.0, f64::max);
        let below = |cable_model| {
            let dynamics = Dynamics::about(&robot, &rest, Linearisation { cable_model, ..SHALLOW }, 12.0).unwrap();
            modes::below(&dynamics, 12.0).modes.iter().map(|mode| mode.frequency_hz).collect::<Vec<f64>>()
        };
        let (shallow, exact) = (below(CableModel::ShallowDynamic), below(CableModel::CatenaryDynamic));
        let differences = shallow.iter().zip(&exact).map(|(a, b): (&f64, &f64)| (a / b - 1.0).abs());
        (sag, differences.take(2).fold(0.0, f64::max))
    };
    // A quarter of the mass has a quarter of the inertia. The ropes are so light that both lists begin with the same
    // two modes of the platform, below all modes of cables.
    let (coarse, fine) = (gap(0.006), gap(0.0015));
    assert!(fine.0 < 0.5 * coarse.0 && fine.1 < 0.26 * coarse.1 && fine.1 < 2e-4, "{coarse:?} {fine:?}");
}
