//! `trajectory`: lengths, tensions and winches while the platform moves along a path, and what limits the motion.

mod fastest;
mod planned;
mod rows;
mod samples;
mod stations;

pub use planned::check as check_path;
pub use rows::TrajectoryRow;
pub use stations::Stations;

use super::found;
use super::shared::Origin;
use super::timed_rows::MAX_SAMPLES;
use crate::at_rest::{self, AtRest};
use crate::columns::{Columns, ResultTable, Tabled, column, parts};
use crate::request::TrajectoryRequest;
use crate::table::Column;
use crate::text::significant;
use crate::watch::Watch;
use anyhow::{Result, bail};
use funicular::clearance::Surroundings;
use funicular::path::{CourseForm, PlatformPath};
use funicular::robot::Robot;
use funicular::statics::{Equilibrium, Limit, StaticModel, TensionRule};
use funicular::trajectory::AlongPath;
use samples::{MotionSamples, UsedLimit};
use serde::Serialize;

/// Key of the request that has the table of a path.
const KEY: &str = "path";

/// Number of parts of a path between its rows, if nothing says how many.
const PARTS: f64 = 200.0;

/// Part of a row beyond the last one that counts as rounding.
const ROUNDING: f64 = 1e-9;

/// Part of the acceleration below whose highest frequency the motion counts, and frequency over the lowest one of a
/// cable from which on cables at rest are in doubt: the sag's part of their compliance is then wrong by 6 %.
const POWER: f64 = 0.95;
const DOUBTFUL: f64 = 0.3;

/// Relative error to which the times of changed limits are found.
const HALVINGS: usize = 20;

/// Largest number of times at which the robot is kept for pictures.
const MAX_FRAMES: usize = 61;

/// Largest number of times of changed limits.
const MAX_CHANGES: usize = 100;

/// Results of `trajectory`.
#[derive(Serialize)]
pub struct TrajectoryResult {
    #[serde(skip)]
    pub robot: String,
    pub static_model: &'static str,
    #[serde(flatten)]
    pub origin: Origin,
    pub duration_s: f64,
    /// True if every limit of tensions, winches and distances is kept at all rows.
    pub within_limits: bool,
    /// Limit of which the largest part is used; absent if the robot file has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub most_used: Option<MostUsed>,
    /// Largest and lowest numbers on the path, with cable and time.
    pub extremes: Vec<Extreme>,
    /// Largest sums over all winches of the powers that drive and that brake; absent without winches.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sums: Option<PowerSums>,
    /// Nearest pair on the path; absent if the robot file says nothing about distances.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nearest: Option<Nearest>,
    /// Times at which a tension reaches a limit or leaves it: the rates of all lengths jump there.
    pub limit_changes: Vec<LimitChange>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quasi_static: Option<QuasiStatic>,
    /// Controller with straight lines between its stations; absent if no length bends.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stations: Option<Stations>,
    /// Distances at which the path passes the poses on its way; absent without such poses.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub misses_m: Vec<f64>,
    /// Names of the cables, in the order of all lists.
    pub cables: Vec<String>,
    pub rows: Vec<TrajectoryRow>,
    /// Robot at some of the times, for pictures.
    #[serde(skip)]
    pub frames: Vec<(f64, Equilibrium)>,
    #[serde(skip)]
    pub warnings: Vec<String>,
}

/// Limit of which a motion uses the largest part.
#[derive(Serialize)]
pub struct MostUsed {
    /// `maximum-tension`, `minimum-tension`, `speed`, `acceleration`, `torque`, `power`, `brake-power` or `clearance`.
    pub limit: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cable: Option<String>,
    pub t_s: f64,
    /// Used over allowed; absent where nothing is allowed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<f64>,
}

/// Largest or lowest number on a path.
#[derive(Serialize)]
pub struct Extreme {
    /// Name of the number.
    pub what: &'static str,
    pub value: f64,
    pub unit: &'static str,
    pub cable: String,
    pub t_s: f64,
}

