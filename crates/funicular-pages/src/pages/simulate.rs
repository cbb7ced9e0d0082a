//! Page about a simulation: the moving robot, pose and tensions over time with the events, its spectrum, its error.

use super::Shell;
use super::figure::{PageFigure, axis, cable_line_style, colour, kind_colour, line, plain, robot, with};
use super::table::{PageTable, significant};
use crate::figures::simulated::displacement_unit;
use anyhow::Context as _;
use askama::Template;
use funicular::modes::Kind;
use funicular_study::analyses::simulate::{
    BelowRow, ColumnError, MotionSpectrum, NearestRow, Peak, Simulated, SimulatedRow, SlackSpan,
};
use funicular_study::text::short;
use serde_json::{Value, json};

const CONTENTS: &[(&str, &str)] = &[
    ("motion", "Motion"),
    ("pose", "Pose"),
    ("tensions", "Tensions"),
    ("spectrum", "Spectrum"),
    ("error", "Error"),
    ("repeat", "How to repeat"),
];

#[derive(Template)]
#[template(path = "simulate.html")]
struct SimulatePage<'a> {
    shell: Shell,
    found: &'a Simulated,
    summary: String,
    error: String,
    happened: Vec<String>,
    robot: PageFigure,
    frames: String,
    last_frame: usize,
    /// Factor of the drawn displacements; 1 if they are seen as they are.
    enlargement: f64,
    scripts: [&'static str; 2],
    pose: Vec<PageFigure>,
    tensions: Vec<PageFigure>,
    spectrum: Option<PageFigure>,
    remark: Option<String>,
    peaks: PageTable,
    errors: Option<PageTable>,
    command_line: String,
}

/// Writes the page as HTML; `command_line` is the command that writes it again.
///
/// # Errors
/// A page that cannot be written.
pub fn page(found: &Simulated, command_line: String) -> anyhow::Result<String> {
    let (figure, mut frames) = robot::simulated(&found.picture);
    frames["times"] = json!(found.picture.frames.iter().map(|frame| frame.t_s).collect::<Vec<f64>>());
    let of_motion = found.spectrum();
    let page = SimulatePage {
        shell: Shell::new(format!("{}: motion in time", found.robot), CONTENTS),
        summary: format!(
            "{} s, {} elements of degree {} in each rope, tolerance {} m.",
            short(found.rows.last().map_or(0.0, |row| row.t_s), 5),
            found.elements,
            found.degree,
            short(found.tolerance_m, 3)
        ),
        error: found.error_in_words(),
        happened: happened(found),
        robot: figure,
        frames: frames.to_string(),
        enlargement: found.picture.enlargement(),
        last_frame: found.picture.frames.len() - 1,
        scripts: [include_str!("../../templates/trajectory.js"), include_str!("../../templates/simulate.js")],
        pose: pose(found),
        tensions: tensions(found),
        remark: of_motion.as_ref().and_then(|of| of.without_modes.clone()),
        spectrum: of_motion.map(|of| spectrum(&of)),
        peaks: PageTable::of("table-peaks", "Largest tensions of each cable.", &Peak::columns(), &found.peaks),
        errors: (!found.errors.is_empty()).then(|| {
            let caption = "Bound of the error of each column, by a run with a finer mesh and tolerance.";
            PageTable::of("table-errors", caption, &ColumnError::columns(), &found.errors)
        }),
        found,
        command_line,
    };
    page.render().context("the page could not be written as HTML")
}

/// Sentences on what happened.
fn happened(found: &Simulated) -> Vec<String> {
    let marks = found.picture.marks.iter().map(|mark| match mark.until_s {
        Some(until) => format!("{} to {} s: {}.", short(mark.from_s, 4), short(until, 4), mark.what),
        None => format!("{} s: {}.", short(mark.from_s, 4), mark.what),
    });
    let slack = found.slack.iter().map(|slack| {
        let (first, share) = (significant(slack.first_s, 4), significant(100.0 * slack.share, 3));
        format!("Cable {} is slack from {first} s on, for {share} % of the time.", slack.cable)
    });
    let nearest = found.nearest.as_ref().map(NearestRow::in_words);
    let below = found.below.iter().map(BelowRow::in_words);
    marks.chain(slack).chain(nearest).chain(below).collect()
}

