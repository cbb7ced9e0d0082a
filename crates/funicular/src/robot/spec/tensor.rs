//! Symmetric tensors of three rows: three numbers on the diagonal, or three rows of three numbers.

use super::range::Range;
use super::read::{Reader, Value};
use crate::math::{Mat3, Vec3, symmetric_part};
use toml::de::DeValue;

/// Maximum difference of mirrored entries, relative to the largest entry: far above rounding, far below the digits of
/// any published tensor.
const SLACK: f64 = 1e-9;

/// Reads a tensor with positive numbers on the diagonal, or three rows of three numbers, which must be symmetric.
pub(super) fn read(reader: &mut Reader, key: &str, unit: &str, value: &Value) -> Option<Mat3> {
    let label = &format!("`{key}`");
    let rows = reader.three(label, &format!("three numbers or three rows of three, in {unit}"), value)?;
    if !rows.iter().any(|row| matches!(row.get_ref(), DeValue::Array(_))) {
        return Some(Mat3::from_diagonal(&Vec3::from(reader.three_numbers(label, Range::Positive, rows)?)));
    }

    let mut tensor = Mat3::zeros();
    let mut elements = [[value; 3]; 3];
    let mut complete = true;
    for (i, row) in rows.into_iter().enumerate() {
        let row_label = format!("row {} of {label}", i + 1);
        let Some(three) = reader.three(&row_label, &format!("three numbers in {unit}"), row) else {
            complete = false;
            continue;
        };
        elements[i] = three;
        match reader.three_numbers(&row_label, Range::Any, three) {
            Some(numbers) => (0..3).for_each(|j| tensor[(i, j)] = numbers[j]),
            None => complete = false,
        }
    }
    if complete { symmetric(reader, key, &tensor, &elements) } else { None }
}

/// Symmetric part of the tensor, after a check that the two halves differ by rounding only.
fn symmetric(reader: &mut Reader, key: &str, tensor: &Mat3, elements: &[[&Value; 3]; 3]) -> Option<Mat3> {
    for (i, j) in [(1, 0), (2, 0), (2, 1)] {
        let [lower, upper] = [tensor[(i, j)], tensor[(j, i)]];
        if (lower - upper).abs() > SLACK * tensor.amax() {
            reader
                .issue(
                    elements[i][j].span(),
                    format!(
                        "`{key}` is not symmetric: row {}, column {} is {}, its mirror is {}",
                        i + 1,
                        j + 1,
                        all_digits(lower),
                        all_digits(upper)
                    ),
                )
                .context(elements[j][i].span(), "the mirror");
            return None;
        }
    }
    Some(symmetric_part(tensor))
}

/// Value with four significant digits, for a message.
pub(super) fn short(value: f64) -> String {
    all_digits(rounded(value, 4))
}

/// Number with all its digits.
fn all_digits(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) { format!("{value}") } else { format!("{value:e}") }
}

/// Value with a number of significant digits.
pub(super) fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}
