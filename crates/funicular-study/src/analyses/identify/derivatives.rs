//! Derivatives of the predictions of an experiment by the values, from the gradients of its robot.

use super::experiment::{Prepared, Solved};
use super::observations::{Stage, Subject};
use crate::at_rest::AtRest;
use crate::payload::change_carrying;
use anyhow::{Result, bail};
use funicular::gradient::{Gradients, Hold, VibrationGradients};
use funicular::math::{Complex, Mat3, Vec3, skew};
use funicular::modes::Mode;
use funicular::robot::{Pose, Robot, RobotChange, State};
use std::ops::Range;

/// Angle [rad] below which the series of (93g) is used: the next term is θ⁴/30240.
const SMALL_ANGLE: f64 = 1e-2;

impl Prepared<'_> {
    /// Change of the robot of this experiment, for a change of the robot of the file. `all` is the robot of the file,
    /// with all cables and no payload. What the experiment states itself does not change with the file.
    pub(super) fn change(&self, mut change: RobotChange, all: &Robot) -> RobotChange {
        let state = &self.given.state;
        if let Some(mounted) = &self.given.cables {
            let mut kept = all.cables.iter().map(|cable| mounted.contains(&cable.name));
            change.cables.retain(|_| kept.next().unwrap_or(false));
        }
        // A payload without a place of its own moves with the centre of mass of the platform.
        if let (Some(payload), Some(center_p)) = (self.given.payload_kg, self.given.payload_center_m) {
            change = change_carrying(change, all, payload, center_p.into());
        }
        if state.mass_kg.is_some() {
            change.mass = 0.0;
        }
        if state.pose.is_some() || state.hold_lengths_of_pose {
            (change.position_w, change.rotation_w) = (Vec3::zeros(), Vec3::zeros());
        }

        let load = &state.load;
        for vector in load.of_file().iter().filter(|vector| vector.value.is_some()) {
            *(vector.of_change)(&mut change) = Vec3::zeros();
        }
        for cable in &mut change.cables {
            if state.lengths_m.is_some() || state.hold_lengths_of_pose {
                cable.unstrained_length = 0.0;
            }
            if load.cable_load_n_per_m.is_some() {
                cable.load_per_length_w = Vec3::zeros();
            }
        }
        change
    }

    /// Derivatives of the predictions along changes of the robot of this experiment: one list per change, in the order
    /// of the predictions.
    ///
    /// # Errors
    /// Predictions that have no gradient. The reason is for developers: the caller takes differences instead.
    pub(super) fn derivatives(
        &self,
        solved: &Solved,
        stage: Stage,
        changes: &[RobotChange],
    ) -> Result<Vec<Vec<Complex>>> {
        let Solved { at_rest, modes, assigned, of_responses, .. } = solved;
        let robot = &at_rest.robot;
        let has_damping = self.observations.iter().any(|of| matches!(of.subject, Subject::Damping(_)));
        if has_damping && stage != Stage::Statics {
            // The damping ratio to first order depends on the motion of the mode, which is not differentiated.
            bail!("a damping ratio to first order has no gradient");
        }
        let gradients = self.gradients(at_rest)?;
        let mut columns = vec![vec![Complex::default(); solved.values.len()]; changes.len()];

        self.add_statics(&gradients, changes, &mut columns)?;
        if stage == Stage::Statics {
            return Ok(columns);
        }
        if !assigned.is_empty() {
            let Some(dynamics) = &modes.1 else { bail!("modes of rigid cables have no gradient") };
            let vibration = gradients.vibration(dynamics)?;
            for (row, observation) in self.observations.iter().enumerate() {
                if let Subject::Frequency(k) = observation.subject {
                    let gradient = vibration.frequency(&modes.0[assigned[k]])?;
                    add(row, &gradient, changes, &mut columns);
                }
            }
        }
        if let Some(dynamics) = of_responses {
            self.add_responses(&gradients.vibration(dynamics)?, robot, changes, &mut columns)?;
        }
        Ok(columns)
    }

    /// Derivatives of the logarithms of the frequencies in a range of the list of modes: one list per mode, along the
    /// changes of the robot of this experiment.
    ///
    /// # Errors
    /// Frequencies that have no gradient, as in [`Self::derivatives`].
    pub(super) fn list_derivatives(
        &self,
        solved: &Solved,
        range: Range<usize>,
        changes: &[RobotChange],
    ) -> Result<Vec<Vec<f64>>> {
        let Some(dynamics) = &solved.modes.1 else { bail!("modes of rigid cables have no gradient") };
        let gradients = self.gradients(&solved.at_rest)?;
        let vibration = gradients.vibration(dynamics)?;
        let of_mode = |mode: &Mode| {
            let gradient = vibration.frequency(mode)?;
            Ok(changes.iter().map(|change| gradient.dot(change) / mode.frequency_hz).collect())
        };
        solved.modes.0[range].iter().map(of_mode).collect()
    }

    /// Gradients of the robot at rest.
    ///
    /// # Errors
    /// A rule of tension distribution or the nearest pose, which have other derivatives than a held pose.
    fn gradients<'s>(&self, at_rest: &'s AtRest) -> Result<Gradients<'s>> {
        let hold = self.hold(&at_rest.robot);
        if hold == Hold::Pose && (at_rest.requested_pose.is_some() || at_rest.rule.is_some()) {
            bail!("the pose or the tensions follow from a rule");
        }
        Ok(Gradients::new(&at_rest.robot, &at_rest.equilibrium, hold)?)
    }

    /// Writes the derivatives of pose, tensions and lengths.
    fn add_statics(&self, gradients: &Gradients, changes: &[RobotChange], columns: &mut [Vec<Complex>]) -> Result<()> {
        let pose = match self.given.measured_pose {
            Some(measured) => pose_derivatives(gradients, &measured.to_robot()?, changes),
            None => Vec::new(),
        };
        let is_measured = |measured: &Option<Vec<f64>>| measured.is_some();
        let tensions = is_measured(&self.given.measured_tensions_n).then(|| gradients.tensions_platform());
        let lengths = is_measured(&self.given.measured_lengths_m).then(|| gradients.lengths());
        for (row, observation) in self.observations.iter().enumerate() {
            match (observation.subject, &tensions, &lengths) {
                (Subject::Pose(k), ..) => {
                    columns.iter_mut().zip(&pose).for_each(|(column, along)| column[row] = along[k].into());
                }
                (Subject::Tension(i), Some(tensions), _) => add(row, &tensions[i], changes, columns),
                (Subject::Length(i), _, Some(lengths)) => add(row, &lengths[i], changes, columns),
                _ => {}
            }
        }
        Ok(())
    }

    /// Writes the derivatives of the responses.
    fn add_responses(
        &self,
        vibration: &VibrationGradients,
        robot: &Robot,
        changes: &[RobotChange],
        columns: &mut [Vec<Complex>],
    ) -> Result<()> {
        for group in self.groups(robot)? {
            let found = vibration.responses(&group.inputs, &group.outputs, &group.frequency_hz, changes)?;
            for (pair, first) in group.rows {
                for (line, derivatives) in found[pair].iter().enumerate() {
                    for (column, along) in columns.iter_mut().zip(&derivatives.along) {
                        column[first + line] = *along;
                    }
                }
            }
        }
        Ok(())
    }

    /// Quantity that is held while a value changes.
    fn hold(&self, robot: &Robot) -> Hold {
        match robot.state {
            State::Pose(_) if !self.given.state.hold_lengths_of_pose => Hold::Pose,
            _ => Hold::Lengths,
        }
    }
}

