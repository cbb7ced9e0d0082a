//! `reduce`: a small second-order model of the robot for control design.

use crate::args::ReduceArgs;
use crate::output::{self, Content, Results, Target};
use crate::progress::Waiting;
use crate::state::{self, Models};
use crate::table::{Table, counted, decimals, significant};
use anyhow::{Context, Result, bail};
use funicular::math::{DMat, Vec3};
use funicular::modes;
use funicular::ports::{Input, OnCable, Output, cable_of};
use funicular::reduction::{Coordinate, DampingAt, Place, SecondOrder, StateSpace, Wanted, reduce};
use funicular::response::Quantity;
use funicular::robot::Robot;
use funicular_files::Guard;
use funicular_files::endings::Kind;
use npyz::WriterBuilder;
use serde::Serialize;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use zip::write::SimpleFileOptions;

/// Most natural frequencies that one model is to have: it has about twice as many coordinates.
const MOST_MODES: usize = 400;

#[derive(Serialize)]
pub(crate) struct Reduced {
    #[serde(skip)]
    robot: String,
    below_hz: f64,
    #[serde(flatten)]
    models: Models,
    order: usize,
    frequency_error: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    truncation_error: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    damping_error: Option<f64>,
    damping: String,
    inputs: Vec<ChannelRow>,
    outputs: Vec<ChannelRow>,
    coordinates: Vec<CoordinateRow>,
    #[serde(skip_serializing_if = "Option::is_none")]
    model_file: Option<String>,
    #[serde(skip)]
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct ChannelRow {
    name: String,
    unit: &'static str,
}

#[derive(Serialize)]
struct CoordinateRow {
    name: String,
    unit: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    clamped_frequency_hz: Option<f64>,
}

pub(crate) fn run(robot: Robot, args: &ReduceArgs, guard: &mut Guard) -> Result<Reduced> {
    let file = args.model_file.as_deref().map(|path| ModelFile::open(path, guard)).transpose()?;
    let inputs = inputs(&robot, args)?;
    let outputs = outputs(&robot, args)?;
    let at_rest = state::equilibrium(robot, &args.state)?;
    let linearisation = state::linearisation(&args.model, at_rest.equilibrium.model);
    let (dynamics, warnings) = at_rest.dynamics(linearisation, args.below_hz)?;
    modes::check_count(&dynamics, args.below_hz, MOST_MODES)?;
    let damping_at = args.damping_at_hz.map_or(DampingAt::NaturalFrequencies, DampingAt::Hz);
    let wanted = Wanted { below_hz: args.below_hz, tolerance: args.tolerance, damping_at };
    let waiting = Waiting::for_("the model, and what it leaves out");
    let from: Vec<Place> = inputs.iter().map(|(_, place)| place.clone()).collect();
    let to: Vec<(Place, Quantity)> = outputs.iter().map(|(output, place)| (place.clone(), output.quantity)).collect();
    let model = reduce(&at_rest.robot, &at_rest.equilibrium, &dynamics, &from, &to, wanted)?;
    drop(waiting);
    let mut reduced = Reduced {
        robot: at_rest.robot.name.clone(),
        below_hz: args.below_hz,
        models: Models::of(&at_rest.equilibrium, linearisation),
        order: model.mass.nrows(),
        frequency_error: model.frequency_error,
        truncation_error: model.truncation_error,
        damping_error: model.damping_error,
        damping: match (model.damping_error, damping_at) {
            (Some(0.0), _) => "viscous, exactly".to_owned(),
            (_, DampingAt::NaturalFrequencies) => {
                "constant ratios made viscous, right at every natural frequency".to_owned()
            }
            (_, DampingAt::Hz(hz)) => format!("constant ratios made viscous, right at {hz} Hz"),
        },
        inputs: inputs
            .iter()
            .map(|(input, _)| ChannelRow { name: input.name.clone(), unit: if input.is_moment { "N m" } else { "N" } })
            .collect(),
        outputs: outputs
            .iter()
            .map(|(output, _)| ChannelRow { name: output.name.clone(), unit: unit(output) })
            .collect(),
        coordinates: model.coordinates.iter().map(|of| CoordinateRow::of(&at_rest.robot, of)).collect(),
        model_file: args.model_file.as_ref().map(|path| path.display().to_string()),
        warnings,
    };
    if reduced.truncation_error.is_some_and(|error| error > args.tolerance) {
        reduced.warnings.push(format!(
            "with all modes of the cables the error is {}, more than the {} asked: a force on a cable and the motion \
             beside it have a kink that modes do not have",
            significant(reduced.truncation_error.unwrap_or_default(), 2),
            args.tolerance
        ));
    }
    if let Some(file) = file {
        file.write(&model, &reduced)?;
    }
    Ok(reduced)
}

/// The inputs asked, or every force and moment on the platform.
fn inputs(robot: &Robot, args: &ReduceArgs) -> Result<Vec<(Input, Place)>> {
    let all = ["fx", "fy", "fz", "mx", "my", "mz"];
    let asked = if args.input.is_empty() {
        let possible = robot.platform.freedoms.components();
        possible.iter().map(|&i| Input::parse(all[i])).collect::<Result<Vec<_>, _>>()?
    } else {
        args.input.clone()
    };
    let place = |input: Input| {
        let direction = input.direction(robot, args.points.input_point_m)?;
        let place = place(robot, input.on_cable.as_ref(), input.direction_w, direction)?;
        Ok((input, place))
    };
    asked.into_iter().map(place).collect()
}

/// The outputs asked, or every displacement and rotation of the platform.
fn outputs(robot: &Robot, args: &ReduceArgs) -> Result<Vec<(Output, Place)>> {
    let all = ["x", "y", "z", "rx", "ry", "rz"];
    let asked = if args.output.is_empty() {
        let possible = robot.platform.freedoms.components();
        possible.iter().map(|&i| Output::parse(all[i])).collect::<Result<Vec<_>, _>>()?
    } else {
        args.output.clone()
    };
    let place = |output: Output| {
        let direction = output.direction(robot, args.points.output_point_m)?;
        let place = place(robot, output.on_cable.as_ref(), output.direction_w, direction)?;
        Ok((output, place))
    };
    asked.into_iter().map(place).collect()
}

fn place(
    robot: &Robot,
    on_cable: Option<&OnCable>,
    direction_w: Vec3,
    direction: funicular::response::Direction,
) -> Result<Place> {
    Ok(match on_cable {
        None => Place::Platform(direction),
        Some(place) => Place::Cable {
            cable: cable_of(robot, place)?,
            fraction: place.fraction,
            direction_w: direction_w.normalize(),
        },
    })
}

fn unit(output: &Output) -> &'static str {
    match (output.is_rotation, output.quantity) {
        (false, Quantity::Displacement) => "m",
        (false, Quantity::Velocity) => "m/s",
        (false, Quantity::Acceleration) => "m/s²",
        (true, Quantity::Displacement) => "rad",
        (true, Quantity::Velocity) => "rad/s",
        (true, Quantity::Acceleration) => "rad/s²",
    }
}

