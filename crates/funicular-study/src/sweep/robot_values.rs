//! Robots that differ in values of their file, as points of a sweep.

use crate::set_values::{self, Assignment};
use crate::sweep::{Column, Kind, Point, Points, Steps, digits};
use funicular::robot::Robot;
use std::borrow::Cow;

/// One value of the robot file that varies.
#[derive(Debug, Clone, PartialEq)]
pub struct ValueAxis {
    /// Path of the value in the robot file.
    pub path: set_values::Path,
    /// The values.
    pub steps: Steps,
}

impl ValueAxis {
    /// An axis from the text of its path and its values.
    ///
    /// # Errors
    /// A text that is no path.
    pub fn new(path: &str, steps: Steps) -> Result<Self, String> {
        Ok(Self { path: set_values::path(path)?, steps })
    }
}

/// Name of the option in messages.
const OPTION: &str = "⟪vary⟫";

/// Changes of a robot that was read: the state and the loads of a request.
type Adjust = Box<dyn Fn(Robot) -> Result<Robot, String> + Send + Sync>;

/// All combinations of values of a robot file; the first varies fastest.
pub struct RobotValues {
    text: String,
    axes: Vec<ValueAxis>,
    adjust: Adjust,
}

impl RobotValues {
    /// Takes the text of a robot file, values that vary in it, and changes of every robot after it was read.
    ///
    /// # Errors
    /// A text for the user: a value that varies twice, an end of one of the variations alone that makes no robot, or a
    /// value that changes nothing, since what is done to every robot sets it, too.
    pub fn new(text: String, axes: Vec<ValueAxis>, adjust: Adjust) -> Result<Self, String> {
        for (i, axis) in axes.iter().enumerate() {
            if axes[..i].iter().any(|other| other.path.is_same(&axis.path)) {
                return Err(format!("{OPTION} {} is given twice", axis.path.text));
            }
            if let Some(value) = axis.steps.repeated() {
                return Err(format!("{OPTION} {} has the value {value} twice: leave one out", axis.path.text));
            }
        }
        let variations = Self { text, axes, adjust };
        for axis in &variations.axes {
            let tried = match &axis.steps {
                Steps::Range { from, to, .. } => vec![*from, *to],
                Steps::List(values) => values.clone(),
            };
            let mut first = None;
            let (mut values_differ, mut robots_differ) = (false, false);
            for value in tried {
                let robot = variations.robot(&[axis.path.with(OPTION, value)])?;
                let (of_first, first) = first.get_or_insert_with(|| (value.to_bits(), robot.clone()));
                values_differ |= *of_first != value.to_bits();
                robots_differ |= *first != robot;
            }
            if values_differ && !robots_differ {
                return Err(format!(
                    "{OPTION} {} changes nothing: no part of the robot uses this value, or another option sets it; leave one of \
                     them out",
                    axis.path.text
                ));
            }
        }
        Ok(variations)
    }

    /// The values that vary.
    pub fn axes(&self) -> &[ValueAxis] {
        &self.axes
    }

    /// The robot of the first point.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn first(&self) -> Result<Robot, String> {
        self.robot(&self.at(0).1)
    }

    fn robot(&self, assignments: &[Assignment]) -> Result<Robot, String> {
        let text = set_values::apply(&self.text, assignments).map_err(|error| error.to_string())?;
        let robot = Robot::from_toml(&text).map_err(|error| {
            let set: Vec<&str> = assignments.iter().map(Assignment::text).collect();
            let help = error.issues().first().and_then(|issue| issue.help.as_deref());
            let help = help.map_or_else(String::new, |help| format!("; {help}"));
            format!("with {}: {error}{help}", set.join(" and "))
        })?;
        (self.adjust)(robot)
    }

    fn at(&self, i: usize) -> (Vec<f64>, Vec<Assignment>) {
        let digits = digits(i, self.axes.iter().map(|axis| axis.steps.count()));
        digits
            .zip(&self.axes)
            .map(|(digit, axis)| {
                let value = axis.steps.at(digit);
                (value, axis.path.with(OPTION, value))
            })
            .unzip()
    }
}

impl Points for RobotValues {
    fn count(&self) -> usize {
        self.axes.iter().fold(1, |count, axis| count.saturating_mul(axis.steps.count()))
    }

    fn columns(&self) -> Vec<Column> {
        self.axes
            .iter()
            .map(|axis| Column {
                name: axis.path.text.clone(),
                unit: unit(axis.path.last()).into(),
                about: "value of the robot file".to_owned(),
                kind: Kind::Real,
            })
            .collect()
    }

    fn point(&self, i: usize) -> Point<'_> {
        let (coordinates, assignments) = self.at(i);
        let robot = self.robot(&assignments).map(|robot| {
            let state = robot.state.clone();
            (Cow::Owned(robot), Cow::Owned(state))
        });
        Point { coordinates, robot }
    }
}

/// The unit that ends the name of a key; the longest that fits.
fn unit(key: &str) -> &'static str {
    const UNITS: [(&str, &str); 16] = [
        ("_n_per_m", "N/m"),
        ("_n_s_m", "N s/m"),
        ("_n_m_s", "N m s"),
        ("_n_s_m2", "N s/m2"),
        ("_kg_m3", "kg/m3"),
        ("_kg_per_m", "kg/m"),
        ("_kg_m2", "kg m2"),
        ("_m_s2", "m/s2"),
        ("_n_m", "N m"),
        ("_m2", "m2"),
        ("_pa", "Pa"),
        ("_kg", "kg"),
        ("_hz", "Hz"),
        ("_deg", "deg"),
        ("_n", "N"),
        ("_m", "m"),
    ];
    UNITS.iter().find(|(ending, _)| key.ends_with(ending)).map_or("1", |(_, unit)| unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_is_the_one_that_ends_the_key() {
        for (key, expected) in [
            ("mass_kg", "kg"),
            ("mass_kg_per_m", "kg/m"),
            ("diameter_m", "m"),
            ("drag_area_m2", "m2"),
            ("load_n_per_m", "N/m"),
            ("axial_stiffness_n", "N"),
            ("youngs_modulus_pa", "Pa"),
            ("translational_damping_n_s_m", "N s/m"),
            ("rotational_damping_n_m_s", "N m s"),
            ("viscous_damping_n_s_m2", "N s/m2"),
            ("damping_ratio", "1"),
        ] {
            assert_eq!(unit(key), expected, "{key}");
        }
    }

    #[test]
    fn a_value_that_another_option_sets_and_one_given_twice_are_refused() {
        let text = funicular_robots::YUAN2014_4MM;
        let varied = |paths: &[&str], mass: Option<f64>| {
            let steps = Steps::range(10.0, 20.0, 3).unwrap();
            let axes = paths.iter().map(|path| ValueAxis::new(path, steps.clone()).unwrap());
            let adjust = Box::new(move |robot: Robot| Ok(mass.map_or(robot.clone(), |mass| robot.with_mass(mass))));
            RobotValues::new(text.to_owned(), axes.collect(), adjust).err()
        };
        let path = "platform.mass_kg";
        assert_eq!(varied(&[path], None), None);
        assert!(
            varied(&[path], Some(15.0))
                .unwrap()
                .contains("changes nothing: no part of the robot uses this value, or another option sets it")
        );
        assert!(varied(&[path, "platform.\"mass_kg\""], None).unwrap().contains("given twice"));
        assert!(varied(&["platform.mas_kg"], None).unwrap().contains("did you mean `mass_kg`?"));
    }
}
