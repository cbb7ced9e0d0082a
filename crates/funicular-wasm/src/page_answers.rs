//! Commands that write files elsewhere. Here their content is the answer, in JSON.

use anyhow::{Result, anyhow};
use funicular_formats::{import, new_robot};
use funicular_study::request::Request;
use funicular_study::schema;
use funicular_study::sweep::{Plan, PreparedSweep};
use funicular_study::table::{Chunk, Values};
use funicular_study::wording::Words;
use serde_json::{Map, Value, json};

/// Content that a command would write to a file; `None` for a command whose results are data.
pub(crate) fn content(request: &Request) -> Option<Result<Vec<u8>>> {
    let found = match request {
        Request::Import(of) => import::run(of, Words::Json)
            .map(|found| json!({ "text": found.text, "assumed": found.assumed, "lost": found.lost })),
        Request::New(of) => new_robot::run(of, Words::Json).map(|found| json!({ "text": found.text })),
        Request::Schema(of) => serde_json::from_str(&schema::of_request(of, Vec::new())).map_err(Into::into),
        Request::Map(_) => rows(request),
        _ => return None,
    };
    Some(found.map(|value| value.to_string().into_bytes()))
}

/// Rows of a map, computed on this thread: one list per column. A value that does not exist is null.
fn rows(request: &Request) -> Result<Value> {
    let prepared = PreparedSweep::new(request)?;
    let plan = prepared.plan()?;
    let chunks: Vec<Chunk> = (0..plan.chunks()).filter_map(|index| plan.evaluate(index, || false)).collect();
    Ok(json!({ "columns": columns(&plan, &chunks)?, "units": units(&plan) }))
}

fn columns(plan: &Plan<'_>, chunks: &[Chunk]) -> Result<Map<String, Value>> {
    let column = |i: usize| -> Result<Vec<Value>> {
        let mut all = Vec::with_capacity(plan.rows());
        for chunk in chunks {
            let values = chunk.columns.get(i).ok_or_else(|| anyhow!("a chunk has no column {i}"))?;
            match values {
                Values::Real(values) => all.extend(values.iter().map(|value| json!(value))),
                Values::Flag(values) => all.extend(values.iter().map(|value| json!(value))),
                Values::Text(values) => all.extend(values.iter().map(|value| json!(value))),
            }
        }
        Ok(all)
    };
    plan.columns().iter().enumerate().map(|(i, of)| Ok((of.name.clone(), Value::from(column(i)?)))).collect()
}

fn units(plan: &Plan<'_>) -> Map<String, Value> {
    plan.columns().iter().map(|column| (column.name.clone(), Value::from(column.unit.as_ref()))).collect()
}
