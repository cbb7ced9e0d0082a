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
//! pole. Derivation: docs/theory.md, section 9. A shallow sagging span with a pulley or a winch takes the same form
//! (`shallow_span`), so that counts, modes and responses treat both alike.

mod at_rest;
mod carrier;
mod drive_forms;
mod drive_motion;
mod drive_signals;
mod families;
mod internal_motion;
mod lossy_poles;
mod mesh;
mod moving_end;
mod partition;
mod poles;
mod shallow_span;
mod stretch;
mod two_ended;

pub(crate) use crate::drive::ByTurn;
pub(crate) use at_rest::SpanAtRest;
pub(crate) use carrier::CarrierMotion;
pub(crate) use drive_forms::{DriveForm, DrivePart, EndSignal, InPowersOfS};
pub use drive_motion::DriveMotion;
pub(crate) use drive_motion::{DriveAt, DriveLosses, MotionsOfDrive};
pub use drive_signals::DriveSignal;
pub(crate) use drive_signals::EndDirections;
pub(crate) use internal_motion::InternalMotion;
pub use internal_motion::{Displacements, Stations};
use lossy_poles::Derived;
pub(crate) use lossy_poles::{LossyBesidePoles, LossyFamily, LossyPoles};
pub(crate) use mesh::{POINTS_BEYOND_DEGREE, ellipse, has_tension, smooth_pieces};
pub use moving_end::{EndAlong, EndSideways, MovingEnd};
pub use poles::PoleResidue;
pub use stretch::StretchMotions;
pub(crate) use two_ended::{ENDS, TwoEnded};

use super::{LocalAxes, LocalStiffness, Sag};
use crate::catenary::Catenary;
use crate::catenary::space::HangingCable;
use crate::math::{Complex, DMat};
use crate::robot::{Damping, StretchLoss};
use families::{Families, StationPositions};
use mesh::Mesh;
use std::f64::consts::TAU;
use std::ops::Range;
use thiserror::Error;

/// Dynamic stiffness of both ends of a cable as poles and residues, in plane and out of plane.
#[derive(Debug, Clone, PartialEq)]
pub struct CatenaryDynamic {
    /// Stiffness in plane: components (horizontal, up) of the start, then of the end.
    pub in_plane: PoleResidue<4, 3>,
    /// Stiffness out of plane: start, then end.
    pub out_of_plane: PoleResidue<2, 1>,
    /// Stiffness of a cable whose end couples both families, which are then empty: components (horizontal, up, out of
    /// plane) of the start, then of the end.
    pub coupled: Option<Box<PoleResidue<6, 6>>>,
    /// Highest angular frequency for which the discretisation was made [rad/s].
    pub limit: f64,
    /// Estimated relative error of the clamped frequencies below the limit.
    pub error: f64,
    /// Polynomial degree of each element.
    pub degrees: Vec<usize>,
    /// Motions that the end has; `None` for an end that is held. They belong to the inside of the cable, and are
    /// relative to the carrier of the end: the components of the end in stiffness, mass and participations are the
    /// motion of this carrier, with wheel and drum.
    pub end: Option<MovingEnd>,
    /// Motions of the drive at that end, and those in which a rope with loss stretches.
    pub drive: Option<DriveMotion>,
    /// Motions in which a rope with loss stretches; none without loss.
    pub stretch: StretchMotions,
}

/// Reason for which a cable has no catenary-dynamic stiffness.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum CatenaryDynamicError {
    /// A point of the cable has no tension: a slack massless cable, or a loop that hangs straight down.
    #[error("the cable has no tension at its lowest point: it has no linear vibration")]
    NoTension,
    /// The end of the cable couples motions in plane and out of plane, but only motions in plane are requested.
    #[error(
        "the swivel axis of its pulley is not parallel to the load of the cable, so that its motions in plane and out \
         of plane are coupled: include the stiffness out of plane"
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
    /// The requested frequency needs too fine a discretisation of a shallow span.
    #[error(
        "with its pulley or winch, the requested frequency limit needs at least {unknowns} unknowns for one cable, the \
         maximum is {limit}: lower the frequency limit"
    )]
    ShallowTooFine {
        /// Unknowns needed.
        unknowns: usize,
        /// Unknowns allowed.
        limit: usize,
    },
}

