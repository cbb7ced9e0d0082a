//! `simulate`: large motion in time, with its own error.

mod below;
mod error;
mod events;
mod keeping;
mod picture;
mod rows;
mod spectrum;

pub use below::BelowRow;
pub use error::{ColumnError, Peak};
pub use events::{ScenarioEvents, scenario_from_toml};
pub use keeping::{BegunRun, NothingKept, RowKeeper};
pub use picture::{EventMark, SimulatedFrame, SimulatedPicture, SlackSpan};
pub use rows::{RowNames, SimulatedRow};
pub use spectrum::MotionSpectrum;

use super::found;
use super::shared::Origin;
use crate::at_rest::{self, AtRest};
use crate::columns::{ResultTable, Tabled};
use crate::error::{Cancelled, NoSolution};
use crate::request::{PointValue, SimulateRequest};
use crate::rows::rows;
use crate::table::Column;
use crate::text::significant;
use crate::values::finite;
use crate::watch::Watch;
use anyhow::{Result, anyhow, bail};
use below::BelowGround;
use error::errors;
use funicular::clearance::{Clearance, ClearancePair, Surroundings};
use funicular::math::Vec3;
use funicular::robot::{PlatformMotion, Robot, Solid};
use funicular::simulation::{
    ElementMesh, LossOfMode, RestFault, RobotSample, Simulation, SimulationError, SimulationSettings, StepCounts,
};
use keeping::STATE_ROWS;

/// Number of parts of the duration between its rows, if nothing says how many.
const PARTS: f64 = 1000.0;
/// Largest number of rows.
const MAX_ROWS: f64 = 2e6;
/// Tolerance of the finer run over that of the first.
const FINER: f64 = 0.1;

