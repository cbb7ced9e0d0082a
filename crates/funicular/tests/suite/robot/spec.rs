//! Robot files: broken ones are refused with one clear message at the right line.

use funicular::robot::{PlatformMotion, Robot};

/// File with lengths; each broken file below is this one with one change. Line 1 is `name`.
const ROBOT: &str = r#"name = "test robot"
source = "none"
gravity_m_s2 = [0.0, 0.0, -9.81]
[platform]
mass_kg = 10.0
inertia_kg_m2 = [
    [0.2, 0.0, 0.01],
    [0.0, 0.2, 0.0],
    [0.01, 0.0, 0.3],
]
center_of_mass_m = [0.0, 0.0, 0.1]
[materials.steel]
youngs_modulus_pa = 100e9
diameter_m = 0.004
mass_kg_per_m = 0.06
damping_ratio = 0.003
[materials.fibre]
axial_stiffness_n = 5e5
mass_kg_per_m = 0.01
[[cables]]
name = "left"
material = "steel"
anchor_m = [-3.0, 0.0, 4.0]
attachment_m = [-0.2, 0.0, 0.0]
unstrained_length_m = 4.0
[[cables]]
name = "right"
material = "fibre"
anchor_m = [3.0, 0.0, 4.0]
attachment_m = [0.2, 0.0, 0.0]
unstrained_length_m = 4.0
"#;

/// File with a pose instead; `[state]` is line 30.
fn robot_with_pose() -> String {
    let mut text = ROBOT.replace("unstrained_length_m = 4.0\n", "");
    text.push_str("[state]\nposition_m = [0.0, 0.0, 1.0]\nroll_pitch_yaw_deg = [0.0, 0.0, 0.0]\n");
    text
}

const YUAN: &str = funicular_robots::YUAN2014_4MM;

/// Point mass with a pose; `motion` is line 4, `[state]` line 13.
const POINT: &str = r#"name = "point"
[platform]
mass_kg = 1.0
motion = "point-mass"
center_of_mass_m = [0, 0, 0]
[materials.cord]
axial_stiffness_n = 1e4
mass_kg_per_m = 0.0
[[cables]]
name = "a"
material = "cord"
anchor_m = [0.0, 0.0, 2.0]
[state]
position_m = [0.0, 0.0, 1.0]
"#;

/// Broken file: the text to replace (its first occurrence), the new text, part of the message, the line.
type BrokenFile = (&'static str, &'static str, &'static str, &'static str, usize);

/// Changes `base` and checks that there is one message, with this text, at this line.
fn check(base: &str, cases: &[BrokenFile]) {
    Robot::from_toml(base).expect("the file is valid before the change");
    for (title, from, to, message, line) in cases {
        assert!(base.contains(from), "{title}: `{from}` is not in the file");
        let text = base.replacen(from, to, 1);
        let Err(error) = Robot::from_toml(&text) else { panic!("{title}: was accepted") };
        let [issue] = error.issues() else { panic!("{title}: more than one message:\n{error}") };
        assert!(issue.message.contains(message), "{title}: {}", issue.message);
        assert_eq!(issue.line, *line, "{title}: {error}");
        let place = text.get(issue.span.clone());
        assert!(place.is_some(), "{title}: the span {:?} is not in the text", issue.span);
        let shown = error.render("broken.toml", &text, false);
        assert!(shown.contains(&format!("broken.toml:{line}:{}", issue.column)), "{title}:\n{shown}");
        assert!(shown.contains('^') || shown.contains("|_"), "{title}: no caret\n{shown}");
    }
}

#[test]
fn what_is_not_toml_is_refused_at_its_line() {
    check(
        ROBOT,
        &[
            ("value missing", "mass_kg = 10.0", "mass_kg =", "not valid TOML", 5),
            ("unit after a number", "mass_kg = 10.0", "mass_kg = 10.0 kg", "not valid TOML", 5),
            ("decimal comma", "mass_kg = 10.0", "mass_kg = 10,0", "not valid TOML", 5),
            ("bracket missing", "[platform]", "[platform", "not valid TOML", 4),
            ("quote missing", "name = \"left\"", "name = \"left", "not valid TOML", 21),
            ("same key twice", "diameter_m = 0.004", "diameter_m = 0.004\ndiameter_m = 0.005", "duplicate key", 15),
            ("same table twice", "[materials.fibre]", "[materials.steel]", "duplicate key", 17),
            ("formula", "diameter_m = 0.004", "diameter_m = 4 * 1e-3", "not valid TOML", 14),
            ("array not closed", "[3.0, 0.0, 4.0]", "[3.0, 0.0, 4.0", "not valid TOML", 30),
            ("single brackets", "[[cables]]\nname = \"right\"", "[cables]\nname = \"right\"", "duplicate key", 26),
        ],
    );
}

