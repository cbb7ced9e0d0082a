//! One point: its equilibrium, and what is asked of it.

use super::Options;
use super::columns::Value;
use super::frequency::{self, Lowest};
use super::points::Point;
use super::quantity::{Quantity, has_ideal_pose};
use super::status::Status;
use crate::cable::{CableModel, Sag};
use crate::dynamics::{Dynamics, Linearisation};
use crate::math::{DMat, Mat6, Vec6, inertia, rotation, symmetric_part};
use crate::modes::Kind;
use crate::platform::Coordinates;
use crate::pose_error::PoseDifference;
use crate::robot::{Robot, State};
use crate::statics::{self, Equilibrium, Stability, StaticModel, StaticsError, TensionRange};
use std::cell::OnceCell;

/// A robot at rest at a point, and what several quantities share.
pub(super) struct Row<'a> {
    robot: &'a Robot,
    rest: &'a Equilibrium,
    options: &'a Options,
    /// Lowest frequencies in the cable model asked for, how many are needed at most.
    lowest: OnceCell<Result<Lowest, Status>>,
    most: usize,
    /// The first with exact cables, for comparisons.
    exact: OnceCell<Result<Lowest, Status>>,
    /// The first reason why something asked for is missing.
    missing: Option<Status>,
}

/// The equilibrium of a point, and how far it is from the pose asked [m] where fewer cables than freedoms hold another.
pub(super) fn at_rest(
    robot: &Robot,
    state: &State,
    options: &Options,
) -> Result<(Equilibrium, Option<f64>), StaticsError> {
    let model = options.static_model;
    let (cables, freedoms) = (robot.cables.len(), robot.platform.freedoms.count());
    match state {
        State::Lengths(lengths) => Ok((statics::forward(robot, lengths, model, None)?, None)),
        State::Pose(pose) if cables < freedoms => {
            let nearest = statics::nearest(robot, pose, model)?;
            Ok((nearest.equilibrium, Some(nearest.distance)))
        }
        State::Pose(pose) if cables > freedoms => {
            Ok((statics::distribute(robot, pose, model, &options.tension_rule)?, None))
        }
        State::Pose(pose) => Ok((statics::inverse(robot, pose, model)?, None)),
        State::Unknown => Err(StaticsError::LengthCount { given: 0, cables }),
    }
}

/// All values of a point but its coordinates: feasible, status, reason, distance from the pose asked if that is a column,
/// then the quantities.
pub(super) fn values(
    point: &Point,
    quantities: &[Quantity],
    options: &Options,
    with_distance: bool,
    width: usize,
    out: &mut Vec<Value>,
) {
    let found = match &point.robot {
        Err(reason) => Err(Status::new("bad-robot", reason)),
        Ok((robot, state)) => match at_rest(robot, state, options) {
            Err(error) => Err(Status::of_error(&error)),
            Ok((rest, distance)) => match Status::refusing(robot, &rest) {
                Some(status) => Err(status),
                None => Ok((robot, rest, distance)),
            },
        },
    };
    let begin = out.len();
    let (robot, rest, distance) = match found {
        Ok(found) => found,
        Err(status) => {
            head(false, Some(status), out);
            out.resize(begin + width, Value::Nothing);
            return;
        }
    };
    let most = quantities.iter().map(Quantity::frequencies).max().unwrap_or(0);
    let mut row = Row {
        robot,
        rest: &rest,
        options,
        lowest: OnceCell::new(),
        most,
        exact: OnceCell::new(),
        missing: Status::remarking(robot, &rest),
    };
    head(true, None, out);
    if with_distance {
        out.push(Value::real(distance));
    }
    for quantity in quantities {
        row.add(*quantity, out);
    }
    // What is missing is known only now.
    if let Some(status) = row.missing {
        let (code, reason) = Status::of(Some(status));
        out[begin + 1] = Value::Text(code);
        out[begin + 2] = reason.map_or(Value::Nothing, Value::Text);
    }
}

fn head(feasible: bool, status: Option<Status>, out: &mut Vec<Value>) {
    let (code, reason) = Status::of(status);
    out.extend([Value::Flag(feasible), Value::Text(code), reason.map_or(Value::Nothing, Value::Text)]);
}