/// Largest sums of powers, each with its time.
#[derive(Serialize)]
pub struct PowerSums {
    pub driving_power_w: f64,
    pub driving_t_s: f64,
    pub braking_power_w: f64,
    pub braking_t_s: f64,
}

/// Nearest pair on a path.
#[derive(Serialize)]
pub struct Nearest {
    pub pair: String,
    pub distance_m: f64,
    pub required_m: f64,
    pub t_s: f64,
}

/// Limit that a tension reaches or leaves.
#[derive(Serialize)]
pub struct LimitChange {
    pub t_s: f64,
    pub cable: String,
    /// `minimum` or `maximum`.
    pub limit: &'static str,
    /// True if the tension is at the limit afterwards.
    pub reached: bool,
}

/// Frequencies of the motion and of the cables.
#[derive(Serialize)]
pub struct QuasiStatic {
    /// Frequency below which 95 % of the square of the acceleration lie.
    pub motion_hz: f64,
    /// Lowest frequency of a cable as a taut string between fixed ends, on the whole path.
    pub cable_hz: f64,
}

/// Path that a robot has to follow.
#[derive(Clone)]
struct Planned<'a> {
    robot: &'a Robot,
    model: StaticModel,
    rule: TensionRule,
    path: PlatformPath,
    rope_inertia: bool,
    judged: JudgedLimits,
}

/// Limits of which the used part is told.
#[derive(Debug, Clone, Copy)]
struct JudgedLimits {
    /// Minimum tensions; where a rule aims at them, they are no limit of the motion.
    minimum_tensions: bool,
    /// Distances.
    clearance: bool,
    /// Inertia, compared with the largest one that any tensions hold; only for tensions by choice.
    inertia: bool,
}

impl<'a> Planned<'a> {
    fn along(&self) -> AlongPath<'a> {
        AlongPath::new(self.robot, self.model, self.rule.clone(), self.rope_inertia)
    }

    fn slowed(&self, factor: f64) -> Self {
        Self { path: self.path.slowed(factor), ..self.clone() }
    }
}

/// Computes the motion along a path.
///
/// # Errors
/// Several paths or none, a path that is none, a time at which the cables do not hold the platform within their limits,
/// or [`Cancelled`](crate::error::Cancelled).
pub fn run(robot: Robot, request: &TrajectoryRequest, watch: &mut dyn Watch) -> Result<TrajectoryResult> {
    if robot.constraint().is_under() {
        bail!(
            "{} cables do not hold the pose of a platform with {} degrees of freedom: only a robot with at least as many \
             cables follows a path of poses",
            robot.cables.len(),
            robot.platform.motion.count()
        );
    }
    let state = planned::state(&robot, request)?;
    let at_rest = at_rest::equilibrium(robot, &request.robot, &state, &request.tensions)?;
    let AtRest { robot, equilibrium: start, rule, .. } = &at_rest;
    let (path, times) = planned::path(robot, &start.pose, request)?;
    let has_choice = rule.is_some();
    let rule = rule.clone().unwrap_or_default();
    let asked = Planned {
        robot,
        model: start.model,
        judged: JudgedLimits {
            minimum_tensions: !(has_choice && rule == TensionRule::Lowest),
            clearance: robot.judges_clearance(),
            inertia: has_choice,
        },
        rule,
        path,
        rope_inertia: request.motion.rope_inertia,
    };

    let planned = if request.motion.fastest { fastest::fastest(&asked, watch)? } else { asked.clone() };
    let factor = planned.path.duration() / asked.path.duration();
    let own = times.map(|times| times.iter().map(|time| time * factor).collect());
    let times = sample_times(planned.path.duration(), request.motion.sample_time_s, own)?;
    let samples = MotionSamples::at(&planned, times, watch)?;
    found(&planned, &at_rest, &samples, request)
}

