//! Defaults of options: the request has them, and the program, its help and Python's signatures agree with it.

use super::{project, robot, succeed};
use funicular::cable::CableModel;
use funicular::statics::{StaticModel, TensionRule};
use funicular_study::Request;
use funicular_study::analyses::reduce;
use funicular_study::at_rest;
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::fs;

/// Command lines with the options that a command needs and no other, for every command whose request has defaults.
fn shortest() -> Vec<Vec<String>> {
    let cogiro = robot("cogiro.toml");
    let imported = project("docs/import/tripod.wcrfx");
    let response = ["--input", "fz", "--output", "z"];
    let range = ["--from-hz", "1", "--to-hz", "2", "--points", "9"];
    let with_robot: [(&str, &[&str]); 15] = [
        ("check", &[]),
        ("parameters", &[]),
        ("statics", &[]),
        ("stiffness", &[]),
        ("modes", &["--below-hz", "2"]),
        ("frf", &range),
        ("compare", &["--below-hz", "2"]),
        ("payload", &[]),
        ("pose-error", &["--mass-kg", "10:20:3"]),
        ("cable", &["--name", "1"]),
        ("reduce", &["--below-hz", "2"]),
        ("map", &["--grid", "z=1:2:2"]),
        ("sweep", &["--vary", "platform.mass_kg=90:100:2"]),
        ("report", &[]),
        ("export", &["--to", "vtk"]),
    ];
    let mut lines: Vec<Vec<String>> = Vec::new();
    let line = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect::<Vec<String>>();
    for (command, options) in with_robot {
        let more: &[&str] = match command {
            "frf" => &response,
            "cable" => &range,
            _ => &[],
        };
        lines.push(line(&[&[command, cogiro.as_str()][..], options, more].concat()));
    }
    lines.push(line(&["new"]));
    lines.push(line(&["import", &imported]));
    lines
}

/// Request that the program makes of a command line, as JSON.
fn request_of(line: &[String]) -> Map<String, Value> {
    let words: Vec<&str> = line.iter().map(String::as_str).chain(["--print-request"]).collect();
    serde_json::from_str(&succeed(&words)).unwrap()
}

/// Default of each key in the requests of the commands that have it.
fn defaults() -> BTreeMap<String, Vec<(String, Value)>> {
    let mut found: BTreeMap<String, Vec<(String, Value)>> = BTreeMap::new();
    for line in shortest() {
        for (key, value) in request_of(&line) {
            found.entry(key).or_default().push((line[0].clone(), value));
        }
    }
    found
}

#[test]
fn options_that_are_not_given_have_the_defaults_of_the_request() {
    let mut compared = 0;
    for line in shortest() {
        let complete = request_of(&line);
        let given = |key: &str| {
            let option = format!("--{}", key.replace('_', "-"));
            ["schema", "command", "robot", "files"].contains(&key) || line.contains(&option)
        };
        for key in complete.keys().filter(|key| !given(key)) {
            let mut without = complete.clone();
            without.remove(key);
            let read = Request::from_value(Value::Object(without));
            let read =
                read.unwrap_or_else(|error| panic!("{}: the request has no default of `{key}`: {error}", line[0]));
            assert_eq!(read.to_value()[key], complete[key], "{}: `{key}` of request and program", line[0]);
            compared += 1;
        }
    }
    assert!(compared > 60, "{compared}");
}

/// Keywords with a default that is not None: name and literal, in Python's notation.
fn keywords(source: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for part in source.split(['(', ',', '\n']) {
        let Some((name, literal)) = part.trim().split_once(" = ") else { continue };
        let Some((name, _)) = name.split_once(": ") else { continue };
        let literal = literal.split([')', '#']).next().unwrap().trim();
        if literal != "None" && literal != "..." {
            found.push((name.trim().to_owned(), literal.to_owned()));
        }
    }
    found
}

#[test]
fn keywords_of_python_have_the_defaults_of_the_request() {
    assert_eq!(
        keywords("def f(a: int | None = None, *, b: str = \"x\", c: bool = True) -> D: ..."),
        [("b", "\"x\""), ("c", "True")].map(|(name, literal)| (name.to_owned(), literal.to_owned()))
    );
    let (defaults, mut compared) = (defaults(), 0);
    for file in ["_funicular.pyi", "_study.py"] {
        let source = fs::read_to_string(project("crates/funicular-py/python/funicular/") + file).unwrap();
        for (name, literal) in keywords(&source) {
            // Other keywords belong to Python alone: files, threads.
            let Some(of_requests) = defaults.get(&name) else { continue };
            let value: Value = match literal.as_str() {
                "True" => true.into(),
                "False" => false.into(),
                other => serde_json::from_str(other).unwrap_or_else(|_| panic!("{file}: {name} = {literal}")),
            };
            assert!(
                of_requests.iter().any(|(_, default)| *default == value),
                "{file}: {name} = {literal}, {of_requests:?}"
            );
            compared += 1;
        }
    }
    assert!(compared > 30, "{compared}");
}

#[test]
fn help_states_the_defaults_that_the_analyses_fill_in() {
    // Options without a default in the request, because the default depends on others: their help is written by hand.
    let stated = |command: &str, option: &str, default: &str| {
        let help = succeed(&[command, "--help"]);
        let words = help.split_whitespace().collect::<Vec<_>>().join(" ");
        let of_option = words.split(&format!(" --{option} <")).nth(1).unwrap_or_else(|| panic!("{command} --{option}"));
        let of_option = of_option.split(" --").next().unwrap();
        assert!(of_option.contains(&format!("[default: {default}")), "{command} --{option} {default}: {of_option}");
    };
    let model = |static_model| at_rest::cable_model(None, static_model).name();
    assert_eq!(model(StaticModel::Catenary), CableModel::default().name());
    let of_model = format!("{}; {} for static", model(StaticModel::Catenary), model(StaticModel::Spring));
    for command in ["modes", "frf", "reduce", "cable"] {
        stated(command, "cable-model", &of_model);
    }
    stated("statics", "tension-rule", TensionRule::default().name());
    stated("reduce", "tolerance", &reduce::DEFAULT_TOLERANCE.to_string());
    stated("reduce", "tolerance", &reduce::DEFAULT_SECOND_ORDER_TOLERANCE.to_string());

    // Values of a new robot, as its file has them.
    let new = succeed(&["new"]);
    let number = |key: &str| {
        let value = new.lines().find_map(|line| line.strip_prefix(&format!("{key} = "))).unwrap();
        value.split('#').next().unwrap().trim().parse::<f64>().unwrap()
    };
    stated("new", "mass-kg", &format!("{}]", number("mass_kg")));
    stated("new", "cables", &new.matches("[[cables]]").count().to_string());
}