/// Platform end of a cable by poles and residues, with its axes and its damping: a catenary-dynamic cable, or a
/// shallow-dynamic one with a drive.
#[derive(Debug, Clone, PartialEq)]
pub struct CatenaryDynamicEnd {
    /// Poles and residues of the cable; its start is at the platform.
    pub cable: CatenaryDynamic,
    /// Local axes: e horizontal towards the anchor, n up, b out of plane; for a shallow span e along the chord.
    pub axes: LocalAxes,
    /// Damping of the rope.
    pub damping: Damping,
    /// Loss of the stretch of the rope.
    pub stretch_loss: StretchLoss,
    /// Mass per unstrained length m [kg/m].
    pub mass_per_length: f64,
    /// Leave out the stiffness out of plane, as the paper does.
    pub in_plane_only: bool,
    /// Poles that have been compressed, if some have been.
    pub(crate) kept: Option<Box<KeptModes>>,
    /// Directions of the cable at its ends.
    directions: EndDirections,
    /// Displacements of the points at which motions along the cable are integrated, by all clamped modes; `None` unless
    /// they have been kept.
    pub(crate) shapes: Option<Box<Stations>>,
    /// True if the model has no inertia of the cable, which then has no poles.
    pub(crate) is_at_rest: bool,
    /// Poles with the loss of the stretch, once something has asked for them; `None` inside if it has none of its own.
    lossy: Derived<Option<LossyFamily>>,
}

/// Choice of what is kept of the clamped modes of a cable once its poles and residues are known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shapes {
    /// Shapes are never formed.
    Dropped,
    /// Shapes are kept, for gradients.
    Kept,
    /// Strains are kept also of a rope without loss, for the share of stretch in its modes.
    Strains,
}

impl Shapes {
    /// Stations at which the shapes are formed.
    fn stations(self) -> StationPositions<'static> {
        match self {
            Self::Dropped | Self::Strains => StationPositions::ArcLengths(&[]),
            Self::Kept => StationPositions::GaussPoints,
        }
    }

    /// True if the strains of a rope with this loss are kept.
    pub(crate) fn has_strains(self, loss: StretchLoss) -> bool {
        self == Self::Strains || loss.is_some()
    }
}

/// Clamped modes that a cable has kept, and the modes that replace the others: per family the number of modes that are
/// kept, and the weights of the others in the modes that replace them, by columns.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct KeptModes {
    in_plane: (usize, DMat),
    out_of_plane: (usize, DMat),
    coupled: (usize, DMat),
}

impl KeptModes {
    /// Compresses displacements by all clamped modes in the same way. A family without displacements stays empty.
    pub(crate) fn compress(
        &self,
        in_plane: &mut Displacements<2, 4>,
        out_of_plane: &mut Displacements<1, 2>,
        coupled: &mut Displacements<3, 6>,
    ) {
        in_plane.compress(self.in_plane.0, &self.in_plane.1);
        out_of_plane.compress(self.out_of_plane.0, &self.out_of_plane.1);
        coupled.compress(self.coupled.0, &self.coupled.1);
    }
}

