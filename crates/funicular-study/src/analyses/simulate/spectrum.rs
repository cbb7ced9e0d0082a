//! Spectrum of the motion after the last event, and the natural frequencies of the robot that is left there.

use super::Simulated;
use crate::analyses::simulate::SimulatedRow;
use crate::at_rest::AtRest;
use funicular::dynamics::Linearisation;
use funicular::modes::{self, Mode};
use funicular::robot::Robot;
use funicular::statics::{StaticModel, forward};
use std::f64::consts::TAU;

/// Smallest number of rows after the last event of which a spectrum is made.
const MIN_ROWS: usize = 32;
/// Largest number of values of which a spectrum is made; neighbours are averaged if there are more.
const MAX_VALUES: usize = 8192;
/// Frequencies per inverse of the duration: a peak is then drawn to 3 % of its height.
const FINER: f64 = 4.0;
/// Largest number of frequencies.
const MAX_FREQUENCIES: usize = 4000;
/// Part of the largest amplitude above which an amplitude is shown.
const SHOWN: f64 = 1e-2;
/// Room above the highest shown frequency, as a factor.
const ABOVE: f64 = 1.3;
/// Largest number of natural frequencies that are marked; more would be a grey band.
const MAX_MODES: usize = 400;
/// Motion below which there is nothing to show [m].
const STILL: f64 = 1e-9;

/// Amplitudes of the motion of the platform's origin, and natural frequencies.
pub struct MotionSpectrum {
    /// Beginning of the motion that is analysed: the end of the last event [s].
    pub from_s: f64,
    pub until_s: f64,
    pub frequency_hz: Vec<f64>,
    /// Amplitudes along the axes of the world [m]: a steady sine appears with its own.
    pub amplitude_m: [Vec<f64>; 3],
    /// Modes of the robot at the equilibrium of the last lengths, with the payloads and cables of the end.
    pub modes: Vec<Mode>,
    /// Reason why no natural frequencies are marked.
    pub without_modes: Option<String>,
}

impl Simulated {
    /// Spectrum of the motion after the last event; `None` if there is no motion, or too little of it.
    pub fn spectrum(&self) -> Option<MotionSpectrum> {
        let marks = self.picture.marks.iter();
        let from = marks.map(|mark| mark.until_s.unwrap_or(mark.from_s)).fold(0.0, f64::max);
        let rows = &self.rows[self.rows.partition_point(|row| row.t_s < from)..];
        if rows.len() < MIN_ROWS {
            return None;
        }
        let (first, last) = (&rows[0], &rows[rows.len() - 1]);
        let duration = last.t_s - first.t_s;
        let averaged = rows.len().div_ceil(MAX_VALUES);
        let values = [0, 1, 2].map(|axis| averages(rows, axis, averaged));
        let size = |of: &[f64]| of.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        if values.iter().all(|of| size(of) < STILL) {
            return None;
        }

        let apart = averaged as f64 * duration / (rows.len() - 1) as f64;
        let highest = 0.5 / apart;
        let step = (1.0 / (FINER * duration)).max(highest / MAX_FREQUENCIES as f64);
        let frequency_hz: Vec<f64> = (1..=(highest / step) as usize).map(|k| step * k as f64).collect();
        let mut amplitude_m = values.map(|of| amplitudes(&of, &frequency_hz, apart));
        let most = amplitude_m.iter().map(|of| size(of)).fold(0.0, f64::max);
        let is_shown = |k: &usize| amplitude_m.iter().any(|of| of[*k] > SHOWN * most);
        let shown = (0..frequency_hz.len()).rfind(is_shown).unwrap_or_default();
        let limit = (ABOVE * frequency_hz[shown]).min(highest);
        let kept = frequency_hz.partition_point(|hz| *hz <= limit);
        for of in &mut amplitude_m {
            of.truncate(kept);
        }
        let (modes, without_modes) = match self.modes_at_end(last, limit) {
            Ok(modes) => (modes, None),
            Err(reason) => (Vec::new(), Some(reason.to_string())),
        };
        let frequency_hz = frequency_hz[..kept].to_vec();
        Some(MotionSpectrum { from_s: first.t_s, until_s: last.t_s, frequency_hz, amplitude_m, modes, without_modes })
    }

    /// Natural frequencies at the equilibrium of the lengths of a row.
    fn modes_at_end(&self, row: &SimulatedRow, below_hz: f64) -> anyhow::Result<Vec<Mode>> {
        let picture = &self.picture;
        let mut robot = Robot { platform: picture.last_platform.clone(), ..picture.robot.clone() };
        let mut holds = picture.holds.iter();
        robot.cables.retain(|_| holds.next().copied().unwrap_or(true));
        let lengths: Vec<f64> =
            row.unstrained_lengths_m.iter().zip(&picture.holds).filter_map(|(l, holds)| holds.then_some(*l)).collect();
        let start = picture.frames.last().map_or(picture.rest.pose, |frame| frame.pose);
        let equilibrium = forward(&robot, &lengths, StaticModel::Catenary, Some(&start))?;
        let at_rest = AtRest { robot, equilibrium, requested_pose: None, rule: None, held_pose: None };
        let (dynamics, _) = at_rest.dynamics(Linearisation::default(), below_hz)?;
        modes::check_count(&dynamics, below_hz, MAX_MODES)?;
        Ok(modes::below(&dynamics, below_hz).modes)
    }
}

/// Position along an axis about its mean; `count` neighbours become one value.
fn averages(rows: &[SimulatedRow], axis: usize, count: usize) -> Vec<f64> {
    let each = rows.chunks_exact(count);
    let values: Vec<f64> =
        each.map(|part| part.iter().map(|row| row.motion.pose.position_m[axis]).sum::<f64>() / count as f64).collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.into_iter().map(|x| x - mean).collect()
}

/// Amplitudes at frequencies [Hz] of values that are `step` [s] apart, through the window of von Hann.
fn amplitudes(values: &[f64], frequency_hz: &[f64], step: f64) -> Vec<f64> {
    let last = (values.len() - 1) as f64;
    let windowed: Vec<f64> = (0..).zip(values).map(|(k, x)| x * (1.0 - (TAU * f64::from(k) / last).cos())).collect();
    let of = |hz: &f64| {
        let (turn_sin, turn_cos) = (TAU * hz * step).sin_cos();
        let (mut re, mut im, mut cos, mut sin) = (0.0, 0.0, 1.0, 0.0);
        for x in &windowed {
            (re, im) = (re + x * cos, im + x * sin);
            (cos, sin) = (cos * turn_cos - sin * turn_sin, sin * turn_cos + cos * turn_sin);
        }
        2.0 * f64::hypot(re, im) / last
    };
    frequency_hz.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_steady_sine_appears_with_its_amplitude_at_its_frequency() {
        let step = 0.01;
        let values: Vec<f64> = (0..1000).map(|k| 0.3 * (TAU * 2.5 * step * f64::from(k) + 0.7).sin()).collect();
        let hz: Vec<f64> = (1..400).map(|k| 0.025 * f64::from(k)).collect();
        let found = amplitudes(&values, &hz, step);
        let (at, most) = found.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
        assert!((hz[at] - 2.5).abs() < 1e-12 && (most - 0.3).abs() < 1e-3, "{} {most}", hz[at]);
        // Three widths away the window has nothing left.
        assert!(found.iter().zip(&hz).all(|(a, hz)| (hz - 2.5).abs() < 0.5 || *a < 2e-3));
    }
}
