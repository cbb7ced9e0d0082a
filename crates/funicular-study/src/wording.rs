//! Names of options in messages: one text for all front ends, each of which writes options in its own way.
//!
//! A message names an option by its key between ⟪ and ⟫: `give ⟪min_tension_n⟫ below ⟪max_tension_n⟫`. The program
//! shows `--min-tension-n`, Python and JSON show `min_tension_n`.

use crate::refused::Refused;
use funicular::robot::spec::SpecError;
use funicular::statics::StaticsError;
use funicular::suggest::shown;
use std::fmt;

/// Ways in which front ends write the name of an option.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Words {
    /// Command line: `--mass-kg`.
    Program,
    /// Keyword of Python: `` `mass_kg` ``.
    Python,
    /// Key of a request in JSON: `` `mass_kg` ``.
    Json,
}

/// Keys whose option on the command line has another name.
const PROGRAM_NAMES: [(&str, &str); 3] = [("robot", "ROBOT"), ("files", "FILE"), ("quantities", "--quantity")];

/// Keys with another form in Python: switches with their value, a method, another keyword.
const PYTHON_NAMES: [(&str, &str); 9] = [
    ("adaptive", "adaptive=True"),
    ("resume", "resume=True"),
    ("discard", "discard=True"),
    ("set", "with_"),
    ("output_file", "file"),
    ("node", "nodes"),
    ("response", "responses"),
    ("prior", "fit"),
    ("quantity", "quantities"),
];

/// Text in which the names of options are written for a front end.
///
/// # Example
/// ```
/// use funicular_study::wording::{Words, worded};
///
/// let text = "a point mass has no orientation: give ⟪pose⟫ as x,y,z";
/// assert_eq!(worded(text, Words::Program), "a point mass has no orientation: give --pose as x,y,z");
/// assert_eq!(worded(text, Words::Python), "a point mass has no orientation: give `pose` as x,y,z");
/// ```
pub fn worded(text: &str, words: Words) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, from_key)) = rest.split_once('⟪') {
        let Some((key, after)) = from_key.split_once('⟫') else { break };
        out.push_str(before);
        out.push_str(&option(key, words));
        rest = after;
    }
    out + rest
}

/// Message, warning or note for a front end: names of options as the front end writes them, and text of the user that
/// can neither act on a terminal nor fill it. Every message leaves the program through this function.
pub fn told(text: &str, words: Words) -> String {
    shown(&with_rounded_numbers(&worded(text, words)))
}

/// Number of significant digits from which on a number counts as computed. Nobody writes so many digits by hand, and a
/// number of double precision has 15 to 17.
const MIN_COMPUTED_DIGITS: usize = 12;

/// Number of zeros behind the point from which on a number is written with an exponent.
const MIN_ZEROS: usize = 8;

/// Number of digits of a whole number from which on it is written with an exponent.
const MIN_WHOLE_DIGITS: usize = 16;

/// Text whose computed numbers have seven digits, and whose tiny and huge ones an exponent. Quoted text, which is the
/// user's, and lines of files in a frame stay as they are.
fn with_rounded_numbers(text: &str) -> String {
    let is_of_file = |line: &str| line.trim_start_matches(|c: char| c == ' ' || c.is_ascii_digit()).starts_with('|');
    let lines = text.split('\n').map(|line| if is_of_file(line) { line.to_owned() } else { rounded_line(line) });
    lines.collect::<Vec<_>>().join("\n")
}

fn rounded_line(line: &str) -> String {
    let mut out = String::with_capacity(line.len());
    let mut quote = None;
    let mut rest = line;
    while let Some(first) = rest.chars().next() {
        match quote {
            Some(open) if first == open => quote = None,
            None if matches!(first, '`' | '"') => quote = Some(first),
            _ => {}
        }
        let before = out.chars().next_back();
        let begins =
            quote.is_none() && !before.is_some_and(|c| c.is_alphanumeric() || matches!(c, '.' | '_' | '/' | '\\'));
        let length = if begins { number_at(rest) } else { 0 };
        if length == 0 {
            out.push(first);
            rest = &rest[first.len_utf8()..];
            continue;
        }
        out.push_str(&rounded_number(&rest[..length]));
        rest = &rest[length..];
    }
    out
}

/// Length of the number with which a text begins; 0 without one.
fn number_at(text: &str) -> usize {
    let digits = |from: usize| text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let sign = usize::from(text.starts_with('-'));
    let mut end = sign + digits(sign);
    if end == sign {
        return 0;
    }
    if text[end..].starts_with('.') && digits(end + 1) > 0 {
        end += 1 + digits(end + 1);
    }
    if text[end..].starts_with('e') {
        let of_exponent = end + 1 + usize::from(text[end + 1..].starts_with('-'));
        end = if digits(of_exponent) > 0 { of_exponent + digits(of_exponent) } else { end };
    }
    let goes_on = text[end..].starts_with(|c: char| c.is_alphanumeric() || matches!(c, '_' | '/' | '\\'));
    if goes_on { 0 } else { end }
}

