//! The pages: where they go, what they repeat, what they refuse.

use super::{command, robot, run, stderr, stdout, succeed};
use std::fs;

#[test]
fn without_arguments_the_pages_are_written_here() {
    let directory = tempfile::tempdir().unwrap();
    for (verb, title) in [("report", "INSA Rennes"), ("paper", "Yuan, Courteille and Deblaise")] {
        let output = command(&[verb]).current_dir(directory.path()).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert_eq!(stdout(&output), "");
        let name = format!("funicular-{verb}.html");
        assert!(stderr(&output).starts_with(&format!("wrote {name} (")), "{}", stderr(&output));
        assert!(stderr(&output).ends_with(" MB)\n"), "{}", stderr(&output));
        let page = fs::read_to_string(directory.path().join(name)).unwrap();
        assert!(page.contains(&format!("<h1>{title}")) && page.trim_end().ends_with("</html>"));
        assert!(page.contains(&format!("<pre>funicular {verb}</pre>")));
    }
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 2, "nothing else is left");
}

#[test]
fn a_page_repeats_what_was_typed_quoted_for_a_shell() {
    let page = succeed(&["report", &robot("cogiro.toml"), "-o", "-", "--set", "name=\"a b\"", "--input", "f:1,0,1"]);
    assert!(page.contains("--set &#39;name=&#34;a b&#34;&#39; --input &#39;f:1,0,1&#39;</pre>"));
    assert!(page.contains("<h1>a b</h1>") && page.contains("name = &#34;a b&#34; # from --set"));
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
        &"report -o - --pose 0,0,0.6 --mass-kg 20 --static-model spring --cable-model spring --assembly paper \
          --in-plane-only --below-hz 12 --input mz --output vx --output-point-m 0,0,-0.2"
            .split_whitespace()
            .collect::<Vec<_>>(),
    );
    for expected in [
        "<dd>20.00 kg</dd>",
        "0.0000, 0.0000, 0.6000 m",
        "straight elastic cables",
        "below 12 Hz",
        "as in Yuan et al. 2014",
        "in their planes only",
        "the velocity along x of the platform&#39;s point (0.000, 0.000, −0.200) m to a moment about z",
        "(m/s)/(N·m)",
    ] {
        assert!(page.contains(expected), "{expected}");
    }
}

#[test]
fn pages_that_cannot_be_are_refused() {
    for (line, code, expected) in [
        ("report --below-hz 1e6", 2, "lower the limit"),
        ("report --below-hz 0", 2, "0 is not positive"),
        ("report no-such.toml", 2, "cannot read the robot file no-such.toml"),
        ("report ROBOT -o ROBOT", 2, "refusing to write the result over the robot file"),
        ("report -o /", 2, "it is a directory"),
        ("report --input mz --input-point-m 0,0,1", 2, "has no effect"),
        ("report --pose 30,0,1 -o -", 1, "no equilibrium"),
        ("report --set platform.mass_kg=-1", 2, "robots/yuan2014-4mm.toml with --set:"),
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
    let output = run(&["report", &robot("yuan2014-8mm.toml"), "--cable-model", "closed-form", "-o", "-"]);
    assert!(stderr(&output).starts_with("warning: cable "), "{}", stderr(&output));
    assert!(stdout(&output).contains("<ul class=\"warnings\">"));
}
