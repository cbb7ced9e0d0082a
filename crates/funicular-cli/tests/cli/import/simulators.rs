//! Robots of simulators and of JSON and YAML: MuJoCo, SDF, URDF, cdpr for Gazebo, GRAB.

use super::*;
use crate::{robot, succeed};
use std::fmt::Write;

/// Examples with the options that their formats need, and the gravity of their programs.
fn examples() -> [(&'static str, Vec<&'static str>, f64); 5] {
    let mass = vec!["--mass-kg-per-m", "0.05"];
    [
        ("tripod_mjcf.xml", mass.clone(), 9.81),
        ("tripod.sdf", mass, 9.81),
        ("tripod.urdf", ROPES.to_vec(), 9.81),
        ("tripod.yaml", ROPES.to_vec(), 9.8),
        ("tripod_grab.json", ROPES.to_vec(), 9.80665),
    ]
}

#[test]
fn the_tripod_is_one_robot_in_the_formats_of_simulators() {
    let [bodies, cables] = caspr();
    let reference = json("check", &imported(&[&[bodies.as_str(), &cables], &ROPES[..]].concat()), &[]);
    for (name, more, gravity) in examples() {
        let text = imported(&[&[&*example(name)], &more[..]].concat());
        let found = json("check", &text, &[]);
        for key in ["mass_kg", "inertia_kg_m2"] {
            assert_eq!(found["platform"][key], reference["platform"][key], "{name}: {key}");
        }
        // The program cdpr has its centre of mass at the origin.
        let center =
            if name == "tripod.yaml" { vec![0.0; 3] } else { numbers(&reference["platform"]["center_of_mass_m"]) };
        assert_eq!(numbers(&found["platform"]["center_of_mass_m"]), center, "{name}");
        assert_eq!(numbers(&found["gravity_m_s2"]), [0.0, 0.0, -gravity], "{name}");
        for (a, b) in found["cables"].as_array().unwrap().iter().zip(reference["cables"].as_array().unwrap()) {
            assert_eq!((&a["name"], &a["anchor_m"]), (&b["name"], &b["anchor_m"]), "{name}");
            assert_close(&numbers(&a["attachment_m"]), &numbers(&b["attachment_m"]), 1e-15, name);
        }
        assert_eq!(found["materials"].as_array().unwrap().len(), 1, "{name}: {}", found["materials"]);
        let stiffness = found["materials"][0]["axial_stiffness_n"].as_f64().unwrap();
        assert!((stiffness - 1e6).abs() < 1e-6, "{name}: {stiffness}");
    }
    // The lengths of the springs are those of the robot at its pose.
    for name in ["tripod_mjcf.xml", "tripod.sdf"] {
        let found = json("statics", &imported(&[&example(name), "--mass-kg-per-m", "0.05"]), &[]);
        assert_close(&numbers(&found["pose"]["position_m"]), &[0.1, -0.05, 1.5], 1e-10, name);
    }
    // Limits of the motors and of the joints.
    for name in ["tripod_mjcf.xml", "tripod.yaml"] {
        let more: &[&str] = if name == "tripod.yaml" { &ROPES } else { &ROPES[..2] };
        let text = imported(&[&[&*example(name)], more].concat());
        let limits =
            [text.matches("minimum_tension_n = 10.0").count(), text.matches("maximum_tension_n = 2000.0").count()];
        assert_eq!(limits, [6, 6], "{name}: {text}");
    }
}

/// Robot of the library, exported with an option and imported without mass of its ropes.
fn there_and_back(name: &str, to: &str, more: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(if to == "mujoco" { "robot.xml".to_owned() } else { format!("robot.{to}") });
    let path = path.to_str().unwrap();
    succeed(&["export", &robot(name), "--to", to, "-o", path]);
    imported(&[&[path, "--mass-kg-per-m", "0"], more].concat())
}

