//! Figure of `trajectory`: tensions, lengths, speeds and powers over time, with their limits.

use super::axis::ChartAxis;
use super::chart::{Chart, Entry, Layer, Panel, Sample};
use super::drawing::{BLACK, Stroke};
use super::style::{self, AXIS_WIDTH, GREY};
use funicular::robot::{Cable, Robot};
use funicular_study::analyses::trajectory::{TrajectoryResult, TrajectoryRow};

/// Room above and below the curves, as a part of their range.
const BESIDE: f64 = 0.06;

/// Limit that a panel shows: within this multiple of the range of the curves beyond them. A farther one would leave the
/// curves flat.
const MAX_BEYOND: f64 = 1.5;

/// Height of a panel with a line for every cable, and of one with a single line, relative to the width.
const HEIGHT: f64 = 0.32;
const LOW_HEIGHT: f64 = 0.2;

/// Limits of a panel.
#[derive(Default)]
struct Limits {
    values: Vec<f64>,
}

impl Limits {
    /// Finite limits, each once.
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        Self { values }
    }
}

/// One panel for each quantity that the results have.
pub(super) fn chart(robot: &Robot, found: &TrajectoryResult) -> Chart {
    let cables = found.cables.len();
    let winch_limits = || robot.cables.iter().filter_map(|cable| Some(&cable.anchor.winch.as_ref()?.limits));
    let tensions = robot.cables.iter().map(Cable::limits);
    let tensions = tensions.flat_map(|limits| limits.minimum.into_iter().chain(limits.maximum));
    let of_cables = |title: &str, limits: &Limits, value: &dyn Fn(&TrajectoryRow, usize) -> Option<f64>| {
        panel(found, title, Some(cables), limits, value)
    };
    let single = |title: &str, limits: &Limits, value: &dyn Fn(&TrajectoryRow) -> Option<f64>| {
        panel(found, title, None, limits, &|row, _| value(row))
    };

    let mut panels = vec![
        of_cables("tension at the platform [N]", &Limits::of(tensions), &|row, i| Some(row.tensions_platform_n[i])),
        of_cables("unstrained length [m]", &Limits::default(), &|row, i| Some(row.unstrained_lengths_m[i])),
        of_cables(
            "rope speed [m/s]",
            &Limits::of(winch_limits().flat_map(|limits| [-limits.speed, limits.speed])),
            &|row, i| Some(row.cable_speeds_m_s[i]),
        ),
    ];
    let powers = Limits::of(winch_limits().flat_map(|limits| [-limits.brake_power, limits.power]));
    panels.push(of_cables("power of the motor [W]", &powers, &|row, i| *row.motor_powers_w.get(i)?));
    panels.push(single("f₁ [Hz]", &Limits::default(), &|row| row.first_frequency_hz));
    let zero = Limits { values: vec![0.0] };
    panels.push(single("clearance [m]", &zero, &|row| row.clearance_margin_m));
    let has_limit = panels.iter().flatten().any(|(_, has_limit)| *has_limit);

    let line = |(i, name): (usize, &String)| Entry { text: name.clone(), sample: Sample::Line(style::curve(i)) };
    let mut legend: Vec<Entry> = found.cables.iter().enumerate().map(line).collect();
    if has_limit {
        legend.push(Entry { text: "limit".to_owned(), sample: Sample::Line(limit_stroke()) });
    }
    Chart {
        title: format!("{}: trajectory", found.robot),
        x: ChartAxis::linear("time [s]", 0.0, found.duration_s),
        panels: panels.into_iter().flatten().map(|(panel, _)| panel).collect(),
        legend,
        colour_bar: None,
    }
}

fn limit_stroke() -> Stroke {
    Stroke { dashes: vec![4.0, 2.0], ..Stroke::solid(GREY, 2.0 * AXIS_WIDTH) }
}

/// Panel with a line for each of so many cables or with a single one, and true if it shows a limit; none without
/// values.
fn panel(
    found: &TrajectoryResult,
    title: &str,
    cables: Option<usize>,
    limits: &Limits,
    value: &dyn Fn(&TrajectoryRow, usize) -> Option<f64>,
) -> Option<(Panel, bool)> {
    let points = |i: usize| -> Vec<(f64, f64)> {
        found.rows.iter().map(|row| (row.t_s, value(row, i).unwrap_or(f64::NAN))).collect()
    };
    let curves: Vec<Vec<(f64, f64)>> = (0..cables.unwrap_or(1)).map(points).collect();
    let finite = || curves.iter().flatten().map(|point| point.1).filter(|value| value.is_finite());
    let (mut low, mut high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    if low > high {
        return None;
    }
    let room = MAX_BEYOND * (high - low).max(1e-3 * high.abs());
    let near = |limit: &f64| (low - room..=high + room).contains(limit);
    let shown: Vec<f64> = limits.values.iter().copied().filter(near).collect();
    (low, high) = shown.iter().fold((low, high), |(low, high), limit| (low.min(*limit), high.max(*limit)));

    let across = |limit: &f64| vec![(0.0, *limit), (found.duration_s, *limit)];
    let mut layers: Vec<Layer> =
        shown.iter().map(|limit| Layer::Line { points: across(limit), stroke: limit_stroke() }).collect();
    let alone = Stroke::solid(BLACK, style::CURVE_WIDTH);
    let stroke = |i: usize| if cables.is_some() { style::curve(i) } else { alone.clone() };
    layers.extend(curves.into_iter().enumerate().map(|(i, points)| Layer::Line { points, stroke: stroke(i) }));
    let height = if cables.is_some() { HEIGHT } else { LOW_HEIGHT };
    let beside = if high > low { BESIDE * (high - low) } else { BESIDE * high.abs().max(1.0) };
    Some((Panel::new(ChartAxis::linear(title, low - beside, high + beside), height, layers), !shown.is_empty()))
}
