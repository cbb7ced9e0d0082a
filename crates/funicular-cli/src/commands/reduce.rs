//! `reduce`: text.

use crate::output::Printed;
use crate::table::{Table, counted, decimals};
use funicular_files::endings::Kind;
use funicular_study::analyses::control_model::{ControlStateSpace, StatesRow, percent};
use funicular_study::analyses::reduce::{ChannelRow, Reduced, ReducedForm};
use std::path::Path;

impl Printed for ReducedForm {
    fn text(&self) -> String {
        match self {
            Self::StateSpace(found) => state_space_text(found),
            Self::SecondOrder(found) => second_order_text(found),
        }
    }
}

/// Sentence in place of the file that was not requested.
const NOT_WRITTEN: &str =
    "The matrices are not written: give --matrices model.npz, model.mat, or a folder for CSV files.";

/// Names and units of inputs or outputs.
fn names(channels: &[ChannelRow]) -> String {
    channels.iter().map(|of| format!("{} [{}]", of.name, of.unit)).collect::<Vec<_>>().join(", ")
}

/// Peaks and errors of the responses, and the number of pairs that are not coupled.
fn errors_table(found: &ControlStateSpace) -> String {
    let mut errors =
        Table::new(&["response", "peak", "unit", "at [Hz]", "error [% of peak]", "at [Hz]"]).text_columns(&[0, 2]);
    let shown = found.responses.iter().filter(|of| of.coupled);
    for of in shown.clone() {
        errors.row(vec![
            format!("{}/{}", of.output, of.input),
            format!("{:.4e}", of.peak),
            of.unit.clone(),
            decimals(of.peak_hz, 4),
            percent(of.error),
            decimals(of.error_hz, 4),
        ]);
    }
    let none = match found.responses.len() - shown.count() {
        0 => String::new(),
        n => format!("{} not coupled: below a millionth of the others\n", counted(n, "response")),
    };

    format!("{errors}{none}")
}

/// Text of a state space.
fn state_space_text(found: &ControlStateSpace) -> String {
    let (modes, errors) = (Table::of(&StatesRow::columns(), &found.states), errors_table(found));
    let damping = if found.damping_error == 0.0 {
        String::new()
    } else {
        format!("; with all modes {} % would remain", percent(found.damping_error))
    };
    let pointwise = format!(
        "relative to the response at the same frequency: up to {} % ({}/{} at {} Hz, where the response is {} % of \
             its peak)",
        percent(found.pointwise_error.error),
        found.pointwise_error.output,
        found.pointwise_error.input,
        decimals(found.pointwise_error.frequency_hz, 4),
        percent(found.pointwise_error.response_over_peak),
    );
    let written = match &found.matrices_file {
        None => NOT_WRITTEN.to_owned(),
        Some(path) if Kind::of(Path::new(path)) == Some(Kind::Fmu) => {
            format!(
                "{path}: x' = A x + B u, y = C x + D u as a Functional Mock-up Unit 2.0, with robot file and \
                 description"
            )
        }
        Some(path) => format!("{path}: A, B, C, D of x' = A x + B f, y = C x + D f; description"),
    };

    format!(
        "{}: state space for frequencies below {} Hz\n{}\n\n{}; the complete model has {}, the robot {} below the \
             limit\ninputs: {}\noutputs: {}\ndamping: {}\n\n{modes}\nerror: at most {} % of the peak of each \
             response{damping}\n{errors}{pointwise}\n\n{written}\n",
        found.robot,
        found.below_hz,
        found.models.line(),
        counted(found.order, "state"),
        found.complete_order,
        counted(found.modes_below, "mode"),
        names(&found.inputs),
        names(&found.outputs),
        found.damping,
        percent(found.error),
    )
}

/// Text of a second-order model.
fn second_order_text(found: &Reduced) -> String {
    let mut errors = Table::new(&["", "max relative error"]);
    let mut row = |what: &str, error: Option<f64>| {
        errors.row(vec![what.to_owned(), error.map_or("no response: undamped".to_owned(), |e| format!("{e:.1e}"))]);
    };
    row("natural frequencies", Some(found.frequency_error));
    row("responses, due to omitted modes", found.truncation_error);
    row("responses, due to viscous damping", found.damping_error);

    let highest = found.coordinates.iter().filter_map(|of| of.clamped_frequency_hz).fold(0.0, f64::max);
    let clamped = found.coordinates.iter().filter(|of| of.clamped_frequency_hz.is_some()).count();
    let kept = match clamped {
        0 => String::new(),
        n => format!(" and {} of cables up to {} Hz", counted(n, "clamped mode"), decimals(highest, 2)),
    };

    let written = match &found.matrices_file {
        None => NOT_WRITTEN.to_owned(),
        Some(path) => format!(
            "{path}: M, C, K, B, L of M x'' + C x' + K x = B f, y = L x; ss_A, ss_B, ss_C, ss_D of its state \
                 space; the description"
        ),
    };

    format!(
        "{}: second-order model for frequencies below {} Hz\n{}\n\n{} coordinates: the platform's {}{kept}\n\
             inputs: {}\noutputs: {}\ndamping: {}\n\n{errors}\n{written}\n",
        found.robot,
        found.below_hz,
        found.models.line(),
        found.order,
        found.order - clamped,
        names(&found.inputs),
        names(&found.outputs),
        found.damping,
    )
}
