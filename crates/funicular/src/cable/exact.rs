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

mod mesh;
mod partition;
mod poles;
mod shape;

pub(crate) use mesh::{ellipse, has_tension};
pub(crate) use poles::EndSeries;
pub use poles::PoleResidue;
pub(crate) use shape::Swing;
pub use shape::{Displacements, Stations};

use super::{LocalAxes, LocalStiffness, damped_square};
use crate::catenary::Catenary;
use crate::catenary::space::HangingCable;
use crate::math::Complex;
use crate::robot::Damping;
use mesh::Mesh;
use partition::Condensed;
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
    #[error(
        "the frequency limit asked needs {unknowns} or more unknowns for one cable, at most {limit} are taken: lower the \
         limit, or choose the model `closed-form`"
    )]
    TooFine {
        /// Unknowns needed.
        unknowns: usize,
        /// Unknowns allowed.
        limit: usize,
    },
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
    /// How many poles in plane and across are its own, where the others have been compressed.
    pub(crate) kept: Option<(usize, usize)>,
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
        Ok(Self { exact, axes, damping, mass_per_length, in_plane_only, plane, across, kept: None })
    }

    /// With the poles below x, and a few in place of the others: see [`PoleResidue::compressed`].
    pub(crate) fn with_poles_below(&self, x: f64) -> Self {
        let mut cut = self.clone();
        let (plane, across) = (self.exact.in_plane.poles_below(x), self.exact.out_of_plane.poles_below(x));
        cut.exact.in_plane = self.exact.in_plane.compressed(plane, 2).0;
        cut.exact.out_of_plane = self.exact.out_of_plane.compressed(across, 1).0;
        cut.kept = Some((plane, across));
        cut.plane = EndSeries::of(&cut.exact.in_plane, [(0, 0), (0, 1), (1, 1)]);
        cut.across = EndSeries::of(&cut.exact.out_of_plane, [(0, 0)]);
        cut
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
        let mut all: Vec<f64> = self.poles_below(omega * omega).map(f64::sqrt).collect();
        all.sort_by(f64::total_cmp);
        all
    }

    /// The poles below x, in plane and then across.
    pub(crate) fn poles_below(&self, x: f64) -> impl Iterator<Item = f64> + '_ {
        let Exact { in_plane, out_of_plane, .. } = &self.exact;
        let count = if self.in_plane_only { 0 } else { out_of_plane.poles_below(x) };
        in_plane.poles[..in_plane.poles_below(x)].iter().chain(&out_of_plane.poles[..count]).copied()
    }

    /// The undamped stiffness at x = ω² without the poles nearer to it than the part `width`, and those poles.
    pub(crate) fn beside_poles(&self, x: f64, width: f64) -> (LocalStiffness<f64>, Vec<NearPole>) {
        let (plane, across) = self.near(x, width);
        let [axial, coupling, normal] = self.plane.undamped(x, plane.clone());
        let [out_of_plane] = if self.in_plane_only { [0.0] } else { self.across.undamped(x, across.clone()) };
        (LocalStiffness { axial, coupling, normal, out_of_plane }, self.near_poles(plane, across))
    }

    /// The same at the complex x = ω_c², with minus its derivative by x [kg].
    pub(crate) fn complex_beside_poles(
        &self,
        x: Complex,
        width: f64,
    ) -> (LocalStiffness<Complex>, LocalStiffness<Complex>, Vec<NearPole>) {
        let (plane, across) = self.near(x.re, width);
        let Exact { in_plane, out_of_plane, .. } = &self.exact;
        let ([ka, kb, kc], [ma, mb, mc]) = in_plane.with_derivative([(0, 0), (0, 1), (1, 1)], x, plane.clone());
        let ([ko], [mo]) = out_of_plane.with_derivative([(0, 0)], x, across.clone());
        let k = LocalStiffness { axial: ka, coupling: kb, normal: kc, out_of_plane: ko };
        let mass = LocalStiffness { axial: ma, coupling: mb, normal: mc, out_of_plane: mo };
        (self.in_plane_if_asked(k), self.in_plane_if_asked(mass), self.near_poles(plane, across))
    }

    /// Places of the poles nearer to x than the part `width`, in plane and across.
    fn near(&self, x: f64, width: f64) -> (Range<usize>, Range<usize>) {
        (self.plane.near(x, width), if self.in_plane_only { 0..0 } else { self.across.near(x, width) })
    }

    fn near_poles(&self, plane: Range<usize>, across: Range<usize>) -> Vec<NearPole> {
        let Exact { in_plane, out_of_plane, .. } = &self.exact;
        let in_plane = plane.map(|index| {
            let [e, n, ..] = in_plane.participation[index];
            NearPole { direction: [e, n, 0.0], pole: in_plane.poles[index], across: false, index }
        });
        let out_of_plane = across.map(|index| {
            let [b, _] = out_of_plane.participation[index];
            NearPole { direction: [0.0, 0.0, b], pole: out_of_plane.poles[index], across: true, index }
        });
        in_plane.chain(out_of_plane).collect()
    }

    /// Minus the derivative by ω² of the undamped stiffness at x = ω² [kg], the poles of
    /// [`beside_poles`](Self::beside_poles) being amplitudes of their own.
    pub(crate) fn moving_mass_beside_poles(&self, x: f64, width: f64) -> LocalStiffness<f64> {
        let (plane, across) = self.near(x, width);
        let [axial, coupling, normal] = self.exact.in_plane.moving_mass([(0, 0), (0, 1), (1, 1)], x, plane);
        let [out_of_plane] = self.exact.out_of_plane.moving_mass([(0, 0)], x, across);
        self.in_plane_if_asked(LocalStiffness { axial, coupling, normal, out_of_plane })
    }
}

