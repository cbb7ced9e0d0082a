//! Vibration of cables and robots whose drives have inertia and control.

use super::reference::{CableToWinch, DriveParts, DrivenCable, DrivenRobot, Drives, ServoDamped};
use super::section::WRONG;
use super::{Bound, Case, Comparison, Declared, Level, NegativeControl, drives, reference, slug};
use anyhow::{Result, anyhow};
use funicular::cable::catenary_dynamic::DriveSignal;
use funicular::cable::{CableModel, EndStiffness};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Complex, Mat3, Vec3};
use funicular::modes;
use funicular::response::{self, FrameInput, Port, Quantity, Signal};
use funicular::robot::{Cable, Control, Damping, DrumSide, Robot, Servo, State, WinchMode};
use funicular::statics::{self, CableState, Equilibrium, StaticModel};
use std::f64::consts::TAU;

pub(super) const SECTION: Declared = Declared {
    id: "drives",
    title: "Pulleys and winches",
    note: "Straight cables over swivelling pulleys against the closed forms of other programs; sagging elastic \
           cables over pulleys, whose weight begins at the entry point; cables to winches that yield; robots with \
           pulleys and winches. The stiffness with a tilted swivel axis is exact to the square of the kink, \
           theory (69). Friction of pulleys: equilibria after given last motions of the cables, solved without \
           linearisation, and the first-order half widths of theory (74).",
    rows: || {
        let of = reference::drives()?;
        Ok([drives::rows(&of)?, comparisons(&of)?].concat())
    },
    controls: &[
        NegativeControl {
            id: "radius",
            wrong: "radius of every pulley 1 % too large",
            proves: "the arc on the pulley",
            rows: || {
                drives::of_changed(|of| {
                    of.straight.rows.iter_mut().for_each(|row| row.radius_m *= WRONG);
                    of.sagging.rows.iter_mut().for_each(|row| row.radius_m *= WRONG);
                    of.cables.rows.iter_mut().for_each(|row| row.radius_m *= WRONG);
                })
            },
        },
        NegativeControl {
            id: "drum-side",
            wrong: "length of the rope between pulley and drum 1 % too large",
            proves: "the stretch of the drum side",
            rows: || drives::of_changed(|of| of.cables.rows.iter_mut().for_each(|row| row.drum_side_length_m *= WRONG)),
        },
        NegativeControl {
            id: "winch-stiffness",
            wrong: "stiffness of every winch 1 % too small",
            proves: "the yielding of the winch",
            rows: || {
                drives::of_changed(|of| {
                    let all = of.cables.rows.iter_mut().filter_map(|row| row.winch_stiffness_n_per_m.as_mut());
                    all.for_each(|stiffness| *stiffness /= WRONG);
                })
            },
        },
        NegativeControl {
            id: "friction",
            wrong: "coefficient of friction of the pulleys 1 % too large",
            proves: "the change of the tension over a pulley",
            rows: || {
                let mut of = reference::drives()?;
                drives::only_friction(&mut of);
                of.friction_corners.rows.iter_mut().for_each(|row| row.friction_coefficient *= WRONG);
                drives::rows(&of)
            },
        },
        NegativeControl {
            id: "motor",
            wrong: "mass of every motor at the cable 1 % too large",
            proves: "the inertia of the drive",
            rows: || of_vibration(|parts| parts.motor_mass_kg *= WRONG),
        },
        NegativeControl {
            id: "wheel",
            wrong: "inertia of every wheel 1 % too large",
            proves: "the inertia of the pulleys",
            rows: || of_vibration(|parts| parts.wheel_inertia_kg_m2 *= WRONG),
        },
        NegativeControl {
            id: "gain",
            wrong: "position gain of every servo 1 % too large",
            proves: "the control of the motors",
            rows: || of_vibration(|parts| parts.position_gain_n_per_m *= WRONG),
        },
    ],
};

/// Frequency beyond the last listed one, relative: the list ends between two of them.
const BEYOND: f64 = 1e-6;

/// Relative error of frequencies: 12 printed digits, and the error of the discretisation that is accepted.
const FREQUENCIES: f64 = 1e-9;

