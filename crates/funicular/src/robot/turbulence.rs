//! Turbulence of the wind: how strong it is, over which frequencies it is spread, and over which distances it agrees.

use std::f64::consts::TAU;
use thiserror::Error;

/// Turbulence about the mean wind. Components are in the order along the mean wind, lateral, up.
#[derive(Debug, Clone, PartialEq)]
pub struct Turbulence {
    /// Shape of the spectra.
    pub spectrum: TurbulenceSpectrum,
    /// Intensity of each component: its standard deviation over the mean speed.
    pub intensity: [f64; 3],
    /// Length scale of each component along the mean wind [m].
    pub length_scale: [f64; 3],
    /// Decay of the coherence with the distance along the mean wind, lateral and up; zero for none.
    pub coherence_decay: [f64; 3],
    /// True if the gusts travel with the mean wind without change (frozen turbulence): a place downstream meets them
    /// later.
    pub is_frozen: bool,
    /// Measured spectra, which replace shape, intensity and length scales.
    pub measured: Option<MeasuredSpectrum>,
}

/// Measured one-sided spectral densities of the components, straight between the measured frequencies and constant
/// below the first. Gusts faster than the last are not known.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredSpectrum {
    frequencies_hz: Vec<f64>,
    densities: Vec<[f64; 3]>,
}

/// Reason why numbers are no measured spectrum, with the index of its row.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum MeasuredSpectrumError {
    /// Too few or too many rows.
    #[error(
        "there are {count} frequencies: give at least two and at most {}, with means over neighbouring ones",
        MeasuredSpectrum::MAX_ROWS
    )]
    Rows {
        /// Number of rows.
        count: usize,
    },
    /// A frequency that is not positive, or not above the one before.
    #[error("the frequency {frequency_hz} Hz is not above the one before, {before_hz} Hz: give rising frequencies")]
    Falling {
        /// Index of the row.
        row: usize,
        /// Frequency [Hz].
        frequency_hz: f64,
        /// Frequency before, or zero.
        before_hz: f64,
    },
    /// A density that is negative or not finite.
    #[error("the density {density} m²/s is negative or not finite: a spectral density is zero or more")]
    Density {
        /// Index of the row.
        row: usize,
        /// Density [m²/s].
        density: f64,
    },
}

impl MeasuredSpectrum {
    /// Maximum number of rows: the response is computed at each, in about a millisecond.
    pub const MAX_ROWS: usize = 2000;

    /// Spectrum from ascending frequencies [Hz] and the densities of the components at each [m²/s].
    ///
    /// # Errors
    /// [`MeasuredSpectrumError`].
    pub fn new(frequencies_hz: Vec<f64>, densities: Vec<[f64; 3]>) -> Result<Self, MeasuredSpectrumError> {
        let count = frequencies_hz.len().min(densities.len());
        if !(2..=Self::MAX_ROWS).contains(&count) {
            return Err(MeasuredSpectrumError::Rows { count });
        }
        let mut before_hz = 0.0;
        for (row, frequency_hz) in frequencies_hz.iter().copied().enumerate() {
            if !(frequency_hz > before_hz && frequency_hz.is_finite()) {
                return Err(MeasuredSpectrumError::Falling { row, frequency_hz, before_hz });
            }
            before_hz = frequency_hz;
        }
        for (row, of_row) in densities.iter().enumerate() {
            if let Some(density) = of_row.iter().copied().find(|density| !(*density >= 0.0 && density.is_finite())) {
                return Err(MeasuredSpectrumError::Density { row, density });
            }
        }
        Ok(Self { frequencies_hz, densities })
    }

    /// Measured frequencies [Hz], ascending.
    pub fn frequencies_hz(&self) -> &[f64] {
        &self.frequencies_hz
    }

    /// Density of a component at a frequency [Hz], [m²/s]; beyond the last frequency that of the last.
    pub fn density(&self, component: usize, frequency_hz: f64) -> f64 {
        let (at, of) = (&self.frequencies_hz, |row: usize| self.densities[row][component]);
        let next = at.partition_point(|hz| *hz <= frequency_hz);
        if next == 0 || next == at.len() {
            return of(next.saturating_sub(1));
        }
        let part = (frequency_hz - at[next - 1]) / (at[next] - at[next - 1]);
        of(next - 1) * (1.0 - part) + of(next) * part
    }

