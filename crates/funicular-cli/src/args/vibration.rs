//! Arguments of the commands about vibration.

use super::groups::{
    FigureArgs, LinearisedArgs, OutputArgs, PointArgs, RangeArgs, RobotArgs, ShareArgs, StateArgs, TensionArgs,
    TermArgs,
};
use super::names::{CableModelName, ModelFormName, WinchModeName};
use super::values::{self};
use clap::Args;
use funicular::compare::TOLERANCE;
use funicular_study::request::{DEFAULT_INPUT, DEFAULT_OUTPUT};
use funicular_study::signals::{Input, Output};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct ModesArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Upper limit of the frequencies [Hz] [default: slightly above the 20 lowest; with rigid cables above all]
    #[arg(long, value_name = "HZ", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) below_hz: Option<f64>,

    /// Input of a response (see `frf`): also show the contribution of each mode to this response; needs --output
    #[arg(long, value_name = "INPUT", value_parser = Input::parse, requires = "output")]
    pub(crate) input: Option<Input>,

    /// Output of that response; needs --input
    #[arg(long, value_name = "OUTPUT", value_parser = Output::parse, requires = "input")]
    pub(crate) output: Option<Output>,
    #[command(flatten)]
    pub(crate) points: PointArgs,

    /// Number of points along every cable whose displacements in each mode are listed, ends included; only in JSON
    #[arg(long, value_name = "N", value_parser = values::stations)]
    pub(crate) stations: Option<usize>,

    #[command(flatten)]
    pub(crate) share: ShareArgs,

    #[command(flatten)]
    pub(crate) linearised: LinearisedArgs,

    /// Modes with cables that are straight, without mass and rigid in length: how a platform swings on fewer cables
    /// than it has degrees of freedom; with --static-model ideal
    #[arg(long, help_heading = "Model")]
    pub(crate) rigid_cables: bool,

    #[command(flatten)]
    pub(crate) sink: OutputArgs,
    #[command(flatten)]
    pub(crate) figure: FigureArgs,

    /// Draw the shape of mode N of the list in the figure [default: the spectrum]
    #[arg(long, value_name = "N", allow_hyphen_values = true, help_heading = "Figure")]
    pub(crate) figure_mode: Option<usize>,
}

#[derive(Debug, Args)]
pub(crate) struct FrfArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// First frequency [Hz] [default: 0; with equal ratios a thousandth of the last one]
    #[arg(long, value_name = "HZ", value_parser = values::not_negative, allow_hyphen_values = true)]
    pub(crate) from_hz: Option<f64>,

    /// Last frequency [Hz] [default: above the 20 lowest natural frequencies and the first mode of the platform]
    #[arg(long, value_name = "HZ", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) to_hz: Option<f64>,

    /// Number of frequencies, 2 to 1000000; with --adaptive the number from which it starts [default: 200, and
    /// others are added]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=1_000_000),
        allow_hyphen_values = true)]
    pub(crate) points: Option<u64>,

    /// Equal ratios between frequencies instead of equal steps
    #[arg(long)]
    pub(crate) log: bool,

    /// Add frequencies until every peak has its height (to 0.1 %) and straight lines over the logarithm of the
    /// magnitude are accurate to 1 %
    #[arg(long)]
    pub(crate) adaptive: bool,

    /// Input: force fx, fy, fz, moment mx, my, mz, or f:ux,uy,uz, m:ux,uy,uz along a direction, world axes; a force on
    /// a cable, as in cable:3@0.5:fz; the commanded length of a cable, length:3, a force of its motor or on its drum,
    /// motor:3, drum:3; a motion of the base, base-x to base-rz, or of an anchor, anchor:3:x (repeatable)
    #[arg(long, value_name = "INPUT", value_parser = Input::parse, default_value = DEFAULT_INPUT)]
    pub(crate) input: Vec<Input>,

    /// Output: displacement x, y, z, rotation rx, ry, rz, velocity vx … vrz, acceleration ax … arz, or x:ux,uy,uz, v:…,
    /// a:… along a direction, world axes; the motion of a point on a cable (name, fraction of its length from the
    /// platform), as in cable:3@0.5:az; the motion of a drum or motor, drum:3, motor:3, or the tension at the platform
    /// or at the drum, tension:3, drum-tension:3 (repeatable)
    #[arg(long, value_name = "OUTPUT", value_parser = Output::parse, default_value = DEFAULT_OUTPUT)]
    pub(crate) output: Vec<Output>,
    #[command(flatten)]
    pub(crate) signal_points: PointArgs,

    /// Minimum height of a peak above the valleys beside it [dB]
    #[arg(long, value_name = "DB", value_parser = values::not_negative, allow_hyphen_values = true, default_value = "1")]
    pub(crate) prominence_db: f64,

    #[command(flatten)]
    pub(crate) linearised: LinearisedArgs,
    #[command(flatten)]
    pub(crate) sink: OutputArgs,
    #[command(flatten)]
    pub(crate) figure: FigureArgs,
}

