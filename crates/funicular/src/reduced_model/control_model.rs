//! State space of few states for controllers: the modes that inputs and outputs see, chosen by the error that is left.
//!
//! Lightly damped modes are nearly the balanced coordinates of the robot, so that a choice of modes is as short as a
//! balanced truncation. It knows the frequency limit and the size of every pair of input and output, which Hankel
//! singular values do not. Modes left out keep their static displacement as feedthrough. Every error is measured
//! against the full model. Derivation: docs/theory.md, section 13.

use super::candidates::{DampedPair, MULTIPLE, ModalModel, joined};
use super::reference::{Maximum, Reference, derivatives};
use super::{
    Channels, KEPT, Quantity, ReductionError, RequestedModel, StateSpace, assembled, viscous_damping_and_ratios,
};
use crate::cable::DynamicCable;
use crate::dynamics::Dynamics;
use crate::math::{Complex, DMat};
use crate::modes::{self, Kind};
use crate::reduced_model::DampingAt;
use crate::response::Signal;
use crate::robot::Robot;
use crate::statics::Equilibrium;
use std::f64::consts::TAU;

/// Wanted size of a state space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Size {
    /// Maximum number of states.
    Order(usize),
    /// Maximum error of every response, relative to its peak; the model has as few states as it allows.
    Tolerance(f64),
}

/// Requirements for a state space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RequestedStateSpace {
    /// Highest frequency [Hz].
    pub below_hz: f64,
    /// Number of states, or the error.
    pub size: Size,
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
    /// False if the response is below a millionth of the responses that input and output have otherwise. Its error is
    /// then relative to this millionth.
    pub coupled: bool,
}

/// Largest error relative to the response at the same frequency. It is large beside a zero of the response.
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
/// Rounds in which frequencies of large errors are added to those at which modes are chosen.
const MAX_ROUNDS: usize = 6;
/// Fraction of the tolerance that the choice uses; the rest is for maxima between the frequencies.
const USED: f64 = 0.995;
/// Residue relative to the largest of the same eigenvalue below which it is rounding.
const RESIDUE: f64 = 1e-9;

