//! Keywords of a call, which become the request of a command or a part of one. `funicular_study` checks their
//! combination.

use crate::errors;
use crate::reading;
use funicular_study::request::{Request, RobotText, State, Tensions, check_given, convert_units, keys_of};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

/// Keys of a request that a call gives.
pub(crate) struct Keywords(Map<String, Value>);

impl Keywords {
    /// Reads the keywords of a command; None counts as not given. `cables` are the names of the cables.
    pub(crate) fn read(command: &str, given: &Bound<'_, PyDict>, cables: &[String]) -> PyResult<Self> {
        let mut keys = Map::from_iter([("command".to_owned(), command.into())]);
        for (name, value) in given.iter() {
            if !value.is_none() {
                let name: String = name.extract()?;
                let value = reading::read(command, &name, &name, &value, cables)?;
                keys.insert(name, value);
            }
        }
        convert_units(command, &mut keys).map_err(|error| errors::study(&error))?;
        check_given(command, &keys).map_err(|error| errors::study(&error))?;
        Ok(Self(keys))
    }

    /// Adds the keys of an object that are given.
    fn with(mut self, object: &impl Serialize) -> PyResult<Self> {
        self.0.extend(keys_of(object).map_err(|error| errors::input(error.to_string()))?);
        Ok(self)
    }

    /// Group of keys, or request whose other keys do not matter: keys that are not given have their defaults.
    pub(crate) fn part<T: DeserializeOwned>(&self) -> PyResult<T> {
        serde_json::from_value(Value::Object(self.0.clone())).map_err(|error| errors::input(error.to_string()))
    }

    /// Request for a robot.
    pub(crate) fn request(mut self, robot: &RobotText) -> PyResult<Request> {
        let robot = serde_json::to_value(robot).map_err(|error| errors::input(error.to_string()))?;
        self.0.insert("robot".to_owned(), robot);
        Request::from_value(Value::Object(self.0)).map_err(|error| errors::study(&error.into()))
    }

    /// Request about an equilibrium of a robot, with the state that gave it.
    pub(crate) fn request_at(self, robot: &RobotText, state: &State, tensions: &Tensions) -> PyResult<Request> {
        self.with(state)?.with(tensions)?.request(robot)
    }
}

/// State and choice of the tensions of a robot with these cables.
pub(crate) fn state_and_tensions(given: &Bound<'_, PyDict>, cables: &[String]) -> PyResult<(State, Tensions)> {
    if given.is_empty() {
        return Ok((State::default(), Tensions::default()));
    }
    let keywords = Keywords::read("statics", given, cables)?;
    Ok((keywords.part()?, keywords.part()?))
}

/// Keys of several objects as one object in JSON, without those that are not given.
pub(crate) fn joined(state: &State, tensions: &Tensions) -> PyResult<String> {
    let keywords = Keywords(Map::new()).with(state)?.with(tensions)?;
    Ok(Value::Object(keywords.0).to_string())
}
