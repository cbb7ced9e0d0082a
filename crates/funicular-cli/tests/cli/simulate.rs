//! `simulate`: page, figure, animation, chosen points, and a run that is killed.

use super::{csv, json, numbers, project, robot, run, stderr, stdout, succeed};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Release that stays taut, with fewer elements for speed.
fn release() -> Vec<String> {
    let (robot, scenario) = (robot("yuan2014-4mm.toml"), project("docs/simulation/release.toml"));
    let line =
        ["simulate", &robot, "--mass-kg", "12.5", "--scenario", &scenario, "--tolerance-m", "1e-6", "--elements", "2"];
    line.iter().chain(&["--degree", "6"]).map(|word| (*word).to_owned()).collect()
}

fn with<'a>(line: &'a [String], more: &[&'a str]) -> Vec<&'a str> {
    line.iter().map(String::as_str).chain(more.iter().copied()).collect()
}

/// Platform that falls into slack cables.
fn drop_scenario(directory: &Path) -> String {
    let path = directory.join("drop.toml");
    fs::write(
        &path,
        "[[release]]\nat_s = 0.01\nmass_kg = 75.8\n[[push]]\nat_s = 0.1\nduration_s = 0.05\nforce_n = [5, 0, 0]\n",
    )
    .unwrap();
    path.to_str().unwrap().to_owned()
}

#[test]
fn a_page_has_the_moving_robot_its_traces_its_spectrum_and_its_error() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let line = release();
    let (page, animation, figure) = (at("run.html"), at("moving.svg"), at("run.svg"));
    succeed(&with(&line, &["--for", "1", "--page", &page, "--animation", &animation, "-o", &figure]));

    let page = fs::read_to_string(&page).unwrap();
    assert!(page.len() < 5_000_000, "{}", page.len());
    for id in ["figure-robot", "figure-position", "figure-turn", "figure-tensions", "figure-spectrum"] {
        assert!(page.contains(&format!("id=\"{id}\"")), "{id}");
    }
    assert!(page.contains("mm in position and"));
    assert!(page.contains("0 s: release 1.95 kg.") && page.contains("mixed mode"));
    let frames = page.split_once("id=\"motion-frames\">").unwrap().1.split_once("</script>").unwrap().0;
    let frames: serde_json::Value = serde_json::from_str(frames).unwrap();
    let times = numbers(&frames["times"]);
    assert_eq!((times.len(), times[0], *times.last().unwrap()), (300, 0.0, 1.0));

    let figure = fs::read_to_string(&figure).unwrap();
    assert!(figure.contains("displacement [mm]") && figure.contains("tension at the platform [N]"));
    assert!(!figure.contains("slack"), "no cable is slack");

    // Every rope, every face of the platform, the centre of mass and the mark of the time move, in the true time.
    let animation = fs::read_to_string(&animation).unwrap();
    assert!(animation.len() < 3_500_000, "{}", animation.len());
    let moving: Vec<&str> = animation.matches("<animate attributeName=\"d\" dur=\"1s\"").collect();
    assert!(moving.len() > 6 + 2, "{}", moving.len());
    assert!(animation.contains("times as large"), "3 mm in a robot of 12 m are not seen");
    for path in animation.split("<animate attributeName=\"d\"").skip(1) {
        let values = path.split_once("values=\"").unwrap().1.split_once('"').unwrap().0;
        let steps: Vec<usize> = values.split(';').map(|frame| frame.matches('L').count()).collect();
        assert!(steps.iter().all(|count| *count == steps[0]), "frames with other points cannot be joined");
    }
}

