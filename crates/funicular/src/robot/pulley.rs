//! Swivelling pulley: its data, and the place of a cable on it.
//!
//! The wheel swivels about an axis through the entry point E. The axis has the direction a in which the cable travels
//! at E towards the platform. At the swivel angle γ the wheel's centre is at E + rρ, ρ being the unit vector normal to
//! a in the plane of the wheel. The cable touches the wheel over the wrap angle β and leaves it at the exit point
//! (docs/theory.md, equations (61) to (63)).

use super::friction::PulleyFriction;
use crate::math::dual::{Real, combined};
use crate::math::{Vec3, any_normal};
use std::f64::consts::TAU;

/// Magnitude of a negative wrap angle that is rounding [rad]: that of two angles is 1e-15. An end near the swivel axis
/// makes it larger, since the distance from the axis then has a rounding of 1e-16 of the coordinates.
const ANGLE_ROUNDING: f64 = 1e-9;

/// Swivelling pulley.
#[derive(Debug, Clone, PartialEq)]
pub struct Pulley {
    /// Name in the robot file.
    pub name: String,
    /// Radius r of the cable's centre line on the wheel [m], positive.
    pub radius: f64,
    /// Unit vector a along which the cable travels at the entry point, towards the platform; the swivel axis, world
    /// axes.
    pub entry_direction_w: Vec3,
    /// Moment of inertia of the wheel about its axle [kg m²].
    pub inertia: f64,
    /// Moment of inertia of all that swivels, wheel included, about the swivel axis [kg m²].
    pub swivel_inertia: f64,
    /// Friction; `None` for a wheel without friction.
    pub friction: Option<PulleyFriction>,
}

/// Place of a cable on a pulley: swivel angle and wrap angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PulleyContact {
    /// Radius r of the cable's centre line on the wheel [m].
    pub radius: f64,
    /// Wrap angle β [rad], from 0 to 2π.
    pub wrap: f64,
    /// Swivel axis a: direction of travel at the entry point, unit vector, world axes.
    pub axis_w: Vec3,
    /// Direction ρ from the entry point to the wheel's centre, unit vector normal to the axis, world axes.
    pub center_w: Vec3,
    /// Direction ν = a × ρ normal to the wheel, unit vector, world axes.
    pub sideways_w: Vec3,
}

impl Pulley {
    /// Pulley without inertia and without friction.
    pub fn new(name: &str, radius: f64, entry_direction_w: Vec3) -> Self {
        Self { name: name.to_owned(), radius, entry_direction_w, inertia: 0.0, swivel_inertia: 0.0, friction: None }
    }

    /// Distance of a point from the wheel's centre [m]; the wheel swivels towards the point. `reach_w` is the point
    /// from the entry point.
    pub(crate) fn distance_from_center(&self, reach_w: &Vec3) -> f64 {
        let along = reach_w.dot(&self.entry_direction_w);
        let across = (reach_w - self.entry_direction_w * along).norm();
        (across - self.radius).hypot(along)
    }

    /// Place of a straight cable that ends at `reach_w` from the entry point [m].
    ///
    /// An end inside the wheel has no tangent; the result is then the place at which the end would be on the rim. An
    /// end on the swivel axis leaves the swivel angle open; the result has any.
    ///
    /// # Example
    /// ```
    /// use funicular::{math::Vec3, robot::Pulley};
    ///
    /// let pulley = Pulley::new("wheel", 0.5, Vec3::z()); // the cable comes up the post
    /// // The cable goes over the wheel and straight down at twice the radius.
    /// let contact = pulley.contact(&Vec3::new(1.0, 0.0, -4.0));
    /// assert!((contact.wrap - std::f64::consts::PI).abs() < 1e-15);
    /// assert!((contact.exit_offset_w() - Vec3::new(1.0, 0.0, 0.0)).norm() < 1e-15);
    /// ```
    ///
    /// # References
    /// docs/theory.md, equation (63).
    pub fn contact(&self, reach_w: &Vec3) -> PulleyContact {
        let (r, axis_w) = (self.radius, self.entry_direction_w);
        let along = reach_w.dot(&axis_w);
        let across_w = reach_w - axis_w * along;
        let across = across_w.norm();
        let center_w = if across > 0.0 { across_w / across } else { any_normal(&axis_w) };

        // Angle of the end seen from the wheel's centre, counted from the entry point, less that of the tangent.
        let beyond_center = across - r;
        let tangent = (beyond_center * beyond_center + along * along - r * r).max(0.0).sqrt();
        let wrap = along.atan2(-beyond_center).rem_euclid(TAU) - tangent.atan2(r);
        let wrap = if wrap < -ANGLE_ROUNDING { wrap + TAU } else { wrap.max(0.0) };
        PulleyContact::new(self, center_w, wrap)
    }
}

