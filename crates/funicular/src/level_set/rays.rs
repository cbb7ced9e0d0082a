//! The set along rays from a centre: every interval of each ray.

use super::boundary::BoundaryMesh;
use super::edge_root::EdgeRoot;
use super::sphere::Sphere;
use super::{Evaluate, is_inside};
use crate::math::Vec3;

/// Search along rays.
#[derive(Debug, Clone, PartialEq)]
pub struct RaysInBox {
    /// Point from which the rays go out.
    pub center: Vec3,
    /// Corners of the box in which the rays end.
    pub bounds: [Vec3; 2],
    /// Largest distance of the points of a ray between which the function is followed [m].
    pub step: f64,
    /// Tolerance of the ends of the intervals [m].
    pub tolerance: f64,
}

/// Intervals of a ray inside the set.
#[derive(Debug, Clone, PartialEq)]
pub struct RayIntervals {
    /// Distances from the centre [m], ascending.
    pub intervals: Vec<[f64; 2]>,
    /// Distance at which the ray leaves the box [m].
    pub end: f64,
}

impl RayIntervals {
    /// True if the set reaches the end of the ray, behind which it may go on.
    pub fn is_cut(&self) -> bool {
        self.intervals.last().is_some_and(|interval| interval[1] >= self.end)
    }
}

/// Set along the rays of a sphere.
///
/// # References
/// docs/theory.md, section 10b.
pub struct RaySet {
    sphere: Sphere,
    center: Vec3,
    rays: Vec<RayIntervals>,
    evaluations: usize,
}

impl RaySet {
    /// Finds the intervals of every ray. `None` if the work was stopped, or if the centre is not in the box.
    pub fn find(sphere: Sphere, search: &RaysInBox, evaluate: &mut Evaluate<'_>) -> Option<Self> {
        let RaysInBox { center, step, tolerance, .. } = *search;
        let ends: Vec<f64> = sphere.directions().iter().map(|ray| length_in(search, ray)).collect::<Option<_>>()?;

        // Points along the rays, from the centre to the end of each.
        let count = |end: &f64| (end / step).ceil().max(1.0) as usize;
        let points: Vec<(usize, f64)> = (ends.iter().enumerate())
            .flat_map(|(ray, end)| (1..=count(end)).map(move |k| (ray, end * k as f64 / count(end) as f64)))
            .collect();
        let at = |(ray, distance): (usize, f64)| center + sphere.directions()[ray] * distance;
        let places: Vec<Vec3> = std::iter::once(center).chain(points.iter().map(|point| at(*point))).collect();
        let values = evaluate(&places)?;

        // Between two points that do not agree there is an end of an interval.
        let mut roots = Vec::new();
        let mut of_rays = Vec::new();
        let mut before = (usize::MAX, 0.0, None);
        for ((ray, distance), value) in points.into_iter().zip(values[1..].iter().copied()) {
            let (of, near, near_value) = before;
            let (near, near_value) = if of == ray { (near, near_value) } else { (0.0, values[0]) };
            if is_inside(near_value) != is_inside(value) {
                let segment = [at((ray, near)), at((ray, distance))];
                let (segment, ends) = if is_inside(value) {
                    ([segment[1], segment[0]], [value, near_value])
                } else {
                    (segment, [near_value, value])
                };
                roots.push(EdgeRoot::new(segment, ends, tolerance));
                of_rays.push(ray);
            }
            before = (ray, distance, value);
        }
        let (polishing, found) = EdgeRoot::find_all(&mut roots, tolerance, evaluate);
        if !found {
            return None;
        }

        let mut rays: Vec<RayIntervals> =
            ends.into_iter().map(|end| RayIntervals { intervals: Vec::new(), end }).collect();
        let mut changes: Vec<Vec<f64>> = vec![Vec::new(); rays.len()];
        for (root, ray) in roots.iter().zip(of_rays) {
            changes[ray].push((root.end() - center).norm());
        }
        for (ray, mut changes) in rays.iter_mut().zip(changes) {
            if is_inside(values[0]) {
                changes.insert(0, 0.0);
            }
            if changes.len() % 2 == 1 {
                changes.push(ray.end);
            }
            ray.intervals = changes.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
        }
        Some(Self { sphere, center, rays, evaluations: places.len() + polishing })
    }

    /// Directions of the rays.
    pub fn sphere(&self) -> &Sphere {
        &self.sphere
    }

