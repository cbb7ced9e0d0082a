//! Figure of `estimate`: displacement, payload with two deviations, tensions, and residuals of the load cells over
//! time, with the alarms.

use super::axis::ChartAxis;
use super::chart::{Chart, Entry, Layer, Panel, Sample};
use super::drawing::{BLACK, Colour, Stroke};
use super::style::{self, AXIS_WIDTH, GREY};
use funicular_study::analyses::estimate::{EstimateRow, Estimated};

/// Room above and below the curves, as a part of their range.
const BESIDE: f64 = 0.06;

/// Heights of the panels relative to the width of the figure.
const HEIGHT: f64 = 0.28;
const TENSION_HEIGHT: f64 = 0.4;

/// Largest residual that the panel of the residuals shows whole [deviations].
const MAX_RESIDUAL: f64 = 10.0;

/// Colour of the band of two deviations.
const BAND: Colour = [0xd6, 0xe2, 0xf0];

/// Displacement since the first row, payload, tensions and residuals.
pub(super) fn chart(found: &Estimated) -> Chart {
    let (first, last) = ends(&found.rows);
    let begin = found.rows.first().map_or([0.0; 3], |row| row.pose.position_m);
    let of_axis: Vec<Stroke> = (0..3).map(axis_stroke).collect();
    let of_cable: Vec<Stroke> = (0..found.cables.len()).map(style::curve).collect();
    let residual = |row: &EstimateRow, i: usize| {
        row.residuals.as_ref().map_or(f64::NAN, |all| all[i].clamp(-MAX_RESIDUAL, MAX_RESIDUAL))
    };
    let mut panels = vec![
        over_time(found, "displacement [mm]", HEIGHT, &of_axis, &|row, k| 1e3 * (row.pose.position_m[k] - begin[k])),
        payload(found),
        over_time(found, "tension [N]", TENSION_HEIGHT, &of_cable, &|row, i| row.tensions_n[i]),
    ];
    if found.rows.iter().any(|row| row.residuals.is_some()) {
        panels.push(over_time(found, "residual [deviations]", HEIGHT, &of_cable, &residual));
    }

    let entry = |text: String, stroke: &Stroke| Entry { text, sample: Sample::Line(stroke.clone()) };
    let mut legend: Vec<Entry> =
        ["x", "y", "z"].iter().zip(&of_axis).map(|(name, stroke)| entry((*name).to_owned(), stroke)).collect();
    legend.push(Entry { text: "payload, two deviations".to_owned(), sample: Sample::Area(BAND) });
    legend.extend(found.cables.iter().zip(&of_cable).map(|(name, stroke)| entry(format!("cable {name}"), stroke)));
    if !found.alarms.is_empty() {
        legend.push(Entry { text: "alarm".to_owned(), sample: Sample::Stem(alarm_stroke()) });
    }
    Chart {
        title: format!("{}: estimate", found.robot),
        x: ChartAxis::linear("time [s]", first, last),
        panels,
        legend,
        colour_bar: None,
    }
}

/// First and last time.
fn ends(rows: &[EstimateRow]) -> (f64, f64) {
    let (first, last) = (rows.first().map_or(0.0, |row| row.t_s), rows.last().map_or(1.0, |row| row.t_s));
    (first, if last > first { last } else { first + 1.0 })
}

/// Black lines of the axes, which no line of a cable looks like.
fn axis_stroke(axis: usize) -> Stroke {
    let dashes = [vec![1.0, 1.4], vec![4.0, 1.6], Vec::new()];
    Stroke { dashes: dashes[axis].clone(), ..Stroke::solid(BLACK, 0.8 * style::CURVE_WIDTH) }
}

fn alarm_stroke() -> Stroke {
    Stroke { dashes: vec![3.0, 1.5], ..Stroke::solid(GREY, AXIS_WIDTH) }
}

fn alarms(found: &Estimated) -> Layer {
    let x = found.alarms.iter().map(|alarm| alarm.t_s).collect();
    Layer::Stems { x, from: 0.0, to: 1.0, stroke: alarm_stroke() }
}

/// Axis that holds all values that are finite.
fn axis_of(title: &str, values: impl Iterator<Item = f64>) -> ChartAxis {
    let values = values.filter(|value| value.is_finite());
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), of| (low.min(of), high.max(of)));
    let (low, high) = if low > high { (0.0, 1.0) } else { (low, high) };
    let beside = if high > low { BESIDE * (high - low) } else { 1.0 };
    ChartAxis::linear(title, low - beside, high + beside)
}

/// Panel with a line for every stroke, and the alarms behind them.
fn over_time(
    found: &Estimated,
    title: &str,
    height: f64,
    strokes: &[Stroke],
    value: &dyn Fn(&EstimateRow, usize) -> f64,
) -> Panel {
    let all = found.rows.iter().flat_map(|row| (0..strokes.len()).map(move |k| value(row, k)));
    let axis = axis_of(title, all);
    let lines = strokes.iter().enumerate().map(|(k, stroke)| {
        let points = found.rows.iter().map(|row| (row.t_s, value(row, k))).collect();
        Layer::Line { points, stroke: stroke.clone() }
    });
    Panel::new(axis, height, [alarms(found)].into_iter().chain(lines).collect())
}

/// Panel of the payload with its band, which is interrupted where no deviation is told.
fn payload(found: &Estimated) -> Panel {
    let band = |row: &EstimateRow| Some((row.payload_kg, 2.0 * row.payload_std_kg?));
    let areas = found.rows.chunk_by(|a, b| a.payload_std_kg.is_some() == b.payload_std_kg.is_some());
    let areas: Vec<Vec<(f64, f64)>> = areas
        .filter(|rows| rows[0].payload_std_kg.is_some())
        .map(|rows| {
            let upper = rows.iter().filter_map(|row| band(row).map(|(mid, two)| (row.t_s, mid + two)));
            let lower = rows.iter().rev().filter_map(|row| band(row).map(|(mid, two)| (row.t_s, mid - two)));
            upper.chain(lower).collect()
        })
        .collect();
    // The band of a payload that was just forgotten would hide everything else.
    let shown = found.rows.iter().flat_map(|row| {
        let two = band(row).map_or(0.0, |(_, two)| two).min(0.5 * row.payload_kg.abs().max(1.0));
        [row.payload_kg - two, row.payload_kg + two]
    });
    let points = found.rows.iter().map(|row| (row.t_s, row.payload_kg)).collect();
    let line = Layer::Line { points, stroke: style::curve(0) };
    Panel::new(axis_of("payload [kg]", shown), HEIGHT, vec![Layer::Areas { areas, fill: BAND }, alarms(found), line])
}
