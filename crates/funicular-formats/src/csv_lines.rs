//! CSV texts with the line numbers of their records, for messages.

use anyhow::{Result, anyhow, bail};
use funicular_study::units;
use funicular_study::values::number;
use std::borrow::Cow;

/// Line number of a record, from 1. It is counted here, because the position of the reader points to the end of the
/// previous record, before blank lines, and does not count all kinds of line ends.
pub(crate) fn line_at(bytes: &[u8], position: &csv::Position) -> usize {
    LineCounter::new(bytes).at(position)
}

/// Line numbers of records in ascending order, each counted on from the one before.
struct LineCounter<'a> {
    bytes: &'a [u8],
    /// Number of bytes in which the ends of lines have been counted.
    counted: usize,
    line: usize,
}

impl<'a> LineCounter<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, counted: 0, line: 1 }
    }

    fn at(&mut self, position: &csv::Position) -> usize {
        let bytes = self.bytes;
        let from = usize::try_from(position.byte()).unwrap_or(bytes.len()).min(bytes.len());
        let ends = |byte: &u8| matches!(byte, b'\r' | b'\n');
        let begin = from + bytes[from..].iter().take_while(|byte| ends(byte)).count();
        let ends_line = |i: &usize| bytes[*i] == b'\n' || (bytes[*i] == b'\r' && bytes.get(i + 1) != Some(&b'\n'));
        self.line += (self.counted..begin).filter(ends_line).count();
        self.counted = begin;
        self.line
    }
}

/// Form in which a program wrote a table: its separator, and whether numbers have decimal commas.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TableForm {
    delimiter: u8,
    has_decimal_commas: bool,
    /// Number of bytes before the table: those of a line `sep=;`, which spreadsheets write.
    begin: usize,
}

impl TableForm {
    /// Form of a table, by its first line that is neither empty nor a comment.
    pub(crate) fn of(bytes: &[u8]) -> Self {
        let (stated, begin) = stated_delimiter(bytes);
        let table = &bytes[begin..];
        let lines = || {
            let all = table.split(|byte| matches!(byte, b'\r' | b'\n')).map(<[u8]>::trim_ascii_start);
            all.filter(|line| !line.is_empty() && line[0] != b'#')
        };
        let first = lines().next();
        let count = |delimiter: u8| first.map_or(0, |line| line.split(|byte| *byte == delimiter).count() - 1);
        // Of equal counts the comma is taken.
        let frequent = [b';', b'\t', b','].into_iter().max_by_key(|delimiter| count(*delimiter)).unwrap_or(b',');
        let delimiter = stated.unwrap_or(frequent);

        // A table with commas and points in its numbers has thousands separators or a mistake: it is not guessed which.
        let is_decimal =
            |mark: u8| lines().any(|line| line.windows(2).any(|pair| pair[0] == mark && pair[1].is_ascii_digit()));
        let has_decimal_commas = delimiter != b',' && is_decimal(b',') && !is_decimal(b'.');
        Self { delimiter, has_decimal_commas, begin }
    }

    /// Reader of the table and its bytes.
    pub(crate) fn reader<'a>(
        self,
        bytes: &'a [u8],
        builder: &mut csv::ReaderBuilder,
    ) -> (csv::Reader<&'a [u8]>, &'a [u8]) {
        let table = &bytes[self.begin..];
        (builder.trim(csv::Trim::All).delimiter(self.delimiter).from_reader(table), table)
    }

    /// Number of lines before the table.
    pub(crate) fn lines_before(self) -> usize {
        usize::from(self.begin > 0)
    }

    /// Text of a cell with a decimal point.
    pub(crate) fn cell<'c>(&self, cell: &'c str) -> Cow<'c, str> {
        let is_number = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit() || b"+-,eE".contains(&byte));
        if self.has_decimal_commas && cell.matches(',').count() == 1 && is_number(cell) {
            return cell.replace(',', ".").into();
        }
        cell.into()
    }
}

