//! Axes: ticks at round numbers, labels that do not overlap, powers of ten.

use super::drawing::{Frame, Label, PaperPoint};

/// Quantity along one side of a panel.
#[derive(Debug, Clone)]
pub(crate) struct ChartAxis {
    pub(crate) title: String,
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) logarithmic: bool,
    /// Places and labels that replace the round numbers.
    pub(crate) labels: Option<Vec<(f64, String)>>,
}

/// Tick with its label; a minor tick has none.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tick {
    pub(crate) at: f64,
    pub(crate) label: Option<Label>,
}

/// Ticks of an axis, and the power of ten that its labels leave out.
pub(crate) struct Ticks {
    pub(crate) ticks: Vec<Tick>,
    pub(crate) exponent: i32,
}

impl ChartAxis {
    /// Axis with equal steps.
    pub(crate) fn linear(title: impl Into<String>, low: f64, high: f64) -> Self {
        let (low, high) = apart(low, high);
        Self { title: title.into(), low, high, logarithmic: false, labels: None }
    }

    /// Axis with equal ratios between positive limits.
    pub(crate) fn logarithmic(title: impl Into<String>, low: f64, high: f64) -> Self {
        let (low, high) = if high > low * (1.0 + 1e-9) { (low, high) } else { (low / 2.0, high * 2.0) };
        Self { title: title.into(), low, high, logarithmic: true, labels: None }
    }

    /// Axis with given labels instead of round numbers.
    pub(crate) fn with_labels(mut self, labels: Vec<(f64, String)>) -> Self {
        self.labels = Some(labels);
        self
    }

