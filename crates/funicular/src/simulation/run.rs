//! A simulation from its start to its end: events in their order, samples at the times that the caller asks for.

use super::books::{EnergyBooks, Powers, StepPowers};
use super::dense::DenseOutput;
use super::esdirk::{StepCounts, Stepper};
use super::event::{CutAt, EventFault, Faulty, SimulationEvent, check_place};
use super::moving_anchor::AnchorCourse;
use super::planned::CommandedLengths;
use super::rope::WoundLength;
use super::start::{LossOfMode, SimulationError, SimulationSettings, at_rest};
use super::system::{BODY, MotionNumbers, RopeEnd};
use super::winding::Winding;
use crate::math::{Rotation, Vec3, Vec6};
use crate::robot::{Pose, Robot};
use crate::statics::Equilibrium;

mod picture;
mod state;
mod stepping;

pub use stepping::{
    AnchorAtEnd, LengthAtEnd, StepError, StepInputs, StepSignal, StepSignals, SteppedSimulation, WrenchInput,
};

const SLACK: f64 = SlackCable::TENSION;

/// Energy that the books of a step may not explain, over the energy that has moved so far, …
const MAX_DEFECT: f64 = 1e-4;
/// … over the weight times the tolerance, …
const MAX_DEFECT_OF_TOLERANCE: f64 = 1e-3;
/// … and over the energies themselves, whose rounding is all that is left at rest; the largest of the three counts.
/// Steps of smooth motion leave less. Ropes that go slack or taut within a step leave more, and so does a command that
/// a long step passes over.
const MAX_ROUNDING: f64 = 1e-12;
/// Maximum step that may leave more [s], a guard against steps that shrink to nothing.
const MAX_DEFECT_STEP: f64 = 1e-6;

/// One cable at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CableSample {
    /// Tension at the platform [N]: the size of the force between them.
    pub tension_platform: f64,
    /// Tension at the anchor [N].
    pub tension_anchor: f64,
    /// Unstrained length.
    pub length: WoundLength,
    /// True after the cable has been cut.
    pub is_cut: bool,
}

/// Robot at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct RobotSample {
    /// Time [s].
    pub time: f64,
    /// Pose of the platform.
    pub pose: Pose,
    /// Velocity of the platform's origin and angular velocity, world axes [m/s, rad/s].
    pub velocity_w: Vec6,
    /// Acceleration of the platform's origin and angular acceleration, world axes [m/s², rad/s²].
    pub acceleration_w: Vec6,
    /// The cables, in file order.
    pub cables: Vec<CableSample>,
    /// Energy and work since the start.
    pub energy: EnergyBooks,
}

/// Time for which a cable has been slack.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SlackCable {
    /// Time at which its tension at the platform first fell below half a newton [s].
    pub first: Option<f64>,
    /// Time for which it was below [s].
    pub duration: f64,
    /// Tension at the end of the last step [N].
    last: Option<f64>,
}

/// Simulation of a robot.
///
/// # Example
/// ```
/// use funicular::robot::Robot;
/// use funicular::simulation::{Simulation, SimulationEvent, SimulationSettings};
/// use funicular::statics::{self, StaticModel};
///
/// let mut robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
/// robot.platform.mass = 12.5; // kg
/// let rest = statics::solve(&robot, StaticModel::Catenary, None)?.equilibrium;
/// let release = SimulationEvent::Release { time: 0.0, mass: 1.95, point_p: None };
/// let mut simulation = Simulation::new(&robot, &rest, &[release], 0.05, &SimulationSettings::default())?;
/// let sample = simulation.at(0.05)?;
/// assert!(sample.pose.position_w.z > rest.pose.position_w.z); // the lighter platform goes up
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Simulation {
    stepper: Stepper,
    settings: SimulationSettings,
    names: Vec<String>,
    losses: Vec<LossOfMode>,
    /// Sudden events that are to come, by time: index and event.
    sudden: Vec<(usize, SimulationEvent)>,
    /// Cables that fail at a tension.
    fuses: Vec<Fuse>,
    /// Cables that failed, with the time [s].
    cuts: Vec<(usize, f64)>,
    /// Times at which steps end, rising.
    breaks: Vec<f64>,
    books: EnergyBooks,
    /// Powers at the present time.
    powers: Powers,
    last: Option<(DenseOutput, StepPowers, EnergyBooks)>,
    slack: Vec<SlackCable>,
    work: MotionNumbers,
    needed: Vec<f64>,
}

