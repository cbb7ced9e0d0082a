//! Tables of results. The columns of each kind of rows stand once: CSV, tables for reading, pages, Python and the
//! documentation follow from them.

pub use crate::reading_table::COMPONENTS;

use crate::reading_table::{ReadingColumn, ReadingTable};
use crate::table::{Column, ColumnKind, Values};
use crate::text::{self, NONE};
use crate::units;
use serde::Serialize;
use std::borrow::{Borrow, Cow};
use std::fmt::Display;

/// Digits of a number that is shown as it is.
const MAX_DIGITS: usize = 12;

/// Digits of a number in a table for reading whose columns do not say how many.
const READ_DIGITS: usize = 5;

/// Value of a column in a row.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Cell {
    /// Number with its unit.
    Number(f64),
    /// Count or index.
    Count(usize),
    /// Yes or no.
    Flag(bool),
    /// Word, name or sentence.
    Text(String),
    /// Value that the row does not have.
    Missing(Option<()>),
}

impl Cell {
    /// Adds the cell to the values of its column. A number in a column of texts is written as text, and a flag in a
    /// column of numbers is 0 or 1.
    pub fn add_to(self, values: &mut Values) {
        match values {
            Values::Real(values) => values.push(match self {
                Self::Number(value) => Some(value).filter(|value| value.is_finite()),
                // Counts of results are far below 2^53.
                Self::Count(value) => Some(value as f64),
                Self::Flag(value) => Some(f64::from(u8::from(value))),
                Self::Text(_) | Self::Missing(_) => None,
            }),
            Values::Flag(values) => values.push(self == Self::Flag(true)),
            Values::Text(values) => values.push(match self {
                Self::Text(text) => Some(text.into()),
                Self::Number(value) => Some(value.to_string().into()),
                Self::Count(value) => Some(value.to_string().into()),
                Self::Flag(value) => Some(value.to_string().into()),
                Self::Missing(_) => None,
            }),
        }
    }
}

/// Value that can stand in a row.
pub trait ToCell {
    /// Kind of its column.
    const KIND: ColumnKind;

    /// The value as a cell.
    fn cell(self) -> Cell;
}

impl ToCell for f64 {
    const KIND: ColumnKind = ColumnKind::Real;

    fn cell(self) -> Cell {
        Cell::Number(self)
    }
}

impl ToCell for usize {
    const KIND: ColumnKind = ColumnKind::Real;

    fn cell(self) -> Cell {
        Cell::Count(self)
    }
}

impl ToCell for bool {
    const KIND: ColumnKind = ColumnKind::Flag;

    fn cell(self) -> Cell {
        Cell::Flag(self)
    }
}

impl ToCell for &str {
    const KIND: ColumnKind = ColumnKind::Text;

    fn cell(self) -> Cell {
        Cell::Text(self.to_owned())
    }
}

impl ToCell for String {
    const KIND: ColumnKind = ColumnKind::Text;

    fn cell(self) -> Cell {
        Cell::Text(self)
    }
}

impl<V: ToCell> ToCell for Option<V> {
    const KIND: ColumnKind = V::KIND;

    fn cell(self) -> Cell {
        self.map_or(Cell::Missing(None), ToCell::cell)
    }
}

/// Writing of numbers: with a hyphen on a terminal, with a minus sign on a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// Terminal.
    Plain,
    /// Page.
    Typeset,
}

impl Style {
    fn set(self, value: f64, text: impl FnOnce() -> String) -> String {
        match self {
            _ if !value.is_finite() => NONE.to_owned(),
            Self::Plain => text(),
            Self::Typeset => text().replace('-', "−"),
        }
    }

    /// Number with `count` decimals; a dash without a number.
    pub fn decimals(self, value: impl Into<Option<f64>>, count: usize) -> String {
        let value = value.into().unwrap_or(f64::NAN);
        self.set(value, || text::decimals(value, count))
    }

    /// Number with `digits` significant digits; a dash without a number.
    pub fn significant(self, value: impl Into<Option<f64>>, digits: usize) -> String {
        let value = value.into().unwrap_or(f64::NAN);
        self.set(value, || text::significant(value, digits))
    }

