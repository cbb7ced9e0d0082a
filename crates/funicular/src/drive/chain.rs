//! Motions behind the exit point of a cable, and their stiffness and mass: wheel, drum side, drum, shaft and motor.
//!
//! The first motion is σ, that of the cable along itself at the wheel, towards the platform; the wheel turns with it.
//! Behind it follow guide wheels with mass, the waves of a drum side with mass, the drum and the motor, as motions of
//! the cable there towards the wheel. A part that cannot move has no motion: a rigid winch is a wall (docs/theory.md,
//! equations (75) to (79)).

mod description;
mod parts;

pub(crate) use description::{ChainDescription, Piece};

use super::{AnchorEnd, DriveAtRest};
use crate::math::{Complex, DMat, legendre};
use crate::robot::{Anchor, Servo, WinchMode};
use parts::{MotionOrder, Parts};

/// Motions behind the exit point of a cable, as a chain from the wheel to the motor.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveChain {
    /// Stiffness over the motions, with the position gain of a control [N/m]; symmetric.
    pub stiffness: DMat,
    /// Mass of wheel, guide wheels, drum and motor over the motions [kg]; diagonal.
    pub mass: DMat,
    /// Mass of the cable between drum and exit point over the motions [kg]; symmetric.
    pub cable_mass: DMat,
    /// Drum, if it can move.
    pub drum: Option<Place>,
    /// Motor, if it can move.
    pub motor: Option<Motor>,
    /// Force on each motion per unstrained length that a held drum or motor pays out: by stiffness [N/m], and by the
    /// mass of the cable per ω² [kg]. Empty if a control moves the drum.
    pub(crate) by_length: Vec<(f64, f64)>,
    /// Force of the drum side on each motion; empty if the drum is at the exit point.
    pub(crate) drum_side: Vec<OnDrumSide>,
    /// Mass of a drum side with mass [kg]; zero for one without.
    pub(crate) drum_side_mass: f64,
    /// End of the drum side at the drum; `None` if the drum is at the exit point.
    pub(crate) drum_end: Option<DrumEnd>,
    /// Stretch λ_E between entry point and drum.
    pub(crate) stretch_drum: f64,
    /// Motions in which the drum side stretches.
    pub(crate) stretches: Vec<ChainStretch>,
}

/// Motion in which a piece of the drum side stretches: its elongation, or one of its waves.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ChainStretch {
    /// The motion as a sum of parts of the motions of the chain.
    pub(crate) parts: Vec<Place>,
    /// Stiffness of the spring [N/m].
    pub(crate) stiffness: f64,
    /// The motion per displacement of the ends of the drum side: of that at the drum and of that at the wheel.
    pub(crate) by_ends: [f64; 2],
}

impl ChainStretch {
    /// The motion by displacements of the ends of the drum side, at the drum and at the wheel.
    pub(crate) fn by(&self, ends: [f64; 2]) -> f64 {
        self.by_ends[0] * ends[0] + self.by_ends[1] * ends[1]
    }
}

/// Force of the drum side on a motion of the chain when the pulley moves along the drum side, or carries it along.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct OnDrumSide {
    /// Stiffness between the motion and the end of the drum side at the wheel [N/m].
    pub(crate) stiffness: f64,
    /// Mass between the motion and that end [kg].
    pub(crate) mass: f64,
    /// Mass between the motion and a motion of the whole drum side along itself [kg].
    pub(crate) carried_mass: f64,
}

/// End of the drum side at the drum: pairs of stiffness [N/m] and mass [kg] give the force on it over the stretch,
/// towards the wheel.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DrumEnd {
    /// Pairs between this end and each motion.
    pub(crate) by_motion: Vec<(f64, f64)>,
    /// Pair between this end and itself. A held drum that pays out a length moves the end by this length times the
    /// stretch at the exit point.
    pub(crate) own: (f64, f64),
    /// Pair between this end and the end at the wheel; zero if guide wheels lie between them.
    pub(crate) by_wheel: (f64, f64),
    /// Mass between this end and a motion of the whole drum side along itself [kg].
    pub(crate) carried_mass: f64,
    /// Tension at the drum per force on this end: the ratio of the stretch at the exit point to that at the drum.
    pub(crate) ratio: f64,
}

