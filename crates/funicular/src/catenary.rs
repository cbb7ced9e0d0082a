//! Elastic catenary: one uniform cable that hangs and stretches between two points, in its own plane.
//!
//! Irvine's two equations (theory, section 2) contain two unknowns, H and V. They reduce to one equation in one
//! unknown. With the weight `W = w L0`, the sum of the two end tensions `S` and `v = atanh(W/S)`, the identity `asinh b
//! − asinh a = 2 atanh((b − a)/(√(1+a²) + √(1+b²)))` turns them into
//!
//! ```text
//! H = w x / (2 (v + k)),   V_m = w z / (2 (tanh v + k)),   k = w L0 / (2 EA)
//! F(v) = (x sinh v/(v + k))² + (z tanh v/(tanh v + k))² − L0² = 0
//! ```
//!
//! V_m is the mean of the two vertical end forces. F grows strictly with v, so there is exactly one solution. v runs
//! from 0 (taut) to ∞ (a loop that hangs straight down), and no term cancels on the way. So one method covers every
//! tautness, sag and inclination, vertical cables included. Derivation: docs/theory.md, equations (6) to (10).

mod load;
mod parallel;
mod root;
pub mod space;

use root::{Hyperbolic, root};
use thiserror::Error;

/// Invalid input of [`Catenary::between`].
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum CatenaryError {
    /// Invalid value of a quantity.
    #[error("{quantity} is {value}: it must be {must}")]
    Input {
        /// Name of the quantity, with its unit.
        quantity: &'static str,
        /// Given value.
        value: f64,
        /// Allowed values.
        must: &'static str,
    },
}

/// Properties of one cable's rope in the catenary equations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rope {
    /// Unstrained length L0 [m].
    pub unstrained_length: f64,
    /// Weight per unstrained length w [N/m]; zero for a massless cable, which is straight and carries no force when
    /// slack.
    pub weight_per_length: f64,
    /// Axial stiffness EA [N].
    pub axial_stiffness: f64,
}

/// Elastic catenary in equilibrium, from its start (arc length 0) to its end (arc length L0).
///
/// x is horizontal from start to end, z is up. Forces are those that hold the cable at its **end**; the same horizontal
/// force acts at the start in the opposite direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Catenary {
    rope: Rope,
    span: f64,
    rise: f64,
    horizontal: f64,
    vertical_mean: f64,
    slope: Slope,
}

/// Quantities of the solved equation that the tangent and the length derivatives share.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Slope {
    /// General case: weight and tension.
    Curved { v: f64, tanh_v: f64, sech2_v: f64, sinh_v: f64, v_cosh_minus_sinh: f64 },
    /// Both ends on one vertical line and the cable longer than needed: a loop without horizontal force.
    Loop,
    /// Massless and taut: a straight spring.
    Straight,
    /// Massless and longer than its chord: no force.
    Slack,
}

/// Weight over tension up to which the direction of a cable counts as constant in its integrals: the error is a twelfth
/// of its square.
const STRAIGHT_WEIGHT: f64 = 1e-8;

impl Catenary {
    /// Cable that hangs from the origin to `(span, rise)` [m].
    ///
    /// Takes about 0.2 µs. `span` must not be negative; `rise` may have either sign.
    ///
    /// # Errors
    /// [`CatenaryError::Input`] for a value that is not finite or not in its range. Every other input has a solution.
    ///
    /// # Example
    /// ```
    /// use funicular::catenary::{Catenary, Rope};
    /// let rope = Rope { unstrained_length: 105.0, weight_per_length: 10.0, axial_stiffness: 1e7 };
    /// let cable = Catenary::between(100.0, 0.0, rope)?;
    /// assert!((cable.horizontal_force() / 918.634_473_646_241_4 - 1.0).abs() < 1e-13);
    /// assert!((cable.vertical_force_at_end() - 525.0).abs() < 1e-10);
    /// # Ok::<(), funicular::catenary::CatenaryError>(())
    /// ```
    ///
    /// # References
    /// H. M. Irvine, Cable Structures, MIT Press 1981, section 1.2.
    pub fn between(span: f64, rise: f64, rope: Rope) -> Result<Self, CatenaryError> {
        let check = |ok: bool, quantity, value, must| {
            if ok { Ok(()) } else { Err(CatenaryError::Input { quantity, value, must }) }
        };
        check(span >= 0.0 && span.is_finite(), "span [m]", span, "finite and not negative")?;
        check(rise.is_finite(), "rise [m]", rise, "finite")?;
        let Rope { unstrained_length, weight_per_length, axial_stiffness } = rope;
        let positive = |value: f64| value > 0.0 && value.is_finite();
        check(positive(unstrained_length), "unstrained length [m]", unstrained_length, "finite and positive")?;
        check(
            weight_per_length >= 0.0 && weight_per_length.is_finite(),
            "weight per length [N/m]",
            weight_per_length,
            "finite and not negative",
        )?;
        check(positive(axial_stiffness), "axial stiffness [N]", axial_stiffness, "finite and positive")?;
        Ok(Self::solve(span, rise, rope))
    }

