//! Bounds of what the weight of an elastic catenary adds to a straight cable.
//!
//! With the tension τ along the chord, which is horizontal force over cos α, the vertical force at the platform is
//! `τ sin α − ½ w l` up to β. Let `g = 1/EA + 1/T`. The chord gives `τ sin α = ∫ V g ds / ∫ g ds`, a mean of the
//! vertical force V along the cable, which is linear in the arc s. Its deviation from the plain mean is at most
//! `w G L₀³/12 / ∫ g ds` with `G = max |g'| ≤ w max|V| / min T³`.

/// Cable that sags.
#[derive(Debug, Clone, Copy)]
pub(super) struct SagOfCable {
    /// Weight per unstrained length [N/m].
    pub(super) weight: f64,
    /// Axial stiffness [N].
    pub(super) axial_stiffness: f64,
}

/// Chords of a cable over a box.
#[derive(Debug, Clone, Copy)]
pub(super) struct ChordRange {
    /// Greatest length [m].
    pub(super) longest: f64,
    /// Greatest rise or fall [m].
    pub(super) steepest: f64,
    /// Least rise or fall [m].
    pub(super) flattest: f64,
    /// Greatest magnitude of the sine of the slope.
    pub(super) sine: f64,
}

/// Bounds of a sagging cable for chord tensions of a range.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SagBound {
    /// Deviation β of the vertical force at the platform from `τ sin α − ½ w l` [N].
    pub(super) deviation: f64,
    /// Amount by which the least tension anywhere can be below τ [N].
    pub(super) below: f64,
    /// Amount by which the greatest tension anywhere can be above τ [N].
    pub(super) above: f64,
}

impl SagOfCable {
    /// Bounds for chord tensions from `least` to `greatest`; `None` for a cable so slack that they have no meaning.
    pub(super) fn bound(&self, chord: &ChordRange, [least, greatest]: [f64; 2]) -> Option<SagBound> {
        /// Assumed bound of `|V − τ sin α|` over the weight of the chord. It is one half for a taut cable. If it gives
        /// a smaller one for every smaller weight, too, it is true: the cable without weight has none, and all is
        /// continuous in the weight.
        const ASSUMED: f64 = 0.75;
        let Self { weight, axial_stiffness } = *self;
        let straight = weight * chord.longest;

        // The unstrained length is at most that of the curve, whose angle to the chord has at most the sine v/T.
        let (mut varies, mut bound) = (ASSUMED * straight, None);
        for _ in 0..3 {
            let lowest = least - varies;
            if lowest <= 1.1 * varies {
                return None;
            }
            let stretched = chord.longest / (1.0 - (varies / lowest).powi(2)).sqrt();
            let load = weight * stretched;
            let vertical = least * chord.sine + varies;
            // max|V| T_max / T_min³ falls with τ.
            let curved = load * load / 12.0 * vertical * (least + varies) / lowest.powi(3);
            let longer = stretched - chord.longest;
            let shorter = chord.longest * (greatest + varies) / axial_stiffness;
            let deviation = curved + 0.5 * weight * longer.max(shorter);
            let found = 0.5 * load + curved;
            if found > varies {
                return bound;
            }
            varies = found;
            let across = varies * varies / (2.0 * (least - varies));
            let along = chord.sine * curved + 0.5 * weight * chord.steepest * (stretched / chord.longest);
            bound = Some(SagBound { deviation, below: along, above: along + across });
        }
        bound
    }

    /// Range of chord tensions of a cable whose tensions are within their limits everywhere.
    pub(super) fn chord_tensions(&self, chord: &ChordRange, [least, greatest]: [f64; 2]) -> Option<[f64; 2]> {
        // Somewhere in the cable the tension is τ, so τ is between the limits, too.
        let bound = self.bound(chord, [least, greatest])?;
        let half = 0.5 * self.weight * chord.longest + bound.deviation;
        let by_slope = (0.5 * self.weight * chord.flattest - bound.deviation).max(0.0);
        let at_low_end = by_slope + (least * least - half * half).max(0.0).sqrt();
        Some([least.max(at_low_end), greatest - by_slope])
    }
}
