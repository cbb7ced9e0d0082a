//! Gradients: derivatives of a result by every number of the robot at once, in reverse.
//!
//! Every result is a scalar of the state at rest: forces, lever arms, chords, loads and lengths of the cables, arms and
//! tensors of the platform. Its coefficients over that state are followed back through the cables' partial derivatives
//! to the numbers of the robot. The pose or the lengths adapt to a change of the robot; this costs one linear solve per
//! result, whatever the number of parameters is. Quantities of vibration get their coefficients from the quadratic form
//! of the dynamic stiffness. This form is stationary in the motion, so no mode is differentiated (docs/theory.md,
//! section 17).
//!
//! The derivative along one direction is the product with it, [`RobotChange::dot`]; the direction of a number of the
//! robot file is [`Parameters::change`](crate::robot::parameters::Parameters::change).

mod adjoint;
mod at_limits;
mod cable_form;
mod centre;
mod drive_form;
mod end_form;
mod length_rates;
mod load_factor;
mod parallel_tension;
mod pullback;
mod robot_form;
mod rule;
mod scalar;
mod support_form;
mod supports;
mod vibration;

pub use length_rates::LengthRates;
pub use load_factor::LoadFactorGradient;
pub use vibration::{DampedGradient, ResponseDerivatives, VibrationGradients};

use crate::cable::CableModel;
use crate::cable::catenary_dynamic::CatenaryDynamicError;
use crate::drive::derivatives::end;
use crate::dynamics::{Dynamics, DynamicsError};
use crate::math::{Vec3, Vec6, symmetric};
use crate::platform::Coordinates;
use crate::robot::{Robot, RobotChange};
use crate::statics::derivatives::{StaticDerivativeError, force_at_anchor, load_of};
use crate::statics::{Equilibrium, Limit, StaticsError, TensionRule, tangent_stiffness};
use adjoint::Adjoint;
use pullback::Pullback;
use robot_form::{Driven, RobotForm};
use thiserror::Error;

/// Quantity that is held while a number of the robot changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Hold {
    /// The unstrained lengths are held, apart from their own change, and the pose adapts.
    #[default]
    Lengths,
    /// The pose is held, apart from its own change, and the unstrained lengths adapt. With redundant cables the change
    /// of the parallel tensions, (10a), is minimum: the sum of the squares of the changes.
    Pose,
    /// The pose is held, apart from its own change, and the unstrained lengths follow the rule of the tension
    /// distribution; see [`Gradients::by_rule`]. It is equal to [`Self::Pose`] if there are as many cables as degrees
    /// of freedom.
    Rule,
}

impl Hold {
    /// All choices.
    pub const ALL: [Self; 3] = [Self::Lengths, Self::Pose, Self::Rule];

    /// Name in requests and results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lengths => "lengths",
            Self::Pose => "pose",
            Self::Rule => "rule",
        }
    }
}

