//! A simulation that is written down and continued later.

use super::{Simulation, SlackCable};
use crate::simulation::books::{EnergyBooks, Powers, StepPowers};
use crate::simulation::dense::DenseOutput;
use crate::simulation::state::{EachNumber, count, optional, rotation};
use crate::simulation::system::MotionNumbers;

impl Simulation {
    /// State as numbers, with which a new simulation of the same robot, events, duration and settings goes on exactly
    /// as this one does from here.
    ///
    /// # Example
    /// ```
    /// use funicular::robot::Robot;
    /// use funicular::simulation::{Simulation, SimulationEvent, SimulationSettings};
    /// use funicular::statics::{self, StaticModel};
    ///
    /// let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
    /// let rest = statics::solve(&robot, StaticModel::Catenary, None)?.equilibrium;
    /// let release = [SimulationEvent::Release { time: 0.01, mass: 1.0, point_p: None }];
    /// let new = || Simulation::new(&robot, &rest, &release, 0.1, &SimulationSettings::default());
    /// let (mut first, mut second) = (new()?, new()?);
    /// first.at(0.02)?;
    /// assert!(second.restore(&first.state()));
    /// assert_eq!(first.at(0.04)?, second.at(0.04)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn state(&mut self) -> Vec<f64> {
        let mut numbers = Vec::new();
        self.each_number(&mut |number| numbers.push(*number));
        numbers
    }

    /// Takes over a [`state`](Self::state); `false`, with a simulation that must not be used any more, if it belongs to
    /// another robot or other settings.
    pub fn restore(&mut self, numbers: &[f64]) -> bool {
        let mut rest = numbers.iter();
        let mut is_complete = true;
        self.each_number(&mut |number| match rest.next() {
            Some(given) => *number = *given,
            None => is_complete = false,
        });
        is_complete && rest.next().is_none()
    }

    /// Gives every number away, and the place of the factored matrix.
    pub(super) fn with_factor(&mut self, each: EachNumber) {
        let is_factored = self.stepper.is_factored();
        self.each_number(each);
        self.stepper.factor_numbers(is_factored, each);
    }

    fn each_number(&mut self, each: EachNumber) {
        self.stepper.each_number(each);
        // Events that have happened are gone; those to come are known from the start.
        let mut to_come = self.sudden.len();
        count(&mut to_come, each);
        self.sudden.drain(..self.sudden.len().saturating_sub(to_come));
        let mut cuts = self.cuts.len();
        count(&mut cuts, each);
        self.cuts.resize(cuts.min(self.names.len()), (0, 0.0));
        for (cable, time) in &mut self.cuts {
            count(cable, each);
            each(time);
        }
        self.fuses.retain(|fuse| self.cuts.iter().all(|(cable, _)| *cable != fuse.cable));
        for SlackCable { first, duration, last } in &mut self.slack {
            optional(first, each);
            each(duration);
            optional(last, each);
        }
        self.books.each_number(each);
        self.powers.each_number(each);
        self.last_step(each);
    }

    /// Last step, in which the next sample may lie.
    fn last_step(&mut self, each: EachNumber) {
        let mut is_there = usize::from(self.last.is_some());
        count(&mut is_there, each);
        if is_there == 0 {
            self.last = None;
            return;
        }
        let (dense, powers, books) = self.last.get_or_insert_with(|| {
            let motion = || MotionNumbers::zeros(self.stepper.system.size);
            let dense = DenseOutput::new(0.0, 0.0, self.stepper.system.rotation, motion(), motion());
            (dense, StepPowers::default(), EnergyBooks::default())
        });
        each(&mut dense.from);
        each(&mut dense.until);
        rotation(&mut dense.rotation, each);
        dense.motions().into_iter().for_each(|motion| motion.each_number(each));
        powers.at.iter_mut().for_each(|powers| powers.each_number(each));
        each(&mut powers.duration);
        books.each_number(each);
    }
}

impl Powers {
    fn each_number(&mut self, each: EachNumber) {
        let Self { winches, anchors, loads, dissipation } = self;
        [winches, anchors, loads, dissipation].into_iter().for_each(each);
    }
}

impl EnergyBooks {
    fn each_number(&mut self, each: EachNumber) {
        let Self { kinetic, strain, potential, winches, anchors, loads, dissipated, payloads, at_start } = self;
        [kinetic, strain, potential, winches, anchors, loads, dissipated, payloads, at_start]
            .into_iter()
            .for_each(each);
    }
}