impl Simulation {
    /// Simulation that begins at `rest`, for `duration` [s].
    ///
    /// # Errors
    /// [`SimulationError`]: a part of the robot that is not simulated, an event that cannot happen, or a start without
    /// a stable equilibrium of the mesh.
    pub fn new(
        robot: &Robot,
        rest: &Equilibrium,
        events: &[SimulationEvent],
        duration: f64,
        settings: &SimulationSettings,
    ) -> Result<Self, SimulationError> {
        let holds_tension = |i: usize| events.iter().any(|event| event.tension_of(i).is_some());
        Self::begun(robot, rest, events, (duration, duration), settings, &holds_tension)
    }

    /// Simulation whose gusts and events have their own durations; some winches may hold tensions.
    fn begun(
        robot: &Robot,
        rest: &Equilibrium,
        events: &[SimulationEvent],
        (gusts, duration): (f64, f64),
        settings: &SimulationSettings,
        holds_tension: &dyn Fn(usize) -> bool,
    ) -> Result<Self, SimulationError> {
        let CommandedLengths { windings, anchors, order } = CommandedLengths::new(robot, rest, events, duration)?;
        let mut breaks: Vec<f64> = windings.iter().flat_map(Winding::breaks).collect();
        breaks.extend(anchors.iter().flatten().flat_map(AnchorCourse::breaks));
        let parting = parting(robot, events);
        let (mut stepper, losses) = at_rest(robot, rest, settings, (windings, holds_tension), &parting, gusts)?;

        stepper.system.anchors[..anchors.len()].clone_from_slice(&anchors);

        let (count, size) = (robot.cables.len(), stepper.system.size);
        let mut simulation = Self {
            stepper,
            settings: settings.clone(),
            names: robot.cables.iter().map(|cable| cable.name.clone()).collect(),
            losses,
            sudden: Vec::new(),
            fuses: Vec::new(),
            cuts: Vec::new(),
            breaks: Vec::new(),
            books: EnergyBooks::default(),
            powers: Powers::default(),
            last: None,
            slack: vec![SlackCable::default(); count],
            work: MotionNumbers::zeros(size),
            needed: vec![0.0; size],
        };
        for event in order.iter().map(|k| &events[*k]) {
            breaks.extend(event.time());
            if let SimulationEvent::Tension { time, duration, .. } = event {
                breaks.push(time + duration);
            }
            if let Some(push) = event.push() {
                breaks.extend([push.from + push.rise, push.until - push.rise, push.until]);
                simulation.stepper.system.body.pushes.push(push);
            }
        }
        breaks.push(duration);
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        simulation.breaks = breaks;
        simulation.sudden =
            order.into_iter().filter(|k| events[*k].is_sudden()).map(|k| (k, events[k].clone())).collect();
        simulation.set_fuses(events)?;
        simulation.check_cuts().map_err(of_event)?;

        simulation.begin()?;
        simulation.books.at_start = simulation.books.total();
        Ok(simulation)
    }

    /// Cables that fail at a tension.
    fn set_fuses(&mut self, events: &[SimulationEvent]) -> Result<(), SimulationError> {
        for (event, of) in events.iter().enumerate() {
            if let SimulationEvent::Cut { cable, at: CutAt::Tension(limit), place } = *of {
                let lengths = self.stepper.system.lengths(0.0);
                let now = (0.0, &self.stepper.now, &self.stepper.needed[..]);
                let tension = self.tensions(cable, now, &lengths).into_iter().fold(0.0, f64::max);
                if tension >= limit {
                    let fault = EventFault::CutAtStart { cable: self.names[cable].clone(), tension };
                    return Err(SimulationError::Event { event, fault });
                }
                self.fuses.push(Fuse { event, cable, tension: limit, place });
            }
        }
        Ok(())
    }

