//! Step control of the searches for the maximum distance from the limits.

/// Ratio of two successive changes of the tensions above which a step counts as a setback. A search that converges
/// slower than this factor per step would reach the maximum number of iterations without an end: `0.9^100 = 3e-5`.
pub(super) const SETBACK: f64 = 0.9;

/// Factor by which a repeated setback reduces the growth of the smallest distance, and by which a search from another
/// start reduces its first step each time. Chosen, not fitted; each is smaller than
/// [`SETBACK_FACTOR`](super::SETBACK_FACTOR), because a proximal step never grows again.
pub(super) const SMALLER_CLIMB: f64 = 0.3;

/// Limited growth of the smallest distance from the limits [N].
#[derive(Debug, Clone, Copy)]
pub(in crate::statics::tension) struct ProximalStep {
    pub from: f64,
    pub by: f64,
}

/// Step control of the search for the maximum distance.
///
/// If the optimum is not a corner of the linear problem, the corners on both sides take turns. Then the steps are made
/// smaller: the distance may grow by a limited amount only, with the smallest possible move of the tensions (a proximal
/// step). The fixed points are the same.
#[derive(Debug)]
pub(in crate::statics::tension) struct ProximalStepControl {
    pub climb: Option<ProximalStep>,
    pub last_change: f64,
    setbacks: usize,
}

impl Default for ProximalStepControl {
    fn default() -> Self {
        Self { climb: None, last_change: f64::INFINITY, setbacks: 0 }
    }
}

impl ProximalStepControl {
    /// Takes note of a change of the tensions, over their size, and of the height that was reached; makes the next step
    /// smaller after a setback.
    pub(in crate::statics::tension) fn next(&mut self, change: f64, size: f64, height: f64) {
        if change > SETBACK * self.last_change {
            self.setbacks += 1;
            if self.setbacks > 1 {
                let by = self.climb.map_or(change * size, |climb| SMALLER_CLIMB * climb.by);
                self.climb = Some(ProximalStep { from: height, by });
            }
        }
        if let Some(climb) = &mut self.climb {
            climb.from = height;
        }
        self.last_change = change;
    }
}
