//! `statics`: equilibrium of the robot.

mod centre;

pub use centre::CentreRow;

use super::fields::{self, AXES};
use super::found;
use super::shared::{LimitNumbers, LoadRow, PoseDifferenceRow, PoseRow, SagNumbers, WindRow};
use crate::at_rest::{self, AtRest};
use crate::columns::{Columns, Field, ResultTable, Style, Tabled, any, column, only_read, parts};
use crate::request;
use crate::rows::rows;
use crate::table::Column;
use crate::text::short;
use anyhow::Result;
use funicular::cable::Sag;
use funicular::pose_error::PoseDifference;
use funicular::robot::{Pose, Robot, State, Support, TensionLimits};
use funicular::statics::{
    self, CableFriction, CableState, Candidate, Equilibrium, FreeMotion, FrictionInterval, Held, Interval,
    MotionInterval, TensionRange,
};
use std::fmt::Display;

rows! {
    /// Results of `statics`: an equilibrium.
    pub struct Statics {
        pub robot: String = hidden;
        pub static_model: &'static str;
        pub mass_kg: f64;
        /// Load on the platform; absent if there is none.
        pub load: Option<LoadRow>;
        /// Wind; absent in still air.
        pub wind: Option<WindRow>;
        pub pose: PoseRow;
        /// Distance from the requested pose; present only with fewer cables than degrees of freedom and a requested
        /// pose.
        pub nearest_pose_distance_m: Option<f64>;
        /// Motion from the pose whose lengths are held to the equilibrium; absent if no lengths are held.
        pub held: Option<HeldRow>;
        /// Tension rule; absent if there was no choice of tensions.
        pub tension_rule: Option<&'static str>;
        /// Proof that the tensions of the rule `centre` are the only ones; absent for other rules.
        pub centre: Option<CentreRow>;
        pub cables: Vec<CableRow>;
        /// Flexible supports; absent on a rigid frame.
        pub supports: Vec<SupportRow> = sparse;
        pub residual: f64;
        /// True if there are neither loads nor tensions; the residual then has no meaning.
        pub is_unloaded: bool = hidden;
        pub iterations: usize;
        /// True for a stable equilibrium; absent for ideal cables, which are rigid.
        pub stable: Option<bool>;
        pub stiffness_min_n_per_m: Option<f64>;
        /// Motions that no cable opposes by its tension; absent unless the directions of the cables are dependent or
        /// the equilibrium is indifferent.
        pub free_motions: Vec<FreeMotionRow> = sparse;
        pub another_stable_equilibrium: Option<OtherStable>;
        /// All equilibria that the search of `all` found, with the lowest energy first.
        pub equilibria: Option<Vec<EquilibriumRow>>;
        pub search: Option<Search>;
        /// Interval in which friction of pulleys leaves the robot; absent unless requested.
        pub friction_interval: Option<FrictionRow>;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Motion of the platform that no cable opposes by its tension: a rotation about an axis, or a translation.
    pub struct FreeMotionRow {
        /// Axis of the rotation, unit vector; zero for a translation.
        pub rotation: [f64; 3];
        /// Velocity of the platform origin, per radian with a rotation.
        pub translation_m: [f64; 3];
        /// Point on the axis.
        pub point_m: [f64; 3];
        /// False if nothing holds the platform; absent for ideal cables.
        pub held: Option<bool>;
        /// The motion in words.
        pub text: String;
    }
}

impl FreeMotionRow {
    fn all(robot: &Robot, equilibrium: &Equilibrium) -> Vec<Self> {
        let row = |free: FreeMotion| Self {
            rotation: free.rotation_w.into(),
            translation_m: free.translation_w.into(),
            point_m: free.point_w.into(),
            held: free.is_held,
            text: free.to_string(),
        };
        statics::free_motions(robot, equilibrium).into_iter().map(row).collect()
    }
}

rows! {
    /// Another equilibrium of the same lengths.
    pub struct EquilibriumRow {
        pub stable: bool;
        /// Number of directions in which the energy falls.
        pub falling_directions: usize;
        /// Number of directions in which the energy does not change.
        pub indifferent_directions: usize;
        /// Energy above the lowest equilibrium; absent if the loads have no potential.
        pub energy_j: Option<f64>;
        /// Distance from the first equilibrium.
        pub distance_m: f64;
        pub pose: PoseRow;
        pub tensions_platform_n: Vec<f64>;
    }
}

impl EquilibriumRow {
    fn of(candidate: &Candidate) -> Self {
        Self {
            stable: candidate.is_stable(),
            falling_directions: candidate.falling,
            indifferent_directions: candidate.indifferent,
            energy_j: candidate.energy,
            distance_m: candidate.distance,
            pose: PoseRow::of(&candidate.equilibrium.pose),
            tensions_platform_n: candidate.equilibrium.cables.iter().map(|cable| cable.tension_platform).collect(),
        }
    }
}

impl EquilibriumRow {
    /// Columns of the equilibria of a robot with these cables.
    fn columns(cables: impl IntoIterator<Item = impl Display>) -> Columns<Self> {
        let [position, angles] =
            fields::pose(|row: &Self| Some(row.pose.position_m), |row: &Self| Some(row.pose.roll_pitch_yaw_deg));
        Columns::new([
            column("stable", "", "the equilibrium is stable", |row: &Self| row.stable),
            column("falling_directions", "1", "number of directions in which the energy falls", |row: &Self| {
                row.falling_directions
            }),
            column("indifferent_directions", "1", "number of directions in which it stays", |row: &Self| {
                row.indifferent_directions
            }),
            column("energy_j", "J", "energy above the lowest equilibrium", |row: &Self| row.energy_j),
            column("distance_m", "m", "distance from the first equilibrium", |row: &Self| row.distance_m),
            position,
            angles,
            parts("tension_platform_{}_n", cables, "N", "tension of cable {} at the platform", |row: &Self| {
                row.tensions_platform_n.clone()
            }),
        ])
    }
}

rows! {
    /// Statistics of a search for all equilibria.
    pub struct Search {
        pub starts: usize;
        /// Sum of (−1)^falling_directions over the equilibria that were found.
        pub index_sum: i64;
        pub expected_index_sum: Option<i64>;
    }
}

rows! {
    /// Another stable equilibrium, if a short search found one.
    pub struct OtherStable {
        /// Energy above this equilibrium; absent if the loads have no potential.
        pub energy_above_j: Option<f64>;
        pub distance_m: f64;
        pub position_m: [f64; 3];
    }
}

impl OtherStable {
    fn of(robot: &Robot, equilibrium: &Equilibrium) -> Option<Self> {
        let (other, energy_above_j) = statics::another_stable_equilibrium(robot, equilibrium)?;
        Some(Self { energy_above_j, distance_m: other.distance, position_m: other.equilibrium.pose.position_w.into() })
    }
}

rows! {
    /// Pose whose unstrained lengths are held, and the motion from there to the equilibrium.
    pub struct HeldRow {
        pub pose: PoseRow;
        pub motion: PoseDifferenceRow = spread;
    }
}

impl HeldRow {
    fn of(held: &Pose, reached: &Pose) -> Self {
        Self { pose: PoseRow::of(held), motion: PoseDifference::between(held, reached).into() }
    }
}

rows! {
    /// Interval in which friction of pulleys leaves the robot. Every pair is minimum and maximum.
    pub struct FrictionRow {
        /// Quantity that is held: `lengths` or `pose`.
        pub held: &'static str;
        /// Motion of the platform; absent with the pose held.
        pub motion: Option<FrictionMotionRow> = spread;
        pub cables: Vec<FrictionCableRow>;
    }
}

rows! {
    /// Motion of the platform due to friction, along and about the world axes.
    pub struct FrictionMotionRow {
        pub translation_m: [[f64; 2]; 3];
        /// Components of the rotation vector.
        pub rotation_deg: [[f64; 2]; 3];
    }
}

rows! {
    /// Tensions of a cable that friction permits.
    pub struct FrictionCableRow {
        pub name: String;
        /// Friction exponent of the cable's pulley; zero without friction.
        pub friction_exponent: f64;
        /// Change of the unstrained length beyond the exit point.
        pub excess_length_m: [f64; 2];
        pub tension_platform_n: [f64; 2];
        pub tension_anchor_n: [f64; 2];
        pub tension_drum_n: [f64; 2];
    }
}

impl FrictionRow {
    /// Interval about the equilibrium, with the quantity held that the request gives.
    ///
    /// # Errors
    /// [`funicular::statics::FrictionError`].
    pub fn of(at_rest: &AtRest) -> Result<Self> {
        let AtRest { robot, equilibrium, held_pose, .. } = at_rest;
        let lengths_held = held_pose.is_some() || matches!(robot.state, State::Lengths(_));
        let (held, name) = if lengths_held { (Held::Lengths, "lengths") } else { (Held::Pose, "pose") };
        let FrictionInterval { motion, cables } = statics::friction_interval(robot, equilibrium, held)?;
        let cables = robot.cables.iter().zip(&cables).map(|(cable, found)| FrictionCableRow::of(&cable.name, found));
        Ok(Self { held: name, motion: motion.as_ref().map(FrictionMotionRow::of), cables: cables.collect() })
    }
}

impl FrictionMotionRow {
    fn of(motion: &MotionInterval) -> Self {
        let degrees = |angle: Interval| [angle.min.to_degrees(), angle.max.to_degrees()];
        Self { translation_m: motion.translation_w.map(pair), rotation_deg: motion.rotation_w.map(degrees) }
    }
}

impl FrictionCableRow {
    /// Fields of a row with an interval of friction, or none. The tensions of the free span vary only if the lengths
    /// are held.
    fn fields<R>(of: impl Fn(&R) -> Option<&Self> + Copy + 'static, lengths_held: bool) -> [Field<R>; 5] {
        let range = |name: &str, about: &str, value: fn(&Self) -> [f64; 2]| {
            let unit = if name.ends_with("_m") { "m" } else { "N" };
            parts(name, ["min", "max"], unit, about, move |row| of(row).map_or([None; 2], |row| value(row).map(Some)))
        };
        let tension = |name: &str, about: &str, heading: &'static str, value: fn(&Self) -> [f64; 2]| {
            range(name, about, value).shown(heading, "N", move |row, style| {
                of(row).map_or_else(String::new, |row| style.range(value(row), 3))
            })
        };
        [
            column("friction_exponent", "1", "friction exponent of the pulley", move |row| {
                of(row).map(|f| f.friction_exponent)
            })
            .decimals("exponent", 4),
            range("excess_length_{}_m", "{}imum change of the unstrained length beyond the exit point", |f| {
                f.excess_length_m
            })
            .shown("beyond exit", "mm", move |row, style| {
                of(row).map_or_else(String::new, |row| style.range(row.excess_length_m.map(|metres| 1e3 * metres), 3))
            }),
            tension("tension_platform_{}_n", "{}imum tension at the platform with friction", "T platform", |f| {
                f.tension_platform_n
            })
            .read_if(lengths_held),
            tension("tension_anchor_{}_n", "{}imum tension at the anchor with friction", "T anchor", |f| {
                f.tension_anchor_n
            })
            .read_if(lengths_held),
            tension("tension_drum_{}_n", "{}imum tension at the drum with friction", "T drum", |f| f.tension_drum_n),
        ]
    }

    /// Columns of the table of friction.
    pub fn columns(lengths_held: bool) -> Columns<Self> {
        let name = fields::cable_name(|row: &Self| row.name.clone());
        Columns::new(std::iter::once(name).chain(Self::fields(|row| Some(row), lengths_held)))
    }

    fn of(name: &str, found: &CableFriction) -> Self {
        Self {
            name: name.to_owned(),
            friction_exponent: found.exponent,
            excess_length_m: pair(found.excess_length),
            tension_platform_n: pair(found.tension_platform),
            tension_anchor_n: pair(found.tension_anchor),
            tension_drum_n: pair(found.tension_drum),
        }
    }
}