/// State space of a robot linearised about an equilibrium, of as few states as the requirements allow.
///
/// # Example
/// ```
/// # use funicular::{dynamics::{Dynamics, Linearisation}, math::Vec3, robot::Robot, statics::{self, StaticModel}};
/// # use funicular::{reduced_model::{DampingAt, RequestedStateSpace, Size, control_model}, response::{Quantity, Signal}};
/// # let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
/// # let lengths = [6.863, 6.565, 6.756, 6.663, 6.801, 6.604];
/// let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
/// let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 5.0)?;
/// let fz = Signal::Along { direction_w: Vec3::z(), point_p: Vec3::zeros() };
/// let requested = RequestedStateSpace { below_hz: 5.0, size: Size::Tolerance(0.05), damping_at: DampingAt::NaturalFrequencies };
/// let model = control_model(&robot, &rest, &dynamics, &[fz], &[(fz, Quantity::Acceleration)], requested)?;
/// assert!(model.error <= 0.05 && model.space.a.nrows() < 20);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ReductionError`]; among others, a tolerance that no choice of modes keeps, a robot without damping, and an unstable
/// equilibrium.
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
) -> Result<ControlModel, ReductionError> {
    if dynamics.terms().iter().any(|term| !matches!(term.form(), DynamicCable::CatenaryDynamic(_))) {
        return Err(ReductionError::Model);
    }
    let RequestedStateSpace { below_hz, size, damping_at } = requested;
    let tolerance = match size {
        Size::Order(_) => MAX_TOLERANCE,
        Size::Tolerance(tolerance) => tolerance.min(MAX_TOLERANCE),
    };

    // The full model and its peaks.
    let listed = modes::below(dynamics, below_hz);
    if let Some(mode) = listed.modes.iter().find(|mode| mode.damping_ratio < MIN_DAMPING) {
        return Err(ReductionError::Undamped { frequency_hz: mode.frequency_hz });
    }
    let loaded = inputs.iter().any(|signal| matches!(signal, Signal::OnCable { .. }));
    let full = Channels::new(robot, equilibrium, dynamics, inputs, outputs, loaded)?;
    let quantities: Vec<Quantity> = outputs.iter().map(|(_, quantity)| *quantity).collect();
    let mut reference = Reference::new(dynamics, &full, &quantities, &listed.modes, below_hz)?;
    if reference.peaks.iter().all(|peak| peak.value == 0.0) {
        return Err(ReductionError::NoResponse);
    }

    // The second-order model and its modes.
    let cut = cut(robot, equilibrium, dynamics, inputs, outputs, &reference, tolerance)?;
    let channels = Channels::new(robot, equilibrium, &cut, inputs, outputs, false)?;
    let of_second_order = RequestedModel { below_hz, tolerance, damping_at };
    let second_order = assembled(&cut, &channels, outputs, of_second_order)?;
    let complete_order = 2 * second_order.mass.nrows();
    let (viscous, ratios) = match damping_at {
        DampingAt::NaturalFrequencies => viscous_damping_and_ratios(&cut),
        // Viscous damping as it was requested.
        DampingAt::Hz(_) => (second_order.damping.clone(), &second_order.damping * 0.0),
    };
    let modal = ModalModel::new(&second_order, &viscous, &ratios, &cut.platform_blocks().mass);
    let modal = modal.ok_or(ReductionError::Unstable)?;

    // Sets of modes to choose from, and the error with all modes that matter.
    let sets_from = |ratio: f64, reference: &Reference| -> Result<Vec<Vec<Term>>, ReductionError> {
        let pairs = modal.candidates(ratio * below_hz * TAU, reference, tolerance).damped();
        let pairs = pairs.ok_or(ReductionError::Eigenvalues)?;
        let apart = JOINED.map(|width| joined(&pairs, width)).into_iter();
        let different = apart.enumerate().filter(|(i, joined)| *i == 0 || joined.len() < pairs.len());
        let of_all = |joined: Vec<DampedPair>| joined.iter().flat_map(|pair| terms(pair, reference)).collect();
        Ok(different.map(|(_, joined)| of_all(joined)).collect())
    };
    let mut sets: Vec<Vec<Term>> = Vec::new();
    let mut damping_error = 0.0;
    for ratio in REPLACED_FROM {
        let added = sets_from(ratio, &reference)?;
        if cut.has_damping_ratios() {
            damping_error = Sum::of_all(&reference, &added[0]).largest();
        }
        sets.extend(added);
    }

    // Choose, search for the largest errors, and choose again with these frequencies.
    let mut has_all_modes = false;
    for round in 0..MAX_ROUNDS {
        let mut found = chosen(&sets, &reference, size);
        if matches!(found, Err(ReductionError::Tolerance { .. })) && !has_all_modes {
            has_all_modes = true;
            sets.extend(sets_from(f64::INFINITY, &reference)?);
            found = chosen(&sets, &reference, size);
        }
        let chosen = found?;
        let static_part = chosen.static_part(&reference);
        let errors = reference.maxima(&mut |frequency_hz, values| {
            let model = chosen.response(frequency_hz, &static_part);
            values.iter().zip(model).map(|(full, reduced)| (full - reduced).norm()).collect()
        })?;
        let error = largest(&errors, &reference.sizes);

        let kept = match size {
            Size::Order(_) => true,
            Size::Tolerance(tolerance) => error <= tolerance,
        };
        if kept || round + 1 == MAX_ROUNDS {
            if let (false, Size::Tolerance(requested)) = (kept, size) {
                return Err(ReductionError::Tolerance { requested, reached: error, order: chosen.order() });
            }
            let modes_below = listed.modes.len();
            let made = Made { error, damping_error, complete_order, modes_below, below_hz };
            return Ok(chosen.model(&reference, &errors, made));
        }
    }
    unreachable!("the last round returns")
}

/// Damping ratio below which a peak is not finite in practice.
const MIN_DAMPING: f64 = 1e-9;

