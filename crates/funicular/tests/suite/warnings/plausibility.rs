//! Slips of units and signs: each gives a warning that names it, and no usual robot gives one.

mod drives;
mod library;

use funicular::robot::Robot;
use funicular::statics::{self, StaticModel};
use funicular::warnings;
use funicular::warnings::plausibility::{self, Implausible};

/// Robot of a hall, 20 m x 12 m x 8 m: a platform of 1 m x 0.8 m x 0.5 m and 60 kg on eight wire ropes of 6 mm.
const HALL: &str = r#"
name = "hall"
source = "made for this test"
gravity_m_s2 = [0.0, 0.0, -9.81]

[platform]
mass_kg = 60.0
inertia_kg_m2 = [4.45, 6.25, 8.2]
center_of_mass_m = [0.0, 0.0, 0.02]
drag_area_m2 = 0.5

[loads]
force_n = [0.0, 0.0, -100.0]
moment_n_m = [1.0, 2.0, 0.0]
point_m = [0.1, 0.0, 0.25]

[wind]
velocity_m_s = [5.0, 0.0, 0.0]
air_density_kg_m3 = 1.2

[materials.rope]
youngs_modulus_pa = 100e9
area_m2 = 14e-6
mass_kg_per_m = 0.13
damping_ratio = 0.003
minimum_tension_n = 50.0
maximum_tension_n = 2000.0
breaking_load_n = 20e3
drag_coefficient = 1.2
drag_diameter_m = 0.006

[state]
position_m = [0.0, 0.0, 3.0]
roll_pitch_yaw_deg = [0.0, 0.0, 2.0]
"#;

/// Corners of the hall with the attachments: lower corners from above, upper corners from below.
fn hall() -> String {
    let mut text = HALL.to_owned();
    let mut number = 0;
    for (x, y) in [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)] {
        for (z, corner) in [(8.0, -0.25), (7.0, 0.25)] {
            number += 1;
            let cable = format!(
                "\n[[cables]]\nname = \"{number}\"\nmaterial = \"rope\"\nanchor_m = [{:.1}, {:.1}, {z:.1}]\n\
                 attachment_m = [{:.1}, {:.1}, {corner}]\n",
                10.0 * x,
                6.0 * y,
                0.5 * x * if z > 7.5 { 1.0 } else { -1.0 },
                0.4 * y * if z > 7.5 { -1.0 } else { 1.0 },
            );
            text.push_str(&cable);
        }
    }
    text
}

/// Hall with one more line for its rope.
fn hall_with(line: &str) -> String {
    changed(&hall(), &[("damping_ratio = 0.003", &format!("damping_ratio = 0.003\n{line}"))])
}

/// Hall with a pulley and a winch of every cable.
fn hall_with_drives() -> String {
    let drives = "[pulleys.wheel]\nradius_m = 0.05\nentry_direction = [0.0, 0.0, 1.0]\ninertia_kg_m2 = 0.0004\n\
                  swivel_inertia_kg_m2 = 0.001\nefficiency = 0.97\n[winches.drum]\ndrum_side_length_m = 5.0\n\
                  drum_radius_m = 0.0675\nstiffness_n_per_m = 200000.0\ndrum_inertia_kg_m2 = 0.02\n\
                  motor_inertia_kg_m2 = 0.0012\ngear_ratio = 5.0\ndamping_n_m_s_per_rad = 0.8\n\
                  control = \"position\"\nbandwidth_hz = 5.0\ncontrol_damping_ratio = 0.7\ndelay_s = 0.002\n\
                  gear_efficiency = 0.9\nmax_speed_m_s = 3.0\nmax_acceleration_m_s2 = 10.0\nmax_torque_n_m = 30.0\n\
                  max_power_w = 2000.0\ntorque_speed_rad_s = [0.0, 400.0]\ntorque_speed_n_m = [40.0, 20.0]\n\n[state]";
    changed(
        &hall(),
        &[
            // Indented, so that `scaled` changes the inertia of the wheel alone.
            ("inertia_kg_m2 = [4.45", "  inertia_kg_m2 = [4.45"),
            ("[state]", drives),
            ("material = \"rope\"\n", "material = \"rope\"\npulley = \"wheel\"\nwinch = \"drum\"\n"),
        ],
    )
}

