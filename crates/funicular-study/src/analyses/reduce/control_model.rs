//! `reduce` as a state space: A, B, C, D of the modes that inputs and outputs see, with their errors.

use super::{
    ChannelRow, DEFAULT_TOLERANCE, Linearised, check, damping_in_words, goes_on, input_rows, linearised, output_rows,
    stopped_or_error,
};
use crate::Watch;
use crate::analyses::found;
use crate::analyses::shared::Models;
use crate::at_rest::AtRest;
use crate::columns::only_read;
use crate::names::{ModelForm, Named};
use crate::request;
use crate::rows::rows;
use crate::signals::response_unit;
use anyhow::Result;
use funicular::math::DMat;
use funicular::reduced_model::{
    ControlModel, DampingAt, ModalStates, RequestedStateSpace, ResponseOfPair, StateSpaceSize, control_model,
};

rows! {
    /// Results of `reduce` as a state space.
    pub struct ControlStateSpace {
        pub robot: String = hidden;
        pub form: &'static str;
        pub below_hz: f64;
        pub models: Models = spread;
        pub order: usize;
        pub error: f64;
        pub damping_error: f64;
        pub pointwise_error: Pointwise;
        pub complete_order: usize;
        pub modes_below: usize;
        pub damping: String;
        pub inputs: Vec<ChannelRow>;
        pub outputs: Vec<ChannelRow>;
        pub responses: Vec<ResponseRow>;
        pub states: Vec<StatesRow>;
        pub a: Vec<Vec<f64>>;
        pub b: Vec<Vec<f64>>;
        pub c: Vec<Vec<f64>>;
        pub d: Vec<Vec<f64>>;
        /// File or folder to which a front end has written the matrices.
        pub matrices_file: Option<String>;
        /// Model with its matrices.
        pub model: ControlModel = hidden;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Largest error relative to the response at the same frequency.
    pub struct Pointwise {
        pub error: f64;
        pub frequency_hz: f64;
        pub output: String;
        pub input: String;
        pub response_over_peak: f64;
    }
}

rows! {
    /// Peak and error of the response of one output to one input.
    pub struct ResponseRow {
        pub output: String;
        pub input: String;
        pub unit: String;
        pub coupled: bool;
        pub peak: f64;
        pub peak_hz: f64;
        pub error: f64;
        pub error_hz: f64;
    }
}

rows! {
    /// States of one mode. The first state has the number 0.
    pub struct StatesRow in tables() {
        /// Number of the first state of the mode, from 0.
        pub first: usize => one("first_state");
        /// Number of its states.
        pub states: usize
            => one
            => only_read().shown("states", "", |of: &Self, _| {
                if of.states == 1 { format!("{}", of.first + 1) } else { format!("{}, {}", of.first + 1, of.first + 2) }
            });
        /// Natural frequency.
        pub frequency_hz: f64 => one.decimals("frequency", 4);
        /// Damping ratio.
        pub damping_ratio: f64 => one
            .shown("damping ratio", "%", |of, style| style.decimals(100.0 * of.damping_ratio, 4));
        /// Kind of the mode.
        pub kind: &'static str => one.plain("kind");
        /// Share of the platform in the kinetic energy.
        pub platform_energy_fraction: f64 => one;
        /// Largest part of the mode in a response, over its peak.
        pub contribution: f64 => one.shown("part in a response", "%", |of, _| percent(of.contribution));
    }
}

/// Kind of a motion that replaces the modes above the limit.
const RESIDUAL: &str = "residual";

/// Makes the state space for a robot at equilibrium. The state of the request is not used.
///
/// # Errors
/// A signal that the robot does not have, too many modes, a robot without such a model, or work that was stopped.
pub fn about(at_rest: &AtRest, request: &request::ReduceRequest, watch: &mut dyn Watch) -> Result<ControlStateSpace> {
    let signals = check(&at_rest.robot, request)?;
    let Linearised { dynamics, linearisation, warnings, damping_at, from, to } =
        linearised(at_rest, request, &signals)?;

    let tolerance = StateSpaceSize::Tolerance(request.tolerance.unwrap_or(DEFAULT_TOLERANCE));
    let size = request.order.map_or(tolerance, StateSpaceSize::Order);
    let requested = RequestedStateSpace { below_hz: request.below_hz, size, damping_at };
    let report = &mut |done| goes_on(watch, done);
    let model = control_model(&at_rest.robot, &at_rest.equilibrium, &dynamics, &from, &to, requested, report)
        .map_err(stopped_or_error)?;

    let (inputs, outputs) = (input_rows(&signals.0), output_rows(&signals.1));
    let response = |row: &ResponseOfPair| ResponseRow {
        output: outputs[row.output].name.clone(),
        input: inputs[row.input].name.clone(),
        unit: response_unit(&signals.0[row.input].0, &signals.1[row.output].0),
        coupled: row.coupled,
        peak: row.peak,
        peak_hz: row.peak_hz,
        error: row.error,
        error_hz: row.error_hz,
    };
    Ok(ControlStateSpace {
        robot: at_rest.robot.name.clone(),
        form: ModelForm::StateSpace.name(),
        below_hz: request.below_hz,
        models: Models::of(at_rest, linearisation),
        order: model.space.a.nrows(),
        error: model.error,
        damping_error: model.damping_error,
        pointwise_error: Pointwise {
            error: model.pointwise.error,
            frequency_hz: model.pointwise.frequency_hz,
            output: outputs[model.pointwise.output].name.clone(),
            input: inputs[model.pointwise.input].name.clone(),
            response_over_peak: model.pointwise.response,
        },
        complete_order: model.complete_order,
        modes_below: model.modes_below,
        damping: match damping_at {
            DampingAt::NaturalFrequencies if model.damping_error > 0.0 => {
                "of each mode as the ropes' constant damping ratios give it".to_owned()
            }
            _ => damping_in_words(model.damping_error == 0.0, damping_at),
        },
        responses: model.responses.iter().map(response).collect(),
        states: model.states.iter().map(StatesRow::of).collect(),
        a: rows(&model.space.a),
        b: rows(&model.space.b),
        c: rows(&model.space.c),
        d: rows(&model.space.d),
        inputs,
        outputs,
        matrices_file: None,
        model,
        warnings,
    })
}

impl StatesRow {
    fn of(states: &ModalStates) -> Self {
        Self {
            first: states.first,
            states: states.states,
            frequency_hz: states.frequency_hz,
            damping_ratio: states.damping_ratio,
            kind: states.kind.map_or(RESIDUAL, |kind| kind.name()),
            platform_energy_fraction: states.platform_energy_fraction,
            contribution: states.contribution,
        }
    }
}

fn rows(matrix: &DMat) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}

/// Fraction in percent, with three digits.
pub fn percent(fraction: f64) -> String {
    let value = 100.0 * fraction;
    if value >= 99.95 || value == 0.0 {
        format!("{value:.0}")
    } else {
        let digits = (2 - value.log10().floor() as i32).clamp(0, 12) as usize;
        format!("{value:.digits$}")
    }
}

found!(ControlStateSpace, "reduce");
