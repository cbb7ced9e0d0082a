//! Deviation of the platform's position in the direction in which it is largest.

use crate::rows::rows;
use crate::text::significant;
use funicular::math::{Mat3, symmetric};

rows! {
    /// Deviation of the position of the platform origin.
    #[derive(Debug, Clone, Copy)]
    pub struct PositionDeviation {
        /// Standard deviation along the direction in which it is largest.
        pub deviation_m: f64;
        /// Direction of the largest deviation, world axes.
        pub direction: [f64; 3];
        /// Covariance of the position, world axes.
        pub covariance_m2: [[f64; 3]; 3];
    }
}

impl PositionDeviation {
    /// Deviation of a linear position from the changes of its coordinates by independent numbers: a row of changes for
    /// each of these axes. `None` if nothing deviates.
    pub(super) fn of_contributions(axes: &[usize], changes: &[Vec<f64>]) -> Option<Self> {
        let mut covariance = Mat3::zeros();
        for (i, first) in axes.iter().zip(changes) {
            for (j, second) in axes.iter().zip(changes) {
                covariance[(*i, *j)] = first.iter().zip(second).map(|(a, b)| a * b).sum();
            }
        }
        Self::of(covariance)
    }

    /// Deviation of the positions of sampled robots; those without a position are left out.
    pub(super) fn of_samples(axes: &[usize], values: &[Vec<f64>]) -> Option<Self> {
        let robots = values.first().map_or(0, Vec::len);
        let found: Vec<usize> = (0..robots).filter(|k| values.iter().all(|of| of[*k].is_finite())).collect();
        let count = found.len() as f64;
        if found.len() < 2 {
            return None;
        }
        let centred = |of: &Vec<f64>| {
            let mean = found.iter().map(|k| of[*k]).sum::<f64>() / count;
            found.iter().map(|k| (of[*k] - mean) / (count - 1.0).sqrt()).collect()
        };
        let changes: Vec<Vec<f64>> = values.iter().map(centred).collect();
        Self::of_contributions(axes, &changes)
    }

    fn of(covariance: Mat3) -> Option<Self> {
        let (variance, direction) = symmetric::largest_principal(&covariance);
        (variance > 0.0).then(|| Self {
            deviation_m: variance.sqrt(),
            direction: direction.map(|component| component + 0.0).into(),
            covariance_m2: [0, 1, 2].map(|i| [0, 1, 2].map(|j| covariance[(i, j)] + 0.0)),
        })
    }

    /// Deviation with its direction, as part of a sentence.
    pub fn told(&self) -> String {
        let [x, y, z] = self.direction.map(|component| significant(component, 2));
        format!("{} mm along ({x}, {y}, {z})", significant(1e3 * self.deviation_m, 3))
    }
}
