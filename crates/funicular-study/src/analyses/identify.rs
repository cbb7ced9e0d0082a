//! `identify`: values of the robot file that fit measurements best, with their deviations.

use super::found;
use super::gradient::Pattern;
use crate::Watch;
use crate::identification::{
    IdentifiedModel, Kind, LIMIT as NORMAL_95, StartRow, Unknown, judge, profiles, search, unknowns, unresolved_peaks,
};
pub use crate::identification::{OpenEnd, Profile};
use crate::request::{self, Experiment, IdentifyRequest};
use crate::text::{counted, significant};
use anyhow::{Result, bail};
use funicular::math::Complex;
use funicular::math::least_squares::Ending;
use funicular::robot::parameters::Parameters;
use serde::Serialize;
use std::cell::RefCell;

/// Fraction of the values of responses that may be far outside of the deviations without a warning.
const MAX_OUTLIERS: f64 = 0.01;

/// Maximum number of starts.
const MAX_STARTS: usize = 1000;

/// Results of `identify`.
#[derive(Serialize)]
pub struct Identified {
    #[serde(skip)]
    pub robot: String,
    pub values: Vec<ValueRow>,
    /// Sum of the squares of all residuals, those of priors included.
    pub chi2: f64,
    pub residuals: usize,
    pub degrees_of_freedom: usize,
    pub chi2_per_degree: f64,
    /// Factor by which the deviations of the values were multiplied.
    pub deviation_factor: f64,
    pub verdict: String,
    pub correlations: Vec<Vec<f64>>,
    pub singular_values: Vec<f64>,
    /// Combinations of values that the measurements do not determine.
    pub weak_combinations: Vec<String>,
    pub strong_correlations: Vec<String>,
    /// True if the last search has ended at a minimum.
    pub converged: bool,
    pub starts: Vec<StartRow>,
    pub evaluations: usize,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub frequencies: Vec<FrequencyRow>,
    /// Root mean square of the relative differences of all natural frequencies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frequency_rms: Option<f64>,
    /// Root mean square before the fit, with the same modes as partners.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frequency_rms_before: Option<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub responses: Vec<FittedResponse>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub statics: Vec<StaticRow>,
    /// Robot file with the values.
    pub robot_file: String,
    #[serde(skip)]
    pub warnings: Vec<String>,
}

/// Identified value.
#[derive(Serialize)]
pub struct ValueRow {
    pub path: String,
    pub unit: &'static str,
    pub start: f64,
    pub value: f64,
    /// Standard deviation; absent for a value that the measurements do not determine.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deviation: Option<f64>,
    /// Interval that holds the value with 95 %.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interval_95: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub prior: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub prior_deviation: Option<f64>,
    /// `minimum` or `maximum` if the value is at this bound.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_bound: Option<&'static str>,
    /// Profile of χ², if it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub profile: Option<Profile>,
}

/// Measured and fitted natural frequency.
#[derive(Serialize)]
pub struct FrequencyRow {
    pub experiment: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
    /// Number of the mode in the ascending list, from 1.
    pub number: usize,
    pub measured_hz: f64,
    pub fitted_hz: f64,
    pub before_hz: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured_damping_ratio: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fitted_damping_ratio: Option<f64>,
}

/// Measured and fitted response.
#[derive(Serialize)]
pub struct FittedResponse {
    pub experiment: String,
    pub name: String,
    pub input: String,
    pub output: String,
    pub unit: String,
    /// Root mean square of the residuals in deviations of the noise, of the values that are not left out; 1 if the fit is
    /// perfect.
    pub residual_rms: f64,
    /// Ranges that are left out because the model misses them: first and last frequency of each [Hz].
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub left_out_hz: Vec<[f64; 2]>,
    pub frequency_hz: Vec<f64>,
    pub measured_real: Vec<f64>,
    pub measured_imag: Vec<f64>,
    pub before_real: Vec<f64>,
    pub before_imag: Vec<f64>,
    pub fitted_real: Vec<f64>,
    pub fitted_imag: Vec<f64>,
}

