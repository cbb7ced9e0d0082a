//! Motions, losses and signals of a drive as linear forms over the platform end and the amplitudes of the clamped modes.
//!
//! A second-order model has these as its coordinates. There the losses of a drive are a damping matrix, and a signal is a
//! row that is a polynomial of s = iω (docs/theory.md, equations (45a) to (45d)).

use super::{CatenaryDynamicEnd, DriveSignal, MovingEnd};
use crate::math::DMat;
use crate::robot::Damping;
use std::array::from_fn;

/// Linear form over the displacement (e, n, b) of the platform end and the amplitudes of the clamped modes, in plane and
/// then out of plane.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DriveForm {
    pub(crate) end: [f64; 3],
    pub(crate) modes: Vec<f64>,
}

impl DriveForm {
    fn zero(modes: usize) -> Self {
        Self { end: [0.0; 3], modes: vec![0.0; modes] }
    }

    /// Adds `factor` times another form.
    fn add(&mut self, factor: f64, other: &Self) {
        self.end.iter_mut().zip(other.end).for_each(|(sum, entry)| *sum += factor * entry);
        self.modes.iter_mut().zip(&other.modes).for_each(|(sum, entry)| *sum += factor * entry);
    }

    fn is_zero(&self) -> bool {
        self.end.iter().chain(&self.modes).all(|entry| *entry == 0.0)
    }
}

/// Part of a drive that has mass of its own or losses.
pub(crate) struct DrivePart {
    /// Motion.
    pub(crate) motion: DriveForm,
    /// Mass [kg]. The damping of the cable does not act on it.
    pub(crate) mass: f64,
    /// Viscous damping [N s/m].
    pub(crate) damping: f64,
    /// Static response of the motion to a force on it that the clamped modes do not have, relative to its static
    /// response: zero unless the part has no mass.
    pub(crate) massless: f64,
}

/// Relative size below which the difference of two static responses is rounding; the modes leave about 1e-10.
const ROUNDING: f64 = 1e-8;

/// Coefficients of 1, s and s² of a polynomial of s = iω.
pub(crate) type InPowersOfS<T> = [T; 3];

impl CatenaryDynamicEnd {
    /// Number of amplitudes: clamped modes in plane and, unless these are left out, out of plane.
    fn amplitudes(&self) -> usize {
        self.in_plane().poles.len() + self.out_of_plane().map_or(0, |family| family.poles.len())
    }

    /// Motion `motion` of the chain along the cable.
    fn motion_along(&self, motion: usize) -> Option<DriveForm> {
        let along = &self.cable.drive.as_ref()?.along;
        let mut form = DriveForm::zero(self.amplitudes());
        let [e, n, ..] = along.still[motion][0];
        form.end = [e, n, 0.0];
        for (amplitude, mode) in form.modes.iter_mut().zip(&along.modes) {
            *amplitude = mode[motion][0];
        }
        Some(form)
    }

    /// Motion of the swivelling pulley out of plane; `None` if there is none or motion out of plane is left out.
    fn motion_out_of_plane(&self) -> Option<DriveForm> {
        let motion = self.cable.drive.as_ref().filter(|drive| drive.flexibility_out_of_plane > 0.0)?;
        self.out_of_plane()?;
        let mut form = DriveForm::zero(self.amplitudes());
        form.end = [0.0, 0.0, motion.out_of_plane.still[0][0][0]];
        let modes = form.modes.iter_mut().skip(self.in_plane().poles.len());
        for (amplitude, mode) in modes.zip(&motion.out_of_plane.modes) {
            *amplitude = mode[0][0];
        }
        Some(form)
    }

