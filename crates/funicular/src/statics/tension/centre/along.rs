//! Platform, loads and cables along a motion: values with their first two derivatives by time.

use super::corners::RoundedForces;
use super::curve::{TauLimitKind, TensionCurve};
use crate::catenary::Catenary;
use crate::drive::at_tension::{AtTension, SpanAtTension};
use crate::math::dual::{Real, combined, dot};
use crate::math::jet::Jet;
use crate::math::{Matrix, Vec3, Vec6};
use crate::platform::wrench_of;
use crate::robot::{Anchor, Load, Pose, Robot};
use crate::statics::limits::MinimumTension;

/// Number of unknowns of a cable at a limit: those of its place, and τ.
const AT_LIMIT: usize = 4;

/// Platform along a motion: coefficients of 1, t and t².
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlatformAlong {
    origin_w: [Vec3; 3],
    pose: Pose,
    turn_w: Vec3,
    turn_acceleration_w: Vec3,
}

impl PlatformAlong {
    /// Motion with these velocities and accelerations of the origin [m/s, m/s²] and of the rotation [rad/s, rad/s²].
    pub(crate) fn new(pose: &Pose, velocity_w: &Vec6, acceleration_w: &Vec6) -> Self {
        let parts = |of: &Vec6| [Vec3::new(of[0], of[1], of[2]), Vec3::new(of[3], of[4], of[5])];
        let ([linear, turn_w], [linear_acceleration, turn_acceleration_w]) = (parts(velocity_w), parts(acceleration_w));
        Self {
            origin_w: [pose.position_w, linear, linear_acceleration * 0.5],
            pose: *pose,
            turn_w,
            turn_acceleration_w,
        }
    }

    /// Coefficients of a vector that is fixed to the platform, in platform axes.
    pub(crate) fn vector(&self, vector_p: &Vec3) -> [Vec3; 3] {
        let (vector_w, turn) = (self.pose.rot_wp * vector_p, &self.turn_w);
        let rate = turn.cross(&vector_w);
        [vector_w, rate, (self.turn_acceleration_w.cross(&vector_w) + turn.cross(&rate)) * 0.5]
    }

    /// Coefficients of a point of the platform [m].
    fn point(&self, point_p: &Vec3) -> [Vec3; 3] {
        let lever = self.vector(point_p);
        std::array::from_fn(|k| self.origin_w[k] + lever[k])
    }

    /// Coefficients of t and t² of the dead load of a robot about the platform's origin (N, N m).
    pub(crate) fn dead_load(&self, robot: &Robot) -> [Vec6; 2] {
        let Load { force_w, point_p, .. } = &robot.load;
        let mass_centre = self.vector(&robot.platform.center_of_mass_p);
        let point = self.vector(point_p);
        [1, 2].map(|k| {
            let mut wrench =
                wrench_of(&robot.force_at_mass_centre_w(), &mass_centre[k]) + wrench_of(force_w, &point[k]);
            wrench.fixed_rows_mut::<3>(0).fill(0.0);
            wrench
        })
    }
}

/// Numbers with derivatives from the coefficients of a vector.
pub(super) fn jets<const N: usize>(coefficients: &[Vec3; 3]) -> [Jet<N>; 3] {
    std::array::from_fn(|k| Jet::of_time(coefficients.map(|of| of[k])))
}

