//! `workspace`: sets with known volumes, files of the surface, orientations, refusals.

use super::{csv, json, number, robot, run, stderr, stdout, succeed};
use std::f64::consts::PI;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Point mass without weight on cables from the corners of a cube of 2 m about the origin; its path. Cables without a
/// maximum hold it everywhere inside.
fn cube(folder: &Path) -> String {
    let mut text =
        "name = \"cube\"\ngravity_m_s2 = [0.0, 0.0, 0.0]\n[platform]\nmass_kg = 1.0\nmotion = \"point-mass\"\n\
                    [materials.rope]\nmass_kg_per_m = 1e-6\naxial_stiffness_n = 1e6\nminimum_tension_n = 1.0\n"
            .to_owned();
    for corner in 0..8 {
        let [x, y, z] = [1, 2, 4].map(|bit| if corner & bit == 0 { -1.0 } else { 1.0 });
        let _ = writeln!(
            text,
            "[[cables]]\nname = \"{}\"\nanchor_m = [{x:?}, {y:?}, {z:?}]\nmaterial = \"rope\"",
            corner + 1
        );
    }
    let path = folder.join("cube.toml");
    fs::write(&path, text).unwrap();
    path.display().to_string()
}

const GRID: [&str; 6] = ["--grid", "x=-1.2:1.2:25", "--grid", "y=-1.2:1.2:25", "--grid", "z=-1.2:1.2:25"];

/// The corner of the cube from which the first cable comes.
const CORNER: [&str; 6] = ["--grid", "x=-1.2:0:25", "--grid", "y=-1.2:0:25", "--grid", "z=-1.2:0:25"];

fn words<'a>(robot: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&["workspace", robot, "--static-model", "ideal"], &GRID[..], more].concat()
}

fn near_corner<'a>(robot: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&["workspace", robot, "--static-model", "ideal"], &CORNER[..], &["--at-most", "unstrained_length_1_m=0.8"], more]
        .concat()
}

#[test]
fn lengths_and_tensions_give_an_eighth_of_a_ball() {
    let folder = tempfile::tempdir().unwrap();
    let cube = cube(folder.path());

    // All positions that the cables hold: the cube, to the tolerance of the vertices.
    let all = json(&words(&cube, &[]));
    assert!((number(&all["volumes"][0]["volume_m3"]) / 8.0 - 1.0).abs() < 0.02, "{}", all["volumes"]);
    assert_eq!(all["conditions"][0]["of"], "tensions");

    // Those near the first corner.
    let near = json(&near_corner(&cube, &["--section", "z=-0.75"]));
    let volume = number(&near["volumes"][0]["volume_m3"]);
    assert!((volume / (PI / 6.0 * 0.512) - 1.0).abs() < 0.04, "{volume}");
    assert_eq!((near["parts"].as_array().unwrap().len(), near["holes"].as_array().unwrap().len()), (1, 0));
    assert_eq!(near["complete"].as_bool(), Some(true));
    let [low, high] = [0, 1].map(|end| number(&near["bounds_m"][end][0]));
    assert!((low + 1.0).abs() < 1e-3 && (high + 0.2).abs() < 0.02, "{low} {high}");
    let section = number(&near["sections"][0]["area_m2"]);
    assert!((section / (0.25 * PI * (0.64 - 0.0625)) - 1.0).abs() < 0.03, "{section}");

    // Where cables have other lengths the sets differ: what both share is the smaller one.
    let both = json(&near_corner(&cube, &["--compare-set", "materials.rope.minimum_tension_n=2"]));
    let compared = &both["compared"];
    assert!((number(&compared["common_volume_m3"]) - volume).abs() < 1e-3 * volume, "{compared}");
    assert!(number(&compared["only_own_m3"]).abs() < 1e-3 && number(&compared["only_other_m3"]).abs() < 1e-3);
}

