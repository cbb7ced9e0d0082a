//! Figure of `gust`: spectra over the logarithm of the frequency, where areas are variances, with those of slow gusts.

use super::axis::ChartAxis;
use super::chart::{Chart, Entry, Layer, Panel, Sample};
use super::drawing::Stroke;
use super::style::{self, GREY};
use funicular_study::analyses::gust::{GustRow, Gusty};
use funicular_study::text::significant;

/// Maximum number of outputs of one unit: with more no curve is found again.
const MAX_CURVES: usize = 3;

/// Room above the highest curve, as a part of it.
const ABOVE: f64 = 0.08;

/// Part of the first frequency with a visible variance: below it nothing is drawn.
const VISIBLE: f64 = 1e-2;

/// One panel per unit with its outputs of the largest r.m.s. values, and the natural frequencies below.
pub(super) fn chart(found: &Gusty) -> Chart {
    let mut units: Vec<&str> = Vec::new();
    for row in &found.outputs {
        if !units.contains(&row.unit.as_str()) {
            units.push(&row.unit);
        }
    }
    let (mut panels, mut legend, mut first, mut curve) = (Vec::new(), Vec::new(), f64::INFINITY, 0);
    for unit in units {
        let mut rows: Vec<&GustRow> = found.outputs.iter().filter(|row| row.unit == unit).collect();
        rows.sort_by(|a, b| b.rms.total_cmp(&a.rms));
        rows.truncate(MAX_CURVES);
        let (label, factor) = scaled(unit);
        let (mut layers, mut highest) = (Vec::new(), 0.0_f64);
        for row in rows {
            let stroke = style::curve(curve);
            curve += 1;
            let slow = Stroke { dashes: vec![3.0, 1.5], width: 0.6 * stroke.width, ..stroke.clone() };
            let over = |density: &[f64]| -> Vec<(f64, f64)> {
                let points = found.frequency_hz.iter().zip(density);
                points.map(|(hz, density)| (*hz, factor * factor * hz * density)).collect()
            };
            let points = over(&row.density);
            let most = points.iter().map(|point| point.1).fold(0.0, f64::max);
            first = points.iter().find(|point| point.1 > VISIBLE * most).map_or(first, |point| first.min(point.0));
            highest = highest.max(most);
            let rms = |value: f64| significant(factor * value, 3);
            let slow_rms =
                row.quasi_static_rms.map_or_else(String::new, |slow| format!(", slow gusts (dashed) {}", rms(slow)));
            let text = format!("{}: r.m.s. {}{slow_rms} {label}", row.output, rms(row.rms));
            legend.push(Entry { text, sample: Sample::Line(stroke.clone()) });
            layers.push(Layer::Line { points: over(&row.slow_density), stroke: slow });
            layers.push(Layer::Line { points, stroke });
        }
        let top = if highest > 0.0 { highest * (1.0 + ABOVE) } else { 1.0 };
        panels.push(Panel::new(ChartAxis::linear(format!("f S [({label})²]"), 0.0, top), 0.36, layers));
    }

    let last = found.frequency_hz.last().copied().unwrap_or(found.below_hz);
    let first = if first < last { first } else { VISIBLE * last };
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

/// Unit of the axis, a thousandth for lengths and angles, and the factor to it.
fn scaled(unit: &str) -> (String, f64) {
    if unit.starts_with('m') || unit.starts_with("rad") { (format!("m{unit}"), 1e3) } else { (unit.to_owned(), 1.0) }
}
