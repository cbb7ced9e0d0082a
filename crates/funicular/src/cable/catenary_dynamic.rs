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

mod drive_forms;
mod drive_motion;
mod drive_signals;
mod internal_motion;
mod mesh;
mod moving_end;
mod partition;
mod poles;

pub(crate) use drive_forms::{DriveForm, DrivePart, InPowersOfS};
use drive_motion::DriveAt;
pub use drive_motion::DriveMotion;
pub(crate) use drive_motion::{DriveLosses, DriveMotions};
pub use drive_signals::DriveSignal;
use drive_signals::EndDirections;
pub(crate) use internal_motion::InternalMotion;
pub use internal_motion::{Displacements, Stations};
pub(crate) use mesh::{ellipse, has_tension};
pub use moving_end::{EndAlong, MovingEnd};
pub use poles::PoleResidue;

use super::{LocalAxes, LocalStiffness};
use crate::catenary::Catenary;
use crate::catenary::space::HangingCable;
use crate::drive::{AnchorEnd, DriveChain};
use crate::math::{Complex, DMat};
use crate::robot::Damping;
use mesh::Mesh;
use partition::{Condensed, Guide};
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
    /// Motions of the drive at that end.
    pub drive: Option<DriveMotion>,
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
    /// Nothing holds the drum: the cable would run over its pulley.
    #[error(
        "with its motor at constant torque, the weight of the cable would pull it over its pulley: it has no linear \
         vibration; choose a state with more tension, or another control of the motor"
    )]
    RunsOut,
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
    /// Poles that have been compressed, if some have been.
    pub(crate) kept: Option<Box<KeptModes>>,
    /// Directions of the cable at its ends.
    directions: EndDirections,
}

/// Clamped modes that a cable has kept, and the modes that replace the others.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct KeptModes {
    /// Number of modes that are kept, and the weights of the others in the modes that replace them, by columns.
    in_plane: (usize, DMat),
    out_of_plane: (usize, DMat),
}

impl KeptModes {
    /// Compresses displacements by all clamped modes in the same way.
    pub(crate) fn compress(&self, in_plane: &mut Displacements<2, 4>, out_of_plane: &mut Displacements<1, 2>) {
        in_plane.compress(self.in_plane.0, &self.in_plane.1);
        out_of_plane.compress(self.out_of_plane.0, &self.out_of_plane.1);
    }
}

impl CatenaryDynamicEnd {
    /// Platform end of a hanging cable, valid up to ω = `limit` [rad/s]. `end` is its end at the pulley or the winch,
    /// with the drive behind it and the mass of the swivel at the cable [kg]; `None` for a fixed anchor.
    ///
    /// # Errors
    /// [`CatenaryDynamicError`].
    pub fn new(
        hanging: &HangingCable,
        end: Option<(&AnchorEnd, Option<DriveChain>, f64)>,
        mass_per_length: f64,
        damping: Damping,
        in_plane_only: bool,
        limit: f64,
    ) -> Result<Self, CatenaryDynamicError> {
        let end =
            end.map(|(end, chain, swivel_mass)| MovingEnd::of(hanging, end, chain, swivel_mass)).transpose()?.flatten();
        let cable =
            CatenaryDynamic::with_stations(&hanging.catenary, end, mass_per_length, limit, Vec::new(), false)?.0;
        let (e, n) = hanging.axes_w();
        let axes = LocalAxes { e, n, b: e.cross(&n) };
        let catenary = &hanging.catenary;
        let (h, at_start, at_end) =
            (catenary.horizontal_force(), catenary.vertical_force_at_start(), catenary.vertical_force_at_end());
        let (first, last) = (catenary.tension_at_start(), catenary.tension_at_end());
        let directions = EndDirections {
            from_platform: [h / first, at_start / first],
            to_platform: [-h / last, -at_end / last],
            stretch: 1.0 + last / catenary.rope().axial_stiffness,
        };
        Ok(Self { cable, axes, damping, mass_per_length, in_plane_only, kept: None, directions })
    }