    /// Static response of the motions along the cable to forces on them that the clamped modes do not have: that of
    /// motions without mass [m/N].
    fn massless_flexibility(&self) -> DMat {
        let Some(drive) = &self.cable.drive else { return DMat::zeros(0, 0) };
        let mut rest = drive.flexibility.clone();
        for (pole, mode) in self.in_plane().poles.iter().zip(&drive.along.modes) {
            for i in 0..rest.nrows() {
                for j in 0..rest.ncols() {
                    rest[(i, j)] -= mode[i][0] * mode[j][0] / pole;
                }
            }
        }

        // Rounding is no motion without mass.
        let size = drive.flexibility.diagonal().map(f64::sqrt);
        rest.map_with_location(|i, j, entry| if entry.abs() < ROUNDING * size[i] * size[j] { 0.0 } else { entry })
    }

    /// Parts of the drive that have mass of their own or losses; a delay of the control is left out.
    pub(crate) fn drive_parts(&self) -> Vec<DrivePart> {
        let mut parts = Vec::new();
        if let (Some(chain), Some(drive)) = (self.chain(), &self.cable.drive) {
            let damping = chain.viscous_damping();
            let rest = self.massless_flexibility();
            for j in (0..chain.len()).filter(|&j| chain.mass[(j, j)] > 0.0 || damping[j] > 0.0) {
                let Some(motion) = self.motion_along(j) else { continue };
                let massless = rest[(j, j)] / drive.flexibility[(j, j)];
                parts.push(DrivePart { motion, mass: chain.mass[(j, j)], damping: damping[j], massless });
            }
        }
        let swivel = self.cable.end.as_ref().map_or(0.0, MovingEnd::swivel_mass);
        if let Some(motion) = self.motion_out_of_plane().filter(|_| swivel > 0.0) {
            parts.push(DrivePart { motion, mass: swivel, damping: 0.0, massless: 0.0 });
        }
        parts
    }

    /// Rate c/m of a viscous damping of the cable [1/s]: `ω_c² = −s² − s c/m`. Zero for a constant ratio, whose loss a
    /// polynomial of s cannot have.
    fn viscous_rate(&self) -> f64 {
        match self.damping {
            Damping::Viscous(c) if self.mass_per_length > 0.0 => c / self.mass_per_length,
            Damping::Viscous(_) | Damping::Ratio(_) => 0.0,
        }
    }

    /// Force on the motions of the chain per unit of an input; for drum and motor also the row of their motion. `None`
    /// without such a signal.
    fn force_in_powers(&self, signal: DriveSignal) -> Option<InPowersOfS<Vec<f64>>> {
        let force = super::drive_signals::DriveForce::of(self.chain()?, signal)?;
        let rate = self.viscous_rate();
        let by_rate = force.rate.iter().zip(&force.square).map(|(by_rate, square)| by_rate - rate * square).collect();
        let by_acceleration = force.square.iter().map(|square| -square).collect();
        Some([force.still, by_rate, by_acceleration])
    }

    /// Row of a signal: generalised force on platform end and amplitudes per unit of an input, and the output per
    /// coordinate. `None` if the cable has no such signal.
    pub(crate) fn signal_form(&self, signal: DriveSignal) -> Option<InPowersOfS<DriveForm>> {
        let zero = || DriveForm::zero(self.amplitudes());
        if signal == DriveSignal::Tension {
            return Some(self.tension_form());
        }
        if self.chain().is_none() {
            return (signal == DriveSignal::Length).then(|| self.moved_end_form());
        }
        let motions: Vec<DriveForm> = (0..self.chain()?.len()).map_while(|j| self.motion_along(j)).collect();
        Some(self.force_in_powers(signal)?.map(|force| {
            let mut sum = zero();
            force.iter().zip(&motions).for_each(|(force, motion)| sum.add(*force, motion));
            sum
        }))
    }

