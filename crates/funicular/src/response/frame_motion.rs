//! Given motions of the frame as inputs of a response: of the base with all anchors and drums, or of one anchor.
//!
//! Every cable pulls at the platform by the motion of its far end; gravity and loads stay where they are. Derivation:
//! docs/theory.md, equations (83) to (86).

use crate::cable::catenary_dynamic::{ByTurn, CarrierMotion, DriveSignal};
use crate::cable::{EndStiffness, LocalAxes, span_stiffness};
use crate::cable_motion::{CableMotionError, CableStations};
use crate::dynamics::{Dynamics, Supports};
use crate::math::{CVec6, Complex, Mat3, Vec3, Vec6};
use crate::robot::Robot;
use crate::statics::{CableState, Equilibrium, SupportSide, support_side};

/// Given motion of the frame of the robot, harmonic, of unit amplitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FrameInput {
    /// The base moves along a direction in world axes (normalised on use), with all anchors and drums [m].
    BaseAlong(Vec3),
    /// The base turns about a direction in world axes (normalised on use) through the origin of the world, with all
    /// anchors and drums [rad].
    BaseAbout(Vec3),
    /// The anchor of one cable, with its pulley, moves along a direction in world axes (normalised on use); its drum
    /// stays where it is if a drum side leads to the pulley, else the end of the cable moves with the anchor [m]. If
    /// the anchor is on a flexible support, the foot of that support moves: the ground end of its spring. Drums on the
    /// support follow it.
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
    /// Motion with the feet of all flexible supports, world axes, three coordinates per support; empty on a rigid
    /// frame.
    feet: Vec<f64>,
    /// Forces on the supports that do not depend on frequency; empty on a rigid frame.
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
    /// Motion of the anchor of cable `i`, whose state at rest is `state`; `None` if it does not move.
    fn of_anchor(&self, robot: &Robot, i: usize, state: &CableState) -> Option<AnchorMotion> {
        let anchor = &robot.cables[i].anchor;

        match self {
            Self::BaseAlong(direction_w) => {
                let along_w = direction_w.normalize();
                Some(AnchorMotion { entry_w: along_w, exit_w: along_w, turn_w: Vec3::zeros(), with_drum: true })
            }
            Self::BaseAbout(axis_w) => {
                let turn_w = axis_w.normalize();
                let entry_w = turn_w.cross(&(anchor.point_w + state.displacement_w));
                Some(AnchorMotion { entry_w, exit_w: turn_w.cross(&state.anchor_w), turn_w, with_drum: true })
            }
            Self::Anchor { cable, direction_w } => {
                // All anchors on one support move with its foot.
                let support = robot.cables[*cable].anchor.support;
                let is_moved = *cable == i || (support.is_some() && support == anchor.support);
                let along_w = direction_w.normalize();

                let with_drum = match anchor.support.map(|support| &robot.supports[support]) {
                    Some(support) => support.drum_side_from_ground(anchor).is_none(),
                    // Without a pulley the file does not say where the drum side comes from, and without a drum side
                    // the cable ends at the anchor.
                    None => anchor.pulley.is_none() || anchor.drum_side_length() == 0.0,
                };
                let motion = AnchorMotion { entry_w: along_w, exit_w: along_w, turn_w: Vec3::zeros(), with_drum };
                is_moved.then_some(motion)
            }
        }
    }

    /// Motion of the frame at the place of each support of a robot at rest, world axes, three coordinates per support.
    fn of_feet(&self, robot: &Robot, equilibrium: &Equilibrium) -> Vec<f64> {
        let of_support = |support: usize| {
            let carried = |i: &usize| robot.cables[*i].anchor.support == Some(support);
            let moved: Vec<Vec3> = (0..robot.cables.len())
                .filter(carried)
                .filter_map(|i| self.of_anchor(robot, i, &equilibrium.cables[i]))
                .map(|motion| motion.entry_w)
                .collect();
            // A base that turns moves its anchors differently: the mass of the support is taken to be in their middle.
            moved.iter().sum::<Vec3>() / moved.len().max(1) as f64
        };
        (0..robot.supports.len()).map(of_support).flat_map(|moved_w| [moved_w.x, moved_w.y, moved_w.z]).collect()
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
        let mut frame = Self {
            constant: Vec6::zeros(),
            cables: Vec::new(),
            displacements_w: Vec::new(),
            feet: dynamics.supports().map_or_else(Vec::new, |_| input.of_feet(robot, equilibrium)),
            constant_on_supports: vec![0.0; dynamics.supports().map_or(0, Supports::count)],
        };
        for (i, state) in equilibrium.cables.iter().enumerate() {
            let Some(anchor) = input.of_anchor(robot, i, state) else {
                frame.displacements_w.push(Vec3::zeros());
                continue;
            };
            frame.displacements_w.push(anchor.exit_w);

            let side = dynamics.supports().and_then(|_| support_side(robot, i, state));
            let force_on_support_w = if let Some(term) = dynamics.terms().iter().position(|term| term.cable() == i) {
                let axes = dynamics.terms()[term].form().axes();
                let motion = carrier_motion((robot, i, state), &anchor, side.as_ref(), axes);
                frame.cables.push(MovedCable { term, lever_w: state.lever_w, motion });
                Vec3::zeros()
            } else {
                let forces = constant_forces_w(robot, i, state, dynamics, (&anchor, side.as_ref()))?;
                frame.constant += wrench(&forces.on_platform_w, &state.lever_w);
                forces.on_anchor_w
            };

            // The supports.
            let first = dynamics.supports().and_then(|supports| supports.of_cable(i));
            if let (Some(first), Some(side)) = (first, &side) {
                let force_w = force_on_support_w + side.force_by(&anchor);
                (0..3).for_each(|k| frame.constant_on_supports[first + k] += force_w[k]);
            }
        }
        Ok(frame)
    }

    /// Forces on the displacements of the supports at ω [rad/s], the platform and the supports held on their feet.
    pub(super) fn on_supports(&self, dynamics: &Dynamics, supports: &Supports, omega: f64) -> Vec<Complex> {
        let mut forces: Vec<Complex> = self.constant_on_supports.iter().map(|force| Complex::from(*force)).collect();
        supports.add_inertia_of_feet(&mut forces, &self.feet, omega);
        for moved in &self.cables {
            if let Some(form) = dynamics.terms()[moved.term].form().by_poles() {
                let square = dynamics.cable_square(dynamics.terms()[moved.term].cable(), omega);
                supports.add_forces_by_carrier(&mut forces, (moved.term, form), &moved.motion, omega, square);
            }
        }
        forces
    }

    /// Wrench on the platform about its origin at ω [rad/s].
    pub(super) fn vector(&self, dynamics: &Dynamics, omega: f64) -> CVec6 {
        let mut total = self.constant.map(Complex::from);
        for moved in &self.cables {
            let form = dynamics.terms()[moved.term].form();
            let force = form.force_by_carrier(&moved.motion, omega);
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
        match (moved, dynamics.terms()[term].form().by_poles()) {
            (Some(moved), Some(cable)) => {
                cable.response_to_carrier(&moved.motion, output, omega.into()).unwrap_or_default()
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

    /// Displacement of station `at` of a cable along `direction_w`, the platform and the amplitudes of the clamped
    /// modes at rest.
    pub(crate) fn still_of_station(&self, stations: &CableStations, at: usize, direction_w: &Vec3) -> f64 {
        stations.still_by_far_end(at, direction_w, &self.displacements_w[stations.cable])
    }

    /// Wrench on the platform about its origin by the cables whose stiffness does not depend on frequency.
    pub(crate) fn constant(&self) -> &Vec6 {
        &self.constant
    }

    /// Forces on the supports that do not depend on frequency, and motion of the feet of the supports; empty on a rigid
    /// frame.
    pub(crate) fn on_feet(&self) -> (&[f64], &[f64]) {
        (&self.constant_on_supports, &self.feet)
    }

    /// Motions of the carriers of the other cables, each with its index among those whose stiffness depends on
    /// frequency.
    pub(crate) fn carriers(&self) -> impl Iterator<Item = (usize, &CarrierMotion)> {
        self.cables.iter().map(|moved| (moved.term, &moved.motion))
    }

    /// Motion of the carrier of a cable, given by its index in the order of the file; `None` if it is at rest or if the
    /// stiffness of the cable does not depend on frequency.
    fn carrier(&self, dynamics: &Dynamics, cable: usize) -> Option<&CarrierMotion> {
        self.carriers().find(|(term, _)| dynamics.terms()[*term].cable() == cable).map(|(_, motion)| motion)
    }
}

/// Motion of the carrier of a cable in the axes of its model. `side` is its drum side, if the anchor is on a support.
fn carrier_motion(
    (robot, i, state): (&Robot, usize, &CableState),
    anchor: &AnchorMotion,
    side: Option<&SupportSide>,
    axes: &LocalAxes,
) -> CarrierMotion {
    let LocalAxes { e, n, b } = axes;
    let drive = state.drive.as_deref();
    let by_turn = match (drive, &state.hanging) {
        (Some(drive), Some(span)) => drive.by_turn(span, &robot.cables[i].anchor, &anchor.turn_w),
        _ => ByTurn::default(),
    };
    let contact = drive.and_then(|drive| drive.contact.as_ref());
    let travel_w = drive.map_or_else(Vec3::zeros, |drive| drive.end.travel_w);
    let along_w = side.map_or_else(|| contact.map_or(travel_w, |contact| contact.axis_w), |side| side.direction_w);
    CarrierMotion {
        displacement: [e, n, b].map(|axis| axis.dot(&anchor.exit_w)),
        by_turn,
        along_drum_side: along_w.dot(&anchor.entry_w),
        with_drum: anchor.with_drum,
    }
}

/// Forces by a motion of the anchor of a cable whose stiffness does not depend on frequency, world axes [N].
struct ConstantForces {
    on_platform_w: Vec3,
    /// Force on the anchor and the parts that it carries, without the force by the turn of the drum side's tension.
    on_anchor_w: Vec3,
}

/// Forces by a motion of the anchor of a cable whose stiffness does not depend on frequency.
fn constant_forces_w(
    robot: &Robot,
    i: usize,
    state: &CableState,
    dynamics: &Dynamics,
    (anchor, side): (&AnchorMotion, Option<&SupportSide>),
) -> Result<ConstantForces, CableMotionError> {
    let linearisation = dynamics.linearisation;
    let (model, winches) = (linearisation.cable_model, linearisation.winches);
    let no_motion = || CableMotionError::NoFrameMotion { cable: robot.cables[i].name.clone() };
    let found = EndStiffness::new(robot, i, state, model, linearisation.in_plane_only, winches, 1.0);
    let Ok(EndStiffness::Constant(stiffness)) = found else { return Err(no_motion()) };
    let mut on_platform_w = stiffness * anchor.exit_w;

    // The drive adds the forces of a drum side that is stretched and of a swivel that turns.
    let (mut added_to_drum_side, axes) = (0.0, LocalAxes::of_cable(robot, i, state));
    let motion = carrier_motion((robot, i, state), anchor, side, &axes);
    if let (Some(drive), Some(span)) = (&state.drive, &state.hanging) {
        // Supports have been assembled with the stiffness of the span in its model.
        let held: Mat3 = match side {
            Some(_) => span_stiffness(robot, i, state, model).ok_or_else(no_motion)?,
            None => span.tangent_w(),
        };
        let end = &drive.end;
        let ratio = end.stretch / end.stretch_drum;
        let [_, at_wheel, _] = motion.of_drum_side(ratio);
        let (stretched, on_end) = (at_wheel / ratio, motion.by_turn.on_end);
        if let Some(by_length_w) = end.force_by_length_w(&held) {
            on_platform_w -= by_length_w * (stretched / end.stretch_drum);
            added_to_drum_side = end.drum_side_tension(&held, &anchor.exit_w, on_end, stretched);
        }
        on_platform_w += end.force_by_end_w(&held, on_end);
    }

    let pulled_w = side.filter(|side| side.from_ground).map_or_else(Vec3::zeros, |side| side.direction_w);
    Ok(ConstantForces { on_platform_w, on_anchor_w: -on_platform_w - pulled_w * added_to_drum_side })
}

impl SupportSide {
    /// Force on the support, for a given motion of its anchor, of forces that turn with the frame or pull at a drum
    /// that stays where it is, world axes [N].
    fn force_by(&self, anchor: &AnchorMotion) -> Vec3 {
        let turned_w = -anchor.turn_w.cross(&self.carried_w);
        if anchor.with_drum { turned_w } else { turned_w - self.sideways_w * anchor.entry_w }
    }
}

/// Wrench of a force at the end of a lever, world axes.
fn wrench(force_w: &Vec3, lever_w: &Vec3) -> Vec6 {
    let moment_w = lever_w.cross(force_w);
    Vec6::new(force_w.x, force_w.y, force_w.z, moment_w.x, moment_w.y, moment_w.z)
}
