//! Quantities of a map or sweep: one row of [`TABLE`] per quantity, and one per [`measure`](crate::measure) that maps
//! show.
//!
//! A row holds everything about its quantity: name, description, text of docs/sweeps.md, requirements, columns and
//! values. Names, help texts, documentation and the evaluation of points read these rows. No other code knows a
//! quantity.

mod table;

use super::evaluation::PointEvaluation;
use super::sensitivity::Sensitivity;
use crate::measure::{self, CableMeasure, Measure, MeasureQuantity, RobotMeasure};
use crate::set_values;
use crate::table::{Column, Value};
use crate::wording::{Words, worded};
use funicular::cable::CableModel;
use funicular::robot::{PlatformMotion, Pose, Robot};
use funicular::statics::StaticModel;
use funicular::suggest::nearest;
use std::fmt;
use std::sync::LazyLock;
use table::TABLE;
use thiserror::Error;

/// Definition of one quantity.
#[derive(Clone)]
struct Definition {
    /// Name, with the form of its parameter.
    name: &'static str,
    /// Description in one line.
    about: &'static str,
    /// Columns and their meaning, in the words of docs/sweeps.md.
    documentation: &'static str,
    takes: ParameterKind,
    needs: RequiredModel,
    /// Number of the lowest natural frequencies that it shows, with the cable model of the options.
    frequencies: fn(&Parameter) -> usize,
    columns: fn(&Robot, &Parameter) -> Vec<Column>,
    /// Function that adds the values of a point, one per column.
    values: fn(&mut PointEvaluation<'_>, &Parameter, &mut Vec<Value>),
    /// Measures in place of `columns` and `values`.
    shows: Option<StaticMeasure>,
    /// Value of a quantity that depends on the pose alone, also where no tensions hold the platform.
    at_pose: Option<fn(&Robot, &Pose) -> f64>,
}

impl Definition {
    /// Quantity without a parameter that exists for every static model and shows no natural frequency. Each row of the
    /// table gives the rest.
    const PLAIN: Self = Self {
        name: "",
        about: "",
        documentation: "",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Anything,
        frequencies: |_| 0,
        columns: |_, _| Vec::new(),
        values: |_, _, _| {},
        shows: None,
        at_pose: None,
    };

    /// All quantities, in the order of the documentation.
    fn all() -> &'static [Self] {
        static ALL: LazyLock<Vec<Definition>> = LazyLock::new(|| {
            let of_cables = measure::of_cables().map(|of| (of.key, of.quantity, StaticMeasure::Cables(of)));
            let of_robot = measure::of_robot().filter_map(|of| Some((of.key, of.quantity?, StaticMeasure::Robot(of))));
            let of_measures =
                of_cables.chain(of_robot).map(|(key, quantity, of)| Definition::of_measure(key, quantity, of));
            TABLE.iter().cloned().chain(of_measures).collect()
        });
        &ALL
    }

    /// Quantity that shows a measure.
    fn of_measure(name: &'static str, quantity: MeasureQuantity, shows: StaticMeasure) -> Self {
        let MeasureQuantity { about, documentation, is_elastic } = quantity;
        let needs = if is_elastic { RequiredModel::Elastic } else { RequiredModel::Anything };
        Self { name, about, documentation, needs, shows: Some(shows), ..Self::PLAIN }
    }
}

