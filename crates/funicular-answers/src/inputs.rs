//! Values of keys that are read from files, by the reader that the declaration of a key names.

mod poses;
mod robot_file;
mod tables;

pub use robot_file::read as read_robot;

use anyhow::{Context, Result, bail};
use funicular::robot::Robot;
use funicular_files::Guard;
use funicular_formats::import::{self, SourceFile};
use funicular_study::TableFault;
use funicular_study::analyses::{calibrate, estimate, gust, settle, simulate, trajectory};
use funicular_study::request::{Change, GappedColumns, InputFile, NumberColumns, Reader, Scenario};
use serde_json::Value;
use std::cell::RefCell;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

/// Files that have been read, and notes about them.
#[derive(Debug, Default)]
pub struct FilesRead {
    files: Vec<(String, PathBuf)>,
    /// Notes for the user, such as columns that are ignored.
    pub notes: Vec<String>,
}

impl FilesRead {
    /// Adds a file; `role` is its name in messages, such as "the mesh".
    pub fn add(&mut self, role: &str, path: &Path) {
        self.files.push((role.to_owned(), path.to_owned()));
    }

    /// Guard that lets no result replace these files.
    pub fn guard(&self) -> Guard {
        let mut guard = Guard::default();
        self.files.iter().for_each(|(role, path)| guard.reads(role, path));
        guard
    }
}

/// Key of a command whose value stands in files.
#[derive(Debug, Clone, Copy)]
pub struct FileKey<'a> {
    /// Name of the command.
    pub command: &'a str,
    /// Name of the key.
    pub key: &'a str,
    /// Declaration of the file.
    pub file: InputFile,
    /// Changes of another robot file.
    pub changes: &'a [Change],
}

impl FileKey<'_> {
    /// Reads the value, as JSON. `robot` is that of the request, if it has one.
    ///
    /// # Errors
    /// A file that cannot be read or that the robot contradicts; the message names file and line.
    pub fn read(&self, paths: &[PathBuf], robot: Option<&Robot>, read: &mut FilesRead) -> Result<Value> {
        let InputFile { reader, role } = self.file;
        let [path, ..] = paths else { bail!("⟪{}⟫ needs the name of a file", self.key) };
        if reader != Reader::Robot {
            for path in paths {
                read.add(role, path);
            }
        }
        let robot = || robot.context("the file belongs to a robot");

        Ok(match reader {
            Reader::Columns => {
                let robot = robot()?;
                serde_json::to_value(tables::read(path, role, &mut read.notes, |columns| self.check(columns, robot))?)?
            }
            Reader::GappedColumns => {
                let robot = robot()?;
                let check = |columns: &GappedColumns| match (self.command, self.key) {
                    ("estimate", "log") => estimate::check_log(columns, robot),
                    _ => calibrate::check_readings(columns, robot),
                };
                serde_json::to_value(tables::read_with_gaps(path, role, check)?)?
            }
            Reader::Records => serde_json::to_value(tables::read_records(path, role)?)?,
            Reader::Poses => serde_json::to_value(poses::read(path, robot()?, &mut read.notes)?)?,
            Reader::Scenario => serde_json::to_value(scenario(path, read)?)?,
            Reader::Robot => serde_json::to_value(read_robot(Some(path), self.changes, role, read)?)?,
            Reader::Source => serde_json::to_value(source(path)?)?,
            Reader::Sources => {
                let files: Result<Vec<SourceFile>> = paths.iter().map(|path| source(path)).collect();
                serde_json::to_value(files?)?
            }
            Reader::Paths => paths.iter().map(|path| Value::from(path.display().to_string())).collect(),
            Reader::Path => path.display().to_string().into(),
        })
    }

    /// Checks columns of numbers by what the command wants of them.
    fn check(&self, columns: &NumberColumns, robot: &Robot) -> Result<(), TableFault> {
        match (self.command, self.key) {
            ("settle", "trajectory") => settle::check_trajectory(columns, robot),
            ("trajectory", "path") => trajectory::check_path(columns, robot),
            ("gust", "spectrum") => gust::check_spectrum(columns),
            _ => Ok(()),
        }
    }
}

/// Reads a scenario and the tables that it names.
fn scenario(path: &Path, read: &mut FilesRead) -> Result<Scenario> {
    let shown = path.display();
    let text = fs::read_to_string(path).with_context(|| format!("cannot read the scenario {shown}"))?;
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let files = RefCell::new(read);
    let table = |name: &str| {
        let path = folder.join(name);
        let mut files = files.borrow_mut();
        files.add("the table", &path);
        tables::read(&path, "the table", &mut files.notes, |_| Ok(()))
    };
    simulate::scenario_from_toml(&text, table).with_context(|| format!("the scenario {shown}"))
}

/// Reads a file of another program as text.
fn source(path: &Path) -> Result<SourceFile> {
    let shown = path.display().to_string();
    if path.is_dir() {
        bail!("cannot read {shown}: it is a directory; name the files in it");
    }
    let file = File::open(path).with_context(|| format!("cannot read {shown}"))?;
    let mut bytes = Vec::new();
    // One byte is read beyond the limit, which shows that a file is too large.
    file.take(import::MAX_BYTES as u64 + 1).read_to_end(&mut bytes).with_context(|| format!("cannot read {shown}"))?;
    SourceFile::decode(shown, &bytes)
}