/// Relative error of the lowest frequencies with motors at constant torque. Their stiffness is that of the weight, a
/// hundred thousandth of the stiffness of the cables, whose rounding it has.
const AT_CONSTANT_TORQUE: f64 = 1e-8;

/// Relative error of the forces by a motion of an anchor whose drum stays on the ground. The formula of the reference
/// measures the elongation of the drum side with the stretch at the exit point also at the entry point, where it
/// differs by up to 1e-7: the reference's own second method differs from it by 5e-8 to 4e-7 there, and by 1e-10 in all
/// else.
const AT_MOVING_ANCHOR: f64 = 1.5e-7;

fn comparisons(of: &Drives) -> Result<Vec<Comparison>> {
    let mut rows = Vec::new();
    for row in &of.moving_cables.rows {
        let at_rest = of.cables.rows.iter().find(|cable| cable.case == row.case);
        let at_rest = at_rest.ok_or_else(|| anyhow!("no cable \"{}\"", row.case))?;
        rows.extend(cable(row, at_rest, &of.moving_cables.source)?);
    }
    for row in &of.vibration.rows {
        let at_rest = of.robots.rows.iter().find(|robot| robot.case == row.case);
        let robot = drives::robot_of(at_rest.ok_or_else(|| anyhow!("no robot \"{}\"", row.case))?)?;
        rows.extend(driven(row, robot, &of.vibration.source)?);
    }
    Ok(rows)
}

/// Comparisons of the vibration of cables with a change of their drives.
fn of_vibration(change: fn(&mut DriveParts)) -> Result<Vec<Comparison>> {
    let mut of = reference::drives()?;
    of.vibration.rows.clear();
    of.moving_cables.rows.iter_mut().for_each(|row| change(&mut row.parts));
    comparisons(&of)
}

/// Control of a motor, integral action included.
fn control(parts: &DriveParts) -> Control {
    let DriveParts { position_gain_n_per_m: position_gain, speed_gain_n_s_per_m: speed_gain, .. } = *parts;
    match parts.control.as_str() {
        "position" => Control::Position(Servo { position_gain, speed_gain, integral: true, delay: 0.0 }),
        "torque" => Control::Torque,
        _ => Control::Ideal,
    }
}

/// Gives all cables of a robot the inertia and the control of a case.
fn equip(robot: &mut Robot, parts: &DriveParts) {
    for cable in &mut robot.cables {
        cable.material.damping = Damping::Ratio(parts.cable_damping_ratio);
        if let Some(pulley) = &mut cable.anchor.pulley {
            (pulley.inertia, pulley.swivel_inertia) = (parts.wheel_inertia_kg_m2, parts.swivel_inertia_kg_m2);
        }
        if let Some(winch) = &mut cable.anchor.winch {
            (winch.drum_mass, winch.motor_mass) = (parts.drum_mass_kg, parts.motor_mass_kg);
            winch.control = control(parts);
        }
    }
}

/// Comparisons of one robot whose drives move.
/// Weight on wheels that turn with the base, at most this part of the tensions that turn: the reference leaves it out,
/// theory (83a).
fn weight_on_wheels(robot: &Robot, rest: &Equilibrium) -> f64 {
    let on_wheel = |(cable, state): (&Cable, &CableState)| {
        let radius = cable.anchor.pulley.as_ref().map_or(0.0, |pulley| pulley.radius);
        2.0 * radius * cable.material.mass_per_length * robot.gravity_w.norm() / state.tension_anchor
    };
    robot.cables.iter().zip(&rest.cables).map(on_wheel).fold(0.0, f64::max)
}

