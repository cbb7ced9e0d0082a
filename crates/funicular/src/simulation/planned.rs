//! Plan of a scenario before anything is simulated: lengths that winches are commanded to have, and the platform
//! after a release.

use super::body::MovingBody;
use super::event::{EventFault, Faulty, SimulationEvent, check_places, windings};
use super::moving_anchor::{AnchorCourse, courses};
use super::rope::WoundLength;
use super::start::SimulationError;
use super::winding::Winding;
use crate::math::Vec3;
use crate::robot::Robot;
use crate::statics::{CableState, Equilibrium};

/// Number of parts of a change whose course is no cubic: a cubic between them is off by less than 1e-7 of the change.
const PARTS: usize = 64;

/// Unstrained lengths of all cables over time, as a scenario commands them.
#[derive(Debug, Clone)]
pub struct CommandedLengths {
    pub(super) windings: Vec<Winding>,
    /// Courses of the anchors; none for those that rest.
    pub(super) anchors: Vec<Option<AnchorCourse>>,
    /// Events with a time, by their time.
    pub(super) order: Vec<usize>,
}

impl CommandedLengths {
    /// Lengths from `rest` on, for `duration` [s].
    ///
    /// # Errors
    /// [`SimulationError::Event`]: an event that cannot happen.
    pub fn new(
        robot: &Robot,
        rest: &Equilibrium,
        events: &[SimulationEvent],
        duration: f64,
    ) -> Result<Self, SimulationError> {
        for (event, of) in events.iter().enumerate() {
            of.check(robot, duration).map_err(|fault| SimulationError::Event { event, fault })?;
        }
        let mut order: Vec<usize> = (0..events.len()).filter(|k| events[*k].time().is_some()).collect();
        let time = |k: usize| events[k].time().unwrap_or_default();
        order.sort_by(|a, b| time(*a).total_cmp(&time(*b)));

        let initial: Vec<f64> = rest.cables.iter().map(|cable| cable.unstrained_length).collect();
        let free: Vec<f64> = rest.cables.iter().map(CableState::free_length).collect();
        let windings = windings(robot, (&initial, &free), events, &order)
            .and_then(|windings| check_places(robot, (&initial, &free), events, &windings).map(|()| windings))
            .map_err(|Faulty { event, fault }| SimulationError::Event { event, fault })?;
        let anchors = courses(robot, events, &order)
            .map_err(|Faulty { event, fault }| SimulationError::Event { event, fault })?;
        Ok(Self { windings, anchors, order })
    }

    /// Length of a cable with its rate and acceleration.
    pub fn at(&self, cable: usize, time: f64) -> WoundLength {
        self.windings[cable].at(time)
    }

    /// True if a cable's length changes after a time [s].
    pub fn moves_after(&self, cable: usize, time: f64) -> bool {
        let winding = &self.windings[cable];
        let now = winding.at(time).value;
        let later = winding.knots(PARTS).into_iter().filter(|knot| *knot > time);
        later.into_iter().any(|knot| (winding.at(knot).value - now).abs() > 0.0)
    }

    /// Times [s] between which every length is a cubic polynomial, rising; none if no length changes. The first is the
    /// beginning of the first change, the last the end of the last one.
    pub fn knots(&self) -> Vec<f64> {
        let mut knots: Vec<f64> = self.windings.iter().flat_map(|winding| winding.knots(PARTS)).collect();
        knots.sort_by(f64::total_cmp);
        // Rounding keeps times apart that are the same.
        knots.dedup_by(|later, earlier| *later - *earlier < 1e-9);
        knots
    }
}

/// Robot after its platform has let a payload go, at `point_p` or at the centre of mass.
///
/// # Errors
/// A payload that is not a part of the platform.
pub fn without_payload(robot: &Robot, mass: f64, point_p: Option<Vec3>) -> Result<Robot, EventFault> {
    let point_p = point_p.unwrap_or(robot.platform.center_of_mass_p);
    let left = MovingBody::of(robot, false).without(mass, &point_p)?;
    let mut after = robot.clone();
    after.platform.mass = left.mass;
    after.platform.inertia_p = left.inertia_p;
    after.platform.center_of_mass_p = left.center_p;
    Ok(after)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statics::{self, StaticModel};

    #[test]
    fn between_its_knots_every_length_is_a_cubic() {
        let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
        let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
        let start: Vec<f64> = rest.cables.iter().map(|cable| cable.unstrained_length).collect();
        let follow = |length: f64| Some(vec![length, length + 0.02, length + 0.01]);
        let events = [
            SimulationEvent::Ramp { time: 0.5, duration: 1.0, changes: vec![0.1, 0.0, 0.0, 0.0, 0.0, -0.1] },
            SimulationEvent::Stop { time: 1.0, duration: 0.2, cables: vec![5] },
            SimulationEvent::Follow {
                time: 2.0,
                times: vec![0.0, 0.3, 1.0],
                lengths: start
                    .iter()
                    .enumerate()
                    .map(|(i, length)| if i == 1 { follow(*length) } else { None })
                    .collect(),
            },
        ];
        let lengths = CommandedLengths::new(&robot, &rest, &events, 5.0).unwrap();
        let knots = lengths.knots();
        assert!((knots[0] - 0.5).abs() < 1e-12 && (knots[knots.len() - 1] - 3.0).abs() < 1e-12, "{knots:?}");
        for pair in knots.windows(2) {
            for i in 0..robot.cables.len() {
                let [a, b] = [pair[0], pair[1]].map(|time| lengths.at(i, time));
                let gap = pair[1] - pair[0];
                let middle = 0.5 * (a.value + b.value) + 0.125 * gap * (a.rate - b.rate);
                assert!((middle - lengths.at(i, pair[0] + 0.5 * gap).value).abs() < 1e-8, "{i} {pair:?}");
            }
        }
        assert!(CommandedLengths::new(&robot, &rest, &[], 1.0).unwrap().knots().is_empty());
    }

    #[test]
    fn a_released_payload_takes_its_mass_and_its_inertia_with_it() {
        let mut robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
        robot.platform.mass = 12.0;
        let after = without_payload(&robot, 2.0, Some(Vec3::new(0.0, 0.0, 0.1))).unwrap();
        assert!((after.platform.mass - 10.0).abs() < 1e-12);
        assert!((after.platform.center_of_mass_p - Vec3::new(0.0, 0.0, -0.02)).norm() < 1e-15);
        // 2 kg at 0.1 m above, seen from the common centre of mass: 2 · 12/10 · 0.1².
        assert!((robot.platform.inertia_p[(0, 0)] - after.platform.inertia_p[(0, 0)] - 0.024).abs() < 1e-12);
        assert!(without_payload(&robot, 12.0, None).is_err());
    }
}
