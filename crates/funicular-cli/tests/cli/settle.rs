//! `settle`: decay after a release.

use super::{csv, json, json_of, number, numbers, robot, run, run_with, stderr, succeed, yuan};
use std::fmt::Write as _;

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
}

/// Nothing damps: the point never settles, unless it moves less than the tolerance.
#[test]
fn without_damping_the_answer_is_never() {
    let undamped = yuan().replace("damping_ratio = 0.003", "damping_ratio = 0.0");
    let line = ["settle", "-", "--release-n", "0,0,-1", "--below-hz", "3", "--tolerance-m"];
    let found = json_of(&[&line[..], &["1e-5"]].concat(), &undamped);
    let never = &found["never_settles"];
    let sum: f64 = found["modes"].as_array().unwrap().iter().map(|mode| number(&mode["amplitude_m"])).sum();
    assert!(
        (number(&never["amplitude_m"]) / sum - 1.0).abs() < 1e-9 && number(&never["frequency_hz"]) > 0.3,
        "{never}"
    );
    assert!(found["settled_s"].is_null() && found["surely_settled_s"].is_null());
    assert!(found["modes"].as_array().unwrap().iter().all(|mode| number(&mode["damping_ratio"]) == 0.0));

    let output = run_with(&[&line[..], &["1e-5"]].concat(), &undamped);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(text.contains("Never within") && text.contains("has no damping; give the ropes"), "{text}");

    let wide = json_of(&[&line[..], &["1"]].concat(), &undamped);
    assert!(number(&wide["settled_s"]) == 0.0 && wide["never_settles"].is_null(), "{wide}");
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
        (&["--release-n", "0,0,-1"][..], "give a release, a stop, a move or a trajectory, not several"),
        (&["--stop-m-s", "0,1,0"], "give a release, a stop, a move or a trajectory, not several"),
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

/// Lengths of the short move, at steps of 10 ms.
fn lengths_of_the_move(folder: &std::path::Path) -> String {
    let path = folder.join("lengths.csv").to_str().unwrap().to_owned();
    let output = run(&[&MOVE[..], &["--sample-time-s", "0.01", "--lengths", &path]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    path
}

fn largest_amplitude(of: &serde_json::Value) -> f64 {
    number(&of["modes"][0]["amplitude_m"])
}

/// The oracle is the move in closed form. Straight lines of h = 10 ms have `sin²(ωh/2)/(ωh/2)²` of the spectrum of the
/// move, which is 1 − ω²h²/12, or 1 − 6e-4 at 1.36 Hz.
#[test]
fn a_trajectory_of_the_lengths_of_a_move_has_the_motion_of_the_move() {
    let folder = tempfile::tempdir().unwrap();
    let path = lengths_of_the_move(folder.path());
    let line = ["settle", "ROBOT", "--below-hz", "3", "--trajectory", &path];
    let (moved, read) = (json(&with(&[])), json(&line));
    assert_eq!((&read["command"], &read["command_kind"]), (&"settle".into(), &"trajectory".into()));
    assert!((number(&read["duration_s"]) - number(&moved["duration_s"])).abs() < 1e-9);
    let (a, b) = (largest_amplitude(&moved), largest_amplitude(&read));
    assert!((b / a - 1.0).abs() < 1e-3, "{a} {b}");
    let lowest = |of: &serde_json::Value| number(&of["lowest_tension"]["tension_n"]);
    assert!((lowest(&read) / lowest(&moved) - 1.0).abs() < 1e-3, "{} {}", lowest(&read), lowest(&moved));

    // Poses give the same lengths: a straight line with the course of the move, of which the lengths are known.
    let rows = std::fs::read_to_string(&path).unwrap();
    let poses = folder.path().join("poses.csv");
    let profile = |t: f64| {
        // Rate of the boxes 1.2, 0.3 and 0.1 s, summed in small steps.
        let boxed = |t: f64, of: f64| (t / of).clamp(0.0, 1.0);
        let (fine, h) = (64_u32, 1.0 / 64.0);
        let nodes = || (0..fine).map(move |k| (f64::from(k) + 0.5) * h);
        nodes().map(|a| nodes().map(|b| boxed(t - 0.3 * a - 0.1 * b, 1.2)).sum::<f64>()).sum::<f64>() * h * h
    };
    let rest = json(&["statics", "ROBOT"]);
    let [place, angles] = ["position_m", "roll_pitch_yaw_deg"].map(|key| numbers(&rest["pose"][key]));
    let mut text = "t_s,x_m,y_m,z_m,roll_deg,pitch_deg,yaw_deg\n".to_owned();
    for line in rows.lines().skip(1) {
        let t: f64 = line.split(',').next().unwrap().parse().unwrap();
        let y = place[1] - 0.02 * (1.0 - profile(t));
        writeln!(text, "{t},{},{y},{},{},{},{}", place[0], place[2], angles[0], angles[1], angles[2]).unwrap();
    }
    std::fs::write(&poses, text).unwrap();
    let by_poses = json(&["settle", "ROBOT", "--below-hz", "3", "--trajectory", poses.to_str().unwrap()]);
    let c = largest_amplitude(&by_poses);
    assert!((c / b - 1.0).abs() < 1e-3, "{b} {c}");
}

/// The shaper of the table cancels the modes of the move. It acts on the lengths, and a mean of lengths has not quite
/// the mean pose: the square of 20 mm over 2 m is left.
#[test]
fn a_shaper_makes_a_trajectory_quiet() {
    let folder = tempfile::tempdir().unwrap();
    let path = lengths_of_the_move(folder.path());
    let more = ["--shaper", "zv", "--shape-modes-hz", "1.0207,1.3571", "--tolerance-m", "1e-4"];
    let shaped = json(&[&["settle", "ROBOT", "--below-hz", "3", "--trajectory", &path][..], &more].concat());
    for mode in &shaped["modes"].as_array().unwrap()[..2] {
        assert!(number(&mode["amplitude_m"]) < 1e-4 * number(&mode["amplitude_without_m"]), "{mode}");
    }
}

#[test]
fn a_trajectory_that_is_none_is_refused_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("way.csv");
    let good = std::fs::read_to_string(lengths_of_the_move(folder.path())).unwrap();
    let header = good.lines().next().unwrap();
    let row = |t: &str, more: &str| format!("{t},{}{more}\n", good.lines().nth(1).unwrap().split_once(',').unwrap().1);
    let poses = "t_s,x_m,y_m,z_m\n0,0,0,0.5\n1,0,0,0.51\n";
    for (text, expected) in [
        (format!("{header}\n{}", row("0", "")), "there are 1 rows: give at least two"),
        (format!("{header}\n{}\n{}", row("0", ""), row("0", "")), "line 4: the time 0 s is not after the one before"),
        (format!("{header}\n{}{}", row("1", ""), row("0.5", "")), "line 3: the time 0.5 s is not after"),
        (format!("{header}\n{}{}", row("0", ""), row("nan", "")), "line 3, column `t_s`"),
        (format!("{header}\n{}{}", row("0", ""), row("1", ",3")), "line 3: 8 values, but 7 in the header"),
        (good.replace("unstrained_length_2_m", "unstrained_length_9_m"), "a column `unstrained_length_9_m`"),
        (good.replace("t_s,", "time,"), "there is a column `time`"),
        (poses.replace(",z_m", ",yaw_deg"), "there is no column `z_m`"),
        (poses.replace("x_m", "unstrained_length_1_m"), "columns of poses and of lengths"),
        (poses.replace("0.51", "1e300"), "line 3, column `z_m`"),
        (
            header.replace(",unstrained_length_2_m", "") + "\n0,1,1,1,1,1\n1,1,1,1,1,1\n",
            "no column `unstrained_length_2_m`",
        ),
        (format!("{header}\n0,1,1,1,1,1,1\n1,1,1,-1,1,1,1\n"), "line 3: `unstrained_length_3_m`"),
    ] {
        std::fs::write(&path, &text).unwrap();
        let output = run(&["settle", "ROBOT", "--trajectory", path.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(2), "{text}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{text}: {}", stderr(&output));
    }

    // Another end than the rest, another option of a command, and another command.
    std::fs::write(&path, poses).unwrap();
    for (more, expected) in [
        (&["--pose", "0,0,0.5"][..], "at rest it is"),
        (&["--profile-s", "1"], "is used by a stop or a move"),
        (&["--stop-m-s", "0,1,0"], "not several"),
    ] {
        let output = run(&[&["settle", "ROBOT", "--trajectory", path.to_str().unwrap()], more].concat());
        assert_eq!(output.status.code(), Some(2), "{more:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{more:?}: {}", stderr(&output));
    }
}

/// The figure and the lengths of one run.
#[test]
fn a_figure_and_the_lengths_are_written_together() {
    let folder = tempfile::tempdir().unwrap();
    let [figure, lengths] = ["x.svg", "x.csv"].map(|name| folder.path().join(name).to_str().unwrap().to_owned());
    let output = run(&[&MOVE[..], &["--sample-time-s", "0.1", "--lengths", &lengths, "-o", &figure]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(std::fs::read_to_string(figure).unwrap().contains("end of the command"));
    assert!(std::fs::read_to_string(lengths).unwrap().starts_with("t_s,"));
}

/// The motion while the command runs begins at rest and goes on into the motion after it.
#[test]
fn the_history_holds_the_motion_during_the_command() {
    let found = json(&with(&[]));
    let during = found["during"].as_array().unwrap();
    let place = |row: &serde_json::Value| ["x_m", "y_m", "z_m"].map(|key| number(&row[key]));
    assert!((number(&during[0]["t_s"]) + number(&found["duration_s"])).abs() < 1e-12);
    assert!(place(&during[0]).iter().all(|part| *part == 0.0), "{:?}", during[0]);
    let most = during.iter().map(|row| place(row)[1].abs()).fold(0.0, f64::max);
    let (before, after) = (place(during.last().unwrap()), place(&found["history"][0]));
    let next = place(&found["history"][1]);
    for k in 0..3 {
        assert!((after[k] - before[k]).abs() <= 2.0 * (next[k] - after[k]).abs() + 0.05 * most, "{before:?} {after:?}");
    }
    let (header, rows) = csv(&with(&[]));
    assert_eq!(header, ["t_s", "x_m", "y_m", "z_m", "envelope_m"]);
    assert!(rows[0][4].is_empty() && rows[0][0].starts_with('-'), "{:?}", rows[0]);
}

/// Oracle of a payload: the robot with its mass, at rest with the commanded lengths.
#[test]
fn payloads_have_the_vibration_of_the_robot_that_carries_them() {
    let found = json(&with(&["--robust-payload-kg", "0,1"]));
    let payloads = found["payloads"].as_array().unwrap();
    let sum = |of: &serde_json::Value| -> f64 {
        of["modes"].as_array().unwrap().iter().map(|mode| number(&mode["amplitude_m"])).sum()
    };
    assert!((number(&payloads[0]["amplitude_m"]) / sum(&found) - 1.0).abs() < 1e-6, "{payloads:?}");

    // The centre of mass of this platform does not change, and its inertia only by the rounding of a mass without
    // extent.
    let folder = tempfile::tempdir().unwrap();
    let path = lengths_of_the_move(folder.path());
    let mass = number(
        &json(&["parameters", "ROBOT"])["parameters"]
            .as_array()
            .unwrap()
            .iter()
            .find(|row| row["path"] == "platform.mass_kg")
            .unwrap()["value"],
    ) + 1.0;
    let heavier = json(&["settle", "ROBOT", "--below-hz", "3", "--trajectory", &path, "--mass-kg", &mass.to_string()]);
    assert!((number(&payloads[1]["amplitude_m"]) / sum(&heavier) - 1.0).abs() < 0.05, "{payloads:?}");
    assert!((number(&payloads[1]["frequency_hz"]) / number(&heavier["modes"][0]["frequency_hz"]) - 1.0).abs() < 1e-6);
}

#[test]
fn a_page_shows_the_decay_and_the_lengths() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("decay.html").display().to_string();
    let cogiro = robot("cogiro.toml");
    let line =
        ["settle", &cogiro, "--pose", "1,1,1.5", "--move-m", "0,0.05,0", "--profile-s", "1,0.3", "--below-hz", "6"];
    succeed(&[&line[..], &["--sample-time-s", "0.05", "-o", &page]].concat());
    let text = std::fs::read_to_string(&page).unwrap();
    for part in ["decay after a move", "figure-decay-plot", "figure-lengths-plot", "table-modes", "--move-m"] {
        assert!(text.contains(part), "{part}");
    }
}

/// Symmetric robots have motions that share a frequency with each other and with cables that vibrate alone: every robot
/// of the library and every new one has an answer after a release and after a stop, also with ropes without mass.
#[test]
fn every_robot_has_an_answer() {
    let [release, stop] = [["--release-n", "0,0,-1"], ["--stop-m-s", "0.01,0,0"]];
    let answered = |name: &str, text: &str, command: &[&str]| {
        let found = json_of(&[&["settle", "-"], command].concat(), text);
        assert_eq!(found["settled_s"].is_null(), !found["never_settles"].is_null(), "{name} {command:?}");
        if found["never_settles"].is_null() {
            assert!(number(&found["settled_s"]) <= number(&found["surely_settled_s"]), "{name} {command:?}");
        }
        assert!(number(&found["lowest_tension"]["tension_n"]) > 0.0, "{name} {command:?}");
    };
    for (name, text) in funicular_robots::ALL {
        answered(name, text, &release);
        answered(name, text, &stop);
    }
    let rigid = [2, 3, 4, 5, 6, 7, 8, 9].map(|count| format!("--cables {count}"));
    let others = ["--motion point-mass", "--motion planar-xz", "--motion planar-xz --cables 12"].map(str::to_owned);
    for more in rigid.iter().chain(&others) {
        let file = succeed(&[&["new"][..], &more.split(' ').collect::<Vec<_>>()].concat());
        answered(more, &file, &release);
        answered(more, &file, &stop);
    }

    // Limits at which cables of these two vibrate alone at a frequency of the platform.
    let [kntu, stadium] = ["kntu-planar.toml", "stadium-camera.toml"].map(robot);
    for (robot, force, limit) in [(&kntu, "20,0,0", "50"), (&kntu, "20,0,0", "80"), (&stadium, "0,0,-20", "4")] {
        let found = json(&["settle", robot, "--release-n", force, "--below-hz", limit]);
        assert!(number(&found["lowest_tension"]["tension_n"]) > 0.0, "{robot} {limit}");
    }
}

/// A stop says what the modes above the limit may add, and never that it has settled "after 0 s" of no modes.
#[test]
fn a_stop_states_its_bounds() {
    let stop = ["settle", "-", "--pose", "0,0,1.5", "--stop-m-s", "0.2,0,0"];
    let cogiro = std::fs::read_to_string(robot("cogiro.toml")).unwrap();
    let output = run_with(&[&stop[..], &["--below-hz", "5.5"]].concat(), &cogiro);
    assert!(output.status.success(), "{}", stderr(&output));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(text.contains("All modes above the limit together move the point by at most"), "{text}");
    assert!(stderr(&output).contains("the modes above 5.5 Hz may"), "{}", stderr(&output));

    // The limit that the program chooses leaves little.
    let found = json_of(&stop, &cogiro);
    assert!(number(&found["omitted_m"]) < number(&found["tolerance_m"]), "{found}");

    let none = run_with(&[&stop[..], &["--below-hz", "0.1"]].concat(), &cogiro);
    assert_eq!(none.status.code(), Some(2));
    assert!(stderr(&none).contains("no mode in which the platform moves lies below 0.1 Hz"), "{}", stderr(&none));
}

/// Ropes without mass have commanded lengths like all others: the answer is that of ropes with a little mass.
#[test]
fn commands_of_massless_ropes_are_those_of_light_ones() {
    for name in ["grab-2-cables.toml", "grab-3-cables.toml", "grab-4-cables.toml"] {
        let path = robot(name);
        let stop = ["settle", &path, "--stop-m-s", "0.01,0,0"];
        let massless = json(&stop);
        let light = json(&[&stop[..], &["--set", "materials.rope.mass_kg_per_m=1e-7"]].concat());
        let largest = |found: &serde_json::Value| {
            let modes = found["modes"].as_array().unwrap();
            modes.iter().map(|mode| number(&mode["amplitude_m"])).fold(0.0, f64::max)
        };
        let (one, other) = (largest(&massless), largest(&light));
        assert!(one > 0.0 && (one / other - 1.0).abs() < 1e-3, "{name}: {one} {other}");
        let says = massless["warnings"].to_string();
        assert!(!says.contains("axial stiffness over mass per length"), "{says}");
    }
}
