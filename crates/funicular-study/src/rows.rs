//! Rows and results, each declared once: from `rows!` follow the struct, its JSON and the schema of it, its columns
//! in files and in tables for reading, and the reading of rows that a file holds.

use crate::columns::{Cell, Field, ToCell};
use crate::request::key::sentence;
use crate::table::{Column, ColumnKind};
use crate::units;
use serde::ser::SerializeMap;
use serde_json::{Map, Value, json};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt::Display;

/// Value of a key in the JSON of results.
pub trait Described {
    /// True if the key of such a value can be absent.
    const MAY_BE_ABSENT: bool = false;

    /// JSON Schema of the values.
    fn schema() -> Value;

    /// True for a value whose key is left out.
    fn is_absent(&self) -> bool {
        false
    }

    /// True for a value that says nothing: an empty list, or a number that is not finite. A sparse key is left out
    /// then.
    fn is_empty(&self) -> bool {
        false
    }
}

/// Part of the keys of results.
pub struct RowKey {
    name: &'static str,
    schema: Value,
    is_required: bool,
}

/// Rows or results that `rows!` declares.
pub trait DeclaredRow {
    /// Keys in the order of the JSON, those of the parts among them.
    fn keys() -> Vec<RowKey>;

    /// Adds the keys and values to a JSON object.
    ///
    /// # Errors
    /// The errors of the serialiser.
    fn put<M: SerializeMap>(&self, map: &mut M) -> Result<(), M::Error>;
}

/// Part whose keys stand among those of the whole: it may be absent.
pub trait RowPart {
    /// Declared type of the part.
    type Of: DeclaredRow;
    /// True if it can be absent.
    const MAY_BE_ABSENT: bool;

    /// The part, if it is there.
    fn part(&self) -> Option<&Self::Of>;
}

impl<T: DeclaredRow> RowPart for T {
    type Of = T;
    const MAY_BE_ABSENT: bool = false;

    fn part(&self) -> Option<&T> {
        Some(self)
    }
}

impl<T: DeclaredRow> RowPart for Option<T> {
    type Of = T;
    const MAY_BE_ABSENT: bool = true;

    fn part(&self) -> Option<&T> {
        self.as_ref()
    }
}

/// Key with its meaning from the lines of its doc comment, and its unit from its name.
pub(crate) fn key<T: Described>(name: &'static str, about: &[&str], is_sparse: bool) -> Vec<RowKey> {
    let mut schema = T::schema();
    if let Value::Object(schema) = &mut schema {
        // A list has one key for all parts.
        let about = sentence(about).replace("cable {}", "each cable").replace(", {}", "");
        if !about.is_empty()
            && let Some(of_type) = schema.insert("description".to_owned(), about.into())
        {
            // Meaning of the object itself, whatever the key.
            schema.insert("$comment".to_owned(), of_type);
        }
        let unit = units::of_name(name).filter(|_| !schema.contains_key("properties"));
        if let Some(unit) = unit {
            schema.insert("unit".to_owned(), unit.text.into());
        }
    }
    vec![RowKey { name, schema, is_required: !is_sparse && !T::MAY_BE_ABSENT }]
}

/// Keys of a part.
pub(crate) fn keys_of_part<P: RowPart>() -> Vec<RowKey> {
    let keys = P::Of::keys().into_iter();
    keys.map(|key| RowKey { is_required: key.is_required && !P::MAY_BE_ABSENT, ..key }).collect()
}

/// Schema of an object with these keys.
pub(crate) fn schema_of(title: &str, about: &[&str], keys: Vec<RowKey>) -> Value {
    let required: Vec<&str> = keys.iter().filter(|key| key.is_required).map(|key| key.name).collect();
    let required = json!(required);
    let properties: Map<String, Value> = keys.into_iter().map(|key| (key.name.to_owned(), key.schema)).collect();
    json!({
        "title": title, "description": sentence(about), "type": "object", "properties": properties,
        "required": required, "additionalProperties": false,
    })
}

