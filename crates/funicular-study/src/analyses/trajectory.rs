//! `trajectory`: lengths, tensions and winches while the platform moves along a path, and what limits the motion.

mod at_time;
mod fastest;
mod instants;
mod job;
mod jumps;
mod length_commands;
mod passing;
mod planned;
mod rounded;
mod rows;
mod samples;
mod stations;
mod told;
mod used;

pub use length_commands::{LengthCommand, SlackCable};
pub use planned::check as check_path;
pub use rows::TrajectoryRow;
pub use stations::Stations;

use super::found;
use super::shared::Origin;
use super::timed_rows::{MAX_SAMPLES, count_of_steps, in_steps};
use crate::at_rest::{self, AtRest};
use crate::columns::{Columns, ResultTable, Tabled, column, parts};
use crate::request::TrajectoryRequest;
use crate::rows::rows;
use crate::table::Column;
use crate::text::significant;
use crate::watch::Watch;
use anyhow::{Result, bail};
use funicular::clearance::Surroundings;
use funicular::path::{PathCorner, PlatformPath};
use funicular::robot::Robot;
use funicular::statics::{Equilibrium, StaticModel, TensionRule};
use funicular::trajectory::AlongPath;
use jumps::JumpCause;
use rounded::RoundedRows;
use samples::MotionSamples;
use used::UsedLimit;

/// Key of the request that has the table of a path.
const KEY: &str = "path";

/// Number of parts of a path between its rows, if nothing says how many.
const PARTS: f64 = 200.0;

/// Number of parts of a path whose ends are computed beside the rows: every phase has at least eight of its own, and of
/// a smooth peak between two of 400 parts less than a thousandth is lost.
const OWN_PARTS: usize = 400;

/// Part of a row beyond the last one that counts as rounding.
const ROUNDING: f64 = 1e-9;

/// Part of the acceleration below whose highest frequency the motion counts, and frequency over the lowest one of a
/// cable from which on cables at rest are in doubt: the sag's part of their compliance is then wrong by 6 %.
const POWER: f64 = 0.95;
const DOUBTFUL: f64 = 0.3;

/// Largest number of times at which the robot is kept for pictures.
const MAX_FRAMES: usize = 61;

