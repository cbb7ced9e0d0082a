//! A robot in motion along a path: tensions with the inertia of the platform and of the ropes, unstrained lengths,
//! their rates and accelerations.
//!
//! The cables are quasi-static: at every time each has the shape of a cable at rest. The inertia of the platform is a
//! load on it (docs/theory.md, equation (40z5)), that of a taut rope a load along it, (40z8).

mod length_acceleration;

pub use length_acceleration::length_accelerations;

use crate::gradient::{GradientError, LengthRates};
use crate::math::{Vec3, Vec6};
use crate::path::PathPoint;
use crate::robot::{Constraint, Robot, State};
use crate::statics::{self, Equilibrium, HeldTensions, StaticModel, StaticsError, TensionRule};
use std::f64::consts::PI;

/// Time over which differences stand for derivatives that do not exist in closed form [s]. Their error is a third of
/// its square times the third derivative of the lengths; the lengths have an error of 1e-12 m, over this time 1e-8 m/s.
pub const RATE_DIFFERENCE: f64 = 1e-4;

/// Difference of the rates on both sides of a time, over the smaller of them, from which on the tensions jump on one
/// side, and least rate that is compared [m/s]: a jump of 1 N in 10 m of rope with 1 MN is 0.1 m/s over this time.
const JUMP: f64 = 3.0;
const MIN_JUMP: f64 = 0.01;

/// Part of the load of a rope that swings with the platform about its fixed anchor: a uniform load with the same force
/// at the platform as `μ (1 − s/l) a`.
const UNIFORM: f64 = 2.0 / 3.0;

/// Robot that follows a path, with what it needs at every time of it.
///
/// # Example
/// ```
/// use funicular::path::{CourseForm, MotionLimits, PlatformPath};
/// use funicular::robot::{Pose, Robot};
/// use funicular::statics::{StaticModel, TensionRule};
/// use funicular::trajectory::AlongPath;
///
/// let robot = Robot::from_toml(funicular_robots::COGIRO)?;
/// let limits = MotionLimits { speed: 2.0, acceleration: 3.0, jerk: 20.0, ..MotionLimits::default() };
/// let poses = [Pose::new([0.0, 0.0, 1.5], [0.0; 3]), Pose::new([3.0, 0.0, 1.5], [0.0; 3])];
/// let path = PlatformPath::through(&poses, &limits, CourseForm::JerkLimited, 0.0)?;
///
/// let mut along = AlongPath::new(&robot, StaticModel::Catenary, TensionRule::Lowest, false);
/// let in_motion = along.at(&path.at(0.5 * path.duration()))?;
/// assert!(in_motion.length_rates.iter().all(|rate| rate.abs() < 2.0)); // m/s
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, section 10d.
pub struct AlongPath<'a> {
    /// Robot without its motion.
    at_rest: &'a Robot,
    /// Robot with the loads of the motion.
    loaded: Robot,
    model: StaticModel,
    rule: TensionRule,
    rope_inertia: bool,
}

/// Robot at one time of a path.
#[derive(Debug, Clone, PartialEq)]
pub struct InMotion {
    /// Motion of the platform.
    pub point: PathPoint,
    /// Equilibrium with the loads of the motion.
    pub equilibrium: Equilibrium,
    /// Rates of the unstrained lengths [m/s], positive while they are paid out.
    pub length_rates: Vec<f64>,
    /// Reason why the rates are differences of lengths at neighbouring times, if they are.
    pub no_exact_rates: Option<GradientError>,
    /// Conditions that hold the tensions of the rule.
    pub held: HeldTensions,
    /// Distances from the further conditions that could hold them, see [`HeldTensions::of`].
    pub distances: Vec<f64>,
}

impl<'a> AlongPath<'a> {
    /// Robot whose tensions follow a rule if its cables leave a choice. `rope_inertia` adds that of the ropes across
    /// them, as of taut strings with fixed anchors.
    pub fn new(robot: &'a Robot, model: StaticModel, rule: TensionRule, rope_inertia: bool) -> Self {
        Self { at_rest: robot, loaded: robot.clone(), model, rule, rope_inertia }
    }

    /// Tensions, lengths and rates at a time of a path.
    ///
    /// # Errors
    /// [`StaticsError`]: the cables do not hold the platform with its inertia within their limits, or are fewer than
    /// the degrees of freedom.
    pub fn at(&mut self, point: &PathPoint) -> Result<InMotion, StaticsError> {
        let equilibrium = self.equilibrium(point)?;
        let (length_rates, no_exact_rates) = match LengthRates::of(&self.loaded, &equilibrium, &self.rule) {
            Ok(rates) => (self.rates(point, &rates), None),
            Err(reason) => (self.differences(point)?, Some(reason)),
        };
        let (held, distances) = HeldTensions::of(&self.loaded, &equilibrium, &self.rule);
        Ok(InMotion { point: *point, equilibrium, length_rates, no_exact_rates, held, distances })
    }

    /// Robot with the loads of the motion at the last time.
    pub fn loaded(&self) -> &Robot {
        &self.loaded
    }

