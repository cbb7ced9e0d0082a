//! Rows in memory as Arrow has them.

use arrow_array::builder::{BooleanBuilder, Float64Builder, StringBuilder};
use arrow_array::{Array, ArrayRef, BooleanArray, Float64Array, RecordBatch, StringArray};
use arrow_schema::{ArrowError, DataType, Field, Schema};
use funicular_study::sweep::{Chunk, Column, ColumnKind, Record, Values};
use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// The schema of rows; every field has its `unit` and what it is (`about`) in its metadata.
pub fn schema(record: &Record) -> Schema {
    Schema::new(record.columns.iter().map(field).collect::<Vec<_>>())
}

fn field(column: &Column) -> Field {
    let kind = match column.kind {
        ColumnKind::Real => DataType::Float64,
        ColumnKind::Flag => DataType::Boolean,
        ColumnKind::Text => DataType::Utf8,
    };
    let mut about = HashMap::from([("about".to_owned(), column.about.clone())]);
    if !column.unit.is_empty() {
        about.insert("unit".to_owned(), column.unit.clone().into_owned());
    }
    Field::new(&column.name, kind, column.kind != ColumnKind::Flag).with_metadata(about)
}

/// The rows of a chunk as a batch of [`schema`].
///
/// # Errors
/// Columns that are not those of the record.
pub fn batch(record: &Record, chunk: &Chunk) -> Result<RecordBatch, ArrowError> {
    let mut rows = Builders::new(&record.columns);
    rows.add(chunk, 0..chunk.rows());
    rows.finish(&Arc::new(schema(record)))
}

/// Columns that grow.
pub(crate) struct Builders(Vec<Builder>);

enum Builder {
    Real(Float64Builder),
    Flag(BooleanBuilder),
    Text(StringBuilder),
}

impl Builders {
    pub(crate) fn new(columns: &[Column]) -> Self {
        Self(
            columns
                .iter()
                .map(|column| match column.kind {
                    ColumnKind::Real => Builder::Real(Float64Builder::new()),
                    ColumnKind::Flag => Builder::Flag(BooleanBuilder::new()),
                    ColumnKind::Text => Builder::Text(StringBuilder::new()),
                })
                .collect(),
        )
    }

    /// Adds some rows of a chunk whose columns are of these kinds.
    pub(crate) fn add(&mut self, chunk: &Chunk, rows: Range<usize>) {
        for (builder, values) in self.0.iter_mut().zip(&chunk.columns) {
            match (builder, values) {
                (Builder::Real(builder), Values::Real(values)) => {
                    values[rows.clone()].iter().for_each(|value| builder.append_option(*value));
                }
                (Builder::Flag(builder), Values::Flag(values)) => {
                    values[rows.clone()].iter().for_each(|value| builder.append_value(*value));
                }
                (Builder::Text(builder), Values::Text(values)) => {
                    values[rows.clone()].iter().for_each(|value| builder.append_option(value.as_deref()));
                }
                (_, values) => unreachable!("a column of another kind: {values:?}"),
            }
        }
    }

    /// What was added, as a batch; the builders are empty then.
    pub(crate) fn finish(&mut self, schema: &Arc<Schema>) -> Result<RecordBatch, ArrowError> {
        let columns = self
            .0
            .iter_mut()
            .map(|builder| match builder {
                Builder::Real(builder) => Arc::new(builder.finish()) as ArrayRef,
                Builder::Flag(builder) => Arc::new(builder.finish()),
                Builder::Text(builder) => Arc::new(builder.finish()),
            })
            .collect();
        RecordBatch::try_new(Arc::clone(schema), columns)
    }
}

/// The values of a batch, with all its columns; `None` for kinds that no chunk has.
pub(crate) fn values(batch: &RecordBatch) -> Option<Vec<Values>> {
    fn options<T>(array: &dyn Array, at: impl Fn(usize) -> T) -> Vec<Option<T>> {
        (0..array.len()).map(|i| array.is_valid(i).then(|| at(i))).collect()
    }
    batch
        .columns()
        .iter()
        .map(|column| {
            let any = column.as_any();
            if let Some(array) = any.downcast_ref::<Float64Array>() {
                Some(Values::Real(options(array, |i| array.value(i))))
            } else if let Some(array) = any.downcast_ref::<BooleanArray>() {
                Some(Values::Flag((0..array.len()).map(|i| array.value(i)).collect()))
            } else {
                let array = any.downcast_ref::<StringArray>()?;
                Some(Values::Text(options(array, |i| Cow::Owned(array.value(i).to_owned()))))
            }
        })
        .collect()
}
