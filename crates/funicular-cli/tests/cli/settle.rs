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

/// Short move of the robot of Yuan 2014, whose sag swings for minutes.
const MOVE: [&str; 8] = ["settle", "ROBOT", "--move-m", "0,0.02,0", "--below-hz", "3", "--profile-s", "1.2,0.3,0.1"];

fn with(more: &[&'static str]) -> Vec<&'static str> {
    [&MOVE[..], more].concat()
}

#[test]
fn a_shaper_makes_a_move_quiet() {
    let plain = json(&with(&["--tolerance-m", "1e-4"]));
    let shaped = json(&with(&["--tolerance-m", "1e-4", "--shaper", "zv", "--shape-modes-hz", "1.0207,1.3571"]));
    let settled = |of: &serde_json::Value| number(&of["settled_s"]);
    assert!(settled(&shaped) < 0.1 * settled(&plain), "{} {}", settled(&shaped), settled(&plain));

    // The command is longer by half a period of each mode; its two modes are silent, and what it says of the plain one
    // holds.
    let shaping = &shaped["shaping"];
    let longer = number(&shaping["longer_s"]);
    assert!((longer - 0.5 / 1.0207 - 0.5 / 1.3571).abs() < 1e-3, "{longer}");
    assert!((number(&shaped["duration_s"]) - number(&plain["duration_s"]) - longer).abs() < 1e-12);
    assert!((number(&shaping["settled_without_s"]) - settled(&plain)).abs() < 1e-9);
    for mode in &shaped["modes"].as_array().unwrap()[..2] {
        assert!(number(&mode["amplitude_m"]) < 1e-6 * number(&mode["amplitude_without_m"]), "{mode}");
    }
    let parts: f64 = shaping["impulses"].as_array().unwrap().iter().map(|impulse| number(&impulse["part"])).sum();
    assert!((parts - 1.0).abs() < 1e-12, "{parts}");

    // Frequencies a tenth off are worse than none off, and better than no shaper.
    let sums: Vec<f64> =
        shaping["robustness"].as_array().unwrap().iter().map(|row| number(&row["amplitude_m"])).collect();
    let without = number(&shaping["robustness"][1]["without_m"]);
    assert!(
        sums[1] < sums[0] && sums[1] < sums[2] && sums.iter().all(|sum| *sum < 0.5 * without),
        "{sums:?} {without}"
    );

    let text = succeed(&with(&["--shaper", "zvd"]));
    assert!(text.contains("decay after a move") && text.contains("Shaper zvd"), "{text}");
}

/// The lengths of a stop begin with the speed of inverse statics, end at rest at the lengths of the pose, and are
/// smooth.
#[test]
fn the_commanded_lengths_begin_at_speed_and_end_at_rest() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lengths.csv");
    let line =
        ["settle", "ROBOT", "--pose", "0,0,0.5", "--stop-m-s", "0,0.1,0", "--profile-s", "0.5,0.1", "--below-hz", "3"];
    let output = run(&[&line[..], &["--sample-time-s", "0.01", "--lengths", path.to_str().unwrap()]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = std::fs::read_to_string(&path).unwrap();
    let mut lines = text.lines();
    assert!(lines.next().unwrap().starts_with("t_s,unstrained_length_1_m,unstrained_length_2_m"));
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|number| number.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len(), 61);
    let of = |pose: &str| -> f64 {
        let found = json(&["statics", "ROBOT", "--pose", pose]);
        number(&found["cables"][0]["unstrained_length_m"])
    };
    assert!((rows[60][1] - of("0,0,0.5")).abs() < 1e-9);
    // The way of a stop from 0.1 m/s is half its 0.6 s.
    assert!((rows[0][1] - of("0,-0.03,0.5")).abs() < 1e-9);
    let speed = (of("0,-0.029,0.5") - of("0,-0.031,0.5")) / 0.02;
    let first = (rows[1][1] - rows[0][1]) / 0.01;
    assert!((first / speed - 1.0).abs() < 0.01, "{first} {speed}");
    assert!((rows[60][1] - rows[59][1]).abs() < 1e-3 * (rows[1][1] - rows[0][1]).abs() * 10.0);
}

#[test]
fn commands_that_make_no_sense_are_refused() {
    for (more, expected) in [
        (&["--release-n", "0,0,-1"][..], "give a release, a stop or a move, not several"),
        (&["--stop-m-s", "0,1,0"], "give a release, a stop or a move, not several"),
        (&["--profile-s", "0"], "a move takes time"),
        (&["--profile-s", "0.3,1.2"], "longer than the one before"),
        (&["--profile-s=-1"], "--profile-s"),
        (&["--profile-s", "4,3,2,1"], "at most three"),
        (&["--shaper", "zw"], "is no shaper: give zv"),
        (&["--shaper", "ei:2"], "give a fraction between 0 and 1"),
        (&["--shape-modes-hz", "1"], "needs a shaper"),
        (&["--shaper", "zv", "--shape-modes-hz", "100"], "the nearest is at"),
        (&["--lengths", "x.csv"], "--sample-time-s"),
        (&["--sample-time-s", "1e-9"], "samples of the lengths"),
        (&["--cable-model", "spring"], "has no length that is commanded"),
    ] {
        let mut line = with(&[]);
        if more[0].starts_with("--profile-s") {
            line.truncate(6);
        }
        let output = run(&[&line[..], more].concat());
        assert_eq!(output.status.code(), Some(2), "{more:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{more:?}: {}", stderr(&output));
    }
    for (line, expected) in [
        (&["settle", "ROBOT", "--stop-m-s", "0,0,0"][..], "nothing stops"),
        (&["settle", "ROBOT", "--move-m", "0,0,0", "--profile-s", "1"], "nothing moves"),
        (&["settle", "ROBOT", "--release-n", "0,0,-1", "--shaper", "zv"], "not by a release"),
    ] {
        let output = run(line);
        assert_eq!(output.status.code(), Some(2), "{line:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{line:?}: {}", stderr(&output));
    }
}

#[test]
fn a_cable_that_would_be_slack_ends_the_linear_motion() {
    let output = run(&["settle", "ROBOT", "--stop-m-s", "0,3,0", "--below-hz", "6"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("becomes slack") && stderr(&output).contains("simulation in time"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn a_release_that_is_not_small_is_warned_of() {
    let large = run(&["settle", "ROBOT", "--release-n", "0,0,-19.1", "--below-hz", "3"]);
    assert_eq!(large.status.code(), Some(0), "{}", stderr(&large));
    assert!(stderr(&large).contains("the release is not small: the linear displacement"), "{}", stderr(&large));
    let small = run(&SMALL);
    assert!(!stderr(&small).contains("the release is not small"), "{}", stderr(&small));
}
