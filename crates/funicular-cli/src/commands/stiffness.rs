//! `stiffness`: the 6×6 at one frequency.

use crate::args::StiffnessArgs;
use crate::output::Results;
use crate::state::{self, Models};
use crate::table::{Table, significant};
use anyhow::Result;
use funicular::cable::CableModel;
use funicular::dynamics::{DynamicsError, Linearisation};
use funicular::math::{CMat6, Complex};
use funicular::robot::Robot;
use funicular::statics::{self, StaticModel};
use serde::Serialize;
use std::f64::consts::TAU;

#[derive(Serialize)]
pub(crate) struct Stiffness {
    #[serde(skip)]
    robot: String,
    frequency_hz: f64,
    #[serde(flatten)]
    models: Models,
    real: [[f64; 6]; 6],
    imag: [[f64; 6]; 6],
    /// Size of the antisymmetric part over that of the whole; absent where the matrix is symmetric by its theory.
    #[serde(skip_serializing_if = "Option::is_none")]
    antisymmetric_part: Option<f64>,
    #[serde(skip)]
    warnings: Vec<String>,
}

pub(crate) fn run(robot: Robot, args: &StiffnessArgs) -> Result<Stiffness> {
    let at_rest = state::equilibrium(robot, &args.state)?;
    let mut linearisation = state::linearisation(&args.model, at_rest.equilibrium.model);
    if args.model.cable_model.is_none() && args.at_hz == 0.0 {
        // The tangent of the static model, which the exact model has at rest, whatever the static model is.
        linearisation.cable_model = CableModel::CatenaryTangent;
    }
    if linearisation.cable_model == CableModel::CatenaryTangent && at_rest.equilibrium.model == StaticModel::Ideal {
        return Err(DynamicsError::Rigid.into());
    }
    let whole_tangent = Linearisation { cable_model: CableModel::CatenaryTangent, ..Linearisation::default() };
    let (robot, rest) = (&at_rest.robot, &at_rest.equilibrium);
    // Without a cable model the drag of the wind turns with the cables; a named one is that of vibration, with held drag.
    let turning = (linearisation == whole_tangent && args.model.cable_model.is_none())
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
            let (dynamics, warnings) = at_rest.dynamics(linearisation, args.at_hz)?;
            let matrix = exact.map(|tangent| tangent.map(|k| Complex::new(k, 0.0)));
            (matrix.unwrap_or_else(|| dynamics.stiffness(args.at_hz * TAU)), warnings)
        }
    };
    // `+ 0.0` makes a negative zero positive: the sign would mean nothing.
    let rows =
        |part: fn(&Complex) -> f64| std::array::from_fn(|i| std::array::from_fn(|j| part(&matrix[(i, j)]) + 0.0));
    Ok(Stiffness {
        robot: at_rest.robot.name.clone(),
        frequency_hz: args.at_hz,
        models: Models::of(&at_rest.equilibrium, linearisation),
        real: rows(|k| k.re),
        imag: rows(|k| k.im),
        antisymmetric_part,
        warnings,
    })
}

/// Wrench components and motions, in the order of rows and columns.
const WRENCH: [&str; 6] = ["fx", "fy", "fz", "mx", "my", "mz"];
const MOTION: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

fn unit(row: usize, column: usize) -> &'static str {
    match (row < 3, column < 3) {
        (true, true) => "N/m",
        (true, false) => "N/rad",
        (false, true) => "N m/m",
        (false, false) => "N m/rad",
    }
}

impl Results for Stiffness {
    const COMMAND: &'static str = "stiffness";

    fn robot(&self) -> &str {
        &self.robot
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn text(&self) -> String {
        let table = |rows: &[[f64; 6]; 6]| {
            let mut table =
                Table::new(&["", "x [1/m]", "y [1/m]", "z [1/m]", "rx [1/rad]", "ry [1/rad]", "rz [1/rad]"]);
            for (i, row) in rows.iter().enumerate() {
                let label = format!("{} [{}]", WRENCH[i], if i < 3 { "N" } else { "N m" });
                table.row(std::iter::once(label).chain(row.iter().map(|k| significant(*k, 6))).collect());
            }
            table.to_string()
        };
        let frequency =
            if self.frequency_hz == 0.0 { "at rest".to_owned() } else { format!("at {} Hz", self.frequency_hz) };
        let mut out = format!(
            "{}: stiffness {frequency}, about the platform origin, world axes\n{}\n\n",
            self.robot,
            self.models.line()
        );
        if let Some(part) = self.antisymmetric_part {
            let line = format!(
                "The drag of the wind turns with the cables: the matrix is not symmetric, its antisymmetric part is {} % of it \
                 (Frobenius norm, moments divided by the platform's size).\n\n",
                significant(100.0 * part, 3)
            );
            out += &line;
        }
        let is_real = self.imag.iter().flatten().all(|k| *k == 0.0);
        if is_real {
            out += &table(&self.real);
        } else {
            out += "Real part\n";
            out += &table(&self.real);
            out += "\nImaginary part (damping)\n";
            out += &table(&self.imag);
        }
        out
    }

    fn csv(&self, out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
        out.write_record(["row", "column", "unit", "real", "imag"])?;
        for (i, row) in WRENCH.iter().enumerate() {
            for (j, column) in MOTION.iter().enumerate() {
                out.serialize((row, column, unit(i, j), self.real[i][j], self.imag[i][j]))?;
            }
        }
        Ok(())
    }
}
