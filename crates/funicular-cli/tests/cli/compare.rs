//! `compare`: all models and advice.

use super::{json, number, robot, run, stderr, succeed};

#[test]
fn compare_has_all_models_and_advice() {
    let value = json(&["compare", "ROBOT", "--below-hz", "3"]);
    let models: Vec<&str> =
        value["models"].as_array().unwrap().iter().map(|m| m["cable_model"].as_str().unwrap()).collect();
    assert_eq!(models, ["spring", "shallow-static", "catenary-static", "shallow-dynamic", "catenary-dynamic"]);
    assert_eq!(value["reference"], "catenary-dynamic");
    assert_eq!(value["advice"]["cable_model"], "shallow-dynamic");
    let text = succeed(&["compare", "ROBOT", "--below-hz", "3"]);
    let (_, advice) = text.split_once("\nUse `shallow-dynamic`").unwrap();

    // Three short lines, each a sentence.
    let lines: Vec<&str> = advice.lines().take_while(|line| !line.is_empty()).collect();
    assert!(lines.len() == 3 && lines.iter().all(|line| line.ends_with('.')), "{text}");
    assert!(lines.iter().all(|line| line.split_whitespace().count() <= 25), "{text}");
    assert!(lines[1].contains("a constant cable stiffness misses"), "{text}");
    assert!(lines[2].starts_with("Maximum sag d/l = "), "{text}");
}

#[test]
fn the_platform_alone_is_compared_with_its_own_tolerance() {
    let cogiro = robot("cogiro.toml");
    let with = |more: &[&str]| json(&[&["compare", &cogiro, "--below-hz", "15", "--platform"], more].concat());
    let strict = with(&[]);
    let reference = strict["models"].as_array().unwrap().last().unwrap();
    let modes = reference["modes"].as_array().unwrap();
    let compared: Vec<usize> =
        strict["compared"].as_array().unwrap().iter().map(|i| i.as_u64().unwrap() as usize).collect();
    let of_platform: Vec<usize> =
        (0..modes.len()).filter(|&i| number(&modes[i]["platform_energy_fraction"]) >= 0.5).collect();
    assert_eq!(compared, of_platform);
    assert!(compared.len() >= 3 && compared.len() < modes.len() / 4, "{compared:?} of {}", modes.len());

    let spring = |found: &serde_json::Value| {
        let of = found["models"].as_array().unwrap()[0].clone();
        assert_eq!(of["cable_model"], "spring");
        of
    };
    let largest = number(&spring(&strict)["largest_difference"]).abs();
    assert_eq!(spring(&strict)["missed"].as_f64(), Some(0.0));
    // A tolerance above its largest difference makes the spring good enough, one below does not.
    let tolerance = |factor: f64| with(&["--tolerance", &format!("{}", factor * largest)]);
    assert_eq!(tolerance(1.001)["advice"]["cable_model"], "spring");
    assert_ne!(tolerance(0.999)["advice"]["cable_model"], "spring");
    let none = succeed(&["compare", &cogiro, "--below-hz", "3", "--platform"]);
    assert!(none.contains("No mode below 3 Hz has at least 50 % of its kinetic energy in the platform"), "{none}");
    let output = run(&["compare", &cogiro, "--below-hz", "3", "--platform", "--platform-share", "50"]);
    assert!(output.status.code() == Some(2) && stderr(&output).contains("0.5 for 50 %"), "{}", stderr(&output));
}

/// The sentence stands exactly where static sag is worse than springs above the first cable resonance.
#[test]
fn frozen_sag_is_explained_where_it_happens() {
    let cogiro = robot("cogiro.toml");
    let found = json(&["compare", &cogiro, "--below-hz", "4.9"]);
    let frozen = &found["frozen_sag"];
    assert!(number(&frozen["relative_difference"]) < -0.01, "{frozen}");
    assert!(number(&frozen["relative_difference"]).abs() > number(&frozen["spring_relative_difference"]).abs());
    assert!(number(&frozen["frequency_hz"]) > number(&frozen["first_cable_resonance_hz"]));
    let text = succeed(&["compare", &cogiro, "--below-hz", "4.9"]);
    assert!(text.contains("keeps their sag from following the platform"), "{text}");
    // With a tolerance above the difference, and where no spring finds the mode, there is nothing to explain.
    assert!(json(&["compare", &cogiro, "--below-hz", "4.9", "--tolerance", "0.05"])["frozen_sag"].is_null());
    assert!(json(&["compare", "ROBOT", "--below-hz", "2"])["frozen_sag"].is_null());
}

/// The line of a model and its column tell the same: the number within the tolerance, and the largest difference.
#[test]
fn the_verdict_counts_the_rows_of_the_table() {
    let cogiro = robot("cogiro.toml");
    let text = succeed(&["compare", &cogiro, "--below-hz", "14.78", "--tolerance", "0.006"]);
    let rows: Vec<Vec<&str>> = text
        .lines()
        .filter(|line| line.starts_with(' ') && line.trim_start().starts_with(|of: char| of.is_ascii_digit()))
        .map(|line| line.split_whitespace().collect())
        .collect();
    let differs = |row: &Vec<&str>| row.last().unwrap().trim_end_matches('%').parse::<f64>().unwrap();
    let within = rows.iter().filter(|row| differs(row).abs() <= 0.6).count();
    assert!(rows.len() == 62 && within < 62, "{text}");
    assert!(
        text.contains(&format!("shallow-dynamic   {within} of 62 modes within 0.6 %, misses 0, first wrong")),
        "{text}"
    );

    let text = succeed(&["compare", &cogiro, "--below-hz", "14.78"]);
    assert!(text.contains("all 62 modes within 1 %") && !text.contains(" 1.16%"), "{text}");
}
