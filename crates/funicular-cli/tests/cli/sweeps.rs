//! `map`, `sweep` and `merge`: rows, and what becomes of them when the program is stopped.

use super::{command, json, robot, run, stderr, stdout, succeed, yuan};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Rows of a CSV on stdout: header and cells.
fn rows(text: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().unwrap().iter().map(str::to_owned).collect();
    (header, reader.records().map(|row| row.unwrap().iter().map(str::to_owned).collect()).collect())
}

fn column(text: &str, name: &str) -> Vec<String> {
    let (header, rows) = rows(text);
    let at = header.iter().position(|column| column == name).unwrap_or_else(|| panic!("{name} in {header:?}"));
    rows.into_iter().map(|row| row[at].clone()).collect()
}

#[test]
fn a_map_has_a_row_for_every_point_and_a_reason_where_there_is_no_number() {
    let text = succeed(&["map", "ROBOT", "--grid", "x=-6:6:3", "--grid", "y=0", "--grid", "z=0.5", "--format", "csv"]);
    assert_eq!(column(&text, "x_m"), ["-6.0", "0.0", "6.0"]);
    assert_eq!(column(&text, "feasible"), ["false", "true", "false"]);
    assert_eq!(column(&text, "status")[0], "negative-tension");
    assert!(column(&text, "reason")[0].contains("would need"), "{text}");
    let tensions = column(&text, "tension_max_n");
    assert!(tensions[0].is_empty() && tensions[1].parse::<f64>().unwrap() > 50.0, "{tensions:?}");
    // The orientation of the robot's own state.
    assert!(column(&text, "pitch_deg")[1].starts_with("2.884"));
}

#[test]
fn the_schema_of_columns_has_the_columns_of_a_map_with_every_quantity() {
    let schema: serde_json::Value = serde_json::from_str(&succeed(&["schema", "--of", "columns"])).unwrap();
    let tables = schema["map"].as_array().unwrap();
    let names = |table: &serde_json::Value| -> Vec<String> {
        table["columns"].as_array().unwrap().iter().map(|of| of["name"].as_str().unwrap().to_owned()).collect()
    };
    let quantity = |table: &serde_json::Value| {
        let name = table["with"].as_str().unwrap();
        name.replace(":N", ":1")
            .replace(":MODEL", "")
            .replace(":RESULT:PATH", ":first-frequency:platform.mass_kg")
            .replace(":AXIS", ":x")
    };
    let quantities: Vec<String> = tables[1..].iter().map(quantity).collect();
    let text = succeed(
        &[
            &["map", "ROBOT", "--grid", "x=0", "--grid", "y=0", "--grid", "z=0.5", "--format", "csv", "--quantity"][..],
            &[quantities.join(",").as_str()],
        ]
        .concat(),
    );

    // The cables have the names 1 to 6. Robots with fewer cables have one more column.
    let (header, _) = rows(&text);
    let described: Vec<String> =
        tables.iter().flat_map(names).filter(|name| name != "nearest_pose_distance_m").collect();
    for name in &described {
        assert!(header.contains(&name.replace("NAME", "1")), "{name} in {header:?}");
    }
    for name in &header {
        let is_it = |of: &String| (1..=6).any(|cable| of.replace("NAME", &cable.to_string()) == *name);
        assert!(described.iter().any(is_it), "{name} in {described:?}");
    }
    assert_eq!(schema["sweep"].as_array().unwrap().len(), tables.len());
}

#[test]
fn a_row_of_a_map_is_what_the_command_for_one_pose_says() {
    let robot = robot("cogiro.toml");
    let pose = ["1,-2,1.5,0,0,5", "--tension-rule", "middle", "--max-tension-n", "1500"];
    let one = json(&[&["statics", &robot, "--pose"], &pose[..]].concat());
    let grid = [
        "--grid", "x=1", "--grid", "y=-2", "--grid", "z=1.5", "--grid", "roll=0", "--grid", "pitch=0", "--grid",
        "yaw=5",
    ];
    let requested = ["--quantity", "tensions,lengths", "--format", "csv"];
    let text = succeed(&[&["map", &robot], &grid[..], &pose[1..], &requested[..]].concat());
    for (i, cable) in one["cables"].as_array().unwrap().iter().enumerate() {
        for (key, name) in [("tension_platform_n", "tension_platform"), ("unstrained_length_m", "unstrained_length")] {
            let suffix = key.rsplit('_').next().unwrap();
            let found: f64 = column(&text, &format!("{name}_{}_{suffix}", i + 1))[0].parse().unwrap();
            assert_eq!(found.to_bits(), cable[key].as_f64().unwrap().to_bits(), "{key}");
        }
    }
}

