//! Files of every command: what is printed, what is told and the exit code are the same by an option, by the ending of
//! `-o`, and by a request in JSON.

use super::{project, robot, run, run_with, stderr, stdout, succeed};
use funicular_answers::outputs;
use std::fs;
use std::path::Path;

/// Commands with files besides their result, each with the arguments of a short run.
fn lines() -> Vec<(&'static str, Vec<String>)> {
    let cogiro = robot("cogiro.toml");
    let machine = project("docs/calibration/machine.toml");
    let belts = project("docs/calibration/belts.csv");
    let [held, log] = ["robot.toml", "run.csv"].map(|name| project(&format!("docs/estimation/{name}")));
    let release = project("docs/simulation/release.toml");
    let camera = robot("stadium-camera.toml");
    let line = |command: &'static str, words: &str| {
        let words = words.replace("COGIRO", &cogiro).replace("MACHINE", &machine).replace("BELTS", &belts);
        let words = words.replace("RELEASE", &release).replace("CAMERA", &camera);
        let words = words.replace("HELD", &held).replace("LOG", &log);
        (command, words.split_whitespace().map(str::to_owned).collect())
    };
    vec![
        line("statics", "ROBOT"),
        line("payload", "COGIRO --pose 1,1,1.5"),
        line("loads", "COGIRO --pose 1,1,1.5 --required-force-n 50,50,50"),
        line("clearance", "COGIRO --pose 1,1,1.5"),
        line("speeds", "COGIRO --pose 1,1,1.5 --required-velocity-m-s 1,1,1"),
        line("winches", "COGIRO --pose 1,1,1.5 --required-velocity-m-s 1,1,1"),
        line("modes", "ROBOT --below-hz 1.3"),
        line("frf", "ROBOT --from-hz 0.5 --to-hz 1 --points 5 --input fz --output az"),
        line("settle", "ROBOT --move-m 0,0.05,0 --profile-s 1.2,0.3 --below-hz 5 --sample-time-s 0.1"),
        line(
            "gust",
            "CAMERA --set materials.rope-5mm.drag_coefficient=1.2 --set materials.rope-5mm.drag_diameter_m=0.005 --set \
             platform.drag_area_m2=0.3 --wind-m-s 12,0,0 --below-hz 1 --turbulence=kaimal --intensity 0.15,0.12,0.075 \
             --length-scale-m 85.05,28.35,6.93 --output z",
        ),
        line("compare", "ROBOT --below-hz 1.3"),
        line("uncertainty", "ROBOT --deviations platform.mass_kg=1%"),
        line(
            "trajectory",
            "COGIRO --pose 1,1,1.5 --move-to 1.5,1,1.5 --speed-m-s 1 --acceleration-m-s2 1 --jerk-m-s3 10 \
             --sample-time-s 0.2",
        ),
        line("simulate", "ROBOT --mass-kg 12.5 --scenario RELEASE --for 0.05 --once"),
        line("reduce", "ROBOT --below-hz 1.3 --input fz --output z --order 4"),
        line("identify", "ROBOT --fit platform.mass_kg --measured-tensions-n 17,36,40,15,50,52 --starts 1"),
        line("calibrate", "MACHINE --readings BELTS"),
        line("estimate", "HELD --log LOG --every-s 0.5"),
        line("design", "COGIRO --pose 0,0,1.5 --change cables.1.anchor_m.z=±0.1 --max-iterations 1"),
        line("workspace", "COGIRO --step-m 2 --max-tension-n 5000 --section z=1.5 --prove --boxes 100"),
        line("prove", "COGIRO --pose 0,0,1.5 --within-m 5,3,1 --boxes 60"),
        line("validate", "--only paper"),
    ]
}

/// Lines of stderr about files, without the size.
fn told(stderr: &str) -> Vec<String> {
    let lines = stderr.lines().filter_map(|line| line.strip_prefix("wrote "));
    lines.map(|line| line.split(" (").next().unwrap_or_default().to_owned()).collect()
}