/// Place of a part of the drive in the chain: its motion as a multiple of one of the motions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Index of the motion.
    pub motion: usize,
    /// Motion of the part per that motion.
    pub factor: f64,
}

impl Place {
    /// Place that moves `factor` times as far.
    fn times(self, factor: f64) -> Self {
        Self { factor: factor * self.factor, ..self }
    }
}

/// Motor that can move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motor {
    /// Place of the motor in the chain.
    pub place: Place,
    /// Viscous damping at the cable [N s/m].
    pub damping: f64,
    /// Position control; `None` for a constant torque.
    pub servo: Option<Servo>,
}

impl Motor {
    /// Difference between the dynamic stiffness of the control and its position gain, viscous damping included, at the
    /// complex ω [N/m], and its derivative by ω: `(K_p + iωK_d) e^{−iωτ} − K_p + iωc`.
    fn loss(&self, omega: Complex) -> (Complex, Complex) {
        let i = Complex::i();
        let viscous = (i * omega * self.damping, i * self.damping);
        let Some(servo) = self.servo else { return viscous };
        let (control, slope) = servo.control(omega);
        (viscous.0 + control - servo.position_gain, viscous.1 + slope)
    }
}

impl Servo {
    /// Force of the control at the cable per error of position at the complex ω [N/m], and its derivative by ω.
    pub(crate) fn control(&self, omega: Complex) -> (Complex, Complex) {
        let i = Complex::i();
        let (gain, delay) = (self.position_gain + i * omega * self.speed_gain, (-i * omega * self.delay).exp());
        (gain * delay, (i * self.speed_gain - i * self.delay * gain) * delay)
    }
}

/// Chain under construction.
struct ChainMatrices {
    stiffness: DMat,
    mass: DMat,
    cable_mass: DMat,
    stretches: Vec<ChainStretch>,
}

impl ChainMatrices {
    /// Chain of `n` motions without stiffness and mass.
    fn new(n: usize) -> Self {
        Self {
            stiffness: DMat::zeros(n, n),
            mass: DMat::zeros(n, n),
            cable_mass: DMat::zeros(n, n),
            stretches: Vec::new(),
        }
    }

    /// Adds a spring [N/m] against the sum of these parts of the motions.
    fn spring(&mut self, stiffness: f64, parts: &[Place]) {
        for a in parts {
            for b in parts {
                self.stiffness[(a.motion, b.motion)] += stiffness * a.factor * b.factor;
            }
        }
    }

    /// Adds a mass [kg] at a place.
    fn heavy(&mut self, mass: f64, at: Place) {
        self.mass[(at.motion, at.motion)] += mass * at.factor * at.factor;
    }

    /// Adds the drum side, which stretches between σ, the guide wheels and its end at the drum. The result is the end
    /// at the drum, and the mass of a rod between each motion and a motion of the whole rod [kg].
    fn drum_side(&mut self, parts: &Parts, layout: &MotionOrder) -> (DrumEnd, Vec<f64>) {
        let mut end = DrumEnd {
            by_motion: vec![(0.0, 0.0); layout.count],
            own: (0.0, 0.0),
            by_wheel: (0.0, 0.0),
            carried_mass: 0.0,
            ratio: parts.stretch / parts.stretch_drum,
        };
        let mut carried = vec![0.0; layout.count];
        let last = parts.pieces.len();
        for (piece, ends) in layout.nodes.windows(2).enumerate() {
            let (spring, at_drum) = (parts.spring(piece), piece + 1 == last);
            let both: Vec<Place> = ends[0].into_iter().chain(ends[1].map(|end| end.times(-1.0))).collect();
            self.spring(spring, &both);
            let by_ends = [if at_drum { -1.0 } else { 0.0 }, if piece == 0 { 1.0 } else { 0.0 }];
            self.stretches.push(ChainStretch { parts: both.clone(), stiffness: spring, by_ends });
            if at_drum {
                end.own.0 = spring;
                for place in both {
                    end.by_motion[place.motion].0 -= spring * place.factor;
                }
            }
            if last == 1 {
                end.by_wheel.0 = -spring;
            }
            if parts.is_rod() {
                let mass = self.rod(parts, layout, piece, &mut carried);
                if at_drum {
                    end.set_mass(&mass, |function| layout.place(piece, function));
                    end.by_wheel.1 = if last == 1 { mass[(0, 1)] } else { 0.0 };
                }
            }
        }

        (end, carried)
    }

