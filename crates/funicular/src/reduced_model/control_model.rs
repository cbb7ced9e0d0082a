//! State space of few states for controllers: the modes that inputs and outputs see, chosen by the error that is left.
//!
//! Lightly damped modes are nearly the balanced coordinates of the robot, so that a choice of modes is as short as a
//! balanced truncation. It knows the frequency limit and the size of every pair of input and output, which Hankel
//! singular values do not. Modes left out keep their static displacement as feedthrough. Every error is measured
//! against the full model. Derivation: docs/theory.md, section 13.

use super::candidates::{DampedPair, MULTIPLE, ModalModel, joined};
use super::expansion::Expansion;
use super::reference::{Maximum, ReferenceResponses};
use super::selection::{RemainingDifference, StateSpaceSize, chosen};
use super::steps::{STEPS, Steps};
use super::terms::{RealBlock, Term, terms};
use super::{
    Channels, KEPT, Quantity, ReductionError, RequestedModel, SecondOrder, StateSpace, assembled, check_cables,
    matrices,
};
use crate::dynamics::Dynamics;
use crate::math::{Complex, DMat};
use crate::modes::{self, Kind, Mode};
use crate::reduced_model::DampingAt;
use crate::response::Signal;
use crate::robot::Robot;
use crate::statics::Equilibrium;
use std::f64::consts::TAU;
use std::ops::Range;

/// Requirements for a state space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RequestedStateSpace {
    /// Highest frequency [Hz].
    pub below_hz: f64,
    /// Number of states, or the error.
    pub size: StateSpaceSize,
    /// Treatment of constant damping ratios.
    pub damping_at: DampingAt,
}

/// States of one mode.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalStates {
    /// Index of the first state.
    pub first: usize,
    /// Number of states: 2, or 1 for a decay without oscillation.
    pub states: usize,
    /// Natural frequency |λ|/2π [Hz].
    pub frequency_hz: f64,
    /// Damping ratio −Re λ/|λ|.
    pub damping_ratio: f64,
    /// Kind of the mode; `None` for a motion that replaces modes above the limit.
    pub kind: Option<Kind>,
    /// Fraction of the kinetic energy that the platform has.
    pub platform_energy_fraction: f64,
    /// Maximum part of the mode in a response, relative to the peak of that response.
    pub contribution: f64,
}

/// Error of the response of one output to one input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResponseOfPair {
    /// Index of the output.
    pub output: usize,
    /// Index of the input.
    pub input: usize,
    /// Maximum of |G| up to the limit.
    pub peak: f64,
    /// Frequency of the peak [Hz].
    pub peak_hz: f64,
    /// Maximum of |G_r − G| up to the limit, relative to the peak.
    pub error: f64,
    /// Frequency of this maximum [Hz].
    pub error_hz: f64,
    /// False if the response is below a millionth of the responses that input and output have otherwise, as by
    /// symmetry. Its error is then relative to those.
    pub coupled: bool,
}

/// Largest error relative to the response at the same frequency, where this is above a millionth of its peak. It is
/// large beside a zero of the response.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointwiseError {
    /// Index of the output.
    pub output: usize,
    /// Index of the input.
    pub input: usize,
    /// |G_r − G|/|G|.
    pub error: f64,
    /// Frequency [Hz].
    pub frequency_hz: f64,
    /// |G| there, relative to the peak.
    pub response: f64,
}

/// State space of few states, in modal coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlModel {
    /// Matrices; A has one block per mode, `[0, ω; −ω, −2ζω]`.
    pub space: StateSpace,
    /// Meaning of the states, ascending in frequency.
    pub states: Vec<ModalStates>,
    /// Quantity of each output.
    pub quantities: Vec<Quantity>,
    /// Highest frequency for which the model is made [Hz].
    pub below_hz: f64,
    /// Maximum error of a response, relative to its peak.
    pub error: f64,
    /// Part of the error that is left with every mode, because no state space has constant damping ratios. Zero for
    /// viscous ropes.
    pub damping_error: f64,
    /// Peak and error of each pair of output and input.
    pub responses: Vec<ResponseOfPair>,
    /// Largest error relative to the response at the same frequency.
    pub pointwise: PointwiseError,
    /// Number of states of the second-order model from which the modes are chosen.
    pub complete_order: usize,
    /// Number of natural frequencies below the limit.
    pub modes_below: usize,
}

