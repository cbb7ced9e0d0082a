//! `gradient`: derivatives of results by numbers of the robot file.

mod columns;
mod rows;

pub use columns::GradientColumns;
pub(crate) use columns::{Tolerance, refuse_replaced, value_at};

use super::found;
use super::result_groups::{missing_option, nothing_below, refuse_unused, result_groups};
use super::shared::Models;
use crate::at_rest::{self, AtRest};
use crate::columns::{Columns, ResultTable, Tabled, column};
use crate::error::NoSolution;
use crate::measure::MeasureGroup;
use crate::names::{Named, Per};
use crate::request::{self, GradientRequest, RobotText};
use crate::rows::rows;
use crate::table::Column;
use anyhow::{Result, bail};
use funicular::gradient::{GradientError, Gradients, Hold};
use funicular::robot::Robot;
use funicular::statics::TensionRule;
use funicular::statics::derivatives::StaticDerivativeError;
use rows::GradientRows;
use serde_json::Value;

rows! {
    /// Results of `gradient`: derivatives of results by numbers of the robot file.
    pub struct GradientTable {
        pub robot: String = hidden;
        pub models: Models = spread;
        /// Quantity that is held while a number changes: `lengths` or `pose`.
        pub held: &'static str;
        /// Sentence that says what is held, and by which rule the rest follows.
        pub held_means: &'static str;
        /// Unit of the derivatives: `unit`, `percent` or `tolerance`.
        pub per: &'static str;
        /// Numbers of the robot file; one column of `derivatives` each.
        pub parameters: Vec<GradientParameter>;
        /// Results; one row of `derivatives` each.
        pub results: Vec<GradientResult>;
        /// Results without a gradient, each with the reason.
        pub refused: Vec<RefusedResult> = sparse;
        /// Paths of numbers without derivatives, such as limits.
        pub without_derivative: Vec<String> = sparse;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Number of the robot file.
    #[derive(Debug, Clone)]
    pub struct GradientParameter {
        pub path: String;
        /// Value with which the results are computed.
        pub value: f64;
        pub unit: &'static str;
        /// Step `tolerance`, in the unit of the number.
        pub tolerance: f64;
    }
}

rows! {
    /// Result with its derivatives.
    pub struct GradientResult {
        /// Name, such as `frequency 3` or `tension of cable "2" at the anchor`.
        pub name: String;
        /// Identity as data: `kind`, and the cable, mode or frequency to which the result belongs.
        pub measure: Value;
        pub unit: String;
        pub value: f64;
        /// Entry of the block of modes that share a frequency: numbers of the two modes in the list, from 1. Along a
        /// change, the derivatives of the frequencies are the eigenvalues of the block.
        pub block_entry: Option<[usize; 2]>;
        /// Derivatives, one per number of the robot file.
        pub derivatives: Vec<f64>;
    }
}

rows! {
    /// Result without a gradient.
    pub struct RefusedResult {
        pub name: String;
        /// Identity as data, as in [`GradientResult`].
        pub measure: Value;
        pub reason: String;
    }
}

/// Derivative of a result by a number.
struct Derivative<'a> {
    table: &'a GradientTable,
    result: &'a GradientResult,
    parameter: &'a GradientParameter,
    value: f64,
}

impl<'a> Derivative<'a> {
    fn columns() -> Columns<Self> {
        Columns::new([
            column("result", "", "name of the result", |row: &Self| row.result.name.clone()),
            column("result_value", "", "value of the result", |row: &Self| row.result.value),
            column("result_unit", "", "unit of the result", |row: &Self| row.result.unit.clone()),
            column("path", "", "path of the number of the robot file", |row: &Self| row.parameter.path.clone()),
            column("path_value", "", "value of the number", |row: &Self| row.parameter.value),
            column("path_unit", "", "unit of the number", |row: &Self| row.parameter.unit),
            column("tolerance", "", "tolerance of the number, in its unit", |row: &Self| row.parameter.tolerance),
            column("held", "", "what is held while the number changes", |row: &Self| row.table.held),
            column("per", "", "step to which the derivative belongs: unit, percent or tolerance", |row: &Self| {
                row.table.per
            }),
            column("derivative", "", "derivative, in the unit of the result per step", |row: &Self| row.value),
        ])
    }

