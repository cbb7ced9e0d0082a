//! Figures for papers, as SVG and PDF.
//!
//! A [`Figure`] describes what is drawn, independent of its size and of the format of the file. [`of_statics`] and its
//! neighbours make the figures of the commands, and [`crate::pages::plot::figure`] that of a map or sweep.
//! [`Figure::svg`] and [`Figure::pdf`] draw it with the width of a journal's column. Sizes of texts and lines are those
//! of the printed page. A PDF has the letters of its font embedded. The same figure always gives the same bytes.

pub(crate) mod axis;
mod bars;
pub(crate) mod bodies;
pub(crate) mod calibration;
pub(crate) mod chart;
mod contour;
pub(crate) mod drawing;
pub(crate) mod drive;
mod estimated;
mod font;
mod gusts;
pub(crate) mod hull;
mod making;
pub(crate) mod map;
mod motions;
mod pairs;
pub(crate) mod pdf;
pub(crate) mod proved;
mod sections;
mod settling;
pub(crate) mod simulated;
pub(crate) mod space;
pub(crate) mod style;
pub(crate) mod supports;
pub(crate) mod svg;
pub(crate) mod view;
mod winches;

pub use making::{
    RequestFigure, of_calibration, of_clearance, of_compare, of_decay, of_estimate, of_frf, of_gust, of_loads,
    of_modes, of_payload, of_proof, of_rest, of_sections, of_simulation, of_speeds, of_statics, of_trajectory,
    of_winches,
};
pub use space::animation_of_simulation;

pub use crate::figure_style::{DEFAULT_FONT_SIZE_PT, DEFAULT_WIDTH_MM, FONT_SIZE_LIMITS_PT, WIDTH_LIMITS_MM, WIDTHS};

use anyhow::{Result, anyhow, bail};
use chart::Chart;
use drawing::Drawing;
use funicular_study::values::positive;
use space::Space;
use style::Type;

/// Figure of one result.
pub struct Figure(pub(crate) FigureContent);

/// Content of a figure: a chart, or the robot in space.
pub(crate) enum FigureContent {
    Chart(Chart),
    Space(Box<Space>),
}

/// Size of a figure on paper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Size {
    width_mm: f64,
    font_size_pt: f64,
}

/// Maximum size of the texts relative to the width: larger ones leave no room for the curves.
const MAX_FONT_TO_WIDTH: f64 = 0.06;
/// Points per millimetre.
const POINTS: f64 = 72.0 / 25.4;

impl Default for Size {
    fn default() -> Self {
        Self { width_mm: DEFAULT_WIDTH_MM, font_size_pt: DEFAULT_FONT_SIZE_PT }
    }
}

impl Size {
    /// Size with a width [mm] and a size of the texts [pt]; the default replaces one that is not given.
    ///
    /// # Errors
    /// A width or a size out of its limits, or texts too large for the width.
    pub fn new(width_mm: Option<f64>, font_size_pt: Option<f64>) -> Result<Self> {
        let width_mm = within("figure_width_mm", width_mm.unwrap_or(DEFAULT_WIDTH_MM), WIDTH_LIMITS_MM, "mm")?;
        let font_size_pt =
            within("font_size_pt", font_size_pt.unwrap_or(DEFAULT_FONT_SIZE_PT), FONT_SIZE_LIMITS_PT, "pt")?;
        let most = MAX_FONT_TO_WIDTH * width_mm * POINTS;
        if font_size_pt > most {
            bail!(
                "⟪font_size_pt⟫: texts of {font_size_pt} pt leave no room for curves in a figure of {width_mm} mm: \
                 give at most {most:.0} pt, or a larger ⟪figure_width_mm⟫"
            );
        }
        Ok(Self { width_mm, font_size_pt })
    }
}

impl Size {
    /// Size of a figure on a page of texts, with a width [mm] that the page knows to be possible.
    pub(crate) fn of_page(width_mm: f64) -> Self {
        Self { width_mm, font_size_pt: DEFAULT_FONT_SIZE_PT.min(MAX_FONT_TO_WIDTH * width_mm * POINTS) }
    }
}

fn within(key: &str, value: f64, (low, high): (f64, f64), unit: &str) -> Result<f64> {
    let value = positive(value).map_err(|reason| anyhow!("⟪{key}⟫: {reason}"))?;
    if !(low..=high).contains(&value) {
        bail!("⟪{key}⟫: {value} {unit} is out of range: give {low} to {high} {unit}");
    }
    Ok(value)
}

/// Width of a figure [mm] from a number or from the name of a column such as `ieee-single`.
///
/// # Errors
/// A text that is neither, with the names.
pub fn width_mm(text: &str) -> Result<f64, String> {
    let text = text.trim();
    if let Some((_, width)) = WIDTHS.iter().find(|(name, _)| *name == text) {
        return Ok(*width);
    }
    text.parse::<f64>().ok().filter(|width| width.is_finite()).ok_or_else(|| {
        let names: Vec<String> = WIDTHS.iter().map(|(name, width)| format!("{name} ({width})")).collect();
        format!("`{text}` is neither a width in millimetres nor a column: the columns are {}", names.join(", "))
    })
}

impl Figure {
    /// Text of the figure as SVG.
    pub fn svg(&self, size: Size) -> String {
        svg::svg(&self.draw(size))
    }

    /// Bytes of the figure as PDF, one page of the figure's size.
    pub fn pdf(&self, size: Size) -> Vec<u8> {
        pdf::pdf(&self.draw(size))
    }

    pub(crate) fn draw(&self, size: Size) -> Drawing {
        let (width, style) = (size.width_mm * POINTS, Type::new(size.font_size_pt));
        match &self.0 {
            FigureContent::Chart(chart) => chart.draw(width, &style),
            FigureContent::Space(space) => space.draw(width, &style),
        }
    }
}

#[cfg(test)]
mod tests;
