//! Names of models, rules and terms in requests, on the command line and in Python.

use crate::differenced_goals::{DIFFERENCED, DifferencedGoal};
use crate::measure::{MEASURES, MIN_STIFFNESS, Measure, MeasureGoal, MeasureGroup, RobotMeasure};
use funicular::cable::CableModel;
use funicular::dynamics::Assembly;
use funicular::gradient::Hold;
use funicular::math::chosen_rows::RowCriterion;
use funicular::path::CourseForm;
use funicular::robot::{LoadShape, Robot, TurbulenceSpectrum, WinchMode};
use funicular::statics::{StaticModel, TensionRule};
use funicular::suggest::nearest;
use serde::{Deserialize, Deserializer, Serializer};
use serde_json::{Value, json};

/// Closed set of choices, each with a name.
pub trait Named: Copy + PartialEq + Sized + 'static {
    /// Noun for the set, as in "static model".
    const WHAT: &'static str;

    /// All choices, in the order of lists and messages.
    const ALL: &'static [Self];

    /// Name of the choice.
    fn name(self) -> &'static str;

    /// Meaning of the choice, for help texts.
    fn about(self) -> &'static str;

    /// Another name that the program understands.
    fn also(self) -> Option<&'static str> {
        None
    }

    /// Choice with a given name.
    ///
    /// # Errors
    /// A message that suggests a near name or else lists all names.
    fn from_name(name: &str) -> Result<Self, String> {
        if let Some(found) = Self::ALL.iter().find(|choice| choice.name() == name) {
            return Ok(*found);
        }
        let all: Vec<String> = Self::ALL.iter().map(|choice| choice.name().to_owned()).collect();
        Err(no_such(Self::WHAT, name, &all))
    }
}

/// Closed sets with a line for every choice, in the order of lists and messages: its name, unless the type has names
/// of its own, and its meaning. A set that begins with `enum` is defined too, and the meanings document its choices.
macro_rules! named {
    ($(#[$meta:meta])* enum $set:ident, $what:literal {
        $($(#[$of_choice:meta])* $choice:ident $name:literal $(or $also:literal)?, $about:literal;)*
    }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $set {
            $(#[doc = concat!($about, ".")] $(#[$of_choice])* $choice,)*
        }

        named! { $set, $what { $($choice $name $(or $also)?, $about;)* } }
    };
    ($set:ident, $what:literal { $($choice:ident $name:literal $(or $also:literal)?, $about:literal;)* }) => {
        impl Named for $set {
            const WHAT: &'static str = $what;
            const ALL: &'static [Self] = &[$(Self::$choice),*];

            fn name(self) -> &'static str {
                match self {
                    $(Self::$choice => $name,)*
                }
            }

            fn about(self) -> &'static str {
                match self {
                    $(Self::$choice => $about,)*
                }
            }

            fn also(self) -> Option<&'static str> {
                match self {
                    $(Self::$choice => named!(@also $($also)?),)*
                }
            }
        }
    };
    ($set:ident, $what:literal, named $name:path { $($choice:ident, $about:literal;)* }) => {
        impl Named for $set {
            const WHAT: &'static str = $what;
            const ALL: &'static [Self] = &[$(Self::$choice),*];

            fn name(self) -> &'static str {
                $name(self)
            }

            fn about(self) -> &'static str {
                match self {
                    $(Self::$choice => $about,)*
                }
            }
        }
    };
    (@also $also:literal) => {
        Some($also)
    };
    (@also) => {
        None
    };
}

// After the macro that it uses.
mod exports;

pub use exports::ExportFormat;

named! {
    /// Sensors besides the encoders of the cables.
    enum SensorSet, "sensor" {
        None "none", "the encoders alone";
        Tensions "tensions", "load cells of all cables, at anchors or drums";
        CableAngles "cable-angles", "directions in which all cables leave their anchors";
        Gyroscope "gyroscope", "angular velocity of the platform";
        Accelerometer "accelerometer", "specific force on the platform, which tells the direction of gravity";
        Tracker "tracker", "position of the tracked point";
    }
}

impl SensorSet {
    /// Names of all.
    pub fn names() -> impl Iterator<Item = &'static str> {
        Self::ALL.iter().map(|sensor| sensor.name())
    }
}