    fn all(table: &'a GradientTable) -> impl Iterator<Item = Self> {
        table.results.iter().flat_map(move |result| {
            let numbers = table.parameters.iter().zip(&result.derivatives);
            numbers.map(move |(parameter, value)| Self { table, result, parameter, value: *value })
        })
    }
}

impl Tabled for GradientTable {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", Derivative::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(Derivative::columns(), Derivative::all(self))
    }
}

found!(GradientTable, "gradient");

/// Computes the derivatives.
///
/// # Errors
/// A request that contradicts itself or the robot, a robot without such an equilibrium, or an equilibrium without
/// derivatives.
pub fn run(robot: Robot, request: &GradientRequest) -> Result<GradientTable> {
    // A request that has to change is refused before the work.
    groups(request)?;
    about(&at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?, request)
}

/// Groups of results of a request, checked.
fn groups(request: &GradientRequest) -> Result<Vec<&'static MeasureGroup>> {
    let groups = result_groups(&request.of, request.below_hz)?;
    let signals = [request.input.as_deref(), request.output.as_deref()];
    refuse_unused(&groups, request.below_hz, request.at_hz.is_some(), signals, &request.points)?;
    if groups.contains(&&MeasureGroup::Response) {
        for (option, is_given) in [
            ("at_hz", request.at_hz.is_some()),
            ("input", request.input.is_some()),
            ("output", request.output.is_some()),
        ] {
            if !is_given {
                return Err(missing_option(&MeasureGroup::Response, option));
            }
        }
    }
    request.at_hz.map_or(Ok(()), |hz| request::check_not_negative("at_hz", hz))?;
    Ok(groups)
}

/// Computes the derivatives about an equilibrium.
///
/// # Errors
/// The errors of [`run`].
pub fn about(at_rest: &AtRest, request: &GradientRequest) -> Result<GradientTable> {
    let groups = groups(request)?;
    let AtRest { robot, equilibrium, .. } = at_rest;
    let linearisation = at_rest::linearisation(&request.model, equilibrium.model);
    let text = RobotText::read(&request.robot)?.text;
    let columns = GradientColumns::of(at_rest, &text, &request.by, &request.tolerances)?;
    let GradientColumns { parameters, changes, without_derivative } = columns;
    let gradients = held(at_rest, request.hold)?;

    let mut rows = GradientRows { robot, changes: &changes, results: Vec::new(), refused: Vec::new() };
    rows.statics(robot, &gradients, &groups);

    let limit = request.below_hz.into_iter().chain(request.at_hz).fold(0.0, f64::max);
    let mut warnings = at_rest.warnings(None);
    let of_modes = groups.iter().any(|group| group.is_of_modes());
    if of_modes || groups.contains(&&MeasureGroup::Response) {
        let (dynamics, found) = at_rest.dynamics_for_gradients(linearisation, limit)?;
        warnings = found;
        let vibration = gradients.vibration(&dynamics)?;
        if of_modes {
            let below_hz = request.below_hz.unwrap_or(limit);
            if rows.modes(&dynamics, &vibration, &groups, below_hz) == 0 {
                warnings.push(nothing_below(below_hz));
            }
        }
        if groups.contains(&&MeasureGroup::Response) {
            rows.response(robot, &vibration, request)?;
        }
    }

    warnings.extend(at_rest.rule_near_jump());
    let GradientRows { mut results, refused, .. } = rows;
    for result in &mut results {
        scale(&mut result.derivatives, &parameters, request.per);
    }
    Ok(GradientTable {
        robot: robot.name.clone(),
        models: Models::of(at_rest, linearisation),
        held: request.hold.name(),
        held_means: meaning(at_rest, request.hold),
        per: request.per.name(),
        parameters,
        results,
        refused,
        without_derivative,
        warnings,
    })
}

