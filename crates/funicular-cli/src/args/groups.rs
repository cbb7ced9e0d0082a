//! Groups of arguments that several commands share.

use super::Format;
use super::names::{AssemblyName, CableModelName, StaticModelName, TensionRuleName, WinchModeName};
use super::values::{self, Lengths, PoseNumbers, Tensions};
use clap::Args;
use funicular::math::Vec3;
use funicular::modes::PLATFORM_SHARE;
use funicular_study::request::Change;
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

/// Robot at rest and its linearisation.
#[derive(Debug, Args)]
pub(crate) struct LinearisedArgs {
    #[command(flatten)]
    pub(crate) state: StateArgs,
    #[command(flatten)]
    pub(crate) tensions: TensionArgs,
    #[command(flatten)]
    pub(crate) model: ModelArgs,
}

/// State of the robot; what these options do not give comes from the robot file.
#[derive(Debug, Args)]
#[command(next_help_heading = "State")]
pub(crate) struct StateArgs {
    /// Unstrained lengths [m], one per cable in the order of the file; the pose follows from them
    #[arg(long, value_name = "L1,L2,…", value_parser = values::lengths, allow_hyphen_values = true, conflicts_with = "pose")]
    pub(crate) lengths_m: Option<Lengths>,

    /// Pose x,y,z[,roll,pitch,yaw] [m, degrees], R = Rz(yaw) Ry(pitch) Rx(roll); the lengths follow from it
    #[arg(long, value_name = "X,Y,Z[,ROLL,PITCH,YAW]", value_parser = values::pose, allow_hyphen_values = true)]
    pub(crate) pose: Option<PoseNumbers>,

    /// Hold the unstrained lengths with which the robot of the file rests at the pose (of the file or of --pose); all
    /// changes (--set, --mass-kg, loads, wind, --vary) then act at these lengths and move the platform
    #[arg(long, conflicts_with = "lengths_m")]
    pub(crate) hold_lengths_of_pose: bool,

    #[command(flatten)]
    pub(crate) loaded: LoadedRobotArgs,
}

/// Mass, static model and loads of the robot, at any pose.
#[derive(Debug, Args)]
#[command(next_help_heading = "State")]
pub(crate) struct LoadedRobotArgs {
    /// Mass of the platform [kg]; inertia and centre of mass do not change
    #[arg(long, value_name = "KG", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) mass_kg: Option<f64>,

    /// Static model of the cables
    #[arg(long, value_name = "MODEL", value_enum, default_value_t)]
    pub(crate) static_model: StaticModelName,
    #[command(flatten)]
    pub(crate) load: LoadArgs,
}

/// Loads on platform and cables besides their weight, fixed in world axes; they replace the loads of the robot file.
#[derive(Debug, Clone, Copy, Args)]
#[command(next_help_heading = "Load")]
pub(crate) struct LoadArgs {
    /// Force on the platform, world axes [N]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) force_n: Option<Vec3>,

    /// Moment on the platform, world axes [N m]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) moment_n_m: Option<Vec3>,

    /// Point where the force acts, platform frame [m] [default: from the robot file, or the origin]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) load_point_m: Option<Vec3>,

    /// Velocity of the steady wind, world axes [m/s]; it acts on ropes with a `drag_coefficient` and platforms with a
    /// `drag_area_m2`
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) wind_m_s: Option<Vec3>,

    /// Load per metre of every cable besides its weight, world axes [N/m]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) cable_load_n_per_m: Option<Vec3>,
}

/// Linearisation of the robot.
#[derive(Debug, Args)]
#[command(next_help_heading = "Model")]
pub(crate) struct ModelArgs {
    /// Cable model: how cables respond to motion of the platform [default: catenary-dynamic; shallow-dynamic for static
    /// models other than catenary]
    #[arg(long, value_name = "MODEL", value_enum)]
    pub(crate) cable_model: Option<CableModelName>,
    #[command(flatten)]
    pub(crate) terms: TermArgs,
}

