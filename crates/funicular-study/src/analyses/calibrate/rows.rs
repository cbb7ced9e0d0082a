//! Rows of the results of a calibration, with their columns.

use crate::analyses::fields;
use crate::analyses::profile::Profile;
use crate::columns::{column, parts};
use crate::rows::rows;
use crate::text::{digits_for, significant};
use funicular::calibration::{CandidatePose, ProposalAim, ToolRows};
use funicular::math::DMat;

rows! {
    /// Calibrated value.
    pub struct CalibratedValue in tables() with {
        let remark = |row: &Self| match (row.held, row.deviation, row.prior.zip(row.prior_deviation)) {
            (true, ..) => "held by the frame".to_owned(),
            (false, None, _) => "not determined".to_owned(),
            (false, Some(_), Some((value, deviation))) => {
                format!("prior {} ± {}", significant(value, 4), significant(deviation, 2))
            }
            (false, Some(_), None) => String::new(),
        };
        let profile = |row: &Self| row.profile.as_ref().map_or([None; 2], |profile| [profile.from, profile.to]);
        let [low, high] = fields::interval_95(|row: &Self| row.interval_95, Self::digits, "the value with 95 %");
    } rows {
        /// Path of the number in the robot file, or its name.
        ///
        /// Path in the robot file, or the name of an offset or of the scale.
        pub path: String => one.plain("value");
        /// Unit of the number.
        pub unit: &'static str => one.plain("unit");
        /// Value of the file.
        pub start: f64 => one.unit("").significant("start", 5);
        /// Calibrated value.
        pub value: f64 => one.unit("").shown("value", "", |row, style| style.significant(row.value, row.digits()));
        /// True if the frame holds the value.
        pub held: bool;
        /// Standard deviation in the frame.
        ///
        /// Absent for a value that the readings do not determine or the frame holds.
        pub deviation: Option<f64>
            => one.unit("").significant("±", 3)
            => low
            => high;
        /// Interval that holds the value with 95 %; absent as well where χ² is no parabola.
        pub interval_95: Option<[f64; 2]>;
        /// Standard deviation with inner conditions.
        ///
        /// No choice of the frame enlarges it.
        pub inner_deviation: Option<f64>
            => one.unit("").significant("inner ±", 3)
            => column("remark", "", "what holds the value, or that nothing determines it; its prior", remark).plain("");
        /// Value that was known beforehand.
        pub prior: Option<f64> => one.unit("");
        /// Standard deviation of the value known beforehand.
        pub prior_deviation: Option<f64>
            => one.unit("").about("its standard deviation")
            => parts("profile_95_{}", ["from", "to"], "", "end of the interval of the profile: {}", profile);
        /// Profile of χ², if it was asked for: ends of the interval that holds the value with 95 %, and points.
        pub profile: Option<Profile>;
    }
}

impl CalibratedValue {
    /// Number of digits of the value, by its deviation.
    pub fn digits(&self) -> usize {
        digits_for(self.value, self.deviation)
    }
}

rows! {
    /// Distance between two anchors, which no frame changes.
    pub struct DistanceRow in tables() {
        /// Cable of one anchor.
        pub first: String => one.plain("anchor");
        /// Cable of the other anchor.
        pub second: String => one.plain("anchor");
        /// Distance.
        pub distance_m: f64 => one.decimals("distance", 5);
        /// Standard deviation of the distance.
        pub deviation_m: Option<f64> => one.significant("±", 3);
    }
}

rows! {
    /// Residual of a reading, computed less measured.
    pub struct CableResidual {
        pub cable: String;
        pub residual_m: f64;
    }
}

rows! {
    /// One row of readings after the fit.
    pub struct ReadingRow in tables(turns: bool) with {
        let remark = |row: &Self| match (row.outlier, row.chi2_drop) {
            (true, _) => "outlier",
            (false, None) => "indispensable, cannot be checked",
            (false, Some(_)) => "",
        };
    } rows {
        /// Number of the row, from 1.
        pub row: usize => one.plain("row");
        /// Position of the platform origin, {}.
        pub position_m: [f64; 3] => each(fields::AXES, "{}_m").components("position", 4);
        /// Roll, pitch, yaw of the platform.
        pub roll_pitch_yaw_deg: [f64; 3]
            => each(fields::ANGLES, "{}_deg", "{} of the platform").components("roll, pitch, yaw", 3).read_if(turns)
            => column("residual_rms_m", "m", "root mean square of the residuals of the row", |row: &Self| row.rms())
                .shown("residual", "mm", |row, style| style.significant(1e3 * row.rms(), 3));
        /// Residuals of the cables that were read.
        pub residuals: Vec<CableResidual>;
        /// Decrease of χ² if the row is left out.
        ///
        /// In the variance of the residuals; absent for a row that no other row checks.
        pub chi2_drop: Option<f64> => one.significant("χ² without it falls by", 3);
        /// Largest decrease that noise gives with 95 %.
        ///
        /// Largest decrease that noise gives in one of as many rows with 95 %.
        pub chi2_limit: f64 => one.significant("limit", 3);
        /// Largest change of a value if the row is left out.
        pub shift_m: Option<f64>
            => one.shown("values move by", "mm", |row, style| {
                style.significant(row.shift_m.map(|shift| 1e3 * shift), 3)
            })
            => column("remark", "", "outlier, or a row that no other row checks", remark).plain("");
        /// True if the decrease is beyond its limit.
        pub outlier: bool;
    }
}

