//! Maps of a quantity over two axes: coloured cells, contours with labels, hatched infeasible cells, a colour bar.

use super::axis::Placed;
use super::axis::{ChartAxis, nice_step, round_numbers};
use super::contour::contours;
use super::drawing::{Align, BLACK, Colour, Drawing, Frame, Label, PaperPoint, Stroke, WHITE};
use super::style::{AXIS_WIDTH, Type, lightness, of_map};
use funicular_study::text::short;

/// Values on a grid.
pub(crate) struct Map {
    /// Values of the axes, ascending.
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    /// Value of each cell, `y` by `y`; NaN for a cell without a value.
    pub(crate) values: Vec<f64>,
    /// True for each infeasible cell.
    pub(crate) infeasible: Vec<bool>,
    pub(crate) scale: ColourScale,
}

/// Range of colours.
#[derive(Debug, Clone)]
pub(crate) struct ColourScale {
    pub(crate) low: f64,
    pub(crate) high: f64,
    /// True for equal ratios between colours.
    pub(crate) logarithmic: bool,
}

/// Ratio of the largest to the smallest value from which colours have equal ratios, as on the page of a map.
const MIN_RATIO: f64 = 30.0;

impl ColourScale {
    /// Range of all values that are finite; `None` if there is none.
    pub(crate) fn of(values: &[f64]) -> Option<Self> {
        let finite = || values.iter().copied().filter(|value| value.is_finite());
        let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
        (low <= high).then_some(Self { low, high, logarithmic: low > 0.0 && high > MIN_RATIO * low })
    }

    fn fraction(&self, value: f64) -> f64 {
        let scaled = |value: f64| if self.logarithmic { value.ln() } else { value };
        let (low, high) = (scaled(self.low), scaled(self.high));
        // All values are equal: the middle of the colours.
        if high > low { (scaled(value) - low) / (high - low) } else { 0.5 }
    }

    /// Round values for contours.
    pub(crate) fn levels(&self) -> Vec<f64> {
        const ABOUT: f64 = 7.0;
        if self.high <= self.low {
            return Vec::new();
        }
        let mut levels: Vec<f64> = Vec::new();
        if self.logarithmic {
            let multiples: &[f64] = if self.high > 1e3 * self.low { &[1.0] } else { &[1.0, 2.0, 5.0] };
            for decade in self.low.log10().floor() as i32..=self.high.log10().ceil() as i32 {
                levels.extend(multiples.iter().map(|multiple| multiple * 10_f64.powi(decade)));
            }
        } else {
            levels = round_numbers(self.low, self.high, nice_step((self.high - self.low) / ABOUT));
        }
        levels.retain(|level| *level > self.low && *level < self.high);
        levels
    }

    /// Axis of the colour bar.
    fn axis(&self, title: &str) -> ChartAxis {
        if self.logarithmic {
            ChartAxis::logarithmic(title, self.low, self.high)
        } else {
            ChartAxis::linear(title, self.low, self.high)
        }
    }
}

/// Number of different colours; a step is too small to see.
const SHADES: f64 = 96.0;
/// Length by which a cell overlaps the next one [pt]. Without it programs that smooth edges show white lines.
const OVERLAP: f64 = 0.25;

impl Map {
    pub(crate) fn draw(&self, drawing: &mut Drawing, placed: &Placed<'_>, style: &Type) {
        let (x, y) =
            (edges(&self.x, |x| placed.at(x, placed.y.low)[0]), edges(&self.y, |y| placed.at(placed.x.low, y)[1]));
        let clamp = |frame: Frame| Frame {
            left: frame.left.max(placed.frame.left),
            right: frame.right.min(placed.frame.right),
            top: frame.top.max(placed.frame.top),
            bottom: frame.bottom.min(placed.frame.bottom),
        };
        // The vertical axis points upwards: a row lies between its lower edge `y[j]` and its upper edge `y[j + 1]`.
        let cells = |j: usize, from: usize, to: usize, more: f64| {
            clamp(Frame { left: x[from], right: x[to] + more, top: y[j + 1] - more, bottom: y[j] })
        };

        // Neighbours of one shade are one area; areas of one shade are one path.
        let shade = |value: f64| (self.scale.fraction(value) * (SHADES - 1.0)).round() as usize;
        let mut by_shade: Vec<Vec<Vec<PaperPoint>>> = vec![Vec::new(); SHADES as usize];
        for (j, from, to) in self.runs(|cell| Some(self.values[cell]).filter(|value| value.is_finite()).map(shade)) {
            let value = self.values[j * self.x.len() + from];
            by_shade[shade(value)].push(cells(j, from, to, OVERLAP).corners());
        }
        for (k, areas) in by_shade.into_iter().enumerate() {
            drawing.areas(areas, Some(of_map(k as f64 / (SHADES - 1.0))), None);
        }

        let infeasible: Vec<Frame> = self
            .runs(|cell| (self.infeasible[cell] && !self.values[cell].is_finite()).then_some(()))
            .into_iter()
            .map(|(j, from, to)| cells(j, from, to, 0.0))
            .collect();
        // The overlap of the last feasible cells is covered.
        drawing.areas(infeasible.iter().map(Frame::corners).collect(), Some(WHITE), None);
        hatch(drawing, &infeasible, style);
        drawing.lines(self.boundary(&x, &y), Stroke::solid(BLACK, 1.4 * AXIS_WIDTH));
        self.draw_contours(drawing, placed, style);
    }

