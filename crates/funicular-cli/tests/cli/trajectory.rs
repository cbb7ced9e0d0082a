//! `trajectory`: paths, limits, the fastest motion, files, and faults.

use super::{csv, json, number, numbers, robot, run, stderr, stdout, succeed};
use std::fs;

const COURSE: [&str; 6] = ["--speed-m-s", "2", "--acceleration-m-s2", "2", "--jerk-m-s3", "20"];
const MOVE: [&str; 4] = ["--pose", "0,0,1.5", "--move-to", "4,2,1.5"];

fn moved(more: &[&str]) -> serde_json::Value {
    json(&[&["trajectory", &robot("cogiro.toml")], &MOVE[..], &COURSE, more].concat())
}

#[test]
fn a_move_starts_and_ends_at_rest_with_the_lengths_of_its_poses() {
    let found = moved(&[]);
    // √20 m at 2 m/s, 1 s to get to it, 0.1 s to get to the acceleration.
    assert!((number(&found["duration_s"]) - (20.0_f64.sqrt() / 2.0 + 1.1)).abs() < 1e-12);
    assert_eq!(found["within_limits"], true);

    let rows = found["rows"].as_array().unwrap();
    for (row, pose) in [(&rows[0], "0,0,1.5"), (&rows[rows.len() - 1], "4,2,1.5")] {
        let rest = json(&["statics", &robot("cogiro.toml"), "--pose", pose]);
        let cables = rest["cables"].as_array().unwrap();
        for (cable, length) in cables.iter().zip(numbers(&row["unstrained_lengths_m"])) {
            assert!((number(&cable["unstrained_length_m"]) - length).abs() < 1e-9);
        }
    }

    // The lengths are the integral of their rates.
    for k in 1..rows.len() {
        let step = number(&rows[k]["t_s"]) - number(&rows[k - 1]["t_s"]);
        let at = |row: usize, key: &str| numbers(&rows[row][key]);
        let (rates, before) = (at(k, "length_rates_m_s"), at(k - 1, "length_rates_m_s"));
        for (i, rate) in rates.iter().enumerate() {
            let way = at(k, "unstrained_lengths_m")[i] - at(k - 1, "unstrained_lengths_m")[i];
            assert!((way - 0.5 * step * (rate + before[i])).abs() < 3e-4, "{k} {i}");
        }
    }
}

#[test]
fn the_fastest_motion_uses_all_of_a_limit_and_a_faster_one_breaks_it() {
    let limit = ["--max-tension-n", "700"];
    let fastest = moved(&[&["--fastest"], &limit[..]].concat());
    let duration = number(&fastest["duration_s"]);
    let part = number(&fastest["most_used"]["part"]);
    assert_eq!((&fastest["most_used"]["limit"], &fastest["within_limits"]), (&"maximum-tension".into(), &true.into()));
    // The worst time lies between two rows.
    assert!((0.99..=1.0).contains(&part), "{part}");

    let (cogiro, faster) = (robot("cogiro.toml"), (0.99 * duration).to_string());
    let line = [&["trajectory", &cogiro], &MOVE[..], &COURSE, &limit, &["--duration-s", &faster]].concat();
    assert_eq!(run(&line).status.code(), Some(1));

    let free = run(&[
        &["trajectory", &robot("yuan2014-4mm.toml")],
        &["--pose", "0,0,0.5", "--move-to", "0.1,0,0.5"][..],
        &COURSE,
        &["--fastest"],
    ]
    .concat());
    assert_eq!(free.status.code(), Some(1), "{}", stderr(&free));
    assert!(stderr(&free).contains("--fastest") || stderr(&free).contains("nothing limits"), "{}", stderr(&free));
}

#[test]
fn winches_and_their_limits_are_in_the_result() {
    let set = ["--set", "winches.drum.max_speed_m_s=1.5", "--set", "winches.drum.gear_efficiency=0.8"];
    let winches = robot("cogiro-winches.toml");
    let line = [&["trajectory", &winches], &MOVE[..], &COURSE, &set].concat();
    let found = json(&line);
    assert_eq!((&found["within_limits"], &found["most_used"]["limit"]), (&false.into(), &"speed".into()));
    let row = &found["rows"].as_array().unwrap()[100];
    let powers = numbers(&row["motor_powers_w"]);
    let (speeds, torques) = (numbers(&row["cable_speeds_m_s"]), numbers(&row["motor_torques_n_m"]));
    for ((power, speed), torque) in powers.iter().zip(&speeds).zip(&torques) {
        // Torque times the angular velocity of the motor, three turns per turn of a drum of 67.5 mm.
        assert!((power + torque * speed * 3.0 / 0.0675).abs() < 1e-9 * power.abs().max(1.0));
    }
    let sum: f64 = powers.iter().map(|power| power.max(0.0)).sum();
    assert!(number(&found["sums"]["driving_power_w"]) >= sum);
}

