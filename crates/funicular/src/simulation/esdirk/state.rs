//! Numbers of a stepper that its next steps depend on.

use super::Stepper;
use crate::simulation::state::{EachNumber, count, rotation};
use crate::simulation::system::MotionNumbers;

impl MotionNumbers {
    /// Gives every number away, to be read or replaced.
    pub(in crate::simulation) fn each_number(&mut self, each: EachNumber) {
        [&mut self.x, &mut self.v, &mut self.a].into_iter().flatten().for_each(each);
    }
}

impl Stepper {
    /// Gives every number away, to be read or replaced. The factored matrix is none of them: the next step makes a new
    /// one.
    pub(in crate::simulation) fn each_number(&mut self, each: EachNumber) {
        self.factored = None;
        for number in [&mut self.time, &mut self.step, &mut self.error_before, &mut self.contraction] {
            each(number);
        }
        self.now.each_number(each);
        self.needed.iter_mut().for_each(&mut *each);
        let counts = &mut self.counts;
        for number in [&mut counts.accepted, &mut counts.rejected, &mut counts.factored, &mut counts.evaluations] {
            count(number, each);
        }
        self.system.each_number(each);
        rotation(&mut self.system.rotation, each);
    }
}