    /// Runs of neighbouring cells of a row with one key: row, first cell, cell after the last.
    fn runs<K: PartialEq>(&self, key: impl Fn(usize) -> Option<K>) -> Vec<(usize, usize, usize)> {
        let n = self.x.len();
        let mut runs = Vec::new();
        for j in 0..self.y.len() {
            let mut from = 0;
            while from < n {
                let first = key(j * n + from);
                let mut to = from + 1;
                while to < n && key(j * n + to) == first {
                    to += 1;
                }
                if first.is_some() {
                    runs.push((j, from, to));
                }
                from = to;
            }
        }
        runs
    }

    /// Edges between infeasible cells and all others.
    fn boundary(&self, x: &[f64], y: &[f64]) -> Vec<Vec<PaperPoint>> {
        let (n, m) = (self.x.len(), self.y.len());
        let at = |i: usize, j: usize| self.infeasible[j * n + i];
        let mut lines = Vec::new();
        for (i, j) in (0..m).flat_map(|j| (0..n).map(move |i| (i, j))) {
            if i > 0 && at(i - 1, j) != at(i, j) {
                lines.push(vec![[x[i], y[j]], [x[i], y[j + 1]]]);
            }
            if j > 0 && at(i, j - 1) != at(i, j) {
                lines.push(vec![[x[i], y[j]], [x[i + 1], y[j]]]);
            }
        }
        lines
    }

    /// Contours, each with its value where the longest of its lines is in the middle of its length.
    fn draw_contours(&self, drawing: &mut Drawing, placed: &Placed<'_>, style: &Type) {
        let mut taken: Vec<Frame> = Vec::new();
        for level in self.scale.levels() {
            let ink = if lightness(of_map(self.scale.fraction(level))) > 0.45 { BLACK } else { WHITE };
            let stroke = Stroke::solid(ink, 0.6);
            let mut lines: Vec<Vec<PaperPoint>> = contours(&self.x, &self.y, &self.values, level)
                .into_iter()
                .map(|line| line.into_iter().map(|[x, y]| placed.at(x, y)).collect())
                .collect();
            lines.sort_by(|a, b| length(b).total_cmp(&length(a)));
            let label = Label::plain(&short(level, 4).replace('-', "−"));
            let width = drawing.width_of(&label, style.small);

            let mut placed_once = false;
            for line in lines {
                // A label needs a line that is clearly longer than itself, away from the other labels.
                let place = if placed_once || length(&line) < 2.2 * width {
                    None
                } else {
                    label_place(&line, width, &placed.frame, &taken)
                };
                let Some(place) = place else {
                    drawing.line(super::drawing::simplified(&line), stroke.clone());
                    continue;
                };
                placed_once = true;
                taken.push(place.area);
                drawing.lines(vec![place.before, place.behind], stroke.clone());
                let [x, y] = place.middle;
                let (sin, cos) = place.angle.to_radians().sin_cos();
                let down = 0.5 * drawing.font.capital_height() * style.small;
                let at = [x + down * sin, y + down * cos];
                drawing.turned_text(label.clone(), at, Align::Middle, place.angle, style.small, ink);
            }
        }
    }
}

/// Place of a label on a line, and the parts of the line beside it.
struct LabelPlace {
    middle: PaperPoint,
    angle: f64,
    before: Vec<PaperPoint>,
    behind: Vec<PaperPoint>,
    area: Frame,
}

