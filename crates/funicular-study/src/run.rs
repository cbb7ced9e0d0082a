//! Execution of a request.

use crate::analyses::{
    Found,
    cable::{self, CableResult},
    calibrate::{self, Calibrated},
    check::{self, Checked},
    clearance::{self, Clearances},
    compare::{self, Compared},
    design::{self, Designed},
    estimate::{self, Estimated},
    frf,
    gradient::{self, GradientTable},
    gust::{self, Gusty},
    identify::{self, Identified},
    loads::{self, Loads},
    modes::{self, Modes},
    observability::{self, Observed},
    parameters::{self, ParameterList},
    payload::{self, Payload},
    pose_error::{self, PoseErrors},
    prove::{self, Proved},
    reduce::{self, ReducedForm},
    settle::{self, Settled},
    simulate::{self, Simulated},
    speeds::{self, Speeds},
    statics::{self, Statics},
    stiffness::{self, Stiffness},
    trajectory::{self, TrajectoryResult},
    uncertainty::{self, Uncertainties},
    winches::{self, Winches},
    workspace::{self, Workspace},
};
use crate::at_rest::AtRest;
use crate::columns::{CommandTables, ResultTable, Tabled};
use crate::error::Error;
use crate::json;
use crate::request::{Request, RobotText};
use crate::rows::Described;
use crate::shared_ropes::{refuse_ropes_of_request, refuse_ropes_over_sheaves};
use crate::watch::Watch;
use crate::wording::Words;
use anyhow::{Result, anyhow};
use funicular::robot::Robot;
use serde::Serialize;
use serde_json::Value;

/// Declares the commands that need nothing but their request: type of the results, and the analysis of a request `of`
/// for its robot, with a watch. A command that starts from an equilibrium can say after `at` how it goes on from one.
macro_rules! answers {
    (
        ($d:tt $robot:ident, $watch:ident)
        $($Variant:ident($Found:ty): $of:pat => $run:expr $(, at $at_rest:ident => $about:expr)?;)*
    ) => {
        /// Results of any command that needs nothing but its request.
        #[derive(Serialize)]
        #[serde(untagged)]
        #[expect(missing_docs, reason = "each variant is named after its command and holds its results")]
        pub enum Results {
            $($Variant($Found),)*
        }

        impl Results {
            /// Name of every command, with the columns of its tables in files as [`Tabled::tables`] gives them.
            pub fn tables() -> Vec<CommandTables> {
                vec![$((<$Found as Found>::COMMAND, <$Found as Tabled>::tables()),)*]
            }

            /// Name of every command, with the JSON Schema of its results without the keys that all results have.
            pub(crate) fn schemas() -> Vec<(&'static str, Value)> {
                vec![$((<$Found as Found>::COMMAND, <$Found as Described>::schema()),)*]
            }

            /// Sentences that the user should know before trusting the numbers.
            pub fn warnings(&self) -> &[String] {
                match self {
                    $(Self::$Variant(found) => found.warnings(),)*
                }
            }

            /// Table of the results in files.
            pub fn table(&self) -> ResultTable<'_> {
                match self {
                    $(Self::$Variant(found) => found.table(),)*
                }
            }

            /// Results as JSON, with the warnings worded for a front end.
            ///
            /// # Errors
            /// A result that is not a finite number, for example at an undamped resonance: kind
            /// [`NoSolution`](crate::ErrorKind).
            pub fn to_json(&self, words: Words) -> Result<Vec<u8>, Error> {
                match self {
                    $(Self::$Variant(found) => json::of_results(found, words),)*
                }
            }
        }

        /// Evaluates an expression for results, whatever command they are of, with their own type.
        #[macro_export]
        macro_rules! with_found {
            ($d results:expr, $d found:ident => $d body:expr) => {
                match $d results {
                    $($crate::Results::$Variant($d found) => $d body,)*
                }
            };
        }

        /// Runs a request whose robot, if it has one, has been read before. The errors keep their types.
        ///
        /// # Errors
        /// The errors of [`run`], except those of the robot file.
        pub fn run_on(request: &Request, robot: Option<Robot>, $watch: &mut dyn Watch) -> Result<Results> {
            match &robot {
                Some(robot) => refuse_ropes_over_sheaves(request.command(), robot)?,
                None => refuse_ropes_of_request(request)?,
            }
            let $robot = || robot.ok_or_else(|| anyhow!("`{}` needs a robot", request.command()));
            Ok(match request {
                $(Request::$Variant($of) => Results::$Variant($run),)*
                // A front end that has the crate `funicular-validation` runs it instead.
                Request::Validate(_) => {
                    return Err(anyhow!(
                        "`validate` needs the reference numbers, which this build leaves out: run it with the program \
                         or in Python"
                    ));
                }
                other => {
                    return Err(anyhow!("`{}` writes a file: run it with the program or in Python", other.command()));
                }
            })
        }

        /// Runs a request about an equilibrium of its robot that has been computed before. The state of the request is
        /// not used.
        ///
        /// # Errors
        /// The errors of [`run_on`], and a command that does not start from an equilibrium.
        pub fn run_at(request: &Request, at_rest: &AtRest, $watch: &mut dyn Watch) -> Result<Results> {
            refuse_ropes_over_sheaves(request.command(), &at_rest.robot)?;
            Ok(match request {
                $($(Request::$Variant($of) => {
                    let $at_rest = at_rest;
                    Results::$Variant($about)
                })?)*
                other => return Err(anyhow!("`{}` does not start from an equilibrium", other.command())),
            })
        }
    };
}

