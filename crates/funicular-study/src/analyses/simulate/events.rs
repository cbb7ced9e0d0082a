//! Events of a scenario: from the words of a file to what the simulation knows.

use super::CutRow;
use crate::analyses::anchor_table::AnchorTable;
use crate::analyses::timed_rows::{Holds, TimedRows};
use crate::at_rest::AtRest;
use crate::names::suggestion;
use crate::request::{self, AnchorEvent, CutEvent, LengthsEvent, NumberColumns, Scenario, check_scenario};
use crate::text::short;
use crate::values::finite;
use anyhow::{Context, Result, anyhow, bail};
use funicular::math::Vec3;
use funicular::robot::{Robot, State};
use funicular::simulation::{CommandedLengths, CutAt, SimulationEvent};
use funicular::statics;
use serde_json::Value;

/// ScenarioEvents in the order of the scenario, with their names in messages.
pub struct ScenarioEvents {
    pub list: Vec<SimulationEvent>,
    pub labels: Vec<String>,
}

impl ScenarioEvents {
    /// Events of a scenario for a robot at rest.
    ///
    /// # Errors
    /// A name or a number that is none; the message names the event.
    pub fn of(scenario: &Scenario, at_rest: &AtRest) -> Result<Self> {
        let mut events = Self { list: Vec::new(), labels: Vec::new() };
        let robot = &at_rest.robot;
        events.add("release", &scenario.release, |of| {
            Ok(SimulationEvent::Release {
                time: number("at_s", of.at_s)?,
                mass: number("mass_kg", of.mass_kg)?,
                point_p: point("point_m", of.point_m)?,
            })
        })?;
        events.add("pick", &scenario.pick, |of| {
            Ok(SimulationEvent::Pick {
                time: number("at_s", of.at_s)?,
                mass: number("mass_kg", of.mass_kg)?,
                point_p: point("point_m", of.point_m)?,
                velocity_w: point("velocity_m_s", of.velocity_m_s)?,
            })
        })?;
        events.add("lengths", &scenario.lengths, |of| lengths(of, at_rest))?;
        events.add("tension", &scenario.tension, |of| {
            let mut tensions = vec![None; robot.cables.len()];
            for (name, tension) in &of.tension_n {
                tensions[cable(robot, name)?] = Some(number("tension_n", *tension)?);
            }
            Ok(SimulationEvent::Tension {
                time: number("at_s", of.at_s)?,
                duration: number("duration_s", of.duration_s)?,
                tensions,
            })
        })?;
        events.add("stop", &scenario.stop, |of| {
            let all = || (0..robot.cables.len()).map(Ok).collect::<Result<Vec<usize>>>();
            let named = |names: &Vec<String>| names.iter().map(|name| cable(robot, name)).collect();
            Ok(SimulationEvent::Stop {
                time: number("at_s", of.at_s)?,
                duration: number("duration_s", of.duration_s)?,
                cables: of.cables.as_ref().map_or_else(all, named)?,
            })
        })?;
        events.add("push", &scenario.push, |of| {
            let vector = |key, of| point(key, Some(of)).map(Option::unwrap_or_default);
            Ok(SimulationEvent::Push {
                time: number("at_s", of.at_s)?,
                duration: number("duration_s", of.duration_s)?,
                rise: number("rise_s", of.rise_s)?,
                force_w: vector("force_n", of.force_n)?,
                moment_w: vector("moment_n_m", of.moment_n_m)?,
                point_p: vector("point_m", of.point_m)?,
            })
        })?;
        events.add("anchor", &scenario.anchor, |of| anchors(of, robot))?;
        events.add("cut", &scenario.cut, |of| cut(of, robot))?;
        Ok(events)
    }

    fn add<T>(&mut self, kind: &str, list: &[T], event: impl Fn(&T) -> Result<SimulationEvent>) -> Result<()> {
        for (k, of) in list.iter().enumerate() {
            let label = if list.len() == 1 { format!("[[{kind}]]") } else { format!("[[{kind}]] number {}", k + 1) };
            let event = event(of).with_context(|| format!("{label} of ⟪scenario⟫"))?;
            self.list.push(event);
            self.labels.push(label);
        }
        Ok(())
    }
}