/// Describes types by the name of their JSON type.
macro_rules! described {
    ($($Type:ty: $name:literal $(, empty $value:ident: $is_empty:expr)?;)*) => {
        $(impl Described for $Type {
            fn schema() -> Value {
                json!({ "type": $name })
            }

            $(fn is_empty(&self) -> bool {
                let $value = self;
                $is_empty
            })?
        })*
    };
}

described! {
    f64: "number", empty value: !value.is_finite();
    usize: "integer";
    i64: "integer";
    u64: "integer";
    u32: "integer";
    bool: "boolean", empty value: !*value;
    String: "string", empty value: value.as_str().is_empty();
    &'static str: "string", empty value: str::is_empty(value);
    Cow<'static, str>: "string", empty value: str::is_empty(value);
}

/// Identity of a result, whose further keys depend on its kind.
impl Described for Value {
    fn schema() -> Value {
        json!({ "type": "object", "properties": { "kind": { "type": "string" } }, "required": ["kind"] })
    }
}

impl<T: Described> Described for Option<T> {
    const MAY_BE_ABSENT: bool = true;

    fn schema() -> Value {
        T::schema()
    }

    fn is_absent(&self) -> bool {
        self.is_none()
    }

    fn is_empty(&self) -> bool {
        self.as_ref().is_none_or(Described::is_empty)
    }
}

impl<T: Described> Described for Vec<T> {
    fn schema() -> Value {
        json!({ "type": "array", "items": T::schema() })
    }

    fn is_empty(&self) -> bool {
        self.as_slice().is_empty()
    }
}

impl<T: Described, const N: usize> Described for [T; N] {
    fn schema() -> Value {
        json!({ "type": "array", "items": T::schema(), "minItems": N, "maxItems": N })
    }
}

impl<T: Described> Described for Box<T> {
    const MAY_BE_ABSENT: bool = T::MAY_BE_ABSENT;

    fn schema() -> Value {
        T::schema()
    }

    fn is_absent(&self) -> bool {
        (**self).is_absent()
    }
}

impl<T: Described> Described for BTreeMap<String, T> {
    fn schema() -> Value {
        json!({ "type": "object", "additionalProperties": T::schema() })
    }

    fn is_empty(&self) -> bool {
        self.keys().next().is_none()
    }
}

/// Value of a key as cells of a table.
pub trait Cells {
    /// Kind of the columns.
    const KIND: ColumnKind;

    /// Adds the cells.
    fn add(&self, cells: &mut Vec<Cell>);
}

/// Values of one cell.
macro_rules! cells {
    ($($Type:ty),*) => {
        $(impl Cells for $Type {
            const KIND: ColumnKind = <Self as ToCell>::KIND;

            fn add(&self, cells: &mut Vec<Cell>) {
                cells.push(self.clone().cell());
            }
        })*
    };
}

