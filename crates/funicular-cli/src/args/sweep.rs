//! Options of `map`, `sweep`, `merge` and `plot`.

use super::{Format, ModelArgs, RobotArgs, StateArgs, TensionArgs, values};
use clap::Args;
use funicular_study::sweep::{Part, Quantity, Steps, ValueAxis};
use std::num::NonZeroUsize;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct MapArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// An axis of the grid: x, y, z [m], roll, pitch, yaw [degrees], from A to B in N values, or the values (repeatable);
    /// axes that are not given are those of the robot's state, or of --pose
    #[arg(long, value_name = "AXIS=A:B:N|V,V,…", value_parser = values::grid_axis, required_unless_present = "poses")]
    pub(crate) grid: Vec<(String, Steps)>,

    /// Poses of a CSV file instead of a grid: columns x_m, y_m, z_m and, if they turn, roll_deg, pitch_deg, yaw_deg
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

    /// A number of the robot file, from A to B in N values, or the values (repeatable: all combinations, the first fastest)
    #[arg(long, value_name = "PATH=A:B:N|V,V,…", value_parser = values::variation, required = true)]
    pub(crate) vary: Vec<ValueAxis>,

    #[command(flatten)]
    pub(crate) point: EachArgs,
    #[command(flatten)]
    pub(crate) run: RunArgs,
}

/// How every point is computed.
#[derive(Debug, Args)]
pub(crate) struct EachArgs {
    #[command(flatten)]
    pub(crate) what: WhatArgs,
    #[command(flatten)]
    pub(crate) state: StateArgs,
    #[command(flatten)]
    pub(crate) tensions: TensionArgs,
    #[command(flatten)]
    pub(crate) model: ModelArgs,
}

/// What is asked of every point.
#[derive(Debug, Args)]
pub(crate) struct WhatArgs {
    // Help: the names of all quantities.
    #[arg(long, help = quantities(), value_name = "Q,Q,…", value_parser = values::quantity, value_delimiter = ',', default_value = "tension-min,tension-max")]
    pub(crate) quantity: Vec<Quantity>,

    /// Where the search for natural frequencies ends [Hz]
    #[arg(long, value_name = "HZ", value_parser = values::positive, allow_hyphen_values = true, default_value_t = funicular_study::sweep::MAX_HZ)]
    pub(crate) up_to_hz: f64,
}

/// Help of the option for quantities.
fn quantities() -> String {
    let names: Vec<&str> = Quantity::names().collect();
    format!("What to compute, docs/sweeps.md has the list: {}", names.join(", "))
}

/// How rows are computed and where they go.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub(crate) struct RunArgs {
    /// What goes to standard output: a summary as text or json, or, without -o, all rows as csv [default: text]
    #[arg(long, value_name = "FORMAT", value_enum)]
    pub(crate) format: Option<Format>,

    /// Write the rows to FILE.parquet, .csv or .vti (ParaView), as a whole; until then they are in FILE.partial
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output_file: Option<PathBuf>,

    /// Go on with what FILE.partial holds of the same sweep; begin if there is nothing
    #[arg(long, requires = "output_file", conflicts_with = "discard")]
    pub(crate) resume: bool,

    /// Forget what FILE.partial holds
    #[arg(long, requires = "output_file")]
    pub(crate) discard: bool,

    /// The k-th of n parts, each with a FILE.parquet of its own, for `funicular merge`
    #[arg(long, value_name = "K/N", requires = "output_file")]
    pub(crate) part: Option<Part>,

    /// Threads [default: one a core]; the rows do not depend on it
    #[arg(long, value_name = "N", value_parser = values::threads, allow_hyphen_values = true)]
    pub(crate) threads: Option<NonZeroUsize>,
}

#[derive(Debug, Args)]
pub(crate) struct MergeArgs {
    /// The parts, in any order
    #[arg(value_name = "PART.parquet", required = true)]
    pub(crate) parts: Vec<PathBuf>,

    /// Write all rows to FILE.parquet, .csv or .vti, as a whole or not at all
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub(crate) output_file: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct PlotArgs {
    /// What `map` or `sweep` has written
    #[arg(value_name = "FILE.parquet")]
    pub(crate) file: PathBuf,

    /// Write the page to FILE, as a whole or not at all; - is standard output [default: as FILE.parquet, ending in .html]
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub(crate) output_file: Option<PathBuf>,
}
