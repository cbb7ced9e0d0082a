//! Beginning of a simulation: the robot at rest as a mesh.

use super::air::Air;
use super::basis::ElementBasis;
use super::body::MovingBody;
use super::esdirk::Stepper;
use super::event::EventFault;
use super::far_end::FarEnd;
use super::rope::RopeMesh;
use super::side_by_side::RopePack;
use super::system::{BODY, MotionNumbers, MovingSupport, RopeEnd, System};
use super::winding::Winding;
use crate::math::Vec3;
use crate::modes;
use crate::robot::{Cable, Control, Damping, Material, Robot, Winch};
use crate::statics::{CableState, Equilibrium};
use std::f64::consts::TAU;
use std::rc::Rc;
use thiserror::Error;

/// Elements of each rope.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ElementMesh {
    /// Number of elements of each rope, at least 1.
    pub elements: usize,
    /// Degree of their polynomials, 1 to [`ElementMesh::MAX_DEGREE`].
    pub degree: usize,
}

impl ElementMesh {
    /// Three elements of degree eight: the tension after a release is right to 1 % (root mean square).
    pub const STANDARD: Self = Self { elements: 3, degree: 8 };
    /// Highest degree: beyond it the blocks of the elements cost more than they gain.
    pub const MAX_DEGREE: usize = 10;
    /// Largest number of elements.
    pub const MAX_ELEMENTS: usize = 1000;

    /// ElementMesh with half as many nodes again, against which a result shows its error.
    #[must_use]
    pub fn finer(self) -> Self {
        Self { elements: self.elements + self.elements.div_ceil(2), ..self }
    }
}

impl Default for ElementMesh {
    fn default() -> Self {
        Self::STANDARD
    }
}

/// Settings of a simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulationSettings {
    /// ElementMesh of the ropes.
    pub mesh: ElementMesh,
    /// Error of a position that one step may have [m].
    pub tolerance: f64,
    /// Frequency at which the constant damping ratio of a rope holds [Hz]; `None` for the robot's first natural
    /// frequency.
    pub damping_frequency_hz: Option<f64>,
    /// Damping time of the stretch of all ropes [s] in place of that of the robot file.
    pub stretch_damping_time: Option<f64>,
    /// The platform is held where it is.
    pub platform_is_held: bool,
    /// Number from which the gusts of the robot's turbulence are drawn; `None` for the mean wind alone.
    pub gust_seed: Option<u64>,
}

impl SimulationSettings {
    /// Default tolerance [m]: tensions to about 1 %.
    pub const TOLERANCE: f64 = 1e-7;
    /// Range of tolerances [m]; below it rounding decides, above it no tension is right.
    pub const TOLERANCES: [f64; 2] = [1e-12, 1e-3];
}

impl Default for SimulationSettings {
    fn default() -> Self {
        Self {
            mesh: ElementMesh::default(),
            tolerance: Self::TOLERANCE,
            damping_frequency_hz: None,
            stretch_damping_time: None,
            platform_is_held: false,
            gust_seed: None,
        }
    }
}

/// Reason why a simulation cannot begin or go on.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SimulationError {
    /// A part of the robot that a simulation does not know.
    #[error("cable \"{cable}\" has {what}, which a simulation does not have yet: {remedy}")]
    Unsupported {
        /// Name of the cable.
        cable: String,
        /// The part.
        what: &'static str,
        /// Way out.
        remedy: &'static str,
    },
    /// The equilibrium has no hanging cables.
    #[error("a simulation begins at an equilibrium of elastic cables: choose the static model `catenary`")]
    NotElastic,
    /// The start is no stable equilibrium of the mesh.
    #[error(
        "the equilibrium at the start is not stable, or a cable carries nothing there, or its mesh is too coarse for its \
         sag: begin at a pose that the cables hold with tension, or give more elements"
    )]
    NoRest,
    /// The damping ratio of ropes has no frequency.
    #[error(
        "the damping ratio of the ropes holds at one frequency, and the robot has no first natural frequency at the \
         start: give that frequency, or `viscous_damping_n_s_m2` in [materials.*]"
    )]
    NoFrequency,
    /// The wind has no gusts, or none that can be drawn.
    #[error("no gusts can be simulated, because {0}: give `turbulence` in [wind], or leave out the seed of the gusts")]
    Gusts(#[from] crate::gust::GustError),
    /// An event that cannot happen.
    #[error("event {}: {fault}", event + 1)]
    Event {
        /// Index of the event.
        event: usize,
        /// Reason.
        fault: EventFault,
    },
    /// The motion cannot be followed.
    #[error(
        "from {time} s on no step is short enough for the tolerance of {tolerance} m: give a larger tolerance, more \
         elements, or `axial_damping_time_s` in [materials.*]"
    )]
    TooFast {
        /// Time reached [s].
        time: f64,
        /// Tolerance [m].
        tolerance: f64,
    },
}