rows! {
    /// Results of `trajectory`.
    pub struct TrajectoryResult {
        pub robot: String = hidden;
        pub static_model: &'static str;
        pub origin: Origin = spread;
        pub duration_s: f64;
        /// True if every limit of tensions, winches and distances is kept on the whole path.
        pub within_limits: bool;
        /// Limit of which the largest part is used; absent if the robot file has none. All of a minimum tension is used
        /// where the rule holds a cable there by its choice.
        pub most_used: Option<MostUsed>;
        /// Largest used part of every kind of limit: of a maximum tension T/T_max, of a minimum tension T_min/T.
        pub used: Vec<MostUsed>;
        /// Smallest factor with which the inertia is the largest one that any tensions within their limits hold; absent
        /// where the cables leave no choice of tensions.
        pub inertia_factor: Option<f64>;
        /// Largest and lowest numbers on the path, with cable and time.
        pub extremes: Vec<Extreme>;
        /// Largest sums over all winches of the powers that drive and that brake; absent without winches.
        pub sums: Option<PowerSums>;
        /// Nearest pair on the path; absent if the robot file says nothing about distances.
        pub nearest: Option<Nearest>;
        /// Times at which a tension reaches a limit or leaves it: the rates of all lengths jump there.
        pub limit_changes: Vec<LimitChange>;
        /// Times at which a derivative of the path jumps, and with it lengths or their rates.
        pub path_jumps: Vec<PathJump>;
        /// Times at which the rule of tensions goes over to other tensions, and with them the lengths.
        pub rule_jumps: Vec<RuleJump>;
        /// Sentences that explain the largest numbers.
        pub notes: Vec<String>;
        pub quasi_static: Option<QuasiStatic>;
        /// Controller with straight lines between its stations; absent if no length bends.
        pub stations: Option<Stations>;
        /// Tensions under a controller that commands lengths alone, with computed and with geometric lengths; absent
        /// for a robot with as many cables as degrees of freedom.
        pub length_commands: Vec<LengthCommand> = sparse;
        /// Distances at which the path passes the poses on its way; absent without such poses.
        pub misses_m: Vec<f64> = sparse;
        /// Names of the cables, in the order of all lists.
        pub cables: Vec<String>;
        pub rows: Vec<TrajectoryRow>;
        /// Robot at some of the times, for pictures.
        pub frames: Vec<(f64, Equilibrium)> = hidden;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Limit of which a motion uses the largest part.
    #[derive(Clone)]
    pub struct MostUsed {
        /// `maximum-tension`, `minimum-tension`, `speed`, `acceleration`, `torque`, `power`, `brake-power` or
        /// `clearance`.
        pub limit: &'static str;
        pub cable: Option<String>;
        pub t_s: f64;
        /// Used over allowed; absent where nothing is allowed, and where a speed or an acceleration has no bound.
        pub part: Option<f64>;
    }
}

rows! {
    /// Largest or lowest number on a path.
    pub struct Extreme {
        /// Name of the number.
        pub what: &'static str;
        /// Largest beside the jumps where the number has no bound; absent where rates jump because tensions reach
        /// limits, or other conditions hold them, near which they change too fast for a number that does not depend on
        /// the rows.
        pub value: Option<f64>;
        pub unit: &'static str;
        pub cable: String;
        pub t_s: f64;
        /// Reason why the number has no bound, with the place of the largest jump.
        pub no_bound: Option<String>;
    }
}

rows! {
    /// Jump of lengths or of their rates where a derivative of the path jumps.
    pub struct PathJump {
        pub t_s: f64;
        /// `acceleration` or `jerk` of the platform.
        pub of: &'static str;
        /// Cable with the largest jump.
        pub cable: String;
        /// Jump of its length; absent if it is continuous.
        pub length_m: Option<f64>;
        /// Jump of its rate.
        pub rate_m_s: Option<f64>;
    }
}

rows! {
    /// Jump of the rule of tensions.
    pub struct RuleJump {
        pub t_s: f64;
        /// Cable with the largest jump of the tension.
        pub cable: String;
        pub tension_n: f64;
        /// Jump of the length of the cable whose length jumps most.
        pub length_m: f64;
    }
}

rows! {
    /// Largest sums of powers, each with its time.
    pub struct PowerSums {
        pub driving_power_w: f64;
        pub driving_t_s: f64;
        pub braking_power_w: f64;
        pub braking_t_s: f64;
    }
}

rows! {
    /// Nearest pair on a path.
    pub struct Nearest {
        pub pair: String;
        pub distance_m: f64;
        pub required_m: f64;
        pub t_s: f64;
    }
}

rows! {
    /// Limit that a tension reaches or leaves.
    pub struct LimitChange {
        pub t_s: f64;
        pub cable: String;
        /// `minimum` or `maximum`.
        pub limit: &'static str;
        /// True if the tension is at the limit afterwards.
        pub reached: bool;
    }
}

rows! {
    /// Frequencies of the motion and of the cables.
    pub struct QuasiStatic {
        /// Frequency below which 95 % of the square of the acceleration lie.
        pub motion_hz: f64;
        /// Lowest frequency of a cable as a taut string between fixed ends, on the whole path.
        pub cable_hz: f64;
    }
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
    /// Rows with so few digits that their rounding is part of the motion.
    rounded: Option<RoundedRows>,
}

/// Limits of which the used part is told.
#[derive(Debug, Clone, Copy)]
struct JudgedLimits {
    /// True if a rule chooses the tensions: they are within their limits, or there are none.
    choice: bool,
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
            "{} cables do not hold the pose of a platform with {} degrees of freedom: only a robot with at least as \
             many cables follows a path of poses",
            robot.cables.len(),
            robot.platform.motion.count()
        );
    }
    let state = planned::state(&robot, request)?;
    let at_rest = at_rest::equilibrium(robot, &request.robot, &state, &request.tensions)?;
    let AtRest { robot, equilibrium: start, rule, .. } = &at_rest;
    let planned::PathOfRequest { path, times, rounded } = planned::path(robot, &start.pose, request)?;
    let has_choice = rule.is_some();
    let rule = rule.clone().unwrap_or_default();
    let asked = Planned {
        robot,
        model: start.model,
        judged: JudgedLimits { choice: has_choice, clearance: robot.judges_clearance(), inertia: has_choice },
        rule,
        path,
        rope_inertia: request.motion.rope_inertia,
        rounded,
    };

    let planned = if request.motion.fastest { fastest::fastest(&asked, watch)? } else { asked.clone() };
    let factor = planned.path.duration() / asked.path.duration();
    let own = times.map(|times| times.iter().map(|time| time * factor).collect());
    let times = sample_times(planned.path.duration(), request.motion.sample_time_s, own)?;
    let samples = MotionSamples::at(&planned, &times, OWN_PARTS, watch)?;
    found(&planned, &at_rest, &samples, request)
}