    /// Copy that keeps the poles below x and has a few poles in place of the others: see [`PoleResidue::compressed`].
    /// These represent the losses of the drive and its `signals`, too.
    pub(crate) fn with_poles_below(&self, x: f64, signals: &[DriveSignal]) -> Self {
        let mut cut = self.clone();
        let [of_plane, of_normal] = self.forces_on_modes(signals);
        let (in_plane, out_of_plane) = (self.cable.in_plane.poles_below(x), self.cable.out_of_plane.poles_below(x));
        let (poles, weights) = self.cable.in_plane.compressed(in_plane, 2, &of_plane);
        let (poles_out_of_plane, weights_out_of_plane) =
            self.cable.out_of_plane.compressed(out_of_plane, 1, &of_normal);

        (cut.cable.in_plane, cut.cable.out_of_plane) = (poles, poles_out_of_plane);
        let kept = KeptModes { in_plane: (in_plane, weights), out_of_plane: (out_of_plane, weights_out_of_plane) };
        if let Some(drive) = &mut cut.cable.drive {
            kept.compress(&mut drive.along, &mut drive.out_of_plane);
        }
        cut.kept = Some(Box::new(kept));
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

    /// Square ω_c² of the complex frequency of the cable at ω [rad/s], [rad²/s²].
    fn square(&self, omega: f64) -> Complex {
        let (re, im) = self.damping.square(omega, self.mass_per_length);
        Complex::new(re, im)
    }

    /// Damped stiffness at ω [rad/s], [N/m].
    pub fn damped(&self, omega: f64) -> LocalStiffness<Complex> {
        let square = self.square(omega);
        let mut stiffness = self.with_out_of_plane(self.in_plane().damped(square), |family| family.damped(square));
        if let Some(added) = self.drive_stiffness(omega) {
            stiffness.axial += added.axial;
            stiffness.coupling += added.coupling;
            stiffness.normal += added.normal;
            stiffness.out_of_plane += added.out_of_plane;
        }
        stiffness
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
    pub(crate) fn near(&self, x: f64, width: f64) -> (Range<usize>, Range<usize>) {
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
            let held = MovingEnd { along: None, out_of_plane: None };
            let still = end.as_ref().unwrap_or(&held).still([[hh, hv], [hv, vv]], o)?;

            // Poles and residues of both families, with the drive among the stations.
            let tables = mesh.tables();
            let along = end.as_ref().and_then(|end| end.along.as_ref()).map(|along| {
                let mass = &along.chain.mass + &along.chain.cable_mass;
                Guide { direction: along.direction, stiffness: along.chain.stiffness.clone(), mass }
            });
            let sideways = end.as_ref().and_then(|end| end.out_of_plane).map(|(stiffness, mass)| {
                let [stiffness, mass] = [stiffness, mass].map(|entry| DMat::from_element(1, 1, entry));
                Guide { direction: [1.0], stiffness, mass }
            });
            let mut in_plane: Condensed<2, 4, 3> =
                mesh.condense(&tables, still.in_plane, along.as_ref(), limit, &arc_lengths)?;
            let mut out_of_plane: Condensed<1, 2, 1> =
                mesh.condense(&tables, still.out_of_plane, sideways.as_ref(), limit, &arc_lengths)?;
            let error = in_plane.error.max(out_of_plane.error);

            // Accept the discretisation if it is fine enough, otherwise refine it.
            if error <= WANTED_ERROR || mesh.refined == MAX_REFINEMENTS {
                let drive = end.is_some().then(|| DriveMotion {
                    along: in_plane.stations.split_off(arc_lengths.len()),
                    out_of_plane: out_of_plane.stations.split_off(arc_lengths.len()),
                    flexibility: still.flexibility,
                    flexibility_out_of_plane: still.flexibility_out_of_plane,
                });
                let stations =
                    Stations { arc_lengths, in_plane: in_plane.stations, out_of_plane: out_of_plane.stations };
                let (in_plane, out_of_plane) = (in_plane.ends, out_of_plane.ends);
                let cable = Self { in_plane, out_of_plane, limit, error, degrees: mesh.degrees(), end, drive };
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
