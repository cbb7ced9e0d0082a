//! Sizes, colours, dashes and symbols of figures.
//!
//! Colours are those of [`crate::figure_style`]. Lines differ in their dashes too, so that a figure printed in grey
//! keeps its meaning.

use super::drawing::{BLACK, Colour, Drawing, Frame, PaperPoint, Stroke, WHITE};
use crate::figure_style::{colour, rgb};
use funicular::cable::CableModel;

pub(crate) const ORANGE: Colour = rgb(colour::ORANGE);
pub(crate) const SKY: Colour = rgb(colour::SKY);
pub(crate) const GREEN: Colour = rgb(colour::GREEN);
pub(crate) const BLUE: Colour = rgb(colour::BLUE);
pub(crate) const VERMILION: Colour = rgb(colour::VERMILION);
pub(crate) const PURPLE: Colour = rgb(colour::PURPLE);
pub(crate) const GREY: Colour = rgb(colour::GREY);

/// Width of axes and ticks [pt]; publishers ask for at least 0.25 pt.
pub(crate) const AXIS_WIDTH: f64 = 0.5;
/// Width of curves [pt].
pub(crate) const CURVE_WIDTH: f64 = 1.0;

const COLOURS: [Colour; 7] = [BLUE, VERMILION, GREEN, PURPLE, ORANGE, BLACK, SKY];
/// Dashes and gaps in multiples of the width of the line. Eight patterns with seven colours give 56 different lines.
const DASHES: [&[f64]; 8] = [
    &[],
    &[5.0, 2.0],
    &[1.2, 1.5],
    &[6.0, 1.6, 1.2, 1.6],
    &[10.0, 2.5],
    &[6.0, 1.6, 1.2, 1.6, 1.2, 1.6],
    &[3.0, 1.4],
    &[10.0, 1.6, 3.0, 1.6],
];
const SHAPES: [SymbolShape; 6] = [
    SymbolShape::Circle,
    SymbolShape::Square,
    SymbolShape::Triangle,
    SymbolShape::Diamond,
    SymbolShape::Cross,
    SymbolShape::HollowCircle,
];

/// Line of the curve with this number.
pub(crate) fn curve(number: usize) -> Stroke {
    let dashes = DASHES[number % DASHES.len()].iter().map(|length| length * CURVE_WIDTH).collect();
    Stroke { colour: COLOURS[number % COLOURS.len()], width: CURVE_WIDTH, dashes }
}

/// Symbol of the points with this number.
pub(crate) fn symbol(number: usize) -> Symbol {
    Symbol { shape: SHAPES[number % SHAPES.len()], colour: COLOURS[number % COLOURS.len()] }
}

/// Sizes of texts and ticks [pt].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Type {
    /// Size of the texts.
    pub(crate) size: f64,
    /// Size of numbers inside a figure.
    pub(crate) small: f64,
    /// Length of a tick.
    pub(crate) tick: f64,
}

impl Type {
    pub(crate) fn new(size: f64) -> Self {
        Self { size, small: 0.85 * size, tick: 0.35 * size }
    }
}

/// Shape of a symbol.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SymbolShape {
    Circle,
    HollowCircle,
    Square,
    Triangle,
    Diamond,
    Cross,
}

/// Marks of a cable model, equal in all figures.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ModelStyle {
    /// Colour `#rrggbb`.
    pub(crate) colour: &'static str,
    /// Dash of its curves on a page.
    pub(crate) dash: &'static str,
    /// Shape of its symbols in a figure for a paper.
    pub(crate) shape: SymbolShape,
}

impl ModelStyle {
    pub(crate) const fn of(model: CableModel) -> Self {
        let (colour, dash, shape) = match model {
            CableModel::CatenaryDynamic => (colour::BLACK, "solid", SymbolShape::HollowCircle),
            CableModel::ShallowDynamic => (colour::BLUE, "solid", SymbolShape::Circle),
            CableModel::ShallowStatic => (colour::ORANGE, "dash", SymbolShape::Square),
            CableModel::Spring => (colour::GREEN, "dot", SymbolShape::Triangle),
            CableModel::CatenaryStatic => (colour::PURPLE, "dashdot", SymbolShape::Diamond),
        };
        Self { colour, dash, shape }
    }
}

/// Symbol at a point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Symbol {
    pub(crate) shape: SymbolShape,
    pub(crate) colour: Colour,
}