/// Times of the rows [s].
fn sample_times(duration: f64, step: Option<f64>, own: Option<Vec<f64>>) -> Result<Vec<f64>> {
    if let (None, Some(own)) = (step, own) {
        return Ok(own);
    }
    let count = step.map_or(PARTS, |step| (duration / step - ROUNDING).ceil().max(1.0));
    if count > MAX_SAMPLES {
        bail!(
            "⟪sample_time_s⟫ gives {count} rows in {} s, and at most {MAX_SAMPLES} are computed: give a longer time",
            significant(duration, 4)
        );
    }
    Ok((0..=count as usize).map(|k| duration * k as f64 / count).collect())
}

/// Results of the samples.
fn found(
    planned: &Planned,
    at_rest: &AtRest,
    samples: &MotionSamples,
    request: &TrajectoryRequest,
) -> Result<TrajectoryResult> {
    let robot = planned.robot;
    let used: Vec<Option<(UsedLimit, f64)>> = (0..samples.times.len()).map(|k| samples.most_used(planned, k)).collect();
    let interval = request
        .motion
        .station_time_s
        .unwrap_or_else(|| samples.times.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max));
    let stations = Stations::of(planned, samples, interval, request.motion.length_tolerance_m)?;
    let quasi_static = quasi_static(planned, samples);
    let warnings = warnings(at_rest, samples, request, quasi_static.as_ref());

    Ok(TrajectoryResult {
        robot: robot.name.clone(),
        static_model: planned.model.name(),
        origin: Origin::of(at_rest),
        duration_s: planned.path.duration(),
        within_limits: used.iter().flatten().all(|(_, part)| *part <= 1.0 + ROUNDING),
        most_used: most_used(robot, samples, &used),
        extremes: extremes(robot, samples),
        sums: power_sums(robot, samples),
        nearest: nearest(robot, samples),
        limit_changes: limit_changes(planned, samples)?,
        quasi_static,
        stations,
        misses_m: planned.path.misses(),
        cables: robot.cables.iter().map(|cable| cable.name.clone()).collect(),
        rows: (0..samples.times.len()).map(|k| TrajectoryRow::of(robot, samples, k, used[k].as_ref())).collect(),
        frames: frames(samples),
        warnings,
    })
}

/// Equilibria at evenly chosen samples, the first and the last among them.
fn frames(samples: &MotionSamples) -> Vec<(f64, Equilibrium)> {
    let (last, parts) = (samples.times.len() - 1, MAX_FRAMES - 1);
    let chosen = |k: usize| if last <= parts { k } else { (k * last + parts / 2) / parts };
    (0..=last.min(parts)).map(chosen).map(|k| (samples.times[k], samples.motions[k].equilibrium.clone())).collect()
}

fn most_used(robot: &Robot, samples: &MotionSamples, used: &[Option<(UsedLimit, f64)>]) -> Option<MostUsed> {
    let each = used.iter().enumerate().filter_map(|(k, used)| used.map(|used| (k, used)));
    let (k, (limit, part)) = each.max_by(|a, b| a.1.1.total_cmp(&b.1.1)).filter(|(_, (_, part))| *part > 0.0)?;
    Some(MostUsed {
        limit: limit.name(),
        cable: limit.cable().map(|i| robot.cables[i].name.clone()),
        t_s: samples.times[k],
        part: part.is_finite().then_some(part),
    })
}