    /// Number with at most `digits` significant digits, without zeros at the end; a dash without a number.
    pub fn short(self, value: impl Into<Option<f64>>, digits: usize) -> String {
        let value = value.into().unwrap_or(f64::NAN);
        self.set(value, || text::short(value, digits))
    }

    /// Numbers with `count` decimals each, separated by commas.
    pub fn vector(self, values: &[f64], count: usize) -> String {
        values.iter().map(|value| self.decimals(*value, count)).collect::<Vec<_>>().join(", ")
    }

    /// Components of a vector with `count` decimals each, which a terminal shows below each other.
    pub fn components(self, values: &[f64], count: usize) -> String {
        let texts: Vec<String> = values.iter().map(|value| self.decimals(*value, count)).collect();
        texts.join(if self == Self::Plain { COMPONENTS } else { ", " })
    }

    /// Interval, `1.0 to 2.0`.
    pub fn range(self, [from, to]: [f64; 2], count: usize) -> String {
        format!("{} to {}", self.decimals(from, count), self.decimals(to, count))
    }
}

/// Text of a row.
type Text<R> = dyn Fn(&R, Style) -> String;

/// Function that adds the cells of a row.
type CellsOfRow<R> = dyn Fn(&R, &mut Vec<Cell>);

/// Text of a field in tables for reading.
enum ReadingForm<R> {
    /// Numbers with this many decimals.
    Decimals(usize),
    /// Numbers with this many significant digits.
    Significant(usize),
    /// Numbers with at most this many significant digits, without zeros at the end.
    Short(usize),
    /// Components of a vector with this many decimals, which a terminal shows below each other.
    Components(usize),
    /// Lowest of the numbers with this many significant digits.
    Lowest(usize),
    /// Largest of the numbers, whatever its sign, with this many significant digits.
    Largest(usize),
    /// Text made of the row.
    Own(Box<Text<R>>),
}

/// Column of a table for reading.
struct Reading<R> {
    heading: Cow<'static, str>,
    unit: Cow<'static, str>,
    is_text: bool,
    /// Style of the tables that have it; `None` for all.
    style: Option<Style>,
    form: ReadingForm<R>,
}

impl<R> Reading<R> {
    fn is_in(&self, style: Style) -> bool {
        self.style.is_none_or(|own| own == style)
    }
}

/// Quantity of a row: its numbers in files, one text in tables for reading.
pub struct Field<R> {
    columns: Vec<Column>,
    values: Box<CellsOfRow<R>>,
    reading: Option<Reading<R>>,
    is_there: bool,
}

/// Field with one column.
pub fn column<R, V: ToCell>(
    name: &'static str,
    unit: &'static str,
    about: impl Into<String>,
    value: impl Fn(&R) -> V + 'static,
) -> Field<R> {
    Field {
        columns: vec![Column { name: name.to_owned(), unit: unit.into(), about: about.into(), kind: V::KIND }],
        values: Box::new(move |row, cells| cells.push(value(row).cell())),
        reading: None,
        is_there: true,
    }
}

/// Field with a column for each part, whose name stands in place of `{}` in `name` and `about`.
pub fn parts<R, I: IntoIterator<Item: ToCell>>(
    name: &str,
    of: impl IntoIterator<Item = impl Display>,
    unit: &'static str,
    about: &str,
    values: impl Fn(&R) -> I + 'static,
) -> Field<R> {
    let columns = of.into_iter().map(|part| {
        let part = part.to_string();
        let [name, about] = [name, about].map(|pattern| pattern.replace("{}", &part));
        Column { name, unit: unit.into(), about, kind: I::Item::KIND }
    });
    Field {
        columns: columns.collect(),
        values: Box::new(move |row, cells| cells.extend(values(row).into_iter().map(ToCell::cell))),
        reading: None,
        is_there: true,
    }
}

/// Field that stands in tables for reading only: files have its number at another place, because their order never
/// changes.
pub(crate) fn only_read<R>() -> Field<R> {
    Field { columns: Vec::new(), values: Box::new(|_, _| ()), reading: None, is_there: true }
}

impl<R> IntoIterator for Field<R> {
    type Item = Self;
    type IntoIter = std::iter::Once<Self>;

    fn into_iter(self) -> Self::IntoIter {
        std::iter::once(self)
    }
}

