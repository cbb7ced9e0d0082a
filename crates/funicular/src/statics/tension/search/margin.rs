//! Tensions with the maximum distance from the limits: the linear problem of one iteration.

use super::proximal_step::ProximalStep;
use super::{CONVERGED, Linear, TensionSearch};
use crate::math::active_set::Active;
use crate::math::{Vec6, order};
use crate::statics::error::StaticsError;
use crate::statics::limits::Limit;
use crate::statics::tension::feasible_set::{FeasiblePoint, FeasibleSet};

/// Multiplier of a limit, over the largest one, above which the limit holds an optimum; rounding leaves 1e-12.
pub(in crate::statics::tension) const HOLDS: f64 = 1e-9;

/// Tensions with the maximum of the smallest distance from the limits.
pub(super) struct MarginOptimum {
    /// Tensions [N].
    pub(super) tau: Vec<f64>,
    /// Minimum distance from the limits, in units of the widths.
    pub(super) distance: f64,
    /// Minimum distance from the limits [N].
    pub(super) height: f64,
    /// Limits that hold it.
    pub(super) held_by: Vec<(usize, Limit)>,
    /// Multipliers of the balance; zero if the distance is in units of the widths.
    pub(super) multipliers: Vec6,
    /// Tensions with which the cables hang in the linear problem of a minimum violation; below them a cable is
    /// continued by its tangent.
    pub(super) hung: Vec<f64>,
}

impl TensionSearch<'_> {
    /// Maximum of the smallest distance from the limits: over their `widths`, or, without widths, in N and at most
    /// zero.
    ///
    /// With a `climb` the distance grows by a limited amount instead, and the tensions `here` move little.
    pub(super) fn margin_optimum(
        &self,
        linear: &Linear,
        widths: Option<&[f64]>,
        here: &[f64],
        climb: Option<ProximalStep>,
    ) -> Result<MarginOptimum, StaticsError> {
        let solutions = self.solutions_for_feasible_set(linear, &vec![1.0; self.cables.len()])?;
        // The height is in N in both cases.
        let unit = widths.map_or(1.0, |widths| widths.iter().sum::<f64>() / widths.len() as f64);

        let mut feasible = FeasibleSet::new(&solutions, true);
        let rows = self.add_limits(&mut feasible, linear, widths, unit);

        // Highest point.
        let tolerance = self.tolerance(&solutions);
        let found = match (climb, widths) {
            (Some(climb), _) => feasible.nearest(|i| here[i], climb.from + climb.by, tolerance),
            (None, None) => feasible.highest(|i| here[i], tolerance),
            (None, Some(_)) => feasible.highest(|i| 0.5 * (linear.limits[i][0].at + linear.limits[i][1].at), tolerance),
        };

        let Some(FeasiblePoint { sigma: tau, height, held }) = found else {
            // Only the slackest cables can prevent a solution here: they bind more strictly than the limits.
            return match widths {
                Some(_) => self.margin_optimum(linear, None, here, None),
                None => Err(self.not_converged(f64::INFINITY, CONVERGED)),
            };
        };

        // Limits that hold it.
        let strongest = held.iter().fold(0.0, |m: f64, a| m.max(a.multiplier));
        let binds = |held: &Active| (held.multiplier > HOLDS * strongest).then(|| rows[held.row]).flatten();
        let mut held_by: Vec<_> = held.iter().filter_map(binds).collect();
        order::sort_ascending(&mut held_by, |(i, _)| *i as f64);
        let mut multipliers = Vec6::zeros();
        if widths.is_none() {
            let mut pressed = vec![0.0; self.cables.len()];
            for held in &held {
                if let Some((i, limit)) = rows[held.row] {
                    pressed[i] += if limit == Limit::Minimum { held.multiplier } else { -held.multiplier };
                }
            }
            multipliers = solutions.multipliers(|i| -pressed[i]);
        }
        Ok(MarginOptimum { tau, height, distance: height / unit, held_by, multipliers, hung: Vec::new() })
    }

    /// Adds the limits of the linear problem to the set, less the height in proportion to the `widths` over their mean
    /// `unit`; returns the limit of each row.
    fn add_limits(
        &self,
        feasible: &mut FeasibleSet,
        linear: &Linear,
        widths: Option<&[f64]>,
        unit: f64,
    ) -> Vec<Option<(usize, Limit)>> {
        let mut rows = Vec::with_capacity(3 * self.cables.len());
        for (i, [lower, upper]) in linear.limits.iter().enumerate() {
            let width = widths.map_or(1.0, |widths| widths[i] / unit);
            let lower = if widths.is_some() { *lower } else { self.floor(i, *lower) };
            feasible.add(Some(i), 1.0, -width * lower.rate, lower.at);
            rows.push(Some((i, Limit::Minimum)));
            if upper.at.is_finite() {
                feasible.add(Some(i), -1.0, -width * upper.rate, -upper.at);
                rows.push(Some((i, Limit::Maximum)));
            }
            if widths.is_some() {
                feasible.add(Some(i), 1.0, 0.0, self.cables[i].slackest);
                rows.push(None);
            }
        }
        if widths.is_none() {
            feasible.add(None, 1.0, -1.0, 0.0);
            rows.push(None);
        }

        rows
    }
}
