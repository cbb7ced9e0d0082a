//! Speeds at a pose: what every winch has to do while the platform moves, and how fast its limits let the platform be.
//!
//! The platform moves slowly enough for the tensions to be those at rest. A twist is the velocity of the platform's
//! origin along the axes of the world [m/s], then the angular velocity about them [rad/s].

use crate::gradient::{GradientError, LengthRates};
use crate::math::{Vec6, roots};
use crate::robot::{LimitOfWinch, LoadShape, PlatformMotion, Robot, TwistSet, Winch};
use crate::statics::{Equilibrium, StaticModel, TensionRule};

/// Speed of a cable up to which limits are searched [m/s]; a winch that reaches it has no limit of speed.
const SEARCHED: f64 = 1e9;

/// Speed of a cable that has begun to move [m/s], far below any other: the friction of the gear then has a direction.
const BARELY: f64 = 1e-100;

/// Maximum number of steps of an ascent; a convex sum of eight winches took at most five.
const MAX_ASCENTS: usize = 30;

/// Relative rise below which an ascent has ended.
const ASCENDED: f64 = 1e-14;

/// Half width of the differences of an ascent over that of the set: the sum is piecewise smooth, and a step that is too
/// wide only chooses another direction.
const DIFFERENCE: f64 = 1e-6;

/// Work of the winches of a robot while its platform moves.
///
/// # Example
/// ```
/// use funicular::math::Vec6;
/// use funicular::robot::{Robot, TwistSet};
/// use funicular::speeds::WinchSpeeds;
/// use funicular::statics::{self, StaticModel};
///
/// let limited = "gear_ratio = 3\nmax_speed_m_s = 3.0";
/// let robot = Robot::from_toml(&funicular_robots::COGIRO_WINCHES.replacen("gear_ratio = 3", limited, 1))?;
/// let rest = statics::solve(&robot, StaticModel::Catenary, None)?.equilibrium;
/// let speeds = WinchSpeeds::at(&robot, &rest, None)?;
///
/// let required = TwistSet::in_box(Vec6::new(1.0, 1.0, 1.0, 0.2, 0.2, 0.2)); // m/s and rad/s, both ways
/// let factor = speeds.factor(&required);
/// assert!(factor.value > 1.0 && factor.cable.is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, equations (40z1) to (40z4).
#[derive(Debug, Clone)]
pub struct WinchSpeeds {
    motion: PlatformMotion,
    /// Winches in the order of the cables.
    winches: Vec<WinchAtRest>,
    /// False if the rule of the tensions has no derivatives at the equilibrium: the tensions then change least along
    /// the cables in place of following it.
    pub follows_rule: bool,
}

/// Winch of a cable at a pose.
#[derive(Debug, Clone)]
pub struct WinchAtRest {
    /// Winch; without one in the robot file a rigid winch without limits.
    pub winch: Winch,
    /// Speed of the cable at the drum per unit twist, positive while it pays out [m/s per m/s, then m per rad].
    pub by_twist: Vec6,
    /// Tension at the drum [N].
    pub tension: f64,
    /// Largest speed while it winds in.
    pub inwards: SpeedLimit,
    /// Largest speed while it pays out.
    pub outwards: SpeedLimit,
}

/// Largest speed of a winch in one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedLimit {
    /// Speed of the cable at the drum up to which every speed is within the limits [m/s]; infinite without a limit.
    pub value: f64,
    /// Limit that is reached there; `None` without one.
    pub limit: Option<LimitOfWinch>,
}

/// Largest multiple of a motion that the winches can follow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LargestMotion {
    /// Multiple; infinite if no winch limits it.
    pub value: f64,
    /// Cable whose winch limits it, and the limit.
    pub cable: Option<(usize, LimitOfWinch)>,
}

/// Work of one winch at the worst speeds of a set of twists.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorstUse {
    /// Largest speed of the cable at the drum [m/s].
    pub speed: f64,
    /// Largest power of the motor while it drives [W].
    pub driving: f64,
    /// Largest power that the motor takes while it brakes [W].
    pub braking: f64,
    /// Largest torque of the motor [N m]; `None` without a radius of the drum.
    pub torque: Option<f64>,
    /// Largest used part of each limit.
    pub uses: [(LimitOfWinch, f64); 5],
}

