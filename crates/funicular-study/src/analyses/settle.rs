//! `settle`: how a point of the platform swings after a wrench is released, and when it has settled.

use super::found;
use super::shared::Models;
use crate::at_rest::{self, AtRest, ModesBelow};
use crate::request::{self, SettleRequest, check_vector};
use anyhow::{Result, bail};
use funicular::math::{Vec3, Vec6};
use funicular::modes::{self, Release};
use funicular::robot::Robot;
use serde::Serialize;
use std::f64::consts::TAU;

/// Results of `settle`.
#[derive(Serialize)]
pub struct Settled {
    #[serde(skip)]
    pub robot: String,
    pub below_hz: f64,
    #[serde(flatten)]
    pub models: Models,
    pub tolerance_m: f64,
    /// Displacement of the point under the wrench, linear, world axes.
    pub held_m: [f64; 3],
    /// Bound of what the modes above the limit add to the displacement at the release.
    pub omitted_m: f64,
    /// Maximum distance of the point from its rest in the history.
    pub peak_m: f64,
    /// Last time at which the point is at the tolerance.
    pub settled_s: f64,
    /// Time from which on the sum of all amplitudes is within the tolerance.
    pub surely_settled_s: f64,
    /// True if a count proves that every mode has its damped mode.
    pub damped_certified: bool,
    /// Modes that take part, the largest amplitude first.
    pub modes: Vec<SettlingMode>,
    pub history: Vec<HistoryRow>,
    #[serde(skip)]
    pub warnings: Vec<String>,
}

/// Part of a mode in the motion.
#[derive(Serialize)]
pub struct SettlingMode {
    pub frequency_hz: f64,
    pub damping_ratio: f64,
    /// Amplitude at the release: half of the long axis of the ellipse on which the point moves.
    pub amplitude_m: f64,
    /// Time in which this amplitude alone falls to the tolerance; zero if it is smaller.
    pub settled_s: f64,
}

/// Position of the point relative to its rest at one time, and the bound of its distance.
#[derive(Serialize)]
pub struct HistoryRow {
    pub t_s: f64,
    pub x_m: f64,
    pub y_m: f64,
    pub z_m: f64,
    pub envelope_m: f64,
}

/// Points per period of the fastest mode that takes part, and maximum number of points.
const POINTS_PER_PERIOD: f64 = 16.0;
const MAX_POINTS: f64 = 20_000.0;

/// Part of the largest amplitude below which a mode does not make the steps of the history finer.
const SMALL: f64 = 1e-3;

/// Ratio of a change of tension to the tension from which on linear motion is in doubt.
const LARGE_CHANGE: f64 = 0.1;

/// Computes the decay after a release.
///
/// # Errors
/// A request without a wrench, a robot without such an equilibrium, or modes whose decay has no closed form.
pub fn run(robot: Robot, request: &SettleRequest) -> Result<Settled> {
    checked(request)?;
    about(&at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?, request)
}

/// Computes the decay of a robot at equilibrium. The state of the request is not used.
///
/// # Errors
/// The errors of [`run`].
pub fn about(at_rest: &AtRest, request: &SettleRequest) -> Result<Settled> {
    checked(request)?;
    let linearisation = at_rest::linearisation(&request.model, at_rest.equilibrium.model);
    let limit = match request.below_hz {
        Some(given) => at_rest.modes_limit(Some(given), linearisation)?,
        None => at_rest.response_limit(linearisation)?,
    };
    let ModesBelow { dynamics, modes: found, mut warnings } =
        at_rest.modes_with_strains(linearisation, limit, modes::MAX_MODES)?;
    warnings.extend(funicular::warnings::of_damping(&at_rest.robot).map(|warning| warning.to_string()));
    let damped = modes::damped::damped_modes(&dynamics, &found);
    let ratios: Vec<f64> = damped.modes.iter().map(modes::damped::DampedMode::damping_ratio).collect();
    warnings.extend(modes::caveat_of_stretch(&at_rest.robot, &found.modes, &ratios, modes::PLATFORM_SHARE));

    let arm_w = |point: Option<[f64; 3]>| at_rest.equilibrium.pose.rot_wp * Vec3::from(point.unwrap_or_default());
    let force = Vec3::from(request.release_n.unwrap_or_default());
    let moment =
        arm_w(request.points.input_point_m).cross(&force) + Vec3::from(request.release_n_m.unwrap_or_default());
    let wrench = Vec6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z);
    let release = Release::of(&dynamics, &found, &damped, &wrench, &arm_w(request.points.output_point_m))?;

    let tolerance = request.tolerance_m;
    let (settled_s, surely_settled_s) = (release.settled(tolerance), release.surely_settled(tolerance));
    warnings.extend(large_release(at_rest, &force));
    let history = history(&release, surely_settled_s);
    let distance = |row: &HistoryRow| Vec3::new(row.x_m, row.y_m, row.z_m).norm();
    Ok(Settled {
        robot: at_rest.robot.name.clone(),
        below_hz: limit,
        models: Models::of(at_rest, linearisation),
        tolerance_m: tolerance,
        held_m: release.held.into(),
        omitted_m: release.omitted,
        peak_m: history.iter().map(distance).fold(release.held.norm(), f64::max),
        settled_s,
        surely_settled_s,
        damped_certified: damped.certified,
        modes: settling_modes(&release, tolerance),
        history,
        warnings,
    })
}

