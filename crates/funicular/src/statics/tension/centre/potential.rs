//! Functions of the tensions whose minimum is searched: the two logarithms of each cable, the same continued beyond the
//! limits, or none.

use super::CentreCable;
use crate::math::dual::Real;

/// Distance from a limit, over the distance between the limits, below which a relaxed logarithm is a parabola. With a
/// smaller one the tensions beyond the limits are nearer to the least possible, and Newton's method takes 40 to 60
/// steps in place of 15.
const RELAXED: f64 = 1e-3;

/// Part of the slackest tension below which no step goes where no limit stops it: a fiftieth of the cable's weight.
const MIN_SLACKENED: f64 = 0.05;

/// Function of the tensions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Potential {
    /// Logarithms of the distances from both limits, (40b1).
    Logarithms,
    /// Logarithms that become parabolas near the limits, so that tensions beyond them have a value too, (40b8).
    Relaxed,
    /// None, where the balance alone determines the tensions.
    None,
}

impl Potential {
    /// First and second derivative by τ.
    pub(super) fn derivatives(self, cable: &CentreCable<'_>) -> [f64; 2] {
        match self {
            Self::Logarithms => logarithms(cable.room()),
            Self::Relaxed => {
                let width = relaxed_width(cable);
                let [[below, bent_below], [above, bent_above]] = cable.room().map(|room| relaxed(room, width));
                [below - above, bent_below + bent_above]
            }
            Self::None => [0.0, 1.0],
        }
    }

    /// Slope by τ, between limits and at a tension in numbers with derivatives.
    pub(super) fn slope<T: Real>(self, [lower, upper]: &[T; 2], tau: T) -> T {
        let (below, above) = (tau - *lower, *upper - tau);
        let inverse = |room: T| T::from(1.0) / room;
        match self {
            Self::Logarithms => inverse(above) - inverse(below),
            Self::Relaxed => {
                let width = (*upper - *lower) * RELAXED;
                let relaxed = |room: T| {
                    if room.value() >= width.value() { -inverse(room) } else { (room - width * 2.0) / (width * width) }
                };
                relaxed(below) - relaxed(above)
            }
            Self::None => T::from(0.0),
        }
    }

    /// Farthest that a step in this direction may go [N].
    pub(super) fn reach(self, cable: &CentreCable<'_>, step: f64) -> f64 {
        let [below, above] = cable.room();
        let room = if step < 0.0 { below } else { above };
        match self {
            Self::Logarithms => room,
            Self::Relaxed => {
                let width = relaxed_width(cable);
                if room > 2.0 * width { room - width } else { f64::INFINITY }
            }
            Self::None => f64::INFINITY,
        }
    }

    /// Size with which a step is compared [N]: the distance from the nearer limit.
    pub(super) fn size(self, cable: &CentreCable<'_>) -> f64 {
        let [below, above] = cable.room();
        match self {
            Self::Logarithms => below.min(above),
            Self::Relaxed => below.min(above).max(relaxed_width(cable)),
            Self::None => cable.curve.tau().abs(),
        }
    }

    /// Tension after a step [N].
    pub(super) fn moved(self, cable: &CentreCable<'_>, step: f64) -> f64 {
        let (tau, slackest) = (cable.curve.tau(), cable.curve.slackest());
        match self {
            Self::Logarithms => tau + step,
            Self::Relaxed | Self::None => {
                let least = if slackest > 0.0 { MIN_SLACKENED * slackest } else { f64::NEG_INFINITY };
                (tau + step).max(least)
            }
        }
    }
}

/// First and second derivative of `−ln s⁻ − ln s⁺` by τ.
pub(super) fn logarithms([below, above]: [f64; 2]) -> [f64; 2] {
    [1.0 / above - 1.0 / below, 1.0 / (below * below) + 1.0 / (above * above)]
}

/// Distance from the limits at which the logarithms of a cable become parabolas [N].
fn relaxed_width(cable: &CentreCable<'_>) -> f64 {
    RELAXED * (cable.upper - cable.lower)
}

/// Violation of the nearer limit of a cable, over [`relaxed_width`]; negative between the limits.
pub(super) fn violation(cable: &CentreCable<'_>) -> f64 {
    let [below, above] = cable.room();
    -below.min(above) / relaxed_width(cable)
}

/// First and second derivative by s of `−ln s`, and below `width` of the parabola `½[((s − 2ε)/ε)² − 1] − ln ε`.
fn relaxed(s: f64, width: f64) -> [f64; 2] {
    if s >= width { [-1.0 / s, 1.0 / (s * s)] } else { [(s - 2.0 * width) / (width * width), 1.0 / (width * width)] }
}

#[cfg(test)]
mod tests {
    use super::relaxed;

    #[test]
    fn a_relaxed_logarithm_is_smooth_where_its_parabola_begins() {
        for width in [1e-3, 1.0, 40.0] {
            let [inside, outside] = [width * (1.0 + 1e-12), width * (1.0 - 1e-12)].map(|s| relaxed(s, width));
            for (a, b) in inside.into_iter().zip(outside) {
                assert!((a - b).abs() < 1e-11 * a.abs(), "{a} {b}");
            }
            // Beyond the limit the parabola pulls back with a slope that grows with the distance.
            let [near, far] = [-1.0, -100.0].map(|s| relaxed(s * width, width)[0]);
            assert!((near * width + 3.0).abs() < 1e-12 && (far * width + 102.0).abs() < 1e-12, "{near} {far}");
        }
    }
}
