//! Page about uncertain results: values with error bars, shares of the numbers that deviate, tables.

use super::Shell;
use super::figure::{PageFigure, axis, colour, plain, rounded};
use super::table::PageTable;
use anyhow::Context as _;
use askama::Template;
use funicular_study::analyses::uncertainty::{
    PoseUncertainty, ResultAtPose, UncertainInput, UncertainResult, Uncertainties,
};
use serde_json::{Value, json};

const CONTENTS: &[(&str, &str)] =
    &[("results", "Results"), ("numbers", "Numbers that deviate"), ("repeat", "How to repeat")];

/// Maximum number of results that have a figure over the poses.
const MAX_FIGURES: usize = 40;

/// Colours of the groups in bars of shares.
const COLOURS: [&str; 7] =
    [colour::BLUE, colour::ORANGE, colour::GREEN, colour::SKY, colour::VERMILION, colour::PURPLE, colour::GREY];

/// Methods, with colour and symbol of their marks.
const METHODS: [(&str, &str, &str); 2] = [("linear", colour::BLUE, "circle"), ("sampled", colour::VERMILION, "square")];

#[derive(Template)]
#[template(path = "uncertainty.html")]
struct UncertaintyPage<'a> {
    shell: Shell,
    found: &'a Uncertainties,
    figures: Vec<PageFigure>,
    results: PageTable,
    reasons: Vec<String>,
    numbers: PageTable,
    command_line: String,
}

/// Writes the page as HTML; `command_line` is the command that writes it again.
///
/// # Errors
/// A page that cannot be written.
pub fn page(found: &Uncertainties, command_line: String) -> anyhow::Result<String> {
    let figures = match &found.poses[..] {
        [pose] => of_one_pose(found, pose),
        _ => over_poses(found),
    };
    let mut reasons: Vec<String> = Vec::new();
    for reason in found.poses.iter().flat_map(|pose| &pose.results).filter_map(|result| result.sampling_reason.as_ref())
    {
        if !reasons.contains(reason) {
            reasons.push(reason.clone());
        }
    }
    let page = UncertaintyPage {
        shell: Shell::new(format!("{}: uncertainty of results", found.robot), CONTENTS),
        found,
        figures,
        results: results(found),
        reasons,
        numbers: numbers(found),
        command_line,
    };
    page.render().context("the page could not be written as HTML")
}

/// Error bars from the interval of a result to its value.
fn bars(results: &[&UncertainResult]) -> Value {
    let side = |of: fn([f64; 2], f64) -> f64| -> Vec<f64> {
        let of_result = |result: &&UncertainResult| {
            result.interval_95.map_or(f64::NAN, |interval| of(interval, result.value).max(0.0))
        };
        results.iter().map(of_result).collect()
    };
    json!({
        "type": "data", "symmetric": false, "thickness": 1.6, "width": 5,
        "array": rounded(&side(|[_, to], value| to - value)),
        "arrayminus": rounded(&side(|[from, _], value| value - from)),
    })
}

