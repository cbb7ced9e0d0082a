//! Events of a simulation: releases, pick-ups, changes of length and tension, stops, pushes and cuts.

use super::body::Push;
use super::winding::Winding;
use crate::math::Vec3;
use crate::robot::{Cable, Control, Robot};
use thiserror::Error;

/// Event that changes a robot at a time or from it on.
#[derive(Debug, Clone, PartialEq)]
pub enum SimulationEvent {
    /// The platform lets a payload go, which takes its momentum with it.
    Release {
        /// Time [s].
        time: f64,
        /// Mass of the payload [kg], a part of the platform's mass.
        mass: f64,
        /// Place of the payload as a point mass, platform frame [m]; `None` for the centre of mass.
        point_p: Option<Vec3>,
    },
    /// The platform takes a payload up, a point mass that sticks to it.
    Pick {
        /// Time [s].
        time: f64,
        /// Mass of the payload [kg].
        mass: f64,
        /// Place of the mass, platform frame [m]; `None` for the centre of mass.
        point_p: Option<Vec3>,
        /// Velocity of the mass before, world axes [m/s]; `None` if it moves with the platform.
        velocity_w: Option<Vec3>,
    },
    /// Winches change the unstrained lengths, each by a polynomial of the fifth degree from rest to rest.
    Ramp {
        /// Beginning [s].
        time: f64,
        /// Duration [s].
        duration: f64,
        /// Change of the unstrained length of each cable [m]; zero leaves a winch at rest.
        changes: Vec<f64>,
    },
    /// Winches follow unstrained lengths at given times by a cubic spline, at rest at both ends.
    Follow {
        /// Beginning [s].
        time: f64,
        /// Times since the beginning, from zero on, rising [s].
        times: Vec<f64>,
        /// Unstrained lengths at these times [m] of each cable; none for a winch that stays at rest.
        lengths: Vec<Option<Vec<f64>>>,
    },
    /// Winches hold tensions from now on instead of lengths, by their torque.
    Tension {
        /// Beginning [s].
        time: f64,
        /// Time within which the tension goes from the present one to the given one [s].
        duration: f64,
        /// Tension at the drum of each cable [N]; none for a winch that goes on as before.
        tensions: Vec<Option<f64>>,
    },
    /// Brakes bring winches to rest, with a continuous acceleration.
    Stop {
        /// Beginning [s].
        time: f64,
        /// Duration [s].
        duration: f64,
        /// Cables whose winches brake.
        cables: Vec<usize>,
    },
    /// Force and moment on the platform for a while.
    Push {
        /// Beginning [s].
        time: f64,
        /// Duration [s].
        duration: f64,
        /// Time in which it grows at the beginning and fades at the end [s]; zero for a step.
        rise: f64,
        /// Force, world axes [N].
        force_w: Vec3,
        /// Moment, world axes [N m].
        moment_w: Vec3,
        /// Point at which the force acts, platform frame [m].
        point_p: Vec3,
    },
    /// Anchors move through places at given times by a cubic spline, at rest at both ends.
    Anchors {
        /// Beginning [s].
        time: f64,
        /// Times since the beginning, from zero on, rising [s].
        times: Vec<f64>,
        /// Places at these times, world axes [m], of the anchor of each cable; none for an anchor that goes on.
        places_w: Vec<Option<Vec<Vec3>>>,
    },
    /// A cable fails, at the platform or at a place along it.
    Cut {
        /// Index of the cable.
        cable: usize,
        /// When it fails.
        at: CutAt,
        /// Unstrained length between the platform and the place where it fails [m]; zero at the platform.
        place: f64,
    },
}

/// When a cable fails.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CutAt {
    /// At a time [s].
    Time(f64),
    /// When its tension at either end reaches this value [N].
    Tension(f64),
}

