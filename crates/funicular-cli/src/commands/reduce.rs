//! `reduce`: text, CSV and the files of the matrices.

use crate::output::{Content, Printed, Target};
use crate::table::{Table, counted, decimals};
use anyhow::{Context, Result, bail};
use funicular::math::DMat;
use funicular::reduced_model::{SecondOrder, StateSpace};
use funicular_files::endings::Kind;
use funicular_files::{Guard, atomic_file};
use funicular_study::analyses::Found;
use funicular_study::analyses::reduce::{ChannelRow, Reduced};
use funicular_study::json;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use zip::write::SimpleFileOptions;

impl Printed for Reduced {
    fn text(&self) -> String {
        let mut errors = Table::new(&["", "largest relative error"]);
        let mut row = |what: &str, error: Option<f64>| {
            errors.row(vec![what.to_owned(), error.map_or("no response: undamped".to_owned(), |e| format!("{e:.1e}"))]);
        };
        row("natural frequencies", Some(self.frequency_error));
        row("responses, by modes left out", self.truncation_error);
        row("responses, by viscous damping", self.damping_error);
        let names = |channels: &[ChannelRow]| {
            channels.iter().map(|of| format!("{} [{}]", of.name, of.unit)).collect::<Vec<_>>().join(", ")
        };
        let highest = self.coordinates.iter().filter_map(|of| of.clamped_frequency_hz).fold(0.0, f64::max);
        let clamped = self.coordinates.iter().filter(|of| of.clamped_frequency_hz.is_some()).count();
        let kept = match clamped {
            0 => String::new(),
            n => format!(" and {} of cables up to {} Hz", counted(n, "clamped mode"), decimals(highest, 2)),
        };
        let written = match &self.model_file {
            None => "Nothing is written: give --model model.npz, or --model FOLDER for CSV files.".to_owned(),
            Some(path) => format!(
                "{path}: M, C, K, B, L of M x'' + C x' + K x = B f, y = L x; ss_A, ss_B, ss_C, ss_D of its state space; \
                 description.json"
            ),
        };
        format!(
            "{}: second-order model for frequencies below {} Hz\n{}\n\n{} coordinates: the platform's {}{kept}\n\
             inputs: {}\noutputs: {}\ndamping: {}\n\n{errors}\n{written}\n",
            self.robot,
            self.below_hz,
            self.models.line(),
            self.order,
            self.order - clamped,
            names(&self.inputs),
            names(&self.outputs),
            self.damping,
        )
    }

    fn csv(&self, out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
        out.write_record(["coordinate", "unit", "clamped_frequency_hz"])?;
        for of in &self.coordinates {
            out.serialize((&of.name, of.unit, of.clamped_frequency_hz))?;
        }
        Ok(())
    }
}

/// The matrices in one file.
const MATRICES: Content =
    Content { name: "the matrices", option: "--model", in_words: "arrays of NumPy", fitting: &[Kind::Npz] };

/// Destination of the matrices.
pub(crate) enum ModelFile {
    /// One NumPy archive.
    Npz(Target),
    /// A folder of CSV files, new or empty.
    Folder(PathBuf),
}

impl ModelFile {
    /// Checks before the work that it can be written.
    pub(crate) fn open(path: &Path, guard: &mut Guard) -> Result<Self> {
        if Kind::of(path) == Some(Kind::Npz) {
            return Ok(Self::Npz(Target::open(Some(path), MATRICES, guard)?));
        }
        let shown = path.display();
        guard.writes_folder(MATRICES.name, MATRICES.option, path)?;
        if path.extension().is_some() && !path.is_dir() {
            bail!(
                "--model {shown} is neither an .npz file nor a folder: write model.npz, or a folder without an ending"
            );
        }
        match path.read_dir().map(|mut entries| entries.next().is_some()) {
            Ok(true) => bail!("the folder {shown} is not empty: choose another for --model, or empty it"),
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                Err(error).with_context(|| format!("cannot write to {shown}"))
            }
            _ => {
                let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
                if !parent.unwrap_or(Path::new(".")).is_dir() {
                    bail!("cannot write to {shown}: there is no directory {}", parent.unwrap_or(path).display());
                }
                Ok(Self::Folder(path.to_owned()))
            }
        }
    }

    pub(crate) fn write(&self, reduced: &Reduced) -> Result<()> {
        let model = &reduced.model;
        let space = model.state_space();
        let matrices = matrices(model, &space);
        let mut description = Vec::new();
        json::write(&mut description, Reduced::COMMAND, &reduced.robot, reduced, &reduced.warnings)?;
        match self {
            Self::Npz(target) => target.write(&npz(&matrices, &description)?),
            Self::Folder(path) => {
                folder(path, &matrices, &description).with_context(|| format!("cannot write to {}", path.display()))
            }
        }
    }
}

/// The matrices by name: those of the second-order model, then those of the state space.
fn matrices<'a>(model: &'a SecondOrder, space: &'a StateSpace) -> [(&'static str, &'a DMat); 9] {
    [
        ("M", &model.mass),
        ("C", &model.damping),
        ("K", &model.stiffness),
        ("B", &model.input),
        ("L", &model.output),
        ("ss_A", &space.a),
        ("ss_B", &space.b),
        ("ss_C", &space.c),
        ("ss_D", &space.d),
    ]
}

/// A NumPy archive, with the description as text beside the arrays.
fn npz(matrices: &[(&str, &DMat)], description: &[u8]) -> Result<Vec<u8>> {
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    // A fixed time stamp (the earliest of the format), so that equal models give equal files.
    let options = SimpleFileOptions::default().last_modified_time(zip::DateTime::default());
    for (name, matrix) in matrices {
        archive.start_file(format!("{name}.npy"), options)?;
        archive.write_all(&npy(matrix))?;
    }
    archive.start_file("description.json", options)?;
    archive.write_all(description)?;
    Ok(archive.finish()?.into_inner())
}

/// A matrix as NumPy keeps it: format 1.0, little-endian numbers, column by column (numpy.lib.format).
fn npy(matrix: &DMat) -> Vec<u8> {
    // The array begins at a multiple of this many bytes; the header ends with a new line before it.
    const ALIGNMENT: usize = 64;
    const MAGIC: &[u8] = b"\x93NUMPY\x01\x00";

    let mut header =
        format!("{{'descr': '<f8', 'fortran_order': True, 'shape': ({}, {}), }}", matrix.nrows(), matrix.ncols());
    let before = MAGIC.len() + 2 + header.len() + 1;
    header.push_str(&" ".repeat(before.next_multiple_of(ALIGNMENT) - before));
    header.push('\n');

    let length = u16::try_from(header.len()).expect("two numbers are far shorter than 64 KiB");
    let mut bytes = [MAGIC, &length.to_le_bytes(), header.as_bytes()].concat();
    // nalgebra keeps its matrices column by column, too.
    bytes.extend(matrix.iter().flat_map(|value| value.to_le_bytes()));
    bytes
}

/// Writes a folder with one CSV file per matrix and the description. The folder appears only when it is complete.
fn folder(path: &Path, matrices: &[(&str, &DMat)], description: &[u8]) -> Result<()> {
    atomic_file::write_folder(path, |folder| {
        for (name, matrix) in matrices {
            let mut table = csv::Writer::from_path(folder.join(format!("{name}.csv")))?;
            for row in matrix.row_iter() {
                table.serialize(row.iter().collect::<Vec<_>>())?;
            }
            table.flush()?;
        }
        Ok(std::fs::write(folder.join("description.json"), description)?)
    })
}