/// Message about a name that no thing of a kind has.
pub fn no_such(what: &str, name: &str, all: &[String]) -> String {
    format!("there is no {what} `{name}`{}", suggestion(name, all))
}

/// End of a message: `; did you mean …` for a near name, else `; there are …` with the first names.
pub fn suggestion(word: &str, names: &[String]) -> String {
    match nearest(word, names.iter().map(String::as_str)) {
        Some(name) => format!("; did you mean `{name}`?"),
        None => listed(names),
    }
}

/// Minimum length of a word that is searched in the keys of paths: two letters stand in too many of them.
const MIN_WORD: usize = 3;

/// End of a message about a path that no number has: the paths with a key that begins with its last word or contains
/// it, as `mass` does for `platform.mass_kg`; else as [`suggestion`].
pub(crate) fn path_suggestion(text: &str, paths: &[String]) -> String {
    let text = text.trim().to_lowercase();
    let mut keys: Vec<&str> = text.split('.').collect();
    while keys.last().is_some_and(|key| key.len() < MIN_WORD) {
        keys.pop();
    }
    let Some((word, parents)) = keys.split_last() else { return suggestion(&text, paths) };

    // The best path has all parents of the text, then a key that begins with the word, then the shortest key.
    let mut ranked: Vec<((usize, bool, usize), String)> = Vec::new();
    for path in paths {
        let own: Vec<&str> = path.split('.').collect();
        let Some(at) = own.iter().rposition(|key| key.to_lowercase().contains(word)) else { continue };
        let missing = parents.iter().filter(|parent| !own[..at].contains(parent)).count();
        let key = own[at].to_lowercase();
        let found = ((missing, !key.starts_with(word), key.len()), own[..=at].join("."));
        if !ranked.contains(&found) {
            ranked.push(found);
        }
    }
    let Some(best) = ranked.iter().map(|(rank, _)| *rank).min() else { return suggestion(&text, paths) };

    const SHOWN: usize = 3;
    let same: Vec<String> =
        ranked.iter().filter(|(rank, _)| *rank == best).map(|(_, path)| format!("`{path}`")).collect();
    let more = if same.len() > SHOWN { ", …" } else { "" };
    format!("; did you mean {}{more}?", same[..same.len().min(SHOWN)].join(" or "))
}

/// End of a message that lists the names; only the first ones if there are many.
pub(crate) fn listed(names: &[String]) -> String {
    const SHOWN: usize = 12;
    if names.is_empty() {
        return String::new();
    }
    let shown: Vec<String> = names.iter().take(SHOWN).map(|name| format!("`{name}`")).collect();
    format!(
        "; there {} {}{}",
        if names.len() == 1 { "is" } else { "are" },
        shown.join(", "),
        if names.len() > SHOWN { ", …" } else { "" }
    )
}

named! {
    /// Which orientations of a set have to be possible at a position of the workspace.
    #[derive(Default)]
    enum OrientationRule, "rule of orientations" {
        #[default]
        All "all", "positions at which every orientation of the grid is possible (total orientation workspace)";
        Some "some", "positions at which one of them is possible (inclusive orientation workspace)";
    }
}

named! {
    TurbulenceSpectrum, "spectrum of turbulence", named TurbulenceSpectrum::word {
        Kaimal, "Kaimal, as in IEC 61400-1";
        VonKarman, "Von Kármán";
    }
}

named! {
    WinchMode, "mode of winches", named WinchMode::name {
        AsGiven, "As the robot file describes them";
        Clamped, "Motors held at their angle";
        Torque, "Motors with constant torque";
        Stuck, "Cables that stick to their pulleys";
    }
}

named! {
    LoadShape, "shape" {
        Box "box", "Every component varies by itself";
        Ellipsoid "ellipsoid", "Ellipsoid with these half axes; a ball if they are equal";
    }
}

named! {
    StaticModel, "static model", named StaticModel::name {
        Ideal, "Straight, massless, rigid";
        Spring, "Straight, massless, elastic";
        Catenary, "Elastic, sagging under its own weight";
    }
}

named! {
    CourseForm, "course", named CourseForm::name {
        ContinuousJerk,
            "Fifteen phases: the jerk rises and falls in straight lines, so that the rates of the lengths do not jump";
        JerkLimited, "Seven phases of constant jerk: the fastest course within the limits";
        Quintic, "Polynomial of the fifth degree; the jerk jumps at both ends";
        Septic, "Polynomial of the seventh degree, without jerk at both ends";
    }
}