/// Minimum and maximum.
fn pair(interval: Interval) -> [f64; 2] {
    [interval.min, interval.max]
}

/// Cable at the equilibrium, with what friction permits.
struct CableWithFriction<'a> {
    cable: &'a CableRow,
    friction: Option<&'a FrictionCableRow>,
}

impl<'a> CableWithFriction<'a> {
    /// Rows of all cables.
    fn all(found: &'a Statics) -> impl Iterator<Item = Self> {
        let friction = found.friction_interval.as_ref();
        let row = move |(i, cable)| Self { cable, friction: friction.map(|of| &of.cables[i]) };
        found.cables.iter().enumerate().map(row)
    }

    /// Columns of the cables, with those of pulleys and winches, and those of friction.
    fn columns(drives: bool, friction: bool) -> Columns<Self> {
        let of_cables = CableRow::fields(|row: &Self| row.cable, false);
        let of_drives = DriveRow::fields(|row: &Self| row.cable.drive.as_ref());
        let of_friction = FrictionCableRow::fields(|row: &Self| row.friction, true);
        Columns::new(
            of_cables
                .into_iter()
                .chain(of_drives.map(|field| field.only_if(drives)))
                .chain(of_friction.map(|field| field.only_if(friction))),
        )
    }
}

rows! {
    /// Cable at the equilibrium.
    pub struct CableRow {
        pub name: String;
        /// Name of its rope.
        pub rope: String = hidden;
        pub unstrained_length_m: f64;
        pub tension_platform_n: f64;
        pub tension_anchor_n: f64;
        pub chord_m: f64;
        pub sag: SagNumbers = spread;
        pub force_on_platform_n: [f64; 3];
        /// State of pulley and winch; absent for a cable that ends at a fixed point.
        pub drive: Option<DriveRow>;
        /// Tension limits; absent if neither the file nor a rule has limits.
        pub limits: Option<LimitNumbers> = spread;
    }
}

