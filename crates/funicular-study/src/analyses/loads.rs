//! `loads`: loads that the cables hold at a pose, compared with the required ones.

use super::found;
use super::payload::LoadedRow;
use super::shared::PoseRow;
use crate::at_rest;
use crate::columns::{Columns, ResultTable, Tabled, column};
use crate::error::with_warnings;
use crate::request::LoadsRequest;
use crate::rows::rows;
use crate::table::Column;
use anyhow::{Result, bail};
use funicular::gradient::LoadFactorGradient;
use funicular::robot::{Pose, Robot, State};
use funicular::statics::{self, LoadCapacity, WrenchClosure};
use funicular::warnings;

rows! {
    /// Results of `loads`.
    pub struct Loads {
        pub robot: String = hidden;
        pub static_model: &'static str;
        pub pose: PoseRow;
        /// Number of independent wrenches of the cables, and the degrees of freedom.
        pub rank: usize;
        pub dof: usize;
        /// True if straight cables could balance every load with tensions that are high enough.
        pub closure: bool;
        pub tension_factor: f64;
        /// True if the dead load with the lightest payload is held within the limits.
        pub dead_load_held: bool;
        /// Reason why the dead load is not held.
        pub dead_load_reason: Option<String>;
        /// Radius of the largest ball of loads that can be added to every required load, moments over the length of the
        /// platform.
        pub capacity_margin_n: Option<f64>;
        /// Length by which moments are divided in the margin, and angular accelerations multiplied.
        pub platform_length_m: f64;
        /// Largest acceleration in every direction from rest.
        pub acceleration_max_m_s2: Option<f64>;
        /// Required loads and how much of them is held; absent if nothing is required or the dead load is not held.
        pub required: Option<RequiredHeld>;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Load factor with what binds.
    pub struct RequiredHeld {
        /// True if all required loads are held.
        pub held: bool;
        /// Largest multiple of the required loads; absent if no maximum tension limits it.
        pub load_factor: Option<f64>;
        /// Multiple that is proved to be too much.
        pub load_factor_upper_bound: Option<f64>;
        /// Multiple up to which all loads inside the set are held, not only its vertices.
        pub load_factor_lower_bound: Option<f64>;
        /// Derivatives of the load factor by a motion of the platform along the axes of the world, and by a turn about
        /// them; absent where it has none.
        pub load_factor_by_position_per_m: Option<[f64; 3]>;
        pub load_factor_by_rotation_per_rad: Option<[f64; 3]>;
        /// Required wind that binds, at the multiple 1; absent if it does not act on the ropes.
        pub wind_m_s: Option<[f64; 3]>;
        /// Required load that binds, in addition to the dead load.
        pub force_n: [f64; 3];
        pub moment_n_m: [f64; 3];
        /// Cables with the dead load and the largest multiple of this load; empty without a largest multiple.
        pub cables: Vec<LoadedRow>;
    }
}

/// Compares the loads that the cables hold with the required ones.
///
/// # Errors
/// A request that contradicts itself or the robot, or a robot without a pose.
pub fn run(robot: Robot, request: &LoadsRequest) -> Result<Loads> {
    let LoadsRequest { required, state, tensions, .. } = request;
    let robot = at_rest::with_limits(&at_rest::with_state(robot, state)?, tensions)?;
    let robot = at_rest::with_required(robot, required)?;
    let pose = pose_of(&robot, request)?;
    let model = state.static_model;

    let capacity = LoadCapacity::at(&robot, &pose, model, None).map_err(|error| with_warnings(error, &robot))?;
    let closure = statics::wrench_closure(&robot, &pose);
    let WrenchClosure { rank, dof, tension_factor } = closure;
    let reason = capacity.dead_load().err().map(ToString::to_string);
    let is_asked = reason.is_none() && !capacity.requires_nothing();
    let required = if is_asked { Some(RequiredHeld::of(&robot, &capacity)?) } else { None };
    let slacker = required.as_ref().is_some_and(|(_, slacker)| *slacker).then_some(SLACKER);

    let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
    Ok(Loads {
        robot: robot.name.clone(),
        static_model: model.name(),
        pose: PoseRow::of(&pose),
        rank,
        dof,
        closure: closure.is_closed(),
        tension_factor,
        dead_load_held: reason.is_none(),
        dead_load_reason: reason,
        capacity_margin_n: finite(capacity.margin()),
        platform_length_m: robot.platform_length(),
        acceleration_max_m_s2: finite(capacity.largest_acceleration()),
        required: required.map(|(held, _)| held),
        warnings: warnings::of_robot(&robot)
            .iter()
            .map(ToString::to_string)
            .chain(slacker.map(str::to_owned))
            .collect(),
    })
}

/// Pose of a robot: that of its state, or the one in which its lengths hold it.
fn pose_of(robot: &Robot, request: &LoadsRequest) -> Result<Pose> {
    if request.state.hold_lengths_of_pose {
        bail!("`loads` compares all tensions at one pose: leave out ⟪hold_lengths_of_pose⟫");
    }
    if let State::Pose(pose) = &robot.state {
        return Ok(*pose);
    }
    at_rest::refuse_no_state(robot)?;
    let rest = statics::solve(robot, request.state.static_model, None).map_err(|error| with_warnings(error, robot))?;
    Ok(rest.equilibrium.pose)
}

/// Warning about a load factor that counts cables which hang deeper than those of the margin.
const SLACKER: &str = "with this multiple of the binding load a cable hangs so deep that its tension would rise with \
                       more rope: the load factor counts such cables, the capacity margin and the acceleration do not; \
                       give a larger `minimum_tension_n` if the cable has to stay taut";

impl RequiredHeld {
    /// Load factor of a capacity, and true if it counts cables that hang deeper than those of the margin.
    fn of(robot: &Robot, capacity: &LoadCapacity) -> Result<(Self, bool)> {
        let (factor, gradient) = match LoadFactorGradient::of(capacity) {
            Ok(found) => (found.factor, Some(found.gradient)),
            Err(_) => (capacity.load_factor()?, None),
        };
        let finite = |value: f64| value.is_finite().then_some(value);
        let by_pose = gradient.map(|by| [by.position_w, by.rotation_w].map(Into::into));
        let [x, y, z, roll, pitch, yaw] = factor.load.into();
        let counts_slacker = capacity.counts_slacker_cables(&factor);
        let held = Self {
            held: factor.value >= 1.0,
            load_factor: finite(factor.value),
            load_factor_upper_bound: finite(factor.upper_bound),
            load_factor_lower_bound: factor.lower_bound.and_then(finite),
            load_factor_by_position_per_m: by_pose.map(|[by_position, _]| by_position),
            load_factor_by_rotation_per_rad: by_pose.map(|[_, by_rotation]| by_rotation),
            wind_m_s: (factor.wind_w.norm() > 0.0).then(|| factor.wind_w.into()),
            force_n: [x, y, z],
            moment_n_m: [roll, pitch, yaw],
            cables: LoadedRow::all(robot, &factor.cables, &factor.limits),
        };
        Ok((held, counts_slacker))
    }
}

impl Loads {
    /// Columns of the table in files, whose only row has the measures of the pose.
    fn columns() -> Columns<Self> {
        let required = |of: fn(&RequiredHeld) -> Option<f64>| move |row: &Self| row.required.as_ref().and_then(of);
        let component = |k: usize, of: fn(&RequiredHeld) -> [f64; 3]| {
            move |row: &Self| row.required.as_ref().map(|held| of(held)[k])
        };
        let mut columns = vec![
            column("closure", "", "true if straight cables could balance every load", |row: &Self| row.closure),
            column(
                "tension_factor",
                "1",
                "largest ratio of minimum to maximum tension without a load",
                |row: &Self| row.tension_factor,
            ),
            column("dead_load_held", "", "true if the dead load is held within the limits", |row: &Self| {
                row.dead_load_held
            }),
            column("capacity_margin_n", "N", "radius of the largest ball of loads that can be added", |row: &Self| {
                row.capacity_margin_n
            }),
            column(
                "acceleration_max_m_s2",
                "m/s²",
                "largest acceleration in every direction from rest",
                |row: &Self| row.acceleration_max_m_s2,
            ),
            column("load_factor", "1", "largest multiple of the required loads", required(|held| held.load_factor)),
            column(
                "load_factor_upper_bound",
                "1",
                "multiple that is proved to be too much",
                required(|held| held.load_factor_upper_bound),
            ),
            column(
                "load_factor_lower_bound",
                "1",
                "multiple up to which all loads inside the set are held",
                required(|held| held.load_factor_lower_bound),
            ),
        ];
        let by = |k: usize, of: fn(&RequiredHeld) -> Option<[f64; 3]>| {
            move |row: &Self| row.required.as_ref().and_then(of).map(|by| by[k])
        };
        let names = ["load_factor_by_x_per_m", "load_factor_by_y_per_m", "load_factor_by_z_per_m"];
        for (k, name) in names.into_iter().enumerate() {
            let about = "derivative of the load factor by a motion of the platform";
            columns.push(column(name, "1/m", about, by(k, |held| held.load_factor_by_position_per_m)));
        }
        let names = [
            "load_factor_by_rotation_x_per_rad",
            "load_factor_by_rotation_y_per_rad",
            "load_factor_by_rotation_z_per_rad",
        ];
        for (k, name) in names.into_iter().enumerate() {
            let about = "derivative of the load factor by a turn of the platform about an axis of the world";
            columns.push(column(name, "1/rad", about, by(k, |held| held.load_factor_by_rotation_per_rad)));
        }
        for (k, name) in ["force_x_n", "force_y_n", "force_z_n"].into_iter().enumerate() {
            let about = "component of the required force that binds";
            columns.push(column(name, "N", about, component(k, |held| held.force_n)));
        }
        for (k, name) in ["moment_x_n_m", "moment_y_n_m", "moment_z_n_m"].into_iter().enumerate() {
            let about = "component of the required moment that binds";
            columns.push(column(name, "N m", about, component(k, |held| held.moment_n_m)));
        }
        Columns::new(columns)
    }
}

impl Tabled for Loads {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", Self::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(Self::columns(), std::iter::once(self))
    }
}

found!(Loads, "loads");
