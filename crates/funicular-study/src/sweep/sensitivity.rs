//! Derivatives of quantities by a number of the robot file, as quantities of maps and sweeps.

use super::evaluation::PointEvaluation;
use super::status::Status;
use crate::measure::{self, Measure};
use crate::set_values::{self, ValuePath};
use crate::table::{Column, Value};
use funicular::gradient::{GradientError, Gradients};
use funicular::modes;
use funicular::robot::{Robot, RobotChange};
use funicular::suggest::nearest;
use std::fmt::Display;

/// Quantity of the first natural frequency.
const FIRST_FREQUENCY: &str = "first-frequency";

/// Names of the quantities that can be differentiated: the first natural frequency, and the measures of the robot at
/// rest.
fn results() -> impl Iterator<Item = &'static str> {
    let at_rest = measure::of_robot().map(|of| of.key).chain(measure::of_cables().map(|of| of.key));
    std::iter::once(FIRST_FREQUENCY).chain(at_rest)
}

/// Derivative of a quantity by a number of the robot file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sensitivity {
    result: &'static str,
    path: ValuePath,
}

impl Sensitivity {
    /// Example of a parameter.
    pub(super) const EXAMPLE: &'static str = "first-frequency:platform.mass_kg";

    /// Derivative from `RESULT:PATH`.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let (result, path) = text.split_once(':')?;
        let result = results().find(|name| *name == result)?;
        Some(Self { result, path: set_values::path(path).ok()? })
    }

    /// End of the message about a name that is no derivative.
    pub(super) fn hint(text: &str) -> String {
        let mut parts = text.splitn(3, ':').skip(1);
        if let (Some(result), Some(path)) = (parts.next(), parts.next())
            && !results().any(|name| name == result)
            && let Some(near) = nearest(result, results())
        {
            return format!("; did you mean `sensitivity:{near}:{path}`?");
        }
        let names: Vec<&str> = results().collect();
        format!(
            ": give a result and the path of a number after the colon, as in \
             sensitivity:{}; results are {}",
            Self::EXAMPLE,
            names.join(", ")
        )
    }

    /// Name of the quantity that is differentiated.
    pub(super) fn result(&self) -> &'static str {
        self.result
    }

    /// Path of the number.
    pub(super) fn path(&self) -> &ValuePath {
        &self.path
    }

    /// Result and path.
    pub(super) fn name(&self) -> String {
        format!("{}:{}", self.result, self.path.text)
    }

    /// Columns, from those of the quantity that is differentiated.
    pub(super) fn columns(&self, of_result: &[Column]) -> Vec<Column> {
        let number = self.path.unit().unwrap_or("1").replace("degrees", "deg").replace('²', "2").replace('³', "3");
        let whole = |unit: &str| if unit.contains([' ', '/']) { format!("({unit})") } else { unit.to_owned() };
        let column = |column: &Column| Column {
            name: format!("{}_by_{}", column.name, self.path.text),
            unit: if number == "1" {
                column.unit.clone()
            } else {
                format!("{}/{}", whole(&column.unit), whole(&number)).into()
            },
            about: format!("derivative of the {} by this number of the robot file", column.about),
            kind: column.kind,
        };
        of_result.iter().map(column).collect()
    }

    /// Measures that are differentiated, one per column.
    fn measures(&self, robot: &Robot) -> Vec<Measure> {
        if let Some(of) = measure::of_cables().find(|of| of.key == self.result) {
            return of.members(robot);
        }
        let of_robot = measure::of_robot().find(|of| of.key == self.result).map(Measure::Robot);
        vec![of_robot.unwrap_or(Measure::Frequency(0))]
    }

    /// Adds the derivatives at a point, one per column.
    pub(super) fn values(&self, row: &mut PointEvaluation<'_>, out: &mut Vec<Value>) {
        let measures = self.measures(row.robot);
        match self.derivatives(row, &measures) {
            Ok(found) => out.extend(found.into_iter().map(|value| Value::real(Some(value)))),
            Err(status) => {
                out.extend(vec![Value::Nothing; measures.len()]);
                row.note_missing(status);
            }
        }
    }

    fn derivatives(&self, row: &PointEvaluation<'_>, measures: &[Measure]) -> Result<Vec<f64>, Status> {
        let none = |reason: &dyn Display| Status::new("no-derivative", &reason.to_string());
        let change = self.change(row)?;

        let gradients = match row.rule() {
            Some(rule) => Gradients::by_rule(row.robot, row.rest, rule),
            None => Gradients::new(row.robot, row.rest, row.hold),
        };
        let gradients = gradients.map_err(|error| none(&error))?;

        let found = Measure::static_gradients(measures, &gradients).into_iter().zip(measures);
        let gradient = |(of, measure): (Option<Result<RobotChange, GradientError>>, &Measure)| match of {
            Some(found) => found.map_err(|error| none(&error)),
            None => frequency_gradient(row, &gradients, measure.mode().unwrap_or_default()),
        };
        found.map(|of| Ok(gradient(of)?.dot(&change))).collect()
    }

    /// Change of the robot of a point per unit of the number.
    fn change(&self, row: &PointEvaluation<'_>) -> Result<RobotChange, Status> {
        let none = |reason: &str| Status::new("no-derivative", reason);
        let parameters = row.parameters().ok_or_else(|| none("the points have no robot file"))?;
        let index = parameters.find(self.path.keys()).ok_or_else(|| none("the robot file has no such number"))?;
        let change = parameters.change_of(index, row.robot);
        change.ok_or_else(|| none(&format!("{} has no derivative", self.path.text)))
    }
}

/// Gradient of the natural frequency with this number, from 0.
fn frequency_gradient(row: &PointEvaluation<'_>, gradients: &Gradients, mode: usize) -> Result<RobotChange, Status> {
    let none = |reason: &dyn Display| Status::new("no-derivative", &reason.to_string());
    let (linearisation, highest_hz) = row.vibration();
    let (dynamics, found) = modes::lowest(row.robot, row.rest, linearisation, mode + 1, highest_hz)
        .map_err(|error| Status::new("no-frequency", &error))?;
    let mode = found.modes.get(mode).ok_or_else(|| none(&"there is no mode"))?;
    let vibration = gradients.vibration(&dynamics).map_err(|error| none(&error))?;
    vibration.frequency(mode).map_err(|error| none(&error))
}
