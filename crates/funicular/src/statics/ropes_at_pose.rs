//! Equilibrium at a pose with ropes over sheaves: one tension per rope.

use super::equilibrium::Equilibrium;
use super::error::StaticsError;
use super::forward::forward;
use super::model::StaticModel;
use super::nearest_pose::gap;
use super::ropes::{self, RunningEnd};
use super::stiffness::tangent_stiffness;
use super::tension::{TensionRule, distribute_tensions};
use crate::math::{DMat, DVec, Vec6};
use crate::platform::{Coordinates, load_size};
use crate::robot::{Constraint, Pose, Robot};

/// Maximum number of steps towards the nearest pose, a guard: 4 to 10 are usual.
const MAX_STEPS: usize = 100;

/// Maximum number of halvings of a step that does not come nearer.
const MAX_HALVINGS: usize = 20;

/// Maximum change of a length in a step, over the length.
const MAX_CHANGE: f64 = 0.2;

/// Remaining approach, over the size of the robot, at which a pose counts as nearest; and the value that is accepted if
/// rounding allows no further approach.
const MAX_APPROACH: f64 = 1e-11;
const NEAR: f64 = 1e-6;

/// Ratio of a singular value to the largest one below which a change of lengths does not move the platform.
const IDLE: f64 = 1e-10;

/// Robot with ropes over sheaves at a requested pose.
pub(super) struct RopesAtPose<'a> {
    pub(super) robot: &'a Robot,
    pub(super) pose: &'a Pose,
    pub(super) model: StaticModel,
    /// Rule for more ropes than degrees of freedom.
    pub(super) rule: &'a TensionRule,
}

impl RopesAtPose<'_> {
    /// Equilibrium at the pose; with fewer ropes than degrees of freedom at the nearest pose that they hold, with its
    /// distance [m].
    ///
    /// # Errors
    /// [`StaticsError`] of the solver, by the number of ropes.
    pub(super) fn solved(&self) -> Result<(Equilibrium, Option<f64>), StaticsError> {
        if self.robot.constraint().is_under() {
            let (equilibrium, distance) = self.nearest()?;
            return Ok((equilibrium, Some(distance)));
        }
        Ok((self.held()?, None))
    }

    /// Equilibrium at the pose itself.
    ///
    /// # Errors
    /// [`StaticsError`]: fewer ropes than degrees of freedom, or no tensions that hold the pose.
    pub(super) fn held(&self) -> Result<Equilibrium, StaticsError> {
        let constraint = self.robot.constraint();
        if constraint.is_under() {
            let (cables, dof) = (self.robot.rope_count(), self.robot.platform.motion.count());
            return Err(StaticsError::InverseCableCount { cables, dof });
        }
        let found = distribute_tensions(self.robot, self.pose, self.model, self.rule);
        let found = match found {
            // Without limits the violation is the part of the load that the ropes do not balance.
            Err(StaticsError::NotFoundWithinLimits { miss, .. }) if constraint == Constraint::Fully => {
                let residual = miss.by / load_size(self.robot).max(miss.by);
                return Err(StaticsError::RopesDoNotHold { residual });
            }
            found => found?,
        };
        ropes::check_balance(self.robot, &found.cables)?;
        Ok(found)
    }

    /// Equilibrium with the lengths that bring the platform nearest to the pose, and its distance [m]: Gauss and
    /// Newton's method on the lengths of the ropes.
    fn nearest(&self) -> Result<(Equilibrium, f64), StaticsError> {
        ropes::check(self.robot, self.model)?;
        self.robot.platform.motion.check(self.pose)?;
        let ropes_of = self.robot.cables_of_ropes();
        let share = load_size(self.robot) / self.robot.cables.len() as f64;
        let mut lengths: Vec<f64> = (self.robot.cables.iter())
            .map(|cable| cable.straight_length(self.pose) / (1.0 + share / cable.material.axial_stiffness))
            .collect();
        let size = self.robot.platform_length() + lengths.iter().copied().fold(0.0, f64::max);
        let mut here = forward(self.robot, &lengths, self.model, Some(self.pose))?;
        let mut missing = gap(self.robot, &here.pose, self.pose);
        let mut approach = f64::INFINITY;

        for _ in 0..MAX_STEPS {
            let Some((step, moved)) = self.step(&here, &ropes_of, &missing) else { break };
            approach = moved / size;
            if approach <= MAX_APPROACH {
                break;
            }

            // Lengthen each rope in proportion, by no more than the maximum, and by less if that comes no nearer.
            let changes: Vec<f64> = (step.iter().zip(&ropes_of))
                .map(|(step, cables)| step / cables.iter().map(|i| lengths[*i]).sum::<f64>())
                .collect();
            let most = changes.iter().fold(0.0, |most: f64, change| most.max(change.abs()));
            let mut part = (MAX_CHANGE / most).min(1.0);
            let mut taken = None;
            for _ in 0..MAX_HALVINGS {
                let mut next = lengths.clone();
                for (change, cables) in changes.iter().zip(&ropes_of) {
                    for i in cables {
                        next[*i] *= 1.0 + part * change;
                    }
                }
                let found = forward(self.robot, &next, self.model, Some(&here.pose));
                let left = found.as_ref().map(|found| gap(self.robot, &found.pose, self.pose));
                if let (Ok(found), Ok(left)) = (&found, left)
                    && left.norm() < missing.norm()
                {
                    taken = Some((next, found.clone(), left));
                    break;
                }
                part *= 0.5;
            }
            let Some((next, found, left)) = taken else { break };
            (lengths, here, missing) = (next, found, left);
        }

        if approach > NEAR {
            let p = here.pose.position_w;
            let (iterations, limit) = (here.iterations, NEAR);
            return Err(StaticsError::NotNearest { iterations, residual: approach, limit, x: p.x, y: p.y, z: p.z });
        }
        let distance = missing.norm();
        Ok((here, distance))
    }

    /// Change of the length of each rope [m] that comes nearest to a motion of the platform, scaled, to first order;
    /// and the size of the motion that it gives [m]. `None` without stiffness.
    fn step(&self, here: &Equilibrium, ropes_of: &[Vec<usize>], motion: &Vec6) -> Option<(DVec, f64)> {
        let coordinates = Coordinates::of(self.robot);
        let dof = coordinates.count();
        let ends: Vec<RunningEnd> = here.cables.iter().map(RunningEnd::of_state).collect::<Option<_>>()?;
        let stiffness = coordinates.reduce_symmetric(&tangent_stiffness(&self.running(), here)?);
        let wrenches = DMat::from_fn(dof, ropes_of.len(), |i, j| {
            coordinates.reduce(&ropes::wrench_by_length(&ropes_of[j], &ends))[i]
        });
        let moved = DMat::from_fn(dof, dof, |i, j| stiffness[(i, j)]).lu().solve(&wrenches)?;
        let target = DVec::from_fn(dof, |i, _| motion[i]);
        let svd = moved.clone().svd(true, true);
        let step = svd.solve(&target, IDLE * svd.singular_values.max()).ok()?;
        let reached = (&moved * &step).norm();
        Some((step, reached))
    }

    /// Robot whose ropes run over all sheaves, as they do while the platform is brought to its place.
    fn running(&self) -> Robot {
        let mut robot = self.robot.clone();
        robot.ropes.iter_mut().flat_map(|rope| &mut rope.efficiencies).for_each(|efficiency| *efficiency = 1.0);
        robot
    }
}
