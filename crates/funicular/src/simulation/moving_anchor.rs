//! Anchors that move: cranes, ships, drones, a base on wheels.
//!
//! An anchor has a course of its own for each axis, as a winch has one for its length. The exit point, the pulley and
//! the winch behind move along with it without a turn; they have no inertia in this motion.

use super::event::{EventFault, Faulty, JUMP, SimulationEvent};
use super::far_end::ExitMotion;
use super::winding::Winding;
use crate::math::Vec3;
use crate::robot::Robot;

/// Place of an anchor over time.
#[derive(Debug, Clone)]
pub(super) struct AnchorCourse {
    /// Place at the start.
    pub(super) home_w: Vec3,
    /// Displacement along each axis of the world.
    pub(super) axes: [Winding; 3],
}

impl AnchorCourse {
    /// Anchor that rests.
    pub(super) fn resting(home_w: Vec3) -> Self {
        Self { home_w, axes: [(); 3].map(|()| Winding::constant(0.0)) }
    }

    /// Displacement since the start at a time, with its velocity and acceleration.
    pub(super) fn moved(&self, time: f64) -> ExitMotion {
        let [x, y, z] = [0, 1, 2].map(|axis| self.axes[axis].at(time));
        [
            Vec3::new(x.value, y.value, z.value),
            Vec3::new(x.rate, y.rate, z.rate),
            Vec3::new(x.acceleration, y.acceleration, z.acceleration),
        ]
    }

    /// Place at a time, with its velocity and acceleration.
    pub(super) fn at(&self, time: f64) -> ExitMotion {
        let [moved_w, velocity_w, acceleration_w] = self.moved(time);
        [self.home_w + moved_w, velocity_w, acceleration_w]
    }

    /// Times at which a motion begins or ends [s].
    pub(super) fn breaks(&self) -> impl Iterator<Item = f64> + '_ {
        self.axes.iter().flat_map(Winding::breaks)
    }

    /// Gives away whether there is a course, and the numbers of a commanded one.
    pub(super) fn each_number(of: &mut Option<Self>, home_w: Vec3, each: &mut dyn FnMut(&mut f64)) {
        let mut is_there = f64::from(u8::from(of.is_some()));
        each(&mut is_there);
        if is_there < 0.5 {
            *of = None;
            return;
        }
        let course = of.get_or_insert_with(|| Self::resting(home_w));
        for axis in &mut course.axes {
            axis.each_commanded_number(each);
        }
    }
}

/// Courses of all anchors, as a scenario commands them; none for an anchor that rests. `order` has the events by their
/// time.
pub(super) fn courses(
    robot: &Robot,
    events: &[SimulationEvent],
    order: &[usize],
) -> Result<Vec<Option<AnchorCourse>>, Faulty> {
    let mut courses: Vec<Option<AnchorCourse>> = vec![None; robot.cables.len()];
    for &event in order {
        let SimulationEvent::Anchors { time, times, places_w } = &events[event] else { continue };
        for (i, places_w) in places_w.iter().enumerate() {
            let Some(places_w) = places_w else { continue };
            let course = courses[i].get_or_insert_with(|| AnchorCourse::resting(robot.cables[i].anchor.point_w));
            follow(course, &robot.cables[i].name, (*time, times), places_w).map_err(|fault| Faulty { event, fault })?;
        }
    }
    Ok(courses)
}

/// Adds a table of places to a course.
fn follow(
    course: &mut AnchorCourse,
    cable: &str,
    (time, times): (f64, &[f64]),
    places_w: &[Vec3],
) -> Result<(), EventFault> {
    let [before_w, ..] = course.at(time);
    let way = places_w.windows(2).map(|pair| (pair[1] - pair[0]).norm()).fold(0.0, f64::max);
    let jump = (places_w[0] - before_w).norm();
    // A micrometre is rounding of a table.
    if jump > JUMP * way.max(0.1) {
        let (before, first) = (before_w.into(), places_w[0].into());
        return Err(EventFault::AnchorJump { cable: cable.to_owned(), before, first, time });
    }
    for (axis, winding) in course.axes.iter_mut().enumerate() {
        let values: Vec<f64> = places_w.iter().map(|place_w| place_w[axis]).collect();
        winding.follow(time, times, &values).map_err(|of| EventFault::AnchorOverlap {
            cable: cable.to_owned(),
            time,
            until: of.until,
        })?;
    }
    Ok(())
}
