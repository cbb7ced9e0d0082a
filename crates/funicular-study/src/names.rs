//! Names of models, rules and terms in requests, on the command line and in Python.

use crate::measure::Measure;
use funicular::cable::CableModel;
use funicular::dynamics::Assembly;
use funicular::gradient::Hold;
use funicular::math::chosen_rows::RowCriterion;
use funicular::path::CourseForm;
use funicular::robot::{LoadShape, TurbulenceSpectrum, WinchMode};
use funicular::statics::{StaticModel, TensionRule};
use funicular::suggest::nearest;
use serde::{Deserialize, Deserializer, Serializer};

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

/// Which orientations of a set have to be possible at a position of the workspace.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OrientationRule {
    /// All of them.
    #[default]
    All,
    /// At least one.
    Some,
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

impl Named for OrientationRule {
    const WHAT: &'static str = "rule of orientations";
    const ALL: &'static [Self] = &[Self::All, Self::Some];

    fn name(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Some => "some",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::All => "positions at which every orientation of the grid is possible (total orientation workspace)",
            Self::Some => "positions at which one of them is possible (inclusive orientation workspace)",
        }
    }
}

impl Named for TurbulenceSpectrum {
    const WHAT: &'static str = "spectrum of turbulence";
    const ALL: &'static [Self] = &[Self::Kaimal, Self::VonKarman];

    fn name(self) -> &'static str {
        self.word()
    }

    fn about(self) -> &'static str {
        match self {
            Self::Kaimal => "Kaimal, as in IEC 61400-1",
            Self::VonKarman => "Von Kármán",
        }
    }
}

impl Named for WinchMode {
    const WHAT: &'static str = "mode of winches";
    const ALL: &'static [Self] = &WinchMode::ALL;

    fn name(self) -> &'static str {
        self.name()
    }

    fn about(self) -> &'static str {
        match self {
            Self::AsGiven => "As the robot file describes them",
            Self::Clamped => "Motors held at their angle",
            Self::Torque => "Motors with constant torque",
            Self::Stuck => "Cables that stick to their pulleys",
        }
    }
}

impl Named for LoadShape {
    const WHAT: &'static str = "shape";
    const ALL: &'static [Self] = &[Self::Box, Self::Ellipsoid];

    fn name(self) -> &'static str {
        match self {
            Self::Box => "box",
            Self::Ellipsoid => "ellipsoid",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Box => "Every component varies by itself",
            Self::Ellipsoid => "Ellipsoid with these half axes; a ball if they are equal",
        }
    }
}

impl Named for StaticModel {
    const WHAT: &'static str = "static model";
    const ALL: &'static [Self] = &StaticModel::ALL;

    fn name(self) -> &'static str {
        StaticModel::name(self)
    }

    fn about(self) -> &'static str {
        match self {
            Self::Ideal => "Straight, massless, rigid",
            Self::Spring => "Straight, massless, elastic",
            Self::Catenary => "Elastic, sagging under its own weight",
        }
    }
}

impl Named for CourseForm {
    const WHAT: &'static str = "course";
    const ALL: &'static [Self] = &CourseForm::ALL;

    fn name(self) -> &'static str {
        CourseForm::name(self)
    }

    fn about(self) -> &'static str {
        match self {
            Self::ContinuousJerk => {
                "Fifteen phases: the jerk rises and falls in straight lines, so that the rates of the lengths do not jump"
            }
            Self::JerkLimited => "Seven phases of constant jerk: the fastest course within the limits",
            Self::Quintic => "Polynomial of the fifth degree; the jerk jumps at both ends",
            Self::Septic => "Polynomial of the seventh degree, without jerk at both ends",
        }
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

impl Named for Assembly {
    const WHAT: &'static str = "assembly";
    const ALL: &'static [Self] = &Assembly::ALL;

    fn name(self) -> &'static str {
        Assembly::name(self)
    }

    fn about(self) -> &'static str {
        match self {
            Self::Consistent => {
                "All terms: end stiffness of the cables, and rotation of their forces on their lever arms"
            }
            Self::WithoutGeometricStiffness => "End stiffness of the cables only, as in Yuan et al. 2014",
        }
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