impl CatenaryDynamicEnd {
    /// Platform end of a hanging cable, valid up to ω = `limit` [rad/s]. `end` is its end at the pulley or the winch;
    /// `None` for an end that is held.
    ///
    /// # Errors
    /// [`CatenaryDynamicError`].
    pub(crate) fn new(
        hanging: &HangingCable,
        end: Option<MovingEnd>,
        (mass_per_length, damping, stretch_loss): (f64, Damping, StretchLoss),
        in_plane_only: bool,
        limit: f64,
        shapes: Shapes,
    ) -> Result<Self, CatenaryDynamicError> {
        if in_plane_only && end.as_ref().is_some_and(MovingEnd::couples) {
            return Err(CatenaryDynamicError::Skew);
        }
        let rope = hanging.catenary.rope();
        let has_strains = shapes.has_strains(stretch_loss);
        let moments = if has_strains { stretch::moments(&rope, mass_per_length, limit) } else { 0 };
        let (cable, stations) = CatenaryDynamic::condensed(
            &hanging.catenary,
            end,
            mass_per_length,
            limit,
            shapes.stations(),
            (&[], moments),
        )?;
        let (axes, directions) = (LocalAxes::of_hanging(hanging), EndDirections::of(hanging));
        let shapes = (shapes == Shapes::Kept).then(|| Box::new(stations));
        let (kept, is_at_rest) = (None, false);
        Ok(Self {
            cable,
            axes,
            damping,
            stretch_loss,
            mass_per_length,
            in_plane_only,
            kept,
            directions,
            shapes,
            is_at_rest,
            lossy: Derived::default(),
        })
    }

    /// Platform end of a shallow sagging span with a drive, valid up to ω = `limit` [rad/s]. `end` is its end at the
    /// pulley or the winch, `None` for an end that is held; it and the `directions` are in the `axes` of the chord.
    ///
    /// # Errors
    /// [`CatenaryDynamicError`].
    pub(crate) fn of_shallow_span(
        sag: &Sag,
        (axes, directions): (LocalAxes, EndDirections),
        end: Option<MovingEnd>,
        (damping, stretch_loss, has_strains): (Damping, StretchLoss, bool),
        in_plane_only: bool,
        limit: f64,
    ) -> Result<Self, CatenaryDynamicError> {
        if in_plane_only && end.as_ref().is_some_and(MovingEnd::couples) {
            return Err(CatenaryDynamicError::Skew);
        }
        let cable = shallow_span::condensed(sag, end, limit, has_strains)?;
        let mass_per_length = sag.mass_per_length;
        Ok(Self {
            cable,
            axes,
            damping,
            stretch_loss,
            mass_per_length,
            in_plane_only,
            kept: None,
            directions,
            shapes: None,
            is_at_rest: false,
            lossy: Derived::default(),
        })
    }

    /// Platform end of a cable of another model, valid up to `limit_hz`: its stiffness by poles and residues in plane
    /// (components along e and n of the platform end, then of the far end) and out of plane (along b of both ends). The
    /// far end is held, or on a flexible support. `mass_per_length` [kg/m] belongs to the damping.
    ///
    /// # References
    /// docs/theory.md, section 9.
    pub fn of_families(
        axes: LocalAxes,
        in_plane: PoleResidue<4, 3>,
        out_of_plane: PoleResidue<2, 1>,
        (mass_per_length, damping): (f64, Damping),
        limit_hz: f64,
    ) -> Self {
        let cable = CatenaryDynamic {
            in_plane,
            out_of_plane,
            coupled: None,
            limit: limit_hz * TAU,
            error: 0.0,
            degrees: Vec::new(),
            end: None,
            drive: None,
            stretch: StretchMotions::default(),
        };
        Self {
            cable,
            axes,
            damping,
            stretch_loss: StretchLoss::default(),
            mass_per_length,
            in_plane_only: false,
            kept: None,
            directions: EndDirections::along_chord(),
            shapes: None,
            is_at_rest: false,
            lossy: Derived::default(),
        }
    }