/// Measured and fitted number of a state.
#[derive(Serialize)]
pub struct StaticRow {
    pub experiment: String,
    /// `x_m` … `rz_deg` (differences from the measured pose), `tension_n:NAME`, `length_m:NAME`.
    pub quantity: String,
    pub measured: f64,
    pub fitted: f64,
    pub deviation: f64,
}

/// Identifies values of a robot file.
///
/// # Errors
/// A request that contradicts itself or the robot, no start at which the robot has an equilibrium, or work that was
/// stopped.
pub fn run(request: &IdentifyRequest, watch: &mut dyn Watch) -> Result<Identified> {
    check(request)?;
    let request = &within_range(request)?;
    let file = request.robot.read()?;
    let parameters = Parameters::from_toml(&file.text)?;
    let unknowns = unknowns(&parameters, &request.fit)?;
    let profiled = profiled(&parameters, &unknowns, &request.profile)?;

    let watch = RefCell::new(watch);
    let is_cancelled = || watch.borrow().is_cancelled();
    let mut model = IdentifiedModel::new(&parameters, &unknowns, request, &is_cancelled)?;
    let nominal: Vec<f64> = unknowns.iter().map(|unknown| unknown.coordinate(unknown.start)).collect();
    let before = model.predict(&nominal, None).ok();
    let progress = |done: usize, total: usize| watch.borrow_mut().progress(done, total, "starts");
    let searched = search(&mut model, request.starts, &progress)?;
    let best = &searched.best;

    let judged = judge(&model, best, is_noise_given(request));
    let values = model.values(&best.x);
    let mut warnings: Vec<String> = outliers(&model, request).into_iter().collect();
    for (number, experiment) in request.experiments.iter().enumerate() {
        let name = model.names().nth(number).unwrap_or_default().to_owned();
        warnings.extend(unresolved_peaks(&model, &best.x, number, experiment)?.map(|text| format!("{name}: {text}")));
    }
    let mut rows: Vec<ValueRow> = (unknowns.iter().zip(&values).zip(&judged.deviations))
        .map(|((unknown, value), deviation)| value_row(unknown, *value, *deviation))
        .collect();
    for row in &rows {
        if let Some(bound) = row.at_bound {
            warnings.push(format!(
                "{} is at its {bound} {}: the measurements would have it beyond, and its deviation does not hold",
                row.path,
                significant(row.value, 6)
            ));
        }
    }
    let converged = best.ending == Ending::Converged;
    if !converged {
        warnings.push(format!("the search has not ended after {}", counted(best.iterations, "iteration")));
    }
    warnings.extend(judged.weak.iter().cloned());
    if !profiled.is_empty() {
        let progress = |done: usize, total: usize| watch.borrow_mut().progress(done, total, "fits of profiles");
        let found = profiles(&mut model, best, &profiled, &judged.deviations, judged.factor, &progress)?;
        for (&number, profile) in profiled.iter().zip(found) {
            let row = &mut rows[number];
            warnings.extend(lower(row, &profile, best.chi2(), judged.factor));
            row.profile = Some(profile);
        }
    }

    let fitted = model.predict(&best.x, None)?;
    let before = match before {
        Some(_) => model.predict(&nominal, Some(&fitted.assigned)).ok(),
        None => None,
    };
    let before = before.map_or_else(|| fitted.values.clone(), |before| before.values);
    let names: Vec<String> = model.names().map(str::to_owned).collect();
    let mut tables = Tables::default();
    let mut at = 0;
    for ((experiment, name), assigned) in request.experiments.iter().zip(&names).zip(&fitted.assigned) {
        tables.add(&model, experiment, name, assigned, [&fitted.values, &before], &mut at);
    }
    warnings.splice(0..0, left_out(&model, &tables.responses));
    let rms = |value: fn(&FrequencyRow) -> f64| {
        let squares = tables.frequencies.iter().map(|row| (value(row) / row.measured_hz - 1.0).powi(2));
        (!tables.frequencies.is_empty()).then(|| (squares.sum::<f64>() / tables.frequencies.len() as f64).sqrt())
    };

    Ok(Identified {
        robot: parameters.robot().name.clone(),
        values: rows,
        chi2: best.chi2(),
        residuals: best.residuals.len(),
        degrees_of_freedom: judged.degrees,
        chi2_per_degree: judged.chi2_per_degree,
        deviation_factor: judged.factor,
        verdict: judged.verdict,
        correlations: judged.correlations,
        singular_values: judged.singular_values,
        weak_combinations: judged.weak,
        strong_correlations: judged.strong,
        converged,
        starts: searched.starts,
        evaluations: model.evaluations,
        frequency_rms: rms(|row| row.fitted_hz),
        frequency_rms_before: rms(|row| row.before_hz),
        frequencies: tables.frequencies,
        responses: tables.responses,
        statics: tables.statics,
        robot_file: model.text(&best.x)?,
        warnings,
    })
}