/// A pole near a frequency.
pub(crate) struct NearPole {
    /// g_k of the platform end in (e, n, b) [√kg].
    pub(crate) direction: [f64; 3],
    /// ω_k² [rad²/s²].
    pub(crate) pole: f64,
    /// Out of plane.
    pub(crate) across: bool,
    /// Its place in the cable's list.
    pub(crate) index: usize,
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
        Ok(Self::with_stations(catenary, mass_per_length, limit, Vec::new(), false)?.0)
    }

    /// The same, and how the points at unstrained arc lengths from the start [m] move: also under forces at those points
    /// if they are `loaded`, which each cost an element.
    ///
    /// # Errors
    /// [`ExactError`].
    pub fn with_stations(
        catenary: &Catenary,
        mass_per_length: f64,
        limit: f64,
        arc_lengths: Vec<f64>,
        loaded: bool,
    ) -> Result<(Self, Stations), ExactError> {
        let mut mesh = Mesh::new(catenary, mass_per_length, limit, if loaded { &arc_lengths } else { &[] })?;
        loop {
            let unknowns = mesh.unknowns();
            if unknowns > MOST_UNKNOWNS {
                return Err(ExactError::TooFine { unknowns, limit: MOST_UNKNOWNS });
            }
            let [[hh, hv], [_, vv]] = catenary.tangent();
            let o = catenary.out_of_plane_stiffness();
            let still = [[hh, hv, -hh, -hv], [hv, vv, -hv, -vv], [-hh, -hv, hh, hv], [-hv, -vv, hv, vv]];
            let tables = mesh.tables();
            let plane: Condensed<2, 4> = mesh.condense(&tables, still, limit, &arc_lengths)?;
            let across: Condensed<1, 2> = mesh.condense(&tables, [[o, -o], [-o, o]], limit, &arc_lengths)?;
            let error = plane.error.max(across.error);
            if error <= WANTED_ERROR || mesh.refined == MOST_REFINEMENTS {
                let (in_plane, out_of_plane) = (plane.ends, across.ends);
                let exact = Self { in_plane, out_of_plane, limit, error, degrees: mesh.degrees() };
                let (in_plane, out_of_plane) = (plane.stations, across.stations);
                return Ok((exact, Stations { arc_lengths, in_plane, out_of_plane }));
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
        let [axial, coupling, normal] = self.in_plane.moving_mass([(0, 0), (0, 1), (1, 1)], x, 0..0);
        let [out_of_plane] = self.out_of_plane.moving_mass([(0, 0)], x, 0..0);
        LocalStiffness { axial, coupling, normal, out_of_plane }
    }
}

/// Refinements until the estimate is taken as it is; each adds a sixth of the degree and eight.
const MOST_REFINEMENTS: usize = 4;
