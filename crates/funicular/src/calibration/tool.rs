//! Deviation of the platform when readings are commanded with calibrated values (96n): what a covariance of anchors,
//! attachments and offsets means at the tool.

use super::elastic::RowState;
use super::{CalibratedRobot, Calibration, MeasuredRow};
use crate::math::{DMat, Mat3, Vec3, symmetric};
use crate::robot::Pose;

/// Least singular value of the readings' derivatives by the pose, relative to the largest one, at which readings hold
/// the pose: a tenth of what rounding leaves of 1e-16 in a normal matrix. A singular pose has 1e-12 and less.
const MIN_HOLD: f64 = 1e-9;

/// Motion of the platform per unit of each unknown, with the readings held.
#[derive(Debug, Clone)]
pub struct ToolRows {
    /// Rates of the position, world axes; one column per unknown.
    pub position: DMat,
    /// Rates of roll, pitch and yaw [rad]; no rows for a platform whose cables end in one point.
    pub angles: DMat,
}

/// Standard deviations of the platform at a pose.
#[derive(Debug, Clone, PartialEq)]
pub struct ToolDeviation {
    /// Standard deviation of the position along the direction in which it is largest [m].
    pub position: f64,
    /// This direction, a unit vector in world axes.
    pub direction_w: Vec3,
    /// Covariance of the position, world axes [m²].
    pub covariance_w: Mat3,
    /// Standard deviations of roll, pitch and yaw [rad]; `None` for a platform whose cables end in one point.
    pub angles: Option<[f64; 3]>,
}

impl ToolRows {
    /// Deviations of the platform from a covariance of the unknowns.
    pub fn deviation(&self, covariance: &DMat) -> ToolDeviation {
        let position = &self.position * covariance * self.position.transpose();
        let covariance_w = Mat3::from_fn(|i, j| 0.5 * (position[(i, j)] + position[(j, i)]));
        let (variance, direction_w) = symmetric::largest_principal(&covariance_w);
        let of_angle = |k: usize| {
            let row = self.angles.rows(k, 1);
            (row * covariance * row.transpose())[(0, 0)].max(0.0).sqrt()
        };
        ToolDeviation {
            position: variance.max(0.0).sqrt(),
            direction_w,
            covariance_w,
            angles: (self.angles.nrows() == 3).then(|| [0, 1, 2].map(of_angle)),
        }
    }
}

impl Calibration {
    /// Motions of the platform at a pose per unit of each unknown, with the readings of all cables held: a controller
    /// commands the readings that the calibrated values give, and the robot goes where they lead with the true ones.
    /// `lengths` are the unstrained lengths of elastic cables with which the platform rests there [m], empty for
    /// straight rigid ones. More of these than degrees of freedom share what they contradict by least squares. `None`
    /// for a pose that its readings do not hold, or without equilibrium.
    ///
    /// # References
    /// docs/theory.md, equation (96n).
    pub fn tool_rows(&self, at: &CalibratedRobot, pose: &Pose, lengths: &[f64]) -> Option<ToolRows> {
        let cables = at.robot.cables.len();
        let readings = MeasuredRow::of_readings(&vec![0.0; cables]);
        let row = MeasuredRow { position: [Some(0.0); 3], angles: [Some(0.0); 3], ..readings };
        let state = RowState { pose: *pose, lengths: lengths.to_vec() };
        let terms = self.terms_of(at, &row, &state)?;

        // The readings stay: their change with the state of the row makes up for that with the unknowns.
        let of_readings = terms.by_pose.rows(0, cables).into_owned();
        if cables < of_readings.ncols() {
            return None;
        }
        let svd = of_readings.svd(true, true);
        let (least, most) = (svd.singular_values.min(), svd.singular_values.max());
        if least <= MIN_HOLD * most {
            return None;
        }
        let of_state = -svd.solve(&terms.by_unknowns.rows(0, cables).into_owned(), 0.0).ok()?;
        let motion = |first: usize, count: usize, deviation: f64| {
            let by_state = terms.by_pose.rows(first, count) * &of_state;
            (by_state + terms.by_unknowns.rows(first, count)) * deviation
        };
        let angles = if self.is_point { 0 } else { 3 };
        Some(ToolRows {
            position: motion(cables, 3, self.deviations.position),
            angles: motion(cables + 3, angles, self.deviations.angle),
        })
    }
}
