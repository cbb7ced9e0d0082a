//! Request of a simulation in time, and its scenario of events.

use super::key::{Declared, Key, declared};
use super::parts::{NumberColumns, RobotText, State, Tensions};
use funicular::simulation::{ElementMesh, SimulationSettings};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

declared! {
    /// Large motion in time of platform and sagging ropes: released payloads, winches that change lengths or hold
    /// tensions, stops, pushes, gusts, cables that fail or go slack.
    ///
    /// The robot begins at rest. The result states its own error: the run is repeated with a finer mesh and a smaller
    /// tolerance unless ⟪once⟫ is given. docs/simulation.md explains the scenario and the result.
    pub struct SimulateRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Events: lists `release`, `pick`, `lengths`, `tension`, `stop`, `push`, `anchor` and `cut` of events.
        scenario: Scenario = Scenario::default() => (Data(shape::scenario))
            .read_by(Reader::Scenario, "the scenario");
        /// Simulated time [s].
        duration_s: f64 = SIMULATED_S => (Number(Positive));
        /// Time between the rows of the result [s].
        sample_time_s: Option<f64> = None => (Number(Positive)).otherwise("a thousandth of the duration");
        /// Point of the platform whose motion is a part of the result, by a name and its place in the platform frame
        /// [m], as in hook=0,0,-0.5 (repeatable).
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
            .otherwise("the first natural frequency at the start, for a loss factor that of the mode with most \
                stretch");
        /// Damping time of the stretch of all ropes [s] in place of that of the robot file.
        stretch_damping_time_s: Option<f64> = None => (Number(NotNegative)).under("Damping")
            .otherwise("`axial_damping_time_s` of each rope");
        /// Hold the platform where it is, so that only the ropes move.
        hold_platform: bool = false => (Switch);
        /// Draw the gusts of the wind's turbulence from this number; another number gives other gusts of the same
        /// strength.
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
    /// Anchors that move.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub anchor: Vec<AnchorEvent>,
    /// Cables that fail.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub cut: Vec<CutEvent>,
}

declared! {
    /// The platform lets a payload go.
    pub struct ReleaseEvent {
        /// Time [s].
        at_s: f64 = 0.0 => (Number(Finite)).required();
        /// Mass of the payload [kg], a part of the platform's mass.
        mass_kg: f64 = 0.0 => (Number(Finite)).required();
        /// Place of the mass, platform frame [m]; the centre of mass if not given.
        #[serde(skip_serializing_if = "Option::is_none")]
        point_m: Option<[f64; 3]> = None => (Vector);
    }
}

declared! {
    /// The platform takes a payload up.
    pub struct PickEvent {
        /// Time [s].
        at_s: f64 = 0.0 => (Number(Finite)).required();
        /// Mass of the payload [kg].
        mass_kg: f64 = 0.0 => (Number(Finite)).required();
        /// Place of the mass, platform frame [m]; the centre of mass if not given.
        #[serde(skip_serializing_if = "Option::is_none")]
        point_m: Option<[f64; 3]> = None => (Vector);
        /// Velocity of the mass before, world axes [m/s]; that of the platform if not given.
        #[serde(skip_serializing_if = "Option::is_none")]
        velocity_m_s: Option<[f64; 3]> = None => (Vector);
    }
}

declared! {
    /// Winches change unstrained lengths: by `change_m` within `duration_s`, or by a table over time.
    pub struct LengthsEvent {
        /// Beginning [s].
        at_s: f64 = 0.0 => (Number(Finite)).required();
        /// Duration of the change [s].
        #[serde(skip_serializing_if = "Option::is_none")]
        duration_s: Option<f64> = None => (Number(Finite));
        /// Change of each cable [m], by its name; other winches stay at rest.
        #[serde(skip_serializing_if = "Option::is_none")]
        change_m: Option<BTreeMap<String, f64>> = None => (ByCable(Finite));
        /// Table with t_s from the beginning on, and unstrained_length_NAME_m of every cable, or poses.
        #[serde(skip_serializing_if = "Option::is_none")]
        table: Option<NumberColumns> = None => (Columns);
    }
}

