//! Figure of `settle`: distance of the point from its rest over time, while a command runs and after it, with the bound
//! of all modes and the tolerance. Swings that follow each other too closely for lines are an area below their crests.

use super::axis::ChartAxis;
use super::chart::{Chart, Entry, Layer, Panel, Sample};
use super::drawing::{Colour, Stroke};
use super::style::{self, GREY};
use funicular_study::analyses::settle::{HistoryRow, Settled};
use funicular_study::text::significant;

/// Room above the highest curve, as a part of it.
const ABOVE: f64 = 0.08;

/// Number of columns of the figure, each with its largest distance: more swings than columns would be a solid block.
const COLUMNS: usize = 120;

/// Part of white in the colour of the area below the crests.
const WHITENED: f64 = 0.72;

/// Motion after one command.
struct Course<'a> {
    name: &'static str,
    /// Time of the end of the command [s].
    end: f64,
    /// Motion while the command runs; empty for a release, and for a command that is only compared.
    during: &'a [HistoryRow],
    history: &'a [HistoryRow],
    /// `None` if the point never settles.
    settled: Option<f64>,
}

/// Distance over the time since the release or the start of the command: with and without the shaper.
pub(super) fn chart(found: &Settled) -> Chart {
    let courses = courses(found);
    let last = courses.iter().filter_map(|of| Some(of.end + of.history.last()?.t_s)).fold(0.0, f64::max);
    let last = if last > 0.0 { last } else { 1.0 };
    let tolerance = 1e3 * found.tolerance_m;
    let rows = courses.iter().flat_map(|of| of.during.iter().chain(of.history));
    let highest = rows.map(|row| 1e3 * row.envelope_m.unwrap_or_else(|| distance(row))).fold(tolerance, f64::max);

    let (mut layers, mut legend) = (Vec::new(), Vec::new());
    for (i, of) in courses.iter().enumerate() {
        let stroke = style::curve(i);
        let bound = Stroke { dashes: vec![3.0, 1.5], width: 0.6 * stroke.width, ..stroke.clone() };
        let point = |row: &HistoryRow, value: f64| (of.end + row.t_s, 1e3 * value);
        let moved = of.during.iter().chain(of.history).map(|row| point(row, distance(row)));
        layers.extend(motion(moved.collect(), last, &stroke));
        let bounded = of.history.iter().filter_map(|row| Some(point(row, row.envelope_m?)));
        layers.push(Layer::Line { points: bounded.collect(), stroke: bound.clone() });
        if !of.during.is_empty() {
            let ends = vec![(of.end, 0.0), (of.end, highest)];
            let stroke = Stroke { dashes: vec![1.0, 1.5], ..Stroke::solid(GREY, style::AXIS_WIDTH) };
            layers.push(Layer::Line { points: ends, stroke: stroke.clone() });
            legend.push(Entry { text: "end of the command".to_owned(), sample: Sample::Line(stroke) });
        }
        let at = of.settled.map(|settled| of.end + settled);
        layers.extend(at.map(|at| {
            let stroke = Stroke::solid(stroke.colour, 2.0);
            Layer::Line { points: vec![(at, 0.0), (at, tolerance)], stroke }
        }));
        let within = format!("{}: within {} mm for good", of.name, significant(tolerance, 3));
        let text = at.map_or_else(|| format!("{within} never"), |at| format!("{within} at {} s", significant(at, 4)));
        legend.push(Entry { text, sample: Sample::Line(stroke) });
        legend.push(Entry { text: format!("{}: sum of all amplitudes", of.name), sample: Sample::Line(bound) });
    }
    let band = Stroke::solid(GREY, style::AXIS_WIDTH);
    layers.push(Layer::Line { points: vec![(0.0, tolerance), (last, tolerance)], stroke: band.clone() });
    legend.push(Entry { text: "tolerance".to_owned(), sample: Sample::Line(band) });

    let y = ChartAxis::linear("distance from rest [mm]", 0.0, highest * (1.0 + ABOVE));
    Chart {
        title: format!("{}: decay", found.robot),
        x: ChartAxis::linear("time [s]", 0.0, last),
        panels: vec![Panel::new(y, 0.6, layers)],
        legend,
        colour_bar: None,
    }
}

/// Line of a motion up to a time, or the area below its crests where the swings are too close for a line.
fn motion(points: Vec<(f64, f64)>, last: f64, stroke: &Stroke) -> Vec<Layer> {
    let crests = points.windows(3).filter(|three| three[1].1 > three[0].1 && three[1].1 >= three[2].1).count();
    if crests <= COLUMNS {
        return vec![Layer::Line { points, stroke: stroke.clone() }];
    }
    let column = |t: f64| ((t / last * COLUMNS as f64) as usize).min(COLUMNS - 1);
    let highest = |part: &[(f64, f64)]| part.iter().copied().reduce(|most, of| if of.1 > most.1 { of } else { most });
    let crests: Vec<(f64, f64)> = points.chunk_by(|a, b| column(a.0) == column(b.0)).filter_map(highest).collect();
    let ends = [points.first(), points.last()].map(|end| end.map_or(0.0, |end| end.0));
    let area = [(ends[0], 0.0)].into_iter().chain(crests.iter().copied()).chain([(ends[1], 0.0)]).collect();
    let line = Stroke { width: 0.7 * stroke.width, ..stroke.clone() };
    vec![
        Layer::Areas { areas: vec![area], fill: whitened(stroke.colour) },
        Layer::Line { points: crests, stroke: line },
    ]
}

/// Light tone of a colour.
fn whitened(colour: Colour) -> Colour {
    colour.map(|part| (f64::from(part) + WHITENED * (255.0 - f64::from(part))).round() as u8)
}

/// Distance of the point from its rest [m].
fn distance(row: &HistoryRow) -> f64 {
    row.x_m.hypot(row.y_m).hypot(row.z_m)
}

fn courses(found: &Settled) -> Vec<Course<'_>> {
    let Some(commanded) = &found.commanded else {
        let (history, settled) = (&found.history, found.settled_s);
        return vec![Course { name: "release", end: 0.0, during: &[], history, settled }];
    };
    let own = |name| Course {
        name,
        end: commanded.duration_s,
        during: &commanded.during,
        history: &found.history,
        settled: found.settled_s,
    };
    let Some(shaping) = &commanded.shaping else { return vec![own(commanded.command_kind)] };
    let without = Course {
        name: "without shaper",
        end: commanded.duration_s - shaping.longer_s,
        during: &[],
        history: &shaping.history_without,
        settled: shaping.settled_without_s,
    };
    vec![own("with shaper"), without]
}
