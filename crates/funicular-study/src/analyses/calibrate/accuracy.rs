//! Accuracy of the tool: what the deviations of the calibrated values mean for the platform over a set of poses, and
//! how many further readings halve the worst of them.

use super::report::CalibrationReport;
use super::rows::{LeftOut, Reachable, ToolPoses};
use crate::Watch;
use crate::analyses::fields;
use crate::error::NoSolution;
use crate::rows::rows;
use crate::text::{counted, significant};
use anyhow::{Result, bail};
use funicular::calibration::{CandidatePose, ToolDeviation, ToolRows, proposals};
use funicular::math::chosen_rows::RowCriterion;
use funicular::math::rotation;

/// Largest number of further poses while half of the worst deviation is looked for.
const MAX_HALVING: usize = 60;

/// Number of poses that the sentence on halving names.
const MAX_NAMED: usize = 6;

rows! {
    /// Accuracy of the tool: standard deviations of the platform when the readings of the calibrated values are
    /// commanded.
    pub struct ToolAccuracy {
        pub poses: Vec<ToolRow>;
        /// Largest standard deviation of the position.
        pub worst_m: f64;
        /// Least standard deviation of the position.
        pub best_m: f64;
        /// Further readings that halve the largest standard deviation; absent if no number of poses up to 60 does.
        pub halving: Option<HalvingRow>;
        /// Poses that the robot cannot have.
        pub left_out: Option<LeftOut>;
    }
}

rows! {
    /// Standard deviations of the platform at a pose.
    pub struct ToolRow in tables(turns: bool) {
        /// Position of the platform origin, {}.
        pub position_m: [f64; 3] => each(fields::AXES, "{}_m").components("position", 4);
        /// Roll, pitch, yaw of the platform.
        pub roll_pitch_yaw_deg: [f64; 3] => each(fields::ANGLES, "{}_deg", "{} of the platform")
            .components("roll, pitch, yaw", 3)
            .read_if(turns);
        /// Standard deviation of the position along the direction in which it is largest.
        pub deviation_m: f64
            => one.shown("position ±", "mm", |row, style| style.significant(1e3 * row.deviation_m, 3));
        /// Half width of the interval that holds the position along this direction with 95 %.
        pub within_95_m: f64
            => one.shown("95 % within ±", "mm", |row, style| style.significant(1e3 * row.within_95_m, 3));
        /// Direction of the largest deviation, {}.
        pub direction: [f64; 3] => each(fields::AXES, "direction_{}").components("direction", 2);
        /// Covariance of the position.
        pub covariance_m2: [[f64; 3]; 3];
        /// Standard deviations of roll, pitch and yaw; absent for cables that end in one point.
        pub deviations_deg: Option<[f64; 3]>;
    }
}

rows! {
    /// Further readings that halve the largest standard deviation.
    pub struct HalvingRow {
        /// Number of further poses with readings of all cables.
        pub poses: usize;
        /// Their positions, in the order in which they help most.
        pub positions_m: Vec<[f64; 3]>;
        /// Largest standard deviation of the position then.
        pub worst_m: f64;
    }
}

