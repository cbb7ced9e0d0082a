//! A simulation that advances by intervals whose inputs are known only when they begin.
//!
//! The integrator's own steps do not end where an interval ends, as long as the inputs go on as they were: the robot
//! there is read off within the step. Where an input changes, the last step is taken again to that time, and the next
//! one begins there with the same size and, if nothing jumps, the same factored matrix.

mod events;
mod inputs;
mod saved;
mod signals;

use super::{RobotSample, Simulation, SlackCable};
use crate::math::Vec3;
use crate::robot::{Control, LoadError, Robot};
use crate::simulation::event::{EventFault, LEAST_LENGTH};
use crate::simulation::feed::WinchHold;
use crate::simulation::start::{SimulationError, SimulationSettings};
use crate::simulation::system::RopeEnd;
use crate::statics::{CableState, Equilibrium};
pub use inputs::{AnchorAtEnd, LengthAtEnd, StepInputs, WrenchInput};
use saved::fingerprint;
pub use signals::{StepSignal, StepSignals};
use thiserror::Error;

/// Range of intervals [s]. Shorter ones are below what a step can be; longer ones are more than a controller waits, and
/// the robot in between would not be seen.
const INTERVALS: [f64; 2] = [1e-6, 1.0];

/// Time over which gusts have no period [s].
const GUSTS: f64 = 100.0;

/// Reason why a simulation did not advance, or take an event or a state. It is then as it was before.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StepError {
    /// An interval that is not one.
    #[error("`dt_s` is {interval} s: give {} to {} s", INTERVALS[0], INTERVALS[1])]
    Interval {
        /// Given interval [s].
        interval: f64,
    },
    /// A number that is not finite.
    #[error("`{key}` has a number that is not finite: leave the input out, or give a number")]
    NotFinite {
        /// Key of the input.
        key: &'static str,
    },
    /// Another number of values than there are cables.
    #[error("`{key}` has {given} values, and the robot has {cables} cables: give one for each")]
    Count {
        /// Key of the input.
        key: &'static str,
        /// Number of values.
        given: usize,
        /// Number of cables.
        cables: usize,
    },
    /// Another number of values than there are inputs.
    #[error("{given} values are given, and there are {inputs} inputs: give one for each")]
    SignalCount {
        /// Number of values.
        given: usize,
        /// Number of inputs.
        inputs: usize,
    },
    /// A length that jumps.
    #[error(
        "the length of cable \"{cable}\" would change by {change} m within {interval} s, which is a jump: give its \
         rate as well, a smaller change, or a longer interval"
    )]
    Jump {
        /// Name of the cable.
        cable: String,
        /// Change of the length [m].
        change: f64,
        /// Interval [s].
        interval: f64,
    },
    /// An anchor that jumps.
    #[error(
        "the anchor of cable \"{cable}\" would move by {change} m within {interval} s, which is a jump: give its \
         velocity as well, a smaller change, or a longer interval"
    )]
    AnchorJump {
        /// Name of the cable.
        cable: String,
        /// Change of its place [m].
        change: f64,
        /// Interval [s].
        interval: f64,
    },
    /// A cable that would be too short.
    #[error("the length of cable \"{cable}\" would be {length} m: give at least {least} m")]
    TooShort {
        /// Name of the cable.
        cable: String,
        /// Length [m].
        length: f64,
        /// Least length [m].
        least: f64,
    },
    /// A length is commanded of a winch that holds a tension.
    #[error("the winch of cable \"{cable}\" holds a tension, so that its length cannot be commanded")]
    HoldsTension {
        /// Name of the cable.
        cable: String,
    },
    /// A tension is asked of a winch that cannot hold one.
    #[error(
        "the winch of cable \"{cable}\" does not hold a tension: name the cable in `tension_control` when the \
         simulation begins"
    )]
    NoTensionControl {
        /// Name of the cable.
        cable: String,
    },
    /// Wind without air.
    #[error("the robot has no air, so that wind has no effect: give `air_density_kg_m3` in [wind]")]
    NoAir,
    /// A load that the platform cannot carry.
    #[error("{0}")]
    Load(#[from] LoadError),
    /// An event of another time.
    #[error("the event is at {event} s, and the simulation is at {now} s: an event happens at the present time")]
    NotNow {
        /// Time of the event [s].
        event: f64,
        /// Present time [s].
        now: f64,
    },
    /// A table of lengths or of places of anchors.
    #[error("a table is no event of a simulation in intervals: give the lengths or places at the end of each interval")]
    Table,
    /// A failure at a place along a cable.
    #[error(
        "a cable fails at the platform in a simulation in intervals, not {place} m from it: leave out the place, or \
         give the failure to a simulation from start to end"
    )]
    Place {
        /// Unstrained length between the platform and the place [m].
        place: f64,
    },
    /// A cable that does not exist.
    #[error("there is no cable {cable}: the robot has {cables}")]
    NoCable {
        /// Index.
        cable: usize,
        /// Number of cables.
        cables: usize,
    },
    /// An event that cannot happen.
    #[error("{0}")]
    Event(EventFault),
    /// A motion that cannot be followed.
    #[error("{0}")]
    Failed(SimulationError),
    /// Bytes that are no state.
    #[error("this is no saved state of a simulation: give the bytes that `save` returned")]
    NotSaved,
    /// A state with other bytes than it was saved with.
    #[error("the saved state is damaged: its checksum is another one")]
    Damaged,
    /// A state of another simulation.
    #[error("the saved state belongs to another robot, another start or other settings")]
    OtherRobot,
}

