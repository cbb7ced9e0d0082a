//! Stored rows of a map or sweep.

use super::columns::Chunk;
use super::record::Record;
use anyhow::Result;

/// Stored rows of a map or sweep, as the source of a page.
pub trait SweepRows {
    /// Description of the rows.
    fn record(&self) -> &Record;

    /// Number of rows.
    fn rows(&self) -> usize;

    /// Index of the first row among the rows of all parts.
    fn first_row(&self) -> usize;

    /// True if all rows are there.
    fn is_complete(&self) -> bool;

    /// Passes the rows to `take` in chunks, in order.
    ///
    /// # Errors
    /// A damaged file.
    fn each(&self, take: &mut dyn FnMut(&Chunk)) -> Result<()>;
}
