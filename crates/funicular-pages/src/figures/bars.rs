//! Bars over cables, with marks of limits: the figures of `payload` and `loads`, and the panels of those of winches.

use super::axis::ChartAxis;
use super::chart::{Chart, Entry, Layer, Panel, Sample};
use super::drawing::{BLACK, Colour, Stroke};
use super::style::{AXIS_WIDTH, BLUE, ORANGE};
use anyhow::{Result, bail};
use funicular_study::analyses::loads::Loads;
use funicular_study::analyses::payload::{LoadedRow, Payload};
use funicular_study::text::significant;

/// Room above the highest bar, as a part of it.
const ABOVE: f64 = 0.08;
/// Part of the width of a cable's place that its bars take.
const FILLED: f64 = 0.7;
/// Mark up to this multiple of the highest bar that a panel shows; higher ones would leave the bars flat.
const MAX_MARK: f64 = 2.5;
/// Maximum number of letters of a name below a bar.
pub(super) const MAX_LETTERS: usize = 20;

/// Bars of one kind, one for each name.
pub(super) struct Bars {
    pub(super) text: String,
    pub(super) colour: Colour,
    pub(super) values: Vec<Option<f64>>,
}

/// BarMarks across the bars, one for each name.
pub(super) struct BarMarks {
    pub(super) text: String,
    pub(super) stroke: Stroke,
    pub(super) values: Vec<Option<f64>>,
}

/// Panel of bars.
pub(super) struct BarPanel {
    /// Quantity with its unit.
    pub(super) title: String,
    pub(super) bars: Vec<Bars>,
    pub(super) marks: Vec<BarMarks>,
}

/// Chart with a place for every name, and panels of bars above each other.
pub(super) fn chart(title: String, axis: &str, names: &[String], panels: &[BarPanel], height: f64) -> Chart {
    let count = names.len() as f64;
    let labels = names.iter().enumerate().map(|(i, name)| (i as f64, shortened(name))).collect();
    Chart {
        title,
        x: ChartAxis::linear(axis, -0.5, count - 0.5).with_labels(labels),
        panels: panels.iter().map(|panel| panel.drawn(height)).collect(),
        legend: legend(panels),
        colour_bar: None,
    }
}

/// Entries of all bars and marks, each once.
fn legend(panels: &[BarPanel]) -> Vec<Entry> {
    let mut legend: Vec<Entry> = Vec::new();
    let mut add = |text: &str, sample: Sample| {
        if !text.is_empty() && legend.iter().all(|entry| entry.text != text) {
            legend.push(Entry { text: text.to_owned(), sample });
        }
    };
    for bars in panels.iter().flat_map(|panel| &panel.bars) {
        add(&bars.text, Sample::Area(bars.colour));
    }
    let shown = |panel: &BarPanel, marks: &BarMarks| {
        let top = panel.top();
        marks.values.iter().flatten().any(|mark| *mark <= top)
    };
    for (panel, marks) in panels.iter().flat_map(|panel| panel.marks.iter().map(move |marks| (panel, marks))) {
        if shown(panel, marks) {
            add(&marks.text, Sample::Line(marks.stroke.clone()));
        }
    }
    legend
}

/// Name with at most [`MAX_LETTERS`] letters.
pub(super) fn shortened(name: &str) -> String {
    if name.chars().count() <= MAX_LETTERS {
        return name.to_owned();
    }
    let kept: String = name.chars().take(MAX_LETTERS - 1).collect();
    format!("{kept}…")
}

impl BarPanel {
    /// Height of the bars, and of the marks that are not far above them.
    fn top(&self) -> f64 {
        let highest = self.bars.iter().flat_map(|bars| &bars.values).flatten().copied().fold(0.0, f64::max);
        let marks = self.marks.iter().flat_map(|marks| &marks.values).flatten().copied();
        if highest > 0.0 {
            marks.filter(|mark| *mark <= MAX_MARK * highest).fold(highest, f64::max)
        } else {
            marks.fold(0.0, f64::max)
        }
    }