/// Measure of the robot at rest.
#[derive(Clone, Copy)]
enum StaticMeasure {
    Cables(&'static CableMeasure),
    Robot(&'static RobotMeasure),
}

impl StaticMeasure {
    /// Measures of the robot, one per column.
    fn members(self, robot: &Robot) -> Vec<Measure> {
        match self {
            Self::Cables(of) => of.members(robot),
            Self::Robot(of) => vec![Measure::Robot(of)],
        }
    }
}

/// Kind of parameter after the colon of a name.
#[derive(Clone)]
enum ParameterKind {
    Nothing,
    /// Number from 1 to [`MAX_FREQUENCIES`].
    Count,
    /// Cable model other than `catenary-dynamic`, with the default for a name without a colon.
    Model(CableModel),
    /// Result and path of a number of the robot file.
    Sensitivity,
    /// Axis of the world, along or about which the platform moves.
    Axis,
}

/// Static models for which a quantity exists.
#[derive(Clone)]
enum RequiredModel {
    Anything,
    /// Models whose cables stretch.
    Elastic,
    Catenary,
    /// Any model, with at least as many cables as degrees of freedom.
    HeldPose,
}

/// Value of the parameter in a name.
#[derive(Debug, Clone, PartialEq)]
enum Parameter {
    None,
    Count(usize),
    Model(CableModel),
    Sensitivity(Sensitivity),
    /// Component of a twist.
    Axis(usize),
}

/// Maximum number of natural frequencies per point.
pub const MAX_FREQUENCIES: usize = 100;

/// Quantity to compute at every point, given by its name; `frequencies:3` and `model-error:spring` have a parameter.
///
/// # Example
/// ```
/// use funicular_study::sweep::Quantity;
///
/// let quantity: Quantity = "frequencies:3".parse()?;
/// assert_eq!((quantity.name(), quantity.count()), ("frequencies:3".to_owned(), Some(3)));
/// let error = "tension-mx".parse::<Quantity>().unwrap_err();
/// assert_eq!(error.to_string(), "there is no quantity `tension-mx`; did you mean `tension-max`?");
/// # Ok::<(), funicular_study::sweep::UnknownQuantity>(())
/// ```
#[derive(Clone)]
pub struct Quantity {
    definition: &'static Definition,
    parameter: Parameter,
}

/// Error of a name that is not a quantity.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("there is no quantity `{name}`{hint}")]
pub struct UnknownQuantity {
    /// Name as given.
    pub name: String,
    /// End of the message: the nearest name, or all names.
    pub hint: String,
}

impl Quantity {
    /// Names of all quantities, with the form of their parameters, in the order of the documentation.
    pub fn names() -> impl Iterator<Item = &'static str> {
        Definition::all().iter().map(|definition| definition.name)
    }

    /// Rows of a Markdown table of all quantities: name, description.
    pub fn documentation() -> String {
        let rows: Vec<String> = Definition::all()
            .iter()
            .map(|of| format!("| `{}` | {} |\n", of.name, worded(of.documentation, Words::Program)))
            .collect();
        rows.concat()
    }

    /// Every quantity with one of its parameters, and its name with the form of the parameter.
    pub(super) fn examples() -> impl Iterator<Item = (&'static str, Self)> {
        Definition::all().iter().filter_map(|definition| {
            let parameter = match definition.takes {
                ParameterKind::Nothing => Some(Parameter::None),
                ParameterKind::Count => Some(Parameter::Count(1)),
                ParameterKind::Model(default) => Some(Parameter::Model(default)),
                ParameterKind::Sensitivity => Sensitivity::parse(Sensitivity::EXAMPLE).map(Parameter::Sensitivity),
                ParameterKind::Axis => Some(Parameter::Axis(0)),
            };
            Some((definition.name, Self { definition, parameter: parameter? }))
        })
    }

    /// Name with its parameter, also if the parameter is the default.
    pub fn name(&self) -> String {
        let head = self.definition.head();
        match &self.parameter {
            Parameter::None => head.to_owned(),
            Parameter::Count(count) => format!("{head}:{count}"),
            Parameter::Model(model) => format!("{head}:{model}"),
            Parameter::Sensitivity(of) => format!("{head}:{}", of.name()),
            Parameter::Axis(axis) => format!("{head}:{}", twist_axes()[*axis]),
        }
    }

    /// Description in one line.
    pub fn about(&self) -> &'static str {
        self.definition.about
    }

    /// Number of values, if the name contains it: 3 for `frequencies:3`.
    pub fn count(&self) -> Option<usize> {
        match self.parameter {
            Parameter::Count(count) => Some(count),
            Parameter::None | Parameter::Model(_) | Parameter::Sensitivity(_) | Parameter::Axis(_) => None,
        }
    }

    /// Path of the number of the robot file by which it differentiates.
    pub(crate) fn path(&self) -> Option<&set_values::ValuePath> {
        self.parameter.sensitivity().map(Sensitivity::path)
    }

    /// Columns of the quantity for a robot.
    pub fn columns(&self, robot: &Robot) -> Vec<Column> {
        let Some(shows) = self.definition.shows else { return (self.definition.columns)(robot, &self.parameter) };
        let column = |of: Measure| table::column(of.column(robot), of.unit(), self.definition.about);
        shows.members(robot).into_iter().map(column).collect()
    }

    /// Number of the lowest natural frequencies that it shows, with the cable model of the options.
    pub(super) fn frequencies(&self) -> usize {
        (self.definition.frequencies)(&self.parameter)
    }