/// Everything that a user sees who runs `statics`: warnings about the robot, and about its equilibrium or the error.
fn said(robot: &Robot) -> String {
    let mut all: Vec<String> = warnings::of_robot(robot).iter().map(ToString::to_string).collect();
    match statics::solve(robot, StaticModel::Catenary, None) {
        Ok(found) => {
            let of_equilibrium = warnings::of_plausibility(robot, &found.equilibrium);
            all.extend(of_equilibrium.iter().map(ToString::to_string));
        }
        Err(error) => all.push(format!("error: {error}")),
    }
    all.join("\n")
}

/// Robot file with a number of a key multiplied, in every line of the key.
fn scaled(text: &str, key: &str, factor: f64) -> String {
    let mut found = false;
    let lines = text.lines().map(|line| {
        let Some(values) = line.strip_prefix(&format!("{key} = ")) else { return line.to_owned() };
        found = true;
        let values = values.split('#').next().unwrap();
        let numbers: Vec<String> = values
            .trim()
            .trim_matches(['[', ']'])
            .split(',')
            .map(|number| (number.trim().parse::<f64>().unwrap() * factor).to_string())
            .map(|number| if number.contains('.') { number } else { number + ".0" })
            .collect();
        if values.contains('[') {
            format!("{key} = [{}]", numbers.join(", "))
        } else {
            format!("{key} = {}", numbers[0])
        }
    });
    let scaled = lines.collect::<Vec<_>>().join("\n");
    assert!(found, "{key}");
    scaled
}

