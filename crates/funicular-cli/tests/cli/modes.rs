//! `modes`: the list, its part in responses, shapes of cables.

use super::{close, csv, json, number, numbers, robot, run, stderr, succeed};

#[test]
fn modes_below_20_hz_are_147_and_certified() {
    let value = json(&["modes", "ROBOT", "--below-hz", "20"]);
    assert_eq!(value["count_below"], 147);
    assert_eq!(value["certified"], true);
    assert_eq!(value["cable_model"], "catenary-dynamic");
    let modes = value["modes"].as_array().unwrap();
    assert_eq!(modes.len(), 147);
    for mode in modes {
        assert!(["platform", "cable", "mixed"].contains(&mode["kind"].as_str().unwrap()));
        assert_eq!(numbers(&mode["shape"]).len(), 6);
        let energy =
            number(&mode["platform_energy_fraction"]) + numbers(&mode["cable_energy_fractions"]).iter().sum::<f64>();
        assert!(close(energy, 1.0, 1e-9));
        assert!(number(&mode["damping_ratio"]) <= 0.003 + 1e-12);
    }
    let text = succeed(&["modes", "ROBOT", "--below-hz", "20"]);
    assert!(
        text.contains("Certified: the Wittrick–Williams count below 20 Hz is 147, the list has 147 modes"),
        "{text}"
    );
    assert_eq!(csv(&["modes", "ROBOT", "--below-hz", "20"]).1.len(), 147);
}

#[test]
fn without_a_limit_the_20_lowest_modes_are_shown() {
    for line in [&["modes", "ROBOT"][..], &["modes", &robot("cogiro.toml"), "--pose", "0,0,1.5"]] {
        let found = json(line);
        let limit = number(&found["below_hz"]);
        let modes = found["modes"].as_array().unwrap();
        // The limit is rounded up, so that a neighbour may be below it too.
        assert!(found["certified"] == true && (20..=24).contains(&modes.len()), "{line:?}: {}", modes.len());
        let last = number(&modes[19]["frequency_hz"]);
        assert!(last < limit && limit < 1.11 * last, "{line:?}: {last} {limit}");

        // The limit is printed, and gives the same list.
        let text = succeed(line);
        assert!(text.contains(&format!("below {limit} Hz, the lowest ones; --below-hz sets another")), "{text}");
        let given = json(&[line, &["--below-hz", &limit.to_string()]].concat());
        assert_eq!(given, found);
    }

    // A robot with fewer modes shows all of them.
    let springs = json(&["modes", "ROBOT", "--cable-model", "spring"]);
    let modes = springs["modes"].as_array().unwrap();
    assert!(modes.len() == 6 && number(&springs["below_hz"]) < 1.11 * number(&modes[5]["frequency_hz"]));
}

#[test]
fn modes_take_part_in_a_response_and_move_their_cables() {
    let value =
        json(&["modes", "ROBOT", "--below-hz", "3", "--input", "fz", "--output", "cable:3@0.5:az", "--stations", "5"]);
    assert_eq!(value["damped_certified"], true);
    assert_eq!(value["peak_unit"], "(m/s²)/N");
    let stations = value["stations"].as_array().unwrap();
    assert_eq!(stations.len(), 6);
    let frf = json(&[
        "frf",
        "ROBOT",
        "--from-hz",
        "1.7",
        "--to-hz",
        "2",
        "--points",
        "3001",
        "--input",
        "fz",
        "--output",
        "cable:3@0.5:az",
    ]);
    let peak = frf["peaks"].as_array().unwrap().iter().map(|peak| number(&peak["magnitude"])).fold(0.0, f64::max);
    let mut largest = 0.0_f64;
    for mode in value["modes"].as_array().unwrap() {
        let (zeta, [re, im]) = (number(&mode["damping_ratio"]), [0, 1].map(|i| number(&mode["eigenvalue_per_s"][i])));
        assert!(re < 0.0 && close(zeta, -re / re.hypot(im), 1e-14));
        assert!(number(&mode["modal_mass_kg"]) > 0.0);
        let shapes = mode["cable_shapes"].as_array().unwrap();
        assert!(shapes.len() == 6 && shapes.iter().all(|cable| cable.as_array().unwrap().len() == 5));
        // Anchors are held.
        assert!(shapes.iter().all(|cable| numbers(&cable[4]).iter().all(|u| u.abs() < 1e-9)));
        if (1.7..2.0).contains(&number(&mode["frequency_hz"])) {
            largest = largest.max(number(&mode["peak"]));
        }
    }
    // One mode stands out, and is most of the peak.
    assert!(close(largest, peak, 0.1 * peak), "{largest} {peak}");
}

