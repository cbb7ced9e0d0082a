//! Sizes of CONTRIBUTING.md: columns of a line, lines of a function and of a file.

use super::names::crates;
use super::{root, sources};
use std::fs;
use std::path::Path;

/// Largest number of columns of a line. rustfmt.toml has the same, but rustfmt breaks neither comments nor texts.
const MAX_COLUMNS: usize = 120;

/// Largest number of lines of a function and of a file, without comments, blank lines and unit tests.
const MAX_LINES_OF_FUNCTION: usize = 60;
const MAX_LINES_OF_FILE: usize = 500;

/// Functions and files that are longer, with the reason.
const ALLOWED: [(&str, &str, &str); 14] = [
    ("src/warnings.rs", "fmt", "a sentence per warning"),
    ("funicular-py/src/reading.rs", "of_kind", "a case per kind of values"),
    ("modes/columns.rs", "columns", COLUMNS),
    ("analyses/loads.rs", "columns", COLUMNS),
    ("analyses/identify.rs", "columns", COLUMNS),
    ("workspace/rows.rs", "of", COLUMNS),
    ("analyses/identify.rs", "run", "the steps of a fit, and the fields of its result"),
    ("sweep/quantity/table.rs", "the file", "a row per quantity"),
    ("commands/calibrate.rs", "text", "a paragraph per part of the result"),
    ("commands/trajectory.rs", "text", "a paragraph per part of the result"),
    ("pages/report.rs", A_LINE, "a template breaks where its text does"),
    ("robot/spec.rs", A_LINE, "a message as it is printed"),
    ("cli/gradient.rs", A_LINE, "rustfmt joins it again"),
    ("cli/request.rs", A_LINE, "a request in one line, as users write it"),
];

/// Name of a line among [`ALLOWED`].
const A_LINE: &str = "a line";

/// Reason of a list of columns.
const COLUMNS: &str = "a row per column, in the order of files";

/// Lines of a source before its unit tests.
fn without_tests(source: &str) -> Vec<&str> {
    let lines: Vec<&str> = source.lines().collect();
    let of_tests = |pair: &[&str]| pair[0] == "#[cfg(test)]" && pair[1].starts_with("mod ") && pair[1].ends_with('{');
    let end = lines.windows(2).position(of_tests).unwrap_or(lines.len());
    lines[..end].to_vec()
}

/// True for a line that is neither blank nor a comment.
fn is_code(line: &&str) -> bool {
    let line = line.trim_start();
    !line.is_empty() && !line.starts_with("//")
}

/// Name of the function that a line begins.
fn begun_function(line: &str) -> Option<&str> {
    let (before, after) = line.split_once("fn ")?;
    let words = ["pub", "pub(crate)", "pub(super)", "const", "unsafe", "extern", "\"C\"", "\"C-unwind\""];
    let is_item = before.split_whitespace().all(|word| words.contains(&word) || word.starts_with("pub(in"));
    let name = after.split(|c: char| !(c.is_alphanumeric() || c == '_')).next()?;
    (is_item && before.ends_with([' ', '\t']) | before.is_empty() && !name.is_empty()).then_some(name)
}

/// Functions with their lines of code. rustfmt sets the last brace of a function below its first word.
fn functions<'a>(lines: &[&'a str]) -> Vec<(&'a str, usize)> {
    let mut found = Vec::new();
    for (at, line) in lines.iter().enumerate() {
        let Some(name) = begun_function(line) else { continue };
        let indent = &line[..line.len() - line.trim_start().len()];
        let ends = |line: &&str| {
            let rest = line.strip_prefix(indent).unwrap_or(" ");
            rest.starts_with('}') || (!rest.starts_with([' ', ')']) && rest.ends_with(['}', ';']))
        };
        let body = lines[at..].iter().position(ends).map_or(0, |end| end + 1);
        found.push((name, lines[at..at + body].iter().copied().filter(is_code).count()));
    }
    found
}

#[test]
fn functions_are_found_with_their_lines_of_code() {
    let source = "pub(crate) fn one() {\n    a();\n\n    // why\n    b();\n}\nimpl A \
                  {\n    const fn two(\n        x: f64,\n    ) -> f64 {\n        x\n    }\n    fn three() \
                  {}\n}\ntrait B {\n    fn four(&self);\n}\n\
                  // fn five() {\nlet fn_six = 6;\n#[cfg(test)]\nmod tests {\n    fn seven() {}\n}\n";
    let lines = without_tests(source);
    assert_eq!(functions(&lines), [("one", 4), ("two", 5), ("three", 1), ("four", 1)]);
}

#[test]
fn lines_functions_and_files_keep_their_sizes() {
    let mut found = Vec::new();
    let mut excused = Vec::new();
    let mut tell = |path: &Path, name: &str, size: usize, what: &str| {
        let is_this = |(file, of, _): &&(&str, &str, &str)| path.ends_with(file) && *of == name;
        match ALLOWED.iter().find(is_this) {
            Some(allowed) => excused.push(*allowed),
            None => found.push(format!("{}: {name} {size} {what}", path.display())),
        }
    };
    for file in crates().iter().flat_map(|folder| sources(folder)) {
        let text = fs::read_to_string(&file).unwrap();
        for (number, line) in text.lines().enumerate() {
            let columns = line.chars().count();
            if columns > MAX_COLUMNS {
                tell(&file, A_LINE, columns, &format!("columns, number {}", number + 1));
            }
        }

        let is_product =
            file.strip_prefix(root().join("..")).is_ok_and(|path| path.iter().nth(1).is_some_and(|of| of == "src"));
        if !is_product {
            continue;
        }
        let lines = without_tests(&text);
        for (name, count) in functions(&lines) {
            if count > MAX_LINES_OF_FUNCTION {
                tell(&file, name, count, "lines");
            }
        }
        let count = lines.iter().filter(|line| is_code(line)).count();
        if count > MAX_LINES_OF_FILE {
            tell(&file, "the file", count, "lines");
        }
    }
    assert!(found.is_empty(), "break lines, and part what is long:\n{}", found.join("\n"));
    for allowed in ALLOWED {
        assert!(excused.contains(&allowed), "{allowed:?} is short enough now: remove it from ALLOWED");
    }
}
