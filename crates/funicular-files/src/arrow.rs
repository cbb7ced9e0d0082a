//! Rows in memory in the format of Apache Arrow.

use arrow_array::builder::{BooleanBuilder, Float64Builder, StringBuilder};
use arrow_array::{Array, ArrayRef, BooleanArray, Float64Array, RecordBatch, StringArray};
use arrow_schema::{ArrowError, DataType, Field, Schema};
use funicular_study::table::{Chunk, Column, ColumnKind, Record, Values};
use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// Arrow schema of the rows. The metadata of every field hold its `unit` and a description (`about`).
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

/// Rows of a chunk as a record batch with this [`schema`].
///
/// # Errors
/// Columns that are not those of the record.
pub fn batch(record: &Record, chunk: &Chunk) -> Result<RecordBatch, ArrowError> {
    let mut rows = ColumnBuilders::new(&record.columns);
    rows.add(chunk, 0..chunk.rows());
    rows.finish(&Arc::new(schema(record)))
}

/// Builders of all columns.
pub(crate) struct ColumnBuilders(Vec<Builder>);

enum Builder {
    Real(Float64Builder),
    Flag(BooleanBuilder),
    Text(StringBuilder),
}

impl ColumnBuilders {
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

    /// Adds rows of a chunk; its columns have to be of the builders' kinds.
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
                (_, values) => unreachable!("column and builder differ in kind: {values:?}"),
            }
        }
    }

    /// Returns the added rows as a batch and leaves the builders empty.
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

/// Values of a batch, column by column; `None` if a column has a type that no chunk has.
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
