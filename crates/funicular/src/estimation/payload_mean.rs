//! Payload from means of measured tensions, which do not ring.

use super::kalman::Kalman;
use super::model::split;
use super::readings::SensorReadings;
use super::state::StatePlaces;
use crate::control_loop::MAX_CABLES;
use crate::math::{Vec3, Vec6};
use crate::platform::{load_wrench, wrench_of};

/// Shortest time whose mean tells a payload [s]: three periods of the slowest usual mode.
const MIN_TIME: f64 = 0.5;

/// Part of the speed of a vibration by which the estimated velocity may be wrong.
const VELOCITY_ERROR: f64 = 0.1;

/// Sums since a payload was taken up or put down.
///
/// # References
/// docs/theory.md, equation (97y).
#[derive(Debug, Clone)]
pub(super) struct PayloadWindow {
    time: f64,
    count: usize,
    /// Sum of the wrenches that payload and external wrench have to balance.
    sum: Vec6,
    /// Sums of the unit wrenches of the cables.
    pulls: [Vec6; MAX_CABLES],
    start: Vec6,
}

impl PayloadWindow {
    pub(super) fn new(kalman: &Kalman) -> Self {
        Self { time: 0.0, count: 0, sum: Vec6::zeros(), pulls: [Vec6::zeros(); MAX_CABLES], start: kalman.mean.twist }
    }

    /// Adds the readings of one time; they count if all tensions are there.
    pub(super) fn add(&mut self, kalman: &Kalman, readings: &SensorReadings, step: f64) {
        self.time += step;
        let cables = &kalman.at.cables;
        if !readings.tensions[..cables.len()].iter().all(|tension| tension.is_finite()) {
            return;
        }
        let mut total = load_wrench(&kalman.of.robot, &kalman.mean.pose);
        for (i, cable) in cables.iter().enumerate() {
            let measured = readings.tensions[i] - kalman.mean.tension_biases[i];
            let at_platform = measured - (cable.tension - cable.tension_platform);
            let pull = wrench_of(&cable.direction, &cable.lever);
            total += pull * at_platform;
            self.pulls[i] += pull;
        }
        self.sum -= total;
        self.count += 1;
    }

    /// Gives the filter the payload of the means, if the time is long enough; `vibration` is the speed of what rings
    /// [m/s].
    pub(super) fn apply(&self, kalman: &mut Kalman, vibration: f64) -> bool {
        let gravity = kalman.of.robot.gravity_w;
        let size2 = gravity.norm_squared();
        if self.time < MIN_TIME || self.count < 10 || size2 == 0.0 {
            return false;
        }
        let count = self.count as f64;
        let slowing = kalman.at.mass * (kalman.mean.twist - self.start) / self.time;
        let (force, moment) = split(&(self.sum / count + slowing));

        // Payload and first moment per unit of a wrench.
        let to_platform = kalman.mean.pose.rot_wp.inverse();
        let of_wrench = |force: &Vec3, moment: &Vec3| -> [f64; 4] {
            let first = to_platform * (gravity.cross(moment) / size2);
            [force.dot(&gravity) / size2, first.x, first.y, first.z]
        };
        let found = of_wrench(&force, &moment);
        let mut by_bias = [[0.0; 4]; MAX_CABLES];
        for (i, by) in by_bias.iter_mut().enumerate().take(kalman.places.cables) {
            let (force, moment) = split(&(self.pulls[i] / count));
            *by = of_wrench(&force, &moment);
        }

        // Errors that are not biases: noise of the cells, the external wrench, and the velocity at the ends.
        let settings = kalman.settings;
        let ratio = self.time / settings.process.wrench_time;
        let wrench_part = (2.0 / ratio * (1.0 - (1.0 - (-ratio).exp()) / ratio)).min(1.0);
        let along = gravity.normalize();
        let velocity_std =
            (0..3).map(|k| along[k] * along[k] * kalman.covariance.variance(StatePlaces::VELOCITY + k)).sum::<f64>();
        let ends = 2.0 * velocity_std.max((VELOCITY_ERROR * vibration).powi(2)) / self.time.powi(2);
        let mass = kalman.at.mass[(0, 0)];
        let vertical_p = to_platform * along;
        let cell = settings.noise.tension.powi(2) / count;
        let noise = |a: usize, b: usize| -> f64 {
            let of_cells: f64 = by_bias.iter().map(|by| by[a] * by[b]).sum::<f64>() * cell;
            let of_wrench = match (a, b) {
                (0, 0) => (settings.priors.force.powi(2) * wrench_part + mass * mass * ends) / size2,
                (0, _) | (_, 0) => 0.0,
                _ => {
                    let level = f64::from(u8::from(a == b)) - vertical_p[a - 1] * vertical_p[b - 1];
                    let upright = vertical_p[a - 1] * vertical_p[b - 1] * settings.priors.first_moment.powi(2);
                    let inertia = mass * mass * ends / size2;
                    level * (settings.priors.moment.powi(2) * wrench_part / size2 + inertia) + upright
                }
            };
            of_cells + of_wrench
        };

        kalman.set_payload(&found, &by_bias, noise);
        true
    }
}

impl Kalman {
    /// Forgets payload and first moment.
    pub(super) fn reopen_payload(&mut self, payload: f64, first_moment: f64) {
        self.covariance.reopen(StatePlaces::PAYLOAD, payload * payload);
        for k in 0..3 {
            self.covariance.reopen(StatePlaces::FIRST_MOMENT + k, first_moment * first_moment);
        }
    }

    /// Covariance of a state with the part of payload or first moment that the biases of the tensions have.
    fn of_biases(&self, by_bias: &[[f64; 4]; MAX_CABLES], part: usize, state: usize) -> f64 {
        let first = self.places.tension_biases();
        let cables = by_bias.iter().enumerate().take(self.places.cables);
        cables.map(|(i, by)| by[part] * self.covariance.at(first + i, state)).sum()
    }

    /// Sets payload and first moment. Their errors are those of the biases of the tensions times `by_bias`, and
    /// `noise`.
    fn set_payload(&mut self, found: &[f64; 4], by_bias: &[[f64; 4]; MAX_CABLES], noise: impl Fn(usize, usize) -> f64) {
        let n = self.places.size();
        let first = StatePlaces::PAYLOAD;
        let is_payload = |j: usize| (first..StatePlaces::OFFSETS).contains(&j);
        for j in (0..n).filter(|j| !is_payload(*j)) {
            for a in 0..4 {
                let value = self.of_biases(by_bias, a, j);
                self.covariance.put(first + a, j, value);
            }
        }
        for a in 0..4 {
            for b in 0..=a {
                let value = self.of_biases(by_bias, a, first + b) + noise(a, b);
                self.covariance.put(first + a, first + b, value);
            }
        }
        self.mean.load.mass = found[0];
        self.mean.load.moment_p = Vec3::new(found[1], found[2], found[3]);
    }
}