/// Reason why an event cannot happen. The caller names the event.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum EventFault {
    /// The event lies outside the simulated time.
    #[error(
        "its time {time} s is not within the simulated time, 0 to {end} s: simulate longer, or give an earlier time"
    )]
    Outside {
        /// Time of the event [s].
        time: f64,
        /// End of the simulation [s].
        end: f64,
    },
    /// A duration that is not positive.
    #[error("its duration is {duration} s: it must be positive, because lengths cannot jump")]
    Duration {
        /// Given duration [s].
        duration: f64,
    },
    /// A push without force and moment.
    #[error("it pushes with no force and no moment: give `force_n` or `moment_n_m`")]
    NoPush,
    /// A command that names no cable, or changes none.
    #[error("it changes nothing: give the cables by their names, with a change of length or a tension for each")]
    NoCable,
    /// A motion of anchors that names none.
    #[error("it moves no anchor: give the cables whose anchors move")]
    NoAnchor,
    /// The rise of a push is longer than half of it.
    #[error("its rise takes {rise} s at each end: give at most half of its duration of {duration} s")]
    Rise {
        /// Given time [s].
        rise: f64,
        /// Duration [s].
        duration: f64,
    },
    /// A payload without mass.
    #[error("the payload's mass is {mass} kg: it must be positive")]
    NoMass {
        /// Given mass [kg].
        mass: f64,
    },
    /// The payload is as heavy as the platform or heavier.
    #[error(
        "the payload's {mass} kg leave nothing of the platform's {of} kg at this time: the robot file's mass includes \
         the payload before its release"
    )]
    NegativeMass {
        /// Mass of the payload [kg].
        mass: f64,
        /// Mass of the platform before [kg].
        of: f64,
    },
    /// The inertia of the platform cannot contain the payload.
    #[error(
        "a payload of {mass} kg at this point is not part of the platform's inertia, of which something negative \
         would be left: move the point towards the centre of mass, or raise `inertia_kg_m2` in [platform]"
    )]
    NegativeInertia {
        /// Mass of the payload [kg].
        mass: f64,
    },
    /// Changes of length of one cable overlap.
    #[error("it begins at {time} s, before the last change of length of cable \"{cable}\" ends at {until} s")]
    Overlap {
        /// Name of the cable.
        cable: String,
        /// Beginning [s].
        time: f64,
        /// End of the change before [s].
        until: f64,
    },
    /// The first length of a table is not the length at that time.
    #[error(
        "the length of cable \"{cable}\" jumps from {before} m to {first} m at {time} s: begin the table with the \
         length at that time"
    )]
    Jump {
        /// Name of the cable.
        cable: String,
        /// Length before [m].
        before: f64,
        /// First length of the table [m].
        first: f64,
        /// Time [s].
        time: f64,
    },
    /// The first place of an anchor in a table is not where the anchor is at that time.
    #[error(
        "the anchor of cable \"{cable}\" jumps from {before:?} m to {first:?} m at {time} s: begin the table with its \
         place at that time"
    )]
    AnchorJump {
        /// Name of the cable.
        cable: String,
        /// Place before [m].
        before: [f64; 3],
        /// First place of the table [m].
        first: [f64; 3],
        /// Time [s].
        time: f64,
    },
    /// Motions of one anchor overlap.
    #[error("it begins at {time} s, before the last motion of the anchor of cable \"{cable}\" ends at {until} s")]
    AnchorOverlap {
        /// Name of the cable.
        cable: String,
        /// Beginning [s].
        time: f64,
        /// End of the motion before [s].
        until: f64,
    },
    /// An anchor that stands on a flexible support.
    #[error(
        "the anchor of cable \"{cable}\" stands on a flexible support, whose foot cannot be moved: leave out `support` \
         of this cable, or let its anchor rest"
    )]
    AnchorOnSupport {
        /// Name of the cable.
        cable: String,
    },
    /// A place that is not finite.
    #[error("its table has a place of the anchor of cable \"{cable}\" that is not finite")]
    AnchorNotFinite {
        /// Name of the cable.
        cable: String,
    },
    /// Times of a table that do not rise.
    #[error("row {row} of its table has the time {time} s, after {before} s: times rise from row to row")]
    TimesFall {
        /// Number of the row, from 1.
        row: usize,
        /// Time [s].
        time: f64,
        /// Time of the row before [s].
        before: f64,
    },
    /// A table that is too short.
    #[error("its table has {}: give at least two, the first at the beginning", crate::counted(*rows, "row"))]
    FewRows {
        /// Rows given.
        rows: usize,
    },
    /// A cable would become too short.
    #[error(
        "cable \"{cable}\" would be {length} m long at {time} s: its unstrained length must stay above {least} m, at \
         which a hundredth of its free span is left"
    )]
    TooShort {
        /// Name of the cable.
        cable: String,
        /// Length [m].
        length: f64,
        /// Time [s].
        time: f64,
        /// Limit [m].
        least: f64,
    },
    /// A tension that a rope cannot have.
    #[error("it asks for a tension of {tension} N: a rope has a tension of zero or more")]
    NegativeTension {
        /// Given tension [N].
        tension: f64,
    },
    /// A length is commanded of a winch that holds a tension.
    #[error(
        "the winch of cable \"{cable}\" holds a tension from {since} s on, so that its length cannot be commanded at \
         {time} s"
    )]
    HoldsTension {
        /// Name of the cable.
        cable: String,
        /// Time from which on it holds a tension [s].
        since: f64,
        /// Time of the command [s].
        time: f64,
    },
    /// A place of a failure that no cable has.
    #[error("it fails {place} m from the platform: give 0 or more")]
    NegativePlace {
        /// Given unstrained length [m].
        place: f64,
    },
    /// A place of a failure that is not well within the free span.
    #[error(
        "cable \"{cable}\" would fail {place} m from the platform, and {length} m of it hang there then: give a place \
         between {least} m and {most} m, so that each half has a fiftieth of it, or 0 for a failure at the platform"
    )]
    Place {
        /// Name of the cable.
        cable: String,
        /// Given unstrained length [m].
        place: f64,
        /// Unstrained length of the free span [m].
        length: f64,
        /// Least place [m].
        least: f64,
        /// Largest place [m].
        most: f64,
    },
    /// The last cable is cut.
    #[error("cable \"{cable}\" is the last one that holds the platform: without it the platform only falls")]
    LastCable {
        /// Name of the cable.
        cable: String,
    },
    /// A cable is cut twice.
    #[error("cable \"{cable}\" has been cut before")]
    CutTwice {
        /// Name of the cable.
        cable: String,
    },
    /// A cable that would fail from the beginning.
    #[error("cable \"{cable}\" has a tension of {tension} N at the start: give a larger tension at which it fails")]
    CutAtStart {
        /// Name of the cable.
        cable: String,
        /// Tension [N].
        tension: f64,
    },
    /// A load that a point mass cannot carry.
    #[error("{0}")]
    Load(#[from] crate::robot::LoadError),
}

