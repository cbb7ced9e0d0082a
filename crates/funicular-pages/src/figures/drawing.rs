//! Drawing of a figure in points, independent of the file format: paths, and texts with known widths.

use super::font::Font;

/// Position on the page [pt]: from the left, and from the top downwards.
pub(crate) type PaperPoint = [f64; 2];

/// Colour: red, green, blue.
pub(crate) type Colour = [u8; 3];

/// Black.
pub(crate) const BLACK: Colour = [0, 0, 0];
/// White.
pub(crate) const WHITE: Colour = [255, 255, 255];

/// Rectangle [pt].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Frame {
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) right: f64,
    pub(crate) bottom: f64,
}

impl Frame {
    pub(crate) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(crate) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    /// True if the point is inside or on the edge.
    pub(crate) fn contains(&self, p: PaperPoint) -> bool {
        (self.left..=self.right).contains(&p[0]) && (self.top..=self.bottom).contains(&p[1])
    }

    /// Corners around the rectangle.
    pub(crate) fn corners(&self) -> Vec<PaperPoint> {
        vec![[self.left, self.top], [self.right, self.top], [self.right, self.bottom], [self.left, self.bottom]]
    }
}

/// Line of a path.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stroke {
    pub(crate) colour: Colour,
    /// Width [pt].
    pub(crate) width: f64,
    /// Lengths of dashes and gaps in turn [pt]; empty for a solid line.
    pub(crate) dashes: Vec<f64>,
}

impl Stroke {
    /// Solid line.
    pub(crate) fn solid(colour: Colour, width: f64) -> Self {
        Self { colour, width, dashes: Vec::new() }
    }
}

/// Lines or areas with one style.
#[derive(Debug, Clone)]
pub(crate) struct DrawnPath {
    /// Lines, each through its points.
    pub(crate) lines: Vec<Vec<PaperPoint>>,
    /// True if every line ends where it begins.
    pub(crate) closed: bool,
    pub(crate) fill: Option<Colour>,
    pub(crate) stroke: Option<Stroke>,
}

/// Lines or areas that move, in drawings that a browser plays. Elsewhere they stand as at the start.
#[derive(Debug, Clone)]
pub(crate) struct Moving {
    /// Path at the start, with one line.
    pub(crate) path: DrawnPath,
    /// Times of the frames as parts of the duration, from 0 to 1.
    pub(crate) shares: Vec<f64>,
    /// Points of the line in each frame, always as many.
    pub(crate) each: Vec<Vec<PaperPoint>>,
    /// Colours of the stroke, each from a part of the duration on, the first from 0; empty for one colour.
    pub(crate) colours: Vec<(f64, Colour)>,
    /// Time in which it moves once, again and again [s].
    pub(crate) duration: f64,
}

/// Text whose parts may be raised as exponents.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Label(pub(crate) Vec<(String, bool)>);

impl Label {
    /// Label from a text in which `^{…}` is an exponent.
    pub(crate) fn new(text: &str) -> Self {
        let mut runs = Vec::new();
        let mut rest = text;
        while let Some((before, after)) = rest.split_once("^{") {
            let Some((exponent, behind)) = after.split_once('}') else { break };
            if !before.is_empty() {
                runs.push((before.to_owned(), false));
            }
            runs.push((exponent.to_owned(), true));
            rest = behind;
        }
        if !rest.is_empty() {
            runs.push((rest.to_owned(), false));
        }
        Self(runs)
    }

    /// Label without exponents, for names that the user chose.
    pub(crate) fn plain(text: &str) -> Self {
        Self(vec![(text.to_owned(), false)])
    }
}

/// Size of an exponent relative to its text, and its height above the line relative to the size of the text.
pub(crate) const RAISED: (f64, f64) = (0.72, 0.36);

/// Place of a text relative to its point, along the text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Align {
    Start,
    Middle,
    End,
}

/// Text on the page.
#[derive(Debug, Clone)]
pub(crate) struct Text {
    pub(crate) label: Label,
    /// Start of the base line [pt].
    pub(crate) at: PaperPoint,
    /// Direction of the text [°], counterclockwise.
    pub(crate) angle: f64,
    /// Size of the font [pt].
    pub(crate) size: f64,
    pub(crate) colour: Colour,
}

/// Part of a drawing, in the order of drawing.
#[derive(Debug, Clone)]
pub(crate) enum Item {
    Path(DrawnPath),
    Moving(Moving),
    Text(Text),
}

/// Drawing of a figure.
pub(crate) struct Drawing {
    pub(crate) font: Font,
    /// Title for the file, not shown in the figure.
    pub(crate) title: String,
    /// Size of the page [pt].
    pub(crate) width: f64,
    pub(crate) height: f64,
    pub(crate) items: Vec<Item>,
}

