//! Words of the user in messages: the known name nearest to a mistyped one ("did you mean", with one measure and one
//! limit for all messages), and text of any length and content made fit for a terminal.

use std::fmt::Write;

/// Minimum similarity (Jaro-Winkler, 0 to 1) at which a known name is suggested: `mas` has 0.87 with `mass_kg`, which
/// is meant; `mass_kg_per_m` has 0.66 with `name`, which is not.
const MIN_SIMILARITY: f64 = 0.8;

/// Maximum length of a name [bytes]. Longer text is no name, and its comparison would take long.
const MAX_LENGTH: usize = 100;

/// Names of earlier versions of the program with their present names. The present name is suggested for an earlier one
/// even if their letters have nothing in common.
const RENAMED: &[(&str, &str)] = &[
    ("exact", "catenary-dynamic"),
    ("closed-form", "shallow-dynamic"),
    ("catenary-tangent", "catenary-static"),
    ("static-sag", "shallow-static"),
    ("paper", "without-geometric-stiffness"),
    ("freedoms", "motion"),
    ("wanted_tension_n", "target_tension_n"),
    ("wanted-tension-n", "target-tension-n"),
];

/// Present name of an earlier name, if `word` is one.
///
/// # Example
/// ```
/// use funicular::suggest::renamed;
///
/// assert_eq!(renamed("static-sag"), Some("shallow-static"));
/// assert_eq!(renamed("spring"), None);
/// ```
pub fn renamed(word: &str) -> Option<&'static str> {
    RENAMED.iter().find(|(old, _)| old.eq_ignore_ascii_case(word)).map(|(_, new)| *new)
}

/// Known name that an earlier version called `word`, or else the known name nearest to `word`, if one is near enough.
/// Ignores upper and lower case.
///
/// # Example
/// ```
/// use funicular::suggest::nearest;
///
/// assert_eq!(nearest("statcs", ["check", "statics"]), Some("statics"));
/// assert_eq!(nearest("colour", ["check", "statics"]), None);
/// ```
pub fn nearest<'k>(word: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    let known: Vec<&str> = known.into_iter().collect();
    if let Some(new) = renamed(word).and_then(|new| known.iter().find(|name| **name == new)) {
        return Some(new);
    }

    let word = word.to_lowercase();
    known
        .into_iter()
        .filter(|name| word.len().max(name.len()) <= MAX_LENGTH)
        .map(|name| (strsim::jaro_winkler(&word, &name.to_lowercase()), name))
        .filter(|(similarity, _)| *similarity >= MIN_SIMILARITY)
        // Equal candidates: the first one wins, so that the answer does not depend on the order of comparison.
        .fold(None, |best: Option<(f64, &str)>, (similarity, name)| match best {
            Some((most, _)) if most >= similarity => best,
            _ => Some((similarity, name)),
        })
        .map(|(_, name)| name)
}

/// Maximum number of characters of a word in a message, and how many of its beginning and its end remain of a longer
/// one. Names of files have up to 255 characters.
const WORD: (usize, usize) = (300, 130);

/// Maximum number of characters of a line of a message, and how many of its beginning and its end remain of a longer
/// one. Lists that messages make themselves stay below 1000.
const LINE: (usize, usize) = (2000, 900);

/// True for control characters, and for characters that turn or hide text in a terminal.
pub fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{2069}')
        || matches!(c, '\u{feff}' | '\u{e0000}'..='\u{e007f}')
}

/// Text with [hidden](is_hidden) characters as their codes, except ends of lines and tabs.
pub fn visible(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        if is_hidden(c) && !matches!(c, '\n' | '\t') {
            out.extend(c.escape_default());
        } else {
            out.push(c);
        }
    }
    out
}

/// Message of one or more lines in which text of the user is harmless: [`visible`], with long words and long lines cut
/// in the middle. A message that was shown stays as it is.
///
/// # Example
/// ```
/// use funicular::suggest::shown;
///
/// assert_eq!(shown("`1\u{1b}[31m` is not a number"), "`1\\u{1b}[31m` is not a number");
/// assert!(shown(&"x".repeat(1_000_000)).len() < 300);
/// ```
pub fn shown(message: &str) -> String {
    let line = |line: &str| {
        let words: Vec<String> = line.split(' ').map(|word| cut(&with_exponents(word), WORD)).collect();
        cut(&words.join(" "), LINE)
    };
    visible(message).split('\n').map(line).collect::<Vec<_>>().join("\n")
}

/// Maximum number of characters of a number without an exponent: with every digit, 1e-9 has fewer.
const NUMBER: usize = 27;