/// Powers of all winches together.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SumOfPowers {
    /// Power of the motors that drive [W].
    pub driving: f64,
    /// Taken by the motors that brake [W].
    pub braking: f64,
}

impl WinchSpeeds {
    /// Winches at an equilibrium: the tensions follow the rule that has chosen them; without one, and where it has no
    /// derivatives, they change least along the cables.
    ///
    /// A rule has a kink where a tension reaches or leaves a limit, as at symmetric poses. The speeds on its two sides
    /// differ by the changes of stretch and sag.
    ///
    /// # Errors
    /// [`GradientError`], as [`LengthRates::of`].
    pub fn at(robot: &Robot, rest: &Equilibrium, rule: Option<&TensionRule>) -> Result<Self, GradientError> {
        let least_change = || LengthRates::with_least_change(robot, rest);
        let Some(rule) = rule else { return Ok(Self::of_rates(robot, rest, &least_change()?)) };
        match LengthRates::of(robot, rest, rule) {
            Err(GradientError::OneSided { .. } | GradientError::Stiffest) => {
                Ok(Self { follows_rule: false, ..Self::of_rates(robot, rest, &least_change()?) })
            }
            rates => Ok(Self::of_rates(robot, rest, &rates?)),
        }
    }

    /// Winches at an equilibrium with these rates of the unstrained lengths.
    pub fn of_rates(robot: &Robot, rest: &Equilibrium, rates: &LengthRates) -> Self {
        let motion = robot.platform.motion;
        let cables = robot.cables.iter().zip(&rest.cables).zip(&rates.by_pose);
        let winches = cables.map(|((cable, state), by_pose)| {
            let tension = state.tension_drum();
            // The length is counted without tension; rigid cables have no other length.
            let is_rigid = rest.model == StaticModel::Ideal;
            let stretch = if is_rigid { 1.0 } else { 1.0 + tension / cable.material.axial_stiffness };
            let winch = cable.anchor.winch.clone().unwrap_or_else(|| Winch::rigid(&cable.name, 0.0));
            WinchAtRest::new(winch, motion.allowed(by_pose) * stretch, tension)
        });
        Self { motion, winches: winches.collect(), follows_rule: true }
    }

    /// Winches in the order of the cables.
    pub fn winches(&self) -> &[WinchAtRest] {
        &self.winches
    }

    /// Largest multiple of a set of twists all of whose twists the winches can follow. Infinite for an empty set.
    pub fn factor(&self, twists: &TwistSet) -> LargestMotion {
        self.largest(|winch| winch.slowest().over(winch.speed_in(twists)))
    }

    /// Largest multiple of a twist.
    pub fn along(&self, twist_w: &Vec6) -> LargestMotion {
        let twist_w = self.motion.allowed(twist_w);
        self.largest(|winch| {
            let speed = winch.by_twist.dot(&twist_w);
            if speed < 0.0 { winch.inwards.over(-speed) } else { winch.outwards.over(speed) }
        })
    }

    /// Largest speed of the platform's origin in every direction, while the platform does not turn [m/s].
    pub fn in_every_direction(&self) -> LargestMotion {
        self.largest(|winch| winch.slowest().over(winch.by_twist.fixed_rows::<3>(0).norm()))
    }

    /// Smallest of the motions that the winches allow.
    fn largest(&self, of: impl Fn(&WinchAtRest) -> SpeedLimit) -> LargestMotion {
        let none = LargestMotion { value: f64::INFINITY, cable: None };
        self.winches.iter().enumerate().fold(none, |least, (i, winch)| {
            let SpeedLimit { value, limit } = of(winch);
            if value < least.value { LargestMotion { value, cable: limit.map(|limit| (i, limit)) } } else { least }
        })
    }

