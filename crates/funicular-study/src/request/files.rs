//! Requests that make a robot file, or write the robot for another program.

use super::parts::{ImportPlatform, ImportRopes, Pose, RobotText, State, Tensions};
use super::source_file::SourceFile;
use crate::names::{ExportFormat, LengthUnit, NewMotion, RopeType};
use serde::{Deserialize, Serialize};

/// Request of `new`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct NewRequest {
    /// Name of the robot.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Number of cables; default 8, or for a planar platform and a point mass 4.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cables: Option<usize>,
    /// Motion of the platform.
    #[serde(default, with = "crate::names")]
    pub motion: NewMotion,
    /// Table of the points of the cables, in place of a number of cables.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from_csv: Option<SourceFile>,
    /// Unit of the points in the table; default metres, or the unit in the names of the columns.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "crate::names::optional")]
    pub csv_unit: Option<LengthUnit>,
    /// Mass of the platform [kg]; default 100.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_kg: Option<f64>,
    /// Sides of the homogeneous box that gives the inertia [m]; default 1 × 1 × 0.5, or the box around the attachments.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub box_m: Option<[f64; 3]>,
    /// Type of the rope.
    #[serde(default, with = "crate::names")]
    pub rope: RopeType,
    /// Diameter of the rope [m]; default by the mass of the platform, 6 mm for 100 kg.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub diameter_m: Option<f64>,
    /// Axial stiffness EA of another rope [N], in place of type and diameter; needs its mass.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axial_stiffness_n: Option<f64>,
    /// Mass of that rope per unstrained length [kg/m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_kg_per_m: Option<f64>,
    /// Pose of the state; default a stable pose that the program finds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pose: Option<Pose>,
}

/// Request of `schema`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SchemaRequest {}

/// Request of `import`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ImportRequest {
    /// Files of one robot.
    pub files: Vec<SourceFile>,
    /// Name of the cable set in a CASPR file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cable_set: Option<String>,
    /// Rope values that the files do not give.
    #[serde(flatten)]
    pub ropes: ImportRopes,
    /// Platform values that the files do not give.
    #[serde(flatten)]
    pub platform: ImportPlatform,
}

/// Request of `export`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExportRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Program that the file is for.
    #[serde(with = "crate::names")]
    pub to: ExportFormat,
    /// Elements per cable.
    #[serde(default = "twenty_segments")]
    pub segments: usize,
    /// Upper limit of the frequencies of modes in the file [Hz].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub modes_below_hz: Option<f64>,
    /// State and loads.
    #[serde(flatten)]
    pub state: State,
    /// Rule and limits of tensions.
    #[serde(flatten)]
    pub tensions: Tensions,
}

fn twenty_segments() -> usize {
    20
}
