//! Drawing of a simulation in pages and figures beyond its rows: the robot at some of the times, marks of the events,
//! and the times at which cables are slack.

use super::rows::SimulatedRow;
use crate::text::short;
use funicular::math::Vec3;
use funicular::robot::{Platform, Pose, Robot};
use funicular::simulation::{RobotSample, Simulation, SimulationEvent, SlackCable};
use funicular::statics::Equilibrium;

/// Largest number of times at which the robot is kept for pictures: thirty per second of a run of ten seconds.
const MAX_FRAMES: usize = 300;
/// Largest number of coordinates in all pictures: with more a page is larger than 5 MB.
const MAX_COORDINATES: usize = 300_000;

/// Largest displacement of a picture, as a part of the robot's size, up to which motion is enlarged: smaller motion is
/// not seen.
const VISIBLE: f64 = 0.03;

/// Robot at one time, as it is drawn.
#[derive(Debug, Clone)]
pub struct SimulatedFrame {
    pub t_s: f64,
    pub pose: Pose,
    /// Points of every rope from the platform to the anchor [m]; none for a cut rope without mass. Of a cable that has
    /// failed at a place, they are those of the half at the anchor.
    pub curves: Vec<Vec<Vec3>>,
    /// Halves at the platform of cables that fail at a place: the cable's index and points from the platform to the
    /// loose end [m], none before the failure.
    pub halves: Vec<(usize, Vec<Vec3>)>,
}

/// Event as a mark in time.
#[derive(Debug, Clone, PartialEq)]
pub struct EventMark {
    pub from_s: f64,
    /// End of an event that lasts.
    pub until_s: Option<f64>,
    /// Event in a few words.
    pub what: String,
}

/// Time during which a cable is slack.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlackSpan {
    /// Index of the cable.
    pub cable: usize,
    pub from_s: f64,
    pub until_s: f64,
}

/// Robot of a simulation at its start, at some of its times and at its end.
pub struct SimulatedPicture {
    pub robot: Robot,
    /// Equilibrium at the start.
    pub rest: Equilibrium,
    pub frames: Vec<SimulatedFrame>,
    pub marks: Vec<EventMark>,
    /// Platform with the payloads of the end.
    pub last_platform: Platform,
    /// True for cables that hold at the end.
    pub holds: Vec<bool>,
}

impl SimulatedPicture {
    pub(super) fn new(robot: &Robot, rest: &Equilibrium, events: &[SimulationEvent]) -> Self {
        Self {
            robot: robot.clone(),
            rest: rest.clone(),
            frames: Vec::new(),
            marks: marks(robot, events),
            last_platform: robot.platform.clone(),
            holds: vec![true; robot.cables.len()],
        }
    }

    /// Keeps the robot at row `k` of `rows` if a picture falls on it.
    pub(super) fn keep(&mut self, simulation: &mut Simulation, sample: &RobotSample, k: usize, rows: usize) {
        if self.frames.is_empty() {
            self.add(simulation, sample);
        }
        // Halves have as many points as their cables.
        let first = &self.frames[0];
        let halves: usize = first.halves.iter().map(|(cable, _)| first.curves[*cable].len()).sum();
        let points = first.curves.iter().map(Vec::len).sum::<usize>() + halves;
        let count = MAX_FRAMES.min(MAX_COORDINATES / (3 * points).max(1)).max(2);
        let parts = (count - 1).min(rows - 1).max(1);
        // Row k is drawn if it is the first one in its part of the rows.
        let part = |row: usize| (row * parts).div_ceil((rows - 1).max(1));
        if k > 0 && (k == rows - 1 || part(k) < part(k + 1)) {
            self.add(simulation, sample);
        }
    }

    /// Factor with which displacements since the start are drawn: 1, 2 or 5 times a power of ten.
    pub fn enlargement(&self) -> f64 {
        let Some(first) = self.frames.first() else { return 1.0 };
        let points = |frame: &SimulatedFrame| frame.curves.iter().flatten().copied().collect::<Vec<Vec3>>();
        let at_start = points(first);
        let far = |frame: &SimulatedFrame| {
            points(frame).iter().zip(&at_start).map(|(p, q)| (p - q).norm()).fold(0.0, f64::max)
        };
        let largest = self.frames.iter().map(far).fold(0.0, f64::max);
        let of_axis = |axis: usize| {
            let values = at_start.iter().map(|p| p[axis]);
            let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
            high - low
        };
        let wanted = VISIBLE * Vec3::new(of_axis(0), of_axis(1), of_axis(2)).norm() / largest;
        if !wanted.is_finite() || wanted < 2.0 {
            return 1.0;
        }
        let power = 10.0_f64.powf(wanted.log10().floor());
        let step = [5.0, 2.0].into_iter().find(|step| step * power <= wanted).unwrap_or(1.0);
        step * power
    }

