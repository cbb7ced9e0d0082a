//! Robots of the library, notes on what a file leaves open, and what is plausible although it is rare.

use super::{changed, check, hall, hall_with_drives, said, scaled, swapped};
use funicular::robot::{Pose, Robot, State};
use funicular::statics::{self, StaticModel};
use funicular::warnings;
use funicular::warnings::plausibility;

#[test]
fn slips_at_robots_of_the_library_are_named() {
    let mut misses = Vec::new();
    let mut slip = |slip: &str, text: String, expected: &[&str]| check(slip, &text, expected, &mut misses);

    // Lengths give the state, and E with the full circle the stiffness.
    let yuan = funicular_robots::YUAN2014_4MM;
    slip("yuan, E in GPa", scaled(yuan, "youngs_modulus_pa", 1e-9), &["GPa given as Pa"]);
    slip("yuan, rope in kg per 100 m", scaled(yuan, "mass_kg_per_m", 1e2), &["kg per 100 m"]);
    slip("yuan, lengths in mm", scaled(yuan, "unstrained_length_m", 1e3), &["unstrained lengths in mm"]);
    slip("yuan, lengths in km", scaled(yuan, "unstrained_length_m", 1e-3), &["unstrained lengths in km"]);
    slip("yuan, mass in g", scaled(yuan, "mass_kg", 1e3), &["mass in g given as kg"]);
    slip("yuan, mass in t", scaled(yuan, "mass_kg", 1e-3), &["mass in t given as kg"]);
    slip("yuan, anchors in mm", scaled(yuan, "anchor_m", 1e3), &["anchors in mm"]);
    slip("yuan, attachments in mm", scaled(yuan, "attachment_m", 1e3), &["attachments in mm"]);
    slip("yuan, ends swapped", swapped(yuan), &["swapped"]);

    // A point mass, and the stiffness itself.
    let camera = funicular_robots::STADIUM_CAMERA;
    slip("camera, EA in kN", scaled(camera, "axial_stiffness_n", 1e-3), &["axial stiffness in kN"]);
    slip("camera, rope in g/m", scaled(camera, "mass_kg_per_m", 1e3), &["mass in g/m"]);
    slip("camera, mass in t", scaled(camera, "mass_kg", 1e-3), &["platform in t"]);
    slip("camera, mass in g", scaled(camera, "mass_kg", 1e3), &["mass in g given as kg"]);
    slip("camera, limit in kN", scaled(camera, "maximum_tension_n", 1e-3), &["tension in kN"]);
    slip(
        "camera, breaking load in kN",
        scaled(&scaled(camera, "breaking_load_n", 1e-3), "maximum_tension_n", 0.01),
        &["breaking load in kN"],
    );
    slip("camera, anchors in mm", scaled(camera, "anchor_m", 1e3), &["lengths of the robot in mm"]);

    // A robot between anchors above and below, and one that moves in a horizontal plane.
    let ipanema = funicular_robots::IPANEMA2;
    slip("ipanema, E in MPa", scaled(ipanema, "youngs_modulus_pa", 1e-6), &["MPa (N/mm²) given as Pa"]);
    slip("ipanema, diameter in cm", scaled(ipanema, "diameter_m", 100.0), &["diameter in cm"]);
    slip("ipanema, limit in kN", scaled(ipanema, "maximum_tension_n", 1e-3), &["maximum tension in kN"]);
    slip("ipanema, mass in t", scaled(ipanema, "mass_kg", 1e-3), &["mass in t given as kg"]);
    let planar = funicular_robots::KNTU_PLANAR;
    slip("kntu, inertia times 1000", scaled(planar, "inertia_kg_m2", 1e3), &["inertia a factor of 1000 too large"]);
    slip(
        "kntu, all in mm",
        scaled(&scaled(planar, "anchor_m", 1e3), "attachment_m", 1e3),
        &["lengths of the robot in mm"],
    );

    assert!(misses.is_empty(), "{}", misses.join("\n"));
}

#[test]
fn no_robot_of_the_library_is_implausible() {
    for (name, text) in funicular_robots::ALL {
        let robot = Robot::from_toml(text).unwrap();
        // The source of these robots has cables without mass.
        if name.starts_with("grab-") {
            let notes = plausibility::notes(&robot);
            assert!(notes.len() == 2 && notes[0].starts_with("rope \"rope\": it has no mass"), "{name}: {notes:?}");
            assert!(notes[1].starts_with("nothing in the robot file damps vibration"), "{name}: {notes:?}");
            continue;
        }
        assert_eq!(said(&robot), "", "{name}");
        // The source of this robot says nothing of damping.
        let undamped = ["nothing in the robot file damps vibration"].map(str::to_owned);
        let expected = if name.starts_with("sap2000-") { &undamped[..] } else { &[] };
        let notes = plausibility::notes(&robot);
        let as_expected = notes.iter().zip(expected).all(|(note, expected)| note.starts_with(expected.as_str()));
        assert!(notes.len() == expected.len() && as_expected, "{name}: {notes:?}");
        // The pose of the lengths as the state.
        let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
        let at_pose = Robot { state: State::Pose(rest.pose), ..robot.clone() };
        assert_eq!(warnings::of_robot(&at_pose), [], "{name}");
        let without = Robot { state: State::Unknown, ..robot };
        assert_eq!(warnings::of_robot(&without), [], "{name}");
    }
}