    fn drawn(&self, height: f64) -> Panel {
        let top = self.top();
        let top = if top > 0.0 { top * (1.0 + ABOVE) } else { 1.0 };
        let wide = FILLED / self.bars.len().max(1) as f64;

        let mut layers: Vec<Layer> = Vec::new();
        for (k, bars) in self.bars.iter().enumerate() {
            let area = |(i, value): (usize, &Option<f64>)| {
                let left = i as f64 - 0.5 * FILLED + k as f64 * wide;
                let value = (*value)?;
                Some(vec![(left, 0.0), (left + wide, 0.0), (left + wide, value), (left, value)])
            };
            let areas = bars.values.iter().enumerate().filter_map(area).collect();
            layers.push(Layer::Areas { areas, fill: bars.colour });
        }
        for marks in &self.marks {
            let across = |(i, value): (usize, &Option<f64>)| {
                let (at, value) = (i as f64, value.unwrap_or(f64::NAN));
                [(at - 0.5, value), (at + 0.5, value), (f64::NAN, f64::NAN)]
            };
            let points = marks.values.iter().enumerate().flat_map(across).collect();
            layers.push(Layer::Line { points, stroke: marks.stroke.clone() });
        }
        Panel::new(ChartAxis::linear(self.title.clone(), 0.0, top), height, layers)
    }
}

/// Tensions with the minimum and the maximum payload, between their limits.
///
/// # Errors
/// Payloads without limits.
pub(super) fn of_payload(found: &Payload) -> Result<Chart> {
    let bounds = [("minimum", Some(&found.minimum), ORANGE), ("maximum", found.maximum.as_ref(), BLUE)];
    let shown = bounds.into_iter().filter_map(|(name, bound, colour)| Some((name, bound?, colour)));
    let shown: Vec<_> = shown.filter(|(_, bound, _)| !bound.cables.is_empty()).collect();
    let Some((_, last, _)) = shown.last() else {
        bail!("no tension limit bounds the payload, so that there is nothing to draw: give ⟪max_tension_n⟫");
    };
    let bars = shown.iter().map(|(name, bound, colour)| {
        let text = format!("{name} payload, {} kg", significant(bound.payload_kg, 4));
        largest(text, *colour, &bound.cables)
    });
    let panel = BarPanel { title: "tension [N]".to_owned(), bars: bars.collect(), marks: limits(&last.cables) };
    Ok(chart(format!("{}: payload", found.robot), "cable", &names(&last.cables), &[panel], 0.5))
}

/// Tensions with the largest multiple of the required loads, between their limits.
///
/// # Errors
/// A robot without a largest multiple.
pub(super) fn of_loads(found: &Loads) -> Result<Chart> {
    let Some(held) = &found.required else {
        match &found.dead_load_reason {
            Some(reason) => bail!("the dead load is not held, so that there are no tensions to draw: {reason}"),
            None => bail!("nothing is required, so that there is nothing to draw: give ⟪required_force_n⟫"),
        }
    };
    let (Some(factor), false) = (held.load_factor, held.cables.is_empty()) else {
        bail!("no maximum tension limits the required loads, so that there is nothing to draw: give ⟪max_tension_n⟫");
    };
    let verdict = if held.held { "held" } else { "not held" };
    let text = format!("{} × required load: {verdict}", significant(factor, 3));
    let bars = vec![largest(text, BLUE, &held.cables)];
    let panel = BarPanel { title: "tension [N]".to_owned(), bars, marks: limits(&held.cables) };
    Ok(chart(format!("{}: required loads", found.robot), "cable", &names(&held.cables), &[panel], 0.5))
}

fn names(cables: &[LoadedRow]) -> Vec<String> {
    cables.iter().map(|cable| cable.name.clone()).collect()
}

/// Bars of the larger tension at the two ends.
fn largest(text: String, colour: Colour, cables: &[LoadedRow]) -> Bars {
    let values = cables.iter().map(|cable| Some(cable.tension_platform_n.max(cable.tension_anchor_n))).collect();
    Bars { text, colour, values }
}

/// BarMarks of the minimum and the maximum tension.
fn limits(cables: &[LoadedRow]) -> Vec<BarMarks> {
    let minimum = cables.iter().map(|cable| Some(cable.limits.minimum_tension_n).filter(|minimum| *minimum > 0.0));
    let maximum = cables.iter().map(|cable| cable.limits.maximum_tension_n);
    let dashed = Stroke { dashes: vec![3.0, 1.5], ..Stroke::solid(BLACK, 2.0 * AXIS_WIDTH) };
    let solid = Stroke::solid(BLACK, 2.0 * AXIS_WIDTH);
    vec![
        BarMarks { text: "maximum tension".to_owned(), stroke: solid, values: maximum.collect() },
        BarMarks { text: "minimum tension".to_owned(), stroke: dashed, values: minimum.collect() },
    ]
}
