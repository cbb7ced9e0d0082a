//! Signals of the drive of a cable: commanded length, force of the motor, motions of drum and motor, tension.

use super::{CatenaryDynamicEnd, DriveAt, DriveLosses, NearRanges};
use crate::cable::LocalAxes;
use crate::catenary::space::HangingCable;
use crate::drive::{ChainStretch, DriveChain};
use crate::math::Complex;

/// Quantity of a cable's drive in a response.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DriveSignal {
    /// Commanded unstrained length, paid out [m]; an input.
    Length,
    /// Force on the drum at the cable [N] as an input, motion of the cable at the drum [m] as an output; both towards
    /// the wheel.
    Drum,
    /// Force of the motor at the cable [N] as an input, motion of the motor at the cable [m] as an output; both pay
    /// out.
    Motor,
    /// Tension of the cable at the platform [N]; an output.
    Tension,
    /// Tension of the cable at the drum, or without a winch at the anchor [N]; an output.
    DrumTension,
}

impl DriveSignal {
    /// All quantities.
    pub const ALL: [Self; 5] = [Self::Length, Self::Drum, Self::Motor, Self::Tension, Self::DrumTension];

    /// Name before the name of the cable, as in `length:3`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Length => "length",
            Self::Drum => "drum",
            Self::Motor => "motor",
            Self::Tension => "tension",
            Self::DrumTension => "drum-tension",
        }
    }

    /// True if it can be an input.
    pub fn is_input(self) -> bool {
        !self.is_tension()
    }

    /// True for a tension.
    pub fn is_tension(self) -> bool {
        matches!(self, Self::Tension | Self::DrumTension)
    }

    /// True if it can be an output.
    pub fn is_output(self) -> bool {
        self != Self::Length
    }
}

/// Direction of a cable in its plane and its stretch, at both ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct EndDirections {
    /// Direction from the platform into the cable: components (e, n).
    pub(crate) from_platform: [f64; 2],
    /// Direction at the far end towards the platform.
    pub(crate) to_platform: [f64; 2],
    /// Stretch at the far end.
    pub(crate) stretch: f64,
}

impl EndDirections {
    /// Directions of a hanging cable in its own axes.
    pub(crate) fn of(hanging: &HangingCable) -> Self {
        let catenary = &hanging.catenary;
        let (h, at_start, at_end) =
            (catenary.horizontal_force(), catenary.vertical_force_at_start(), catenary.vertical_force_at_end());
        let (first, last) = (catenary.tension_at_start(), catenary.tension_at_end());
        Self {
            from_platform: [h / first, at_start / first],
            to_platform: [-h / last, -at_end / last],
            stretch: 1.0 + last / catenary.rope().axial_stiffness,
        }
    }

    /// Directions of a straight cable without stretch, in the axes of its chord.
    pub(crate) fn along_chord() -> Self {
        Self { from_platform: [1.0, 0.0], to_platform: [-1.0, 0.0], stretch: 1.0 }
    }

    /// Directions of a hanging cable in other axes of its plane.
    pub(crate) fn in_axes(hanging: &HangingCable, axes: &LocalAxes) -> Self {
        let own = Self::of(hanging);
        let (level_w, up_w) = hanging.axes_w();
        let turned = |[h, v]: [f64; 2]| [axes.e, axes.n].map(|axis| axis.dot(&(level_w * h + up_w * v)));
        Self { from_platform: turned(own.from_platform), to_platform: turned(own.to_platform), stretch: own.stretch }
    }
}

impl CatenaryDynamicEnd {
    /// Vector of a signal at ω [rad/s] in (e, n, b): the force on the held platform end per unit of an input, and by
    /// reciprocity the output per motion of the platform end. `None` if the cable has no such signal.
    pub(crate) fn signal_vector(&self, signal: DriveSignal, omega: Complex) -> Option<[Complex; 3]> {
        if signal == DriveSignal::Tension {
            let k = self.damped_at(omega);
            let [h, v] = self.directions.from_platform;
            let [along, normal] = k.across;
            return Some([
                -(k.axial * h + k.coupling * v),
                -(k.coupling * h + k.normal * v),
                -(along * h + normal * v),
            ]);
        }
        let Some(chain) = self.chain() else {
            return match signal {
                // The drum is rigid and holds the far end: the cable that is paid out moves it towards the platform.
                DriveSignal::Length => self.at_held_end(omega).map(|row| row.map(|k| self.directions.stretch * k)),
                DriveSignal::DrumTension => self.at_held_end(omega),
                DriveSignal::Drum | DriveSignal::Motor | DriveSignal::Tension => None,
            };
        };

        // By reciprocity the row of an output is also the force of an input.
        let row = match signal {
            DriveSignal::DrumTension => self.drum_tension_row(chain, omega)?,
            _ => self.forces_of(chain, signal, omega)?,
        };
        let (motions, losses) = self.motions_with_losses(omega)?;
        let moved = motions.moved(&losses.values());
        Some(std::array::from_fn(|s| row.iter().zip(&moved).map(|(row, moved)| moved[s] * row).sum()))
    }

