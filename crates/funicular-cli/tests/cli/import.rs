//! Tests of `import`: one robot from every format, required options, losses and assumptions.

mod refused;
mod simulators;

use super::{run, stderr, stdout};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

const ROPES: [&str; 4] = ["--mass-kg-per-m", "0.05", "--axial-stiffness-n", "1e6"];

/// Path of an example of docs/import/.
fn example(name: &str) -> String {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "..", "..", "docs", "import", name].iter().collect();
    path.to_str().expect("the path is text").to_owned()
}

fn example_text(name: &str) -> String {
    fs::read_to_string(example(name)).unwrap()
}

/// The examples of CASPR, WireX and MoorDyn.
fn caspr() -> [String; 2] {
    [example("tripod_bodies.xml"), example("tripod_cables.xml")]
}

fn import(arguments: &[&str]) -> Output {
    run(&[&["import"], arguments].concat())
}

/// The robot file of an import that succeeds.
fn imported(arguments: &[&str]) -> String {
    let output = import(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    stdout(&output).to_owned()
}

/// Results of `funicular COMMAND - …` for a robot file.
fn json(command: &str, robot: &str, more: &[&str]) -> Value {
    let arguments = [&[command, "-", "--format", "json"], more].concat();
    let output = super::run_with(&arguments, robot);
    assert_eq!(output.status.code(), Some(0), "{command}: {}\n{robot}", stderr(&output));
    serde_json::from_str(stdout(&output)).unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

fn assert_close(a: &[f64], b: &[f64], tolerance: f64, what: &str) {
    assert_eq!(a.len(), b.len(), "{what}");
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance), "{what}: {a:?} and {b:?}");
}

/// Example with changes, in a separate folder.
struct Changed {
    folder: tempfile::TempDir,
}

impl Changed {
    fn of(files: &[&str], changes: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mut found = vec![false; changes.len()];
        for file in files {
            let mut text = example_text(file);
            for ((from, to), found) in changes.iter().zip(&mut found) {
                *found |= text.contains(from);
                text = text.replacen(from, to, 1);
            }
            fs::write(folder.path().join(file), text).unwrap();
        }
        assert!(found.iter().all(|found| *found), "every change is made: {changes:?}");
        Self { folder }
    }

    fn import(&self, more: &[&str]) -> Output {
        let mut files: Vec<String> = fs::read_dir(self.folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().path().to_str().unwrap().to_owned())
            .collect();
        files.sort();
        let files: Vec<&str> = files.iter().map(String::as_str).collect();
        import(&[&files[..], more].concat())
    }

    fn imported(&self, more: &[&str]) -> String {
        let output = self.import(more);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        stdout(&output).to_owned()
    }
}

const CASPR: [&str; 2] = ["tripod_bodies.xml", "tripod_cables.xml"];

#[test]
fn one_robot_is_the_same_in_every_format() {
    let [bodies, cables] = caspr();
    let ideal = imported(&[&[bodies.as_str(), &cables], &ROPES[..]].concat());
    let reference = json("check", &ideal, &[]);
    assert_eq!(reference["warnings"].as_array().unwrap().len(), 0, "{}", reference["warnings"]);
    let pose = "0.1,-0.05,1.5,0,0,0";
    for (what, arguments) in [
        ("order", [&[cables.as_str(), &bodies], &ROPES[..]].concat()),
        ("springs", vec![&cables, &bodies, "--cable-set", "springs", "--mass-kg-per-m", "0.05"]),
        ("WireX", vec![&example("tripod.wcrfx"), "--axial-stiffness-n", "1e6", "--pose", pose]),
        ("MoorDyn", vec![&example("tripod.txt")]),
    ] {
        let text = imported(&arguments);
        let robot = json("check", &text, &[]);
        // Imported robots are plausible, and so are their equilibria.
        for found in [&robot, &json("statics", &text, &[])] {
            assert_eq!(found["warnings"].as_array().unwrap().len(), 0, "{what}: {}", found["warnings"]);
        }
        for key in ["mass_kg", "inertia_kg_m2", "center_of_mass_m"] {
            assert_eq!(robot["platform"][key], reference["platform"][key], "{what}: {key}");
        }
        assert_eq!(robot["gravity_m_s2"], reference["gravity_m_s2"], "{what}");
        for (a, b) in robot["cables"].as_array().unwrap().iter().zip(reference["cables"].as_array().unwrap()) {
            assert_eq!((&a["name"], &a["anchor_m"]), (&b["name"], &b["anchor_m"]), "{what}");
            // The shift from the centre of mass and back only causes rounding errors.
            assert_close(&numbers(&a["attachment_m"]), &numbers(&b["attachment_m"]), 1e-15, what);
        }
        assert_eq!(robot["materials"][0]["axial_stiffness_n"], 1e6, "{what}");
        assert_eq!(robot["materials"][0]["mass_kg_per_m"], 0.05, "{what}");
    }
    // Values of the file of cables.
    let fourth = &reference["cables"][3];
    assert_eq!(numbers(&fourth["anchor_m"]), [-3.3891, -2.1299, 5.03]);
    assert_eq!(numbers(&fourth["attachment_m"]), [0.0, -0.8, 0.1]);
}

