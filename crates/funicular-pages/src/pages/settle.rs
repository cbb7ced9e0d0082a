//! Page about a decay: motion of the point over time with its bound, the modes that carry it, and the commanded
//! lengths.

use super::Shell;
use super::figure::{PageFigure, axis, cable_line_style, colour, line, plain};
use super::table::{PageTable, significant};
use anyhow::Context as _;
use askama::Template;
use funicular_study::analyses::settle::{Commanded, HistoryRow, Settled, SettlingMode};
use serde_json::{Value, json};

const CONTENTS: &[(&str, &str)] = &[("decay", "Decay"), ("modes", "Modes"), ("repeat", "How to repeat")];
const WITH_LENGTHS: &[(&str, &str)] =
    &[("decay", "Decay"), ("modes", "Modes"), ("lengths", "Lengths"), ("repeat", "How to repeat")];

#[derive(Template)]
#[template(path = "settle.html")]
struct SettlePage<'a> {
    shell: Shell,
    found: &'a Settled,
    summary: String,
    decay: PageFigure,
    modes: PageTable,
    lengths: Option<PageFigure>,
    command_line: String,
}

/// Writes the page as HTML; `command_line` is the command that writes it again.
///
/// # Errors
/// A page that cannot be written.
pub fn page(found: &Settled, command_line: String) -> anyhow::Result<String> {
    let lengths = found.commanded.as_ref().filter(|commanded| !commanded.lengths.is_empty()).map(lengths);
    let what = found.commanded.as_ref().map_or("release", |commanded| commanded.command_kind);
    let page = SettlePage {
        shell: Shell::new(
            format!("{}: decay after a {what}", found.robot),
            if lengths.is_some() { WITH_LENGTHS } else { CONTENTS },
        ),
        found,
        summary: format!("{}. Largest distance {} mm.", found.when_settled(), significant(1e3 * found.peak_m, 4)),
        decay: decay(found),
        modes: PageTable::of(
            "table-modes",
            "Modes that take part, the largest amplitude first.",
            &SettlingMode::columns(&found.modes),
            &found.modes,
        ),
        lengths,
        command_line,
    };
    page.render().context("the page could not be written as HTML")
}

/// Displacement along the axes, and the bound of the distance, over the time since the end of the command.
fn decay(found: &Settled) -> PageFigure {
    let during = found.commanded.as_ref().map_or(&[][..], |commanded| &commanded.during);
    let rows: Vec<&HistoryRow> = during.iter().chain(&found.history).collect();
    let of = |value: fn(&HistoryRow) -> f64| -> Vec<f64> { rows.iter().map(|row| 1e3 * value(row)).collect() };
    let times: Vec<f64> = rows.iter().map(|row| row.t_s).collect();
    let bound = of(|row| row.envelope_m.unwrap_or(f64::NAN));
    let below: Vec<f64> = bound.iter().map(|bound| -bound).collect();

    let data = [
        line("x", &times, &of(|row| row.x_m), colour::BLUE, "solid"),
        line("y", &times, &of(|row| row.y_m), colour::GREEN, "solid"),
        line("z", &times, &of(|row| row.z_m), colour::VERMILION, "solid"),
        line("sum of all amplitudes", &times, &bound, colour::GREY, "dash"),
        line("", &times, &below, colour::GREY, "dash"),
    ];
    let caption = if during.is_empty() {
        "Displacement of the point from its rest since the release, along the axes of the world, with the sum of the \
         amplitudes of all modes as its bound."
    } else {
        "Displacement of the point from where the lengths of the time hold it at rest, along the axes of the world, \
         since the end of the command, with the sum of the amplitudes of all modes as its bound afterwards."
    };
    PageFigure::new(
        "figure-decay",
        420,
        caption,
        &data,
        json!({"xaxis": axis("time [s]", json!({})), "yaxis": axis("displacement [mm]", json!({}))}),
    )
}

/// Commanded lengths, from their first value on.
fn lengths(commanded: &Commanded) -> PageFigure {
    let times: Vec<f64> = commanded.lengths.iter().map(|row| row.t_s).collect();
    let lines = commanded.cables.iter().enumerate().map(|(i, name)| {
        let length = |k: usize| commanded.lengths[k].unstrained_lengths_m[i];
        let values: Vec<f64> = (0..times.len()).map(|k| length(k) - length(0)).collect();
        let (colour, dash) = cable_line_style(i);
        line(&plain(name), &times, &values, colour, dash)
    });
    PageFigure::new(
        "figure-lengths",
        340,
        "Commanded unstrained lengths, each from its first value on.",
        &lines.collect::<Vec<Value>>(),
        json!({"xaxis": axis("time since the start [s]", json!({})), "yaxis": axis("change of length [m]", json!({}))}),
    )
}