rows! {
    /// Pulley and winch of a cable at the equilibrium.
    pub struct DriveRow {
        /// Point at which the cable leaves its pulley.
        pub exit_m: [f64; 3];
        /// Wrap angle on the pulley; absent without a pulley.
        pub wrap_deg: Option<f64>;
        /// Direction from the entry point to the axle, unit vector; absent without a pulley.
        pub swivel_direction: Option<[f64; 3]>;
        /// Tension from the entry point to the drum.
        pub tension_drum_n: f64;
        /// Unstrained lengths of the free span, on the wheel, and from the entry point to the drum, which add up to
        /// that of the cable.
        pub free_length_m: f64;
        pub arc_length_m: f64;
        pub drum_side_length_m: f64;
        /// Length that the winch pays out because it yields.
        pub winch_yield_m: f64;
    }
}

impl DriveRow {
    /// Fields of a row that has a pulley or winch, or none.
    fn fields<R>(of: impl Fn(&R) -> Option<&Self> + Copy + 'static) -> [Field<R>; 7] {
        let number =
            |name, unit, about: &str, value: fn(&Self) -> f64| column(name, unit, about, move |row| of(row).map(value));
        [
            parts("exit_{}_m", AXES, "m", "point at which the cable leaves its pulley, {}", move |row| {
                of(row).map_or([None; 3], |drive| drive.exit_m.map(Some))
            })
            .decimals("exit point", 4),
            column("wrap_deg", "deg", "angle over which the cable touches its wheel", move |row| {
                of(row).and_then(|d| d.wrap_deg)
            })
            .decimals("wrap", 2),
            number("tension_drum_n", "N", "tension at the drum", |drive| drive.tension_drum_n)
                .decimals("T drum", 3)
                .with_unit("N"),
            number("free_length_m", "m", "unstrained length of the free span", |drive| drive.free_length_m)
                .decimals("free", 4)
                .with_unit("m"),
            number("arc_length_m", "m", "unstrained length on the wheel", |drive| drive.arc_length_m)
                .decimals("on wheel", 4)
                .with_unit("m"),
            number("drum_side_length_m", "m", "unstrained length from the pulley to the drum", |drive| {
                drive.drum_side_length_m
            })
            .decimals("to drum", 4)
            .with_unit("m"),
            number("winch_yield_m", "m", "length that the winch pays out because it yields", |drive| {
                drive.winch_yield_m
            })
            .shown("yield", "mm", move |row, style| style.decimals(of(row).map(|drive| 1e3 * drive.winch_yield_m), 3)),
        ]
    }