/// Reason why a result has no gradient.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum GradientError {
    /// The equilibrium has no derivatives.
    #[error(transparent)]
    Static(#[from] StaticDerivativeError),
    /// The robot cannot be linearised as it is.
    #[error(transparent)]
    Dynamics(#[from] DynamicsError),
    /// The parallel tension of a vertical cable with weight is not differentiated.
    #[error(
        "cable \"{cable}\" is parallel to its load: with the pose held, the rule for more cables than degrees of \
         freedom needs the derivative of its parallel tension, which is not known there; hold the lengths, or choose a \
         pose beside this one"
    )]
    Vertical {
        /// Name of the cable.
        cable: String,
    },
    /// The rule of the tension distribution is not known.
    #[error(
        "the derivatives of tensions that follow a rule need the rule: give it, or hold the pose with tensions that \
         change least"
    )]
    NoRule,
    /// The rule has no derivatives here.
    #[error(
        "tensions by the rule `stiffest` have no derivatives here: choose the rule `centre`, `closest` or `lowest`, or \
         hold the pose with tensions that change least"
    )]
    Stiffest,
    /// The equilibrium is not that of the rule.
    #[error(
        "the tension of cable \"{cable}\" does not follow the rule `{rule}`: distribute the tensions by this rule \
         first, or hold the lengths"
    )]
    NotByRule {
        /// Name of the rule.
        rule: &'static str,
        /// Name of the cable.
        cable: String,
    },
    /// The rule has different derivatives on both sides.
    #[error(
        "the tensions by the rule `{rule}` have different derivatives on both sides of this robot: {}; change the \
         pose, the target or a limit a little, or hold the pose with tensions that change least",
        one_sided(cable, *limit)
    )]
    OneSided {
        /// Name of the rule.
        rule: &'static str,
        /// Name of the cable.
        cable: String,
        /// Limit at which the tension of the cable is without pressing against it, if that is the reason.
        limit: Option<Limit>,
    },
    /// The pose has no load factor.
    #[error(transparent)]
    LoadFactor(#[from] StaticsError),
    /// The load factor is infinite.
    #[error(
        "no maximum tension limits the load factor, so that it has no derivatives: give `maximum_tension_n` or \
         `breaking_load_n`"
    )]
    UnlimitedLoadFactor,
    /// Another load or limit binds on the other side.
    #[error(
        "the load factor has different derivatives on both sides of this pose: {}; change the pose a little",
        one_sided(cable, *limit)
    )]
    OneSidedLoadFactor {
        /// Name of the cable.
        cable: String,
        /// Limit at which the tension of the cable is without pressing against it, if that is the reason.
        limit: Option<Limit>,
    },
    /// The required wind bends the cables.
    #[error(
        "the required wind acts on the ropes, which have a `drag_coefficient`: the load factor has derivatives with \
         wind on the platform alone; leave the load factor out, or `wind_speed_m_s` in [required]"
    )]
    LoadFactorInWind,
    /// Supports settle under the tensions at the limit.
    #[error(
        "cable \"{cable}\" is on a flexible support: the load factor has derivatives on a rigid frame; leave the \
         load factor out, or hold the support by a stiff one"
    )]
    LoadFactorAndSupports {
        /// Name of the cable.
        cable: String,
    },
    /// A minimum tension by default is not differentiated for straight cables.
    #[error(
        "cable \"{cable}\": its minimum tension is the default, a multiple of its weight, which straight cables do not \
         have: give `minimum_tension_n`, or use the static model `catenary`"
    )]
    DefaultMinimum {
        /// Name of the cable.
        cable: String,
    },
    /// A rule chooses the tensions of cables on flexible supports.
    #[error(
        "cable \"{cable}\" is on a flexible support: tensions that follow their rule have derivatives on a rigid \
         frame; hold the lengths or the pose instead"
    )]
    RuleAndSupports {
        /// Name of the cable.
        cable: String,
    },
    /// Gradients are not implemented for this cable model.
    #[error(
        "gradients of vibrations need the cable model `spring`, `catenary-static` or `catenary-dynamic`, not `{0}`"
    )]
    Model(CableModel),
    /// Terms of the stiffness are left out.
    #[error("gradients of vibrations need all terms of the stiffness: assembly `consistent`, in and out of plane")]
    Terms,
    /// The minimum stiffness in wind contains the turn of the drag.
    #[error("the drag of the wind turns with the cables: the stiffness has no gradient there")]
    DragTurns,
    /// The minimum stiffness is shared by several motions.
    #[error("{multiplicity} motions share the minimum stiffness: it has no single derivative")]
    MultipleStiffness {
        /// Number of motions.
        multiplicity: usize,
    },
    /// Several modes share the frequency, so that it has several derivatives.
    #[error(
        "{multiplicity} modes share the frequency {frequency_hz} Hz: it has no single derivative, but a block of them"
    )]
    Multiple {
        /// Frequency [Hz].
        frequency_hz: f64,
        /// Number of modes.
        multiplicity: usize,
    },
    /// The zero of the damped dynamic stiffness is not simple, or the model has no motion.
    #[error("the damped frequency {frequency_hz} Hz belongs to no single motion: it has no gradient")]
    NoDampedMotion {
        /// Frequency [Hz].
        frequency_hz: f64,
    },
    /// An input or output is not on the platform.
    #[error("gradients of responses need inputs and outputs on the platform, or at a drive: `length`, `motor`, `drum`")]
    NotOnPlatform,
    /// A cable has no such signal of its drive, or none with gradients.
    #[error(
        "cable \"{cable}\" has no gradients of the signal `{signal}`: `length` needs a cable with a drum side or a \
         winch that yields, `drum` and `motor` one that can move; choose another signal"
    )]
    NoDriveSignal {
        /// Name of the cable.
        cable: String,
        /// Name of the signal.
        signal: &'static str,
    },
    /// The robot is undamped and the frequency is a natural one.
    #[error(
        "the response at {frequency_hz} Hz is not finite: an undamped natural frequency lies there; give the ropes \
         damping or choose other frequencies"
    )]
    Resonance {
        /// Frequency [Hz].
        frequency_hz: f64,
    },
    /// A cable has no catenary-dynamic stiffness.
    #[error("cable \"{cable}\": {reason}")]
    CatenaryDynamic {
        /// Name of the cable.
        cable: String,
        /// Reason.
        reason: CatenaryDynamicError,
    },
}

