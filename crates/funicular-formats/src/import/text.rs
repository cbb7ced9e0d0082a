//! Numbers in the text of source files.

use funicular_study::text::clean;

/// Maximum magnitude of a number, the same limit as in robot files.
const MAX_NUMBER: f64 = 1e12;

/// Parses a finite number of a file. The error describes the bad value.
pub(crate) fn number(text: &str) -> Result<f64, String> {
    let text = text.trim();
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value.abs() <= MAX_NUMBER => Ok(value),
        Ok(value) if value.is_finite() => Err(format!("{text}, which is beyond {MAX_NUMBER:e} in magnitude")),
        Ok(_) => Err(format!("{text}, which is not a finite number")),
        Err(_) if text.is_empty() => Err("empty where a number is needed".to_owned()),
        Err(_) if text.contains(',') => {
            Err(format!("`{}`, which is not a number; decimals are written with a point", clean(text)))
        }
        Err(_) => Err(format!("`{}`, which is not a number", clean(text))),
    }
}

/// Parses numbers separated by white space.
pub(crate) fn numbers(text: &str) -> Result<Vec<f64>, String> {
    text.split_whitespace().map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_finite_and_have_decimal_points() {
        assert_eq!(number(" -13.332E-3 "), Ok(-0.013_332));
        for (text, expected) in [
            ("", "empty"),
            ("NaN", "not a finite number"),
            ("1e400", "not a finite number"),
            ("1e13", "beyond"),
            ("1,5", "with a point"),
            ("1.5m", "`1.5m`, which is not a number"),
        ] {
            assert!(number(text).unwrap_err().contains(expected), "{text}");
        }
        assert_eq!(numbers(" 1\t2\n3 "), Ok(vec![1.0, 2.0, 3.0]));
    }
}