/// Copy of the robot with as few clamped modes of the cables as the tolerance allows.
fn cut(
    robot: &Robot,
    equilibrium: &Equilibrium,
    dynamics: &Dynamics,
    inputs: &[Signal],
    outputs: &[(Signal, Quantity)],
    reference: &Reference,
    tolerance: f64,
) -> Result<Dynamics, ReductionError> {
    let below_hz = reference.frequencies_hz.last().expect("there are frequencies");
    for ratio in KEPT {
        let cut = dynamics.with_poles_below(ratio * below_hz * TAU);
        if ratio.is_infinite() {
            return Ok(cut);
        }

        // A constant difference of displacements becomes feedthrough.
        let channels = Channels::new(robot, equilibrium, &cut, inputs, outputs, false)?;
        let Ok(values) = reference.of_other(&cut, &channels) else { continue };
        let differences: Vec<Complex> = values.iter().zip(&reference.values).map(|(a, b)| a - b).collect();
        let pairs = reference.pairs();
        let error = differences
            .iter()
            .enumerate()
            .map(|(at, difference)| {
                let pair = at % pairs;
                let constant = if reference.quantity(pair) == Quantity::Displacement {
                    Complex::from(differences[pair].re)
                } else {
                    0.0.into()
                };
                (difference - constant).norm() / reference.sizes[pair]
            })
            .fold(0.0, f64::max);
        if error <= OMITTED * tolerance {
            return Ok(cut);
        }
    }
    unreachable!("the last ratio keeps all modes")
}

/// Part of one pair of states, or of one state, in all responses:
/// `R/(s − λ)`, its conjugate, and a constant that makes it zero at s = 0.
#[derive(Clone)]
struct Term {
    value: Complex,
    /// Column of the outputs, in their quantities.
    column: Vec<Complex>,
    /// Row of the inputs.
    row: Vec<Complex>,
    /// Residues of all pairs of output and input.
    residues: Vec<Complex>,
    /// Feedthrough of all pairs.
    constants: Vec<f64>,
    platform: f64,
    is_residual: bool,
    /// Maximum of the term relative to the peaks.
    size: f64,
}

impl Term {
    fn states(&self) -> usize {
        if self.value.im > 0.0 { 2 } else { 1 }
    }

    /// Adds `factor` times the term at a frequency [Hz] to the responses of all pairs.
    fn add(&self, frequency_hz: f64, factor: f64, responses: &mut [Complex]) {
        self.add_strictly_proper(frequency_hz, factor, responses);
        for (response, constant) in responses.iter_mut().zip(&self.constants) {
            *response += factor * constant;
        }
    }

    /// Adds `factor` times the term without its constant.
    fn add_strictly_proper(&self, frequency_hz: f64, factor: f64, responses: &mut [Complex]) {
        let s = Complex::new(0.0, frequency_hz * TAU);
        let upper = factor / (s - self.value);
        if self.states() == 2 {
            let lower = factor / (s - self.value.conj());
            for (response, residue) in responses.iter_mut().zip(&self.residues) {
                *response += residue * upper + residue.conj() * lower;
            }
        } else {
            for (response, residue) in responses.iter_mut().zip(&self.residues) {
                *response += residue * upper;
            }
        }
    }
}

/// Terms of a damped mode: one per independent direction of its residues.
fn terms(pair: &DampedPair, reference: &Reference) -> Vec<Term> {
    let (outputs, inputs) = pair.residue.shape();
    let scaled = pair.residue.map_with_location(|o, i, r| r / (reference.output_scale[o] * reference.input_scale[i]));
    let decomposed = scaled.svd(true, true);
    let (Some(left), Some(right)) = (&decomposed.u, &decomposed.v_t) else { return Vec::new() };
    let largest = decomposed.singular_values.max();
    let is_real = pair.value.im <= 0.0;

    (0..decomposed.singular_values.len())
        .filter(|k| decomposed.singular_values[*k] > RESIDUE * largest)
        .map(|k| {
            let root = decomposed.singular_values[k].sqrt();
            let column: Vec<Complex> =
                (0..outputs).map(|o| left[(o, k)] * (root * reference.output_scale[o])).collect();
            let row: Vec<Complex> = (0..inputs).map(|i| right[(k, i)] * (root * reference.input_scale[i])).collect();
            let (column, row) = if is_real { real_factors(&column, &row) } else { (column, row) };
            term(pair, column, row, reference)
        })
        .collect()
}

