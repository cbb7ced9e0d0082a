//! Journal of finished chunks: a file that is only appended to, and whose incomplete end can be recognized.
//!
//! It begins with one line of magic. Frames follow: length and CRC-32 of the content, 4 bytes each, little-endian, then
//! the content. The first frame holds the record (JSON) and the robot file, every further frame holds one chunk, in
//! order.

use crate::{FilesError, Rows};
use funicular_study::table::{Chunk, ColumnKind, Part, Record, RecordDifference, Values};
use serde_json::{Value, json};
use std::borrow::Cow;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const MAGIC: &[u8] = b"funicular journal 1\n";

/// Maximum length of a frame [bytes]; a larger number is a damaged length.
const MAX_FRAME: u32 = 1 << 30;

/// Time between two syncs to the disk: a power cut may cost this much work. Killing the process costs nothing.
const SYNC_INTERVAL: Duration = Duration::from_secs(5);

/// Journal that is being written.
pub(crate) struct Journal {
    pub(crate) path: PathBuf,
    file: File,
    record: Record,
    /// End of the last complete frame [bytes].
    end: u64,
    /// Index of the next chunk.
    pub(crate) next: usize,
    synced: Instant,
}

/// Content of the file at the journal's path.
pub(crate) enum Found {
    /// No rows: a new or empty file, or a journal without chunks.
    Nothing,
    /// Journal with chunks of a sweep.
    Chunks {
        /// Difference from the requested sweep.
        difference: Option<RecordDifference>,
        /// Number of rows in the journal, and of the complete sweep.
        done: usize,
        rows: usize,
        /// End of the last complete frame [bytes], and index of the chunk after it.
        end: u64,
        next: usize,
    },
    /// Other content than a journal.
    Foreign,
}

impl Journal {
    /// Opens or creates the file and locks it against other processes.
    pub(crate) fn lock(path: &Path) -> Result<File, FilesError> {
        let mut options = OpenOptions::new();
        let file = options
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(|source| FilesError::Place { path: path.to_owned(), reason: crate::io_reason(&source) })?;
        // Any other error means a file system without locks: there the user has to avoid two runs on one file.
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => Err(FilesError::Locked { path: path.to_owned() }),
            Ok(()) | Err(TryLockError::Error(_)) => Ok(file),
        }
    }

    /// Starts an empty journal.
    pub(crate) fn begin(path: &Path, mut file: File, record: Record) -> io::Result<Self> {
        file.set_len(0)?;
        file.seek(SeekFrom::Start(0))?;
        file.write_all(MAGIC)?;
        let head =
            json!({ "record": record.to_json(), "part": shown_part(record.part), "robot_file": record.robot_file });
        write_frame(&mut file, head.to_string().as_bytes())?;
        file.sync_data()?;
        let (end, next) = (file.stream_position()?, record.range().start);
        Ok(Self { path: path.to_owned(), file, record, end, next, synced: Instant::now() })
    }

    /// Continues a journal after its last complete frame; the rest of the file is cut off.
    pub(crate) fn resume(path: &Path, mut file: File, record: Record, end: u64, next: usize) -> io::Result<Self> {
        file.set_len(end)?;
        file.seek(SeekFrom::Start(end))?;
        Ok(Self { path: path.to_owned(), file, record, end, next, synced: Instant::now() })
    }

    /// Adds the next chunk. If that fails, the chunks before it stay intact.
    pub(crate) fn add(&mut self, chunk: &Chunk) -> io::Result<()> {
        assert_eq!(chunk.index, self.next, "chunks come in order");
        if let Err(error) = write_frame(&mut self.file, &encode(chunk)) {
            let _ = self.file.set_len(self.end).and_then(|()| self.file.seek(SeekFrom::Start(self.end)));
            return Err(error);
        }
        self.end = self.file.stream_position()?;
        self.next += 1;
        if self.synced.elapsed() > SYNC_INTERVAL {
            self.sync()?;
        }
        Ok(())
    }

    /// Writes all data through to the disk.
    pub(crate) fn sync(&mut self) -> io::Result<()> {
        self.file.sync_data()?;
        self.synced = Instant::now();
        Ok(())
    }

    /// Number of rows in the journal.
    pub(crate) fn done(&self) -> usize {
        self.record.rows_of(self.record.range().start..self.next)
    }

    pub(crate) fn record(&self) -> &Record {
        &self.record
    }
}

