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
}

/// Size of a figure.
#[derive(Debug, Clone, Copy, Default, Args)]
#[command(next_help_heading = "Figure")]
pub(crate) struct FigureArgs {
    /// Width of the figure in FILE.svg or FILE.pdf [mm], or the column of a journal: ieee-single (88.9), ieee-double
    /// (181), elsevier-single (90), elsevier-double (190), springer-single (84), springer-double (174) [default:
    /// ieee-single]
    #[arg(long, value_name = "MM|COLUMN", value_parser = funicular_pages::figures::width_mm, allow_hyphen_values = true)]
    pub(crate) figure_width_mm: Option<f64>,

    /// Size of the texts in the figure [pt] [default: 8]
    #[arg(long, value_name = "PT", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) font_size_pt: Option<f64>,
}

/// Result that is printed, or drawn as a figure.
#[derive(Debug, Args)]
pub(crate) struct DrawArgs {
    #[command(flatten)]
    pub(crate) output: OutputArgs,
    #[command(flatten)]
    pub(crate) figure: FigureArgs,
}

/// Modes that are printed, or drawn as a spectrum or as the shape of one mode.
#[derive(Debug, Args)]
pub(crate) struct DrawModesArgs {
    #[command(flatten)]
    pub(crate) drawn: DrawArgs,

    /// Draw the shape of mode N of the list in the figure [default: the spectrum]
    #[arg(long, value_name = "N", allow_hyphen_values = true, help_heading = "Figure")]
    pub(crate) figure_mode: Option<usize>,
}

/// Trajectory of a decay, which is printed or drawn, and the file of the commanded lengths.
#[derive(Debug, Args)]
pub(crate) struct SettleArgs {
    /// Trajectory in a CSV file that the lengths command, from rest to rest: columns t_s, and either x_m, y_m, z_m and
    /// optionally roll_deg, pitch_deg, yaw_deg, or unstrained_length_NAME_m of every cable, as --lengths writes them;
    /// between the rows the lengths change in straight lines [default of the state: the last row]
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) trajectory: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) drawn: DrawArgs,

    /// Write the commanded lengths to FILE.csv: t_s, and unstrained_length_NAME_m of every cable [m]
    #[arg(long, value_name = "FILE.csv", requires = "sample_time_s", help_heading = "Output")]
    pub(crate) lengths: Option<PathBuf>,
}

/// Path of a trajectory, and the files of its result.
#[derive(Debug, Args)]
pub(crate) struct TrajectoryArgs {
    /// Path in a CSV file: columns t_s, x_m, y_m, z_m and, where the platform turns, roll_deg, pitch_deg, yaw_deg; a
    /// spline of the fifth degree passes the rows
    #[arg(long, value_name = "FILE.csv", help_heading = "Path", conflicts_with_all = ["pose", "lengths_m"])]
    pub(crate) path: Option<PathBuf>,

    /// Poses on the way to --move-to in a CSV file: columns x_m, y_m, z_m and optionally roll_deg, pitch_deg, yaw_deg
    #[arg(long, value_name = "FILE.csv", help_heading = "Path")]
    pub(crate) via: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) sink: OutputArgs,

    /// Write the lengths for a controller to FILE.csv: t_s, and unstrained_length_NAME_m of every cable [m], a
    /// trajectory for `settle`
    #[arg(long, value_name = "FILE.csv", help_heading = "Output")]
    pub(crate) lengths: Option<PathBuf>,

    /// Write a page with the moving robot and its tensions, speeds and powers over time to FILE; -o FILE.html does the same
    #[arg(long, value_name = "FILE.html", help_heading = "Output")]
    pub(crate) page: Option<PathBuf>,
}

/// Scenario of a simulation, its result, page, figure and animation.
#[derive(Debug, Args)]
pub(crate) struct SimulateArgs {
    /// Events with their times in a TOML file: [[release]], [[pick]], [[lengths]], [[tension]], [[stop]], [[push]] and [[cut]];
    /// a `table` of [[lengths]] names a CSV file beside it
    #[arg(long, value_name = "FILE.toml")]
    pub(crate) scenario: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) drawn: DrawArgs,

    /// Continue after the rows in FILE.csv.partial of the same request, beside -o FILE.csv; start if there are none
    #[arg(long, requires = "output_file", conflicts_with_all = ["discard", "page", "animation"], help_heading = "Output")]
    pub(crate) resume: bool,

    /// Discard the rows in FILE.csv.partial and start again
    #[arg(long, requires = "output_file", help_heading = "Output")]
    pub(crate) discard: bool,

    /// Write the moving robot as an animated drawing to FILE.svg, which any browser shows in true time
    #[arg(long, value_name = "FILE.svg", help_heading = "Output")]
    pub(crate) animation: Option<PathBuf>,

    /// Write a page with the moving robot, pose and tensions over time and the spectrum to FILE; -o FILE.html does the same.
    /// -o FILE.svg and FILE.pdf draw pose and tensions
    #[arg(long, value_name = "FILE.html", help_heading = "Output")]
    pub(crate) page: Option<PathBuf>,
}

