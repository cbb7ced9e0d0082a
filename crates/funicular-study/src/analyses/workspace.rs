//! `workspace`: set of all positions at which the robot meets conditions.

mod conditions;
mod places;
mod reach;
mod rows;
mod study;

pub use conditions::ConditionRow;
pub use reach::{ReachedPoint, WorkspaceReach};
pub use rows::{
    AreaOfWorkspace, ComparedSets, GridOfWorkspace, InnerBox, PartOfWorkspace, RaysOfWorkspace, SectionOfWorkspace,
    VolumeRow, Workspace,
};
pub use study::{EvaluateSet, SearchedSet, WorkspaceStudy};

use crate::Watch;
use crate::error::Cancelled;
use crate::request::WorkspaceRequest;
use anyhow::Result;
use funicular::math::Vec3;
use funicular::robot::Robot;

/// Number of poses between two looks at the watch.
const POSES_AT_ONCE: usize = 64;

/// Finds the workspace on this thread.
///
/// # Errors
/// A request that contradicts itself or the robot, no position that meets the conditions, or work that was stopped
/// before anything was found.
pub fn run(robot: Robot, request: &WorkspaceRequest, watch: &mut dyn Watch) -> Result<Workspace> {
    let study = WorkspaceStudy::new(robot, request)?;
    let mut done = 0;
    let mut evaluate = |set: SearchedSet, positions: &[Vec3]| {
        let total = done + positions.len();
        let mut values = Vec::with_capacity(positions.len());
        for chunk in positions.chunks(POSES_AT_ONCE) {
            if watch.is_cancelled() {
                return None;
            }
            values.extend(chunk.iter().map(|position| study.value(set, position)));
            done += chunk.len();
            watch.progress(done, total, "poses");
        }
        Some(values)
    };
    study.find(&mut evaluate)?.ok_or_else(|| Cancelled.into())
}
