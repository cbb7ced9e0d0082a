//! Requests as JSON: every command prints its own, and the program runs it with the same result.

use super::{robot, run, run_with, stderr, stdout, succeed};

/// Command lines that print their result.
#[expect(clippy::too_many_lines, reason = "a table")]
fn command_lines() -> Vec<Vec<String>> {
    let cogiro = robot("cogiro.toml");
    let lines: [&[&str]; 29] = [
        &["check", &cogiro],
        &["parameters", &cogiro, "--set", "platform.center_of_mass_m.x=0.1"],
        &["statics", &cogiro, "--pose", "1,2,1.5", "--tension-rule", "middle", "--max-tension-n", "1200"],
        &["statics", "ROBOT", "--set", "platform.mass_kg=20", "--force-n", "1,-2,0", "--load-point-m", "0.1,0,0"],
        &["statics", "ROBOT", "--all"],
        &["stiffness", "ROBOT", "--at-hz", "3.5", "--cable-model", "shallow-dynamic", "--in-plane-only"],
        &["modes", "ROBOT", "--below-hz", "2", "--input", "fz", "--output", "cable:3@0.5:az", "--stations", "5"],
        &[
            "frf",
            "ROBOT",
            "--from-hz",
            "0.1",
            "--to-hz",
            "5",
            "--points",
            "40",
            "--log",
            "--input",
            "f:1,0,1",
            "--output",
            "x",
        ],
        &[
            "frf",
            "ROBOT",
            "--from-hz",
            "1",
            "--to-hz",
            "3",
            "--adaptive",
            "--input",
            "fx",
            "--input",
            "mz",
            "--output",
            "x",
        ],
        &["compare", &cogiro, "--below-hz", "3", "--assembly", "without-geometric-stiffness"],
        &["gradient", "ROBOT", "--of", "pose,tensions", "--by", "platform,cables.*.anchor_m.z", "--per", "tolerance"],
        &[
            "uncertainty",
            "ROBOT",
            "--deviations",
            "platform.mass_kg=1%,platform.center_of_mass_m=0.005",
            "--tolerances",
            "cables.*.anchor_m=0.001",
            "--hold",
            "pose",
            "--of",
            "lengths",
            "--method",
            "sampled",
            "--samples",
            "12",
            "--seed",
            "7",
        ],
        &["pose-error", "ROBOT", "--mass-kg", "10.55:86.35:4", "--tolerance-mm", "5"],
        &["cable", "ROBOT", "--name", "1", "--from-hz", "0.1", "--to-hz", "5", "--points", "9"],
        &[
            "map",
            &cogiro,
            "--grid",
            "x=-1:1:3",
            "--grid",
            "y=0,0.5",
            "--grid",
            "z=1",
            "--quantity",
            "tensions,stiffness-min",
        ],
        &["sweep", "ROBOT", "--vary", "platform.mass_kg=10,20", "--quantity", "pose,frequencies:2"],
        &["settle", "ROBOT", "--release-n", "0,0,-1", "--below-hz", "2", "--tolerance-m", "5e-4"],
        &[
            "gust",
            "ROBOT",
            "--set",
            "materials.rope-4mm.drag_coefficient=1.2",
            "--wind-m-s",
            "5,0,0",
            "--turbulence",
            "kaimal",
            "--intensity",
            "0.1,0.1,0.1",
            "--length-scale-m",
            "50,20,5",
            "--output",
            "z",
            "--below-hz",
            "1.5",
        ],
        &["loads", &cogiro, "--pose", "1,1,1.5", "--required-force-n", "100,100,100"],
        &["speeds", &cogiro, "--pose", "1,1,1.5", "--required-velocity-m-s", "1,1,0.5"],
        &["winches", &cogiro, "--grid", "x=-1,1", "--grid", "z=1.5", "--required-velocity-m-s", "1,1,0.5"],
        &["observability", &cogiro, "--pose", "1,1,1.5", "--sensors", "tensions,tracker"],
        &["clearance", &cogiro, "--pose", "1,1,1.5"],
        &[
            "trajectory",
            &cogiro,
            "--pose",
            "1,1,1.5",
            "--move-to",
            "1.5,1,1.5",
            "--speed-m-s",
            "1",
            "--acceleration-m-s2",
            "1",
            "--jerk-m-s3",
            "10",
            "--sample-time-s",
            "0.2",
        ],
        &["workspace", &cogiro, "--step-m", "2", "--max-tension-n", "5000"],
        &["prove", &cogiro, "--pose", "0,0,1.5", "--within-m", "2,1,0.5", "--within-deg", "0,0,1", "--boxes", "30"],
        &["export", "ROBOT", "--to", "vtk", "--segments", "3", "--modes-below-hz", "1"],
        &["new", "--cables", "6", "--motion", "rigid", "--box-m", "0.4,0.3,0.2", "--mass-kg", "20", "--rope", "7x7"],
        &["schema"],
    ];
    lines.iter().map(|line| line.iter().map(|word| (*word).to_owned()).collect()).collect()
}

