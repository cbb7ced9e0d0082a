//! Words of a line of G-code: a letter and a number each.

use funicular_study::values::number;

/// Words of one line. Codes are in tenths, so that G90.1 is 901.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Block {
    pub(super) g: Vec<u32>,
    pub(super) m: Vec<u32>,
    others: Vec<(char, f64)>,
}

impl Block {
    /// Number of a word.
    pub(super) fn value(&self, letter: char) -> Option<f64> {
        self.others.iter().find(|(of, _)| *of == letter).map(|(_, value)| *value)
    }
}

/// Letters that a job may have besides G, M and N.
const LETTERS: &str = "XYZIJKRFPSTHDE";

/// Largest code of G or M.
const MAX_CODE: f64 = 1000.0;

/// Code as it is written.
pub(super) fn shown(tenths: u32) -> String {
    if tenths.is_multiple_of(10) { (tenths / 10).to_string() } else { format!("{}.{}", tenths / 10, tenths % 10) }
}

/// Reads a line. Comments, line numbers, checksums and the marks `%` and `/` are left out.
///
/// # Errors
/// A comment without end, a word without number, a letter twice, or one that a job does not have.
pub(super) fn block(line: &str) -> Result<Block, String> {
    let text = without_comments(line)?;
    let mut block = Block::default();
    let mut rest = text.as_str();
    while let Some(letter) = rest.chars().next() {
        rest = &rest[letter.len_utf8()..];
        let end = rest.find(|c: char| !matches!(c, '0'..='9' | '.' | '+' | '-')).unwrap_or(rest.len());
        let (digits, after) = rest.split_at(end);
        rest = after;
        if !letter.is_ascii_uppercase() {
            return Err(format!("`{letter}` begins no word of G-code: expressions and variables are not followed"));
        }
        if letter == 'O' && block == Block::default() {
            return Ok(block);
        }
        let value = number(digits).map_err(|reason| format!("`{letter}{digits}`: {reason}"))?;
        match letter {
            'N' => {}
            'G' | 'M' => {
                let tenths = (value * 10.0).round();
                if !(0.0..=MAX_CODE * 10.0).contains(&tenths) || (value * 10.0 - tenths).abs() > 1e-9 {
                    return Err(format!("`{letter}{digits}` is no code that can be followed"));
                }
                let codes = if letter == 'G' { &mut block.g } else { &mut block.m };
                codes.push(tenths as u32);
            }
            _ if !LETTERS.contains(letter) => {
                return Err(format!(
                    "`{letter}{digits}` cannot be followed: a job moves in X, Y and Z; leave other axes and words out"
                ));
            }
            _ if block.value(letter).is_some() => return Err(format!("`{letter}` is there twice")),
            _ => block.others.push((letter, value)),
        }
    }
    Ok(block)
}

/// Words of a line in capital letters without blanks.
fn without_comments(line: &str) -> Result<String, String> {
    let mut text = String::new();
    let mut is_comment = false;
    for c in line.chars() {
        match c {
            ')' if is_comment => is_comment = false,
            _ if is_comment => {}
            '(' => is_comment = true,
            // A checksum after `*` is of the transfer.
            ';' | '*' => break,
            '%' => return Ok(String::new()),
            c if c.is_whitespace() => {}
            '/' if text.is_empty() => {}
            c => text.push(c.to_ascii_uppercase()),
        }
    }
    if is_comment {
        return Err("a comment has no end: close it with `)`".to_owned());
    }
    Ok(text)
}
