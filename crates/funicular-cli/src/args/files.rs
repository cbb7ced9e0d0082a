//! Options that only the program has: files that a command reads and writes, and figures.

use super::values;
use clap::{Args, ValueEnum};
use funicular_formats::measurements::{NodePoint, ResponseName};
use funicular_study::request::{Change, FitValue};
use funicular_study::table::Part;
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// Robot file and its changes.
#[derive(Debug, Args)]
pub(crate) struct RobotArgs {
    /// Robot file (TOML), or - for standard input
    #[arg(value_name = "ROBOT")]
    pub(crate) robot: PathBuf,
    #[command(flatten)]
    pub(crate) changes: ChangeArgs,
}

/// Changes of the robot file.
#[derive(Debug, Args)]
pub(crate) struct ChangeArgs {
    /// Change a value of the robot file, as in platform.mass_kg=20, cables.3.unstrained_length_m=6.7 (cables by name)
    /// or loads.force_n.2=-50 (one number of a vector, by x, y, z or 0, 1, 2); repeatable
    #[arg(long, value_name = "PATH=VALUE", value_parser = funicular_study::set_values::change)]
    pub(crate) set: Vec<Change>,
}

/// Robot file and its changes, with a robot that is built into the program if no file is given.
#[derive(Debug, Args)]
pub(crate) struct OptionalRobotArgs {
    /// Robot file (TOML), or - for standard input [default: yuan2014-4mm.toml, which is built into the program]
    #[arg(value_name = "ROBOT")]
    pub(crate) robot: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) changes: ChangeArgs,
}

/// Format of a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// Rounded tables for reading
    Text,
    /// One object with every digit
    Json,
    /// One table with a header and every digit
    Csv,
    /// The table of the result, rounded, for LaTeX with booktabs and siunitx
    Latex,
    /// The table of the result, rounded, for Markdown
    Markdown,
}

/// Format and destination of the result.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub(crate) struct OutputArgs {
    /// Format of the result [default: from the ending of FILE, else text]; FILE.parquet holds the rows of
    /// FILE.csv, FILE.svg and FILE.pdf a figure, and FILE.uff of `frf` and `modes` is a Universal File
    #[arg(long, value_name = "FORMAT", value_enum)]
    pub(crate) format: Option<Format>,

    /// Write the result to FILE, completely or not at all, instead of standard output (-)
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output_file: Option<PathBuf>,

    /// Print no result on standard output
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// Size of a figure.
#[derive(Debug, Clone, Copy, Default, Args)]
#[command(next_help_heading = "Figure")]
pub(crate) struct FigureArgs {
    /// Width of the figure in FILE.svg or FILE.pdf [mm], or the column of a journal: ieee-single (88.9), ieee-double
    /// (181), elsevier-single (90), elsevier-double (190), springer-single (84), springer-double (174) [default:
    /// ieee-single]
    #[arg(long, value_name = "MM|COLUMN", value_parser = funicular_pages::figures::width_mm)]
    #[arg(allow_hyphen_values = true)]
    pub(crate) figure_width_mm: Option<f64>,

    /// Size of the texts in the figure [pt] [default: 8]
    #[arg(long, value_name = "PT", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) font_size_pt: Option<f64>,
}

/// Mode of a figure.
#[derive(Debug, Args)]
pub(crate) struct ModeFigureArgs {
    /// Draw the shape of mode N of the list of `modes` in the figure [default: the spectrum]
    #[arg(long, value_name = "N", allow_hyphen_values = true, help_heading = "Figure")]
    pub(crate) figure_mode: Option<usize>,
}

/// Quantity and slice in the figure of a map or sweep.
#[derive(Debug, Args)]
#[command(next_help_heading = "Figure")]
pub(crate) struct SweepFigureArgs {
    /// Quantity of the figure, by its name for `map` or by the name of its column; needed if there are several
    #[arg(long, value_name = "Q")]
    pub(crate) quantity: Option<String>,

    /// Axes of the slice in the figure, as in x,z [default: the two axes with most values]
    #[arg(long, value_name = "AXIS,AXIS", value_parser = values::plane)]
    pub(crate) plane: Option<values::Plane>,

    /// Value of another axis at which the slice lies (repeatable) [default: the middle of the grid]
    #[arg(long, value_name = "AXIS=VALUE", value_parser = values::place)]
    pub(crate) at: Vec<(String, f64)>,
}

/// Work of an earlier run.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub(crate) struct StoredArgs {
    /// Continue with what is in FILE.partial of the same request; start if there is nothing
    #[arg(long, conflicts_with = "discard")]
    pub(crate) resume: bool,

    /// Discard what is in FILE.partial and start again
    #[arg(long)]
    pub(crate) discard: bool,
}