/// Warnings about events that change nothing: brakes of winches that rest, and commands to winches whose cables have
/// failed.
pub(super) fn idle(at_rest: &AtRest, list: &[SimulationEvent], labels: &[String], cuts: &[CutRow]) -> Vec<String> {
    let AtRest { robot, equilibrium, .. } = at_rest;
    let cut = |i: usize, time: f64| cuts.iter().find(|cut| cut.cable == robot.cables[i].name && cut.t_s <= time);
    let mut warnings = Vec::new();
    for (k, (event, label)) in list.iter().zip(labels).enumerate() {
        let (time, cables) = match event {
            SimulationEvent::Ramp { time, changes, .. } => (*time, indices(changes, |change| *change != 0.0)),
            SimulationEvent::Follow { time, lengths, .. } => (*time, indices(lengths, Option::is_some)),
            SimulationEvent::Tension { time, tensions, .. } => (*time, indices(tensions, Option::is_some)),
            SimulationEvent::Stop { time, cables, .. } => (*time, cables.clone()),
            _ => continue,
        };
        if matches!(event, SimulationEvent::Stop { .. }) {
            // What begins later is not braked.
            let before = list.iter().enumerate().filter(|(j, of)| *j != k && of.time() <= Some(time));
            let before: Vec<SimulationEvent> = before.map(|(_, of)| of.clone()).collect();
            let moves = CommandedLengths::new(robot, equilibrium, &before, f64::MAX)
                .is_ok_and(|lengths| cables.iter().any(|i| lengths.moves_after(*i, time)));
            if !moves {
                let time = short(time, 6);
                warnings.push(format!("{label} of ⟪scenario⟫ brakes nothing: its winches rest at {time} s"));
            }
            continue;
        }
        // A table commands all winches, also those that it need not mention.
        let is_table = matches!(event, SimulationEvent::Follow { .. });
        for (i, cut) in cables.iter().filter(|_| !is_table).filter_map(|i| Some((*i, cut(*i, time)?))) {
            let massless = robot.cables[i].material.mass_per_length == 0.0;
            let effect = if massless { "it moves nothing" } else { "it moves only the rope that is left at the winch" };
            warnings.push(format!(
                "{label} of ⟪scenario⟫ commands cable \"{}\" at {} s, which has failed at {} s: {effect}",
                cut.cable,
                short(time, 6),
                short(cut.t_s, 6)
            ));
        }
    }
    warnings
}

/// Indices of the entries for which something is true.
fn indices<T>(list: &[T], is: impl Fn(&T) -> bool) -> Vec<usize> {
    list.iter().enumerate().filter(|(_, entry)| is(entry)).map(|(i, _)| i).collect()
}

fn number(key: &str, value: f64) -> Result<f64> {
    finite(value).map_err(|reason| anyhow!("`{key}`: {reason}"))
}

fn point(key: &str, value: Option<[f64; 3]>) -> Result<Option<Vec3>> {
    value
        .map(|value| {
            value.iter().try_for_each(|x| number(key, *x).map(|_| ()))?;
            Ok(Vec3::from(value))
        })
        .transpose()
}

/// Index of a cable.
fn cable(robot: &Robot, name: &str) -> Result<usize> {
    let names: Vec<String> = robot.cables.iter().map(|cable| cable.name.clone()).collect();
    let found = names.iter().position(|other| other == name);
    found.ok_or_else(|| anyhow!("there is no cable \"{name}\"{}", suggestion(name, &names)))
}

fn cut(of: &CutEvent, robot: &Robot) -> Result<SimulationEvent> {
    let at = match (of.at_s, of.at_tension_n) {
        (Some(time), None) => CutAt::Time(number("at_s", time)?),
        (None, Some(tension)) => CutAt::Tension(number("at_tension_n", tension)?),
        _ => bail!("give either `at_s` or `at_tension_n`"),
    };
    Ok(SimulationEvent::Cut { cable: cable(robot, &of.cable)?, at, place: number("place_m", of.place_m)? })
}

fn lengths(of: &LengthsEvent, at_rest: &AtRest) -> Result<SimulationEvent> {
    let (robot, time) = (&at_rest.robot, number("at_s", of.at_s)?);
    match (&of.change_m, of.duration_s, &of.table) {
        (Some(change), Some(duration), None) => {
            let mut changes = vec![0.0; robot.cables.len()];
            for (name, value) in change {
                changes[cable(robot, name)?] = number("change_m", *value)?;
            }
            Ok(SimulationEvent::Ramp { time, duration: number("duration_s", duration)?, changes })
        }
        (None, None, Some(table)) => follow(time, table, at_rest),
        _ => bail!("give `change_m` and `duration_s`, or `table`"),
    }
}

