//! Request of `design`: values of the robot file to be chosen, and what they have to achieve.

use super::key::declared;
use super::parts::{Model, Places, RobotText, State, Tensions};
use crate::names::DesignGoal;
use serde::{Deserialize, Serialize};

declared! {
    /// Values of the robot file with which the robot is stiffest, fastest or lightest at several poses.
    ///
    /// The values move within their bounds until the goal at the worst pose, or its weighted mean, improves no further.
    /// The poses are held, and the tensions follow ⟪tension_rule⟫. docs/design.md explains goals, demands and the
    /// result.
    pub struct DesignRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Value of the robot file to choose, with its bounds: around the present value, as in
        /// 'cables.*.attachment_m=±0.05' (or +-), or absolute, as in platform.mass_kg=80:120; * stands for any key, and
        /// a path to a table or vector for all numbers of it that the file gives (repeatable).
        change: Vec<ChangeValue> = Vec::new() => (List(ProgramForm::Change)).form("PATH=±REACH|MIN:MAX").required();
        /// Goal of the design.
        #[serde(with = "crate::names")]
        goal: DesignGoal = DesignGoal::default() => (name::<DesignGoal>()).form("GOAL");
        /// Poses.
        #[serde(flatten)]
        places: Places = Places::default() => group;
        /// Weights of the poses, for their mean instead of the worst pose.
        weights: Option<Vec<f64>> = None => (Commas(ProgramForm::Positive)).form("W1,W2,…");
        /// Ropes to choose from for all cables: a table with the columns name, axial_stiffness_n, mass_kg_per_m and,
        /// where known, diameter_m, minimum_tension_n, maximum_tension_n, breaking_load_n. The values are chosen for
        /// each of them.
        ropes: Option<Vec<OfferedRope>> = None => (Data(shape::objects)).under("Choices")
            .read_by(Reader::Records, "the ropes");
        /// Exchange the attachments of cables, two at a time, while the goal with the present values gains from it and
        /// no further cables cross.
        reconnect: bool = false => (Switch).under("Choices");
        /// Demand: first natural frequency at every pose of at least HZ.
        min_frequency_hz: Option<f64> = None => (Number(Positive)).under("Demands");
        /// Demand: minimum stiffness at every pose of at least K, as `statics` prints it [N/m].
        min_stiffness_n_per_m: Option<f64> = None => (Number(Positive)).form("K").under("Demands");
        /// Demand: no natural frequency between two frequencies at any pose, as in 2.5:3.2 [Hz].
        avoid_hz: Option<[f64; 2]> = None => (Written(ProgramForm::Band)).form("FROM:TO").under("Demands");
        /// Maximum number of iterations.
        max_iterations: usize = 50 => (Count(0..=u64::MAX));
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => (group without ["lengths_m", "hold_lengths_of_pose"]);
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
        /// Linearisation.
        #[serde(flatten)]
        model: Model = Model::default() => group;
    }
    examples {
        "funicular design robots/cogiro.toml --poses docs/design/cogiro-poses.csv --target-tension-n 350 \\\n    \
         --change 'cables.*.attachment_m=±0.05' -o designed.toml",
        "funicular design robots/cogiro.toml --pose 1,2,1.5 --change 'cables.*.anchor_m.z=5:6' --goal stiffness-min \
         \\\n    --page design.html",
        "funicular design robots/cogiro.toml --pose 0,0,1.5 --change 'cables.*.anchor_m=±0.5' --goal rope-mass \\\n    \
         --min-stiffness-n-per-m 20000",
    }
}

/// Value of the robot file to choose, with its bounds.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChangeValue {
    /// Path of the value; `*` stands for every name, and a vector without a component for all its components.
    pub path: String,
    /// Minimum.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minimum: Option<f64>,
    /// Maximum.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub maximum: Option<f64>,
    /// Largest change to both sides, instead of minimum and maximum.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plus_minus: Option<f64>,
}

/// Rope to choose.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OfferedRope {
    /// Name.
    pub name: String,
    /// Axial stiffness EA [N].
    pub axial_stiffness_n: f64,
    /// Mass per length [kg/m].
    pub mass_kg_per_m: f64,
    /// Diameter [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diameter_m: Option<f64>,
    /// Minimum tension of its cables [N].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minimum_tension_n: Option<f64>,
    /// Maximum tension of its cables [N].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub maximum_tension_n: Option<f64>,
    /// Tension at which it breaks [N].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub breaking_load_n: Option<f64>,
}

impl OfferedRope {
    /// Keys of its numbers.
    pub(crate) const NUMBERS: [&str; 6] = [
        "axial_stiffness_n",
        "mass_kg_per_m",
        "diameter_m",
        "minimum_tension_n",
        "maximum_tension_n",
        "breaking_load_n",
    ];

    /// Keys of the numbers that every rope has.
    pub(crate) const NEEDED: [&str; 2] = ["axial_stiffness_n", "mass_kg_per_m"];

    /// Keys of a material of the robot file with the values of this rope. A material has its stiffness, or a diameter
    /// with the modulus of its full circle.
    pub(crate) fn material(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let circle = |diameter: f64| 0.25 * std::f64::consts::PI * diameter * diameter;
        let of_circle = self.diameter_m.map(|diameter| self.axial_stiffness_n / circle(diameter));
        let values = [
            ("axial_stiffness_n", self.diameter_m.is_none().then_some(self.axial_stiffness_n)),
            ("youngs_modulus_pa", of_circle),
            ("diameter_m", self.diameter_m),
            ("mass_kg_per_m", Some(self.mass_kg_per_m)),
            ("minimum_tension_n", self.minimum_tension_n),
            ("maximum_tension_n", self.maximum_tension_n),
            ("breaking_load_n", self.breaking_load_n),
        ];
        values.into_iter().filter_map(|(key, value)| Some((key, value?)))
    }
}