    /// Robot with the loads of a motion.
    pub fn loaded_at(&mut self, point: &PathPoint) -> &Robot {
        self.load(point);
        &self.loaded
    }

    /// Equilibrium with the loads of the motion.
    ///
    /// # Errors
    /// [`StaticsError`], as for [`Self::at`].
    pub fn equilibrium(&mut self, point: &PathPoint) -> Result<Equilibrium, StaticsError> {
        if let Constraint::Under(_) = self.at_rest.constraint() {
            let (cables, dof) = (self.at_rest.cables.len(), self.at_rest.platform.motion.count());
            return Err(StaticsError::InverseCableCount { cables, dof });
        }

        self.load(point);
        let state = State::Pose(point.pose);
        Ok(statics::solve_at(&self.loaded, &state, self.model, &self.rule)?.equilibrium)
    }

    /// Puts the loads of a motion on the robot. The dead load keeps its point: the moment of the inertia is about it.
    fn load(&mut self, point: &PathPoint) {
        let [force_w, moment_w] = point.inertia(self.at_rest);
        let (dead, arm_w) = (&self.at_rest.load, point.pose.rot_wp * self.at_rest.load.point_p);
        self.loaded.load.force_w = dead.force_w + force_w;
        self.loaded.load.moment_w = dead.moment_w + moment_w - arm_w.cross(&force_w);

        if self.rope_inertia {
            for i in 0..self.loaded.cables.len() {
                let of_rope = rope_inertia(self.at_rest, i, point);
                self.loaded.cables[i].load_per_length_w = self.at_rest.cables[i].load_per_length_w + of_rope;
            }
        }
    }

    /// Rates of the lengths by their derivatives, (40z6).
    fn rates(&self, point: &PathPoint, rates: &LengthRates) -> Vec<f64> {
        let ([force_w, _], [force_rate, moment_rate]) = (point.inertia(self.at_rest), point.inertia_rate(self.at_rest));
        let arm_w = point.pose.rot_wp * self.at_rest.load.point_p;
        let turning = point.twist()[1].cross(&arm_w).cross(&force_w);
        let moment_rate = moment_rate - turning - arm_w.cross(&force_rate);
        let load_rate = Vec6::from_iterator(force_rate.iter().chain(moment_rate.iter()).copied());

        let mut found = rates.of_twist(&point.velocity_w);
        for (rate, by_load) in found.iter_mut().zip(&rates.by_load) {
            *rate += by_load.dot(&load_rate);
        }
        if self.rope_inertia {
            let [before, after] = [-RATE_DIFFERENCE, RATE_DIFFERENCE].map(|time| point.shifted(time));
            let rope_rate = |i| {
                let of = |point| rope_inertia(self.at_rest, i, point);
                (of(&after) - of(&before)) / (2.0 * RATE_DIFFERENCE)
            };
            let rope_rates: Vec<Vec3> = (0..self.loaded.cables.len()).map(rope_rate).collect();
            for (rate, by_rope_load) in found.iter_mut().zip(&rates.by_rope_load) {
                *rate += by_rope_load.iter().zip(&rope_rates).map(|(by, of)| by.dot(of)).sum::<f64>();
            }
        }
        found
    }

    /// Rates of the lengths as differences over a short time; those of the smoother side if the tensions jump on the
    /// other.
    fn differences(&mut self, point: &PathPoint) -> Result<Vec<f64>, StaticsError> {
        let [before, here, after] =
            [-RATE_DIFFERENCE, 0.0, RATE_DIFFERENCE].map(|time| self.equilibrium(&point.shifted(time)));
        self.load(point);
        let [before, here, after] = [before?, here?, after?];
        let rates = |from: &Equilibrium, to: &Equilibrium, time: f64| -> Vec<f64> {
            let pairs = from.cables.iter().zip(&to.cables);
            pairs.map(|(from, to)| (to.unstrained_length - from.unstrained_length) / time).collect()
        };
        let [backward, forward] = [rates(&before, &here, RATE_DIFFERENCE), rates(&here, &after, RATE_DIFFERENCE)];
        let size = |of: &[f64]| of.iter().fold(0.0, |most: f64, rate| most.max(rate.abs()));
        let difference = backward.iter().zip(&forward).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        Ok(if difference <= JUMP * size(&backward).min(size(&forward)).max(MIN_JUMP) {
            rates(&before, &after, 2.0 * RATE_DIFFERENCE)
        } else if size(&backward) < size(&forward) {
            backward
        } else {
            forward
        })
    }
}

