//! Universal Files of other programs: units, functions that tell too little, functions of other quantities, sizes of
//! binary data. The file has a response of a frame on eight ropes with a platform of 13 kg; the robot file says 12 kg.

use crate::{number, project, run, stderr};
use serde_json::Value;

const FOLDER: &str = "crates/funicular-cli/tests/cli/identify";

/// Text of the response in SI units, and its numbers in the frequencies of dataset 58.
fn frame() -> String {
    std::fs::read_to_string(project(&format!("{FOLDER}/frame.uff"))).unwrap()
}

/// The response with ordinates multiplied by a factor.
fn scaled(text: &str, factor: f64) -> String {
    let is_number = |field: &str| field.contains('E') && field.trim().parse::<f64>().is_ok();
    let is_data = |line: &str| line.len().is_multiple_of(40) && line.get(..20).is_some_and(is_number);
    let scaled = |line: &str| -> String {
        let fields = (0..line.len() / 20).map(|i| line[20 * i..20 * i + 20].trim().parse::<f64>().unwrap());
        fields.map(|number| format!("{:>20.12e}", number * factor)).collect::<Vec<_>>().concat()
    };
    let line = |line: &str| if is_data(line) { scaled(line) } else { line.to_owned() };
    text.lines().map(line).collect::<Vec<_>>().join("\n") + "\n"
}

/// Message, and identified mass if there is one.
fn identified(bytes: &[u8], more: &[&str]) -> (String, Option<f64>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("test.uff");
    std::fs::write(&path, bytes).unwrap();
    let robot = project(&format!("{FOLDER}/frame.toml"));
    let fixed = ["--hold-lengths-of-pose", "--fit", "platform.mass_kg", "--starts", "1", "--format", "json"];
    let path = path.to_str().unwrap();
    let output = run(&[&["identify", &robot, "--measured", path], &fixed[..], more].concat());
    let message = stderr(&output).to_owned();
    match output.status.code() {
        Some(0) => {
            let found: Value = serde_json::from_slice(&output.stdout).unwrap();
            (message, Some(number(&found["values"][0]["value"])))
        }
        code => {
            assert_eq!(code, Some(2), "{message}");
            (message, None)
        }
    }
}

/// Asserts that the response of a file gives the mass. The measured numbers have 13 digits.
fn gives_the_mass(bytes: &[u8], more: &[&str], says: &str) {
    let (message, mass) = identified(bytes, more);
    assert!(mass.is_some_and(|mass| (mass - 13.0).abs() < 1e-3), "{mass:?} {message}");
    assert!(message.contains(says), "{message}");
}

#[test]
fn units_are_converted_or_refused() {
    let text = frame();
    gives_the_mass(text.as_bytes(), &[], "");
    for (from, to, factor) in [
        ("m/s^2               ", "g's                 ", 1.0 / 9.806_65),
        ("N                   ", "mN                  ", 1e-3),
        ("m/s^2               ", "(m/s^2)/kN          ", 1e3),
    ] {
        let label = to.trim();
        let changed = scaled(&text.replacen(&format!(" {from}"), &format!(" {to}"), 1), factor);
        let changed = if label.contains("/kN") {
            changed.replace("Force                N ", "NONE                   ")
        } else {
            changed
        };
        gives_the_mass(changed.as_bytes(), &[], &format!("1 function: the unit `{label}` is converted"));
        // Dataset 164 in SI units does not make it another unit; one in millimetres contradicts it.
        let units = |factor: &str| {
            format!(
                "    -1\n   164\n{:10}{:>20}{:10}\n{factor:>25}{:>25}{:>25}\n{:>25}\n    -1\n",
                1, "SI", 2, "1.0", "1.0", "273.15"
            )
        };
        gives_the_mass((units("1.0") + &changed).as_bytes(), &[], "is converted");
        if !label.contains('N') {
            let (message, mass) = identified((units("1.0D+03") + &changed).as_bytes(), &[]);
            assert!(mass.is_none() && message.contains("(dataset 164) it is 0.001"), "{message}");
        }
    }

    // Abscissae: 2 Hz to 22 Hz in rad/s, kHz and cycles per minute.
    let form = "2.00000E+00  2.50000E-01";
    for (label, form_of_label) in [
        ("rad/s", format!("{:>11.5e}  {:>11.5e}", std::f64::consts::TAU * 2.0, std::f64::consts::TAU / 4.0)),
        ("kHz", "2.00000E-03  2.50000E-04".to_owned()),
        ("1/min", "1.20000E+02  1.50000E+01".to_owned()),
    ] {
        let of_label = form_of_label.clone();
        let padded = format!("{of_label:<24}");
        let changed = text.replacen("Hz   ", &format!("{label:<5}"), 1).replacen(form, &padded, 1);
        let (message, mass) = identified(changed.as_bytes(), &[]);
        // Six digits of 2π.
        assert!(mass.is_some_and(|mass| (mass - 13.0).abs() < 0.01), "{label} {mass:?} {message}");
        assert!(message.contains(&format!("the unit `{label}` of the abscissae is converted")), "{message}");
    }

    for (from, to, says) in [
        ("m/s^2 ", "V     ", "the unit `V` of its ordinates, which is no known unit of az"),
        ("m/s^2 ", "mm    ", "the unit `mm` of its ordinates, which is no known unit of az"),
        ("N     ", "kg    ", "the unit `kg` of its denominator, which is no known unit of fz"),
        ("Hz    ", "orders", "abscissae in the unit `orders`"),
        ("m/s^2 ", "g/kN  ", "contradict each other"),
    ] {
        let (message, mass) = identified(text.replacen(from, to, 1).as_bytes(), &[]);
        assert!(mass.is_none() && message.contains(says), "{message}");
    }
}