/// Reason why a rule has different derivatives on both sides.
fn one_sided(cable: &str, limit: Option<Limit>) -> String {
    match limit {
        Some(limit) => {
            format!("cable \"{cable}\" is at its {} tension, but the limit does not change the tensions", limit.name())
        }
        None => format!("too many or too few cables, cable \"{cable}\" among them, hold the optimum"),
    }
}

/// Maximum difference of two stiffnesses, relative to the largest one, at which they count as equal.
const MULTIPLE_STIFFNESS: f64 = 1e-9;

/// Gradients of the results of an equilibrium. Each gradient has the derivative of a result by every number of the
/// robot: units of the result per SI unit of the field.
///
/// # Example
/// ```
/// use funicular::gradient::{Gradients, Hold};
/// use funicular::robot::{Robot, parameters::Parameters};
/// use funicular::statics::{self, StaticModel};
///
/// let parameters = Parameters::from_toml(funicular_robots::COGIRO)?;
/// let robot = parameters.robot();
/// let rest = statics::solve(robot, StaticModel::Catenary, None)?.equilibrium;
/// let gradients = Gradients::new(robot, &rest, Hold::Lengths)?;
///
/// let tension = &gradients.tensions_platform()[0];
/// assert!(tension.mass > 0.0); // N/kg
/// let modulus = parameters.find(&["materials", "rope", "axial_stiffness_n"]);
/// if let Some(change) = modulus.and_then(|index| parameters.change(index)) {
///     assert!(tension.dot(&change).is_finite()); // N per N of EA in all cables
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, equations (60a) to (60h).
pub struct Gradients<'a> {
    hold: Hold,
    pullback: Pullback<'a>,
}

impl<'a> Gradients<'a> {
    /// Prepares the gradients of an equilibrium.
    ///
    /// # Errors
    /// [`GradientError::Static`]: ideal or slack cables, an indifferent equilibrium, too few cables to hold the pose;
    /// [`GradientError::Vertical`]; [`GradientError::NoRule`] for [`Hold::Rule`], which needs [`Self::by_rule`].
    pub fn new(robot: &'a Robot, equilibrium: &'a Equilibrium, hold: Hold) -> Result<Self, GradientError> {
        if hold == Hold::Rule {
            return Err(GradientError::NoRule);
        }
        Ok(Self { hold, pullback: Pullback::new(robot, equilibrium, hold, None)? })
    }

    /// Prepares the gradients of an equilibrium whose pose is held, with tensions that follow the rule by which
    /// [`distribute_tensions`](crate::statics::distribute_tensions) has chosen them. The limits that are reached stay
    /// reached: the derivatives are those between two changes of this set.
    ///
    /// # Errors
    /// The errors of [`Self::new`]; [`GradientError::Stiffest`], [`GradientError::NotByRule`],
    /// [`GradientError::OneSided`], [`GradientError::DefaultMinimum`].
    ///
    /// # Example
    /// ```
    /// use funicular::gradient::Gradients;
    /// use funicular::robot::{Robot, RobotChange};
    /// use funicular::statics::{self, StaticModel, TensionRule};
    ///
    /// let robot = Robot::from_toml(funicular_robots::COGIRO)?;
    /// let rule = TensionRule::Closest(vec![350.0]);
    /// let pose = statics::solve(&robot, StaticModel::Catenary, None)?.equilibrium.pose;
    /// let tension = |robot: &Robot| -> Result<f64, statics::StaticsError> {
    ///     Ok(statics::distribute_tensions(robot, &pose, StaticModel::Catenary, &rule)?.cables[0].tension_platform)
    /// };
    /// let rest = statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, &rule)?;
    /// let by_mass = Gradients::by_rule(&robot, &rest, &rule)?.tensions_platform()[0].mass; // N/kg
    ///
    /// let change = RobotChange::of_mass(&robot);
    /// let difference = (tension(&robot.changed(&change, 0.01))? - tension(&robot.changed(&change, -0.01))?) / 0.02;
    /// assert!((by_mass - difference).abs() < 1e-6 * difference.abs());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # References
    /// docs/theory.md, equations (60r) to (60t3).
    pub fn by_rule(robot: &'a Robot, equilibrium: &'a Equilibrium, rule: &TensionRule) -> Result<Self, GradientError> {
        Ok(Self { hold: Hold::Rule, pullback: Pullback::new(robot, equilibrium, Hold::Rule, Some(rule))? })
    }