/// Place for a label of a width: near the middle of the line, inside the frame, apart from the labels before.
fn label_place(line: &[PaperPoint], width: f64, frame: &Frame, taken: &[Frame]) -> Option<LabelPlace> {
    let total = length(line);
    let half = 0.5 * width + 1.5;

    for part in [0.5, 0.4, 0.6, 0.3, 0.7, 0.22, 0.78] {
        let at = part * total;
        let (before, _) = split(line, at - half);
        let (_, behind) = split(line, at + half);
        let (Some(a), Some(b)) = (before.last().copied(), behind.first().copied()) else { continue };
        let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];

        // A sharp bend leaves no room for the text.
        if (b[0] - a[0]).hypot(b[1] - a[1]) < 1.7 * half {
            continue;
        }

        let mut angle = (-(b[1] - a[1])).atan2(b[0] - a[0]).to_degrees();
        // Texts are read from left to right.
        if angle > 90.0 {
            angle -= 180.0;
        } else if angle <= -90.0 {
            angle += 180.0;
        }

        let reach = half + 2.0;
        let area = Frame {
            left: middle[0] - reach,
            right: middle[0] + reach,
            top: middle[1] - reach,
            bottom: middle[1] + reach,
        };

        let inside = frame.contains([area.left, area.top]) && frame.contains([area.right, area.bottom]);
        let apart = |other: &Frame| {
            area.right < other.left || area.left > other.right || area.bottom < other.top || area.top > other.bottom
        };
        if inside && taken.iter().all(apart) {
            return Some(LabelPlace { middle, angle, before, behind, area });
        }
    }

    None
}

fn length(line: &[PaperPoint]) -> f64 {
    line.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).sum()
}