impl<R> Field<R> {
    /// Field with these columns, of a function that adds their cells; cells that it does not add are missing.
    pub(crate) fn of_columns(columns: Vec<Column>, values: impl Fn(&R, &mut Vec<Cell>) + 'static) -> Self {
        let count = columns.len();
        let values = move |row: &R, cells: &mut Vec<Cell>| {
            let all = cells.len() + count;
            values(row, cells);
            cells.resize(all, Cell::Missing(None));
        };
        Self { columns, values: Box::new(values), reading: None, is_there: true }
    }

    /// Number of columns that the table has of this field.
    pub(crate) fn count(&self) -> usize {
        if self.is_there { self.columns.len() } else { 0 }
    }

    /// Gives the columns another meaning in words than the key has.
    #[must_use]
    pub(crate) fn about(mut self, about: &str) -> Self {
        self.columns.iter_mut().for_each(|column| about.clone_into(&mut column.about));
        self
    }

    /// Gives the columns a unit that their name does not tell.
    #[must_use]
    pub(crate) fn unit(mut self, unit: &'static str) -> Self {
        self.columns.iter_mut().for_each(|column| column.unit = unit.into());
        self
    }

    /// Field of rows that have a row of this kind as a part; without the part its values are missing.
    fn within<O: 'static>(self, part: impl Fn(&O) -> Option<&R> + Copy + 'static) -> Field<O>
    where
        R: 'static,
    {
        let Self { columns, values, reading, is_there } = self;
        let reading = reading.map(|Reading { heading, unit, is_text, style, form }| {
            let form = match form {
                ReadingForm::Own(text) => ReadingForm::Own(Box::new(move |row: &O, style: Style| {
                    part(row).map_or_else(|| NONE.to_owned(), |row| text(row, style))
                }) as Box<Text<O>>),
                ReadingForm::Decimals(count) => ReadingForm::Decimals(count),
                ReadingForm::Significant(digits) => ReadingForm::Significant(digits),
                ReadingForm::Short(digits) => ReadingForm::Short(digits),
                ReadingForm::Components(count) => ReadingForm::Components(count),
                ReadingForm::Lowest(digits) => ReadingForm::Lowest(digits),
                ReadingForm::Largest(digits) => ReadingForm::Largest(digits),
            };
            Reading { heading, unit, is_text, style, form }
        });
        let of_part = move |row: &O, cells: &mut Vec<Cell>| {
            if let Some(row) = part(row) {
                values(row, cells);
            }
        };
        Field { reading, is_there, ..Field::of_columns(columns, of_part) }
    }

    /// The table has this field if the condition holds.
    #[must_use]
    pub(crate) fn only_if(mut self, is_there: bool) -> Self {
        self.is_there = is_there;
        self
    }

    fn reading(mut self, heading: impl Into<Cow<'static, str>>, unit: &'static str, form: ReadingForm<R>) -> Self {
        let is_text = self.columns.first().is_none_or(|column| column.kind == ColumnKind::Text);
        self.reading = Some(Reading { heading: heading.into(), unit: unit.into(), is_text, style: None, form });
        self
    }

    /// Form of reading with the unit of the columns.
    fn read(self, heading: impl Into<Cow<'static, str>>, form: ReadingForm<R>) -> Self {
        let unit = match self.columns.first().map(|column| &column.unit) {
            Some(Cow::Borrowed(unit)) => units::shown(unit),
            _ => "",
        };
        self.reading(heading, unit, form)
    }

    /// Shows the values as they are under a heading.
    #[must_use]
    pub fn plain(self, heading: impl Into<Cow<'static, str>>) -> Self {
        self.reading(heading, "", ReadingForm::Short(MAX_DIGITS))
    }

    /// Shows the numbers with `count` decimals.
    #[must_use]
    pub fn decimals(self, heading: impl Into<Cow<'static, str>>, count: usize) -> Self {
        self.read(heading, ReadingForm::Decimals(count))
    }

    /// Shows the numbers with `digits` significant digits.
    #[must_use]
    pub fn significant(self, heading: impl Into<Cow<'static, str>>, digits: usize) -> Self {
        self.read(heading, ReadingForm::Significant(digits))
    }

    /// Shows the numbers with at most `digits` significant digits, without zeros at the end.
    #[must_use]
    pub fn short(self, heading: impl Into<Cow<'static, str>>, digits: usize) -> Self {
        self.read(heading, ReadingForm::Short(digits))
    }

    /// Shows the components of a vector with `count` decimals, below each other on a terminal.
    #[must_use]
    pub fn components(self, heading: impl Into<Cow<'static, str>>, count: usize) -> Self {
        self.read(heading, ReadingForm::Components(count)).aligned(false)
    }

    /// Shows the lowest of the numbers with `digits` significant digits.
    #[must_use]
    pub fn lowest(self, heading: impl Into<Cow<'static, str>>, digits: usize) -> Self {
        self.read(heading, ReadingForm::Lowest(digits))
    }

    /// Shows the largest magnitude of the numbers with `digits` significant digits.
    #[must_use]
    pub fn largest(self, heading: impl Into<Cow<'static, str>>, digits: usize) -> Self {
        self.read(heading, ReadingForm::Largest(digits))
    }

    /// Shows a text that is made of the row.
    #[must_use]
    pub fn shown(
        self,
        heading: impl Into<Cow<'static, str>>,
        unit: &'static str,
        text: impl Fn(&R, Style) -> String + 'static,
    ) -> Self {
        self.reading(heading, unit, ReadingForm::Own(Box::new(text)))
    }

    /// Tables for reading have this field if the condition holds; files have it anyway.
    #[must_use]
    pub(crate) fn read_if(mut self, is_read: bool) -> Self {
        self.reading = self.reading.filter(|_| is_read);
        self
    }

    /// Only the tables of one style have this field.
    #[must_use]
    pub(crate) fn only_in(mut self, style: Style) -> Self {
        if let Some(reading) = &mut self.reading {
            reading.style = Some(style);
        }
        self
    }

    /// Shows the field with another unit than that of its columns, for example one that depends on the results.
    #[must_use]
    pub fn with_unit(mut self, unit: impl Into<Cow<'static, str>>) -> Self {
        if let Some(reading) = &mut self.reading {
            reading.unit = unit.into();
        }
        self
    }

    /// Shows the field aligned to the right, as numbers are, or to the left.
    #[must_use]
    pub fn aligned(mut self, is_text: bool) -> Self {
        if let Some(reading) = &mut self.reading {
            reading.is_text = is_text;
        }
        self
    }
}