/// Uniform load along a rope that has the force at the platform of the rope's inertia across it, world axes [N/m]; zero
/// for a rope that does not move.
///
/// # References
/// docs/theory.md, equation (40z8).
fn rope_inertia(robot: &Robot, i: usize, point: &PathPoint) -> Vec3 {
    let cable = &robot.cables[i];
    let ([velocity, omega], lever_w) = (point.twist(), point.pose.rot_wp * cable.attachment_p);
    let acceleration = |k: usize| point.acceleration_w[k];
    let (linear, angular) = (Vec3::from_fn(|k, _| acceleration(k)), Vec3::from_fn(|k, _| acceleration(k + 3)));

    let chord_w = cable.chord_w(&point.pose);
    let (length, pull_w) = (chord_w.norm(), chord_w.normalize());
    let end_velocity = velocity + omega.cross(&lever_w);
    let end_acceleration = linear + angular.cross(&lever_w) + omega.cross(&omega.cross(&lever_w));
    let across = |of: &Vec3| of - pull_w * of.dot(&pull_w);
    let length_rate = -end_velocity.dot(&pull_w);
    let of_rope = across(&end_acceleration) + across(&end_velocity) * (length_rate / length);
    of_rope * (-UNIFORM * cable.material.mass_per_length)
}

impl InMotion {
    /// First frequency of a cable as a taut string with fixed ends [Hz], the lowest of all cables; `None` without a
    /// rope that has mass. Cables follow the platform as at rest far below it.
    pub fn lowest_string_frequency(&self, robot: &Robot) -> Option<f64> {
        let frequencies = self.equilibrium.cables.iter().zip(&robot.cables).filter_map(|(state, cable)| {
            let mass = cable.material.mass_per_length;
            let omega = PI / state.chord() * (state.tension_platform / mass).sqrt();
            (mass > 0.0).then_some(omega / (2.0 * PI))
        });
        frequencies.reduce(f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{Dynamics, Linearisation};
    use crate::robot::Pose;

    /// Point mass without weight, held by four taut cables in the plane y = 0.
    fn plane_robot() -> Robot {
        let head = "name = \"plane\"\ngravity_m_s2 = [0, 0, 0]\n[platform]\nmass_kg = 5\nmotion = \"point-mass\"\n\
                    [materials.rope]\naxial_stiffness_n = 4e5\nmass_kg_per_m = 0.05\n";
        let cable = |(k, [x, z]): (usize, [f64; 2])| {
            format!(
                "[[cables]]\nname = \"{k}\"\nmaterial = \"rope\"\nanchor_m = [{x}, 0.0, {z}]\n\
                 unstrained_length_m = 4.99\n"
            )
        };
        let corners = [[-4.0, 3.0], [4.0, 3.0], [-4.0, -3.0], [4.0, -3.0]];
        let cables: String = corners.into_iter().enumerate().map(cable).collect();
        Robot::from_toml(&format!("{head}{cables}")).unwrap()
    }

    #[test]
    fn the_load_of_a_rope_is_that_of_its_elements() {
        let robot = plane_robot();
        let six = |x: f64, y: f64, z: f64| Vec6::new(x, y, z, 0.0, 0.0, 0.0);
        let point = PathPoint {
            velocity_w: six(0.7, 1.1, -0.4),
            acceleration_w: six(-1.5, 2.0, 0.8),
            ..PathPoint::at_rest(&Pose::new([0.3, 0.2, -0.1], [0.0; 3]))
        };
        for (i, cable) in robot.cables.iter().enumerate() {
            // Element at the distance s from the platform along a straight rope.
            let place = |time: f64, s: f64| {
                let end = point.shifted(time).pose.position_w;
                end + (cable.anchor.point_w - end).normalize() * s
            };
            let chord_w = cable.anchor.point_w - point.pose.position_w;
            let (length, pull_w, step, parts) = (chord_w.norm(), chord_w.normalize(), 1e-3, 200);
            let mut force = Vec3::zeros();
            for k in 0..parts {
                let s = length * (f64::from(k) + 0.5) / f64::from(parts);
                let acceleration = (place(step, s) - 2.0 * place(0.0, s) + place(-step, s)) / (step * step);
                let across = acceleration - pull_w * acceleration.dot(&pull_w);
                force -= across * (cable.material.mass_per_length * (1.0 - s / length) * length / f64::from(parts));
            }
            let found = rope_inertia(&robot, i, &point) * (0.5 * length);
            // Midpoints: 1/(12·200²) of the force; differences: 1e-6.
            assert!((found - force).norm() < 2e-5 * force.norm(), "{found} {force}");
        }
    }

    #[test]
    fn slow_vibration_across_ropes_has_the_same_inertia() {
        let robot = plane_robot();
        let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 5.0).unwrap();
        let omega = 2.0 * PI * 0.2;
        let [still, moving] = [0.0, omega].map(|omega| dynamics.stiffness(omega)[(1, 1)].re);
        let mass = (still - moving) / (omega * omega);

        let accelerated =
            PathPoint { acceleration_w: Vec6::new(0.0, 1.0, 0.0, 0.0, 0.0, 0.0), ..PathPoint::at_rest(&rest.pose) };
        let of_ropes: f64 =
            (0..4).map(|i| -rope_inertia(&robot, i, &accelerated).y * 0.5 * rest.cables[i].unstrained_length).sum();
        // The string's next term is (ωl/c)²/15; the load is per unstrained length.
        assert!((mass - of_ropes).abs() < 1e-3 * of_ropes, "{mass} {of_ropes}");
    }
}
