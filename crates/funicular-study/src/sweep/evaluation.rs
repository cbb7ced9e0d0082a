//! Equilibrium of one point with the results that several quantities share.

use super::frequency::{self, Lowest};
use super::gusts::{self, PointInGusts};
use super::options::Options;
use super::status::Status;
use crate::table::Value;
use funicular::cable::CableModel;
use funicular::clearance::{Clearance, Surroundings};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::gradient::Hold;
use funicular::modes::Kind;
use funicular::modes::damped::{DECAY_PERCENT, DampedMode};
use funicular::pose_error::PoseDifference;
use funicular::robot::parameters::Parameters;
use funicular::robot::{Constraint, Robot, TwistSet};
use funicular::speeds::WinchSpeeds;
use funicular::statics::{
    self, Equilibrium, LimitAtCable, LoadCapacity, PayloadSide, RequestedPayload, Stability, StaticModel, StaticsError,
    TensionRule,
};
use funicular::warnings;
use funicular::winch_needs::{WinchNeed, WinchNeeds, WinchNeedsError};
use std::cell::OnceCell;

/// Frequency up to which cables are resolved for their slow motion [Hz]; the shape of slow motion itself is exact.
const SLOW_HZ: f64 = 0.1;

/// Reader of the numbers of the robot file of a point.
pub(super) type ReadParameters<'a> = dyn Fn() -> Option<Parameters> + 'a;

/// Robot at the equilibrium of a point, with results that several quantities share.
pub(super) struct PointEvaluation<'a> {
    pub(super) robot: &'a Robot,
    pub(super) rest: &'a Equilibrium,
    /// Quantity that is held while a number of the robot changes.
    pub(super) hold: Hold,
    /// Reader of the numbers of the robot file of this point.
    read: &'a ReadParameters<'a>,
    options: &'a Options,
    /// Lowest frequencies with the cable model of the options, as many as the quantities need.
    lowest: OnceCell<Result<Lowest, Status>>,
    /// Number of frequencies in `lowest`.
    frequency_count: usize,
    /// First frequency with the cable model `catenary-dynamic`, for comparisons.
    exact: OnceCell<Result<Lowest, Status>>,
    /// Damped partner of the first mode of the platform, and true if its list is certified.
    damped_platform: OnceCell<Result<(DampedMode, bool), Status>>,
    /// Loads that the cables hold at the pose.
    capacity: OnceCell<Result<LoadCapacity<'a>, Status>>,
    /// Winches while the platform moves.
    speeds: OnceCell<Result<WinchSpeeds, Status>>,
    /// Needs of the winches for everything that is required.
    winches: OnceCell<Result<WinchNeeds, Status>>,
    /// Response to the gusts of the robot file.
    in_gusts: OnceCell<Result<PointInGusts, Status>>,
    /// Pair with the least margin between cables, platform and obstacles, with its text.
    nearest: OnceCell<Option<(Clearance, String)>>,
    /// First reason why a requested value is missing.
    missing: Option<Status>,
}

impl<'a> PointEvaluation<'a> {
    /// Equilibrium of a point before any quantity of it is computed; the quantities need the lowest `frequency_count`
    /// frequencies.
    pub(super) fn new(
        robot: &'a Robot,
        rest: &'a Equilibrium,
        hold: Hold,
        read: &'a ReadParameters<'a>,
        options: &'a Options,
        frequency_count: usize,
    ) -> Self {
        let (lowest, exact, damped_platform) = (OnceCell::new(), OnceCell::new(), OnceCell::new());
        let missing = Status::note_for(robot, rest);
        let (capacity, speeds, winches, in_gusts) =
            (OnceCell::new(), OnceCell::new(), OnceCell::new(), OnceCell::new());
        let nearest = OnceCell::new();
        Self {
            robot,
            rest,
            hold,
            read,
            options,
            lowest,
            frequency_count,
            exact,
            damped_platform,
            capacity,
            speeds,
            winches,
            in_gusts,
            nearest,
            missing,
        }
    }

    /// Numbers of the robot file of this point.
    pub(super) fn parameters(&self) -> Option<Parameters> {
        (self.read)()
    }