impl Named for CableModel {
    const WHAT: &'static str = "cable model";
    const ALL: &'static [Self] = &CableModel::ALL;

    fn name(self) -> &'static str {
        CableModel::name(self)
    }

    fn about(self) -> &'static str {
        CableModel::about(self)
    }
}

named! {
    Assembly, "assembly", named Assembly::name {
        Consistent, "All terms: end stiffness of the cables, and rotation of their forces on their lever arms";
        WithoutGeometricStiffness, "End stiffness of the cables only, as in Yuan et al. 2014";
    }
}

/// Tension rules by name; see [`TensionRule`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TensionRuleName {
    /// Minimum sum of squares of the tensions above their minimum.
    Lowest,
    /// Minimum sum of squares of the differences from the target tensions.
    Closest,
    /// Maximum distance from the limits, relative to the distance between them.
    Middle,
    /// Centre of the tensions within the limits, a smooth function of pose and numbers.
    Centre,
    /// Maximum of the minimum eigenvalue of the scaled stiffness.
    Stiffest,
}

impl Named for TensionRuleName {
    const WHAT: &'static str = "tension rule";
    const ALL: &'static [Self] = &[Self::Lowest, Self::Closest, Self::Middle, Self::Centre, Self::Stiffest];

    fn name(self) -> &'static str {
        match self {
            Self::Lowest => TensionRule::Lowest.name(),
            Self::Closest => TensionRule::Closest(Vec::new()).name(),
            Self::Middle => TensionRule::Middle.name(),
            Self::Centre => TensionRule::Centre.name(),
            Self::Stiffest => TensionRule::Stiffest.name(),
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Lowest => "Minimum sum of squares of the tensions above their minimum",
            Self::Closest => "Minimum sum of squares of the differences from ⟪target_tension_n⟫",
            Self::Middle => "Maximum distance from the limits, relative to the distance between them",
            Self::Centre => {
                "Centre of the tensions within the limits, which changes smoothly: for paths and controllers"
            }
            Self::Stiffest => "Maximum of the minimum eigenvalue of the scaled stiffness",
        }
    }
}

impl From<&TensionRule> for TensionRuleName {
    fn from(rule: &TensionRule) -> Self {
        match rule {
            TensionRule::Lowest => Self::Lowest,
            TensionRule::Closest(_) => Self::Closest,
            TensionRule::Middle => Self::Middle,
            TensionRule::Centre => Self::Centre,
            TensionRule::Stiffest => Self::Stiffest,
        }
    }
}

named! {
    RowCriterion, "criterion" {
        Variances "variances", "Least sum of the variances of the chosen values";
        Determinant "determinant", "Least determinant of the covariance of all values, whatever their units";
    }
}

named! {
    /// Kind of a measured time history.
    #[derive(Default)]
    enum HistoryKind, "kind of time histories" {
        #[default]
        Decay "decay", "Free decay after a push, a release or a stop";
        Ambient "ambient", "Record under wind or other broad-band excitation that is not measured";
    }
}

named! {
    /// Form of a reduced model.
    #[derive(Default)]
    enum ModelForm, "form" {
        #[default]
        StateSpace "state-space", "State space of the modes that inputs and outputs see";
        SecondOrder "second-order",
            "M, C, K of the platform and all modes of the cables with fixed ends, and their state space";
    }
}

named! {
    Hold, "choice of what is held", named Hold::name {
        Lengths, "The unstrained lengths; the pose follows";
        Pose, "The pose; the unstrained lengths follow";
        Rule, "The pose and the rule of ⟪tension_rule⟫; the unstrained lengths follow";
    }
}

/// Number that a design improves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum DesignGoal {
    /// Highest first natural frequency, cables included.
    #[default]
    First,
    /// Highest first natural frequency of the platform on the static stiffness of its cables.
    Platform,
    /// Highest minimum stiffness.
    Stiffness,
    /// Best value of a measure of the robot at rest.
    Measure(GoalMeasure),
    /// Best value of what has no derivatives of its own.
    Differenced(&'static DifferencedGoal),
    /// Most poses at which the required loads are held.
    Workspace,
}

