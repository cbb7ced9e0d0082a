//! Figures over frequency: responses with phase and modes as ticks, and the kinds of modes.

use super::{PageFigure, axis, colour, kind_colour, line, rounded, with};
use crate::figures::style::ModelStyle;
use funicular::dynamics::Dynamics;
use funicular::math::{Complex, Vec6};
use funicular::modes::{Kind, Mode, Modes};
use funicular::response::adaptive::{Resolution, Resolved, resolve};
use funicular::response::{Measured, Peak, Port, Quantity, ResponseError, measured};
use serde_json::{Value, json};

/// Number of evenly spaced points from which a response is resolved.
const EVEN_POINTS: u32 = 400;
/// Accuracy of a drawn response: 2 % of the magnitude, less than half a pixel of a figure with four decades. The limit
/// of points keeps a page with five curves below 10 MB.
const DRAWN: Resolution = Resolution { tolerance: 0.02, max_points: 30_000 };

/// Response over frequency for a figure.
pub(crate) struct ResponseCurve {
    /// Name in the legend.
    pub(crate) name: String,
    /// Colour and dash of its model.
    pub(crate) style: ModelStyle,
    /// Frequencies [Hz].
    pub(crate) frequencies_hz: Vec<f64>,
    /// Response. A sum of the magnitudes of several outputs is real and has no phase.
    pub(crate) values: Vec<Complex>,
    resolved: Resolved,
}

impl ResponseCurve {
    /// Computes the response of one output to one input up to a limit [Hz], or the sum of the magnitudes for several
    /// outputs. `modes` are the modes below the limit.
    ///
    /// # Errors
    /// A response that is not finite.
    pub(crate) fn of(
        name: impl Into<String>,
        style: ModelStyle,
        (dynamics, below_hz, modes): (&Dynamics, f64, &[Mode]),
        input: &Vec6,
        outputs: &[Vec6],
        quantity: Quantity,
    ) -> Result<Self, ResponseError> {
        let step = below_hz / f64::from(EVEN_POINTS);
        let even: Vec<f64> = (1..=EVEN_POINTS).map(|k| step * f64::from(k)).collect();
        let input = [Port::Platform(*input)];
        let outputs: Vec<(Port, Quantity)> = outputs.iter().map(|output| (Port::Platform(*output), quantity)).collect();

        let sum = |row: Vec<Measured>| match row.as_slice() {
            [one] => vec![*one],
            several => vec![Measured {
                value: Complex::from(several.iter().map(|m| m.value.norm()).sum::<f64>()),
                floor: several.iter().map(|m| m.floor).sum(),
            }],
        };
        let resolved = resolve(&even, modes, DRAWN, |frequencies| {
            Ok(measured(dynamics, frequencies, &input, &outputs)?.into_iter().map(sum).collect())
        })?;
        let (frequencies_hz, values) = (resolved.frequencies_hz.clone(), resolved.values[0].clone());
        Ok(Self { name: name.into(), style, frequencies_hz, values, resolved })
    }

    /// Peaks with at least the given prominence [dB], with their heights.
    pub(crate) fn peaks(&self, min_prominence_db: f64) -> Vec<Peak> {
        self.resolved.peaks(0, min_prominence_db)
    }

    /// Number of its resonances without damping, which have no height.
    pub(crate) fn undamped(&self) -> usize {
        self.resolved.undamped_resonances_hz(0).len()
    }

    fn magnitude(&self) -> Vec<f64> {
        self.values.iter().map(|v| v.norm()).collect()
    }

    /// Phase [°] in (−180, 180], with gaps where it wraps so that no line crosses the figure.
    fn phase(&self) -> (Vec<f64>, Vec<f64>) {
        let (mut x, mut y) = (Vec::new(), Vec::<f64>::new());
        for (frequency, value) in self.frequencies_hz.iter().zip(&self.values) {
            let degrees = value.arg().to_degrees();
            // An undamped response is real; the sign of its zero imaginary part has no meaning.
            let degrees = if degrees <= -179.99 { 180.0 } else { degrees };
            if y.last().is_some_and(|last: &f64| (degrees - last).abs() > 270.0) {
                x.push(*frequency);
                y.push(f64::NAN);
            }
            x.push(*frequency);
            y.push(degrees);
        }
        (x, y)
    }
}

