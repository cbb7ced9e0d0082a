//! `payload`: minimum and maximum payload at a pose.

use super::shared::{LimitNumbers, PoseRow};
use super::{fields, found};
use crate::at_rest::{self, AtRest};
use crate::columns::{Columns, Field, ResultTable, Tabled, column};
use crate::error::NoSolution;
use crate::request;
use crate::rows::rows;
use crate::table::Column;
use crate::text::NONE;
use crate::text::significant;
use anyhow::Result;
use funicular::math::Vec3;
use funicular::robot::{Pose, Robot, State};
use funicular::statics::{
    self, CableState, Equilibrium, LimitAtCable, PayloadBound, PayloadSide, RequestedPayload, StaticModel,
    StaticsError, TensionRange,
};

rows! {
    /// Results of `payload`: the payloads that the cables hold at a pose.
    pub struct Payload {
        pub robot: String = hidden;
        pub static_model: &'static str;
        /// Mass of the platform, without payload.
        pub mass_kg: f64;
        pub pose: PoseRow;
        pub payload_center_m: [f64; 3];
        /// Minimum payload; zero if the tensions without payload are within their limits.
        pub minimum: BoundRow;
        /// Maximum payload; absent if no maximum tension limits it.
        pub maximum: Option<BoundRow>;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Minimum or maximum payload.
    pub struct BoundRow {
        pub payload_kg: f64;
        /// Proved limit: no payload of at least this mass is possible; absent without a proof.
        pub excluded_from_kg: Option<f64>;
        /// Tensions with this payload; empty without a payload.
        pub cables: Vec<LoadedRow>;
    }
}

rows! {
    /// Cable with the payload.
    pub struct LoadedRow {
        pub name: String;
        pub tension_platform_n: f64;
        pub tension_anchor_n: f64;
        pub limits: LimitNumbers = spread;
        /// Place where the limit is reached: `platform`, `anchor`, `lowest point` or `anywhere`.
        pub limit_place: Option<&'static str>;
    }
}

/// Finds the minimum and the maximum payload.
///
/// # Errors
/// A request that contradicts itself or the robot, or a pose that the cables hold with no payload.
pub fn run(robot: Robot, request: &request::PayloadRequest) -> Result<Payload> {
    let request::PayloadRequest { payload_center_m, state, tensions, .. } = request;
    let center_p = at_rest::payload_center(&robot, *payload_center_m)?;
    let model = state.static_model;

    // The equilibrium without payload need not exist: a payload may be needed to keep the cables taut.
    match at_rest::equilibrium(robot.clone(), &request.robot, state, tensions) {
        Ok(rest) => about(&rest, center_p),
        Err(error) => {
            let no_solution = error.downcast_ref().is_some_and(StaticsError::is_no_solution);
            let robot = at_rest::with_limits(&at_rest::with_state(robot, state)?, tensions)?;
            let (true, false, State::Pose(pose)) = (no_solution, state.hold_lengths_of_pose, robot.state.clone())
            else {
                return Err(error);
            };
            let center_p = center_p.unwrap_or(robot.platform.center_of_mass_p);
            match bounds(&robot, &pose, model, center_p, None) {
                // Without any payload that helps, the reason of the equilibrium says more.
                Err(other) if matches!(other.downcast_ref(), Some(StaticsError::NoPayload)) => Err(error),
                found => found,
            }
        }
    }
}

/// Finds the payloads at the pose of an equilibrium. Without a centre the payload has that of the platform.
///
/// # Errors
/// The errors of [`run`].
pub fn about(at_rest: &AtRest, center_p: Option<Vec3>) -> Result<Payload> {
    let AtRest { robot, equilibrium, .. } = at_rest;
    let center_p = center_p.unwrap_or(robot.platform.center_of_mass_p);
    let mut found = bounds(robot, &equilibrium.pose, equilibrium.model, center_p, Some(equilibrium))?;
    found.warnings = at_rest.warnings(None);
    Ok(found)
}

fn bounds(
    robot: &Robot,
    pose: &Pose,
    model: StaticModel,
    center_p: Vec3,
    start: Option<&Equilibrium>,
) -> Result<Payload> {
    let bound = |side| {
        let requested = RequestedPayload { center_p, side, prove: true };
        statics::payload_bound(robot, pose, model, requested, start)
    };
    let maximum = bound(PayloadSide::Maximum)?;
    if maximum.mass < 0.0 {
        let limits: Vec<String> = (maximum.limits.iter())
            .map(|of| format!("the {} of cable \"{}\"", of.limit.name(), robot.cables[of.cable].name))
            .collect();
        return Err(NoSolution(format!(
            "the platform of {} kg is too heavy for this pose by {} kg, because of {}; choose another pose or mass, or \
             widen the limits (`minimum_tension_n`, `maximum_tension_n`)",
            robot.platform.mass,
            significant(-maximum.mass, 5),
            limits.join(", ")
        ))
        .into());
    }

    let minimum = if start.is_some_and(|start| is_within_limits(robot, start)) {
        BoundRow { payload_kg: 0.0, excluded_from_kg: None, cables: Vec::new() }
    } else {
        BoundRow::of(robot, &bound(PayloadSide::Minimum)?)
    };
    Ok(Payload {
        robot: robot.name.clone(),
        static_model: model.name(),
        mass_kg: robot.platform.mass,
        pose: PoseRow::of(pose),
        payload_center_m: center_p.into(),
        minimum,
        maximum: maximum.mass.is_finite().then(|| BoundRow::of(robot, &maximum)),
        warnings: Vec::new(),
    })
}

/// True if all tensions are within their limits, to the accuracy of tension distributions.
fn is_within_limits(robot: &Robot, rest: &Equilibrium) -> bool {
    rest.cables.iter().enumerate().all(|(i, cable)| {
        let margin = TensionRange::of(robot, i, &cable.chord_w()).margin(cable);
        margin.distance() >= -1e-6 * margin.max.max(margin.range.minimum)
    })
}

impl BoundRow {
    fn of(robot: &Robot, bound: &PayloadBound) -> Self {
        let cables = LoadedRow::all(robot, &bound.cables, &bound.limits);
        Self { payload_kg: bound.mass, excluded_from_kg: bound.excluded_from, cables }
    }
}

/// Cable with the minimum or the maximum payload.
struct BoundedRow<'a> {
    name: &'static str,
    bound: &'a BoundRow,
    cable: &'a LoadedRow,
}