#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Upper limit of the frequencies [Hz]
    #[arg(long, value_name = "HZ", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) below_hz: f64,

    /// Compare the modes of the platform alone
    #[arg(long)]
    pub(crate) platform: bool,

    #[command(flatten)]
    pub(crate) share: ShareArgs,

    /// Maximum relative difference of frequency for a model that is good enough
    #[arg(long, value_name = "FRACTION", value_parser = values::not_negative, allow_hyphen_values = true, default_value_t = TOLERANCE)]
    pub(crate) tolerance: f64,

    #[command(flatten)]
    pub(crate) state: StateArgs,
    #[command(flatten)]
    pub(crate) tensions: TensionArgs,
    #[command(flatten)]
    pub(crate) terms: TermArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
    #[command(flatten)]
    pub(crate) figure: FigureArgs,
}

#[derive(Debug, Args)]
pub(crate) struct CableArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Name of the cable in the robot file
    #[arg(long, value_name = "NAME", allow_hyphen_values = true)]
    pub(crate) name: String,

    #[command(flatten)]
    pub(crate) range: RangeArgs,
    #[command(flatten)]
    pub(crate) state: StateArgs,
    #[command(flatten)]
    pub(crate) tensions: TensionArgs,

    /// Cable model: how the cable responds to motion of its platform end [default: catenary-dynamic; shallow-dynamic
    /// for static models other than catenary]
    #[arg(long, value_name = "MODEL", value_enum)]
    pub(crate) cable_model: Option<CableModelName>,

    /// Leave out the out-of-plane stiffness of the cable, as in Yuan et al. 2014
    #[arg(long)]
    pub(crate) in_plane_only: bool,

    /// Winch in vibration, for a cable that runs to a winch
    #[arg(long, value_name = "MODE", value_enum, default_value_t)]
    pub(crate) winches: WinchModeName,

    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

#[derive(Debug, Args)]
pub(crate) struct ReduceArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Highest frequency for which the model is valid [Hz]
    #[arg(long, value_name = "HZ", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) below_hz: f64,

    /// Input signal, see `frf` (repeatable) [default: all forces and moments on the platform]
    #[arg(long, value_name = "INPUT", value_parser = Input::parse)]
    pub(crate) input: Vec<Input>,

    /// Output signal, see `frf` (repeatable) [default: all displacements and rotations of the platform]
    #[arg(long, value_name = "OUTPUT", value_parser = Output::parse)]
    pub(crate) output: Vec<Output>,
    #[command(flatten)]
    pub(crate) points: PointArgs,

    /// Form of the model
    #[arg(long, value_name = "FORM", value_enum, default_value_t)]
    pub(crate) form: ModelFormName,

    /// Maximum error of each response, relative to its peak below the limit; the state space has as few states as it
    /// allows [default: 0.01]. With the second-order form: maximum relative error due to omitted modes [default: 0.001]
    #[arg(long, value_name = "FRACTION", value_parser = values::not_negative, allow_hyphen_values = true)]
    pub(crate) tolerance: Option<f64>,

    /// Maximum number of states, instead of a tolerance
    #[arg(long, value_name = "N")]
    pub(crate) order: Option<usize>,

    /// Frequency at which viscous damping reproduces constant damping ratios [Hz] [default: every natural frequency]
    #[arg(long, value_name = "HZ", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) damping_at_hz: Option<f64>,

    /// Write the matrices to an .npz or .mat file, or as CSV files to a new folder
    #[arg(long, value_name = "FILE|FOLDER")]
    pub(crate) matrices: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) linearised: LinearisedArgs,
    #[command(flatten)]
    pub(crate) sink: OutputArgs,
}
