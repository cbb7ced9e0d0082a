//! Books of the energy: what platform and ropes hold, and what came in and went out.

use super::dense::DenseOutput;
use super::rope::WoundLength;
use super::system::{MotionNumbers, RopeEnd, System};

/// Energy of platform and ropes [J], and the work done on them since the start.
///
/// # References
/// docs/theory.md, equation (97g).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EnergyBooks {
    /// Kinetic energy.
    pub kinetic: f64,
    /// Energy of the stretch of ropes, shafts and supports.
    pub strain: f64,
    /// Energy of height, zero at the origin of the world.
    pub potential: f64,
    /// Work of the winches, with the energy of the rope that passes the anchors.
    pub winches: f64,
    /// Work at anchors that move.
    pub anchors: f64,
    /// Work of loads, pushes and wind.
    pub loads: f64,
    /// Energy lost in damping.
    pub dissipated: f64,
    /// Energy that payloads brought with them, less what they took away.
    pub payloads: f64,
    pub(super) at_start: f64,
}

impl EnergyBooks {
    /// Energy of platform and ropes [J].
    pub fn total(&self) -> f64 {
        self.kinetic + self.strain + self.potential
    }

    /// Energy at the start [J].
    pub fn at_start(&self) -> f64 {
        self.at_start
    }

    /// Energy that moves now, and that came and went since the start [J]: the measure of an error of the energy.
    pub fn moved(&self) -> f64 {
        let Self { kinetic, winches, anchors, loads, payloads, dissipated, .. } = self;
        kinetic + winches.abs() + anchors.abs() + loads.abs() + payloads.abs() + dissipated
    }

    /// Error of the energy balance [J]: energy that only the errors of mesh and steps explain.
    pub fn defect(&self) -> f64 {
        self.total() - self.at_start - self.winches - self.anchors - self.loads - self.payloads + self.dissipated
    }
}

/// Powers that change the energy [W].
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Powers {
    pub(super) winches: f64,
    pub(super) anchors: f64,
    pub(super) loads: f64,
    pub(super) dissipation: f64,
}

/// Powers at the ends and in the middle of a step, whose integral is its work.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct StepPowers {
    pub(super) at: [Powers; 3],
    pub(super) duration: f64,
}

impl StepPowers {
    /// Work [J] from the beginning to the share s of the step: of winches, anchors, loads and damping.
    pub(super) fn work(&self, s: f64) -> [f64; 4] {
        let of = |power: fn(&Powers) -> f64| {
            let [p0, pm, p1] = [0, 1, 2].map(|k| power(&self.at[k]));
            let (linear, square) = (-3.0 * p0 + 4.0 * pm - p1, 2.0 * p0 - 4.0 * pm + 2.0 * p1);
            self.duration * s * (p0 + s * (0.5 * linear + s * square / 3.0))
        };
        [of(|p| p.winches), of(|p| p.anchors), of(|p| p.loads), of(|p| p.dissipation)]
    }
}

impl System {
    /// Energy and powers at a motion whose needed forces are known.
    pub(super) fn energy(
        &self,
        time: f64,
        lengths: &[WoundLength],
        m: &MotionNumbers,
        needed: &[f64],
    ) -> (EnergyBooks, Powers) {
        let body = self.body_motion(m);
        let [kinetic, potential] = self.body.energy(&body);
        let [loads, lost] = self.body.powers(time, &self.air.on_body(time), &body);
        let mut books = EnergyBooks { kinetic, potential, ..EnergyBooks::default() };
        let mut powers = Powers { winches: 0.0, anchors: 0.0, loads, dissipation: lost };
        for (i, rope) in self.ropes.iter().enumerate() {
            if self.ends[i] == RopeEnd::Gone {
                continue;
            }
            let range = self.of_rope(i);
            let wind = self.air.on_rope(i, time);
            let free = self.free_length(i, &lengths[i], m);
            let mut of = rope.energy(&free, &wind, [&m.x[range.clone()], &m.v[range.clone()], &m.a[range]]);
            if let Some(far) = &self.far_ends[i] {
                let behind = far.energy(&self.far_state(i, time, &lengths[i], m, needed));
                of = of.with_far_end(&behind, far.feed.is_some());
            }
            books.kinetic += of.kinetic;
            books.strain += of.strain;
            books.potential += of.potential;
            powers.winches += of.winch;
            powers.anchors += self.anchor_power(i, time, &lengths[i], m, needed);
            powers.loads += of.loads;
            powers.dissipation += of.dissipation;
        }
        for (index, support) in self.supports.iter().enumerate() {
            let [place, velocity, _] = m.point(Self::of_support(index).start);
            books.kinetic += 0.5 * support.mass * velocity.norm_squared();
            books.strain += 0.5 * place.dot(&(support.stiffness_w * place));
            powers.dissipation += support.damping_time * velocity.dot(&(support.stiffness_w * velocity));
        }
        (books, powers)
    }

    /// Motion at a time of a step, with its needed forces.
    pub(super) fn within(
        &mut self,
        dense: &DenseOutput,
        time: f64,
        m: &mut MotionNumbers,
        needed: &mut [f64],
    ) -> Vec<WoundLength> {
        let rotation = std::mem::replace(&mut self.rotation, dense.rotation);
        dense.at(time, m);
        let (lengths, body) = (self.lengths(time), self.body_motion(m));
        self.fill_ends(time, &body, &lengths, m);
        self.needed(time, &lengths, &body, m, needed);
        // The motion is given about the rotation that it belongs to.
        self.rotation = rotation;
        lengths
    }
}