    /// Variance of a component up to the last frequency [m²/s²].
    pub fn variance(&self, component: usize) -> f64 {
        let below = self.frequencies_hz[0] * self.densities[0][component];
        let between = |k: usize| {
            let width = self.frequencies_hz[k] - self.frequencies_hz[k - 1];
            0.5 * width * (self.densities[k - 1][component] + self.densities[k][component])
        };
        below + (1..self.densities.len()).map(between).sum::<f64>()
    }
}

/// Shape of the spectra of turbulence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TurbulenceSpectrum {
    /// Kaimal, in the form of IEC 61400-1.
    Kaimal,
    /// Von Kármán, isotropic at high frequencies.
    VonKarman,
}

impl TurbulenceSpectrum {
    /// Words of the robot file, with their meaning.
    pub const WORDS: [(&'static str, &'static str); 2] =
        [("kaimal", "Kaimal, as in IEC 61400-1"), ("von-karman", "von Kármán")];

    /// Spectra, in the order of their words.
    const ALL: [Self; 2] = [Self::Kaimal, Self::VonKarman];

    /// Spectrum of a word of the robot file.
    pub(crate) fn of_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|of| of.word() == word)
    }

    /// Word of the robot file.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize].0
    }
}

impl Turbulence {
    /// Decay of the coherence that is usual for wind across the distance (Davenport).
    pub const COHERENCE_DECAY: [f64; 3] = [0.0, 10.0, 10.0];

    /// Highest intensity. Beyond it the wind turns round now and then, and drag is not linear in the gusts.
    pub const MAX_INTENSITY: f64 = 0.5;

    /// One-sided spectral density of a component (0 along, 1 lateral, 2 up) at a frequency [Hz] in a mean wind of a
    /// speed [m/s], over the variance of the component [1/Hz]. Its integral over all frequencies is 1, to the rounding
    /// of the published constants, 1.5e-4.
    ///
    /// # References
    /// docs/theory.md, equations (49f) and (49g).
    pub fn density_over_variance(&self, component: usize, frequency_hz: f64, speed: f64) -> f64 {
        let time = self.length_scale[component] / speed;
        let n = frequency_hz * time;
        let shape = match (self.spectrum, component) {
            (TurbulenceSpectrum::Kaimal, _) => (1.0 + 6.0 * n).powf(-5.0 / 3.0),
            (TurbulenceSpectrum::VonKarman, 0) => (1.0 + 70.8 * n * n).powf(-5.0 / 6.0),
            (TurbulenceSpectrum::VonKarman, _) => (1.0 + 755.2 * n * n) * (1.0 + 283.2 * n * n).powf(-11.0 / 6.0),
        };
        4.0 * time * shape
    }

    /// One-sided spectral density of a component at a frequency [Hz] in a mean wind of a speed [m/s], [m²/s].
    pub fn density(&self, component: usize, frequency_hz: f64, speed: f64) -> f64 {
        if let Some(measured) = &self.measured {
            return measured.density(component, frequency_hz);
        }
        let deviation = self.intensity[component] * speed;
        deviation * deviation * self.density_over_variance(component, frequency_hz, speed)
    }

    /// Distance over which the coherence falls to 1/e at 1 Hz and 1 m/s, inverse: the root of Σ (C_a Δ_a)² for a
    /// distance along the mean wind, lateral and up [m].
    ///
    /// # References
    /// docs/theory.md, equation (49h).
    pub(crate) fn weighted_distance(&self, distance: [f64; 3]) -> f64 {
        let square: f64 = distance.iter().zip(self.coherence_decay).map(|(d, decay)| (d * decay).powi(2)).sum();
        square.sqrt()
    }

    /// Phase [rad] by which the gusts at a place this far downstream [m] lag behind, at a frequency [Hz] and a mean
    /// speed [m/s].
    pub(crate) fn lag(&self, downstream: f64, frequency_hz: f64, speed: f64) -> f64 {
        if self.is_frozen { TAU * frequency_hz * downstream / speed } else { 0.0 }
    }
}
