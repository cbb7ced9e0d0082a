//! Curves of rows along one value or along a list, and natural frequencies joined by their modes.

use super::rows::{Rows, Series, label, with_unit};
use super::{Tracking, axis_title};
use crate::pages::figure::{PageFigure, axis, colour, line, plain, rounded, with};
use funicular_study::sweep::CODES;
use serde_json::{Value, json};

/// Horizontal axis of the figures.
pub(super) struct HorizontalAxis {
    pub(super) title: String,
    pub(super) x: Vec<f64>,
    /// Short name in front of the value in tooltips.
    short: String,
}

const COLOURS: [&str; 7] =
    [colour::BLUE, colour::VERMILION, colour::GREEN, colour::PURPLE, colour::ORANGE, colour::SKY, colour::BLACK];
const DASHES: [&str; 4] = ["solid", "dash", "dot", "dashdot"];

/// Maximum number of figures on a page; further quantities are only in the table.
const MAX_FIGURES: usize = 16;

/// Maximum relative difference of frequencies that count as equal.
const EQUAL: f64 = 1e-9;

/// Checks that the modes computed again are those of the file.
///
/// # Errors
/// The first frequency that differs.
pub(super) fn checked<'a>(tracking: &'a Tracking, rows: &Rows) -> Result<&'a Tracking, String> {
    let ours = |place: usize, k: usize| tracking.modes.get(place)?.get(k).map(|mode| mode.frequency_hz);
    for (k, series) in frequencies(rows).into_iter().enumerate() {
        for (at, value) in rows.places.iter().zip(&series.values).filter(|(_, value)| value.is_finite()) {
            let found = ours(at - rows.places[0], k);
            if found.is_none_or(|found| (found - value).abs() > EQUAL * value.abs()) {
                return Err(format!(
                    "computed again, {} of row {} is {}, but the file has {value} Hz: another version wrote it",
                    series.name,
                    at + 1,
                    found.map_or_else(|| "missing".to_owned(), |found| format!("{found} Hz"))
                ));
            }
        }
    }
    Ok(tracking)
}

/// Columns of `frequencies:N`, in order.
fn frequencies(rows: &Rows) -> Vec<&Series> {
    rows.series.iter().filter(|series| is_frequency(series)).collect()
}

fn is_frequency(series: &Series) -> bool {
    let middle = series.name.strip_prefix("frequency_").and_then(|rest| rest.strip_suffix("_hz"));
    middle.is_some_and(|middle| middle.parse::<usize>().is_ok())
}

/// Figures of all quantities, one per kind, the natural frequencies first.
pub(super) fn figures(rows: &Rows, tracking: Option<&Tracking>) -> Vec<PageFigure> {
    let along = horizontal_axis(rows);
    let mut figures = Vec::new();
    if let Some(tracking) = tracking {
        figures.push(campbell(rows, &along, tracking));
    }
    let mut families: Vec<(String, Vec<&Series>)> = Vec::new();
    for series in &rows.series {
        if series.count == 0 || (tracking.is_some() && is_frequency(series)) {
            continue;
        }
        let family = family(series);
        match families.iter_mut().find(|(known, _)| *known == family) {
            Some((_, members)) => members.push(series),
            None => families.push((family, vec![series])),
        }
    }
    let ids = (1..=MAX_FIGURES).map(|number| format!("figure-{number}"));
    figures.extend(families.iter().zip(ids).map(|((_, members), id)| curves(id, rows, &along, members)));
    figures
}

/// Key of the quantities that share a figure: one unit, and one kind of value of several cables, modes, coordinates or
/// models.
pub(super) fn family(series: &Series) -> String {
    let name = &series.name;
    let stem = ["tension_platform", "unstrained_length", "frequency", "stiffness", "pose", "tension"];
    let stem = stem.iter().find(|stem| name.starts_with(&format!("{stem}_"))).map_or_else(
        || {
            let ends = ["distance_m"].iter().find(|end| name.ends_with(*end));
            ends.map_or_else(|| name.clone(), |end| (*end).to_owned())
        },
        |stem| (*stem).to_owned(),
    );
    // The minimum eigenvalue is not one of the coordinates.
    let stem = if name.starts_with("stiffness_min") { "stiffness_min".to_owned() } else { stem };
    format!("{stem} {}", series.unit)
}

