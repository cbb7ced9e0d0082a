//! The sections of an input file and the rows of their tables.

use super::SourceFile;
use crate::import::text::{self, clean};
use anyhow::{Result, bail};

/// A kind of section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    LineTypes,
    RodTypes,
    Bodies,
    Rods,
    Points,
    Lines,
    Options,
    /// Outputs, failures, control, and whatever comes: none of it describes the robot at rest but this.
    ExternalLoads,
    Other,
}

/// Words of a header, the longer ones first: `LINE TYPES` is no section of `LINE`s.
const HEADERS: [(&[&str], Kind); 8] = [
    (&["LINE TYPES", "LINE DICTIONARY"], Kind::LineTypes),
    (&["ROD TYPES", "ROD DICTIONARY"], Kind::RodTypes),
    (&["EXTERNAL LOADS"], Kind::ExternalLoads),
    (&["BODIES", "BODY LIST", "BODY PROPERTIES"], Kind::Bodies),
    (&["RODS", "ROD LIST", "ROD PROPERTIES"], Kind::Rods),
    (&["POINTS", "POINT LIST", "POINT PROPERTIES", "CONNECTION PROPERTIES", "NODE PROPERTIES"], Kind::Points),
    (&["LINES", "LINE LIST", "LINE PROPERTIES"], Kind::Lines),
    (&["OPTIONS"], Kind::Options),
];

/// A row of a table.
#[derive(Debug, Clone)]
pub(super) struct Row<'a> {
    /// Line of the file, from 1.
    pub(super) line: usize,
    pub(super) words: Vec<&'a str>,
}

/// The rows of a file, each with its section.
pub(super) fn rows(text: &str) -> Vec<(Kind, Row<'_>)> {
    let mut rows = Vec::new();
    let mut kind = None;
    let mut to_skip = 0;
    for (i, line) in text.lines().enumerate() {
        if let Some(header) = header(line) {
            kind = Some(header);
            // Names and units of the columns; the list of options has none.
            to_skip = if header == Kind::Options { 0 } else { 2 };
            continue;
        }
        let Some(kind) = kind else { continue };
        if to_skip > 0 {
            to_skip -= 1;
            continue;
        }
        let words: Vec<&str> = without_comment(line).split_whitespace().collect();
        if !words.is_empty() {
            rows.push((kind, Row { line: i + 1, words }));
        }
    }
    rows
}

/// Whether a text has the sections without which there is no robot.
pub(super) fn is_input(text: &str) -> bool {
    let has = |kind| text.lines().any(|line| header(line) == Some(kind));
    has(Kind::LineTypes) || (has(Kind::Lines) && has(Kind::Points))
}

/// The section that a line begins.
fn header(line: &str) -> Option<Kind> {
    if !line.contains("---") {
        return None;
    }
    let upper = line.to_uppercase();
    let words = |known: &[&str]| known.iter().any(|word| upper.contains(word));
    Some(HEADERS.iter().find(|(known, _)| words(known)).map_or(Kind::Other, |(_, kind)| *kind))
}

fn without_comment(line: &str) -> &str {
    line.split(['!', '#', '%']).next().unwrap_or_default()
}

impl<'a> Row<'a> {
    /// A word of the row.
    pub(super) fn word(&self, file: &SourceFile, column: usize, name: &str) -> Result<&'a str> {
        match self.words.get(column) {
            Some(word) => Ok(word),
            None => bail!(self.error(file, format!("column {} ({name}) is missing", column + 1))),
        }
    }

    /// A number of the row.
    pub(super) fn number(&self, file: &SourceFile, column: usize, name: &str) -> Result<f64> {
        let word = self.word(file, column, name)?;
        text::number(word).map_err(|wrong| self.error(file, format!("column {} ({name}) is {wrong}", column + 1)))
    }

    /// A number of the row that is not negative.
    pub(super) fn quantity(&self, file: &SourceFile, column: usize, name: &str) -> Result<f64> {
        match self.number(file, column, name)? {
            value if value >= 0.0 => Ok(value),
            value => {
                bail!(self.error(file, format!("column {} ({name}) is {value}, it cannot be negative", column + 1)))
            }
        }
    }

    /// Numbers between bars.
    pub(super) fn numbers(&self, file: &SourceFile, column: usize, name: &str) -> Result<Vec<f64>> {
        let word = self.word(file, column, name)?;
        let numbers: Result<Vec<f64>, String> = word.split('|').map(text::number).collect();
        numbers.map_err(|wrong| self.error(file, format!("column {} ({name}) holds {wrong}", column + 1)))
    }

    /// A counting number of the row, letters before it left out.
    pub(super) fn id(&self, file: &SourceFile, column: usize, name: &str) -> Result<usize> {
        let word = self.word(file, column, name)?;
        let digits = word.trim_start_matches(|c: char| c.is_ascii_alphabetic());
        digits.parse().ok().filter(|id| *id > 0).ok_or_else(|| {
            self.error(file, format!("column {} ({name}) is `{}`, which is no number of one", column + 1, clean(word)))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sections_are_told_by_their_headers_and_comments_are_left_out() {
        let text = "free text\n--- LINE TYPES ---\nName\n(-)\nrope 1 ! note\n\n---- POINTS ----\na\nb\n1 fixed # x\n\
                    --- SOLVER OPTIONS---\n0 rho\n--- need this line ---\n";
        let found: Vec<(Kind, usize, usize)> =
            rows(text).into_iter().map(|(kind, row)| (kind, row.line, row.words.len())).collect();
        assert_eq!(found, [(Kind::LineTypes, 5, 2), (Kind::Points, 10, 2), (Kind::Options, 12, 2)]);
        assert!(is_input(text) && !is_input("a text with --- dashes ---"));
    }
}
