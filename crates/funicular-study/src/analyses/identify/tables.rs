//! Tables of measured and fitted numbers.

use super::{IdentifiedModel, Observation, Subject};
use crate::columns::column;
use crate::measurements::MeasuredResponse;
use crate::request::{self, Experiment};
use crate::rows::rows;
use funicular::math::Complex;

rows! {
    /// Measured and fitted natural frequency.
    pub struct FrequencyRow {
        pub experiment: String;
        pub label: Option<String>;
        /// Number of the mode in the ascending list, from 1.
        pub number: usize;
        pub measured_hz: f64;
        pub fitted_hz: f64;
        /// Absent if the robot has no equilibrium before the fit, or not this mode.
        pub before_hz: Option<f64>;
        pub measured_damping_ratio: Option<f64>;
        pub fitted_damping_ratio: Option<f64>;
    }
}

rows! {
    /// Measured and fitted response.
    pub struct FittedResponse {
        pub experiment: String;
        pub name: String;
        pub input: String;
        pub output: String;
        pub unit: String;
        /// Root mean square of the residuals in deviations of the noise, of the values that are not left out; 1 if the
        /// fit is perfect.
        pub residual_rms: f64;
        /// Ranges that are left out because the model misses them: first and last frequency of each [Hz].
        pub left_out_hz: Vec<[f64; 2]> = sparse;
        pub frequency_hz: Vec<f64>;
        pub measured_real: Vec<f64>;
        pub measured_imag: Vec<f64>;
        /// Empty if the robot has no equilibrium before the fit.
        pub before_real: Vec<f64> = sparse;
        pub before_imag: Vec<f64> = sparse;
        pub fitted_real: Vec<f64>;
        pub fitted_imag: Vec<f64>;
    }
}

rows! {
    /// Measured and fitted number of a state.
    pub struct StaticRow in tables() {
        /// Experiment.
        pub experiment: String => one.plain("experiment");
        /// Quantity with its unit.
        ///
        /// `x_m` … `rz_rad` (differences from the measured pose), `tension_n:NAME`, `length_m:NAME`.
        pub quantity: String => one.plain("quantity");
        /// Measured value.
        pub measured: f64 => one.unit("").significant("measured", 6);
        /// Value of the fit.
        pub fitted: f64
            => one.unit("").significant("fitted", 6)
            => column("difference", "1", "difference in deviations", Self::difference)
                .significant("difference", 3)
                .with_unit("deviations");
        pub deviation: f64;
    }
}

impl StaticRow {
    /// Difference of the fitted from the measured number in deviations.
    pub fn difference(&self) -> f64 {
        (self.fitted - self.measured) / self.deviation
    }
}

/// Tables of measured and fitted numbers.
#[derive(Default)]
pub(super) struct Tables {
    pub(super) frequencies: Vec<FrequencyRow>,
    pub(super) responses: Vec<FittedResponse>,
    pub(super) statics: Vec<StaticRow>,
}

/// Observation with its predictions.
#[derive(Clone, Copy)]
struct ComparedObservation<'a> {
    observation: &'a Observation,
    fitted: Complex,
    before: Option<Complex>,
    is_left_out: bool,
}

impl Tables {
    /// Tables of all experiments. `assigned` are the modes of the measured frequencies per experiment; `fitted` and
    /// `before` are predictions in the order of the observations, `before` if they exist.
    pub(super) fn of(
        model: &IdentifiedModel<'_>,
        experiments: &[Experiment],
        assigned: &[Vec<usize>],
        fitted: &[Complex],
        before: Option<&[Complex]>,
    ) -> Self {
        let compared: Vec<ComparedObservation<'_>> = (model.observations.iter().enumerate())
            .map(|(i, observation)| ComparedObservation {
                observation,
                fitted: fitted[i],
                before: before.map(|before| before[i]),
                is_left_out: model.left_out[i],
            })
            .collect();

        let mut tables = Self::default();
        for (number, ((experiment, name), assigned)) in experiments.iter().zip(model.names()).zip(assigned).enumerate()
        {
            let own = || compared.iter().filter(|of| of.observation.experiment == number);
            let cables: Vec<String> = match &experiment.cables {
                Some(cables) => cables.clone(),
                None => model.parameters.robot().cables.iter().map(|cable| cable.name.clone()).collect(),
            };
            tables.statics.extend(own().filter_map(|compared| static_row(compared, name, &cables)));

            let frequencies = own().filter_map(|compared| frequency_row(compared, experiment, name, assigned));
            let mut frequencies: Vec<FrequencyRow> = frequencies.collect();
            for compared in own() {
                if let Subject::Damping(k) = compared.observation.subject {
                    frequencies[k].fitted_damping_ratio = Some(compared.fitted.re);
                }
            }
            tables.frequencies.extend(frequencies);

            for (k, response) in experiment.responses.iter().enumerate() {
                let lines = own()
                    .filter(|of| matches!(of.observation.subject, Subject::Response { response, .. } if response == k));
                tables.responses.push(fitted_response(response, name, lines));
            }
        }
        tables
    }

