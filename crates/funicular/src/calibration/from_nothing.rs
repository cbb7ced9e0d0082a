//! Anchors and positions from nothing but lengths, for platforms whose cables end in one point: the table of squared
//! lengths has the rank of the space (96h), and what this leaves open is linear (96i).

use crate::math::{DMat, DVec};

/// Least eigenvalue of the metric, relative to the largest one. Noise can make it negative; 1e-3 keeps an aspect of 30.
const FLAT: f64 = 1e-3;

/// Anchors and positions whose distances are the given lengths, in a frame of their own: `lengths[(j, i)]` is the
/// length of cable i in row j [m]. Rows of the results are points with `dimension` coordinates. `None` if there are too
/// few points for a linear solution: 6 of the more numerous ones in the plane, 10 in space.
///
/// # References
/// Metric unfolding: P. H. Schönemann, Psychometrika 35 (1970) 349.
///
/// # Example
/// ```
/// use funicular::{calibration::anchors_from_lengths, math::DMat};
///
/// let anchors = [[0.0, 0.0], [3.0, 0.0], [2.5, 2.0]];
/// let positions = [[1.0, 0.5], [2.0, 0.7], [1.5, 1.4], [0.7, 1.1], [2.2, 1.2], [1.1, 1.0], [1.9, 0.2]];
/// let length = |p: [f64; 2], a: [f64; 2]| (p[0] - a[0]).hypot(p[1] - a[1]);
/// let lengths = DMat::from_fn(7, 3, |j, i| length(positions[j], anchors[i]));
/// let (found, _) = anchors_from_lengths(&lengths, 2).unwrap();
/// assert!(((found.row(0) - found.row(1)).norm() - 3.0).abs() < 1e-9);
/// ```
pub fn anchors_from_lengths(lengths: &DMat, dimension: usize) -> Option<(DMat, DMat)> {
    let squares = lengths.map(|length| length * length);
    if lengths.nrows() >= lengths.ncols() {
        unfold(&squares, dimension).map(|(positions, anchors)| (anchors, positions))
    } else {
        unfold(&squares.transpose(), dimension)
    }
}

/// Points of the rows and of the columns of a table of squared distances, with more rows than columns.
fn unfold(squares: &DMat, dimension: usize) -> Option<(DMat, DMat)> {
    let (rows, columns) = squares.shape();
    let products = dimension * (dimension + 1) / 2;
    if rows < products + dimension + 1 || columns < dimension + 1 {
        return None;
    }

    // −½ J D² J = U Vᵀ.
    let of_row = DVec::from_fn(rows, |i, _| squares.row(i).mean());
    let of_column = DVec::from_fn(columns, |j, _| squares.column(j).mean());
    let mean = squares.mean();
    let centred = DMat::from_fn(rows, columns, |i, j| -0.5 * (squares[(i, j)] - of_row[i] - of_column[j] + mean));
    let svd = centred.svd(true, true);
    let (left, right) = (svd.u?, svd.v_t?);
    let mut order: Vec<usize> = (0..svd.singular_values.len()).collect();
    order.sort_by(|a, b| svd.singular_values[*b].total_cmp(&svd.singular_values[*a]));
    let root = |k: usize| svd.singular_values[order[k]].max(0.0).sqrt();
    let u = DMat::from_fn(rows, dimension, |i, k| left[(i, order[k])] * root(k));
    let v = DMat::from_fn(columns, dimension, |j, k| right[(order[k], j)] * root(k));

    // uᵀ H u − 2 u·b + e is the mean squared distance of each row: linear in H, b and e.
    let pairs: Vec<(usize, usize)> = (0..dimension).flat_map(|a| (a..dimension).map(move |b| (a, b))).collect();
    let system = DMat::from_fn(rows, products + dimension + 1, |i, k| match k {
        k if k < products => {
            let (a, b) = pairs[k];
            u[(i, a)] * u[(i, b)] * if a == b { 1.0 } else { 2.0 }
        }
        k if k < products + dimension => -2.0 * u[(i, k - products)],
        _ => 1.0,
    });
    let solved = system.svd(true, true).solve(&of_row, 1e-13).ok()?;
    let mut metric = DMat::zeros(dimension, dimension);
    for (k, &(a, b)) in pairs.iter().enumerate() {
        metric[(a, b)] = solved[k];
        metric[(b, a)] = solved[k];
    }
    let shift = solved.rows(products, dimension).into_owned();

    // H = CᵀC.
    let eigen = metric.symmetric_eigen();
    let largest = eigen.eigenvalues.max();
    if largest.is_nan() || largest <= 0.0 {
        return None;
    }
    let raised = eigen.eigenvalues.map(|value| value.max(FLAT * largest));
    let root = &eigen.eigenvectors * DMat::from_diagonal(&raised.map(f64::sqrt)) * eigen.eigenvectors.transpose();
    let inverse = &eigen.eigenvectors
        * DMat::from_diagonal(&raised.map(|value| 1.0 / value.sqrt()))
        * eigen.eigenvectors.transpose();
    let mean = &inverse * shift;
    let of_rows = u * &root;
    let mut of_columns = v * &inverse;
    for mut row in of_columns.row_iter_mut() {
        row += mean.transpose();
    }
    Some((of_rows, of_columns))
}