#[test]
fn a_file_without_any_damping_has_a_note() {
    let notes = |text: &str| plausibility::notes(&Robot::from_toml(text).unwrap());
    let none = changed(&hall(), &[("damping_ratio = 0.003", "damping_ratio = 0.0")]);
    let found = notes(&none);
    assert!(found.len() == 1 && found[0].contains("nothing in the robot file damps vibration"), "{found:?}");
    // Any damping is enough: of the platform, a support or a winch.
    let platform = "drag_area_m2 = 0.5\nrotational_damping_n_m_s = [1.0, 1.0, 1.0]";
    assert!(notes(&changed(&none, &[("drag_area_m2 = 0.5", platform)])).is_empty());
    let support = "[supports.1]\nstiffness_n_per_m = 2e5\ndamping_ratio = 0.01\n[state]";
    let on_support = ("name = \"1\"\n", "name = \"1\"\nsupport = \"1\"\n");
    assert!(notes(&changed(&none, &[("[state]", support), on_support])).is_empty());
    let servo = changed(&hall_with_drives(), &[("damping_ratio = 0.003\n", "damping_ratio = 0.0\n")]);
    assert!(notes(&servo).is_empty());
}

#[test]
fn ropes_that_leave_a_doubt_have_a_note() {
    let circle = |modulus: &str| {
        let change = format!("youngs_modulus_pa = {modulus}\ndiameter_m = 0.006");
        let text = changed(&hall(), &[("youngs_modulus_pa = 100e9\narea_m2 = 14e-6", change.as_str())]);
        let robot = Robot::from_toml(&text).unwrap();
        (warnings::of_robot(&robot).len(), plausibility::notes(&robot))
    };
    // 0.13 kg/m fills 0.586 of the circle with steel.
    assert_eq!(circle("50e9"), (0, Vec::new()));
    let (warned, notes) = circle("75e9");
    assert!(warned == 0 && notes[0].contains("1.28e11 Pa over the metal"), "{notes:?}");
    assert_eq!((circle("100e9").0, circle("196e9").0), (1, 1));

    let massless = changed(&hall(), &[("mass_kg_per_m = 0.13", "mass_kg_per_m = 0.0")]);
    let notes = plausibility::notes(&Robot::from_toml(&massless).unwrap());
    assert!(notes[0].contains("has no mass"), "{notes:?}");
}

/// Forces of slings from one hook: the attachments are farther apart than the anchors.
#[test]
fn slings_from_one_hook_are_plausible() {
    let mut robot = Robot::from_toml(&hall()).unwrap();
    for (i, cable) in robot.cables.iter_mut().enumerate() {
        let angle = i as f64;
        cable.anchor = funicular::math::Vec3::new(0.01 * angle.cos(), 0.01 * angle.sin(), 8.0).into();
        cable.attachment_p *= 2.0;
    }
    robot.state = State::Pose(Pose::new([0.0, 0.0, 3.0], [0.0; 3]));
    assert_eq!(warnings::of_robot(&robot), []);
}

/// A request may give lengths of any number; statics refuses them, and the warnings come with the error.
#[test]
fn lengths_of_another_number_than_the_cables_are_no_panic() {
    let robot = Robot::from_toml(&hall()).unwrap();
    for lengths in [vec![], vec![12.0; 3], vec![12.0; 20]] {
        let robot = Robot { state: State::Lengths(lengths), ..robot.clone() };
        assert!(said(&robot).contains("unstrained lengths given for 8 cables"));
    }
}

/// Full turns are warned of up to the limit alone, and only for the pose that the angles were written for.
#[test]
fn a_full_turn_is_plausible_and_more_is_not() {
    for (written, expected) in [("360.0", 0), ("-360.0", 0), ("360.001", 1), ("-3600.0", 1)] {
        let text = changed(&hall(), &[("[0.0, 0.0, 2.0]", &format!("[0.0, 0.0, {written}]"))]);
        let robot = Robot::from_toml(&text).unwrap();
        assert_eq!(warnings::of_robot(&robot).len(), expected, "{written}");

        // Code sets another pose: the angles of the file are not its angles.
        let moved = Robot { state: State::Pose(Pose::new([0.0, 0.0, 3.0], [0.0, 0.0, 7.0])), ..robot };
        assert_eq!(warnings::of_robot(&moved), [], "{written}");
    }
}