rows! {
    /// Results of `simulate`.
    pub struct Simulated {
        pub robot: String = hidden;
        pub origin: Origin = spread;
        pub duration_s: f64;
        /// Time at which the run was stopped from outside; absent if it came to its end.
        pub stopped_at_s: Option<f64>;
        pub elements: usize;
        pub degree: usize;
        pub tolerance_m: f64;
        pub steps: StepNumbers;
        /// Cables that were slack, with the time at which their tension first fell below 0.5 N.
        pub slack: Vec<SlackRow>;
        /// Cables that failed.
        pub cuts: Vec<CutRow>;
        /// Time at which the parts of the robot are nearest; absent if its file says nothing about distances.
        pub nearest: Option<NearestRow>;
        /// Parts of the robot that are behind the surface of a half space, such as below a floor, in some rows; nothing
        /// stops them. Absent if there are none.
        pub below: Vec<BelowRow> = sparse;
        /// Largest error of the energy balance [J].
        pub energy_defect_j: f64;
        /// True if slack ropes with mass make the history depend on the mesh, so that its peaks are statistics.
        pub is_statistical: bool;
        /// Loss of the stretch in each mode of the platform at the start; absent without a loss factor.
        pub stretch_losses: Vec<StretchLossRow> = sparse;
        /// Bound of the error of each column, from its difference from a finer run; absent without one.
        pub errors: Vec<ColumnError> = sparse;
        /// Largest tensions, and root mean squares, of this run and of the finer one.
        pub peaks: Vec<Peak>;
        /// Names of the cables, in the order of all lists.
        pub cables: Vec<String>;
        /// Names of the chosen points, in the order of all lists.
        pub points: Vec<String> = sparse;
        pub rows: Vec<SimulatedRow>;
        /// Robot at some of the times, for pictures.
        pub picture: SimulatedPicture = hidden;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// StepNumbers of a run.
    #[derive(Clone, Copy)]
    pub struct StepNumbers {
        pub accepted: usize;
        pub rejected: usize;
        pub factored: usize;
        pub evaluations: usize;
    }
}

rows! {
    /// Slack of one cable.
    pub struct SlackRow {
        pub cable: String;
        pub first_s: f64;
        /// Time for which it was slack, over that of the simulation.
        pub share: f64;
    }
}

rows! {
    /// Least margin of all rows.
    #[derive(Clone)]
    pub struct NearestRow {
        pub t_s: f64;
        /// Distance beyond the required one.
        pub margin_m: f64;
        /// Things that are nearest, in words; absent for a row of a run that was continued.
        pub pair: Option<String>;
    }
}

impl NearestRow {
    /// Sentence on it.
    pub fn in_words(&self) -> String {
        let (margin, time) = (significant(1e3 * self.margin_m.abs(), 3), significant(self.t_s, 4));
        let pair = self.pair.as_ref().map_or_else(String::new, |pair| format!(", between {pair}"));
        let word = if self.margin_m < 0.0 { "less" } else { "more" };
        format!("The least distance is {margin} mm {word} than required, at {time} s{pair}.")
    }
}

rows! {
    /// Loss of the stretch of ropes in one mode of the platform. In time it is a damping time, which has the loss
    /// factor at one frequency only.
    pub struct StretchLossRow in tables() {
        /// Natural frequency of the platform on massless ropes.
        pub frequency_hz: f64 => one.significant("mode", 4);
        /// Share of the stretch in the energy of deformation.
        pub stretch_share: f64 => one.significant("stretch", 2);
        /// Damping ratio by the losses of the robot file.
        pub damping_ratio: f64 => one.significant("ratio", 2);
        /// Damping ratio in this run.
        pub damping_ratio_in_time: f64 => one.significant("in time", 2);
    }
}

impl StretchLossRow {
    fn of(loss: &LossOfMode) -> Self {
        let LossOfMode { frequency_hz, stretch_share, ratio, ratio_in_time } = *loss;
        Self { frequency_hz, stretch_share, damping_ratio: ratio, damping_ratio_in_time: ratio_in_time }
    }
}

rows! {
    /// Cable that failed.
    pub struct CutRow {
        pub cable: String;
        pub t_s: f64;
    }
}

/// Simulates a robot.
///
/// # Errors
/// A scenario that cannot happen, a part of the robot that is not simulated, a tolerance that no step reaches, or
/// [`Cancelled`] before the first row.
pub fn run(robot: Robot, request: &SimulateRequest, watch: &mut dyn Watch) -> Result<Simulated> {
    run_with(robot, request, watch, &mut NothingKept, None)
}

/// Simulates a robot, from a run that has begun if there is one, and gives each new row of the first run to a keeper.
///
/// # Errors
/// Those of [`run`] and of the keeper; a run that belongs to another request.
pub fn run_with(
    robot: Robot,
    request: &SimulateRequest,
    watch: &mut dyn Watch,
    keeper: &mut dyn RowKeeper,
    begun: Option<BegunRun>,
) -> Result<Simulated> {
    let at_rest = at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?;
    let vibrating = at_rest.vibrating();
    let events = ScenarioEvents::of(&request.scenario, &vibrating)?;
    let settings = settings(request)?;
    let times = times(request)?;
    check_points(&request.point, &vibrating.robot)?;
    let course = Course { at_rest: &vibrating, events: &events, times: &times, points: &request.point };

    let first = course.history(&settings, watch, keeper, begun)?;
    let mut without_finer = None;
    let finer = if request.once || first.rows.len() < times.len() {
        None
    } else {
        let settings = SimulationSettings {
            mesh: settings.mesh.finer(),
            tolerance: FINER * settings.tolerance,
            ..settings.clone()
        };
        // A run that is stopped or fails here still has the rows of the first one.
        match course.history(&settings, watch, &mut NothingKept, None) {
            Ok(finer) => Some(finer).filter(|finer| finer.rows.len() == times.len()),
            Err(error) if error.is::<Cancelled>() => None,
            Err(error) => {
                without_finer = Some(format!(
                    "the error is not known, because the run with a finer mesh and tolerance failed: {error:#}; the \
                     rows of the first run may be as wrong: give a larger ⟪tolerance_m⟫, or other ⟪elements⟫"
                ));
                None
            }
        }
    };
    let idle = events::idle(&vibrating, &events.list, &events.labels, &first.cuts);
    let mut found = found(&at_rest, request, first, finer.as_ref());
    found.warnings.extend(idle.into_iter().chain(without_finer));
    Ok(found)
}

/// Rows of one run.
struct History {
    rows: Vec<SimulatedRow>,
    picture: SimulatedPicture,
    slack: Vec<SlackRow>,
    cuts: Vec<CutRow>,
    nearest: Option<NearestRow>,
    below: Vec<BelowRow>,
    losses: Vec<StretchLossRow>,
    counts: StepCounts,
}

/// Parts that both runs have in common.
struct Course<'a> {
    at_rest: &'a AtRest,
    events: &'a ScenarioEvents,
    times: &'a [f64],
    points: &'a [PointValue],
}

