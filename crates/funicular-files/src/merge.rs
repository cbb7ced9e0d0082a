//! Merging of the parts of a sweep into the file that a single run would have written.

use crate::parquet::ParquetFile;
use crate::{FilesError, Format, Guard, Rows, behind_link, resumable_writer, write_complete};
use funicular_study::table::{Chunk, Column, ColumnKind, Part, Record, SCHEMA};
use serde_json::Value;
use std::collections::HashSet;
use std::io;
use std::path::{Path, PathBuf};

/// Writes the rows of all parts of a sweep to one file, byte for byte the file of a single run; the parts may be given
/// in any order. Returns the number of rows.
///
/// # Errors
/// [`FilesError`]: files that are no parts; parts that are missing, given twice, incomplete or of another sweep.
pub fn merge(parts: &[PathBuf], to: &Path) -> Result<usize, FilesError> {
    let format = Format::of(to)?;

    // No part may be overwritten.
    let mut guard = Guard::default();
    for part in parts {
        guard.reads("the part", part);
    }
    guard.writes_rows(to, false)?;

    // The first part gives the record that all others have to match.
    let mut files = Vec::with_capacity(parts.len());
    for path in parts {
        files.push((path, ParquetFile::open(path)?));
    }
    let Some((first_path, first)) = files.first() else {
        return Err(FilesError::Parts("there are no parts to merge".to_owned()));
    };
    let record = record_of(first, first_path)?;
    resumable_writer::check_place(to, format, &record)?;

    let mut found: Vec<(Part, ParquetFile)> = Vec::with_capacity(files.len());
    for (path, file) in files {
        found.push((checked(&record, path, &file, &found)?, file));
    }
    found.sort_by_key(|(part, _)| part.number);
    refuse_missing(&found)?;

    let to = behind_link(to);
    let rows = PartRows { record: &record, parts: &found };
    write_complete(&to, format, &record, &rows, true).map_err(|cause| FilesError::Write {
        path: to.clone(),
        saved: format!("the parts are unchanged: {}, then merge again", crate::to_do(&cause)),
        cause,
    })?;
    Ok(record.rows)
}

/// Refuses a set of parts with gaps, and lists the missing parts.
fn refuse_missing(found: &[(Part, ParquetFile)]) -> Result<(), FilesError> {
    const SHOWN: usize = 10;
    let of = found.first().map_or(0, |(part, _)| part.of);
    let there: HashSet<usize> = found.iter().map(|(part, _)| part.number).collect();
    let missing: Vec<String> = (1..=of).filter(|k| !there.contains(k)).map(|k| format!("{k}/{of}")).collect();
    if missing.is_empty() {
        return Ok(());
    }
    let more = if missing.len() > SHOWN { ", …" } else { "" };
    let (noun, is) = if missing.len() == 1 { ("part", "is") } else { ("parts", "are") };
    let listed = missing.iter().take(SHOWN).map(String::as_str).collect::<Vec<_>>().join(", ");
    Err(FilesError::Parts(format!("{noun} {listed}{more} {is} missing: give all {of} parts")))
}

/// Part that a file holds, after a check against the record and the parts found before.
fn checked(
    record: &Record,
    path: &Path,
    file: &ParquetFile,
    before: &[(Part, ParquetFile)],
) -> Result<Part, FilesError> {
    let shown = path.display();
    if let Some(difference) = record.difference(&file.json, &file.robot_file) {
        let advice = "merge the parts of one command";
        return Err(FilesError::Foreign { path: path.to_owned(), difference, advice });
    }

    let Some(part) = file.part else {
        return Err(FilesError::Parts(format!("{shown} is no part: it is a complete sweep, written without ⟪part⟫")));
    };

    if !file.complete || file.rows != record.rows_of(part.range(record.chunks())) {
        return Err(FilesError::Parts(format!(
            "{shown} (part {part}) is incomplete: repeat the command that began it with ⟪resume⟫"
        )));
    }

    if let Some((other, _)) = before.first().filter(|(other, _)| other.of != part.of) {
        return Err(FilesError::Parts(format!("{shown} is part {part}, but other files are parts of {}", other.of)));
    }
    if before.iter().any(|(other, _)| other.number == part.number) {
        return Err(FilesError::Parts(format!("part {part} is given twice, the second time as {shown}")));
    }
    Ok(part)
}

/// Rows of all parts, in the order of the sweep.
struct PartRows<'a> {
    record: &'a Record,
    parts: &'a [(Part, ParquetFile)],
}

impl Rows for PartRows<'_> {
    fn each(&self, take: &mut dyn FnMut(Chunk) -> io::Result<()>) -> io::Result<()> {
        self.parts.iter().try_for_each(|(part, file)| {
            file.each(part.range(self.record.chunks()).start, self.record.chunk_rows, &mut |chunk| {
                self.record.check(&chunk)?;
                take(chunk)
            })
        })
    }
}

/// Record in a file's metadata, without the part.
pub(crate) fn record_of(file: &ParquetFile, path: &Path) -> Result<Record, FilesError> {
    let json = &file.json;
    let not_ours = |reason: String| FilesError::NotOurs { path: path.to_owned(), reason };
    if json["schema"] != SCHEMA {
        return Err(not_ours(format!("its format is {}, this program reads \"{SCHEMA}\"", json["schema"])));
    }
    let read = || {
        let number = |key: &str| json[key].as_u64().and_then(|n| usize::try_from(n).ok());
        let columns: Option<Vec<Column>> = json["columns"].as_array()?.iter().map(column).collect();
        Some(Record {
            robot_file: file.robot_file.clone(),
            plan: json["plan"].as_object()?.clone(),
            columns: columns?,
            rows: number("rows")?,
            chunk_rows: number("chunk_rows").filter(|rows| *rows > 0)?,
            part: None,
        })
    };
    read().ok_or_else(|| not_ours("its metadata are damaged".to_owned()))
}

fn column(json: &Value) -> Option<Column> {
    let text = |key: &str| json[key].as_str();
    let kind = match text("kind")? {
        "real" => ColumnKind::Real,
        "flag" => ColumnKind::Flag,
        "text" => ColumnKind::Text,
        _ => return None,
    };
    let (name, unit, about) = (text("name")?.to_owned(), text("unit")?.to_owned(), text("about")?.to_owned());
    Some(Column { name, unit: unit.into(), about, kind })
}
