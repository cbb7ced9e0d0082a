//! Small second-order model of the robot, `M ẍ + C ẋ + K x = B f`, `y = L x`, for control design.
//!
//! The coordinates are the platform's motion, the amplitudes of the cables' clamped modes and the displacements of
//! flexible supports. They represent catenary-dynamic cables without approximation: K is block diagonal, M couples the
//! platform to each amplitude. The model has two approximations. Three modes of each cable replace all modes above the
//! limit, and viscous damping replaces a constant damping ratio. Both errors are measured against the full model.
//! Derivation: docs/theory.md, section 13.

mod candidates;
mod channels;
mod control_model;
mod error;
mod expansion;
mod massless;
mod matrices;
mod reference;
mod selection;
mod steps;
mod terms;

pub use steps::STEPS;

pub use control_model::{
    ControlModel, ModalStates, PointwiseError, RequestedStateSpace, ResponseOfPair, control_model,
};
pub use error::ReductionError;
pub use selection::StateSpaceSize;

use crate::cable::catenary_dynamic::{DriveSignal, InPowersOfS};
use crate::dynamics::{CableBlocks, DrivePartBlock, Dynamics};
use crate::math::{CDMat, Complex, DMat};
use crate::modes;
use crate::response::{FrameInput, Quantity, Signal};
use crate::robot::Robot;
use crate::statics::Equilibrium;
use channels::Channels;
use expansion::Expansion;
use massless::MasslessSupports;
pub(crate) use matrices::{CoordinateLayout, Matrices};
use std::f64::consts::TAU;
use std::ops::Range;
use steps::Steps;

/// Viscous replacement of constant damping ratios, which no matrix C can represent at every frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DampingAt {
    /// Equation (46) of docs/theory.md: correct at every natural frequency of the model.
    NaturalFrequencies,
    /// `C = 2ξω M_c`: correct at this one frequency [Hz].
    Hz(f64),
}

/// Requirements for a reduced model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RequestedModel {
    /// Highest frequency [Hz].
    pub below_hz: f64,
    /// Maximum relative error of the responses by modes left out.
    pub tolerance: f64,
    /// Treatment of constant damping ratios.
    pub damping_at: DampingAt,
}

/// Meaning of a coordinate of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Coordinate {
    /// Coordinate of the platform's motion about its origin ([m] or [rad]), in the order of
    /// [`coordinate_names`](crate::robot::PlatformMotion::coordinate_names); for a rigid body δp and δθ in world axes.
    Platform(usize),
    /// Amplitude of a clamped mode of a cable with its drive, of unit modal mass [m √kg].
    Clamped {
        /// Index of the cable, in the order of the file.
        cable: usize,
        /// True for a mode out of the cable's plane.
        out_of_plane: bool,
        /// Clamped frequency [Hz]; the last modes of a cable replace all the others.
        frequency_hz: f64,
    },
    /// Displacement of a flexible support along an axis of the world [m], relative to its foot.
    Support {
        /// Index of the support, in the order of [`Robot::supports`].
        support: usize,
        /// Axis: 0, 1 or 2.
        axis: usize,
    },
}

