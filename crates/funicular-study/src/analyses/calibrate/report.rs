//! Results of a calibration from its minima.

use super::choice::{all_chosen, proposed_for};
use super::rows::{
    CableResidual, CalibratedValue, DistanceRow, LeftOut, MinimumRow, ProposalRow, Reachable, ReadingRow, ToolPoses,
    Walk, WeakRow,
};

use super::wrong::{self, FoundFit, Wrong};
use super::{Calibrated, in_mm, is_for_tool, words};
use crate::Watch;
use crate::analyses::candidate_poses::Candidates;
use crate::analyses::profile::Profile;
use crate::normal::NOISE_DEVIATIONS;
use crate::quantiles::{chi2_above, student_95};
use crate::request::{CalibrateRequest, RobotText};
use crate::set_values;
use crate::text::{counted, significant};
use anyhow::{Result, anyhow};
use funicular::calibration::{
    Calibration, CalibrationFit, CalibrationFrame, CalibrationPrecision, CalibrationSearch, OtherMinimum, ProposalAim,
    WeakWalk, proposals,
};
use funicular::math::{DMat, Vec3, rotation};
use funicular::robot::Pose;

/// Number of weak combinations that are reported.
const WEAK: usize = 3;

/// Minimum factor of the deviations with which the walk along the weakest combination is more than rounding.
const MIN_FACTOR: f64 = 1e-6;

/// χ² per degree of freedom above which values mean nothing: residuals are three times as large as their deviations.
const MISFIT: f64 = 10.0;

/// Rise of χ² of another minimum below which the readings do not choose: three deviations of noise.
const UNDECIDED: f64 = 9.0;

/// Largest number of proposed poses while a wanted deviation is looked for.
pub(super) const MAX_PROPOSALS: usize = 100;

/// Minima, precision and what the results need beside them.
pub(super) struct CalibrationReport<'a> {
    pub(super) request: &'a CalibrateRequest,
    pub(super) of: &'a Calibration,
    /// Numbers of the rows in their table, from 1.
    pub(super) numbers: &'a [usize],
    pub(super) frame: CalibrationFrame,
    pub(super) found: &'a CalibrationSearch,
    pub(super) precision: CalibrationPrecision,
    /// Deviations of the data are multiplied by this factor; `None` if nothing tells them.
    pub(super) factor: Option<f64>,
    /// Factor of a deviation whose interval holds 95 %.
    quantile: f64,
    pub(super) paths: Vec<(String, &'static str)>,
    /// Candidates of a proposal.
    poses: Vec<Pose>,
    /// Poses at which the accuracy of the tool is asked for.
    pub(super) tool_at: Vec<Pose>,
    /// True for an unknown whose profile is wanted.
    profiled: Vec<bool>,
    /// True for an unknown whose deviation a proposal reduces.
    proposed_for: Vec<bool>,
    source: &'a RobotText,
    /// Rows and columns that are wrong.
    pub(super) wrong: Wrong,
}

impl<'a> CalibrationReport<'a> {
    pub(super) fn new(
        request: &'a CalibrateRequest,
        of: &'a Calibration,
        numbers: &'a [usize],
        frame: &CalibrationFrame,
        found: &'a CalibrationSearch,
        [candidates, tool]: [&Candidates; 2],
    ) -> Result<Self> {
        let fit = &found.best;
        let frame = of.frame_about(frame, fit);
        let precision = of.precision(fit, &frame);
        let degrees = precision.degrees;
        let ratio = (fit.chi2 / degrees.max(1) as f64).sqrt();
        let spread = NOISE_DEVIATIONS * (2.0 / degrees.max(1) as f64).sqrt();
        let (factor, quantile) = match request.length_std_m {
            Some(_) if degrees > 0 && ratio * ratio > 1.0 + spread => (Some(ratio), student_95(degrees)),
            Some(_) => (Some(1.0), student_95(usize::MAX)),
            None => ((degrees > 0).then_some(ratio), student_95(degrees)),
        };
        let middle = middle(&fit.poses);
        let mut report = Self {
            wrong: Wrong::default(),
            request,
            of,
            numbers,
            found,
            factor,
            quantile: quantile.unwrap_or(f64::NAN),
            paths: of.unknowns.iter().map(|unknown| words::path(&of.robot, unknown)).collect(),
            poses: candidates.poses(&of.robot, &middle)?,
            tool_at: tool.poses(&of.robot, &middle)?,
            profiled: all_chosen("profile", &request.profile, &of.unknowns, &of.robot)?,
            proposed_for: proposed_for(request, &of.unknowns, &of.robot)?,
            source: &request.robot,
            frame,
            precision,
        };
        report.wrong = wrong::found(&report.judged());
        Ok(report)
    }

