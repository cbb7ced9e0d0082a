//! Forces of a cable on its platform end when the carrier of its other end moves: the anchor, with pulley and winch or
//! without the winch (docs/theory.md, equations (83) to (85)).

use super::{
    CatenaryDynamic, CatenaryDynamicEnd, DriveAt, DriveLosses, DriveSignal, Family, InternalMotion, NearRanges,
};
use crate::drive::{ByTurn, DriveChain};
use crate::math::Complex;

/// Given motion of the carrier of a cable's end, harmonic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CarrierMotion {
    /// Displacement of the exit point with the carrier in the axes (e, n, b) of the cable.
    pub(crate) displacement: [f64; 3],
    /// Forces by a rotation of the carrier, with which the wheel turns.
    pub(crate) by_turn: ByTurn,
    /// Displacement of the entry point along the drum side, towards the platform.
    pub(crate) along_drum_side: f64,
    /// True if the drum moves with the carrier, false if it stays where it is.
    pub(crate) with_drum: bool,
}

impl CarrierMotion {
    /// Motions of the ends of the drum side with the carrier, the motions of the drive held: its end at the drum, that
    /// at the wheel, and the whole drum side along itself.
    ///
    /// The elongation of the drum side is measured with the stretch at the exit point, `ratio` times that at the entry
    /// point.
    pub(crate) fn of_drum_side(&self, ratio: f64) -> [f64; 3] {
        let (at_wheel, whole) =
            if self.with_drum { (0.0, self.along_drum_side) } else { (ratio * self.along_drum_side, 0.0) };
        [0.0, at_wheel + self.by_turn.stretched, whole]
    }
}

impl CatenaryDynamicEnd {
    /// Amplitudes of clamped modes for a motion of the carrier of the far end at ω [rad/s], the platform end held.
    pub(crate) fn amplitudes_by_carrier(
        &self,
        motion: &CarrierMotion,
        omega: Complex,
        modes: &[(Family, usize)],
    ) -> Vec<Complex> {
        self.motion_by_carrier(&self.cable, motion, omega).of_modes(modes)
    }

    /// Forces on the motions of the drive that a motion of the carrier brings about, those of the chain and then that
    /// sideways if there is one: constant part [N], and part per ω_c² [kg m].
    ///
    /// # References
    /// docs/theory.md, equation (85).
    pub(crate) fn forces_by_carrier(&self, motion: &CarrierMotion) -> Vec<(f64, f64)> {
        let [_, at_wheel, whole] = motion.of_drum_side(self.drum_side_ratio());
        let mut forces: Vec<(f64, f64)> = (self.chain().map_or(&[][..], |chain| &chain.drum_side).iter())
            .map(|side| (-side.stiffness * at_wheel, side.mass * at_wheel + side.carried_mass * whole))
            .collect();

        // A chain without a drum side has no such force; wheel and swivel turn with the carrier.
        let (chain, along) = self.motions_along();
        let [on_slip, on_swivel] = motion.by_turn.on_end;
        forces.resize(along, (0.0, 0.0));
        if let Some((still, _)) = forces[..chain].first_mut() {
            *still += on_slip;
        }
        forces.resize(self.motions(), (on_swivel, 0.0));
        forces
    }

    /// Forces of [`forces_by_carrier`](Self::forces_by_carrier) at ω [rad/s], with the loss of the drum side.
    pub(crate) fn forces_at(&self, motion: &CarrierMotion, omega: Complex) -> Vec<Complex> {
        let square = self.square(omega);
        let mut forces = self.forces_by_carrier(motion).iter().map(|(still, mass)| *still + square * *mass).collect();
        let [at_drum, at_wheel, _] = motion.of_drum_side(self.drum_side_ratio());
        self.add_on_drum_side(&mut forces, [-at_drum, -at_wheel], omega);
        forces
    }

    /// Motion along `cable` for a motion of the carrier at ω [rad/s], the platform end held. The cable is this one,
    /// perhaps in another discretisation.
    pub(crate) fn motion_by_carrier(
        &self,
        cable: &CatenaryDynamic,
        motion: &CarrierMotion,
        omega: Complex,
    ) -> InternalMotion {
        self.motion_by_far_end(cable, motion.displacement, self.forces_at(motion, omega), omega)
    }

    /// Motion along `cable` per unit of a signal of the drive or tension at ω [rad/s]: by an input, the platform end
    /// held, and by reciprocity the output per force on a point of the cable. The cable is this one, perhaps in another
    /// discretisation. `None` if the cable has no such signal.
    pub(crate) fn motion_by_signal(
        &self,
        cable: &CatenaryDynamic,
        signal: DriveSignal,
        omega: Complex,
    ) -> Option<InternalMotion> {
        let [start, far_end] = self.ends_of_signal(signal);
        if signal == DriveSignal::Tension {
            let square = self.square(omega);
            let moved = InternalMotion::new(cable, start.map(Complex::from), square);
            return Some(moved.with_drive(cable, &self.beyond_undamped(omega, 1.0), square));
        }
        let Some(chain) = self.chain() else {
            return Some(self.motion_by_far_end(cable, far_end, Vec::new(), omega));
        };
        let given = self.output_row(chain, signal, omega)?;
        Some(self.motion_by_far_end(cable, [0.0; 3], given, omega))
    }

