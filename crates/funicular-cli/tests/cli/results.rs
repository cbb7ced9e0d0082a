//! What the commands find: keys that scripts rely on, and numbers.

use super::{command, json, robot, run, run_with, stderr, stdout, succeed, yuan};
use serde_json::Value;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is a number"))
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap_or_else(|| panic!("{value} is an array")).iter().map(number).collect()
}

fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance
}

/// The table of a CSV: header and rows of equal length.
fn csv(arguments: &[&str]) -> (Vec<String>, Vec<Vec<String>>) {
    let text = succeed(&[arguments, &["--format", "csv"]].concat());
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let rows = reader.records().map(|row| row.unwrap().iter().map(str::to_owned).collect()).collect();
    (header, rows)
}

#[test]
fn every_json_names_schema_command_and_robot_and_holds_no_null() {
    for line in [
        "check ROBOT",
        "parameters ROBOT",
        "statics ROBOT",
        "statics ROBOT --static-model ideal",
        "stiffness ROBOT --at-hz 2",
        "modes ROBOT --below-hz 3",
        "frf ROBOT --from-hz 0 --to-hz 3 --points 50 --input fz --output ay",
        "compare ROBOT --below-hz 3",
        "pose-error ROBOT --mass-kg 10:90:3 --tolerance-mm 5",
        "cable ROBOT --name 1 --from-hz 0 --to-hz 3 --points 5",
    ] {
        let arguments: Vec<&str> = line.split(' ').collect();
        let value = json(&arguments);
        assert_eq!(value["schema"], "funicular/1", "{line}");
        assert_eq!(value["command"], arguments[0], "{line}");
        assert_eq!(value["robot"], "INSA Rennes 6-cable suspended robot, 4 mm cables", "{line}");
        assert!(value["warnings"].is_array(), "{line}");
        assert!(!value.to_string().contains("null"), "{line}");
        let (header, rows) = csv(&arguments);
        assert!(!header.is_empty() && !rows.is_empty(), "{line}");
        let text = succeed(&arguments);
        assert!(!text.contains("NaN") && !text.contains("inf") && text.ends_with('\n'), "{line}: {text}");
    }
}

#[test]
fn statics_has_the_published_pose_and_the_keys() {
    let value = json(&["statics", "ROBOT"]);
    let position = numbers(&value["pose"]["position_m"]);
    for (found, expected) in position.iter().zip([0.020_304_9, 0.010_231_8, 0.455_485_0]) {
        assert!(close(*found, expected, 1e-6), "{position:?}");
    }
    assert!(close(numbers(&value["pose"]["quaternion_wxyz"]).iter().map(|q| q * q).sum(), 1.0, 1e-12));
    assert!(number(&value["residual"]) <= 1e-10);
    assert_eq!(value["stable"], true);
    assert_eq!(value["static_model"], "catenary");
    assert!(number(&value["least_stiffness_n_per_m"]) > 0.0 && value["iterations"].is_u64());
    let cables = value["cables"].as_array().unwrap();
    assert_eq!(cables.len(), 6);
    for key in ["unstrained_length_m", "tension_platform_n", "tension_anchor_n", "chord_m", "sag_ratio", "lambda2"] {
        assert!(cables.iter().all(|cable| number(&cable[key]) > 0.0), "{key}");
    }
    assert_eq!(cables[0]["name"], "1");
    let forces: Vec<f64> = cables.iter().map(|cable| numbers(&cable["force_on_platform_n"])[2]).collect();
    assert!(close(forces.iter().sum(), 10.55 * 9.81, 1e-8), "the cables carry the weight");
}

#[test]
fn pose_and_lengths_are_inverse_to_each_other() {
    let there = json(&["statics", "ROBOT", "--pose", "-0.05,0.02,0.5,1,-2,3", "--mass-kg", "20"]);
    let lengths: Vec<String> =
        there["cables"].as_array().unwrap().iter().map(|c| c["unstrained_length_m"].to_string()).collect();
    let back = json(&["statics", "ROBOT", "--lengths-m", &lengths.join(","), "--set", "platform.mass_kg=20"]);
    for key in ["position_m", "roll_pitch_yaw_deg"] {
        let (a, b) = (numbers(&there["pose"][key]), numbers(&back["pose"][key]));
        assert!(a.iter().zip(&b).all(|(a, b)| close(*a, *b, 1e-7)), "{a:?} {b:?}");
    }
    assert!(close(numbers(&there["pose"]["position_m"])[0], -0.05, 1e-12));
}

