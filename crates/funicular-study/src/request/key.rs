//! Declaration of the options of a command.
//!
//! A [`Key`] is said once, beside its field, and is everywhere: key of a request in JSON, option of the program with
//! its help and its range, keyword in Python, row of the tables in the documentation.

use crate::names::Named;
use crate::units;
use crate::values::{MAX_MAGNITUDE, MIN_POSITIVE, finite, fraction, not_negative, positive};
use serde_json::Value;
use std::ops::RangeInclusive;

/// Range of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Range {
    /// Any number up to [`MAX_MAGNITUDE`].
    Finite,
    /// At least [`MIN_POSITIVE`].
    Positive,
    /// Zero or more.
    NotNegative,
    /// Above 0, at most 1.
    Fraction,
}

impl Range {
    /// Checks a number.
    ///
    /// # Errors
    /// A message that says what is wrong with it.
    pub fn check(self, value: f64) -> Result<f64, String> {
        match self {
            Self::Finite => finite(value),
            Self::Positive => positive(value),
            Self::NotNegative => not_negative(value),
            Self::Fraction => fraction(value),
        }
    }

    /// Smallest and largest number of the range.
    pub fn ends(self) -> (f64, f64) {
        match self {
            Self::Finite => (-MAX_MAGNITUDE, MAX_MAGNITUDE),
            Self::Positive => (MIN_POSITIVE, MAX_MAGNITUDE),
            Self::NotNegative => (0.0, MAX_MAGNITUDE),
            Self::Fraction => (MIN_POSITIVE, 1.0),
        }
    }
}

/// One of the names that an option can have as its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Choice {
    /// Name.
    pub name: &'static str,
    /// Meaning.
    pub about: &'static str,
    /// Another name that the program understands.
    pub also: Option<&'static str>,
}

/// Value that the program writes in a form of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProgramForm {
    /// Input signal.
    Input,
    /// Output signal.
    Output,
    /// Positive number.
    Positive,
    /// Number that is not negative.
    NotNegative,
    /// Name of a quantity of a map or sweep.
    Quantity,
    /// Masses in equal steps, `from:to:count`.
    MassRange,
    /// Axis of a grid, `x=-4:4:81`.
    GridAxis,
    /// Side of a box of poses, `x=-3:3`.
    Side,
    /// Number of the robot file that varies, `platform.mass_kg=10:90:81`.
    Variation,
    /// Value to identify, `PATH` or `PATH=MIN:MAX`.
    Fit,
    /// Value to choose, `PATH=±REACH` or `PATH=MIN:MAX`.
    Change,
    /// Value known beforehand with its standard deviation, `PATH=VALUE±DEVIATION`.
    Prior,
    /// Band of frequencies or tensions, `FROM:TO`.
    Band,
    /// Limit of a quantity of a map, `QUANTITY=VALUE`.
    Bound,
    /// Point of the platform, `NAME=X,Y,Z`.
    Point,
}

/// Kind of value of an option.
#[derive(Debug, Clone)]
pub enum Kind {
    /// Truth value; in the program a switch without a value.
    Switch,
    /// Number.
    Number(Range),
    /// Whole number.
    Count(RangeInclusive<u64>),
    /// Numbers, one per cable in the order of the file.
    PerCable(Range),
    /// One number for all cables, or one per cable.
    OneOrPerCable(Range),
    /// Vector x, y, z.
    Vector,
    /// Position and orientation, or only the position.
    Pose,
    /// Entries xx, yy, zz, xy, xz, yz of a symmetric tensor, or its diagonal.
    Tensor,
    /// One of several names of such a thing.
    Name(&'static str, Vec<Choice>),
    /// Any text.
    Text,
    /// Several texts; in the program separated by commas.
    Texts,
    /// Paths of numbers of the robot file with sizes, `PATH=SIZE`; in the program separated by commas.
    Sizes,
    /// Poses, each x, y, z [m], roll, pitch, yaw [degrees]; the program reads them from a file.
    Poses,
    /// Columns of numbers by their names; the program reads them from a CSV file.
    Columns,
    /// Columns of numbers with gaps: null, in the file an empty cell.
    GappedColumns,
    /// Numbers by the names of cables.
    ByCable(Range),
    /// Value that the program writes in a form of its own.
    Written(ProgramForm),
    /// List of such values; the option can be given several times.
    List(ProgramForm),
    /// Such a value, or a list of them; the option can be given several times.
    OneOrMore(ProgramForm),
    /// List of such values, separated by commas.
    Commas(ProgramForm),
    /// Data of this JSON Schema.
    Data(fn() -> Value),
}

/// Way of reading the value of a key from a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reader {
    /// Columns of numbers in a CSV file.
    Columns,
    /// Columns of numbers in a CSV file, in which cells may be empty.
    GappedColumns,
    /// Rows of a CSV file as objects, with texts and numbers; empty cells are left out.
    Records,
    /// Poses in a CSV file.
    Poses,
    /// Events in a TOML file, which names tables.
    Scenario,
    /// Robot file with changes of its own.
    Robot,
    /// Text of another program.
    Source,
    /// Texts of another program; the files are arguments without an option.
    Sources,
    /// Files of rows, of which the request has the paths; arguments without an option.
    Paths,
    /// File of rows, of which the request has the path; an argument without an option.
    Path,
}

