//! Stiffness and mass of a cable in the blocks that its condensation needs, and the condensation.
//!
//! The functions of a mesh are of three kinds: inner functions i (nodes between elements, bubbles), the two ends b, and
//! the functions beyond the degree, which serve the error estimate. The clamped modes solve `M_ii φ = μ K_ii φ`. The
//! ends need only the products of a mode with the columns K_ib and M_ib, so that no eigenvector is formed
//! ([`generalized_eigen`]).

use super::internal_motion::Displacements;
use super::{CatenaryDynamicError, PoleResidue};
use crate::math::{DMat, generalized_eigen, order};

/// Functions of one element by kind: index in the matrices of the element, and number among the functions of its kind.
pub(super) struct Functions {
    pub(super) inner: Vec<(usize, usize)>,
    pub(super) ends: Vec<(usize, usize)>,
    pub(super) beyond: Vec<(usize, usize)>,
}

impl Functions {
    /// Functions that are not inner functions: the two ends, then those beyond the degree.
    fn outer(&self) -> impl Iterator<Item = (usize, usize)> {
        let beyond = self.beyond.iter().map(|(place, number)| (*place, 2 + number));
        self.ends.iter().copied().chain(beyond)
    }
}

/// Stiffness and mass of a cable by kinds of functions, with D components per function and N = 2D components of its
/// ends.
pub(super) struct Partition<const D: usize, const N: usize> {
    /// Number of inner unknowns.
    unknowns: usize,
    /// Number of outer unknowns: ends, and functions beyond the degree.
    outer: usize,
    /// K_ii and M_ii, by columns.
    stiffness: Vec<f64>,
    mass: Vec<f64>,
    /// Row of each inner unknown: K_io and M_io of the outer unknowns, then the function's values at the stations.
    rows: Vec<f64>,
    /// Length of a row.
    row_length: usize,
    /// M_bb of the ends.
    end_mass: [[f64; N]; N],
    /// Diagonal entries of stiffness and mass of each unknown beyond the degree.
    beyond: Vec<(f64, f64)>,
    /// Displacement of each station by the functions of both ends.
    by_ends: Vec<[[f64; N]; D]>,
}

/// Station that is a motion, not a point: its first component as a sum of unknowns and of components of the ends.
pub(super) struct MotionRow {
    pub(super) inner: Vec<(usize, f64)>,
    pub(super) ends: Vec<f64>,
}

/// Motions at the end of a cable, some of which move the end; the others lie behind these.
pub(super) struct Guide<const D: usize> {
    /// Motions that move the end, at most D of them: each with the displacement of the end.
    pub(super) directions: Vec<(usize, [f64; D])>,
    /// Stiffness [N/m] and mass [kg] over the motions, symmetric.
    pub(super) stiffness: DMat,
    pub(super) mass: DMat,
}

/// Pairs of components (row, column) that the tangent C couples, with the number of the entry of C: out of plane its
/// only one, in plane hh, hv, vv, with all components together these and then the one out of plane.
fn components<const D: usize>() -> impl Iterator<Item = ((usize, usize), usize)> {
    let entry = |row: usize, column: usize| match (row, column) {
        (2, 2) => Some(3),
        (2, _) | (_, 2) => None,
        (row, column) => Some(row + column),
    };
    (0..D).flat_map(move |column| (0..D).filter_map(move |row| Some(((row, column), entry(row, column)?))))
}

/// Blocks of stiffness and mass from which a [`Partition`] is made at once, symmetric ones by both triangles.
pub(super) struct Blocks {
    /// K_ii and M_ii.
    pub(super) inner: [DMat; 2],
    /// K_io and M_io; the outer unknowns are those of both ends, then those beyond the degree.
    pub(super) to_outer: [DMat; 2],
    /// M_bb.
    pub(super) end_mass: DMat,
    /// Diagonal entries of stiffness and mass of each unknown beyond the degree.
    pub(super) beyond: Vec<(f64, f64)>,
    /// Stations, all of which are motions.
    pub(super) stations: Vec<MotionRow>,
}