    /// Root mean square of the relative differences of all natural frequencies from the measured ones, for one of their
    /// values; `None` without frequencies or without one of the values.
    pub(super) fn frequency_rms(&self, value: fn(&FrequencyRow) -> Option<f64>) -> Option<f64> {
        let squares = self.frequencies.iter().map(|row| Some((value(row)? / row.measured_hz - 1.0).powi(2)));
        let sum = squares.sum::<Option<f64>>()?;
        (!self.frequencies.is_empty()).then(|| (sum / self.frequencies.len() as f64).sqrt())
    }
}

/// Row of a number of the equilibrium; `None` for another quantity.
fn static_row(compared: &ComparedObservation<'_>, experiment: &str, cables: &[String]) -> Option<StaticRow> {
    const POSE: [&str; 6] = ["x_m", "y_m", "z_m", "rx_rad", "ry_rad", "rz_rad"];
    let quantity = match compared.observation.subject {
        Subject::Pose(k) => POSE[k].to_owned(),
        Subject::Tension(i) => format!("tension_n:{}", cables[i]),
        Subject::Length(i) => format!("length_m:{}", cables[i]),
        _ => return None,
    };
    Some(StaticRow {
        experiment: experiment.to_owned(),
        quantity,
        measured: compared.observation.measured.re,
        fitted: compared.fitted.re,
        deviation: compared.observation.deviation,
    })
}

/// Row of a natural frequency, without its damping ratio; `None` for another quantity.
fn frequency_row(
    compared: &ComparedObservation<'_>,
    experiment: &Experiment,
    name: &str,
    assigned: &[usize],
) -> Option<FrequencyRow> {
    let Subject::Frequency(k) = compared.observation.subject else { return None };
    let measured = &experiment.frequencies[k];
    Some(FrequencyRow {
        experiment: name.to_owned(),
        label: measured.label.clone(),
        number: assigned[k] + 1,
        measured_hz: measured.frequency_hz,
        fitted_hz: compared.fitted.re,
        before_hz: compared.before.map(|before| before.re),
        measured_damping_ratio: measured.damping_ratio,
        fitted_damping_ratio: None,
    })
}

/// Row of a response from its values, one per frequency.
fn fitted_response<'a>(
    response: &MeasuredResponse,
    experiment: &str,
    lines: impl Iterator<Item = &'a ComparedObservation<'a>>,
) -> FittedResponse {
    let mut row = FittedResponse {
        experiment: experiment.to_owned(),
        name: response.name.clone(),
        input: response.input.clone(),
        output: response.output.clone(),
        unit: unit(&response.input, &response.output),
        residual_rms: 0.0,
        left_out_hz: Vec::new(),
        frequency_hz: response.frequency_hz.clone(),
        measured_real: response.real.clone(),
        measured_imag: response.imag.clone(),
        before_real: Vec::new(),
        before_imag: Vec::new(),
        fitted_real: Vec::new(),
        fitted_imag: Vec::new(),
    };

    let (mut squares, mut kept, mut is_open) = (0.0, 0_usize, false);
    for (hz, ComparedObservation { observation, fitted, before, is_left_out }) in
        response.frequency_hz.iter().zip(lines)
    {
        match (*is_left_out, is_open, row.left_out_hz.last_mut()) {
            (true, true, Some(range)) => range[1] = *hz,
            (true, ..) => row.left_out_hz.push([*hz, *hz]),
            (false, ..) => {
                squares += ((fitted - observation.measured) / observation.deviation).norm_sqr();
                kept += 1;
            }
        }
        is_open = *is_left_out;
        row.before_real.extend(before.map(|before| before.re));
        row.before_imag.extend(before.map(|before| before.im));
        row.fitted_real.push(fitted.re);
        row.fitted_imag.push(fitted.im);
    }
    row.residual_rms = (squares / kept.max(1) as f64).sqrt();
    row
}

/// Unit of a response whose signals were checked.
fn unit(input: &str, output: &str) -> String {
    match (request::input(input), request::output(output)) {
        (Ok(input), Ok(output)) => crate::signals::response_unit(&input, &output),
        _ => String::new(),
    }
}