    fn of(state: &CableState) -> Option<Self> {
        let drive = state.drive.as_deref()?;
        Some(Self {
            exit_m: state.anchor_w.into(),
            wrap_deg: drive.contact.map(|contact| contact.wrap.to_degrees()),
            swivel_direction: drive.contact.map(|contact| contact.center_w.into()),
            tension_drum_n: drive.tension_drum,
            free_length_m: state.free_length(),
            arc_length_m: drive.arc_length,
            drum_side_length_m: drive.drum_side_length,
            winch_yield_m: drive.winch_yield,
        })
    }
}

impl CableRow {
    /// Columns of the table of lengths, tensions and sag; with the limits if a cable has any.
    pub fn columns(cables: &[Self]) -> Columns<Self> {
        Columns::new(Self::fields(|row| row, cables.iter().any(|cable| cable.limits.is_some())))
    }

    /// Fields of a row with a cable; tables for reading have the limits if there are any.
    fn fields<R>(of: impl Fn(&R) -> &Self + Copy + 'static, limited: bool) -> [Field<R>; 14] {
        let [at_platform, at_anchor] =
            fields::tensions(move |row| [of(row).tension_platform_n, of(row).tension_anchor_n]);
        let [range, margin, reached] = fields::limits(move |row| of(row).limits.as_ref());
        [
            fields::cable_name(move |row| of(row).name.clone()),
            only_read().shown("rope", "", move |row, _| of(row).rope.clone()).only_in(Style::Typeset),
            column("unstrained_length_m", "m", "length without tension", move |row| of(row).unstrained_length_m)
                .decimals("unstrained", 4),
            only_read().shown("chord", "m", move |row, style| style.decimals(of(row).chord_m, 4)).aligned(false),
            at_platform,
            at_anchor,
            column("chord_m", "m", "distance between the ends of the free span", move |row| of(row).chord_m),
            column("sag_ratio", "1", "sag divided by the chord", move |row| of(row).sag.sag_ratio)
                .decimals("sag/chord", 5),
            column("lambda2", "1", "Irvine's parameter", move |row| of(row).sag.lambda2).significant("λ²", 4),
            column("string_frequency_hz", "Hz", "first natural frequency of the taut cable alone", move |row| {
                of(row).sag.string_frequency_hz
            })
            .decimals("string", 3),
            parts("force_on_platform_{}_n", AXES, "N", "force of the cable on the platform, {}", move |row| {
                of(row).force_on_platform_n
            }),
            range.read_if(limited),
            margin.read_if(limited),
            reached,
        ]
    }

