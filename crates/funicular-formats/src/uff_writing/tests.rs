//! Readers and writers of measurements: every form of a Universal File, damaged files, tables.

use super::{frf_file, modes_file};
use crate::measurements::uff::UffFile;
use crate::measurements::*;
use funicular::math::Complex;
use funicular_study::request::Request;
use funicular_study::{Results, Silent};
use std::fmt::Write as _;

/// Ordinates of the test files; the imaginary parts of real files are left out. All are exact as single numbers.
const VALUES: [(f64, f64, f64); 5] =
    [(0.5, 1.5, -0.25), (0.75, -2048.0, 0.125), (1.0, 0.0, 0.0), (1.25, -0.0625, 3.0), (1.5, 1e-3, -4096.0)];

/// Form of a file to write by hand.
#[derive(Clone, Copy)]
struct Written {
    ordinates: usize,
    is_even: bool,
    /// Byte order of a binary body; `None` for text.
    binary: Option<bool>,
    /// Uneven abscissae of double ordinates as double numbers, too.
    wide_abscissae: bool,
}

impl Written {
    fn is_complex(self) -> bool {
        self.ordinates >= 5
    }

    fn is_double(self) -> bool {
        matches!(self.ordinates, 4 | 6)
    }

    fn numbers(self) -> Vec<Vec<f64>> {
        let point = |(x, re, im): &(f64, f64, f64)| {
            let mut numbers = if self.is_even { vec![] } else { vec![*x] };
            numbers.push(*re);
            if self.is_complex() {
                numbers.push(*im);
            }
            numbers
        };
        VALUES.iter().map(point).collect()
    }

    fn body(self) -> Vec<u8> {
        let mut out = Vec::new();
        let Some(little) = self.binary else {
            let wide = |i: usize| self.is_double() && (self.is_even || i > 0);
            let per_line = match (self.is_double(), self.is_even, self.is_complex()) {
                (false, ..) => 6,
                (true, false, true) => 3,
                (true, ..) => 4,
            };

            let mut count = 0;

            for point in self.numbers() {
                for (i, number) in point.iter().enumerate() {
                    let text = if wide(i) { format!("{number:>20.12e}") } else { format!("{number:>13.5e}") };
                    out.extend(text.bytes());
                    count += 1;

                    if count % per_line == 0 {
                        out.push(b'\n');
                    }
                }
            }
            if count % per_line != 0 {
                out.push(b'\n');
            }
            return out;
        };

        for point in self.numbers() {
            for (i, number) in point.iter().enumerate() {
                let is_abscissa = !self.is_even && i == 0;
                if self.is_double() && (!is_abscissa || self.wide_abscissae) {
                    out.extend(if little { number.to_le_bytes() } else { number.to_be_bytes() });
                } else {
                    let single = *number as f32;
                    out.extend(if little { single.to_le_bytes() } else { single.to_be_bytes() });
                }
            }
        }
        out
    }

    fn file(self) -> Vec<u8> {
        let body = self.body();
        let kind = match self.binary {
            None => "    58".to_owned(),
            Some(little) => format!(
                "    58b{:6}{:6}{:12}{:12}{:6}{:6}{:12}{:12}",
                if little { 1 } else { 2 },
                2,
                11,
                body.len(),
                0,
                0,
                0,
                0
            ),
        };

        let mut out = format!(
            "    -1\n   151\nsome model\nx\n    -1\n    -1\n{kind}\ntest\na\nb\nc\nd\n{:5}{:10}{:5}{:10} \
             {:10}{:10}{:4} {:10}{:10}{:4}\n\
             {:10}{:10}{:10}{:13.5e}{:13.5e}{:13.5e}\n",
            4,
            0,
            1,
            0,
            "NONE",
            7,
            -2,
            "NONE",
            3,
            3,
            self.ordinates,
            VALUES.len(),
            u8::from(self.is_even),
            0.5,
            0.25,
            0.0
        );

        for (kind, unit) in [(18, "Hz"), (12, "m/s^2"), (13, "N"), (0, "NONE")] {
            writeln!(out, "{kind:10}{:5}{:5}{:5} {:20} {unit:20}", 0, 0, 0, "label").unwrap();
        }

        let mut out = out.into_bytes();
        out.extend(body);
        out.extend(b"    -1\n");
        out
    }

