//! Texts of the user in files of XML: names that an attribute can hold, and comments.

use super::one_line;

/// True for a character that XML 1.0 allows in an attribute and that a reader returns unchanged: it replaces tabs and
/// line breaks by spaces.
///
/// # References
/// Extensible Markup Language (XML) 1.0, fifth edition, production \[2\] `Char` and section 3.3.3.
fn is_kept(c: char) -> bool {
    matches!(c, ' '..='\u{d7ff}' | '\u{e000}'..='\u{fffd}' | '\u{10000}'..) && !c.is_control()
}

/// Names of `what` as a file can hold them: characters that XML or the program does not allow become `_`, and names
/// that are equal then get their number. A warning says which names changed.
pub(crate) fn names<'a>(
    what: &str,
    given: impl Iterator<Item = &'a str>,
    forbidden: &[char],
    warnings: &mut Vec<String>,
) -> Vec<String> {
    let mut written: Vec<String> = Vec::new();
    for (i, name) in given.enumerate() {
        let letter = |c: char| if is_kept(c) && !forbidden.contains(&c) { c } else { '_' };
        let mut allowed: String = name.chars().map(letter).collect();
        if allowed.is_empty() {
            allowed.push('_');
        }
        while written.contains(&allowed) {
            allowed = format!("{allowed}_{}", i + 1);
        }
        if allowed != name {
            warnings.push(format!(
                "the name {name:?} of a {what} holds what the file does not allow there, or comes twice: it is \
                 \"{allowed}\" in the file"
            ));
        }
        written.push(allowed);
    }
    written
}

/// Text in a comment of XML, which may hold neither two hyphens in a row nor characters that XML does not allow.
pub(crate) fn in_comment(text: &str) -> String {
    let mut text: String = one_line(text).chars().map(|c| if is_kept(c) { c } else { '_' }).collect();
    while text.contains("--") {
        text = text.replace("--", "- -");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_allowed_and_differ_and_those_that_change_are_told() {
        let mut warnings = Vec::new();
        let given = ["a", "a\u{1}", "a_", "", "索 & <1>", "x/y"];
        let written = names("cable", given.into_iter(), &['/'], &mut warnings);
        assert_eq!(written, ["a", "a_", "a__3", "_", "索 & <1>", "x_y"]);
        assert_eq!(warnings.len(), 4, "{warnings:?}");
        assert!(warnings[0].contains(r#""a\u{1}""#), "{}", warnings[0]);
    }

    #[test]
    fn a_comment_holds_no_two_hyphens() {
        assert_eq!(in_comment("a --- b\n\u{7}"), "a - - - b _");
    }
}