/// Ratios to the limit from which on a few motions replace the modes. The ratio with the smallest model is taken.
const REPLACED_FROM: [f64; 4] = [1.0, 1.25, 1.5, 2.5];
/// Distances of eigenvalues that become one, in half widths of the peak. The distance with the smallest model is taken.
const JOINED: [f64; 2] = [MULTIPLE, 0.3];
/// Error of the second-order model's omitted cable modes, as a fraction of the requested error.
const OMITTED: f64 = 0.1;
/// Maximum requested error for the same purpose. The stated error of damping is as accurate as this model.
const MAX_TOLERANCE: f64 = 1e-3;
/// Maximum number of rounds. Each adds the frequencies of the largest errors to those at which modes are chosen.
const MAX_ROUNDS: usize = 6;

/// Steps for the responses of the full model, the number of clamped modes, the modes of the second-order model and the
/// sets of damped modes; the rest are for the choice.
const FULL: Range<usize> = 0..10;
const TRIED: Range<usize> = 10..20;
const MODES: Range<usize> = 20..30;
const SETS: Range<usize> = 30..70;

/// State space of a robot linearised about an equilibrium, of as few states as the requirements allow.
///
/// `report` gets the number of finished steps of [`STEPS`] during the work, and stops it by returning `false`.
///
/// # Example
/// ```
/// # use funicular::{dynamics::{Dynamics, Linearisation}, math::Vec3, robot::Robot, statics::{self, StaticModel}};
/// # use funicular::reduced_model::{DampingAt, RequestedStateSpace, StateSpaceSize, control_model};
/// # use funicular::response::{Quantity, Signal};
/// # let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
/// # let lengths = [6.863, 6.565, 6.756, 6.663, 6.801, 6.604];
/// let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
/// let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 5.0)?;
/// let fz = Signal::Along { direction_w: Vec3::z(), point_p: Vec3::zeros() };
/// let requested = RequestedStateSpace {
///     below_hz: 5.0,
///     size: StateSpaceSize::Tolerance(0.05),
///     damping_at: DampingAt::NaturalFrequencies,
/// };
/// let output = (fz, Quantity::Acceleration);
/// let model = control_model(&robot, &rest, &dynamics, &[fz], &[output], requested, &mut |_| true)?;
/// assert!(model.error <= 0.05 && model.space.a.nrows() < 20);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ReductionError`]; among others, a tolerance that no choice of modes keeps, a robot without damping, and an
/// unstable equilibrium.
///
/// # References
/// W. Gawronski, Advanced Structural Dynamics and Active Control of Structures, Springer 2004, chapters 4 and 6;
/// docs/theory.md, section 13.
pub fn control_model(
    robot: &Robot,
    equilibrium: &Equilibrium,
    dynamics: &Dynamics,
    inputs: &[Signal],
    outputs: &[(Signal, Quantity)],
    requested: RequestedStateSpace,
    report: &mut dyn FnMut(usize) -> bool,
) -> Result<ControlModel, ReductionError> {
    let mut steps = Steps::new(report);
    check_cables(robot, dynamics)?;
    let RequestedStateSpace { below_hz, size, damping_at } = requested;
    let tolerance = match size {
        StateSpaceSize::Order(_) => MAX_TOLERANCE,
        StateSpaceSize::Tolerance(tolerance) => tolerance.min(MAX_TOLERANCE),
    };

    // The full model and its peaks.
    let modes = damped_modes(dynamics, below_hz, &mut steps)?;
    let loaded = inputs.iter().any(|signal| matches!(signal, Signal::OnCable { .. }));
    let full = Channels::new(robot, equilibrium, dynamics, inputs, outputs, loaded)?;
    let quantities: Vec<Quantity> = outputs.iter().map(|(_, quantity)| *quantity).collect();
    let mut reference = ReferenceResponses::new(dynamics, &full, &quantities, &modes, below_hz)?;
    if reference.peaks.iter().all(|peak| peak.value == 0.0) {
        return Err(ReductionError::NoResponse);
    }

    // The second-order model and its modes.
    let of_second_order = RequestedModel { below_hz, tolerance, damping_at };
    let (cut, second_order) = cut(robot, equilibrium, inputs, outputs, &reference, of_second_order, &mut steps)?;
    steps.reached(&MODES, 1, 2)?;
    let modal = modal_model(&second_order, &cut, damping_at, equilibrium.stability.is_indifferent())?;

    // Sets of modes to choose from, and the error with all modes that matter.
    let candidates = TermCandidates { modal: &modal, below_hz, tolerance };
    let (sets, damping_error) = candidates.all(&reference, cut.has_damping_ratios(), &mut steps)?;

    // The choice.
    let (chosen, errors) = candidates.choose(sets, &mut reference, size, &mut steps)?;
    let made = Made {
        error: largest(&errors, &reference.sizes),
        damping_error,
        complete_order: 2 * second_order.mass.nrows(),
        modes_below: modes.len(),
        below_hz,
    };
    Ok(chosen.model(&reference, &errors, made))
}