    /// Best fit with what judges its rows.
    pub(super) fn judged(&self) -> FoundFit<'_> {
        FoundFit {
            of: self.of,
            fit: &self.found.best,
            frame: &self.frame,
            precision: &self.precision,
            is_noise_known: self.request.length_std_m.is_some(),
            variance: self.variance(),
        }
    }

    fn fit(&self) -> &CalibrationFit {
        &self.found.best
    }

    pub(super) fn names(&self) -> Vec<String> {
        self.paths.iter().map(|(path, _)| path.clone()).collect()
    }

    /// All results.
    ///
    /// # Errors
    /// Work that was stopped, or a robot file that cannot be written.
    pub(super) fn results(&self, watch: &mut dyn Watch) -> Result<Calibrated> {
        let walk = self.walk();
        let is_parabola = walk.as_ref().is_none_or(WeakWalk::is_parabola);
        let is_one = !self.fits_otherwise();
        let is_determined =
            is_parabola && is_one && !self.is_misfit() && self.precision.lost.is_empty() && self.factor.is_some();
        let profiles = if self.is_misfit() { Vec::new() } else { self.profiles(&self.profiled, watch)? };
        let values = self.values(is_parabola && is_one && !self.is_misfit(), profiles);
        let rows = self.rows();
        let weak = self.weak();
        let inner = self.frame.inner(&self.precision.covariance);
        let has_lengths = (0..self.paths.len()).any(|k| self.of.is_length(k));
        let root = |covariance: &DMat| Some(self.factor? * self.of.total_of_lengths(covariance));
        let is_known = self.precision.lost.is_empty();
        let tool = self.tool_poses(watch)?;
        let (proposals, poses_needed, left_out) = self.proposals(tool.as_ref(), watch)?;
        let residuals: Vec<f64> = rows.iter().flat_map(|row| row.residuals.iter().map(|of| of.residual_m)).collect();
        let squares: f64 = residuals.iter().map(|residual| residual * residual).sum();
        Ok(Calibrated {
            robot: self.of.robot.name.clone(),
            fit: self.fit_sentence((squares / residuals.len().max(1) as f64).sqrt()),
            determined: self.determined_sentence(&values, &weak, walk.as_ref()),
            is_determined,
            frame: words::frame(&self.of.robot, &self.frame),
            distances: self.distances(),
            anchors: self.anchors(weak.first().and_then(|row| Some((row.direction.as_slice(), row.deviation_m?)))),
            axes: self.of.axes(),
            linear: self.linear_rows(),
            weak_combinations: weak,
            minima: self.minima(),
            chi2: self.fit().chi2,
            data: self.of.rows.iter().map(|row| self.of.data_count(row)).sum(),
            degrees_of_freedom: self.precision.degrees,
            residual_rms_m: (squares / residuals.len().max(1) as f64).sqrt(),
            length_std_m: self.factor.map(|factor| factor * self.of.deviations.reading),
            total_m: root(&self.precision.covariance).filter(|_| is_known && has_lengths),
            inner_total_m: root(&inner).filter(|_| is_known && has_lengths),
            weakest_m: self
                .factor
                .filter(|_| is_known && has_lengths)
                .map(|factor| factor * self.of.weakest_of_lengths(&self.precision.covariance)),
            turns: !self.of.is_point(),
            starts: self.found.starts,
            arrivals: self.found.arrivals,
            iterations: self.fit().iterations,
            robot_file: self.robot_file()?,
            covariance: self.covariance(),
            warnings: Vec::new(),
            values,
            rows,
            walk: walk.map(|walk| walk_row(&walk)),
            proposals,
            accuracy: tool.and_then(|tool| self.accuracy(&tool)),
            left_out,
            poses_needed,
        })
    }

    /// True if the readings miss the model so far that no value means anything.
    pub(super) fn is_misfit(&self) -> bool {
        let degrees = self.precision.degrees;
        self.request.length_std_m.is_some() && degrees > 0 && self.fit().chi2 > MISFIT * degrees as f64
    }

    /// Variance of the residuals over that of the data.
    pub(super) fn variance(&self) -> f64 {
        self.factor.unwrap_or(1.0).max(MIN_FACTOR).powi(2)
    }

    /// Variance of the residuals over that of the data, and the factor of a deviation whose interval holds 95 %; `None`
    /// if nothing tells them.
    pub(super) fn noise(&self) -> Option<(f64, f64)> {
        self.factor.filter(|factor| *factor > MIN_FACTOR && self.quantile.is_finite())?;
        Some((self.variance(), self.quantile))
    }

    /// Rise of χ² of another minimum, in the variance of the residuals.
    fn rise(&self, other: &CalibrationFit) -> f64 {
        (other.chi2 - self.fit().chi2) / self.variance()
    }

    /// True if another minimum fits so well that the readings do not choose between them.
    pub(super) fn fits_otherwise(&self) -> bool {
        self.found.others.iter().any(|other| self.rise(&other.fit) < UNDECIDED)
    }

    fn walk(&self) -> Option<WeakWalk> {
        let factor = self.factor.filter(|factor| *factor > MIN_FACTOR)?;
        if !self.precision.lost.is_empty() || self.is_misfit() {
            return None;
        }
        self.of.weak_walk(self.fit(), &self.frame, &self.precision, factor)
    }

    fn values(&self, has_intervals: bool, mut profiles: Vec<Option<Profile>>) -> Vec<CalibratedValue> {
        let start = self.of.start();
        let deviations = self.precision.deviations();
        let inner = self.frame.inner(&self.precision.covariance);
        let lost: Vec<bool> = (0..start.len())
            .map(|k| self.precision.lost.iter().any(|direction| direction[k].abs() > LOST_PART))
            .collect();
        profiles.resize(start.len(), None);
        let value = |(k, profile): (usize, Option<Profile>)| {
            let [value, unit] = self.of.meaning(k, self.fit().values[k]);
            let held = self.frame.holds(k);
            let known = |deviation: f64| self.factor.filter(|_| !lost[k]).map(|factor| factor * deviation * unit);
            let deviation = known(deviations[k]).filter(|_| !held);
            let reach = deviation.filter(|_| has_intervals).map(|deviation| self.quantile * deviation);
            CalibratedValue {
                path: self.paths[k].0.clone(),
                unit: self.paths[k].1,
                start: self.of.meaning(k, start[k])[0],
                value,
                held,
                deviation,
                interval_95: reach.filter(|reach| reach.is_finite()).map(|reach| [value - reach, value + reach]),
                inner_deviation: known(inner[(k, k)].max(0.0).sqrt()),
                prior: self.of.prior_of(k).map(|(value, _)| value),
                prior_deviation: self.of.prior_of(k).map(|(_, deviation)| deviation),
                profile,
            }
        };
        profiles.into_iter().enumerate().map(value).collect()
    }

    fn distances(&self) -> Vec<DistanceRow> {
        let name = |cable: usize| self.of.robot.cables[cable].name.clone();
        let is_known = self.precision.lost.is_empty();
        let distances = self.of.anchor_distances(self.fit(), &self.precision);
        distances
            .iter()
            .map(|of| DistanceRow {
                first: name(of.cables[0]),
                second: name(of.cables[1]),
                distance_m: of.distance,
                deviation_m: self.factor.filter(|_| is_known).map(|factor| factor * of.deviation),
            })
            .collect()
    }

    fn rows(&self) -> Vec<ReadingRow> {
        let left_out = self.precision.rows_left_out(&self.frame);
        let residuals = self.of.residuals_of(self.fit());
        let scale = self.variance();
        let count = self.of.rows.len();
        let row = |j: usize| {
            let (measured, pose, left_out) = (&self.of.rows[j], &self.fit().poses[j], &left_out[j]);
            let read = self.of.robot.cables.iter().zip(&measured.readings).filter(|(_, reading)| reading.is_some());
            let residuals = read
                .zip(&residuals[j])
                .map(|((cable, _), residual)| CableResidual { cable: cable.name.clone(), residual_m: *residual });
            let limit = chi2_above(wrong::OUTLIER / count as f64, left_out.degrees.max(1));
            let drop = left_out.chi2_drop.map(|drop| drop / scale);
            ReadingRow {
                row: self.numbers[j],
                position_m: pose.position_w.into(),
                roll_pitch_yaw_deg: rotation::to_roll_pitch_yaw_deg(&pose.rot_wp),
                residuals: residuals.collect(),
                chi2_drop: drop,
                chi2_limit: limit,
                shift_m: drop.map(|_| self.largest_length(&left_out.shift)),
                outlier: drop.is_some_and(|drop| drop > limit) && self.precision.degrees > left_out.degrees,
            }
        };
        let mut rows: Vec<ReadingRow> = (0..count).map(row).collect();

        // A wrong row drags the fit, whose linearisation blames others: what fits without it say counts.
        if !self.wrong.rows.is_empty() {
            for row in &mut rows {
                row.outlier = false;
            }
        }
        for wrong in &self.wrong.rows {
            let moved: Vec<f64> = self.fit().values.iter().zip(&wrong.values).map(|(a, b)| a - b).collect();
            let row = &mut rows[wrong.row];
            row.outlier = true;
            row.chi2_drop = Some(wrong.chi2_drop / wrong::variance(&self.judged(), wrong));
            row.chi2_limit = wrong::limit_of(&self.judged(), wrong);
            row.shift_m = Some(self.largest_length(&moved));
        }
        rows
    }

    /// Largest of changes of the values that are lengths.
    fn largest_length(&self, changes: &[f64]) -> f64 {
        let lengths = changes.iter().enumerate().filter(|(k, _)| self.of.is_length(*k));
        lengths.fold(0.0, |most, (_, change)| most.max(change.abs()))
    }

    fn weak(&self) -> Vec<WeakRow> {
        let (robot, names) = (&self.of.robot, self.names());
        if !self.precision.lost.is_empty() {
            let lost = self.precision.lost.iter().take(WEAK).map(|direction| {
                let of = self.of.combination_of(self.fit(), &self.frame, direction);
                let words = words::lost(robot, &names, &of);
                WeakRow { deviation_m: None, share: of.share, words, direction: of.direction }
            });
            return lost.collect();
        }
        let has_lengths = (0..self.paths.len()).any(|k| self.of.is_length(k));
        let Some(factor) = self.factor.filter(|_| has_lengths) else { return Vec::new() };
        let weak = self.of.weak_combinations(self.fit(), &self.frame, &self.precision, WEAK);
        let row = |mut of: funicular::calibration::WeakCombination| {
            of.deviation *= factor;
            of.parts.iter_mut().for_each(|(_, amount)| *amount *= factor);
            let words = words::combination(robot, &names, &of);
            WeakRow { deviation_m: Some(of.deviation), share: of.share, words, direction: of.direction }
        };
        weak.into_iter().map(row).collect()
    }

    fn minima(&self) -> Vec<MinimumRow> {
        let best = self.fit();
        let row = |OtherMinimum { fit: other, mirrored }: &OtherMinimum| {
            let apart: Vec<f64> = best.values.iter().zip(&other.values).map(|(a, b)| a - b).collect();
            let distance = |j: usize| {
                let (a, b) = (&best.poses[j], &other.poses[j]);
                (a.position_w - b.position_w).norm() + self.of.robot.platform_length() * a.rot_wp.angle_to(&b.rot_wp)
            };
            let row = (0..best.poses.len()).max_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or(0);
            MinimumRow {
                chi2: other.chi2,
                values: other.values.iter().enumerate().map(|(k, value)| self.of.meaning(k, *value)[0]).collect(),
                farthest_m: self.largest_length(&apart),
                mirrored: mirrored.iter().map(|cable| self.of.robot.cables[*cable].name.clone()).collect(),
                row: self.numbers[row],
            }
        };
        self.found.others.iter().map(row).collect()
    }

    /// Proposed poses, the number of them that the wanted deviation needs, and the candidates that were left out.
    fn proposals(
        &self,
        tool: Option<&ToolPoses>,
        watch: &mut dyn Watch,
    ) -> Result<(Vec<ProposalRow>, Option<usize>, Option<LeftOut>)> {
        let Some(factor) = self.factor.filter(|_| !self.poses.is_empty()) else { return Ok((Vec::new(), None, None)) };
        let Reachable { candidates, rules, left_out } = self.reachable(&self.poses, watch)?;
        let weights: Vec<f64> = self.proposed_for.iter().map(|chosen| if *chosen { 1.0 } else { 0.0 }).collect();
        let count = if self.request.wanted_std_m.is_some() { MAX_PROPOSALS } else { self.request.propose };
        let by = (count, self.request.propose_by);
        let for_tool = tool.filter(|_| is_for_tool(self.request));
        let aim = for_tool.map_or(ProposalAim::Unknowns(&weights), ToolPoses::aim);
        let found = proposals(self.of, self.fit(), (&self.frame, &self.precision), &candidates, by, aim);
        // Factors of stiffness and mass are no lengths.
        let has_lengths = (0..weights.len()).any(|k| weights[k] > 0.0 && self.of.is_length(k));
        let row = |(n, of): (usize, &funicular::calibration::ProposedPose)| {
            let pose = &candidates[of.candidate].pose;
            let chosen = (0..weights.len()).filter(|&k| weights[k] > 0.0 && self.of.is_length(k) == has_lengths);
            let largest = chosen.max_by(|a, b| of.deviations[*a].total_cmp(&of.deviations[*b])).unwrap_or(0);
            let name = &self.paths[largest].0;
            let relative = factor * of.deviations[largest] * self.of.meaning(largest, self.fit().values[largest])[1]
                / self.of.meaning(largest, self.fit().values[largest])[0];
            ProposalRow {
                number: n + 1,
                position_m: pose.position_w.into(),
                roll_pitch_yaw_deg: rotation::to_roll_pitch_yaw_deg(&pose.rot_wp),
                readings_m: of.readings.clone(),
                tension_rule: rules[of.candidate],
                total_m: has_lengths.then_some(factor * of.total),
                largest_m: has_lengths.then_some(factor * of.deviations[largest]),
                tool_m: tool.map(|tool| factor * tool.worst(&of.covariance)),
                largest_of: if has_lengths { name.clone() } else { format!("{name} (±{} %)", percent(relative)) },
                deviations: of
                    .deviations
                    .iter()
                    .enumerate()
                    .map(|(k, d)| factor * d * self.of.meaning(k, self.fit().values[k])[1])
                    .collect(),
            }
        };
        let mut rows: Vec<ProposalRow> = found.iter().enumerate().map(row).collect();
        let needed = self.request.wanted_std_m.and_then(|wanted| {
            let largest = |row: &ProposalRow| if for_tool.is_some() { row.tool_m } else { row.largest_m };
            rows.iter().find(|row| largest(row).is_some_and(|largest| largest <= wanted)).map(|row| row.number)
        });
        rows.truncate(needed.unwrap_or(0).max(self.request.propose));
        Ok((rows, needed, left_out))
    }

    /// Sentence on the fit.
    fn fit_sentence(&self, rms: f64) -> String {
        let (chi2, degrees) = (self.fit().chi2, self.precision.degrees);
        let residuals = in_mm(rms);
        if degrees == 0 {
            return format!(
                "The readings fit to {residuals} r.m.s., as they always do: no reading is left to test the model"
            );
        }
        let expected = degrees as f64;
        let spread = (2.0 * expected).sqrt();
        if self.request.length_std_m.is_none() {
            return format!(
                "The readings fit to {residuals} r.m.s.; with {} of freedom this is a deviation of {} for each reading",
                counted(degrees, "degree"),
                in_mm(self.factor.unwrap_or(0.0) * self.of.deviations.reading)
            );
        }
        let fits = if chi2 > expected + NOISE_DEVIATIONS * spread { "do not fit" } else { "fit" };
        format!(
            "The readings {fits} (χ² {}, expected {} ± {}; {residuals} r.m.s.)",
            significant(chi2, 4),
            degrees,
            significant(spread, 2)
        )
    }

    /// Sentence on what the readings determine.
    fn determined_sentence(&self, values: &[CalibratedValue], weak: &[WeakRow], walk: Option<&WeakWalk>) -> String {
        if self.factor.is_none() {
            return "The readings leave nothing that tells their deviation: give ⟪length_std_m⟫, or measure more rows"
                .to_owned();
        }
        if self.is_misfit() {
            return "No value is known as long as the readings do not fit: see the warnings".to_owned();
        }
        if let Some(lost) = weak.first().filter(|row| row.deviation_m.is_none()) {
            return format!("These rows do not determine {}", lost.words);
        }
        let deviations: Vec<f64> = values
            .iter()
            .filter(|row| row.unit == "m" && !is_nearly_held(row))
            .filter_map(|row| row.deviation)
            .collect();
        let weakest = weak.first().map_or_else(String::new, |row| {
            format!("; weakest: {} (±{} together)", row.words, in_mm(row.deviation_m.unwrap_or_default()))
        });
        let relative = values.iter().enumerate().filter(|(k, _)| !self.of.is_length(*k));
        let factors = relative
            .filter_map(|(_, row)| Some(format!("the {} to ±{} %", row.path, percent(row.deviation? / row.value))));
        let lengths = (!deviations.is_empty()).then(|| words::range_mm(&deviations));
        let known = lengths.into_iter().chain(factors).collect::<Vec<_>>().join(", ");
        let known = if known.is_empty() { "nothing".to_owned() } else { known };
        if self.fits_otherwise() {
            return format!(
                "Other values fit nearly as well (see the minima); about these ones the values are known to \
                 {known}{weakest}"
            );
        }
        if walk.is_some_and(|walk| !walk.is_parabola()) {
            return format!(
                "The values are not determined, or χ² is curved: {known} by the linearisation{weakest}; a walk along \
                 it does not raise χ² by 1 and 4"
            );
        }
        format!("The values are known to {known}{weakest}")
    }

    /// Robot file with anchors, attachments and radii.
    fn robot_file(&self) -> Result<String> {
        let mut assignments = Vec::new();
        for (k, unknown) in self.of.unknowns.iter().enumerate() {
            if unknown.is_in_file() {
                let path = set_values::path(&self.paths[k].0).map_err(|error| anyhow!("{error}"))?;
                assignments.push(path.with("⟪unknowns⟫", self.fit().values[k]));
            }
        }
        Ok(set_values::apply(&self.source.changed_text()?, &assignments)?)
    }
}

