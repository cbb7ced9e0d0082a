//! Rounded numbers and counted nouns for messages, tables and pages.

use funicular::suggest::is_hidden;

/// Number with `count` decimals, without a minus before zero.
pub fn decimals(value: f64, count: usize) -> String {
    let text = format!("{value:.count$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.to_owned(),
        _ => text,
    }
}

/// Number with `digits` significant digits, with an exponent if that is shorter.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let exponent = value.abs().log10().floor() as i64;
    if (-4..=6).contains(&exponent) {
        decimals(value, (i64::try_from(digits).unwrap_or(i64::MAX) - 1 - exponent).max(0) as usize)
    } else {
        format!("{value:.places$e}", places = digits.saturating_sub(1))
    }
}

/// Number as in [`significant`], without zeros at the end: for numbers that the user chose.
pub fn short(value: f64, digits: usize) -> String {
    let text = significant(value, digits);
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// Text of a missing number.
pub const NONE: &str = "–";

/// Number of digits of a value that shows one or two digits of its standard deviation, from 2 to 10; 6 if the deviation
/// is unknown or one of the two is zero.
pub(crate) fn digits_for(value: f64, deviation: Option<f64>) -> usize {
    const WITHOUT_DEVIATION: usize = 6;
    match deviation.map(|deviation| (value / deviation).abs().log10().floor()) {
        Some(decades) if decades.is_finite() => (decades as i64 + 2).clamp(2, 10) as usize,
        _ => WITHOUT_DEVIATION,
    }
}

/// Number with `count` decimals, or a dash if there is no number.
pub fn decimals_or_none(value: Option<f64>, count: usize) -> String {
    value.map_or_else(|| NONE.to_owned(), |value| decimals(value, count))
}

/// List `a, b, c` with `count` decimals each.
pub fn vector(values: &[f64], count: usize) -> String {
    values.iter().map(|value| decimals(*value, count)).collect::<Vec<_>>().join(", ")
}

pub use funicular::counted;

/// Text of a file made fit for names and comments: one line, no hidden characters, limited length.
pub fn clean(text: &str) -> String {
    const MAX_LENGTH: usize = 200;
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    line.chars().filter(|c| !is_hidden(*c)).take(MAX_LENGTH).collect()
}

/// Number with its unit, "1" of a ratio left out.
pub fn with_unit(number: &str, unit: &str) -> String {
    if unit == "1" { number.to_owned() } else { format!("{number} {unit}") }
}

/// Title of a column or an axis with its unit in brackets, "1" of a ratio left out.
pub fn titled(title: &str, unit: &str) -> String {
    if unit == "1" { title.to_owned() } else { format!("{title} [{unit}]") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_as_said() {
        assert_eq!(decimals(-0.0001, 2), "0.00");
        assert_eq!(decimals(-0.016, 2), "-0.02");
        assert_eq!(significant(1234.5678, 6), "1234.57");
        assert_eq!(significant(-0.000_012_345, 3), "-1.23e-5");
        assert_eq!(significant(1.5e9, 4), "1.500e9");
        assert_eq!(significant(0.0, 4), "0");
        assert_eq!(short(10.55, 6), "10.55");
        assert_eq!(short(100.0, 6), "100");
    }

    #[test]
    fn a_value_has_the_digits_of_its_deviation() {
        let written = |value: f64, deviation| significant(value, digits_for(value, deviation));
        assert_eq!(written(63.8634, Some(0.11)), "63.86");
        assert_eq!(written(-0.012_000_4, Some(6.9e-6)), "-0.012000");
        assert_eq!(written(2.0, Some(30.0)), "2.0");
        for deviation in [None, Some(0.0)] {
            assert_eq!(written(1.25, deviation), "1.25000");
        }
        assert_eq!(digits_for(0.0, Some(1.0)), 6);
    }

    #[test]
    fn counted_nouns_have_their_plural() {
        for (count, noun, text) in [
            (1, "natural frequency", "1 natural frequency"),
            (2, "natural frequency", "2 natural frequencies"),
            (0, "mass", "0 masses"),
            (3, "mode", "3 modes"),
            (2, "day", "2 days"),
        ] {
            assert_eq!(counted(count, noun), text);
        }
    }

    #[test]
    fn clean_text_is_one_short_line() {
        assert_eq!(clean(" a\n\tb\u{7}c "), "a bc");
        assert_eq!(clean(&"x".repeat(10_000)).len(), 200);
    }
}
