//! Ways around: from pose to pose through others where the straight move touches.

use super::{PoseRow, rest_at};
use crate::Watch;
use crate::at_rest::AtRest;
use crate::error::{Cancelled, NoSolution};
use crate::rows::rows;
use crate::text::decimals;
use anyhow::Result;
use funicular::clearance::Surroundings;
use funicular::math::Vec3;
use funicular::path::StraightMove;
use funicular::robot::{PlatformMotion, Pose, Robot};

/// Number of positions along each axis of the lattice of poses through which a way may lead.
const LATTICE: usize = 5;

/// Maximum number of straight moves that a search examines: some ten seconds for a robot with eight sagging cables.
const MAX_MOVES: usize = 1000;

rows! {
    /// Way from the pose of the state to the end of a move.
    pub struct WayAround {
        /// Poses between both, in their order; absent if no way was found, which does not mean that there is none.
        pub through: Option<Vec<PoseRow>>;
        /// Number of straight moves that were examined.
        pub moves_examined: usize;
    }
}

/// Refuses a search between two poses one of which is not free itself: no way leads there.
///
/// # Errors
/// [`NoSolution`] with the pair that is nearest at this pose.
pub(super) fn refuse_blocked(at_rest: &AtRest, around: &Surroundings, end: &Pose) -> Result<()> {
    for (which, key, pose) in [("start", "pose", &at_rest.equilibrium.pose), ("end", "move_to", end)] {
        if around.is_free_way(&StraightMove::between(pose, pose), &mut rest_at(at_rest)) {
            continue;
        }
        let rest = rest_at(at_rest)(pose).map_err(|error| {
            let text = format!("at the {which} of the move: {error}");
            if error.is_no_solution() { NoSolution(text).into() } else { anyhow::anyhow!(text) }
        })?;
        let nearest = around.least(&rest, None).map_or_else(String::new, |pair| {
            let (distance, required) = (decimals(pair.distance, 4), decimals(pair.required, 4));
            format!(": {} are {distance} m apart, and {required} m are required", around.pair_text(pair.pair))
        });
        let text =
            format!("no way leads to the {which} of the move, which is not free itself{nearest}; give another ⟪{key}⟫");
        return Err(NoSolution(text).into());
    }
    Ok(())
}

impl WayAround {
    /// Searches a way through a lattice of positions between the anchors, with the orientations of both ends.
    ///
    /// # Errors
    /// Work that was stopped.
    pub(super) fn find(at_rest: &AtRest, around: &Surroundings, end: &Pose, watch: &dyn Watch) -> anyhow::Result<Self> {
        let start = at_rest.equilibrium.pose;
        let candidates = candidates(&at_rest.robot, [&start, end]);
        let mut rest_at = rest_at(at_rest);
        // A move through poses without an equilibrium is none, so that a stopped search ends soon.
        let mut watched = |pose: &Pose| {
            if watch.is_cancelled() { Err(()) } else { rest_at(pose).map_err(|_| ()) }
        };
        let found = around.free_way([&start, end], &candidates, MAX_MOVES, &mut watched);
        if watch.is_cancelled() {
            return Err(Cancelled.into());
        }
        Ok(Self {
            through: found.through.map(|poses| poses.iter().map(PoseRow::of).collect()),
            moves_examined: found.moves,
        })
    }
}

/// Poses of the lattice: inside the box of anchors and both poses, in the plane of a planar platform, each orientation
/// of the ends once.
fn candidates(robot: &Robot, ends: [&Pose; 2]) -> Vec<Pose> {
    let corners = robot.cables.iter().map(|cable| cable.anchor.reference_w()).chain(ends.map(|pose| pose.position_w));
    let (lower, upper) = corners.fold((ends[0].position_w, ends[0].position_w), |(lower, upper), corner| {
        (lower.inf(&corner), upper.sup(&corner))
    });
    let turns = if ends[0].rot_wp == ends[1].rot_wp { 1 } else { 2 };

    let at = |k: usize, i: usize| lower[k] + (upper[k] - lower[k]) * (i as f64 + 0.5) / LATTICE as f64;
    let in_plane = |position_w: Vec3| match &robot.platform.motion {
        PlatformMotion::Planar(plane) => {
            let normal_w = plane.normal_w();
            position_w - normal_w * normal_w.dot(&(position_w - ends[0].position_w))
        }
        PlatformMotion::Rigid | PlatformMotion::PointMass => position_w,
    };
    let mut poses = Vec::new();
    for (i, j, k) in (0..LATTICE.pow(3)).map(|n| (n % LATTICE, n / LATTICE % LATTICE, n / LATTICE / LATTICE)) {
        let position_w = in_plane(Vec3::new(at(0, i), at(1, j), at(2, k)));
        poses.extend(ends[..turns].iter().map(|end| Pose { position_w, rot_wp: end.rot_wp }));
    }
    poses
}
