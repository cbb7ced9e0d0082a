//! Files of measured responses, natural frequencies and time histories, as plain data.
//!
//! Readers take bytes and never touch a disk. A file that is cut off or damaged gives an error with its line, and no
//! reader reserves memory for a count that the file declares.

mod convert;
mod csv;
mod given_signals;
mod history;
pub mod uff;
mod uff_numbers;
mod unit_label;

pub use convert::NodePoint;
pub(crate) use convert::RESPONSE;
pub(crate) use convert::responses_of_uff;
pub use csv::{CsvContent, read_csv};

use anyhow::{Result, bail};
use funicular_study::measurements::{MeasuredFrequency, MeasuredHistory, MeasuredResponse};
use serde::{Deserialize, Serialize};

/// Maximum size of a file of measurements [bytes]: a thousand responses of ten thousand lines.
pub const MAX_BYTES: usize = 256 << 20;

/// Refuses a file that is too large to be read.
///
/// # Errors
/// A message with the limit.
pub fn check_size(path: &str, size: usize) -> Result<()> {
    if size > MAX_BYTES {
        bail!("{path} is larger than {} MiB, the limit for a file of measurements", MAX_BYTES >> 20);
    }
    Ok(())
}

/// Facts that a file of measurements may lack.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileOptions {
    /// Points of the platform at nodes of a Universal File.
    #[serde(default)]
    pub nodes: Vec<NodePoint>,
    /// Signals of the responses of a table, or of functions of a Universal File.
    #[serde(default)]
    pub responses: Vec<ResponseName>,
    /// Point where the force acts in all responses of a table, platform frame [m].
    #[serde(default)]
    pub input_point_m: Option<[f64; 3]>,
    /// Point whose motion is measured in all responses of a table, platform frame [m].
    #[serde(default)]
    pub output_point_m: Option<[f64; 3]>,
}

/// Signals of a response of a table, or of a function of a Universal File.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ResponseName {
    /// Name in the header.
    pub name: String,
    /// Input signal, as `fz`.
    pub input: String,
    /// Output signal, as `az`.
    pub output: String,
}

/// Contents of a file of measurements.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Measured {
    /// Responses.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub responses: Vec<MeasuredResponse>,
    /// Natural frequencies.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub frequencies: Vec<MeasuredFrequency>,
    /// Time histories.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub histories: Vec<MeasuredHistory>,
    /// Sentences on what was left out.
    #[serde(skip)]
    pub notes: Vec<String>,
}

/// Reads a file of measurements; the ending of its name says what it is.
///
/// # Errors
/// Another ending, or a file that cannot be read; the message names its line.
///
/// # Example
/// ```
/// use funicular_formats::measurements::{FileOptions, read};
///
/// let list = b"frequency_hz,damping_ratio\n1.25,0.004\n";
/// let found = read("modes.csv", list, &FileOptions::default())?;
/// assert_eq!(found.frequencies[0].damping_ratio, Some(0.004));
/// # Ok::<(), anyhow::Error>(())
/// ```
pub fn read(path: &str, bytes: &[u8], options: &FileOptions) -> Result<Measured> {
    for (i, given) in options.responses.iter().enumerate() {
        if options.responses[..i].iter().any(|other| other.name == given.name) {
            bail!("⟪response⟫ {}: the response is there twice; give its signals once", given.name);
        }
    }

    let ending = path.rsplit_once('.').map(|(_, ending)| ending.to_ascii_lowercase());
    match ending.as_deref() {
        Some("uff" | "unv") => {
            let file = uff::UffFile::read(path, bytes)?;
            let (responses, notes) = responses_of_uff(path, &file, &options.nodes, &options.responses)?;
            Ok(Measured { responses, notes, ..Measured::default() })
        }
        Some("csv") => {
            let points = [options.input_point_m, options.output_point_m];
            Ok(match read_csv(path, bytes, &options.responses, points)? {
                CsvContent::Responses(responses) => Measured { responses, ..Measured::default() },
                CsvContent::Frequencies(frequencies) => Measured { frequencies, ..Measured::default() },
                CsvContent::History((history, notes)) => {
                    Measured { histories: vec![history], notes, ..Measured::default() }
                }
            })
        }
        _ => bail!("{path}: measurements are read from .uff and .unv (Universal File) and from .csv"),
    }
}
