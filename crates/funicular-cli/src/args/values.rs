//! Values of options that only the program has, read from text and checked. Each error contains the value and its
//! permitted range.

use funicular_files::threads::{self, THREADS};
use funicular_formats::measurements::{NodePoint, ResponseName};
use funicular_study::request::{FitValue, PriorValue};
use funicular_study::signals::{Input, Output};
use funicular_study::values;
use funicular_study::written::{self, number, point};
use std::num::NonZeroUsize;

/// Reads a positive number.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    values::positive(number(text)?)
}

/// Reads `PATH=VALUE±DEVIATION` or `PATH=±DEVIATION`.
pub(super) fn prior(text: &str) -> Result<FitValue, String> {
    let PriorValue { path, prior, prior_std } = written::prior(text)?;
    Ok(FitValue { path, prior, prior_std: Some(prior_std), ..FitValue::default() })
}

/// Reads `NODE=X,Y,Z`.
pub(super) fn node(text: &str) -> Result<NodePoint, String> {
    let (node, place) = text.split_once('=').ok_or("a node and its point are written as in 2=0.1,0.08,0.02")?;
    let node = node.trim().parse().map_err(|_| format!("`{node}` is not the number of a node"))?;
    Ok(NodePoint { node, point_m: point(place)? })
}

/// Reads `NAME=OUTPUT/INPUT`.
pub(super) fn response(text: &str) -> Result<ResponseName, String> {
    let wrong = "a response is written as in a1=az/fz";
    let (name, signals) = text.split_once('=').ok_or(wrong)?;
    let (output, input) = signals.rsplit_once('/').ok_or(wrong)?;
    let input = Input::parse(input).map_err(|error| format!("{input}: {error}"))?;
    let output = Output::parse(output).map_err(|error| format!("{output}: {error}"))?;
    Ok(ResponseName { name: name.trim().to_owned(), input: input.name, output: output.name })
}

/// Axes of a slice: horizontal and vertical.
#[derive(Debug, Clone)]
pub(crate) struct Plane(pub(crate) [String; 2]);

/// Reads the two axes of a slice, as in `x,z`.
pub(super) fn plane(text: &str) -> Result<Plane, String> {
    match text.split(',').map(str::trim).collect::<Vec<_>>()[..] {
        [h, v] if !h.is_empty() && !v.is_empty() => Ok(Plane([h.to_owned(), v.to_owned()])),
        _ => Err(format!("`{text}` is not a pair of axes: give two names, as in x,z")),
    }
}

/// Reads the value of an axis, as in `z=1.5`.
pub(super) fn place(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or_else(|| format!("`{text}` has no value: give one, as in z=1.5"))?;
    Ok((name.trim().to_owned(), number(value)?))
}

/// Reads a number of threads.
pub(super) fn threads(text: &str) -> Result<NonZeroUsize, String> {
    let (first, last) = (THREADS.start(), THREADS.end());
    (text.trim().parse().ok().and_then(threads::checked))
        .ok_or_else(|| format!("`{text}` is not a number of threads: give a whole number from {first} to {last}"))
}
