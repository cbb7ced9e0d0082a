//! Level sets: the part of a box in which a function of a point is not negative, its boundary, volume, parts and holes.
//!
//! The function may be anything that has a number at a point, or none, which counts as outside. Two ways lead to the
//! set. [`LevelSet`] evaluates a grid and finds any number of parts and holes that are not thinner than its steps.
//! [`RaySet`] goes outwards from a centre along the rays of a [`Sphere`].
//!
//! Neither calls the function itself: they ask for the values of many points at once ([`Evaluate`]), so that the caller
//! can share the work among threads, show progress and stop it.

mod boundary;
mod edge_root;
mod error;
mod grid;
mod inner_box;
mod nodes;
mod rays;
mod section;
mod set;
mod sphere;
mod tetrahedra;

pub use boundary::{BoundaryMesh, SetPart};
pub use grid::{BOX_FACES, MAX_NODES, PointGrid};
pub use rays::{FirstBorder, RayIntervals, RaySet, RaysInBox, first_borders};
pub use section::{SetSection, signed_area};
pub use set::{LevelSet, SearchEnd};
pub use sphere::Sphere;

use crate::math::Vec3;

/// Values of the function at points, in their order: not negative inside the set, negative outside, `None` where the
/// function has no value. The whole answer is `None` if the work shall stop.
pub type Evaluate<'a> = dyn FnMut(&[Vec3]) -> Option<Vec<Option<f64>>> + 'a;

/// True for a value inside the set.
fn is_inside(value: Option<f64>) -> bool {
    value.is_some_and(|value| value >= 0.0)
}
