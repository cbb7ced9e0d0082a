//! Robot of an estimator: forces, tangents, masses and tensions at one pose and one set of lengths.

use crate::control_loop::MAX_CABLES;
use crate::drive::{CableInLoop, force_by_length_w};
use crate::math::{Mat3, Mat6, Vec3, Vec6, inverse6, skew};
use crate::platform::{
    Coordinates, add_congruent, add_lever_term, damping_matrix, load_wrench, mass_matrix, wrench_of,
};
use crate::robot::{Pose, Robot};
use crate::statics::{LoadedCable, StaticModel, assembled};
use arrayvec::ArrayVec;

/// Part of the mass of a rope that moves with its end in slow motion.
const MASS_AT_END: f64 = 1.0 / 3.0;

/// Least mass that divides the square of the first moment in the inertia of a payload [kg]: the quotient has no bound
/// where the mass is zero.
const MIN_INERTIA_MASS: f64 = 5.0;

/// Step of the length, over the length, for differences of the tension beyond a pulley.
const LENGTH_STEP: f64 = 1e-6;

/// Payload besides the platform of the file, with the external wrench.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct CarriedLoad {
    /// Mass [kg].
    pub(super) mass: f64,
    /// First moment about the platform origin, platform axes [kg m].
    pub(super) moment_p: Vec3,
    /// External wrench about the platform origin, world axes [N, N m].
    pub(super) wrench: Vec6,
}

/// One cable at a pose.
#[derive(Debug, Clone)]
pub(super) struct CableTangents {
    /// Attachment from the platform origin, world axes [m].
    pub(super) lever: Vec3,
    /// Force on the platform [N], its unit vector, and its size.
    pub(super) force: Vec3,
    pub(super) direction: Vec3,
    pub(super) tension_platform: f64,
    /// Derivative of the force by the length [N/m].
    pub(super) by_length: Vec3,
    /// Damping of the stretch, τ EA/L [N s/m]; zero for a cable that hangs loose.
    pub(super) damping: f64,
    /// Tension at the drum or anchor [N] with its derivatives by the attachment and by the length [N/m].
    pub(super) tension: f64,
    pub(super) tension_by_start: Vec3,
    pub(super) tension_by_length: f64,
    /// Unit vector of the cable at its anchor, from there towards the platform, with its derivatives [1/m].
    pub(super) leaving: Vec3,
    pub(super) leaving_by_start: Mat3,
    pub(super) leaving_by_length: Vec3,
    /// Weight of half the rope [N], below which the cable hangs loose.
    pub(super) half_weight: f64,
}

/// Platform on its cables at one pose, quasi-static.
#[derive(Debug, Clone)]
pub(super) struct Tangents {
    pub(super) cables: ArrayVec<CableTangents, MAX_CABLES>,
    /// Sum of all wrenches without those of motion, in the directions in which the platform moves.
    pub(super) wrench: Vec6,
    /// Stiffness, damping and inverse of the mass matrix, in the same directions.
    pub(super) stiffness: Mat6,
    pub(super) damping: Mat6,
    pub(super) inverse_mass: Mat6,
    /// Mass matrix.
    pub(super) mass: Mat6,
    /// Cables, from which the next search over pulleys starts.
    near: ArrayVec<CableInLoop, MAX_CABLES>,
}

/// Robot with its coordinates.
#[derive(Debug, Clone)]
pub(super) struct EstimatedRobot {
    pub(super) robot: Robot,
    pub(super) coordinates: Coordinates,
}

impl EstimatedRobot {
    pub(super) fn new(robot: Robot) -> Self {
        let coordinates = Coordinates::of(&robot);
        Self { robot, coordinates }
    }

    pub(super) fn cables(&self) -> usize {
        self.robot.cables.len()
    }

    /// Wrench in the directions in which the platform moves.
    pub(super) fn allowed(&self, wrench: &Vec6) -> Vec6 {
        self.robot.platform.motion.allowed(wrench)
    }

