//! Request of the uncertainty of results.

use super::parts::{Model, ResponsePoints, RobotText, State, Tensions};
use crate::names::UncertaintyMethod;
use funicular::gradient::Hold;
use serde::{Deserialize, Deserializer, Serialize};

/// Number of sampled robots if a request gives none: deviations are then accurate to 5 %.
pub const DEFAULT_SAMPLES: usize = 200;

/// Request of `uncertainty`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct UncertaintyRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Groups of results: `pose`, `lengths`, `tensions`, `stiffness-min`, `frequencies`, `damping`, `response`.
    #[serde(default = "pose_and_tensions")]
    pub of: Vec<String>,
    /// Standard deviations of normally distributed numbers, as `PATH=VALUE` or `PATH=PERCENT%`.
    #[serde(default)]
    pub deviations: Vec<String>,
    /// Tolerances of numbers that are anywhere within them, as `PATH=VALUE` or `PATH=PERCENT%`.
    #[serde(default)]
    pub tolerances: Vec<String>,
    /// Quantity that is held while the numbers deviate.
    #[serde(default, with = "crate::names")]
    pub hold: Hold,
    /// Method for the deviations of the results.
    #[serde(default, with = "crate::names")]
    pub method: UncertaintyMethod,
    /// Number of sampled robots.
    #[serde(default = "default_samples")]
    pub samples: usize,
    /// Number that chooses the sample.
    #[serde(default)]
    pub seed: u32,
    /// Upper limit of the frequencies [Hz]; for frequencies and damping.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub below_hz: Option<f64>,
    /// Frequencies of the response [Hz]: a list, or a single number.
    #[serde(skip_serializing_if = "Option::is_none", default, deserialize_with = "one_or_several")]
    pub at_hz: Option<Vec<f64>>,
    /// Input of the response.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub input: Option<String>,
    /// Output of the response.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub output: Option<String>,
    /// Points of the response.
    #[serde(flatten)]
    pub points: ResponsePoints,
    /// List of poses instead of the state: position [m] and roll, pitch, yaw [degrees].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub poses: Option<Vec<[f64; 6]>>,
    /// State and loads.
    #[serde(flatten)]
    pub state: State,
    /// Rule and limits of tensions.
    #[serde(flatten)]
    pub tensions: Tensions,
    /// Linearisation.
    #[serde(flatten)]
    pub model: Model,
}

/// Results whose deviations are computed if a request names none.
pub fn pose_and_tensions() -> Vec<String> {
    vec!["pose".to_owned(), "tensions".to_owned()]
}

/// Reads a number or a list of numbers as a list.
fn one_or_several<'de, D: Deserializer<'de>>(source: D) -> Result<Option<Vec<f64>>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "a frequency is a number, and several are a list of numbers")]
    enum Numbers {
        One(f64),
        Several(Vec<f64>),
    }
    Ok(Option::<Numbers>::deserialize(source)?.map(|numbers| match numbers {
        Numbers::One(hz) => vec![hz],
        Numbers::Several(all) => all,
    }))
}

fn default_samples() -> usize {
    DEFAULT_SAMPLES
}
