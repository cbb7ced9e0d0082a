//! Rows of the measurements: residuals with their derivatives by the state.

use super::model::{CableTangents, Tangents, split};
use super::readings::{SensorGroup, SensorReadings};
use super::settings::EstimationSettings;
use super::state::{StateMean, StatePlaces};
use crate::control_loop::MAX_CABLES;
use crate::math::{Mat3, Vec3, Vec6, skew};

/// Maximum number of rows of one group.
pub(super) const MAX_ROWS: usize = 2 * MAX_CABLES;

/// Deviation of an acceleration that the model does not have, per acceleration that it has.
const ACCELERATION_ERROR: f64 = 0.3;

/// Time over which the error of an acceleration keeps its sign [s]: a period of the slowest usual mode, 5 Hz.
const ACCELERATION_MEMORY: f64 = 0.2;

/// Rows of one group at one time.
#[derive(Debug, Clone)]
pub(super) struct RowGroup {
    pub(super) count: usize,
    /// Derivatives, one row after the other.
    pub(super) derivatives: Vec<f64>,
    pub(super) residuals: [f64; MAX_ROWS],
    pub(super) variances: [f64; MAX_ROWS],
    /// Cable or axis of each row.
    pub(super) of: [usize; MAX_ROWS],
    size: usize,
}

/// Values that the rows of one time share.
pub(super) struct RowContext<'a> {
    pub(super) places: StatePlaces,
    pub(super) mean: &'a StateMean,
    pub(super) at: &'a Tangents,
    pub(super) settings: &'a EstimationSettings,
    pub(super) gravity_w: Vec3,
    /// Rates of the lengths [m/s], time step [s] behind them, and variances of the errors of the encoders before it.
    pub(super) rates: &'a [f64],
    pub(super) step: f64,
    pub(super) errors_before: &'a [f64],
    /// Acceleration of the platform, and the largest of the last time [m/s²].
    pub(super) acceleration: Vec6,
    pub(super) largest_acceleration: f64,
    /// Deviation of tensions that vibrations of the ropes add [N].
    pub(super) rope_tension: f64,
}

impl RowGroup {
    pub(super) fn new(size: usize) -> Self {
        Self {
            count: 0,
            derivatives: vec![0.0; MAX_ROWS * size],
            residuals: [0.0; MAX_ROWS],
            variances: [0.0; MAX_ROWS],
            of: [0; MAX_ROWS],
            size,
        }
    }

    pub(super) fn row(&self, k: usize) -> &[f64] {
        &self.derivatives[k * self.size..][..self.size]
    }

    /// Adds a row and returns its derivatives, which are zero.
    fn add(&mut self, of: usize, residual: f64, variance: f64) -> &mut [f64] {
        let k = self.count;
        self.count += 1;
        (self.residuals[k], self.variances[k], self.of[k]) = (residual, variance, of);
        let row = &mut self.derivatives[k * self.size..][..self.size];
        row.fill(0.0);
        row
    }

    /// Rows of a group for the readings that are there.
    pub(super) fn fill(&mut self, group: SensorGroup, readings: &SensorReadings, context: &RowContext) {
        self.count = 0;
        match group {
            SensorGroup::Tensions => self.tensions(readings, context),
            SensorGroup::Angles => self.angles(readings, context),
            SensorGroup::Gyroscope => self.gyroscope(readings, context),
            SensorGroup::Accelerometer => self.accelerometer(readings, context),
            SensorGroup::Tracker => self.tracker(readings, context),
        }
    }

    fn tensions(&mut self, readings: &SensorReadings, context: &RowContext) {
        let noise = context.settings.noise.tension.powi(2) + context.rope_tension.powi(2);
        for (i, cable) in context.at.cables.iter().enumerate() {
            if readings.tensions[i].is_finite() {
                let residual =
                    readings.tensions[i] - expected_tension(cable, context, i) - context.mean.tension_biases[i];
                let by_rate = cable.damping / context.step;
                let row = self.add(i, residual, noise + by_rate.powi(2) * context.errors_before[i]);
                tension_row(row, cable, context, i);
                row[context.places.tension_biases() + i] = 1.0;
            }
        }
    }

    fn angles(&mut self, readings: &SensorReadings, context: &RowContext) {
        let variance = context.settings.noise.angle.powi(2);
        for (i, cable) in context.at.cables.iter().enumerate() {
            let d = &cable.leaving;
            let level = d.x.hypot(d.y).max(1e-9);
            let by =
                [(d.y.atan2(d.x), Vec3::new(-d.y, d.x, 0.0) / (level * level)), (d.z.atan2(level), Vec3::z() / level)];
            for (read, (angle, gradient)) in readings.angles[i].into_iter().zip(by) {
                if read.is_finite() {
                    let turns = ((read - angle) / std::f64::consts::TAU).round();
                    let residual = read - angle - turns * std::f64::consts::TAU;
                    let row = self.add(i, residual, variance);
                    put_attachment(row, &(cable.leaving_by_start.transpose() * gradient), cable);
                    put_length(row, cable.leaving_by_length.dot(&gradient), context.places, i);
                }
            }
        }
    }

