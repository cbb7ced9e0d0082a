//! Events of a scenario: from the words of a file to what the simulation knows.

use crate::analyses::timed_rows::{Holds, TimedRows};
use crate::at_rest::AtRest;
use crate::names::suggestion;
use crate::request::{self, CutEvent, LengthsEvent, NumberColumns, Scenario, check_scenario};
use crate::values::finite;
use anyhow::{Context, Result, anyhow, bail};
use funicular::math::Vec3;
use funicular::robot::{Robot, State};
use funicular::simulation::{CutAt, SimulationEvent};
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
    Ok(SimulationEvent::Cut { cable: cable(robot, &of.cable)?, at })
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

/// Reads a scenario from TOML. `table` reads the columns of a file that a `[[lengths]]` names.
///
/// # Errors
/// Text that is not TOML, an unknown key, or a value of the wrong type; the message says where.
pub fn scenario_from_toml(text: &str, table: impl Fn(&str) -> Result<NumberColumns>) -> Result<Scenario> {
    let document: toml_edit::DocumentMut = text.parse().map_err(|error| anyhow!("it is not TOML: {error}"))?;
    let mut value = of_item(document.as_item())?;
    if let Some(Value::Array(list)) = value.get_mut("lengths") {
        for event in list {
            if let Some(Value::String(path)) = event.get("table") {
                let columns = table(path)?;
                event["table"] = serde_json::to_value(columns)?;
            }
        }
    }
    check_scenario(&value)?;
    request::read(value)
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
