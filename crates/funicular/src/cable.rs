//! Dynamic stiffness of one cable at its platform end, anchor held.
//!
//! Every model uses the local axes of docs/theory.md, section 4: e along the chord from the platform to the anchor, n
//! normal to it in the plane of the cable, upwards, b = e × n. In these axes
//! `K = k_a eeᵀ + k_b (enᵀ + neᵀ) + k_c nnᵀ + k_o bbᵀ`. One formula serves cables that go up from the platform and
//! cables that go down. There is one file per model.

pub mod catenary_dynamic;
mod catenary_end;
mod damping;
mod model;
pub mod shallow_dynamic;
mod shallow_end;
pub mod shallow_static;
mod situation;
mod spring;

pub use model::{CableModel, CableShape, MODELS, ModelEntry};

use crate::catenary::space::HangingCable;
use crate::drive::DriveChain;
use crate::math::{Complex, Mat3, Vec3, any_normal};
use crate::robot::{Robot, WinchMode};
use crate::statics::CableState;
use catenary_dynamic::{CarrierMotion, CatenaryDynamicEnd, MovingEnd, NearPole, Shapes};
use shallow_dynamic::ShallowDynamic;
use situation::CableSituation;
use std::f64::consts::TAU;
use thiserror::Error;

/// Local axes of a cable at its platform end; unit vectors in world axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalAxes {
    /// Along the chord, platform to anchor.
    pub e: Vec3,
    /// Normal to the chord in the plane of chord and load, upwards; any normal for a vertical cable.
    pub n: Vec3,
    /// Out of plane, e × n.
    pub b: Vec3,
}

impl LocalAxes {
    /// Axes of cable `i` of a robot. Up is opposite to the cable's load per length.
    pub fn of_cable(robot: &Robot, i: usize, state: &CableState) -> Self {
        Self::of_chord(&state.attachment_w, &state.anchor_w, &robot.line_load(i, &state.chord_w()).up_w)
    }

    /// Axes of a hanging cable: e horizontal towards its end, n against its load.
    pub(crate) fn of_hanging(hanging: &HangingCable) -> Self {
        let (e, n) = hanging.axes_w();
        Self { e, n, b: e.cross(&n) }
    }

    /// Axes of the chord from `from_w` to `to_w`; `up_w` is the unit vector opposite to the load.
    pub fn of_chord(from_w: &Vec3, to_w: &Vec3, up_w: &Vec3) -> Self {
        let e = (to_w - from_w).normalize();
        let normal = up_w - e * e.dot(up_w);
        // A chord within 1e-9 rad of the vertical defines no plane, and its stiffness needs none.
        let n = if normal.norm() > 1e-9 { normal.normalize() } else { any_normal(&e) };
        Self { e, n, b: e.cross(&n) }
    }
}

/// End stiffness in local axes as its entries [N/m]; `T` is real or complex.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LocalStiffness<T> {
    /// Along the chord.
    pub axial: T,
    /// Between chord and normal.
    pub coupling: T,
    /// Along the normal, in plane.
    pub normal: T,
    /// Out of plane.
    pub out_of_plane: T,
    /// Between chord and out of plane, and between normal and out of plane: zero unless the far end of the cable
    /// couples them, as a pulley with an inclined swivel axis does.
    pub across: [T; 2],
}

impl<T> LocalStiffness<T> {
    /// Stiffness whose entries are a function of these, as their real parts.
    pub fn map<U>(&self, of: impl Fn(&T) -> U) -> LocalStiffness<U> {
        LocalStiffness {
            axial: of(&self.axial),
            coupling: of(&self.coupling),
            normal: of(&self.normal),
            out_of_plane: of(&self.out_of_plane),
            across: [of(&self.across[0]), of(&self.across[1])],
        }
    }
}

impl LocalStiffness<f64> {
    /// Stiffness as a 3×3 matrix in world axes [N/m].
    pub fn in_world(&self, axes: &LocalAxes) -> Mat3 {
        let LocalAxes { e, n, b } = axes;
        let mixed = |p: &Vec3, q: &Vec3| p * q.transpose() + q * p.transpose();
        e * e.transpose() * self.axial
            + mixed(e, n) * self.coupling
            + n * n.transpose() * self.normal
            + b * b.transpose() * self.out_of_plane
            + mixed(e, b) * self.across[0]
            + mixed(n, b) * self.across[1]
    }
}

