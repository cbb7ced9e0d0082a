//! Files of the matrices of `reduce`: arrays of NumPy, variables of MATLAB, CSV files of a folder, or a Functional
//! Mock-up Unit.

use crate::destination::Bytes;
use crate::outputs::{Answered, Given, Made};
use anyhow::{Result, anyhow, bail};
use funicular::math::DMat;
use funicular::reduced_model::{SecondOrder, StateSpace};
use funicular_files::endings::Kind;
use funicular_files::mat::{self, Value, Variable};
use funicular_formats::fmu::{self, UnitModel};
use funicular_study::analyses::Found;
use funicular_study::analyses::control_model::ControlStateSpace;
use funicular_study::analyses::reduce::{ChannelRow, ReducedForm};
use funicular_study::json;
use funicular_study::names::{ModelForm, Named};
use std::io::{Cursor, Write};
use std::path::Path;
use zip::write::SimpleFileOptions;

/// Makes the file of the matrices of a model.
pub(crate) fn made(reduced: &ReducedForm, at: &Answered<'_>, kind: Option<Kind>) -> Result<Made> {
    let mut description = Vec::new();
    json::write(&mut description, ReducedForm::COMMAND, reduced.robot(), reduced, reduced.warnings())?;
    let space;
    let matrices: &[(&str, &DMat)] = match reduced {
        ReducedForm::StateSpace(found) => &state_space(&found.model.space),
        ReducedForm::SecondOrder(found) => {
            // A warning says so if there is none.
            space = found.model.state_space().ok();
            &second_order(&found.model, space.as_ref())
        }
    };
    match (kind, reduced) {
        (Some(Kind::Npz), _) => Ok(npz(matrices, reduced, &description)?.into()),
        (Some(Kind::Mat), _) => Ok(mat(matrices, reduced, &description)?.into()),
        (Some(Kind::Fmu), ReducedForm::StateSpace(found)) => {
            let Some(robot) = at.request.robot() else { bail!("a model belongs to a robot") };
            unit(found, &robot.read()?.text, &description)
        }
        (Some(Kind::Fmu), ReducedForm::SecondOrder(_)) => bail!("{UNIT_OF_SPACE}"),
        _ => Ok(Made { bytes: Bytes::Folder(folder(matrices, description)?), ..Vec::new().into() }),
    }
}

/// Message about a unit of a second-order model.
const UNIT_OF_SPACE: &str = "a Functional Mock-up Unit holds a state space: leave out ⟪form⟫ second-order";

/// Refuses a model that the file cannot hold.
pub(crate) fn check(given: &Given, path: &Path) -> Result<()> {
    if given.get("form") == Some(&ModelForm::SecondOrder.name().into()) && Kind::of(path) == Some(Kind::Fmu) {
        bail!("{UNIT_OF_SPACE}");
    }
    Ok(())
}

/// CSV files of a folder, one per matrix, and the description.
fn folder(matrices: &[(&str, &DMat)], description: Vec<u8>) -> Result<Vec<(String, Vec<u8>)>> {
    let table = |(name, matrix): &(&str, &DMat)| {
        let mut table = csv::Writer::from_writer(Vec::new());
        for row in matrix.row_iter() {
            table.serialize(row.iter().collect::<Vec<_>>())?;
        }
        let bytes = table.into_inner().map_err(|error| anyhow!("{}", error.error()))?;
        Ok((format!("{name}.csv"), bytes))
    };
    let mut files = matrices.iter().map(table).collect::<Result<Vec<_>>>()?;
    files.push(("description.json".to_owned(), description));
    Ok(files)
}

/// Matrices of a state space by name.
fn state_space(space: &StateSpace) -> [(&'static str, &DMat); 4] {
    [("A", &space.a), ("B", &space.b), ("C", &space.c), ("D", &space.d)]
}

/// Matrices by name: first those of the second-order model, then those of its state space. Rates of inputs and outputs
/// and the feedthrough are there if a signal of a drive needs them.
fn second_order<'a>(model: &'a SecondOrder, space: Option<&'a StateSpace>) -> Vec<(&'static str, &'a DMat)> {
    let mut matrices = vec![
        ("M", &model.mass),
        ("C", &model.damping),
        ("K", &model.stiffness),
        ("B", &model.input),
        ("L", &model.output),
    ];

    let [by_rate, by_acceleration] = &model.input_rates;
    let [of_rate, of_acceleration] = &model.output_rates;
    let [direct, direct_rate, direct_acceleration] = &model.feedthrough;
    let of_drives = [
        ("B1", by_rate),
        ("B2", by_acceleration),
        ("L1", of_rate),
        ("L2", of_acceleration),
        ("D0", direct),
        ("D1", direct_rate),
        ("D2", direct_acceleration),
    ];
    matrices.extend(of_drives.into_iter().filter(|(_, matrix)| matrix.iter().any(|entry| *entry != 0.0)));

    if let Some(space) = space {
        matrices.extend([("ss_A", &space.a), ("ss_B", &space.b), ("ss_C", &space.c), ("ss_D", &space.d)]);
    }
    matrices
}

