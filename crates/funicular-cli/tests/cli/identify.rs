//! `identify`, and Universal Files that `frf` and `modes` write.

mod histories;
mod universal_files;

use super::{json, number, project, robot, run, stderr, succeed};
use std::fs;

/// A response that the program writes as a Universal File and as a table is found again: the mass, and the same curve
/// from both files.
#[test]
fn a_written_response_gives_the_mass_that_it_has() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let yuan = robot("yuan2014-4mm.toml");
    let response = [
        "frf",
        &yuan,
        "--cable-model",
        "spring",
        "--set",
        "platform.mass_kg=12",
        "--from-hz",
        "0.5",
        "--to-hz",
        "4.1",
        "--points",
        "37",
        "--input",
        "fz",
        "--output",
        "az",
        "--input-point-m",
        "0.03,-0.02,0.05",
        "--output-point-m",
        "0.1,0.08,0.02",
    ];
    let uff = at("test.uff");
    succeed(&[&response[..], &["-o", &uff]].concat());
    let fitted = at("fitted.toml");
    let page = at("page.html");
    let fit = ["--fit", "platform.mass_kg=5:50", "--cable-model", "spring", "--starts", "1"];
    let found =
        json(&[&["identify", &yuan, "--measured", &uff, "--fitted", &fitted, "--page", &page], &fit[..]].concat());
    assert!((number(&found["values"][0]["value"]) - 12.0).abs() < 1e-3, "{}", found["values"]);
    assert_eq!(found["responses"][0]["name"], "az at node 1 / fz at node 2");
    assert!(
        fs::read_to_string(&fitted).unwrap().contains("mass_kg = 12.0")
            || fs::read_to_string(&fitted).unwrap().contains("mass_kg = 11.99")
    );
    let html = fs::read_to_string(&page).unwrap();
    assert!(html.contains("figure-response-1-plot") && html.contains("platform.mass_kg"));

    // That curve as a table.
    let (header, rows) = super::csv(&[&response[..]].concat());
    assert_eq!(header[..3], ["frequency_hz", "real", "imag"]);
    let lines: Vec<String> = rows.iter().map(|row| row[..3].join(",")).collect();
    let table = at("test.csv");
    fs::write(&table, format!("frequency_hz,a_re,a_im\n{}\n", lines.join("\n"))).unwrap();
    let points = ["--input-point-m", "0.03,-0.02,0.05", "--output-point-m", "0.1,0.08,0.02"];
    let by_table =
        json(&[&["identify", &yuan, "--measured", &table, "--response", "a=az/fz"], &points[..], &fit[..]].concat());
    assert!((number(&by_table["values"][0]["value"]) - 12.0).abs() < 1e-3, "{}", by_table["values"]);
}

#[test]
fn the_endings_of_the_output_say_what_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let yuan = robot("yuan2014-4mm.toml");
    let line =
        ["identify", &yuan, "--fit", "platform.mass_kg", "--measured-tensions-n", "17,36,40,15,50,52", "--starts", "1"];
    let toml = at("fitted.toml");
    let text = succeed(&[&line[..], &["-o", &toml]].concat());
    assert!(text.contains("platform.mass_kg"), "{text}");
    succeed(&["check", &toml]);
    let output = run(&[&line[..], &["-o", &toml, "--fitted", &at("b.toml")]].concat());
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(stderr(&output).contains("name a file of the same kind"));
}

#[test]
fn wrong_files_and_values_are_refused_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let yuan = robot("yuan2014-4mm.toml");
    let measured = |name: &str, text: &str, more: &[&str]| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        let line = ["identify", &yuan, "--fit", "platform.mass_kg", "--measured", path.to_str().unwrap()];
        let output = run(&[&line[..], more].concat());
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        stderr(&output).to_owned()
    };
    for (name, text, more, says) in [
        ("a.uff", "no file", &[][..], "is no Universal File"),
        ("a.txt", "no file", &[], "measurements are read from .uff"),
        ("a.csv", "frequency_hz,a_re,a_im\n1,2,3\n", &[], "give --response a=OUTPUT/INPUT"),
        ("a.csv", "frequency_hz\nx\n", &[], "line 2, column `frequency_hz`: `x` is not a number"),
        ("a.csv", "frequency_hz\n1\n", &["--prior", "platform.inertia_kg_m2=1±1"], "no --fit has this path"),
        ("a.csv", "frequency_hz\n1\n", &["--prior", "platform.mass=1±1"], "and was given for `platform.mass_kg`"),
    ] {
        let told = measured(name, text, more);
        assert!(told.contains(says), "{told}");
    }
    for bad in ["platform.mass_kg=3", "platform.mass_kg=a:b"] {
        let output = run(&["identify", &yuan, "--fit", bad]);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    }
    let output = run(&["identify", &yuan, "--fit", "platform.mass_kg"]);
    assert!(stderr(&output).contains("has no measurement"), "{}", stderr(&output));
    // The example of the documents.
    let found = json(&[
        "identify",
        &project("docs/quick-start/hall.toml"),
        "--hold-lengths-of-pose",
        "--measured",
        &project("docs/identification/hall-modes.csv"),
        "--fit",
        "platform.mass_kg",
    ]);
    let value = &found["values"][0];
    assert!((number(&value["value"]) - 64.0).abs() < 3.0 * number(&value["deviation"]), "{value}");
}

/// Response of the six-cable robot as a Universal File, of 21 frequencies with two numbers each.
fn written_response(folder: &std::path::Path) -> String {
    let path = folder.join("with blanks.uff");
    succeed(&[
        "frf",
        &robot("yuan2014-4mm.toml"),
        "--from-hz",
        "0.5",
        "--to-hz",
        "1.5",
        "--points",
        "21",
        "--input",
        "fz",
        "--output",
        "az",
        "-o",
        path.to_str().unwrap(),
    ]);
    fs::read_to_string(path).unwrap()
}