/// Parameters of a shallow sagging cable, used by the shallow-static and the shallow-dynamic model.
///
/// EA, mass and load are per length of the chord: of a cable with the stretch λ they are λ EA, m/λ and q/λ of its rope
/// (docs/theory.md, equation (18a)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sag {
    /// Chord l [m].
    pub chord: f64,
    /// Tension parallel to the chord τ = H/cos α [N].
    pub tension: f64,
    /// Axial stiffness EA [N].
    pub axial_stiffness: f64,
    /// Mass per length m [kg/m].
    pub mass_per_length: f64,
    /// ε = q l cos α/τ: load normal to the chord over tension. q is the weight m g per length if no other load acts.
    pub epsilon: f64,
    /// Effective length L_e = l (1 + 8 (d/l)²) [m].
    pub effective_length: f64,
    /// Irvine's λ² = ε² EA l/(τ L_e).
    pub lambda2: f64,
}

/// Ratio of sag to chord above which the shallow-sag models leave their range (docs/theory.md, section 6).
pub const SHALLOW_SAG_LIMIT: f64 = 1.0 / 20.0;

impl Sag {
    /// Sag parameters of cable `i` at an equilibrium. A straight cable (spring or ideal statics) gets the sag that
    /// follows from its tension.
    pub fn of(robot: &Robot, i: usize, state: &CableState) -> Self {
        let (material, stretch) = (&robot.cables[i].material, stretch_of(robot, i, state));
        let chord_w = state.chord_w();
        let chord = chord_w.norm();
        let load = robot.line_load(i, &chord_w);
        let cos_alpha = (chord_w - load.up_w * chord_w.dot(&load.up_w)).norm() / chord;
        let tension = match &state.hanging {
            Some(hanging) => hanging.catenary.parallel_tension(),
            None => state.tension_platform,
        };
        let (axial_stiffness, mass) = (material.axial_stiffness * stretch, material.mass_per_length / stretch);
        Self::new(chord, cos_alpha, tension, axial_stiffness, mass, load.size / stretch)
    }

    /// Sag parameters from chord [m], cosine of the angle between the chord and the plane normal to the load, parallel
    /// tension [N], EA [N], mass per length [kg/m] and load per length [N/m]. The load is the weight m g per length if
    /// nothing else acts.
    pub fn new(
        chord: f64,
        cos_alpha: f64,
        tension: f64,
        axial_stiffness: f64,
        mass_per_length: f64,
        load_per_length: f64,
    ) -> Self {
        let epsilon = load_per_length * chord * cos_alpha / tension;
        let ratio = epsilon / 8.0;
        let effective_length = chord * (1.0 + 8.0 * ratio * ratio);
        let lambda2 = epsilon * epsilon * axial_stiffness * chord / (tension * effective_length);
        Self { chord, tension, axial_stiffness, mass_per_length, epsilon, effective_length, lambda2 }
    }

    /// Ratio of sag to chord, d/l = ε/8.
    pub fn ratio(&self) -> f64 {
        self.epsilon / 8.0
    }

    /// First frequency of the taut string, √(τ/m)/(2l) [Hz]; infinite for a massless cable.
    pub fn string_frequency_hz(&self) -> f64 {
        (self.tension / self.mass_per_length).sqrt() / (2.0 * self.chord)
    }

    /// First axial frequency √(EA/m)/(2l) of the cable [Hz]. Only the catenary-dynamic model contains axial waves; the
    /// other models are valid well below this frequency.
    pub(crate) fn axial_frequency_hz(&self) -> f64 {
        (self.axial_stiffness / self.mass_per_length).sqrt() / (2.0 * self.chord)
    }
}

/// Stretch λ = 1 + τ/EA of cable `i` at an equilibrium, with its tension τ parallel to the chord; 1 for a rigid cable.
fn stretch_of(robot: &Robot, i: usize, state: &CableState) -> f64 {
    let tension = state.hanging.as_ref().map_or(0.0, |hanging| hanging.catenary.parallel_tension());
    1.0 + tension / robot.cables[i].material.axial_stiffness
}

/// End stiffness of one cable in one model.
#[derive(Debug, Clone, PartialEq)]
pub enum EndStiffness {
    /// Stiffness independent of frequency; 3×3 in world axes [N/m].
    Constant(Mat3),
    /// Stiffness that depends on frequency.
    Dynamic(DynamicCable),
}