/// Modes below a limit [Hz], all of them damped.
fn damped_modes(dynamics: &Dynamics, below_hz: f64, steps: &mut Steps<'_>) -> Result<Vec<Mode>, ReductionError> {
    let modes = modes::below(dynamics, below_hz).modes;
    steps.reached(&FULL, 1, 2)?;
    match modes.iter().find(|mode| mode.damping_ratio < MIN_DAMPING) {
        Some(mode) => Err(ReductionError::Undamped { frequency_hz: mode.frequency_hz }),
        None => Ok(modes),
    }
}

/// Undamped modes of the second-order model `model` of the robot `cut`.
fn modal_model(
    model: &SecondOrder,
    cut: &Dynamics,
    damping_at: DampingAt,
    is_indifferent: bool,
) -> Result<ModalModel, ReductionError> {
    let mut parts = matrices(cut).1;
    if let DampingAt::Hz(_) = damping_at {
        // Viscous damping as it was requested.
        let none = &model.damping * 0.0;
        (parts.damping, parts.ratio, parts.loss) = (model.damping.clone(), none.clone(), none);
    }
    let refused = if is_indifferent { ReductionError::Indifferent } else { ReductionError::Unstable };
    ModalModel::new(model, &parts, &cut.platform_blocks().mass, is_indifferent).ok_or(refused)
}

/// Modes from which a state space is chosen.
struct TermCandidates<'a> {
    modal: &'a ModalModel,
    /// Highest frequency [Hz].
    below_hz: f64,
    /// Error of the second-order model.
    tolerance: f64,
}

impl TermCandidates<'_> {
    /// Sets of the modes below `ratio` times the limit and of the motions that replace the modes above it: one set per
    /// distance of [`JOINED`], without sets that are equal to the first. `parts` gets the numbers of finished and of
    /// all eigenvalues; its error ends the work.
    fn sets(
        &self,
        ratio: f64,
        reference: &ReferenceResponses,
        parts: &mut dyn FnMut(usize, usize) -> Result<(), ReductionError>,
    ) -> Result<Vec<Vec<Term>>, ReductionError> {
        let pairs = self.modal.candidates(ratio * self.below_hz * TAU, reference, self.tolerance).damped(parts)?;
        let apart = JOINED.map(|width| joined(&pairs, width)).into_iter();
        let different = apart.enumerate().filter(|(i, joined)| *i == 0 || joined.len() < pairs.len());
        let of_all = |joined: Vec<DampedPair>| joined.iter().flat_map(|pair| terms(pair, reference)).collect();
        Ok(different.map(|(_, joined)| of_all(joined)).collect())
    }

    /// Sets for all ratios of [`REPLACED_FROM`], and the error by damping ratios that is left with every mode.
    fn all(
        &self,
        reference: &ReferenceResponses,
        has_damping_ratios: bool,
        steps: &mut Steps<'_>,
    ) -> Result<(Vec<Vec<Term>>, f64), ReductionError> {
        let mut sets: Vec<Vec<Term>> = Vec::new();
        let mut damping_error = 0.0;
        for (i, ratio) in REPLACED_FROM.into_iter().enumerate() {
            let phase = part(&SETS, i, REPLACED_FROM.len());
            let added = self.sets(ratio, reference, &mut |done, all| steps.reached(&phase, done, all))?;
            if has_damping_ratios {
                damping_error = RemainingDifference::of_all(reference, &added[0]).largest();
            }
            sets.extend(added);
        }
        Ok((sets, damping_error))
    }

    /// Chooses terms, searches for the largest errors, and chooses again with the frequencies of these. The result are
    /// the terms and the maximum error of each pair.
    fn choose(
        &self,
        mut sets: Vec<Vec<Term>>,
        reference: &mut ReferenceResponses,
        size: StateSpaceSize,
        steps: &mut Steps<'_>,
    ) -> Result<(Chosen, Vec<Maximum>), ReductionError> {
        let mut has_all_modes = false;
        let mut left = SETS.end..STEPS;
        for round in 0..MAX_ROUNDS {
            // One round is usually enough: each takes half of the steps that are left.
            let phase = part(&left, 0, 2);
            left.start = phase.end;
            let mut found = chosen(&sets, reference, size, &mut |done, all| steps.reached(&phase, done, all));
            if matches!(found, Err(ReductionError::Tolerance { .. })) && !has_all_modes {
                has_all_modes = true;
                let reached = &mut |_, _| steps.reached(&left, 0, 1);
                sets.extend(self.sets(f64::INFINITY, reference, reached)?);
                found = chosen(&sets, reference, size, reached);
            }

            let chosen = Chosen { terms: found? };
            let static_part = chosen.static_part(reference);
            let errors = reference.maxima(&mut |frequency_hz, values| {
                let model = chosen.response(frequency_hz, &static_part);
                values.iter().zip(model).map(|(full, reduced)| (full - reduced).norm()).collect()
            })?;

            let StateSpaceSize::Tolerance(requested) = size else { return Ok((chosen, errors)) };
            let reached = largest(&errors, &reference.sizes);
            if reached <= requested {
                return Ok((chosen, errors));
            }
            if round + 1 == MAX_ROUNDS {
                return Err(ReductionError::Tolerance { requested, reached, order: chosen.order() });
            }
        }
        unreachable!("the last round returns")
    }
}

