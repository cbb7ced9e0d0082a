//! Mode shapes: motion of platform and cables in each natural mode, for an animated view.
//!
//! The page holds a header in JSON and the displacements at stations along the cables, packed together. Displacements
//! are integer multiples of a scale, with one scale per mode. Along a cable they are stored as second differences:
//! small numbers, which pack to half the size. The script of the view (`templates/shapes.js`) reads this format.

use super::rounded;
use crate::figures::hull::faces;
use crate::figures::view::{EYE, extent, joined, ranges, sides};
use crate::pages::packed;
use crate::pages::table::{fixed, significant};
use askama::Template;
use funicular::cable::Sag;
use funicular::cable_motion::{CableMotionError, CableStations};
use funicular::dynamics::Dynamics;
use funicular::math::Vec3;
use funicular::modes::{Mode, Modes};
use funicular::robot::Robot;
use funicular::statics::Equilibrium;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Largest displacement of a mode in steps of its scale: one step is a tenth of a pixel for a motion of a hundred
/// pixels.
const STEPS: f64 = 1000.0;
/// Maximum size of the displacements before packing [bytes]: with it a page stays below 5 MB.
const MAX_BYTES: usize = 1_000_000;
/// Minimum number of intervals between stations.
const MIN_INTERVALS: usize = 16;
/// Minimum number of intervals per half wave of the taut cable. The error of the cubics through the stations is then
/// 0.6 % of the wave's height.
const MIN_PER_HALF_WAVE: f64 = 4.5;
/// Number of intervals of a cable at equilibrium; its curve has no waves.
const AT_REST: usize = 32;
/// Minimum number of intervals of a drawn cable.
const MIN_DRAWN: usize = 64;

/// View of the mode shapes.
#[derive(Template)]
#[template(path = "shapes.html")]
pub(crate) struct Shapes {
    packed: String,
    shown: usize,
    total: usize,
}

/// Script of the view.
pub(crate) const SCRIPT: &str = include_str!("../../../templates/shapes.js");

impl Shapes {
    /// Creates the view of the lowest modes, as many as the size of a page allows. `None` if there is no mode.
    ///
    /// # Errors
    /// A cable model without motion along the cables.
    pub(crate) fn new(
        robot: &Robot,
        equilibrium: &Equilibrium,
        dynamics: &Dynamics,
        found: &Modes,
    ) -> Result<Option<Self>, CableMotionError> {
        let slowest = slowest_string_hz(robot, equilibrium);
        let mut stations = Levels { robot, equilibrium, dynamics, by_intervals: BTreeMap::new() };
        let (mut modes, mut steps, mut finest) = (Vec::new(), Vec::new(), MIN_INTERVALS);

        for mode in &found.modes {
            let intervals = intervals(mode.frequency_hz / slowest);
            let room = MAX_BYTES / 2 - steps.len();
            if intervals.saturating_mul(3 * robot.cables.len()) > room {
                break;
            }
            let moved = stations.moved(mode, intervals)?;
            let values = || moved.iter().flatten().flatten();
            let largest = values().fold(0.0_f64, |most, u| most.max(u.abs()));
            let scale = if largest > 0.0 { largest / STEPS } else { 1.0 };
            for (cable, axis) in moved.iter().flat_map(|cable| [0, 1, 2].map(|axis| (cable, axis))) {
                steps.extend(second_differences(cable.iter().map(|u| (u[axis] / scale).round() as i16)));
            }
            modes.push(described(mode, intervals, scale));
            finest = finest.max(intervals);
        }

        if modes.is_empty() {
            return Ok(None);
        }
        let shown = modes.len();
        let mut header = scenery(robot, equilibrium, (2 * finest).max(MIN_DRAWN));
        let axes = stations.axes(MIN_INTERVALS)?;
        for (cable, axes) in header["cables"].as_array_mut().into_iter().flatten().zip(axes) {
            cable["axes"] = json!(axes.map(|axis| [axis.x, axis.y, axis.z]));
        }
        header["modes"] = Value::Array(modes);
        header["total"] = json!(found.modes.len());
        Ok(Some(Self { packed: packed(&with_header(&header, &steps)), shown, total: found.modes.len() }))
    }
}