/// Reason for which a cable has no stiffness in a model.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum NoStiffness {
    /// The cable is rigid.
    #[error("ideal cables are rigid: only the models `spring`, `shallow-static` and `shallow-dynamic` exist for them")]
    Rigid,
    /// The cable carries no tension.
    #[error("it has no tension")]
    NoTension,
    /// The catenary-dynamic model does not exist for the cable.
    #[error(transparent)]
    CatenaryDynamic(#[from] catenary_dynamic::CatenaryDynamicError),
}

/// Cable in a model whose stiffness depends on frequency. Each variant has its own local axes, [`DynamicCable::axes`].
#[derive(Debug, Clone, PartialEq)]
pub enum DynamicCable {
    /// Starossek's closed form for shallow sag, the far end held.
    ShallowDynamic(ShallowDynamic),
    /// Vibration by poles and residues: about the elastic catenary, or that of a shallow span with its pulley and
    /// winch.
    CatenaryDynamic(Box<CatenaryDynamicEnd>),
}

impl DynamicCable {
    /// The cable by poles and residues; `None` for the closed form.
    pub fn by_poles(&self) -> Option<&CatenaryDynamicEnd> {
        match self {
            Self::ShallowDynamic(_) => None,
            Self::CatenaryDynamic(cable) => Some(cable),
        }
    }

    /// The cable by poles and residues, to be changed; `None` for the closed form.
    pub(crate) fn by_poles_mut(&mut self) -> Option<&mut CatenaryDynamicEnd> {
        match self {
            Self::ShallowDynamic(_) => None,
            Self::CatenaryDynamic(cable) => Some(cable),
        }
    }

    /// Squares of the clamped frequencies below ω [rad²/s²], not sorted.
    pub(crate) fn poles_below(&self, omega: f64) -> Vec<f64> {
        match self {
            Self::ShallowDynamic(cable) => cable.clamped_frequencies_below(omega).into_iter().map(|f| f * f).collect(),
            Self::CatenaryDynamic(cable) => cable.poles_below(omega * omega).collect(),
        }
    }

    /// Local axes of the cable.
    pub fn axes(&self) -> &LocalAxes {
        match self {
            Self::ShallowDynamic(cable) => &cable.axes,
            Self::CatenaryDynamic(cable) => &cable.axes,
        }
    }

    /// Undamped stiffness in local axes at ω [rad/s], [N/m].
    pub fn undamped(&self, omega: f64) -> LocalStiffness<f64> {
        match self {
            Self::ShallowDynamic(cable) => cable.undamped(omega),
            Self::CatenaryDynamic(cable) => cable.undamped(omega),
        }
    }

    /// Damped stiffness in local axes at ω [rad/s], [N/m].
    pub fn damped(&self, omega: f64) -> LocalStiffness<Complex> {
        match self {
            Self::ShallowDynamic(cable) => cable.damped(omega),
            Self::CatenaryDynamic(cable) => cable.damped(omega),
        }
    }

    /// Damped stiffness at the complex x = ω_c² without the poles in the relative distance `width` of the real part of
    /// x, and those poles. The closed form has no poles to leave out.
    pub(crate) fn complex_beside_poles(&self, x: Complex, width: f64) -> (LocalStiffness<Complex>, Vec<NearPole>) {
        match self {
            Self::ShallowDynamic(cable) => (cable.at(x).0, Vec::new()),
            Self::CatenaryDynamic(cable) => cable.complex_beside_poles(x, width),
        }
    }

    /// Minus the derivative by x of the stiffness of [`complex_beside_poles`](Self::complex_beside_poles) [kg].
    pub(crate) fn complex_mass_beside_poles(&self, x: Complex, width: f64) -> LocalStiffness<Complex> {
        match self {
            Self::ShallowDynamic(cable) => cable.at(x).1,
            Self::CatenaryDynamic(cable) => cable.complex_mass_beside_poles(x, width),
        }
    }

    /// Force (e, n, b) on the platform end per motion of the carrier of the far end at ω [rad/s], the platform end
    /// held [N].
    pub(crate) fn force_by_carrier(&self, motion: &CarrierMotion, omega: f64) -> [Complex; 3] {
        match self {
            Self::ShallowDynamic(cable) => cable.force_by_far_end(&motion.displacement, omega),
            Self::CatenaryDynamic(cable) => cable.force_by_carrier(motion, omega.into()),
        }
    }

