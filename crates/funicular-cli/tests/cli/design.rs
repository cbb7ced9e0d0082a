//! `design`: the robot file and the page that it writes, poses from a file, text and exit codes.

use super::{json, number, project, robot, run, stderr, succeed};
use std::fs;

#[test]
fn a_design_is_printed_and_written_as_robot_file_and_page() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let cogiro = robot("cogiro.toml");
    let (designed, page, poses) = (at("designed.toml"), at("page.html"), at("poses.csv"));
    fs::write(&poses, "x_m,y_m,z_m\n3,2,1.2\n-3,2,1.2\n").unwrap();
    let options = [
        "--change",
        "cables.*.attachment_m=±0.05",
        "--poses",
        &poses,
        "--target-tension-n",
        "350",
        "--goal",
        "platform",
    ];
    let found = json(&[&["design", &cogiro, "--designed", &designed, "--page", &page], &options[..]].concat());
    assert!(number(&found["after"]) > number(&found["before"]));
    assert_eq!((found["goal"].as_str(), found["unit"].as_str()), (Some("platform"), Some("Hz")));
    assert_eq!(found["poses"].as_array().unwrap().len(), 2);

    // The file is the user's with other numbers, and has the result.
    let text = fs::read_to_string(&designed).unwrap();
    assert!(text.contains("# Non-rotating steel wire rope of 4 mm, DIN 3069."));
    for pose in ["3,2,1.2", "-3,2,1.2"] {
        let modes = json(&[
            "modes",
            &designed,
            "--pose",
            pose,
            "--target-tension-n",
            "350",
            "--cable-model",
            "catenary-static",
            "--below-hz",
            "20",
        ]);
        assert!(number(&modes["modes"][0]["frequency_hz"]) >= number(&found["after"]) * (1.0 - 1e-9), "{pose}");
    }
    let html = fs::read_to_string(&page).unwrap();
    for id in ["figure-poses-plot", "figure-points-plot", "figure-room-plot", "figure-history-plot", "table-values"] {
        assert!(html.contains(id), "{id}");
    }

    let text = succeed(&[&["design", &cogiro], &options[..]].concat());
    assert!(text.contains("lowest first natural frequency of the platform of 2 poses"), "{text}");
    assert!(text.contains("Hz more per cm of more room"), "{text}");
}

#[test]
fn wrong_bounds_are_bad_input_and_unmet_demands_no_solution() {
    let cogiro = robot("cogiro.toml");
    for (change, expected) in [
        ("platform.mass_kg", "bounds are written as in"),
        ("platform.mass_kg=±x", "x"),
        ("platform.mas_kg=±1", "did you mean `platform.mass_kg`?"),
    ] {
        let output = run(&["design", &cogiro, "--pose", "0,0,1.5", "--change", change]);
        assert_eq!(output.status.code(), Some(2), "{change}");
        assert!(stderr(&output).contains(expected), "{change}: {}", stderr(&output));
    }
    let output = run(&[
        "design",
        &cogiro,
        "--pose",
        "0,0,1.5",
        "--change",
        "cables.1.attachment_m=±0.01",
        "--goal",
        "rope-mass",
        "--min-frequency-hz",
        "20",
        "--target-tension-n",
        "350",
    ]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("reached after"), "{}", stderr(&output));
}

/// The poses of the document are those of its example.
#[test]
fn the_poses_of_the_example_are_nine() {
    let text = fs::read_to_string(project("docs/design/cogiro-poses.csv")).unwrap();
    assert_eq!(text.lines().count(), 10);
}
