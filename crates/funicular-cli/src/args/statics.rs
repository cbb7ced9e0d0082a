//! Arguments of the commands about the robot file and the robot at rest.

use super::groups::{FigureArgs, LinearisedArgs, OutputArgs, RobotArgs, StateArgs, TensionArgs};
use super::values::{self, Lengths, MassRange, PoseNumbers};
use clap::Args;
use funicular::math::Vec3;

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

#[derive(Debug, Args)]
pub(crate) struct StaticsArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,
    #[command(flatten)]
    pub(crate) state: StateArgs,
    #[command(flatten)]
    pub(crate) tensions: TensionArgs,

    /// Search for all equilibria of the unstrained lengths, including unstable ones
    #[arg(long)]
    pub(crate) all: bool,

    /// Compute the interval in which friction of pulleys leaves pose and tensions
    ///
    /// The interval is that of every cable having last run towards the platform or towards its drum. With lengths
    /// given, or with --hold-lengths-of-pose, pose and tensions vary. With a pose given, the tensions at the drums and
    /// the lengths vary. Friction is given in [pulleys.NAME] by `friction_coefficient`, `efficiency` or
    /// `bearing_friction_coefficient`.
    #[arg(long)]
    pub(crate) friction_interval: bool,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
    #[command(flatten)]
    pub(crate) figure: FigureArgs,
}

#[derive(Debug, Args)]
pub(crate) struct StiffnessArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Frequency of the stiffness [Hz]; at 0 Hz the tangent of the static model, unless --cable-model is given
    #[arg(long, value_name = "HZ", value_parser = values::not_negative, allow_hyphen_values = true, default_value = "0")]
    pub(crate) at_hz: f64,

    #[command(flatten)]
    pub(crate) linearised: LinearisedArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

#[derive(Debug, Args)]
pub(crate) struct PayloadArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Centre of mass of the payload, platform frame [m] [default: that of the platform]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) payload_center_m: Option<Vec3>,

    #[command(flatten)]
    pub(crate) state: StateArgs,
    #[command(flatten)]
    pub(crate) tensions: TensionArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

#[derive(Debug, Args)]
pub(crate) struct PoseErrorArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Platform masses [kg]: N masses from A to B in equal steps, as in 10:90:81
    #[arg(long, value_name = "A:B:N", value_parser = values::mass_range, allow_hyphen_values = true)]
    pub(crate) mass_kg: MassRange,

    /// Unstrained lengths [m], one per cable in the order of the file [default: from the robot file]
    #[arg(long, value_name = "L1,L2,…", value_parser = values::lengths, allow_hyphen_values = true)]
    pub(crate) lengths_m: Option<Lengths>,

    /// Pose x,y,z[,roll,pitch,yaw] [m, degrees]: hold the unstrained lengths with which the robot of the file, without
    /// --set, rests there [default: the [state] of the robot file]
    #[arg(long, value_name = "X,Y,Z[,ROLL,PITCH,YAW]", value_parser = values::pose, allow_hyphen_values = true, conflicts_with = "lengths_m")]
    pub(crate) pose: Option<PoseNumbers>,
    #[command(flatten)]
    pub(crate) tensions: TensionArgs,

    /// Maximum distance between spring pose and catenary pose at which springs are good enough [mm]; reports the masses
    /// where they are
    #[arg(long, value_name = "MM", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) tolerance_mm: Option<f64>,

    #[command(flatten)]
    pub(crate) output: OutputArgs,
}