fn driven(row: &DrivenRobot, mut robot: Robot, source: &str) -> Result<Vec<Comparison>> {
    equip(&mut robot, &row.parts);
    let State::Lengths(lengths) = &robot.state else { return Err(anyhow!("the lengths are given")) };
    let rest = statics::forward(&robot, lengths, StaticModel::Catenary, None)?;

    // All natural frequencies.
    let below_hz = row.frequencies_hz.iter().copied().fold(0.0, f64::max) * (1.0 + BEYOND);
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), below_hz)?;
    let found = modes::below(&dynamics, below_hz);
    let frequencies: Vec<f64> = found.modes.iter().map(|mode| mode.frequency_hz).collect();
    let certified = if found.certified { frequencies.len() } else { 0 };
    let id = format!("moving-robot/{}", slug(&row.case));
    let case = Case::new(Level::Program, source, &id, &format!("{}, moving drives", row.case));
    let torque = control(&row.parts) == Control::Torque;
    let tolerance = if torque { AT_CONSTANT_TORQUE } else { FREQUENCIES };
    let quantity = case.of("frequencies", "frequencies [Hz]");
    let mut rows = vec![
        case.of("count", "certified frequencies").count(row.frequencies_hz.len(), certified),
        quantity.relative(&row.frequencies_hz, &frequencies, tolerance, Bound::Rounding),
    ];

    // Responses of the platform to all commanded lengths, or to the forces of all motors.
    let signal = if torque { DriveSignal::Motor } else { DriveSignal::Length };
    let inputs: Vec<Signal> = (0..robot.cables.len()).map(|cable| Signal::Drive { cable, signal }).collect();
    let along = |direction_w: Vec3| Signal::Along { direction_w, point_p: Vec3::zeros() };
    let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
    let motions: Vec<Signal> = axes.map(along).into_iter().chain(axes.map(|axis_w| Signal::About { axis_w })).collect();
    let inputs = Port::all(&robot, &rest, &dynamics, &inputs, false)?;
    let outputs: Vec<(Port, Quantity)> = Port::all(&robot, &rest, &dynamics, &motions, false)?
        .into_iter()
        .map(|port| (port, Quantity::Displacement))
        .collect();
    let what =
        if torque { ("motor", "motion per force of a motor") } else { ("length", "motion per commanded length") };
    let base = axes.map(FrameInput::BaseAlong).into_iter().chain(axes.map(FrameInput::BaseAbout));
    let base: Vec<Signal> = base.map(Signal::Frame).collect();
    let base = Port::all(&robot, &rest, &dynamics, &base, false)?;
    let exact = (AT_CONSTANT_TORQUE, Bound::Rounding);
    let turned = (weight_on_wheels(&robot, &rest), Bound::Model("weight on turned wheels"));
    for ((id, what), inputs, columns, responses, (tolerance, bound)) in [
        (what, &inputs, 0..inputs.len(), &row.responses, exact),
        (("base-along", "motion per translation of the base"), &base, 0..3, &row.base, exact),
        (("base-about", "motion per rotation of the base"), &base, 3..6, &row.base, turned),
    ] {
        for theirs in responses {
            let found = response::matrix(&dynamics, &[theirs.frequency_hz], inputs, &outputs)?;
            let (mut ours, mut expected) = (Vec::new(), Vec::new());
            for (output, (re, im)) in theirs.re.iter().zip(&theirs.im).enumerate() {
                for input in columns.clone() {
                    let value = found[output * inputs.len() + input][0];
                    ours.extend([value.re, value.im]);
                    expected.extend([re[input], im[input]]);
                }
            }
            let hz = theirs.frequency_hz;
            let (id, quantity) = (format!("{id}-{hz}hz"), format!("{what} at {hz} Hz"));
            rows.push(case.of(&id, &quantity).together(&expected, &ours, tolerance, bound));
        }
    }

    if let Some(damped) = &row.servo_damped {
        rows.extend(servo_damped(damped, robot, &rest, &case)?);
    }
    Ok(rows)
}

