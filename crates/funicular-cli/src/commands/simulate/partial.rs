//! Rows and state of a simulation that has not ended, in FILE.csv.partial and FILE.csv.partial.state. A run that is
//! killed is continued from them.

use crate::errors;
use anyhow::{Context, Result, bail};
use funicular_answers::outputs::as_csv;
use funicular_files::atomic_file::TemporaryFile;
use funicular_files::endings::Kind;
use funicular_files::{Begin, Checksum, Guard};
use funicular_formats::number_columns;
use funicular_study::analyses::simulate::{BegunRun, RowKeeper, RowNames, SimulatedRow};
use funicular_study::columns::ResultTable;
use funicular_study::request::SimulateRequest;
use std::fs::{self, File, OpenOptions};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Time after which rows that are ready, and the state after them, are on the disk.
const FLUSH: Duration = Duration::from_secs(1);
/// First bytes of a state. The version of the program follows, because another one may have other numbers in it. The
/// request stands in the next line, then follow the checksum of the rows and the numbers, 4 bytes, and the numbers:
/// the count of rows and the state.
const MARK: &str = concat!("funicular simulate 2, ", env!("CARGO_PKG_VERSION"), "\n");

/// Files of a run that has not ended; none for a result that is no CSV file.
pub(in crate::commands) struct PartialRows {
    files: Option<OpenFiles>,
    names: RowNames,
    /// Request whose rows these are, as it stands in the state.
    request: String,
    flushed: Instant,
}

struct OpenFiles {
    /// File of the rows; none before the first one, so that a run that is refused leaves no file.
    rows: Option<BufWriter<File>>,
    /// Checksum of the rows so far, the header included.
    sum: Checksum,
    path: PathBuf,
    state: PathBuf,
}

impl OpenFiles {
    fn write(&mut self, bytes: &[u8]) -> Result<()> {
        let cannot = || format!("cannot write {}", self.path.display());
        let rows = match &mut self.rows {
            Some(rows) => rows,
            None => self.rows.insert(BufWriter::new(File::create(&self.path).with_context(cannot)?)),
        };
        self.sum.update(bytes);
        rows.write_all(bytes).with_context(cannot)
    }
}

impl PartialRows {
    /// Files beside the result, with the run that has begun if it is to be continued.
    pub(in crate::commands) fn beside(
        path: Option<&Path>,
        of: &SimulateRequest,
        names: RowNames,
        earlier: Begin,
        guard: &mut Guard,
    ) -> Result<(Self, Option<BegunRun>)> {
        let request = serde_json::to_string(of)?;
        let mut partial = Self { files: None, names, request, flushed: Instant::now() };
        let Some(path) = path.filter(|path| Kind::of(path) == Some(Kind::Csv)) else {
            if earlier != Begin::Anew {
                bail!("only a CSV file is written as it grows: give -o FILE.csv, or leave out ⟪resume⟫ and ⟪discard⟫");
            }
            return Ok((partial, None));
        };
        let [path, state] = [".partial", ".partial.state"].map(|ending| {
            let mut name = path.as_os_str().to_owned();
            name.push(ending);
            PathBuf::from(name)
        });
        guard.writes("the rows", &path)?;
        guard.writes("the state", &state)?;
        let shown = path.display();
        let begun = match earlier {
            Begin::Resume => partial.begun(&path, &state)?,
            Begin::Anew if path.exists() => {
                bail!("{shown} has the rows of a run that did not end: give ⟪resume⟫ or ⟪discard⟫")
            }
            _ => None,
        };
        let mut files = OpenFiles { rows: None, sum: Checksum::new(), path, state };
        if let Some(begun) = &begun {
            // Rows after the state are computed again.
            let cannot = || format!("cannot write {}", files.path.display());
            let text = fs::read(&files.path).with_context(cannot)?;
            let kept = begun_bytes(&text, begun.rows.len());
            let mut file = OpenOptions::new().append(true).open(&files.path).with_context(cannot)?;
            file.set_len(kept as u64).with_context(cannot)?;
            file.flush().with_context(cannot)?;
            files.sum.update(&text[..kept]);
            files.rows = Some(BufWriter::new(file));
            errors::note(&format!("continuing after {} rows", begun.rows.len()));
        } else if earlier == Begin::Discard {
            let _ = fs::remove_file(&files.path);
            let _ = fs::remove_file(&files.state);
        }
        partial.files = Some(files);
        Ok((partial, begun))
    }

