//! `calibrate`: the belts of a measured machine, its files, proposals, frames, and tables that are refused.

use super::{json, number, project, run, stderr, succeed};
use serde_json::Value;
use std::fs;

/// Words of a calibration of the machine, with further ones.
fn machine(more: &[&str]) -> Vec<String> {
    let (robot, belts) = (project("docs/calibration/machine.toml"), project("docs/calibration/belts.csv"));
    let words = ["calibrate", &robot, "--readings", &belts];
    words.into_iter().chain(more.iter().copied()).map(str::to_owned).collect()
}

fn found(more: &[&str]) -> Value {
    let words = machine(more);
    json(&words.iter().map(String::as_str).collect::<Vec<_>>())
}

/// Number of a value at a path.
fn value(found: &Value, path: &str, key: &str) -> f64 {
    let rows = found["values"].as_array().unwrap();
    number(&rows.iter().find(|row| row["path"] == path).unwrap()[key])
}

/// Runs on a table of its own, which is refused; the message.
fn refused(table: &str, more: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table.csv").display().to_string();
    fs::write(&path, table).unwrap();
    let robot = project("docs/calibration/machine.toml");
    let words = [&["calibrate", &robot, "--readings", &path][..], more].concat();
    let refused = run(&words);
    assert_eq!(refused.status.code(), Some(2), "{}", stderr(&refused));
    stderr(&refused).to_owned()
}

#[test]
fn the_belts_of_a_machine_fit_but_do_not_tell_its_anchors() {
    let found = found(&[]);
    // Fit of a separate program: 1 µm and its printed digits.
    assert!((value(&found, "cables.tr.anchor_m.y", "value") - 3.8549).abs() < 1e-6);
    assert!((value(&found, "cables.tr.anchor_m.y", "deviation") - 0.063_549_2).abs() < 1e-6);
    assert!((number(&found["residual_rms_m"]) - 0.279_623_1e-3).abs() < 1e-9);
    assert!((number(&found["weakest_m"]) - 0.113_501_8).abs() < 1e-6);
    assert!((number(&found["length_std_m"]) - 0.517_761_4e-3).abs() < 1e-9);
    // Student's t of 7 degrees of freedom: 2.3646 deviations to either side.
    let interval = &found["values"].as_array().unwrap()[5]["interval_95"];
    let width = number(&interval[1]) - number(&interval[0]);
    assert!((width / (2.0 * 2.3646 * 0.063_549_2) - 1.0).abs() < 1e-4, "{width}");
    assert_eq!(found["is_determined"], true);
    assert_eq!(found["frame"], "held as in the file: anchor bl, one coordinate of anchor br");
    let words = found["weak_combinations"][0]["words"].as_str().unwrap();
    assert!(words.contains("along x by 10.") && words.contains("along y by 15.7 mm/m"), "{words}");
    assert!(found["rows"].as_array().unwrap().iter().all(|row| row["outlier"] == false));

    let text = succeed(&machine(&[]).iter().map(String::as_str).collect::<Vec<_>>());
    assert!(text.contains("The readings fit to 0.280 mm r.m.s.") && text.contains("±7.96 to ±63.5 mm"), "{text}");
}

#[test]
fn the_proposal_says_what_the_next_positions_leave() {
    let grid = ["--grid", "x=0.4:4.2:9", "--grid", "y=0.4:3.5:8"];
    let proposed = found(&[&grid[..], &["--propose", "2"]].concat());
    let first = &proposed["proposals"][0];
    assert_eq!(first["position_m"], serde_json::json!([3.725, 3.5, 0.0]));
    // Values of another program.
    assert!((number(&first["total_m"]) - 10.789_284_73e-3).abs() < 1e-8);
    assert_eq!(first["readings_m"].as_array().unwrap().len(), 4);

    let wanted = found(&[&grid[..], &["--wanted-std-m", "0.002"]].concat());
    assert_eq!(wanted["poses_needed"], 2);
    assert!(number(&wanted["proposals"][1]["largest_m"]) < 0.002);
}