    /// Copy that keeps the poles below x and has a few poles in place of the others: see [`PoleResidue::compressed`].
    /// The replacing poles represent the losses of the drive and its `signals`, too.
    pub(crate) fn with_poles_below(&self, x: f64, signals: &[EndSignal]) -> Self {
        let mut cut = Self { shapes: None, lossy: Derived::default(), ..self.clone() };
        let [of_plane, of_normal, of_coupled] = self.forces_on_modes(signals);
        let CatenaryDynamic { in_plane, out_of_plane, coupled, .. } = &self.cable;
        let below = [in_plane.poles_below(x), out_of_plane.poles_below(x)];
        let (poles, weights) = in_plane.compressed(below[0], 2, &of_plane);
        let (poles_out_of_plane, weights_out_of_plane) = out_of_plane.compressed(below[1], 1, &of_normal);
        let mut kept = KeptModes {
            in_plane: (below[0], weights),
            out_of_plane: (below[1], weights_out_of_plane),
            coupled: (0, DMat::zeros(0, 0)),
        };
        (cut.cable.in_plane, cut.cable.out_of_plane) = (poles, poles_out_of_plane);
        if let Some(family) = coupled {
            let count = family.poles_below(x);
            let (poles, weights) = family.compressed(count, 3, &of_coupled);
            cut.cable.coupled = Some(Box::new(poles));
            kept.coupled = (count, weights);
        }

        if let Some(drive) = &mut cut.cable.drive {
            kept.compress(&mut drive.along, &mut drive.sideways, &mut drive.coupled);
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

    /// Poles and residues of both families together; `None` unless the end of the cable couples them.
    pub(crate) fn coupled(&self) -> Option<&PoleResidue<6, 6>> {
        self.cable.coupled.as_deref()
    }

    /// Local stiffness from its entries per family; those out of plane may be left out.
    fn local<T: Default>(
        &self,
        in_plane: impl FnOnce(&PoleResidue<4, 3>) -> [T; 3],
        out_of_plane: impl FnOnce(&PoleResidue<2, 1>) -> [T; 1],
        coupled: impl FnOnce(&PoleResidue<6, 6>) -> [T; 6],
    ) -> LocalStiffness<T> {
        match self.coupled() {
            Some(family) => local_of_coupled(coupled(family)),
            None => local(in_plane(self.in_plane()), self.out_of_plane().map_or_else(Default::default, out_of_plane)),
        }
    }

    /// Undamped stiffness at ω [rad/s], [N/m].
    pub fn undamped(&self, omega: f64) -> LocalStiffness<f64> {
        let x = omega * omega;
        self.local(|of| of.undamped(x, 0..0), |of| of.undamped(x, 0..0), |of| of.undamped(x, 0..0))
    }

    /// Square ω_c² of the complex frequency of the cable at ω [rad/s], [rad²/s²].
    fn square(&self, omega: Complex) -> Complex {
        self.damping.square_with_slope(omega, self.mass_per_length).0
    }

    /// Damped stiffness at ω [rad/s], [N/m].
    pub fn damped(&self, omega: f64) -> LocalStiffness<Complex> {
        self.damped_at(omega.into())
    }

    /// Damped stiffness at a complex ω of positive real part [rad/s], [N/m].
    pub(crate) fn damped_at(&self, omega: Complex) -> LocalStiffness<Complex> {
        let square = self.square(omega);
        let mut stiffness = self.local(|of| of.damped(square), |of| of.damped(square), |of| of.damped(square));
        if let Some(added) = self.drive_stiffness(omega) {
            stiffness.axial += added.axial;
            stiffness.coupling += added.coupling;
            stiffness.normal += added.normal;
            stiffness.out_of_plane += added.out_of_plane;
            stiffness.across.iter_mut().zip(added.across).for_each(|(sum, added)| *sum += added);
        }
        stiffness
    }

    /// Minus the derivative of the undamped stiffness by ω² [kg].
    pub fn effective_mass(&self, omega: f64) -> LocalStiffness<f64> {
        let x = omega * omega;
        self.local(|of| of.effective_mass(x, 0..0), |of| of.effective_mass(x, 0..0), |of| of.effective_mass(x, 0..0))
    }

    /// Number of clamped-clamped frequencies below ω [rad/s].
    pub fn clamped_modes_below(&self, omega: f64) -> usize {
        let x = omega * omega;
        self.in_plane().poles_below(x)
            + self.out_of_plane().map_or(0, |family| family.poles_below(x))
            + self.coupled().map_or(0, |family| family.poles_below(x))
    }

    /// Clamped-clamped frequencies below ω [rad/s], ascending.
    pub fn clamped_frequencies_below(&self, omega: f64) -> Vec<f64> {
        let mut all: Vec<f64> = self.poles_below(omega * omega).map(f64::sqrt).collect();
        all.sort_by(f64::total_cmp);
        all
    }

    /// Poles below x, family by family.
    pub(crate) fn poles_below(&self, x: f64) -> impl Iterator<Item = f64> + '_ {
        let in_plane = &self.in_plane().poles[..self.in_plane().poles_below(x)];
        let out_of_plane = self.out_of_plane().map_or(&[][..], |family| &family.poles[..family.poles_below(x)]);
        let coupled = self.coupled().map_or(&[][..], |family| &family.poles[..family.poles_below(x)]);
        in_plane.iter().chain(out_of_plane).chain(coupled).copied()
    }

    /// Undamped stiffness at x = ω² without the poles in the relative distance `width` of x, and those poles.
    pub(crate) fn beside_poles(&self, x: f64, width: f64) -> (LocalStiffness<f64>, Vec<NearPole>) {
        let near = self.near(x, width);
        let stiffness = self.local(
            |of| of.undamped(x, near.in_plane.clone()),
            |of| of.undamped(x, near.out_of_plane.clone()),
            |of| of.undamped(x, near.coupled.clone()),
        );
        (stiffness, self.near_poles(&near))
    }

    /// Damped stiffness at the complex x = ω_c² without the poles in the relative distance `width` of the real part of
    /// x, and those poles.
    pub(crate) fn complex_beside_poles(&self, x: Complex, width: f64) -> (LocalStiffness<Complex>, Vec<NearPole>) {
        let near = self.near(x.re, width);
        let stiffness = self.local(
            |of| of.damped_without(x, near.in_plane.clone()),
            |of| of.damped_without(x, near.out_of_plane.clone()),
            |of| of.damped_without(x, near.coupled.clone()),
        );
        (stiffness, self.near_poles(&near))
    }

    /// Minus the derivative by x of the stiffness of [`complex_beside_poles`](Self::complex_beside_poles) [kg].
    pub(crate) fn complex_mass_beside_poles(&self, x: Complex, width: f64) -> LocalStiffness<Complex> {
        let near = self.near(x.re, width);
        self.local(
            |of| of.damped_mass_without(x, near.in_plane.clone()),
            |of| of.damped_mass_without(x, near.out_of_plane.clone()),
            |of| of.damped_mass_without(x, near.coupled.clone()),
        )
    }

    /// Minus the derivative by ω² of the undamped stiffness at x = ω² [kg], without the poles that
    /// [`beside_poles`](Self::beside_poles) leaves out.
    pub(crate) fn effective_mass_beside_poles(&self, x: f64, width: f64) -> LocalStiffness<f64> {
        let near = self.near(x, width);
        self.local(
            |of| of.effective_mass(x, near.in_plane.clone()),
            |of| of.effective_mass(x, near.out_of_plane.clone()),
            |of| of.effective_mass(x, near.coupled.clone()),
        )
    }

    /// Indices of the poles in the relative distance `width` of x.
    pub(crate) fn near(&self, x: f64, width: f64) -> NearRanges {
        NearRanges {
            in_plane: self.in_plane().near(x, width),
            out_of_plane: self.out_of_plane().map_or(0..0, |family| family.near(x, width)),
            coupled: self.coupled().map_or(0..0, |family| family.near(x, width)),
        }
    }

    /// Poles at the given places.
    pub(crate) fn near_poles(&self, near: &NearRanges) -> Vec<NearPole> {
        let CatenaryDynamic { in_plane, out_of_plane, .. } = &self.cable;
        let pole = |family: Family, index: usize, direction: [f64; 3], poles: &[f64]| NearPole {
            direction,
            pole: poles[index],
            family,
            index,
        };

        let of_plane = near.in_plane.clone().map(|index| {
            let [e, n, ..] = in_plane.participation[index];
            pole(Family::InPlane, index, [e, n, 0.0], &in_plane.poles)
        });
        let of_normal = near.out_of_plane.clone().map(|index| {
            let [b, _] = out_of_plane.participation[index];
            pole(Family::OutOfPlane, index, [0.0, 0.0, b], &out_of_plane.poles)
        });
        let of_coupled = self.coupled().into_iter().flat_map(|family| {
            near.coupled.clone().map(move |index| {
                let [e, n, b, ..] = family.participation[index];
                pole(Family::Coupled, index, [e, n, b], &family.poles)
            })
        });

        of_plane.chain(of_normal).chain(of_coupled).collect()
    }
}

/// Family of clamped modes of a cable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Family {
    /// Motion in the plane of the cable.
    InPlane,
    /// Motion out of that plane.
    OutOfPlane,
    /// Motion in all directions, of a cable whose end couples them.
    Coupled,
}

