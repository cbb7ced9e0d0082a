//! Start of an estimator: the platform at rest, its pose tied to offsets, payload and wrench.

use super::covariance::Covariance;
use super::model::{CarriedLoad, EstimatedRobot, Tangents, gravity_of};
use super::settings::StatePriors;
use super::state::StatePlaces;
use crate::control_loop::MAX_CABLES;
use crate::math::{Vec3, Vec6};
use crate::robot::{Pose, Robot};
use crate::statics::{StaticModel, StaticsError, forward};
use thiserror::Error;

/// Reason why there is no estimate.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum EstimationError {
    /// More cables than an estimator has room for.
    #[error("the robot has {cables} cables in [[cables]]: an estimator has room for {MAX_CABLES}")]
    TooManyCables {
        /// Number of cables.
        cables: usize,
    },
    /// Flexible supports.
    #[error(
        "the support \"{support}\" in [[supports]] yields under its cables, which the estimator does not follow: leave \
         out `support` in [[cables]]"
    )]
    Supports {
        /// Name of the support.
        support: String,
    },
    /// Rope over sheaves.
    #[error(
        "the rope of cable \"{cable}\" runs over sheaves, which the estimator does not follow: leave out \
         `shares_rope_with` in [[cables]]"
    )]
    RopeOverSheaves {
        /// Name of the first cable of the rope.
        cable: String,
    },
    /// A length that the start needs is missing.
    #[error("the estimator starts from the lengths of all cables at one time; cable \"{cable}\" has none")]
    NoLength {
        /// Name of the cable.
        cable: String,
    },
    /// No equilibrium with the lengths of the start.
    #[error("no equilibrium was found with the lengths of the start: {0}")]
    NoStart(#[from] StaticsError),
    /// No equilibrium at the state that was reached.
    #[error("the platform finds no balance with these lengths")]
    NoBalance,
    /// A time step that is not positive or finite.
    #[error("the time step is {step} s: it must be positive and at most {MAX_STEP} s")]
    BadStep {
        /// Time step [s].
        step: f64,
    },
    /// All encoders silent for too long.
    #[error("no length has been read for {gap} s, longer than {MAX_GAP} s: start the estimator anew")]
    EncodersLost {
        /// Time without readings [s].
        gap: f64,
    },
    /// A state that has left every number behind.
    #[error("the state is no longer a finite number: start the estimator anew")]
    Diverged,
}

/// Maximum time step [s]: a pause of a log is longer, and starts anew.
pub(super) const MAX_STEP: f64 = 1.0;

/// Maximum time without readings of lengths [s]; at 0.2 m/s the platform has moved 40 mm then.
pub(super) const MAX_GAP: f64 = 0.2;

/// Maximum number of steps of Newton's method at rest.
const MAX_STEPS: usize = 20;

/// Step of the platform that ends the search at rest [m].
const LAST_STEP: f64 = 1e-10;

/// Checks a robot for an estimator.
pub(super) fn check(robot: &Robot) -> Result<(), EstimationError> {
    let cables = robot.cables.len();
    if cables > MAX_CABLES {
        return Err(EstimationError::TooManyCables { cables });
    }
    if let Some(rope) = robot.ropes.first() {
        return Err(EstimationError::RopeOverSheaves { cable: robot.cables[rope.cables[0]].name.clone() });
    }
    match robot.supports.first().filter(|_| robot.has_supports()) {
        Some(support) => Err(EstimationError::Supports { support: support.name.clone() }),
        None => Ok(()),
    }
}

/// Pose at rest with lengths, near `start` or from nothing.
pub(super) fn rest_pose(
    of: &EstimatedRobot,
    lengths: &[f64],
    load: &CarriedLoad,
    start: Option<&Pose>,
) -> Result<(Pose, Tangents), EstimationError> {
    let near = start.and_then(|start| balanced(of, lengths, load, *start));
    if let Some(found) = near {
        return Ok(found);
    }
    let cold = forward(&of.robot, lengths, StaticModel::Catenary, start)
        .or_else(|_| forward(&of.robot, lengths, StaticModel::Catenary, None))?;
    balanced(of, lengths, load, cold.pose).ok_or(EstimationError::NoBalance)
}

