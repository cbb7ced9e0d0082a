//! Linear deviations at one pose, and the tests of where they hold.

use super::inputs::{Distribution, Inputs};
use super::mode_linearity;
use super::response_linearity;
use super::responses::{RequestedResponse, Responses};
use super::results::{NominalModes, of_groups};
use super::row::{Along, Row};
use crate::analyses::gradient::{check_hold, held};
use crate::analyses::result_groups::nothing_below;
use crate::at_rest::{self, AtRest};
use crate::error::NoSolution;
use crate::measure::{Measure, MeasureGroup, ResponsePart};
use crate::request::UncertaintyRequest;
use anyhow::Result;
use funicular::dynamics::Linearisation;
use funicular::gradient::{GradientError, Gradients, Hold};
use funicular::robot::{Robot, RobotChange, TensionLimits};
use funicular::statics::{TensionRange, TensionRule};

/// Minimum distance of a tension from its limit, in standard deviations: with eight cables at this distance, one in
/// ninety robots exceeds a limit.
const TENSION_DEVIATIONS: f64 = 3.0;

/// Robot at a pose with the linear deviations of its results.
#[derive(Clone)]
pub(crate) struct LinearPose {
    /// Undisturbed robot at rest.
    pub(crate) at_rest: AtRest,
    /// Linearisation of vibrations.
    pub(crate) linearisation: Linearisation,
    /// Values of the numbers that deviate.
    pub(crate) input_values: Vec<f64>,
    /// Distributions of the numbers that deviate.
    pub(crate) distributions: Vec<Distribution>,
    /// Results.
    pub(crate) rows: Vec<Row>,
    /// Warnings.
    pub(crate) warnings: Vec<String>,
    /// Tension limits of the request.
    pub(super) limits: TensionLimits,
    /// Rule of the tensions at a held pose: the rule of the request, or the smallest change.
    pub(super) rule: TensionRule,
    /// Frequency responses of the undisturbed robot, if they are requested for.
    pub(super) responses: Option<Responses>,
    /// Changes of the robot per unit of each number of the pose.
    pub(super) pose_changes: Vec<Option<RobotChange>>,
}

impl LinearPose {
    /// Linear deviations of the results of a robot at rest.
    ///
    /// # Errors
    /// A robot without such an equilibrium, or too few cables to hold its pose.
    pub(crate) fn new(
        request: &UncertaintyRequest,
        of: &[&MeasureGroup],
        requested: Option<&RequestedResponse>,
        inputs: &Inputs,
        at_rest: AtRest,
    ) -> Result<Self> {
        let robot = &at_rest.robot;
        check_hold(robot, request.hold)?;
        let linearisation = at_rest::linearisation(&request.model, at_rest.equilibrium.model);
        let input_values = inputs.values(&at_rest);
        let distributions = inputs.distributions(&input_values);
        let changes = inputs.changes(robot);

        let needs_damping = of.contains(&&MeasureGroup::Damping);
        let below_hz = request.below_hz.filter(|_| needs_damping || of.contains(&&MeasureGroup::Frequencies));
        let at_hz = requested.map_or(&[][..], RequestedResponse::at_hz);
        let modes = (below_hz.is_some() || requested.is_some())
            .then(|| NominalModes::new(&at_rest, linearisation, below_hz.unwrap_or(0.0), needs_damping, at_hz))
            .transpose()?;
        let responses = match (requested, &modes) {
            (Some(requested), Some(modes)) => Some(Responses::new(requested, &at_rest, &modes.dynamics)?),
            _ => None,
        };
        let kinds = of_groups(of, robot, modes.as_ref().map_or(0, |modes| modes.count), at_hz);
        let mut rows = rows(&kinds, &at_rest, modes.as_ref(), responses.as_ref());

        match held(&at_rest, request.hold) {
            Err(error) if !error.is::<GradientError>() && !error.is::<NoSolution>() => return Err(error),
            Err(error) => rows.iter_mut().for_each(|row| row.sampling_reason = Some(error.to_string())),
            Ok(gradients) => {
                let along = Along { inputs, changes: &changes, distributions: &distributions };
                differentiate_and_test(&mut rows, robot, &gradients, (modes.as_ref(), responses.as_ref()), &along);
            }
        }

        let lacking = below_hz.filter(|_| modes.as_ref().is_some_and(|modes| modes.count == 0)).map(nothing_below);
        let mut warnings = modes.map_or_else(|| at_rest.warnings(None), |modes| modes.warnings);
        warnings.extend(lacking);
        let rule = match (request.hold, &at_rest.rule) {
            (Hold::Rule, Some(rule)) => rule.clone(),
            _ => held_tensions(&at_rest),
        };
        let is_moved = |k: usize| request.hold != Hold::Lengths && inputs.is_of_pose(k);
        let pose_changes = changes.into_iter().enumerate().map(|(k, change)| change.filter(|_| is_moved(k))).collect();
        let limits = TensionLimits { minimum: request.tensions.min_tension_n, maximum: request.tensions.max_tension_n };
        Ok(Self {
            at_rest,
            linearisation,
            input_values,
            distributions,
            rows,
            warnings,
            limits,
            rule,
            responses,
            pose_changes,
        })
    }

    /// True if a result has to be sampled.
    pub(crate) fn needs_samples(&self) -> bool {
        self.rows.iter().any(|row| row.sampling_reason.is_some())
    }
}

