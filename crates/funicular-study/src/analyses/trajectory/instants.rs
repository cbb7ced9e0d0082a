//! Times at which a motion is computed: those of the rows, and times of its own, so that what is largest on the path
//! does not depend on the rows.

use funicular::path::{PlatformPath, Side};

/// Part of the duration within which two times are one.
const SAME_TIME: f64 = 1e-9;

/// Least number of parts of a phase between two corners of the path: the accelerations of lengths bend once or twice in
/// it.
const MIN_PARTS: f64 = 8.0;

/// Distance of a time from a row, over the time between two of them, below which the row stands for it.
const BESIDE_ROW: f64 = 0.3;

/// One time of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Instant {
    pub(super) time: f64,
    pub(super) side: Side,
    /// Number of the phase; no derivative of the path jumps within one.
    pub(super) phase: usize,
    pub(super) is_row: bool,
    /// True beside the path, where the platform rests.
    pub(super) is_rest: bool,
}

/// Times of a path, ascending: the rows, `count` parts of the path with at least [`MIN_PARTS`] of every phase, and both
/// sides of every corner. A row at a corner is just after it, and at the end of the path just before it.
pub(super) fn instants(path: &PlatformPath, rows: &[f64], count: usize) -> Vec<Instant> {
    let duration = path.duration();
    let same = SAME_TIME * duration;
    let corners: Vec<f64> = path.corners().iter().map(|corner| corner.time).collect();
    let inside = corners.iter().copied().filter(|time| *time > same && *time < duration - same);
    let breaks: Vec<f64> = std::iter::once(0.0).chain(inside).chain([duration]).collect();
    let has_corner = |time: f64| corners.iter().any(|corner| (corner - time).abs() <= same);

    // At rest before the path and after it.
    let last = breaks.len();
    let rest = |time: f64, side, phase| {
        has_corner(time).then_some(Instant { time, side, phase, is_row: false, is_rest: true })
    };
    let mut found: Vec<Instant> = rest(0.0, Side::Before, 0).into_iter().collect();
    for (phase, pair) in (1..).zip(breaks.windows(2)) {
        let is_last = phase + 1 == last;
        let until = if is_last { f64::INFINITY } else { pair[1] - same };
        let own: Vec<f64> = rows.iter().copied().filter(|row| *row >= pair[0] - same && *row < until).collect();
        found.extend(of_phase([pair[0], pair[1]], &own, duration / count as f64, same, phase));
    }
    found.extend(rest(duration, Side::After, last));
    found
}

/// Times of a phase with its ends.
fn of_phase([from, to]: [f64; 2], rows: &[f64], step: f64, same: f64, phase: usize) -> Vec<Instant> {
    let parts = ((to - from) / step).ceil().max(MIN_PARTS);
    let spacing = (to - from) / parts;
    let is_end = |time: f64| (time - from).abs() <= same || (time - to).abs() <= same;
    let has_row = |time: f64, within: f64| {
        let next = rows.partition_point(|row| *row < time - within);
        rows.get(next).is_some_and(|row| *row <= time + within)
    };

    let ends = [(from, Side::After), (to, Side::Before)].map(|(time, side)| Instant {
        time,
        side,
        phase,
        is_row: has_row(time, same),
        is_rest: false,
    });
    let after = |time: f64, is_row: bool| Instant { time, side: Side::After, phase, is_row, is_rest: false };
    let own = (1..parts as usize).map(|k| from + spacing * k as f64);
    let own = own.filter(|time| !has_row(*time, BESIDE_ROW * spacing)).map(|time| after(time, false));
    let of_rows = rows.iter().filter(|row| !is_end(**row)).map(|row| after(*row, true));
    let mut found: Vec<Instant> = ends.into_iter().chain(own).chain(of_rows).collect();
    found.sort_by(|a, b| a.time.total_cmp(&b.time));
    found
}
