//! Files that are written as a whole or not at all.

use std::fs::{self, File};
use std::io;
use std::path::Path;

/// Not a device or a pipe: those are written as they are.
pub fn is_regular_or_new(path: &Path) -> bool {
    fs::metadata(path).map_or(true, |metadata| metadata.is_file())
}

/// A file beside another that takes its name when it is complete, and vanishes if it never is.
pub struct Temporary(tempfile::NamedTempFile);

impl Temporary {
    /// An empty one in the folder of `path`.
    ///
    /// # Errors
    /// What the system says; the path that it would name is left out, since it is not the one the user gave.
    pub fn beside(path: &Path) -> io::Result<Self> {
        let directory = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        if path.file_name().is_none() {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "it names no file"));
        }
        if !directory.is_dir() {
            let reason = format!("there is no directory {}", directory.display());
            return Err(io::Error::new(io::ErrorKind::NotFound, reason));
        }
        let mut builder = tempfile::Builder::new();
        builder.prefix(".funicular-");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // As any new file; tempfile's own choice keeps others from reading it. The umask applies.
            builder.permissions(fs::Permissions::from_mode(0o666));
        }
        Ok(Self(builder.tempfile_in(directory).map_err(|error| io::Error::from(error.kind()))?))
    }

    /// To be written.
    pub fn as_file_mut(&mut self) -> &mut File {
        self.0.as_file_mut()
    }

    /// Takes the name and the permissions of the file there, if there is one.
    ///
    /// # Errors
    /// What the system says; the file of that name is as it was.
    pub fn persist(self, path: &Path) -> io::Result<()> {
        if let Ok(metadata) = fs::metadata(path) {
            self.0.as_file().set_permissions(metadata.permissions())?;
        }
        self.0.persist(path).map_err(|error| error.error)?;
        Ok(())
    }
}
