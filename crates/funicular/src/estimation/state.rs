//! State of an estimator: places of its components, mean, and what is told about it.

use super::model::CarriedLoad;
use crate::control_loop::MAX_CABLES;
use crate::math::{Vec3, Vec6};
use crate::robot::Pose;

/// Places of the components of the error state for a number of cables.
///
/// # References
/// docs/theory.md, equation (97s).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct StatePlaces {
    pub(super) cables: usize,
}

impl StatePlaces {
    pub(super) const POSITION: usize = 0;
    pub(super) const TURN: usize = 3;
    pub(super) const VELOCITY: usize = 6;
    pub(super) const ANGULAR_VELOCITY: usize = 9;
    pub(super) const WRENCH: usize = 12;
    pub(super) const PAYLOAD: usize = 18;
    pub(super) const FIRST_MOMENT: usize = 19;
    pub(super) const OFFSETS: usize = 22;

    pub(super) fn tension_biases(self) -> usize {
        Self::OFFSETS + self.cables
    }

    pub(super) fn accelerometer_bias(self) -> usize {
        self.tension_biases() + self.cables
    }

    pub(super) fn gyroscope_bias(self) -> usize {
        self.accelerometer_bias() + 3
    }

    /// Errors of the encoders at the last time; without memory.
    pub(super) fn encoder_errors(self) -> usize {
        self.gyroscope_bias() + 3
    }

    pub(super) fn size(self) -> usize {
        self.encoder_errors() + self.cables
    }
}

/// Mean of the state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StateMean {
    pub(super) pose: Pose,
    /// Velocity of the platform origin and angular velocity, world axes.
    pub(super) twist: Vec6,
    pub(super) load: CarriedLoad,
    pub(super) offsets: [f64; MAX_CABLES],
    pub(super) tension_biases: [f64; MAX_CABLES],
    pub(super) accelerometer_bias: Vec3,
    pub(super) gyroscope_bias: Vec3,
    pub(super) encoder_errors: [f64; MAX_CABLES],
}

impl StateMean {
    pub(super) fn new(pose: Pose, payload: f64) -> Self {
        Self {
            pose,
            twist: Vec6::zeros(),
            load: CarriedLoad { mass: payload, ..CarriedLoad::default() },
            offsets: [0.0; MAX_CABLES],
            tension_biases: [0.0; MAX_CABLES],
            accelerometer_bias: Vec3::zeros(),
            gyroscope_bias: Vec3::zeros(),
            encoder_errors: [0.0; MAX_CABLES],
        }
    }

    /// Writes the difference of payload, wrench and errors of the sensors from those of `other`; poses and velocities
    /// are left.
    pub(super) fn less(&self, other: &Self, places: StatePlaces, error: &mut [f64]) {
        let mut three = |first: usize, value: Vec3| error[first..first + 3].copy_from_slice(value.as_slice());
        three(StatePlaces::FIRST_MOMENT, self.load.moment_p - other.load.moment_p);
        three(places.accelerometer_bias(), self.accelerometer_bias - other.accelerometer_bias);
        three(places.gyroscope_bias(), self.gyroscope_bias - other.gyroscope_bias);
        error[StatePlaces::PAYLOAD] = self.load.mass - other.load.mass;
        for k in 0..6 {
            error[StatePlaces::WRENCH + k] = self.load.wrench[k] - other.load.wrench[k];
        }
        for i in 0..places.cables {
            error[StatePlaces::OFFSETS + i] = self.offsets[i] - other.offsets[i];
            error[places.tension_biases() + i] = self.tension_biases[i] - other.tension_biases[i];
            error[places.encoder_errors() + i] = self.encoder_errors[i] - other.encoder_errors[i];
        }
    }

    /// Adds an error state.
    pub(super) fn correct(&mut self, places: StatePlaces, error: &[f64]) {
        let three = |first: usize| Vec3::new(error[first], error[first + 1], error[first + 2]);
        self.pose = self.pose.moved(&three(StatePlaces::POSITION), &three(StatePlaces::TURN));
        for k in 0..6 {
            self.twist[k] += error[StatePlaces::VELOCITY + k];
            self.load.wrench[k] += error[StatePlaces::WRENCH + k];
        }
        self.load.mass += error[StatePlaces::PAYLOAD];
        self.load.moment_p += three(StatePlaces::FIRST_MOMENT);
        for i in 0..places.cables {
            self.offsets[i] += error[StatePlaces::OFFSETS + i];
            self.tension_biases[i] += error[places.tension_biases() + i];
            self.encoder_errors[i] += error[places.encoder_errors() + i];
        }
        self.accelerometer_bias += three(places.accelerometer_bias());
        self.gyroscope_bias += three(places.gyroscope_bias());
    }
}

/// Number with its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Estimate {
    /// Mean.
    pub value: f64,
    /// Standard deviation.
    pub std: f64,
}

/// Whether a cable hangs loose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Slackness {
    /// Loose with a probability above 95 %.
    Slack,
    /// Loose with a probability below 5 %.
    Taut,
    /// Neither is known.
    #[default]
    Unknown,
}

/// One cable of an estimated state.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EstimatedCable {
    /// Tension at the drum or anchor [N].
    pub tension: Estimate,
    /// Whether the cable hangs loose.
    pub slackness: Slackness,
    /// Offset of the length: true length minus reading [m].
    pub offset: Estimate,
    /// Bias of the measured tension [N].
    pub tension_bias: Estimate,
}

/// Estimated state of the robot at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EstimatedState {
    /// Pose of the platform.
    pub pose: Pose,
    /// Deviation of the position, world axes [m].
    pub position_std: [f64; 3],
    /// Deviation of small turns about the world's axes [rad].
    pub rotation_std: [f64; 3],
    /// Velocity of the platform origin, world axes [m/s].
    pub velocity: [Estimate; 3],
    /// Angular velocity, world axes [rad/s].
    pub angular_velocity: [Estimate; 3],
    /// External force besides the loads of the file, world axes [N].
    pub force: [Estimate; 3],
    /// External moment about the platform origin, world axes [N m].
    pub moment: [Estimate; 3],
    /// Payload beyond the platform of the file [kg].
    pub payload: Estimate,
    /// First moment of the payload about the platform origin, platform axes [kg m].
    pub first_moment: [Estimate; 3],
    /// Bias of the accelerometer [m/s²].
    pub accelerometer_bias: [Estimate; 3],
    /// Bias of the gyroscope [rad/s].
    pub gyroscope_bias: [Estimate; 3],
    /// Cables in the order of the file; those beyond their number are zero.
    pub cables: [EstimatedCable; MAX_CABLES],
    /// True while the platform vibrates, so that payload and first moment are not read from its motion.
    pub rings: bool,
}

impl EstimatedState {
    /// Centre of mass of the payload in the platform frame [m] with its deviation; `None` while it is not known within
    /// `limit` [m].
    pub fn payload_center(&self, limit: f64) -> Option<[Estimate; 3]> {
        let mass = self.payload;
        if mass.value <= 3.0 * mass.std {
            return None;
        }
        let center = self.first_moment.map(|moment| {
            let value = moment.value / mass.value;
            Estimate { value, std: (moment.std.powi(2) + (value * mass.std).powi(2)).sqrt() / mass.value }
        });
        center.iter().any(|part| part.std <= limit).then_some(center)
    }
}