impl Named for RowCriterion {
    const WHAT: &'static str = "criterion";
    const ALL: &'static [Self] = &[Self::Variances, Self::Determinant];

    fn name(self) -> &'static str {
        match self {
            Self::Variances => "variances",
            Self::Determinant => "determinant",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Variances => "Least sum of the variances of the chosen values",
            Self::Determinant => "Least determinant of the covariance of all values, whatever their units",
        }
    }
}

/// Form of a reduced model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ModelForm {
    /// State space of the modes that inputs and outputs see.
    #[default]
    StateSpace,
    /// Matrices M, C, K of all clamped modes, and their state space.
    SecondOrder,
}

impl Named for ModelForm {
    const WHAT: &'static str = "form";
    const ALL: &'static [Self] = &[Self::StateSpace, Self::SecondOrder];

    fn name(self) -> &'static str {
        match self {
            Self::StateSpace => "state-space",
            Self::SecondOrder => "second-order",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::StateSpace => "State space of the modes that inputs and outputs see",
            Self::SecondOrder => {
                "M, C, K of the platform and all modes of the cables with fixed ends, and their state space"
            }
        }
    }
}

impl Named for Hold {
    const WHAT: &'static str = "choice of what is held";
    const ALL: &'static [Self] = &Hold::ALL;

    fn name(self) -> &'static str {
        Hold::name(self)
    }

    fn about(self) -> &'static str {
        match self {
            Self::Lengths => "The unstrained lengths; the pose follows",
            Self::Pose => "The pose; the unstrained lengths follow",
            Self::Rule => "The pose and the rule of ⟪tension_rule⟫; the unstrained lengths follow",
        }
    }
}

/// Number that a design improves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DesignGoal {
    /// Highest first natural frequency.
    #[default]
    First,
    /// Highest first natural frequency of the platform on the static stiffness of its cables.
    Platform,
    /// Highest minimum stiffness.
    Stiffness,
    /// Least mass of all ropes.
    RopeMass,
    /// Least length of all ropes.
    RopeLength,
}

impl DesignGoal {
    /// Number that improves; with [`Self::Platform`] that of the platform on the static stiffness of its cables.
    pub(crate) fn measure(self) -> Measure {
        match self {
            Self::First | Self::Platform => Measure::Frequency(0),
            Self::Stiffness => Measure::MinStiffness,
            Self::RopeMass => Measure::RopeMass,
            Self::RopeLength => Measure::RopeLength,
        }
    }

    /// Number in words.
    pub(crate) fn in_words(self) -> &'static str {
        match self {
            Self::First => "first natural frequency",
            Self::Platform => "first natural frequency of the platform",
            Self::Stiffness => "minimum stiffness",
            Self::RopeMass => "mass of the ropes",
            Self::RopeLength => "length of the ropes",
        }
    }

    /// Sign of an improvement.
    pub(crate) fn sign(self) -> f64 {
        match self {
            Self::First | Self::Platform | Self::Stiffness => 1.0,
            Self::RopeMass | Self::RopeLength => -1.0,
        }
    }
}

impl Named for DesignGoal {
    const WHAT: &'static str = "goal of a design";
    const ALL: &'static [Self] = &[Self::First, Self::Platform, Self::Stiffness, Self::RopeMass, Self::RopeLength];

    fn name(self) -> &'static str {
        match self {
            Self::First => "first-frequency",
            Self::Platform => "platform",
            Self::Stiffness => "stiffness-min",
            Self::RopeMass => "rope-mass",
            Self::RopeLength => "rope-length",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::First => "Highest first natural frequency, cables included",
            Self::Platform => "Highest first natural frequency of the platform on the static stiffness of its cables",
            Self::Stiffness => "Highest minimum stiffness, as `statics` prints it",
            Self::RopeMass => "Least mass of all ropes",
            Self::RopeLength => "Least length of all ropes",
        }
    }
}

