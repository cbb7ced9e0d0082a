//! `stiffness`: the 6×6 at one frequency.

use super::found;
use super::shared::Models;
use crate::at_rest;
use crate::request;
use anyhow::Result;
use funicular::cable::CableModel;
use funicular::dynamics::{DynamicsError, Linearisation};
use funicular::math::{CMat6, Complex};
use funicular::robot::Robot;
use funicular::statics::{self, StaticModel};
use serde::Serialize;
use std::f64::consts::TAU;

/// Results of `stiffness`: the 6×6 matrix about the platform origin, world axes.
#[derive(Serialize)]
pub struct Stiffness {
    #[serde(skip)]
    pub robot: String,
    pub frequency_hz: f64,
    #[serde(flatten)]
    pub models: Models,
    pub real: [[f64; 6]; 6],
    pub imag: [[f64; 6]; 6],
    /// Size of the antisymmetric part over that of the whole; absent where the matrix is symmetric by its theory.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub antisymmetric_part: Option<f64>,
    #[serde(skip)]
    pub warnings: Vec<String>,
}

/// The 6×6 stiffness about the platform origin, world axes, at one frequency.
///
/// # Errors
/// A robot without that equilibrium, or a model that has no stiffness there.
pub fn run(robot: Robot, request: &request::StiffnessRequest) -> Result<Stiffness> {
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
    let whole_tangent = Linearisation { cable_model: CableModel::CatenaryTangent, ..Linearisation::default() };
    let (robot, rest) = (&at_rest.robot, &at_rest.equilibrium);

    // Without a cable model the drag of the wind turns with the cables; a named one is that of vibration, with held drag.
    let turning = (linearisation == whole_tangent && request.model.cable_model.is_none())
        .then(|| statics::drag_stiffness(robot, rest))
        .flatten();
    let exact = match (linearisation == whole_tangent, turning) {
        (true, Some(_)) => statics::tangent_with_drag(robot, rest),
        (true, None) => statics::tangent_stiffness(robot, rest),
        (false, _) => None,
    };
    let antisymmetric_part =
        exact.filter(|_| turning.is_some()).map(|tangent| statics::antisymmetric_part(robot, &tangent));

    let (matrix, warnings): (CMat6, _) = match exact {
        Some(tangent) if turning.is_some() => (tangent.map(|k| Complex::new(k, 0.0)), at_rest.warnings(None)),
        _ => {
            let (dynamics, warnings) = at_rest.dynamics(linearisation, request.at_hz)?;
            let matrix = exact.map(|tangent| tangent.map(|k| Complex::new(k, 0.0)));
            (matrix.unwrap_or_else(|| dynamics.stiffness(request.at_hz * TAU)), warnings)
        }
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
        antisymmetric_part,
        warnings,
    })
}

found!(Stiffness, "stiffness");