#[test]
fn the_request_of_a_command_gives_its_result() {
    for line in command_lines() {
        let words: Vec<&str> = line.iter().map(String::as_str).collect();
        // Rows, not their summary, where there are rows; a file of another program has one format.
        let format: &[&str] = if ["export", "new", "schema"].contains(&words[0]) { &[] } else { &["--format", "csv"] };
        let direct = succeed(&[&words[..], format].concat());
        let request = succeed(&[&words[..], &["--print-request"]].concat());
        let again = run_with(&[&["request", "-"][..], format].concat(), &request);
        assert_eq!(again.status.code(), Some(0), "{line:?}: {}", stderr(&again));
        assert_eq!(stdout(&again), direct, "{line:?}");
    }
}

/// Every command of the program but `request` itself prints a request that runs again: with the result of the command,
/// or with a page or file. What a command writes to files stands after its words.
#[test]
fn the_request_of_every_command_runs_again() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let [cogiro, parquet, part, all, page] =
        [robot("cogiro.toml"), at("rows.parquet"), at("part.parquet"), at("all.parquet"), at("rows.html")];
    let hall = super::project("docs/quick-start/hall.toml");
    let modes = super::project("docs/identification/hall-modes.csv");
    let tripod = super::project("docs/import/tripod.wcrfx");
    let sweep = ["sweep", "ROBOT", "--vary", "platform.mass_kg=10,20", "--quantity", "pose"];
    succeed(&[&sweep[..], &["-o", &parquet]].concat());
    succeed(&[&sweep[..], &["--part", "1/1", "-o", &part]].concat());

    let machine = super::project("docs/calibration/machine.toml");
    let release = super::project("docs/simulation/release.toml");
    let belts = super::project("docs/calibration/belts.csv");
    let [run, machine_at_rest] =
        ["run.csv", "robot.toml"].map(|name| super::project(&format!("docs/estimation/{name}")));
    let decay = super::project("docs/identification/hall-decay.csv");
    let lines: [(&[&str], &[&str]); 15] = [
        (&["reduce", "ROBOT", "--below-hz", "1.3", "--input", "fz", "--output", "z", "--order", "4"], &[]),
        (&["reduce", "ROBOT", "--below-hz", "1.3", "--form", "second-order"], &[]),
        (&["payload", &cogiro, "--pose", "1,2,1.5"], &[]),
        (&["identify", &hall, "--hold-lengths-of-pose", "--measured", &modes, "--fit", "platform.mass_kg"], &[]),
        (&["identify", &hall, "--measured", &decay, "--history-from-s", "0.5", "--history-poles", "1"], &[]),
        (
            &["design", &cogiro, "--pose", "0,0,1.5", "--change", "cables.1.anchor_m.z=±0.1", "--max-iterations", "1"],
            &[],
        ),
        (&["calibrate", &machine, "--readings", &belts, "--propose", "1", "--grid", "x=1:4:4"], &[]),
        (&["estimate", &machine_at_rest, "--log", &run, "--every-s", "0.5"], &[]),
        (
            &["simulate", "ROBOT", "--mass-kg", "12.5", "--scenario", &release, "--for", "0.05", "--point", "a=0,0,1"],
            &[],
        ),
        (&["export", "ROBOT", "--to", "moordyn", "--mass-kg", "12.5", "--scenario", &release, "--for", "0.05"], &[]),
        (&["import", &tripod], &[]),
        (&["report", "ROBOT", "--below-hz", "1.3"], &["-o", "-"]),
        (&["validate", "--only", "catenary,paper", "--level", "published", "--controls"], &[]),
        (&["merge", &part, "-o", &all], &["-o", &all]),
        (&["plot", &parquet], &["-o", &page]),
    ];
    for (words, more) in lines {
        let request = succeed(&[words, &["--print-request"]].concat());
        let again = run_with(&[&["request", "-"][..], more].concat(), &request);
        assert_eq!(again.status.code(), Some(0), "{words:?}: {}", stderr(&again));
        if more.is_empty() {
            assert_eq!(stdout(&again), succeed(words), "{words:?}");
        }
    }
    assert!(std::path::Path::new(&all).is_file() && std::path::Path::new(&page).is_file());

    // The matrices go where the option says, and belong to `reduce` alone.
    let matrices = at("model.npz");
    let request = succeed(&["reduce", "ROBOT", "--below-hz", "1.3", "--print-request"]);
    let again = run_with(&["request", "-", "--matrices", &matrices], &request);
    assert!(again.status.code() == Some(0) && std::path::Path::new(&matrices).is_file(), "{}", stderr(&again));
    let request = succeed(&["check", "ROBOT", "--print-request"]);
    let refused = run_with(&["request", "-", "--matrices", &matrices], &request);
    assert!(refused.status.code() == Some(2) && stderr(&refused).contains("`check` writes no --matrices"));

    // `live`, `paper`, `completions` and `man` have tests of their own; every other command is in one of the lists.
    let help = succeed(&["--help"]);
    let commands =
        help.split("Commands:").nth(1).unwrap().lines().skip(1).take_while(|line| !line.is_empty()).filter_map(
            |line| {
                let name = line.strip_prefix("  ")?.split(' ').next().unwrap();
                (!name.is_empty()).then_some(name)
            },
        );
    let tried: Vec<String> = command_lines().iter().map(|line| line[0].clone()).collect();
    let tried: Vec<&str> = tried.iter().map(String::as_str).chain(lines.iter().map(|(words, _)| words[0])).collect();
    let untried: Vec<&str> = commands.filter(|name| !tried.contains(name)).collect();
    let others = ["request", "help", "live", "paper", "completions", "man"];
    assert!(untried.iter().all(|name| others.contains(name)), "{untried:?}");
}