#[test]
fn an_unknown_key_is_refused_where_it_stands() {
    check(
        ROBOT,
        &[
            ("misspelt", "mass_kg = 10.0", "mas_kg = 10.0", "unknown key `mas_kg` in [platform]", 5),
            ("without unit", "anchor_m = [3", "anchor = [3", "unknown key `anchor` in cable \"right\"", 29),
            ("other unit", "diameter_m = 0.004", "diameter_mm = 4", "unknown key `diameter_mm`", 14),
            ("British", "center_of_mass_m", "centre_of_mass_m", "unknown key `centre_of_mass_m`", 11),
            ("at the top", "source =", "sauce =", "unknown key `sauce` at the top of the file", 2),
            ("wrong table", "[platform]\n", "[platform]\nsource = 'x'\n", "unknown key `source` in [platform]", 5),
            ("unknown table", "[materials.fibre]", "[motors]\n[materials.fibre]", "unknown key `motors`", 17),
            (
                "length misspelt",
                "unstrained_length_m = 4.0\n[[",
                "unstrained_len_m = 4.0\n[[",
                "`unstrained_len_m`",
                25,
            ),
            (
                "modulus misspelt",
                "youngs_modulus_pa",
                "young_modulus_pa",
                "`young_modulus_pa` in [materials.steel]",
                13,
            ),
        ],
    );
}

#[test]
fn a_missing_key_is_reported_at_the_header_of_its_table() {
    check(
        ROBOT,
        &[
            ("robot name", "name = \"test robot\"\n", "", "the file has no `name`", 1),
            ("mass", "mass_kg = 10.0\n", "", "[platform] has no `mass_kg`", 4),
            ("rope mass", "mass_kg_per_m = 0.06\n", "", "[materials.steel] has no `mass_kg_per_m`", 12),
            ("modulus", "youngs_modulus_pa = 100e9\n", "", "no `youngs_modulus_pa`", 12),
            ("section", "diameter_m = 0.004\n", "", "neither `diameter_m` nor `area_m2`", 12),
            ("stiffness", "axial_stiffness_n = 5e5\n", "", "[materials.fibre] has no axial stiffness", 17),
            ("cable name", "name = \"right\"\n", "", "[[cables]] number 2 has no `name`", 26),
            ("material", "material = \"fibre\"\n", "", "cable \"right\" has no `material`", 26),
            ("anchor", "anchor_m = [-3.0, 0.0, 4.0]\n", "", "cable \"left\" has no `anchor_m`", 20),
            ("attachment", "attachment_m = [0.2, 0.0, 0.0]\n", "", "cable \"right\" has no `attachment_m`", 26),
            ("one length", "unstrained_length_m = 4.0\n[[", "[[", "cable \"left\" has no `unstrained_length_m`", 20),
        ],
    );
    let without = |from: &str, to: &str| {
        let (head, tail) = (ROBOT.split(from).next().unwrap(), ROBOT.find(to).map_or("", |at| &ROBOT[at..]));
        Robot::from_toml(&format!("{head}{tail}")).unwrap_err().to_string()
    };
    assert_eq!(without("[platform]", "[materials.steel]"), "line 1, column 1: the file has no `platform`");
    assert_eq!(without("[materials.steel]", "[[cables]]"), "line 1, column 1: the file has no `materials`");
    assert_eq!(without("[[cables]]", "nothing"), "line 1, column 1: the file has no `cables`");
}

#[test]
fn a_value_of_another_type_is_refused() {
    check(
        ROBOT,
        &[
            ("quoted number", "mass_kg = 10.0", "mass_kg = \"10.0\"", "`mass_kg` is text, it must be a number", 5),
            ("array for number", "mass_kg = 10.0", "mass_kg = [10.0]", "`mass_kg` is an array", 5),
            ("boolean", "diameter_m = 0.004", "diameter_m = true", "`diameter_m` is true or false", 14),
            ("date", "diameter_m = 0.004", "diameter_m = 2014-05-31", "`diameter_m` is a date", 14),
            ("number for name", "name = \"left\"", "name = 1", "`name` is a number, it must be text in quotes", 21),
            ("number for material", "\"fibre\"", "7", "`material` is a number", 28),
            ("number for vector", "[-3.0, 0.0, 4.0]", "4.0", "`anchor_m` is a number, it must be three numbers", 23),
            ("text in vector", "[-3.0, 0.0, 4.0]", "[-3.0, \"x\", 4.0]", "number 2 of `anchor_m` is text", 23),
            ("table in vector", "[-3.0, 0.0, 4.0]", "[{}, 0.0, 4.0]", "number 1 of `anchor_m` is a table", 23),
            ("source", "\"none\"", "[\"a\", \"b\"]", "`source` is an array", 2),
            ("gravity as a number", "[0.0, 0.0, -9.81]", "9.81", "`gravity_m_s2` is a number", 3),
            (
                "material as a number",
                "[materials.fibre]\n",
                "[materials]\nrope = 3\n[materials.fibre]\n",
                "`rope` is a num",
                18,
            ),
        ],
    );
    let single = Robot::from_toml("name = 'a'\n[cables]\nname = 'b'\n").unwrap_err();
    let issue = single.issues().iter().find(|issue| issue.line == 2).unwrap();
    assert_eq!(issue.message, "`cables` is a table, it must be an array of tables");
    assert_eq!(issue.help.as_deref(), Some("begin every cable with [[cables]], in double brackets"));
}

