//! Rows and state of a simulation that has not ended, in FILE.csv.partial and FILE.csv.partial.state. A run that is killed is
//! continued from them.

use crate::errors;
use anyhow::{Context, Result, bail};
use funicular_files::atomic_file::TemporaryFile;
use funicular_files::endings::Kind;
use funicular_files::{Begin, Guard};
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
/// First bytes of a state. The version of the program follows, because another one may have other numbers in it.
const MARK: &str = concat!("funicular simulate ", env!("CARGO_PKG_VERSION"), "\n");

/// Files of a run that has not ended; none for a result that is no CSV file.
pub(super) struct PartialRows {
    files: Option<OpenFiles>,
    names: RowNames,
    /// Request whose rows these are, as it stands in the state.
    request: String,
    flushed: Instant,
}

struct OpenFiles {
    rows: BufWriter<File>,
    path: PathBuf,
    state: PathBuf,
}

impl PartialRows {
    /// Files beside the result, with the run that has begun if it is to be continued.
    pub(super) fn beside(
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
        let cannot = || format!("cannot write {shown}");
        let file = if let Some(begun) = &begun {
            // Rows after the state are computed again.
            let kept = begun_bytes(&fs::read(&path)?, begun.rows.len());
            let mut file = OpenOptions::new().append(true).open(&path).with_context(cannot)?;
            file.set_len(kept as u64).with_context(cannot)?;
            file.flush().with_context(cannot)?;
            errors::note(&format!("continuing after {} rows", begun.rows.len()));
            file
        } else {
            let _ = fs::remove_file(&state);
            let mut file = File::create(&path).with_context(cannot)?;
            let header = SimulatedRow::columns(&partial.names);
            file.write_all(&crate::output::as_csv(ResultTable::new(header, [] as [&SimulatedRow; 0]))?)
                .with_context(cannot)?;
            file
        };
        partial.files = Some(OpenFiles { rows: BufWriter::new(file), path, state });
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
        let mut numbers = numbers.chunks_exact(8).map(|part| f64::from_le_bytes(part.try_into().unwrap_or_default()));
        let count = numbers.next().unwrap_or_default() as usize;
        // The last line may be a part of a row.
        let text = fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
        let whole = &text[..begun_bytes(&text, count)];
        let table = number_columns::read(&path.display().to_string(), whole)?.columns;
        let names = SimulatedRow::columns(&self.names).described();
        let row = |k: usize| {
            let of_row: Option<Vec<f64>> =
                names.iter().map(|column| table.get(column.name.as_str())?.get(k).copied()).collect();
            SimulatedRow::of_numbers(&of_row?, &self.names)
        };
        let rows: Option<Vec<SimulatedRow>> = (0..count).map(row).collect();
        let Some(rows) = rows else { bail!("{} has lost rows: give ⟪discard⟫", path.display()) };
        Ok(Some(BegunRun { rows, state: numbers.collect() }))
    }

    /// Removes the files after the whole result has been written.
    pub(super) fn remove(self) {
        if let Some(OpenFiles { rows, path, state }) = self.files {
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
        let Some(OpenFiles { rows, path, .. }) = &mut self.files else { return Ok(()) };
        let csv = crate::output::as_csv(ResultTable::new(SimulatedRow::columns(&self.names), [row]))?;
        let from = csv.iter().position(|byte| *byte == b'\n').map_or(0, |end| end + 1);
        rows.write_all(&csv[from..]).with_context(|| format!("cannot write {}", path.display()))
    }

    fn state(&mut self, count: usize, state: &[f64]) -> Result<()> {
        let Some(OpenFiles { rows, path, state: to }) = &mut self.files else { return Ok(()) };
        if self.flushed.elapsed() < FLUSH {
            return Ok(());
        }
        rows.flush().with_context(|| format!("cannot write {}", path.display()))?;
        let cannot = || format!("cannot write {}", to.display());
        let mut file = TemporaryFile::beside(to).with_context(cannot)?;
        let numbers = [count as f64].into_iter().chain(state.iter().copied()).flat_map(f64::to_le_bytes);
        let bytes: Vec<u8> = format!("{MARK}{}\n", self.request).into_bytes().into_iter().chain(numbers).collect();
        file.as_file_mut().write_all(&bytes).with_context(cannot)?;
        file.persist(to).with_context(cannot)?;
        self.flushed = Instant::now();
        Ok(())
    }
}
