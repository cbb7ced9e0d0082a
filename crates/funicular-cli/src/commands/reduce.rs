//! `reduce`: text, CSV and the files of the matrices.

use crate::args::{OutputArgs, ReduceArgs, ReducedTo};
use crate::errors;
use crate::output::{Content, Printed, Sink, Target};
use crate::progress::TerminalProgress;
use crate::table::{Table, counted, decimals};
use anyhow::{Context, Result, anyhow, bail};
use funicular::math::DMat;
use funicular::reduced_model::{SecondOrder, StateSpace};
use funicular_files::endings::Kind;
use funicular_files::mat::{self, Value, Variable};
use funicular_files::{Guard, atomic_file};
use funicular_formats::fmu::{self, UnitModel};
use funicular_study::analyses::Found;
use funicular_study::analyses::control_model::{ControlStateSpace, StatesRow, percent};
use funicular_study::analyses::reduce::{self, ChannelRow, Reduced, ReducedForm};
use funicular_study::json;
use funicular_study::names::ModelForm;
use funicular_study::request::ReduceRequest;
use funicular_study::robot_file::RobotFile;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use zip::write::SimpleFileOptions;

/// Runs `reduce`: prints the model and writes its matrices to files.
pub(super) fn run(of: &ReduceRequest, args: &ReduceArgs, guard: Guard) -> Result<()> {
    match args.to {
        None => print(of, &args.sink, args.matrices.as_deref(), guard),
        Some(ReducedTo::Fmu) => {
            let path = args.sink.output_file.as_deref().filter(|path| Kind::of(path) == Some(Kind::Fmu));
            let Some(path) = path else { bail!("--to fmu writes a Functional Mock-up Unit: give -o FILE.fmu") };
            print(of, &OutputArgs { format: None, output_file: None }, Some(path), guard)
        }
    }
}

/// Prints the model of a request and writes its matrices to files.
pub(super) fn print(of: &ReduceRequest, output: &OutputArgs, matrices: Option<&Path>, mut guard: Guard) -> Result<()> {
    let RobotFile { robot, text, .. } = of.robot.read()?;
    let sink = Sink::open(output, &[], &mut guard)?;
    let file = matrices.map(|path| ModelFile::open(path, &mut guard)).transpose()?;
    if matches!(file, Some(ModelFile::Fmu(_))) && of.form == ModelForm::SecondOrder {
        bail!("a Functional Mock-up Unit holds a state space: leave out --form second-order");
    }

    let mut watch = TerminalProgress::new();
    let mut found = reduce::run(robot, of, &mut watch)?;
    drop(watch);
    found.set_matrices_file(matrices.map(|path| path.display().to_string()));
    if let Some(file) = file {
        file.write(&found, &text)?;
    }
    sink.write(&found)
}

impl Printed for ReducedForm {
    fn text(&self) -> String {
        match self {
            Self::StateSpace(found) => state_space_text(found),
            Self::SecondOrder(found) => second_order_text(found),
        }
    }
}

/// Sentence in place of the file that was not requested.
const NOT_WRITTEN: &str =
    "The matrices are not written: give --matrices model.npz, model.mat, or a folder for CSV files.";

/// Names and units of inputs or outputs.
fn names(channels: &[ChannelRow]) -> String {
    channels.iter().map(|of| format!("{} [{}]", of.name, of.unit)).collect::<Vec<_>>().join(", ")
}

/// Peaks and errors of the responses, and the number of pairs that are not coupled.
fn errors_table(found: &ControlStateSpace) -> String {
    let mut errors =
        Table::new(&["response", "peak", "unit", "at [Hz]", "error [% of peak]", "at [Hz]"]).text_columns(&[0, 2]);
    let shown = found.responses.iter().filter(|of| of.coupled);
    for of in shown.clone() {
        errors.row(vec![
            format!("{}/{}", of.output, of.input),
            format!("{:.4e}", of.peak),
            of.unit.clone(),
            decimals(of.peak_hz, 4),
            percent(of.error),
            decimals(of.error_hz, 4),
        ]);
    }
    let none = match found.responses.len() - shown.count() {
        0 => String::new(),
        n => format!("{} not coupled: below a millionth of the others\n", counted(n, "response")),
    };

    format!("{errors}{none}")
}

/// Text of a state space.
fn state_space_text(found: &ControlStateSpace) -> String {
    let (modes, errors) = (Table::of(&StatesRow::columns(), &found.states), errors_table(found));
    let damping = if found.damping_error == 0.0 {
        String::new()
    } else {
        format!("; with all modes {} % would remain", percent(found.damping_error))
    };
    let pointwise = format!(
        "relative to the response at the same frequency: up to {} % ({}/{} at {} Hz, where the response is {} % of \
             its peak)",
        percent(found.pointwise_error.error),
        found.pointwise_error.output,
        found.pointwise_error.input,
        decimals(found.pointwise_error.frequency_hz, 4),
        percent(found.pointwise_error.response_over_peak),
    );
    let written = match &found.matrices_file {
        None => NOT_WRITTEN.to_owned(),
        Some(path) if Kind::of(Path::new(path)) == Some(Kind::Fmu) => {
            format!(
                "{path}: x' = A x + B u, y = C x + D u as a Functional Mock-up Unit 2.0, with robot file and description"
            )
        }
        Some(path) => format!("{path}: A, B, C, D of x' = A x + B f, y = C x + D f; description"),
    };

    format!(
        "{}: state space for frequencies below {} Hz\n{}\n\n{}; the complete model has {}, the robot {} below the \
             limit\ninputs: {}\noutputs: {}\ndamping: {}\n\n{modes}\nerror: at most {} % of the peak of each \
             response{damping}\n{errors}{pointwise}\n\n{written}\n",
        found.robot,
        found.below_hz,
        found.models.line(),
        counted(found.order, "state"),
        found.complete_order,
        counted(found.modes_below, "mode"),
        names(&found.inputs),
        names(&found.outputs),
        found.damping,
        percent(found.error),
    )
}

