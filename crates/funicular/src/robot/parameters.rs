//! Every number of a robot file as a parameter, with its place, unit, range, meaning and value; and robots with other
//! values of these parameters.
//!
//! Keys, units and ranges come from the table by which the reader checks robot files. A robot with other values is read
//! from the same parsed file with the numbers of the text replaced. So every check of the reader applies, and no number
//! passes through text.

mod change_per_unit;
mod list;
mod paths;

pub use super::spec::range::{MAX_MAGNITUDE, MIN_POSITIVE, Range};
pub use paths::{ComponentOfKey, component, is_optional_table, is_top_key, unit, unknown_component};

use super::Robot;
use super::spec::key::{Component, Shape};
use super::spec::{Numbers, SpecError, from_tree};
use list::{list_of, owned_table};
use paths::key_of;
use thiserror::Error;
use toml::Spanned;
use toml::de::DeTable;

/// Part of the robot that a parameter belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RobotPart {
    /// The robot itself: gravity.
    Robot,
    /// The platform.
    Platform,
    /// A rope; its name is the second key of the path.
    Material,
    /// A pulley; its name is the second key of the path.
    Pulley,
    /// A winch; its name is the second key of the path.
    Winch,
    /// A guide wheel; its name is the second key of the path.
    GuideWheel,
    /// A flexible support of anchors; its name is the second key of the path.
    Support,
    /// The cable at this index in file order, from 0.
    Cable(usize),
    /// The load on the platform.
    Load,
    /// The required loads.
    Required,
    /// A body of the platform or an obstacle; its name is the second key of the path.
    Body,
    /// The required distances.
    Clearance,
    /// The wind.
    Wind,
    /// The pose.
    State,
}

/// Number of a robot file.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Keys from the top of the file to the number, the name of the component last: `cables`, `3`, `anchor_m`, `z`.
    pub keys: Vec<String>,
    /// Part of the robot that the parameter belongs to.
    pub part: RobotPart,
    /// Key in the table of this part.
    pub key: &'static str,
    /// Component of a vector or tensor: `x`, `y`, `z`; `roll`, `pitch`, `yaw`; `xx`, `yy`, `zz`, `xy`, `xz`, `yz`.
    pub component: Option<&'static str>,
    /// Value, in the unit of the file.
    pub value: f64,
    /// Unit, SI apart from degrees; `1` for a ratio.
    pub unit: &'static str,
    /// Range of the value. A value within it may still be refused together with the robot's other values, as a minimum
    /// above a maximum.
    pub range: Range,
    /// Meaning.
    pub about: &'static str,
    /// True if the file gives the value; otherwise the value is the default.
    pub given: bool,
    /// First byte of the number in the text, for each place where it stands.
    places: Vec<usize>,
}

impl Parameter {
    /// Path by which a request changes the parameter: keys as [`quoted_key`] writes them, separated by dots.
    pub fn path(&self) -> String {
        self.keys.iter().map(|key| quoted_key(key)).collect::<Vec<_>>().join(".")
    }

    /// Name in words with the unit, as beside a field: `mass of the platform [kg]`, `diameter of the rope (steel) [m]`,
    /// `exit point of the cable (3), z [m]`.
    pub fn label(&self) -> String {
        // The first part of the meaning says what the number is, the others explain it.
        let meaning = self.about.split([',', ';', ':']).next().unwrap_or(self.about);
        let has_name = match self.part {
            RobotPart::Robot
            | RobotPart::Platform
            | RobotPart::Load
            | RobotPart::Required
            | RobotPart::Clearance
            | RobotPart::Wind
            | RobotPart::State => false,
            RobotPart::Material
            | RobotPart::Pulley
            | RobotPart::Winch
            | RobotPart::GuideWheel
            | RobotPart::Support
            | RobotPart::Body
            | RobotPart::Cable(_) => true,
        };
        let name = self.keys.get(1).filter(|_| has_name).map_or_else(String::new, |name| format!(" ({name})"));
        let component = self.component.map_or_else(String::new, |component| format!(", {component}"));
        let unit = if self.unit == "1" { String::new() } else { format!(" [{}]", self.unit) };
        format!("{meaning}{name}{component}{unit}")
    }
}

/// Key as part of a path: bare if it consists of letters, digits, _ and -, otherwise in quotes.
///
/// # Example
/// ```
/// use funicular::robot::parameters::quoted_key;
///
/// assert_eq!(quoted_key("steel-4_mm"), "steel-4_mm");
/// assert_eq!(quoted_key("steel 4.0 mm"), "'steel 4.0 mm'");
/// assert_eq!(quoted_key("rope's end"), "\"rope's end\"");
/// ```
pub fn quoted_key(key: &str) -> String {
    let is_bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if is_bare {
        key.to_owned()
    } else if key.contains('\'') {
        format!("\"{}\"", key.replace('\\', "\\\\").replace('"', "\\\""))
    } else {
        format!("'{key}'")
    }
}

