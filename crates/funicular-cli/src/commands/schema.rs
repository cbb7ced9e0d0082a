//! `schema`: the JSON Schema of the robot file or of requests.

use crate::errors;
use crate::output::{Content, Target};
use anyhow::Result;
use funicular_files::Guard;
use funicular_files::endings::Kind;
use funicular_study::request::SchemaRequest;
use funicular_study::schema;
use std::path::Path;

/// Writes the JSON Schema.
pub(super) fn write(of: &SchemaRequest, guard: &mut Guard, path: &Path) -> Result<()> {
    let content = Content { name: "the schema", in_words: "a JSON Schema", fitting: &[Kind::Json] };
    let target = Target::open(Some(path), content, guard)?;
    target.write(schema::of_request(of, vec![funicular_validation::tables()]).as_bytes())?;
    if target.is_file() {
        errors::note(&format!("wrote {}", path.display()));
    }
    Ok(())
}