/// File from which the program reads the value of a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InputFile {
    /// Way of reading it.
    pub reader: Reader,
    /// Name in messages, such as "the readings".
    pub role: &'static str,
}

/// One option of a command.
#[derive(Debug, Clone)]
pub struct Key {
    /// Name: of the key in JSON and of the keyword in Python; the program writes it with `-` for `_`.
    pub name: &'static str,
    /// Meaning, with ⟪other keys⟫; further paragraphs follow after an empty line.
    pub about: String,
    /// Kind of value.
    pub kind: Kind,
    /// True if a request without it is refused.
    pub required: bool,
    /// Names that a text can be, which the meaning lists; empty for any text.
    pub names: Vec<&'static str>,
    /// Value of a request that does not give it; null without one.
    pub default: Value,
    /// Substitute for a value that is not given, in words.
    pub otherwise: Option<&'static str>,
    /// Form of the value in help texts.
    pub form: &'static str,
    /// Heading of the help texts under which it stands; empty for the options of the command itself.
    pub heading: &'static str,
    /// Key without which this one has no meaning.
    pub needs: Option<&'static str>,
    /// Keys that exclude this one.
    pub excludes: &'static [&'static str],
    /// Option of the program; empty if the program has none.
    pub option: String,
    /// File from which the program reads the value; none for a value that stands in the command line.
    pub file: Option<InputFile>,
}

impl Key {
    /// Key of a kind; [`request!`](super::request) gives name, meaning and default.
    pub(crate) fn new(kind: Kind) -> Self {
        let form = match &kind {
            Kind::Vector => "X,Y,Z",
            Kind::Pose => "X,Y,Z[,ROLL,PITCH,YAW]",
            Kind::Tensor => "XX,YY,ZZ[,XY,XZ,YZ]",
            Kind::Number(Range::Fraction) => "FRACTION",
            Kind::Count(_) => "N",
            _ => "",
        };
        Self {
            name: "",
            about: String::new(),
            kind,
            names: Vec::new(),
            required: false,
            default: Value::Null,
            otherwise: None,
            form,
            heading: "",
            needs: None,
            excludes: &[],
            option: String::new(),
            file: None,
        }
    }

    /// Names the file from which the program reads the value.
    pub(crate) fn read_by(self, reader: Reader, role: &'static str) -> Self {
        Self { file: Some(InputFile { reader, role }), ..self }
    }

    /// Refuses requests without this key.
    pub(crate) fn required(self) -> Self {
        Self { required: true, ..self }
    }

    /// Says in words what stands for the value if it is not given.
    pub(crate) fn otherwise(self, otherwise: &'static str) -> Self {
        Self { otherwise: Some(otherwise), ..self }
    }

    /// Adds the names that a text can be to its meaning.
    pub(crate) fn one_of(mut self, names: impl Iterator<Item = &'static str>) -> Self {
        self.names = names.collect();
        self
    }

    /// Sets the form of the value in help texts.
    pub(crate) fn form(self, form: &'static str) -> Self {
        Self { form, ..self }
    }

    /// Puts the key under a heading of the help texts.
    pub(crate) fn under(self, heading: &'static str) -> Self {
        Self { heading, ..self }
    }

    /// Names the key without which this one has no meaning.
    pub(crate) fn needs(self, other: &'static str) -> Self {
        Self { needs: Some(other), ..self }
    }

    /// Names the keys that exclude this one.
    pub(crate) fn excludes(self, others: &'static [&'static str]) -> Self {
        Self { excludes: others, ..self }
    }

    /// Gives the option of the program another name; without one, the program has no such option.
    pub(crate) fn option(self, option: &str) -> Self {
        Self { option: option.to_owned(), ..self }
    }

    /// Completes the key with what stands beside its field.
    pub(crate) fn named(mut self, name: &'static str, about: &[&str], default: Option<&Value>) -> Self {
        self.name = name;
        self.about = sentence(about);
        if !self.names.is_empty() {
            self.about = format!("{}: {}", self.about, self.names.join(", "));
        }
        if !self.required {
            self.default = default.cloned().unwrap_or_default();
        }
        if self.option.is_empty()
            && (self.file.is_some()
                || !matches!(
                    self.kind,
                    Kind::Data(_) | Kind::Poses | Kind::Columns | Kind::GappedColumns | Kind::ByCable(_)
                ))
        {
            self.option = name.replace('_', "-");
        }
        if self.option == Self::NOT_IN_PROGRAM {
            self.option.clear();
        }
        if self.form.is_empty() {
            self.form = units::of_name(name).map_or("VALUE", |unit| unit.form);
        }
        self
    }

    /// Name of an option that the program does not have.
    pub(crate) const NOT_IN_PROGRAM: &'static str = "-";
}