#[test]
fn the_home_pose_is_that_of_the_source_with_tensions_in_equilibrium() {
    let [bodies, cables] = caspr();
    let robot = imported(&[&[bodies.as_str(), &cables], &ROPES[..]].concat());
    let found = json("statics", &robot, &[]);
    assert_close(&numbers(&found["pose"]["position_m"]), &[0.1, -0.05, 1.5], 1e-14, "position");
    // q_initial 0.02, -0.03, 0.05 rad is Rx Ry Rz: the quaternion of that product, written out.
    let half = |angle: f64| ((angle / 2.0).cos(), (angle / 2.0).sin());
    let ((cx, sx), (cy, sy), (cz, sz)) = (half(0.02), half(-0.03), half(0.05));
    let quaternion = [
        cx * cy * cz - sx * sy * sz,
        sx * cy * cz + cx * sy * sz,
        cx * sy * cz - sx * cy * sz,
        cx * cy * sz + sx * sy * cz,
    ];
    assert_close(&numbers(&found["pose"]["quaternion_wxyz"]), &quaternion, 1e-15, "orientation");

    let turn = |v: &[f64]| {
        let [w, x, y, z] = quaternion;
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let t = cross([x, y, z], [v[0], v[1], v[2]]).map(|c| 2.0 * c);
        let u = cross([x, y, z], t);
        [v[0] + w * t[0] + u[0], v[1] + w * t[1] + u[1], v[2] + w * t[2] + u[2]]
    };
    let moment = |arm: [f64; 3], force: &[f64]| {
        [
            arm[1] * force[2] - arm[2] * force[1],
            arm[2] * force[0] - arm[0] * force[2],
            arm[0] * force[1] - arm[1] * force[0],
        ]
    };
    let weight = [0.0, 0.0, -60.0 * 9.81];
    let mut wrench = [weight.to_vec(), moment(turn(&[0.01, -0.02, 0.05]), &weight).to_vec()].concat();
    let geometry = json("check", &robot, &[]);
    for (cable, state) in geometry["cables"].as_array().unwrap().iter().zip(found["cables"].as_array().unwrap()) {
        let force = numbers(&state["force_on_platform_n"]);
        let arm = turn(&numbers(&cable["attachment_m"]));
        let chord: f64 = numbers(&cable["anchor_m"])
            .iter()
            .zip([0.1, -0.05, 1.5])
            .zip(arm)
            .map(|((anchor, position), arm)| (anchor - position - arm).powi(2))
            .sum();
        assert!((chord.sqrt() - state["chord_m"].as_f64().unwrap()).abs() < 1e-13);
        assert!(state["tension_platform_n"].as_f64().unwrap() > 100.0);
        for (total, part) in wrench.iter_mut().zip([force.clone(), moment(arm, &force).to_vec()].concat()) {
            *total += part;
        }
    }
    assert_close(&wrench, &[0.0; 6], 1e-8, "forces and moments");
}

#[test]
fn lengths_of_a_moordyn_file_lead_back_to_their_pose() {
    let found = json("statics", &imported(&[&example("tripod.txt")]), &[]);
    assert_close(&numbers(&found["pose"]["position_m"]), &[0.1, -0.05, 1.5], 1e-10, "position");
    // A pose replaces the lengths.
    let output = import(&[&example("tripod.txt"), "--pose", "0,0,1.5"]);
    assert!(stderr(&output).contains("not carried over: the unstrained lengths"), "{}", stderr(&output));
    assert!(
        !stdout(&output).contains("unstrained_length_m") && stdout(&output).contains("position_m = [0.0, 0.0, 1.5]")
    );
}

/// A weight of 8 kg on two ropes, in the layout of MoorDyn 1.
const VERSION_1: &str = "\
--------------------- MoorDyn Input File ------------------------------------
hanging weight
----------------------- LINE TYPES ------------------------------------------
1        NTypes    - number of LineTypes
Name     Diam      MassDen       EA         BA/-zeta     Can    Cat    Cdn    Cdt
(-)      (m)       (kg/m)        (N)        (N-s/-)      (-)    (-)    (-)    (-)
main     0.004     0.05          1.0E6      0            1.0    0.0    1.6    0.1
---------------------- CONNECTION PROPERTIES --------------------------------
3        NConnects - number of connections including anchors and fairleads
Node     Type      X        Y         Z        M        V        FX       FY      FZ     CdA   CA
(-)      (-)       (m)      (m)       (m)      (kg)     (m^3)    (kN)     (kN)    (kN)   (m^2)  (-)
1        Fixed    3.0      0.0       4.0      0        0        0        0       0      0      0
2        Fixed   -3.0      0.0       4.0      0        0        0        0       0      0      0
3        Connect  0.0      0.0       2.0      8.0      0        0        0       0      0      0
---------------------- LINE PROPERTIES --------------------------------------
2        NLines    - number of line objects
Line     LineType  UnstrLen  NumSegs   NodeAnch  NodeFair  Flags/Outputs
(-)      (-)       (m)       (-)       (-)       (-)       (-)
1        main      3.60      20        1         3         -
2        main      3.60      20        2         3         -
---------------------- SOLVER OPTIONS ---------------------------------------
0        WtrDnsty
--------------------- need this line ------------------
";