/// Refuses points that the platform does not have, and names that two points share.
fn check_points(points: &[PointValue], robot: &Robot) -> Result<()> {
    for (k, point) in points.iter().enumerate() {
        let name = &point.name;
        if name.is_empty() || points[..k].iter().any(|other| other.name == *name) {
            bail!("⟪point⟫: the name \"{name}\" is empty or stands twice: give every point a name of its own");
        }
        for x in point.point_m {
            finite(x).map_err(|reason| anyhow!("⟪point⟫ {name}: {reason}"))?;
        }
        let is_origin = point.point_m.iter().all(|x| *x == 0.0);
        if robot.platform.motion == PlatformMotion::PointMass && !is_origin {
            bail!("⟪point⟫ {name}: a point mass has no point except its origin: give {name}=0,0,0, or leave it out");
        }
    }
    Ok(())
}

fn settings(request: &SimulateRequest) -> Result<SimulationSettings> {
    let [least, most] = SimulationSettings::TOLERANCES;
    if !(least..=most).contains(&request.tolerance_m) {
        bail!("⟪tolerance_m⟫ is {} m: give {least} to {most} m", request.tolerance_m);
    }
    Ok(SimulationSettings {
        mesh: ElementMesh { elements: request.elements, degree: request.degree },
        tolerance: request.tolerance_m,
        damping_frequency_hz: request.damping_frequency_hz,
        stretch_damping_time: request.stretch_damping_time_s,
        platform_is_held: request.hold_platform,
        gust_seed: request.gust_seed.map(u64::from),
    })
}

/// Times of the rows [s].
fn times(request: &SimulateRequest) -> Result<Vec<f64>> {
    let duration = request.duration_s;
    let count = request.sample_time_s.map_or(PARTS, |step| (duration / step - 1e-9).ceil().max(1.0));
    if count > MAX_ROWS {
        bail!(
            "⟪sample_time_s⟫ gives {count} rows in {duration} s, and at most {MAX_ROWS} are kept: give a longer time"
        );
    }
    let step = request.sample_time_s.unwrap_or(duration / count);
    Ok((0..=count as usize).map(|k| (step * k as f64).min(duration)).collect())
}

