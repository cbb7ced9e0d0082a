//! Page about an estimate: pose, velocity, payload with its deviation, tensions and residuals over time, alarms, and
//! the fit of the sensors.

use super::Shell;
use super::figure::{PageFigure, axis, cable_line_style, colour, line, plain};
use super::table::PageTable;
use anyhow::Context as _;
use askama::Template;
use funicular_study::analyses::estimate::{CableErrors, EstimateAlarm, EstimateRow, Estimated, SensorFit};
use serde_json::{Value, json};

const CONTENTS: &[(&str, &str)] = &[
    ("alarms", "Alarms"),
    ("motion", "Motion"),
    ("payload", "Payload"),
    ("tensions", "Tensions"),
    ("sensors", "Sensors"),
    ("repeat", "How to repeat"),
];

#[derive(Template)]
#[template(path = "estimate.html")]
struct EstimatePage<'a> {
    shell: Shell,
    found: &'a Estimated,
    alarms: PageTable,
    motion: Vec<PageFigure>,
    payload: PageFigure,
    tensions: PageFigure,
    residuals: Option<PageFigure>,
    sensors: PageTable,
    cables: PageTable,
    command_line: String,
}

/// Writes the page as HTML; `command_line` is the command that writes it again.
///
/// # Errors
/// A page that cannot be written.
pub fn page(found: &Estimated, command_line: String) -> anyhow::Result<String> {
    let begin = found.rows.first().map_or([0.0; 3], |row| row.pose.position_m);
    let has_cells = found.rows.iter().any(|row| row.residuals.is_some());
    let residual = |row: &EstimateRow, i: usize| row.residuals.as_ref().map_or(f64::NAN, |all| all[i]);
    let page = EstimatePage {
        shell: Shell::new(format!("{}: estimate from a log", found.robot), CONTENTS),
        found,
        alarms: PageTable::of(
            "table-alarms",
            "Alarms in the order of their times.",
            &EstimateAlarm::columns(),
            &found.alarms,
        ),
        motion: vec![
            of_axes(found, ("figure-position", "Displacement since the first row."), "displacement [mm]", |row, k| {
                1e3 * (row.pose.position_m[k] - begin[k])
            }),
            of_axes(found, ("figure-velocity", "Velocity of the platform origin."), "velocity [m/s]", |row, k| {
                row.velocity_m_s[k]
            }),
        ],
        payload: payload(found),
        tensions: of_cables(
            found,
            ("figure-tensions", "Estimated tensions at the anchors or drums."),
            "tension [N]",
            |row, i| row.tensions_n[i],
        ),
        residuals: has_cells.then(|| {
            let caption = "Readings of the load cells less the expected ones, in their standard deviations.";
            of_cables(found, ("figure-residuals", caption), "residual [deviations]", residual)
        }),
        sensors: PageTable::of(
            "table-sensors",
            "Residuals of each kind of sensor: the mean of their squares over their variances is one if noise and \
             model are true.",
            &SensorFit::columns(),
            &found.sensors,
        ),
        cables: PageTable::of(
            "table-cables",
            "Constant errors of the sensors at the end of the log.",
            &CableErrors::columns(),
            &found.cable_errors,
        ),
        command_line,
    };
    page.render().context("the page could not be written as HTML")
}

fn times(found: &Estimated) -> Vec<f64> {
    found.rows.iter().map(|row| row.t_s).collect()
}

/// Figure with a line for every axis.
fn of_axes(
    found: &Estimated,
    caption: (&str, &str),
    title: &str,
    value: impl Fn(&EstimateRow, usize) -> f64,
) -> PageFigure {
    let colours = [colour::BLUE, colour::GREEN, colour::VERMILION];
    let lines = ["x", "y", "z"].into_iter().enumerate().map(|(k, name)| {
        let values: Vec<f64> = found.rows.iter().map(|row| value(row, k)).collect();
        line(name, &times(found), &values, colours[k], "solid")
    });
    figure(caption, title, &lines.collect::<Vec<Value>>())
}

/// Figure with a line for every cable.
fn of_cables(
    found: &Estimated,
    caption: (&str, &str),
    title: &str,
    value: impl Fn(&EstimateRow, usize) -> f64,
) -> PageFigure {
    let lines = found.cables.iter().enumerate().map(|(i, name)| {
        let values: Vec<f64> = found.rows.iter().map(|row| value(row, i)).collect();
        let (colour, dash) = cable_line_style(i);
        line(&plain(name), &times(found), &values, colour, dash)
    });
    figure(caption, title, &lines.collect::<Vec<Value>>())
}

/// Payload with two deviations to both sides.
fn payload(found: &Estimated) -> PageFigure {
    let of = |sign: f64| -> Vec<f64> {
        let two = |row: &EstimateRow| row.payload_std_kg.map_or(f64::NAN, |std| sign * 2.0 * std);
        found.rows.iter().map(|row| row.payload_kg + if sign == 0.0 { 0.0 } else { two(row) }).collect()
    };
    let times = times(found);
    let lines = [
        line("payload", &times, &of(0.0), colour::BLUE, "solid"),
        line("two deviations above", &times, &of(1.0), colour::GREY, "dash"),
        line("two deviations below", &times, &of(-1.0), colour::GREY, "dash"),
    ];
    figure(("figure-payload", "Payload beyond the platform of the file."), "payload [kg]", &lines)
}

fn figure((id, caption): (&str, &str), title: &str, lines: &[Value]) -> PageFigure {
    PageFigure::new(
        id,
        340,
        caption,
        lines,
        json!({"xaxis": axis("time [s]", json!({})), "yaxis": axis(title, json!({})), "hovermode": "x unified"}),
    )
}
