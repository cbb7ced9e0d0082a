//! `prove` and `workspace --prove`: verdicts, ends of a division, certificates and what is refused.

use super::{json, robot, run, succeed};

#[test]
fn a_box_is_inside_outside_or_undecided_with_a_reason() {
    let cogiro = robot("cogiro.toml");
    let at = |pose: &str, within: &str| json(&["prove", &cogiro, "--pose", pose, "--within-m", within]);
    let middle = at("0,0,1.5", "0.5,0.5,0.3");
    assert_eq!((middle["verdict"].as_str(), middle["tried"].as_u64()), (Some("inside"), Some(1)));
    assert!(middle["margin_n"].as_f64().unwrap() > 100.0 && middle.get("reason").is_none());
    assert_eq!(middle["inside"], middle["whole"]);
    let corner = at("6.5,-5,0.3", "0.2,0.2,0.2");
    assert_eq!(corner["verdict"], "outside");
    let whole = at("0,0,2.7", "7.5,5.5,2.7");
    assert_eq!((whole["verdict"].as_str(), whole["reason"].as_str()), (Some("undecided"), Some("small-margin")));
    let point = json(&["prove", &cogiro, "--pose", "0,0,1.5"]);
    assert_eq!((point["verdict"].as_str(), point["volume_unit"].as_str()), (Some("inside"), Some("")));
    assert!(point["margin_n"].as_f64() > middle["margin_n"].as_f64());

    // A share that is reached ends the division before the boxes do.
    let line = ["prove", &cogiro, "--pose", "0,0,2.7", "--within-m", "7.5,5.5,2.7"];
    let share = json(&[&line[..], &["--undecided", "0.6", "--boxes", "20000"]].concat());
    assert_eq!(share["end"], "undecided");
    assert!(share["undecided_share"].as_f64().unwrap() <= 0.6 && share["tried"].as_u64().unwrap() < 20_000);
    let sum: f64 = ["inside", "outside", "undecided"].iter().map(|name| share[*name].as_f64().unwrap()).sum();
    assert!((sum - share["whole"].as_f64().unwrap()).abs() < 1e-9 * sum);
    let threads = |count: &str| json(&[&line[..], &["--boxes", "700", "--threads", count]].concat());
    assert_eq!(threads("1"), threads("3"));
}

#[test]
fn a_certificate_has_a_line_for_every_box_that_is_proved() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (certificate, surface) = (at("cogiro.jsonl"), at("cogiro.stl"));
    let options = ["--grid", "z=0:5:6", "--step-m", "3", "--prove", "--boxes", "2000"];
    let cogiro = robot("cogiro.toml");
    let line = [&["workspace", &cogiro][..], &options].concat();
    succeed(&[&line[..], &["--certificate", &certificate, "--proved", &surface]].concat());
    let proof = &json(&line)["proof"];
    let boxes = proof["boxes"].as_array().unwrap();
    let count = |verdict: &str| boxes.iter().filter(|of| of["verdict"] == verdict).count();
    let text = std::fs::read_to_string(&certificate).unwrap();
    assert_eq!(text.lines().count(), 3 + count("inside") + count("outside"));
    assert!(count("inside") > 0 && std::fs::metadata(&surface).unwrap().len() > 84);
}

#[test]
fn what_cannot_be_proved_is_refused_with_the_reason() {
    let (cogiro, kntu) = (robot("cogiro.toml"), robot("kntu-planar.toml"));
    let (winches, camera) = (robot("cogiro-winches.toml"), robot("stadium-camera.toml"));
    let pose = ["--pose", "0,0,1.5", "--within-m", "0.1,0.1,0.1"];
    let lines: [(Vec<&str>, &str); 9] = [
        ([&["prove", &winches][..], &pose].concat(), "runs over a pulley"),
        ([&["prove", &camera][..], &["--pose", "0,0,10", "--within-deg", "1,0,0"]].concat(), "does not turn"),
        ([&["prove", &kntu][..], &["--pose", "0,0,0", "--within-m", "0.5,0.5,0.5"]].concat(), "stays in its plane"),
        ([&["prove", &cogiro][..], &["--pose", "0,0,1.5", "--within-m", "-1,0,0"]].concat(), "within-m"),
        ([&["prove", &cogiro][..], &pose, &["--within-deg", "30,0,0"]].concat(), "too large"),
        ([&["prove", &cogiro][..], &pose, &["--required-wind-speed-m-s", "8"]].concat(), "disk without corners"),
        (vec!["workspace", &cogiro, "--step-m", "3", "--prove", "--at-least", "stiffness-min=1"], "stiffness"),
        (vec!["workspace", &cogiro, "--step-m", "3", "--boxes", "10"], "--prove"),
        (vec!["workspace", &cogiro, "--step-m", "3", "--prove", "--grid", "yaw=-5,5"], "--within-deg"),
    ];
    for (words, expected) in lines {
        let refused = run(&words);
        let said = String::from_utf8_lossy(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{words:?}: {said}");
        assert!(said.contains(expected), "{words:?}: {said}");
    }
}
