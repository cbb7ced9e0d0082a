//! Search for the best values, with every choice of the sides of a band to avoid.

use super::at_poses::RobotAtPoses;
use super::band::{self, BandCounts, Sides, SidesTried};
use super::rows::{DemandKind, Evaluated};
use crate::Watch;
use crate::request::DesignRequest;
use funicular::math::max_min::{self, Evaluation, Found, MET, MaxMinProblem, Settings};

/// Gain of a step, relative to the value, below which the search ends.
pub(super) const TOLERANCE: f64 = 1e-5;

/// Minimum share of a pose in the optimum, and of a multiplier in the largest one; smaller ones are rounding.
pub(super) const RELEVANT: f64 = 1e-6;

/// True if the band to avoid limits a result, or if demands are not met.
fn is_limited_by_band(found: &Found, poses: &RobotAtPoses<'_>) -> bool {
    let Ok(there) = poses.evaluate(&found.x, &[]) else { return false };
    let mut multipliers = there.demands.iter().zip(&found.demand_multipliers);
    found.violation > MET || multipliers.any(|(kind, multiplier)| *kind == DemandKind::Band && *multiplier > RELEVANT)
}

/// DesignSearch with its progress.
pub(super) struct DesignSearch<'a> {
    poses: &'a RobotAtPoses<'a>,
    watch: &'a mut dyn Watch,
    /// Maximum number of iterations of all searches.
    total: usize,
    /// Number of iterations of the searches that have ended.
    done: usize,
    /// 1 for a goal to maximise, −1 for a goal to minimise.
    sign: f64,
    /// Sides of the band to which the frequencies go.
    sides: Sides,
    /// Value of the goal after each iteration.
    history: Vec<f64>,
    /// Reason for which the last refused point had no results.
    refusal: Option<anyhow::Error>,
    /// Functions at the start, which are known.
    first: Option<Evaluation>,
}

/// Result of a search.
pub(super) struct SearchResult {
    pub(super) found: Found,
    pub(super) sides: Sides,
    pub(super) history: Vec<f64>,
    pub(super) refusal: Option<anyhow::Error>,
}

/// Searches by several choices of the sides of a band.
pub(super) struct Tried {
    /// All choices, if there were several.
    pub(super) sides: Vec<SidesTried>,
    /// Number of choices that were left out.
    pub(super) left_out: usize,
    /// Number of evaluated robots of all searches.
    pub(super) evaluations: usize,
}

impl<'a> DesignSearch<'a> {
    /// Search that has not begun. `first` are the functions at the start.
    pub(super) fn new(
        request: &DesignRequest,
        poses: &'a RobotAtPoses<'a>,
        watch: &'a mut dyn Watch,
        first: Evaluation,
    ) -> Self {
        Self {
            poses,
            watch,
            total: request.max_iterations,
            done: 0,
            sign: request.goal.sign(),
            sides: Sides::new(),
            history: Vec::new(),
            refusal: None,
            first: Some(first),
        }
    }

    /// Searches from the start; `None` if it has no results.
    pub(super) fn run(&mut self, start: &[f64], settings: &Settings) -> Option<SearchResult> {
        let found = max_min::maximise(self, start, settings)?;
        self.done += found.iterations;
        let (history, refusal) = (std::mem::take(&mut self.history), self.refusal.take());
        Some(SearchResult { found, sides: std::mem::take(&mut self.sides), history, refusal })
    }
}

/// Searches again with other sides for the frequencies that are in the band at the start, if the band limits the result
/// of the nearer sides or is not avoided there; keeps the best result.
pub(super) fn try_other_sides(
    nearer: SearchResult,
    before: &Evaluated,
    search: &mut DesignSearch<'_>,
    (start, settings): (&[f64], &Settings),
) -> (SearchResult, Tried) {
    let mut tried = Tried { sides: Vec::new(), left_out: 0, evaluations: nearer.found.evaluations };
    let counts: Vec<BandCounts> = before.poses.iter().filter_map(|pose| pose.band_counts).collect();
    let (choices, left_out) = band::others(&counts);
    if choices.is_empty() || search.is_cancelled() || !is_limited_by_band(&nearer.found, search.poses) {
        return (nearer, tried);
    }
    tried.left_out = left_out;
    search.total *= 1 + choices.len();

    let sign = search.sign;
    tried.sides.push(nearer.tried_row(sign, counts.iter().map(|of| of.nearer_below).collect()));
    let (mut best, mut chosen) = (nearer, 0);
    for sides in choices {
        if search.is_cancelled() {
            break;
        }
        let below = sides.iter().zip(&counts).map(|(number, of)| number.unwrap_or(of.nearer_below)).collect();
        search.sides = sides;
        let Some(other) = search.run(start, settings) else { continue };
        tried.evaluations += other.found.evaluations;
        tried.sides.push(other.tried_row(sign, below));
        if other.is_better_than(&best) {
            (best, chosen) = (other, tried.sides.len() - 1);
        }
    }
    tried.sides[chosen].is_chosen = true;
    (best, tried)
}

impl SearchResult {
    /// True if all demands are met.
    pub(super) fn is_met(&self) -> bool {
        self.found.violation <= MET
    }

    /// True if this result is better than another one: a result that meets all demands is better than one that does
    /// not.
    fn is_better_than(&self, other: &Self) -> bool {
        match (self.is_met(), other.is_met()) {
            (true, true) => self.found.value > other.found.value,
            (is_met, was_met) => is_met && !was_met,
        }
    }

    /// Row of the table of choices. `below` is the number of frequencies below the band, one entry per pose.
    fn tried_row(&self, sign: f64, below: Vec<usize>) -> SidesTried {
        SidesTried { below, after: self.is_met().then_some(sign * self.found.value), is_chosen: false }
    }
}

impl MaxMinProblem for DesignSearch<'_> {
    fn evaluate(&mut self, x: &[f64]) -> Option<Evaluation> {
        if let Some(first) = self.first.take() {
            return Some(first);
        }
        match self.poses.evaluate(x, &self.sides) {
            Ok(found) => Some(found.evaluation),
            Err(error) => {
                self.refusal = Some(error);
                None
            }
        }
    }

    fn is_cancelled(&self) -> bool {
        self.watch.is_cancelled()
    }

    fn progress(&mut self, iteration: usize, value: f64) {
        self.history.push(self.sign * value);
        self.watch.progress(self.done + iteration, self.total, "iterations");
    }
}
