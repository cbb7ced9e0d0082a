//! Requests: the analysis to run and its options, as plain data.
//!
//! In JSON a request is one flat object. `command` names the analysis, `robot` holds the text of the robot file, and
//! every other key is an option with the same name as in the program (`--mass-kg`) and in Python (`mass_kg=`). An
//! option that is left out has its default.

mod design;
mod files;
mod gradient;
mod grids;
mod identify;
mod json_text;
mod keys;
mod pages;
mod parts;
mod source_file;
mod statics;
mod steps;
mod uncertainty;
mod vibration;

pub use design::{ChangeValue, DesignRequest};
pub use files::{ExportRequest, ImportRequest, NewRequest, SchemaRequest};
pub use gradient::{GradientRequest, frequencies};
pub use grids::{MapRequest, MergeRequest, PlotRequest, SweepRequest};
pub use identify::{
    DEFAULT_DAMPING_NOISE, DEFAULT_FREQUENCY_NOISE, DEFAULT_RESPONSE_NOISE, DEFAULT_STARTS, Experiment, FitValue,
    IdentifyRequest,
};
pub use keys::KEYS;
pub use pages::{LiveRequest, PaperRequest, ReportRequest, ValidateRequest};
pub use parts::{
    Axis, Change, EachPoint, FrequencyRange, ImportPlatform, ImportRopes, Load, MAX_HZ, Model, OneOrSeveral, Pose,
    ResponsePoints, ResponseRange, RobotText, State, Tensions, Terms,
};
pub use source_file::{MAX_BYTES, SourceFile};
pub use statics::{
    CheckRequest, ParametersRequest, PayloadRequest, PoseErrorRequest, StaticsRequest, StiffnessRequest,
};
pub use steps::{Steps, digits};
pub use uncertainty::{DEFAULT_SAMPLES, UncertaintyRequest, pose_and_tensions};

pub use vibration::{
    CableRequest, CompareRequest, DEFAULT_INPUT, DEFAULT_OUTPUT, FrfRequest, ModesRequest, ReduceRequest,
};

pub(crate) use parts::{check, check_vector};

use crate::error::Error;
use crate::names::suggestion;
use crate::signals::{Input, Output};
use crate::values::{fraction, not_negative, positive};
use anyhow::{anyhow, bail};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Name and version of the vocabulary of requests. The version changes if the meaning of a key changes.
pub const SCHEMA: &str = "funicular-request/1";

/// Request of one analysis of one robot, or, for a few commands, of files.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "command", rename_all = "kebab-case")]
pub enum Request {
    /// Check of the robot file, and a description of the robot.
    Check(CheckRequest),
    /// Every number of the robot file.
    Parameters(ParametersRequest),
    /// Equilibrium: pose, tensions, sag.
    Statics(StaticsRequest),
    /// 6×6 stiffness at one frequency.
    Stiffness(StiffnessRequest),
    /// Every natural frequency below a limit.
    Modes(ModesRequest),
    /// Frequency response and its peaks.
    Frf(FrfRequest),
    /// Comparison of all cable models.
    Compare(CompareRequest),
    /// Derivatives of results by numbers of the robot file.
    Gradient(GradientRequest),
    /// Deviations of results from deviations of numbers of the robot file.
    Uncertainty(UncertaintyRequest),
    /// Minimum and maximum payload at a pose.
    Payload(PayloadRequest),
    /// Distances between the poses of ideal, spring and catenary cables over platform mass.
    PoseError(PoseErrorRequest),
    /// Dynamic stiffness of one cable over frequency.
    Cable(CableRequest),
    /// Model for control design: state space or second-order form.
    Reduce(ReduceRequest),
    /// Values of the robot file that fit measurements best.
    Identify(IdentifyRequest),
    /// Values of the robot file with which the robot is best at several poses.
    Design(DesignRequest),
    /// Quantities over poses.
    Map(MapRequest),
    /// Quantities over values of the robot file.
    Sweep(SweepRequest),
    /// HTML page about one robot.
    Report(ReportRequest),
    /// HTML page on which the platform can be dragged.
    Live(LiveRequest),
    /// HTML page that reproduces Yuan et al. 2014.
    Paper(PaperRequest),
    /// Robot file with starting values.
    New(NewRequest),
    /// JSON Schema of the robot file.
    Schema(SchemaRequest),
    /// Robot file made from files of other programs.
    Import(ImportRequest),
    /// Robot at equilibrium as a file of another program.
    Export(ExportRequest),
    /// Comparison of the program with published and independent numbers.
    Validate(ValidateRequest),
    /// Parts of a map or sweep combined in one file.
    Merge(MergeRequest),
    /// HTML page about a map or sweep.
    Plot(PlotRequest),
}