fn times(found: &Simulated) -> Vec<f64> {
    found.rows.iter().map(|row| row.t_s).collect()
}

/// Figure over time with the events as dashed lines and grey bands.
fn over_time(found: &Simulated, id: &str, height: usize, caption: &str, lines: &[Value], layout: Value) -> PageFigure {
    let (mut shapes, mut texts) = (Vec::new(), Vec::new());
    for mark in &found.picture.marks {
        let (x0, x1) = (mark.from_s, mark.until_s.unwrap_or(mark.from_s));
        let place = json!({"xref": "x", "yref": "paper", "x0": x0, "x1": x1, "y0": 0, "y1": 1, "layer": "below"});
        let look = match mark.until_s {
            Some(_) => json!({"type": "rect", "fillcolor": colour::GREY, "opacity": 0.13, "line": {"width": 0}}),
            None => json!({"type": "line", "line": {"color": colour::GREY, "width": 1.2, "dash": "dash"}}),
        };
        shapes.push(with(place, look));
        texts.push(json!({
            "xref": "x", "yref": "paper", "x": x0, "y": 1, "xanchor": "left", "yanchor": "top", "textangle": 90,
            "text": plain(&mark.what), "showarrow": false, "font": {"size": 11, "color": "#565656"},
        }));
    }
    let common = json!({
        "xaxis": axis("time [s]", json!({"range": [0, found.rows.last().map_or(1.0, |row| row.t_s)]})),
        "hovermode": "x unified", "shapes": shapes, "annotations": texts,
    });
    PageFigure::new(id, height, caption, lines, with(common, layout))
}

/// Displacement and turn since the start.
fn pose(found: &Simulated) -> Vec<PageFigure> {
    let (factor, unit) = displacement_unit(&found.rows);
    let of = |value: &dyn Fn(&SimulatedRow) -> f64| -> Vec<f64> { found.rows.iter().map(value).collect() };
    let colours = [colour::BLUE, colour::GREEN, colour::VERMILION];
    let lines = |names: [&str; 3], value: &dyn Fn(&SimulatedRow, usize) -> f64| -> Vec<Value> {
        let one = |k: usize| line(names[k], &times(found), &of(&|row| value(row, k)), colours[k], "solid");
        (0..3).map(one).collect()
    };
    let first = &found.rows[0];
    let moved =
        lines(["x", "y", "z"], &|row, k| factor * (row.motion.pose.position_m[k] - first.motion.pose.position_m[k]));
    let title = format!("displacement [{unit}]");
    let mut figures = vec![over_time(
        found,
        "figure-position",
        340,
        "Displacement of the platform's origin since the start, along the axes of the world. Dashed lines and grey \
         bands: events.",
        &moved,
        json!({"yaxis": axis(&title, json!({}))}),
    )];
    let turn =
        |row: &SimulatedRow, k: usize| row.motion.pose.roll_pitch_yaw_deg[k] - first.motion.pose.roll_pitch_yaw_deg[k];
    if found.rows.iter().any(|row| (0..3).any(|k| turn(row, k) != 0.0)) {
        let turned = lines(["roll", "pitch", "yaw"], &turn);
        let caption = "Change of roll, pitch and yaw since the start.";
        let layout = json!({"yaxis": axis("turn [°]", json!({}))});
        figures.push(over_time(found, "figure-turn", 300, caption, &turned, layout));
    }
    figures
}

