//! Columns of numbers of a file, as every reader of tables, jobs and logs gives them.

use std::collections::BTreeMap;

/// Columns of a file, whose values are numbers, or numbers and gaps.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NumberTable<V = f64> {
    /// Values of each column, by its name.
    pub columns: BTreeMap<String, Vec<V>>,
    /// Line of each row in the file, from 1.
    pub lines: Vec<usize>,
    /// Sentences about what was taken or passed over.
    pub notes: Vec<String>,
}
