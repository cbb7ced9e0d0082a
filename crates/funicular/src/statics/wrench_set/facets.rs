//! Facets of a sum of segments (zonotope) and the distances at which they bound it.

use crate::math::Vec6;

/// Maximum number of subsets of columns whose hyperplanes are formed: 30 cables with six degrees of freedom have
/// 142506, which take a tenth of a second.
const MAX_SUBSETS: usize = 200_000;

/// Volume of unit columns below which they count as dependent: their common normal is then known to less than seven
/// digits.
const DEPENDENT: f64 = 1e-9;

/// Unit normals of all facets of the zonotope of these reduced columns, one for each pair of opposite facets. A facet
/// contains the directions of `dof − 1` independent columns, so its normal is their generalised cross product. Normals
/// may repeat. Empty if the columns do not span all degrees of freedom; `None` if they are too many.
///
/// # References
/// docs/theory.md, equation (40g).
pub(in crate::statics) fn facet_normals(columns: &[Vec6], dof: usize) -> Option<Vec<Vec6>> {
    let units: Vec<Vec6> = columns.iter().filter_map(|column| column.try_normalize(0.0)).collect();
    if subsets(units.len(), dof - 1) > MAX_SUBSETS {
        return None;
    }

    let mut normals = Vec::with_capacity(subsets(units.len(), dof - 1));
    let mut scalar = [0.0; BLADES];
    scalar[0] = 1.0;
    add_normals(&units, dof, 0, &scalar, &mut normals);

    // Columns within a subspace have its normal as the normal of every facet.
    let is_flat = normals.iter().any(|normal| units.iter().all(|unit| normal.dot(unit).abs() < DEPENDENT));
    if is_flat {
        normals.clear();
    }
    Some(normals)
}

/// Number of subsets with `chosen` of `of` elements; stops counting above [`MAX_SUBSETS`].
fn subsets(of: usize, chosen: usize) -> usize {
    let mut count = 1;
    for k in 0..chosen.min(of) {
        count = count * (of - k) / (k + 1);
        if count > MAX_SUBSETS {
            break;
        }
    }
    count
}

/// Number of basis elements of the exterior algebra of six dimensions. An element is a set of axes, as bits.
const BLADES: usize = 64;

/// Exterior product of some columns: coefficients of sets of as many axes.
type Blade = [f64; BLADES];

/// Term of the exterior product with a column: the coefficient of `axes` gets that of `rest`, which lacks `axis`, times
/// the component of the column along this axis.
#[derive(Clone, Copy)]
struct ProductTerm {
    axes: usize,
    rest: usize,
    axis: usize,
    sign: f64,
}

/// Number of axes.
const AXES: usize = 6;

/// Number of terms of the products of up to five columns.
const TERM_COUNT: usize = 186;

/// Terms by the number of axes of their sets, ascending, and the place of the first term of each number.
const TERMS: ([ProductTerm; TERM_COUNT], [usize; AXES + 1]) = terms();

const fn terms() -> ([ProductTerm; TERM_COUNT], [usize; AXES + 1]) {
    let mut all = [ProductTerm { axes: 0, rest: 0, axis: 0, sign: 0.0 }; TERM_COUNT];
    let mut first = [0; AXES + 1];
    let (mut count, mut grade) = (0, 1);
    while grade < AXES {
        first[grade] = count;
        let mut axes = 1;
        while axes < BLADES {
            let mut axis = 0;
            while axis < AXES && axes.count_ones() as usize == grade {
                if axes & (1 << axis) != 0 {
                    let rest = axes ^ (1 << axis);
                    all[count] = ProductTerm { axes, rest, axis, sign: sign(rest, axis) };
                    count += 1;
                }
                axis += 1;
            }
            axes += 1;
        }
        grade += 1;
    }
    first[AXES] = count;
    (all, first)
}

/// Adds the normals of all sets of columns that extend a product of `depth` columns by columns from `units`. Products
/// of the first columns are shared, which makes 56 normals of eight cables a matter of microseconds.
fn add_normals(units: &[Vec6], dof: usize, depth: usize, product: &Blade, normals: &mut Vec<Vec6>) {
    let missing = dof - 1 - depth;
    if missing == 0 {
        let all = (1_usize << dof) - 1;
        let component = |axis: usize| sign(all ^ (1 << axis), axis) * product[all ^ (1 << axis)];
        let normal = Vec6::from_fn(|axis, _| if axis < dof { component(axis) } else { 0.0 });
        normals.extend(normal.try_normalize(DEPENDENT));
        return;
    }

    let (all, first) = &TERMS;
    let terms = &all[first[depth + 1]..first[depth + 2]];
    // Later columns leave too few for a set.
    for (i, unit) in units.iter().enumerate().take((units.len() + 1).saturating_sub(missing)) {
        let mut longer = [0.0; BLADES];
        for term in terms {
            longer[term.axes] += term.sign * product[term.rest] * unit[term.axis];
        }
        add_normals(&units[i + 1..], dof, depth + 1, &longer, normals);
    }
}

/// Sign of the product of a set of axes with a further axis: negative for an odd number of axes behind it.
const fn sign(axes: usize, axis: usize) -> f64 {
    if (axes >> axis).count_ones().is_multiple_of(2) { 1.0 } else { -1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_normal_is_normal_to_five_of_eight_columns_and_there_are_as_many_as_subsets() {
        let columns: Vec<Vec6> = (0..8)
            .map(|i| Vec6::from_fn(|j, _| (1.0 + f64::from(i) * 1.7 + j as f64 * (0.9 + f64::from(i))).sin()))
            .collect();
        let normals = facet_normals(&columns, 6).unwrap();
        assert_eq!(normals.len(), 56);
        for normal in &normals {
            let orthogonal = columns.iter().filter(|column| normal.dot(column).abs() < 1e-12).count();
            assert!(orthogonal == 5 && (normal.norm() - 1.0).abs() < 1e-14, "{orthogonal} {normal}");
        }
    }

    #[test]
    fn columns_in_a_subspace_have_no_facets_and_too_many_columns_are_refused() {
        let flat: Vec<Vec6> = (0..8)
            .map(|i| Vec6::from_fn(|j, _| if j == 4 { 0.0 } else { (f64::from(i) + 2.3 * j as f64).cos() }))
            .collect();
        assert!(facet_normals(&flat, 6).unwrap().is_empty());
        let many: Vec<Vec6> = (0..60).map(|i| Vec6::from_fn(|j, _| (f64::from(i) + 2.3 * j as f64).cos())).collect();
        assert!(facet_normals(&many, 6).is_none());
        assert!(facet_normals(&many, 3).is_some());
    }
}
