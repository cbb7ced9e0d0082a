//! Faces of the body spanned by points in space.

use super::view::{extent, polygon};
use funicular::math::Vec3;

/// Corners of each face in their order around the face: faces of the convex hull, or one polygon if all points lie in a
/// plane. Empty if all points coincide.
///
/// A plane through three points with all others on one side holds a face. The search takes n⁴ steps, and a platform has
/// few attachments.
pub(crate) fn faces(points: &[Vec3]) -> Vec<Vec<usize>> {
    let reach = extent(points);
    if reach <= 0.0 {
        return Vec::new();
    }
    if let Some(order) = polygon(points, reach) {
        return vec![order];
    }

    let mut faces = flat_corners(points, reach);
    for corners in &mut faces {
        let around: Vec<Vec3> = corners.iter().map(|&l| points[l]).collect();
        if let Some(order) = polygon(&around, reach) {
            *corners = order.iter().map(|&at| corners[at]).collect();
        }
    }
    faces
}

/// Corners of each flat side of the convex hull, in no order around it.
fn flat_corners(points: &[Vec3], reach: f64) -> Vec<Vec<usize>> {
    let mut faces: Vec<Vec<usize>> = Vec::new();
    for i in 0..points.len() {
        for j in i + 1..points.len() {
            for k in j + 1..points.len() {
                let Some(corners) = corners_of_side(points, [i, j, k], reach) else { continue };
                if !faces.contains(&corners) {
                    faces.push(corners);
                }
            }
        }
    }
    faces
}

/// Points in the plane of three points; `None` if the three are nearly on a line, or if points lie on both sides of
/// their plane.
fn corners_of_side(points: &[Vec3], [i, j, k]: [usize; 3], reach: f64) -> Option<Vec<usize>> {
    let normal = (points[j] - points[i]).cross(&(points[k] - points[i]));
    if normal.norm() < 1e-6 * reach * reach {
        return None;
    }

    let normal = normal.normalize();
    let height = |p: &Vec3| normal.dot(&(p - points[i]));
    let above = points.iter().any(|p| height(p) > 1e-3 * reach);
    let below = points.iter().any(|p| height(p) < -1e-3 * reach);
    if above && below {
        return None;
    }
    Some((0..points.len()).filter(|&l| height(&points[l]).abs() <= 1e-3 * reach).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_has_six_faces_of_four_corners_each_around_the_face() {
        let corner = |k: usize| Vec3::new((k & 1) as f64, 0.5 * (k >> 1 & 1) as f64, 0.3 * (k >> 2) as f64);
        let points: Vec<Vec3> = (0..8).map(corner).collect();
        let faces = faces(&points);
        assert_eq!(faces.len(), 6);
        for face in &faces {
            assert_eq!(face.len(), 4);
            // Neighbours share an edge of the box: they differ in one coordinate.
            for (at, &corner) in face.iter().enumerate() {
                let next = face[(at + 1) % 4];
                assert_eq!((corner ^ next).count_ones(), 1, "{face:?}");
            }
        }
    }

    #[test]
    fn flat_platforms_are_one_polygon_and_points_have_no_face() {
        let ring: Vec<Vec3> = (0..6).map(|k| Vec3::new(f64::from(k).cos(), f64::from(k).sin(), 1.0)).collect();
        assert_eq!(faces(&ring).len(), 1);
        assert_eq!(faces(&ring)[0].len(), 6);
        assert!(faces(&[Vec3::z(); 4]).is_empty());
    }
}
