//! Which equilibrium is asked for: a state, models, limits and loads, checked as the program checks its options.

use crate::arrays::{Number, Numbers, Vector, finite, not_negative};
use crate::errors;
use crate::names;
use crate::pose::PyPose;
use funicular::math::Vec3;
use funicular::robot::{Freedoms, Load, LoadError, Pose, Robot, State, TensionLimits};
use funicular::statics::{StaticModel, TensionRule};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// All but the state.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Options {
    pub(crate) model: StaticModel,
    pub(crate) rule: Option<TensionRule>,
    pub(crate) limits: TensionLimits,
    pub(crate) force_n: Option<[f64; 3]>,
    pub(crate) moment_n_m: Option<[f64; 3]>,
    pub(crate) load_point_m: Option<[f64; 3]>,
}

/// The same as Python gives it.
pub(crate) struct Given<'a> {
    pub(crate) model: &'a str,
    pub(crate) tension_rule: Option<&'a str>,
    pub(crate) wanted_tension_n: Option<Numbers>,
    pub(crate) min_tension_n: Option<Number>,
    pub(crate) max_tension_n: Option<Number>,
    pub(crate) force_n: Option<Numbers>,
    pub(crate) moment_n_m: Option<Numbers>,
    pub(crate) load_point_m: Option<Numbers>,
}

impl Options {
    pub(crate) fn read(given: Given<'_>) -> PyResult<Self> {
        let wanted = given.wanted_tension_n.map(one_or_more).transpose()?;
        let three = |value: Option<Numbers>, what| value.map(|numbers| numbers.three(what)).transpose();
        Ok(Self {
            model: names::static_model(given.model)?,
            rule: names::tension_rule(given.tension_rule, wanted)?,
            limits: TensionLimits {
                minimum: given.min_tension_n.map(|value| value.not_negative("min_tension_n")).transpose()?,
                maximum: given.max_tension_n.map(|value| value.positive("max_tension_n")).transpose()?,
            },
            force_n: three(given.force_n, "force_n")?,
            moment_n_m: three(given.moment_n_m, "moment_n_m")?,
            load_point_m: three(given.load_point_m, "load_point_m")?,
        })
    }

    /// The robot with limits and loads.
    pub(crate) fn robot(&self, robot: &Robot) -> PyResult<Robot> {
        self.adjusted(robot).map_err(errors::input)
    }

    /// The same without Python's lock.
    pub(crate) fn adjusted(&self, robot: &Robot) -> Result<Robot, String> {
        let mut robot = robot.with_tension_limits(self.limits);
        for cable in &robot.cables {
            if let TensionLimits { minimum: Some(minimum), maximum: Some(maximum) } = cable.limits()
                && minimum >= maximum
            {
                return Err(format!(
                    "the least tension of cable \"{}\" is {minimum} N and its greatest {maximum} N: give min_tension_n \
                     below max_tension_n (what is not given is as the robot file says)",
                    cable.name
                ));
            }
        }
        let or = |given: Option<[f64; 3]>, of_file: Vec3| given.map_or(of_file, Vec3::from);
        robot.load = Load {
            force_w: or(self.force_n, robot.load.force_w),
            moment_w: or(self.moment_n_m, robot.load.moment_w),
            point_p: or(self.load_point_m, robot.load.point_p),
        };
        if self.load_point_m.is_some() && robot.load.force_w.norm() == 0.0 {
            return Err("`load_point_m` is where a force acts, and there is none: give `force_n`".to_owned());
        }
        robot.load.check(&robot.platform.freedoms).map_err(|error: LoadError| error.to_string())?;
        Ok(robot)
    }

    /// What [`Options::read`] reads this from, without what is not given.
    pub(crate) fn to_python(&self, into: &Bound<'_, PyDict>) -> PyResult<()> {
        into.set_item("model", self.model.name())?;
        match &self.rule {
            Some(TensionRule::Closest(wanted)) => {
                into.set_item("wanted_tension_n", wanted.iter().copied().collect::<Vector>())?;
            }
            Some(rule) => into.set_item("tension_rule", rule.name())?,
            None => {}
        }
        for (key, value) in [("min_tension_n", self.limits.minimum), ("max_tension_n", self.limits.maximum)] {
            if let Some(value) = value {
                into.set_item(key, value)?;
            }
        }
        for (key, value) in
            [("force_n", self.force_n), ("moment_n_m", self.moment_n_m), ("load_point_m", self.load_point_m)]
        {
            if let Some(value) = value {
                into.set_item(key, value)?;
            }
        }
        Ok(())
    }
}

/// Wanted tensions, one for all or one a cable.
fn one_or_more(numbers: Numbers) -> PyResult<Vec<f64>> {
    let (values, _) = numbers.one_or_row("wanted_tension_n")?;
    for &value in &values {
        not_negative("wanted_tension_n", value)?;
    }
    Ok(values)
}

/// The state asked.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Asked {
    /// As the robot file says.
    OfFile,
    Pose(Pose),
    Lengths(Vec<f64>),
}

impl Asked {
    pub(crate) fn read(pose: Option<Pose>, lengths: Option<Numbers>) -> PyResult<Self> {
        match (pose, lengths) {
            (Some(_), Some(_)) => Err(errors::input("give `pose` or `lengths`, not both".to_owned())),
            (Some(pose), None) => Ok(Self::Pose(pose)),
            (None, Some(lengths)) => {
                let lengths = lengths.row("lengths")?;
                for &length in &lengths {
                    finite("lengths", length)?;
                }
                Ok(Self::Lengths(lengths))
            }
            (None, None) => Ok(Self::OfFile),
        }
    }

    /// The robot in this state.
    pub(crate) fn robot(&self, robot: Robot) -> PyResult<Robot> {
        self.put(robot).map_err(errors::input)
    }

    /// The same without Python's lock.
    pub(crate) fn put(&self, mut robot: Robot) -> Result<Robot, String> {
        match self {
            Self::OfFile => {}
            Self::Pose(pose) => {
                check_pose(&robot, pose)?;
                robot.state = State::Pose(*pose);
            }
            Self::Lengths(lengths) => robot.state = State::Lengths(lengths.clone()),
        }
        Ok(robot)
    }

    pub(crate) fn to_python(&self, into: &Bound<'_, PyDict>) -> PyResult<()> {
        match self {
            Self::OfFile => Ok(()),
            Self::Pose(pose) => into.set_item("pose", PyPose(*pose)),
            Self::Lengths(lengths) => into.set_item("lengths", lengths.iter().copied().collect::<Vector>()),
        }
    }
}

/// Whether a platform can have a pose at all.
pub(crate) fn check_pose(robot: &Robot, pose: &Pose) -> Result<(), String> {
    let freedoms = &robot.platform.freedoms;
    if *freedoms == Freedoms::PointMass && pose.rot_wp.angle() != 0.0 {
        return Err("a point mass has no orientation: give x, y, z".to_owned());
    }
    freedoms.check(pose).map_err(|error| error.to_string())
}