/// Adds the derivatives of all results, and the reasons why results have to be sampled.
fn differentiate_and_test(
    rows: &mut [Row],
    robot: &Robot,
    gradients: &Gradients,
    (modes, responses): (Option<&NominalModes>, Option<&Responses>),
    along: &Along,
) {
    differentiate(rows, gradients, modes, along);
    if let (Some(of), Some(modes)) = (responses, modes) {
        response_linearity::differentiate(rows, of, robot, gradients, modes, along);
    }
    test_tensions(rows, robot, gradients, along);
    if let Some(modes) = modes {
        mode_linearity::test(rows, modes, gradients, along);
    }
    if let (Some(of), Some(modes)) = (responses, modes) {
        response_linearity::test(rows, of, robot, gradients, modes, along);
    }
}

/// Rule that keeps the tensions of an equilibrium.
fn held_tensions(at_rest: &AtRest) -> TensionRule {
    let parallel = at_rest.equilibrium.cables.iter();
    TensionRule::Closest(
        parallel
            .map(|cable| match &cable.hanging {
                Some(hanging) => hanging.catenary.parallel_tension(),
                None => cable.tension_platform,
            })
            .collect(),
    )
}

/// Results with their values, without derivatives. A value that does not exist has no row.
fn rows(kinds: &[Measure], at_rest: &AtRest, modes: Option<&NominalModes>, responses: Option<&Responses>) -> Vec<Row> {
    let value = |kind: Measure| match kind {
        Measure::Response(hz, ResponsePart::Phase) => responses.and_then(|of| Some(of.degrees(of.place(hz)?))),
        Measure::Response(hz, _) => responses.and_then(|of| Some(of.decibels(of.place(hz)?))),
        Measure::Frequency(k) => modes?.found.modes.get(k).map(|mode| mode.frequency_hz),
        Measure::Damping(k) => modes?.damped.get(k).map(funicular::modes::damped::DampedMode::damping_ratio),
        // A rotation is counted from here.
        Measure::Pose(3..) => Some(0.0),
        other => other.static_value(&at_rest.robot, &at_rest.equilibrium, &at_rest.equilibrium.pose),
    };
    let row =
        |kind: &Measure| Some(Row { kind: *kind, value: value(*kind)?, derivatives: None, sampling_reason: None });
    kinds.iter().filter_map(row).collect()
}

/// Adds the derivatives of all rows, or the reasons why they have none.
fn differentiate(rows: &mut [Row], gradients: &Gradients, modes: Option<&NominalModes>, along: &Along) {
    let put = |row: &mut Row, gradient: Result<RobotChange, GradientError>| match gradient
        .map_err(|error| error.to_string())
        .and_then(|gradient| along.of(&gradient))
    {
        Ok(derivatives) => row.derivatives = Some(derivatives),
        Err(reason) => row.sampling_reason = Some(reason),
    };

    let kinds: Vec<Measure> = rows.iter().map(|row| row.kind).collect();
    for (row, gradient) in rows.iter_mut().zip(Measure::static_gradients(&kinds, gradients)) {
        if let Some(gradient) = gradient {
            put(row, gradient);
        }
    }

    let Some(modes) = modes else { return };
    let vibration = match gradients.vibration(&modes.dynamics) {
        Ok(vibration) => vibration,
        Err(error) => {
            let of_modes = rows.iter_mut().filter(|row| row.kind.mode().is_some());
            of_modes.for_each(|row| row.sampling_reason = Some(error.to_string()));
            return;
        }
    };
    for row in rows {
        match row.kind {
            Measure::Frequency(k) => put(row, vibration.frequency(&modes.found.modes[k])),
            Measure::Damping(k) => {
                put(row, vibration.damped(&modes.damped[k]).map(|gradient| gradient.damping_ratio));
            }
            _ => {}
        }
    }
}

/// Tests whether a tension may reach zero, or with the pose held one of its limits: all results are then far from
/// linear.
fn test_tensions(rows: &mut [Row], robot: &Robot, gradients: &Gradients, along: &Along) {
    let rest = gradients.equilibrium();
    let chosen = gradients.hold() != Hold::Lengths && robot.constraint().is_redundant();
    for (i, (gradient, state)) in gradients.tensions_platform().iter().zip(&rest.cables).enumerate() {
        let Ok(derivatives) = along.of(gradient) else { return };

        let range = TensionRange::of(robot, i, &state.chord_w());
        let margin = range.margin(state);
        // Where tensions are chosen, the limits hold; elsewhere the cable only must not become slack. A limit that a
        // rule has reached stays reached.
        if gradients.hold() == Hold::Rule && margin.reached().is_some() {
            continue;
        }
        let distance = if chosen { margin.distance().min(margin.min) } else { margin.min };
        let reached = along.reach(&derivatives, TENSION_DEVIATIONS);
        if reached >= distance {
            let reason = tension_reason(robot, i, chosen, reached, distance);
            for row in rows.iter_mut() {
                row.sampling_reason = row.sampling_reason.take().or_else(|| Some(reason.clone()));
            }
            return;
        }
    }
}

fn tension_reason(robot: &Robot, i: usize, chosen: bool, reached: f64, distance: f64) -> String {
    let what = if chosen { "reach a limit" } else { "become slack" };
    let number = |value: f64| crate::text::significant(value, 3);
    format!(
        "cable \"{}\" may {what}: {TENSION_DEVIATIONS} deviations of its tension are {} N, and its distance is {} N",
        robot.cables[i].name,
        number(reached),
        number(distance.max(0.0))
    )
}