/// Word in which very small and very large numbers have an exponent instead of hundreds of zeros.
fn with_exponents(word: &str) -> String {
    if word.len() <= NUMBER {
        return word.to_owned();
    }
    let is_part = |c: char| c.is_ascii_digit() || c == '.';
    let mut out = String::new();
    let mut rest = word;
    while let Some(from) = rest.find(|c: char| c.is_ascii_digit()) {
        let (before, digits) = rest.split_at(from);
        let until = digits.find(|c: char| !is_part(c)).unwrap_or(digits.len());
        // A full stop ends the sentence.
        let number = digits[..until].trim_end_matches('.');
        out.push_str(before);
        match number.parse::<f64>() {
            Ok(value) if number.len() > NUMBER && value.is_finite() => {
                let _ = write!(out, "{value:e}");
            }
            _ => out.push_str(number),
        }
        rest = &digits[number.len()..];
    }
    out + rest
}

/// Text without its middle if it has more than `maximum` characters; `kept` remain at either end.
fn cut(text: &str, (maximum, kept): (usize, usize)) -> String {
    // A text has at most as many characters as bytes.
    if text.len() <= maximum {
        return text.to_owned();
    }
    let count = text.chars().count();
    if count <= maximum {
        return text.to_owned();
    }
    let head: String = text.chars().take(kept).collect();
    let tail: String = text.chars().skip(count - kept).collect();
    format!("{head}…[{} characters]…{tail}", count - 2 * kept)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_with_hundreds_of_zeros_have_an_exponent() {
        let message = |x: f64| format!("it is {x} m (x={x}): give more than {x}.");
        for x in [1e-300, 2.5e-30, -1e100, 1.234e-40] {
            assert_eq!(shown(&message(x)), format!("it is {x:e} m (x={x:e}): give more than {x:e}."));
        }
        for x in [1e-9, 0.1 + 0.2, 1e15, 1.234_567_890_123_456_7e-7] {
            assert_eq!(shown(&message(x)), message(x));
        }
        // Digits that are no number, and a sentence that ends in one.
        let text = format!("{}.toml v1.2.3.{}", "7".repeat(20), "1.2".repeat(12));
        assert_eq!(shown(&text), text);
    }

    #[test]
    fn an_earlier_name_is_answered_with_the_name_of_today() {
        assert_eq!(nearest("exact", ["spring", "catenary-dynamic"]), Some("catenary-dynamic"));
        assert_eq!(nearest("Freedoms", ["mass_kg", "motion"]), Some("motion"));
        // If the new name is not among the known ones, similarity decides.
        assert_eq!(nearest("exact", ["spring", "exact_length"]), Some("exact_length"));
        assert_eq!(nearest("exact", ["spring"]), None);
    }

    #[test]
    fn typing_errors_are_near_and_other_words_are_not() {
        let keys = ["name", "mass_kg", "inertia_kg_m2", "center_of_mass_m"];
        for (word, expected) in [
            ("mas", Some("mass_kg")),
            ("mass", Some("mass_kg")),
            ("Mass_kg", Some("mass_kg")),
            ("inertia", Some("inertia_kg_m2")),
            ("centre_of_mass_m", Some("center_of_mass_m")),
            ("", None),
            ("colour", None),
            (
                "mass_kg_per_m_and_so_on_for_more_than_a_hundred_letters_which_no_name_of_any_robot_file_or_option_\
                 ever_has_had",
                None,
            ),
        ] {
            assert_eq!(nearest(word, keys), expected, "{word}");
        }
        assert!(strsim::jaro_winkler("mass_kg_per_m", "name") < MIN_SIMILARITY);
    }

    #[test]
    fn a_message_shows_what_would_be_hidden_and_has_a_limited_length() {
        let bad = "a\u{1b}]0;b\u{7}\u{202e}c\u{2066}\u{61c}\r\u{9b}\u{0}\u{feff}\u{e0041}";
        let good = shown(bad);
        assert!(!good.chars().any(is_hidden), "{good:?}");
        assert!(good.starts_with("a\\u{1b}]0;b\\u{7}\\u{202e}c"), "{good}");
        assert_eq!(shown("µ ± 1 °, 漢字 é, two\nlines\tand tabs"), "µ ± 1 °, 漢字 é, two\nlines\tand tabs");
        for long in ["é".repeat(100_000), "word ".repeat(100_000), "\u{202e}".repeat(100_000), "w ".repeat(2500)] {
            let cut = shown(&long);
            assert!(cut.chars().count() <= LINE.0 && cut.contains(" characters]…"), "{cut}");
            assert_eq!(shown(&cut), cut);
        }
        let just = "x".repeat(WORD.0);
        assert_eq!(shown(&just), just);
    }
}
