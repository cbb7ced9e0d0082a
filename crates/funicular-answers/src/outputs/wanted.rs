//! Files that a request in JSON asks for.

use super::{Output, of};
use anyhow::{Result, bail};
use funicular_study::wording::{Words, worded};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// File that is wanted: its key, and its path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Wanted {
    /// Key of the table.
    pub key: String,
    /// Path.
    pub path: PathBuf,
}

/// Key of a request in JSON with the files that it wants: an object with the keys of the table.
pub const FILES: &str = "write_files";

/// Takes the wanted files out of a request in JSON.
///
/// # Errors
/// No object of paths; only files of which there may be several have a list of paths.
pub fn take_wanted(request: &mut Value) -> Result<Vec<Wanted>> {
    let files = request.as_object_mut().and_then(|keys| keys.remove(FILES));
    let files = match files {
        None | Some(Value::Null) => return Ok(Vec::new()),
        Some(Value::Object(files)) => files,
        Some(other) => bail!("`{FILES}` is {other}: give an object of paths, as in {{\"page\": \"page.html\"}}"),
    };
    let mut wanted = Vec::new();
    for (key, paths) in files {
        let paths = match paths {
            Value::Null => continue,
            Value::Array(paths) => paths,
            one => vec![one],
        };
        for path in paths {
            let Value::String(path) = path else { bail!("`{FILES}`, `{key}`: {path} is not the path of a file") };
            wanted.push(Wanted { key: key.clone(), path: path.into() });
        }
    }
    Ok(wanted)
}

/// Wanted files as the value of [`FILES`]; `None` without any.
pub fn wanted_to_value(wanted: &[Wanted]) -> Option<Value> {
    let mut files: BTreeMap<&str, Vec<Value>> = BTreeMap::new();
    for Wanted { key, path } in wanted {
        files.entry(key).or_default().push(path.display().to_string().into());
    }
    let of_paths = |mut paths: Vec<Value>| if paths.len() == 1 { paths.remove(0) } else { Value::Array(paths) };
    let object: Map<String, Value> = files.into_iter().map(|(key, paths)| (key.to_owned(), of_paths(paths))).collect();
    (!object.is_empty()).then_some(Value::Object(object))
}

/// Schema of the value of [`FILES`] for a command; `None` for one that writes no other file.
pub fn schema(command: &str) -> Option<Value> {
    let outputs = of(command);
    if outputs.is_empty() {
        return None;
    }
    let path = json!({ "type": "string", "minLength": 1 });
    let property = |output: &Output| {
        let about = worded(output.about, Words::Json);
        let one = json!({ "type": "string", "minLength": 1, "description": about });
        let some = json!({ "anyOf": [path, { "type": "array", "items": path }], "description": about });
        (output.key.to_owned(), if output.several { some } else { one })
    };
    Some(json!({
        "description": "Files that are written besides the result",
        "type": "object",
        "properties": outputs.iter().map(property).collect::<Map<_, _>>(),
        "additionalProperties": false,
    }))
}
