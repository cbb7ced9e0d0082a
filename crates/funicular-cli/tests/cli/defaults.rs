//! Defaults of options: the request has them, and the program, its help and Python's signatures agree with it.

use super::{project, robot, succeed};
use funicular::cable::CableModel;
use funicular::math::Vec3;
use funicular::robot::Robot;
use funicular::statics::{StaticModel, TensionRange, TensionRule};
use funicular_pages::figures;
use funicular_study::analyses::reduce;
use funicular_study::frequency_range::{LOWEST, START_POINTS};
use funicular_study::measurements;
use funicular_study::request::{RobotText, SIMULATED_S, TABLE_TOLERANCE_M};
use funicular_study::{Request, at_rest};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::fs;

/// Command lines with the options that a command needs and no other, for every command whose request has defaults.
fn shortest() -> Vec<Vec<String>> {
    let cogiro = robot("cogiro.toml");
    let imported = project("docs/import/tripod.wcrfx");
    let range = ["--from-hz", "1", "--to-hz", "2", "--points", "9"];
    let with_robot: [(&str, &[&str]); 21] = [
        ("check", &[]),
        ("parameters", &[]),
        ("statics", &[]),
        ("stiffness", &[]),
        ("modes", &[]),
        ("frf", &[]),
        ("compare", &["--below-hz", "2"]),
        ("gradient", &["--below-hz", "2"]),
        ("uncertainty", &["--deviations", "platform.mass_kg=1%"]),
        ("payload", &[]),
        ("simulate", &[]),
        ("pose-error", &["--mass-kg", "10:20:3"]),
        ("cable", &["--name", "1"]),
        ("reduce", &["--below-hz", "2"]),
        ("identify", &["--fit", "platform.mass_kg"]),
        ("design", &["--change", "platform.mass_kg=±1"]),
        ("map", &["--grid", "z=1:2:2"]),
        ("sweep", &["--vary", "platform.mass_kg=90:100:2"]),
        ("report", &[]),
        ("live", &[]),
        ("export", &["--to", "vtk"]),
    ];
    let mut lines: Vec<Vec<String>> = Vec::new();
    let line = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect::<Vec<String>>();
    for (command, options) in with_robot {
        let more: &[&str] = match command {
            "cable" => &range,
            _ => &[],
        };
        lines.push(line(&[&[command, cogiro.as_str()][..], options, more].concat()));
    }
    let [machine, readings] = ["machine.toml", "belts.csv"].map(|file| project("docs/calibration/") + file);
    lines.push(line(&["calibrate", &machine, "--readings", &readings]));
    let [held, log] = ["robot.toml", "run.csv"].map(|file| project("docs/estimation/") + file);
    lines.push(line(&["estimate", &held, "--log", &log]));
    lines.push(line(&["observability", &held]));
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
            ["schema", "command", "robot", "files", "experiments"].contains(&key) || line.contains(&option)
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

/// Defaults that the help states, with their options.
fn stated(command: &str) -> Vec<(String, String)> {
    let (mut found, mut option, mut text) = (Vec::new(), String::new(), String::new());
    let mut close = |option: &str, text: &str| {
        let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
        for part in words.split("[default").skip(1) {
            let (_, default) = part.split_once(": ").unwrap();
            let mut depth = 1;
            let end = default.find(|c| {
                depth += i32::from(c == '[') - i32::from(c == ']');
                depth == 0
            });
            found.push((option.to_owned(), default[..end.unwrap()].to_owned()));
        }
    };
    for line in succeed(&[command, "--help"]).lines() {
        let name = line.trim_start().split("--").nth(1).filter(|_| line.trim_start().starts_with('-'));
        if let Some(name) = name {
            close(&option, &text);
            name.split([' ', '=']).next().unwrap().clone_into(&mut option);
            text.clear();
        }
        text += line;
        text.push('\n');
    }
    close(&option, &text);
    found
}

/// Literal of a default as the help shows it.
fn literal(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Array(values) => values.iter().map(literal).collect::<Vec<_>>().join(","),
        Value::Number(number) => number.as_f64().unwrap().to_string(),
        other => other.to_string(),
    }
}