/// Inertia of a rope without mass whose far end moves, over the mass of the platform. Frequencies of the platform change by
/// at most half of it for each rope.
const MASSLESS_PART: f64 = 1e-6;

/// Refuses parts of a robot that are not simulated.
fn check_parts(robot: &Robot) -> Result<(), SimulationError> {
    for cable in &robot.cables {
        let unsupported = |what, remedy| Err(SimulationError::Unsupported { cable: cable.name.clone(), what, remedy });
        let rope = &cable.material;
        if let Some(Winch { control: Control::Position(_), drum_mass, motor_mass, stiffness, .. }) = &cable.anchor.winch
        {
            // The motor is what the servo moves; on a stiff shaft the drum is a part of it.
            let moved = if stiffness.is_finite() { *motor_mass } else { drum_mass + motor_mass };
            if moved == 0.0 {
                return unsupported("a servo but no inertia of its motor", "give `motor_inertia_kg_m2` in [winches.*]");
            }
        }
        let is_loaded = cable.load_per_length_w.norm() > 0.0 || rope.drag_width.is_some_and(|width| width > 0.0);
        if rope.mass_per_length == 0.0 && is_loaded {
            return unsupported("a load or drag but no mass", "give `mass_kg_per_m` in [materials.*]");
        }
    }
    Ok(())
}

/// Damping of one rope in time.
struct RopeDamping {
    /// Viscous damping per length [N s/m²].
    viscous: f64,
    /// Damping time of the stretch [s]: force over the stiffness and the rate of the strain.
    stretch_time: f64,
}

/// Damping of each rope, and the angular frequency at which ratios hold [rad/s]. A damping ratio and a loss factor are the
/// same at all frequencies, and a motion in time has them at one frequency.
fn damping(
    robot: &Robot,
    rest: &Equilibrium,
    settings: &SimulationSettings,
) -> Result<(Vec<RopeDamping>, f64), SimulationError> {
    let needs_frequency = |rope: &Material| {
        matches!(rope.damping, Damping::Ratio(ratio) if ratio > 0.0 && rope.mass_per_length > 0.0)
            || (rope.stretch_loss.factor > 0.0 && settings.stretch_damping_time.is_none())
    };
    let mut omega = 0.0;
    let supports = robot.supports.iter().any(|support| support.damping_ratio > 0.0);
    if supports || robot.cables.iter().any(|cable| needs_frequency(&cable.material)) {
        let frequency_hz = match settings.damping_frequency_hz {
            Some(frequency_hz) => frequency_hz,
            None => modes::first(robot, rest).map_err(|_| SimulationError::NoFrequency)?.frequency_hz,
        };
        omega = TAU * frequency_hz;
    }
    let of = |cable: &Cable| {
        let Material { damping, mass_per_length, stretch_loss, .. } = &cable.material;
        let of_factor = if stretch_loss.factor > 0.0 { stretch_loss.factor / omega } else { 0.0 };
        RopeDamping {
            viscous: match *damping {
                Damping::Ratio(ratio) => 2.0 * ratio * mass_per_length * omega,
                Damping::Viscous(viscous) => viscous,
            },
            stretch_time: settings.stretch_damping_time.unwrap_or(stretch_loss.time + of_factor),
        }
    };
    Ok((robot.cables.iter().map(of).collect(), omega))
}

