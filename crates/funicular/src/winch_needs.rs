//! Needs of winches at a pose: tensions, speeds, accelerations, torques, powers and rope for everything that is
//! required there.
//!
//! Every required load is an equilibrium of its own, with tensions by their rule. The required velocities and
//! accelerations act in every combination with the loads, so that the largest tension and the largest acceleration of a
//! cable count together, even if no single motion has both.

use crate::gradient::GradientError;
use crate::math::{Mat3, Mat6, Vec3, Vec6, skew, symmetric};
use crate::robot::{Constraint, LoadShape, PlatformMotion, Pose, Robot, State, TwistSet};
use crate::speeds::WinchSpeeds;
use crate::statics::{self, CableState, Equilibrium, StaticModel, StaticsError, TensionRule};
use thiserror::Error;

/// Quantity for which a winch is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WinchNeed {
    /// Tension at the drum [N].
    Tension,
    /// Speed of the cable at the drum [m/s].
    Speed,
    /// Acceleration of the cable at the drum [m/s²].
    Acceleration,
    /// Torque of the motor at its own shaft [N m].
    Torque,
    /// Mechanical power of the motor while it drives [W].
    Power,
    /// Mechanical power that the motor takes while it brakes [W].
    BrakePower,
}

impl WinchNeed {
    /// All needs.
    pub const ALL: [Self; 6] =
        [Self::Tension, Self::Speed, Self::Acceleration, Self::Torque, Self::Power, Self::BrakePower];
}

/// Largest value of a need, with what asks for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LargestNeed {
    /// Value, in the unit of the need.
    pub value: f64,
    /// Pose.
    pub pose: Pose,
    /// Load in addition to the dead load, world axes about the platform origin (N, N m).
    pub load_w: Vec6,
    /// Twist of the platform, world axes (m/s, rad/s).
    pub twist_w: Vec6,
}

/// Needs of the winch of one cable.
#[derive(Debug, Clone, PartialEq)]
pub struct CableNeeds {
    /// Largest values in the order of [`WinchNeed::ALL`]; a torque needs a radius of the drum.
    pub largest: [Option<LargestNeed>; 6],
    /// Least and largest unstrained length [m].
    pub lengths: [f64; 2],
}

/// Needs of all winches, in the order of the cables.
///
/// # Example
/// ```
/// use funicular::math::Vec3;
/// use funicular::robot::{Pose, Robot};
/// use funicular::statics::{StaticModel, TensionRule};
/// use funicular::winch_needs::{WinchNeed, WinchNeeds};
///
/// let mut robot = Robot::from_toml(funicular_robots::COGIRO_WINCHES)?;
/// robot.required.velocity_w = Vec3::repeat(1.0); // m/s, every way along every axis
/// robot.required.acceleration_w = Vec3::repeat(2.0); // m/s²
/// let pose = Pose::new([1.0, 1.0, 1.5], [0.0; 3]);
/// let needs = WinchNeeds::at(&robot, &pose, StaticModel::Catenary, &TensionRule::Lowest)?;
/// let power = needs.cables[0].of(WinchNeed::Power).unwrap();
/// assert!(power.value > 100.0 && power.twist_w.norm() > 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, equations (40z4a) to (40z4c).
#[derive(Debug, Clone, PartialEq)]
pub struct WinchNeeds {
    /// Needs of each cable.
    pub cables: Vec<CableNeeds>,
}

/// Pose at which winches cannot be chosen.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum WinchNeedsError {
    /// Required load that the cables do not hold within their limits.
    #[error("{}{reason}", under(load_w))]
    NotHeld {
        /// Load in addition to the dead load, world axes about the platform origin (N, N m).
        load_w: Vec6,
        /// Reason.
        reason: Box<StaticsError>,
    },
    /// Equilibrium without rates of its lengths.
    #[error(transparent)]
    NoRates(#[from] GradientError),
}

fn under(load_w: &Vec6) -> String {
    if *load_w == Vec6::zeros() {
        return String::new();
    }
    let [fx, fy, fz, mx, my, mz] = (*load_w).into();
    format!("under the required load ({fx:.1}, {fy:.1}, {fz:.1}) N, ({mx:.1}, {my:.1}, {mz:.1}) N m: ")
}

impl WinchNeeds {
    /// Needs at a pose for the required loads, accelerations and velocities of a robot; tensions follow a rule if the
    /// cables leave a choice.
    ///
    /// # Errors
    /// [`WinchNeedsError`]: a required load that the cables do not hold, fewer cables than degrees of freedom, or an
    /// equilibrium without rates.
    pub fn at(robot: &Robot, pose: &Pose, model: StaticModel, rule: &TensionRule) -> Result<Self, WinchNeedsError> {
        // Every load, with the tensions and lengths that it needs.
        let mut held = Vec::new();
        for (loaded, load_w) in statics::robots_under_required_loads(robot, pose) {
            let not_held = |reason| WinchNeedsError::NotHeld { load_w, reason: Box::new(reason) };
            if let Constraint::Under(_) = robot.constraint() {
                let (cables, dof) = (robot.cables.len(), robot.platform.motion.count());
                return Err(not_held(StaticsError::InverseCableCount { cables, dof }));
            }
            let found = statics::solve_at(&loaded, &State::Pose(*pose), model, rule).map_err(not_held)?;
            held.push(UnderLoad { robot: loaded, rest: found.equilibrium, load_w });
        }
        let mut needs = Self { cables: (0..robot.cables.len()).map(|i| CableNeeds::at_rest(&held, i, pose)).collect() };

        // Speeds and powers: the rates of the lengths differ from load to load as the sag does.
        let rule = robot.constraint().is_redundant().then_some(rule);
        for under in &held {
            needs.add_motion(under, &WinchSpeeds::at(&under.robot, &under.rest, rule)?);
        }
        Ok(needs)
    }