#[test]
fn rays_from_a_corner_region_have_their_intervals() {
    let folder = tempfile::tempdir().unwrap();
    let cube = cube(folder.path());
    let found = json(&near_corner(&cube, &["--rays", "258", "--center-m", "-0.75,-0.75,-0.75"]));
    let volumes = found["volumes"].as_array().unwrap();
    let by = |name: &str| volumes.iter().find(|row| row["by"] == name).unwrap();
    assert_eq!(found["rays"]["count"].as_u64(), Some(258));
    let (rays, hull) = (number(&by("rays")["volume_m3"]), number(&by("hull of rays")["volume_m3"]));
    let exact = PI / 6.0 * 0.8_f64.powi(3);
    assert!((rays / exact - 1.0).abs() < 0.1 && hull < rays, "{rays} {hull} {exact}");
}

#[test]
fn the_surface_is_the_same_in_every_file_and_with_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let cube = cube(folder.path());
    let at = |name: &str| folder.path().join(name).display().to_string();
    let [stl, ply, vtp, page] = ["set.stl", "set.ply", "set.vtp", "set.html"].map(at);
    let text = succeed(&near_corner(&cube, &["-o", &stl, "--surface", &ply, "--surface", &vtp, "--page", &page]));
    assert!(text.contains("unstrained_length_1_m at most 0.8"), "{text}");

    let found = json(&near_corner(&cube, &[]));
    let (vertices, triangles) =
        (found["vertices_m"].as_array().unwrap().len(), found["triangles"].as_array().unwrap().len());
    assert_eq!(fs::metadata(&stl).unwrap().len(), 84 + 50 * triangles as u64);
    let ply = fs::read_to_string(ply).unwrap();
    assert_eq!(ply.lines().count(), 10 + vertices + triangles);
    assert!(ply.contains(&format!("element vertex {vertices}\n")));
    let vtp = fs::read_to_string(vtp).unwrap();
    assert!(vtp.contains(&format!("NumberOfPoints=\"{vertices}\" NumberOfPolys=\"{triangles}\"")));
    assert!(fs::read_to_string(page).unwrap().contains("figure-surface"));

    let of_threads =
        ["1", "3"].map(|threads| succeed(&near_corner(&cube, &["--threads", threads, "--format", "json"])));
    assert_eq!(of_threads[0], of_threads[1]);
    let (header, rows) = csv(&near_corner(&cube, &[]));
    assert_eq!((rows.len(), header[3].as_str()), (3, "volume_m3"));
}

#[test]
fn more_orientations_that_are_all_needed_make_the_set_smaller() {
    let cogiro = robot("cogiro.toml");
    let volume = |more: &[&str]| {
        let grid = ["workspace", &cogiro, "--step-m", "1.2", "--grid", "z=-1:5:5", "--max-tension-n", "5000"];
        number(&json(&[&grid[..], more].concat())["volumes"][0]["volume_m3"])
    };
    let one = volume(&[]);
    let turned = ["--grid", "yaw=-15,0,15"];
    let (all, some) = (volume(&turned), volume(&[&turned[..], &["--orientations", "some"]].concat()));
    assert!(all < one && one <= some, "{all} {one} {some}");
}