impl<const D: usize, const N: usize> Partition<D, N> {
    /// Partition of these blocks.
    pub(super) fn of(blocks: &Blocks) -> Self {
        let Blocks { inner: [stiffness, mass], to_outer, end_mass, beyond, stations } = blocks;
        let (unknowns, outer) = (stiffness.nrows(), to_outer[0].ncols());
        let row_length = 2 * outer + D * stations.len();
        let mut rows = vec![0.0; unknowns * row_length];
        for (i, row) in rows.chunks_exact_mut(row_length).enumerate() {
            for j in 0..outer {
                (row[j], row[outer + j]) = (to_outer[0][(i, j)], to_outer[1][(i, j)]);
            }
        }

        let mut by_ends = vec![[[0.0; N]; D]; stations.len()];
        for (station, row) in stations.iter().enumerate() {
            by_ends[station][0].copy_from_slice(&row.ends);
            for (unknown, entry) in &row.inner {
                rows[unknown * row_length + 2 * outer + D * station] = *entry;
            }
        }

        Self {
            unknowns,
            outer,
            stiffness: stiffness.as_slice().to_vec(),
            mass: mass.as_slice().to_vec(),
            rows,
            row_length,
            end_mass: std::array::from_fn(|i| std::array::from_fn(|j| end_mass[(i, j)])),
            beyond: beyond.clone(),
            by_ends,
        }
    }

    /// Partition of zeros for the given numbers of inner functions, functions beyond the degree and stations.
    pub(super) fn new(inner: usize, beyond: usize, stations: usize) -> Self {
        let (unknowns, outer) = (D * inner, D * (2 + beyond));
        let row_length = 2 * outer + D * stations;
        Self {
            unknowns,
            outer,
            stiffness: vec![0.0; unknowns * unknowns],
            mass: vec![0.0; unknowns * unknowns],
            rows: vec![0.0; unknowns * row_length],
            row_length,
            end_mass: [[0.0; N]; N],
            beyond: vec![(0.0, 0.0); D * beyond],
            by_ends: vec![[[0.0; N]; D]; stations],
        }
    }

    /// Adds an element's contribution to K_ii and M_ii. `stiffness` has one matrix for each entry of C, in the order of
    /// [`components`]; all components have the same mass.
    pub(super) fn add_inner(&mut self, functions: &Functions, stiffness: &[DMat], mass: &DMat) {
        for &(b, column) in &functions.inner {
            for &(a, row) in &functions.inner {
                for ((i, j), entry) in components::<D>() {
                    self.stiffness[(D * column + j) * self.unknowns + D * row + i] += stiffness[entry][(a, b)];
                }
                for d in 0..D {
                    self.mass[(D * column + d) * self.unknowns + D * row + d] += mass[(a, b)];
                }
            }
        }
    }

    /// Adds an element's contribution to K_io and M_io.
    pub(super) fn add_columns(&mut self, functions: &Functions, stiffness: &[DMat], mass: &DMat) {
        for (b, column) in functions.outer() {
            for &(a, row) in &functions.inner {
                for ((i, j), entry) in components::<D>() {
                    self.rows[(D * row + i) * self.row_length + D * column + j] += stiffness[entry][(a, b)];
                }
                for d in 0..D {
                    self.rows[(D * row + d) * self.row_length + self.outer + D * column + d] += mass[(a, b)];
                }
            }
        }
    }

    /// Adds an element's contribution to M_bb.
    pub(super) fn add_end_mass(&mut self, functions: &Functions, mass: &DMat) {
        for &(b, column) in &functions.ends {
            for &(a, row) in &functions.ends {
                for d in 0..D {
                    self.end_mass[D * row + d][D * column + d] += mass[(a, b)];
                }
            }
        }
    }

    /// Sets the diagonal entries of an element's functions beyond the degree.
    pub(super) fn set_beyond(&mut self, functions: &Functions, stiffness: &[DMat], mass: &DMat) {
        for &(a, number) in &functions.beyond {
            for ((d, _), entry) in components::<D>().filter(|((i, j), _)| i == j) {
                self.beyond[D * number + d] = (stiffness[entry][(a, a)], mass[(a, a)]);
            }
        }
    }

