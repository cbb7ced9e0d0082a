//! `uncertainty`: run on all cores, text and CSV.

use crate::args::{Cli, OutputArgs, UncertaintyArgs};
use crate::errors::{self, Interrupted};
use crate::interrupt::{STOPPED, stop_at_next_row};
use crate::output::{Content, Printed, Sink, Target};
use crate::pose_csv;
use crate::progress::Progress;
use crate::table::{Table, counted, significant};
use anyhow::{Result, bail};
use funicular_files::endings::Kind;
use funicular_files::{Begin, Guard, UncertaintyOutcome, UncertaintyRun, threads};
use funicular_study::analyses::uncertainty::{PoseUncertainty, ResultAtPose, Uncertainties, UncertaintyStudy};
use funicular_study::request::{Request, UncertaintyRequest};
use funicular_study::wording::{Words, worded};
use serde_json::{Map, Value};
use std::fmt::Write as _;
use std::num::NonZeroUsize;
use std::path::Path;

/// Request of `uncertainty`. Errors of its poses name the line in the file of poses.
pub(super) fn request(cli: &Cli, further: Map<String, Value>) -> Result<Request> {
    let mut request = cli.request(further)?;
    if let Request::Uncertainty(of) = &mut request {
        of.poses = pose_csv::read_if_given(cli.files::<UncertaintyArgs>()?.poses.as_deref(), &of.robot)?;
    }
    Ok(request)
}

/// Runs `uncertainty`: prints the deviations, writes the samples and the page.
pub(super) fn run(of: &UncertaintyRequest, args: &UncertaintyArgs, guard: &mut Guard) -> Result<()> {
    if let Some(poses) = &args.poses {
        guard.reads("the poses", poses);
    }

    // -o may name the page.
    let output = args.sink.output_file.as_deref();
    let is_page = args.sink.format.is_none() && output.and_then(Kind::of) == Some(Kind::Html);
    let page = match (&args.page, output.filter(|_| is_page)) {
        (Some(_), Some(_)) => bail!("⟪page⟫ and -o name a page each: leave out one of them"),
        (option, by_ending) => option.as_deref().or(by_ending),
    };
    let printed =
        OutputArgs { format: args.sink.format, output_file: args.sink.output_file.clone().filter(|_| !is_page) };
    let sink = Sink::open(&printed, &[Kind::Html], guard)?;
    let page =
        page.map(|path| Ok::<_, anyhow::Error>((Target::open(Some(path), Content::PAGE, guard)?, path))).transpose()?;
    let begin = Begin::of(args.resume, args.discard);
    if let Some(path) = &args.samples_file {
        guard.writes_rows(path, true)?;
    }

    let found = compute(of, args.threads, args.samples_file.as_deref().map(|path| (path, begin)))?;
    sink.write(&found)?;
    if let Some((target, path)) = page {
        let page = funicular_pages::pages::uncertainty::page(&found, super::page::command_line()?)?;
        target.write(worded(&page, Words::Program).as_bytes())?;
        errors::note(&format!("wrote {}", path.display()));
    }
    if let Some(path) = args.samples_file.as_ref().filter(|_| found.evaluations > 0) {
        errors::note(&format!("{} in {}", counted(found.evaluations, "robot"), path.display()));
    }
    Ok(())
}

/// Runs a request and prints its results.
pub(super) fn print(of: &UncertaintyRequest, output: &OutputArgs, guard: &mut Guard) -> Result<()> {
    let sink = Sink::open(output, &[], guard)?;
    sink.write(&compute(of, None, None)?)
}

/// Computes the deviations on all cores.
fn compute(
    of: &UncertaintyRequest,
    threads: Option<NonZeroUsize>,
    samples: Option<(&Path, Begin)>,
) -> Result<Uncertainties> {
    let study = UncertaintyStudy::new(of)?;
    let otherwise = match samples {
        Some((path, _)) => format!(
            "stopped: the finished robots are safe beside {}; continue with the same command and --resume",
            path.display()
        ),
        None => "stopped, and the robots are not stored: give --samples-file to be able to continue later".to_owned(),
    };
    stop_at_next_row(Some(otherwise))?;
    let mut bar: Option<(Progress, &'static str, usize)> = None;
    let mut progress = |done: usize, total: usize, what: &'static str| {
        if bar.as_ref().is_none_or(|(_, shown, _)| *shown != what) {
            bar = Some((Progress::with_rate(total, what), what, 0));
        }
        if let Some((bar, _, before)) = &mut bar {
            bar.advance(done - *before);
            *before = done;
        }
    };
    let run = UncertaintyRun { threads: threads::or_all(threads), samples, cancel: &STOPPED };

    match run.run(&study, &mut progress)? {
        UncertaintyOutcome::Complete(found) => Ok(*found),
        UncertaintyOutcome::Stopped(sentence) => Err(Interrupted(worded(&sentence, Words::Program)).into()),
    }
}

impl Printed for Uncertainties {
    fn text(&self) -> String {
        let groups: Vec<String> =
            self.groups.iter().map(|group| format!("{} ({})", group.name, counted(group.count, "number"))).collect();
        let numbers = if self.inputs.len() == 1 { "deviates" } else { "deviate" };
        let mut out = format!(
            "{}: deviations of results from {} that {numbers}\n{}\nHeld: {}.\nGroups: {}.\n",
            self.robot,
            counted(self.inputs.len(), "number"),
            self.models.line(),
            self.held_means,
            groups.join(", ")
        );
        if let Some(of) = &self.response {
            let _ = writeln!(out, "Response: {} to {}; magnitudes in dB of 1 {}.", of.output, of.input, of.unit);
        }
        for (i, pose) in self.poses.iter().enumerate() {
            out += &pose_text(self, i, pose);
        }
        if !self.notes.is_empty() {
            out.push('\n');
        }
        for note in &self.notes {
            let _ = writeln!(out, "{note}.");
        }
        out
    }
}

/// Text about the results at one pose: their table, and doubts.
fn pose_text(of: &Uncertainties, i: usize, pose: &PoseUncertainty) -> String {
    let mut out = String::new();
    if of.poses.len() > 1 {
        let place = pose.position_m.iter().chain(&pose.roll_pitch_yaw_deg).flatten();
        let place: Vec<String> = place.map(|value| significant(*value, 4)).collect();
        let _ = write!(out, "\nPose {}", i + 1);
        if !place.is_empty() {
            let _ = write!(out, ": {}", place.join(", "));
        }
        out.push('\n');
    }
    if let Some(reason) = &pose.reason {
        let _ = writeln!(out, "no results: {reason}");
        return out;
    }

    let columns = ResultAtPose::columns(&of.groups, pose.results.iter().any(|result| result.worst.is_some()));
    let _ = write!(out, "\n{}", Table::of(&columns, ResultAtPose::all(of, i, 1)));

    // Each reason once.
    let mut reasons: Vec<&str> = Vec::new();
    for reason in pose.results.iter().filter_map(|result| result.sampling_reason.as_deref()) {
        if !reasons.contains(&reason) {
            reasons.push(reason);
        }
    }
    if !reasons.is_empty() || pose.failed.is_some() {
        out.push('\n');
    }
    for reason in reasons {
        let _ = writeln!(out, "Not linear: {reason}.");
    }
    if let Some(failed) = &pose.failed {
        let _ =
            writeln!(out, "{} without results; the first: {}.", counted(failed.count, "sampled robot"), failed.reason);
    }
    out
}