#[test]
fn damaged_files_are_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let good = written_response(folder.path());
    let refused = |bytes: &[u8], says: &str| {
        let path = folder.path().join("damaged file.uff");
        fs::write(&path, bytes).unwrap();
        let line = ["identify", &robot("yuan2014-4mm.toml"), "--fit", "platform.mass_kg", "--measured"];
        let output = run(&[&line[..], &[path.to_str().unwrap()]].concat());
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains(says) && told.trim_end().lines().count() == 1, "{says}: {told}");
    };

    let lines: Vec<&str> = good.lines().collect();
    let begin = lines.iter().position(|line| line.trim() == "58").unwrap();
    let form = lines[begin + 7];
    let with_form = |form: &str| good.replace(lines[begin + 7], form);
    // Cut off, too few points in the last line, too many, and steps of zero.
    refused(&good.as_bytes()[..good.len() - 200], "the file ends where");
    let counted = |points: usize| with_form(&format!("{}{points:10}{}", &form[..10], &form[20..]));
    refused(counted(20).as_bytes(), "dataset 58 goes on after its last point");
    refused(counted(22).as_bytes(), "dataset 58 ends after 42 of its 44 numbers");
    let step_of_zero = with_form(&format!("{}{:>13}{}", &form[..43], "0.00000E+00", &form[56..]));
    refused(step_of_zero.as_bytes(), "the frequencies must ascend, and 0.5 Hz follows 0.5 Hz");
    refused(&[], "is no Universal File");

    // Binary data in another byte order than the head says.
    let binary = |order: usize| {
        let values: Vec<u8> = (0..42).flat_map(|i| (0.01 * f64::from(i + 1)).to_le_bytes()).collect();
        let mut bytes = lines[..begin].join("\n").into_bytes();
        let head = format!("    58b{order:6}{:6}{:12}{:12}{:6}{:6}{:12}{:12}", 2, 11, values.len(), 0, 0, 0, 0);
        bytes.extend(format!("\n{head}\n{}\n", lines[begin + 1..begin + 12].join("\n")).bytes());
        bytes.extend(values);
        bytes.extend(b"\n    -1\n");
        bytes
    };
    refused(&binary(2), "(dataset 58b) the byte order of the file is wrong");
    refused(&binary(3), "byte order 3 (dataset 58b), it must be 1");
}

#[test]
fn measurements_that_cannot_be_are_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |text: &str, more: &[&str], says: &str| {
        let path = folder.path().join("table.csv");
        fs::write(&path, text).unwrap();
        let line = ["identify", &robot("yuan2014-4mm.toml"), "--fit", "platform.mass_kg", "--measured"];
        let output = run(&[&line[..], &[path.to_str().unwrap()], more].concat());
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains(says) && told.trim_end().lines().count() == 1, "{says}: {told}");
    };
    let response = ["--response", "a=az/fz"];
    for (text, says) in [
        ("", "is empty: give a header"),
        ("frequency,a_re,a_im\n1,2,3\n", "its columns are `frequency`, `a_re`, `a_im`"),
        ("frequency_hz;a_re;a_im\n1;0,2;x\n", "`x` is not a number"),
        ("frequency_hz,a_re,a_im\n1,2,3\n2,,3\n", "line 3: `a_re` is missing"),
        ("frequency_hz,a_re,a_im\n2,2,3\n1,2,3\n", "the frequencies must ascend, and 1 Hz follows 2 Hz"),
        ("frequency_hz,a_re,a_im\n-1,2,3\n1,2,3\n", "-1 is negative"),
    ] {
        refused(text, &response, says);
    }
    for (text, says) in [
        ("frequency_hz,label\n1.1,100000\n", "the number of a mode, which is at most 1000"),
        ("frequency_hz,damping_ratio\n1.1,2\n", "2 is not below 1"),
    ] {
        refused(text, &[], says);
    }
    let undamped = ["--set", "materials.rope-4mm.damping_ratio=0"];
    refused("frequency_hz,damping_ratio\n1.1,0.01\n", &undamped, "the mode has no damping in the model");
    let list = "frequency_hz,label\n1.1,1\n";
    refused(list, &["--measured-lengths-m", "6.8,6.5,6.7,6.6,6.8,6.6"], "needs a pose that is held");
    refused(
        list,
        &["--profile", "platform.mass"],
        "--profile platform.mass: no fitted value has this path; did you mean",
    );
}

#[test]
fn a_profile_is_in_text_table_and_page() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    fs::write(file("list.csv"), "frequency_hz,label\n1.08,1\n1.19,2\n1.22,3\n").unwrap();
    let yuan = robot("yuan2014-4mm.toml");
    let (list, page) = (file("list.csv"), file("page.html"));
    let line =
        ["identify", &yuan, "--fit", "platform.mass_kg", "--measured", &list, "--profile", "platform", "--page", &page];

    let found = json(&line);
    let row = &found["values"][0];
    let (from, to, value) = (number(&row["profile"]["from"]), number(&row["profile"]["to"]), number(&row["value"]));
    assert!(from < value && value < to, "{row}");
    assert!(row["profile"]["open_below"].is_null(), "{row}");
    let points = row["profile"]["points"].as_array().unwrap();
    assert!(points.iter().any(|point| number(&point["chi2_rise"]) == 0.0) && points.len() >= 9, "{row}");

    assert!(fs::read_to_string(&page).unwrap().contains("figure-profile-1"));
    let text = succeed(&line);
    assert!(text.contains("profile 95 % from"), "{text}");
    let table = succeed(&[&line[..], &["--format", "csv"]].concat());
    assert!(table.contains(&format!("{from},{to}")), "{table}");
}
