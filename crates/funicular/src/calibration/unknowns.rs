//! Unknown numbers of a calibration, and the robot that has their values.

use crate::robot::Robot;

/// Least radius of a pulley in a search [m]: a step beyond zero has no meaning.
const MIN_RADIUS: f64 = 1e-6;

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
    /// Radius of the pulley that this cable, and every other one with a pulley of its name, runs over [m].
    PulleyRadius {
        /// Index of the first cable with it.
        cable: usize,
    },
    /// Factor of the stiffness of all flexible supports.
    SupportStiffness,
}

impl CalibrationUnknown {
    /// Cable that the unknown belongs to; `None` for one of all cables.
    pub fn cable(&self) -> Option<usize> {
        match self {
            Self::Anchor { cable, .. } | Self::Attachment { cable, .. } | Self::Offset { cable } => Some(*cable),
            Self::Scale | Self::AxialStiffness | Self::Mass | Self::PulleyRadius { .. } | Self::SupportStiffness => {
                None
            }
        }
    }

    /// True for a number of the robot file: of an anchor, an attachment or a pulley.
    pub fn is_in_file(&self) -> bool {
        matches!(self, Self::Anchor { .. } | Self::Attachment { .. } | Self::PulleyRadius { .. })
    }

    /// True for a length, or the scale of the readings times their mean; false for a factor of stiffness or mass.
    pub fn is_length(&self) -> bool {
        self.factor().is_none()
    }

    /// Place of a factor of all cables, of the platform or of all supports among those of [`CalibratedRobot::factors`].
    pub(super) fn factor(&self) -> Option<usize> {
        match self {
            Self::AxialStiffness => Some(0),
            Self::Mass => Some(1),
            Self::SupportStiffness => Some(2),
            _ => None,
        }
    }

    /// True for the radius of the pulley of this cable.
    pub(super) fn is_radius_of(&self, robot: &Robot, cable: usize) -> bool {
        let name = |cable: usize| robot.cables[cable].anchor.pulley.as_ref().map(|pulley| pulley.name.as_str());
        match self {
            Self::PulleyRadius { cable: first } => name(cable).is_some() && name(cable) == name(*first),
            _ => false,
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
    /// Factors of the axial stiffness of all cables, of the mass of the platform and of the stiffness of all supports,
    /// which the robot has already.
    pub factors: [f64; 3],
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
            CalibrationUnknown::SupportStiffness => self.factors[2].ln() * scale_length,
            CalibrationUnknown::PulleyRadius { cable } => {
                self.robot.cables[cable].anchor.pulley.as_ref().map_or(0.0, |pulley| pulley.radius)
            }
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
                CalibrationUnknown::SupportStiffness => {
                    let factor = (*value / scale_length).exp();
                    for support in &mut self.robot.supports {
                        support.stiffness_w *= factor / self.factors[2];
                    }
                    self.factors[2] = factor;
                }
                CalibrationUnknown::PulleyRadius { .. } => {
                    let with_it: Vec<usize> =
                        (0..self.robot.cables.len()).filter(|cable| of.is_radius_of(&self.robot, *cable)).collect();
                    for cable in with_it {
                        if let Some(pulley) = &mut self.robot.cables[cable].anchor.pulley {
                            pulley.radius = value.max(MIN_RADIUS);
                        }
                    }
                }
            }
        }
    }
}