/// Damped modes with cables without damping.
fn servo_damped(theirs: &ServoDamped, mut robot: Robot, rest: &Equilibrium, case: &Case) -> Result<Vec<Comparison>> {
    for cable in &mut robot.cables {
        cable.material.damping = Damping::Ratio(0.0);
    }
    let dynamics = Dynamics::about(&robot, rest, Linearisation::default(), theirs.below_hz)?;
    let undamped = modes::below(&dynamics, theirs.below_hz);
    let damped = modes::damped::damped_modes(&dynamics, &undamped);

    // The order of strongly damped modes is that of neither list: each is compared with the nearest.
    let ours: Vec<Complex> = damped.modes.iter().map(|mode| mode.omega / TAU).collect();
    let zero = |(hz, ratio): (&f64, &f64)| hz * Complex::new((1.0 - ratio * ratio).sqrt(), *ratio);
    let zeros: Vec<Complex> = theirs.frequency_hz.iter().zip(&theirs.damping_ratio).map(zero).collect();
    let nearest = |theirs: &Complex| {
        ours.iter().copied().min_by(|a, b| (a - theirs).norm().total_cmp(&(b - theirs).norm())).unwrap_or_default()
    };
    let pairs: Vec<(Complex, Complex)> = zeros.iter().map(|theirs| (*theirs, nearest(theirs))).collect();
    let flat = |numbers: Vec<Complex>| numbers.iter().flat_map(|z| [z.re, z.im]).collect::<Vec<f64>>();
    let (theirs, ours_matched) = (pairs.iter().map(|pair| pair.0).collect(), pairs.iter().map(|pair| pair.1).collect());
    let certified = if damped.certified { damped.modes.len() } else { 0 };
    Ok(vec![
        case.of("damped-count", "certified damped frequencies").count(zeros.len(), certified),
        case.of("damped", "damped frequencies, real and imaginary [Hz]").together(
            &flat(theirs),
            &flat(ours_matched),
            FREQUENCIES,
            Bound::Digits("12 printed digits"),
        ),
    ])
}

/// Comparisons of one cable whose drive moves.
fn cable(row: &DrivenCable, at_rest: &CableToWinch, source: &str) -> Result<Vec<Comparison>> {
    // A point mass in equilibrium at the platform's point: its load balances the cable.
    let mut robot = drives::to_winch_robot(at_rest)?;
    robot.load.force_w = -Vec3::from(at_rest.force_on_platform_n) - robot.gravity_w * robot.platform.mass;
    equip(&mut robot, &row.parts);
    if let (true, Some(winch)) = (row.drum_side == "rod", &mut robot.cables[0].anchor.winch) {
        winch.drum_side = DrumSide::Rod;
    }
    let rest = statics::forward(&robot, &[at_rest.unstrained_length_m], StaticModel::Catenary, None)?;

    // Frequencies with the platform end held.
    let limit = row.clamped_frequencies_hz.iter().copied().fold(0.0, f64::max) * (1.0 + BEYOND);
    let model = CableModel::CatenaryDynamic;
    let found = EndStiffness::new(&robot, 0, &rest.cables[0], model, false, WinchMode::AsGiven, limit)?;
    let EndStiffness::Dynamic(found) = found else { return Err(anyhow!("the cable has mass")) };
    let clamped: Vec<f64> = found.clamped_frequencies_below(limit * TAU).iter().map(|omega| omega / TAU).collect();
    let id = format!("moving-cable/{}", slug(&row.case));
    let case = Case::new(Level::Program, source, &id, &format!("{}, moving drive", row.case));
    let point = rest.pose.position_w;
    let digits = Bound::Digits("12 printed digits");
    let clamped_hz = case.of("clamped", "clamped frequencies [Hz]");
    let mut rows = vec![
        // The force is printed with 12 digits, and the stiffness across a taut cable is small.
        case.of("point", "platform point [m]").absolute(&at_rest.platform_point_m, point.as_slice(), 1e-9, digits),
        case.of("clamped-count", "clamped frequencies").count(row.clamped_frequencies_hz.len(), clamped.len()),
        clamped_hz.relative(&row.clamped_frequencies_hz, &clamped, FREQUENCIES, Bound::Rounding),
    ];

    // Dynamic stiffness, and forces by the inputs.
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), limit)?;
    let by_inputs = HeldPlatform::new(&robot, &rest, &dynamics)?;
    for theirs in &row.dynamic {
        let hz = theirs.frequency_hz;
        let at = format!("at {hz} Hz");
        let k = found.damped(hz * TAU);
        let (re, im) = (k.map(|z| z.re).in_world(found.axes()), k.map(|z| z.im).in_world(found.axes()));
        let theirs_k = by_columns(&theirs.stiffness_re, &theirs.stiffness_im);
        let ours_k = joined(re.as_slice(), im.as_slice());
        let (id, quantity) = (format!("stiffness-{hz}hz"), format!("stiffness {at} [N/m]"));
        rows.push(case.of(&id, &quantity).together(&theirs_k, &ours_k, AT_CONSTANT_TORQUE, digits));

        let forces = by_inputs.forces(hz)?;
        let by_base = theirs.base_re.as_ref().zip(theirs.base_im.as_ref());
        let by_base = by_base.map(|(re, im)| {
            (("base", "motion of anchor and drum"), by_columns(re, im), parts(&forces[4..7]), AT_CONSTANT_TORQUE)
        });
        let by_length = joined(&theirs.length_re, &theirs.length_im);
        let by_anchor = by_columns(&theirs.anchor_re, &theirs.anchor_im);
        for ((id, what), theirs, ours, tolerance) in [
            (("length", "length"), by_length, parts(&forces[0..1]), AT_CONSTANT_TORQUE),
            (("anchor", "motion of the anchor"), by_anchor, parts(&forces[1..4]), AT_MOVING_ANCHOR),
        ]
        .into_iter()
        .chain(by_base)
        {
            let (id, quantity) = (format!("{id}-{hz}hz"), format!("force per {what} {at} [N/m]"));
            rows.push(case.of(&id, &quantity).together(&theirs, &ours, tolerance, digits));
        }
    }
    Ok(rows)
}