impl Symbol {
    /// Draws the symbol at points.
    pub(crate) fn draw(self, drawing: &mut Drawing, points: &[PaperPoint], style: &Type) {
        let half = 0.19 * style.size;
        let around = |[x, y]: PaperPoint, corners: &[[f64; 2]]| -> Vec<PaperPoint> {
            corners.iter().map(|[dx, dy]| [x + half * dx, y + half * dy]).collect()
        };
        let circle: Vec<[f64; 2]> =
            (0..12).map(|k| f64::from(k) * 30_f64.to_radians()).map(|angle| [angle.cos(), angle.sin()]).collect();

        let corners: &[[f64; 2]] = match self.shape {
            SymbolShape::Circle | SymbolShape::HollowCircle => &circle,
            SymbolShape::Square => &[[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]],
            SymbolShape::Triangle => &[[-1.1, 0.8], [0.0, -1.1], [1.1, 0.8]],
            SymbolShape::Diamond => &[[0.0, -1.25], [1.25, 0.0], [0.0, 1.25], [-1.25, 0.0]],
            SymbolShape::Cross => {
                let lines = points
                    .iter()
                    .flat_map(|p| [around(*p, &[[-0.9, -0.9], [0.9, 0.9]]), around(*p, &[[-0.9, 0.9], [0.9, -0.9]])]);
                drawing.lines(lines.collect(), Stroke::solid(self.colour, 0.8));
                return;
            }
        };

        let areas: Vec<Vec<PaperPoint>> = points.iter().map(|p| around(*p, corners)).collect();
        let fill = if self.shape == SymbolShape::HollowCircle { WHITE } else { self.colour };
        drawing.areas(areas, Some(fill), Some(Stroke::solid(self.colour, 0.5)));
    }
}

/// Colours of maps, light to dark: part of matplotlib's colour map plasma, whose lightness falls evenly, so that a map
/// printed in grey keeps its order.
const MAP: [Colour; 7] = [
    [0xfd, 0xd5, 0x6a],
    [0xfd, 0xb5, 0x2e],
    [0xf8, 0x95, 0x40],
    [0xe9, 0x72, 0x57],
    [0xd5, 0x53, 0x6f],
    [0xb8, 0x32, 0x89],
    [0x8f, 0x0d, 0xa4],
];

/// Colour of a fraction from 0 to 1 of a map's range.
pub(crate) fn of_map(fraction: f64) -> Colour {
    let at = fraction.clamp(0.0, 1.0) * (MAP.len() - 1) as f64;
    let k = (at.floor() as usize).min(MAP.len() - 2);
    let part = |i: usize| {
        let (a, b) = (f64::from(MAP[k][i]), f64::from(MAP[k + 1][i]));
        (a + (at - k as f64) * (b - a)).round() as u8
    };
    [part(0), part(1), part(2)]
}

/// Lightness of a colour from 0 to 1, as the eye weighs red, green and blue.
pub(crate) fn lightness([r, g, b]: Colour) -> f64 {
    (0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b)) / 255.0
}

/// Rectangle around points.
pub(crate) fn around(points: impl Iterator<Item = PaperPoint>) -> Frame {
    let mut frame =
        Frame { left: f64::INFINITY, top: f64::INFINITY, right: f64::NEG_INFINITY, bottom: f64::NEG_INFINITY };
    for [x, y] in points {
        (frame.left, frame.right) = (frame.left.min(x), frame.right.max(x));
        (frame.top, frame.bottom) = (frame.top.min(y), frame.bottom.max(y));
    }
    frame
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_curves_differ_in_colour_and_in_grey() {
        for i in 0..7 {
            for j in 0..i {
                assert_ne!(curve(i).colour, curve(j).colour);
                assert_ne!(curve(i).dashes, curve(j).dashes, "in grey only dashes are left");
            }
        }
        let all: Vec<Stroke> = (0..56).map(curve).collect();
        assert!(all.iter().enumerate().all(|(i, one)| !all[..i].contains(one)));
    }

    #[test]
    fn colours_of_a_map_darken_evenly() {
        let grey: Vec<f64> = (0..=100).map(|k| lightness(of_map(f64::from(k) / 100.0))).collect();
        assert!(grey.windows(2).all(|pair| pair[1] < pair[0] + 2e-3), "{grey:?}");
        assert!(grey[0] - grey[100] > 0.5);
    }
}