/// File of sampled robots.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub(crate) struct SampleArgs {
    /// Write the sampled robots to FILE.parquet or FILE.csv when all are computed; until then they are kept in
    /// FILE.partial
    #[arg(long, value_name = "FILE")]
    pub(crate) samples_file: Option<PathBuf>,
}

/// Number of threads.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub(crate) struct ThreadArgs {
    /// Number of threads [default: one per core]; the results do not depend on it
    #[arg(long, value_name = "N", value_parser = values::threads, allow_hyphen_values = true)]
    pub(crate) threads: Option<NonZeroUsize>,
}

/// Form of a reduced model for other programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum ReducedTo {
    /// Functional Mock-up Unit 2.0.
    Fmu,
}

/// Model for other programs.
#[derive(Debug, Args)]
pub(crate) struct ReduceArgs {
    /// Write the model for other programs to the FILE of -o: fmu, a Functional Mock-up Unit 2.0, as --matrices FILE.fmu
    #[arg(long, value_name = "PROGRAM", value_enum, requires = "output_file")]
    #[arg(conflicts_with_all = ["matrices", "format"])]
    pub(crate) to: Option<ReducedTo>,
}

/// Measurements in files, and values that are known beforehand.
#[derive(Debug, Args)]
pub(crate) struct IdentifyArgs {
    /// Value known beforehand with its standard deviation, as in platform.mass_kg=20±2 (or +-); without a value, as in
    /// platform.mass_kg=±2, it is the value of the robot file (repeatable)
    #[arg(long, value_name = "PATH=VALUE±DEVIATION", value_parser = values::prior)]
    pub(crate) prior: Vec<FitValue>,

    /// File with measured responses or natural frequencies: .uff or .unv (Universal File), or .csv (repeatable)
    #[arg(long, value_name = "FILE", help_heading = "Measurements")]
    pub(crate) measured: Vec<PathBuf>,

    /// Point of the platform at a node of a Universal File [m], as in 2=0.1,0.08,0.02 (repeatable) [default: the nodes
    /// of the file]
    #[arg(long, value_name = "NODE=X,Y,Z", value_parser = values::node, help_heading = "Measurements")]
    pub(crate) node: Vec<NodePoint>,

    /// Signals of a response of a CSV file, with its name in the header, as in a1=az/fz for a1_re and a1_im, or of a
    /// function of a Universal File that does not tell them, as in "line 7=az/fz" or "az at node 1=az/fz" (repeatable)
    #[arg(long, value_name = "NAME=OUTPUT/INPUT", value_parser = values::response, help_heading = "Measurements")]
    pub(crate) response: Vec<ResponseName>,

    /// File with measurements in several states (JSON): a list of objects as in `experiments` of a request
    #[arg(long, value_name = "FILE.json", help_heading = "Measurements")]
    pub(crate) experiments: Option<PathBuf>,
}

/// Computation of the rows, and their destination.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub(crate) struct RunArgs {
    /// Format of standard output: a summary as text or json, or, without -o, all rows as csv [default: text]
    #[arg(long, value_name = "FORMAT", value_enum)]
    pub(crate) format: Option<Format>,

    /// Write the rows to FILE.parquet, .csv or .vti (ParaView) when all are computed; until then they are kept in
    /// FILE.partial
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output_file: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) stored: StoredArgs,

    /// Compute only part K of N parts, each with its own FILE.parquet, for `funicular merge`
    #[arg(long, value_name = "K/N", requires = "output_file")]
    pub(crate) part: Option<Part>,

    #[command(flatten)]
    pub(crate) threads: ThreadArgs,
}

/// File of all rows.
#[derive(Debug, Args)]
pub(crate) struct MergeArgs {
    /// Write all rows to FILE.parquet, .csv or .vti, completely or not at all
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub(crate) output_file: PathBuf,
}

/// Request to run.
#[derive(Debug, Args)]
pub(crate) struct RequestArgs {
    /// Request (JSON), or - for standard input
    #[arg(value_name = "FILE.json")]
    pub(crate) file: PathBuf,
    #[command(flatten)]
    pub(crate) run: RunArgs,

    /// Print no result on standard output
    #[arg(long, help_heading = "Output")]
    pub(crate) quiet: bool,
    #[command(flatten)]
    pub(crate) samples: SampleArgs,
    #[command(flatten)]
    pub(crate) figure: FigureArgs,
    #[command(flatten)]
    pub(crate) mode: ModeFigureArgs,
    #[command(flatten)]
    pub(crate) slice: SweepFigureArgs,
}
