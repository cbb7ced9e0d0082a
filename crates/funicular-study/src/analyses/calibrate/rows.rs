//! Rows of the results of a calibration, with their columns.

use crate::analyses::fields;
use crate::analyses::profile::Profile;
use crate::columns::{Columns, column, parts};
use crate::rows::rows;
use crate::text::{digits_for, significant};
use funicular::calibration::CandidatePose;

rows! {
    /// Calibrated value.
    pub struct CalibratedValue {
        /// Path in the robot file, or the name of an offset or of the scale.
        pub path: String;
        pub unit: &'static str;
        pub start: f64;
        pub value: f64;
        /// True if the frame holds the value.
        pub held: bool;
        /// Standard deviation in the frame; absent for a value that the readings do not determine or the frame holds.
        pub deviation: Option<f64>;
        /// Interval that holds the value with 95 %; absent as well where χ² is no parabola.
        pub interval_95: Option<[f64; 2]>;
        /// Standard deviation with inner conditions, which no choice of the frame enlarges.
        pub inner_deviation: Option<f64>;
        /// Value known beforehand.
        pub prior: Option<f64>;
        pub prior_deviation: Option<f64>;
        /// Profile of χ², if it was asked for: ends of the interval that holds the value with 95 %, and points.
        pub profile: Option<Profile>;
    }
}

impl CalibratedValue {
    /// Number of digits of the value, by its deviation.
    pub fn digits(&self) -> usize {
        digits_for(self.value, self.deviation)
    }

    /// Columns of the values.
    pub fn columns() -> Columns<Self> {
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
        Columns::new([
            column("path", "", "path of the number in the robot file, or its name", |row: &Self| row.path.clone())
                .plain("value"),
            column("unit", "", "unit of the number", |row: &Self| row.unit).plain("unit"),
            column("start", "", "value of the file", |row: &Self| row.start).significant("start", 5),
            column("value", "", "calibrated value", |row: &Self| row.value)
                .shown("value", "", |row, style| style.significant(row.value, row.digits())),
            column("deviation", "", "standard deviation in the frame", |row: &Self| row.deviation).significant("±", 3),
            low,
            high,
            column("inner_deviation", "", "standard deviation with inner conditions", |row: &Self| row.inner_deviation)
                .significant("inner ±", 3),
            column("remark", "", "what holds the value, or that nothing determines it; its prior", remark).plain(""),
            column("prior", "", "value that was known beforehand", |row: &Self| row.prior),
            column("prior_deviation", "", "its standard deviation", |row: &Self| row.prior_deviation),
            parts("profile_95_{}", ["from", "to"], "", "end of the interval of the profile: {}", profile),
        ])
    }
}

rows! {
    /// Distance between two anchors, which no frame changes.
    pub struct DistanceRow {
        pub first: String;
        pub second: String;
        pub distance_m: f64;
        pub deviation_m: Option<f64>;
    }
}

impl DistanceRow {
    /// Columns of the distances.
    pub fn columns() -> Columns<Self> {
        Columns::new([
            column("first", "", "cable of one anchor", |row: &Self| row.first.clone()).plain("anchor"),
            column("second", "", "cable of the other anchor", |row: &Self| row.second.clone()).plain("anchor"),
            column("distance_m", "m", "distance", |row: &Self| row.distance_m).decimals("distance", 5),
            column("deviation_m", "m", "standard deviation of the distance", |row: &Self| row.deviation_m)
                .significant("±", 3),
        ])
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
    pub struct ReadingRow {
        /// Number of the row, from 1.
        pub row: usize;
        pub position_m: [f64; 3];
        pub roll_pitch_yaw_deg: [f64; 3];
        /// Residuals of the cables that were read.
        pub residuals: Vec<CableResidual>;
        /// Decrease of χ² if the row is left out, in the variance of the residuals; absent for a row that no other row
        /// checks.
        pub chi2_drop: Option<f64>;
        /// Largest decrease that noise gives in one of as many rows with 95 %.
        pub chi2_limit: f64;
        /// Largest change of a value if the row is left out.
        pub shift_m: Option<f64>;
        /// True if the decrease is beyond its limit.
        pub outlier: bool;
    }
}

impl ReadingRow {
    fn rms(&self) -> f64 {
        let squares: f64 = self.residuals.iter().map(|of| of.residual_m * of.residual_m).sum();
        (squares / self.residuals.len().max(1) as f64).sqrt()
    }

