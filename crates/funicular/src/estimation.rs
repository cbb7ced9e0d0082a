//! State of a robot from its sensors: pose, velocity, payload, external wrench, tensions of all cables, and the errors
//! of the sensors themselves, each with its standard deviation.
//!
//! An [`Estimator`] is an error-state Kalman filter of a rigid platform on quasi-static elastic catenaries. Lengths are
//! its inputs; load cells, gyroscope, accelerometer, tracker and cable angles are its measurements. After the start it
//! reserves no memory, and every call has a bound of its work.
//!
//! The same object serves logs and control loops. [`Estimator::rest_anew`] begins a further pose at rest with what is
//! known about the robot: weighted least squares over poses at rest, one row after the other.
//!
//! # References
//! docs/theory.md, section 18f.

mod consistency;
mod covariance;
mod estimator;
mod exponential;
mod faults;
mod kalman;
mod model;
mod payload_mean;
mod readings;
mod rows;
mod settings;
mod start;
mod state;

pub use consistency::{Consistency, chi2_quantile};
pub use estimator::{Estimator, UpdateNotes};
pub use faults::{FaultAlarm, FaultHypothesis, FaultKind, FaultVerdict, MAX_CORRELATION, UNDECIDED};
pub use readings::{SensorGroup, SensorReadings};
pub use settings::{EstimationSettings, ProcessNoise, SensorNoise, StatePriors};
pub use start::EstimationError;
pub use state::{Estimate, EstimatedCable, EstimatedState, Slackness};
