//! `gust`: response to turbulent wind.

use super::{csv, json, json_of, number, numbers, robot, run, run_with, stderr, succeed, yuan};

/// Stadium camera with drag, in 12 m/s.
const WINDY: [&str; 11] = [
    "--set",
    "materials.rope-5mm.drag_coefficient=1.2",
    "--set",
    "materials.rope-5mm.drag_diameter_m=0.005",
    "--set",
    "platform.drag_area_m2=0.3",
    "--wind-m-s",
    "12,0,0",
    "--below-hz",
    "1",
    "--turbulence=kaimal",
];

/// Strength and lengths of its gusts.
const GUSTS: [&str; 4] = ["--intensity", "0.15,0.12,0.075", "--length-scale-m", "85.05,28.35,6.93"];

#[test]
fn gusts_have_rms_values_peaks_and_the_smallest_tension() {
    let camera = robot("stadium-camera.toml");
    let line = [&["gust", camera.as_str()][..], &WINDY, &GUSTS].concat();
    let found = json(&line);
    let outputs = found["outputs"].as_array().unwrap();
    let names: Vec<&str> = outputs.iter().map(|row| row["output"].as_str().unwrap()).collect();
    assert_eq!(names, ["x", "y", "z", "tension:1", "tension:2", "tension:3", "tension:4"]);

    // Up and down it moves most, by gusts along the wind; peaks are three times the r.m.s. value.
    let rms: Vec<f64> = outputs.iter().map(|row| number(&row["rms"])).collect();
    assert!(rms[2] > 2.0 * rms[0] && rms[2] > 2.0 * rms[1], "{rms:?}");
    let factor = number(&outputs[2]["peak"]) / rms[2];
    assert!((2.5..3.5).contains(&factor), "{factor}");
    assert!(outputs[3]["slack_probability"].is_number() && outputs[0].get("slack_probability").is_none());
    assert_eq!(numbers(&outputs[0]["density"]).len(), numbers(&found["frequency_hz"]).len());

    let text = succeed(&line);
    assert!(text.contains("Smallest expected tension") && text.contains("by the wind"), "{text}");
    let (header, rows) = csv(&[&line[..], &["--output", "z"]].concat());
    assert_eq!(header, ["output", "frequency_hz", "density", "slow_density", "unit"]);
    assert!(rows.len() > 50);
}

/// The file says what the options say.
#[test]
fn turbulence_of_the_file_is_that_of_the_options() {
    let text = std::fs::read_to_string(robot("stadium-camera.toml")).unwrap();
    let file = format!(
        "{text}\n[wind]\nvelocity_m_s = [12.0, 0.0, 0.0]\nturbulence = \"kaimal\"\nintensity = [0.15, 0.12, 0.075]\n\
         length_scale_m = [85.05, 28.35, 6.93]\n"
    );
    let rest = [&["gust", "-", "--output", "z"][..], &WINDY[..6], &["--below-hz", "1"]].concat();
    let of_file = json_of(&rest, &file);
    let of_options = json_of(&[&["gust", "-", "--output", "z"][..], &WINDY, &GUSTS].concat(), &text);
    assert_eq!(of_file["outputs"], of_options["outputs"]);
}

#[test]
fn wrong_requests_are_refused_with_a_remedy() {
    let wind = ["--wind-m-s", "12,0,0"];
    for (more, expected) in [
        (&[][..], "the wind has no turbulence: give --turbulence"),
        (&["--turbulence", "kaimal"], "needs --intensity and --length-scale-m"),
        (&["--turbulence", "kaimal", "--intensity", "15,12,7", "--length-scale-m", "85,28,7"], "no percentages"),
        (&["--turbulence", "kaimal", "--intensity", "0.1,0.1,0.1", "--length-scale-m", "0,28,7"], "positive lengths"),
        (&["--turbulence", "kaimal", "--intensity", "0.1,0.1,0.1", "--length-scale-m", "85,28,7"], "drag_coefficient"),
        (&["--duration-s", "0"], "--duration-s"),
        (&["--output", "tension:9"], "no cable"),
    ] {
        let output = run(&[&["gust", "ROBOT"][..], &wind, more].concat());
        assert_eq!(output.status.code(), Some(2), "{more:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{more:?}: {}", stderr(&output));
    }

    let still = run(&[&["gust", "ROBOT", "--turbulence", "kaimal"][..], &GUSTS].concat());
    assert_eq!(still.status.code(), Some(2));
    assert!(stderr(&still).contains("no mean wind"), "{}", stderr(&still));
}

#[test]
fn turbulence_of_the_file_needs_a_mean_wind_and_its_keys() {
    for (wind, expected) in [
        ("turbulence = \"kaimal\"", "without a mean wind"),
        ("velocity_m_s = [5, 0, 0]\nturbulence = \"kaimal\"", "has no `intensity`"),
        ("velocity_m_s = [5, 0, 0]\nintensity = [0.1, 0.1, 0.1]", "belongs to a wind with turbulence"),
        ("velocity_m_s = [5, 0, 0]\nturbulence = \"kaimall\"", "did you mean \"kaimal\""),
        (
            "velocity_m_s = [5, 0, 0]\nturbulence = \"kaimal\"\nintensity = [15, 12, 7]\nlength_scale_m = [9, 9, 9]",
            "`intensity`",
        ),
    ] {
        let output = run_with(&["gust", "-"], &format!("{}\n[wind]\n{wind}\n", yuan()));
        assert_eq!(output.status.code(), Some(2), "{wind}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{wind}: {}", stderr(&output));
    }
}