#[test]
fn a_sweep_varies_values_of_the_file_and_a_list_gives_poses() {
    let vary = ["--vary", "platform.mass_kg=10.55,20", "--vary", "materials.rope-4mm.diameter_m=0.003:0.004:2"];
    let text = succeed(&[&["sweep", "ROBOT", "--quantity", "pose,tension-max", "--format", "csv"], &vary[..]].concat());
    assert_eq!(column(&text, "platform.mass_kg"), ["10.55", "20.0", "10.55", "20.0"]);
    assert_eq!(column(&text, "materials.rope-4mm.diameter_m"), ["0.003", "0.003", "0.004", "0.004"]);
    let rest = json(&["statics", "ROBOT", "--mass-kg", "20"]);
    let found: f64 = column(&text, "pose_z_m")[3].parse().unwrap();
    assert!((found - rest["pose"]["position_m"][2].as_f64().unwrap()).abs() < 1e-12);

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("poses.csv");
    fs::write(&path, "time_s,z_m,y_m,x_m\n0,0.5,0,0.25\n1,0.6,0.1,0\n").unwrap();
    let poses = ["map", "ROBOT", "--poses", path.to_str().unwrap()];
    let text = succeed(&[&poses[..], &["--format", "csv"]].concat());
    assert_eq!(column(&text, "x_m"), ["0.25", "0.0"]);
    let summary = json(&poses);
    assert_eq!((summary["command"].as_str(), summary["feasible"].as_u64()), (Some("map"), Some(2)));
    let coordinates = ["x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg"];
    assert_eq!(summary["coordinates"], serde_json::json!(coordinates));
    assert_eq!(summary["ranges"][0]["min_at"].as_array().unwrap().len(), coordinates.len());
    assert!(succeed(&poses).contains("2 rows, 2 feasible (100 %)"));
    fs::write(&path, "x_m,y_m,z_m\n0,0,0.5\n0,zero,0.5\n").unwrap();
    let output = run(&poses);
    assert!(stderr(&output).contains("line 3, column `y_m`: `zero` is not a number"), "{}", stderr(&output));
    // As editors count, whatever ends the lines.
    for (broken, says) in [
        ("x_m,y_m,z_m\r\n0,0,0.5\r\n0,zero,0.5\r\n", "line 3, column `y_m`"),
        ("\u{feff}x_m,y_m,z_m\n\n\n0,0,0.5\n\n0,0,0.5,1\n", "line 6: 4 values, but 3 in the header"),
        ("x_m,y_m,z_m\r\n\r\n0,,0.5\r\n", "line 3, column `y_m`"),
        ("x_m,y_m,z_m\r0,0,0.5\r0,0,a\r", "line 3, column `z_m`"),
    ] {
        fs::write(&path, broken).unwrap();
        assert!(stderr(&run(&poses)).contains(says), "{broken:?}: {}", stderr(&run(&poses)));
    }
    fs::write(&path, "x_m,y_m,z_m\n").unwrap();
    assert!(stderr(&run(&poses)).contains("has a header and no poses"));
}

#[test]
fn a_list_of_poses_is_read_as_spreadsheets_write_it() {
    let folder = tempfile::tempdir().unwrap();
    let rows_of = |text: &str| {
        let path = folder.path().join("poses.csv");
        fs::write(&path, text).unwrap();
        run(&["map", "ROBOT", "--poses", path.to_str().unwrap(), "--format", "csv"])
    };
    let text_of = |output: &std::process::Output| {
        assert!(output.status.success(), "{}", stderr(output));
        String::from_utf8(output.stdout.clone()).unwrap()
    };
    let plain = text_of(&rows_of("x_m,y_m,z_m\n0.25,0,0.5\n0,0.1,0.6\n"));
    for same in [
        "x_m;y_m;z_m\r\n0,25;0;0,5\r\n0;0,1;0,6\r\n",
        "x_m\ty_m\tz_m\n0.25\t0\t0.5\n0\t0.1\t0.6\n",
        "sep=;\nx_m;y_m;z_m\n0.25;0;0.5\n0;0.1;0.6\n",
        "# three columns\n,x_m,y_m,z_m\n0,0.25,0,0.5\n1,0,0.1,0.6\n",
    ] {
        assert_eq!(text_of(&rows_of(same)), plain, "{same:?}");
    }
    let unnamed = rows_of("0.25,0,0.5\n0,0.1,0.6\n");
    assert!(stderr(&unnamed).contains("the first line has no names, only numbers"), "{}", stderr(&unnamed));
}

