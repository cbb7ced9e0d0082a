//! Dynamic stiffness of a cable of any sag, exactly: linear vibration about the elastic catenary, axial inertia
//! included, both ends.
//!
//! Along the unstrained arc length s the motion p(s) obeys `(C p′)′ = −m ω_c² p` with
//! `C = EA ttᵀ + (EA T/(EA + T))(I − ttᵀ)`; in plane (two components) and out of plane (one) are independent. The weak
//! form `∫ p′ᵀ C p′ − ω_c² m ∫ pᵀ p` is discretised by polynomials of high degree on one element, or on a few where the
//! cable bends sharply. With the clamped modes (ω_k, φ_k) of the interior, computed once, the ends have
//!
//! ```text
//! K(ω) = K_s − ω_c² M_s − Σ_k ω_c⁴ g_k g_kᵀ/(ω_k² − ω_c²)
//! ```
//!
//! K_s and M_s being the static condensation and g_k the participation of the ends in mode k: a few operations a pole.
//! Derivation: docs/theory.md, section 9.

use super::{LocalAxes, LocalStiffness, damped_square};
use crate::catenary::Catenary;
use crate::catenary::space::HangingCable;
use crate::math::{Complex, DMat, legendre, projected};
use crate::robot::Damping;
use std::ops::Range;
use thiserror::Error;

/// One cable as poles and residues, in plane and out of plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Exact {
    /// In plane: components (horizontal, up) of the start, then of the end.
    pub in_plane: PoleResidue<4>,
    /// Out of plane: start, then end.
    pub out_of_plane: PoleResidue<2>,
    /// Highest angular frequency it was made for [rad/s].
    pub limit: f64,
    /// Estimated relative error of the clamped frequencies below the limit.
    pub error: f64,
    /// Polynomial degree of each element.
    pub degrees: Vec<usize>,
}

/// Why a cable has no exact dynamic stiffness.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum ExactError {
    /// No tension somewhere: a slack massless cable, or a loop that hangs straight down.
    #[error("the cable has no tension at its lowest point: it has no linear vibration")]
    NoTension,
    /// The frequency asked needs too fine a discretisation.
    #[error("the frequency limit asked needs {unknowns} unknowns for one cable (limit {limit}): lower it")]
    TooFine {
        /// Unknowns needed.
        unknowns: usize,
        /// Unknowns allowed.
        limit: usize,
    },
}

/// A symmetric end stiffness by poles and residues; N end components.
#[derive(Debug, Clone, PartialEq)]
pub struct PoleResidue<const N: usize> {
    /// K_s, symmetric [N/m].
    pub stiffness: [[f64; N]; N],
    /// M_s, symmetric [kg].
    pub mass: [[f64; N]; N],
    /// ω_k² of the clamped modes, ascending [rad²/s²].
    pub poles: Vec<f64>,
    /// g_k [√kg].
    pub participation: Vec<[f64; N]>,
}

impl<const N: usize> PoleResidue<N> {
    /// Entries (i, j) of the undamped stiffness at x = ω² [N/m].
    pub fn undamped<const E: usize>(&self, entries: [(usize, usize); E], x: f64) -> [f64; E] {
        let mut sums = [0.0; E];
        for (pole, g) in self.poles.iter().zip(&self.participation) {
            let factor = 1.0 / (pole - x);
            for (sum, (i, j)) in sums.iter_mut().zip(entries) {
                *sum += g[i] * g[j] * factor;
            }
        }
        std::array::from_fn(|e| {
            let (i, j) = entries[e];
            self.stiffness[i][j] - x * (self.mass[i][j] + x * sums[e])
        })
    }

    /// Entries (i, j) of the stiffness at the complex x = ω_c² [N/m].
    pub fn damped<const E: usize>(&self, entries: [(usize, usize); E], x: Complex) -> [Complex; E] {
        let mut sums = [Complex::new(0.0, 0.0); E];
        for (pole, g) in self.poles.iter().zip(&self.participation) {
            let factor = 1.0 / (*pole - x);
            for (sum, (i, j)) in sums.iter_mut().zip(entries) {
                *sum += factor * (g[i] * g[j]);
            }
        }
        std::array::from_fn(|e| {
            let (i, j) = entries[e];
            self.stiffness[i][j] - x * (self.mass[i][j] + x * sums[e])
        })
    }

