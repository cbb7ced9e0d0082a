//! Search over assignments: measured frequencies without a number belong to some of the modes, and each choice has its
//! own values. The best and the second best are found, and how well random frequencies would be fitted.

use super::chi2::degrees_of_freedom;
use super::draws::{mixed, point};
use super::lists::{ListSample, NearBest, Target, targets};
use super::model::{Assigned, IdentifiedModel};
use super::observations::Subject;
use super::precision::Judged;
use super::starts::{MAX_ITERATIONS, StartRow};
use super::unknowns::Unknown;
use crate::error::Cancelled;
use crate::normal::normal_quantile;
use crate::text::{counted, significant};
use anyhow::{Result, anyhow};
use funicular::math::least_squares::{Minimum, minimise};

/// Number of sampled robots per value, and its minimum and maximum. With 64 samples of a mass without prior, neighbours
/// are 2 % apart near the start and their frequencies at most 1 %.
const SAMPLES_PER_VALUE: usize = 48;
const MIN_SAMPLES: usize = 64;
const MAX_SAMPLES: usize = 160;

/// Width of the samples of a value without prior, in its usual errors: 95 % are within a factor of 3.
const WIDTH: f64 = 2.0;

/// Bounds of a value without prior that are at most this many usual errors apart are its range of samples.
const NARROW: f64 = 12.0;

/// Way on which the linear model of a sample is used, in widths of the samples: at least [`MIN_WAY`], and for several
/// values a multiple of the distance between neighbours.
const WAY: f64 = 2.5;
const MIN_WAY: f64 = 0.25;

/// Number of lists of random frequencies.
const RANDOM_LISTS: usize = 100;

/// Part of these lists that may fit as well as the measured frequencies.
const MAX_AS_GOOD: f64 = 0.02;

/// Minimum number of assignments from which a search starts, beside the values of the file.
const MIN_REFINED: usize = 7;

/// Ratio of likelihoods down to which another assignment is possible, if the deviations of the measurements are given,
/// and if they were assumed. With an unknown factor of the deviations, five frequencies with errors of 0.5 % were
/// fitted to 0.1 % with one wrong mode, a ratio of 1e-3.
const POSSIBLE: f64 = 1e-2;
const POSSIBLE_IF_ASSUMED: f64 = 1e-4;

/// Difference of values, in spreads, up to which two minima are one.
const SAME: f64 = 1e-3;

/// Deviations from a measured frequency within which a second mode leaves the choice open.
const CROWDED: f64 = 2.0;

/// Deviations from a measured frequency within which other modes are tried in place of its mode.
const EXCHANGED: f64 = 3.0;

/// Number of nearest modes within whose distance random frequencies are spread.
const AROUND: usize = 3;

/// Quantile of the normal distribution for an interval of 95 %.
const NORMAL_95: f64 = crate::analyses::profile::LIMIT;

/// Fit with other modes.
pub(crate) struct OtherFit {
    pub(crate) x: Vec<f64>,
    pub(crate) chi2: f64,
    pub(crate) degrees: usize,
    /// Modes of the frequencies of each experiment.
    pub(crate) assigned: Assigned,
    /// Natural frequencies of these modes [Hz], in the order of the measured ones.
    pub(crate) frequency_hz: Vec<f64>,
}

/// Best assignment among others.
pub(crate) struct Assigning {
    /// Number of frequencies without a number.
    pub(crate) open: usize,
    /// Number of these with several modes within [`CROWDED`] deviations.
    pub(crate) crowded: usize,
    /// Part of χ² that frequencies, poses, tensions, lengths and priors have, and its degrees of freedom.
    pub(crate) own: f64,
    pub(crate) own_degrees: usize,
    /// Part of χ² after the best fit to each list of random frequencies, ascending.
    pub(crate) random: Vec<f64>,
    /// Second best fit.
    pub(crate) other: Option<OtherFit>,
    /// Fits in which one frequency belongs to another mode nearby, in the linear model.
    exchanges: Vec<Exchange>,
}

/// Fit with another mode of one frequency.
struct Exchange {
    /// Logarithm of the measured frequency in Hz.
    ln_hz: f64,
    /// Index of the other mode.
    mode: usize,
    chi2: f64,
    x: Vec<f64>,
}