impl ReadingRow {
    fn rms(&self) -> f64 {
        let squares: f64 = self.residuals.iter().map(|of| of.residual_m * of.residual_m).sum();
        (squares / self.residuals.len().max(1) as f64).sqrt()
    }
}

rows! {
    /// Combination of values that the readings determine worst.
    pub struct WeakRow {
        /// Standard deviation of the lengths of the combination together; absent if the readings do not see it.
        pub deviation_m: Option<f64>;
        /// Share of the words in the combination.
        pub share: f64;
        pub words: String;
        /// Unit vector over the values that are lengths, with inner conditions; factors stand with the metres for which
        /// they count.
        pub direction: Vec<f64>;
    }
}

rows! {
    /// Walk along the weakest combination, with everything else fitted again.
    pub struct Walk {
        /// Held distances, in deviations, at which something fits.
        pub deviations: Vec<f64>;
        /// Rises of χ² there, in the variance of the residuals: 1 and 4 for a parabola.
        pub chi2_rises: Vec<f64>;
        pub is_parabola: bool;
    }
}

rows! {
    /// Further minimum that fits.
    pub struct MinimumRow {
        pub chi2: f64;
        /// Values in the order of the calibrated ones.
        pub values: Vec<f64>;
        /// Largest difference of an anchor, attachment or offset from the best minimum.
        pub farthest_m: f64;
        /// Cables whose anchors stand on the other side of the plane or line of their rows; empty for another kind of
        /// minimum.
        pub mirrored: Vec<String> = sparse;
        /// Rows whose poses differ most, from 1.
        pub row: usize;
    }
}

rows! {
    /// Pose to measure next.
    pub struct ProposalRow in tables(turns: bool, has_rules: bool, has_tool: bool) {
        /// Number of proposed poses up to this one.
        pub number: usize => one.plain("next");
        /// Position of the platform origin, {}.
        pub position_m: [f64; 3] => each(fields::AXES, "{}_m").components("position", 4);
        /// Roll, pitch, yaw of the platform.
        pub roll_pitch_yaw_deg: [f64; 3] => each(fields::ANGLES, "{}_deg", "{} of the platform")
            .components("roll, pitch, yaw", 3)
            .read_if(turns);
        /// Readings at the pose with the calibrated values, one per cable.
        pub readings_m: Vec<f64>;
        /// Rule of the tensions at the pose, if they are a matter of choice.
        pub tension_rule: Option<&'static str>;
        /// Root of the sum of the variances of the chosen values then.
        ///
        /// Root of the sum of the variances of the chosen lengths after this pose and those before it; absent if
        /// factors alone are chosen.
        pub total_m: Option<f64> => one
            .shown("all together then ±", "mm", |row, style| {
                style.significant(row.total_m.map(|total| 1e3 * total), 4)
            });
        /// Largest deviation of a value then.
        ///
        /// Largest deviation of a length then; absent if factors alone are chosen.
        pub largest_m: Option<f64> => one
            .shown("largest ±", "mm", |row, style| style.significant(row.largest_m.map(|largest| 1e3 * largest), 3));
        /// Value with the largest deviation.
        ///
        /// Value that has it, or the factor with the largest deviation.
        pub largest_of: String
            => one.plain("of")
            => column("tension_rule", "", "rule of the tensions", |row: &Self| row.tension_rule)
                .plain("tensions")
                .read_if(has_rules);
        /// Largest deviation of the position of the platform then, over the poses of its accuracy.
        pub tool_m: Option<f64> => one
            .shown("tool ±", "mm", |row, style| style.significant(row.tool_m.map(|worst| 1e3 * worst), 3))
            .read_if(has_tool);
        /// Deviations of all values then, in their order.
        pub deviations: Vec<f64>;
    }
}

rows! {
    /// Candidates that were left out.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
    pub struct LeftOut {
        /// Candidates that were given.
        pub candidates: usize;
        /// Candidates without equilibrium or without tensions within the limits.
        pub by_tensions: usize;
        /// Candidates with cables, platform or obstacles too near to each other.
        pub by_clearance: usize;
    }
}

/// Candidates that can be reached; a pose can be there with several tensions.
pub(super) struct Reachable {
    pub(super) candidates: Vec<CandidatePose>,
    /// Rule that chose the tensions of each; `None` without tensions.
    pub(super) rules: Vec<Option<&'static str>>,
    /// Absent if nothing had to be checked.
    pub(super) left_out: Option<LeftOut>,
}

/// Poses at which the accuracy is asked for, as the platform can have them, with its motions there.
pub(super) struct ToolPoses {
    pub(super) poses: Vec<CandidatePose>,
    pub(super) rows: Vec<ToolRows>,
    pub(super) left_out: Option<LeftOut>,
}

impl ToolPoses {
    /// Motions of the platform at all poses.
    pub(super) fn aim(&self) -> ProposalAim<'_> {
        ProposalAim::Tool(&self.rows)
    }

    /// Largest standard deviation of the position for a covariance of the unknowns.
    pub(super) fn worst(&self, covariance: &DMat) -> f64 {
        self.rows.iter().map(|rows| rows.deviation(covariance).position).fold(0.0, f64::max)
    }
}