#[test]
fn an_array_of_another_length_is_refused() {
    check(
        ROBOT,
        &[
            ("plane anchor", "[3.0, 0.0, 4.0]", "[3.0, 4.0]", "`anchor_m` has 2 elements", 29),
            ("four numbers", "[0.2, 0.0, 0.0]", "[0.2, 0.0, 0.0, 1.0]", "`attachment_m` has 4 elements", 30),
            ("empty", "[0.0, 0.0, -9.81]", "[]", "`gravity_m_s2` has 0 elements", 3),
            ("two rows", "    [0.0, 0.2, 0.0],\n", "", "`inertia_kg_m2` has 2 elements", 6),
            ("short row", "[0.01, 0.0, 0.3]", "[0.01, 0.0]", "row 3 of `inertia_kg_m2` has 2 elements", 9),
            ("number for a row", "[0.0, 0.2, 0.0]", "0.2", "row 2 of `inertia_kg_m2` is a number", 8),
        ],
    );
}

#[test]
fn a_number_outside_its_limits_is_refused_at_the_number() {
    check(
        ROBOT,
        &[
            ("negative mass", "mass_kg = 10.0", "mass_kg = -10.0", "`mass_kg` is -10.0, it must be positive", 5),
            ("no mass", "mass_kg = 10.0", "mass_kg = 0", "`mass_kg` is 0, it must be positive", 5),
            ("mass nan", "mass_kg = 10.0", "mass_kg = nan", "`mass_kg` is nan, it must be finite", 5),
            ("mass inf", "mass_kg = 10.0", "mass_kg = +inf", "`mass_kg` is +inf, it must be finite", 5),
            ("huge mass", "mass_kg = 10.0", "mass_kg = 1e13", "`mass_kg` is 1e13, the limit is 1e12", 5),
            ("beyond f64", "mass_kg = 10.0", "mass_kg = 1e999", "1e999", 5),
            ("long integer", "mass_kg = 10.0", "mass_kg = 99999999999999999999", "the limit is 1e12", 5),
            ("tiny mass", "mass_kg = 10.0", "mass_kg = 1e-13", "it must be at least 1e-12", 5),
            ("no modulus", "100e9", "0.0", "`youngs_modulus_pa` is 0.0, it must be positive", 13),
            ("no diameter", "0.004", "0.0", "`diameter_m` is 0.0, it must be positive", 14),
            ("negative stiffness", "5e5", "-5e5", "`axial_stiffness_n` is -5e5", 18),
            ("stiffness out of the limits", "0.004", "1e6", "the axial stiffness is", 13),
            ("negative rope mass", "0.06", "-0.06", "it must not be negative", 15),
            ("tiny rope mass", "0.06", "1e-300", "it must be zero or at least 1e-12", 15),
            ("negative damping", "0.003", "-0.003", "it must not be negative", 16),
            ("damping in per cent", "0.003", "0.5", "`damping_ratio` is 0.5, it must be below 0.5", 16),
            ("zero length", "unstrained_length_m = 4.0\n[[", "unstrained_length_m = 0\n[[", "must be positive", 25),
            ("anchor nan", "[3.0, 0.0, 4.0]", "[3.0, nan, 4.0]", "number 2 of `anchor_m` is nan", 29),
            ("anchor -inf", "[3.0, 0.0, 4.0]", "[3.0, 0.0, -inf]", "number 3 of `anchor_m` is -inf", 29),
            ("anchor in ångström", "[3.0, 0.0, 4.0]", "[3e13, 0.0, 4.0]", "number 1 of `anchor_m` is 3e13", 29),
            ("gravity nan", "-9.81", "nan", "number 3 of `gravity_m_s2` is nan", 3),
            ("inertia nan", "[0.0, 0.2, 0.0]", "[0.0, nan, 0.0]", "number 2 of row 2 of `inertia_kg_m2` is nan", 8),
        ],
    );
}