    /// Quantity that is held constant.
    pub fn hold(&self) -> Hold {
        self.hold
    }

    fn robot(&self) -> &'a Robot {
        self.pullback.robot
    }

    /// Equilibrium to which the gradients belong.
    pub fn equilibrium(&self) -> &'a Equilibrium {
        self.pullback.equilibrium
    }

    /// Gradient of the scalar whose coefficients `set` writes.
    fn of(&self, set: impl FnOnce(&mut Adjoint<f64>)) -> RobotChange {
        let mut scalar = Adjoint::zeros(self.robot().cables.len());
        set(&mut scalar);
        self.pullback.gradient(&scalar)
    }

    /// Gradients of the pose: translation of the origin along the axes of the world [m], then the rotation vector about
    /// them [rad].
    pub fn pose(&self) -> [RobotChange; 6] {
        std::array::from_fn(|k| {
            self.of(|scalar| {
                let part = if k < 3 { &mut scalar.translation } else { &mut scalar.rotation };
                part[k % 3] = 1.0;
            })
        })
    }

    /// Gradients of the unstrained lengths [m], in file order.
    pub fn lengths(&self) -> Vec<RobotChange> {
        (0..self.robot().cables.len()).map(|i| self.of(|scalar| scalar.cables[i].length = 1.0)).collect()
    }

    /// Gradient of the sum of the unstrained lengths [m].
    pub fn rope_length(&self) -> RobotChange {
        self.of(|scalar| scalar.cables.iter_mut().for_each(|cable| cable.length = 1.0))
    }

    /// Gradient of the mass of all ropes, Σ μ L [kg].
    pub fn rope_mass(&self) -> RobotChange {
        let cables = &self.robot().cables;
        let mut mass = self.of(|scalar| {
            for (of, cable) in scalar.cables.iter_mut().zip(cables) {
                of.length = cable.material.mass_per_length;
            }
        });
        for (of, state) in mass.cables.iter_mut().zip(&self.equilibrium().cables) {
            of.mass_per_length += state.unstrained_length;
        }
        mass
    }

    /// Gradients of the tensions at the platform ends [N], in file order.
    pub fn tensions_platform(&self) -> Vec<RobotChange> {
        let states = self.equilibrium().cables.iter().enumerate();
        states
            .map(|(i, state)| self.of(|scalar| scalar.cables[i].force = state.force_on_platform_w.normalize().into()))
            .collect()
    }

    /// Gradients of the tensions at the anchors [N], with a pulley at the exit point, in file order: the magnitude of
    /// N = f − S q, S being the unstrained length of the free span.
    pub fn tensions_anchor(&self) -> Vec<RobotChange> {
        let states = self.equilibrium().cables.iter().enumerate();
        states
            .map(|(i, state)| {
                let direction_w: Vec3 = force_at_anchor(state).normalize();
                self.of(|scalar| {
                    let cable = &mut scalar.cables[i];
                    cable.force = direction_w.into();
                    cable.load = (direction_w * -state.free_length()).into();
                    cable.free_length = -direction_w.dot(&load_of(state));
                })
            })
            .collect()
    }

    /// Gradients of the tensions at the drums [N], in file order; without a drive those at the anchors.
    pub fn tensions_drum(&self) -> Vec<RobotChange> {
        let mut all = self.tensions_anchor();
        for (i, (gradient, state)) in all.iter_mut().zip(&self.equilibrium().cables).enumerate() {
            if state.drive.is_some() {
                *gradient = self.of(|scalar| scalar.cables[i].end[end::TENSION_DRUM] = 1.0);
            }
        }
        all
    }

    /// Gradient of an entry of the tangent stiffness about the origin of the platform, world axes [N/m, N, N·m], (14).
    ///
    /// # Errors
    /// [`GradientError`], as for any form.
    pub fn tangent_entry(&self, row: usize, column: usize) -> Result<RobotChange, GradientError> {
        let unit = |k: usize| {
            let mut motion = [[0.0; 3]; 2];
            motion[k / 3][k % 3] = 1.0;
            motion
        };
        self.of_static_form(unit(row), unit(column), 0.0)
    }

    /// Gradient of the minimum eigenvalue of the scaled stiffness, the
    /// [`min_stiffness`](crate::statics::Stability::min_stiffness) [N/m].
    ///
    /// # Errors
    /// [`GradientError::DragTurns`], [`GradientError::MultipleStiffness`].
    pub fn min_stiffness(&self) -> Result<RobotChange, GradientError> {
        let (robot, equilibrium) = (self.robot(), self.equilibrium());
        if robot.wind_turns_with_cables() {
            return Err(GradientError::DragTurns);
        }
        let stiffness = tangent_stiffness(robot, equilibrium).ok_or(StaticDerivativeError::Ideal)?;
        let coordinates = Coordinates::of(robot);
        let n = coordinates.count();
        let (values, vectors) = symmetric::eigen(&coordinates.reduce_symmetric(&stiffness), n);
        let lowest = (0..n).min_by(|a, b| values[*a].total_cmp(&values[*b])).unwrap_or(0);
        let largest = values.iter().take(n).fold(0.0_f64, |largest, value| largest.max(value.abs()));
        let near = |value: &&f64| (**value - values[lowest]).abs() <= MULTIPLE_STIFFNESS * largest;
        let multiplicity = values.iter().take(n).filter(near).count();
        if multiplicity > 1 {
            return Err(GradientError::MultipleStiffness { multiplicity });
        }
        self.of_eigenvalue(&coordinates, values[lowest], &vectors[lowest])
    }

    /// Eigenvalues of the scaled stiffness [N/m], ascending, each with its gradient. Those that several motions share
    /// have the gradients of orthogonal motions among these, which are no derivatives of the sorted values.
    ///
    /// # Errors
    /// [`GradientError::DragTurns`].
    pub fn stiffnesses(&self) -> Result<Vec<(f64, RobotChange)>, GradientError> {
        let (robot, equilibrium) = (self.robot(), self.equilibrium());
        if robot.wind_turns_with_cables() {
            return Err(GradientError::DragTurns);
        }
        let stiffness = tangent_stiffness(robot, equilibrium).ok_or(StaticDerivativeError::Ideal)?;
        let coordinates = Coordinates::of(robot);
        let (values, vectors) = symmetric::eigen(&coordinates.reduce_symmetric(&stiffness), coordinates.count());
        let found = values.iter().zip(&vectors).take(coordinates.count());
        found.map(|(value, vector)| Ok((*value, self.of_eigenvalue(&coordinates, *value, vector)?))).collect()
    }

    /// Gradient of an eigenvalue of the scaled stiffness with this vector.
    fn of_eigenvalue(
        &self,
        coordinates: &Coordinates,
        value: f64,
        vector: &Vec6,
    ) -> Result<RobotChange, GradientError> {
        // Rotations are divided by ℓ, which the attachments change.
        let motion = coordinates.expand(vector);
        let ell = coordinates.ell();
        let translation = [motion[0], motion[1], motion[2]];
        let scaled = [motion[3], motion[4], motion[5]];
        let turning: f64 = scaled.iter().map(|turn| turn * turn).sum();
        let motion = [translation, scaled.map(|turn| turn / ell)];
        self.of_static_form(motion, motion, -2.0 * value * turning / ell)
    }

    /// Gradient of the static form over two motions (translation, rotation), with a coefficient of ℓ.
    fn of_static_form(&self, a: [[f64; 3]; 2], b: [[f64; 3]; 2], ell: f64) -> Result<RobotChange, GradientError> {
        let form = RobotForm::of_statics((self.robot(), self.pullback.settled()), self.equilibrium())?;
        let at = form.undamped(0.0);
        let [a, b] = [a, b].map(|[v, theta]| {
            let supports = form.supports.as_ref().map_or_else(Vec::new, |supports| supports.at_rest(&v, &theta));
            form.motion(v, theta, &at, &[], &Driven { supports: &supports, near: &[], forces: None })
        });
        Ok(self.of(|scalar| {
            form.add(scalar, &a, &b, &at, 1.0);
            scalar.ell = ell;
        }))
    }

    /// Prepares gradients of vibrations about this equilibrium.
    ///
    /// # Errors
    /// [`GradientError::Model`], [`GradientError::Terms`], [`GradientError::CatenaryDynamic`].
    pub fn vibration<'g>(&'g self, dynamics: &'g Dynamics) -> Result<VibrationGradients<'g>, GradientError> {
        VibrationGradients::new(self, dynamics)
    }
}