    /// True if it does not exist for a static model.
    pub(crate) fn excludes(&self, model: StaticModel) -> bool {
        match self.definition.needs {
            RequiredModel::Anything | RequiredModel::HeldPose => false,
            RequiredModel::Elastic => model == StaticModel::Ideal,
            RequiredModel::Catenary => model != StaticModel::Catenary,
        }
    }

    /// True if it does not exist for a robot with so few cables.
    pub(super) fn needs_more_cables(&self, robot: &Robot) -> bool {
        matches!(self.definition.needs, RequiredModel::HeldPose) && robot.constraint().is_under()
    }

    /// Adds the values of the quantity at a pose that no tensions hold: empty unless the pose alone decides.
    pub(super) fn values_without_rest(&self, robot: &Robot, pose: &Pose, out: &mut Vec<Value>) {
        let end = out.len() + self.columns(robot).len();
        out.extend(self.definition.at_pose.map(|value| Value::real(Some(value(robot, pose)))));
        out.resize(end, Value::Nothing);
    }

    /// Adds the values of the quantity at a point.
    pub(super) fn values(&self, row: &mut PointEvaluation<'_>, out: &mut Vec<Value>) {
        let Some(shows) = self.definition.shows else { return (self.definition.values)(row, &self.parameter, out) };
        let value = |of: Measure| Value::real(of.static_value(row.robot, row.rest, &row.rest.pose));
        out.extend(shows.members(row.robot).into_iter().map(value));
    }
}

impl PartialEq for Quantity {
    fn eq(&self, other: &Self) -> bool {
        self.definition.name == other.definition.name && self.parameter == other.parameter
    }
}

impl fmt::Debug for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Quantity({})", self.name())
    }
}

impl Definition {
    /// Name without its parameter.
    fn head(&self) -> &'static str {
        self.name.split(':').next().unwrap_or(self.name)
    }

    /// Parameter after the colon of a name; `None` if this quantity has no such parameter.
    fn parameter(&self, text: Option<&str>) -> Option<Parameter> {
        match (&self.takes, text) {
            (ParameterKind::Nothing, None) => Some(Parameter::None),
            (ParameterKind::Count, Some(text)) => {
                let count = text.parse().ok().filter(|count| (1..=MAX_FREQUENCIES).contains(count));
                count.map(Parameter::Count)
            }
            (ParameterKind::Model(default), None) => Some(Parameter::Model(*default)),
            (ParameterKind::Model(_), Some(text)) => {
                simpler_models().find(|model| model.name() == text).map(Parameter::Model)
            }
            (ParameterKind::Sensitivity, Some(text)) => Sensitivity::parse(text).map(Parameter::Sensitivity),
            (ParameterKind::Axis, Some(text)) => {
                twist_axes().iter().position(|axis| *axis == text).map(Parameter::Axis)
            }
            (ParameterKind::Nothing, Some(_))
            | (ParameterKind::Count | ParameterKind::Sensitivity | ParameterKind::Axis, None) => None,
        }
    }
}

impl Parameter {
    fn count(&self) -> usize {
        match self {
            Self::Count(count) => *count,
            Self::None | Self::Model(_) | Self::Sensitivity(_) | Self::Axis(_) => 0,
        }
    }

    fn model(&self) -> Option<CableModel> {
        match self {
            Self::Model(model) => Some(*model),
            Self::None | Self::Count(_) | Self::Sensitivity(_) | Self::Axis(_) => None,
        }
    }

    fn sensitivity(&self) -> Option<&Sensitivity> {
        match self {
            Self::Sensitivity(of) => Some(of),
            Self::None | Self::Count(_) | Self::Model(_) | Self::Axis(_) => None,
        }
    }

    /// Component of a twist, along x without one.
    fn axis(&self) -> usize {
        match self {
            Self::Axis(axis) => *axis,
            Self::None | Self::Count(_) | Self::Model(_) | Self::Sensitivity(_) => 0,
        }
    }

    /// Name of the model in the form that is used in names of columns.
    fn underscored(&self) -> String {
        self.model().map_or_else(String::new, |model| model.name().replace('-', "_"))
    }
}

/// Components of a twist: along the axes of the world, then about them.
fn twist_axes() -> &'static [&'static str] {
    PlatformMotion::Rigid.coordinate_names()
}

/// Cable models that are compared with `catenary-dynamic`.
fn simpler_models() -> impl Iterator<Item = CableModel> {
    CableModel::ALL.into_iter().filter(|model| *model != CableModel::CatenaryDynamic)
}

