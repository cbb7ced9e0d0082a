//! Page about a calibration: anchors with their ellipses, residuals, rows that can be left out, proposals.

use super::Shell;
use super::figure::{PageFigure, axis, cable_line_style, colour, line, plain, points, with};
use super::table::PageTable;
use crate::figures::calibration::{AxisView, ellipse, tool_rows, views};
use anyhow::Context as _;
use askama::Template;
use funicular_study::analyses::calibrate::{
    Calibrated, CalibratedValue, DistanceRow, ProposalRow, ReadingRow, ToolRow,
};
use funicular_study::text::significant;
use serde_json::{Value, json};

const CONTENTS: &[(&str, &str)] = &[
    ("anchors", "Anchors"),
    ("rows", "Rows"),
    ("precision", "Precision"),
    ("accuracy", "Accuracy of the tool"),
    ("proposals", "What to measure next"),
    ("repeat", "How to repeat"),
];

#[derive(Template)]
#[template(path = "calibrate.html")]
struct CalibratePage<'a> {
    shell: Shell,
    found: &'a Calibrated,
    views: Vec<PageFigure>,
    values: PageTable,
    distances: PageTable,
    residuals: PageFigure,
    rows: PageTable,
    /// Linear equations of the rows, for the script of the page.
    refit: String,
    weak: Vec<String>,
    /// Sentences on the accuracy of the tool, with their table.
    accuracy: Option<(Vec<String>, PageTable)>,
    proposals: Option<PageTable>,
    script: &'static str,
    command_line: String,
}

/// Writes the page as HTML; `command_line` is the command that writes it again.
///
/// # Errors
/// A page that cannot be written.
pub fn page(found: &Calibrated, command_line: String) -> anyhow::Result<String> {
    let has_rules = found.proposals.iter().any(|row| row.tension_rule.is_some());
    let proposed = "Poses to measure next, one after the other, with the deviations that each leaves.";
    let page = CalibratePage {
        shell: Shell::new(format!("{}: calibration", found.robot), CONTENTS),
        found,
        views: views(found).iter().enumerate().map(|(k, view)| figure(found, view, k + 1)).collect(),
        values: PageTable::of("table-values", "Calibrated values.", &CalibratedValue::columns(), &found.values),
        distances: PageTable::of(
            "table-distances",
            "Distances between anchors, which no frame changes.",
            &DistanceRow::columns(),
            &found.distances,
        ),
        residuals: residuals(found),
        rows: PageTable::of("table-rows", "Rows after the fit.", &ReadingRow::columns(found.turns), &found.rows),
        // No `<` ends the script element that holds it.
        refit: serde_json::to_string(&found.refit_data())?.replace('<', "\\u003c"),
        weak: weak(found),
        accuracy: found.accuracy.as_ref().map(|accuracy| {
            let about = "Deviations of the platform in the frame of the values.";
            let table = PageTable::of("table-accuracy", about, &ToolRow::columns(found.turns), &accuracy.poses);
            (accuracy.sentences(), table)
        }),
        proposals: (!found.proposals.is_empty()).then(|| {
            let columns = ProposalRow::columns(found.turns, has_rules, found.accuracy.is_some());
            PageTable::of("table-proposals", proposed, &columns, &found.proposals)
        }),
        script: concat!(include_str!("../../templates/refit.js"), include_str!("../../templates/calibrate.js")),
        command_line,
    };
    page.render().context("the page could not be written as HTML")
}

