//! Commands whose result is a file itself: robot files, schemas, pages, files of other programs.

use crate::outputs::clock;
use crate::outputs::{self, size_of_page};
use anyhow::{Result, bail};
use funicular_files::SweepFile;
use funicular_files::endings::Kind;
use funicular_formats::export::{self, ExportFormat};
use funicular_formats::fmu::IDENTIFIER;
use funicular_formats::fmu::robot_unit::{self, FmiVersion, RobotUnit};
use funicular_formats::{import, new_robot};
use funicular_pages::pages;
use funicular_pages::pages::summary::Summary;
use funicular_study::names::SchemaSubject;
use funicular_study::request::{ExportRequest, Request, SchemaRequest};
use funicular_study::schema::MoreCommands;
use funicular_study::shared_ropes::refuse_ropes_of_request;
use funicular_study::wording::{Words, worded};
use funicular_study::{Watch, schema};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Default destination of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DefaultDestination {
    /// Standard output.
    Stdout,
    /// File of this name.
    File(&'static str),
    /// File of the rows, with the ending .html.
    BesideRows,
}

/// Commands whose result is a file, with the default destination and the meaning of their `-o`.
const DOCUMENTS: [(&str, DefaultDestination, &str); 8] = [
    ("new", DefaultDestination::Stdout, "Write the robot file to FILE, which must not exist yet; - is standard output"),
    ("schema", DefaultDestination::Stdout, TO_FILE),
    ("import", DefaultDestination::Stdout, TO_FILE),
    ("export", DefaultDestination::Stdout, TO_FILE),
    ("report", DefaultDestination::File("funicular-report.html"), TO_PAGE),
    ("live", DefaultDestination::File("funicular-live.html"), TO_PAGE),
    ("paper", DefaultDestination::File("funicular-paper.html"), TO_PAGE),
    ("plot", DefaultDestination::BesideRows, TO_PAGE_OR_FIGURE),
];

const TO_FILE: &str = "Write to FILE, completely or not at all; - is standard output";
const TO_PAGE_OR_FIGURE: &str = "Write the page to FILE, completely or not at all; - is standard output [default: \
                                 FILE.parquet with the ending .html]. FILE.svg and FILE.pdf hold one figure";
const TO_PAGE: &str = "Write the page to FILE, completely or not at all; - is standard output";

/// Default destination of a command whose result is a file, and the meaning of its `-o`; `None` for other commands.
pub fn destination(command: &str) -> Option<(DefaultDestination, &'static str)> {
    DOCUMENTS.iter().find(|(name, _, _)| *name == command).map(|(_, default, about)| (*default, *about))
}

/// Content of the file of a command.
#[derive(Debug, Clone, Copy)]
pub struct Form {
    /// Name in messages: "the page".
    pub name: &'static str,
    /// Content in messages: "a page".
    pub in_words: &'static str,
    /// Kinds of files that hold it.
    pub kinds: &'static [Kind],
    /// True if a file that exists is never replaced.
    pub is_new: bool,
}

/// Content of the file of a request; `None` for a command that has results.
pub fn form(request: &Request) -> Option<Form> {
    const ROBOT: Form = Form { name: "the robot file", in_words: "a robot file", kinds: &[Kind::Toml], is_new: false };
    const PAGE: Form = Form { name: "the page", in_words: "a page", kinds: &[Kind::Html], is_new: false };
    Some(match request {
        Request::New(_) => Form { is_new: true, ..ROBOT },
        Request::Schema(_) => Form { name: "the schema", in_words: "a JSON Schema", kinds: &[Kind::Json], ..ROBOT },
        Request::Import(of) if of.trajectory.is_some() => {
            Form { name: "the table", in_words: "a table", kinds: &[Kind::Csv], ..ROBOT }
        }
        Request::Import(_) => ROBOT,
        Request::Export(of) => of_export(of),
        Request::Report(_) | Request::Live(_) | Request::Paper(_) | Request::Plot(_) => PAGE,
        _ => return None,
    })
}

/// Content of an exported file.
fn of_export(of: &ExportRequest) -> Form {
    let (in_words, kinds): (_, &[Kind]) = match of.to {
        ExportFormat::Opensees => ("a Python script for OpenSees", &[Kind::Python]),
        ExportFormat::Moordyn if of.scenario.is_some() => ("a Python script for MoorDyn", &[Kind::Python]),
        ExportFormat::Moordyn => ("an input file of MoorDyn", &[Kind::Text]),
        ExportFormat::Mujoco => ("a model of MuJoCo", &[Kind::Xml]),
        ExportFormat::Sdf => ("a world of Gazebo", &[Kind::Sdf]),
        ExportFormat::Urdf => ("a robot in URDF", &[Kind::Urdf]),
        ExportFormat::Vtk => ("curves and polygons of VTK", &[Kind::Vtp]),
        ExportFormat::C => ("C source", &[Kind::C]),
        ExportFormat::Json => ("a table of lengths in JSON", &[Kind::Json]),
        ExportFormat::Fmu | ExportFormat::Fmu3 => ("a Functional Mock-up Unit", &[Kind::Fmu]),
    };
    Form { name: "the exported robot", in_words, kinds, is_new: false }
}

/// Destination of a document without another one; `None` is standard output.
pub fn default_path(request: &Request) -> Option<PathBuf> {
    match (destination(request.command())?.0, request) {
        (DefaultDestination::File(name), _) => Some(name.into()),
        (DefaultDestination::BesideRows, Request::Plot(of)) => Some(Path::new(&of.file).with_extension("html")),
        _ => None,
    }
}

/// File that a command has made.
pub struct Document {
    /// Content as text; empty for bytes.
    pub text: String,
    /// Content that is no text.
    pub bytes: Option<Vec<u8>>,
    /// Size in words, of pages.
    pub size: Option<String>,
    /// Sentences that the user should know before using it.
    pub warnings: Vec<String>,
    /// Notes about a file that was written.
    pub notes: Vec<String>,
}

/// Text of a schema. That of requests has the files that each command writes.
fn schema_of(of: &SchemaRequest) -> Result<String> {
    let more =
        MoreCommands { tables: vec![funicular_validation::tables()], results: vec![funicular_validation::schema()] };
    let text = schema::of_request(of, more);
    if of.of != SchemaSubject::Request {
        return Ok(text);
    }
    let mut schema: Value = serde_json::from_str(&text)?;
    for form in schema["oneOf"].as_array_mut().into_iter().flatten() {
        let command = form["title"].as_str().unwrap_or_default().to_owned();
        if let (Some(files), Some(keys)) = (outputs::schema(&command), form["properties"].as_object_mut()) {
            keys.insert(outputs::FILES.to_owned(), files);
        }
    }
    Ok(format!("{schema:#}\n"))
}

/// Makes the file of a request. `call` makes it again, and `words` are those for the names of options.
///
/// # Errors
/// The errors of the command, and a command that has results.
pub fn make(request: &Request, call: &str, words: Words, watch: &mut dyn Watch) -> Result<Document> {
    let text =
        |text: String, warnings: Vec<String>| Document { text, bytes: None, size: None, warnings, notes: Vec::new() };
    let page =
        |html: String, warnings: Vec<String>| Document { size: Some(size_of_page(html.len())), ..text(html, warnings) };
    refuse_ropes_of_request(request)?;
    Ok(match request {
        Request::New(of) => {
            let made = new_robot::run(of, words)?;
            let notes = vec![made.pose_line()];
            Document { notes, ..text(made.text, made.warnings) }
        }
        Request::Schema(of) => text(schema_of(of)?, Vec::new()),
        Request::Import(of) => {
            let import::Imported { text: made, assumed, lost } = import::run(of, words)?;
            let assumed = assumed.iter().map(|fact| format!("assumed: {fact}"));
            text(made, assumed.chain(lost.iter().map(|fact| format!("not carried over: {fact}"))).collect())
        }
        Request::Export(of) if of.to.is_unit() => {
            let (bytes, warnings) = unit(of)?;
            Document { bytes: Some(bytes), ..text(String::new(), warnings) }
        }
        Request::Export(of) => {
            let made = export::of_request(of.robot.read()?.robot, of)?;
            text(made.text, made.warnings)
        }
        Request::Report(of) if of.summary => {
            let made = Summary::of_request(of, &of.robot.read()?, (call, words), watch, &clock())?;
            page(made.html()?, made.warnings)
        }
        Request::Report(of) => {
            let made = pages::report::of_request(of, of.robot.read()?, call.to_owned())?;
            page(worded(&made.html, words), made.warnings)
        }
        // The page words its messages itself.
        Request::Live(of) => page(pages::live::live(of)?, Vec::new()),
        Request::Paper(_) => page(worded(&pages::paper::paper(call.to_owned())?, words), Vec::new()),
        Request::Plot(of) => {
            let rows = SweepFile::open(Path::new(&of.file))?;
            let made = pages::plot::plot(&rows, of.file.clone(), call.to_owned(), watch)?;
            page(worded(&made.html, words), made.notes)
        }
        other => bail!("the result of `{}` is no file of its own", other.command()),
    })
}

/// Functional Mock-up Unit with the robot in motion, and its caveats.
///
/// # Errors
/// A request that no unit can hold, no equilibrium, or no library of this machine.
pub fn unit(of: &ExportRequest) -> Result<(Vec<u8>, Vec<String>)> {
    export::refuse(of)?;
    let is_fmi3 = of.to == ExportFormat::Fmu3;
    let version = if is_fmi3 { FmiVersion::Three } else { FmiVersion::Two };
    let RobotUnit { description, source, robot, warnings } = robot_unit::of_request(of, version)?;
    let resources = [("robot.toml", robot.as_bytes())];
    let bytes = funicular_files::fmu::pack_with_c_library(IDENTIFIER, &description, &source, &resources, is_fmi3)?;
    Ok((bytes, warnings))
}
