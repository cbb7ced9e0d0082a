//! Rates of the unstrained lengths while the platform moves and its load changes.

use super::pullback::six;
use super::{GradientError, Gradients, Hold};
use crate::math::{Vec3, Vec6};
use crate::robot::{Robot, RobotChange};
use crate::statics::derivatives::StaticDerivativeError;
use crate::statics::{Equilibrium, StaticModel, TensionRule};

/// Derivatives of the unstrained lengths by the pose and by the load on the platform, while the tensions follow their
/// rule. They contain the change of sag and stretch, pulleys, and winches that yield.
///
/// # Example
/// ```
/// use funicular::gradient::LengthRates;
/// use funicular::math::Vec6;
/// use funicular::robot::Robot;
/// use funicular::statics::{self, StaticModel, TensionRule};
///
/// let robot = Robot::from_toml(funicular_robots::COGIRO)?;
/// let pose = statics::solve(&robot, StaticModel::Catenary, None)?.equilibrium.pose;
/// let rest = statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, &TensionRule::Lowest)?;
/// let rates = LengthRates::of(&robot, &rest, &TensionRule::Lowest)?;
/// let upwards = Vec6::new(0.0, 0.0, 0.5, 0.0, 0.0, 0.0); // m/s
/// assert!(rates.of_twist(&upwards).iter().all(|rate| *rate < 0.0)); // m/s; every cable gets shorter
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, equations (40z1) and (40z6).
#[derive(Debug, Clone, PartialEq)]
pub struct LengthRates {
    /// Per cable: by the translation of the platform's origin along the axes of the world [m/m], then by its rotation
    /// about them [m/rad].
    pub by_pose: Vec<Vec6>,
    /// Per cable: by the force of the load along the axes of the world [m/N], then by its moment about them [m/(N m)].
    pub by_load: Vec<Vec6>,
    /// Per cable: by the load per length of every cable in the order of the file, world axes [m/(N/m)].
    pub by_rope_load: Vec<Vec<Vec3>>,
}

impl LengthRates {
    /// Derivatives at an equilibrium whose tensions were chosen by a rule, if the cables left a choice.
    ///
    /// # Errors
    /// [`GradientError`], as for [`Gradients::by_rule`]; ideal cables have derivatives without flexible supports.
    pub fn of(robot: &Robot, rest: &Equilibrium, rule: &TensionRule) -> Result<Self, GradientError> {
        if rest.model == StaticModel::Ideal {
            return Self::of_ideal(robot, rest);
        }
        Ok(Self::of_lengths(&Gradients::by_rule(robot, rest, rule)?.lengths()))
    }

    /// Derivatives at an equilibrium whose tensions no rule has chosen: they change least along the cables, or, without
    /// a choice, as the loads ask.
    ///
    /// # Errors
    /// [`GradientError`], as for [`Gradients::new`] with the pose held.
    pub fn with_least_change(robot: &Robot, rest: &Equilibrium) -> Result<Self, GradientError> {
        if rest.model == StaticModel::Ideal {
            return Self::of_ideal(robot, rest);
        }
        Ok(Self::of_lengths(&Gradients::new(robot, rest, Hold::Pose)?.lengths()))
    }

    /// Derivatives in the gradients of the lengths.
    fn of_lengths(lengths: &[RobotChange]) -> Self {
        let by_pose = |of: &RobotChange| six(&of.position_w, &of.rotation_w);
        let by_load = |of: &RobotChange| six(&of.force_w, &of.moment_w);
        let by_rope_load = |of: &RobotChange| of.cables.iter().map(|cable| cable.load_per_length_w).collect();
        Self {
            by_pose: lengths.iter().map(by_pose).collect(),
            by_load: lengths.iter().map(by_load).collect(),
            by_rope_load: lengths.iter().map(by_rope_load).collect(),
        }
    }

    /// Derivatives of rigid straight cables: each gets shorter by the motion of its attachment along the pull.
    fn of_ideal(robot: &Robot, rest: &Equilibrium) -> Result<Self, GradientError> {
        if !robot.supports.is_empty() {
            return Err(StaticDerivativeError::Ideal.into());
        }
        let by_pose = rest.cables.iter().map(|cable| {
            let pull_w = cable.chord_w().normalize();
            robot.platform.motion.allowed(&six(&-pull_w, &-cable.lever_w.cross(&pull_w)))
        });
        let count = rest.cables.len();
        let (by_load, by_rope_load) = (vec![Vec6::zeros(); count], vec![vec![Vec3::zeros(); count]; count]);
        Ok(Self { by_pose: by_pose.collect(), by_load, by_rope_load })
    }

    /// Rate of each unstrained length [m/s] for a twist: velocity of the origin [m/s], then angular velocity [rad/s].
    pub fn of_twist(&self, twist_w: &Vec6) -> Vec<f64> {
        self.by_pose.iter().map(|of| of.dot(twist_w)).collect()
    }
}
