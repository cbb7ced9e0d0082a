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
    shown(&worded(text, words))
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
