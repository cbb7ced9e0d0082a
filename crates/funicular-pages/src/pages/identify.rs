//! Page about a fit: values with deviations, measured and fitted curves, natural frequencies, correlations.

use super::Shell;
use super::figure::{PageFigure, axis, colour, line, plain, points, with};
use super::table::{PageTable, fixed, significant};
use anyhow::Context as _;
use askama::Template;
use funicular_study::analyses::identify::{
    FittedResponse, FittedValue, Identified, PoleRow, Profile, StaticRow, ValueRow,
};
use funicular_study::text;
use serde_json::{Value, json};

/// Sections of a fit; without one there are no values and no precision.
const CONTENTS: [(&str, &str); 4] =
    [("values", "Values"), ("measurements", "Measurements"), ("precision", "Precision"), ("repeat", "How to repeat")];

#[derive(Template)]
#[template(path = "identify.html")]
struct IdentifyPage<'a> {
    shell: Shell,
    found: &'a Identified,
    values: Option<PageTable>,
    chi2: String,
    histories: Option<PageTable>,
    responses: Vec<PageFigure>,
    frequencies: Option<(PageFigure, PageTable)>,
    /// Sentences on fits with other modes and to random frequencies.
    assignment: Vec<String>,
    statics: Option<PageTable>,
    profiles: Vec<PageFigure>,
    correlations: PageFigure,
    command_line: String,
}

/// Writes the page as HTML; `command_line` is the command that writes it again.
///
/// # Errors
/// A page that cannot be written.
pub fn page(found: &Identified, command_line: String) -> anyhow::Result<String> {
    let has_values = !found.values.is_empty();
    let contents: Vec<(&str, &str)> =
        CONTENTS.into_iter().filter(|(id, _)| has_values || !["values", "precision"].contains(id)).collect();
    let page = IdentifyPage {
        shell: Shell::new(format!("{}: values from measurements", found.robot), contents),
        found,
        values: has_values.then(|| values(found)),
        chi2: format!(
            "χ² = {} for {} of freedom, χ²/n = {}",
            significant(found.chi2, 4),
            funicular_study::text::counted(found.degrees_of_freedom, "degree"),
            significant(found.chi2_per_degree, 3)
        ),
        histories: histories(found),
        responses: found.responses.iter().enumerate().map(|(i, response)| curves(i, response)).collect(),
        frequencies: (!found.frequencies.is_empty()).then(|| (differences(found), frequencies(found))),
        assignment: found.assignment.as_ref().map_or_else(Vec::new, |assignment| {
            let second = assignment.second_best.as_ref().map(|second| second.sentence(&found.values) + ".");
            assignment.random_text().into_iter().chain(second).collect()
        }),
        statics: (!found.statics.is_empty()).then(|| statics(found)),
        profiles: found.values.iter().enumerate().filter_map(|(i, row)| profile(i, row)).collect(),
        correlations: correlations(found),
        command_line,
    };
    page.render().context("the page could not be written as HTML")
}

/// Natural frequencies of time histories.
fn histories(found: &Identified) -> Option<PageTable> {
    let names: Vec<&str> = found.histories.iter().map(|history| history.name.as_str()).collect();
    let caption = format!("Natural frequencies with standard deviations, from {}.", names.join(", "));
    let rows = found.histories.iter().flat_map(|history| &history.poles);
    (!names.is_empty()).then(|| PageTable::of("table-histories", caption, &PoleRow::columns(), rows))
}

fn values(found: &Identified) -> PageTable {
    let caption = "Identified values with standard deviations and the intervals that hold them with 95 %.";
    PageTable::of("table-values", caption, &FittedValue::columns(), FittedValue::all(found))
}