/// Figures of one pose: the results of each unit with error bars, then the shares of the groups.
fn of_one_pose(found: &Uncertainties, pose: &PoseUncertainty) -> Vec<PageFigure> {
    // Responses at several frequencies have figures over the frequency.
    let over_frequency = over_frequency(found, pose);
    let is_beside = |result: &&UncertainResult| over_frequency.is_empty() || result.at_hz.is_none();
    let mut units: Vec<&str> = Vec::new();
    for result in pose.results.iter().filter(is_beside) {
        if !units.contains(&result.unit) {
            units.push(result.unit);
        }
    }

    let mut figures = Vec::new();
    for unit in units {
        let of_unit: Vec<&UncertainResult> = pose.results.iter().filter(|result| result.unit == unit).collect();
        let traces: Vec<Value> = METHODS
            .into_iter()
            .filter_map(|(method, colour, symbol)| {
                let own: Vec<&UncertainResult> = of_unit.iter().copied().filter(|r| r.method == method).collect();
                (!own.is_empty()).then(|| {
                    let values: Vec<f64> = own.iter().map(|result| result.value).collect();
                    let names: Vec<String> = own.iter().map(|result| plain(&result.name)).collect();
                    json!({
                        "type": "scatter", "mode": "markers", "name": method, "x": rounded(&values), "y": names,
                        "error_x": bars(&own), "marker": {"color": colour, "symbol": symbol, "size": 7},
                    })
                })
            })
            .collect();
        // The categories are in the order of the results, from above.
        let order: Vec<String> = of_unit.iter().map(|result| plain(&result.name)).collect();
        figures.push(PageFigure::new(
            format!("figure-results-{}", figures.len() + 1),
            130 + 22 * of_unit.len(),
            format!("Results in {unit} with the intervals that hold 95 % of all robots."),
            &traces,
            json!({
                "xaxis": axis(&format!("value [{unit}]"), json!({})),
                "yaxis": axis("", json!({
                    "automargin": true, "autorange": "reversed", "categoryorder": "array", "categoryarray": order,
                })),
            }),
        ));
    }
    figures.extend(over_frequency);
    if found.groups.len() > 1 {
        figures.push(shares(found, pose));
    }
    figures
}

/// Figures of a response at several frequencies: magnitude and phase with error bars. Empty for a single frequency.
fn over_frequency(found: &Uncertainties, pose: &PoseUncertainty) -> Vec<PageFigure> {
    let Some(response) = &found.response else { return Vec::new() };
    let of_unit = |unit: &str| -> Vec<&UncertainResult> {
        let mut all: Vec<&UncertainResult> =
            pose.results.iter().filter(|result| result.at_hz.is_some() && result.unit == unit).collect();
        all.sort_by(|a, b| a.at_hz.unwrap_or_default().total_cmp(&b.at_hz.unwrap_or_default()));
        all
    };

    if of_unit("dB").len() < 2 {
        return Vec::new();
    }

    let title = format!("{} / {}", plain(&response.output), plain(&response.input));
    let magnitude = format!("magnitude [dB of 1 {}]", response.unit);
    [("magnitude", "dB", magnitude), ("phase", "degrees", "phase [°]".to_owned())]
        .into_iter()
        .map(|(name, unit, label)| {
            let all = of_unit(unit);
            let line: Vec<f64> = all.iter().map(|result| result.value).collect();
            let hz = |of: &[&UncertainResult]| -> Vec<f64> { of.iter().filter_map(|result| result.at_hz).collect() };

            let mut traces = vec![json!({
                "type": "scatter", "mode": "lines", "name": "undisturbed", "x": rounded(&hz(&all)), "y": rounded(&line),
                "line": {"color": colour::GREY, "width": 1}, "hoverinfo": "skip",
            })];

            for (method, colour, symbol) in METHODS {
                let own: Vec<&UncertainResult> = all.iter().copied().filter(|r| r.method == method).collect();
                if !own.is_empty() {
                    let values: Vec<f64> = own.iter().map(|result| result.value).collect();
                    traces.push(json!({
                        "type": "scatter", "mode": "markers", "name": method, "x": rounded(&hz(&own)),
                        "y": rounded(&values), "error_y": bars(&own),
                        "marker": {"color": colour, "symbol": symbol, "size": 6},
                    }));
                }
            }

            PageFigure::new(
                format!("figure-response-{name}"),
                340,
                format!("Response {title}: {name} with the intervals that hold 95 % of all robots."),
                &traces,
                json!({"xaxis": axis("frequency [Hz]", json!({})), "yaxis": axis(&label, json!({}))}),
            )
        })
        .collect()
}

