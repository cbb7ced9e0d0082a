//! Proposed measurements: the poses, payloads and kinds that reduce the deviations of the values most (96k).

use super::experiment::mounted;
use super::model::IdentifiedModel;
use super::unknowns::Unknown;
use crate::Watch;
use crate::analyses::fields;
use crate::at_rest;
use crate::error::Cancelled;
use crate::measurements::MeasuredFrequency;
use crate::names::suggestion;
use crate::request::{self, Experiment, IdentifyRequest, State};
use crate::rows::rows;
use crate::text::significant;
use anyhow::{Result, bail};
use funicular::math::chosen_rows::{ChosenRows, choose_rows};
use funicular::math::least_squares::{LeastSquaresProblem, Minimum, precision};
use funicular::math::{DMat, rotation};
use funicular::robot::Pose;
use std::cell::RefCell;

/// Maximum number of candidates: each is computed with its derivatives, which takes about as long as one step of the
/// fit.
const MAX_CANDIDATES: usize = 2000;

/// Largest number of proposed measurements while a wanted deviation is looked for.
const MAX_PROPOSALS: usize = 100;

/// Frequency with which the search of a list of modes begins [Hz]; it goes on until the list is long enough.
const FIRST_HZ: f64 = 1.0;

/// Singular value of a direction, relative to the largest one, up to which the measurements do not see it.
const UNSEEN: f64 = 1e-6;

/// Kinds of measurements.
const KINDS: [&str; 4] = ["frequencies", "tensions", "lengths", "pose"];

rows! {
    /// Measurement to make next.
    pub struct ProposedMeasurement in tables(rows: &[Self]) with {
        let has_payloads = rows.iter().any(|row| row.payload_kg.is_some());
    } rows {
        /// Number of proposed measurements up to this one.
        pub number: usize => one.plain("next");
        /// Position of the platform origin, {}.
        pub position_m: [f64; 3] => each(fields::AXES, "{}_m").components("position", 4);
        /// Roll, pitch, yaw of the platform.
        pub roll_pitch_yaw_deg: [f64; 3] => each(fields::ANGLES, "{}_deg", "{} of the platform")
            .components("roll, pitch, yaw", 3);
        /// Payload that the platform carries there.
        ///
        /// Absent unless payloads are candidates.
        pub payload_kg: Option<f64> => one.significant("payload", 4).only_if(has_payloads);
        /// Measured quantity: `frequencies`, `tensions`, `lengths` or `pose`.
        pub measured: String => one.about("what is measured there").plain("measured");
        /// Natural frequencies of the identified robot there, if they are measured.
        pub frequency_hz: Vec<f64> = sparse;
        /// Standard deviations of all values after this measurement and those before it, in their order.
        pub deviations: Vec<f64>;
        /// Largest relative deviation of a chosen value then.
        ///
        /// Largest of these relative to its value, of the chosen positive values.
        pub largest_percent: Option<f64> => one.significant("largest ±", 3);
        /// Value with the largest relative deviation.
        pub largest_of: Option<String> => one.plain("of");
    }
}

/// Candidate: what is measured at a pose with a payload.
struct Candidate {
    place: CandidatePlace,
    frequency_hz: Vec<f64>,
    /// Derivatives of its residuals; `None` if the robot cannot be measured there.
    rows: Option<DMat>,
}

/// Pose, payload and kind of measurement of a candidate.
#[derive(Clone, Copy)]
struct CandidatePlace {
    pose: Pose,
    /// Payload [kg]; `None` for that of the first experiment.
    payload_kg: Option<f64>,
    kind: &'static str,
}

/// Checks the options of a proposal.
///
/// # Errors
/// A kind that does not exist, or a deviation that is not positive.
pub(super) fn check(request: &IdentifyRequest) -> Result<()> {
    request::check("wanted_percent", request.wanted_percent, crate::values::positive)?;
    let payloads = request.propose_payloads_kg.as_deref();
    if payloads.is_some() && !is_wanted(request) {
        bail!("⟪propose_payloads_kg⟫ are payloads of a proposal: give ⟪propose⟫ or ⟪wanted_percent⟫");
    }
    let replaced = request.experiments.first().is_some_and(|first| first.state.mass_kg.is_some());
    if payloads.is_some() && replaced {
        bail!("⟪mass_kg⟫ is the mass of platform and payload together: leave out it or ⟪propose_payloads_kg⟫");
    }
    for payload in payloads.unwrap_or_default() {
        request::check("propose_payloads_kg", Some(*payload), crate::values::not_negative)?;
    }
    let known = KINDS.map(str::to_owned);
    if let Some(unknown) = request.propose_measuring.iter().find(|kind| !known.contains(kind)) {
        bail!("⟪propose_measuring⟫: there is no `{unknown}`{}", suggestion(unknown, &known));
    }
    Ok(())
}

