//! Fit of the platform to the nine frequencies that Table III of the paper prints for its two static models.

use super::pose::lengths;
use super::published::{SPRING, STATIC_SAG};
use funicular::cable::CableModel;
use funicular::dynamics::{Assembly, Dynamics, Linearisation};
use funicular::math::least_squares::{LeastSquaresProblem, Minimum, minimise, precision};
use funicular::math::{DMat, Mat3, Vec3};
use funicular::modes;
use funicular::robot::{Robot, WinchMode};
use funicular::statics::{self, StaticModel};
use std::f64::consts::LN_10;

/// Deviation of a printed tenth [Hz]: that of a uniform distribution over ± 0.05 Hz, 0.1/√12.
const PRINTED_HZ: f64 = 0.03;

/// Deviation of the centre of mass beforehand [m], x, y and z: the attachments lie within 0.15 m of the origin.
const CENTER_M: [f64; 3] = [0.03, 0.03, 0.06];

/// Radius of the second moments beforehand [m], and the deviation of its logarithm.
const RADIUS_M: f64 = 0.1;
const LOG_RADIUS: f64 = 0.8;

/// Upper limit of the lists of modes [Hz]: the fifth frequency of the spring model lies below.
const BELOW_HZ: f64 = 40.0;

/// Step of the central differences in the dimensionless unknowns: frequencies are converged to 1e-9 of themselves.
const STEP: f64 = 1e-4;

/// Bounds of an unknown with a prior, in deviations.
const BOUND: f64 = 6.0;

/// Bounds of the mass [kg].
const MASS_KG: (f64, f64) = (2.0, 300.0);

/// Number of unknowns: logarithm of the mass, centre of mass, logarithms of the three radii, three correlations.
const UNKNOWNS: usize = 10;

/// Platform: mass, centre of mass, and inertia tensor about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Platform {
    pub(super) mass: f64,
    pub(super) center_p: Vec3,
    pub(super) inertia_p: Mat3,
}

impl Platform {
    /// Second moments per mass `∫ x xᵀ dm / m` about the centre of mass: ½ tr(I) − I.
    fn moments(&self) -> Mat3 {
        (Mat3::identity() * (0.5 * self.inertia_p.trace()) - self.inertia_p) / self.mass
    }

    /// Dimensionless unknowns: radii √(∫ x² dm / m) along the three axes, and the correlations of their products, that
    /// of y and z at given x. A tensor of any unknowns is that of a body.
    fn unknowns(&self) -> [f64; UNKNOWNS] {
        let moments = self.moments();
        let radii = [0, 1, 2].map(|i| moments[(i, i)].sqrt());
        let [xy, xz, yz] = [(0, 1), (0, 2), (1, 2)].map(|(i, j)| moments[(i, j)] / (radii[i] * radii[j]));
        let at_x = (yz - xy * xz) / ((1.0 - xy * xy) * (1.0 - xz * xz)).sqrt();
        let center = [0, 1, 2].map(|i| self.center_p[i] / CENTER_M[i]);
        let [rx, ry, rz] = radii.map(|radius| (radius / RADIUS_M).ln() / LOG_RADIUS);
        [self.mass.ln(), center[0], center[1], center[2], rx, ry, rz, xy.atanh(), xz.atanh(), at_x.atanh()]
    }

    fn at(x: &[f64]) -> Self {
        let (mass, center_p) = (x[0].exp(), Vec3::from_fn(|i, _| x[1 + i] * CENTER_M[i]));
        let radii = Vec3::from_fn(|i, _| RADIUS_M * (x[4 + i] * LOG_RADIUS).exp());
        let [xy, xz, at_x] = [x[7], x[8], x[9]].map(f64::tanh);
        // Rows of a triangular root of the correlations.
        let [of_xy, of_xz, of_x] = [xy, xz, at_x].map(|s| (1.0 - s * s).sqrt());
        let root = Mat3::new(1.0, 0.0, 0.0, xy, of_xy, 0.0, xz, at_x * of_xz, of_xz * of_x);
        let root = Mat3::from_diagonal(&radii) * root;
        let moments = root * root.transpose() * mass;
        Self { mass, center_p, inertia_p: Mat3::identity() * moments.trace() - moments }
    }

    /// Radii of gyration about the three axes √(I/m) [m].
    fn radii_of_gyration(&self) -> [f64; 3] {
        [0, 1, 2].map(|i| (self.inertia_p[(i, i)] / self.mass).sqrt())
    }
}

/// Fit of one cable set.
#[derive(Debug, Clone)]
pub(super) struct Fit {
    pub(super) platform: Platform,
    /// Sum of the squares of the nine differences, in deviations of a printed tenth.
    pub(super) chi2: f64,
    /// Sum of the squares of all differences, those from the priors included.
    pub(super) chi2_with_priors: f64,
    /// Deviations of mass [kg], centre of mass [m] and radii of gyration [m].
    pub(super) mass_std: f64,
    pub(super) center_std: [f64; 3],
    pub(super) gyration_std: [f64; 3],
    /// Radii of gyration about the axes of the platform [m].
    pub(super) gyration: [f64; 3],
    /// Number of combinations of the ten unknowns that the priors determine more than the nine frequencies.
    pub(super) undetermined: usize,
    /// Decimal logarithm of the probability of the nine frequencies for this cable set, up to a constant that both sets
    /// share; by Laplace's approximation.
    pub(super) evidence: f64,
}

/// The nine frequencies as functions of the platform.
struct Nine<'a> {
    robot: &'a Robot,
}