/// An event that cannot happen.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Faulty {
    pub(super) event: usize,
    pub(super) fault: EventFault,
}

/// Least length of a cable over that at the start.
pub(super) const LEAST_LENGTH: f64 = 0.01;
/// Least part of a free span that a half has after a failure at a place. Ropes of 6 m with 24 nodes are followed with
/// 0.02 of it, in 5000 steps for 0.08 s; with 0.01 some need steps below the shortest one.
const MIN_HALF: f64 = 0.02;
/// Difference of lengths that counts as a jump, over the length: above the rounding of tables in micrometres.
pub(super) const JUMP: f64 = 1e-5;

impl SimulationEvent {
    /// Time at which it begins [s]; none for a cut at a tension.
    pub fn time(&self) -> Option<f64> {
        match self {
            Self::Release { time, .. }
            | Self::Pick { time, .. }
            | Self::Ramp { time, .. }
            | Self::Follow { time, .. }
            | Self::Stop { time, .. }
            | Self::Tension { time, .. }
            | Self::Push { time, .. }
            | Self::Anchors { time, .. }
            | Self::Cut { at: CutAt::Time(time), .. } => Some(*time),
            Self::Cut { at: CutAt::Tension(_), .. } => None,
        }
    }

    /// True if it happens at once and changes platform or cables.
    pub(super) fn is_sudden(&self) -> bool {
        matches!(
            self,
            Self::Release { .. } | Self::Pick { .. } | Self::Tension { .. } | Self::Cut { at: CutAt::Time(_), .. }
        )
    }

    /// Tension that it asks of a cable [N].
    pub(super) fn tension_of(&self, cable: usize) -> Option<f64> {
        if let Self::Tension { tensions, .. } = self { tensions[cable] } else { None }
    }

