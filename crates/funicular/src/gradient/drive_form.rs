//! Quadratic form of the drive of a cable over the motions behind its exit point, and the coefficients of the form over
//! the numbers of the drive.
//!
//! The form is (76) with the masses and the control: `Σ k_j (Δ_a)(Δ_b) + … − ω² Σ M z_a z_b + C(ω) w_a w_b`. Its
//! differential keeps the motions and changes the numbers (docs/theory.md, equation (60l)).

use super::adjoint::CableAdjoint;
use super::scalar::Field;
use super::support_form::{SideForces, Sides};
use crate::cable::catenary_dynamic::DriveSignal;
use crate::drive::derivatives::end;
use crate::drive::{AnchorEnd, ChainDescription, DriveAtRest, Piece, Place};
use crate::math::Complex;
use crate::robot::{Anchor, PulleyContact, Servo, WinchMode};

/// Quadratic form of the drive of one cable that vibrates.
pub(super) struct VibratingDriveForm {
    chain: Option<ChainDescription>,
    /// Radius of the wheel, its moment of inertia and that of the swivel.
    radius: f64,
    inertia: f64,
    swivel_inertia: f64,
    /// Distance of the exit point from the swivel axis.
    distance: f64,
    /// Place of the motion sideways among the motions, if there is one.
    sideways: Option<usize>,
    /// Winch: length to the drum, distances and masses of the guide wheels, masses of drum and motor.
    drum_side_length: f64,
    guides: Vec<(f64, f64)>,
    drum_mass: f64,
    motor_mass: f64,
    /// Compliance of the drum side alone.
    drum_side_compliance: f64,
    /// Stretch at the exit point and at the drum.
    stretch: f64,
    stretch_drum: f64,
    /// EA and mass per length of the rope.
    axial_stiffness: f64,
    mass_per_length: f64,
}

/// Control of the motor of one cable at a frequency: force C + iωc per motion, and derivatives of this force with
/// respect to the position gain, the speed gain, the delay and the viscous damping.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ControlAt<T> {
    pub(super) force: T,
    pub(super) by_position_gain: T,
    pub(super) by_speed_gain: T,
    pub(super) by_delay: T,
    pub(super) by_damping: T,
}

impl ControlAt<f64> {
    /// Control without losses.
    pub(super) fn undamped(servo: Option<&Servo>) -> Self {
        match servo {
            Some(servo) => Self { force: servo.position_gain, by_position_gain: 1.0, ..Self::default() },
            None => Self::default(),
        }
    }
}

impl ControlAt<Complex> {
    /// Control at a complex ω.
    pub(super) fn at(servo: Option<&Servo>, damping: f64, omega: Complex) -> Self {
        let rate = Complex::i() * omega;
        let mut at = Self { force: rate * damping, by_damping: rate, ..Self::default() };
        if let Some(servo) = servo {
            let (force, _) = servo.control(omega);
            let delay = (-rate * servo.delay).exp();
            at.force += force;
            at.by_position_gain = delay;
            at.by_speed_gain = rate * delay;
            at.by_delay = -rate * force;
        }
        at
    }
}

/// Frequencies at which the form of a drive is evaluated.
pub(super) struct DriveAtFrequency<T> {
    /// Square ω² of wheel, drum and motor, and ω_c² of the rope.
    pub(super) square: T,
    pub(super) of_rope: T,
    pub(super) control: ControlAt<T>,
    /// Factor h of the stiffness of the drum side, and its derivatives by loss factor and damping time.
    pub(super) stretch: T,
    pub(super) by_loss: [T; 2],
}

impl<T: Field> DriveAtFrequency<T> {
    /// Adds the derivative of the form by h, times the derivatives of h.
    fn add_loss(&self, sum: &mut CableAdjoint<T>, by_factor: T) {
        sum.stretch_loss.iter_mut().zip(self.by_loss).for_each(|(sum, by)| *sum += by_factor * by);
    }
}

