//! `export --to c` and `--to json`: tables of lengths for firmware, compiled and run where there is a C compiler.

use super::{csv, json, number, numbers, robot, run, run_with, stderr, stdout, succeed};
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Box of a robot, with a name for each case.
struct Case {
    name: &'static str,
    robot: String,
    sides: Vec<(&'static str, f64, f64)>,
    options: Vec<&'static str>,
    tolerance: f64,
}

fn cases() -> Vec<Case> {
    let case = |name, file: &str, sides: &[(&'static str, f64, f64)], options: &[&'static str], tolerance| Case {
        name,
        robot: robot(file),
        sides: sides.to_vec(),
        options: options.to_vec(),
        tolerance,
    };
    let six = |from, to| {
        [
            ("x", -0.5, 0.5),
            ("y", -0.5, 0.5),
            ("z", 1.0, 1.5),
            ("roll", -2.0, 2.0),
            ("pitch", -2.0, 2.0),
            ("yaw", from, to),
        ]
    };
    let point = ["--pose", "1.25,1.25,1.2", "--min-tension-n", "5", "--max-tension-n", "900"];
    vec![
        case("space", "cogiro.toml", &[("x", -3.0, 3.0), ("y", -2.0, 2.0), ("z", 0.5, 2.5)], &[], 1e-4),
        case("planar", "kntu-planar.toml", &[("x", -0.3, 0.3), ("y", -0.3, 0.3), ("yaw", -5.0, 5.0)], &[], 1e-5),
        case("point", "sap2000-8-cable-point-mass.toml", &[("x", 1.15, 1.35), ("z", 1.1, 1.2)], &point, 1e-5),
        case("no choice", "yuan2014-4mm.toml", &[("x", -0.2, 0.2), ("y", -0.2, 0.2)], &["--pose", "0,0,0.5"], 1e-5),
        case("six", "cogiro.toml", &six(-5.0, 5.0), &[], 5e-5),
        case("turned", "cogiro.toml", &six(80.0, 83.0), &[], 5e-4),
        case("pulleys", "cogiro-winches.toml", &[("x", -1.0, 1.0), ("y", -1.0, 1.0), ("z", 1.0, 2.0)], &[], 1e-4),
    ]
}

impl Case {
    /// Export of the case; `more` are further options.
    fn export(&self, to: &str, path: &str, more: &[&str]) -> std::process::Output {
        let tolerance = self.tolerance.to_string();
        let sides: Vec<String> = self.sides.iter().map(|(axis, from, to)| format!("{axis}={from}:{to}")).collect();
        let within = sides.iter().flat_map(|side| ["--within", side.as_str()]);
        let first = ["export", &self.robot, "--to", to, "--tolerance-m", &tolerance, "-o", path];
        let arguments: Vec<&str> = first.into_iter().chain(within).chain(self.options.iter().copied()).collect();
        run(&[&arguments[..], more].concat())
    }

    /// Held-out poses: coordinates of the sides, by a sequence of the test's own.
    fn held_out(&self, count: usize) -> Vec<Vec<f64>> {
        let mut state = 20_140_531_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..count).map(|_| self.sides.iter().map(|(_, from, to)| from + (to - from) * random()).collect()).collect()
    }
}

/// Program that reads poses and prints the result of the self-test, then for each pose flags, lengths and for each
/// cable the largest error of the gradient against differences of lengths.
fn caller(axes: usize) -> String {
    let at = |k: Option<usize>, sign: &str| -> String {
        let each = (0..axes).map(|i| if k == Some(i) { format!("p[{i}] {sign} step") } else { format!("p[{i}]") });
        each.collect::<Vec<_>>().join(", ")
    };
    let shifted = |sign: &str| (0..axes).map(|i| format!("p[{i}] {sign} step")).collect::<Vec<_>>().join(", ");
    let mut differences = String::new();
    for k in 0..axes {
        writeln!(
            differences,
            "      d = g[{k}] - (t_length_m(c, {}) - t_length_m(c, {})) / (2 * step);\n      if (d < 0) d = -d;\n      \
             if (!(d < worst)) worst = d;",
            at(Some(k), "+"),
            at(Some(k), "-")
        )
        .unwrap();
    }
    format!(
        "#include <stdio.h>\n#define T_DECLARATIONS\n#include \"t.c\"\nint main(void) {{\n  double p[T_AXES], \
         l[T_CABLES], g[T_AXES], d, worst = 0, step = 1e-4;\n  int c, k;\n  for (k = 0; k < T_AXES; k++) p[k] = 0;\n  \
         printf(\"%d\\n\", t_self_test());\n  \
         if (t_length_m(-1, {at}) != -1.0 || t_length_m(T_CABLES, {at}) != -1.0) return 1;\n  for (;;) {{\n    \
         for (k = 0; k < T_AXES; k++) if (scanf(\"%lf\", &p[k]) != 1) {{ printf(\"%.3e\\n\", worst); return 0; }}\n    \
         printf(\"%d\", t_lengths_m({at}, l));\n    for (c = 0; c < T_CABLES; c++) \
         {{\n      printf(\" %.17g\", l[c]);\n      if (l[c] != t_length_m(c, {at})) return 2;\n      if \
         (t_outside({above}) || t_outside({below})) continue;\n      if (t_gradient(c, {at}, g)) \
         return 3;\n{differences}    }}\n    printf(\"\\n\");\n  }}\n}}\n",
        at = at(None, ""),
        above = shifted("+"),
        below = shifted("-"),
    )
}

fn compile(folder: &Path, arguments: &[&str]) {
    let compiler = std::env::var("CC").ok().filter(|name| !name.is_empty()).unwrap_or_else(|| "cc".to_owned());
    let output = Command::new(&compiler).args(arguments).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// Compiles `t.c` of a folder as firmware would, with a caller, and runs it at poses: result of the self-test, then the
/// numbers of each line.
fn compiled(folder: &Path, axes: usize, flags: &[&str], poses: &[Vec<f64>]) -> (i32, Vec<Vec<f64>>) {
    let strict = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror"];
    fs::write(folder.join("main.c"), caller(axes)).unwrap();
    compile(folder, &[&strict[..], &["-O2", "-ffreestanding", "-c", "t.c", "-o", "t.o"], flags].concat());
    compile(folder, &[&strict[..], &["-O2", "-c", "main.c", "-o", "main.o"], flags].concat());
    // No library: not even that of mathematics.
    compile(folder, &["t.o", "main.o", "-o", "program"]);
    let lines: Vec<String> =
        poses.iter().map(|pose| pose.iter().map(f64::to_string).collect::<Vec<_>>().join(" ")).collect();
    let input = folder.join("poses.txt");
    fs::write(&input, lines.join("\n") + "\n").unwrap();
    let output = Command::new(folder.join("program")).stdin(fs::File::open(&input).unwrap()).output().unwrap();
    assert!(output.status.success(), "{:?}", output.status);
    let text = String::from_utf8(output.stdout).unwrap();
    let mut rows = text.lines().map(|line| line.split(' ').map(|word| word.parse().unwrap()).collect::<Vec<f64>>());
    (rows.next().unwrap()[0] as i32, rows.collect())
}

/// Unstrained lengths of `statics` at poses of a case.
fn lengths(case: &Case, poses: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("poses.csv");
    let mut base: [f64; 6] = [0.0; 6];
    if let Some(at) = case.options.iter().position(|option| *option == "--pose") {
        for (value, text) in base.iter_mut().zip(case.options[at + 1].split(',')) {
            *value = text.parse().unwrap();
        }
    }
    let axes = ["x", "y", "z", "roll", "pitch", "yaw"];
    let row = |pose: &Vec<f64>| {
        let mut all = base;
        for ((axis, ..), value) in case.sides.iter().zip(pose) {
            all[axes.iter().position(|name| name == axis).unwrap()] = *value;
        }
        all.map(|value| value.to_string()).join(",")
    };
    let rows: Vec<String> = poses.iter().map(row).collect();
    fs::write(&file, "x_m,y_m,z_m,roll_deg,pitch_deg,yaw_deg\n".to_owned() + &rows.join("\n") + "\n").unwrap();
    let rule: &[&str] = if case.name == "no choice" { &[] } else { &["--tension-rule", "centre"] };
    let mut arguments = vec!["map", &case.robot, "--poses", file.to_str().unwrap(), "--quantity", "lengths"];
    arguments.extend(rule);
    let limits = case.options.iter().position(|option| option.starts_with("--m"));
    arguments.extend(limits.map_or(&[][..], |at| &case.options[at..]));
    let (header, rows) = csv(&arguments);
    let columns: Vec<usize> = (0..header.len()).filter(|i| header[*i].starts_with("unstrained_length_")).collect();
    rows.iter().map(|row| columns.iter().map(|i| row[*i].parse().unwrap()).collect()).collect()
}

/// Text between two words.
fn between<'a>(text: &'a str, before: &str, after: &str) -> &'a str {
    text.split_once(before).and_then(|(_, rest)| rest.split_once(after)).unwrap_or_else(|| panic!("{before}")).0
}

