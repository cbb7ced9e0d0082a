//! `observability`: numbers that sensors determine at poses at rest, before any reading.

mod cases;

use super::shared::AXES;
use super::{candidate_poses, found};
use crate::Watch;
use crate::at_rest;
use crate::columns::{ResultTable, Style, Tabled};
use crate::error::{Cancelled, NoSolution};
use crate::names::{Named, SensorSet};
use crate::request::ObservabilityRequest;
use crate::rows::rows;
use crate::table::Column;
use crate::text::{significant, with_unit};
use anyhow::{Result, anyhow, bail};
use cases::{Case, CasePlan, RestingPlace};
use funicular::robot::{Robot, State};
use funicular::statics::{StaticModel, TensionRule, solve_at};

/// Maximum number of poses: each is estimated with the readings of all others.
const MAX_POSES: usize = 30;

/// Part of the deviation without the sensors down to which a number is known by their readings: they give three
/// quarters of what is known about it then.
const MOSTLY_READ: f64 = 0.5;

/// Part from which on a number is as the encoders and what was known beforehand give it.
const AS_BEFORE: f64 = 0.9;

/// Numbers that the encoders give: the others have a prior of their own.
const OF_ENCODERS: [&str; 3] = ["position", "turn", "tension"];

rows! {
    /// Results of `observability`.
    pub struct Observed {
        pub robot: String = hidden;
        /// Sensors besides the encoders of all cables.
        pub sensors: Vec<&'static str>;
        /// Number of poses.
        pub poses: usize;
        /// Numbers of the state with their deviations.
        pub numbers: Vec<ObservedNumber>;
        /// Deviations with the encoders alone, with these sensors, and with each sensor or pose besides.
        pub cases: Vec<ObservedCase>;
        /// Addition that reduces the deviations of all numbers most, by the product of their ratios.
        pub best_addition: Option<String>;
        /// Sentences on numbers that these sensors do not determine.
        pub not_determined: Vec<String>;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Number of the state with its standard deviation, the worst of all poses and cables.
    pub struct ObservedNumber {
        /// Number.
        pub number: String;
        /// Unit of the deviations.
        pub unit: &'static str;
        /// Standard deviation with these sensors.
        pub std: f64;
        /// Standard deviation with the encoders alone.
        pub std_of_lengths: f64;
        /// `sensors` if their readings give most of what is known, `partly`; otherwise `encoders` for pose and
        /// tensions, `prior` for what was known beforehand, or `given` if it was known exactly.
        pub determined: &'static str;
        /// Addition that reduces this deviation most; absent if none reduces it by a tenth.
        pub best_addition: Option<String>;
        /// Standard deviation with this addition.
        pub std_with_addition: Option<f64>;
    }
}

/// Largest component, as a table shows it.
fn largest(of: [f64; 3], factor: f64, style: Style) -> String {
    style.significant(factor * of.into_iter().fold(0.0, f64::max), 3)
}

rows! {
    /// Standard deviations with some sensors, the worst of all poses and cables.
    pub struct ObservedCase in tables() with {
        let position = |of: &Self, style: Style| largest(of.position_std_m, 1e3, style);
        let turn = |of: &Self, style: Style| largest(of.rotation_std_deg, 1.0, style);
        let force = |of: &Self, style: Style| largest(of.force_std_n, 1.0, style);
    } rows {
        /// Sensors or poses.
        pub with: String => one.plain("with");
        /// Standard deviation of the position, {}.
        pub position_std_m: [f64; 3] => each(AXES).shown("position ±", "mm", position);
        /// Standard deviation of small turns about the world's axes, {}.
        pub rotation_std_deg: [f64; 3] => each(AXES).shown("turn ±", "deg", turn);
        /// Standard deviation of the payload.
        pub payload_std_kg: f64 => one.significant("payload ±", 3);
        /// Standard deviation of the payload's first moment, platform axes, {}.
        pub first_moment_std_kg_m: [f64; 3] => each(AXES);
        /// Standard deviation of the external force, {}.
        pub force_std_n: [f64; 3] => each(AXES).shown("force ±", "N", force);
        /// Standard deviation of the external moment, {}.
        pub moment_std_n_m: [f64; 3] => each(AXES);
        /// Standard deviation of the constant error of a length.
        pub offset_std_m: f64 => one.shown("offset ±", "mm", |of, style| style.significant(1e3 * of.offset_std_m, 3));
        /// Standard deviation of the constant error of a load cell.
        ///
        /// Absent without load cells.
        pub tension_bias_std_n: Option<f64> => one.significant("bias ±", 3);
        /// Standard deviation of the tension of a cable.
        pub tension_std_n: f64 => one.significant("tension ±", 3);
    }
}

impl ObservedCase {
    /// Numbers with their names, units and deviations.
    fn numbers(&self) -> Vec<(String, &'static str, f64)> {
        let mut found = Vec::new();
        let mut three = |what: &str, unit: &'static str, of: [f64; 3]| {
            found.extend(AXES.into_iter().zip(of).map(|(axis, std)| (format!("{what} {axis}"), unit, std)));
        };
        three("position", "m", self.position_std_m);
        three("turn about", "deg", self.rotation_std_deg);
        three("force", "N", self.force_std_n);
        three("moment", "N m", self.moment_std_n_m);
        three("first moment", "kg m", self.first_moment_std_kg_m);
        found.push(("payload".to_owned(), "kg", self.payload_std_kg));
        found.push(("offset of a length".to_owned(), "m", self.offset_std_m));
        found.push(("tension of a cable".to_owned(), "N", self.tension_std_n));
        found
    }
}