/// Horizontal axis of the rows: the value that varies. For a list of poses it is the length of the path, or the number
/// of the row if all positions are equal.
pub(super) fn horizontal_axis(rows: &Rows) -> HorizontalAxis {
    if let [axis] = &rows.axes[..] {
        let x = rows.places.iter().map(|place| rows.at(*place)[0]).collect();
        return HorizontalAxis { title: axis_title(&axis.name, &axis.unit), x, short: axis.name.clone() };
    }

    let positions: Vec<&Vec<f64>> = rows
        .coordinates
        .iter()
        .filter(|(name, ..)| ["x_m", "y_m", "z_m"].contains(&name.as_str()))
        .map(|c| &c.2)
        .collect();

    let mut length = 0.0;
    let path: Vec<f64> = (0..rows.places.len())
        .map(|i| {
            let steps = positions.iter().map(|values| if i > 0 { values[i] - values[i - 1] } else { 0.0 });
            length += steps.map(|step| step * step).sum::<f64>().sqrt();
            length
        })
        .collect();

    if rows.is_list && length > 0.0 {
        HorizontalAxis { title: "length of the path [m]".to_owned(), x: path, short: "path".to_owned() }
    } else {
        let x = rows.places.iter().map(|place| *place as f64 + 1.0).collect();
        HorizontalAxis { title: "row".to_owned(), x, short: "row".to_owned() }
    }
}

/// Ranges of infeasible rows, from half way to the row before to half way to the row after.
pub(super) fn infeasible_ranges(rows: &Rows, along: &HorizontalAxis) -> Vec<(f64, f64)> {
    let infeasible =
        |i: usize| CODES.get(usize::from(rows.status[i])).is_some_and(|code| code.1.starts_with("infeasible"));
    let x = &along.x;
    let last = x.len().saturating_sub(1);
    let middle = |a: usize, b: usize| 0.5 * (x[a] + x[b]);
    let mut ranges = Vec::new();
    let mut i = 0;
    while i < x.len() {
        if !infeasible(i) {
            i += 1;
            continue;
        }
        let begin = i;
        while i < last && infeasible(i + 1) {
            i += 1;
        }
        ranges.push((middle(begin.saturating_sub(1), begin), middle(i, (i + 1).min(last))));
        i += 1;
    }
    ranges
}

/// Grey bands at infeasible rows.
fn bands(rows: &Rows, along: &HorizontalAxis) -> Vec<Value> {
    let band = |(from, to): (f64, f64)| {
        json!({
            "type": "rect", "x0": from, "x1": to, "yref": "paper", "y0": 0, "y1": 1, "layer": "below",
            "fillcolor": "#e4e4e4", "line": {"width": 0},
        })
    };
    infeasible_ranges(rows, along).into_iter().map(band).collect()
}

fn layout(rows: &Rows, along: &HorizontalAxis, y: &str, more: Value) -> Value {
    let ends = [
        along.x.iter().copied().fold(f64::INFINITY, f64::min),
        along.x.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    ];
    let room = if ends[1] > ends[0] { 0.015 * (ends[1] - ends[0]) } else { 0.5 };
    let base = json!({
        "xaxis": axis(&plain(&along.title), json!({"range": [ends[0] - room, ends[1] + room]})),
        // Thousands are written as numbers, not with a letter such as k.
        "yaxis": axis(&plain(y), json!({"exponentformat": "power", "minexponent": 6})),
        "shapes": bands(rows, along),
    });
    with(base, more)
}

fn shading(rows: &Rows, along: &HorizontalAxis) -> &'static str {
    if bands(rows, along).is_empty() { "" } else { " Grey: infeasible." }
}

/// Markers for single values between two missing ones, where a line has no length.
fn isolated_points(along: &HorizontalAxis, series: &Series, colour: &str) -> Value {
    let there = |i: Option<usize>| i.and_then(|i| series.values.get(i)).is_some_and(|value| value.is_finite());
    let alone = (0..series.values.len()).filter(|&i| there(Some(i)) && !there(i.checked_sub(1)) && !there(Some(i + 1)));
    let (x, y): (Vec<f64>, Vec<f64>) = alone.map(|i| (along.x[i], series.values[i])).unzip();
    json!({
        "type": "scatter", "mode": "markers", "name": plain(&label(&series.name)), "x": rounded(&x), "y": rounded(&y),
        "showlegend": false, "marker": {"size": 5, "color": colour},
    })
}

/// Lines through the values, with gaps where values are missing.
fn curves(id: String, rows: &Rows, along: &HorizontalAxis, members: &[&Series]) -> PageFigure {
    let few = along.x.len() <= 60;

    let data: Vec<Value> = members
        .iter()
        .enumerate()
        .map(|(i, series)| {
            let colour = COLOURS[i % COLOURS.len()];
            let dash = DASHES[i / COLOURS.len() % DASHES.len()];
            let mut trace = line(&plain(&label(&series.name)), &along.x, &series.values, colour, dash);
            if few {
                trace = with(trace, json!({"mode": "lines+markers", "marker": {"size": 4, "color": colour}}));
            }

            let hover = format!("{} %{{x}}<br>%{{y:.5g}} {}", plain(&along.short), plain(&series.unit));
            let more = json!({"hovertemplate": hover, "connectgaps": false, "legendgroup": series.name});
            let trace = with(trace, more.clone());
            if few {
                return vec![trace];
            }

            let alone = with(isolated_points(along, series, colour), more);
            [Some(trace), Some(alone).filter(|alone| alone["x"] != json!([]))].into_iter().flatten().collect()
        })
        .collect::<Vec<_>>()
        .concat();

    let y = vertical_title(members);

    let caption = match members {
        [one] => format!("{}: {}.", label(&one.name), one.about),
        several => {
            let word = common_word(several);
            let mut parts: Vec<String> = Vec::new();
            for series in several {
                let same = several.iter().all(|other| other.about == series.about);
                let name = if same { word.clone() } else { label(&series.name) };
                let one = format!("{name}: {}", series.about);
                if !parts.contains(&one) {
                    parts.push(one);
                }
            }
            format!("{}.", parts.join("; "))
        }
    };

    let caption = format!("{}{}", capitalised(&caption), shading(rows, along));

    // The margin leaves room for the buttons above the legend.
    let more = json!({"showlegend": members.len() > 1, "margin": {"t": if members.len() > 1 { 56 } else { 34 }}});
    PageFigure::new(id, if members.len() > 10 { 460 } else { 380 }, caption, &data, layout(rows, along, &y, more))
}