    fn all() -> Vec<Self> {
        let mut all = Vec::new();
        for ordinates in [2, 4, 5, 6] {
            for is_even in [true, false] {
                for binary in [None, Some(true), Some(false)] {
                    for wide_abscissae in [false, true] {
                        all.push(Self { ordinates, is_even, binary, wide_abscissae });
                    }
                }
            }
        }
        all
    }
}

#[test]
fn every_form_of_a_function_is_read() {
    for form in Written::all() {
        let file = UffFile::read("a.uff", &form.file()).unwrap();
        assert_eq!(file.model.as_deref(), Some("some model"));
        let [function] = &file.functions[..] else { panic!("one function") };
        assert_eq!((function.response.node, function.response.direction), (7, -2));
        assert_eq!(function.abscissae, VALUES.map(|value| value.0));
        assert_eq!(function.is_complex, form.is_complex());
        let values = VALUES.map(|(_, re, im)| Complex::new(re, if form.is_complex() { im } else { 0.0 }));
        let single = |value: &Complex| Complex::new(f64::from(value.re as f32), f64::from(value.im as f32));
        let expected: Vec<Complex> = if form.is_double() || form.binary.is_none() {
            values.to_vec()
        } else {
            values.iter().map(single).collect()
        };
        assert_eq!(function.values, expected);
    }
}

#[test]
fn binary_data_may_contain_the_closing_line() {
    let form = Written { ordinates: 6, is_even: true, binary: Some(true), wide_abscissae: false };
    let mut bytes = form.file();
    let text = b"\n    -1\n    -1\n ";
    let at = bytes.len() - 7 - 80;
    bytes[at..at + 16].copy_from_slice(text);
    let file = UffFile::read("a.uff", &bytes).unwrap();
    assert_eq!(file.functions[0].values[4], Complex::new(1e-3, -4096.0));
}

#[test]
fn damaged_files_are_errors_and_never_panics() {
    // Linear congruential generator of Knuth's MMIX.
    let mut state = 1_u64;
    let mut random = move |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };

    for form in Written::all() {
        let whole = form.file();
        for end in 0..whole.len() {
            let cut = UffFile::read("a.uff", &whole[..end]);
            // A file cut off behind the header is complete in itself, and has no function.
            assert!(cut.is_err() || cut.unwrap().functions.len() <= 1, "{end}");
        }

        for _ in 0..2000 {
            let mut bytes = whole.clone();
            for _ in 0..=random(4) {
                let at = random(bytes.len());
                bytes[at] = random(256) as u8;
            }

            if let Ok(file) = UffFile::read("a.uff", &bytes) {
                let nodes = [3, 7].map(|node| NodePoint { node, point_m: [0.0; 3] });
                let _ = responses_of_uff("a.uff", &file, &nodes, &[]);
            }
        }
    }

    // Counts that no memory holds.
    let form = Written { ordinates: 6, is_even: true, binary: None, wide_abscissae: false };
    let huge = String::from_utf8(form.file()).unwrap().replace("         6         5", "         6 999999999");
    let error = UffFile::read("a.uff", huge.as_bytes()).unwrap_err();
    assert!(format!("{error:#}").contains("of its 1999999998 numbers"), "{error:#}");
}

#[test]
fn messages_name_the_line() {
    let text =
        String::from_utf8(Written { ordinates: 6, is_even: true, binary: None, wide_abscissae: false }.file()).unwrap();
    for (from, to, says) in [
        ("         6         5", "         3         5", "line 14: ordinates of type 3"),
        ("         6         5", "         6         9", "dataset 58 ends after 10 of its 18 numbers"),
        ("         6         5", "         6         2", "dataset 58 goes on after its last point"),
        ("-2.048", "-2.o48", "is not a number"),
        ("    -1", "    -2", "no Universal File"),
    ] {
        let error = UffFile::read("a.uff", text.replace(from, to).as_bytes()).unwrap_err();
        assert!(format!("{error:#}").contains(says), "{error:#}");
    }
}