/// Measure of the robot at rest with its goal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GoalMeasure {
    measure: &'static RobotMeasure,
    sign: f64,
    about: &'static str,
}

impl DesignGoal {
    /// Number that improves, with derivatives of its own; with [`Self::Platform`] that of the platform on the static
    /// stiffness of its cables.
    pub(crate) fn measure(self) -> Option<Measure> {
        match self {
            Self::First | Self::Platform => Some(Measure::Frequency(0)),
            Self::Stiffness => Some(Measure::Robot(&MIN_STIFFNESS)),
            Self::Measure(of) => Some(of.measure()),
            Self::Differenced(_) | Self::Workspace => None,
        }
    }

    /// Identity of the number that improves, as data.
    pub(crate) fn identity(self, robot: &Robot) -> Value {
        self.measure().map_or_else(|| json!({ "kind": self.name() }), |measure| measure.identity(robot))
    }

    /// Unit of the number that improves.
    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::Differenced(of) => of.unit,
            goal => goal.measure().map_or("1", Measure::unit),
        }
    }

    /// Number in words.
    pub(crate) fn in_words(self) -> &'static str {
        match self {
            Self::First => "first natural frequency",
            Self::Platform => "first natural frequency of the platform",
            Self::Stiffness => MIN_STIFFNESS.name,
            Self::Measure(of) => of.measure.name,
            Self::Differenced(of) => of.name,
            Self::Workspace => "share of the poses at which the required loads are held",
        }
    }

    /// Sign of an improvement.
    pub(crate) fn sign(self) -> f64 {
        match self {
            Self::First | Self::Platform | Self::Stiffness | Self::Workspace => 1.0,
            Self::Measure(of) => of.sign,
            Self::Differenced(of) => of.sign,
        }
    }
}

/// Number of goals: four with a search of their own, those of differences, and those of measures.
const GOAL_COUNT: usize = {
    let (mut count, mut i) = (4 + DIFFERENCED.len(), 0);
    while i < MEASURES.len() {
        count += GoalMeasure::of(&MEASURES[i]).is_some() as usize;
        i += 1;
    }
    count
};

/// All goals, in the order of lists and messages.
static GOALS: [DesignGoal; GOAL_COUNT] = {
    let mut goals = [DesignGoal::First; GOAL_COUNT];
    (goals[1], goals[2]) = (DesignGoal::Platform, DesignGoal::Stiffness);
    let (mut count, mut i) = (3, 0);
    while i < MEASURES.len() {
        if let Some(of) = GoalMeasure::of(&MEASURES[i]) {
            goals[count] = DesignGoal::Measure(of);
            count += 1;
        }
        i += 1;
    }
    i = 0;
    while i < DIFFERENCED.len() {
        goals[count + i] = DesignGoal::Differenced(&DIFFERENCED[i]);
        i += 1;
    }
    goals[count + i] = DesignGoal::Workspace;
    goals
};

impl GoalMeasure {
    /// Number that improves.
    pub(crate) fn measure(self) -> Measure {
        Measure::Robot(self.measure)
    }

    /// Sign of an improvement.
    pub(crate) fn sign(self) -> f64 {
        self.sign
    }

    /// Goal of a group of measures, if it has one.
    const fn of(group: &MeasureGroup) -> Option<Self> {
        match group {
            MeasureGroup::Robot(measure) => match measure.goal {
                Some(MeasureGoal { sign, about }) => Some(Self { measure, sign, about }),
                None => None,
            },
            _ => None,
        }
    }
}

impl Named for DesignGoal {
    const WHAT: &'static str = "goal of a design";
    const ALL: &'static [Self] = &GOALS;

    fn name(self) -> &'static str {
        match self {
            Self::First => "first-frequency",
            Self::Platform => "platform",
            Self::Stiffness => MIN_STIFFNESS.key,
            Self::Measure(of) => of.measure.key,
            Self::Differenced(of) => of.key,
            Self::Workspace => "workspace",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::First => "Highest first natural frequency, cables included",
            Self::Platform => "Highest first natural frequency of the platform on the static stiffness of its cables",
            Self::Stiffness => "Highest minimum stiffness, as `statics` prints it",
            Self::Measure(of) => of.about,
            Self::Differenced(of) => of.about,
            Self::Workspace => "Most of the poses at which the required loads are held",
        }
    }
}