/// Reason why a robot cannot have other values.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ParameterError {
    /// Index beyond the end of the list of parameters.
    #[error("there is no parameter number {index}, the robot has {count}")]
    Unknown {
        /// Requested index.
        index: usize,
        /// Number of parameters.
        count: usize,
    },
    /// The value is a default: the file has no place for another one.
    #[error("the robot file does not give {path}: write it there first")]
    NotGiven {
        /// Path of the parameter.
        path: String,
    },
    /// The reader refuses the resulting robot.
    #[error("with {}: {}", changes.join(" and "), first_message(reason))]
    Refused {
        /// Each change, as `path=value`.
        changes: Vec<String>,
        /// Issues found by the reader. They point into the original text, at the values that were replaced.
        reason: SpecError,
    },
}

/// First issue without its line, because the text there holds another value.
fn first_message(reason: &SpecError) -> String {
    reason.issues().first().map_or_else(String::new, |issue| match &issue.help {
        Some(help) => format!("{}; {help}", issue.message),
        None => issue.message.clone(),
    })
}

/// Numbers of a robot file, and robots with other values of these numbers.
///
/// # Example
/// ```
/// use funicular::robot::parameters::Parameters;
///
/// let parameters = Parameters::from_toml(funicular_robots::COGIRO)?;
/// let mass = parameters.find(&["platform", "mass_kg"]).unwrap();
/// assert_eq!(parameters.list()[mass].unit, "kg");
///
/// let heavier = parameters.robot_with(&[(mass, 300.0)])?;
/// assert_eq!(heavier.platform.mass, 300.0); // kg
/// let refused = parameters.robot_with(&[(mass, -1.0)]).unwrap_err();
/// assert!(refused.to_string().starts_with("with platform.mass_kg=-1: `mass_kg` is -1.0, it must be positive"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Parameters {
    text: String,
    /// Values of the file by key, with their places in the text. The numbers in this tree are placeholders.
    root: DeTable<'static>,
    /// First byte of every number in the text, in ascending order, with the number.
    numbers: Vec<(usize, f64)>,
    robot: Robot,
    list: Vec<Parameter>,
}

impl Parameters {
    /// Reads a robot file and lists its numbers.
    ///
    /// # Errors
    /// [`SpecError`], as [`Robot::from_toml`].
    pub fn from_toml(text: &str) -> Result<Self, SpecError> {
        let robot = Robot::from_toml(text)?;
        // `Robot::from_toml` has just parsed the same text.
        let borrowed = DeTable::parse(text).map(Spanned::into_inner).unwrap_or_default();
        let list = list_of(&borrowed, &robot);

        let mut numbers = Vec::new();
        let root = owned_table(&borrowed, &mut numbers);
        numbers.sort_unstable_by_key(|(place, _)| *place);
        Ok(Self { text: text.to_owned(), root, numbers, robot, list })
    }

    /// Robot with the values of the file.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// All numbers, in this order: gravity, platform, ropes by name, cables in file order, load, wind, pose.
    pub fn list(&self) -> &[Parameter] {
        &self.list
    }

    /// Index in the list of the parameter at a path. A component is named, as in `anchor_m`, `z`, or numbered from 0,
    /// as in `anchor_m`, `2` and `inertia_kg_m2`, `0`, `1`.
    pub fn find<K: AsRef<str>>(&self, path: &[K]) -> Option<usize> {
        let path: Vec<&str> = path.iter().map(AsRef::as_ref).collect();
        let (key, of_key) = key_of(&path)?;
        let shape = key.numeric_value()?.shape;
        let (own, rest) = path.split_at(of_key);
        let at_key = |parameter: &&Parameter| parameter.keys.len() >= of_key && parameter.keys[..of_key] == *own;
        let place = match (shape.place(rest), rest) {
            (None, []) => None,
            (None, _) => return None,
            // One index of a tensor is a principal moment; in a tensor with rows it is a row.
            (Some(Component::Element(i)), _) if shape == Shape::Tensor => {
                if self.list.iter().filter(at_key).any(|other| other.component == Some("xy")) {
                    return None;
                }
                Some(Component::Entry(i, i))
            }
            (place, _) => place,
        };

        self.list.iter().position(|parameter| {
            let named = parameter.component.and_then(|name| shape.place(&[name]));
            at_key(&parameter) && named == place
        })
    }

    /// Robot with other values, given as pairs of the index in [`Self::list`] and the number in the unit of the file.
    /// The result is the robot that [`Robot::from_toml`] would read from the text with these numbers written in it.
    ///
    /// # Errors
    /// [`ParameterError`].
    pub fn robot_with(&self, values: &[(usize, f64)]) -> Result<Robot, ParameterError> {
        let (mut numbers, mut changed) = (self.numbers.clone(), Vec::with_capacity(values.len()));
        for &(index, value) in values {
            let count = self.list.len();
            let parameter = self.list.get(index).ok_or(ParameterError::Unknown { index, count })?;
            if parameter.places.is_empty() {
                return Err(ParameterError::NotGiven { path: parameter.path() });
            }
            for &place in &parameter.places {
                if let Ok(at) = numbers.binary_search_by_key(&place, |(start, _)| *start) {
                    numbers[at].1 = value;
                    changed.push(place);
                }
            }
        }

        let numbers = Numbers { values: &numbers, changed: &changed };
        from_tree(&self.text, &self.root, numbers).map_err(|reason| {
            let changes = values.iter().map(|&(index, value)| format!("{}={value}", self.list[index].path())).collect();
            ParameterError::Refused { changes, reason }
        })
    }
}
