//! Motions, losses and signals of a drive as linear forms over the platform end and the amplitudes of the clamped
//! modes.
//!
//! A second-order model has these as its coordinates. There the losses of a drive are a damping matrix, and a signal is
//! a row that is a polynomial of s = iω (docs/theory.md, equations (45a) to (45d)).

use super::drive_signals::DriveForce;
use super::{CarrierMotion, CatenaryDynamicEnd, DriveSignal, Family, MovingEnd, StretchMotions};
use crate::drive::{ByTurn, ChainStretch};
use crate::math::DMat;
use crate::robot::{Damping, StretchLoss};
use std::array::from_fn;

/// Linear form over the displacement (e, n, b) of the platform end and the amplitudes of the clamped modes, in plane
/// and then out of plane.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DriveForm {
    pub(crate) end: [f64; 3],
    pub(crate) modes: Vec<f64>,
}

impl DriveForm {
    /// Adds `factor` times another form.
    fn add(&mut self, factor: f64, other: &Self) {
        self.end.iter_mut().zip(other.end).for_each(|(sum, entry)| *sum += factor * entry);
        self.modes.iter_mut().zip(&other.modes).for_each(|(sum, entry)| *sum += factor * entry);
    }
}

/// Signal at the far end of a cable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum EndSignal {
    /// Quantity of the drive.
    Drive(DriveSignal),
    /// Given motion of the carrier.
    Carrier(CarrierMotion),
}

/// Part of a drive that has mass of its own or losses, or a stretch with a loss.
pub(crate) struct DrivePart {
    /// Motion.
    pub(crate) motion: DriveForm,
    /// Motion with the carrier of the end (e, n, b), platform end and amplitudes at rest.
    pub(crate) with_carrier: [f64; 3],
    /// Motion with the ends of the drum side, at the drum and at the wheel, if the motions of the drive are at rest.
    pub(crate) with_drum_side: [f64; 2],
    /// Ratio of the stretch at the exit point to that at the drum.
    ratio: f64,
    /// Mass [kg]. The damping of the cable does not act on it.
    pub(crate) mass: f64,
    /// Viscous damping [N s/m].
    pub(crate) damping: f64,
    /// Imaginary part of the stiffness by a constant loss factor [N/m].
    pub(crate) loss: f64,
    /// Static response of the motion to a force on it that the clamped modes do not have, relative to its static
    /// response: zero unless the part has no mass.
    pub(crate) massless: f64,
}

impl DrivePart {
    /// Motion with a motion of the carrier.
    pub(crate) fn along(&self, carrier: &CarrierMotion) -> f64 {
        let [at_drum, at_wheel, _] = carrier.of_drum_side(self.ratio);
        let displaced: f64 = self.with_carrier.iter().zip(carrier.displacement).map(|(part, c)| part * c).sum();
        displaced + self.with_drum_side[0] * at_drum + self.with_drum_side[1] * at_wheel
    }
}

/// Relative size below which the difference of two static responses is rounding; the modes leave about 1e-10.
const ROUNDING: f64 = 1e-8;

/// Coefficients of 1, s and s² of a polynomial of s = iω.
pub(crate) type InPowersOfS<T> = [T; 3];

