//! Rows and states that are kept while a simulation runs, and a run that goes on from them.

use super::rows::{RowNames, SimulatedRow};
use anyhow::Result;

/// Rows between two states from which a run can go on. They are the same wherever the rows go, because a step after a
/// state begins with a new matrix, and a result depends on its request alone.
pub(super) const STATE_ROWS: usize = 50;

/// Keeper of the rows of the first run.
pub trait RowKeeper {
    /// Takes a row when it is ready.
    ///
    /// # Errors
    /// A row that cannot be kept, which ends the run.
    fn row(&mut self, row: &SimulatedRow) -> Result<()>;

    /// Takes the state after this many rows.
    ///
    /// # Errors
    /// A state that cannot be kept, which ends the run.
    fn state(&mut self, rows: usize, state: &[f64]) -> Result<()>;
}

/// Keeper that keeps nothing.
pub struct NothingKept;

impl RowKeeper for NothingKept {
    fn row(&mut self, _: &SimulatedRow) -> Result<()> {
        Ok(())
    }

    fn state(&mut self, _: usize, _: &[f64]) -> Result<()> {
        Ok(())
    }
}

/// Run that was interrupted: its rows, and the state after the last of them.
pub struct BegunRun {
    pub rows: Vec<SimulatedRow>,
    pub state: Vec<f64>,
}

impl SimulatedRow {
    /// Row from the numbers of its columns; `None` with another count of numbers.
    pub fn of_numbers(mut numbers: &[f64], names: &RowNames) -> Option<Self> {
        let row = Self::read(&mut numbers, names)?;
        numbers.is_empty().then_some(row)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::Cell;

    /// The order of the columns is that in which they are read.
    #[test]
    fn a_row_is_read_from_the_numbers_of_its_columns() {
        let names = RowNames { cables: vec!["1".into(), "2".into()], points: vec!["hook".into()], has_distances: true };
        let count = SimulatedRow::columns(&names).described().len();
        let numbers: Vec<f64> = (1..=count).map(|number| number as f64).collect();
        let row = SimulatedRow::of_numbers(&numbers, &names).unwrap();
        let again: Vec<f64> = SimulatedRow::columns(&names)
            .cells(&row)
            .into_iter()
            .map(|cell| if let Cell::Number(number) = cell { number } else { panic!("a number") })
            .collect();
        assert_eq!(again, numbers);
        assert!(SimulatedRow::of_numbers(&numbers[1..], &names).is_none());
        let others = RowNames { has_distances: false, ..names };
        assert!(SimulatedRow::of_numbers(&numbers, &others).is_none());
    }
}
