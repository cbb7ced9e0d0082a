//! Pairing of two lists of frequencies.

/// Maximum difference within a pair [Hz].
pub(crate) const MAX_DIFFERENCE: f64 = 0.5;

/// Agreement of two ascending lists of frequencies.
pub(crate) struct Agreement {
    /// Each published frequency with the computed one, if there is one near enough.
    pub(crate) pairs: Vec<(f64, Option<f64>)>,
    /// Computed frequencies without a pair.
    pub(crate) extra: Vec<f64>,
}

impl Agreement {
    /// Pairs two lists in order with the minimum sum of differences, where an unpaired frequency costs half
    /// [`MAX_DIFFERENCE`]. Frequencies are therefore paired only if they are closer than [`MAX_DIFFERENCE`].
    pub(crate) fn of(published: &[f64], ours: &[f64]) -> Self {
        let (m, n) = (published.len(), ours.len());
        // cost[i][j]: minimum cost of the first i published and the first j computed frequencies.
        let mut cost = vec![vec![0.0; n + 1]; m + 1];
        for i in 0..=m {
            for j in 0..=n {
                let alone = 0.5 * MAX_DIFFERENCE;
                cost[i][j] = match (i, j) {
                    (0, _) => alone * j as f64,
                    (_, 0) => alone * i as f64,
                    _ => (cost[i - 1][j] + alone)
                        .min(cost[i][j - 1] + alone)
                        .min(cost[i - 1][j - 1] + (published[i - 1] - ours[j - 1]).abs()),
                };
            }
        }

        // Walk back along the pairing with the minimum cost.
        let (mut pairs, mut extra) = (Vec::new(), Vec::new());
        let (mut i, mut j) = (m, n);
        while i > 0 || j > 0 {
            let paired = (i > 0 && j > 0).then(|| cost[i - 1][j - 1] + (published[i - 1] - ours[j - 1]).abs());
            if paired.is_some_and(|c| c <= cost[i][j]) {
                pairs.push((published[i - 1], Some(ours[j - 1])));
                (i, j) = (i - 1, j - 1);
            } else if i > 0 && cost[i - 1][j] + 0.5 * MAX_DIFFERENCE <= cost[i][j] {
                pairs.push((published[i - 1], None));
                i -= 1;
            } else {
                extra.push(ours[j - 1]);
                j -= 1;
            }
        }
        pairs.reverse();
        extra.reverse();
        Self { pairs, extra }
    }

    fn differences(&self) -> impl Iterator<Item = f64> + '_ {
        self.pairs.iter().filter_map(|(published, ours)| ours.map(|f| f - published))
    }

    /// Number of pairs.
    pub(crate) fn paired(&self) -> usize {
        self.differences().count()
    }

    /// Published frequencies without a pair.
    pub(crate) fn missing(&self) -> usize {
        self.pairs.len() - self.paired()
    }

    /// Root mean square of the differences of pairs [Hz].
    pub(crate) fn rms(&self) -> f64 {
        (self.differences().map(|d| d * d).sum::<f64>() / self.paired() as f64).sqrt()
    }

    /// Largest difference of a pair [Hz].
    pub(crate) fn largest(&self) -> f64 {
        self.differences().fold(0.0, |largest, d| d.abs().max(largest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_frequencies_pair_in_order_and_the_rest_is_listed() {
        let agreement = Agreement::of(&[1.0, 2.0, 5.0], &[1.1, 1.3, 2.1, 9.0]);
        assert_eq!(agreement.pairs, [(1.0, Some(1.1)), (2.0, Some(2.1)), (5.0, None)]);
        assert_eq!(agreement.extra, [1.3, 9.0]);
        assert!((agreement.rms() - 0.1).abs() < 1e-12 && (agreement.largest() - 0.1).abs() < 1e-12);
        assert_eq!((agreement.paired(), agreement.missing()), (2, 1));
    }

    #[test]
    fn no_pair_is_wider_than_the_limit() {
        assert_eq!(Agreement::of(&[1.0], &[1.51]).paired(), 0);
        assert_eq!(Agreement::of(&[1.0], &[1.49]).paired(), 1);
        assert_eq!(Agreement::of(&[], &[1.0]).extra, [1.0]);
    }
}