/// Measured spectra of gusts, and the response that is printed or drawn.
#[derive(Debug, Args)]
pub(crate) struct GustArgs {
    /// Measured spectra of the gusts in a CSV file, one-sided, in place of --turbulence: columns frequency_hz, and
    /// along_m2_s, lateral_m2_s, up_m2_s [m²/s² per Hz], straight between the rows and constant below the first; with
    /// --intensity their integrals are compared with it
    #[arg(long, value_name = "FILE.csv", help_heading = "Gusts")]
    pub(crate) spectrum: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) drawn: DrawArgs,
}

/// Form of a reduced model for other programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum ReducedTo {
    /// Functional Mock-up Unit 2.0.
    Fmu,
}

/// Model whose matrices are written to files.
#[derive(Debug, Args)]
pub(crate) struct ReduceArgs {
    /// Write the matrices to an .npz or .mat file, or as CSV files to a new folder; FILE.fmu is a unit for Simulink and
    /// Modelica
    #[arg(long, value_name = "FILE|FOLDER")]
    pub(crate) matrices: Option<PathBuf>,
    /// Write the model for other programs to the FILE of -o: fmu, a Functional Mock-up Unit 2.0, as --matrices FILE.fmu
    #[arg(long, value_name = "PROGRAM", value_enum, requires = "output_file", conflicts_with_all = ["matrices", "format"])]
    pub(crate) to: Option<ReducedTo>,
    #[command(flatten)]
    pub(crate) sink: OutputArgs,
}

/// Destination of a page.
#[derive(Debug, Args)]
pub(crate) struct PageArgs {
    /// Write the page to FILE, completely or not at all; - is standard output
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub(crate) output_file: PathBuf,
}

/// Destination of a file, by default standard output.
#[derive(Debug, Args)]
pub(crate) struct FileArgs {
    /// Write to FILE, completely or not at all; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-", help_heading = "Output")]
    pub(crate) output_file: PathBuf,
}

/// Scenario for MoorDyn, and destination of the file.
#[derive(Debug, Args)]
pub(crate) struct ExportArgs {
    /// Events for MoorDyn in a TOML file, as `simulate` reads them: [[release]] from rest, [[lengths]], [[stop]] and [[cut]] at a
    /// time; the file is then a Python script that runs MoorDyn
    #[arg(long, value_name = "FILE.toml")]
    pub(crate) scenario: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) to: FileArgs,
}

/// Table and destination of a new robot file.
#[derive(Debug, Args)]
pub(crate) struct NewArgs {
    /// Table of the cables in place of their number: name (may be left out), anchor x, y, z in the world frame,
    /// attachment x, y, z in the platform frame; a first line may name the columns: name, anchor_x, …, attachment_z
    #[arg(long, value_name = "FILE")]
    pub(crate) from_csv: Option<PathBuf>,

    /// Write the robot file to FILE, which must not exist yet; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-", help_heading = "Output")]
    pub(crate) output_file: PathBuf,
}

/// Files of another program.
#[derive(Debug, Args)]
pub(crate) struct ImportArgs {
    /// Files of one robot; their format is recognised from their content
    #[arg(value_name = "FILE", required = true)]
    pub(crate) files: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) to: FileArgs,
}

/// Files of measurements, and of what is identified from them.
#[derive(Debug, Args)]
pub(crate) struct IdentifyArgs {
    /// Value known beforehand with its standard deviation, as in platform.mass_kg=20±2 (or +-); without a value, as in
    /// platform.mass_kg=±2, it is the value of the robot file (repeatable)
    #[arg(long, value_name = "PATH=VALUE±DEVIATION", value_parser = values::prior)]
    pub(crate) prior: Vec<FitValue>,

    /// Poses of a proposal in a CSV file instead of a grid: columns x_m, y_m, z_m and optionally roll_deg, pitch_deg, yaw_deg
    #[arg(long, value_name = "FILE.csv", help_heading = "Proposal", conflicts_with = "grid")]
    pub(crate) poses: Option<PathBuf>,

