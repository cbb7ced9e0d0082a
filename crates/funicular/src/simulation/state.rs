//! State of a simulation as a list of numbers, for runs that are continued later.
//!
//! Each part gives its numbers away one after the other, by one function for reading and for replacing them, so that
//! both have the same order.

use super::body::MovingBody;
use super::far_end::FarEnd;
use super::feed::{Feed, WinchHold};
use super::system::{MovingSupport, RopeEnd, System};
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
        for far in self.far_ends.iter_mut().flatten() {
            far.each_number(each);
        }
        if !self.halves.is_empty() {
            for winding in &mut self.windings {
                each(&mut winding.initial);
                each(&mut winding.cut_off);
            }
            for MovingSupport { stiffness_w, mass, .. } in &mut self.supports {
                stiffness_w.iter_mut().for_each(&mut *each);
                each(mass);
            }
        }
        count(&mut self.evaluations, each);
    }
}

impl FarEnd {
    fn each_number(&mut self, each: EachNumber) {
        if let Some(contact) = &mut self.contact {
            each(&mut contact.wrap);
            contact.center_w.iter_mut().for_each(&mut *each);
            contact.sideways_w = contact.axis_w.cross(&contact.center_w);
        }
        each(&mut self.off_tangent);
        if let Some(feed) = &mut self.feed {
            feed.each_number(each);
        }
    }
}

impl Feed {
    fn each_number(&mut self, each: EachNumber) {
        let mut is_locked = usize::from(self.is_locked);
        count(&mut is_locked, each);
        self.is_locked = is_locked > 0;
        each(&mut self.bias);
        each(&mut self.behind);
        let mut of = match self.hold {
            WinchHold::Length => [f64::NAN; 4],
            WinchHold::Tension { from, duration, before, after } => [from, duration, before, after],
        };
        of.iter_mut().for_each(each);
        let [from, duration, before, after] = of;
        self.hold =
            if from.is_nan() { WinchHold::Length } else { WinchHold::Tension { from, duration, before, after } };
    }
}
