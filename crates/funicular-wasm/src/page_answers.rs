//! Commands that write files elsewhere. Here their content is the answer, in JSON.

use anyhow::{Result, anyhow};
use funicular::math::rotation;
use funicular_formats::{import, new_robot, number_columns};
use funicular_study::Silent;
use funicular_study::analyses::calibrate;
use funicular_study::analyses::simulate::{self, SimulatedFrame};
use funicular_study::json::of_results;
use funicular_study::request::{CalibrateRequest, Request, SimulateRequest};
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
        Request::Schema(of) => {
            serde_json::from_str(&schema::of_request(of, schema::MoreCommands::default())).map_err(Into::into)
        }
        Request::Map(_) => rows(request),
        Request::Simulate(of) => simulated(of),
        Request::Calibrate(of) => calibrated(of),
        _ => return None,
    };
    Some(found.map(|value| value.to_string().into_bytes()))
}

/// Results of a calibration with `refit`, the linear equations with which a page fits again without some rows.
fn calibrated(of: &CalibrateRequest) -> Result<Value> {
    let found = calibrate::run(of, &mut Silent)?;
    let mut answer: Value = serde_json::from_slice(&of_results(&found, Words::Json)?)?;
    answer["refit"] = found.refit_data();
    Ok(answer)
}

/// Columns of a CSV text with gaps, as `calibrate` has them in ⟪readings⟫, in JSON: one list per column, null for an
/// empty cell. `name` is that of the file in messages.
///
/// # Errors
/// A fault of the table; the message names line and column.
pub(crate) fn table(name: &str, text: &str) -> Result<Value> {
    Ok(json!(number_columns::read_with_gaps(name, text.as_bytes())?.columns))
}

/// Results of a simulation with its picture: times, poses as position and quaternion w, x, y, z, and the points of
/// every rope from the platform to the anchor, three coordinates each.
fn simulated(of: &SimulateRequest) -> Result<Value> {
    let found = simulate::run(of.robot.read()?.robot, of, &mut Silent)?;
    let mut answer: Value = serde_json::from_slice(&of_results(&found, Words::Json)?)?;
    let frames = &found.picture.frames;
    let pose = |frame: &SimulatedFrame| {
        let [w, x, y, z] = rotation::quaternion_wxyz(&frame.pose.rot_wp);
        let at = frame.pose.position_w;
        [at.x, at.y, at.z, w, x, y, z]
    };
    let curves = |frame: &SimulatedFrame| -> Vec<Vec<f64>> {
        frame.curves.iter().map(|curve| curve.iter().flatten().copied().collect()).collect()
    };
    answer["picture"] = json!({
        "t_s": frames.iter().map(|frame| frame.t_s).collect::<Vec<_>>(),
        "poses": frames.iter().map(pose).collect::<Vec<_>>(),
        "curves_m": frames.iter().map(curves).collect::<Vec<_>>(),
        "enlargement": found.picture.enlargement(),
    });
    Ok(answer)
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