impl std::str::FromStr for Quantity {
    type Err = UnknownQuantity;

    fn from_str(text: &str) -> Result<Self, UnknownQuantity> {
        let text = text.trim();
        let (head, parameter) = match text.split_once(':') {
            Some((head, parameter)) => (head, Some(parameter)),
            None => (text, None),
        };
        Definition::all()
            .iter()
            .find(|definition| definition.head() == head)
            .and_then(|definition| Some(Self { definition, parameter: definition.parameter(parameter)? }))
            .ok_or_else(|| UnknownQuantity { name: text.to_owned(), hint: hint(text) })
    }
}

fn hint(text: &str) -> String {
    let head = text.split(':').next().unwrap_or(text);

    match Definition::all().iter().find(|definition| definition.head() == head).map(|definition| &definition.takes) {
        Some(ParameterKind::Count) => {
            return format!(": give a whole number from 1 to {MAX_FREQUENCIES} after the colon, as in {head}:3");
        }
        Some(ParameterKind::Sensitivity) => return Sensitivity::hint(text),
        Some(ParameterKind::Axis) => {
            return format!(": the axis after the colon is one of {}, as in {head}:x", twist_axes().join(", "));
        }
        Some(ParameterKind::Model(_)) if text.contains(':') => {
            let models: Vec<&str> = simpler_models().map(CableModel::name).collect();
            let parameter = text.split_once(':').map_or("", |(_, parameter)| parameter);
            if let Some(near) = nearest(parameter, models.iter().copied()) {
                return format!("; did you mean `{head}:{near}`?");
            }
            return format!(": the model after the colon is one of {}", models.join(", "));
        }
        _ => {}
    }

    let near = nearest(head, Definition::all().iter().map(Definition::head));
    match near.and_then(|near| Definition::all().iter().find(|definition| definition.head() == near)) {
        Some(definition) => format!("; did you mean `{}`?", definition.name),
        None => format!("; there are {}", Quantity::names().collect::<Vec<_>>().join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quantity_of_the_table_is_read_and_named_back() {
        for name in Quantity::names() {
            let name = name.replace(":N", ":7").replace(":MODEL", ":shallow-static").replace(":AXIS", ":rz");
            let name = name.replace(":RESULT:PATH", ":stiffness-min:cables.1.anchor_m.z");
            let quantity: Quantity = name.parse().unwrap();
            assert_eq!(quantity.name(), name);
            assert!(!quantity.about().is_empty());
        }
        for (short, full) in
            [("model-error", "model-error:shallow-dynamic"), ("stiffness-error", "stiffness-error:spring")]
        {
            assert_eq!(short.parse::<Quantity>().unwrap().name(), full);
        }
    }

    #[test]
    fn the_documentation_has_the_rows_of_the_table() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/sweeps.md");
        let page = std::fs::read_to_string(file).expect("the repository has the file");
        let (_, behind) = page.split_once("| `--quantity` | Columns |\n|---|---|\n").unwrap();
        let (rows, _) = behind.split_once("\n\n").unwrap();
        assert_eq!(format!("{rows}\n"), Quantity::documentation(), "docs/sweeps.md, Quantities");
    }

    #[test]
    fn an_unknown_quantity_is_answered_with_the_known_ones() {
        for (name, says) in [
            ("first-freq", "did you mean `first-frequency`"),
            ("frequencies:0", "from 1 to 100"),
            ("frequencies:x", "from 1 to 100"),
            ("frequencies", "as in frequencies:3"),
            ("tension-max:3", "did you mean `tension-max`"),
            ("model-error:exact", "one of spring, shallow-static, catenary-static, shallow-dynamic"),
            ("speed-max", "one of x, y, z, rx, ry, rz, as in speed-max:x"),
            ("speed-max:w", "one of x, y, z, rx, ry, rz, as in speed-max:x"),
            ("sensitivity", "as in sensitivity:first-frequency:platform.mass_kg"),
            ("sensitivity:tension:platform.mass_kg", "did you mean `sensitivity:tensions:platform.mass_kg`"),
            ("sensitivity:tensions:platform mass", "as in sensitivity:first-frequency:platform.mass_kg"),
            ("", "there are first-frequency"),
            ("é", "there are"),
        ] {
            let error = name.parse::<Quantity>().unwrap_err().to_string();
            assert!(error.contains(says), "{error}");
        }
    }
}
