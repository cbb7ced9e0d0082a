//! Request of `identify`: measurements in one or several states, and the values to find.

use super::json_text;
use super::keys::KEYS;
use super::parts::{Model, Pose, RobotText, State, Tensions};
use crate::measurements::{MeasuredFrequency, MeasuredResponse};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Number of starts of the search if none is given.
pub const DEFAULT_STARTS: usize = 10;

/// Deviation of responses that have none, relative to their magnitude.
pub const DEFAULT_RESPONSE_NOISE: f64 = 0.02;

/// Relative deviation of natural frequencies that have none.
pub const DEFAULT_FREQUENCY_NOISE: f64 = 0.01;

/// Relative deviation of damping ratios.
pub const DEFAULT_DAMPING_NOISE: f64 = 0.1;

/// Request of `identify`: values of the robot file that fit measurements best.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct IdentifyRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Values to identify.
    pub fit: Vec<FitValue>,
    /// Measurements, one element per state of the robot.
    pub experiments: Vec<Experiment>,
    /// First frequency of the responses that counts [Hz]; default all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from_hz: Option<f64>,
    /// Last frequency of the responses that counts [Hz]; default all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to_hz: Option<f64>,
    /// Number of starts of the search.
    #[serde(default = "default_starts")]
    pub starts: usize,
    /// Deviation of responses without deviations, relative to their magnitude; 0.3 % of the median magnitude is added.
    #[serde(default = "default_response_noise")]
    pub response_noise: f64,
    /// Relative deviation of natural frequencies without deviations.
    #[serde(default = "default_frequency_noise")]
    pub frequency_noise: f64,
    /// Relative deviation of damping ratios.
    #[serde(default = "default_damping_noise")]
    pub damping_noise: f64,
    /// Cables that are rigid in length: natural frequencies of the motions that they leave free.
    #[serde(default)]
    pub rigid_cables: bool,
    /// Paths of fitted values whose profiles are computed, in which `*` stands for any key.
    #[serde(default)]
    pub profile: Vec<String>,
    /// Rule and limits of tensions.
    #[serde(flatten)]
    pub tensions: Tensions,
    /// Linearisation.
    #[serde(flatten)]
    pub model: Model,
}

impl IdentifyRequest {
    /// Reads a list of experiments from JSON, with the checks of a request.
    ///
    /// # Errors
    /// Bytes that are not JSON, a key that is there twice, no list, an unknown key, or a value of the wrong type.
    pub fn experiments_from_json(bytes: &[u8]) -> anyhow::Result<Vec<Experiment>> {
        let given = json_text::value(bytes).map_err(|error| anyhow::anyhow!("it is not valid JSON: {error}"))?;
        let experiments: Vec<Experiment> = serde_json::from_value(given.clone())
            .map_err(|error| anyhow::anyhow!("it is not a list of experiments: {error}"))?;
        let understood = serde_json::to_value(&experiments)?;
        let as_key = |list: Value| Map::from_iter([("experiments".to_owned(), list)]);
        check_keys(&as_key(given), &as_key(understood))?;
        Ok(experiments)
    }
}

/// Value of the robot file to identify.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FitValue {
    /// Path of the value; `*` stands for every name, and a vector without a component for all its components.
    pub path: String,
    /// Minimum; default the range of the key.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minimum: Option<f64>,
    /// Maximum; default the range of the key.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub maximum: Option<f64>,
    /// Value known beforehand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prior: Option<f64>,
    /// Standard deviation of the value known beforehand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prior_std: Option<f64>,
}

/// Measurements of the robot in one state.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Experiment {
    /// Name in tables and messages.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Names of the cables that were mounted; default all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cables: Option<Vec<String>>,
    /// State and loads.
    #[serde(flatten)]
    pub state: State,
    /// Frequency responses.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub responses: Vec<MeasuredResponse>,
    /// Natural frequencies.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub frequencies: Vec<MeasuredFrequency>,
    /// Measured pose; the lengths are then held.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured_pose: Option<Pose>,
    /// Standard deviation of each coordinate of the measured position [m]; default 1 mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position_std_m: Option<f64>,
    /// Standard deviation of the measured rotation about each axis [degrees]; default 0.1°.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation_std_deg: Option<f64>,
    /// Measured tensions at the platform [N], one per cable.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured_tensions_n: Option<Vec<f64>>,
    /// Standard deviation of the tensions [N]; default 1 % of the maximum.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tension_std_n: Option<f64>,
    /// Measured unstrained lengths [m], one per cable; the pose is then held.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured_lengths_m: Option<Vec<f64>>,
    /// Standard deviation of the lengths [m]; default 1 mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length_std_m: Option<f64>,
}

/// Checks that experiments have no unknown key. Fields that are spread over groups cannot refuse one themselves.
///
/// # Errors
/// A key that no experiment has.
pub(super) fn check_keys(given: &Map<String, Value>, understood: &Map<String, Value>) -> anyhow::Result<()> {
    let (Some(Value::Array(given)), Some(Value::Array(understood))) =
        (given.get("experiments"), understood.get("experiments"))
    else {
        return Ok(());
    };
    let unknown = given.iter().zip(understood).find_map(|pair| {
        let (Value::Object(given), Value::Object(understood)) = pair else { return None };
        given.iter().find(|(key, value)| !understood.contains_key(*key) && !is_empty(value)).map(|(key, _)| key)
    });
    let Some(unknown) = unknown else { return Ok(()) };

    let is_of_requests = KEYS.iter().any(|(key, _)| key == unknown);
    let place = if is_of_requests { "; it is a key of requests and stands beside `experiments`" } else { "" };
    anyhow::bail!("an experiment has no key `{unknown}`{place}")
}

/// True for a value that is not written again because it is empty.
fn is_empty(value: &Value) -> bool {
    match value {
        Value::Null => true,
        Value::Array(items) => items.is_empty(),
        Value::String(text) => text.is_empty(),
        _ => false,
    }
}

fn default_starts() -> usize {
    DEFAULT_STARTS
}

fn default_response_noise() -> f64 {
    DEFAULT_RESPONSE_NOISE
}

fn default_frequency_noise() -> f64 {
    DEFAULT_FREQUENCY_NOISE
}

fn default_damping_noise() -> f64 {
    DEFAULT_DAMPING_NOISE
}
