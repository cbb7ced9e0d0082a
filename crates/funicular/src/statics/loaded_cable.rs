//! Cable with its load, before its length is known.

use super::model::StaticModel;
use crate::catenary::Rope;
use crate::catenary::space::HangingCable;
use crate::drive::CableAtRest;
use crate::math::Vec3;
use crate::robot::{Cable, LineLoad, Pose, Robot};

/// Maximum ratio of unstrained length to chord in the search for slack cables at a pose where straight cables would
/// have negative tension. For 30,000 random robots in equilibrium with cables up to 1.25 times as long as their chords,
/// the limit 2 finds every equilibrium. Poses that only longer ropes hold are held by the ropes' weight alone.
pub(super) const MAX_LENGTH_RATIO: f64 = 2.0;

/// Cable without its length: anchor, rope and load.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LoadedCable<'a> {
    pub(super) cable: &'a Cable,
    /// Load; its size is zero in a straight model.
    pub(crate) load: LineLoad,
}

impl<'a> LoadedCable<'a> {
    /// Cable `i` in a static model, with the load that it has at a pose.
    pub(crate) fn at(robot: &'a Robot, i: usize, pose: &Pose, model: StaticModel) -> Self {
        let cable = &robot.cables[i];
        let mut load = robot.line_load(i, &cable.chord_w(pose));
        if model != StaticModel::Catenary {
            load.size = 0.0;
        }
        Self { cable, load }
    }

    /// All cables.
    pub(super) fn all(robot: &'a Robot, pose: &Pose, model: StaticModel) -> Vec<Self> {
        (0..robot.cables.len()).map(|i| Self::at(robot, i, pose, model)).collect()
    }

    /// Axial stiffness EA [N].
    pub(super) fn axial_stiffness(&self) -> f64 {
        self.cable.material.axial_stiffness
    }

    /// Chord at a pose, attachment to anchor, world axes [m].
    pub(super) fn chord_w(&self, pose: &Pose) -> Vec3 {
        self.cable.chord_w(pose)
    }

    /// Cable hung from the platform at a pose with an unstrained length [m], drum side included.
    pub(super) fn hang(&self, pose: &Pose, unstrained_length: f64) -> CableAtRest {
        CableAtRest::hang(pose.point_w(&self.cable.attachment_p), self.cable, &self.load, unstrained_length)
    }

    /// Free span hung with this tension parallel to its chord [N], which must not be far below its weight. A pulley is
    /// where a straight cable would turn it.
    pub(super) fn hang_with_tension(&self, pose: &Pose, tension: f64) -> HangingCable {
        let start_w = pose.point_w(&self.cable.attachment_p);
        let exit_w = self.cable.anchor.exit_w(&start_w);
        let rope = Rope {
            // The tension fixes the length; this value is only the start of the search for it.
            unstrained_length: (exit_w - start_w).norm(),
            weight_per_length: self.load.size,
            axial_stiffness: self.axial_stiffness(),
        };
        HangingCable::with_parallel_tension(start_w, exit_w, self.load.up_w, rope, tension)
    }

    /// Unstrained length [m], drum side included, with which the free span has this tension parallel to its chord [N].
    pub(super) fn length_with_tension(&self, pose: &Pose, tension: f64) -> f64 {
        let start_w = pose.point_w(&self.cable.attachment_p);
        let anchor = &self.cable.anchor;
        let span = self.hang_with_tension(pose, tension);
        CableAtRest::with_span(span, anchor, anchor.contact(&start_w)).unstrained_length()
    }
}
