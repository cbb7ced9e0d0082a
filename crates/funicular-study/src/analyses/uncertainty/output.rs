//! Results of `uncertainty` as data.

use crate::analyses::shared::Models;
use serde::Serialize;

/// Results of `uncertainty`.
#[derive(Serialize)]
pub struct Uncertainties {
    #[serde(skip)]
    pub robot: String,
    #[serde(flatten)]
    pub models: Models,
    /// Quantity that is held while the numbers deviate: `lengths` or `pose`.
    pub held: &'static str,
    /// Sentence that says what is held, and by which rule the rest follows.
    pub held_means: &'static str,
    /// Frequency response among the results.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub response: Option<UncertainResponse>,
    /// Numbers that deviate.
    pub inputs: Vec<UncertainInput>,
    /// Groups of numbers, one per option.
    pub groups: Vec<InputGroup>,
    /// Number of sampled robots per pose that needs them.
    pub samples: usize,
    /// Number of robots that were computed for the samples and the corners of the tolerances.
    pub evaluations: usize,
    /// Notes on the accuracy.
    pub notes: Vec<String>,
    /// Results at each pose.
    pub poses: Vec<PoseUncertainty>,
    #[serde(skip)]
    pub warnings: Vec<String>,
}

/// Frequency response whose magnitudes and phases are results.
#[derive(Debug, Clone, Serialize)]
pub struct UncertainResponse {
    pub input: String,
    pub output: String,
    /// Unit; magnitudes are in decibels of it, phases in degrees.
    pub unit: String,
}

/// Number of the robot file that deviates.
#[derive(Debug, Clone, Serialize)]
pub struct UncertainInput {
    pub path: String,
    pub unit: &'static str,
    /// Value; absent if it changes from pose to pose.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// Distribution: `normal` or `uniform`.
    pub distribution: &'static str,
    /// Standard deviation; absent if it changes from pose to pose.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deviation: Option<f64>,
    /// Half width of the tolerance; absent for a normal distribution.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Index of its group, from 0.
    pub group: usize,
}

/// Numbers that one option makes deviate.
#[derive(Debug, Clone, Serialize)]
pub struct InputGroup {
    pub name: String,
    /// Count of parameters in the group.
    pub count: usize,
}

/// Results at one pose.
#[derive(Debug, Clone, Serialize)]
pub struct PoseUncertainty {
    /// Pose of the undisturbed robot; absent if it has no equilibrium.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position_m: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roll_pitch_yaw_deg: Option<[f64; 3]>,
    /// Reason why there are no results.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Number of sampled robots without results, with the first reason.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failed: Option<FailedSamples>,
    pub results: Vec<UncertainResult>,
}

/// Sampled robots without results.
#[derive(Debug, Clone, Serialize)]
pub struct FailedSamples {
    pub count: usize,
    pub reason: String,
}

/// Result with its deviation.
#[derive(Debug, Clone, Serialize)]
pub struct UncertainResult {
    /// Name, such as `frequency 3` or `tension of cable "2" at the anchor`.
    pub name: String,
    /// Identity as data: `kind`, and the cable, mode or frequency to which the result belongs.
    pub measure: serde_json::Value,
    pub unit: &'static str,
    /// Frequency of a response [Hz].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_hz: Option<f64>,
    /// Value of the undisturbed robot.
    pub value: f64,
    /// Standard deviation; absent if too few sampled robots have the result.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deviation: Option<f64>,
    /// Interval that holds 95 % of the robots.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interval_95: Option<[f64; 2]>,
    /// Method: `linear` or `sampled`.
    pub method: &'static str,
    /// Reason for sampling. With the requested method `linear` it is the reason why the linear deviation is doubtful.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sampling_reason: Option<String>,
    /// Standard deviation by the gradient, also of a sampled result.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub linear_deviation: Option<f64>,
    /// Mean of the sampled robots.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean: Option<f64>,
    /// Shares of the groups in the variance; of a sampled result total shares, which may add up to more than 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub group_shares: Option<Vec<f64>>,
    /// Largest linear shares of single numbers in the variance.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub largest: Vec<ShareOfInput>,
    /// Linear shares of all numbers, in the order of `inputs`; for one pose only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shares: Option<Vec<f64>>,
    /// Worst case within the tolerances.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub worst: Option<WorstCase>,
}

/// Share of a number in the variance of a result.
#[derive(Debug, Clone, Serialize)]
pub struct ShareOfInput {
    pub path: String,
    pub share: f64,
}

/// Worst case within the tolerances.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct WorstCase {
    /// Sum of the absolute linear changes over all tolerances: neither a lower nor an upper bound.
    pub linear: f64,
    /// Change at the corner of the tolerances where the linear result is smallest. The true worst case is at least as
    /// far.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub down: Option<f64>,
    /// Change at the opposite corner, where the linear result is largest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub up: Option<f64>,
}
