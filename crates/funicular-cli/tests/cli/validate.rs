//! `validate`: every comparison, without a robot.

use super::{csv, json, number, numbers, succeed};
use serde_json::Value;

#[test]
fn validate_passes_every_comparison_and_needs_no_robot() {
    let value = json(&["validate"]);
    assert_eq!((&value["schema"], &value["command"]), (&Value::from("funicular/1"), &Value::from("validate")));
    assert!(value.get("robot").is_none());
    assert_eq!(value["passed"], value["comparisons"]);
    let sections = value["sections"].as_array().unwrap();
    let rows: Vec<&Value> = sections.iter().flat_map(|section| section["rows"].as_array().unwrap()).collect();
    assert_eq!((sections.len(), rows.len() as u64), (21, value["comparisons"].as_u64().unwrap()));
    for row in &rows {
        assert!(number(&row["difference"]) <= number(&row["tolerance"]), "{row}");
        assert!(row["source"].as_str().is_some_and(|source| !source.is_empty()), "{row}");
        assert!(numbers(&row["theirs"]).len() == numbers(&row["ours"]).len(), "{row}");
    }
    let (header, table) = csv(&["validate"]);
    assert_eq!((header[0].as_str(), table.len()), ("section", rows.len()));
    assert!(succeed(&["validate"]).starts_with("# Validation\n"));

    let schema: Value = serde_json::from_str(&succeed(&["schema", "--of", "columns"])).unwrap();
    let described = schema["validate"][0]["columns"].as_array().unwrap().iter().map(|of| of["name"].as_str().unwrap());
    assert_eq!(described.collect::<Vec<_>>(), header);
}
