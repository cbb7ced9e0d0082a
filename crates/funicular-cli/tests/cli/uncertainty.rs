//! `uncertainty`: against `gradient`, tables and files, work that goes on, refusals.

use super::{csv, json, number, robot, run, stderr, succeed};
use std::fs;

/// Deviations that leave every result linear.
const SMALL: &str = "platform.mass_kg=1%,cables.*.anchor_m=0.0002";

#[test]
fn linear_deviations_are_the_root_sum_of_squares_of_the_derivatives() {
    let found = json(&[
        "uncertainty",
        "ROBOT",
        "--deviations",
        SMALL,
        "--of",
        "pose,tensions,frequencies,damping",
        "--below-hz",
        "1.3",
    ]);
    let gradient = json(&[
        "gradient",
        "ROBOT",
        "--of",
        "pose,tensions,frequencies,damping",
        "--below-hz",
        "1.3",
        "--by",
        "platform.mass_kg,cables.*.anchor_m",
        "--per",
        "tolerance",
        "--tolerances",
        SMALL,
    ]);
    let results = found["poses"][0]["results"].as_array().unwrap();
    let theirs = gradient["results"].as_array().unwrap();
    assert_eq!((results.len(), found["inputs"].as_array().unwrap().len()), (theirs.len(), 19));
    for (result, theirs) in results.iter().zip(theirs) {
        assert_eq!((&result["name"], &result["unit"]), (&theirs["name"], &theirs["unit"]));
        let squares: f64 = theirs["derivatives"].as_array().unwrap().iter().map(|of| number(of).powi(2)).sum();
        let (deviation, value) = (number(&result["deviation"]), number(&result["value"]));
        // The list of modes goes on to another limit, with another rounding of damped modes: 2e-12 observed.
        assert!((deviation - squares.sqrt()).abs() <= 1e-10 * deviation, "{result}");
        // Normal distributions: 1.96 deviations to both sides.
        let to = number(&result["interval_95"][1]);
        assert!(
            (to - value - 1.959_963_984_540_054 * deviation).abs() <= 1e-9 * deviation + 1e-15 * to.abs(),
            "{result}"
        );
        let shares: f64 = result["group_shares"].as_array().unwrap().iter().map(number).sum();
        assert!((shares - 1.0).abs() < 1e-12 && result["method"] == "linear", "{result}");
        assert_eq!(result["shares"].as_array().unwrap().len(), 19);
    }
}

#[test]
fn a_cable_that_may_become_slack_and_frequencies_that_may_cross_are_sampled() {
    let cogiro = robot("cogiro.toml");
    let lengths = |size: &str| {
        let deviations = format!("cables.*.unstrained_length_m={size}");
        json(&["uncertainty", &cogiro, "--deviations", &deviations, "--of", "tensions", "--samples", "50"])
    };
    // Half a millimetre changes the tensions by some ten newton, five millimetres by more than the tensions.
    let found = lengths("0.0002");
    assert!(found["poses"][0]["results"].as_array().unwrap().iter().all(|result| result["method"] == "linear"));
    assert_eq!(found["evaluations"], 0);
    let found = lengths("0.005");
    for result in found["poses"][0]["results"].as_array().unwrap() {
        assert_eq!(result["method"], "sampled");
        assert!(
            result["sampling_reason"].as_str().unwrap().contains("may become slack: 3 deviations of its tension are"),
            "{result}"
        );
        // Cables that become slack carry less than the linear deviation says.
        assert!(number(&result["deviation"]) < 0.9 * number(&result["linear_deviation"]), "{result}");
    }
    assert!(found["notes"][0].as_str().unwrap().starts_with("16 results sampled with 50 robots"), "{found}");

    let found = json(&[
        "uncertainty",
        "ROBOT",
        "--deviations",
        "platform.center_of_mass_m=0.002",
        "--of",
        "frequencies",
        "--below-hz",
        "1.3",
        "--samples",
        "12",
    ]);
    let results = found["poses"][0]["results"].as_array().unwrap();
    let reasons: Vec<Option<&str>> = results.iter().map(|result| result["sampling_reason"].as_str()).collect();
    assert_eq!(results.len(), 4, "{reasons:?}");
    // 300 robots have a deviation of frequency 1 that is 2 % above the linear one.
    assert!(reasons[0].unwrap().starts_with("frequencies 1 and 4 come near each other and mix"), "{reasons:?}");
    assert!(reasons[1].unwrap().starts_with("frequencies 2 and 3 may cross: they are 0.0355 Hz apart"), "{reasons:?}");
    assert_eq!(reasons[1], reasons[2]);
    assert_eq!(found["evaluations"], 12);
}

