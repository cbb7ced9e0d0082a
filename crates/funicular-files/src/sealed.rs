//! Checksum of a Parquet file over all of its bytes, kept in its own metadata.
//!
//! Pages of Parquet may carry checksums, but not every reader looks at them, this crate's library writes none, and the
//! metadata behind the pages have none at all. So the whole file gets one: the CRC-32 of all its bytes, with zeros in the
//! place of its own eight digits. It is the last pair of the file's metadata, where any reader of Parquet passes over it.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

/// Key of the checksum among the file's metadata.
pub(crate) const KEY: &str = "funicular.checksum";

/// Value of the checksum while it is not known, and while it is computed.
pub(crate) const BLANK: &str = "00000000";

/// What stands between key and value in the footer (Thrift's compact protocol): the next field, a text, of eight bytes.
const BETWEEN: [u8; 2] = [0x18, BLANK.len() as u8];

/// First and last bytes of every Parquet file.
const MAGIC: &[u8; 4] = b"PAR1";

/// Length of what follows the footer: its own length, and the magic.
const END: u64 = 8;

/// A writer that holds back the end of a file to put in the checksum of all of it.
pub(crate) struct Sealing<W: Write> {
    out: W,
    sum: crc32fast::Hasher,
    /// The footer, from [`Sealing::hold`] on.
    footer: Option<Vec<u8>>,
}

impl<W: Write> Sealing<W> {
    pub(crate) fn new(out: W) -> Self {
        Self { out, sum: crc32fast::Hasher::new(), footer: None }
    }

    /// From here on the bytes are the footer's.
    pub(crate) fn hold(&mut self) {
        self.footer = Some(Vec::new());
    }

    /// Writes the footer with the checksum.
    ///
    /// # Errors
    /// What `out` reports; a footer that has no place for the checksum, which is a mistake in the program.
    pub(crate) fn seal(self) -> io::Result<()> {
        let Self { mut out, mut sum, footer } = self;
        let mut footer = footer.unwrap_or_default();
        let place = place(&footer).ok_or_else(|| io::Error::other("the file has no place for its checksum"))?;
        footer[place..place + BLANK.len()].copy_from_slice(BLANK.as_bytes());
        sum.update(&footer);
        footer[place..place + BLANK.len()].copy_from_slice(digits(sum.finalize()).as_bytes());
        out.write_all(&footer)?;
        out.flush()
    }
}

impl<W: Write> Write for Sealing<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if let Some(footer) = &mut self.footer {
            return footer.write(bytes);
        }
        let count = self.out.write(bytes)?;
        self.sum.update(&bytes[..count]);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// What the bytes of a file say before anything in them is believed.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Seal {
    /// The checksum is that of the bytes.
    Whole,
    /// It is another.
    Broken,
    /// There is none.
    None,
    /// The bytes are no Parquet file.
    NoParquet,
}

/// Compares the checksum of a file with its bytes.
///
/// # Errors
/// A file that cannot be read.
pub(crate) fn check(path: &Path) -> io::Result<Seal> {
    let mut file = File::open(path)?;
    let length = file.seek(SeekFrom::End(0))?;
    if length < MAGIC.len() as u64 + END {
        return Ok(Seal::NoParquet);
    }

    // The footer ends with its length and the magic.
    let mut end = [0; END as usize];
    file.seek(SeekFrom::Start(length - END))?;
    file.read_exact(&mut end)?;
    let footer_length = u64::from(u32::from_le_bytes([end[0], end[1], end[2], end[3]]));
    let Some(behind_pages) = (length - END).checked_sub(footer_length) else { return Ok(Seal::NoParquet) };
    if end[4..] != *MAGIC {
        return Ok(Seal::NoParquet);
    }

    // All before the footer, by way of a buffer: a file may be larger than the memory.
    let mut sum = crc32fast::Hasher::new();
    let mut buffer = vec![0; 1 << 20];
    file.seek(SeekFrom::Start(0))?;
    let mut pages = (&mut file).take(behind_pages);
    let mut read = 0;
    loop {
        let count = match pages.read(&mut buffer) {
            Ok(count) => count,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        };
        if count == 0 {
            break;
        }
        if read == 0 && !buffer.starts_with(MAGIC) {
            return Ok(Seal::NoParquet);
        }
        sum.update(&buffer[..count]);
        read += count as u64;
    }
    if read != behind_pages {
        return Ok(Seal::Broken);
    }

    // The footer, with zeros for the checksum.
    let mut footer = Vec::new();
    file.read_to_end(&mut footer)?;
    let Some(place) = place(&footer) else { return Ok(Seal::None) };
    let found = footer[place..place + BLANK.len()].to_owned();
    footer[place..place + BLANK.len()].copy_from_slice(BLANK.as_bytes());
    sum.update(&footer);
    Ok(if digits(sum.finalize()).as_bytes() == found { Seal::Whole } else { Seal::Broken })
}

/// Where the digits of the checksum are in a footer. No text of a robot file looks like it: it would hold a control
/// character, which TOML refuses.
fn place(footer: &[u8]) -> Option<usize> {
    let before = [KEY.as_bytes(), &BETWEEN].concat();
    let at = footer.windows(before.len()).rposition(|window| window == before)? + before.len();
    (at + BLANK.len() <= footer.len()).then_some(at)
}

fn digits(sum: u32) -> String {
    format!("{sum:08x}")
}
