//! Tests of `plot`: the page of a map or sweep.

use super::{command, robot, run, stderr, stdout, succeed};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use flate2::read::GzDecoder;
use serde_json::Value;
use std::fs;
use std::io::Read as _;
use std::path::Path;

/// Maximum size of a page [bytes].
const MAX_BYTES: usize = 5_000_000;

fn text(path: &Path) -> String {
    path.to_str().unwrap().to_owned()
}

/// Page of the rows that a command line writes, and the messages of `plot` on stderr.
fn page_of(line: &str) -> (String, String) {
    let folder = tempfile::tempdir().unwrap();
    let file = text(&folder.path().join("rows.parquet"));
    let cogiro = robot("cogiro.toml");
    let words = line.split_whitespace().map(|word| if word == "COGIRO" { cogiro.as_str() } else { word });
    succeed(&words.chain(["-o", &file]).collect::<Vec<_>>());
    let output = run(&["plot", &file, "-o", "-"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let page = stdout(&output).to_owned();
    assert!(page.len() < MAX_BYTES && page.trim_end().ends_with("</html>"), "{}", page.len());
    (page, stderr(&output).to_owned())
}

/// Data of the slices: header, status of every cell, values of every quantity.
fn slices(page: &str) -> (Value, Vec<u8>, Vec<Vec<f32>>) {
    let packed = page.split_once("id=\"slices-data\" data-packed>").unwrap().1.split_once('<').unwrap().0;
    let mut bytes = Vec::new();
    GzDecoder::new(BASE64.decode(packed).unwrap().as_slice()).read_to_end(&mut bytes).unwrap();
    let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
    let header: Value = serde_json::from_slice(&bytes[4..4 + length]).unwrap();
    let counts = header["axes"].as_array().unwrap().iter().map(|axis| axis["values"].as_array().unwrap().len());
    let cells = counts.product::<usize>();
    let (status, numbers) = bytes[4 + length..].split_at(cells);
    let numbers: Vec<f32> = numbers.chunks(4).map(|four| f32::from_le_bytes(four.try_into().unwrap())).collect();
    assert_eq!(numbers.len(), cells * header["quantities"].as_array().unwrap().len());
    (header, status.to_vec(), numbers.chunks(cells).map(<[f32]>::to_vec).collect())
}

/// Description of a figure in the page.
fn figure(page: &str, id: &str) -> Value {
    let begin = format!("<script type=\"application/json\" data-plot=\"{id}-plot\">");
    let json = page.split_once(&begin).unwrap_or_else(|| panic!("{id}")).1.split_once("</script>").unwrap().0;
    serde_json::from_str(json).unwrap()
}

#[test]
fn a_grid_becomes_slices_that_hold_its_rows() {
    let line = "COGIRO --grid x=-9:9:7 --grid y=-3:3:4 --grid z=1,2.5 --quantity tension-max,stiffness-min";
    let (page, notes) = page_of(&format!("map {line}"));
    assert_eq!(notes, "");
    let (line, cogiro) = (format!("map {line} --format csv"), robot("cogiro.toml"));
    let words = line.split_whitespace().map(|word| if word == "COGIRO" { cogiro.as_str() } else { word });
    let csv = succeed(&words.collect::<Vec<_>>());
    let (header, status, numbers) = slices(&page);
    assert_eq!(header["axes"][0]["title"], "x [m]");
    assert_eq!(header["axes"][2]["values"], serde_json::json!([1.0, 2.5]));
    assert_eq!(header["quantities"][0]["title"], "tension max [N]");
    assert_eq!(header["quantities"][1]["title"], "stiffness min [N/m]");
    assert_eq!(header["space"], serde_json::json!([0, 1, 2]));
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let names = reader.headers().unwrap().clone();
    let at = |name: &str| names.iter().position(|column| column == name).unwrap();
    let mut feasible = 0;
    for (i, row) in reader.records().enumerate() {
        let row = row.unwrap();
        for (q, name) in ["tension_max_n", "stiffness_min_n_per_m"].into_iter().enumerate() {
            match row[at(name)].parse::<f64>() {
                Ok(value) => assert_eq!(numbers[q][i].to_bits(), (value as f32).to_bits(), "{name} of row {i}"),
                Err(_) => assert!(numbers[q][i].is_nan(), "{name} of row {i}"),
            }
        }
        assert_eq!(status[i] == 0, &row[at("status")] == "ok", "row {i}");
        feasible += usize::from(&row[at("feasible")] == "true");
    }
    assert!(feasible > 10 && feasible < 50, "{feasible}");
    assert!(page.contains(&format!("<dt>feasible</dt><dd>{feasible} (")));
    // Every row counts in the histogram and in a status.
    let sum = |values: &Value| values.as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).sum::<u64>();
    assert_eq!(sum(&header["quantities"][0]["bins"]), feasible as u64);
    let of_status = header["statuses"].as_array().unwrap().iter().map(|one| one["rows"].as_u64().unwrap());
    assert_eq!(of_status.sum::<u64>(), 56);
    for expected in [
        "figure-slice-plot",
        "figure-set-plot",
        "figure-histogram-plot",
        "figure-space-plot",
        "<td class=\"left\">tension-limits</td>",
    ] {
        assert!(page.contains(expected), "{expected}");
    }
}

#[test]
fn values_that_do_not_ascend_are_drawn_in_their_order_on_the_axis() {
    let of = |x: &str| {
        let (page, _) = page_of(&format!("map COGIRO --grid x={x} --grid y=-3:3:4 --grid z=1 --quantity tension-max"));
        let (header, status, numbers) = slices(&page);
        let bits: Vec<u32> = numbers[0].iter().map(|number| number.to_bits()).collect();
        (header["axes"].clone(), status, bits)
    };
    assert_eq!(of("0,2,-1"), of("-1,0,2"));
}

#[test]
fn a_page_of_a_large_grid_is_thinned_with_a_note() {
    let (page, notes) = page_of("map COGIRO --grid x=-1:1:701 --grid y=-1:1:401 --grid z=1 --quantity condition");
    assert!(notes.contains("values of x (") && notes.contains("of 281101 rows)"), "{notes}");
    let (header, status, _) = slices(&page);
    assert!(status.len() > 50_000 && status.len() < 281_101, "{}", status.len());
    assert_eq!(header["quantities"][0]["count"], 281_101);
    assert!(page.contains("to limit the size of the page"));
    // Without all three axes of positions there is no view in space.
    assert!(header["space"].is_null() && !page.contains("figure-space-plot"));
}

#[test]
fn a_sweep_of_one_value_becomes_curves_whose_modes_are_followed() {
    let line =
        "sweep ROBOT --vary platform.mass_kg=10.55:86.35:60 --quantity frequencies:8,tension-max,tension-min,pose";
    let (page, notes) = page_of(line);
    assert_eq!(notes, "");
    let modes = figure(&page, "figure-modes");
    assert_eq!(modes["layout"]["xaxis"]["title"]["text"], "platform mass [kg]");
    let points = modes["data"].as_array().unwrap().last().unwrap();
    assert_eq!(points["x"].as_array().unwrap().len(), 60 * 8);
    assert!(points["marker"]["color"].as_array().unwrap().iter().any(|share| share.as_f64().unwrap() > 75.0));
    // One line per branch; some begin or end where another mode enters the lowest eight.
    let lines = modes["data"].as_array().unwrap().len() - 1;
    assert!((8..20).contains(&lines), "{lines}");
    let tensions = figure(&page, "figure-1");
    assert_eq!(tensions["data"].as_array().unwrap().len(), 2, "tensions share a figure");
    assert_eq!(tensions["layout"]["yaxis"]["title"]["text"], "tension [N]");
    assert!(page.contains("<td class=\"left\">frequency 8</td>"));
}

#[test]
fn a_trajectory_is_drawn_over_its_path_and_infeasible_rows_are_shaded() {
    let folder = tempfile::tempdir().unwrap();
    let poses = folder.path().join("poses.csv");
    let rows: Vec<String> = (0..31).map(|i| format!("{},0,0.5", 0.2 * f64::from(i) + 1.0)).collect();
    fs::write(&poses, format!("x_m,y_m,z_m\n{}\n", rows.join("\n"))).unwrap();
    let file = text(&folder.path().join("path.parquet"));
    succeed(&["map", "ROBOT", "--poses", &text(&poses), "--quantity", "tensions,first-kind", "-o", &file]);
    let output = command(&["plot", "path.parquet"]).current_dir(folder.path()).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("wrote path.html (") && stderr(&output).contains("no figure for first_kind"));
    let page = fs::read_to_string(folder.path().join("path.html")).unwrap();
    let figure = figure(&page, "figure-1");
    assert_eq!(figure["layout"]["xaxis"]["title"]["text"], "length of the path [m]");
    let x = figure["data"][0]["x"].as_array().unwrap();
    assert!((x[30].as_f64().unwrap() - 6.0).abs() < 1e-5);
    assert_eq!(figure["data"].as_array().unwrap().len(), 6);
    assert!(!figure["layout"]["shapes"].as_array().unwrap().is_empty());
}

