//! Figure of the differences between the modes of each cable model and those of the reference.

use super::{PageFigure, axis, colour, points, with};
use crate::figures::style::ModelStyle;
use funicular::compare::{Comparison, TOLERANCE};
use serde_json::{Value, json};

/// Smallest difference that is drawn [%]; smaller ones are drawn at this value.
const MIN_DIFFERENCE: f64 = 1e-4;
/// Position of modes that a model lacks [%]; each model has its own line above this value.
const LACKING: f64 = 60.0;
/// Ratio between the positions of two such lines.
const LINE: f64 = 1.6;

/// Differences over frequency; `None` if the reference has no modes.
pub(crate) fn figure(comparison: &Comparison) -> Option<PageFigure> {
    let reference = comparison.models.iter().find(|model| model.model == comparison.reference)?;
    let modes = &reference.modes.as_ref().ok()?.modes;
    if modes.is_empty() {
        return None;
    }

    let mut traces: Vec<Value> = Vec::new();
    let others = comparison.models.iter().filter(|model| model.model != comparison.reference && model.modes.is_ok());
    let mut highest = LACKING;
    for result in others {
        let ModelStyle { colour, .. } = ModelStyle::of(result.model);
        let found: Vec<f64> = result.matches.iter().map(|of| of.reference_hz).collect();
        let differences: Vec<f64> =
            result.matches.iter().map(|of| (100.0 * of.relative_difference.abs()).max(MIN_DIFFERENCE)).collect();

        let group = json!({ "legendgroup": result.model.name() });
        traces.push(with(points(result.model.name(), &found, &differences, colour, "circle"), group.clone()));

        let has = |index: usize| result.matches.iter().any(|of| of.reference_index == index);
        let lacking: Vec<f64> =
            modes.iter().enumerate().filter(|(i, _)| !has(*i)).map(|(_, mode)| mode.frequency_hz).collect();
        highest *= LINE;

        if !lacking.is_empty() {
            let name = format!("{}: missing", result.model.name());
            let trace = points(&name, &lacking, &vec![highest; lacking.len()], colour, "x-thin-open");
            traces.push(with(trace, with(group, json!({ "showlegend": false }))));
        }
    }

    let tolerance = 100.0 * TOLERANCE;
    let layout = json!({
        "xaxis": axis("natural frequency [Hz]", json!({ "range": [0.0, comparison.below_hz] })),
        "yaxis": axis("difference [%]", json!({
            "type": "log",
            "range": [MIN_DIFFERENCE.log10() - 0.15, (highest * LINE).log10()],
            "tickvals": [1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0],
            "ticktext": ["≤ 0.0001", "0.001", "0.01", "0.1", "1", "10"],
        })),
        "shapes": [{
            "type": "line", "xref": "paper", "x0": 0, "x1": 1, "y0": tolerance, "y1": tolerance,
            "line": { "color": colour::GREY, "width": 1, "dash": "dot" },
        }],
        "annotations": [{
            "xref": "paper", "x": 1, "xanchor": "right", "yref": "paper", "y": 1.01, "yanchor": "bottom",
            "showarrow": false, "text": "× a mode that the model does not have",
        }],
    });

    let caption = format!(
        "Relative difference between the natural frequencies of each cable model and those of the model {}, over \
         frequency. Dotted line: {tolerance} %. Crosses at the top: modes that the model of that colour does not have.",
        comparison.reference.name(),
    );
    Some(PageFigure::new("figure-models", 420, caption, &traces, layout))
}
