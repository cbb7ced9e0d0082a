//! Beginning of a simulation: the robot at rest as a mesh.

use super::air::Air;
use super::basis::ElementBasis;
use super::body::MovingBody;
use super::esdirk::Stepper;
use super::event::EventFault;
use super::far_end::FarEnd;
use super::resting::RestingRope;
use super::rope::RopeMesh;
use super::side_by_side::RopePack;
use super::system::{BODY, MotionNumbers, MovingSupport, RopeEnd, System};
use super::winding::Winding;
use crate::catenary::space::HangingCable;
use crate::math::Vec3;
use crate::modes::{self, StretchOfMode};
use crate::robot::{Cable, Control, Damping, Material, Robot, Winch};
use crate::statics::{CableState, Equilibrium, Stability};
use std::f64::consts::TAU;
use std::sync::Arc;
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
    /// The robot does not come to rest at its start.
    #[error("{0}")]
    NoRest(RestFault),
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

/// Reason why a robot does not come to rest at its start.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum RestFault {
    /// The equilibrium of statics is not stable.
    #[error("the equilibrium at the start is not stable: begin at a pose that the cables hold")]
    Unstable,
    /// A rope without mass carries nothing, so that nothing holds the wheel or winch behind it.
    #[error(
        "cable \"{cable}\" has no mass and carries nothing at the start, so that nothing holds its wheel or winch: \
         give `mass_kg_per_m` in [materials.*], or begin at a pose at which the cable is taut"
    )]
    Slack {
        /// Name of the cable.
        cable: String,
    },
    /// The mesh of a rope is too coarse for its bend.
    #[error(
        "the mesh does not come to rest at the start: cable \"{cable}\" hangs there in a bend with a radius of \
         {radius_m} m, and its nodes are {apart_m} m apart: give {elements} elements"
    )]
    Coarse {
        /// Name of the cable with the narrowest bend for its mesh.
        cable: String,
        /// Radius [m].
        radius_m: String,
        /// Mean distance of the nodes [m].
        apart_m: String,
        /// Number of elements with nodes that are as near as the radius is long.
        elements: usize,
    },
    /// No bend is narrow for the mesh.
    #[error(
        "the mesh does not come to rest at the start, though statics does: give more elements, or begin at another pose"
    )]
    NotFound,
}

/// Inertia of a rope without mass whose far end moves, over the mass of the platform. Frequencies of the platform
/// change by at most half of it for each rope.
const MASSLESS_PART: f64 = 1e-6;

/// Refuses parts of a robot that are not simulated.
fn check_parts(robot: &Robot) -> Result<(), SimulationError> {
    if let Some(rope) = robot.ropes.first() {
        let cable = robot.cables[rope.cables[0]].name.clone();
        let (what, remedy) = ("a rope that runs over sheaves", "leave out `shares_rope_with` in [[cables]]");
        return Err(SimulationError::Unsupported { cable, what, remedy });
    }
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

/// Loss of the stretch of ropes with a loss factor, in one mode of the platform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LossOfMode {
    /// Natural frequency with massless ropes [Hz].
    pub frequency_hz: f64,
    /// Share of the stretch of all ropes in the energy of deformation.
    pub stretch_share: f64,
    /// Damping ratio by the loss factors and damping times of the robot.
    pub ratio: f64,
    /// Damping ratio in time, where a loss factor is a damping time.
    pub ratio_in_time: f64,
}

/// Damping of all ropes in time.
pub(super) struct DampingInTime {
    ropes: Vec<RopeDamping>,
    /// Angular frequency at which damping ratios hold [rad/s].
    omega: f64,
    /// Modes of the platform, if ropes have a loss factor.
    pub(super) losses: Vec<LossOfMode>,
}

/// Shares of the stretch that differ by less count as equal: the lower frequency is then taken.
const EQUAL_SHARES: f64 = 1e-6;

