//! Robots that differ in values of their file, as points of a sweep.

use crate::edit::{self, Assignment};
use funicular::robot::Robot;
use funicular::sweep::{Column, Kind, Point, Points, Steps, digits};
use std::borrow::Cow;

/// One value of the robot file that varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Variation {
    /// Where it is.
    pub path: edit::Path,
    /// What it is, in turn.
    pub steps: Steps,
}

/// What is done to a robot after it was read, as a whole.
type Adjust<'a> = Box<dyn Fn(Robot) -> Result<Robot, String> + Send + Sync + 'a>;

/// All combinations of values of a robot file; the first varies fastest.
pub struct Variations<'a> {
    text: String,
    axes: Vec<Variation>,
    /// What the user calls it, for messages.
    option: &'static str,
    adjust: Adjust<'a>,
}

impl<'a> Variations<'a> {
    /// Of the text of a robot file, values that vary in it (as the user's `option` asked), and what is done to every robot
    /// after it was read.
    ///
    /// # Errors
    /// A text for the user, if an end of one of the variations alone makes no robot.
    pub fn new(text: String, axes: Vec<Variation>, option: &'static str, adjust: Adjust<'a>) -> Result<Self, String> {
        for (i, axis) in axes.iter().enumerate() {
            if axes[..i].iter().any(|other| other.path.text == axis.path.text) {
                return Err(format!("{option} {} is given twice", axis.path.text));
            }
        }
        let variations = Self { text, axes, option, adjust };
        for axis in &variations.axes {
            let tried = match &axis.steps {
                Steps::Range { from, to, .. } => vec![*from, *to],
                Steps::List(values) => values.clone(),
            };
            for value in tried {
                variations.robot(&[axis.path.with(option, value)])?;
            }
        }
        Ok(variations)
    }

    /// The values that vary.
    pub fn axes(&self) -> &[Variation] {
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
        let text = edit::apply(&self.text, assignments).map_err(|error| error.to_string())?;
        let robot = Robot::from_toml(&text).map_err(|error| {
            let set: Vec<&str> = assignments.iter().map(Assignment::text).collect();
            format!("with {}: {error}", set.join(" and "))
        })?;
        (self.adjust)(robot)
    }

    fn at(&self, i: usize) -> (Vec<f64>, Vec<Assignment>) {
        let digits = digits(i, self.axes.iter().map(|axis| axis.steps.count()));
        digits
            .zip(&self.axes)
            .map(|(digit, axis)| {
                let value = axis.steps.at(digit);
                (value, axis.path.with(self.option, value))
            })
            .unzip()
    }
}

impl Points for Variations<'_> {
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
    const UNITS: [(&str, &str); 14] = [
        ("_n_s_per_m", "N s/m"),
        ("_n_m_s", "N m s"),
        ("_n_s_m2", "N s/m2"),
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
