//! Guard of the files of a command: it refuses to overwrite a file that is read, and to write two results to one file.

use crate::{FilesError, behind_link, with_ending};
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

/// Files that a command reads and writes, including journals and temporary files.
#[derive(Debug, Default)]
pub struct Guard {
    read: Vec<GuardedFile>,
    written: Vec<GuardedFile>,
}

/// File or folder and its role in the command.
#[derive(Debug)]
struct GuardedFile {
    /// Name in messages, such as "the robot file".
    role: String,
    path: PathBuf,
    place: Place,
    /// True for a folder: everything in it belongs to the command.
    is_folder: bool,
}

impl Guard {
    /// Adds a file that is read. Devices and pipes are ignored, because no result replaces them.
    pub fn reads(&mut self, role: &str, path: &Path) {
        if let Some(place) = Place::of(path) {
            self.read.push(GuardedFile { role: role.to_owned(), path: path.to_owned(), place, is_folder: false });
        }
    }

    /// Adds a file that is written; `role` is its content in messages, such as "the matrices".
    ///
    /// # Errors
    /// [`FilesError::Clash`]: the file is already read or written, perhaps under another name.
    pub fn writes(&mut self, role: &str, path: &Path) -> Result<(), FilesError> {
        self.add(role, role, path, false)
    }

    /// Adds a folder that is written, with all files in it.
    ///
    /// # Errors
    /// [`FilesError::Clash`]; see [`Guard::writes`].
    pub fn writes_folder(&mut self, role: &str, path: &Path) -> Result<(), FilesError> {
        self.add(role, role, path, true)
    }

    /// Adds a file of rows together with the files beside it until it is complete: the journal (if used) and the new
    /// file.
    ///
    /// # Errors
    /// [`FilesError::Clash`]; see [`Guard::writes`].
    pub fn writes_rows(&mut self, path: &Path, has_journal: bool) -> Result<(), FilesError> {
        const ROWS: &str = "the rows";

        self.writes(ROWS, path)?;
        let path = behind_link(path);
        if has_journal {
            let journal = with_ending(&path, crate::JOURNAL);
            self.add(&format!("the journal of the rows, {},", journal.display()), ROWS, &journal, false)?;
        }
        let new = with_ending(&path, crate::NEW);
        self.add(&format!("the new file, {},", new.display()), ROWS, &new, false)
    }

    /// Adds a file or folder that is written. `chosen` is the content whose file the user can choose.
    fn add(&mut self, role: &str, chosen: &str, path: &Path, is_folder: bool) -> Result<(), FilesError> {
        let Some(place) = Place::of(path) else { return Ok(()) };
        let used = GuardedFile { role: role.to_owned(), path: path.to_owned(), place, is_folder };
        let advice = format!("choose another file for {chosen}");

        if let Some(source) = self.read.iter().find(|source| used.meets(source)) {
            let shown = source.path.display();
            let same = if source.path == used.path {
                String::new()
            } else {
                format!(" ({} is the same file)", used.path.display())
            };
            return Err(FilesError::Clash(format!(
                "refusing to write {role} over {} {shown}{same}; {advice}",
                source.role
            )));
        }
        if let Some(other) = self.written.iter().find(|other| used.meets(other)) {
            let both = format!("refusing to write {role} and {} both to {}", other.role, other.path.display());
            return Err(FilesError::Clash(format!("{both}; {advice}")));
        }

        self.written.push(used);
        Ok(())
    }
}

impl GuardedFile {
    /// True if writing one would replace the other or a file in it.
    fn meets(&self, other: &Self) -> bool {
        self.place.is(&other.place)
            || (self.is_folder && other.place.path.starts_with(&self.place.path))
            || (other.is_folder && self.place.path.starts_with(&other.place.path))
    }
}

/// File or folder that a path leads to.
#[derive(Debug)]
struct Place {
    /// Path without links, `.` and `..`, as far as it exists.
    path: PathBuf,
    /// Device and inode number, equal for all names of one file.
    file: Option<(u64, u64)>,
    /// True if nothing exists at the path yet.
    is_new: bool,
}

impl Place {
    /// Place of a path; `None` for devices and pipes, which are written in place.
    fn of(path: &Path) -> Option<Self> {
        match fs::metadata(path) {
            Ok(metadata) if !metadata.is_file() && !metadata.is_dir() => None,
            Ok(metadata) => {
                let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
                Some(Self { path, file: file_id(&metadata), is_new: false })
            }
            Err(_) => {
                let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
                let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
                let path = path.file_name().map_or_else(|| path.to_owned(), |name| folder.join(name));
                Some(Self { path, file: None, is_new: true })
            }
        }
    }

    fn is(&self, other: &Self) -> bool {
        if self.path == other.path || (self.file.is_some() && self.file == other.file) {
            return true;
        }
        // For existing files the system has resolved the names. For two new names, check whether the folder ignores
        // case.
        let folded = |path: &Path| path.file_name().map(|name| name.to_string_lossy().to_lowercase());
        self.is_new
            && other.is_new
            && self.path.parent() == other.path.parent()
            && folded(&self.path) == folded(&other.path)
            && self.path.parent().is_some_and(ignores_case)
    }
}