impl VibratingDriveForm {
    /// Form of the drive of a cable. Its motions are the motions of the chain, and last the motion sideways.
    pub(super) fn of(
        anchor: &Anchor,
        drive: &DriveAtRest,
        rope: (f64, f64),
        mode: WinchMode,
        limit: f64,
        along: usize,
    ) -> Self {
        let chain = ChainDescription::of(anchor, drive, rope, mode, limit);
        let end: &AnchorEnd = &drive.end;
        let pulley = anchor.pulley.as_ref();
        let winch = anchor.winch.as_ref();
        let straight = drive.drum_side_length / (rope.0 * end.stretch_drum.powi(2));

        Self {
            chain,
            radius: pulley.map_or(0.0, |pulley| pulley.radius),
            inertia: pulley.map_or(0.0, |pulley| pulley.inertia),
            swivel_inertia: pulley.map_or(0.0, |pulley| pulley.swivel_inertia),
            distance: drive.contact.as_ref().map_or(0.0, PulleyContact::distance_from_axis),
            sideways: end.sideways_w.map(|_| along),
            drum_side_length: anchor.drum_side_length(),
            guides: winch.map_or_else(Vec::new, |winch| {
                winch.guide_wheels.iter().map(|wheel| (wheel.distance, wheel.mass)).collect()
            }),
            drum_mass: winch.map_or(0.0, |winch| winch.drum_mass),
            motor_mass: winch.map_or(0.0, |winch| winch.motor_mass),
            drum_side_compliance: straight,
            stretch: end.stretch,
            stretch_drum: end.stretch_drum,
            axial_stiffness: rope.0,
            mass_per_length: rope.1,
        }
    }

    /// Adds `factor` times the coefficients of the form over two motions, in which a support moves the entry point
    /// along the drum side. The result is the mass of the rope of the drive over both motions, by which the form
    /// changes with −ω_c², and the forces of the drum side on the entry point.
    pub(super) fn add<T: Field>(
        &self,
        sum: &mut CableAdjoint<T>,
        (a, b): (&[T], &[T]),
        sides: &Sides<T>,
        at: &DriveAtFrequency<T>,
        factor: T,
    ) -> (T, SideForces<T>) {
        let (mut rope_mass, mut on_side) = (T::default(), [T::default(); 2]);
        if let Some(chain) = &self.chain {
            let slip = factor * a[0] * b[0];
            sum.end[end::WEIGHT] += slip;
            if self.radius > 0.0 {
                let inertia = -(slip * at.square) * self.radius.powi(-2);
                sum.drive.inertia += inertia;
                sum.drive.radius += inertia * (-2.0 * self.inertia / self.radius);
            }

            let mut by_ratio = T::default();
            for (index, piece) in chain.pieces.iter().enumerate() {
                let motions = (a, b, sides);
                let (mass, forces) = self.add_piece(sum, chain, (index, piece), motions, at, factor, &mut by_ratio);
                rope_mass += mass;
                on_side.iter_mut().zip(forces).for_each(|(sum, force)| *sum += force);
            }
            for (place, wheel) in &chain.guides {
                let by_mass = -(factor * at.square * moved(*place, a) * moved(*place, b));
                sum.guide_mass(*wheel, by_mass);
            }
            self.add_winch(sum, chain, (a, b), at, factor, &mut by_ratio);
            self.add_ratio(sum, by_ratio);
        }

        // Sideways with the swivel.
        if let Some(v) = self.sideways {
            if self.chain.is_some() {
                sum.end[end::COUPLING] += factor * (a[0] * b[v] + a[v] * b[0]);
            }
            let both = factor * a[v] * b[v];
            sum.end[end::SIDEWAYS_STIFFNESS] += both;
            let inertia = -(both * at.square) * self.distance.powi(-2);
            sum.drive.swivel_inertia += inertia;
            sum.end[end::DISTANCE] += inertia * (-2.0 * self.swivel_inertia / self.distance);
        }
        (rope_mass, on_side)
    }