#[test]
fn sections_of_a_moordyn_file_that_are_not_read_are_named_with_their_line() {
    let text = fs::read_to_string(example("tripod.txt")).unwrap();
    let header = "---------------------- OPTIONS";
    let sections = "---- FAILURE ----\nFailID Point Lines FailTime FailTen\n() () () (s) (N)\n1 2 1 40 0\n\
                    ---- CONTROL ----\nChannelID Lines\n() ()\n1 2,3\n2 4\n---- HEATING ----\nID Power\n() (W)\n1 5\n";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.txt");
    let at = text.find(header).unwrap();
    let line = text[..at].lines().count();
    fs::write(&path, [&text[..at], sections, &text[at..]].concat()).unwrap();
    let out = folder.path().join("a.toml");
    let output = run(&["import", path.to_str().unwrap(), "-o", out.to_str().unwrap()]);
    let told = stderr(&output);
    for says in [
        format!("the failure of line {} of the file: in a scenario of `simulate` it is a [[cut]]", line + 4),
        format!("the section `CONTROL` from line {} on", line + 5),
        format!("the section `HEATING` from line {} on", line + 10),
    ] {
        assert_eq!(told.matches(&says).count(), 1, "{says}: {told}");
    }
    // The description above the first section is none.
    assert!(!told.contains("MoorDyn Input File"), "{told}");
}

#[test]
fn both_layouts_of_moordyn_describe_one_robot() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("weight.txt");
    let of = |text: &str| {
        fs::write(&path, text).unwrap();
        imported(&[path.to_str().unwrap()])
    };
    let robot = of(VERSION_1);
    let without_counts = VERSION_1.lines().filter(|line| !line.contains("    - ") && !line.contains("NConnects"));
    assert_eq!(of(&without_counts.collect::<Vec<_>>().join("\n")), robot);
    let version_2 = VERSION_1
        .replace("Can    Cat    Cdn    Cdt", "EI Cd Ca CdAx CaAx")
        .replace("1.0    0.0    1.6    0.1", "0 0 0 0 0")
        .replace("UnstrLen  NumSegs   NodeAnch  NodeFair", "AttachA AttachB UnstrLen NumSegs")
        .replace("3.60      20        1         3", "1 3 3.60 20")
        .replace("3.60      20        2         3", "2 3 3.60 20");
    assert_eq!(of(&version_2), robot);

    // Straight ropes would end 1.98997 m below; 8 kg strain them by 0.3 mm, and their weight of 1.8 N bends them.
    let found = json("statics", &robot, &[]);
    let position = numbers(&found["pose"]["position_m"]);
    assert_close(&position, &[0.0, 0.0, 4.0 - (3.6_f64.powi(2) - 9.0).sqrt()], 1e-3, "position");
    assert_eq!(json("check", &robot, &[])["platform"]["mass_kg"], 8.0);
}

#[test]
fn coupled_points_are_the_platform_if_there_is_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("coupled.txt");
    let text = "--- LINE TYPES ---\nTypeName Diam Mass/m EA\n(-)\nrope 0.004 0.05 1e6\n\
        --- POINTS ---\nID Type X Y Z Mass\n(-)\n1 Fixed 5 0 4 0\n2 Fixed -2.5 4.3 4 0\n3 Fixed -2.5 -4.3 4 0\n\
        4 Coupled 0.5 0 1 0\n5 Vessel -0.25 0.43 1 0\n6 Fairlead -0.25 -0.43 1 0\n\
        --- LINES ---\nID LineType AttachA AttachB UnstrLen\n(-)\n1 rope 1 4 5.4\n2 rope 2 5 5.4\n3 rope 3 6 5.4\n\
        --- OPTIONS ---\n0 rho\n";
    let import_of = |text: &str, more: &[&str]| {
        fs::write(&path, text).unwrap();
        import(&[&[path.to_str().unwrap()], more].concat())
    };
    let output = import_of(text, &["--mass-kg", "10", "--inertia-kg-m2", "1,1,1"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    for says in
        ["assumed: the platform is the 3 coupled points", "assumed: the centre of mass is the centre of the coupled"]
    {
        assert!(stderr(&output).contains(says), "{}", stderr(&output));
    }
    let robot = stdout(&output);
    for says in ["attachment_m = [0.5, 0.0, 0.0]", "center_of_mass_m = [0.0, 0.0, 0.0]", "unstrained_length_m = 5.4"] {
        assert!(robot.contains(says), "{robot}");
    }
    // Three ropes with their lengths hold the platform where these are 5.4 m long: 0.5 m nearer than the anchors.
    let position = numbers(&json("statics", robot, &[])["pose"]["position_m"]);
    assert_close(&position, &[0.0, 0.0, 4.0 - (5.4_f64.powi(2) - 4.5_f64.powi(2)).sqrt()], 0.05, "position");

    // Mass and inertia are missing, and named.
    let message = stderr(&import_of(text, &[])).to_owned();
    assert!(message.contains("--mass-kg KG") && message.contains("--inertia-kg-m2"), "{message}");
    // A single coupled point is a point mass.
    let single = text
        .replace("5 Vessel -0.25 0.43 1 0\n6 Fairlead -0.25 -0.43 1 0\n", "")
        .replace(" 5 5.4", " 4 5.4")
        .replace(" 6 5.4", " 4 5.4");
    let output = import_of(&single, &["--mass-kg", "10"]);
    assert!(stdout(&output).contains("motion = \"point-mass\""), "{}", stderr(&output));
    // Without coupled points there is none.
    let message = stderr(&import_of(
        &text.replace("Coupled", "Fixed").replace("Vessel", "Fixed").replace("Fairlead", "Fixed"),
        &[],
    ))
    .to_owned();
    assert!(message.contains("no body, no free point and no coupled point"), "{message}");
}

#[test]
fn a_declaration_that_the_bytes_contradict_does_not_count() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tripod.wcrfx");
    let text = example_text("tripod.wcrfx");
    let declared = text.replace("encoding=\"utf-8\"", "encoding=\"utf-16\"");
    let declared = if declared == text {
        format!("<?xml version=\"1.0\" encoding=\"utf-16\"?>\n{}", text.trim_start())
    } else {
        declared
    };
    fs::write(&path, &declared).unwrap();
    assert_eq!(imported(&[path.to_str().unwrap()]), imported(&[&example("tripod.wcrfx")]));
}

