//! `clearance`: distances at a pose and on a move, obstacles from STL files, status and warning.

use super::{csv, json, json_of, number, robot, run, stderr, succeed};
use std::fs;
use std::path::Path;

/// Binary STL file of a box about its origin; `faces` of its twelve triangles.
fn stl(half: [f32; 3], faces: usize) -> Vec<u8> {
    let corner =
        |bits: usize| -> [f32; 3] { std::array::from_fn(|k| if bits & (1 << k) == 0 { -half[k] } else { half[k] }) };
    let quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).take(faces);
    let mut bytes = vec![b' '; 80];
    bytes.extend(u32::try_from(faces).unwrap().to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        bytes.extend(triangle.map(corner).iter().flatten().flat_map(|number| number.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

/// Robot file with more tables in a folder; its path.
fn with_tables(folder: &Path, tables: &str) -> String {
    let path = folder.join("my hall.toml");
    fs::write(&path, format!("{}\n{tables}", fs::read_to_string(robot("cogiro.toml")).unwrap())).unwrap();
    path.display().to_string()
}

const COLUMN: &str = "[clearance]\nobstacles_m = 0.1\n[obstacles.column]\nshape = \"mesh\"\nfile = \"column.stl\"\n\
                      position_m = [3.0, 1.0, 1.5]\n";

/// Ends of an axis.
const ENDS: &str = "from_m = [1.0, 2.0, 0.5]\nto_m = [3.0, 1.0, 2.0]\n";

/// A guy wire or a beam between two points is the cylinder or the box that is turned there by its angles, in every
/// command; `check` lists what the drawing shows.
#[test]
fn a_body_between_two_points_is_the_one_that_is_turned_there() {
    let folder = tempfile::tempdir().unwrap();
    let distances = |tables: &str| -> Vec<f64> {
        let file = with_tables(folder.path(), &format!("[obstacles.it]\n{tables}"));
        let found = json(&["clearance", &file, "--pose", "1,0.5,1.5"]);
        let pairs = found["pairs"].as_array().unwrap().iter().filter(|pair| pair["second"] == "it");
        pairs.map(|pair| number(&pair["distance_m"])).collect()
    };
    // Angles of the axis by hand: yaw of its level part, pitch from z.
    let (across, length) = (2.0_f64.hypot(1.0), (4.0_f64 + 1.0 + 2.25).sqrt());
    let (pitch, yaw) = (across.atan2(1.5).to_degrees(), (-1.0_f64).atan2(2.0).to_degrees());
    let place = format!("position_m = [2.0, 1.5, 1.25]\nroll_pitch_yaw_deg = [0.0, {pitch}, {yaw}]\n");
    let near = |one: &str, other: &str| {
        let (one, other) = (distances(one), distances(other));
        assert!(one.len() > 1 && one.len() == other.len());
        assert!(one.iter().zip(&other).all(|(a, b)| (a - b).abs() < 1e-9), "{one:?} {other:?}");
    };
    let wire = "shape = \"cylinder\"\ndiameter_m = 0.1\n";
    near(&format!("{wire}{ENDS}"), &format!("{wire}{place}length_m = {length}\n"));
    // The width of a beam is level: it is the y axis of these angles.
    near(&format!("width_m = 0.6\nheight_m = 0.1\n{ENDS}"), &format!("size_m = [0.1, 0.6, {length}]\n{place}"));
    // An upright post has its width along x.
    let post = "from_m = [2, 1, 0]\nto_m = [2, 1, 3]\n";
    near(&format!("width_m = 0.8\nheight_m = 0.2\n{post}"), "size_m = [0.8, 0.2, 3]\nposition_m = [2, 1, 1.5]\n");

    let tables = format!(
        "[clearance]\nobstacles_m = 0.1\n[required]\nforce_n = [10, 20, 30]\npayload_max_kg = 50\n\
         [[required_loads]]\nforce_n = [0, 0, -300]\n[obstacles.floor]\nshape = \"half-space\"\n\
         [obstacles.\"guy wire\"]\n{wire}{ENDS}[platform_bodies.rail]\nwidth_m = 0.1\nheight_m = 0.2\n\
         from_m = [-0.4, 0, 0]\nto_m = [0.4, 0, 0]\n"
    );
    let file = with_tables(folder.path(), &tables);
    let text = succeed(&["check", &file]);
    for line in [
        "required    force ±(10.0000, 20.0000, 30.0000) N; payload 0 to 50 kg; shape: box",
        "or force (0.0000, 0.0000, -300.0000) N",
        "clearance   0 m between cables, 0 m to the platform, 0.1 m to obstacles",
        "from (1.0000, 2.0000, 0.5000) to (3.0000, 1.0000, 2.0000) m",
        "behind the plane through (0.0000, 0.0000, 0.0000) m with the normal (0.0000, 0.0000, 1.0000)",
        "0.1 × 0.2 × 0.8 m",
    ] {
        assert!(text.contains(line), "{line}\n{text}");
    }
    let checked = json(&["check", &file]);
    assert_eq!(checked["obstacles"][1]["name"], "guy wire");
    assert!((number(&checked["obstacles"][1]["length_m"]) - length).abs() < 1e-12);
    assert_eq!(checked["obstacles"][0]["outward"][2].as_f64(), Some(1.0));
    assert_eq!(checked["platform_bodies"][0]["shape"], "box");
    assert_eq!(checked["required"]["payload_max_kg"].as_f64(), Some(50.0));
    assert_eq!(checked["required_loads"][0]["force_n"][2].as_f64(), Some(-300.0));
    assert_eq!(checked["clearance"]["obstacles_m"].as_f64(), Some(0.1));

    // An end is a number of the file, and the place that it stands for is none.
    let moved = json(&["check", &file, "--set", "obstacles.\"guy wire\".to_m.2=4"]);
    assert_eq!(moved["obstacles"][1]["to_m"][2].as_f64(), Some(4.0));
    let refused = run(&["check", &file, "--set", "obstacles.\"guy wire\".position_m.2=4"]);
    assert_eq!(refused.status.code(), Some(2), "{}", stderr(&refused));
}

#[test]
fn a_column_from_a_file_is_the_box_that_it_shows_in_every_command() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("column.stl"), stl([200.0, 200.0, 1500.0], 12)).unwrap();
    let meshed = with_tables(folder.path(), &format!("{COLUMN}file_unit = \"mm\"\n"));
    let of_mesh = json(&["clearance", &meshed, "--pose", "1,0.5,1.5"]);
    assert_eq!(of_mesh["free"].as_bool(), Some(true));

    let other = tempfile::tempdir().unwrap();
    let boxed = COLUMN.replace("\"mesh\"\nfile = \"column.stl\"", "\"box\"\nsize_m = [0.4, 0.4, 3.0]");
    let of_box = json(&["clearance", &with_tables(other.path(), &boxed), "--pose", "1,0.5,1.5"]);
    let distances = |found: &serde_json::Value| -> Vec<f64> {
        found["pairs"].as_array().unwrap().iter().map(|pair| number(&pair["distance_m"])).collect()
    };
    for (one, two) in distances(&of_mesh).iter().zip(distances(&of_box)) {
        // The numbers of the file have 24 bits.
        assert!((one - two).abs() < 1e-6, "{one} {two}");
    }

    // Beside the column: a warning, and an infeasible row that has its numbers.
    let warned = run(&["statics", &meshed, "--pose", "2.2,0.8,1.5"]);
    assert!(
        warned.status.success() && stderr(&warned).contains("the obstacle \"column\" touch"),
        "{}",
        stderr(&warned)
    );
    let grid = ["--grid", "x=1,2.2", "--grid", "y=0.8", "--grid", "z=1.5", "--quantity", "clearance,tension-max"];
    let (header, rows) = csv(&[&["map", &meshed], &grid[..]].concat());
    let value = |row: usize, name: &str| rows[row][header.iter().position(|column| column == name).unwrap()].clone();
    assert_eq!((value(0, "status").as_str(), value(0, "feasible").as_str()), ("ok", "true"));
    assert_eq!((value(1, "status").as_str(), value(1, "feasible").as_str()), ("interference", "false"));
    assert!(value(1, "clearance_margin_m").parse::<f64>().unwrap() < -0.1 && !value(1, "tension_max_n").is_empty());

    // The report carries the mesh with it.
    let page = folder.path().join("page.html").display().to_string();
    succeed(&["report", &meshed, "--pose", "1,0.5,1.5", "-o", &page]);
    assert!(fs::read_to_string(page).unwrap().contains("Grey bodies: obstacles"));
}

#[test]
fn a_move_through_the_column_is_seen_and_one_beside_it_is_free() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("column.stl"), stl([0.2, 0.2, 1.5], 12)).unwrap();
    let hall = with_tables(folder.path(), COLUMN);
    let found = json(&["clearance", &hall, "--pose", "1,0.5,1.5", "--move-to", "4.5,1,1.5"]);
    let worst = &found["pairs"][0];
    assert_eq!(found["free"].as_bool(), Some(false));
    assert!(number(&worst["fraction"]) > 0.1 && worst["second"] == "column", "{worst}");
    let free = json(&["clearance", &hall, "--pose", "1,0.5,1.5", "--move-to", "0,-1,1.8,0,0,10"]);
    assert_eq!(free["free"].as_bool(), Some(true));

    let ways: [(&[&str], i32, &str); 3] = [
        (&["--move-to", "30,0,1"], 1, "% of the move"),
        (&["--move-to", "1,0,1", "--hold-lengths-of-pose"], 2, "from pose to pose"),
        (&["--move-to", "1,nan,1"], 2, "move-to"),
    ];
    for (more, code, words) in ways {
        let output = run(&[&["clearance", &hall, "--pose", "1,0.5,1.5"], more].concat());
        assert!(output.status.code() == Some(code) && stderr(&output).contains(words), "{more:?}: {}", stderr(&output));
    }
}

