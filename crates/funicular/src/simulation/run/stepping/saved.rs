//! State of a simulation in intervals: all numbers that its future depends on, and its bytes.

use super::{SlackCable, StepError, SteppedSimulation};
use crate::math::Vec3;
use crate::robot::Robot;
use crate::simulation::body::{HeldWrench, Push};
use crate::simulation::moving_anchor::AnchorCourse;
use crate::simulation::run::Fuse;
use crate::simulation::start::SimulationSettings;
use crate::simulation::state::{EachNumber, count, optional};
use crate::statics::Equilibrium;

/// First bytes of a state; the last one is the version of the list of numbers.
const MARK: [u8; 8] = *b"funicul\x02";
/// Number of bytes of a number.
const WORD: usize = 8;
/// Words before the numbers: mark, robot, count.
const HEAD: usize = 3;

/// Hash by Fowler, Noll and Vo (FNV-1a, 64 bits).
fn hash(bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// Number that tells simulations apart by robot, start and settings.
pub(super) fn fingerprint(
    robot: &Robot,
    rest: &Equilibrium,
    tension_control: &[usize],
    settings: &SimulationSettings,
) -> u64 {
    hash(format!("{robot:?}{rest:?}{tension_control:?}{settings:?}").bytes())
}

/// Gives the numbers of a vector away.
fn vector(of: &mut Vec3, each: EachNumber) {
    of.iter_mut().for_each(each);
}

/// Gives the length of a list away and brings the list to it.
fn resized<T: Clone>(of: &mut Vec<T>, value: T, each: EachNumber) {
    let mut size = of.len();
    count(&mut size, each);
    of.resize(size, value);
}

impl SteppedSimulation {
    /// State as bytes, with which a simulation of the same robot, start and settings goes on exactly as this one does
    /// from here. Nothing changes in this one.
    pub fn save(&mut self) -> Vec<u8> {
        let mut numbers = Vec::new();
        self.numbers(&mut numbers);
        let head = [u64::from_le_bytes(MARK), self.fingerprint, numbers.len() as u64];
        let words = head.into_iter().chain(numbers.iter().map(|number| number.to_bits()));
        let mut bytes: Vec<u8> = words.flat_map(u64::to_le_bytes).collect();
        let checksum = hash(bytes.iter().copied());
        bytes.extend(checksum.to_le_bytes());
        bytes
    }

    /// Takes over a state that [`save`](Self::save) returned.
    ///
    /// # Errors
    /// [`StepError::NotSaved`], [`StepError::Damaged`], [`StepError::OtherRobot`]; the simulation is then as it was.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), StepError> {
        let (words, rest) = bytes.as_chunks::<WORD>();
        if words.first() != Some(&MARK) {
            return Err(StepError::NotSaved);
        }
        let words: Vec<u64> = words.iter().map(|word| u64::from_le_bytes(*word)).collect();
        let is_whole = rest.is_empty() && words.len() > HEAD && words[2] == (words.len() - HEAD - 1) as u64;
        if !is_whole || words[words.len() - 1] != hash(bytes[..bytes.len() - WORD].iter().copied()) {
            return Err(StepError::Damaged);
        }
        if words[1] != self.fingerprint {
            return Err(StepError::OtherRobot);
        }
        let numbers: Vec<f64> = words[HEAD..words.len() - 1].iter().map(|word| f64::from_bits(*word)).collect();
        self.or_as_before(|simulation| if simulation.take_numbers(&numbers) { Ok(()) } else { Err(StepError::Damaged) })
    }

    /// Writes all numbers to a list.
    pub(super) fn numbers(&mut self, numbers: &mut Vec<f64>) {
        numbers.clear();
        self.each_number(&mut |number| numbers.push(*number));
    }

    /// Takes all numbers from a list; `false` if they are too few or too many.
    pub(super) fn take_numbers(&mut self, numbers: &[f64]) -> bool {
        let mut rest = numbers.iter();
        let mut is_complete = true;
        self.each_number(&mut |number| match rest.next() {
            Some(given) => *number = *given,
            None => is_complete = false,
        });
        let is_right = is_complete && rest.next().is_none();
        is_right && self.run.stepper.factor_again()
    }

    fn each_number(&mut self, each: EachNumber) {
        each(&mut self.time);
        // Lists whose parts follow from numbers of the run.
        for SlackCable { first, duration, last } in &mut self.slack_before {
            optional(first, each);
            each(duration);
            optional(last, each);
        }
        for far in self.run.stepper.system.far_ends.iter_mut().flatten() {
            each(&mut far.off_tangent_before);
        }
        self.run.with_factor(each);
        resized(&mut self.run.breaks, 0.0, each);
        self.run.breaks.iter_mut().for_each(&mut *each);
        resized(&mut self.run.fuses, Fuse::default(), each);
        for Fuse { event, cable, tension, place } in &mut self.run.fuses {
            count(event, each);
            count(cable, each);
            [tension, place].into_iter().for_each(&mut *each);
        }

        let system = &mut self.run.stepper.system;
        system.windings.iter_mut().for_each(|winding| winding.each_number(each));
        for (course, cable) in system.anchors.iter_mut().zip(&self.robot.cables) {
            AnchorCourse::each_number(course, cable.anchor.point_w, each);
        }
        vector(system.air.mean_w(), each);
        let none = Vec3::zeros();
        let push = Push { from: 0.0, until: 0.0, rise: 0.0, force_w: none, moment_w: none, point_p: none };
        resized(&mut system.body.pushes, push, each);
        for Push { from, until, rise, force_w, moment_w, point_p } in &mut system.body.pushes {
            [from, until, rise].into_iter().for_each(&mut *each);
            for of in [force_w, moment_w, point_p] {
                vector(of, each);
            }
        }
        let mut is_held = usize::from(system.body.held.is_some());
        count(&mut is_held, each);
        let mut held = system.body.held.unwrap_or_default();
        let HeldWrench { from, force_w, moment_w, force_rate_w, moment_rate_w } = &mut held;
        each(from);
        for of in [force_w, moment_w, force_rate_w, moment_rate_w] {
            vector(of, each);
        }
        system.body.held = (is_held > 0).then_some(held);
    }
}
