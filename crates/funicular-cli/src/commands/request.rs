//! Requests in JSON: read from a file, and printed.

use crate::output;
use anyhow::{Context, Result, bail};
use funicular_answers::inputs::FilesRead;
use funicular_answers::outputs::{self, Wanted};
use funicular_study::request::Request;
use std::fs;
use std::io::{self, Read, Write};
use std::path::Path;

/// Maximum size of a request [bytes]: a list of a million poses takes some 100 MB.
const MAX_BYTES: u64 = 1 << 30;

/// Reads a request and the files that it wants; `-` is standard input.
pub(crate) fn read(path: &Path, read: &mut FilesRead) -> Result<(Request, Vec<Wanted>)> {
    let shown = if path.as_os_str() == "-" { "<stdin>".to_owned() } else { path.display().to_string() };
    if path.as_os_str() != "-" {
        read.add("the request", path);
    }
    let cannot = || format!("cannot read the request {shown}");
    let mut source: Box<dyn Read> = match path.as_os_str().to_str() {
        Some("-") => Box::new(io::stdin().lock()),
        _ => Box::new(fs::File::open(path).with_context(cannot)?),
    };

    // One byte more than the maximum shows that there are more.
    let mut text = String::new();
    source.by_ref().take(MAX_BYTES + 1).read_to_string(&mut text).with_context(cannot)?;
    if text.len() as u64 > MAX_BYTES {
        bail!("{shown} has more than {} MB: no request is that large; choose another file", MAX_BYTES >> 20);
    }
    let request = || {
        let mut value = Request::value_of_json(&text)?;
        let wanted = outputs::take_wanted(&mut value)?;
        Ok::<_, anyhow::Error>((Request::from_value(value)?, wanted))
    };
    request().context(shown)
}

/// Prints a request, with the files that it wants, as JSON.
pub(crate) fn print(request: &Request, wanted: &[Wanted]) -> Result<()> {
    let mut out = io::stdout().lock();
    let mut value = request.to_value();
    if let Some(files) = outputs::wanted_to_value(wanted) {
        value[outputs::FILES] = files;
    }
    let text = serde_json::to_string_pretty(&value)?;
    writeln!(out, "{text}").and_then(|()| out.flush()).map_err(output::of_stdout)
}
