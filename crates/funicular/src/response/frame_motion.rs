//! Given motions of the frame as inputs of a response: of the base with all anchors and drums, or of one anchor.
//!
//! Every cable pulls at the platform by the motion of its far end; gravity and loads stay where they are. Derivation:
//! docs/theory.md, equations (83) to (86).

use crate::cable::catenary_dynamic::{CarrierMotion, DriveSignal};
use crate::cable::{DynamicCable, EndStiffness, LocalAxes, span_stiffness};
use crate::cable_motion::{CableMotionError, CableStations};
use crate::dynamics::{Dynamics, Supports};
use crate::math::{CVec6, Complex, Mat3, Vec3, Vec6};
use crate::robot::Robot;
use crate::statics::{CableState, Equilibrium, on_support};

/// Given motion of the frame of the robot, harmonic, of unit amplitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FrameInput {
    /// The base moves along a direction in world axes (normalised on use), with all anchors and drums [m].
    BaseAlong(Vec3),
    /// The base turns about a direction in world axes (normalised on use) through the origin of the world, with all
    /// anchors and drums [rad].
    BaseAbout(Vec3),
    /// The anchor of one cable, with its pulley, moves along a direction in world axes (normalised on use); its drum
    /// stays where it is if there is a drum side, else it moves with the anchor [m].
    Anchor {
        /// Index of the cable, in the order of the file.
        cable: usize,
        /// Direction, world axes.
        direction_w: Vec3,
    },
}

/// Motion of the frame at each cable of a robot linearised about an equilibrium.
#[derive(Debug, Clone)]
pub struct FrameMotion {
    /// Wrench on the platform about its origin by the cables whose stiffness does not depend on frequency.
    constant: Vec6,
    /// Motions of the other cables.
    cables: Vec<MovedCable>,
    /// Displacement of the far end of every cable in the world.
    displacements_w: Vec<Vec3>,
    /// Motion of the feet of flexible supports, world axes.
    feet_w: Vec3,
    /// Forces on the supports by the cables whose stiffness does not depend on frequency; empty on a rigid frame.
    constant_on_supports: Vec<f64>,
}

/// Cable whose stiffness depends on frequency and whose far end is moved.
#[derive(Debug, Clone)]
struct MovedCable {
    /// Index among the cables whose stiffness depends on frequency.
    term: usize,
    /// Attachment from the platform origin, world axes [m].
    lever_w: Vec3,
    motion: CarrierMotion,
}

/// Motion of one anchor with the frame, world axes.
struct AnchorMotion {
    /// Displacement of entry point and exit point.
    entry_w: Vec3,
    exit_w: Vec3,
    /// Rotation.
    turn_w: Vec3,
    /// True if the drum moves with it.
    with_drum: bool,
}

impl FrameInput {
    /// Motion of cable `i`, which leaves its anchor at `exit_w`; `None` if it does not move.
    fn of_anchor(&self, robot: &Robot, i: usize, exit_w: &Vec3) -> Option<AnchorMotion> {
        let anchor = &robot.cables[i].anchor;
        match self {
            Self::BaseAlong(direction_w) => {
                let along_w = direction_w.normalize();
                Some(AnchorMotion { entry_w: along_w, exit_w: along_w, turn_w: Vec3::zeros(), with_drum: true })
            }
            Self::BaseAbout(axis_w) => {
                let turn_w = axis_w.normalize();
                let (entry_w, exit_w) = (turn_w.cross(&anchor.point_w), turn_w.cross(exit_w));
                Some(AnchorMotion { entry_w, exit_w, turn_w, with_drum: true })
            }
            Self::Anchor { cable, direction_w } => (*cable == i).then(|| {
                let along_w = direction_w.normalize();
                // Without a pulley the file does not say where the drum side comes from.
                AnchorMotion {
                    entry_w: along_w,
                    exit_w: along_w,
                    turn_w: Vec3::zeros(),
                    with_drum: anchor.pulley.is_none(),
                }
            }),
        }
    }
}