/// Multiplies derivatives per unit of each number by the step of the number.
fn scale(derivatives: &mut [f64], parameters: &[GradientParameter], per: Per) {
    for (derivative, parameter) in derivatives.iter_mut().zip(parameters) {
        *derivative *= match per {
            Per::Unit => 1.0,
            Per::Percent => 0.01 * parameter.value.abs(),
            Per::Tolerance => parameter.tolerance,
        };
    }
}

/// Checks that the robot has enough cables to hold its pose, if the pose is to be held.
///
/// # Errors
/// Fewer cables than degrees of freedom.
pub(crate) fn check_hold(robot: &Robot, hold: Hold) -> Result<()> {
    if hold != Hold::Lengths && robot.constraint().is_under() {
        let (cables, degrees_of_freedom) = (robot.cables.len(), robot.platform.motion.count());
        bail!(
            "⟪hold⟫ {}: {cables} cables cannot hold the pose of a platform with {degrees_of_freedom} degrees of \
             freedom by their lengths; give ⟪hold⟫ lengths",
            hold.name()
        );
    }
    Ok(())
}

/// Gradients about an equilibrium while the lengths, the pose or the tension rule are held.
///
/// # Errors
/// Too few cables to hold a pose, `Hold::Rule` where no rule has chosen the tensions, or an equilibrium without
/// derivatives.
pub(crate) fn held(at_rest: &AtRest, hold: Hold) -> Result<Gradients<'_>> {
    let AtRest { robot, equilibrium, rule, held_pose, .. } = at_rest;
    check_hold(robot, hold)?;
    let gradients = match (hold, rule) {
        (Hold::Rule, _) if held_pose.is_some() => {
            bail!(
                "⟪hold⟫ rule: the lengths of a pose are held, which no rule changes; leave out ⟪hold_lengths_of_pose⟫"
            )
        }
        (Hold::Rule, Some(rule)) => Gradients::by_rule(robot, equilibrium, rule),
        (Hold::Rule, None) if robot.constraint().is_redundant() => {
            bail!(
                "⟪hold⟫ rule needs tensions that a rule has chosen: give ⟪pose⟫, or the robot file a [state] with \
                 `position_m`"
            )
        }
        (Hold::Rule, None) => Gradients::new(robot, equilibrium, Hold::Pose),
        (Hold::Lengths | Hold::Pose, _) => Gradients::new(robot, equilibrium, hold),
    };
    gradients.map_err(no_solution)
}

/// Part of a sentence that says what is held while a number of the robot file changes, and by which rule the rest
/// follows.
pub fn meaning(at_rest: &AtRest, hold: Hold) -> &'static str {
    let redundant = at_rest.robot.constraint().is_redundant();
    match (hold, &at_rest.rule) {
        (Hold::Lengths, _) => "the unstrained lengths are held, the pose follows",
        (Hold::Pose, _) if redundant => {
            "the pose is held, the lengths follow such that the tensions parallel to the chords change least"
        }
        (Hold::Rule, Some(TensionRule::Lowest)) => {
            "the pose is held, the lengths follow such that the tensions obey the rule `lowest`"
        }
        (Hold::Rule, Some(TensionRule::Closest(_))) => {
            "the pose is held, the lengths follow such that the tensions obey the rule `closest`"
        }
        (Hold::Rule, Some(TensionRule::Middle)) => {
            "the pose is held, the lengths follow such that the tensions obey the rule `middle`"
        }
        (Hold::Rule, Some(TensionRule::Centre)) => {
            "the pose is held, the lengths follow such that the tensions obey the rule `centre`"
        }
        (Hold::Rule, Some(TensionRule::Stiffest)) => {
            "the pose is held, the lengths follow such that the tensions obey the rule `stiffest`"
        }
        (Hold::Pose | Hold::Rule, _) => "the pose is held, the lengths follow",
    }
}

/// Error of a robot without derivatives. It is an error of the solution if another state may have derivatives,
/// otherwise an error of the input.
pub(crate) fn no_solution(error: GradientError) -> anyhow::Error {
    match &error {
        GradientError::Static(StaticDerivativeError::Slack { .. } | StaticDerivativeError::Singular)
        | GradientError::Vertical { .. }
        | GradientError::OneSided { .. } => NoSolution(error.to_string()).into(),
        _ => error.into(),
    }
}
