//! `stiffness`: the 6×6 at one frequency.

use super::found;
use super::shared::Models;
use crate::at_rest::{self, AtRest};
use crate::request::{self, Model};
use anyhow::Result;
use funicular::cable::CableModel;
use funicular::dynamics::{Assembly, Dynamics, DynamicsError, Linearisation};
use funicular::math::{CMat6, Complex, Mat6};
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
    pub antisymmetric_fraction: Option<f64>,
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
    let linearisation = linearisation_at(&at_rest, request.model, request.at_hz);
    let matrix = matrices(&at_rest, request.model, &[request.at_hz])?[0];

    // The drag that turns with the cables makes the matrix unsymmetric; the models of vibration are not asked then.
    let turns = drag_turns(&at_rest, request.model, request.at_hz);
    let antisymmetric_fraction = turns.then(|| statics::antisymmetric_fraction(&at_rest.robot, &matrix.map(|k| k.re)));
    let warnings = at_rest.warnings((!turns).then_some((linearisation.cable_model, request.at_hz)));

    // `+ 0.0` makes a negative zero positive: the sign would mean nothing.
    let rows =
        |part: fn(&Complex) -> f64| std::array::from_fn(|i| std::array::from_fn(|j| part(&matrix[(i, j)]) + 0.0));
    Ok(Stiffness {
        robot: at_rest.robot.name.clone(),
        frequency_hz: request.at_hz,
        models: Models::of(&at_rest.equilibrium, linearisation),
        real: rows(|k| k.re),
        imag: rows(|k| k.im),
        antisymmetric_fraction,
        warnings,
    })
}

/// The linearisation at a frequency: at 0 Hz, unless a cable model is named, the tangent of the static model, which the exact
/// cable model has at rest.
fn linearisation_at(at_rest: &AtRest, model: Model, hz: f64) -> Linearisation {
    let linearisation = at_rest::linearisation(&model, at_rest.equilibrium.model);
    if model.cable_model.is_none() && hz == 0.0 {
        return Linearisation { cable_model: CableModel::CatenaryStatic, ..linearisation };
    }
    linearisation
}

/// Whether the stiffness at a frequency has a drag of the wind that turns with the cables: at 0 Hz without a named cable
/// model, which is that of vibration, with held drag.
fn drag_turns(at_rest: &AtRest, model: Model, hz: f64) -> bool {
    model.cable_model.is_none()
        && linearisation_at(at_rest, model, hz) == WHOLE_TANGENT
        && statics::drag_stiffness(&at_rest.robot, &at_rest.equilibrium).is_some()
}

/// The stiffness of a robot at rest at every frequency [Hz]; none may be negative.
///
/// # Errors
/// [`DynamicsError`]: a model that has no stiffness there.
pub fn matrices(at_rest: &AtRest, model: Model, frequencies: &[f64]) -> Result<Vec<CMat6>, DynamicsError> {
    let highest_hz = frequencies.iter().copied().fold(0.0, f64::max);
    let still = if frequencies.contains(&0.0) { Some(Form::at(at_rest, model, 0.0)?) } else { None };
    let moving = if highest_hz > 0.0 { Some(Form::at(at_rest, model, highest_hz)?) } else { None };
    let at = |hz: &f64| {
        let form = if *hz == 0.0 { &still } else { &moving };
        form.as_ref().map_or_else(CMat6::zeros, |form| form.matrix(*hz))
    };
    Ok(frequencies.iter().map(at).collect())
}

/// All terms of the static tangent.
const WHOLE_TANGENT: Linearisation =
    Linearisation { cable_model: CableModel::CatenaryStatic, assembly: Assembly::Consistent, in_plane_only: false };

/// A stiffness over frequency.
enum Form {
    /// The tangent of the statics, the same at every frequency.
    Constant(Box<CMat6>),
    Dynamic(Box<Dynamics>),
}

impl Form {
    /// The stiffness up to a frequency [Hz].
    fn at(at_rest: &AtRest, model: Model, up_to_hz: f64) -> Result<Self, DynamicsError> {
        let AtRest { robot, equilibrium, .. } = at_rest;
        let linearisation = linearisation_at(at_rest, model, up_to_hz);
        refuse_rigid(linearisation, equilibrium.model)?;
        let constant = |tangent: Mat6| Self::Constant(Box::new(tangent.map(|k| Complex::new(k, 0.0))));
        if drag_turns(at_rest, model, up_to_hz)
            && let Some(tangent) = statics::tangent_with_drag(robot, equilibrium)
        {
            return Ok(constant(tangent));
        }
        let dynamics = Dynamics::about(robot, equilibrium, linearisation, up_to_hz)?;
        Ok(match statics::tangent_stiffness(robot, equilibrium) {
            Some(tangent) if linearisation == WHOLE_TANGENT => constant(tangent),
            _ => Self::Dynamic(Box::new(dynamics)),
        })
    }

    fn matrix(&self, hz: f64) -> CMat6 {
        match self {
            Self::Constant(matrix) => **matrix,
            Self::Dynamic(dynamics) => dynamics.stiffness(hz * TAU),
        }
    }
}

/// Refuses the tangent of ideal cables, which are rigid.
fn refuse_rigid(linearisation: Linearisation, static_model: StaticModel) -> Result<(), DynamicsError> {
    if linearisation.cable_model == CableModel::CatenaryStatic && static_model == StaticModel::Ideal {
        return Err(DynamicsError::Rigid);
    }
    Ok(())
}

found!(Stiffness, "stiffness");