/// Reduced model in second-order form.
#[derive(Debug, Clone, PartialEq)]
pub struct SecondOrder {
    /// Mass matrix M, symmetric positive definite, n×n.
    pub mass: DMat,
    /// Damping matrix C, symmetric positive semidefinite, n×n.
    pub damping: DMat,
    /// Stiffness matrix K, symmetric, n×n.
    pub stiffness: DMat,
    /// Input matrix B, n×inputs: generalised force per unit of each input.
    pub input: DMat,
    /// Matrices B₁ and B₂, n×inputs: generalised force per rate and per acceleration of each input. They are zero
    /// except for a commanded length and a motion of the frame.
    pub input_rates: [DMat; 2],
    /// Output matrix L, outputs×n: displacements, rotations and tensions.
    pub output: DMat,
    /// Matrices L₁ and L₂, outputs×n: outputs per velocity and per acceleration of the coordinates. They are zero
    /// except for the tension of a cable.
    pub output_rates: [DMat; 2],
    /// Matrices D₀, D₁ and D₂, outputs×inputs: outputs per input, its rate and its acceleration with all coordinates at
    /// rest. They are zero except for signals of the drive of one cable, and for outputs on cables by a motion of the
    /// frame.
    pub feedthrough: [DMat; 3],
    /// Quantity of each output: displacement, velocity or acceleration.
    pub quantities: Vec<Quantity>,
    /// Meaning of the n coordinates.
    pub coordinates: Vec<Coordinate>,
    /// Highest frequency for which the model is made [Hz].
    pub below_hz: f64,
    /// Maximum relative error of the natural frequencies below the limit.
    pub frequency_error: f64,
    /// Maximum error of the responses up to the limit by modes left out, at each frequency relative to the largest
    /// entry there. `None` if an undamped robot has no finite response.
    pub truncation_error: Option<f64>,
    /// Maximum error of the responses by the viscous replacement of constant damping ratios, at natural frequencies,
    /// each relative to the largest entry there; zero for viscous damping.
    pub damping_error: Option<f64>,
}

/// State space `ẋ = A x + B f`, `y = C x + D f`, whose state is motion and velocity.
#[derive(Debug, Clone, PartialEq)]
pub struct StateSpace {
    /// Matrix A, 2n×2n.
    pub a: DMat,
    /// Matrix B, 2n×inputs.
    pub b: DMat,
    /// Matrix C, outputs×2n.
    pub c: DMat,
    /// Matrix D, outputs×inputs.
    pub d: DMat,
}

/// Maximum fraction of the static response of a drive's part that may be without mass; rounding leaves 1e-9.
const MASSLESS: f64 = 1e-6;

/// Checks that all cables are catenary-dynamic and that the losses of their drives have a second-order form.
fn check_cables(robot: &Robot, dynamics: &Dynamics) -> Result<(), ReductionError> {
    let name = |cable: usize| robot.cables[cable].name.clone();
    for term in dynamics.terms() {
        let form = term.form().by_poles().ok_or(ReductionError::Model)?;
        if dynamics.linearisation.cable_model.is_shallow() {
            return Err(ReductionError::Model);
        }
        let delay_s = form.delay();
        if delay_s > 0.0 {
            return Err(ReductionError::Delay { cable: name(term.cable()), delay_s });
        }
    }
    for blocks in dynamics.cable_blocks() {
        let is_lossy = |part: &DrivePartBlock| part.damping > 0.0 || part.loss > 0.0;
        if blocks.drive.iter().any(|part| is_lossy(part) && part.massless > MASSLESS) {
            let (cable, is_at_rest) = (name(blocks.cable), dynamics.is_at_rest(blocks.cable));
            return Err(if is_at_rest {
                ReductionError::StretchAtRest { cable }
            } else {
                ReductionError::Massless { cable }
            });
        }
    }
    Ok(())
}

/// Frequencies, over the limit, up to which clamped modes are kept unchanged. They are tried in turn until the error is
/// small enough.
const KEPT: [f64; 7] = [1.1, 1.5, 2.0, 3.0, 5.0, 8.0, f64::INFINITY];

/// Number of frequencies at which the error of modes left out is measured, in addition to the natural frequencies.
const GRID: usize = 1000;

/// Steps for the responses of the full model, and for the tried numbers of clamped modes; the rest are for the error of
/// damping.
const FULL: Range<usize> = 0..10;
const TRIED: Range<usize> = 10..60;