impl Family {
    /// All families.
    const ALL: [Self; 3] = [Self::InPlane, Self::OutOfPlane, Self::Coupled];
}

/// Indices of poles near a frequency, by families.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct NearRanges {
    pub(crate) in_plane: Range<usize>,
    pub(crate) out_of_plane: Range<usize>,
    pub(crate) coupled: Range<usize>,
}

/// Pole near a frequency.
pub(crate) struct NearPole {
    /// g_k of the platform end in (e, n, b) [√kg].
    pub(crate) direction: [f64; 3],
    /// ω_k² [rad²/s²].
    pub(crate) pole: f64,
    /// Family of the mode.
    pub(crate) family: Family,
    /// Index in the cable's list of poles of that family.
    pub(crate) index: usize,
}

/// Maximum number of unknowns in one eigenproblem of a cable; the eigenproblem then takes about two seconds.
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
        Ok(Self::with_stations(catenary, None, mass_per_length, limit, &[], false, 0)?.0)
    }

    /// Dynamic stiffness as by [`new`](Self::new), and the displacements of the points at the given unstrained arc
    /// lengths from the start [m]. With `loaded`, forces may act at these points; each of them then costs an element.
    /// An `end` that can move is part of the inside of the cable. `moments` is the number of moments of the strain for
    /// a rope with loss ([`StretchMotions`]).
    ///
    /// # Errors
    /// [`CatenaryDynamicError`].
    pub fn with_stations(
        catenary: &Catenary,
        end: Option<MovingEnd>,
        mass_per_length: f64,
        limit: f64,
        arc_lengths: &[f64],
        loaded: bool,
        moments: usize,
    ) -> Result<(Self, Stations), CatenaryDynamicError> {
        let cuts = if loaded { arc_lengths } else { &[] };
        let positions = StationPositions::ArcLengths(arc_lengths);
        Self::condensed(catenary, end, mass_per_length, limit, positions, (cuts, moments))
    }

    /// Dynamic stiffness and displacements as by [`with_stations`](Self::with_stations), with nodes of the mesh at the
    /// arc lengths `cuts`, and with this number of moments of the strain.
    fn condensed(
        catenary: &Catenary,
        end: Option<MovingEnd>,
        mass_per_length: f64,
        limit: f64,
        positions: StationPositions,
        (cuts, moments): (&[f64], usize),
    ) -> Result<(Self, Stations), CatenaryDynamicError> {
        let mut mesh = Mesh::new(catenary, mass_per_length, limit, cuts, end.is_some())?;
        let couples = end.as_ref().is_some_and(MovingEnd::couples);
        loop {
            let unknowns = mesh.unknowns(if couples { 3 } else { 2 });
            if unknowns > MAX_UNKNOWNS {
                return Err(CatenaryDynamicError::TooFine { unknowns, limit: MAX_UNKNOWNS });
            }

            // Poles and residues, with the drive among the stations.
            let found = match &end {
                Some(end) if couples => Families::together(catenary, &mesh, end, limit, positions, moments)?,
                _ => Families::apart(catenary, &mesh, end.as_ref(), limit, positions, moments)?,
            };

            // Accept the discretisation if it is fine enough, otherwise refine it.
            if found.error <= WANTED_ERROR || mesh.refined == MAX_REFINEMENTS {
                return Ok(found.split(end, limit, mesh.degrees()));
            }
            mesh.refine();
        }
    }

    /// Participations of the ends in a clamped mode [√kg].
    pub(crate) fn participation(&self, family: Family, index: usize) -> &[f64] {
        match family {
            Family::InPlane => &self.in_plane.participation[index],
            Family::OutOfPlane => &self.out_of_plane.participation[index],
            Family::Coupled => self.coupled.as_ref().map_or(&[], |of| &of.participation[index]),
        }
    }

    /// Poles of a family.
    pub(crate) fn poles_of(&self, family: Family) -> &[f64] {
        match family {
            Family::InPlane => &self.in_plane.poles,
            Family::OutOfPlane => &self.out_of_plane.poles,
            Family::Coupled => self.coupled_poles(),
        }
    }

    /// Poles of both families together; none unless the end of the cable couples them.
    pub(crate) fn coupled_poles(&self) -> &[f64] {
        self.coupled.as_ref().map_or(&[], |family| &family.poles)
    }

    /// Undamped stiffness of the start in the axes (horizontal towards the end, up, out of plane) at ω [rad/s], [N/m].
    pub fn undamped(&self, omega: f64) -> LocalStiffness<f64> {
        let x = omega * omega;
        match &self.coupled {
            Some(family) => local_of_coupled(family.undamped(x, 0..0)),
            None => local(self.in_plane.undamped(x, 0..0), self.out_of_plane.undamped(x, 0..0)),
        }
    }

    /// Stiffness of the start in the axes of [`undamped`](Self::undamped) at the complex square ω_c² [rad²/s²], [N/m].
    pub fn damped(&self, square: Complex) -> LocalStiffness<Complex> {
        match &self.coupled {
            Some(family) => local_of_coupled(family.damped(square)),
            None => local(self.in_plane.damped(square), self.out_of_plane.damped(square)),
        }
    }

    /// Minus the derivative of the undamped stiffness by ω² in the axes of [`undamped`](Self::undamped) [kg].
    pub fn effective_mass(&self, omega: f64) -> LocalStiffness<f64> {
        let x = omega * omega;
        match &self.coupled {
            Some(family) => local_of_coupled(family.effective_mass(x, 0..0)),
            None => local(self.in_plane.effective_mass(x, 0..0), self.out_of_plane.effective_mass(x, 0..0)),
        }
    }
}

/// Local stiffness from its entries in plane and out of plane, in the order of [`PoleResidue`].
fn local<T: Default>([axial, coupling, normal]: [T; 3], [out_of_plane]: [T; 1]) -> LocalStiffness<T> {
    LocalStiffness { axial, coupling, normal, out_of_plane, across: Default::default() }
}

/// Local stiffness from its entries in all directions, in the order of [`PoleResidue`].
fn local_of_coupled<T>([axial, coupling, normal, along, across, out_of_plane]: [T; 6]) -> LocalStiffness<T> {
    LocalStiffness { axial, coupling, normal, out_of_plane, across: [along, across] }
}

/// Number of refinements after which the discretisation is accepted with its estimated error. Each refinement adds a
/// sixth of the degree plus eight.
const MAX_REFINEMENTS: usize = 4;
