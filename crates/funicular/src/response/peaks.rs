//! Peaks of a frequency response in decibels.

use crate::math::Complex;

/// Peak of |response|.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Frequency of the vertex of the parabola through the highest point and its neighbours, in decibels [Hz].
    pub frequency_hz: f64,
    /// Height above the higher of the two valleys that separate it from higher ground [dB].
    pub prominence_db: f64,
    /// Magnitude |response| at the highest point.
    pub magnitude: f64,
}

/// Local maxima of `|values|` over `frequencies_hz` (ascending) with at least the given prominence [dB], ascending in
/// frequency. Ends of the range are not peaks. A zero counts as the smallest positive number.
pub fn peaks(frequencies_hz: &[f64], values: &[Complex], min_prominence_db: f64) -> Vec<Peak> {
    let level = levels(values);
    let peak = |top: Top| {
        let Top { at, plateau, prominence_db } = top;
        let frequency_hz = if plateau { frequencies_hz[at] } else { vertex(frequencies_hz, &level, at) };
        Peak { frequency_hz, prominence_db, magnitude: values[at].norm() }
    };
    tops_of(&level, min_prominence_db).into_iter().map(peak).collect()
}

/// Highest point of a peak.
#[derive(Debug, Clone, Copy)]
pub(super) struct Top {
    /// Index of the point; that of the middle for a plateau.
    pub(super) at: usize,
    /// True if several points are equally high.
    plateau: bool,
    /// Height above the higher of the two valleys that separate the peak from higher ground [dB].
    pub(super) prominence_db: f64,
}

/// Highest points of all peaks, as [`peaks`] finds them.
pub(super) fn tops(values: &[Complex], min_prominence_db: f64) -> Vec<Top> {
    tops_of(&levels(values), min_prominence_db)
}

/// Magnitudes in decibels.
fn levels(values: &[Complex]) -> Vec<f64> {
    values.iter().map(|v| 20.0 * v.norm().max(f64::MIN_POSITIVE).log10()).collect()
}

fn tops_of(level: &[f64], min_prominence_db: f64) -> Vec<Top> {
    let mut found = Vec::new();
    let mut i = 1;
    while i + 1 < level.len() {
        // The peak of a plateau is in its middle.
        let mut end = i;
        while end + 1 < level.len() && level[end + 1] <= level[i] && level[end + 1] >= level[i] {
            end += 1;
        }

        if level[i] > level[i - 1] && end + 1 < level.len() && level[i] > level[end + 1] {
            let prominence_db = level[i] - valley(level, i, end);
            if prominence_db >= min_prominence_db {
                found.push(Top { at: usize::midpoint(i, end), plateau: i != end, prominence_db });
            }
        }

        i = end + 1;
    }
    found
}

/// Higher of the lowest levels on both sides, each up to the next higher level or the end.
fn valley(level: &[f64], start: usize, end: usize) -> f64 {
    let height = level[start];
    let lowest =
        |side: &mut dyn Iterator<Item = &f64>| side.take_while(|l| **l <= height).copied().fold(height, f64::min);
    lowest(&mut level[..start].iter().rev()).max(lowest(&mut level[end + 1..].iter()))
}

/// Vertex of the parabola through three neighbouring points.
fn vertex(x: &[f64], y: &[f64], i: usize) -> f64 {
    let (left, right) = (x[i] - x[i - 1], x[i + 1] - x[i]);
    let (rise, fall) = ((y[i] - y[i - 1]) / left, (y[i + 1] - y[i]) / right);
    let curvature = (fall - rise) / (left + right);
    if curvature < 0.0 {
        let slope = (rise * right + fall * left) / (left + right);
        (x[i] - slope / (2.0 * curvature)).clamp(x[i - 1], x[i + 1])
    } else {
        x[i]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(levels_db: &[f64]) -> (Vec<f64>, Vec<Complex>) {
        let x = (0..levels_db.len()).map(|i| i as f64).collect();
        (x, levels_db.iter().map(|l| Complex::new(10f64.powf(l / 20.0), 0.0)).collect())
    }

    #[test]
    fn prominence_is_the_height_above_the_higher_valley() {
        let (x, y) = curve(&[0.0, 10.0, 4.0, 6.0, 1.0, 8.0, 0.0]);
        let found = peaks(&x, &y, 0.0);
        let prominences: Vec<f64> = found.iter().map(|p| (p.prominence_db * 1e6).round() / 1e6).collect();
        assert_eq!(prominences, [10.0, 2.0, 7.0]);
        assert_eq!(peaks(&x, &y, 3.0).len(), 2);
    }

    #[test]
    fn a_parabola_gives_its_vertex_on_an_uneven_grid() {
        let x = [0.0, 1.0, 1.7, 2.9, 3.5];
        let (_, y) = curve(&x.map(|x: f64| -(x - 1.9) * (x - 1.9)));
        let found = peaks(&x, &y, 0.0);
        assert!((found[0].frequency_hz - 1.9).abs() < 1e-12);
    }

    #[test]
    fn plateaus_ends_and_short_curves_do_not_confuse_it() {
        let (x, y) = curve(&[0.0, 5.0, 5.0, 5.0, 0.0, 9.0]);
        let found = peaks(&x, &y, 0.0);
        assert_eq!(found.len(), 1);
        assert!((found[0].frequency_hz - 2.0).abs() < 1e-12);
        for n in 0..3 {
            assert!(peaks(&x[..n], &y[..n], 0.0).is_empty());
        }
    }
}
