//! The sweep of a file again: its robots and options, from what the file says of itself.

use super::{adjusted, asked, options};
use crate::args::values::{self, Lengths, PoseNumbers, Tensions};
use crate::args::{EachArgs, LoadArgs, ModelArgs, StateArgs, TensionArgs, TermArgs, WhatArgs};
use clap::ValueEnum;
use funicular::math::Vec3;
use funicular::sweep::Options;
use funicular_files::edit;
use funicular_files::{Grid, Record, Variation, Variations};
use serde_json::{Map, Value};

/// Points and options of a `sweep`.
pub(crate) struct Again {
    pub(crate) points: Variations<'static>,
    pub(crate) options: Options,
}

impl Again {
    /// Of a record that `sweep` has written.
    ///
    /// # Errors
    /// A text: a plan that this program does not know in full.
    pub(crate) fn of(record: &Record) -> Result<Self, String> {
        let plan = &record.plan;
        let unknown = || "its plan is not one of this program".to_owned();
        let grid = plan.get("grid").and_then(Grid::from_json).ok_or_else(unknown)?;
        let axes = grid.0.into_iter();
        let axes: Vec<Variation> = axes
            .map(|(path, steps)| Ok(Variation { path: edit::path(&path)?, steps }))
            .collect::<Result<_, String>>()?;
        let mut point = point_of(plan).ok_or_else(unknown)?;
        let adjust = {
            let point = point_of(plan).ok_or_else(unknown)?;
            Box::new(move |robot| adjusted(robot, &point).map_err(|error| format!("{error:#}")))
        };
        let points = Variations::new(record.robot_file.clone(), axes, "--vary", adjust)?;
        let robot = points.first()?;
        // What chooses among tensions where there is nothing to choose is refused as an option, and not one.
        if robot.cables.len() > robot.platform.freedoms.count() {
            let name = text(plan, "tension_rule").ok_or_else(unknown)?;
            point.tensions.tension_rule = Some(ValueEnum::from_str(name, false).map_err(|_| unknown())?);
        }
        let options = options(&robot, &point).map_err(|error| format!("{error:#}"))?;
        // The proof that nothing was left out.
        let mut ours = Map::new();
        asked(&options, &point).describe(&mut ours);
        let theirs = plan.iter().filter(|(key, _)| !["command", "robot", "grid"].contains(&key.as_str()));
        if ours == theirs.map(|(key, value)| (key.clone(), value.clone())).collect::<Map<_, _>>() {
            Ok(Self { points, options })
        } else {
            Err(unknown())
        }
    }
}

fn text<'a>(plan: &'a Map<String, Value>, key: &str) -> Option<&'a str> {
    plan.get(key)?.as_str()
}

fn numbers(plan: &Map<String, Value>, key: &str) -> Option<Vec<f64>> {
    plan.get(key)?.as_array()?.iter().map(Value::as_f64).collect()
}

fn number(plan: &Map<String, Value>, key: &str) -> Option<f64> {
    plan.get(key)?.as_f64()
}

fn vector(plan: &Map<String, Value>, key: &str) -> Option<Vec3> {
    match numbers(plan, key)?[..] {
        [x, y, z] => Some(Vec3::new(x, y, z)),
        _ => None,
    }
}

fn point_of(plan: &Map<String, Value>) -> Option<EachArgs> {
    Some(EachArgs { what: what_of(plan)?, state: state_of(plan)?, tensions: tensions_of(plan), model: model_of(plan)? })
}

fn state_of(plan: &Map<String, Value>) -> Option<StateArgs> {
    let pose = match numbers(plan, "pose").as_deref() {
        Some(&[x, y, z, roll, pitch, yaw]) => {
            Some(PoseNumbers { position: [x, y, z], roll_pitch_yaw_deg: [roll, pitch, yaw] })
        }
        _ => None,
    };
    Some(StateArgs {
        lengths_m: numbers(plan, "lengths_m").map(Lengths),
        pose,
        mass_kg: number(plan, "mass_kg"),
        static_model: ValueEnum::from_str(text(plan, "static_model")?, false).ok()?,
        load: LoadArgs {
            force_n: vector(plan, "force_n"),
            moment_n_m: vector(plan, "moment_n_m"),
            load_point_m: vector(plan, "load_point_m"),
            wind_m_s: vector(plan, "wind_m_s"),
            cable_load_n_per_m: vector(plan, "cable_load_n_per_m"),
        },
    })
}

fn tensions_of(plan: &Map<String, Value>) -> TensionArgs {
    TensionArgs {
        tension_rule: None,
        wanted_tension_n: numbers(plan, "wanted_tension_n").map(Tensions),
        min_tension_n: number(plan, "min_tension_n"),
        max_tension_n: number(plan, "max_tension_n"),
    }
}

fn model_of(plan: &Map<String, Value>) -> Option<ModelArgs> {
    Some(ModelArgs {
        cable_model: Some(ValueEnum::from_str(text(plan, "cable_model")?, false).ok()?),
        terms: TermArgs {
            assembly: ValueEnum::from_str(text(plan, "assembly")?, false).ok()?,
            in_plane_only: plan.get("in_plane_only")?.as_bool()?,
        },
    })
}

fn what_of(plan: &Map<String, Value>) -> Option<WhatArgs> {
    let names = plan.get("quantities")?.as_array()?;
    let quantity = names.iter().map(|name| values::quantity(name.as_str()?).ok()).collect::<Option<_>>()?;
    Some(WhatArgs { quantity, up_to_hz: number(plan, "up_to_hz")? })
}