    /// Cable of [`Catenary::between`], without checks: for numbers that a [`crate::robot::Robot`] has already checked.
    #[inline]
    pub(crate) fn solve(span: f64, rise: f64, rope: Rope) -> Self {
        let Rope { unstrained_length: length, weight_per_length: w, axial_stiffness: ea } = rope;
        if w == 0.0 {
            return Self::straight(span, rise, rope);
        }

        let k = w * length / (2.0 * ea);
        let (x, z) = (span / length, rise / length);
        // With a span this far below the length the cable is vertical to every digit; squares of smaller spans
        // underflow.
        const VERTICAL: f64 = 1e-140;
        if x < VERTICAL && z.abs() <= 1.0 + k {
            let vertical_mean = w * rise / (2.0 * (1.0 + k));
            return Self { rope, span, rise, horizontal: 0.0, vertical_mean, slope: Slope::Loop };
        }

        let root = root(if x < VERTICAL { 0.0 } else { x }, z, k);
        let Hyperbolic { sinh, cosh, v_cosh_minus_sinh, .. } = root.hyperbolic;
        let tanh_v = sinh / cosh;
        Self {
            rope,
            span,
            rise,
            horizontal: w * span / (2.0 * (root.v + k)),
            vertical_mean: w * rise / (2.0 * (tanh_v + k)),
            slope: Slope::Curved { v: root.v, tanh_v, sech2_v: 1.0 / (cosh * cosh), sinh_v: sinh, v_cosh_minus_sinh },
        }
    }

    fn straight(span: f64, rise: f64, rope: Rope) -> Self {
        let chord = span.hypot(rise);
        let tension = rope.axial_stiffness * (chord / rope.unstrained_length - 1.0);
        if tension > 0.0 {
            let (horizontal, vertical_mean) = (tension * span / chord, tension * rise / chord);
            Self { rope, span, rise, horizontal, vertical_mean, slope: Slope::Straight }
        } else {
            Self { rope, span, rise, horizontal: 0.0, vertical_mean: 0.0, slope: Slope::Slack }
        }
    }

    /// Rope of the cable, with its unstrained length.
    #[inline]
    pub fn rope(&self) -> Rope {
        self.rope
    }

    /// Horizontal distance from start to end [m].
    #[inline]
    pub fn span(&self) -> f64 {
        self.span
    }

    /// Vertical distance from start to end [m], up positive.
    #[inline]
    pub fn rise(&self) -> f64 {
        self.rise
    }

    /// Cosine and sine of the chord's inclination.
    pub(crate) fn chord_direction(&self) -> [f64; 2] {
        let chord = hypot(self.span, self.rise);
        [self.span / chord, self.rise / chord]
    }

    /// Horizontal force H along the whole cable [N].
    #[inline]
    pub fn horizontal_force(&self) -> f64 {
        self.horizontal
    }

    /// Vertical force V_B that holds the end [N], up positive.
    #[inline]
    pub fn vertical_force_at_end(&self) -> f64 {
        self.vertical_mean + 0.5 * self.weight()
    }