impl Course<'_> {
    /// One run. Work that is stopped from outside keeps the rows so far.
    fn history(
        &self,
        settings: &SimulationSettings,
        watch: &mut dyn Watch,
        keeper: &mut dyn RowKeeper,
        begun: Option<BegunRun>,
    ) -> Result<History> {
        let Self { at_rest: AtRest { robot, equilibrium, .. }, events, times, points } = *self;
        let duration = times[times.len() - 1];
        let mut simulation = Simulation::new(robot, equilibrium, &events.list, duration, settings)
            .map_err(|error| events.told(error))?;
        let mut rows = Vec::with_capacity(times.len());
        if let Some(begun) = begun {
            if begun.rows.len() > times.len() || !simulation.restore(&begun.state) {
                bail!("the run that has begun belongs to another request: discard it");
            }
            rows.extend(begun.rows);
        }
        let mut picture = SimulatedPicture::new(robot, equilibrium, &events.list);
        let around = robot.judges_clearance().then(|| Surroundings::of(robot));
        let mut nearest = nearest_of(&rows);
        let mut below = BelowGround::new(robot, &simulation.parted());
        for (k, time) in times.iter().enumerate().skip(rows.len()) {
            if watch.is_cancelled() {
                if rows.is_empty() {
                    return Err(Cancelled.into());
                }
                break;
            }
            let sample = simulation.at(*time).map_err(|error| events.told(error))?;
            picture.keep(&mut simulation, &sample, k, times.len());
            let curves = if around.is_some() { simulation.curves_w(*time) } else { Vec::new() };
            let clearance =
                around.as_ref().and_then(|around| Some((around, nearest_of_sample(around, robot, &sample, &curves)?)));
            below.look(*time, &sample.pose, &curves);
            if let Some((around, clearance)) = clearance
                && nearest.as_ref().is_none_or(|nearest| clearance.margin() < nearest.margin_m)
            {
                let pair = Some(around.pair_text(clearance.pair));
                nearest = Some(NearestRow { t_s: *time, margin_m: clearance.margin(), pair });
            }
            let row = SimulatedRow::of(&sample, points, clearance.map(|(_, clearance)| clearance.margin()));
            keeper.row(&row)?;
            rows.push(row);
            if rows.len() % STATE_ROWS == 0 {
                keeper.state(rows.len(), &simulation.state())?;
            }
            watch.progress(k + 1, times.len(), "rows");
        }
        picture.end(&simulation);
        Ok(History { nearest, below: below.rows(), ..History::new(robot, &simulation, rows, picture) })
    }
}

/// Pair with the least margin at one time. A cable that has failed falls, so that its distance from a floor says
/// nothing; [`BelowGround`] tells where it is.
fn nearest_of_sample(
    around: &Surroundings,
    robot: &Robot,
    sample: &RobotSample,
    curves_w: &[Vec<Vec3>],
) -> Option<Clearance> {
    let counts = |pair: ClearancePair| match pair {
        ClearancePair::CableAndObstacle { cable, obstacle } => {
            !(sample.cables[cable].is_cut && robot.obstacles[obstacle].solid == Solid::HalfSpace)
        }
        _ => true,
    };
    around.least_through_of(&sample.pose, curves_w, &counts)
}

/// Row with the least margin.
fn nearest_of(rows: &[SimulatedRow]) -> Option<NearestRow> {
    let margins = rows.iter().filter_map(|row| Some((row.t_s, row.clearance_margin_m?)));
    let (t_s, margin_m) = margins.min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(NearestRow { t_s, margin_m, pair: None })
}

impl History {
    fn new(robot: &Robot, simulation: &Simulation, rows: Vec<SimulatedRow>, picture: SimulatedPicture) -> Self {
        let reached = rows.last().map_or(0.0, |row| row.t_s);
        let name = |i: usize| robot.cables[i].name.clone();
        let slack = simulation.slack().iter().enumerate().filter_map(|(i, of)| {
            Some(SlackRow { cable: name(i), first_s: of.first?, share: (of.duration / reached).min(1.0) })
        });
        Self {
            slack: slack.collect(),
            cuts: simulation.cuts().iter().map(|(i, t_s)| CutRow { cable: name(*i), t_s: *t_s }).collect(),
            losses: simulation.losses().iter().map(StretchLossRow::of).collect(),
            counts: simulation.counts(),
            nearest: None,
            below: Vec::new(),
            rows,
            picture,
        }
    }
}

/// Warning about the nearest pair if it is too near.
fn too_near(NearestRow { t_s, margin_m, pair }: &NearestRow) -> Option<String> {
    let pair = pair.as_deref().unwrap_or("two parts of the robot");
    (*margin_m < 0.0).then(|| {
        format!(
            "{pair} are nearer than required by {} mm at {} s; the simulation goes on as if they did not touch",
            significant(-1e3 * margin_m, 3),
            significant(*t_s, 4)
        )
    })
}