#[test]
fn slack_is_marked_in_page_figure_and_animation() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let (heavy, scenario) = (robot("yuan2014-4mm.toml"), drop_scenario(directory.path()));
    let line =
        ["simulate", &heavy, "--mass-kg", "86.35", "--scenario", &scenario, "--for", "0.3", "--tolerance-m", "1e-5"];
    let (page, animation, figure) = (at("run.html"), at("moving.svg"), at("run.svg"));
    let more =
        ["--elements", "2", "--degree", "6", "--once", "--page", &page, "--animation", &animation, "-o", &figure];
    let text = succeed(&[&line[..], &more].concat());
    assert!(text.contains("is slack from"), "{text}");
    let page = fs::read_to_string(&page).unwrap();
    assert!(page.contains("The error is not known") && page.contains("ropes with mass go slack"));
    assert!(page.contains("\"text\":\"slack\"") && page.contains("0.1 to 0.15 s: push."));
    assert!(fs::read_to_string(&figure).unwrap().contains(">slack<"));
    assert!(fs::read_to_string(&animation).unwrap().contains("attributeName=\"stroke\" calcMode=\"discrete\""));
}

#[test]
fn a_chosen_point_moves_with_the_platform() {
    let line = release();
    let line = with(&line, &["--for", "0.2", "--sample-time-s", "0.001", "--once", "--point", "hook=0.1,0,-0.5"]);
    let found = json(&line);
    let rows = found["rows"].as_array().unwrap();
    let hook = |k: usize| numbers(&rows[k]["points_m"][0]);
    let position = numbers(&rows[100]["position_m"]);
    let away = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    assert!((away(&hook(100), &position) - 0.1_f64.hypot(0.5)).abs() < 1e-12);
    // The velocity is the rate of the position.
    let velocity = numbers(&rows[100]["point_velocities_m_s"][0]);
    for (axis, velocity) in velocity.iter().enumerate() {
        let rate = (hook(101)[axis] - hook(99)[axis]) / 0.002;
        assert!((rate - velocity).abs() < 1e-3 * numbers(&rows[100]["velocity_m_s"])[2].abs().max(1e-2), "{axis}");
    }
    let (header, rows) = csv(&line);
    let place = header.iter().position(|name| name == "point_hook_z_m").unwrap();
    assert_eq!(rows[100][place].parse::<f64>().unwrap().to_bits(), hook(100)[2].to_bits());

    for (point, says) in [("hook", "hook=0,0,-0.5"), ("hook=0,0", "x,y,z")] {
        let output = run(&[&line[..2], &["--point", point]].concat());
        assert!(stderr(&output).contains(says), "{}", stderr(&output));
    }
    let twice = run(&[&line[..], &["--point", "hook=0,0,0"]].concat());
    assert!(stderr(&twice).contains("stands twice"), "{}", stderr(&twice));
}