impl From<SimulationError> for StepError {
    fn from(error: SimulationError) -> Self {
        match error {
            SimulationError::Event { fault, .. } => Self::Event(fault),
            other => Self::Failed(other),
        }
    }
}

/// Simulation of a robot in intervals, with inputs and events that are known only when they come.
///
/// # Example
/// ```
/// use funicular::robot::Robot;
/// use funicular::simulation::{SimulationSettings, StepInputs, SteppedSimulation, WrenchInput};
/// use funicular::statics::{self, StaticModel};
///
/// let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
/// let rest = statics::solve(&robot, StaticModel::Catenary, None)?.equilibrium;
/// let mut simulation = SteppedSimulation::new(&robot, &rest, &[], &SimulationSettings::default())?;
/// let up = WrenchInput { force_w: [0.0, 0.0, 20.0].into(), ..WrenchInput::default() }; // N
/// let inputs = StepInputs { wrench: Some(up), ..StepInputs::default() };
/// let saved = simulation.save();
/// let sample = simulation.step(0.001, &inputs)?;
/// assert!(sample.velocity_w[2] > 0.0);
/// simulation.restore(&saved)?;
/// assert_eq!(simulation.step(0.001, &inputs)?, sample);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct SteppedSimulation {
    run: Simulation,
    robot: Robot,
    /// Present time [s], at which the integrator is or which its last step passed.
    time: f64,
    /// Least unstrained lengths [m].
    least: Vec<f64>,
    /// Records of slack cables before the last step.
    slack_before: Vec<SlackCable>,
    fingerprint: u64,
    /// Numbers before a step.
    before: Vec<f64>,
}

impl SteppedSimulation {
    /// Simulation that begins at `rest`. `tension_control` has the indices of the cables whose winches may be told to
    /// hold a tension.
    ///
    /// # Errors
    /// [`SimulationError`], as those of [`Simulation::new`]; [`StepError::NoCable`].
    pub fn new(
        robot: &Robot,
        rest: &Equilibrium,
        tension_control: &[usize],
        settings: &SimulationSettings,
    ) -> Result<Self, StepError> {
        let cables = robot.cables.len();
        if let Some(cable) = tension_control.iter().find(|cable| **cable >= cables) {
            return Err(StepError::NoCable { cable: *cable, cables });
        }
        let mut run =
            Simulation::begun(robot, rest, &[], (GUSTS, f64::INFINITY), settings, &|i| tension_control.contains(&i))?;
        for winding in &mut run.stepper.system.windings {
            let length = winding.at(0.0).value;
            winding.command(0.0, 0.0, [length, 0.0, 0.0, 0.0, 0.0, 0.0]);
        }
        run.breaks.clear();
        let least = |cable: &CableState| cable.unstrained_length - (1.0 - LEAST_LENGTH) * cable.free_length();
        Ok(Self {
            robot: robot.clone(),
            time: 0.0,
            least: rest.cables.iter().map(least).collect(),
            slack_before: run.slack.clone(),
            fingerprint: fingerprint(robot, rest, tension_control, settings),
            before: Vec::new(),
            run,
        })
    }

    /// Present time [s].
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Robot that is simulated, without what has happened to it.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Simulation behind, for the counts of its steps and the records of slack cables.
    pub fn run(&self) -> &Simulation {
        &self.run
    }

    /// Robot at the present time.
    pub fn now(&mut self) -> RobotSample {
        self.run.sample(self.time)
    }