    fn add(&mut self, simulation: &mut Simulation, sample: &RobotSample) {
        let mut curves = simulation.curves_w(sample.time);
        let halves = simulation.parted().into_iter().zip(curves.split_off(self.robot.cables.len())).collect();
        self.frames.push(SimulatedFrame { t_s: sample.time, pose: sample.pose, curves, halves });
    }

    /// Notes the end of the run.
    pub(super) fn end(&mut self, simulation: &Simulation) {
        self.last_platform = simulation.platform(&self.robot.platform);
        for (cable, time) in simulation.cuts() {
            self.holds[*cable] = false;
            let what = format!("cut {}", self.robot.cables[*cable].name);
            self.marks.push(EventMark { from_s: *time, until_s: None, what });
        }
        self.marks.sort_by(|a, b| a.from_s.total_cmp(&b.from_s));
    }
}

/// Marks of all events but cuts, whose times the run tells.
fn marks(robot: &Robot, events: &[SimulationEvent]) -> Vec<EventMark> {
    let named = |cables: Vec<usize>| {
        if cables.len() == robot.cables.len() {
            return String::new();
        }
        let names: Vec<&str> = cables.iter().map(|i| robot.cables[*i].name.as_str()).collect();
        format!(" {}", names.join(", "))
    };
    let mark = |event: &SimulationEvent| {
        let (from_s, lasts, what) = match event {
            SimulationEvent::Release { time, mass, .. } => (*time, None, format!("release {} kg", short(*mass, 4))),
            SimulationEvent::Pick { time, mass, .. } => (*time, None, format!("pick {} kg", short(*mass, 4))),
            SimulationEvent::Ramp { time, duration, changes } => {
                let moved = (0..changes.len()).filter(|i| changes[*i] != 0.0).collect();
                (*time, Some(*duration), format!("lengths{}", named(moved)))
            }
            SimulationEvent::Follow { time, times, lengths } => {
                let moved = (0..lengths.len()).filter(|i| lengths[*i].is_some()).collect();
                (*time, times.last().copied(), format!("lengths{}", named(moved)))
            }
            SimulationEvent::Anchors { time, times, places_w } => {
                let moved = (0..places_w.len()).filter(|i| places_w[*i].is_some()).collect();
                (*time, times.last().copied(), format!("anchors{}", named(moved)))
            }
            SimulationEvent::Tension { time, duration, tensions } => {
                let held = (0..tensions.len()).filter(|i| tensions[*i].is_some()).collect();
                (*time, Some(*duration), format!("tension{}", named(held)))
            }
            SimulationEvent::Stop { time, duration, cables } => {
                (*time, Some(*duration), format!("stop{}", named(cables.clone())))
            }
            SimulationEvent::Push { time, duration, .. } => (*time, Some(*duration), "push".to_owned()),
            SimulationEvent::Cut { .. } => return None,
        };
        Some(EventMark { from_s, until_s: lasts.map(|duration| from_s + duration), what })
    };
    events.iter().filter_map(mark).collect()
}

/// Times at which cables are slack, by the rows, in which a tension counts as straight. A cable that failed is not
/// slack.
pub(super) fn slack_spans(rows: &[SimulatedRow], cut_at: impl Fn(usize) -> Option<f64>) -> Vec<SlackSpan> {
    let mut spans = Vec::new();
    let count = rows.first().map_or(0, |row| row.tensions_platform_n.len());
    for cable in 0..count {
        let end = cut_at(cable).unwrap_or(f64::INFINITY);
        let until = rows.partition_point(|row| row.t_s < end);
        let at = |k: usize| (rows[k].t_s, rows[k].tensions_platform_n[cable]);
        // Time between two rows at which the tension passes the limit.
        let passes = |k: usize| {
            let ((t0, n0), (t1, n1)) = (at(k), at(k + 1));
            t0 + (t1 - t0) * ((SlackCable::TENSION - n0) / (n1 - n0)).clamp(0.0, 1.0)
        };
        let mut began = None;
        for k in 0..until {
            let is_slack = at(k).1 < SlackCable::TENSION;
            match (began, is_slack) {
                (None, true) => began = Some(if k == 0 { at(0).0 } else { passes(k - 1) }),
                (Some(from_s), false) => {
                    spans.push(SlackSpan { cable, from_s, until_s: passes(k - 1) });
                    began = None;
                }
                _ => {}
            }
        }
        if let (Some(from_s), true) = (began, until > 0) {
            spans.push(SlackSpan { cable, from_s, until_s: at(until - 1).0.min(end) });
        }
    }
    spans
}
