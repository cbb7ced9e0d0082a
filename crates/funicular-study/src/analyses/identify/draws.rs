//! Values drawn by what is known beforehand: a fixed sequence of points that fill a unit cube evenly.

/// Iterations for the root of x^{d+1} = x + 1, each of which takes its error at least to a third; the root is between 1
/// and 2.
const ROOT_ITERATIONS: usize = 60;

/// Point with this number in the unit cube, each coordinate between 0 and 1. Point 0 is the centre.
///
/// # References
/// M. Roberts, The unreasonable effectiveness of quasirandom sequences, 2018: additive recurrence with the root of
/// x^{d+1} = x + 1.
pub(super) fn point(number: usize, dimensions: usize) -> Vec<f64> {
    let mut root = 1.5_f64;
    for _ in 0..ROOT_ITERATIONS {
        root = (1.0 + root).powf(1.0 / (dimensions as f64 + 1.0));
    }
    let mut place = 1.0;
    (0..dimensions)
        .map(|_| {
            place /= root;
            // A coordinate of 0 has no quantile of the normal distribution.
            (0.5 + place * number as f64).fract().max(f64::EPSILON)
        })
        .collect()
}

/// Number between 0 and 1 with two indices, without any pattern between neighbours.
///
/// # References
/// G. Steele, D. Lea and C. Flood, Fast splittable pseudorandom number generators, 2014: the mixing function.
pub(super) fn mixed(first: usize, second: usize) -> f64 {
    let mut bits = ((first as u64) << 32 | second as u64).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_sequences_fill_the_range_evenly() {
        for dimension in 0..3 {
            let points: Vec<f64> = (0..400).map(|number| point(number, 3)[dimension]).collect();
            let mixed: Vec<f64> = (0..400).map(|number| mixed(number, dimension)).collect();
            for (values, tolerance) in [(points, 0.01), (mixed, 0.05)] {
                let below = |limit: f64| values.iter().filter(|value| **value < limit).count() as f64 / 400.0;
                // The deviation of a fraction of 400 random numbers is at most 0.025.
                assert!([0.25, 0.5, 0.75].into_iter().all(|limit| (below(limit) - limit).abs() <= tolerance));
            }
        }
        assert_eq!(point(0, 3), [0.5; 3]);
    }
}