impl Rows for Journal {
    fn each(&self, take: &mut dyn FnMut(Chunk) -> io::Result<()>) -> io::Result<()> {
        let mut file = BufReader::with_capacity(1 << 20, File::open(&self.path)?);
        file.seek(SeekFrom::Start(MAGIC.len() as u64))?;
        let torn = || io::Error::new(io::ErrorKind::InvalidData, "the journal has changed while it was read");
        read_frame(&mut file)?.ok_or_else(torn)?;
        for index in self.record.range().start..self.next {
            let frame = read_frame(&mut file)?.ok_or_else(torn)?;
            let chunk = decode(&frame, &self.record).filter(|chunk| chunk.index == index).ok_or_else(torn)?;
            take(chunk)?;
        }
        Ok(())
    }
}

/// Reads an existing file and compares it with `record`.
pub(crate) fn inspect(file: &File, record: &Record) -> io::Result<Found> {
    let mut file = BufReader::with_capacity(1 << 20, file);
    file.seek(SeekFrom::Start(0))?;
    let mut magic = Vec::new();
    file.by_ref().take(MAGIC.len() as u64).read_to_end(&mut magic)?;

    if magic != MAGIC {
        // An empty file, or a part of the magic: the run was killed before its first frame.
        return Ok(if MAGIC.starts_with(&magic) { Found::Nothing } else { Found::Foreign });
    }

    let Some(head) = read_frame(&mut file)? else { return Ok(Found::Nothing) };
    let Ok(head) = serde_json::from_slice::<Value>(&head) else { return Ok(Found::Foreign) };
    let difference = record
        .difference(&head["record"], head["robot_file"].as_str().unwrap_or_default())
        .or_else(|| RecordDifference::of_values("part", &head["part"], &shown_part(record.part)));
    let same = difference.is_none();
    let mut end = file.stream_position()?;
    let (first, mut next) = (record.range().start, record.range().start);
    let mut done = 0;

    while let Some(frame) = read_frame(&mut file)? {
        if same {
            match decode(&frame, record) {
                Some(chunk) if chunk.index == next => next += 1,
                _ => break,
            }
        } else {
            // A chunk of another sweep, whose columns are not known here; its number of rows stands at bytes 8 to 11.
            done +=
                frame.get(8..12).map_or(0, |rows| u32::from_le_bytes([rows[0], rows[1], rows[2], rows[3]]) as usize);
        }
        end = file.stream_position()?;
    }

    let rows =
        if same { record.rows_of(record.range()) } else { head["record"]["rows"].as_u64().unwrap_or(0) as usize };
    if same {
        done = record.rows_of(first..next);
    }
    Ok(if done == 0 && same { Found::Nothing } else { Found::Chunks { difference, done, rows, end, next } })
}

/// Part in the form used by files: its text, or null.
pub(crate) fn shown_part(part: Option<Part>) -> Value {
    part.map_or(Value::Null, |part| Value::String(part.to_string()))
}

pub(crate) fn write_frame(file: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    let length = u32::try_from(bytes.len())
        .ok()
        .filter(|length| *length <= MAX_FRAME)
        .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "a chunk is too large for the journal"))?;
    let mut frame = Vec::with_capacity(bytes.len() + 8);
    frame.extend(length.to_le_bytes());
    frame.extend(crc32fast::hash(bytes).to_le_bytes());
    frame.extend(bytes);
    file.write_all(&frame)
}

