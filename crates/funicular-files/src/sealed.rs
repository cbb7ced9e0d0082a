//! Checksum over all bytes of a Parquet file, kept in the file's own metadata.
//!
//! Pages of Parquet may carry checksums, but not every reader checks them, the library used here writes none, and the
//! metadata after the pages have none at all. The checksum here covers the complete file: it is the CRC-32 of all
//! bytes, with zeros in place of its own eight digits. It is the last pair of the file's metadata; other readers ignore
//! it.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

/// Key of the checksum in the file's metadata.
pub(crate) const KEY: &str = "funicular.checksum";

/// Placeholder for the checksum while the checksum is computed.
pub(crate) const BLANK: &str = "00000000";

/// Bytes between key and value in the footer, in Thrift's compact protocol: the next field is a text of eight bytes.
const BETWEEN: [u8; 2] = [0x18, BLANK.len() as u8];

/// First and last bytes of every Parquet file.
const MAGIC: &[u8; 4] = b"PAR1";

/// Length of the end of the file after the footer: the footer's length (4 bytes) and the magic.
const END: u64 = 8;

/// Writer that holds back the footer of a file to insert the checksum of the complete file.
pub(crate) struct SealingWriter<W: Write> {
    out: W,
    sum: crc32fast::Hasher,
    /// Bytes of the footer, collected after [`SealingWriter::hold`].
    footer: Option<Vec<u8>>,
}

impl<W: Write> SealingWriter<W> {
    pub(crate) fn new(out: W) -> Self {
        Self { out, sum: crc32fast::Hasher::new(), footer: None }
    }

    /// Starts the footer: all further bytes are held back.
    pub(crate) fn hold(&mut self) {
        self.footer = Some(Vec::new());
    }

    /// Writes the footer with the checksum.
    ///
    /// # Errors
    /// The error of `out`; a footer without a place for the checksum, which is a bug.
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

impl<W: Write> Write for SealingWriter<W> {
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

/// Result of checking a file's checksum before its content is read.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Seal {
    /// The checksum matches the bytes.
    Intact,
    /// The checksum does not match the bytes.
    Broken,
    /// The file has no checksum.
    None,
    /// The file is no Parquet file.
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

    // Everything before the footer is read through a buffer: a file may be larger than the memory.
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
    Ok(if digits(sum.finalize()).as_bytes() == found { Seal::Intact } else { Seal::Broken })
}

/// Position of the checksum's digits in a footer. The text of a robot file cannot be mistaken for it: the searched
/// bytes hold a control character, which TOML refuses.
fn place(footer: &[u8]) -> Option<usize> {
    let before = [KEY.as_bytes(), &BETWEEN].concat();
    let at = footer.windows(before.len()).rposition(|window| window == before)? + before.len();
    (at + BLANK.len() <= footer.len()).then_some(at)
}

fn digits(sum: u32) -> String {
    format!("{sum:08x}")
}
