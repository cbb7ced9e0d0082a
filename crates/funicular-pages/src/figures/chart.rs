//! Charts: panels one above the other with a common horizontal axis, and a legend above them.

use super::axis::{ChartAxis, Placed, Ticks};
use super::drawing::{
    Align, BLACK, Colour, Drawing, Frame, Label, MIN_FITTING, PaperPoint, Stroke, WHITE, clipped, simplified,
};
use super::map::{ColourBar, Map};
use super::style::{AXIS_WIDTH, Symbol, Type};

/// Chart of panels with one horizontal axis.
pub(crate) struct Chart {
    pub(crate) title: String,
    pub(crate) x: ChartAxis,
    pub(crate) panels: Vec<Panel>,
    pub(crate) legend: Vec<Entry>,
    pub(crate) colour_bar: Option<ColourBar>,
}

/// Panel of a chart.
pub(crate) struct Panel {
    pub(crate) y: ChartAxis,
    /// Height relative to the width of the figure.
    pub(crate) height: f64,
    /// True if both axes have the same scale, which then gives the height.
    pub(crate) equal_scales: bool,
    /// True if the panel shows no vertical axis.
    pub(crate) bare: bool,
    pub(crate) layers: Vec<Layer>,
}

/// Content of a panel, in the order of drawing.
pub(crate) enum Layer {
    /// Line through points; a value that is not finite interrupts it.
    Line { points: Vec<(f64, f64)>, stroke: Stroke },
    /// Symbols at points.
    Symbols { points: Vec<(f64, f64)>, symbol: Symbol },
    /// Vertical lines over a part of the panel's height.
    Stems { x: Vec<f64>, from: f64, to: f64, stroke: Stroke },
    /// Grey bands over the whole height.
    Bands(Vec<(f64, f64)>),
    /// Areas within corners, as far as the panel shows them.
    Areas { areas: Vec<Vec<(f64, f64)>>, fill: Colour },
    /// Texts at points, upwards.
    Upright { texts: Vec<(f64, f64, String)>, colour: Colour },
    /// Map of values over both axes.
    Map(Box<Map>),
}

/// Entry of the legend.
pub(crate) struct Entry {
    pub(crate) text: String,
    pub(crate) sample: Sample,
}

/// Sample of an entry.
pub(crate) enum Sample {
    Line(Stroke),
    Symbol(Symbol),
    LineAndSymbol(Stroke, Symbol),
    Band,
    Area(Colour),
    Hatch,
    Stem(Stroke),
}

/// Colour of the bands.
pub(crate) const BAND: Colour = [0xdc, 0xdc, 0xdc];

impl Panel {
    pub(crate) fn new(y: ChartAxis, height: f64, layers: Vec<Layer>) -> Self {
        Self { y, height, equal_scales: false, bare: false, layers }
    }
}

impl Chart {
    /// Drawing of the chart with a width [pt] and a size of the texts.
    pub(crate) fn draw(&self, width: f64, style: &Type) -> Drawing {
        let mut drawing = Drawing::new(&self.title, width);
        let size = style.size;
        let gap = 0.45 * size;
        let y_room = |_: &Label| 1.9 * size;

        // Margins: the labels of the vertical axes on the left, half of the last label on the right.
        let panel_heights: Vec<f64> = self.panels.iter().map(|panel| panel.height_in(&drawing, size)).collect();
        let y_ticks: Vec<Ticks> =
            self.panels.iter().zip(&panel_heights).map(|(panel, height)| panel.y.ticks(*height, &y_room)).collect();
        let widest = self.panels.iter().zip(&y_ticks).filter(|(panel, _)| !panel.bare);
        let widest = widest.flat_map(|(_, ticks)| &ticks.ticks).filter_map(|tick| tick.label.as_ref());
        let widest = widest.map(|label| drawing.width_of(label, size)).fold(0.0, f64::max);
        let left = 1.2 * size + gap + widest + style.tick + gap;
        let bar = self.colour_bar.as_ref().map_or(0.0, |bar| bar.width(&drawing, size));
        let right = width - bar - 0.9 * size;

        let x_room = |label: &Label| drawing.width_of(label, size) + 0.9 * size;
        let mut x_ticks = self.x.ticks(right - left, &x_room);
        if self.x.labels.is_some() {
            self.x.leave_out_crowded(&mut x_ticks, right - left, &x_room);
        }
        let top = self.draw_legend(&mut drawing, 0.25 * size, style);

        // Panels from top to bottom.
        let mut at = top;
        let last = self.panels.len() - 1;
        for (i, panel) in self.panels.iter().enumerate() {
            let height = if panel.equal_scales {
                (panel.y.high - panel.y.low) / (self.x.high - self.x.low) * (right - left)
            } else {
                panel_heights[i]
            };
            let frame = Frame { left, top: at, right, bottom: at + height };
            let placed = Placed { frame, x: &self.x, y: &panel.y };
            for layer in &panel.layers {
                draw_layer(&mut drawing, &placed, layer, style);
            }
            let again;
            let of_y = if panel.equal_scales {
                again = panel.y.ticks(height, &y_room);
                &again
            } else {
                &y_ticks[i]
            };
            draw_frame(&mut drawing, &placed, panel, (&x_ticks, of_y), i == last, style);
            if let Some(bar) = self.colour_bar.as_ref().filter(|_| i == last) {
                bar.draw(&mut drawing, &frame, style);
            }
            at = frame.bottom + if i == last { 0.0 } else { 0.75 * size };
        }

        let base = self.draw_x_labels(&mut drawing, &x_ticks, [left, right], at, style);
        drawing.height = base + 1.95 * size;
        drawing
    }

