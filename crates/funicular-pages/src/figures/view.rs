//! View of points in space that pages and figures share: place of the eye, ranges, order around a face, sides of
//! labels.

use funicular::math::Vec3;

/// Position of the eye: to the side and a little above, so that sag is visible.
pub(crate) const EYE: [f64; 3] = [0.7, -1.65, 0.5];

/// Range of each axis around points.
pub(crate) fn ranges(points: &[Vec3], floor: bool) -> [(f64, f64); 3] {
    let bounds = |k: usize| {
        let values = || points.iter().map(|p| p[k]);
        (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max))
    };
    let mut ranges = [0, 1, 2].map(bounds);
    // A margin, and a minimum extent for flat robots.
    let size = ranges.iter().map(|(low, high)| high - low).fold(0.0, f64::max);
    for (low, high) in &mut ranges {
        let more = 0.04 * size + (0.06 * size - 0.5 * (*high - *low)).max(0.0);
        (*low, *high) = (*low - more, *high + more);
    }
    if floor && bounds(2).0 >= 0.0 {
        ranges[2].0 = 0.0;
    }
    ranges
}

/// Labels in which the names of close neighbours are joined at the first of them, so that names do not overlap.
pub(crate) fn joined(points: &[Vec3], names: &[String], places: &[&str], reach: f64) -> Vec<String> {
    let same = |i: usize, j: usize| places[i] == places[j] && (points[i] - points[j]).norm() < 0.06 * reach;
    (0..points.len())
        .map(|i| {
            let others = if (0..i).any(|j| same(i, j)) { 0..0 } else { i..points.len() };
            others.filter(|&j| same(i, j)).map(|j| names[j].as_str()).collect::<Vec<_>>().join(", ")
        })
        .collect()
}

/// Position of each point's name: below the point if another point is close above it, otherwise above. Coinciding
/// points use different sides, so that their names do not overlap.
pub(crate) fn sides(points: &[Vec3], reach: f64) -> Vec<&'static str> {
    const COINCIDING: [&str; 4] = ["middle left", "middle right", "top center", "bottom center"];
    points
        .iter()
        .enumerate()
        .map(|(i, p)| {
            let same = points[..i].iter().filter(|q| (*q - p).norm() < 0.01 * reach).count();
            let crowded = points.iter().any(|q| q.z - p.z > 0.5 * (q - p).norm() && (q - p).norm() < 0.12 * reach);
            match (same, crowded) {
                (0, false) => "top center",
                (0, true) => "bottom center",
                _ => COINCIDING[same % COINCIDING.len()],
            }
        })
        .collect()
}

/// Order of points around their centre if they lie in a plane; `None` otherwise.
pub(crate) fn polygon(points: &[Vec3], reach: f64) -> Option<Vec<usize>> {
    let centre = points.iter().sum::<Vec3>() / points.len() as f64;
    let spokes: Vec<Vec3> = points.iter().map(|p| p - centre).collect();
    let along = spokes.iter().max_by(|a, b| a.norm().total_cmp(&b.norm()))?.normalize();
    let normal = spokes.iter().map(|s| along.cross(s)).max_by(|a, b| a.norm().total_cmp(&b.norm()))?;
    if normal.norm() < 1e-6 * reach {
        return Some((0..points.len()).collect());
    }
    let normal = normal.normalize();
    if spokes.iter().any(|s| s.dot(&normal).abs() > 1e-3 * reach) {
        return None;
    }
    let across = normal.cross(&along);
    let angle = |i: usize| spokes[i].dot(&across).atan2(spokes[i].dot(&along));
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| angle(a).total_cmp(&angle(b)));
    Some(order)
}

/// Diagonal of the bounding box of points [m].
pub(crate) fn extent(points: &[Vec3]) -> f64 {
    let span = |k: usize| {
        let values = || points.iter().map(|p| p[k]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    Vec3::new(span(0), span(1), span(2)).norm()
}