/// Figure of a measured response, the response before the fit and the fitted one: magnitude, and phase below.
fn curves(number: usize, response: &FittedResponse) -> PageFigure {
    let polar = |real: &[f64], imag: &[f64]| {
        let magnitude: Vec<f64> = real.iter().zip(imag).map(|(re, im)| re.hypot(*im)).collect();
        let phase: Vec<f64> = real.iter().zip(imag).map(|(re, im)| im.atan2(*re).to_degrees()).collect();
        (magnitude, phase)
    };

    let x = &response.frequency_hz;
    let mut data: Vec<Value> = Vec::new();

    let (magnitude, phase) = polar(&response.measured_real, &response.measured_imag);
    let small = json!({"marker": {"size": 4}, "legendgroup": "measured"});
    data.push(with(points("measured", x, &magnitude, colour::GREY, "circle"), small.clone()));
    let below = json!({"yaxis": "y2", "showlegend": false});
    data.push(with(with(points("measured", x, &phase, colour::GREY, "circle"), small), below.clone()));

    for (name, real, imag, colour, dash) in [
        ("before the fit", &response.before_real, &response.before_imag, colour::ORANGE, "dot"),
        ("fitted", &response.fitted_real, &response.fitted_imag, colour::BLUE, "solid"),
    ] {
        if real.is_empty() {
            continue;
        }
        let (magnitude, phase) = polar(real, imag);
        data.push(with(line(name, x, &magnitude, colour, dash), json!({"legendgroup": name})));
        data.push(with(with(line(name, x, &phase, colour, dash), json!({"legendgroup": name})), below.clone()));
    }

    let name = if response.name.is_empty() {
        format!("{}/{}", response.output, response.input)
    } else {
        response.name.clone()
    };

    PageFigure::new(
        format!("figure-response-{}", number + 1),
        560,
        format!(
            "{}, {}: measured and fitted. The residuals have {} times the deviations of the measurement.",
            response.experiment,
            name,
            significant(response.residual_rms, 3)
        ),
        &data,
        json!({
            "xaxis": axis("frequency [Hz]", json!({"anchor": "y2", "mirror": "all"})),
            "yaxis": axis(&format!("magnitude [{}]", response.unit), json!({
                "type": "log", "domain": [0.36, 1.0], "exponentformat": "power", "dtick": 1,
            })),
            "yaxis2": axis("phase [°]", json!({
                "domain": [0.0, 0.3], "range": [-190, 190], "tickvals": [-180, -90, 0, 90, 180],
            })),
            "margin": {"l": 78},
        }),
    )
}

/// Figure of the differences of all natural frequencies before and after the fit.
fn differences(found: &Identified) -> PageFigure {
    let x: Vec<f64> = found.frequencies.iter().map(|row| row.measured_hz).collect();
    let relative = |hz: fn(&funicular_study::analyses::identify::FrequencyRow) -> Option<f64>| -> Vec<f64> {
        found.frequencies.iter().filter_map(|row| Some(100.0 * (hz(row)? / row.measured_hz - 1.0))).collect()
    };

    let data = [
        points("before the fit", &x, &relative(|row| row.before_hz), colour::ORANGE, "circle-open"),
        points("fitted", &x, &relative(|row| Some(row.fitted_hz)), colour::BLUE, "circle"),
    ];

    let rms = |value: Option<f64>| value.map_or_else(|| text::NONE.to_owned(), |value| significant(100.0 * value, 3));

    PageFigure::new(
        "figure-differences",
        340,
        format!(
            "Differences of the computed natural frequencies from the measured ones: root mean square {} %, before the \
             fit {} %.",
            rms(found.frequency_rms),
            rms(found.frequency_rms_before)
        ),
        &data,
        json!({
            "xaxis": axis("measured natural frequency [Hz]", json!({})),
            "yaxis": axis("computed − measured [%]", json!({"zeroline": true, "zerolinecolor": "#444444"})),
        }),
    )
}