/// Tensions with the times of slack, and changed lengths.
fn tensions(found: &Simulated) -> Vec<PageFigure> {
    let of_cables = |value: &dyn Fn(&SimulatedRow, usize) -> f64| -> Vec<Value> {
        let one = |(i, name): (usize, &String)| {
            let values: Vec<f64> = found.rows.iter().map(|row| value(row, i)).collect();
            let (colour, dash) = cable_line_style(i);
            line(&plain(name), &times(found), &values, colour, dash)
        };
        found.cables.iter().enumerate().map(one).collect()
    };
    let spans = found.slack_spans();
    let mut lines = of_cables(&|row, i| row.tensions_platform_n[i]);
    let mut layout = json!({"yaxis": axis("tension [N]", json!({})), "showlegend": true});
    let mut caption = "Tensions at the platform.".to_owned();
    if !spans.is_empty() {
        lines.extend(slack_bars(found, &spans));
        let rows = found.cables.len();
        let names: Vec<String> = found.cables.iter().map(|name| plain(name)).collect();
        let strip = json!({
            "domain": [0, 0.16], "range": [rows as f64 - 0.5, -0.5], "tickvals": (0..rows).collect::<Vec<_>>(),
            "ticktext": names, "showgrid": false, "tickfont": {"size": 9},
        });
        layout = with(
            layout,
            json!({"xaxis": {"anchor": "y2"}, "yaxis": {"domain": [0.22, 1]}, "yaxis2": axis("slack", strip)}),
        );
        caption.push_str(" Bars below: times during which a cable is slack (below 0.5 N).");
    }
    let mut figures = vec![over_time(found, "figure-tensions", 420, &caption, &lines, layout)];
    let is_wound = |row: &SimulatedRow| row.unstrained_lengths_m != found.rows[0].unstrained_lengths_m;
    if found.rows.iter().any(is_wound) {
        let first = &found.rows[0].unstrained_lengths_m;
        let lines = of_cables(&|row, i| row.unstrained_lengths_m[i] - first[i]);
        let layout = json!({"yaxis": axis("change [m]", json!({})), "showlegend": true});
        let caption = "Change of the unstrained lengths since the start.";
        figures.push(over_time(found, "figure-lengths", 300, caption, &lines, layout));
    }
    figures
}

/// Bars over the times of slack, a row for each cable.
fn slack_bars(found: &Simulated, spans: &[SlackSpan]) -> Vec<Value> {
    let bar = |i: usize| {
        let of_cable = spans.iter().filter(|span| span.cable == i);
        let (mut x, mut y) = (Vec::new(), Vec::new());
        for span in of_cable {
            x.extend([span.from_s, span.until_s, f64::NAN]);
            y.extend([i as f64, i as f64, f64::NAN]);
        }
        let look = json!({"yaxis": "y2", "showlegend": false, "line": {"width": 5}, "hoverinfo": "skip"});
        with(line("", &x, &y, cable_line_style(i).0, "solid"), look)
    };
    let is_slack = |i: &usize| spans.iter().any(|span| span.cable == *i);
    (0..found.cables.len()).filter(is_slack).map(bar).collect()
}

/// Amplitudes over frequency, and natural frequencies as lines by kind.
fn spectrum(of: &MotionSpectrum) -> PageFigure {
    let mut data = Vec::new();
    for (k, (name, colour)) in [("x", colour::BLUE), ("y", colour::GREEN), ("z", colour::VERMILION)].iter().enumerate()
    {
        let millimetres: Vec<f64> = of.amplitude_m[k].iter().map(|a| 1e3 * a).collect();
        data.push(line(name, &of.frequency_hz, &millimetres, colour, "solid"));
    }
    for kind in [Kind::Cable, Kind::Drive, Kind::Mixed, Kind::Platform] {
        let at: Vec<f64> = of.modes.iter().filter(|mode| mode.kind == kind).map(|mode| mode.frequency_hz).collect();
        if at.is_empty() {
            continue;
        }
        let x: Vec<f64> = at.iter().flat_map(|hz| [*hz, *hz, f64::NAN]).collect();
        let y: Vec<f64> = at.iter().flat_map(|_| [0.0, 1.0, f64::NAN]).collect();
        let name = format!("{} mode", kind.name());
        let look = json!({"yaxis": "y2", "line": {"width": 1}, "hovertemplate": "%{x:.5g} Hz"});
        data.push(with(line(&name, &x, &y, kind_colour(kind), "solid"), look));
    }
    let caption = format!(
        "Amplitudes of the motion of the platform's origin from {} to {} s, through the window of von Hann, and below \
         the natural frequencies of the robot at the equilibrium of its last lengths and payloads.",
        short(of.from_s, 4),
        short(of.until_s, 4)
    );
    let ticks = json!({"domain": [0, 0.12], "showticklabels": false, "ticks": "", "showgrid": false, "range": [0, 1]});
    let layout = json!({
        "xaxis": axis("frequency [Hz]", json!({"range": [0, of.frequency_hz.last()], "anchor": "y2"})),
        "yaxis": axis("amplitude [mm]", json!({"domain": [0.16, 1], "rangemode": "tozero"})),
        "yaxis2": axis("", ticks),
    });
    PageFigure::new("figure-spectrum", 380, caption, &data, layout)
}