    /// Draws labels and title of the common axis below the last panel, which ends at `bottom`. Returns the base line of
    /// the labels.
    fn draw_x_labels(
        &self,
        drawing: &mut Drawing,
        x_ticks: &Ticks,
        [left, right]: [f64; 2],
        bottom: f64,
        style: &Type,
    ) -> f64 {
        let size = style.size;
        let base = bottom + style.tick + 0.35 * size + drawing.font.capital_height() * size;
        for tick in &x_ticks.ticks {
            let Some(label) = &tick.label else { continue };
            let x = left + self.x.fraction(tick.at) * (right - left);
            drawing.text(label.clone(), [x, base], Align::Middle, size, BLACK);
        }
        let title = self.x.title(x_ticks.exponent);
        let fitting = drawing.fitting(&title, size, drawing.width - size);
        let half = 0.5 * drawing.width_of(&title, fitting);
        let middle = (0.5 * (left + right)).clamp(half, (drawing.width - half).max(half));
        drawing.text(title, [middle, base + 1.45 * size], Align::Middle, fitting, BLACK);
        base
    }

    /// Draws the legend in rows from the top, and returns the top of the panels.
    fn draw_legend(&self, drawing: &mut Drawing, top: f64, style: &Type) -> f64 {
        if self.legend.is_empty() {
            return top + 0.6 * style.size;
        }
        let size = style.size;
        let (sample, gap, row) = (2.4 * size, 1.1 * size, 1.35 * size);
        let indent = 0.5 * size;
        let (mut x, mut y) = (indent, top + 0.85 * size);
        for entry in &self.legend {
            let label = Label::plain(&entry.text);
            let room = drawing.width - sample - 2.0 * indent;
            let fitting = drawing.fitting(&label, size, room);
            let length = sample + 0.4 * size + drawing.width_of(&label, fitting);
            if x > indent && x + length > drawing.width - indent {
                (x, y) = (indent, y + row);
            }
            entry.sample.draw(drawing, [x, y - 0.35 * size], sample, style);
            drawing.text(label, [x + sample + 0.4 * size, y], Align::Start, fitting, BLACK);
            x += length + gap;
        }
        y + 0.75 * size
    }
}

impl Sample {
    /// Draws the sample from a point to the right.
    fn draw(&self, drawing: &mut Drawing, at: PaperPoint, length: f64, style: &Type) {
        let [x, y] = at;
        let middle = [x + 0.5 * length, y];
        let half = 0.38 * style.size;
        let area = Frame { left: x + 0.2 * length, top: y - half, right: x + 0.8 * length, bottom: y + half };
        match self {
            Self::Line(stroke) => drawing.line(vec![at, [x + length, y]], stroke.clone()),
            Self::Symbol(symbol) => symbol.draw(drawing, &[middle], style),
            Self::LineAndSymbol(stroke, symbol) => {
                drawing.line(vec![at, [x + length, y]], stroke.clone());
                symbol.draw(drawing, &[middle], style);
            }
            Self::Band => drawing.areas(vec![area.corners()], Some(BAND), None),
            Self::Area(fill) => drawing.areas(vec![area.corners()], Some(*fill), None),
            Self::Hatch => super::map::hatch(drawing, &[area], style),
            Self::Stem(stroke) => drawing.line(vec![[middle[0], y - half], [middle[0], y + half]], stroke.clone()),
        }
    }
}