#[test]
fn rows_are_never_written_over_what_they_are_computed_from() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("poses.csv");
    let poses = "x_m,y_m,z_m\n0,0,0.5\n";
    fs::write(&path, poses).unwrap();
    let path = path.to_str().unwrap();
    let output = run(&["map", "ROBOT", "--poses", path, "-o", path]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("refusing to write the rows over the poses"), "{}", stderr(&output));
    assert_eq!(fs::read_to_string(path).unwrap(), poses);
}

#[test]
fn springs_that_are_all_slack_are_no_pose_to_compare_with() {
    // At the minimum tensions of a robot in a horizontal plane its ropes are longer than their chords.
    let robot = robot("kntu-planar.toml");
    let requested = ["--pose", "0.2,0.1,0,0,0,10", "--grid", "x=0.2", "--quantity", "pose-error", "--format", "csv"];
    let text = succeed(&[&["map", &robot], &requested[..]].concat());
    assert_eq!(column(&text, "status"), ["no-comparison"]);
    assert_eq!(column(&text, "spring_from_catenary_distance_m"), [""]);
    let reason = &column(&text, "reason")[0];
    assert!(reason.contains("with spring cables of the same lengths: the equilibrium does not hold"), "{reason}");
}

/// A map that takes a while, with its file.
fn slow(path: &Path) -> Vec<String> {
    let path = path.to_str().unwrap();
    let words =
        "map ROBOT --grid x=-0.4:0.4:10 --grid y=-0.4:0.4:10 --grid z=0.5 --quantity first-frequency,tensions -o";
    words.split(' ').chain([path]).map(str::to_owned).collect()
}

fn started(arguments: &[String]) -> std::process::Child {
    let path = robot("yuan2014-4mm.toml");
    let arguments = arguments.iter().map(|argument| if argument == "ROBOT" { &path } else { argument });
    let mut command = Command::new(env!("CARGO_BIN_EXE_funicular"));
    command.args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

#[test]
fn killed_twenty_times_and_resumed_a_map_has_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let (path, whole) = (folder.path().join("a.parquet"), folder.path().join("whole.parquet"));
    let begun = Instant::now();
    assert!(started(&slow(&whole)).wait().unwrap().success());
    let takes = begun.elapsed();
    let resumed = [slow(&path), vec!["--resume".to_owned()]].concat();
    let mut killed = 0;
    for i in 0..20_u32 {
        let mut child = started(&resumed);
        // At moments that are spread over starting, the first rows and, in the end, writing the file.
        std::thread::sleep(
            takes.mul_f64(0.13 * f64::from(i * 7 % 20) / 20.0) + Duration::from_millis(u64::from(i % 3)),
        );
        let _ = child.kill();
        killed += u32::from(!child.wait().unwrap().success());
    }
    assert!(killed >= 5, "{killed}: it is slow enough to be killed");
    assert!(started(&resumed).wait().unwrap().success());
    assert!(fs::read(&path).unwrap() == fs::read(&whole).unwrap());
    let names = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let left: Vec<String> = names.filter(|name| name.ends_with(".partial")).collect();
    assert!(left.is_empty(), "{left:?}");
}

#[cfg(unix)]
#[test]
fn interrupted_a_map_keeps_its_rows_and_says_how_to_go_on() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.parquet");
    let mut arguments = slow(&path);
    arguments[3] = "x=-0.4:0.4:1000".to_owned();
    let child = started(&arguments);
    let journal = folder.path().join("a.parquet.partial");
    let length = || fs::metadata(&journal).map_or(0, |metadata| metadata.len());
    let begun = Instant::now();
    while length() < 20_000 && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(5));
    }
    let interrupted = Instant::now();
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    // A second, and what a busy machine adds.
    assert!(interrupted.elapsed() < Duration::from_secs(5), "{:?}", interrupted.elapsed());
    assert_eq!(output.status.code(), Some(130));
    let message = stderr(&output);
    assert!(
        message.contains("continue with the same command and --resume") && message.contains("marked as incomplete"),
        "{message}"
    );
    assert!(path.exists() && journal.exists());
    let again = started(&arguments).wait_with_output().unwrap();
    assert_eq!(again.status.code(), Some(2));
    let discarded = [&slow(&path)[..], &["--discard".to_owned()]].concat();
    assert!(started(&discarded).wait().unwrap().success());
    assert!(!journal.exists());
    assert!(stderr(&again).contains("continue with --resume, or start again with --discard"), "{}", stderr(&again));
}

