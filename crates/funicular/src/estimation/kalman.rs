//! Kalman filter: prediction by the exponential of the tangent, and updates by groups of rows.

use super::consistency::{GroupResult, chi2_quantile};
use super::covariance::{Covariance, MOTION};
use super::exponential::{Mat12, StepExponential};
use super::model::{EstimatedRobot, Tangents, gravity_of, split};
use super::readings::{SensorGroup, SensorReadings};
use super::rows::{MAX_ROWS, RowContext, RowGroup, expected_tension, tension_row};
use super::settings::EstimationSettings;
use super::start::{EstimationError, MAX_GAP, moved};
use super::state::{Estimate, StateMean, StatePlaces};
use crate::control_loop::MAX_CABLES;
use crate::math::{Mat6, Vec3, Vec6, skew};
use crate::platform::wrench_of;

/// Probability with which a true reading is left out as an outlier.
const GATE: f64 = 1e-6;

/// Time without a reading of a length from which on the cable's own motion adds to its error [s].
const SHORT_GAP: f64 = 0.02;

/// Additional noise while hypotheses are compared: variance per step of one or more states.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct StepNoise {
    pub(super) places: [usize; 4],
    pub(super) variances: [f64; 4],
    pub(super) count: usize,
}

/// Lower Cholesky factor of the covariance of the innovations of the load cells, and the cables of its rows.
#[derive(Debug, Clone)]
pub(super) struct TensionFactor {
    entries: [f64; MAX_CABLES * MAX_CABLES],
    rows: [usize; MAX_CABLES],
    count: usize,
}

impl TensionFactor {
    const NONE: Self = Self { entries: [0.0; MAX_CABLES * MAX_CABLES], rows: [0; MAX_CABLES], count: 0 };

    /// Takes the factor of a group with rows of these cables.
    fn take(&mut self, factor: &[f64; MAX_ROWS * MAX_ROWS], rows: &[usize]) {
        self.count = rows.len();
        self.rows[..rows.len()].copy_from_slice(rows);
        for k in 0..rows.len() {
            self.entries[k * MAX_CABLES..][..=k].copy_from_slice(&factor[k * MAX_ROWS..][..=k]);
        }
    }

    /// Cables of the rows.
    pub(super) fn rows(&self) -> &[usize] {
        &self.rows[..self.count]
    }

    /// Deviation of the innovation of a row.
    pub(super) fn deviation(&self, k: usize) -> f64 {
        self.entries[k * MAX_CABLES..][..=k].iter().map(|entry| entry * entry).sum::<f64>().sqrt()
    }

    /// Innovations with the unit matrix as their covariance.
    pub(super) fn whitened(&self, innovations: &[f64; MAX_CABLES]) -> [f64; MAX_CABLES] {
        let mut white = [0.0; MAX_CABLES];
        for k in 0..self.count {
            let row = &self.entries[k * MAX_CABLES..][..=k];
            let before: f64 = row[..k].iter().zip(&white).map(|(entry, white)| entry * white).sum();
            white[k] = (innovations[k] - before) / row[k];
        }
        white
    }
}

/// Filter with everything that one update needs.
#[derive(Debug, Clone)]
pub(super) struct Kalman {
    pub(super) of: EstimatedRobot,
    pub(super) settings: EstimationSettings,
    pub(super) places: StatePlaces,
    pub(super) mean: StateMean,
    pub(super) covariance: Covariance,
    pub(super) at: Tangents,
    /// Readings of the lengths, their rates with offsets [m/s], and times since they were read [s].
    pub(super) readings: [f64; MAX_CABLES],
    pub(super) rates: [f64; MAX_CABLES],
    pub(super) silent: [f64; MAX_CABLES],
    /// Last time step [s], and variances of the errors of the encoders before it.
    pub(super) step: f64,
    errors_before: [f64; MAX_CABLES],
    pub(super) acceleration: Vec6,
    pub(super) largest_acceleration: f64,
    /// Payload and first moment are considered, not estimated.
    pub(super) holds_payload: bool,
    /// Factor on the white force, and additional deviation of tensions [N], while ropes vibrate.
    pub(super) force_factor: f64,
    pub(super) rope_tension: f64,
    pub(super) added: StepNoise,
    pub(super) tension_factor: TensionFactor,
    group: RowGroup,
    error: Vec<f64>,
    gain: Vec<f64>,
    motion: Vec<f64>,
    decay: Vec<f64>,
    products: Vec<f64>,
}