    /// Checks what the event says by itself.
    pub(super) fn check(&self, robot: &Robot, end: f64) -> Result<(), EventFault> {
        if let Some(time) = self.time()
            && !(0.0..=end).contains(&time)
        {
            return Err(EventFault::Outside { time, end });
        }
        match self {
            Self::Ramp { duration, .. }
            | Self::Stop { duration, .. }
            | Self::Push { duration, .. }
            | Self::Tension { duration, .. }
                if !(*duration > 0.0 && duration.is_finite()) =>
            {
                Err(EventFault::Duration { duration: *duration })
            }
            Self::Release { mass, .. } | Self::Pick { mass, .. } if !(*mass > 0.0 && mass.is_finite()) => {
                Err(EventFault::NoMass { mass: *mass })
            }
            Self::Push { duration, rise, .. } if !(0.0..=0.5 * duration).contains(rise) => {
                Err(EventFault::Rise { rise: *rise, duration: *duration })
            }
            Self::Push { force_w, moment_w, .. } if force_w.norm() == 0.0 && moment_w.norm() == 0.0 => {
                Err(EventFault::NoPush)
            }
            Self::Ramp { changes, .. } if changes.iter().all(|change| *change == 0.0) => Err(EventFault::NoCable),
            Self::Tension { tensions, .. } if tensions.iter().all(Option::is_none) => Err(EventFault::NoCable),
            Self::Stop { cables, .. } if cables.is_empty() => Err(EventFault::NoCable),
            Self::Push { force_w, moment_w, point_p, .. } => {
                let load = crate::robot::Load { force_w: *force_w, moment_w: *moment_w, point_p: *point_p };
                Ok(load.check(&robot.platform.motion)?)
            }
            Self::Cut { place, .. } if !(*place >= 0.0 && place.is_finite()) => {
                Err(EventFault::NegativePlace { place: *place })
            }
            Self::Follow { times, .. } => check_times(times),
            Self::Anchors { times, places_w, .. } => check_anchors(robot, times, places_w),
            Self::Tension { tensions, .. } => {
                let negative = tensions.iter().flatten().find(|tension| !(**tension >= 0.0 && tension.is_finite()));
                negative.map_or(Ok(()), |tension| Err(EventFault::NegativeTension { tension: *tension }))
            }
            _ => Ok(()),
        }
    }

    pub(super) fn push(&self) -> Option<Push> {
        let Self::Push { time, duration, rise, force_w, moment_w, point_p } = *self else { return None };
        Some(Push { from: time, until: time + duration, rise, force_w, moment_w, point_p })
    }
}

/// Refuses a place of a failure of a cable whose free span has this unstrained length.
pub(super) fn check_place(cable: &str, place: f64, length: f64) -> Result<(), EventFault> {
    let (least, most) = (MIN_HALF * length, (1.0 - MIN_HALF) * length);
    if place == 0.0 || (least..=most).contains(&place) {
        return Ok(());
    }
    Err(EventFault::Place { cable: cable.to_owned(), place, length, least, most })
}

/// Refuses to move an anchor on a flexible support.
pub(super) fn check_can_move(robot: &Robot, cable: usize) -> Result<(), EventFault> {
    let of = &robot.cables[cable];
    if of.anchor.support.is_some() {
        return Err(EventFault::AnchorOnSupport { cable: of.name.clone() });
    }
    Ok(())
}

fn check_anchors(robot: &Robot, times: &[f64], places_w: &[Option<Vec<Vec3>>]) -> Result<(), EventFault> {
    if places_w.iter().all(Option::is_none) {
        return Err(EventFault::NoAnchor);
    }
    check_times(times)?;
    for (i, places_w) in places_w.iter().enumerate() {
        let Some(places_w) = places_w else { continue };
        check_can_move(robot, i)?;
        if places_w.iter().any(|place_w| !place_w.norm().is_finite()) {
            return Err(EventFault::AnchorNotFinite { cable: robot.cables[i].name.clone() });
        }
    }
    Ok(())
}

fn check_times(times: &[f64]) -> Result<(), EventFault> {
    if times.len() < 2 {
        return Err(EventFault::FewRows { rows: times.len() });
    }
    for (row, pair) in (2..).zip(times.windows(2)) {
        if pair[1] <= pair[0] || pair.iter().any(|time| time.is_nan()) {
            return Err(EventFault::TimesFall { row, time: pair[1], before: pair[0] });
        }
    }
    Ok(())
}