impl<R> Field<R> {
    /// Text of a row; `None` for a field that is not shown.
    fn text(&self, row: &R, style: Style) -> Option<String> {
        let form = &self.reading.as_ref().filter(|reading| reading.is_in(style))?.form;
        if let ReadingForm::Own(text) = form {
            return Some(text(row, style));
        }
        let mut cells = Vec::new();
        (self.values)(row, &mut cells);
        let numbers =
            cells.iter().filter_map(|cell| if let Cell::Number(number) = cell { Some(*number) } else { None });
        match form {
            ReadingForm::Lowest(digits) => {
                return Some(style.significant(numbers.fold(f64::INFINITY, f64::min), *digits));
            }
            ReadingForm::Largest(digits) => {
                return Some(style.significant(numbers.map(f64::abs).fold(0.0, f64::max), *digits));
            }
            _ => {}
        }
        let texts = cells.into_iter().map(|cell| match (cell, form) {
            (Cell::Number(value), ReadingForm::Decimals(count) | ReadingForm::Components(count)) => {
                style.decimals(value, *count)
            }
            (Cell::Number(value), ReadingForm::Significant(digits)) => style.significant(value, *digits),
            (Cell::Number(value), ReadingForm::Short(digits)) => style.short(value, *digits),
            (Cell::Count(count), _) => count.to_string(),
            (Cell::Text(text), _) => text,
            (Cell::Flag(is), _) => if is { "yes" } else { "no" }.to_owned(),
            (Cell::Missing(_) | Cell::Number(_), _) => NONE.to_owned(),
        });
        let separator = match (form, style) {
            (ReadingForm::Components(_), Style::Plain) => COMPONENTS,
            _ => ", ",
        };
        Some(texts.collect::<Vec<_>>().join(separator))
    }
}

/// Columns of a kind of rows.
pub struct Columns<R>(Vec<Field<R>>);

/// Heading of a column in a table for reading.
pub struct Heading<'a> {
    /// Name of the quantity.
    pub name: &'a str,
    /// Unit; empty without one.
    pub unit: &'a str,
    /// True for a column of texts, which are aligned to the left.
    pub is_text: bool,
}

