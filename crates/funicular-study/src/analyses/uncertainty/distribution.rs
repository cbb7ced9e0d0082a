//! Numbers of distributions: quantiles, Latin hypercubes, intervals of sums.

/// Quantile of the standard normal distribution for the probability `p`, relative error 1e-16.
///
/// # References
/// M. J. Wichura, Algorithm AS 241, Applied Statistics 37(3), 1988.
pub(super) fn normal_quantile(p: f64) -> f64 {
    const A: [f64; 8] = [
        3.387_132_872_796_366_5,
        1.331_416_678_917_843_8e2,
        1.971_590_950_306_551_3e3,
        1.373_169_376_550_946e4,
        4.592_195_393_154_987e4,
        6.726_577_092_700_87e4,
        3.343_057_558_358_813e4,
        2.509_080_928_730_122_7e3,
    ];
    const B: [f64; 7] = [
        4.231_333_070_160_091e1,
        6.871_870_074_920_579e2,
        5.394_196_021_424_751e3,
        2.121_379_430_158_66e4,
        3.930_789_580_009_271e4,
        2.872_908_573_572_194_3e4,
        5.226_495_278_852_545e3,
    ];
    const C: [f64; 8] = [
        1.423_437_110_749_683_5,
        4.630_337_846_156_546,
        5.769_497_221_460_691,
        3.647_848_324_763_204_5,
        1.270_458_252_452_368_4,
        2.417_807_251_774_506e-1,
        2.272_384_498_926_918_4e-2,
        7.745_450_142_783_414e-4,
    ];
    const D: [f64; 7] = [
        2.053_191_626_637_759,
        1.676_384_830_183_803_8,
        6.897_673_349_851e-1,
        1.481_039_764_274_800_8e-1,
        1.519_866_656_361_645_7e-2,
        5.475_938_084_995_345e-4,
        1.050_750_071_644_416_9e-9,
    ];
    const E: [f64; 8] = [
        6.657_904_643_501_103,
        5.463_784_911_164_114,
        1.784_826_539_917_291_3,
        2.965_605_718_285_048_7e-1,
        2.653_218_952_657_612_4e-2,
        1.242_660_947_388_078_4e-3,
        2.711_555_568_743_487_6e-5,
        2.010_334_399_292_288_1e-7,
    ];
    const F: [f64; 7] = [
        5.998_322_065_558_88e-1,
        1.369_298_809_227_358e-1,
        1.487_536_129_085_061_5e-2,
        7.868_691_311_456_133e-4,
        1.846_318_317_510_054_7e-5,
        1.421_511_758_316_446e-7,
        2.044_263_103_389_939_8e-15,
    ];
    let ratio = |numerator: &[f64; 8], denominator: &[f64; 7], x: f64| {
        let top = numerator.iter().rev().fold(0.0, |sum, c| sum * x + c);
        let bottom = denominator.iter().rev().fold(0.0, |sum, c| sum * x + c) * x + 1.0;
        top / bottom
    };

    let q = p - 0.5;
    if q.abs() <= 0.425 {
        return q * ratio(&A, &B, 0.180_625 - q * q);
    }
    let r = (-(if q < 0.0 { p } else { 1.0 - p }).ln()).sqrt();
    let tail = if r <= 5.0 { ratio(&C, &D, r - 1.6) } else { ratio(&E, &F, r - 5.0) };
    tail.copysign(q)
}

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

/// Latin hypercube: `samples` points in the unit cube of `dimensions`; along every axis each of `samples` equal intervals
/// has one point. Depends on its arguments alone.
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

/// Half width of the symmetric interval that holds [`PROBABILITY`] of a sum of independent terms: a normal one with this
/// variance, and uniform ones between ± their half widths.
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
    fn quantiles_of_the_normal_distribution_are_those_of_its_tables() {
        // NIST/SEMATECH e-Handbook and Wichura's own check values.
        for (p, z) in [
            (0.5, 0.0),
            (0.975, 1.959_963_984_540_054),
            (0.25, -0.674_489_750_196_081_7),
            (0.001, -3.090_232_306_167_813_5),
            (1e-20, -9.262_340_089_798_408),
        ] {
            assert!((normal_quantile(p) - z).abs() <= 1e-14 * z.abs().max(1.0), "{p}: {}", normal_quantile(p));
        }
    }

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