#[test]
fn what_cannot_be_searched_is_refused_with_what_to_give() {
    let folder = tempfile::tempdir().unwrap();
    let cube = cube(folder.path());
    let elsewhere = folder.path().join("set.obj").display().to_string();
    for (more, says) in [
        (&["--at-least", "load-factr=1"][..], "did you mean `load-factor`"),
        (&["--at-least", "stiffness=1"], "name one of `stiffness_x_n_per_m`"),
        (&["--at-least", "first-kind=1"], "a word, not a number"),
        (&["--at-least", "load-factor"], "as in load-factor=1"),
        (&["--at-least", "sensitivity:tensions:platform.mass_kg=1"], "derivatives cannot limit"),
        (&["--grid", "x=-1:1:9"], "given twice"),
        (&["--grid", "yaw=-5,5"], "a point mass has no orientation"),
        (&["--rays", "100"], "give 66 or 162"),
        (&["--rays", "18", "--center-m", "5,0,0"], "not inside the box"),
        (&["--section", "z=7"], "the grid reaches from -1.2 to 1.2 m"),
        (&["--section", "yaw=7"], "at right angles to x, y or z"),
        (&["--vertex-tolerance-m", "0"], "0"),
        (&["--surface", &elsewhere], ".stl, .ply or .vtp"),
    ] {
        let refused = run(&words(&cube, more));
        assert_eq!(refused.status.code(), Some(2), "{more:?}: {}", stderr(&refused));
        assert!(stderr(&refused).contains(says), "{more:?}: {}", stderr(&refused));
    }
    let many = run(&["workspace", &cube, "--step-m", "1e-4"]);
    assert!(many.status.code() == Some(2) && stderr(&many).contains("are too many"), "{}", stderr(&many));
    let listed = run(&["workspace", &cube, "--grid", "x=0,1"]);
    assert!(listed.status.code() == Some(2) && stderr(&listed).contains("needs a range"), "{}", stderr(&listed));
    for (more, says) in [
        (["--grid", "z=-1:1:9"], "leave this axis out"),
        (["--rays", "18"], "leave out --rays"),
        (["--section", "z=0"], "leave out --section"),
    ] {
        let planar = run(&[&["workspace", &robot("kntu-planar.toml")][..], &more].concat());
        assert!(planar.status.code() == Some(2) && stderr(&planar).contains(says), "{}", stderr(&planar));
    }

    let nothing = run(&words(&cube, &["--at-least", "unstrained_length_1_m=9"]));
    assert!(nothing.status.code() == Some(1) && stderr(&nothing).contains("no position"), "{}", stderr(&nothing));
    assert!(stdout(&nothing).is_empty());
}

#[test]
fn what_the_grid_leaves_open_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let cube = cube(folder.path());
    let warned = |words: &[&str]| {
        let told = run(words);
        assert_eq!(told.status.code(), Some(0), "{}", stderr(&told));
        stderr(&told).to_owned()
    };
    // The set fills the box between the anchors; a third of a step is left of the ball.
    let cut = warned(&[
        "workspace",
        &cube,
        "--static-model",
        "ideal",
        "--grid",
        "x=-0.5:0.5:5",
        "--grid",
        "y=-0.5:0.5:5",
        "--grid",
        "z=-0.5:0.5:5",
    ]);
    assert!(cut.contains("reaches the box of the grid at -x, +x, -y, +y, -z, +z"), "{cut}");
    let coarse = warned(&[
        "workspace",
        &cube,
        "--static-model",
        "ideal",
        "--at-most",
        "unstrained_length_1_m=0.8",
        "--grid",
        "x=-1.2:1.2:13",
        "--grid",
        "y=-1.2:1.2:13",
        "--grid",
        "z=-1.2:1.2:13",
    ]);
    assert!(coarse.contains("the grid is coarse for this set"), "{coarse}");
    let alone = warned(&["workspace", &cube, "--static-model", "ideal", "--grid", "x=-1.2:1.2:10"]);
    assert!(alone.contains("a multiple of 4"), "{alone}");
}

/// The set of a planar platform is an area: that of the cells of a map, to the error of counting cells.
#[test]
fn a_planar_platform_has_an_area() {
    let kntu = robot("kntu-planar.toml");
    let found = json(&["workspace", &kntu, "--step-m", "0.05"]);
    let area = number(&found["plane"]["area_m2"]);
    let folder = tempfile::tempdir().unwrap();
    let rows = folder.path().join("rows.csv").display().to_string();
    let grid = ["--grid", "x=-1.11:1.11:112", "--grid", "y=-1.04:1.04:105", "-o", &rows];
    succeed(&[&["map", &kntu][..], &grid].concat());
    let text = std::fs::read_to_string(&rows).unwrap();
    let counted =
        text.lines().filter(|line| line.contains(",ok,") || line.ends_with(",ok")).count() as f64 * 0.02 * 0.02;
    assert!(area > 1.0 && (area / counted - 1.0).abs() < 0.02, "{area} {counted}");

    let text = stdout(&run(&["workspace", &kntu, "--step-m", "0.05"])).to_owned();
    assert!(text.contains("plane             z = 0 m") && !text.contains("m³"), "{text}");
    let figure = folder.path().join("area.svg").display().to_string();
    succeed(&["workspace", &kntu, "--step-m", "0.1", "-o", &figure]);
    let svg = std::fs::read_to_string(&figure).unwrap();
    assert!(svg.contains("<svg") && svg.contains("anchor"), "{svg}");
}

