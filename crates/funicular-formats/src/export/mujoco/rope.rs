//! Rope with mass in MuJoCo: rigid bars that hang from the platform, and a tendon from the last joint to the anchor.
//!
//! The bars are those of [`Chain`] at their length at rest. Two hinges turn each bar against the one before it: a ball
//! would add its spin, which nothing holds. A bar of the mass m and the length h has the moment of inertia m h²/6, the
//! mean of a rod's and of two half masses at its ends: the errors that both have in the waves across the rope cancel.
//!
//! The stretch of the rope is in two springs, the slide of the first bar and the tendon, so that no wave along the
//! rope limits the time step. Let u be the motion of the platform along the rope and r the part of the free span in the
//! compliance of the whole cable. A rope that stretches evenly moves by u (1 − r x) at the part x of its length, and
//! has the kinetic energy of the mass m (1 − r + r²/3). Bars behind a part α of the span's compliance all move by u (1
//! − α r); α is such that both are equal.

use super::super::chain::Chain;
use super::super::springs::{CableSpring, SpringRobot, in_plane};
use super::{tensor, vector};
use funicular::math::{Mat3, Vec3};
use std::iter::once;

/// Moment of inertia of a bar about its axis, over that across it: that of a rope as thick as a ninetieth of a bar.
const THIN: f64 = 1e-4;
/// Part of its length that the piece at the anchor keeps when the winch takes rope in. Across it, the last joint is
/// held by the tension over this length, so that less needs shorter time steps.
const KEPT_PIECE: f64 = 0.2;

/// Bars of a cable and the spring of the first one.
pub(super) struct ChainedRope {
    pub(super) bars: Vec<RigidBar>,
    /// Spring between the platform and the first bar: stiffness [N/m], length without force [m] and damping [N s/m].
    pub(super) stiffness: f64,
    pub(super) reference: f64,
    pub(super) damping: f64,
    /// Length of the free span behind the last bar [m].
    pub(super) span: f64,
    /// Most rope that the winch takes in, and lets out [m].
    pub(super) most_in: f64,
    pub(super) most_out: f64,
    /// Bound of the angular frequencies of the chain [rad/s].
    pub(super) fastest: f64,
}

/// Bar as a body in the frame of the one before it; frames have the axes of the platform.
pub(super) struct RigidBar {
    pub(super) position: String,
    pub(super) along: String,
    pub(super) across: [String; 2],
    pub(super) end: String,
    pub(super) mass: f64,
    pub(super) center: String,
    pub(super) inertia: String,
}

impl ChainedRope {
    /// Cable `i` as the chain that hangs where it does; `whole` is the spring of the complete cable.
    pub(super) fn of(springs: &SpringRobot, i: usize, chain: &Chain, whole: &CableSpring) -> Self {
        let (cable, state) = (&springs.robot.cables[i], &springs.equilibrium.cables[i]);
        let count = chain.tensions.len();
        let mass = chain.weight_factor * cable.material.mass_per_length * state.free_length() / count as f64;

        let compliance = 1.0 / whole.stiffness;
        let r = state.free_length() / cable.material.axial_stiffness / compliance;
        let at_platform = compliance * (1.0 - (1.0 - r + r * r / 3.0).sqrt());

        let to_platform = springs.equilibrium.pose.rot_wp.inverse();
        let steps: Vec<Vec3> = chain.nodes_w.windows(2).map(|pair| to_platform * (pair[1] - pair[0])).collect();
        let starts = once(&cable.attachment_p).chain(&steps);
        let bars = (starts.zip(&steps[..count - 1]).enumerate())
            .map(|(k, (start, step))| RigidBar::of(start, step, mass, k + 2 == count))
            .collect();

        let span = steps[count - 1].norm();
        Self {
            bars,
            stiffness: 1.0 / at_platform,
            // The slide carries the whole first bar, whose tension is that of its middle.
            reference: -(to_platform * state.force_on_platform_w).dot(&steps[0].normalize()) * at_platform,
            damping: whole.damping / whole.stiffness / at_platform,
            span,
            most_in: (1.0 - KEPT_PIECE) * span,
            most_out: state.unstrained_length,
            fastest: fastest(chain, mass, at_platform, compliance),
        }
    }

    /// Spring of the tendon behind the last bar.
    pub(super) fn anchor_spring(&self, whole: &CableSpring, chain: &Chain) -> CableSpring {
        let stiffness = 1.0 / (1.0 / whole.stiffness - 1.0 / self.stiffness);
        let damping = whole.damping / whole.stiffness * stiffness;
        CableSpring { stiffness, damping, tension: chain.tensions[chain.tensions.len() - 1] }
    }
}

impl RigidBar {
    /// Bar along a step from its start, with a mass. The last one also carries half of the mass of the piece behind it,
    /// at its end; with the same moment of inertia the errors of the waves cancel there as well, up to the fourth
    /// order.
    fn of(start: &Vec3, step: &Vec3, mass: f64, is_last: bool) -> Self {
        let length = step.norm();
        let along = step / length;
        let [first, second] = in_plane(&along);

        let (all, center) = if is_last { (1.5 * mass, 2.0 / 3.0) } else { (mass, 0.5) };
        let about = (Mat3::identity() - along * along.transpose() * (1.0 - THIN)) * (mass * length * length / 6.0);
        Self {
            position: vector(start),
            along: vector(&along),
            across: [vector(&first), vector(&second)],
            end: vector(step),
            mass: all,
            center: vector(&(step * center)),
            inertia: tensor(&about),
        }
    }
}

/// Bound of the angular frequencies of a chain of bars of a mass [rad/s].
///
/// Across, neighbouring joints that swing against each other have ω² = 6 T/(m h), and the last one, beside the
/// shortest piece at the anchor, no more than twice as much. Along, all bars move between both springs.
fn fastest(chain: &Chain, mass: f64, at_platform: f64, compliance: f64) -> f64 {
    let bars = chain.tensions.len() - 1;
    let lengths = chain.nodes_w.windows(2).map(|pair| (pair[1] - pair[0]).norm());
    let across = chain.tensions.iter().zip(lengths).map(|(tension, length)| 12.0 * tension / (mass * length));
    let along = (1.0 / at_platform + 1.0 / (compliance - at_platform)) / (mass * (bars as f64 + 0.5));
    across.fold(along, f64::max).sqrt()
}