#[cfg(unix)]
#[test]
fn a_cluster_that_ends_a_job_in_the_middle_of_a_long_row_waits_two_seconds_at_most() {
    let folder = tempfile::tempdir().unwrap();
    let (path, file) = (folder.path().join("a.parquet"), folder.path().join("gusts.toml"));
    // A soft rope has hundreds of modes in the range of gusts, so that a row takes seconds.
    let soft = yuan()
        .replace("youngs_modulus_pa = 100e9", "youngs_modulus_pa = 1e9")
        .replace("mass_kg_per_m = 0.067", "mass_kg_per_m = 0.6")
        .replace("[platform]", "[platform]\ndrag_area_m2 = 1.0");
    let wind = "\n[wind]\nvelocity_m_s = [8.0, 0.0, 0.0]\nturbulence = \"kaimal\"\nintensity = [0.2, 0.15, 0.1]\n\
                length_scale_m = [100.0, 40.0, 10.0]\n";
    fs::write(&file, soft + wind).unwrap();
    let line = format!(
        "sweep {} --vary platform.mass_kg=10:11:9 --quantity gust-rms --threads 1 -o {}",
        file.display(),
        path.display()
    );
    let child = started(&line.split(' ').map(str::to_owned).collect::<Vec<_>>());
    let journal = folder.path().join("a.parquet.partial");
    while !journal.exists() {
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(500));

    let asked = Instant::now();
    assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    // Two seconds, and what a busy machine adds.
    assert!(asked.elapsed() < Duration::from_secs(3), "{:?}", asked.elapsed());
    assert_eq!(output.status.code(), Some(130));
    assert!(stderr(&output).contains("stopped: the finished rows are safe in"), "{}", stderr(&output));
    let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert!(journal.exists() && !left.iter().any(|name| name.to_string_lossy().ends_with(".writing")), "{left:?}");
}

#[test]
fn a_slip_is_warned_of_once_per_run_and_before_the_rows() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.parquet");
    let line = "map ROBOT --pose 0,0,1 --grid x=0:0.1:3 --set materials.rope-4mm.youngs_modulus_pa=20 -o";
    let arguments: Vec<&str> = line.split(' ').chain([path.to_str().unwrap(), "--resume"]).collect();

    // The rows are computed, then found complete.
    for end in ["(3 rows)", " already contains all of 3 rows"] {
        let output = run(&arguments);
        let said = stderr(&output);
        let lines: Vec<&str> = said.lines().collect();
        let warned: Vec<usize> = (0..lines.len()).filter(|i| lines[*i].contains("GPa given as Pa?")).collect();
        assert!(output.status.success() && warned == [0] && lines[lines.len() - 1].contains(end), "{said}");
    }
}

#[test]
fn parts_of_a_map_are_merged_into_the_same_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let robot = robot("cogiro.toml");
    let map = |rest: &[&str]| {
        let grid = ["map", &robot, "--grid", "x=-6:6:31", "--grid", "y=-4:4:9", "--quantity", "tension-max"];
        succeed(&[&grid[..], rest].concat());
    };
    map(&["-o", &file("whole.parquet")]);
    map(&["-o", &file("whole.vti")]);
    for part in ["1/3", "2/3", "3/3"] {
        map(&["-o", &file(&format!("part-{}.parquet", &part[..1])), "--part", part, "--threads", &part[..1]]);
    }
    let parts = ["1", "2", "3"].map(|k| file(&format!("part-{k}.parquet")));
    for ending in ["parquet", "vti"] {
        let merged = file(&format!("merged.{ending}"));
        succeed(&["merge", &parts[2], &parts[0], &parts[1], "-o", &merged]);
        assert!(fs::read(merged).unwrap() == fs::read(file(&format!("whole.{ending}"))).unwrap(), "{ending}");
    }
    // A whole file is summarised as the run was that made it.
    let again = ["-o", &file("whole.parquet"), "--resume", "--format", "json"];
    let grid = ["map", &robot, "--grid", "x=-6:6:31", "--grid", "y=-4:4:9", "--quantity", "tension-max"];
    assert_eq!(succeed(&[&grid[..], &again].concat()), succeed(&[&grid[..], &["--format", "json"]].concat()));
    let output = run(&["merge", &parts[0], &parts[1], "-o", &file("no.parquet")]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("part 3/3 is missing"), "{}", stderr(&output));
    // Nor does one part take the place of another.
    let before = fs::read(&parts[0]).unwrap();
    let output = run(&[&grid[..], &["-o", &parts[0], "--part", "2/3", "--resume"]].concat());
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("its part: \"1/3\", here: \"2/3\""), "{}", stderr(&output));
    assert!(fs::read(&parts[0]).unwrap() == before);
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    let mut child = started(
        &"map ROBOT --grid x=-0.4:0.4:400 --grid y=-0.4:0.4:40 --format csv"
            .split(' ')
            .map(str::to_owned)
            .collect::<Vec<_>>(),
    );
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), ""));
}

