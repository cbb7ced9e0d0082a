//! Numbers that spread starts and poses, the same in every run.

/// Number between 0 and 1 for a pair of indices, without a pattern (SplitMix64).
pub(super) fn spread(first: usize, second: usize) -> f64 {
    let mut z = (first as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add((second as u64 + 1) << 32);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (z >> 11) as f64 / (1_u64 << 53) as f64
}
