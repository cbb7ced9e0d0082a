//! `reduce`: state space and second-order form, and their files.

use super::{json, number, numbers, robot, run, stderr, succeed};
use serde_json::Value;
use std::process::Stdio;
use std::time::{Duration, Instant};

/// Arguments of a state space with one input and two outputs.
const SMALL: [&str; 10] =
    ["reduce", "ROBOT", "--below-hz", "3", "--input", "fz", "--output", "az", "--output", "cable:3@0.5:z"];

/// Rows of a matrix in JSON.
fn matrix(value: &Value) -> Vec<Vec<f64>> {
    value.as_array().unwrap().iter().map(numbers).collect()
}

#[test]
fn a_state_space_has_few_states_and_keeps_its_tolerance() {
    let found = json(&[&SMALL[..], &["--tolerance", "0.02"]].concat());
    let n = found["order"].as_u64().unwrap() as usize;
    assert_eq!(found["form"], "state-space");
    assert!((2..40).contains(&n) && number(&found["complete_order"]) > 100.0, "{n}");
    assert!(number(&found["error"]) <= 0.02 && number(&found["damping_error"]) <= number(&found["error"]) + 0.02);
    let (a, b, c, d) = (matrix(&found["a"]), matrix(&found["b"]), matrix(&found["c"]), matrix(&found["d"]));
    assert_eq!([a.len(), a[0].len(), b.len(), b[0].len(), c.len(), c[0].len()], [n, n, n, 1, 2, n]);
    assert_eq!([d.len(), d[0].len()], [2, 1]);

    // Each mode has its states, and each response its error.
    let states: u64 = found["states"].as_array().unwrap().iter().map(|row| row["states"].as_u64().unwrap()).sum();
    assert_eq!(states as usize, n);
    for row in found["responses"].as_array().unwrap() {
        assert!(number(&row["error"]) <= 0.02 && number(&row["peak"]) > 0.0, "{row}");
    }

    let text = succeed(&[&SMALL[..], &["--order", "8"]].concat());
    assert!(
        text.contains("8 states; the complete model has") && text.contains("of the peak of each response"),
        "{text}"
    );
    let csv = succeed(&[&SMALL[..], &["--order", "8", "--format", "csv"]].concat());
    assert_eq!(csv.lines().count(), 5, "{csv}");
}

#[test]
fn a_state_space_is_written_for_numpy_matlab_and_as_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let written = |name: &str| json(&[&SMALL[..], &["--order", "6", "--matrices", &place(name)]].concat());
    let found = written("m.npz");
    let mut archive = zip::ZipArchive::new(std::fs::File::open(place("m.npz")).unwrap()).unwrap();
    let mut bytes = Vec::new();
    std::io::copy(&mut archive.by_name("A.npy").unwrap(), &mut bytes).unwrap();
    let values: Vec<f64> = npyz::NpyFile::new(&bytes[..]).unwrap().into_vec().unwrap();
    let a = matrix(&found["a"]);
    assert!((0..6).all(|i| (0..6).all(|j| values[j * 6 + i].to_bits() == a[i][j].to_bits())));

    written("m.mat");
    let mat = std::fs::read(place("m.mat")).unwrap();
    assert!(mat.starts_with(b"MATLAB 5.0 MAT-file") && mat.len() % 8 == 0);

    written("folder");
    let text = std::fs::read_to_string(place("folder/D.csv")).unwrap();
    assert_eq!(text.lines().count(), 2);
    assert!(folder.path().join("folder/description.json").exists());
}

/// Texts of a member of a NumPy archive: characters of four bytes, of one width, behind the header.
fn member_texts(archive: &mut zip::ZipArchive<std::fs::File>, name: &str) -> Vec<String> {
    let mut bytes = Vec::new();
    std::io::copy(&mut archive.by_name(&format!("{name}.npy")).unwrap(), &mut bytes).unwrap();
    let start = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let header = String::from_utf8_lossy(&bytes[10..start]).into_owned();
    let width: usize = header.split("<U").nth(1).unwrap().split('\'').next().unwrap().parse().unwrap();
    assert_eq!(start % 64, 0, "{header}");
    let character = |bytes: &[u8]| char::from_u32(u32::from_le_bytes(bytes.try_into().unwrap())).unwrap();
    let text = |bytes: &[u8]| bytes.chunks(4).map(character).filter(|c| *c != '\0').collect();
    bytes[start..].chunks(4 * width).map(text).collect()
}

