//! Text of a robot file for `Robot`: read from a file, changed by `with_`, packed for pickles.

use crate::arrays::{Number, TextKeyed};
use crate::dict_to_toml;
use crate::errors;
use funicular_files::beside;
use funicular_study::request::RobotText;
use funicular_study::robot_file::{self, MAX_BYTES};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::fs;
use std::io::{self, Read};
use std::path::Path;

/// Name and text of a robot file.
pub(crate) fn of_file(path: &Path) -> PyResult<(String, String)> {
    let name = path.display().to_string();
    let read = || {
        let mut bytes = Vec::new();
        fs::File::open(path)?.take(MAX_BYTES as u64 + 1).read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    let bytes: Vec<u8> = read().map_err(|error: io::Error| {
        io::Error::new(error.kind(), format!("cannot read the robot file {name}: {error}"))
    })?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let text = robot_file::decode(&name, bytes).and_then(|text| robot_file::with_meshes(&name, text, beside(folder)));
    Ok((name, text.map_err(|error| errors::change(format!("{error:#}")))?))
}

/// Text with further changes: values by their paths, and the mass of the platform [kg].
pub(crate) fn changed(
    py: Python<'_>,
    source: &RobotText,
    changes: Option<TextKeyed<'_>>,
    mass_kg: Option<Number>,
) -> PyResult<RobotText> {
    let all = PyDict::new(py);
    if let Some(TextKeyed(changes)) = changes {
        all.update(changes.as_mapping())?;
    }
    if let Some(mass) = mass_kg {
        if all.contains("platform.mass_kg")? {
            return Err(errors::input("`mass_kg` is `platform.mass_kg` of the changes: give one of them".to_owned()));
        }
        all.set_item("platform.mass_kg", mass.positive("mass_kg")?)?;
    }

    let mut source = source.clone();
    source.set.extend(dict_to_toml::changes(&all)?);
    Ok(source)
}

/// Text and changes as JSON.
pub(crate) fn to_json(source: &RobotText) -> PyResult<String> {
    serde_json::to_string(source).map_err(|error| errors::input(error.to_string()))
}

/// Text and changes from JSON.
pub(crate) fn of_json(source: &str) -> PyResult<RobotText> {
    serde_json::from_str(source).map_err(|error| errors::input(error.to_string()))
}