#[test]
fn an_exported_robot_of_springs_is_imported_with_the_same_statics() {
    // Fixed points; winches with pulleys, drum sides and stiffness; pulleys on fewer cables than freedoms; a point
    // mass.
    for (name, formats) in [
        ("yuan2014-4mm.toml", &["mujoco", "sdf"][..]),
        ("cogiro-winches.toml", &["mujoco"]),
        ("grab-4-cables.toml", &["mujoco"]),
        ("sap2000-8-cable-point-mass.toml", &["mujoco", "sdf"]),
        ("caroca.toml", &["mujoco", "sdf"]),
    ] {
        let of = std::fs::read_to_string(robot(name)).unwrap();
        let ours = json("statics", &of, &["--static-model", "spring"]);
        for to in formats {
            let found = json("statics", &there_and_back(name, to, &[]), &["--static-model", "spring"]);
            let what = format!("{name} by {to}");
            let place = |of: &Value| numbers(&of["pose"]["position_m"]);
            assert_close(&place(&found), &place(&ours), 1e-8, &what);
            let turn = |of: &Value| numbers(&of["pose"]["quaternion_wxyz"]);
            assert_close(&turn(&found), &turn(&ours), 1e-8, &what);
            let tensions = |of: &Value| -> Vec<f64> {
                let cables = of["cables"].as_array().unwrap();
                cables.iter().map(|cable| cable["tension_platform_n"].as_f64().unwrap()).collect()
            };
            let largest = tensions(&ours).into_iter().fold(0.0, f64::max);
            assert_close(&tensions(&found), &tensions(&ours), 1e-7 * largest, &what);
        }
    }
}

#[test]
fn an_exported_robot_for_viewers_is_imported_at_its_pose() {
    for name in ["yuan2014-4mm.toml", "nist-robocrane.toml", "kntu-planar.toml", "sap2000-8-cable-point-mass.toml"] {
        let text = there_and_back(name, "urdf", &["--axial-stiffness-n", "1e5"]);
        let given = std::fs::read_to_string(robot(name)).unwrap();
        let (ours, found) = (json("statics", &given, &["--static-model", "spring"]), json("check", &text, &[]));
        let reference = json("check", &given, &[]);
        assert_eq!(found["platform"]["motion"], reference["platform"]["motion"], "{name}");
        for (a, b) in found["cables"].as_array().unwrap().iter().zip(reference["cables"].as_array().unwrap()) {
            assert_close(&numbers(&a["anchor_m"]), &numbers(&b["anchor_m"]), 1e-12, name);
        }
        let pose = json("statics", &text, &["--static-model", "ideal"]);
        assert_close(&numbers(&pose["pose"]["position_m"]), &numbers(&ours["pose"]["position_m"]), 1e-12, name);
    }
}

/// Text of a model of Gazebo with one cable of a chain of joints, in the layout of `cdpr`, and two more of frames.
fn chain_of_joints(extra: &str) -> String {
    let mut text = String::from(
        "<sdf version='1.4'><model name='m'><pose>0 0 1 0 0 0</pose><link name='frame'/><link name='platform'>\
         <pose>0 0 0 0 0 1.5707963267948966</pose><inertial><mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy>\
         <izz>0.1</izz></inertia></inertial></link>",
    );
    for (i, (anchor, end)) in
        [("2 0 3", "0.1 0 0.2"), ("-1 2 3", "0 0.1 0.2"), ("-1 -2 3", "0 -0.1 0.2")].iter().enumerate()
    {
        let _ = write!(
            text,
            "<link name='cable{i}'><pose>0 0 2 0 0 0</pose></link><link name='X{i}'><pose>{anchor} 0 0 0</pose></link>\
             <link name='E{i}'><pose>{end} 0 0 0</pose></link>\
             <joint name='turn{i}' type='revolute'><parent>frame</parent><child>X{i}</child></joint>\
             <joint name='slide{i}' type='prismatic'><parent>X{i}</parent><child>cable{i}</child></joint>\
             <joint name='end{i}' type='revolute'><parent>platform</parent><child>E{i}</child></joint>\
             <joint name='spin{i}' type='revolute'><parent>cable{i}</parent><child>E{i}</child></joint>"
        );
    }
    text + extra + "<plugin name='winches' filename='a.so'/></model></sdf>"
}

/// Output of an import of a text in a file.
fn import_text(name: &str, text: &str, more: &[&str]) -> Output {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    import(&[&[path.to_str().unwrap()], more].concat())
}

