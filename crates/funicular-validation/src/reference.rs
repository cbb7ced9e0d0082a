//! Contents of the files in crates/funicular-validation/reference.

mod centres;
mod damped;
mod distances;
mod drives;
mod exact;
mod gradients;
mod histories;
mod identification;
mod independent;
mod load_factors;
mod measured;
mod published;
mod stretch_loss;
mod strings;
mod sway;
mod trajectories;
mod workspaces;

use anyhow::{Result, anyhow};
use funicular::robot::{Robot, State};
use serde::Deserialize;

pub(super) use centres::{CentreRow, LengthsAtCentre, centre_lengths, centres};
pub(super) use damped::{
    Damped, DampedRobot, ModeShape, PointRobot, ReferencePoint, RopeDamping, ShapesOfRobot, damped,
};
pub(super) use distances::{DistanceReference, MeasuredPairs, PairsAtPose, distances};
pub(super) use drives::{
    CableToWinch, DriveParts, DrivenCable, DrivenRobot, Drives, FrictionCorner, FrictionHalfWidths, RobotWithWinches,
    SaggingOverPulley, ServoDamped, StraightOverPulley, drives,
};
pub(super) use exact::{ExactCable, ExactReference, ExactRobot, exact};
pub(super) use gradients::{GradientReference, GradientRobot, GradientRow, gradients};
pub(super) use histories::{HistoryCase, HistoryReference, HistorySample, histories};
pub(super) use identification::{IdentificationReference, MeasuredResponses, PlatformOfMakers, identification};
pub(super) use independent::{
    ComplexMatrix, IndependentReference, IndependentRobot, Matrix, ModeList, ReferenceResponse, independent,
};
pub(super) use load_factors::{LoadFactorReference, LoadedPose, LoadedRobot, load_factors};
pub(super) use measured::{MeasuredPose, measured};
pub(super) use published::{
    BesselRow, ClosedFormRow, Cube, CubeRow, Fig2, FiniteElementRow, HungBetween, IsolatedCable, Published, published,
};

pub(super) use stretch_loss::{ChangedRobot, LossyRobot, LossyRope, StretchLossReference, stretch_loss};
pub(super) use strings::{ClampedCable, ClampedTable, CooledCable, StringReference, TautString, strings};
pub(super) use sway::{ShapedSum, SwayReference, SwayingRobot, sway};
pub(super) use trajectories::{MovingRobot, MovingRow, TrajectoryReference, trajectories};
pub(super) use workspaces::{WorkspaceReference, workspaces};

/// Table of a reference file: a source and rows.
#[derive(Deserialize)]
pub(super) struct ReferenceTable<R> {
    pub(super) source: String,
    pub(super) rows: Vec<R>,
}

/// Reads a robot and its unstrained lengths.
pub(super) fn robot(text: &str) -> Result<(Robot, Vec<f64>)> {
    let robot = Robot::from_toml(text)?;
    match robot.state.clone() {
        State::Lengths(lengths) => Ok((robot, lengths)),
        State::Pose(_) | State::Unknown => Err(anyhow!("{} gives no unstrained lengths", robot.name)),
    }
}

/// Text of a robot of the library by the name of its file.
pub(super) fn library_text(name: &str) -> Result<&'static str> {
    let found = funicular_robots::ALL.iter().find(|(own, _)| *own == name);
    found.map(|(_, text)| *text).ok_or_else(|| anyhow!("the library has no robot {name}"))
}

/// Reads a robot of the library by the name of its file.
pub(super) fn library(name: &str) -> Result<(Robot, Vec<f64>)> {
    robot(library_text(name)?)
}