impl Tabled for Observed {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", ObservedCase::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(ObservedCase::columns(), &self.cases)
    }
}

found!(Observed, "observability");

/// Computes which numbers sensors determine.
///
/// # Errors
/// A request that contradicts itself or the robot, a pose without an equilibrium, a robot that the filter does not
/// follow, or work that was stopped.
pub fn run(robot: Robot, request: &ObservabilityRequest, watch: &mut dyn Watch) -> Result<Observed> {
    let sensors = sensors(&request.sensors)?;
    if request.state.static_model != StaticModel::Catenary {
        bail!("the estimator works with elastic catenaries: leave out ⟪static_model⟫");
    }
    if request.state.hold_lengths_of_pose {
        bail!("every pose has its own lengths here: leave out ⟪hold_lengths_of_pose⟫");
    }
    let robot = at_rest::with_limits(&at_rest::with_state(robot, &request.state)?, &request.tensions)?;
    let rule = at_rest::rule(&request.tensions)?.unwrap_or_default();
    let places = places(&robot, request, &rule)?;

    // Without the sensors, with them, and with one thing more.
    let settings = request.model.settings();
    let plan = CasePlan::new(&robot, settings, places)?;
    let mut cases = vec![Case::of("encoders alone", &[]), Case::of("these sensors", &sensors)];
    cases.extend(further_sensors(&robot, &sensors));
    let further = further_places(&robot, &plan, request.further_pose_m, &rule);
    cases.extend(further.into_iter().map(|(name, place)| Case { further: Some(place), ..Case::of(&name, &sensors) }));
    let count = cases.len();
    let mut rows: Vec<ObservedCase> = Vec::with_capacity(count);
    for (k, case) in cases.iter().enumerate() {
        if watch.is_cancelled() {
            return Err(Cancelled.into());
        }
        match plan.observe(case) {
            Ok(row) => rows.push(row),
            // A further pose that the filter does not reach is no addition.
            Err(_) if case.further.is_some() => {}
            Err(error) => return Err(NoSolution(error.to_string()).into()),
        }
        watch.progress(k + 1, count, "cases");
    }

    let numbers = numbers(&rows);
    Ok(Observed {
        robot: robot.name.clone(),
        sensors: sensors.iter().map(|sensor| sensor.name()).collect(),
        poses: plan.count(),
        not_determined: not_determined(&numbers, request),
        best_addition: best_addition(&rows),
        numbers,
        cases: rows,
        warnings: Vec::new(),
    })
}

/// Sensors of a request.
fn sensors(names: &[String]) -> Result<Vec<SensorSet>> {
    let found: Vec<SensorSet> = (names.iter())
        .map(|name| SensorSet::from_name(name).map_err(|reason| anyhow!("⟪sensors⟫: {reason}")))
        .collect::<Result<_>>()?;
    if let Some(twice) = (1..found.len()).find(|k| found[..*k].contains(&found[*k])) {
        bail!("⟪sensors⟫ has {} twice", found[twice].name());
    }
    if found.contains(&SensorSet::None) && found.len() > 1 {
        bail!("⟪sensors⟫ has none and others: give none alone, or leave it out");
    }
    Ok(found.into_iter().filter(|sensor| *sensor != SensorSet::None).collect())
}

/// Poses of a request with their lengths.
fn places(robot: &Robot, request: &ObservabilityRequest, rule: &TensionRule) -> Result<Vec<RestingPlace>> {
    let rows = candidate_poses::of_places(&request.places, &request.state, robot)?;
    let states = match rows {
        Some(rows) => rows.iter().map(|row| State::Pose(candidate_poses::pose(row))).collect(),
        None => vec![robot.state.clone()],
    };
    if states.len() > MAX_POSES || states.is_empty() {
        bail!("there are {} poses: give 1 to {MAX_POSES}", states.len());
    }
    states.iter().map(|state| place_of(robot, state, rule)).collect()
}