#[test]
fn broken_sweeps_are_refused_with_one_message() {
    for (line, expected) in [
        ("map ROBOT", "--grid"),
        ("map ROBOT --grid x", "it has no `=`"),
        ("map ROBOT --grid w=1", "there is no axis `w`"),
        ("map ROBOT --grid x=1:0:5", "it must end above its start"),
        ("map ROBOT --grid x=0:1:1", "2 or more"),
        ("map ROBOT --grid x=0:1:1e3", "is not a number of values"),
        ("map ROBOT --grid x=0:1:5 --grid x=2", "given twice"),
        ("map ROBOT --grid x=0,0.5,0", "the axis `x` has the value 0 twice"),
        (
            "map ROBOT --grid x=0:1:10000 --grid y=0:1:10000 --grid z=0:1:10000",
            "1000000000000 points are more than the 100000000",
        ),
        ("map ROBOT --grid x=0:1:5 --quantity tension-mx", "did you mean `tension-max`?"),
        ("map ROBOT --grid x=0:1:5 --quantity energy,energy", "would appear twice"),
        ("map ROBOT --grid x=0:1:5 --quantity stiffness --static-model ideal", "does not exist for the static model"),
        ("map ROBOT --grid x=0:1:5 --tension-rule lowest", "nothing to choose"),
        ("map ROBOT --grid x=0:1:5 -o rows.txt", "names no format: choose .parquet, .csv or .vti"),
        ("map ROBOT --grid x=0:1:5 -o no/such/folder/a.csv", "there is no directory"),
        ("map ROBOT --grid x=0:1:5 -o /dev/null", "names no format"),
        ("map ROBOT --grid x=0:1:5 -o -", "--format csv and without -o"),
        ("map ROBOT --grid x=0:1:5 --resume", "--output-file"),
        ("map ROBOT --grid x=0:1:5 --part 3/2 -o a.parquet", "is not a part"),
        ("map ROBOT --grid x=0:1:5 --threads 0", "is not a number of threads"),
        ("map ROBOT --poses no-such-file.csv", "cannot read the poses no-such-file.csv"),
        ("sweep ROBOT", "--vary"),
        ("sweep ROBOT --vary platform.mass_kg", "it has no `=`"),
        ("sweep ROBOT --vary platfrom.mass_kg=1:2:3", "did you mean `platform.mass_kg`?"),
        ("sweep ROBOT --vary cables.*.anchor=1:2:3", "did you mean `cables.1.anchor_m`"),
        ("sweep ROBOT --vary platform.mass_kg=-1:2:3", "it must be positive"),
        ("sweep ROBOT --vary platform.mass_kgs=1:2:3", "did you mean `mass_kg`?"),
        ("sweep ROBOT --vary platform.mass_kg=12,14,12", "has the value 12 twice"),
        ("sweep ROBOT --vary platform.mass_kg=10:20:3 --mass-kg 12", "or another option sets it"),
        ("sweep ROBOT --vary cables.1.unstrained_length_m=6:7:3 --pose 0,0,0.5", "changes nothing"),
        ("merge no-such-file.parquet -o a.parquet", "cannot read no-such-file.parquet"),
    ] {
        let output = run(&line.split(' ').collect::<Vec<_>>());
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{line}: {message}");
        assert!(message.contains(expected) && message.matches("error:").count() == 1, "{line}: {message}");
        assert!(!message.contains("panicked") && stdout(&output).is_empty(), "{line}: {message}");
    }
    let camera = robot("stadium-camera.toml");
    let output = command(&["map", &camera, "--grid", "yaw=0:1:3"]).output().unwrap();
    assert!(stderr(&output).contains("cannot move along the axis `yaw`"), "{}", stderr(&output));
}
