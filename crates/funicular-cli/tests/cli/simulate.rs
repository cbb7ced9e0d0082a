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
    assert!(page.contains("A run with a finer mesh and tolerance differs by at most"));
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
    assert!(page.contains("The error is not known") && page.contains("Warning: ropes go slack"));
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