/// Steps of part `i` of `parts` equal parts of a phase.
fn part(phase: &Range<usize>, i: usize, parts: usize) -> Range<usize> {
    let step = |i: usize| phase.start + phase.len() * i / parts;
    step(i)..step(i + 1)
}

/// Minimum damping ratio. The peak of a mode with less damping counts as infinite.
const MIN_DAMPING: f64 = 1e-9;

/// Copy of the robot with as few clamped modes of the cables as the tolerance allows, and its second-order model.
fn cut(
    robot: &Robot,
    equilibrium: &Equilibrium,
    inputs: &[Signal],
    outputs: &[(Signal, Quantity)],
    reference: &ReferenceResponses,
    requested: RequestedModel,
    steps: &mut Steps<'_>,
) -> Result<(Dynamics, SecondOrder), ReductionError> {
    let below_hz = reference.frequencies_hz.last().expect("there are frequencies");
    let allowed = OMITTED * requested.tolerance;
    let ends = reference.channels.at_far_ends(reference.dynamics);
    for (tried, ratio) in KEPT.into_iter().enumerate() {
        steps.reached(&TRIED, tried, KEPT.len())?;
        let cut = reference.dynamics.with_poles_below(ratio * below_hz * TAU, &ends);
        let channels = Channels::new(robot, equilibrium, &cut, inputs, outputs, false)?;
        let model = || assembled(&cut, &channels, outputs, requested);
        if ratio.is_infinite() {
            return Ok((cut.clone(), model()?));
        }

        // A constant difference of displacements becomes feedthrough.
        let Ok(values) = reference.of_other(&cut, &channels) else { continue };
        let differences: Vec<Complex> = values.iter().zip(&reference.values).map(|(a, b)| a - b).collect();
        let pairs = reference.pairs();
        let error_at = |(at, difference): (usize, &Complex)| {
            let pair = at % pairs;
            let is_displacement = reference.quantity(pair) == Quantity::Displacement;
            let constant = Complex::from(if is_displacement { differences[pair].re } else { 0.0 });
            (difference - constant).norm() / reference.sizes[pair]
        };
        if differences.iter().enumerate().map(error_at).fold(0.0, f64::max) > allowed {
            continue;
        }

        // Few modes leave a part of the response to a commanded length or a motion of the frame that follows its rate,
        // which no mode has.
        let model = model()?;
        if !ends.is_empty() {
            let expansion = Expansion::of(&model);
            let beside = |pair: usize| {
                let at = (pair % outputs.len(), pair / outputs.len());
                let no_feedthrough = reference.quantity(pair) == Quantity::Velocity && !reference.has_drive_losses;
                expansion.beside_modes(below_hz * TAU, at, no_feedthrough) / reference.sizes[pair]
            };
            if (0..pairs).map(beside).fold(0.0, f64::max) > requested.tolerance {
                continue;
            }
        }
        return Ok((cut, model));
    }
    unreachable!("the last ratio keeps all modes")
}

/// Maximum error of all pairs, relative to their sizes.
fn largest(errors: &[Maximum], sizes: &[f64]) -> f64 {
    errors.iter().zip(sizes).map(|(error, size)| error.value / size).fold(0.0, f64::max)
}

/// Terms of a model.
struct Chosen {
    /// Terms, ascending in frequency.
    terms: Vec<Term>,
}

/// Numbers of a model that do not follow from its terms.
#[derive(Clone, Copy)]
struct Made {
    error: f64,
    damping_error: f64,
    complete_order: usize,
    modes_below: usize,
    below_hz: f64,
}

