//! Minimum eigenvalue of the stiffness about given tensions, to second order, and the step to its maximum.
//!
//! With the r lowest eigenvectors Q, the balanced tensions `τ + N z` have to second order the minimum eigenvalue
//! `λ_min(S(z)) + ½ zᵀ H z`. S is the r×r matrix `Qᵀ K Q`, affine in z; H contains the curvature of the cables, that of
//! the balance, and the other eigenvectors. With r = 1 this is the Taylor series; a larger r keeps it valid where
//! eigenvalues meet.

use super::super::null_space::Solutions;
use super::super::search::{Linear, TensionSearch};
use crate::math::active_set::Polyhedron;
use crate::math::{DMat, Mat6, Vec6};
use crate::statics::wrench_set::{CableAtPose, Rates};

/// Relative distance from the minimum eigenvalue within which eigenvalues are kept together with it.
const NEAR: f64 = 0.08;

/// Minimum ratio of a cable's tension after a step to that before: the model does not know how soft slack cables are.
const FALL: f64 = 0.3;

/// Maximum number of cuts of a step in which eigenvalues meet.
const MAX_CUTS: usize = 40;

/// Strength by which the height of a cut is held back, relative to the promised gain. Its inverse is the far point, and
/// the rounding of the far point must also be small compared with the height.
const HOLD: f64 = 1e-4;

/// Motions of the platform whose stiffness makes up the minimum eigenvalue, with weights that sum to one.
pub(super) type Weights = Vec<(f64, Vec6)>;

/// Step of the tensions.
pub(super) struct StiffeningStep {
    /// Change of every tension that restores the balance [N], …
    pub restoring: Vec<f64>,
    /// … and the further change that increases the stiffness.
    pub stiffening: Vec<f64>,
    /// Growth of the minimum eigenvalue.
    pub gain: f64,
    /// Composition of the minimum eigenvalue at the end of the step.
    pub weights: Weights,
}

/// Best point of the cuts so far.
struct Cut {
    /// Gain of stiffness.
    reached: f64,
    u: Vec<f64>,
    /// Active cuts: multiplier and index.
    holding: Vec<(f64, usize)>,
}

/// Model of the minimum eigenvalue about the present tensions.
pub(super) struct Model {
    linear: Linear,
    solutions: Solutions,
    /// Present tensions …
    tau: Vec<f64>,
    /// … and the nearest ones that hold the platform, to first order.
    balanced: Vec<f64>,
    values: Vec<f64>,
    vectors: Vec<Vec6>,
    rates: Vec<Rates>,
    /// Products `K' q` for each of the lowest eigenvectors q and each cable.
    turned: Vec<Vec<Vec6>>,
    /// Matrix S at the balanced tensions, …
    block: DMat,
    /// … and its derivatives along the directions of the balance.
    block_by_z: Vec<DMat>,
    /// Minimum eigenvalue at the balanced tensions.
    pub value: f64,
    /// Rounding of this value.
    pub rounding: f64,
}

impl Model {
    /// Model at the present tensions; `None` at a singular pose.
    pub(super) fn here(
        search: &TensionSearch<'_>,
        stiffness: &Mat6,
        (values, vectors): (Vec<f64>, Vec<Vec6>),
    ) -> Option<Self> {
        let motion = &search.robot().platform.motion;
        let linear = search.linearise();
        let tau = search.tensions();
        let solutions = search.solutions(&linear, &vec![1.0; tau.len()]).ok()?;
        let balanced = solutions.at(&solutions.along(|i| tau[i]));

        // Eigenvalues near the lowest.
        let rounding = 1e-13 * stiffness.amax();
        let near = values[0] + NEAR * values[0].abs() + rounding;
        let count = values.iter().take_while(|value| **value <= near).count();

        // Products of these motions with the stiffness of the cables, per tension.
        let rates: Vec<Rates> = search.cables().iter().map(CableAtPose::rates).collect();
        let turned: Vec<Vec<Vec6>> = vectors[..count]
            .iter()
            .map(|q| {
                let displacement = motion.expanded(q);
                let cables = search.cables().iter().zip(&rates);
                cables.map(|(cable, rates)| motion.reduced(&cable.applied(&rates.first, &displacement))).collect()
            })
            .collect();

        let form = |sum: &dyn Fn(&[Vec6]) -> Vec6| {
            let columns: Vec<Vec6> = turned.iter().map(|turned| sum(turned)).collect();
            DMat::from_fn(count, count, |a, b| vectors[a].dot(&columns[b]))
        };

        // Block of these eigenvectors at the balanced tensions, and its derivatives along the directions.
        let moved = form(&|turned| (0..tau.len()).map(|i| turned[i] * (balanced[i] - tau[i])).sum());
        let block = DMat::from_fn(count, count, |a, b| if a == b { values[a] } else { 0.0 }) + moved;
        let block_by_z = (0..solutions.redundancy())
            .map(|k| {
                form(&|turned| turned.iter().enumerate().map(|(i, turned)| turned * solutions.direction(k)[i]).sum())
            })
            .collect();

        let value = lowest(&block).0;
        Some(Self {
            linear,
            solutions,
            tau,
            balanced,
            values,
            vectors,
            rates,
            turned,
            block,
            block_by_z,
            value,
            rounding,
        })
    }

