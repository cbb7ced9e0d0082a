//! The program as a user meets it: command line in; output, messages and exit code out.

mod bad_input;
mod cable;
mod calibrate;
mod clearance;
mod coming_from;
mod compare;
mod defaults;
mod design;
mod estimate;
mod export;
mod figures;
mod files;
mod frf;
mod gcode;
mod gradient;
mod gust;
mod identify;
mod import;
mod length_tables;
mod links;
mod loads;
mod messages;
mod modes;
mod motion;
mod motion_unit;
mod new_robot;
mod observability;
mod pages;
mod payload;
mod plots;
mod pose_error;
mod prove;
mod readme;
mod reduce;
mod request;
mod results;
mod results_schema;
mod settle;
mod shell;
mod simulate;
mod speeds;
mod statics;
mod stiffness;
mod sweeps;
mod trajectory;
mod uncertainty;
mod validate;
mod wind;
mod wording;
mod workspace;
mod written_files;

use assert_cmd::Command;
use serde_json::Value;
use std::path::PathBuf;
use std::process::Output;

/// Path of a robot of the library.
fn robot(name: &str) -> String {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "..", "..", "robots", name].iter().collect();
    path.to_str().expect("the path is text").to_owned()
}

/// Path of a file of the project.
fn project(name: &str) -> String {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "..", "..", name].iter().collect();
    path.to_str().expect("the path is text").to_owned()
}

/// Text of the robot most tests use.
fn yuan() -> String {
    std::fs::read_to_string(robot("yuan2014-4mm.toml")).expect("the robot file is there")
}

/// Runs the program with arguments; `ROBOT` among them stands for the robot most tests use.
fn run(arguments: &[&str]) -> Output {
    command(arguments).output().expect("the program starts")
}

/// As [`run`], with a robot file on standard input.
fn run_with(arguments: &[&str], robot: &str) -> Output {
    command(arguments).write_stdin(robot).output().expect("the program starts")
}

fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_funicular"));
    let path = robot("yuan2014-4mm.toml");
    command.args(arguments.iter().map(|argument| if *argument == "ROBOT" { path.as_str() } else { argument }));
    command
}

fn stdout(output: &Output) -> &str {
    std::str::from_utf8(&output.stdout).expect("stdout is UTF-8")
}

fn stderr(output: &Output) -> &str {
    std::str::from_utf8(&output.stderr).expect("stderr is UTF-8")
}

/// Stdout of a command that succeeds.
fn succeed(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    stdout(&output).to_owned()
}

/// JSON of a command that succeeds.
fn json(arguments: &[&str]) -> Value {
    let text = succeed(&[arguments, &["--format", "json"]].concat());
    let results = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{arguments:?}: {error}"));
    results_schema::check(&results, arguments[0]);
    results
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is a number"))
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap_or_else(|| panic!("{value} is an array")).iter().map(number).collect()
}

fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance
}

/// The table of a CSV: header and rows of equal length.
fn csv(arguments: &[&str]) -> (Vec<String>, Vec<Vec<String>>) {
    let text = succeed(&[arguments, &["--format", "csv"]].concat());
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let rows = reader.records().map(|row| row.unwrap().iter().map(str::to_owned).collect()).collect();
    (header, rows)
}

/// Results of a command whose robot file is this text.
fn json_of(arguments: &[&str], file: &str) -> Value {
    let output = run_with(&[arguments, &["--format", "json"]].concat(), file);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let results = serde_json::from_str(stdout(&output)).unwrap();
    results_schema::check(&results, arguments[0]);
    results
}