/// Text of a second-order model.
fn second_order_text(found: &Reduced) -> String {
    let mut errors = Table::new(&["", "max relative error"]);
    let mut row = |what: &str, error: Option<f64>| {
        errors.row(vec![what.to_owned(), error.map_or("no response: undamped".to_owned(), |e| format!("{e:.1e}"))]);
    };
    row("natural frequencies", Some(found.frequency_error));
    row("responses, due to omitted modes", found.truncation_error);
    row("responses, due to viscous damping", found.damping_error);

    let highest = found.coordinates.iter().filter_map(|of| of.clamped_frequency_hz).fold(0.0, f64::max);
    let clamped = found.coordinates.iter().filter(|of| of.clamped_frequency_hz.is_some()).count();
    let kept = match clamped {
        0 => String::new(),
        n => format!(" and {} of cables up to {} Hz", counted(n, "clamped mode"), decimals(highest, 2)),
    };

    let written = match &found.matrices_file {
        None => NOT_WRITTEN.to_owned(),
        Some(path) => format!(
            "{path}: M, C, K, B, L of M x'' + C x' + K x = B f, y = L x; ss_A, ss_B, ss_C, ss_D of its state \
                 space; the description"
        ),
    };

    format!(
        "{}: second-order model for frequencies below {} Hz\n{}\n\n{} coordinates: the platform's {}{kept}\n\
             inputs: {}\noutputs: {}\ndamping: {}\n\n{errors}\n{written}\n",
        found.robot,
        found.below_hz,
        found.models.line(),
        found.order,
        found.order - clamped,
        names(&found.inputs),
        names(&found.outputs),
        found.damping,
    )
}

/// Matrices in a file of NumPy.
const ARRAYS: Content = Content { name: "the matrices", in_words: "arrays of NumPy", fitting: &[Kind::Npz] };
/// Matrices in a file of MATLAB.
const VARIABLES: Content = Content { name: "the matrices", in_words: "variables of MATLAB", fitting: &[Kind::Mat] };

/// Unit of a simulation.
const UNIT: Content = Content { name: "the model", in_words: "a Functional Mock-up Unit", fitting: &[Kind::Fmu] };

/// Destination of the matrices.
pub(crate) enum ModelFile {
    /// NumPy archive.
    Npz(Target),
    /// File of MATLAB.
    Mat(Target),
    /// Functional Mock-up Unit.
    Fmu(Target),
    /// Folder of CSV files, new or empty.
    Folder(PathBuf),
}

impl ModelFile {
    /// Checks before the work that the destination can be written.
    pub(crate) fn open(path: &Path, guard: &mut Guard) -> Result<Self> {
        match Kind::of(path) {
            Some(Kind::Npz) => return Ok(Self::Npz(Target::open(Some(path), ARRAYS, guard)?)),
            Some(Kind::Mat) => return Ok(Self::Mat(Target::open(Some(path), VARIABLES, guard)?)),
            Some(Kind::Fmu) => return Ok(Self::Fmu(Target::open(Some(path), UNIT, guard)?)),
            _ => {}
        }

        let shown = path.display();
        guard.writes_folder(ARRAYS.name, path)?;

        if path.extension().is_some() && !path.is_dir() {
            bail!(
                "--matrices {shown} is neither an .npz, .mat or .fmu file nor a folder: write model.npz, model.mat, \
                 model.fmu, or a folder without an ending"
            );
        }
        match path.read_dir().map(|mut entries| entries.next().is_some()) {
            Ok(true) => bail!("the folder {shown} is not empty: choose another one for --matrices, or empty it"),
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

    /// Writes the model; `robot_file` is the text of the robot.
    pub(crate) fn write(&self, reduced: &ReducedForm, robot_file: &str) -> Result<()> {
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
        match self {
            Self::Npz(target) => target.write(&npz(matrices, reduced, &description)?),
            Self::Mat(target) => target.write(&mat(matrices, reduced, &description)?),
            Self::Fmu(target) => {
                let ReducedForm::StateSpace(found) = reduced else { return Ok(()) };
                target.write(&unit(found, robot_file, &description)?)
            }
            Self::Folder(path) => {
                folder(path, matrices, &description).with_context(|| format!("cannot write to {}", path.display()))
            }
        }
    }
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
fn unit(found: &ControlStateSpace, robot_file: &str, description: &[u8]) -> Result<Vec<u8>> {
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
    texts.warnings.iter().chain(&not_compiled).for_each(|warning| errors::warn(warning));
    Ok(bytes)
}

/// Writes a NumPy archive, with the names of inputs and outputs and the description beside the matrices. Every member is
/// an array, because NumPy gives the bytes of any other member.
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