    /// Vertical component V_A of the internal force at the start [N], positive up along increasing arc length; the
    /// force that holds the start is (−H, −V_A).
    #[inline]
    pub fn vertical_force_at_start(&self) -> f64 {
        self.vertical_mean - 0.5 * self.weight()
    }

    /// Tension at the start [N].
    #[inline]
    pub fn tension_at_start(&self) -> f64 {
        hypot(self.horizontal, self.vertical_force_at_start())
    }

    /// Tension at the end [N].
    #[inline]
    pub fn tension_at_end(&self) -> f64 {
        hypot(self.horizontal, self.vertical_force_at_end())
    }

    /// Tension [N] at arc length `s` [m] of the unstrained cable from the start.
    pub fn tension_at(&self, s: f64) -> f64 {
        hypot(self.horizontal, self.vertical_force_at_start() + self.rope.weight_per_length * s)
    }

    /// Weight w L0 [N].
    #[inline]
    pub fn weight(&self) -> f64 {
        self.rope.weight_per_length * self.rope.unstrained_length
    }

    /// Position (x, z) [m] of the point at unstrained arc length `s` [m] from the start.
    ///
    /// A massless slack cable has no defined shape; its points are placed on the chord.
    pub fn point_at(&self, s: f64) -> [f64; 2] {
        let h = self.horizontal;
        let va = self.vertical_force_at_start();
        let v = va + self.rope.weight_per_length * s;
        let (ta, t) = (hypot(h, va), hypot(h, v));
        let sum = ta + t;
        let compliance = 1.0 / self.rope.axial_stiffness;

        match self.slope {
            Slope::Slack => {
                let part = s / self.rope.unstrained_length;
                return [self.span * part, self.rise * part];
            }
            _ if sum == 0.0 => return [0.0, 0.0],
            _ => {}
        }

        let part_weight = self.rope.weight_per_length * s;
        let u = part_weight / sum;
        let x = if h == 0.0 {
            0.0
        } else if u < 0.1 {
            h * s * (compliance + 2.0 / sum * atanh_over(u))
        } else {
            // 2 atanh u = ln((sum + ws)/(sum − ws)), and sum − ws = (T_A + V_A) + (T − V) without cancellation.
            let less = plus_stable(h, ta, va) + plus_stable(h, t, -v);
            h * (s * compliance + ((sum + part_weight) / less).ln() / self.rope.weight_per_length)
        };
        [x, s * (va + v) * (0.5 * compliance + 1.0 / sum)]
    }

    /// Stiffness of the end with the start held: `[[∂H/∂x, ∂H/∂z], [∂V/∂x, ∂V/∂z]]` [N/m], symmetric. The stiffness of
    /// the start with the end held is the same matrix.
    pub fn tangent(&self) -> [[f64; 2]; 2] {
        let Rope { unstrained_length: length, weight_per_length: w, axial_stiffness: ea } = self.rope;
        let (x, z) = (self.span, self.rise);

        match self.slope {
            Slope::Slack => [[0.0; 2]; 2],
            Slope::Straight => {
                let chord = hypot(x, z);
                let (cos, sin) = (x / chord, z / chord);
                let along = ea / length;
                let across = hypot(self.horizontal, self.vertical_mean) / chord;
                let mixed = (along - across) * cos * sin;
                [[along * cos * cos + across * sin * sin, mixed], [mixed, along * sin * sin + across * cos * cos]]
            }
            Slope::Loop => [[0.0, 0.0], [0.0, w / (2.0 * (1.0 + self.half_strain_of_weight()))]],
            Slope::Curved { v, tanh_v, sech2_v, .. } => {
                let k = self.half_strain_of_weight();
                let (by_x, by_z, ..) = self.parameter_derivatives();
                let (across, along) = (v + k, tanh_v + k);
                let mixed = -w * x / (2.0 * across * across) * by_z;
                [
                    [w / (2.0 * across) * (1.0 - x * by_x / across), mixed],
                    [mixed, w / (2.0 * along) * (1.0 - z * sech2_v * by_z / along)],
                ]
            }
        }
    }