/// Angular frequency at which the loss factors hold [rad/s]: that of the mode with the largest share of the stretch of
/// ropes with a loss factor. `None` if no mode stretches them.
fn omega_of_stretch(robot: &Robot, modes: &[StretchOfMode]) -> Option<f64> {
    let lossy = |mode: &StretchOfMode| -> f64 {
        let shares = mode.shares.iter().zip(&robot.cables);
        shares.filter(|(_, cable)| cable.material.stretch_loss.factor > 0.0).map(|(share, _)| share).sum()
    };
    let most = modes.iter().map(lossy).fold(0.0, f64::max);
    let mode = modes.iter().find(|mode| most > 0.0 && lossy(mode) >= most - EQUAL_SHARES)?;
    Some(TAU * mode.frequency_hz)
}

/// Damping of each rope. A damping ratio and a loss factor are the same at all frequencies, and a motion in time has
/// them at one frequency: a ratio of moving ropes at the first natural frequency, a loss factor of their stretch at
/// the frequency of the mode of the platform that stretches them most.
///
/// # References
/// docs/theory.md, equation (97e2).
fn damping(robot: &Robot, rest: &Equilibrium, settings: &SimulationSettings) -> Result<DampingInTime, SimulationError> {
    let has_factor =
        |cable: &Cable| cable.material.stretch_loss.factor > 0.0 && settings.stretch_damping_time.is_none();
    let has_ratio = |cable: &Cable| {
        let rope = &cable.material;
        matches!(rope.damping, Damping::Ratio(ratio) if ratio > 0.0 && rope.mass_per_length > 0.0)
    };
    let lossy = robot.cables.iter().any(has_factor);
    let modes = if lossy { modes::stretch_of_platform(robot, rest) } else { Vec::new() };
    let of_stretch = settings.damping_frequency_hz.map(|hz| TAU * hz).or_else(|| omega_of_stretch(robot, &modes));

    let mut omega = 0.0;
    let supports = robot.supports.iter().any(|support| support.damping_ratio > 0.0);
    if supports || robot.cables.iter().any(has_ratio) || (lossy && of_stretch.is_none()) {
        let frequency_hz = match settings.damping_frequency_hz {
            Some(frequency_hz) => frequency_hz,
            None => modes::first(robot, rest).map_err(|_| SimulationError::NoFrequency)?.frequency_hz,
        };
        omega = TAU * frequency_hz;
    }
    let of_stretch = of_stretch.unwrap_or(omega);
    let of = |cable: &Cable| {
        let Material { damping, mass_per_length, stretch_loss, .. } = &cable.material;
        let of_factor = if stretch_loss.factor > 0.0 { stretch_loss.factor / of_stretch } else { 0.0 };
        RopeDamping {
            viscous: match *damping {
                Damping::Ratio(ratio) => 2.0 * ratio * mass_per_length * omega,
                Damping::Viscous(viscous) => viscous,
            },
            stretch_time: settings.stretch_damping_time.unwrap_or(stretch_loss.time + of_factor),
        }
    };
    let ropes: Vec<RopeDamping> = robot.cables.iter().map(of).collect();

    let loss = |mode: &StretchOfMode| {
        let omega = TAU * mode.frequency_hz;
        let sum = |of: &dyn Fn(usize) -> f64| 0.5 * (0..ropes.len()).map(|i| mode.shares[i] * of(i)).sum::<f64>();
        let of_file = |i: usize| {
            let loss = &robot.cables[i].material.stretch_loss;
            loss.factor + omega * loss.time
        };
        LossOfMode {
            frequency_hz: mode.frequency_hz,
            stretch_share: mode.shares.iter().sum(),
            ratio: sum(&of_file),
            ratio_in_time: sum(&|i| omega * ropes[i].stretch_time),
        }
    };
    let losses = modes.iter().map(loss).collect();
    Ok(DampingInTime { ropes, omega, losses })
}