#[test]
fn firmware_has_the_lengths_of_statics_in_double_and_in_float() {
    for case in cases() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.c");
        let output = case.export("c", path.to_str().unwrap(), &["--prefix", "t"]);
        assert_eq!(output.status.code(), Some(0), "{}: {}", case.name, stderr(&output));
        let mut poses = case.held_out(200);
        let inside = lengths(&case, &poses);

        // Beyond the first axis the border holds, and the first bit says so; so does a number that is none.
        let (_, from, to) = case.sides[0];
        let mut beyond = vec![poses[0].clone(), poses[0].clone(), poses[0].clone()];
        (beyond[0][0], beyond[1][0], beyond[2][0]) = (to + 1.0, to, f64::NAN);
        poses.extend(beyond);
        for (flags, rounding) in [(&[][..], 0.0), (&["-DT_FLOAT"][..], 1e-6)] {
            let (bad, rows) = compiled(folder.path(), case.sides.len(), flags, &poses);
            assert_eq!(bad, 0, "{}: self-test", case.name);
            let mut worst = 0.0_f64;
            for (row, lengths) in rows.iter().zip(&inside) {
                assert!(row[0] == 0.0, "{}: inside", case.name);
                worst = row[1..].iter().zip(lengths).map(|(a, b)| (a - b).abs()).fold(worst, f64::max);
            }
            println!("{}: {} mm of {} mm", case.name, 1e3 * worst, 1e3 * case.tolerance);
            assert!(worst <= case.tolerance + rounding, "{}: {worst}", case.name);
            let [outside, border, none] = [&rows[200], &rows[201], &rows[202]];
            assert_eq!((outside[0], border[0], none[0]), (1.0, 0.0, 1.0), "{}", case.name);
            assert_eq!(outside[1..], border[1..], "{}: {from} {to}", case.name);
            // A difference over 0.2 mm of lengths up to 16 m, with 24 bits each.
            let gradient = rows[203][0];
            assert!(gradient < if flags.is_empty() { 1e-5 } else { 1e-2 }, "{}: {gradient}", case.name);
        }
    }
}

