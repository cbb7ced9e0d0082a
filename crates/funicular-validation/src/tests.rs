//! Tests of all sections: every comparison passes and has an identity, every negative control fails.

use super::*;
use funicular_study::request::ValidateRequest;
use std::collections::BTreeSet;
use std::sync::LazyLock;

/// All comparisons and all negative controls, computed once for all tests.
pub(super) fn all() -> &'static Validated {
    static ALL: LazyLock<Validated> =
        LazyLock::new(|| run(&ValidateRequest { controls: true, ..ValidateRequest::default() }).unwrap());
    &ALL
}

#[test]
fn every_comparison_passes_and_has_a_source_that_can_be_looked_up() {
    for section in &all().sections {
        let failed: Vec<String> = section.rows.iter().filter(|row| !row.pass).map(markdown::line).collect();
        assert!(failed.is_empty(), "{}:\n{}", section.title, failed.join("\n"));
        assert!(!section.rows.is_empty(), "{}", section.title);
        for row in &section.rows {
            assert!(row.source.len() > 20, "{}: {:?} is not a source", row.id, row.source);
            assert!(!row.theirs.is_empty() && row.numbers > 0 && row.tolerance >= 0.0, "{}", row.id);
        }
    }
}

#[test]
fn every_comparison_has_an_id_of_its_own_made_of_plain_words() {
    let mut known = BTreeSet::new();
    for section in &all().sections {
        for row in &section.rows {
            let parts: Vec<&str> = row.id.split('/').collect();
            let is_plain = |part: &&str| {
                let letter =
                    |letter: u8| letter.is_ascii_lowercase() || letter.is_ascii_digit() || b"._-".contains(&letter);
                !part.is_empty() && part.bytes().all(letter)
            };
            assert!(parts.len() > 2 && parts[0] == section.id && parts.iter().all(is_plain), "{}", row.id);
            assert!(row.id.len() <= 120, "{} is long", row.id);
            assert!(known.insert(row.id.clone()), "{} is there twice", row.id);
        }
    }
}

#[test]
fn every_section_has_controls_and_finds_each_wrong_input() {
    for declared in &SECTIONS {
        assert!(!declared.controls.is_empty(), "{} has no negative control", declared.id);
    }
    for run in &all().controls {
        assert!(run.caught, "{}: all of {} comparisons pass", run.id, run.comparisons);
    }
}
