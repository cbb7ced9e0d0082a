//! Request of `identify`: measurements in one or several states, and the values to find.

use super::key::declared;
use super::parts::{Axis, Model, Pose, RobotText, State, Tensions};
use crate::measurements::{MeasuredFrequency, MeasuredHistory, MeasuredResponse};
use crate::names::HistoryKind;
use funicular::math::chosen_rows::RowCriterion;
use serde::{Deserialize, Serialize};

/// Number of starts of the search if none is given.
const DEFAULT_STARTS: usize = 10;

/// Deviation of responses that have none, relative to their magnitude.
const DEFAULT_RESPONSE_NOISE: f64 = 0.02;

/// Relative deviation of natural frequencies that have none.
const DEFAULT_FREQUENCY_NOISE: f64 = 0.01;

/// Relative deviation of damping ratios.
const DEFAULT_DAMPING_NOISE: f64 = 0.1;

declared! {
    /// Values of the robot file that fit measurements best, with their deviations.
    ///
    /// Measurements are frequency responses, natural frequencies with damping ratios, time histories of sensors, poses,
    /// tensions and lengths, in one or several states. The result says how sure each value is, and which combinations
    /// the measurements do not determine. docs/identification.md explains files, priors and the result.
    pub struct IdentifyRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Value of the robot file to identify, with optional bounds, as in platform.mass_kg=10:30; * stands for any
        /// key, as in 'materials.*.axial_stiffness_n', and a path to a table or vector for all numbers of it that the
        /// file gives (repeatable). Without any, the frequencies and damping ratios of time histories are found alone.
        fit: Vec<FitValue> = Vec::new() => (List(ProgramForm::Fit)).form("PATH[=MIN:MAX]");
        /// Measurements of the robot, each in a state of its own.
        experiments: Vec<Experiment> = Vec::new() => (Data(shape::experiments));
        /// Maximum number of starts of the search. The first start has the values of the file, the others are spread by
        /// the priors; the search ends at the first start that fits.
        starts: usize = DEFAULT_STARTS => (Count(0..=u64::MAX));
        /// Fitted values with a profile, by their paths, separated by commas: each value is held at steps and all
        /// others are fitted again, until χ² has risen by 3.84; * stands for any key, and a path to a table or vector
        /// for all numbers in it.
        profile: Vec<String> = Vec::new() => (Texts).form("PATHS");
        /// Number of measurements to propose that reduce the deviations most, one after the other.
        propose: usize = 0 => (Count(0..=100)).under("Proposal");
        /// Axis of the poses of a proposal: x, y, z [m], roll, pitch, yaw [degrees], with N values from A to B, or with
        /// listed values (repeatable); an axis that is not given stays at the pose of the first experiment.
        grid: Vec<Axis> = Vec::new() => (List(ProgramForm::GridAxis)).form("AXIS=A:B:N|V,V,…").under("Proposal");
        /// Poses of a proposal instead of a grid: position [m] and roll, pitch, yaw [degrees].
        poses: Option<Vec<[f64; 6]>> = None => (Poses).under("Proposal").excludes(&["grid"])
            .read_by(Reader::Poses, "the poses");
        /// Quantities that can be measured at each of these poses, separated by commas: frequencies (the lowest ones),
        /// tensions, lengths, pose (at the lengths of the file's robot there). Other loads are those of the first
        /// experiment.
        propose_measuring: Vec<String> = vec!["frequencies".to_owned()] => (Texts).form("KINDS").under("Proposal");
        /// Number of the lowest natural frequencies that are measured at each pose of a proposal.
        propose_modes: usize = 6 => (Count(1..=100)).under("Proposal");
        /// Payloads of a proposal [kg], which the platform carries at each of these poses, separated by commas.
        propose_payloads_kg: Option<Vec<f64>> = None =>
            (Commas(ProgramForm::NotNegative)).form("M1,M2,…").under("Proposal")
                .otherwise("that of the first experiment");
        /// Values whose deviations the proposal reduces, by their paths, as in ⟪profile⟫.
        propose_for: Vec<String> = Vec::new() => (Texts).form("PATHS").under("Proposal").otherwise("all fitted values");
        /// Criterion of the proposal. Variances are relative to the values, or in usual errors of values that may be
        /// zero.
        #[serde(with = "crate::names")]
        propose_by: RowCriterion = RowCriterion::default() => (name::<RowCriterion>()).form("CRITERION")
            .under("Proposal");
        /// Largest relative deviation of a positive value that is wanted [%]: the least number of proposed measurements
        /// that reaches it.
        wanted_percent: Option<f64> = None => (Number(Positive)).under("Proposal");
        /// First frequency of the responses that counts [Hz].
        from_hz: Option<f64> = None => (Number(NotNegative)).under("Measurements").otherwise("all");
        /// Last frequency of the responses that counts [Hz].
        to_hz: Option<f64> = None => (Number(Positive)).under("Measurements").otherwise("all");
        /// Standard deviation of responses without deviations, relative to their magnitude; 0.3 % of the median
        /// magnitude is added.
        response_noise: f64 = DEFAULT_RESPONSE_NOISE => (Number(Positive)).form("FRACTION").under("Measurements");
        /// Relative standard deviation of natural frequencies without deviations.
        frequency_noise: f64 = DEFAULT_FREQUENCY_NOISE => (Number(Positive)).form("FRACTION").under("Measurements");
        /// Relative standard deviation of damping ratios.
        damping_noise: f64 = DEFAULT_DAMPING_NOISE => (Number(Positive)).form("FRACTION").under("Measurements");
        /// Kind of measured time histories.
        #[serde(with = "crate::names")]
        history_kind: HistoryKind = HistoryKind::default() => (name::<HistoryKind>()).form("KIND")
            .under("Time histories");
        /// Time at which the histories begin to count [s]: a decay begins after its push has ended.
        history_from_s: Option<f64> = None => (Number(Finite)).under("Time histories").otherwise("all");
        /// Time at which they end to count [s].
        history_to_s: Option<f64> = None => (Number(Finite)).under("Time histories").otherwise("all");
        /// Number of vibrations in a decay, or half the order of the system for a record in wind.
        history_poles: Option<usize> = None => (Count(1..=20)).under("Time histories")
            .otherwise("as many as the readings show");
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
        /// Linearisation.
        #[serde(flatten)]
        model: Model = Model::default() => group;
        /// Natural frequencies with cables that are straight, without mass and rigid in length; with ideal as
        /// ⟪static_model⟫.
        rigid_cables: bool = false => (Switch).under("Model");
    }
    examples {
        "funicular identify docs/quick-start/hall.toml --hold-lengths-of-pose \\\n    --measured \
         docs/identification/hall-modes.csv --fit platform.mass_kg --prior platform.mass_kg=60±10",
        "funicular identify robot.toml --measured test.uff --node 2=0.1,0.08,0.02 --node 1=0.03,-0.02,0.05 \\\n    \
         --fit platform.mass_kg --fit platform.center_of_mass_m --prior platform.center_of_mass_m=0±0.03 -o \
         fitted.toml",
        "funicular identify docs/quick-start/hall.toml --hold-lengths-of-pose \\\n    --measured \
         docs/identification/hall-modes.csv --fit platform.mass_kg --fit materials.rope.youngs_modulus_pa \\\n    \
         --propose 3 --grid x=-2:2:5 --propose-measuring frequencies,tensions",
        "funicular identify docs/quick-start/hall.toml --measured docs/identification/hall-decay.csv",
        "funicular identify robot.toml --experiments poses.json --rigid-cables --fit platform.center_of_mass_m \\\n    \
         --fit platform.inertia_kg_m2 -o result.json --page result.html",
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

declared! {
    /// Measurements of the robot in one state.
    pub struct Experiment {
        /// Name in tables and messages.
        #[serde(skip_serializing_if = "String::is_empty")]
        name: String = String::new() => (Data(shape::text));
        /// Names of the cables that were mounted.
        #[serde(skip_serializing_if = "Option::is_none")]
        cables: Option<Vec<String>> = None => (Data(shape::texts)).otherwise("all");
        /// Payload that the platform carried, beside its own mass [kg].
        #[serde(skip_serializing_if = "Option::is_none")]
        payload_kg: Option<f64> = None => (Number(NotNegative)).under("State").otherwise("none");
        /// Centre of mass of the payload, platform frame [m].
        #[serde(skip_serializing_if = "Option::is_none")]
        payload_center_m: Option<[f64; 3]> = None => (Vector).under("State").otherwise("that of the platform");
        /// Frequency responses.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        responses: Vec<MeasuredResponse> = Vec::new() => (Data(shape::objects));
        /// Natural frequencies.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        frequencies: Vec<MeasuredFrequency> = Vec::new() => (Data(shape::objects));
        /// Time histories of sensors, from which natural frequencies and damping ratios are found.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        histories: Vec<MeasuredHistory> = Vec::new() => (Data(shape::objects));
        /// Measured pose at held lengths [m, degrees].
        #[serde(skip_serializing_if = "Option::is_none")]
        measured_pose: Option<Pose> = None => (Pose).form("X,Y,Z,ROLL,PITCH,YAW").under("Measurements");
        /// Measured tensions at the platform [N], one per cable.
        #[serde(skip_serializing_if = "Option::is_none")]
        measured_tensions_n: Option<Vec<f64>> = None => (PerCable(NotNegative)).form("T1,T2,…").under("Measurements");
        /// Measured unstrained lengths at a held pose [m], one per cable.
        #[serde(skip_serializing_if = "Option::is_none")]
        measured_lengths_m: Option<Vec<f64>> = None => (PerCable(Positive)).form("L1,L2,…").under("Measurements");
        /// Standard deviation of each coordinate of the measured position [m].
        #[serde(skip_serializing_if = "Option::is_none")]
        position_std_m: Option<f64> = None => (Number(Positive)).under("Measurements").otherwise("0.001");
        /// Standard deviation of the measured rotation about each axis [degrees].
        #[serde(skip_serializing_if = "Option::is_none")]
        rotation_std_deg: Option<f64> = None => (Number(Positive)).under("Measurements").otherwise("0.1");
        /// Standard deviation of the measured tensions [N].
        #[serde(skip_serializing_if = "Option::is_none")]
        tension_std_n: Option<f64> = None => (Number(Positive)).under("Measurements").otherwise("1 % of the maximum");
        /// Standard deviation of the measured lengths [m].
        #[serde(skip_serializing_if = "Option::is_none")]
        length_std_m: Option<f64> = None => (Number(Positive)).under("Measurements").otherwise("0.001");
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
    }
}
