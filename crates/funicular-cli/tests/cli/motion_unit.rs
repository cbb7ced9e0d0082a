//! Units of the robot in motion for co-simulation.

use crate::{robot, stderr};
use std::path::Path;
use std::process::{Command, Output};

fn export(robot: &str, arguments: &[&str], variables: &[(&str, &str)]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_funicular"));
    command.args(["export", robot]).args(arguments).envs(variables.iter().copied()).output().unwrap()
}

/// The C library that tests of the whole workspace build beside the program.
fn has_c_library() -> bool {
    let folder = Path::new(env!("CARGO_BIN_EXE_funicular")).parent().unwrap();
    [folder.to_owned(), folder.join("deps")].iter().any(|folder| folder.join("libfunicular_c.a").is_file())
}

fn text(archive: &mut zip::ZipArchive<std::fs::File>, name: &str) -> String {
    std::io::read_to_string(archive.by_name(name).unwrap()).unwrap()
}

#[test]
fn units_of_both_versions_have_names_units_and_feedthrough_of_the_robot() {
    let (folder, robot) = (tempfile::tempdir().unwrap(), robot("kntu-planar.toml"));
    for (form, version) in [("fmu", "2.0"), ("fmu3", "3.0")] {
        let path = folder.path().join(format!("{form}.fmu"));
        let given = ["--to", form, "--set", "platform.mass_kg=2.5", "-o", path.to_str().unwrap()];
        let output = export(&robot, &given, &[]);
        if !has_c_library() {
            assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
            assert!(stderr(&output).contains("libfunicular_c.a"), "{}", stderr(&output));
            continue;
        }
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));

        let mut archive = zip::ZipArchive::new(std::fs::File::open(&path).unwrap()).unwrap();
        let description = text(&mut archive, "modelDescription.xml");
        let document = roxmltree::Document::parse(&description).unwrap();
        assert_eq!(document.root_element().attribute("fmiVersion"), Some(version));
        let find = |name: &str| {
            let mut nodes = document.descendants();
            let node = nodes.find(|node| node.attribute("name") == Some(name) && node.has_attribute("valueReference"));
            node.unwrap_or_else(|| panic!("{name}: {description}"))
        };
        let unit = |name: &str| {
            let node = find(name);
            node.attribute("unit").or_else(|| node.first_element_child()?.attribute("unit")).map(str::to_owned)
        };
        for (name, causality, has) in [
            ("length_1_m", "input", "m"),
            ("length_rate_1_m_s", "input", "m/s"),
            ("force_x_n", "input", "N"),
            ("moment_z_n_m", "input", "N.m"),
            ("x_m", "output", "m"),
            ("quaternion_w", "output", "1"),
            ("tension_platform_1_n", "output", "N"),
            ("energy_defect_j", "output", "J"),
        ] {
            assert_eq!(find(name).attribute("causality"), Some(causality), "{name}");
            assert_eq!(unit(name).as_deref(), Some(has), "{name}");
        }
        let depends = |name: &str| {
            let reference: usize = find(name).attribute("valueReference").unwrap().parse().unwrap();
            let (tag, key, number) = if form == "fmu" {
                ("Unknown", "index", reference + 1)
            } else {
                ("Output", "valueReference", reference)
            };
            let number = number.to_string();
            let mut nodes = document.descendants();
            let node = nodes.find(|node| node.has_tag_name(tag) && node.attribute(key) == Some(&number)).unwrap();
            node.attribute("dependencies") != Some("")
        };
        assert!(!depends("x_m") && !depends("velocity_x_m_s") && !depends("unstrained_length_1_m"));
        assert!(depends("acceleration_x_m_s2") && depends("tension_platform_1_n"));
        assert!(text(&mut archive, "resources/robot.toml").contains("mass_kg = 2.5"));
        assert_eq!(archive.file_names().filter(|name| name.starts_with("binaries/")).count(), 1);
    }
}

#[test]
fn a_unit_that_cannot_be_made_is_refused_and_no_file_is_written() {
    let (folder, robot) = (tempfile::tempdir().unwrap(), robot("kntu-planar.toml"));
    let path = folder.path().join("robot.fmu");
    let to = ["--to", "fmu", "-o", path.to_str().unwrap()];
    let absent = [("FUNICULAR_C_LIBRARY", "/absent/library.a")];
    for (more, variables, says) in [
        (vec!["--force-n=1,0,0"], &absent[..], "leave out --force-n"),
        (vec!["--tolerance-m=5"], &absent[..], "--tolerance-m is 5 m"),
        (vec!["--within=x=0:1"], &absent[..], "--within"),
        (vec![], &absent[..], "/absent/library.a"),
    ] {
        let output = export(&robot, &[&to[..], &more].concat(), variables);
        assert_eq!(output.status.code(), Some(2), "{more:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(says), "{more:?}: {}", stderr(&output));
        assert!(!path.exists(), "{more:?}");
    }
    let output = export(&robot, &["--to", "fmu", "-o", "robot.vtp"], &[]);
    assert!(output.status.code() == Some(2) && stderr(&output).contains(".fmu"), "{}", stderr(&output));
}
