//! Requests: the analysis to run and its options, as plain data.
//!
//! In JSON a request is one flat object. `command` names the analysis, `robot` holds the text of the robot file, and
//! every other key is an option with the same name as in the program (`--mass-kg`) and in Python (`mass_kg=`). An
//! option that is left out has its default.

mod identify;
mod keys;
mod parts;
mod source_file;
mod steps;

pub use identify::{Experiment, FitValue, IdentifyRequest};
pub use keys::KEYS;
pub use parts::{
    Axis, Change, EachPoint, FrequencyRange, ImportPlatform, ImportRopes, Load, MAX_HZ, Model, OneOrSeveral, Pose,
    ResponsePoints, RobotText, State, Tensions, Terms,
};
pub use source_file::{MAX_BYTES, SourceFile};
pub use steps::{Steps, digits};

pub(crate) use parts::{check, check_vector};

use crate::error::Error;
use crate::names::{ExportFormat, LengthUnit, ModelForm, NewMotion, Per, WireRope, suggestion};
use crate::signals::{Input, Output};
use crate::values::{fraction, not_negative, positive};
use anyhow::{anyhow, bail};
use funicular::gradient::Hold;
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

/// Request of `check`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CheckRequest {
    /// Robot file.
    pub robot: RobotText,
}

/// Request of `parameters`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ParametersRequest {
    /// Robot file.
    pub robot: RobotText,
}

/// Request of `statics`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StaticsRequest {
    /// Robot file.
    pub robot: RobotText,
    /// State and loads.
    #[serde(flatten)]
    pub state: State,
    /// Rule and limits of tensions.
    #[serde(flatten)]
    pub tensions: Tensions,
    /// Search for all equilibria of the unstrained lengths.
    #[serde(default)]
    pub all: bool,
    /// Interval in which friction of pulleys leaves pose and tensions.
    #[serde(default)]
    pub friction_interval: bool,
}

/// Request of `stiffness`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StiffnessRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Frequency [Hz]; at 0 the tangent of the static model unless a cable model is named.
    #[serde(default)]
    pub at_hz: f64,
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

/// Request of `modes`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModesRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Upper limit of the frequencies [Hz].
    pub below_hz: f64,
    /// Input of the response to which the modes contribute; needs an output.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub input: Option<String>,
    /// Output of that response; needs an input.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub output: Option<String>,
    /// Points of that response.
    #[serde(flatten)]
    pub points: ResponsePoints,
    /// Number of points along every cable whose displacements in each mode are listed, ends included.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stations: Option<usize>,
    /// Minimum fraction of the kinetic energy in the platform for the first mode of the platform.
    #[serde(default = "platform_share")]
    pub platform_share: f64,
    /// Compute the damped mode of every undamped mode; otherwise damping ratios are of first order in the damping.
    #[serde(default = "yes")]
    pub damped: bool,
    /// Cables that are rigid in length: the motions that they leave free.
    #[serde(default)]
    pub rigid_cables: bool,
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

/// Request of `frf`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FrfRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Frequencies.
    #[serde(flatten)]
    pub range: FrequencyRange,
    /// Add frequencies until every peak has its height and the drawn curve is accurate.
    #[serde(default)]
    pub adaptive: bool,
    /// Input signal, as `fz`, `cable:3@0.5:fz`, `length:3` or `base-x`, or a list of input signals.
    pub input: OneOrSeveral,
    /// Output signal, as `ay`, `cable:3@0.5:az` or `tension:3`, or a list of output signals.
    pub output: OneOrSeveral,
    /// Points of the platform.
    #[serde(flatten)]
    pub signal_points: ResponsePoints,
    /// Minimum height of a peak above the valleys beside it [dB].
    #[serde(default = "one")]
    pub prominence_db: f64,
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

/// Request of `gradient`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GradientRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Groups of results: `pose`, `lengths`, `tensions`, `stiffness-min`, `frequencies`, `damping`, `response`.
    #[serde(default = "frequencies")]
    pub of: Vec<String>,
    /// Paths of the numbers of the robot file, in which `*` stands for any key; without any all numbers.
    #[serde(default)]
    pub by: Vec<String>,
    /// Quantity that is held while a number changes.
    #[serde(default, with = "crate::names")]
    pub hold: Hold,
    /// Step that the derivatives are for.
    #[serde(default, with = "crate::names")]
    pub per: Per,
    /// Tolerances of numbers, as `PATH=VALUE` or `PATH=PERCENT%`; numbers without one have the usual tolerance.
    #[serde(default)]
    pub tolerances: Vec<String>,
    /// Upper limit of the frequencies [Hz]; for frequencies and damping.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub below_hz: Option<f64>,
    /// Frequency of the response [Hz].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_hz: Option<f64>,
    /// Input of the response.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub input: Option<String>,
    /// Output of the response.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub output: Option<String>,
    /// Points of the response.
    #[serde(flatten)]
    pub points: ResponsePoints,
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

