//! `stiffness`: the 6×6 at one frequency.

use super::found;
use crate::at_rest::{self, AtRest, Models};
use crate::request::{self, Model};
use anyhow::Result;
use funicular::cable::CableModel;
use funicular::dynamics::{Dynamics, DynamicsError, Linearisation};
use funicular::math::{CMat6, Complex};
use funicular::robot::Robot;
use funicular::statics::{self, StaticModel};
use serde::Serialize;
use std::f64::consts::TAU;

#[derive(Serialize)]
pub struct Stiffness {
    #[serde(skip)]
    pub robot: String,
    pub frequency_hz: f64,
    #[serde(flatten)]
    pub models: Models,
    pub real: [[f64; 6]; 6],
    pub imag: [[f64; 6]; 6],
    #[serde(skip)]
    pub warnings: Vec<String>,
}

/// The 6×6 stiffness about the platform origin, world axes, at one frequency.
///
/// # Errors
/// A robot without that equilibrium, or a model that has no stiffness there.
pub fn run(robot: Robot, request: &request::Stiffness) -> Result<Stiffness> {
    crate::request::check_not_negative("at_hz", request.at_hz)?;
    let at_rest = at_rest::equilibrium(robot, &request.state, &request::Tensions::default())?;
    let linearisation = linearisation_at(&at_rest, &request.model, request.at_hz);
    let matrix = matrices(&at_rest, &request.model, &[request.at_hz])?[0];
    let warnings = at_rest.warnings(Some((linearisation.cable_model, request.at_hz)));
    // `+ 0.0` makes a negative zero positive: the sign would mean nothing.
    let rows =
        |part: fn(&Complex) -> f64| std::array::from_fn(|i| std::array::from_fn(|j| part(&matrix[(i, j)]) + 0.0));
    Ok(Stiffness {
        robot: at_rest.robot.name.clone(),
        frequency_hz: request.at_hz,
        models: Models::of(&at_rest.equilibrium, linearisation),
        real: rows(|k| k.re),
        imag: rows(|k| k.im),
        warnings,
    })
}

/// The linearisation at a frequency: at 0 Hz, unless a cable model is named, the tangent of the static model, which the exact
/// cable model has at rest.
fn linearisation_at(at_rest: &AtRest, model: &Model, hz: f64) -> Linearisation {
    let linearisation = at_rest::linearisation(model, at_rest.equilibrium.model);
    if model.cable_model.is_none() && hz == 0.0 {
        return Linearisation { cable_model: CableModel::CatenaryTangent, ..linearisation };
    }
    linearisation
}

/// The stiffness of a robot at rest at every frequency [Hz]; none may be negative.
///
/// # Errors
/// [`DynamicsError`]: a model that has no stiffness there.
pub fn matrices(at_rest: &AtRest, model: &Model, frequencies: &[f64]) -> Result<Vec<CMat6>, DynamicsError> {
    let highest_hz = frequencies.iter().copied().fold(0.0, f64::max);
    let still = if frequencies.contains(&0.0) { Some(at_zero(at_rest, model)?) } else { None };
    let moving = if highest_hz > 0.0 {
        let linearisation = linearisation_at(at_rest, model, highest_hz);
        refuse_rigid(linearisation, at_rest.equilibrium.model)?;
        Some(Dynamics::about(&at_rest.robot, &at_rest.equilibrium, linearisation, highest_hz)?)
    } else {
        None
    };
    let at = |hz: &f64| match (&still, &moving) {
        (Some(still), _) if *hz == 0.0 => *still,
        (_, Some(dynamics)) => dynamics.stiffness(hz * TAU),
        (still, None) => still.unwrap_or_default(),
    };
    Ok(frequencies.iter().map(at).collect())
}

/// The stiffness at 0 Hz.
fn at_zero(at_rest: &AtRest, model: &Model) -> Result<CMat6, DynamicsError> {
    let AtRest { robot, equilibrium, .. } = at_rest;
    let linearisation = linearisation_at(at_rest, model, 0.0);
    refuse_rigid(linearisation, equilibrium.model)?;
    let whole_tangent = Linearisation { cable_model: CableModel::CatenaryTangent, ..Linearisation::default() };
    if linearisation == whole_tangent
        && let Some(tangent) = statics::tangent_stiffness(robot, equilibrium)
    {
        return Ok(tangent.map(|k| Complex::new(k, 0.0)));
    }
    Ok(Dynamics::about(robot, equilibrium, linearisation, 0.0)?.stiffness(0.0))
}

/// Refuses the tangent of ideal cables, which are rigid.
fn refuse_rigid(linearisation: Linearisation, static_model: StaticModel) -> Result<(), DynamicsError> {
    if linearisation.cable_model == CableModel::CatenaryTangent && static_model == StaticModel::Ideal {
        return Err(DynamicsError::Rigid);
    }
    Ok(())
}

found!(Stiffness, "stiffness");