#[test]
fn an_inertia_tensor_that_no_body_has_is_refused() {
    check(
        ROBOT,
        &[
            ("not symmetric", "[0.01, 0.0, 0.3]", "[-0.01, 0.0, 0.3]", "not symmetric: row 3, column 1 is -0.01", 9),
            ("negative moment", "[0.0, 0.2, 0.0]", "[0.0, -0.2, 0.0]", "not positive definite", 6),
            ("all zero", "[0.2, 0.0, 0.01]", "[0.0, 0.0, 0.01]", "not positive definite", 6),
            ("too long", "[0.01, 0.0, 0.3]", "[0.01, 0.0, 0.5]", "exceeds the sum of the others", 6),
        ],
    );
    let diagonal = |moments: &str| {
        let (head, rest) = ROBOT.split_once("inertia_kg_m2 = [\n").unwrap();
        let tail = rest.split_once("\n]\n").unwrap().1;
        Robot::from_toml(&format!("{head}inertia_kg_m2 = {moments}\n{tail}"))
    };
    assert!(diagonal("[0.15, 0.15, 0.25]").is_ok());
    let message = |moments| diagonal(moments).unwrap_err().to_string();
    assert_eq!(
        message("[0.1, 0.0, 0.1]"),
        "line 6, column 23: number 2 of `inertia_kg_m2` is 0.0, it must be positive"
    );
    assert_eq!(
        message("[0.1, 0.1, 0.5]"),
        "line 6, column 17: `inertia_kg_m2` fits no body: its principal moments are 0.1, 0.1 and 0.5 kg m², \
         and the largest exceeds the sum of the others"
    );
}

#[test]
fn two_ways_to_say_one_thing_are_refused_at_the_second() {
    check(
        ROBOT,
        &[
            (
                "EA and E",
                "axial_stiffness_n = 5e5",
                "axial_stiffness_n = 5e5\nyoungs_modulus_pa = 1e9",
                "does not go",
                19,
            ),
            (
                "EA and diameter",
                "axial_stiffness_n = 5e5",
                "axial_stiffness_n = 5e5\ndiameter_m = 0.01",
                "`diameter_m` d",
                19,
            ),
            (
                "diameter and area",
                "diameter_m = 0.004",
                "diameter_m = 0.004\narea_m2 = 1e-5",
                "`area_m2` does not go",
                15,
            ),
            (
                "area and diameter",
                "diameter_m = 0.004",
                "area_m2 = 1e-5\ndiameter_m = 0.004",
                "`diameter_m` does not",
                15,
            ),
            (
                "two dampings",
                "damping_ratio = 0.003",
                "damping_ratio = 0.003\nviscous_damping_n_s_m2 = 1",
                "viscous",
                17,
            ),
            ("pose and lengths", "[platform]", "[state]\nposition_m = [0, 0, 1]\n[platform]", "both a pose and", 4),
        ],
    );
}

#[test]
fn names_are_present_printable_and_unique() {
    check(
        ROBOT,
        &[
            ("empty robot name", "\"test robot\"", "\"\"", "`name` is empty", 1),
            ("blank cable name", "\"left\"", "\"  \"", "`name` is empty", 21),
            ("tab", "\"left\"", "\"le\\tft\"", "control character U+0009", 21),
            ("escape", "\"left\"", "\"\\u001b[31mleft\"", "control character U+001B", 21),
            ("turned text", "\"test robot\"", "\"a\\u202eb\"", "control character U+202E", 1),
            ("control character in source", "\"none\"", "\"no\\u0000ne\"", "control character U+0000", 2),
            ("same name", "\"right\"", "\"left\"", "two cables are called \"left\"", 27),
            (
                "material of no name",
                "[materials.fibre]",
                "[materials.\"\"]\naxial_stiffness_n = 1\nmass_kg_per_m = 0\n[materials.fibre]",
                "`material name` is empty",
                17,
            ),
            ("unknown material", "\"fibre\"", "\"fiber\"", "there is no material \"fiber\"", 28),
            ("other case", "\"steel\"", "\"Steel\"", "there is no material \"Steel\"", 22),
        ],
    );
}

#[test]
fn a_pose_is_checked_with_the_geometry() {
    check(
        &robot_with_pose(),
        &[
            ("no position", "position_m = [0.0, 0.0, 1.0]\n", "", "[state] has no `position_m`", 30),
            ("position in the plane", "[0.0, 0.0, 1.0]", "[0.0, 1.0]", "`position_m` has 2 elements", 31),
            (
                "angle inf",
                "roll_pitch_yaw_deg = [0.0",
                "roll_pitch_yaw_deg = [inf",
                "number 1 of `roll_pitch_yaw_deg`",
                32,
            ),
            ("radians", "roll_pitch_yaw_deg", "roll_pitch_yaw_rad", "unknown key `roll_pitch_yaw_rad` in [state]", 32),
            (
                "state as number",
                "[state]\nposition_m = [0.0, 0.0, 1.0]\nroll_pitch_yaw_deg = [0.0, 0.0, 0.0]\n",
                "state.position_m = 1\n",
                "unknown key `state` in cable",
                30,
            ),
            (
                "ends coincide",
                "anchor_m = [3.0, 0.0, 4.0]",
                "anchor_m = [0.2, 0.0, 1.0]",
                "cable \"right\" has no length",
                28,
            ),
        ],
    );
    // Turned by 90° the attachment (0.2, 0, 0) is at (0, 0.2, 0), up to rounding.
    let turned = robot_with_pose()
        .replace("_deg = [0.0, 0.0, 0.0]", "_deg = [0.0, 0.0, 90.0]")
        .replace("[3.0, 0.0, 4.0]", "[0.0, 0.2, 1.0]");
    assert!(
        Robot::from_toml(&turned).unwrap_err().to_string().contains("line 28, column 12: cable \"right\" has no len")
    );
}

