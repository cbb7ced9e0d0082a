//! Motions behind the exit point of a cable, and their stiffness and mass: wheel, drum side, drum, shaft and motor.
//!
//! The first motion is the slip σ of the cable on the wheel, towards the platform. Behind it follow the waves of a drum
//! side with mass, the drum and the motor, both as motion of the cable at the drum towards the wheel. What cannot move
//! has no motion: a rigid winch is a wall (docs/theory.md, equations (75) to (79)).

use super::DriveAtRest;
use crate::math::{Complex, DMat, legendre};
use crate::robot::{Anchor, Control, DrumSide, Servo, WinchMode};

/// Polynomial degree of a drum side with mass per radian of an axial wave's phase, and its degrees besides. A wave needs
/// 0.5 degrees per radian; six more degrees leave an error of 1e-12.
const DEGREE_PER_RADIAN: f64 = 0.5;
const BASE_DEGREE: f64 = 8.0;

/// Motions behind the exit point of a cable, as a chain from the wheel to the motor.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveChain {
    /// Stiffness over the motions, with the position gain of a control [N/m]; symmetric.
    pub stiffness: DMat,
    /// Mass of wheel, drum and motor over the motions [kg]; diagonal.
    pub mass: DMat,
    /// Mass of the cable between drum and exit point over the motions [kg]; symmetric.
    pub cable_mass: DMat,
    /// Drum, if it can move.
    pub drum: Option<Place>,
    /// Motor, if it can move.
    pub motor: Option<Motor>,
    /// Force on the motions per unstrained length that is paid out at a drum or by a motor that is held [N/m], and that
    /// by the mass of the cable, per ω² [kg]; empty if a control moves the drum.
    pub(crate) by_length: Vec<(f64, f64)>,
    /// Stretch λ_E between entry point and drum.
    pub(crate) stretch_drum: f64,
}

/// Place of a part of the drive in the chain: its motion as a multiple of one of the motions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Index of the motion.
    pub motion: usize,
    /// Motion of the part per that motion.
    pub factor: f64,
}

/// Motor that can move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motor {
    /// Its place.
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
struct Assembly {
    stiffness: DMat,
    mass: DMat,
    cable_mass: DMat,
}

impl Assembly {
    /// Chain of `n` motions without stiffness and mass.
    fn new(n: usize) -> Self {
        Self { stiffness: DMat::zeros(n, n), mass: DMat::zeros(n, n), cable_mass: DMat::zeros(n, n) }
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
        let end = &drive.end;
        let winch = anchor.winch.as_ref();
        let control = match (mode, winch) {
            (WinchMode::Stuck, _) => return None,
            (WinchMode::Clamped, _) | (_, None) => Control::Ideal,
            (WinchMode::Torque, Some(_)) => Control::Torque,
            (WinchMode::AsGiven, Some(winch)) => winch.control,
        };
        let shaft = winch.map_or(f64::INFINITY, |winch| winch.stiffness);
        let (motor_moves, yields) = (control != Control::Ideal, shaft.is_finite());
        let drum_moves = motor_moves || yields;

        // Motions: σ, waves of the drum side, drum, motor. A drum side of no length makes drum and cable one.
        let rope = end.rope_compliance;
        if rope <= 0.0 && !drum_moves {
            return None;
        }
        let stretch = end.stretch;
        let (spring, length) = (1.0 / (stretch * stretch * rope), axial_stiffness * stretch * stretch * rope);
        let is_rod = rope > 0.0 && mass_per_length > 0.0 && winch.is_some_and(|winch| winch.drum_side == DrumSide::Rod);
        let waves = if is_rod {
            let phase = limit * (mass_per_length / axial_stiffness).sqrt() * length;
            (DEGREE_PER_RADIAN * phase + BASE_DEGREE).ceil() as usize - 1
        } else {
            0
        };
        let mut count = 1 + waves;
        let mut another = || {
            count += 1;
            Place { motion: count - 1, factor: 1.0 }
        };
        let slip = Place { motion: 0, factor: 1.0 };
        let ratio = stretch / end.stretch_drum;
        let drum = drum_moves.then(|| if rope > 0.0 { another() } else { Place { motion: 0, factor: 1.0 / ratio } });
        let motor = match drum {
            Some(drum) if motor_moves => Some(if yields { another() } else { drum }),
            _ => None,
        };

        // Wheel and weight of the cable on it.
        let mut chain = Assembly::new(count);
        chain.stiffness[(0, 0)] += end.weight;
        if let Some(pulley) = &anchor.pulley {
            chain.heavy(pulley.inertia / (pulley.radius * pulley.radius), slip);
        }

        // Drum side: the cable stretches between σ and its end at the drum, which is the motion w of the drum there,
        // but for the stretch.
        let at_drum = drum.map(|place| Place { factor: ratio * place.factor, ..place });
        if rope > 0.0 {
            match at_drum {
                Some(at_drum) => chain.spring(spring, &[slip, Place { factor: -at_drum.factor, ..at_drum }]),
                None => chain.spring(spring, &[slip]),
            }
        }
        let mut held_end = vec![0.0; count];
        if is_rod {
            held_end = chain.rod((axial_stiffness, mass_per_length, length), waves, at_drum);
        }

        // Drum, shaft and motor.
        let (drum_mass, motor_mass) = winch.map_or((0.0, 0.0), |winch| (winch.drum_mass, winch.motor_mass));
        if let Some(drum) = drum {
            chain.heavy(drum_mass, drum);
            match motor {
                Some(motor) if yields => chain.spring(shaft, &[drum, Place { factor: -motor.factor, ..motor }]),
                None => chain.spring(shaft, &[drum]),
                Some(_) => {}
            }
        }
        let servo = if let Control::Position(servo) = control { Some(servo) } else { None };
        if let Some(motor) = motor {
            chain.heavy(motor_mass, motor);
            chain.spring(servo.map_or(0.0, |servo| servo.position_gain), &[motor]);
        }

        // Force by a length that is paid out at a drum that is held, or behind a shaft that yields.
        let by_length = match (drum, motor) {
            (_, Some(_)) => Vec::new(),
            (Some(drum), None) => {
                let mut force = vec![(0.0, 0.0); count];
                force[drum.motion].0 = shaft * drum.factor * end.stretch_drum;
                force
            }
            (None, None) => {
                let still = |motion: usize| if motion == 0 { spring * stretch } else { 0.0 };
                held_end.iter().enumerate().map(|(motion, mass)| (still(motion), mass * stretch)).collect()
            }
        };

        let Assembly { stiffness, mass, cable_mass } = chain;
        let damping = winch.map_or(0.0, |winch| winch.damping);
        let motor = motor.map(|place| Motor { place, damping, servo });
        Some(Self { stiffness, mass, cable_mass, drum, motor, by_length, stretch_drum: end.stretch_drum })
    }