    /// Columns of the table of pulleys and winches.
    pub fn drive_columns() -> Columns<Self> {
        let name = fields::cable_name(|row: &Self| row.name.clone());
        Columns::new(std::iter::once(name).chain(DriveRow::fields(|row: &Self| row.drive.as_ref())))
    }
}

rows! {
    /// Flexible support at the equilibrium.
    pub struct SupportRow {
        pub name: String;
        /// Displacement of its anchors, world axes.
        pub displacement_m: [f64; 3];
        /// Force of its cables on it, world axes.
        pub force_n: [f64; 3];
    }
}

impl SupportRow {
    fn all(robot: &Robot, equilibrium: &Equilibrium) -> Vec<Self> {
        let row = |(support, displacement_w): (&Support, funicular::math::Vec3)| Self {
            name: support.name.clone(),
            displacement_m: displacement_w.into(),
            force_n: (support.stiffness_w * displacement_w).into(),
        };
        robot.supports.iter().zip(equilibrium.support_displacements(robot)).map(row).collect()
    }
}

impl Tabled for Statics {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![
            ("", CableWithFriction::columns(true, true).described()),
            ("`all`", EquilibriumRow::columns(any()).described()),
        ]
    }

    fn table(&self) -> ResultTable<'_> {
        if let Some(equilibria) = &self.equilibria {
            let cables = equilibria.first().map_or(0, |row| row.tensions_platform_n.len());
            return ResultTable::new(EquilibriumRow::columns(1..=cables), equilibria);
        }
        let drives = self.cables.iter().any(|cable| cable.drive.is_some());
        let columns = CableWithFriction::columns(drives, self.friction_interval.is_some());
        ResultTable::new(columns, CableWithFriction::all(self))
    }
}

/// Finds the equilibrium.
///
/// # Errors
/// A request that contradicts itself or the robot, or a robot without such an equilibrium.
pub fn run(robot: Robot, request: &request::StaticsRequest) -> Result<Statics> {
    let at_rest = at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?;
    about(&at_rest, Extras { all: request.all, friction_interval: request.friction_interval, ..Extras::default() })
}

/// Results of `statics` beyond the equilibrium.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Extras {
    /// All equilibria of the unstrained lengths.
    pub all: bool,
    /// Interval in which friction of pulleys leaves pose and tensions.
    pub friction_interval: bool,
    /// No search for another stable equilibrium, which takes far longer than the equilibrium.
    pub alone: bool,
}

