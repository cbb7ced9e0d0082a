//! Tests of the pages: output files, repeated command lines, refusals.

use super::{command, json, number, robot, run, stderr, stdout, succeed};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use flate2::read::GzDecoder;
use funicular::cable::CableModel;
use funicular::cable_motion::CableStations;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::modes;
use funicular::robot::{Robot, State};
use funicular::statics::{self, StaticModel};
use serde_json::Value;
use std::fs;
use std::io::Read as _;

#[test]
fn without_arguments_the_pages_are_written_here() {
    let directory = tempfile::tempdir().unwrap();
    for (verb, title) in [("report", "INSA Rennes"), ("paper", "Yuan, Courteille and Deblaise")] {
        let output = command(&[verb]).current_dir(directory.path()).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert_eq!(stdout(&output), "");
        let name = format!("funicular-{verb}.html");
        assert!(stderr(&output).starts_with(&format!("wrote {name} (")), "{}", stderr(&output));
        // The ropes of this robot have no loss of their stretch, which a page with damping ratios says.
        let (size, warning) = stderr(&output).split_once('\n').unwrap();
        assert!(size.ends_with(" MB)"), "{size}");
        assert_eq!(warning.contains("lives on the stretch of the ropes"), verb == "report", "{warning}");
        assert_eq!(warning.lines().filter(|line| !line.is_empty()).count(), usize::from(verb == "report"), "{warning}");
        let page = fs::read_to_string(directory.path().join(name)).unwrap();
        assert!(page.contains(&format!("<h1>{title}")) && page.trim_end().ends_with("</html>"));
        assert!(page.contains(&format!("<pre>funicular {verb}</pre>")));
    }
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 2, "nothing else is left");
}

/// The table of tensions has the limits and margins of `statics`, and none for a robot without limits.
#[test]
fn a_report_has_the_tension_limits_of_the_robot() {
    let found = json(&["statics", &robot("cogiro.toml"), "--pose", "1,2,1.5"]);
    let page = succeed(&["report", &robot("cogiro.toml"), "--pose", "1,2,1.5", "--below-hz", "5", "-o", "-"]);
    let (_, table) = page.split_once("Margin: distance of the tension from its nearest limit").unwrap();
    let (table, _) = table.split_once("</table>").unwrap();
    for cable in found["cables"].as_array().unwrap() {
        let margin = format!("{:.1}", number(&cable["tension_margin_n"]));
        assert!(table.contains(&format!(">{margin}<")), "{margin}: {table}");
    }
    assert!(page.contains("1 mixed mode."), "one mode is no plural");

    let without = succeed(&["report", "--below-hz", "2", "-o", "-"]);
    assert!(without.contains("table-tensions") && !without.contains("Margin: distance"));
}

#[test]
fn a_page_repeats_what_was_typed_quoted_for_a_shell() {
    let page = succeed(&["report", &robot("cogiro.toml"), "-o", "-", "--set", "name=\"a b\"", "--input", "f:1,0,1"]);
    assert!(page.contains("--set &#39;name=&#34;a b&#34;&#39; --input &#39;f:1,0,1&#39;</pre>"));
    assert!(page.contains("<h1>a b</h1>") && page.contains("name = &#34;a b&#34; # set: name"));
    assert!(page.contains("a force along (1.000, 0.000, 1.000) at the platform origin"));
}

#[test]
fn the_built_in_robot_is_that_of_the_file() {
    let own =
        |page: String| page[page.find("<header>").unwrap()..page.find("<section id=\"repeat\">").unwrap()].to_owned();
    assert!(own(succeed(&["report", "-o", "-"])) == own(succeed(&["report", "ROBOT", "-o", "-"])));
}

#[test]
fn options_of_state_model_and_response_reach_the_page() {
    let page = succeed(
        &"report -o - --pose 0,0,0.6 --mass-kg 20 --static-model spring --cable-model spring --assembly \
          without-geometric-stiffness --in-plane-only --below-hz 12 --input mz --output vx --output-point-m 0,0,-0.2"
            .split_whitespace()
            .collect::<Vec<_>>(),
    );
    for expected in [
        "<dd>20.00 kg</dd>",
        "0.0000, 0.0000, 0.6000 m",
        "straight elastic cables",
        "below 12 Hz",
        "as in Yuan et al. 2014",
        "cables with in-plane stiffness only",
        "the velocity along x of the platform&#39;s point (0.000, 0.000, −0.200) m to a moment about z",
        "(m/s)/(N·m)",
    ] {
        assert!(page.contains(expected), "{expected}");
    }
}

