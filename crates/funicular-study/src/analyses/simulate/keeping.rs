//! Rows and states that are kept while a simulation runs, and a run that goes on from them.

use super::rows::{RowNames, SimulatedRow};
use crate::analyses::shared::PoseRow;
use anyhow::Result;
use funicular::math::{Vec3, rotation};
use funicular::robot::Pose;

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
    pub fn of_numbers(numbers: &[f64], names: &RowNames) -> Option<Self> {
        let (cables, points) = (names.cables.len(), names.points.len());
        let mut rest = numbers;
        let mut take = |count: usize| {
            let (taken, more) = rest.split_at_checked(count)?;
            rest = more;
            Some(taken.to_vec())
        };
        let one = |numbers: Option<Vec<f64>>| numbers.and_then(|numbers| numbers.first().copied());
        let three = |numbers: Option<Vec<f64>>| numbers.and_then(|numbers| <[f64; 3]>::try_from(numbers).ok());
        let triples = |numbers: Vec<f64>| numbers.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
        let row = Self {
            t_s: one(take(1))?,
            pose: {
                let (position_m, angles) = (three(take(3))?, three(take(3))?);
                let rot_wp = rotation::from_roll_pitch_yaw_deg(angles[0], angles[1], angles[2]);
                let pose = PoseRow::of(&Pose { position_w: Vec3::from(position_m), rot_wp });
                PoseRow { roll_pitch_yaw_deg: angles, ..pose }
            },
            velocity_m_s: three(take(3))?,
            angular_velocity_rad_s: three(take(3))?,
            acceleration_m_s2: three(take(3))?,
            angular_acceleration_rad_s2: three(take(3))?,
            tensions_platform_n: take(cables)?,
            tensions_anchor_n: take(cables)?,
            unstrained_lengths_m: take(cables)?,
            length_rates_m_s: take(cables)?,
            points_m: triples(take(3 * points)?),
            point_velocities_m_s: triples(take(3 * points)?),
            clearance_margin_m: if names.has_distances { Some(one(take(1))?) } else { None },
            kinetic_energy_j: one(take(1))?,
            strain_energy_j: one(take(1))?,
            potential_energy_j: one(take(1))?,
            work_of_winches_j: one(take(1))?,
            work_of_loads_j: one(take(1))?,
            dissipated_j: one(take(1))?,
            energy_of_payloads_j: one(take(1))?,
            energy_defect_j: one(take(1))?,
        };
        rest.is_empty().then_some(row)
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
        let count = 1 + 6 + 12 + 4 * 2 + 6 + 1 + 8;
        let numbers: Vec<f64> = (1..=count).map(f64::from).collect();
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