cells!(f64, usize, bool, String, &'static str);

impl<T: Cells> Cells for Option<T> {
    const KIND: ColumnKind = T::KIND;

    fn add(&self, cells: &mut Vec<Cell>) {
        match self {
            Some(value) => value.add(cells),
            None => cells.push(Cell::Missing(None)),
        }
    }
}

impl<T: Cells> Cells for Vec<T> {
    const KIND: ColumnKind = T::KIND;

    fn add(&self, cells: &mut Vec<Cell>) {
        for value in self {
            value.add(cells);
        }
    }
}

impl<T: Cells, const N: usize> Cells for [T; N] {
    const KIND: ColumnKind = T::KIND;

    fn add(&self, cells: &mut Vec<Cell>) {
        for value in self {
            value.add(cells);
        }
    }
}

/// Field of the value of a key in one column, or in one per part, whose name stands in place of `{}`.
pub(crate) fn columns_of<R, V: Cells>(
    name: &str,
    about: &[&str],
    parts: Option<&[String]>,
    value: impl Fn(&R) -> &V + 'static,
) -> Field<R> {
    // Further paragraphs of the meaning stand in the schema alone.
    let about: Vec<&str> = about.iter().copied().take_while(|line| !line.trim().is_empty()).collect();
    let about = in_a_line(&sentence(&about));
    let unit = match V::KIND {
        ColumnKind::Real => units::of_name(name).map_or("1", |unit| unit.text),
        ColumnKind::Flag | ColumnKind::Text => "",
    };
    let column = |part: &str| {
        let [name, about] = [name, about.as_str()].map(|pattern| pattern.replace("{}", part));
        Column { name, unit: unit.into(), about, kind: V::KIND }
    };
    let columns = parts.map_or_else(|| vec![column("")], |parts| parts.iter().map(|part| column(part)).collect());
    Field::of_columns(columns, move |row, cells| value(row).add(cells))
}

/// Sentence as it stands in a line of a table: without its capital letter, unless it is that of an abbreviation.
fn in_a_line(sentence: &str) -> String {
    let mut letters = sentence.chars();
    match (letters.next(), letters.clone().next()) {
        (Some(first), Some(second)) if second.is_lowercase() || second == ' ' => {
            first.to_lowercase().chain(letters).collect()
        }
        _ => sentence.to_owned(),
    }
}

/// Name of the columns of a list: `velocity_{}_m_s` of `velocity_m_s`.
pub(crate) fn pattern_of(name: &str) -> String {
    let stem = units::without_unit(name);
    format!("{stem}_{{}}{}", &name[stem.len()..])
}

/// Names of parts as texts.
pub(crate) fn texts(of: impl IntoIterator<Item = impl Display>) -> Vec<String> {
    of.into_iter().map(|part| part.to_string()).collect()
}

/// Value that is read from the numbers of its columns.
pub(crate) trait ReadBack: Sized {
    /// Takes the value of `count` columns; `None` if such a value has another count of numbers.
    fn take(count: usize, numbers: &mut &[f64]) -> Option<Self>;
}

/// Takes numbers from the front.
fn front<'a>(count: usize, numbers: &mut &'a [f64]) -> Option<&'a [f64]> {
    let (taken, rest) = numbers.split_at_checked(count)?;
    *numbers = rest;
    Some(taken)
}

impl ReadBack for f64 {
    fn take(count: usize, numbers: &mut &[f64]) -> Option<Self> {
        front(count, numbers)?.first().copied()
    }
}

impl<T: ReadBack> ReadBack for Option<T> {
    fn take(count: usize, numbers: &mut &[f64]) -> Option<Self> {
        if count == 0 { Some(None) } else { T::take(count, numbers).map(Some) }
    }
}

impl<const N: usize> ReadBack for [f64; N] {
    fn take(count: usize, numbers: &mut &[f64]) -> Option<Self> {
        front(count, numbers)?.try_into().ok()
    }
}

impl ReadBack for Vec<f64> {
    fn take(count: usize, numbers: &mut &[f64]) -> Option<Self> {
        front(count, numbers).map(<[f64]>::to_vec)
    }
}

impl ReadBack for Vec<[f64; 3]> {
    fn take(count: usize, numbers: &mut &[f64]) -> Option<Self> {
        Some(front(count, numbers)?.as_chunks().0.to_vec())
    }
}

