//! Requests: the analysis to run and its options, as plain data.
//!
//! In JSON a request is one flat object. `command` names the analysis, `robot` holds the text of the robot file, and
//! every other key is an option with the same name as in the program (`--mass-kg`) and in Python (`mass_kg=`). An
//! option that is left out has its default.

mod calibrate;
mod design;
mod estimate;
mod files;
mod given;
mod gradient;
mod grids;
mod identify;
mod json_text;
pub mod key;
mod library_words;
mod loads;
mod pages;
mod parts;
mod prove;
mod shape;
mod simulate;
mod source_file;
mod speeds;
mod statics;
mod steps;
mod trajectory;
mod uncertainty;
mod vibration;
mod winches;
mod workspace;

pub use calibrate::{CalibrateRequest, PriorValue};
pub use design::{ChangeValue, DesignRequest, OfferedRope};
pub use estimate::{EstimateRequest, ObservabilityRequest, SensorModel};
pub use files::{ExportRequest, ImportRequest, NewRequest, SchemaRequest, TABLE_TOLERANCE_M};
pub use given::{check_given, convert_units};
pub(crate) use given::{check_scenario, read};
pub use gradient::{GradientRequest, frequencies};
pub use grids::{EachPoint, MapRequest, MergeRequest, PlotRequest, PointOptions, SweepRequest};
pub use identify::{Experiment, FitValue, IdentifyRequest};
pub use key::{Choice, Declared, InputFile, Key, Kind, ProgramForm, Range, Reader};
pub use loads::{LoadsRequest, Requirements};
pub use pages::{LiveRequest, PaperRequest, ReportRequest, ValidateRequest};
pub use parts::{
    Axis, Change, FrequencyRange, GappedColumns, ImportPlatform, ImportRopes, Load, MAX_HZ, Model, NumberColumns,
    OneOrSeveral, Places, Pose, ResponsePoints, ResponseRange, RobotText, State, Tensions, Terms,
};
pub use prove::{BOXES, Division, ProveRequest};
pub use shape::schema;
pub use simulate::{
    AnchorEvent, CutEvent, LengthsEvent, PickEvent, PointValue, PushEvent, ReleaseEvent, SIMULATED_S, Scenario,
    SimulateRequest, StopEvent,
};
pub use source_file::{MAX_BYTES, SourceFile};
pub use speeds::{RequiredVelocities, SpeedsRequest};
pub use statics::{
    CheckRequest, ClearanceRequest, ParametersRequest, PayloadRequest, PoseErrorRequest, StaticsRequest,
    StiffnessRequest,
};
pub use steps::{Steps, digits};
pub use trajectory::{MotionOptions, TrajectoryRequest};
pub use uncertainty::{CovarianceEntry, UncertaintyRequest};

pub(crate) use vibration::GUST_DURATION;
pub use vibration::{
    CableRequest, CompareRequest, FrfRequest, GustRequest, ModesRequest, ReduceRequest, SettleRequest,
    TurbulenceOptions,
};
pub use winches::{OfferedWinch, WinchesRequest};
pub use workspace::{BoundValue, WorkspaceRequest};

pub use parts::check;
pub(crate) use parts::check_vector;

use crate::error::Error;
use crate::names::suggestion;
use crate::signals::{Input, Output};
use crate::values::{fraction, not_negative, positive};
use anyhow::{anyhow, bail};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::sync::LazyLock;

/// Name and version of the vocabulary of requests. The version changes if the meaning of a key changes.
pub const SCHEMA: &str = "funicular-request/1";

/// Command of the program and of requests.
#[derive(Debug, Clone)]
pub struct CommandInfo {
    /// Name.
    pub name: &'static str,
    /// Meaning; further paragraphs follow after an empty line.
    pub about: String,
    /// Uses of the program.
    pub examples: &'static [&'static str],
    /// Robot file of its request.
    pub robot: RequestRobot,
    /// Keys of its request besides `command`, in the order of the program's help.
    pub keys: Vec<Key>,
}

/// Robot file of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RequestRobot {
    /// None.
    None,
    /// One that has to be given.
    Needed,
    /// In the program the embedded one, if none is given.
    Embedded,
}