/// Anchors, ellipses, poses and proposals in one view.
fn figure(found: &Calibrated, view: &AxisView, number: usize) -> PageFigure {
    let [a, b] = view.axes;
    let of =
        |points: &mut dyn Iterator<Item = [f64; 3]>| -> (Vec<f64>, Vec<f64>) { points.map(|p| (p[a], p[b])).unzip() };
    let scale = found.magnification();
    let (x, y) = of(&mut found.anchors.iter().map(|row| row.start_m));
    let mut data = vec![points("robot file", &x, &y, colour::GREY, "circle-open")];
    let (x, y) = of(&mut found.anchors.iter().map(|row| row.position_m));
    let names: Vec<String> = found.anchors.iter().map(|row| plain(&row.cable)).collect();
    let texts = json!({ "mode": "markers+text", "text": names, "textposition": "top center" });
    data.push(with(points("calibrated", &x, &y, colour::BLUE, "square"), texts));
    for (i, anchor) in found.anchors.iter().enumerate() {
        let curve = ellipse(anchor, view.axes, scale);
        let (x, y): (Vec<f64>, Vec<f64>) = curve.into_iter().unzip();
        let more = json!({ "legendgroup": "ellipses", "showlegend": i == 0, "meta": { "anchor": i } });
        data.push(with(line("2 deviations", &x, &y, colour::BLUE, "solid"), more));
        if let Some(weak) = anchor.weakest_m {
            let ends = [-2.0, 2.0].map(|side| [0, 1, 2].map(|k| anchor.position_m[k] + side * scale * weak[k]));
            let (x, y) = of(&mut ends.into_iter());
            let more = json!({ "legendgroup": "weakest", "showlegend": i == 0 });
            data.push(with(line("weakest combination", &x, &y, colour::VERMILION, "solid"), more));
        }
    }
    for (i, row) in tool_rows(found).iter().enumerate() {
        let (x, y): (Vec<f64>, Vec<f64>) = ellipse(row, view.axes, scale).into_iter().unzip();
        let more = json!({ "legendgroup": "tool", "showlegend": i == 0 });
        data.push(with(line("tool, 2 deviations", &x, &y, colour::ORANGE, "solid"), more));
    }
    let (x, y) = of(&mut found.rows.iter().map(|row| row.position_m));
    data.push(points("rows", &x, &y, colour::GREEN, "circle"));
    if !found.proposals.is_empty() {
        let (x, y) = of(&mut found.proposals.iter().map(|row| row.position_m));
        let numbers: Vec<String> = found.proposals.iter().map(|row| row.number.to_string()).collect();
        let texts = json!({ "mode": "markers+text", "text": numbers, "textposition": "top center" });
        data.push(with(points("to measure next", &x, &y, colour::PURPLE, "diamond"), texts));
    }
    PageFigure::new(
        format!("figure-anchors-{number}"),
        520,
        format!(
            "Anchors and poses, {}. Ellipses of two deviations with inner conditions and the weakest combination are \
             {} times as large as the room.",
            view.name,
            significant(scale, 2)
        ),
        &data,
        json!({
            "xaxis": axis(&format!("{} [m]", ["x", "y", "z"][a]), json!({})),
            "yaxis": axis(&format!("{} [m]", ["x", "y", "z"][b]), json!({ "scaleanchor": "x", "scaleratio": 1 })),
            "meta": { "axes": view.axes, "scale": scale },
        }),
    )
}

/// Residuals of every cable over the rows.
fn residuals(found: &Calibrated) -> PageFigure {
    let mut data: Vec<Value> = Vec::new();
    for (i, anchor) in found.anchors.iter().enumerate() {
        let of_cable = found.rows.iter().filter_map(|row| {
            let of = row.residuals.iter().find(|of| of.cable == anchor.cable)?;
            Some((row.row as f64, 1e3 * of.residual_m))
        });
        let (x, y): (Vec<f64>, Vec<f64>) = of_cable.unzip();
        data.push(points(&plain(&anchor.cable), &x, &y, cable_line_style(i).0, "circle"));
    }
    PageFigure::new(
        "figure-residuals",
        340,
        "Residuals of the readings, computed less measured, by cable.",
        &data,
        json!({ "xaxis": axis("row", json!({})), "yaxis": axis("residual [mm]", json!({ "zeroline": true })) }),
    )
}

/// Sentences on the weakest combinations.
fn weak(found: &Calibrated) -> Vec<String> {
    let sentence = |row: &funicular_study::analyses::calibrate::WeakRow| match row.deviation_m {
        Some(deviation) => format!("±{} mm: {}", significant(1e3 * deviation, 4), row.words),
        None => format!("undetermined: {}", row.words),
    };
    found.weak_combinations.iter().map(sentence).collect()
}