#[test]
fn frames_change_deviations_of_anchors_but_not_of_distances() {
    let [file, other, inner] = [found(&[]), found(&["--frame", "tr,tl"]), found(&["--frame", "inner"])];
    // The figure is turned by half a degree against that of the file's frame, which mixes x and y by 1 %.
    assert!((value(&other, "cables.bl.anchor_m.y", "inner_deviation") - 0.02946).abs() < 4e-4);
    // The inner frame turns the figure towards the file by about 2°.
    assert!((value(&inner, "cables.tr.anchor_m.y", "deviation") - 0.03152).abs() < 1e-3);
    for (k, distance) in file["distances"].as_array().unwrap().iter().enumerate() {
        for found in [&other, &inner] {
            let own = &found["distances"][k];
            // The search ends within 1e-6 deviations.
            for key in ["distance_m", "deviation_m"] {
                assert!((number(&own[key]) - number(&distance[key])).abs() < 1e-6, "{own} {distance}");
            }
        }
    }
}

#[test]
fn the_robot_file_has_the_anchors_and_calibrates_to_itself() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("calibrated.toml").display().to_string();
    let words = machine(&["--calibrated", &path]);
    succeed(&words.iter().map(String::as_str).collect::<Vec<_>>());
    let again = json(&["calibrate", &path, "--readings", &project("docs/calibration/belts.csv")]);
    for row in again["values"].as_array().unwrap() {
        // The search ends within 1e-6 deviations of up to 64 mm.
        assert!((number(&row["value"]) - number(&row["start"])).abs() < 1e-6, "{row}");
    }
}

#[test]
fn tables_that_cannot_be_meant_are_refused_with_their_remedy() {
    let header = "length_bl_m,length_br_m,length_tr_m,length_tl_m\n";
    let millimetres = refused(&format!("{header}2960.58,3150.08,3067.72,3049.85\n"), &[]);
    assert!(millimetres.contains("they look like millimetres: name the columns length_NAME_mm"), "{millimetres}");
    let steps = refused(&format!("{header}296058,315008,306772,304985\n"), &[]);
    assert!(steps.contains("steps of a motor have to be converted"), "{steps}");
    let few = refused(&format!("{header}2.96,3.15,3.07,3.05\n3.07,3.04,2.96,3.16\n"), &[]);
    assert!(
        few.contains("8 data cannot give 5 unknowns of the robot and 4 of the poses: measure at least 3 rows"),
        "{few}"
    );
    let unknown = refused("length_b1_m,length_br_m\n1,2\n", &[]);
    assert!(unknown.contains("there is a column `length_b1_m`; did you mean `length_bl_m`?"), "{unknown}");
    let line = refused(&format!("{header}2.96,3.15,3.07,3.05\n3.07,x,2.96,3.16\n"), &[]);
    assert!(line.contains("line 3, column `length_br_m`"), "{line}");
    let belts = fs::read_to_string(project("docs/calibration/belts.csv")).unwrap();
    let size = refused(&belts, &["--unknowns", "anchors,scale"]);
    assert!(size.contains("say nothing about the size of the robot"), "{size}");
    let name = refused(&belts, &["--unknowns", "anchor"]);
    assert!(name.contains("did you mean `anchors`?"), "{name}");
    let cable = refused(&belts, &["--frame", "bl,xx"]);
    assert!(cable.contains("there is no cable `xx`"), "{cable}");
    let candidates = refused(&belts, &["--propose", "1"]);
    assert!(candidates.contains("a proposal needs candidates"), "{candidates}");
}