    fn gyroscope(&mut self, readings: &SensorReadings, context: &RowContext) {
        let variance = context.settings.noise.gyroscope.powi(2);
        let (_, turn) = split(&context.mean.twist);
        let rotation = context.mean.pose.rot_wp.to_rotation_matrix().matrix().transpose();
        let expected = rotation * turn + context.mean.gyroscope_bias;
        let by_turn = rotation * skew(&turn);
        for axis in 0..3 {
            if readings.gyroscope[axis].is_finite() {
                let row = self.add(axis, readings.gyroscope[axis] - expected[axis], variance);
                put_three(row, StatePlaces::TURN, &by_turn.row(axis).transpose());
                put_three(row, StatePlaces::ANGULAR_VELOCITY, &rotation.row(axis).transpose());
                row[context.places.gyroscope_bias() + axis] = 1.0;
            }
        }
    }

    /// Direction of gravity. The acceleration of the model is taken off; its error counts with its own deviation.
    fn accelerometer(&mut self, readings: &SensorReadings, context: &RowContext) {
        let rotation = context.mean.pose.rot_wp.to_rotation_matrix().matrix().transpose();
        let (linear, angular) = split(&context.acceleration);
        let (_, turn) = split(&context.mean.twist);
        let lever = context.mean.pose.rot_wp * context.settings.inertial_unit_p;
        let of_unit = linear + angular.cross(&lever) + turn.cross(&turn.cross(&lever));
        let expected = rotation * (of_unit - context.gravity_w) + context.mean.accelerometer_bias;
        let by_turn: Mat3 = rotation * skew(&-context.gravity_w);
        let repeats = (ACCELERATION_MEMORY / context.step).max(1.0);
        let of_model = repeats * (ACCELERATION_ERROR * context.largest_acceleration).powi(2);
        let variance = context.settings.noise.accelerometer.powi(2) + of_model;
        for axis in 0..3 {
            if readings.accelerometer[axis].is_finite() {
                let row = self.add(axis, readings.accelerometer[axis] - expected[axis], variance);
                put_three(row, StatePlaces::TURN, &by_turn.row(axis).transpose());
                row[context.places.accelerometer_bias() + axis] = 1.0;
            }
        }
    }

    fn tracker(&mut self, readings: &SensorReadings, context: &RowContext) {
        let variance = context.settings.noise.tracker.powi(2);
        let lever = context.mean.pose.rot_wp * context.settings.tracked_point_p;
        let expected = context.mean.pose.position_w + lever;
        let by_turn = skew(&-lever);
        for axis in 0..3 {
            if readings.tracker[axis].is_finite() {
                let row = self.add(axis, readings.tracker[axis] - expected[axis], variance);
                row[StatePlaces::POSITION + axis] = 1.0;
                put_three(row, StatePlaces::TURN, &by_turn.row(axis).transpose());
            }
        }
    }
}

/// Tension of a cable at its drum or anchor [N].
pub(super) fn expected_tension(cable: &CableTangents, context: &RowContext, i: usize) -> f64 {
    cable.tension + cable.damping * (Tangents::chord_rate(cable, &context.mean.twist) - context.rates[i])
}

/// Derivatives of the tension of a cable.
///
/// # References
/// docs/theory.md, equation (97w).
pub(super) fn tension_row(row: &mut [f64], cable: &CableTangents, context: &RowContext, i: usize) {
    put_attachment(row, &cable.tension_by_start, cable);
    put_length(row, cable.tension_by_length, context.places, i);
    row[context.places.encoder_errors() + i] -= cable.damping / context.step;
    let by_velocity = cable.direction * -cable.damping;
    put_three(row, StatePlaces::VELOCITY, &by_velocity);
    put_three(row, StatePlaces::ANGULAR_VELOCITY, &cable.lever.cross(&by_velocity));
}

/// Derivatives by the pose of a number that has the derivative `by_start` by the attachment of a cable.
fn put_attachment(row: &mut [f64], by_start: &Vec3, cable: &CableTangents) {
    put_three(row, StatePlaces::POSITION, by_start);
    put_three(row, StatePlaces::TURN, &cable.lever.cross(by_start));
}

/// Derivatives by a length, which has an offset and an error of its encoder.
fn put_length(row: &mut [f64], by_length: f64, places: StatePlaces, i: usize) {
    row[StatePlaces::OFFSETS + i] = by_length;
    row[places.encoder_errors() + i] = by_length;
}

fn put_three(row: &mut [f64], first: usize, values: &Vec3) {
    row[first..first + 3].copy_from_slice(values.as_slice());
}
