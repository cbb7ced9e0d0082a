//! JSON of results: one line per key, every digit, and no `null`.

use crate::analyses::Found;
use crate::error::{Error, NoSolution};
use crate::wording::{Words, told};
use serde::Serialize;
use serde_json::ser::{CharEscape, Formatter};
use std::io::{self, Write};

/// Version of the form of results.
pub(crate) const SCHEMA: &str = "funicular/1";

/// Results of a command, with the keys that all results have.
#[derive(Serialize)]
struct Envelope<'a, R> {
    schema: &'static str,
    command: &'static str,
    #[serde(skip_serializing_if = "str::is_empty")]
    robot: &'a str,
    #[serde(flatten)]
    results: &'a R,
    warnings: &'a [String],
}

/// Results of a command as JSON, with the warnings worded for a front end.
///
/// # Errors
/// [`NoSolution`]: a result that is not finite.
pub fn of_results<R: Found>(results: &R, words: Words) -> Result<Vec<u8>, Error> {
    let warnings: Vec<String> = results.warnings().iter().map(|text| told(text, words)).collect();
    let mut bytes = Vec::new();
    write(&mut bytes, R::COMMAND, results.robot(), results, &warnings).map_err(anyhow::Error::from)?;
    Ok(bytes)
}

/// Appends results of a command for a robot to `out`.
///
/// It writes to memory only: for every kind of writer, each type of results would be compiled again.
///
/// # Errors
/// [`NoSolution`]: a result that is not finite, which JSON cannot express.
pub fn write<R: Serialize>(
    out: &mut Vec<u8>,
    command: &'static str,
    robot: &str,
    results: &R,
    warnings: &[String],
) -> Result<(), NoSolution> {
    let envelope = Envelope { schema: SCHEMA, command, robot, results, warnings };
    let mut serializer = serde_json::Serializer::with_formatter(&mut *out, LineFormatter { depth: 0 });
    envelope.serialize(&mut serializer).map_err(not_finite)?;
    out.push(b'\n');
    Ok(())
}

/// Error of a result that JSON cannot express.
fn not_finite(error: serde_json::Error) -> NoSolution {
    NoSolution(format!(
        "{}: an undamped resonance lies exactly here, or numbers of the robot file are too far apart; change the \
         frequency or check the units",
        io::Error::from(error)
    ))
}

/// Formatter that writes each key of an object on its own line and an array on one line.
struct LineFormatter {
    depth: usize,
}

impl LineFormatter {
    fn new_line<W: ?Sized + Write>(&self, out: &mut W) -> io::Result<()> {
        write!(out, "\n{:width$}", "", width = 2 * self.depth)
    }
}

impl Formatter for LineFormatter {
    /// Refuses a `null`: serde_json writes it for a number that is not finite, and results leave out absent keys.
    fn write_null<W: ?Sized + Write>(&mut self, _: &mut W) -> io::Result<()> {
        Err(io::Error::other("a result is not a finite number"))
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        if first { Ok(()) } else { out.write_all(b", ") }
    }

    fn begin_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.depth += 1;
        out.write_all(b"{")
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        if !first {
            out.write_all(b",")?;
        }
        self.new_line(out)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        out.write_all(b": ")
    }

    fn end_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.depth -= 1;
        self.new_line(out)?;
        out.write_all(b"}")
    }

    fn write_char_escape<W: ?Sized + Write>(&mut self, out: &mut W, escape: CharEscape) -> io::Result<()> {
        serde_json::ser::CompactFormatter.write_char_escape(out, escape)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize)]
    struct SampleResults {
        values: Vec<f64>,
        rows: Vec<SampleRow>,
    }

    #[derive(Serialize)]
    struct SampleRow {
        x: f64,
    }

    #[test]
    fn arrays_take_one_line_and_objects_one_a_key() {
        let mut out = Vec::new();
        let sample = SampleResults { values: vec![0.1, 2.0], rows: vec![SampleRow { x: 1.0 }] };
        write(&mut out, "modes", "r \"1\"", &sample, &[]).unwrap();
        let expected = "{\n  \"schema\": \"funicular/1\",\n  \"command\": \"modes\",\n  \"robot\": \"r \\\"1\\\"\",\n  \
            \"values\": [0.1, 2.0],\n  \"rows\": [{\n    \"x\": 1.0\n  }],\n  \"warnings\": []\n}\n";
        assert_eq!(String::from_utf8(out).unwrap(), expected);
    }

    #[test]
    fn a_result_that_is_not_finite_is_an_error() {
        for value in [f64::NAN, f64::INFINITY] {
            assert!(write(&mut Vec::new(), "c", "r", &SampleRow { x: value }, &[]).is_err());
        }
    }
}