#[test]
fn text_table_page_and_poses() {
    let text = succeed(&["uncertainty", "ROBOT", "--deviations", SMALL, "--of", "tensions"]);
    for says in [
        "deviations of results from 19 numbers that deviate",
        "Groups: platform.mass_kg=1% (1 number), cables.*.anchor_m=0.0002 (18 numbers).",
        "12 results linear: within the deviations no cable becomes slack",
        "platform.mass_kg ",
    ] {
        assert!(text.contains(says), "{says}: {text}");
    }

    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    fs::write(at("poses.csv"), "x_m,y_m,z_m\n0,0,0.4\n0.1,0,0.4\n30,0,1\n").unwrap();
    let options = [
        "uncertainty",
        "ROBOT",
        "--poses",
        &at("poses.csv"),
        "--tolerances",
        "platform.mass_kg=1%",
        "--of",
        "stiffness-min",
    ];
    let (header, rows) = csv(&options);
    assert_eq!(header[..8], ["pose", "x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg", "result"]);
    assert_eq!((rows.len(), header.last().unwrap().as_str()), (2, "share of platform.mass_kg=1%"));
    assert_eq!((rows[1][1].as_str(), rows[1][7].as_str()), ("0.1", "minimum stiffness"));
    let found = json(&options);
    assert!(found["poses"][2]["reason"].as_str().unwrap().contains("no tensions found"), "{found}");
    let worst = &found["poses"][0]["results"][0]["worst"];
    assert!(number(&worst["up"]) > 0.0 && number(&worst["down"]) < 0.0 && number(&worst["linear"]) > 0.0, "{worst}");

    for page in [&["-o"][..], &["--format", "text", "--page"]] {
        let path = at("page.html");
        succeed(&[&options[..], page, &[&path]].concat());
        let page = fs::read_to_string(&path).unwrap();
        assert!(page.contains("uncertainty of results") && page.contains("figure-poses-1"), "{}", page.len());
        assert!(page.contains("minimum stiffness: values with the intervals that hold 95 %"));
    }
    let path = at("one.html");
    succeed(&["uncertainty", "ROBOT", "--deviations", SMALL, "-o", &path]);
    let page = fs::read_to_string(&path).unwrap();
    assert!(page.contains("figure-results-1") && page.contains("figure-shares"));
}

#[test]
fn sampled_robots_are_kept_in_a_file_and_do_not_depend_on_the_threads() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let file = at("robots.parquet");
    let options = |more: &[&str]| -> Vec<String> {
        let line =
            ["uncertainty", "ROBOT", "--deviations", "platform.mass_kg=2%", "--deviations", "cables.*.anchor_m=0.001"];
        let line = line.iter().chain(&["--method", "sampled", "--samples", "40"]).chain(more);
        line.map(|word| (*word).to_owned()).collect()
    };
    let run_json = |more: &[&str]| {
        let line = options(more);
        json(&line.iter().map(String::as_str).collect::<Vec<_>>())
    };
    let stored = run_json(&["--samples-file", &file, "--threads", "3"]);
    assert_eq!(stored["evaluations"], 120);
    assert_eq!(run_json(&["--threads", "1"]), stored);
    // The file is complete: nothing is computed again. Another sample is refused.
    assert_eq!(run_json(&["--samples-file", &file, "--resume"]), stored);
    let line = options(&["--samples-file", &file, "--resume", "--seed", "1"]);
    let output = run(&line.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("seed"), "{}", stderr(&output));
    assert_ne!(run_json(&["--seed", "1"])["poses"], stored["poses"]);

    let csv_file = at("robots.csv");
    run_json(&["--samples-file", &csv_file]);
    let table = fs::read_to_string(&csv_file).unwrap();
    assert!(table.starts_with("pose,set,number,reason,pose_x_m,"), "{}", &table[..80]);
    assert_eq!(table.lines().count(), 121);
}