/// Oracle: the complete list below a high limit.
#[test]
fn the_first_platform_mode_is_the_first_of_the_list_with_the_share() {
    let cogiro = super::robot("cogiro.toml");
    let all = json(&["modes", &cogiro, "--below-hz", "12"]);
    let modes = all["modes"].as_array().unwrap();
    for share in ["0.5", "0.75", "0.97"] {
        let first = modes.iter().position(|mode| number(&mode["platform_energy_fraction"]) >= share.parse().unwrap());
        let found = json(&["modes", &cogiro, "--below-hz", "12", "--platform-share", share]);
        assert_eq!(found["first_platform_mode"]["index"].as_u64().map(|index| index as usize), first, "{share}");
        let Some(first) = first else { continue };
        let expected = number(&modes[first]["frequency_hz"]);
        let text = succeed(&["modes", &cogiro, "--below-hz", "12", "--platform-share", share]);
        assert!(text.contains(&format!("in the platform: {expected:.4} Hz (no. {}", first + 1)), "{text}");

        // A map finds it without a limit.
        let line = ["sweep", &cogiro, "--vary", "platform.mass_kg=160", "--quantity", "first-platform-frequency"];
        let (header, rows) = csv(&[&line[..], &["--platform-share", share]].concat());
        let at = header.iter().position(|column| column == "first_platform_frequency_hz").unwrap();
        let mass = json(&["modes", &cogiro, "--below-hz", "30", "--platform-share", share, "--mass-kg", "160"]);
        let expected = number(&mass["first_platform_mode"]["frequency_hz"]);
        assert!(close(rows[0][at].parse().unwrap(), expected, 1e-9 * expected), "{rows:?} {expected}");
    }
    let text = succeed(&["modes", &cogiro, "--below-hz", "3"]);
    assert!(text.contains("No mode below 3 Hz has at least 50 %") && text.contains("raise --below-hz"), "{text}");
}

#[test]
fn a_platform_on_few_rigid_cables_swings_in_the_motions_that_they_leave_free() {
    for (cables, free) in [(2, 4), (3, 3), (4, 2)] {
        let file = robot(&format!("grab-{cables}-cables.toml"));
        let rigid = ["modes", &file, "--static-model", "ideal", "--rigid-cables", "--below-hz", "10"];
        let found = json(&rigid);
        let modes = found["modes"].as_array().unwrap();
        assert_eq!((modes.len(), &found["cable_model"], &found["certified"]), (free, &"rigid".into(), &true.into()));
        let text = succeed(&rigid);
        assert!(text.contains(&format!("rigid cables leave the platform {free} of its motions below 10 Hz")), "{text}");

        // Stiff springs come near: the difference falls with their compliance.
        let stiff = "materials.rope.axial_stiffness_n=2e7";
        let springs = json(&[
            "modes",
            &file,
            "--static-model",
            "spring",
            "--cable-model",
            "catenary-static",
            "--set",
            stiff,
            "--below-hz",
            "10",
        ]);
        for (rigid, elastic) in modes.iter().zip(springs["modes"].as_array().unwrap()) {
            let [rigid, elastic] = [rigid, elastic].map(|mode| number(&mode["frequency_hz"]));
            assert!(close(rigid / elastic, 1.0, 1e-5), "{rigid} Hz and {elastic} Hz");
        }
    }

    let file = robot("grab-2-cables.toml");
    let figure = tempfile::tempdir().unwrap();
    let path = figure.path().join("shape.svg");
    let shape = ["--rigid-cables", "--static-model", "ideal", "--figure-mode", "1", "-o", path.to_str().unwrap()];
    succeed(&[&["modes", &file, "--below-hz", "10"], &shape[..]].concat());
    assert!(std::fs::read_to_string(&path).unwrap().contains("Mode 1: "));
    for (more, says) in [
        ("", "choose the static model `ideal`"),
        ("--static-model ideal --cable-model spring", "--rigid-cables does not go with --cable-model"),
        ("--static-model ideal --assembly without-geometric-stiffness", "--rigid-cables does not go with --assembly"),
        ("--static-model ideal --in-plane-only", "--rigid-cables does not go with --in-plane-only"),
        ("--static-model ideal --input fz --output az", "--rigid-cables does not go with --input"),
        ("--static-model ideal --stations 5", "--rigid-cables does not go with --stations"),
    ] {
        let options: Vec<&str> = more.split_whitespace().collect();
        let output = run(&[&["modes", &file, "--rigid-cables", "--below-hz", "5"], &options[..]].concat());
        assert!(output.status.code() == Some(2) && stderr(&output).contains(says), "{more}: {}", stderr(&output));
    }
}