#[test]
fn chains_of_joints_between_frame_and_platform_are_cables() {
    let output = import_text("m.sdf", &chain_of_joints(""), &ROPES);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("the plugin `winches`"), "{}", stderr(&output));
    let found = json("check", stdout(&output), &[]);
    let [first, ..] = &found["cables"].as_array().unwrap()[..] else { panic!("{found}") };
    assert_eq!(first["name"], "slide0");
    // The model stands 1 m high, and the platform has turned by a quarter.
    assert_close(&numbers(&first["anchor_m"]), &[2.0, 0.0, 4.0], 1e-12, "anchor");
    assert_close(&numbers(&first["attachment_m"]), &[0.0, -0.1, 0.2], 1e-12, "attachment");

    let second = "<joint name='more' type='revolute'><parent>frame</parent><child>cable0</child></joint>";
    let told = stderr(&import_text("m.sdf", &chain_of_joints(second), &ROPES)).to_owned();
    assert!(told.contains("the chain of the prismatic joint `slide0` has 2 ends on the frame and 1 on the"), "{told}");
}

/// Weight of 3 kg on three tendons, in degrees, with masses of geometries, nested bodies and a class.
const MJCF: &str =
    "<mujoco><compiler angle='degree'/><default><default class='rope'><tendon stiffness='1000'/></default>
 </default><worldbody><geom type='plane' size='1 1 1'/><body pos='0 0 3'><site name='a' pos='2 0 0'/>
 <body euler='0 0 120'><site name='b' pos='2 0 0'/></body><body quat='-0.5 0 0 0.8660254037844386'>
 <site name='c' pos='-2 0 0'/></body></body>
 <body name='p' pos='0 0 1'><joint type='slide' axis='1 0 0'/><joint type='slide' axis='0 1 0'/>
 <joint type='slide' axis='0 0 1'/><geom type='box' size='.1 .1 .1' mass='2'/><geom size='.1' mass='1'/>
 <site name='p'/></body></worldbody><tendon>
 <spatial class='rope' name='a' springlength='2.5'><site site='p'/><site site='a'/></spatial>
 <spatial class='rope' name='b' springlength='2.5'><site site='b'/><site site='p'/></spatial>
 <spatial class='rope' name='c' springlength='0 2.5'><site site='c'/><site site='p'/></spatial></tendon></mujoco>";

