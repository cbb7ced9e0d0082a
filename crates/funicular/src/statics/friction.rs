//! Interval in which friction of pulleys leaves pose and tensions: their hysteresis.
//!
//! Friction holds a cable at rest with any tension at the drum between e^−Θ and e^Θ times that without friction. The
//! friction depends on the last motion of every cable, so the equilibrium is one of many. With unstrained lengths held,
//! friction changes the strain behind the exit points, and this moves the platform. With the pose held, friction
//! changes the tensions at the drums and the lengths.

use super::derivatives::{self, load_of};
use super::equilibrium::{CableState, Equilibrium};
use crate::math::{Mat6, Vec3};
use crate::platform::Coordinates;
use crate::robot::{Cable, Robot};
use thiserror::Error;

/// Reason why an equilibrium has no friction interval.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FrictionError {
    /// No pulley of the robot's cables has friction.
    #[error(
        "no cable runs over a pulley with friction: give [pulleys.NAME] a `friction_coefficient`, an `efficiency` or a \
         `bearing_friction_coefficient`"
    )]
    NoFriction,
    /// The robot has flexible supports.
    #[error(
        "the interval of friction is not known for a robot with flexible supports: leave `support` out of the cables for \
         that with rigid anchors"
    )]
    Supports,
    /// Some motion meets no resistance.
    #[error("the equilibrium is indifferent: friction may move the platform without limit")]
    Singular,
}

/// Quantity of the robot that is held while friction varies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Held {
    /// Unstrained lengths: drums under position control.
    Lengths,
    /// Pose and tensions at the platform; the lengths follow.
    Pose,
}

/// Minimum and maximum of a quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Minimum.
    pub min: f64,
    /// Maximum.
    pub max: f64,
}

impl Interval {
    const ZERO: Self = Self { min: 0.0, max: 0.0 };

    /// Interval between two values in either order.
    fn between(one: f64, other: f64) -> Self {
        Self { min: one.min(other), max: one.max(other) }
    }

    /// Interval of a multiple.
    fn times(self, factor: f64) -> Self {
        Self::between(self.min * factor, self.max * factor)
    }

    /// Interval of the sum of two independent quantities.
    fn plus(self, other: Self) -> Self {
        Self { min: self.min + other.min, max: self.max + other.max }
    }

    /// Interval around both.
    fn with(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Interval of a quantity at this distance from a value.
    fn about(self, value: f64) -> Self {
        Self { min: value + self.min, max: value + self.max }
    }

    /// Half of the width.
    pub fn half_width(&self) -> f64 {
        0.5 * (self.max - self.min)
    }
}

/// Interval in which friction leaves an equilibrium.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionInterval {
    /// Motion of the platform from the equilibrium without friction; `None` with the pose held.
    pub motion: Option<MotionInterval>,
    /// The cables, in file order.
    pub cables: Vec<CableFriction>,
}

/// Motion of the platform that friction may cause.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionInterval {
    /// Translation of the platform origin along the world axes [m].
    pub translation_w: [Interval; 3],
    /// Components of the rotation vector along the world axes [rad].
    pub rotation_w: [Interval; 3],
}

/// Tensions of a cable that friction permits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CableFriction {
    /// Friction exponent Θ of the cable's pulley; zero without friction.
    pub exponent: f64,
    /// Change of the unstrained length beyond the exit point, with the free span held [m]. With the pose held the
    /// length of the cable changes by it; with lengths held the free span changes by the opposite.
    pub excess_length: Interval,
    /// Tension at the platform end [N].
    pub tension_platform: Interval,
    /// Tension at the anchor, with a pulley at the exit point [N].
    pub tension_anchor: Interval,
    /// Tension at the drum [N]; without a drive that at the anchor.
    pub tension_drum: Interval,
}

