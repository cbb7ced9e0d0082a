//! Numbers of a stepper that its next steps depend on.

use super::{GAMMA, Stepper};
use crate::math::Rotation;
use crate::simulation::rope::{Newton, WoundLength};
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

/// Place at which a matrix was factored: what it depends on besides what does not change in between.
#[derive(Debug, Clone, Default)]
pub(super) struct FactorPlace {
    time: f64,
    step: f64,
    rotation: Rotation,
    lengths: Vec<WoundLength>,
    motion: MotionNumbers,
    needed: Vec<f64>,
}

impl FactorPlace {
    pub(super) fn new(size: usize, ropes: usize) -> Self {
        let length = WoundLength { value: 0.0, rate: 0.0, acceleration: 0.0 };
        let (motion, needed) = (MotionNumbers::zeros(size), vec![0.0; size]);
        Self { lengths: vec![length; ropes], motion, needed, ..Self::default() }
    }

    pub(super) fn set(
        &mut self,
        (time, step, rotation): (f64, f64, Rotation),
        lengths: &[WoundLength],
        motion: &MotionNumbers,
        needed: &[f64],
    ) {
        (self.time, self.step, self.rotation) = (time, step, rotation);
        self.lengths.copy_from_slice(lengths);
        self.motion.x.copy_from_slice(&motion.x);
        self.motion.v.copy_from_slice(&motion.v);
        self.motion.a.copy_from_slice(&motion.a);
        self.needed.copy_from_slice(needed);
    }

    fn each_number(&mut self, each: EachNumber) {
        each(&mut self.time);
        each(&mut self.step);
        rotation(&mut self.rotation, each);
        for WoundLength { value, rate, acceleration } in &mut self.lengths {
            [value, rate, acceleration].into_iter().for_each(&mut *each);
        }
        self.motion.each_number(each);
        self.needed.iter_mut().for_each(each);
    }
}

impl Stepper {
    /// True if the factored matrix is in use.
    pub(in crate::simulation) fn is_factored(&self) -> bool {
        self.factored.is_some()
    }

    /// Gives away whether the factored matrix is in use, and its place. The matrix itself is made anew by
    /// [`Self::factor_again`].
    pub(in crate::simulation) fn factor_numbers(&mut self, is_factored: bool, each: EachNumber) {
        let mut number = usize::from(is_factored);
        count(&mut number, each);
        self.factor_place.each_number(each);
        self.factored = (number > 0).then_some(self.factor_place.step);
    }

    /// Factors the matrix again where it was factored, after the numbers have been replaced; `false` if that fails.
    pub(in crate::simulation) fn factor_again(&mut self) -> bool {
        if self.factored.is_none() {
            return true;
        }
        let place = std::mem::take(&mut self.factor_place);
        let rotation = std::mem::replace(&mut self.system.rotation, place.rotation);
        let hg = place.step * GAMMA;
        let of = Newton { mass: 1.0 / hg, damping: 1.0, stiffness: hg };
        let factored =
            self.arrow.factor(&self.system, place.time, &place.lengths, &place.motion, &place.needed, of).is_ok();
        self.system.rotation = rotation;
        self.factor_place = place;
        factored
    }
}
