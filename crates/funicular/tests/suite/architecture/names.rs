//! One name, one type: within a crate, tests included, no two types have the same name.

use super::{root, sources};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Types that share a name in a crate, with the reason.
const ALLOWED: [(&str, &str, &str); 1] = [(
    "funicular-files",
    "ParquetFile",
    "a build has one of `parquet.rs` and `without_parquet.rs`; with the same names the rest of the crate is the same",
)];

/// Name of the type that a line defines: a struct, an enum, a union, a trait or an alias.
fn defined_type(line: &str) -> Option<&str> {
    let line = line.trim_start();
    let line = match line.strip_prefix("pub") {
        Some(rest) if rest.starts_with('(') => rest.split_once(") ")?.1,
        Some(rest) => rest.strip_prefix(' ')?,
        None => line,
    };
    let (keyword, rest) = line.split_once(' ')?;
    let name = rest.split(|c: char| !(c.is_alphanumeric() || c == '_')).next()?;
    let defines = ["struct", "enum", "union", "trait", "type"].contains(&keyword);
    (defines && name.starts_with(|c: char| c.is_uppercase())).then_some(name)
}

/// Names of the types that a source defines, without associated types.
fn defined_types(source: &str) -> Vec<&str> {
    // Line without indentation to which the present line belongs.
    let mut outer = "";
    let mut names = Vec::new();
    for line in source.lines() {
        if !line.starts_with([' ', '}', '/', '#']) && !line.is_empty() {
            outer = line;
        }
        let words: Vec<&str> = outer.split([' ', '<', ':']).collect();
        let is_associated = line.starts_with(' ')
            && line.trim_start().starts_with("type ")
            && words.iter().any(|word| ["impl", "trait"].contains(word));
        names.extend(defined_type(line).filter(|_| !is_associated));
    }
    names
}

#[test]
fn definitions_of_types_are_found_in_sources() {
    let source = "pub(crate) struct A<'a> {\n    b: B,\n}\n// enum C\n\
                  impl Iterator for A<'_> {\n    type Item = B;\n}\n\
                  mod tests {\n    type Case = (A, B);\n    pub enum D {}\n}\n\
                  union E {}\npub trait F {\n    type G;\n}\n\
                  pub(in crate::a) type H = A<'static>;\nlet structure = type_of(x);\n";
    assert_eq!(defined_types(source), ["A", "Case", "D", "E", "F", "H"]);
}

/// Folders of all crates of the workspace.
pub(super) fn crates() -> Vec<PathBuf> {
    let entries = fs::read_dir(root().join("..")).unwrap().map(|entry| entry.unwrap().path());
    let mut folders: Vec<PathBuf> = entries.filter(|path| path.join("Cargo.toml").exists()).collect();
    folders.push(root().join("../../robots"));
    folders
}

#[test]
fn no_two_types_of_a_crate_have_one_name() {
    let mut shared = Vec::new();
    let crates = crates();
    assert!(crates.len() > 6, "{crates:?}");
    for folder in &crates {
        let name = folder.file_name().unwrap().to_str().unwrap();
        let mut places: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
        for file in sources(folder) {
            let text = fs::read_to_string(&file).unwrap();
            let shown: &Path = file.strip_prefix(folder).unwrap();
            for defined in defined_types(&text) {
                places.entry(defined.to_owned()).or_default().push(shown.to_owned());
            }
        }
        places.retain(|_, files| files.len() > 1);
        for (krate, allowed, _) in &ALLOWED {
            if *krate == name {
                assert!(places.remove(*allowed).is_some(), "{allowed} no longer needs its exception");
            }
        }
        shared.extend(places.into_iter().map(|(defined, files)| format!("{name}: {defined} in {files:?}")));
    }
    assert!(shared.is_empty(), "give each type a name that says what it is:\n{}", shared.join("\n"));
}

/// Code and documents name equations by their numbers, so that a number means one equation.
#[test]
fn no_two_equations_of_the_theory_have_one_number() {
    let theory = fs::read_to_string(root().join("../../docs/theory.md")).unwrap();
    let mut numbers: Vec<&str> =
        theory.split("\\tag{").skip(1).filter_map(|after| after.split_once('}')).map(|(number, _)| number).collect();
    assert!(numbers.len() > 200, "{} equations", numbers.len());
    numbers.sort_unstable();
    let twice: Vec<&str> = numbers.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect();
    assert!(twice.is_empty(), "give each equation a number of its own: {twice:?}");
}