/// Real column and row with the same product, for the real residues of a real eigenvalue.
fn real_factors(column: &[Complex], row: &[Complex]) -> (Vec<Complex>, Vec<Complex>) {
    let largest = row.iter().copied().max_by(|a, b| a.norm().total_cmp(&b.norm())).unwrap_or_default();
    let turn = if largest.norm() > 0.0 { largest.conj() / largest.norm() } else { 1.0.into() };
    let real = |values: &[Complex], turn: Complex| values.iter().map(|z| Complex::from((z * turn).re)).collect();
    (real(column, turn.conj()), real(row, turn))
}

/// Term of a column for displacements and a row for forces.
fn term(pair: &DampedPair, mut column: Vec<Complex>, row: Vec<Complex>, reference: &Reference) -> Term {
    let outputs = column.len();
    let value = pair.value;
    let twice = if value.im > 0.0 { 2.0 } else { 1.0 };

    // Feedthrough: what makes the displacement zero at s = 0, so that the static part of every mode can be added
    // elsewhere; and that of the acceleration, `s² R/(s − λ) = λ² R/(s − λ) + λ R + s R`, whose last part vanishes in
    // the sum with the conjugate for a mode of second order.
    let mut constants = vec![0.0; reference.pairs()];
    for (at, constant) in constants.iter_mut().enumerate() {
        let residue = column[at % outputs] * row[at / outputs];
        *constant = match reference.quantity(at) {
            Quantity::Displacement => twice * (residue / value).re,
            Quantity::Velocity => 0.0,
            Quantity::Acceleration => twice * (residue * value).re,
        };
    }
    for (output, entry) in column.iter_mut().enumerate() {
        *entry *= value.powu(derivatives(reference.quantity(output)));
    }

    let residues = row.iter().flat_map(|b| column.iter().map(move |c| c * b)).collect();
    let (platform, is_residual) = (pair.platform, pair.is_residual);
    let mut term = Term { value, column, row, residues, constants, platform, is_residual, size: 0.0 };
    let mut responses = vec![Complex::from(0.0); reference.pairs()];
    for frequency_hz in &reference.frequencies_hz {
        responses.fill(0.0.into());
        term.add(*frequency_hz, 1.0, &mut responses);
        term.size = responses.iter().zip(&reference.sizes).map(|(r, size)| r.norm() / size).fold(term.size, f64::max);
    }
    term
}

/// Difference between the full responses and those of some terms, at all frequencies of the reference.
struct Sum<'a> {
    reference: &'a Reference<'a>,
    differences: Vec<Complex>,
}

impl<'a> Sum<'a> {
    /// Difference without any term: the static displacement is the feedthrough.
    fn of_none(reference: &'a Reference<'a>) -> Self {
        let pairs = reference.pairs();
        let differences =
            reference.values.iter().enumerate().map(|(at, value)| value - reference.at_rest[at % pairs]).collect();
        Self { reference, differences }
    }

    fn of_all(reference: &'a Reference<'a>, terms: &[Term]) -> Self {
        let mut sum = Self::of_none(reference);
        for term in terms {
            sum.add(term, -1.0);
        }
        sum
    }

    /// Adds `factor` times a term to the difference: −1 takes it into the model, 1 out of it.
    fn add(&mut self, term: &Term, factor: f64) {
        let at_each = self.differences.chunks_exact_mut(self.reference.pairs());
        for (responses, frequency_hz) in at_each.zip(&self.reference.frequencies_hz) {
            term.add(*frequency_hz, factor, responses);
        }
    }

    /// Maximum difference relative to the peaks.
    fn largest(&self) -> f64 {
        let pairs = self.reference.pairs();
        let relative = |(at, difference): (usize, &Complex)| difference.norm() / self.reference.sizes[at % pairs];
        self.differences.iter().enumerate().map(relative).fold(0.0, f64::max)
    }
}