    /// Largest sums of the powers of all winches in a set of twists: of those that drive, and of those that brake. The
    /// sum of driving powers is convex, so that no twist inside a box needs more than its worst corner; that of braking
    /// powers is convex without damping of the winches. In an ellipsoid the largest sums are those that an ascent finds
    /// from every octant and from the fastest twist of every winch: equation (40z3a).
    pub fn powers(&self, twists: &TwistSet) -> SumOfPowers {
        let most = |most: SumOfPowers, of: SumOfPowers| SumOfPowers {
            driving: most.driving.max(of.driving),
            braking: most.braking.max(of.braking),
        };
        let corners = twists.corners();
        if twists.shape == LoadShape::Box {
            return corners.map(|twist_w| self.powers_at(&twist_w)).fold(SumOfPowers::default(), most);
        }
        let fastest = self.winches.iter().flat_map(|winch| [winch.by_twist, -winch.by_twist]);
        let starts = corners.chain(fastest.map(|row| twists.farthest(&row)));
        starts.fold(SumOfPowers::default(), |found, start_w| {
            let driving = self.ascent(twists, start_w, |powers| powers.driving);
            let braking = self.ascent(twists, start_w, |powers| powers.braking);
            most(most(found, driving), braking)
        })
    }

    /// Powers at the end of an ascent over a set from a twist: each step goes to the twist that is farthest along the
    /// gradient of a sum, which is higher wherever the sum is convex.
    fn ascent(&self, twists: &TwistSet, start_w: Vec6, of: fn(&SumOfPowers) -> f64) -> SumOfPowers {
        let mut best = self.powers_at(&start_w);
        let mut twist_w = start_w;
        for _ in 0..MAX_ASCENTS {
            let gradient = Vec6::from_fn(|axis, _| {
                let half = DIFFERENCE * twists.half_widths[axis];
                let at = |side: f64| {
                    let mut beside_w = twist_w;
                    beside_w[axis] += side * half;
                    of(&self.powers_at(&beside_w))
                };
                if half > 0.0 { (at(1.0) - at(-1.0)) / (2.0 * half) } else { 0.0 }
            });
            let next_w = twists.farthest(&gradient);
            let next = self.powers_at(&next_w);
            if of(&next) <= of(&best) * (1.0 + ASCENDED) {
                break;
            }
            (best, twist_w) = (next, next_w);
        }
        best
    }

    /// Sums of the powers of all winches for a twist.
    pub fn powers_at(&self, twist_w: &Vec6) -> SumOfPowers {
        self.winches.iter().fold(SumOfPowers::default(), |sum, winch| {
            let power = winch.power(winch.by_twist.dot(twist_w));
            SumOfPowers { driving: sum.driving + power.max(0.0), braking: sum.braking + (-power).max(0.0) }
        })
    }
}

impl WinchAtRest {
    fn new(winch: Winch, by_twist: Vec6, tension: f64) -> Self {
        let none = SpeedLimit { value: f64::INFINITY, limit: None };
        let mut found = Self { winch, by_twist, tension, inwards: none, outwards: none };
        found.inwards = found.limit(-1.0);
        found.outwards = found.limit(1.0);
        found
    }

    /// Power of the motor at a constant speed of the cable at the drum [m/s], positive while it drives [W].
    fn power(&self, speed: f64) -> f64 {
        self.winch.motor(self.tension, speed, 0.0).power
    }

    /// Used parts of the limits at a constant speed.
    fn uses(&self, speed: f64) -> [(LimitOfWinch, f64); 5] {
        self.winch.limits.use_of(speed, 0.0, &self.winch.motor(self.tension, speed, 0.0))
    }

    /// Limit of which a constant speed uses most, and the used part.
    fn most_used(&self, speed: f64) -> (LimitOfWinch, f64) {
        self.uses(speed).into_iter().fold((LimitOfWinch::Speed, 0.0), |most, of| if of.1 > most.1 { of } else { most })
    }

    /// Smaller of the two largest speeds.
    pub fn slowest(&self) -> SpeedLimit {
        if self.inwards.value <= self.outwards.value { self.inwards } else { self.outwards }
    }