/// Request of `compare`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CompareRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Upper limit of the frequencies [Hz].
    pub below_hz: f64,
    /// Compare the modes of the platform alone.
    #[serde(default)]
    pub platform: bool,
    /// Minimum fraction of the kinetic energy in the platform for a mode of the platform.
    #[serde(default = "platform_share")]
    pub platform_share: f64,
    /// Maximum relative difference of frequency for a model that is good enough.
    #[serde(default = "one_per_cent")]
    pub tolerance: f64,
    /// State and loads.
    #[serde(flatten)]
    pub state: State,
    /// Rule and limits of tensions.
    #[serde(flatten)]
    pub tensions: Tensions,
    /// Terms of the stiffness.
    #[serde(flatten)]
    pub terms: Terms,
}

/// Request of `payload`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PayloadRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Centre of mass of the payload, platform frame [m]. Default: that of the platform.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub payload_center_m: Option<[f64; 3]>,
    /// State and loads.
    #[serde(flatten)]
    pub state: State,
    /// Rule and limits of tensions. The rule only chooses the lengths of a pose that are held; the payload is the
    /// extreme one of all tensions within the limits.
    #[serde(flatten)]
    pub tensions: Tensions,
}

/// Request of `pose-error`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PoseErrorRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Platform masses: first [kg], last [kg], number of them in equal steps.
    pub mass_kg: (f64, f64, usize),
    /// Unstrained lengths [m], one per cable.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lengths_m: Option<Vec<f64>>,
    /// Pose whose unstrained lengths are held: those with which the robot of the file rests there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pose: Option<Pose>,
    /// Rule and limits of the tensions at this pose.
    #[serde(flatten)]
    pub tensions: Tensions,
    /// Maximum distance between spring pose and catenary pose at which springs are good enough [mm].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance_mm: Option<f64>,
}

/// Request of `cable`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CableRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Name of the cable.
    pub name: String,
    /// Frequencies.
    #[serde(flatten)]
    pub range: FrequencyRange,
    /// State and loads.
    #[serde(flatten)]
    pub state: State,
    /// Rule and limits of tensions.
    #[serde(flatten)]
    pub tensions: Tensions,
    /// Cable model.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "crate::names::optional")]
    pub cable_model: Option<funicular::cable::CableModel>,
    /// Leave out the out-of-plane stiffness of the cable.
    #[serde(default)]
    pub in_plane_only: bool,
    /// Winches in vibration.
    #[serde(default, with = "crate::names")]
    pub winches: funicular::robot::WinchMode,
}

/// Request of `reduce`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReduceRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Highest frequency that the model is for [Hz].
    pub below_hz: f64,
    /// Input signals; an empty list stands for all forces and moments on the platform.
    #[serde(default)]
    pub input: Vec<String>,
    /// Output signals; an empty list stands for all displacements and rotations of the platform.
    #[serde(default)]
    pub output: Vec<String>,
    /// Points of the platform.
    #[serde(flatten)]
    pub points: ResponsePoints,
    /// Form of the model.
    #[serde(default, with = "crate::names")]
    pub form: ModelForm,
    /// Maximum number of states of a state space, instead of a tolerance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub order: Option<usize>,
    /// Maximum error of a response relative to its peak (0.01 if neither tolerance nor order is given); for the
    /// second-order form the maximum relative error due to omitted modes (0.001).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Frequency at which viscous damping reproduces constant damping ratios [Hz].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping_at_hz: Option<f64>,
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

/// Request of `map`: quantities over poses, from a grid or a list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MapRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Axes of the grid, each once. An axis that is left out keeps the value of the state.
    #[serde(default)]
    pub grid: Vec<Axis>,
    /// List of poses instead of a grid: position [m] and roll, pitch, yaw [degrees].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub poses: Option<Vec<[f64; 6]>>,
    /// Quantities and options of every point.
    #[serde(flatten)]
    pub point: EachPoint,
}

/// Request of `sweep`: quantities over all combinations of values of the robot file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Values of the robot file that vary, each an axis named by its path. The first axis runs fastest.
    pub vary: Vec<Axis>,
    /// Quantities and options of every point.
    #[serde(flatten)]
    pub point: EachPoint,
}

/// Request of `report`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReportRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Upper limit of the frequencies [Hz].
    #[serde(default = "twenty")]
    pub below_hz: f64,
    /// Minimum fraction of the kinetic energy in the platform for the first mode of the platform.
    #[serde(default = "platform_share")]
    pub platform_share: f64,
    /// Force or moment of the response. Default: `fz`, or `fx` if the platform cannot move along z.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub input: Option<String>,
    /// Motion of the response. Default: `az`, or `ax` if the platform cannot move along z.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub output: Option<String>,
    /// Points of the platform.
    #[serde(flatten)]
    pub points: ResponsePoints,
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

