//! Destination of a file: checked before long work begins, and written completely or not at all.

use anyhow::{Context, Result, bail};
use funicular_files::Guard;
use funicular_files::atomic_file::{self, TemporaryFile, is_read_only, is_regular_or_new};
use funicular_files::endings::{self, Kind};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Content of a file: its name in messages and the endings it may have.
#[derive(Debug, Clone, Copy)]
pub struct Content<'a> {
    /// Name of the output in messages: "the result".
    pub name: &'a str,
    /// Kind of the file in messages: "a page".
    pub in_words: &'a str,
    /// Kinds of files that hold it.
    pub fitting: &'a [Kind],
}

/// Bytes of a file, or files of a folder by their names.
#[derive(Debug)]
pub enum Bytes {
    /// One file.
    File(Vec<u8>),
    /// Files of a folder.
    Folder(Vec<(String, Vec<u8>)>),
}

/// File or folder that can be written.
#[derive(Debug)]
pub struct Destination {
    /// Path as it was given.
    pub path: PathBuf,
    /// Path behind symbolic links.
    target: PathBuf,
}

impl Destination {
    /// Checks that a file can be written.
    ///
    /// # Errors
    /// A destination that cannot be written; a file that the command also reads or writes; or a file whose ending means
    /// another format.
    pub fn open(path: &Path, content: Content<'_>, guard: &mut Guard) -> Result<Self> {
        let shown = path.display();
        // A symbolic link is followed: its target is replaced, not the link.
        let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        if target.is_dir() {
            let text = format!("cannot write to {shown}: it is a directory; add a file name");
            return Err(io::Error::new(io::ErrorKind::IsADirectory, text).into());
        }
        guard.writes(content.name, path)?;
        endings::check(path, content.in_words, content.fitting)?;
        if is_regular_or_new(&target) {
            if is_read_only(&target) {
                let text = format!("cannot write to {shown}: it is read-only");
                return Err(io::Error::new(io::ErrorKind::PermissionDenied, text).into());
            }
            // The empty file is removed again.
            TemporaryFile::beside(&target).map_err(|error| failed(path, error))?;
        }
        Ok(Self { path: path.to_owned(), target })
    }

    /// Checks that a folder can be written, which is new or empty. `key` is that of its option.
    ///
    /// # Errors
    /// A folder with files, one that the command reads or writes, or one that cannot be written.
    pub fn open_folder(path: &Path, content: Content<'_>, key: &str, guard: &mut Guard) -> Result<Self> {
        let shown = path.display();
        guard.writes_folder(content.name, path)?;
        match path.read_dir().map(|mut entries| entries.next().is_some()) {
            Ok(true) => bail!("the folder {shown} is not empty: choose another one for ⟪{key}⟫, or empty it"),
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(error).with_context(|| format!("cannot write to {shown}"))
            }
            _ => {
                let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
                if !parent.unwrap_or(Path::new(".")).is_dir() {
                    bail!("cannot write to {shown}: there is no directory {}", parent.unwrap_or(path).display());
                }
                Ok(Self { path: path.to_owned(), target: path.to_owned() })
            }
        }
    }

    /// True for a file that did not exist before or is replaced; false for a device or a pipe.
    pub fn is_kept(&self) -> bool {
        is_regular_or_new(&self.target)
    }

    /// Writes a file or a folder, completely or not at all.
    ///
    /// # Errors
    /// The error of the system.
    pub fn write(&self, bytes: &Bytes) -> Result<()> {
        let written = match bytes {
            Bytes::File(bytes) => self.write_file(bytes),
            Bytes::Folder(files) => atomic_file::write_folder(&self.target, |folder| {
                files.iter().try_for_each(|(name, bytes)| fs::write(folder.join(name), bytes))
            }),
        };
        written.map_err(|error| failed(&self.path, error))
    }

    fn write_file(&self, bytes: &[u8]) -> io::Result<()> {
        if !is_regular_or_new(&self.target) {
            return fs::OpenOptions::new().write(true).open(&self.target)?.write_all(bytes);
        }
        let mut file = TemporaryFile::beside(&self.target)?;
        file.as_file_mut().write_all(bytes)?;
        file.persist(&self.target)
    }
}

/// Error of a file that cannot be written, with the error of the system.
fn failed(path: &Path, error: io::Error) -> anyhow::Error {
    anyhow::Error::new(error).context(format!("cannot write to {}", path.display()))
}
