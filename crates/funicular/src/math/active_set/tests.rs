//! Tests of the nearest and the highest point, by conditions that every optimum satisfies.

use super::*;
use proptest::prelude::*;

fn polyhedron(dimension: usize, rows: &[(Vec<f64>, f64)]) -> Polyhedron {
    let mut polyhedron = Polyhedron::new(dimension);
    for (normal, level) in rows {
        polyhedron.add(normal.iter(), 1.0, None, *level);
    }
    polyhedron
}

#[test]
fn the_nearest_point_of_a_corner_is_the_corner() {
    let quadrant = polyhedron(2, &[(vec![1.0, 0.0], 1.0), (vec![0.0, 1.0], 2.0)]);
    let mut x = [-3.0, 0.0];
    let active = quadrant.nearest(&mut x, 1e-12).unwrap();
    assert!((x[0] - 1.0).abs() < 1e-15 && (x[1] - 2.0).abs() < 1e-15, "{x:?}");
    assert!((active.iter().map(|a| a.multiplier).sum::<f64>() - 6.0).abs() < 1e-14);
    let mut inside = [5.0, 5.0];
    assert_eq!(quadrant.nearest(&mut inside, 1e-12).unwrap(), []);
}

#[test]
fn an_empty_polyhedron_has_no_point() {
    let empty = polyhedron(2, &[(vec![1.0, 1.0], 1.0), (vec![-1.0, -1.0], 0.0), (vec![1.0, 0.0], -9.0)]);
    assert!(empty.nearest(&mut [0.3, 8.0], 1e-12).is_none());
    let beyond_reach = polyhedron(1, &[(vec![1e-17], 1.0)]);
    assert!(beyond_reach.nearest(&mut [0.0], 1e-12).is_none());
}

/// Corner of three constraints that no number hits exactly, far from the origin.
#[test]
fn a_tolerance_below_the_rounding_of_the_levels_hides_no_point() {
    for i in 1..200 {
        let (x, y) = (60.0 / f64::from(i), -47.0 / f64::from(i + 1));
        let wall = |a: f64, b: f64| (vec![a, b], a * x + b * y);
        let constraints = [wall(0.3, 0.7), wall(-0.9, 0.1), wall(0.6, -0.8)];
        assert!(polyhedron(2, &constraints).nearest(&mut [0.0, 0.0], 1e-300).is_some(), "{constraints:?}");
    }
}

#[test]
fn of_equally_high_points_the_nearest_is_taken() {
    // Roof with a level ridge: y ≤ 1, and a constraint x ≥ 3.
    let roof = polyhedron(2, &[(vec![0.0, -1.0], -1.0), (vec![1.0, 0.0], 3.0), (vec![-1.0, -0.001], -9.0)]);
    let mut x = [4.0, 0.0];
    roof.highest(&mut x, 1e-12).unwrap();
    assert!((x[0] - 4.0).abs() < 1e-9 && (x[1] - 1.0).abs() < 1e-12, "{x:?}");
}

type Rows = [(Vec<f64>, f64)];

/// Point deepest inside of all constraints, or least outside; its depth (at most 1) is the last component.
fn deepest(rows: &Rows, start: &[f64]) -> (Vec<f64>, Vec<Active>) {
    let mut lifted = Polyhedron::new(4);
    for (normal, level) in rows {
        lifted.add(normal.iter(), 1.0, Some(-1.0), *level);
    }
    lifted.add([0.0; 3].iter(), 1.0, Some(-1.0), -1.0);
    let mut point = [start, &[0.0]].concat();
    let held = lifted.highest(&mut point, 1e-12).unwrap();
    (point, held)
}

fn check_deepest(rows: &Rows, start: &[f64]) -> Result<(), TestCaseError> {
    let (point, held) = deepest(rows, start);
    let (x, depth) = (&point[..3], point[3]);
    let size = 1.0 + dot(x, x).sqrt();
    for (normal, level) in rows {
        prop_assert!(dot(normal, x) - depth >= level - 1e-10 * size, "{point:?}");
    }
    prop_assert!(depth <= 1.0 + 1e-12, "{point:?}");
    let mut balance = [0.0, 0.0, 0.0, 1.0];
    let total: f64 = held.iter().map(|held| held.multiplier).sum();
    prop_assert!((total - 1.0).abs() < 1e-9, "{held:?}");
    for held in held {
        prop_assert!(held.multiplier >= 0.0);
        balance[3] -= held.multiplier;
        let Some((normal, level)) = rows.get(held.row) else { continue };
        balance.iter_mut().zip(normal).for_each(|(b, a)| *b += held.multiplier * a);
        prop_assert!((dot(normal, x) - depth - level).abs() < 1e-9 * size, "{point:?}");
    }
    prop_assert!(balance.iter().all(|b| b.abs() < 1e-9), "{balance:?}");
    Ok(())
}