/// True if a proposal is wanted.
pub(super) fn is_wanted(request: &IdentifyRequest) -> bool {
    request.propose > 0 || request.wanted_percent.is_some()
}

/// Proposed measurements, and the number of them that reaches the wanted deviation. `chosen` marks the values whose
/// deviations count.
///
/// # Errors
/// Too many candidates, or work that was stopped.
pub(super) fn proposals(
    model: &IdentifiedModel<'_>,
    request: &IdentifyRequest,
    (best, factor): (&Minimum, f64),
    poses: &[Pose],
    chosen: &[bool],
    watch: &RefCell<&mut dyn Watch>,
) -> Result<(Vec<ProposedMeasurement>, Option<usize>)> {
    let kinds: Vec<&'static str> =
        KINDS.into_iter().filter(|kind| request.propose_measuring.iter().any(|wanted| wanted == kind)).collect();
    let payloads =
        request.propose_payloads_kg.as_ref().map_or(vec![None], |all| all.iter().copied().map(Some).collect());
    let total = poses.len() * payloads.len() * kinds.len();
    if total > MAX_CANDIDATES {
        bail!(
            "⟪grid⟫: {total} measurements are candidates: give at most {MAX_CANDIDATES} poses times payloads times \
             kinds"
        );
    }
    let places = poses.iter().flat_map(|pose| {
        let of_pose = payloads.iter().flat_map(|payload| kinds.iter().map(move |kind| (*payload, *kind)));
        of_pose.map(|(payload_kg, kind)| CandidatePlace { pose: *pose, payload_kg, kind })
    });
    let mut candidates = Vec::with_capacity(total);
    for place in places {
        watch.borrow_mut().progress(candidates.len(), total, "candidates");
        if watch.borrow().is_cancelled() {
            return Err(Cancelled.into());
        }
        candidates.push(candidate(model, request, &best.x, place));
    }

    let (covariance, weight) = covariance(model, best, chosen);
    let count = if request.wanted_percent.is_some() { MAX_PROPOSALS } else { request.propose };
    let rows: Vec<Option<DMat>> = candidates.iter().map(|candidate| candidate.rows.clone()).collect();
    let found = choose_rows(&covariance, &weight, &rows, count, request.propose_by);
    let mut found: Vec<ProposedMeasurement> = found
        .iter()
        .enumerate()
        .map(|(n, choice)| proposed(model, (best, factor), n + 1, &candidates[choice.candidate], choice, chosen))
        .collect();
    let needed = request.wanted_percent.and_then(|wanted| {
        let reaches = |row: &&ProposedMeasurement| row.largest_percent.is_some_and(|largest| largest <= wanted);
        found.iter().find(reaches).map(|row| row.number)
    });
    found.truncate(needed.unwrap_or(0).max(request.propose));
    Ok((found, needed))
}

/// Sentence on a wanted deviation that no number of measurements reaches.
pub(super) fn not_reached(wanted_percent: f64) -> String {
    format!(
        "{MAX_PROPOSALS} of the candidates do not reach deviations of {} %: offer other poses or kinds of \
         measurements, more accurate ones, or fit fewer values",
        significant(wanted_percent, 3)
    )
}

/// Covariance of the coordinates, with one usual error along what the measurements do not see, and the weights of the
/// chosen ones.
fn covariance(model: &IdentifiedModel<'_>, best: &Minimum, chosen: &[bool]) -> (DMat, DMat) {
    let scales: Vec<f64> = model.unknowns.iter().map(Unknown::spread).collect();
    let known = precision(&best.jacobian, &scales);
    let mut covariance = known.covariance;
    let floor = UNSEEN * known.directions.first().map_or(0.0, |(value, _)| *value);
    for (_, direction) in known.directions.iter().filter(|(value, _)| *value <= floor) {
        covariance +=
            DMat::from_fn(scales.len(), scales.len(), |i, j| direction[i] * direction[j] * scales[i] * scales[j]);
    }
    let weight =
        DMat::from_fn(scales.len(), scales.len(), |i, j| if i == j && chosen[i] { scales[i].powi(-2) } else { 0.0 });
    (covariance, weight)
}