    /// File with measured responses or natural frequencies: .uff or .unv (Universal File), or .csv (repeatable)
    #[arg(long, value_name = "FILE", help_heading = "Measurements")]
    pub(crate) measured: Vec<PathBuf>,

    /// Point of the platform at a node of a Universal File [m], as in 2=0.1,0.08,0.02 (repeatable) [default: the nodes of
    /// the file]
    #[arg(long, value_name = "NODE=X,Y,Z", value_parser = values::node, help_heading = "Measurements")]
    pub(crate) node: Vec<NodePoint>,

    /// Signals of a response of a CSV file, with its name in the header, as in a1=az/fz for a1_re and a1_im, or of a
    /// function of a Universal File that does not tell them, as in "line 7=az/fz" or "az at node 1=az/fz" (repeatable)
    #[arg(long, value_name = "NAME=OUTPUT/INPUT", value_parser = values::response, help_heading = "Measurements")]
    pub(crate) response: Vec<ResponseName>,

    /// File with measurements in several states (JSON): a list of objects as in `experiments` of a request
    #[arg(long, value_name = "FILE.json", help_heading = "Measurements")]
    pub(crate) experiments: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) sink: OutputArgs,

    /// Write the robot file with the identified values to FILE; -o FILE.toml does the same
    #[arg(long, value_name = "FILE.toml", help_heading = "Output")]
    pub(crate) fitted: Option<PathBuf>,

    /// Write a page with measured and fitted curves to FILE; -o FILE.html does the same
    #[arg(long, value_name = "FILE.html", help_heading = "Output")]
    pub(crate) page: Option<PathBuf>,
}

/// Poses of a design, and the files of its result.
#[derive(Debug, Args)]
pub(crate) struct DesignArgs {
    /// List of poses in a CSV file: columns x_m, y_m, z_m and optionally roll_deg, pitch_deg, yaw_deg [default: the pose of
    /// --pose or of the robot file]
    #[arg(long, value_name = "FILE.csv", conflicts_with = "pose")]
    pub(crate) poses: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) sink: OutputArgs,

    /// Write the robot file with the chosen values to FILE; -o FILE.toml does the same
    #[arg(long, value_name = "FILE.toml", help_heading = "Output")]
    pub(crate) designed: Option<PathBuf>,

    /// Write a page with the poses before and after, the moved points and the gains of more room to FILE; -o FILE.html does
    /// the same
    #[arg(long, value_name = "FILE.html", help_heading = "Output")]
    pub(crate) page: Option<PathBuf>,
}

/// Readings of a calibration, candidates of its proposal, and its robot file.
#[derive(Debug, Args)]
pub(crate) struct CalibrateArgs {
    /// Readings in a CSV file, one row per pose: columns length_NAME_m [m] or length_NAME_mm [mm] of every cable, empty where
    /// a cable was slack or not read, and optionally x_m, y_m, z_m, roll_deg, pitch_deg, yaw_deg, tension_NAME_n
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) readings: PathBuf,

    /// Candidates of a proposal in a CSV file instead of a grid: columns x_m, y_m, z_m and optionally roll_deg, pitch_deg,
    /// yaw_deg
    #[arg(long, value_name = "FILE.csv", help_heading = "Proposal", conflicts_with = "grid")]
    pub(crate) poses: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) drawn: DrawArgs,

    /// Write the robot file with the calibrated anchors and attachments to FILE; -o FILE.toml does the same
    #[arg(long, value_name = "FILE.toml", help_heading = "Output")]
    pub(crate) calibrated: Option<PathBuf>,

    /// Write a page with the anchors and their ellipses, the residuals, rows that can be clicked away and the proposed poses
    /// to FILE; -o FILE.html does the same. -o FILE.svg and FILE.pdf draw the anchors
    #[arg(long, value_name = "FILE.html", help_heading = "Output")]
    pub(crate) page: Option<PathBuf>,
}

/// Poses of an uncertainty, its page and its samples.
#[derive(Debug, Args)]
pub(crate) struct UncertaintyArgs {
    /// List of poses in a CSV file: columns x_m, y_m, z_m and optionally roll_deg, pitch_deg, yaw_deg
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["pose", "lengths_m"])]
    pub(crate) poses: Option<PathBuf>,
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