/// Terms of the stiffness.
#[derive(Debug, Args)]
#[command(next_help_heading = "Model")]
pub(crate) struct TermArgs {
    /// Terms of the stiffness
    #[arg(long, value_name = "TERMS", value_enum, default_value_t)]
    pub(crate) assembly: AssemblyName,

    /// Leave out the out-of-plane stiffness of the cables, as in Yuan et al. 2014
    #[arg(long)]
    pub(crate) in_plane_only: bool,

    /// Winches in vibration, for cables that run to a winch
    #[arg(long, value_name = "MODE", value_enum, default_value_t)]
    pub(crate) winches: WinchModeName,
}

/// Format and destination of the result.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub(crate) struct OutputArgs {
    /// Format of the result [default: from the ending of FILE, else text]; FILE.svg and FILE.pdf hold a
    /// figure, and FILE.uff of `frf` and `modes` is a Universal File
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
    #[arg(long, value_name = "MM|COLUMN", value_parser = funicular_study::figures::width_mm, allow_hyphen_values = true)]
    pub(crate) figure_width_mm: Option<f64>,

    /// Size of the texts in the figure [pt] [default: 8]
    #[arg(long, value_name = "PT", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) font_size_pt: Option<f64>,
}

/// Range of frequencies.
#[derive(Debug, Args)]
pub(crate) struct RangeArgs {
    /// First frequency [Hz]
    #[arg(long, value_name = "HZ", value_parser = values::not_negative, allow_hyphen_values = true)]
    pub(crate) from_hz: f64,

    /// Last frequency [Hz]
    #[arg(long, value_name = "HZ", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) to_hz: f64,

    /// Number of frequencies, 2 to 1000000
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=1_000_000), allow_hyphen_values = true)]
    pub(crate) points: u64,

    /// Equal ratios between frequencies instead of equal steps
    #[arg(long)]
    pub(crate) log: bool,
}

/// Choice of the tensions at a pose, for a robot with more cables than degrees of freedom.
#[derive(Debug, Args)]
#[command(next_help_heading = "Tensions")]
pub(crate) struct TensionArgs {
    /// Rule that chooses the tensions at a pose if there are more cables than degrees of freedom [default: lowest]
    #[arg(long, value_name = "RULE", value_enum)]
    pub(crate) tension_rule: Option<TensionRuleName>,

    /// Target tensions [N], one for all cables or one per cable in the order of the file; the rule is then closest
    #[arg(long, value_name = "T|T1,T2,…", value_parser = values::tensions, allow_hyphen_values = true)]
    pub(crate) target_tension_n: Option<Tensions>,

    /// Minimum tension anywhere in a cable [N] [default: from the robot file, or 2.5 times the cable's weight]
    #[arg(long, value_name = "N", value_parser = values::not_negative, allow_hyphen_values = true)]
    pub(crate) min_tension_n: Option<f64>,

    /// Maximum tension anywhere in a cable [N] [default: from the robot file, or none]
    #[arg(long, value_name = "N", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) max_tension_n: Option<f64>,
}

/// Mode that counts as a mode of the platform.
#[derive(Debug, Args)]
pub(crate) struct ShareArgs {
    /// Minimum fraction of the kinetic energy in the platform for a mode that counts as a mode of the platform
    #[arg(long, value_name = "FRACTION", value_parser = values::fraction, allow_hyphen_values = true, default_value_t = PLATFORM_SHARE)]
    pub(crate) platform_share: f64,
}

/// Points of the platform for the input and the output of a response.
#[derive(Debug, Args)]
pub(crate) struct PointArgs {
    /// Point where the force acts, platform frame [m] [default: the origin]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) input_point_m: Option<Vec3>,

    /// Point whose motion is measured, platform frame [m] [default: the origin]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) output_point_m: Option<Vec3>,
}
