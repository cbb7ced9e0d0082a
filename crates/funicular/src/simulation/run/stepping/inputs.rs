//! Inputs of an interval.

use super::{StepError, SteppedSimulation};
use crate::math::Vec3;
use crate::robot::Load;
use crate::simulation::body::HeldWrench;
use crate::simulation::event::check_can_move;
use crate::simulation::moving_anchor::AnchorCourse;
use crate::simulation::rope::WoundLength;
use crate::simulation::winding::{Winding, between};

/// Change of a length that needs no rate [m].
const MAX_JUMP: f64 = 1e-6;
/// Maximum mean speed of a commanded length [m/s]: the fastest rope robots reach 13 m/s.
const MAX_SPEED: f64 = 50.0;
/// Maximum difference of the mean speed from the rates at both ends over the interval [m/s²]: the fastest rope robots
/// reach 430 m/s².
const MAX_ACCELERATION: f64 = 1e3;
/// Difference of an input from what it was to be that is rounding, over its size.
const ROUNDING: f64 = 1e-9;
/// Jump of a commanded acceleration that counts [m/s²]: far above rounding, far below gravity.
const MIN_JUMP: f64 = 1e-6;

/// Inputs of an interval. Whatever is left out goes on: lengths with their last rates, anchors with their last
/// velocities, wrench and wind as they are.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StepInputs {
    /// Unstrained length that each winch is to have at the end, in file order; empty to leave all out.
    pub lengths: Vec<Option<LengthAtEnd>>,
    /// Place that the anchor of each cable is to have at the end, in file order; empty to leave all out.
    pub anchors: Vec<Option<AnchorAtEnd>>,
    /// Force and moment on the platform besides the load of the robot file.
    pub wrench: Option<WrenchInput>,
    /// Mean velocity of the wind, world axes [m/s].
    pub wind_w: Option<Vec3>,
}

/// Unstrained length at the end of an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LengthAtEnd {
    /// Length [m].
    pub length: f64,
    /// Rate at the end [m/s]; `None` for a length that does not change by more than a micrometre.
    pub rate: Option<f64>,
    /// Acceleration at the end [m/s²], with which the polynomial is of the fifth degree; `None` for the third degree.
    pub acceleration: Option<f64>,
}

/// Place of an anchor at the end of an interval, world axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnchorAtEnd {
    /// Place [m].
    pub place_w: Vec3,
    /// Velocity at the end [m/s]; `None` for a place that does not change by more than a micrometre.
    pub velocity_w: Option<Vec3>,
    /// Acceleration at the end [m/s²], with which the polynomials are of the fifth degree; `None` for the third degree.
    pub acceleration_w: Option<Vec3>,
}

/// Force and moment on the platform about its origin.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WrenchInput {
    /// Force at the beginning of the interval, world axes [N].
    pub force_w: Vec3,
    /// Moment at the beginning [N m].
    pub moment_w: Vec3,
    /// Rate of the force [N/s].
    pub force_rate_w: Vec3,
    /// Rate of the moment [N m/s].
    pub moment_rate_w: Vec3,
}

impl SteppedSimulation {
    /// Refuses inputs that are wrong by themselves.
    pub(super) fn check(&self, interval: f64, inputs: &StepInputs) -> Result<(), StepError> {
        let finite =
            |key: &'static str, is_finite: bool| if is_finite { Ok(()) } else { Err(StepError::NotFinite { key }) };
        let cables = self.robot.cables.len();
        if !inputs.lengths.is_empty() && inputs.lengths.len() != cables {
            return Err(StepError::Count { key: "lengths_m", given: inputs.lengths.len(), cables });
        }
        for (i, command) in inputs.lengths.iter().enumerate().filter_map(|(i, command)| Some((i, (*command)?))) {
            finite("lengths_m", command.length.is_finite())?;
            finite("rates_m_s", command.rate.is_none_or(f64::is_finite))?;
            finite("accelerations_m_s2", command.acceleration.is_none_or(f64::is_finite))?;
            self.check_length(i, interval, &command)?;
        }
        if !inputs.anchors.is_empty() && inputs.anchors.len() != cables {
            return Err(StepError::Count { key: "anchors_m", given: inputs.anchors.len(), cables });
        }
        for (i, anchor) in inputs.anchors.iter().enumerate().filter_map(|(i, anchor)| Some((i, (*anchor)?))) {
            let is_finite = |of: Option<Vec3>| of.is_none_or(|of| of.norm().is_finite());
            finite("anchors_m", is_finite(Some(anchor.place_w)))?;
            finite("anchor_velocities_m_s", is_finite(anchor.velocity_w))?;
            finite("anchor_accelerations_m_s2", is_finite(anchor.acceleration_w))?;
            self.check_anchor(i, interval, &anchor)?;
        }
        if let Some(WrenchInput { force_w, moment_w, force_rate_w, moment_rate_w }) = &inputs.wrench {
            let all = |of: [&Vec3; 2]| of.into_iter().all(|vector| vector.norm().is_finite());
            finite("force_n", all([force_w, force_rate_w]))?;
            finite("moment_n_m", all([moment_w, moment_rate_w]))?;
            for moment_w in [*moment_w, *moment_rate_w] {
                let load = Load { force_w: *force_w, moment_w, point_p: Vec3::zeros() };
                load.check(&self.robot.platform.motion)?;
            }
        }
        if let Some(wind_w) = &inputs.wind_w {
            finite("wind_m_s", wind_w.norm().is_finite())?;
            if self.robot.wind.air_density == 0.0 && wind_w.norm() > 0.0 {
                return Err(StepError::NoAir);
            }
        }
        Ok(())
    }

