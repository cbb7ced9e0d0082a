//! Sentences that a user should know before trusting a fit.

use super::IdentifiedModel;
use super::ValueRow;
use super::tables::FittedResponse;
use crate::request::{Experiment, IdentifyRequest};
use crate::text::{counted, significant};
use funicular::warnings::plausibility::usual::DAMPING_RATIO;

/// Maximum fraction of the values of responses that may be far outside of the deviations without a warning.
const MAX_OUTLIERS: f64 = 0.01;

/// Number of measured damping ratios that a sentence names.
const NAMED: usize = 3;

/// Relative difference up to which the value at the minimum of a profile is the identified one.
const SAME_VALUE: f64 = 1e-6;

/// Sentence on measured damping ratios that may be in per cent; `None` if all are usual. The weakest usual one of a
/// rope, 0.05 %, is the usual maximum if it is given in per cent.
pub(super) fn damping_in_per_cent(request: &IdentifyRequest) -> Option<String> {
    let frequencies = request.experiments.iter().flat_map(|experiment| &experiment.frequencies);
    let large: Vec<(f64, f64)> = frequencies
        .filter_map(|frequency| Some((frequency.damping_ratio?, frequency.frequency_hz)))
        .filter(|(damping, _)| *damping > DAMPING_RATIO[1])
        .collect();
    let (first, _) = large.first()?;
    let named: Vec<String> =
        large.iter().take(NAMED).map(|(damping, hz)| format!("{damping} at {} Hz", significant(*hz, 4))).collect();
    let more = if large.len() > NAMED { format!(" and {} more", large.len() - NAMED) } else { String::new() };
    Some(format!(
        "measured damping ratios are above {}, the usual maximum of ropes: {}{more}. Were they measured in per cent? \
         Then divide `damping_ratio` of the measurements by 100: {first} % is {}",
        DAMPING_RATIO[1],
        named.join(", "),
        significant(first / 100.0, 3)
    ))
}

/// Sentence on a value at one of its bounds; `None` for a value between them.
pub(super) fn value_at_bound(row: &ValueRow) -> Option<String> {
    let (bound, value) = (row.at_bound?, significant(row.value, 6));
    Some(format!(
        "{} is at its {bound} {value}: the best fit lies outside the bound; its deviation is not valid",
        row.path
    ))
}

/// χ²/n beyond which no error of a model or of a deviation is the reason: the differences are ten times as large as the
/// deviations.
const UNEXPLAINED: f64 = 100.0;

/// Sentence on a χ² per degree of freedom that is so large that the values mean nothing; `None` if it is not.
pub(super) fn unexplained(chi2_per_degree: f64) -> Option<String> {
    (chi2_per_degree > UNEXPLAINED).then(|| {
        format!(
            "χ²/n = {} is above {UNEXPLAINED}: the model does not explain the measurements, and the values mean \
             nothing. Check units, signs and directions of the measurements first; then points, lengths and the state; \
             then whether another start arrives",
            significant(chi2_per_degree, 3)
        )
    })
}

/// Sentence on a value that moves with others that are poorly determined; `None` for a value that does not.
pub(super) fn moves(row: &ValueRow) -> Option<String> {
    let (with, path) = (row.moves_with.join(", "), &row.path);
    (!row.moves_with.is_empty()).then(|| {
        format!(
            "{path} moves with {with}, which the measurements determine poorly: its deviation would hold with {with} \
             held, and its interval is that of its profile; give a prior, hold one of the values, or measure more"
        )
    })
}

/// Sentence on a profile that falls below the minimum; `None` if it does not. `factor` is the factor of the deviations.
pub(super) fn missed_minimum(row: &ValueRow, chi2: f64, factor: f64) -> Option<String> {
    let profile = row.profile.as_ref().filter(|profile| profile.falls)?;
    let lowest = profile.points.iter().min_by(|a, b| a.chi2_rise.total_cmp(&b.chi2_rise))?;
    // Measurements without noise determine the value to more digits than the search finds.
    if (lowest.value - row.value).abs() <= SAME_VALUE * row.value.abs() {
        return None;
    }
    Some(format!(
        "the search has missed the best values: with {0} = {1} the measurements fit better, χ² = {2}; give ⟪set⟫ \
         {0}={1} and identify again",
        row.path,
        significant(lowest.value, 6),
        significant(chi2 + factor * factor * lowest.chi2_rise, 5)
    ))
}

/// Sentence on the values of responses that lost weight; `None` if they are few.
pub(super) fn outliers(model: &IdentifiedModel<'_>, request: &IdentifyRequest) -> Option<String> {
    let responses =
        model.observations.iter().zip(model.weights()).filter(|(observation, _)| observation.subject.is_response());
    let frequencies =
        request.experiments.iter().flat_map(|experiment| &experiment.responses).flat_map(|r| &r.frequency_hz);
    let mut outside: Vec<f64> = (responses.zip(frequencies))
        .filter(|((_, weight), _)| **weight > 0.0 && **weight < 1.0)
        .map(|(_, hz)| *hz)
        .collect();
    let total = model.observations.iter().filter(|observation| observation.subject.is_response()).count();
    if (outside.len() as f64) < MAX_OUTLIERS * total as f64 || outside.len() < 2 {
        return None;
    }

    outside.sort_by(f64::total_cmp);
    let at = |part: f64| significant(outside[((outside.len() - 1) as f64 * part).round() as usize], 4);
    Some(format!(
        "{} of {total} values of responses are far outside of the deviations, and get less weight; 90 % of them are \
         between {} and {} Hz: the model is not right there, or the measurement is disturbed; ⟪from_hz⟫ and ⟪to_hz⟫ \
         leave a range out",
        outside.len(),
        at(0.05),
        at(0.95)
    ))
}

/// Sentence on the ranges of responses that are left out; `None` if there are none.
pub(super) fn left_out(model: &IdentifiedModel<'_>, responses: &[FittedResponse]) -> Option<String> {
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
            "the model misses ranges of responses by more than the noise, and their {} are left out: {}. Find the \
             reason: a part that the model does not have, a disturbed measurement, or another robot; ⟪from_hz⟫ and \
             ⟪to_hz⟫ leave a range out of all responses",
            counted(count, "value"),
            ranges.join(", ")
        )
    })
}

/// True if every measurement has its own deviation.
pub(super) fn is_noise_given(request: &IdentifyRequest) -> bool {
    request.experiments.iter().all(|experiment| {
        let Experiment { responses, frequencies, .. } = experiment;
        let statics = [
            (experiment.measured_pose.is_some(), experiment.position_std_m.and(experiment.rotation_std_deg)),
            (experiment.measured_tensions_n.is_some(), experiment.tension_std_n),
            (experiment.measured_lengths_m.is_some(), experiment.length_std_m),
        ];
        responses.iter().all(|response| response.std.is_some())
            && frequencies
                .iter()
                .all(|of| of.std_hz.is_some() && of.damping_ratio.is_some() == of.damping_std.is_some())
            && statics.iter().all(|(is_measured, deviation)| !is_measured || deviation.is_some())
    })
}
