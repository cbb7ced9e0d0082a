//! Options of `new` and `schema`.

use super::values::{self, PoseNumbers};
use clap::{Args, ValueEnum};
use funicular::math::Vec3;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct NewArgs {
    /// Name of the robot
    #[arg(long, value_name = "NAME", allow_hyphen_values = true)]
    pub(crate) name: Option<String>,

    /// Number of cables, up to 64, in a symmetric layout [default: 8; 4 for planar-xz and point-mass]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub(crate) cables: Option<usize>,

    /// Motion of the platform
    #[arg(long, value_name = "MOTION", value_enum, default_value = "rigid")]
    pub(crate) motion: MotionName,

    /// Table of the cables in place of their number: name (may be left out), anchor x, y, z in the world frame,
    /// attachment x, y, z in the platform frame; a first line may name the columns: name, anchor_x, …, attachment_z
    #[arg(long, value_name = "FILE")]
    pub(crate) from_csv: Option<PathBuf>,

    /// Unit of the points in the table [default: m, or the ending of the names of the columns, as in anchor_x_mm]
    #[arg(long, value_name = "UNIT", value_enum)]
    pub(crate) csv_unit: Option<LengthUnitName>,

    /// Pose of the state x,y,z[,roll,pitch,yaw] [m, degrees], R = Rz(yaw) Ry(pitch) Rx(roll) [default: a stable pose
    /// that the program finds, above the floor of the anchors]
    #[arg(long, value_name = "X,Y,Z[,ROLL,PITCH,YAW]", value_parser = values::pose, allow_hyphen_values = true)]
    pub(crate) pose: Option<PoseNumbers>,

    /// Mass of the platform [kg] [default: 100]
    #[arg(long, value_name = "KG", value_parser = values::positive, allow_hyphen_values = true, help_heading = "Platform")]
    pub(crate) mass_kg: Option<f64>,

    /// Sides of the homogeneous box that gives the inertia [m] [default: 1,1,0.5, or the box around the attachments of
    /// the table]
    #[arg(long, value_name = "A,B,C", value_parser = values::point, allow_hyphen_values = true, help_heading = "Platform")]
    pub(crate) box_m: Option<Vec3>,

    /// Type of the rope: a wire rope, or a rope of HMPE fibre
    #[arg(long, value_name = "ROPE", value_enum, default_value = "6x19", help_heading = "Ropes")]
    pub(crate) rope: RopeName,

    /// Diameter of the rope [m] [default: by the mass of the platform, 0.006 for 100 kg on wire ropes]
    #[arg(long, value_name = "M", value_parser = values::positive, allow_hyphen_values = true, help_heading = "Ropes")]
    pub(crate) diameter_m: Option<f64>,

    /// Axial stiffness EA of another rope [N]; needs --mass-kg-per-m
    #[arg(long, value_name = "N", value_parser = values::positive, allow_hyphen_values = true, help_heading = "Ropes")]
    pub(crate) axial_stiffness_n: Option<f64>,

    /// Mass of this rope per unstrained length [kg/m]
    #[arg(long, value_name = "KG_PER_M", value_parser = values::not_negative, allow_hyphen_values = true, help_heading = "Ropes")]
    pub(crate) mass_kg_per_m: Option<f64>,

    /// Write the robot file to FILE, which must not exist yet; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-", help_heading = "Output")]
    pub(crate) output_file: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct SchemaArgs {
    /// Write the schema to FILE, completely or not at all; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-", help_heading = "Output")]
    pub(crate) output_file: PathBuf,
}

/// Motion of the platform of a new robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum MotionName {
    /// Three translations and three rotations
    #[value(alias = "spatial")]
    Rigid,
    /// Three translations
    #[value(alias = "point")]
    PointMass,
    /// Translations along x and z, rotation about y
    #[value(alias = "planar")]
    PlanarXz,
}

/// Unit of lengths in a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum LengthUnitName {
    /// Metres
    M,
    /// Millimetres
    Mm,
}

/// Type of rope whose numbers follow from a diameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum RopeName {
    /// Six strands of 19 wires on a steel core
    #[value(name = "6x19")]
    SixTimes19,
    /// Seven strands of seven wires
    #[value(name = "7x7")]
    SevenTimes7,
    /// Braided rope of HMPE fibre, as Dyneema or Spectra
    #[value(alias = "dyneema")]
    Hmpe,
}