/// Checks the numbers of a request.
fn check(request: &IdentifyRequest) -> Result<()> {
    if !(1..=MAX_STARTS).contains(&request.starts) {
        bail!("⟪starts⟫: {} starts are not possible: give a whole number from 1 to {MAX_STARTS}", request.starts);
    }
    request::check_positive("response_noise", request.response_noise)?;
    request::check_positive("frequency_noise", request.frequency_noise)?;
    request::check_positive("damping_noise", request.damping_noise)
}

/// Numbers of the unknowns at the paths of profiles, in the order of the fit.
fn profiled(parameters: &Parameters, unknowns: &[Unknown], paths: &[String]) -> Result<Vec<usize>> {
    let mut chosen = vec![false; unknowns.len()];
    for path in paths {
        let pattern = Pattern::parse("profile", path)?;
        let mut is_met = false;
        for (unknown, chosen) in unknowns.iter().zip(&mut chosen) {
            if pattern.matches(&parameters.list()[unknown.index].keys) {
                (*chosen, is_met) = (true, true);
            }
        }
        if !is_met {
            let all: Vec<String> = unknowns.iter().map(|unknown| unknown.path.clone()).collect();
            let near = crate::names::suggestion(path, &all);
            bail!("⟪profile⟫ {path}: no fitted value has this path{near}");
        }
    }
    Ok((0..unknowns.len()).filter(|&k| chosen[k]).collect())
}

/// Sentence on a profile that falls below the minimum; `None` if it does not.
fn lower(row: &ValueRow, profile: &Profile, chi2: f64, factor: f64) -> Option<String> {
    let lowest = profile.points.iter().min_by(|a, b| a.chi2_rise.total_cmp(&b.chi2_rise)).filter(|_| profile.falls)?;
    // Measurements without noise hold the value to more digits than the search: there is nothing to say.
    let same = 1e-6 * row.value.abs();
    if (lowest.value - row.value).abs() <= same {
        return None;
    }
    Some(format!(
        "the search has missed the best values: with {0} = {1} the measurements fit better, χ² = {2}; give ⟪set⟫ {0}={1} and identify again",
        row.path,
        significant(lowest.value, 6),
        significant(chi2 + factor * factor * lowest.chi2_rise, 5)
    ))
}

/// Request with the frequencies of responses that count.
fn within_range(request: &IdentifyRequest) -> Result<IdentifyRequest> {
    let mut request = request.clone();
    let (from, to) = (request.from_hz.unwrap_or(0.0), request.to_hz.unwrap_or(f64::INFINITY));
    if from >= to {
        bail!("⟪from_hz⟫ {from} Hz is not below ⟪to_hz⟫ {to} Hz");
    }
    // A frequency that is not possible is refused later, and not left out.
    let counts_or_wrong = |hz: &f64| (from..=to).contains(hz) || !(hz.is_finite() && *hz >= 0.0);
    for response in request.experiments.iter_mut().flat_map(|experiment| &mut experiment.responses) {
        let counts: Vec<bool> = response.frequency_hz.iter().map(counts_or_wrong).collect();
        let keep = |values: &mut Vec<f64>| {
            // Lists of other lengths are refused later.
            if values.len() == counts.len() {
                let mut counts = counts.iter();
                values.retain(|_| counts.next().copied().unwrap_or(true));
            }
        };
        keep(&mut response.real);
        keep(&mut response.imag);
        response.std.iter_mut().for_each(keep);
        keep(&mut response.frequency_hz);
        if response.frequency_hz.is_empty() && !counts.is_empty() {
            bail!("no frequency of a response is between ⟪from_hz⟫ and ⟪to_hz⟫");
        }
    }
    Ok(request)
}