#[test]
fn impossible_pages_are_refused() {
    for (line, code, expected) in [
        ("report --below-hz 1e6", 2, "lower the frequency limit"),
        ("report --cable-model shallow-dynamic --below-hz 1e6", 2, "at most 2000 are listed"),
        ("report --below-hz 0", 2, "0 is not positive"),
        ("report no-such.toml", 2, "cannot read the robot file no-such.toml"),
        ("report ROBOT -o ROBOT", 2, "refusing to write the page over the robot file"),
        ("report -o /", 2, "it is a directory"),
        ("report --input mz --input-point-m 0,0,1", 2, "has no effect"),
        ("report --pose 30,0,1 -o -", 1, "no tensions found"),
        ("report --set platform.mass_kg=-1", 2, "robots/yuan2014-4mm.toml with changes:"),
        ("report --format json", 2, "unexpected argument"),
        ("paper ROBOT", 2, "unexpected argument"),
        ("paper -o /no/such/place.html", 2, "there is no directory /no/such"),
    ] {
        let directory = tempfile::tempdir().unwrap();
        let arguments: Vec<&str> = line.split(' ').collect();
        let output = command(&arguments).current_dir(directory.path()).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{line}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{line}: {}", stderr(&output));
        assert!(output.stdout.is_empty(), "{line}");
        assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 0, "{line}: no file is left");
    }
}

#[test]
fn a_dash_is_standard_output_for_every_command() {
    assert_eq!(stdout(&run(&["statics", "ROBOT", "-o", "-"])), succeed(&["statics", "ROBOT"]));
}

#[test]
fn a_page_warns_on_stderr_too() {
    let output = run(&["report", &robot("yuan2014-8mm.toml"), "--cable-model", "shallow-dynamic", "-o", "-"]);
    assert!(stderr(&output).starts_with("warning: cable "), "{}", stderr(&output));
    assert!(stdout(&output).contains("<ul class=\"warnings\">"));
}

/// Four equal cables at a point mass have modes in which the mass rests.
#[test]
fn modes_of_cables_alone_do_not_count_as_modes_that_move_the_platform() {
    let page = succeed(&["report", &robot("stadium-camera.toml"), "--below-hz", "0.8", "-o", "-"]);
    let shares = |table: &str, column: usize| -> Vec<String> {
        let body = page.split_once(&format!("<table id=\"{table}\"")).unwrap().1.split_once("</table>").unwrap().0;
        let cell = |row: &str| Some(row.split("</td>").nth(column)?.rsplit('>').next()?.to_owned());
        body.split("</tr>").filter(|row| row.contains("<td")).filter_map(cell).collect()
    };
    assert!(shares("table-modes", 4).iter().any(|share| share == "0.0"));
    let listed = shares("table-side-by-side", 2);
    assert!(!listed.is_empty() && !listed.iter().any(|share| share == "0.0"), "{listed:?}");
    assert!(page.contains("with at least 0.1 % of their energy in it"));
}

/// Header and displacements of the mode shapes of a page, read like its script: per mode, cable, axis and station.
fn shapes_of(page: &str) -> (Value, Vec<Vec<Vec<Vec<f64>>>>) {
    let packed = page.split_once("id=\"shapes-data\" data-packed>").unwrap().1.split_once('<').unwrap().0;
    let mut bytes = Vec::new();
    GzDecoder::new(BASE64.decode(packed).unwrap().as_slice()).read_to_end(&mut bytes).unwrap();
    let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
    let header: Value = serde_json::from_slice(&bytes[4..4 + length]).unwrap();
    let mut steps = bytes[4 + length..].chunks(2).map(|pair| i16::from_le_bytes([pair[0], pair[1]]));
    let cables = header["cables"].as_array().unwrap().len();
    let mut shapes = Vec::new();
    for mode in header["modes"].as_array().unwrap() {
        let (intervals, scale) = (mode["intervals"].as_u64().unwrap(), mode["scale"].as_f64().unwrap());
        let mut along = || {
            let (mut slope, mut value) = (0.0, 0.0);
            let mut next = || {
                slope += f64::from(steps.next().unwrap());
                value += slope;
                scale * value
            };
            (0..=intervals).map(|_| next()).collect::<Vec<f64>>()
        };
        shapes.push((0..cables).map(|_| (0..3).map(|_| along()).collect()).collect());
    }
    assert!(steps.next().is_none(), "nothing is left over");
    (header, shapes)
}

