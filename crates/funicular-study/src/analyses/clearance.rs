//! `clearance`: distances between cables, platform and obstacles at rest.

mod swaying;
mod ways;

pub use ways::WayAround;

use super::fields::AXES;
use super::found;
use super::shared::PoseRow;
use crate::Watch;
use crate::at_rest::{self, AtRest};
use crate::columns::{Columns, ResultTable, Tabled, column, parts};
use crate::error::{Cancelled, NoSolution};
use crate::request::{self, ClearanceRequest};
use crate::rows::rows;
use crate::table::Column;
use crate::text::significant;
use anyhow::{Result, bail};
use funicular::clearance::{Clearance, ClearancePair, HULL, OnTheWay, Surroundings};
use funicular::path::StraightMove;
use funicular::robot::{Pose, Robot, State};
use funicular::statics::{self, Equilibrium, StaticsError};
use swaying::Excursions;

rows! {
    /// Results of `clearance`.
    pub struct Clearances {
        pub robot: String = hidden;
        pub static_model: &'static str;
        pub pose: PoseRow;
        /// End of the move; absent without one.
        pub move_to: Option<PoseRow>;
        /// True if no pair touches, and every one keeps its required distance.
        pub free: bool;
        /// Way to the end of the move on which every pair keeps its distance, if it was searched.
        pub way: Option<WayAround>;
        /// All pairs, that with the least margin first.
        pub pairs: Vec<ClearanceRow>;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Pair of things with its distance, on a move the least one.
    pub struct ClearanceRow in tables(moves: bool, sways: bool) {
        /// Kind of the pair: cables, platform or obstacles.
        pub kind: &'static str => one.plain("kind");
        /// Name of the first cable, or of a body of the platform.
        pub first: String => one.plain("first");
        /// Name of the other cable, body or obstacle.
        pub second: String => one.plain("second");
        /// Distance between the surfaces, negative in an overlap.
        pub distance_m: f64 => one.decimals("distance", 4);
        /// Required distance, vibration included.
        pub required_m: f64;
        /// Part of the required distance for the motions of both in gusts; absent without them.
        pub vibration_m: Option<f64>;
        /// Distance beyond the required one; negative where the pair touches.
        pub margin_m: f64;
        /// Nearest points, on the centre lines of cables.
        pub points_m: [[f64; 3]; 2];
        /// Fraction of the move where the margin is least.
        pub fraction: Option<f64>
            => one.decimals("at part of way", 4).read_if(moves)
            => column(
                "crosses_at",
                "1",
                "first fraction of the move at which the cables cross each other",
                |row: &Self| row.crossing_fractions.first().copied(),
            )
            .decimals("crosses at", 6)
            .read_if(moves)
            => column("required_m", "m", "required distance", |row: &Self| row.required_m).decimals("required", 4)
            => column("vibration_m", "m", "part of the required distance for the motions in gusts", |row: &Self| {
                row.vibration_m
            })
            .decimals("for gusts", 4)
            .read_if(sways)
            => column("margin_m", "m", "distance beyond the required one", |row: &Self| row.margin_m).read_if(false)
            => parts(
                "first_{}_m",
                AXES,
                "m",
                "nearest point of the first, on the centre line of a cable, {}",
                |row: &Self| row.points_m[0].map(Some),
            )
            .decimals("at", 3)
            => parts("second_{}_m", AXES, "m", "nearest point of the second, {}", |row: &Self| {
                row.points_m[1].map(Some)
            })
            .read_if(false);
        /// Fractions of the move at which the two cables cross each other.
        pub crossing_fractions: Vec<f64> = sparse;
    }
}

/// Computes the distances of all pairs at the equilibrium, or the least ones on a move from there.
///
/// # Errors
/// A robot without such an equilibrium, or a move on which the cables do not hold the platform everywhere.
pub fn run(robot: Robot, request: &ClearanceRequest, watch: &mut dyn Watch) -> Result<Clearances> {
    if request.in_gusts && request.move_to.is_some() {
        bail!("⟪in_gusts⟫ belongs to a platform that stays at a pose: leave out ⟪move_to⟫, or ask for its end alone");
    }
    let at_rest = at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?;
    let (robot, rest) = (&at_rest.robot, &at_rest.equilibrium);
    let around = Surroundings::of(robot);
    let end = request.move_to.map(|pose| move_end(&at_rest, request, pose)).transpose()?;
    if let Some(end) = end.as_ref().filter(|_| request.find_way) {
        ways::refuse_blocked(&at_rest, &around, end)?;
    }
    let mut pairs = match &end {
        None => around.clearances(rest, None).iter().map(|of| ClearanceRow::of(robot, &around, of)).collect(),
        Some(end) => on_the_way(&at_rest, &around, end, watch)?,
    };
    if request.in_gusts {
        Excursions::of(&at_rest, &around)?.enlarge(&mut pairs);
    }
    let way = end.as_ref().filter(|_| request.find_way).map(|end| WayAround::find(&at_rest, &around, end, &*watch));
    let way = way.transpose()?;
    pairs.sort_by(|a, b| a.margin_m.total_cmp(&b.margin_m));

    Ok(Clearances {
        robot: robot.name.clone(),
        static_model: rest.model.name(),
        pose: PoseRow::of(&rest.pose),
        move_to: end.as_ref().map(PoseRow::of),
        free: pairs.iter().all(ClearanceRow::is_kept),
        way,
        pairs,
        warnings: at_rest.warnings(None),
    })
}

/// End of the requested move.
fn move_end(at_rest: &AtRest, request: &ClearanceRequest, pose: request::Pose) -> Result<Pose> {
    if request.state.hold_lengths_of_pose || matches!(at_rest.robot.state, State::Lengths(_)) {
        bail!("a move goes from pose to pose: give the first one as ⟪pose⟫, without lengths");
    }
    let end = pose.to_robot()?;
    at_rest::check_pose(&at_rest.robot, &end)?;
    Ok(end)
}

/// Equilibrium at another pose, with the model and the rule of this one.
fn rest_at(at_rest: &AtRest) -> impl FnMut(&Pose) -> Result<Equilibrium, StaticsError> {
    let AtRest { robot, equilibrium, rule, .. } = at_rest;
    let rule = rule.clone().unwrap_or_default();
    move |pose| Ok(statics::solve_at(robot, &State::Pose(*pose), equilibrium.model, &rule)?.equilibrium)
}

/// Number of parts of a way, for its progress.
const PARTS: usize = 1000;

/// Reason for which there is no equilibrium at a pose of a way.
enum Unheld {
    Statics(StaticsError),
    /// The work shall stop.
    Cancelled,
}

/// Pairs on the way from the pose of an equilibrium to another one.
fn on_the_way(at_rest: &AtRest, around: &Surroundings, end: &Pose, watch: &mut dyn Watch) -> Result<Vec<ClearanceRow>> {
    let AtRest { robot, equilibrium: rest, .. } = at_rest;
    let straight = StraightMove::between(&rest.pose, end);
    let mut rest_at = rest_at(at_rest);
    let watched = |pose: &Pose| {
        // The way is searched from its start on.
        let [way, whole] = [pose, end].map(|pose| (pose.position_w - rest.pose.position_w).norm());
        let [turn, whole_turn] = [pose, end].map(|pose| pose.rot_wp.angle_to(&rest.pose.rot_wp));
        let part = if whole > 0.0 { way / whole } else { turn / whole_turn.max(f64::MIN_POSITIVE) };
        // The end of the way is looked at first.
        if part < 1.0 {
            watch.progress((PARTS as f64 * part) as usize, PARTS, "parts of the way");
        }
        if watch.is_cancelled() { Err(Unheld::Cancelled) } else { rest_at(pose).map_err(Unheld::Statics) }
    };
    let found = around.on_the_way(&straight, watched).map_err(|(fraction, unheld)| match unheld {
        Unheld::Cancelled => anyhow::Error::from(Cancelled),
        Unheld::Statics(error) => {
            NoSolution(format!("at {} % of the move: {error}", significant(100.0 * fraction, 4))).into()
        }
    })?;
    let row = |of: &OnTheWay| ClearanceRow {
        fraction: Some(of.fraction),
        crossing_fractions: of.crossings.clone(),
        ..ClearanceRow::of(robot, around, &of.least)
    };
    Ok(found.iter().map(row).collect())
}

impl Clearances {
    /// Columns of the pairs.
    pub fn columns(&self) -> Columns<ClearanceRow> {
        ClearanceRow::columns(self.move_to.is_some(), self.pairs.iter().any(|pair| pair.vibration_m.is_some()))
    }
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
            vibration_m: None,
            margin_m: found.margin(),
            points_m: found.points_w.map(Into::into),
            fraction: None,
            crossing_fractions: Vec::new(),
        }
    }

    /// True if the pair does not touch and keeps its required distance.
    pub fn is_kept(&self) -> bool {
        self.margin_m >= 0.0
    }
}

impl Tabled for Clearances {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", ClearanceRow::columns(true, true).described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(self.columns(), &self.pairs)
    }
}

found!(Clearances, "clearance");