/// Sentence on the values of responses that lost weight; `None` if they are few.
fn outliers(model: &IdentifiedModel<'_>, request: &IdentifyRequest) -> Option<String> {
    let responses = model.observations.iter().zip(model.weights()).filter(|(o, _)| o.kind == Kind::Response);
    let frequencies =
        request.experiments.iter().flat_map(|experiment| &experiment.responses).flat_map(|r| &r.frequency_hz);
    let mut outside: Vec<f64> = (responses.zip(frequencies))
        .filter(|((_, weight), _)| **weight > 0.0 && **weight < 1.0)
        .map(|(_, hz)| *hz)
        .collect();
    let total = model.observations.iter().filter(|observation| observation.kind == Kind::Response).count();
    if (outside.len() as f64) < MAX_OUTLIERS * total as f64 || outside.len() < 2 {
        return None;
    }
    outside.sort_by(f64::total_cmp);
    let at = |part: f64| significant(outside[((outside.len() - 1) as f64 * part).round() as usize], 4);
    Some(format!(
        "{} of {total} values of responses are far outside of the deviations, and count less; nine in ten of them are \
         between {} and {} Hz: the model does not hold there, or the measurement is disturbed; ⟪from_hz⟫ and ⟪to_hz⟫ leave \
         a range out",
        outside.len(),
        at(0.05),
        at(0.95)
    ))
}

/// Sentence on the ranges of responses that are left out; `None` if there are none.
fn left_out(model: &IdentifiedModel<'_>, responses: &[FittedResponse]) -> Option<String> {
    let count = model.left_out.iter().filter(|left_out| **left_out).count();
    let ranges: Vec<String> = (responses.iter())
        .filter_map(|response| {
            let (first, last) = (response.left_out_hz.first()?, response.left_out_hz.last()?);
            let name = if response.name.is_empty() {
                format!("{}/{}", response.output, response.input)
            } else {
                response.name.clone()
            };
            let parts = match response.left_out_hz.len() {
                1 => String::new(),
                parts => format!(" in {parts} parts"),
            };
            Some(format!("{name} from {} to {} Hz{parts}", significant(first[0], 4), significant(last[1], 4)))
        })
        .collect();
    (!ranges.is_empty()).then(|| {
        format!(
            "the model misses ranges of responses by more than the noise, and their {} are left out: {}. Find the reason: a \
             part that the model does not have, a disturbed measurement, or another robot; ⟪from_hz⟫ and ⟪to_hz⟫ leave a \
             range out of all responses",
            counted(count, "value"),
            ranges.join(", ")
        )
    })
}

/// True if every measurement has its own deviation.
fn is_noise_given(request: &IdentifyRequest) -> bool {
    request.experiments.iter().all(|experiment| {
        let Experiment { responses, frequencies, .. } = experiment;
        let statics = [
            (experiment.measured_pose.is_some(), experiment.position_std_m.and(experiment.rotation_std_deg)),
            (experiment.measured_tensions_n.is_some(), experiment.tension_std_n),
            (experiment.measured_lengths_m.is_some(), experiment.length_std_m),
        ];
        responses.iter().all(|response| response.std.is_some())
            && frequencies.iter().all(|frequency| frequency.std_hz.is_some() && frequency.damping_ratio.is_none())
            && statics.iter().all(|(is_measured, deviation)| !is_measured || deviation.is_some())
    })
}

fn value_row(unknown: &Unknown, value: f64, deviation: Option<f64>) -> ValueRow {
    let x = unknown.coordinate(value);
    let interval = |deviation: f64| [-1.0, 1.0].map(|side| unknown.value(x + side * NORMAL_95 * deviation));
    let (low, high) = unknown.bounds;
    // A bound is reached exactly.
    let at_bound = match value {
        value if value <= low => Some("minimum"),
        value if value >= high => Some("maximum"),
        _ => None,
    };
    ValueRow {
        path: unknown.path.clone(),
        unit: unknown.unit,
        start: unknown.start,
        value,
        deviation: deviation.map(|deviation| deviation * unknown.rate(value)),
        interval_95: deviation.map(interval),
        prior: unknown.prior.map(|prior| prior.0),
        prior_deviation: unknown.prior.map(|prior| prior.1),
        at_bound,
        profile: None,
    }
}

