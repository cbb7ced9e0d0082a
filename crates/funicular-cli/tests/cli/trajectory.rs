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
    // √20 m at 2 m/s, 1 s to get to it, 0.1 s to get to the acceleration, 0.1 s to get to the jerk.
    assert!((number(&found["duration_s"]) - (20.0_f64.sqrt() / 2.0 + 1.2)).abs() < 1e-12);
    let jerk_limited = moved(&["--course", "jerk-limited"]);
    assert!((number(&jerk_limited["duration_s"]) - (20.0_f64.sqrt() / 2.0 + 1.1)).abs() < 1e-12);
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
    let used = fastest["used"].as_array().unwrap();
    let part = number(&used.iter().find(|of| of["limit"] == "maximum-tension").unwrap()["part"]);
    assert_eq!(fastest["within_limits"], true);
    // The duration is found to 1e-4.
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

/// Value of an extreme, and the reason why it has no bound.
fn extreme(found: &serde_json::Value, what: &str) -> (Option<f64>, Option<String>) {
    let all = found["extremes"].as_array().unwrap();
    let of = all.iter().find(|of| of["what"] == what).unwrap();
    (of["value"].as_f64(), of["no_bound"].as_str().map(str::to_owned))
}

#[test]
fn what_is_largest_does_not_depend_on_the_rows() {
    // A minimum that some cables reach on the way, where the rates jump.
    for (more, jumps) in [
        (&[][..], false),
        (&["--course", "septic"], false),
        (&["--course", "jerk-limited"], true),
        (&["--min-tension-n", "180"], true),
    ] {
        let of = |step: &str| moved(&[more, &["--sample-time-s", step]].concat());
        let (speed, no_bound) = extreme(&of("0.04"), "largest speed");
        assert_eq!(no_bound, None);
        let (acceleration, no_bound) = extreme(&of("0.04"), "largest acceleration");
        assert_eq!(no_bound.is_some(), jumps, "{more:?} {no_bound:?}");
        for step in ["0.01", "0.002", "0.001"] {
            let found = of(step);
            let near = |finer: Option<f64>, coarse: Option<f64>| match (finer, coarse) {
                (Some(finer), Some(coarse)) => (finer - coarse).abs() < 0.01 * coarse,
                // Beside limits of tensions no acceleration is told.
                (None, None) => more.contains(&"--min-tension-n"),
                _ => false,
            };
            let (finer, _) = extreme(&found, "largest speed");
            assert!(near(finer, speed), "{more:?} {step}: {finer:?} {speed:?}");
            let (finer, _) = extreme(&found, "largest acceleration");
            assert!(near(finer, acceleration), "{more:?} {step}: {finer:?} {acceleration:?}");

            // No row has more, and no difference of two rows.
            let rows = found["rows"].as_array().unwrap();
            let speed = speed.unwrap();
            for pair in rows.windows(2) {
                let [before, after] = [0, 1].map(|k| numbers(&pair[k]["unstrained_lengths_m"]));
                let time = number(&pair[1]["t_s"]) - number(&pair[0]["t_s"]);
                for (before, after) in before.iter().zip(&after) {
                    assert!((after - before).abs() < 1.01 * speed * time + 1e-9, "{more:?} {step} {}", pair[0]["t_s"]);
                }
            }
        }
    }
}