    /// Adds the coefficients of a piece of arc and drum side; see [`Self::add`].
    #[expect(clippy::too_many_arguments, reason = "a piece in its chain, over two motions")]
    fn add_piece<T: Field>(
        &self,
        sum: &mut CableAdjoint<T>,
        chain: &ChainDescription,
        (index, piece): (usize, &Piece),
        (a, b, sides): (&[T], &[T], &Sides<T>),
        at: &DriveAtFrequency<T>,
        factor: T,
        by_ratio: &mut T,
    ) -> (T, SideForces<T>) {
        let motion = PieceMotion::of(chain, (index, piece), (a, b, sides));
        let [ends_a, ends_b] = motion.ends;
        let mut strained = (ends_a[0] - ends_a[1]) * (ends_b[0] - ends_b[1]);
        for wave in piece.waves.clone() {
            strained += a[wave] * b[wave] * 2.0;
        }

        let (mass, forces) = self.rod(piece, (a, b), &motion, at.of_rope);
        if piece.mass.is_some() {
            let inertia = -(factor * at.of_rope * mass);
            sum.mass += inertia * (1.0 / self.mass_per_length);
            sum.stiffness += inertia * (1.0 / self.axial_stiffness);
        }

        // k = 1/(λ²Γ); the mass is proportional to 1/k.
        let by_spring = factor * strained * at.stretch + factor * at.of_rope * mass * (1.0 / piece.spring);
        at.add_loss(sum, factor * strained * piece.spring);
        sum.end[end::STRETCH] += by_spring * (-2.0 * piece.spring / self.stretch);
        self.add_compliance(sum, chain, index, by_spring * (-piece.spring / piece.compliance));

        // Ends whose places contain the ratio of the stretches.
        let pull =
            [ends_a[0] - ends_a[1], ends_b[0] - ends_b[1]].map(|stretched| stretched * at.stretch * piece.spring);
        for (k, sign) in [(0, 1.0), (1, -1.0)] {
            let (Some(place), true) = (piece.ends[k], piece.by_ratio[k]) else { continue };
            let force = [pull[0] * sign + forces[k][0], pull[1] * sign + forces[k][1]];
            let per_ratio = place.factor / chain.ratio;
            *by_ratio += factor * (a[place.motion] * force[1] + b[place.motion] * force[0]) * per_ratio;
        }

        // Forces along the drum side on its entry point.
        let on_side = if sides.from_ground && index == 0 {
            let at_wheel = [0, 1].map(|k| pull[k] + forces[0][k]);
            *by_ratio += factor * (at_wheel[0] * sides.along[1] + at_wheel[1] * sides.along[0]);
            at_wheel.map(|force| force * chain.ratio)
        } else if sides.from_ground {
            [T::default(); 2]
        } else {
            [0, 1].map(|k| forces[0][k] + forces[1][k])
        };
        (mass, on_side)
    }

    /// Mass of a piece over both motions, as a rod of the length EA/k, and the forces of its inertia on its ends; zero
    /// for a piece without mass.
    fn rod<T: Field>(
        &self,
        piece: &Piece,
        (a, b): (&[T], &[T]),
        motion: &PieceMotion<T>,
        of_rope: T,
    ) -> (T, [[T; 2]; 2]) {
        let (mut mass, mut forces) = (T::default(), [[T::default(); 2]; 2]);
        let Some(matrix) = &piece.mass else { return (mass, forces) };
        let size = 0.5 * self.mass_per_length * self.axial_stiffness / piece.spring;
        let function = |ends: &[T; 2], z: &[T], whole: T, k: usize| {
            if k < 2 { ends[k] + whole } else { z[piece.waves.start + k - 2] }
        };

        let PieceMotion { ends: [ends_a, ends_b], whole } = motion;
        for row in 0..matrix.nrows() {
            let product = |ends: &[T; 2], z: &[T], whole: T| {
                let mut product = T::default();
                for column in 0..matrix.ncols() {
                    product += function(ends, z, whole, column) * (matrix[(row, column)] * size);
                }
                product
            };
            let (by_a, by_b) = (product(ends_a, a, whole[0]), product(ends_b, b, whole[1]));
            mass += function(ends_a, a, whole[0], row) * by_b;
            if row < 2 {
                forces[row] = [-(of_rope * by_a), -(of_rope * by_b)];
            }
        }
        (mass, forces)
    }

    /// Adds the coefficient of the compliance of a piece: of the whole rope, or of its share of the drum side.
    fn add_compliance<T: Field>(&self, sum: &mut CableAdjoint<T>, chain: &ChainDescription, index: usize, by: T) {
        let last = chain.pieces.len() - 1;
        if last == 0 {
            sum.end[end::ROPE_COMPLIANCE] += by;
            return;
        }

        // Γ_j = Γ_d (ℓ_{j+1} − ℓ_j)/ℓ_d; the arc belongs to the first.
        let length = self.drum_side_length;
        let wheel = |k: usize| chain.guides[k].1;
        let start = if index == 0 { 0.0 } else { self.guides[wheel(index - 1)].0 };
        let stop = if index == last { length } else { self.guides[wheel(index)].0 };
        let share = (stop - start) / length;
        if index == 0 {
            sum.end[end::ROPE_COMPLIANCE] += by;
            sum.end[end::DRUM_SIDE_COMPLIANCE] += by * (share - 1.0);
        } else {
            sum.end[end::DRUM_SIDE_COMPLIANCE] += by * share;
        }
        let per_length = by * (self.drum_side_compliance / length);
        if index < last {
            sum.guide_distance(wheel(index), per_length);
        }
        if index > 0 {
            sum.guide_distance(wheel(index - 1), -per_length);
        }
        let by_length = if index == last { 1.0 - share } else { -share };
        sum.drive.drum_side_length += per_length * by_length;
    }