#[test]
fn a_coefficient_that_changes_by_a_percent_fails_the_self_test() {
    let case = &cases()[0];
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.c");
    let output = case.export("c", path.to_str().unwrap(), &["--prefix", "t"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = fs::read_to_string(&path).unwrap();
    let table = between(&text, "t_coefficients[T_CABLES][T_TERMS] = {", "};");
    let numbers: Vec<&str> =
        table.split(',').map(str::trim).map(|word| word.trim_start_matches(['{', '}', '\n', ' '])).collect();
    let numbers: Vec<&str> = numbers.into_iter().filter(|word| word.parse::<f64>().is_ok()).collect();
    assert!(numbers.len() >= 8 * 10, "{}", numbers.len());
    for k in [0, 1, numbers.len() / 2, numbers.len() - 1] {
        let changed = table.replacen(numbers[k], &format!("{:e}", 1.01 * numbers[k].parse::<f64>().unwrap()), 1);
        assert_ne!(changed, table);
        fs::write(&path, text.replacen(table, &changed, 1)).unwrap();
        let (bad, _) = compiled(folder.path(), 3, &[], &[]);
        assert!((1..=20).contains(&bad), "coefficient {k}: {bad}");
        if k == 0 {
            let (bad, _) = compiled(folder.path(), 3, &["-DT_FLOAT"], &[]);
            assert!((1..=20).contains(&bad), "coefficient {k} in float: {bad}");
        }
    }
}

#[test]
fn the_head_of_a_file_says_what_it_holds_and_json_has_the_same_numbers() {
    let case = &cases()[0];
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    assert!(case.export("c", &at("a.c"), &[]).status.success());
    assert!(case.export("json", &at("a.json"), &[]).status.success());
    let text = fs::read_to_string(at("a.c")).unwrap();
    let found: Value = serde_json::from_str(&fs::read_to_string(at("a.json")).unwrap()).unwrap();
    let head = between(&text, "/*", "*/");
    let checksum = found["robot_file_crc32"].as_str().unwrap();
    for says in [
        checksum,
        "rule of the tensions: centre",
        "0: 1, 100 N to 5000 N",
        "x from -3 to 3 m",
        "Tolerance: 0.100 mm",
        "fixed: roll_deg = 0, pitch_deg = 0, yaw_deg = 0",
        "10 % more axial stiffness EA of all ropes changes lengths by: up to 0.",
        "10 % more mass per length of all ropes changes lengths by: up to 0.",
    ] {
        assert!(head.contains(says), "{says}: {head}");
    }
    assert!(text.contains("double cogiro_length_m(int cable, double x_m, double y_m, double z_m);"));
    assert!(text.lines().all(|line| !line.ends_with(' ')), "no spaces at the ends of lines");

    let bytes: usize = between(head, "coefficients, ", " bytes as float").parse().unwrap();
    assert!(bytes <= 1000, "{bytes}");
    let tested = found["error"]["tested_poses"].as_u64().unwrap();
    assert!(head.contains(&format!("at {tested} poses to which the polynomials were not fitted")), "{head}");
    assert!(number(&found["error"]["largest_m"]) <= 1e-4);

    // The length of the definition in the file, by its words alone.
    let cable = &found["cables"][2];
    let (point, end) = (numbers(&found["self_test"][7]["at"]), numbers(&cable["anchor_m"]));
    let attachment = numbers(&cable["attachment_m"]);
    let straight = (0..3).map(|k| (end[k] - point[k] - attachment[k]).powi(2)).sum::<f64>().sqrt();
    let axes = found["axes"].as_array().unwrap();
    let mut sum = 0.0;
    for (c, degrees) in numbers(&cable["coefficients_m"]).iter().zip(found["exponents"].as_array().unwrap()) {
        let product: f64 = (0..3)
            .map(|k| {
                let [from, to] = ["from", "to"].map(|end| number(&axes[k][end]));
                let t: f64 = (2.0 * point[k] - from - to) / (to - from);
                (number(&degrees[k]) * t.acos()).cos()
            })
            .product();
        sum += c * product;
    }
    let length = numbers(&found["self_test"][7]["length_m"])[2];
    assert!((straight + sum - length).abs() < 1e-12, "{straight} {sum} {length}");
}

#[test]
fn names_of_any_letters_stand_in_comments_and_identifiers() {
    let text = fs::read_to_string(robot("cogiro.toml")).unwrap();
    let text = text
        .replacen("name = \"CoGiRo, LIRMM and Tecnalia, 8 cables\"", r#"name = "4 \"a\" */ /* ??/ \\ Käfig 索""#, 1)
        .replacen("name = \"1\"", r#"name = "*/ int x; /* \\ ??/""#, 1);
    let output = run_with(&["export", "-", "--to", "c", "--within", "x=-1:1", "--pose", "0,0,1.5"], &text);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.c"), stdout(&output)).unwrap();
    compile(folder.path(), &["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-ffreestanding", "-c", "a.c"]);
    assert!(stdout(&output).contains("double robot_4_a_k_fig_length_m(int cable, double x_m);"), "{}", stdout(&output));

    // Two tables in one program, one of them by its declarations first.
    let two = "#define A_FLOAT\n#include \"left.c\"\n#include \"right.c\"\nint main(void) \
        { return a_self_test() + b_self_test(); }\n";
    fs::write(folder.path().join("two.c"), two).unwrap();
    for (prefix, file, side) in [("a", "left.c", "x=-1:0"), ("b", "right.c", "x=0:1")] {
        let path = folder.path().join(file);
        let path = path.to_str().unwrap();
        succeed(&[
            "export",
            &robot("cogiro.toml"),
            "--to",
            "c",
            "--pose",
            "0,0,1.5",
            "--within",
            side,
            "--prefix",
            prefix,
            "-o",
            path,
        ]);
    }
    compile(folder.path(), &["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "two.c", "-o", "two"]);
    assert!(Command::new(folder.path().join("two")).status().unwrap().success());
}

#[test]
fn boxes_and_options_that_give_no_table_are_refused() {
    let cogiro = robot("cogiro.toml");
    let side = |options: &'static str| options.split(' ').collect::<Vec<_>>();
    for (options, code, says) in [
        ("--within x=-3:8 --within y=-2:2 --within z=1", 1, "not wholly feasible: at x = 8 m, y = -2 m"),
        ("--within x=-1:1 --pose 0,0,1 --tension-rule middle", 2, "jumps from pose to pose"),
        ("--within x=-1:1 --pose 0,0,1 --tension-rule stiffest", 2, "take --tension-rule `centre`"),
        ("--within x=-1:1 --pose 0,0,1 --static-model ideal", 2, "leave out --static-model"),
        ("--within x=-1:1 --pose 0,0,1 --tolerance-m 0", 2, "--tolerance-m"),
        ("--within x=-1:1 --pose 0,0,1 --tolerance-m -1", 2, "--tolerance-m"),
        ("--within x=-3:3 --within y=-2:2 --within z=0.5:2.5 --tolerance-m 1e-12", 1, "halve the box along "),
        ("--within x=-1:1 --within y=0", 2, "nothing gives the coordinate z: give it by --within, or give --pose"),
        ("--within x=1 --within y=0 --within z=1", 2, "no coordinate has a range"),
        ("--within x=1:-1 --pose 0,0,1", 2, "give the smaller end first"),
        ("--within x=-1:1 --within x=0:1 --pose 0,0,1", 2, "the axis is given twice"),
        ("--within x=0:1e-9 --pose 0,0,1", 2, "the range is narrower"),
        ("--within yaw=-400:0 --pose 0,0,1", 2, "give angles from -360 to 360 degrees"),
        ("--within w=0:1 --pose 0,0,1", 2, "w"),
        ("--within x=0:1:5 --pose 0,0,1", 2, "a side has two ends"),
        ("--pose 0,0,1", 2, "give --within for each coordinate that moves"),
        ("--within x=-1:1 --pose 0,0,1 --prefix 1a", 2, "--prefix"),
        ("--within x=-1:1 --pose 0,0,1 --prefix a-b", 2, "--prefix"),
        ("--within x=-1:1 --pose 0,0,1 --hold-lengths-of-pose", 2, "leave out --hold-lengths-of-pose"),
        ("--within x=-1:1 --pose 0,0,1 --modes-below-hz 5", 2, "has no modes"),
        ("--within x=-1:1 --pose 0,0,1 --min-tension-n 6000", 2, "is not below its maximum"),
    ] {
        let output = run(&[&["export", &cogiro, "--to", "c"], &side(options)[..]].concat());
        assert_eq!(output.status.code(), Some(code), "{options}: {}", stderr(&output));
        assert!(stderr(&output).contains(says), "{options}: {}", stderr(&output));
        assert_eq!(stdout(&output), "", "{options}");
    }
    for (arguments, says) in [
        (vec!["export", &cogiro, "--to", "vtk", "--within", "x=0:1"], "--within is for tables of lengths, C and JSON"),
        (vec!["export", &cogiro, "--to", "json", "--within", "x=0:1", "--prefix", "a"], "--prefix is for names in C"),
        (vec!["export", &cogiro, "--to", "c", "--within", "x=0:1", "-o", "a.py"], "choose a name that ends in .c"),
    ] {
        let output = run(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(says), "{arguments:?}: {}", stderr(&output));
    }

    // A planar platform stays in its plane, a point mass does not turn, and without a maximum the rule is `lowest`.
    let planar = robot("kntu-planar.toml");
    let output = run(&["export", &planar, "--to", "c", "--within", "z=0:1"]);
    assert!(
        output.status.code() == Some(2) && stderr(&output).contains("does not move along it"),
        "{}",
        stderr(&output)
    );
    let point = robot("sap2000-8-cable-point-mass.toml");
    let output = run(&["export", &point, "--to", "c", "--pose", "1.25,1.25,1.2", "--within", "yaw=0:1"]);
    assert!(
        output.status.code() == Some(2) && stderr(&output).contains("does not move along it"),
        "{}",
        stderr(&output)
    );
    let output = run(&["export", &point, "--to", "json", "--pose", "1.25,1.25,1.2", "--within", "x=1.2:1.3"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("has no maximum tension"), "{}", stderr(&output));
    let found: Value = serde_json::from_str(stdout(&output)).unwrap();
    assert_eq!(found["tension_rule"], "lowest");
    let state = json(&["statics", &point, "--pose", "1.26,1.25,1.2", "--tension-rule", "lowest"]);
    assert!(number(&state["cables"][0]["unstrained_length_m"]) > 0.0);
}
