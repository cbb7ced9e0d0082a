//! Measured responses, natural frequencies and states as plain data, and the files that hold them.
//!
//! Readers take bytes and never touch a disk. A file that is cut off or damaged gives an error with its line, and no
//! reader reserves memory for a count that the file declares.

mod convert;
mod csv;
mod given_signals;
pub mod uff;
mod uff_numbers;
mod unit_label;

pub(crate) use convert::RESPONSE;
pub use convert::{NodePoint, responses_of_uff};
pub use csv::{CsvContent, ResponseName, read_csv};

use anyhow::{Result, bail};
use serde::{Deserialize, Serialize};

/// Maximum size of a file of measurements [bytes]: a thousand responses of ten thousand lines.
pub const MAX_BYTES: usize = 256 << 20;

/// Standard deviation of each coordinate of a measured position that has none [m].
pub const POSITION_STD_M: f64 = 1e-3;
/// Standard deviation of a measured rotation about each axis that has none [degrees].
pub const ROTATION_STD_DEG: f64 = 0.1;
/// Standard deviation of measured lengths that have none [m].
pub const LENGTH_STD_M: f64 = 1e-3;
/// Standard deviation of measured tensions that have none, relative to the maximum tension.
pub const TENSION_STD: f64 = 0.01;

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

/// Contents of a file of measurements.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Measured {
    /// Responses.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub responses: Vec<MeasuredResponse>,
    /// Natural frequencies.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub frequencies: Vec<MeasuredFrequency>,
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
/// use funicular_study::measurements::{FileOptions, read};
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
            })
        }
        _ => bail!("{path}: measurements are read from .uff and .unv (Universal File) and from .csv"),
    }
}

/// Measured frequency response: output per input at each frequency, e^{+iωt}.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasuredResponse {
    /// Name in messages, tables and figures.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Input signal, as `fz`.
    pub input: String,
    /// Point where the force acts, platform frame [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub input_point_m: Option<[f64; 3]>,
    /// Output signal, as `ay`.
    pub output: String,
    /// Point whose motion is measured, platform frame [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub output_point_m: Option<[f64; 3]>,
    /// Frequencies [Hz].
    pub frequency_hz: Vec<f64>,
    /// Real parts, in the SI unit of the output per input.
    pub real: Vec<f64>,
    /// Imaginary parts.
    pub imag: Vec<f64>,
    /// Standard deviations of the magnitude of the complex noise, √(E|n|²); each part has its half of the variance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub std: Option<Vec<f64>>,
}

/// Measured natural frequency.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasuredFrequency {
    /// Natural frequency [Hz].
    pub frequency_hz: f64,
    /// Damping ratio.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping_ratio: Option<f64>,
    /// Standard deviation of the frequency [Hz].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub std_hz: Option<f64>,
    /// Weight: the variance is divided by it; 0 leaves the frequency out of the fit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weight: Option<f64>,
    /// Number of the mode in the ascending list of the model, from 1, or any name. A frequency without a number is
    /// assigned to the nearest modes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
}

impl MeasuredFrequency {
    /// Number of the mode in the ascending list, from 1, if the label is one.
    pub fn number(&self) -> Option<usize> {
        self.label.as_ref()?.trim().parse().ok().filter(|number| *number > 0)
    }
}
