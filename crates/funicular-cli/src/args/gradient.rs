//! Arguments of `gradient`.

use super::groups::{LinearisedArgs, OutputArgs, PointArgs, RobotArgs};
use super::names::{HoldName, PerName};
use super::values::{self};
use clap::Args;
use funicular_study::signals::{Input, Output};

#[derive(Debug, Args)]
pub(crate) struct GradientArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Results: pose, lengths, tensions, stiffness-min, frequencies, damping, response; separated by commas
    #[arg(long, value_name = "RESULTS", value_delimiter = ',', default_value = "frequencies")]
    pub(crate) of: Vec<String>,

    /// Numbers of the robot file, by paths that `parameters` lists, separated by commas; * stands for any key, and a path to
    /// a table or vector for all numbers in it [default: all]
    #[arg(long, value_name = "PATHS", value_delimiter = ',')]
    pub(crate) by: Vec<String>,

    /// Quantity that is held while a number changes; with the pose held, the tensions parallel to the chords of more
    /// cables than degrees of freedom change least, or follow their rule
    #[arg(long, value_name = "WHAT", value_enum, default_value_t)]
    pub(crate) hold: HoldName,

    /// Unit of the derivatives: per unit, percent or tolerance of each number
    #[arg(long, value_name = "STEP", value_enum, default_value_t)]
    pub(crate) per: PerName,

    /// Tolerances PATH=VALUE or PATH=PERCENT%, separated by commas [default: usual ones, which docs/gradients.md lists]
    #[arg(long, value_name = "TOLERANCES", value_delimiter = ',')]
    pub(crate) tolerances: Vec<String>,

    /// Upper limit of the frequencies [Hz]; for frequencies and damping
    #[arg(long, value_name = "HZ", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) below_hz: Option<f64>,

    /// Frequency of the response [Hz]
    #[arg(long, value_name = "HZ", value_parser = values::not_negative, allow_hyphen_values = true)]
    pub(crate) at_hz: Option<f64>,

    /// Input of the response, on the platform (see `frf`)
    #[arg(long, value_name = "INPUT", value_parser = Input::parse)]
    pub(crate) input: Option<Input>,

    /// Output of the response, on the platform (see `frf`)
    #[arg(long, value_name = "OUTPUT", value_parser = Output::parse)]
    pub(crate) output: Option<Output>,
    #[command(flatten)]
    pub(crate) points: PointArgs,

    #[command(flatten)]
    pub(crate) linearised: LinearisedArgs,
    #[command(flatten)]
    pub(crate) sink: OutputArgs,
}