impl Drawing {
    /// Empty drawing; the height is set when it is known.
    pub(crate) fn new(title: &str, width: f64) -> Self {
        Self { font: Font::new(), title: title.to_owned(), width, height: 0.0, items: Vec::new() }
    }

    /// Draws a line through points.
    pub(crate) fn line(&mut self, points: Vec<PaperPoint>, stroke: Stroke) {
        self.lines(vec![points], stroke);
    }

    /// Draws lines with one style.
    pub(crate) fn lines(&mut self, lines: Vec<Vec<PaperPoint>>, stroke: Stroke) {
        let lines: Vec<Vec<PaperPoint>> = lines.into_iter().filter(|line| line.len() > 1).collect();
        if !lines.is_empty() {
            self.items.push(Item::Path(DrawnPath { lines, closed: false, fill: None, stroke: Some(stroke) }));
        }
    }

    /// Draws lines or areas that move.
    pub(crate) fn moving(&mut self, moving: Moving) {
        self.items.push(Item::Moving(moving));
    }

    /// Draws areas with one style.
    pub(crate) fn areas(&mut self, lines: Vec<Vec<PaperPoint>>, fill: Option<Colour>, stroke: Option<Stroke>) {
        if !lines.is_empty() {
            self.items.push(Item::Path(DrawnPath { lines, closed: true, fill, stroke }));
        }
    }

    /// Width of a text [pt].
    pub(crate) fn width_of(&self, label: &Label, size: f64) -> f64 {
        let run =
            |(text, raised): &(String, bool)| self.font.width(text) * if *raised { RAISED.0 * size } else { size };
        label.0.iter().map(run).sum()
    }

    /// Draws a text whose base line is at a point.
    pub(crate) fn text(&mut self, label: Label, at: PaperPoint, align: Align, size: f64, colour: Colour) {
        self.turned_text(label, at, align, 0.0, size, colour);
    }

    /// Draws a text in a direction [°], counterclockwise.
    pub(crate) fn turned_text(
        &mut self,
        label: Label,
        at: PaperPoint,
        align: Align,
        angle: f64,
        size: f64,
        colour: Colour,
    ) {
        let back = self.width_of(&label, size)
            * match align {
                Align::Start => 0.0,
                Align::Middle => 0.5,
                Align::End => 1.0,
            };
        let (sin, cos) = angle.to_radians().sin_cos();
        let at = [at[0] - back * cos, at[1] + back * sin];
        self.items.push(Item::Text(Text { label, at, angle, size, colour }));
    }

    /// Largest size at which a text fits a length [pt], at most `size`.
    pub(crate) fn fitting(&self, label: &Label, size: f64, length: f64) -> f64 {
        let width = self.width_of(label, size);
        if width > length && width > 0.0 { size * (length / width).max(MIN_FITTING) } else { size }
    }
}

/// Minimum size of a text that is made smaller to fit, relative to the other texts.
pub(crate) const MIN_FITTING: f64 = 0.6;

/// Parts of a line inside a frame. Points that are not finite end a part.
pub(crate) fn clipped(points: &[PaperPoint], frame: &Frame) -> Vec<Vec<PaperPoint>> {
    let mut parts: Vec<Vec<PaperPoint>> = Vec::new();
    let mut part: Vec<PaperPoint> = Vec::new();

    for pair in points.windows(2) {
        let inside = if pair.iter().flatten().all(|x| x.is_finite()) { segment(pair[0], pair[1], frame) } else { None };
        let Some((from, to)) = inside else {
            parts.push(std::mem::take(&mut part));
            continue;
        };

        // The segment begins where the last one ended, or where the line enters the frame.
        if part.is_empty() || !frame.contains(pair[0]) {
            parts.push(std::mem::take(&mut part));
            part.push(from);
        }
        part.push(to);

        if !frame.contains(pair[1]) {
            parts.push(std::mem::take(&mut part));
        }
    }

    parts.push(part);
    parts.retain(|part| part.len() > 1);
    parts
}

/// Part of a segment inside a frame (Liang and Barsky).
fn segment(a: PaperPoint, b: PaperPoint, frame: &Frame) -> Option<(PaperPoint, PaperPoint)> {
    let d = [b[0] - a[0], b[1] - a[1]];
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    let edges = [
        (-d[0], a[0] - frame.left),
        (d[0], frame.right - a[0]),
        (-d[1], a[1] - frame.top),
        (d[1], frame.bottom - a[1]),
    ];

    for (slope, room) in edges {
        if slope == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if slope < 0.0 {
            enter = enter.max(room / slope);
        } else {
            leave = leave.min(room / slope);
        }
    }

    let at = |t: f64| [a[0] + t * d[0], a[1] + t * d[1]];
    (enter <= leave).then(|| (if enter > 0.0 { at(enter) } else { a }, if leave < 1.0 { at(leave) } else { b }))
}