#[test]
fn a_point_mass_has_neither_size_nor_orientation() {
    check(
        POINT,
        &[
            ("inertia", "mass_kg = 1.0", "mass_kg = 1.0\ninertia_kg_m2 = [1, 1, 1]", "has no inertia tensor", 4),
            ("centre of mass", "[0, 0, 0]", "[0, 0, 1]", "`center_of_mass_m` must be zero or absent", 5),
            (
                "attachment",
                "\"cord\"\n",
                "\"cord\"\nattachment_m = [0.1, 0, 0]\n",
                "`attachment_m` must be zero or",
                12,
            ),
            ("angles", "[state]\n", "[state]\nroll_pitch_yaw_deg = [0, 0, 1]\n", "has no orientation", 14),
            ("unknown word", "\"point-mass\"", "\"point\"", "`motion` is \"point\", which is unknown", 4),
            ("rigid without inertia", "\"point-mass\"", "\"rigid\"\ninertia_kg_m2 = [1,1,1]", "no `attachment_m`", 10),
        ],
    );
    let zero = POINT.replace("\"cord\"\n", "\"cord\"\nattachment_m = [0, 0.0, -0.0]\n");
    assert_eq!(Robot::from_toml(&zero).unwrap().platform.motion, PlatformMotion::PointMass);
}

#[test]
fn the_help_says_what_to_do() {
    let help = |from: &str, to: &str| {
        let error = Robot::from_toml(&ROBOT.replacen(from, to, 1)).unwrap_err();
        error.issues()[0].help.clone().unwrap_or_default()
    };
    assert_eq!(
        help("mass_kg = 10.0", "mas_kg = 10.0"),
        "did you mean `mass_kg`? keys here are `mass_kg`, `motion`, `plane_normal`, `plane_offset_m`, \
         `inertia_kg_m2`, `center_of_mass_m`, `drag_area_m2`, `translational_damping_n_s_m`, `rotational_damping_n_m_s`"
    );
    assert!(
        help("[platform]\n", "[platform]\ndamping_ratio = 0\n")
            .starts_with("`damping_ratio` belongs in [materials.NAME];")
    );
    assert_eq!(help("mass_kg = 10.0", ""), "add it, for example `mass_kg = 10.0`");
    assert_eq!(help("mass_kg = 10.0", "mass_kg = '10'"), "remove the quotes");
    assert_eq!(help("mass_kg = 10.0", "mass_kg = 0"), "give a number in this range, for example `mass_kg = 10.0`");
    assert_eq!(help("\"fibre\"", "\"fiber\""), "did you mean \"fibre\"? the file has \"fibre\", \"steel\"");
    assert_eq!(help("\"fibre\"", "\"zylon\""), "the file has \"fibre\", \"steel\"");
    assert!(help("0.003", "3").contains("not per cent"));
    assert!(help("mass_kg = 10.0", "mass_kg = 10.0 kg").starts_with("a value is one number without its unit"));
}

#[test]
fn a_decimal_comma_is_recognised() {
    let help = |from: &str, to: &str| {
        let error = Robot::from_toml(&ROBOT.replacen(from, to, 1)).unwrap_err();
        error.issues()[0].help.clone().unwrap_or_default()
    };
    let point = "write numbers with a decimal point, not a comma: 60.0";
    assert_eq!(help("mass_kg = 10.0", "mass_kg = 60,0"), point);
    assert_eq!(help("mass_kg = 10.0", "mass_kg = 1.060,5"), point);
    assert_eq!(help("[0.0, 0.0, 0.1]", "[0,0, 0,0, 0,1]"), point);
    // Other commas and other counts of numbers are no decimal commas.
    assert_ne!(help("mass_kg = 10.0", "mass_kg = 10.0,"), point);
    assert_ne!(help("[0.0, 0.0, 0.1]", "[0.0, 0.0, 0.1, 0.0]"), point);
    assert_ne!(help("mass_kg = 10.0", "mass_kg = ten # 1,5"), point);
}

