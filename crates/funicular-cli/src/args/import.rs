//! Options of `import`.

use super::values::{self, Inertia, PoseNumbers};
use clap::Args;
use funicular::math::Vec3;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct ImportArgs {
    /// Files of one robot; their format is recognised from their content
    #[arg(value_name = "FILE", required = true)]
    pub(crate) files: Vec<PathBuf>,

    /// Name of the cable set if a CASPR file has several [default: from the file]
    #[arg(long, value_name = "NAME", allow_hyphen_values = true)]
    pub(crate) cable_set: Option<String>,

    #[command(flatten)]
    pub(crate) ropes: RopeArgs,
    #[command(flatten)]
    pub(crate) platform: ImportedPlatformArgs,

    /// Write the robot file to FILE, completely or not at all; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-", help_heading = "Output")]
    pub(crate) output_file: PathBuf,
}

/// Rope values that a source may lack. An option takes precedence over the file.
#[derive(Debug, Args)]
#[command(next_help_heading = "Ropes")]
pub(crate) struct RopeArgs {
    /// Mass of the ropes per unstrained length [kg/m]; 0 for massless ropes
    #[arg(long, value_name = "KG_PER_M", value_parser = values::not_negative, allow_hyphen_values = true)]
    pub(crate) mass_kg_per_m: Option<f64>,

    /// Axial stiffness EA of the ropes [N]
    #[arg(long, value_name = "N", value_parser = values::positive, allow_hyphen_values = true,
        conflicts_with_all = ["youngs_modulus_pa", "diameter_m"])]
    pub(crate) axial_stiffness_n: Option<f64>,

    /// Young's modulus of the full circular section of the ropes [Pa]; needs the diameter
    #[arg(long, value_name = "PA", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) youngs_modulus_pa: Option<f64>,

    /// Diameter of the ropes [m]
    #[arg(long, value_name = "M", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) diameter_m: Option<f64>,
}

/// Platform values that a source may lack. An option takes precedence over the file.
#[derive(Debug, Args)]
#[command(next_help_heading = "Platform")]
pub(crate) struct ImportedPlatformArgs {
    /// Mass of the platform [kg]
    #[arg(long, value_name = "KG", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) mass_kg: Option<f64>,

    /// Inertia tensor about the centre of mass, platform axes [kg m²]
    #[arg(long, value_name = "XX,YY,ZZ[,XY,XZ,YZ]", value_parser = values::inertia, allow_hyphen_values = true)]
    pub(crate) inertia_kg_m2: Option<Inertia>,

    /// Centre of mass in the platform frame [m]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) center_of_mass_m: Option<Vec3>,

    /// Pose of the state x,y,z[,roll,pitch,yaw] [m, degrees], R = Rz(yaw) Ry(pitch) Rx(roll) [default: from the file]
    #[arg(long, value_name = "X,Y,Z[,ROLL,PITCH,YAW]", value_parser = values::pose, allow_hyphen_values = true)]
    pub(crate) pose: Option<PoseNumbers>,
}