#[test]
fn a_table_lengths_for_settle_and_a_page() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let [path, lengths, page] = [at("a path.csv"), at("lengths.csv"), at("motion.html")];
    let row = |k: u32| {
        let t = f64::from(k) / 20.0;
        let s = t * t * t * (10.0 - t * (15.0 - 6.0 * t));
        format!("{},{},{},1.5,{}\n", 3.0 + 2.0 * t, 0.5 * s, -0.2 * s, 5.0 * s)
    };
    fs::write(&path, format!("t_s,x_m,y_m,z_m,yaw_deg\n{}", (0..=20).map(row).collect::<String>())).unwrap();

    let cogiro = robot("cogiro.toml");
    let (header, rows) = csv(&["trajectory", &cogiro, "--path", &path, "--lengths", &lengths]);
    assert_eq!(rows.len(), 21);
    assert!(header.contains(&"length_rate_8_m_s".to_owned()) && header.contains(&"first_frequency_hz".to_owned()));
    let settled = json(&["settle", &cogiro, "--trajectory", &lengths, "--below-hz", "5"]);
    assert!((number(&settled["duration_s"]) - 2.0).abs() < 1e-12);

    succeed(&["trajectory", &cogiro, "--path", &path, "-o", &page]);
    let text = fs::read_to_string(&page).unwrap();
    assert!(text.contains("motion-frames") && text.contains("figure-tensions"));

    // Half the duration: the same poses, twice the rates.
    let [slow, fast] =
        ["2", "1"].map(|duration| json(&["trajectory", &cogiro, "--path", &path, "--duration-s", duration]));
    let rate = |of: &serde_json::Value| number(&of["rows"][10]["velocity_m_s"][0]);
    assert!((rate(&fast) - 2.0 * rate(&slow)).abs() < 1e-9);
}

#[test]
fn faults_are_named_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let cogiro = robot("cogiro.toml");
    let fault = |text: &str| {
        let path = folder.path().join("path.csv");
        fs::write(&path, text).unwrap();
        let output = run(&["trajectory", &cogiro, "--path", &path.display().to_string()]);
        assert_eq!((output.status.code(), stdout(&output)), (Some(2), ""));
        stderr(&output).to_owned()
    };
    for (text, parts) in [
        ("t_s,x_m,y_m,z_m\n0,0,0,1.5\n1,0,0,1.6\n1,0,0,1.7\n", ["line 4", "not after"]),
        ("t_s,x_m,y_m,z_m,yaw_deg\n0,0,0,1.5,0\n1,0,0,1.5,270\n", ["line 3", "half a turn"]),
        ("t_s,x_m,y_m,z_m,yaw_deg\n0,0,0,1.5,0\n1,0,0,1.5,175\n", ["line 3", "175"]),
        ("t_s,x_m,y_m,zm\n0,0,0,1.5\n1,0,0,1.5\n", ["`zm`", "z_m"]),
        ("t_s,x_m,y_m,z_m\n0,0,0,1.5\n", ["path.csv", "at least two"]),
    ] {
        let error = fault(text);
        assert!(parts.iter().all(|part| error.contains(part)), "{error}");
    }

    for (more, part) in [
        (&["--move-to", "1,0,1.5"][..], "--speed-m-s"),
        (&["--move-to", "1,0,1.5", "--speed-m-s", "0"], "0"),
        (&[], "--move-to"),
        (&["--move-to", "1,0,1.5", "--circle-center-m", "0,0,1"], "--circle-center-m"),
        (&["--move-to", "1,0,1.5", "--blend", "2", "--speed-m-s", "1", "--acceleration-m-s2", "1"], "--blend"),
        (&["--move-to", "0,0,1.5", "--speed-m-s", "1", "--acceleration-m-s2", "1"], "same"),
        (&["--circle-center-m", "0,0,1", "--speed-m-s", "1", "--acceleration-m-s2", "1"], "axis"),
        (
            &["--move-to", "1,0,1.5", "--speed-m-s", "1", "--acceleration-m-s2", "1", "--sample-time-s", "1e-7"],
            "--sample-time-s",
        ),
    ] {
        let output = run(&[&["trajectory", &cogiro, "--pose", "0,0,1.5"], more].concat());
        assert_eq!(output.status.code(), Some(2), "{more:?} {}", stderr(&output));
        assert!(stderr(&output).contains(part), "{more:?} {}", stderr(&output));
    }

    // A pose that the cables do not hold is no fault of the request.
    let output = run(&[&["trajectory", &cogiro, "--pose", "0,0,1.5", "--move-to", "9,0,1.5"], &COURSE[..]].concat());
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("after the start of the path"), "{}", stderr(&output));
}
