//! Execution of `map` and `sweep`: writes rows to a file or to standard output, and a summary.

mod summary;

use crate::args::{Format, OutputArgs, RunArgs};
use crate::errors;
use crate::interrupt::{STOPPED, stop_at_next_row};
use crate::output::{self, Sink};
use crate::progress::Progress;
use crate::table::counted;
use anyhow::{Result, bail};
use funicular_answers::Stopped;
use funicular_answers::outputs::told;
use funicular_files::endings::Kind;
use funicular_files::{Begin, CsvRows, Guard, Opened, Outcome, SweepFile, threads};
use funicular_study::Request;
use funicular_study::sweep::{Plan, PreparedSweep};
use funicular_study::table::Record;
use std::io::{self, BufWriter};
use std::num::NonZeroUsize;
use std::path::Path;
use summary::Summary;

/// Sweep to run.
struct Job<'a> {
    sweep: &'a PreparedSweep,
    run: &'a RunArgs,
}

/// Computes all rows. The guard knows the files that are read, so that the rows do not overwrite them.
pub(crate) fn run(request: &Request, guard: &mut Guard, run: &RunArgs) -> Result<()> {
    let sweep = PreparedSweep::new(request)?;
    let job = &Job { sweep: &sweep, run };
    let plan = sweep.plan()?;
    let record = sweep.record(&plan, run.part);
    let threads = threads::or_all(run.threads.threads);
    match &run.output_file {
        Some(path) => {
            refuse_output(job, guard, path)?;
            to_file(job, &plan, record, path, threads)
        }
        None if run.stored.resume || run.stored.discard => {
            bail!("⟪resume⟫ and ⟪discard⟫ are about rows in a file: give -o FILE.parquet, .csv or .vti")
        }
        None if run.format == Some(Format::Csv) => {
            warn(job);
            to_stdout(&plan, threads)
        }
        None => to_summary(job, &plan, threads),
    }
}

/// Computes the rows for the summary alone.
fn to_summary(job: &Job, plan: &Plan, threads: NonZeroUsize) -> Result<()> {
    stop_at_next_row(Some(NOT_STORED.to_owned()))?;
    let mut summary = Summary::new(job, plan.columns());
    let mut progress = Progress::with_rate(plan.rows(), "rows");
    let outcome = threads::run(plan, 0..plan.chunks(), threads, &STOPPED, |chunk| {
        progress.advance(chunk.rows());
        summary.add(&chunk);
        anyhow::Ok(())
    })?;
    drop(progress);
    refuse_stopped(plan, outcome)?;
    summary.print(job.run.format)
}

/// Message of a run that ends within a row, if its rows are not stored.
const NOT_STORED: &str = "stopped, and the rows are not stored: give -o to be able to continue later";

/// Error of an interrupted run whose rows are not stored.
fn refuse_stopped(plan: &Plan, outcome: Outcome) -> Result<()> {
    match outcome {
        Outcome::Complete => Ok(()),
        Outcome::Cancelled { next } => {
            let (done, rows) = ((next * plan.chunk_rows()).min(plan.rows()), plan.rows());
            Err(Stopped(format!(
                "stopped after {done} of {rows} rows, which are not stored: give -o to be able to continue later"
            ))
            .into())
        }
    }
}

/// Writes the rows as CSV as they are computed.
fn to_stdout(plan: &Plan, threads: NonZeroUsize) -> Result<()> {
    stop_at_next_row(Some(NOT_STORED.to_owned()))?;
    let write = || {
        let mut out = CsvRows::new(BufWriter::new(io::stdout().lock()), plan.columns())?;
        let outcome = threads::run(plan, 0..plan.chunks(), threads, &STOPPED, |chunk| out.add(&chunk))?;
        out.finish()?;
        Ok(outcome)
    };
    refuse_stopped(plan, write().map_err(output::of_stdout)?)
}

fn to_file(job: &Job, plan: &Plan, record: Record, path: &Path, threads: NonZeroUsize) -> Result<()> {
    let run = job.run;
    // A file of rows as CSV says nothing of a summary.
    let format = run.format.filter(|format| *format != Format::Csv);
    let begin = Begin::of(run.stored.resume, run.stored.discard);
    let range = record.range();
    let rows = record.rows_of(range.clone());

    let opened = funicular_files::Job::open(path, record, begin)?;
    // Before the rows, so that a slip can be corrected before hours of work.
    if format.is_none() {
        warn(job);
    }
    let mut work = match opened {
        Opened::Done => {
            errors::note(&format!("{} already contains all of {}", path.display(), counted(rows, "row")));
            if format.is_none() {
                return Ok(());
            }
            let mut summary = Summary::new(job, plan.columns());
            SweepFile::open(path)?.each(|chunk| summary.add(chunk))?;
            return summary.print(format);
        }
        Opened::Work(work) => work,
    };
    let journal = work.journal().display();
    let safe = format!("the finished rows are safe in {journal}");
    stop_at_next_row(Some(format!("stopped: {safe}; continue with the same command and --resume")))?;
    let mut summary = Summary::new(job, plan.columns());

    if work.done() > 0 {
        errors::note(&format!("continuing after {} of {rows} rows", work.done()));
        work.each(&mut |chunk| summary.add(&chunk))?;
    }

    let mut progress = Progress::with_rate(rows - work.done(), "rows");
    let outcome = threads::run(plan, work.next()..range.end, threads, &STOPPED, |chunk| {
        work.add(&chunk)?;
        progress.advance(chunk.rows());
        summary.add(&chunk);
        anyhow::Ok(())
    })?;
    drop(progress);

    if outcome != Outcome::Complete {
        let safe = work.interrupt(funicular_files::WRITE_WITHIN)?;
        return Err(Stopped(format!("stopped: {safe}; continue with the same command and --resume")).into());
    }

    work.finish()?;
    errors::note(&told(path, Some(&counted(rows, "row"))));
    if format.is_some() { summary.print(format) } else { Ok(()) }
}

/// Prints the warnings about the robot, once per run. A summary has them in its own place.
fn warn(job: &Job) {
    job.sweep.warnings().iter().for_each(|warning| errors::warn(warning));
}

/// Refuses a destination that cannot hold rows.
fn refuse_output(job: &Job, guard: &mut Guard, path: &Path) -> Result<()> {
    if path.as_os_str() == "-" {
        bail!("rows go to standard output with --format csv and without -o");
    }
    if job.run.format == Some(Format::Csv) && Kind::of(path) != Some(Kind::Csv) {
        bail!("--format csv and the ending of -o contradict each other: give -o a name that ends in .csv");
    }
    Ok(guard.writes_rows(path, true)?)
}

/// Destination of a summary.
fn sink(format: Option<Format>) -> Result<Sink> {
    Sink::open(&OutputArgs { format, output_file: None, quiet: false }, &[], &mut Guard::default())
}
