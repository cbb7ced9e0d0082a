//! Events that happen at the present time.

use super::{StepError, SteppedSimulation};
use crate::simulation::event::{CutAt, EventFault, SimulationEvent};
use crate::simulation::run::Fuse;
use crate::simulation::winding::braking;

impl SteppedSimulation {
    /// Lets an event happen now: a release, a pick-up, a push, a cut at once or at a tension, a stop, a ramp of lengths
    /// or tensions. Its time has to be the present one.
    ///
    /// # Errors
    /// [`StepError`]; the simulation is then as it was.
    pub fn happen(&mut self, event: &SimulationEvent) -> Result<(), StepError> {
        let now = self.time;
        if let Some(time) = event.time().filter(|time| (time - now).abs() > 0.0) {
            return Err(StepError::NotNow { event: time, now });
        }
        event.check(&self.robot, f64::INFINITY).map_err(StepError::Event)?;
        self.check_cables(event)?;
        self.or_as_before(|simulation| {
            simulation.go_back()?;
            simulation.run.breaks.retain(|at| *at > now);
            simulation.let_happen(event)
        })
    }

    /// Refuses cables that do not exist, and what their winches cannot do.
    fn check_cables(&self, event: &SimulationEvent) -> Result<(), StepError> {
        let cables = self.robot.cables.len();
        let count = |key: &'static str, given: usize| {
            if given == cables { Ok(()) } else { Err(StepError::Count { key, given, cables }) }
        };
        let exists = |cable: usize| if cable < cables { Ok(()) } else { Err(StepError::NoCable { cable, cables }) };
        let name = |cable: usize| self.robot.cables[cable].name.clone();
        let far_ends = &self.run.stepper.system.far_ends;
        let can_hold = |cable: usize| far_ends[cable].as_ref().is_some_and(|far| far.feed.is_some());
        match event {
            SimulationEvent::Follow { .. } | SimulationEvent::Anchors { .. } => Err(StepError::Table),
            // The second half of a rope has a mesh of its own, which is made at the start.
            SimulationEvent::Cut { place, .. } if *place > 0.0 => Err(StepError::Place { place: *place }),
            SimulationEvent::Cut { cable, .. } => exists(*cable),
            SimulationEvent::Stop { cables, .. } => cables.iter().try_for_each(|cable| exists(*cable)),
            SimulationEvent::Ramp { changes, .. } => {
                count("changes", changes.len())?;
                let held = (0..cables).find(|cable| changes[*cable] != 0.0 && self.holds_tension(*cable));
                held.map_or(Ok(()), |cable| Err(StepError::HoldsTension { cable: name(cable) }))
            }
            SimulationEvent::Tension { tensions, .. } => {
                count("tensions_n", tensions.len())?;
                let other = (0..cables).find(|cable| tensions[*cable].is_some() && !can_hold(*cable));
                other.map_or(Ok(()), |cable| Err(StepError::NoTensionControl { cable: name(cable) }))
            }
            _ => Ok(()),
        }
    }

    fn let_happen(&mut self, event: &SimulationEvent) -> Result<(), StepError> {
        let now = self.time;
        match event {
            SimulationEvent::Cut { cable, .. } if !self.is_attached(*cable) => {
                Err(StepError::Event(EventFault::CutTwice { cable: self.robot.cables[*cable].name.clone() }))
            }
            SimulationEvent::Cut { cable, at: CutAt::Tension(limit), .. } => self.add_fuse(*cable, *limit),
            SimulationEvent::Push { .. } => {
                let Some(push) = event.push() else { return Ok(()) };
                self.break_at(&[push.from + push.rise, push.until - push.rise, push.until]);
                self.run.stepper.system.body.pushes.push(push);
                if push.rise == 0.0 { self.jump() } else { Ok(()) }
            }
            SimulationEvent::Stop { duration, cables, .. } => {
                let until = now + duration;
                for cable in cables {
                    let winding = &mut self.run.stepper.system.windings[*cable];
                    let from = winding.at(now);
                    winding.command(now, until, braking(&from, *duration));
                }
                self.break_at(&[until]);
                Ok(())
            }
            SimulationEvent::Ramp { duration, changes, .. } => self.ramp(*duration, changes),
            _ => {
                if let SimulationEvent::Tension { duration, .. } = event {
                    self.break_at(&[now + duration]);
                }
                self.run.sudden.push((0, event.clone()));
                self.run.happen()?;
                // A cable that is cut does not fail again.
                let ends = &self.run.stepper.system.ends;
                self.run.fuses.retain(|fuse| ends[fuse.cable] == crate::simulation::system::RopeEnd::Attached);
                Ok(())
            }
        }
    }

    /// Winches at rest change their lengths by polynomials of the fifth degree.
    fn ramp(&mut self, duration: f64, changes: &[f64]) -> Result<(), StepError> {
        let (now, until) = (self.time, self.time + duration);
        for (cable, change) in changes.iter().enumerate().filter(|(_, change)| **change != 0.0) {
            let (name, winding) = (&self.robot.cables[cable].name, &mut self.run.stepper.system.windings[cable]);
            let from = winding.at(now);
            if winding.ends_at() > now || from.rate != 0.0 {
                let (cable, until) = (name.clone(), winding.ends_at().max(now));
                return Err(StepError::Event(EventFault::Overlap { cable, time: now, until }));
            }
            let (length, least) = (from.value + change, self.least[cable]);
            if length < least {
                return Err(StepError::TooShort { cable: name.clone(), length, least });
            }
            let part = |power: i32, factor: f64| factor * change / duration.powi(power);
            winding.command(now, until, [from.value, 0.0, 0.0, part(3, 10.0), part(4, -15.0), part(5, 6.0)]);
        }
        self.break_at(&[until]);
        Ok(())
    }

    fn add_fuse(&mut self, cable: usize, limit: f64) -> Result<(), StepError> {
        let of = self.now().cables[cable];
        let tension = of.tension_platform.max(of.tension_anchor);
        if tension >= limit || limit.is_nan() {
            let cable = self.robot.cables[cable].name.clone();
            return Err(StepError::Event(EventFault::CutAtStart { cable, tension }));
        }
        let next = self.run.fuses.iter().map(|fuse| fuse.event + 1).max().unwrap_or(0);
        self.run.fuses.push(Fuse { event: next, cable, tension: limit, place: 0.0 });
        Ok(())
    }

    /// Lets steps end at these times.
    fn break_at(&mut self, times: &[f64]) {
        let breaks = &mut self.run.breaks;
        breaks.extend(times.iter().filter(|time| **time > self.time));
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
    }
}