impl Kalman {
    pub(super) fn new(
        of: EstimatedRobot,
        settings: EstimationSettings,
        mean: &StateMean,
        at: Tangents,
        readings: [f64; MAX_CABLES],
    ) -> Self {
        let places = StatePlaces { cables: of.cables() };
        let n = places.size();
        Self {
            of,
            settings,
            places,
            mean: *mean,
            covariance: Covariance::new(n),
            at,
            readings,
            rates: [0.0; MAX_CABLES],
            silent: [0.0; MAX_CABLES],
            step: MAX_GAP,
            errors_before: [0.0; MAX_CABLES],
            acceleration: Vec6::zeros(),
            largest_acceleration: 0.0,
            holds_payload: false,
            force_factor: 1.0,
            rope_tension: 0.0,
            added: StepNoise::default(),
            tension_factor: TensionFactor::NONE,
            group: RowGroup::new(n),
            error: vec![0.0; n],
            gain: vec![0.0; n],
            motion: vec![0.0; MOTION * n],
            decay: vec![1.0; n],
            products: vec![0.0; MAX_ROWS * n],
        }
    }

    /// Takes the state of another filter of the same robot, without memory from the heap.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.mean = other.mean;
        self.covariance.copy_from(&other.covariance);
        self.at.clone_from(&other.at);
        (self.readings, self.rates, self.silent) = (other.readings, other.rates, other.silent);
        (self.step, self.errors_before) = (other.step, other.errors_before);
        (self.acceleration, self.largest_acceleration) = (other.acceleration, other.largest_acceleration);
        self.holds_payload = other.holds_payload;
        (self.force_factor, self.rope_tension) = (other.force_factor, other.rope_tension);
    }

    /// Lengths with offsets and errors of the encoders [m].
    pub(super) fn lengths(&self) -> [f64; MAX_CABLES] {
        let mean = &self.mean;
        std::array::from_fn(|i| self.readings[i] + mean.offsets[i] + mean.encoder_errors[i])
    }

    /// Tangents at the mean.
    pub(super) fn refresh(&mut self) -> Result<(), EstimationError> {
        let (lengths, m) = (self.lengths(), self.places.cables);
        let found = self.of.at(&self.mean.pose, &lengths[..m], &self.mean.load, Some(&self.at));
        self.at = found.ok_or(EstimationError::Diverged)?;
        Ok(())
    }

    /// Takes new readings of the lengths; those that are missing go on at their rates. Returns the variances of the
    /// errors of the encoders.
    fn take_lengths(&mut self, lengths: &[f64; MAX_CABLES], step: f64) -> Result<[f64; MAX_CABLES], EstimationError> {
        let before = self.lengths();
        let noise = self.settings.noise.length;
        let mut variances = [0.0; MAX_CABLES];
        for i in 0..self.places.cables {
            if lengths[i].is_finite() {
                (self.readings[i], self.silent[i]) = (lengths[i], 0.0);
                self.rates[i] = (self.readings[i] + self.mean.offsets[i] - before[i]) / step;
                variances[i] = noise * noise;
            } else {
                self.silent[i] += step;
                self.readings[i] = before[i] - self.mean.offsets[i] + self.rates[i] * step;
                let gap = if self.silent[i] > SHORT_GAP { self.silent[i] } else { 0.0 };
                variances[i] = noise * noise + (self.rates[i] * gap).powi(2);
            }
        }
        let gap = self.silent[..self.places.cables].iter().copied().fold(f64::INFINITY, f64::min);
        if gap > MAX_GAP {
            return Err(EstimationError::EncodersLost { gap });
        }
        Ok(variances)
    }

    /// Moves the state to a time `step` later, at which the lengths are read.
    ///
    /// # References
    /// docs/theory.md, equations (97t) to (97v).
    pub(super) fn predict(&mut self, lengths: &[f64; MAX_CABLES], step: f64) -> Result<(), EstimationError> {
        let variances = self.take_lengths(lengths, step)?;
        for i in 0..self.places.cables {
            self.errors_before[i] = self.covariance.variance(self.places.encoder_errors() + i);
        }
        let m = self.places.cables;
        let inverse = self.at.inverse_mass;
        let acceleration = self.at.acceleration(&self.of, &self.mean.twist, &self.rates[..m]);
        let exponential = StepExponential::of(&self.tangent(), step);

        // Mean.
        let mut pull = Vec6::zeros();
        for i in 0..m {
            pull += self.at.wrench_by_length(i) * self.rates[i];
        }
        let pull = inverse * self.of.allowed(&pull);
        let twist = self.mean.twist;
        let mut change = [0.0; MOTION];
        for (k, change) in change.iter_mut().enumerate() {
            *change = (0..6)
                .map(|j| {
                    exponential.once[(k, j)] * twist[j]
                        + exponential.once[(k, j + 6)] * acceleration[j]
                        + exponential.twice[(k, j + 6)] * pull[j]
                })
                .sum();
        }

        let entering = self.set_columns(&exponential, &acceleration, step);
        let mut noise = self.white_noise(&exponential, step);
        for (of, variance) in entering.iter().zip(variances).take(m) {
            for k in 0..MOTION {
                for j in 0..MOTION {
                    noise[(k, j)] += of[k] * of[j] * variance;
                }
            }
        }
        let kept = (-step / self.settings.process.wrench_time).exp();
        self.decay.fill(1.0);
        self.decay[StatePlaces::WRENCH..StatePlaces::PAYLOAD].fill(kept);
        self.decay[self.places.encoder_errors()..].fill(0.0);
        self.covariance.propagate(&self.motion, &self.decay, &noise);
        for i in 0..m {
            let place = self.places.encoder_errors() + i;
            self.covariance.put(place, place, variances[i]);
            (0..MOTION).for_each(|k| self.covariance.put(k, place, entering[i][k] * variances[i]));
        }
        self.add_walks(step, kept);

        // The mean moves last: everything above belongs to the begin of the step.
        self.mean.pose = moved(&self.mean.pose, &Vec6::from_fn(|k, _| change[k]));
        self.mean.twist += Vec6::from_fn(|k, _| change[k + 6]);
        self.mean.load.wrench *= kept;
        self.mean.encoder_errors = [0.0; MAX_CABLES];
        self.step = step;
        self.refresh()?;
        self.acceleration = self.at.acceleration(&self.of, &self.mean.twist, &self.rates[..m]);
        let size = self.acceleration.fixed_rows::<3>(0).norm();
        self.largest_acceleration = size.max(self.largest_acceleration * (-step / 0.5).exp());
        Ok(())
    }

    /// Sets the columns of the motion over a step by the whole state before it. Returns those of the errors of the
    /// encoders at its end.
    fn set_columns(
        &mut self,
        exponential: &StepExponential,
        acceleration: &Vec6,
        step: f64,
    ) -> [[f64; MOTION]; MAX_CABLES] {
        let (m, n) = (self.places.cables, self.places.size());
        let inverse = self.at.inverse_mass;
        self.motion.fill(0.0);
        for k in 0..MOTION {
            for j in 0..MOTION {
                self.motion[k * n + j] = exponential.whole[(k, j)];
            }
        }
        let lower = |of: &Mat12, force: &Vec6| -> [f64; MOTION] {
            std::array::from_fn(|k| (0..6).map(|j| of[(k, j + 6)] * force[j]).sum())
        };
        let columns = self.load_columns(acceleration);
        for (c, wrench) in columns.iter().enumerate() {
            let column = lower(&exponential.once, &(inverse * self.of.allowed(wrench)));
            (0..MOTION).for_each(|k| self.motion[k * n + StatePlaces::WRENCH + c] = column[k]);
        }
        let mut entering = [[0.0; MOTION]; MAX_CABLES];
        for (i, of) in entering.iter_mut().enumerate().take(m) {
            let by_length = inverse * self.of.allowed(&self.at.wrench_by_length(i));
            let cable = &self.at.cables[i];
            let by_rate = wrench_of(&(cable.direction * -cable.damping), &cable.lever);
            let by_rate = inverse * self.of.allowed(&by_rate);
            let (once, twice) = (lower(&exponential.once, &by_length), lower(&exponential.twice, &by_length));
            let damped = lower(&exponential.once, &by_rate);
            for k in 0..MOTION {
                of[k] = (twice[k] + damped[k]) / step;
                self.motion[k * n + StatePlaces::OFFSETS + i] = once[k];
                self.motion[k * n + self.places.encoder_errors() + i] = once[k] - of[k];
            }
        }
        entering
    }

    /// Tangent of the motion, (97t).
    fn tangent(&self) -> Mat12 {
        let mut tangent = Mat12::zeros();
        tangent.fixed_view_mut::<6, 6>(0, 6).copy_from(&Mat6::identity());
        let (_, turn) = split(&self.mean.twist);
        tangent.fixed_view_mut::<3, 3>(3, 3).copy_from(&skew(&turn));
        let inverse = self.at.inverse_mass;
        let moves = self.of.coordinates.allowed_matrix(&Mat6::identity());
        tangent.fixed_view_mut::<6, 6>(6, 0).copy_from(&(-(inverse * moves * self.at.stiffness * moves)));
        tangent.fixed_view_mut::<6, 6>(6, 6).copy_from(&(-(inverse * self.at.damping)));
        tangent
    }

    /// Wrenches per unit of wrench, payload and first moment, less what their inertia takes.
    fn load_columns(&self, acceleration: &Vec6) -> [Vec6; 10] {
        let (linear, angular) = split(acceleration);
        let felt = self.of.robot.gravity_w - linear;
        std::array::from_fn(|c| match c {
            0..6 => Vec6::from_fn(|k, _| if k == c { 1.0 } else { 0.0 }),
            6 => gravity_of(&felt, 1.0, &Vec3::zeros()),
            _ => {
                let axis = self.mean.pose.rot_wp * Vec3::ith(c - 7, 1.0);
                let mut wrench = gravity_of(&felt, 0.0, &axis);
                let force = angular.cross(&axis);
                (0..3).for_each(|k| wrench[k] -= force[k]);
                wrench
            }
        })
    }

    /// Covariance that white forces give the motion over a step, by Simpson's rule.
    fn white_noise(&self, exponential: &StepExponential, step: f64) -> Mat12 {
        let process = &self.settings.process;
        let inverse = self.at.inverse_mass;
        let moves = self.of.coordinates.allowed_matrix(&Mat6::identity());
        let density = Mat6::from_diagonal(&Vec6::from_fn(|k, _| {
            self.force_factor * if k < 3 { process.force } else { process.moment }
        }));
        let mut first = Mat12::zeros();
        let density = inverse * moves * density * moves * inverse.transpose();
        first.fixed_view_mut::<6, 6>(6, 6).copy_from(&density);
        let (half, whole) = (&exponential.half, &exponential.whole);
        (first + half * first * half.transpose() * 4.0 + whole * first * whole.transpose()) * (step / 6.0)
    }

    /// Noise of what changes slowly.
    fn add_walks(&mut self, step: f64, kept: f64) {
        let EstimationSettings { process, priors, .. } = self.settings;
        let places = self.places;
        let mut add = |place: usize, variance: f64| {
            let value = self.covariance.at(place, place) + variance;
            self.covariance.put(place, place, value);
        };
        for k in 0..6 {
            let std = if k < 3 { priors.force } else { priors.moment };
            add(StatePlaces::WRENCH + k, std * std * (1.0 - kept * kept));
        }
        add(StatePlaces::PAYLOAD, process.payload[0] * step);
        (0..3).for_each(|k| add(StatePlaces::FIRST_MOMENT + k, process.payload[1] * step));
        for i in 0..places.cables {
            add(StatePlaces::OFFSETS + i, process.offset * step);
            let travel = (self.rates[i] * step).abs() / 0.01;
            add(places.tension_biases() + i, (2.0 * process.friction * self.at.cables[i].tension).powi(2) * travel);
        }
        for k in 0..self.added.count {
            add(self.added.places[k], self.added.variances[k]);
        }
    }

    /// Context of the rows at this time.
    fn with_rows<T>(&mut self, run: impl FnOnce(&mut RowGroup, &RowContext) -> T) -> T {
        let context = RowContext {
            places: self.places,
            mean: &self.mean,
            at: &self.at,
            settings: &self.settings,
            gravity_w: self.of.robot.gravity_w,
            rates: &self.rates,
            step: self.step,
            errors_before: &self.errors_before,
            acceleration: self.acceleration,
            largest_acceleration: self.largest_acceleration,
            rope_tension: self.rope_tension,
        };
        run(&mut self.group, &context)
    }

    /// Begins the updates of one time.
    pub(super) fn begin(&mut self) {
        self.error.fill(0.0);
    }

    /// Begins the updates of a platform at rest at a mean that is not that of `prior`; twelve rows `motion` say how the
    /// platform follows the rest of the state.
    pub(super) fn begin_from(&mut self, prior: &StateMean, motion: &[f64]) {
        self.begin();
        prior.less(&self.mean, self.places, &mut self.error);
        let n = self.places.size();
        for k in 0..6 {
            self.error[k] = dot(&motion[k * n..][..n], &self.error);
        }
    }

    /// Update by one group, whose error adds to that of the groups before; `None` without a reading.
    pub(super) fn measure(&mut self, group: SensorGroup, readings: &SensorReadings) -> Option<GroupResult> {
        self.with_rows(|rows, context| rows.fill(group, readings, context));
        let (count, n) = (self.group.count, self.places.size());
        if count == 0 {
            return None;
        }

        // Innovations and their covariance.
        let mut innovations = [0.0; MAX_ROWS];
        let mut spread = [0.0; MAX_ROWS * MAX_ROWS];
        for k in 0..count {
            let product = &mut self.products[k * n..][..n];
            self.covariance.times(self.group.row(k), product);
            innovations[k] = self.group.residuals[k] - dot(self.group.row(k), &self.error);
            for j in 0..=k {
                let own = if j == k { self.group.variances[k] } else { 0.0 };
                let value = dot(self.group.row(j), &self.products[k * n..][..n]) + own;
                spread[k * MAX_ROWS + j] = value;
            }
        }
        let mut result =
            GroupResult { nis: 0.0, count, gated: 0, log_determinant: 0.0, relative: [f64::NAN; MAX_ROWS] };
        let mut keeps = [true; MAX_ROWS];
        let limit = chi2_quantile(1.0 - GATE / count as f64, 1.0);
        for k in 0..count {
            let relative = innovations[k] / spread[k * MAX_ROWS + k].sqrt();
            let place = if group == SensorGroup::Angles { k } else { self.group.of[k] };
            result.relative[place] = relative;
            keeps[k] = relative * relative <= limit;
        }
        // If most rows are far off, the platform is elsewhere and no sensor is at fault.
        result.gated = keeps[..count].iter().filter(|keep| !**keep).count();
        if 2 * result.gated > count {
            result.gated = 0;
            keeps = [true; MAX_ROWS];
        }
        (result.nis, result.log_determinant) = squared_size(&mut spread, &innovations, count);
        if group == SensorGroup::Tensions {
            self.tension_factor.take(&spread, &self.group.of[..count]);
        }

        let held = self.holds_payload;
        for k in (0..count).filter(|k| keeps[*k]) {
            let row = &self.group.derivatives[k * n..][..n];
            let product = &mut self.products[..n];
            self.covariance.times(row, product);
            let spread = dot(row, product) + self.group.variances[k];
            let innovation = self.group.residuals[k] - dot(row, &self.error);
            self.gain.iter_mut().zip(product.iter()).for_each(|(gain, entry)| *gain = entry / spread);
            if held {
                self.gain[StatePlaces::PAYLOAD..StatePlaces::OFFSETS].fill(0.0);
            }
            self.error.iter_mut().zip(&self.gain).for_each(|(error, gain)| *error += gain * innovation);
            self.covariance.joseph(&self.gain, product, spread);
        }
        Some(result)
    }

    /// Ends the updates of one time: the mean takes the error, and the tangents follow it.
    pub(super) fn finish(&mut self) -> Result<(), EstimationError> {
        if self.error.iter().any(|value| !value.is_finite()) {
            return Err(EstimationError::Diverged);
        }
        self.mean.correct(self.places, &self.error);
        let errors = &self.error[self.places.encoder_errors()..];
        self.rates.iter_mut().zip(errors).for_each(|(rate, error)| *rate += error / self.step);
        self.error.fill(0.0);
        self.refresh()
    }

    /// Estimate of the tension of a cable.
    pub(super) fn tension(&mut self, i: usize) -> Estimate {
        let value = self.with_rows(|rows, context| {
            let n = context.places.size();
            rows.derivatives[..n].fill(0.0);
            tension_row(&mut rows.derivatives[..n], &context.at.cables[i], context, i);
            expected_tension(&context.at.cables[i], context, i)
        });
        let n = self.places.size();
        let product = &mut self.products[..n];
        self.covariance.times(self.group.row(0), product);
        let variance = dot(self.group.row(0), product).max(0.0);
        Estimate { value, std: variance.sqrt() }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Squared size of a vector by a covariance, whose lower triangle becomes its Cholesky factor, and the logarithm of its
/// determinant.
fn squared_size(matrix: &mut [f64; MAX_ROWS * MAX_ROWS], vector: &[f64; MAX_ROWS], count: usize) -> (f64, f64) {
    let (mut size, mut log) = (0.0, 0.0);
    let mut whitened = [0.0; MAX_ROWS];
    for k in 0..count {
        for j in 0..k {
            let sum: f64 = (0..j).map(|l| matrix[k * MAX_ROWS + l] * matrix[j * MAX_ROWS + l]).sum();
            matrix[k * MAX_ROWS + j] = (matrix[k * MAX_ROWS + j] - sum) / matrix[j * MAX_ROWS + j];
        }
        let sum: f64 = (0..k).map(|l| matrix[k * MAX_ROWS + l].powi(2)).sum();
        let diagonal = (matrix[k * MAX_ROWS + k] - sum).max(f64::MIN_POSITIVE).sqrt();
        matrix[k * MAX_ROWS + k] = diagonal;
        let before: f64 = (0..k).map(|l| matrix[k * MAX_ROWS + l] * whitened[l]).sum();
        whitened[k] = (vector[k] - before) / diagonal;
        size += whitened[k] * whitened[k];
        log += 2.0 * diagonal.ln();
    }
    (size, log)
}
