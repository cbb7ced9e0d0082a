//! JSON Schema of the robot file, made from the table of keys, for editors.
//!
//! The schema contains names, types, ranges and required keys. Conditions between keys, such as a minimum tension below
//! the maximum, are left to the reader of the program.

use funicular::robot::parameters::Range;
use funicular::robot::spec::key::{Absent, Key, KeyValue, Numeric, Shape, Table};
use funicular::robot::spec::{TABLES, top_of_file};
use serde_json::{Map, Value, json};

/// Version of JSON Schema that editors of TOML files understand.
const DRAFT: &str = "http://json-schema.org/draft-07/schema#";

/// Text of the schema, with a line feed at the end.
///
/// # Example
/// ```
/// use funicular_study::robot_file::schema;
///
/// let schema: serde_json::Value = serde_json::from_str(&schema::text()).unwrap();
/// assert_eq!(schema["properties"]["platform"]["properties"]["mass_kg"]["minimum"], 1e-12);
/// assert_eq!(schema["additionalProperties"], false);
/// ```
pub fn text() -> String {
    // The alternate form has one value per line; a JSON value always has a text.
    format!("{:#}\n", schema())
}

/// Schema as a JSON value.
pub fn schema() -> Value {
    let Value::Object(mut schema) = of_table(top_of_file()) else { unreachable!("a table is an object") };
    schema.insert("$schema".to_owned(), DRAFT.into());
    schema.insert("title".to_owned(), "Robot file of funicular".into());
    let about = "Cable-driven parallel robot. `funicular check FILE` also checks the conditions between keys.";
    schema.insert("description".to_owned(), about.into());
    Value::Object(schema)
}

/// Object with the keys of a table and no others.
fn of_table(table: &Table) -> Value {
    let properties: Map<String, Value> = table.keys.iter().map(|key| (key.name.to_owned(), of_key(key))).collect();
    let required: Vec<&str> =
        table.keys.iter().filter(|key| key.absent == Absent::Refused).map(|key| key.name).collect();
    let mut object = json!({ "type": "object", "properties": properties, "additionalProperties": false });
    if !required.is_empty() {
        object["required"] = required.into();
    }
    object
}

/// Schema of the value of a key, with its meaning and default.
fn of_key(key: &Key) -> Value {
    let mut schema = match &key.value {
        KeyValue::Name => json!({ "type": "string", "pattern": "\\S" }),
        KeyValue::Text => json!({ "type": "string" }),
        KeyValue::Word(words) => {
            let words: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
            json!({ "type": "string", "enum": words })
        }
        KeyValue::Table => of_table(table_of(&format!("[{}]", key.name))),
        KeyValue::Tables => {
            json!({ "type": "array", "minItems": 1, "items": of_table(table_of(&format!("[[{}]]", key.name))) })
        }
        KeyValue::NamedTables => {
            let table = of_table(table_of(&format!("[{}.NAME]", key.name)));
            json!({ "type": "object", "minProperties": 1, "additionalProperties": table })
        }
        KeyValue::Numbers(numbers) => of_numbers(numbers),
        KeyValue::NumberList(numbers) => {
            json!({ "type": "array", "items": of_number(numbers.range), "minItems": 1 })
        }
    };

    schema["description"] = description(key).into();

    match key.absent {
        Absent::Default(numbers) if key.numeric_value().is_some_and(|numeric| numeric.shape == Shape::Number) => {
            schema["default"] = numbers[0].into();
        }
        Absent::Default(numbers) => schema["default"] = numbers.to_vec().into(),
        Absent::DefaultWord(word) => schema["default"] = word.into(),
        Absent::Refused | Absent::Depends(_) | Absent::Means(_) => {}
    }
    schema
}

/// Table with a header. A table that a key names is in the list of tables.
fn table_of(header: &str) -> &'static Table {
    TABLES.iter().find(|table| table.header == header).unwrap_or_else(|| unreachable!("{header} is a table"))
}

/// Meaning, unit and effect of a missing key in one text.
fn description(key: &Key) -> String {
    let unit = match key.each_number() {
        Some(numbers) if numbers.unit != "1" => format!(" [{}]", numbers.unit),
        _ => String::new(),
    };
    let words = match &key.value {
        KeyValue::Word(words) => {
            let words: Vec<String> = words.iter().map(|(word, meaning)| format!("{word}: {meaning}")).collect();
            format!(". {}", words.join("; "))
        }
        _ => String::new(),
    };
    let absent = match key.absent {
        Absent::Depends(text) | Absent::Means(text) => format!(". Without it: {text}"),
        Absent::Refused | Absent::Default(_) | Absent::DefaultWord(_) => String::new(),
    };
    format!("{}{unit}{words}{absent}", key.about)
}

/// Numbers in their arrangement.
fn of_numbers(numbers: &Numeric) -> Value {
    let number = of_number(numbers.range);
    let three = |item: &Value| json!({ "type": "array", "items": item, "minItems": 3, "maxItems": 3 });
    match numbers.shape {
        Shape::Number => number,
        Shape::Vector | Shape::Angles => three(&number),
        // A moment is positive; the entries of a tensor may have any sign.
        Shape::Tensor => {
            let moment = of_number(Range::Positive);
            json!({ "oneOf": [moment.clone(), three(&moment), three(&three(&number))] })
        }
    }
}

/// Number within a range.
fn of_number(range: Range) -> Value {
    let maximum = if matches!(range, Range::Below(_)) { "exclusiveMaximum" } else { "maximum" };
    json!({ "type": "number", "minimum": range.minimum(), maximum: range.maximum() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_is_in_the_schema_with_its_meaning_and_the_required_ones_are_required() {
        let schema = schema();
        let mut keys = 0;

        let mut check = |table: &Table, schema: &Value| {
            assert_eq!(schema["properties"].as_object().unwrap().len(), table.keys.len());
            for key in table.keys {
                let own = &schema["properties"][key.name];
                assert!(own["description"].as_str().unwrap().starts_with(key.about), "{}", key.name);
                let required = schema["required"].as_array().is_some_and(|names| names.contains(&key.name.into()));
                assert_eq!(required, key.absent == Absent::Refused, "{}", key.name);
                keys += 1;
            }
        };

        for table in TABLES {
            let properties = &schema["properties"];
            let named = table.header.strip_prefix('[').and_then(|header| header.strip_suffix(".NAME]"));
            let own = match table.header {
                _ if named.is_some() => &properties[named.unwrap()]["additionalProperties"],
                "[[cables]]" => &properties["cables"]["items"],
                "[[required_loads]]" => &properties["required_loads"]["items"],
                header if header.starts_with('[') => &properties[header.trim_matches(['[', ']'])],
                _ => &schema,
            };

            check(table, own);
        }

        assert!(keys > 55, "{keys}");
    }
}