    /// Minus the derivative of the undamped stiffness by ω² [kg]; as a 3×3 matrix it is positive semidefinite.
    pub fn effective_mass(&self, omega: f64) -> LocalStiffness<f64> {
        match self {
            Self::ShallowDynamic(cable) => cable.effective_mass(omega),
            Self::CatenaryDynamic(cable) => cable.effective_mass(omega),
        }
    }

    /// Number of clamped-clamped frequencies below ω [rad/s]: J0 of Wittrick and Williams.
    pub fn clamped_modes_below(&self, omega: f64) -> usize {
        match self {
            Self::ShallowDynamic(cable) => cable.clamped_modes_below(omega),
            Self::CatenaryDynamic(cable) => cable.clamped_modes_below(omega),
        }
    }

    /// Clamped-clamped frequencies below ω [rad/s], ascending, with multiplicity.
    pub fn clamped_frequencies_below(&self, omega: f64) -> Vec<f64> {
        match self {
            Self::ShallowDynamic(cable) => cable.clamped_frequencies_below(omega),
            Self::CatenaryDynamic(cable) => cable.clamped_frequencies_below(omega),
        }
    }
}

impl EndStiffness {
    /// End stiffness of cable `i` of a robot at an equilibrium, valid up to the frequency `up_to_hz` [Hz]. Only the
    /// catenary-dynamic model uses that frequency and the `winches`. `in_plane_only` leaves out all stiffness out of
    /// the cable's plane, as the paper does.
    ///
    /// # Errors
    /// [`NoStiffness`]: an ideal cable has no stiffness in the catenary models, a cable without tension none in the
    /// models with sag.
    pub fn new(
        robot: &Robot,
        i: usize,
        state: &CableState,
        model: CableModel,
        in_plane_only: bool,
        winches: WinchMode,
        up_to_hz: f64,
    ) -> Result<Self, NoStiffness> {
        Self::of_cable(robot, (i, state), (model, in_plane_only, winches), up_to_hz, Shapes::Dropped)
    }

    /// Vibration by poles and residues.
    fn by_poles(cable: CatenaryDynamicEnd) -> Self {
        Self::Dynamic(DynamicCable::CatenaryDynamic(Box::new(cable)))
    }

    /// Vibration of a shallow cable in closed form.
    fn in_closed_form(cable: ShallowDynamic) -> Self {
        Self::Dynamic(DynamicCable::ShallowDynamic(cable))
    }

    /// Stiffness as by [`new`](Self::new); a catenary-dynamic cable may keep the shapes of its clamped modes.
    pub(crate) fn of_cable(
        robot: &Robot,
        (i, state): (usize, &CableState),
        (model, in_plane_only, winches): (CableModel, bool, WinchMode),
        up_to_hz: f64,
        shapes: Shapes,
    ) -> Result<Self, NoStiffness> {
        let axes = LocalAxes::of_cable(robot, i, state);
        let of = CableSituation { robot, i, state, axes, in_plane_only, winches, limit: up_to_hz * TAU, shapes };
        let entry = model.entry();
        if entry.needs_tension && of.sag().tension <= 0.0 {
            return Err(NoStiffness::NoTension);
        }
        (entry.end)(&of)
    }
}

/// Static stiffness of the free span of cable `i` in a model, its far end held; 3×3, world axes [N/m]. `None` for a
/// rigid cable in a catenary model.
pub(crate) fn span_stiffness(robot: &Robot, i: usize, state: &CableState, model: CableModel) -> Option<Mat3> {
    (model.entry().span)(robot, i, state)
}

/// End of cable `i` of a robot at its pulley or winch, with the drive behind it, in the `axes` of the cable's model and
/// for frequencies up to `limit` [rad/s]; `None` for an end that is held.
pub(crate) fn moving_end(
    robot: &Robot,
    i: usize,
    state: &CableState,
    axes: &LocalAxes,
    winches: WinchMode,
    limit: f64,
) -> Option<MovingEnd> {
    let drive = state.drive.as_deref()?;
    let (anchor, material) = (&robot.cables[i].anchor, &robot.cables[i].material);
    let rope = (material.axial_stiffness, material.mass_per_length);
    let chain = DriveChain::of(anchor, drive, rope, winches, limit);
    MovingEnd::of(axes, &drive.end, chain, drive.swivel_mass(anchor))
}