#[test]
fn offsets_of_the_machine_are_not_determined_although_its_residuals_are_smaller() {
    let [without, with] = [found(&[]), found(&["--unknowns", "anchors,offsets"])];
    assert!(number(&with["residual_rms_m"]) < number(&without["residual_rms_m"]));
    // The separate program: 46 to 205 m for the anchors, which are no numbers any more.
    assert_eq!(with["is_determined"], false);
    assert!(with["values"].as_array().unwrap().iter().all(|row| row["interval_95"].is_null()));
}

#[test]
fn cells_of_cables_that_were_not_read_are_empty() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table.csv").display().to_string();
    let belts = fs::read_to_string(project("docs/calibration/belts.csv")).unwrap();
    let gap = belts.replace("2859.27,3272.34", "2859.27,");
    assert_ne!(gap, belts);
    fs::write(&path, gap).unwrap();
    let found = json(&["calibrate", &project("docs/calibration/machine.toml"), "--readings", &path]);
    assert_eq!((&found["data"], &found["degrees_of_freedom"]), (&23.into(), &6.into()));
    let residuals = found["rows"][5]["residuals"].as_array().unwrap();
    assert_eq!(residuals.iter().map(|of| of["cable"].as_str().unwrap()).collect::<Vec<_>>(), ["bl", "tr", "tl"]);
    // Without one reading the values stay within their deviations.
    assert!((value(&found, "cables.tr.anchor_m.y", "value") - 3.8549).abs() < 0.0635);

    let no_length = refused("length_bl_m,length_br_m,length_tr_m,length_tl_m\n2.9,3.1,-3.0,3.0\n", &[]);
    assert!(no_length.contains("the reading -3.000 m of cable tr is no length"), "{no_length}");
}

#[test]
fn readings_that_do_not_fit_say_so_before_any_value_and_name_the_row() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table.csv").display().to_string();
    let belts = fs::read_to_string(project("docs/calibration/belts.csv")).unwrap();
    // One belt of the third position is 5 % off.
    let wrong = belts.replace("3134.33", "3291.05");
    assert_ne!(wrong, belts);
    fs::write(&path, wrong).unwrap();
    let robot = project("docs/calibration/machine.toml");
    let found = json(&["calibrate", &robot, "--readings", &path, "--length-std-m", "0.0005"]);
    assert_eq!(found["is_determined"], false);
    assert!(found["fit"].as_str().unwrap().starts_with("The readings do not fit (χ² "));
    assert_eq!(found["determined"], "No value is known as long as the readings do not fit: see the warnings");
    assert!(found["values"].as_array().unwrap().iter().all(|row| row["interval_95"].is_null()));

    // Without that row the others fit, and keep their numbers.
    let words = ["calibrate", &robot, "--readings", &path, "--length-std-m", "0.0005", "--leave-out"];
    let found = json(&[&words[..], &["3"]].concat());
    assert_eq!(found["is_determined"], true);
    let numbers: Vec<_> = found["rows"].as_array().unwrap().iter().map(|row| row["row"].as_u64().unwrap()).collect();
    assert_eq!(numbers, [1, 2, 4, 5, 6]);
    let other = run(&[&words[..], &["7"]].concat());
    assert_eq!(other.status.code(), Some(2));
    assert!(
        stderr(&other).contains("--leave-out 7: there is no such row: give numbers from 1 to 6"),
        "{}",
        stderr(&other)
    );
}

