//! `prove`: statements that hold at every pose of a box, and the division of a box into what is proved.

mod lines;
mod rows;

pub use rows::{BoxRow, Proved};

use crate::Watch;
use crate::at_rest;
use crate::request::{BOXES, Division, ProveRequest, Requirements, State, Tensions};
use anyhow::{Result, bail};
use funicular::math::{Rotation, Vec3};
use funicular::proof::{BoxProof, PositionBox, ProofSearch, ProofStatement};
use funicular::robot::{self, Pose, Robot};
use funicular::statics::StaticModel;
use funicular::warnings;
use rows::DivisionEnd;

/// Number of boxes between two looks at the clock: some ten milliseconds of work.
const BOXES_AT_ONCE: usize = 256;

/// Proof that is ready to run.
pub struct ProofStudy {
    robot: Robot,
    model: StaticModel,
    pose: Pose,
    turns_deg: [f64; 3],
    statement: ProofStatement,
    region: PositionBox,
    division: Division,
    most_boxes: usize,
}

/// Proofs of boxes in their order; `None` if the work is to stop.
pub type ProveBoxes<'a> = dyn FnMut(&ProofStatement, &[PositionBox]) -> Option<Vec<BoxProof>> + 'a;

/// Box that a workspace proves.
pub(crate) struct ProofOfWorkspace<'a> {
    pub(crate) robot: &'a Robot,
    pub(crate) model: StaticModel,
    pub(crate) rotation: Rotation,
    pub(crate) region: PositionBox,
    pub(crate) division: Division,
}

impl ProofStudy {
    /// Checks a request for a robot that has been read from its file.
    ///
    /// # Errors
    /// A request that contradicts itself, or a robot for which no bound is derived.
    pub fn new(robot: Robot, request: &ProveRequest) -> Result<Self> {
        request.check()?;
        let ProveRequest { state, tensions, required, division, within_m, within_deg, .. } = request;
        let robot = prepared(robot, state, tensions, required)?;
        at_rest::refuse_no_state(&robot)?;
        let robot::State::Pose(pose) = robot.state else {
            bail!("a proof is about a box of poses: give ⟪pose⟫, the middle of the box");
        };
        let half = Vec3::from(within_m.unwrap_or_default());
        let turns_deg = within_deg.unwrap_or_default();
        let turns = Vec3::from(turns_deg).map(f64::to_radians);
        let statement = ProofStatement::of(&robot, &pose, state.static_model, turns)?;
        let region = PositionBox::about(&pose.position_w, &half);
        if statement.within_motion(&region) != region {
            bail!("⟪within_m⟫: the platform stays in its plane: give 0 for the axis at right angles to it");
        }
        let (model, most_boxes) = (state.static_model, division.most_boxes(1));
        Ok(Self { robot, model, pose, turns_deg, statement, region, division: *division, most_boxes })
    }

    /// Proof about the box of a workspace.
    ///
    /// # Errors
    /// A robot for which no bound is derived.
    pub(crate) fn of_workspace(of: &ProofOfWorkspace<'_>) -> Result<Self> {
        let ProofOfWorkspace { robot, model, rotation, region, division } = *of;
        division.check()?;
        let pose = Pose { position_w: region.center(), rot_wp: rotation };
        let statement = ProofStatement::of(robot, &pose, model, Vec3::zeros())?;
        let region = statement.within_motion(&region);
        let most_boxes = division.most_boxes(BOXES);
        Ok(Self { robot: robot.clone(), model, pose, turns_deg: [0.0; 3], statement, region, division, most_boxes })
    }

    /// Divides the box, the largest undecided boxes first, with the proofs that `prove` gives. `elapsed` is the time
    /// since the start [s], if there is a clock. `report` gets the number of boxes and what was found so far.
    ///
    /// # Errors
    /// A time without a clock.
    pub fn find(
        &self,
        prove: &mut ProveBoxes<'_>,
        elapsed: Option<&dyn Fn() -> f64>,
        report: &mut dyn FnMut(usize, usize, &str),
    ) -> Result<Proved> {
        if self.division.time_s.is_some() && elapsed.is_none() {
            bail!("⟪time_s⟫ needs a clock, which a request in the browser does not have: give ⟪boxes⟫");
        }
        let mut search = ProofSearch::new(self.region);
        let end = loop {
            let left = self.most_boxes.saturating_sub(search.tried());
            let boxes = search.next(left.min(BOXES_AT_ONCE));
            if boxes.is_empty() {
                break if left == 0 { DivisionEnd::Boxes } else { DivisionEnd::Complete };
            }
            let Some(proofs) = prove(&self.statement, &boxes) else { break DivisionEnd::Stopped };
            search.add(&proofs);
            report(search.tried(), self.most_boxes, &rows::so_far(&search));
            if let (Some(limit), Some(elapsed)) = (self.division.time_s, elapsed)
                && elapsed() >= limit
            {
                break DivisionEnd::Time;
            }
            if self.division.undecided.is_some_and(|share| search.volumes().undecided_share() <= share) {
                break DivisionEnd::Undecided;
            }
        };
        let end = if search.volumes().undecided() <= 1e-9 * search.volumes().whole && end == DivisionEnd::Boxes {
            DivisionEnd::Complete
        } else {
            end
        };
        Ok(Proved::of(self, &search, end))
    }
}

/// Robot with the state, limits and required loads of a request.
fn prepared(robot: Robot, state: &State, tensions: &Tensions, required: &Requirements) -> Result<Robot> {
    at_rest::with_required(at_rest::with_limits(&at_rest::with_state(robot, state)?, tensions)?, required)
}

/// Proves on this thread.
///
/// # Errors
/// A request that contradicts itself, or a robot for which no bound is derived.
pub fn run(robot: Robot, request: &ProveRequest, watch: &mut dyn Watch) -> Result<Proved> {
    run_study(&ProofStudy::new(robot, request)?, watch)
}

/// Proves a study on this thread, without a clock.
pub(super) fn run_study(study: &ProofStudy, watch: &mut dyn Watch) -> Result<Proved> {
    let watch = std::cell::RefCell::new(watch);
    let mut prove = |statement: &ProofStatement, boxes: &[PositionBox]| {
        let proofs = boxes.iter().map(|region| (!watch.borrow().is_cancelled()).then(|| statement.prove(region)));
        proofs.collect()
    };
    let start = watch.borrow().now_s();
    let elapsed = || watch.borrow().now_s().unwrap_or_default() - start.unwrap_or_default();
    let clock = start.map(|_| &elapsed as &dyn Fn() -> f64);
    study.find(&mut prove, clock, &mut |done, total, so_far| {
        let mut watch = watch.borrow_mut();
        watch.note(so_far);
        watch.progress(done, total, "boxes");
    })
}

impl ProofStudy {
    fn warnings(&self) -> Vec<String> {
        warnings::of_robot(&self.robot).iter().map(ToString::to_string).collect()
    }
}