#[test]
fn a_missing_inertia_is_proposed_for_a_box_with_the_size_of_the_attachments() {
    let robot = |attachments: [[f64; 3]; 3]| {
        let cable = |(i, attachment): (usize, &[f64; 3])| {
            format!(
                "[[cables]]\nname = \"{i}\"\nmaterial = \"fibre\"\nanchor_m = [{i}, 0, 4]\nattachment_m = \
                 {attachment:?}\n"
            )
        };
        let (head, _) = ROBOT.split_once("[[cables]]").unwrap();
        let (before, rest) = head.split_once("inertia_kg_m2").unwrap();
        let (_, after) = rest.split_once(",\n]\n").unwrap();
        format!("{before}{after}{}", attachments.iter().enumerate().map(cable).collect::<String>())
            .replace("mass_kg = 10.0", "mass_kg = 60.0")
    };
    let proposed = |text: &str| {
        let error = Robot::from_toml(text).unwrap_err();
        let issue = &error.issues()[0];
        assert_eq!(issue.message, "[platform] has no `inertia_kg_m2`", "{error}");
        let help = issue.help.clone().unwrap();
        let line = help.split('`').nth(1).unwrap().to_owned();
        (help, line)
    };

    // 60 kg and 1 × 0.8 × 0.5 m: 5 (0.64 + 0.25), 5 (1 + 0.25), 5 (1 + 0.64).
    let text = robot([[0.5, 0.4, 0.25], [-0.5, -0.4, -0.25], [0.0, 0.0, 0.0]]);
    let (help, line) = proposed(&text);
    assert_eq!(line, "inertia_kg_m2 = [4.45, 6.25, 8.2]");
    assert!(help.contains("a homogeneous box of 60 kg with the size of the attachments, 1 × 0.8 × 0.5 m"), "{help}");
    assert!(help.contains("starting value"), "{help}");

    // Boxes of odd and of no height are bodies too: the proposal is accepted.
    for attachments in [
        [[0.5, 0.4, 0.25], [-0.5, -0.4, -0.25], [0.0, 0.0, 0.0]],
        [[1.0 / 3.0, 0.123_456_7, 0.0], [-0.777_7, 0.0, 0.0], [0.0, -0.1, 0.0]],
        [[0.0, 1e3, 1.0], [0.0, -1e3, 0.0], [0.0, 0.0, 0.0]],
    ] {
        let text = robot(attachments);
        let (_, line) = proposed(&text);
        Robot::from_toml(&text.replace("mass_kg = 60.0", &format!("mass_kg = 60.0\n{line}"))).unwrap();
    }

    // Points on a line span no box.
    let (_, line) = proposed(&robot([[0.5, 0.0, 0.0], [-0.5, 0.0, 0.0], [0.0, 0.0, 0.0]]));
    assert_eq!(line, "inertia_kg_m2 = [0.1, 0.1, 0.2]");
}

/// Removes every key of complete files: the reader misses the keys that its table calls required, and no others.
#[test]
fn the_table_of_keys_says_which_keys_are_required() {
    use funicular::robot::spec::key::{Absent, KeyValue};
    use funicular::robot::spec::{TABLES, top_of_file};

    let file = robot_with_pose().replace("source = \"none\"", "# none")
        + "[loads]\nforce_n = [0, 0, 1]\nmoment_n_m = [0, 0, 1]\npoint_m = [0, 0, 1]\n\
           [wind]\nvelocity_m_s = [1, 0, 0]\nair_density_kg_m3 = 1.2\n\
           [required]\nforce_n = [1, 1, 1]\npayload_max_kg = 5\n[[required_loads]]\nforce_n = [0, 0, 1]\n\
           [pulleys.fibre]\nradius_m = 0.01\nentry_direction = [0, 0, 1]\n\
           [winches.fibre]\ndrum_side_length_m = 2\nshaft_stiffness_n_m_per_rad = 800\ndrum_radius_m = 0.05\n\
           [guide_wheels.fibre]\nwinch = \"fibre\"\ndistance_m = 1\nradius_m = 0.05\ninertia_kg_m2 = 0.001\n\
           [supports.fibre]\nstiffness_n_per_m = 1e6\nmass_kg = 20\n\
           [platform_bodies.fibre]\nsize_m = [1, 1, 1]\n[obstacles.fibre]\nsize_m = [1, 1, 1]\nposition_m = [50, 0, \
           0]\n\
           [clearance]\ncables_m = 0.1\nfrom_end_m = 0.1\n";
    let behind = "pulley = \"fibre\"\nwinch = \"fibre\"\nsupport = \"fibre\"\n";
    let file = file.replacen("[[cables]]\n", &format!("[[cables]]\n{behind}"), 1);
    Robot::from_toml(&file).unwrap();
    let mut tried = 0;
    for table in TABLES {
        for key in table
            .keys
            .iter()
            .filter(|key| !matches!(key.value, KeyValue::Table | KeyValue::Tables | KeyValue::NamedTables))
        {
            let header = table.header.replace("NAME", "fibre");
            let begin = if header.starts_with('[') { file.find(&header).unwrap() } else { 0 };
            let Some(at) = file[begin..].lines().position(|line| line.starts_with(&format!("{} =", key.name))) else {
                continue;
            };
            // Lines of another table do not count.
            if file[begin..].lines().skip(1).take(at).any(|line| line.starts_with('[')) {
                continue;
            }
            let line = file[begin..].lines().nth(at).unwrap();
            let without = format!("{}{}", &file[..begin], file[begin..].replacen(&format!("{line}\n"), "", 1));
            let misses = match Robot::from_toml(&without) {
                Ok(_) => false,
                Err(error) => {
                    error.to_string().contains(&format!("has no `{}`", key.name))
                        || matches!(key.absent, Absent::Depends(_))
                }
            };
            let says = matches!(key.absent, Absent::Refused | Absent::Depends(_));
            // A tensor stands in several lines and is tested above.
            if key.name != "inertia_kg_m2" {
                assert_eq!(misses, says, "`{}` of {}", key.name, table.header);
                tried += 1;
            }
        }
    }
    assert!(tried >= 23, "{tried}");

    for key in top_of_file().keys.iter().filter(|key| matches!(key.value, KeyValue::Table)) {
        let is_optional = ["loads", "required", "clearance", "wind", "state"].contains(&key.name);
        assert_eq!(key.absent != Absent::Refused, is_optional, "{}", key.name);
        assert_eq!(funicular::robot::parameters::is_optional_table(key.name), is_optional);
    }
}