answers! {
    ($ robot, watch)
    Check(Checked): _ => check::run(robot()?);
    Parameters(ParameterList): of => parameters::run(&of.robot)?;
    Statics(Statics): of => statics::run(robot()?, of)?;
    Stiffness(Stiffness): of => stiffness::run(robot()?, of, watch)?;
    Modes(Modes): of => modes::run(robot()?, of)?, at at_rest => modes::about(at_rest, of)?;
    Frf(frf::Frf): of => frf::run(robot()?, of, watch)?;
    Settle(Settled): of => settle::run(robot()?, of)?, at at_rest => settle::about(at_rest, of)?;
    Gust(Gusty): of => gust::run(robot()?, of)?, at at_rest => gust::about(at_rest, of)?;
    Compare(Compared): of => compare::run(robot()?, of)?, at at_rest => compare::about(at_rest, of)?;
    Gradient(GradientTable): of => gradient::run(robot()?, of)?, at at_rest => gradient::about(at_rest, of)?;
    Uncertainty(Uncertainties): of => uncertainty::run(of, watch)?;
    Payload(Payload): of => payload::run(robot()?, of)?;
    Loads(Loads): of => loads::run(robot()?, of)?;
    Speeds(Speeds): of => speeds::run(robot()?, of)?;
    Winches(Winches): of => winches::run(robot()?, of, watch)?;
    Trajectory(TrajectoryResult): of => trajectory::run(robot()?, of, watch)?;
    Simulate(Box<Simulated>): of => Box::new(simulate::run(robot()?, of, watch)?);
    Clearance(Clearances): of => clearance::run(robot()?, of, watch)?;
    PoseError(PoseErrors): of => pose_error::run(&robot()?, of, watch)?;
    Cable(CableResult): of => cable::run(robot()?, of, watch)?;
    Reduce(ReducedForm): of => reduce::run(robot()?, of, watch)?, at at_rest => reduce::about(at_rest, of, watch)?;
    Identify(Box<Identified>): of => Box::new(identify::run(of, watch)?);
    Calibrate(Box<Calibrated>): of => Box::new(calibrate::run(of, watch)?);
    Estimate(Box<Estimated>): of => Box::new(estimate::run(&robot()?, of, watch)?);
    Observability(Observed): of => observability::run(robot()?, of, watch)?;
    Workspace(Box<Workspace>): of => Box::new(workspace::run(robot()?, of, watch)?);
    Prove(Box<Proved>): of => Box::new(prove::run(robot()?, of, watch)?);
    Design(Box<Designed>): of => Box::new(design::run(of, watch)?);
}

/// Runs a request.
///
/// # Errors
/// [`Error`]: a request that has to change, a robot without such a result, or work that was stopped. Commands that
/// write files of many rows (`map`, `sweep`, `merge`, `plot`) are run by front ends with a disk.
pub fn run(request: &Request, watch: &mut dyn Watch) -> Result<Results, Error> {
    let robot = request.robot().map(RobotText::read).transpose()?.map(|file| file.robot);
    Ok(run_on(request, robot, watch)?)
}

#[cfg(test)]
mod tests {
    use super::Results;
    use crate::units;
    use std::collections::BTreeSet;

    #[test]
    fn every_column_has_a_meaning_and_a_name_of_its_own_that_ends_with_its_unit() {
        let tables = Results::tables();
        assert_eq!(tables.len(), tables.iter().map(|(command, _)| command).collect::<BTreeSet<_>>().len());
        for (command, columns) in tables.iter().flat_map(|(command, all)| all.iter().map(move |(_, of)| (command, of)))
        {
            let names: BTreeSet<&str> = columns.iter().map(|column| column.name.as_str()).collect();
            assert_eq!(names.len(), columns.len(), "{command}");
            for column in columns {
                assert!(!column.about.is_empty() && !column.about.contains("{}"), "{command} {}", column.name);
                if let Some(unit) = units::of_name(&column.name) {
                    assert_eq!(column.unit, unit.text, "{command} {}", column.name);
                }
            }
        }
    }
}