/// Part of one in per cent.
fn percent(part: f64) -> String {
    significant(100.0 * part, 2)
}

/// True for a value that the frame holds but for its direction, as one across a direction that is nearly an axis.
fn is_nearly_held(row: &CalibratedValue) -> bool {
    row.deviation.zip(row.inner_deviation).is_some_and(|(here, inner)| here < NEARLY_HELD * inner)
}

/// Deviation relative to that with inner conditions below which the frame holds a value.
const NEARLY_HELD: f64 = 0.05;

/// Part of a lost direction from which on a value counts as not determined.
const LOST_PART: f64 = 1e-3;

/// Walk along the weakest combination, without steps at which nothing fits.
fn walk_row(walk: &WeakWalk) -> Walk {
    let fitted = walk.steps.iter().zip(&walk.rises).filter(|(_, rise)| rise.is_finite());
    let (deviations, chi2_rises) = fitted.map(|(step, rise)| (*step, *rise)).unzip();
    Walk { deviations, chi2_rises, is_parabola: walk.is_parabola() }
}

/// Mean position of poses, with the orientation of the first.
fn middle(poses: &[Pose]) -> Pose {
    let mean = poses.iter().map(|pose| pose.position_w).sum::<Vec3>() / poses.len().max(1) as f64;
    let first = poses.first().copied().unwrap_or_else(|| Pose::new([0.0; 3], [0.0; 3]));
    Pose { position_w: mean, ..first }
}
