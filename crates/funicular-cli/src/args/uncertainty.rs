//! Arguments of `uncertainty`.

use super::groups::{LinearisedArgs, OutputArgs, PointArgs, RobotArgs};
use super::names::{HoldName, UncertaintyMethodName};
use super::values;
use clap::Args;
use funicular_study::request::DEFAULT_SAMPLES;
use funicular_study::signals::{Input, Output};
use std::num::NonZeroUsize;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct UncertaintyArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Standard deviations PATH=VALUE or PATH=PERCENT% of normally distributed numbers, separated by commas. `parameters`
    /// lists the paths; * stands for any key, and a path to a table or vector for all numbers in it. Each entry is a group
    /// with its own share
    #[arg(long, value_name = "DEVIATIONS", value_delimiter = ',')]
    pub(crate) deviations: Vec<String>,

    /// Tolerances PATH=VALUE or PATH=PERCENT% of numbers with a uniform distribution within ± their tolerance, separated by
    /// commas
    #[arg(long, value_name = "TOLERANCES", value_delimiter = ',')]
    pub(crate) tolerances: Vec<String>,

    /// Results: pose, lengths, tensions, stiffness-min, frequencies, damping, response; separated by commas
    #[arg(long, value_name = "RESULTS", value_delimiter = ',', default_value = "pose,tensions")]
    pub(crate) of: Vec<String>,

    /// Quantity that is held while the numbers deviate; with the pose held, the tensions parallel to the chords of more
    /// cables than degrees of freedom change least, or follow their rule
    #[arg(long, value_name = "WHAT", value_enum, default_value_t)]
    pub(crate) hold: HoldName,

    /// Upper limit of the frequencies [Hz]; for frequencies and damping
    #[arg(long, value_name = "HZ", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) below_hz: Option<f64>,

    /// Frequencies of the response [Hz], separated by commas
    #[arg(long, value_name = "HZ", value_delimiter = ',', value_parser = values::not_negative, allow_hyphen_values = true)]
    pub(crate) at_hz: Vec<f64>,

    /// Input of the response (see `frf`)
    #[arg(long, value_name = "INPUT", value_parser = Input::parse)]
    pub(crate) input: Option<Input>,

    /// Output of the response (see `frf`); results are its magnitudes in decibels and its phases in degrees
    #[arg(long, value_name = "OUTPUT", value_parser = Output::parse)]
    pub(crate) output: Option<Output>,
    #[command(flatten)]
    pub(crate) points: PointArgs,

    /// List of poses in a CSV file: columns x_m, y_m, z_m and optionally roll_deg, pitch_deg, yaw_deg
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["pose", "lengths_m"])]
    pub(crate) poses: Option<PathBuf>,

    /// Method for the deviations
    #[arg(long, value_name = "METHOD", value_enum, default_value_t)]
    pub(crate) method: UncertaintyMethodName,

    /// Number of sampled robots per pose that needs sampling, 10 to 1000000; with several groups, each group needs as many
    /// again
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value_t = DEFAULT_SAMPLES)]
    pub(crate) samples: usize,

    /// Seed of the sample
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u32,

    #[command(flatten)]
    pub(crate) linearised: LinearisedArgs,
    #[command(flatten)]
    pub(crate) sink: OutputArgs,

    /// Write the page to FILE.html, completely or not at all
    #[arg(long, value_name = "FILE.html", help_heading = "Output")]
    pub(crate) page: Option<PathBuf>,

    /// Write the sampled robots to FILE.parquet or FILE.csv when all are computed; until then they are kept in FILE.partial
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub(crate) samples_file: Option<PathBuf>,

    /// Continue with the robots in FILE.partial of the same request; start if there are none
    #[arg(long, requires = "samples_file", conflicts_with = "discard", help_heading = "Output")]
    pub(crate) resume: bool,

    /// Discard the robots in FILE.partial and start again
    #[arg(long, requires = "samples_file", help_heading = "Output")]
    pub(crate) discard: bool,

    /// Number of threads [default: one per core]; the results do not depend on it
    #[arg(long, value_name = "N", value_parser = values::threads, allow_hyphen_values = true, help_heading = "Output")]
    pub(crate) threads: Option<NonZeroUsize>,
}