/// Ropes as meshes.
fn ropes(
    robot: &Robot,
    rest: &Equilibrium,
    settings: &SimulationSettings,
    damping: &[RopeDamping],
    holds_tension: &dyn Fn(usize) -> bool,
) -> Vec<RopeMesh> {
    let basis = Rc::new(ElementBasis::new(settings.mesh.degree));
    let bar = Rc::new(ElementBasis::new(1));
    let mesh = |(i, cable): (usize, &Cable)| {
        let rope = &cable.material;
        // A rope without mass is one straight bar. If rope passes its far end, it has a little inertia there.
        let is_bar = rope.mass_per_length == 0.0;
        let passes = !cable.anchor.is_fixed() || cable.anchor.support.is_some() || holds_tension(i);
        let length = rest.cables[i].unstrained_length;
        let mass = if is_bar && passes { MASSLESS_PART * robot.platform.mass / length } else { rope.mass_per_length };
        let (elements, basis) = if is_bar { (1, &bar) } else { (settings.mesh.elements, &basis) };
        let has_air = robot.wind.air_density > 0.0;
        RopeMesh {
            basis: Rc::clone(basis),
            elements,
            mass,
            stiffness: rope.axial_stiffness,
            damping_time: damping[i].stretch_time,
            viscous: if is_bar { 0.0 } else { damping[i].viscous },
            load_w: robot.gravity_w * rope.mass_per_length + cable.load_per_length_w,
            gravity_w: robot.gravity_w,
            drag_width: if has_air { rope.drag_width.unwrap_or(0.0) } else { 0.0 },
        }
    };
    robot.cables.iter().enumerate().map(mesh).collect()
}

/// Stepper at the equilibrium of the mesh near `rest`, with unstrained lengths over time.
pub(super) fn at_rest(
    robot: &Robot,
    rest: &Equilibrium,
    settings: &SimulationSettings,
    (windings, holds_tension): (Vec<Winding>, &dyn Fn(usize) -> bool),
    duration: f64,
) -> Result<Stepper, SimulationError> {
    check_parts(robot)?;
    let (damping, omega) = damping(robot, rest, settings)?;
    let ropes = ropes(robot, rest, settings, &damping, holds_tension);
    let far_ends: Vec<Option<FarEnd>> =
        (0..ropes.len()).map(|i| FarEnd::of(robot, i, &rest.cables[i], holds_tension(i))).collect();
    let supports: Vec<MovingSupport> = robot.supports.iter().map(|support| MovingSupport::of(support, omega)).collect();
    let mut size = BODY + 3 * supports.len();
    let mut offset = |(rope, far): (&RopeMesh, &Option<FarEnd>)| {
        let own = rope.size() + far.as_ref().map_or(0, |far| far.places().count);
        size += own;
        size - own
    };
    let offsets: Vec<usize> = ropes.iter().zip(&far_ends).map(&mut offset).collect();

    let air = match settings.gust_seed {
        None => Air::steady(robot.wind, ropes.len()),
        Some(seed) => Air::gusty(robot, rest.pose.position_w, &gusty_places(&ropes, rest), (duration, seed))?,
    };
    let mut system = System {
        body: MovingBody::of(robot, settings.platform_is_held),
        ends: vec![RopeEnd::Attached; ropes.len()],
        packs: RopePack::of(&ropes),
        ropes,
        far_ends,
        supports,
        windings,
        offsets,
        size,
        air,
        rotation: rest.pose.rot_wp,
        evaluations: 0,
    };
    let now = hanging(robot, &system, rest)?;
    lock(&mut system, &now);
    let mut stepper = Stepper::new(system, now, settings.tolerance, robot.platform_length());
    if !stepper.settle() {
        return Err(SimulationError::NoRest);
    }
    let_go(robot, &mut stepper, holds_tension);
    Ok(stepper)
}

