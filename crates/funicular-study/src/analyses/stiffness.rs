//! `stiffness`: the 6×6 at one frequency.

use super::found;
use crate::at_rest::{self, Models};
use crate::request;
use anyhow::Result;
use funicular::cable::CableModel;
use funicular::dynamics::{DynamicsError, Linearisation};
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
    let mut linearisation = at_rest::linearisation(&request.model, at_rest.equilibrium.model);
    if request.model.cable_model.is_none() && request.at_hz == 0.0 {
        // The tangent of the static model, which the exact model has at rest, whatever the static model is.
        linearisation.cable_model = CableModel::CatenaryTangent;
    }
    if linearisation.cable_model == CableModel::CatenaryTangent && at_rest.equilibrium.model == StaticModel::Ideal {
        return Err(DynamicsError::Rigid.into());
    }
    let (dynamics, warnings) = at_rest.dynamics(linearisation, request.at_hz)?;
    let whole_tangent = Linearisation { cable_model: CableModel::CatenaryTangent, ..Linearisation::default() };
    let exact = match linearisation {
        l if l == whole_tangent => statics::tangent_stiffness(&at_rest.robot, &at_rest.equilibrium),
        _ => None,
    };
    let matrix: CMat6 = match exact {
        Some(tangent) => tangent.map(|k| Complex::new(k, 0.0)),
        None => dynamics.stiffness(request.at_hz * TAU),
    };
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

found!(Stiffness, "stiffness");
