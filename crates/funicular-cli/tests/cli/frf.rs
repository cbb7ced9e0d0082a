//! `frf`: its table, its peaks, where forces act.

use super::{close, csv, json, number, numbers, run, stderr, succeed};
use serde_json::Value;

#[test]
fn a_frequency_response_is_that_of_its_csv_and_finds_the_peaks() {
    let options =
        ["frf", "ROBOT", "--from-hz", "0.1", "--to-hz", "5", "--points", "2000", "--input", "fz", "--output", "ay"];
    let value = json(&options);
    assert_eq!(value["unit"], "(m/s²)/N");
    let (frequency, real) = (numbers(&value["frequency_hz"]), numbers(&value["real"]));
    assert!(frequency.len() == 2000 && real.len() == 2000 && numbers(&value["imag"]).len() == 2000);
    let peaks = value["peaks"].as_array().unwrap();
    assert!(peaks.iter().all(|peak| number(&peak["prominence_db"]) >= 1.0));
    assert!(peaks.iter().any(|peak| close(number(&peak["frequency_hz"]), 1.2672, 5e-3)), "{peaks:?}");
    let (header, rows) = csv(&options);
    assert_eq!(header, ["frequency_hz", "real", "imag", "magnitude", "phase_deg"]);
    let cell = |row: usize, column: usize| rows[row][column].parse::<f64>().unwrap();
    for row in [0, 700, 1999] {
        assert_eq!(cell(row, 0).to_bits(), frequency[row].to_bits(), "every digit");
        assert_eq!(cell(row, 1).to_bits(), real[row].to_bits());
        assert!(close(cell(row, 3), cell(row, 1).hypot(cell(row, 2)), 1e-15));
    }
}

#[test]
fn without_options_the_response_is_vertical_and_contains_the_first_resonances() {
    let found = json(&["frf", "ROBOT"]);
    assert_eq!((&found["input"], &found["output"]), (&Value::from("fz"), &Value::from("az")));
    let hz = numbers(&found["frequency_hz"]);
    let (first, last) = (hz[0], hz[hz.len() - 1]);
    let modes = json(&["modes", "ROBOT"]);
    let platform = number(&modes["first_platform_mode"]["frequency_hz"]);
    assert!(first == 0.0 && last >= number(&modes["below_hz"]) && last >= 1.5 * platform, "{first} {last} {platform}");
    assert!(!found["peaks"].as_array().unwrap().is_empty());

    // The chosen limits are printed, and give the same response.
    let text = succeed(&["frf", "ROBOT"]);
    assert!(text.contains("response of az at") && text.contains("to fz at"), "{text}");
    assert!(text.contains(&format!("frequencies from 0 to {last} Hz, chosen so that every peak")), "{text}");
    let last = last.to_string();
    let given = ["frf", "ROBOT", "--from-hz", "0", "--to-hz", &last, "--input", "fz", "--output", "az", "--adaptive"];
    assert_eq!(json(&given), found);

    let even = numbers(&json(&["frf", "ROBOT", "--log", "--points", "5"])["frequency_hz"]);
    assert!(even.len() == 5 && close(even[4] / even[0], 1000.0, 1e-6), "{even:?}");
}

#[test]
fn a_force_at_a_point_is_a_force_and_a_moment() {
    let frf = |input: &str, output: &str, more: &[&str]| {
        let range =
            ["frf", "ROBOT", "--from-hz", "0.5", "--to-hz", "5", "--points", "5", "--input", input, "--output", output];
        numbers(&json(&[&range, more].concat())["real"])
    };
    let together = frf("fx", "z", &["--input-point-m", "0,0,0"]);
    assert_eq!(frf("fx", "z", &[]), together);
    assert_eq!(frf("f:2,0,0", "x:0,0,3", &[]), together, "directions are unit vectors");
    let (reciprocal, other) = (frf("fz", "x", &[]), frf("mx", "ry", &[]));
    assert!(together.iter().zip(&reciprocal).all(|(a, b)| close(*a, *b, 1e-9 * a.abs())));
    assert!(other.iter().any(|x| *x != 0.0));
    let shifted = frf("fx", "z", &["--output-point-m", "-0.1,0.2,0.3", "--input-point-m", "0.1,0,-0.2"]);
    assert!(shifted.iter().zip(&together).any(|(a, b)| !close(*a, *b, 1e-6 * b.abs())));
}

/// Words of a command line.
fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

/// Frequencies and magnitudes of the first response.
fn magnitudes(response: &Value, frequencies: &Value) -> Vec<(f64, f64)> {
    let (re, im) = (numbers(&response["real"]), numbers(&response["imag"]));
    numbers(frequencies).into_iter().zip(re.iter().zip(&im).map(|(re, im)| re.hypot(*im))).collect()
}

