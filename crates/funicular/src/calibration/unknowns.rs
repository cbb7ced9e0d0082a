//! Unknown numbers of a calibration, and the robot that has their values.

use crate::robot::Robot;

/// Unknown number of the robot or of its readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CalibrationUnknown {
    /// Coordinate of an anchor along a world axis [m].
    Anchor {
        /// Index of the cable.
        cable: usize,
        /// World axis, 0 to 2.
        axis: usize,
    },
    /// Coordinate of an attachment along an axis of the platform [m].
    Attachment {
        /// Index of the cable.
        cable: usize,
        /// Axis of the platform, 0 to 2.
        axis: usize,
    },
    /// Length of a cable at the reading zero [m].
    Offset {
        /// Index of the cable.
        cable: usize,
    },
    /// Metres of length per metre of all readings.
    Scale,
    /// Factor of the axial stiffness of all cables.
    AxialStiffness,
    /// Factor of the mass of the platform.
    Mass,
}

impl CalibrationUnknown {
    /// Cable that the unknown belongs to; `None` for one of all cables.
    pub fn cable(&self) -> Option<usize> {
        match self {
            Self::Anchor { cable, .. } | Self::Attachment { cable, .. } | Self::Offset { cable } => Some(*cable),
            Self::Scale | Self::AxialStiffness | Self::Mass => None,
        }
    }
}

/// Robot with calibrated values, and how its encoders count: `length = offset + scale · reading` (96a).
#[derive(Debug, Clone, PartialEq)]
pub struct CalibratedRobot {
    /// Robot with these anchors and attachments.
    pub robot: Robot,
    /// Offset of each cable [m].
    pub offsets: Vec<f64>,
    /// Metres of length per metre of reading.
    pub scale: f64,
    /// Factors of the axial stiffness of all cables and of the mass of the platform, which the robot has already.
    pub factors: [f64; 2],
}

impl CalibratedRobot {
    /// Values of unknowns; the scale and the logarithms of the factors are multiplied by a length.
    pub(super) fn values(&self, unknowns: &[CalibrationUnknown], scale_length: f64) -> Vec<f64> {
        let value = |of: &CalibrationUnknown| match *of {
            CalibrationUnknown::Anchor { cable, axis } => self.robot.cables[cable].anchor.point_w[axis],
            CalibrationUnknown::Attachment { cable, axis } => self.robot.cables[cable].attachment_p[axis],
            CalibrationUnknown::Offset { cable } => self.offsets[cable],
            CalibrationUnknown::Scale => self.scale * scale_length,
            CalibrationUnknown::AxialStiffness => self.factors[0].ln() * scale_length,
            CalibrationUnknown::Mass => self.factors[1].ln() * scale_length,
        };
        unknowns.iter().map(value).collect()
    }

    /// Sets the values of unknowns.
    pub(super) fn set(&mut self, unknowns: &[CalibrationUnknown], values: &[f64], scale_length: f64) {
        for (of, value) in unknowns.iter().zip(values) {
            match *of {
                CalibrationUnknown::Anchor { cable, axis } => self.robot.cables[cable].anchor.point_w[axis] = *value,
                CalibrationUnknown::Attachment { cable, axis } => self.robot.cables[cable].attachment_p[axis] = *value,
                CalibrationUnknown::Offset { cable } => self.offsets[cable] = *value,
                CalibrationUnknown::Scale => self.scale = *value / scale_length,
                CalibrationUnknown::AxialStiffness => {
                    let factor = (*value / scale_length).exp();
                    for cable in &mut self.robot.cables {
                        cable.material.axial_stiffness *= factor / self.factors[0];
                    }
                    self.factors[0] = factor;
                }
                CalibrationUnknown::Mass => {
                    let factor = (*value / scale_length).exp();
                    self.robot.platform.mass *= factor / self.factors[1];
                    self.factors[1] = factor;
                }
            }
        }
    }
}