#[test]
fn a_file_is_told_and_the_text_is_printed_by_every_command_and_from_every_front() {
    let folder = tempfile::tempdir().unwrap();
    let lines = lines();
    for (command, words) in &lines {
        let words: Vec<&str> = [*command].into_iter().chain(words.iter().map(String::as_str)).collect();
        let text = succeed(&words);
        assert!(!text.is_empty(), "{command}");
        // The text of `reduce` says where the matrices are.
        let same = |printed: &str| {
            if *command == "reduce" { printed.lines().next() == text.lines().next() } else { printed == text }
        };
        let quiet = succeed(&[&words[..], &["--quiet"]].concat());
        assert_eq!(quiet, "", "{command}");

        for (output, kind) in outputs::of(command).iter().flat_map(|of| of.kinds.iter().map(move |kind| (of, kind))) {
            let ending = kind.ending().unwrap_or_default();
            let path = |front: &str| {
                folder.path().join(format!("{command}-{}-{front}.{ending}", output.key)).display().to_string()
            };
            let of = |front: &str| format!("{command}, {} by {front}, .{ending}", output.key);
            let option = format!("--{}", output.key.replace('_', "-"));

            let own = path("option");
            let by_option = run(&[&words[..], &[&option, &own]].concat());
            let said = stderr(&by_option);
            assert_eq!(by_option.status.code(), Some(0), "{}: {said}", of("option"));
            assert!(same(stdout(&by_option)), "{}: {}", of("option"), stdout(&by_option));
            assert_eq!(told(said), std::slice::from_ref(&own), "{}", of("option"));
            let bytes = fs::read(&own).unwrap();
            assert!(!bytes.is_empty(), "{}", of("option"));

            let other = path("request");
            let request = succeed(&[&words[..], &[&option, &other, "--print-request"]].concat());
            assert!(!Path::new(&other).exists(), "a request is printed, not run");
            let by_request = run_with(&["request", "-"], &request);
            assert_eq!(by_request.status.code(), Some(0), "{}: {}", of("request"), stderr(&by_request));
            assert!(same(stdout(&by_request)), "{}", of("request"));
            assert_eq!(told(stderr(&by_request)), std::slice::from_ref(&other), "{}", of("request"));
            // A page has the command that made it, and matrices the path of their file.
            if ending != "html" && *command != "reduce" {
                assert!(fs::read(&other).unwrap() == bytes, "{}", of("request"));
            }

            if output.by_ending {
                let named = path("ending");
                let by_ending = run(&[&words[..], &["-o", &named]].concat());
                assert_eq!(by_ending.status.code(), Some(0), "{}: {}", of("-o"), stderr(&by_ending));
                assert!(same(stdout(&by_ending)), "{}", of("-o"));
                assert_eq!(told(stderr(&by_ending)), [named], "{}", of("-o"));
            }
        }

        let result = folder.path().join(format!("{command}.json")).display().to_string();
        let written = run(&[&words[..], &["-o", &result]].concat());
        assert!(written.status.code() == Some(0) && stdout(&written).is_empty(), "{command}: {}", stderr(&written));
        assert_eq!(told(stderr(&written)), [result], "{command}");
    }

    // Every command of the table is there, but `plot` and `report`, whose results are pages themselves.
    let listed: Vec<&str> = lines.iter().map(|(command, _)| *command).collect();
    for info in funicular_study::request::commands() {
        let has_files = !outputs::of(info.name).is_empty();
        assert_eq!(listed.contains(&info.name), has_files && !["plot", "report"].contains(&info.name), "{}", info.name);
    }
}

#[test]
fn a_file_that_a_command_does_not_write_or_that_it_reads_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("robot.svg").display().to_string();
    fs::write(&path, super::yuan()).unwrap();
    let refused = run(&["statics", &path, "--figure", &path]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("refusing to write the figure over the robot file"), "{}", stderr(&refused));
    assert_eq!(fs::read_to_string(&path).unwrap(), super::yuan());

    let request = succeed(&["statics", "ROBOT", "--print-request"]);
    let with = |files: &str| request.replacen('{', &format!("{{\"write_files\": {files},"), 1);
    for (files, says) in [
        (r#"{"page": "a.html"}"#, "`statics` writes no"),
        (r#"{"figure": 5}"#, "5 is not the path of a file"),
        (r#"["a.svg"]"#, "give an object of paths"),
        (r#"{"figure": ["a.svg", "b.svg"]}"#, "leave out one of them"),
        (r#"{"figure": "a.html"}"#, "a figure is written to a file that ends in .svg or .pdf"),
    ] {
        let refused = run_with(&["request", "-"], &with(files));
        assert_eq!(refused.status.code(), Some(2), "{files}");
        assert!(stderr(&refused).contains(says), "{files}: {}", stderr(&refused));
    }
}