    /// Adds the coefficients of drum, shaft and motor.
    fn add_winch<T: Field>(
        &self,
        sum: &mut CableAdjoint<T>,
        chain: &ChainDescription,
        (a, b): (&[T], &[T]),
        at: &DriveAtFrequency<T>,
        factor: T,
        by_ratio: &mut T,
    ) {
        let Some(drum) = chain.drum else { return };
        let at_place = |place: Option<Place>, z: &[T]| place.map_or_else(T::default, |place| moved(place, z));
        let (drum_a, drum_b) = (moved(drum, a), moved(drum, b));
        let (motor_a, motor_b) = (at_place(chain.motor, a), at_place(chain.motor, b));

        sum.drive.drum_mass += -(factor * at.square * drum_a * drum_b);
        let mut force = [drum_a, drum_b].map(|moved| -(at.square * moved * self.drum_mass));
        if chain.shaft.is_finite() {
            sum.drive.stiffness += factor * (drum_a - motor_a) * (drum_b - motor_b);
            force[0] += (drum_a - motor_a) * chain.shaft;
            force[1] += (drum_b - motor_b) * chain.shaft;
        }
        if let Some(motor) = chain.motor {
            let both = factor * motor_a * motor_b;
            sum.drive.motor_mass += -(at.square * both);
            let control = &at.control;
            if chain.is_controlled {
                sum.drive.position_gain += both * control.by_position_gain;
                sum.drive.speed_gain += both * control.by_speed_gain;
                sum.drive.delay += both * control.by_delay;
            }
            sum.drive.damping += both * control.by_damping;
            if motor.is_at_exit() {
                for (force, moved) in force.iter_mut().zip([motor_a, motor_b]) {
                    *force += moved * control.force - at.square * moved * self.motor_mass;
                }
            }
        }

        // A drum at the exit point moves by σ λ_E/λ.
        if drum.is_at_exit() {
            let per_ratio = -drum.factor / chain.ratio;
            *by_ratio += factor * (a[drum.motion] * force[1] + b[drum.motion] * force[0]) * per_ratio;
        }
    }

    /// Adds `factor` times the coefficients of the forces on the drive per unit of a signal, over the motions `z` on
    /// which they act, with the first of `side` along the drum side; `by_damping` has the derivatives of ω_c². The
    /// result is the force of the drum side on its entry point.
    pub(super) fn add_signal<T: Field>(
        &self,
        sum: &mut CableAdjoint<T>,
        signal: DriveSignal,
        (z, side): (&[T], &Sides<T>),
        (at, servo, by_damping): (&DriveAtFrequency<T>, Option<&Servo>, [T; 2]),
        factor: T,
    ) -> T {
        let (mut by_ratio, mut on_side) = (T::default(), T::default());
        let Some(chain) = &self.chain else { return on_side };

        // A place at the exit point contains one over the ratio of the stretches.
        let mut add_place = |place: Place, force: T| {
            if place.is_at_exit() {
                by_ratio += factor * force * moved(place, z) * (-1.0 / chain.ratio);
            }
        };

        match (signal, chain.drum, chain.motor) {
            (DriveSignal::Drum, Some(place), _) | (DriveSignal::Motor, _, Some(place)) => {
                add_place(place, T::from(1.0));
            }
            (DriveSignal::Length, _, Some(motor)) => {
                // C λ_E at the motor.
                let (Some(servo), control) = (servo, &at.control) else { return on_side };
                let force = control.by_position_gain * servo.position_gain + control.by_speed_gain * servo.speed_gain;
                let work = factor * moved(motor, z);
                sum.end[end::STRETCH_DRUM] += work * force;
                sum.drive.position_gain += work * control.by_position_gain * self.stretch_drum;
                sum.drive.speed_gain += work * control.by_speed_gain * self.stretch_drum;
                sum.drive.delay += work * control.by_delay * self.stretch_drum;
                add_place(motor, force * self.stretch_drum);
            }
            (DriveSignal::Length, Some(drum), None) => {
                // k λ_E at the drum.
                let work = factor * moved(drum, z);
                sum.end[end::STRETCH_DRUM] += work * chain.shaft;
                sum.drive.stiffness += work * self.stretch_drum;
                add_place(drum, T::from(chain.shaft * self.stretch_drum));
            }
            (DriveSignal::Length, None, None) => {
                on_side = self.add_held_drum(sum, chain, (z, side), (at, by_damping), factor, &mut by_ratio);
            }
            _ => {}
        }

        self.add_ratio(sum, by_ratio);
        on_side
    }