/// Times of the rows [s].
fn sample_times(duration: f64, step: Option<f64>, own: Option<Vec<f64>>) -> Result<Vec<f64>> {
    if let (None, Some(own)) = (step, own) {
        return Ok(own);
    }
    let step = step.unwrap_or(duration / PARTS);
    let count = count_of_steps(duration, step);
    if count > MAX_SAMPLES {
        bail!(
            "⟪sample_time_s⟫ gives {count} rows in {} s, and at most {MAX_SAMPLES} are computed: give a longer time",
            significant(duration, 4)
        );
    }
    Ok(in_steps(duration, step).collect())
}

/// Results of the samples.
fn found(
    planned: &Planned,
    at_rest: &AtRest,
    samples: &MotionSamples,
    request: &TrajectoryRequest,
) -> Result<TrajectoryResult> {
    let robot = planned.robot;
    let parts: Vec<_> = (0..samples.times.len()).map(|k| used::parts(samples, planned, k)).collect();
    let used: Vec<Option<(UsedLimit, f64)>> = parts.iter().map(|parts| used::most(parts)).collect();
    let between_rows = || samples.rows.windows(2).map(|pair| samples.times[pair[1]] - samples.times[pair[0]]);
    let interval = request.motion.station_time_s.unwrap_or_else(|| between_rows().fold(0.0, f64::max));
    let stations = Stations::of(planned, samples, interval, request.motion.length_tolerance_m)?;
    let quasi_static = quasi_static(planned, samples);
    let warnings = warnings(at_rest, planned, samples, request, quasi_static.as_ref());
    let extremes = extremes(planned, samples);

    Ok(TrajectoryResult {
        robot: robot.name.clone(),
        static_model: planned.model.name(),
        origin: Origin::of(at_rest),
        duration_s: planned.path.duration(),
        within_limits: used.iter().flatten().all(|(_, part)| *part <= 1.0 + ROUNDING)
            && samples.passing.as_ref().is_none_or(|passing| passing.too_near().is_none()),
        most_used: most_used(robot, samples, &used),
        used: largest_used(robot, samples, &parts),
        inertia_factor: used::part_of_inertia(planned, &samples.motions)
            .filter(|part| *part > 0.0)
            .map(|part| 1.0 / part),
        notes: told::notes(planned, samples, &extremes),
        extremes,
        sums: power_sums(robot, samples),
        nearest: nearest(robot, samples),
        limit_changes: limit_changes(robot, samples),
        path_jumps: path_jumps(robot, samples),
        rule_jumps: rule_jumps(robot, samples),
        quasi_static,
        stations,
        length_commands: length_commands::of(planned, samples),
        misses_m: planned.path.misses(),
        cables: robot.cables.iter().map(|cable| cable.name.clone()).collect(),
        rows: (0..samples.rows.len())
            .map(|row| TrajectoryRow::of(robot, samples, row, used[samples.rows[row]].as_ref()))
            .collect(),
        frames: frames(samples),
        warnings,
    })
}

/// Equilibria at evenly chosen rows, the first and the last among them.
fn frames(samples: &MotionSamples) -> Vec<(f64, Equilibrium)> {
    let (last, parts) = (samples.rows.len() - 1, MAX_FRAMES - 1);
    let chosen = |k: usize| if last <= parts { k } else { (k * last + parts / 2) / parts };
    let frame = |k: usize| (samples.times[k], samples.motions[k].equilibrium.clone());
    (0..=last.min(parts)).map(chosen).map(|row| frame(samples.rows[row])).collect()
}

