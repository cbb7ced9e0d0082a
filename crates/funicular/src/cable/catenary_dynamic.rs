//! Dynamic stiffness of both ends of a cable of any sag: linear vibration about the elastic catenary, axial inertia
//! included. The discretisation is refined until its error is negligible.
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
//! K_s and M_s being the static condensation and g_k the participation of the ends in mode k: a few operations per
//! pole. Derivation: docs/theory.md, section 9.

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
use crate::drive::AnchorEnd;
use crate::math::Complex;
use crate::robot::Damping;
use mesh::Mesh;
use partition::Condensed;
use std::ops::Range;
use thiserror::Error;

/// Dynamic stiffness of both ends of a cable as poles and residues, in plane and out of plane.
#[derive(Debug, Clone, PartialEq)]
pub struct CatenaryDynamic {
    /// Stiffness in plane: components (horizontal, up) of the start, then of the end.
    pub in_plane: PoleResidue<4, 3>,
    /// Stiffness out of plane: start, then end.
    pub out_of_plane: PoleResidue<2, 1>,
    /// Highest angular frequency for which the discretisation was made [rad/s].
    pub limit: f64,
    /// Estimated relative error of the clamped frequencies below the limit.
    pub error: f64,
    /// Polynomial degree of each element.
    pub degrees: Vec<usize>,
    /// Motion that the end has; `None` for an end that is held. The components of a moving end are zero in the
    /// stiffness, the mass and the participations: it belongs to the inside of the cable.
    pub end: Option<MovingEnd>,
}

/// End of a cable that can move: along the cable, as on a pulley with an elastic cable behind it, and out of plane, as
/// on a pulley that swivels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovingEnd {
    /// Direction along the cable: its components (horizontal, up).
    pub along: [f64; 2],
    /// Stiffness against motion in this direction [N/m].
    pub stiffness: f64,
    /// Stiffness against motion out of plane [N/m]; `None` if the end is held out of plane.
    pub out_of_plane: Option<f64>,
}

/// Maximum component out of plane of the direction in which an end moves along the cable, and maximum coupling between
/// its motions over their stiffness: rounding is 1e-15, and the frequencies change by the square of both.
const IN_PLANE: f64 = 1e-8;

impl MovingEnd {
    /// Motion of the end of a hanging cable at its pulley and winch; `None` if it is held.
    ///
    /// # Errors
    /// [`CatenaryDynamicError::Skew`]: the end moves in and out of plane at the same time.
    fn of(hanging: &HangingCable, end: &AnchorEnd) -> Result<Option<Self>, CatenaryDynamicError> {
        let Some(along_w) = end.along_w else { return Ok(None) };
        let (horizontal_w, up_w) = hanging.axes_w();
        let out_w = horizontal_w.cross(&up_w);

        // The motions have to be in plane and out of plane.
        let [[stiffness, coupling], [_, sideways]] = end.stiffness;
        let skew = end.sideways_w.map_or(0.0, |sideways_w| {
            let turned = (sideways_w - out_w * out_w.dot(&sideways_w)).norm();
            turned.max(coupling.abs() / (stiffness * sideways).abs().sqrt())
        });
        if skew.max(out_w.dot(&along_w).abs()) > IN_PLANE {
            return Err(CatenaryDynamicError::Skew);
        }
        let along = [horizontal_w.dot(&along_w), up_w.dot(&along_w)];
        Ok(Some(Self { along, stiffness, out_of_plane: end.sideways_w.map(|_| sideways) }))
    }