/// Marks of a response figure besides its curves.
pub(crate) struct Marks<'a> {
    /// Natural frequencies of the first curve's model, as ticks below.
    pub(crate) modes: &'a [Mode],
    /// Peaks to label.
    pub(crate) peaks: &'a [Peak],
    /// Published frequencies, as dashed lines; name and values [Hz].
    pub(crate) published: Option<(&'a str, &'a [f64])>,
    /// True if the phase is shown.
    pub(crate) phase: bool,
}

/// Figure of responses over frequency: logarithmic magnitude, with phase and modes below. The first curve sets the
/// range of the magnitude; undamped curves leave it at their resonances.
pub(crate) fn figure(
    id: &'static str,
    caption: String,
    unit: &str,
    below_hz: f64,
    curves: &[ResponseCurve],
    marks: &Marks<'_>,
) -> PageFigure {
    // The range ignores the first twentieth of the axis: an accelerance falls to zero there and would compress the
    // rest.
    let shown = curves[0].frequencies_hz.iter().zip(curves[0].magnitude()).filter(|(f, _)| **f > 0.05 * below_hz);
    let levels: Vec<f64> = shown.map(|(_, m)| m.log10()).filter(|l| l.is_finite()).collect();
    let (low, high) = (minimum(&levels), -minimum(&levels.iter().map(|l| -l).collect::<Vec<_>>()));
    let room = 0.22 * (high - low).max(0.5);

    let mut data = traces(curves, unit, marks.phase);
    data.extend(ticks(marks.modes));
    let mut shapes = Vec::new();
    if let Some((name, frequencies)) = marks.published {
        for frequency in frequencies {
            shapes.push(json!({
                "type": "line", "x0": frequency, "x1": frequency, "yref": "y domain", "y0": 0, "y1": 1,
                "layer": "below",
                "line": {"color": colour::GREY, "width": 1, "dash": "dash"},
            }));
        }
        // A line outside the figure for the legend, because shapes have no entry among the traces.
        data.push(with(line(name, &[f64::NAN], &[f64::NAN], colour::GREY, "dash"), json!({"line": {"width": 1}})));
    }

    let (magnitude, phase, strip) =
        if marks.phase { ([0.45, 1.0], [0.13, 0.4], [0.0, 0.07]) } else { ([0.16, 1.0], [0.0, 0.1], [0.0, 0.09]) };
    let mut layout = json!({
        "xaxis": axis("frequency [Hz]", json!({"range": [0, below_hz], "anchor": "y3", "mirror": "all"})),
        "yaxis": axis(&format!("magnitude [{unit}]"), json!({
            "type": "log", "domain": magnitude, "exponentformat": "power", "dtick": 1,
            "range": [low - 0.2 * room, high + room],
        })),
        "yaxis3": axis("", json!({
            "domain": strip, "range": [-1, 1], "showticklabels": false, "ticks": "", "showgrid": false,
            "fixedrange": true,
        })),
        "annotations": peak_labels(marks.peaks, below_hz, curves[0].style.colour),
        "shapes": shapes,
    });
    if marks.phase {
        layout["yaxis2"] =
            axis("phase [°]", json!({"domain": phase, "range": [-190, 190], "tickvals": [-180, -90, 0, 90, 180]}));
    }
    layout["margin"] = json!({"l": 78});
    PageFigure::new(id, if marks.phase { 600 } else { 430 }, caption, &data, layout)
}

/// Lines of the magnitudes and, below them, of the phases.
fn traces(curves: &[ResponseCurve], unit: &str, with_phase: bool) -> Vec<Value> {
    let mut data = Vec::new();
    for curve in curves {
        let trace = line(&curve.name, &curve.frequencies_hz, &curve.magnitude(), curve.style.colour, curve.style.dash);
        let hover = format!("%{{x:.3f}} Hz<br>%{{y:.3e}} {unit}");
        data.push(with(trace, json!({"hovertemplate": hover, "legendgroup": curve.name})));
        if with_phase {
            let (x, y) = curve.phase();
            let trace = line(&curve.name, &x, &y, curve.style.colour, curve.style.dash);
            data.push(with(
                trace,
                json!({
                    "yaxis": "y2", "showlegend": false, "legendgroup": curve.name,
                    "hovertemplate": "%{x:.3f} Hz<br>%{y:.0f}°",
                }),
            ));
        }
    }

    data
}

/// Frequencies [Hz] above the peaks, where there is room.
fn peak_labels(peaks: &[Peak], below_hz: f64, colour: &str) -> Vec<Value> {
    spaced(peaks, 0.03 * below_hz)
        .iter()
        .map(|peak| {
            json!({
                "x": peak.frequency_hz, "y": peak.magnitude.log10(), "text": format!("{:.2}", peak.frequency_hz),
                "textangle": -90,
                "showarrow": false, "yanchor": "bottom", "yshift": 3, "bgcolor": "rgba(255,255,255,0.75)",
                "borderpad": 0, "font": {"size": 11, "color": colour},
            })
        })
        .collect()
}

