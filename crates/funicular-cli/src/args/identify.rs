//! Options of `identify`.

use super::values::{self, Lengths, PoseNumbers, Tensions};
use super::{LinearisedArgs, OutputArgs, PointArgs, RobotArgs};
use clap::Args;
use funicular_study::measurements::{NodePoint, ResponseName};
use funicular_study::request::{
    DEFAULT_DAMPING_NOISE, DEFAULT_FREQUENCY_NOISE, DEFAULT_RESPONSE_NOISE, DEFAULT_STARTS, FitValue,
};
use funicular_study::set_values;
use funicular_study::signals::{Input, Output};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct IdentifyArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Value of the robot file to identify, with optional bounds, as in platform.mass_kg=10:30; * stands for any key, as in
    /// 'materials.*.axial_stiffness_n', and a path to a table or vector for all numbers of it that the file gives
    /// (repeatable)
    #[arg(long, value_name = "PATH[=MIN:MAX]", value_parser = fit, required = true)]
    pub(crate) fit: Vec<FitValue>,

    /// Value known beforehand with its standard deviation, as in platform.mass_kg=20±2 (or +-); without a value, as in
    /// platform.mass_kg=±2, it is the value of the robot file (repeatable)
    #[arg(long, value_name = "PATH=VALUE±DEVIATION", value_parser = prior)]
    pub(crate) prior: Vec<FitValue>,

    /// Maximum number of starts of the search. The first start has the values of the file, the others are spread by the
    /// priors; the search ends at the first start that fits
    #[arg(long, value_name = "N", default_value_t = DEFAULT_STARTS)]
    pub(crate) starts: usize,

    /// Fitted values with a profile, by their paths, separated by commas: each value is held at steps and all others are
    /// fitted again, until χ² has risen by 3.84; * stands for any key, and a path to a table or vector for all numbers in
    /// it
    #[arg(long, value_name = "PATHS", value_delimiter = ',')]
    pub(crate) profile: Vec<String>,

    /// File with measured responses or natural frequencies: .uff or .unv (Universal File), or .csv (repeatable)
    #[arg(long, value_name = "FILE", help_heading = "Measurements")]
    pub(crate) measured: Vec<PathBuf>,

    /// Point of the platform at a node of a Universal File [m], as in 2=0.1,0.08,0.02 (repeatable) [default: the nodes of
    /// the file]
    #[arg(long, value_name = "NODE=X,Y,Z", value_parser = node, help_heading = "Measurements")]
    pub(crate) node: Vec<NodePoint>,

    /// Signals of a response of a CSV file, with its name in the header, as in a1=az/fz for a1_re and a1_im, or of a
    /// function of a Universal File that does not tell them, as in "line 7=az/fz" or "az at node 1=az/fz" (repeatable)
    #[arg(long, value_name = "NAME=OUTPUT/INPUT", value_parser = response, help_heading = "Measurements")]
    pub(crate) response: Vec<ResponseName>,

    #[command(flatten)]
    pub(crate) points: PointArgs,

    /// File with measurements in several states (JSON): a list of objects as in `experiments` of a request
    #[arg(long, value_name = "FILE.json", help_heading = "Measurements")]
    pub(crate) experiments: Option<PathBuf>,

    /// Measured pose at held lengths [m, degrees]
    #[arg(long, value_name = "X,Y,Z,ROLL,PITCH,YAW", value_parser = values::pose, allow_hyphen_values = true, help_heading = "Measurements")]
    pub(crate) measured_pose: Option<PoseNumbers>,

    /// Measured tensions at the platform [N], one per cable
    #[arg(long, value_name = "T1,T2,…", value_parser = values::tensions, help_heading = "Measurements")]
    pub(crate) measured_tensions_n: Option<Tensions>,

    /// Measured unstrained lengths at a held pose [m], one per cable
    #[arg(long, value_name = "L1,L2,…", value_parser = values::lengths, help_heading = "Measurements")]
    pub(crate) measured_lengths_m: Option<Lengths>,

    /// Standard deviation of each coordinate of the measured position [m] [default: 0.001]
    #[arg(long, value_name = "M", value_parser = values::positive, help_heading = "Measurements")]
    pub(crate) position_std_m: Option<f64>,

    /// Standard deviation of the measured rotation about each axis [degrees] [default: 0.1]
    #[arg(long, value_name = "DEG", value_parser = values::positive, help_heading = "Measurements")]
    pub(crate) rotation_std_deg: Option<f64>,

    /// Standard deviation of the measured tensions [N] [default: 1 % of the maximum]
    #[arg(long, value_name = "N", value_parser = values::positive, help_heading = "Measurements")]
    pub(crate) tension_std_n: Option<f64>,

    /// Standard deviation of the measured lengths [m] [default: 0.001]
    #[arg(long, value_name = "M", value_parser = values::positive, help_heading = "Measurements")]
    pub(crate) length_std_m: Option<f64>,

    /// First frequency of the responses that counts [Hz] [default: all]
    #[arg(long, value_name = "HZ", value_parser = values::not_negative, help_heading = "Measurements")]
    pub(crate) from_hz: Option<f64>,

    /// Last frequency of the responses that counts [Hz] [default: all]
    #[arg(long, value_name = "HZ", value_parser = values::positive, help_heading = "Measurements")]
    pub(crate) to_hz: Option<f64>,

    /// Standard deviation of responses without deviations, relative to their magnitude; 0.3 % of the median magnitude is
    /// added
    #[arg(long, value_name = "FRACTION", value_parser = values::positive, default_value_t = DEFAULT_RESPONSE_NOISE, help_heading = "Measurements")]
    pub(crate) response_noise: f64,

    /// Relative standard deviation of natural frequencies without deviations
    #[arg(long, value_name = "FRACTION", value_parser = values::positive, default_value_t = DEFAULT_FREQUENCY_NOISE, help_heading = "Measurements")]
    pub(crate) frequency_noise: f64,

    /// Relative standard deviation of damping ratios
    #[arg(long, value_name = "FRACTION", value_parser = values::positive, default_value_t = DEFAULT_DAMPING_NOISE, help_heading = "Measurements")]
    pub(crate) damping_noise: f64,

    #[command(flatten)]
    pub(crate) linearised: LinearisedArgs,

    /// Natural frequencies with cables that are straight, without mass and rigid in length; with --static-model ideal
    #[arg(long, help_heading = "Model")]
    pub(crate) rigid_cables: bool,

    #[command(flatten)]
    pub(crate) sink: OutputArgs,

    /// Write the robot file with the identified values to FILE; -o FILE.toml does the same
    #[arg(long, value_name = "FILE.toml", help_heading = "Output")]
    pub(crate) fitted: Option<PathBuf>,

    /// Write a page with measured and fitted curves to FILE; -o FILE.html does the same
    #[arg(long, value_name = "FILE.html", help_heading = "Output")]
    pub(crate) page: Option<PathBuf>,
}

