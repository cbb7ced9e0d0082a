//! A request in, results out.

use crate::analyses::{
    cable::{self, CableResult},
    check::{self, Checked},
    compare::{self, Compared},
    frf,
    modes::{self, Modes},
    parameters::{self, ParameterList},
    pose_error::{self, PoseErrors},
    reduce::{self, Reduced},
    statics::{self, Statics},
    stiffness::{self, Stiffness},
    validate::{self, Validated},
};
use crate::error::Error;
use crate::json;
use crate::request::{Request, RobotText};
use crate::watch::Watch;
use crate::wording::Words;
use anyhow::{Result, anyhow};
use funicular::robot::Robot;
use serde::Serialize;

/// Results of any command that computes them from a request alone.
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
    Compare(Compared),
    PoseError(PoseErrors),
    Cable(CableResult),
    Reduce(Reduced),
    Validate(Validated),
}

impl Results {
    /// The results as JSON, with the warnings in the words of a front end.
    ///
    /// # Errors
    /// A result that is not a finite number, as at an undamped resonance: kind [`NoSolution`](crate::ErrorKind).
    pub fn to_json(&self, words: Words) -> Result<Vec<u8>, Error> {
        match self {
            Self::Check(found) => json::of_results(found, words),
            Self::Parameters(found) => json::of_results(found, words),
            Self::Statics(found) => json::of_results(found, words),
            Self::Stiffness(found) => json::of_results(found, words),
            Self::Modes(found) => json::of_results(found, words),
            Self::Frf(found) => json::of_results(found, words),
            Self::Compare(found) => json::of_results(found, words),
            Self::PoseError(found) => json::of_results(found, words),
            Self::Cable(found) => json::of_results(found, words),
            Self::Reduce(found) => json::of_results(found, words),
            Self::Validate(found) => json::of_results(found, words),
        }
    }
}

/// Runs a request.
///
/// # Errors
/// [`Error`]: a request that has to change, a robot without that result, or work that was stopped. Commands that make
/// files of many rows (`map`, `sweep`, `merge`, `plot`) are run by front ends with a disk.
pub fn run(request: &Request, watch: &mut dyn Watch) -> Result<Results, Error> {
    let robot = request.robot().map(RobotText::read).transpose()?.map(|file| file.robot);
    Ok(run_on(request, robot, watch)?)
}

/// Runs a request whose robot was read already, if it has one; the errors keep their types.
///
/// # Errors
/// Those of [`run`], but the robot file's own.
pub fn run_on(request: &Request, robot: Option<Robot>, watch: &mut dyn Watch) -> Result<Results> {
    let robot = || robot.ok_or_else(|| anyhow!("`{}` needs a robot", request.command()));
    Ok(match request {
        Request::Check(_) => Results::Check(check::run(robot()?)),
        Request::Parameters(of) => Results::Parameters(parameters::run(&of.robot)?),
        Request::Statics(of) => Results::Statics(statics::run(robot()?, of)?),
        Request::Stiffness(of) => Results::Stiffness(stiffness::run(robot()?, of)?),
        Request::Modes(of) => Results::Modes(modes::run(robot()?, of)?),
        Request::Frf(of) => Results::Frf(frf::run(robot()?, of, watch)?),
        Request::Compare(of) => Results::Compare(compare::run(robot()?, of)?),
        Request::PoseError(of) => Results::PoseError(pose_error::run(&robot()?, of, watch)?),
        Request::Cable(of) => Results::Cable(cable::run(robot()?, of)?),
        Request::Reduce(of) => Results::Reduce(reduce::run(robot()?, of)?),
        Request::Validate(_) => Results::Validate(validate::run()?),
        other => return Err(anyhow!("`{}` makes a file: the program runs it, and Python", other.command())),
    })
}