#[test]
fn stiffness_at_rest_is_the_symmetric_tangent_and_above_it_that_of_the_exact_cables() {
    let still = json(&["stiffness", "ROBOT"]);
    assert_eq!(still["cable_model"], "catenary-tangent");
    assert_eq!(still["assembly"], "consistent");
    let rows: Vec<Vec<f64>> = still["real"].as_array().unwrap().iter().map(numbers).collect();
    let imag: Vec<Vec<f64>> = still["imag"].as_array().unwrap().iter().map(numbers).collect();
    assert!(rows.len() == 6 && imag.iter().flatten().all(|k| *k == 0.0));
    for i in 0..6 {
        for j in 0..6 {
            assert!(close(rows[i][j], rows[j][i], 1e-8 * rows[0][0]));
        }
    }
    let moving = json(&["stiffness", "ROBOT", "--at-hz", "2"]);
    assert_eq!(moving["cable_model"], "exact");
    assert!(moving["imag"].as_array().unwrap().iter().flat_map(numbers).any(|k| k != 0.0));
    let shallow = json(&["stiffness", "ROBOT", "--cable-model", "closed-form"]);
    assert_eq!(shallow["cable_model"], "closed-form");
    assert_eq!(json(&["stiffness", "ROBOT", "--assembly", "paper"])["cable_model"], "catenary-tangent");
    assert!(json(&["stiffness", "ROBOT", "--static-model", "spring"])["static_model"] == "spring");
}

#[test]
fn modes_below_20_hz_are_147_and_certified() {
    let value = json(&["modes", "ROBOT", "--below-hz", "20"]);
    assert_eq!(value["count_below"], 147);
    assert_eq!(value["certified"], true);
    assert_eq!(value["cable_model"], "exact");
    let modes = value["modes"].as_array().unwrap();
    assert_eq!(modes.len(), 147);
    for mode in modes {
        assert!(["platform", "cable", "mixed"].contains(&mode["kind"].as_str().unwrap()));
        assert_eq!(numbers(&mode["shape"]).len(), 6);
        let energy =
            number(&mode["platform_energy_fraction"]) + numbers(&mode["cable_energy_fractions"]).iter().sum::<f64>();
        assert!(close(energy, 1.0, 1e-9));
        assert!(number(&mode["damping_ratio"]) <= 0.003 + 1e-12);
    }
    let text = succeed(&["modes", "ROBOT", "--below-hz", "20"]);
    assert!(
        text.contains("Certified: the Wittrick–Williams count below 20 Hz is 147, the list has 147 modes"),
        "{text}"
    );
    assert_eq!(csv(&["modes", "ROBOT", "--below-hz", "20"]).1.len(), 147);
}

#[test]
fn a_frequency_response_is_that_of_its_csv_and_finds_the_peaks() {
    let options =
        ["frf", "ROBOT", "--from-hz", "0.1", "--to-hz", "5", "--points", "2000", "--input", "fz", "--output", "ay"];
    let value = json(&options);
    assert_eq!(value["unit"], "(m/s²)/N");
    let (frequency, real) = (numbers(&value["frequency_hz"]), numbers(&value["real"]));
    assert!(frequency.len() == 2000 && real.len() == 2000 && numbers(&value["imag"]).len() == 2000);
    let peaks = value["peaks"].as_array().unwrap();
    assert!(peaks.iter().all(|peak| number(&peak["prominence_db"]) >= 1.0));
    assert!(peaks.iter().any(|peak| close(number(&peak["frequency_hz"]), 1.2672, 5e-3)), "{peaks:?}");
    let (header, rows) = csv(&options);
    assert_eq!(header, ["frequency_hz", "real", "imag", "magnitude", "phase_deg"]);
    let cell = |row: usize, column: usize| rows[row][column].parse::<f64>().unwrap();
    for row in [0, 700, 1999] {
        assert_eq!(cell(row, 0).to_bits(), frequency[row].to_bits(), "every digit");
        assert_eq!(cell(row, 1).to_bits(), real[row].to_bits());
        assert!(close(cell(row, 3), cell(row, 1).hypot(cell(row, 2)), 1e-15));
    }
}

