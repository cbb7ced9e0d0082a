//! Proof that a load is held at every pose of a box: tensions that change linearly over it, and Brouwer's theorem for
//! what they leave.

use super::Undecided;
use super::cutting::{LinearCut, largest_last};
use super::frame::{Affine, BoxFrame, CableFrame, uniform};
use super::outside::ROUNDING;
use super::sag::SagBound;
use crate::math::{Mat6, Vec6};

/// Tensions over a box: `t = q l_0` of every cable at the centre, and by each coordinate [N].
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Witness {
    pub(crate) center: Vec<f64>,
    pub(crate) by: Vec<Vec<f64>>,
}

impl Witness {
    /// Bound of the tension of a cable over the box.
    fn size(&self, cable: usize) -> f64 {
        self.center[cable].abs() + self.by.iter().map(|by| by[cable].abs()).sum::<f64>()
    }

    fn sizes(&self) -> Vec<f64> {
        (0..self.center.len()).map(|cable| self.size(cable)).collect()
    }
}

/// Loads that are held at every pose of a box.
pub(super) struct HeldInBox {
    /// Tensions of each load.
    pub(super) witnesses: Vec<Witness>,
    /// Least distance of a tension from its limits [N].
    pub(super) margin: f64,
}

/// Load that is not proved to be held.
pub(super) struct NotHeld {
    /// Number of the load.
    pub(super) load: usize,
    pub(super) reason: Undecided,
}

/// Part of the tensions of witnesses by which the true ones may differ when their sag is bounded.
const SLACKER: f64 = 0.05;

/// Bounds of the sag of a cable, and the chord tensions to which they belong [N].
#[derive(Clone, Copy, Default)]
struct SagInRange {
    bound: SagBound,
    tensions: [f64; 2],
}

/// Tensions as functions of the free ones: `fixed + Σ free`, at the centre and by each coordinate.
struct TensionFamily {
    center: Vec<f64>,
    by: Vec<Vec<f64>>,
    /// Change of the tensions of each coordinate by the free ones at the centre, rows per cable.
    coupled: Vec<Vec<Vec<f64>>>,
}

/// Bounds of the change by which a witness becomes an exact balance.
struct Correction {
    /// Coefficients of the squares of the coordinates, per cable.
    squares: Vec<Vec<f64>>,
    /// Bound of everything else, per cable.
    others: Vec<f64>,
    /// Part of it that comes from sag.
    of_sag: Vec<f64>,
}