/// Stacked bars of the shares of the groups in the variance of each result.
fn shares(found: &Uncertainties, pose: &PoseUncertainty) -> PageFigure {
    let with_shares: Vec<&UncertainResult> =
        pose.results.iter().filter(|result| result.group_shares.is_some()).collect();
    let names: Vec<String> = with_shares.iter().map(|result| plain(&result.name)).collect();

    let traces: Vec<Value> = (found.groups.iter().enumerate())
        .map(|(g, group)| {
            let of_group: Vec<f64> = with_shares
                .iter()
                .map(|result| result.group_shares.as_ref().map_or(0.0, |all| 100.0 * all[g]))
                .collect();
            json!({
                "type": "bar", "orientation": "h", "name": plain(&group.name), "x": rounded(&of_group), "y": names,
                "marker": {"color": COLOURS[g % COLOURS.len()]},
            })
        })
        .collect();

    PageFigure::new(
        "figure-shares",
        130 + 22 * with_shares.len(),
        "Shares of the groups in the variance of each result. Total shares of sampled results may add up to \
         more than 100 %.",
        &traces,
        json!({
            "barmode": "stack",
            "xaxis": axis("share [%]", json!({})),
            "yaxis": axis("", json!({"automargin": true, "autorange": "reversed"})),
        }),
    )
}

/// Figures over the poses: one per result, with error bars.
fn over_poses(found: &Uncertainties) -> Vec<PageFigure> {
    let mut names: Vec<(&str, &str)> = Vec::new();
    for result in found.poses.iter().flat_map(|pose| &pose.results) {
        if !names.iter().any(|(name, _)| *name == result.name) {
            names.push((&result.name, result.unit));
        }
    }

    let (title, place) = abscissa(found);
    names.truncate(MAX_FIGURES);
    let figure = |(i, (name, unit)): (usize, &(&str, &str))| {
        let mut traces = Vec::new();
        for (method, colour, symbol) in METHODS {
            let (mut x, mut own) = (Vec::new(), Vec::new());
            for (k, pose) in found.poses.iter().enumerate() {
                for result in pose.results.iter().filter(|result| result.name == *name && result.method == method) {
                    x.push(place(k, pose));
                    own.push(result);
                }
            }
            if own.is_empty() {
                continue;
            }
            let values: Vec<f64> = own.iter().map(|result| result.value).collect();
            traces.push(json!({
                "type": "scatter", "mode": "markers", "name": method, "x": rounded(&x), "y": rounded(&values),
                "error_y": bars(&own), "marker": {"color": colour, "symbol": symbol, "size": 6},
            }));
        }
        PageFigure::new(
            format!("figure-poses-{}", i + 1),
            300,
            format!("{}: values with the intervals that hold 95 % of all robots.", plain(name)),
            &traces,
            json!({
                "xaxis": axis(title, json!({})),
                "yaxis": axis(&format!("{} [{unit}]", plain(name)), json!({})),
            }),
        )
    };
    names.iter().enumerate().map(figure).collect()
}

/// Axis of figures over the poses: the coordinate that changes, if it is a single one and ascends, else the number.
fn abscissa(found: &Uncertainties) -> (&'static str, impl Fn(usize, &PoseUncertainty) -> f64) {
    const AXES: [&str; 3] = ["x [m]", "y [m]", "z [m]"];
    let positions: Vec<[f64; 3]> = found.poses.iter().filter_map(|pose| pose.position_m).collect();
    let changes = |k: usize| positions.windows(2).any(|pair| (pair[1][k] - pair[0][k]).abs() > 1e-9);
    let changing: Vec<usize> = (0..3).filter(|k| changes(*k)).collect();
    let axis = match changing[..] {
        [k] if positions.windows(2).all(|pair| pair[1][k] > pair[0][k]) => Some(k),
        _ => None,
    };
    let place = move |number: usize, pose: &PoseUncertainty| match (axis, pose.position_m) {
        (Some(k), Some(position)) => position[k],
        _ => (number + 1) as f64,
    };
    (axis.map_or("number of the pose", |k| AXES[k]), place)
}

fn results(found: &Uncertainties) -> PageTable {
    let caption = "Results with standard deviations and the intervals that hold 95 % of all robots; corners of the \
                   tolerances as changes of the result.";
    let columns = ResultAtPose::columns(&found.groups, true);
    PageTable::of("table-results", caption, &columns, ResultAtPose::all(found, 0, found.poses.len()))
}

fn numbers(found: &Uncertainties) -> PageTable {
    PageTable::of("table-numbers", "Numbers that deviate.", &UncertainInput::columns(&found.groups), &found.inputs)
}
