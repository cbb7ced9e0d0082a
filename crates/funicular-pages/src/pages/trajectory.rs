//! Page about a motion along a path: the moving robot, tensions, speeds and powers over time, and what limits them.

use super::Shell;
use super::figure::{PageFigure, axis, cable_line_style, colour, line, plain, robot};
use super::table::{PageTable, fixed, significant};
use anyhow::Context as _;
use askama::Template;
use funicular::robot::Robot;
use funicular::statics::Equilibrium;
use funicular_study::analyses::trajectory::{TrajectoryResult, TrajectoryRow};
use serde_json::{Value, json};

const CONTENTS: &[(&str, &str)] = &[
    ("motion", "Motion"),
    ("tensions", "Tensions"),
    ("cables", "Cables and winches"),
    ("limits", "Limits"),
    ("repeat", "How to repeat"),
];

#[derive(Template)]
#[template(path = "trajectory.html")]
struct TrajectoryPage<'a> {
    shell: Shell,
    found: &'a TrajectoryResult,
    duration: String,
    robot: PageFigure,
    frames: String,
    last_frame: usize,
    script: &'static str,
    extremes: PageTable,
    tensions: PageFigure,
    winches: Vec<PageFigure>,
    limits: Vec<PageFigure>,
    command_line: String,
}

/// Writes the page as HTML; `command_line` is the command that writes it again.
///
/// # Errors
/// A page that cannot be written.
pub fn page(robot: &Robot, found: &TrajectoryResult, command_line: String) -> anyhow::Result<String> {
    let equilibria: Vec<&Equilibrium> = found.frames.iter().map(|(_, equilibrium)| equilibrium).collect();
    let (figure, mut frames) = robot::moving(robot, &equilibria);
    frames["times"] = json!(found.frames.iter().map(|(time, _)| *time).collect::<Vec<f64>>());

    let page = TrajectoryPage {
        shell: Shell::new(format!("{}: motion along a path", found.robot), CONTENTS),
        found,
        duration: significant(found.duration_s, 5),
        robot: figure,
        frames: frames.to_string(),
        last_frame: equilibria.len() - 1,
        script: include_str!("../../templates/trajectory.js"),
        extremes: extremes(found),
        tensions: of_cables(found, ("figure-tensions", "Tensions at the platform."), "tension [N]", |row, i| {
            Some(row.tensions_platform_n[i])
        }),
        winches: winches(found),
        limits: limits(found),
        command_line,
    };
    page.render().context("the page could not be written as HTML")
}

/// Largest and lowest numbers.
fn extremes(found: &TrajectoryResult) -> PageTable {
    let caption = "Largest and lowest numbers on the path.";
    let mut table = PageTable::new("table-extremes", caption, &["<number", "value", "<unit", "<cable", "at|s"]);
    for of in &found.extremes {
        let time = fixed(of.t_s, 3);
        let bounded = of.value.filter(|_| of.no_bound.is_none());
        let value = bounded.map_or_else(|| "no bound".to_owned(), |value| significant(value, 4));
        table.row(vec![of.what.to_owned(), value, of.unit.to_owned(), of.cable.clone(), time]);
    }
    table
}

/// Speeds, and torques and powers of motors.
fn winches(found: &TrajectoryResult) -> Vec<PageFigure> {
    let mut figures = vec![of_cables(
        found,
        ("figure-speeds", "Speeds of the cables at the drums, positive while they are paid out."),
        "speed [m/s]",
        |row, i| Some(row.cable_speeds_m_s[i]),
    )];
    let has =
        |of: fn(&TrajectoryRow) -> &[Option<f64>]| found.rows.iter().any(|row| of(row).iter().any(Option::is_some));
    if has(|row| &row.motor_torques_n_m) {
        let caption = ("figure-torques", "Torques of the motors at their shafts, positive while they wind in.");
        figures.push(of_cables(found, caption, "torque [N m]", |row, i| row.motor_torques_n_m[i]));
    }
    if has(|row| &row.motor_powers_w) {
        let caption = ("figure-powers", "Powers of the motors, negative while they brake.");
        figures.push(of_cables(found, caption, "power [W]", |row, i| row.motor_powers_w[i]));
    }
    figures
}

/// Used part of the limits, first frequency, and distance of the nearest pair.
fn limits(found: &TrajectoryResult) -> Vec<PageFigure> {
    let one = |(id, caption, title): (&str, &str, &str), value: fn(&TrajectoryRow) -> Option<f64>| {
        found.rows.iter().any(|row| value(row).is_some()).then(|| {
            let values: Vec<f64> = found.rows.iter().map(|row| value(row).unwrap_or(f64::NAN)).collect();
            figure(id, caption, title, &[line("", &times(found), &values, colour::BLUE, "solid")], false)
        })
    };
    let used = "Used part of the limit that is nearest at each time: above 1 it is exceeded.";
    let frequency = "First natural frequency at rest under the tensions of each time.";
    let clearance = "Distance of the nearest pair beyond the required one.";
    [
        one(("figure-used", used, "used part"), |row| row.used_part),
        one(("figure-frequency", frequency, "frequency [Hz]"), |row| row.first_frequency_hz),
        one(("figure-clearance", clearance, "margin [m]"), |row| row.clearance_margin_m),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Figure with a line for every cable.
fn of_cables(
    found: &TrajectoryResult,
    (id, caption): (&str, &str),
    title: &str,
    value: impl Fn(&TrajectoryRow, usize) -> Option<f64>,
) -> PageFigure {
    let lines = found.cables.iter().enumerate().map(|(i, name)| {
        let values: Vec<f64> = found.rows.iter().map(|row| value(row, i).unwrap_or(f64::NAN)).collect();
        let (colour, dash) = cable_line_style(i);
        line(&plain(name), &times(found), &values, colour, dash)
    });
    figure(id, caption, title, &lines.collect::<Vec<Value>>(), true)
}

fn times(found: &TrajectoryResult) -> Vec<f64> {
    found.rows.iter().map(|row| row.t_s).collect()
}

fn figure(id: &str, caption: &str, title: &str, lines: &[Value], legend: bool) -> PageFigure {
    PageFigure::new(
        id,
        340,
        caption,
        lines,
        json!({
            "xaxis": axis("time [s]", json!({})), "yaxis": axis(title, json!({})), "showlegend": legend,
            "hovermode": "x unified",
        }),
    )
}