fn minimum(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// Most prominent peaks with a minimum distance [Hz] between them, so that their labels do not overlap.
fn spaced(peaks: &[Peak], distance: f64) -> Vec<Peak> {
    let mut order: Vec<&Peak> = peaks.iter().collect();
    order.sort_by(|a, b| b.prominence_db.total_cmp(&a.prominence_db));
    let mut kept: Vec<Peak> = Vec::new();
    for peak in order {
        if kept.iter().all(|k| (k.frequency_hz - peak.frequency_hz).abs() >= distance) {
            kept.push(*peak);
        }
    }
    kept
}

/// Kinds of modes in the order in which they are drawn and listed.
pub(crate) const KINDS: [Kind; 4] = [Kind::Cable, Kind::Mixed, Kind::Platform, Kind::Drive];

/// Ticks of the modes on the strip below a response, one trace per kind.
fn ticks(modes: &[Mode]) -> Vec<Value> {
    of_kinds(modes)
        .map(|(kind, found)| {
            let x: Vec<f64> = found.iter().map(|m| m.frequency_hz).collect();
            json!({
                "type": "scatter", "mode": "markers", "name": format!("{} mode", kind.name()), "x": rounded(&x),
                "y": vec![0; x.len()],
                "yaxis": "y3", "hovertemplate": "%{x:.4f} Hz",
                "marker": {
                    "symbol": "line-ns-open", "size": 26, "color": kind_colour(kind),
                    "line": {"width": 1.5, "color": kind_colour(kind)},
                },
            })
        })
        .collect()
}

fn of_kinds(modes: &[Mode]) -> impl Iterator<Item = (Kind, Vec<&Mode>)> {
    KINDS
        .into_iter()
        .map(move |kind| (kind, modes.iter().filter(|m| m.kind == kind).collect::<Vec<_>>()))
        .filter(|(_, found)| !found.is_empty())
}

/// Figure of the platform's share of the kinetic energy of every mode, over frequency.
pub(crate) fn strip(modes: &Modes) -> PageFigure {
    let mut data = Vec::new();

    for (kind, found) in of_kinds(&modes.modes) {
        let (mut stem_x, mut stem_y) = (Vec::new(), Vec::new());
        for mode in &found {
            stem_x.extend([mode.frequency_hz, mode.frequency_hz, f64::NAN]);
            stem_y.extend([0.0, 100.0 * mode.platform_energy_fraction, f64::NAN]);
        }

        let colour = kind_colour(kind);
        data.push(with(
            line("", &stem_x, &stem_y, colour, "solid"),
            json!({"showlegend": false, "hoverinfo": "skip", "line": {"width": 1.2}, "legendgroup": kind.name()}),
        ));

        let symbol = match kind {
            Kind::Platform => "circle",
            Kind::Mixed => "diamond",
            Kind::Cable => "line-ns-open",
            Kind::Drive => "triangle-up",
        };

        let x: Vec<f64> = found.iter().map(|m| m.frequency_hz).collect();
        let y: Vec<f64> = found.iter().map(|m| 100.0 * m.platform_energy_fraction).collect();
        data.push(json!({
            "type": "scatter", "mode": "markers", "name": format!("{} ({})", kind.name(), found.len()),
            "x": rounded(&x), "y": rounded(&y),
            "legendgroup": kind.name(), "hovertemplate": "%{x:.4f} Hz<br>platform %{y:.1f} % of the energy",
            "marker": {
                "symbol": symbol, "size": if kind == Kind::Cable { 10 } else { 8 }, "color": colour,
                "line": {"color": colour, "width": 1.4},
            },
        }));
    }

    PageFigure::new(
        "figure-modes",
        300,
        format!(
            "Natural frequencies below {} Hz. Height: the platform's share of the mode's kinetic energy, which is at \
             least 75 % for platform modes and at most 25 % for cable modes.",
            modes.below_hz
        ),
        &data,
        json!({
            "xaxis": axis("natural frequency [Hz]", json!({"range": [0, modes.below_hz]})),
            "yaxis": axis("platform's share [%]", json!({"range": [-7, 107], "tickvals": [0, 25, 50, 75, 100]})),
        }),
    )
}