    /// Sets the values at a station of the functions of the element on which it lies.
    pub(super) fn set_station(&mut self, functions: &Functions, station: usize, values: &[f64]) {
        for &(a, row) in &functions.inner {
            for d in 0..D {
                self.rows[(D * row + d) * self.row_length + 2 * self.outer + D * station + d] = values[a];
            }
        }
        for &(a, end) in &functions.ends {
            (0..D).for_each(|d| self.by_ends[station][d][D * end + d] = values[a]);
        }
    }

    /// Adds an element's contribution to a station that is a motion: `row` has its first component by each function of
    /// the element, in plane.
    pub(super) fn add_motion(&mut self, functions: &Functions, station: usize, row: &[[f64; 2]]) {
        for &(a, at) in &functions.inner {
            for (d, entry) in row[a].iter().enumerate() {
                self.rows[(D * at + d) * self.row_length + 2 * self.outer + D * station] += entry;
            }
        }
        for &(a, end) in &functions.ends {
            for (d, entry) in row[a].iter().enumerate() {
                self.by_ends[station][0][D * end + d] += entry;
            }
        }
    }

    /// Restricts the inner function `node`, the end of the cable, to the motions of a guide. The motions that move it
    /// take the places of its D unknowns, the others follow all unknowns. Each motion is a station of its own, in its
    /// first component, from `first_station` on.
    pub(super) fn guide(&mut self, node: usize, guide: &Guide<D>, first_station: usize) {
        let Guide { directions, stiffness, mass } = guide;
        let (n, first) = (self.unknowns, D * node);

        // Every new unknown as a sum of the earlier ones, and the place of every motion.
        let mut unknowns: Vec<Vec<(usize, f64)>> = Vec::with_capacity(n + mass.nrows());
        let mut places = vec![0; mass.nrows()];
        for old in (0..n).filter(|old| !(first + 1..first + D).contains(old)) {
            if old != first {
                unknowns.push(vec![(old, 1.0)]);
                continue;
            }
            for (motion, direction) in directions {
                places[*motion] = unknowns.len();
                unknowns.push(direction.iter().enumerate().map(|(i, part)| (first + i, *part)).collect());
            }
        }
        for motion in (0..mass.nrows()).filter(|motion| directions.iter().all(|(moving, _)| moving != motion)) {
            places[motion] = unknowns.len();
            unknowns.push(Vec::new());
        }

        // The square matrices.
        let all = unknowns.len();
        let restrict = |matrix: &[f64], added: &DMat| -> Vec<f64> {
            let mut restricted = vec![0.0; all * all];
            for (c, columns) in unknowns.iter().enumerate() {
                for (r, rows) in unknowns.iter().enumerate() {
                    let product =
                        |(row, f): &(usize, f64), (column, g): &(usize, f64)| f * g * matrix[column * n + row];
                    restricted[c * all + r] =
                        rows.iter().flat_map(|row| columns.iter().map(move |column| product(row, column))).sum();
                }
            }
            for j in 0..added.ncols() {
                for i in 0..added.nrows() {
                    restricted[places[j] * all + places[i]] += added[(i, j)];
                }
            }
            restricted
        };
        self.stiffness = restrict(&self.stiffness, stiffness);
        self.mass = restrict(&self.mass, mass);

        // Rows of the outer unknowns and of the stations.
        let length = self.row_length;
        let mut rows = vec![0.0; all * length];
        for (row, sources) in rows.chunks_exact_mut(length).zip(&unknowns) {
            for (old, factor) in sources {
                let old = &self.rows[old * length..(old + 1) * length];
                row.iter_mut().zip(old).for_each(|(entry, old)| *entry += factor * old);
            }
        }
        for (motion, place) in places.iter().enumerate() {
            rows[place * length + 2 * self.outer + D * (first_station + motion)] = 1.0;
        }
        (self.rows, self.unknowns) = (rows, all);
    }