impl FrameMotion {
    /// Motion of the frame at a robot linearised about an equilibrium.
    ///
    /// # Errors
    /// [`CableMotionError::NoFrameMotion`]: a cable that has no stiffness in the model.
    pub(super) fn new(
        robot: &Robot,
        equilibrium: &Equilibrium,
        dynamics: &Dynamics,
        input: &FrameInput,
    ) -> Result<Self, CableMotionError> {
        let feet_w = feet_w(robot, dynamics, input)?;
        let mut frame = Self {
            constant: Vec6::zeros(),
            cables: Vec::new(),
            displacements_w: Vec::new(),
            feet_w,
            constant_on_supports: vec![0.0; dynamics.supports().map_or(0, Supports::count)],
        };
        for (i, state) in equilibrium.cables.iter().enumerate() {
            let Some(anchor) = input.of_anchor(robot, i, &state.anchor_w) else {
                frame.displacements_w.push(Vec3::zeros());
                continue;
            };
            frame.displacements_w.push(anchor.exit_w);
            if let Some(term) = dynamics.terms().iter().position(|term| term.cable() == i) {
                let motion = carrier_motion(state, &anchor, dynamics.terms()[term].form().axes());
                frame.cables.push(MovedCable { term, lever_w: state.lever_w, motion });
            } else {
                let force_w = constant_force_w(robot, i, state, dynamics, &anchor)?;
                frame.constant += wrench(&force_w, &state.lever_w);
                frame.add_constant_on_support(robot, i, state, dynamics);
            }
        }
        Ok(frame)
    }

    /// Adds the force on the support of a cable whose stiffness does not depend on frequency.
    fn add_constant_on_support(&mut self, robot: &Robot, i: usize, state: &CableState, dynamics: &Dynamics) {
        let Some(first) = dynamics.supports().and_then(|supports| supports.of_cable(i)) else { return };
        let Some(held) = span_stiffness(robot, i, state, dynamics.linearisation.cable_model) else { return };
        let Some(stiffness) = on_support(robot, i, state, &held) else { return };
        let force_w = -stiffness.force_w.transpose() * self.feet_w;
        (0..3).for_each(|k| self.constant_on_supports[first + k] += force_w[k]);
    }

    /// Forces on the displacements of the supports at ω [rad/s], the platform and the supports held on their feet.
    pub(super) fn on_supports(&self, dynamics: &Dynamics, supports: &Supports, omega: f64) -> Vec<Complex> {
        let mut forces: Vec<Complex> = self.constant_on_supports.iter().map(|force| Complex::from(*force)).collect();
        supports.add_inertia_of_feet(&mut forces, &self.feet_w, omega);
        for moved in &self.cables {
            if let DynamicCable::CatenaryDynamic(form) = dynamics.terms()[moved.term].form() {
                let square = dynamics.cable_square(dynamics.terms()[moved.term].cable(), omega);
                supports.add_forces_by_base(&mut forces, (moved.term, form), &moved.motion, omega, square);
            }
        }
        forces
    }

    /// Wrench on the platform about its origin at ω [rad/s].
    pub(super) fn vector(&self, dynamics: &Dynamics, omega: f64) -> CVec6 {
        let mut total = self.constant.map(Complex::from);
        for moved in &self.cables {
            let form = dynamics.terms()[moved.term].form();
            let force = match form {
                DynamicCable::ShallowDynamic(cable) => cable.force_by_far_end(&moved.motion.displacement, omega),
                DynamicCable::CatenaryDynamic(cable) => cable.force_by_carrier(&moved.motion, omega),
            };
            let LocalAxes { e, n, b } = form.axes();
            for (axis, entry) in [e, n, b].into_iter().zip(force) {
                total += wrench(axis, &moved.lever_w).map(|part| entry * part);
            }
        }
        total
    }

    /// Output of the drive of the cable with the index `term` among those whose stiffness depends on frequency, or its
    /// tension, at ω [rad/s], the platform held.
    pub(super) fn of_drive(&self, dynamics: &Dynamics, term: usize, output: DriveSignal, omega: f64) -> Complex {
        let moved = self.cables.iter().find(|moved| moved.term == term);
        match (moved, dynamics.terms()[term].form()) {
            (Some(moved), DynamicCable::CatenaryDynamic(cable)) => {
                cable.response_to_carrier(&moved.motion, output, omega).unwrap_or_default()
            }
            _ => Complex::new(0.0, 0.0),
        }
    }

    /// Displacement of station `at` of a cable along `direction_w` at ω [rad/s], the platform held.
    pub(super) fn of_station(
        &self,
        dynamics: &Dynamics,
        stations: &CableStations,
        (at, direction_w): (usize, &Vec3),
        omega: f64,
    ) -> Complex {
        let carrier = self.carrier(dynamics, stations.cable);
        stations.by_far_end(dynamics, (at, direction_w), &self.displacements_w[stations.cable], carrier, omega)
    }

