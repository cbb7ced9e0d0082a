//! Figures of pages: descriptions for plotly in JSON, in one style.
//!
//! The descriptions are written directly as JSON. The builders of the crate `plotly` lack features that are used here
//! (empty values in a line, several legends) and would be three times as long; the crate only provides the library
//! plotly.js.

pub(crate) mod models;
pub(crate) mod response;
pub(crate) mod robot;
pub(crate) mod shapes;

pub(crate) use crate::figure_style::{colour, kind_colour};

use askama::Template;
use serde_json::{Value, json};

/// Figure with a caption.
#[derive(Template)]
#[template(path = "figure.html")]
pub(crate) struct PageFigure {
    id: String,
    height: usize,
    caption: String,
    json: String,
    /// True for a view in space.
    scene: bool,
}

impl PageFigure {
    /// Creates a figure from plotly's traces and layout; the common style is added to `layout`.
    pub(crate) fn new(
        id: impl Into<String>,
        height: usize,
        caption: impl Into<String>,
        data: &[Value],
        layout: Value,
    ) -> Self {
        let mut full = json!({
            "font": {
                "family": "system-ui, -apple-system, Segoe UI, Roboto, Helvetica Neue, Arial, sans-serif", "size": 13,
                "color": "#1b1b1b",
            },
            "paper_bgcolor": "#ffffff",
            "plot_bgcolor": "#ffffff",
            "margin": {"l": 64, "r": 16, "t": 34, "b": 52},
            "legend": {
                "orientation": "h", "x": 0, "xanchor": "left", "y": 1.01, "yanchor": "bottom", "font": {"size": 12},
            },
            "hovermode": "closest",
            "autosize": true,
        });
        let scene = layout.get("scene").is_some();
        merge(&mut full, layout);
        // In a script element only `<` can end the element or open a comment. In JSON it occurs only in strings.
        let json = json!({"data": data, "layout": full}).to_string().replace('<', "\\u003c");
        Self { id: id.into(), height, caption: caption.into(), json, scene }
    }
}

/// Merges `over` into `base`, object by object; values of `over` win.
fn merge(base: &mut Value, over: Value) {
    match (base, over) {
        (Value::Object(base), Value::Object(over)) => {
            for (key, value) in over {
                merge(base.entry(key).or_insert(Value::Null), value);
            }
        }
        (base, over) => *base = over,
    }
}

/// Returns `base` with `over` merged into it.
pub(crate) fn with(mut base: Value, over: Value) -> Value {
    merge(&mut base, over);
    base
}

/// Cartesian axis with a title.
pub(crate) fn axis(title: &str, more: Value) -> Value {
    let base = json!({
        "title": {"text": title, "standoff": 10, "font": {"size": 13}}, "tickfont": {"size": 12}, "showline": true,
        "linecolor": "#444444", "ticks": "outside", "tickcolor": "#444444",
        "gridcolor": "#ebebeb", "zeroline": false, "mirror": true,
    });
    with(base, more)
}

/// Line through points.
pub(crate) fn line(name: &str, x: &[f64], y: &[f64], colour: &str, dash: &str) -> Value {
    json!({
        "type": "scatter", "mode": "lines", "name": name, "x": rounded(x), "y": rounded(y),
        "line": {"color": colour, "width": 1.8, "dash": dash},
    })
}

/// Colours of the cables, repeated with other dashes if there are more cables.
pub(crate) const CABLE_COLOURS: [&str; 7] =
    [colour::BLUE, colour::VERMILION, colour::GREEN, colour::PURPLE, colour::ORANGE, colour::SKY, colour::BLACK];
const CABLE_DASHES: [&str; 3] = ["solid", "dash", "dot"];

/// Colour and dash of the line of cable `i` in a chart.
pub(crate) fn cable_line_style(i: usize) -> (&'static str, &'static str) {
    let round = i / CABLE_COLOURS.len();
    (CABLE_COLOURS[i % CABLE_COLOURS.len()], CABLE_DASHES[round % CABLE_DASHES.len()])
}

/// Points drawn with a symbol.
pub(crate) fn points(name: &str, x: &[f64], y: &[f64], colour: &str, symbol: &str) -> Value {
    json!({
        "type": "scatter", "mode": "markers", "name": name, "x": rounded(x), "y": rounded(y),
        "marker": {"color": colour, "symbol": symbol, "size": 8, "line": {"color": colour, "width": 1.4}},
    })
}

/// Values rounded to six significant digits: finer than any pixel, and half the size of the page.
pub(crate) fn rounded(values: &[f64]) -> Vec<Option<f64>> {
    values.iter().map(|v| if v.is_finite() { format!("{v:.5e}").parse().ok() } else { None }).collect()
}

/// Text with escaped tags, because plotly interprets some HTML tags in every text.
pub(crate) fn plain(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
