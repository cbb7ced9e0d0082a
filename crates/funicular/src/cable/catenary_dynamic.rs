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

mod internal_motion;
mod mesh;
mod partition;
mod poles;

pub(crate) use internal_motion::InternalMotion;
pub use internal_motion::{Displacements, Stations};
pub(crate) use mesh::{ellipse, has_tension};
pub use poles::PoleResidue;

use super::{LocalAxes, LocalStiffness};
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
pub struct CatenaryDynamic {
    /// In plane: components (horizontal, up) of the start, then of the end.
    pub in_plane: PoleResidue<4, 3>,
    /// Out of plane: start, then end.
    pub out_of_plane: PoleResidue<2, 1>,
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
         limit, or choose the model `shallow-dynamic`"
    )]
    TooFine {
        /// Unknowns needed.
        unknowns: usize,
        /// Unknowns allowed.
        limit: usize,
    },
}

/// The platform end of a catenary-dynamic cable: its axes and its damping.
#[derive(Debug, Clone, PartialEq)]
pub struct ExactEnd {
    /// Poles and residues, the platform being the start.
    pub exact: CatenaryDynamic,
    /// e horizontal towards the anchor, n up, b across.
    pub axes: LocalAxes,
    /// Damping of the rope.
    pub damping: Damping,
    /// Mass per unstrained length m [kg/m].
    pub mass_per_length: f64,
    /// Leave out the stiffness across, as the paper does.
    pub in_plane_only: bool,
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
        let exact = CatenaryDynamic::new(&hanging.catenary, mass_per_length, limit)?;
        let (e, n) = hanging.axes_w();
        let axes = LocalAxes { e, n, b: e.cross(&n) };
        Ok(Self { exact, axes, damping, mass_per_length, in_plane_only, kept: None })
    }

    /// With the poles below x, and a few in place of the others: see [`PoleResidue::compressed`].
    pub(crate) fn with_poles_below(&self, x: f64) -> Self {
        let mut cut = self.clone();
        let (plane, across) = (self.exact.in_plane.poles_below(x), self.exact.out_of_plane.poles_below(x));
        cut.exact.in_plane = self.exact.in_plane.compressed(plane, 2).0;
        cut.exact.out_of_plane = self.exact.out_of_plane.compressed(across, 1).0;
        cut.kept = Some((plane, across));
        cut
    }

    /// Motion in the cable's plane.
    pub(crate) fn plane(&self) -> &PoleResidue<4, 3> {
        &self.exact.in_plane
    }

    /// Motion out of the cable's plane, unless it is left out.
    pub(crate) fn out_of_plane(&self) -> Option<&PoleResidue<2, 1>> {
        (!self.in_plane_only).then_some(&self.exact.out_of_plane)
    }

    /// Entries in plane, with those out of plane unless they are left out.
    fn with_out_of_plane<T: Default>(
        &self,
        in_plane: [T; 3],
        entries: impl FnOnce(&PoleResidue<2, 1>) -> [T; 1],
    ) -> LocalStiffness<T> {
        local(in_plane, self.out_of_plane().map_or_else(Default::default, entries))
    }

    /// Undamped stiffness at ω [rad/s], [N/m].
    pub fn undamped(&self, omega: f64) -> LocalStiffness<f64> {
        let x = omega * omega;
        self.with_out_of_plane(self.plane().undamped(x, 0..0), |across| across.undamped(x, 0..0))
    }

    /// Damped stiffness at ω [rad/s], [N/m].
    pub fn damped(&self, omega: f64) -> LocalStiffness<Complex> {
        let (re, im) = self.damping.square(omega, self.mass_per_length);
        let square = Complex::new(re, im);
        self.with_out_of_plane(self.plane().damped(square), |across| across.damped(square))
    }

    /// Minus the derivative of the undamped stiffness by ω² [kg].
    pub fn effective_mass(&self, omega: f64) -> LocalStiffness<f64> {
        let x = omega * omega;
        self.with_out_of_plane(self.plane().effective_mass(x, 0..0), |across| across.effective_mass(x, 0..0))
    }

    /// Number of clamped-clamped frequencies below ω [rad/s].
    pub fn clamped_modes_below(&self, omega: f64) -> usize {
        let x = omega * omega;
        self.plane().poles_below(x) + self.out_of_plane().map_or(0, |across| across.poles_below(x))
    }

    /// The clamped-clamped frequencies below ω [rad/s], ascending.
    pub fn clamped_frequencies_below(&self, omega: f64) -> Vec<f64> {
        let mut all: Vec<f64> = self.poles_below(omega * omega).map(f64::sqrt).collect();
        all.sort_by(f64::total_cmp);
        all
    }

    /// The poles below x, in plane and then out of plane.
    pub(crate) fn poles_below(&self, x: f64) -> impl Iterator<Item = f64> + '_ {
        let plane = &self.plane().poles[..self.plane().poles_below(x)];
        let across = self.out_of_plane().map_or(&[][..], |across| &across.poles[..across.poles_below(x)]);
        plane.iter().chain(across).copied()
    }

    /// Undamped stiffness at x = ω² without the poles nearer to it than the fraction `width`, and those poles.
    pub(crate) fn beside_poles(&self, x: f64, width: f64) -> (LocalStiffness<f64>, Vec<NearPole>) {
        let (plane, across) = self.near(x, width);
        let stiffness = self
            .with_out_of_plane(self.plane().undamped(x, plane.clone()), |family| family.undamped(x, across.clone()));
        (stiffness, self.near_poles(plane, across))
    }

    /// Damped stiffness at the complex x = ω_c² without the poles nearer to its real part than the fraction `width`, minus
    /// its derivative by x [kg], and those poles.
    pub(crate) fn complex_beside_poles(
        &self,
        x: Complex,
        width: f64,
    ) -> (LocalStiffness<Complex>, LocalStiffness<Complex>, Vec<NearPole>) {
        let (plane, across) = self.near(x.re, width);
        let (k, mass) = self.plane().with_derivative(x, plane.clone());
        let (k_across, mass_across) = match self.out_of_plane() {
            Some(family) => family.with_derivative(x, across.clone()),
            None => Default::default(),
        };
        let stiffness = self.with_out_of_plane(k, |_| k_across);
        let effective_mass = self.with_out_of_plane(mass, |_| mass_across);
        (stiffness, effective_mass, self.near_poles(plane, across))
    }

    /// Minus the derivative by ω² of the undamped stiffness at x = ω² [kg], the poles of
    /// [`beside_poles`](Self::beside_poles) being amplitudes of their own.
    pub(crate) fn effective_mass_beside_poles(&self, x: f64, width: f64) -> LocalStiffness<f64> {
        let (plane, across) = self.near(x, width);
        self.with_out_of_plane(self.plane().effective_mass(x, plane), |family| family.effective_mass(x, across))
    }

    /// Places of the poles nearer to x than the fraction `width` of it, in plane and out of plane.
    fn near(&self, x: f64, width: f64) -> (Range<usize>, Range<usize>) {
        (self.plane().near(x, width), self.out_of_plane().map_or(0..0, |across| across.near(x, width)))
    }

    fn near_poles(&self, plane: Range<usize>, across: Range<usize>) -> Vec<NearPole> {
        let CatenaryDynamic { in_plane, out_of_plane, .. } = &self.exact;
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
const MAX_UNKNOWNS: usize = 1200;

/// Estimated relative error of the clamped frequencies that the discretisation is refined to.
const WANTED_ERROR: f64 = 1e-11;

impl CatenaryDynamic {
    /// Of a static cable, good for frequencies up to ω = `limit` [rad/s].
    ///
    /// # Errors
    /// [`ExactError`].
    ///
    /// # Example
    /// ```
    /// use funicular::cable::catenary_dynamic::CatenaryDynamic;
    /// use funicular::catenary::{Catenary, Rope};
    /// let rope = Rope { unstrained_length: 6.9, weight_per_length: 0.657, axial_stiffness: 251_327.0 };
    /// let cable = Catenary::between(5.54, 4.025, rope)?;
    /// let exact = CatenaryDynamic::new(&cable, 0.067, 60.0)?;
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
            if unknowns > MAX_UNKNOWNS {
                return Err(ExactError::TooFine { unknowns, limit: MAX_UNKNOWNS });
            }

            // Static stiffness of both ends.
            let [[hh, hv], [_, vv]] = catenary.tangent();
            let o = catenary.out_of_plane_stiffness();
            let still = [[hh, hv, -hh, -hv], [hv, vv, -hv, -vv], [-hh, -hv, hh, hv], [-hv, -vv, hv, vv]];

            // Poles and residues of both families.
            let tables = mesh.tables();
            let plane: Condensed<2, 4, 3> = mesh.condense(&tables, still, limit, &arc_lengths)?;
            let across: Condensed<1, 2, 1> = mesh.condense(&tables, [[o, -o], [-o, o]], limit, &arc_lengths)?;
            let error = plane.error.max(across.error);

            // Taken if fine enough, or refined.
            if error <= WANTED_ERROR || mesh.refined == MAX_REFINEMENTS {
                let (in_plane, out_of_plane) = (plane.ends, across.ends);
                let exact = Self { in_plane, out_of_plane, limit, error, degrees: mesh.degrees() };
                let (in_plane, out_of_plane) = (plane.stations, across.stations);
                return Ok((exact, Stations { arc_lengths, in_plane, out_of_plane }));
            }
            mesh.refine();
        }
    }

    /// Undamped stiffness of the start in the axes (horizontal towards the end, up, out of plane) at ω [rad/s], [N/m].
    pub fn undamped(&self, omega: f64) -> LocalStiffness<f64> {
        let x = omega * omega;
        local(self.in_plane.undamped(x, 0..0), self.out_of_plane.undamped(x, 0..0))
    }

    /// Stiffness of the start in the same axes at the complex square ω_c² [rad²/s²], [N/m].
    pub fn damped(&self, square: Complex) -> LocalStiffness<Complex> {
        local(self.in_plane.damped(square), self.out_of_plane.damped(square))
    }

    /// Minus the derivative of the undamped stiffness by ω² in the same axes [kg].
    pub fn effective_mass(&self, omega: f64) -> LocalStiffness<f64> {
        let x = omega * omega;
        local(self.in_plane.effective_mass(x, 0..0), self.out_of_plane.effective_mass(x, 0..0))
    }
}

/// Entries in plane and out of plane, in the order that [`PoleResidue`] has them.
fn local<T>([axial, coupling, normal]: [T; 3], [out_of_plane]: [T; 1]) -> LocalStiffness<T> {
    LocalStiffness { axial, coupling, normal, out_of_plane }
}

/// Refinements until the estimate is taken as it is; each adds a sixth of the degree and eight.
const MAX_REFINEMENTS: usize = 4;