/// Reduced model of a robot linearised about an equilibrium.
///
/// `report` gets the number of finished steps of [`STEPS`] during the work, and stops it by returning `false`.
///
/// # Errors
/// [`ReductionError`].
///
/// # References
/// R. R. Craig, M. C. C. Bampton, AIAA Journal 6(7), 1968; docs/theory.md, section 13.
pub fn reduce(
    robot: &Robot,
    equilibrium: &Equilibrium,
    dynamics: &Dynamics,
    inputs: &[Signal],
    outputs: &[(Signal, Quantity)],
    requested: RequestedModel,
    report: &mut dyn FnMut(usize) -> bool,
) -> Result<SecondOrder, ReductionError> {
    let mut steps = Steps::new(report);
    check_cables(robot, dynamics)?;

    // The response of a cable to a force on itself has a kink, which the kept modes cannot represent.
    let loaded = inputs.iter().any(|signal| matches!(signal, Signal::OnCable { .. }));
    let full = Channels::new(robot, equilibrium, dynamics, inputs, outputs, loaded)?;

    // Natural frequencies and responses of the full model, for comparison.
    let listed = modes::below(dynamics, requested.below_hz);
    steps.reached(&FULL, 1, 2)?;
    let natural: Vec<f64> = listed.modes.iter().map(|mode| mode.frequency_hz).collect();
    let mut frequencies: Vec<f64> =
        (1..=GRID).map(|i| requested.below_hz * i as f64 / GRID as f64).chain(natural.iter().copied()).collect();
    frequencies.sort_by(f64::total_cmp);
    let reference = full.responses(dynamics, &frequencies).ok();

    // As few clamped modes as the tolerance allows.
    let ends = full.at_far_ends(dynamics);
    let kinds = pair_kinds(inputs, outputs);
    for (tried, ratio) in KEPT.into_iter().enumerate() {
        steps.reached(&TRIED, tried, KEPT.len())?;
        let cut = dynamics.with_poles_below(ratio * requested.below_hz * TAU, &ends);
        let truncation_error = reference.as_ref().and_then(|reference| {
            let of_cut = Channels::new(robot, equilibrium, &cut, inputs, outputs, false).ok()?;
            Some(largest_difference(reference, &of_cut.responses(&cut, &frequencies).ok()?, &kinds))
        });

        let reduced = modes::below(&cut, requested.below_hz * (1.0 + 1e-9));
        let frequency_error = relative_error(&natural, &reduced.modes);

        if truncation_error.unwrap_or(frequency_error) <= requested.tolerance || ratio.is_infinite() {
            let channels = Channels::new(robot, equilibrium, &cut, inputs, outputs, false)?;
            let mut model = assembled(&cut, &channels, outputs, requested)?;
            steps.reached(&TRIED, KEPT.len(), KEPT.len())?;
            (model.frequency_error, model.truncation_error) = (frequency_error, truncation_error);
            model.damping_error = match requested.damping_at {
                _ if !cut.has_damping_ratios() => Some(0.0),
                _ => damping_error(&model, &cut, &channels, &kinds, &natural, &mut steps)?,
            };
            return Ok(model);
        }
    }
    unreachable!("the last ratio keeps all modes")
}

/// Maximum relative difference of frequencies; infinite if their numbers differ by more than one.
fn relative_error(natural: &[f64], others: &[modes::Mode]) -> f64 {
    // A frequency at the limit may lie on different sides of it.
    if others.len().abs_diff(natural.len()) > 1 {
        return f64::INFINITY;
    }
    natural.iter().zip(others).map(|(a, b)| (b.frequency_hz / a - 1.0).abs()).fold(0.0, f64::max)
}

/// Kind of each response, the pairs of the first output with all inputs first. Responses of one kind have comparable
/// sizes: motion or tension, per force, per commanded length or displacement of the frame, or per rotation of the base.
fn pair_kinds(inputs: &[Signal], outputs: &[(Signal, Quantity)]) -> Vec<usize> {
    let of_input = |signal: &Signal| match signal {
        Signal::Drive { signal: DriveSignal::Length, .. }
        | Signal::Frame(FrameInput::BaseAlong(_) | FrameInput::Anchor { .. }) => 1,
        Signal::Frame(FrameInput::BaseAbout(_)) => 2,
        Signal::Drive { .. } | Signal::Along { .. } | Signal::About { .. } | Signal::OnCable { .. } => 0,
    };
    let is_tension = |signal: &Signal| matches!(signal, Signal::Drive { signal, .. } if signal.is_tension());
    let kind = |input: &Signal, output: &Signal| 3 * usize::from(is_tension(output)) + of_input(input);
    outputs.iter().flat_map(|(output, _)| inputs.iter().map(move |input| kind(input, output))).collect()
}