#[test]
fn a_jump_of_the_jerk_is_told_and_is_beyond_a_limit_of_acceleration() {
    let winches = robot("cogiro-winches.toml");
    let set = ["--set", "winches.drum.max_acceleration_m_s2=50", "--set", "winches.drum.max_speed_m_s=5"];
    let line = [&["trajectory", &winches], &MOVE[..], &COURSE, &set].concat();
    let smooth = json(&line);
    assert_eq!(smooth["within_limits"], true, "{}", smooth["most_used"]);
    assert_eq!(smooth["path_jumps"].as_array().unwrap().len(), 0);

    let jumping = [&line[..], &["--course", "jerk-limited"]].concat();
    let found = json(&jumping);
    assert_eq!((&found["within_limits"], &found["most_used"]["limit"]), (&false.into(), &"acceleration".into()));
    assert_eq!((found["most_used"].get("part"), &found["path_jumps"][0]["of"]), (None, &"jerk".into()));
    assert_eq!(found["path_jumps"].as_array().unwrap().len(), 8);
    let text = run(&jumping);
    let text = stdout(&text);
    assert!(text.contains("no bound, because the jerk of the platform jumps"), "{text}");
    assert!(text.contains("which has no bound"), "{text}");

    // Without a limit of the jerk lengths jump.
    let steps = [&["trajectory", &winches], &MOVE[..], &COURSE[..4], &set].concat();
    let found = json(&steps);
    let (_, no_bound) = extreme(&found, "largest speed");
    assert!(no_bound.unwrap().contains("acceleration of the platform jumps"));
    assert_eq!(found["within_limits"], false);
}

#[test]
fn used_parts_of_tensions_are_those_of_the_tensions() {
    let found = moved(&["--min-tension-n", "150", "--max-tension-n", "900"]);
    let used = found["used"].as_array().unwrap();
    let part = |limit: &str| number(&used.iter().find(|of| of["limit"] == limit).unwrap()["part"]);
    let (largest, lowest) =
        (extreme(&found, "largest tension").0.unwrap(), extreme(&found, "lowest tension").0.unwrap());
    assert!((part("maximum-tension") - largest / 900.0).abs() < 1e-9);
    // The lowest tension of a cable may lie between its ends.
    assert!(part("minimum-tension") >= 150.0 / lowest - 1e-9 && part("minimum-tension") < 1.02 * 150.0 / lowest);
    assert_eq!(found["most_used"]["part"], used[0]["part"]);
    assert!(number(&found["inertia_factor"]) > 1.0);

    // A cable that the rule holds at its minimum uses all of it, and is not beyond it.
    let found = moved(&["--min-tension-n", "180"]);
    assert_eq!((&found["used"][0]["limit"], &found["used"][0]["part"]), (&"minimum-tension".into(), &1.0.into()));
    assert_eq!((&found["used"][1]["limit"], &found["within_limits"]), (&"maximum-tension".into(), &true.into()));
}

#[test]
fn steps_of_the_rows_are_exact_and_the_last_is_shorter() {
    let found = moved(&["--sample-time-s", "0.002"]);
    let times: Vec<f64> = found["rows"].as_array().unwrap().iter().map(|row| number(&row["t_s"])).collect();
    let last = times.len() - 1;
    assert!(times[..last].iter().enumerate().all(|(k, time)| (time - 0.002 * k as f64).abs() < 1e-14));
    assert!(times[last].total_cmp(&number(&found["duration_s"])).is_eq());
    assert!((1e-9..=0.002).contains(&(times[last] - times[last - 1])));

    let cogiro = robot("cogiro.toml");
    let settled = json(
        &[
            &["settle", &cogiro, "--pose", "0,0,1.5", "--move-m", "0.1,0,0", "--below-hz", "5"][..],
            &["--profile-s", "0.5,0.24,0.103", "--sample-time-s", "0.007"],
        ]
        .concat(),
    );
    let times: Vec<f64> = settled["lengths"].as_array().unwrap().iter().map(|row| number(&row["t_s"])).collect();
    let last = times.len() - 1;
    assert!((0..last).all(|k| (times[k] - 0.007 * k as f64).abs() < 1e-12));
    assert!((times[last] - number(&settled["duration_s"])).abs() < 1e-12);
}