#[test]
fn requests_that_make_no_sense_are_refused_with_the_reason() {
    let cogiro = robot("cogiro.toml");
    let few = robot("grab-3-cables.toml");
    for (arguments, expected) in [
        (&["uncertainty", "ROBOT"][..], "no number deviates: give --deviations, --tolerances or --covariance"),
        (&["uncertainty", "ROBOT", "--deviations", "platform.mas_kg=1"], "did you mean `platform.mass_kg`?"),
        (
            &["uncertainty", "ROBOT", "--deviations", "platform.mass_kg"],
            "--deviations platform.mass_kg: write PATH=VALUE",
        ),
        (&["uncertainty", "ROBOT", "--tolerances", "platform.mass_kg=-1"], "it must be finite and not negative"),
        (&["uncertainty", "ROBOT", "--deviations", "platform=1%", "--of", "tension"], "did you mean `tensions`?"),
        (
            &["uncertainty", "ROBOT", "--deviations", "platform=1%", "--of", "frequencies"],
            "`frequencies` needs --below-hz",
        ),
        (&["uncertainty", "ROBOT", "--deviations", "platform=1%", "--samples", "3"], "give a whole number from 10"),
        (
            &["uncertainty", &cogiro, "--deviations", "cables.*.unstrained_length_m=1%", "--hold", "pose"],
            "with the pose held the lengths follow, and cannot deviate by itself",
        ),
        (
            &["uncertainty", &cogiro, "--deviations", "state.position_m=0.01"],
            "with the lengths held the pose follows, and cannot deviate by itself",
        ),
        (
            &["uncertainty", &few, "--deviations", "platform=1%", "--hold", "pose"],
            "3 cables cannot hold the pose of a platform with 6 degrees of freedom by their lengths; give --hold \
             lengths",
        ),
        (
            &["uncertainty", "ROBOT", "--static-model", "ideal", "--deviations", "platform=1%", "--method", "linear"],
            "x has no linear deviation",
        ),
    ] {
        let output = run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{arguments:?}: {}", stderr(&output));
    }
    let output = run(&["uncertainty", "ROBOT", "--deviations", "platform=1%", "--pose", "30,0,1"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
}

#[test]
fn deviations_of_a_response_are_those_of_its_real_and_imaginary_derivatives() {
    let response = ["--of", "response", "--at-hz", "0.5", "--input", "fz", "--output", "az"];
    let line = ["uncertainty", "ROBOT", "--deviations", SMALL, "--method", "linear"];
    let found = json(&[&line[..], &response[..]].concat());
    let line = ["gradient", "ROBOT", "--by", "platform.mass_kg,cables.*.anchor_m", "--per", "tolerance"];
    let gradient = json(&[&line[..], &["--tolerances", SMALL], &response[..]].concat());
    assert_eq!(found["response"]["unit"], "(m/s²)/N");

    let parts = gradient["results"].as_array().unwrap();
    let [re, im] = [0, 1].map(|k| number(&parts[k]["value"]));
    let [by_re, by_im] =
        [0, 1].map(|k| parts[k]["derivatives"].as_array().unwrap().iter().map(number).collect::<Vec<_>>());
    let square = re * re + im * im;
    let relative: Vec<[f64; 2]> = (by_re.iter().zip(&by_im))
        .map(|(dr, di)| [(dr * re + di * im) / square, (di * re - dr * im) / square])
        .collect();
    let results = found["poses"][0]["results"].as_array().unwrap();
    assert_eq!(results.len(), 2);
    for (k, (result, (value, factor))) in (results.iter())
        .zip([
            (10.0 * square.log10(), 20.0 / std::f64::consts::LN_10),
            (im.atan2(re).to_degrees(), 180.0 / std::f64::consts::PI),
        ])
        .enumerate()
    {
        let deviation = factor * relative.iter().map(|part| part[k].powi(2)).sum::<f64>().sqrt();
        assert!((number(&result["value"]) - value).abs() < 1e-9, "{result} {value}");
        // The list of modes goes on to another limit, with another rounding; the phase is 1e-3 of the response.
        assert!((number(&result["deviation"]) / deviation - 1.0).abs() < 1e-7, "{result} {deviation}");
        assert_eq!((&result["method"], number(&result["at_hz"])), (&"linear".into(), 0.5));
    }
}