    /// Static stiffness of the start in plane and out of plane, from those with the end held; zero for the end.
    fn still(&self, [[hh, hv], [_, vv]]: [[f64; 2]; 2], o: f64) -> ([[f64; 4]; 4], [[f64; 2]; 2]) {
        let [h, v] = self.along;
        let pulled = [hh * h + hv * v, hv * h + vv * v];
        let total = self.stiffness + h * pulled[0] + v * pulled[1];
        let left = |held: f64, i: usize, j: usize| held - pulled[i] * pulled[j] / total;

        let mut in_plane = [[0.0; 4]; 4];
        (in_plane[0][0], in_plane[1][1]) = (left(hh, 0, 0), left(vv, 1, 1));
        (in_plane[0][1], in_plane[1][0]) = (left(hv, 0, 1), left(hv, 0, 1));
        match self.out_of_plane {
            Some(sideways) => (in_plane, [[o - o * o / (o + sideways), 0.0], [0.0, 0.0]]),
            None => (in_plane, [[o, -o], [-o, o]]),
        }
    }
}

/// Reason for which a cable has no catenary-dynamic stiffness.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum CatenaryDynamicError {
    /// A point of the cable has no tension: a slack massless cable, or a loop that hangs straight down.
    #[error("the cable has no tension at its lowest point: it has no linear vibration")]
    NoTension,
    /// The end of the cable moves in its plane and out of it at the same time.
    #[error(
        "the swivel axis of its pulley is not parallel to the load of the cable: the model exists for pulleys whose \
         swivel axis is vertical, and without wind; choose the model `catenary-static`"
    )]
    Skew,
    /// The requested frequency needs too fine a discretisation.
    #[error(
        "the requested frequency limit needs at least {unknowns} unknowns for one cable, the maximum is {limit}: lower \
         the frequency limit, or choose the model `shallow-dynamic`"
    )]
    TooFine {
        /// Unknowns needed.
        unknowns: usize,
        /// Unknowns allowed.
        limit: usize,
    },
}

/// Platform end of a catenary-dynamic cable, with its axes and its damping.
#[derive(Debug, Clone, PartialEq)]
pub struct CatenaryDynamicEnd {
    /// Poles and residues of the cable; its start is at the platform.
    pub cable: CatenaryDynamic,
    /// Local axes: e horizontal towards the anchor, n up, b out of plane.
    pub axes: LocalAxes,
    /// Damping of the rope.
    pub damping: Damping,
    /// Mass per unstrained length m [kg/m].
    pub mass_per_length: f64,
    /// Leave out the stiffness out of plane, as the paper does.
    pub in_plane_only: bool,
    /// Numbers of original poles in plane and out of plane, if the other poles have been compressed.
    pub(crate) kept: Option<(usize, usize)>,
}

impl CatenaryDynamicEnd {
    /// Platform end of a hanging cable, valid up to ω = `limit` [rad/s]. `end` is its end at the pulley or the winch;
    /// `None` for a fixed anchor.
    ///
    /// # Errors
    /// [`CatenaryDynamicError`].
    pub fn new(
        hanging: &HangingCable,
        end: Option<&AnchorEnd>,
        mass_per_length: f64,
        damping: Damping,
        in_plane_only: bool,
        limit: f64,
    ) -> Result<Self, CatenaryDynamicError> {
        let end = end.map(|end| MovingEnd::of(hanging, end)).transpose()?.flatten();
        let cable =
            CatenaryDynamic::with_stations(&hanging.catenary, end, mass_per_length, limit, Vec::new(), false)?.0;
        let (e, n) = hanging.axes_w();
        let axes = LocalAxes { e, n, b: e.cross(&n) };
        Ok(Self { cable, axes, damping, mass_per_length, in_plane_only, kept: None })
    }

    /// Copy that keeps the poles below x and has a few poles in place of the others: see [`PoleResidue::compressed`].
    pub(crate) fn with_poles_below(&self, x: f64) -> Self {
        let mut cut = self.clone();
        let (in_plane, out_of_plane) = (self.cable.in_plane.poles_below(x), self.cable.out_of_plane.poles_below(x));
        cut.cable.in_plane = self.cable.in_plane.compressed(in_plane, 2).0;
        cut.cable.out_of_plane = self.cable.out_of_plane.compressed(out_of_plane, 1).0;
        cut.kept = Some((in_plane, out_of_plane));
        cut
    }