#[test]
fn rounded_rows_are_named_and_smoothed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("path.csv").display().to_string();
    let cogiro = robot("cogiro.toml");
    let write = |step: f64, digits: usize| {
        let row = |k: usize| {
            let t = step * k as f64;
            let s = t / 3.0 - (std::f64::consts::TAU * t / 3.0).sin() / std::f64::consts::TAU;
            format!("{t:.4},{:.digits$},{:.digits$},{:.digits$}\n", -1.0 + 2.0 * s, 0.3 * s, 1.5 + 0.2 * s)
        };
        let count = (3.0 / step).round() as usize;
        fs::write(&path, format!("t_s,x_m,y_m,z_m\n{}", (0..=count).map(row).collect::<String>())).unwrap();
    };
    let line = |more: &[&str]| {
        [&["trajectory", &cogiro, "--path", &path], more].concat().iter().map(|x| (*x).to_owned()).collect::<Vec<_>>()
    };
    let tension = |more: &[&str]| {
        let line = line(more);
        let line: Vec<&str> = line.iter().map(String::as_str).collect();
        (extreme(&json(&line), "largest tension").0.unwrap(), stderr(&run(&line)).to_owned())
    };

    write(0.01, 9);
    let (exact, warnings) = tension(&[]);
    assert!(!warnings.contains("rounded"), "{warnings}");
    write(0.1, 3);
    let (coarse, warnings) = tension(&[]);
    assert!(!warnings.contains("rounded") && (coarse - exact).abs() < 0.02 * exact, "{warnings} {coarse} {exact}");

    write(0.01, 4);
    let (rounded, warnings) = tension(&[]);
    for part in ["rounded to 0.0001 m every 0.01 s", "= 4.0 m/s²", "at rows ", "--row-tolerance-m 5.0e-5"] {
        assert!(warnings.contains(part), "{part}: {warnings}");
    }
    // At the ends, where this motion needs most, rows have neighbours on one side alone.
    let (smooth, warnings) = tension(&["--row-tolerance-m", "0.00005"]);
    assert!(
        (smooth - exact).abs() < 0.01 * exact && (rounded - exact).abs() > 0.2 * exact,
        "{smooth} {rounded} {exact}"
    );
    assert!(!warnings.contains("rounded"), "{warnings}");

    // Rows every 10 ms in millimetres ask for accelerations that no cables give.
    write(0.01, 3);
    let owned = line(&[]);
    let output = run(&owned.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(stderr(&output).contains("rounded to 0.001 m") && stderr(&output).contains("rows "), "{}", stderr(&output));
    // Half a millimetre of freedom takes 2 % from the peak at the end.
    let (smooth, _) = tension(&["--row-tolerance-m", "0.0005"]);
    assert!((smooth - exact).abs() < 0.03 * exact, "{smooth} {exact}");

    let without = run(&[&["trajectory", &cogiro], &MOVE[..], &COURSE, &["--row-tolerance-m", "0.1"]].concat());
    assert_eq!(without.status.code(), Some(2));
}

#[test]
fn a_polynomial_needs_a_duration_or_a_limit_alone() {
    let cogiro = robot("cogiro.toml");
    for course in ["quintic", "septic"] {
        let line = [&["trajectory", &cogiro], &MOVE[..], &["--course", course, "--duration-s", "4"]].concat();
        assert!((number(&json(&line)["duration_s"]) - 4.0).abs() < 1e-12);
        let line = [&["trajectory", &cogiro], &MOVE[..], &["--course", course, "--speed-m-s", "2"]].concat();
        assert!(number(&json(&line)["duration_s"]) > 4.0);
    }
    let line = [&["trajectory", &cogiro], &MOVE[..], &["--duration-s", "4"]].concat();
    let output = run(&line);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("septic"), "{}", stderr(&output));

    // A duration that is too short for the limits is told.
    let line = [&["trajectory", &cogiro], &MOVE[..], &COURSE, &["--duration-s", "3"]].concat();
    assert!(stderr(&run(&line)).contains("the speed 114"), "{}", stderr(&run(&line)));
}

