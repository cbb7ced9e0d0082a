//! Frequency of the platform on cables that follow it as at rest.

use super::{Dynamics, add_local};
use crate::math::{Mat6, symmetric};
use std::f64::consts::TAU;

impl Dynamics {
    /// Lowest natural frequency of the platform if each cable follows it in the shape of slow motion, with the share of
    /// its mass that then moves [Hz]. It changes continuously from pose to pose, also where the first mode of the
    /// platform veers with modes of the cables: its square is the mean of the squares of all natural frequencies,
    /// weighted by the kinetic energy that each mode has in this motion. So it is not below the lowest natural
    /// frequency.
    ///
    /// `None` if some motion has no mass or no positive stiffness. The mass of flexible supports is left out.
    ///
    /// # References
    /// docs/theory.md, equations (35d) and (35e).
    pub fn platform_frequency(&self) -> Option<f64> {
        self.platform_frequencies()?.first().copied()
    }

    /// All frequencies of the platform as [`platform_frequency`](Self::platform_frequency), one per degree of freedom,
    /// ascending [Hz].
    pub fn platform_frequencies(&self) -> Option<Vec<f64>> {
        let mut mass = self.mass;
        for term in &self.terms {
            add_local(&mut mass, term, &term.form.effective_mass(0.0));
        }

        // Rows beyond the coordinates of the platform are zero, and get a unit mass.
        let dof = self.dof();
        (dof..6).for_each(|k| mass[(k, k)] = 1.0);
        let factor = mass.cholesky()?;
        let half: Mat6 = factor.l().solve_lower_triangular(&self.dynamic_stiffness(0.0))?;
        let whole: Mat6 = factor.l().solve_lower_triangular(&half.transpose())?;
        let squares = symmetric::eigenvalues(&whole, dof);
        squares.iter().all(|square| *square > 0.0).then(|| squares.iter().map(|square| square.sqrt() / TAU).collect())
    }
}
