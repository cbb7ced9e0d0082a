//! Guard of the files of a command: nothing is written over a file that is read, nor twice to one place.

use crate::{FilesError, behind_link, with_ending};
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

/// The files that a command reads and writes, those beside its results too.
#[derive(Debug, Default)]
pub struct Guard {
    read: Vec<Used>,
    written: Vec<Used>,
}

/// A file and its part in the command.
#[derive(Debug)]
struct Used {
    /// As it is called in a message: "the robot file".
    role: String,
    path: PathBuf,
    place: Place,
    /// All that is in this folder is of the command.
    is_folder: bool,
}

impl Guard {
    /// Adds a file that is read. Devices and pipes are left alone: nothing that is written replaces them.
    pub fn reads(&mut self, role: &str, path: &Path) {
        if let Some(place) = Place::of(path) {
            self.read.push(Used { role: role.to_owned(), path: path.to_owned(), place, is_folder: false });
        }
    }

    /// Adds a file that is written, named by an option.
    ///
    /// # Errors
    /// [`FilesError::Clash`]: it is one of the files that are read, or another that is written, by whatever name.
    pub fn writes(&mut self, role: &str, option: &str, path: &Path) -> Result<(), FilesError> {
        self.add(role, option, path, false)
    }

    /// Adds a folder that is written, with all that will be in it.
    ///
    /// # Errors
    /// [`FilesError::Clash`], as [`Guard::writes`].
    pub fn writes_folder(&mut self, role: &str, option: &str, path: &Path) -> Result<(), FilesError> {
        self.add(role, option, path, true)
    }

    /// Adds a file of rows with what is beside it until it is complete: the journal, if there is one, and the new file.
    ///
    /// # Errors
    /// [`FilesError::Clash`], as [`Guard::writes`].
    pub fn writes_rows(&mut self, option: &str, path: &Path, has_journal: bool) -> Result<(), FilesError> {
        self.writes("the rows", option, path)?;
        let path = behind_link(path);
        if has_journal {
            let journal = with_ending(&path, crate::JOURNAL);
            self.writes(&format!("the journal of the rows, {},", journal.display()), option, &journal)?;
        }
        let new = with_ending(&path, crate::NEW);
        self.writes(&format!("the new file, {},", new.display()), option, &new)
    }

    fn add(&mut self, role: &str, option: &str, path: &Path, is_folder: bool) -> Result<(), FilesError> {
        let Some(place) = Place::of(path) else { return Ok(()) };
        let used = Used { role: role.to_owned(), path: path.to_owned(), place, is_folder };
        let advice = format!("choose another name for {option}");
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

impl Used {
    /// One would replace the other.
    fn meets(&self, other: &Self) -> bool {
        self.place.is(&other.place)
            || (self.is_folder && other.place.path.starts_with(&self.place.path))
            || (other.is_folder && self.place.path.starts_with(&other.place.path))
    }
}

/// Where a path leads.
#[derive(Debug)]
struct Place {
    /// Without links and detours, as far as it exists.
    path: PathBuf,
    /// Device and number of what is there, which all of its names share.
    file: Option<(u64, u64)>,
    /// Nothing is there yet.
    is_new: bool,
}

impl Place {
    /// None for devices and pipes, which are written as they are.
    fn of(path: &Path) -> Option<Self> {
        match fs::metadata(path) {
            Ok(metadata) if !metadata.is_file() && !metadata.is_dir() => None,
            Ok(metadata) => {
                let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
                Some(Self { path, file: number(&metadata), is_new: false })
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
        // Of what exists, the system has found whatever name it takes for the same. Two new names it has not seen.
        let folded = |path: &Path| path.file_name().map(|name| name.to_string_lossy().to_lowercase());
        self.is_new
            && other.is_new
            && self.path.parent() == other.path.parent()
            && folded(&self.path) == folded(&other.path)
            && self.path.parent().is_some_and(ignores_case)
    }
}

/// Device and number of a file, where the system gives them.
fn number(metadata: &fs::Metadata) -> Option<(u64, u64)> {
    #[cfg(unix)]
    let number = {
        use std::os::unix::fs::MetadataExt;
        Some((metadata.dev(), metadata.ino()))
    };
    #[cfg(not(unix))]
    let number = None;
    let _ = metadata;
    number
}

/// Whether names in a folder that differ in case alone are one; tried with a file that vanishes again.
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
                let said = guard.writes("the result", "-o", output).unwrap_err().to_string();
                assert!(said.starts_with("refusing to write the result over the robot file"), "{said}");
                assert!(said.ends_with("choose another name for -o"), "{said}");
                let mut guard = Guard::default();
                guard.writes("the matrices", "--matrices", input).unwrap();
                assert!(guard.writes("the result", "-o", output).is_err(), "{input:?} {output:?}");
            }
        }
        let mut guard = Guard::default();
        guard.reads("the robot file", &at("robot.toml"));
        guard.writes("the result", "-o", &at("sub/robot.toml")).unwrap();
        guard.writes("the matrices", "--matrices", &at("other")).unwrap();
    }

    #[test]
    fn what_is_not_there_yet_is_one_place_too() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let mut guard = Guard::default();
        guard.writes("the result", "-o", &at("new.npz")).unwrap();
        let said = guard.writes("the matrices", "--matrices", &at("./new.npz")).unwrap_err().to_string();
        assert!(said.starts_with("refusing to write the matrices and the result both to"), "{said}");
        // Whether this is the same place is the file system's choice, and only that.
        let same = guard.writes("the matrices", "--matrices", &at("NEW.npz")).is_err();
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
            let said = guard.writes_rows("-o", &at("w.parquet"), has_journal).unwrap_err().to_string();
            assert!(said.contains(&format!("refusing to write {refused}")), "{said}");
        }
        let mut guard = Guard::default();
        guard.reads("the part", &at("w.parquet.partial"));
        fs::remove_file(at("w.parquet")).unwrap();
        guard.writes_rows("-o", &at("w.parquet"), false).unwrap();

        fs::create_dir(at("model")).unwrap();
        let mut guard = Guard::default();
        guard.writes("the result", "-o", &at("model/M.csv")).unwrap();
        assert!(guard.writes_folder("the matrices", "--matrices", &at("model")).is_err());
        let mut guard = Guard::default();
        guard.writes_folder("the matrices", "--matrices", &at("model")).unwrap();
        assert!(guard.writes("the result", "-o", &at("model/M.csv")).is_err());
        guard.writes("the result", "-o", &at("model.txt")).unwrap();
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
        assert!(guard.writes_rows("-o", &at("w.parquet"), true).is_err());
        let mut guard = Guard::default();
        guard.reads("the robot file", Path::new("/dev/null"));
        guard.writes("the result", "-o", Path::new("/dev/null")).unwrap();
        guard.writes("the matrices", "--matrices", Path::new("/dev/null")).unwrap();
    }
}
