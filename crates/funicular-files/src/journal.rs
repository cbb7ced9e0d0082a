//! Finished chunks on their way: a file that only grows, whose torn end is known as such.
//!
//! One line of magic, then frames: length and CRC-32 of what follows, 4 bytes each, little-endian. The first frame is
//! the record (JSON) and the robot file, every other one chunk, in order.

use crate::{FilesError, Rows};
use funicular_study::sweep::{Chunk, ColumnKind, Part, Record, RecordDifference, Values};
use serde_json::{Value, json};
use std::borrow::Cow;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const MAGIC: &[u8] = b"funicular journal 1\n";

/// Longest frame; anything above is torn.
const LONGEST: u32 = 1 << 30;

/// How often chunks are forced to the disk: what a power cut may cost. Killing the process costs nothing.
const SYNC: Duration = Duration::from_secs(5);

/// A journal that is being written.
pub(crate) struct Journal {
    pub(crate) path: PathBuf,
    file: File,
    record: Record,
    /// End of the last whole frame.
    end: u64,
    /// The chunk that comes next.
    pub(crate) next: usize,
    synced: Instant,
}

/// What is in a file where a journal may be.
pub(crate) enum Found {
    /// Nothing that anyone would miss.
    Nothing,
    /// Chunks of a sweep.
    Chunks {
        /// How they differ from the one asked.
        difference: Option<RecordDifference>,
        /// Rows it has, and all it is to have.
        done: usize,
        rows: usize,
        /// End of the last whole frame, and the chunk behind it.
        end: u64,
        next: usize,
    },
    /// Something else.
    Foreign,
}

impl Journal {
    /// Opens or makes the file and keeps other processes out.
    pub(crate) fn lock(path: &Path) -> Result<File, FilesError> {
        let mut options = OpenOptions::new();
        let file = options
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(|source| FilesError::Place { path: path.to_owned(), reason: crate::told(&source) })?;
        // Any other error is a file system without locks: the user has to know what runs.
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => Err(FilesError::Locked { path: path.to_owned() }),
            Ok(()) | Err(TryLockError::Error(_)) => Ok(file),
        }
    }

    /// Begins an empty one.
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

    /// Goes on behind what was found; what is torn is cut off.
    pub(crate) fn go_on(path: &Path, mut file: File, record: Record, end: u64, next: usize) -> io::Result<Self> {
        file.set_len(end)?;
        file.seek(SeekFrom::Start(end))?;
        Ok(Self { path: path.to_owned(), file, record, end, next, synced: Instant::now() })
    }

    /// Adds the next chunk. If that fails, what was there before is whole.
    pub(crate) fn add(&mut self, chunk: &Chunk) -> io::Result<()> {
        assert_eq!(chunk.index, self.next, "chunks come in order");
        if let Err(error) = write_frame(&mut self.file, &encode(chunk)) {
            let _ = self.file.set_len(self.end).and_then(|()| self.file.seek(SeekFrom::Start(self.end)));
            return Err(error);
        }
        self.end = self.file.stream_position()?;
        self.next += 1;
        if self.synced.elapsed() > SYNC {
            self.sync()?;
        }
        Ok(())
    }

    /// Forces everything to the disk.
    pub(crate) fn sync(&mut self) -> io::Result<()> {
        self.file.sync_data()?;
        self.synced = Instant::now();
        Ok(())
    }

    /// Rows that are safe.
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

/// Looks at what is there.
pub(crate) fn look(file: &File, record: &Record) -> io::Result<Found> {
    let mut file = BufReader::with_capacity(1 << 20, file);
    file.seek(SeekFrom::Start(0))?;
    let mut magic = Vec::new();
    file.by_ref().take(MAGIC.len() as u64).read_to_end(&mut magic)?;
    if magic != MAGIC {
        // An empty file is one that was killed at birth.
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
            // Of another sweep, whose columns are not known here; the rows stand in front.
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

/// A part as files have it.
pub(crate) fn shown_part(part: Option<Part>) -> Value {
    part.map_or(Value::Null, |part| Value::String(part.to_string()))
}

pub(crate) fn write_frame(file: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    let length = u32::try_from(bytes.len())
        .ok()
        .filter(|length| *length <= LONGEST)
        .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "a chunk is too large for the journal"))?;
    let mut frame = Vec::with_capacity(bytes.len() + 8);
    frame.extend(length.to_le_bytes());
    frame.extend(crc32fast::hash(bytes).to_le_bytes());
    frame.extend(bytes);
    file.write_all(&frame)
}

/// The next frame; none at the end, or where the rest is torn.
pub(crate) fn read_frame(file: &mut impl Read) -> io::Result<Option<Vec<u8>>> {
    let mut head = Vec::new();
    file.by_ref().take(8).read_to_end(&mut head)?;
    let &[a, b, c, d, e, f, g, h] = &head[..] else { return Ok(None) };
    let (length, sum) = (u32::from_le_bytes([a, b, c, d]), u32::from_le_bytes([e, f, g, h]));
    if length > LONGEST {
        return Ok(None);
    }
    let mut bytes = Vec::new();
    file.by_ref().take(u64::from(length)).read_to_end(&mut bytes)?;
    Ok((bytes.len() == length as usize && crc32fast::hash(&bytes) == sum).then_some(bytes))
}

/// Index, number of rows, and the columns: a bit a row for what is there, then what is there.
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

/// The chunk of a frame; none if it is not of this record.
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

/// A value where there is one.
fn optional<T>(bits: impl Iterator<Item = bool>, mut read: impl FnMut() -> Option<T>) -> Option<Vec<Option<T>>> {
    bits.map(|there| if there { read().map(Some) } else { Some(None) }).collect()
}

fn get<'b>(bytes: &mut &'b [u8], count: usize) -> Option<&'b [u8]> {
    let (head, rest) = bytes.split_at_checked(count)?;
    *bytes = rest;
    Some(head)
}