impl CoordinateRow {
    fn of(robot: &Robot, coordinate: &Coordinate) -> Self {
        match coordinate {
            Coordinate::Platform(i) => Self {
                name: robot.platform.freedoms.coordinate_names()[*i].to_owned(),
                unit: if robot.platform.freedoms.is_rotation(*i) { "rad" } else { "m" },
                clamped_frequency_hz: None,
            },
            Coordinate::Clamped { cable, out_of_plane, frequency_hz } => Self {
                name: format!(
                    "cable {} {}",
                    robot.cables[*cable].name,
                    if *out_of_plane { "out of plane" } else { "in plane" }
                ),
                unit: "m √kg",
                clamped_frequency_hz: Some(*frequency_hz),
            },
        }
    }
}

/// The matrices in one file.
const MATRICES: Content =
    Content { name: "the matrices", option: "--model", in_words: "arrays of NumPy", fitting: &[Kind::Npz] };

/// Where the matrices go.
enum ModelFile {
    /// One NumPy archive.
    Npz(Target),
    /// A folder of CSV files, new or empty.
    Folder(PathBuf),
}

impl ModelFile {
    /// Checks before the work that it can be written.
    fn open(path: &Path, guard: &mut Guard) -> Result<Self> {
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

    fn write(&self, model: &SecondOrder, reduced: &Reduced) -> Result<()> {
        let space = model.state_space();
        let matrices = matrices(model, &space);
        let mut description = Vec::new();
        crate::json::write(&mut description, Reduced::COMMAND, &reduced.robot, reduced, &reduced.warnings)?;
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
    // The time of the format's beginning: the same model is the same file.
    let options = SimpleFileOptions::default().last_modified_time(zip::DateTime::default());
    for (name, matrix) in matrices {
        archive.start_file(npyz::npz::file_name_from_array_name(name), options)?;
        let mut array = Vec::new();
        let shape = [matrix.nrows() as u64, matrix.ncols() as u64];
        let mut writer = npyz::WriteOptions::new()
            .default_dtype()
            .shape(&shape)
            .order(npyz::Order::Fortran)
            .writer(&mut array)
            .begin_nd()?;
        writer.extend(matrix.iter())?;
        writer.finish()?;
        archive.write_all(&array)?;
    }
    archive.start_file("description.json", options)?;
    archive.write_all(description)?;
    Ok(archive.finish()?.into_inner())
}

/// A folder that takes its name when it is complete.
fn folder(path: &Path, matrices: &[(&str, &DMat)], description: &[u8]) -> Result<()> {
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let made = tempfile::Builder::new().prefix(".funicular-").tempdir_in(parent)?;
    for (name, matrix) in matrices {
        let mut table = csv::Writer::from_path(made.path().join(format!("{name}.csv")))?;
        for row in matrix.row_iter() {
            table.serialize(row.iter().collect::<Vec<_>>())?;
        }
        table.flush()?;
    }
    std::fs::write(made.path().join("description.json"), description)?;
    output::open_to_all(made.path())?;
    // An empty folder gives way; one that is not does not.
    std::fs::rename(made.path(), path)?;
    let _ = made.keep();
    Ok(())
}

impl Results for Reduced {
    const COMMAND: &'static str = "reduce";

    fn robot(&self) -> &str {
        &self.robot
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

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