    /// Number of motions.
    pub fn len(&self) -> usize {
        self.stiffness.nrows()
    }

    /// False: a chain has at least the slip of the cable on its wheel.
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

    /// Static response of all motions to a unit force on σ, if the cable adds the stiffness `held` [N/m] to it: the
    /// inverse of the chain's stiffness, n×n [m/N]. `None` if nothing holds the chain.
    pub(crate) fn flexibility(&self, held: f64) -> Option<DMat> {
        let mut total = self.stiffness.clone();
        total[(0, 0)] += held;
        Some(total.cholesky()?.inverse())
    }
}

impl Assembly {
    /// Adds waves and mass of a drum side with the axial stiffness EA [N], the mass per length [kg/m] and the length of
    /// a uniform rod [m]; its spring is there. The result is the mass between the motions and the end at the drum [kg],
    /// if the drum is held.
    fn rod(
        &mut self,
        (axial_stiffness, mass_per_length, length): (f64, f64, f64),
        waves: usize,
        at_drum: Option<Place>,
    ) -> Vec<f64> {
        // Functions of the rod: hats at σ and at the drum, then polynomials that vanish at both.
        let half = 0.5 * length;
        let mass = legendre::element_mass(waves + 1) * (half * mass_per_length);
        let place = |function: usize| match function {
            0 => Some(Place { motion: 0, factor: 1.0 }),
            1 => at_drum,
            bubble => Some(Place { motion: bubble - 1, factor: 1.0 }),
        };

        let mut by_end = vec![0.0; self.mass.nrows()];
        for row in 0..waves + 2 {
            let Some(a) = place(row) else { continue };
            for column in 0..waves + 2 {
                let entry = mass[(row, column)];
                match place(column) {
                    Some(b) => self.cable_mass[(a.motion, b.motion)] += entry * a.factor * b.factor,
                    None => by_end[a.motion] += entry * a.factor,
                }
            }
            // The slopes of these polynomials are orthonormal.
            if row >= 2 {
                self.stiffness[(a.motion, a.motion)] += axial_stiffness / half;
            }
        }
        by_end
    }
}

impl DriveChain {
    /// Dynamic stiffness of each motion besides that of the undamped chain, at the complex ω [N/m], with its derivative
    /// by ω: no two motions share a mass or a loss. The undamped matrices move with ω_c² (`square`, with its derivative by
    /// ω), because the cable has damping of its own; wheel, drum and motor have ω². `losses` is the fraction of the
    /// damping that acts.
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
