//! Figures for papers: `-o FILE.svg` and `-o FILE.pdf`.

use super::{robot, run, run_with, stderr, succeed};
use std::fs;
use std::path::Path;

fn svg(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap();
    roxmltree::Document::parse(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert!(text.starts_with("<svg"), "{text}");
    text
}

#[test]
fn commands_with_a_figure_write_svg_and_pdf() {
    let folder = tempfile::tempdir().unwrap();
    for (line, part) in [
        ("statics ROBOT", "x [m]"),
        ("modes ROBOT --below-hz 3", "platform's share of energy [%]"),
        ("modes ROBOT --below-hz 3 --figure-mode 2", "Mode 2: 1.1"),
        ("frf ROBOT --from-hz 0.1 --to-hz 3 --points 200 --input fz --output az", "magnitude [(m/s²)/N]"),
        ("frf ROBOT --from-hz 0.1 --to-hz 3 --points 200 --input fz --output z --log", "phase [°]"),
        ("compare ROBOT --below-hz 2", "difference [%]"),
    ] {
        let (as_svg, as_pdf) = (folder.path().join("a.svg"), folder.path().join("a.PDF"));
        for path in [&as_svg, &as_pdf] {
            let words = line.split(' ').chain(["-o", path.to_str().unwrap()]);
            let own: Vec<&str> = line.trim_end_matches(" --figure-mode 2").split(' ').collect();
            let printed = succeed(&words.collect::<Vec<_>>());
            assert_eq!(printed, succeed(&own), "{line}: the text is that without a figure");
        }
        assert!(svg(&as_svg).contains(part), "{line}: {part}");
        let pdf = fs::read(&as_pdf).unwrap();
        assert!(pdf.starts_with(b"%PDF-") && pdf.windows(10).any(|part| part == b"/FontFile2"), "{line}");
    }
}

#[test]
fn several_responses_share_a_figure_if_they_share_a_unit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.svg");
    let draw = |outputs: [&str; 2]| {
        let range = ["--from-hz", "0.5", "--to-hz", "2", "--points", "50", "--input", "fz"];
        let signals = ["--output", outputs[0], "--output", outputs[1], "-o", path.to_str().unwrap()];
        run(&[&["frf", "ROBOT"][..], &range, &signals].concat())
    };
    let output = draw(["ax", "az"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = svg(&path);
    assert!(text.contains(">ax / fz</text>") && text.contains(">az / fz</text>"));
    let output = draw(["ax", "z"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("responses with one unit, and these have (m/s²)/N and m/N"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn a_figure_has_the_width_of_a_column() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.svg");
    let file = path.to_str().unwrap();
    for (width, shown) in [("88", "width=\"88mm\""), ("elsevier-double", "width=\"190mm\"")] {
        succeed(&["modes", "ROBOT", "--below-hz", "2", "--figure-width-mm", width, "-o", file]);
        assert!(svg(&path).contains(shown), "{width}");
    }
    succeed(&["modes", "ROBOT", "--below-hz", "2", "--font-size-pt", "10", "-o", file]);
    assert!(svg(&path).contains("font-size=\"10\""));
    for (arguments, says) in [
        (vec!["--figure-width-mm", "nature"], "is neither a width in millimetres nor a column"),
        (vec!["--figure-width-mm", "5"], "--figure-width-mm: 5 mm is out of range: give 40 to 1000 mm"),
        (vec!["--font-size-pt", "-8"], "not positive"),
        (vec!["--figure-mode", "50"], "--figure-mode is 50, but there are 8 modes below 2 Hz: give 1 to 8"),
    ] {
        let output = run(&[&["modes", "ROBOT", "--below-hz", "2", "-o", file][..], &arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(says), "{}", stderr(&output));
    }
    for option in [["--figure-width-mm", "88"], ["--font-size-pt", "9"], ["--figure-mode", "1"]] {
        let output = run(&[&["modes", "ROBOT", "--below-hz", "2"][..], &option].concat());
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains("belongs to a figure: write one with -o FILE.svg"), "{}", stderr(&output));
    }
}

#[test]
fn a_request_is_drawn_as_its_command() {
    let folder = tempfile::tempdir().unwrap();
    let [direct, again] = ["a.svg", "b.svg"].map(|name| folder.path().join(name));
    let line = ["modes", "ROBOT", "--below-hz", "2"];
    succeed(&[&line[..], &["-o", direct.to_str().unwrap()]].concat());
    let request = succeed(&[&line[..], &["--print-request"]].concat());
    let output = run_with(&["request", "-", "-o", again.to_str().unwrap()], &request);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(svg(&direct), svg(&again));
}

#[test]
fn a_map_is_drawn_as_a_slice_and_a_sweep_as_curves() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (rows, file) = (at("rows.parquet"), at("a.svg"));
    let cogiro = robot("cogiro.toml");
    let grid = ["--grid", "x=-9:9:13", "--grid", "y=-7:7:9", "--grid", "z=1,2.5"];
    let what = ["--quantity", "tension-max,stiffness-min,tensions", "-o", &rows];
    succeed(&[&["map", &cogiro][..], &grid, &what].concat());
    let plot = |more: &[&str]| run(&[&["plot", &rows, "-o", &file][..], more].concat());

    let output = plot(&["--quantity", "tension-max", "--at", "z=2.5"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(!stderr(&output).contains("the slice at"), "{}", stderr(&output));
    let first = svg(Path::new(&file));
    for part in ["x [m]", "y [m]", "tension max [N]", "infeasible"] {
        assert!(first.contains(&format!(">{part}</text>")), "{part}");
    }
    // The column has the same figure as the quantity; another slice has another one.
    assert_eq!(plot(&["--quantity", "tension_max_n", "--at", "z=2.5"]).status.code(), Some(0));
    assert_eq!(svg(Path::new(&file)), first);
    let output = plot(&["--quantity", "tension-max", "--plane", "y,z"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(stderr(&output).contains("the slice at x = 0 m is drawn; --at chooses another"), "{}", stderr(&output));
    assert!(svg(Path::new(&file)).contains(">z [m]</text>"));

    for (more, says) in [
        (vec![], "a figure shows one quantity, and the rows have tension_max_n, stiffness_min_n_per_m"),
        (vec!["--quantity", "sag-max"], "--quantity: the rows have no numbers of `sag-max`; they have tension_max_n"),
        (vec!["--quantity", "tensions"], "a figure cannot show all of `tensions`; choose one of its columns: tension_"),
        (vec!["--quantity", "tension-max", "--plane", "x,yaw"], "`yaw` is not an axis of these rows"),
        (vec!["--quantity", "tension-max", "--plane", "x,x"], "--plane names x twice"),
        (vec!["--quantity", "tension-max", "--at", "z=2"], "z = 2 is not a value of these rows"),
        (vec!["--quantity", "tension-max", "--at", "x=0"], "x is an axis of the slice itself"),
    ] {
        let output = plot(&more);
        assert_eq!(output.status.code(), Some(2), "{more:?}");
        assert!(stderr(&output).contains(says), "{more:?}: {}", stderr(&output));
    }
    let output = run(&["plot", &rows, "-o", &at("a.html"), "--quantity", "tension-max"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("--quantity belongs to a figure"), "{}", stderr(&output));

    let payload =
        ["--grid", "x=-2:2:3", "--grid", "y=-2:2:3", "--grid", "z=1", "--quantity", "payload-max", "-o", &rows];
    succeed(&[&["map", &cogiro][..], &payload].concat());
    assert_eq!(plot(&["--quantity", "payload-max"]).status.code(), Some(0));
    // The limits accompany the payload, and nobody requests a figure of them.
    let page = run(&["plot", &rows, "-o", &at("page.html")]);
    assert!(page.status.success() && !stderr(&page).contains("no figure"), "{}", stderr(&page));
    assert!(svg(Path::new(&file)).contains(">payload max [kg]</text>"));

    let masses = ["--vary", "platform.mass_kg=20:60:9", "--quantity", "tensions", "-o", &rows];
    succeed(&[&["sweep", "ROBOT"][..], &masses].concat());
    assert_eq!(plot(&[]).status.code(), Some(0));
    let curves = svg(Path::new(&file));
    for part in ["platform mass [kg]", "tension [N]", "tension platform 6"] {
        assert!(curves.contains(&format!(">{part}</text>")), "{part}");
    }
    assert!(curves.contains("stroke-dasharray"), "curves differ in grey");
    assert!(stderr(&plot(&["--at", "z=1"])).contains("these rows have one axis"));
}

/// Fonts, texts and pictures as another program sees them. It is skipped where poppler is not installed.
#[test]
fn another_program_reads_the_pdf() {
    use std::process::Command;
    let run = |program: &str, arguments: &[&str]| -> Option<String> {
        let output = Command::new(program).args(arguments).output().ok()?;
        assert!(output.status.success() && output.stderr.is_empty(), "{program}: {output:?}");
        String::from_utf8(output.stdout).ok()
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.pdf");
    let file = path.to_str().unwrap();
    succeed(&[
        "frf",
        "ROBOT",
        "--from-hz",
        "0.1",
        "--to-hz",
        "3",
        "--points",
        "200",
        "--input",
        "fz",
        "--output",
        "az",
        "-o",
        file,
    ]);
    let Some(fonts) = run("pdffonts", &[file]) else { return };
    let font = fonts.lines().nth(2).expect("one font");
    assert!(font.contains("+NotoSans") && font.contains("CID TrueType"), "{fonts}");
    // Embedded, a subset, with a map to Unicode.
    assert!(font.contains("yes yes yes") && fonts.lines().count() == 3, "{fonts}");
    let text = run("pdftotext", &["-layout", file, "-"]).unwrap();
    for part in ["frequency [Hz]", "az / fz", "−90", "180"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let size = run("pdfinfo", &[file]).unwrap();
    assert!(size.contains("Pages:           1") && size.contains("252 x "), "{size}");
}

/// Commands that compute first, whose figures show their results.
#[test]
fn results_are_drawn_without_a_second_run() {
    let folder = tempfile::tempdir().unwrap();
    let winches = robot("cogiro-winches.toml");
    for (line, part) in [
        ("winches WINCHES --pose 1,1,1.5 --required-velocity-m-s 1,1,0.5", "winch of cable"),
        ("speeds WINCHES --pose 1,1,1.5 --required-velocity-m-s 1,1,0.5", "motor drives"),
        ("loads WINCHES --pose 1,1,1.5 --required-force-n 150,150,150", "× required load: held"),
        ("payload WINCHES --pose 1,1,1.5", "maximum payload"),
        ("clearance WINCHES --pose 1,1,1.5", "required distance"),
        ("trajectory WINCHES --pose 1,1,1.5 --move-to 2,1,1.5 --speed-m-s 1 --acceleration-m-s2 1", "rope speed [m/s]"),
    ] {
        let own: Vec<&str> = line.split(' ').map(|word| if word == "WINCHES" { &winches } else { word }).collect();
        for ending in ["svg", "pdf"] {
            let path = folder.path().join(format!("a.{ending}"));
            let printed = succeed(&[&own[..], &["-o", path.to_str().unwrap()]].concat());
            assert_eq!(printed, succeed(&own), "{line}: the text is that without a figure");
            if ending == "svg" {
                assert!(svg(&path).contains(part), "{line}: {part}");
            } else {
                assert!(fs::read(&path).unwrap().starts_with(b"%PDF-"), "{line}");
            }
        }
    }
}

/// Winches in an ellipsoid of velocities need less than in the box around it.
#[test]
fn every_direction_up_to_a_speed_asks_for_less_than_all_axes_at_once() {
    let winches = robot("cogiro-winches.toml");
    let speed = |more: &[&str]| {
        let line = ["winches", &winches, "--pose", "1,1,1.5", "--required-velocity-m-s", "1,1,1", "--format", "json"];
        let found: serde_json::Value = serde_json::from_str(&succeed(&[&line[..], more].concat())).unwrap();
        found["winches"][0]["speed_m_s"].as_f64().unwrap()
    };
    let (boxed, ball) = (speed(&[]), speed(&["--required-velocity-shape", "ellipsoid"]));
    assert!(ball < 1.05 && ball > 0.95 && boxed > 1.4, "{ball} {boxed}");
}

#[test]
fn the_page_of_winches_has_the_needs_what_asks_for_them_and_the_offers() {
    let folder = tempfile::tempdir().unwrap();
    let (path, offers) = (folder.path().join("winches.html"), folder.path().join("offers.csv"));
    fs::write(&offers, "name,tension_n,speed_m_s\nsmall <1>,200,3\nbig,5000,3\n").unwrap();
    let winches = robot("cogiro-winches.toml");
    let line = ["winches", &winches, "--pose", "1,1,1.5", "--required-velocity-m-s", "1,1,0.5", "--offers"];
    succeed(&[&line[..], &[offers.to_str().unwrap(), "-o", path.to_str().unwrap()]].concat());
    let page = fs::read_to_string(&path).unwrap();
    for part in ["id=\"table-needs\"", "id=\"table-asked\"", "id=\"table-offers\"", "every cable", "offer big", "<svg"]
    {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("small <1>"), "names stay text");
}

#[test]
fn a_summary_is_two_pages_as_html_and_as_pdf() {
    let folder = tempfile::tempdir().unwrap();
    let [html, pdf] = ["a.html", "a.pdf"].map(|name| folder.path().join(name));
    for (file, pose) in [("yuan2014-4mm.toml", None), ("cogiro-winches.toml", Some("1,1,1.5"))] {
        let own = robot(file);
        let mut line = vec!["report", own.as_str(), "--below-hz", "5", "--summary"];
        line.extend(pose.into_iter().flat_map(|pose| ["--pose", pose]));
        succeed(&[&line[..], &["-o", html.to_str().unwrap()]].concat());
        let page = fs::read_to_string(&html).unwrap();
        assert_eq!(page.matches("<section class=\"sheet\">").count(), 2, "{file}");
        for part in ["What it carries", "Where it works", "winches", "Clearance", "First resonance", "What was assumed"]
        {
            assert!(page.contains(part), "{file}: {part}");
        }
        assert!(!page.contains("http://") || page.matches("http://").count() == page.matches("www.w3.org").count());
        assert!(!page.contains("⟪") && !page.contains("NaN"), "{file}");
        succeed(&[&line[..], &["-o", pdf.to_str().unwrap()]].concat());
        let bytes = fs::read(&pdf).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        assert!(text.starts_with("%PDF-1.7") && text.contains("/Count 2"), "{file}");
    }
    let output = run(&["report", "ROBOT", "-o", pdf.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("give --summary"), "{}", stderr(&output));
}