    /// Largest speed of the cable at the drum in a set of twists [m/s]. The speed is linear in the twist, and the set
    /// is symmetric, so that it has this speed in both directions.
    pub fn speed_in(&self, twists: &TwistSet) -> f64 {
        twists.largest(&self.by_twist)
    }

    /// Largest powers and uses of the limits in a set of twists, at constant speeds.
    pub fn worst_in(&self, twists: &TwistSet) -> WorstUse {
        self.worst_up_to(self.speed_in(twists), 0.0)
    }

    /// Largest powers and uses of the limits up to a speed and an acceleration of the cable at the drum [m/s, m/s²],
    /// both in either direction.
    pub fn worst_up_to(&self, speed: f64, acceleration: f64) -> WorstUse {
        let uses = LimitOfWinch::ALL.map(|of| (of, 0.0));
        let mut worst = WorstUse { speed, driving: 0.0, braking: 0.0, torque: None, uses };
        let accelerations = if acceleration > 0.0 { &[-acceleration, acceleration][..] } else { &[0.0] };
        for (direction, acceleration) in [-1.0, 1.0].iter().flat_map(|way| accelerations.iter().map(move |a| (way, *a)))
        {
            let before = self.turns(acceleration).into_iter().filter(|turn| *turn < speed);
            let barely = [0.0, BARELY.min(speed)];
            for speed in barely.into_iter().chain(before).chain([speed]).map(|speed| direction * speed) {
                let motor = self.winch.motor(self.tension, speed, acceleration);
                worst.driving = worst.driving.max(motor.power);
                worst.braking = worst.braking.max(-motor.power);
                worst.torque = motor.torque.map(|torque| torque.abs().max(worst.torque.unwrap_or(0.0)));
                let uses = self.winch.limits.use_of(speed, acceleration, &motor);
                for (most, of) in worst.uses.iter_mut().zip(uses) {
                    most.1 = most.1.max(of.1);
                }
            }
        }
        worst
    }

    /// Speeds between which every used part is monotonic at an acceleration of the cable [m/s²], ascending: corners of
    /// the torque–speed curve, the largest braking power and the end of braking if damping takes the place of the
    /// motor.
    fn turns(&self, acceleration: f64) -> Vec<f64> {
        let lever = self.winch.drum_radius.map_or(0.0, |radius| radius / self.winch.gear_ratio);
        let corners = self.winch.limits.torque_speed.iter().map(|[speed, _]| speed * lever);
        let alone = (self.tension - self.winch.drum_mass * acceleration) / self.winch.damping;
        let mut turns: Vec<f64> =
            corners.chain([0.5 * alone, alone]).filter(|turn| *turn > 0.0 && turn.is_finite()).collect();
        turns.sort_unstable_by(f64::total_cmp);
        turns
    }

    /// Largest speed in a direction, −1 winding in or 1 paying out, up to which every speed is within the limits.
    fn limit(&self, direction: f64) -> SpeedLimit {
        let beyond = |speed: f64| self.most_used(direction * speed).1 - 1.0;
        let reached =
            |value: f64, just_beyond: f64| SpeedLimit { value, limit: Some(self.most_used(direction * just_beyond).0) };

        let mut from = 0.0_f64;
        for to in self.turns(0.0).into_iter().chain([SEARCHED]) {
            // The use may jump at the beginning of a piece: at rest by the friction of the gear, and at the end of the
            // torque–speed curve.
            let first = from.next_up().max(BARELY);
            let (at_first, at_end) = (beyond(first), beyond(to));
            if at_first > 0.0 {
                return reached(from, first);
            }
            if at_end > 0.0 {
                let value = roots::brent(first, at_first, to, at_end, beyond);
                return reached(value, value);
            }
            from = to;
        }
        SpeedLimit { value: f64::INFINITY, limit: None }
    }
}

impl SpeedLimit {
    /// Multiple of a speed [m/s] that reaches the limit; infinite for a cable that does not move.
    fn over(self, speed: f64) -> Self {
        if speed > 0.0 {
            Self { value: self.value / speed, ..self }
        } else {
            Self { value: f64::INFINITY, limit: None }
        }
    }
}
