//! Friction of a cable on a pulley.
//!
//! Friction changes the tension over the pulley by a factor between e^−Θ and e^Θ. The friction exponent Θ depends on
//! the kind of the friction (docs/theory.md, equation (71)).

/// Friction of a pulley.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PulleyFriction {
    /// The cable slides in the groove of a wheel that does not turn, or over a fixed bar. Θ = μβ, β being the wrap
    /// angle.
    Sliding {
        /// Coefficient μ of friction between cable and groove, not negative.
        coefficient: f64,
    },
    /// The wheel turns with the cable and has the efficiency η of a catalogue: the ratio of the tension on the pulled
    /// side to that on the pulling side, in (0, 1]. Θ = −ln η.
    Efficiency(f64),
    /// The wheel turns with the cable, and its bearing has friction. `Θ = 2 μ_b (r_b/r) sin(β/2)`.
    Bearing {
        /// Coefficient `μ_b` of friction in the bearing, not negative.
        coefficient: f64,
        /// Radius `r_b` at which the friction acts [m], positive and below the radius of the wheel.
        radius: f64,
    },
}

impl PulleyFriction {
    /// Friction exponent Θ of a wheel with this radius [m] that the cable touches over the wrap angle [rad]: the
    /// tension at the drum is at most e^Θ times, and at least e^−Θ times that without friction.
    ///
    /// # Example
    /// ```
    /// use funicular::robot::PulleyFriction;
    ///
    /// let bar = PulleyFriction::Sliding { coefficient: 0.15 };
    /// let half_a_turn = std::f64::consts::PI;
    /// assert!((bar.exponent(0.01, half_a_turn) - 0.15 * half_a_turn).abs() < 1e-15);
    /// ```
    ///
    /// # References
    /// docs/theory.md, equation (71).
    pub fn exponent(&self, wheel_radius: f64, wrap: f64) -> f64 {
        match *self {
            Self::Sliding { coefficient } => coefficient * wrap,
            Self::Efficiency(efficiency) => -efficiency.ln(),
            Self::Bearing { coefficient, radius } => 2.0 * coefficient * radius / wheel_radius * (0.5 * wrap).sin(),
        }
    }

    /// Friction exponent between the exit point and the point of the rim at the angle θ [rad] from the entry point.
    ///
    /// A cable that slides changes its tension all along the arc. On a wheel that turns it sticks to the groove and
    /// changes its tension near the point at which it leaves the wheel. Then the whole arc has the tension of one of
    /// the two sides; the result is that of the drum side, which differs the more from the tension without friction.
    pub(crate) fn exponent_from_exit(&self, wheel_radius: f64, wrap: f64, angle: f64) -> f64 {
        match *self {
            Self::Sliding { coefficient } => coefficient * (wrap - angle),
            Self::Efficiency(_) | Self::Bearing { .. } => self.exponent(wheel_radius, wrap),
        }
    }
}