/// Second differences of numbers that are preceded by two zeros; at most four times as large as the numbers.
fn second_differences(values: impl Iterator<Item = i16>) -> impl Iterator<Item = i16> {
    values.scan((0, 0), |(last, before), value| {
        let difference = value - 2 * *last + *before;
        (*before, *last) = (*last, value);
        Some(difference)
    })
}

/// Bytes of the packed data: length of the header (four bytes, little-endian), header, steps (two bytes each,
/// little-endian).
fn with_header(header: &Value, steps: &[i16]) -> Vec<u8> {
    let header = header.to_string();
    let mut bytes = (header.len() as u32).to_le_bytes().to_vec();
    bytes.extend(header.as_bytes());
    bytes.extend(steps.iter().flat_map(|step| step.to_le_bytes()));
    bytes
}

/// Number of intervals for this many half waves: 16, 24, 32, 48, 64, …, so that modes share their stations.
fn intervals(half_waves: f64) -> usize {
    // More intervals would exceed the size of a page.
    let needed = if half_waves.is_finite() { (MIN_PER_HALF_WAVE * half_waves).min(1e6) } else { 0.0 };
    let mut count = MIN_INTERVALS;
    while (count as f64) < needed {
        count = if count.is_power_of_two() { count / 2 * 3 } else { count / 3 * 4 };
    }
    count
}

/// First frequency of the slowest cable as a taut string [Hz]; infinite if none has mass and tension.
fn slowest_string_hz(robot: &Robot, equilibrium: &Equilibrium) -> f64 {
    let strings =
        equilibrium.cables.iter().enumerate().map(|(i, state)| Sag::of(robot, i, state).string_frequency_hz());
    strings.filter(|f| *f > 0.0).fold(f64::INFINITY, f64::min)
}

/// Stations on every cable, by the number of intervals between them.
struct Levels<'a> {
    robot: &'a Robot,
    equilibrium: &'a Equilibrium,
    dynamics: &'a Dynamics,
    by_intervals: BTreeMap<usize, Vec<CableStations>>,
}

impl Levels<'_> {
    fn at(&mut self, intervals: usize) -> Result<&[CableStations], CableMotionError> {
        if !self.by_intervals.contains_key(&intervals) {
            let fractions: Vec<f64> = (0..=intervals).map(|k| k as f64 / intervals as f64).collect();
            let on = |i| CableStations::new(self.robot, self.equilibrium, self.dynamics, i, &fractions, false);
            let stations = (0..self.robot.cables.len()).map(on).collect::<Result<Vec<_>, _>>()?;
            self.by_intervals.insert(intervals, stations);
        }
        Ok(&self.by_intervals[&intervals])
    }

    /// Displacements (e, n, b) of a mode [m] per cable and station.
    fn moved(&mut self, mode: &Mode, intervals: usize) -> Result<Vec<Vec<[f64; 3]>>, CableMotionError> {
        let dynamics = self.dynamics;
        Ok(self.at(intervals)?.iter().map(|cable| cable.in_mode(dynamics, mode)).collect())
    }

    /// Axes (e, n, b) of the displacements of each cable.
    fn axes(&mut self, intervals: usize) -> Result<Vec<[Vec3; 3]>, CableMotionError> {
        Ok(self.at(intervals)?.iter().map(|cable| [cable.axes.e, cable.axes.n, cable.axes.b]).collect())
    }
}

