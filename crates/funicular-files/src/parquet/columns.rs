//! Columns of rows as columns of a Parquet file, and back.

use ::parquet::basic::{ConvertedType, LogicalType, Repetition, Type as PhysicalType};
use ::parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use ::parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType};
use ::parquet::errors::{ParquetError, Result};
use ::parquet::file::writer::SerializedColumnWriter;
use ::parquet::schema::types::{Type, TypePtr};
use funicular_study::table::{Column, ColumnKind, Values};
use std::borrow::Cow;
use std::sync::Arc;

/// Schema of the file: one field per column. Flags are always there; numbers and texts may be missing.
pub(super) fn schema(columns: &[Column]) -> Result<TypePtr> {
    let fields = columns.iter().map(|column| {
        let field = match column.kind {
            ColumnKind::Real => Type::primitive_type_builder(&column.name, PhysicalType::DOUBLE),
            ColumnKind::Flag => Type::primitive_type_builder(&column.name, PhysicalType::BOOLEAN),
            ColumnKind::Text => Type::primitive_type_builder(&column.name, PhysicalType::BYTE_ARRAY)
                .with_converted_type(ConvertedType::UTF8)
                .with_logical_type(Some(LogicalType::String)),
        };
        let required = column.kind == ColumnKind::Flag;
        let repetition = if required { Repetition::REQUIRED } else { Repetition::OPTIONAL };
        Ok(Arc::new(field.with_repetition(repetition).build()?))
    });
    Ok(Arc::new(Type::group_type_builder("rows").with_fields(fields.collect::<Result<_>>()?).build()?))
}

/// Kind of the column that a reader reads; `None` for a type that no sweep writes.
pub(super) fn kind(reader: &ColumnReader) -> Option<ColumnKind> {
    match reader {
        ColumnReader::DoubleColumnReader(_) => Some(ColumnKind::Real),
        ColumnReader::BoolColumnReader(_) => Some(ColumnKind::Flag),
        ColumnReader::ByteArrayColumnReader(_) => Some(ColumnKind::Text),
        _ => None,
    }
}

/// Writes all values of a row group's column.
pub(super) fn write(mut out: SerializedColumnWriter<'_>, values: &Values) -> Result<()> {
    /// Definition level of each value: 1 if it is there, 0 if it is missing.
    fn levels<T>(values: &[Option<T>]) -> Vec<i16> {
        values.iter().map(|value| i16::from(value.is_some())).collect()
    }

    match values {
        Values::Real(values) => {
            let present: Vec<f64> = values.iter().flatten().copied().collect();
            out.typed::<DoubleType>().write_batch(&present, Some(&levels(values)), None)?;
        }
        Values::Flag(values) => {
            out.typed::<BoolType>().write_batch(values, None, None)?;
        }
        Values::Text(values) => {
            let present: Vec<ByteArray> = values.iter().flatten().map(|text| ByteArray::from(text.as_ref())).collect();
            out.typed::<ByteArrayType>().write_batch(&present, Some(&levels(values)), None)?;
        }
    }
    out.close()
}

/// Reads the next `count` values of a column and appends them to `values`, which are of the reader's [`kind`].
pub(super) fn read(reader: &mut ColumnReader, count: usize, values: &mut Values) -> Result<()> {
    match (reader, values) {
        (ColumnReader::DoubleColumnReader(reader), Values::Real(values)) => {
            values.extend(next(reader, count)?);
        }
        (ColumnReader::BoolColumnReader(reader), Values::Flag(values)) => {
            let flags: Option<Vec<bool>> = next(reader, count)?.into_iter().collect();
            values.extend(flags.ok_or_else(|| ParquetError::General("a flag is missing".to_owned()))?);
        }
        (ColumnReader::ByteArrayColumnReader(reader), Values::Text(values)) => {
            for value in next(reader, count)? {
                let text = value.map(|bytes| bytes.as_utf8().map(|text| Cow::Owned(text.to_owned())));
                values.push(text.transpose()?);
            }
        }
        (_, values) => unreachable!("column and reader differ in kind: {values:?}"),
    }
    Ok(())
}

/// Next `count` values of a column, `None` for each missing value.
///
/// # Errors
/// A column that ends before.
fn next<T: DataType>(reader: &mut ColumnReaderImpl<T>, count: usize) -> Result<Vec<Option<T::T>>> {
    let (mut present, mut levels) = (Vec::with_capacity(count), Vec::with_capacity(count));
    let (rows, _, _) = reader.read_records(count, Some(&mut levels), None, &mut present)?;
    if rows < count {
        return Err(ParquetError::EOF(format!("a column ends after {rows} of {count} values")));
    }

    // A column whose values are all required has no levels.
    let mut present = present.into_iter();
    Ok(match levels.as_slice() {
        [] => present.map(Some).collect(),
        levels => levels.iter().map(|level| if *level == 0 { None } else { present.next() }).collect(),
    })
}
