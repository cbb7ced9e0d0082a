//! Figure of `workspace`: its sections with planes at right angles to one axis, and the anchors of the cables.

use super::axis::ChartAxis;
use super::chart::{Chart, Entry, Layer, Panel, Sample};
use super::style::{self, GREY, Symbol, SymbolShape};
use anyhow::{Result, bail};
use funicular_study::analyses::workspace::{SectionOfWorkspace, Workspace};
use funicular_study::text::{short, significant};

/// Room around sections and anchors, as a part of their extent.
const AROUND: f64 = 0.05;

/// Axes of the world.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Sections of a workspace, one curve style each.
///
/// # Errors
/// No section, or sections along several axes.
pub(super) fn chart(found: &Workspace) -> Result<Chart> {
    let Some(axis) = found.sections.first().map(|section| section.axis) else {
        bail!("a figure of a workspace shows its sections: give ⟪section⟫, as in z=0.5,1,1.5");
    };
    if let Some(other) = found.sections.iter().find(|section| section.axis != axis) {
        bail!(
            "a figure shows sections along one axis: there are some along {axis} and along {}; leave out one",
            other.axis
        );
    }
    let normal = AXES.iter().position(|name| *name == axis).unwrap_or(2);
    let [across, up] = match normal {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    };

    let (mut layers, mut legend) = (Vec::new(), Vec::new());
    for (i, section) in found.sections.iter().enumerate() {
        let stroke = style::curve(i);
        for polygon in &section.polygons_m {
            let closed = polygon.iter().chain(polygon.first());
            let points = closed.map(|point| (point[across], point[up])).collect();
            layers.push(Layer::Line { points, stroke: stroke.clone() });
        }
        legend.push(Entry { text: text_of(section), sample: Sample::Line(stroke) });
    }
    let anchors: Vec<(f64, f64)> = found.anchors.iter().map(|anchor| (anchor[across], anchor[up])).collect();
    let symbol = Symbol { shape: SymbolShape::Cross, colour: GREY };
    layers.push(Layer::Symbols { points: anchors.clone(), symbol });
    legend.push(Entry { text: "anchor".to_owned(), sample: Sample::Symbol(symbol) });

    let of_sections = found.sections.iter().flat_map(|section| section.polygons_m.iter().flatten());
    let points: Vec<(f64, f64)> = of_sections.map(|point| (point[across], point[up])).chain(anchors).collect();
    let [x, y] = [limits(points.iter().map(|point| point.0)), limits(points.iter().map(|point| point.1))];
    let y_axis = ChartAxis::linear(format!("{} [m]", AXES[up]), y[0], y[1]);
    Ok(Chart {
        title: format!("{}: workspace", found.robot),
        x: ChartAxis::linear(format!("{} [m]", AXES[across]), x[0], x[1]),
        panels: vec![Panel { equal_scales: true, ..Panel::new(y_axis, (y[1] - y[0]) / (x[1] - x[0]), layers) }],
        legend,
        colour_bar: None,
    })
}

/// Plane and area of a section.
fn text_of(section: &SectionOfWorkspace) -> String {
    format!("{} = {} m, {} m²", section.axis, short(section.at_m, 4), significant(section.area_m2, 4))
}

/// Least and greatest value with some room.
fn limits(values: impl Iterator<Item = f64> + Clone) -> [f64; 2] {
    let (low, high) = (values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max));
    let room = AROUND * (high - low).max(f64::MIN_POSITIVE);
    [low - room, high + room]
}