/// Maximum distance by which a line with fewer points differs from the original [pt]: a twelfth of the thinnest line.
const SIMPLER: f64 = 0.03;

/// Line with fewer points that differs by at most [`SIMPLER`] from the original (Douglas and Peucker).
pub(crate) fn simplified(points: &[PaperPoint]) -> Vec<PaperPoint> {
    let points = columns(points);
    let n = points.len();
    if n < 3 {
        return points;
    }
    let mut kept = vec![false; n];
    (kept[0], kept[n - 1]) = (true, true);
    let mut stack = vec![(0, n - 1)];
    while let Some((from, to)) = stack.pop() {
        let farthest = (from + 1..to)
            .map(|i| (i, distance(points[i], points[from], points[to])))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((i, away)) = farthest
            && away > SIMPLER
        {
            kept[i] = true;
            stack.extend([(from, i), (i, to)]);
        }
    }
    points.into_iter().zip(kept).filter_map(|(point, kept)| kept.then_some(point)).collect()
}

/// Line in which runs of points that share a narrow column are replaced by their first, lowest, highest and last point.
/// It bounds the work of [`simplified`] for a curve of a million points.
fn columns(points: &[PaperPoint]) -> Vec<PaperPoint> {
    let column = |p: &PaperPoint| (p[0] / SIMPLER).floor() as i64;
    let mut all = Vec::new();
    for run in points.chunk_by(|a, b| column(a) == column(b)) {
        if run.len() < 5 {
            all.extend_from_slice(run);
            continue;
        }
        let extreme = |sign: f64| {
            (0..run.len()).max_by(|&i, &j| (sign * run[i][1]).total_cmp(&(sign * run[j][1]))).unwrap_or_default()
        };
        let mut places = vec![0, extreme(-1.0), extreme(1.0), run.len() - 1];
        places.sort_unstable();
        places.dedup();
        all.extend(places.into_iter().map(|i| run[i]));
    }
    all
}

/// Distance of a point from a segment.
fn distance(p: PaperPoint, a: PaperPoint, b: PaperPoint) -> f64 {
    let (d, r) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = d[0] * d[0] + d[1] * d[1];
    let t = if square > 0.0 { ((r[0] * d[0] + r[1] * d[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    (r[0] - t * d[0]).hypot(r[1] - t * d[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Frame = Frame { left: 0.0, top: 0.0, right: 1.0, bottom: 1.0 };

    #[test]
    fn a_line_is_cut_at_the_frame_and_at_gaps() {
        let parts = clipped(&[[-1.0, 0.5], [0.5, 0.5], [0.5, 3.0], [0.8, 3.0], [0.8, 0.2]], &UNIT);
        assert_eq!(parts.len(), 2);
        assert_eq!(parts[0], [[0.0, 0.5], [0.5, 0.5], [0.5, 1.0]]);
        assert!((parts[1][0][1] - 1.0).abs() < 1e-15);
        assert_eq!(parts[1].len(), 2);
        let gap = clipped(&[[0.1, 0.1], [0.2, 0.1], [f64::NAN, 0.1], [0.3, 0.1], [0.4, 0.1]], &UNIT);
        assert_eq!(gap, [[[0.1, 0.1], [0.2, 0.1]], [[0.3, 0.1], [0.4, 0.1]]]);
        assert!(clipped(&[[2.0, 2.0], [3.0, 0.0]], &UNIT).is_empty());
    }

    #[test]
    fn a_simpler_line_stays_close_to_the_original() {
        let wave: Vec<PaperPoint> =
            (0..200_000).map(|i| f64::from(i) / 1000.0).map(|x| [x, 50.0 * (x / 7.0).sin()]).collect();
        let simple = simplified(&wave);
        assert!(simple.len() < 2000, "{}", simple.len());
        // Bound: the tolerance of the simplification and the width of a column.
        for point in wave.iter().step_by(97) {
            let near = simple.windows(2).map(|pair| distance(*point, pair[0], pair[1])).fold(f64::INFINITY, f64::min);
            assert!(near < 2.0 * SIMPLER, "{point:?}: {near}");
        }
        // A resonance that is narrower than a column keeps its height.
        let mut peak: Vec<PaperPoint> = (0..1000).map(|i| [f64::from(i) * 1e-5, 0.0]).collect();
        peak[437][1] = 80.0;
        assert!(simplified(&peak).contains(&peak[437]));
    }

    #[test]
    fn exponents_are_raised_and_names_stay_as_they_are() {
        let label = Label::new("stiffness [10^{6} N/m]");
        assert_eq!(label.0, [("stiffness [10".into(), false), ("6".into(), true), (" N/m]".into(), false)]);
        assert_eq!(Label::plain("a^{b}").0, [("a^{b}".into(), false)]);
        assert_eq!(Label::new("a^{b").0, [("a^{b".into(), false)]);
    }
}