/// Robot file with other words; every change is made.
fn changed(text: &str, changes: &[(&str, &str)]) -> String {
    changes.iter().fold(text.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

/// Robot file with the ends of all cables swapped.
fn swapped(text: &str) -> String {
    changed(text, &[("anchor_m", "other_m"), ("attachment_m", "anchor_m"), ("other_m", "attachment_m")])
}

fn check(slip: &str, text: &str, expected: &[&str], misses: &mut Vec<String>) {
    let robot = match Robot::from_toml(text) {
        Ok(robot) => robot,
        // The reader refuses the value, which is as good.
        Err(error) => {
            let help = error.issues().iter().filter_map(|issue| issue.help.clone());
            let text = std::iter::once(error.to_string()).chain(help).collect::<Vec<_>>().join("\n");
            if !expected.iter().all(|part| text.contains(part)) {
                misses.push(format!("{slip}: refused by {text}"));
            }
            return;
        }
    };
    let said = said(&robot);
    if !expected.iter().all(|part| said.contains(part)) {
        misses.push(format!("{slip}, expected {expected:?}:\n{said}\n"));
    }
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table of slips")]
fn slips_of_units_and_signs_are_named() {
    let hall = hall();
    let mut misses = Vec::new();
    let mut slip = |slip: &str, text: String, expected: &[&str]| check(slip, &text, expected, &mut misses);
    let times = |key: &str, factor: f64| scaled(&hall, key, factor);
    let stiffness = |value: &str| {
        changed(&hall, &[("youngs_modulus_pa = 100e9\narea_m2 = 14e-6", &format!("axial_stiffness_n = {value}"))])
    };
    let circle = |diameter: &str| changed(&hall, &[("area_m2 = 14e-6", &format!("diameter_m = {diameter}"))]);

    // Ropes.
    slip("E in GPa", times("youngs_modulus_pa", 1e-9), &["Young's modulus", "GPa given as Pa", "strain of cable"]);
    slip("E in MPa", times("youngs_modulus_pa", 1e-6), &["MPa (N/mm²) given as Pa"]);
    slip("E in kPa", times("youngs_modulus_pa", 1e-3), &["kPa given as Pa"]);
    slip(
        "E of the metal with the full circle",
        circle("0.006"),
        &["full circle", "Give the area of the metal as `area_m2`"],
    );
    slip("diameter in mm", circle("6.0"), &["axial stiffness", "check the units"]);
    slip("diameter in cm", circle("0.6"), &["diameter in cm given as m"]);
    slip("radius for diameter", circle("0.003"), &["radius given as diameter"]);
    slip("area in mm²", times("area_m2", 1e6), &["axial stiffness", "check the units"]);
    slip("area in cm²", times("area_m2", 1e4), &["area in cm²"]);
    slip("EA in kN", stiffness("1400.0"), &["axial stiffness in kN given as N"]);
    slip("EA in MN", stiffness("1.4"), &["axial stiffness in MN given as N"]);
    slip("E for EA", stiffness("100e9"), &["Young's modulus given as axial stiffness"]);
    slip("rope in g/m", times("mass_kg_per_m", 1e3), &["mass in g/m given as kg/m"]);
    slip("rope in kg per 100 m", times("mass_kg_per_m", 1e2), &["kg per 100 m given as kg/m"]);
    slip("rope in N/m", times("mass_kg_per_m", 9.81), &["weight in N/m"]);
    slip("rope in t/m", times("mass_kg_per_m", 1e-3), &["mass in t/m"]);
    slip("damping in per cent", times("damping_ratio", 100.0), &["damping ratio", "per cent given as a fraction"]);
    slip("damping over 100", times("damping_ratio", 0.01), &["divided by 100 once more"]);
    slip(
        "loss in per cent",
        hall_with("axial_loss_factor = 0.5"),
        &["axial_loss_factor", "per cent given as a fraction?"],
    );
    slip("loss over 100", hall_with("axial_loss_factor = 0.0002"), &["divided by 100 once more?"]);
    slip("loss above one", hall_with("axial_loss_factor = 2.0"), &["must be below 1", "2 % is 0.02"]);
    slip("damping time in ms", hall_with("axial_damping_time_s = 0.77"), &["milliseconds given as s?"]);
    slip("longer one in ms", hall_with("axial_damping_time_s = 5.0"), &["must be below 1 s", "0.8 ms is 0.8e-3"]);
    slip("one decay twice", hall_with("axial_loss_factor = 0.006"), &["one measured decay given twice?", "`identify`"]);
    slip("one decay, equal", hall_with("axial_loss_factor = 0.003"), &["one measured decay given twice?"]);
    slip(
        "breaking load in kN",
        changed(
            &times("breaking_load_n", 1e-3),
            &[
                ("maximum_tension_n = 2000.0", "maximum_tension_n = 10.0"),
                ("minimum_tension_n = 50.0", "minimum_tension_n = 5.0"),
            ],
        ),
        &["breaking load in kN"],
    );
    slip("breaking load in kgf", times("breaking_load_n", 1.0 / 9.81), &["breaking load in kgf"]);
    slip("drag diameter in mm", times("drag_diameter_m", 1e3), &["diameter in mm given as m"]);
    slip("drag coefficient in per cent", times("drag_coefficient", 100.0), &["drag coefficient", "per cent"]);

    // Tension limits.
    slip(
        "both limits in kN",
        scaled(&times("maximum_tension_n", 1e-3), "minimum_tension_n", 1e-3),
        &["maximum tension in kN", "minimum tension in kN"],
    );
    slip("minimum in kN", times("minimum_tension_n", 1e-3), &["minimum tension in kN"]);
    slip(
        "maximum in mN",
        changed(&times("maximum_tension_n", 1e3), &[("breaking_load_n = 20e3", "")]),
        &["tension in mN"],
    );

    // Geometry.
    let anchors = |factor: f64| scaled(&hall, "anchor_m", factor);
    let attachments = |factor: f64| scaled(&hall, "attachment_m", factor);
    slip("anchors in mm", anchors(1e3), &["farthest anchor", "anchors in mm or cm"]);
    slip("anchors in cm", anchors(1e2), &["anchors in mm or cm"]);
    slip("attachments in mm", attachments(1e3), &["attachments in mm"]);
    slip("attachments in cm", attachments(1e2), &["attachments in cm"]);
    slip(
        "all in mm",
        scaled(&scaled(&anchors(1e3), "attachment_m", 1e3), "position_m", 1e3),
        &["lengths of the robot in mm"],
    );
    slip("all in cm", scaled(&scaled(&anchors(1e2), "attachment_m", 1e2), "position_m", 1e2), &["mm or cm"]);
    slip("ends swapped", swapped(&hall), &["swapped", "no cable pulls against the load"]);
    slip("position in mm", times("position_m", 1e3), &["position in mm or cm given as m"]);
    slip(
        "yaw in rad",
        changed(&hall, &[("[0.0, 0.0, 2.0]", "[0.0, 0.0, 0.5236]")]),
        &["yaw is 0.5236°, which is 30° in radians"],
    );
    // 8° times 180/π.
    slip(
        "yaw in degrees converted to degrees",
        changed(&hall, &[("[0.0, 0.0, 2.0]", "[0.0, 0.0, 458.37]")]),
        &[
            "yaw of the pose is 458.4 degrees, usual is -360 to 360 degrees",
            "multiplied by 57.3",
            "Without its full turns it is 98.37 degrees",
        ],
    );
    slip(
        "pitch in arc minutes",
        changed(&hall, &[("[0.0, 0.0, 2.0]", "[0.0, -600.0, 0.0]")]),
        &["pitch of the pose is -600 degrees", "an angle in another unit"],
    );
    slip(
        "pose above the anchors",
        changed(&hall, &[("position_m = [0.0, 0.0, 3.0]", "position_m = [0.0, 0.0, 12.0]")]),
        &["all cables pull down", "no anchor is above"],
    );
    slip("sign of an anchor's height", hall.replacen("6.0, 8.0]", "6.0, -8.0]", 1), &["wrong sign of the coordinate"]);
    slip(
        "sign of an anchor",
        hall.replacen("[10.0, 6.0, 8.0]", "[-10.0, 6.0, 8.0]", 1),
        &["have the same `anchor_m`", "wrong sign"],
    );
    slip(
        "sign of an attachment",
        hall.replacen("attachment_m = [0.5, -0.4, -0.25]", "attachment_m = [-0.5, -0.4, -0.25]", 1),
        &["have the same `attachment_m`", "wrong sign"],
    );

    // Platform.
    slip("mass in g", times("mass_kg", 1e3), &["mass in g given as kg"]);
    slip("mass in t", times("mass_kg", 1e-3), &["mass in t given as kg"]);
    slip("inertia times 1000", times("inertia_kg_m2", 1e3), &["inertia a factor of 1000 too large"]);
    slip("inertia in kg mm²", times("inertia_kg_m2", 1e6), &["inertia in kg mm²"]);
    slip("inertia in kg cm²", times("inertia_kg_m2", 1e4), &["inertia in kg cm²"]);
    slip("inertia in t m²", times("inertia_kg_m2", 1e-3), &["inertia a factor of 1000 too small"]);
    slip(
        "centre of mass in mm",
        changed(&hall, &[("[0.0, 0.0, 0.02]", "[0.0, 0.0, 20.0]")]),
        &["`center_of_mass_m` in mm"],
    );

    // Gravity and loads.
    slip("gravity up", changed(&hall, &[("-9.81]", "9.81]")]), &["wrong sign of gravity", "gravity_m_s2` points up"]);
    slip("gravity in cm/s²", changed(&hall, &[("-9.81]", "-981.0]")]), &["in cm/s²"]);
    slip("gravity in mm/s²", changed(&hall, &[("-9.81]", "-9810.0]")]), &["in mm/s²"]);
    slip("gravity in g", changed(&hall, &[("-9.81]", "-1.0]")]), &["in units of g"]);
    slip("gravity in ft/s²", changed(&hall, &[("-9.81]", "-32.17]")]), &["in ft/s²"]);
    slip(
        "gravity along y",
        changed(
            &hall,
            &[
                ("[0.0, 0.0, -9.81]", "[0.0, -9.81, 0.0]"),
                ("force_n = [0.0, 0.0, -100.0]", "force_n = [0.0, 0.0, 0.0]"),
            ],
        ),
        &["perpendicular to z", "gravity along -z meant?", "no cable can", "pull the platform along"],
    );
    slip("force up", changed(&hall, &[("[0.0, 0.0, -100.0]", "[0.0, 0.0, 1000.0]")]), &["the load lifts the platform"]);
    slip("force in mN", times("force_n", 1e3), &["force in mN"]);
    slip("moment in N mm", times("moment_n_m", 1e5), &["moment in N mm"]);
    slip("point in mm", times("point_m", 1e3), &["`point_m` in mm"]);
    slip("wind in km/h", times("velocity_m_s", 20.0), &["km/h given as m/s"]);
    slip("density of air in g/cm³", times("air_density_kg_m3", 1e-3), &["g/cm³ given as kg/m³"]);
    slip("drag area in cm²", times("drag_area_m2", 1e4), &["cm² given as m²"]);

    assert!(misses.is_empty(), "{}", misses.join("\n"));
    assert_eq!(said(&Robot::from_toml(&hall).unwrap()), "", "the robot itself is plausible");
}

/// Slips at one cable, values in another frame, weights counted twice, and other slips of one key.
#[test]
#[expect(clippy::too_many_lines, reason = "one list of slips")]
fn slips_of_single_values_are_named() {
    let hall = hall();
    let mut misses = Vec::new();
    let mut slip = |slip: &str, text: String, expected: &[&str]| check(slip, &text, expected, &mut misses);

    // Ropes.
    let circle = |modulus: &str| {
        changed(
            &hall,
            &[(
                "youngs_modulus_pa = 100e9\narea_m2 = 14e-6",
                &format!("youngs_modulus_pa = {modulus}\narea_m2 = 28.27e-6"),
            )],
        )
    };
    slip(
        "area of the full circle with E of the metal",
        circle("100e9"),
        &["full circle of `area_m2`", "Give the area"],
    );
    slip(
        "mass of the complete cable",
        scaled(&hall, "mass_kg_per_m", 12.0),
        &["density", "mass of the complete cable given per metre"],
    );
    let load = |load: &str| {
        changed(&hall, &[("damping_ratio = 0.003", &format!("damping_ratio = 0.003\nload_n_per_m = {load}"))])
    };
    slip("rope's weight twice", load("[0.0, 0.0, -1.2753]"), &["weight of the rope: weight counted twice"]);
    slip("ice upwards", load("[0.0, 0.0, 4.0]"), &["upward load", "wrong sign of `load_n_per_m`"]);

    // One cable.
    let (anchor, attachment) = ("anchor_m = [10.0, 6.0, 8.0]", "attachment_m = [0.5, -0.4, -0.25]");
    slip(
        "ends of one cable swapped",
        changed(
            &hall,
            &[(&format!("{anchor}\n{attachment}"), "anchor_m = [0.5, -0.4, -0.25]\nattachment_m = [10.0, 6.0, 8.0]")],
        ),
        &["the attachment of cable \"1\" is among the anchors", "of this cable swapped"],
    );
    slip(
        "one attachment in mm",
        changed(&hall, &[(attachment, "attachment_m = [500.0, -400.0, -250.0]")]),
        &["attachment of cable \"1\"", "`attachment_m` of this cable in mm"],
    );
    slip(
        "one anchor in mm",
        changed(&hall, &[(anchor, "anchor_m = [10000.0, 6000.0, 8000.0]")]),
        &["anchor of cable \"1\"", "`anchor_m` of this cable in mm"],
    );
    slip(
        "a copied cable",
        changed(
            &hall,
            &[("anchor_m = [-10.0, 6.0, 8.0]\nattachment_m = [-0.5, -0.4, -0.25]", &format!("{anchor}\n{attachment}"))],
        ),
        &["cables \"1\" and \"3\" have the same `anchor_m` and the same `attachment_m`", "copied cable"],
    );

    // Another frame or another point.
    let mut in_world = hall.clone();
    for (x, y) in [("0.5", "0.4"), ("0.5", "-0.4"), ("-0.5", "0.4"), ("-0.5", "-0.4")] {
        for (z, there) in [("-0.25", "2.75"), ("0.25", "3.25")] {
            in_world = in_world
                .replace(&format!("attachment_m = [{x}, {y}, {z}]"), &format!("attachment_m = [{x}, {y}, {there}]"));
        }
    }
    slip("attachments in the world frame", in_world, &["position of the platform in the world", "in the world frame?"]);
    let higher = changed(&hall, &[("position_m = [0.0, 0.0, 3.0]", "position_m = [8.0, 3.0, 5.0]")]);
    slip(
        "centre of mass in the world frame",
        changed(&higher, &[("[0.0, 0.0, 0.02]", "[8.0, 3.0, 5.02]")]),
        &["`center_of_mass_m` given in the world frame?"],
    );
    slip(
        "inertia about the origin of the world",
        changed(&hall, &[("[4.45, 6.25, 8.2]", "[544.45, 546.25, 8.2]")]),
        &["inertia about the origin of the world"],
    );
    slip("inertia in g cm²", scaled(&hall, "inertia_kg_m2", 1e7), &["inertia in g cm²"]);
    slip("inertia over mass", scaled(&hall, "inertia_kg_m2", 1.0 / 60.0), &["inertia divided by the mass"]);
    let damped = |key: &str, value: &str| {
        changed(&hall, &[("drag_area_m2 = 0.5", &format!("drag_area_m2 = 0.5\n{key} = [{value}, {value}, {value}]"))])
    };
    slip(
        "damping ratio in N s/m",
        damped("translational_damping_n_s_m", "0.003"),
        &["`translational_damping_n_s_m`", "a damping ratio given as damping?"],
    );
    slip(
        "stiffness as damping",
        damped("rotational_damping_n_m_s", "5000.0"),
        &["`rotational_damping_n_m_s`", "a stiffness", "given as damping?"],
    );

    // Loads.
    slip(
        "weight twice",
        changed(&hall, &[("[0.0, 0.0, -100.0]", "[0.0, 0.0, -588.4]")]),
        &["weight of the platform: weight counted twice"],
    );
    slip(
        "weight twice, with three digits",
        changed(&hall, &[("[0.0, 0.0, -100.0]", "[0.0, 0.0, -588.0]")]),
        &["weight of the platform: weight counted twice"],
    );
    slip("moment in N mm", scaled(&hall, "moment_n_m", 5e3), &["moment in N mm"]);

    assert!(misses.is_empty(), "{}", misses.join("\n"));

    // Values near these slips that are right.
    for (what, text) in [
        ("modulus and area of the full circle", circle("50e9")),
        ("ice", load("[0.0, 0.0, -4.0]")),
        ("loss of a fibre rope", hall_with("axial_loss_factor = 0.02")),
        ("damping time of a fibre rope", hall_with("axial_damping_time_s = 0.8e-3")),
        ("a rope that floats", load("[0.0, 0.0, 0.2]")),
        ("damping of guides", damped("translational_damping_n_s_m", "30.0")),
        ("payload", changed(&hall, &[("[0.0, 0.0, -100.0]", "[0.0, 0.0, -500.0]")])),
    ] {
        assert_eq!(said(&Robot::from_toml(&text).unwrap()), "", "{what}");
    }
}

/// A hint names no slip that would have made the value larger where it is too small, or smaller where it is too large.
#[test]
fn hints_name_slips_of_the_right_direction_alone() {
    let lines = |ea: &str| {
        format!(
            "name = \"two lines\"\n[platform]\nmass_kg = 2.0\nmotion = \
             \"point-mass\"\n[materials.rope]\naxial_stiffness_n = {ea}\n\
             mass_kg_per_m = 0.14\n[[cables]]\nname = \"1\"\nmaterial = \"rope\"\nanchor_m = [-2.0, 0.0, 2.0]\n\
             unstrained_length_m = 2.4\n[[cables]]\nname = \"2\"\nmaterial = \"rope\"\nanchor_m = [2.0, 0.0, 2.0]\n\
             unstrained_length_m = 2.4\n"
        )
    };
    let hint = |text: &str| {
        let found = plausibility::of_robot(&Robot::from_toml(text).unwrap());
        let [Implausible::OutOfRange { slip, .. }] = &found[..] else { panic!("{found:?}") };
        slip.clone()
    };

    // 7.1e8 and 5.0e9 m²/s² are above the usual range, 1.4e5 is below.
    let too_stiff = "axial stiffness in mN given as N, or mass in t/m given as kg/m?";
    assert!(hint(&lines("1e8")).starts_with(too_stiff), "{}", hint(&lines("1e8")));
    assert!(hint(&lines("7e8")).starts_with(too_stiff), "{}", hint(&lines("7e8")));
    assert!(hint(&lines("1e11")).starts_with("Young's modulus given as axial stiffness, without the area?"));
    assert!(hint(&lines("2e4")).starts_with("mass in kg per 100 m given as kg/m, or axial stiffness in kN"));

    // Values on either side of ranges with two ends.
    let (hall, drives) = (hall(), hall_with_drives());
    for (key, text, small, large) in [
        ("drag_coefficient", &hall, "coefficient times diameter?", "a coefficient in per cent?"),
        ("air_density_kg_m3", &hall, "g/cm³ given as kg/m³?", "g/m³ given as kg/m³?"),
        ("drag_diameter_m", &hall, "a slip of its unit or of the decimal point?", "diameter in"),
        ("breaking_load_n", &hall, "breaking load in kN", "breaking load in mN"),
        ("gear_ratio", &drives, "turns of the drum", "a slip of its unit"),
        ("bandwidth_hz", &drives, "gain in kN m given as N m?", "gain in N mm given as N m"),
    ] {
        // Tension limits are out of the way of the breaking load.
        let text = text.replace("maximum_tension_n = 2000.0", "").replace("minimum_tension_n = 50.0", "");
        for (factor, expected) in [(1e-3, small), (1e3, large)] {
            let said = said(&Robot::from_toml(&scaled(&text, key, factor)).unwrap());
            assert!(said.contains(&format!(": {expected}")), "{key} times {factor}: {said}");
        }
    }
    // The reader refuses ratios from 0.5 on.
    for (factor, expected) in
        [(1e-2, ": a fraction divided by 100 once more?"), (1e2, ": per cent given as a fraction?")]
    {
        let said = said(&Robot::from_toml(&scaled(&hall, "damping_ratio", factor)).unwrap());
        assert!(said.contains(expected), "damping_ratio times {factor}: {said}");
    }
}

/// At a pose that straight cables cannot hold, cables of 17 times the distance of their ends balance the platform.
#[test]
fn cables_that_balance_only_far_below_their_ends_are_named() {
    let text = r#"
name = "camera on three pairs of cables"

[platform]
mass_kg = 45.0
inertia_kg_m2 = [2.1, 2.3, 1.6]
center_of_mass_m = [0.0, 0.0, -0.25]

[materials.hmpe]
axial_stiffness_n = 0.9e6
mass_kg_per_m = 0.021

[state]
position_m = [0.0, 5.0, 12.0]
"#;
    let vertices = |y: f64, front: f64| [[-0.6, y], [0.0, front], [0.0, front], [0.6, y], [0.6, y], [-0.6, y]];
    let masts = [[-45.0, 30.0], [-45.0, 30.0], [45.0, 30.0], [45.0, 30.0], [0.0, -35.0], [0.0, -35.0]];
    let file = |vertices: [[f64; 2]; 6]| {
        let cables = masts.iter().zip(vertices).enumerate().map(|(i, ([x, y], [u, v]))| {
            format!(
                "\n[[cables]]\nname = \"{i}\"\nmaterial = \"hmpe\"\nanchor_m = [{x:.1}, {y:.1}, 28.0]\n\
                 attachment_m = [{u:.2}, {v:.2}, 0.3]\n"
            )
        });
        format!("{text}{}", cables.collect::<String>())
    };

    // The centre of mass lies outside the triangle of the attachments, then inside.
    let hanging = said(&Robot::from_toml(&file(vertices(0.15, 0.5))).unwrap());
    assert!(hanging.contains("over the distance of its ends is 17"), "{hanging}");
    assert!(hanging.contains("straight it would be slack or have to push"), "{hanging}");
    assert_eq!(said(&Robot::from_toml(&file(vertices(-0.35, 0.7))).unwrap()), "");

    // One length in feet.
    let feet =
        changed(funicular_robots::YUAN2014_4MM, &[("unstrained_length_m = 6.863", "unstrained_length_m = 22.516")]);
    let said = said(&Robot::from_toml(&feet).unwrap());
    assert!(said.contains("unstrained length of cable \"1\"") && said.contains("too long"), "{said}");
}
