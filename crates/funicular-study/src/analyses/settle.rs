//! `settle`: how a point of the platform swings after a wrench is released, and when it has settled.

use super::fields::AXES;
use super::found;
use super::shared::Models;
use crate::at_rest::{self, AtRest, ModesBelow};
use crate::columns::{Columns, ResultTable, Tabled, column, parts};
use crate::error::NoSolution;
use crate::request::{self, SettleRequest, check_vector};
use crate::table::Column;
use crate::text::significant;
use anyhow::{Result, bail};
use funicular::math::{Vec3, Vec6};
use funicular::modes::{self, Release};
use funicular::robot::{Pose, Robot};
use funicular::statics::{self, Stability, StaticModel};
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
    /// Displacement between the equilibria with the wrench and without it; absent if there is none with it, and with
    /// ideal cables.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub held_exact_m: Option<[f64; 3]>,
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

/// Relative difference of the linear displacement from that of the equilibrium under the wrench from which on linear
/// motion is in doubt. A release of 1.95 kg from the robot of Yuan 2014 has 0.19, and its linear history is wrong by 0.18.
const NOT_LINEAR: f64 = 0.1;

/// Computes the decay after a release.
///
/// # Errors
/// A request without a wrench, a robot without such an equilibrium, a slack cable, an equilibrium to which nothing
/// returns, or modes whose decay has no closed form.
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
    check_rest(at_rest)?;
    let under_wrench = UnderWrench::of(at_rest, request);
    let at_rest = &*at_rest.vibrating();
    let linearisation = at_rest::linearisation(&request.model, at_rest.equilibrium.model);
    let limit = match request.below_hz {
        Some(given) => at_rest.modes_limit(Some(given), linearisation)?,
        None => at_rest.response_limit(linearisation)?,
    };
    let ModesBelow { dynamics, modes: found, mut warnings } =
        at_rest.modes_with_strains(linearisation, limit, modes::MAX_MODES)?;
    warnings.extend(at_rest.without_damping());
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
    warnings.extend(under_wrench.as_ref().and_then(|under| under.caveat(&release.held)));
    let held_exact_m = under_wrench.and_then(|under| Some(under.found?.0.into()));
    let history = history(&release, surely_settled_s);
    let distance = |row: &HistoryRow| Vec3::new(row.x_m, row.y_m, row.z_m).norm();
    Ok(Settled {
        robot: at_rest.robot.name.clone(),
        below_hz: limit,
        models: Models::of(at_rest, linearisation),
        tolerance_m: tolerance,
        held_m: release.held.into(),
        held_exact_m,
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

/// Refuses an equilibrium about which nothing swings linearly, or to which nothing returns.
fn check_rest(AtRest { robot, equilibrium, .. }: &AtRest) -> Result<()> {
    let is_slack = |i: &usize| equilibrium.model != StaticModel::Ideal && equilibrium.cables[*i].is_slack();
    if let Some(i) = (0..robot.cables.len()).find(is_slack) {
        let name = &robot.cables[i].name;
        return Err(NoSolution(format!(
            "cable \"{name}\" is slack after the release: it pulls in one direction only, and the linear motion does not \
             know that; choose a state without slack cables, or the static model `catenary`"
        ))
        .into());
    }
    if matches!(equilibrium.stability, Stability::Unstable { .. }) {
        return Err(NoSolution(
            "the equilibrium is not stable: the platform does not come to rest there; choose another pose".to_owned(),
        )
        .into());
    }
    Ok(())
}

/// Equilibrium under the wrench, before the release.
struct UnderWrench {
    /// Displacement of the point from its rest, and the names of the cables that are slack; `None` if there is no such
    /// equilibrium.
    found: Option<(Vec3, Vec<String>)>,
}

impl UnderWrench {
    /// `None` for ideal cables, which no wrench displaces.
    fn of(AtRest { robot, equilibrium, .. }: &AtRest, request: &SettleRequest) -> Option<Self> {
        if equilibrium.model == StaticModel::Ideal {
            return None;
        }
        let [force, moment] = [request.release_n, request.release_n_m].map(|of| Vec3::from(of.unwrap_or_default()));
        let point_p = Vec3::from(request.points.input_point_m.unwrap_or_default());
        let mut loaded = robot.clone();
        let load = &mut loaded.load;
        load.moment_w += moment;
        if load.force_w == Vec3::zeros() {
            load.point_p = point_p;
        } else {
            // Two forces at different points: the arm of the released one is that at rest.
            load.moment_w += (equilibrium.pose.rot_wp * (point_p - load.point_p)).cross(&force);
        }
        load.force_w += force;

        let lengths: Vec<f64> = equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect();
        let under = statics::forward(&loaded, &lengths, equilibrium.model, Some(&equilibrium.pose)).ok();
        let measured_p = Vec3::from(request.points.output_point_m.unwrap_or_default());
        let place = |pose: &Pose| pose.position_w + pose.rot_wp * measured_p;
        let found = under.map(|under| {
            let slack = under.cables.iter().zip(&robot.cables).filter(|(state, _)| state.is_slack());
            let names = slack.map(|(_, cable)| format!("\"{}\"", cable.name)).collect();
            (place(&under.pose) - place(&equilibrium.pose), names)
        });
        Some(Self { found })
    }

    /// Caveat if the linear displacement is not that of the equilibrium, or a cable is slack there.
    fn caveat(&self, linear: &Vec3) -> Option<String> {
        let Some((exact, slack)) = &self.found else {
            return Some(
                "there is no equilibrium with this force or moment at these lengths: the linear motion after its release \
                 is not what happens; release less"
                    .to_owned(),
            );
        };
        if !slack.is_empty() {
            return Some(format!(
                "before the release {} slack: the linear motion does not know that; release less",
                if let [one] = &slack[..] {
                    format!("cable {one} is")
                } else {
                    format!("cables {} are", slack.join(", "))
                }
            ));
        }
        let gap = (linear - exact).norm() / exact.norm();
        (gap > NOT_LINEAR).then(|| {
            format!(
                "the release is not small: the linear displacement before it is {} mm, that of the equilibrium {} mm; \
                 amplitudes and the history are wrong by as much",
                significant(1e3 * linear.norm(), 4),
                significant(1e3 * exact.norm(), 4)
            )
        })
    }
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

impl HistoryRow {
    fn columns() -> Columns<Self> {
        let place = |row: &Self| [row.x_m, row.y_m, row.z_m];
        Columns::new([
            column("t_s", "s", "time since the release", |row: &Self| row.t_s),
            parts("{}_m", AXES, "m", "displacement of the point from its rest, {}", place),
            column("envelope_m", "m", "bound of its distance from its rest", |row: &Self| row.envelope_m),
        ])
    }
}

impl SettlingMode {
    /// Columns of the modes that take part.
    pub fn columns() -> Columns<Self> {
        Columns::new([
            column("frequency_hz", "Hz", "frequency of the damped mode", |mode: &Self| mode.frequency_hz)
                .decimals("f", "Hz", 4),
            column("damping_ratio", "1", "damping ratio", |mode: &Self| mode.damping_ratio).shown(
                "damping",
                "%",
                |mode, style| style.significant(100.0 * mode.damping_ratio, 3),
            ),
            column("amplitude_m", "m", "amplitude at the release", |mode: &Self| mode.amplitude_m).shown(
                "amplitude",
                "mm",
                |mode, style| style.significant(1e3 * mode.amplitude_m, 3),
            ),
            column("settled_s", "s", "time in which this amplitude alone falls to the tolerance", |mode: &Self| {
                mode.settled_s
            })
            .significant("to the tolerance", "s", 3),
        ])
    }
}

impl Tabled for Settled {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", HistoryRow::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(HistoryRow::columns(), &self.history)
    }
}

found!(Settled, "settle");