    /// Rule that chooses the tensions while the pose is held; `None` without a choice.
    pub(super) fn rule(&self) -> Option<&'a TensionRule> {
        (self.hold != Hold::Lengths && self.robot.constraint().is_redundant()).then_some(&self.options.tension_rule)
    }

    /// Linearisation, and upper limit of the search for natural frequencies [Hz].
    pub(super) fn vibration(&self) -> (Linearisation, f64) {
        (self.options.linearisation, self.options.highest_hz)
    }

    /// Keeps the reason why a value is missing, unless the row has one already.
    pub(super) fn note_missing(&mut self, status: Status) {
        self.missing.get_or_insert(status);
    }

    /// First reason why a requested value is missing, or the caveat about the equilibrium.
    pub(super) fn into_missing(self) -> Option<Status> {
        self.missing
    }
}

impl PointEvaluation<'_> {
    /// Adds a value. If there is only a reason, adds nothing and keeps the reason, unless the row has one already.
    pub(super) fn push(&mut self, value: Option<Result<f64, Status>>, out: &mut Vec<Value>) {
        match value {
            None => out.push(Value::Nothing),
            Some(Ok(value)) => out.push(Value::real(Some(value))),
            Some(Err(status)) => {
                out.push(Value::Nothing);
                self.missing.get_or_insert(status);
            }
        }
    }

    /// Minimum and maximum tension anywhere in each cable.
    pub(super) fn tensions(&self) -> impl Iterator<Item = (f64, f64)> {
        self.rest.cables.iter().map(|cable| match &cable.hanging {
            Some(hanging) => (hanging.catenary.min_tension(), hanging.catenary.max_tension()),
            None => (cable.tension_platform, cable.tension_platform),
        })
    }

    /// Lowest modes with the requested cable model.
    pub(super) fn modes(&mut self) -> Option<&[(f64, Kind)]> {
        let found = self.lowest.get_or_init(|| {
            frequency::lowest(
                self.robot,
                self.rest,
                self.options.linearisation,
                self.frequency_count,
                self.options.highest_hz,
            )
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

    pub(super) fn frequencies(&mut self, count: usize, out: &mut Vec<Value>) {
        let end = out.len() + count;
        if let Some(modes) = self.modes() {
            out.extend(modes.iter().take(count).map(|mode| Value::real(Some(mode.0))));
        }
        out.resize(end, Value::Nothing);
    }

    /// Distances between the poses of catenary, spring and rigid cables with the same unstrained lengths. An
    /// equilibrium that does not hold the platform, for example with slack springs only, is not compared.
    pub(super) fn pose_error(&mut self, out: &mut Vec<Value>) {
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
        if self.robot.constraint() == Constraint::Fully {
            let ideal = with(StaticModel::Ideal);
            let both = ideal.as_ref().and_then(|ideal| spring.as_ref().map(|spring| distance(ideal, spring)));
            let of_ideal = ideal.as_ref().map(|ideal| distance(ideal, catenary)).map_err(Clone::clone);
            let both = both.map_err(Clone::clone);
            self.push(Some(both), out);
            self.push(Some(of_ideal), out);
        }

        self.push(Some(of_spring), out);
    }

    /// Lowest natural frequency of a mode with enough of its kinetic energy in the platform.
    pub(super) fn first_platform_frequency(&mut self) -> Result<f64, Status> {
        let Options { linearisation, highest_hz, platform_share, .. } = *self.options;
        let (first, certified) =
            frequency::first_platform(self.robot, self.rest, linearisation, platform_share, highest_hz)?;
        if !certified {
            self.missing.get_or_insert_with(not_certified);
        }
        Ok(first)
    }

    /// Lowest frequency of the platform on cables that follow it as at rest.
    pub(super) fn platform_frequency(&self) -> Result<f64, Status> {
        let (robot, rest) = self.rest.with_dynamic_stiffness(self.robot);
        let dynamics = Dynamics::about(&robot, &rest, self.options.linearisation, SLOW_HZ)
            .map_err(|error| Status::new("no-frequency", &error))?;
        let none = || Status::new("no-frequency", "some motion of the platform has no mass or no positive stiffness");
        dynamics.platform_frequency().ok_or_else(none)
    }

    /// Damping ratio of the damped partner of the first mode of the platform, and the time in which its amplitude falls
    /// to [`DECAY_PERCENT`] [s].
    pub(super) fn platform_damping(&mut self) -> Result<(f64, f64), Status> {
        let found = self.damped_platform.get_or_init(|| {
            let Options { linearisation, highest_hz, platform_share, .. } = *self.options;
            frequency::damped_platform(self.robot, self.rest, linearisation, platform_share, highest_hz)
        });
        let (mode, certified) = found.clone()?;
        if !certified {
            self.missing.get_or_insert_with(not_certified);
        }
        let time = mode.decay_time(0.01 * DECAY_PERCENT);
        if !time.is_finite() {
            return Err(Status::new("no-decay", "the first mode of the platform does not decay: nothing damps it"));
        }
        Ok((mode.damping_ratio(), time))
    }

    /// Number of the response to gusts; it is missing for fewer than ten expected crossings.
    pub(super) fn of_gusts(&self, number: impl FnOnce(&PointInGusts) -> Option<f64>) -> Result<f64, Status> {
        let find = || gusts::at_point(self.robot, self.rest, self.options.linearisation);
        let found = self.in_gusts.get_or_init(find).as_ref().map_err(Clone::clone)?;
        number(found).ok_or_else(|| Status::new("no-gusts", "too few crossings of the mean are expected for a peak"))
    }

    /// Measure of the loads that the cables hold at the pose; `unlimited` says why there is none if it is infinite or
    /// does not exist.
    pub(super) fn of_capacity(
        &self,
        measure: impl FnOnce(&LoadCapacity) -> Result<Option<f64>, StaticsError>,
        unlimited: &str,
    ) -> Result<f64, Status> {
        let Self { robot, rest, .. } = *self;
        let found = self.capacity.get_or_init(|| {
            LoadCapacity::at(robot, &rest.pose, self.options.static_model, Some(rest))
                .map_err(|error| Status::of_error(&error))
        });
        let capacity = found.as_ref().map_err(Clone::clone)?;
        let value = measure(capacity).map_err(|error| match error {
            StaticsError::NothingRequired | StaticsError::NoLoadFactor => Status::new("required-load", &error),
            _ => Status::new("dead-load", &error),
        })?;
        value.filter(|value| value.is_finite()).ok_or_else(|| Status::new("required-load", unlimited))
    }

    /// Measure of the speeds that the winches allow; `none` says why there is none if it does not exist.
    pub(super) fn of_speeds(
        &self,
        measure: impl FnOnce(&WinchSpeeds) -> Option<f64>,
        none: &str,
    ) -> Result<f64, Status> {
        let find = || {
            let found = WinchSpeeds::at(self.robot, self.rest, self.rule());
            found.map_err(|error| Status::new("no-derivative", &error))
        };
        let speeds = self.speeds.get_or_init(find).as_ref().map_err(Clone::clone)?;
        let value = measure(speeds).filter(|value| value.is_finite());
        value.ok_or_else(|| Status::new("no-speed", none))
    }

    /// Measure of the speeds for the required velocities; it is missing if none is required.
    pub(super) fn of_required_speeds(
        &self,
        measure: impl FnOnce(&WinchSpeeds, &TwistSet) -> f64,
    ) -> Result<f64, Status> {
        let twists = self.robot.required.twists_w();
        let asks = !twists.is_empty();
        let none = if asks { "no winch limits the required velocities" } else { "no velocity is required" };
        self.of_speeds(|speeds| asks.then(|| measure(speeds, &twists)), none)
    }

    /// Largest need of a winch for everything that is required, over all cables.
    pub(super) fn winch_need(&mut self, need: WinchNeed, out: &mut Vec<Value>) {
        let find = || {
            let Options { static_model, tension_rule, .. } = self.options;
            WinchNeeds::at(self.robot, &self.rest.pose, *static_model, tension_rule).map_err(|error| match error {
                WinchNeedsError::NotHeld { .. } => Status::new("required-load", &error),
                WinchNeedsError::NoRates(_) => Status::new("no-derivative", &error),
            })
        };
        let none = || Status::new("no-torque", "no drum has a radius, so there is no torque of a motor");
        let found = self.winches.get_or_init(find).as_ref().map_err(Clone::clone);
        let value = found.and_then(|needs| needs.of_one(need).map(|(_, of)| of.value).ok_or_else(none));
        self.push(Some(value), out);
    }

    /// Pair with the least margin between cables, platform and obstacles, with its text.
    fn nearest(&self) -> Option<&(Clearance, String)> {
        let find = || {
            let around = Surroundings::of(self.robot);
            around.least(self.rest, None).map(|least| (least, around.pair_text(least.pair)))
        };
        self.nearest.get_or_init(find).as_ref()
    }

    /// Status of an equilibrium at which cables, platform and obstacles are too near to each other. It has quantities.
    pub(super) fn interference(&self) -> Option<Status> {
        if !self.robot.judges_clearance() {
            return None;
        }
        let (least, pair) = self.nearest()?;
        warnings::of_nearest(pair, least).map(|warning| Status::new("interference", &warning))
    }

    /// Adds the least distance between cables, platform and obstacles, its margin and the pair.
    pub(super) fn clearance(&mut self, out: &mut Vec<Value>) {
        if let Some((least, pair)) = self.nearest() {
            out.extend([least.distance, least.margin()].map(|value| Value::real(Some(value))));
            out.push(Value::Text(pair.clone().into()));
        } else {
            out.extend([Value::Nothing, Value::Nothing, Value::Nothing]);
            self.note_missing(Status::new("no-comparison", "there is no pair of things whose distance counts"));
        }
    }

    /// Adds the maximum payload and the limits that bind.
    pub(super) fn payload(&mut self, out: &mut Vec<Value>) {
        let Options { static_model, payload_center_p, .. } = *self.options;
        let center_p = payload_center_p.unwrap_or(self.robot.platform.center_of_mass_p);
        let requested = RequestedPayload { center_p, side: PayloadSide::Maximum, prove: false };
        let found = statics::payload_bound(self.robot, &self.rest.pose, static_model, requested, Some(self.rest));
        let found = match found {
            Ok(found) if found.mass.is_finite() => Ok(found),
            Ok(_) => Err(Status::new("unlimited", "no maximum tension limits the payload")),
            Err(error) => Err(Status::new("no-payload", &error)),
        };
        match found {
            Ok(found) => {
                out.push(Value::real(Some(found.mass)));
                let limits: Vec<String> = found.limits.iter().map(|of| limit_text(self.robot, of)).collect();
                out.push(Value::Text(limits.join(", ").into()));
            }
            Err(status) => {
                out.extend([Value::Nothing, Value::Nothing]);
                self.missing.get_or_insert(status);
            }
        }
    }

    /// First frequency with another cable model divided by the one with `catenary-dynamic`, minus one.
    pub(super) fn model_error(&mut self, model: CableModel) -> Result<f64, Status> {
        let Options { linearisation, highest_hz, .. } = *self.options;
        let (robot, rest) = (self.robot, self.rest);
        let first = |cable_model| {
            let requested = Linearisation { cable_model, ..linearisation };
            frequency::lowest(robot, rest, requested, 1, highest_hz)
        };

        let mut certified = true;
        let mut of = |found: &Result<Lowest, Status>| match found {
            Ok(lowest) => {
                certified &= lowest.certified;
                lowest.modes.first().map(|mode| mode.0).ok_or_else(not_certified)
            }
            Err(status) => Err(status.clone()),
        };
        let exact = if linearisation.cable_model == CableModel::CatenaryDynamic && self.frequency_count > 0 {
            of(self.lowest.get_or_init(|| {
                frequency::lowest(self.robot, self.rest, linearisation, self.frequency_count, highest_hz)
            }))?
        } else {
            of(self.exact.get_or_init(|| first(CableModel::CatenaryDynamic)))?
        };
        let simpler = of(&first(model))?;

        if !certified {
            self.missing.get_or_insert_with(not_certified);
        }

        Ok(simpler / exact - 1.0)
    }

    /// Minimum eigenvalue of the scaled static stiffness with another cable model divided by the one with
    /// `catenary-static`, minus one.
    pub(super) fn stiffness_error(&self, model: CableModel) -> Result<f64, Status> {
        let min_stiffness = |cable_model| {
            let requested = Linearisation { cable_model, ..self.options.linearisation };
            let (robot, rest) = self.rest.with_dynamic_stiffness(self.robot);
            let dynamics =
                Dynamics::about(&robot, &rest, requested, 0.0).map_err(|error| Status::new("no-comparison", &error))?;
            Ok::<f64, Status>(dynamics.min_static_stiffness())
        };
        let exact = min_stiffness(CableModel::CatenaryStatic)?;
        if exact <= 0.0 {
            return Err(Status::new(
                "unstable",
                "the minimum stiffness is not positive: no model can be compared with it",
            ));
        }
        Ok(min_stiffness(model)? / exact - 1.0)
    }
}

/// Limit that a tension has reached, as in `1 maximum at anchor`.
fn limit_text(robot: &Robot, of: &LimitAtCable) -> String {
    let LimitAtCable { cable, limit, place } = of;
    format!("{} {} at {}", robot.cables[*cable].name, limit.name(), place.name())
}

fn not_certified() -> Status {
    Status::new("not-certified", "the mode count does not confirm the lowest natural frequencies")
}