/// Interval in which friction of the pulleys leaves an equilibrium without friction: every state of friction between
/// "last ran towards the platform" and "last ran towards the drum" is possible for every cable on its own.
///
/// The change of the unstrained lengths behind the exit points is that of the profile of the tension. Motion and
/// tensions are of first order in this change. Ideal cables have no strain, so only their tensions at the drum change.
///
/// Left out: the friction of the swivel, of guide wheels behind the entry point and of the winch; for the tensions at
/// the exit points the weight of the cable over the exit point's own motion; for all tensions the turn of the wind's
/// drag.
///
/// # Errors
/// [`FrictionError`].
///
/// # Example
/// ```
/// use funicular::robot::Robot;
/// use funicular::statics::{self, Held, StaticModel};
///
/// let text = funicular_robots::YUAN2014_4MM.replacen(
///     "[[cables]]",
///     "[pulleys.wheel]\nradius_m = 0.05\nentry_direction = [0, 0, 1]\nefficiency = 0.96\n\
///      [winches.drum]\ndrum_side_length_m = 3\n[[cables]]",
///     1,
/// );
/// let text = text.replace("[[cables]]\n", "[[cables]]\npulley = \"wheel\"\nwinch = \"drum\"\n");
/// let robot = Robot::from_toml(&text)?;
/// let lengths = [9.929, 9.628, 9.823, 9.725, 9.867, 9.667];
/// let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
///
/// let found = statics::friction_interval(&robot, &rest, Held::Lengths)?;
/// let height = found.motion.unwrap().translation_w[2];
/// assert!(height.min < 0.0 && height.max > 0.0 && height.half_width() < 1e-3); // m
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, equations (71) to (74).
pub fn friction_interval(
    robot: &Robot,
    equilibrium: &Equilibrium,
    held: Held,
) -> Result<FrictionInterval, FrictionError> {
    if !robot.cables.iter().any(has_friction) {
        return Err(FrictionError::NoFriction);
    }
    if robot.has_supports() {
        return Err(FrictionError::Supports);
    }
    let pairs = robot.cables.iter().zip(&equilibrium.cables);
    let frictions: Vec<Extremes> = pairs.map(|(cable, state)| Extremes::of(cable, state)).collect();

    // The motion due to each cable's friction on its own.
    let motions = match held {
        Held::Lengths => motions_by_length(robot, equilibrium)?,
        Held::Pose => Vec::new(),
    };
    let motion = (held == Held::Lengths).then(|| {
        let component = |row: usize| {
            let terms = motions.iter().zip(&frictions).map(|(motion, own)| own.length_change().times(motion[row]));
            terms.fold(Interval::ZERO, Interval::plus)
        };
        MotionInterval {
            translation_w: std::array::from_fn(component),
            rotation_w: std::array::from_fn(|axis| component(3 + axis)),
        }
    });

    let cables = equilibrium.cables.iter().enumerate().map(|(i, state)| {
        let axial_stiffness = robot.cables[i].material.axial_stiffness;
        let mut gains = vec![TensionGain::default(); motions.len()];
        for (l, gain) in gains.iter_mut().enumerate() {
            *gain = TensionGain::of(state, axial_stiffness, &motions[l], i == l);
        }
        frictions[i].tensions(i, state, &gains, &frictions)
    });
    Ok(FrictionInterval { motion, cables: cables.collect() })
}

/// Friction exponent Θ of every cable, in file order: friction changes the tension at its drum by a factor of up to
/// e^Θ. Zero for a cable without friction.
///
/// # References
/// docs/theory.md, equation (71).
pub fn friction_exponents(robot: &Robot, equilibrium: &Equilibrium) -> Vec<f64> {
    robot.cables.iter().zip(&equilibrium.cables).map(|(cable, state)| exponent(cable, state)).collect()
}

/// Friction exponent Θ of a cable at its state.
fn exponent(cable: &Cable, state: &CableState) -> f64 {
    let anchor = &cable.anchor;
    if let Some(drive) = &state.drive {
        return drive.friction_exponent(anchor);
    }
    // Ideal cables are straight.
    let friction = anchor.pulley.as_ref().and_then(|pulley| pulley.friction);
    let contact = anchor.contact(&state.attachment_w);
    friction.zip(contact).map_or(0.0, |(friction, contact)| friction.exponent(contact.radius, contact.wrap))
}

/// True if the cable runs over a pulley with friction.
fn has_friction(cable: &Cable) -> bool {
    cable.anchor.pulley.as_ref().is_some_and(|pulley| pulley.friction.is_some())
}

/// Motion of the platform per unstrained length of each cable: translation [m/m] and rotation vector [rad/m], world
/// axes. Zero for ideal cables, which have no strain.
fn motions_by_length(robot: &Robot, equilibrium: &Equilibrium) -> Result<Vec<[f64; 6]>, FrictionError> {
    let Some(jacobian) = derivatives::balance_jacobian(robot, equilibrium) else {
        return Ok(vec![[0.0; 6]; robot.cables.len()]);
    };
    let coordinates = Coordinates::of(robot);
    let reduced: Mat6 = coordinates.reduce_matrix(&jacobian);

    let motion = |state: &CableState| {
        let force_w = state.force_by_length_w().unwrap_or_else(Vec3::zeros);
        let wrench = crate::platform::wrench_of(&force_w, &state.lever_w);
        let found = derivatives::solve(&reduced, &coordinates, &wrench).map_err(|_| FrictionError::Singular)?;
        let scaled = coordinates.expand(&found);
        Ok(std::array::from_fn(|row| if row < 3 { scaled[row] } else { scaled[row] / coordinates.ell() }))
    };
    equilibrium.cables.iter().map(motion).collect()
}