/// Lengths of a table, or of the poses of one.
fn follow(time: f64, table: &NumberColumns, at_rest: &AtRest) -> Result<SimulationEvent> {
    let robot = &at_rest.robot;
    let rows = TimedRows::read("table", table, robot).map_err(|fault| {
        let row = fault.row.map_or_else(String::new, |row| format!(" row {}:", row + 1));
        anyhow!("`table`:{row} {}", fault.text)
    })?;
    let rule = at_rest.rule.clone().unwrap_or_default();
    let at = |row: usize| -> Result<Vec<f64>> {
        if rows.holds == Holds::Lengths {
            return Ok(rows.values[row].clone());
        }
        let state = State::Pose(rows.pose(row));
        let solution = statics::solve_at(robot, &state, at_rest.equilibrium.model, &rule)
            .with_context(|| format!("`table` row {}", row + 1))?;
        Ok(solution.equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect())
    };
    let each = (0..rows.times.len()).map(at).collect::<Result<Vec<_>>>()?;
    let of_cable = |i: usize| Some(each.iter().map(|lengths| lengths[i]).collect());
    Ok(SimulationEvent::Follow { time, lengths: (0..robot.cables.len()).map(of_cable).collect(), times: rows.times })
}

/// Places of anchors over time.
fn anchors(of: &AnchorEvent, robot: &Robot) -> Result<SimulationEvent> {
    let AnchorTable { times, places_w } = AnchorTable::read("table", &of.table, robot)
        .map_err(|fault| anyhow!("`table`: {}", fault.text))?
        .of_cables(of.cables.as_deref(), robot)?;
    Ok(SimulationEvent::Anchors { time: number("at_s", of.at_s)?, times, places_w })
}

/// Reads a scenario from TOML. `table` reads the columns of a file that a `[[lengths]]` names.
///
/// # Errors
/// Text that is not TOML, an unknown key, or a value of the wrong type; the message says where.
pub fn scenario_from_toml(text: &str, table: impl Fn(&str) -> Result<NumberColumns>) -> Result<Scenario> {
    let document: toml_edit::DocumentMut = text.parse().map_err(|error| not_toml(text, &error))?;
    let mut value = of_item(document.as_item())?;
    for kind in ["lengths", "anchor"] {
        for event in value.get_mut(kind).and_then(Value::as_array_mut).into_iter().flatten() {
            if let Some(Value::String(path)) = event.get("table") {
                let columns = table(path)?;
                event["table"] = serde_json::to_value(columns)?;
            }
        }
    }
    check_scenario(&value)?;
    request::read(value)
}

/// Error of a text that is not TOML, in one line, with its place.
fn not_toml(text: &str, error: &toml_edit::TomlError) -> anyhow::Error {
    let at = error.span().map_or(0, |span| span.start.min(text.len()));
    let before = text.get(..at).unwrap_or_default();
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
    let written = text.lines().nth(line - 1).unwrap_or_default().trim();
    let is_comma = written.split_once('=').is_some_and(|(_, value)| {
        let parts: Vec<&str> = value.trim().split(',').collect();
        parts.len() == 2 && parts.iter().all(|part| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit()))
    });
    let help = if is_comma { "; write numbers with a decimal point, not a comma: 1.95" } else { "" };
    let message = error.message().trim().replace('\n', ", ");
    anyhow!("line {line}, column {column}: `{written}` is not TOML: {message}{help}")
}

fn of_item(item: &toml_edit::Item) -> Result<Value> {
    Ok(match item {
        toml_edit::Item::None => Value::Null,
        toml_edit::Item::Value(value) => of_value(value)?,
        toml_edit::Item::Table(table) => {
            let entries = table.iter().map(|(key, item)| Ok((key.to_owned(), of_item(item)?)));
            Value::Object(entries.collect::<Result<_>>()?)
        }
        toml_edit::Item::ArrayOfTables(tables) => {
            let each = tables.iter().map(|table| of_item(&toml_edit::Item::Table(table.clone())));
            Value::Array(each.collect::<Result<_>>()?)
        }
    })
}

fn of_value(value: &toml_edit::Value) -> Result<Value> {
    Ok(match value {
        toml_edit::Value::String(text) => Value::from(text.value().clone()),
        toml_edit::Value::Integer(number) => Value::from(*number.value()),
        toml_edit::Value::Float(number) => {
            let number = *number.value();
            serde_json::Number::from_f64(number).map(Value::Number).with_context(|| format!("{number} is no number"))?
        }
        toml_edit::Value::Boolean(truth) => Value::from(*truth.value()),
        toml_edit::Value::Datetime(date) => bail!("{date} is a date: give a number"),
        toml_edit::Value::Array(list) => Value::Array(list.iter().map(of_value).collect::<Result<_>>()?),
        toml_edit::Value::InlineTable(table) => {
            let entries = table.iter().map(|(key, value)| Ok((key.to_owned(), of_value(value)?)));
            Value::Object(entries.collect::<Result<_>>()?)
        }
    })
}
