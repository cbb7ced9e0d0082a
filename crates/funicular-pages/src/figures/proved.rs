//! Figure of `prove`: a section through the middle of the box with what is proved inside, outside and neither.

use super::axis::ChartAxis;
use super::chart::{Chart, Entry, Layer, Panel, Sample};
use super::drawing::Colour;
use super::style::{BLUE, GREY, ORANGE, Symbol, SymbolShape};
use anyhow::{Result, bail};
use funicular_study::analyses::prove::{BoxRow, Proved};
use funicular_study::text::short;

/// Axes of the world.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Verdicts with their colours, in the order of the legend.
pub(crate) const SETS: [(&str, &str, Colour); 3] =
    [("inside", "proved inside", BLUE), ("undecided", "undecided", ORANGE), ("outside", "proved outside", GREY)];

/// Plane of a section: axes to the right and upwards, and the axis at right angles with its coordinate [m].
pub(crate) struct SectionPlane {
    pub(crate) across: usize,
    pub(crate) up: usize,
    pub(crate) normal: usize,
    pub(crate) at: f64,
}

impl SectionPlane {
    /// Plane through the middle of the box: at right angles to an axis without a width, or else to z.
    ///
    /// # Errors
    /// A box without an area.
    pub(crate) fn of(found: &Proved) -> Result<Self> {
        let flat: Vec<usize> = (0..3).filter(|k| found.within_m[*k] <= 0.0).collect();
        let normal = match flat[..] {
            [] => 2,
            [axis] => axis,
            _ => bail!("the figure of a proof is a section of the box: give ⟪within_m⟫ with at least two widths"),
        };
        let [across, up] = match normal {
            0 => [1, 2],
            1 => [0, 2],
            _ => [0, 1],
        };
        // Beside the planes in which boxes are divided.
        let at = found.pose.position_m[normal] + 0.003 * found.within_m[normal];
        Ok(Self { across, up, normal, at })
    }

    /// Corners of the boxes with a verdict that the plane cuts.
    pub(crate) fn cut<'a>(&'a self, found: &'a Proved, verdict: &'a str) -> impl Iterator<Item = [[f64; 2]; 2]> + 'a {
        let is_cut = |of: &&BoxRow| of.lower_m[self.normal] <= self.at && self.at <= of.upper_m[self.normal];
        let boxes = found.boxes.iter().filter(move |of| of.verdict == verdict).filter(is_cut);
        boxes.map(|of| [of.lower_m, of.upper_m].map(|at| [at[self.across], at[self.up]]))
    }

    /// Plane in words.
    pub(crate) fn in_words(&self) -> String {
        format!("{} = {} m", AXES[self.normal], short(self.at, 4))
    }

    /// Titles of both axes.
    pub(crate) fn titles(&self) -> [String; 2] {
        [self.across, self.up].map(|axis| format!("{} [m]", AXES[axis]))
    }
}

/// Section with the three sets.
///
/// # Errors
/// A box without an area.
pub(super) fn chart(found: &Proved) -> Result<Chart> {
    let plane = SectionPlane::of(found)?;
    let (mut layers, mut legend) = (Vec::new(), Vec::new());
    for (verdict, text, fill) in SETS {
        let corners =
            |[[left, low], [right, high]]: [[f64; 2]; 2]| vec![(left, low), (right, low), (right, high), (left, high)];
        let areas: Vec<Vec<(f64, f64)>> = plane.cut(found, verdict).map(corners).collect();
        layers.push(Layer::Areas { areas, fill });
        legend.push(Entry { text: text.to_owned(), sample: Sample::Area(fill) });
    }
    let ends = |axis: usize| {
        let (middle, half) = (found.pose.position_m[axis], 1.05 * found.within_m[axis]);
        [middle - half, middle + half]
    };
    let middle = vec![(found.pose.position_m[plane.across], found.pose.position_m[plane.up])];
    layers.push(Layer::Symbols { points: middle, symbol: Symbol { shape: SymbolShape::Cross, colour: GREY } });
    let ([left, right], [low, high], [x, y]) = (ends(plane.across), ends(plane.up), plane.titles());
    let panel = Panel::new(ChartAxis::linear(y, low, high), (high - low) / (right - left), layers);
    Ok(Chart {
        title: format!("{}: proof, {}", found.robot, plane.in_words()),
        x: ChartAxis::linear(x, left, right),
        panels: vec![Panel { equal_scales: true, ..panel }],
        legend,
        colour_bar: None,
    })
}