#[test]
fn the_page_and_the_figure_draw_anchors_ellipses_and_proposals() {
    let folder = tempfile::tempdir().unwrap();
    let of = |name: &str| folder.path().join(name).display().to_string();
    let grid = ["--propose", "2", "--grid", "x=0.4:4.2:9", "--grid", "y=0.4:3.5:8"];
    let [html, svg, pdf] = ["page.html", "figure.svg", "figure.pdf"].map(of);
    for file in [&html, &svg, &pdf] {
        let words = machine(&[&grid[..], &["-o", file]].concat());
        succeed(&words.iter().map(String::as_str).collect::<Vec<_>>());
    }
    let page = fs::read_to_string(&html).unwrap();
    for part in ["figure-anchors-1", "to measure next", "weakest combination", "id=\"refit-data\"", "belts.csv"] {
        assert!(page.contains(part), "{part}");
    }
    // One net row of each of six rows, and five free values.
    let linear = page.split("id=\"refit-data\">").nth(1).unwrap().split("</script>").next().unwrap();
    let linear: Value = serde_json::from_str(linear).unwrap();
    assert_eq!(linear["linear"]["rows"].as_array().unwrap().len(), 6);
    assert_eq!(linear["linear"]["information"].as_array().unwrap().len(), 5);

    let figure = fs::read_to_string(&svg).unwrap();
    assert!(figure.starts_with("<?xml") || figure.starts_with("<svg"), "{}", &figure[..60]);
    assert!(figure.contains("weakest combination") && figure.contains("to measure next"));
    assert!(fs::read(&pdf).unwrap().starts_with(b"%PDF"));
}

#[test]
fn profiles_and_priors_of_the_machine_are_printed() {
    let profiled = found(&["--profile", "cables.tl.anchor_m.y"]);
    let row = profiled["values"].as_array().unwrap().iter().find(|row| row["path"] == "cables.tl.anchor_m.y").unwrap();
    // The separate program: parabolic within 2.5 % at 4 deviations.
    for (end, profile) in [(0, "from"), (1, "to")] {
        let half = number(&row["interval_95"][1]) - number(&row["value"]);
        assert!((number(&row["profile"][profile]) - number(&row["interval_95"][end])).abs() < 0.025 * half, "{row}");
    }
    let text = succeed(
        &machine(&["--prior", "cables.tl.anchor_m.y=3.9±0.01", "--profile", "cables.tl.anchor_m.y"])
            .iter()
            .map(String::as_str)
            .collect::<Vec<_>>(),
    );
    assert!(text.contains("prior 3.900 ± 0.010") && text.contains("profile 95 % from"), "{text}");
}

#[test]
fn inches_and_lines_of_a_firmware_are_the_readings_in_millimetres() {
    let belts = fs::read_to_string(project("docs/calibration/belts.csv")).unwrap();
    let lines: Vec<&str> = belts.lines().filter(|line| !line.starts_with('#')).collect();
    let header: Vec<&str> = lines[0].split(',').collect();
    assert!(header.iter().all(|name| name.ends_with("_mm")), "{header:?}");
    let rows: Vec<Vec<f64>> =
        lines[1..].iter().map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();

    let each = |of: &dyn Fn(&str, f64) -> String| -> Vec<String> {
        let row = |row: &Vec<f64>| header.iter().zip(row).map(|(name, value)| of(name, *value)).collect::<Vec<_>>();
        rows.iter().map(|cells| row(cells).join(",")).collect()
    };
    let belt = |name: &str| name.trim_start_matches("length_").trim_end_matches("_mm").to_owned();
    let inches = format!(
        "{}\n{}\n",
        lines[0].replace("_mm", "_in"),
        each(&|_, value| format!("{:.12}", value / 25.4)).join("\n")
    );
    let firmware = format!(
        "[MSG:INFO: start]\nCLBM:[{}]\n",
        each(&|name, value| format!("{}:{value:.2}", belt(name)))
            .iter()
            .fold(String::new(), |all, row| all + "{" + row + "},")
    );

    let plain = found(&[]);
    let folder = tempfile::tempdir().unwrap();
    let robot = project("docs/calibration/machine.toml");
    for (name, text) in [("belts-in.csv", &inches), ("log.txt", &firmware)] {
        let path = folder.path().join(name).display().to_string();
        fs::write(&path, text).unwrap();
        let same = json(&["calibrate", &robot, "--readings", &path]);
        for (a, b) in plain["values"].as_array().unwrap().iter().zip(same["values"].as_array().unwrap()) {
            assert!((number(&a["value"]) - number(&b["value"])).abs() < 1e-9, "{name}: {a} {b}");
        }
    }
}