    /// Place of a value as a fraction of the axis; not finite for a value that the axis cannot show.
    pub(crate) fn fraction(&self, value: f64) -> f64 {
        if self.logarithmic {
            (value.ln() - self.low.ln()) / (self.high.ln() - self.low.ln())
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// Ticks of an axis with this length [pt]. `room` gives the length that a label needs along the axis.
    pub(crate) fn ticks(&self, length: f64, room: &dyn Fn(&Label) -> f64) -> Ticks {
        if let Some(labels) = &self.labels {
            let tick = |(at, text): &(f64, String)| Tick { at: *at, label: Some(Label::new(text)) };
            return Ticks { ticks: labels.iter().map(tick).collect(), exponent: 0 };
        }
        if self.logarithmic { self.logarithmic_ticks(length, room) } else { self.linear_ticks(length, room) }
    }

    /// Title with the power of ten that the labels leave out: in the brackets of the unit, as in `[10⁶ N]`.
    pub(crate) fn title(&self, exponent: i32) -> Label {
        let text = match (exponent, self.title.rsplit_once('[')) {
            (0, _) => self.title.clone(),
            (power, Some((name, unit))) => format!("{name}[10^{{{}}} {unit}", signed(power)),
            (power, None) => format!("{} [10^{{{}}}]", self.title, signed(power)),
        };
        Label::new(&text)
    }

    /// Takes away the labels that have no room behind the one before them.
    pub(crate) fn leave_out_crowded(&self, ticks: &mut Ticks, length: f64, room: &dyn Fn(&Label) -> f64) {
        let mut end = f64::NEG_INFINITY;
        for tick in &mut ticks.ticks {
            let Some(half) = tick.label.as_ref().map(|label| 0.5 * room(label)) else { continue };
            let middle = self.fraction(tick.at) * length;
            if middle - half < end {
                tick.label = None;
            } else {
                end = middle + half;
            }
        }
    }

    fn linear_ticks(&self, length: f64, room: &dyn Fn(&Label) -> f64) -> Ticks {
        let exponent = common_exponent(self.low.abs().max(self.high.abs()));
        let unit = 10_f64.powi(exponent);
        let (low, high) = (self.low / unit, self.high / unit);
        let labelled = |step: f64| -> Vec<Tick> {
            let places = (-step.log10().floor() as i32 + i32::from(is_quarter(step))).max(0) as usize;
            round_numbers(low, high, step)
                .into_iter()
                .map(|value| Tick { at: value * unit, label: Some(Label::plain(&with_minus(value, places))) })
                .collect()
        };
        // The finest steps whose labels leave space between them.
        let mut step = nice_step((high - low) / 10.0);
        loop {
            let ticks = labelled(step);
            let widest = ticks.iter().filter_map(|tick| tick.label.as_ref()).map(room).fold(0.0, f64::max);
            if ticks.len() < 3 || widest <= step / (high - low) * length {
                return Ticks { ticks, exponent };
            }
            step = nice_step(step * 1.01);
        }
    }

    fn logarithmic_ticks(&self, length: f64, room: &dyn Fn(&Label) -> f64) -> Ticks {
        let (first, last) = (self.low.log10().floor() as i32, self.high.log10().ceil() as i32);
        let inside = |value: f64| value >= self.low * (1.0 - 1e-9) && value <= self.high * (1.0 + 1e-9);
        let decades: Vec<i32> = (first..=last).filter(|decade| inside(10_f64.powi(*decade))).collect();
        let plain = self.low >= 0.99e-3 && self.high <= 1.01e4;
        let of_power = |decade: i32| {
            if plain {
                Label::plain(&with_minus(10_f64.powi(decade), usize::try_from(-decade).unwrap_or(0)))
            } else {
                Label::new(&format!("10^{{{}}}", signed(decade)))
            }
        };
        let per_decade = length / (self.high / self.low).log10();

        // With a single decade or none the multiples in between have labels, too.
        let multiples: &[u32] = match decades.len() {
            0 => &[1, 2, 3, 4, 5, 6, 7, 8, 9],
            1 => &[1, 2, 5],
            _ => &[1],
        };
        let of_multiple = |multiple: u32, decade: i32| match (multiple, plain) {
            (1, _) => of_power(decade),
            (_, true) => {
                let value = f64::from(multiple) * 10_f64.powi(decade);
                Label::plain(&with_minus(value, usize::try_from(-decade).unwrap_or(0)))
            }
            (_, false) => Label::new(&format!("{multiple}·10^{{{}}}", signed(decade))),
        };
        let widest = decades.iter().map(|decade| room(&of_power(*decade))).fold(0.0, f64::max);
        let every = (widest / per_decade).ceil().max(1.0) as i32;

        let mut ticks = Vec::new();
        let mut end = f64::NEG_INFINITY;
        for decade in first..=last {
            for multiple in 1..10 {
                let at = f64::from(multiple) * 10_f64.powi(decade);
                if !inside(at) {
                    continue;
                }
                let wanted = multiples.contains(&multiple) && (multiple > 1 || decade % every == 0);
                let label = Some(of_multiple(multiple, decade)).filter(|label| {
                    let half = 0.5 * room(label);
                    let middle = self.fraction(at) * length;
                    let fits = wanted && middle - half >= end;
                    if fits {
                        end = middle + half;
                    }
                    fits
                });
                // Minor ticks that would merge are left out.
                if label.is_some() || (multiple == 1 || per_decade > MIN_DECADE) {
                    ticks.push(Tick { at, label });
                }
            }
        }
        Ticks { ticks, exponent: 0 }
    }
}

/// Minimum length of a decade with minor ticks [pt]: the last two are then half a point apart.
const MIN_DECADE: f64 = 11.0;

/// Limits of an axis; equal limits are moved apart.
fn apart(low: f64, high: f64) -> (f64, f64) {
    let size = low.abs().max(high.abs());
    if high - low > 1e-9 * size { (low, high) } else { (low - 0.5 * size.max(1e-9), high + 0.5 * size.max(1e-9)) }
}

/// Exponent, a multiple of three, that labels of large and small numbers leave out.
fn common_exponent(largest: f64) -> i32 {
    if largest == 0.0 || (1e-2..1e5).contains(&largest) {
        return 0;
    }
    3 * (largest.log10() / 3.0).floor() as i32
}

/// Smallest of 1, 2, 2.5 and 5 times a power of ten that is at least `rough`.
pub(crate) fn nice_step(rough: f64) -> f64 {
    let power = 10_f64.powf(rough.log10().floor());
    let multiple = [1.0, 2.0, 2.5, 5.0, 10.0].into_iter().find(|multiple| multiple * power >= rough * (1.0 - 1e-9));
    multiple.unwrap_or(10.0) * power
}

/// True for a step of 2.5 times a power of ten, which needs another decimal.
fn is_quarter(step: f64) -> bool {
    let leading = step / 10_f64.powf(step.log10().floor());
    (leading - 2.5).abs() < 1e-6
}

/// Multiples of a step between two limits.
pub(crate) fn round_numbers(low: f64, high: f64, step: f64) -> Vec<f64> {
    let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
    let count = (last - first).max(-1.0) as usize + usize::from(last >= first);
    // `+ 0.0` makes a negative zero positive.
    (0..count).map(|k| (first + k as f64) * step + 0.0).collect()
}

/// Number with decimals and a proper minus sign.
fn with_minus(value: f64, places: usize) -> String {
    funicular_study::text::decimals(value, places).replace('-', "−")
}

fn signed(exponent: i32) -> String {
    exponent.to_string().replace('-', "−")
}

/// Panel on the page.
pub(crate) struct Placed<'a> {
    pub(crate) frame: Frame,
    pub(crate) x: &'a ChartAxis,
    pub(crate) y: &'a ChartAxis,
}

impl Placed<'_> {
    /// Point of a pair of values.
    pub(crate) fn at(&self, x: f64, y: f64) -> PaperPoint {
        let Frame { left, bottom, .. } = self.frame;
        [left + self.x.fraction(x) * self.frame.width(), bottom - self.y.fraction(y) * self.frame.height()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn room(label: &Label) -> f64 {
        8.0 + 5.0 * label.0.iter().map(|(run, _)| run.chars().count()).sum::<usize>() as f64
    }

    fn texts(axis: &ChartAxis, length: f64) -> Vec<String> {
        let text = |label: &Label| label.0.iter().map(|run| run.0.as_str()).collect::<String>();
        axis.ticks(length, &room).ticks.iter().filter_map(|tick| tick.label.as_ref().map(text)).collect()
    }

    #[test]
    fn labels_are_round_numbers_with_space_between_them() {
        assert_eq!(texts(&ChartAxis::linear("x", 0.0, 20.0), 300.0).len(), 11);
        assert_eq!(texts(&ChartAxis::linear("x", 0.0, 20.0), 100.0), ["0", "5", "10", "15", "20"]);
        assert_eq!(texts(&ChartAxis::linear("x", -0.3, 0.3), 150.0), ["−0.2", "0.0", "0.2"]);
        assert_eq!(texts(&ChartAxis::linear("x", 3.0, 3.0), 60.0).len(), 3, "equal limits");
        for length in [40.0, 90.0, 170.0, 400.0] {
            for (low, high) in [(0.0, 1.0), (-7.3, 912.0), (1e-7, 3e-7), (5.0, 5.02), (-2e9, 1e9)] {
                let axis = ChartAxis::linear("x", low, high);
                let found = axis.ticks(length, &room).ticks;
                assert!(found.iter().all(|tick| tick.at >= low - 1e-9 * high.abs() && tick.at <= high * (1.0 + 1e-9)));
                for pair in found.windows(2) {
                    let apart = (axis.fraction(pair[1].at) - axis.fraction(pair[0].at)) * length;
                    let need = pair[0].label.as_ref().map_or(0.0, room);
                    assert!(found.len() < 3 || apart > 0.8 * need, "{low} to {high} on {length}: {apart} < {need}");
                }
            }
        }
    }

    #[test]
    fn large_numbers_have_their_power_in_the_title() {
        let axis = ChartAxis::linear("stiffness [N/m]", 0.0, 2.4e6);
        let found = axis.ticks(120.0, &room);
        assert_eq!(found.exponent, 6);
        assert_eq!(axis.title(6), Label::new("stiffness [10^{6} N/m]"));
        assert_eq!(ChartAxis::linear("ratio", 0.0, 1.0).title(-6), Label::new("ratio [10^{−6}]"));
        assert!(texts(&axis, 120.0).contains(&"2.0".to_owned()) || texts(&axis, 120.0).contains(&"2".to_owned()));
    }

    #[test]
    fn decades_have_minor_ticks() {
        let axis = ChartAxis::logarithmic("x", 1e-5, 1.0);
        let found = axis.ticks(150.0, &room).ticks;
        assert_eq!(found.len(), 5 * 9 + 1);
        assert_eq!(found.iter().filter(|tick| tick.label.is_some()).count(), 6, "{:?}", texts(&axis, 150.0));
        assert_eq!(texts(&ChartAxis::logarithmic("f", 0.1, 100.0), 200.0), ["0.1", "1", "10", "100"]);
        // Within a decade the multiples have labels.
        assert_eq!(texts(&ChartAxis::logarithmic("f", 2.0, 8.0), 300.0), ["2", "3", "4", "5", "6", "7", "8"]);
        // Twenty decades on a short axis: labels of some of them, no minor ticks.
        let many = ChartAxis::logarithmic("x", 1e-10, 1e10);
        let labels = texts(&many, 100.0);
        assert!(labels.len() >= 3 && labels.len() <= 5, "{labels:?}");
        assert_eq!(many.ticks(100.0, &room).ticks.len(), 21);
    }
}