/// Declares the commands: variant and type of each request, its name, and the field with its robot.
macro_rules! commands {
    ($($Variant:ident($Request:ident) $name:literal $Robot:ident $($robot:ident)?;)*) => {
        /// Request of one analysis of one robot, or, for a few commands, of files.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        #[serde(tag = "command", rename_all = "kebab-case")]
        pub enum Request {
            $(#[doc = concat!("Request of `", $name, "`.")] $Variant($Request),)*
        }

        /// Every command, in the order of the program's help.
        pub fn commands() -> &'static [CommandInfo] {
            static COMMANDS: LazyLock<Vec<CommandInfo>> = LazyLock::new(|| {
                vec![$(CommandInfo {
                    name: $name,
                    about: $Request::about(),
                    examples: $Request::EXAMPLES,
                    robot: RequestRobot::$Robot,
                    keys: $Request::keys(),
                }),*]
            });
            &COMMANDS
        }

        impl Request {
            /// Name of the command.
            pub fn command(&self) -> &'static str {
                match self {
                    $(Self::$Variant(_) => $name,)*
                }
            }

            /// Robot file of the request, if it has one.
            pub fn robot(&self) -> Option<&RobotText> {
                match self {
                    $(Self::$Variant(request) => {
                        let _ = request;
                        None$(.or(Some(&request.$robot)))?
                    })*
                }
            }
        }
    };
}

commands! {
    New(NewRequest) "new" None;
    Schema(SchemaRequest) "schema" None;
    Check(CheckRequest) "check" Needed robot;
    Parameters(ParametersRequest) "parameters" Needed robot;
    Statics(StaticsRequest) "statics" Needed robot;
    Stiffness(StiffnessRequest) "stiffness" Needed robot;
    Modes(ModesRequest) "modes" Needed robot;
    Frf(FrfRequest) "frf" Needed robot;
    Settle(SettleRequest) "settle" Needed robot;
    Gust(GustRequest) "gust" Needed robot;
    Compare(CompareRequest) "compare" Needed robot;
    Gradient(GradientRequest) "gradient" Needed robot;
    Uncertainty(UncertaintyRequest) "uncertainty" Needed robot;
    Payload(PayloadRequest) "payload" Needed robot;
    Loads(LoadsRequest) "loads" Needed robot;
    Speeds(SpeedsRequest) "speeds" Needed robot;
    Winches(WinchesRequest) "winches" Needed robot;
    Trajectory(TrajectoryRequest) "trajectory" Needed robot;
    Simulate(SimulateRequest) "simulate" Needed robot;
    Clearance(ClearanceRequest) "clearance" Needed robot;
    PoseError(PoseErrorRequest) "pose-error" Needed robot;
    Cable(CableRequest) "cable" Needed robot;
    Reduce(ReduceRequest) "reduce" Needed robot;
    Identify(IdentifyRequest) "identify" Needed robot;
    Calibrate(CalibrateRequest) "calibrate" Needed robot;
    Estimate(EstimateRequest) "estimate" Needed robot;
    Observability(ObservabilityRequest) "observability" Needed robot;
    Design(DesignRequest) "design" Needed robot;
    Map(MapRequest) "map" Needed robot;
    Sweep(SweepRequest) "sweep" Needed robot;
    Workspace(WorkspaceRequest) "workspace" Needed robot;
    Prove(ProveRequest) "prove" Needed robot;
    Merge(MergeRequest) "merge" None;
    Plot(PlotRequest) "plot" None;
    Report(ReportRequest) "report" Embedded robot;
    Live(LiveRequest) "live" Embedded robot;
    Paper(PaperRequest) "paper" None;
    Import(ImportRequest) "import" None;
    Export(ExportRequest) "export" Needed robot;
    Validate(ValidateRequest) "validate" None;
}

impl Request {
    /// Reads a request from JSON. A key that the command does not have is refused, and the nearest known key is
    /// suggested.
    ///
    /// # Errors
    /// Text that is not JSON, a key that is there twice, another schema, an unknown command or key, or a value of the
    /// wrong type.
    pub fn from_json(text: &str) -> Result<Self, Error> {
        Self::from_value(Self::value_of_json(text)?)
    }