/// Request of `live`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LiveRequest {
    /// Robot file.
    pub robot: RobotText,
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

/// Request of `paper`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PaperRequest {}

/// Request of `validate`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ValidateRequest {}

/// Request of `new`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct NewRequest {
    /// Name of the robot.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Number of cables; default 8, or for a planar platform and a point mass 4.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cables: Option<usize>,
    /// Motion of the platform.
    #[serde(default, with = "crate::names")]
    pub motion: NewMotion,
    /// Table of the points of the cables, in place of a number of cables.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from_csv: Option<SourceFile>,
    /// Unit of the points in the table; default metres, or the unit in the names of the columns.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "crate::names::optional")]
    pub csv_unit: Option<LengthUnit>,
    /// Mass of the platform [kg]; default 100.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_kg: Option<f64>,
    /// Sides of the homogeneous box that gives the inertia [m]; default 1 × 1 × 0.5, or the box around the attachments.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub box_m: Option<[f64; 3]>,
    /// Construction of the wire rope.
    #[serde(default, with = "crate::names")]
    pub rope: WireRope,
    /// Diameter of the rope [m]; default by the mass of the platform, 6 mm for 100 kg.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub diameter_m: Option<f64>,
    /// Axial stiffness EA of another rope [N], in place of construction and diameter; needs its mass.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axial_stiffness_n: Option<f64>,
    /// Mass of that rope per unstrained length [kg/m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_kg_per_m: Option<f64>,
    /// Pose of the state; default a stable pose that the program finds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pose: Option<Pose>,
}

/// Request of `schema`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SchemaRequest {}

/// Request of `import`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ImportRequest {
    /// Files of one robot.
    pub files: Vec<SourceFile>,
    /// Name of the cable set in a CASPR file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cable_set: Option<String>,
    /// Rope values that the files do not give.
    #[serde(flatten)]
    pub ropes: ImportRopes,
    /// Platform values that the files do not give.
    #[serde(flatten)]
    pub platform: ImportPlatform,
}

/// Request of `export`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExportRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Program that the file is for.
    #[serde(with = "crate::names")]
    pub to: ExportFormat,
    /// Elements per cable.
    #[serde(default = "twenty_segments")]
    pub segments: usize,
    /// Upper limit of the frequencies of modes in the file [Hz].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub modes_below_hz: Option<f64>,
    /// State and loads.
    #[serde(flatten)]
    pub state: State,
    /// Rule and limits of tensions.
    #[serde(flatten)]
    pub tensions: Tensions,
}

/// Request of `merge`; only a front end with a disk can run it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MergeRequest {
    /// Paths of the parts.
    pub parts: Vec<String>,
}

/// Request of `plot`; only a front end with a disk can run it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlotRequest {
    /// Path of the file of a map or sweep.
    pub file: String,
}

fn one() -> f64 {
    1.0
}

fn yes() -> bool {
    true
}

/// Results that are differentiated if a request names none.
pub fn frequencies() -> Vec<String> {
    vec!["frequencies".to_owned()]
}

fn one_per_cent() -> f64 {
    funicular::compare::TOLERANCE
}

pub(crate) fn platform_share() -> f64 {
    funicular::modes::PLATFORM_SHARE
}

fn twenty() -> f64 {
    20.0
}

fn twenty_segments() -> usize {
    20
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
            Self::Payload(_) => "payload",
            Self::PoseError(_) => "pose-error",
            Self::Cable(_) => "cable",
            Self::Reduce(_) => "reduce",
            Self::Identify(_) => "identify",
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
            Self::Payload(request) => Some(&request.robot),
            Self::PoseError(request) => Some(&request.robot),
            Self::Cable(request) => Some(&request.robot),
            Self::Reduce(request) => Some(&request.robot),
            Self::Identify(request) => Some(&request.robot),
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
    /// Text that is not JSON, another schema, an unknown command or key, or a value of the wrong type.
    pub fn from_json(text: &str) -> Result<Self, Error> {
        let value: Value =
            serde_json::from_str(text).map_err(|error| anyhow!("the request is not valid JSON: {error}"))?;
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
        let unknown = given.keys().find(|key| !understood.contains_key(*key));
        if let Some(unknown) = unknown.or_else(|| identify::unknown_key(&given, &understood)) {
            let names: Vec<String> = KEYS.iter().map(|(key, _)| (*key).to_owned()).collect();
            let nearest = suggestion(unknown, &names);
            return Err(anyhow!("a request of `{}` has no key `{unknown}`{nearest}", request.command()).into());
        }

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