#[test]
fn missing_values_of_a_source_are_requested_in_one_message() {
    let [bodies, cables] = caspr();
    let lacking = |more: &[&str], expected: &[&str], absent: &[&str]| {
        let output = import(&[&[bodies.as_str(), &cables], more].concat());
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(expected.iter().all(|text| message.contains(text)), "{message}");
        assert!(!absent.iter().any(|text| message.contains(text)), "{message}");
        assert!(output.stdout.is_empty());
    };
    lacking(&[], &["--mass-kg-per-m", "--axial-stiffness-n", "--youngs-modulus-pa"], &["--mass-kg KG"]);
    lacking(&["--axial-stiffness-n", "1e6"], &["--mass-kg-per-m"], &["--youngs-modulus-pa"]);
    lacking(&["--mass-kg-per-m", "0"], &["--axial-stiffness-n"], &["--mass-kg-per-m"]);
    lacking(&["--mass-kg-per-m", "0", "--youngs-modulus-pa", "1e10"], &["--diameter-m"], &["stiffness of the ropes"]);

    let empty = Changed::of(
        &CASPR,
        &[("<mass>60.0", "<mass>0"), ("<Ixx>4.0", "<Ixx>0"), ("<Iyy>5.0", "<Iyy>0"), ("<Izz>7.0", "<Izz>0")],
    );
    let output = empty.import(&ROPES);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2));
    for expected in ["tripod_bodies.xml:8:7", "--mass-kg KG", "--inertia-kg-m2 XX,YY,ZZ"] {
        assert!(message.contains(expected), "{message}");
    }
    let more = ["--mass-kg", "30", "--inertia-kg-m2", "2,3,4,0.1,0.2,0.3", "--center-of-mass-m", "0,0,0.1"];
    let robot = json("check", &empty.imported(&[&ROPES[..], &more].concat()), &[]);
    assert_eq!(robot["platform"]["mass_kg"], 30.0);
    assert_eq!(numbers(&robot["platform"]["inertia_kg_m2"][0]), [2.0, 0.1, 0.2]);
    assert_eq!(numbers(&robot["platform"]["center_of_mass_m"]), [0.0, 0.0, 0.1]);
}

#[test]
fn modulus_and_diameter_are_a_stiffness_and_options_win_over_the_source() {
    let more = ["--mass-kg-per-m", "0.1", "--youngs-modulus-pa", "1e11", "--diameter-m", "0.004"];
    let robot = json("check", &imported(&[&[example("tripod.txt").as_str()], &more[..]].concat()), &[]);
    let stiffness = robot["materials"][0]["axial_stiffness_n"].as_f64().unwrap();
    assert!((stiffness - 1e11 * std::f64::consts::PI * 4e-6).abs() < 1e-6, "{stiffness}");
    assert_eq!(robot["materials"][0]["mass_kg_per_m"], 0.1);
    // WireX gives a radius, and the file has its own modulus.
    let robot = json("check", &imported(&[&example("tripod.wcrfx")]), &[]);
    let stiffness = robot["materials"][0]["axial_stiffness_n"].as_f64().unwrap();
    assert!((stiffness - 5e10 * std::f64::consts::PI * 4e-6).abs() < 1e-6, "{stiffness}");
}