/// Step of a number that derivatives are for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Per {
    /// Unit of the number.
    #[default]
    Unit,
    /// Percent of its value.
    Percent,
    /// Tolerance of the number.
    Tolerance,
}

impl Named for Per {
    const WHAT: &'static str = "step of derivatives";
    const ALL: &'static [Self] = &[Self::Unit, Self::Percent, Self::Tolerance];

    fn name(self) -> &'static str {
        match self {
            Self::Unit => "unit",
            Self::Percent => "percent",
            Self::Tolerance => "tolerance",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Unit => "Unit of the number",
            Self::Percent => "Percent of its value",
            Self::Tolerance => "Tolerance of the number",
        }
    }
}

/// Method for the deviations of results.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum UncertaintyMethod {
    /// Linear where that holds, otherwise sampled.
    #[default]
    Automatic,
    /// Linear for every result.
    Linear,
    /// Sampled for every result.
    Sampled,
}

impl Named for UncertaintyMethod {
    const WHAT: &'static str = "method";
    const ALL: &'static [Self] = &[Self::Automatic, Self::Linear, Self::Sampled];

    fn name(self) -> &'static str {
        match self {
            Self::Automatic => "automatic",
            Self::Linear => "linear",
            Self::Sampled => "sampled",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Automatic => "Linear where tensions and frequencies allow it, otherwise sampled",
            Self::Linear => "Linear for every result",
            Self::Sampled => "Sampled for every result",
        }
    }
}

/// Programs that robots can be exported to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExportFormat {
    /// Python script for OpenSeesPy.
    Opensees,
    /// MoorDyn input file of version 2.
    Moordyn,
    /// MuJoCo model (MJCF).
    Mujoco,
    /// World of Gazebo (SDF).
    Sdf,
    /// Robot for viewers (URDF).
    Urdf,
    /// VTK XML of polylines and polygons (.vtp), for ParaView.
    Vtk,
    /// C99 file with a table of lengths, for firmware.
    C,
    /// Table of lengths in JSON, for firmware that reads its numbers.
    Json,
}

impl Named for ExportFormat {
    const WHAT: &'static str = "format of export";
    const ALL: &'static [Self] =
        &[Self::Opensees, Self::Moordyn, Self::Mujoco, Self::Sdf, Self::Urdf, Self::Vtk, Self::C, Self::Json];

    fn name(self) -> &'static str {
        match self {
            Self::Opensees => "opensees",
            Self::Moordyn => "moordyn",
            Self::Mujoco => "mujoco",
            Self::Sdf => "sdf",
            Self::Urdf => "urdf",
            Self::Vtk => "vtk",
            Self::C => "c",
            Self::Json => "json",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Opensees => "Python script for OpenSeesPy",
            Self::Moordyn => "Input file of version 2",
            Self::Mujoco => "Model in MJCF, with winches as actuators",
            Self::Sdf => "World of Gazebo, whose cables Drake reads as springs",
            Self::Urdf => "Frame and platform for viewers",
            Self::Vtk => "VTK XML of polylines and polygons (.vtp), for ParaView",
            Self::C => "Table of lengths over a box of poses as a C99 file, for firmware",
            Self::Json => "Table of lengths over a box of poses in JSON, for firmware that reads its numbers",
        }
    }
}

impl ExportFormat {
    /// Name of the program as its authors write it.
    pub fn program(self) -> &'static str {
        match self {
            Self::Opensees => "OpenSees",
            Self::Moordyn => "MoorDyn",
            Self::Mujoco => "MuJoCo",
            Self::Sdf => "Gazebo",
            Self::Urdf => "URDF",
            Self::Vtk => "VTK",
            Self::C => "C",
            Self::Json => "JSON",
        }
    }

    /// True if the file is a table of lengths over a box of poses.
    pub fn is_length_table(self) -> bool {
        matches!(self, Self::C | Self::Json)
    }

    /// True if cables of the program are straight springs without mass, with the static model `spring`.
    pub fn has_straight_cables(self) -> bool {
        matches!(self, Self::Mujoco | Self::Sdf | Self::Urdf)
    }

    /// True if the file can hold or compare modes.
    pub fn has_modes(self) -> bool {
        matches!(self, Self::Opensees | Self::Vtk)
    }
}