impl BoxFrame<'_> {
    /// Proves that every load is held at every pose of the box, and with them their combinations: tensions of these are
    /// combinations of those of the loads, if the bounds of the sag are the same for all loads.
    ///
    /// # Errors
    /// The first load that is not proved to be held.
    pub(super) fn held(&self) -> Result<HeldInBox, NotHeld> {
        let loads: Vec<Affine> = (0..self.statement.loads.len()).map(|number| self.load(number)).collect();
        let over_box = |cable: &CableFrame| {
            cable.sag.map(|of| SagInRange { bound: of.bound, tensions: of.tensions }).unwrap_or_default()
        };
        let wide: Vec<SagInRange> = self.cables.iter().map(over_box).collect();
        let (mut witnesses, mut margin, mut too_wide) = (Vec::with_capacity(loads.len()), f64::INFINITY, None);
        for (number, load) in loads.iter().enumerate() {
            let refused = |reason| NotHeld { load: number, reason };
            let witness = self.witness(load).ok_or_else(|| refused(Undecided::SmallMargin))?;
            match self.margin(load, &witness, &wide) {
                Ok(of_load) => margin = margin.min(of_load),
                Err(Undecided::SagBound) => too_wide = too_wide.or(Some(number)),
                Err(reason) => return Err(refused(reason)),
            }
            witnesses.push(witness);
        }
        let Some(first) = too_wide else { return Ok(HeldInBox { witnesses, margin }) };

        // Bounds of the sag for tensions that differ little from those of the witnesses.
        let refused = |load, reason| NotHeld { load, reason };
        let near = self.sags(&witnesses).ok_or_else(|| refused(first, Undecided::SagBound))?;
        let mut margin = f64::INFINITY;
        for (number, (load, witness)) in loads.iter().zip(&witnesses).enumerate() {
            let of_load = self.margin(load, witness, &near).map_err(|reason| refused(number, reason))?;
            margin = margin.min(of_load);
        }
        Ok(HeldInBox { witnesses, margin })
    }

    /// Tensions whose least distance from the limits over the box is greatest, to first order.
    fn witness(&self, load: &Affine) -> Option<Witness> {
        let family = self.family(load);
        let (free, coordinates) = (self.null_space.first().map_or(0, Vec::len), self.steps.len());
        let d = 1 + free * (1 + coordinates);
        let scale = self.cables.iter().map(|cable| cable.within[0]).fold(load.center.norm(), f64::max).max(1e-6);
        let next = |x: &[f64], cut: &mut LinearCut| self.most_violated(&family, x, 1e-9 * scale, cut);
        let x = largest_last(&vec![1e4 * scale; d], 0.0, next)?;

        let along = |row: &[f64], z: &[f64]| row.iter().zip(z).map(|(n, z)| n * z).sum::<f64>();
        let z = &x[..free];
        let center = (0..self.cables.len()).map(|i| family.center[i] + along(&self.null_space[i], z)).collect();
        let by = (0..coordinates).map(|j| {
            let own = &x[free * (1 + j)..free * (2 + j)];
            let of = |i: usize| family.by[j][i] + along(&family.coupled[j][i], z) + along(&self.null_space[i], own);
            (0..self.cables.len()).map(of).collect()
        });
        Some(Witness { center, by: by.collect() })
    }

    /// Tensions that balance the load to first order, with free ones.
    fn family(&self, load: &Affine) -> TensionFamily {
        let (m, free) = (self.cables.len(), self.null_space.first().map_or(0, Vec::len));
        let center: Vec<f64> = self.inverse.iter().map(|row| -row.dot(&load.center)).collect();
        let (mut by, mut coupled) = (Vec::new(), Vec::new());
        for j in 0..self.steps.len() {
            let columns = self.cables.iter().map(|cable| &cable.column.by[j]);
            let left = columns.clone().zip(&center).fold(load.by[j], |sum, (column, t)| sum + column * *t);
            by.push(self.inverse.iter().map(|row| -row.dot(&left)).collect());
            let mut of_free = vec![Vec6::zeros(); free];
            for (column, row) in columns.zip(&self.null_space) {
                of_free.iter_mut().zip(row).for_each(|(sum, n)| *sum += column * *n);
            }
            let of_cable = |i: usize| of_free.iter().map(|of| -self.inverse[i].dot(of)).collect();
            coupled.push((0..m).map(of_cable).collect());
        }
        TensionFamily { center, by, coupled }
    }

    /// Writes the limit that tensions of free ones `x` miss most, with the signs of its worst corner: two families per
    /// cable stand for all corners.
    fn most_violated(&self, family: &TensionFamily, x: &[f64], tolerance: f64, cut: &mut LinearCut) -> bool {
        let (free, coordinates) = (self.null_space.first().map_or(0, Vec::len), self.steps.len());
        let least_distance = x[x.len() - 1];
        let along = |row: &[f64], z: &[f64]| row.iter().zip(z).map(|(n, z)| n * z).sum::<f64>();
        let z = &x[..free];
        let (mut worst, mut missed) = (None, tolerance);
        for (i, cable) in self.cables.iter().enumerate() {
            let null = &self.null_space[i];
            let center = family.center[i] + along(null, z);
            let by = |j: usize| {
                let own = &x[free * (1 + j)..free * (2 + j)];
                family.by[j][i] + along(&family.coupled[j][i], z) + along(null, own)
            };
            let [least, greatest] = cable.within;
            let (mut below, mut above) = (0.0, 0.0);
            for j in 0..coordinates {
                let change = by(j);
                below += (change - least * cable.nearer[j]).abs();
                above += if greatest.is_finite() { (change - greatest * cable.nearer[j]).abs() } else { 0.0 };
            }
            let lower = center - below - least * (1.0 + cable.curved[0]);
            let upper = greatest * (1.0 - cable.curved[1]) - center - above;
            for (distance, is_upper) in [(lower, false), (upper, true)] {
                if least_distance - distance > missed {
                    missed = least_distance - distance;
                    worst = Some((i, is_upper));
                }
            }
        }

        let Some((i, is_upper)) = worst else { return false };
        let (cable, null) = (&self.cables[i], &self.null_space[i]);
        let (side, limit) = if is_upper { (1.0, cable.within[1]) } else { (-1.0, cable.within[0]) };
        cut.row.fill(0.0);
        cut.row[x.len() - 1] = 1.0;
        // s ± t_0 + Σ_j |T_j − limit κ_j| ≤ ± limit (1 ± …)
        let curved = if is_upper { 1.0 - cable.curved[1] } else { 1.0 + cable.curved[0] };
        cut.limit = side * (limit * curved - family.center[i]);
        cut.row[..free].iter_mut().zip(null).for_each(|(of, n)| *of = side * n);
        for j in 0..coordinates {
            let own = &x[free * (1 + j)..free * (2 + j)];
            let coupled = &family.coupled[j][i];
            let fixed = family.by[j][i] - limit * cable.nearer[j];
            let sign = if fixed + along(coupled, z) + along(null, own) < 0.0 { -1.0 } else { 1.0 };
            cut.limit -= sign * fixed;
            cut.row[..free].iter_mut().zip(coupled).for_each(|(of, n)| *of += sign * n);
            cut.row[free * (1 + j)..free * (2 + j)].iter_mut().zip(null).for_each(|(of, n)| *of = sign * n);
        }
        true
    }

    /// Least distance of exact tensions about a witness from their limits over the box, if it is positive and their sag
    /// has the given bounds: (42b) to (42d).
    fn margin(&self, load: &Affine, witness: &Witness, sags: &[SagInRange]) -> Result<f64, Undecided> {
        let sizes = witness.sizes();
        let correction = self.correction(load, witness, &sizes, sags).ok_or(Undecided::NearSingular)?;
        let (mut margin, mut of_sag, mut of_size) = (f64::INFINITY, 0.0, 0.0);
        for (i, (cable, sag)) in self.cables.iter().zip(sags).enumerate() {
            let Correction { squares, others, .. } = &correction;
            let below: f64 = squares.iter().map(|of| of[i].min(0.0)).sum();
            let above: f64 = squares.iter().map(|of| of[i].max(0.0)).sum();
            let center = witness.center[i];
            let of = &self.statement.cables[i];
            let least = of.least.at(cable.length + cable.moves[1]) + sag.bound.below;
            let greatest = of.greatest - sag.bound.above;
            let differs = |limit: f64| {
                let by = witness.by.iter().zip(&cable.nearer);
                by.map(|(by, nearer)| (by[i] - limit * nearer).abs()).sum::<f64>()
            };
            let rounded = |limit: f64| ROUNDING * limit * (1.0 + cable.curved[0] + cable.size);
            let above_least = |limit: f64| {
                center - differs(limit) + below - others[i] - limit * (1.0 + cable.curved[0]) - rounded(limit)
            };
            let below_greatest = |limit: f64| {
                limit * (1.0 - cable.curved[1]) - center - differs(limit) - above - others[i] - rounded(limit)
            };
            // The limits, and the range of tensions to which the bounds of the sag belong.
            let mut distance = above_least(least);
            if greatest.is_finite() {
                distance = distance.min(below_greatest(greatest));
            }
            if cable.sag.is_some() {
                let [from, to] = sag.tensions;
                distance = distance.min(above_least(from)).min(below_greatest(to));
            }
            if distance < margin {
                margin = distance;
                of_sag = correction.of_sag[i];
                of_size = others[i] - of_sag - below + above + least * cable.curved[0] + differs(least);
            }
        }
        if margin > 0.0 {
            return Ok(margin);
        }
        Err(if of_sag > 0.0 && of_size < of_sag { Undecided::SagBound } else { Undecided::SmallMargin })
    }

    /// Bounds of the sag for tensions near those of witnesses; nothing for straight cables.
    fn sags(&self, witnesses: &[Witness]) -> Option<Vec<SagInRange>> {
        let cables = self.statement.cables.iter().zip(&self.cables).enumerate();
        let bounds = cables.map(|(i, (of, cable))| {
            let (Some(sag), Some(over)) = (of.sag, &cable.sag) else { return Some(SagInRange::default()) };
            let ratio = cable.moves[1] / cable.length;
            let (mut least, mut greatest) = (f64::INFINITY, 0.0_f64);
            for witness in witnesses {
                let (center, size) = (witness.center[i], witness.size(i));
                least = least.min((2.0 * center.abs() - size) * (1.0 - ratio) * (1.0 - SLACKER));
                greatest = greatest.max(size * (1.0 + ratio) * (1.0 + SLACKER));
            }
            let least = least.max(over.tensions[0]);
            let tensions = [least, greatest.max(least)];
            sag.bound(&over.chords, tensions).map(|bound| SagInRange { bound, tensions })
        });
        bounds.collect()
    }

    /// Bounds of the change of a witness by Brouwer's theorem; `None` if the wrenches are too near to dependence.
    fn correction(&self, load: &Affine, witness: &Witness, sizes: &[f64], sags: &[SagInRange]) -> Option<Correction> {
        let (n, coordinates) = (self.statement.coordinates.count(), self.steps.len());
        let cables = || self.cables.iter().enumerate();

        // Left by the witness: constant and linear parts, which are rounding, and quadratic ones.
        let linear = |j: Option<usize>| {
            let start = j.map_or(load.center, |j| load.by[j]);
            cables().fold(start, |sum, (i, cable)| match j {
                None => sum + cable.column.center * witness.center[i],
                Some(j) => sum + cable.column.center * witness.by[j][i] + cable.column.by[j] * witness.center[i],
            })
        };
        let mut rounding = linear(None).abs();
        for j in 0..coordinates {
            rounding += linear(Some(j)).abs();
        }
        let quadratic = |j: usize, k: usize| {
            cables().fold(Vec6::zeros(), |sum, (i, cable)| {
                let own = cable.column.by[j] * witness.by[k][i];
                if j == k { sum + own } else { sum + own + cable.column.by[k] * witness.by[j][i] }
            })
        };

        // Bounds of what is no polynomial, and of all together.
        let (mut rest, mut of_sag, mut total) = (load.rest, Vec6::zeros(), rounding);
        for (i, cable) in cables() {
            rest += cable.column.rest * sizes[i];
            let turned = uniform(cable.lift_turns[0], n);
            of_sag += (cable.lift.abs() + turned) * sags[i].bound.deviation;
        }
        let of_load = load.by.iter().fold(load.center.abs(), |sum, by| sum + by.abs()).amax();
        let scale = cables().map(|(i, cable)| sizes[i] * cable.size).sum::<f64>() + of_load;
        rest += uniform(ROUNDING * scale, n);
        let (mut squares, mut crossed) = (Vec::new(), vec![0.0; self.cables.len()]);
        for j in 0..coordinates {
            for k in j..coordinates {
                let left = quadratic(j, k);
                total += left.abs();
                let of_cables = self.inverse.iter().map(|row| -row.dot(&left));
                if j == k {
                    squares.push(of_cables.collect());
                } else {
                    crossed.iter_mut().zip(of_cables).for_each(|(sum, of)| *sum += of.abs());
                }
            }
        }
        total += rest + of_sag;

        let unbalanced = self.unbalanced() * (1.0 + ROUNDING);
        let reach = fixed_bound(&unbalanced, &total)?;
        let left = unbalanced * reach + rest + rounding;
        let of_cable = |bound: &Vec6| self.inverse.iter().map(|row| row.abs().dot(bound)).collect::<Vec<f64>>();
        let rounded = self.inverse.iter().zip(sizes).map(|(row, t)| ROUNDING * (row.abs().sum() * scale + t));
        let of_sag = of_cable(&of_sag);
        let others = of_cable(&left).into_iter().zip(&of_sag).zip(&crossed).zip(rounded);
        let others = others.map(|(((left, sag), crossed), rounded)| left + sag + crossed + rounded).collect();
        Some(Correction { squares, others, of_sag })
    }

    /// Bound E of `M(ξ) Y − 1` over the box.
    fn unbalanced(&self) -> Mat6 {
        let n = self.statement.coordinates.count();
        let product = |columns: &dyn Fn(usize) -> Vec6| {
            self.inverse.iter().enumerate().fold(Mat6::zeros(), |sum, (i, row)| sum + columns(i) * row.transpose())
        };
        let mut identity = Mat6::zeros();
        (0..n).for_each(|k| identity[(k, k)] = 1.0);
        let mut bound = (product(&|i| self.cables[i].column.center) - identity).abs();
        for j in 0..self.steps.len() {
            bound += product(&|i| self.cables[i].column.by[j]).abs();
        }
        for (row, cable) in self.inverse.iter().zip(&self.cables) {
            let columns = cable.column.rest + uniform(ROUNDING * cable.size, n);
            bound += columns * row.abs().transpose();
        }
        bound
    }
}

/// Positive vector x with `E x + ρ ≤ x` in every component; `None` if none is found.
fn fixed_bound(unbalanced: &Mat6, left: &Vec6) -> Option<Vec6> {
    let used = left.map(|of| if of > 0.0 { 1.0 } else { 0.0 });
    let floor = 1e-12 * left.amax();
    let mut x = *left;
    for _ in 0..40 {
        let mapped = unbalanced * x + left;
        let proposed = mapped * 1.02 + used * floor;
        if (unbalanced * proposed + left).iter().zip(&proposed).all(|(of, x)| *of * (1.0 + ROUNDING) <= *x) {
            return Some(proposed);
        }
        if !mapped.amax().is_finite() || mapped.amax() > 1e6 * left.amax() {
            return None;
        }
        x = mapped;
    }
    None
}