/// Extremes of the friction of one cable.
struct Extremes {
    exponent: f64,
    /// Unstrained length beyond the exit point less that without friction [m], after motion towards the platform and
    /// after motion towards the drum.
    excess_lengths: [f64; 2],
}

impl Extremes {
    fn of(cable: &Cable, state: &CableState) -> Self {
        let exponent = exponent(cable, state);
        let excess_lengths = match (&state.hanging, &state.drive) {
            (Some(span), Some(drive)) => {
                [1.0, -1.0].map(|used| drive.with_friction(span, &cable.anchor, used).excess_length)
            }
            // Ideal cables have no strain.
            _ => [0.0; 2],
        };
        Self { exponent, excess_lengths }
    }

    /// Change of the unstrained length beyond the exit point [m].
    fn excess_length(&self) -> Interval {
        Interval::between(self.excess_lengths[0], self.excess_lengths[1])
    }

    /// Change of the cable's length that has the effect of the friction, in a cable without friction [m].
    fn length_change(&self) -> Interval {
        self.excess_length().times(-1.0)
    }

    /// Tensions of cable `i` at its state, by the gains of its tensions with respect to the lengths of all cables; no
    /// gains with the pose held.
    fn tensions(&self, i: usize, state: &CableState, gains: &[TensionGain], all: &[Self]) -> CableFriction {
        let sum = |gain: fn(&TensionGain) -> f64, skipped: Option<usize>| {
            let kept = gains.iter().zip(all).enumerate().filter(|(l, _)| Some(*l) != skipped);
            let terms = kept.map(|(_, (of, other))| other.length_change().times(gain(of)));
            terms.fold(Interval::ZERO, Interval::plus)
        };

        // The friction of the cable's own pulley acts on the tension at the drum twice, by the length and directly.
        let others = sum(|gain| gain.drum, Some(i));
        let own_gain = gains.get(i).map_or(0.0, |gain| gain.drum);
        let frictionless = state.tension_drum();
        let [towards_platform, towards_drum] = self.excess_lengths;
        let after = |excess_length: f64, exponent: f64| {
            others.about(frictionless - own_gain * excess_length).times(exponent.exp())
        };

        CableFriction {
            exponent: self.exponent,
            excess_length: self.excess_length(),
            tension_platform: sum(|gain| gain.platform, None).about(state.tension_platform),
            tension_anchor: sum(|gain| gain.anchor, None).about(state.tension_anchor),
            tension_drum: after(towards_platform, -self.exponent).with(after(towards_drum, self.exponent)),
        }
    }
}

/// Change of a cable's tensions per unstrained length of a cable, with all other lengths held [N/m].
#[derive(Debug, Clone, Copy, Default)]
struct TensionGain {
    platform: f64,
    anchor: f64,
    drum: f64,
}

impl TensionGain {
    /// Gain for a motion per length; `is_own` if the length is that of the cable itself.
    fn of(state: &CableState, axial_stiffness: f64, motion: &[f64; 6], is_own: bool) -> Self {
        // A slack cable without weight stays without tension.
        let (Some(stiffness), Some(by_length_w)) = (state.tangent_w(), state.force_by_length_w()) else {
            return Self::default();
        };
        let Some(along_w) = state.force_on_platform_w.try_normalize(0.0) else { return Self::default() };

        let [x, y, z, roll, pitch, yaw] = *motion;
        let attachment_w = Vec3::new(x, y, z) + Vec3::new(roll, pitch, yaw).cross(&state.lever_w);
        let direct_w = if is_own { by_length_w } else { Vec3::zeros() };
        let platform = along_w.dot(&(direct_w - stiffness * attachment_w));

        // ψ(T) + q·p is the same all along the cable, and λ = dψ/dT. The ends at the frame stay in place.
        let stretch = |tension: f64| 1.0 + tension / axial_stiffness;
        let potential = stretch(state.tension_platform) * platform + load_of(state).dot(&attachment_w);
        Self {
            platform,
            anchor: potential / stretch(state.tension_anchor),
            drum: potential / stretch(state.tension_drum()),
        }
    }
}