/// Parts by modes add up to one, and a figure shows the spectra.
#[test]
fn spectra_have_parts_by_modes_and_a_figure() {
    let camera = robot("stadium-camera.toml");
    let line = [&["gust", camera.as_str(), "--output", "z", "--output", "tension:1"][..], &WINDY, &GUSTS].concat();
    let found = json(&line);
    for row in found["outputs"].as_array().unwrap() {
        let parts = numbers(&row["share_by_mode"]);
        assert_eq!(parts.len(), found["modes"].as_array().unwrap().len());
        assert!((parts.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{parts:?}");
        assert_eq!(numbers(&row["slow_density"]).len(), numbers(&row["density"]).len());
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gusts.svg");
    let output = run(&[&line[..], &["-o", path.to_str().unwrap()]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let svg = std::fs::read_to_string(path).unwrap();
    assert!(svg.contains("slow gusts (dashed)") && svg.contains("natural frequency"));
}

#[test]
fn measured_spectra_replace_the_formula_and_are_refused_with_their_line() {
    let camera = robot("stadium-camera.toml");
    let wind: Vec<&str> = WINDY[..10].to_vec();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gusts.csv");
    let header = "frequency_hz,along_m2_s,lateral_m2_s,up_m2_s\n";
    // 200 m²/s up to 0.01 Hz, falling to nothing at 0.02 Hz: 3 m²/s², the intensity √3/12.
    let good = format!("{header}0.01,200,0,0\n0.02,0,0,0\n");
    let measured = |text: &str, more: &[&str]| {
        std::fs::write(&path, text).unwrap();
        let own = ["gust", camera.as_str(), "--output", "z", "--spectrum", path.to_str().unwrap()];
        run(&[&own[..], &wind, more].concat())
    };
    let output = measured(&good, &["--intensity", "0.144,0,0", "--format", "json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("the measured spectra end at 0.02"), "{}", stderr(&output));
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(found["turbulence"]["spectrum"], "measured");
    assert!((numbers(&found["turbulence"]["intensity"])[0] - 3.0_f64.sqrt() / 12.0).abs() < 1e-12);

    for (text, more, expected) in [
        (good.clone(), &["--intensity", "0.1,0,0"][..], "integrates to the intensity 0.144"),
        (good.clone(), &["--turbulence", "kaimal"], "not both"),
        (good.clone(), &["--length-scale-m", "1,1,1"], "not both"),
        (format!("{header}0.01,200,0,0\n"), &[], "there are 1 frequencies"),
        (format!("{header}0.02,1,0,0\n0.01,1,0,0\n"), &[], "line 3: the frequency 0.01 Hz is not above"),
        (format!("{header}0.01,1,0,0\n0.02,-1,0,0\n"), &[], "line 3: the density -1"),
        (format!("{header}0.01,1,0,0\n0.02,1,0,inf\n"), &[], "line 3, column `up_m2_s`"),
        (good.replace("up_m2_s", "w"), &[], "there is a column `w`"),
        (good.replace(",up_m2_s", "").replace(",0\n", "\n"), &[], "there is no column `up_m2_s`"),
        (good.replace("200", "20000"), &[], "each must be below 0.5"),
    ] {
        let output = measured(&text, more);
        assert_eq!(output.status.code(), Some(2), "{text} {more:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{text} {more:?}: {}", stderr(&output));
    }
}

/// A map has the numbers of the command.
#[test]
fn maps_have_the_response_to_the_gusts_of_the_file() {
    let text = std::fs::read_to_string(robot("stadium-camera.toml")).unwrap();
    let file = format!(
        "{text}\n[wind]\nvelocity_m_s = [12.0, 0.0, 0.0]\nturbulence = \"kaimal\"\nintensity = [0.15, 0.12, 0.075]\n\
         length_scale_m = [85.05, 28.35, 6.93]\n"
    );
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("camera.toml");
    std::fs::write(&path, file).unwrap();
    let camera = path.to_str().unwrap();
    let set = &WINDY[..6];
    let pose = ["--pose", "0,0,8"];
    let found = json(&[&["gust", camera][..], set, &pose].concat());
    let rows: Vec<&serde_json::Value> = found["outputs"].as_array().unwrap().iter().collect();
    let of = |key: &str| rows.iter().map(|row| row[key].as_f64().unwrap_or(f64::NAN)).collect::<Vec<_>>();
    let (rms, peak, mean, slack) = (of("rms"), of("peak"), of("mean"), of("slack_probability"));
    let expected = [
        rms[..3].iter().map(|x| x * x).sum::<f64>().sqrt(),
        peak[..3].iter().copied().fold(0.0, f64::max),
        (3..rows.len()).map(|k| mean[k] - peak[k]).fold(f64::INFINITY, f64::min),
        slack[3..].iter().copied().fold(0.0, f64::max),
    ];
    let quantities = "gust-rms,gust-peak,gust-tension-min,gust-slack";
    let grid = ["map", camera, "--grid", "x=0", "--grid", "y=0", "--grid", "z=8", "--quantity", quantities];
    let (header, lines) = csv(&[&grid[..], set].concat());
    let names = ["gust_rms_m", "gust_peak_m", "gust_tension_min_n", "gust_slack_probability"];
    for (name, expected) in names.into_iter().zip(expected) {
        let at = header.iter().position(|column| column == name).unwrap();
        let value: f64 = lines[0][at].parse().unwrap();
        // Other outputs make the frequencies finer elsewhere.
        assert!((value - expected).abs() <= 1e-4 * expected.abs() + 1e-12, "{name}: {value} {expected}");
    }
    let still = csv(&["map", "ROBOT", "--grid", "x=0", "--grid", "y=0", "--grid", "z=0.5", "--quantity", "gust-rms"]);
    assert!(still.1[0].iter().any(|value| value == "no-gusts"), "{still:?}");
}
