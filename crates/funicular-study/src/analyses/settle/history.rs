//! Motion over time from the release or the end of a command on.

use super::{HistoryRow, MAX_POINTS, POINTS_PER_PERIOD, SMALL, points_in};
use funicular::math::Vec3;
use funicular::modes::{Decay, DecayingMotion};
use std::f64::consts::TAU;

/// Periods of the slowest mode that are shown of a motion that never settles.
const PERIODS: f64 = 20.0;

/// History of a decay.
pub(super) struct SwingHistory {
    pub(super) rows: Vec<HistoryRow>,
    /// Frequency up to which modes are in the rows; `None` if all are.
    pub(super) up_to_hz: Option<f64>,
    /// Maximum distance of the point from its rest, of all modes [m].
    pub(super) peak: f64,
}

impl SwingHistory {
    /// Motion up to a time [s], or for some periods if it never settles, with enough points per period of every mode
    /// that counts. If these are too many, the fastest modes are left out, because too few points would show them as
    /// slow ones.
    pub(super) fn of(decay: &Decay, until: f64) -> Self {
        let largest = decay.motions.iter().map(DecayingMotion::size).fold(0.0, f64::max);
        let counts = || decay.motions.iter().filter(move |motion| motion.size() >= SMALL * largest);
        let fastest = counts().fold(0.0_f64, |fastest, motion| fastest.max(motion.omega.re));
        let slowest = counts().fold(f64::INFINITY, |slowest, motion| slowest.min(motion.omega.re));
        if fastest <= 0.0 {
            return Self { rows: Vec::new(), up_to_hz: None, peak: 0.0 };
        }
        // At least one period of the slowest mode is shown.
        let period = TAU / slowest;
        let until = if until.is_finite() { until.max(period) } else { PERIODS * period };
        let most = MAX_POINTS / (until * POINTS_PER_PERIOD) * TAU;
        if fastest <= most {
            let rows = rows(decay, decay, until, points_in(until, fastest));
            let peak = rows.iter().map(distance).fold(0.0, f64::max);
            return Self { rows, up_to_hz: None, peak };
        }

        let of_slow = |motion: &&DecayingMotion| motion.omega.re <= most.max(slowest);
        let shown = Decay { motions: decay.motions.iter().filter(of_slow).copied().collect() };
        let rows = rows(&shown, decay, until, MAX_POINTS);
        let at_first = points_in(period, fastest);
        let peak = (0..=at_first as usize).map(|i| decay.at(period * i as f64 / at_first).norm()).fold(0.0, f64::max);
        Self { peak: rows.iter().map(distance).fold(peak, f64::max), rows, up_to_hz: Some(most.max(slowest) / TAU) }
    }
}

/// Caveat about a history without the modes above a frequency [Hz].
pub(super) fn caveat(up_to_hz: f64) -> String {
    format!(
        "the history would need more than {MAX_POINTS} rows to show all modes until the motion has settled: it has the \
         modes up to {up_to_hz:.4} Hz; times, amplitudes and the envelope have all"
    )
}

fn distance(row: &HistoryRow) -> f64 {
    Vec3::new(row.x_m, row.y_m, row.z_m).norm()
}

/// Rows at equal steps, with the bound of all modes.
fn rows(shown: &Decay, all: &Decay, until: f64, points: f64) -> Vec<HistoryRow> {
    (0..=points as usize)
        .map(|i| {
            let t_s = until * i as f64 / points;
            let [x_m, y_m, z_m] = shown.at(t_s).into();
            HistoryRow { t_s, x_m, y_m, z_m, envelope_m: Some(all.envelope(t_s)) }
        })
        .collect()
}