#[test]
fn a_model_of_mujoco_by_hand_rests_where_its_springs_carry_it() {
    let output = import_text("w.xml", MJCF, &["--mass-kg-per-m", "0"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let found = json("check", stdout(&output), &[]);
    let anchors: Vec<Vec<f64>> =
        found["cables"].as_array().unwrap().iter().map(|of| numbers(&of["anchor_m"])).collect();
    let side = 3.0_f64.sqrt();
    assert_close(&anchors.concat(), &[2.0, 0.0, 3.0, -1.0, side, 3.0, 1.0, side, 3.0], 1e-12, "anchors");
    assert_eq!((&found["platform"]["motion"], &found["platform"]["mass_kg"]), (&"point-mass".into(), &3.0.into()));

    // Three ropes at equal angles: the depth h is where 3 k (L − L₀) h / L is the weight.
    let even = MJCF.replace("quat='-0.5 0 0 0.8660254037844386'", "euler='0 0 60'");
    let robot = stdout(&import_text("w.xml", &even, &["--mass-kg-per-m", "0"])).to_owned();
    let place = numbers(&json("statics", &robot, &["--static-model", "spring"])["pose"]["position_m"]);
    let h = 3.0 - place[2];
    let length = h.hypot(2.0);
    assert!((3.0 * 1000.0 * (length - 2.5) * h / length - 3.0 * 9.81).abs() < 1e-6, "{place:?}");
    assert!(place[0].abs() < 1e-9 && place[1].abs() < 1e-9, "{place:?}");
}

#[test]
fn models_that_are_no_cable_robot_are_refused_with_their_place() {
    for (from, to, expected) in [
        (
            "springlength='2.5'><site site='p'/>",
            "springlength='2.5'><site site='q'/>",
            "the site `q` of the tendon is not",
        ),
        (
            "springlength='2.5'><site site='p'/>",
            "springlength='x'><site site='p'/>",
            "`springlength` of <spatial> holds `x`",
        ),
        ("springlength='2.5'><site site='p'/>", "><site site='p'/>", "a stiffness and no `springlength`"),
        (
            "<site site='p'/><site site='a'/>",
            "<site site='a'/><site site='p'/><site site='b'/>",
            "both ends on the frame",
        ),
        ("<site site='p'/><site site='a'/>", "<site site='a'/>", "fewer than two sites"),
        ("<site site='p'/><site site='a'/>", "<site site='p'/><pulley divisor='2'/><site site='a'/>", "several falls"),
        ("<site site='p'/><site site='a'/>", "<site site='p'/><geom geom='g'/><site site='a'/>", "the geometry `g` of"),
        ("<joint type='slide' axis='0 0 1'/>", "", "the joints of the body `p` are slide, slide"),
        ("mass='2'", "mass='-2'", "give --mass-kg"),
        ("angle='degree'", "angle='grad'", "MuJoCo knows degree and radian"),
        ("euler='0 0 120'", "euler='0 0'", "attribute `euler` of <body> holds 2 numbers"),
        ("<worldbody>", "<include file='a.xml'/><worldbody>", "the model includes another file"),
        ("<spatial class='rope' name='c'", "<fixed/><spatial class='rope' name='c'", "a tendon <fixed> couples joints"),
    ] {
        let text = MJCF.replacen(from, to, 1);
        assert_ne!(text, MJCF, "{from}");
        let text = if to == "mass='-2'" { text.replace("mass='1'", "mass='0'") } else { text };
        let output = import_text("w.xml", &text, &["--mass-kg-per-m", "0"]);
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{to}: {told}{}", stdout(&output));
        assert!(told.contains(expected) && told.lines().count() == 1, "{to}: {told}");
    }
    for (file, from, to, expected) in [
        ("tripod.yaml", "xyz: [0.1, -0.05, 1.5]", "xyz: [0.1, 1.5]", "`platform.position.xyz` holds 2 numbers"),
        ("tripod.yaml", "platform: [0.6928", "platfrom: [0.6928", "`points[1]` has no `platform`"),
        ("tripod.yaml", "mass: 60.0", "mass: sixty", "`platform.mass` is `sixty`, which is not a number"),
        ("tripod.yaml", "mass: 60.0", "weight: 60.0", "give --mass-kg"),
        ("tripod.yaml", "points:", "points: [", "not well-formed YAML"),
        ("tripod.yaml", "  mass: 60.0", "\tmass: 60.0", "not well-formed YAML"),
        ("tripod_grab.json", "\"pos_OD_glob\"", "\"pos_OD\"", "`actuator[1].pulley` has no `pos_OD_glob`"),
        ("tripod_grab.json", "THREE_R_THREE_T", "TWO_R_THREE_T", "only THREE_R_THREE_T"),
        ("tripod_grab.json", "\"active\": true", "\"active\": \"yes\"", "it must be true or false"),
        ("tripod_grab.json", "\"active\": true,", "\"active\": true", "not well-formed"),
        ("tripod.sdf", "<link name=\"platform\">", "<link name=\"box\">", "no link called `platform`"),
        ("tripod.sdf", "free_length>4.98", "free_length>-4.98", "it must be positive"),
        ("tripod.sdf", "body_B>platform", "body_B>hook", "the spring acts between"),
        ("tripod.sdf", "<pose>0.1 -0.05 1.5 0 0 0", "<pose>0.1 -0.05 1.5", "<pose> must hold six numbers"),
        (
            "tripod.urdf",
            "name=\"platform\" type=\"floating\"",
            "name=\"platform\" type=\"fixed\"",
            "no joint is floating",
        ),
        ("tripod.urdf", "child link=\"attachment_3\"", "child link=\"ring_3\"", "`anchor_3` has no partner"),
        ("tripod.urdf", "xyz=\"0.1 -0.05 1.5\"", "xyz=\"0.1 -0.05\"", "attribute `xyz` of <origin> holds 2 numbers"),
    ] {
        let more: &[&str] = if file == "tripod.sdf" { &ROPES[..2] } else { &ROPES };
        let output = Changed::of(&[file], &[(from, to)]).import(more);
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{file}, {to}: {told}{}", stdout(&output));
        assert!(told.contains(expected) && told.lines().count() == 1, "{file}, {to}: {told}");
    }
}
