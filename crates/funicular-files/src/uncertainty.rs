//! Uncertainty of results on several threads, with the sampled robots in a file that survives interruptions.

use crate::parquet::ParquetFile;
use crate::threads::{Outcome, in_order};
use crate::{Begin, FilesError, Job, Opened, SweepFile, WRITE_WITHIN};
use funicular_study::analyses::uncertainty::{SamplePlan, Samples, Uncertainties, UncertaintyStudy};
use funicular_study::table::Record;
use std::convert::Infallible;
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// End of the work.
pub enum UncertaintyOutcome {
    /// All results.
    Complete(Box<Uncertainties>),
    /// Sentence about work that was stopped.
    Stopped(String),
}

/// Way of computing the results.
pub struct UncertaintyRun<'a> {
    /// Number of threads; the results do not depend on it.
    pub threads: NonZeroUsize,
    /// File for the sampled robots, and the treatment of the work of an earlier run.
    pub samples: Option<(&'a Path, Begin)>,
    /// Flag that stops the work at its next step.
    pub cancel: &'a AtomicBool,
}

impl UncertaintyRun<'_> {
    /// Computes the deviations of a request. `progress` gets the number of finished items, of all items, and their
    /// name.
    ///
    /// # Errors
    /// More samples than the memory is for, or a file that cannot be written or belongs to other work.
    pub fn run(
        &self,
        study: &UncertaintyStudy,
        progress: &mut dyn FnMut(usize, usize, &'static str),
    ) -> anyhow::Result<UncertaintyOutcome> {
        // The poses with their linear deviations.
        let mut poses = Vec::with_capacity(study.poses());
        let linear = |pose: usize, given_up: &dyn Fn() -> bool| (!given_up()).then(|| study.linear(pose));
        let outcome = in_order(0..study.poses(), self.threads, self.cancel, linear, |pose| {
            poses.push(pose);
            progress(poses.len(), study.poses(), "poses");
            Ok::<(), Infallible>(())
        });
        if !matches!(outcome, Ok(Outcome::Complete)) {
            return Ok(UncertaintyOutcome::Stopped("stopped before the end".to_owned()));
        }

        // The robots that they need, from the file as far as it has them.
        let plan = study.plan(poses)?;
        let mut table = plan.table();
        let mut job = match self.samples {
            Some((path, begin)) if plan.rows() > 0 => match Job::open(path, plan.record()?, begin)? {
                Opened::Done => {
                    stored(path, plan.record()?, &mut table)?;
                    return Ok(UncertaintyOutcome::Complete(Box::new(plan.finish(&table))));
                }
                Opened::Work(job) => {
                    job.each(&mut |chunk| table.add(&chunk))?;
                    Some(job)
                }
            },
            _ => None,
        };
        let next = job.as_ref().map_or(0, |job| job.next());
        let outcome = self.robots(&plan, next, &mut table, job.as_deref_mut(), progress)?;

        match (outcome, job) {
            (Outcome::Complete, job) => {
                job.map_or(Ok(()), |job| job.finish())?;
                Ok(UncertaintyOutcome::Complete(Box::new(plan.finish(&table))))
            }
            (Outcome::Cancelled { .. }, Some(job)) => {
                let safe = job.interrupt(WRITE_WITHIN)?;
                Ok(UncertaintyOutcome::Stopped(format!("stopped: {safe}; continue with the same command and ⟪resume⟫")))
            }
            (Outcome::Cancelled { next }, None) => {
                let done = (next * plan.chunk_rows()).min(plan.rows());
                Ok(UncertaintyOutcome::Stopped(format!(
                    "stopped after {done} of {} robots, which are not stored: give ⟪samples_file⟫ to be able to \
                     continue later",
                    plan.rows()
                )))
            }
        }
    }

    /// Computes the robots from chunk `next` on.
    fn robots(
        &self,
        plan: &SamplePlan<'_>,
        next: usize,
        table: &mut Samples,
        mut job: Option<&mut Job>,
        progress: &mut dyn FnMut(usize, usize, &'static str),
    ) -> Result<Outcome, FilesError> {
        let (rows, chunk_rows) = (plan.rows(), plan.chunk_rows());
        let compute = |chunk: usize, given_up: &dyn Fn() -> bool| plan.evaluate(chunk, given_up);
        in_order(next..plan.chunks(), self.threads, self.cancel, compute, |chunk| {
            if let Some(job) = &mut job {
                job.add(&chunk)?;
            }
            table.add(&chunk);
            progress(((chunk.index + 1) * chunk_rows).min(rows), rows, "robots");
            Ok(())
        })
    }
}

/// Adds the robots of a complete file.
fn stored(path: &Path, record: Record, table: &mut Samples) -> Result<(), FilesError> {
    let file = ParquetFile::open(path)?;
    let (complete, rows) = (file.complete, file.rows);
    SweepFile::of_parts(file, record, complete, rows).each(|chunk| table.add(chunk))
}
