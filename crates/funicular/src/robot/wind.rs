//! Steady wind, and the load per length of a cable: its weight, the wind, and further loads given by the file.

use super::Robot;
use crate::math::{Mat3, Vec3};

/// Steady, uniform wind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wind {
    /// Velocity of the air, world axes [m/s].
    pub velocity_w: Vec3,
    /// Density of the air [kg/m³].
    pub air_density: f64,
}

impl Wind {
    /// Default air density [kg/m³]: the ISO standard atmosphere (ISO 2533) at sea level.
    pub const AIR_DENSITY: f64 = 1.225;

    /// Maximum wind speed [m/s]: a third of the speed of sound, up to which the compressibility of air hardly matters.
    pub const MAX_SPEED: f64 = 110.0;

    /// Force on a body per area and drag coefficient [N/m²], along the wind: `½ ρ |u| u`.
    pub fn pressure_w(&self) -> Vec3 {
        self.velocity_w * (0.5 * self.air_density * self.velocity_w.norm())
    }

    /// Derivative of [`Self::pressure_w`] with respect to the velocity; 3×3, world axes, symmetric [N s/m³].
    pub(crate) fn pressure_by_velocity_w(&self) -> Mat3 {
        magnified(&self.velocity_w) * (0.5 * self.air_density)
    }

    /// Wind of the same velocity in air of density 1 kg/m³; all forces of a wind are proportional to the density.
    pub(crate) fn at_unit_density(&self) -> Self {
        Self { air_density: 1.0, ..*self }
    }

    /// Force on a straight cylinder per length, diameter and drag coefficient [N/m²]. Only the wind component normal to
    /// the axis (a unit vector) counts (the cross-flow principle, theory (49)).
    pub fn cross_pressure_w(&self, axis_w: &Vec3) -> Vec3 {
        let across = self.velocity_w - axis_w * axis_w.dot(&self.velocity_w);
        across * (0.5 * self.air_density * across.norm())
    }

    /// Drag on a cable per length and drag width [N/m²], as if it were straight along its chord. Coinciding ends have
    /// no axis; the callers that place cables refuse them.
    pub(crate) fn drag_along_w(&self, chord_w: &Vec3) -> Vec3 {
        self.cross_pressure_w(&chord_w.try_normalize(0.0).unwrap_or_else(Vec3::zeros))
    }

    /// Derivative of [`Self::cross_pressure_w`] with respect to the velocity; 3×3, world axes, symmetric [N s/m³].
    pub(crate) fn cross_pressure_by_velocity_w(&self, axis_w: &Vec3) -> Mat3 {
        let normal = Mat3::identity() - axis_w * axis_w.transpose();
        magnified(&(normal * self.velocity_w)) * normal * (0.5 * self.air_density)
    }

    /// Derivative of [`Self::cross_pressure_w`] with respect to a chord of direction `axis_w` (a unit vector) and
    /// length `chord` [m]; 3×3, world axes, not symmetric [N/m³]. Zero if the wind blows along the chord.
    ///
    /// # References
    /// docs/theory.md, equation (49a).
    fn cross_pressure_by_chord_w(&self, axis_w: &Vec3, chord: f64) -> Mat3 {
        let along = axis_w.dot(&self.velocity_w);
        let across = self.velocity_w - axis_w * along;
        let speed = across.norm();
        if speed == 0.0 {
            return Mat3::zeros();
        }
        let direction = across / speed;
        let turned = Mat3::identity() - axis_w * axis_w.transpose() + direction * direction.transpose();
        (turned * along + axis_w * across.transpose()) * (-0.5 * self.air_density * speed / chord)
    }
}

/// Derivative of `|v| v` with respect to v: `|v| I + v vᵀ/|v|`.
fn magnified(v: &Vec3) -> Mat3 {
    let size = v.norm();
    if size == 0.0 { Mat3::zeros() } else { Mat3::identity() * size + v * v.transpose() / size }
}

impl Default for Wind {
    /// Still air.
    fn default() -> Self {
        Self { velocity_w: Vec3::zeros(), air_density: Self::AIR_DENSITY }
    }
}

/// Load per length of an unstrained cable, uniform along it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineLoad {
    /// Unit vector against the load: the upward direction of this cable.
    pub up_w: Vec3,
    /// Magnitude [N/m].
    pub size: f64,
}

impl LineLoad {
    /// Load as a vector, world axes [N/m].
    pub fn vector_w(&self) -> Vec3 {
        self.up_w * -self.size
    }
}

impl Robot {
    /// Load on cable `i` per unstrained length if its chord, platform to anchor, is `chord_w` [m]: weight, the load
    /// given by the file, and the drag of the wind, which depends on the chord's direction.
    ///
    /// # Example
    /// ```
    /// # use funicular::{math::Vec3, robot::{Robot, Wind}};
    /// # let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
    /// let load = robot.line_load(0, &Vec3::new(5.0, 0.0, 4.0));
    /// assert!((load.size - 0.067 * 9.81).abs() < 1e-15); // N/m
    /// assert_eq!(load.up_w, Vec3::z());
    /// # Ok::<(), funicular::robot::spec::SpecError>(())
    /// ```
    pub fn line_load(&self, i: usize, chord_w: &Vec3) -> LineLoad {
        let cable = &self.cables[i];
        let drag_width =
            if self.wind.velocity_w == Vec3::zeros() { 0.0 } else { cable.material.drag_width.unwrap_or(0.0) };
        let mass = cable.material.mass_per_length;
        if drag_width == 0.0 && cable.load_per_length_w == Vec3::zeros() {
            return LineLoad { up_w: self.up_w(), size: mass * self.gravity_w.norm() };
        }
        let mut total = self.gravity_w * mass + cable.load_per_length_w;
        if drag_width > 0.0 {
            total += self.wind.drag_along_w(chord_w) * drag_width;
        }
        let size = total.norm();
        if size > 0.0 { LineLoad { up_w: -total / size, size } } else { LineLoad { up_w: self.up_w(), size } }
    }

    /// Derivative of the [`Self::line_load`] vector of cable `i` with respect to its chord: the change of drag as the
    /// cable turns in the wind; 3×3, world axes, not symmetric [N/m²]. `None` if the load does not depend on the chord.
    ///
    /// # References
    /// docs/theory.md, equation (49a).
    pub(crate) fn line_load_by_chord(&self, i: usize, chord_w: &Vec3) -> Option<Mat3> {
        let drag_width = self.cables[i].material.drag_width.filter(|width| *width > 0.0)?;
        if self.wind.velocity_w == Vec3::zeros() {
            return None;
        }
        let axis = chord_w.try_normalize(0.0)?;
        Some(self.wind.cross_pressure_by_chord_w(&axis, chord_w.norm()) * drag_width)
    }

    /// True if the load on some cable depends on the direction of its chord.
    pub(crate) fn wind_turns_with_cables(&self) -> bool {
        self.wind.velocity_w != Vec3::zeros()
            && self.cables.iter().any(|cable| cable.material.drag_width.is_some_and(|width| width > 0.0))
    }

    /// Dead force at the platform's centre of mass, weight and wind, world axes [N].
    pub fn force_at_mass_centre_w(&self) -> Vec3 {
        self.gravity_w * self.platform.mass + self.wind.pressure_w() * self.platform.drag_area
    }
}