/// Separator that a first line `sep=;` states, and the length of this line.
fn stated_delimiter(bytes: &[u8]) -> (Option<u8>, usize) {
    let bom = if bytes.starts_with("\u{feff}".as_bytes()) { 3 } else { 0 };
    let end = bytes.iter().position(|byte| matches!(byte, b'\r' | b'\n')).unwrap_or(bytes.len());
    let line = bytes.get(bom..end).unwrap_or_default().trim_ascii_end();
    let line = line.strip_prefix(b"\"").and_then(|line| line.strip_suffix(b"\"")).unwrap_or(line);
    let stated = match line {
        [b's' | b'S', b'e' | b'E', b'p' | b'P', b'=', delimiter] if !delimiter.is_ascii_alphanumeric() => *delimiter,
        // A tab at the end of a line is trimmed away.
        b"sep=" | b"SEP=" => b'\t',
        _ => return (None, 0),
    };
    let ends = bytes[end..].iter().take(2).zip(b"\r\n").take_while(|(a, b)| a == b).count().max(1);
    (Some(stated), (end + ends).min(bytes.len()))
}

/// Table whose first line names the columns. Columns are separated by commas, semicolons or tabs; numbers have a
/// decimal point, or a decimal comma where commas do not separate the columns. Lines that begin with # are comments.
pub struct CsvText<'a> {
    path: &'a str,
    bytes: &'a [u8],
    reader: csv::Reader<&'a [u8]>,
    form: TableForm,
    /// Names of the columns, in units of the program.
    pub header: Vec<String>,
    /// Names of the columns as the file has them, for messages.
    pub written: Vec<String>,
    /// Factors of the numbers of the columns; 1 for those in units of the program.
    factors: Vec<f64>,
    /// True if a first column without a name counts the rows.
    has_index: bool,
}

impl<'a> CsvText<'a> {
    /// Reads the header.
    ///
    /// # Errors
    /// A text that cannot be read, a first line that does not name the columns, or a column that is there twice.
    pub fn open(path: &'a str, bytes: &'a [u8]) -> Result<Self> {
        let form = TableForm::of(bytes);
        let (mut reader, bytes) = form.reader(bytes, csv::ReaderBuilder::new().comment(Some(b'#')));
        let header = reader.headers().map_err(|error| match error.kind() {
            csv::ErrorKind::Utf8 { .. } => anyhow!("{path}, first line: {NOT_UTF8}"),
            _ => anyhow!("cannot read {path}: {error}"),
        })?;
        let mut header: Vec<String> =
            header.iter().map(|name| name.trim_start_matches('\u{feff}').to_owned()).collect();
        let has_index = header.len() > 1 && header[0].is_empty();
        if has_index {
            header.remove(0);
        }
        check_names(path, form, &header)?;
        let written = header;
        let (header, factors): (Vec<String>, Vec<f64>) = written.iter().map(|name| units::column(name)).unzip();
        if let Some((second, name)) = header.iter().enumerate().find(|(i, name)| header[..*i].contains(name)) {
            let first = header.iter().position(|other| other == name).unwrap_or_default();
            bail!("{path} has columns `{}` and `{}`: keep one of them", written[first], written[second]);
        }
        Ok(Self { path, bytes, reader, form, header, written, factors, has_index })
    }