    /// Columns of the rows.
    pub fn columns(turns: bool) -> Columns<Self> {
        let remark = |row: &Self| match (row.outlier, row.chi2_drop) {
            (true, _) => "outlier",
            (false, None) => "indispensable, cannot be checked",
            (false, Some(_)) => "",
        };
        Columns::new([
            column("row", "1", "number of the row, from 1", |row: &Self| row.row).plain("row"),
            parts("{}_m", fields::AXES, "m", "position of the platform origin, {}", |row: &Self| row.position_m)
                .components("position", 4),
            parts("{}_deg", ["roll", "pitch", "yaw"], "deg", "{} of the platform", |row: &Self| row.roll_pitch_yaw_deg)
                .components("roll, pitch, yaw", 3)
                .read_if(turns),
            column("residual_rms_m", "m", "root mean square of the residuals of the row", |row: &Self| row.rms())
                .shown("residual", "mm", |row, style| style.significant(1e3 * row.rms(), 3)),
            column("chi2_drop", "1", "decrease of χ² if the row is left out", |row: &Self| row.chi2_drop)
                .significant("χ² without it falls by", 3),
            column("chi2_limit", "1", "largest decrease that noise gives with 95 %", |row: &Self| row.chi2_limit)
                .significant("limit", 3),
            column("shift_m", "m", "largest change of a value if the row is left out", |row: &Self| row.shift_m).shown(
                "values move by",
                "mm",
                |row, style| style.significant(row.shift_m.map(|shift| 1e3 * shift), 3),
            ),
            column("remark", "", "outlier, or a row that no other row checks", remark).plain(""),
        ])
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
    pub struct ProposalRow {
        /// Number of proposed poses up to this one.
        pub number: usize;
        pub position_m: [f64; 3];
        pub roll_pitch_yaw_deg: [f64; 3];
        /// Readings at the pose with the calibrated values, one per cable.
        pub readings_m: Vec<f64>;
        /// Rule of the tensions at the pose, if they are a matter of choice.
        pub tension_rule: Option<&'static str>;
        /// Root of the sum of the variances of the chosen lengths after this pose and those before it; absent if factors
        /// alone are chosen.
        pub total_m: Option<f64>;
        /// Largest deviation of a length then; absent if factors alone are chosen.
        pub largest_m: Option<f64>;
        /// Value that has it, or the factor with the largest deviation.
        pub largest_of: String;
        /// Deviations of all values then, in their order.
        pub deviations: Vec<f64>;
    }
}

impl ProposalRow {
    /// Columns of the proposed poses; with the rules of tensions if any has one.
    pub fn columns(turns: bool, has_rules: bool) -> Columns<Self> {
        Columns::new([
            column("number", "1", "number of proposed poses up to this one", |row: &Self| row.number).plain("next"),
            parts("{}_m", fields::AXES, "m", "position of the platform origin, {}", |row: &Self| row.position_m)
                .components("position", 4),
            parts("{}_deg", ["roll", "pitch", "yaw"], "deg", "{} of the platform", |row: &Self| row.roll_pitch_yaw_deg)
                .components("roll, pitch, yaw", 3)
                .read_if(turns),
            column("total_m", "m", "root of the sum of the variances of the chosen values then", |row: &Self| {
                row.total_m
            })
            .shown("all together then ±", "mm", |row, style| {
                style.significant(row.total_m.map(|total| 1e3 * total), 4)
            }),
            column("largest_m", "m", "largest deviation of a value then", |row: &Self| row.largest_m).shown(
                "largest ±",
                "mm",
                |row, style| style.significant(row.largest_m.map(|largest| 1e3 * largest), 3),
            ),
            column("largest_of", "", "value with the largest deviation", |row: &Self| row.largest_of.clone())
                .plain("of"),
            column("tension_rule", "", "rule of the tensions", |row: &Self| row.tension_rule)
                .plain("tensions")
                .read_if(has_rules),
        ])
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
