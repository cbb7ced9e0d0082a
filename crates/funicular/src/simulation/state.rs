//! State of a simulation as a list of numbers, for runs that are continued later.
//!
//! Each part gives its numbers away one after the other, by one function for reading and for replacing them, so that both
//! have the same order.

use super::body::MovingBody;
use super::system::{RopeEnd, System};
use crate::math::{Quaternion, Rotation};

/// Function that reads or replaces one number.
pub(super) type EachNumber<'a> = &'a mut dyn FnMut(&mut f64);

/// Gives a count away.
pub(super) fn count(of: &mut usize, each: EachNumber) {
    let mut number = *of as f64;
    each(&mut number);
    *of = number as usize;
}

/// Gives a rotation away.
pub(super) fn rotation(of: &mut Rotation, each: EachNumber) {
    let mut numbers = of.into_inner().coords;
    numbers.iter_mut().for_each(each);
    *of = Rotation::new_unchecked(Quaternion::from(numbers));
}

/// Gives a number away that may be missing.
pub(super) fn optional(of: &mut Option<f64>, each: EachNumber) {
    let mut number = of.unwrap_or(f64::NAN);
    each(&mut number);
    *of = Some(number).filter(|number| !number.is_nan());
}

impl System {
    pub(super) fn each_number(&mut self, each: EachNumber) {
        let MovingBody { mass, inertia_p, center_p, .. } = &mut self.body;
        each(mass);
        inertia_p.iter_mut().for_each(&mut *each);
        center_p.iter_mut().for_each(&mut *each);
        for end in &mut self.ends {
            let mut number =
                [RopeEnd::Attached, RopeEnd::Free, RopeEnd::Gone].iter().position(|of| of == end).unwrap_or(0);
            count(&mut number, each);
            *end = [RopeEnd::Attached, RopeEnd::Free, RopeEnd::Gone][number.min(2)];
        }
        count(&mut self.evaluations, each);
    }
}