    /// Poles and residues in plane.
    pub(crate) fn in_plane(&self) -> &PoleResidue<4, 3> {
        &self.cable.in_plane
    }

    /// Poles and residues out of plane; `None` if they are left out.
    pub(crate) fn out_of_plane(&self) -> Option<&PoleResidue<2, 1>> {
        (!self.in_plane_only).then_some(&self.cable.out_of_plane)
    }

    /// Local stiffness from its entries in plane, and those out of plane unless they are left out.
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
        self.with_out_of_plane(self.in_plane().undamped(x, 0..0), |family| family.undamped(x, 0..0))
    }

    /// Damped stiffness at ω [rad/s], [N/m].
    pub fn damped(&self, omega: f64) -> LocalStiffness<Complex> {
        let (re, im) = self.damping.square(omega, self.mass_per_length);
        let square = Complex::new(re, im);
        self.with_out_of_plane(self.in_plane().damped(square), |family| family.damped(square))
    }

    /// Minus the derivative of the undamped stiffness by ω² [kg].
    pub fn effective_mass(&self, omega: f64) -> LocalStiffness<f64> {
        let x = omega * omega;
        self.with_out_of_plane(self.in_plane().effective_mass(x, 0..0), |family| family.effective_mass(x, 0..0))
    }

    /// Number of clamped-clamped frequencies below ω [rad/s].
    pub fn clamped_modes_below(&self, omega: f64) -> usize {
        let x = omega * omega;
        self.in_plane().poles_below(x) + self.out_of_plane().map_or(0, |family| family.poles_below(x))
    }

    /// Clamped-clamped frequencies below ω [rad/s], ascending.
    pub fn clamped_frequencies_below(&self, omega: f64) -> Vec<f64> {
        let mut all: Vec<f64> = self.poles_below(omega * omega).map(f64::sqrt).collect();
        all.sort_by(f64::total_cmp);
        all
    }

    /// Poles below x, in plane and then out of plane.
    pub(crate) fn poles_below(&self, x: f64) -> impl Iterator<Item = f64> + '_ {
        let in_plane = &self.in_plane().poles[..self.in_plane().poles_below(x)];
        let out_of_plane = self.out_of_plane().map_or(&[][..], |family| &family.poles[..family.poles_below(x)]);
        in_plane.iter().chain(out_of_plane).copied()
    }

    /// Undamped stiffness at x = ω² without the poles in the relative distance `width` of x, and those poles.
    pub(crate) fn beside_poles(&self, x: f64, width: f64) -> (LocalStiffness<f64>, Vec<NearPole>) {
        let (in_plane, out_of_plane) = self.near(x, width);
        let stiffness = self.with_out_of_plane(self.in_plane().undamped(x, in_plane.clone()), |family| {
            family.undamped(x, out_of_plane.clone())
        });
        (stiffness, self.near_poles(in_plane, out_of_plane))
    }

    /// Damped stiffness at the complex x = ω_c² without the poles in the relative distance `width` of the real part of
    /// x, minus its derivative by x [kg], and those poles.
    pub(crate) fn complex_beside_poles(
        &self,
        x: Complex,
        width: f64,
    ) -> (LocalStiffness<Complex>, LocalStiffness<Complex>, Vec<NearPole>) {
        let (in_plane, out_of_plane) = self.near(x.re, width);
        let (k, mass) = self.in_plane().with_derivative(x, in_plane.clone());
        let (k_out_of_plane, mass_out_of_plane) = match self.out_of_plane() {
            Some(family) => family.with_derivative(x, out_of_plane.clone()),
            None => Default::default(),
        };
        let stiffness = self.with_out_of_plane(k, |_| k_out_of_plane);
        let effective_mass = self.with_out_of_plane(mass, |_| mass_out_of_plane);
        (stiffness, effective_mass, self.near_poles(in_plane, out_of_plane))
    }

    /// Minus the derivative by ω² of the undamped stiffness at x = ω² [kg], without the poles that
    /// [`beside_poles`](Self::beside_poles) leaves out.
    pub(crate) fn effective_mass_beside_poles(&self, x: f64, width: f64) -> LocalStiffness<f64> {
        let (in_plane, out_of_plane) = self.near(x, width);
        self.with_out_of_plane(self.in_plane().effective_mass(x, in_plane), |family| {
            family.effective_mass(x, out_of_plane)
        })
    }

    /// Indices of the poles in the relative distance `width` of x, in plane and out of plane.
    fn near(&self, x: f64, width: f64) -> (Range<usize>, Range<usize>) {
        (self.in_plane().near(x, width), self.out_of_plane().map_or(0..0, |family| family.near(x, width)))
    }

    /// Poles at the given places in plane and out of plane.
    fn near_poles(&self, in_plane: Range<usize>, out_of_plane: Range<usize>) -> Vec<NearPole> {
        let CatenaryDynamic { in_plane: plane_family, out_of_plane: normal_family, .. } = &self.cable;
        let in_plane = in_plane.map(|index| {
            let [e, n, ..] = plane_family.participation[index];
            NearPole { direction: [e, n, 0.0], pole: plane_family.poles[index], out_of_plane: false, index }
        });
        let out_of_plane = out_of_plane.map(|index| {
            let [b, _] = normal_family.participation[index];
            NearPole { direction: [0.0, 0.0, b], pole: normal_family.poles[index], out_of_plane: true, index }
        });
        in_plane.chain(out_of_plane).collect()
    }
}