named! {
    /// Step of a number that derivatives are for.
    #[derive(Default)]
    enum Per, "step of derivatives" {
        #[default]
        Unit "unit", "Unit of the number";
        Percent "percent", "Percent of its value";
        Tolerance "tolerance", "Tolerance of the number";
    }
}

named! {
    /// Method for the deviations of results.
    #[derive(Default)]
    enum UncertaintyMethod, "method" {
        #[default]
        Automatic "automatic", "Linear where tensions and frequencies allow it, otherwise sampled";
        Linear "linear", "Linear for every result";
        Sampled "sampled", "Sampled for every result";
    }
}

named! {
    /// Motions of the platforms of new robots.
    #[derive(Default)]
    enum NewMotion, "motion of a new robot" {
        #[default]
        Rigid "rigid" or "spatial", "Three translations and three rotations";
        PointMass "point-mass" or "point", "Three translations";
        PlanarXz "planar-xz" or "planar", "Translations along x and z, rotation about y";
        PlanarXy "planar-xy", "Translations along x and y, rotation about z";
    }
}

impl LengthUnit {
    /// Factor that makes metres of a number.
    pub fn metres(self) -> f64 {
        crate::units::metres(self.name()).unwrap_or(1.0)
    }
}

named! {
    /// Units of lengths in a table of points.
    enum LengthUnit, "unit of length" {
        Metre "m", "Metres";
        Millimetre "mm", "Millimetres";
        Centimetre "cm", "Centimetres";
        Inch "in", "Inches";
        Foot "ft", "Feet";
    }
}

named! {
    /// Types of rope whose numbers follow from a diameter: wire ropes with factors in EN 12385 (Feyrer, Wire Ropes, 2nd
    /// edition 2015, table of factors for stranded ropes), and a fibre rope.
    #[derive(Default)]
    enum RopeType, "type of rope" {
        #[default]
        SixTimes19 "6x19", "Six strands of 19 wires on a steel core";
        SevenTimes7 "7x7", "Seven strands of seven wires";
        Hmpe "hmpe" or "dyneema", "Braided rope of HMPE fibre, as Dyneema or Spectra";
    }
}

named! {
    /// Subjects of the JSON Schemas that the program writes.
    #[derive(Default)]
    enum SchemaSubject, "subject of a schema" {
        #[default]
        RobotFile "robot-file", "Robot files (TOML), for editors";
        Request "request", "Requests (JSON) of all commands, for programs that write them";
        Columns "columns", "Columns (CSV) of results with units and meanings, for programs that read them";
        Results "results", "Results (JSON) of all commands, for programs that read them";
    }
}

named! {
    /// Kinds of reference numbers, by what stands behind them.
    enum ValidationLevel, "level" {
        Exact "exact", "Closed form or equation, solved to many more digits than are compared";
        Program "program", "Another program, which shares no code with this one, or sampled robots";
        Published "published", "Number printed in a publication or in the manual of another program";
        Measured "measured", "Measurement";
    }
}

/// Serialises a choice as its name: for `#[serde(with = "…")]`.
pub(crate) fn serialize<T: Named, S: Serializer>(choice: &T, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(choice.name())
}

/// Reads a choice from its name.
pub(crate) fn deserialize<'de, T: Named, D: Deserializer<'de>>(from: D) -> Result<T, D::Error> {
    T::from_name(&String::deserialize(from)?).map_err(serde::de::Error::custom)
}

/// Serde functions for a choice that may be absent.
pub(crate) mod optional {
    use super::{Deserialize, Deserializer, Named, Serializer};

    #[expect(clippy::ref_option, reason = "serde passes this type")]
    pub(crate) fn serialize<T: Named, S: Serializer>(choice: &Option<T>, to: S) -> Result<S::Ok, S::Error> {
        match choice {
            Some(choice) => to.serialize_some(choice.name()),
            None => to.serialize_none(),
        }
    }

    pub(crate) fn deserialize<'de, T: Named, D: Deserializer<'de>>(from: D) -> Result<Option<T>, D::Error> {
        let name = Option::<String>::deserialize(from)?;
        name.map(|name| T::from_name(&name).map_err(serde::de::Error::custom)).transpose()
    }
}
