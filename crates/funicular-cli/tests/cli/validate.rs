//! `validate`: comparisons by their IDs, without a robot; reports and badges.

use super::{csv, json, number, numbers, run, stderr, stdout, succeed};
use serde_json::Value;
use std::fs;

#[test]
fn validate_passes_every_comparison_and_needs_no_robot() {
    let value = json(&["validate"]);
    assert_eq!((&value["schema"], &value["command"]), (&Value::from("funicular/1"), &Value::from("validate")));
    assert!(value.get("robot").is_none());
    assert_eq!(value["passed"], value["comparisons"]);
    let sections = value["sections"].as_array().unwrap();
    let rows: Vec<&Value> = sections.iter().flat_map(|section| section["rows"].as_array().unwrap()).collect();
    assert_eq!(rows.len() as u64, value["comparisons"].as_u64().unwrap());
    assert!(number(&value["numbers"]) > 2000.0 && number(&value["sources"]) >= 25.0, "{}", value["numbers"]);
    for row in &rows {
        assert!(number(&row["difference"]) <= number(&row["tolerance"]), "{row}");
        assert!(row["source"].as_str().is_some_and(|source| !source.is_empty()), "{row}");
        assert!(numbers(&row["theirs"]).len() == numbers(&row["ours"]).len(), "{row}");
    }
    let levels = value["levels"].as_array().unwrap();
    let of_levels: u64 = levels.iter().map(|level| level["comparisons"].as_u64().unwrap()).sum();
    assert!(levels.len() == 4 && Some(of_levels) == value["comparisons"].as_u64(), "{levels:?}");
}

#[test]
fn ids_and_levels_choose_comparisons_in_every_form() {
    let one = ["validate", "--only", "catenary/michalos-1962/node"];
    let value = json(&one);
    assert_eq!(value["sections"][0]["rows"][0]["id"], "catenary/michalos-1962/node");
    assert_eq!((number(&value["comparisons"]), value["controls"].as_array().unwrap().len()), (1.0, 0));
    let (header, table) = csv(&["validate", "--only", "catenary/michalos-1962"]);
    assert_eq!((header[0].as_str(), header[1].as_str(), table.len()), ("section", "id", 3));
    let text = succeed(&["validate", "--only", "catenary,paper", "--controls"]);
    assert!(text.starts_with("# Validation\n") && text.contains("<a id=\"control/catenary/ea\">"), "{text}");
    let measured = json(&["validate", "--level", "measured", "--only", "few-cables"]);
    assert!(number(&measured["numbers"]) > 200.0, "{}", measured["numbers"]);

    let output = run(&["validate", "--only", "catenery"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("--only: no comparison") && stderr(&output).contains("did you mean catenary"));
    let output = run(&["validate", "--only", "catenary", "--level", "measured"]);
    assert!(output.status.code() == Some(2) && stderr(&output).contains("--level"), "{}", stderr(&output));

    let schema: Value = serde_json::from_str(&succeed(&["schema", "--of", "columns"])).unwrap();
    let described = schema["validate"][0]["columns"].as_array().unwrap().iter().map(|of| of["name"].as_str().unwrap());
    assert_eq!(described.collect::<Vec<_>>(), header);
}

#[test]
fn reports_and_badges_are_written_beside_the_result() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let (report, badge) = (at("report.xml"), at("badge.svg"));
    let output = run(&["validate", "--only", "catenary/michalos-1962", "-o", &report, "--badge", &badge, "--quiet"]);
    assert_eq!((output.status.code(), stdout(&output)), (Some(0), ""), "{}", stderr(&output));
    assert!(fs::read_to_string(&report).unwrap().contains("tests=\"3\" failures=\"0\""));
    assert!(fs::read_to_string(&badge).unwrap().starts_with("<svg "));
    let output = run(&["validate", "--only", "paper", "-o", &badge, "--badge", &badge]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
}