/// Motions of the platforms of new robots.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum NewMotion {
    /// Three translations and three rotations.
    #[default]
    Rigid,
    /// Three translations.
    PointMass,
    /// Translations along x and z, rotation about y.
    PlanarXz,
}

impl Named for NewMotion {
    const WHAT: &'static str = "motion of a new robot";
    const ALL: &'static [Self] = &[Self::Rigid, Self::PointMass, Self::PlanarXz];

    fn name(self) -> &'static str {
        match self {
            Self::Rigid => "rigid",
            Self::PointMass => "point-mass",
            Self::PlanarXz => "planar-xz",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Rigid => "Three translations and three rotations",
            Self::PointMass => "Three translations",
            Self::PlanarXz => "Translations along x and z, rotation about y",
        }
    }

    fn also(self) -> Option<&'static str> {
        match self {
            Self::Rigid => Some("spatial"),
            Self::PointMass => Some("point"),
            Self::PlanarXz => Some("planar"),
        }
    }
}

/// Units of lengths in a table of points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LengthUnit {
    /// Metres.
    Metre,
    /// Millimetres.
    Millimetre,
}

impl LengthUnit {
    /// Factor that makes metres of a number.
    pub fn metres(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Millimetre => 1e-3,
        }
    }
}

impl Named for LengthUnit {
    const WHAT: &'static str = "unit of length";
    const ALL: &'static [Self] = &[Self::Metre, Self::Millimetre];

    fn name(self) -> &'static str {
        match self {
            Self::Metre => "m",
            Self::Millimetre => "mm",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Metre => "Metres",
            Self::Millimetre => "Millimetres",
        }
    }
}

/// Types of rope whose numbers follow from a diameter: wire ropes with factors in EN 12385 (Feyrer, Wire Ropes, 2nd
/// edition 2015, table of factors for stranded ropes), and a fibre rope.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum RopeType {
    /// Six strands of 19 wires on a steel core.
    #[default]
    SixTimes19,
    /// Seven strands of seven wires: six strands of 7 wires on a steel strand.
    SevenTimes7,
    /// Braided rope of high-modulus polyethylene, as Dyneema or Spectra.
    Hmpe,
}

impl Named for RopeType {
    const WHAT: &'static str = "type of rope";
    const ALL: &'static [Self] = &[Self::SixTimes19, Self::SevenTimes7, Self::Hmpe];

    fn name(self) -> &'static str {
        match self {
            Self::SixTimes19 => "6x19",
            Self::SevenTimes7 => "7x7",
            Self::Hmpe => "hmpe",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::SixTimes19 => "Six strands of 19 wires on a steel core",
            Self::SevenTimes7 => "Seven strands of seven wires",
            Self::Hmpe => "Braided rope of HMPE fibre, as Dyneema or Spectra",
        }
    }

    fn also(self) -> Option<&'static str> {
        (self == Self::Hmpe).then_some("dyneema")
    }
}

/// Subjects of the JSON Schemas that the program writes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum SchemaSubject {
    /// Robot file.
    #[default]
    RobotFile,
    /// Request of any command.
    Request,
    /// Columns of the results of any command.
    Columns,
}

impl Named for SchemaSubject {
    const WHAT: &'static str = "subject of a schema";
    const ALL: &'static [Self] = &[Self::RobotFile, Self::Request, Self::Columns];

    fn name(self) -> &'static str {
        match self {
            Self::RobotFile => "robot-file",
            Self::Request => "request",
            Self::Columns => "columns",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::RobotFile => "Robot files (TOML), for editors",
            Self::Request => "Requests (JSON) of all commands, for programs that write them",
            Self::Columns => "Columns (CSV) of results with units and meanings, for programs that read them",
        }
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
