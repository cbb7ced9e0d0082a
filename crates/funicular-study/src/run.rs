//! A request in, results out.

use crate::analyses::{
    cable::{self, CableResult},
    check::{self, Checked},
    compare::{self, Compared},
    frf,
    modes::{self, Modes},
    pose_error::{self, PoseErrors},
    reduce::{self, Reduced},
    statics::{self, Statics},
    stiffness::{self, Stiffness},
    validate::{self, Validated},
};
use crate::error::Error;
use crate::request::Request;
use crate::watch::Watch;
use anyhow::{Result, anyhow};
use funicular::robot::Robot;
use serde::Serialize;

/// Results of any command that computes them from a request alone.
#[derive(Serialize)]
#[serde(untagged)]
#[expect(missing_docs, reason = "each variant is named after its command and holds its results")]
pub enum Results {
    Check(Checked),
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

/// Runs a request.
///
/// # Errors
/// [`Error`]: a request that has to change, a robot without that result, or work that was stopped. Commands that make
/// files of many rows (`map`, `sweep`, `merge`, `plot`) are run by front ends with a disk.
pub fn run(request: &Request, watch: &mut dyn Watch) -> Result<Results, Error> {
    Ok(match request {
        Request::Check(_) => Results::Check(check::run(robot(request)?)),
        Request::Statics(of) => Results::Statics(statics::run(robot(request)?, of)?),
        Request::Stiffness(of) => Results::Stiffness(stiffness::run(robot(request)?, of)?),
        Request::Modes(of) => Results::Modes(modes::run(robot(request)?, of)?),
        Request::Frf(of) => Results::Frf(frf::run(robot(request)?, of, watch)?),
        Request::Compare(of) => Results::Compare(compare::run(robot(request)?, of)?),
        Request::PoseError(of) => Results::PoseError(pose_error::run(&robot(request)?, of, watch)?),
        Request::Cable(of) => Results::Cable(cable::run(robot(request)?, of)?),
        Request::Reduce(of) => Results::Reduce(reduce::run(robot(request)?, of)?),
        Request::Validate(_) => Results::Validate(validate::run()?),
        other => return Err(anyhow!("`{}` makes a file: the program runs it, and Python", other.command()).into()),
    })
}

/// The robot of a request.
fn robot(request: &Request) -> Result<Robot> {
    let text = request.robot().ok_or_else(|| anyhow!("`{}` has no robot", request.command()))?;
    Ok(text.read()?.robot)
}