/// Parts of a line before and behind a length from its start.
fn split(line: &[PaperPoint], at: f64) -> (Vec<PaperPoint>, Vec<PaperPoint>) {
    let mut gone = 0.0;
    for (i, pair) in line.windows(2).enumerate() {
        let step = (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
        if gone + step >= at && step > 0.0 {
            let t = ((at - gone) / step).max(0.0);
            let point = [0, 1].map(|k| pair[0][k] + t * (pair[1][k] - pair[0][k]));
            let mut before = line[..=i].to_vec();
            before.push(point);
            let mut behind = vec![point];
            behind.extend_from_slice(&line[i + 1..]);
            return (before, behind);
        }
        gone += step;
    }
    (line.to_vec(), Vec::new())
}

/// Edges of cells on the page: half way between their values, and as far outside at both ends.
fn edges(values: &[f64], at: impl Fn(f64) -> f64) -> Vec<f64> {
    let n = values.len();
    let middle = |i: usize| 0.5 * (values[i - 1] + values[i]);
    let mut edges = vec![at(values[0] - (middle(1) - values[0]))];
    edges.extend((1..n).map(|i| at(middle(i))));
    edges.push(at(values[n - 1] + (values[n - 1] - middle(n - 1))));
    edges
}

/// Limits of an axis of cells: the outer edges of the first and the last.
pub(crate) fn limits(values: &[f64]) -> (f64, f64) {
    let edges = edges(values, |value| value);
    (edges[0], edges[edges.len() - 1])
}

/// Distance between two lines of the hatching, relative to the size of the texts.
const HATCH: f64 = 0.5;

/// Draws diagonal lines over rectangles. They continue from one rectangle to the next.
pub(crate) fn hatch(drawing: &mut Drawing, areas: &[Frame], style: &Type) {
    use std::collections::BTreeMap;
    let step = HATCH * style.size * 2_f64.sqrt();

    // On the line with number k, x + y = k · step. Its parts are kept as ranges of x.
    let mut parts: BTreeMap<i64, Vec<(f64, f64)>> = BTreeMap::new();

    for area in areas {
        let (first, last) = ((area.left + area.top) / step, (area.right + area.bottom) / step);
        for k in first.ceil() as i64..=last.floor() as i64 {
            let sum = k as f64 * step;
            let (from, to) = (area.left.max(sum - area.bottom), area.right.min(sum - area.top));
            if from < to {
                parts.entry(k).or_default().push((from, to));
            }
        }
    }

    let mut lines = Vec::new();

    for (k, mut ranges) in parts {
        let sum = k as f64 * step;
        ranges.sort_by(|a, b| a.0.total_cmp(&b.0));

        let mut joined: Vec<(f64, f64)> = Vec::new();
        for (from, to) in ranges {
            match joined.last_mut() {
                Some(last) if from <= last.1 + 1e-6 => last.1 = last.1.max(to),
                _ => joined.push((from, to)),
            }
        }

        lines.extend(joined.into_iter().map(|(from, to)| vec![[from, sum - from], [to, sum - to]]));
    }

    drawing.lines(lines, Stroke::solid(HATCHING, 0.4));
}

const HATCHING: Colour = [0x70, 0x70, 0x70];

/// Bar with the colours of a map and their values.
pub(crate) struct ColourBar {
    pub(crate) title: String,
    pub(crate) scale: ColourScale,
}

/// Length of the bar to which its ticks are fitted before the height of the map is known [pt].
const ABOUT_LENGTH: f64 = 130.0;

impl ColourBar {
    /// Width of the bar with its labels, its title, and the space before it [pt].
    pub(crate) fn width(&self, drawing: &Drawing, size: f64) -> f64 {
        let axis = self.scale.axis(&self.title);
        let ticks = axis.ticks(ABOUT_LENGTH, &|_| 1.9 * size);
        let labels = ticks.ticks.iter().filter_map(|tick| tick.label.as_ref());
        0.9 * size
            + 1.2 * size
            + size
            + labels.map(|label| drawing.width_of(label, size)).fold(0.0, f64::max)
            + 1.4 * size
    }

    /// Draws the bar to the right of a panel.
    pub(crate) fn draw(&self, drawing: &mut Drawing, panel: &Frame, style: &Type) {
        const STEPS: usize = 64;
        let size = style.size;
        let bar = Frame { left: panel.right + 0.9 * size, right: panel.right + 2.1 * size, ..*panel };
        let axis = self.scale.axis(&self.title);
        let ticks = axis.ticks(panel.height().min(ABOUT_LENGTH), &|_| 1.9 * size);
        for k in 0..STEPS {
            let y = |k: usize| bar.bottom - k as f64 / STEPS as f64 * bar.height();
            let area = Frame { top: (y(k + 1) - OVERLAP).max(bar.top), bottom: y(k), ..bar };
            let value = (k as f64 + 0.5) / STEPS as f64;
            drawing.areas(vec![area.corners()], Some(of_map(value)), None);
        }
        let frame = Stroke::solid(BLACK, AXIS_WIDTH);
        drawing.areas(vec![bar.corners()], None, Some(frame.clone()));

        let mut marks = Vec::new();
        let mut widest: f64 = 0.0;
        for tick in &ticks.ticks {
            let y = bar.bottom - axis.fraction(tick.at) * bar.height();
            let length = if tick.label.is_some() { style.tick } else { 0.55 * style.tick };
            marks.push(vec![[bar.right, y], [bar.right + length, y]]);
            if let Some(label) = &tick.label {
                widest = widest.max(drawing.width_of(label, size));
                let base = y + 0.5 * drawing.font.capital_height() * size;
                drawing.text(label.clone(), [bar.right + style.tick + 0.3 * size, base], Align::Start, size, BLACK);
            }
        }
        drawing.lines(marks, frame);
        let title = axis.title(ticks.exponent);
        let fitting = drawing.fitting(&title, size, bar.height() + 1.2 * size);
        let x = bar.right + style.tick + 0.3 * size + widest + 1.2 * size;
        drawing.turned_text(title, [x, 0.5 * (bar.top + bar.bottom)], Align::Middle, 90.0, fitting, BLACK);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_round_and_inside_the_range() {
        let levels = |low, high| ColourScale::of(&[low, f64::NAN, high]).unwrap().levels();
        assert_eq!(levels(0.0, 10.0), [2.0, 4.0, 6.0, 8.0]);
        assert_eq!(levels(1.0, 100.0), [2.0, 5.0, 10.0, 20.0, 50.0]);
        assert!(levels(3.0, 3.0).is_empty());
        assert!(ColourScale::of(&[f64::NAN]).is_none());
    }

    #[test]
    fn cells_end_half_way_to_the_next() {
        assert_eq!(edges(&[0.0, 1.0, 3.0], |x| x), [-0.5, 0.5, 2.0, 4.0]);
    }

    #[test]
    fn hatching_covers_the_areas_and_nothing_else() {
        let style = Type::new(8.0);
        let mut drawing = Drawing::new("", 100.0);
        let frame = |left, right| Frame { left, right, top: 10.0, bottom: 30.0 };
        hatch(&mut drawing, &[frame(0.0, 10.0), frame(10.0, 20.0), frame(50.0, 60.0)], &style);
        let super::super::drawing::Item::Path(path) = &drawing.items[0] else { panic!("a path") };
        let length: f64 = path.lines.iter().map(|line| length(line)).sum();
        // Lines at a distance d cover an area A with a length of A / d, up to one line at each border.
        let expected = 600.0 / (HATCH * 8.0);
        assert!((length - expected).abs() < 0.1 * expected, "{length}, expected about {expected}");
        for point in path.lines.iter().flatten() {
            assert!((-1e-9..=20.0 + 1e-9).contains(&point[0]) || (50.0 - 1e-9..=60.0 + 1e-9).contains(&point[0]));
            assert!((10.0 - 1e-9..=30.0 + 1e-9).contains(&point[1]));
        }
        assert!(path.lines.iter().any(|line| line[0][0] < 9.0 && line[1][0] > 11.0), "lines cross from cell to cell");
    }

    #[test]
    fn a_line_is_split_at_a_length() {
        let (before, behind) = split(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0]], 6.0);
        assert_eq!(before, [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0]]);
        assert_eq!(behind, [[4.0, 2.0], [4.0, 4.0]]);
    }
}
