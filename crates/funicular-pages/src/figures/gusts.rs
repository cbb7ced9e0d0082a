//! Figure of `gust`: spectra on logarithmic axes with those of slow gusts, and how the variance adds up over the
//! frequency.

use super::axis::ChartAxis;
use super::chart::{Chart, Entry, Layer, Panel, Sample};
use super::drawing::{BLACK, Stroke};
use super::style::{self, GREY};
use funicular_study::analyses::gust::{GustRow, Gusty};
use funicular_study::text::significant;

/// Maximum number of outputs of one unit: with more no curve is found again.
const MAX_CURVES: usize = 3;

/// Decades of a spectrum below its highest peak that are drawn: lower parts have no visible variance.
const DECADES: f64 = 6.0;

/// Room above the highest curve, as a factor.
const ABOVE: f64 = 2.0;

/// Part of the variance below the lowest frequency that is drawn.
const VISIBLE: f64 = 1e-3;

/// Heights of the panels relative to the width of the figure.
const SPECTRUM: f64 = 0.36;
const SUMS: f64 = 0.26;

/// One panel per unit with its outputs of the largest r.m.s. values, the parts of their variances up to a frequency,
/// and the natural frequencies below.
pub(super) fn chart(found: &Gusty) -> Chart {
    let mut units: Vec<&str> = Vec::new();
    for row in &found.outputs {
        if !units.contains(&row.unit.as_str()) {
            units.push(&row.unit);
        }
    }
    let last = found.frequency_hz.last().copied().unwrap_or(found.below_hz);
    let (mut panels, mut sums, mut legend) = (Vec::new(), Vec::new(), Vec::new());
    let (mut first, mut has_slow) = (f64::INFINITY, false);
    for unit in units {
        let mut rows: Vec<&GustRow> = found.outputs.iter().filter(|row| row.unit == unit).collect();
        rows.sort_by(|a, b| b.rms.total_cmp(&a.rms));
        rows.truncate(MAX_CURVES);
        let (label, factor) = scaled(unit);
        let (mut layers, mut highest) = (Vec::new(), 0.0_f64);
        for row in rows {
            let stroke = style::curve(legend.len());
            let over = |density: &[f64]| -> Vec<(f64, f64)> {
                let points = found.frequency_hz.iter().zip(density);
                points.map(|(hz, density)| (*hz, factor * factor * density)).collect()
            };
            highest = row.density.iter().map(|density| factor * factor * density).fold(highest, f64::max);
            let summed = cumulative(&found.frequency_hz, &row.density);
            first = summed.iter().find(|point| point.1 > VISIBLE).map_or(first, |point| first.min(point.0));
            if !row.slow_density.is_empty() {
                has_slow = true;
                layers.push(Layer::Line { points: over(&row.slow_density), stroke: slow_stroke(&stroke) });
            }
            layers.push(Layer::Line { points: over(&row.density), stroke: stroke.clone() });
            sums.push(Layer::Line { points: summed, stroke: stroke.clone() });
            let text = format!("{}: r.m.s. {} {label}", row.output, significant(factor * row.rms, 3));
            legend.push(Entry { text, sample: Sample::Line(stroke) });
        }
        let highest = if highest > 0.0 { highest * ABOVE } else { 1.0 };
        let y = ChartAxis::logarithmic(format!("S [({label})²/Hz]"), highest / 10_f64.powf(DECADES), highest);
        panels.push(Panel::new(y, SPECTRUM, layers));
    }
    panels.push(Panel::new(ChartAxis::linear("part of variance", 0.0, 1.05), SUMS, sums));
    if has_slow {
        let sample = Sample::Line(slow_stroke(&Stroke::solid(BLACK, style::CURVE_WIDTH)));
        legend.push(Entry { text: "slow gusts (dashed)".to_owned(), sample });
    }

    let first = if first < last { first } else { 1e-2 * last };
    let stroke = Stroke::solid(GREY, style::AXIS_WIDTH);
    let x = found.modes.iter().map(|mode| mode.frequency_hz).filter(|hz| *hz > first && *hz < last).collect();
    let stems = vec![Layer::Stems { x, from: 0.0, to: 1.0, stroke: stroke.clone() }];
    panels.push(Panel { bare: true, ..Panel::new(ChartAxis::linear("", 0.0, 1.0), 0.05, stems) });
    legend.push(Entry { text: "natural frequency".to_owned(), sample: Sample::Stem(stroke) });
    Chart {
        title: format!("{}: spectra in gusts", found.robot),
        x: ChartAxis::logarithmic("frequency [Hz]", first, last),
        panels,
        legend,
        colour_bar: None,
    }
}

/// Line of the spectrum without the dynamics of the robot.
fn slow_stroke(of: &Stroke) -> Stroke {
    Stroke { dashes: vec![3.0, 1.5], width: 0.6 * of.width, ..of.clone() }
}

/// Part of the variance up to each frequency, by straight lines between the densities.
fn cumulative(frequency_hz: &[f64], density: &[f64]) -> Vec<(f64, f64)> {
    let mut sum = 0.0;
    let mut points: Vec<(f64, f64)> = frequency_hz.first().map(|hz| (*hz, 0.0)).into_iter().collect();
    for (hz, density) in frequency_hz.windows(2).zip(density.windows(2)) {
        sum += 0.5 * (density[0] + density[1]) * (hz[1] - hz[0]);
        points.push((hz[1], sum));
    }
    let all = if sum > 0.0 { sum } else { 1.0 };
    points.into_iter().map(|(hz, part)| (hz, part / all)).collect()
}

/// Unit of the axis, a thousandth for lengths and angles, and the factor to it.
fn scaled(unit: &str) -> (String, f64) {
    if unit.starts_with('m') || unit.starts_with("rad") { (format!("m{unit}"), 1e3) } else { (unit.to_owned(), 1.0) }
}