#[test]
fn the_rendered_error_looks_as_a_user_expects() {
    let text = ROBOT.replace("\"right\"", "\"left\"").replace("mass_kg = 10.0", "mas_kg = 10.0");
    let shown = Robot::from_toml(&text).unwrap_err().render("robots/mine.toml", &text, false);
    let expected = r#"error: unknown key `mas_kg` in [platform]
 --> robots/mine.toml:5:1
  |
5 | mas_kg = 10.0
  | ^^^^^^
  |
  = help: did you mean `mass_kg`? keys here are `mass_kg`, `motion`, `plane_normal`, `plane_offset_m`, `inertia_kg_m2`, `center_of_mass_m`, `drag_area_m2`, `translational_damping_n_s_m`, `rotational_damping_n_m_s`

error: two cables are called "left"
  --> robots/mine.toml:27:8
   |
21 | name = "left"
   |        ------ the first is here
...
27 | name = "left"
   |        ^^^^^^
   |
   = help: results are listed by name: give every cable its own"#;
    assert_eq!(shown, expected);
}

#[test]
fn a_file_nested_without_end_is_refused_and_does_not_exhaust_the_stack() {
    let depth = 100_000;
    for text in [
        format!("a = {}", "[".repeat(depth)),
        format!("a = {}", "{a=".repeat(depth)),
        format!("a{} = 1", ".a".repeat(depth)),
        format!("[a{}]", ".a".repeat(depth)),
        format!("{}\n", "[".repeat(depth)),
        format!("name = 1\n{}", "[[cables]]\n".repeat(depth)),
    ] {
        let error = Robot::from_toml(&text).unwrap_err();
        assert!(!error.render("deep.toml", &text, false).is_empty());
    }
}

#[test]
fn limits_of_tension_are_read_and_those_of_a_cable_come_first() {
    let text = ROBOT
        .replace("damping_ratio = 0.003", "minimum_tension_n = 50\nmaximum_tension_n = 900\nbreaking_load_n = 5e3")
        .replacen("unstrained_length_m = 4.0", "unstrained_length_m = 4.0\nmaximum_tension_n = 700", 1);
    let robot = Robot::from_toml(&text).unwrap();
    let limits = robot.cables[0].limits();
    assert_eq!((limits.minimum, limits.maximum), (Some(50.0), Some(700.0)));
    assert_eq!(robot.cables[0].material.breaking_load, Some(5e3));
    let none = robot.cables[1].limits();
    assert_eq!((none.minimum, none.maximum), (None, None));
    // The breaking load is the maximum.
    let text = ROBOT.replace("damping_ratio = 0.003", "breaking_load_n = 5e3");
    assert_eq!(Robot::from_toml(&text).unwrap().cables[0].limits().maximum, Some(5e3));
}