/// Reads the next frame. `None` at the end of the file or at an incomplete or damaged frame.
pub(crate) fn read_frame(file: &mut impl Read) -> io::Result<Option<Vec<u8>>> {
    let mut head = Vec::new();
    file.by_ref().take(8).read_to_end(&mut head)?;
    let &[a, b, c, d, e, f, g, h] = &head[..] else { return Ok(None) };
    let (length, sum) = (u32::from_le_bytes([a, b, c, d]), u32::from_le_bytes([e, f, g, h]));
    if length > MAX_FRAME {
        return Ok(None);
    }
    let mut bytes = Vec::new();
    file.by_ref().take(u64::from(length)).read_to_end(&mut bytes)?;
    Ok((bytes.len() == length as usize && crc32fast::hash(&bytes) == sum).then_some(bytes))
}

/// Bytes of a chunk: index, number of rows, then per column one bit per row (value present) and the present values.
pub(crate) fn encode(chunk: &Chunk) -> Vec<u8> {
    let mut bytes = Vec::new();
    bytes.extend((chunk.index as u64).to_le_bytes());
    bytes.extend((chunk.rows() as u32).to_le_bytes());
    for column in &chunk.columns {
        match column {
            Values::Real(values) => {
                put_bits(&mut bytes, values.iter().map(Option::is_some));
                values.iter().flatten().for_each(|value| bytes.extend(value.to_bits().to_le_bytes()));
            }
            Values::Flag(values) => put_bits(&mut bytes, values.iter().copied()),
            Values::Text(values) => {
                put_bits(&mut bytes, values.iter().map(Option::is_some));
                for text in values.iter().flatten() {
                    bytes.extend((text.len() as u32).to_le_bytes());
                    bytes.extend(text.as_bytes());
                }
            }
        }
    }
    bytes
}

fn put_bits(bytes: &mut Vec<u8>, bits: impl Iterator<Item = bool>) {
    for (i, bit) in bits.enumerate() {
        if i % 8 == 0 {
            bytes.push(0);
        }
        if let Some(last) = bytes.last_mut() {
            *last |= u8::from(bit) << (i % 8);
        }
    }
}

/// Chunk of a frame; `None` if it does not belong to this record.
pub(crate) fn decode(mut bytes: &[u8], record: &Record) -> Option<Chunk> {
    let bytes = &mut bytes;
    let index = usize::try_from(u64::from_le_bytes(get(bytes, 8)?.try_into().ok()?)).ok()?;
    let rows = u32::from_le_bytes(get(bytes, 4)?.try_into().ok()?) as usize;
    if index >= record.chunks() || rows != record.rows_of(index..index + 1) {
        return None;
    }
    let mut columns = Vec::with_capacity(record.columns.len());

    for column in &record.columns {
        let bits = get(bytes, rows.div_ceil(8))?;
        let bits = (0..rows).map(|i| bits[i / 8] >> (i % 8) & 1 == 1);
        columns.push(match column.kind {
            ColumnKind::Flag => Values::Flag(bits.collect()),
            ColumnKind::Real => Values::Real(optional(bits, || {
                Some(f64::from_bits(u64::from_le_bytes(get(bytes, 8)?.try_into().ok()?)))
            })?),
            ColumnKind::Text => Values::Text(optional(bits, || {
                let length = u32::from_le_bytes(get(bytes, 4)?.try_into().ok()?) as usize;
                Some(Cow::Owned(String::from_utf8(get(bytes, length)?.to_vec()).ok()?))
            })?),
        });
    }

    bytes.is_empty().then_some(Chunk { index, columns })
}

/// Reads one value for every bit that is set.
fn optional<T>(bits: impl Iterator<Item = bool>, mut read: impl FnMut() -> Option<T>) -> Option<Vec<Option<T>>> {
    bits.map(|there| if there { read().map(Some) } else { Some(None) }).collect()
}

fn get<'b>(bytes: &mut &'b [u8], count: usize) -> Option<&'b [u8]> {
    let (head, rest) = bytes.split_at_checked(count)?;
    *bytes = rest;
    Some(head)
}