impl CatenaryDynamicEnd {
    /// Poles of the clamped modes: in plane and, unless these are left out, out of plane; or both together, for an end
    /// that couples them.
    fn mode_poles(&self) -> impl Iterator<Item = f64> + '_ {
        let out_of_plane = self.out_of_plane().map_or(&[][..], |family| &family.poles);
        let coupled = self.coupled().map_or(&[][..], |family| &family.poles);
        self.in_plane().poles.iter().chain(out_of_plane).chain(coupled).copied()
    }

    fn zero_form(&self) -> DriveForm {
        DriveForm { end: [0.0; 3], modes: vec![0.0; self.mode_poles().count()] }
    }

    /// Motions of the drive: those along the cable, then that sideways if there is one.
    fn motion_forms(&self) -> Vec<DriveForm> {
        let Some(drive) = &self.cable.drive else { return Vec::new() };
        let mut forms = vec![self.zero_form(); self.motions()];

        // Slow motion with the platform end.
        let along = drive.along.still.len();
        for (form, psi) in forms.iter_mut().zip(&drive.along.still) {
            form.end = [psi[0][0], psi[0][1], 0.0];
        }
        for (form, psi) in forms.iter_mut().skip(along).zip(&drive.sideways.still) {
            form.end = [0.0, 0.0, psi[0][0]];
        }
        for (form, psi) in forms.iter_mut().zip(&drive.coupled.still) {
            form.end = [psi[0][0], psi[0][1], psi[0][2]];
        }

        // Clamped modes.
        let indices = |family: Family, poles: usize| (0..poles).map(move |index| (family, index));
        let out_of_plane = self.out_of_plane().map_or(0, |family| family.poles.len());
        let modes = indices(Family::InPlane, self.in_plane().poles.len())
            .chain(indices(Family::OutOfPlane, out_of_plane))
            .chain(indices(Family::Coupled, self.coupled().map_or(0, |family| family.poles.len())));
        for (k, (family, index)) in modes.enumerate() {
            for (form, motion) in forms.iter_mut().zip(drive.in_mode(family, index)) {
                form.modes[k] = motion;
            }
        }
        forms
    }

    /// Static response of the motions to forces on them that the clamped modes do not have: that of motions without
    /// mass [m/N].
    fn massless_flexibility(&self, motions: &[DriveForm]) -> DMat {
        let Some(drive) = &self.cable.drive else { return DMat::zeros(0, 0) };
        let poles: Vec<f64> = self.mode_poles().collect();
        DMat::from_fn(motions.len(), motions.len(), |i, j| {
            let products = motions[i].modes.iter().zip(&motions[j].modes).zip(&poles);
            let left = drive.flexibility[(i, j)] - products.map(|((a, b), pole)| a * b / pole).sum::<f64>();

            // Rounding is no motion without mass.
            let size = (drive.flexibility[(i, i)] * drive.flexibility[(j, j)]).sqrt();
            if left.abs() < ROUNDING * size { 0.0 } else { left }
        })
    }

    /// Parts of the drive that have mass of their own or losses; a delay of the control is left out.
    pub(crate) fn drive_parts(&self) -> Vec<DrivePart> {
        let Some(drive) = &self.cable.drive else { return Vec::new() };
        let motions = self.motion_forms();
        let rest = self.massless_flexibility(&motions);

        // Mass, viscous damping and loss of each motion, and its motion with the ends of the drum side.
        let held = [0.0; 2];
        let of_chain = self.chain().map_or_else(Vec::new, |chain| {
            let damped = chain.viscous_damping().into_iter().enumerate();
            damped.map(|(j, damping)| (chain.mass[(j, j)], damping, 0.0, held)).collect()
        });
        let StretchLoss { factor, time } = self.stretch_loss;
        let StretchMotions { moments, stiffness } = &self.cable.stretch;
        let of_drum_side = self.chain().map_or(&[][..], |chain| &chain.stretches).iter().map(|of| of.by_ends);
        let ends = std::iter::repeat_n(held, *moments).chain(of_drum_side);
        let of_stretch = stiffness.iter().zip(ends).map(|(k, ends)| (0.0, time * k, factor * k, ends));
        let swivel = self.cable.end.as_ref().map_or(0.0, MovingEnd::swivel_mass);
        let all = of_chain.into_iter().chain(of_stretch).chain([(swivel, 0.0, 0.0, held)]);

        let (chain, along) = self.motions_along();
        let massless = |j: usize| {
            let spring = if (chain..along).contains(&j) { 1.0 / stiffness[j - chain] } else { 0.0 };
            let (left, size) = (rest[(j, j)], drive.flexibility[(j, j)]);
            if left.abs() <= ROUNDING * spring { 0.0 } else { left / size }
        };
        let ratio = self.drum_side_ratio();
        (motions.into_iter().zip(drive.with_carrier()).zip(all).enumerate())
            .filter(|(_, (_, (mass, damping, loss, _)))| *mass > 0.0 || *damping > 0.0 || *loss > 0.0)
            .map(|(j, ((motion, with_carrier), (mass, damping, loss, with_drum_side)))| DrivePart {
                motion,
                with_carrier,
                with_drum_side,
                ratio,
                mass,
                damping,
                loss,
                massless: massless(j),
            })
            .collect()
    }

    /// Rate c/m of a viscous damping of the cable [1/s]: `ω_c² = −s² − s c/m`. Zero for a constant ratio, whose loss a
    /// polynomial of s cannot have.
    fn viscous_rate(&self) -> f64 {
        match self.damping {
            Damping::Viscous(c) if self.mass_per_length > 0.0 => c / self.mass_per_length,
            Damping::Viscous(_) | Damping::Ratio(_) => 0.0,
        }
    }

    /// Coefficients of `constant + s rate + ω_c² square` in powers of s.
    fn in_powers(&self, constant: Vec<f64>, rate: &[f64], square: &[f64]) -> InPowersOfS<Vec<f64>> {
        let by_rate = rate.iter().zip(square).map(|(rate, square)| rate - self.viscous_rate() * square).collect();
        [constant, by_rate, square.iter().map(|square| -square).collect()]
    }

    /// Force on the motions of the chain per unit of an input, or row of an output over them. `None` without such a
    /// signal.
    fn row_in_powers(&self, signal: DriveSignal) -> Option<InPowersOfS<Vec<f64>>> {
        let chain = self.chain()?;
        if signal == DriveSignal::DrumTension {
            let end = chain.drum_end.as_ref()?;
            let (constant, square): (Vec<f64>, Vec<f64>) =
                end.by_motion.iter().map(|(k, mass)| (-k * end.ratio, mass * end.ratio)).unzip();
            let mut row = self.in_powers(constant, &vec![0.0; square.len()], &square);
            self.add_rate_of_drum_side(&mut row, end.ratio);
            return Some(row);
        }
        let DriveForce { constant, rate, square, .. } = DriveForce::of(chain, signal)?;
        let mut row = self.in_powers(constant, &rate, &square);
        if signal == DriveSignal::Length && chain.drum.is_none() {
            self.add_rate_of_drum_side(&mut row, self.directions.stretch);
        }
        Some(row)
    }

    /// Row of a signal: generalised force on platform end and amplitudes per unit of an input, and the output per
    /// coordinate. `None` if the cable has no such signal.
    pub(crate) fn signal_form(&self, signal: DriveSignal) -> Option<InPowersOfS<DriveForm>> {
        if signal == DriveSignal::Tension {
            return Some(self.tension_form());
        }
        if self.chain().is_none() {
            return match signal {
                DriveSignal::Length => self.held_end_form(self.directions.stretch),
                DriveSignal::DrumTension => self.held_end_form(1.0),
                DriveSignal::Drum | DriveSignal::Motor | DriveSignal::Tension => None,
            };
        }
        let motions = self.motion_forms();
        Some(self.row_in_powers(signal)?.map(|force| {
            let mut sum = self.zero_form();
            force.iter().zip(&motions).for_each(|(force, motion)| sum.add(*force, motion));
            sum
        }))
    }

    /// Form of `constant + s rate + s² acceleration + ω_c² square`, in powers of s.
    fn form_in_powers(
        &self,
        constant: DriveForm,
        mut rate: DriveForm,
        mut acceleration: DriveForm,
        square: &DriveForm,
    ) -> InPowersOfS<DriveForm> {
        rate.add(-self.viscous_rate(), square);
        acceleration.add(-1.0, square);
        [constant, rate, acceleration]
    }

    /// Tension at the platform: minus the force along the cable that holds its platform end.
    fn tension_form(&self) -> InPowersOfS<DriveForm> {
        let [h, v] = self.directions.from_platform;
        let (mut constant, mut rate, mut acceleration, mut square) =
            (self.zero_form(), self.zero_form(), self.zero_form(), self.zero_form());

        // The cable: K_s, and −ω_c² times the rows of its mass.
        let (stiffness, mass): ([f64; 3], [f64; 3]) = if let Some(family) = self.coupled() {
            let row = |matrix: &[[f64; 6]; 6]| from_fn(|j| matrix[0][j] * h + matrix[1][j] * v);
            (row(&family.stiffness), row(&family.mass))
        } else {
            let family = self.in_plane();
            let row =
                |matrix: &[[f64; 4]; 4]| from_fn(|j| if j < 2 { matrix[0][j] * h + matrix[1][j] * v } else { 0.0 });
            (row(&family.stiffness), row(&family.mass))
        };
        constant.end = stiffness.map(|entry| -entry);
        square.end = mass;
        let in_plane = self.in_plane().participation.iter().map(|g| g[0] * h + g[1] * v);
        let out_of_plane = self.out_of_plane().map_or(0, |family| family.poles.len());
        let coupled = self.coupled().into_iter().flat_map(|family| &family.participation);
        let participations =
            in_plane.chain(std::iter::repeat_n(0.0, out_of_plane)).chain(coupled.map(|g| g[0] * h + g[1] * v));
        square.modes.iter_mut().zip(participations).for_each(|(entry, g)| *entry = g);

        // Parts of the drive, which move with ω² instead and have losses.
        for part in self.drive_parts() {
            let along = part.motion.end[0] * h + part.motion.end[1] * v;
            square.add(-along * part.mass, &part.motion);
            acceleration.add(-along * part.mass, &part.motion);
            rate.add(-along * part.damping, &part.motion);
        }
        self.form_in_powers(constant, rate, acceleration, &square)
    }

    /// Tension at a far end that is held, and force on platform and amplitudes if it moves by `factor` towards the
    /// platform. `None` for an end that couples the families.
    fn held_end_form(&self, factor: f64) -> Option<InPowersOfS<DriveForm>> {
        if self.cable.coupled.is_some() {
            return None;
        }
        let ([h, v], family) = (self.directions.to_platform, self.in_plane());
        let moved = |matrix: &[[f64; 4]; 4], i: usize| factor * (matrix[i][2] * h + matrix[i][3] * v);
        let (mut constant, mut square) = (self.zero_form(), self.zero_form());
        constant.end = [-moved(&family.stiffness, 0), -moved(&family.stiffness, 1), 0.0];
        square.end = [moved(&family.mass, 0), moved(&family.mass, 1), 0.0];
        for (amplitude, g) in square.modes.iter_mut().zip(&family.participation) {
            *amplitude = factor * (g[2] * h + g[3] * v);
        }
        let mut rate = self.zero_form();
        for part in self.drive_parts() {
            rate.add(-part.along(&self.far_end_moved(factor)) * part.damping, &part.motion);
        }
        Some(self.form_in_powers(constant, rate, self.zero_form(), &square))
    }

    /// Motion of a far end without a drive by `factor` towards the platform.
    fn far_end_moved(&self, factor: f64) -> CarrierMotion {
        let displacement = self.far_end_along().map(|along| factor * along);
        CarrierMotion { displacement, by_turn: ByTurn::default(), along_drum_side: 0.0, with_drum: true }
    }

    /// Viscous damping between two motions of the carrier by losses of the stretch and of the drive, all coordinates at
    /// rest [N s/m].
    fn damping_between(&self, one: &CarrierMotion, other: &CarrierMotion) -> f64 {
        self.drive_parts().iter().map(|part| part.damping * part.along(one) * part.along(other)).sum()
    }

    /// Viscous force of the stretches of the drum side on its end at the drum, towards the wheel, per speed of its
    /// ends, at the drum and at the wheel [N s/m].
    fn rate_at_drum(&self, ends: [f64; 2]) -> f64 {
        if !self.has_strains() {
            return 0.0;
        }
        let chain = self.chain().map_or(&[][..], |chain| &chain.stretches);
        let of = |of: &ChainStretch| of.stiffness * of.by(ends) * -of.by_ends[0];
        self.stretch_loss.time * chain.iter().map(of).sum::<f64>()
    }

    /// Viscous damping of each stretch of the drum side by its end at the drum, which moves by `moved` towards the
    /// wheel, in a row over the motions of the chain and the stretches [N s/m].
    fn add_rate_of_drum_side(&self, row: &mut InPowersOfS<Vec<f64>>, moved: f64) {
        let (_, along) = self.motions_along();
        let chain = self.chain().map_or(&[][..], |chain| &chain.stretches);
        let first = along - if self.cable.stretch.moments > 0 { chain.len() } else { 0 };
        for of_power in &mut *row {
            of_power.resize(along, 0.0);
        }
        for (rate, of) in row[1][first..].iter_mut().zip(chain) {
            *rate -= self.stretch_loss.time * of.stiffness * of.by([moved, 0.0]);
        }
    }

    /// Row of a motion of the carrier: generalised force on platform end and amplitudes per unit of it.
    ///
    /// # References
    /// docs/theory.md, equation (45e).
    pub(crate) fn carrier_form(&self, motion: &CarrierMotion) -> InPowersOfS<DriveForm> {
        let (mut constant, mut rate, mut acceleration, mut square) =
            (self.zero_form(), self.zero_form(), self.zero_form(), self.zero_form());
        let [e, n, b] = motion.displacement;

        // The cable: K_s and −ω_c² times its mass between both ends, and the participations of the far end.
        let participations: Vec<f64> = if let Some(family) = self.coupled() {
            let by = |row: &[f64; 6]| row[3] * e + row[4] * n + row[5] * b;
            constant.end = from_fn(|i| -by(&family.stiffness[i]));
            square.end = from_fn(|i| by(&family.mass[i]));
            family.participation.iter().map(by).collect()
        } else {
            let family = self.in_plane();
            let by = |row: &[f64; 4]| row[2] * e + row[3] * n;
            for i in 0..2 {
                (constant.end[i], square.end[i]) = (-by(&family.stiffness[i]), by(&family.mass[i]));
            }
            let mut all: Vec<f64> = family.participation.iter().map(by).collect();
            if let Some(family) = self.out_of_plane() {
                (constant.end[2], square.end[2]) = (-family.stiffness[0][1] * b, family.mass[0][1] * b);
                all.extend(family.participation.iter().map(|g| g[1] * b));
            }
            all
        };
        square.modes = participations;

        // Forces on the drive, then those of its masses and losses, which move with the carrier.
        for (form, (force, mass)) in self.motion_forms().iter().zip(self.forces_by_carrier(motion)) {
            constant.add(force, form);
            square.add(mass, form);
        }
        for part in self.drive_parts() {
            let along = part.along(motion);
            square.add(-along * part.mass, &part.motion);
            acceleration.add(-along * part.mass, &part.motion);
            rate.add(-along * part.damping, &part.motion);
        }
        self.form_in_powers(constant, rate, acceleration, &square)
    }

    /// Force on the carrier along one motion per unit of another motion of it, with all coordinates at rest: by
    /// reciprocity symmetric.
    ///
    /// # References
    /// docs/theory.md, equation (92c).
    pub(crate) fn between_carriers(&self, one: &CarrierMotion, other: &CarrierMotion) -> InPowersOfS<f64> {
        let (c1, c2) = (one.displacement, other.displacement);

        // The cable: K_s and −ω_c² times its mass at the far end.
        let (stiffness, mass) = if let Some(family) = self.coupled() {
            (far_product(&family.stiffness, [3, 4, 5], c1, c2), far_product(&family.mass, [3, 4, 5], c1, c2))
        } else {
            let (plane, normal) = (self.in_plane(), self.out_of_plane());
            let [in_plane, in_plane_mass] = [&plane.stiffness, &plane.mass]
                .map(|matrix| far_product(matrix, [2, 3], [c1[0], c1[1]], [c2[0], c2[1]]));
            let (normal, normal_mass) = normal.map_or((0.0, 0.0), |family| {
                (c1[2] * family.stiffness[1][1] * c2[2], c1[2] * family.mass[1][1] * c2[2])
            });
            (in_plane + normal, in_plane_mass + normal_mass)
        };
        let (mut constant, mut rate, mut acceleration, mut square) = (-stiffness, 0.0, 0.0, mass);

        // Motions of the drive with the carrier, forces on them, and those without mass by these forces.
        if let Some(drive) = &self.cable.drive {
            let moved = |c: [f64; 3]| -> Vec<f64> {
                drive.with_carrier().iter().map(|row| row.iter().zip(c).map(|(part, c)| part * c).sum()).collect()
            };
            let (z1, z2) = (moved(c1), moved(c2));
            let (f1, f2) = (self.forces_by_carrier(one), self.forces_by_carrier(other));
            for (z, f) in [(&z1, &f2), (&z2, &f1)] {
                constant += z.iter().zip(f).map(|(z, (force, _))| z * force).sum::<f64>();
                square += z.iter().zip(f).map(|(z, (_, mass))| z * mass).sum::<f64>();
            }
            let rest = self.massless_flexibility(&self.motion_forms());
            for (i, (force, _)) in f1.iter().enumerate() {
                constant += force * f2.iter().enumerate().map(|(j, (other, _))| rest[(i, j)] * other).sum::<f64>();
            }
            for part in self.drive_parts() {
                let product = part.along(one) * part.along(other);
                square -= product * part.mass;
                acceleration -= product * part.mass;
                rate -= product * part.damping;
            }
        }

        // The drum side.
        if let Some(chain) = self.chain() {
            let [[_, at_wheel, whole], [_, other_at_wheel, other_whole]] =
                [one, other].map(|motion| motion.of_drum_side(self.drum_side_ratio()));
            if let Some(side) = chain.drum_side.first() {
                constant -= side.stiffness * at_wheel * other_at_wheel;
                square += side.mass * at_wheel * other_at_wheel
                    + side.carried_mass * (at_wheel * other_whole + whole * other_at_wheel);
            }
            square += chain.drum_side_mass * whole * other_whole;
        }
        [constant, rate - self.viscous_rate() * square, acceleration - square]
    }

    /// Output of the cable's drive, or its tension, per motion of the carrier with all coordinates at rest; for a
    /// commanded length, by reciprocity the force on the carrier. `None` without such a signal.
    pub(crate) fn direct_by_carrier(&self, motion: &CarrierMotion, output: DriveSignal) -> Option<InPowersOfS<f64>> {
        if output == DriveSignal::Tension {
            // The force of the motion on the platform end, along the cable.
            let [h, v] = self.directions.from_platform;
            return Some(self.carrier_form(motion).map(|form| form.end[0] * h + form.end[1] * v));
        }
        let in_powers = |constant: f64, square: f64| [constant, -self.viscous_rate() * square, -square];
        let Some(chain) = self.chain() else {
            // The far end itself moves.
            let factor = match output {
                DriveSignal::DrumTension => 1.0,
                DriveSignal::Length => self.directions.stretch,
                DriveSignal::Drum | DriveSignal::Motor | DriveSignal::Tension => return None,
            };
            if self.cable.coupled.is_some() {
                return None;
            }
            let ([h, v], family, [e, n, _]) = (self.directions.to_platform, self.in_plane(), motion.displacement);
            let along = |matrix: &[[f64; 4]; 4]| {
                (matrix[2][2] * e + matrix[2][3] * n) * h + (matrix[3][2] * e + matrix[3][3] * n) * v
            };
            let mut direct = in_powers(-along(&family.stiffness) * factor, along(&family.mass) * factor);
            direct[1] -= self.damping_between(motion, &self.far_end_moved(factor));
            return Some(direct);
        };

        // Motions of the drive with the carrier, and those without mass by the forces that the carrier brings about.
        let rest = self.massless_flexibility(&self.motion_forms());
        let rows = self.row_in_powers(output)?;
        let with_carrier = self.cable.drive.as_ref()?.with_carrier();
        let (constant, square): (Vec<f64>, Vec<f64>) = self.forces_by_carrier(motion).into_iter().unzip();
        let mut motions = self.in_powers(constant, &vec![0.0; square.len()], &square).map(|forces| {
            let moved = |i: usize| forces.iter().enumerate().map(|(j, force)| rest[(i, j)] * force).sum::<f64>();
            (0..forces.len()).map(moved).collect::<Vec<f64>>()
        });
        for (sum, row) in motions[0].iter_mut().zip(with_carrier) {
            *sum += row.iter().zip(motion.displacement).map(|(part, c)| part * c).sum::<f64>();
        }
        let product = |row: &[f64], motion: &[f64]| row.iter().zip(motion).map(|(row, z)| row * z).sum::<f64>();
        let mut direct: InPowersOfS<f64> =
            from_fn(|power| (0..=power).map(|i| product(&rows[i], &motions[power - i])).sum());

        // The ends of the drum side; a length that a drum pays out which is held moves one of them.
        let factor = |ratio: f64| match output {
            DriveSignal::DrumTension => ratio,
            DriveSignal::Length if chain.drum.is_none() => self.directions.stretch,
            _ => 0.0,
        };
        if let Some((end, factor)) =
            chain.drum_end.as_ref().map(|end| (end, factor(end.ratio))).filter(|(_, f)| *f > 0.0)
        {
            let [_, at_wheel, whole] = motion.of_drum_side(self.drum_side_ratio());
            let mass = end.by_wheel.1 * at_wheel + end.carried_mass * whole;
            let mut own = in_powers(-end.by_wheel.0 * at_wheel * factor, mass * factor);
            own[1] += self.rate_at_drum([0.0, at_wheel]) * factor;
            direct.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
        }
        Some(direct)
    }

    /// Output per input of signals of this cable with all coordinates at rest. `None` without such signals.
    pub(crate) fn direct_signal(&self, input: DriveSignal, output: DriveSignal) -> Option<InPowersOfS<f64>> {
        if output == DriveSignal::Tension {
            // The force of the input on the platform end, along the cable.
            let [h, v] = self.directions.from_platform;
            return Some(self.signal_form(input)?.map(|form| form.end[0] * h + form.end[1] * v));
        }
        // A length that is paid out by a drum that is held moves an end whose own tension is the output.
        let pays_out = (input, output) == (DriveSignal::Length, DriveSignal::DrumTension);
        let in_powers = |constant: f64, square: f64| [constant, -self.viscous_rate() * square, -square];
        let Some(chain) = self.chain() else {
            let ([h, v], family) = (self.directions.to_platform, self.in_plane());
            let own = |matrix: &[[f64; 4]; 4]| {
                (matrix[2][2] * h + matrix[2][3] * v) * h + (matrix[3][2] * h + matrix[3][3] * v) * v
            };
            let stretch = self.directions.stretch;
            return pays_out.then(|| {
                let mut direct = in_powers(-stretch * own(&family.stiffness), stretch * own(&family.mass));
                direct[1] -= self.damping_between(&self.far_end_moved(1.0), &self.far_end_moved(stretch));
                direct
            });
        };

        // Motions without mass follow at once. A product with ω_c² on both sides belongs to rods, which have mass.
        let rest = self.massless_flexibility(&self.motion_forms());
        let (rows, forces) = (self.row_in_powers(output)?, self.row_in_powers(input)?);
        let product = |row: &[f64], force: &[f64]| -> f64 {
            let moved = |i: usize| force.iter().enumerate().map(|(j, force)| rest[(i, j)] * force).sum::<f64>();
            row.iter().enumerate().map(|(i, row)| if *row == 0.0 { 0.0 } else { row * moved(i) }).sum()
        };
        let mut direct: InPowersOfS<f64> =
            from_fn(|power| (0..=power).map(|i| product(&rows[i], &forces[power - i])).sum());
        if let Some(end) = chain.drum_end.as_ref().filter(|_| pays_out && chain.drum.is_none()) {
            let by_length = self.directions.stretch * end.ratio;
            let mut own = in_powers(-end.own.0 * by_length, end.own.1 * by_length);
            own[1] += self.rate_at_drum([by_length, 0.0]);
            direct.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
        }
        Some(direct)
    }

    /// Weights of the clamped modes of each family in the forces of lossy parts and of signals. Modes that replace
    /// others have to represent these forces beside those on the platform end.
    pub(super) fn forces_on_modes(&self, signals: &[EndSignal]) -> [Vec<Vec<f64>>; 3] {
        let in_plane = self.in_plane().poles.len();
        let coupled = self.mode_poles().count() - self.coupled().map_or(0, |family| family.poles.len());
        let parts = self.drive_parts().into_iter().map(|part| part.motion);
        let of_signal = |signal: &EndSignal| match signal {
            EndSignal::Drive(signal) => self.signal_form(*signal),
            EndSignal::Carrier(motion) => Some(self.carrier_form(motion)),
        };
        let of_signals = signals.iter().filter_map(of_signal).flatten();

        let mut families = [Vec::new(), Vec::new(), Vec::new()];
        for form in parts.chain(of_signals) {
            let ranges = [&form.modes[..in_plane], &form.modes[in_plane..coupled], &form.modes[coupled..]];
            for (family, modes) in families.iter_mut().zip(ranges) {
                if modes.iter().any(|entry| *entry != 0.0) {
                    family.push(modes.to_vec());
                }
            }
        }
        families
    }
}

/// Product `c₁ᵀ M c₂` over the components `places` of a matrix.
fn far_product<const N: usize, const D: usize>(
    matrix: &[[f64; N]; N],
    places: [usize; D],
    c1: [f64; D],
    c2: [f64; D],
) -> f64 {
    let row = |i: usize| places.iter().zip(c2).map(|(j, c)| matrix[i][*j] * c).sum::<f64>();
    places.iter().zip(c1).map(|(i, c)| c * row(*i)).sum()
}
