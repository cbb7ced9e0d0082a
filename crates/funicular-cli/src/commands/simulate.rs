//! `simulate`: scenario, text and CSV. A run that is killed leaves the rows so far beside its file.

mod partial;

use super::result_files::{OtherFile, ResultFiles};
use crate::args::{Cli, DrawArgs, OutputArgs, SimulateArgs};
use crate::number_table;
use crate::output::{FigureSink, Printed};
use crate::progress::TerminalProgress;
use crate::read_files;
use crate::table::{Table, counted, significant};
use anyhow::{Context, Result};
use funicular_files::Begin;
use funicular_files::Guard;
use funicular_pages::figures;
use funicular_study::Cancelled;
use funicular_study::analyses::simulate::{self, ColumnError, Peak, RowNames, Simulated, SimulatedRow, StretchLossRow};
use funicular_study::request::{Request, Scenario, SimulateRequest};
use funicular_study::wording::{Words, worded};
use partial::PartialRows;
use serde_json::{Map, Value};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Rows that the table shows.
const SHOWN: usize = 21;

/// Request of a simulation. Errors of its scenario name the file.
pub(super) fn request(cli: &Cli, further: Map<String, Value>) -> Result<Request> {
    let mut request = cli.request(further)?;
    let files = cli.files::<SimulateArgs>()?;
    if let (Request::Simulate(of), Some(path)) = (&mut request, &files.scenario) {
        of.scenario = scenario(path)?;
    }
    Ok(request)
}

/// Reads a scenario and the tables that it names.
pub(super) fn scenario(path: &Path) -> Result<Scenario> {
    let shown = path.display();
    let text = fs::read_to_string(path).with_context(|| format!("cannot read the scenario {shown}"))?;
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let table = |name: &str| {
        let path = folder.join(name);
        read_files::note("the table", &path);
        number_table::read(&path, "the table", |_| Ok(()))
    };
    simulate::scenario_from_toml(&text, table).with_context(|| format!("the scenario {shown}"))
}

/// Runs `simulate`. Rows of a CSV file are written as they become ready.
pub(super) fn run(of: &SimulateRequest, args: &SimulateArgs, guard: &mut Guard) -> Result<()> {
    if let Some(path) = &args.scenario {
        guard.reads("the scenario", path);
    }
    // Errors of the robot file are reported before errors of the destination.
    let robot = of.robot.read()?.robot;
    let DrawArgs { output, figure } = &args.drawn;
    let path = output.output_file.as_deref().filter(|_| output.format.is_none());
    let drawn = FigureSink::open(path, *figure, guard)?;
    // With a figure the result is printed.
    let output_file = output.output_file.clone().filter(|_| drawn.is_none());
    let printed = OutputArgs { format: output.format, output_file };
    let animation = OtherFile::animation(args.animation.as_deref());
    let files = ResultFiles::open(&printed, animation, args.page.as_deref(), guard)?;
    let names = RowNames::of(&robot, &of.point);
    let earlier = Begin::of(args.resume, args.discard);
    let (mut partial, begun) = PartialRows::beside(printed.output_file.as_deref(), of, names, earlier, guard)?;

    let mut watch = TerminalProgress::new();
    let found = simulate::run_with(robot, of, &mut watch, &mut partial, begun)?;
    drop(watch);
    if let Some(drawn) = drawn {
        drawn.write(&figures::of_simulation(&found))?;
    }
    files.write(
        &found,
        || Ok(figures::animation_of_simulation(&found).into_bytes()),
        || {
            let page = funicular_pages::pages::simulate::page(&found, super::page::command_line()?)?;
            Ok(worded(&page, Words::Program))
        },
    )?;
    partial.remove();
    if found.stopped_at_s.is_some() { Err(Cancelled.into()) } else { Ok(()) }
}

impl Printed for Simulated {
    fn text(&self) -> String {
        let columns = SimulatedRow::columns(&self.names());
        let step = self.rows.len().div_ceil(SHOWN).max(1);
        let shown = self.rows.iter().step_by(step);
        let table = Table::of(&columns, shown.clone());
        let mut text = format!(
            "{}: simulation of {} s{}\n{} of degree {} in each rope, tolerance {} m, {}\n",
            self.robot,
            significant(self.duration_s, 5),
            self.origin.phrase(),
            counted(self.elements, "element"),
            self.degree,
            significant(self.tolerance_m, 3),
            counted(self.steps.accepted, "step"),
        );
        if let Some(time) = self.stopped_at_s {
            let _ = writeln!(text, "STOPPED at {} s", significant(time, 5));
        }
        for cut in &self.cuts {
            let _ = writeln!(text, "cable \"{}\" fails at {} s", cut.cable, significant(cut.t_s, 5));
        }
        for slack in &self.slack {
            let (first, share) = (significant(slack.first_s, 4), significant(100.0 * slack.share, 3));
            let _ = writeln!(text, "cable \"{}\" is slack from {first} s on, for {share} % of the time", slack.cable);
        }
        if let Some(nearest) = &self.nearest {
            let _ = writeln!(text, "{}", nearest.in_words());
        }
        let _ = write!(text, "\n{table}\n{} of {} shown.\n", shown.len(), counted(self.rows.len(), "row"));
        if !self.stretch_losses.is_empty() {
            let losses = Table::of(&StretchLossRow::columns(), &self.stretch_losses);
            let _ =
                write!(text, "\nDamping ratios by the loss of the stretch, by the robot file and in time\n{losses}");
        }
        let _ = write!(text, "\nLargest tensions\n{}", Table::of(&Peak::columns(), &self.peaks));
        if self.errors.is_empty() {
            let _ = writeln!(text, "\nThe error is not known: no finer run came to its end.");
        } else {
            let _ = write!(
                text,
                "\nErrors, at most, by a run with a finer mesh and tolerance\n{}",
                Table::of(&ColumnError::columns(), &self.errors)
            );
        }
        let _ = writeln!(text, "Energy is off by at most {} J.", significant(self.energy_defect_j, 2));
        text
    }
}