    /// Composition of the minimum eigenvalue here, from its composition at the end of the last step.
    pub(super) fn weights(&self, last: Option<&Weights>) -> Weights {
        let mut weights: Weights = Vec::new();
        for (weight, displacement) in last.into_iter().flatten() {
            let kept: Vec6 = self.components(displacement).iter().zip(&self.vectors).map(|(x, q)| q * *x).sum();
            let size = kept.norm();
            if size > 0.5 {
                weights.push((*weight, kept / size));
            }
        }
        let sum: f64 = weights.iter().map(|(weight, _)| weight).sum();
        if self.turned.len() == 1 || sum < 0.5 || sum.is_nan() {
            return vec![(1.0, self.vectors[0])];
        }
        for (weight, _) in &mut weights {
            *weight /= sum;
        }
        weights
    }

    /// Components of a motion along the kept eigenvectors.
    fn components(&self, displacement: &Vec6) -> Vec<f64> {
        self.vectors.iter().take(self.turned.len()).map(|q| q.dot(displacement)).collect()
    }

    /// Matrix H for a minimum eigenvalue with this composition.
    fn curvature(&self, search: &TensionSearch<'_>, weights: &Weights) -> DMat {
        let d = self.solutions.redundancy();
        let kept = self.turned.len();
        let mut curvature = DMat::zeros(d, d);
        for (weight, displacement) in weights {
            let components = self.components(displacement);
            let turned: Vec<Vec6> = (0..self.tau.len())
                .map(|i| components.iter().zip(&self.turned).map(|(x, turned)| turned[i] * *x).sum())
                .collect();
            let displacement: Vec6 = components.iter().zip(&self.vectors).map(|(x, q)| q * *x).sum();

            let bends = self.bends(search, &displacement, &turned);

            // Contribution of the other eigenvectors: −2 bbᵀ over the gap.
            let others: Vec<(f64, Vec<f64>)> = (kept..self.values.len())
                .map(|j| {
                    let gap = self.values[j] - self.values[0];
                    let by_cable: Vec<f64> = turned.iter().map(|turned| turned.dot(&self.vectors[j])).collect();
                    (-2.0 / gap, self.solutions.along(|i| by_cable[i]))
                })
                .collect();

            for k in 0..d {
                for l in 0..=k {
                    let (n, m) = (self.solutions.direction(k), self.solutions.direction(l));
                    let own: f64 = bends.iter().zip(n).zip(m).map(|((bend, n), m)| bend * n * m).sum();
                    let given: f64 = others.iter().map(|(factor, b)| factor * b[k] * b[l]).sum();
                    curvature[(k, l)] += weight * (own + given);
                }
            }
        }
        curvature.fill_upper_triangle_with_lower_triangle();
        curvature
    }

    /// Second derivative of a motion's stiffness with respect to every tension. The multipliers of the balance turn its
    /// curvature, which takes the tensions off the directions, into stiffness.
    fn bends(&self, search: &TensionSearch<'_>, displacement: &Vec6, turned: &[Vec6]) -> Vec<f64> {
        let motion = &search.robot().platform.motion;
        let expanded = motion.expanded(displacement);
        let multipliers = self.solutions.multipliers(|i| turned[i].dot(displacement));
        let cables = search.cables().iter().zip(&self.rates);
        cables
            .map(|(cable, rates)| {
                let stiffness = cable.applied(&rates.second, &expanded).dot(&expanded);
                stiffness - motion.reduced(&cable.wrench(&rates.second.force_w)).dot(&multipliers)
            })
            .collect()
    }

    /// Step to the tensions within the linearised limits at which the model is maximum, H taken with `weights`; `None`
    /// if there are no such tensions.
    ///
    /// Along the scaled eigenvectors of H, `½ zᵀ H z` is a distance, and the step a projection on a polyhedron. Along a
    /// convex direction the step is as long as along a concave one of the same curvature.
    pub(super) fn step(&self, search: &TensionSearch<'_>, weights: &Weights) -> Option<StiffeningStep> {
        let d = self.solutions.redundancy();
        let slope = DMat::from_fn(d, 1, |k, _| self.block_by_z[k][(0, 0)]);

        // Eigenvectors of H, scaled.
        let eigen = self.curvature(search, weights).symmetric_eigen();
        let flat = slope.norm() / search.size();
        let unit = eigen.eigenvalues.amax().max(1e-6 * flat).max(f64::MIN_POSITIVE);
        let mut turn = eigen.eigenvectors;
        for (mut column, value) in turn.column_iter_mut().zip(&eigen.eigenvalues) {
            column /= (value.abs() / unit).max(1e-6).sqrt();
        }

        // The limits.
        let tolerance = search.tolerance(&self.solutions);
        let one = self.turned.len() == 1;
        let mut set = Polyhedron::new(if one { d } else { d + 1 });
        for (i, [lower, upper]) in self.linear.limits.iter().enumerate() {
            let normal = DMat::from_iterator(1, d, self.solutions.part(i).copied()) * &turn;
            let last = (!one).then_some(0.0);
            let least = lower.at.max(search.cables()[i].slackest).max(FALL * self.tau[i]);
            set.add(normal.iter(), 1.0, last, least - self.balanced[i]);
            set.add(normal.iter(), -1.0, last, self.balanced[i] - upper.at);
        }

        // The step.
        let free = turn.tr_mul(&slope) / unit;
        let (u, weights) = if one {
            let mut u: Vec<f64> = free.iter().copied().collect();
            set.nearest(&mut u, tolerance)?;
            (u, vec![(1.0, self.vectors[0])])
        } else {
            self.meeting(&mut set, &turn, unit, free.norm_squared(), tolerance)?
        };

        // Gain, and the tensions at the end.
        let u = DMat::from_vec(d, 1, u);
        let z = &turn * &u;
        let gain = lowest(&self.block_at(z.as_slice())).0 - self.value - 0.5 * unit * u.norm_squared();
        let restoring = self.balanced.iter().zip(&self.tau).map(|(to, from)| to - from).collect();
        let stiffening = (0..self.tau.len()).map(|i| self.solutions.part(i).zip(z.iter()).map(|(n, z)| n * z).sum());
        Some(StiffeningStep { restoring, stiffening: stiffening.collect(), gain, weights })
    }