    /// Tension at the platform: minus the force along the cable that holds its platform end.
    fn tension_form(&self) -> InPowersOfS<DriveForm> {
        let [h, v] = self.directions.from_platform;
        let family = self.in_plane();
        let pulled = |matrix: &[[f64; 4]; 4], j: usize| matrix[0][j] * h + matrix[1][j] * v;
        let mut forms = from_fn(|_| DriveForm::zero(self.amplitudes()));
        let [still, by_rate, by_acceleration] = &mut forms;

        // The cable: K_s, and −ω_c² times the rows of its mass.
        let mut by_square = DriveForm::zero(self.amplitudes());
        still.end = [-pulled(&family.stiffness, 0), -pulled(&family.stiffness, 1), 0.0];
        by_square.end = [pulled(&family.mass, 0), pulled(&family.mass, 1), 0.0];
        for (amplitude, g) in by_square.modes.iter_mut().zip(&family.participation) {
            *amplitude = g[0] * h + g[1] * v;
        }

        // Parts of the drive, which move with ω² instead and have losses.
        for part in self.drive_parts() {
            let along = part.motion.end[0] * h + part.motion.end[1] * v;
            by_square.add(-along * part.mass, &part.motion);
            by_acceleration.add(-along * part.mass, &part.motion);
            by_rate.add(-along * part.damping, &part.motion);
        }

        // ω_c² = −s² − s c/m.
        by_rate.add(-self.viscous_rate(), &by_square);
        by_acceleration.add(-1.0, &by_square);
        forms
    }

    /// Length that is paid out by a rigid drum at the far end, which thereby moves towards the platform.
    fn moved_end_form(&self) -> InPowersOfS<DriveForm> {
        let ([h, v], stretch, family) = (self.directions.to_platform, self.directions.stretch, self.in_plane());
        let moved = |matrix: &[[f64; 4]; 4], i: usize| stretch * (matrix[i][2] * h + matrix[i][3] * v);

        let mut still = DriveForm::zero(self.amplitudes());
        still.end = [-moved(&family.stiffness, 0), -moved(&family.stiffness, 1), 0.0];
        let mut by_square = DriveForm::zero(self.amplitudes());
        by_square.end = [moved(&family.mass, 0), moved(&family.mass, 1), 0.0];
        for (amplitude, g) in by_square.modes.iter_mut().zip(&family.participation) {
            *amplitude = stretch * (g[2] * h + g[3] * v);
        }

        let (mut by_rate, mut by_acceleration) =
            (DriveForm::zero(self.amplitudes()), DriveForm::zero(self.amplitudes()));
        by_rate.add(-self.viscous_rate(), &by_square);
        by_acceleration.add(-1.0, &by_square);
        [still, by_rate, by_acceleration]
    }

    /// Output per input of signals of this cable with all coordinates at rest. `None` without such signals.
    pub(crate) fn direct_signal(&self, input: DriveSignal, output: DriveSignal) -> Option<InPowersOfS<f64>> {
        if output == DriveSignal::Tension {
            // The force of the input on the platform end, along the cable.
            let [h, v] = self.directions.from_platform;
            return Some(self.signal_form(input)?.map(|form| form.end[0] * h + form.end[1] * v));
        }
        let rest = self.massless_flexibility();
        let [row, ..] = self.force_in_powers(output)?;
        Some(self.force_in_powers(input)?.map(|force| {
            let moved = |i: usize| (0..force.len()).map(|j| rest[(i, j)] * force[j]).sum::<f64>();
            row.iter().enumerate().map(|(i, row)| if *row == 0.0 { 0.0 } else { row * moved(i) }).sum()
        }))
    }

    /// Weights of the clamped modes in plane and out of plane in the forces of lossy parts and of signals: what modes
    /// that replace others have to represent beside the platform end.
    pub(super) fn forces_on_modes(&self, signals: &[DriveSignal]) -> [Vec<Vec<f64>>; 2] {
        let count = self.in_plane().poles.len();
        let parts = self.drive_parts().into_iter().map(|part| part.motion);
        let of_signals = signals.iter().filter_map(|signal| self.signal_form(*signal)).flatten();
        let mut families = [Vec::new(), Vec::new()];
        for form in parts.chain(of_signals.filter(|form| !form.is_zero())) {
            let (in_plane, out_of_plane) = form.modes.split_at(count);
            for (family, modes) in families.iter_mut().zip([in_plane, out_of_plane]) {
                if modes.iter().any(|entry| *entry != 0.0) {
                    family.push(modes.to_vec());
                }
            }
        }
        families
    }
}
