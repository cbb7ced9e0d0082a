//! Conditions of a workspace: limits of quantities, and how far a pose is from them.

use crate::names::suggestion;
use crate::request::{BoundValue, WorkspaceRequest};
use crate::rows::rows;
use crate::sweep::{Options, Quantity, values_at};
use crate::table::{ColumnKind, Value};
use crate::text::short;
use anyhow::{Result, anyhow, bail};
use funicular::robot::{Pose, Robot};
use funicular::statics::{self, LoadCapacity};
use std::fmt;

/// Column of the load factor.
const LOAD_FACTOR: &str = "load_factor";

/// Column with the distance beyond the required clearance [m].
const CLEARANCE: &str = "clearance_margin_m";

/// Rounding of a value over its limit: tensions are found to 1e-10 of their size.
const ROUNDING: f64 = 1e-10;

/// LimitSide of a limit on which a value is allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LimitSide {
    AtLeast,
    AtMost,
}

/// Limit of a column of the quantities.
struct Limit {
    /// Place of the column among those of all quantities.
    column: usize,
    side: LimitSide,
    value: f64,
}

impl Limit {
    /// Distance of a value from the limit, over the limit if that is not zero. An unlimited value is one limit away.
    fn margin(&self, value: f64) -> Option<f64> {
        let scale = if self.value == 0.0 { 1.0 } else { self.value.abs() };
        let above = if value.is_infinite() { value.signum() } else { (value - self.value) / scale };
        let margin = if self.side == LimitSide::AtLeast { above } else { -above };
        // A value at its limit to rounding keeps it: over a region where it stays there, rounding would decide.
        let rounded = if self.value != 0.0 && (-ROUNDING..0.0).contains(&margin) { 0.0 } else { margin };
        Some(rounded).filter(|margin| margin.is_finite())
    }
}

rows! {
    /// Condition of a workspace, for reading.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ConditionRow {
        /// Column of the quantity; `tensions` if only their limits count.
        pub of: String;
        /// Least value that is allowed.
        pub at_least: Option<f64>;
        /// Greatest value that is allowed.
        pub at_most: Option<f64>;
    }
}

impl fmt::Display for ConditionRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.at_least, self.at_most) {
            (Some(value), _) => write!(f, "{} at least {}", self.of, short(value, 6)),
            (_, Some(value)) => write!(f, "{} at most {}", self.of, short(value, 6)),
            _ => f.write_str("tensions within their limits"),
        }
    }
}

/// Conditions of a workspace. Without a limit the tensions alone count.
pub(super) struct Conditions {
    quantities: Vec<Quantity>,
    limits: Vec<Limit>,
    /// Limits of the load factor, which needs the dead load alone, not what a map knows about its equilibrium.
    of_loads: Vec<Limit>,
    pub(super) rows: Vec<ConditionRow>,
}

impl Conditions {
    /// Conditions of a request; without any, all required loads have to be held, or the dead load if there are none. A
    /// robot whose clearances are judged has to keep them, too.
    ///
    /// # Errors
    /// A name that no quantity and no column has, or one without a single number per pose.
    pub(super) fn of(request: &WorkspaceRequest, robot: &Robot, options: &Options) -> Result<Self> {
        let mut conditions =
            Self { quantities: Vec::new(), limits: Vec::new(), of_loads: Vec::new(), rows: Vec::new() };
        for (bounds, key, side) in
            [(&request.at_least, "at_least", LimitSide::AtLeast), (&request.at_most, "at_most", LimitSide::AtMost)]
        {
            for bound in bounds {
                let value = crate::values::finite(bound.value);
                let value = value.map_err(|reason| anyhow!("⟪{key}⟫ {}: {reason}", bound.quantity))?;
                let added = conditions.add(robot, options, &BoundValue { value, ..bound.clone() }, side);
                added.map_err(|error| anyhow!("⟪{key}⟫ {}: {error}", bound.quantity))?;
            }
        }

        if conditions.rows.is_empty() && !robot.required.is_empty() {
            let all_loads = BoundValue { quantity: LOAD_FACTOR.to_owned(), value: 1.0 };
            conditions.add(robot, options, &all_loads, LimitSide::AtLeast)?;
        }
        if robot.judges_clearance() {
            let clearance = BoundValue { quantity: CLEARANCE.to_owned(), value: 0.0 };
            conditions.add(robot, options, &clearance, LimitSide::AtLeast)?;
        }
        if conditions.rows.is_empty() {
            conditions.rows.push(ConditionRow { of: "tensions".to_owned(), at_least: None, at_most: None });
        }
        Ok(conditions)
    }