#[test]
fn a_grid_that_misses_peaks_says_how_many_and_which_and_adaptive_frequencies_show_them() {
    let frf = "frf ROBOT --from-hz 0.1 --to-hz 5 --input fz --output az --output-point-m 0.1,0,0";
    let line = format!("{frf} --points 100");
    let coarse = words(&line);
    let chosen = json(&words(&format!("{frf} --adaptive --prominence-db 0")));
    assert!(numbers(&chosen["frequency_hz"]).len() < 600 && chosen["warnings"].as_array().unwrap().is_empty());

    // Peaks that are more than 5 % higher than the frequencies of the grid beside them.
    let grid = json(&coarse);
    let read = magnitudes(&grid, &grid["frequency_hz"]);
    let missed: Vec<(f64, f64, f64)> = (chosen["peaks"].as_array().unwrap().iter())
        .map(|peak| (number(&peak["frequency_hz"]), number(&peak["magnitude"])))
        .map(|(hz, height)| {
            let next = read.partition_point(|(at, _)| *at < hz);
            (hz, height, read[next - 1].1.max(read[next].1))
        })
        .filter(|(_, height, read)| *height > 1.05 * read)
        .collect();
    let worst = missed.iter().max_by(|a, b| (a.1 / a.2).total_cmp(&(b.1 / b.2))).unwrap();
    assert!(missed.len() > 3, "{missed:?}");

    let warning = grid["warnings"][0].as_str().unwrap();
    let starts =
        format!("{} peaks between the frequencies are read more than 5 % too low; the worst has ", missed.len());
    assert!(warning.starts_with(&starts), "{warning}\n{missed:?}");
    assert!(warning.ends_with("is read: give --adaptive, or more frequencies"), "{warning}");
    let told: Vec<f64> = warning.split(' ').skip(10).filter_map(|word| word.parse().ok()).collect();
    let [.., height, hz, read, _] = told[..] else { panic!("{warning}") };
    assert!(close(height / worst.1, 1.0, 1e-3) && close(read / worst.2, 1.0, 1e-3), "{warning}\n{worst:?}");
    assert!(close(hz, worst.0, 1e-5 * hz), "{warning}\n{worst:?}");
    assert!(stderr(&run(&coarse)).contains(warning), "the program says it on stderr too");

    // A fine grid, and frequencies that are too few to be a curve, have no warning.
    for points in ["200000", "5"] {
        let output = run(&words(&format!("{frf} --points {points}")));
        assert!(output.status.success() && stderr(&output).is_empty(), "{}", stderr(&output));
    }
}

#[test]
fn adaptive_frequencies_have_the_values_and_the_ends_of_a_plain_response() {
    let frf = "frf ROBOT --from-hz 0.5 --to-hz 3 --input fx --output x";
    let chosen = json(&words(&format!("{frf} --adaptive --points 11")));
    let plain = json(&words(&format!("{frf} --points 11")));
    let all = magnitudes(&chosen, &chosen["frequency_hz"]);
    for point in magnitudes(&plain, &plain["frequency_hz"]) {
        assert!(all.contains(&point), "{point:?}");
    }
    let text = succeed(&words(&format!("{frf} --adaptive")));
    assert!(text.contains(" Hz, chosen so that every peak has its height; largest magnitude "), "{text}");
    // So it is without a number of frequencies.
    assert_eq!(succeed(&words(frf)), text);
}

#[test]
fn undamped_resonances_are_listed_without_a_height() {
    let frf = "frf ROBOT --from-hz 0.5 --to-hz 10 --input fz --output z --cable-model spring --adaptive";
    let found = json(&words(frf));
    let modes = json(&words("modes ROBOT --below-hz 10 --cable-model spring"));
    let natural: Vec<f64> =
        modes["modes"].as_array().unwrap().iter().map(|mode| number(&mode["frequency_hz"])).collect();
    let undamped = numbers(&found["undamped_hz"]);
    assert!(!undamped.is_empty() && undamped.iter().all(|hz| natural.iter().any(|mode| close(*hz, *mode, 1e-9))));
    assert!(found["peaks"].as_array().unwrap().is_empty());
    assert!(succeed(&words(frf)).contains(" Hz, where the magnitude has no bound."));
}

#[test]
fn several_inputs_and_outputs_are_the_responses_of_each_pair() {
    let range = "--from-hz 0.5 --to-hz 3 --points 31";
    let signals = "--input fx --input fz --output az --output cable:3@0.5:y";
    let several = json(&words(&format!("frf ROBOT {range} {signals}")));
    let responses = several["responses"].as_array().unwrap();
    assert!(several.get("real").is_none() && responses.len() == 4);
    let pairs = [("fx", "az"), ("fz", "az"), ("fx", "cable:3@0.5:y"), ("fz", "cable:3@0.5:y")];
    for (response, (input, output)) in responses.iter().zip(pairs) {
        let one = json(&words(&format!("frf ROBOT {range} --input {input} --output {output}")));
        assert_eq!(several["frequency_hz"], one["frequency_hz"]);
        for key in response.as_object().unwrap().keys() {
            assert_eq!(response[key], one[key], "{key} of {output} to {input}");
        }
    }

    let (header, rows) = csv(&words(&format!("frf ROBOT {range} {signals}")));
    assert_eq!(header, ["input", "output", "frequency_hz", "real", "imag", "magnitude", "phase_deg"]);
    assert!(rows.len() == 4 * 31 && rows[31][..2] == ["fz", "az"]);
    let text = succeed(&words(&format!("frf ROBOT {range} {signals}")));
    for (input, output) in pairs {
        assert!(
            text.contains(&format!("response of {output} at ")) && text.contains(&format!(" to {input} at ")),
            "{text}"
        );
    }

    // The worst of the missed peaks is named with its pair.
    assert!(several["warnings"][0].as_str().unwrap().contains("; the worst, of "), "{}", several["warnings"]);
}