    /// Stiffness against motion out of the cable's plane [N/m], exactly H/x.
    pub fn out_of_plane_stiffness(&self) -> f64 {
        let w = self.rope.weight_per_length;
        match self.slope {
            Slope::Slack | Slope::Loop => 0.0,
            Slope::Straight => hypot(self.horizontal, self.vertical_mean) / hypot(self.span, self.rise),
            Slope::Curved { v, .. } => w / (2.0 * (v + self.half_strain_of_weight())),
        }
    }

    /// Integrals ∫ t tᵀ ds of the direction t along the unstrained length [m], in (horizontal, up); not finite where a
    /// point has no tension.
    ///
    /// # References
    /// docs/theory.md, equation (27f).
    pub fn direction_integrals(&self) -> [[f64; 2]; 2] {
        let Rope { unstrained_length: length, weight_per_length: w, .. } = self.rope;
        let (h, start, end) = (self.horizontal, self.vertical_force_at_start(), self.vertical_force_at_end());
        let (first, weight) = (hypot(h, start), w * length);

        // With the weight going to zero both quotients keep their digits: ∫ H²/T² ds and ∫ H V/T² ds.
        let [level, mixed] = if weight.abs() <= STRAIGHT_WEIGHT * first {
            let mean = 0.5 * (start + end);
            let square = h * h + mean * mean;
            [length * h * h / square, length * h * mean / square]
        } else {
            let turned = (h * weight).atan2(h * h + start * end);
            let grown = 0.5 * (weight * (start + end) / (first * first)).ln_1p();
            [h / w * turned, h / w * grown]
        };
        [[level, mixed], [mixed, length - level]]
    }

    /// Parallel tension τ = H/cos α, α being the chord's inclination [N]: the tension parallel to the chord, also for a
    /// vertical cable (for which H and cos α both vanish). It falls to zero as the cable gets longer.
    #[inline]
    pub fn parallel_tension(&self) -> f64 {
        self.out_of_plane_stiffness() * hypot(self.span, self.rise)
    }

    /// Minimum ratio of parallel tension to weight (w times chord) above which both end tensions grow with it at any
    /// slope. A level cable that sags further (its minimum end tension is at v = 1.1997) gets heavier at its ends, not
    /// lighter.
    pub(crate) const MIN_TENSION_TO_WEIGHT: f64 = 1.0 / 2.4;

    /// Minimum tension anywhere in the cable [N]: at its lowest point if that is between the ends, else at the lower
    /// end.
    pub fn min_tension(&self) -> f64 {
        if self.vertical_force_at_start() < 0.0 && self.vertical_force_at_end() > 0.0 {
            self.horizontal
        } else {
            self.tension_at_start().min(self.tension_at_end())
        }
    }

    /// Maximum tension anywhere in the cable [N]: at the upper end.
    pub fn max_tension(&self) -> f64 {
        self.tension_at_start().max(self.tension_at_end())
    }

    /// Derivative of [`Self::parallel_tension`] with respect to the unstrained length [N/m].
    pub fn parallel_tension_by_length(&self) -> f64 {
        let Rope { unstrained_length: length, weight_per_length: w, axial_stiffness: ea } = self.rope;
        let chord = hypot(self.span, self.rise);
        match self.slope {
            Slope::Slack | Slope::Loop => 0.0,
            Slope::Straight => -ea * chord / (length * length),
            Slope::Curved { v, .. } => {
                let across = v + self.half_strain_of_weight();
                let (_, _, by_length, _) = self.parameter_derivatives();
                -chord * w / (2.0 * across * across) * (by_length + w / (2.0 * ea))
            }
        }
    }

    /// Derivative of `(H, V_A)`, minus the force that holds the **start**, with respect to the unstrained length [N/m].
    pub fn start_force_by_length(&self) -> [f64; 2] {
        let Rope { unstrained_length: length, weight_per_length: w, axial_stiffness: ea } = self.rope;
        match self.slope {
            Slope::Slack => [0.0; 2],
            Slope::Straight => {
                let chord = hypot(self.span, self.rise);
                let rate = -ea * chord / (length * length);
                [rate * self.span / chord, rate * self.rise / chord]
            }
            Slope::Loop => {
                let k = self.half_strain_of_weight();
                [0.0, -self.vertical_mean / (1.0 + k) * w / (2.0 * ea) - 0.5 * w]
            }
            Slope::Curved { v, tanh_v, sech2_v, .. } => {
                let k = self.half_strain_of_weight();
                let k_by_length = w / (2.0 * ea);
                let (_, _, by_length, _) = self.parameter_derivatives();
                [
                    -self.horizontal / (v + k) * (by_length + k_by_length),
                    -self.vertical_mean / (tanh_v + k) * (sech2_v * by_length + k_by_length) - 0.5 * w,
                ]
            }
        }
    }

