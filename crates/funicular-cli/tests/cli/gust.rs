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
    assert_eq!(header, ["output", "frequency_hz", "density", "unit"]);
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
