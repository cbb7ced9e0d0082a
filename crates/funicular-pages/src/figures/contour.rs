//! Contours of values on a grid: marching squares, joined to lines.

use std::collections::BTreeMap;

/// Edge of the grid that a contour crosses: from point (i, j) to the next in the direction of x (false) or y (true).
type Edge = (usize, usize, bool);

/// Lines on which the interpolated values equal a level. Cells with a corner that is not finite have none.
///
/// `values` holds the value at each (x, y), `y` by `y`.
pub(crate) fn contours(x: &[f64], y: &[f64], values: &[f64], level: f64) -> Vec<Vec<[f64; 2]>> {
    let n = x.len();
    let value = |i: usize, j: usize| values[j * n + i];
    let mut next: BTreeMap<Edge, Vec<Edge>> = BTreeMap::new();
    for j in 0..y.len().saturating_sub(1) {
        for i in 0..n.saturating_sub(1) {
            for (a, b) in segments([value(i, j), value(i + 1, j), value(i + 1, j + 1), value(i, j + 1)], level) {
                // Edges of a cell: below, right, above, left.
                let edge = |k: usize| match k {
                    0 => (i, j, false),
                    1 => (i + 1, j, true),
                    2 => (i, j + 1, false),
                    _ => (i, j, true),
                };
                next.entry(edge(a)).or_default().push(edge(b));
                next.entry(edge(b)).or_default().push(edge(a));
            }
        }
    }

    let point = |(i, j, up): Edge| {
        let (k, l) = if up { (i, j + 1) } else { (i + 1, j) };
        let (a, b) = (value(i, j), value(k, l));
        let t = (level - a) / (b - a);
        [x[i] + t * (x[k] - x[i]), y[j] + t * (y[l] - y[j])]
    };
    let mut lines = Vec::new();
    // Open lines begin at an edge with one neighbour. What is left afterwards are closed lines.
    let open: Vec<Edge> = next.iter().filter(|(_, others)| others.len() == 1).map(|(edge, _)| *edge).collect();
    for begin in open {
        lines.extend(follow(begin, &mut next));
    }
    while let Some(begin) = next.iter().find(|(_, others)| !others.is_empty()).map(|(edge, _)| *edge) {
        lines.extend(follow(begin, &mut next));
    }
    lines.into_iter().map(|line| line.into_iter().map(point).collect()).collect()
}

/// Line from an edge to its end; removes its segments. `None` if no segment is left at the edge.
fn follow(begin: Edge, next: &mut BTreeMap<Edge, Vec<Edge>>) -> Option<Vec<Edge>> {
    let mut line = vec![begin];
    let mut at = begin;
    while let Some(to) = next.get_mut(&at).and_then(Vec::pop) {
        if let Some(back) = next.get_mut(&to)
            && let Some(place) = back.iter().position(|edge| *edge == at)
        {
            back.swap_remove(place);
        }
        line.push(to);
        at = to;
    }
    // Edges without segments would be searched again.
    for edge in &line {
        if next.get(edge).is_some_and(Vec::is_empty) {
            next.remove(edge);
        }
    }
    (line.len() > 1).then_some(line)
}

/// Pairs of edges (below, right, above, left) that a contour joins in a cell with these corners, around from the lower
/// left. At a saddle the mean of the corners decides.
fn segments(corners: [f64; 4], level: f64) -> Vec<(usize, usize)> {
    if corners.iter().any(|value| !value.is_finite()) {
        return Vec::new();
    }
    let high = corners.map(|value| value >= level);
    let crossed: Vec<usize> = (0..4).filter(|&k| high[k] != high[(k + 1) % 4]).collect();
    match crossed[..] {
        [a, b] => vec![(a, b)],
        [_, _, _, _] => {
            let middle = corners.iter().sum::<f64>() / 4.0 >= level;
            // The middle belongs to the corners of its side: the contour cuts off the other two corners.
            if middle == high[0] { vec![(0, 1), (2, 3)] } else { vec![(3, 0), (1, 2)] }
        }
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(n: usize, of: impl Fn(f64, f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let x: Vec<f64> = (0..n).map(|i| -1.0 + 2.0 * i as f64 / (n - 1) as f64).collect();
        let values = x.iter().flat_map(|y| x.iter().map(|x| of(*x, *y)).collect::<Vec<_>>()).collect();
        (x, values)
    }

    #[test]
    fn the_contour_of_a_cone_is_one_closed_circle() {
        let (x, values) = grid(81, f64::hypot);
        let lines = contours(&x, &x, &values, 0.6);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].first(), lines[0].last(), "closed");
        let length: f64 = lines[0].windows(2).map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1])).sum();
        // Linear interpolation on cells of h = 0.025: the radius errs by h² / (8 r) at most, about 1.3e-4.
        for [x, y] in &lines[0] {
            assert!((x.hypot(*y) - 0.6).abs() < 1.4e-4, "{}", x.hypot(*y));
        }
        assert!((length - 0.6 * std::f64::consts::TAU).abs() < 2e-3, "{length}");
    }

    #[test]
    fn a_plane_has_one_open_straight_line() {
        let (x, values) = grid(7, |x, y| 2.0 * x + y);
        let lines = contours(&x, &x, &values, 0.3);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].iter().all(|[x, y]| (2.0 * x + y - 0.3).abs() < 1e-12));
        let ends = [lines[0][0], *lines[0].last().unwrap()];
        assert!(ends.iter().all(|p| (p[1].abs() - 1.0).abs() < 1e-12), "{ends:?}");
    }

    #[test]
    fn holes_and_saddles_have_no_crossing_lines() {
        let (x, mut values) = grid(21, |x, y| x * y);
        // A saddle: two branches of a hyperbola at each level.
        assert_eq!(contours(&x, &x, &values, 0.1).len(), 2);
        assert_eq!(contours(&x, &x, &values, -0.1).len(), 2);
        values[10 * 21 + 18] = f64::NAN;
        let all: Vec<_> = contours(&x, &x, &values, 0.02).concat();
        let hole = |p: &[f64; 2]| (p[0] - x[18]).abs() < 0.0999 && p[1].abs() < 0.0999;
        assert!(!all.is_empty() && !all.iter().any(hole));
    }
}
