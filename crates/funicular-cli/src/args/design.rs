//! Options of `design`.

use super::names::DesignGoalName;
use super::values::{self, PoseNumbers};
use super::{LoadedRobotArgs, ModelArgs, OutputArgs, RobotArgs, TensionArgs};
use clap::Args;
use funicular_study::request::{ChangeValue, DesignRequest, RobotText};
use funicular_study::set_values;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct DesignArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Value of the robot file to choose, with its bounds: around the present value, as in 'cables.*.attachment_m=±0.05' (or
    /// +-), or absolute, as in platform.mass_kg=80:120; * stands for any key, and a path to a table or vector for all
    /// numbers of it that the file gives (repeatable)
    #[arg(long, value_name = "PATH=±REACH|MIN:MAX", value_parser = change, required = true)]
    pub(crate) change: Vec<ChangeValue>,

    /// Goal of the design
    #[arg(long, value_name = "GOAL", value_enum, default_value_t)]
    pub(crate) goal: DesignGoalName,

    /// List of poses in a CSV file: columns x_m, y_m, z_m and optionally roll_deg, pitch_deg, yaw_deg [default: the pose of
    /// --pose or of the robot file]
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) poses: Option<PathBuf>,

    /// Weights of the poses, for their mean instead of the worst pose
    #[arg(long, value_name = "W1,W2,…", value_delimiter = ',', value_parser = values::positive)]
    pub(crate) weights: Option<Vec<f64>>,

    /// Demand: first natural frequency at every pose of at least HZ
    #[arg(long, value_name = "HZ", value_parser = values::positive, help_heading = "Demands")]
    pub(crate) min_frequency_hz: Option<f64>,

    /// Demand: minimum stiffness at every pose of at least K, as `statics` prints it [N/m]
    #[arg(long, value_name = "K", value_parser = values::positive, help_heading = "Demands")]
    pub(crate) min_stiffness_n_per_m: Option<f64>,

    /// Demand: no natural frequency between two frequencies at any pose, as in 2.5:3.2 [Hz]
    #[arg(long, value_name = "FROM:TO", value_parser = band, help_heading = "Demands")]
    pub(crate) avoid_hz: Option<[f64; 2]>,

    /// Maximum number of iterations
    #[arg(long, value_name = "N", default_value = "50")]
    pub(crate) max_iterations: usize,

    /// Pose x,y,z[,roll,pitch,yaw] [m, degrees] instead of a list of poses
    #[arg(long, value_name = "X,Y,Z[,ROLL,PITCH,YAW]", value_parser = values::pose, allow_hyphen_values = true, conflicts_with = "poses", help_heading = "State")]
    pub(crate) pose: Option<PoseNumbers>,

    #[command(flatten)]
    pub(crate) loaded: LoadedRobotArgs,
    #[command(flatten)]
    pub(crate) tensions: TensionArgs,
    #[command(flatten)]
    pub(crate) model: ModelArgs,
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

impl DesignArgs {
    /// Request of a design; `poses` are the poses in the file of `--poses`.
    pub(crate) fn request(&self, robot: RobotText, poses: Option<Vec<[f64; 6]>>) -> DesignRequest {
        DesignRequest {
            robot,
            change: self.change.clone(),
            goal: self.goal.into(),
            poses,
            weights: self.weights.clone(),
            min_frequency_hz: self.min_frequency_hz,
            min_stiffness_n_per_m: self.min_stiffness_n_per_m,
            avoid_hz: self.avoid_hz,
            max_iterations: self.max_iterations,
            state: self.loaded.at_pose(self.pose),
            tensions: self.tensions.request(),
            model: self.model.request(),
        }
    }
}

/// Reads `PATH=±REACH` or `PATH=MIN:MAX`.
fn change(text: &str) -> Result<ChangeValue, String> {
    let wrong = "bounds are written as in cables.*.attachment_m=±0.05 or platform.mass_kg=80:120";
    let (path, bounds) = set_values::split(text).ok_or(wrong)?;
    let path = path.trim().to_owned();
    let bounds = bounds.trim();
    if let Some(reach) = bounds.strip_prefix('±').or_else(|| bounds.strip_prefix("+-")) {
        return Ok(ChangeValue { path, plus_minus: Some(values::positive(reach)?), ..ChangeValue::default() });
    }
    let (low, high) = bounds.split_once(':').ok_or(wrong)?;
    let (minimum, maximum) = (Some(values::finite(low)?), Some(values::finite(high)?));
    Ok(ChangeValue { path, minimum, maximum, ..ChangeValue::default() })
}

/// Reads `FROM:TO`.
fn band(text: &str) -> Result<[f64; 2], String> {
    let (first, last) = text.split_once(':').ok_or("a band is written as in 2.5:3.2")?;
    Ok([values::positive(first)?, values::positive(last)?])
}