/// Kind of value for a choice by name.
pub(crate) fn name<T: Named>() -> Kind {
    let choice = |of: &T| Choice { name: of.name(), about: of.about(), also: of.also() };
    Kind::Name(T::WHAT, T::ALL.iter().map(choice).collect())
}

/// Text of the lines of a doc comment. An empty line stands between paragraphs; the last full stop of each paragraph
/// that is a single sentence goes, as usual in help texts.
pub(crate) fn sentence(lines: &[&str]) -> String {
    let paragraphs = lines.split(|line| line.trim().is_empty());
    let joined = paragraphs.map(|lines| lines.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" "));
    let mut paragraphs: Vec<String> = joined.filter(|text| !text.is_empty()).collect();
    if let Some(first) = paragraphs.first_mut()
        && first.ends_with('.')
    {
        first.pop();
    }
    paragraphs.join("\n\n")
}

/// Struct whose fields are keys of a request.
pub trait Declared: Default {
    /// Commands of the program that show how a command is used.
    const EXAMPLES: &'static [&'static str];

    /// Meaning of the group, or of the command.
    fn about() -> String;

    /// Keys in the order of the program's help.
    fn keys() -> Vec<Key>;
}

/// Changes keys of a list by their name.
pub(crate) fn with(keys: Vec<Key>, names: &[&str], change: impl Fn(Key) -> Key) -> Vec<Key> {
    keys.into_iter().map(|key| if names.contains(&key.name) { change(key) } else { key }).collect()
}

/// Declares a group of keys, or the request of a command: each field with its meaning, its default and its
/// kind of value. `=> group` spreads the keys of another struct, under its heading.
macro_rules! declared {
    (
        $(#[doc = $about:literal])+
        $(#[derive($($derive:path),*)])?
        pub struct $Name:ident {
            $(
                $(#[doc = $text:literal])+
                $(#[serde($($serde:tt)*)])?
                $field:ident: $Type:ty = $default:expr => $how:tt $(. $method:ident ( $($argument:tt)* ))*;
            )*
        }
        $(examples { $($example:literal,)* })?
    ) => {
        $(#[doc = $about])+
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize $(, $($derive),*)?)]
        #[serde(default)]
        pub struct $Name {
            $(
                $(#[doc = $text])+
                $(#[serde($($serde)*)])?
                pub $field: $Type,
            )*
        }

        impl Default for $Name {
            fn default() -> Self {
                Self { $($field: $default,)* }
            }
        }

        impl crate::request::key::Declared for $Name {
            const EXAMPLES: &'static [&'static str] = &[$($($example),*)?];

            fn about() -> String {
                crate::request::key::sentence(&[$($about),+])
            }

            #[allow(unused_imports, unused_variables, reason = "not every group has every kind, or a key")]
            fn keys() -> Vec<crate::request::key::Key> {
                use crate::request::key::{Kind::*, ProgramForm, Range::*, Reader, name};
                use crate::request::shape;
                let defaults = serde_json::to_value(Self::default()).unwrap_or_default();
                let keys: Vec<Vec<crate::request::key::Key>> = vec![
                    $(crate::request::key::entry!(
                        defaults, $field: $Type, [$($text),+], $how $(. $method ( $($argument)* ))*
                    )),*
                ];
                keys.concat()
            }
        }
    };
}

/// One entry of [`declared!`]: a key, a group, or a field that is no option.
macro_rules! entry {
    ($defaults:ident, $field:ident: $Type:ty, [$($text:literal),+], group) => {
        <$Type as crate::request::key::Declared>::keys()
    };
    ($defaults:ident, $field:ident: $Type:ty, [$($text:literal),+], (group without $names:expr)) => {
        crate::request::key::with(<$Type as crate::request::key::Declared>::keys(), &$names, |key| {
            crate::request::key::Key { option: String::new(), ..key }
        })
    };
    ($defaults:ident, $field:ident: $Type:ty, [$($text:literal),+],
        ($kind:expr) $(. $method:ident ( $($argument:tt)* ))*) => {
        vec![
            crate::request::key::Key::new($kind)
                $(.$method($($argument)*))*
                .named(stringify!($field), &[$($text),+], $defaults.get(stringify!($field))),
        ]
    };
}

pub(crate) use {declared, entry};