/// Computation of a workspace, and its destination.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub(crate) struct WorkspaceArgs {
    /// Compare the set with that of another robot file on the same grid: volumes of both, of what they share, and of what
    /// only one has [default with --compare-set: the same file]
    #[arg(long, value_name = "FILE.toml", help_heading = "Set")]
    pub(crate) compare: Option<PathBuf>,

    /// Change a value of the other robot, as --set does (repeatable)
    #[arg(long, value_name = "PATH=VALUE", value_parser = funicular_study::set_values::change, help_heading = "Set")]
    pub(crate) compare_set: Vec<Change>,

    #[command(flatten)]
    pub(crate) drawn: DrawArgs,

    /// Write the closed surface of the set [m] to FILE.stl, FILE.ply or FILE.vtp (ParaView); -o does the same with such a
    /// file (repeatable)
    #[arg(long, value_name = "FILE")]
    pub(crate) surface: Vec<PathBuf>,

    /// Write a page with the surface in space, the volumes and the sections to FILE; -o FILE.html does the same
    #[arg(long, value_name = "FILE.html")]
    pub(crate) page: Option<PathBuf>,

    /// Number of threads [default: one per core]; the results do not depend on it
    #[arg(long, value_name = "N", value_parser = values::threads, allow_hyphen_values = true)]
    pub(crate) threads: Option<NonZeroUsize>,
}

/// Poses of a map, and the destination of its rows.
#[derive(Debug, Args)]
pub(crate) struct MapArgs {
    /// List of poses in a CSV file instead of a grid: columns x_m, y_m, z_m and optionally roll_deg, pitch_deg, yaw_deg
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["grid", "pose", "lengths_m"])]
    pub(crate) poses: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) run: RunArgs,
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

    /// Continue with the rows in FILE.partial of the same sweep; start if there are none
    #[arg(long, requires = "output_file", conflicts_with = "discard")]
    pub(crate) resume: bool,

    /// Discard the rows in FILE.partial and start again
    #[arg(long, requires = "output_file")]
    pub(crate) discard: bool,

    /// Compute only part K of N parts, each with its own FILE.parquet, for `funicular merge`
    #[arg(long, value_name = "K/N", requires = "output_file")]
    pub(crate) part: Option<Part>,

    /// Number of threads [default: one per core]; the rows do not depend on it
    #[arg(long, value_name = "N", value_parser = values::threads, allow_hyphen_values = true)]
    pub(crate) threads: Option<NonZeroUsize>,
}

/// Parts to merge.
#[derive(Debug, Args)]
pub(crate) struct MergeArgs {
    /// Parts, in any order
    #[arg(value_name = "PART.parquet", required = true)]
    pub(crate) parts: Vec<PathBuf>,

    /// Write all rows to FILE.parquet, .csv or .vti, completely or not at all
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub(crate) output_file: PathBuf,
}

/// File to draw, and the figure of it.
#[derive(Debug, Args)]
pub(crate) struct PlotArgs {
    /// File that `map` or `sweep` has written
    #[arg(value_name = "FILE.parquet")]
    pub(crate) file: PathBuf,

    /// Write the page to FILE, completely or not at all; - is standard output [default: FILE.parquet with the ending
    /// .html]. FILE.svg and FILE.pdf hold one figure
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub(crate) output_file: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) figure: FigureArgs,

    /// Quantity of the figure, by its name for `map` or by the name of its column; needed if there are several
    #[arg(long, value_name = "Q", help_heading = "Figure")]
    pub(crate) quantity: Option<String>,

    /// Axes of the slice in the figure, as in x,z [default: the two axes with most values]
    #[arg(long, value_name = "AXIS,AXIS", value_parser = values::plane, help_heading = "Figure")]
    pub(crate) plane: Option<values::Plane>,

    /// Value of another axis at which the slice lies (repeatable) [default: the middle of the grid]
    #[arg(long, value_name = "AXIS=VALUE", value_parser = values::place, help_heading = "Figure")]
    pub(crate) at: Vec<(String, f64)>,
}

/// Request to run.
#[derive(Debug, Args)]
pub(crate) struct RequestArgs {
    /// Request (JSON), or - for standard input
    #[arg(value_name = "FILE.json")]
    pub(crate) file: PathBuf,
    #[command(flatten)]
    pub(crate) run: RunArgs,
    #[command(flatten)]
    pub(crate) figure: FigureArgs,

    /// Draw the shape of mode N of `modes` in the figure [default: the spectrum]
    #[arg(long, value_name = "N", allow_hyphen_values = true, help_heading = "Figure")]
    pub(crate) figure_mode: Option<usize>,

    /// Write the matrices of `reduce` to an .npz or .mat file, or as CSV files to a new folder
    #[arg(long, value_name = "FILE|FOLDER", help_heading = "Output")]
    pub(crate) matrices: Option<PathBuf>,
}