/// Maximum difference of the responses over all frequencies, at each frequency relative to the largest entry of its
/// kind there.
fn largest_difference(reference: &[Vec<Complex>], others: &[Vec<Complex>], kinds: &[usize]) -> f64 {
    let count = reference.first().map_or(0, Vec::len);
    let of_kind = |kind: usize, k: usize| {
        let pairs = || reference.iter().zip(others).zip(kinds).filter(|(_, of)| **of == kind).map(|(pair, _)| pair);
        let size = pairs().map(|(entry, _)| entry[k].norm()).fold(0.0, f64::max);
        let gap = pairs().map(|(a, b)| (a[k] - b[k]).norm()).fold(0.0, f64::max);
        if size > 0.0 { gap / size } else { 0.0 }
    };
    let last = kinds.iter().copied().max().unwrap_or(0);
    (0..count).flat_map(|k| (0..=last).map(move |kind| (kind, k))).map(|(kind, k)| of_kind(kind, k)).fold(0.0, f64::max)
}

/// Matrices of a linearised robot whose cables have only the poles to be kept, the order of all coordinates, and the
/// supports without mass, which the matrices do not contain.
fn matrices(dynamics: &Dynamics) -> (CoordinateLayout, Matrices, Option<MasslessSupports>) {
    let cables: Vec<CableBlocks> = dynamics.cable_blocks().collect();
    let supports = dynamics.support_blocks();
    let layout =
        CoordinateLayout::new(dynamics.dof(), &cables, supports.as_ref().map_or(0, |blocks| blocks.mass.nrows()));

    let mut matrices = Matrices::of_platform(&dynamics.platform_blocks(), layout.coordinates.len());
    if let Some(supports) = &supports {
        matrices.add_supports(supports, &layout);
    }
    for (term, cable) in cables.iter().enumerate() {
        matrices.add_cable(cable, term, &layout);
    }
    let massless = MasslessSupports::of(&matrices, &layout);
    let matrices = match &massless {
        Some(massless) => massless.reduced(matrices),
        None => matrices,
    };
    (layout, matrices, massless)
}

/// Reduced model from a linearised robot whose cables have only the poles to be kept.
fn assembled(
    dynamics: &Dynamics,
    channels: &Channels,
    measured: &[(Signal, Quantity)],
    requested: RequestedModel,
) -> Result<SecondOrder, ReductionError> {
    let (mut layout, mut matrices, massless) = matrices(dynamics);
    if dynamics.has_damping_ratios() {
        matrices.damping = matrices.all_damping(requested.damping_at)?;
    }

    let mut inputs = Channels::rows(&channels.inputs, dynamics, &layout);
    let mut outputs = Channels::rows(&channels.outputs, dynamics, &layout);
    let mut feedthrough = channels.direct(dynamics);
    if let Some(massless) = &massless {
        let added = massless.direct(&outputs, &inputs);
        feedthrough.iter_mut().zip(added).for_each(|(sum, added)| *sum += added);
        (inputs, outputs) = (massless.rows(inputs), massless.rows(outputs));
        layout.coordinates = massless.kept(&layout.coordinates);
    }
    let [input, input_rate, input_acceleration] = inputs.map(|rows| rows.transpose());
    let [output, output_rate, output_acceleration] = outputs;

    let Matrices { mass, damping, stiffness, .. } = matrices;
    if mass.clone().cholesky().is_none() {
        return Err(ReductionError::Mass);
    }
    Ok(SecondOrder {
        mass,
        damping,
        stiffness,
        input,
        input_rates: [input_rate, input_acceleration],
        output,
        output_rates: [output_rate, output_acceleration],
        feedthrough,
        quantities: measured.iter().map(|(_, quantity)| *quantity).collect(),
        coordinates: layout.coordinates,
        below_hz: requested.below_hz,
        frequency_error: 0.0,
        truncation_error: None,
        damping_error: None,
    })
}