    /// Entries (i, j) of minus the derivative of the undamped stiffness by ω² [kg]:
    /// `M_s + Σ g gᵀ (2 x ω_k² − x²)/(ω_k² − x)²` at x = ω².
    pub fn moving_mass<const E: usize>(&self, entries: [(usize, usize); E], x: f64) -> [f64; E] {
        let mut sums = entries.map(|(i, j)| self.mass[i][j]);
        for (pole, g) in self.poles.iter().zip(&self.participation) {
            let gap = pole - x;
            let factor = x * (2.0 * pole - x) / (gap * gap);
            for (sum, (i, j)) in sums.iter_mut().zip(entries) {
                *sum += g[i] * g[j] * factor;
            }
        }
        sums
    }

    /// Number of poles below ω² = x.
    pub fn poles_below(&self, x: f64) -> usize {
        self.poles.partition_point(|pole| *pole < x)
    }
}

/// The platform end of an exact cable: its axes and its damping.
#[derive(Debug, Clone, PartialEq)]
pub struct ExactEnd {
    /// Poles and residues, the platform being the start.
    pub exact: Exact,
    /// e horizontal towards the anchor, n up, b across.
    pub axes: LocalAxes,
    /// Damping of the rope.
    pub damping: Damping,
    /// Mass per unstrained length m [kg/m].
    pub mass_per_length: f64,
    /// Leave out the stiffness across, as the paper does.
    pub in_plane_only: bool,
    pub(crate) plane: EndSeries<3>,
    pub(crate) across: EndSeries<1>,
}

impl ExactEnd {
    /// Of a cable that hangs from the platform, good up to ω = `limit` [rad/s].
    ///
    /// # Errors
    /// [`ExactError`].
    pub fn new(
        hanging: &HangingCable,
        mass_per_length: f64,
        damping: Damping,
        in_plane_only: bool,
        limit: f64,
    ) -> Result<Self, ExactError> {
        let exact = Exact::new(&hanging.catenary, mass_per_length, limit)?;
        let (e, n) = hanging.axes_w();
        let plane = EndSeries::of(&exact.in_plane, [(0, 0), (0, 1), (1, 1)]);
        let across = EndSeries::of(&exact.out_of_plane, [(0, 0)]);
        let axes = LocalAxes { e, n, b: e.cross(&n) };
        Ok(Self { exact, axes, damping, mass_per_length, in_plane_only, plane, across })
    }

    fn in_plane_if_asked<T: Default>(&self, mut k: LocalStiffness<T>) -> LocalStiffness<T> {
        if self.in_plane_only {
            k.out_of_plane = T::default();
        }
        k
    }

    /// Undamped stiffness at ω [rad/s], [N/m].
    pub fn undamped(&self, omega: f64) -> LocalStiffness<f64> {
        let x = omega * omega;
        let [axial, coupling, normal] = self.plane.undamped(x, 0..0);
        let [out_of_plane] = if self.in_plane_only { [0.0] } else { self.across.undamped(x, 0..0) };
        LocalStiffness { axial, coupling, normal, out_of_plane }
    }

    /// Damped stiffness at ω [rad/s], [N/m].
    pub fn damped(&self, omega: f64) -> LocalStiffness<Complex> {
        let (re, im) = damped_square(omega, self.damping, self.mass_per_length);
        self.in_plane_if_asked(self.exact.damped(Complex::new(re, im)))
    }

    /// Minus the derivative of the undamped stiffness by ω² [kg].
    pub fn moving_mass(&self, omega: f64) -> LocalStiffness<f64> {
        self.in_plane_if_asked(self.exact.moving_mass(omega))
    }

