//! Page with figures of a map or sweep.

mod curves;
mod figure;
mod rows;
mod slices;
mod tracking;

pub use figure::{SweepFigure, SweepFigureChoice, figure};

use super::Shell;
use super::figure::PageFigure;
use super::table::{PageTable, significant};
use anyhow::{Context as _, bail};
use askama::Template;
use funicular::modes::Mode;
use funicular_study::Cancelled;
use funicular_study::Watch;
use funicular_study::sweep::CODES;
use funicular_study::table::SweepRows;
use funicular_study::text::{counted, short};
use rows::{Rows, label, robot_name, with_unit};
use slices::Slices;

/// Input of a page.
struct PlotInput<'a> {
    /// Rows of the map or sweep.
    file: &'a dyn SweepRows,
    /// Path or description of the rows.
    label: String,
    /// Command that writes the page again.
    command_line: String,
    /// Modes of every row followed along the sweep, or the reason why they are not followed.
    tracking: Option<Result<Tracking, String>>,
}

/// Modes of the rows of a file, with the branch of each mode.
struct Tracking {
    /// Modes per row in ascending order; empty for a row without modes.
    modes: Vec<Vec<Mode>>,
    /// Branches from [`funicular::modes::tracking::track`].
    branches: Vec<Vec<usize>>,
}

/// Page of a map or sweep, with its notes.
pub struct Page {
    /// HTML text.
    pub html: String,
    /// Notes for the user, one sentence each; they are also on the page.
    pub notes: Vec<String>,
}

const CONTENTS: &[(&str, &str)] =
    &[("numbers", "Numbers"), ("pictures", "Figures"), ("feasible", "Feasibility"), ("repeat", "How to repeat")];

#[derive(Template)]
#[template(path = "plot.html")]
struct PlotPage<'a> {
    shell: Shell,
    key: Vec<(&'static str, String)>,
    notes: &'a [String],
    numbers: PageTable,
    statuses: PageTable,
    slices: Option<Slices>,
    curves: Vec<PageFigure>,
    robot_text: &'a str,
    /// Plan of the rows as in the file.
    plan: String,
    label: &'a str,
    command_line: &'a str,
}

/// Writes the page of a map or sweep. `label` names the place of the rows, `command_line` is the command that writes
/// the page again.
///
/// # Errors
/// A damaged file, a file without rows, or work that was stopped.
pub fn plot(rows: &dyn SweepRows, label: String, command_line: String, watch: &mut dyn Watch) -> anyhow::Result<Page> {
    refuse_no_rows(rows, &label)?;
    let tracking = tracking::tracking(rows, watch);
    if watch.is_cancelled() {
        return Err(Cancelled.into());
    }
    page(&PlotInput { file: rows, label, command_line, tracking })
}

/// Refuses a file without rows, whose page would be empty.
fn refuse_no_rows(file: &dyn SweepRows, label: &str) -> anyhow::Result<()> {
    if file.rows() > 0 {
        return Ok(());
    }
    match file.record().part.filter(|_| file.is_complete()) {
        Some(part) => bail!(
            "{label} is part {part} of {} and holds none of them: merge all parts with `funicular merge` and plot the \
             result",
            counted(file.record().rows, "row")
        ),
        None => bail!("{label} has no rows yet: continue the sweep with ⟪resume⟫"),
    }
}

fn page(input: &PlotInput) -> anyhow::Result<Page> {
    let record = input.file.record();
    let rows = Rows::read(input.file)?;
    let mut notes = notes(input, &rows);
    let robot = robot_name(&record.plan);

    let is_sweep = record.plan.get("command").is_some_and(|command| command == "sweep");
    let (slices, curves) = if rows.axes.len() >= 2 {
        (Some(Slices::new(&rows, is_sweep)), Vec::new())
    } else {
        let tracking = match &input.tracking {
            Some(Ok(tracking)) => curves::checked(tracking, &rows).map(Some),
            Some(Err(reason)) => Err(reason.clone()),
            None => Ok(None),
        };
        if let Err(reason) = &tracking {
            notes.push(format!("the modes are not followed; frequencies are joined in ascending order: {reason}"));
        }
        (None, curves::figures(&rows, tracking.ok().flatten()))
    };

    let what = if is_sweep { "sweep" } else { "map" };
    let page = PlotPage {
        shell: Shell::new(format!("{robot}: {what}"), CONTENTS),
        key: key(&rows),
        notes: &notes,
        numbers: numbers(&rows),
        statuses: statuses(&rows),
        slices,
        curves,
        robot_text: &record.robot_file,
        plan: serde_json::to_string_pretty(&record.plan).context("the plan could not be written")?,
        label: &input.label,
        command_line: &input.command_line,
    };

    let html = page.render().context("the page could not be written as HTML")?;
    Ok(Page { html, notes })
}

