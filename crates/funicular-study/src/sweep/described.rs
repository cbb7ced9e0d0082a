//! Columns of maps and sweeps of any robot, for programs that read them.

use super::plan::row_columns;
use super::points::{Points, Poses};
use super::quantity::Quantity;
use crate::columns::{ANY, CommandTables};
use crate::table::{Column, ColumnKind};
use funicular::robot::Robot;

/// Tables of `map` and `sweep`: the columns that every file has, then those of each quantity.
pub(crate) fn tables() -> Vec<CommandTables> {
    // Six cables hold a platform with six degrees of freedom, so that no quantity lacks a column.
    let Ok(mut robot) = Robot::from_toml(funicular_robots::YUAN2014_4MM) else { return Vec::new() };
    robot.cables.iter_mut().for_each(|cable| ANY.clone_into(&mut cable.name));
    let poses = Poses::list(robot.clone(), Vec::new()).columns();
    let varied = Column {
        name: "PATH".to_owned(),
        unit: "".into(),
        about: "value of the number of the robot file with this path, one column for each that varies".to_owned(),
        kind: ColumnKind::Real,
    };

    let with_coordinates = |command: &'static str, coordinates: Vec<Column>| {
        let of_rows = coordinates.into_iter().chain(row_columns(&robot, &[], true)).collect();
        let of_quantities = Quantity::examples().map(|(name, quantity)| (name, each_once(quantity.columns(&robot))));
        (command, [("", of_rows)].into_iter().chain(of_quantities).collect())
    };
    vec![with_coordinates("map", poses), with_coordinates("sweep", vec![varied])]
}

/// Columns without those that have the name of one before.
fn each_once(columns: Vec<Column>) -> Vec<Column> {
    columns.into_iter().fold(Vec::new(), |mut found, column| {
        if found.iter().all(|of: &Column| of.name != column.name) {
            found.push(column);
        }
        found
    })
}