#[test]
fn a_force_at_a_point_is_a_force_and_a_moment() {
    let frf = |input: &str, output: &str, more: &[&str]| {
        let range =
            ["frf", "ROBOT", "--from-hz", "0.5", "--to-hz", "5", "--points", "5", "--input", input, "--output", output];
        numbers(&json(&[&range, more].concat())["real"])
    };
    let together = frf("fx", "z", &["--input-point-m", "0,0,0"]);
    assert_eq!(frf("fx", "z", &[]), together);
    assert_eq!(frf("f:2,0,0", "x:0,0,3", &[]), together, "directions are unit vectors");
    let (reciprocal, other) = (frf("fz", "x", &[]), frf("mx", "ry", &[]));
    assert!(together.iter().zip(&reciprocal).all(|(a, b)| close(*a, *b, 1e-9 * a.abs())));
    assert!(other.iter().any(|x| *x != 0.0));
    let shifted = frf("fx", "z", &["--output-point-m", "-0.1,0.2,0.3", "--input-point-m", "0.1,0,-0.2"]);
    assert!(shifted.iter().zip(&together).any(|(a, b)| !close(*a, *b, 1e-6 * b.abs())));
}

#[test]
fn compare_has_all_models_and_advice() {
    let value = json(&["compare", "ROBOT", "--below-hz", "3"]);
    let models: Vec<&str> =
        value["models"].as_array().unwrap().iter().map(|m| m["cable_model"].as_str().unwrap()).collect();
    assert_eq!(models, ["spring", "static-sag", "catenary-tangent", "closed-form", "exact"]);
    assert_eq!(value["reference"], "exact");
    assert_eq!(value["advice"]["cable_model"], "closed-form");
    assert!(succeed(&["compare", "ROBOT", "--below-hz", "3"]).contains("Use `closed-form`"));
}

#[test]
fn pose_error_names_the_threshold_mass() {
    let value = json(&["pose-error", "ROBOT", "--mass-kg", "10.55:86.35:20", "--tolerance-mm", "5"]);
    let points = value["points"].as_array().unwrap();
    assert_eq!(points.len(), 20);
    assert!(close(number(&points[19]["mass_kg"]), 86.35, 0.0));
    let distance = |i: usize| number(&points[i]["spring_from_catenary"]["distance_m"]);
    let mass = number(&value["threshold"]["from_mass_kg"]);
    for (i, point) in points.iter().enumerate() {
        assert_eq!(number(&point["mass_kg"]) >= mass, distance(i) <= 0.005, "{i}");
    }
}

#[test]
fn the_stiffness_of_a_cable_is_the_same_in_its_own_and_in_world_axes() {
    for model in ["exact", "closed-form", "static-sag", "spring", "catenary-tangent"] {
        let value = json(&[
            "cable",
            "ROBOT",
            "--name",
            "1",
            "--from-hz",
            "0",
            "--to-hz",
            "3",
            "--points",
            "4",
            "--cable-model",
            model,
        ]);
        let trace = |i: usize| {
            let world = &value["world"]["real"][i];
            (0..3).map(|k| number(&world[k][k])).sum::<f64>()
        };
        let local = |key: &str| numbers(&value["local"][key]["real"]);
        let (a, c, o) = (local("k_a"), local("k_c"), local("k_o"));
        for i in 0..4 {
            let sum = a[i] + c[i] + o[i];
            assert!(close(trace(i), sum, 1e-9 * (a[i].abs() + c[i].abs() + o[i].abs())), "{model} {i}");
        }
        assert_eq!(value["clamped_frequencies_hz"].is_array(), matches!(model, "closed-form" | "exact"));
    }
}

#[test]
fn massless_and_slack_cables_leave_their_keys_out() {
    let text = yuan().replace("mass_kg_per_m = 0.067", "mass_kg_per_m = 0");
    let value: Value =
        serde_json::from_str(stdout(&run_with(&["statics", "-", "--format", "json"], &text))).expect("it is JSON");
    assert!(value["cables"][0].get("string_frequency_hz").is_none());
    assert!(close(number(&value["cables"][0]["sag_ratio"]), 0.0, 0.0));
    let slack = json(&["statics", "ROBOT", "--static-model", "spring", "--set", "cables.1.unstrained_length_m=9"]);
    assert!(slack["cables"][0].get("lambda2").is_none());
    assert!(slack["warnings"][0].as_str().unwrap().contains("slack"), "{}", slack["warnings"]);
    for format in ["text", "csv"] {
        let output = run_with(&["modes", "-", "--below-hz", "9", "--format", format], &text);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(!stdout(&output).contains("NaN"));
    }
}