#[test]
fn meshes_and_obstacles_that_make_no_sense_are_refused_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let files =
        [("open.stl", stl([0.2, 0.2, 1.5], 11)), ("empty.stl", stl([1.0; 3], 0)), ("mm.stl", stl([2000.0; 3], 12))];
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    fs::write(folder.path().join("text.stl"), "no mesh").unwrap();
    let mesh = |file: &str| COLUMN.replace("column.stl", file);
    let cases = [
        (mesh("open.stl"), "is open: 3 of its edges"),
        (mesh("empty.stl"), "has no triangles"),
        (mesh("text.stl"), "is no STL file"),
        (mesh("mm.stl"), "add `file_unit = \"mm\"`"),
        (mesh("none.stl"), "cannot be read"),
        ("[obstacles.room]\nsize_m = [40, 40, 40]\n".to_owned(), "is around the anchor of cable"),
        ("[obstacles.ball]\nshape = \"ball\"\n".to_owned(), "the words are"),
        ("[obstacles.box]\nsize_m = [1, 0, 1]\n".to_owned(), "must be positive"),
        ("[obstacles.box]\nsize_m = [1, 1, 1]\ndiameter_m = 2\n".to_owned(), "does not go with"),
        ("[obstacles.box]\n".to_owned(), "has no `size_m`"),
        (
            format!("[obstacles.wire]\nshape = \"cylinder\"\ndiameter_m = 0.1\n{ENDS}position_m = [1, 1, 1]\n"),
            "place the body",
        ),
        (
            format!("[obstacles.wire]\nshape = \"cylinder\"\ndiameter_m = 0.1\n{ENDS}length_m = 3\n"),
            "`length_m` does not go",
        ),
        (format!("[obstacles.beam]\nwidth_m = 1\nheight_m = 1\n{ENDS}size_m = [1, 1, 1]\n"), "`size_m` does not go"),
        (format!("[obstacles.beam]\nwidth_m = 1\n{ENDS}"), "has no `height_m`"),
        ("[obstacles.beam]\nwidth_m = 1\nheight_m = 1\nfrom_m = [1, 2, 3]\n".to_owned(), "has no `to_m`"),
        ("[obstacles.beam]\nwidth_m = 1\nheight_m = 1\nsize_m = [1, 1, 1]\n".to_owned(), "needs `from_m` and `to_m`"),
        (format!("[obstacles.floor]\nshape = \"half-space\"\n{ENDS}"), "does not go with `shape"),
        (
            "[obstacles.wire]\nshape = \"cylinder\"\ndiameter_m = 0.1\nfrom_m = [1, 2, 3]\nto_m = [1, 2, 3]\n"
                .to_owned(),
            "are the same point",
        ),
        ("[platform_bodies.wall]\nshape = \"half-space\"\n".to_owned(), "cannot carry a half space"),
        ("[clearance]\ncables_m = -1\n".to_owned(), "must not be negative"),
        ("[clearance]\ncable_m = 1\n".to_owned(), "did you mean `cables_m`"),
    ];
    for (tables, words) in cases {
        let output = run(&["clearance", &with_tables(folder.path(), &tables), "--pose", "1,0.5,1.5"]);
        let message = stderr(&output);
        assert!(output.status.code() == Some(2) && message.contains(words), "{tables}: {message}");
    }
}

