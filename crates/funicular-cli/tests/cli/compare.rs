//! `compare`: all models and advice.

use super::{json, succeed};

#[test]
fn compare_has_all_models_and_advice() {
    let value = json(&["compare", "ROBOT", "--below-hz", "3"]);
    let models: Vec<&str> =
        value["models"].as_array().unwrap().iter().map(|m| m["cable_model"].as_str().unwrap()).collect();
    assert_eq!(models, ["spring", "shallow-static", "catenary-static", "shallow-dynamic", "catenary-dynamic"]);
    assert_eq!(value["reference"], "catenary-dynamic");
    assert_eq!(value["advice"]["cable_model"], "shallow-dynamic");
    assert!(succeed(&["compare", "ROBOT", "--below-hz", "3"]).contains("Use `shallow-dynamic`"));
}