/// Minimum with its choices.
struct AssignedFit {
    minimum: Minimum,
    choices: (Assigned, Vec<f64>),
}

/// True if modes of frequencies have to be found without the help of responses, which see motions.
pub(super) fn is_open(model: &IdentifiedModel<'_>) -> bool {
    model.observations.iter().any(|observation| observation.is_assigned)
        && !model.observations.iter().any(|observation| observation.subject.is_response())
}

/// Searches values and assignment. `starts` is the maximum number of searches if it is above eight.
///
/// # Errors
/// No robot with an equilibrium, or work that was stopped.
pub(super) fn search(
    model: &mut IdentifiedModel<'_>,
    (first, centre): (&[f64], &[f64]),
    starts: usize,
    progress: &dyn Fn(usize, usize),
) -> Result<(Minimum, Vec<StartRow>, Assigning)> {
    let bounds: Vec<(f64, f64)> = model.unknowns.iter().map(Unknown::coordinate_bounds).collect();
    let targets = targets(model);
    let (mut fits, mut rows) = (Vec::new(), Vec::new());
    refine(model, first, &bounds, (&mut fits, &mut rows))?;

    // All modes at sampled values, and the best assignments near each.
    let count = (SAMPLES_PER_VALUE * first.len()).clamp(MIN_SAMPLES, MAX_SAMPLES);
    let widths: Vec<f64> = model.unknowns.iter().map(width).collect();
    let way = (WAY * (count as f64).powf(-1.0 / first.len() as f64)).max(MIN_WAY);
    let reach: Vec<f64> = widths.iter().map(|width| way * width).collect();
    let mut samples = Vec::with_capacity(count);
    for number in 0..count {
        progress(number * starts / count, starts + 1);
        let x = drawn(model, centre, number, &bounds);
        samples.extend(model.sample(&x, &targets)?);
    }
    let mut candidates: Vec<_> =
        samples.iter().filter_map(|sample| sample.best(model, &targets, &reach, &bounds)).collect();
    candidates.sort_by(|a, b| a.chi2.total_cmp(&b.chi2));

    // Searches from the best assignments that no search has ended with.
    let mut tried: Vec<Vec<usize>> = Vec::new();
    for candidate in candidates {
        let is_known = fits.iter().any(|fit: &AssignedFit| fit.choices.0.iter().flatten().eq(&candidate.partners));
        if is_known || tried.contains(&candidate.partners) {
            continue;
        }
        if tried.len() >= MIN_REFINED.max(starts.saturating_sub(1)) {
            break;
        }
        refine(model, &candidate.x, &bounds, (&mut fits, &mut rows))?;
        tried.push(candidate.partners);
    }

    fits.sort_by(|a, b| a.minimum.chi2().total_cmp(&b.minimum.chi2()));
    let mut fits = fits.into_iter();
    let Some(best) = fits.next() else {
        let reason = model.refusal.take().unwrap_or_else(|| anyhow!("no residual is finite"));
        return Err(reason.context("the measurements cannot be computed at any start"));
    };
    let other = fits.find(|fit| fit.choices.0 != best.choices.0 && !is_same(model, &fit.minimum.x, &best.minimum.x));
    let other = other.map(|fit| other_fit(model, &fit)).transpose()?;

    model.choose(Some(best.choices));
    let assigning = assigning(model, &best.minimum.x, &samples, (&targets, &reach, &bounds), other)?;
    Ok((best.minimum, rows, assigning))
}

/// Width of the samples of a value.
fn width(unknown: &Unknown) -> f64 {
    if unknown.prior.is_some() { unknown.spread() } else { WIDTH * unknown.spread() }
}

/// Sampled values with this number: normal about the centre of starts, or even within narrow bounds.
fn drawn(model: &IdentifiedModel<'_>, centre: &[f64], number: usize, bounds: &[(f64, f64)]) -> Vec<f64> {
    let points = point(number, centre.len());
    let of_value = |(k, unknown): (usize, &Unknown)| {
        let (low, high) = bounds[k];
        if unknown.prior.is_none() && high - low <= NARROW * unknown.spread() {
            return low + points[k] * (high - low);
        }
        (centre[k] + width(unknown) * normal_quantile(points[k])).clamp(low, high)
    };
    model.unknowns.iter().enumerate().map(of_value).collect()
}