#[cfg(unix)]
#[test]
fn ctrl_c_stops_it_with_the_exit_code_of_maps_and_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (result, matrices) = (place("model.json"), place("model.npz"));
    let mut long = std::process::Command::new(env!("CARGO_BIN_EXE_funicular"));
    long.args(["reduce", &robot("cogiro.toml"), "--pose", "1,1,1.5", "--below-hz", "80", "--tolerance", "1e-4"]);
    let child = long.args(["-o", &result, "--matrices", &matrices]).stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(Duration::from_secs(2));

    let interrupted = Instant::now();
    assert!(std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    // A second, and what a busy machine adds.
    assert!(interrupted.elapsed() < Duration::from_secs(5), "{:?}", interrupted.elapsed());
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert_eq!(stderr(&output), "error: stopped before the end\n");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_state_space_that_cannot_be_is_refused() {
    let with = |more: &[&'static str]| run(&[&SMALL[..], more].concat());
    // Springs have no damping of their own.
    let springs = run(&["reduce", "ROBOT", "--below-hz", "20", "--input", "fz", "--cable-model", "spring"]);
    assert_eq!(springs.status.code(), Some(1), "{}", stderr(&springs));
    assert!(stderr(&springs).contains("has no damping: a response has no peak"), "{}", stderr(&springs));

    for (more, code, says) in [
        (&["--order", "8", "--tolerance", "0.1"][..], 2, "--order and --tolerance both decide the number of states"),
        (&["--order", "1"], 2, "--order is 1: give a number of states from 2 to 400"),
        (&["--order", "8", "--form", "second-order"], 2, "take --form `state-space`"),
        (&["--tolerance", "0"], 2, "tolerance"),
        (&["--tolerance", "1e-11"], 1, "no state space has an error of at most"),
        (&["--cable-model", "shallow-dynamic"], 2, "choose the cable model `catenary-dynamic`"),
    ] {
        let refused = with(more);
        assert!(stderr(&refused).contains(says), "{more:?}: {}", stderr(&refused));
        assert_eq!(refused.status.code(), Some(code), "{more:?}: {}", stderr(&refused));
    }
}

#[test]
fn a_reduced_model_is_read_by_others_as_it_was_made() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let arguments = [&SMALL[..], &["--form", "second-order"]].concat();
    fn with<'a>(arguments: &[&'a str], model: &'a str) -> Vec<&'a str> {
        [arguments, &["--matrices", model]].concat()
    }
    let (npz, csv) = (place("my model.npz"), place("a folder"));
    let found = json(&with(&arguments, &npz));
    let n = found["order"].as_u64().unwrap();
    assert!(number(&found["truncation_error"]) <= 1e-3 && number(&found["frequency_error"]) < 1e-4);
    assert!(succeed(&with(&arguments, &csv)).contains(&format!("{n} coordinates: the platform's 6")));
    let mut archive = zip::ZipArchive::new(std::fs::File::open(&npz).unwrap()).unwrap();
    let shapes =
        [("M", [n, n]), ("K", [n, n]), ("B", [n, 1]), ("L", [2, n]), ("ss_A", [2 * n, 2 * n]), ("ss_D", [2, 1])];
    for (name, shape) in shapes {
        let mut bytes = Vec::new();
        std::io::copy(&mut archive.by_name(&format!("{name}.npy")).unwrap(), &mut bytes).unwrap();
        let array = npyz::NpyFile::new(&bytes[..]).unwrap();
        assert_eq!((array.shape(), array.order()), (&shape[..], npyz::Order::Fortran), "{name}");
        let values: Vec<f64> = array.into_vec().unwrap();
        // The CSV files hold equal numbers, row by row.
        let text = std::fs::read_to_string(format!("{csv}/{name}.csv")).unwrap();
        let rows: Vec<Vec<f64>> =
            text.lines().map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect();
        assert_eq!([rows.len() as u64, rows[0].len() as u64], shape, "{name}");
        for (i, row) in rows.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                assert_eq!(value.to_bits(), values[j * rows.len() + i].to_bits(), "{name} {i} {j}");
            }
        }
    }
    // NumPy reads arrays alone, so that names and description are arrays of texts.
    assert_eq!(member_texts(&mut archive, "inputs"), ["fz"]);
    assert_eq!(member_texts(&mut archive, "outputs").len(), 2);
    let description: serde_json::Value = serde_json::from_str(&member_texts(&mut archive, "description")[0]).unwrap();
    assert_eq!(description["order"], n);
    assert!(archive.file_names().all(|name| std::path::Path::new(name).extension().is_some_and(|end| end == "npy")));
    // Existing files are never overwritten.
    let refused = run(&with(&arguments, &csv));
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("is not empty"), "{}", stderr(&refused));
    let refused = run(&with(&arguments, &place("model.h5")));
    assert!(stderr(&refused).contains("neither ends in .npz, .mat or .fmu nor is a folder"), "{}", stderr(&refused));
    let refused = run(&[&SMALL[..], &["--form", "second-order", "--cable-model", "shallow-dynamic"]].concat());
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("choose the cable model `catenary-dynamic`"), "{}", stderr(&refused));
}

/// The program with an environment for its C compiler.
fn with_compiler(arguments: &[&str], variables: &[(&str, &str)]) -> std::process::Output {
    let path = robot("yuan2014-4mm.toml");
    let arguments = arguments.iter().map(|argument| if *argument == "ROBOT" { path.as_str() } else { argument });
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_funicular"));
    command.args(arguments).envs(variables.iter().copied()).output().unwrap()
}