    /// Larger of these needs and those at other poses, cable by cable.
    pub fn merge(&mut self, other: &Self) {
        for (cable, other) in self.cables.iter_mut().zip(&other.cables) {
            for need in other.largest.iter().zip(WinchNeed::ALL).filter_map(|(need, of)| Some((of, (*need)?))) {
                cable.take(need.0, need.1);
            }
            cable.lengths = [cable.lengths[0].min(other.lengths[0]), cable.lengths[1].max(other.lengths[1])];
        }
    }

    /// Needs of one winch that serves every cable, with the cable that asks for each; none without cables.
    pub fn of_one(&self, need: WinchNeed) -> Option<(usize, LargestNeed)> {
        let of_cables = self.cables.iter().enumerate().filter_map(|(i, cable)| Some((i, cable.of(need)?)));
        of_cables.reduce(|most, of| if of.1.value > most.1.value { of } else { most })
    }

    /// Adds what a load asks for while the platform moves.
    fn add_motion(&mut self, under: &UnderLoad, speeds: &WinchSpeeds) {
        let required = &under.robot.required;
        let (twists, accelerations) = (required.twists_w(), TwistSet::in_box(required.accelerations_w()));
        let motion = &under.robot.platform.motion;
        let cables = self.cables.iter_mut().zip(speeds.winches()).zip(&under.rest.cables);
        for ((needs, winch), state) in cables {
            let pose = under.rest.pose;
            let with = |value, twist_w| LargestNeed { value, pose, load_w: under.load_w, twist_w };
            let fastest_w = twists.farthest(&winch.by_twist);
            let (bend, bending_w) = largest_bend(state, motion, &twists);
            let (speed, acceleration) = (winch.speed_in(&twists), winch.speed_in(&accelerations) + bend);

            let worst = winch.worst_up_to(speed, acceleration);
            needs.take(WinchNeed::Speed, with(speed, fastest_w));
            needs.take(WinchNeed::Acceleration, with(acceleration, bending_w));
            if let Some(torque) = worst.torque {
                needs.take(WinchNeed::Torque, with(torque, fastest_w));
            }
            needs.take(WinchNeed::Power, with(worst.driving, -fastest_w));
            needs.take(WinchNeed::BrakePower, with(worst.braking, fastest_w));
        }
    }
}

/// Robot at rest under one of its required loads.
struct UnderLoad {
    robot: Robot,
    rest: Equilibrium,
    load_w: Vec6,
}

impl CableNeeds {
    /// Largest value of a need, with what asks for it.
    pub fn of(&self, need: WinchNeed) -> Option<LargestNeed> {
        self.largest[need as usize]
    }

    /// Rope that goes on and off the drum between the extreme lengths [m].
    pub fn stroke(&self) -> f64 {
        self.lengths[1] - self.lengths[0]
    }

    /// Takes a need if it is the largest.
    fn take(&mut self, need: WinchNeed, of: LargestNeed) {
        if self.of(need).is_none_or(|most| of.value > most.value) {
            self.largest[need as usize] = Some(of);
        }
    }

    /// Tension and lengths of a cable under all loads at a pose.
    fn at_rest(held: &[UnderLoad], i: usize, pose: &Pose) -> Self {
        let mut found = Self { largest: [None; 6], lengths: [f64::INFINITY, f64::NEG_INFINITY] };
        for UnderLoad { rest, load_w, .. } in held {
            let state = &rest.cables[i];
            let need =
                LargestNeed { value: state.tension_drum(), pose: *pose, load_w: *load_w, twist_w: Vec6::zeros() };
            found.take(WinchNeed::Tension, need);
            let length = state.unstrained_length;
            found.lengths = [found.lengths[0].min(length), found.lengths[1].max(length)];
        }
        found
    }
}

/// Largest acceleration of a straight cable while the platform moves with a constant twist of a set [m/s²], and the
/// twist: equation (40z4b).
fn largest_bend(state: &CableState, motion: &PlatformMotion, twists: &TwistSet) -> (f64, Vec6) {
    match twists.shape {
        LoadShape::Box => largest_bend_in_box(state, motion, twists),
        LoadShape::Ellipsoid => {
            let form = bend_form(state, motion, &twists.half_widths);
            let [rising, falling] = [form, -form].map(|form| largest_in_balls(&form));
            let (value, unit) = if rising.0 >= falling.0 { rising } else { falling };
            (value, unit.component_mul(&twists.half_widths))
        }
    }
}