/// Real parts, then imaginary parts.
fn joined(re: &[f64], im: &[f64]) -> Vec<f64> {
    re.iter().chain(im).copied().collect()
}

/// Entries of a complex matrix by columns: all real parts, then all imaginary parts.
fn by_columns(re: &[[f64; 3]; 3], im: &[[f64; 3]; 3]) -> Vec<f64> {
    let columns = |rows: &[[f64; 3]; 3]| Mat3::from_fn(|i, j| rows[i][j]);
    joined(columns(re).as_slice(), columns(im).as_slice())
}

/// Components of complex forces: all real parts, then all imaginary parts.
fn parts(forces: &[[Complex; 3]]) -> Vec<f64> {
    let all = || forces.iter().flatten();
    all().map(|f| f.re).chain(all().map(|f| f.im)).collect()
}

/// Point mass on one cable, which the forces by the inputs of its drive would hold in place.
struct HeldPlatform<'a> {
    dynamics: &'a Dynamics,
    /// Mass of the platform [kg].
    mass: f64,
    /// Commanded length, motions of the anchor along x, y, z, and motions of anchor and drum along x, y, z.
    inputs: Vec<Port>,
    /// Displacements of the platform along x, y, z.
    outputs: Vec<(Port, Quantity)>,
}

impl<'a> HeldPlatform<'a> {
    fn new(robot: &Robot, rest: &Equilibrium, dynamics: &'a Dynamics) -> Result<Self> {
        let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
        let length = Signal::Drive { cable: 0, signal: DriveSignal::Length };
        let anchor = axes.map(|direction_w| Signal::Frame(FrameInput::Anchor { cable: 0, direction_w }));
        let base = axes.map(|direction_w| Signal::Frame(FrameInput::BaseAlong(direction_w)));
        let inputs: Vec<Signal> = [length].into_iter().chain(anchor).chain(base).collect();
        let outputs = axes.map(|direction_w| Signal::Along { direction_w, point_p: Vec3::zeros() });

        let inputs = Port::all(robot, rest, dynamics, &inputs, false)?;
        let outputs = Port::all(robot, rest, dynamics, &outputs, false)?;
        let outputs = outputs.into_iter().map(|port| (port, Quantity::Displacement)).collect();
        Ok(Self { dynamics, mass: robot.platform.mass, inputs, outputs })
    }

    /// Force on the held platform per unit of each input at a frequency [Hz]: D x, without the part of D that moves the
    /// mass.
    fn forces(&self, frequency_hz: f64) -> Result<Vec<[Complex; 3]>> {
        let omega = frequency_hz * TAU;
        let x = response::matrix(self.dynamics, &[frequency_hz], &self.inputs, &self.outputs)?;
        let d = self.dynamics.stiffness(omega);
        let force = |input: usize, i: usize| -> Complex {
            let x = |j: usize| x[j * self.inputs.len() + input][0];
            (0..3).map(|j| d[(i, j)] * x(j)).sum::<Complex>() - omega * omega * self.mass * x(i)
        };
        Ok((0..self.inputs.len()).map(|input| std::array::from_fn(|i| force(input, i))).collect())
    }
}