#[test]
fn a_unit_of_a_simulation_holds_model_source_robot_and_error() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let made = |name: &str, variables: &[(&str, &str)]| {
        let path = place(name);
        let output = with_compiler(&[&SMALL[..], &["--order", "6", "--to", "fmu", "-o", &path]].concat(), variables);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        (zip::ZipArchive::new(std::fs::File::open(&path).unwrap()).unwrap(), stderr(&output).to_owned())
    };
    let text = |archive: &mut zip::ZipArchive<std::fs::File>, name: &str| {
        std::io::read_to_string(archive.by_name(name).unwrap()).unwrap()
    };

    let (mut archive, _) = made("model.fmu", &[]);
    let description = text(&mut archive, "modelDescription.xml");
    for name in ["\"fz\" valueReference=\"0\" causality=\"input\"", "\"cable:3@0.5:z\" valueReference=\"2\"", "der(x6)"]
    {
        assert!(description.contains(name), "{name}: {description}");
    }
    let file = std::fs::read_to_string(robot("yuan2014-4mm.toml")).unwrap();
    assert_eq!(text(&mut archive, "resources/robot.toml"), file);
    let told: Value = serde_json::from_str(&text(&mut archive, "resources/description.json")).unwrap();
    let error = format!("at most {:.3e} of their peaks", number(&told["error"]));
    assert!(description.contains(&error), "{error}: {description}");

    // Without a compiler, and with one that fails, the unit has its source, and a sentence says so.
    for (variables, reason) in [
        ([("PATH", ""), ("CC", "")], "no C compiler was found"),
        ([("PATH", "/usr/bin:/bin"), ("CC", "false")], "the C compiler `false` fails"),
    ] {
        let (mut archive, said) = made("source.fmu", &variables);
        assert!(said.contains(reason) && said.contains("the unit holds its C source alone"), "{said}");
        assert!(!archive.file_names().any(|name| name.starts_with("binaries/")));
        assert_eq!(text(&mut archive, "modelDescription.xml"), description);
    }

    // By its ending the unit is a file of matrices, too.
    let path = place("again.fmu");
    let output = with_compiler(&[&SMALL[..], &["--order", "6", "--matrices", &path]].concat(), &[("PATH", "")]);
    assert!(output.status.success() && std::path::Path::new(&path).is_file(), "{}", stderr(&output));

    for (more, says) in [
        (vec!["--to", "fmu", "-o", "model.txt"], "give -o FILE.fmu"),
        (vec!["--to", "fmu"], "--output-file"),
        (vec!["--form", "second-order", "--matrices", &path], "leave out --form second-order"),
    ] {
        let refused = run(&[&SMALL[..], &more].concat());
        assert_eq!(refused.status.code(), Some(2));
        assert!(stderr(&refused).contains(says), "{}", stderr(&refused));
    }
}

/// Winches with a position control: their commanded lengths are inputs, tensions outputs.
#[test]
fn winches_with_a_control_are_actuators_of_the_model() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let servo = |name: &str, delay: &str| {
        let text = std::fs::read_to_string(robot("cogiro-winches.toml")).unwrap();
        let keys = format!("gear_ratio = 3\ncontrol = \"position\"\nbandwidth_hz = 3\n{delay}");
        std::fs::write(place(name), text.replace("gear_ratio = 3\n", &keys)).unwrap();
        place(name)
    };
    let file = servo("robot.toml", "");
    let asked = ["reduce", &file, "--below-hz", "2.5", "--input", "length:1", "--output", "tension:1"];

    let found = json(&[&asked[..], &["--tolerance", "0.02"]].concat());
    assert!(number(&found["error"]) <= 0.02);
    assert_eq!((&found["inputs"][0]["unit"], &found["outputs"][0]["unit"]), (&"m".into(), &"N".into()));
    assert_eq!(found["responses"][0]["unit"], "N/m");
    let ratios = found["states"].as_array().unwrap().iter().map(|row| number(&row["damping_ratio"]));
    let strongest = ratios.fold(0.0, f64::max);
    assert!(strongest > 0.3, "{strongest}");

    // The second-order form has matrices for rates, and says that it has no state space.
    let matrices = place("second");
    let second = ["--form", "second-order", "--tolerance", "0.01", "--matrices", &matrices];
    let found = json(&[&asked[..], &second].concat());
    let warning = found["warnings"][0].as_str().unwrap();
    assert!(warning.contains("output 1 contains the rate of change of input 1"), "{warning}");
    let is_written = |name: &str| std::path::Path::new(&matrices).join(format!("{name}.csv")).exists();
    assert!(["M", "C", "K", "B", "L", "B1", "L2", "D0"].into_iter().all(is_written));
    assert!(!["B2", "ss_A", "ss_D"].into_iter().any(is_written));

    // A delay has no second-order form.
    let delayed = servo("delayed.toml", "delay_s = 0.002\n");
    let output = run(&["reduce", &delayed, "--below-hz", "2.5"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("cable \"1\" has a delay of 0.002 s"), "{}", stderr(&output));
}
