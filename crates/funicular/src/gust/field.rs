//! Gusts at places in space: axes of the mean wind, spectra, and how far the gusts at two places agree.

use super::GustError;
use crate::math::{Complex, Mat3, Vec3};
use crate::robot::{Robot, Turbulence};

/// Least part of a mean wind that is level, over its speed. A wind straight up or down has no lateral direction.
const MIN_LEVEL: f64 = 0.1;

/// Coherence below which two places count as independent: far below the part that any result shows.
const MIN_COHERENCE: f64 = 1e-9;

/// Frequency, times the longest time of the turbulence, below which spectra of turbulence are constant to 1e-4.
const CONSTANT_BELOW: f64 = 1e-4;

/// Turbulence about the mean wind of a robot.
pub(crate) struct TurbulentField {
    turbulence: Turbulence,
    /// Mean speed [m/s].
    speed: f64,
    /// Directions along the mean wind, lateral and up, by columns, world axes.
    pub(crate) axes: Mat3,
}

/// Place at which gusts act: a cell of a cable, or the platform.
#[derive(Debug, Clone)]
pub(crate) struct GustPlace {
    /// Centre, world axes [m].
    pub(crate) center_w: Vec3,
    /// Extent of the cell along its cable, world axes [m]; zero for the platform.
    pub(crate) extent_w: Vec3,
}

/// Weighted distances between places, a row per place with the places from itself on.
pub(crate) struct Distances(Vec<Vec<f64>>);

impl TurbulentField {
    /// Turbulence of a robot in its wind.
    pub(crate) fn of(robot: &Robot) -> Result<Self, GustError> {
        let turbulence = robot.turbulence.clone().ok_or(GustError::NoTurbulence)?;
        let (velocity_w, up_w) = (robot.wind.velocity_w, robot.up_w());
        let speed = velocity_w.norm();
        if speed == 0.0 {
            return Err(GustError::NoWind);
        }
        let along = velocity_w / speed;
        let lateral = up_w.cross(&along);
        if lateral.norm() < MIN_LEVEL {
            return Err(GustError::NotLevel);
        }
        let lateral = lateral.normalize();
        Ok(Self { turbulence, speed, axes: Mat3::from_columns(&[along, lateral, along.cross(&lateral)]) })
    }

    /// Spectral density of each component of the gusts at a frequency [Hz], [m²/s].
    pub(crate) fn densities(&self, frequency_hz: f64) -> [f64; 3] {
        std::array::from_fn(|component| self.turbulence.density(component, frequency_hz, self.speed))
    }

    /// Frequency below which the spectra are constant [Hz].
    pub(crate) fn lowest_hz(&self) -> f64 {
        if let Some(measured) = &self.turbulence.measured {
            return measured.frequencies_hz()[0];
        }
        let times = self.turbulence.length_scale.iter().map(|length| length / self.speed);
        CONSTANT_BELOW / times.fold(0.0_f64, f64::max)
    }

    /// Measured frequencies [Hz], between which the spectra are straight; none for a formula.
    pub(crate) fn measured_hz(&self) -> &[f64] {
        self.turbulence.measured.as_ref().map_or(&[], |measured| measured.frequencies_hz())
    }

    /// Weighted distances between all places.
    pub(crate) fn distances(&self, places: &[GustPlace]) -> Distances {
        let between = |a: &GustPlace, b: &GustPlace| self.weighted(&(a.center_w - b.center_w));
        Distances(
            (0..places.len()).map(|p| places[p..].iter().map(|other| between(&places[p], other)).collect()).collect(),
        )
    }

    /// Distance weighted by the decay of the coherence along each axis of the wind [m].
    fn weighted(&self, distance_w: &Vec3) -> f64 {
        self.turbulence.weighted_distance((self.axes.transpose() * distance_w).into())
    }

    /// Factor of the gusts at a place at a frequency [Hz]: the phase by which they are late, and the root of the part
    /// that is left of them if they are the mean over the cell instead of the value at its centre.
    ///
    /// # References
    /// docs/theory.md, equation (49l).
    pub(crate) fn factor(&self, place: &GustPlace, frequency_hz: f64) -> Complex {
        let lag = |w: &Vec3| self.turbulence.lag(self.axes.column(0).dot(w), frequency_hz, self.speed);
        let decay = self.weighted(&place.extent_w) * frequency_hz / self.speed;
        Complex::from_polar(mean_over_cell(decay, lag(&place.extent_w)).sqrt(), -lag(&place.center_w))
    }

    /// Calls `pair` with the numbers of two places and the magnitude of the coherence between them at a frequency
    /// [Hz], for every pair of a place and itself or a later place.
    pub(crate) fn for_coherences(
        &self,
        distances: &Distances,
        frequency_hz: f64,
        mut pair: impl FnMut(usize, usize, f64),
    ) {
        let per_distance = -frequency_hz / self.speed;
        for (p, row) in distances.0.iter().enumerate() {
            for (k, distance) in row.iter().enumerate() {
                let coherence = (per_distance * distance).exp();
                if coherence > MIN_COHERENCE {
                    pair(p, p + k, coherence);
                }
            }
        }
    }
}

/// Power of gusts that act on all cells of a line, over that with the value at the centre of each cell: the gusts of
/// two neighbouring cells have the coherence `e^{-decay}` and differ by the phase `lag`.
fn mean_over_cell(decay: f64, lag: f64) -> f64 {
    let square = decay * decay + lag * lag;
    // Below this the series has no digit beside 1.
    if square < 1e-12 {
        return 1.0;
    }
    let over_sinh = if decay == 0.0 { 1.0 } else { decay / decay.sinh() };
    (2.0 * decay * (0.5 * decay).tanh() + 4.0 * over_sinh * (0.5 * lag).sin().powi(2)) / square
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the sum over cells and the integral over the line, of coherence and phase, for a long line.
    #[test]
    fn cells_of_a_long_line_have_the_power_of_the_line() {
        for (decay, lag) in [(0.3_f64, 0.0_f64), (2.0, 0.0), (0.5, 1.5), (3.0, 2.0)] {
            let count = 4000;
            // Over the line ∫∫ e^{−a|s − s'| + iφ(s − s')}, in lengths of a cell, without its ends.
            let line = 2.0 * decay / (decay * decay + lag * lag);
            let cells: f64 =
                (-count..=count).map(|k| (-decay * f64::from(k).abs()).exp() * (lag * f64::from(k)).cos()).sum();
            assert!((mean_over_cell(decay, lag) * cells / line - 1.0).abs() < 1e-12, "{decay} {lag}");
        }
        assert!((mean_over_cell(0.0, 1.0) - (2.0 * 0.5_f64.sin()).powi(2)).abs() < 1e-15);
        assert!((mean_over_cell(800.0, 0.0) - 2.0 / 800.0).abs() < 1e-15);
    }
}