impl Heading<'_> {
    /// Name with the unit in brackets.
    pub fn with_unit(&self) -> String {
        if self.unit.is_empty() { self.name.to_owned() } else { format!("{} [{}]", self.name, self.unit) }
    }
}

impl<R> Columns<R> {
    /// Columns of the fields that the table has.
    pub fn new(fields: impl IntoIterator<Item = Field<R>>) -> Self {
        Self(fields.into_iter().filter(|field| field.is_there).collect())
    }

    /// Fields of rows that have a row of this kind as a part.
    pub(crate) fn within<O: 'static>(self, part: impl Fn(&O) -> Option<&R> + Copy + 'static) -> Vec<Field<O>>
    where
        R: 'static,
    {
        self.0.into_iter().map(|field| field.within(part)).collect()
    }

    /// Descriptions of the columns in files.
    pub fn described(&self) -> Vec<Column> {
        self.0.iter().flat_map(|field| field.columns.iter().cloned()).collect()
    }

    /// Cells of a row in files.
    pub fn cells(&self, row: &R) -> Vec<Cell> {
        let mut cells = Vec::with_capacity(self.0.len());
        for field in &self.0 {
            (field.values)(row, &mut cells);
        }
        cells
    }

    /// Headings of the table for reading.
    pub fn headings(&self, style: Style) -> Vec<Heading<'_>> {
        let shown = self.0.iter().filter_map(|field| field.reading.as_ref()).filter(|reading| reading.is_in(style));
        shown.map(|of| Heading { name: &of.heading, unit: &of.unit, is_text: of.is_text }).collect()
    }

    /// Texts of a row in the table for reading.
    pub fn texts(&self, row: &R, style: Style) -> Vec<String> {
        self.0.iter().filter_map(|field| field.text(row, style)).collect()
    }
}

/// Rows of a table: cells for files, and texts for reading.
pub trait TableRows: Iterator<Item = Vec<Cell>> {
    /// The rows that are left, as a table for reading; of rows that say nothing about it, with `columns` and five
    /// digits.
    fn reading(self: Box<Self>, columns: &[Column]) -> ReadingTable;
}

/// Rows of results with their columns.
pub struct ResultTable<'a> {
    /// Columns.
    pub columns: Vec<Column>,
    /// Cells of every row, one per column.
    pub rows: Box<dyn TableRows + 'a>,
}

impl<'a> ResultTable<'a> {
    /// Table of rows with the columns of their kind.
    pub fn new<R: 'a>(columns: Columns<R>, rows: impl IntoIterator<Item: Borrow<R>, IntoIter: 'a>) -> Self {
        Self { columns: columns.described(), rows: Box::new(RowsOf { columns, rows: rows.into_iter() }) }
    }

    /// Table of cells.
    pub fn of_cells(columns: Vec<Column>, rows: impl Iterator<Item = Vec<Cell>> + 'a) -> Self {
        Self { columns, rows: Box::new(CellRows(rows)) }
    }

    /// The table with rounded numbers, as the program prints it.
    pub fn reading(self) -> ReadingTable {
        self.rows.reading(&self.columns)
    }
}

/// Rows of one kind.
struct RowsOf<R, I> {
    columns: Columns<R>,
    rows: I,
}

impl<R, I: Iterator<Item: Borrow<R>>> Iterator for RowsOf<R, I> {
    type Item = Vec<Cell>;

    fn next(&mut self) -> Option<Vec<Cell>> {
        self.rows.next().map(|row| self.columns.cells(row.borrow()))
    }
}

impl<R, I: Iterator<Item: Borrow<R>>> TableRows for RowsOf<R, I> {
    fn reading(self: Box<Self>, columns: &[Column]) -> ReadingTable {
        let headings = self.columns.headings(Style::Plain);
        if headings.is_empty() {
            return reading_of_cells(columns, *self);
        }
        let of = |of: Heading| ReadingColumn { name: of.name.into(), unit: of.unit.into(), is_text: of.is_text };
        let headings = headings.into_iter().map(of).collect();
        let Self { columns, rows } = *self;
        ReadingTable { columns: headings, rows: rows.map(|row| columns.texts(row.borrow(), Style::Plain)).collect() }
    }
}