/// Search from a start; a minimum is added to those that are known, unless it is one of them.
fn refine(
    model: &mut IdentifiedModel<'_>,
    start: &[f64],
    bounds: &[(f64, f64)],
    (fits, rows): (&mut Vec<AssignedFit>, &mut Vec<StartRow>),
) -> Result<()> {
    let found = minimise(model, start, bounds, MAX_ITERATIONS);
    if model.is_stopped() {
        return Err(Cancelled.into());
    }
    let Some((minimum, choices)) = found.zip(model.choices()) else {
        rows.push(StartRow::refused());
        return Ok(());
    };
    let degrees = degrees_of_freedom(model, &minimum).max(1) as f64;
    rows.push(StartRow::of(&minimum, degrees));
    let known = fits.iter_mut().find(|fit| fit.choices.0 == choices.0 || is_same(model, &fit.minimum.x, &minimum.x));
    match known {
        Some(known) if known.minimum.chi2() <= minimum.chi2() => {}
        Some(known) => *known = AssignedFit { minimum, choices },
        None => fits.push(AssignedFit { minimum, choices }),
    }
    Ok(())
}

fn is_same(model: &IdentifiedModel<'_>, a: &[f64], b: &[f64]) -> bool {
    model.unknowns.iter().zip(a).zip(b).all(|((unknown, a), b)| (a - b).abs() <= SAME * unknown.spread())
}

/// Second best fit with its frequencies.
fn other_fit(model: &mut IdentifiedModel<'_>, fit: &AssignedFit) -> Result<OtherFit> {
    let predicted = model.predict(&fit.minimum.x, Some(&fit.choices.0))?;
    let frequencies = model.observations.iter().zip(&predicted.values);
    Ok(OtherFit {
        frequency_hz: frequencies
            .filter(|(observation, _)| matches!(observation.subject, Subject::Frequency(_)))
            .map(|(_, value)| value.re)
            .collect(),
        x: fit.minimum.x.clone(),
        chi2: fit.minimum.chi2(),
        degrees: degrees_of_freedom(model, &fit.minimum),
        assigned: fit.choices.0.clone(),
    })
}

/// Comparison of the best fit with those to random frequencies.
fn assigning(
    model: &mut IdentifiedModel<'_>,
    x: &[f64],
    samples: &[ListSample],
    (targets, reach, bounds): (&[Target], &[f64], &[(f64, f64)]),
    other: Option<OtherFit>,
) -> Result<Assigning> {
    let here = model.sample(x, targets)?;
    let open: Vec<usize> = (0..targets.len()).filter(|&k| targets[k].mode.is_none()).collect();
    let (mut own, mut crowded, mut random, mut exchanges) = (0.0, 0, Vec::new(), Vec::new());
    if let Some(here) = &here {
        own = here.best(model, targets, &vec![0.0; x.len()], bounds).map_or(f64::INFINITY, |best| best.chi2);
        let is_crowded = |&&k: &&usize| here.distance(&targets[k], 2) <= CROWDED * targets[k].deviation;
        crowded = open.iter().filter(is_crowded).count();
        let found = here.exchanges(model, targets, EXCHANGED).into_iter();
        exchanges.extend(found.map(|(k, NearBest { chi2, x, partners })| Exchange {
            ln_hz: targets[k].ln_hz,
            mode: partners[0],
            chi2,
            x,
        }));

        let around: Vec<f64> = targets.iter().map(|target| here.distance(target, AROUND)).collect();
        for list in 0..RANDOM_LISTS {
            if model.is_stopped() {
                return Err(Cancelled.into());
            }
            let mut others = targets.to_vec();
            for &k in &open {
                others[k].ln_hz += around[k] * (2.0 * mixed(list, k) - 1.0);
            }
            let fitted = samples.iter().filter_map(|sample| sample.best(model, &others, reach, bounds));
            random.push(fitted.fold(f64::INFINITY, |least, best| least.min(best.chi2)));
        }
        random.sort_by(f64::total_cmp);
    }
    let statics = model.observations.iter().filter(|observation| observation.subject.is_static()).count();
    Ok(Assigning {
        open: open.len(),
        crowded,
        own,
        own_degrees: (targets.len() + statics + model.prior_count()).saturating_sub(model.unknowns.len()),
        random,
        other,
        exchanges,
    })
}

