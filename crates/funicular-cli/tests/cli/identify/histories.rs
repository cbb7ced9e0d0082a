//! Time histories: frequencies alone, as measurements of a fit, and readings that are warned of or refused.

use crate::{json, number, project, run, stderr, stdout, succeed};
use serde_json::Value;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;

/// Table of a decay of 2 Hz with a damping ratio of 1 %, sampled at 40 Hz, with pseudo-random noise; `change` alters
/// time and reading of a row.
fn table(column: &str, change: impl Fn(usize, f64, f64) -> (f64, f64)) -> String {
    let mut text = format!("t_s,{column}\n");
    for k in 0..240 {
        let t = 0.025 * k as f64;
        let noise = 2e-3 * (1e4 * (k as f64 + 0.5).sin()).sin();
        // The damped frequency is below the natural one, by three deviations of the result.
        let turn = (1.0f64 - 0.01 * 0.01).sqrt() * TAU * 2.0 * t;
        let (t, value) = change(k, t, (-0.01 * TAU * 2.0 * t).exp() * turn.cos() + noise);
        let _ = writeln!(text, "{t},{value}");
    }
    text
}

fn arguments(file: &str) -> Vec<String> {
    ["identify", &project("docs/quick-start/hall.toml"), "--measured", file].map(str::to_owned).to_vec()
}

fn words(of: &[String]) -> Vec<&str> {
    of.iter().map(String::as_str).collect()
}

fn poles(found: &Value) -> &Vec<Value> {
    found["histories"][0]["poles"].as_array().unwrap()
}

#[test]
fn frequencies_of_a_decay_are_found_alone_and_as_measurements_of_a_fit() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("decay.csv").to_str().unwrap().to_owned();
    fs::write(&file, table("z_m", |_, t, value| (t, value))).unwrap();
    let line = arguments(&file);
    let found = json(&words(&line));
    let pole = &poles(&found)[0];
    assert_eq!(poles(&found).len(), 1, "{found}");
    let error = |value: f64| (number(&pole["frequency_hz"]) - value) / number(&pole["std_hz"]);
    assert!(error(2.0).abs() < 3.0 && error(2.02).abs() > 20.0, "{pole}");
    assert!((number(&pole["damping_ratio"]) - 0.01).abs() < 3.0 * number(&pole["damping_std"]), "{pole}");
    assert!(stdout(&run(&words(&line))).contains("decay.csv, decay of 5.975 s"));

    let rows = folder.path().join("poles.csv").to_str().unwrap().to_owned();
    let page = folder.path().join("poles.html").to_str().unwrap().to_owned();
    succeed(&[&words(&line)[..], &["-o", &rows, "--page", &page]].concat());
    assert!(fs::read_to_string(&rows).unwrap().contains("decay.csv,"));
    assert!(fs::read_to_string(&page).unwrap().contains("table-histories"));

    // The decay of the documents as a measurement of the mass.
    let example = arguments(&project("docs/identification/hall-decay.csv"));
    let more = ["--set", "materials.rope.axial_loss_factor=0.01", "--cable-model", "spring", "--history-poles", "1"];
    let fit = ["--fit", "platform.mass_kg", "--prior", "platform.mass_kg=60±10", "--hold-lengths-of-pose"];
    let fitted = json(&[&words(&example)[..], &more, &fit].concat());
    assert_eq!(fitted["frequencies"].as_array().unwrap().len(), 1, "{fitted}");
    assert!((number(&fitted["values"][0]["value"]) - 64.0).abs() < 1.0, "{fitted}");
    assert_eq!(fitted["frequencies"][0]["measured_hz"], fitted["histories"][0]["poles"][0]["frequency_hz"]);
}

#[test]
fn readings_that_mislead_are_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    let told = |column: &str, change: &dyn Fn(usize, f64, f64) -> (f64, f64)| {
        let file = folder.path().join("a.csv").to_str().unwrap().to_owned();
        fs::write(&file, table(column, change)).unwrap();
        stderr(&run(&words(&arguments(&file)))).to_owned()
    };
    assert!(told("z_m", &|_, t, value| (t, value)).is_empty());
    assert!(told("z_m", &|_, t, value| (t, value.clamp(-0.3, 9.0))).contains("is clipped"));
    let folded = |_: usize, t: f64, value: f64| (t, value + (TAU * 22.0 * t).cos());
    assert!(told("z_m", &folded).contains("may have been folded down"));
    let uneven = |k: usize, t: f64, value: f64| (t + 0.005 * (k as f64 * 7.0).sin(), value);
    assert!(told("z_m", &uneven).contains("the time steps vary"));
}

#[test]
fn histories_that_cannot_be_used_are_refused_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |text: &str, more: &[&str]| {
        let file = folder.path().join("a.csv").to_str().unwrap().to_owned();
        fs::write(&file, text).unwrap();
        let output = run(&[&words(&arguments(&file))[..], more].concat());
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        stderr(&output).to_owned()
    };
    let good = table("z_m", |_, t, value| (t, value));
    let falling = table("z_m", |k, t, value| (if k == 9 { 0.0 } else { t }, value));
    let uneven = table("z_m", |k, t, value| (t + 0.005 * (k as f64 * 7.0).sin(), value));
    let constant = table("z_m", |_, t, _| (t, 9.81));
    for (text, more, says) in [
        ("t_s,az_m\n0,1\n", &[][..], "the signal az has m_s2"),
        ("t_s\n1\n", &[], "has times and no sensor"),
        ("t_s,z_m\n0,1\n0.1,2\n", &[], "2 samples are too few"),
        ("t_s,z_m\n0,one\n", &[], "line 2, column `z_m`"),
        (&falling, &[], "the times must ascend"),
        (&constant, &[], "has one value throughout"),
        (&good, &["--history-from-s", "5", "--history-to-s", "4"], "is not before --history-to-s"),
        (&uneven, &["--history-kind", "ambient"], "needs even ones"),
        (&good, &["--history-kind", "ambient"], "samples are too few"),
    ] {
        let told = refused(text, more);
        assert!(told.contains(says), "{told}");
    }
}