#[test]
fn a_mesh_in_millimetres_is_reported_at_its_line_in_the_table_of_its_kind() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("mm.stl"), stl([2000.0; 3], 12)).unwrap();
    // The other kind has a body of the same name, which is not meant.
    for (kind, other) in [("platform_bodies", "obstacles"), ("obstacles", "platform_bodies")] {
        let tables = format!(
            "[{other}.part]\nsize_m = [0.1, 0.1, 0.1]\nposition_m = [1, 0, 0.4]\n[{kind}.part]\nshape = \"mesh\"\n\
             file = \"mm.stl\"\n"
        );
        let robot = with_tables(folder.path(), &tables);
        let line = 1 + fs::read_to_string(&robot).unwrap().lines().position(|l| l == format!("[{kind}.part]")).unwrap();
        let output = run(&["clearance", &robot, "--pose", "1,0.5,1.5"]);
        let message = stderr(&output);
        assert!(output.status.code() == Some(2) && message.contains(&format!(":{line}:")), "{line}: {message}");
    }
}

/// Distance of a point from a segment, in plan.
fn in_plan(point: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let (along, beside) = ([to[0] - from[0], to[1] - from[1]], [point[0] - from[0], point[1] - from[1]]);
    let part = ((along[0] * beside[0] + along[1] * beside[1]) / (along[0].powi(2) + along[1].powi(2))).clamp(0.0, 1.0);
    (beside[0] - part * along[0]).hypot(beside[1] - part * along[1])
}