    /// Poles and residues of the ends, whose static stiffness is `still`. All poles are found; the error is estimated
    /// for those below ω = `limit`.
    pub(super) fn reduce<const E: usize>(
        self,
        still: [[f64; N]; N],
        limit: f64,
    ) -> Result<Condensed<D, N, E>, CatenaryDynamicError> {
        let Self { stiffness, mass, rows, row_length, outer, end_mass, beyond, by_ends, .. } = self;
        let (values, products) =
            generalized_eigen::pencil(stiffness, mass, rows, row_length).ok_or(CatenaryDynamicError::NoTension)?;

        // Low frequencies first. Values that are not positive are infinite frequencies with rounding errors.
        let (mut order, infinite): (Vec<usize>, Vec<usize>) = (0..values.len()).partition(|&k| values[k] > 0.0);
        order::sort_descending(&mut order, |&k| values[k]);

        // Poles, participations and displacements, mode by mode; each mode takes its contribution out of the end mass.
        let (mut mass, mut error) = (end_mass, 0.0_f64);
        let (mut poles, mut participation) = (Vec::with_capacity(order.len()), Vec::with_capacity(order.len()));
        let mut stations = Displacements { still: by_ends, modes: Vec::new() };
        for k in infinite {
            let mode = ModeProducts::new(values[k], &products[k * row_length..(k + 1) * row_length], outer);
            stations.add_still(mode.at_stations, mode.stiff);
        }
        for k in order {
            let mode = ModeProducts::new(values[k], &products[k * row_length..(k + 1) * row_length], outer);
            mode.take_from(&mut mass);
            poles.push(1.0 / mode.mu);
            participation.push(mode.participation());
            stations.add_mode(mode.at_stations, mode.stiff, mode.mu);
            if 1.0 / mode.mu < limit * limit {
                error = error.max(mode.error(&beyond, N));
            }
        }

        Ok(Condensed { ends: PoleResidue::new(still, mass, poles, participation), error, stations })
    }
}

/// Products of a clamped mode φ, normalised to `φᵀKφ = 1`, with the outer unknowns and the stations.
struct ModeProducts<'a> {
    /// Eigenvalue μ = 1/ω².
    mu: f64,
    /// Stiffness products a = K_oi φ.
    stiff: &'a [f64],
    /// Mass products b = M_oi φ.
    heavy: &'a [f64],
    /// Displacements of the stations.
    at_stations: &'a [f64],
}

impl<'a> ModeProducts<'a> {
    /// Products of φ with the rows of a [`Partition`], divided into their kinds.
    fn new(mu: f64, products: &'a [f64], outer: usize) -> Self {
        let (by_outer, at_stations) = products.split_at(2 * outer);
        let (stiff, heavy) = by_outer.split_at(outer);
        Self { mu, stiff, heavy, at_stations }
    }

    /// Subtracts the mode's contribution from the mass of the ends: `M_s = M_bb − Σ (b aᵀ + a bᵀ − μ a aᵀ)`.
    fn take_from<const N: usize>(&self, mass: &mut [[f64; N]; N]) {
        let Self { mu, stiff, heavy, .. } = self;
        for i in 0..N {
            for j in 0..N {
                mass[i][j] -= heavy[i] * stiff[j] + stiff[i] * heavy[j] - mu * stiff[i] * stiff[j];
            }
        }
    }

    /// Participation of the ends, `g = (b − μ a)/√μ`.
    fn participation<const N: usize>(&self) -> [f64; N] {
        std::array::from_fn(|i| (self.heavy[i] - self.mu * self.stiff[i]) / self.mu.sqrt())
    }

    /// Estimated relative error of the clamped frequency: half the relative decrease of ω² that the functions beyond
    /// the degree would cause, to first order in each. They are numbered from `first` among the outer functions.
    fn error(&self, beyond: &[(f64, f64)], first: usize) -> f64 {
        let lost = |(e, (stiffness, mass)): (usize, &(f64, f64))| {
            let answer = self.stiff[first + e] - self.heavy[first + e] / self.mu;
            answer * answer / (stiffness - mass / self.mu).abs().max(f64::MIN_POSITIVE)
        };
        0.5 * beyond.iter().enumerate().map(lost).sum::<f64>()
    }
}

/// Cable condensed onto its ends.
pub(super) struct Condensed<const D: usize, const N: usize, const E: usize> {
    pub(super) ends: PoleResidue<N, E>,
    /// Estimated relative error of the clamped frequencies below the limit.
    pub(super) error: f64,
    pub(super) stations: Displacements<D, N>,
}

impl<const D: usize, const N: usize, const E: usize> Condensed<D, N, E> {
    /// No stiffness and no stations.
    pub(super) fn none() -> Self {
        Self { ends: PoleResidue::none(), error: 0.0, stations: Displacements::none() }
    }
}
