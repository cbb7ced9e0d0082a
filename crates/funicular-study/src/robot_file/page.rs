//! Part of docs/robot-file.md with all keys, made from the table of keys.

use funicular::robot::spec::key::{Absent, Key, KeyValue, Shape, Table};
use funicular::robot::spec::{TABLES, top_of_file};
use std::fmt::Write;

/// All tables of keys in Markdown.
pub fn keys() -> String {
    let mut out = String::new();
    for table in TABLES {
        of_table(&mut out, table);
    }
    out
}

/// Heading and rows of a table.
fn of_table(out: &mut String, table: &Table) {
    let heading =
        if table.header.starts_with('[') { format!("`{}`", table.header) } else { "Top of the file".to_owned() };
    let _ = writeln!(out, "### {heading}\n");
    if let Some(about) = about_table(table) {
        let _ = writeln!(out, "{about}.\n");
    }
    let _ = writeln!(out, "| Key | Value | Unit | Range | If it is absent | Meaning |\n|---|---|---|---|---|---|");
    for key in table.keys {
        let (unit, range) = match key.each_number() {
            Some(numbers) => (numbers.unit, numbers.range.to_string()),
            None => ("", String::new()),
        };
        let cells = [format!("`{}`", key.name), value(key), unit.to_owned(), range, absent(key), key.about.to_owned()];
        let _ = writeln!(out, "| {} |", cells.map(|cell| cell.replace('|', "\\|")).join(" | "));
    }
    out.push('\n');

    for key in table.keys {
        if let KeyValue::Word(words) = &key.value {
            let _ = writeln!(out, "Values of `{}`:\n", key.name);
            for (word, meaning) in *words {
                let _ = writeln!(out, "- `\"{word}\"`: {meaning}");
            }
            out.push('\n');
        }
    }
}

/// Meaning of a table and the effect of its absence, from its key at the top of the file.
fn about_table(table: &Table) -> Option<String> {
    let name = table.header.trim_matches(['[', ']']).split('.').next()?;
    let key = top_of_file().keys.iter().find(|key| key.name == name)?;
    let mut letters = key.about.chars();
    let capital: String = letters.next()?.to_uppercase().chain(letters).collect();
    Some(match key.absent {
        Absent::Means(text) => format!("{capital}. If the table is absent: {text}"),
        _ => capital,
    })
}

/// Kind of the value of a key.
fn value(key: &Key) -> String {
    match &key.value {
        KeyValue::Name | KeyValue::Text => "text".to_owned(),
        KeyValue::Word(_) => "one of the words below".to_owned(),
        KeyValue::Table => format!("table `[{}]`", key.name),
        KeyValue::NamedTables => format!("tables `[{}.NAME]`", key.name),
        KeyValue::Tables => format!("tables `[[{}]]`", key.name),
        KeyValue::Numbers(numbers) => match numbers.shape {
            Shape::Number => "number".to_owned(),
            Shape::Vector => "[x, y, z]".to_owned(),
            Shape::Angles => "[roll, pitch, yaw]".to_owned(),
            Shape::Tensor => "number, [xx, yy, zz], or three rows".to_owned(),
        },
        KeyValue::NumberList(_) => "list of numbers".to_owned(),
    }
}

/// Effect of a key that the file leaves out.
fn absent(key: &Key) -> String {
    match key.absent {
        Absent::Refused => "required".to_owned(),
        Absent::Depends(text) | Absent::Means(text) => text.to_owned(),
        Absent::DefaultWord(word) => format!("`\"{word}\"`"),
        Absent::Default(numbers) => match key.numeric_value().map(|numbers| numbers.shape) {
            Some(Shape::Number) => format!("{}", numbers[0]),
            _ => format!("[{}, {}, {}]", numbers[0], numbers[1], numbers[2]),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines around the generated part of the page.
    const MARKS: [&str; 2] = ["<!-- keys: begin -->\n", "<!-- keys: end -->"];

    #[test]
    fn the_page_of_the_robot_file_has_the_keys_of_the_reader() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/robot-file.md");
        let page = std::fs::read_to_string(file).unwrap();
        let (before, rest) = page.split_once(MARKS[0]).unwrap();
        let (written, after) = rest.split_once(MARKS[1]).unwrap();
        let made = format!("\n{}", keys());
        if std::env::var_os("UPDATE_DOCS").is_some() {
            std::fs::write(file, [before, MARKS[0], &made, MARKS[1], after].concat()).unwrap();
            return;
        }
        assert!(
            written == made,
            "docs/robot-file.md differs from the table of keys; write it anew with `UPDATE_DOCS=1 cargo test -p \
             funicular-study robot_file`"
        );
        for table in TABLES {
            assert!(table.keys.iter().all(|key| made.contains(&format!("| `{}` | ", key.name))));
        }
    }
}