/// Minimum number of pieces of a rope at which gusts are drawn. For the camera of the tests, on ropes of 150 m, the root mean
/// square upwards was 0.78 of the spectral answer with two pieces, 0.88 with five and 1.02 with eight.
const MIN_GUSTY_PIECES: usize = 8;

/// Ends of equal pieces of the ropes at rest, as places of gusts: at least one for each element.
fn gusty_places(ropes: &[RopeMesh], rest: &Equilibrium) -> Vec<Vec<[Vec3; 2]>> {
    let of_rope = |(rope, state): (&RopeMesh, &CableState)| {
        let count = rope.elements.max(MIN_GUSTY_PIECES);
        let chord_w = state.chord_w() / count as f64;
        (0..count).map(|e| [e, e + 1].map(|k| state.attachment_w + chord_w * k as f64)).collect()
    };
    ropes.iter().zip(&rest.cables).map(of_rope).collect()
}

/// Locks the winches of a system at rest until its equilibrium is known.
fn lock(system: &mut System, now: &MotionNumbers) {
    let lengths = system.lengths(0.0);
    for (i, given) in lengths.iter().enumerate() {
        let from = system.of_far_end(i).start;
        let Some(far) = &mut system.far_ends[i] else { continue };
        let at = far.places().feed.unwrap_or_default();
        if let Some(feed) = &mut far.feed {
            feed.lock(now.x[from + at + feed.count() - 1] - given.value);
        }
    }
}

/// Lets motors balance by themselves what holds them at rest.
fn let_go(robot: &Robot, stepper: &mut Stepper, holds_tension: &dyn Fn(usize) -> bool) {
    let lengths = stepper.system.lengths(0.0);
    for (i, given) in lengths.iter().enumerate() {
        let Some(forces) = stepper.system.far_forces(i, 0.0, given, &stepper.now, &stepper.needed) else { continue };
        let winch = robot.cables[i].anchor.winch.as_ref();
        let is_plain = winch.is_none() && holds_tension(i);
        let torque = winch.is_some_and(|winch| winch.control == Control::Torque);
        let from = stepper.system.of_far_end(i).start;
        let Some(far) = stepper.system.far_ends[i].as_mut().filter(|_| !is_plain) else { continue };
        let at = far.places().feed.unwrap_or_default();
        if let Some(feed) = &mut far.feed {
            let last = stepper.now.x[from + at + feed.count() - 1];
            feed.let_go(&forces.feed, forces.exit_w.norm(), torque, [given.value, last]);
        }
    }
}

/// Nodes on the curves of the cables at rest, and what lies behind them.
fn hanging(robot: &Robot, system: &System, rest: &Equilibrium) -> Result<MotionNumbers, SimulationError> {
    let mut motion = MotionNumbers::zeros(system.size);
    let put =
        |motion: &mut MotionNumbers, from: usize, at: &Vec3| motion.x[from..from + 3].copy_from_slice(at.as_slice());
    put(&mut motion, 0, &rest.pose.point_w(&system.body.center_p));
    for (i, rope) in system.ropes.iter().enumerate() {
        let hanging = rest.cables[i].hanging.as_ref().ok_or(SimulationError::NotElastic)?;
        let length = hanging.catenary.rope().unstrained_length;
        let degree = rope.basis.degree;
        for node in 0..=rope.last() {
            let (e, q) = (node / degree, node % degree);
            let sigma = (e as f64 + rope.basis.nodes[q]) / rope.elements as f64;
            let at = if node == rope.last() { hanging.end_w } else { hanging.point_w(sigma * length) };
            put(&mut motion, system.offsets[i] + 3 * node, &at);
        }
        let state = &rest.cables[i];
        if let Some(index) = robot.cables[i].anchor.support {
            put(&mut motion, System::of_support(index).start, &state.displacement_w);
        }
        let Some(far) = &system.far_ends[i] else { continue };
        let stations = far.stations_at_rest(length, state.tension_drum(), &rope.load_w, &state.displacement_w);
        if let Some(at) = far.places().feed {
            let from = system.of_far_end(i).start + at;
            motion.x[from..from + stations.len()].copy_from_slice(&stations);
        }
    }
    Ok(motion)
}