#[test]
fn a_request_that_cannot_be_read_says_where_and_what_there_is() {
    let text = serde_json::to_string(&super::yuan()).unwrap();
    for (request, says) in [
        (String::new(), "the request is not valid JSON"),
        ("[]".to_owned(), "the request is not a JSON object"),
        (r#"{"robot": {"text": ""}}"#.to_owned(), "it has no `command`"),
        (r#"{"command": "static"}"#.to_owned(), "there is no command `static`; did you mean `statics`?"),
        (r#"{"command": "statics"}"#.to_owned(), "a request of `statics` needs `robot`"),
        (
            format!(r#"{{"command": "statics", "robot": {{"text": {text}}}, "poze": [0, 0, 1]}}"#),
            "no key `poze`; did you mean `pose`?",
        ),
        (
            format!(r#"{{"command": "statics", "robot": {{"text": {text}}}, "below_hz": 3}}"#),
            "`statics` has no key `below_hz`",
        ),
        (format!(r#"{{"command": "statics", "robot": {{"text": {text}}}, "pose": [0, 0]}}"#), "a pose is [x, y, z]"),
        (
            format!(r#"{{"command": "statics", "robot": {{"text": {text}}}, "mass_kg": -1}}"#),
            "`mass_kg`: -1 is not positive",
        ),
        (
            format!(r#"{{"command": "statics", "robot": {{"text": {text}}}, "static_model": "catenery"}}"#),
            "did you mean `catenary`?",
        ),
        (
            format!(r#"{{"command": "compare", "robot": {{"text": {text}}}}}"#),
            "a request of `compare` needs `below_hz`",
        ),
        (
            format!(
                r#"{{"command": "frf", "robot": {{"text": {text}}}, "from_hz": 1, "to_hz": 2, "points": 9, "input": 3, "output": "z"}}"#
            ),
            "a signal is a text, and several signals are a list of texts",
        ),
        (
            format!(
                r#"{{"command": "frf", "robot": {{"text": {text}}}, "from_hz": 1, "to_hz": 2, "points": 9, "input": [], "output": "z"}}"#
            ),
            "--input is an empty list: name at least one signal",
        ),
        (
            r#"{"command": "paper", "schema": "funicular-request/9"}"#.to_owned(),
            "this program reads funicular-request/1",
        ),
        (r#"{"command": "statics", "robot": {"text": "a = 1"}}"#.to_owned(), "unknown key `a`"),
    ] {
        let output = run_with(&["request", "-"], &request);
        assert_eq!(output.status.code(), Some(2), "{request}");
        assert!(stderr(&output).contains(says), "{request}\n{}", stderr(&output));
        assert!(stdout(&output).is_empty());
    }
    let missing = run(&["request", "no-such-file.json"]);
    assert_eq!(missing.status.code(), Some(2));
    assert!(stderr(&missing).contains("cannot read the request no-such-file.json"), "{}", stderr(&missing));
}