/// A limit that is met exactly over a region is kept there: the set is that without the limit, and its stated error
/// bounds the difference from a finer grid. A section at a face of the grid has the area of one just inside.
#[test]
fn a_limit_that_is_met_exactly_over_a_region_loses_nothing() {
    let hall = super::project("docs/quick-start/hall.toml");
    let grid = |steps: [usize; 3]| {
        [("x=-10:10", steps[0]), ("y=-6:6", steps[1]), ("z=2:8", steps[2])]
            .map(|(of, count)| format!("{of}:{}", count + 1))
    };
    let found = |steps: [usize; 3], more: &[&str]| {
        let [x, y, z] = grid(steps);
        json(&[&["workspace", &hall, "--grid", &x, "--grid", &y, "--grid", &z][..], more].concat())
    };
    let volume = |of: &serde_json::Value| number(&of["volumes"][0]["volume_m3"]);
    let stated = |of: &serde_json::Value| number(&of["volumes"][0]["volume_error_m3"]);
    let plain = found([16, 12, 8], &["--section", "z=2,2.0001"]);
    let limited = found([16, 12, 8], &["--at-least", "tension_margin_n=0"]);
    assert!((volume(&limited) / volume(&plain) - 1.0).abs() < 0.01, "{} {}", volume(&limited), volume(&plain));
    let at_limit = found([16, 12, 8], &["--at-least", "tension_min_n=50"]);
    assert!((volume(&at_limit) / volume(&plain) - 1.0).abs() < 0.01, "{} {}", volume(&at_limit), volume(&plain));

    let fine = found([32, 24, 16], &[]);
    let change = (volume(&fine) - volume(&plain)).abs();
    assert!(change < stated(&plain) && stated(&fine) < stated(&plain), "{change} {}", stated(&plain));
    let areas: Vec<f64> = [0, 1].map(|i| number(&plain["sections"][i]["area_m2"])).into();
    assert!(areas[1] > 10.0 && (areas[0] / areas[1] - 1.0).abs() < 1e-3, "{areas:?}");

    let refused = run(&["workspace", &hall, "--at-least", "load-factor=1"]);
    assert!(
        refused.status.code() == Some(2) && stderr(&refused).contains("nothing is required"),
        "{}",
        stderr(&refused)
    );
}

/// Ctrl-C keeps what was found: a set of larger steps where they divide the grid, and otherwise what the positions say
/// that were asked so far.
#[cfg(unix)]
#[test]
fn ctrl_c_during_the_first_steps_keeps_what_was_found() {
    let stopped = |values: usize| {
        let grid: Vec<String> = ["x=-7:7", "y=-5:5", "z=0:5"].iter().map(|axis| format!("{axis}:{values}")).collect();
        let mut long = std::process::Command::new(env!("CARGO_BIN_EXE_funicular"));
        long.args(["workspace", &robot("cogiro.toml"), "--required-force-n", "50,50,50"]);
        for axis in &grid {
            long.args(["--grid", axis]);
        }
        let child = long.stdout(std::process::Stdio::piped()).stderr(std::process::Stdio::piped()).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_secs(4));
        std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
        child.wait_with_output().unwrap()
    };
    // 226 steps have no larger ones but two at once: some 1.5 million positions come first.
    let few = stopped(227);
    assert_eq!(few.status.code(), Some(130), "{}", stderr(&few));
    let says = stderr(&few);
    assert!(
        says.contains("asked so far, which are spread over the box") && says.contains("meet the conditions"),
        "{says}"
    );

    // 256 steps: 16, 8 and 4 cells along each axis are ready after some thousand positions.
    let coarse = stopped(257);
    assert_eq!(coarse.status.code(), Some(130), "{}", stderr(&coarse));
    assert!(stdout(&coarse).contains("volume") && stderr(&coarse).contains("stopped"), "{}", stderr(&coarse));
}