/// A run that is killed is continued, and the result is that of a run that was left alone.
#[test]
fn a_killed_run_is_continued() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let (killed, whole) = (at("killed.csv"), at("whole.csv"));
    let line = release();
    let line = with(&line, &["--for", "6", "--sample-time-s", "0.0005", "--once"]);
    let state = at("killed.csv.partial.state");

    let mut child = Command::new(env!("CARGO_BIN_EXE_funicular"))
        .args([&line[..], &["-o", &killed]].concat())
        .stderr(Stdio::null())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    while !Path::new(&state).exists() && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(20));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(Path::new(&state).exists() && !Path::new(&killed).exists(), "it ended before it was killed");

    // The rows so far can be read, and are not lost by repeating the command.
    let kept = fs::read_to_string(at("killed.csv.partial")).unwrap();
    assert!(kept.starts_with("t_s,x_m,") && kept.lines().count() > 50);
    let again = run(&[&line[..], &["-o", &killed]].concat());
    assert!(stderr(&again).contains("--resume or --discard"), "{}", stderr(&again));
    let other = run(&[&line[..], &["-o", &killed, "--resume", "--hold-platform"]].concat());
    assert!(stderr(&other).contains("belongs to another request"), "{}", stderr(&other));

    // One bit that is another one, in a row, in the checksum or in a number of the state, is found.
    let rows = at("killed.csv.partial");
    let length = fs::metadata(&state).unwrap().len() as usize;
    for (file, place) in [(&rows, 2000), (&state, length - 5), (&state, length / 2 + 1000), (&state, length - 800)] {
        let sound = fs::read(file).unwrap();
        let mut damaged = sound.clone();
        damaged[place] ^= 1;
        fs::write(file, damaged).unwrap();
        let output = run(&[&line[..], &["-o", &killed, "--resume"]].concat());
        assert_eq!(output.status.code(), Some(2), "{file} {place}");
        let says = stderr(&output);
        assert!(says.contains("is damaged") || says.contains("belongs to another request"), "{file} {place}: {says}");
        fs::write(file, sound).unwrap();
    }

    let output = run(&[&line[..], &["-o", &killed, "--resume"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("continuing after "), "{}", stderr(&output));
    succeed(&[&line[..], &["-o", &whole]].concat());
    assert!(fs::read(&killed).unwrap() == fs::read(&whole).unwrap(), "every digit is the same");
    assert!(!Path::new(&state).exists() && !Path::new(&at("killed.csv.partial")).exists());
}

/// Distances of the moving cables are in the rows, their least one is said, and a run that is continued has them too.
#[test]
fn a_release_beside_a_pillar_has_distances() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let pillar =
        "\n[obstacles.pillar]\nsize_m = [0.2, 0.2, 0.8]\nposition_m = [0, 0, 0.878]\n[clearance]\nobstacles_m = 0.01\n";
    let text = fs::read_to_string(robot("yuan2014-4mm.toml")).unwrap() + pillar;
    fs::write(at("hall.toml"), text).unwrap();
    let scenario = project("docs/simulation/release.toml");
    let hall = at("hall.toml");
    let line = ["simulate", &hall, "--mass-kg", "12.5", "--scenario", &scenario, "--for", "0.3", "--elements", "2"];

    let found = json(&line);
    let rows = found["rows"].as_array().unwrap();
    let margins: Vec<f64> = rows.iter().map(|row| row["clearance_margin_m"].as_f64().unwrap()).collect();
    let at_rest = json(&["clearance", &hall, "--mass-kg", "12.5"]);
    let least = at_rest["pairs"].as_array().unwrap().iter().map(|pair| pair["margin_m"].as_f64().unwrap());
    let least = least.fold(f64::INFINITY, f64::min);
    // Lines between the nodes of the ropes are near the ropes by a part of their sag.
    assert!((margins[0] - least).abs() < 1e-4, "{} {least}", margins[0]);
    // The platform rises towards the pillar above it when the payload is gone.
    let nearest = &found["nearest"];
    assert_eq!(nearest["margin_m"].as_f64(), margins.iter().copied().reduce(f64::min));
    assert!(nearest["pair"].as_str().unwrap().contains("pillar"), "{nearest}");
    assert!(margins[0] - nearest["margin_m"].as_f64().unwrap() > 5e-4, "{margins:?}");
    let errors = found["errors"].as_array().unwrap();
    let error = errors.iter().find(|of| of["column"] == "clearance_margin_m").unwrap();
    assert!(error["largest"].as_f64().unwrap() < 1e-4);

    let (header, cells) = csv(&line);
    let place = header.iter().position(|name| name == "clearance_margin_m").unwrap();
    assert_eq!(cells[7][place].parse::<f64>().unwrap().to_bits(), margins[7].to_bits());
    assert!(stdout(&run(&line)).contains("The least distance is "));
}

/// A load on a rope, with more tables.
fn hanging(rope: &str, cables: &str) -> String {
    format!(
        "name = \"load\"\n[platform]\nmass_kg = 50.0\nmotion = \"point-mass\"\n[materials.rope]\n\
         axial_stiffness_n = 20000.0\n{rope}[[cables]]\nname = \"working\"\nmaterial = \"rope\"\n\
         anchor_m = [0.0, 0.0, 0.0]\nunstrained_length_m = 8.0\n{cables}"
    )
}