/// Values of the unknowns at a point, in words.
fn in_words(model: &IdentifiedModel<'_>, x: &[f64]) -> String {
    let values = model.unknowns.iter().zip(model.values(x));
    let values = values.map(|(unknown, value)| format!("{} = {}", unknown.path, significant(value, 4)));
    values.collect::<Vec<_>>().join(", ")
}

impl Assigning {
    /// Number of random lists that fit at least as well as the measured one.
    pub(crate) fn as_good(&self) -> usize {
        self.random.iter().filter(|random| **random <= self.own).count()
    }

    /// Median of χ² per degree of freedom after fits to random frequencies.
    pub(crate) fn random_chi2_per_degree(&self) -> Option<f64> {
        let median = self.random.get(self.random.len() / 2).filter(|median| median.is_finite())?;
        Some(median / self.own_degrees.max(1) as f64)
    }

    /// Reasons why the assignment is not determined; none if it is.
    pub(crate) fn doubts(
        &self,
        model: &IdentifiedModel<'_>,
        best: &Minimum,
        judged: &Judged,
        is_noise_given: bool,
    ) -> Vec<String> {
        let mut doubts = Vec::new();
        let lists = self.random.len();
        if self.own_degrees == 0 {
            doubts.push("there are no more measurements than values, so that every assignment fits".to_owned());
        } else if self.as_good() as f64 > MAX_AS_GOOD * lists as f64 {
            doubts.push(format!("{} of {lists} lists of random frequencies fit as well", self.as_good()));
        }
        let is_away = |x: &[f64]| {
            let values = judged.deviations.iter().zip(x).zip(&best.x);
            values.into_iter().any(|((deviation, x), best)| {
                deviation.is_some_and(|deviation| (x - best).abs() > NORMAL_95 * deviation)
            })
        };
        let told = |x: &[f64]| in_words(model, x);
        let is_possible = |chi2: f64, best: f64, degrees: usize| {
            if is_noise_given {
                (best - chi2) / (2.0 * judged.factor * judged.factor) > POSSIBLE.ln()
            } else {
                0.5 * degrees as f64 * (best / chi2).ln() > POSSIBLE_IF_ASSUMED.ln()
            }
        };
        let other = self.other.as_ref().filter(|other| is_possible(other.chi2, best.chi2(), judged.degrees));
        if let Some(other) = other.filter(|other| is_away(&other.x)) {
            doubts.push(format!(
                "other modes fit with χ² = {}, not {}, and {}",
                significant(other.chi2, 3),
                significant(best.chi2(), 3),
                told(&other.x)
            ));
        }
        let exchange = (self.exchanges.iter())
            .filter(|other| is_possible(other.chi2, self.own, self.own_degrees) && is_away(&other.x))
            .min_by(|a, b| a.chi2.total_cmp(&b.chi2));
        if let Some(other) = exchange {
            doubts.push(format!(
                "{} Hz fits mode {} as well, with {}",
                significant(other.ln_hz.exp(), 5),
                other.mode + 1,
                told(&other.x)
            ));
        }
        if !doubts.is_empty() && self.crowded > 0 {
            doubts.push(format!(
                "{} of them {} several modes within {CROWDED} deviations",
                self.crowded,
                if self.crowded == 1 { "has" } else { "have" }
            ));
        }
        doubts
    }

    /// Sentence on doubts.
    pub(crate) fn warning(&self, doubts: &[String]) -> Option<String> {
        (!doubts.is_empty()).then(|| {
            format!(
                "the assignment to modes is not determined for {} without a number: {}. No deviations and intervals \
                 are given; number the modes (column `label`), fit fewer values, \
                 or measure more frequencies more accurately",
                counted(self.open, "frequency").replace("frequencys", "frequencies"),
                doubts.join("; ")
            )
        })
    }
}