declared! {
    /// Winches hold tensions by their torque from now on, instead of lengths.
    pub struct TensionEvent {
        /// Beginning [s].
        at_s: f64 = 0.0 => (Number(Finite)).required();
        /// Time within which the tension goes from the present one to the given one [s].
        duration_s: f64 = 0.0 => (Number(Finite)).required();
        /// Tension at the drum of each cable by its name [N].
        tension_n: BTreeMap<String, f64> = BTreeMap::new() => (ByCable(Finite)).required();
    }
}

declared! {
    /// Brakes bring winches to rest.
    pub struct StopEvent {
        /// Beginning [s].
        at_s: f64 = 0.0 => (Number(Finite)).required();
        /// Time until the winches stand [s].
        duration_s: f64 = 0.0 => (Number(Finite)).required();
        /// Names of the cables whose winches brake; all if not given.
        #[serde(skip_serializing_if = "Option::is_none")]
        cables: Option<Vec<String>> = None => (Texts);
    }
}

declared! {
    /// Force and moment on the platform for a while.
    pub struct PushEvent {
        /// Beginning [s].
        at_s: f64 = 0.0 => (Number(Finite)).required();
        /// Duration [s].
        duration_s: f64 = 0.0 => (Number(Finite)).required();
        /// Time in which it grows at the beginning and fades at the end [s].
        rise_s: f64 = 0.0 => (Number(Finite));
        /// Force, world axes [N].
        force_n: [f64; 3] = [0.0; 3] => (Vector);
        /// Moment, world axes [N m].
        moment_n_m: [f64; 3] = [0.0; 3] => (Vector);
        /// Point at which the force acts, platform frame [m].
        point_m: [f64; 3] = [0.0; 3] => (Vector);
    }
}

declared! {
    /// Anchors move: those of a crane, a ship, a drone, or of the whole base.
    pub struct AnchorEvent {
        /// Beginning [s].
        at_s: f64 = 0.0 => (Number(Finite)).required();
        /// Names of the cables whose anchors have the displacements of the table; all, which is the base, if not given.
        #[serde(skip_serializing_if = "Option::is_none")]
        cables: Option<Vec<String>> = None => (Texts);
        /// Table with t_s from the beginning on, and x_m, y_m, z_m, the displacement from the places of the robot file,
        /// or anchor_NAME_x_m, anchor_NAME_y_m, anchor_NAME_z_m, the place of the anchor of cable NAME.
        table: NumberColumns = NumberColumns::new() => (Columns).required();
    }
}

declared! {
    /// A cable fails, at a time or at a tension, at the platform or at a place along it.
    pub struct CutEvent {
        /// Name of the cable.
        cable: String = String::new() => (Text).required();
        /// Time [s].
        #[serde(skip_serializing_if = "Option::is_none")]
        at_s: Option<f64> = None => (Number(Finite));
        /// Tension at either end at which it fails [N].
        #[serde(skip_serializing_if = "Option::is_none")]
        at_tension_n: Option<f64> = None => (Number(Finite));
        /// Unstrained length between the platform and the place where it fails [m]; 0 at the platform. Both halves
        /// swing on.
        #[serde(skip_serializing_if = "is_zero")]
        place_m: f64 = 0.0 => (Number(Finite));
    }
}

/// Kinds of events with their keys, in the order of the fields of [`Scenario`].
pub(super) fn event_kinds() -> [(&'static str, Vec<Key>); 8] {
    [
        ("release", ReleaseEvent::keys()),
        ("pick", PickEvent::keys()),
        ("lengths", LengthsEvent::keys()),
        ("tension", TensionEvent::keys()),
        ("stop", StopEvent::keys()),
        ("push", PushEvent::keys()),
        ("anchor", AnchorEvent::keys()),
        ("cut", CutEvent::keys()),
    ]
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it with a reference")]
fn is_zero(number: &f64) -> bool {
    *number == 0.0
}