/// Largest acceleration over the corners of a box.
fn largest_bend_in_box(state: &CableState, motion: &PlatformMotion, twists: &TwistSet) -> (f64, Vec6) {
    // Opposite twists bend alike: every second corner is one of a pair.
    twists.corners().step_by(2).fold((0.0, Vec6::zeros()), |most, twist_w| {
        let bend = bend(state, &motion.allowed(&twist_w)).abs();
        if bend > most.0 { (bend, twist_w) } else { most }
    })
}

/// Symmetric matrix of the acceleration of [`bend`] as a quadratic form of the twist over its half axes.
fn bend_form(state: &CableState, motion: &PlatformMotion, half_axes: &Vec6) -> Mat6 {
    let (length, lever_w) = (state.chord(), state.lever_w);
    let outwards_w = -state.chord_w() / length;
    let across = (Mat3::identity() - outwards_w * outwards_w.transpose()) / length;
    let by_turn = -skew(&lever_w);
    let product = outwards_w * lever_w.transpose();
    let turning = 0.5 * (product + product.transpose()) - Mat3::identity() * outwards_w.dot(&lever_w);

    let mut form = Mat6::zeros();
    form.fixed_view_mut::<3, 3>(0, 0).copy_from(&across);
    form.fixed_view_mut::<3, 3>(0, 3).copy_from(&(across * by_turn));
    form.fixed_view_mut::<3, 3>(3, 0).copy_from(&(by_turn.transpose() * across));
    form.fixed_view_mut::<3, 3>(3, 3).copy_from(&(by_turn.transpose() * across * by_turn + turning));
    let mut scaled = Mat6::zeros();
    for axis in 0..6 {
        let mut along = Vec6::zeros();
        along[axis] = half_axes[axis];
        scaled.set_column(axis, &motion.allowed(&along));
    }
    scaled.transpose() * form * scaled
}

/// Largest value of a quadratic form over two unit balls, of the first and of the last three coordinates, and a point
/// there; zero if the form is never positive.
///
/// For two such constraints the bound of Lagrange is exact: the largest value is the least of the largest eigenvalues
/// of the form whose parts are scaled with 1/√p and 1/√(1 − p), over 0 < p < 1, equation (40z4c). This function of p
/// has one minimum.
fn largest_in_balls(form: &Mat6) -> (f64, Vec6) {
    let [linear, angular] = [0, 3].map(|from| form.fixed_rows::<3>(from).iter().any(|entry| *entry != 0.0));
    let scale = |part: f64| Vec6::from_fn(|axis, _| (if axis < 3 { part } else { 1.0 - part }).sqrt().recip());
    let eigen = |scale: &Vec6| {
        let scaled = Mat6::from_fn(|i, j| scale[i] * form[(i, j)] * scale[j]);
        let (values, vectors) = symmetric::eigen(&scaled, 6);
        (values[5], vectors[5])
    };
    // In one ball the value is the eigenvalue of its own part.
    let scale = if linear && angular { scale(least_of(|part| eigen(&scale(part)).0)) } else { Vec6::repeat(1.0) };
    let (value, vector) = eigen(&scale);
    if value <= 0.0 {
        return (0.0, Vec6::zeros());
    }
    // The parts of an eigenvector alone end on their balls where the eigenvalue is simple.
    let point = vector.component_mul(&scale);
    let size = [0, 3].map(|from| point.fixed_rows::<3>(from).norm()).into_iter().fold(0.0, f64::max);
    (value, point / size)
}

/// Place between 0 and 1 of the minimum of a function that falls and then rises, by the golden section.
fn least_of(value: impl Fn(f64) -> f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let (mut low, mut high) = (0.0, 1.0);
    let mut inner = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
    let mut values = inner.map(&value);
    // The bound is flat at its minimum: half the digits of the place are enough for all of the value.
    while high - low > 1e-9 {
        if values[0] <= values[1] {
            high = inner[1];
            inner = [high - GOLDEN * (high - low), inner[0]];
            values = [value(inner[0]), values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + GOLDEN * (high - low)];
            values = [values[1], value(inner[1])];
        }
    }
    0.5 * (low + high)
}

/// Acceleration of the length of a straight cable while the platform moves with a constant twist [m/s²].
fn bend(state: &CableState, twist_w: &Vec6) -> f64 {
    let (velocity_w, turn_w): (Vec3, Vec3) = (twist_w.fixed_rows::<3>(0).into(), twist_w.fixed_rows::<3>(3).into());
    let length = state.chord();
    let outwards_w = -state.chord_w() / length;
    let of_end_w = velocity_w + turn_w.cross(&state.lever_w);
    let along = outwards_w.dot(&of_end_w);
    let across_squared = (of_end_w.norm_squared() - along * along).max(0.0);
    across_squared / length + outwards_w.dot(&turn_w.cross(&turn_w.cross(&state.lever_w)))
}
