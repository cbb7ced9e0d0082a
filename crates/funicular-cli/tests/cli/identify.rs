//! `identify`, and Universal Files that `frf` and `modes` write.

use super::{json, number, project, robot, run, stderr, succeed};
use std::fs;

/// A response that the program writes as a Universal File and as a table is found again: the mass, and the same curve from
/// both files.
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