/// Columns from floor to roof: a cable hangs in a vertical plane, so that its distance is that of two figures in plan.
#[test]
fn distances_from_the_columns_of_a_hall_are_those_of_its_plan() {
    let file = fs::read_to_string(super::project("docs/quick-start/hall.toml")).unwrap();
    let columns = [("east", [6.0, 0.0]), ("west", [-6.0, 0.5])];
    let table = |(name, [x, y]): &(&str, [f64; 2])| {
        format!(
            "[obstacles.{name}]\nshape = \"cylinder\"\nposition_m = [{x}, {y}, 4.0]\ndiameter_m = 0.5\nlength_m = 9.0\n"
        )
    };
    let tables = columns.iter().map(table).collect::<Vec<_>>().concat();
    // Two cables at each corner of the hall, and of the platform.
    let corners = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    // Each goes to a corner of the platform beside the nearest one.
    let ends = |i: usize| [corners[i / 2], corners[(i / 2 + if i.is_multiple_of(2) { 1 } else { 3 }) % 4]];
    let cables: Vec<(String, [[f64; 2]; 2])> = (0..8).map(|i| ((i + 1).to_string(), ends(i))).collect();
    let rope = 0.5 * (4.0 * 14e-6 / std::f64::consts::PI).sqrt();

    for [x, y] in [[1.0, 0.5], [2.0, -1.5], [-3.0, 1.0]] {
        let found = json_of(&["clearance", "-", "--pose", &format!("{x},{y},3")], &format!("{file}{tables}"));
        let pairs = found["pairs"].as_array().unwrap();
        let each = cables.iter().flat_map(|cable| columns.iter().map(move |of| (cable, of)));
        for ((cable, [anchor, attachment]), (name, column)) in each {
            let to = [x + 0.5 * attachment[0], y + 0.4 * attachment[1]];
            let expected = in_plan(*column, [10.0 * anchor[0], 6.0 * anchor[1]], to) - 0.25 - rope;
            let is_pair = |pair: &&serde_json::Value| pair["first"] == **cable && pair["second"] == *name;
            let pair = pairs.iter().find(is_pair).unwrap();
            assert!((number(&pair["distance_m"]) - expected).abs() < 1e-8, "{pair} {expected}");
        }
    }
}

/// Robot file with gusts of these intensities; its path.
fn windy(folder: &Path, intensity: &str) -> String {
    let rope = "drag_coefficient = 1.2\ndrag_diameter_m = 0.005\nmaximum_tension_n";
    let text = fs::read_to_string(robot("stadium-camera.toml")).unwrap().replacen("maximum_tension_n", rope, 1);
    let wind = format!(
        "[wind]\nvelocity_m_s = [12.0, 0.0, 0.0]\nturbulence = \"kaimal\"\nintensity = {intensity}\n\
         length_scale_m = [85.05, 28.35, 6.93]\n"
    );
    let path = folder.join("windy.toml");
    fs::write(&path, format!("{text}\n{wind}")).unwrap();
    path.display().to_string()
}