    /// Number of clamped-clamped frequencies below ω [rad/s].
    pub fn clamped_modes_below(&self, omega: f64) -> usize {
        let x = omega * omega;
        let across = if self.in_plane_only { 0 } else { self.exact.out_of_plane.poles_below(x) };
        self.exact.in_plane.poles_below(x) + across
    }

    /// The clamped-clamped frequencies below ω [rad/s], ascending.
    pub fn clamped_frequencies_below(&self, omega: f64) -> Vec<f64> {
        let x = omega * omega;
        let (in_plane, across) = (&self.exact.in_plane, &self.exact.out_of_plane);
        let count = if self.in_plane_only { 0 } else { across.poles_below(x) };
        let mut all: Vec<f64> =
            in_plane.poles[..in_plane.poles_below(x)].iter().chain(&across.poles[..count]).map(|p| p.sqrt()).collect();
        all.sort_by(f64::total_cmp);
        all
    }

    /// The undamped stiffness at x = ω² without the poles nearer to it than the part `width`, and those poles: for each
    /// its direction in (e, n, b) and 1/κ of the term κ g gᵀ that was left out [m/N].
    pub(crate) fn beside_poles(&self, x: f64, width: f64) -> (LocalStiffness<f64>, Vec<([f64; 3], f64)>) {
        let mut poles = Vec::new();
        let near = self.plane.near(x, width);
        for k in near.clone() {
            let g = self.exact.in_plane.participation[k];
            poles.push(([g[0], g[1], 0.0], (x - self.plane.poles[k]) / (x * x)));
        }
        let [axial, coupling, normal] = self.plane.undamped(x, near);
        let mut out_of_plane = 0.0;
        if !self.in_plane_only {
            let near = self.across.near(x, width);
            for k in near.clone() {
                let g = self.exact.out_of_plane.participation[k];
                poles.push(([0.0, 0.0, g[0]], (x - self.across.poles[k]) / (x * x)));
            }
            [out_of_plane] = self.across.undamped(x, near);
        }
        (LocalStiffness { axial, coupling, normal, out_of_plane }, poles)
    }
}

/// Entries of the platform end's stiffness, poles and residues each in a row, for sums in vector registers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct EndSeries<const E: usize> {
    pub(crate) poles: Vec<f64>,
    pub(crate) residues: [Vec<f64>; E],
    pub(crate) stiffness: [f64; E],
    pub(crate) mass: [f64; E],
}

impl<const E: usize> EndSeries<E> {
    fn of<const N: usize>(all: &PoleResidue<N>, entries: [(usize, usize); E]) -> Self {
        Self {
            poles: all.poles.clone(),
            residues: entries.map(|(i, j)| all.participation.iter().map(|g| g[i] * g[j]).collect()),
            stiffness: entries.map(|(i, j)| all.stiffness[i][j]),
            mass: entries.map(|(i, j)| all.mass[i][j]),
        }
    }

    /// Places of the poles nearer to x than the part `width`.
    fn near(&self, x: f64, width: f64) -> Range<usize> {
        let from = self.poles.partition_point(|pole| *pole < x * (1.0 - width));
        let count = self.poles[from..].iter().take_while(|pole| **pole < x * (1.0 + width)).count();
        from..from + count
    }

    /// Undamped entries at x = ω², without the poles `left_out`.
    fn undamped(&self, x: f64, left_out: Range<usize>) -> [f64; E] {
        const LANES: usize = 8;
        let mut sums = [0.0; E];
        for range in [0..left_out.start, left_out.end..self.poles.len()] {
            let poles = &self.poles[range.clone()];
            let residues: [&[f64]; E] = std::array::from_fn(|e| &self.residues[e][range.clone()]);
            let whole = poles.len() / LANES * LANES;
            let mut lanes = [[0.0; LANES]; E];
            for (k, block) in poles.chunks_exact(LANES).enumerate() {
                let factors: [f64; LANES] = std::array::from_fn(|i| 1.0 / (block[i] - x));
                for (lanes, residues) in lanes.iter_mut().zip(residues) {
                    let block = &residues[k * LANES..(k + 1) * LANES];
                    for i in 0..LANES {
                        lanes[i] += block[i] * factors[i];
                    }
                }
            }
            for ((sum, lanes), residues) in sums.iter_mut().zip(&lanes).zip(residues) {
                *sum += lanes.iter().sum::<f64>();
                for (pole, residue) in poles[whole..].iter().zip(&residues[whole..]) {
                    *sum += residue / (pole - x);
                }
            }
        }
        std::array::from_fn(|e| self.stiffness[e] - x * (self.mass[e] + x * sums[e]))
    }
}

