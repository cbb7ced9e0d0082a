//! What `map` and `sweep` share: a plan is computed, its rows go to a file or to standard output, a summary is given.

pub(crate) mod again;
mod summary;

use crate::args::Format;
use crate::args::{EachArgs, OutputArgs, RunArgs};
use crate::errors::{self, Interrupted};
use crate::output::{self, Sink};
use crate::progress::Progress;
use crate::robot_file;
use crate::state;
use crate::table::counted;
use anyhow::{Context, Result, bail};
use funicular::robot::Robot;
use funicular::sweep::{Options, Outcome, Plan, Points};
use funicular_files::{Asked, Begin, CsvRows, Guard, Opened, Record, Source, SweepFile};
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
    pub(crate) robot_file: String,
    /// Robot file that is read.
    pub(crate) robot_path: &'a Path,
    /// File of poses that is read, if there is one.
    pub(crate) poses_path: Option<&'a Path>,
    pub(crate) points: &'a dyn Points,
    pub(crate) source: Source<'a>,
    pub(crate) point: &'a EachArgs,
    pub(crate) run: &'a RunArgs,
}

/// A robot of the file with what the options set.
pub(crate) fn adjusted(robot: Robot, point: &EachArgs) -> Result<Robot> {
    state::with_limits(&state::with_options(robot, &point.state)?, &point.tensions)
}

/// The options of every point.
pub(crate) fn options(robot: &Robot, point: &EachArgs) -> Result<Options> {
    let static_model = point.state.static_model.into();
    let rule = state::rule(&point.tensions)?;
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
        linearisation: state::linearisation(&point.model, static_model),
        highest_hz: point.what.up_to_hz,
    })
}

/// What was asked, for the files.
pub(crate) fn asked<'a>(options: &'a Options, point: &'a EachArgs) -> Asked<'a> {
    let EachArgs { what, state, tensions, .. } = point;
    Asked {
        options,
        quantities: &what.quantity,
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
    let options = options(job.robot, job.point)?;
    let asked = asked(&options, job.point);
    let plan = Plan::new(job.points, job.robot, asked.quantities, asked.options)?;
    let record = Record::of(&plan, job.robot_file.clone(), &job.robot.name, job.source, &asked, run.part);
    let threads = match run.threads {
        Some(threads) => threads,
        None => std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN),
    };
    match &run.output_file {
        Some(path) => to_file(job, &plan, record, path, threads),
        None if run.format == Some(Format::Csv) => to_stdout(&plan, threads),
        None => to_summary(job, &plan, threads),
    }
}

/// Rows counted, and forgotten.
fn to_summary(job: &Job, plan: &Plan, threads: NonZeroUsize) -> Result<()> {
    listen()?;
    let mut summary = Summary::new(job, plan.columns());
    let mut progress = Progress::with_rate(plan.rows(), "rows");
    let outcome = plan.run(0..plan.chunks(), threads, &STOPPED, |chunk| {
        progress.advance(chunk.rows());
        summary.add(&chunk);
        anyhow::Ok(())
    })?;
    drop(progress);
    refuse_stopped(plan, outcome)?;
    summary.print(job.run.format)
}

/// Rows that were kept nowhere, and are not all there.
fn refuse_stopped(plan: &Plan, outcome: Outcome) -> Result<()> {
    match outcome {
        Outcome::Complete => Ok(()),
        Outcome::Cancelled { next } => {
            let (done, rows) = ((next * plan.chunk_rows()).min(plan.rows()), plan.rows());
            Err(Interrupted(format!(
                "stopped after {done} of {rows} rows, which no file keeps: give -o to go on later"
            ))
            .into())
        }
    }
}

/// Rows as CSV, as they come.
fn to_stdout(plan: &Plan, threads: NonZeroUsize) -> Result<()> {
    listen()?;
    let write = || {
        let mut out = CsvRows::new(BufWriter::new(io::stdout().lock()), plan.columns())?;
        let outcome = plan.run(0..plan.chunks(), threads, &STOPPED, |chunk| out.add(&chunk))?;
        out.finish()?;
        Ok(outcome)
    };
    refuse_stopped(plan, write().map_err(output::of_stdout)?)
}

fn to_file(job: &Job, plan: &Plan, record: Record, path: &Path, threads: NonZeroUsize) -> Result<()> {
    refuse_output(job, path)?;
    let run = job.run;
    let begin = match (run.resume, run.discard) {
        (true, _) => Begin::Resume,
        (_, true) => Begin::Discard,
        _ => Begin::Anew,
    };
    let range = record.range();
    let rows = record.rows_of(range.clone());
    let mut work = match funicular_files::Job::open(path, record, begin)? {
        Opened::Done => {
            errors::note(&format!("{} holds all of {} already", path.display(), counted(rows, "row")));
            if run.format.is_none() {
                return Ok(());
            }
            let mut summary = Summary::new(job, plan.columns());
            SweepFile::open(path)?.each(|chunk| summary.add(chunk))?;
            return summary.print(run.format);
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
        let safe = work.interrupt()?;
        return Err(Interrupted(format!("stopped: {safe}; the same command with --resume goes on")).into());
    }
    work.finish()?;
    errors::note(&format!("{} in {}", counted(rows, "row"), path.display()));
    if run.format.is_some() { summary.print(run.format) } else { Ok(()) }
}

/// Refuses what is no place for rows, whatever its ending.
fn refuse_output(job: &Job, path: &Path) -> Result<()> {
    if path.as_os_str() == "-" {
        bail!("rows go to standard output with --format csv and without -o");
    }
    if job.run.format == Some(Format::Csv) {
        bail!("--format csv is for standard output: leave out -o, or give -o a name that ends in .csv");
    }
    let mut guard = robot_file::guard(Some(job.robot_path));
    if let Some(poses) = job.poses_path {
        guard.reads("the poses", poses);
    }
    Ok(guard.writes_rows("-o", path, true)?)
}

/// The sink of a summary.
fn sink(format: Option<Format>) -> Result<Sink> {
    Sink::open(&OutputArgs { format, output_file: None }, &mut Guard::default())
}