    /// Adds the mass of a piece of the drum side that is a rod, and its waves. Functions are hats at both of its ends,
    /// then polynomials that vanish there. The result is the mass over these functions.
    fn rod(&mut self, parts: &Parts, layout: &MotionOrder, piece: usize, carried: &mut [f64]) -> DMat {
        let half = 0.5 * parts.rod_length(piece);
        let functions = layout.waves[piece].len() + 2;
        let mass = legendre::element_mass(functions - 1) * (half * parts.mass_per_length);
        for row in 0..functions {
            let Some(a) = layout.place(piece, row) else { continue };
            carried[a.motion] += (mass[(row, 0)] + mass[(row, 1)]) * a.factor;
            for column in 0..functions {
                if let Some(b) = layout.place(piece, column) {
                    self.cable_mass[(a.motion, b.motion)] += mass[(row, column)] * a.factor * b.factor;
                }
            }
            // The slopes of these polynomials are orthonormal.
            if row >= 2 {
                let stiffness = parts.axial_stiffness / half;
                self.stiffness[(a.motion, a.motion)] += stiffness;
                self.stretches.push(ChainStretch { parts: vec![a], stiffness, by_ends: [0.0; 2] });
            }
        }
        mass
    }

    /// Adds drum, shaft and motor.
    fn winch(&mut self, parts: &Parts, layout: &MotionOrder) {
        let (Some(winch), Some(drum)) = (parts.winch, layout.drum) else { return };
        self.heavy(winch.drum_mass, drum);
        if parts.shaft.is_finite() {
            let ends: Vec<Place> = [drum].into_iter().chain(layout.motor.map(|motor| motor.times(-1.0))).collect();
            self.spring(parts.shaft, &ends);
        }
        if let Some(motor) = layout.motor {
            self.heavy(winch.motor_mass, motor);
            self.spring(parts.servo().map_or(0.0, |servo| servo.position_gain), &[motor]);
        }
    }
}

impl DrumEnd {
    /// Sets the masses between this end, the second function of the last piece, and the functions of that piece.
    fn set_mass(&mut self, mass: &DMat, place: impl Fn(usize) -> Option<Place>) {
        self.own.1 = mass[(1, 1)];
        self.carried_mass = mass[(1, 1)] + mass[(0, 1)];
        for function in 0..mass.nrows() {
            if let Some(at) = place(function) {
                self.by_motion[at.motion].1 += mass[(function, 1)] * at.factor;
            }
        }
    }
}

/// Motion σ of the cable along itself at the wheel: the first motion of every chain.
const AT_WHEEL: Place = Place { motion: 0, factor: 1.0 };

/// Force on the motions per unstrained length that is paid out: see [`DriveChain::by_length`].
fn by_length(parts: &Parts, layout: &MotionOrder, drum_end: &DrumEnd) -> Vec<(f64, f64)> {
    match (layout.drum, layout.motor) {
        (_, Some(_)) => Vec::new(),
        (Some(drum), None) => {
            let mut force = vec![(0.0, 0.0); layout.count];
            force[drum.motion].0 = parts.shaft * drum.factor * parts.stretch_drum;
            force
        }
        // The end at the drum is moved.
        (None, None) => drum_end.by_motion.iter().map(|(k, mass)| (-k * parts.stretch, mass * parts.stretch)).collect(),
    }
}