/// Data of a mode for the view.
fn described(mode: &Mode, intervals: usize, scale: f64) -> Value {
    json!({
        "hz": fixed(mode.frequency_hz, 4),
        "multiplicity": mode.multiplicity,
        "damping": fixed(100.0 * mode.damping_ratio, 3),
        "kind": mode.kind.name(),
        "mass": significant(mode.modal_mass, 4),
        "platform": shares(&[mode.platform_energy_fraction])[0],
        "cables": shares(&mode.cable_energy_fractions),
        "drives": shares(&mode.drive_energy_fractions),
        "shape": mode.shape,
        "intervals": intervals,
        "scale": scale,
    })
}

/// Energy fractions rounded to a hundredth of a per cent, finer than any colour.
fn shares(fractions: &[f64]) -> Vec<f64> {
    fractions.iter().map(|share| (1e4 * share).round() / 1e4).collect()
}

/// Equilibrium for the view: cables, anchors, platform and axes, and the number of intervals of a drawn cable.
fn scenery(robot: &Robot, equilibrium: &Equilibrium, drawn: usize) -> Value {
    let part = |k: usize| k as f64 / AT_REST as f64;
    let anchors: Vec<Vec3> = equilibrium.cables.iter().map(|c| c.anchor_w).collect();
    let attachments: Vec<Vec3> = equilibrium.cables.iter().map(|c| c.attachment_w).collect();
    let names: Vec<String> = robot.cables.iter().map(|c| c.name.clone()).collect();

    let reach = extent(&anchors);
    let places = sides(&anchors, reach);
    let labels = joined(&anchors, &names, &places, reach);

    let mut points = anchors.clone();
    let cables: Vec<Value> = equilibrium
        .cables
        .iter()
        .enumerate()
        .map(|(i, state)| {
            let chord_w = state.anchor_w - state.attachment_w;
            let at = |k: usize| match &state.hanging {
                Some(hanging) => hanging.point_w(part(k) * state.free_length()),
                None => state.attachment_w + chord_w * part(k),
            };
            let rest: Vec<Vec3> = (0..=AT_REST).map(at).collect();
            let flat: Vec<f64> = rest.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
            points.extend(rest);
            json!({"name": names[i], "label": labels[i], "place": places[i], "rest": rounded(&flat)})
        })
        .collect();

    points.extend(&attachments);
    let ranges = ranges(&points, true);
    let triple = |p: &Vec3| rounded(&[p.x, p.y, p.z]);

    json!({
        "drawn": drawn,
        "low": rounded(&ranges.map(|(low, _)| low)),
        "high": rounded(&ranges.map(|(_, high)| high)),
        "eye": EYE,
        "cables": cables,
        "platform": {
            "origin": triple(&equilibrium.pose.position_w),
            "mass_centre": triple(&equilibrium.pose.point_w(&robot.platform.center_of_mass_p)),
            "corners": attachments.iter().map(triple).collect::<Vec<_>>(),
            "faces": faces(&attachments),
        },
    })
}

#[cfg(test)]
mod tests {
    use super::{intervals, second_differences};

    #[test]
    fn there_are_enough_stations_for_the_waves_and_not_many_more() {
        for none in [0.0, 3.5, f64::NAN, f64::INFINITY] {
            assert_eq!(intervals(none), 16);
        }
        let counts: Vec<usize> = [4.0, 6.0, 8.0, 12.0, 100.0].map(intervals).to_vec();
        assert_eq!(counts, [24, 32, 48, 64, 512]);
        for half_waves in [5.0, 14.7, 33.0, 470.0] {
            let count = intervals(half_waves) as f64;
            assert!(count >= 4.5 * half_waves && count <= 7.0 * half_waves);
        }
        assert!(intervals(f64::MAX) > 1_000_000);
    }

    #[test]
    fn double_summation_restores_the_numbers() {
        let values = [1000, -1000, 1000, 0, 3, -999];
        let (mut slope, mut value) = (0, 0);
        let again = second_differences(values.into_iter()).map(|difference| {
            slope += difference;
            value += slope;
            value
        });
        assert_eq!(again.collect::<Vec<i16>>(), values);
    }
}
