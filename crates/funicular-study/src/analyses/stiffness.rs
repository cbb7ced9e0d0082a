//! `stiffness`: 6×6 stiffness at one frequency.

use super::cable::STEP;
use super::found;
use super::shared::Models;
use crate::at_rest::{self, AtRest};
use crate::columns::{Columns, ResultTable, Tabled, column};
use crate::error::Cancelled;
use crate::request::{self, Model};
use crate::rows::rows;
use crate::table::Column;
use crate::watch::Watch;
use anyhow::Result;
use funicular::cable::CableModel;
use funicular::dynamics::{Assembly, Dynamics, DynamicsError, Linearisation};
use funicular::math::{CMat6, Complex, Mat6};
use funicular::robot::{Robot, WinchMode};
use funicular::statics::{self, StaticModel};
use std::f64::consts::TAU;

/// Components of a wrench, in the order of the rows of a stiffness.
pub const WRENCH: [&str; 6] = ["fx", "fy", "fz", "mx", "my", "mz"];
/// Components of a motion, in the order of its columns.
pub const MOTION: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

rows! {
    /// Results of `stiffness`: 6×6 matrix about the platform origin, world axes.
    pub struct Stiffness {
        pub robot: String = hidden;
        pub frequency_hz: f64;
        pub models: Models = spread;
        pub real: [[f64; 6]; 6];
        pub imag: [[f64; 6]; 6];
        /// Norm of the antisymmetric part divided by the norm of the matrix; absent if the matrix is symmetric by
        /// theory.
        pub antisymmetric_fraction: Option<f64>;
        pub warnings: Vec<String> = hidden;
    }
}

/// Computes the 6×6 stiffness about the platform origin, world axes, at one frequency.
///
/// # Errors
/// A robot without such an equilibrium, or a cable model that has no stiffness there.
pub fn run(robot: Robot, request: &request::StiffnessRequest, watch: &mut dyn Watch) -> Result<Stiffness> {
    crate::request::check_not_negative("at_hz", request.at_hz)?;
    let at_rest = at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?;
    let linearisation = linearisation_at(&at_rest, request.model, request.at_hz);
    let matrix = matrices(&at_rest, request.model, &[request.at_hz], watch)?[0];

    // Drag that turns with the cables makes the matrix unsymmetric. The cable models of vibration are not used then.
    let turns = drag_turns(&at_rest, request.model, request.at_hz);
    let antisymmetric_fraction = turns.then(|| statics::antisymmetric_fraction(&at_rest.robot, &matrix.map(|k| k.re)));
    let warnings = at_rest.warnings((!turns).then_some((linearisation.cable_model, request.at_hz)));

    // `+ 0.0` makes a negative zero positive, because its sign has no meaning.
    let rows =
        |part: fn(&Complex) -> f64| std::array::from_fn(|i| std::array::from_fn(|j| part(&matrix[(i, j)]) + 0.0));
    Ok(Stiffness {
        robot: at_rest.robot.name.clone(),
        frequency_hz: request.at_hz,
        models: Models::of(&at_rest, linearisation),
        real: rows(|k| k.re),
        imag: rows(|k| k.im),
        antisymmetric_fraction,
        warnings,
    })
}

/// Linearisation at a frequency. At 0 Hz without a named cable model it is the tangent of the static model, which is
/// also the limit of the cable model `catenary-dynamic` at 0 Hz.
fn linearisation_at(at_rest: &AtRest, model: Model, hz: f64) -> Linearisation {
    let linearisation = at_rest::linearisation(&model, at_rest.equilibrium.model);
    if model.cable_model.is_none() && hz == 0.0 {
        return Linearisation { cable_model: CableModel::CatenaryStatic, ..linearisation };
    }
    linearisation
}

/// True if the stiffness at a frequency contains wind drag that turns with the cables: at 0 Hz without a named cable
/// model. A named cable model is a model of vibration, with constant drag.
fn drag_turns(at_rest: &AtRest, model: Model, hz: f64) -> bool {
    model.cable_model.is_none()
        && linearisation_at(at_rest, model, hz) == FULL_TANGENT
        && statics::drag_stiffness(&at_rest.robot, &at_rest.equilibrium).is_some()
}

/// Computes the stiffness of a robot at equilibrium at every frequency [Hz], none of them negative.
///
/// # Errors
/// [`DynamicsError`]: a cable model that has no stiffness there; or work that was stopped.
pub fn matrices(at_rest: &AtRest, model: Model, frequencies: &[f64], watch: &mut dyn Watch) -> Result<Vec<CMat6>> {
    let highest_hz = frequencies.iter().copied().fold(0.0, f64::max);
    let still = if frequencies.contains(&0.0) { Some(Form::at(at_rest, model, 0.0)?) } else { None };
    let moving = if highest_hz > 0.0 { Some(Form::at(at_rest, model, highest_hz)?) } else { None };
    let at = |(place, hz): (usize, &f64)| {
        if place % STEP == 0 {
            watch.progress(place, frequencies.len(), "frequencies");
            if watch.is_cancelled() {
                return Err(Cancelled.into());
            }
        }
        let form = if *hz == 0.0 { &still } else { &moving };
        Ok(form.as_ref().map_or_else(CMat6::zeros, |form| form.matrix(*hz)))
    };
    frequencies.iter().enumerate().map(at).collect()
}

/// Linearisation with all terms of the static tangent.
const FULL_TANGENT: Linearisation = Linearisation {
    cable_model: CableModel::CatenaryStatic,
    assembly: Assembly::Consistent,
    in_plane_only: false,
    winches: WinchMode::AsGiven,
};

/// Stiffness over frequency.
enum Form {
    /// Static tangent, the same at every frequency.
    Constant(Box<CMat6>),
    Dynamic(Box<Dynamics>),
}

impl Form {
    /// Stiffness for frequencies up to a limit [Hz].
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
        // At rest a rope has the stiffness of its equilibrium, in vibration its dynamic one.
        let vibrating = if up_to_hz > 0.0 { equilibrium.with_dynamic_stiffness(robot) } else { at_rest.slow() };
        let dynamics = Dynamics::about(&vibrating.0, &vibrating.1, linearisation, up_to_hz)?;
        Ok(match statics::tangent_stiffness(robot, equilibrium) {
            Some(tangent) if linearisation == FULL_TANGENT => constant(tangent),
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

/// Entry of a stiffness.
struct Entry {
    row: usize,
    column: usize,
    value: Complex,
}

impl Entry {
    fn columns() -> Columns<Self> {
        Columns::new([
            column("row", "", "component of the wrench", |of: &Self| WRENCH[of.row]),
            column("column", "", "component of the motion", |of: &Self| MOTION[of.column]),
            column("unit", "", "unit of the entry", |of: &Self| match (of.row < 3, of.column < 3) {
                (true, true) => "N/m",
                (true, false) => "N/rad",
                (false, true) => "N m/m",
                (false, false) => "N m/rad",
            }),
            column("real", "", "real part of the entry", |of: &Self| of.value.re),
            column("imag", "", "imaginary part of the entry", |of: &Self| of.value.im),
        ])
    }
}

impl Tabled for Stiffness {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", Entry::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        let entries = (0..6).flat_map(|row| (0..6).map(move |column| (row, column)));
        let entry = |(row, column): (usize, usize)| Entry {
            row,
            column,
            value: Complex::new(self.real[row][column], self.imag[row][column]),
        };
        ResultTable::new(Entry::columns(), entries.map(entry))
    }
}

found!(Stiffness, "stiffness");