#[test]
fn a_row_between_two_that_are_infeasible_is_a_point() {
    let folder = tempfile::tempdir().unwrap();
    let poses = folder.path().join("poses.csv");
    let rows: Vec<String> =
        (0..70).map(|i| format!("{},0,0.5", if i == 40 { 0.0 } else { 9.0 + f64::from(i) })).collect();
    fs::write(&poses, format!("x_m,y_m,z_m\n{}\n", rows.join("\n"))).unwrap();
    let file = text(&folder.path().join("path.parquet"));
    succeed(&["map", "ROBOT", "--poses", &text(&poses), "--quantity", "tension-max", "-o", &file]);
    let output = run(&["plot", &file, "-o", "-"]);
    let figure = figure(stdout(&output), "figure-1");
    let data = figure["data"].as_array().unwrap();
    assert_eq!((data.len(), &data[1]["mode"]), (2, &Value::from("markers")));
    assert_eq!(data[1]["y"].as_array().unwrap().len(), 1);
    assert!((data[1]["y"][0].as_f64().unwrap() - data[0]["y"][40].as_f64().unwrap()).abs() < 1e-9);
}

#[test]
fn other_models_and_options_are_followed_as_they_were_computed() {
    for rest in [
        "--pose 0.1,0,0.5 --cable-model shallow-dynamic",
        "--pose 0,0,0.5 --assembly without-geometric-stiffness --in-plane-only --force-n 1,0,2 --mass-kg 12",
    ] {
        let vary = "sweep ROBOT --vary materials.rope-4mm.diameter_m=0.003:0.005:5 --quantity frequencies:3";
        let (page, notes) = page_of(&format!("{vary} {rest}"));
        assert_eq!(notes, "", "{rest}");
        assert_eq!(
            figure(&page, "figure-modes")["data"].as_array().unwrap().last().unwrap()["x"].as_array().unwrap().len(),
            15
        );
    }
}