fn frequencies(found: &Identified) -> PageTable {
    let second = found.assignment.as_ref().and_then(|assignment| assignment.second_best.as_ref());
    let mut columns = vec![
        "<experiment",
        "number",
        "measured|Hz",
        "before|Hz",
        "fitted|Hz",
        "difference|%",
        "damping measured",
        "damping fitted",
    ];
    if second.is_some() {
        columns.extend(["second best number", "second best|Hz"]);
    }
    let mut table = PageTable::new(
        "table-frequencies",
        "Natural frequencies. The number is that of the mode in the ascending list.",
        &columns,
    );

    for (k, row) in found.frequencies.iter().enumerate() {
        let damping = |value: Option<f64>| value.map_or_else(|| text::NONE.to_owned(), |value| significant(value, 3));

        let mut cells = vec![
            row.experiment.clone(),
            row.number.to_string(),
            fixed(row.measured_hz, 4),
            row.before_hz.map_or_else(|| text::NONE.to_owned(), |hz| fixed(hz, 4)),
            fixed(row.fitted_hz, 4),
            fixed(100.0 * (row.fitted_hz / row.measured_hz - 1.0), 2),
            damping(row.measured_damping_ratio),
            damping(row.fitted_damping_ratio),
        ];
        if let Some(second) = second {
            cells.extend([second.numbers[k].to_string(), fixed(second.frequency_hz[k], 4)]);
        }
        table.row(cells);
    }
    table
}

fn statics(found: &Identified) -> PageTable {
    let caption = "Poses (differences from the measured pose), tensions and lengths.";
    PageTable::of("table-statics", caption, &StaticRow::columns(), &found.statics)
}

/// Figure of the rise of χ² on both sides of a value, if its profile was computed.
fn profile(number: usize, row: &ValueRow) -> Option<PageFigure> {
    let profile = row.profile.as_ref()?;
    let x: Vec<f64> = profile.points.iter().map(|point| point.value - row.value).collect();
    let y: Vec<f64> = profile.points.iter().map(|point| point.chi2_rise).collect();
    let curve = line("others fitted again", &x, &y, colour::BLUE, "solid");

    let mut data =
        vec![with(curve, json!({"mode": "lines+markers", "line": {"shape": "spline"}, "marker": {"size": 5}}))];

    let limit = Profile::RISE_95;
    if let (Some([low, high]), Some(from), Some(to)) = (row.parabola_95, x.first(), x.last()) {
        // The deviation's interval as the parabola of χ², whose coordinate may be a logarithm.
        let at = |x: f64| {
            let half = if x < 0.0 { row.value - low } else { high - row.value };
            limit * (x / half).powi(2)
        };
        let parabola: Vec<f64> = (0..=60).map(|i| from + (to - from) * f64::from(i) / 60.0).collect();
        let rises: Vec<f64> = parabola.iter().map(|x| at(*x)).collect();
        data.push(line("by the deviation", &parabola, &rises, colour::GREY, "dash"));
    }

    if let (Some(from), Some(to)) = (x.first(), x.last()) {
        data.push(line("limit for 95 %", &[*from, *to], &[limit, limit], colour::VERMILION, "dot"));
    }

    let name = plain(&row.path);
    let end = |end: Option<f64>| {
        end.map_or_else(|| "no lower or upper end".to_owned(), |end| format!("{} {}", significant(end, 6), row.unit))
    };

    Some(PageFigure::new(
        format!("figure-profile-{}", number + 1),
        320,
        format!("Profile of {name}: χ² reaches its limit for 95 % at {} and {}.", end(profile.from), end(profile.to)),
        &data,
        json!({
            "xaxis": axis(&format!("{name} − {} [{}]", significant(row.value, 6), row.unit), json!({})),
            "yaxis": axis("rise of χ²", json!({"range": [-0.2, 2.0 * limit]})),
        }),
    ))
}

/// Figure of all correlations.
fn correlations(found: &Identified) -> PageFigure {
    let names: Vec<String> = found.values.iter().map(|row| plain(&row.path)).collect();
    let data = [json!({
        "type": "heatmap", "x": names, "y": names, "z": found.correlations, "zmin": -1, "zmax": 1, "colorscale": "RdBu",
        "hovertemplate": "%{x}<br>%{y}<br>%{z:.3f}<extra></extra>",
    })];
    PageFigure::new(
        "figure-correlations",
        // The margins with the names, and a row per value; below that the numbers of the scale touch.
        260 + 34 * found.values.len(),
        "Correlations of the values, priors included.",
        &data,
        json!({"margin": {"l": 230, "b": 170}, "yaxis": {"autorange": "reversed"}}),
    )
}
