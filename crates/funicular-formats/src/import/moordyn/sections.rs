//! Sections of a MoorDyn input file and the rows of their tables.

use super::SourceFile;
use crate::import::text;
use anyhow::{Result, bail};
use funicular_study::text::clean;
use std::rc::Rc;

/// SectionKind of a section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SectionKind {
    LineTypes,
    RodTypes,
    Bodies,
    Rods,
    Points,
    Lines,
    Options,
    ExternalLoads,
    /// Lines that fail, at a time or at a tension.
    Failures,
    /// Names of signals to write, and the line after the last section.
    Outputs,
    /// Any other section (control, …): it does not describe the robot's statics.
    Other,
}

/// Words of the headers. The longer ones come first: `LINE TYPES` must not be taken as a section of `LINES`.
const HEADERS: [(&[&str], SectionKind); 10] = [
    (&["LINE TYPES", "LINE DICTIONARY"], SectionKind::LineTypes),
    (&["ROD TYPES", "ROD DICTIONARY"], SectionKind::RodTypes),
    (&["EXTERNAL LOADS"], SectionKind::ExternalLoads),
    (&["BODIES", "BODY LIST", "BODY PROPERTIES"], SectionKind::Bodies),
    (&["RODS", "ROD LIST", "ROD PROPERTIES"], SectionKind::Rods),
    (&["POINTS", "POINT LIST", "POINT PROPERTIES", "CONNECTION PROPERTIES", "NODE PROPERTIES"], SectionKind::Points),
    (&["LINES", "LINE LIST", "LINE PROPERTIES"], SectionKind::Lines),
    (&["OPTIONS"], SectionKind::Options),
    (&["FAILURE"], SectionKind::Failures),
    (&["OUTPUT", "NEED THIS LINE"], SectionKind::Outputs),
];

/// Section with at least one row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Section<'a> {
    pub(super) kind: SectionKind,
    /// Words of its header.
    pub(super) title: &'a str,
    /// Line of its header, from 1.
    pub(super) line: usize,
}

/// SourceRow of a table in an input file.
#[derive(Debug, Clone)]
pub(super) struct SourceRow<'a> {
    /// Line number in the file, from 1.
    pub(super) line: usize,
    pub(super) words: Vec<&'a str>,
    /// Names of the columns; none in the list of options.
    names: Rc<[&'a str]>,
}

/// Rows of a file, each with its section.
pub(super) fn rows(text: &str) -> Vec<(Section<'_>, SourceRow<'_>)> {
    let mut rows = Vec::new();
    let mut section = None;
    let mut to_skip = 0;
    let mut names: Rc<[&str]> = Rc::default();

    for (i, line) in text.lines().enumerate() {
        if let Some(header) = header(line) {
            let title = line.trim_matches(|c: char| c == '-' || c.is_whitespace());
            section = Some(Section { kind: header, title, line: i + 1 });
            // Two rows with names and units of the columns follow; the list of options has none.
            to_skip = if matches!(header, SectionKind::Options | SectionKind::Outputs) { 0 } else { 2 };
            names = Rc::default();
            continue;
        }

        let Some(section) = section else { continue };
        if to_skip == 2 {
            let words: Vec<&str> = line.split_whitespace().collect();
            // In the layout of version 1, the number of rows stands before the names: `2 NLines - number of lines`.
            let is_count =
                matches!(words[..], [count, name, ..] if count.parse::<usize>().is_ok() && name.starts_with('N'));
            if !is_count {
                names = words.into();
                to_skip = 1;
            }
            continue;
        }
        if to_skip == 1 {
            to_skip = 0;
            continue;
        }

        let words: Vec<&str> = without_comment(line).split_whitespace().collect();
        if !words.is_empty() {
            rows.push((section, SourceRow { line: i + 1, words, names: names.clone() }));
        }
    }
    rows
}