    /// Tension at a far end that is held per motion (e, n, b) of the platform end, or the force on that one per motion
    /// of the far end towards the platform [N/m]. `None` for an end that couples the families.
    fn at_held_end(&self, omega: Complex) -> Option<[Complex; 3]> {
        let (square, [h, v], family) = (self.square(omega), self.directions.to_platform, &self.cable.in_plane);
        let towards = |i: usize| -(family.entry(i, 2, square) * h + family.entry(i, 3, square) * v);
        let mut row = [towards(0), towards(1), Complex::new(0.0, 0.0)];
        if let Some((motions, lost)) = self.lost_by_far_end(self.far_end_along(), omega) {
            for (s, entry) in row.iter_mut().enumerate() {
                *entry -= lost.iter().zip(&motions.transfer).map(|(lost, row)| row[s] * lost).sum::<Complex>();
            }
        }
        self.cable.coupled.is_none().then_some(row)
    }

    /// Displacement of the far end along itself towards the platform, (e, n, b).
    pub(super) fn far_end_along(&self) -> [f64; 3] {
        let [h, v] = self.directions.to_platform;
        [h, v, 0.0]
    }

    /// Motions of the drive at ω [rad/s], and the forces on them by their losses for a displacement of the far end, the
    /// platform end held. `None` without losses.
    fn lost_by_far_end(&self, displacement: [f64; 3], omega: Complex) -> Option<(DriveAt, Vec<Complex>)> {
        if !self.has_drive_losses() {
            return None;
        }
        let (motions, losses) = self.motions_with_losses(omega)?;
        let free = self.free_by_far_end(displacement, omega)?;
        let lost = motions.forces_by(&losses, &free);
        Some((motions, lost))
    }

    /// Motions of the drive without its losses for a displacement of the far end, the platform end held.
    pub(super) fn free_by_far_end(&self, displacement: [f64; 3], omega: Complex) -> Option<Vec<Complex>> {
        let drive = self.cable.drive.as_ref()?;
        let rows = DriveAt::by_carrier(&self.cable, drive, self.motions(), self.square(omega));
        Some(rows.iter().map(|row| row.iter().zip(displacement).map(|(t, c)| t * c).sum()).collect())
    }

    /// Force along a far end without a drive, towards the platform, by the losses of the cable, if the far end has this
    /// displacement, at ω [rad/s].
    pub(super) fn lost_at_far_end(&self, displacement: [f64; 3], omega: Complex) -> Complex {
        let found = self.lost_by_far_end(displacement, omega).zip(self.free_by_far_end(self.far_end_along(), omega));
        found.map_or(0.0.into(), |((_, lost), along)| lost.iter().zip(along).map(|(lost, z)| lost * z).sum())
    }

    /// Tension at the drum per motion of the drive [N/m]; `None` without a drum side.
    fn drum_tension_row(&self, chain: &DriveChain, omega: Complex) -> Option<Vec<Complex>> {
        let (end, square) = (chain.drum_end.as_ref()?, self.square(omega));
        let mut row: Vec<Complex> = end.by_motion.iter().map(|(k, mass)| (square * *mass - k) * end.ratio).collect();
        self.add_on_drum_side(&mut row, [-end.ratio, 0.0], omega);
        Some(row)
    }

