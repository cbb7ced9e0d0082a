//! Figure of `calibrate`: anchors with their ellipses, the weakest combination, poses of the rows and proposed poses.

use super::axis::ChartAxis;
use super::chart::{Chart, Entry, Layer, Panel, Sample};
use super::drawing::Stroke;
use super::style::{AXIS_WIDTH, GREY, Symbol, SymbolShape};
use crate::figure_style::{colour, rgb};
use funicular_study::analyses::calibrate::{AnchorRow, Calibrated, ToolRow};
use funicular_study::text::significant;
use std::f64::consts::TAU;

/// Number of points of an ellipse.
const POINTS: u32 = 72;

/// Width of the ellipses of the tool [pt].
const TOOL_WIDTH: f64 = 0.6;

/// View along a world axis.
pub(crate) struct AxisView {
    /// World axes to the right and upwards.
    pub(crate) axes: [usize; 2],
    pub(crate) name: &'static str,
}

/// Views of a calibration: one of a planar platform, two of others.
pub(crate) fn views(found: &Calibrated) -> Vec<AxisView> {
    match found.axes[..] {
        [a, b] => vec![AxisView { axes: [a, b], name: "in the plane of the platform" }],
        _ => vec![AxisView { axes: [0, 1], name: "along z" }, AxisView { axes: [0, 2], name: "along y" }],
    }
}

/// Point with a covariance, as two deviations in a view.
pub(crate) struct UncertainPoint {
    position_m: [f64; 3],
    covariance_m2: Option<[[f64; 3]; 3]>,
}

impl From<&AnchorRow> for UncertainPoint {
    fn from(row: &AnchorRow) -> Self {
        Self { position_m: row.position_m, covariance_m2: row.covariance_m2 }
    }
}

impl From<&ToolRow> for UncertainPoint {
    fn from(row: &ToolRow) -> Self {
        Self { position_m: row.position_m, covariance_m2: Some(row.covariance_m2) }
    }
}

/// Poses of the accuracy of the tool.
pub(crate) fn tool_rows(found: &Calibrated) -> &[ToolRow] {
    found.accuracy.as_ref().map_or(&[], |accuracy| &accuracy.poses)
}

/// Ellipse of two deviations in a view, larger by a factor; empty without deviations.
pub(crate) fn ellipse(of: impl Into<UncertainPoint>, [a, b]: [usize; 2], scale: f64) -> Vec<(f64, f64)> {
    let UncertainPoint { position_m, covariance_m2 } = of.into();
    let Some(covariance) = covariance_m2 else { return Vec::new() };
    // Lower Cholesky factor of the covariance in the view: it maps the unit circle to the ellipse.
    let l11 = covariance[a][a].max(0.0).sqrt();
    let l21 = if l11 > 0.0 { covariance[a][b] / l11 } else { 0.0 };
    let l22 = (covariance[b][b] - l21 * l21).max(0.0).sqrt();
    let point = |k: u32| {
        let (sine, cosine) = (TAU * f64::from(k) / f64::from(POINTS)).sin_cos();
        let half = 2.0 * scale;
        (position_m[a] + half * l11 * cosine, position_m[b] + half * (l21 * cosine + l22 * sine))
    };
    (0..=POINTS).map(point).collect()
}

/// Chart of a calibration: one panel per view, all with the same scale.
pub(super) fn chart(found: &Calibrated) -> Chart {
    let scale = found.magnification();
    let panels: Vec<Panel> = views(found).iter().map(|view| panel(found, view, scale)).collect();
    let (low, high) = range(found, 0);
    let symbol = |shape, colour| Sample::Symbol(Symbol { shape, colour: rgb(colour) });
    let mut legend = vec![
        Entry { text: "robot file".to_owned(), sample: symbol(SymbolShape::HollowCircle, colour::BLACK) },
        Entry { text: "calibrated".to_owned(), sample: symbol(SymbolShape::Square, colour::BLUE) },
        Entry {
            text: format!("2 deviations, {} times as large", significant(scale, 2)),
            sample: Sample::Line(Stroke::solid(rgb(colour::BLUE), 1.0)),
        },
        Entry {
            text: "weakest combination".to_owned(),
            sample: Sample::Line(Stroke::solid(rgb(colour::VERMILION), 1.2)),
        },
        Entry { text: "rows".to_owned(), sample: symbol(SymbolShape::Circle, colour::GREEN) },
    ];
    if found.accuracy.is_some() {
        let sample = Sample::Line(Stroke::solid(rgb(colour::ORANGE), TOOL_WIDTH));
        legend.push(Entry { text: "tool, as large".to_owned(), sample });
    }
    if !found.proposals.is_empty() {
        let text = "to measure next".to_owned();
        legend.push(Entry { text, sample: symbol(SymbolShape::Diamond, colour::PURPLE) });
    }
    let first = views(found)[0].axes[0];
    Chart {
        title: format!("{}: calibration", found.robot),
        x: ChartAxis::linear(format!("{} [m]", NAMES[first]), low, high),
        panels,
        legend,
        colour_bar: None,
    }
}

