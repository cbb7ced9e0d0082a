//! Conversion of Python's keywords to the parts of a request. `funicular_study` checks their combination.

use crate::arrays::{Number, Numbers};
use crate::errors;
use crate::labels::Names;
use crate::pose::PoseLike;
use funicular::modes::PLATFORM_SHARE;
use funicular_study::names::Named;
use funicular_study::request::{Load, Model, ResponsePoints, State, Tensions, Terms};
use pyo3::prelude::*;
use serde_json::Map;

/// Choice by its name.
pub(crate) fn named<T: Named>(keyword: &str, name: &str) -> PyResult<T> {
    T::from_name(name).map_err(|reason| errors::input(format!("`{keyword}`: {reason}")))
}

fn number(value: Option<Number>, keyword: &str) -> PyResult<Option<f64>> {
    value.map(|value| value.value(keyword)).transpose()
}

pub(crate) fn three(value: Option<Numbers>, keyword: &str) -> PyResult<Option<[f64; 3]>> {
    value.map(|numbers| numbers.three(keyword)).transpose()
}

/// Unstrained lengths of a robot with these cables.
pub(crate) fn lengths(lengths_m: Option<Numbers>, cables: &[String]) -> PyResult<Option<Vec<f64>>> {
    let names = || Names::of_cables(cables, "lengths_m");
    lengths_m.map(|lengths| lengths.named_row("lengths_m", &names())).transpose()
}

/// Keywords for state and loads.
pub(crate) struct StateKeywords<'a> {
    pub(crate) pose: Option<PoseLike>,
    pub(crate) lengths_m: Option<Numbers>,
    pub(crate) hold_lengths_of_pose: bool,
    pub(crate) mass_kg: Option<Number>,
    pub(crate) static_model: &'a str,
    pub(crate) force_n: Option<Numbers>,
    pub(crate) moment_n_m: Option<Numbers>,
    pub(crate) load_point_m: Option<Numbers>,
    pub(crate) wind_m_s: Option<Numbers>,
    pub(crate) cable_load_n_per_m: Option<Numbers>,
}

impl StateKeywords<'_> {
    /// State of a robot with these cables.
    pub(crate) fn request(self, cables: &[String]) -> PyResult<State> {
        Ok(State {
            lengths_m: lengths(self.lengths_m, cables)?,
            pose: self.pose.map(|pose| pose.0),
            hold_lengths_of_pose: self.hold_lengths_of_pose,
            mass_kg: number(self.mass_kg, "mass_kg")?,
            static_model: named("static_model", self.static_model)?,
            load: Load {
                force_n: three(self.force_n, "force_n")?,
                moment_n_m: three(self.moment_n_m, "moment_n_m")?,
                load_point_m: three(self.load_point_m, "load_point_m")?,
                wind_m_s: three(self.wind_m_s, "wind_m_s")?,
                cable_load_n_per_m: three(self.cable_load_n_per_m, "cable_load_n_per_m")?,
            },
        })
    }
}

/// Keywords for rule and limits of the tensions.
pub(crate) struct TensionKeywords<'a> {
    pub(crate) tension_rule: Option<&'a str>,
    pub(crate) target_tension_n: Option<Numbers>,
    pub(crate) min_tension_n: Option<Number>,
    pub(crate) max_tension_n: Option<Number>,
}

impl TensionKeywords<'_> {
    /// Rule and limits for a robot with these cables.
    pub(crate) fn request(self, cables: &[String]) -> PyResult<Tensions> {
        let target =
            self.target_tension_n.map(|target| target.one_or_per_cable("target_tension_n", cables)).transpose()?;
        Ok(Tensions {
            tension_rule: self.tension_rule.map(|name| named("tension_rule", name)).transpose()?,
            target_tension_n: target,
            min_tension_n: number(self.min_tension_n, "min_tension_n")?,
            max_tension_n: number(self.max_tension_n, "max_tension_n")?,
        })
    }
}

/// Models of the linearised robot.
pub(crate) fn model(cable_model: Option<&str>, assembly: &str, in_plane_only: bool, winches: &str) -> PyResult<Model> {
    Ok(Model {
        cable_model: cable_model.map(|name| named("cable_model", name)).transpose()?,
        terms: terms(assembly, in_plane_only, winches)?,
    })
}

/// Minimum fraction of the kinetic energy in the platform for a mode of the platform.
pub(crate) fn share(platform_share: Option<Number>) -> PyResult<f64> {
    platform_share.map_or(Ok(PLATFORM_SHARE), |share| share.value("platform_share"))
}

/// Terms of the stiffness.
pub(crate) fn terms(assembly: &str, in_plane_only: bool, winches: &str) -> PyResult<Terms> {
    Ok(Terms { assembly: named("assembly", assembly)?, in_plane_only, winches: named("winches", winches)? })
}

/// Points of the platform where a force acts and where motion is measured.
pub(crate) fn points(input_point_m: Option<Numbers>, output_point_m: Option<Numbers>) -> PyResult<ResponsePoints> {
    Ok(ResponsePoints {
        input_point_m: three(input_point_m, "input_point_m")?,
        output_point_m: three(output_point_m, "output_point_m")?,
    })
}

/// Keys of several objects as one object in JSON, without those that are not given.
pub(crate) fn joined(parts: &[&serde_json::Result<serde_json::Value>]) -> PyResult<String> {
    let mut all = Map::new();
    for part in parts {
        match part {
            Ok(serde_json::Value::Object(keys)) => {
                all.extend(
                    keys.iter().filter(|(_, value)| !value.is_null()).map(|(key, value)| (key.clone(), value.clone())),
                );
            }
            Ok(_) => {}
            Err(error) => return Err(errors::input(error.to_string())),
        }
    }
    Ok(serde_json::Value::Object(all).to_string())
}
