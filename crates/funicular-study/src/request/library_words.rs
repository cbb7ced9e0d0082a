//! Messages of the readers of JSON in words of this program.

use crate::names::suggestion;

/// Beginnings of messages about the form of JSON, and what is told instead.
const FORM: [(&str, &str); 8] = [
    ("EOF while parsing a list", "it ends within a list: `]` is missing"),
    ("EOF while parsing an object", "it ends within an object: `}` is missing"),
    ("EOF while parsing a string", "it ends within a text: `\"` is missing"),
    ("EOF while parsing", "it ends before a value is complete"),
    ("expected value", "a value stands here that is none of JSON"),
    ("expected ident", "a word stands here that is none of JSON: it knows true, false and null"),
    ("trailing comma", "a comma stands before the end of a list or object: leave it out"),
    ("trailing characters", "something follows after the end of the value"),
];

/// Message about text that is not JSON, with line and column.
pub(super) fn of_form(message: &str) -> String {
    let (what, place) = place_at_end(message);
    let told = FORM.iter().find(|(begin, _)| what.starts_with(begin)).map_or(what, |(_, told)| told);
    format!("{told}{place}")
}

/// Message about a value of another type than its reader needs.
pub(super) fn of_reader(message: &str) -> String {
    let (what, place) = place_at_end(message);
    format!("{}{place}", value_of_another_type(what).unwrap_or_else(|| what.to_owned()))
}

fn value_of_another_type(message: &str) -> Option<String> {
    if let Some(key) = message.strip_prefix("missing field ") {
        return Some(format!("it has no {key}"));
    }
    if let Some(rest) = message.strip_prefix("unknown field ") {
        let mut names = rest.split('`').skip(1).step_by(2).map(str::to_owned);
        let unknown = names.next()?;
        return Some(format!("there is no key `{unknown}`{}", suggestion(&unknown, &names.collect::<Vec<_>>())));
    }
    if let Some(rest) = message.strip_prefix("duplicate field ") {
        return Some(format!("the key {rest} is there twice: keep one of them"));
    }
    if message.starts_with("data did not match any variant") {
        return Some("the value has none of the forms that it can have".to_owned());
    }
    let rest = ["invalid type: ", "invalid value: "].iter().find_map(|begin| message.strip_prefix(begin));
    if let Some((found, wanted)) = rest.and_then(|rest| rest.rsplit_once(", expected ")) {
        return Some(format!("{} stands where {} is needed", found_value(found), wanted_value(wanted)));
    }
    let (count, wanted) = message.strip_prefix("invalid length ")?.split_once(", expected ")?;
    Some(format!("there are {count} values, but {} is needed", wanted_value(wanted)))
}

/// Message and its end `, line 3, column 5`.
fn place_at_end(message: &str) -> (&str, String) {
    let split = message.rsplit_once(" at line ").and_then(|(what, place)| Some((what, place.split_once(" column ")?)));
    match split {
        Some((what, (line, column))) if line.parse::<usize>().is_ok() => {
            (what, format!(", line {line}, column {column}"))
        }
        _ => (message, String::new()),
    }
}

fn found_value(found: &str) -> String {
    match found {
        "map" => "a mapping".to_owned(),
        "sequence" => "a list".to_owned(),
        "null" | "unit value" => "nothing".to_owned(),
        other => {
            let names = [("string ", "the text "), ("integer ", "the number "), ("floating point ", "the number ")];
            let named = names.iter().find_map(|(from, to)| Some(format!("{to}{}", other.strip_prefix(from)?)));
            named.unwrap_or_else(|| other.trim_start_matches("boolean ").to_owned())
        }
    }
}

fn wanted_value(wanted: &str) -> String {
    match wanted {
        "f64" | "f32" => "a number".to_owned(),
        "u8" | "u16" | "u32" | "u64" | "usize" | "i32" | "i64" => "a whole number".to_owned(),
        "a string" | "a borrowed string" | "string" => "a text".to_owned(),
        "a boolean" => "true or false".to_owned(),
        "a sequence" => "a list".to_owned(),
        "a map" => "a mapping".to_owned(),
        other if other.starts_with("struct ") || other.starts_with("internally tagged") => "a mapping".to_owned(),
        other => {
            let count = ["an array of length ", "a tuple of size "].iter().find_map(|begin| other.strip_prefix(begin));
            count.map_or_else(|| other.to_owned(), |count| format!("a list of {count}"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;

    #[derive(Debug, Deserialize)]
    #[serde(deny_unknown_fields)]
    #[expect(dead_code, reason = "only its reader is of interest")]
    struct Read {
        mass_kg: f64,
        #[serde(default)]
        point_m: [f64; 3],
        #[serde(default)]
        names: Vec<String>,
        #[serde(default)]
        count: u32,
    }

    #[test]
    fn no_word_of_a_library_reaches_the_user() {
        let library =
            ["field", "expected", "f64", "u32", "sequence", "invalid", "EOF", "trailing", "struct", "column 0"];
        for text in [
            "{}",
            r#"{"mass_kg": "5"}"#,
            r#"{"mass_kg": 1, "mas_kg": 2}"#,
            r#"{"mass_kg": 1, "mass_kg": 2}"#,
            r#"{"mass_kg": [1]}"#,
            r#"{"mass_kg": 1, "point_m": [1, 2]}"#,
            r#"{"mass_kg": 1, "point_m": {"x": 1}}"#,
            r#"{"mass_kg": 1, "names": "a"}"#,
            r#"{"mass_kg": 1, "names": [true]}"#,
            r#"{"mass_kg": 1, "count": 1.5}"#,
            r#"{"mass_kg": 1, "count": -1}"#,
            "[true]",
            "3",
        ] {
            let error = serde_json::from_str::<Read>(text).unwrap_err().to_string();
            let told = of_reader(&error);
            assert!(!library.iter().any(|word| told.contains(word)), "{text}: {told}");
        }
        for text in ["{", "[1", "\"a", "{\"a\":}", "{\"a\": tru}", "[1,]", "{\"a\": 1,}", "1 2", ""] {
            let error = serde_json::from_str::<serde_json::Value>(text).unwrap_err().to_string();
            let told = of_form(&error);
            assert!(!library[6..8].iter().any(|word| told.contains(word)), "{text}: {told}");
            assert!(told.contains("line "), "{text}: {told}");
        }
    }

    #[test]
    fn a_wrong_key_is_told_with_the_nearest_one() {
        let error = serde_json::from_str::<Read>(r#"{"mass_kg": 1, "mas_kg": 2}"#).unwrap_err().to_string();
        assert!(of_reader(&error).starts_with("there is no key `mas_kg`; did you mean `mass_kg`?"), "{error}");
    }
}