/// Unstrained lengths over time of all cables, which begin at `initial`, with free spans of the lengths `free`. `order`
/// has the events by their time.
pub(super) fn windings(
    robot: &Robot,
    (initial, free): (&[f64], &[f64]),
    events: &[SimulationEvent],
    order: &[usize],
) -> Result<Vec<Winding>, Faulty> {
    let mut windings: Vec<Winding> = initial.iter().map(|length| Winding::constant(*length)).collect();
    let mut holding: Vec<Option<f64>> = robot.cables.iter().map(torque_from_the_start).collect();
    for &event in order {
        for (i, winding) in windings.iter_mut().enumerate() {
            let name = &robot.cables[i].name;
            let faulty = |fault| Faulty { event, fault };
            check_hold(&mut holding[i], i, name, &events[event]).map_err(faulty)?;
            wind(winding, i, name, &events[event]).map_err(faulty)?;
            let (least, limit) = (winding.least(1e-3, 0.0), initial[i] - (1.0 - LEAST_LENGTH) * free[i]);
            if least.0 < limit || least.0.is_nan() {
                let (length, time) = least;
                return Err(faulty(EventFault::TooShort { cable: name.clone(), length, time, least: limit }));
            }
        }
    }
    Ok(windings)
}

/// Refuses places of failures that the lengths of the cables do not have at their times, and lengths that would leave
/// nothing of the half at the winch.
pub(super) fn check_places(
    robot: &Robot,
    (initial, free): (&[f64], &[f64]),
    events: &[SimulationEvent],
    windings: &[Winding],
) -> Result<(), Faulty> {
    for (event, of) in events.iter().enumerate() {
        let SimulationEvent::Cut { cable: i, at, place } = *of else { continue };
        if place == 0.0 || robot.cables[i].material.mass_per_length == 0.0 {
            continue;
        }
        let (name, behind) = (&robot.cables[i].name, initial[i] - free[i]);
        let faulty = |fault| Faulty { event, fault };
        // The time of a failure at a tension is not known before.
        if let CutAt::Time(time) = at {
            check_place(name, place, windings[i].at(time).value - behind).map_err(faulty)?;
            let (limit, (length, time)) = (behind + place + LEAST_LENGTH * free[i], windings[i].least(1e-3, time));
            if length < limit {
                let fault = EventFault::TooShort { cable: name.clone(), length, time, least: limit };
                return Err(faulty(fault));
            }
        }
    }
    Ok(())
}

/// Time from which on a motor with constant torque holds a tension.
fn torque_from_the_start(cable: &Cable) -> Option<f64> {
    cable.anchor.winch.as_ref().filter(|winch| winch.control == Control::Torque).map(|_| 0.0)
}

/// Refuses an event that commands the length of a winch that holds a tension.
fn check_hold(since: &mut Option<f64>, i: usize, name: &str, event: &SimulationEvent) -> Result<(), EventFault> {
    let time = event.time().unwrap_or_default();
    let commands = match event {
        SimulationEvent::Ramp { changes, .. } => changes[i] != 0.0,
        SimulationEvent::Follow { lengths, .. } => lengths[i].is_some(),
        SimulationEvent::Stop { cables, .. } => cables.contains(&i) && since.is_some_and(|since| since > 0.0),
        _ => false,
    };
    if let (true, Some(since)) = (commands, *since) {
        return Err(EventFault::HoldsTension { cable: name.to_owned(), since, time });
    }
    if event.tension_of(i).is_some() && since.is_none() {
        *since = Some(time);
    }
    Ok(())
}

/// Adds what an event asks of one winch.
fn wind(winding: &mut Winding, i: usize, name: &str, event: &SimulationEvent) -> Result<(), EventFault> {
    let overlap = |time: f64| {
        move |of: super::winding::Overlap| EventFault::Overlap { cable: name.to_owned(), time, until: of.until }
    };
    match event {
        SimulationEvent::Ramp { time, duration, changes } if changes[i] != 0.0 => {
            winding.ramp(*time, *duration, changes[i]).map_err(overlap(*time))
        }
        SimulationEvent::Follow { time, times, lengths } => {
            let Some(lengths) = &lengths[i] else { return Ok(()) };
            let before = winding.at(*time).value;
            if (lengths[0] - before).abs() > JUMP * before {
                let (cable, first) = (name.to_owned(), lengths[0]);
                return Err(EventFault::Jump { cable, before, first, time: *time });
            }
            winding.follow(*time, times, lengths).map_err(overlap(*time))
        }
        SimulationEvent::Stop { time, duration, cables } if cables.contains(&i) => {
            winding.brake(*time, *duration);
            Ok(())
        }
        _ => Ok(()),
    }
}