impl Row<'_> {
    fn add(&mut self, quantity: Quantity, out: &mut Vec<Value>) {
        let cables = || self.rest.cables.iter();
        match quantity {
            Quantity::FirstFrequency => self.frequencies(1, out),
            Quantity::Frequencies(count) => self.frequencies(count, out),
            Quantity::FirstKind => {
                let kind = self.modes().and_then(|modes| modes.first().map(|mode| mode.1));
                out.push(kind.map_or(Value::Nothing, |kind: Kind| Value::Text(kind.name().into())));
            }
            Quantity::TensionMax => out.push(Value::real(self.tensions().map(|(_, most)| most).reduce(f64::max))),
            Quantity::TensionMin => out.push(Value::real(self.tensions().map(|(least, _)| least).reduce(f64::min))),
            Quantity::Tensions => out.extend(cables().map(|cable| Value::real(Some(cable.tension_platform)))),
            Quantity::Lengths => out.extend(cables().map(|cable| Value::real(Some(cable.unstrained_length)))),
            Quantity::TensionMargin => {
                let margins = cables()
                    .enumerate()
                    .map(|(i, cable)| TensionRange::of(self.robot, i, &cable.chord_w()).margin(cable).distance());
                out.push(Value::real(margins.reduce(f64::min)));
            }
            Quantity::StiffnessMin => out.push(Value::real(match self.rest.stability {
                Stability::Stable { least_stiffness } | Stability::Unstable { least_stiffness, .. } => {
                    Some(least_stiffness)
                }
                Stability::Rigid => None,
            })),
            Quantity::Stiffness => self.stiffness(out),
            Quantity::PoseError => self.pose_error(out),
            Quantity::SagMax => {
                let sags = cables().enumerate().map(|(i, cable)| Sag::of(self.robot, i, cable));
                let ratios = sags.map(|sag| if sag.tension > 0.0 { sag.ratio() } else { f64::INFINITY });
                out.push(Value::real(ratios.reduce(f64::max)));
            }
            Quantity::ModelError(model) => {
                let error = self.model_error(model);
                self.push(error, out);
            }
            Quantity::StiffnessError(model) => {
                let error = self.stiffness_error(model);
                self.push(error, out);
            }
            Quantity::Condition => out.push(Value::real(Some(inverse_condition(self.robot, self.rest)))),
            Quantity::Energy => out.push(Value::real(Some(statics::energy(self.robot, self.rest)))),
            Quantity::Pose => {
                let pose = &self.rest.pose;
                let angles = rotation::to_roll_pitch_yaw_deg(&pose.rot_wp);
                out.extend(pose.position_w.iter().chain(&angles).map(|value| Value::real(Some(*value))));
            }
        }
    }

    /// A value, or nothing with the reason in the row's status unless there is one already.
    fn push(&mut self, value: Result<f64, Status>, out: &mut Vec<Value>) {
        match value {
            Ok(value) => out.push(Value::real(Some(value))),
            Err(status) => {
                out.push(Value::Nothing);
                self.missing.get_or_insert(status);
            }
        }
    }

    /// Least and greatest tension anywhere in each cable.
    fn tensions(&self) -> impl Iterator<Item = (f64, f64)> {
        self.rest.cables.iter().map(|cable| match &cable.hanging {
            Some(hanging) => (hanging.catenary.least_tension(), hanging.catenary.greatest_tension()),
            None => (cable.tension_platform, cable.tension_platform),
        })
    }

    /// The lowest modes in the cable model asked for.
    fn modes(&mut self) -> Option<&[(f64, Kind)]> {
        let found = self.lowest.get_or_init(|| {
            frequency::lowest(self.robot, self.rest, self.options.linearisation, self.most, self.options.highest_hz)
        });
        match found {
            Ok(lowest) => {
                if !lowest.certified {
                    self.missing.get_or_insert_with(not_certified);
                }
                Some(&lowest.modes)
            }
            Err(status) => {
                self.missing.get_or_insert_with(|| status.clone());
                None
            }
        }
    }

    fn frequencies(&mut self, count: usize, out: &mut Vec<Value>) {
        let end = out.len() + count;
        if let Some(modes) = self.modes() {
            out.extend(modes.iter().take(count).map(|mode| Value::real(Some(mode.0))));
        }
        out.resize(end, Value::Nothing);
    }

    /// Load along each coordinate over the motion along it, all others free: one over the diagonal of the compliance.
    fn stiffness(&self, out: &mut Vec<Value>) {
        let freedoms = &self.robot.platform.freedoms;
        let n = freedoms.count();
        let inverse = statics::tangent_stiffness(self.robot, self.rest).and_then(|stiffness| {
            // Symmetric to rounding; what the turn of the drag adds in wind is not symmetric.
            let mut whole = symmetric_part(&stiffness);
            if let Some(turn) = statics::drag_stiffness(self.robot, self.rest) {
                whole += turn;
            }
            let mut reduced = freedoms.reduced_matrix(&whole);
            (n..6).for_each(|k| reduced[(k, k)] = 1.0);
            reduced.try_inverse()
        });
        out.extend((0..n).map(|k| Value::real(inverse.map(|compliance| 1.0 / compliance[(k, k)]))));
    }

    /// Poses of springs and of rigid cables of the same unstrained lengths, each against the others. An equilibrium that
    /// does not hold the platform, as one of springs that are all slack, is no pose to compare with.
    fn pose_error(&mut self, out: &mut Vec<Value>) {
        let lengths: Vec<f64> = self.rest.cables.iter().map(|cable| cable.unstrained_length).collect();
        let with = |model: StaticModel| {
            let none = |reason: &str| {
                let reason = format!("with {} cables of the same lengths: {reason}", model.name());
                Status::new("no-comparison", &reason)
            };
            let found = statics::forward(self.robot, &lengths, model, Some(&self.rest.pose));
            let found = found.map_err(|error| none(&error.to_string()))?;
            match found.stability {
                Stability::Unstable { .. } => Err(none("the equilibrium does not hold the platform")),
                Stability::Stable { .. } | Stability::Rigid => Ok(found.pose),
            }
        };
        let spring = with(StaticModel::Spring);
        let distance = |from: &_, to: &_| PoseDifference::between(from, to).distance;
        let catenary = &self.rest.pose;
        let of_spring = spring.as_ref().map(|spring| distance(catenary, spring)).map_err(Clone::clone);
        if has_ideal_pose(self.robot) {
            let ideal = with(StaticModel::Ideal);
            let both = ideal.as_ref().and_then(|ideal| spring.as_ref().map(|spring| distance(ideal, spring)));
            let of_ideal = ideal.as_ref().map(|ideal| distance(ideal, catenary)).map_err(Clone::clone);
            let both = both.map_err(Clone::clone);
            self.push(both, out);
            self.push(of_ideal, out);
        }
        self.push(of_spring, out);
    }

    /// First frequency with another cable model over the exact one, less one.
    fn model_error(&mut self, model: CableModel) -> Result<f64, Status> {
        let Options { linearisation, highest_hz, .. } = *self.options;
        let (robot, rest) = (self.robot, self.rest);
        let first = |cable_model| {
            let asked = Linearisation { cable_model, ..linearisation };
            frequency::lowest(robot, rest, asked, 1, highest_hz)
        };
        let mut certified = true;
        let mut of = |found: &Result<Lowest, Status>| match found {
            Ok(lowest) => {
                certified &= lowest.certified;
                lowest.modes.first().map(|mode| mode.0).ok_or_else(not_certified)
            }
            Err(status) => Err(status.clone()),
        };
        let exact = if linearisation.cable_model == CableModel::Exact && self.most > 0 {
            of(self
                .lowest
                .get_or_init(|| frequency::lowest(self.robot, self.rest, linearisation, self.most, highest_hz)))?
        } else {
            of(self.exact.get_or_init(|| first(CableModel::Exact)))?
        };
        let simpler = of(&first(model))?;
        if !certified {
            self.missing.get_or_insert_with(not_certified);
        }
        Ok(simpler / exact - 1.0)
    }

    /// Least eigenvalue of the scaled static stiffness with another cable model over that of the catenary, less one.
    fn stiffness_error(&self, model: CableModel) -> Result<f64, Status> {
        let least = |cable_model| {
            let asked = Linearisation { cable_model, ..self.options.linearisation };
            let dynamics = Dynamics::about(self.robot, self.rest, asked, 0.0)
                .map_err(|error| Status::new("no-comparison", &error))?;
            let stiffness: Mat6 = dynamics.dynamic_stiffness(0.0);
            Ok::<f64, Status>(inertia::eigen(&stiffness, dynamics.freedoms()).0[0])
        };
        let exact = least(CableModel::CatenaryTangent)?;
        if exact <= 0.0 {
            return Err(Status::new(
                "unstable",
                "the least stiffness is not positive: nothing can be compared with it",
            ));
        }
        Ok(least(model)? / exact - 1.0)
    }
}

fn not_certified() -> Status {
    Status::new("not-certified", "the count does not confirm the lowest natural frequencies")
}

/// Least over largest singular value of the matrix of the cables' directions, moments over ℓ, in the platform's
/// coordinates: 0 at a singular pose, 1 where all freedoms are held alike.
fn inverse_condition(robot: &Robot, rest: &Equilibrium) -> f64 {
    let coordinates = Coordinates::of(robot);
    let columns: Vec<Vec6> = rest
        .cables
        .iter()
        .map(|cable| coordinates.reduce_force(&cable.chord_w().normalize(), &cable.lever_w))
        .collect();
    let matrix = DMat::from_fn(coordinates.count(), columns.len(), |i, j| columns[j][i]);
    let values = matrix.singular_values();
    let (least, most) = (values.min(), values.max());
    if most > 0.0 { least / most } else { 0.0 }
}