impl CalibrationReport<'_> {
    /// Poses at which the accuracy is asked for; `None` without such poses, or where readings leave something of the
    /// robot undetermined.
    ///
    /// # Errors
    /// No pose that the robot can have, or work that was stopped.
    pub(super) fn tool_poses(&self, watch: &mut dyn Watch) -> Result<Option<ToolPoses>> {
        if self.tool_at.is_empty() || !self.precision.lost.is_empty() || self.is_misfit() {
            return Ok(None);
        }
        let Reachable { candidates, left_out, .. } = self.reachable(&self.tool_at, watch)?;
        let robot = self.of.robot_at(&self.found.best.values);
        let held = candidates
            .into_iter()
            .filter_map(|pose| Some((self.of.tool_rows(&robot, &pose.pose, &pose.lengths)?, pose)));
        let (rows, poses): (Vec<_>, Vec<_>) = held.unzip();
        if rows.is_empty() {
            bail!(NoSolution(
                "no pose of ⟪accuracy_grid⟫ or ⟪accuracy_poses⟫ is held by its readings with tensions within the \
                 limits: give other poses, or limits"
                    .to_owned()
            ));
        }
        Ok(Some(ToolPoses { poses, rows, left_out }))
    }

    /// Accuracy at these poses; `None` if nothing tells the deviation of a reading.
    pub(super) fn accuracy(&self, tool: &ToolPoses) -> Option<ToolAccuracy> {
        let (variance, quantile) = self.noise()?;
        let factor = variance.sqrt();
        let row = |(pose, rows): (&CandidatePose, &ToolRows)| {
            let ToolDeviation { position, direction_w, covariance_w, angles } =
                rows.deviation(&self.precision.covariance);
            ToolRow {
                position_m: pose.pose.position_w.into(),
                roll_pitch_yaw_deg: rotation::to_roll_pitch_yaw_deg(&pose.pose.rot_wp),
                deviation_m: factor * position,
                within_95_m: quantile * factor * position,
                direction: direction_w.into(),
                covariance_m2: [0, 1, 2].map(|i| [0, 1, 2].map(|j| variance * covariance_w[(i, j)])),
                deviations_deg: angles.map(|angles| angles.map(|angle| (factor * angle).to_degrees())),
            }
        };
        let poses: Vec<ToolRow> = tool.poses.iter().zip(&tool.rows).map(row).collect();
        let of = |pick: fn(f64, f64) -> f64| poses.iter().map(|row| row.deviation_m).reduce(pick).unwrap_or(f64::NAN);
        let (best_m, worst_m) = (of(f64::min), of(f64::max));
        Some(ToolAccuracy { best_m, worst_m, halving: self.halving(tool, factor), left_out: tool.left_out, poses })
    }

    /// Further readings at the poses of the accuracy that halve the worst deviation.
    fn halving(&self, tool: &ToolPoses, factor: f64) -> Option<HalvingRow> {
        let by = (MAX_HALVING, RowCriterion::Variances);
        let (fit, precision) = (&self.found.best, (&self.frame, &self.precision));
        let chosen = proposals(self.of, fit, precision, &tool.poses, by, tool.aim());
        let half = 0.5 * tool.worst(&self.precision.covariance);
        let count = 1 + chosen.iter().position(|pose| tool.worst(&pose.covariance) <= half)?;
        Some(HalvingRow {
            poses: count,
            positions_m: chosen[..count].iter().map(|of| tool.poses[of.candidate].pose.position_w.into()).collect(),
            worst_m: factor * tool.worst(&chosen[count - 1].covariance),
        })
    }
}

impl ToolAccuracy {
    /// Least and largest deviation, and what halves the largest, as sentences.
    pub fn sentences(&self) -> Vec<String> {
        let place = |[x, y, z]: [f64; 3]| {
            let [x, y, z] = [x, y, z].map(|value| significant(value, 4));
            format!("({x}, {y}, {z}) m")
        };
        let mm = |value: f64| significant(1e3 * value, 3);
        let mut sentences = Vec::new();
        let by = |a: &&ToolRow, b: &&ToolRow| a.deviation_m.total_cmp(&b.deviation_m);
        if let (Some(best), Some(worst)) = (self.poses.iter().min_by(by), self.poses.iter().max_by(by)) {
            let [x, y, z] = worst.direction.map(|part| significant(part, 2));
            sentences.push(format!(
                "The tool stands within ±{} mm at {} and ±{} mm at {}, there along ({x}, {y}, {z}); one deviation, \
                 95 % within ±{} and ±{} mm",
                mm(best.deviation_m),
                place(best.position_m),
                mm(worst.deviation_m),
                place(worst.position_m),
                mm(best.within_95_m),
                mm(worst.within_95_m)
            ));
        }
        sentences.push(match &self.halving {
            Some(halving) => {
                let named: Vec<String> = halving.positions_m.iter().take(MAX_NAMED).map(|of| place(*of)).collect();
                let more = if halving.poses > MAX_NAMED { ", …" } else { "" };
                format!(
                    "Readings at {} halve the worst, to ±{} mm: {}{more}",
                    counted(halving.poses, "further pose"),
                    mm(halving.worst_m),
                    named.join(", ")
                )
            }
            None => format!(
                "Readings at {MAX_HALVING} further poses of this list do not halve the worst: give more exact \
                 readings, or hold what is known"
            ),
        });
        sentences
    }
}