fn largest(errors: &[Maximum], sizes: &[f64]) -> f64 {
    errors.iter().zip(sizes).map(|(error, size)| error.value / size).fold(0.0, f64::max)
}

/// Terms of a model.
struct Chosen {
    /// Terms, ascending in frequency.
    terms: Vec<Term>,
}

/// Terms for a size, from the set that needs the fewest states or leaves the smallest error.
fn chosen(sets: &[Vec<Term>], reference: &Reference, size: Size) -> Result<Chosen, ReductionError> {
    let mut best: Option<(Vec<Term>, f64)> = None;
    let mut smallest = (f64::INFINITY, 0);
    let order = |terms: &[Term]| terms.iter().map(Term::states).sum::<usize>();

    for set in sets {
        let mut ranked: Vec<&Term> = set.iter().collect();
        ranked.sort_by(|a, b| b.size.total_cmp(&a.size));
        match size {
            Size::Order(states) => {
                let (terms, error) = of_order(&ranked, reference, states);
                if !terms.is_empty() && best.as_ref().is_none_or(|(_, other)| error < *other) {
                    best = Some((terms, error));
                }
            }
            Size::Tolerance(tolerance) => {
                let (terms, error) = within(&ranked, reference, USED * tolerance);
                if error < smallest.0 {
                    smallest = (error, order(&terms));
                }
                let fewer = |(other, of_other): &(Vec<Term>, f64)| (order(&terms), error) < (order(other), *of_other);
                if error <= USED * tolerance && best.as_ref().is_none_or(fewer) {
                    best = Some((terms, error));
                }
            }
        }
    }

    match (best, size) {
        (Some((mut terms, _)), _) => {
            terms.sort_by(|a, b| a.value.norm().total_cmp(&b.value.norm()));
            Ok(Chosen { terms })
        }
        (None, Size::Order(order)) => Err(ReductionError::Order(order)),
        (None, Size::Tolerance(requested)) => {
            Err(ReductionError::Tolerance { requested, reached: smallest.0, order: smallest.1 })
        }
    }
}

/// The first terms in the order of their size that have at most so many states, and their error.
fn of_order(ranked: &[&Term], reference: &Reference, states: usize) -> (Vec<Term>, f64) {
    let mut terms: Vec<Term> = Vec::new();
    let mut left = states;
    let mut sum = Sum::of_none(reference);
    for term in ranked {
        if term.states() <= left {
            left -= term.states();
            sum.add(term, -1.0);
            terms.push((*term).clone());
        }
    }
    let error = sum.largest();
    (terms, error)
}

/// The first terms in the order of their size that keep the tolerance, without those that turn out not to be needed; or
/// all terms if these do not keep it. With their error.
fn within(ranked: &[&Term], reference: &Reference, tolerance: f64) -> (Vec<Term>, f64) {
    let mut sum = Sum::of_none(reference);
    let mut count = 0;
    let mut error = f64::INFINITY;
    for term in ranked {
        sum.add(term, -1.0);
        count += 1;
        error = sum.largest();
        if error <= tolerance {
            break;
        }
    }
    let mut kept: Vec<&Term> = ranked[..count].to_vec();
    if error > tolerance {
        return (kept.into_iter().cloned().collect(), error);
    }

    // Take out one after the other, the smallest first, what the tolerance allows.
    for at in (0..kept.len()).rev() {
        if kept.len() == 1 {
            break;
        }
        sum.add(kept[at], 1.0);
        let without = sum.largest();
        if without <= tolerance {
            error = without;
            kept.remove(at);
        } else {
            sum.add(kept[at], -1.0);
        }
    }
    (kept.into_iter().cloned().collect(), error)
}