    /// Adds the forces of the loss of the drum side to forces on the motions of the drive: those that act while
    /// these motions are at rest, and the ends of the drum side, at the drum and at the wheel, move against them.
    pub(super) fn add_on_drum_side(&self, forces: &mut Vec<Complex>, against: [f64; 2], omega: Complex) {
        let (loss, (chain, along)) = (self.stretch_loss.at(omega).0, self.motions_along());
        let first = chain + self.cable.stretch.moments;
        if first == along || !self.stretch_loss.is_some() {
            return;
        }
        forces.resize(along.max(forces.len()), Complex::new(0.0, 0.0));
        for (force, of) in forces[first..along].iter_mut().zip(self.chain().map_or(&[][..], |chain| &chain.stretches)) {
            *force += loss * (of.stiffness * of.by(against));
        }
    }

    /// Row of an output over the motions of the drive.
    pub(super) fn output_row(&self, chain: &DriveChain, output: DriveSignal, omega: Complex) -> Option<Vec<Complex>> {
        match output {
            DriveSignal::DrumTension => self.drum_tension_row(chain, omega),
            _ => self.forces_of(chain, output, omega),
        }
    }

    /// Tension at the drum when the ends of the drum side move, the motions of the drive held: its end at the drum and
    /// that at the wheel, both towards the platform, and the whole drum side along itself. Zero without a drum side.
    pub(super) fn drum_tension_of_ends(&self, [at_drum, at_wheel, whole]: [f64; 3], omega: Complex) -> Complex {
        let Some(end) = self.chain().and_then(|chain| chain.drum_end.as_ref()) else { return Complex::new(0.0, 0.0) };
        let square = self.square(omega);
        let force = |(k, mass): (f64, f64), motion: f64| (square * mass - k) * motion;
        let carried = square * end.carried_mass * whole;
        (force(end.own, at_drum)
            + force(end.by_wheel, at_wheel)
            + carried
            + self.lost_on_drum(at_drum, at_wheel, omega))
            * end.ratio
    }

    /// Force of the loss of the drum side at its end at the drum, when its ends move.
    fn lost_on_drum(&self, at_drum: f64, at_wheel: f64, omega: Complex) -> Complex {
        if !self.has_strains() || !self.stretch_loss.is_some() {
            return 0.0.into();
        }
        let stretches = self.chain().map_or(&[][..], |chain| &chain.stretches);
        let of = |of: &ChainStretch| of.stiffness * of.by([at_drum, at_wheel]) * -of.by_ends[0];
        self.stretch_loss.at(omega).0 * stretches.iter().map(of).sum::<f64>()
    }

    /// Output per input of signals of this cable, its platform end held, at ω [rad/s]. `None` if the cable has no such
    /// signals.
    pub(crate) fn signal_response(&self, input: DriveSignal, output: DriveSignal, omega: Complex) -> Option<Complex> {
        if output == DriveSignal::Tension {
            return Some(self.tension_of(&self.signal_vector(input, omega)?));
        }
        let Some(chain) = self.chain() else {
            // The far end moves along itself.
            let ([h, v], square) = (self.directions.to_platform, self.square(omega));
            let of = |i: usize, j: usize| self.cable.in_plane.entry(i, j, square);
            let own = (of(2, 2) * h + of(2, 3) * v) * h
                + (of(3, 2) * h + of(3, 3) * v) * v
                + self.lost_at_far_end(self.far_end_along(), omega);
            let known =
                self.cable.coupled.is_none() && (input, output) == (DriveSignal::Length, DriveSignal::DrumTension);
            return known.then(|| own * -self.directions.stretch);
        };
        let (force, row) = (self.forces_of(chain, input, omega)?, self.output_row(chain, output, omega)?);
        let (motions, losses) = self.motions_with_losses(omega)?;
        let count = losses.0.len();
        let free: Vec<Complex> = (0..count)
            .map(|i| force.iter().enumerate().map(|(j, force)| motions.receptance[(i, j)] * force).sum())
            .collect();
        let held = motions.freed(&losses.values(), &free);
        let through: Complex = row.iter().zip(&held).map(|(row, moved)| row * moved).sum();

        // A length that a drum pays out which is held moves the end of the drum side.
        let direct = (input, output) == (DriveSignal::Length, DriveSignal::DrumTension) && chain.drum.is_none();
        let paid_out = if direct { self.directions.stretch } else { 0.0 };
        Some(through + self.drum_tension_of_ends([paid_out, 0.0, 0.0], omega))
    }