/// Title of the vertical axis of quantities that share a figure.
pub(super) fn vertical_title(members: &[&Series]) -> String {
    let unit = &members[0].unit;
    match members {
        [one] => with_unit(&label(&one.name), unit),
        several => with_unit(&common_word(several), unit),
    }
}

/// Word for several quantities of one kind.
fn common_word(several: &[&Series]) -> String {
    let first = label(&several[0].name);
    let word = first.split(' ').next().unwrap_or_default();
    if several[0].name.ends_with("distance_m") {
        "distance".to_owned()
    } else if word == "unstrained" {
        "unstrained length".to_owned()
    } else {
        word.to_owned()
    }
}

/// Text with a capital first letter.
fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Figure of the natural frequencies: one line per branch of modes, coloured by the platform's share of the energy.
fn campbell(rows: &Rows, along: &HorizontalAxis, tracking: &Tracking) -> PageFigure {
    let count = frequencies(rows).len();
    let branches = tracking.branches.iter().flatten().max().map_or(0, |last| last + 1);

    let mut data = Vec::new();
    let (mut x, mut y, mut share, mut text) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());

    for branch in 0..branches {
        let (mut line_x, mut line_y) = (Vec::new(), Vec::new());
        for (at, place) in rows.places.iter().enumerate() {
            let step = place - rows.places[0];
            let of_step = tracking.branches.get(step).map_or(&[][..], Vec::as_slice);
            let modes = tracking.modes.get(step).map_or(&[][..], Vec::as_slice);

            let Some(k) = of_step.iter().position(|of| *of == branch).filter(|k| *k < count) else {
                line_x.push(along.x[at]);
                line_y.push(f64::NAN);
                continue;
            };
            line_x.push(along.x[at]);
            line_y.push(modes[k].frequency_hz);
            x.push(along.x[at]);
            y.push(modes[k].frequency_hz);
            share.push(100.0 * modes[k].platform_energy_fraction);
            text.push(format!("mode {} of its row, branch {}, {}", k + 1, branch + 1, modes[k].kind.name()));
        }

        if line_y.iter().filter(|y| y.is_finite()).count() > 1 {
            let trace = line("", &line_x, &line_y, "#6b6b6b", "solid");
            data.push(with(trace, json!({"showlegend": false, "hoverinfo": "skip", "line": {"width": 1.1}})));
        }
    }

    let hover = format!(
        "{} %{{x}}<br>%{{y:.4f}} Hz<br>platform %{{marker.color:.0f}} % of the energy<br>%{{text}}<extra></extra>",
        plain(&along.short)
    );
    let size = if along.x.len() > 120 { 4.0 } else { 6.0 };
    data.push(json!({
        "type": "scatter", "mode": "markers", "x": rounded(&x), "y": rounded(&y), "text": text, "showlegend": false,
        "hovertemplate": hover,
        "marker": {
            "size": size, "color": rounded(&share), "cmin": 0, "cmax": 100, "line": {"width": 0},
            "colorscale": [[0.0, "#fdd56a"], [0.25, "#f89540"], [0.5, "#d5536f"], [0.75, "#8f0da4"], [1.0, "#0d0887"]],
            "colorbar": {
                "title": {"text": "platform's share of the energy [%]", "side": "right", "font": {"size": 12}},
                "thickness": 14, "outlinewidth": 0, "tickfont": {"size": 11},
            },
        },
    }));

    let caption = format!(
        "The lowest {count} natural frequencies. A line joins modes with the most similar motion from one value to the \
         next (MAC of the complete robot, weighted by mass, at least 0.5). Colour: the platform's share of the kinetic \
         energy. Where two lines cross, each mode keeps its motion. Where two lines bend away from each other, the \
         modes exchange their motions, and the colours change along the lines.{}",
        shading(rows, along)
    );

    PageFigure::new("figure-modes", 520, caption, &data, layout(rows, along, "natural frequency [Hz]", json!({})))
}