/// Candidate with its derivatives at the identified values.
fn candidate(model: &IdentifiedModel<'_>, request: &IdentifyRequest, x: &[f64], place: CandidatePlace) -> Candidate {
    let found = experiment(model, request, x, place).and_then(|experiment| {
        let frequency_hz: Vec<f64> = experiment.frequencies.iter().map(|of| of.frequency_hz).collect();
        let of_candidate = IdentifyRequest { experiments: vec![experiment], ..request.clone() };
        let is_cancelled = || false;
        let mut alone = IdentifiedModel::new(model.parameters, model.unknowns, &of_candidate, &is_cancelled).ok()?;
        let (_, jacobian) = alone.linearised(x)?;
        let measured = jacobian.nrows() - alone.prior_count();
        Some((frequency_hz, jacobian.rows(0, measured).into_owned()))
    });
    let (frequency_hz, rows) = found.map_or_else(|| (Vec::new(), None), |(hz, rows)| (hz, Some(rows)));
    Candidate { place, frequency_hz, rows }
}

/// Experiment of a candidate, whose measured values are those of the identified robot; `None` without an equilibrium.
fn experiment(
    model: &IdentifiedModel<'_>,
    request: &IdentifyRequest,
    x: &[f64],
    CandidatePlace { pose, payload_kg, kind }: CandidatePlace,
) -> Option<Experiment> {
    let first = request.experiments.first()?;
    let given = request::Pose::from(&pose);
    let state = State {
        lengths_m: None,
        pose: Some(given),
        hold_lengths_of_pose: first.state.hold_lengths_of_pose || kind == "pose",
        ..first.state.clone()
    };
    let mut experiment = Experiment {
        cables: first.cables.clone(),
        payload_kg: payload_kg.or(first.payload_kg),
        payload_center_m: first.payload_center_m,
        position_std_m: first.position_std_m,
        rotation_std_deg: first.rotation_std_deg,
        tension_std_n: first.tension_std_n,
        length_std_m: first.length_std_m,
        state,
        ..Experiment::default()
    };
    match kind {
        "frequencies" => {
            let numbered = |(k, frequency_hz): (usize, f64)| MeasuredFrequency {
                frequency_hz,
                label: Some((k + 1).to_string()),
                ..MeasuredFrequency::default()
            };
            experiment.frequencies = (0..request.propose_modes).map(|k| numbered((k, FIRST_HZ))).collect();
            let of_list = IdentifyRequest { experiments: vec![experiment.clone()], ..request.clone() };
            let is_cancelled = || false;
            let mut alone = IdentifiedModel::new(model.parameters, model.unknowns, &of_list, &is_cancelled).ok()?;
            let predicted = alone.predict(x, None).ok()?;
            experiment.frequencies = predicted.values.iter().map(|value| value.re).enumerate().map(numbered).collect();
        }
        "pose" => experiment.measured_pose = Some(given),
        _ => {
            let robot = mounted(model.robot(x).ok()?, &experiment, "").ok()?;
            let rest = at_rest::equilibrium(robot, &request.robot, &experiment.state, &request.tensions);
            let cables = rest.ok()?.equilibrium.cables;
            if kind == "tensions" {
                experiment.measured_tensions_n = Some(cables.iter().map(|cable| cable.tension_platform).collect());
            } else {
                experiment.measured_lengths_m = Some(cables.iter().map(|cable| cable.unstrained_length).collect());
            }
        }
    }
    Some(experiment)
}

fn proposed(
    model: &IdentifiedModel<'_>,
    (best, factor): (&Minimum, f64),
    number: usize,
    candidate: &Candidate,
    choice: &ChosenRows,
    chosen: &[bool],
) -> ProposedMeasurement {
    let values = model.values(&best.x);
    let coordinate: Vec<f64> =
        choice.covariance.diagonal().iter().map(|variance| factor * variance.max(0.0).sqrt()).collect();
    let deviations: Vec<f64> = model
        .unknowns
        .iter()
        .zip(&values)
        .zip(&coordinate)
        .map(|((unknown, value), deviation)| unknown.rate(*value) * deviation)
        .collect();
    let largest = (0..values.len())
        .filter(|&k| chosen[k] && model.unknowns[k].is_log)
        .max_by(|a, b| coordinate[*a].total_cmp(&coordinate[*b]));
    ProposedMeasurement {
        number,
        position_m: candidate.place.pose.position_w.into(),
        roll_pitch_yaw_deg: rotation::to_roll_pitch_yaw_deg(&candidate.place.pose.rot_wp),
        payload_kg: candidate.place.payload_kg,
        measured: candidate.place.kind.to_owned(),
        frequency_hz: candidate.frequency_hz.clone(),
        deviations,
        largest_percent: largest.map(|k| 100.0 * coordinate[k]),
        largest_of: largest.map(|k| model.unknowns[k].path.clone()),
    }
}