/// Most unknowns of one cable in its plane; they take about two seconds.
const MOST_UNKNOWNS: usize = 1200;

/// Estimated relative error of the clamped frequencies that the discretisation is refined to.
const WANTED_ERROR: f64 = 1e-11;

impl Exact {
    /// Of a static cable, good for frequencies up to ω = `limit` [rad/s].
    ///
    /// # Errors
    /// [`ExactError`].
    ///
    /// # Example
    /// ```
    /// use funicular::cable::exact::Exact;
    /// use funicular::catenary::{Catenary, Rope};
    /// let rope = Rope { unstrained_length: 6.9, weight_per_length: 0.657, axial_stiffness: 251_327.0 };
    /// let cable = Catenary::between(5.54, 4.025, rope)?;
    /// let exact = Exact::new(&cable, 0.067, 60.0)?;
    /// assert!(exact.error < 1e-9);
    /// // At rest it is the catenary's own stiffness.
    /// assert_eq!(exact.undamped(0.0).axial, cable.tangent()[0][0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(catenary: &Catenary, mass_per_length: f64, limit: f64) -> Result<Self, ExactError> {
        let mut mesh = Mesh::new(catenary, mass_per_length, limit)?;
        loop {
            let unknowns = mesh.unknowns();
            if unknowns > MOST_UNKNOWNS {
                return Err(ExactError::TooFine { unknowns, limit: MOST_UNKNOWNS });
            }
            let [[hh, hv], [_, vv]] = catenary.tangent();
            let o = catenary.out_of_plane_stiffness();
            let still = [[hh, hv, -hh, -hv], [hv, vv, -hv, -vv], [-hh, -hv, hh, hv], [-hv, -vv, hv, vv]];
            let (in_plane, error_in) = mesh.condense::<2, 4>(still, limit)?;
            let (out_of_plane, error_out) = mesh.condense::<1, 2>([[o, -o], [-o, o]], limit)?;
            let error = error_in.max(error_out);
            if error <= WANTED_ERROR || mesh.refined == MOST_REFINEMENTS {
                let degrees = mesh.elements.iter().map(|e| e.degree).collect();
                return Ok(Self { in_plane, out_of_plane, limit, error, degrees });
            }
            mesh.refine();
        }
    }

    /// Undamped stiffness of the start in the axes (horizontal towards the end, up, across) at ω [rad/s].
    pub fn undamped(&self, omega: f64) -> LocalStiffness<f64> {
        let x = omega * omega;
        let [axial, coupling, normal] = self.in_plane.undamped([(0, 0), (0, 1), (1, 1)], x);
        let [out_of_plane] = self.out_of_plane.undamped([(0, 0)], x);
        LocalStiffness { axial, coupling, normal, out_of_plane }
    }

    /// The same at the complex square ω_c² [rad²/s²].
    pub fn damped(&self, square: Complex) -> LocalStiffness<Complex> {
        let [axial, coupling, normal] = self.in_plane.damped([(0, 0), (0, 1), (1, 1)], square);
        let [out_of_plane] = self.out_of_plane.damped([(0, 0)], square);
        LocalStiffness { axial, coupling, normal, out_of_plane }
    }

    /// Minus the derivative of the undamped stiffness by ω² [kg], same axes.
    pub fn moving_mass(&self, omega: f64) -> LocalStiffness<f64> {
        let x = omega * omega;
        let [axial, coupling, normal] = self.in_plane.moving_mass([(0, 0), (0, 1), (1, 1)], x);
        let [out_of_plane] = self.out_of_plane.moving_mass([(0, 0)], x);
        LocalStiffness { axial, coupling, normal, out_of_plane }
    }
}