    /// Adds the coefficients of the force `λ (k + ω_c² M)` of the last piece, whose end at the drum is moved by λ. The
    /// result is the force of the drum side on its entry point.
    fn add_held_drum<T: Field>(
        &self,
        sum: &mut CableAdjoint<T>,
        chain: &ChainDescription,
        (z, side): (&[T], &Sides<T>),
        (at, by_damping): (&DriveAtFrequency<T>, [T; 2]),
        factor: T,
        by_ratio: &mut T,
    ) -> T {
        let Some((index, piece)) = chain.pieces.iter().enumerate().next_back() else { return T::default() };
        let (stretches, along) = (side.from_ground && index == 0, side.along[0]);
        let mut start = piece.ends[0].map_or_else(T::default, |place| moved(place, z));
        if stretches {
            start += along * chain.ratio;
        }
        let (mut mass, mut mass_of_start, mut mass_of_whole) = (T::default(), 0.0, 0.0);
        if let Some(matrix) = &piece.mass {
            let size = 0.5 * self.mass_per_length * self.axial_stiffness / piece.spring;
            mass = start * (matrix[(0, 1)] * size);
            mass_of_start = matrix[(0, 1)] * size;
            if !side.from_ground {
                mass_of_whole = (matrix[(0, 1)] + matrix[(1, 1)]) * size;
                mass += along * mass_of_whole;
            }
            for (k, wave) in piece.waves.clone().enumerate() {
                mass += z[wave] * (matrix[(k + 2, 1)] * size);
            }
        }

        let inertia = factor * at.of_rope * mass;
        let force = factor * start * at.stretch * piece.spring + inertia;
        at.add_loss(sum, factor * start * (piece.spring * self.stretch));
        sum.end[end::STRETCH] += force;
        let by_spring = (factor * start * at.stretch - inertia * (1.0 / piece.spring)) * self.stretch;
        sum.end[end::STRETCH] += by_spring * (-2.0 * piece.spring / self.stretch);
        self.add_compliance(sum, chain, index, by_spring * (-piece.spring / piece.compliance));
        if piece.mass.is_some() {
            sum.mass += inertia * (self.stretch / self.mass_per_length);
            sum.stiffness += inertia * (self.stretch / self.axial_stiffness);
            sum.mass += factor * mass * self.stretch * by_damping[0];
            sum.damping += factor * mass * self.stretch * by_damping[1];
        }
        let per_motion = (at.stretch * piece.spring + at.of_rope * mass_of_start) * self.stretch;
        if let (Some(place), true) = (piece.ends[0], piece.by_ratio[0]) {
            *by_ratio += factor * per_motion * z[place.motion] * (place.factor / chain.ratio);
        }
        if stretches {
            *by_ratio += factor * per_motion * along;
            return per_motion * chain.ratio;
        }
        at.of_rope * (mass_of_whole * self.stretch)
    }

    /// Adds the coefficient of the ratio of the stretches.
    fn add_ratio<T: Field>(&self, sum: &mut CableAdjoint<T>, by_ratio: T) {
        sum.end[end::STRETCH] += by_ratio * (1.0 / self.stretch_drum);
        sum.end[end::STRETCH_DRUM] += by_ratio * (-self.stretch * self.stretch_drum.powi(-2));
    }

    /// Chain of the motions along the cable.
    pub(super) fn chain(&self) -> Option<&ChainDescription> {
        self.chain.as_ref()
    }

    /// Place of the motion sideways.
    pub(super) fn sideways(&self) -> Option<usize> {
        self.sideways
    }
}

/// Motions of the ends of a piece of arc and drum side, in two motions of the drive.
struct PieceMotion<T> {
    /// Motions of the end at the wheel and of the end at the drum, for each motion of the drive.
    ends: [[T; 2]; 2],
    /// Motion of the whole piece with a support that carries it, for each motion of the drive.
    whole: [T; 2],
}

impl<T: Field> PieceMotion<T> {
    fn of(chain: &ChainDescription, (index, piece): (usize, &Piece), (a, b, sides): (&[T], &[T], &Sides<T>)) -> Self {
        // A support stretches a drum side from the ground at the wheel, and carries another one along.
        let stretched = |along: T| if sides.from_ground && index == 0 { along * chain.ratio } else { T::default() };
        let carried = |along: T| if sides.from_ground { T::default() } else { along };
        let at_ends = |z: &[T], along: T| {
            let [wheel, drum] = piece.ends.map(|end| end.map_or_else(T::default, |place| moved(place, z)));
            [wheel + stretched(along), drum]
        };
        Self { ends: [at_ends(a, sides.along[0]), at_ends(b, sides.along[1])], whole: sides.along.map(carried) }
    }
}

/// Motion at a place.
fn moved<T: Field>(place: Place, motions: &[T]) -> T {
    motions[place.motion] * place.factor
}