#[test]
fn signals_that_a_function_does_not_tell_are_given_or_follow_from_its_unit() {
    let text = frame();
    let without_type = text
        .replace(
            "        12    0    0    0 Acceleration         m/s^2 ",
            "         0    0    0    0 NONE                 NONE  ",
        )
        .replace(
            "        13    0    0    0 Force                N   ",
            "         0    0    0    0 NONE                 NONE",
        );
    let without_direction = text.replace("NONE               1   3", "NONE               1   0");
    for changed in [&without_type, &without_direction] {
        assert_ne!(*changed, text);
        let (message, mass) = identified(changed.as_bytes(), &[]);
        assert!(mass.is_none() && message.contains("as in --response \"line 7=az/fz\""), "{message}");
        for name in ["line 7", "response", "az at node 1", "az at node 1 / fz at node 1"] {
            gives_the_mass(changed.as_bytes(), &["--response", &format!("{name}=az/fz")], "");
        }
        let other = ["--response", "az at node 2=az/fz"];
        let (message, mass) = identified(changed.as_bytes(), &other);
        assert!(mass.is_none() && message.contains("line 7=az/fz"), "{message}");
    }

    let by_label = text
        .replace(
            "12    0    0    0 Acceleration         m/s^2        ",
            " 1    0    0    0 Frequency Function   (1/N)*(m/s^2)",
        )
        .replace(
            "        13    0    0    0 Force                N   ",
            "         0    0    0    0 NONE                 NONE",
        );
    gives_the_mass(by_label.as_bytes(), &[], "taken as az by the unit `(1/N)*(m/s^2)`");
}

#[test]
fn functions_of_other_quantities_are_left_out_beside_good_ones() {
    let text = frame();
    let at = text.find("    -1\n    58").unwrap();
    let function = &text[at..];
    for (changed, says) in [
        (
            function.replace(
                "        12    0    0    0 Acceleration         m/s^2",
                "        15    0    0    0 Sound pressure       Pa   ",
            ),
            "has ordinates of data type 15",
        ),
        (function.replace("        13    0", "        12    0"), "is a response per data type 12"),
        (function.replacen("NONE               1   3", "NONE              99   3", 1), "is at node 99"),
        (
            function.replacen("NONE               1   3", "NONE               1   0", 1),
            "has no direction of its response",
        ),
    ] {
        assert_ne!(changed, function);
        for both in [format!("{text}{changed}"), format!("{}{changed}{function}", &text[..at])] {
            gives_the_mass(both.as_bytes(), &[], says);
        }
        let (message, mass) = identified(format!("{}{changed}", &text[..at]).as_bytes(), &[]);
        assert!(mass.is_none() && message.contains(says), "{message}");
        let (message, _) = identified(format!("{text}{changed}{changed}").as_bytes(), &[]);
        assert!(message.contains("is left out, as is another one: it "), "{message}");
    }
}

#[test]
fn the_size_of_binary_data_follows_from_the_number_of_points() {
    let text = frame();
    let at = text.find("    58\n").unwrap();
    let head: Vec<&str> = text[at..].lines().take(12).collect();
    let first_data = text.find(head[11]).unwrap() + head[11].len() + 1;
    let data = &text[first_data..];
    let numbers = data.lines().take_while(|line| line.trim() != "-1").flat_map(|line| {
        (0..line.len() / 20).map(|i| line[20 * i..20 * i + 20].trim().parse::<f64>().unwrap()).collect::<Vec<_>>()
    });
    let body: Vec<u8> = numbers.flat_map(f64::to_le_bytes).collect();
    assert_eq!(body.len(), 81 * 16);
    // `pyuff` writes eight bytes per point for complex numbers.
    for count in [81 * 16, 81 * 8, 0, 1_000_000] {
        let kind = format!("    58b{:6}{:6}{:12}{count:12}{:6}{:6}{:12}{:12}", 1, 2, 11, 0, 0, 0, 0);
        let mut bytes = text.as_bytes()[..at].to_vec();
        bytes.extend(format!("{kind}\n{}\n", head[1..].join("\n")).into_bytes());
        bytes.extend(&body);
        bytes.extend(b"\n    -1\n");
        gives_the_mass(&bytes, &[], "");
        bytes.truncate(bytes.len() - 30);
        let (message, mass) = identified(&bytes, &[]);
        assert!(mass.is_none() && message.contains("test.uff: line "), "{message}");
    }
}