impl Nine<'_> {
    /// Frequencies of the spring model, then of the shallow-static one. `None` without equilibrium.
    fn frequencies(&self, platform: &Platform) -> Option<Vec<f64>> {
        let mut robot = self.robot.clone();
        robot.platform.mass = platform.mass;
        robot.platform.center_of_mass_p = platform.center_p;
        robot.platform.inertia_p = platform.inertia_p;
        let rest = statics::forward(&robot, &lengths(&robot), StaticModel::Catenary, None).ok()?;
        let mut found = Vec::with_capacity(SPRING.len() + STATIC_SAG.len());
        for (cable_model, count) in [(CableModel::Spring, SPRING.len()), (CableModel::ShallowStatic, STATIC_SAG.len())]
        {
            let linearisation = Linearisation {
                cable_model,
                assembly: Assembly::WithoutGeometricStiffness,
                in_plane_only: true,
                winches: WinchMode::AsGiven,
            };
            let dynamics = Dynamics::about(&robot, &rest, linearisation, BELOW_HZ).ok()?;
            let modes = modes::below(&dynamics, BELOW_HZ).modes;
            found.extend(modes.get(..count)?.iter().map(|mode| mode.frequency_hz));
        }
        Some(found)
    }
}

impl LeastSquaresProblem for Nine<'_> {
    fn residuals(&mut self, x: &[f64]) -> Option<Vec<f64>> {
        let printed = SPRING.iter().chain(&STATIC_SAG);
        let found = self.frequencies(&Platform::at(x))?;
        let of_lists = found.iter().zip(printed).map(|(ours, printed)| (ours - printed) / PRINTED_HZ);
        // Nothing is known of the mass. A correlation has the prior tanh of 0 ± 1.
        Some(of_lists.chain(x[1..].iter().copied()).collect())
    }

    fn linearised(&mut self, x: &[f64]) -> Option<(Vec<f64>, DMat)> {
        let residuals = self.residuals(x)?;
        let mut jacobian = DMat::zeros(residuals.len(), x.len());
        for k in 0..x.len() {
            let mut moved = [x.to_vec(), x.to_vec()];
            moved[0][k] -= STEP;
            moved[1][k] += STEP;
            let [before, after] = [self.residuals(&moved[0])?, self.residuals(&moved[1])?];
            for (row, (before, after)) in before.iter().zip(&after).enumerate() {
                jacobian[(row, k)] = (after - before) / (2.0 * STEP);
            }
        }
        Some((residuals, jacobian))
    }
}

/// Fits the platform of a cable set to the nine frequencies, from a start. `None` without an equilibrium there.
pub(super) fn fit(robot: &Robot, start: &Platform) -> Option<Fit> {
    let mut bounds = [(-BOUND, BOUND); UNKNOWNS];
    bounds[0] = (MASS_KG.0.ln(), MASS_KG.1.ln());
    let found = minimise(&mut Nine { robot }, &start.unknowns(), &bounds, 100)?;
    Some(fit_with_precision(&found))
}

fn fit_with_precision(found: &Minimum) -> Fit {
    let platform = Platform::at(&found.x);
    let count = SPRING.len() + STATIC_SAG.len();

    let all = precision(&found.jacobian, &[1.0; UNKNOWNS]);
    let deviation = |by: &[f64; UNKNOWNS]| {
        let entries = (0..UNKNOWNS).flat_map(|i| (0..UNKNOWNS).map(move |j| (i, j)));
        entries.map(|(i, j)| by[i] * all.covariance[(i, j)] * by[j]).sum::<f64>().sqrt()
    };

    let unit = |k: usize, size: f64| {
        let mut by = [0.0; UNKNOWNS];
        by[k] = size;
        by
    };

    let gyration_by = |axis: usize| -> [f64; UNKNOWNS] {
        std::array::from_fn(|k| {
            let [before, after] = [-STEP, STEP].map(|step| {
                let mut x = found.x.clone();
                x[k] += step;
                Platform::at(&x).radii_of_gyration()[axis]
            });
            (after - before) / (2.0 * STEP)
        })
    };

    let alone = precision(&found.jacobian.rows(0, count).into_owned(), &[1.0; UNKNOWNS]);

    // ∫ exp(−χ²/2) is exp(−χ²/2) at the minimum times √det(2π C), and det C the inverse product of the squares.
    let log_volume: f64 = -all.directions.iter().map(|(value, _)| value.ln()).sum::<f64>();

    Fit {
        platform,
        chi2: found.residuals[..count].iter().map(|r| r * r).sum(),
        chi2_with_priors: found.chi2(),
        mass_std: deviation(&unit(0, platform.mass)),
        center_std: [0, 1, 2].map(|i| deviation(&unit(1 + i, CENTER_M[i]))),
        gyration_std: [0, 1, 2].map(|axis| deviation(&gyration_by(axis))),
        gyration: platform.radii_of_gyration(),
        undetermined: alone.directions.iter().filter(|(value, _)| *value < 1.0).count(),
        evidence: (log_volume - 0.5 * found.chi2()) / LN_10,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_platform_is_the_one_of_its_unknowns() {
        let inertia_p = Mat3::new(0.1934, -0.0146, 0.016, -0.0146, 0.1513, -0.0002, 0.016, -0.0002, 0.1798);
        let platform = Platform { mass: 17.76, center_p: Vec3::new(-0.0169, 0.0194, -0.0039), inertia_p };
        let again = Platform::at(&platform.unknowns());
        assert!((again.mass - platform.mass).abs() < 1e-12 && (again.center_p - platform.center_p).norm() < 1e-15);
        assert!((again.inertia_p - inertia_p).norm() < 1e-13);
        // Any unknowns are a body: its second moments are positive definite.
        let any = Platform::at(&[2.0, 0.3, -1.0, 0.2, 1.0, -2.0, 0.5, 2.0, -1.5, 3.0]);
        assert!(any.moments().cholesky().is_some());
    }
}
