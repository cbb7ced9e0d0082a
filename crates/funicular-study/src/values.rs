//! Checks of numbers in requests, one rule for all front ends.

use thiserror::Error;

/// Minimum of a quantity that has to be positive, the same as in robot files.
pub const MIN_POSITIVE: f64 = 1e-12;

/// Maximum magnitude of any number, the same as in robot files. Below it no product in the analyses overflows.
pub const MAX_MAGNITUDE: f64 = 1e12;

/// Text that is not a number, or a number that is not usable.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum NumberError {
    /// Empty text.
    #[error("a number is missing")]
    Missing,
    /// Text that is not a number.
    #[error("`{0}` is not a number (write it without its unit, with a point for decimals)")]
    NotANumber(String),
    /// NaN or infinite.
    #[error("{0} is not a finite number")]
    NotFinite(String),
    /// Magnitude above the limit.
    #[error("{0} is beyond {MAX_MAGNITUDE:e} in magnitude")]
    TooLarge(String),
}

/// Reads a finite number with a magnitude of at most [`MAX_MAGNITUDE`] from a text.
///
/// # Errors
/// [`NumberError`].
pub fn number(text: &str) -> Result<f64, NumberError> {
    let text = text.trim();
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value.abs() <= MAX_MAGNITUDE => Ok(value),
        Ok(value) if value.is_finite() => Err(NumberError::TooLarge(text.to_owned())),
        Ok(_) => Err(NumberError::NotFinite(text.to_owned())),
        Err(_) if text.is_empty() => Err(NumberError::Missing),
        Err(_) => Err(NumberError::NotANumber(text.to_owned())),
    }
}

/// Checks that a number is finite with a magnitude of at most [`MAX_MAGNITUDE`].
///
/// # Errors
/// A message that says what is wrong with the value.
pub fn finite(value: f64) -> Result<f64, String> {
    if value.abs() <= MAX_MAGNITUDE {
        return Ok(value);
    }
    // `number` makes the message. A printed number is read back as the same number.
    number(&format!("{value:?}")).map_err(|error| error.to_string())
}

/// True for a number that can be written without an exponent: it has no long row of zeros.
pub(crate) fn is_short(value: f64) -> bool {
    value == 0.0 || (1e-15..1e21).contains(&value.abs())
}

/// Number as a user writes it, with an exponent in place of a long row of zeros.
fn written(value: f64) -> String {
    if is_short(value) { value.to_string() } else { format!("{value:e}") }
}

/// Checks that a number is a fraction of something: above 0, at most 1.
///
/// # Errors
/// A message that says what is wrong with the value.
pub fn fraction(value: f64) -> Result<f64, String> {
    let value = positive(value)?;
    if value <= 1.0 { Ok(value) } else { Err(format!("{value} is above 1: give a fraction, as 0.5 for 50 %")) }
}

/// Checks that a number is at least [`MIN_POSITIVE`].
///
/// # Errors
/// A message that says what is wrong with the value.
pub fn positive(value: f64) -> Result<f64, String> {
    match finite(value)? {
        value if value >= MIN_POSITIVE => Ok(value),
        value if value > 0.0 => Err(format!("{value:e} is too small, it must be at least {MIN_POSITIVE:e}")),
        value => Err(format!("{} is not positive", written(value))),
    }
}

/// Checks that a number is zero or more.
///
/// # Errors
/// A message that says what is wrong with the value.
pub fn not_negative(value: f64) -> Result<f64, String> {
    match finite(value)? {
        value if value >= 0.0 => Ok(value),
        value => Err(format!("{} is negative", written(value))),
    }
}