fn found(at_rest: &AtRest, request: &SimulateRequest, first: History, finer: Option<&History>) -> Simulated {
    let RowNames { cables, points, .. } = RowNames::of(&at_rest.robot, &request.point);
    let has_mass = |name: &str| {
        at_rest.robot.cables.iter().any(|cable| cable.name == name && cable.material.mass_per_length > 0.0)
    };
    let is_statistical = first.slack.iter().any(|slack| has_mass(&slack.cable));
    let mesh = ElementMesh { elements: request.elements, degree: request.degree };
    let (errors, peaks) = errors(&cables, &first.rows, finer.map(|finer| &finer.rows[..]), mesh);
    let reached = first.rows.last().map_or(0.0, |row| row.t_s);
    let is_whole = reached >= request.duration_s * (1.0 - 1e-12);
    let mut warnings: Vec<String> = at_rest.implausible().collect();
    warnings.extend(at_rest.rule_near_jump());
    if at_rest.robot.turbulence.is_some() && request.gust_seed.is_none() {
        warnings.push("the wind is its mean alone: ⟪gust_seed⟫ draws the gusts of its turbulence".to_owned());
    }
    if at_rest.robot.cables.iter().any(|cable| cable.anchor.pulley.as_ref().is_some_and(|of| of.friction.is_some())) {
        warnings.push("the friction of pulleys is left out".to_owned());
    }
    warnings.extend(first.nearest.as_ref().and_then(too_near));
    warnings.extend(below::warning(&first.below));
    if is_statistical {
        warnings.push(
            "ropes with mass go slack: from the first time on at which one is taut again the history depends on the \
             mesh, and peaks and root mean squares of the tensions are statistics, whose spread `peaks` shows"
                .to_owned(),
        );
    }
    let StepCounts { accepted, rejected, factored, evaluations } = first.counts;
    Simulated {
        robot: at_rest.robot.name.clone(),
        origin: Origin::of(at_rest),
        duration_s: request.duration_s,
        stopped_at_s: (!is_whole).then_some(reached),
        elements: request.elements,
        degree: request.degree,
        tolerance_m: request.tolerance_m,
        steps: StepNumbers { accepted, rejected, factored, evaluations },
        energy_defect_j: first.rows.iter().map(|row| row.energy_defect_j.abs()).fold(0.0, f64::max),
        slack: first.slack,
        cuts: first.cuts,
        nearest: first.nearest,
        below: first.below,
        is_statistical,
        stretch_losses: first.losses,
        errors,
        peaks,
        cables,
        points,
        rows: first.rows,
        picture: first.picture,
        warnings,
    }
}

impl Simulated {
    /// Names in the columns of the rows.
    pub fn names(&self) -> RowNames {
        let (cables, points) = (self.cables.clone(), self.points.clone());
        RowNames { cables, points, has_distances: self.nearest.is_some() }
    }

    /// Times at which cables are slack, by the rows.
    pub fn slack_spans(&self) -> Vec<SlackSpan> {
        picture::slack_spans(&self.rows, |i| {
            self.cuts.iter().find(|cut| cut.cable == self.cables[i]).map(|cut| cut.t_s)
        })
    }
}

impl Tabled for Simulated {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        let names = RowNames { cables: vec!["NAME".to_owned()], points: vec!["POINT".to_owned()], has_distances: true };
        vec![("", SimulatedRow::columns(&names).described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(SimulatedRow::columns(&self.names()), &self.rows)
    }
}

found!(Simulated, "simulate");

impl ScenarioEvents {
    /// Error of a simulation with the name of the event in the scenario.
    pub fn told(&self, error: SimulationError) -> anyhow::Error {
        match error {
            SimulationError::Event { event, fault } => {
                anyhow!("{} of ⟪scenario⟫: {fault}", self.labels.get(event).map_or("an event", String::as_str))
            }
            SimulationError::NoRest(RestFault::Coarse { .. } | RestFault::NotFound) => {
                NoSolution(format!("{error} (⟪elements⟫)")).into()
            }
            SimulationError::NoRest(_) => NoSolution(error.to_string()).into(),
            SimulationError::NoFrequency => anyhow!("{error} (⟪damping_frequency_hz⟫)"),
            SimulationError::TooFast { .. } => anyhow!("{error} (⟪tolerance_m⟫, ⟪elements⟫, ⟪stretch_damping_time_s⟫)"),
            other => anyhow!("{other}"),
        }
    }
}
