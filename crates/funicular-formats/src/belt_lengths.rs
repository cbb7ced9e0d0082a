//! Readings of belt lengths as the firmware of the Maslow 4 and programs around it write them: lines
//! `CLBM:[{bl:2960.58, br:3150.08, tr:3067.72, tl:3049.85},…]` in a log, such objects without the mark, a list of them
//! in JSON, or JSON with `order` and `lengths_mm`. Lengths are in millimetres (github.com/MaslowCNC/Maslow_4,
//! DATA-PARSER.md at abfc930).

use crate::measurements::check_size;
use crate::number_table::NumberTable;
use anyhow::{Result, anyhow, bail};
use funicular_study::values::number;
use serde_json::Value;
use std::collections::BTreeMap;

/// Mark of a line with lengths in a log.
const MARK: &str = "CLBM";

/// Metres of the unit of all lengths.
const MILLIMETRE: f64 = 1e-3;

/// Lengths of one row by the names of their belts [mm].
type Lengths = BTreeMap<String, f64>;

/// True for a file with such readings: JSON, a text with a line of lengths, or one that begins with an object.
pub fn has_lengths(path: &str, bytes: &[u8]) -> bool {
    let is_json = path.rsplit_once('.').is_some_and(|(_, ending)| ending.eq_ignore_ascii_case("json"));
    let first = bytes.iter().find(|byte| !byte.is_ascii_whitespace());
    is_json || matches!(first, Some(b'{' | b'[')) || bytes.windows(MARK.len()).any(|part| part == MARK.as_bytes())
}

/// Reads the lengths of all rows as columns `length_NAME_m`; a belt that a row does not have is a gap.
///
/// # Errors
/// No lengths, or a length that is no number; the message names the line.
///
/// # Example
/// ```
/// let log = b"CLBM:[{bl:2000, br:3150.08},{bl:2500, br:3042.59}]\n";
/// let found = funicular_formats::belt_lengths::read("log.txt", log)?;
/// assert_eq!(found.columns["length_bl_m"], [Some(2.0), Some(2.5)]);
/// # Ok::<(), anyhow::Error>(())
/// ```
pub fn read(path: &str, bytes: &[u8]) -> Result<NumberTable<Option<f64>>> {
    check_size(path, bytes.len())?;
    let text = std::str::from_utf8(bytes).map_err(|_| anyhow!("{path}: the text is not valid UTF-8"))?;
    let rows = match (text.contains(MARK), serde_json::from_str(text)) {
        (true, _) => of_log(path, text, false)?,
        (false, Ok(value)) => of_json(path, &value)?,
        (false, Err(error)) if path.to_ascii_lowercase().ends_with(".json") => bail!("{path} is no JSON: {error}"),
        (false, Err(_)) => of_log(path, text, true)?,
    };
    if rows.is_empty() {
        bail!("{path} has no lengths: it needs rows such as {{bl:2960.58, br:3150.08, tr:3067.72, tl:3049.85}}");
    }

    let mut table = NumberTable::<Option<f64>>::default();
    for name in rows.iter().flat_map(|(_, lengths)| lengths.keys()) {
        let of_row = |(_, lengths): &(usize, Lengths)| lengths.get(name).map(|length| length * MILLIMETRE);
        table.columns.entry(format!("length_{name}_m")).or_insert_with(|| rows.iter().map(of_row).collect());
    }
    table.lines = rows.iter().map(|(line, _)| *line).collect();
    Ok(table)
}

/// Objects in the lines with the mark, and in those below as long as they hold objects; from the first line on if the
/// list `is_open` there.
fn of_log(path: &str, text: &str, mut is_open: bool) -> Result<Vec<(usize, Lengths)>> {
    let mut rows = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let part = match line.split_once(MARK) {
            Some((_, part)) => part,
            None if is_open && line.contains('{') => line,
            None => {
                is_open = false;
                continue;
            }
        };
        is_open = true;
        let mut rest = part;
        while let Some((_, after)) = rest.split_once('{') {
            let (inside, after) = after
                .split_once('}')
                .ok_or_else(|| anyhow!("{path}, line {number}: a row of lengths has no end: close it with `}}`"))?;
            rows.push((number, lengths(inside).map_err(|reason| anyhow!("{path}, line {number}: {reason}"))?));
            rest = after;
        }
    }
    Ok(rows)
}