#[test]
fn warnings_go_to_stderr_and_into_the_json() {
    let arguments = ["modes", "ROBOT", "--below-hz", "400", "--cable-model", "spring", "--format", "json"];
    let output = run(&arguments);
    assert!(stderr(&output).starts_with("warning: 400 Hz"), "{}", stderr(&output));
    let value: Value = serde_json::from_str(stdout(&output)).unwrap();
    assert!(value["warnings"][0].as_str().unwrap().contains("axial"));
}

#[test]
fn set_changes_cables_by_name_and_text_without_quotes() {
    let value = json(&["check", "ROBOT", "--set", "cables.3.unstrained_length_m=6.5", "--set", "name=other"]);
    assert!(close(number(&value["cables"][2]["unstrained_length_m"]), 6.5, 0.0));
    assert_eq!(value["robot"], "other");
    let heavy = json(&["statics", "ROBOT", "--set", "platform.mass_kg=20"]);
    let same = json(&["statics", "ROBOT", "--mass-kg", "20"]);
    assert_eq!(heavy["pose"], same["pose"]);
}

#[test]
fn every_robot_of_the_library_is_checked_and_rests() {
    for name in ["yuan2014-4mm.toml", "yuan2014-8mm.toml", "cogiro.toml", "sap2000-8-cable-point-mass.toml"] {
        let path = robot(name);
        assert!(json(&["check", &path])["cables"].as_array().unwrap().len() >= 6);
        assert!(number(&json(&["statics", &path])["residual"]) <= 1e-10, "{name}");
    }
}

#[test]
fn output_is_the_same_every_time() {
    let once = || command(&["modes", "ROBOT", "--below-hz", "10"]).output().unwrap().stdout;
    assert_eq!(once(), once());
}

#[test]
fn validate_passes_every_comparison_and_needs_no_robot() {
    let value = json(&["validate"]);
    assert_eq!((&value["schema"], &value["command"]), (&Value::from("funicular/1"), &Value::from("validate")));
    assert!(value.get("robot").is_none());
    assert_eq!(value["passed"], value["comparisons"]);
    let sections = value["sections"].as_array().unwrap();
    let rows: Vec<&Value> = sections.iter().flat_map(|section| section["rows"].as_array().unwrap()).collect();
    assert_eq!((sections.len(), rows.len() as u64), (8, value["comparisons"].as_u64().unwrap()));
    for row in &rows {
        assert!(number(&row["difference"]) <= number(&row["tolerance"]), "{row}");
        assert!(row["source"].as_str().is_some_and(|source| !source.is_empty()), "{row}");
        assert!(numbers(&row["theirs"]).len() == numbers(&row["ours"]).len(), "{row}");
    }
    let (header, table) = csv(&["validate"]);
    assert_eq!((header[0].as_str(), table.len()), ("section", rows.len()));
    assert!(succeed(&["validate"]).starts_with("# Validation\n"));
}

#[test]
fn a_list_without_modes_says_so_without_an_empty_table() {
    let text = succeed(&["modes", "ROBOT", "--below-hz", "0.5"]);
    assert!(text.contains("count below 0.5 Hz is 0, the list has 0 modes") && !text.contains("f [Hz]"), "{text}");
    let text = succeed(&[
        "frf",
        "ROBOT",
        "--from-hz",
        "0",
        "--to-hz",
        "0.2",
        "--points",
        "9",
        "--input",
        "fz",
        "--output",
        "z",
    ]);
    let compared = succeed(&["compare", "ROBOT", "--below-hz", "0.5"]);
    assert!(compared.contains("no modes, as the reference") && !compared.contains("[Hz]"), "{compared}");
    assert!(text.contains("0 peaks") && !text.contains("peak [Hz]"), "{text}");
}