    fn check_length(&self, cable: usize, interval: f64, command: &LengthAtEnd) -> Result<(), StepError> {
        let name = || self.robot.cables[cable].name.clone();
        if self.holds_tension(cable) {
            return Err(StepError::HoldsTension { cable: name() });
        }
        let least = self.least[cable];
        if command.length < least {
            return Err(StepError::TooShort { cable: name(), length: command.length, least });
        }
        let now = self.run.stepper.system.windings[cable].at(self.time);
        let change = command.length - now.value;
        let rate = command.rate.unwrap_or(0.0);
        let mean = change / interval;
        let fastest = (mean - now.rate).abs().max((mean - rate).abs());
        let jumps = match command.rate {
            None => change.abs() > MAX_JUMP,
            Some(_) => mean.abs().max(rate.abs()) > MAX_SPEED || fastest / interval > MAX_ACCELERATION,
        };
        if jumps { Err(StepError::Jump { cable: name(), change, interval }) } else { Ok(()) }
    }

    fn check_anchor(&self, cable: usize, interval: f64, to: &AnchorAtEnd) -> Result<(), StepError> {
        check_can_move(&self.robot, cable).map_err(StepError::Event)?;
        let [place_w, velocity_w, _] = self.anchor(cable).at(self.time);
        let (change_w, velocity_at_end_w) = (to.place_w - place_w, to.velocity_w.unwrap_or_default());
        let mean_w = change_w / interval;
        let fastest = (mean_w - velocity_w).norm().max((mean_w - velocity_at_end_w).norm());
        let jumps = match to.velocity_w {
            None => change_w.norm() > MAX_JUMP,
            Some(_) => mean_w.norm().max(velocity_at_end_w.norm()) > MAX_SPEED || fastest / interval > MAX_ACCELERATION,
        };
        let name = || self.robot.cables[cable].name.clone();
        if jumps { Err(StepError::AnchorJump { cable: name(), change: change_w.norm(), interval }) } else { Ok(()) }
    }

    /// Course of an anchor, also of one that rests.
    pub(super) fn anchor(&self, cable: usize) -> AnchorCourse {
        let course = self.run.stepper.system.anchors[cable].clone();
        course.unwrap_or_else(|| AnchorCourse::resting(self.robot.cables[cable].anchor.point_w))
    }

    /// Takes the inputs of the interval that ends at `end`; `true` if all go on as they were.
    pub(super) fn take_inputs(&mut self, end: f64, inputs: &StepInputs) -> Result<bool, StepError> {
        let (courses, anchors) = (self.courses(end, inputs), self.anchor_courses(end, inputs));
        let wrench = inputs.wrench.and_then(|wrench| self.held(&wrench));
        let wind_w = inputs.wind_w.filter(|wind_w| wind_w != self.run.stepper.system.air.mean_w());
        let goes_on =
            courses.iter().chain(anchors.iter().flatten()).all(Option::is_none) && wrench.is_none() && wind_w.is_none();
        if goes_on {
            return Ok(true);
        }

        self.go_back()?;
        let now = self.time;
        self.run.breaks.retain(|at| *at > now);
        let system = &mut self.run.stepper.system;
        system.body.pushes.retain(|push| push.until > now);
        let mut jumps = wind_w.is_some();
        for (winding, course) in system.windings.iter_mut().zip(courses) {
            let Some((until, coefficients)) = course else { continue };
            let before = winding.at(now).acceleration;
            winding.command(now, until, coefficients);
            jumps |= (winding.at(now).acceleration - before).abs() > MIN_JUMP;
        }
        jumps |= self.move_anchors(&anchors);
        let system = &mut self.run.stepper.system;
        if let Some((held, is_jump)) = wrench {
            system.body.held = Some(held);
            jumps |= is_jump;
        }
        if let Some(wind_w) = wind_w {
            *system.air.mean_w() = wind_w;
        }
        if jumps {
            self.jump()?;
        }
        Ok(false)
    }

