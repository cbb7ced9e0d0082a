//! JSON of results against the schema that `schema --of results` promises: every test that reads JSON checks it.

use super::succeed;
use serde_json::Value;
use std::sync::LazyLock;

static SCHEMA: LazyLock<Value> =
    LazyLock::new(|| serde_json::from_str(&succeed(&["schema", "--of", "results"])).expect("a schema is JSON"));

/// Checks results against the schema of a command.
pub(crate) fn check(results: &Value, command: &str) {
    // Maps and sweeps write rows, whose columns `schema --of columns` tells, and a summary of them.
    if ["map", "sweep"].contains(&command) {
        return;
    }
    let schema = &SCHEMA["$defs"][command];
    assert!(schema.is_object(), "`schema --of results` has no `{command}`");
    if let Err(fault) = fault(results, schema, command) {
        panic!("results differ from `schema --of results`: {fault}");
    }
}

/// First difference of a value from a schema. Only the words that the schema of results uses are known.
fn fault(value: &Value, schema: &Value, place: &str) -> Result<(), String> {
    for (word, wanted) in schema.as_object().ok_or_else(|| format!("{place}: the schema is no object"))? {
        let holds = match word.as_str() {
            "title" | "description" | "$comment" | "unit" => true,
            "const" => value == wanted,
            "enum" => wanted.as_array().is_some_and(|all| all.contains(value)),
            "type" => is_of_type(value, wanted),
            "required" => {
                let missing = wanted.as_array().and_then(|all| all.iter().find(|key| value.get(key_of(key)).is_none()));
                if let Some(key) = missing {
                    return Err(format!("{place}: no {key}"));
                }
                true
            }
            "properties" => {
                for (key, of_key) in wanted.as_object().into_iter().flatten() {
                    if let Some(inner) = value.get(key) {
                        fault(inner, of_key, &format!("{place}.{key}"))?;
                    }
                }
                true
            }
            "additionalProperties" => {
                for (key, inner) in value.as_object().into_iter().flatten() {
                    match (schema["properties"].get(key), wanted) {
                        (Some(_), _) => {}
                        (None, Value::Bool(is_allowed)) if !is_allowed => {
                            return Err(format!("{place}: `{key}` is not in the schema"));
                        }
                        (None, of_key) => fault(inner, of_key, &format!("{place}.{key}"))?,
                    }
                }
                true
            }
            "items" => {
                for inner in value.as_array().into_iter().flatten() {
                    fault(inner, wanted, &format!("{place}[]"))?;
                }
                true
            }
            "minItems" => value.as_array().is_some_and(|all| all.len() as u64 >= wanted.as_u64().unwrap()),
            "maxItems" => value.as_array().is_some_and(|all| all.len() as u64 <= wanted.as_u64().unwrap()),
            "oneOf" => {
                let faults: Vec<String> =
                    wanted.as_array().unwrap().iter().filter_map(|one| fault(value, one, place).err()).collect();
                if faults.len() + 1 != wanted.as_array().unwrap().len() {
                    return Err(format!("{place}: not one of the forms: {faults:?}"));
                }
                true
            }
            other => return Err(format!("{place}: the word `{other}` is not known")),
        };
        if !holds {
            return Err(format!("{place}: {value} is not {word} {wanted}"));
        }
    }
    Ok(())
}

fn key_of(key: &Value) -> &str {
    key.as_str().expect("keys are texts")
}

fn is_of_type(value: &Value, wanted: &Value) -> bool {
    match wanted.as_str().expect("a type is a text") {
        "number" => value.is_number(),
        "integer" => value.is_u64() || value.is_i64(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("`{other}` is a type of JSON"),
    }
}

#[test]
fn a_missing_key_a_foreign_key_and_a_wrong_type_are_faults() {
    let results: Value = serde_json::from_str(&succeed(&["statics", "ROBOT", "--format", "json"])).unwrap();
    check(&results, "statics");
    let schema = &SCHEMA["$defs"]["statics"];
    for change in [
        |results: &mut Value| drop(results.as_object_mut().unwrap().remove("cables")),
        |results: &mut Value| results["cables"][1]["foreign"] = 1.into(),
        |results: &mut Value| results["iterations"] = 1.5.into(),
        |results: &mut Value| drop(results["pose"]["position_m"].as_array_mut().unwrap().pop()),
    ] {
        let mut changed = results.clone();
        change(&mut changed);
        assert!(fault(&changed, schema, "statics").is_err(), "{changed}");
    }
}

/// Every command with results has a schema, and every key of it that is a number with a unit says which.
#[test]
fn the_schema_has_every_command_of_the_columns_that_writes_json() {
    let columns: Value = serde_json::from_str(&succeed(&["schema", "--of", "columns"])).unwrap();
    let without: Vec<&String> =
        columns.as_object().unwrap().keys().filter(|command| SCHEMA["$defs"].get(command.as_str()).is_none()).collect();
    assert_eq!(without, ["map", "sweep"]);
    let mass = &SCHEMA["$defs"]["statics"]["properties"]["mass_kg"];
    assert_eq!((&mass["type"], &mass["unit"]), (&"number".into(), &"kg".into()));
}