fn most_used(robot: &Robot, samples: &MotionSamples, used: &[Option<(UsedLimit, f64)>]) -> Option<MostUsed> {
    let each = samples.times.iter().zip(used).filter_map(|(time, used)| used.map(|used| (*time, used)));
    let each = each.chain(used::between_rows(samples));
    let (time, used) = each.max_by(|a, b| a.1.1.total_cmp(&b.1.1)).filter(|(_, (_, part))| *part > 0.0)?;
    Some(MostUsed::of(robot, time, used))
}

/// Largest used part of every kind of limit, the largest first.
fn largest_used(robot: &Robot, samples: &MotionSamples, parts: &[Vec<(UsedLimit, f64)>]) -> Vec<MostUsed> {
    let mut found: Vec<(f64, MostUsed)> = Vec::new();
    let each = parts.iter().zip(&samples.times).flat_map(|(parts, time)| parts.iter().map(move |of| (*time, *of)));
    let each = each.chain(used::between_rows(samples));
    for (time, (limit, part)) in each.filter(|(_, (_, part))| *part > 0.0) {
        let of = || MostUsed::of(robot, time, (limit, part));
        match found.iter_mut().find(|(_, of)| of.limit == limit.name()) {
            Some(last) if part > last.0 => *last = (part, of()),
            Some(_) => {}
            None => found.push((part, of())),
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.into_iter().map(|(_, of)| of).collect()
}

impl MostUsed {
    fn of(robot: &Robot, t_s: f64, (limit, part): (UsedLimit, f64)) -> Self {
        Self {
            limit: limit.name(),
            cable: limit.cable().map(|i| robot.cables[i].name.clone()),
            t_s,
            part: part.is_finite().then_some(part),
        }
    }
}

/// Names of the extremes that have no bound where lengths or their rates jump.
const SPEED: &str = "largest speed";
const ACCELERATION: &str = "largest acceleration";

/// Largest and lowest tension, speed and acceleration of a cable, and what the motors do.
fn extremes(planned: &Planned, samples: &MotionSamples) -> Vec<Extreme> {
    let robot = planned.robot;
    /// Number of a cable at a time, by their indices; `None` where there is none.
    type Number<'a> = dyn Fn(usize, usize) -> Option<f64> + 'a;
    let state = |k: usize, i: usize| &samples.motions[k].equilibrium.cables[i];
    let motor = |k: usize, i: usize| samples.winch(robot, k, i).motor;
    let all: [(&str, &str, &Number); 8] = [
        ("largest tension", "N", &|k, i| Some(state(k, i).tension_platform.max(state(k, i).tension_anchor))),
        ("lowest tension", "N", &|k, i| Some(-state(k, i).tension_platform.min(state(k, i).tension_anchor))),
        (SPEED, "m/s", &|k, i| Some(samples.winch(robot, k, i).speed.abs())),
        (ACCELERATION, "m/s²", &|k, i| Some(samples.winch(robot, k, i).acceleration.abs())),
        ("largest motor torque", "N m", &|k, i| motor(k, i)?.torque.map(f64::abs)),
        ("largest motor speed", "rad/s", &|k, i| motor(k, i)?.speed.map(f64::abs)),
        ("largest driving power", "W", &|k, i| motor(k, i).map(|motor| motor.power.max(0.0))),
        ("largest braking power", "W", &|k, i| motor(k, i).map(|motor| (-motor.power).max(0.0))),
    ];
    let (times, cables) = (samples.times.len(), robot.cables.len());
    let found = all.into_iter().filter_map(|(what, unit, number)| {
        let each = (0..times).flat_map(|k| (0..cables).filter_map(move |i| Some((k, i, number(k, i)?))));
        let (k, i, value) = each.max_by(|a, b| a.2.total_cmp(&b.2))?;
        Some(Extreme {
            what,
            value: (!told::jumps_at_kinks(samples, what)).then_some(value.abs()),
            unit,
            cable: robot.cables[i].name.clone(),
            t_s: samples.times[k],
            no_bound: told::no_bound(planned, samples, what),
        })
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
    let times = samples.rows.iter().map(|k| samples.times[*k]);
    let each = samples.nearest.iter().zip(times).filter_map(|(pair, t_s)| Some((pair.as_ref()?, t_s)));
    let between = samples.passing.as_ref().and_then(|passing| passing.too_near());
    let (pair, t_s) =
        each.chain(between.map(|(t_s, pair)| (pair, t_s))).min_by(|a, b| a.0.margin().total_cmp(&b.0.margin()))?;
    Some(Nearest {
        pair: Surroundings::of(robot).pair_text(pair.pair),
        distance_m: pair.distance,
        required_m: pair.required,
        t_s,
    })
}

/// Times at which tensions reach or leave their limits.
fn limit_changes(robot: &Robot, samples: &MotionSamples) -> Vec<LimitChange> {
    let of_jump = |jump: &jumps::LengthJump| {
        let changes = if let JumpCause::Limits(changes) = &jump.cause { changes.clone() } else { Vec::new() };
        let (t_s, named) = (jump.time, |i: usize| robot.cables[i].name.clone());
        let row = move |(i, limit, reached): (usize, funicular::statics::Limit, bool)| LimitChange {
            t_s,
            cable: named(i),
            limit: limit.name(),
            reached,
        };
        changes.into_iter().map(row).collect::<Vec<_>>()
    };
    samples.jumps.iter().flat_map(of_jump).collect()
}

/// Jumps of lengths or rates where a derivative of the path jumps.
fn path_jumps(robot: &Robot, samples: &MotionSamples) -> Vec<PathJump> {
    let row = |jump: &jumps::LengthJump| {
        let JumpCause::Path(order) = jump.cause else { return None };
        let (lengths, rates) = (jump.length_jumps(), jump.rate_jumps());
        let (cable, _) = lengths.or(rates)?;
        Some(PathJump {
            t_s: jump.time,
            of: if order == 2 { "acceleration" } else { "jerk" },
            cable: robot.cables[cable].name.clone(),
            length_m: lengths.map(|(_, jump)| jump),
            rate_m_s: rates.map(|(_, jump)| jump),
        })
    };
    samples.jumps.iter().filter_map(row).collect()
}

/// Jumps of the rule of tensions.
fn rule_jumps(robot: &Robot, samples: &MotionSamples) -> Vec<RuleJump> {
    let row = |jump: &jumps::LengthJump| {
        let (cable, tension_n) = jump.tension_jump();
        let length_m = jump.length_jumps().map_or(0.0, |(_, jump)| jump);
        RuleJump { t_s: jump.time, cable: robot.cables[cable].name.clone(), tension_n, length_m }
    };
    samples.jumps.iter().filter(|jump| jump.cause == JumpCause::Rule).map(row).collect()
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
    planned: &Planned,
    samples: &MotionSamples,
    request: &TrajectoryRequest,
    quasi_static: Option<&QuasiStatic>,
) -> Vec<String> {
    let mut found: Vec<String> = at_rest.implausible().collect();
    if planned.path.corners().iter().any(|corner| corner.order < PathCorner::JERK) {
        found.push(
            "the acceleration jumps, and with it tensions and lengths: give ⟪jerk_m_s3⟫ (of a turn \
             ⟪angular_jerk_rad_s3⟫), or the course `septic`"
                .to_owned(),
        );
    }
    found.extend(planned::beyond_limits(&planned.path, &request.motion));
    found.extend(planned.rounded.as_ref().map(RoundedRows::warning));
    found.extend(told::rule_that_jumps(planned, samples));
    if let Some(QuasiStatic { motion_hz, cable_hz }) = quasi_static.filter(|of| of.motion_hz > DOUBTFUL * of.cable_hz) {
        found.push(format!(
            "the motion has parts up to {} Hz, more than {DOUBTFUL} of the {} Hz at which a cable swings, so that \
             cables do not hang as at rest: repeat it with `simulate`",
            significant(*motion_hz, 3),
            significant(*cable_hz, 3)
        ));
    }
    if let Some(passing::Passing::Undecided { time }) = samples.passing {
        found.push(format!(
            "at {} s and elsewhere a pair stays so near to its required distance that the verdict between the rows is \
             open: require a little less, or more, in [clearance]",
            significant(time, 4)
        ));
    }
    let by_differences = samples.motions.iter().filter_map(|motion| motion.no_exact_rates.as_ref());
    if let Some(reason) = by_differences.clone().next() {
        found.push(format!(
            "the rates of the lengths are differences over 0.2 ms at {} of {} rows, where they have no derivatives: \
             {reason}",
            by_differences.count(),
            samples.times.len()
        ));
    }
    found
}

impl TrajectoryResult {
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