    /// Value of a text in JSON, for a front end that takes keys of its own out of it.
    ///
    /// # Errors
    /// Text that is not JSON, or a key that is there twice.
    pub fn value_of_json(text: &str) -> Result<Value, Error> {
        json_text::value(text.as_bytes()).map_err(|error| {
            anyhow!("the request is not valid JSON: {}", library_words::of_form(&error.to_string())).into()
        })
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
        let command = command_of(&given).map_err(|error| anyhow!("the request cannot be read: {error}"))?;
        let keys = &command.keys;
        if let Some(unknown) =
            given.keys().find(|name| *name != "command" && !keys.iter().any(|key| key.name == **name))
        {
            let all = commands().iter().flat_map(|command| &command.keys);
            let nearest = suggestion(unknown, &all.map(|key| key.name.to_owned()).collect::<Vec<_>>());
            return Err(anyhow!("a request of `{}` has no key `{unknown}`{nearest}", command.name).into());
        }
        if let Some(missing) = keys.iter().find(|key| key.required && !given.contains_key(key.name)) {
            return Err(anyhow!("a request of `{}` needs ⟪{}⟫", command.name, missing.name).into());
        }
        convert_units(command.name, &mut given)?;
        check_given(command.name, &given)?;

        Ok(given::read(Value::Object(given)).map_err(|error| anyhow!("the request cannot be read: {error}"))?)
    }

    /// Request as JSON, with its schema. A key without a default is absent if it was not given.
    pub fn to_value(&self) -> Value {
        let mut object = Map::from_iter([("schema".to_owned(), Value::from(SCHEMA))]);
        if let Ok(keys) = keys_of(self) {
            object.extend(keys);
        }
        Value::Object(object)
    }
}

impl IdentifyRequest {
    /// Reads a list of experiments from JSON, with the checks of a request.
    ///
    /// # Errors
    /// Bytes that are not JSON, a key that is there twice, no list, an unknown key, or a value of the wrong type.
    pub fn experiments_from_json(bytes: &[u8]) -> anyhow::Result<Vec<Experiment>> {
        let given = json_text::value(bytes)
            .map_err(|error| anyhow::anyhow!("it is not valid JSON: {}", library_words::of_form(&error.to_string())))?;
        given::check_experiments(&given)?;
        given::read(given)
    }
}

/// Keys of a request, or of a group of them, as JSON; those that are not given are absent.
///
/// # Errors
/// A value that is no object of JSON.
pub fn keys_of(group: &impl Serialize) -> serde_json::Result<Map<String, Value>> {
    fn given(value: Value) -> Value {
        match value {
            Value::Object(keys) => Value::Object(without_null(keys)),
            Value::Array(values) => Value::Array(values.into_iter().map(given).collect()),
            other => other,
        }
    }
    fn without_null(keys: Map<String, Value>) -> Map<String, Value> {
        keys.into_iter().filter(|(_, value)| !value.is_null()).map(|(key, value)| (key, given(value))).collect()
    }
    serde_json::from_value(serde_json::to_value(group)?).map(without_null)
}

/// Command that a request names.
fn command_of(given: &Map<String, Value>) -> anyhow::Result<&'static CommandInfo> {
    let Some(command) = given.get("command") else { bail!("it has no `command`") };
    let Some(name) = command.as_str() else { bail!("its `command` is {command}: give the name of a command") };
    let found = commands().iter().find(|info| info.name == name);
    found.ok_or_else(|| {
        let names: Vec<String> = commands().iter().map(|command| command.name.to_owned()).collect();
        anyhow!("there is no command `{name}`{}", suggestion(name, &names))
    })
}

/// Reads the name of an input signal.
///
/// # Errors
/// A name that is not a signal; the message names the key.
pub fn input(name: &str) -> anyhow::Result<Input> {
    Input::parse(name).map_err(|reason| anyhow!("⟪input⟫ {name}: {reason}"))
}

/// Reads the name of an output signal.
///
/// # Errors
/// A name that is not a signal; the message names the key.
pub fn output(name: &str) -> anyhow::Result<Output> {
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