/// A longer rope that catches the load, with its anchor this far away.
fn catching(apart: f64) -> String {
    format!(
        "[[cables]]\nname = \"safety\"\nmaterial = \"rope\"\nanchor_m = [{apart:?}, 0.0, 0.0]\n\
         unstrained_length_m = 10.0\n"
    )
}

#[test]
fn a_simulation_begins_with_a_rope_that_hangs_slack() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    fs::write(at("cut.toml"), "[[cut]]\ncable = \"working\"\nat_s = 0.05\n").unwrap();
    for (mass, apart) in [(0.05, 0.5), (0.05, 2.0), (0.1, 2.0), (0.02, 4.0), (0.05, 0.0)] {
        let rope = format!("mass_kg_per_m = {mass}\naxial_damping_time_s = 0.0005\n");
        fs::write(at("robot.toml"), hanging(&rope, &catching(apart))).unwrap();
        let line = ["simulate", &at("robot.toml"), "--scenario", &at("cut.toml"), "--for", "0.06", "--once"];
        let found = json(&line);
        // It rests until the cut, with the weight of half of the loop and of its own rope on the working one.
        let rows = found["rows"].as_array().unwrap();
        let [first, before] = [0, 800].map(|k| numbers(&rows[k]["position_m"]));
        assert!((first[2] - before[2]).abs() < 1e-6, "{mass} {apart}: {first:?} {before:?}");
        assert!(first[2] < -8.0 && first[2] > -8.5, "{mass} {apart}");
    }
}

/// A rope that fails at a place swings on in two halves, which fall below a floor; text, results and page say so, and
/// the floor does not count as the nearest obstacle.
#[test]
fn both_halves_of_a_rope_that_fails_at_a_place_are_told() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let rope = "mass_kg_per_m = 0.05\naxial_damping_time_s = 0.0005\n";
    let floor = "[obstacles.ground]\nshape = \"half-space\"\nposition_m = [0.0, 0.0, -8.22]\n";
    fs::write(at("robot.toml"), hanging(rope, &format!("{}{floor}", catching(2.0)))).unwrap();
    let scenario = |place: &str| format!("[[cut]]\ncable = \"working\"\nat_s = 0.01\nplace_m = {place}\n");
    let run_with = |place: &str, more: &[&str]| {
        fs::write(at("cut.toml"), scenario(place)).unwrap();
        run(&[&["simulate", &at("robot.toml"), "--scenario", &at("cut.toml"), "--for", "0.1", "--once"], more].concat())
    };

    let output = run_with("5.0", &["--format", "json", "--page", &at("page.html")]);
    assert!(output.status.success(), "{}", stderr(&output));
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let rows = found["rows"].as_array().unwrap();
    let last = &rows[rows.len() - 1];
    // 8 m of rope without 5 m, and the weight of these 5 m still hangs on the platform for a while.
    assert!(
        (numbers(&last["unstrained_lengths_m"])[0] - (numbers(&rows[0]["unstrained_lengths_m"])[0] - 5.0)).abs() < 1e-9
    );
    let below = found["below"].as_array().unwrap();
    assert!(below.iter().any(|row| row["part"] == "the platform" && row["is_floor"] == true), "{below:?}");
    assert!(stderr(&output).contains("contact is not simulated"), "{}", stderr(&output));
    let page = fs::read_to_string(at("page.html")).unwrap();
    assert!(page.contains("Grey bodies: obstacles") && page.contains("is below the surface of"));

    // Without the floor nothing is said.
    fs::write(at("robot.toml"), hanging(rope, &catching(2.0))).unwrap();
    let without = run_with("5.0", &["--format", "json"]);
    let without: serde_json::Value = serde_json::from_slice(&without.stdout).unwrap();
    assert!(without["below"].is_null());
    for (place, says) in [("9.0", "between"), ("-1", "give 0 or more"), ("0.01", "0 for a failure at the platform")] {
        let refused = run_with(place, &[]);
        assert_eq!(refused.status.code(), Some(2), "{place}");
        assert!(stderr(&refused).contains("[[cut]]") && stderr(&refused).contains(says), "{}", stderr(&refused));
    }
}

