//! Keys of the robot file: meaning, unit, range, and the effect of a key that the file leaves out.
//!
//! The reader checks files by this table. [`parameters`](crate::robot::parameters), the JSON Schema and the page of all
//! keys are made from it.

use super::range::Range;

/// Table of a robot file.
#[derive(Debug, Clone, Copy)]
pub struct Table {
    /// Header in the file, as `[platform]`; for the keys before the first header a phrase.
    pub header: &'static str,
    /// Keys of the table, in the order of the documentation.
    pub keys: &'static [Key],
}

/// Known key of a robot file.
#[derive(Debug, Clone, Copy)]
pub struct Key {
    /// Name in the file.
    pub name: &'static str,
    /// Line of a robot file with this key.
    pub example: &'static str,
    /// Meaning.
    pub about: &'static str,
    /// Kind of the value.
    pub value: KeyValue,
    /// Effect if the file leaves the key out.
    pub absent: Absent,
}

/// Kind of the value of a key.
#[derive(Debug, Clone, Copy)]
pub enum KeyValue {
    /// Text on one line, for tables and file names.
    Name,
    /// Text of any length.
    Text,
    /// Word from a list, each with its meaning.
    Word(&'static [(&'static str, &'static str)]),
    /// Table of the file.
    Table,
    /// Tables with names of the user's choice, as `[materials.NAME]`.
    NamedTables,
    /// List of tables: `[[cables]]`.
    Tables,
    /// Number or array of numbers.
    Numbers(Numeric),
    /// List of numbers of any length, as the corners of a curve; unit and range are those of each. No number of a list
    /// is a parameter.
    NumberList(Numeric),
}

/// Effect of a key that the file leaves out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Absent {
    /// The file is refused.
    Refused,
    /// The file is refused in the stated cases.
    Depends(&'static str),
    /// Default numbers; a single number is the first of them.
    Default([f64; 3]),
    /// Default word.
    DefaultWord(&'static str),
    /// Effect in words.
    Means(&'static str),
}

/// Unit, range and arrangement of the numbers of a key.
#[derive(Debug, Clone, Copy)]
pub struct Numeric {
    /// Unit, SI apart from degrees; `1` for a ratio or a direction.
    pub unit: &'static str,
    /// Range of each number.
    pub range: Range,
    /// Arrangement.
    pub shape: Shape,
}

/// Arrangement of the numbers of a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Single number.
    Number,
    /// Three numbers x, y, z.
    Vector,
    /// Three numbers roll, pitch, yaw.
    Angles,
    /// Moment, three principal moments, or three rows of three numbers.
    Tensor,
}

/// Place of one number in the array of its key.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::robot) enum Component {
    /// Element of an array of three numbers.
    Element(usize),
    /// Entry of a symmetric tensor; an off-diagonal entry has a mirrored one.
    Entry(usize, usize),
}

impl Shape {
    /// Names and places of the components.
    pub(in crate::robot) fn components(self) -> &'static [(&'static str, Component)] {
        use Component::{Element, Entry};
        match self {
            Self::Number => &[],
            Self::Vector => &[("x", Element(0)), ("y", Element(1)), ("z", Element(2))],
            Self::Angles => &[("roll", Element(0)), ("pitch", Element(1)), ("yaw", Element(2))],
            Self::Tensor => &[
                ("xx", Entry(0, 0)),
                ("yy", Entry(1, 1)),
                ("zz", Entry(2, 2)),
                ("xy", Entry(0, 1)),
                ("xz", Entry(0, 2)),
                ("yz", Entry(1, 2)),
            ],
        }
    }

    /// Place of a component that the rest of a path names: by its name, by its index from 0, or in a tensor by row and
    /// column. One index in a tensor is a principal moment.
    pub(in crate::robot) fn place(self, rest: &[&str]) -> Option<Component> {
        let index = |text: &str| ["0", "1", "2"].iter().position(|known| *known == text);
        match (self, rest) {
            (Self::Number, _) | (_, []) => None,
            (Self::Tensor, [row, column]) => {
                let (row, column) = (index(row)?, index(column)?);
                Some(Component::Entry(row.min(column), row.max(column)))
            }
            (_, [one]) => {
                let named = self.components().iter().find(|(name, _)| name == one).map(|(_, place)| *place);
                named.or_else(|| index(one).map(Component::Element))
            }
            _ => None,
        }
    }

    /// Names and indices of the components, for messages.
    pub(in crate::robot) fn names(self) -> &'static str {
        match self {
            Self::Number => "",
            Self::Vector => "x, y and z, or 0, 1 and 2",
            Self::Angles => "roll, pitch and yaw, or 0, 1 and 2",
            Self::Tensor => {
                "xx, yy, zz, xy, xz and yz, or 0, 1 and 2 for principal moments, or row and column from 0.0 to 2.2"
            }
        }
    }
}

impl Key {
    /// Required key with numbers.
    pub(super) const fn numeric(
        shape: Shape,
        name: &'static str,
        example: &'static str,
        unit: &'static str,
        range: Range,
        about: &'static str,
    ) -> Self {
        Self::other(name, example, KeyValue::Numbers(Numeric { unit, range, shape }), about)
    }

    /// Required key with another value.
    pub(super) const fn other(name: &'static str, example: &'static str, value: KeyValue, about: &'static str) -> Self {
        Self { name, example, about, value, absent: Absent::Refused }
    }

    /// Key with another effect if the file leaves it out.
    pub(super) const fn without(mut self, absent: Absent) -> Self {
        self.absent = absent;
        self
    }

    /// Key with default numbers.
    pub(super) const fn or(self, default: [f64; 3]) -> Self {
        self.without(Absent::Default(default))
    }

    /// Required key with a list of numbers.
    pub(super) const fn list(
        name: &'static str,
        example: &'static str,
        unit: &'static str,
        range: Range,
        about: &'static str,
    ) -> Self {
        Self::other(name, example, KeyValue::NumberList(Numeric { unit, range, shape: Shape::Number }), about)
    }

    /// Unit, range and arrangement if the value is a number or an array of numbers.
    pub fn numeric_value(&self) -> Option<&Numeric> {
        match &self.value {
            KeyValue::Numbers(numbers) => Some(numbers),
            _ => None,
        }
    }

    /// Unit and range of every number of the value, also of a list.
    pub fn each_number(&self) -> Option<&Numeric> {
        match &self.value {
            KeyValue::Numbers(numbers) | KeyValue::NumberList(numbers) => Some(numbers),
            _ => None,
        }
    }

    /// Default numbers; a single number is the first of them.
    pub(crate) fn default_numbers(&self) -> Option<[f64; 3]> {
        match self.absent {
            Absent::Default(numbers) => Some(numbers),
            _ => None,
        }
    }

    /// Unit, range and arrangement of a key that holds numbers.
    pub(super) fn numbers(&self) -> &Numeric {
        self.each_number().expect("the reader asks for numbers of keys that have some")
    }
}