/// Writes the derivatives of one prediction along all changes.
fn add(row: usize, gradient: &RobotChange, changes: &[RobotChange], columns: &mut [Vec<Complex>]) {
    for (column, change) in columns.iter_mut().zip(changes) {
        column[row] = gradient.dot(change).into();
    }
}

/// Derivatives of the difference from a measured pose, one list per change: position, then rotation vector.
fn pose_derivatives(gradients: &Gradients, measured: &Pose, changes: &[RobotChange]) -> Vec<[f64; 6]> {
    let by_pose = gradients.pose();
    let turn = (gradients.equilibrium().pose.rot_wp * measured.rot_wp.inverse()).scaled_axis();
    let rate = rate_of_rotation_vector(&turn);
    let along = |change: &RobotChange| {
        let motion = by_pose.each_ref().map(|gradient| gradient.dot(change));
        let turned = rate * Vec3::new(motion[3], motion[4], motion[5]);
        [motion[0], motion[1], motion[2], turned.x, turned.y, turned.z]
    };
    changes.iter().map(along).collect()
}

/// Derivative of the rotation vector θ of a rotation by a small turn after it, in world axes: the inverse of the left
/// Jacobian, (93g).
fn rate_of_rotation_vector(theta: &Vec3) -> Mat3 {
    let angle = theta.norm();
    let square = if angle < SMALL_ANGLE {
        1.0 / 12.0 + angle * angle / 720.0
    } else {
        (1.0 - 0.5 * angle / (0.5 * angle).tan()) / (angle * angle)
    };
    let cross = skew(theta);
    Mat3::identity() - cross * 0.5 + cross * cross * square
}

#[cfg(test)]
mod tests {
    use super::*;
    use funicular::math::Rotation;

    #[test]
    fn the_rate_of_a_rotation_vector_is_its_difference() {
        for size in [1e-9, 1e-3, 0.009_99, 0.010_01, 0.7, 3.0] {
            let theta = Vec3::new(0.3, -0.8, 0.5).normalize() * size;
            let rate = rate_of_rotation_vector(&theta);
            for axis in [Vec3::x(), Vec3::y(), Vec3::z()] {
                let step = 1e-6;
                let [before, after] = [-step, step].map(|step| {
                    (Rotation::from_scaled_axis(axis * step) * Rotation::from_scaled_axis(theta)).scaled_axis()
                });
                // Rounding of the vectors over the step, and the cube of the step.
                let error = ((after - before) / (2.0 * step) - rate * axis).norm();
                assert!(error < 2e-9, "{size}: {error:e}");
            }
        }
    }
}
