//! Options of `map`, `sweep`, `merge` and `plot`.

use super::groups::{LinearisedArgs, ShareArgs};
use super::{FigureArgs, Format, RobotArgs, values};
use clap::Args;
use funicular_study::sweep::{Part, Quantity, Steps, ValueAxis};
use std::num::NonZeroUsize;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct MapArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Axis of the grid: x, y, z [m], roll, pitch, yaw [degrees], with N values from A to B, or with listed values
    /// (repeatable); an axis that is not given keeps the value of the robot's state or of --pose
    #[arg(long, value_name = "AXIS=A:B:N|V,V,…", value_parser = values::grid_axis, required_unless_present = "poses")]
    pub(crate) grid: Vec<(String, Steps)>,

    /// List of poses in a CSV file instead of a grid: columns x_m, y_m, z_m and optionally roll_deg, pitch_deg, yaw_deg
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["grid", "pose", "lengths_m"])]
    pub(crate) poses: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) point: EachArgs,
    #[command(flatten)]
    pub(crate) run: RunArgs,
}

#[derive(Debug, Args)]
pub(crate) struct SweepArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Number of the robot file that varies, with N values from A to B, or with listed values (repeatable: all
    /// combinations, the first fastest); `*` for any key moves all numbers that match together, as in
    /// cables.*.anchor_m.z
    #[arg(long, value_name = "PATH=A:B:N|V,V,…", value_parser = values::variation, required = true)]
    pub(crate) vary: Vec<ValueAxis>,

    #[command(flatten)]
    pub(crate) point: EachArgs,
    #[command(flatten)]
    pub(crate) run: RunArgs,
}

/// Options of the evaluation of every point.
#[derive(Debug, Args)]
pub(crate) struct EachArgs {
    #[command(flatten)]
    pub(crate) what: WhatArgs,
    #[command(flatten)]
    pub(crate) linearised: LinearisedArgs,
}

/// Quantities to compute at every point.
#[derive(Debug, Args)]
pub(crate) struct WhatArgs {
    // The help lists the names of all quantities.
    #[arg(long, help = quantities(), value_name = "Q,Q,…", value_parser = values::quantity, value_delimiter = ',', default_value = "tension-min,tension-max")]
    pub(crate) quantity: Vec<Quantity>,

    /// Upper limit of the search for natural frequencies [Hz]
    #[arg(long, value_name = "HZ", value_parser = values::positive, allow_hyphen_values = true, default_value_t = funicular_study::sweep::MAX_HZ)]
    pub(crate) up_to_hz: f64,

    #[command(flatten)]
    pub(crate) share: ShareArgs,

    /// Centre of mass of the payload, platform frame [m] [default: that of the platform]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) payload_center_m: Option<funicular::math::Vec3>,
}

/// Help of the option for quantities.
fn quantities() -> String {
    let names: Vec<&str> = Quantity::names().collect();
    format!(
        "Quantities to compute at every point, described in docs/sweeps.md: {}. first-platform-frequency jumps between \
         neighbouring points where a mode of the cables is near; for a smooth curve choose --cable-model catenary-static",
        names.join(", ")
    )
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

#[derive(Debug, Args)]
pub(crate) struct MergeArgs {
    /// Parts, in any order
    #[arg(value_name = "PART.parquet", required = true)]
    pub(crate) parts: Vec<PathBuf>,

    /// Write all rows to FILE.parquet, .csv or .vti, completely or not at all
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub(crate) output_file: PathBuf,
}

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