/// Equilibrium of a state.
fn place_of(robot: &Robot, state: &State, rule: &TensionRule) -> Result<RestingPlace> {
    let rest = solve_at(robot, state, StaticModel::Catenary, rule)?.equilibrium;
    Ok(RestingPlace { lengths: rest.cables.iter().map(|cable| cable.unstrained_length).collect(), pose: rest.pose })
}

/// Sensors that are not there yet, each alone; load cells also one by one.
fn further_sensors<'a>(robot: &'a Robot, sensors: &'a [SensorSet]) -> impl Iterator<Item = Case> + 'a {
    let whole = SensorSet::ALL.iter().filter(|sensor| **sensor != SensorSet::None && !sensors.contains(sensor));
    let whole = whole.map(move |sensor| {
        let name = format!("and {}", sensor.name());
        Case::of(&name, &[sensors, &[*sensor]].concat())
    });
    let has_cells = sensors.contains(&SensorSet::Tensions);
    let single = robot.cables.iter().enumerate().filter(move |_| !has_cells).map(|(i, cable)| {
        let name = format!("and the load cell of cable {}", cable.name);
        Case { cell: Some(i), ..Case::of(&name, sensors) }
    });
    whole.chain(single)
}

/// Further poses at a distance from the last one along the axes in which the platform moves, as far as cables hold it
/// there.
fn further_places(robot: &Robot, plan: &CasePlan, distance: f64, rule: &TensionRule) -> Vec<(String, RestingPlace)> {
    let last = plan.last_pose();
    let mut found = Vec::new();
    for direction in robot.platform.motion.translations_w() {
        for step in [direction * distance, -direction * distance] {
            let mut pose = last;
            pose.position_w += step;
            if let Ok(place) = place_of(robot, &State::Pose(pose), rule) {
                let [x, y, z] = <[f64; 3]>::from(step).map(|part| significant(part + 0.0, 3));
                found.push((format!("and a pose at a distance of ({x}, {y}, {z}) m"), place));
            }
        }
    }
    found
}

/// Numbers beside the encoders alone, and the best addition to each.
fn numbers(rows: &[ObservedCase]) -> Vec<ObservedNumber> {
    let all: Vec<_> = rows.iter().map(ObservedCase::numbers).collect();
    let [alone, with, additions @ ..] = all.as_slice() else { return Vec::new() };
    (alone.iter().zip(with).enumerate())
        .map(|(k, ((number, unit, alone), (.., std)))| {
            let part = std / alone.max(f64::MIN_POSITIVE);
            let determined = match () {
                () if *alone == 0.0 => "given",
                () if part <= MOSTLY_READ => "sensors",
                () if part < AS_BEFORE => "partly",
                () if OF_ENCODERS.iter().any(|of| number.starts_with(of)) => "encoders",
                () => "prior",
            };
            let best = (additions.iter().zip(&rows[2..]))
                .map(|(of, row)| (of[k].2, &row.with))
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .filter(|(best, _)| *best < AS_BEFORE * std);
            ObservedNumber {
                number: number.clone(),
                unit,
                std: *std,
                std_of_lengths: *alone,
                determined,
                best_addition: best.map(|(_, name)| name.clone()),
                std_with_addition: best.map(|(std, _)| std),
            }
        })
        .collect()
}

/// Addition with the smallest product of the deviations, if it is smaller than without.
fn best_addition(rows: &[ObservedCase]) -> Option<String> {
    let size = |row: &ObservedCase| {
        row.numbers().into_iter().filter(|(.., std)| *std > 0.0).map(|(.., std)| std.ln()).sum::<f64>()
    };
    let (with, additions) = (rows.get(1)?, rows.get(2..)?);
    let best = additions.iter().min_by(|a, b| size(a).total_cmp(&size(b)))?;
    (size(best) < size(with)).then(|| best.with.clone())
}

/// Sentences on numbers that stay as they were known.
fn not_determined(numbers: &[ObservedNumber], request: &ObservabilityRequest) -> Vec<String> {
    let mut found: Vec<String> = (numbers.iter().filter(|of| of.determined == "prior"))
        .map(|of| {
            let remedy = match (&of.best_addition, of.std_with_addition) {
                (Some(best), Some(std)) => {
                    let best = best.trim_start_matches("and ");
                    format!("{best} would make it ± {}", with_unit(&significant(std, 3), of.unit))
                }
                _ => "no single sensor or pose tried here tells it".to_owned(),
            };
            let std = with_unit(&significant(of.std, 3), of.unit);
            format!("{}: ± {std} is what was known beforehand; {remedy}", of.number)
        })
        .collect();
    if request.model.payload_std_kg > 0.0 && request.model.force_std_n > 0.0 {
        found.push(
            "payload and vertical external force are one number at one time: over several poses the payload is the \
             part that stays"
                .to_owned(),
        );
    }
    found
}
