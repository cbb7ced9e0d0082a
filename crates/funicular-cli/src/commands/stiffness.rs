//! `stiffness`: text and CSV.

use crate::output::Printed;
use crate::table::{Table, significant};
use funicular_study::analyses::stiffness::{Stiffness, WRENCH};

/// Rounding of an entry over the stiffness of its row and column. Sums over some ten cables leave 1e-15; the observed
/// rounding is 1e-16.
const ROUNDING: f64 = 1e-13;

/// Entry without its rounding: zero if it is tiny against the diagonal of its row and column, `√(K_ii K_jj)`, which has
/// its unit.
fn without_rounding(entry: f64, stiffness: &[[f64; 6]; 6], i: usize, j: usize) -> f64 {
    let scale = (stiffness[i][i] * stiffness[j][j]).abs().sqrt();
    if entry.abs() < ROUNDING * scale { 0.0 } else { entry }
}

impl Printed for Stiffness {
    fn text(&self) -> String {
        let table = |rows: &[[f64; 6]; 6]| {
            let mut table = Table::new(&[
                "",
                "per x [m]",
                "per y [m]",
                "per z [m]",
                "per rx [rad]",
                "per ry [rad]",
                "per rz [rad]",
            ]);
            for (i, row) in rows.iter().enumerate() {
                let label = format!("{} [{}]", WRENCH[i], if i < 3 { "N" } else { "N m" });
                let cells = row.iter().enumerate().map(|(j, k)| significant(without_rounding(*k, &self.real, i, j), 6));
                table.row(std::iter::once(label).chain(cells).collect());
            }
            table.to_string()
        };
        let quantity = if self.frequency_hz == 0.0 {
            "static stiffness".to_owned()
        } else {
            format!("stiffness at {} Hz", self.frequency_hz)
        };
        let mut out =
            format!("{}: {quantity}, about the platform origin, world axes\n{}\n\n", self.robot, self.models.line());

        if let Some(part) = self.antisymmetric_fraction {
            let line = format!(
                "The drag of the wind turns with the cables: the matrix is not symmetric, its antisymmetric part is {} \
                 % of it (Frobenius norm, moments divided by the platform's size).\n\n",
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
}