impl DriveChain {
    /// Chain behind the exit point of a cable with the axial stiffness EA [N] and the mass per length m [kg/m], for
    /// frequencies up to `limit` [rad/s]. `None` if the cable cannot move at its exit point.
    pub(crate) fn of(
        anchor: &Anchor,
        drive: &DriveAtRest,
        (axial_stiffness, mass_per_length): (f64, f64),
        mode: WinchMode,
        limit: f64,
    ) -> Option<Self> {
        let parts = Parts::of(anchor, drive, (axial_stiffness, mass_per_length), mode)?;
        let layout = MotionOrder::of(&parts, limit);
        let mut chain = ChainMatrices::new(layout.count);

        // Wheel and weight of the cable on it, drum side, then drum, shaft and motor.
        chain.stiffness[(0, 0)] += drive.end.weight;
        if let Some(pulley) = &anchor.pulley {
            chain.heavy(pulley.inertia / (pulley.radius * pulley.radius), AT_WHEEL);
        }
        for (mass, place) in parts.guides.iter().zip(&layout.guides) {
            chain.heavy(*mass, *place);
        }
        let (drum_end, carried) = chain.drum_side(&parts, &layout);
        let on_drum_side = |motion: usize| OnDrumSide {
            stiffness: chain.stiffness[(motion, 0)] - if motion == 0 { drive.end.weight } else { 0.0 },
            mass: chain.cable_mass[(motion, 0)],
            carried_mass: carried[motion],
        };
        let drum_side = if parts.has_rope() { (0..layout.count).map(on_drum_side).collect() } else { Vec::new() };
        chain.winch(&parts, &layout);

        let ChainMatrices { stiffness, mass, cable_mass, stretches } = chain;
        let damping = parts.winch.map_or(0.0, |winch| winch.damping);
        let motor = layout.motor.map(|place| Motor { place, damping, servo: parts.servo() });
        let (drum, stretch_drum) = (layout.drum, drive.end.stretch_drum);
        Some(Self {
            stiffness,
            mass,
            cable_mass,
            drum,
            motor,
            by_length: by_length(&parts, &layout, &drum_end),
            drum_side,
            drum_side_mass: parts.rod_mass(),
            drum_end: parts.has_rope().then_some(drum_end),
            stretch_drum,
            stretches,
        })
    }

    /// Chain of an end at rest: the spring of arc and drum side, and that of the winch. `None` for an end that is held.
    pub(crate) fn at_rest(end: &AnchorEnd) -> Option<Self> {
        end.along_w?;
        let (whole, rope) = (end.stiffness[0][0] - end.weight, end.rope_spring());
        let winch = rope.and_then(|rope| Some((rope, softer(rope, whole)?)));
        let motion = |motion: usize, factor: f64| Place { motion, factor };
        let (stiffness, parts) = match (rope, winch) {
            (_, Some((rope, winch))) => (
                DMat::from_row_slice(2, 2, &[end.weight + rope, -rope, -rope, rope + winch]),
                vec![AT_WHEEL, motion(1, -1.0)],
            ),
            _ => (DMat::from_element(1, 1, end.weight + whole), vec![AT_WHEEL]),
        };
        let on_side = |part: &Place| OnDrumSide {
            stiffness: rope.map_or(0.0, |rope| rope * part.factor),
            mass: 0.0,
            carried_mass: 0.0,
        };
        let count = stiffness.nrows();
        let drum_end = rope.map(|rope| DrumEnd {
            by_motion: parts.iter().map(|part| (-rope * part.factor, 0.0)).collect(),
            own: (rope, 0.0),
            by_wheel: (-rope, 0.0),
            carried_mass: 0.0,
            ratio: end.stretch / end.stretch_drum,
        });
        Some(Self {
            stiffness,
            mass: DMat::zeros(count, count),
            cable_mass: DMat::zeros(count, count),
            drum: None,
            motor: None,
            by_length: Vec::new(),
            drum_side: parts.iter().filter(|_| rope.is_some()).map(on_side).collect(),
            drum_side_mass: 0.0,
            drum_end,
            stretch_drum: end.stretch_drum,
            stretches: rope
                .map(|stiffness| ChainStretch { parts, stiffness, by_ends: [-1.0, 1.0] })
                .into_iter()
                .collect(),
        })
    }

    /// Number of motions.
    pub fn len(&self) -> usize {
        self.stiffness.nrows()
    }

    /// False: a chain has at least the motion of the cable at its wheel.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// True if the chain has mass of its own, or losses: with a chain of springs the cable end is one spring.
    pub(crate) fn has_dynamics(&self) -> bool {
        self.mass.amax() > 0.0 || self.cable_mass.amax() > 0.0 || self.has_losses()
    }

    /// True if the motor has damping, or a control that differs from a spring.
    pub(crate) fn has_losses(&self) -> bool {
        self.motor.is_some_and(|motor| {
            motor.damping > 0.0 || motor.servo.is_some_and(|servo| servo.speed_gain > 0.0 || servo.delay > 0.0)
        })
    }

