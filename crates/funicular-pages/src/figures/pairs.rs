//! Figure of `clearance`: distances of the pairs with the least margins, with the required ones.

use super::axis::ChartAxis;
use super::bars::shortened;
use super::chart::{Chart, Entry, Layer, Panel, Sample};
use super::drawing::{BLACK, Colour, Stroke};
use super::style::{BLUE, CURVE_WIDTH, GREEN, ORANGE, SKY, VERMILION};
use anyhow::{Result, bail};
use funicular_study::analyses::clearance::{ClearanceRow, Clearances};

/// Maximum number of pairs that are drawn: those with the least margins.
const MAX_PAIRS: usize = 20;

/// Height of the row of a pair relative to the width of the figure, and part of it that the bar takes.
const ROW: f64 = 0.055;
const FILLED: f64 = 0.64;

/// Room beside the longest bar, as a part of it.
const BESIDE: f64 = 0.06;

/// Colours of the kinds in the order in which they are found; a pair that is too near has another one.
const COLOURS: [Colour; 4] = [BLUE, ORANGE, GREEN, SKY];

/// Bars of the distances, from the pair with the least margin downwards.
///
/// # Errors
/// A robot without a pair.
pub(super) fn chart(found: &Clearances) -> Result<Chart> {
    let pairs = &found.pairs[..found.pairs.len().min(MAX_PAIRS)];
    if pairs.is_empty() {
        bail!("the robot has no pair of things with a distance, so that there is nothing to draw");
    }
    let count = pairs.len() as f64;
    let at = |k: usize| count - 1.0 - k as f64;
    let mut kinds: Vec<&str> = pairs.iter().map(|pair| pair.kind).collect();
    kinds.sort_unstable();
    kinds.dedup();

    let bar = |(k, pair): (usize, &ClearanceRow)| {
        let (low, high) = (at(k) - 0.5 * FILLED, at(k) + 0.5 * FILLED);
        vec![(0.0, low), (pair.distance_m, low), (pair.distance_m, high), (0.0, high)]
    };
    let (mut layers, mut legend) = (Vec::new(), Vec::new());
    let groups = kinds.iter().zip(COLOURS).map(|(kind, colour)| (Some(*kind), colour)).chain([(None, VERMILION)]);
    for (kind, colour) in groups {
        // A pair that touches has a bar on the other side of zero, or none.
        let belongs = |pair: &ClearanceRow| if pair.is_kept() { kind == Some(pair.kind) } else { kind.is_none() };
        let areas: Vec<_> = pairs.iter().enumerate().filter(|(_, pair)| belongs(pair)).map(bar).collect();
        if !areas.is_empty() {
            let text = kind.map_or_else(|| "nearer than required".to_owned(), |kind| kind.replace('-', " "));
            legend.push(Entry { text, sample: Sample::Area(colour) });
            layers.push(Layer::Areas { areas, fill: colour });
        }
    }
    let stroke = Stroke::solid(BLACK, CURVE_WIDTH);
    let required = pairs
        .iter()
        .enumerate()
        .flat_map(|(k, pair)| [(pair.required_m, at(k) - 0.5), (pair.required_m, at(k) + 0.5), (f64::NAN, f64::NAN)]);
    layers.push(Layer::Line { points: required.collect(), stroke: stroke.clone() });
    legend.push(Entry { text: "required distance".to_owned(), sample: Sample::Stem(stroke) });

    let shown = || pairs.iter().flat_map(|pair| [pair.distance_m, pair.required_m, 0.0]);
    let (low, high) = (shown().fold(0.0, f64::min), shown().fold(0.0, f64::max));
    let beside = BESIDE * (high - low).max(f64::MIN_POSITIVE);
    let low = if low < 0.0 { low - beside } else { 0.0 };
    let names =
        pairs.iter().enumerate().map(|(k, pair)| (at(k), shortened(&format!("{} – {}", pair.first, pair.second))));
    let y = ChartAxis::linear("", -0.6, count - 0.4).with_labels(names.collect());
    let x = if found.move_to.is_some() { "least distance on the move [m]" } else { "distance [m]" };
    Ok(Chart {
        title: format!("{}: distances", found.robot),
        x: ChartAxis::linear(x, low, high + beside),
        panels: vec![Panel::new(y, ROW * (count + 0.4), layers)],
        legend,
        colour_bar: None,
    })
}