impl Request {
    /// Name of the command.
    pub fn command(&self) -> &'static str {
        match self {
            Self::Check(_) => "check",
            Self::Parameters(_) => "parameters",
            Self::Statics(_) => "statics",
            Self::Stiffness(_) => "stiffness",
            Self::Modes(_) => "modes",
            Self::Frf(_) => "frf",
            Self::Compare(_) => "compare",
            Self::Gradient(_) => "gradient",
            Self::Uncertainty(_) => "uncertainty",
            Self::Payload(_) => "payload",
            Self::PoseError(_) => "pose-error",
            Self::Cable(_) => "cable",
            Self::Reduce(_) => "reduce",
            Self::Identify(_) => "identify",
            Self::Design(_) => "design",
            Self::Map(_) => "map",
            Self::Sweep(_) => "sweep",
            Self::Report(_) => "report",
            Self::Live(_) => "live",
            Self::Paper(_) => "paper",
            Self::New(_) => "new",
            Self::Schema(_) => "schema",
            Self::Import(_) => "import",
            Self::Export(_) => "export",
            Self::Validate(_) => "validate",
            Self::Merge(_) => "merge",
            Self::Plot(_) => "plot",
        }
    }

    /// Robot file of the request, if it has one.
    pub fn robot(&self) -> Option<&RobotText> {
        match self {
            Self::Check(request) => Some(&request.robot),
            Self::Parameters(request) => Some(&request.robot),
            Self::Statics(request) => Some(&request.robot),
            Self::Stiffness(request) => Some(&request.robot),
            Self::Modes(request) => Some(&request.robot),
            Self::Frf(request) => Some(&request.robot),
            Self::Compare(request) => Some(&request.robot),
            Self::Gradient(request) => Some(&request.robot),
            Self::Uncertainty(request) => Some(&request.robot),
            Self::Payload(request) => Some(&request.robot),
            Self::PoseError(request) => Some(&request.robot),
            Self::Cable(request) => Some(&request.robot),
            Self::Reduce(request) => Some(&request.robot),
            Self::Identify(request) => Some(&request.robot),
            Self::Design(request) => Some(&request.robot),
            Self::Map(request) => Some(&request.robot),
            Self::Sweep(request) => Some(&request.robot),
            Self::Report(request) => Some(&request.robot),
            Self::Live(request) => Some(&request.robot),
            Self::Export(request) => Some(&request.robot),
            Self::New(_)
            | Self::Schema(_)
            | Self::Paper(_)
            | Self::Import(_)
            | Self::Validate(_)
            | Self::Merge(_)
            | Self::Plot(_) => None,
        }
    }

    /// Reads a request from JSON. A key that the command does not have is refused, and the nearest known key is
    /// suggested.
    ///
    /// # Errors
    /// Text that is not JSON, a key that is there twice, another schema, an unknown command or key, or a value of the
    /// wrong type.
    pub fn from_json(text: &str) -> Result<Self, Error> {
        let value =
            json_text::value(text.as_bytes()).map_err(|error| anyhow!("the request is not valid JSON: {error}"))?;
        Self::from_value(value)
    }

    /// Reads a request from a JSON value, with the checks of [`Request::from_json`].
    ///
    /// # Errors
    /// Another schema, an unknown command or key, or a value of the wrong type.
    pub fn from_value(value: Value) -> Result<Self, Error> {
        let Value::Object(mut given) = value else { return Err(anyhow!("the request is not a JSON object").into()) };
        match given.remove("schema") {
            None => {}
            Some(Value::String(schema)) if schema == SCHEMA => {}
            Some(other) => {
                return Err(anyhow!("the schema of the request is {other}; this program reads {SCHEMA}").into());
            }
        }

        // A key with `null` counts as a key that is absent.
        given.retain(|_, value| !value.is_null());
        let request: Self = parsed(&given).map_err(|error| anyhow!("the request cannot be read: {error}"))?;

        // Every known key is written again. A key that is not written again is unknown to the command.
        let Value::Object(understood) = request.to_value() else {
            unreachable!("a request is serialised as an object")
        };
        if let Some(unknown) = given.keys().find(|key| !understood.contains_key(*key)) {
            let names: Vec<String> = KEYS.iter().map(|(key, _)| (*key).to_owned()).collect();
            let nearest = suggestion(unknown, &names);
            return Err(anyhow!("a request of `{}` has no key `{unknown}`{nearest}", request.command()).into());
        }
        identify::check_keys(&given, &understood)?;

        Ok(request)
    }

    /// Request as JSON, with its schema. A key without a default is absent if it was not given.
    pub fn to_value(&self) -> Value {
        let mut object = Map::from_iter([("schema".to_owned(), Value::from(SCHEMA))]);
        if let Ok(Value::Object(keys)) = serde_json::to_value(self) {
            object.extend(keys);
        }
        Value::Object(object)
    }
}

/// Request read by serde. A missing command is reported separately, because serde's message for it is hard to read.
fn parsed<T: DeserializeOwned>(given: &Map<String, Value>) -> anyhow::Result<T> {
    if !given.contains_key("command") {
        bail!("it has no `command`");
    }
    Ok(serde_json::from_value(Value::Object(given.clone()))?)
}

/// Reads the name of an input signal.
///
/// # Errors
/// A name that is not a signal; the message names the key.
pub(crate) fn input(name: &str) -> anyhow::Result<Input> {
    Input::parse(name).map_err(|reason| anyhow!("⟪input⟫ {name}: {reason}"))
}

/// Reads the name of an output signal.
///
/// # Errors
/// A name that is not a signal; the message names the key.
pub(crate) fn output(name: &str) -> anyhow::Result<Output> {
    Output::parse(name).map_err(|reason| anyhow!("⟪output⟫ {name}: {reason}"))
}

/// Checks that the number of a key is positive.
pub(crate) fn check_positive(key: &str, value: f64) -> anyhow::Result<()> {
    parts::check(key, Some(value), positive)
}

/// Checks that the number of a key is a fraction: above 0, at most 1.
pub(crate) fn check_fraction(key: &str, value: f64) -> anyhow::Result<()> {
    parts::check(key, Some(value), fraction)
}

/// Checks that the number of a key is not negative.
pub(crate) fn check_not_negative(key: &str, value: f64) -> anyhow::Result<()> {
    parts::check(key, Some(value), not_negative)
}

/// Maximum number of points along a cable whose displacements are listed.
pub const MAX_STATIONS: usize = 1000;

/// Checks the number of points along a cable, both ends included.
pub(crate) fn check_stations(count: usize) -> anyhow::Result<()> {
    if !(2..=MAX_STATIONS).contains(&count) {
        bail!("⟪stations⟫: {count} points are not possible: give a whole number from 2 to {MAX_STATIONS}");
    }
    Ok(())
}