fn checked(request: &SettleRequest) -> Result<()> {
    request.points.check()?;
    check_vector("release_n", request.release_n)?;
    check_vector("release_n_m", request.release_n_m)?;
    request::check_positive("tolerance_m", request.tolerance_m)?;
    let parts = [request.release_n, request.release_n_m].into_iter().flatten().flatten();
    if parts.into_iter().all(|part| part == 0.0) {
        bail!("nothing is released: give the force ⟪release_n⟫, as 0,0,-20, or the moment ⟪release_n_m⟫");
    }
    Ok(())
}

/// Caveat that the motion is linear: the released force is not small against the forces of the cables.
fn large_release(at_rest: &AtRest, force: &Vec3) -> Option<String> {
    let least = at_rest.equilibrium.cables.iter().map(|cable| cable.tension_platform).fold(f64::INFINITY, f64::min);
    (force.norm() > LARGE_CHANGE * least).then(|| {
        format!(
            "the released force of {:.1} N is more than a tenth of the smallest tension, {least:.1} N: the motion is \
             linear about the equilibrium without it, and a cable may go slack, which is not computed",
            force.norm()
        )
    })
}

fn settling_modes(release: &Release, tolerance: f64) -> Vec<SettlingMode> {
    let mut all: Vec<SettlingMode> = (release.motions.iter())
        .map(|motion| {
            let (size, rate) = (motion.size(), motion.rate());
            SettlingMode {
                frequency_hz: motion.omega.norm() / TAU,
                damping_ratio: rate / motion.omega.norm(),
                amplitude_m: size,
                settled_s: if size > tolerance { (size / tolerance).ln() / rate } else { 0.0 },
            }
        })
        .collect();
    all.sort_by(|a, b| b.amplitude_m.total_cmp(&a.amplitude_m));
    all
}

/// Motion up to the sure time, with enough points per period of every mode that counts.
fn history(release: &Release, until: f64) -> Vec<HistoryRow> {
    let largest = release.motions.iter().map(modes::DecayingMotion::size).fold(0.0, f64::max);
    let counts = release.motions.iter().filter(|motion| motion.size() >= SMALL * largest);
    let (fastest, slowest) = counts.fold((0.0_f64, f64::INFINITY), |(fastest, slowest), motion| {
        (fastest.max(motion.omega.re), slowest.min(motion.omega.re))
    });
    if fastest <= 0.0 {
        return Vec::new();
    }
    // At least one period of the slowest mode is shown.
    let until = until.max(TAU / slowest);
    let points = (until * fastest / TAU * POINTS_PER_PERIOD).clamp(2.0, MAX_POINTS).ceil();
    (0..=points as usize)
        .map(|i| {
            let t_s = until * i as f64 / points;
            let [x_m, y_m, z_m] = release.at(t_s).into();
            HistoryRow { t_s, x_m, y_m, z_m, envelope_m: release.envelope(t_s) }
        })
        .collect()
}

found!(Settled, "settle");
