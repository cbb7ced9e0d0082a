//! A map or sweep in pictures.

mod curves;
mod rows;
mod slices;
mod tracking;

use super::Shell;
use super::figure::Figure;
use super::table::{Table, significant};
use crate::Watch;
use crate::sweep::{CODES, SweepRows};
use crate::text::{counted, short};
use anyhow::{Context as _, bail};
use askama::Template;
use funicular::modes::Mode;
use rows::{Rows, label, robot_name, with_unit};
use slices::Slices;

/// Content of a page.
struct PlotInput<'a> {
    /// The rows.
    file: &'a dyn SweepRows,
    /// Where they are.
    label: String,
    /// What writes the page again.
    command_line: String,
    /// The modes of every row, followed, or why they are not.
    tracking: Option<Result<Tracking, String>>,
}

/// Modes of the rows of a file, and the branch of each.
struct Tracking {
    /// Ascending in frequency; none for a row without.
    modes: Vec<Vec<Mode>>,
    /// As of [`funicular::modes::tracking::track`].
    branches: Vec<Vec<usize>>,
}

/// A page and what the user should know of it.
pub struct Page {
    /// HTML.
    pub html: String,
    /// Sentences that the user should know; they stand on the page, too.
    pub notes: Vec<String>,
}

const CONTENTS: &[(&str, &str)] = &[
    ("numbers", "Numbers"),
    ("pictures", "Pictures"),
    ("feasible", "What is feasible"),
    ("repeat", "How to repeat this"),
];

#[derive(Template)]
#[template(path = "plot.html")]
struct PlotPage<'a> {
    shell: Shell,
    key: Vec<(&'static str, String)>,
    notes: &'a [String],
    numbers: Table,
    statuses: Table,
    slices: Option<Slices>,
    curves: Vec<Figure>,
    robot_text: &'a str,
    /// What was asked, as the file has it.
    plan: String,
    label: &'a str,
    command_line: &'a str,
}

/// The page about the rows of a map or sweep; `label` says where they are, `command_line` writes the page again.
///
/// # Errors
/// A damaged file, or one without rows.
pub fn plot(rows: &dyn SweepRows, label: String, command_line: String, watch: &mut dyn Watch) -> anyhow::Result<Page> {
    refuse_no_rows(rows, &label)?;
    let tracking = tracking::tracking(rows, watch);
    page(&PlotInput { file: rows, label, command_line, tracking })
}

/// Refuses a file whose page would be empty.
fn refuse_no_rows(file: &dyn SweepRows, label: &str) -> anyhow::Result<()> {
    if file.rows() > 0 {
        return Ok(());
    }
    match file.record().part.filter(|_| file.is_complete()) {
        Some(part) => bail!(
            "{label} is part {part} of {}, which has none of them: plot what `funicular merge` makes of all parts",
            counted(file.record().rows, "row")
        ),
        None => bail!("{label} has no rows yet: let the sweep go on with ⟪resume⟫"),
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
            notes.push(format!("the modes are not followed, frequencies are joined in their order: {reason}"));
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

/// What is not as the reader would expect.
fn notes(input: &PlotInput, rows: &Rows) -> Vec<String> {
    let mut notes = Vec::new();
    if !input.file.is_complete() {
        notes.push(format!(
            "the file is incomplete: {} of {} rows are there; the command that began it goes on with ⟪resume⟫",
            rows.rows, rows.planned
        ));
    } else if let Some(part) = input.file.record().part {
        notes.push(format!(
            "the file is part {part}: {} of {} rows; funicular merge makes one file of all parts",
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
            "the slices and the points in space show {} ({} of {} rows), which is what the page has room for; histograms, \
             counts, and the least and greatest values are those of all rows",
            thinned.join(", "),
            rows.shown(),
            rows.planned
        ));
    } else if rows.axes.len() < 2 && rows.shown() < rows.rows {
        notes.push(format!(
            "the curves show {} of {} rows, which is what the page has room for; counts, and the least and greatest values \
             are those of all rows",
            rows.shown(),
            rows.rows
        ));
    }
    if !rows.words.is_empty() {
        notes.push(format!("no picture for {}: words, not numbers", rows.words.join(", ")));
    }
    notes
}

fn key(rows: &Rows) -> Vec<(&'static str, String)> {
    let share = 100.0 * rows.feasible as f64 / rows.rows.max(1) as f64;
    let mut key =
        vec![("rows", rows.rows.to_string()), ("feasible", format!("{} ({} %)", rows.feasible, significant(share, 3)))];
    let range = |axis: &rows::Axis| {
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

/// A number with at most four digits, without zeros behind; what is left of a zero by rounding is zero.
fn brief(value: f64) -> String {
    const ROUNDING: f64 = 1e-12;
    short(if value.abs() < ROUNDING { 0.0 } else { value }, 4).replace('-', "−")
}

/// Name of an axis with its unit: `x [m]`, `platform mass [kg]`.
fn axis_title(name: &str, unit: &str) -> String {
    // The unit of a value of the robot file is in its key.
    let ending = format!("_{}", unit.replace('/', "_per_").replace(' ', "_"));
    let stem = name.strip_suffix(&ending).unwrap_or(name);
    with_unit(&stem.replace(['.', '_'], " ").replace(['"', '\''], ""), unit)
}

/// Least and greatest of every quantity, and where.
fn numbers(rows: &Rows) -> Table {
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
    let mut table = Table::new(
        "table-numbers",
        "Every quantity: how many rows have it, its least and greatest value, and the first row that has it.",
        &["<quantity", "<unit", "rows", "min", "<<at", "max", "<<at", "<<what it is"],
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

/// How many rows have which status.
fn statuses(rows: &Rows) -> Table {
    let mut table = Table::new(
        "table-status",
        "Rows by their status, with the reason of the first row that has it.",
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

/// A status and what it means.
fn status(code: u8) -> (&'static str, &'static str) {
    CODES.get(usize::from(code)).copied().unwrap_or(("unknown", "a status of another version"))
}