/// Declares rows or results: each key with its meaning and its type.
///
/// A type may be followed by `= sparse` (the key is left out for an empty value), `= spread` (the keys of this part
/// stand among those of the whole) or `= hidden` (no key). After `=>` stands the column, with the methods of [`Field`]:
/// `one`, or `one("name")` if it is not that of the key; `each(parts)`, `each(parts, "pattern_{}")` or
/// `each(parts, "pattern_{}", "meaning of {}")` for a list; `columns(…)` for a part, with their arguments. The meaning
/// of a column is the first paragraph of the doc comment. Columns of other values follow after a further `=>`.
///
/// `in tables(names: &Names)` gives the function `columns`, `read back` the function `read`. `with { … } rows` stands
/// before the columns and makes what several of them need.
macro_rules! rows {
    (
        $(#[doc = $about:literal])+
        $(#[derive($($derive:path),*)])?
        $visibility:vis struct $Name:ident in tables($($arg:ident: $Arg:ty),*)
            $(with { $($before:tt)* } rows)? $(read $back:ident)? { $($body:tt)* }
    ) => {
        crate::rows::structure! { [$($about),+] [$($($derive),*)?] $visibility $Name { $($body)* } }

        crate::rows::columns! { $visibility $Name ($($arg: $Arg),*) [$($($before)*)?] { $($body)* } $($back)? }
    };
    (
        $(#[doc = $about:literal])+
        $(#[derive($($derive:path),*)])?
        $visibility:vis struct $Name:ident { $($body:tt)* }
    ) => {
        crate::rows::structure! { [$($about),+] [$($($derive),*)?] $visibility $Name { $($body)* } }
    };
}

/// Struct of `rows!` with its JSON.
macro_rules! structure {
    (
        [$($about:literal),+] [$($derive:path),*] $visibility:vis $Name:ident {
            $(
                $(#[doc = $text:literal])*
                $field_visibility:vis $field:ident: $Type:ty $(= $mark:ident)?
                $(=> $first:ident $(::$more:ident)* $(($($a:tt)*))? $(.$method:ident($($m:tt)*))*)*;
            )*
        }
    ) => {
        $(#[doc = $about])+
        #[derive($($derive),*)]
        $visibility struct $Name {
            $(
                $(#[doc = $text])*
                $field_visibility $field: $Type,
            )*
        }

        impl crate::rows::DeclaredRow for $Name {
            fn keys() -> Vec<crate::rows::RowKey> {
                let keys: Vec<Vec<crate::rows::RowKey>> =
                    vec![$(crate::rows::keys!($field: $Type, [$($text),*] $($mark)?)),*];
                keys.into_iter().flatten().collect()
            }

            #[allow(unused_variables, reason = "not every struct has keys")]
            fn put<M: serde::ser::SerializeMap>(&self, map: &mut M) -> Result<(), M::Error> {
                $(crate::rows::put!(map, &self.$field, $field $($mark)?);)*
                Ok(())
            }
        }

        impl crate::rows::Described for $Name {
            fn schema() -> serde_json::Value {
                let keys = <Self as crate::rows::DeclaredRow>::keys();
                crate::rows::schema_of(stringify!($Name), &[$($about),+], keys)
            }
        }

        impl serde::Serialize for $Name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                let mut map = serializer.serialize_map(None)?;
                crate::rows::DeclaredRow::put(self, &mut map)?;
                serde::ser::SerializeMap::end(map)
            }
        }
    };
}

/// Columns of `rows!`, and the reading of their numbers.
macro_rules! columns {
    ($visibility:vis $Name:ident ($($arg:ident: $Arg:ty),*) $before:tt $body:tt back) => {
        crate::rows::columns! { $visibility $Name ($($arg: $Arg),*) $before $body }
        crate::rows::read_back! { $Name ($($arg: $Arg),*) $body }
    };
    (
        $visibility:vis $Name:ident ($($arg:ident: $Arg:ty),*) [$($before:tt)*] {
            $(
                $(#[doc = $text:literal])*
                $field_visibility:vis $field:ident: $Type:ty $(= $mark:ident)?
                $(=> $first:ident $(::$more:ident)* $(($($a:tt)*))? $(.$method:ident($($m:tt)*))*)*;
            )*
        }
    ) => {
        impl $Name {
            /// Columns of the rows.
            #[allow(unused_variables, reason = "not every key has a column")]
            $visibility fn columns($($arg: $Arg),*) -> crate::columns::Columns<Self> {
                $($before)*
                let mut fields: Vec<crate::columns::Field<Self>> = Vec::new();
                $({
                    let about: &[&str] = &[$($text),*];
                    $(fields.extend(
                        crate::rows::column!(about, $field: $Type, $first $(::$more)* $(($($a)*))?) $(.$method($($m)*))*
                    );)*
                })*
                crate::columns::Columns::new(fields)
            }
        }
    };
}

/// Function that reads rows of `rows!` from the numbers of their columns.
macro_rules! read_back {
    (
        $Name:ident ($($arg:ident: $Arg:ty),*) {
            $(
                $(#[doc = $text:literal])*
                $field_visibility:vis $field:ident: $Type:ty $(= $mark:ident)?
                => $first:ident $(($($a:tt)*))? $(.$method:ident($($m:tt)*))*;
            )*
        }
    ) => {
        impl $Name {
            /// Takes a row from the numbers of its columns; `None` if there are too few.
            pub(crate) fn read(numbers: &mut &[f64] $(, $arg: $Arg)*) -> Option<Self> {
                Some(Self {
                    $($field: crate::rows::taken!(
                        numbers, $field: $Type, $first $(($($a)*))? $(.$method($($m)*))*
                    ),)*
                })
            }
        }
    };
}

/// Keys of one entry of `rows!`.
macro_rules! keys {
    ($field:ident: $Type:ty, [$($text:literal),*]) => {
        crate::rows::key::<$Type>(stringify!($field), &[$($text),*], false)
    };
    ($field:ident: $Type:ty, [$($text:literal),*] sparse) => {
        crate::rows::key::<$Type>(stringify!($field), &[$($text),*], true)
    };
    ($field:ident: $Type:ty, [$($text:literal),*] spread) => {
        crate::rows::keys_of_part::<$Type>()
    };
    ($field:ident: $Type:ty, [$($text:literal),*] hidden) => {
        Vec::new()
    };
}

/// Statement that adds one entry of `rows!` to a JSON object.
macro_rules! put {
    ($map:ident, $value:expr, $field:ident) => {
        if !crate::rows::Described::is_absent($value) {
            $map.serialize_entry(stringify!($field), $value)?;
        }
    };
    ($map:ident, $value:expr, $field:ident sparse) => {
        if !crate::rows::Described::is_empty($value) {
            $map.serialize_entry(stringify!($field), $value)?;
        }
    };
    ($map:ident, $value:expr, $field:ident spread) => {
        if let Some(part) = crate::rows::RowPart::part($value) {
            crate::rows::DeclaredRow::put(part, $map)?;
        }
    };
    ($map:ident, $value:expr, $field:ident hidden) => {};
}

/// Column of one entry of `rows!`, or the columns of a part.
macro_rules! column {
    ($about:ident, $field:ident: $Type:ty, one) => {
        crate::rows::columns_of(stringify!($field), $about, None, |row: &Self| &row.$field)
    };
    ($about:ident, $field:ident: $Type:ty, one($name:expr)) => {
        crate::rows::columns_of($name, $about, None, |row: &Self| &row.$field)
    };
    ($about:ident, $field:ident: $Type:ty, each($parts:expr)) => {
        crate::rows::column!(
            $about, $field: $Type, each($parts, &crate::rows::pattern_of(stringify!($field)))
        )
    };
    ($about:ident, $field:ident: $Type:ty, each($parts:expr, $pattern:expr)) => {
        crate::rows::columns_of($pattern, $about, Some(&crate::rows::texts($parts)), |row: &Self| &row.$field)
    };
    ($about:ident, $field:ident: $Type:ty, each($parts:expr, $pattern:expr, $of_part:literal)) => {
        crate::rows::columns_of($pattern, &[$of_part], Some(&crate::rows::texts($parts)), |row: &Self| &row.$field)
    };
    ($about:ident, $field:ident: $Type:ty, columns($($a:tt)*)) => {
        <<$Type as crate::rows::RowPart>::Of>::columns($($a)*)
            .within(|row: &Self| crate::rows::RowPart::part(&row.$field))
    };
    ($about:ident, $field:ident: $Type:ty, $($other:tt)+) => {
        $($other)+
    };
}

/// Value of one entry of `rows!` from numbers.
macro_rules! taken {
    ($numbers:ident, $field:ident: $Type:ty, columns($($a:tt)*)) => {
        <$Type>::read($numbers, $($a)*)?
    };
    ($numbers:ident, $field:ident: $Type:ty, $first:ident $(($($a:tt)*))? $(.$method:ident($($m:tt)*))*) => {{
        let nothing: &[&str] = &[];
        let field: crate::columns::Field<Self> =
            crate::rows::column!(nothing, $field: $Type, $first $(($($a)*))?) $(.$method($($m)*))*;
        crate::rows::ReadBack::take(field.count(), $numbers)?
    }};
}

pub(crate) use {column, columns, keys, put, read_back, rows, structure, taken};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::Style;

    rows! {
        /// Place of a point.
        struct PointPlace in tables(decimals: usize) read back {
            /// Position, {}.
            position_m: [f64; 3] => each(["x", "y", "z"], "{}_m").decimals("position", decimals);
        }
    }

    rows! {
        /// Point at one time.
        struct PointRow in tables(cables: &[String]) read back {
            /// Time since the start.
            ///
            /// Never negative.
            t_s: f64 => one.decimals("t", 1);
            /// Place.
            place: PointPlace = spread => columns(2);
            /// Tension of cable {}.
            tensions_n: Vec<f64> = sparse => each(cables, "tension_{}_n").lowest("lowest", 2);
            /// Part of the limit.
            used_part: Option<f64> => one.significant("used", 2);
        }
    }

    fn row(tensions_n: Vec<f64>) -> PointRow {
        PointRow { t_s: 0.25, place: PointPlace { position_m: [1.0, -2.0, 3.0] }, tensions_n, used_part: None }
    }

    #[test]
    fn keys_of_parts_stand_among_the_others_and_empty_ones_are_left_out() {
        let json = serde_json::to_string(&row(Vec::new())).unwrap();
        assert_eq!(json, r#"{"t_s":0.25,"position_m":[1.0,-2.0,3.0]}"#);
        let schema = PointRow::schema();
        assert_eq!(schema["required"], json!(["t_s", "position_m"]));
        assert_eq!(
            schema["properties"]["t_s"],
            json!({ "type": "number", "description": "Time since the start\n\nNever negative.", "unit": "s" })
        );
        assert_eq!(schema["properties"]["tensions_n"]["description"], "Tension of each cable");
    }

    #[test]
    fn columns_have_the_unit_of_their_name_and_are_read_back_in_their_order() {
        let cables = ["a".to_owned(), "b".to_owned()];
        let columns = PointRow::columns(&cables);
        let described: Vec<String> = (columns.described().iter())
            .map(|column| format!("{} [{}] {}", column.name, column.unit, column.about))
            .collect();
        assert_eq!(described[..2], ["t_s [s] time since the start", "x_m [m] position, x"]);
        assert_eq!(
            described[4..],
            [
                "tension_a_n [N] tension of cable a",
                "tension_b_n [N] tension of cable b",
                "used_part [1] part of the limit"
            ]
        );
        let row = row(vec![7.0, 5.5]);
        assert_eq!(columns.texts(&row, Style::Plain), ["0.2", "1.00, -2.00, 3.00", "5.5", crate::text::NONE]);

        let mut numbers: &[f64] = &[0.25, 1.0, -2.0, 3.0, 7.0, 5.5, 0.5];
        let again = PointRow::read(&mut numbers, &cables).unwrap();
        assert_eq!((numbers.len(), again.used_part, again.place.position_m), (0, Some(0.5), row.place.position_m));
        assert!(PointRow::read(&mut &[0.25, 1.0][..], &cables).is_none());
    }
}
