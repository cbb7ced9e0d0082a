//! One search from one start, and its result in the list of starts.

use crate::rows::rows;
use funicular::math::least_squares::{LeastSquaresEnding, Minimum};

/// Maximum number of iterations of one search.
pub(super) const MAX_ITERATIONS: usize = 60;

rows! {
    /// Result of one start.
    #[derive(Debug, Clone)]
    pub struct StartRow {
        /// χ² per degree of freedom at its end; absent if the robot has no equilibrium there.
        pub chi2_per_degree: Option<f64>;
        /// Iterations.
        pub iterations: usize;
        /// True if the search ended at a minimum.
        pub converged: bool;
    }
}

impl StartRow {
    /// Start without an equilibrium.
    pub(super) fn refused() -> Self {
        Self { chi2_per_degree: None, iterations: 0, converged: false }
    }

    pub(super) fn of(found: &Minimum, degrees: f64) -> Self {
        Self {
            chi2_per_degree: Some(found.chi2() / degrees),
            iterations: found.iterations,
            converged: found.ending == LeastSquaresEnding::Converged,
        }
    }
}
