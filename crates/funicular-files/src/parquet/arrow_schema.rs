//! The schema that readers based on Apache Arrow (pandas, Polars, DuckDB) look for in a Parquet file: it carries what
//! Parquet's own schema cannot, unit and description of each column.
//!
//! The schema is a message of Arrow's IPC format in base64. The library that writes such messages also writes and
//! compares arrays of every type, for which a first build of the program would take half a minute longer. The message
//! for three types of columns needs a few tables, whose fields are numbered in `Schema.fbs` and `Message.fbs` of
//! Apache Arrow's format, version 1.0.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flatbuffers::{FlatBufferBuilder, TableFinishedWIPOffset, VOffsetT, WIPOffset};
use funicular_study::table::{Column, ColumnKind};

/// Key of the schema in the file's metadata.
pub(super) const KEY: &str = "ARROW:schema";

/// Beginning of a message in the IPC format; the length of the message follows.
const CONTINUATION: [u8; 4] = [0xff; 4];

/// Field `number` of a table, as flatbuffers address it.
const fn field(number: VOffsetT) -> VOffsetT {
    4 + 2 * number
}

/// Fields of `Message`.
const MESSAGE_VERSION: VOffsetT = field(0);
const MESSAGE_HEADER_TYPE: VOffsetT = field(1);
const MESSAGE_HEADER: VOffsetT = field(2);
/// Version 5 of the metadata, which Arrow has had since 1.0.
const VERSION: i16 = 4;
/// Number of `Schema` among the types of a header.
const HEADER_IS_SCHEMA: u8 = 1;

/// Fields of `Schema`; its byte order is little-endian, the default.
const SCHEMA_FIELDS: VOffsetT = field(1);

/// Fields of `Field`.
const FIELD_NAME: VOffsetT = field(0);
const FIELD_NULLABLE: VOffsetT = field(1);
const FIELD_TYPE_TYPE: VOffsetT = field(2);
const FIELD_TYPE: VOffsetT = field(3);
const FIELD_CHILDREN: VOffsetT = field(5);
const FIELD_METADATA: VOffsetT = field(6);

/// Numbers of the types of a field.
const FLOATING_POINT: u8 = 3;
const UTF8: u8 = 5;
const BOOL: u8 = 6;
/// Field and value of `FloatingPoint`: double precision.
const PRECISION: VOffsetT = field(0);
const DOUBLE: i16 = 2;

/// Fields of `KeyValue`.
const PAIR_KEY: VOffsetT = field(0);
const PAIR_VALUE: VOffsetT = field(1);

/// Schema of the columns as the value of [`KEY`].
pub(super) fn encoded(columns: &[Column]) -> String {
    let mut message = FlatBufferBuilder::new();

    let fields: Vec<_> = columns.iter().map(|column| column_field(&mut message, column)).collect();
    let fields = message.create_vector(&fields);
    let start = message.start_table();
    message.push_slot_always(SCHEMA_FIELDS, fields);
    let schema = message.end_table(start);

    let start = message.start_table();
    message.push_slot_always(MESSAGE_VERSION, VERSION);
    message.push_slot_always(MESSAGE_HEADER_TYPE, HEADER_IS_SCHEMA);
    message.push_slot_always(MESSAGE_HEADER, schema);
    let root = message.end_table(start);
    message.finish_minimal(root);

    // Marker, length and message.
    let message = message.finished_data();
    let length = u32::try_from(message.len()).expect("a schema has far fewer than 2^32 bytes");
    STANDARD.encode([&CONTINUATION, length.to_le_bytes().as_slice(), message].concat())
}

/// Field of the schema for one column: name, type, unit and description.
fn column_field(message: &mut FlatBufferBuilder<'_>, column: &Column) -> WIPOffset<TableFinishedWIPOffset> {
    let name = message.create_string(&column.name);

    let start = message.start_table();
    let kind = match column.kind {
        ColumnKind::Real => {
            message.push_slot_always(PRECISION, DOUBLE);
            FLOATING_POINT
        }
        ColumnKind::Flag => BOOL,
        ColumnKind::Text => UTF8,
    };
    let type_table = message.end_table(start);

    let metadata: Vec<_> = [("unit", column.unit.as_ref()), ("about", column.about.as_str())]
        .into_iter()
        .filter(|(_, value)| !value.is_empty())
        .map(|(key, value)| pair(message, key, value))
        .collect();
    let metadata = message.create_vector(&metadata);
    let children = message.create_vector::<WIPOffset<TableFinishedWIPOffset>>(&[]);

    let start = message.start_table();
    message.push_slot_always(FIELD_NAME, name);
    message.push_slot_always(FIELD_NULLABLE, column.kind != ColumnKind::Flag);
    message.push_slot_always(FIELD_TYPE_TYPE, kind);
    message.push_slot_always(FIELD_TYPE, type_table);
    message.push_slot_always(FIELD_CHILDREN, children);
    message.push_slot_always(FIELD_METADATA, metadata);
    message.end_table(start)
}

/// Key and value of a field's metadata.
fn pair(message: &mut FlatBufferBuilder<'_>, key: &str, value: &str) -> WIPOffset<TableFinishedWIPOffset> {
    let (key, value) = (message.create_string(key), message.create_string(value));
    let start = message.start_table();
    message.push_slot_always(PAIR_KEY, key);
    message.push_slot_always(PAIR_VALUE, value);
    message.end_table(start)
}
