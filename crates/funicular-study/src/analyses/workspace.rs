//! `workspace`: set of all positions at which the robot meets conditions.

mod conditions;
mod places;
mod reach;
mod rows;
mod so_far;
mod study;

pub use conditions::ConditionRow;
pub use reach::{ReachedPoint, WorkspaceReach};
pub use rows::{
    AreaOfWorkspace, ComparedSets, GridOfWorkspace, InnerBox, PartOfWorkspace, RaysOfWorkspace, SectionOfWorkspace,
    VolumeRow, Workspace,
};
pub use so_far::FoundSoFar;
pub use study::{EvaluateSet, SearchedSet, WorkspaceStudy};

use super::prove;
use crate::Watch;
use crate::error::Stopped;
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
    let (mut done, mut so_far) = (0, FoundSoFar::default());
    let mut evaluate = |set: SearchedSet, positions: &[Vec3]| {
        let total = done + positions.len();
        let mut values = Vec::with_capacity(positions.len());
        for chunk in positions.chunks(POSES_AT_ONCE) {
            if watch.is_cancelled() {
                return None;
            }
            let found: Vec<Option<f64>> = chunk.iter().map(|position| study.value(set, position)).collect();
            so_far.add(set, chunk, &found);
            values.extend(found);
            done += chunk.len();
            watch.note(&so_far.note());
            watch.progress(done, total, "positions");
        }
        Some(values)
    };
    let found = study.find(&mut evaluate)?;
    let mut found = found.ok_or_else(|| Stopped(so_far.stopped()))?;
    if let Some(proof) = study.proof() {
        found.proof = Some(prove::run_study(proof, watch)?);
    }
    Ok(found)
}