/// Newton's method to the balance next to a pose.
pub(super) fn balanced(
    of: &EstimatedRobot,
    lengths: &[f64],
    load: &CarriedLoad,
    start: Pose,
) -> Option<(Pose, Tangents)> {
    let mut pose = start;
    let mut here = of.at(&pose, lengths, load, None)?;
    for _ in 0..MAX_STEPS {
        let step = here.stiffness.lu().solve(&here.wrench)?;
        let size = step.norm();
        // Far from the balance a step is shortened to a tenth of a metre or radian.
        let step = step * (0.1 / size).min(1.0);
        pose = moved(&pose, &step);
        here = of.at(&pose, lengths, load, Some(&here))?;
        if size < LAST_STEP {
            return here.stiffness.symmetric_eigenvalues().min().is_finite().then_some((pose, here));
        }
    }
    None
}

/// Pose after a motion (translation, turn).
pub(super) fn moved(pose: &Pose, motion: &Vec6) -> Pose {
    pose.moved(&Vec3::new(motion[0], motion[1], motion[2]), &Vec3::new(motion[3], motion[4], motion[5]))
}

/// Covariance of what does not move: prior knowledge of a robot never seen before.
pub(super) fn prior(covariance: &mut Covariance, places: StatePlaces, priors: &StatePriors, length_noise: f64) {
    covariance.clear();
    wrench_prior(covariance, priors);
    covariance.put(StatePlaces::PAYLOAD, StatePlaces::PAYLOAD, priors.payload[1].powi(2));
    let mut same = |first: usize, count: usize, std: f64| {
        (first..first + count).for_each(|i| covariance.put(i, i, std * std));
    };
    same(StatePlaces::FIRST_MOMENT, 3, priors.first_moment);
    same(StatePlaces::OFFSETS, places.cables, priors.offset);
    same(places.tension_biases(), places.cables, priors.tension_bias);
    same(places.accelerometer_bias(), 3, priors.accelerometer_bias);
    same(places.gyroscope_bias(), 3, priors.gyroscope_bias);
    same(places.encoder_errors(), places.cables, length_noise);
}

/// Wrench as before any reading, without correlations.
pub(super) fn wrench_prior(covariance: &mut Covariance, priors: &StatePriors) {
    for k in 0..6 {
        let std = if k < 3 { priors.force } else { priors.moment };
        covariance.reopen(StatePlaces::WRENCH + k, std * std);
    }
}

/// Ties the pose at rest to wrench, payload, offsets and errors of the encoders: it has no prior of its own. Returns
/// the rows that say how it follows them.
///
/// # References
/// docs/theory.md, equation (97r).
pub(super) fn tie_pose(
    covariance: &mut Covariance,
    places: StatePlaces,
    of: &EstimatedRobot,
    at: &Tangents,
    pose: &Pose,
    priors: &StatePriors,
) -> Option<Vec<f64>> {
    let n = places.size();
    let factor = at.stiffness.lu();
    let mut motion = vec![0.0; 12 * n];
    let mut put = |place: usize, wrench: &Vec6| -> Option<()> {
        let by = factor.solve(&of.allowed(wrench))?;
        (0..6).for_each(|k| motion[k * n + place] = by[k]);
        Some(())
    };
    for k in 0..6 {
        put(StatePlaces::WRENCH + k, &Vec6::from_fn(|i, _| if i == k { 1.0 } else { 0.0 }))?;
    }
    let gravity = &of.robot.gravity_w;
    put(StatePlaces::PAYLOAD, &gravity_of(gravity, 1.0, &Vec3::zeros()))?;
    for k in 0..3 {
        let axis = pose.rot_wp * Vec3::ith(k, 1.0);
        put(StatePlaces::FIRST_MOMENT + k, &gravity_of(gravity, 0.0, &axis))?;
    }
    for i in 0..places.cables {
        let by_length = at.wrench_by_length(i);
        put(StatePlaces::OFFSETS + i, &by_length)?;
        put(places.encoder_errors() + i, &by_length)?;
    }

    let decay = vec![1.0; n];
    covariance.propagate(&motion, &decay, &super::exponential::Mat12::zeros());
    let allowed = |first: usize| {
        of.allowed(&Vec6::from_fn(|k, _| match (first, k) {
            (0, 0..3) | (3, 3..6) => 1.0,
            _ => 0.0,
        }))
    };
    for (first, std) in [(0, priors.velocity), (3, priors.angular_velocity)] {
        let moves = allowed(first);
        for k in first..first + 3 {
            let can_move = if moves[k].abs() > 0.0 { 1.0 } else { 0.0 };
            covariance.put(StatePlaces::VELOCITY + k, StatePlaces::VELOCITY + k, can_move * std * std);
        }
    }
    Some(motion)
}
