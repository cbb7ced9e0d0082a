//! Line numbers of the records of a CSV text, for messages.

/// Line number of a record, from 1. It is counted here, because the position of the reader points to the end of the
/// previous record, before blank lines, and does not count all kinds of line ends.
pub fn line_at(bytes: &[u8], position: &csv::Position) -> usize {
    let from = usize::try_from(position.byte()).unwrap_or(bytes.len()).min(bytes.len());
    let ends = |byte: &u8| matches!(byte, b'\r' | b'\n');
    let begin = from + bytes[from..].iter().take_while(|byte| ends(byte)).count();
    let ends_line = |i: &usize| bytes[*i] == b'\n' || (bytes[*i] == b'\r' && bytes.get(i + 1) != Some(&b'\n'));
    1 + (0..begin).filter(ends_line).count()
}
