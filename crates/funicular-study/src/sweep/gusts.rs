//! Response to the gusts of the robot file at a point.

use super::status::Status;
use crate::at_rest::{AtRest, expected_peak, moments_in_gusts};
use crate::request::GUST_DURATION;
use funicular::cable::catenary_dynamic::DriveSignal;
use funicular::dynamics::Linearisation;
use funicular::gust;
use funicular::math::Vec3;
use funicular::response::Signal;
use funicular::robot::Robot;
use funicular::statics::Equilibrium;

/// Code of a point without a response.
const CODE: &str = "no-gusts";

/// Displacements whose moments are computed first, along the axes of the world.
const TRANSLATIONS: usize = 3;

/// Numbers of a point; motions are those of the platform origin, and extremes are within [`GUST_DURATION`].
#[derive(Debug, Clone, Copy)]
pub(super) struct PointInGusts {
    /// R.m.s. value of the distance from the mean place [m].
    pub(super) rms: f64,
    /// Largest of the expected peaks along the axes of the world [m]; `None` for too few crossings.
    pub(super) peak: Option<f64>,
    /// Smallest expected tension at the platform of a cable [N]; `None` for too few crossings.
    pub(super) tension_min: Option<f64>,
    /// Largest probability that the tension of a cable falls to zero.
    pub(super) slack_probability: f64,
}

/// Response at an equilibrium.
pub(super) fn at_point(
    robot: &Robot,
    rest: &Equilibrium,
    linearisation: Linearisation,
) -> Result<PointInGusts, Status> {
    let (robot, equilibrium) = (robot.clone(), rest.clone());
    let at_rest = AtRest { robot, equilibrium, requested_pose: None, rule: None, held_pose: None };
    let AtRest { robot, equilibrium, .. } = &at_rest;

    let along = |direction_w| Signal::Along { direction_w, point_p: Vec3::zeros() };
    let tension = |cable| Signal::Drive { cable, signal: DriveSignal::Tension };
    let motions = [Vec3::x(), Vec3::y(), Vec3::z()].map(along).into_iter();
    let signals: Vec<Signal> = motions.chain((0..robot.cables.len()).map(tension)).collect();
    let moments = moments_in_gusts(&at_rest, linearisation, &signals).map_err(|error| Status::new(CODE, &error))?;

    let (motions, tensions) = moments.split_at(TRANSLATIONS);
    let peak = |of: &gust::Moments| expected_peak(of, GUST_DURATION);
    let mean = |cable: usize| equilibrium.cables[cable].force_on_platform_w.norm();
    let smallest = tensions.iter().enumerate().map(|(i, of)| Some(mean(i) - peak(of)?));
    let slack = |(i, of): (usize, &gust::Moments)| gust::slack_probability(mean(i), of.rms(), of.rate(), GUST_DURATION);
    Ok(PointInGusts {
        rms: motions.iter().map(|of| of.variance).sum::<f64>().sqrt(),
        peak: motions.iter().map(peak).try_fold(0.0_f64, |most, peak| Some(most.max(peak?))),
        tension_min: smallest.reduce(|a, b| Some(a?.min(b?))).flatten(),
        slack_probability: tensions.iter().enumerate().map(slack).fold(0.0, f64::max),
    })
}