#[test]
fn responses_have_signs_points_and_si_units() {
    let form = Written { ordinates: 6, is_even: true, binary: None, wide_abscissae: false };
    let text = String::from_utf8(form.file()).unwrap();
    let file = UffFile::read("a.uff", text.as_bytes()).unwrap();
    let error = responses_of_uff("a.uff", &file, &[], &[]).unwrap_err().to_string();
    assert_eq!(
        error,
        "a.uff: the function in line 8 is at node 3, whose place on the platform is unknown: give ⟪node⟫ 3=x,y,z in \
         the platform frame [m]"
    );

    // Node 7 in dataset 15 in millimetres, node 3 by the option; millimetres and kilonewtons.
    let with_units = text
        .replace("m/s^2", "mm/s^2")
        .replace(" N   ", " kN  ")
        .replacen(
            "    -1\n   151",
            "    -1\n   164\n         9USER                          2\n 1.0D+03 1.0D-03\n    -1\n    -1\n    15\n\
             \x20        7         0\
             \x20        0         1  1.00000E+02  8.00000E+01  2.00000E+01\n    -1\n    -1\n   151",
            1,
        )
        .replace(" 1.0D+03 1.0D-03", &format!("{:>25}{:>25}{:>25}", "1.0D+03", "1.0D-03", "1.0D+00"));
    let file = UffFile::read("a.uff", with_units.as_bytes()).unwrap();
    let node = NodePoint { node: 3, point_m: [0.3, 0.0, 0.0] };
    let (responses, notes) = responses_of_uff("a.uff", &file, &[node], &[]).unwrap();
    let converted = ["kN", "mm/s^2"].map(|unit| format!("the unit `{unit}` is converted"));
    assert!(notes.len() == 2 && notes.iter().zip(&converted).all(|(note, text)| note.contains(text)), "{notes:?}");
    let [one] = &responses[..] else { panic!("one response") };
    assert_eq!((one.input.as_str(), one.output.as_str()), ("fz", "ay"));
    assert_eq!((one.input_point_m, one.output_point_m), (Some([0.3, 0.0, 0.0]), Some([0.1, 0.08, 0.02])));
    // 1.5 mm/s² per kN, along −y.
    assert!((one.real[0] + 1.5e-6).abs() < 1e-20 && (one.imag[0] - 0.25e-6).abs() < 1e-20);

    // A label that the factors contradict.
    let other = String::from_utf8_lossy(with_units.as_bytes()).replace("mm/s^2", "cm/s^2");
    let error =
        responses_of_uff("a.uff", &UffFile::read("a.uff", other.as_bytes()).unwrap(), &[node], &[]).unwrap_err();
    assert!(error.to_string().contains("but by the factors of the file (dataset 164) it is 0.001"), "{error}");
}

/// Results of a request on the robot of the paper.
fn results(request: serde_json::Value) -> Results {
    let mut request = request;
    request["robot"] = serde_json::json!({"text": funicular_robots::YUAN2014_4MM});
    funicular_study::run(&Request::from_json(&request.to_string()).unwrap(), &mut Silent).unwrap()
}

#[test]
fn written_responses_are_read_with_their_digits() {
    for log in [false, true] {
        let Results::Frf(found) = results(serde_json::json!({
            "command": "frf", "from_hz": 0.5, "to_hz": 3.0, "points": 26, "log": log,
            "input": ["fz", "mx"], "output": ["ay", "x:0,0,-1", "arz"], "output_point_m": null,
            "input_point_m": null,
        })) else {
            panic!("frf was requested")
        };

        let file = UffFile::read("a.uff", &frf_file(&found).unwrap()).unwrap();
        let (responses, _) = responses_of_uff("a.uff", &file, &[], &[]).unwrap();
        assert_eq!(responses.len(), 6);

        for (read, pair) in responses.iter().zip(&found.responses) {
            assert_eq!(read.input, pair.input);
            let sign = if pair.output == "x:0,0,-1" { -1.0 } else { 1.0 };
            assert_eq!(read.output, if sign < 0.0 { "z" } else { &pair.output });

            for k in 0..26 {
                let size = pair.real[k].hypot(pair.imag[k]);
                assert!((read.real[k] * sign - pair.real[k]).abs() <= 1e-12 * size);
                assert!((read.imag[k] * sign - pair.imag[k]).abs() <= 1e-12 * size);
                assert!((read.frequency_hz[k] / found.frequency_hz[k] - 1.0).abs() <= 1e-5);
            }
        }
    }
}