/// Rows without a form for reading.
struct CellRows<I>(I);

impl<I: Iterator<Item = Vec<Cell>>> Iterator for CellRows<I> {
    type Item = Vec<Cell>;

    fn next(&mut self) -> Option<Vec<Cell>> {
        self.0.next()
    }
}

impl<I: Iterator<Item = Vec<Cell>>> TableRows for CellRows<I> {
    fn reading(self: Box<Self>, columns: &[Column]) -> ReadingTable {
        reading_of_cells(columns, self.0)
    }
}

fn reading_of_cells(columns: &[Column], rows: impl Iterator<Item = Vec<Cell>>) -> ReadingTable {
    let of = |column: &Column| ReadingColumn {
        name: units::without_unit(&column.name).replace('_', " "),
        unit: units::shown(&column.unit).to_owned(),
        is_text: column.kind == ColumnKind::Text,
    };
    let text = |cell: Cell| match cell {
        Cell::Number(value) => Style::Plain.significant(value, READ_DIGITS),
        Cell::Count(count) => count.to_string(),
        Cell::Flag(is) => if is { "yes" } else { "no" }.to_owned(),
        Cell::Text(text) => text,
        Cell::Missing(_) => NONE.to_owned(),
    };
    let rows = rows.map(|row| row.into_iter().map(text).collect()).collect();
    ReadingTable { columns: columns.iter().map(of).collect(), rows }
}

/// Tables of a command in files: its name, and the tables as [`Tabled::tables`] gives them.
pub type CommandTables = (&'static str, Vec<(&'static str, Vec<Column>)>);

/// Results that are a table in files.
pub trait Tabled {
    /// Every table that such results can be: when it is that one, in words that follow "with", and its columns. The
    /// parts of a robot have the name `NAME`.
    fn tables() -> Vec<(&'static str, Vec<Column>)>
    where
        Self: Sized;

    /// Table of the results.
    fn table(&self) -> ResultTable<'_>;
}

impl<T: Tabled> Tabled for Box<T> {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        T::tables()
    }

    fn table(&self) -> ResultTable<'_> {
        (**self).table()
    }
}

/// Name of a part of any robot in [`Tabled::tables`].
pub(crate) const ANY: &str = "NAME";

/// List with the name of a part of any robot.
pub(crate) fn any() -> Vec<String> {
    vec![ANY.to_owned()]
}

#[cfg(test)]
mod tests {
    use super::*;

    struct PulledCable {
        name: &'static str,
        force: [f64; 2],
        margin: Option<f64>,
    }

    fn of_rows(has_margin: bool) -> Columns<PulledCable> {
        Columns::new([
            column("name", "", "name", |row: &PulledCable| row.name).plain("cable"),
            parts("force_{}_n", ["x", "y"], "N", "force, {}", |row: &PulledCable| row.force).decimals("force", 1),
            column("margin_n", "N", "margin", |row: &PulledCable| row.margin).only_if(has_margin).short("margin", 3),
        ])
    }

    #[test]
    fn files_have_every_number_and_tables_for_reading_one_text_per_quantity() {
        let row = PulledCable { name: "a", force: [-1.0, 2.25], margin: None };
        let columns = of_rows(true);
        let headings: Vec<String> = columns.headings(Style::Plain).iter().map(Heading::with_unit).collect();
        assert_eq!(headings, ["cable", "force [N]", "margin [N]"]);
        assert_eq!(columns.texts(&row, Style::Plain), ["a", "-1.0, 2.2", NONE]);
        assert_eq!(columns.texts(&row, Style::Typeset), ["a", "−1.0, 2.2", NONE]);

        let table = ResultTable::new(columns, [row]);
        let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
        assert_eq!(names, ["name", "force_x_n", "force_y_n", "margin_n"]);
        let cells: Vec<Vec<Cell>> = table.rows.collect();
        let expected = [Cell::Text("a".to_owned()), Cell::Number(-1.0), Cell::Number(2.25), Cell::Missing(None)];
        assert_eq!(cells, [expected]);
    }

    #[test]
    fn a_table_has_the_fields_that_it_asks_for() {
        assert_eq!(of_rows(false).described().len(), 3);
        assert_eq!(of_rows(true).described()[2].about, "force, y");
    }
}