/// Defaults that depend on other values, so that the request has none and the help is written by hand: command, option,
/// and the beginnings of the defaults that the code has.
fn filled_in() -> Vec<(&'static str, &'static str, Vec<String>)> {
    let model = |static_model| at_rest::cable_model(None, static_model).name();
    assert_eq!(model(StaticModel::Catenary), CableModel::default().name());
    let of_model = format!("{}; {} for static", model(StaticModel::Catenary), model(StaticModel::Spring));
    let mut all: Vec<(&str, &str, Vec<String>)> =
        ["modes", "frf", "reduce", "cable"].map(|command| (command, "cable-model", vec![of_model.clone()])).into();
    let rule = TensionRule::default().name();
    all.push(("statics", "tension-rule", vec![rule.to_owned()]));
    let tolerances = [reduce::DEFAULT_TOLERANCE, reduce::DEFAULT_SECOND_ORDER_TOLERANCE];
    all.push(("reduce", "tolerance", tolerances.map(|tolerance| tolerance.to_string()).into()));

    // A heavy level cable: its minimum tension over the weight of its chord.
    let mut robot = Robot::from_toml(RobotText::embedded().text.as_str()).unwrap();
    for cable in &mut robot.cables {
        cable.material.mass_per_length = 1000.0;
    }
    let (chord_w, weight) = (Vec3::new(3.0, 0.0, 0.0), 1000.0 * robot.gravity_w.norm() * 3.0);
    let taut = TensionRange::of(&robot, 0, &chord_w).minimum / weight;
    let tensions =
        |command| (command, "min-tension-n", vec![format!("from the robot file, or {} times", rounded(taut))]);
    all.extend(["statics", "map", "sweep", "export"].map(tensions));

    all.push(("export", "duration-s", vec![format!("{SIMULATED_S} with a scenario")]));
    all.push(("export", "tolerance-m", vec![format!("{:e}", TABLE_TOLERANCE_M)]));

    // Figures.
    let column = figures::WIDTHS.iter().find(|(_, width)| *width == figures::DEFAULT_WIDTH_MM).unwrap().0;
    for command in ["statics", "modes", "frf", "compare", "plot"] {
        all.push((command, "figure-width-mm", vec![column.to_owned()]));
        all.push((command, "font-size-pt", vec![literal(&figures::DEFAULT_FONT_SIZE_PT.into())]));
    }

    // Deviations of measurements that have none.
    for (option, deviation) in [
        ("position-std-m", measurements::POSITION_STD_M),
        ("rotation-std-deg", measurements::ROTATION_STD_DEG),
        ("length-std-m", measurements::LENGTH_STD_M),
    ] {
        all.push(("identify", option, vec![deviation.to_string()]));
    }
    let of_maximum = format!("{} % of the maximum", 100.0 * measurements::TENSION_STD);
    all.push(("identify", "tension-std-n", vec![of_maximum]));

    // Number of frequencies of an adaptive response.
    all.push(("frf", "points", vec![START_POINTS.to_string()]));

    // Limits that follow from the natural frequencies.
    all.push(("modes", "below-hz", vec![format!("slightly above the {LOWEST} lowest")]));
    all.push(("frf", "from-hz", vec!["0".to_owned()]));
    all.push(("frf", "to-hz", vec![format!("above the {LOWEST} lowest natural frequencies")]));

    // Values of a new robot, as its file has them.
    let of = |motion: &str| succeed(&["new", "--motion", motion]);
    let number = |file: &str, key: &str| -> f64 {
        let value = file.lines().find_map(|line| line.trim().strip_prefix(&format!("{key} = "))).unwrap();
        value.split('#').next().unwrap().trim().parse().unwrap()
    };
    let new = of("rigid");
    let mass = number(&new, "mass_kg");
    all.push(("new", "mass-kg", vec![mass.to_string()]));
    let cables = |motion: &str| of(motion).matches("[[cables]]").count();
    assert_eq!(cables("planar-xz"), cables("point-mass"));
    all.push(("new", "cables", vec![format!("{}; {} for planar-xz and", cables("rigid"), cables("planar-xz"))]));
    let rope = new.lines().find(|line| line.starts_with("# Wire rope")).unwrap();
    let diameter_mm: f64 = rope.split(", ").nth(1).unwrap().split(" mm").next().unwrap().parse().unwrap();
    let diameter = 1e-3 * diameter_mm;
    all.push(("new", "diameter-m", vec![format!("by the mass of the platform, {diameter} for {mass} kg")]));
    let robot = Robot::from_toml(&new).unwrap();
    // Inertia of a box: m (b² + c²)/12 about a.
    let inertia = robot.platform.inertia_p;
    let side = |k: usize| (6.0 / mass * (inertia.trace() - 2.0 * inertia[(k, k)])).sqrt();
    // The file gives moments with five digits.
    let sides = [0, 1, 2].map(|k| ((1e3 * side(k)).round() / 1e3).to_string()).join(",");
    all.push(("new", "box-m", vec![format!("{sides}, or the box")]));
    all
}

/// Number without the rounding of the last digits.
fn rounded(number: f64) -> f64 {
    (1e9 * number).round() / 1e9
}

#[test]
fn help_states_the_defaults_that_the_analyses_fill_in() {
    for (command, option, wanted) in filled_in() {
        let found: Vec<String> =
            stated(command).into_iter().filter(|(name, _)| name == option).map(|(_, text)| text).collect();
        assert_eq!(found.len(), wanted.len(), "{command} --{option}: {found:?}");
        for (found, wanted) in found.iter().zip(&wanted) {
            // A number has to end where the wanted one ends.
            let rest = found.strip_prefix(wanted.as_str());
            let is_stated = rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_ascii_digit() || c == '.'));
            assert!(is_stated, "{command} --{option}: {found}, not {wanted}");
        }
    }
}

#[test]
fn help_states_no_number_that_is_not_compared() {
    let by_hand = filled_in();
    let mut compared = 0;
    let commands: Vec<String> = shortest().into_iter().map(|line| line[0].clone()).collect();
    let lines: BTreeMap<String, Vec<String>> = shortest().into_iter().map(|line| (line[0].clone(), line)).collect();
    let others = ["plot", "paper", "merge", "request", "validate"].map(str::to_owned);
    for command in commands.iter().chain(&others) {
        let request = lines.get(command).map(|line| request_of(line)).unwrap_or_default();
        for (option, default) in stated(command) {
            let of_request = request.get(&option.replace('-', "_")).filter(|value| !value.is_null());
            let number = |text: &str| text.parse::<f64>().map_or(text.to_owned(), |number| number.to_string());
            if let Some(value) = of_request
                && value.as_array().is_none_or(|list| list.first().is_some_and(Value::is_number))
                && !by_hand.iter().any(|(_, name, _)| *name == option)
            {
                assert_eq!(number(&default), literal(value), "{command} --{option}");
                compared += 1;
            } else if default.contains(|c: char| c.is_ascii_digit()) && !default.contains(".toml") {
                assert!(
                    by_hand.iter().any(|(_, name, _)| *name == option),
                    "{command} --{option} states {default}, which no test compares with the code"
                );
            }
        }
    }
    assert!(compared > 20, "{compared}");
}
