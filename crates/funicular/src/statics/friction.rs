//! Interval in which friction of pulleys leaves pose and tensions: their hysteresis.
//!
//! Friction holds a cable at rest with any tension at the drum between e^−Θ and e^Θ times that without friction. The
//! friction depends on the last motion of every cable, so the equilibrium is one of many. With unstrained lengths held,
//! friction changes the strain behind the exit points, and this moves the platform. With the pose held, friction
//! changes the tensions at the drums and the lengths.

use super::derivatives::{self, load_of};
use super::equilibrium::{CableState, Equilibrium};
use super::supports;
use crate::catenary::space::HangingCable;
use crate::math::{Mat3, Mat6, Vec3, Vec6};
use crate::platform::{Coordinates, wrench_columns};
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
    /// The pose is held, and the support of a cable with friction yields to its drum on the ground.
    #[error(
        "friction on the pulley of cable \"{cable}\" changes the pull of its drum on the ground, and with it the place \
         of its flexible support: pose and tensions cannot both be held; give unstrained lengths, or set `drums = \
         \"on-support\"`"
    )]
    Supports {
        /// Name of the cable.
        cable: String,
    },
    /// A rope runs over sheaves.
    #[error(
        "the rope of cable \"{cable}\" runs over sheaves: the friction interval knows pulleys of cables of their own \
         alone; leave out `shares_rope_with`"
    )]
    RopeOverSheaves {
        /// Name of the first cable of the rope.
        cable: String,
    },
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

    /// Interval shifted by `value`.
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
/// Flexible supports yield to the changed forces, those of drum sides from the ground included.
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
/// docs/theory.md, equations (71) to (74) and (91a).
pub fn friction_interval(
    robot: &Robot,
    equilibrium: &Equilibrium,
    held: Held,
) -> Result<FrictionInterval, FrictionError> {
    if !robot.cables.iter().any(has_friction) {
        return Err(FrictionError::NoFriction);
    }
    if let Some(rope) = robot.ropes.first() {
        return Err(FrictionError::RopeOverSheaves { cable: robot.cables[rope.cables[0]].name.clone() });
    }
    // Supports have changed the lengths of drum sides from the ground.
    let settled = equilibrium.settled(robot);
    let pairs = settled.cables.iter().zip(&equilibrium.cables);
    let frictions: Vec<Extremes> = pairs.map(|(cable, state)| Extremes::of(cable, state)).collect();

    // The motion due to each cable's friction on its own.
    let motions = match held {
        Held::Lengths => motions_by_friction(robot, equilibrium)?,
        Held::Pose => {
            refuse_pulled_supports(robot, &frictions)?;
            Vec::new()
        }
    };
    let motion = (held == Held::Lengths).then(|| {
        let component = |row: usize| {
            let gains = |[by_length, by_pull]: &[Motion; 2]| [by_length.platform[row], by_pull.platform[row]];
            let terms = motions.iter().zip(&frictions).map(|(motion, own)| own.effect(gains(motion)));
            terms.fold(Interval::ZERO, Interval::plus)
        };
        MotionInterval {
            translation_w: std::array::from_fn(component),
            rotation_w: std::array::from_fn(|axis| component(3 + axis)),
        }
    });

    let cables = equilibrium.cables.iter().enumerate().map(|(i, state)| {
        let mut gains = vec![[TensionGain::default(); 2]; motions.len()];
        for (l, ([by_length, by_pull], gain)) in motions.iter().zip(&mut gains).enumerate() {
            let of = |motion: &Motion, is_own: bool| TensionGain::of((robot, i), state, motion, is_own);
            *gain = [of(by_length, i == l), of(by_pull, false)];
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
    let settled = equilibrium.settled(robot);
    settled.cables.iter().zip(&equilibrium.cables).map(|(cable, state)| exponent(cable, state)).collect()
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

/// Refuses a pose that is held while friction moves supports by the pull of drums on the ground.
fn refuse_pulled_supports(robot: &Robot, frictions: &[Extremes]) -> Result<(), FrictionError> {
    let is_pulled = |(cable, friction): &(&Cable, &Extremes)| {
        let support = cable.anchor.support.map(|support| &robot.supports[support]);
        friction.exponent > 0.0 && support.is_some_and(|support| support.drum_side_from_ground(&cable.anchor).is_some())
    };
    match robot.cables.iter().zip(frictions).find(is_pulled) {
        Some((cable, _)) => Err(FrictionError::Supports { cable: cable.name.clone() }),
        None => Ok(()),
    }
}

/// Motion of the robot by one effect of friction, per unit of it.
#[derive(Debug, Clone, Default)]
struct Motion {
    /// Translation and rotation vector of the platform, world axes [m, rad].
    platform: [f64; 6],
    /// Displacement of each support, world axes [m].
    supports: Vec<Vec3>,
}

/// Motion by the friction of each cable: per unstrained length of the cable [m/m], and per force with which its drum on
/// the ground pulls less at its support [m/N]. Zero for ideal cables, which have no strain.
fn motions_by_friction(robot: &Robot, equilibrium: &Equilibrium) -> Result<Vec<[Motion; 2]>, FrictionError> {
    let still = || Motion { platform: [0.0; 6], supports: vec![Vec3::zeros(); robot.supports.len()] };
    let Some(jacobian) = derivatives::balance_jacobian(robot, equilibrium) else {
        return Ok(equilibrium.cables.iter().map(|_| [still(), still()]).collect());
    };
    let coordinates = Coordinates::of(robot);
    let reduced: Mat6 = coordinates.reduce_matrix(&jacobian);
    let yielding = Yielding::of(robot, equilibrium);

    let moved = |direct: Vec6, on_support: Option<(usize, Vec3)>| {
        // Forces on the supports, which the platform feels as they yield.
        let forces_w = yielding.forces(on_support);
        let wrench = direct + yielding.wrench(&forces_w);
        let found = derivatives::solve(&reduced, &coordinates, &wrench).map_err(|_| FrictionError::Singular)?;
        let scaled = coordinates.expand(&found);
        let platform = std::array::from_fn(|row| if row < 3 { scaled[row] } else { scaled[row] / coordinates.ell() });
        Ok(Motion { platform, supports: yielding.displacements(&forces_w, &platform) })
    };
    let of_cable = |(i, state): (usize, &CableState)| {
        let force_w = state.force_by_length_w().unwrap_or_else(Vec3::zeros);
        let wrench = crate::platform::wrench_of(&force_w, &state.lever_w);
        let Some(support) = robot.cables[i].anchor.support else { return Ok([moved(wrench, None)?, still()]) };

        // The additional length lies behind the wheel: its weight stays with the support.
        let side = supports::pull_by_length(robot, i, state);
        let pulled_w = side.map_or_else(Vec3::zeros, |(along_w, by_length)| along_w * by_length);
        let by_length = moved(wrench, Some((support, -force_w - pulled_w)))?;
        let by_pull =
            side.map_or_else(|| Ok(still()), |(along_w, _)| moved(Vec6::zeros(), Some((support, along_w))))?;
        Ok([by_length, by_pull])
    };
    equilibrium.cables.iter().enumerate().map(of_cable).collect()
}

/// Supports that yield to small forces at an equilibrium.
struct Yielding {
    /// Displacement per force, of each support [m/N].
    compliances: Vec<Mat3>,
    /// Wrench on the platform per displacement of each support, by columns.
    columns: Vec<[Vec6; 3]>,
}

impl Yielding {
    fn of(robot: &Robot, equilibrium: &Equilibrium) -> Self {
        let count = robot.supports.len();
        let mut own: Vec<Mat3> = robot.supports.iter().map(|support| support.stiffness_w).collect();
        let mut columns = vec![[Vec6::zeros(); 3]; count];
        for (i, state) in equilibrium.cables.iter().enumerate() {
            let held = state.hanging.as_ref().map_or_else(Mat3::zeros, HangingCable::tangent_w);
            let carried = robot.cables[i].anchor.support.zip(supports::on_support(robot, i, state, &held));
            let Some((support, cable)) = carried else { continue };
            own[support] += cable.stiffness_w;
            for (column, add) in columns[support].iter_mut().zip(wrench_columns(&cable.force_w, &state.lever_w)) {
                *column += add;
            }
        }
        // An equilibrium has no support that its cables make unstable.
        let compliances = own.iter().map(|own| own.try_inverse().unwrap_or_else(Mat3::zeros)).collect();
        Self { compliances, columns }
    }

    /// Forces on all supports.
    fn forces(&self, on_support: Option<(usize, Vec3)>) -> Vec<Vec3> {
        let force_w = |k: usize| on_support.filter(|(support, _)| *support == k).map_or_else(Vec3::zeros, |(_, f)| f);
        (0..self.columns.len()).map(force_w).collect()
    }

    /// Wrench on the held platform by forces on the supports.
    fn wrench(&self, forces_w: &[Vec3]) -> Vec6 {
        let of = |(k, force_w): (usize, &Vec3)| {
            let moved_w = self.compliances[k] * force_w;
            self.columns[k].iter().zip(moved_w.iter()).map(|(column, moved)| column * *moved).sum::<Vec6>()
        };
        forces_w.iter().enumerate().map(of).sum()
    }

    /// Displacements of the supports by forces on them and a motion of the platform.
    fn displacements(&self, forces_w: &[Vec3], platform: &[f64; 6]) -> Vec<Vec3> {
        let platform = Vec6::from_column_slice(platform);
        let of = |(k, force_w): (usize, &Vec3)| {
            let by_platform_w = Vec3::from_iterator(self.columns[k].iter().map(|column| column.dot(&platform)));
            self.compliances[k] * (force_w + by_platform_w)
        };
        forces_w.iter().enumerate().map(of).collect()
    }
}

/// Extremes of the friction of one cable.
struct Extremes {
    exponent: f64,
    /// Unstrained length beyond the exit point less that without friction [m], after motion towards the platform and
    /// after motion towards the drum.
    excess_lengths: [f64; 2],
    /// Tension at the drum without friction less that with friction, after the same motions [N].
    reliefs: [f64; 2],
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
        let reliefs = [1.0, -1.0].map(|used| -state.tension_drum() * (-used * exponent).exp_m1());
        Self { exponent, excess_lengths, reliefs }
    }

    /// Change of the unstrained length beyond the exit point [m].
    fn excess_length(&self) -> Interval {
        Interval::between(self.excess_lengths[0], self.excess_lengths[1])
    }

    /// Effect of the friction on a quantity, by its gains with respect to the length of the cable without friction that
    /// has the same force, and to the relief of its support from the pull of the drum.
    fn effect(&self, gains: [f64; 2]) -> Interval {
        Interval::between(self.after(0, gains), self.after(1, gains))
    }

    /// Effect after one of the motions.
    fn after(&self, motion: usize, [by_length, by_pull]: [f64; 2]) -> f64 {
        self.reliefs[motion] * by_pull - self.excess_lengths[motion] * by_length
    }

    /// Tensions of cable `i` at its state, by the gains of its tensions with respect to the lengths of all cables; no
    /// gains with the pose held.
    fn tensions(&self, i: usize, state: &CableState, gains: &[[TensionGain; 2]], all: &[Self]) -> CableFriction {
        let sum = |gain: fn(&TensionGain) -> f64, skipped: Option<usize>| {
            let kept = gains.iter().zip(all).enumerate().filter(|(l, _)| Some(*l) != skipped);
            let terms = kept.map(|(_, (of, other))| other.effect(of.each_ref().map(gain)));
            terms.fold(Interval::ZERO, Interval::plus)
        };

        // The friction of the cable's own pulley acts on the tension at the drum twice, by the length and directly.
        let others = sum(|gain| gain.drum, Some(i));
        let own_gains = gains.get(i).map_or([0.0; 2], |gains| gains.each_ref().map(|gain| gain.drum));
        let frictionless = state.tension_drum();
        let after = |motion: usize, exponent: f64| {
            others.about(frictionless + self.after(motion, own_gains)).times(exponent.exp())
        };

        CableFriction {
            exponent: self.exponent,
            excess_length: self.excess_length(),
            tension_platform: sum(|gain| gain.platform, None).about(state.tension_platform),
            tension_anchor: sum(|gain| gain.anchor, None).about(state.tension_anchor),
            tension_drum: after(0, -self.exponent).with(after(1, self.exponent)),
        }
    }
}

/// Change of a cable's tensions per unit of one effect of friction: per unstrained length of a cable, with all other
/// lengths held [N/m], or per relief of its support [-].
#[derive(Debug, Clone, Copy, Default)]
struct TensionGain {
    platform: f64,
    anchor: f64,
    drum: f64,
}

impl TensionGain {
    /// Gain of cable `i` of a robot for a motion; `is_own` if its cause is the length of the cable itself.
    fn of((robot, i): (&Robot, usize), state: &CableState, motion: &Motion, is_own: bool) -> Self {
        // A slack cable without weight stays without tension.
        let (Some(stiffness), Some(by_length_w)) = (state.tangent_w(), state.force_by_length_w()) else {
            return Self::default();
        };
        let Some(along_w) = state.force_on_platform_w.try_normalize(0.0) else { return Self::default() };

        let [x, y, z, roll, pitch, yaw] = motion.platform;
        let mut attachment_w = Vec3::new(x, y, z) + Vec3::new(roll, pitch, yaw).cross(&state.lever_w);
        let direct_w = if is_own { by_length_w } else { Vec3::zeros() };
        let mut force_w = direct_w - stiffness * attachment_w;

        // The support moves the far end.
        let held = state.hanging.as_ref().map_or_else(Mat3::zeros, HangingCable::tangent_w);
        let carried = robot.cables[i].anchor.support.zip(supports::on_support(robot, i, state, &held));
        if let Some((support, cable)) = carried {
            force_w += cable.force_w * motion.supports[support];
            attachment_w -= motion.supports[support];
        }
        let platform = along_w.dot(&force_w);

        // ψ(T) + q·p is the same all along the cable, and λ = dψ/dT. The attachment moves relative to the far end.
        let stretch = |tension: f64| 1.0 + tension / robot.cables[i].material.axial_stiffness;
        let potential = stretch(state.tension_platform) * platform + load_of(state).dot(&attachment_w);
        Self {
            platform,
            anchor: potential / stretch(state.tension_anchor),
            drum: potential / stretch(state.tension_drum()),
        }
    }
}