    /// Matrix in the directions in which the platform moves, with ones in the others.
    fn allowed_with_ones(&self, matrix: &Mat6) -> Mat6 {
        self.coordinates.allowed_matrix(matrix) + Mat6::identity() - self.coordinates.allowed_matrix(&Mat6::identity())
    }

    /// Forces and tangents at a pose; `None` if a cable cannot hang so.
    pub(super) fn at(
        &self,
        pose: &Pose,
        lengths: &[f64],
        load: &CarriedLoad,
        near: Option<&Tangents>,
    ) -> Option<Tangents> {
        let robot = &self.robot;
        let mut cables = ArrayVec::<CableTangents, MAX_CABLES>::new();
        let mut hung = ArrayVec::<CableInLoop, MAX_CABLES>::new();
        let mut parts = ArrayVec::<(Mat3, Vec3, Vec3), MAX_CABLES>::new();
        let mut wrench = load_wrench(robot, pose) + load.wrench;
        let (mut mass, mut damping) = (mass_matrix(&robot.platform, pose), damping_matrix(&robot.platform, pose));
        for (i, length) in lengths.iter().enumerate() {
            if !(length.is_finite() && *length > 0.0) {
                return None;
            }
            let near = near.and_then(|near| near.near.get(i));
            let (cable, tangents) = self.cable_at(i, pose, *length, near)?;
            let stiffness = cable.tangent_w();
            wrench += wrench_of(&tangents.force, &tangents.lever);
            parts.push((stiffness, tangents.force, tangents.lever));
            let along = tangents.direction * tangents.direction.transpose();
            add_congruent(&mut damping, &(along * tangents.damping), &tangents.lever);
            let rope = robot.cables[i].material.mass_per_length * length;
            add_congruent(&mut mass, &(Mat3::identity() * (rope * MASS_AT_END)), &tangents.lever);
            cables.push(tangents);
            hung.push(cable);
        }

        let mut stiffness = assembled(robot, pose, parts.into_iter());
        let moment_w = pose.rot_wp * load.moment_p;
        wrench += gravity_of(&robot.gravity_w, load.mass, &moment_w);
        add_lever_term(&mut stiffness, &robot.gravity_w, &moment_w);
        add_payload_mass(&mut mass, load.mass, &moment_w);
        let mass = self.allowed_with_ones(&mass);
        Some(Tangents {
            cables,
            wrench: self.allowed(&wrench),
            stiffness: self.allowed_with_ones(&stiffness),
            damping: self.coordinates.allowed_matrix(&damping),
            inverse_mass: inverse6(&mass)?,
            mass,
            near: hung,
        })
    }

    /// Cable of a length at a pose with all derivatives.
    fn cable_at(
        &self,
        i: usize,
        pose: &Pose,
        length: f64,
        near: Option<&CableInLoop>,
    ) -> Option<(CableInLoop, CableTangents)> {
        let cable = &self.robot.cables[i];
        let load = LoadedCable::at(&self.robot, i, pose, StaticModel::Catenary).load;
        let start_w = pose.point_w(&cable.attachment_p);
        let hung = CableInLoop::hang(start_w, cable, &load, length, near)?;
        let (span, catenary) = (&hung.span, &hung.span.catenary);
        let by_length = force_by_length_w(span, hung.drive.as_ref());
        let (along_w, up_w) = span.axes_w();
        let weight = catenary.rope().weight_per_length;
        let axial_stiffness = cable.material.axial_stiffness;

        // Force at the upper end, on the cable.
        let end = along_w * catenary.horizontal_force() + up_w * catenary.vertical_force_at_end();
        let end_size = end.norm().max(f64::MIN_POSITIVE);
        let leaving = -end / end_size;
        let across = (Mat3::identity() - leaving * leaving.transpose()) / end_size;
        let end_by_length = by_length + up_w * weight;

        // Derivatives of the tension at the drum: by the attachment from the energy, which has both derivatives.
        let tension = hung.tension_drum();
        let tension_by_start = by_length / (1.0 + tension / axial_stiffness);
        let tension_by_length = if hung.drive.is_some() {
            let step = length * LENGTH_STEP;
            let longer = CableInLoop::hang(start_w, cable, &load, length + step, Some(&hung))?;
            (longer.tension_drum() - tension) / step
        } else {
            -leaving.dot(&end_by_length)
        };
        let force = span.force_on_start_w();
        let tension_platform = force.norm();
        let half_weight = 0.5 * weight * length;
        let is_loose = tension_platform <= half_weight;
        let loss = cable.material.stretch_loss.time * axial_stiffness / length;
        let tangents = CableTangents {
            lever: pose.rot_wp * cable.attachment_p,
            force,
            direction: force / tension_platform.max(f64::MIN_POSITIVE),
            tension_platform,
            by_length,
            damping: if is_loose { 0.0 } else { loss },
            tension,
            tension_by_start,
            tension_by_length,
            leaving,
            leaving_by_start: across * hung.tangent_w(),
            leaving_by_length: -(across * end_by_length),
            half_weight,
        };
        tangents.force.iter().all(|value| value.is_finite()).then_some((hung, tangents))
    }
}