/// Ropes as meshes.
fn ropes(
    robot: &Robot,
    rest: &Equilibrium,
    settings: &SimulationSettings,
    damping: &[RopeDamping],
    holds_tension: &dyn Fn(usize) -> bool,
) -> Vec<RopeMesh> {
    let basis = Arc::new(ElementBasis::new(settings.mesh.degree));
    let bar = Arc::new(ElementBasis::new(1));
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
            basis: Arc::clone(basis),
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

/// Stepper at the equilibrium of the mesh near `rest`, with unstrained lengths over time. The cables of `parting` may
/// fail at a place.
pub(super) fn at_rest(
    robot: &Robot,
    rest: &Equilibrium,
    settings: &SimulationSettings,
    (windings, holds_tension): (Vec<Winding>, &dyn Fn(usize) -> bool),
    parting: &[usize],
    duration: f64,
) -> Result<(Stepper, Vec<LossOfMode>), SimulationError> {
    check_parts(robot)?;
    let DampingInTime { ropes: damping, omega, losses } = damping(robot, rest, settings)?;
    let mut ropes = ropes(robot, rest, settings, &damping, holds_tension);
    let mut far_ends: Vec<Option<FarEnd>> =
        (0..ropes.len()).map(|i| FarEnd::of(robot, i, &rest.cables[i], holds_tension(i))).collect();
    let mut supports: Vec<MovingSupport> =
        robot.supports.iter().map(|support| MovingSupport::of(support, omega)).collect();
    let air = air(robot, rest, settings, (&ropes, parting), duration)?;

    // Halves at the platform wait until their cables fail.
    let (mut windings, mut ends) = (windings, vec![RopeEnd::Attached; ropes.len()]);
    let mut body = MovingBody::of(robot, settings.platform_is_held);
    let mut halves = Vec::new();
    for &cable in parting {
        halves.push((cable, ropes.len()));
        ropes.push(ropes[cable].clone());
        far_ends.push(Some(FarEnd::loose(supports.len())));
        supports.push(MovingSupport::waiting());
        windings.push(Winding::constant(rest.cables[cable].unstrained_length));
        ends.push(RopeEnd::Gone);
        body.attachments_p.push(body.attachments_p[cable]);
    }

    let mut size = BODY + 3 * supports.len();
    let mut offset = |(rope, far): (&RopeMesh, &Option<FarEnd>)| {
        let own = rope.size() + far.as_ref().map_or(0, |far| far.places().count);
        size += own;
        size - own
    };
    let offsets: Vec<usize> = ropes.iter().zip(&far_ends).map(&mut offset).collect();

    let mut system = System {
        body,
        ends,
        halves,
        packs: RopePack::of(&ropes),
        anchors: vec![None; ropes.len()],
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
    let (now, narrow) = hanging(robot, &system, rest)?;
    lock(&mut system, &now);
    let mut stepper = Stepper::new(system, now, settings.tolerance, robot.platform_length());
    if !stepper.settle(&narrow) {
        return Err(SimulationError::NoRest(rest_fault(robot, rest, &stepper.system)));
    }
    let_go(robot, &mut stepper, holds_tension);
    Ok((stepper, losses))
}

/// Wind over time at the platform, at the ropes of the cables, and at the halves of those that may fail at a place.
fn air(
    robot: &Robot,
    rest: &Equilibrium,
    settings: &SimulationSettings,
    (ropes, parting): (&[RopeMesh], &[usize]),
    duration: f64,
) -> Result<Air, SimulationError> {
    let mut air = match settings.gust_seed {
        None => Air::steady(robot.wind, robot.cables.len()),
        Some(seed) => Air::gusty(robot, rest.pose.position_w, &gusty_places(ropes, rest), (duration, seed))?,
    };
    for cable in parting {
        air.add_rope_like(*cable);
    }
    Ok(air)
}

/// Most likely reason why a robot does not come to rest.
fn rest_fault(robot: &Robot, rest: &Equilibrium, system: &System) -> RestFault {
    if !matches!(rest.stability, Stability::Stable { .. }) {
        return RestFault::Unstable;
    }
    let name = |i: usize| robot.cables[i].name.clone();
    let is_slack = |i: &usize| {
        robot.cables[*i].material.mass_per_length == 0.0 && rest.cables[*i].is_slack() && system.far_ends[*i].is_some()
    };
    if let Some(i) = (0..robot.cables.len()).find(is_slack) {
        return RestFault::Slack { cable: name(i) };
    }
    // Distance of the nodes over the radius of the bend, whose least value is H/w.
    let narrow = |i: usize| {
        let catenary = &rest.cables[i].hanging.as_ref()?.catenary;
        let weight = catenary.rope().weight_per_length;
        let (radius, length) = (catenary.parallel_tension() / weight, catenary.rope().unstrained_length);
        let (elements, degree) = (system.ropes[i].elements as f64, system.ropes[i].basis.degree as f64);
        (radius > 0.0 && weight > 0.0).then_some((i, radius, length / (elements * degree), length / (degree * radius)))
    };
    let narrowest = (0..robot.cables.len()).filter_map(narrow).max_by(|a, b| (a.2 / a.1).total_cmp(&(b.2 / b.1)));
    match narrowest {
        Some((i, radius, apart, elements)) if apart > radius && elements < ElementMesh::MAX_ELEMENTS as f64 => {
            let [radius_m, apart_m] = [radius, apart].map(|length| format!("{length:.2}"));
            RestFault::Coarse { cable: name(i), radius_m, apart_m, elements: elements.ceil() as usize }
        }
        _ => RestFault::NotFound,
    }
}

/// Minimum number of pieces of a rope at which gusts are drawn. For the camera of the tests, on ropes of 150 m, the
/// root mean square upwards was 0.78 of the spectral answer with two pieces, 0.88 with five and 1.02 with eight.
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
    for (i, given) in lengths.iter().enumerate().take(robot.cables.len()) {
        let Some(forces) = stepper.system.far_forces(i, 0.0, given, &stepper.now, &stepper.needed) else { continue };
        let winch = robot.cables[i].anchor.winch.as_ref();
        let is_plain = winch.is_none() && holds_tension(i);
        let torque = winch.is_some_and(|winch| winch.control == Control::Torque);
        let from = stepper.system.of_far_end(i).start;
        let Some(far) = stepper.system.far_ends[i].as_mut().filter(|_| !is_plain) else { continue };
        let at = far.places().feed.unwrap_or_default();
        if let Some(feed) = &mut far.feed {
            let last = from + at + feed.count() - 1;
            let lengths = [given.value, stepper.now.x[last]];
            feed.let_go(stepper.needed[last], &forces.feed, torque, lengths);
        }
    }
}

/// Nodes on the curves of the cables at rest, and what lies behind them; with the load per length of each rope in a
/// bend too narrow for its mesh.
fn hanging(
    robot: &Robot,
    system: &System,
    rest: &Equilibrium,
) -> Result<(MotionNumbers, Vec<Option<Vec3>>), SimulationError> {
    let mut motion = MotionNumbers::zeros(system.size);
    let mut narrow = vec![None; system.ropes.len()];
    let put =
        |motion: &mut MotionNumbers, from: usize, at: &Vec3| motion.x[from..from + 3].copy_from_slice(at.as_slice());
    put(&mut motion, 0, &rest.pose.point_w(&system.body.center_p));
    for (i, rope) in system.ropes.iter().enumerate().take(rest.cables.len()) {
        let hanging = rest.cables[i].hanging.as_ref().ok_or(SimulationError::NotElastic)?;
        let length = hanging.catenary.rope().unstrained_length;
        let state = &rest.cables[i];
        let nodes_w = nodes_on_curve(rope, hanging);
        for (node, at) in nodes_w.iter().enumerate() {
            put(&mut motion, system.offsets[i] + 3 * node, at);
        }
        let load_w = hanging.load_w();
        let ends_w = [nodes_w[0], hanging.end_w];
        let is_narrow = load_w.norm() > 0.0 && RestingRope { rope, length, load_w, ends_w }.is_coarse(&nodes_w);
        narrow[i] = is_narrow.then_some(load_w);
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
    Ok((motion, narrow))
}

/// Nodes of a rope on its catenary.
fn nodes_on_curve(rope: &RopeMesh, hanging: &HangingCable) -> Vec<Vec3> {
    let (length, degree) = (hanging.catenary.rope().unstrained_length, rope.basis.degree);
    let on_catenary = |node: usize| {
        let (e, q) = (node / degree, node % degree);
        let sigma = (e as f64 + rope.basis.nodes[q]) / rope.elements as f64;
        if node == rope.last() { hanging.end_w } else { hanging.point_w(sigma * length) }
    };
    (0..=rope.last()).map(on_catenary).collect()
}