    fn add(&mut self, robot: &Robot, options: &Options, bound: &BoundValue, side: LimitSide) -> Result<()> {
        let (quantity, own, name) = column_of(robot, &bound.quantity)?;
        if name == LOAD_FACTOR && robot.required.is_empty() {
            bail!("nothing is required: give ⟪required_force_n⟫ or another required load, or [required] in the file");
        }
        if quantity.excludes(options.static_model) {
            bail!("it does not exist with {} cables: choose another ⟪static_model⟫", options.static_model.name());
        }

        let (at_least, at_most) = match side {
            LimitSide::AtLeast => (Some(bound.value), None),
            LimitSide::AtMost => (None, Some(bound.value)),
        };
        let is_load_factor = name == LOAD_FACTOR;
        self.rows.push(ConditionRow { of: name, at_least, at_most });
        if is_load_factor {
            self.of_loads.push(Limit { column: own, side, value: bound.value });
            return Ok(());
        }

        let mut column = own;
        for known in &self.quantities {
            if *known == quantity {
                break;
            }
            column += known.columns(robot).len();
        }
        if !self.quantities.contains(&quantity) {
            self.quantities.push(quantity);
        }
        self.limits.push(Limit { column, side, value: bound.value });
        Ok(())
    }

    /// Distance of a pose from the limits: the least of all, each over its value if that is not zero. Negative if one
    /// is not kept, `None` if a quantity has no value there.
    pub(super) fn margin(&self, robot: &Robot, pose: &Pose, options: &Options) -> Option<f64> {
        if self.limits.is_empty() && self.of_loads.is_empty() {
            return tension_margin(robot, pose, options);
        }
        let mut margins = Vec::with_capacity(self.limits.len() + self.of_loads.len());
        if !self.limits.is_empty() {
            let values = values_at(robot, pose, &self.quantities, options)?;
            for limit in &self.limits {
                let Value::Real(value) = &values[limit.column] else { return None };
                margins.push(limit.margin(*value)?);
            }
        }
        for limit in &self.of_loads {
            margins.push(load_margin(limit, robot, pose, options)?);
        }
        margins.into_iter().reduce(f64::min)
    }
}

/// Distance of the loads from what tensions within their limits hold [N]. Without maximum tensions, and with cables
/// that do not span all degrees of freedom, there is only a verdict, whose magnitude says nothing.
fn tension_margin(robot: &Robot, pose: &Pose, options: &Options) -> Option<f64> {
    let capacity = LoadCapacity::at(robot, pose, options.static_model, None).ok()?;
    let verdict = if capacity.dead_load().is_ok() { Some(1.0) } else { None };
    capacity.margin().filter(|margin| margin.is_finite()).or(verdict)
}

/// Distance of the load factor from its limit. Bounds that lie on one side of the limit decide, and the upper one
/// stands for the value, to which it is nearer; only between them the factor itself is computed. In wind on the cables
/// the drag of the ropes at the limit stands for that at the factor, which is on the same side.
fn load_margin(limit: &Limit, robot: &Robot, pose: &Pose, options: &Options) -> Option<f64> {
    let model = options.static_model;
    if limit.value > 0.0
        && let Some(verdict) = statics::load_factor_verdict_in_wind(robot, pose, model, limit.value).ok()?
    {
        return limit.margin(verdict);
    }
    if let Some([lower, upper]) = statics::load_factor_bounds(robot, pose, model).ok()? {
        let [lower, upper] = [lower, upper].map(|bound| limit.margin(bound));
        if lower.is_some_and(|margin| margin >= 0.0) == upper.is_some_and(|margin| margin >= 0.0) {
            return upper;
        }
    }
    let capacity = LoadCapacity::at(robot, pose, model, None).ok()?;
    limit.margin(capacity.load_factor_value().ok()?)
}

/// Quantity that a name means, the place of the column among its columns, and the name of the column: that of the
/// quantity if it has one number, or the name of a column of any quantity without a parameter.
fn column_of(robot: &Robot, name: &str) -> Result<(Quantity, usize, String)> {
    let is_number = |kind: ColumnKind| kind == ColumnKind::Real;
    if let Ok(quantity) = name.parse::<Quantity>() {
        if quantity.path().is_some() {
            bail!("derivatives cannot limit a workspace: choose another quantity");
        }
        let columns = quantity.columns(robot);
        let numbers: Vec<usize> = (0..columns.len()).filter(|i| is_number(columns[*i].kind)).collect();
        return match numbers[..] {
            [] => bail!("the quantity is a word, not a number: choose another one"),
            [one] => Ok((quantity, one, columns[one].name.clone())),
            _ => {
                let names: Vec<String> = numbers.iter().map(|i| format!("`{}`", columns[*i].name)).collect();
                bail!("the quantity has several numbers: name one of {}", names.join(", "))
            }
        };
    }

    let mut names = Vec::new();
    for quantity in Quantity::names().filter_map(|name| name.parse::<Quantity>().ok()) {
        for (i, column) in quantity.columns(robot).into_iter().enumerate() {
            if column.name == name && is_number(column.kind) {
                return Ok((quantity, i, column.name));
            }
            names.push(column.name);
        }
    }
    names.extend(Quantity::names().map(str::to_owned));
    bail!("there is no such quantity and no such column of one{}", suggestion(name, &names))
}
