//! What `map` and `sweep` share: a plan is computed, its rows go to a file or to standard output, a summary is given.

pub(crate) mod again;
mod summary;

use crate::args::Format;
use crate::args::{ModelArgs, OutputArgs, RunArgs, StateArgs, TensionArgs, WhatArgs};
use crate::errors::{self, Interrupted};
use crate::output::Sink;
use crate::progress::Progress;
use crate::state;
use anyhow::{Context, Result, bail};
use funicular::robot::Robot;
use funicular::sweep::{Options, Outcome, Plan, Points, Quantity};
use funicular_files::{Asked, Begin, CsvRows, Opened, Record, Source};
use std::io::{self, BufWriter};
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use summary::Summary;

/// A sweep to run.
pub(crate) struct Job<'a> {
    pub(crate) command: &'static str,
    /// One of its robots.
    pub(crate) robot: &'a Robot,
    pub(crate) robot_path: &'a Path,
    pub(crate) robot_file: String,
    pub(crate) points: &'a dyn Points,
    pub(crate) source: Source<'a>,
    pub(crate) asked: Asked<'a>,
    pub(crate) run: &'a RunArgs,
}

/// The options of every point.
pub(crate) fn options(
    robot: &Robot,
    state: &StateArgs,
    tensions: &TensionArgs,
    model: &ModelArgs,
    what: &WhatArgs,
) -> Result<Options> {
    let static_model = state.static_model.into();
    let rule = state::rule(tensions)?;
    let (cables, freedoms) = (robot.cables.len(), robot.platform.freedoms.count());
    if rule.is_some() && cables <= freedoms {
        bail!(
            "a tension rule has nothing to choose: {cables} cables for {freedoms} freedoms have one set of tensions at a \
             pose; leave out --tension-rule and --wanted-tension-n"
        );
    }
    Ok(Options {
        static_model,
        tension_rule: rule.unwrap_or_default(),
        linearisation: state::linearisation(model, static_model),
        highest_hz: what.up_to_hz,
    })
}

/// What was asked, for the files.
pub(crate) fn asked<'a>(
    options: &'a Options,
    state: &'a StateArgs,
    tensions: &'a TensionArgs,
    quantities: &'a [Quantity],
) -> Asked<'a> {
    Asked {
        options,
        quantities,
        wanted_tension_n: tensions.wanted_tension_n.as_ref().map(|wanted| &wanted.0[..]),
        min_tension_n: tensions.min_tension_n,
        max_tension_n: tensions.max_tension_n,
        pose: state.pose.map(|pose| {
            let ([x, y, z], [roll, pitch, yaw]) = (pose.position, pose.roll_pitch_yaw_deg);
            [x, y, z, roll, pitch, yaw]
        }),
        lengths_m: state.lengths_m.as_ref().map(|lengths| &lengths.0[..]),
        mass_kg: state.mass_kg,
        force_n: state.load.force_n,
        moment_n_m: state.load.moment_n_m,
        load_point_m: state.load.load_point_m,
        wind_m_s: state.load.wind_m_s,
        cable_load_n_per_m: state.load.cable_load_n_per_m,
    }
}

/// Raised by Ctrl-C or by the system that ends a job.
static STOPPED: AtomicBool = AtomicBool::new(false);

/// Stops at the next point when asked; at once when asked again.
fn listen() -> Result<()> {
    ctrlc::set_handler(|| {
        if STOPPED.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    })
    .context("cannot listen for Ctrl-C")
}

/// Computes all of it.
pub(crate) fn run(job: &Job) -> Result<()> {
    let Job { run, .. } = job;
    let plan = Plan::new(job.points, job.robot, job.asked.quantities, job.asked.options)?;
    let record = Record::of(&plan, job.robot_file.clone(), &job.robot.name, job.source, &job.asked, run.part);
    let threads = match run.threads {
        Some(threads) => threads,
        None => std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN),
    };
    match &run.output_file {
        Some(path) => to_file(job, &plan, record, path, threads),
        None if run.format == Some(Format::Csv) => to_stdout(&plan, threads),
        None => {
            listen()?;
            let mut summary = Summary::new(job, plan.columns());
            let mut progress = Progress::with_rate(plan.rows(), "rows");
            let outcome = plan.run(0..plan.chunks(), threads, &STOPPED, |chunk| {
                progress.advance(chunk.rows());
                summary.add(&chunk);
                anyhow::Ok(())
            })?;
            drop(progress);
            if outcome != Outcome::Complete {
                return Err(Interrupted(format!("stopped after {} of {} rows", summary.rows, plan.rows())).into());
            }
            summary.print(run.format)
        }
    }
}

/// Rows as CSV, as they come.
fn to_stdout(plan: &Plan, threads: NonZeroUsize) -> Result<()> {
    listen()?;
    let mut out = CsvRows::new(BufWriter::new(io::stdout().lock()), plan.columns())?;
    let outcome = plan.run(0..plan.chunks(), threads, &STOPPED, |chunk| out.add(&chunk))?;
    // An error is kept bare: whoever reads may have seen enough.
    out.finish()?;
    match outcome {
        Outcome::Complete => Ok(()),
        Outcome::Cancelled { next } => {
            let done = (next * plan.chunk_rows()).min(plan.rows());
            Err(Interrupted(format!("stopped after {done} of {} rows", plan.rows())).into())
        }
    }
}

fn to_file(job: &Job, plan: &Plan, record: Record, path: &Path, threads: NonZeroUsize) -> Result<()> {
    let run = job.run;
    if run.format == Some(Format::Csv) {
        bail!("--format csv is for standard output: leave out -o, or give -o a name that ends in .csv");
    }
    if path.canonicalize().ok().is_some_and(|to| job.robot_path.canonicalize().is_ok_and(|from| from == to)) {
        bail!("refusing to write the result over the robot file {}; choose another name for -o", path.display());
    }
    let begin = match (run.resume, run.discard) {
        (true, _) => Begin::Resume,
        (_, true) => Begin::Discard,
        _ => Begin::Anew,
    };
    let range = record.range();
    let rows = record.rows_of(range.clone());
    let mut work = match funicular_files::Job::open(path, record, begin)? {
        Opened::Done => {
            errors::note(&format!("{} holds all {rows} rows already", path.display()));
            return Ok(());
        }
        Opened::Work(work) => work,
    };
    listen()?;
    let mut summary = Summary::new(job, plan.columns());
    if work.done() > 0 {
        errors::note(&format!("going on behind {} of {rows} rows", work.done()));
        work.each(&mut |chunk| summary.add(&chunk))?;
    }
    let mut progress = Progress::with_rate(rows - work.done(), "rows");
    let outcome = plan.run(work.next()..range.end, threads, &STOPPED, |chunk| {
        work.add(&chunk)?;
        progress.advance(chunk.rows());
        summary.add(&chunk);
        anyhow::Ok(())
    })?;
    drop(progress);
    if outcome != Outcome::Complete {
        let (done, journal) = (work.done(), work.journal().display().to_string());
        let written = if work.interrupt()? {
            format!("; {} has them, marked as incomplete", path.display())
        } else {
            String::new()
        };
        return Err(Interrupted(format!(
            "stopped: {done} of {rows} rows are safe in {journal}{written}; the same command with --resume goes on"
        ))
        .into());
    }
    work.finish()?;
    errors::note(&format!("{rows} rows in {}", path.display()));
    if run.format.is_some() { summary.print(run.format) } else { Ok(()) }
}

/// The sink of a summary.
fn sink(format: Option<Format>) -> Result<Sink> {
    Sink::open(&OutputArgs { format, output_file: None }, None)
}