impl Chosen {
    fn order(&self) -> usize {
        self.terms.iter().map(Term::states).sum()
    }

    /// Feedthrough of all pairs: the static displacement that the terms do not have, and the terms' own.
    fn static_part(&self, reference: &ReferenceResponses) -> Vec<f64> {
        let mut constants = reference.at_rest.clone();
        for term in &self.terms {
            for (sum, constant) in constants.iter_mut().zip(&term.constants) {
                *sum += constant;
            }
        }
        // Rounding is no feedthrough.
        for (constant, size) in constants.iter_mut().zip(&reference.sizes) {
            if constant.abs() < MIN_FEEDTHROUGH * size {
                *constant = 0.0;
            }
        }
        constants
    }

    /// Responses of all pairs at a frequency [Hz].
    fn response(&self, frequency_hz: f64, static_part: &[f64]) -> Vec<Complex> {
        let mut responses: Vec<Complex> = static_part.iter().copied().map(Complex::from).collect();
        for term in &self.terms {
            // `static_part` contains the constants.
            term.add_strictly_proper(frequency_hz, 1.0, &mut responses);
        }
        responses
    }

    /// State space in real coordinates, with its errors.
    fn model(&self, reference: &ReferenceResponses, errors: &[Maximum], made: Made) -> ControlModel {
        let (n, outputs) = (self.order(), reference.output_scale.len());
        let inputs = reference.input_scale.len();
        let static_part = self.static_part(reference);
        let (mut a, mut b, mut c) = (DMat::zeros(n, n), DMat::zeros(n, inputs), DMat::zeros(outputs, n));
        let d = DMat::from_column_slice(outputs, inputs, &static_part);

        let mut states = Vec::with_capacity(self.terms.len());
        let mut first = 0;
        for term in &self.terms {
            let block = RealBlock::of(term, reference);
            let size = term.states();
            a.view_mut((first, first), (size, size)).copy_from(&block.a);
            b.view_mut((first, 0), (size, inputs)).copy_from(&block.b);
            c.view_mut((0, first), (outputs, size)).copy_from(&block.c);
            states.push(ModalStates {
                first,
                states: size,
                frequency_hz: term.value.norm() / TAU,
                damping_ratio: -term.value.re / term.value.norm(),
                kind: (!term.is_residual).then(|| Kind::of(term.platform, term.drives)),
                platform_energy_fraction: term.platform,
                contribution: term.size,
            });
            first += size;
        }

        let responses = (0..reference.pairs())
            .map(|pair| ResponseOfPair {
                output: pair % outputs,
                input: pair / outputs,
                peak: reference.peaks[pair].value,
                peak_hz: reference.peaks[pair].frequency_hz,
                error: errors[pair].value / reference.sizes[pair],
                error_hz: errors[pair].frequency_hz,
                coupled: reference.is_coupled(pair),
            })
            .collect();
        ControlModel {
            space: StateSpace { a, b, c, d },
            states,
            quantities: (0..outputs).map(|output| reference.quantity(output)).collect(),
            below_hz: made.below_hz,
            error: made.error,
            damping_error: made.damping_error,
            responses,
            pointwise: self.pointwise(reference, &static_part),
            complete_order: made.complete_order,
            modes_below: made.modes_below,
        }
    }

    /// Largest error relative to the response at the same frequency, over the pairs that have a response.
    fn pointwise(&self, reference: &ReferenceResponses, static_part: &[f64]) -> PointwiseError {
        let outputs = reference.output_scale.len();
        let mut worst = PointwiseError { output: 0, input: 0, error: 0.0, frequency_hz: 0.0, response: 1.0 };
        let at_each = reference.values.chunks_exact(reference.pairs());
        for (values, &frequency_hz) in at_each.zip(&reference.frequencies_hz) {
            let model = self.response(frequency_hz, static_part);
            for (pair, (full, reduced)) in values.iter().zip(model).enumerate() {
                let error = (full - reduced).norm() / full.norm();
                let response = full.norm() / reference.peaks[pair].value;
                if reference.is_coupled(pair) && response > MIN_RESPONSE && error > worst.error {
                    let (output, input) = (pair % outputs, pair / outputs);
                    worst = PointwiseError { output, input, error, frequency_hz, response };
                }
            }
        }
        worst
    }
}

/// Minimum response, relative to its peak, for which an error relative to the response has a meaning. An acceleration
/// at frequencies near zero is smaller.
const MIN_RESPONSE: f64 = 1e-6;

/// Minimum feedthrough, relative to the peak of a pair. A smaller one is rounding.
const MIN_FEEDTHROUGH: f64 = 1e-10;