    /// Refuses cuts of the last cable and second cuts, as far as their times are known.
    fn check_cuts(&self) -> Result<(), Faulty> {
        let mut cut = vec![false; self.names.len()];
        for (event, of) in &self.sudden {
            let SimulationEvent::Cut { cable, .. } = of else { continue };
            let name = || self.names[*cable].clone();
            if std::mem::replace(&mut cut[*cable], true) {
                return Err(Faulty { event: *event, fault: EventFault::CutTwice { cable: name() } });
            }
            if cut.iter().all(|is_cut| *is_cut) {
                return Err(Faulty { event: *event, fault: EventFault::LastCable { cable: name() } });
            }
        }
        Ok(())
    }

    /// Accelerations and energies at the present time, after the start or an event.
    fn begin(&mut self) -> Result<(), SimulationError> {
        self.stepper.restart().map_err(|of| self.too_fast(of.time))?;
        self.last = None;
        self.take_energy();
        Ok(())
    }

    /// Energies and powers at the present time.
    fn take_energy(&mut self) {
        let stepper = &self.stepper;
        let lengths = stepper.system.lengths(stepper.time);
        let (energy, powers) = stepper.system.energy(stepper.time, &lengths, &stepper.now, &stepper.needed);
        self.books = with_energy(&self.books, &energy);
        self.powers = powers;
    }

    fn too_fast(&self, time: f64) -> SimulationError {
        SimulationError::TooFast { time, tolerance: self.settings.tolerance }
    }

    /// Robot at a time [s], not before the last one that was asked for by more than a step.
    ///
    /// # Errors
    /// [`SimulationError::TooFast`]; [`SimulationError::Event`] for an event that turns out to be impossible.
    pub fn at(&mut self, time: f64) -> Result<RobotSample, SimulationError> {
        loop {
            let is_due = self.sudden.first().is_some_and(|(_, event)| event.time() <= Some(self.stepper.time));
            let now = self.stepper.time;
            if time < now || (time <= now && !is_due) {
                return Ok(self.sample(time));
            }
            if is_due {
                self.happen()?;
            } else {
                self.advance(f64::INFINITY)?;
            }
        }
    }

    /// Lets the next sudden event happen.
    fn happen(&mut self) -> Result<(), SimulationError> {
        let (event, of) = self.sudden.remove(0);
        let before = self.books.total();
        match of {
            SimulationEvent::Release { mass, point_p, .. } => {
                self.stepper.release(mass, point_p).map_err(|fault| SimulationError::Event { event, fault })?;
            }
            SimulationEvent::Pick { mass, point_p, velocity_w, .. } => self.stepper.pick(mass, point_p, velocity_w),
            SimulationEvent::Cut { cable, place, .. } => {
                self.cut(event, cable, place)?;
                return self.begin_after_cut(before);
            }
            SimulationEvent::Tension { time, duration, ref tensions } => {
                self.stepper.hold_tensions(time, duration, tensions);
                self.begin()?;
                // Rope behind the exit point is no longer counted.
                self.books.winches += self.books.total() - before;
                return Ok(());
            }
            _ => {}
        }
        self.begin()?;
        self.books.payloads += self.books.total() - before;
        Ok(())
    }

    fn cut(&mut self, event: usize, cable: usize, place: f64) -> Result<(), SimulationError> {
        let ends = &self.stepper.system.ends[..self.names.len()];
        if ends[cable] != RopeEnd::Attached {
            // It failed by its tension before.
            return Ok(());
        }
        if ends.iter().filter(|end| **end == RopeEnd::Attached).count() == 1 {
            let fault = EventFault::LastCable { cable: self.names[cable].clone() };
            return Err(SimulationError::Event { event, fault });
        }
        match self.stepper.system.half_of(cable).filter(|_| place > 0.0) {
            None => self.stepper.cut(cable),
            Some(half) => {
                let lengths = self.stepper.system.lengths(self.stepper.time);
                let free = self.stepper.system.free_length(cable, &lengths[cable], &self.stepper.now).value;
                check_place(&self.names[cable], place, free)
                    .map_err(|fault| SimulationError::Event { event, fault })?;
                self.stepper.part(cable, half, place);
            }
        }
        self.cuts.push((cable, self.stepper.time));
        Ok(())
    }