    /// Potential energy [J] of stretch and weight, with the start at height zero: its gradient with respect to the end
    /// is (H, V_B).
    pub fn energy(&self) -> f64 {
        let Rope { unstrained_length: length, weight_per_length: w, axial_stiffness: ea } = self.rope;
        let (h, vm) = (self.horizontal, self.vertical_mean);
        let sum = self.tension_at_start() + self.tension_at_end();
        // Legendre transform of the complementary energy ∫ T + T²/(2EA) ds.
        let (tension_integral, weight) = match self.slope {
            Slope::Slack => return 0.0,
            Slope::Straight => return 0.5 * length / ea * (h * h + vm * vm),
            Slope::Loop => (0.5 * length * (2.0 * vm * vm / sum + 0.5 * sum), self.weight()),
            Slope::Curved { v, .. } => {
                let weight = self.weight();
                (0.5 * length * (2.0 * vm * vm / sum + 0.5 * sum + 2.0 * h * h * v / weight), weight)
            }
        };
        let square_integral = length * (h * h + vm * vm + weight * weight / 12.0);
        let vertical_end = vm + 0.5 * w * length;
        h * self.span + vertical_end * self.rise - tension_integral - square_integral / (2.0 * ea)
    }

    /// `k = w L0/(2 EA)`: the strain at mid-length of a cable that hangs freely from one end.
    #[inline]
    fn half_strain_of_weight(&self) -> f64 {
        self.weight() / (2.0 * self.rope.axial_stiffness)
    }

    /// Derivatives (∂v/∂x, ∂v/∂z, ∂v/∂L0) [1/m] from F(v; x, z, L0) = 0, and ∂v/∂k with x, z and L0 held.
    fn parameter_derivatives(&self) -> (f64, f64, f64, f64) {
        let Slope::Curved { v, tanh_v, sech2_v, sinh_v, v_cosh_minus_sinh } = self.slope else {
            return (0.0, 0.0, 0.0, 0.0);
        };
        let (x, z, length) = (self.span, self.rise, self.rope.unstrained_length);
        let k = self.half_strain_of_weight();
        let (across, along) = (v + k, tanh_v + k);
        let (a, b) = (sinh_v / across, tanh_v / along);
        let cosh_v = sinh_v / tanh_v;
        let a_by_v = (k * cosh_v + v_cosh_minus_sinh) / (across * across);
        let b_by_v = k * sech2_v / (along * along);
        let half_slope = x * x * a * a_by_v + z * z * b * b_by_v;
        let k_by_length = self.rope.weight_per_length / (2.0 * self.rope.axial_stiffness);
        let (xa, zb) = (x * a, z * b);
        let slope_by_k = xa * xa / across + zb * zb / along;
        let by_length = (length + slope_by_k * k_by_length) / half_slope;
        (-x * a * a / half_slope, -z * b * b / half_slope, by_length, slope_by_k / half_slope)
    }
}

/// Root √(a² + b²). Lengths and forces of cables are far from overflow, so libm's careful `hypot` is not needed.
#[inline]
fn hypot(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
}

/// Sum T + V without cancellation, T = √(H² + V²).
#[inline]
fn plus_stable(h: f64, t: f64, v: f64) -> f64 {
    if v >= 0.0 { t + v } else { h * h / (t - v) }
}

/// Quotient atanh(u)/u for 0 ≤ u < 0.1; the first omitted term is u¹⁶/17 < 1e-17.
#[inline]
fn atanh_over(u: f64) -> f64 {
    let u2 = u * u;
    (0..8).rev().fold(0.0, |sum, n| sum * u2 + 1.0 / f64::from(2 * n + 1))
}
