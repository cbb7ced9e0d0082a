//! Input shapers: a command is split into a few parts that follow each other, so that the vibrations that they excite
//! in one mode cancel (docs/theory.md, equations (46l) and (46m)).

use crate::math::Complex;
use std::f64::consts::TAU;

/// Part of a command, and the time by which it is late [s].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impulse {
    /// Delay [s].
    pub time: f64,
    /// Part of the command; all parts of a shaper add up to one.
    pub amplitude: f64,
}

/// Kind of a shaper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ShaperKind {
    /// No vibration at the frequency of the mode: two impulses over half a period.
    Zv,
    /// No vibration and no slope of it over the frequency: three impulses over a period.
    Zvd,
    /// At the frequency of the mode this fraction of the vibration, and as little over a wider range of frequencies:
    /// three impulses over a period.
    Ei(f64),
}

/// Input shaper.
///
/// # References
/// N. C. Singer, W. P. Seering, J. Dyn. Syst. Meas. Control 112(1), 1990 (ZV, ZVD); W. Singhose, W. Seering, N. Singer,
/// J. Mech. Des. 116(2), 1994 (EI); docs/theory.md, section 13.
#[derive(Debug, Clone, PartialEq)]
pub struct Shaper {
    /// Impulses, ascending in time.
    pub impulses: Vec<Impulse>,
}

impl Shaper {
    /// Shaper that changes nothing.
    pub fn none() -> Self {
        Self { impulses: vec![Impulse { time: 0.0, amplitude: 1.0 }] }
    }

    /// Shaper for a damped mode with the complex frequency ω [rad/s], λ = iω; `None` for a motion that does not
    /// oscillate.
    pub fn of_mode(kind: ShaperKind, omega: Complex) -> Option<Self> {
        if omega.re <= 0.0 || !omega.re.is_finite() {
            return None;
        }
        let half = 0.5 * TAU / omega.re;
        // Decay within half a period.
        let k = (-omega.im * half).exp();
        let parts = match kind {
            ShaperKind::Zv => vec![1.0, k],
            ShaperKind::Zvd => vec![1.0, 2.0 * k, k * k],
            ShaperKind::Ei(v) => vec![0.25 * (1.0 + v), 0.5 * k * (1.0 - v), 0.25 * k * k * (1.0 + v)],
        };
        let sum: f64 = parts.iter().sum();
        let at = |(i, part): (usize, f64)| Impulse { time: half * i as f64, amplitude: part / sum };
        Some(Self { impulses: parts.into_iter().enumerate().map(at).collect() })
    }

    /// Shaper made of two, one after the other: their zeros together, their lengths added.
    #[must_use]
    pub fn convolved(&self, other: &Self) -> Self {
        let mut impulses: Vec<Impulse> = (self.impulses.iter())
            .flat_map(|a| {
                other.impulses.iter().map(|b| Impulse { time: a.time + b.time, amplitude: a.amplitude * b.amplitude })
            })
            .collect();
        impulses.sort_by(|a, b| a.time.total_cmp(&b.time));
        Self { impulses }
    }

    /// Time by which it makes a command longer [s].
    pub fn duration(&self) -> f64 {
        self.impulses.iter().map(|impulse| impulse.time).fold(0.0, f64::max)
    }

    /// Part of the vibration of a mode with the complex frequency ω [rad/s] that is left at the end of the shaper,
    /// relative to that of the same command without it at its own end, which is earlier.
    pub fn left(&self, omega: Complex) -> f64 {
        self.at_end(Complex::i() * omega).norm()
    }

    /// `Σ A_j e^{λ(t_n − t_j)}`, with the last time t_n.
    pub(crate) fn at_end(&self, lambda: Complex) -> Complex {
        let end = self.duration();
        self.impulses.iter().map(|impulse| (lambda * (end - impulse.time)).exp() * impulse.amplitude).sum()
    }
}