/// Refinements until the estimate is taken as it is; each adds a sixth of the degree and eight.
const MOST_REFINEMENTS: usize = 4;

/// A cable cut into elements, each with its polynomial degree.
struct Mesh<'a> {
    catenary: &'a Catenary,
    mass_per_length: f64,
    elements: Vec<Element>,
    refined: usize,
}

#[derive(Debug, Clone, Copy)]
struct Element {
    from: f64,
    to: f64,
    degree: usize,
}

/// A matrix over the functions of one element, two degrees more than it has: what the discretisation leaves out shows
/// in what these would answer.
const BEYOND: usize = 2;

impl<'a> Mesh<'a> {
    fn new(catenary: &'a Catenary, mass_per_length: f64, limit: f64) -> Result<Self, ExactError> {
        let rope = catenary.rope();
        let w = rope.weight_per_length;
        let (h, va) = (catenary.horizontal_force(), catenary.vertical_force_at_start());
        let straight = w == 0.0;
        // T is analytic but at V = ±iH, that is at s = lowest ± i H/w.
        let (lowest, depth) = (-va / w, h / w);
        let least = if !straight && (0.0..=rope.unstrained_length).contains(&lowest) {
            h
        } else {
            catenary.tension_at_start().min(catenary.tension_at_end())
        };
        if least.is_nan() || least <= 1e-9 * catenary.tension_at_end().max(catenary.tension_at_start()) {
            return Err(ExactError::NoTension);
        }
        let mut cuts = vec![(0.0, rope.unstrained_length)];
        let mut elements = Vec::new();
        while let Some((from, to)) = cuts.pop() {
            let (center, half) = (0.5 * (from + to), 0.5 * (to - from));
            // Size of the Bernstein ellipse through the singularity: the coefficients of C fall like its powers.
            let z = Complex::new((lowest - center) / half, depth / half);
            let root = (z * z - 1.0).sqrt();
            let size = if straight { f64::INFINITY } else { (z + root).norm().max((z - root).norm()) };
            if size < SMOOTH_ENOUGH {
                cuts.extend([(center, to), (from, center)]);
                continue;
            }
            // Phase of the transverse wave, the slower one, over the element (Simpson).
            let slowness = |s: f64| {
                let t = catenary.tension_at(s);
                (mass_per_length * (rope.axial_stiffness + t) / (rope.axial_stiffness * t)).sqrt()
            };
            let mean = (slowness(from) + 4.0 * slowness(center) + slowness(to)) / 6.0;
            let phase = limit * mean * (to - from);
            // 0.5 resolves a wave; the cube root is the width of the transition to exponential convergence.
            let waves = 0.53 * phase + 2.2 * (0.5 * phase).cbrt();
            let degree = (waves + 6.0 + 14.0 / size.ln()).ceil().min(1e6) as usize;
            elements.push(Element { from, to, degree });
        }
        Ok(Self { catenary, mass_per_length, elements, refined: 0 })
    }

    fn refine(&mut self) {
        self.refined += 1;
        for element in &mut self.elements {
            element.degree += element.degree / 6 + 8;
        }
    }

    /// Inner unknowns in plane.
    fn unknowns(&self) -> usize {
        2 * (self.elements.iter().map(|e| e.degree).sum::<usize>() - 1)
    }

    /// C at arc length s [N]: in plane (hh, hv, vv), out of plane the first only.
    fn tangent_at(&self, s: f64) -> ([f64; 3], f64) {
        let rope = self.catenary.rope();
        let h = self.catenary.horizontal_force();
        let v = self.catenary.vertical_force_at_start() + rope.weight_per_length * s;
        let tension = h.hypot(v);
        let ea = rope.axial_stiffness;
        let across = ea * tension / (ea + tension);
        let (c, s) = (h / tension, v / tension);
        let extra = ea - across;
        ([across + extra * c * c, extra * c * s, across + extra * s * s], across)
    }