/// Rows of the cables of a robot at equilibrium, one per cable.
pub fn cable_rows(at_rest: &AtRest) -> Vec<CableRow> {
    let AtRest { robot, equilibrium, rule, .. } = at_rest;
    let limited = rule.is_some() || robot.cables.iter().any(|cable| cable.limits() != TensionLimits::default());
    equilibrium
        .cables
        .iter()
        .enumerate()
        .map(|(i, cable)| CableRow {
            name: robot.cables[i].name.clone(),
            rope: robot.cables[i].material.name.clone(),
            unstrained_length_m: cable.unstrained_length,
            tension_platform_n: cable.tension_platform,
            tension_anchor_n: cable.tension_anchor,
            chord_m: cable.chord(),
            sag: SagNumbers::of(&Sag::of(robot, i, cable)),
            force_on_platform_n: cable.force_on_platform_w.into(),
            drive: DriveRow::of(cable),
            limits: limited.then(|| LimitNumbers::of(&TensionRange::of(robot, i, &cable.chord_w()).margin(cable))),
        })
        .collect()
}

/// Results for a robot at equilibrium, with the requested extras.
///
/// # Errors
/// A search that is not possible for the robot, for example with ideal cables; a friction interval of a robot without
/// friction or at an indifferent equilibrium.
pub fn about(at_rest: &AtRest, extras: Extras) -> Result<Statics> {
    let AtRest { robot, equilibrium, rule, .. } = at_rest;
    let cables = cable_rows(at_rest);
    let (mut equilibria, mut search, mut another_stable_equilibrium) = (None, None, None);
    let mut warnings = at_rest.warnings(None);
    let friction_interval = extras.friction_interval.then(|| FrictionRow::of(at_rest)).transpose()?;
    if friction_interval.is_none() {
        warnings.extend(friction_left_out(robot, equilibrium));
    }

    if extras.all {
        let lengths: Vec<f64> = equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect();
        let found = statics::all_equilibria(robot, &lengths, equilibrium.model, Some(&equilibrium.pose))?;
        if let (true, Some(expected)) = (found.lacks_some(), found.expected_index_sum) {
            warnings.push(format!(
                "the list of equilibria is not complete: the sum of (−1)^(falling directions) is {}, for all \
                 equilibria it is {expected} (after {} starts)",
                found.index_sum, found.starts
            ));
        }
        equilibria = Some(found.found.iter().map(EquilibriumRow::of).collect());
        let (index_sum, expected_index_sum) = (found.index_sum, found.expected_index_sum);
        search = Some(Search { starts: found.starts, index_sum, expected_index_sum });
    } else if !extras.alone {
        another_stable_equilibrium = OtherStable::of(robot, equilibrium);
    }

    Ok(Statics {
        warnings,
        robot: robot.name.clone(),
        static_model: equilibrium.model.name(),
        mass_kg: robot.platform.mass,
        load: LoadRow::of(&robot.load),
        wind: WindRow::of(&robot.wind),
        pose: PoseRow::of(&equilibrium.pose),
        nearest_pose_distance_m: at_rest.requested_pose.map(|(_, distance)| distance),
        held: at_rest.held_pose.map(|held| HeldRow::of(&held, &equilibrium.pose)),
        tension_rule: rule.as_ref().map(statics::TensionRule::name),
        centre: CentreRow::of(at_rest),
        cables,
        supports: SupportRow::all(robot, equilibrium),
        residual: equilibrium.residual,
        is_unloaded: statics::is_unloaded(robot, equilibrium),
        iterations: equilibrium.iterations,
        stable: equilibrium.stability.is_stable(),
        stiffness_min_n_per_m: equilibrium.stability.min_stiffness(),
        free_motions: FreeMotionRow::all(robot, equilibrium),
        another_stable_equilibrium,
        equilibria,
        search,
        friction_interval,
    })
}

/// Warning that the equilibrium leaves out the friction of the robot's pulleys, with its size.
fn friction_left_out(robot: &Robot, equilibrium: &Equilibrium) -> Option<String> {
    // The first of equal ones.
    let exponents = statics::friction_exponents(robot, equilibrium).into_iter().enumerate().rev();
    let (i, exponent) = exponents.max_by(|(_, one), (_, other)| one.total_cmp(other))?;
    (exponent > 0.0).then(|| {
        format!(
            "the equilibrium leaves out the friction of pulleys, which changes the tension at the drum of cable \"{}\" \
             by up to {} %: ⟪friction_interval⟫ gives the interval of pose and tensions",
            robot.cables[i].name,
            short(100.0 * exponent.exp_m1(), 2)
        )
    })
}

found!(Statics, "statics");