    /// Goes on after a failure. A rope without mass takes its energy along; `before` is the energy with it. What the
    /// meshes of two halves have less or more than that of the whole rope is an error of the mesh.
    fn begin_after_cut(&mut self, before: f64) -> Result<(), SimulationError> {
        let is_gone = self.cuts.last().is_some_and(|(cable, _)| self.stepper.system.ends[*cable] == RopeEnd::Gone);
        self.begin()?;
        if is_gone {
            self.books.payloads += self.books.total() - before;
        }
        Ok(())
    }

    /// One step, at most to a time [s].
    fn advance(&mut self, latest: f64) -> Result<(), SimulationError> {
        let now = self.stepper.time;
        let next = self.breaks.partition_point(|at| *at <= now);
        let until = self.breaks.get(next).copied().unwrap_or(now + 1.0).min(latest);
        let dense = self.stepper.advance(until).map_err(|of| self.too_fast(of.time))?;
        if let Some((Fuse { event, cable, place, .. }, time)) = self.blown(&dense) {
            // Back to the time at which the cable fails.
            self.stepper.go_back(&dense, time);
            self.book(dense, time);
            self.follow();
            let before = self.books.total();
            self.cut(event, cable, place)?;
            self.fuses.retain(|fuse| fuse.event != event);
            return self.begin_after_cut(before);
        }
        let (until, books, powers) = (dense.until, self.books, self.powers);
        self.book(dense, until);
        if self.is_too_long(&books) {
            if let Some((dense, ..)) = self.last.take() {
                self.stepper.take_back(&dense);
            }
            (self.books, self.powers) = (books, powers);
            return Ok(());
        }
        self.follow();
        Ok(())
    }

    /// True if the last step left an error of the energy that a shorter one would not leave. `before` are the books at
    /// its beginning.
    fn is_too_long(&self, before: &EnergyBooks) -> bool {
        let Some((dense, ..)) = self.last.as_ref() else { return false };
        let body = &self.stepper.system.body;
        let least = MAX_DEFECT_OF_TOLERANCE * self.settings.tolerance * body.mass * body.gravity_w.norm();
        let rounding = MAX_ROUNDING * (self.books.strain + self.books.potential.abs());
        let enough = (MAX_DEFECT * self.books.moved()).max(least).max(rounding);
        let defect = (self.books.defect() - before.defect()).abs();
        dense.until - dense.from > MAX_DEFECT_STEP && defect > enough
    }

    /// Follows what depends on whole steps: wheels that roll, and cables that are slack.
    fn follow(&mut self) {
        let Some(from) = self.last.as_ref().map(|(dense, ..)| dense.from) else { return };
        let lengths = self.stepper.system.lengths(self.stepper.time);
        self.stepper.follow_tangents(&lengths, self.stepper.time - from);
        self.note_slack(from, &lengths);
    }

    /// Powers within a step.
    fn powers_at(&mut self, dense: &DenseOutput, time: f64) -> Powers {
        let system = &mut self.stepper.system;
        let rotation = std::mem::replace(&mut system.rotation, dense.rotation);
        let lengths = system.within(dense, time, &mut self.work, &mut self.needed);
        let powers = system.energy(time, &lengths, &self.work, &self.needed).1;
        system.rotation = rotation;
        powers
    }

    /// Enters a step into the books, up to a time at which the stepper is.
    fn book(&mut self, dense: DenseOutput, until: f64) {
        let before = self.books;
        let first = self.powers;
        let halfway = self.powers_at(&dense, 0.5 * (dense.from + until));
        // Where a push begins or ends, the step knows the power before it, the next one that after it.
        let at_jump = self.stepper.system.jumps_at(until).then(|| self.powers_at(&dense, until.next_down()));
        self.take_energy();
        let last = at_jump.unwrap_or(self.powers);
        let powers = StepPowers { at: [first, halfway, last], duration: until - dense.from };
        self.books = with_work(&self.books, powers.work(1.0));
        self.last = Some((dense, powers, before));
    }