/// Numbers of a model that do not follow from its terms.
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
    fn static_part(&self, reference: &Reference) -> Vec<f64> {
        let mut constants = reference.at_rest.clone();
        for term in &self.terms {
            for (sum, constant) in constants.iter_mut().zip(&term.constants) {
                *sum += constant;
            }
        }
        // Rounding is no feedthrough.
        for (constant, size) in constants.iter_mut().zip(&reference.sizes) {
            if constant.abs() < NO_FEEDTHROUGH * size {
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
    fn model(&self, reference: &Reference, errors: &[Maximum], made: Made) -> ControlModel {
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
                kind: (!term.is_residual).then(|| Kind::of(term.platform)),
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
    fn pointwise(&self, reference: &Reference, static_part: &[f64]) -> PointwiseError {
        let outputs = reference.output_scale.len();
        let mut worst = PointwiseError { output: 0, input: 0, error: 0.0, frequency_hz: 0.0, response: 1.0 };
        let at_each = reference.values.chunks_exact(reference.pairs());
        for (values, &frequency_hz) in at_each.zip(&reference.frequencies_hz) {
            let model = self.response(frequency_hz, static_part);
            for (pair, (full, reduced)) in values.iter().zip(model).enumerate() {
                let error = (full - reduced).norm() / full.norm();
                if reference.is_coupled(pair) && error > worst.error && error.is_finite() {
                    let response = full.norm() / reference.peaks[pair].value;
                    let (output, input) = (pair % outputs, pair / outputs);
                    worst = PointwiseError { output, input, error, frequency_hz, response };
                }
            }
        }
        worst
    }
}

/// Feedthrough relative to the peak of a pair below which it is rounding.
const NO_FEEDTHROUGH: f64 = 1e-10;

/// Matrices of one term in real coordinates: `[0, ω; −ω, −2ζω]` for a pair.
struct RealBlock {
    a: DMat,
    b: DMat,
    c: DMat,
}

impl RealBlock {
    fn of(term: &Term, reference: &Reference) -> Self {
        let (inputs, outputs) = (term.row.len(), term.column.len());
        let value = term.value;
        if term.states() == 1 {
            let b = DMat::from_fn(1, inputs, |_, i| term.row[i].re);
            let c = DMat::from_fn(outputs, 1, |o, _| term.column[o].re);
            return Self { a: DMat::from_element(1, 1, value.re), b, c }.balanced(reference);
        }

        // Phase for which the input acts on the second state, the velocity of the mode, as far as it can: the rows of
        // the inputs become imaginary in the mean.
        let square: Complex =
            term.row.iter().zip(&reference.input_scale).map(|(b, scale)| (b / scale) * (b / scale)).sum();
        let mut turn = Complex::from_polar(1.0, 0.5 * (std::f64::consts::PI - square.arg()));
        let largest = (0..inputs).max_by(|a, b| term.row[*a].norm().total_cmp(&term.row[*b].norm()));
        if largest.is_some_and(|i| (term.row[i] * turn).im < 0.0) {
            turn = -turn;
        }

        // The coordinates are x = 2 Re(v z) with the eigenvector v = (ω, λ) of the block.
        let omega = value.norm();
        let b = DMat::from_fn(2, inputs, |state, i| {
            let row = term.row[i] * turn;
            2.0 * if state == 0 { omega * row.re } else { (value * row).re }
        });
        let c = DMat::from_fn(outputs, 2, |o, state| {
            let column = term.column[o] / turn;
            let second = column.im / value.im;
            if state == 0 { (column.re - value.re * second) / omega } else { second }
        });
        let a = DMat::from_row_slice(2, 2, &[0.0, omega, -omega, 2.0 * value.re]);
        Self { a, b, c }.balanced(reference)
    }

    /// Scales the states so that input and output have entries of equal size, measured in their scales.
    fn balanced(mut self, reference: &Reference) -> Self {
        let by_input: f64 =
            self.b.column_iter().zip(&reference.input_scale).map(|(b, scale)| b.norm_squared() / (scale * scale)).sum();
        let by_output: f64 =
            self.c.row_iter().zip(&reference.output_scale).map(|(c, scale)| c.norm_squared() / (scale * scale)).sum();
        if by_input > 0.0 && by_output > 0.0 {
            let factor = (by_output / by_input).sqrt().sqrt();
            self.b *= factor;
            self.c /= factor;
        }
        self
    }
}