/// Motions in gusts enlarge the required distances: as the intensity of the gusts, and by at least the motion of the
/// platform, to which every cable is attached.
#[test]
fn gusts_enlarge_the_required_distances() {
    let folder = tempfile::tempdir().unwrap();
    let vibration = |intensity: &str| {
        let found = json(&["clearance", &windy(folder.path(), intensity), "--in-gusts"]);
        let pair = &found["pairs"][0];
        let [added, required, margin, distance] =
            ["vibration_m", "required_m", "margin_m", "distance_m"].map(|key| number(&pair[key]));
        assert!((required - added).abs() < 1e-12 && (margin - (distance - required)).abs() < 1e-12);
        added
    };
    let [weak, strong] = ["[0.075, 0.06, 0.0375]", "[0.15, 0.12, 0.075]"].map(vibration);
    assert!((strong / weak - 2.0).abs() < 1e-6, "{weak} {strong}");

    let path = windy(folder.path(), "[0.15, 0.12, 0.075]");
    let outputs = ["x", "y", "z"].map(|axis| ["--output", axis]).concat();
    let gust = json(&[&["gust", &path], &outputs[..]].concat());
    let peaks = gust["outputs"].as_array().unwrap().iter().map(|output| number(&output["peak"]).powi(2));
    assert!(strong >= 2.0 * peaks.sum::<f64>().sqrt() - 1e-9, "{strong}");

    let calm = run(&["clearance", &robot("cogiro.toml"), "--in-gusts"]);
    assert_eq!(calm.status.code(), Some(2));
    assert!(stderr(&calm).contains("turbulence"), "{}", stderr(&calm));
}

/// Where a column stands on the straight move, a way around it is printed.
#[test]
fn a_way_around_a_column_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let column = "[obstacles.post]\nshape = \"box\"\nsize_m = [0.3, 0.3, 1.6]\nposition_m = [0.0, 0.0, 0.8]\n";
    let hall = with_tables(folder.path(), column);
    let ends = ["--pose", "-2.5,0,1.2", "--move-to", "2.5,0,1.2"];
    let found = json(&[&["clearance", &hall, "--find-way"], &ends[..]].concat());
    assert_eq!(found["free"].as_bool(), Some(false));
    let through = found["way"]["through"].as_array().unwrap();
    assert!((1..=2).contains(&through.len()), "{through:?}");

    // No way leads into the distance of the column: told at once.
    let begun = std::time::Instant::now();
    let blocked = ["--pose", "-2.5,0,1.2", "--move-to", "-0.66,0,0.8", "--set", "clearance.obstacles_m=0.5"];
    let blocked = run(&[&["clearance", &hall, "--find-way"], &blocked[..]].concat());
    let text = stderr(&blocked);
    assert!(blocked.status.code() == Some(1) && text.contains("end of the move") && text.contains("post"), "{text}");
    assert!(begun.elapsed().as_secs() < 20);

    let alone = run(&["clearance", &hall, "--find-way"]);
    assert!(alone.status.code() == Some(2) && stderr(&alone).contains("--move-to"), "{}", stderr(&alone));
}

/// The examples that readers copy have no crossing cables; with high anchors at lower corners beside them they had
/// four.
#[test]
fn crossing_cables_are_warned_of_and_the_examples_have_none() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let made = at("made.toml");
    let points = super::project("docs/robot-file.csv");
    succeed(&["new", "--from-csv", &points, "--csv-unit", "mm", "--mass-kg", "60", "-o", &made]);
    let hall = super::project("docs/quick-start/hall.toml");
    for file in [hall.clone(), super::project("docs/tutorials/stage.toml"), made] {
        let found = json(&["clearance", &file]);
        assert_eq!(found["free"].as_bool(), Some(true), "{file}: {}", found["pairs"][0]);
        for command in ["check", "statics"] {
            let output = run(&[command, &file]);
            assert!(!stderr(&output).contains("cross"), "{file}: {}", stderr(&output));
        }
    }

    // Both cables of a corner in one vertical plane, the upper one below at the platform.
    let text = fs::read_to_string(hall).unwrap();
    let swapped = text.replacen("[-0.5, 0.4, 0.25]", "[0.5, 0.4, -0.25]", 1).replacen(
        "[0.5, -0.4, -0.25]",
        "[0.5, 0.4, 0.25]",
        1,
    );
    let crossed = at("crossed.toml");
    fs::write(&crossed, &swapped).unwrap();
    let page = at("page.html");
    let commands: [&[&str]; 3] = [&["check"], &["statics"], &["report", "-o", &page]];
    for command in commands {
        let output = run(&[&[command[0], &crossed], &command[1..]].concat());
        assert!(stderr(&output).contains("cables \"1\" and \"2\" cross"), "{command:?}: {}", stderr(&output));
    }
    // A pose that no tensions hold is judged by straight cables.
    let far = at("far.toml");
    fs::write(&far, swapped.replace("[1.0, 0.5, 3.0]", "[1.0, 0.5, 30.0]")).unwrap();
    let output = run(&["check", &far]);
    assert!(output.status.success() && !stderr(&output).contains("panicked"), "{}", stderr(&output));
}