    /// Intervals of each ray, in the order of the directions.
    pub fn rays(&self) -> &[RayIntervals] {
        &self.rays
    }

    /// Number of evaluations of the function.
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// Volume of all intervals [m³], each ray standing for its solid angle.
    pub fn volume(&self) -> f64 {
        let cubes =
            |ray: &RayIntervals| ray.intervals.iter().map(|[from, to]| (to.powi(3) - from.powi(3)) / 3.0).sum::<f64>();
        self.sphere.solid_angles().iter().zip(&self.rays).map(|(angle, ray)| angle * cubes(ray)).sum()
    }

    /// Surface of triangles between the ends of the first intervals; `None` if the centre is not inside the set.
    pub fn hull(&self) -> Option<BoundaryMesh> {
        let first = |ray: &RayIntervals| {
            ray.intervals.first().filter(|interval| interval[0] <= 0.0).map(|interval| interval[1])
        };
        let lengths: Vec<f64> = self.rays.iter().map(first).collect::<Option<_>>()?;
        Some(self.sphere.hull(self.center, &lengths))
    }
}

/// First border of the set along a ray from a centre inside it, or the end of the ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstBorder {
    /// Distance from the centre [m].
    pub distance: f64,
    /// True if the set ends there; otherwise the ray leaves the box.
    pub is_border: bool,
}

/// First border of the set along each ray from its centre, without what lies behind: all rays go outwards by the same
/// steps, and each stops at its first point outside. Empty if the centre is not inside the set; `None` if the work was
/// stopped, or if the centre is not in the box.
///
/// # References
/// docs/theory.md, section 10b.
pub fn first_borders(directions: &[Vec3], search: &RaysInBox, evaluate: &mut Evaluate<'_>) -> Option<Vec<FirstBorder>> {
    let RaysInBox { center, step, tolerance, .. } = *search;
    let lengths: Vec<f64> = directions.iter().map(|ray| length_in(search, ray)).collect::<Option<_>>()?;
    let at_center = evaluate(&[center])?[0];
    if !is_inside(at_center) {
        return Some(Vec::new());
    }

    // Rays that are still inside, with the distance and the value of their last point.
    let mut going: Vec<(usize, f64, Option<f64>)> = (0..directions.len()).map(|ray| (ray, 0.0, at_center)).collect();
    let mut roots = Vec::new();
    let mut of_rays = Vec::new();
    while !going.is_empty() {
        let next: Vec<f64> = going.iter().map(|(ray, distance, _)| (distance + step).min(lengths[*ray])).collect();
        let at = |ray: usize, distance: f64| center + directions[ray] * distance;
        let places: Vec<Vec3> = going.iter().zip(&next).map(|((ray, ..), distance)| at(*ray, *distance)).collect();
        let values = evaluate(&places)?;
        let mut inside = Vec::new();
        for (((ray, near, near_value), far), value) in going.into_iter().zip(next).zip(values) {
            if !is_inside(value) {
                roots.push(EdgeRoot::new([at(ray, near), at(ray, far)], [near_value, value], tolerance));
                of_rays.push(ray);
            } else if far < lengths[ray] {
                inside.push((ray, far, value));
            }
        }
        going = inside;
    }

    if !EdgeRoot::find_all(&mut roots, tolerance, evaluate).1 {
        return None;
    }
    let mut ends: Vec<FirstBorder> =
        lengths.iter().map(|length| FirstBorder { distance: *length, is_border: false }).collect();
    for (root, ray) in roots.iter().zip(of_rays) {
        ends[ray] = FirstBorder { distance: (root.end() - center).norm(), is_border: true };
    }
    Some(ends)
}

/// Length of a ray from the centre to where it leaves the box; `None` if the centre is not inside the box.
fn length_in(search: &RaysInBox, ray: &Vec3) -> Option<f64> {
    let [low, high] = search.bounds;
    let to_face = |k: usize| {
        let face = if ray[k] > 0.0 { high[k] } else { low[k] };
        if ray[k] == 0.0 { f64::INFINITY } else { (face - search.center[k]) / ray[k] }
    };
    let is_within = (0..3).all(|k| search.center[k] > low[k] && search.center[k] < high[k]);
    is_within.then(|| (0..3).map(to_face).fold(f64::INFINITY, f64::min))
}