    /// New course of each length; `None` where the present one goes on.
    fn courses(&self, end: f64, inputs: &StepInputs) -> Vec<Option<NewCourse>> {
        let windings = self.run.stepper.system.windings.iter().enumerate();
        let command = |i: usize| inputs.lengths.get(i).copied().flatten();
        windings.map(|(i, winding)| new_course(winding, (self.time, end), command(i))).collect()
    }

    /// New courses of each anchor along the axes; `None` where the present one goes on.
    fn anchor_courses(&self, end: f64, inputs: &StepInputs) -> Vec<[Option<NewCourse>; 3]> {
        let along = |i: usize| {
            let given = inputs.anchors.get(i).copied().flatten();
            if given.is_none() && self.run.stepper.system.anchors[i].is_none() {
                return [None; 3];
            }
            let course = self.anchor(i);
            let home_w = course.home_w;
            std::array::from_fn(|axis| {
                let to = given.map(|of| LengthAtEnd {
                    length: of.place_w[axis] - home_w[axis],
                    rate: of.velocity_w.map(|velocity_w| velocity_w[axis]),
                    acceleration: of.acceleration_w.map(|acceleration_w| acceleration_w[axis]),
                });
                new_course(&course.axes[axis], (self.time, end), to)
            })
        };
        (0..self.robot.cables.len()).map(along).collect()
    }

    /// Lets anchors take new courses; `true` if an acceleration jumps.
    fn move_anchors(&mut self, courses: &[[Option<NewCourse>; 3]]) -> bool {
        let (now, mut jumps) = (self.time, false);
        for (i, new) in courses.iter().enumerate().filter(|(_, new)| new.iter().any(Option::is_some)) {
            let mut course = self.anchor(i);
            let before_w = course.moved(now)[2];
            for (axis, new) in course.axes.iter_mut().zip(new) {
                if let Some((until, coefficients)) = *new {
                    axis.command(now, until, coefficients);
                }
            }
            jumps |= (course.moved(now)[2] - before_w).norm() > MIN_JUMP;
            self.run.stepper.system.anchors[i] = Some(course);
        }
        jumps
    }

    /// Wrench that takes the place of the present one, and whether it jumps; `None` if the present one goes on.
    fn held(&self, given: &WrenchInput) -> Option<(HeldWrench, bool)> {
        let WrenchInput { force_w, moment_w, force_rate_w, moment_rate_w } = *given;
        let present = self.run.stepper.system.body.held.unwrap_or_default();
        let [force_now_w, moment_now_w] = present.at(self.time);
        let is_near = |a: &Vec3, b: &Vec3| a == b || (a - b).norm() < ROUNDING * a.norm().max(b.norm());
        let is_continuous = is_near(&force_w, &force_now_w) && is_near(&moment_w, &moment_now_w);
        if is_continuous && force_rate_w == present.force_rate_w && moment_rate_w == present.moment_rate_w {
            return None;
        }
        Some((HeldWrench { from: self.time, force_w, moment_w, force_rate_w, moment_rate_w }, !is_continuous))
    }
}

/// Polynomial that takes the place of a course, with the time of its end [s].
type NewCourse = (f64, [f64; 6]);

/// Course that takes the place of the present one from `now` to `end`; `None` if that goes on.
fn new_course(winding: &Winding, (now, end): (f64, f64), command: Option<LengthAtEnd>) -> Option<NewCourse> {
    let (from, is_over) = (winding.at(now), winding.ends_at() <= now);
    let Some(command) = command else {
        // A length goes on with its rate.
        let is_straight = from.acceleration.abs() <= MIN_JUMP || !is_over;
        return (!is_straight).then_some((now, [from.value, from.rate, 0.0, 0.0, 0.0, 0.0]));
    };
    let to = WoundLength {
        value: command.length,
        rate: command.rate.unwrap_or(0.0),
        acceleration: command.acceleration.unwrap_or(0.0),
    };
    let expected = winding.at(end);
    let is_near = |a: f64, b: f64, size: f64| (a - b).abs() <= ROUNDING * size;
    let is_expected = is_over
        && is_near(to.value, expected.value, 1e-3)
        && is_near(to.rate, expected.rate, 1e-3)
        && command.acceleration.is_none_or(|given| is_near(given, expected.acceleration, 1.0));
    (!is_expected).then(|| (end, between(&from, &to, end - now, command.acceleration.is_some())))
}