#[test]
fn tensions_of_a_redundant_robot_follow_the_rule_and_show_their_limits() {
    let cogiro = robot("cogiro.toml");
    let pose = ["statics", &cogiro, "--pose", "1,1,1.5"];
    let of = |options: &[&str]| json(&[&pose, options].concat());
    let tensions = |value: &Value| -> Vec<f64> {
        value["cables"].as_array().unwrap().iter().map(|c| number(&c["tension_platform_n"])).collect()
    };
    let lowest = of(&[]);
    assert_eq!(lowest["tension_rule"], "lowest");
    assert!(number(&lowest["residual"]) <= 1e-10);
    for cable in lowest["cables"].as_array().unwrap() {
        assert_eq!((number(&cable["minimum_tension_n"]), number(&cable["maximum_tension_n"])), (100.0, 5000.0));
        assert!(number(&cable["tension_margin_n"]) > -1e-4 && number(&cable["tension_margin"]) < 0.5);
    }
    let reached = |value: &Value| value["cables"].as_array().unwrap().iter().any(|c| c["limit_reached"] == "minimum");
    let sum = |value: &Value| tensions(value).iter().sum::<f64>();
    let wide = of(&["--max-tension-n", "800", "--min-tension-n", "265"]);
    assert!(reached(&wide), "{wide}");
    assert!(tensions(&wide).iter().all(|t| *t > 264.0 && *t < 800.0));
    let middle = of(&["--tension-rule", "middle", "--max-tension-n", "800"]);
    let least = |value: &Value| {
        let margins = value["cables"].as_array().unwrap().iter().map(|c| number(&c["tension_margin_n"]));
        margins.fold(f64::INFINITY, f64::min)
    };
    assert!(least(&middle) >= least(&of(&["--max-tension-n", "800"])));
    let stiffest = of(&["--tension-rule", "stiffest", "--max-tension-n", "800"]);
    let stiffness = |value: &Value| number(&value["least_stiffness_n_per_m"]);
    assert!(stiffness(&stiffest) >= stiffness(&middle) && stiffness(&stiffest) >= stiffness(&lowest));
    let closest = of(&["--wanted-tension-n", "450"]);
    assert_eq!(closest["tension_rule"], "closest");
    assert!(sum(&closest) > sum(&lowest));
    let text = succeed(&pose);
    assert!(text.contains("tensions by the rule `lowest`") && text.contains("100 to 5000"), "{text}");
    // The other analyses start from the same state.
    assert!(succeed(&["modes", &cogiro, "--pose", "1,1,1.5", "--below-hz", "3"]).contains("Certified"));
}

