//! `clearance`: distances between cables, platform and obstacles at rest.

use super::fields::AXES;
use super::found;
use super::shared::PoseRow;
use crate::at_rest;
use crate::columns::{Columns, ResultTable, Tabled, column, parts};
use crate::request::ClearanceRequest;
use crate::table::Column;
use anyhow::Result;
use funicular::clearance::{Clearance, ClearancePair, HULL, Surroundings};
use funicular::robot::Robot;
use serde::Serialize;

/// Results of `clearance`.
#[derive(Serialize)]
pub struct Clearances {
    #[serde(skip)]
    pub robot: String,
    pub static_model: &'static str,
    pub pose: PoseRow,
    /// True if every pair keeps its required distance.
    pub free: bool,
    /// All pairs, that with the least margin first.
    pub pairs: Vec<ClearanceRow>,
    #[serde(skip)]
    pub warnings: Vec<String>,
}

/// Pair of things with its distance.
#[derive(Serialize)]
pub struct ClearanceRow {
    /// Kind of the pair: `cables`, `platform` or `obstacles`.
    pub kind: &'static str,
    /// Name of the first cable, or of a body of the platform.
    pub first: String,
    /// Name of the other cable, body or obstacle.
    pub second: String,
    /// Distance between the surfaces.
    pub distance_m: f64,
    pub required_m: f64,
    pub margin_m: f64,
    /// Nearest points, on the centre lines of cables.
    pub points_m: [[f64; 3]; 2],
}

/// Computes the distances of all pairs at the equilibrium.
///
/// # Errors
/// A robot without such an equilibrium.
pub fn run(robot: Robot, request: &ClearanceRequest) -> Result<Clearances> {
    let at_rest = at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?;
    let (robot, rest) = (&at_rest.robot, &at_rest.equilibrium);
    let around = Surroundings::of(robot);
    let mut found = around.clearances(rest);
    found.sort_by(|a, b| a.margin().total_cmp(&b.margin()));

    Ok(Clearances {
        robot: robot.name.clone(),
        static_model: rest.model.name(),
        pose: PoseRow::of(&rest.pose),
        free: found.iter().all(|of| of.margin() >= 0.0),
        pairs: found.iter().map(|of| ClearanceRow::of(robot, &around, of)).collect(),
        warnings: at_rest.warnings(None),
    })
}

impl ClearanceRow {
    fn of(robot: &Robot, around: &Surroundings, found: &Clearance) -> Self {
        let cable = |i: usize| robot.cables[i].name.clone();
        let obstacle = |i: usize| robot.obstacles[i].name.clone();
        let body = |i: usize| around.platform_names().get(i).map_or(HULL, |name| *name).to_owned();
        let (first, second) = match found.pair {
            ClearancePair::Cables(i, j) => (cable(i), cable(j)),
            ClearancePair::CableAndPlatform { cable: i, body: k } => (cable(i), body(k)),
            ClearancePair::CableAndObstacle { cable: i, obstacle: k } => (cable(i), obstacle(k)),
            ClearancePair::PlatformAndObstacle { body: k, obstacle: o } => (body(k), obstacle(o)),
        };
        Self {
            kind: found.pair.kind().name(),
            first,
            second,
            distance_m: found.distance,
            required_m: found.required,
            margin_m: found.margin(),
            points_m: found.points_w.map(Into::into),
        }
    }

    /// Columns of the pairs.
    pub fn columns() -> Columns<Self> {
        Columns::new([
            column("kind", "", "kind of the pair: cables, platform or obstacles", |row: &Self| row.kind).plain("kind"),
            column("first", "", "name of the first cable, or of a body of the platform", |row: &Self| {
                row.first.clone()
            })
            .plain("first"),
            column("second", "", "name of the other cable, body or obstacle", |row: &Self| row.second.clone())
                .plain("second"),
            column("distance_m", "m", "distance between the surfaces", |row: &Self| row.distance_m)
                .decimals("distance", "m", 4),
            column("required_m", "m", "required distance", |row: &Self| row.required_m).decimals("required", "m", 4),
            column("margin_m", "m", "distance beyond the required one", |row: &Self| row.margin_m).read_if(false),
            parts(
                "first_{}_m",
                AXES,
                "m",
                "nearest point of the first, on the centre line of a cable, {}",
                |row: &Self| row.points_m[0].map(Some),
            )
            .decimals("at", "m", 3),
            parts("second_{}_m", AXES, "m", "nearest point of the second, {}", |row: &Self| row.points_m[1].map(Some))
                .read_if(false),
        ])
    }
}

impl Tabled for Clearances {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", ClearanceRow::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(ClearanceRow::columns(), &self.pairs)
    }
}

found!(Clearances, "clearance");