/// A second stiffness for vibration: equilibria keep the first, frequencies follow it, also those of sampled robots,
/// and what differentiates vibration says that it does not.
#[test]
fn a_second_stiffness_moves_the_frequencies_and_not_the_equilibrium() {
    let cogiro = robot("cogiro.toml");
    let stiffer = ["--set", "materials.wire-rope-4mm.dynamic_axial_stiffness_n=1.2e6"];
    let with = |line: &[&str]| json(&[line, &stiffer].concat());
    assert_eq!(json(&["statics", &cogiro])["cables"], with(&["statics", &cogiro])["cables"]);

    let modes = ["modes", &cogiro, "--below-hz", "8"];
    let platform = |value: &serde_json::Value| number(&value["first_platform_mode"]["frequency_hz"]);
    let ratio = platform(&with(&modes)) / platform(&json(&modes));
    // 96 % of the stiffness of this mode is stretch: √(1 + 0.96 (1200/820.51 − 1)).
    assert!((ratio - 1.2015).abs() < 3e-3, "{ratio}");

    let of = ["--deviations", "materials.wire-rope-4mm.dynamic_axial_stiffness_n=10%", "--of", "frequencies"];
    let sampled = with(&[&["uncertainty", &cogiro, "--below-hz", "6", "--samples", "40"][..], &of].concat());
    let deviates = |row: &serde_json::Value| row["deviation"].as_f64().is_some_and(|deviation| deviation > 0.1);
    assert!(sampled["poses"][0]["results"].as_array().unwrap().iter().any(deviates), "{sampled}");

    let refused = run(&[&["gradient", &cogiro, "--below-hz", "5"][..], &stiffer].concat());
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("has a second one for vibration"), "{}", stderr(&refused));
}

/// The lowest motion of the platform is split over two modes there, each with less than half of its energy.
#[test]
fn modes_below_the_first_platform_mode_that_move_the_platform_are_named() {
    let cogiro = super::robot("cogiro.toml");
    let line = ["modes", &cogiro, "--pose", "3.2,0,1.5", "--below-hz", "8"];
    let found = json(&line);
    let sharing = found["share_platform"].as_array().unwrap();
    let (first, list) = (&found["first_platform_mode"], found["modes"].as_array().unwrap());
    let expected: Vec<usize> = (0..first["index"].as_u64().unwrap() as usize)
        .filter(|&i| number(&list[i]["platform_energy_fraction"]) >= 0.2)
        .collect();
    let indices: Vec<usize> = sharing.iter().map(|mode| mode["index"].as_u64().unwrap() as usize).collect();
    assert!(indices == expected && indices.len() >= 2, "{indices:?} {expected:?}");
    let text = succeed(&line);
    let [a, b] = [0, 1].map(|i| number(&sharing[i]["frequency_hz"]));
    assert!(
        text.contains(&format!("\n{a:.4}")) && text.contains(&format!("{b:.4} Hz move the platform, too: ")),
        "{text}"
    );

    // Without a first mode below the limit, the modes that move the platform are named as well.
    let none = succeed(&["modes", &cogiro, "--pose", "3.2,0,1.5", "--below-hz", "5.5"]);
    assert!(none.contains("No mode below 5.5 Hz") && none.contains("move the platform, too"), "{none}");
}