    fn note_slack(&mut self, from: f64, lengths: &[WoundLength]) {
        let until = self.stepper.time;
        for i in 0..self.slack.len() {
            if self.stepper.system.ends[i] != RopeEnd::Attached {
                continue;
            }
            let [tension, _] = self.tensions(i, (until, &self.stepper.now, &self.stepper.needed), lengths);
            let slack = &mut self.slack[i];
            let before = slack.last.replace(tension).unwrap_or(tension);
            // The tension counts as straight over the step.
            let share = match (before < SLACK, tension < SLACK) {
                (false, false) => 0.0,
                (true, true) => 1.0,
                (false, true) => (SLACK - tension) / (before - tension),
                (true, false) => (SLACK - before) / (tension - before),
            };
            slack.duration += share * (until - from);
            if slack.first.is_none() && share > 0.0 {
                slack.first = Some(if before < SLACK { from } else { until - share * (until - from) });
            }
        }
    }

    /// A cable that reached its tension within a step, and the time.
    fn blown(&mut self, dense: &DenseOutput) -> Option<(Fuse, f64)> {
        let lengths = self.stepper.system.lengths(self.stepper.time);
        let over = |of: &Self, cable: usize, at: (f64, &MotionNumbers, &[f64]), lengths: &[WoundLength]| {
            of.tensions(cable, at, lengths).into_iter().fold(0.0, f64::max)
        };
        let now = (self.stepper.time, &self.stepper.now, &self.stepper.needed[..]);
        let reached = |fuse: &&Fuse| {
            let holds = self.stepper.system.ends[fuse.cable] == RopeEnd::Attached;
            holds && over(self, fuse.cable, now, &lengths) >= fuse.tension
        };
        let fuse = *self.fuses.iter().find(reached)?;
        let (mut below, mut above) = (dense.from, dense.until);
        let mut needed = std::mem::take(&mut self.needed);
        for _ in 0..40 {
            let middle = 0.5 * (below + above);
            let lengths = self.stepper.system.within(dense, middle, &mut self.work, &mut needed);
            if over(self, fuse.cable, (middle, &self.work, &needed), &lengths) >= fuse.tension {
                above = middle;
            } else {
                below = middle;
            }
        }
        self.needed = needed;
        Some((fuse, above))
    }

    /// Tensions of a cable at the platform and at its anchor [N].
    fn tensions(
        &self,
        i: usize,
        (time, m, needed): (f64, &MotionNumbers, &[f64]),
        lengths: &[WoundLength],
    ) -> [f64; 2] {
        let system = &self.stepper.system;
        let range = system.of_rope(i);
        let at = |from: usize| Vec3::from_column_slice(&needed[from..from + 3]);
        if system.ends[i] == RopeEnd::Gone {
            return [0.0; 2];
        }
        // After a failure at a place, the half at the platform hangs on it.
        let at_platform = [Some(i), system.half_of(i)].into_iter().flatten();
        let attached = at_platform.filter(|rope| system.ends[*rope] == RopeEnd::Attached);
        let platform = attached.map(|rope| at(system.of_rope(rope).start).norm()).fold(0.0, |sum, of| sum + of);
        let anchor = if let Some(forces) = system.far_forces(i, time, &lengths[i], m, needed) {
            forces.exit_w.norm()
        } else {
            // The momentum of rope that passes is its own along the rope, and that of the anchor's motion.
            let with_w = m.point(range.end - 3)[1] * (system.ropes[i].mass * lengths[i].rate);
            system.ropes[i].anchor_tension(&lengths[i], &m.x[range.clone()], &(at(range.end - 3) - with_w))
        };
        [platform, anchor]
    }

    /// Robot at a time of the last step, or now.
    fn sample(&mut self, time: f64) -> RobotSample {
        let Some((dense, powers, before)) = self.last.take().filter(|_| time < self.stepper.time) else {
            let (now, needed) = (self.stepper.now.clone(), self.stepper.needed.clone());
            let lengths = self.stepper.system.lengths(time);
            return self.of_motion(time, self.stepper.system.rotation, &now, &lengths, &needed, self.books);
        };
        let (mut motion, mut needed) = (std::mem::take(&mut self.work), std::mem::take(&mut self.needed));
        let lengths = self.stepper.system.within(&dense, time, &mut motion, &mut needed);
        let rotation = std::mem::replace(&mut self.stepper.system.rotation, dense.rotation);
        let energy = self.stepper.system.energy(time, &lengths, &motion, &needed).0;
        let part = (time - dense.from) / powers.duration;
        let books = with_work(&with_energy(&before, &energy), powers.work(part));
        let at = self.stepper.system.rotation_at(&Vec3::from_column_slice(&motion.x[3..BODY]));
        self.stepper.system.rotation = rotation;
        let sample = self.of_motion(time, at, &motion, &lengths, &needed, books);
        (self.work, self.needed, self.last) = (motion, needed, Some((dense, powers, before)));
        sample
    }