    /// Force on the commanded length per length, the platform end held, at ω [rad/s]; `None` for a motor that turns,
    /// whose command is no length.
    pub(crate) fn own_stiffness_of_length(&self, omega: Complex) -> Option<Complex> {
        if self.chain().is_some_and(|chain| chain.drum.is_some() || chain.motor.is_some()) {
            return None;
        }
        let tension = self.signal_response(DriveSignal::Length, DriveSignal::DrumTension, omega)?;
        Some(tension * -self.directions.stretch)
    }

    /// Tension at the platform for a force on the held platform end in (e, n, b).
    pub(super) fn tension_of(&self, [x, y, _]: &[Complex; 3]) -> Complex {
        let [h, v] = self.directions.from_platform;
        x * h + y * v
    }

    /// Forces on the motions of the drive per unit of an input, and by reciprocity the row of drum and motor; `None`
    /// for tensions, and for a cable without such a signal.
    pub(crate) fn signal_forces(&self, signal: DriveSignal, omega: Complex) -> Option<Vec<Complex>> {
        let mut forces = self.forces_of(self.chain()?, signal, omega)?;
        forces.resize(self.motions(), Complex::new(0.0, 0.0));
        Some(forces)
    }

    pub(super) fn motions_with_losses(&self, omega: Complex) -> Option<(DriveAt, DriveLosses)> {
        let motions = self.drive_at(self.square(omega), &NearRanges::default())?;
        Some((motions, self.beyond_undamped(omega, 1.0)))
    }

    /// Forces on the motions of the drive per unit of an input [N/m or 1]; for drum and motor also the row of their
    /// motion.
    pub(super) fn forces_of(&self, chain: &DriveChain, signal: DriveSignal, omega: Complex) -> Option<Vec<Complex>> {
        let mut forces = DriveForce::of(chain, signal)?.at(omega, self.square(omega));
        if signal == DriveSignal::Length && chain.drum.is_none() {
            self.add_on_drum_side(&mut forces, [-self.directions.stretch, 0.0], omega);
        }
        Some(forces)
    }
}

/// Force on the motions of a drive per unit of an input, or the row of the motion of drum or motor:
/// `(constant + iω rate) e^{−iωτ} + ω_c² square`.
pub(super) struct DriveForce {
    /// Constant part [N/m or 1].
    pub(super) constant: Vec<f64>,
    /// Force per rate of the input, by the speed gain of a control [N s/m].
    pub(super) rate: Vec<f64>,
    /// Force by the mass of a cable whose end is moved [kg].
    pub(super) square: Vec<f64>,
    /// Delay τ of the control [s].
    delay: f64,
}

impl DriveForce {
    /// Force of a signal on a chain; `None` without such a signal.
    pub(super) fn of(chain: &DriveChain, signal: DriveSignal) -> Option<Self> {
        let zeros = || vec![0.0; chain.len()];
        let mut force = Self { constant: zeros(), rate: zeros(), square: zeros(), delay: 0.0 };
        match (signal, &chain.motor) {
            (DriveSignal::Drum, _) => {
                let drum = chain.drum?;
                force.constant[drum.motion] = drum.factor;
            }
            (DriveSignal::Motor, motor) => {
                let place = (*motor)?.place;
                force.constant[place.motion] = place.factor;
            }
            (DriveSignal::Length, Some(motor)) => {
                let (servo, place) = (motor.servo?, motor.place);
                force.constant[place.motion] = servo.position_gain * chain.stretch_drum * place.factor;
                force.rate[place.motion] = servo.speed_gain * chain.stretch_drum * place.factor;
                force.delay = servo.delay;
            }
            (DriveSignal::Length, None) => {
                (force.constant, force.square) = chain.by_length.iter().copied().unzip();
            }
            (DriveSignal::Tension | DriveSignal::DrumTension, _) => return None,
        }

        Some(force)
    }

    /// Force at ω [rad/s] with `square` = ω_c².
    fn at(&self, omega: Complex, square: Complex) -> Vec<Complex> {
        let (rate_of, delayed) = (Complex::i() * omega, (-Complex::i() * omega * self.delay).exp());
        let parts = self.constant.iter().zip(&self.rate).zip(&self.square);
        parts.map(|((constant, rate), moved)| (rate_of * *rate + *constant) * delayed + square * *moved).collect()
    }
}
