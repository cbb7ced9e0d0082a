//! `settle`: decay after a release.

use super::{csv, json, json_of, number, numbers, robot, run, run_with, stderr, succeed, yuan};

/// Small release at the robot of Yuan 2014.
const SMALL: [&str; 6] = ["settle", "ROBOT", "--release-n", "0,0,-1", "--below-hz", "6"];

fn size(of: &serde_json::Value) -> f64 {
    numbers(of).iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[test]
fn a_release_has_its_displacement_its_modes_and_two_times() {
    let found = json(&[&SMALL[..], &["--tolerance-m", "1e-4"]].concat());
    let (settled, surely) = (number(&found["settled_s"]), number(&found["surely_settled_s"]));
    assert!(settled > 0.1 && settled <= surely, "{settled} {surely}");
    assert_eq!(found["damped_certified"], true);

    // Linear and exact displacement agree for a small force; the history begins there and ends within the tolerance.
    let (linear, exact) = (size(&found["held_m"]), size(&found["held_exact_m"]));
    assert!((linear / exact - 1.0).abs() < 0.05, "{linear} {exact}");
    let history = found["history"].as_array().unwrap();
    let distance =
        |row: &serde_json::Value| ["x_m", "y_m", "z_m"].map(|key| number(&row[key]).powi(2)).iter().sum::<f64>().sqrt();
    assert!((distance(&history[0]) - linear).abs() <= number(&found["omitted_m"]) * 1.01 + 1e-12);
    assert!(distance(history.last().unwrap()) <= 1e-4);
    assert!(history.iter().all(|row| distance(row) <= number(&row["envelope_m"]) * (1.0 + 1e-9)));

    // The mode that lasts longest is at most as long as all together.
    let modes = found["modes"].as_array().unwrap();
    assert!(modes.iter().all(|mode| number(&mode["settled_s"]) <= surely * (1.0 + 1e-9)));

    let text = succeed(&[&SMALL[..], &["--tolerance-m", "1e-5"]].concat());
    assert!(text.contains("for good after") && text.contains("lasts longest"), "{text}");
    let (header, rows) = csv(&[&SMALL[..], &["--tolerance-m", "1e-5"]].concat());
    assert_eq!(header, ["t_s", "x_m", "y_m", "z_m", "envelope_m"]);
    assert!(rows.len() > 100);
}

/// Loss of the stretch makes a bounce on light rope end: the first question to the command.
#[test]
fn a_loss_factor_shortens_the_decay() {
    let file = std::fs::read_to_string(robot("cogiro.toml")).unwrap();
    let lossy = file.replace("[materials.wire-rope-4mm]", "[materials.wire-rope-4mm]\naxial_loss_factor = 0.02");
    assert_ne!(file, lossy);
    let line =
        ["settle", "-", "--pose", "0,0,1.5", "--release-n", "0,0,-50", "--below-hz", "8", "--tolerance-m", "1e-5"];
    let [without, with] = [file, lossy].map(|text| number(&json_of(&line, &text)["surely_settled_s"]));
    assert!(with < 0.2 * without, "{with} {without}");
}

#[test]
fn wrong_requests_are_refused_with_a_remedy() {
    for (more, expected) in [
        (&[][..], "nothing is released: give the force --release-n"),
        (&["--release-n", "0,0,0"], "nothing is released"),
        (&["--release-n", "0,0,-1", "--tolerance-m", "0"], "--tolerance-m"),
        (&["--release-n", "0,0,-1", "--tolerance-m", "nan"], "--tolerance-m"),
        (&["--release-n", "0,0,-1", "--cable-model", "shallow-dynamic"], "choose `catenary-dynamic`"),
    ] {
        let output = run(&[&["settle", "ROBOT"][..], more].concat());
        assert_eq!(output.status.code(), Some(2), "{more:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{more:?}: {}", stderr(&output));
    }

    // Nothing damps: valid, but there is no decay.
    let undamped = yuan().replace("damping_ratio = 0.003", "damping_ratio = 0.0");
    let output = run_with(&["settle", "-", "--release-n", "0,0,-1", "--below-hz", "3"], &undamped);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stderr(&output).contains("does not decay: give the ropes"), "{}", stderr(&output));
}

#[test]
fn a_release_that_is_not_small_is_warned_of() {
    let large = run(&["settle", "ROBOT", "--release-n", "0,0,-19.1", "--below-hz", "3"]);
    assert_eq!(large.status.code(), Some(0), "{}", stderr(&large));
    assert!(stderr(&large).contains("the release is not small: the linear displacement"), "{}", stderr(&large));
    let small = run(&SMALL);
    assert!(!stderr(&small).contains("the release is not small"), "{}", stderr(&small));
}