/// The bounce on a rope, not the pendulum, has the loss factor of the file, and the list says so.
#[test]
fn a_loss_factor_holds_where_the_rope_is_stretched() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    fs::write(at("robot.toml"), hanging("mass_kg_per_m = 0.001\naxial_loss_factor = 0.05\n", "")).unwrap();
    fs::write(at("release.toml"), "[[release]]\nat_s = 0.0\nmass_kg = 1.0\n").unwrap();
    let line = ["simulate", &at("robot.toml"), "--scenario", &at("release.toml"), "--for", "3", "--once"];
    let found = json(&line);
    let modes = found["stretch_losses"].as_array().unwrap();
    let bounce = &modes[modes.len() - 1];
    let [hz, ratio, in_time] =
        ["frequency_hz", "damping_ratio", "damping_ratio_in_time"].map(|key| bounce[key].as_f64().unwrap());
    let expected = (20000.0_f64 / 8.0 / 50.0).sqrt() / std::f64::consts::TAU;
    assert!((hz - expected).abs() < 0.02 * expected, "{hz} {expected}");
    assert!((ratio - 0.025).abs() < 5e-4 && (in_time - ratio).abs() < 1e-9, "{bounce}");

    // The peaks fall by exp(−2πζ) from one to the next.
    let heights: Vec<f64> =
        found["rows"].as_array().unwrap().iter().map(|row| numbers(&row["position_m"])[2]).collect();
    let peaks: Vec<f64> = heights.windows(3).filter(|of| of[1] > of[0] && of[1] >= of[2]).map(|of| of[1]).collect();
    let troughs: Vec<f64> = heights.windows(3).filter(|of| of[1] < of[0] && of[1] <= of[2]).map(|of| of[1]).collect();
    let swing = |k: usize| peaks[k] - troughs[k];
    let fall = (swing(0) / swing(2)).ln() / (2.0 * std::f64::consts::TAU);
    assert!((fall - 0.025).abs() < 1.5e-3, "{fall}");
}

/// Scenarios that say nothing, or something that cannot be, are refused or warned about in one line, and leave no file.
#[test]
fn scenarios_without_effect_are_told() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let robot = robot("yuan2014-4mm.toml");
    let far = "t_s,x_m,y_m,z_m,roll_deg,pitch_deg,yaw_deg\n0,0.0203,0.0102,0.4555,0,2.88,0\n\
               0.002,0.0204,0.0102,100,0,2.88,0\n";
    fs::write(at("far.csv"), far).unwrap();
    let line = ["simulate", &robot, "--scenario", &at("s.toml"), "--for", "0.02", "--once", "-o", &at("rows.csv")];
    for (scenario, code, says) in [
        ("[[release]]\nat_s = 0.0\nmass_kg = 1,95\n", 2, &["line 3, column", "decimal point, not a comma"][..]),
        ("[[release]\nat_s = 0.0\n", 2, &["line 1, column"]),
        ("[[push]]\nat_s = 0.0\nduration_s = 0.01\n", 2, &["[[push]]", "no force and no moment"]),
        ("[[lengths]]\nat_s = 0.0\nduration_s = 0.01\nchange_m = {}\n", 2, &["[[lengths]]", "changes nothing"]),
        ("[[tension]]\nat_s = 0.0\nduration_s = 0.01\ntension_n = {}\n", 2, &["[[tension]]", "changes nothing"]),
        ("[[release]]\nat_s = 0.0\nmass_kg = -1e-300\n", 2, &["-1e-300 kg"]),
        ("[[lengths]]\nat_s = 0.001\ntable = \"far.csv\"\n", 1, &["[[lengths]]", "`table` row 2: "]),
        ("[[stop]]\nat_s = 0.001\nduration_s = 0.01\n", 0, &["warning: [[stop]]", "brakes nothing"]),
        (
            "[[cut]]\ncable = \"1\"\nat_s = 0.001\n\
             [[lengths]]\nat_s = 0.005\nduration_s = 0.01\nchange_m = { 1 = 0.01 }\n",
            0,
            &["warning: [[lengths]]", "only the rope that is left", "commands cable \"1\""],
        ),
    ] {
        fs::write(at("s.toml"), scenario).unwrap();
        let output = run(&line);
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{scenario}: {told}");
        assert!(says.iter().all(|says| told.contains(says)), "{scenario}: {told}");
        assert!(!told.contains("\\n"), "{told}");
        assert!(!Path::new(&at("rows.csv.partial")).exists(), "{scenario}");
    }
}

