//! Wind over time at the platform and along each rope: the mean, and gusts as a sum of waves with random phases.

use crate::gust::{GustError, GustPlace, TurbulentField};
use crate::math::{Complex, DMat, Vec3};
use crate::robot::{Robot, Wind};
use std::borrow::Cow;
use std::cell::RefCell;
use std::f64::consts::TAU;

/// Maximum frequency of simulated gusts [Hz]: slow against the waves that a step of the ropes resolves. Parts of a
/// platform's motion that are faster are left out.
pub(super) const MAX_GUST_HZ: f64 = 10.0;
/// Minimum and maximum number of waves. There are two for each frequency that the duration tells apart; below the
/// minimum the sum of a few waves is not normal, and the maximum is that of 100 s.
const WAVES: [f64; 2] = [300.0, 2000.0];
/// Part of a coherence matrix on its diagonal that keeps it positive where places see the same gusts.
const RIDGE: f64 = 1e-12;

/// Wind at the platform and at each rope.
#[derive(Debug, Clone)]
pub(super) struct Air {
    mean: Wind,
    gusts: Option<DrawnGusts>,
    /// First place of each rope and the number of its places.
    places: Vec<(usize, usize)>,
}

/// Waves of the gusts. The platform is the first place.
#[derive(Debug, Clone)]
struct DrawnGusts {
    /// Angular frequencies [rad/s].
    omegas: Vec<f64>,
    /// Amplitudes of cosine and sine at each place, a row of all waves for each, world axes [m/s].
    amplitudes: Vec<Vec<[Vec3; 2]>>,
    /// Bits of the time of the last call, and the cosines and sines at it.
    phases: RefCell<(u64, Vec<[f64; 2]>)>,
}

impl Air {
    /// Wind without gusts.
    pub(super) fn steady(mean: Wind, ropes: usize) -> Self {
        Self { mean, gusts: None, places: vec![(0, 1); ropes] }
    }

    /// Wind with the gusts of a robot's turbulence from a seed, at the platform and at places along each rope.
    ///
    /// # References
    /// docs/theory.md, equation (97q).
    pub(super) fn gusty(
        robot: &Robot,
        platform_w: Vec3,
        ropes: &[Vec<[Vec3; 2]>],
        (duration, seed): (f64, u64),
    ) -> Result<Self, GustError> {
        let field = TurbulentField::of(robot)?;
        let mut all = vec![GustPlace { center_w: platform_w, extent_w: Vec3::zeros() }];
        let mut places = Vec::new();
        for rope in ropes {
            places.push((all.len(), rope.len()));
            all.extend(rope.iter().map(|[from, to]| GustPlace { center_w: (from + to) * 0.5, extent_w: to - from }));
        }
        Ok(Self { mean: robot.wind, gusts: Some(DrawnGusts::new(&field, &all, duration, seed)), places })
    }

    /// Adds a rope that has the wind of another one.
    pub(super) fn add_rope_like(&mut self, rope: usize) {
        self.places.push(self.places[rope]);
    }

    /// Mean velocity [m/s].
    pub(super) fn mean_w(&mut self) -> &mut Vec3 {
        &mut self.mean.velocity_w
    }

    fn at(&self, place: usize, time: f64) -> Wind {
        let gust_w = self.gusts.as_ref().map_or_else(Vec3::zeros, |gusts| gusts.at(place, time));
        Wind { velocity_w: self.mean.velocity_w + gust_w, ..self.mean }
    }

    pub(super) fn on_body(&self, time: f64) -> Wind {
        self.at(0, time)
    }

    /// Wind at each place of a rope, from the platform on.
    pub(super) fn on_rope(&self, rope: usize, time: f64) -> Cow<'_, [Wind]> {
        if self.gusts.is_none() {
            return Cow::Borrowed(std::slice::from_ref(&self.mean));
        }
        let (first, count) = self.places[rope];
        Cow::Owned((first..first + count).map(|place| self.at(place, time)).collect())
    }
}

impl DrawnGusts {
    fn new(field: &TurbulentField, places: &[GustPlace], duration: f64, seed: u64) -> Self {
        let mut random = fastrand::Rng::with_seed(seed);
        let count = (2.0 * duration * MAX_GUST_HZ).clamp(WAVES[0], WAVES[1]) as usize;
        let width = MAX_GUST_HZ / count as f64;
        let distances = field.distances(places);
        let mut gusts = Self {
            omegas: Vec::with_capacity(count),
            amplitudes: vec![Vec::with_capacity(count); places.len()],
            phases: RefCell::new((f64::NAN.to_bits(), Vec::new())),
        };
        for k in 0..count {
            // Somewhere in its interval, so that the sum has no period.
            let frequency_hz = (k as f64 + random.f64().max(1e-3)) * width;
            let mut coherence = DMat::identity(places.len(), places.len()) * RIDGE;
            field.for_coherences(&distances, frequency_hz, |p, q, of| {
                coherence[(p, q)] += of;
                if p != q {
                    coherence[(q, p)] += of;
                }
            });
            let Some(root) = coherence.cholesky().map(|of| of.l()) else { continue };
            gusts.omegas.push(TAU * frequency_hz);
            let densities = field.densities(frequency_hz);
            let mut of_places = vec![[Vec3::zeros(); 2]; places.len()];
            for (component, density) in densities.into_iter().enumerate() {
                let direction_w = field.axes.column(component).into_owned();
                let size = (2.0 * density * width).sqrt();
                let phases: Vec<Complex> =
                    places.iter().map(|_| Complex::from_polar(size, TAU * random.f64())).collect();
                for (p, of) in of_places.iter_mut().enumerate() {
                    let sum: Complex = (0..=p).map(|q| phases[q] * root[(p, q)]).sum();
                    let wave = sum * field.factor(&places[p], frequency_hz);
                    // Re(wave e^{iωt}).
                    of[0] += direction_w * wave.re;
                    of[1] -= direction_w * wave.im;
                }
            }
            for (row, of) in gusts.amplitudes.iter_mut().zip(of_places) {
                row.push(of);
            }
        }
        gusts
    }

    fn at(&self, place: usize, time: f64) -> Vec3 {
        let mut phases = self.phases.borrow_mut();
        if phases.0 != time.to_bits() {
            let at = |omega: &f64| {
                let (sine, cosine) = (omega * time).sin_cos();
                [cosine, sine]
            };
            *phases = (time.to_bits(), self.omegas.iter().map(at).collect());
        }
        let mut sum = Vec3::zeros();
        for ([cosine_w, sine_w], [cosine, sine]) in self.amplitudes[place].iter().zip(&phases.1) {
            sum += cosine_w * *cosine + sine_w * *sine;
        }
        sum
    }
}