    /// Motions (e, n, b) of the platform end and of the far end per unit of a signal: that of an input, or by
    /// reciprocity the force on the end that is measured. Zero for signals that act on the motions of a drive.
    pub(crate) fn ends_of_signal(&self, signal: DriveSignal) -> [[f64; 3]; 2] {
        let along = |[h, v]: [f64; 2], factor: f64| [factor * h, factor * v, 0.0];
        let (held, is_far_end) = ([0.0; 3], self.chain().is_none() && self.cable.coupled.is_none());
        match signal {
            DriveSignal::Tension => [along(self.directions.from_platform, 1.0), held],
            DriveSignal::Length if is_far_end => [held, along(self.directions.to_platform, self.directions.stretch)],
            DriveSignal::DrumTension if is_far_end => [held, along(self.directions.to_platform, 1.0)],
            _ => [held; 2],
        }
    }

    /// Motion along `cable` for a motion of the far end and the forces `given` on the first motions of the drive at ω
    /// [rad/s], the platform end held.
    fn motion_by_far_end(
        &self,
        cable: &CatenaryDynamic,
        far_end: [f64; 3],
        mut given: Vec<Complex>,
        omega: Complex,
    ) -> InternalMotion {
        let (held, square) = ([Complex::new(0.0, 0.0); 3], self.square(omega));
        let mut found = InternalMotion::between(cable, held, far_end.map(Complex::from), square);
        let Some(drive) = &cable.drive else { return found };
        given.resize(self.motions(), Complex::new(0.0, 0.0));

        // Forces on the motions of the drive: the given ones less those of the losses.
        let at = DriveAt::at(cable, drive, self.motions(), square, &NearRanges::default());
        let delta = self.beyond_undamped(omega, 1.0).values();
        let mut free: Vec<Complex> = (DriveAt::by_carrier(cable, drive, delta.len(), square).iter())
            .map(|row| row.iter().zip(far_end).map(|(t, c)| t * c).sum())
            .collect();
        at.add_motion_by(&given, &mut free);
        let forces: Vec<Complex> =
            given.iter().zip(at.forces(&delta, &free)).map(|(given, lost)| given - lost).collect();

        // The clamped modes under these forces.
        for family in Family::ALL {
            let poles = cable.poles_of(family);
            for (index, (amplitude, pole)) in found.amplitudes(family).iter_mut().zip(poles).enumerate() {
                let phi = drive.in_mode(family, index);
                let force: Complex = phi.iter().zip(&forces).map(|(phi, force)| force * *phi).sum();
                *amplitude += force / (*pole - square);
            }
        }
        found
    }

    /// Force on the held platform end in (e, n, b) for a motion of the carrier at ω [rad/s].
    pub(crate) fn force_by_carrier(&self, motion: &CarrierMotion, omega: Complex) -> [Complex; 3] {
        let square = self.square(omega);
        let mut force = [Complex::new(0.0, 0.0); 3];

        // The undamped model of the drive.
        let [e, n, b] = motion.displacement;
        if let Some(family) = self.coupled() {
            for (i, force) in force.iter_mut().enumerate() {
                *force -=
                    [e, n, b].iter().enumerate().map(|(j, c)| family.entry(i, 3 + j, square) * c).sum::<Complex>();
            }
        } else {
            for (i, force) in force.iter_mut().enumerate().take(2) {
                *force -= self.in_plane().entry(i, 2, square) * e + self.in_plane().entry(i, 3, square) * n;
            }
            if let Some(family) = self.out_of_plane() {
                force[2] -= family.entry(0, 1, square) * b;
            }
        }

        // Forces on the motions of the drive: those of its losses, and those that the carrier brings about.
        if let Some((motions, losses, free, given)) = self.drive_under_carrier(motion, omega) {
            let delta = losses.values();
            let lost = motions.forces(&delta, &free);
            let moved = motions.moved(&delta);
            for (s, force) in force.iter_mut().enumerate() {
                *force -= lost.iter().zip(&motions.transfer).map(|(lost, row)| row[s] * lost).sum::<Complex>();
                *force += given.iter().zip(&moved).map(|(given, row)| row[s] * given).sum::<Complex>();
            }
        }
        force
    }

