//! Valid robot files become the robots that they describe; no text, however broken, makes the reader panic.

use super::*;
use crate::robot::Damping;
use proptest::prelude::*;

/// File that uses every kind of value.
const VALID: &str = r#"name = "two ropes"
source = "made up"
gravity_m_s2 = [0, 0, -9.81]
[platform]
mass_kg = 10.5
inertia_kg_m2 = [[0.2, 0.01, 0.0], [0.01, 0.2, 0.0], [0.0, 0.0, 0.3]]
center_of_mass_m = [0.0, 0.0, 0.1]
[materials.thin]
youngs_modulus_pa = 20e9
diameter_m = 0.004
mass_kg_per_m = 0.067
damping_ratio = 0.003
[materials."thick rope"]
axial_stiffness_n = 1_000_000
mass_kg_per_m = 0
viscous_damping_n_s_m2 = 0.5
[[cables]]
name = "1"
material = "thin"
anchor_m = [1.0, 0.0, 3.0]
attachment_m = [0.1, 0.0, 0.0]
[[cables]]
name = "2"
material = "thick rope"
anchor_m = [-1.0, 0.0, 3.0]
attachment_m = [-0.1, 0.0, 0.0]
[state]
position_m = [0.0, 0.0, 1.0]
roll_pitch_yaw_deg = [0.0, 0.0, 90.0]
"#;

#[test]
fn a_valid_file_becomes_the_robot_it_describes() {
    let robot = Robot::from_toml(VALID).unwrap();
    assert_eq!((robot.name.as_str(), robot.source.as_str()), ("two ropes", "made up"));
    assert_eq!(robot.gravity_w, Vec3::new(0.0, 0.0, -9.81));
    assert_eq!(robot.platform.motion, PlatformMotion::Rigid);
    assert!((robot.platform.inertia_p[(0, 1)] - 0.01).abs() < 1e-15);
    assert_eq!(robot.cables.len(), 2);
    let [thin, thick] = [&robot.cables[0].material, &robot.cables[1].material];
    // E π d²/4, the paper's 251 kN.
    assert!((thin.axial_stiffness - 251_327.412).abs() < 1e-3, "{}", thin.axial_stiffness);
    assert_eq!(thin.damping, Damping::Ratio(0.003));
    assert_eq!((thick.axial_stiffness, thick.mass_per_length), (1e6, 0.0));
    assert_eq!(thick.damping, Damping::Viscous(0.5));
    let State::Pose(pose) = &robot.state else { panic!("{:?}", robot.state) };
    let attachment_w = pose.point_w(&robot.cables[0].attachment_p);
    assert!((attachment_w - Vec3::new(0.0, 0.1, 1.0)).norm() < 1e-15, "{attachment_w}");
}

#[test]
fn line_ends_and_a_byte_order_mark_change_nothing() {
    let plain = Robot::from_toml(VALID).unwrap();
    let windows = format!("\u{feff}{}", VALID.replace('\n', "\r\n"));
    assert_eq!(Robot::from_toml(&windows).unwrap(), plain);
    let error = Robot::from_toml(&windows.replace("10.5", "-10.5")).unwrap_err();
    assert_eq!((error.issues()[0].line, error.issues()[0].column), (5, 11));
    let error = Robot::from_toml(&windows.replace("name = \"two ropes\"", "name = 2")).unwrap_err();
    assert_eq!((error.issues()[0].line, error.issues()[0].column), (1, 8));
}

#[test]
fn defaults_are_earth_gravity_no_damping_and_an_unknown_state() {
    let text = VALID
        .replace("gravity_m_s2 = [0, 0, -9.81]\n", "")
        .replace("source = \"made up\"\n", "")
        .replace("damping_ratio = 0.003\n", "")
        .replace("center_of_mass_m = [0.0, 0.0, 0.1]\n", "");
    let text = text.split("[state]").next().unwrap();
    let robot = Robot::from_toml(text).unwrap();
    assert_eq!(robot.gravity_w, Vec3::new(0.0, 0.0, -9.81));
    assert_eq!(robot.cables[0].material.damping, Damping::Ratio(0.0));
    assert_eq!(robot.platform.center_of_mass_p, Vec3::zeros());
    assert_eq!((robot.source.as_str(), &robot.state), ("", &State::Unknown));
}

#[test]
fn an_empty_file_says_what_a_robot_file_has() {
    for text in ["", "\n\n", "# only a comment\n", "\u{feff}"] {
        let error = Robot::from_toml(text).unwrap_err();
        assert_eq!(error.to_string(), "line 1, column 1: the file describes no robot: it has no keys");
        assert!(error.issues()[0].help.as_deref().unwrap().contains("[[cables]]"));
    }
}

#[test]
fn all_errors_of_a_file_are_reported_at_once_in_file_order() {
    let text = VALID
        .replace("diameter_m = 0.004", "diameter_m = 0")
        .replace("mass_kg = 10.5", "mas_kg = 10.5")
        .replace("anchor_m = [-1.0, 0.0, 3.0]", "anchor_m = [-1.0, nan]");
    let error = Robot::from_toml(&text).unwrap_err();
    let places: Vec<_> = error.issues().iter().map(|i| (i.line, i.column)).collect();
    assert_eq!(places, [(5, 1), (10, 14), (25, 12)], "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn no_text_makes_the_reader_panic(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        read_and_render(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn no_mutation_of_a_valid_file_makes_the_reader_panic(
        edits in proptest::collection::vec((any::<prop::sample::Index>(), 0_usize..12, mutation()), 1..5),
    ) {
        let mut text: Vec<char> = VALID.chars().collect();
        for (at, removed, inserted) in edits {
            let at = at.index(text.len() + 1);
            let end = (at + removed).min(text.len());
            text.splice(at..end, inserted.chars());
        }
        read_and_render(&text.into_iter().collect::<String>());
    }

    #[test]
    fn no_shuffle_of_lines_makes_the_reader_panic(
        lines in proptest::sample::subsequence(VALID.lines().collect::<Vec<_>>(), 0..=29).prop_shuffle(),
    ) {
        read_and_render(&lines.join("\n"));
    }
}

/// Fragments that damage a file.
fn mutation() -> impl Strategy<Value = String> {
    prop_oneof![
        Just(String::new()),
        prop::sample::select(vec![
            "nan",
            "-inf",
            "1e999",
            "1e-320",
            "0",
            "-1",
            "99999999999999999999",
            "[]",
            "[[",
            "]]",
            "{}",
            "\"",
            "'''",
            "\r\n",
            "\u{feff}",
            "\u{202e}",
            "é漢",
            "1979-05-27",
            "0x_",
            "[state]\n",
            "[[cables]]\n",
            "true",
            "=",
            ",",
            "#",
            "[[1,2,3],[4,5,6],[7,8,9]]",
            "\t",
        ])
        .prop_map(str::to_owned),
        any::<char>().prop_map(String::from),
    ]
}

fn read_and_render(text: &str) {
    match Robot::from_toml(text) {
        Ok(robot) => assert!(!robot.cables.is_empty() && robot.platform.mass > 0.0),
        Err(error) => {
            assert!(!error.issues().is_empty());
            assert!(error.render("robot.toml", text, false).contains("error"));
            // With the wrong text the place is wrong, but rendering still works.
            assert!(error.render("robot.toml", "é", true).contains("robot.toml"));
        }
    }
}