    /// Condenses D components a point onto the two ends (N = 2D) with the static stiffness `still`; also the estimated
    /// relative error of the clamped frequencies below the limit.
    fn condense<const D: usize, const N: usize>(
        &self,
        still: [[f64; N]; N],
        limit: f64,
    ) -> Result<(PoleResidue<N>, f64), ExactError> {
        // Scalar functions: inner ones (nodes, then bubbles), the two ends, then those beyond the degree.
        let inner = self.elements.iter().map(|e| e.degree).sum::<usize>() - 1;
        let beyond = BEYOND * self.elements.len();
        let total = inner + 2 + beyond;
        let (n, count) = (D * inner, 2 * D * (2 + beyond));
        let mut stiffness = vec![0.0; n * n];
        let mut mass = vec![0.0; n * n];
        // Columns of K for ends and beyond, then the same of M, by rows.
        let mut columns = vec![0.0; n * count];
        let mut end_mass = [[0.0; N]; N];
        let mut own = vec![(0.0, 0.0); D * beyond];
        let nodes = self.elements.len() - 1;
        let mut bubble = nodes;
        for (e, element) in self.elements.iter().enumerate() {
            let left = if e == 0 { inner } else { e - 1 };
            let right = if e == nodes { inner + 1 } else { e };
            let functions: Vec<usize> = [left, right]
                .into_iter()
                .chain(bubble..bubble + element.degree - 1)
                .chain((0..BEYOND).map(|k| inner + 2 + BEYOND * e + k))
                .collect();
            bubble += element.degree - 1;
            let (k, m) = self.element_matrices::<D>(element);
            for (b, &column) in functions.iter().enumerate() {
                for (a, &row) in functions.iter().enumerate() {
                    let inertia = m[(a, b)];
                    for dj in 0..D {
                        for di in 0..D {
                            let (entry, inertia) = (k[di + dj][(a, b)], if di == dj { inertia } else { 0.0 });
                            if row < inner && column < inner {
                                stiffness[(D * column + dj) * n + D * row + di] += entry;
                                mass[(D * column + dj) * n + D * row + di] += inertia;
                            } else if row < inner {
                                let at = (D * row + di) * count + D * (column - inner) + dj;
                                columns[at] += entry;
                                columns[at + count / 2] += inertia;
                            } else if column < inner {
                                // The transpose of what the branch above takes.
                            } else if row < inner + 2 && column < inner + 2 {
                                end_mass[D * (row - inner) + di][D * (column - inner) + dj] += inertia;
                            } else if row == column && di == dj {
                                own[D * (row - inner - 2) + di] = (entry, inertia);
                            }
                        }
                    }
                }
            }
        }
        debug_assert!(total == inner + 2 + beyond && bubble == inner);
        let (values, products) = projected::pencil(stiffness, mass, columns, count).ok_or(ExactError::NoTension)?;
        Ok(self.pole_residue(&values, &products, still, end_mass, &own, limit))
    }

    /// Poles and residues from the eigenvalues μ = 1/ω² and the products of the eigenvectors, normalised to φᵀKφ = 1,
    /// with the columns a = K_ib and b = M_ib of the ends: `g = (b − μ a)/√μ`, `M_s = M_bb − Σ (b aᵀ + a bᵀ − μ a aᵀ)`.
    fn pole_residue<const N: usize>(
        &self,
        values: &[f64],
        products: &[f64],
        still: [[f64; N]; N],
        end_mass: [[f64; N]; N],
        own: &[(f64, f64)],
        limit: f64,
    ) -> (PoleResidue<N>, f64) {
        let count = products.len() / values.len().max(1);
        let mut order: Vec<usize> = (0..values.len()).filter(|&k| values[k] > 0.0).collect();
        order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
        let mut mass = end_mass;
        let mut error = 0.0_f64;
        let mut poles = Vec::with_capacity(order.len());
        let mut participation = Vec::with_capacity(order.len());
        for k in order {
            let mu = values[k];
            let (stiff, heavy) = products[k * count..(k + 1) * count].split_at(count / 2);
            for i in 0..N {
                for j in 0..N {
                    mass[i][j] -= heavy[i] * stiff[j] + stiff[i] * heavy[j] - mu * stiff[i] * stiff[j];
                }
            }
            poles.push(1.0 / mu);
            participation.push(std::array::from_fn(|i| (heavy[i] - mu * stiff[i]) / mu.sqrt()));
            if 1.0 / mu < limit * limit {
                // What the functions beyond would take off ω², to first order in each, over ω² (φᵀKφ = 1).
                let lost: f64 = own
                    .iter()
                    .enumerate()
                    .map(|(e, (k_own, m_own))| {
                        let answer = stiff[N + e] - heavy[N + e] / mu;
                        answer * answer / (k_own - m_own / mu).abs().max(f64::MIN_POSITIVE)
                    })
                    .sum();
                error = error.max(0.5 * lost);
            }
        }
        (PoleResidue { stiffness: still, mass, poles, participation }, error)
    }