#[test]
fn wrong_limits_of_tension_are_refused_at_their_line() {
    let limited = ROBOT
        .replace("damping_ratio = 0.003", "minimum_tension_n = 50\nmaximum_tension_n = 900\nbreaking_load_n = 5000")
        .replacen("unstrained_length_m = 4.0", "unstrained_length_m = 4.0\nminimum_tension_n = 60", 1);
    check(
        &limited,
        &[
            (
                "negative",
                "minimum_tension_n = 50",
                "minimum_tension_n = -1",
                "`minimum_tension_n` is -1, it must not",
                16,
            ),
            ("zero maximum", "maximum_tension_n = 900", "maximum_tension_n = 0", "it must be positive", 17),
            ("text", "breaking_load_n = 5000", "breaking_load_n = '5 kN'", "is text, it must be a number", 18),
            ("crossed", "minimum_tension_n = 50", "minimum_tension_n = 901", "is 901, it must be below", 16),
            ("crossed with the rope", "minimum_tension_n = 60", "minimum_tension_n = 900", "which is 900", 28),
            ("breaks", "maximum_tension_n = 900", "maximum_tension_n = 6000", "`breaking_load_n`, which is 5000", 17),
            ("breaks", "minimum_tension_n = 60", "maximum_tension_n = 6000", "is 6000, it must not be above", 28),
            ("of a rope only", "minimum_tension_n = 60", "breaking_load_n = 60", "unknown key `breaking_load_n`", 28),
        ],
    );
}

#[test]
fn wind_and_drag_are_read_and_refused_at_their_line() {
    let robot = Robot::from_toml(YUAN).unwrap();
    assert_eq!((robot.wind.velocity_w.norm(), robot.platform.drag_area), (0.0, 0.0));
    assert_eq!(robot.cables[0].material.drag_width, None);
    let with = |wind: &str, rope: &str| {
        format!("{}\n{wind}", YUAN.replacen("mass_kg_per_m", &format!("{rope}mass_kg_per_m"), 1))
    };
    let text = with(
        "[wind]\nvelocity_m_s = [3, 0, 4]\n",
        "drag_coefficient = 1.1\ndrag_diameter_m = 0.006\nload_n_per_m = [0, 0, -0.2]\n",
    );
    let robot = Robot::from_toml(&text).unwrap();
    assert!((robot.wind.velocity_w.norm() - 5.0).abs() < 1e-15 && (robot.wind.air_density - 1.225).abs() < 1e-15);
    assert!((robot.cables[3].material.drag_width.unwrap() - 1.1 * 0.006).abs() < 1e-18);
    assert!((robot.cables[3].load_per_length_w.z + 0.2).abs() < 1e-18);
    for (wind, rope, message) in [
        ("[wind]\nvelocity_m_s = [0, 0, 340]\n", "", "it must be at most 110 m/s"),
        ("[wind]\nvelocity_m_s = [1, 0, 0]\nair_density_kg_m3 = 0\n", "", "`air_density_kg_m3` is 0"),
        ("", "drag_coefficient = -1\n", "`drag_coefficient` is -1"),
        ("", "drag_diameter_m = 0.01\n", "has `drag_diameter_m`, but no `drag_coefficient`"),
        ("", "load_n_per_m = [1, 2]\n", "`load_n_per_m`"),
    ] {
        let error = Robot::from_toml(&with(wind, rope)).unwrap_err().to_string();
        assert!(error.contains(message), "{error}");
    }
}

#[test]
fn broken_loads_are_refused_at_their_line() {
    let camera = funicular_robots::SAP2000_8_CABLE_POINT_MASS;
    let loads = |text: &str| Robot::from_toml(&format!("{camera}\n[loads]\n{text}\n"));
    assert!(loads("force_n = [1, 2, 3]").is_ok());
    for (text, said) in [
        ("force_n = [1, 2]", "`force_n` has 2"),
        ("force = [1, 2, 3]", "unknown key `force`"),
        ("moment_n_m = [0, 0, 1]", "a point mass bears forces at its own point only"),
        ("point_m = [0, 0, 1]", "a point mass bears forces at its own point only"),
        ("force_n = [1, 2, inf]", "must be finite"),
    ] {
        let error = loads(text).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
}

/// Without a state the platform may hang far below an anchor at the origin.
#[test]
fn a_wheel_larger_than_the_robot_is_refused_and_one_of_a_robot_without_a_state_is_not() {
    let crane = |radius: &str, state: &str| {
        format!(
            "name = \"crane\"\n[platform]\nmass_kg = 1\nmotion = \"point-mass\"\n[materials.rope]\n\
             axial_stiffness_n = 1e5\nmass_kg_per_m = 0\n[pulleys.wheel]\nradius_m = {radius}\n\
             entry_direction = [0, 0, 1]\n[[cables]]\nname = \"only\"\nmaterial = \"rope\"\nanchor_m = [0, 0, 0.5]\n\
             pulley = \"wheel\"\n{state}"
        )
    };
    let state = "[state]\nposition_m = [0, 0, -60]\n";
    assert!(Robot::from_toml(&crane("3.0", state)).is_ok() && Robot::from_toml(&crane("3.0", "")).is_ok());
    for state in [state, ""] {
        let error = Robot::from_toml(&crane("3946.7", state)).unwrap_err().to_string();
        assert!(error.contains("radius_m") && error.contains("larger than the robot"), "{error}");
    }
}