impl PulleyContact {
    /// Place with the wheel's centre in the direction `center_w` and the wrap angle `wrap` [rad].
    pub(crate) fn new(pulley: &Pulley, center_w: Vec3, wrap: f64) -> Self {
        let axis_w = pulley.entry_direction_w;
        Self { radius: pulley.radius, wrap, axis_w, center_w, sideways_w: axis_w.cross(&center_w) }
    }

    /// Place after small changes of wrap and swivel angle [rad].
    pub(crate) fn turned(&self, wrap: f64, swivel: f64) -> Self {
        let (sin, cos) = swivel.sin_cos();
        let center_w = (self.center_w * cos + self.sideways_w * sin).normalize();
        Self { wrap: self.wrap + wrap, center_w, sideways_w: self.axis_w.cross(&center_w), ..*self }
    }

    /// Wheel with the cable on it.
    pub(crate) fn wheel(&self) -> Wheel<f64> {
        Wheel {
            radius: self.radius,
            wrap: self.wrap,
            axis_w: self.axis_w.into(),
            center_w: self.center_w.into(),
            sideways_w: self.sideways_w.into(),
        }
    }

    /// Vector from the entry point to the point of the rim at the angle θ from it [m].
    pub fn offset_w(&self, angle: f64) -> Vec3 {
        self.wheel().offset_w(angle).into()
    }

    /// Vector from the entry point to the exit point [m].
    pub fn exit_offset_w(&self) -> Vec3 {
        self.offset_w(self.wrap)
    }

    /// Direction t of travel at the exit point, towards the platform; unit vector, world axes.
    pub fn exit_direction_w(&self) -> Vec3 {
        self.wheel().exit_direction_w().into()
    }

    /// Direction n from the exit point to the wheel's centre; unit vector, world axes.
    pub fn exit_normal_w(&self) -> Vec3 {
        self.wheel().exit_normal_w().into()
    }

    /// Length of the arc between entry and exit point [m].
    pub fn arc(&self) -> f64 {
        self.radius * self.wrap
    }

    /// Distance of the exit point from the swivel axis [m].
    pub fn distance_from_axis(&self) -> f64 {
        self.wheel().distance_from_axis()
    }
}

/// Cable on a pulley, in numbers or in numbers with derivatives.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wheel<T> {
    /// Radius r [m].
    pub(crate) radius: T,
    /// Wrap angle β [rad].
    pub(crate) wrap: T,
    /// Unit vectors a, ρ and ν of [`PulleyContact`].
    pub(crate) axis_w: [T; 3],
    pub(crate) center_w: [T; 3],
    pub(crate) sideways_w: [T; 3],
}

impl<T: Real> Wheel<T> {
    /// Vector from the entry point to the point of the rim at the angle θ from it [m].
    pub(crate) fn offset_w(&self, angle: T) -> [T; 3] {
        // 1 − cos θ without cancellation.
        let (half, _) = (angle * 0.5).sin_cos();
        let (sin, _) = angle.sin_cos();
        combined(&self.center_w, half * 2.0 * half, &self.axis_w, sin).map(|component| component * self.radius)
    }

    /// Direction t of travel at the exit point.
    pub(crate) fn exit_direction_w(&self) -> [T; 3] {
        let (sin, cos) = self.wrap.sin_cos();
        combined(&self.center_w, sin, &self.axis_w, cos)
    }

    /// Direction n from the exit point to the wheel's centre.
    pub(crate) fn exit_normal_w(&self) -> [T; 3] {
        let (sin, cos) = self.wrap.sin_cos();
        combined(&self.center_w, cos, &self.axis_w, -sin)
    }

    /// Distance of the exit point from the swivel axis [m].
    pub(crate) fn distance_from_axis(&self) -> T {
        let (half, _) = (self.wrap * 0.5).sin_cos();
        self.radius * 2.0 * half * half
    }
}