#[test]
fn written_mode_shapes_are_read_again() {
    let Results::Modes(found) = results(serde_json::json!({"command": "modes", "below_hz": 3.0})) else {
        panic!("modes were requested")
    };
    let file = UffFile::read("a.uff", &modes_file(&found)).unwrap();
    assert_eq!(file.shapes.len(), found.modes.len());
    for (shape, mode) in file.shapes.iter().zip(&found.modes) {
        assert!((shape.frequency_hz / mode.frequency_hz - 1.0).abs() < 1e-5);
        assert!((shape.damping_ratio / mode.damping_ratio - 1.0).abs() < 1e-5);
        // The motion of the attachments is that of a rigid body.
        let vector = |node: i64, from: usize| funicular::math::Vec3::from_fn(|i, _| shape.values[&node][from + i].re);
        for (node, place) in file.nodes.iter().skip(1) {
            let rigid = vector(1, 0) + vector(1, 3).cross(&funicular::math::Vec3::from(*place));
            assert!((vector(*node, 0) - rigid).norm() < 2e-5, "five decimals");
        }
    }
}

#[test]
fn signals_beside_the_platform_are_refused() {
    let Results::Frf(found) = results(serde_json::json!({
        "command": "frf", "from_hz": 1.0, "to_hz": 2.0, "points": 2, "input": "f:1,0,1", "output": "cable:3@0.5:az",
    })) else {
        panic!("frf was requested")
    };
    assert!(frf_file(&found).unwrap_err().to_string().starts_with("cable:3@0.5:az is not on the platform"));
}

#[test]
fn tables_are_read_in_both_forms() {
    let names = ["a", "b"].map(|name| ResponseName { name: name.into(), input: "fz".into(), output: "az".into() });
    let table = "# by hand\nfrequency_hz,a_re,a_im,a_std,b_abs,b_phase_deg\n1,2,3,0.1,2,90\n2,4,5,0.2,1,-180\n";
    let Ok(CsvContent::Responses(found)) = read_csv("a.csv", table.as_bytes(), &names, [None, Some([0.1, 0.0, 0.0])])
    else {
        panic!("responses")
    };
    assert_eq!((found[0].real[1], found[0].imag[0], found[0].std.as_ref().unwrap()[1]), (4.0, 3.0, 0.2));
    assert!((found[1].imag[0] - 2.0).abs() < 1e-15 && found[1].std.is_none());
    assert_eq!(found[1].output_point_m, Some([0.1, 0.0, 0.0]));

    let list = "frequency_hz,damping_ratio,std_hz,label\n1.5,0.01,,2\n2.5,,0.1,swing\n";
    let Ok(CsvContent::Frequencies(found)) = read_csv("a.csv", list.as_bytes(), &[], [None; 2]) else {
        panic!("a list")
    };
    assert_eq!((found[0].number(), found[1].number()), (Some(2), None));
    assert_eq!((found[0].damping_ratio, found[1].std_hz), (Some(0.01), Some(0.1)));

    for (text, says) in [
        ("f,a_re\n1,2\n", "has no column `frequency_hz`"),
        ("frequency_hz,a_re\n1,2\n", "needs the columns `a_re` and `a_im`"),
        ("frequency_hz,c_re,c_im\n1,2,3\n", "give ⟪response⟫ c=OUTPUT/INPUT"),
        ("frequency_hz,a_re,a_im,x\n1,2,3,4\n", "a column `x`: columns of responses end in _re"),
        ("frequency_hz,a_re,a_im\n1,2\n", "line 2: 2 values, but 3 in the header"),
        ("frequency_hz,a_re,a_im\n1,2,x\n", "line 2, column `a_im`: `x` is not a number"),
        ("frequency_hz,frequency_hz\n1,2\n", "twice"),
        ("frequency_hz,mode\n1,2\n", "a column `mode`: a list of natural frequencies has"),
        ("frequency_hz\n", "a header and no values"),
        ("frequency_hz,weight\n,1\n", "line 2: the frequency is missing"),
    ] {
        let error = read_csv("a.csv", text.as_bytes(), &names, [None; 2]).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
    for end in 0..table.len() {
        let _ = read_csv("a.csv", &table.as_bytes()[..end], &names, [None; 2]);
    }
}