/// A table or a mesh that another file names is not written over.
#[test]
fn files_that_other_files_name_are_not_written_over() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    fs::write(at("s.toml"), "[[lengths]]\nat_s = 0.001\ntable = \"table.csv\"\n").unwrap();
    let lengths = "t_s,unstrained_length_1_m,unstrained_length_2_m,unstrained_length_3_m,unstrained_length_4_m,\
                   unstrained_length_5_m,unstrained_length_6_m\n0,6.863,6.565,6.756,6.663,6.801,6.604\n\
                   0.005,6.8629,6.565,6.756,6.663,6.801,6.604\n";
    fs::write(at("table.csv"), lengths).unwrap();
    let corners = ["0 0 0", "1 0 0", "0 1 0", "0 0 1"];
    let facet = |of: [usize; 3]| {
        let vertices: String = of.map(|k| format!("vertex {}\n", corners[k])).concat();
        format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
    };
    let facets = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(facet).concat();
    let mesh_text = format!("solid m\n{facets}endsolid m\n");
    fs::write(at("m.stl"), &mesh_text).unwrap();
    let text = fs::read_to_string(robot("yuan2014-4mm.toml")).unwrap();
    let mesh = "\n[obstacles.m]\nshape = \"mesh\"\nfile = \"m.stl\"\nposition_m = [0.0, 30.0, 0.0]\n";
    fs::write(at("robot.toml"), text + mesh).unwrap();
    let plain = robot("yuan2014-4mm.toml");

    let (robot, scenario) = (at("robot.toml"), at("s.toml"));
    let grid = ["--grid", "x=-1:1:3", "--grid", "y=-1:1:3", "--grid", "z=0:1:3"];
    let simulate = ["simulate", &plain, "--scenario", &scenario, "--for", "0.01", "--once"];
    let cases = [
        ([&simulate[..], &["-o", &at("table.csv")]].concat(), "over the table"),
        ([&simulate[..], &["--page", &at("./table.csv")]].concat(), "over the table"),
        ([&["workspace", &robot], &grid[..], &["-o", &at("m.stl")]].concat(), "over the mesh"),
        (
            [&["workspace", &plain, "--compare", &robot], &grid[..], &["--surface", &at("m.stl")]].concat(),
            "over the mesh",
        ),
        (vec!["statics", &robot, "-o", &at("m.stl"), "--format", "json"], "over the mesh"),
    ]
    .map(|(line, says)| (line.into_iter().map(ToOwned::to_owned).collect::<Vec<String>>(), says));
    for (line, says) in &cases {
        let words: Vec<&str> = line.iter().map(String::as_str).collect();
        let output = run(&words);
        assert_eq!(output.status.code(), Some(2), "{line:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(says), "{line:?}: {}", stderr(&output));
        assert_eq!(fs::read_to_string(at("table.csv")).unwrap(), lengths);
        assert_eq!(fs::read_to_string(at("m.stl")).unwrap(), mesh_text);
    }
}

