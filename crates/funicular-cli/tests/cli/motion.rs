//! Planar platforms and robots with few cables, as a user meets them.

use super::{json_of, numbers, run, run_with, stderr, stdout};

/// A plate in the xz plane on three cables.
const PLATE: &str = r#"name = "plate"
[platform]
motion = "planar-xz"
mass_kg = 8.0
inertia_kg_m2 = 0.3
[materials.rope]
axial_stiffness_n = 5e4
mass_kg_per_m = 0.05
damping_ratio = 0.003
[[cables]]
name = "1"
material = "rope"
anchor_m = [-2.0, 0.0, 3.0]
attachment_m = [-0.3, 0.0, 0.1]
[[cables]]
name = "2"
material = "rope"
anchor_m = [2.5, 0.0, 3.2]
attachment_m = [0.3, 0.0, 0.1]
[[cables]]
name = "3"
material = "rope"
anchor_m = [0.4, 0.0, -2.0]
attachment_m = [0.05, 0.0, -0.1]
[state]
position_m = [0.1, 0, 0.4]
roll_pitch_yaw_deg = [0, 5, 0]
"#;

/// Planar robot without its third cable.
fn two_cables() -> String {
    let (head, rest) = PLATE.split_once("[[cables]]\nname = \"3\"").unwrap();
    head.to_owned() + &rest[rest.find("[state]").unwrap()..]
}

#[test]
fn every_analysis_of_a_planar_robot_gives_six_components_with_zeros_out_of_the_plane() {
    let checked = json_of(&["check", "-"], PLATE);
    assert_eq!((&checked["degrees_of_freedom"], &checked["platform"]["motion"]), (&3.into(), &"planar-xz".into()));
    assert!(checked["warnings"].as_array().unwrap().is_empty());
    let modes = json_of(&["modes", "-", "--below-hz", "12"], PLATE);
    let found = modes["modes"].as_array().unwrap();
    assert_eq!((&modes["certified"], found.len() as u64), (&true.into(), modes["count_below"].as_u64().unwrap()));
    for mode in found {
        let shape = numbers(&mode["shape"]);
        assert!(shape.len() == 6 && [1, 3, 5].iter().all(|&i| shape[i] == 0.0), "{shape:?}");
    }
    for hz in ["0", "3"] {
        let stiffness = json_of(&["stiffness", "-", "--at-hz", hz], PLATE).to_string();
        assert!(!stiffness.contains("null"));
    }
    let frf = ["frf", "-", "--from-hz", "1", "--to-hz", "9", "--points", "50", "--input", "fx"];
    json_of(&[&frf[..], &["--output", "ry"]].concat(), PLATE);
    json_of(&["compare", "-", "--below-hz", "8"], PLATE);
    let reduced = json_of(&["reduce", "-", "--below-hz", "5", "--form", "second-order"], PLATE);
    let names: Vec<&str> =
        reduced["inputs"].as_array().unwrap().iter().map(|row| row["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["fx", "fz", "my"]);
    let names: Vec<&str> =
        reduced["coordinates"].as_array().unwrap()[..3].iter().map(|row| row["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["x", "z", "ry"]);
    let page = run_with(&["report", "-", "-o", "-"], PLATE);
    assert!(page.status.code() == Some(0) && stdout(&page).contains("θy") && !stdout(&page).contains("θx"));
}

#[test]
fn a_robot_that_cannot_move_along_z_has_a_report_along_x() {
    let output = run(&["report", &super::robot("kntu-planar.toml"), "-o", "-"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).contains("a force along x at the platform origin"));
}

#[test]
fn what_a_planar_robot_cannot_do_is_refused() {
    for (line, said) in [
        ("frf - --from-hz 1 --to-hz 2 --points 9 --input fy --output z", "the input fy is out of the plane"),
        ("frf - --from-hz 1 --to-hz 2 --points 9 --input fx --output rz", "the output rz is out of the plane"),
        ("statics - --pose 0,0.5,0.4", "0.5 m off the plane"),
        ("statics - --pose 0,0,0.4,0,0,7", "tilted out of its plane by 7"),
    ] {
        let output = run_with(&line.split(' ').collect::<Vec<_>>(), PLATE);
        assert_eq!(output.status.code(), Some(2), "{line}");
        assert!(stderr(&output).contains(said), "{line}: {}", stderr(&output));
    }
    let beside = PLATE.replace("anchor_m = [0.4, 0.0, -2.0]", "anchor_m = [0.4, 0.7, -2.0]");
    let checked = json_of(&["check", "-"], &beside);
    assert!(
        checked["warnings"][0].as_str().unwrap().contains("cables leave the plane of the platform: \"3\" by 0.7 m")
    );
}

#[test]
fn of_a_pose_that_two_cables_cannot_hold_the_nearest_is_given_and_said() {
    let file = two_cables();
    let found = json_of(&["statics", "-"], &file);
    let distance = found["nearest_pose_distance_m"].as_f64().unwrap();
    assert!(distance > 1e-3 && distance < 0.1, "{distance}");
    assert!(found["warnings"][0].as_str().unwrap().contains("cannot hold the requested pose"));
    // Asked for what was found, there is nothing to say.
    let position = numbers(&found["pose"]["position_m"]);
    let angles = numbers(&found["pose"]["roll_pitch_yaw_deg"]);
    let pose = [position, angles].concat().iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    let again = json_of(&["statics", "-", "--pose", &pose], &file);
    assert!(
        again["nearest_pose_distance_m"].as_f64().unwrap() < 1e-8 && again["warnings"].as_array().unwrap().is_empty()
    );
    for (one, two) in found["cables"].as_array().unwrap().iter().zip(again["cables"].as_array().unwrap()) {
        let [one, two] = [one, two].map(|cable| cable["unstrained_length_m"].as_f64().unwrap());
        assert!((one - two).abs() < 1e-8);
    }
    let modes = json_of(&["modes", "-", "--below-hz", "8"], &file);
    assert!(modes["certified"] == true && modes["warnings"][0].as_str().unwrap().contains("nearest"));

    // Straight cables hold the same poses, whether they stretch or not, and so do their lengths.
    let [ideal, spring] =
        ["ideal", "spring"].map(|model| json_of(&["statics", "-", "--static-model", model], &file)["pose"].clone());
    for (ours, theirs) in numbers(&ideal["position_m"]).iter().zip(numbers(&spring["position_m"])) {
        assert!((ours - theirs).abs() < 1e-9, "{ideal} {spring}");
    }
}