    /// Records below the header, each with its line in the file, from 1.
    ///
    /// # Errors
    /// A text that cannot be read, or a line with another number of values.
    pub fn records(self) -> impl Iterator<Item = Result<(usize, csv::StringRecord)>> {
        let Self { path, bytes, reader, form, has_index, factors, .. } = self;
        let mut lines = LineCounter::new(bytes);
        let mut index = None;
        reader.into_records().map(move |record| {
            let mut line_of = |position: Option<&csv::Position>| {
                position.map_or(0, |position| lines.at(position) + form.lines_before())
            };
            let record = record.map_err(|error| match error.kind() {
                csv::ErrorKind::UnequalLengths { pos, expected_len, len } => {
                    unequal(path, line_of(pos.as_ref()), *len, *expected_len)
                }
                csv::ErrorKind::Utf8 { pos, .. } => anyhow!("{path}, line {}: {NOT_UTF8}", line_of(pos.as_ref())),
                _ => anyhow!("cannot read {path}: {error}"),
            })?;
            let line = line_of(record.position());
            let skipped = usize::from(has_index);
            if has_index {
                let count = record.get(0).and_then(|cell| cell.parse::<u64>().ok());
                if count.is_none() || index.is_some_and(|before: u64| count != before.checked_add(1)) {
                    bail!(
                        "{path}, line {line}: the first column has no name and does not count the rows: name it, or \
                         leave it out (pandas: `index=False`)"
                    );
                }
                index = count;
            }
            let cells = record.iter().skip(skipped).map(|cell| form.cell(cell));
            Ok((line, cells.zip(&factors).map(|(cell, factor)| converted(cell, *factor)).collect::<Vec<_>>().into()))
        })
    }
}

