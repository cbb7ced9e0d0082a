//! Figure of `simulate`: displacement, turn and tensions over time, with the events and the times of slack.

use super::axis::ChartAxis;
use super::chart::{Chart, Entry, Layer, Panel, Sample};
use super::drawing::{BLACK, Stroke};
use super::style::{self, AXIS_WIDTH, GREY};
use funicular_study::analyses::simulate::{Simulated, SimulatedRow};

/// Room above and below the curves, as a part of their range.
const BESIDE: f64 = 0.06;
/// Distance of an event's name from its line, as a part of the duration.
const NAME_BESIDE: f64 = 0.012;
/// Height of the panels relative to the width of the figure.
const MOTION_HEIGHT: f64 = 0.32;
const TENSION_HEIGHT: f64 = 0.42;
/// Height of the row of a cable among the times of slack.
const SLACK_ROW: f64 = 0.036;

/// Displacement up to which a figure has millimetres [m].
const IN_MILLIMETRES: f64 = 0.5;

/// Displacement and turn since the start, tensions, and the times at which cables are slack.
pub(super) fn chart(found: &Simulated) -> Chart {
    let last = found.rows.last().map_or(1.0, |row| row.t_s);
    let (factor, unit) = displacement_unit(&found.rows);
    let first = &found.rows[0].motion.pose;
    let moved = |row: &SimulatedRow, k: usize| factor * (row.motion.pose.position_m[k] - first.position_m[k]);
    let turned = |row: &SimulatedRow, k: usize| row.motion.pose.roll_pitch_yaw_deg[k] - first.roll_pitch_yaw_deg[k];
    let turns = found.rows.iter().any(|row| (0..3).any(|k| turned(row, k) != 0.0));

    let of_axis: Vec<Stroke> = (0..3).map(axis_stroke).collect();
    let mut panels = vec![over_time(found, &format!("displacement [{unit}]"), MOTION_HEIGHT, &of_axis, &moved)];
    name_events(found, &mut panels[0], last);
    if turns {
        panels.push(over_time(found, "turn [°]", MOTION_HEIGHT, &of_axis, &turned));
    }
    let of_cable: Vec<Stroke> = (0..found.cables.len()).map(style::curve).collect();
    panels.push(over_time(found, "tension at the platform [N]", TENSION_HEIGHT, &of_cable, &|row, i| {
        row.tensions_platform_n[i]
    }));
    panels.extend(slack(found));

    let names = if turns { ["x, roll", "y, pitch", "z, yaw"] } else { ["x", "y", "z"] };
    let entry = |text: String, stroke: &Stroke| Entry { text, sample: Sample::Line(stroke.clone()) };
    let mut legend: Vec<Entry> =
        names.iter().zip(&of_axis).map(|(name, stroke)| entry((*name).to_owned(), stroke)).collect();
    legend.extend(found.cables.iter().zip(&of_cable).map(|(name, stroke)| entry(format!("cable {name}"), stroke)));
    if found.picture.marks.iter().any(|mark| mark.until_s.is_none()) {
        legend.push(Entry { text: "event".to_owned(), sample: Sample::Stem(event_stroke()) });
    }
    if found.picture.marks.iter().any(|mark| mark.until_s.is_some()) {
        legend.push(Entry { text: "event that lasts".to_owned(), sample: Sample::Band });
    }
    Chart {
        title: format!("{}: motion in time", found.robot),
        x: ChartAxis::linear("time [s]", 0.0, last),
        panels,
        legend,
        colour_bar: None,
    }
}

/// Factor to the unit of displacements since the start, and the unit.
pub(crate) fn displacement_unit(rows: &[SimulatedRow]) -> (f64, &'static str) {
    let from = rows.first().map_or([0.0; 3], |row| row.motion.pose.position_m);
    let off = |row: &SimulatedRow| (0..3).map(|k| (row.motion.pose.position_m[k] - from[k]).abs()).fold(0.0, f64::max);
    let largest = rows.iter().map(off).fold(0.0, f64::max);
    if largest < IN_MILLIMETRES { (1e3, "mm") } else { (1.0, "m") }
}

/// Black lines of the axes, which no line of a cable looks like: z is solid, because most robots move most along it.
fn axis_stroke(axis: usize) -> Stroke {
    let dashes = [vec![1.0, 1.4], vec![4.0, 1.6], Vec::new()];
    Stroke { dashes: dashes[axis].clone(), ..Stroke::solid(BLACK, 0.8 * style::CURVE_WIDTH) }
}

fn event_stroke() -> Stroke {
    Stroke { dashes: vec![3.0, 1.5], ..Stroke::solid(GREY, AXIS_WIDTH) }
}

/// Panel with a line for every stroke, and the events behind them.
fn over_time(
    found: &Simulated,
    title: &str,
    height: f64,
    strokes: &[Stroke],
    value: &dyn Fn(&SimulatedRow, usize) -> f64,
) -> Panel {
    let marks = &found.picture.marks;
    let bands = marks.iter().filter_map(|mark| Some((mark.from_s, mark.until_s?))).collect();
    let sudden = marks.iter().filter(|mark| mark.until_s.is_none()).map(|mark| mark.from_s).collect();
    let mut layers = vec![Layer::Bands(bands), Layer::Stems { x: sudden, from: 0.0, to: 1.0, stroke: event_stroke() }];
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for (k, stroke) in strokes.iter().enumerate() {
        let points: Vec<(f64, f64)> = found.rows.iter().map(|row| (row.t_s, value(row, k))).collect();
        (low, high) = points.iter().fold((low, high), |(low, high), point| (low.min(point.1), high.max(point.1)));
        layers.push(Layer::Line { points, stroke: stroke.clone() });
    }
    let beside = if high > low { BESIDE * (high - low) } else { 1.0 };
    Panel::new(ChartAxis::linear(title, low - beside, high + beside), height, layers)
}

/// Writes the names of the events beside their lines.
fn name_events(found: &Simulated, panel: &mut Panel, last: f64) {
    let from = panel.y.low;
    let texts = found.picture.marks.iter().map(|mark| (mark.from_s + NAME_BESIDE * last, from, mark.what.clone()));
    panel.layers.push(Layer::Upright { texts: texts.collect(), colour: BLACK });
}

/// Panel with the times at which cables are slack, a row for each cable; none if all are taut.
fn slack(found: &Simulated) -> Option<Panel> {
    let spans = found.slack_spans();
    if spans.is_empty() {
        return None;
    }
    let rows = found.cables.len();
    let at = |i: usize| (rows - 1 - i) as f64;
    let bar = |i: usize| {
        let of_cable = spans.iter().filter(|span| span.cable == i);
        let points = of_cable.flat_map(|span| [(span.from_s, at(i)), (span.until_s, at(i)), (f64::NAN, at(i))]);
        Layer::Line { points: points.collect(), stroke: Stroke::solid(style::curve(i).colour, 3.0) }
    };
    let names = found.cables.iter().enumerate().map(|(i, name)| (at(i), name.clone())).collect();
    let y = ChartAxis::linear("slack", -0.7, rows as f64 - 0.3).with_labels(names);
    Some(Panel::new(y, SLACK_ROW * (rows as f64 + 1.0), (0..rows).map(bar).collect()))
}
