//! Broken command lines and robot files: one message each, what is wrong in it, exit code 2 (1 where the input is fine
//! and there is no solution), nothing on stdout, and no panic.

use super::{run, run_with, stderr, yuan};
use std::process::Output;

pub(crate) fn assert_refused(output: &Output, code: i32, expected: &str, what: &str) {
    let message = stderr(output);
    assert_eq!(output.status.code(), Some(code), "{what}: {message}");
    assert_eq!(message.matches("error:").count(), 1, "{what}: one message, not: {message}");
    assert!(!message.contains("panicked") && !message.contains("RUST_BACKTRACE"), "{what}: {message}");
    assert!(message.contains(expected), "{what}: expected `{expected}` in: {message}");
    assert!(output.stdout.is_empty(), "{what}: nothing on stdout");
    assert!(!message.contains('\u{1b}'), "{what}: no colours in a pipe");
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table")]
fn broken_command_lines_are_refused() {
    const FRF: &str = "frf ROBOT --from-hz 1 --to-hz 2 --points 9 --input fz --output z";
    let cases: &[(&str, &str)] = &[
        // Verbs and robots.
        ("mods ROBOT --below-hz 20", "unrecognized subcommand"),
        ("statics", "<ROBOT>"),
        ("statics ROBOT ROBOT", "unexpected argument"),
        ("statics no-such-file.toml", "cannot read the robot file no-such-file.toml"),
        ("statics /", "it is a directory"),
        ("check /dev/zero", "it is not a robot file"),
        ("check /dev/null", "describes no robot"),
        // Options.
        ("statics ROBOT --pose-m 0,0,1", "unexpected argument"),
        ("statics ROBOT --format xml", "[possible values: text, json, csv, latex, markdown]"),
        ("statics ROBOT --static-model rigid", "[possible values: ideal, spring, catenary]"),
        (
            "modes ROBOT --below-hz 9 --cable-model finite-element",
            "spring, shallow-static, catenary-static, shallow-dynamic, catenary-dynamic",
        ),
        ("modes ROBOT --below-hz 9 --assembly full", "[possible values: consistent, without-geometric-stiffness]"),
        // The state.
        ("statics ROBOT --pose 0,0", "2 numbers where x,y,z"),
        ("statics ROBOT --pose 0,0,1,2", "4 numbers where"),
        ("statics ROBOT --pose 0,0,nan", "nan is not a finite number"),
        ("statics ROBOT --pose 0,0,1e999", "not a finite number"),
        ("statics ROBOT --pose 0,0,1e13", "beyond 1e12"),
        ("statics ROBOT --pose 0,0,1m", "`1m` is not a number"),
        ("statics ROBOT --pose 0;0;1", "is not a number"),
        ("statics ROBOT --pose 0,,1", "a number is missing"),
        ("statics ROBOT --pose", "a value is required"),
        ("statics ROBOT --pose --mass-kg 3", "error:"),
        ("statics ROBOT --pose 5.352,-2.124,4.193", "coinciding ends"),
        ("statics ROBOT --lengths-m 1,2,3", "3 unstrained lengths given for 6 cables"),
        ("statics ROBOT --lengths-m 1,2,3,4,5,0", "0 is not positive"),
        ("statics ROBOT --lengths-m 1,2,3,4,5,-6", "-6 is not positive"),
        ("statics ROBOT --lengths-m 1,2,3,4,5,inf", "not a finite number"),
        ("statics ROBOT --lengths-m 1,2,3,4,5,1e-13", "at least 1e-12"),
        ("statics ROBOT --lengths-m 7,7,7,7,7,7 --pose 0,0,1", "cannot be used with"),
        // Tensions.
        ("statics ROBOT --tension-rule highest", "[possible values: lowest, closest, middle, centre, stiffest]"),
        ("statics ROBOT --tension-rule lowest", "given by unstrained lengths"),
        ("statics ROBOT --pose 0,0,0.5 --tension-rule lowest", "6 cables for 6 degrees of freedom"),
        ("statics ROBOT --tension-rule closest", "needs --target-tension-n"),
        ("statics ROBOT --tension-rule middle --target-tension-n 5", "closest only"),
        ("statics ROBOT --target-tension-n 5,-1", "-1 is negative"),
        ("statics ROBOT --min-tension-n 5 --max-tension-n 5", "give --min-tension-n below --max-tension-n"),
        ("statics ROBOT --max-tension-n 0", "0 is not positive"),
        ("statics ROBOT --mass-kg -3", "-3 is not positive"),
        ("statics ROBOT --mass-kg 0", "0 is not positive"),
        ("statics ROBOT --mass-kg ten", "`ten` is not a number"),
        ("statics ROBOT --mass-kg inf", "not a finite number"),
        ("statics ROBOT --mass-kg 1 --mass-kg 2", "cannot be used multiple times"),
        // Changes of the robot file.
        ("statics ROBOT --set platform.mass_kg", "has no `=`"),
        ("statics ROBOT --set =3", "is not a path"),
        ("statics ROBOT --set platform..mass_kg=3", "is not a path"),
        ("statics ROBOT --set platform.mass_kg=", "is not a TOML value"),
        ("statics ROBOT --set platform.mass_kg=[1,", "is not a TOML value"),
        ("statics ROBOT --set platform.mass_kg=-3", "# set: platform.mass_kg=-3"),
        ("statics ROBOT --set platform.mass_kg=nan", "it must be finite"),
        ("statics ROBOT --set platform.mass=3", "mass_kg"),
        ("statics ROBOT --set platfrom.mass_kg=3", "did you mean `platform.mass_kg`?"),
        ("statics ROBOT --set mass=75", "did you mean `platform.mass_kg`?"),
        ("statics ROBOT --set stiffness=75", "the robot file has no `stiffness`"),
        ("statics ROBOT --set platform=3", "it names a table"),
        ("statics ROBOT --set cables.7.unstrained_length_m=3", "no cable \"7\"; there are `1`, `2`"),
        ("statics ROBOT --set cables=3", "it names a table"),
        ("statics ROBOT --set cables.1=3", "error:"),
        ("statics ROBOT --set materials.rope-5mm.diameter_m=3", "did you mean `rope-4mm`"),
        ("statics ROBOT --set name.x=3", "`name` is a value"),
        ("statics ROBOT --set cables.1.material=rope-5mm", "rope-5mm"),
        // Stiffness.
        ("stiffness ROBOT --at-hz -1", "-1 is negative"),
        ("stiffness ROBOT --at-hz nan", "not a finite number"),
        ("stiffness ROBOT --static-model ideal", "use the static model `catenary` or `spring`"),
        ("stiffness ROBOT --static-model ideal --assembly without-geometric-stiffness", "use the static model"),
        // Modes.
        ("modes ROBOT --below-hz 0", "0 is not positive"),
        ("modes ROBOT --below-hz -5", "-5 is not positive"),
        ("modes ROBOT --below-hz 20Hz", "without its unit"),
        ("modes ROBOT --below-hz 1e9", "lower the frequency limit"),
        ("modes ROBOT --below-hz 1e9 --cable-model shallow-dynamic", "lower the limit"),
        ("compare ROBOT --below-hz 1e9", "lower the limit"),
        ("compare ROBOT --below-hz 5 --cable-model spring", "unexpected argument"),
        // Frequency responses.
        ("frf ROBOT --from-hz 2 --to-hz 1", "the range has to ascend"),
        ("frf ROBOT --from-hz 2 --to-hz 1 --points 9 --input fz --output z", "the range has to ascend"),
        ("frf ROBOT --from-hz 1 --to-hz 1 --points 9 --input fz --output z", "the range has to ascend"),
        ("frf ROBOT --from-hz 0 --to-hz 1 --points 9 --log --input fz --output z", "--log needs"),
        ("frf ROBOT --from-hz -1 --to-hz 1 --points 9 --input fz --output z", "-1 is negative"),
        ("frf ROBOT --from-hz 0 --to-hz 1 --points 1 --input fz --output z", "from 2 to 1000000"),
        ("frf ROBOT --from-hz 0 --to-hz 1 --points 1000001 --input fz --output z", "from 2 to 1000000"),
        ("frf ROBOT --from-hz 0 --to-hz 1 --points -9 --input fz --output z", "error:"),
        ("frf ROBOT --from-hz 0 --to-hz 1 --points 2.5 --input fz --output z", "give a whole number"),
        ("frf ROBOT --from-hz 0 --to-hz 1 --points 9 --input f --output z", "not an input"),
        ("frf ROBOT --from-hz 0 --to-hz 1 --points 9 --input f:0,0,0 --output z", "a direction cannot be zero"),
        ("frf ROBOT --from-hz 0 --to-hz 1 --points 9 --input fz --output az2", "not an output"),
        ("frf ROBOT --from-hz 0 --to-hz 1 --points 9 --input fz --output a:1,2", "2 numbers where x,y,z"),
        ("frf ROBOT --from-hz 0 --to-hz 1 --points 9 --input mz --output z --input-point-m 0,0,1", "has no effect"),
        ("frf ROBOT --from-hz 0 --to-hz 1 --points 9 --input fz --output rz --output-point-m 0,0,1", "has no effect"),
        (&format!("{FRF} --prominence-db -1"), "-1 is negative"),
        // Masses and cables.
        ("pose-error ROBOT", "--mass-kg"),
        ("pose-error ROBOT --mass-kg 10", "write from:to:count"),
        ("pose-error ROBOT --mass-kg 90:10:5", "it must end above its start"),
        ("pose-error ROBOT --mass-kg 10:90:1", "not a number of masses"),
        ("pose-error ROBOT --mass-kg 0:90:5", "0 is not positive"),
        ("pose-error ROBOT --mass-kg 10:90:5 --tolerance-mm 0", "0 is not positive"),
        ("pose-error ROBOT --mass-kg 10:90:5 --lengths-m 1,2", "2 unstrained lengths given for 6 cables"),
        ("cable ROBOT --name 9 --from-hz 1 --to-hz 2 --points 9", "no cable \"9\"; there are `1`"),
        ("cable ROBOT --name 1 --from-hz 1 --to-hz 1e9 --points 9", "lower the frequency limit"),
        ("cable ROBOT --name 1 --cable-model shallow-dynamic --from-hz 1 --to-hz 1e9 --points 9", "lower --to-hz"),
        // Where the result goes.
        ("statics ROBOT -o ROBOT", "refusing to write the result over the robot file"),
        ("statics ROBOT -o /", "it is a directory"),
        ("statics ROBOT -o /no/such/place.json", "there is no directory /no/such"),
        ("statics ROBOT -o", "a value is required"),
    ];
    assert!(cases.len() >= 60);
    for (line, expected) in cases {
        let arguments: Vec<&str> = line.split(' ').collect();
        assert_refused(&run(&arguments), 2, expected, line);
    }
}

#[test]
fn broken_robot_files_are_refused_at_their_place() {
    let cases: &[(&str, &str, &str)] = &[
        ("mass_kg = 10.55", "mass_kg = -1", "it must be positive"),
        ("mass_kg = 10.55", "mass_kg = 0", "it must be positive"),
        ("mass_kg = 10.55", "mass_kg = \"10\"", "it must be a number"),
        ("mass_kg = 10.55", "mas_kg = 10.55", "mass_kg"),
        ("mass_kg = 10.55", "mass_kg = 10.55 kg", "not valid TOML"),
        ("[platform]", "[platfrom]", "platform"),
        ("[platform]", "[platform", "not valid TOML"),
        ("inertia_kg_m2 = [0.15, 0.15, 0.25]", "inertia_kg_m2 = [0.1, 0.1, 0.9]", "inertia"),
        ("inertia_kg_m2 = [0.15, 0.15, 0.25]", "", "inertia_kg_m2"),
        ("diameter_m = 0.004", "diameter_m = inf", "it must be finite"),
        ("youngs_modulus_pa = 20e9", "", "youngs_modulus_pa"),
        ("name = \"2\"", "name = \"1\"", "1"),
        ("material = \"rope-4mm\"", "material = \"rope-9mm\"", "rope-9mm"),
        ("anchor_m = [5.327, -2.267, 4.193]", "anchor_m = [5.327, -2.267]", "anchor_m"),
        ("unstrained_length_m = 6.863\n", "", "unstrained_length_m"),
        ("[platform]", "gravity = 3\n[platform]", "gravity"),
    ];
    let text = yuan();
    for (old, new, expected) in cases {
        assert!(text.contains(old), "{old}");
        let output = run_with(&["check", "-"], &text.replacen(old, new, 1));
        assert_refused(&output, 2, expected, new);
        assert!(stderr(&output).contains("--> <stdin>:"), "{new}: {}", stderr(&output));
    }
}

#[test]
fn an_earlier_name_is_answered_with_the_present_name() {
    // Values and names of options on the command line.
    const FREQUENCIES: &str = "--from-hz 1 --to-hz 2 --points 9";
    let lines = [
        ("modes ROBOT --below-hz 5 --cable-model exact".to_owned(), "catenary-dynamic"),
        ("modes ROBOT --below-hz 5 --cable-model closed-form".to_owned(), "shallow-dynamic"),
        (format!("cable ROBOT --name 1 {FREQUENCIES} --cable-model catenary-tangent"), "catenary-static"),
        ("stiffness ROBOT --cable-model static-sag".to_owned(), "shallow-static"),
        ("stiffness ROBOT --assembly paper".to_owned(), "without-geometric-stiffness"),
        ("statics ROBOT --pose 0,0,0.5 --wanted-tension-n 100".to_owned(), "--target-tension-n"),
        ("reduce ROBOT --below-hz 5 --model model.npz".to_owned(), "--matrices"),
    ];
    for (line, new) in &lines {
        let arguments: Vec<&str> = line.split(' ').collect();
        let output = run(&arguments);
        assert_refused(&output, 2, new, line);

        // The name is suggested, not just one of a list.
        let message = stderr(&output);
        let suggested = [format!("a similar value exists: '{new}'"), format!("a similar argument exists: '{new}'")];
        let suggested = suggested.iter().any(|tip| message.contains(tip));
        assert!(suggested || message.contains(&format!("did you mean `{new}`?")), "{line}: {message}");
    }
    // Parameters of quantities. Their names contain `error:`, so the number of messages is not counted.
    for (old, new) in [
        ("model-error:static-sag", "model-error:shallow-static"),
        ("stiffness-error:closed-form", "stiffness-error:shallow-dynamic"),
    ] {
        let output = run(&["map", "ROBOT", "--grid", "x=0", "--quantity", old]);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{old}: {message}");
        assert!(message.contains(&format!("did you mean `{new}`?")), "{old}: {message}");
    }
    // A command is offered only options that it has, and no tip to take the option for a file.
    for (line, tip) in [
        ("statics ROBOT --model spring", "a similar argument exists: '--static-model'"),
        ("modes ROBOT --below-hz 5 --model spring", "some similar arguments exist: '--cable-model', '--static-model'"),
        ("statics ROBOT --freedoms point-mass", "unexpected argument '--freedoms' found\n\nUsage"),
        ("new --freedoms planar-xz", "a similar argument exists: '--motion'"),
    ] {
        let output = run(&line.split(' ').collect::<Vec<_>>());
        assert_refused(&output, 2, tip, line);
        assert!(!stderr(&output).contains("-- --"), "{line}: {}", stderr(&output));
    }

    // Commands by the names that other programs have for them, and numbers without commas.
    for (line, tip) in [
        ("grid ROBOT", "a similar subcommand exists: 'map'"),
        ("path ROBOT", "a similar subcommand exists: 'trajectory'"),
        ("optimize ROBOT", "a similar subcommand exists: 'design'"),
        ("statics ROBOT --pose 0 0 5", "separated by commas alone: `--pose 0,0,5`"),
        ("statics ROBOT --pose 0 -1.5 5", "separated by commas alone: `--pose 0,0,5`"),
    ] {
        assert_refused(&run(&line.split(' ').collect::<Vec<_>>()), 2, tip, line);
    }

    // Keys of a robot file.
    let with_key = |text: &str| text.replacen("[platform]\n", "[platform]\nfreedoms = \"rigid\"\n", 1);
    assert_refused(&run_with(&["check", "-"], &with_key(&yuan())), 2, "did you mean `motion`?", "key of a robot file");
    let set = ["check", "ROBOT", "--set", "platform.freedoms=rigid"];
    assert_refused(&run(&set), 2, "did you mean `motion`?", "changed key of a robot file");

    // Keys and values of a request.
    let refused = |command: &str, keys: serde_json::Value, new: &str| {
        let mut request = serde_json::json!({ "command": command, "robot": { "text": yuan() } });
        let all = request.as_object_mut().expect("an object");
        all.extend(keys.as_object().expect("an object").clone());
        let expected = format!("did you mean `{new}`?");
        assert_refused(&run_with(&["request", "-"], &request.to_string()), 2, &expected, &keys.to_string());
    };
    refused("statics", serde_json::json!({ "wanted_tension_n": [100.0] }), "target_tension_n");
    refused("stiffness", serde_json::json!({ "assembly": "paper" }), "without-geometric-stiffness");
    for (old, new) in [
        ("exact", "catenary-dynamic"),
        ("closed-form", "shallow-dynamic"),
        ("catenary-tangent", "catenary-static"),
        ("static-sag", "shallow-static"),
    ] {
        refused("modes", serde_json::json!({ "below_hz": 5.0, "cable_model": old }), new);
    }
}

#[test]
fn a_robot_without_a_state_is_told_which_options_give_one() {
    let text: String =
        yuan().lines().filter(|line| !line.starts_with("unstrained")).map(|l| l.to_owned() + "\n").collect();
    for line in ["statics -", "modes - --below-hz 5", "compare - --below-hz 5", "stiffness -"] {
        let arguments: Vec<&str> = line.split(' ').collect();
        assert_refused(&run_with(&arguments, &text), 2, "give --lengths-m or --pose", line);
    }
    assert_refused(&run_with(&["pose-error", "-", "--mass-kg", "10:20:3"], &text), 2, "give --lengths-m", "pose-error");
    assert_eq!(run_with(&["statics", "-", "--pose", "0,0,0.5"], &text).status.code(), Some(0));
}

#[test]
fn bytes_that_are_no_text_are_refused() {
    let output = super::command(&["check", "-"]).write_stdin(vec![b'a', 0xff]).output().unwrap();
    assert_refused(&output, 2, "not valid UTF-8 at byte 2", "bytes");
}

#[test]
fn a_point_mass_neither_turns_nor_extends() {
    let robot = super::robot("sap2000-8-cable-point-mass.toml");
    for (line, expected) in [
        ("--input mz --output z", "a point mass has no rotation"),
        ("--input fz --output rz", "a point mass has no rotation"),
        ("--input fz --output z --input-point-m 0,0,1", "leave out the point of the input"),
    ] {
        let arguments: Vec<&str> = ["frf", &robot, "--from-hz", "1", "--to-hz", "2", "--points", "5"]
            .into_iter()
            .chain(line.split(' '))
            .collect();
        assert_refused(&run(&arguments), 2, expected, line);
    }
    assert_refused(&run(&["statics", &robot, "--pose", "1,1,1,10,0,0"]), 2, "no orientation", "pose");
}

#[test]
fn no_solution_has_its_own_exit_code() {
    let output = run(&["statics", "ROBOT", "--pose", "0,0,8", "--static-model", "spring"]);
    assert_refused(&output, 1, "no equilibrium", "above the anchors");
    let output = run(&["statics", "ROBOT", "--pose", "30,0,1"]);
    assert_refused(&output, 1, "no tensions found", "outside");
}

#[test]
fn every_command_has_help_with_an_example() {
    for verb in [
        "check",
        "parameters",
        "statics",
        "stiffness",
        "modes",
        "frf",
        "compare",
        "gradient",
        "uncertainty",
        "payload",
        "pose-error",
        "cable",
    ] {
        let help = super::succeed(&[verb, "--help"]);
        assert!(help.contains("Example") && help.contains(&format!("funicular {verb} ")), "{verb}: {help}");
        assert!(help.contains("--set") && help.contains("--format"), "{verb}");
    }
    for verb in ["report", "paper"] {
        let help = super::succeed(&[verb, "--help"]);
        assert!(help.contains("Example") && help.contains(&format!("funicular {verb}")), "{help}");
    }
    assert!(super::succeed(&["--version"]).starts_with("funicular "));
    let bare = run(&[]);
    assert_eq!(bare.status.code(), Some(2));
}

#[test]
fn tensions_that_no_choice_provides_are_no_solution_and_what_binds_is_named() {
    let cogiro = super::robot("cogiro.toml");
    let refused = |options: &[&str], code, expected| {
        assert_refused(
            &run(&[&["statics", cogiro.as_str(), "--pose", "0,0,1.5"], options].concat()),
            code,
            expected,
            expected,
        );
    };
    refused(&["--max-tension-n", "200"], 1, "the best tensions violate the limits by ");
    refused(&["--max-tension-n", "200"], 1, "because of the maximum of cables ");
    refused(&["--target-tension-n", "1,2"], 2, "2 target tensions given for 8 cables");
    refused(&["--tension-rule", "stiffest", "--static-model", "ideal"], 2, "ideal cables, which are rigid");
}
