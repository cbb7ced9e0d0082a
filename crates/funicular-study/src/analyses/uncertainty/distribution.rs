//! Samples and sums of independent distributions: Latin hypercubes, intervals that hold 95 %.

use crate::normal::normal_quantile;

/// Next number of a pseudorandom sequence (SplitMix64).
///
/// # References
/// G. L. Steele, D. Lea, C. H. Flood, Fast splittable pseudorandom number generators, OOPSLA 2014.
fn next_random(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Random number between 0 and 1, without its ends.
fn next_fraction(state: &mut u64) -> f64 {
    ((next_random(state) >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
}

/// Latin hypercube: `samples` points in the unit cube of `dimensions`; along every axis each of `samples` equal
/// intervals has one point. Depends on its arguments alone.
pub(super) fn latin_hypercube(samples: usize, dimensions: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut points = vec![vec![0.0; dimensions]; samples];
    for k in 0..dimensions {
        // Every axis has its own sequence, so that a further axis does not change the others.
        let mut state = seed.wrapping_mul(0x5851_f42d_4c95_7f2d) ^ (k as u64).wrapping_mul(0x1405_7b7e_f767_814f);
        let mut order: Vec<usize> = (0..samples).collect();
        for i in (1..samples).rev() {
            order.swap(i, (next_random(&mut state) % (i as u64 + 1)) as usize);
        }
        for (point, interval) in points.iter_mut().zip(order) {
            point[k] = (interval as f64 + next_fraction(&mut state)) / samples as f64;
        }
    }
    points
}

/// Probability of an interval that is reported.
pub(super) const PROBABILITY: f64 = 0.95;

/// Excess kurtosis of a sum below which its interval follows from variance and kurtosis alone, to 1e-3.
const MIN_KURTOSIS: f64 = 0.1;

/// Number of steps of the density of a sum of a few uniform distributions.
const STEPS: usize = 4096;

/// Share of the variance below which a uniform distribution counts as normal in such a sum.
const SMALL_SHARE: f64 = 1e-3;

/// Half width of the symmetric interval that holds [`PROBABILITY`] of a sum of independent terms: a normal one with
/// this variance, and uniform ones between ± their half widths.
pub(super) fn half_width(normal_variance: f64, half_widths: &[f64]) -> f64 {
    let variance = normal_variance + half_widths.iter().map(|h| h * h / 3.0).sum::<f64>();
    if variance <= 0.0 {
        return 0.0;
    }
    let deviation = variance.sqrt();
    let z = normal_quantile(0.5 + 0.5 * PROBABILITY);

    // A sum of many terms is nearly normal: first term of the Cornish–Fisher expansion.
    let fourth: f64 = half_widths.iter().map(|h| h.powi(4)).sum();
    let kurtosis = -2.0 / 15.0 * fourth / (variance * variance);
    if kurtosis.abs() < MIN_KURTOSIS {
        return deviation * (z + kurtosis * (z * z * z - 3.0 * z) / 24.0);
    }

    // A few uniform terms dominate: their density on a grid, with small ones in the normal term.
    let is_small = |h: &f64| h * h / 3.0 < SMALL_SHARE * variance;
    let normal =
        (normal_variance + half_widths.iter().filter(|h| is_small(h)).map(|h| h * h / 3.0).sum::<f64>()).sqrt();
    let large: Vec<f64> = half_widths.iter().copied().filter(|h| !is_small(h)).collect();
    let end = large.iter().sum::<f64>() + 8.0 * normal;
    let step = 2.0 * end / STEPS as f64;
    let x = |i: usize| (i as f64 + 0.5) * step - end;
    let mut density: Vec<f64> = if normal > 2.0 * step {
        (0..STEPS).map(|i| (-0.5 * (x(i) / normal).powi(2)).exp()).collect()
    } else {
        (0..STEPS).map(|i| if i == STEPS / 2 || i + 1 == STEPS / 2 { 1.0 } else { 0.0 }).collect()
    };
    for h in &large {
        // Moving average over ± h of a density that is constant within each step.
        let mut sums = Vec::with_capacity(STEPS + 1);
        sums.push(0.0);
        for value in &density {
            sums.push(sums.last().copied().unwrap_or(0.0) + value);
        }
        let up_to = |at: f64| {
            let place = ((at + end) / step).clamp(0.0, STEPS as f64);
            let whole = (place as usize).min(STEPS - 1);
            sums[whole] + (place - whole as f64) * density[whole]
        };
        density = (0..STEPS).map(|i| up_to(x(i) + h) - up_to(x(i) - h)).collect();
    }

    // Outwards from the middle, until the interval holds its probability.
    let total: f64 = density.iter().sum();
    let mut inside = 0.0;
    for (k, i) in (STEPS / 2..STEPS).enumerate() {
        let more = density[i] + density[STEPS - 1 - i];
        if inside + more >= PROBABILITY * total {
            return (k as f64 + (PROBABILITY * total - inside) / more) * step;
        }
        inside += more;
    }
    end
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_interval_of_every_axis_of_a_latin_hypercube_has_one_point() {
        let points = latin_hypercube(37, 5, 3);
        for k in 0..5 {
            let mut intervals: Vec<usize> = points.iter().map(|point| (point[k] * 37.0) as usize).collect();
            intervals.sort_unstable();
            assert_eq!(intervals, (0..37).collect::<Vec<_>>());
        }
        assert_eq!(points, latin_hypercube(37, 5, 3));
        assert_ne!(points, latin_hypercube(37, 5, 4));
        // A further axis leaves the others as they are.
        assert!(latin_hypercube(37, 6, 3).iter().zip(&points).all(|(more, point)| more[..5] == point[..]));

        // Axes are independent: the correlation of two is that of chance, 1/√n.
        let many = latin_hypercube(10_000, 2, 1);
        let mean: f64 = many.iter().map(|point| (point[0] - 0.5) * (point[1] - 0.5)).sum::<f64>() / 1e4;
        assert!((12.0 * mean).abs() < 0.03, "{mean}");
    }

    #[test]
    fn intervals_of_sums_are_those_of_their_closed_forms() {
        let close = |found: f64, expected: f64, tolerance: f64| {
            assert!((found / expected - 1.0).abs() < tolerance, "{found} {expected}");
        };
        assert!(half_width(0.0, &[]).abs() < f64::MIN_POSITIVE);
        close(half_width(4.0, &[]), 2.0 * 1.959_963_984_540_054, 1e-14);
        // Uniform: 95 % of the width. Two equal ones: a triangle of half width 2. The grid has 1/2048 of the width.
        close(half_width(0.0, &[3.0]), 2.85, 2e-3);
        close(half_width(0.0, &[1.0, 1.0]), 2.0 * (1.0 - 0.05_f64.sqrt()), 2e-3);
        // Twelve equal ones are nearly normal: the exact value of the Irwin–Hall distribution is 1.952949 deviations.
        close(half_width(0.0, &[1.0; 12]), 1.952_949 * 2.0, 2e-4);
        // A small normal term beside a uniform one changes nothing.
        close(half_width(1e-8, &[1.0]), 0.95, 2e-3);
        // Uniform ± 1 plus normal 1, by quadrature of the density: 2.25414.
        close(half_width(1.0, &[1.0]), 2.254_14, 2e-3);
    }
}
