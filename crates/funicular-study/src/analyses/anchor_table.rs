//! Places of anchors over time, from a table.

use super::timed_rows::TIME;
use crate::names::suggestion;
use crate::request::NumberColumns;
use crate::table_fault::TableFault;
use anyhow::{Result, anyhow, bail};
use funicular::math::Vec3;
use funicular::robot::Robot;

const AXES: [&str; 3] = ["x", "y", "z"];
/// Columns of a displacement of several anchors.
const MOVED: [&str; 3] = ["x_m", "y_m", "z_m"];

/// Places of anchors over time.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct AnchorTable {
    /// Times since the first row [s].
    pub(super) times: Vec<f64>,
    /// Places of the anchor of each cable, world axes; none for a cable without columns.
    pub(super) places_w: Vec<Option<Vec<Vec3>>>,
}

impl AnchorTable {
    /// Reads a table in a key of a request.
    ///
    /// # Errors
    /// The first fault: a column that is missing or unknown, columns of both kinds, or of different lengths.
    pub(super) fn read(key: &'static str, columns: &NumberColumns, robot: &Robot) -> Result<Self, TableFault> {
        let fault = |text: String| TableFault::of_table(key, text);
        let of_anchor = |name: &str| AXES.map(|axis| format!("anchor_{name}_{axis}_m"));
        let named: Vec<[String; 3]> = robot.cables.iter().map(|cable| of_anchor(&cable.name)).collect();
        let fixed = [TIME].iter().chain(&MOVED).map(|name| (*name).to_owned());
        let known: Vec<String> = fixed.chain(named.iter().flatten().cloned()).collect();
        let wanted = "a table of anchors has t_s, and either x_m, y_m, z_m, a displacement, or anchor_NAME_x_m, \
                      anchor_NAME_y_m, anchor_NAME_z_m of cables";
        TableFault::refuse_unknown(key, columns, &known, wanted)?;
        TableFault::refuse_uneven(key, columns)?;
        let column =
            |name: &str| columns.get(name).ok_or_else(|| fault(format!("there is no column `{name}`: {wanted}")));
        let times = column(TIME)?;
        let first = times.first().copied().unwrap_or_default();
        let is_there = |name: &str| columns.contains_key(name);
        let vectors = |[x, y, z]: [&str; 3]| -> Result<Vec<Vec3>, TableFault> {
            let (x, y, z) = (column(x)?, column(y)?, column(z)?);
            Ok((0..times.len()).map(|row| Vec3::new(x[row], y[row], z[row])).collect())
        };

        let is_moved = MOVED.iter().any(|name| is_there(name));
        let is_named = |names: &[String; 3]| names.iter().any(|name| is_there(name));
        if is_moved && named.iter().any(is_named) {
            return Err(fault("there are columns of a displacement and of places: keep those of one".to_owned()));
        }
        let places = |(cable, names): (usize, &[String; 3])| -> Result<Option<Vec<Vec3>>, TableFault> {
            if is_moved {
                let home_w = robot.cables[cable].anchor.point_w;
                return Ok(Some(vectors(MOVED)?.into_iter().map(|moved_w| home_w + moved_w).collect()));
            }
            let [x, y, z] = names;
            if is_named(names) { vectors([x, y, z]).map(Some) } else { Ok(None) }
        };
        let places_w: Vec<Option<Vec<Vec3>>> = named.iter().enumerate().map(places).collect::<Result<_, _>>()?;
        if places_w.iter().all(Option::is_none) {
            return Err(fault(format!("there is no place and no displacement: {wanted}")));
        }
        Ok(Self { times: times.iter().map(|time| time - first).collect(), places_w })
    }

    /// Keeps the anchors of the named cables, all if no names are given.
    ///
    /// # Errors
    /// A name that no cable has, or no name in the list.
    pub(super) fn of_cables(mut self, names: Option<&[String]>, robot: &Robot) -> Result<Self> {
        let Some(names) = names else { return Ok(self) };
        let all: Vec<String> = robot.cables.iter().map(|cable| cable.name.clone()).collect();
        if let Some(name) = names.iter().find(|name| !all.contains(name)) {
            return Err(anyhow!("there is no cable \"{name}\"{}", suggestion(name, &all)));
        }
        if names.is_empty() {
            bail!("`cables` is empty: name the cables whose anchors move, or leave it out for all");
        }
        for (place, name) in self.places_w.iter_mut().zip(&all) {
            if !names.contains(name) {
                *place = None;
            }
        }
        Ok(self)
    }
}