const NAMES: [&str; 3] = ["x", "y", "z"];

/// Room beside the outermost points, as a part of their distance.
const BESIDE: f64 = 0.12;

/// Range of the first (0) or of another axis that holds all points.
fn range(found: &Calibrated, axis: usize) -> (f64, f64) {
    let axis = if axis == 0 { views(found)[0].axes[0] } else { axis };
    let anchors = found.anchors.iter().flat_map(|row| [row.position_m[axis], row.start_m[axis]]);
    let rows = found.rows.iter().map(|row| row.position_m[axis]);
    let proposed = found.proposals.iter().map(|row| row.position_m[axis]);
    let tool = tool_rows(found).iter().map(|row| row.position_m[axis]);
    let all = anchors.chain(rows).chain(proposed).chain(tool);
    let (low, high) = all.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
    let beside = BESIDE * (high - low).max(f64::MIN_POSITIVE);
    (low - beside, high + beside)
}

fn panel(found: &Calibrated, view: &AxisView, scale: f64) -> Panel {
    let [a, b] = view.axes;
    let at = |point: [f64; 3]| (point[a], point[b]);
    let symbols = |points: Vec<(f64, f64)>, shape, colour| Layer::Symbols {
        points,
        symbol: Symbol { shape, colour: rgb(colour) },
    };
    let mut layers = Vec::new();
    // Cables from the middle of the rows show which anchors belong together.
    let count = found.rows.len().max(1) as f64;
    let middle = [0, 1, 2].map(|k| found.rows.iter().map(|row| row.position_m[k]).sum::<f64>() / count);
    for anchor in &found.anchors {
        let points = vec![at(middle), at(anchor.position_m)];
        layers.push(Layer::Line { points, stroke: Stroke::solid(GREY, AXIS_WIDTH) });
    }
    for anchor in &found.anchors {
        layers.push(Layer::Line {
            points: ellipse(anchor, view.axes, scale),
            stroke: Stroke::solid(rgb(colour::BLUE), 1.0),
        });
        if let Some(weak) = anchor.weakest_m {
            let end = |side: f64| at([0, 1, 2].map(|k| anchor.position_m[k] + side * 2.0 * scale * weak[k]));
            let stroke = Stroke::solid(rgb(colour::VERMILION), 1.2);
            layers.push(Layer::Line { points: vec![end(-1.0), end(1.0)], stroke });
        }
    }
    for row in tool_rows(found) {
        let stroke = Stroke::solid(rgb(colour::ORANGE), TOOL_WIDTH);
        layers.push(Layer::Line { points: ellipse(row, view.axes, scale), stroke });
    }
    let starts = found.anchors.iter().map(|row| at(row.start_m)).collect();
    layers.push(symbols(starts, SymbolShape::HollowCircle, colour::BLACK));
    let places = found.anchors.iter().map(|row| at(row.position_m)).collect();
    layers.push(symbols(places, SymbolShape::Square, colour::BLUE));
    layers.push(symbols(found.rows.iter().map(|row| at(row.position_m)).collect(), SymbolShape::Circle, colour::GREEN));
    let proposed = found.proposals.iter().map(|row| at(row.position_m)).collect();
    layers.push(symbols(proposed, SymbolShape::Diamond, colour::PURPLE));
    let (low, high) = range(found, b);
    Panel {
        y: ChartAxis::linear(format!("{} [m]", NAMES[b]), low, high),
        height: 0.5,
        equal_scales: true,
        bare: false,
        layers,
    }
}