#[test]
fn losses_and_assumptions_are_reported_on_stderr_and_in_the_file() {
    let [bodies, cables] = caspr();
    let output = import(&[&[bodies.as_str(), &cables, "--cable-set", "springs"], &ROPES[..2]].concat());
    let (said, written) = (stderr(&output), stdout(&output).replace("\n#   ", " "));
    assert!(written.contains("[pulleys.wheel]\nradius_m = 0.05"), "{written}");
    for lost in ["the limits of the platform's motion, q_min", "\"ideal\""] {
        assert!(said.contains(lost) && written.contains(lost), "{lost}: {said}\n{written}");
    }

    let defaults = Changed::of(
        &["tripod.wcrfx"],
        &[
            (r#"Ixy="0.0" "#, ""),
            (r#"damping="0.0""#, r#"max_length="30""#),
            (r#"x="0.01" y="-0.02" z="0.05""#, r#"x="0.000000" y="1.000000" z="0.200000""#),
        ],
    );
    let said = defaults.import(&[]);
    for text in ["assumed: the centre of gravity (0, 1, 0.2) m", "diag(2, 3, 4) kg m²", "`max_length` 30"] {
        assert!(stderr(&said).contains(text), "{text}: {}", stderr(&said));
    }
    assert!(!stderr(&said).contains("which no rope has"));
    let thick = Changed::of(&["tripod.wcrfx"], &[(r#"radius="0.002""#, r#"radius="0.008""#)]);
    let said = thick.import(&[]);
    assert!(stderr(&said).contains("a density of 249 kg/m³") && stderr(&said).contains("--diameter-m 0.008"));
}

#[test]
fn tension_limits_are_kept_if_they_have_the_same_meaning() {
    let [bodies, cables] = caspr();
    for written in [
        imported(&[&[bodies.as_str(), &cables], &ROPES[..]].concat()),
        imported(&[&example("tripod.wcrfx"), "--pose", "0.1,-0.05,1.5"]),
    ] {
        assert_eq!(written.matches("\nminimum_tension_n = 10.0\nmaximum_tension_n = 2000.0\n").count(), 6, "{written}");
    }
    assert!(imported(&[&example("tripod.wcrfx")]).contains("\nbreaking_load_n = 15000.0\n"));
    // Limits that no tension satisfies, and limits that a hanging cable cannot reach.
    let limits = "<force_min>10</force_min>\n        <force_max>2000</force_max>";
    for (other, says) in [
        (limits.replace("10<", "0.1<"), "from being slack"),
        (limits.replace("10<", "-1<"), "from being slack"),
        (limits.replace("10<", "2000<"), "minimum, which is not below the maximum"),
        (limits.replace("2000<", "0<"), "maximum, which is not positive"),
    ] {
        let output = Changed::of(&CASPR, &[(limits, other.as_str())]).import(&ROPES);
        assert!(stderr(&output).contains(says), "{says}: {}", stderr(&output));
        assert_eq!(stdout(&output).matches("_tension_n").count(), 11, "the other limit stays");
    }
    let weak = Changed::of(&["tripod.wcrfx"], &[("breaking_load=\"15000.0\"", "breaking_load=\"1500.0\"")]).import(&[]);
    assert!(stderr(&weak).contains("maximum, which is above the breaking load"), "{}", stderr(&weak));
    assert!(!stdout(&weak).contains("maximum_tension_n") && stdout(&weak).contains("breaking_load_n = 1500.0"));
}

#[test]
fn a_model_without_a_pose_is_a_robot_without_a_state() {
    let changes = [("SPATIAL_EULER_XYZ\" q_initial=\"0.1 -0.05 1.5 0.02 -0.03 0.05\"", "SPATIAL_EULER_XYZ\"")];
    let old = Changed::of(&CASPR, &changes);
    let text = old.imported(&ROPES);
    assert!(!text.contains("[state]") && text.contains("The file has no pose, q_initial"), "{text}");
    assert!(old.imported(&[&ROPES[..], &["--pose", "0,0,1.5"]].concat()).contains("position_m = [0.0, 0.0, 1.5]"));
}

#[test]
fn options_without_effect_are_refused() {
    let [bodies, cables] = caspr();
    let springs =
        [&bodies, cables.as_str(), "--cable-set", "springs", "--mass-kg-per-m", "0.05", "--diameter-m", "0.004"];
    let point = Changed::of(&["tripod.wcrfx"], &[("3R3T", "3T")]);
    for (output, says) in [
        (import(&springs), "EA of the ropes, which --diameter-m does not change"),
        (point.import(&["--inertia-kg-m2", "1,1,1"]), "leave out --inertia-kg-m2"),
        (point.import(&["--center-of-mass-m", "1,1,1"]), "leave out --center-of-mass-m"),
    ] {
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(says), "{}", stderr(&output));
    }
}

#[test]
fn for_a_planar_platform_the_moment_about_the_normal_is_enough() {
    let of = |changes: [(&str, &str); 2]| {
        let joint = "SPATIAL_EULER_XYZ\" q_initial=\"0.1 -0.05 1.5 0.02 -0.03 0.05\"";
        Changed::of(&CASPR, &[&[(joint, "PLANAR_XZ\" q_initial=\"0.1 1.5 0\"")], &changes[..]].concat()).import(&ROPES)
    };
    let whole = of([("<Ixx>4.0", "<Ixx>0.0"), ("<Izz>7.0", "<Izz>0.0")]);
    assert!(stdout(&whole).contains("\ninertia_kg_m2 = 5.0\n"), "{}{}", stdout(&whole), stderr(&whole));
    let without = of([("<Ixx>4.0", "<Ixx>4.0"), ("<Iyy>5.0", "<Iyy>0.0")]);
    assert_eq!(without.status.code(), Some(2));
    assert!(stderr(&without).contains("only the moment about the normal of its plane counts"), "{}", stderr(&without));
}

#[test]
fn a_platform_that_moves_in_a_plane_is_planar_in_the_plane_of_its_pose() {
    let caspr = Changed::of(
        &CASPR,
        &[("SPATIAL_EULER_XYZ\" q_initial=\"0.1 -0.05 1.5 0.02 -0.03 0.05\"", "PLANAR_XZ\" q_initial=\"0.1 1.5 0\"")],
    );
    let robot = json("check", &caspr.imported(&ROPES), &[]);
    assert_eq!((&robot["degrees_of_freedom"], &robot["platform"]["motion"]), (&3.into(), &"planar-xz".into()));
    let wirex = Changed::of(&["tripod.wcrfx"], &[("3R3T", "1R2T")]);
    let robot = json("check", &wirex.imported(&["--pose", "0.1,0,1.5,0,0,3"]), &[]);
    assert_eq!(
        (&robot["platform"]["motion"], &robot["platform"]["plane_offset_m"]),
        (&"planar-xy".into(), &1.5.into())
    );
    let tilted = wirex.import(&["--pose", "0.1,0,1.5,2,0,0"]);
    assert!(stderr(&tilted).contains("tilted out of its plane by 2"), "{}", stderr(&tilted));
}

#[test]
fn a_platform_that_only_translates_is_a_point_mass_with_moved_anchors() {
    let caspr = Changed::of(
        &CASPR,
        &[("SPATIAL_EULER_XYZ\" q_initial=\"0.1 -0.05 1.5 0.02 -0.03 0.05\"", "T_XYZ\" q_initial=\"0.1 -0.05 1.5\"")],
    );
    let text = caspr.imported(&ROPES);
    let robot = json("check", &text, &[]);
    assert_eq!(robot["degrees_of_freedom"], 3);
    let first = numbers(&robot["cables"][0]["anchor_m"]);
    assert_close(&first, &[0.15 - 0.6928, 4.0 - 0.4, 5.0 - 0.1], 1e-15, "anchor");
    assert!(
        text.contains("minus the source's attachment") || text.replace("\n#   ", " ").contains("minus the source's")
    );
    let wirex = Changed::of(&["tripod.wcrfx"], &[("3R3T", "3T")]);
    let robot = json("check", &wirex.imported(&[]), &[]);
    assert_close(&numbers(&robot["cables"][0]["anchor_m"]), &first, 1e-15, "anchor");
    let output = wirex.import(&["--pose", "0,0,1,10,0,0"]);
    assert!(stderr(&output).contains("a point mass has no orientation"), "{}", stderr(&output));

    // A free point held by three lines.
    let point = "a ball\n--- LINE TYPES ---\nn\nu\nrope 0.01 0.1 1e5 0 0 0 0 0 0\n--- POINTS ---\nn\nu\n1 Fixed 3 0 4 \
                 0 0 0 0\n\
                 2 Fixed -2 2 4 0 0 0 0\n3 Fixed -2 -2 4 0 0 0 0\n4 Free 0 0 1 25 0 0 0\n--- LINES ---\nn\nu\n\
                 1 rope 1 4 4.2 20 -\n2 rope 4 2 4.1 20 -\n3 rope 3 4 4.1 20 -\n--- OPTIONS ---\n9.80665 g\n0 rho\n";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ball.txt");
    fs::write(&path, point).unwrap();
    let robot = imported(&[path.to_str().unwrap()]);
    let found = json("statics", &robot, &[]);
    assert!(!found["warnings"].to_string().contains("usual is"), "{}", found["warnings"]);
    let lift: f64 = found["cables"].as_array().unwrap().iter().map(|c| numbers(&c["force_on_platform_n"])[2]).sum();
    assert!((lift - 25.0 * 9.80665).abs() < 1e-9, "{lift}");
}

#[test]
fn masses_of_points_on_a_body_are_masses_of_the_body() {
    let changed = Changed::of(&["tripod.txt"], &[("6928       0.4     0.1   0  0", "6928       0.4     0.1   20  0")]);
    let platform = json("check", &changed.imported(&[]), &[])["platform"].clone();
    assert_eq!(platform["mass_kg"], 80.0);
    let center = [0.25 * 0.6928 + 0.75 * 0.01, 0.25 * 0.4 - 0.75 * 0.02, 0.25 * 0.1 + 0.75 * 0.05];
    assert_close(&numbers(&platform["center_of_mass_m"]), &center, 1e-15, "centre");
    // Two bodies: reduced mass times squared distance, about z.
    let (dx, dy) = (0.6928 - 0.01, 0.4 + 0.02);
    let about_z = 7.0 + 60.0 * 20.0 / 80.0 * (dx * dx + dy * dy);
    assert!((numbers(&platform["inertia_kg_m2"][2])[2] - about_z).abs() < 1e-12);
}

#[test]
fn inertia_about_the_joint_is_brought_to_the_centre_of_mass() {
    let changed = Changed::of(&CASPR, &[("ref=\"com\"", "ref=\"joint\"")]);
    let platform = json("check", &changed.imported(&ROPES), &[])["platform"].clone();
    assert!((numbers(&platform["inertia_kg_m2"][0])[0] - (4.0 - 60.0 * (0.02 * 0.02 + 0.05 * 0.05))).abs() < 1e-12);
    assert!((numbers(&platform["inertia_kg_m2"][0])[1] - 60.0 * 0.01 * -0.02).abs() < 1e-12);
    // This tensor does not belong to the mass of the option.
    let massless = Changed::of(&CASPR, &[("ref=\"com\"", "ref=\"joint\""), ("<mass>60.0", "<mass>0")]);
    let output = massless.import(&[&ROPES[..], &["--mass-kg", "60"]].concat());
    assert!(output.status.code() == Some(2) && stderr(&output).contains("--inertia-kg-m2"), "{}", stderr(&output));
}

#[test]
fn a_quaternion_and_its_angles_are_one_pose() {
    let half = |angle: f64| ((angle / 2.0).cos(), (angle / 2.0).sin());
    let (c, s) = half(0.5);
    let quaternion = format!("q_initial=\"0.1 -0.05 1.5 {c} 0 0 {s}\"");
    let from = "SPATIAL_EULER_XYZ\" q_initial=\"0.1 -0.05 1.5 0.02 -0.03 0.05\"";
    let turned = Changed::of(&CASPR, &[(from, &format!("SPATIAL_QUATERNION\" {quaternion}"))]).imported(&ROPES);
    let angles = Changed::of(&CASPR, &[("0.02 -0.03 0.05", "0 0 0.5")]).imported(&ROPES);
    let of = |text: &str| numbers(&json("check", text, &[])["pose"]["roll_pitch_yaw_deg"]);
    assert_close(&of(&turned), &of(&angles), 1e-13, "angles");
    assert_close(&of(&angles), &[0.0, 0.0, 0.5_f64.to_degrees()], 1e-13, "angles");
}

#[test]
fn names_are_made_unique_and_other_files_of_a_model_are_reported() {
    let changed = Changed::of(&CASPR, &[("name=\"2\"", "name=\"1\""), ("name=\"3\"", "name=\"\"")]);
    fs::write(changed.folder.path().join("tripod_trajectories.xml"), "<trajectories/>").unwrap();
    let output = changed.import(&ROPES);
    let robot = json("check", stdout(&output), &[]);
    let names: Vec<&str> = robot["cables"].as_array().unwrap().iter().map(|c| c["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["1", "1 (2)", "3", "4", "5", "6"]);
    for said in ["is a second \"1\" in the source; it is called \"1 (2)\"", "has no name", "tripod_trajectories.xml"] {
        assert!(stderr(&output).contains(said), "{said}: {}", stderr(&output));
    }
}

#[test]
fn the_robot_file_is_written_completely_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("robot.toml");
    let target = path.to_str().unwrap();
    fs::write(&path, "old").unwrap();
    let [bodies, cables] = caspr();
    assert_eq!(import(&[&bodies, &cables, "-o", target]).status.code(), Some(2));
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    let output = import(&[&[bodies.as_str(), &cables, "-o", target], &ROPES[..]].concat());
    assert_eq!(output.status.code(), Some(0));
    assert!(stderr(&output).starts_with(&format!("wrote {target}")) && output.stdout.is_empty());
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.starts_with("# Written by funicular") && text.contains("name = \"tripod, cables ideal\""));
    assert!(!text.contains(Path::new(&bodies).parent().unwrap().to_str().unwrap()), "no folders in the file");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing else is left");
}

/// CASPR's rotating pulleys become pulleys of the robot file, and the cables leave them tangentially.
#[test]
fn rotating_pulleys_of_caspr_become_pulleys() {
    let directory = tempfile::tempdir().unwrap();
    let cables = directory.path().join("pulleys.xml");
    let base =
        "<attachment>\n          <link>0</link>\n          <location>0.15 4.0 5.0</location>\n        </attachment>";
    let pulley = "<base_rotating_pulley>\n<fixed_location>0.15 4.0 5.0</fixed_location>\n\
                  <pulley_radius>0.045</pulley_radius>\n<cable_entry_vector>0 0 1</cable_entry_vector>\n\
                  </base_rotating_pulley>";
    let text = example_text("tripod_cables.xml");
    assert!(text.contains(base));
    std::fs::write(&cables, text.replacen(base, pulley, 1)).unwrap();
    let bodies = example("tripod_bodies.xml");
    let text = imported(&[&[cables.to_str().unwrap(), &bodies], &ROPES[..]].concat());
    assert!(text.contains("[pulleys.wheel]\nradius_m = 0.045\nentry_direction = [0.0, 0.0, 1.0]"), "{text}");

    let robot = json("check", &text, &[]);
    assert_eq!(robot["cables"][0]["pulley"]["radius_m"], 0.045);
    assert!(robot["cables"][1].get("pulley").is_none());
    let rest = json("statics", &text, &[]);
    let drive = &rest["cables"][0]["drive"];
    assert!(drive["wrap_deg"].as_f64().unwrap() > 90.0, "the cable goes down from the wheel: {drive}");
    let exit = numbers(&drive["exit_m"]);
    assert!((exit[2] - 5.0).abs() < 0.0451 && exit[1] < 4.0, "{exit:?}");

    // Damaged values.
    for (right, wrong, message) in [
        ("0.045", "-0.045", "<pulley_radius> is -0.045 m, it must be positive"),
        ("<cable_entry_vector>0 0 1", "<cable_entry_vector>0 0 0", "<cable_entry_vector> has no length"),
    ] {
        let damaged = std::fs::read_to_string(&cables).unwrap().replace(right, wrong);
        let file = directory.path().join("damaged.xml");
        std::fs::write(&file, damaged).unwrap();
        let output = import(&[&[file.to_str().unwrap(), &bodies], &ROPES[..]].concat());
        assert_eq!(output.status.code(), Some(2));
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(told.contains(message), "{told}");
    }
}

/// Limits of winches and the payload of WireX are those of the robot file.
#[test]
fn winches_and_payload_of_wirex_are_carried_over() {
    let text = Changed::of(&["tripod.wcrfx"], &[]).imported(&["--pose", "0.1,-0.05,1.5"]);
    let robot = json("check", &text, &[]);
    let winch = &robot["cables"][3]["winch"];
    let of = ["max_speed_m_s", "max_acceleration_m_s2"].map(|key| winch[key].as_f64());
    assert_eq!(of, [Some(1.5), Some(4.0)], "{winch}");
    for key in ["payload_max_kg = 20.0", "drum_radius_m = 0.08"] {
        assert!(text.contains(key), "{text}");
    }

    // Zero is a number that WireX does not know.
    let unknown = [(r#"max_velocity="1.5" max_acceleration="4.0""#, r#"max_velocity="0.0""#), ("20.0", "0.0")];
    let text = Changed::of(&["tripod.wcrfx"], &unknown).imported(&["--pose", "0.1,-0.05,1.5"]);
    assert!(!text.contains("[winches") && !text.contains("[required]"), "{text}");
}

/// A trajectory of CASPR becomes a table that `trajectory` reads; it passes its points at their times.
#[test]
fn a_trajectory_of_caspr_is_a_table_of_poses() {
    let [bodies, trajectories] = [example("tripod_bodies.xml"), example("tripod_trajectories.xml")];
    let table = |name: &str| import(&[&bodies, &trajectories, "--trajectory", name]);
    let found = table("lift");
    let csv = stdout(&found);
    let rows: Vec<Vec<f64>> =
        csv.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    assert_eq!((csv.lines().next(), rows.len()), (Some("t_s,x_m,y_m,z_m,roll_deg,pitch_deg,yaw_deg"), 61));
    let near = |row: &[f64], expected: &[f64]| row.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12);
    assert!(near(&rows[30], &[1.5, 0.3, 0.0, 1.7, 0.0, 0.0, 0.1_f64.to_degrees()]), "{:?}", rows[30]);
    assert!(near(&rows[60], &[3.0, 0.5, -0.1, 1.5, 0.0, 0.0, 0.0]), "{:?}", rows[60]);

    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("lift.csv");
    std::fs::write(&path, csv).unwrap();
    let robot = imported(&[&[bodies.as_str(), &example("tripod_cables.xml")], &ROPES[..]].concat());
    let found = json("trajectory", &robot, &["--path", path.to_str().unwrap()]);
    assert_eq!(found["duration_s"], 3.0);

    // Errors.
    let wrong = table("lif");
    assert_eq!(wrong.status.code(), Some(2));
    assert!(stderr(&wrong).contains("did you mean `lift`"), "{}", stderr(&wrong));
    for (right, wrong, message) in [
        (r#"<point time="1.5">"#, r#"<point time="-1.5">"#, "is not after that of the point before it"),
        ("<q>0.3 0.0 1.7 0.0 0.0 0.1</q>", "<q>0.3 0.0 1.7</q>", "<q> holds 3 numbers; the joint has 6 coordinates"),
        ("quintic_spline", "parabolic_blend", "cannot be read; known are linear_spline_trajectory"),
        (r#"time_step="0.05""#, r#"time_step="1e-9""#, "a time step of 1e-9 s is not possible"),
    ] {
        let damaged = std::fs::read_to_string(&trajectories).unwrap().replace(right, wrong);
        let file = directory.path().join("damaged.xml");
        std::fs::write(&file, damaged).unwrap();
        let output = import(&[&bodies, file.to_str().unwrap(), "--trajectory", "lift"]);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(stderr(&output).contains(message), "{}", stderr(&output));
    }
}

/// WireX's pulleys become pulleys of the robot file. The lengths are those of WireX's own formula, the sum of two arcs
/// of cosines times the radius and the free length (doInverseKinematicsPulleyEx).
#[test]
fn pulleys_of_wirex_become_pulleys_with_its_lengths() {
    // The frame of one base is turned: its z axis points to y.
    let turned = r#"a13="0.000000" a23="0.000000" a33="1.000000" radius="0.050000""#;
    let changed = Changed::of(
        &["tripod.wcrfx"],
        &[(turned, r#"a13="0.000000" a23="0.600000" a33="0.800000" radius="0.080000""#)],
    );
    let text = changed.imported(&["--pose", "0.1,-0.05,1.5"]);
    assert!(text.contains("radius_m = 0.08\nentry_direction = [0.0, 0.6, 0.8]"), "{text}");
    assert_eq!(text.matches("\n[pulleys.").count(), 2, "{text}");
    assert!(text.contains("the drums are at the pulleys"), "{text}");

    let robot = json("check", &text, &[]);
    let rest = json("statics", &text, &["--static-model", "ideal"]);
    for (i, cable) in robot["cables"].as_array().unwrap().iter().enumerate() {
        let (radius, axis) = if i == 0 { (0.08, [0.0, 0.6, 0.8]) } else { (0.05, [0.0, 0.0, 1.0]) };
        let [base, platform] = ["anchor_m", "attachment_m"].map(|key| numbers(&cable[key]));
        let reach: Vec<f64> = [0.1, -0.05, 1.5].iter().zip(&platform).zip(&base).map(|((r, p), b)| r + p - b).collect();
        let along: f64 = reach.iter().zip(axis).map(|(x, a)| x * a).sum();
        let across = (reach.iter().map(|x| x * x).sum::<f64>() - along * along).sqrt();
        let to_center = (across - radius).hypot(along);
        let free = (to_center * to_center - radius * radius).sqrt();
        let length = ((free / to_center).acos() + (along / to_center).acos()) * radius + free;
        let ours = rest["cables"][i]["unstrained_length_m"].as_f64().unwrap();
        assert!((ours - length).abs() < 1e-12, "cable {i}: {ours} m against {length} m");
    }

    // Radius that WireX writes for pulleys of unknown size, and damaged values.
    let unknown = Changed::of(&["tripod.wcrfx"], &[(r#"radius="0.050000""#, r#"radius="0.100000""#)]).import(&[]);
    assert!(stderr(&unknown).contains("of unknown size"), "{}", stderr(&unknown));
    for (wrong, message) in [
        (r#"a33="1.000000" radius="-0.050000""#, "attribute `radius` of <base> is -0.05 m, it must be positive"),
        (r#"a33="0.000000" radius="0.050000""#, "`a13` `a23` `a33`, has no length"),
    ] {
        let output = Changed::of(&["tripod.wcrfx"], &[(r#"a33="1.000000" radius="0.050000""#, wrong)]).import(&[]);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(message), "{}", stderr(&output));
    }
    let without = Changed::of(&["tripod.wcrfx"], &[(r#" radius="0.050000""#, "")]).imported(&[]);
    assert!(json("check", &without, &[])["cables"][0].get("pulley").is_none());
}
