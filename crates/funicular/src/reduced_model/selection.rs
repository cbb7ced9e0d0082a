//! Choice of the modes of a state space: as few as a tolerance allows, or the best for a number of states.

use super::ReductionError;
use super::reference::ReferenceResponses;
use super::terms::Term;
use crate::math::{Complex, order};

/// Requested size of a state space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StateSpaceSize {
    /// Maximum number of states.
    Order(usize),
    /// Maximum error of every response, relative to its peak; the model has as few states as it allows.
    Tolerance(f64),
}

/// Fraction of the tolerance that the choice uses. The rest allows for maxima between the frequencies.
const USED: f64 = 0.995;

/// Difference between the full responses and the sum of some terms, at all frequencies of the reference.
pub(super) struct RemainingDifference<'a> {
    reference: &'a ReferenceResponses<'a>,
    differences: Vec<Complex>,
}

impl<'a> RemainingDifference<'a> {
    /// Difference without any term: the static displacement is the feedthrough.
    fn of_none(reference: &'a ReferenceResponses<'a>) -> Self {
        let pairs = reference.pairs();
        let differences =
            reference.values.iter().enumerate().map(|(at, value)| value - reference.at_rest[at % pairs]).collect();
        Self { reference, differences }
    }

    pub(super) fn of_all(reference: &'a ReferenceResponses<'a>, terms: &[Term]) -> Self {
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
    pub(super) fn largest(&self) -> f64 {
        let pairs = self.reference.pairs();
        let relative = |(at, difference): (usize, &Complex)| difference.norm() / self.reference.sizes[at % pairs];
        self.differences.iter().enumerate().map(relative).fold(0.0, f64::max)
    }
}

/// Terms for a size, from the set that needs the fewest states or leaves the smallest error. `parts` gets the numbers
/// of finished and of all terms; its error ends the work.
pub(super) fn chosen(
    sets: &[Vec<Term>],
    reference: &ReferenceResponses,
    size: StateSpaceSize,
    parts: &mut dyn FnMut(usize, usize) -> Result<(), ReductionError>,
) -> Result<Vec<Term>, ReductionError> {
    let mut best: Option<(Vec<Term>, f64)> = None;
    let mut smallest = (f64::INFINITY, 0);
    let order = |terms: &[Term]| terms.iter().map(Term::states).sum::<usize>();

    // Each term is added once, and perhaps taken out again.
    let all: usize = sets.iter().map(Vec::len).sum();
    let mut done = 0;
    let mut term_done = || {
        done += 1;
        parts(done, 2 * all)
    };

    for set in sets {
        let mut ranked: Vec<&Term> = set.iter().collect();
        order::sort_descending(&mut ranked, |term| term.size);
        match size {
            StateSpaceSize::Order(states) => {
                let (terms, error) = of_order(&ranked, reference, states, &mut term_done)?;
                if !terms.is_empty() && best.as_ref().is_none_or(|(_, other)| error < *other) {
                    best = Some((terms, error));
                }
            }
            StateSpaceSize::Tolerance(tolerance) => {
                let (terms, error) = within(&ranked, reference, USED * tolerance, &mut term_done)?;
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
            order::sort_ascending(&mut terms, |term| term.value.norm());
            Ok(terms)
        }
        (None, StateSpaceSize::Order(order)) => Err(ReductionError::Order(order)),
        (None, StateSpaceSize::Tolerance(requested)) => {
            Err(ReductionError::Tolerance { requested, reached: smallest.0, order: smallest.1 })
        }
    }
}

/// The first terms in the order of their size that have at most so many states, and their error.
fn of_order(
    ranked: &[&Term],
    reference: &ReferenceResponses,
    states: usize,
    term_done: &mut dyn FnMut() -> Result<(), ReductionError>,
) -> Result<(Vec<Term>, f64), ReductionError> {
    let mut terms: Vec<Term> = Vec::new();
    let mut left = states;
    let mut sum = RemainingDifference::of_none(reference);
    for term in ranked {
        if term.states() <= left {
            term_done()?;
            left -= term.states();
            sum.add(term, -1.0);
            terms.push((*term).clone());
        }
    }
    let error = sum.largest();
    Ok((terms, error))
}

/// The first terms in the order of their size that keep the tolerance, without those that turn out not to be needed; or
/// all terms if these do not keep it. With their error.
fn within(
    ranked: &[&Term],
    reference: &ReferenceResponses,
    tolerance: f64,
    term_done: &mut dyn FnMut() -> Result<(), ReductionError>,
) -> Result<(Vec<Term>, f64), ReductionError> {
    let mut sum = RemainingDifference::of_none(reference);
    let mut count = 0;
    let mut error = f64::INFINITY;
    for term in ranked {
        term_done()?;
        sum.add(term, -1.0);
        count += 1;
        error = sum.largest();
        if error <= tolerance {
            break;
        }
    }
    let mut kept: Vec<&Term> = ranked[..count].to_vec();
    if error > tolerance {
        return Ok((kept.into_iter().cloned().collect(), error));
    }

    // Take out terms that the tolerance does not need, one after the other and the smallest first.
    for at in (0..kept.len()).rev() {
        if kept.len() == 1 {
            break;
        }
        term_done()?;
        sum.add(kept[at], 1.0);
        let without = sum.largest();
        if without <= tolerance {
            error = without;
            kept.remove(at);
        } else {
            sum.add(kept[at], -1.0);
        }
    }
    Ok((kept.into_iter().cloned().collect(), error))
}
