//! Wrenches that the cables can apply at a pose with tensions within their limits.
//!
//! Each cable contributes a curve, on which its tension is the parameter; the set is the sum of these curves. Straight
//! cables have segments, and the set is a zonotope.

mod cable_at_pose;
mod chords;
mod facets;
mod reach;

pub use cable_at_pose::TensionPlace;
pub(super) use cable_at_pose::{CableAtPose, Rates, TensionByTau};
pub(super) use chords::{AvailableWrenches, BulgeSearch, Facet};
pub(super) use reach::{CurveBetween, CurvePoint, ReachableTensions, WrenchSet, spread_start};
