//! Weak combinations: the directions in which rows determine the unknowns worst, as motions that have names.

use super::frame::CalibrationFrame;
use super::{Calibration, CalibrationFit, CalibrationPrecision, CalibrationUnknown};
use crate::math::{DMat, DVec, Vec3};

/// Share of a combination above which named motions stand for it.
const NAMED_SHARE: f64 = 0.95;

/// Number of single unknowns that stand for a combination without named motions.
const SINGLE: usize = 3;

/// Part of the lengths in a direction up to which it is one of factors alone.
const PURE_FACTORS: f64 = 1e-6;

/// Motion or number that a weak combination consists of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CombinationPart {
    /// All anchors apart along a direction [m/m].
    Stretch {
        /// Unit vector, world axes.
        along_w: Vec3,
    },
    /// Shear of the anchors between two directions [m/m].
    Shear {
        /// Unit vectors, world axes.
        between_w: [Vec3; 2],
    },
    /// All offsets together [m].
    CommonOffset,
    /// Offset of a cable, and its anchor farther away by as much [m].
    OffsetWithAnchor {
        /// Index of the cable.
        cable: usize,
    },
    /// Scale of all readings, times a length [m].
    ScaleOfReadings,
    /// Factor of stiffness, mass or supports, relative change [1].
    Factor {
        /// Index of the unknown.
        unknown: usize,
    },
    /// One unknown by itself [m].
    Single {
        /// Index of the unknown.
        unknown: usize,
    },
}

/// Combination of unknowns that the rows determine worst.
#[derive(Debug, Clone)]
pub struct WeakCombination {
    /// Standard deviation along the direction, of its lengths together [m].
    pub deviation: f64,
    /// Direction over all unknowns, unit vector of its lengths, in the inner frame; a factor stands there with the
    /// metres for which it counts.
    pub direction: Vec<f64>,
    /// Parts with their amounts for one deviation.
    pub parts: Vec<(CombinationPart, f64)>,
    /// Share of the parts in the direction, 0 to 1.
    pub share: f64,
}

impl Calibration {
    /// Weakest combinations of a fit, the weakest first, at most `count`. Each factor of stiffness, mass or supports
    /// has the weight of a length of mean deviation, so that its unit does not decide.
    pub fn weak_combinations(
        &self,
        fit: &CalibrationFit,
        frame: &CalibrationFrame,
        precision: &CalibrationPrecision,
        count: usize,
    ) -> Vec<WeakCombination> {
        let mut covariance = frame.inner(&precision.covariance);
        let sizes = self.natural_sizes(&covariance);
        for (k, size) in sizes.iter().enumerate() {
            covariance.row_mut(k).scale_mut(*size);
            covariance.column_mut(k).scale_mut(*size);
        }
        let eigen = covariance.symmetric_eigen();
        let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
        order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
        let combination = |&k: &usize| {
            let deviation = eigen.eigenvalues[k].max(0.0).sqrt();
            self.combination(fit, frame, (&eigen.eigenvectors.column(k).into_owned(), &sizes), deviation)
        };
        order.iter().take(count.min(frame.free_count())).map(combination).collect()
    }

    /// Combination of a direction with its parts.
    pub fn combination_of(&self, fit: &CalibrationFit, frame: &CalibrationFrame, direction: &[f64]) -> WeakCombination {
        let inner = frame.inner_projection() * DVec::from_column_slice(direction);
        let size = inner.norm();
        let direction = if size > 0.0 { inner / size } else { DVec::from_column_slice(direction) };
        self.combination(fit, frame, (&direction, &vec![1.0; direction.len()]), 1.0)
    }

    fn combination(
        &self,
        fit: &CalibrationFit,
        frame: &CalibrationFrame,
        (direction, sizes): (&DVec, &[f64]),
        deviation: f64,
    ) -> WeakCombination {
        let named = self.named_motions(fit, frame);
        let mut best: (f64, Vec<(CombinationPart, f64)>) = (0.0, Vec::new());
        let singles = (0..named.len()).map(|a| vec![a]);
        let pairs = (0..named.len()).flat_map(|a| (a + 1..named.len()).map(move |b| vec![a, b]));
        for chosen in singles.chain(pairs) {
            // A second motion has to explain something that one alone does not.
            if chosen.len() == 2 && best.0 > NAMED_SHARE && best.1.len() == 1 {
                break;
            }
            let columns: Vec<DVec> = chosen.iter().map(|&k| named[k].1.clone()).collect();
            let columns = DMat::from_columns(&columns);
            let Ok(amounts) = columns.clone().svd(true, true).solve(direction, 1e-9) else { continue };
            let share = 1.0 - (direction - &columns * &amounts).norm_squared();
            if share > best.0 {
                let parts = chosen.iter().zip(amounts.iter()).map(|(&k, amount)| (named[k].0, amount * deviation));
                best = (share, parts.collect());
            }
        }

        let (share, mut parts) = if best.0 > NAMED_SHARE { best } else { self.largest_numbers(direction, deviation) };
        for (part, amount) in &mut parts {
            if let CombinationPart::Factor { unknown } = part {
                *amount /= sizes[*unknown] * self.scale_length;
            }
        }
        let lengths = (0..direction.len()).filter(|&k| self.is_length(k)).map(|k| direction[k] * direction[k]);
        let part = lengths.sum::<f64>().sqrt();
        let part = if part > PURE_FACTORS { part } else { 1.0 };
        let direction = (direction / part).as_slice().to_vec();
        WeakCombination { deviation: part * deviation, direction, parts, share }
    }

