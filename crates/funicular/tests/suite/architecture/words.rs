//! Words of CONTRIBUTING.md, "How we write", that the sources can be read for.

use super::names::crates;
use super::sources;
use std::fs;

/// Beginnings of a doc comment that refer to the line before.
const FORBIDDEN: [&str; 6] = ["What", "Its", "The same", "It", "Of", "How"];

/// Text of a line of a doc comment with its mark, `///` or `//!`.
fn doc_line(line: &str) -> Option<(&str, &str)> {
    let line = line.trim_start();
    ["///", "//!"].into_iter().find_map(|mark| Some((mark, line.strip_prefix(mark)?.trim())))
}

/// Forbidden first lines of the doc comments of a source.
fn forbidden_openings(source: &str) -> Vec<&str> {
    let mut before = None;
    let mut found = Vec::new();
    for line in source.lines() {
        let of = doc_line(line);
        if let Some((mark, text)) = of {
            let is_first = before != Some(mark);
            let begins =
                |word: &&str| text.strip_prefix(*word).is_some_and(|rest| !rest.starts_with(char::is_alphanumeric));
            found.extend(Some(text).filter(|_| is_first && FORBIDDEN.iter().any(begins)));
        }
        before = of.map(|(mark, _)| mark);
    }
    found
}

#[test]
fn forbidden_openings_are_found_in_sources() {
    let source = "/// What a row is.\nstruct A;\n/// Sum of all.\n/// It is positive.\nfn f() {}\n    //! Its \
        place.\n/// Items.\n";
    assert_eq!(forbidden_openings(source), ["What a row is.", "Its place."]);
}

#[test]
fn doc_comments_can_be_read_alone() {
    let mut found = Vec::new();
    for file in crates().iter().flat_map(|folder| sources(folder)) {
        let text = fs::read_to_string(&file).unwrap();
        found.extend(forbidden_openings(&text).into_iter().map(|opening| format!("{}: {opening}", file.display())));
    }
    assert!(found.is_empty(), "begin a doc comment with a noun or a verb:\n{}", found.join("\n"));
}