/// Draws the frame of a panel with the ticks of both axes, and labels and title of the vertical one.
fn draw_frame(
    drawing: &mut Drawing,
    placed: &Placed<'_>,
    panel: &Panel,
    (x_ticks, y_ticks): (&Ticks, &Ticks),
    is_last: bool,
    style: &Type,
) {
    let frame = placed.frame;
    let size = style.size;
    let axis = Stroke::solid(BLACK, AXIS_WIDTH);
    let length = |labelled: bool| if labelled { style.tick } else { 0.55 * style.tick };

    // Ticks outside, so that no data hide them; panels above another have none below.
    let mut marks = Vec::new();
    if is_last {
        for tick in &x_ticks.ticks {
            let x = placed.at(tick.at, panel.y.low)[0];
            marks.push(vec![[x, frame.bottom], [x, frame.bottom + length(tick.label.is_some())]]);
        }
    }
    if !panel.bare {
        for tick in &y_ticks.ticks {
            let y = frame.bottom - panel.y.fraction(tick.at) * frame.height();
            marks.push(vec![[frame.left - length(tick.label.is_some()), y], [frame.left, y]]);
            if let Some(label) = &tick.label {
                let base = y + 0.5 * drawing.font.capital_height() * size;
                let x = frame.left - style.tick - 0.4 * size;
                drawing.text(label.clone(), [x, base], Align::End, size, BLACK);
            }
        }
    }
    drawing.lines(marks, axis.clone());
    drawing.areas(vec![frame.corners()], None, Some(axis));

    if !panel.title_is_empty() {
        let title = panel.y.title(y_ticks.exponent);
        // Titles of neighbours do not meet between the panels.
        let fitting = drawing.fitting(&title, size, frame.height() + 0.6 * size);
        let middle = 0.5 * (frame.top + frame.bottom);
        drawing.turned_text(title, [1.1 * size, middle], Align::Middle, 90.0, fitting, BLACK);
    }
}

impl Panel {
    /// Height in a drawing, at least that of the title in its smallest letters.
    fn height_in(&self, drawing: &Drawing, size: f64) -> f64 {
        let height = self.height * drawing.width;
        if self.title_is_empty() {
            return height;
        }
        let title = drawing.width_of(&self.y.title(0), MIN_FITTING * size);
        height.max(title - 0.5 * size)
    }

    fn title_is_empty(&self) -> bool {
        self.bare || self.y.title.is_empty()
    }
}

fn draw_layer(drawing: &mut Drawing, placed: &Placed<'_>, layer: &Layer, style: &Type) {
    let frame = placed.frame;

    match layer {
        Layer::Line { points, stroke } => {
            let points: Vec<PaperPoint> = points.iter().map(|(x, y)| placed.at(*x, *y)).collect();
            // A value of zero on a logarithmic axis lies far below the panel, not at infinity: the line leads there.
            let below = 10.0 * frame.height();
            let points: Vec<PaperPoint> = points
                .into_iter()
                .map(|[x, y]| if y == f64::INFINITY { [x, frame.bottom + below] } else { [x, y] })
                .collect();
            let parts = clipped(&points, &frame);
            drawing.lines(parts.iter().map(|part| simplified(part)).collect(), stroke.clone());
        }

        Layer::Symbols { points, symbol } => {
            let points: Vec<PaperPoint> = points.iter().map(|(x, y)| placed.at(*x, *y)).collect();
            let inside: Vec<PaperPoint> = points.into_iter().filter(|point| frame.contains(*point)).collect();
            symbol.draw(drawing, &inside, style);
        }

        Layer::Stems { x, from, to, stroke } => {
            let y = |part: f64| frame.bottom - part * frame.height();
            let inside = x.iter().map(|x| placed.at(*x, placed.y.low)[0]);
            let inside = inside.filter(|x| (frame.left..=frame.right).contains(x));
            drawing.lines(inside.map(|x| vec![[x, y(*from)], [x, y(*to)]]).collect(), stroke.clone());
        }

        Layer::Bands(bands) => {
            let x = |value: f64| placed.at(value, placed.y.low)[0].clamp(frame.left, frame.right);
            let areas = bands.iter().map(|(from, to)| Frame { left: x(*from), right: x(*to), ..frame }.corners());
            drawing.areas(areas.collect(), Some(BAND), None);
        }

        Layer::Areas { areas, fill } => {
            let corner = |(x, y): &(f64, f64)| {
                let [x, y] = placed.at(*x, *y);
                // The logarithm of zero lies below every panel.
                let y = if y.is_nan() { frame.bottom } else { y };
                [x.clamp(frame.left, frame.right), y.clamp(frame.top, frame.bottom)]
            };
            drawing.areas(areas.iter().map(|area| area.iter().map(corner).collect()).collect(), Some(*fill), None);
        }

        Layer::Upright { texts, colour } => {
            for (x, y, text) in texts {
                let [x, y] = placed.at(*x, *y);
                let label = Label::plain(text);
                let base = x + 0.5 * drawing.font.capital_height() * style.small;
                let from = y - 0.4 * style.size;
                let end = from - drawing.width_of(&label, style.small);
                if !(frame.contains([x, end]) && frame.contains([x, from])) {
                    continue;
                }

                // White below the text keeps it legible on a curve.
                let (wide, tall) = (0.42 * style.small, 0.1 * style.small);
                let area = Frame { left: x - wide, top: end - tall, right: x + wide, bottom: from + tall };
                drawing.areas(vec![area.corners()], Some(WHITE), None);
                drawing.turned_text(label, [base, from], Align::Start, 90.0, style.small, *colour);
            }
        }

        Layer::Map(map) => map.draw(drawing, placed, style),
    }
}