#[test]
fn a_rule_that_jumps_has_no_rate_across_the_jump() {
    // About a pose at which two optima of `middle` lie 87 N apart.
    let cogiro = robot("cogiro.toml");
    let pose = |by: f64| {
        format!(
            "{},{},{},-0.238899985,5.835693707,-0.570301491",
            3.198_456_389 - by,
            -2.261_249_935 - 0.7 * by,
            3.574_254_715 + 0.3 * by
        )
    };
    let line = |rule: &str| {
        let (from, to) = (pose(2e-3), pose(-2e-3));
        let course = ["--speed-m-s", "0.01", "--acceleration-m-s2", "0.1", "--jerk-m-s3", "1"];
        let line = [
            &["trajectory", &cogiro, "--pose", &from, "--move-to", &to, "--tension-rule", rule][..],
            &["--max-tension-n", "5000", "--min-tension-n", "100"],
            &course,
        ];
        line.concat().iter().map(|x| (*x).to_owned()).collect::<Vec<_>>()
    };
    for (rule, jumps) in [("middle", 1), ("lowest", 0)] {
        let line = line(rule);
        let line: Vec<&str> = line.iter().map(String::as_str).collect();
        let found = json(&line);
        assert_eq!(found["rule_jumps"].as_array().unwrap().len(), jumps, "{rule}");
        let (speed, no_bound) = extreme(&found, "largest speed");
        assert!(speed.unwrap() < 0.02, "{rule}: {speed:?}");
        assert_eq!(no_bound.is_some(), jumps > 0);
        let warnings = stderr(&run(&line)).to_owned();
        assert_eq!(warnings.contains("the rule `middle` jumps to other tensions at 1 time"), jumps > 0, "{warnings}");
    }
}

/// A thin plate that the platform passes between two rows: no row is near it, and still it is told with its time.
#[test]
fn what_is_passed_between_two_rows_is_told_with_its_time() {
    let folder = tempfile::tempdir().unwrap();
    let with_plate = |x: f64| {
        let path = folder.path().join("plate.toml");
        let plate = format!(
            "[obstacles.plate]\nshape = \"box\"\nposition_m = [{x}, 0.0, 1.9]\nsize_m = [0.0004, 0.4, 0.2]\n\
             [platform_bodies.sign]\nposition_m = [0.0, 0.0, 0.4]\nsize_m = [0.0004, 0.4, 0.2]\n"
        );
        fs::write(&path, format!("{}\n{plate}", fs::read_to_string(robot("cogiro.toml")).unwrap())).unwrap();
        path.display().to_string()
    };
    let moved = |x: f64, more: &[&str]| {
        let course = ["--pose", "-2,0,1.5", "--move-to", "2,0,1.5", "--speed-m-s", "2", "--acceleration-m-s2", "2"];
        json(&[&["trajectory", &with_plate(x)], &course[..], more].concat())
    };
    for (x, step) in [(0.3137, "0.5"), (0.3137, "1")] {
        let found = moved(x, &["--sample-time-s", step]);
        let rows = found["rows"].as_array().unwrap();
        let margin = |row: &serde_json::Value| number(&row["clearance_margin_m"]);
        assert!(rows.iter().all(|row| margin(row) > 0.0), "{step}");
        assert_eq!(found["within_limits"], false, "{step}");
        assert_eq!(found["most_used"]["limit"], "clearance", "{}", found["most_used"]);
        let (nearest, time) = (&found["nearest"], number(&found["nearest"]["t_s"]));
        assert!(nearest["pair"].as_str().unwrap().contains("plate"), "{nearest}");
        assert!(number(&nearest["distance_m"]) <= 1e-8, "{nearest}");
        // Rows that are close enough see it, too.
        let fine = moved(x, &["--sample-time-s", "0.02"]);
        assert!(fine["rows"].as_array().unwrap().iter().any(|row| margin(row) < 0.0));
        assert!(0.0 < time && time < number(&found["duration_s"]), "{time}");
    }

    // Beside the way nothing is told.
    let free = moved(3.5, &["--sample-time-s", "0.5"]);
    assert_eq!(free["within_limits"], true, "{}", free["most_used"]);
}