/// Notes on missing rows and on reduced data.
fn notes(input: &PlotInput, rows: &Rows) -> Vec<String> {
    let mut notes = Vec::new();
    if !input.file.is_complete() {
        notes.push(format!(
            "the file is incomplete: it has {} of {} rows; repeat the command that began it with ⟪resume⟫",
            rows.rows, rows.planned
        ));
    } else if let Some(part) = input.file.record().part {
        notes.push(format!(
            "the file is part {part}: {} of {} rows; funicular merge joins all parts to one file",
            rows.rows, rows.planned
        ));
    }

    let thinned: Vec<String> = rows
        .axes
        .iter()
        .filter(|axis| axis.every > 1)
        .map(|axis| format!("{} of {} values of {}", axis.kept(), axis.steps.count(), axis.name))
        .collect();
    if !thinned.is_empty() {
        notes.push(format!(
            "the slices and the points in space show {} ({} of {} rows) to limit the size of the page; histograms, \
             counts, minima and maxima are those of all rows",
            thinned.join(", "),
            rows.shown(),
            rows.planned
        ));
    } else if rows.axes.len() < 2 && rows.shown() < rows.rows {
        notes.push(format!(
            "the curves show {} of {} rows to limit the size of the page; counts, minima and maxima are those of all \
             rows",
            rows.shown(),
            rows.rows
        ));
    }

    if !rows.requested_words.is_empty() {
        notes.push(format!("no figure for {}: the values are words, not numbers", rows.requested_words.join(", ")));
    }
    notes
}

fn key(rows: &Rows) -> Vec<(&'static str, String)> {
    let share = 100.0 * rows.feasible as f64 / rows.rows.max(1) as f64;
    let mut key =
        vec![("rows", rows.rows.to_string()), ("feasible", format!("{} ({} %)", rows.feasible, significant(share, 3)))];

    let range = |axis: &rows::PlotAxis| {
        let ends = [axis.steps.at(0), axis.steps.at(axis.steps.count() - 1)].map(brief);
        format!(
            "{} {} to {}, {}",
            axis_title(&axis.name, &axis.unit),
            ends[0],
            ends[1],
            counted(axis.steps.count(), "value")
        )
    };

    if rows.is_list {
        key.push(("points", "a list of poses".to_owned()));
    } else if !rows.axes.is_empty() {
        key.push(("varies", rows.axes.iter().map(range).collect::<Vec<_>>().join("; ")));
    }

    let fixed = rows.fixed.iter().map(|(name, unit, value)| match unit.as_str() {
        "deg" => format!("{name} = {}°", brief(*value)),
        unit => format!("{name} = {} {unit}", brief(*value)),
    });
    let fixed: Vec<String> = fixed.collect();
    if !fixed.is_empty() {
        key.push(("fixed", fixed.join(", ")));
    }
    key
}

/// Number with at most four digits and without trailing zeros. A rounding error around zero becomes zero.
fn brief(value: f64) -> String {
    const ROUNDING: f64 = 1e-12;
    short(if value.abs() < ROUNDING { 0.0 } else { value }, 4).replace('-', "−")
}

/// Title of an axis with its unit, such as `x [m]` or `platform mass [kg]`.
fn axis_title(name: &str, unit: &str) -> String {
    // The key of a value in the robot file ends with its unit.
    let ending = format!("_{}", unit.replace('/', "_per_").replace(' ', "_"));
    let stem = name.strip_suffix(&ending).unwrap_or(name);
    with_unit(&stem.replace(['.', '_'], " ").replace(['"', '\''], ""), unit)
}

/// Table of the minimum and maximum of every quantity, with their places.
fn numbers(rows: &Rows) -> PageTable {
    let place = |row: usize| {
        if rows.axes.is_empty() {
            return format!("row {}", row + 1);
        }
        if let ([axis], [value]) = (&rows.axes[..], &rows.at(row)[..]) {
            let unit = if axis.unit == "1" { "" } else { &axis.unit };
            return format!("{} {unit}", brief(*value)).trim_end().to_owned();
        }
        let parts = rows.axes.iter().zip(rows.at(row));
        let parts: Vec<String> =
            parts.map(|(axis, value)| format!("{}\u{a0}=\u{a0}{}", axis.name, brief(value))).collect();
        parts.join(", ")
    };

    let mut table = PageTable::new(
        "table-numbers",
        "All quantities: number of rows with a value, minimum and maximum, and the first row with each of them.",
        &["<quantity", "<unit", "rows", "min", "<<at", "max", "<<at", "<<meaning"],
    );

    for series in &rows.series {
        let unit = if series.unit == "1" { "–" } else { &series.unit };
        let mut cells = vec![label(&series.name), unit.to_owned(), series.count.to_string()];
        if series.count == 0 {
            cells.extend(["–"; 4].map(str::to_owned));
        } else {
            cells.extend([significant(series.min.0, 5), place(series.min.1)]);
            cells.extend([significant(series.max.0, 5), place(series.max.1)]);
        }
        cells.push(series.about.clone());

        table.row(cells);
    }
    table
}

/// Table of the number of rows per status.
fn statuses(rows: &Rows) -> PageTable {
    let mut table = PageTable::new(
        "table-status",
        "Number of rows per status, with the reason given for the first of them.",
        &["<status", "rows", "<<meaning", "<<first reason"],
    );
    for count in &rows.counts {
        let (code, meaning) = status(count.code);
        table.row(vec![code.to_owned(), count.rows.to_string(), meaning.to_owned(), count.first_reason.clone()]);
    }
    let missing = rows.planned - rows.rows;
    if missing > 0 {
        table.row(vec!["–".to_owned(), missing.to_string(), "not in this file".to_owned(), String::new()]);
    }
    table
}

/// Status with its meaning.
fn status(code: u8) -> (&'static str, &'static str) {
    CODES.get(usize::from(code)).copied().unwrap_or(("unknown", "a status of another version"))
}