/// Columns of texts that stand beside the matrices: names of inputs and outputs, and the description.
fn texts<'a>(reduced: &'a ReducedForm, description: &'a str) -> [(&'static str, Vec<&'a str>); 3] {
    let (inputs, outputs) = match reduced {
        ReducedForm::StateSpace(found) => (&found.inputs, &found.outputs),
        ReducedForm::SecondOrder(found) => (&found.inputs, &found.outputs),
    };
    let names = |channels: &'a [ChannelRow]| channels.iter().map(|of| of.name.as_str()).collect();
    [("inputs", names(inputs)), ("outputs", names(outputs)), ("description", vec![description])]
}

/// Writes a file of MATLAB, with the names of inputs and outputs and the description beside the matrices.
fn mat(matrices: &[(&str, &DMat)], reduced: &ReducedForm, description: &[u8]) -> Result<Vec<u8>> {
    let description = String::from_utf8_lossy(description);
    let mut variables: Vec<Variable> = matrices
        .iter()
        .map(|(name, matrix)| Variable { name, value: Value::Matrix(matrix.nrows(), matrix.as_slice()) })
        .collect();
    let texts = texts(reduced, &description).into_iter();
    variables.extend(texts.map(|(name, column)| Variable { name, value: Value::Texts(column) }));
    mat::bytes(&variables).ok_or_else(|| anyhow!("the matrices are too large for a file of MATLAB: write an .npz file"))
}

/// Makes a Functional Mock-up Unit, with the robot file and the description as resources.
fn unit(found: &ControlStateSpace, robot_file: &str, description: &[u8]) -> Result<Made> {
    let channels = |of: &[ChannelRow]| of.iter().map(|row| (row.name.clone(), row.unit.to_owned())).collect();
    let texts = fmu::texts(&UnitModel {
        robot: &found.robot,
        below_hz: found.below_hz,
        error: found.error,
        inputs: channels(&found.inputs),
        outputs: channels(&found.outputs),
        space: &found.model.space,
    })?;
    let resources = [("robot.toml", robot_file.as_bytes()), ("description.json", description)];
    let (bytes, not_compiled) =
        funicular_files::fmu::pack(fmu::IDENTIFIER, &texts.description, &texts.source, &resources)?;
    let warnings = texts.warnings.into_iter().chain(not_compiled).collect();
    Ok(Made { warnings, ..bytes.into() })
}

/// Writes a NumPy archive, with the names of inputs and outputs and the description beside the matrices. Every member
/// is an array, because NumPy gives the bytes of any other member.
fn npz(matrices: &[(&str, &DMat)], reduced: &ReducedForm, description: &[u8]) -> Result<Vec<u8>> {
    let description = String::from_utf8_lossy(description);
    let matrices = matrices.iter().map(|(name, matrix)| (*name, npy_of_matrix(matrix)));
    let texts = texts(reduced, &description).into_iter().map(|(name, column)| (name, npy_of_texts(&column)));

    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    // The time stamp is fixed to the earliest one of the format, so that equal models give equal files.
    let options = SimpleFileOptions::default().last_modified_time(zip::DateTime::default());
    for (name, bytes) in matrices.chain(texts) {
        archive.start_file(format!("{name}.npy"), options)?;
        archive.write_all(&bytes)?;
    }
    Ok(archive.finish()?.into_inner())
}

/// Matrix in NumPy's file format: little-endian numbers, column by column, as nalgebra stores them.
fn npy_of_matrix(matrix: &DMat) -> Vec<u8> {
    let shape = format!("({}, {})", matrix.nrows(), matrix.ncols());
    npy("<f8", &shape, matrix.iter().flat_map(|value| value.to_le_bytes()))
}

/// Texts in NumPy's file format: characters of four bytes, each text filled up with zeros to the longest.
fn npy_of_texts(texts: &[&str]) -> Vec<u8> {
    // A type without characters is none that NumPy reads back.
    let width = texts.iter().map(|text| text.chars().count()).max().unwrap_or(0).max(1);
    let characters = texts.iter().flat_map(|text| text.chars().chain(std::iter::repeat('\0')).take(width));
    npy(&format!("<U{width}"), &format!("({},)", texts.len()), characters.flat_map(|c| u32::from(c).to_le_bytes()))
}

/// Array in NumPy's file format 1.0 (numpy.lib.format).
fn npy(kind: &str, shape: &str, content: impl Iterator<Item = u8>) -> Vec<u8> {
    // The array begins at a multiple of this number of bytes. The header ends with a new line before it.
    const ALIGNMENT: usize = 64;
    const MAGIC: &[u8] = b"\x93NUMPY\x01\x00";

    let mut header = format!("{{'descr': '{kind}', 'fortran_order': True, 'shape': {shape}, }}");
    let before = MAGIC.len() + 2 + header.len() + 1;
    header.push_str(&" ".repeat(before.next_multiple_of(ALIGNMENT) - before));
    header.push('\n');

    let length = u16::try_from(header.len()).expect("a few numbers are far shorter than 64 KiB");
    let mut bytes = [MAGIC, &length.to_le_bytes(), header.as_bytes()].concat();
    bytes.extend(content);
    bytes
}
