//! `frf`: its table, its peaks, where forces act.

use super::{close, csv, json, number, numbers};

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