/// Largest and lowest tension, speed and acceleration of a cable, and what the motors do.
fn extremes(robot: &Robot, samples: &MotionSamples) -> Vec<Extreme> {
    /// Number of a cable at a time, by their indices; `None` where there is none.
    type Number<'a> = dyn Fn(usize, usize) -> Option<f64> + 'a;
    let state = |k: usize, i: usize| &samples.motions[k].equilibrium.cables[i];
    let motor = |k: usize, i: usize| samples.winch(robot, k, i).motor;
    let all: [(&str, &str, &Number); 8] = [
        ("largest tension", "N", &|k, i| Some(state(k, i).tension_platform.max(state(k, i).tension_anchor))),
        ("lowest tension", "N", &|k, i| Some(-state(k, i).tension_platform.min(state(k, i).tension_anchor))),
        ("largest speed", "m/s", &|k, i| Some(samples.winch(robot, k, i).speed.abs())),
        ("largest acceleration", "m/s²", &|k, i| Some(samples.winch(robot, k, i).acceleration.abs())),
        ("largest motor torque", "N m", &|k, i| motor(k, i)?.torque.map(f64::abs)),
        ("largest motor speed", "rad/s", &|k, i| motor(k, i)?.speed.map(f64::abs)),
        ("largest driving power", "W", &|k, i| motor(k, i).map(|motor| motor.power.max(0.0))),
        ("largest braking power", "W", &|k, i| motor(k, i).map(|motor| (-motor.power).max(0.0))),
    ];
    let (times, cables) = (samples.times.len(), robot.cables.len());
    let found = all.into_iter().filter_map(|(what, unit, number)| {
        let each = (0..times).flat_map(|k| (0..cables).filter_map(move |i| Some((k, i, number(k, i)?))));
        let (k, i, value) = each.max_by(|a, b| a.2.total_cmp(&b.2))?;
        Some(Extreme { what, value: value.abs(), unit, cable: robot.cables[i].name.clone(), t_s: samples.times[k] })
    });
    found.collect()
}

/// Largest sums of the powers of all motors; `None` without winches.
fn power_sums(robot: &Robot, samples: &MotionSamples) -> Option<PowerSums> {
    let powers = |k: usize| (0..robot.cables.len()).filter_map(move |i| Some(samples.winch(robot, k, i).motor?.power));
    powers(0).next()?;
    let largest = |sign: f64| {
        let sum = |k: usize| (k, powers(k).map(|power| (sign * power).max(0.0)).sum::<f64>());
        (0..samples.times.len()).map(sum).max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0))
    };
    let ((driving, driving_power_w), (braking, braking_power_w)) = (largest(1.0), largest(-1.0));
    let [driving_t_s, braking_t_s] = [driving, braking].map(|k| samples.times[k]);
    Some(PowerSums { driving_power_w, driving_t_s, braking_power_w, braking_t_s })
}

/// Pair with the least margin.
fn nearest(robot: &Robot, samples: &MotionSamples) -> Option<Nearest> {
    let each = samples.nearest.iter().zip(&samples.times).filter_map(|(pair, t_s)| Some((pair.as_ref()?, t_s)));
    let (pair, t_s) = each.min_by(|a, b| a.0.margin().total_cmp(&b.0.margin()))?;
    Some(Nearest {
        pair: Surroundings::of(robot).pair_text(pair.pair),
        distance_m: pair.distance,
        required_m: pair.required,
        t_s: *t_s,
    })
}

/// Times between the samples at which tensions reach or leave their limits.
///
/// # Errors
/// A time at which the cables do not hold the platform.
fn limit_changes(planned: &Planned, samples: &MotionSamples) -> Result<Vec<LimitChange>> {
    let mut found = Vec::new();
    if !planned.judged.inertia {
        // Tensions that are no matter of choice pass their limits smoothly.
        return Ok(found);
    }
    let mut along = planned.along();
    for (pair, times) in samples.motions.windows(2).zip(samples.times.windows(2)) {
        let (before, mut after, [mut from, mut to]) =
            (&pair[0].at_limit, pair[1].at_limit.clone(), [times[0], times[1]]);
        if *before == after || found.len() >= MAX_CHANGES {
            continue;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (from + to);
            let at = samples::in_motion(&mut along, planned, middle)?.at_limit;
            if at == *before { from = middle } else { (to, after) = (middle, at) }
        }
        for (i, (before, after)) in before.iter().zip(&after).enumerate().filter(|(_, (before, after))| before != after)
        {
            let cable = planned.robot.cables[i].name.clone();
            let change =
                |limit: Limit, reached| LimitChange { t_s: to, cable: cable.clone(), limit: limit.name(), reached };
            found.extend(before.map(|limit| change(limit, false)));
            found.extend(after.map(|limit| change(limit, true)));
        }
    }
    Ok(found)
}