    /// Run in the files; `None` if it was interrupted before its first state.
    fn begun(&self, path: &Path, state: &Path) -> Result<Option<BegunRun>> {
        if !path.exists() || !state.exists() {
            return Ok(None);
        }
        let shown = state.display();
        let bytes = fs::read(state).with_context(|| format!("cannot read {shown}"))?;
        let head = format!("{MARK}{}\n", self.request);
        let Some(numbers) = bytes.strip_prefix(head.as_bytes()) else {
            bail!("{shown} belongs to another request or version: repeat the same command, or give ⟪discard⟫");
        };
        let (sum, numbers) = numbers.split_at_checked(4).unwrap_or_default();
        let mut each = numbers.chunks_exact(8).map(|part| f64::from_le_bytes(part.try_into().unwrap_or_default()));
        let count = each.next().unwrap_or_default() as usize;
        // The last line may be a part of a row.
        let text = fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
        let whole = &text[..begun_bytes(&text, count)];
        let mut found = Checksum::new();
        found.update(whole);
        found.update(numbers);
        if found.finalize().to_le_bytes() != sum {
            let rows = path.display();
            bail!(
                "{shown} or {rows} is damaged, because their checksum is another one: give ⟪discard⟫ and begin again"
            );
        }
        let table = number_columns::read(&path.display().to_string(), whole)?.columns;
        let names = SimulatedRow::columns(&self.names).described();
        let row = |k: usize| {
            let of_row: Option<Vec<f64>> =
                names.iter().map(|column| table.get(column.name.as_str())?.get(k).copied()).collect();
            SimulatedRow::of_numbers(&of_row?, &self.names)
        };
        let rows: Option<Vec<SimulatedRow>> = (0..count).map(row).collect();
        let Some(rows) = rows else { bail!("{} has lost rows: give ⟪discard⟫", path.display()) };
        Ok(Some(BegunRun { rows, state: each.collect() }))
    }

    /// Removes the files after the whole result has been written.
    pub(in crate::commands) fn remove(self) {
        if let Some(OpenFiles { rows, path, state, .. }) = self.files {
            drop(rows);
            // The result is complete; files that stay do no harm.
            let _ = fs::remove_file(path);
            let _ = fs::remove_file(state);
        }
    }
}

/// Bytes of the header and of so many rows.
fn begun_bytes(text: &[u8], rows: usize) -> usize {
    let ends = text.iter().enumerate().filter(|(_, byte)| **byte == b'\n').map(|(at, _)| at + 1);
    ends.take(rows + 1).last().unwrap_or_default()
}

impl RowKeeper for PartialRows {
    fn row(&mut self, row: &SimulatedRow) -> Result<()> {
        let Some(files) = &mut self.files else { return Ok(()) };
        let csv = as_csv(ResultTable::new(SimulatedRow::columns(&self.names), [row]))?;
        // The header stands before the first row only.
        let header = csv.iter().position(|byte| *byte == b'\n').map_or(0, |end| end + 1);
        files.write(&csv[if files.rows.is_none() { 0 } else { header }..])
    }

    fn state(&mut self, count: usize, state: &[f64]) -> Result<()> {
        let Some(OpenFiles { rows: Some(rows), sum, path, state: to }) = &mut self.files else { return Ok(()) };
        if self.flushed.elapsed() < FLUSH {
            return Ok(());
        }
        rows.flush().with_context(|| format!("cannot write {}", path.display()))?;
        let cannot = || format!("cannot write {}", to.display());
        let mut file = TemporaryFile::beside(to).with_context(cannot)?;
        let numbers: Vec<u8> =
            [count as f64].into_iter().chain(state.iter().copied()).flat_map(f64::to_le_bytes).collect();
        let mut sum = sum.clone();
        sum.update(&numbers);
        let bytes = [format!("{MARK}{}\n", self.request).as_bytes(), &sum.finalize().to_le_bytes(), &numbers].concat();
        file.as_file_mut().write_all(&bytes).with_context(cannot)?;
        file.persist(to).with_context(cannot)?;
        self.flushed = Instant::now();
        Ok(())
    }
}
