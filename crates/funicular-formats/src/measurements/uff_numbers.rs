//! Lines and numbers of a Universal File: fields by columns, as Fortran writes and reads them.

use anyhow::{Result, anyhow, bail};
use std::borrow::Cow;

/// Position in the bytes of a file.
#[derive(Debug, Clone)]
pub(super) struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Number of the line that was read last, from 1. Bytes of binary bodies do not count.
    pub(super) number: usize,
}

impl<'a> Lines<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, number: 0 }
    }

    /// Next line without its end, which is `\n` or `\r\n`; `None` at the end of the file.
    pub(super) fn next(&mut self) -> Option<&'a [u8]> {
        let rest = self.bytes.get(self.at..).filter(|rest| !rest.is_empty())?;
        let end = rest.iter().position(|byte| *byte == b'\n');
        self.at += end.map_or(rest.len(), |end| end + 1);
        self.number += 1;
        let line = &rest[..end.unwrap_or(rest.len())];
        Some(line.strip_suffix(b"\r").unwrap_or(line))
    }

    /// Next line of a dataset.
    ///
    /// # Errors
    /// The end of the file.
    pub(super) fn expect(&mut self, what: &str) -> Result<Line<'a>> {
        let number = self.number + 1;
        let bytes = self.next().ok_or_else(|| anyhow!("line {number}: the file ends where {what} is expected"))?;
        Ok(Line { bytes, number })
    }

    /// Bytes of a binary body.
    ///
    /// # Errors
    /// A file that has fewer bytes.
    pub(super) fn take(&mut self, count: usize) -> Result<&'a [u8]> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        if count > rest.len() {
            bail!(
                "line {}: the file ends after {} of {count} bytes of binary data: it is cut off",
                self.number,
                rest.len()
            );
        }
        self.at += count;
        Ok(&rest[..count])
    }

    /// True if a dataset's closing line stands behind so many bytes.
    pub(super) fn closes_after(&self, count: usize) -> bool {
        let Some(rest) = self.at.checked_add(count).and_then(|end| self.bytes.get(end..)) else { return false };
        let mut behind = Self { bytes: rest, at: 0, number: 0 };
        behind.skip_line_end();
        behind.next().is_some_and(is_delimiter)
    }

    /// Skips the end of a line that follows a binary body, if there is one.
    pub(super) fn skip_line_end(&mut self) {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        self.at += if rest.starts_with(b"\r\n") { 2 } else { usize::from(rest.starts_with(b"\n")) };
    }
}

/// True for the line `    -1` that begins and ends every dataset.
pub(super) fn is_delimiter(line: &[u8]) -> bool {
    let line = line.trim_ascii_end();
    line.len() <= 6 && line.trim_ascii_start() == b"-1"
}

/// Line with its number, for messages.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) number: usize,
}

impl Line<'_> {
    /// Text of the columns, without blanks around it. Bytes that are not UTF-8 are windows-1252, in which western
    /// European Windows programs write `µ` and `°`.
    pub(super) fn text(&self, from: usize, to: usize) -> String {
        let bytes = self.bytes.get(from..to.min(self.bytes.len())).unwrap_or_default();
        let text = std::str::from_utf8(bytes)
            .map_or_else(|_| encoding_rs::WINDOWS_1252.decode_without_bom_handling(bytes).0, Cow::Borrowed);
        text.trim().to_owned()
    }

    /// Whole number in the columns; blank is 0.
    ///
    /// # Errors
    /// A text that is no whole number.
    pub(super) fn whole(&self, from: usize, to: usize) -> Result<i64> {
        let text = self.text(from, to);
        if text.is_empty() {
            return Ok(0);
        }
        text.parse().map_err(|_| {
            anyhow!("line {}: `{text}` in columns {} to {to} is not a whole number", self.number, from + 1)
        })
    }

    /// Number in the columns; blank is 0.
    ///
    /// # Errors
    /// A text that is no finite number.
    pub(super) fn real(&self, from: usize, to: usize) -> Result<f64> {
        let text = self.text(from, to);
        if text.is_empty() {
            return Ok(0.0);
        }
        fortran(&text)
            .filter(|number| number.is_finite())
            .ok_or_else(|| anyhow!("line {}: `{text}` in columns {} to {to} is not a number", self.number, from + 1))
    }

    /// True if nothing stands at or behind a column.
    pub(super) fn is_blank_from(&self, from: usize) -> bool {
        self.bytes.get(from..).unwrap_or_default().trim_ascii().is_empty()
    }
}

/// Number as Fortran writes it: `1.5D+03`, `1.5E+03`, or without the letter before an exponent of three digits,
/// `1.5-100`.
fn fortran(text: &str) -> Option<f64> {
    let text = text.replace(['D', 'd'], "E");
    if let Ok(number) = text.parse() {
        return Some(number);
    }
    let sign = text.char_indices().skip(1).find(|(_, c)| matches!(c, '+' | '-'))?.0;
    let (mantissa, exponent) = text.split_at_checked(sign)?;
    if mantissa.contains(['E', 'e']) { None } else { format!("{mantissa}E{exponent}").parse().ok() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_fortran_reads_them() {
        for (text, value) in
            [("1.5D+03", 1500.0), ("-1.5E-03", -0.0015), ("1.5-100", 1.5e-100), ("-2.0+100", -2e100), ("7", 7.0)]
        {
            assert_eq!(fortran(text), Some(value), "{text}");
        }
        for bad in ["", "x", "1.5E", "1e5-3", "--1", "1,5"] {
            assert_eq!(fortran(bad), None, "{bad}");
        }
    }

    #[test]
    fn fields_are_columns_and_may_touch() {
        let line = Line { bytes: b"  1.00000E+00-2.00000E+00", number: 3 };
        let fields = [(0, 13), (13, 26), (26, 39)].map(|(from, to)| line.real(from, to).unwrap());
        assert_eq!(fields.iter().map(f64::to_string).collect::<Vec<_>>(), ["1", "-2", "0"]);
        assert!(line.whole(0, 13).unwrap_err().to_string().starts_with("line 3: `1.00000E+00` in columns 1 to 13"));
    }
}