/// Frequencies that say how far cables at rest may be trusted; `None` without a rope that has mass, or without motion.
fn quasi_static(planned: &Planned, samples: &MotionSamples) -> Option<QuasiStatic> {
    let motion_hz = planned.path.frequency_below_which(POWER, planned.robot.platform_length());
    let frequencies = samples.motions.iter().filter_map(|motion| motion.lowest_string_frequency(planned.robot));
    let cable_hz = frequencies.reduce(f64::min)?;
    (motion_hz > 0.0).then_some(QuasiStatic { motion_hz, cable_hz })
}

fn warnings(
    at_rest: &AtRest,
    samples: &MotionSamples,
    request: &TrajectoryRequest,
    quasi_static: Option<&QuasiStatic>,
) -> Vec<String> {
    let mut found: Vec<String> = at_rest.implausible().collect();
    if request.path.is_none() && request.motion.jerk_m_s3.is_none() && request.motion.course == CourseForm::JerkLimited
    {
        found.push(
            "the acceleration jumps, and with it tensions and lengths: give ⟪jerk_m_s3⟫, or the course `quintic`"
                .to_owned(),
        );
    }
    if let Some(QuasiStatic { motion_hz, cable_hz }) = quasi_static.filter(|of| of.motion_hz > DOUBTFUL * of.cable_hz) {
        found.push(format!(
            "a cable swings at {} Hz, and the motion has parts up to {} Hz: it is faster than cables that hang as at rest \
             allow; repeat it with `simulate`",
            significant(*cable_hz, 3),
            significant(*motion_hz, 3)
        ));
    }
    let by_differences = samples.motions.iter().filter_map(|motion| motion.no_exact_rates.as_ref());
    if let Some(reason) = by_differences.clone().next() {
        found.push(format!(
            "the rates of the lengths are differences over 0.2 ms at {} of {} rows, where they have no derivatives: {reason}",
            by_differences.count(),
            samples.times.len()
        ));
    }
    found
}

impl TrajectoryResult {
    /// Sentence on the limits.
    pub fn verdict(&self) -> String {
        let Some(of) = &self.most_used else {
            return "The robot file has no limit of tensions, winches or distances for this path.".to_owned();
        };
        let cable = of.cable.as_ref().map_or_else(String::new, |cable| format!(" of cable \"{cable}\""));
        let part = of.part.map_or_else(
            || "where nothing is allowed".to_owned(),
            |part| format!("used to {} %", significant(100.0 * part, 4)),
        );
        format!(
            "{}; the nearest is the {}{cable}, {part} at {} s.",
            if self.within_limits { "Within all limits" } else { "BEYOND a limit" },
            of.limit.replace('-', " "),
            significant(of.t_s, 4)
        )
    }

    /// Lengths over time as a controller reads them.
    pub fn lengths_table(&self) -> ResultTable<'_> {
        let names = self.cables.clone();
        let columns = Columns::new([
            column("t_s", "s", "time since the start of the path", |row: &TrajectoryRow| row.t_s),
            parts("unstrained_length_{}_m", names, "m", "unstrained length of cable {}", |row: &TrajectoryRow| {
                row.unstrained_lengths_m.clone()
            }),
        ]);
        ResultTable::new(columns, &self.rows)
    }
}

impl Tabled for TrajectoryResult {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", TrajectoryRow::columns(&["NAME".to_owned()], true, true).described())]
    }

    fn table(&self) -> ResultTable<'_> {
        let has_winches = self.rows.first().is_some_and(|row| !row.motor_powers_w.is_empty());
        ResultTable::new(TrajectoryRow::columns(&self.cables, has_winches, self.nearest.is_some()), &self.rows)
    }
}

found!(TrajectoryResult, "trajectory");