/// Cell in a unit of the program; what is no number stays as it is.
fn converted(cell: Cow<'_, str>, factor: f64) -> Cow<'_, str> {
    match number(&cell) {
        Ok(value) if (factor - 1.0).abs() > 0.0 => (value * factor).to_string().into(),
        _ => cell,
    }
}

const NOT_UTF8: &str = "the text is not valid UTF-8: save the table as CSV in UTF-8";

/// Maximum number of characters of a first line in a message.
const MAX_SHOWN: usize = 60;

/// Checks the names of the columns.
fn check_names(path: &str, form: TableForm, header: &[String]) -> Result<()> {
    if let [only] = header
        && only.split(['|', ' ']).filter(|part| !part.is_empty()).count() > 1
    {
        let shown: String = only.chars().take(MAX_SHOWN).collect();
        bail!(
            "{path}: the first line is `{shown}`: it has to name the columns, separated by commas, semicolons or tabs; \
             begin lines of text before it with #"
        );
    }
    if !header.is_empty() && header.iter().all(|name| number(&form.cell(name)).is_ok()) {
        bail!("{path}: the first line has no names, only numbers: write the names of the columns above it");
    }
    if let Some(place) = header.iter().position(String::is_empty)
        && header.len() > 1
    {
        bail!("{path}: column {} of the first line has no name: name it, or leave the column out", place + 1);
    }
    if let Some((_, twice)) = header.iter().enumerate().find(|(i, name)| header[..*i].contains(name)) {
        bail!("{path} has the column `{twice}` twice: keep one of them");
    }
    Ok(())
}

/// Error of a line with another number of values than the first one.
fn unequal(path: &str, line: usize, values: u64, names: u64) -> anyhow::Error {
    if names == 1 {
        return anyhow!(
            "{path}, line {line}: {values} values, but 1 in the header: the first line has to name the columns; begin \
             lines of text before it with #"
        );
    }
    anyhow!("{path}, line {line}: {values} values, but {names} in the header: give all lines the same columns")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<(usize, Vec<String>)>> {
        let text = CsvText::open("t.csv", text.as_bytes())?;
        let header = (0, text.header.clone());
        let rows = text.records().map(|row| row.map(|(line, row)| (line, row.iter().map(str::to_owned).collect())));
        std::iter::once(Ok(header)).chain(rows).collect()
    }

    #[test]
    fn separators_decimal_commas_and_an_index_are_read_as_the_plain_table() {
        let plain = read("t_s,x_m\n0,-2.5\n1e-3,3\n").unwrap();
        for same in [
            "t_s;x_m\n0;-2.5\n1e-3;3\n",
            "t_s;x_m\r\n0;-2,5\r\n1e-3;3\r\n",
            "t_s\tx_m\n0\t-2.5\n1e-3\t3\n",
            "t_s\tx_m\n0\t-2,5\n1e-3\t3\n",
            ",t_s,x_m\n0,0,-2.5\n1,1e-3,3\n",
            ";t_s;x_m\n1;0;-2,5\n2;1e-3;3\n",
            "\u{feff}t_s;x_m\n0;-2,5\n1e-3;3\n",
        ] {
            assert_eq!(read(same).unwrap(), plain, "{same:?}");
        }
        for stated in ["sep=;\nt_s;x_m\n0;-2,5\n1e-3;3\n", "\u{feff}sep=,\r\nt_s,x_m\r\n0,-2.5\r\n1e-3,3\r\n"] {
            let found = read(stated).unwrap();
            assert_eq!(
                found.iter().map(|row| &row.1).collect::<Vec<_>>(),
                plain.iter().map(|row| &row.1).collect::<Vec<_>>()
            );
            assert_eq!(found[2].0, 4, "{stated:?}");
        }
    }

    #[test]
    fn columns_in_inches_and_feet_are_read_in_metres() {
        let plain = read("t_s,length_a_m,x_m\n0,2.54,0.6096\n1,,3.048\n").unwrap();
        for same in [
            "t_s,length_a_in,x_ft\n0,100,2\n1,,10\n",
            "t_ms;length_a [in];x (ft)\n0;100;2\n1000;;10\n",
            ",t_s,length_a_cm,x_in\n0,0,254,24\n1,1,,120\n",
        ] {
            let found = read(same).unwrap();
            assert_eq!(found[0].1, plain[0].1, "{same:?}");
            for (found, plain) in found.iter().zip(&plain).skip(1) {
                let numbers =
                    |row: &[String]| row.iter().map(|cell| cell.parse().unwrap_or(-1.0)).collect::<Vec<f64>>();
                let pairs = numbers(&found.1).into_iter().zip(numbers(&plain.1));
                assert!(pairs.clone().all(|(a, b)| (a - b).abs() < 1e-15), "{same:?}: {:?}", pairs.collect::<Vec<_>>());
            }
        }
        let twice = CsvText::open("t.csv", b"x_in,x_m\n1,2\n").err().unwrap().to_string();
        assert!(twice.contains("`x_in` and `x_m`"), "{twice}");
    }

    #[test]
    fn a_cell_that_may_be_thousands_or_decimals_stays_as_it_is() {
        assert_eq!(read("a;b\n1,234;0.5\n").unwrap()[1].1, ["1,234", "0.5"]);
        assert_eq!(read("a;b\n1,234,567;2\n").unwrap()[1].1, ["1,234,567", "2"]);
        assert_eq!(read("a;b\nleft, low;2,5\n").unwrap()[1].1, ["left, low", "2.5"]);
    }

    #[test]
    fn a_first_line_without_names_is_told_with_its_cause() {
        for (text, says) in [
            ("0,-2,0\n1,2,3\n", "only numbers"),
            ("0;-2,5;0\n1;2;3\n", "only numbers"),
            ("Measured on 3 May\nt_s,x_m\n0,1\n", "begin lines of text before it with #"),
            ("Measured\nt_s,x_m\n0,1\n", "line 2: 2 values, but 1 in the header"),
            ("t_s x_m\n0 1\n", "separated by commas, semicolons or tabs"),
            ("t_s,,x_m\n0,1,2\n", "column 2 of the first line has no name"),
            (",t_s\n0,1\n7,2\n", "line 3: the first column has no name"),
            (",t_s\na,1\n", "pandas: `index=False`"),
            ("t_s,x_m\n0,1,2\n", "line 2: 3 values, but 2 in the header"),
            ("a,a\n", "twice"),
        ] {
            let told = read(text).unwrap_err().to_string();
            assert!(told.contains(says), "{told}");
        }
        let latin = CsvText::open("t.csv", b"a,b\n1,\xe4\n").unwrap().records().next().unwrap().unwrap_err();
        assert!(latin.to_string().contains("line 2: the text is not valid UTF-8"), "{latin}");
    }
}