    fn of_motion(
        &self,
        time: f64,
        rot_wp: Rotation,
        m: &MotionNumbers,
        lengths: &[WoundLength],
        needed: &[f64],
        energy: EnergyBooks,
    ) -> RobotSample {
        let body = &self.stepper.system.body;
        let three = |of: &[f64], from: usize| Vec3::from_column_slice(&of[from..from + 3]);
        let origin = -body.center_p;
        let motion = super::body::BodyMotion {
            center_w: three(&m.x, 0),
            rot_wp: rot_wp.to_rotation_matrix().into_inner(),
            velocity: super::system::six(&m.v),
            acceleration: super::system::six(&m.a),
        };
        let [_, velocity, acceleration] = motion.point(&origin);
        let joined = super::body::joined;
        let cable = |i: usize| {
            let [tension_platform, tension_anchor] = self.tensions(i, (time, m, needed), lengths);
            let is_cut = self.stepper.system.ends[i] != RopeEnd::Attached;
            let length = self.stepper.system.whole_length(i, &lengths[i], m);
            CableSample { tension_platform, tension_anchor, length, is_cut }
        };
        RobotSample {
            time,
            pose: body.pose(&motion.center_w, &rot_wp),
            velocity_w: joined(&velocity, &(rot_wp * three(&m.v, 3))),
            acceleration_w: joined(&acceleration, &(rot_wp * three(&m.a, 3))),
            cables: (0..self.names.len()).map(cable).collect(),
            energy,
        }
    }

    /// Time for which each cable has been slack.
    pub fn slack(&self) -> &[SlackCable] {
        &self.slack
    }

    /// Cables that failed so far: index and time [s].
    pub fn cuts(&self) -> &[(usize, f64)] {
        &self.cuts
    }

    /// Loss of the stretch in each mode of the platform at the start, lowest frequency first; empty if no rope has a
    /// loss factor.
    pub fn losses(&self) -> &[LossOfMode] {
        &self.losses
    }

    /// Steps so far.
    pub fn counts(&self) -> StepCounts {
        self.stepper.counts
    }
}

/// Cable that fails at a tension.
#[derive(Debug, Clone, Copy, Default)]
struct Fuse {
    /// Index of the event.
    event: usize,
    cable: usize,
    /// Tension at which it fails [N].
    tension: f64,
    /// Unstrained length from the platform to the place where it fails [m].
    place: f64,
}

/// Cables with mass that may fail at a place, each once.
fn parting(robot: &Robot, events: &[SimulationEvent]) -> Vec<usize> {
    let parts = |i: usize| {
        robot.cables[i].material.mass_per_length > 0.0
            && events
                .iter()
                .any(|event| matches!(event, SimulationEvent::Cut { cable, place, .. } if *cable == i && *place > 0.0))
    };
    (0..robot.cables.len()).filter(|i| parts(*i)).collect()
}

fn of_event(faulty: Faulty) -> SimulationError {
    SimulationError::Event { event: faulty.event, fault: faulty.fault }
}

/// Books with the present energy.
fn with_energy(books: &EnergyBooks, energy: &EnergyBooks) -> EnergyBooks {
    EnergyBooks { kinetic: energy.kinetic, strain: energy.strain, potential: energy.potential, ..*books }
}

/// Books with more work.
fn with_work(books: &EnergyBooks, [winches, anchors, loads, dissipated]: [f64; 4]) -> EnergyBooks {
    EnergyBooks {
        winches: books.winches + winches,
        anchors: books.anchors + anchors,
        loads: books.loads + loads,
        dissipated: books.dissipated + dissipated,
        ..*books
    }
}
