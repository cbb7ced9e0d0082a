//! Flexible supports in space, for the figures of a robot.

use funicular::math::Vec3;
use funicular::robot::{Robot, Support};
use funicular::statics::Equilibrium;

/// Flexible support with its anchors at an equilibrium.
pub(crate) struct SupportAtRest {
    pub(crate) name: String,
    /// Entry points of its cables, displaced.
    pub(crate) anchors: Vec<Vec3>,
    /// Displacement [m].
    pub(crate) displacement: Vec3,
}

impl SupportAtRest {
    /// All supports of a robot at an equilibrium.
    pub(crate) fn all(robot: &Robot, equilibrium: &Equilibrium) -> Vec<Self> {
        let of = |(i, (support, displacement)): (usize, (&Support, Vec3))| {
            let carried = robot.cables.iter().zip(&equilibrium.cables);
            let carried = carried.filter(|(cable, _)| cable.anchor.support == Some(i));
            let anchors = carried.map(|(cable, state)| cable.anchor.reference_w() + state.displacement_w).collect();
            Self { name: support.name.clone(), anchors, displacement }
        };
        robot.supports.iter().zip(equilibrium.support_displacements(robot)).enumerate().map(of).collect()
    }

    /// Mean of the anchors.
    pub(crate) fn middle(&self) -> Vec3 {
        self.anchors.iter().sum::<Vec3>() / self.anchors.len().max(1) as f64
    }
}
