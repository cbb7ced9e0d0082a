//! Execution of a request.

use crate::analyses::{
    cable::{self, CableResult},
    check::{self, Checked},
    compare::{self, Compared},
    design::{self, Designed},
    frf,
    gradient::{self, GradientTable},
    identify::{self, Identified},
    modes::{self, Modes},
    parameters::{self, ParameterList},
    payload::{self, Payload},
    pose_error::{self, PoseErrors},
    reduce::{self, ReducedForm},
    settle::{self, Settled},
    statics::{self, Statics},
    stiffness::{self, Stiffness},
    uncertainty::{self, Uncertainties},
};
use crate::error::Error;
use crate::json;
use crate::request::{Request, RobotText};
#[cfg(feature = "validation")]
use crate::validation::{self, Validated};
use crate::watch::Watch;
use crate::wording::Words;
use anyhow::{Result, anyhow};
use funicular::robot::Robot;
use serde::Serialize;

/// Results of any command that needs nothing but its request.
#[derive(Serialize)]
#[serde(untagged)]
#[expect(missing_docs, reason = "each variant is named after its command and holds its results")]
pub enum Results {
    Check(Checked),
    Parameters(ParameterList),
    Statics(Statics),
    Stiffness(Stiffness),
    Modes(Modes),
    Frf(frf::Frf),
    Settle(Settled),
    Compare(Compared),
    Gradient(GradientTable),
    Uncertainty(Uncertainties),
    Payload(Payload),
    PoseError(PoseErrors),
    Cable(CableResult),
    Reduce(ReducedForm),
    Identify(Box<Identified>),
    Design(Box<Designed>),
    #[cfg(feature = "validation")]
    Validate(Validated),
}

impl Results {
    /// Results as JSON, with the warnings worded for a front end.
    ///
    /// # Errors
    /// A result that is not a finite number, for example at an undamped resonance: kind
    /// [`NoSolution`](crate::ErrorKind).
    pub fn to_json(&self, words: Words) -> Result<Vec<u8>, Error> {
        match self {
            Self::Check(found) => json::of_results(found, words),
            Self::Parameters(found) => json::of_results(found, words),
            Self::Statics(found) => json::of_results(found, words),
            Self::Stiffness(found) => json::of_results(found, words),
            Self::Modes(found) => json::of_results(found, words),
            Self::Frf(found) => json::of_results(found, words),
            Self::Settle(found) => json::of_results(found, words),
            Self::Compare(found) => json::of_results(found, words),
            Self::Gradient(found) => json::of_results(found, words),
            Self::Uncertainty(found) => json::of_results(found, words),
            Self::Payload(found) => json::of_results(found, words),
            Self::PoseError(found) => json::of_results(found, words),
            Self::Cable(found) => json::of_results(found, words),
            Self::Reduce(found) => json::of_results(found, words),
            Self::Identify(found) => json::of_results(&**found, words),
            Self::Design(found) => json::of_results(&**found, words),
            #[cfg(feature = "validation")]
            Self::Validate(found) => json::of_results(found, words),
        }
    }
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

/// Runs a request whose robot, if it has one, has been read before. The errors keep their types.
///
/// # Errors
/// The errors of [`run`], except those of the robot file.
pub fn run_on(request: &Request, robot: Option<Robot>, watch: &mut dyn Watch) -> Result<Results> {
    let robot = || robot.ok_or_else(|| anyhow!("`{}` needs a robot", request.command()));

    Ok(match request {
        Request::Check(_) => Results::Check(check::run(robot()?)),
        Request::Parameters(of) => Results::Parameters(parameters::run(&of.robot)?),
        Request::Statics(of) => Results::Statics(statics::run(robot()?, of)?),
        Request::Stiffness(of) => Results::Stiffness(stiffness::run(robot()?, of, watch)?),
        Request::Modes(of) => Results::Modes(modes::run(robot()?, of)?),
        Request::Frf(of) => Results::Frf(frf::run(robot()?, of, watch)?),
        Request::Settle(of) => Results::Settle(settle::run(robot()?, of)?),
        Request::Compare(of) => Results::Compare(compare::run(robot()?, of)?),
        Request::Gradient(of) => Results::Gradient(gradient::run(robot()?, of)?),
        Request::Uncertainty(of) => Results::Uncertainty(uncertainty::run(of, watch)?),
        Request::Payload(of) => Results::Payload(payload::run(robot()?, of)?),
        Request::PoseError(of) => Results::PoseError(pose_error::run(&robot()?, of, watch)?),
        Request::Cable(of) => Results::Cable(cable::run(robot()?, of, watch)?),
        Request::Reduce(of) => Results::Reduce(reduce::run(robot()?, of, watch)?),
        Request::Identify(of) => Results::Identify(Box::new(identify::run(of, watch)?)),
        Request::Design(of) => Results::Design(Box::new(design::run(of, watch)?)),
        #[cfg(feature = "validation")]
        Request::Validate(_) => Results::Validate(validation::run()?),
        #[cfg(not(feature = "validation"))]
        Request::Validate(_) => {
            return Err(anyhow!(
                "`validate` needs the reference numbers, which this build leaves out: run it with the \
                                program or in Python"
            ));
        }
        other => return Err(anyhow!("`{}` writes a file: run it with the program or in Python", other.command())),
    })
}