/// Reads `PATH` or `PATH=MIN:MAX`; each bound may be left out.
fn fit(text: &str) -> Result<FitValue, String> {
    let Some((path, bounds)) = set_values::split(text) else {
        return Ok(FitValue { path: text.trim().to_owned(), ..FitValue::default() });
    };
    let (low, high) = bounds.split_once(':').ok_or("the bounds are two numbers, as in platform.mass_kg=10:30")?;
    let bound = |text: &str| if text.trim().is_empty() { Ok(None) } else { values::finite(text).map(Some) };
    Ok(FitValue { path: path.trim().to_owned(), minimum: bound(low)?, maximum: bound(high)?, ..FitValue::default() })
}

/// Reads `PATH=VALUE±DEVIATION` or `PATH=±DEVIATION`.
fn prior(text: &str) -> Result<FitValue, String> {
    let wrong = "a prior is a value and its deviation, as in platform.mass_kg=20±2";
    let (path, value) = set_values::split(text).ok_or(wrong)?;
    let (value, deviation) = value.split_once('±').or_else(|| value.split_once("+-")).ok_or(wrong)?;
    let prior = if value.trim().is_empty() { None } else { Some(values::finite(value)?) };
    Ok(FitValue {
        path: path.trim().to_owned(),
        prior,
        prior_std: Some(values::positive(deviation)?),
        ..FitValue::default()
    })
}

/// Reads `NODE=X,Y,Z`.
fn node(text: &str) -> Result<NodePoint, String> {
    let (node, point) = text.split_once('=').ok_or("a node and its point are written as in 2=0.1,0.08,0.02")?;
    let node = node.trim().parse().map_err(|_| format!("`{node}` is not the number of a node"))?;
    Ok(NodePoint { node, point_m: values::point(point)?.into() })
}

/// Reads `NAME=OUTPUT/INPUT`.
fn response(text: &str) -> Result<ResponseName, String> {
    let wrong = "a response is written as in a1=az/fz";
    let (name, signals) = text.split_once('=').ok_or(wrong)?;
    let (output, input) = signals.rsplit_once('/').ok_or(wrong)?;
    let input = Input::parse(input).map_err(|error| format!("{input}: {error}"))?;
    let output = Output::parse(output).map_err(|error| format!("{output}: {error}"))?;
    Ok(ResponseName { name: name.trim().to_owned(), input: input.name, output: output.name })
}