#[test]
fn a_state_beyond_its_limits_is_warned_of_with_numbers() {
    let output = run(&["statics", "ROBOT", "--max-tension-n", "50"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(stderr(&output).contains("more than its `maximum_tension_n`, 50 N"), "{}", stderr(&output));
    let rope = "materials.rope-4mm.breaking_load_n=52";
    let output = run(&["statics", "ROBOT", "--set", rope]);
    assert!(stderr(&output).contains("its rope breaks at 52 N"), "{}", stderr(&output));
}

#[test]
fn modes_take_part_in_a_response_and_move_their_cables() {
    let value =
        json(&["modes", "ROBOT", "--below-hz", "3", "--input", "fz", "--output", "cable:3@0.5:az", "--stations", "5"]);
    assert_eq!(value["damped_certified"], true);
    assert_eq!(value["peak_unit"], "(m/s²)/N");
    let stations = value["stations"].as_array().unwrap();
    assert_eq!(stations.len(), 6);
    let frf = json(&[
        "frf",
        "ROBOT",
        "--from-hz",
        "1.7",
        "--to-hz",
        "2",
        "--points",
        "3001",
        "--input",
        "fz",
        "--output",
        "cable:3@0.5:az",
    ]);
    let peak = frf["peaks"].as_array().unwrap().iter().map(|peak| number(&peak["magnitude"])).fold(0.0, f64::max);
    let mut largest = 0.0_f64;
    for mode in value["modes"].as_array().unwrap() {
        let (zeta, [re, im]) = (number(&mode["damping_ratio"]), [0, 1].map(|i| number(&mode["eigenvalue_per_s"][i])));
        assert!(re < 0.0 && close(zeta, -re / re.hypot(im), 1e-14));
        assert!(number(&mode["modal_mass_kg"]) > 0.0);
        let shapes = mode["cable_shapes"].as_array().unwrap();
        assert!(shapes.len() == 6 && shapes.iter().all(|cable| cable.as_array().unwrap().len() == 5));
        // Anchors are held.
        assert!(shapes.iter().all(|cable| numbers(&cable[4]).iter().all(|u| u.abs() < 1e-9)));
        if (1.7..2.0).contains(&number(&mode["frequency_hz"])) {
            largest = largest.max(number(&mode["peak"]));
        }
    }
    // One mode stands out, and is most of the peak.
    assert!(close(largest, peak, 0.1 * peak), "{largest} {peak}");
}

#[test]
fn a_reduced_model_is_read_by_others_as_it_was_made() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let arguments =
        ["reduce", "ROBOT", "--below-hz", "3", "--input", "fz", "--output", "az", "--output", "cable:3@0.5:z"];
    fn with<'a>(arguments: &[&'a str], model: &'a str) -> Vec<&'a str> {
        [arguments, &["--model", model]].concat()
    }
    let (npz, csv) = (place("my model.npz"), place("a folder"));
    let found = json(&with(&arguments, &npz));
    let n = found["order"].as_u64().unwrap();
    assert!(number(&found["truncation_error"]) <= 1e-3 && number(&found["frequency_error"]) < 1e-4);
    assert!(succeed(&with(&arguments, &csv)).contains(&format!("{n} coordinates: the platform's 6")));
    let mut archive = zip::ZipArchive::new(std::fs::File::open(&npz).unwrap()).unwrap();
    let shapes =
        [("M", [n, n]), ("K", [n, n]), ("B", [n, 1]), ("L", [2, n]), ("ss_A", [2 * n, 2 * n]), ("ss_D", [2, 1])];
    for (name, shape) in shapes {
        let mut bytes = Vec::new();
        std::io::copy(&mut archive.by_name(&format!("{name}.npy")).unwrap(), &mut bytes).unwrap();
        let array = npyz::NpyFile::new(&bytes[..]).unwrap();
        assert_eq!((array.shape(), array.order()), (&shape[..], npyz::Order::Fortran), "{name}");
        let values: Vec<f64> = array.into_vec().unwrap();
        // The same numbers in rows.
        let text = std::fs::read_to_string(format!("{csv}/{name}.csv")).unwrap();
        let rows: Vec<Vec<f64>> =
            text.lines().map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect();
        assert_eq!([rows.len() as u64, rows[0].len() as u64], shape, "{name}");
        for (i, row) in rows.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                assert_eq!(value.to_bits(), values[j * rows.len() + i].to_bits(), "{name} {i} {j}");
            }
        }
    }
    assert!(archive.by_name("description.json").is_ok());
    // What is there is not written over.
    let refused = run(&with(&arguments, &csv));
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("is not empty"), "{}", stderr(&refused));
    let refused = run(&with(&arguments, &place("model.mat")));
    assert!(stderr(&refused).contains("neither an .npz file nor a folder"), "{}", stderr(&refused));
    let refused = run(&["reduce", "ROBOT", "--below-hz", "3", "--cable-model", "closed-form"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("choose the model `exact`"), "{}", stderr(&refused));
}

#[test]
fn every_listed_parameter_is_one_that_set_takes_and_its_value_changes_nothing() {
    for robot in [robot("cogiro.toml"), robot("kntu-planar.toml"), "ROBOT".to_owned()] {
        let listed = json(&["parameters", &robot]);
        let rows = listed["parameters"].as_array().unwrap();
        assert!(rows.len() > 40, "{robot}: {}", rows.len());
        let changes: Vec<String> =
            rows.iter().map(|row| format!("--set={}={}", row["path"].as_str().unwrap(), row["value"])).collect();
        let set: Vec<&str> = ["check", robot.as_str()].into_iter().chain(changes.iter().map(String::as_str)).collect();
        assert_eq!(json(&set), json(&["check", &robot]));
        for row in rows {
            let [value, minimum, maximum] = ["value", "minimum", "maximum"].map(|key| row[key].as_f64().unwrap());
            assert!((minimum..=maximum).contains(&value), "{row}");
        }
    }
}