/// Tables of measured and fitted numbers.
#[derive(Default)]
struct Tables {
    frequencies: Vec<FrequencyRow>,
    responses: Vec<FittedResponse>,
    statics: Vec<StaticRow>,
}

impl Tables {
    /// Adds an experiment, whose observations begin at `at`.
    fn add(
        &mut self,
        model: &IdentifiedModel<'_>,
        experiment: &Experiment,
        name: &str,
        assigned: &[usize],
        [fitted, before]: [&[Complex]; 2],
        at: &mut usize,
    ) {
        let mut next = || {
            *at += 1;
            let number = *at - 1;
            (&model.observations[number], fitted[number], before[number], model.left_out[number])
        };
        // Numbers of the state.
        let mut quantities: Vec<String> = Vec::new();
        if experiment.measured_pose.is_some() {
            quantities.extend(["x_m", "y_m", "z_m", "rx_rad", "ry_rad", "rz_rad"].map(str::to_owned));
        }
        let cables: Vec<String> = match &experiment.cables {
            Some(cables) => cables.clone(),
            None => model.parameters.robot().cables.iter().map(|cable| cable.name.clone()).collect(),
        };
        for (is_measured, quantity) in [
            (experiment.measured_tensions_n.is_some(), "tension_n"),
            (experiment.measured_lengths_m.is_some(), "length_m"),
        ] {
            quantities.extend(cables.iter().filter(|_| is_measured).map(|cable| format!("{quantity}:{cable}")));
        }
        for quantity in quantities {
            let (observation, fitted, ..) = next();
            self.statics.push(StaticRow {
                experiment: name.to_owned(),
                quantity,
                measured: observation.measured.re,
                fitted: fitted.re,
                deviation: observation.deviation,
            });
        }

        // Natural frequencies.
        let first = self.frequencies.len();
        for (frequency, number) in experiment.frequencies.iter().zip(assigned) {
            let (_, fitted, before, _) = next();
            self.frequencies.push(FrequencyRow {
                experiment: name.to_owned(),
                label: frequency.label.clone(),
                number: number + 1,
                measured_hz: frequency.frequency_hz,
                fitted_hz: fitted.re,
                before_hz: before.re,
                measured_damping_ratio: frequency.damping_ratio,
                fitted_damping_ratio: None,
            });
        }
        for row in self.frequencies[first..].iter_mut().filter(|row| row.measured_damping_ratio.is_some()) {
            row.fitted_damping_ratio = Some(next().1.re);
        }

        // Responses.
        for response in &experiment.responses {
            let mut row = FittedResponse {
                experiment: name.to_owned(),
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
            for hz in &response.frequency_hz {
                let (observation, fitted, before, left_out) = next();
                match (left_out, is_open, row.left_out_hz.last_mut()) {
                    (true, true, Some(range)) => range[1] = *hz,
                    (true, ..) => row.left_out_hz.push([*hz, *hz]),
                    (false, ..) => {
                        squares += ((fitted - observation.measured) / observation.deviation).norm_sqr();
                        kept += 1;
                    }
                }
                is_open = left_out;
                row.before_real.push(before.re);
                row.before_imag.push(before.im);
                row.fitted_real.push(fitted.re);
                row.fitted_imag.push(fitted.im);
            }
            row.residual_rms = (squares / kept.max(1) as f64).sqrt();
            self.responses.push(row);
        }
    }
}

/// Unit of a response whose signals were checked.
fn unit(input: &str, output: &str) -> String {
    match (request::input(input), request::output(output)) {
        (Ok(input), Ok(output)) => crate::signals::response_unit(&input, &output),
        _ => String::new(),
    }
}

found!(Identified, "identify");