    /// Output of the cable's drive, or its tension, for a motion of the carrier at ω [rad/s], the platform end held.
    /// `None` if the cable has no such signal.
    pub(crate) fn response_to_carrier(
        &self,
        motion: &CarrierMotion,
        output: DriveSignal,
        omega: Complex,
    ) -> Option<Complex> {
        if output == DriveSignal::Tension {
            return Some(self.tension_of(&self.force_by_carrier(motion, omega)));
        }
        let Some(chain) = self.chain() else {
            return (output == DriveSignal::DrumTension).then(|| self.tension_at_moved_end(motion, omega)).flatten();
        };
        let through = self.through_drive(chain, motion, output, omega)?;
        if output != DriveSignal::DrumTension {
            return Some(through);
        }
        Some(through + self.drum_tension_of_ends(motion.of_drum_side(self.drum_side_ratio()), omega))
    }

    /// Row of a signal times the motions of the drive for a motion of the carrier.
    fn through_drive(
        &self,
        chain: &DriveChain,
        motion: &CarrierMotion,
        signal: DriveSignal,
        omega: Complex,
    ) -> Option<Complex> {
        let row = self.output_row(chain, signal, omega)?;
        let (motions, losses, mut free, given) = self.drive_under_carrier(motion, omega)?;
        motions.add_motion_by(&given, &mut free);
        let moved = motions.freed(&losses.values(), &free);
        Some(row.iter().zip(&moved).map(|(row, moved)| row * moved).sum())
    }

    /// Force on a motion of the carrier per displacement of the drum side's end at the drum towards the platform.
    fn drum_side_by_carrier(&self, motion: &CarrierMotion, omega: Complex) -> Complex {
        let ratio = self.drum_side_ratio();
        self.drum_tension_of_ends(motion.of_drum_side(ratio), omega) / ratio
    }

    /// Mass between a motion of the chain and a motion of the whole drum side along itself [kg].
    pub(crate) fn carried_mass(&self, motion: usize) -> f64 {
        let side = self.chain().and_then(|chain| chain.drum_side.get(motion));
        side.map_or(0.0, |side| side.carried_mass)
    }

    /// Stiffness of the drum side between the motion along the cable and its end at the wheel [N/m].
    pub(crate) fn drum_side_at_wheel(&self) -> f64 {
        self.chain().and_then(|chain| chain.drum_side.first()).map_or(0.0, |side| side.stiffness)
    }

    /// Stretch at the exit point over that at the drum; 1 without a drum side.
    pub(crate) fn drum_side_ratio(&self) -> f64 {
        self.chain().and_then(|chain| chain.drum_end.as_ref()).map_or(1.0, |end| end.ratio)
    }

    /// Force on the carrier along a motion per unit of an input, the platform end held, at ω [rad/s]; by reciprocity
    /// the output of such a motion. `None` if the cable has no such signal.
    pub(crate) fn signal_by_carrier(
        &self,
        motion: &CarrierMotion,
        signal: DriveSignal,
        omega: Complex,
    ) -> Option<Complex> {
        if signal != DriveSignal::Length {
            return self.response_to_carrier(motion, signal, omega);
        }
        let Some(chain) = self.chain() else {
            // The far end moves by the length that is paid out.
            return self.tension_at_moved_end(motion, omega).map(|tension| tension * self.directions.stretch);
        };
        let through = self.through_drive(chain, motion, signal, omega)?;
        // A length that a drum pays out which is held moves the end of the drum side.
        let held = if chain.drum.is_none() { self.drum_side_by_carrier(motion, omega) } else { Complex::new(0.0, 0.0) };
        Some(through + held * self.directions.stretch)
    }

    /// Tension at a far end without a drive, which moves with its carrier; `None` if the end couples the families.
    fn tension_at_moved_end(&self, motion: &CarrierMotion, omega: Complex) -> Option<Complex> {
        let ([h, v], square, [e, n, _]) = (self.directions.to_platform, self.square(omega), motion.displacement);
        let of = |i: usize, j: usize| self.in_plane().entry(i, j, square);
        let force = |i: usize| of(i, 2) * e + of(i, 3) * n;
        let lost = self.lost_at_far_end(motion.displacement, omega);
        self.coupled().is_none().then(|| -(force(2) * h + force(3) * v + lost))
    }

    /// Motions of the drive at ω [rad/s], the terms that its losses add, the motions by the carrier alone, and the
    /// forces of the carrier on them [N]. `None` without a drive.
    fn drive_under_carrier(
        &self,
        motion: &CarrierMotion,
        omega: Complex,
    ) -> Option<(DriveAt, DriveLosses, Vec<Complex>, Vec<Complex>)> {
        let (motions, losses) = self.motions_with_losses(omega)?;
        let free = self.free_by_far_end(motion.displacement, omega)?;

        // The drum side, whose mass is carried along or which is stretched, and the swivel.
        Some((motions, losses, free, self.forces_at(motion, omega)))
    }
}