#[test]
fn the_mode_shapes_of_a_page_are_those_of_the_library_and_fit_the_platform() {
    for (name, below_hz) in
        [("yuan2014-4mm.toml", 6.0), ("cogiro.toml", 12.0), ("sap2000-8-cable-point-mass.toml", 30.0)]
    {
        let below = below_hz.to_string();
        let page =
            succeed(&["report", &robot(name), "--cable-model", "catenary-dynamic", "--below-hz", &below, "-o", "-"]);
        let (header, shapes) = shapes_of(&page);

        let robot = Robot::from_toml(&fs::read_to_string(super::robot(name)).unwrap()).unwrap();
        let State::Lengths(lengths) = &robot.state else { panic!("the file gives lengths") };
        let rest = statics::forward(&robot, lengths, StaticModel::Catenary, None).unwrap();
        let linearisation = Linearisation { cable_model: CableModel::CatenaryDynamic, ..Linearisation::default() };
        let dynamics = Dynamics::about(&robot, &rest, linearisation, below_hz).unwrap();
        let found = modes::below(&dynamics, below_hz);
        assert_eq!(shapes.len(), found.modes.len());
        assert_eq!(header["total"], found.modes.len());
        assert!(!shapes.is_empty());
        for (k, mode) in found.modes.iter().enumerate() {
            let described = &header["modes"][k];
            assert_eq!(described["hz"], format!("{:.4}", mode.frequency_hz));
            assert_eq!(described["kind"], mode.kind.name());
            let (intervals, step) = (described["intervals"].as_u64().unwrap(), described["scale"].as_f64().unwrap());
            let fractions: Vec<f64> = (0..=intervals).map(|at| at as f64 / intervals as f64).collect();
            let mut largest = 0.0_f64;
            for (i, state) in rest.cables.iter().enumerate() {
                let cable = CableStations::new(&robot, &rest, &dynamics, i, &fractions, false).unwrap();
                for (station, moved) in cable.in_mode(&dynamics, mode).iter().enumerate() {
                    for (axis, expected) in moved.iter().enumerate() {
                        let given = shapes[k][i][axis][station];
                        // Rounded to integer steps.
                        assert!((given - expected).abs() <= 0.5 * step * (1.0 + 1e-9), "{name} mode {k} cable {i}");
                        largest = largest.max(given.abs());
                    }
                }
                // In the page's numbers a cable's first point moves with the platform's corner.
                let [dx, dy, dz, tx, ty, tz]: [f64; 6] = serde_json::from_value(described["shape"].clone()).unwrap();
                let corner_w = Vec3::new(dx, dy, dz) + Vec3::new(tx, ty, tz).cross(&state.lever_w);
                let axes: [[f64; 3]; 3] = serde_json::from_value(header["cables"][i]["axes"].clone()).unwrap();
                let end_w: Vec3 = (0..3).map(|axis| Vec3::from(axes[axis]) * shapes[k][i][axis][0]).sum();
                assert!((end_w - corner_w).norm() <= step * (1.0 + 1e-9), "{name} mode {k} cable {i}");
            }
            assert!((largest / step - 1000.0).abs() < 1e-6, "the scale is used in full");
        }
    }
}

/// The page is part of a build only if the variable FUNICULAR_PAGE named it; scripts/release tests a build with it.
#[test]
fn a_live_page_contains_the_robot_or_says_how_to_build_with_the_page() {
    let line = ["live", &robot("cogiro.toml"), "--pose", "1,2,1.5", "--set", "platform.mass_kg=150", "-o", "-"];
    let output = run(&line);
    if funicular_pages::pages::live::is_built() {
        let page = stdout(&output);
        assert!(page.contains("\"pose\":[1.0,2.0,1.5,0.0,0.0,0.0]") && page.contains("platform.mass_kg"));
    } else {
        assert_eq!(output.status.code(), Some(2));
        let said = stderr(&output);
        assert!(
            said.contains("this build does not contain the page: in the sources of funicular, `scripts/install`"),
            "{said}"
        );
    }
    let output = run(&["live", &robot("cogiro.toml"), "--mass-kg", "-1", "-o", "-"]);
    assert_eq!(output.status.code(), Some(2));
}