/// Lengths of `bl:2960.58, br:3150.08`.
fn lengths(inside: &str) -> Result<Lengths, String> {
    let pairs = inside.split(',').map(str::trim).filter(|pair| !pair.is_empty());
    let mut found = Lengths::new();
    for pair in pairs {
        let (name, value) = pair.split_once(':').ok_or_else(|| format!("`{pair}` is no length: write NAME:LENGTH"))?;
        let name = name.trim().trim_matches(['"', '\'']).to_owned();
        let value = number(value).map_err(|reason| format!("the length of `{name}`: {reason}"))?;
        if found.insert(name.clone(), value).is_some() {
            return Err(format!("the length of `{name}` is there twice"));
        }
    }
    Ok(found)
}

/// Rows of a list of objects, or of lists in the order of the names.
fn of_json(path: &str, value: &Value) -> Result<Vec<(usize, Lengths)>> {
    let names: Option<Vec<&str>> =
        value.get("order").and_then(Value::as_array).map(|names| names.iter().filter_map(Value::as_str).collect());
    let rows = value.get("lengths_mm").unwrap_or(value).as_array().ok_or_else(|| {
        anyhow!("{path} has no list of lengths: give a list of objects with the length of every belt [mm] by its name")
    })?;
    let row = |(k, row): (usize, &Value)| {
        let fault = |reason: &str| anyhow!("{path}, row {k}: {reason}");
        let pairs: Vec<(String, &Value)> = match (row, &names) {
            (Value::Object(row), _) => row.iter().map(|(name, value)| (name.clone(), value)).collect(),
            (Value::Array(row), Some(names)) if row.len() == names.len() => {
                names.iter().map(|name| (*name).to_owned()).zip(row).collect()
            }
            _ => return Err(fault("it is neither an object nor a list with one length per name of `order`")),
        };
        let length = |(name, value): (String, &Value)| match value {
            Value::Null => None,
            value => Some(value.as_f64().map(|value| (name, value)).ok_or_else(|| fault("a length is no number"))),
        };
        Ok((k, pairs.into_iter().filter_map(length).collect::<Result<Lengths>>()?))
    };
    (1..).zip(rows).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn log_objects_and_lists_are_the_same_readings() {
        let log = "[MSG:INFO: Waypoint 2]\n[MSG:INFO: CLBM:[{bl:2960.58,   br:3150.08,   tl:3049.85},\n{bl:3066.96,  \
                   br:3042.59},]]\n<Idle|MPos:0,0>\n";
        let objects = r#"[{"bl": 2960.58, "br": 3150.08, "tl": 3049.85}, {"bl": 3066.96, "br": 3042.59, "tl": null}]"#;
        let lists = r#"{"order": ["bl", "br", "tl"],
            "lengths_mm": [[2960.58, 3150.08, 3049.85], [3066.96, 3042.59, null]]}"#;
        let plain = read("log.txt", log.as_bytes()).unwrap();
        assert_eq!(plain.columns["length_tl_m"], [Some(3049.85 * 1e-3), None]);
        assert_eq!((plain.columns.len(), &plain.lines[..]), (3, &[2, 3][..]));
        let bare = "{bl:2960.58,   br:3150.08,   tl:3049.85},\n{bl:3066.96, br:3042.59},\n";
        assert!(has_lengths("a.txt", bare.as_bytes()) && !has_lengths("a.csv", b"length_bl_m\n1\n"));
        assert_eq!(read("a.txt", bare.as_bytes()).unwrap().columns, plain.columns);
        for same in [objects, lists] {
            assert!(has_lengths("a.JSON", same.as_bytes()));
            assert_eq!(read("a.json", same.as_bytes()).unwrap().columns, plain.columns);
        }
        assert!(has_lengths("log.txt", log.as_bytes()) && !has_lengths("belts.csv", b"length_bl_m\n1\n"));
    }

    #[test]
    fn faults_are_named_with_their_line() {
        for (text, says) in [
            ("\nCLBM:[{bl:12,br:x}]", "log.txt, line 2: the length of `br`: "),
            ("CLBM:[{bl:12,bl:13}]", "`bl` is there twice"),
            ("CLBM:[{bl:12", "no end"),
            ("CLBM:[]", "no lengths"),
            ("CLBM:[{12}]", "`12` is no length"),
        ] {
            let told = read("log.txt", text.as_bytes()).unwrap_err().to_string();
            assert!(told.contains(says), "{told}");
        }
        for (text, says) in [("{}", "no list"), ("[[1]]", "row 1: it is neither"), ("[{\"a\": \"b\"}]", "no number")] {
            let told = read("a.json", text.as_bytes()).unwrap_err().to_string();
            assert!(told.contains(says), "{told}");
        }
    }
}