#[test]
fn two_values_become_slices_without_a_view_in_space() {
    let (page, _) =
        page_of("sweep ROBOT --vary platform.mass_kg=10.55:80:6 --vary materials.rope-4mm.diameter_m=0.003:0.005:4");
    let (header, status, _) = slices(&page);
    assert_eq!(status.len(), 24);
    assert_eq!(header["axes"][1]["title"], "materials rope-4mm diameter [m]");
    assert!(header["space"].is_null());
}

#[test]
fn a_part_is_drawn_with_a_note_of_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let file = text(&folder.path().join("part.parquet"));
    let grid = ["--grid", "x=-3:3:20", "--grid", "y=-2:2:10", "--grid", "z=1,2", "--quantity", "tension-max"];
    succeed(&[&["map", &robot("cogiro.toml")], &grid[..], &["--part", "2/3", "-o", &file]].concat());
    let output = run(&["plot", &file, "-o", "-"]);
    assert!(stderr(&output).contains("the file is part 2/3:"), "{}", stderr(&output));
    let (_, status, numbers) = slices(stdout(&output));
    let there = status.iter().filter(|code| **code != u8::MAX).count();
    assert!(there > 100 && there < 200, "{there} of 400");
    // The rows are in the middle of the grid, where they belong.
    assert!(status[0] == u8::MAX && status[399] == u8::MAX && numbers[0][200].is_finite());
    assert!(stdout(&output).contains("not in this file"));
}

#[test]
fn files_that_are_no_sweep_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| text(&folder.path().join(name));
    fs::write(path("text.parquet"), "x_m,y_m\n1,2\n").unwrap();
    let grid = ["map", "ROBOT", "--grid", "x=0:0.1:2"];
    succeed(&[&grid[..], &["--quantity", "first-kind", "-o", &path("words.parquet")]].concat());
    succeed(&[&grid[..], &["-o", &path("good.parquet")]].concat());
    for (file, to, expected) in [
        ("none.parquet", "a.html", "cannot read"),
        ("text.parquet", "a.html", "it is no Parquet file"),
        (".", "a.html", "it is a directory"),
        ("words.parquet", "a.html", "no numbers to plot, only first_kind"),
        ("good.parquet", "good.parquet", "refusing to write the page over the rows"),
        ("good.parquet", "no/such/a.html", "there is no directory"),
    ] {
        let output = run(&["plot", &path(file), "-o", &path(to)]);
        assert_eq!(output.status.code(), Some(2), "{file}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{file}: {}", stderr(&output));
        assert!(!folder.path().join("a.html").exists());
    }
}
