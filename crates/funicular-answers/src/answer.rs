//! Run of a request with results, whatever its command: on several threads where the work has parts, with rows or
//! samples in a file that survives interruptions.

use crate::outputs::clock;
use anyhow::{Context, Result, bail};
use funicular::robot::Robot;
use funicular_files::{Begin, ProofRun, UncertaintyOutcome, UncertaintyRun, WorkspaceOutcome, WorkspaceRun};
use funicular_study::analyses::prove::{ProofStudy, Proved};
use funicular_study::analyses::simulate::{self, BegunRun, RowKeeper};
use funicular_study::analyses::uncertainty::UncertaintyStudy;
use funicular_study::analyses::workspace::{FoundSoFar, WorkspaceStudy};
use funicular_study::request::Request;
use funicular_study::{Cancelled, Results, Stopped, Watch, run_on};
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// Way of running a request.
pub struct Running<'a> {
    /// Observer of the work.
    pub watch: &'a mut dyn Watch,
    /// Number of threads, for the commands that use several.
    pub threads: NonZeroUsize,
    /// Flag that stops work on several threads.
    pub cancel: &'a AtomicBool,
    /// File for the sampled robots of `uncertainty`, and the treatment of the work of an earlier run.
    pub samples: Option<(&'a Path, Begin)>,
    /// True if the results are drawn as a figure, which some do not have.
    pub has_figure: bool,
    /// Keeper of the rows of `simulate`, and the run that has begun.
    pub keeper: Option<(&'a mut dyn RowKeeper, Option<BegunRun>)>,
}

/// Results, and the reason why they are a part of what was wanted.
pub struct Answer {
    /// Results.
    pub results: Results,
    /// Error of work that was stopped with these results.
    pub stopped: Option<anyhow::Error>,
}

impl Running<'_> {
    /// Progress of work on several threads, which the observer can stop.
    fn report(&mut self, done: usize, total: usize, what: &'static str) {
        self.watch.progress(done, total, what);
        if self.watch.is_cancelled() {
            self.cancel.store(true, Ordering::Relaxed);
        }
    }
}

/// Runs a request whose robot, if it has one, has been read before.
///
/// # Errors
/// The errors of the command; [`Stopped`] for work that was stopped without results.
pub fn run(request: &Request, robot: Option<Robot>, how: Running<'_>) -> Result<Answer> {
    let of_robot = |robot: Option<Robot>| robot.with_context(|| format!("`{}` needs a robot", request.command()));
    match request {
        Request::Workspace(of) => {
            let study = WorkspaceStudy::new(of_robot(robot)?, of)?;
            if how.has_figure && !study.has_sections() {
                bail!("a figure of a workspace shows its sections: give ⟪section⟫, as in z=0.5,1,1.5");
            }
            workspace(&study, how)
        }
        Request::Prove(of) => prove(&ProofStudy::new(of_robot(robot)?, of)?, how),
        Request::Uncertainty(of) => uncertainty(&UncertaintyStudy::new(of)?, how),
        Request::Simulate(of) => {
            let robot = of_robot(robot)?;
            let found = match how.keeper {
                Some((keeper, begun)) => simulate::run_with(robot, of, how.watch, keeper, begun)?,
                None => simulate::run(robot, of, how.watch)?,
            };
            let stopped = found.stopped_at_s.map(|_| Cancelled.into());
            Ok(Answer { results: Results::Simulate(Box::new(found)), stopped })
        }
        _ => Ok(Answer { results: run_on(request, robot, how.watch)?, stopped: None }),
    }
}

fn workspace(study: &WorkspaceStudy, mut how: Running<'_>) -> Result<Answer> {
    let (threads, cancel) = (how.threads, how.cancel);
    let mut report = |done: usize, total: usize, so_far: &FoundSoFar| {
        how.watch.note(&so_far.note());
        how.report(done, total, "positions");
    };
    let mut found = match (WorkspaceRun { threads, cancel }).run(study, &mut report)? {
        WorkspaceOutcome::Found(found) => found,
        WorkspaceOutcome::Stopped(so_far) => return Err(Stopped(so_far.stopped()).into()),
    };
    if let Some(proof) = study.proof() {
        found.proof = Some(proved(proof, &mut how)?);
    }
    let is_stopped = cancel.load(Ordering::Relaxed);
    let stopped = is_stopped.then(|| Stopped("stopped: the result is what was found until then".to_owned()).into());
    Ok(Answer { results: Results::Workspace(found), stopped })
}

/// Proof on several threads; what was found until a stop is kept.
fn proved(study: &ProofStudy, how: &mut Running<'_>) -> Result<Proved> {
    let (threads, cancel, elapsed) = (how.threads, how.cancel, clock());
    let run = ProofRun { threads, cancel, elapsed: &elapsed };
    run.run(study, &mut |done, total, so_far| {
        how.watch.note(so_far);
        how.report(done, total, "boxes");
    })
}

fn prove(study: &ProofStudy, mut how: Running<'_>) -> Result<Answer> {
    let found = proved(study, &mut how)?;
    let stopped =
        found.is_stopped().then(|| Stopped("stopped: the result is what was proved until then".to_owned()).into());
    Ok(Answer { results: Results::Prove(Box::new(found)), stopped })
}

fn uncertainty(study: &UncertaintyStudy, mut how: Running<'_>) -> Result<Answer> {
    let run = UncertaintyRun { threads: how.threads, samples: how.samples, cancel: how.cancel };
    match run.run(study, &mut |done, total, what| how.report(done, total, what))? {
        UncertaintyOutcome::Complete(found) => Ok(Answer { results: Results::Uncertainty(*found), stopped: None }),
        UncertaintyOutcome::Stopped(sentence) => Err(Stopped(sentence).into()),
    }
}