/// True if a text has the sections that every robot needs.
pub(super) fn is_input(text: &str) -> bool {
    let has = |kind| text.lines().any(|line| header(line) == Some(kind));
    has(SectionKind::LineTypes) || (has(SectionKind::Lines) && has(SectionKind::Points))
}

/// SectionKind of the section that a line begins, if the line is a header.
fn header(line: &str) -> Option<SectionKind> {
    if !line.contains("---") {
        return None;
    }
    let upper = line.to_uppercase();
    let words = |known: &[&str]| known.iter().any(|word| upper.contains(word));
    Some(HEADERS.iter().find(|(known, _)| words(known)).map_or(SectionKind::Other, |(_, kind)| *kind))
}

fn without_comment(line: &str) -> &str {
    line.split(['!', '#', '%']).next().unwrap_or_default()
}

impl<'a> SourceRow<'a> {
    /// Columns whose names begin with one of these words, in any case.
    pub(super) fn columns_of(&self, begins: &'static [&'static str]) -> impl Iterator<Item = usize> + '_ {
        let is_one = |name: &str| {
            let name = name.to_lowercase();
            begins.iter().any(|word| name.starts_with(word))
        };
        self.names.iter().enumerate().filter(move |(_, name)| is_one(name)).map(|(column, _)| column)
    }

    /// Word in a column of the row.
    pub(super) fn word(&self, file: &SourceFile, column: usize, name: &str) -> Result<&'a str> {
        match self.words.get(column) {
            Some(word) => Ok(word),
            None => bail!(self.error(file, format!("column {} ({name}) is missing", column + 1))),
        }
    }

    /// Number in a column of the row.
    pub(super) fn number(&self, file: &SourceFile, column: usize, name: &str) -> Result<f64> {
        let word = self.word(file, column, name)?;
        text::number(word).map_err(|wrong| self.error(file, format!("column {} ({name}) is {wrong}", column + 1)))
    }

    /// Number in a column of the row that must not be negative.
    pub(super) fn quantity(&self, file: &SourceFile, column: usize, name: &str) -> Result<f64> {
        match self.number(file, column, name)? {
            value if value >= 0.0 => Ok(value),
            value => {
                bail!(self.error(file, format!("column {} ({name}) is {value}, it cannot be negative", column + 1)))
            }
        }
    }

    /// Numbers in a column of the row, separated by `|`.
    pub(super) fn numbers(&self, file: &SourceFile, column: usize, name: &str) -> Result<Vec<f64>> {
        let word = self.word(file, column, name)?;
        let numbers: Result<Vec<f64>, String> = word.split('|').map(text::number).collect();
        numbers.map_err(|wrong| self.error(file, format!("column {} ({name}) holds {wrong}", column + 1)))
    }

    /// Positive integer in a column of the row; letters before it are ignored.
    pub(super) fn id(&self, file: &SourceFile, column: usize, name: &str) -> Result<usize> {
        let word = self.word(file, column, name)?;
        let digits = word.trim_start_matches(|c: char| c.is_ascii_alphabetic());
        digits.parse().ok().filter(|id| *id > 0).ok_or_else(|| {
            self.error(
                file,
                format!("column {} ({name}) is `{}`, which is no positive integer", column + 1, clean(word)),
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sections_are_recognized_by_their_headers_and_comments_are_left_out() {
        let text = "free text\n--- LINE TYPES ---\nName\n(-)\nrope 1 ! note\n\n---- POINTS ----\na\nb\n1 fixed # x\n\
                    --- SOLVER OPTIONS---\n0 rho\n--- need this line ---\n";
        let found: Vec<(SectionKind, usize, usize)> =
            rows(text).into_iter().map(|(section, row)| (section.kind, row.line, row.words.len())).collect();
        assert_eq!(
            found,
            [(SectionKind::LineTypes, 5, 2), (SectionKind::Points, 10, 2), (SectionKind::Options, 12, 2)]
        );
        assert!(is_input(text) && !is_input("a text with --- dashes ---"));
    }
}