/// Maximum relative error of the responses by the viscous replacement of constant ratios, at natural frequencies.
fn damping_error(
    model: &SecondOrder,
    dynamics: &Dynamics,
    channels: &Channels,
    kinds: &[usize],
    natural: &[f64],
    steps: &mut Steps<'_>,
) -> Result<Option<f64>, ReductionError> {
    // Maximum number of frequencies, spread over all natural frequencies, where the effect of damping is largest. Each
    // needs a full elimination.
    const MAX_FREQUENCIES: f64 = 48.0;
    // Maximum number of operations of all eliminations.
    const MAX_OPERATIONS: f64 = 2e9;
    let max = (MAX_OPERATIONS / (model.mass.nrows() as f64).powi(3)).clamp(4.0, MAX_FREQUENCIES) as usize;
    let every = natural.len().div_ceil(max).max(1);
    let frequencies: Vec<f64> = natural.iter().copied().step_by(every).collect();
    let Ok(reference) = channels.responses(dynamics, &frequencies) else { return Ok(None) };

    // Responses of the reduced model at these frequencies.
    let mut of_model = vec![Vec::new(); reference.len()];
    for (done, frequency_hz) in frequencies.iter().enumerate() {
        steps.reached(&(TRIED.end..STEPS), done, frequencies.len())?;
        let Some(receptance) = model.receptance(frequency_hz * TAU) else { return Ok(None) };
        let entries = (0..receptance.nrows()).flat_map(|i| (0..receptance.ncols()).map(move |j| (i, j)));
        for (list, at) in of_model.iter_mut().zip(entries) {
            list.push(receptance[at]);
        }
    }
    Ok(Some(largest_difference(&reference, &of_model, kinds)))
}

impl SecondOrder {
    /// Inputs in powers of s: B, B₁ and B₂.
    pub(crate) fn inputs(&self) -> InPowersOfS<&DMat> {
        [&self.input, &self.input_rates[0], &self.input_rates[1]]
    }

    /// Outputs in powers of s: L, L₁ and L₂.
    pub(crate) fn outputs(&self) -> InPowersOfS<&DMat> {
        [&self.output, &self.output_rates[0], &self.output_rates[1]]
    }

    /// Response `L (K + iωC − ω²M)⁻¹ B` of displacements at ω [rad/s], with B, L and the feedthrough as polynomials of
    /// iω; `None` at an undamped resonance.
    pub fn receptance(&self, omega: f64) -> Option<CDMat> {
        let d = self
            .stiffness
            .zip_zip_map(&self.damping, &self.mass, |k, c, m| Complex::new(k - omega * omega * m, omega * c));
        let s = Complex::new(0.0, omega);
        let [direct, by_rate, by_acceleration] = &self.feedthrough;
        let solved = d.lu().solve(&polynomial(&self.inputs(), s))?;
        Some(polynomial(&self.outputs(), s) * solved + polynomial(&[direct, by_rate, by_acceleration], s))
    }

    /// State space of the model, with outputs of displacement, velocity or acceleration as in
    /// [`quantities`](Self::quantities). With inputs that act by their rates the first states are the coordinates
    /// without the part that follows the input at once.
    ///
    /// # Errors
    /// [`ReductionError::Improper`] if an output contains the rate of an input, such as the acceleration of the
    /// platform by the commanded length of a motor with a speed gain.
    pub fn state_space(&self) -> Result<StateSpace, ReductionError> {
        let expansion = Expansion::of(self);
        if let Some((output, input)) = expansion.improper() {
            return Err(ReductionError::Improper { output: output + 1, input: input + 1 });
        }
        let Expansion { a, b, c, direct, .. } = expansion;
        let d = direct.into_iter().next().unwrap_or_else(|| DMat::zeros(c.nrows(), b.ncols()));
        Ok(StateSpace { a, b, c, d })
    }
}

/// Value of a polynomial with matrix coefficients at s.
fn polynomial(coefficients: &InPowersOfS<&DMat>, s: Complex) -> CDMat {
    let [constant, by_rate, by_acceleration] = coefficients;
    constant.zip_zip_map(by_rate, by_acceleration, |c, r, a| c + s * r + s * s * a)
}