fn rounded_number(text: &str) -> String {
    let (mantissa, exponent) =
        text.split_once('e').map_or((text, None), |(mantissa, exponent)| (mantissa, Some(exponent)));
    let (whole, decimals) = mantissa.trim_start_matches('-').split_once('.').unwrap_or((mantissa, ""));
    let all = whole.trim_start_matches('-').to_owned() + decimals;
    let significant = all.trim_start_matches('0').len();
    let zeros = if whole == "0" { decimals.len() - decimals.trim_start_matches('0').len() } else { 0 };
    let is_computed = (!decimals.is_empty() && significant >= MIN_COMPUTED_DIGITS) || zeros >= MIN_ZEROS;
    let is_huge = exponent.is_none() && whole.len() >= MIN_WHOLE_DIGITS;
    let value = text.parse::<f64>().ok().filter(|_| is_computed || is_huge);
    let Some(value) = value.and_then(|value| format!("{value:.6e}").parse::<f64>().ok()) else {
        return text.to_owned();
    };
    if value == 0.0 || (1e-4..1e9).contains(&value.abs()) { format!("{value}") } else { format!("{value:e}") }
}

/// Warnings that explain an error: values of the robot that are likely slips. [`message`] writes them below the error.
#[derive(Debug)]
pub(crate) struct Warned {
    /// Warnings, one sentence each.
    pub(crate) warnings: Vec<String>,
}

impl fmt::Display for Warned {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the robot has implausible values")
    }
}

/// Message of an error of any analysis for a front end: the text of the error, the option that helps, and in lines of
/// their own the warnings about values of the robot that may be the cause.
pub fn message(error: &anyhow::Error, words: Words) -> String {
    let remedy = error.downcast_ref().and_then(remedy).unwrap_or_default();
    let warned = error.downcast_ref::<Warned>();

    // The warnings are the outermost part of the error.
    let causes: Vec<String> = error.chain().skip(usize::from(warned.is_some())).map(in_one_line).collect();
    let mut text = causes.join(": ") + remedy;
    for warning in warned.iter().flat_map(|warned| &warned.warnings) {
        text = text + "\nwarning: " + warning;
    }
    told(&text, words)
}

/// Text of an error. Ends of lines in it are the user's, except in the list of a refused robot file.
fn in_one_line(error: &(dyn std::error::Error + 'static)) -> String {
    let text = error.to_string();
    if error.is::<Refused>() || error.is::<SpecError>() {
        return text;
    }
    text.trim_end().replace('\n', "\\n").replace('\t', "\\t")
}

/// Hint to an option that helps against an error of the core, which does not know the options.
fn remedy(error: &StaticsError) -> Option<&'static str> {
    match error {
        StaticsError::TensionsNotConverged { .. } => Some(", or give ⟪min_tension_n⟫"),
        StaticsError::NoState => Some(": give ⟪lengths_m⟫ or ⟪pose⟫, or one of the two in the file"),
        StaticsError::NothingToChoose { .. } => Some("; leave out ⟪tension_rule⟫ and ⟪target_tension_n⟫"),
        _ => None,
    }
}

/// Name of one option in the form of a front end.
pub fn option(key: &str, words: Words) -> String {
    let own_name = |names: &[(&str, &'static str)]| names.iter().find(|(name, _)| *name == key).map(|(_, own)| *own);
    match words {
        Words::Program => match own_name(&PROGRAM_NAMES) {
            Some(name) => name.to_owned(),
            None => format!("--{}", key.replace('_', "-")),
        },
        Words::Python => format!("`{}`", own_name(&PYTHON_NAMES).unwrap_or(key)),
        Words::Json => format!("`{key}`"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn computed_numbers_are_rounded_and_what_the_user_wrote_stays() {
        for (text, expected) in [
            ("it needs -2417.3281937462 N, 0.1 m", "it needs -2417.328 N, 0.1 m"),
            (&format!("{} is negative", -1e-300), "-1e-300 is negative"),
            (&format!("at most {} are possible", 1e22), "at most 1e22 are possible"),
            ("the error is 9.714451465470e-17.", "the error is 9.714451e-17."),
            ("(0.30000000000000004, -0.0000000001)", "(0.3, -1e-10)"),
            ("`0.30000000000000004` and \"a 1.2345678901234\"", "`0.30000000000000004` and \"a 1.2345678901234\""),
            ("12 | mass_kg = 1.23456789012345\n   |           ^", "12 | mass_kg = 1.23456789012345\n   |           ^"),
            (
                "/tmp/1.2345678901234/a, v1.2345678901234, 1.2345678901234x",
                "/tmp/1.2345678901234/a, v1.2345678901234, 1.2345678901234x",
            ),
            ("123456789012 rows, 20261128, 1e-300, 0.000012", "123456789012 rows, 20261128, 1e-300, 0.000012"),
        ] {
            assert_eq!(told(text, Words::Json), expected);
        }
    }

    #[test]
    fn an_error_of_the_core_is_told_with_the_option_that_helps() {
        let error = StaticsError::TensionsNotConverged {
            iterations: 100,
            change: 1e-3,
            limit: 1e-9,
            residual: 1e-7,
            x: 0.0,
            y: 0.0,
            z: 1.0,
        };
        assert!(!error.to_string().contains("--"));
        let message = message(&error.into(), Words::Program);
        assert!(message.ends_with("(`minimum_tension_n` in the robot file), or give --min-tension-n"), "{message}");
    }
}