    /// Matrix S at these components along the directions.
    fn block_at(&self, z: &[f64]) -> DMat {
        self.block_by_z.iter().zip(z).fold(self.block.clone(), |sum, (by_z, z)| sum + by_z * *z)
    }

    /// Maximum of `λ_min(S) − ½ unit |u|²` by cuts: each motion x bounds λ_min from above by `xᵀ S x`.
    ///
    /// The height t of the cuts is one more unknown, scaled and drawn to a far point. It is held back a little, which
    /// shortens steps by as little.
    fn meeting(
        &self,
        set: &mut Polyhedron,
        turn: &DMat,
        unit: f64,
        size_squared: f64,
        tolerance: f64,
    ) -> Option<(Vec<f64>, Weights)> {
        let (d, kept) = (self.block_by_z.len(), self.turned.len());
        let spread = (self.block[(kept - 1, kept - 1)] - self.value).abs() / unit;
        let scale = (HOLD / (size_squared + spread).max(f64::MIN_POSITIVE)).sqrt();

        // One cut for each motion.
        let limits = set.len();
        let mut cuts: Vec<Vec6> = Vec::new();
        let mut add = |set: &mut Polyhedron, x: &DMat| {
            let by_z = DMat::from_fn(1, d, |_, k| (x.transpose() * &self.block_by_z[k] * x)[0]);
            let level = (x.transpose() * &self.block * x)[0] - self.value;
            // unit/scale s ≤ level + by_u · u, over the length of its normal.
            let by_u = by_z * turn;
            let height = unit / scale;
            let length = (by_u.norm_squared() + height * height).sqrt();
            set.add((by_u / length).iter(), 1.0, Some(-height / length), -level / length);
            cuts.push(x.iter().zip(&self.vectors).map(|(x, q)| q * *x).sum());
        };

        for a in 0..kept {
            add(set, &DMat::from_fn(kept, 1, |b, _| if a == b { 1.0 } else { 0.0 }));
        }

        let mut best: Option<Cut> = None;
        for _ in 0..MAX_CUTS {
            let mut point = vec![0.0; d];
            point.push(1.0 / scale);

            // Point under all cuts.
            let held = set.nearest(&mut point, tolerance)?;
            let promised = point.pop()? * unit / scale;
            let u = DMat::from_vec(d, 1, point);

            // Value of the model there.
            let (value, x) = lowest(&self.block_at((turn * &u).as_slice()));
            let distance = 0.5 * unit * u.norm_squared();
            let reached = value - self.value - distance;
            if best.as_ref().is_none_or(|best| reached > best.reached) {
                let holding = held.iter().filter(|held| held.row >= limits);
                let holding = holding.map(|held| (held.multiplier, held.row - limits)).collect();
                best = Some(Cut { reached, u: u.as_slice().to_vec(), holding });
            }

            let most = best.as_ref().map_or(reached, |best| best.reached);
            if promised - distance - most <= 1e-3 * most + self.rounding {
                break;
            }
            add(set, &x);
        }
        let Cut { u, holding, .. } = best?;
        let sum: f64 = holding.iter().map(|(multiplier, _)| multiplier).sum();
        Some((u, holding.into_iter().map(|(multiplier, cut)| (multiplier / sum, cuts[cut])).collect()))
    }
}

/// Minimum eigenvalue of a symmetric matrix and its eigenvector.
fn lowest(matrix: &DMat) -> (f64, DMat) {
    if matrix.nrows() == 1 {
        return (matrix[0], DMat::identity(1, 1));
    }
    let eigen = matrix.clone().symmetric_eigen();
    let at = eigen.eigenvalues.imin();
    (eigen.eigenvalues[at], DMat::from_column_slice(matrix.nrows(), 1, eigen.eigenvectors.column(at).as_slice()))
}