/// Device and inode number of a file, where the system has them.
fn file_id(metadata: &fs::Metadata) -> Option<(u64, u64)> {
    #[cfg(unix)]
    let id = {
        use std::os::unix::fs::MetadataExt;
        Some((metadata.dev(), metadata.ino()))
    };
    #[cfg(not(unix))]
    let id = None;
    let _ = metadata;
    id
}

/// True if a folder takes names that differ only in case as one name. Tested with a temporary file.
fn ignores_case(folder: &Path) -> bool {
    let probe = tempfile::Builder::new().prefix(".funicular-case-").tempfile_in(folder);
    probe.is_ok_and(|probe| {
        let name = probe.path().file_name().and_then(OsStr::to_str).map(str::to_uppercase);
        name.is_some_and(|name| folder.join(name).exists())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_the_same_by_every_name_it_has() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("sub")).unwrap();
        fs::write(at("robot.toml"), "").unwrap();
        let mut names = vec![at("robot.toml"), at("./robot.toml"), at("sub/../robot.toml")];
        #[cfg(unix)]
        {
            use std::os::unix::fs::symlink;
            symlink(at("robot.toml"), at("link")).unwrap();
            symlink(at("link"), at("sub/link-of-link")).unwrap();
            symlink(folder.path(), at("sub/up")).unwrap();
            fs::hard_link(at("robot.toml"), at("hard")).unwrap();
            names.extend([at("link"), at("sub/link-of-link"), at("sub/up/robot.toml"), at("hard"), at("sub/up/hard")]);
        }

        for input in &names {
            for output in &names {
                let mut guard = Guard::default();
                guard.reads("the robot file", input);
                let said = guard.writes("the result", output).unwrap_err().to_string();
                assert!(said.starts_with("refusing to write the result over the robot file"), "{said}");
                assert!(said.ends_with("choose another file for the result"), "{said}");
                let mut guard = Guard::default();
                guard.writes("the matrices", input).unwrap();
                assert!(guard.writes("the result", output).is_err(), "{input:?} {output:?}");
            }
        }

        let mut guard = Guard::default();
        guard.reads("the robot file", &at("robot.toml"));
        guard.writes("the result", &at("sub/robot.toml")).unwrap();
        guard.writes("the matrices", &at("other")).unwrap();
    }

    #[test]
    fn files_that_do_not_exist_yet_are_guarded_too() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let mut guard = Guard::default();
        guard.writes("the result", &at("new.npz")).unwrap();
        let said = guard.writes("the matrices", &at("./new.npz")).unwrap_err().to_string();
        assert!(said.starts_with("refusing to write the matrices and the result both to"), "{said}");
        // The file system decides whether this is the same file.
        let same = guard.writes("the matrices", &at("NEW.npz")).is_err();
        fs::write(at("new.npz"), "").unwrap();
        assert_eq!(same, at("NEW.npz").exists());
    }

    #[test]
    fn files_beside_the_rows_and_in_a_folder_are_guarded() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for (beside, has_journal, refused) in [
            ("w.parquet.partial", true, "the journal of the rows"),
            ("w.parquet.writing", true, "the new file"),
            ("w.parquet.writing", false, "the new file"),
            ("w.parquet", false, "the rows"),
        ] {
            fs::write(at(beside), "").unwrap();
            let mut guard = Guard::default();
            guard.reads("the poses", &at(beside));
            let said = guard.writes_rows(&at("w.parquet"), has_journal).unwrap_err().to_string();
            assert!(said.contains(&format!("refusing to write {refused}")), "{said}");
            assert!(said.ends_with("choose another file for the rows"), "{said}");
        }
        let mut guard = Guard::default();
        guard.reads("the part", &at("w.parquet.partial"));
        fs::remove_file(at("w.parquet")).unwrap();
        guard.writes_rows(&at("w.parquet"), false).unwrap();

        fs::create_dir(at("model")).unwrap();
        let mut guard = Guard::default();
        guard.writes("the result", &at("model/M.csv")).unwrap();
        assert!(guard.writes_folder("the matrices", &at("model")).is_err());
        let mut guard = Guard::default();
        guard.writes_folder("the matrices", &at("model")).unwrap();
        assert!(guard.writes("the result", &at("model/M.csv")).is_err());
        guard.writes("the result", &at("model.txt")).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn the_target_of_a_link_is_guarded_with_what_is_beside_it_and_devices_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("sub")).unwrap();
        fs::write(at("sub/real.parquet"), "").unwrap();
        fs::write(at("sub/real.parquet.partial"), "").unwrap();
        std::os::unix::fs::symlink(at("sub/real.parquet"), at("w.parquet")).unwrap();
        let mut guard = Guard::default();
        guard.reads("the robot file", &at("sub/real.parquet.partial"));
        assert!(guard.writes_rows(&at("w.parquet"), true).is_err());
        let mut guard = Guard::default();
        guard.reads("the robot file", Path::new("/dev/null"));
        guard.writes("the result", Path::new("/dev/null")).unwrap();
        guard.writes("the matrices", Path::new("/dev/null")).unwrap();
    }
}