impl LoadedRow {
    /// Rows of cables with the limits that they reach.
    pub(crate) fn all(robot: &Robot, cables: &[CableState], limits: &[LimitAtCable]) -> Vec<Self> {
        let row = |(i, cable): (usize, &CableState)| Self {
            name: robot.cables[i].name.clone(),
            tension_platform_n: cable.tension_platform,
            tension_anchor_n: cable.tension_anchor,
            limits: LimitNumbers::of(&TensionRange::of(robot, i, &cable.chord_w()).margin(cable)),
            limit_place: limits.iter().find(|of| of.cable == i).map(|of| of.place.name()),
        };
        cables.iter().enumerate().map(row).collect()
    }

    /// Columns of the tensions with a payload, for reading.
    pub fn columns() -> Columns<Self> {
        Columns::new(Self::fields(|row: &Self| row))
    }

    fn fields<R>(of: impl Fn(&R) -> &Self + Copy + 'static) -> [Field<R>; 7] {
        let [at_platform, at_anchor] =
            fields::tensions(move |row| [of(row).tension_platform_n, of(row).tension_anchor_n]);
        let [range, margin, reached] = fields::limits(move |row| Some(&of(row).limits));
        [
            fields::cable_name(move |row| of(row).name.clone()),
            at_platform,
            at_anchor,
            range,
            margin.read_if(false),
            reached,
            column("limit_place", "", "place in the cable where it is reached", move |row| of(row).limit_place).shown(
                "at its limit",
                "",
                move |row, _| {
                    let reached = of(row).limits.limit_reached.zip(of(row).limit_place);
                    reached.map_or_else(|| NONE.to_owned(), |(limit, place)| format!("{limit}, {place}"))
                },
            ),
        ]
    }
}

impl<'a> BoundedRow<'a> {
    fn columns() -> Columns<Self> {
        let of_bound = [
            column("bound", "", "minimum or maximum payload", |row: &Self| row.name),
            column("payload_kg", "kg", "payload", |row: &Self| row.bound.payload_kg),
            column("excluded_from_kg", "kg", "mass that is proved to be too much", |row: &Self| {
                row.bound.excluded_from_kg
            }),
        ];
        Columns::new(of_bound.into_iter().chain(LoadedRow::fields(|row: &Self| row.cable)))
    }

    fn all(found: &'a Payload) -> impl Iterator<Item = Self> {
        let bounds = [("minimum", Some(&found.minimum)), ("maximum", found.maximum.as_ref())];
        bounds
            .into_iter()
            .filter_map(|(name, bound)| Some((name, bound?)))
            .flat_map(|(name, bound)| bound.cables.iter().map(move |cable| Self { name, bound, cable }))
    }
}

impl Tabled for Payload {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", BoundedRow::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(BoundedRow::columns(), BoundedRow::all(self))
    }
}

found!(Payload, "payload");
