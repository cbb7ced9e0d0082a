//! Error of a simulation: a bound from its difference from a finer run.

use super::Simulated;
use super::rows::SimulatedRow;
use crate::columns::column;
use crate::rows::rows;
use crate::text::significant;
use funicular::math::Vec3;
use funicular::simulation::ElementMesh;

rows! {
    /// Bound of the error of one column: its difference from a finer run times a factor of the mesh (97k2).
    pub struct ColumnError in tables() {
        /// Column of the result.
        ///
        /// `position_m`, `velocity_m_s`, `clearance_margin_m`, or `tension_platform_NAME_n` and
        /// `tension_anchor_NAME_n`.
        pub column: String => one.plain("column");
        /// Bound of the largest error.
        pub largest: f64 => one.unit("").significant("largest", 2);
        /// Root mean square.
        pub root_mean_square: f64 => one.unit("").significant("r.m.s.", 2);
        /// Root mean square over that of the column.
        ///
        /// Absent for positions and distances.
        pub relative: Option<f64> => one.significant("relative", 2);
    }
}

rows! {
    /// Largest tension of a cable at either end, and root mean square of that at the platform.
    pub struct Peak in tables() {
        /// Name of the cable.
        pub cable: String => one.plain("cable");
        /// Largest tension.
        pub peak_n: f64 => one.significant("largest tension", 4);
        pub root_mean_square_n: f64;
        /// Largest tension of the finer run.
        ///
        /// Value of the finer run.
        pub finer_peak_n: Option<f64>
            => one.significant("finer run", 4)
            => column("root_mean_square_n", "N", "root mean square", |row: &Self| row.root_mean_square_n)
                .significant("r.m.s.", 4);
        /// Root mean square of the finer run.
        pub finer_root_mean_square_n: Option<f64> => one.significant("finer run", 4);
    }
}

/// Tensions of all cables at one of their ends in a row.
type TensionsOfRow = fn(&SimulatedRow) -> &[f64];

fn root_mean_square(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count().max(1) as f64;
    (values.map(|value| value * value).sum::<f64>() / count).sqrt()
}

/// Error of a run over its difference from the run with the finer mesh, by Richardson's rule: with errors `e` and
/// `e/r`, r being the ratio of the distances of the nodes, the difference is `e (1 − 1/r)`, which is less than e.
/// Errors that fall faster leave a larger part of e as the difference, and are bounded too. The first power is the
/// least that was seen, after a release on eight elements of degree one, which leave out the waves that jump; the
/// standard elements had the third.
///
/// # References
/// docs/theory.md, equation (97k2).
fn error_per_difference(mesh: ElementMesh) -> f64 {
    let ratio = mesh.finer().elements as f64 / mesh.elements as f64;
    1.0 / (1.0 - 1.0 / ratio)
}

/// Errors of the columns of a run on this mesh, and peaks of the tensions.
pub(super) fn errors(
    cables: &[String],
    rows: &[SimulatedRow],
    finer: Option<&[SimulatedRow]>,
    mesh: ElementMesh,
) -> (Vec<ColumnError>, Vec<Peak>) {
    let peaks = (0..cables.len()).map(|i| Peak {
        cable: cables[i].clone(),
        peak_n: peak(rows, i),
        root_mean_square_n: effective(rows, i),
        finer_peak_n: finer.map(|finer| peak(finer, i)),
        finer_root_mean_square_n: finer.map(|finer| effective(finer, i)),
    });
    let Some(finer) = finer else { return (Vec::new(), peaks.collect()) };

    let factor = error_per_difference(mesh);
    let vector = |column: &str, of: fn(&SimulatedRow) -> [f64; 3]| {
        let off = rows.iter().zip(finer).map(move |(a, b)| factor * (Vec3::from(of(a)) - Vec3::from(of(b))).norm());
        error(column.to_owned(), off, None)
    };
    let mut errors = vec![
        vector("position_m", |row| row.motion.pose.position_m),
        vector("velocity_m_s", |row| row.motion.velocity_m_s),
        vector("angular_velocity_rad_s", |row| row.motion.angular_velocity_rad_s),
    ];
    let margins = rows.iter().zip(finer).filter_map(|(a, b)| Some((a.clearance_margin_m?, b.clearance_margin_m?)));
    if margins.clone().next().is_some() {
        errors.push(error("clearance_margin_m".to_owned(), margins.map(|(a, b)| factor * (a - b).abs()), None));
    }
    let ends: [(&str, TensionsOfRow); 2] =
        [("platform", |row| &row.tensions_platform_n), ("anchor", |row| &row.tensions_anchor_n)];
    for (end, of) in ends {
        for (i, name) in cables.iter().enumerate() {
            let off = rows.iter().zip(finer).map(|(a, b)| factor * (of(a)[i] - of(b)[i]).abs());
            let size = root_mean_square(finer.iter().map(|row| of(row)[i]));
            errors.push(error(format!("tension_{end}_{name}_n"), off, Some(size)));
        }
    }
    (errors, peaks.collect())
}

fn error(column: String, off: impl Iterator<Item = f64> + Clone, size: Option<f64>) -> ColumnError {
    let root_mean_square = root_mean_square(off.clone());
    let relative = size.filter(|size| *size > 0.0).map(|size| root_mean_square / size);
    ColumnError { column, largest: off.fold(0.0, f64::max), root_mean_square, relative }
}

fn peak(rows: &[SimulatedRow], i: usize) -> f64 {
    rows.iter().map(|row| row.tensions_platform_n[i].max(row.tensions_anchor_n[i])).fold(0.0, f64::max)
}

fn effective(rows: &[SimulatedRow], i: usize) -> f64 {
    root_mean_square(rows.iter().map(|row| row.tensions_platform_n[i]))
}

impl Simulated {
    /// Sentence on the error of the result.
    pub fn error_in_words(&self) -> String {
        let Some(position) = self.errors.iter().find(|of| of.column == "position_m") else {
            return "The error is not known, because no finer run came to its end.".to_owned();
        };
        let worst = self.errors.iter().filter_map(|of| of.relative).fold(0.0, f64::max);
        let statistics = if self.is_statistical {
            " Cables go slack: peaks and root mean squares of the tensions after that are statistics."
        } else {
            ""
        };
        format!(
            "The error is at most {} mm in position and {} % (root mean square) of a tension, by a run with a finer \
             mesh and tolerance.{statistics}",
            significant(1e3 * position.largest, 2),
            significant(100.0 * worst, 2)
        )
    }
}
