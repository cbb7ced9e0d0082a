//! Wind over time at the ropes and the platform: the mean, and gusts as a sum of waves with random phases.

use crate::math::Vec3;
use crate::robot::Wind;

/// Wind at the platform and at each rope.
#[derive(Debug, Clone)]
pub(super) struct Air {
    pub(super) mean: Wind,
    /// Waves of the gusts; empty without gusts.
    pub(super) waves: Vec<Wave>,
}

/// One wave of the gusts, the same everywhere.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wave {
    /// Angular frequency [rad/s].
    pub(super) omega: f64,
    /// Amplitude of the cosine, world axes [m/s].
    pub(super) cosine_w: Vec3,
    /// Amplitude of the sine, world axes [m/s].
    pub(super) sine_w: Vec3,
}

impl Air {
    pub(super) fn steady(mean: Wind) -> Self {
        Self { mean, waves: Vec::new() }
    }

    fn at(&self, time: f64) -> Wind {
        let mut velocity_w = self.mean.velocity_w;
        for wave in &self.waves {
            let (sine, cosine) = (wave.omega * time).sin_cos();
            velocity_w += wave.cosine_w * cosine + wave.sine_w * sine;
        }
        Wind { velocity_w, ..self.mean }
    }

    pub(super) fn on_body(&self, time: f64) -> Wind {
        self.at(time)
    }

    pub(super) fn on_rope(&self, _rope: usize, time: f64) -> Wind {
        self.at(time)
    }
}