impl<'a> TensionCurve<'a> {
    /// Cable of any tension along a motion.
    pub(super) fn along<const N: usize>(&self, platform: &PlatformAlong) -> AtTension<'a, Jet<N>> {
        let (cable, at) = (self.cable(), self.at_tension());
        let start_w = jets(&platform.point(&cable.attachment_p));
        let drag_width = cable.material.drag_width.filter(|width| *width > 0.0 && at.load > 0.0);
        let (load, up_w) = match drag_width {
            Some(width) if self.robot().wind.velocity_w != Vec3::zeros() => self.load_in_wind(&start_w, width),
            _ => (Jet::from(at.load), at.up_w.map(Jet::from)),
        };
        let (axial_stiffness, anchor, contact) = (at.axial_stiffness, at.anchor, at.contact);
        AtTension { start_w, load, up_w, axial_stiffness, anchor, contact, load_turns: false }
    }

    /// Load in a wind of a cable with a drag width [m] as if it were straight, as [`Robot::line_load`]: its size, and
    /// the direction against it.
    fn load_in_wind<T: Real>(&self, start_w: &[T; 3], drag_width: f64) -> (T, [T; 3]) {
        let (robot, cable) = (self.robot(), self.cable());
        let chord_w = straight_chord(&cable.anchor, start_w);
        let per_chord = T::from(1.0) / dot(&chord_w, &chord_w).sqrt();
        let axis_w = chord_w.map(|component| component * per_chord);
        let wind = [0, 1, 2].map(|k| T::from(robot.wind.velocity_w[k]));
        let across = combined(&wind, T::from(1.0), &axis_w, -dot(&axis_w, &wind));
        let squared = dot(&across, &across);
        let pressure = if squared.value() > 0.0 { squared.sqrt() } else { squared };
        let pressure = pressure * (0.5 * robot.wind.air_density * drag_width);

        let dead_w = robot.gravity_w * cable.material.mass_per_length + cable.load_per_length_w;
        let total: [T; 3] = std::array::from_fn(|k| across[k] * pressure + T::from(dead_w[k]));
        let size = dot(&total, &total).sqrt();
        (size, total.map(|component| -(component / size)))
    }

    /// Tension of a limit less its value, zero at the limit.
    fn beyond_limit<T: Real>(&self, kind: TauLimitKind, at: &AtTension<'_, T>, span: &SpanAtTension<T>, tau: T) -> T {
        let sags = at.load.value() > 0.0;
        let forces = RoundedForces {
            horizontal_squared: span.horizontal_squared,
            vertical: span.vertical,
            weight: span.weight,
            drum: span.drum,
        };
        match kind {
            TauLimitKind::Slackest => tau - span.chord * at.load * Catenary::MIN_TENSION_TO_WEIGHT,
            TauLimitKind::Maximum => {
                let maximum = self.cable().limits().maximum.unwrap_or(f64::INFINITY);
                (if sags { forces.highest() } else { tau }) - T::from(maximum)
            }
            TauLimitKind::Minimum(minimum) => {
                let lowest = if sags { forces.lowest() } else { tau };
                match minimum {
                    MinimumTension::OfCable { factor } if sags => lowest - span.chord * at.load * factor,
                    MinimumTension::OfCable { factor } => {
                        lowest - span.chord * (factor * self.robot().line_load(self.index(), &self.span.chord_w()).size)
                    }
                    _ => lowest - T::from(self.minimum(minimum)),
                }
            }
        }
    }

    /// Coefficients of the limit of τ at which this cable is, along a motion [N]; `None` if the limit does not
    /// determine it.
    pub(super) fn limit_along(&self, kind: TauLimitKind, platform: &PlatformAlong) -> Option<[f64; 3]> {
        let (fixed, tau) = (self.at_tension(), self.tau());
        let length = self.span.catenary.rope().unstrained_length;
        let (lifted, span) = fixed.span_by_place(tau, length);
        let by_tau = crate::math::dual::Dual::<AT_LIMIT>::variable(tau, AT_LIMIT - 1);
        let beyond = self.beyond_limit(kind, &lifted, &span, by_tau);
        let by = |row: usize| if row < AT_LIMIT - 1 { span.conditions[row].by } else { beyond.by };
        let inverse = Matrix::<AT_LIMIT, AT_LIMIT>::from_fn(|row, column| by(row)[column]).try_inverse()?;

        // One order of the derivatives becomes right in each step.
        let at = self.along::<1>(platform);
        let mut unknown = [Jet::from(0.0), Jet::from(0.0), Jet::from(length), Jet::from(tau)];
        for _ in 0..2 {
            let [wrap, swivel, length, tau] = unknown;
            let span = at.span(tau, &[wrap, swivel, length]);
            let conditions =
                [span.conditions[0], span.conditions[1], span.conditions[2], self.beyond_limit(kind, &at, &span, tau)];
            for (k, value) in unknown.iter_mut().enumerate() {
                for (row, condition) in conditions.iter().enumerate() {
                    *value = *value - *condition * inverse[(k, row)];
                }
            }
        }
        let mut coefficients = unknown[AT_LIMIT - 1].coefficients();
        coefficients[0] = tau;
        Some(coefficients)
    }
}

/// Chord of a straight cable from its attachment to its exit point, (61) to (63), without angles.
fn straight_chord<T: Real>(anchor: &Anchor, start_w: &[T; 3]) -> [T; 3] {
    let chord: [T; 3] = std::array::from_fn(|k| T::from(anchor.point_w[k]) - start_w[k]);
    let Some(pulley) = &anchor.pulley else { return chord };
    let (radius, one) = (pulley.radius, T::from(1.0));
    let axis = [0, 1, 2].map(|k| T::from(pulley.entry_direction_w[k]));

    // The wheel turns towards the end; the angle of the end from its centre, less that of the tangent, is the wrap.
    let along = -dot(&chord, &axis);
    let across = combined(&chord, -one, &axis, -along);
    let distance = dot(&across, &across).sqrt();
    let center = across.map(|component| component / distance);
    let beyond = distance - T::from(radius);
    let squared = beyond * beyond + along * along;
    let tangent = (squared - T::from(radius * radius)).sqrt();
    let sin = (along * radius + beyond * tangent) / squared;
    let cos = (along * tangent - beyond * radius) / squared;
    let exit = combined(&center, (one - cos) * radius, &axis, sin * radius);
    std::array::from_fn(|k| chord[k] + exit[k])
}
