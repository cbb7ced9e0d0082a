//! Request of a simulation in time, and its scenario of events.

use super::key::declared;
use super::parts::{NumberColumns, RobotText, State, Tensions};
use funicular::simulation::{ElementMesh, SimulationSettings};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

declared! {
    /// Large motion in time of platform and sagging ropes: released payloads, winches that change lengths or hold tensions,
    /// stops, pushes, gusts, cables that fail or go slack.
    ///
    /// The robot begins at rest. The result states its own error: the run is repeated with a finer mesh and a smaller
    /// tolerance unless ⟪once⟫ is given. docs/simulation.md explains the scenario and the result.
    pub struct SimulateRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Events: lists `release`, `pick`, `lengths`, `tension`, `stop`, `push` and `cut` of events.
        scenario: Scenario = Scenario::default() => (Data(shape::scenario));
        /// Simulated time [s].
        duration_s: f64 = SIMULATED_S => (Number(Positive));
        /// Time between the rows of the result [s].
        sample_time_s: Option<f64> = None => (Number(Positive)).otherwise("a thousandth of the duration");
        /// Point of the platform whose motion is a part of the result, by a name and its place in the platform frame [m], as
        /// in hook=0,0,-0.5 (repeatable).
        point: Vec<PointValue> = Vec::new() => (List(ProgramForm::Point)).form("NAME=X,Y,Z");
        /// Error of a position that one step may have [m].
        tolerance_m: f64 = SimulationSettings::TOLERANCE => (Number(Positive)).under("Accuracy");
        /// Number of elements of each rope.
        elements: usize = DEFAULT_MESH.elements => (Count(1..=ElementMesh::MAX_ELEMENTS as u64)).under("Accuracy");
        /// Degree of the polynomials of each element.
        degree: usize = DEFAULT_MESH.degree => (Count(1..=ElementMesh::MAX_DEGREE as u64)).under("Accuracy");
        /// Run once, without the finer run that shows the error.
        once: bool = false => (Switch).under("Accuracy");
        /// Frequency at which the damping ratio of the ropes and their loss factor hold [Hz].
        damping_frequency_hz: Option<f64> = None => (Number(Positive)).under("Damping")
            .otherwise("the first natural frequency at the start, for a loss factor that of the mode with most stretch");
        /// Damping time of the stretch of all ropes [s] in place of that of the robot file.
        stretch_damping_time_s: Option<f64> = None => (Number(NotNegative)).under("Damping")
            .otherwise("`axial_damping_time_s` of each rope");
        /// Hold the platform where it is, so that only the ropes move.
        hold_platform: bool = false => (Switch);
        /// Draw the gusts of the wind's turbulence from this number; another number gives other gusts of the same strength.
        gust_seed: Option<u32> = None => (Count(0..=u64::from(u32::MAX))).otherwise("the mean wind alone");
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
    }
    examples {
        "funicular simulate robots/yuan2014-4mm.toml --mass-kg 12.5 --scenario docs/simulation/release.toml --for 2",
        "funicular simulate robots/yuan2014-4mm.toml --scenario docs/simulation/stop.toml --for 3 --once -o stop.csv",
    }
}

/// Point of the platform with a name.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointValue {
    /// Name, which columns of the result have.
    pub name: String,
    /// Place, platform frame [m].
    pub point_m: [f64; 3],
}

/// Simulated time if none is given [s].
pub const SIMULATED_S: f64 = 10.0;

const DEFAULT_MESH: ElementMesh = ElementMesh::STANDARD;

/// Scenario of a simulation: lists of events, as a TOML file has them in tables `[[release]]`, `[[lengths]]` and so on.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Scenario {
    /// Payloads that the platform lets go.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub release: Vec<ReleaseEvent>,
    /// Payloads that it takes up.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub pick: Vec<PickEvent>,
    /// Commands of lengths.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub lengths: Vec<LengthsEvent>,
    /// Winches that hold tensions.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tension: Vec<TensionEvent>,
    /// Brakes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub stop: Vec<StopEvent>,
    /// Forces on the platform.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub push: Vec<PushEvent>,
    /// Cables that fail.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub cut: Vec<CutEvent>,
}

/// The platform lets a payload go.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReleaseEvent {
    /// Time [s].
    pub at_s: f64,
    /// Mass of the payload [kg], a part of the platform's mass.
    pub mass_kg: f64,
    /// Its place, platform frame [m]; the centre of mass if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point_m: Option<[f64; 3]>,
}

/// The platform takes a payload up.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PickEvent {
    /// Time [s].
    pub at_s: f64,
    /// Mass of the payload [kg].
    pub mass_kg: f64,
    /// Its place, platform frame [m]; the centre of mass if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point_m: Option<[f64; 3]>,
    /// Its velocity before, world axes [m/s]; it moves with the platform if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub velocity_m_s: Option<[f64; 3]>,
}

/// Winches change unstrained lengths: by `change_m` within `duration_s`, or by a table over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LengthsEvent {
    /// Beginning [s].
    pub at_s: f64,
    /// Duration of the change [s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub duration_s: Option<f64>,
    /// Change of each cable [m], by its name; other winches stay at rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub change_m: Option<BTreeMap<String, f64>>,
    /// Table with t_s from the beginning on, and unstrained_length_NAME_m of every cable, or poses.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub table: Option<NumberColumns>,
}

/// Winches hold tensions by their torque from now on, instead of lengths.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TensionEvent {
    /// Beginning [s].
    pub at_s: f64,
    /// Time within which the tension goes from the present one to the given one [s].
    pub duration_s: f64,
    /// Tension at the drum of each cable by its name [N].
    pub tension_n: BTreeMap<String, f64>,
}

/// Brakes bring winches to rest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StopEvent {
    /// Beginning [s].
    pub at_s: f64,
    /// Time until the winches stand [s].
    pub duration_s: f64,
    /// Names of the cables whose winches brake; all if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cables: Option<Vec<String>>,
}

/// Force and moment on the platform for a while.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PushEvent {
    /// Beginning [s].
    pub at_s: f64,
    /// Duration [s].
    pub duration_s: f64,
    /// Time in which it grows at the beginning and fades at the end [s].
    #[serde(default)]
    pub rise_s: f64,
    /// Force, world axes [N].
    #[serde(default)]
    pub force_n: [f64; 3],
    /// Moment, world axes [N m].
    #[serde(default)]
    pub moment_n_m: [f64; 3],
    /// Point at which the force acts, platform frame [m].
    #[serde(default)]
    pub point_m: [f64; 3],
}

/// A cable fails, at a time or at a tension.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CutEvent {
    /// Name of the cable.
    pub cable: String,
    /// Time [s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_s: Option<f64>,
    /// Tension at either end at which it fails [N].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_tension_n: Option<f64>,
}