/// A text of two solids, the second of which a cable meets.
fn two_solids() -> String {
    let solid = |middle: [f64; 3], half: f64| {
        let corner = |bits: usize| -> String {
            let number = |k: usize| middle[k] + if bits & (1 << k) == 0 { -half } else { half };
            format!("vertex {} {} {}\n", number(0), number(1), number(2))
        };
        let quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
        let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
        let facet = |corners: [usize; 3]| {
            let corners = corners.map(corner).concat();
            format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
        };
        format!("solid part\n{}endsolid part\n", triangles.map(facet).collect::<String>())
    };
    solid([30.0, 0.0, 1.0], 0.5) + &solid([3.0, 1.0, 1.5], 0.2)
}

#[test]
fn every_solid_of_a_text_counts_and_a_text_that_breaks_off_is_refused_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let text = two_solids();
    let mesh = "[obstacles.parts]\nshape = \"mesh\"\nfile = \"parts.stl\"\n";
    fs::write(folder.path().join("parts.stl"), &text).unwrap();
    let hall = with_tables(folder.path(), mesh);
    let found = json(&["clearance", &hall, "--pose", "2.2,0.8,1.5"]);
    assert_eq!(found["free"].as_bool(), Some(false));
    assert!(number(&found["pairs"][0]["distance_m"]) < -0.05, "{}", found["pairs"][0]);

    // The second box, cut off in its third facet, which begins at line 102.
    let cut = text.match_indices("facet normal").nth(14).unwrap().0;
    fs::write(folder.path().join("parts.stl"), &text[..cut + 40]).unwrap();
    let output = run(&["clearance", &hall, "--pose", "2.2,0.8,1.5"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("is no STL file: line 104: the text ends"), "{}", stderr(&output));
}

/// Rope without diameter through a box, no distances required: interference in every command that judges it.
#[test]
fn a_rope_through_a_box_is_interference_in_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(super::project("docs/quick-start/hall.toml")).unwrap();
    let mut lines: Vec<&str> = text.lines().collect();
    lines.retain(|line| !line.starts_with("youngs_modulus_pa") && !line.starts_with("area_m2"));
    let text = lines.join("\n").replace("[materials.rope]\n", "[materials.rope]\naxial_stiffness_n = 1.4e6\n");
    let hall = folder.path().join("hall.toml").display().to_string();
    let mast = "[obstacles.mast]\nsize_m = [0.8, 0.8, 9.0]\nposition_m = [5.0, 3.0, 4.5]\n";
    fs::write(&hall, format!("{text}\n{mast}")).unwrap();

    let found = json(&["clearance", &hall]);
    assert_eq!(found["free"].as_bool(), Some(false));
    let nearest = &found["pairs"][0];
    assert!(number(&nearest["distance_m"]) < -0.1 && number(&nearest["margin_m"]) < 0.0, "{nearest}");
    let warned = run(&["statics", &hall]);
    for words in ["touch and overlap by", "\"rope\" have no diameter"] {
        assert!(stderr(&warned).contains(words), "{}", stderr(&warned));
    }
    let (header, rows) = csv(&["map", &hall, "--grid", "x=1,-3", "--quantity", "clearance"]);
    let status = header.iter().position(|column| column == "status").unwrap();
    assert_eq!(rows[0][status], "interference");
    let way = ["--pose", "1,0.5,3", "--move-to", "-3,0.5,3"];
    assert_eq!(json(&[&["clearance", &hall], &way[..]].concat())["free"].as_bool(), Some(false));
}