/// Edge that rises by 2e-6 over a length of 1. Corners by elimination in fractions: the upper one is (-0.108,
/// -0.278, -0.486) at a depth of -0.114 641 518 089 681 27.
#[test]
#[expect(clippy::unreadable_literal, reason = "found by chance")]
fn of_nearly_level_edges_the_higher_end_is_found() {
    let rows = [
        (vec![0.9413309181437038, -0.8639406653083862, 0.5194989338345024], 0.0),
        (vec![-0.8593923931211953, 0.33509511964269273, 0.23586161720763274], 0.0),
        (vec![-0.9757476174678755, 0.8580810771530126, 0.8871393169496077], -0.44921481569361793),
        (vec![0.08799948055057977, 0.09715565023731912, -0.2299596200531202], 0.18993859794459775),
        (vec![0.0, 0.0, -0.9171303545971431], 0.0),
    ];
    let (point, _) = deepest(&rows, &[0.0; 3]);
    let corner = [-0.10827657628128794, -0.2776140979462413, -0.4861598766716261, -0.11464151808968127];
    assert!(point.iter().zip(corner).all(|(x, c)| (x - c).abs() < 1e-12), "{point:?}");
}

#[test]
fn where_there_is_no_highest_point_none_is_given() {
    let open = polyhedron(2, &[(vec![1.0, 0.0], 1.0), (vec![-1.0, -1e-7], -2.0)]);
    assert!(open.highest(&mut [1.5, 0.0], 1e-12).is_some_and(|held| held.len() == 2));
    let open = polyhedron(2, &[(vec![1.0, 0.0], 1.0), (vec![-1.0, 1e-7], -2.0)]);
    assert!(open.highest(&mut [1.5, 0.0], 1e-12).is_none());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..Default::default() })]

    /// Optimality without a second solver: the point is inside, and the way back is a combination of active
    /// normals.
    #[test]
    fn the_nearest_point_satisfies_the_conditions_of_kuhn_and_tucker(
        rows in prop::collection::vec((prop::collection::vec(-1.0f64..1.0, 3), -1.0f64..0.5), 1..24),
        start in prop::collection::vec(-5.0f64..5.0, 3),
    ) {
        let set = polyhedron(3, &rows);

        let mut x = start.clone();
        if let Some(active) = set.nearest(&mut x, 1e-12) {
            let mut way: Vec<f64> = x.iter().zip(&start).map(|(x, s)| x - s).collect();
            for held in active {
                let (normal, level) = &rows[held.row];
                prop_assert!(held.multiplier >= 0.0);
                prop_assert!((dot(normal, &x) - level).abs() < 1e-7);
                way.iter_mut().zip(normal).for_each(|(way, a)| *way -= held.multiplier * a);
            }
            prop_assert!(way.iter().all(|w| w.abs() < 1e-7 * (1.0 + dot(&x, &x).sqrt())), "{way:?}");
            for (normal, level) in &rows {
                prop_assert!(dot(normal, &x) >= level - 1e-10);
            }
        } else {
            // Farkas' lemma checked in another way: the minimum common violation is positive.
            let (point, _) = deepest(&rows, &start);
            prop_assert!(point[3] < 1e-9, "{point:?}");
        }
    }

    /// Optimality without a second solver: the point is inside, and the active constraints are satisfied with
    /// equality and balance the lift.
    #[test]
    fn the_highest_point_solves_the_linear_problem_and_its_dual(
        rows in prop::collection::vec((prop::collection::vec(-1.0f64..1.0, 3), -1.0f64..0.5), 1..24),
        start in prop::collection::vec(-5.0f64..5.0, 3),
    ) {
        check_deepest(&rows, &start)?;
    }

    /// Comparison with all corners, in the plane.
    #[test]
    fn the_highest_point_is_the_highest_corner(
        rows in prop::collection::vec((-1.0f64..1.0, 0.2f64..1.0, 0.0f64..3.0), 2..12),
    ) {
        // Roofs: every row bounds the height, and two constraints bound the width.
        let mut all: Vec<(Vec<f64>, f64)> =
            rows.iter().map(|(slope, down, level)| (vec![*slope, -down], -level)).collect();
        all.extend([(vec![1.0, 0.0], -4.0), (vec![-1.0, 0.0], -4.0)]);

        let mut best = f64::NEG_INFINITY;
        for i in 0..all.len() {
            for j in 0..i {
                let ((a, p), (b, q)) = (&all[i], &all[j]);
                let det = a[0] * b[1] - a[1] * b[0];
                if det.abs() > 1e-9 {
                    let corner = [(p * b[1] - q * a[1]) / det, (a[0] * q - b[0] * p) / det];
                    if all.iter().all(|(n, level)| dot(n, &corner) >= level - 1e-9) {
                        best = best.max(corner[1]);
                    }
                }
            }
        }
        let mut x = vec![0.5, -100.0];
        polyhedron(2, &all).highest(&mut x, 1e-12).unwrap();
        prop_assert!((x[1] - best).abs() < 1e-8, "{} {best}", x[1]);
    }
}