    /// Displacement of station `at` of a cable along `direction_w`, the platform and the amplitudes of the clamped modes at
    /// rest.
    pub(crate) fn still_of_station(&self, stations: &CableStations, at: usize, direction_w: &Vec3) -> f64 {
        stations.still_by_far_end(at, direction_w, &self.displacements_w[stations.cable])
    }

    /// Wrench on the platform about its origin by the cables whose stiffness does not depend on frequency.
    pub(crate) fn constant(&self) -> &Vec6 {
        &self.constant
    }

    /// Motions of the carriers of the other cables, each with its index among those whose stiffness depends on frequency.
    pub(crate) fn carriers(&self) -> impl Iterator<Item = (usize, &CarrierMotion)> {
        self.cables.iter().map(|moved| (moved.term, &moved.motion))
    }

    /// Motion of the carrier of a cable, given by its index in the order of the file; `None` if it is at rest or if the
    /// stiffness of the cable does not depend on frequency.
    fn carrier(&self, dynamics: &Dynamics, cable: usize) -> Option<&CarrierMotion> {
        self.carriers().find(|(term, _)| dynamics.terms()[*term].cable() == cable).map(|(_, motion)| motion)
    }
}

/// Motion of the carrier of a cable in the axes of its model.
fn carrier_motion(state: &CableState, anchor: &AnchorMotion, axes: &LocalAxes) -> CarrierMotion {
    let LocalAxes { e, n, b } = axes;
    let drive = state.drive.as_ref();
    let contact = drive.and_then(|drive| drive.contact.as_ref());
    let travel_w = drive.map_or_else(Vec3::zeros, |drive| drive.end.travel_w);
    CarrierMotion {
        displacement: [e, n, b].map(|axis| axis.dot(&anchor.exit_w)),
        on_swivel: contact.map_or(0.0, |contact| state.tension_anchor * contact.exit_normal_w().dot(&anchor.turn_w)),
        along_drum_side: contact.map_or(travel_w, |contact| contact.axis_w).dot(&anchor.entry_w),
        with_drum: anchor.with_drum,
    }
}

/// Force on the platform by a motion of the anchor of a cable whose stiffness does not depend on frequency [N].
fn constant_force_w(
    robot: &Robot,
    i: usize,
    state: &CableState,
    dynamics: &Dynamics,
    anchor: &AnchorMotion,
) -> Result<Vec3, CableMotionError> {
    let linearisation = dynamics.linearisation;
    let (model, winches) = (linearisation.cable_model, linearisation.winches);
    let found = EndStiffness::new(robot, i, state, model, linearisation.in_plane_only, winches, 1.0);
    let Ok(EndStiffness::Constant(stiffness)) = found else {
        return Err(CableMotionError::NoFrameMotion { cable: robot.cables[i].name.clone() });
    };
    let mut force_w = stiffness * anchor.exit_w;

    // The drive adds the forces of a drum side that is stretched and of a swivel that turns.
    if let (Some(drive), Some(span)) = (&state.drive, &state.hanging) {
        let held: Mat3 = span.tangent_w();
        let axes = LocalAxes::of_cable(robot, i, state);
        let motion = carrier_motion(state, anchor, &axes);
        let stretched = if motion.with_drum { 0.0 } else { motion.along_drum_side / drive.end.stretch_drum };
        if let Some(by_length_w) = drive.end.force_by_length_w(&held) {
            force_w -= by_length_w * stretched;
        }
        force_w += drive.end.force_by_swivel_w(&held) * motion.on_swivel;
    }
    Ok(force_w)
}

/// Motion of the feet of flexible supports, world axes; zero on a rigid frame.
///
/// # Errors
/// [`CableMotionError::FrameAndSupports`]: a rotation of the base, or a motion of an anchor on a support.
fn feet_w(robot: &Robot, dynamics: &Dynamics, input: &FrameInput) -> Result<Vec3, CableMotionError> {
    match input {
        _ if dynamics.supports().is_none() => Ok(Vec3::zeros()),
        FrameInput::BaseAlong(direction_w) => Ok(direction_w.normalize()),
        FrameInput::Anchor { cable, .. } if robot.cables[*cable].anchor.support.is_none() => Ok(Vec3::zeros()),
        FrameInput::BaseAbout(_) | FrameInput::Anchor { .. } => Err(CableMotionError::FrameAndSupports),
    }
}

/// Wrench of a force at the end of a lever, world axes.
fn wrench(force_w: &Vec3, lever_w: &Vec3) -> Vec6 {
    let moment_w = lever_w.cross(force_w);
    Vec6::new(force_w.x, force_w.y, force_w.z, moment_w.x, moment_w.y, moment_w.z)
}