    /// The largest numbers of a direction.
    fn largest_numbers(&self, direction: &DVec, deviation: f64) -> (f64, Vec<(CombinationPart, f64)>) {
        let mut order: Vec<usize> = (0..direction.len()).collect();
        order.sort_by(|a, b| direction[*b].abs().total_cmp(&direction[*a].abs()));
        order.truncate(SINGLE);
        let share = order.iter().map(|&k| direction[k] * direction[k]).sum();
        let part = |unknown: usize| (self.single(unknown), direction[unknown] * deviation);
        (share, order.into_iter().map(part).collect())
    }

    fn single(&self, unknown: usize) -> CombinationPart {
        if self.is_length(unknown) { CombinationPart::Single { unknown } } else { CombinationPart::Factor { unknown } }
    }

    /// Motions that have names, in the inner frame.
    fn named_motions(&self, fit: &CalibrationFit, frame: &CalibrationFrame) -> Vec<(CombinationPart, DVec)> {
        let at = self.robot_at(&fit.values);
        let anchors: Vec<Vec3> = at.robot.cables.iter().map(|cable| cable.anchor.point_w).collect();
        let middle = anchors.iter().sum::<Vec3>() / anchors.len().max(1) as f64;
        let poses = fit.poses.iter().map(|pose| pose.position_w).sum::<Vec3>() / fit.poses.len().max(1) as f64;
        let has = |of: CalibrationUnknown| self.position_of(&of).is_some();
        let field = |anchor: &dyn Fn(usize) -> Vec3, offset: &dyn Fn(usize) -> f64, scale: f64| {
            DVec::from_fn(self.unknowns.len(), |k, _| match self.unknowns[k] {
                CalibrationUnknown::Anchor { cable, axis } => anchor(cable)[axis],
                CalibrationUnknown::Offset { cable } => offset(cable),
                CalibrationUnknown::Scale => scale,
                _ => 0.0,
            })
        };
        let (still, none) = (|_: usize| Vec3::zeros(), |_: usize| 0.0);

        let directions = self.translations_w();
        let mut motions = Vec::new();
        for (n, &along_w) in directions.iter().enumerate() {
            let stretch = |i: usize| along_w * along_w.dot(&(anchors[i] - middle));
            motions.push((CombinationPart::Stretch { along_w }, field(&stretch, &none, 0.0)));
            for &other in &directions[n + 1..] {
                let shear = |i: usize| {
                    let from = anchors[i] - middle;
                    along_w * other.dot(&from) + other * along_w.dot(&from)
                };
                motions.push((CombinationPart::Shear { between_w: [along_w, other] }, field(&shear, &none, 0.0)));
            }
        }
        if has(CalibrationUnknown::Offset { cable: 0 }) {
            motions.push((CombinationPart::CommonOffset, field(&still, &|_| 1.0, 0.0)));
        }
        for (cable, anchor) in anchors.iter().enumerate() {
            if let Some(along) = (anchor - poses).try_normalize(f64::MIN_POSITIVE)
                && has(CalibrationUnknown::Offset { cable })
            {
                let moves = |i: usize| if i == cable { along } else { Vec3::zeros() };
                let one = |i: usize| if i == cable { 1.0 } else { 0.0 };
                motions.push((CombinationPart::OffsetWithAnchor { cable }, field(&moves, &one, 0.0)));
            }
        }
        if has(CalibrationUnknown::Scale) {
            motions.push((CombinationPart::ScaleOfReadings, field(&still, &none, 1.0)));
        }
        let factors = (0..self.unknowns.len()).filter(|&k| !self.is_length(k));
        motions.extend(factors.map(|k| {
            (self.single(k), DVec::from_fn(self.unknowns.len(), |other, _| if other == k { 1.0 } else { 0.0 }))
        }));

        let project = frame.inner_projection();
        motions
            .into_iter()
            .map(|(part, motion)| (part, &project * motion))
            .filter(|(_, motion)| motion.norm() > 1e-9)
            .collect()
    }
}
