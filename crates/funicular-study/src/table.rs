//! Tables of rows: columns, the chunks in which their values come, and the record that describes a stored table.
//!
//! Maps, sweeps and sampled robots are such tables. A [`Record`] has all that their rows depend on.

mod columns;
mod record;
mod stored;

pub(crate) use columns::Value;
pub use columns::{Chunk, Column, ColumnKind, Values};
pub use record::{Part, Record, RecordDifference, SCHEMA, axes_of};
pub use stored::SweepRows;