    /// Viscous damping of each motion [N s/m]: that of the motor, and the speed gain of its control. A delay is left
    /// out.
    pub(crate) fn viscous_damping(&self) -> Vec<f64> {
        let mut damping = vec![0.0; self.len()];
        if let Some(motor) = &self.motor {
            let Place { motion, factor } = motor.place;
            damping[motion] = factor * factor * (motor.damping + motor.servo.map_or(0.0, |servo| servo.speed_gain));
        }
        damping
    }

    /// Static response of all motions to a unit force on σ, if the cable adds the stiffness `held` [N/m] to it: the
    /// inverse of the chain's stiffness, n×n [m/N]. `None` if nothing holds the chain.
    pub(crate) fn flexibility(&self, held: f64) -> Option<DMat> {
        let mut total = self.stiffness.clone();
        total[(0, 0)] += held;
        Some(total.cholesky()?.inverse())
    }

    /// Difference between the dynamic stiffness of each motion and that of the undamped chain at the complex ω [N/m],
    /// with its derivative by ω; no two motions share a mass or a loss. The undamped matrices contain the square ω_c²
    /// of the cable (`square`, with its derivative by ω), because the cable has its own damping; wheel, drum and motor
    /// have ω². `losses` is the fraction of the damping that acts.
    pub(crate) fn beyond_undamped(
        &self,
        omega: Complex,
        (square, square_slope): (Complex, Complex),
        losses: f64,
    ) -> Vec<(Complex, Complex)> {
        let (by_mass, by_mass_slope) = (square - omega * omega, square_slope - 2.0 * omega);
        let mut delta: Vec<(Complex, Complex)> =
            self.mass.diagonal().iter().map(|mass| (by_mass * *mass, by_mass_slope * *mass)).collect();
        if let Some(motor) = &self.motor {
            let Place { motion, factor } = motor.place;
            let (loss, loss_slope) = motor.loss(omega);
            delta[motion].0 += losses * factor * factor * loss;
            delta[motion].1 += losses * factor * factor * loss_slope;
        }
        delta
    }
}

/// Stiffness that has the stiffness `whole` in series with the spring `rope` [N/m]; `None` for a rigid one.
fn softer(rope: f64, whole: f64) -> Option<f64> {
    let compliance = 1.0 / whole - 1.0 / rope;
    (compliance > RIGID / rope).then(|| 1.0 / compliance)
}

/// Compliance over that of the rope up to which a winch counts as rigid: rounding.
const RIGID: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::{Control, DrumSide, Winch};

    /// A rod whose end is held: its condensed stiffness is EA κ cot κs, up to the highest frequency that it is made
    /// for.
    #[test]
    fn a_rod_has_the_axial_waves_of_its_length() {
        let winch = Winch { drum_side: DrumSide::Rod, ..Winch::rigid("winch", 0.0) };
        for limit in [10.0, 3e3, 3e4] {
            let parts = Parts {
                winch: Some(&winch),
                control: Control::Ideal,
                shaft: f64::INFINITY,
                axial_stiffness: 2e5,
                mass_per_length: 0.07,
                stretch: 1.0,
                stretch_drum: 1.0,
                pieces: vec![3.0 / 2e5],
                guides: Vec::new(),
            };
            let layout = MotionOrder::of(&parts, limit);
            let mut chain = ChainMatrices::new(layout.count);
            chain.drum_side(&parts, &layout);
            for omega in [0.3 * limit, 0.77 * limit, limit] {
                let d = &chain.stiffness - &chain.cable_mass * (omega * omega);
                // Schur complement on σ.
                let condensed = 1.0 / d.try_inverse().unwrap()[(0, 0)];
                let kappa: f64 = omega * (0.07_f64 / 2e5).sqrt();
                let exact = 2e5 * kappa / (kappa * 3.0).tan();
                // Ill-conditioned beside a zero, hence relative to the static stiffness.
                let size = exact.abs().max(2e5 / 3.0);
                assert!((condensed - exact).abs() < 1e-10 * size, "{limit} {omega}: {condensed} {exact}");
            }
        }
    }
}