/// Wrench of the weight of a payload; `moment_w` is its first moment in world axes.
pub(super) fn gravity_of(gravity_w: &Vec3, mass: f64, moment_w: &Vec3) -> Vec6 {
    let (force, moment) = (gravity_w * mass, moment_w.cross(gravity_w));
    Vec6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
}

/// Adds a payload to the mass matrix about the platform origin.
fn add_payload_mass(total: &mut Mat6, mass: f64, moment_w: &Vec3) {
    let cross = skew(moment_w);
    let mut add = |row: usize, column: usize, block: Mat3| {
        let mut view = total.fixed_view_mut::<3, 3>(row, column);
        view += block;
    };
    // A payload that is estimated below zero takes inertia from the platform, but never more than noise does.
    add(0, 0, Mat3::identity() * mass);
    add(0, 3, -cross);
    add(3, 0, cross);
    add(3, 3, -(cross * cross) / mass.max(MIN_INERTIA_MASS));
}

impl Tangents {
    /// Acceleration (linear, angular) of the platform origin with velocities and rates of the lengths.
    pub(super) fn acceleration(&self, of: &EstimatedRobot, twist: &Vec6, rates: &[f64]) -> Vec6 {
        let (velocity, turn) = split(twist);
        let mut total = self.wrench - self.damping * twist;
        for (cable, rate) in self.cables.iter().zip(rates) {
            total -= wrench_of(&(cable.direction * (cable.damping * rate)), &cable.lever);
        }
        // Centrifugal and gyroscopic terms about the platform origin, whose velocity needs none.
        let _ = velocity;
        let first: Vec3 = self.first_moment();
        let inertia = self.mass.fixed_view::<3, 3>(3, 3) * turn;
        let force = turn.cross(&turn.cross(&first));
        let moment = turn.cross(&inertia);
        total -= Vec6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z);
        self.inverse_mass * of.allowed(&total)
    }

    /// First moment of the mass about the platform origin, world axes [kg m], by the mass matrix.
    fn first_moment(&self) -> Vec3 {
        Vec3::new(self.mass[(5, 1)], self.mass[(3, 2)], self.mass[(4, 0)])
    }

    /// Rate of the chord of a cable [m/s], positive when the platform moves away from the anchor.
    pub(super) fn chord_rate(cable: &CableTangents, twist: &Vec6) -> f64 {
        let (velocity, turn) = split(twist);
        -cable.direction.dot(&(velocity + turn.cross(&cable.lever)))
    }

    /// Wrench on the platform per unit of each length [N/m].
    pub(super) fn wrench_by_length(&self, i: usize) -> Vec6 {
        let cable = &self.cables[i];
        wrench_of(&cable.by_length, &cable.lever)
    }
}

/// Linear and angular part.
pub(super) fn split(twist: &Vec6) -> (Vec3, Vec3) {
    (twist.fixed_rows::<3>(0).into_owned(), twist.fixed_rows::<3>(3).into_owned())
}