    /// Place, velocity and acceleration of the anchor of a cable at the present time, world axes.
    pub fn anchor_motion(&self, cable: usize) -> [Vec3; 3] {
        self.anchor(cable).at(self.time)
    }

    /// Force and moment that a caller holds at the present time, with their rates.
    pub fn held_wrench(&self) -> WrenchInput {
        let held = self.run.stepper.system.body.held.unwrap_or_default();
        let [force_w, moment_w] = held.at(self.time);
        WrenchInput { force_w, moment_w, force_rate_w: held.force_rate_w, moment_rate_w: held.moment_rate_w }
    }

    /// Advances by an interval [s] and returns the robot at its end, with the inputs of this interval.
    ///
    /// # Errors
    /// [`StepError`]; the simulation is then as it was.
    pub fn step(&mut self, interval: f64, inputs: &StepInputs) -> Result<RobotSample, StepError> {
        if !(INTERVALS[0]..=INTERVALS[1]).contains(&interval) {
            return Err(StepError::Interval { interval });
        }
        self.check(interval, inputs)?;
        self.or_as_before(|simulation| simulation.advance(interval, inputs))
    }

    /// Changes the simulation, or leaves it as it was.
    fn or_as_before<T>(&mut self, change: impl FnOnce(&mut Self) -> Result<T, StepError>) -> Result<T, StepError> {
        let mut before = std::mem::take(&mut self.before);
        self.numbers(&mut before);
        let found = change(self);
        if found.is_err() {
            self.take_numbers(&before);
        }
        self.before = before;
        found
    }

    fn advance(&mut self, interval: f64, inputs: &StepInputs) -> Result<RobotSample, StepError> {
        let end = self.time + interval;
        let goes_on = self.take_inputs(end, inputs)?;
        // A cable must not fail in a future that may not come.
        let latest = if goes_on && self.run.fuses.is_empty() { f64::INFINITY } else { end };
        self.reach(end, latest)?;
        self.time = end;
        let sample = self.run.sample(end);
        if is_finite(&sample) { Ok(sample) } else { Err(StepError::Failed(self.run.too_fast(end))) }
    }

    /// Takes steps, none beyond `latest`, until the integrator is at a time or beyond it.
    fn reach(&mut self, time: f64, latest: f64) -> Result<(), StepError> {
        while self.run.stepper.time < time {
            self.slack_before.clone_from(&self.run.slack);
            self.run.advance(latest)?;
        }
        Ok(())
    }

    /// Cuts the last step short at the present time: it is taken again from its beginning.
    fn go_back(&mut self) -> Result<(), StepError> {
        if self.run.stepper.time <= self.time {
            return Ok(());
        }
        let Some((dense, powers, books)) = self.run.last.take() else { return Ok(()) };
        (self.run.books, self.run.powers) = (books, powers.at[0]);
        self.run.slack.clone_from(&self.slack_before);
        for far in self.run.stepper.system.far_ends.iter_mut().flatten() {
            far.off_tangent = far.off_tangent_before;
        }
        self.run.stepper.go_back(&dense, dense.from);
        self.run.stepper.counts.accepted -= 1;
        self.run.stepper.counts.rejected += 1;
        self.reach(self.time, self.time)
    }

    /// New accelerations at the present time, after a jump of what acts.
    fn jump(&mut self) -> Result<(), StepError> {
        self.run.stepper.accelerate().map_err(|of| self.run.too_fast(of.time))?;
        self.run.take_energy();
        Ok(())
    }

    /// True if the winch of a cable holds a tension in place of a length.
    fn holds_tension(&self, cable: usize) -> bool {
        let far = self.run.stepper.system.far_ends[cable].as_ref();
        let winch = self.robot.cables[cable].anchor.winch.as_ref();
        far.and_then(|far| far.feed.as_ref()).is_some_and(|feed| feed.hold != WinchHold::Length)
            || winch.is_some_and(|winch| winch.control == Control::Torque)
    }

    /// True for an anchor without a course.
    fn has_not_moved(&self, cable: usize) -> bool {
        self.run.stepper.system.anchors[cable].is_none()
    }

    fn is_attached(&self, cable: usize) -> bool {
        self.run.stepper.system.ends[cable] == RopeEnd::Attached
    }
}

fn is_finite(sample: &RobotSample) -> bool {
    let numbers = sample.pose.position_w.iter().chain(sample.velocity_w.iter()).chain(sample.acceleration_w.iter());
    let tensions = sample.cables.iter().flat_map(|cable| [&cable.tension_platform, &cable.tension_anchor]);
    numbers.chain(tensions).all(|number| number.is_finite())
}
