//! Files and folders that appear under their name only when they are complete.
//!
//! Every writer works beside the target and renames at the end, so that nobody reads a half-written file:
//! [`TemporaryFile`] for bytes in memory, `write_locked` for long files that one run at a time writes,
//! [`write_folder`] for a folder with several files.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::Path;

/// Start of the names of temporary files and folders.
const PREFIX: &str = ".funicular-";

/// True for a regular file and for a path where nothing exists yet; false for devices and pipes, which are written in
/// place.
pub fn is_regular_or_new(path: &Path) -> bool {
    fs::metadata(path).map_or(true, |metadata| metadata.is_file())
}

/// Folder that holds `path`: its parent, or the current folder.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Gives `file` the permissions of the file at `path`, if one exists there.
fn take_permissions(file: &File, path: &Path) -> io::Result<()> {
    // WASI has no permissions.
    if cfg!(target_os = "wasi") {
        return Ok(());
    }
    fs::metadata(path).map_or(Ok(()), |metadata| file.set_permissions(metadata.permissions()))
}

/// True for a file that cannot be written. WASI tells no permissions, and its files would all seem to be read-only.
pub fn is_read_only(path: &Path) -> bool {
    let has_permissions = !cfg!(target_os = "wasi");
    has_permissions && fs::metadata(path).is_ok_and(|metadata| metadata.permissions().readonly())
}

/// Temporary file in the folder of its target. It takes the target's name when it is complete, and is removed
/// otherwise.
pub struct TemporaryFile(tempfile::NamedTempFile);

impl TemporaryFile {
    /// Creates an empty file in the folder of `path`.
    ///
    /// # Errors
    /// The error of the system. Its path is left out, because the user did not give the temporary path.
    pub fn beside(path: &Path) -> io::Result<Self> {
        if path.file_name().is_none() {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "it has no file name"));
        }
        let directory = folder_of(path);
        if !directory.is_dir() {
            let reason = format!("there is no directory {}", directory.display());
            return Err(io::Error::new(io::ErrorKind::NotFound, reason));
        }

        let mut builder = tempfile::Builder::new();
        builder.prefix(PREFIX);
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // Permissions of any new file, reduced by the umask; tempfile's default keeps other users from reading it.
            builder.permissions(fs::Permissions::from_mode(0o666));
        }
        Ok(Self(builder.tempfile_in(directory).map_err(|error| io::Error::from(error.kind()))?))
    }

    /// File to write to.
    pub fn as_file_mut(&mut self) -> &mut File {
        self.0.as_file_mut()
    }

    /// Renames the file to `path`. If a file exists there, it is replaced and its permissions are kept.
    ///
    /// # Errors
    /// The error of the system; a file at `path` is unchanged then.
    pub fn persist(self, path: &Path) -> io::Result<()> {
        take_permissions(self.0.as_file(), path)?;
        self.0.persist(path).map_err(|error| error.error)?;
        Ok(())
    }
}

/// Writes `path` by way of the file `beside`, which is locked meanwhile and has a fixed name: the next run takes the
/// file over, so that a run that was killed leaves at most this one file.
///
/// The bytes are on the disk before the file takes its name, because the caller may then remove their source.
///
/// # Errors
/// The error of `write` or of the system; [`io::ErrorKind::ResourceBusy`] if another run holds the lock.
pub(crate) fn write_locked(path: &Path, beside: &Path, write: impl FnOnce(&File) -> io::Result<()>) -> io::Result<()> {
    let file = OpenOptions::new().write(true).create(true).truncate(false).open(beside)?;
    if let Err(TryLockError::WouldBlock) = file.try_lock() {
        return Err(io::Error::new(io::ErrorKind::ResourceBusy, "another run is writing it"));
    }

    let complete = || {
        file.set_len(0)?;
        write(&file)?;
        take_permissions(&file, path)?;
        file.sync_data()?;
        fs::rename(beside, path)
    };
    complete().inspect_err(|_| drop(fs::remove_file(beside)))
}

/// Writes the folder `path` with the files that `fill` puts into the folder given to it. An empty folder at `path` is
/// replaced, a folder with files is not.
///
/// # Errors
/// The error of `fill` or of the system.
pub fn write_folder<E: From<io::Error>>(path: &Path, fill: impl FnOnce(&Path) -> Result<(), E>) -> Result<(), E> {
    let folder = tempfile::Builder::new().prefix(PREFIX).tempdir_in(folder_of(path))?;
    fill(folder.path())?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Permissions of any new folder; a temporary folder can be read by its owner only.
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755))?;
    }
    fs::rename(folder.path(), path)?;
    let _ = folder.keep();
    Ok(())
}