    /// K of each component (hh, hv, vv, or one) and M of an element over its hats and bubbles, [`BEYOND`] included.
    fn element_matrices<const D: usize>(&self, element: &Element) -> (Vec<DMat>, DMat) {
        let half = 0.5 * (element.to - element.from);
        let middle = 0.5 * (element.to + element.from);
        let degree = element.degree + BEYOND;
        // Two slopes have degree 2p − 2; C takes its own share of the rule.
        let rule = legendre::gauss(degree + 8);
        let mut slopes = DMat::zeros(degree + 1, rule.len());
        let parts = 2 * D - 1;
        let mut weights = vec![vec![0.0; rule.len()]; parts];
        for (q, (xi, weight)) in rule.iter().enumerate() {
            let mut column = slopes.column_mut(q);
            column[0] = -0.5;
            column[1] = 0.5;
            for (j, p) in legendre::orthonormal(*xi, degree - 1).iter().enumerate().skip(1) {
                column[j + 1] = *p;
            }
            let (in_plane, across) = self.tangent_at(middle + half * xi);
            for (part, weights) in weights.iter_mut().enumerate() {
                weights[q] = weight / half * if D == 1 { across } else { in_plane[part] };
            }
        }
        let stiffness = weights
            .iter()
            .map(|weights| {
                let mut weighted = slopes.clone();
                for (mut column, w) in weighted.column_iter_mut().zip(weights) {
                    column *= *w;
                }
                weighted * slopes.transpose()
            })
            .collect();
        (stiffness, bubble_mass(degree) * (half * self.mass_per_length))
    }
}

/// Smallest Bernstein ellipse of an element. Cutting in two costs a node; at 1.3 a single element still converges, with
/// twice the degree, and below 2 every slack cable would be cut.
const SMOOTH_ENOUGH: f64 = 1.5;

/// ∫ N_a N_b dξ over [−1, 1] of the two hats and the bubbles `N_j = ∫ p_{j−1} = (P_j − P_{j−2})/√(2(2j − 1))`.
fn bubble_mass(degree: usize) -> DMat {
    let mut m = DMat::zeros(degree + 1, degree + 1);
    let mut set = |a: usize, b: usize, value: f64| {
        m[(a, b)] = value;
        m[(b, a)] = value;
    };
    set(0, 0, 2.0 / 3.0);
    set(1, 1, 2.0 / 3.0);
    set(0, 1, 1.0 / 3.0);
    // Index j of N_j is its place, since the hats take 0 and 1.
    if degree >= 2 {
        let value = -1.0 / 6f64.sqrt();
        set(0, 2, value);
        set(1, 2, value);
    }
    if degree >= 3 {
        let value = 1.0 / (3.0 * 10f64.sqrt());
        set(0, 3, value);
        set(1, 3, -value);
    }
    for j in 2..=degree {
        let n = j as f64;
        set(j, j, 2.0 / ((2.0 * n + 1.0) * (2.0 * n - 3.0)));
        if j + 2 <= degree {
            set(j, j + 2, -1.0 / ((2.0 * n + 1.0) * ((2.0 * n - 1.0) * (2.0 * n + 3.0)).sqrt()));
        }
    }
    m
}