/// Ropes without mass go slack and nothing of it is statistical; ropes with mass are.
#[test]
fn only_slack_ropes_with_mass_are_statistical() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    fs::write(at("push.toml"), "[[push]]\nat_s = 0.0\nduration_s = 0.1\nforce_n = [0, 0, 2000]\n").unwrap();
    for (mass, is_statistical) in [("0.0", false), ("0.05", true)] {
        fs::write(at("robot.toml"), hanging(&format!("mass_kg_per_m = {mass}\n"), "")).unwrap();
        let line = ["simulate", &at("robot.toml"), "--scenario", &at("push.toml"), "--for", "0.3", "--once"];
        let found = json(&line);
        assert!(!found["slack"].as_array().unwrap().is_empty(), "{mass}");
        assert_eq!(found["is_statistical"], is_statistical, "{mass}");
    }
}

/// The reason why the finer run fails is told: on the finer mesh the rope reaches the tension at which it fails.
#[test]
fn a_finer_run_that_fails_gives_its_reason() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    fs::write(at("robot.toml"), hanging("mass_kg_per_m = 1.0\naxial_loss_factor = 0.05\n", "")).unwrap();
    let push = "[[push]]\nat_s = 0.0\nduration_s = 0.05\nforce_n = [0, 0, 1000]\n";
    let cut = "[[cut]]\ncable = \"working\"\nat_tension_n = 626.0\n";
    fs::write(at("s.toml"), format!("{push}{cut}")).unwrap();
    let output = run(&[
        &["simulate", &at("robot.toml"), "--scenario", &at("s.toml"), "--for", "0.5", "--tolerance-m", "1e-6"][..],
        &["--elements", "1", "--degree", "2"],
    ]
    .concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let told = stderr(&output);
    assert!(told.contains("the error is not known") && told.contains("is the last one that holds"), "{told}");
}

/// The stated errors are not below those against a much finer run.
#[test]
fn stated_errors_bound_the_errors() {
    let line = release();
    for (elements, degree) in [("2", "4"), ("3", "4"), ("6", "1"), ("1", "8")] {
        let mut line = with(&line, &["--for", "0.3"]);
        let place = |word: &str, line: &[&str]| line.iter().position(|other| *other == word).unwrap() + 1;
        let (of_elements, of_degree) = (place("--elements", &line), place("--degree", &line));
        (line[of_elements], line[of_degree]) = (elements, degree);
        let found = json(&line);
        let mut finest = line.clone();
        (finest[of_elements], finest[of_degree]) = ("8", "8");
        let tolerance = place("--tolerance-m", &finest);
        finest[tolerance] = "1e-8";
        finest.push("--once");
        let finest = json(&finest);
        let rows = |of: &serde_json::Value| of["rows"].as_array().unwrap().clone();
        let mut checked = 0;
        for error in found["errors"].as_array().unwrap() {
            let column = error["column"].as_str().unwrap();
            let values = |row: &serde_json::Value| match column.strip_prefix("tension_platform_") {
                Some(name) => vec![numbers(&row["tensions_platform_n"])[name[..1].parse::<usize>().unwrap() - 1]],
                None => numbers(&row["position_m"]),
            };
            if column != "position_m" && !column.starts_with("tension_platform_") {
                continue;
            }
            let off = |(a, b): (&serde_json::Value, &serde_json::Value)| -> f64 {
                values(a).iter().zip(values(b)).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
            };
            let (ours, true_rows) = (rows(&found), rows(&finest));
            let each: Vec<f64> = ours.iter().zip(&true_rows).map(off).collect();
            let mean = (each.iter().map(|of| of * of).sum::<f64>() / each.len() as f64).sqrt();
            let stated = error["root_mean_square"].as_f64().unwrap();
            assert!(stated > mean, "{elements} of degree {degree}, {column}: {stated} < {mean}");
            assert!(stated < 8.0 * mean, "{elements} of degree {degree}, {column}: {stated} > 8 · {mean}");
            checked += 1;
        }
        assert_eq!(checked, 7);
    }
}