/// Pole near a frequency.
pub(crate) struct NearPole {
    /// g_k of the platform end in (e, n, b) [√kg].
    pub(crate) direction: [f64; 3],
    /// ω_k² [rad²/s²].
    pub(crate) pole: f64,
    /// True for a mode out of the cable's plane.
    pub(crate) out_of_plane: bool,
    /// Index in the cable's list of poles in plane or out of plane.
    pub(crate) index: usize,
}

/// Maximum number of unknowns of one cable in plane; the eigenproblem then takes about two seconds.
const MAX_UNKNOWNS: usize = 1200;

/// Estimated relative error of the clamped frequencies at which the refinement of the discretisation ends.
const WANTED_ERROR: f64 = 1e-11;

impl CatenaryDynamic {
    /// Dynamic stiffness of a cable about its catenary, valid for frequencies up to ω = `limit` [rad/s].
    ///
    /// # Errors
    /// [`CatenaryDynamicError`].
    ///
    /// # Example
    /// ```
    /// use funicular::cable::catenary_dynamic::CatenaryDynamic;
    /// use funicular::catenary::{Catenary, Rope};
    /// let rope = Rope { unstrained_length: 6.9, weight_per_length: 0.657, axial_stiffness: 251_327.0 };
    /// let catenary = Catenary::between(5.54, 4.025, rope)?;
    /// let cable = CatenaryDynamic::new(&catenary, 0.067, 60.0)?;
    /// assert!(cable.error < 1e-9);
    /// // At ω = 0 it has the static stiffness of the catenary.
    /// assert_eq!(cable.undamped(0.0).axial, catenary.tangent()[0][0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(catenary: &Catenary, mass_per_length: f64, limit: f64) -> Result<Self, CatenaryDynamicError> {
        Ok(Self::with_stations(catenary, None, mass_per_length, limit, Vec::new(), false)?.0)
    }

    /// Dynamic stiffness as by [`new`](Self::new), and the displacements of the points at the given unstrained arc
    /// lengths from the start [m]. With `loaded`, forces may act at these points; each of them then costs an element. An
    /// `end` that can move is part of the inside of the cable.
    ///
    /// # Errors
    /// [`CatenaryDynamicError`].
    pub fn with_stations(
        catenary: &Catenary,
        end: Option<MovingEnd>,
        mass_per_length: f64,
        limit: f64,
        arc_lengths: Vec<f64>,
        loaded: bool,
    ) -> Result<(Self, Stations), CatenaryDynamicError> {
        let cuts = if loaded { &arc_lengths[..] } else { &[] };
        let mut mesh = Mesh::new(catenary, mass_per_length, limit, cuts, end.is_some())?;
        loop {
            let unknowns = mesh.unknowns();
            if unknowns > MAX_UNKNOWNS {
                return Err(CatenaryDynamicError::TooFine { unknowns, limit: MAX_UNKNOWNS });
            }

            // Static stiffness of both ends.
            let [[hh, hv], [_, vv]] = catenary.tangent();
            let o = catenary.out_of_plane_stiffness();
            let (still, still_out_of_plane) = match &end {
                None => {
                    let both = [[hh, hv, -hh, -hv], [hv, vv, -hv, -vv], [-hh, -hv, hh, hv], [-hv, -vv, hv, vv]];
                    (both, [[o, -o], [-o, o]])
                }
                Some(end) => end.still([[hh, hv], [hv, vv]], o),
            };

            // Poles and residues of both families.
            let tables = mesh.tables();
            let along = end.as_ref().map(|end| (&end.along, end.stiffness));
            let in_plane: Condensed<2, 4, 3> = mesh.condense(&tables, still, along, limit, &arc_lengths)?;
            let sideways = end.and_then(|end| end.out_of_plane).map(|stiffness| (&[1.0], stiffness));
            let out_of_plane: Condensed<1, 2, 1> =
                mesh.condense(&tables, still_out_of_plane, sideways, limit, &arc_lengths)?;
            let error = in_plane.error.max(out_of_plane.error);

            // Accept the discretisation if it is fine enough, otherwise refine it.
            if error <= WANTED_ERROR || mesh.refined == MAX_REFINEMENTS {
                let stations =
                    Stations { arc_lengths, in_plane: in_plane.stations, out_of_plane: out_of_plane.stations };
                let (in_plane, out_of_plane) = (in_plane.ends, out_of_plane.ends);
                let cable = Self { in_plane, out_of_plane, limit, error, degrees: mesh.degrees(), end };
                return Ok((cable, stations));
            }
            mesh.refine();
        }
    }

    /// Undamped stiffness of the start in the axes (horizontal towards the end, up, out of plane) at ω [rad/s], [N/m].
    pub fn undamped(&self, omega: f64) -> LocalStiffness<f64> {
        let x = omega * omega;
        local(self.in_plane.undamped(x, 0..0), self.out_of_plane.undamped(x, 0..0))
    }

    /// Stiffness of the start in the axes of [`undamped`](Self::undamped) at the complex square ω_c² [rad²/s²], [N/m].
    pub fn damped(&self, square: Complex) -> LocalStiffness<Complex> {
        local(self.in_plane.damped(square), self.out_of_plane.damped(square))
    }

    /// Minus the derivative of the undamped stiffness by ω² in the axes of [`undamped`](Self::undamped) [kg].
    pub fn effective_mass(&self, omega: f64) -> LocalStiffness<f64> {
        let x = omega * omega;
        local(self.in_plane.effective_mass(x, 0..0), self.out_of_plane.effective_mass(x, 0..0))
    }
}

/// Local stiffness from its entries in plane and out of plane, in the order of [`PoleResidue`].
fn local<T>([axial, coupling, normal]: [T; 3], [out_of_plane]: [T; 1]) -> LocalStiffness<T> {
    LocalStiffness { axial, coupling, normal, out_of_plane }
}

/// Number of refinements after which the discretisation is accepted with its estimated error. Each refinement adds a
/// sixth of the degree plus eight.
const MAX_REFINEMENTS: usize = 4;
