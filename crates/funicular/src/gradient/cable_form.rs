//! Quadratic form of one cable over two motions of the robot, and its coefficients over the state of the cable.
//!
//! `W(a, b) = ∫ δp_a'ᵀ C δp_b' − ω_c² m ∫ δp_aᵀ δp_b` is stationary in the motions inside the cable. So its
//! differential contains the numbers of the cable and the motions of its ends alone. With the change δN = C δp' of the
//! tension vector and the third derivative κ of |N|, every coefficient is an integral along the cable (docs/theory.md,
//! equation (60a)).

mod length_rate;
mod motion;
mod sums;
mod vibrating;

use super::GradientError;
use super::adjoint::CableAdjoint;
use super::drive_form::{ControlAt, DriveAtFrequency, VibratingDriveForm};
use super::end_form::EndAtRest;
use super::scalar::{Field, Vector, add, add_times, cross, dot, vector};
use super::support_form::{AlongDrumSide, SideForces, Sides};
use crate::cable::catenary_dynamic::{
    CatenaryDynamic, CatenaryDynamicEnd, DriveSignal, POINTS_BEYOND_DEGREE, TwoEnded, smooth_pieces,
};
use crate::catenary::space::HangingCable;
use crate::drive::derivatives::end;
use crate::math::{Complex, Vec3};
use crate::robot::{Anchor, Cable, Servo, StretchLoss, WinchMode};
use crate::statics::CableState;
use crate::statics::derivatives::StaticDerivativeError;
use std::array::from_fn;
use sums::{GaussRule, QuadratureElement, ShapeColumns};
use vibrating::{Vibrating, VibratingEnd};

pub(super) use vibrating::LossesAt;

/// Natural logarithm of the accuracy of integrals of the tension alone along a cable at rest: 1e-14.
const DIGITS_OF_REST: f64 = 32.0;

/// Quadratic form of a cable about its equilibrium.
pub(super) struct CableForm {
    /// Horizontal, up, out of plane.
    axes_w: [Vec3; 3],
    lever_w: Vec3,
    length: f64,
    axial_stiffness: f64,
    mass_per_length: f64,
    /// Static stiffness of the platform end in the axes: hh, hv, vv, and out of plane [N/m].
    stiffness: [f64; 4],
    /// Integrals ∫ t tᵀ ds in plane [m].
    direction_integrals: [[f64; 2]; 2],
    /// Load per length, up [N/m]; negative.
    load: f64,
    points: Vec<CablePoint>,
    elements: Vec<QuadratureElement>,
    inertia: Inertia,
    /// End at the pulley or the winch, if it can move and the cable has no inertia.
    end: Option<EndAtRest>,
}

/// Motion of the points of a cable.
enum Inertia {
    /// No motion: the model has no inertia of the cable.
    None,
    /// Slow motion: the cable has no mass, but may get some.
    Massless,
    /// Vibration by clamped modes.
    Modes(Box<Vibrating>),
}

/// Frequency of a cable, and the losses of its drive there.
#[derive(Debug, Clone, Default)]
pub(super) struct CableAt<T> {
    /// Square ω_c², and its derivatives by mass per length and by damping.
    pub(super) square: T,
    pub(super) by_damping: [T; 2],
    /// Factor h of the axial stiffness by the loss of the stretch; `None` without loss.
    pub(super) stretch: Option<T>,
    /// Derivatives of h by loss factor and damping time.
    pub(super) by_loss: [T; 2],
    /// Control of the motor.
    pub(super) control: ControlAt<T>,
    /// Losses of the drive; `None` without losses and without forces on it.
    pub(super) losses: Option<LossesAt<T>>,
}

impl<T: Field> CableAt<T> {
    /// The frequency for the drive of the cable, whose own square is ω².
    fn of_drive(&self, square: T) -> DriveAtFrequency<T> {
        let stretch = self.stretch.unwrap_or_else(|| T::from(1.0));
        DriveAtFrequency { square, of_rope: self.square, control: self.control, stretch, by_loss: self.by_loss }
    }
}

impl CableAt<Complex> {
    /// The frequency with the stretch of a rope with this loss at a complex ω of positive real part.
    pub(super) fn with_stretch(self, loss: StretchLoss, omega: Complex) -> Self {
        let factor = Complex::from(1.0) + loss.at(omega).0;
        Self { stretch: loss.is_some().then_some(factor), by_loss: StretchLoss::by_values(omega), ..self }
    }
}

/// Point of the integrals along a cable.
struct CablePoint {
    /// Fraction σ of the unstrained length from the platform end.
    fraction: f64,
    /// Weight in unstrained length [m].
    weight: f64,
    /// Direction of the tension vector in plane.
    direction: [f64; 2],
    /// Tension [N].
    tension: f64,
}

/// Motion of a cable in the axes (horizontal, up, out of plane).
pub(super) struct CableMotion<T> {
    /// Displacement at each point; empty for a cable without inertia.
    displacement: Vec<Vector<T>>,
    /// Change of the tension vector at each point [N].
    tension: Vec<Vector<T>>,
    /// Force that moves the platform end, world axes [N].
    end_force_w: Vector<T>,
    /// Rotation of the platform, world axes.
    theta: Vector<T>,
    /// Motions along the cable and sideways of an end at rest, or the motions of the drive.
    end: Vec<T>,
    /// Force that moves the far end, in the axes of the cable [N].
    far_force: Vector<T>,
}

/// Integrals along a cable over two changes of its tension vector.
struct TensionIntegrals<T> {
    /// Third derivative of |N| along both changes, and the same times the fraction of the length.
    by_force: Vector<T>,
    by_load: Vector<T>,
    /// Product of both changes.
    squares: T,
    /// Product of the change and the strain.
    work: T,
    /// Product of the parts of both changes along the cable.
    along: T,
}

/// Integrals along the cable that the loss of its stretch needs beside those without it.
struct StretchIntegrals<T> {
    /// Products of a part along and a part across over the tension, and the same times the fraction of the length.
    turned: Vector<T>,
    turned_by_load: Vector<T>,
}

impl<T> CableMotion<T> {
    /// Motions of the drive.
    pub(super) fn of_drive(&self) -> &[T] {
        &self.end
    }
}

impl CableForm {
    /// Cable with the static end stiffness of its catenary. `may_have_mass` for a massless cable in a model with
    /// inertia.
    pub(super) fn at_rest(anchor: &Anchor, state: &CableState, may_have_mass: bool) -> Result<Self, GradientError> {
        let mut form = Self::of_span(state)?;
        if may_have_mass {
            form.inertia = Inertia::Massless;
        }
        form.end = EndAtRest::of(anchor, state.drive.as_deref(), &hanging(state)?.tangent_w());
        Ok(form)
    }

    /// Free span of a cable at rest, both ends held.
    pub(super) fn of_span(state: &CableState) -> Result<Self, GradientError> {
        let catenary = &hanging(state)?.catenary;
        let pieces = smooth_pieces(catenary, vec![(0.0, catenary.rope().unstrained_length)]);
        let count = |size: f64| (DIGITS_OF_REST / (2.0 * size.ln())).ceil() as usize + 4;
        let sizes: Vec<usize> = pieces.iter().map(|(_, _, size)| count(*size)).collect();
        Self::on_pieces(state, 0.0, &pieces, &sizes, Inertia::None)
    }

    /// Cable that vibrates about its catenary. `winches` is the mode of the winches, `both` both ends of a cable on a
    /// flexible support.
    pub(super) fn vibrating(
        cable: &Cable,
        state: &CableState,
        (end, both): (&CatenaryDynamicEnd, Option<&TwoEnded>),
        winches: WinchMode,
    ) -> Result<Self, GradientError> {
        let catenary = hanging(state)?.catenary;
        let pieces = smooth_pieces(&catenary, vec![(0.0, catenary.rope().unstrained_length)]);
        let sizes: Vec<usize> = end.cable.degrees.iter().map(|degree| degree + POINTS_BEYOND_DEGREE).collect();
        let mut form = Self::on_pieces(state, end.mass_per_length, &pieces, &sizes, Inertia::None)?;

        // Displacements of these points: those that the cable has kept, or computed again.
        let (m, limit, moving) = (end.mass_per_length, end.cable.limit, end.cable.end.clone());
        let moments = end.cable.stretch.moments;
        let again;
        let (modes, stations) = if let Some(stations) = &end.shapes {
            (end.cable.clone(), &**stations)
        } else {
            let arc_lengths: Vec<f64> = form.points.iter().map(|point| point.fraction * form.length).collect();
            let found =
                CatenaryDynamic::with_stations(&catenary, moving.clone(), m, limit, &arc_lengths, false, moments)
                    .map_err(|reason| GradientError::CatenaryDynamic { cable: cable.name.clone(), reason })?;
            again = found.1;
            (found.0, &again)
        };
        let (_, along) = end.motions_along();
        let drive = match (&moving, &state.drive) {
            (Some(moving), Some(drive)) => {
                let rope = (cable.material.axial_stiffness, m);
                let directions = moving.along.iter().map(|of| (0, of.direction));
                let sideways = moving.sideways.iter().map(|of| (along, of.direction));
                Some(VibratingEnd {
                    form: VibratingDriveForm::of(&cable.anchor, drive, rope, winches, limit, along),
                    directions: directions.chain(sideways).collect(),
                })
            }
            _ => None,
        };
        form.inertia = Inertia::Modes(Box::new(Vibrating {
            cable: modes,
            points: form.points.len(),
            in_plane: ShapeColumns::of(&stations.in_plane),
            out_of_plane: ShapeColumns::of(&stations.out_of_plane),
            coupled: ShapeColumns::of(&stations.coupled),
            drive,
            along,
            count: end.motions(),
            side: both.map(AlongDrumSide::of),
        }));
        Ok(form)
    }

    /// Points on the pieces of a cable, for Gauss rules of these sizes.
    fn on_pieces(
        state: &CableState,
        mass_per_length: f64,
        pieces: &[(f64, f64, f64)],
        sizes: &[usize],
        inertia: Inertia,
    ) -> Result<Self, GradientError> {
        let hanging = hanging(state)?;
        let (catenary, (horizontal_w, up_w)) = (&hanging.catenary, hanging.axes_w());
        let rope = catenary.rope();
        let (h, at_start) = (catenary.horizontal_force(), catenary.vertical_force_at_start());

        let mut points: Vec<CablePoint> = Vec::with_capacity(sizes.iter().sum());
        let mut elements = Vec::with_capacity(pieces.len());
        for ((from, to, _), size) in pieces.iter().zip(sizes) {
            let rule = GaussRule::of_size(*size);
            let (center, half) = (0.5 * (from + to), 0.5 * (to - from));
            let first = points.len();
            for (xi, weight) in &rule.points {
                let s = center + half * xi;
                let v = at_start + rope.weight_per_length * s;
                let tension = h.hypot(v);
                points.push(CablePoint {
                    fraction: s / rope.unstrained_length,
                    weight: weight * half,
                    direction: [h / tension, v / tension],
                    tension,
                });
            }
            elements.push(QuadratureElement { points: first..points.len(), half, rule });
        }

        let [[hh, hv], [_, vv]] = catenary.tangent();
        Ok(Self {
            axes_w: [horizontal_w, up_w, horizontal_w.cross(&up_w)],
            lever_w: state.lever_w,
            length: rope.unstrained_length,
            axial_stiffness: rope.axial_stiffness,
            mass_per_length,
            stiffness: [hh, hv, vv, catenary.out_of_plane_stiffness()],
            direction_integrals: catenary.direction_integrals(),
            load: -rope.weight_per_length,
            points,
            elements,
            inertia,
            end: None,
        })
    }

    /// Adds `factor` times the coefficients of W(a, b) at a frequency; `own_square` is ω² of the drive.
    pub(super) fn add<T: Field>(
        &self,
        sum: &mut CableAdjoint<T>,
        a: &CableMotion<T>,
        b: &CableMotion<T>,
        at: (T, &CableAt<T>),
        factor: T,
    ) {
        self.add_beside(sum, a, b, &Sides::still(), at, factor);
    }

    /// Adds `factor` times the coefficients of W(a, b) at a frequency, with flexible supports that move the entry point
    /// along the drum side. The result are the forces of the drum side on the entry point.
    pub(super) fn add_beside<T: Field>(
        &self,
        sum: &mut CableAdjoint<T>,
        a: &CableMotion<T>,
        b: &CableMotion<T>,
        sides: &Sides<T>,
        (own_square, at): (T, &CableAt<T>),
        factor: T,
    ) -> SideForces<T> {
        let mut integrals = self.tension_integrals(&a.tension, &b.tension);
        let mut by_stretch = integrals.along * (1.0 / self.axial_stiffness);
        if let Some(stretch) = at.stretch {
            self.add_stretch(&mut integrals, (&a.tension, &b.tension), stretch);
            by_stretch = by_stretch / (stretch * stretch);
        }
        sum.stretch_loss.iter_mut().zip(at.by_loss).for_each(|(sum, by)| *sum += factor * by_stretch * by);
        let mut moved = T::default();
        for ((point, u), w) in self.points.iter().zip(&a.displacement).zip(&b.displacement) {
            moved += dot(u, w) * point.weight;
        }

        // The free span.
        let (force_w, load_w) = (self.world(&integrals.by_force), self.world(&integrals.by_load));
        add_times(&mut sum.force, &force_w, factor);
        add_times(&mut sum.load, &load_w, -(factor * self.length));
        let inertia = at.square * moved;
        let strained = (integrals.work + inertia * self.mass_per_length) * (1.0 / self.length);
        sum.free_length += -(factor * (integrals.by_load[1] * self.load + strained));
        sum.stiffness += factor * integrals.squares * self.axial_stiffness.powi(-2);
        sum.mass += -(factor * inertia);

        // The ends turn with their lever arms.
        let turned = add(&cross(&a.end_force_w, &b.theta), &cross(&b.end_force_w, &a.theta));
        add_times(&mut sum.lever, &turned, factor);

        // ω_c² depends on mass per length and damping.
        let (rope_of_drive, on_side) = self.add_far_end(sum, (a, b), sides, (own_square, at), factor);
        let by_square = -(factor * (moved * self.mass_per_length + rope_of_drive));
        sum.mass += by_square * at.by_damping[0];
        sum.damping += by_square * at.by_damping[1];
        on_side
    }

    /// Adds the coefficients of the far end, which turns with its directions and whose stiffness changes. The result is
    /// the mass of the rope of the drive over both motions, and the forces of the drum side on its entry point.
    fn add_far_end<T: Field>(
        &self,
        sum: &mut CableAdjoint<T>,
        (a, b): (&CableMotion<T>, &CableMotion<T>),
        sides: &Sides<T>,
        (own_square, at): (T, &CableAt<T>),
        factor: T,
    ) -> (T, SideForces<T>) {
        let (mut rope, mut on_side) = (T::default(), [T::default(); 2]);

        match &self.inertia {
            Inertia::Modes(vibrating) => {
                if let Some(VibratingEnd { form, .. }) = &vibrating.drive {
                    let along = &vibrating.along;
                    let at = at.of_drive(own_square);
                    (rope, on_side) = form.add(sum, (&a.end, &b.end), sides, &at, factor);
                    let slips = form.chain().is_some().then_some(0);
                    self.add_turn(sum, a, b, [slips, form.sideways().map(|_| *along)], factor);
                }
            }
            Inertia::None | Inertia::Massless => {
                if let Some(of) = &self.end {
                    on_side = of.add(sum, (&a.end, &b.end), &sides.along, (at.stretch, at.by_loss), factor);
                    self.add_turn(sum, a, b, [Some(0), Some(1)], factor);
                }
            }
        }
        (rope, on_side)
    }

    /// Integrals along the cable over two changes of the tension vector.
    #[inline]
    fn tension_integrals<T: Field>(&self, a: &[Vector<T>], b: &[Vector<T>]) -> TensionIntegrals<T> {
        let zero = T::default();
        let (mut by_force, mut by_load) = ([zero; 3], [zero; 3]);
        let (mut squares, mut work, mut along) = (zero, zero, zero);
        for ((point, u), w) in self.points.iter().zip(a).zip(b) {
            // Third derivative of |N| along both changes.
            let [h, v] = point.direction;
            let (along_u, along_w) = (u[0] * h + u[1] * v, w[0] * h + w[1] * v);
            let across_u = [u[0] - along_u * h, u[1] - along_u * v, u[2]];
            let across_w = [w[0] - along_w * h, w[1] - along_w * v, w[2]];
            let product = dot(&across_u, &across_w);
            let size = point.weight / (point.tension * point.tension);
            let mut third: Vector<T> = from_fn(|k| across_w[k] * along_u + across_u[k] * along_w);
            third[0] += product * h;
            third[1] += product * v;
            for k in 0..3 {
                let value = third[k] * size;
                by_force[k] += value;
                by_load[k] += value * point.fraction;
            }

            let both_along = along_u * along_w;
            let both = product + both_along;
            along += both_along * point.weight;
            squares += both * point.weight;
            work += (both * (1.0 / self.axial_stiffness) + product * (1.0 / point.tension)) * point.weight;
        }
        TensionIntegrals { by_force, by_load, squares, work, along }
    }

    /// Adds to integrals over two changes of the tension vector what the factor h of the axial stiffness changes.
    fn add_stretch<T: Field>(
        &self,
        integrals: &mut TensionIntegrals<T>,
        (a, b): (&[Vector<T>], &[Vector<T>]),
        stretch: T,
    ) {
        let StretchIntegrals { turned, turned_by_load } = self.stretch_integrals(a, b);
        let more = self.more_compliance(stretch);
        for k in 0..3 {
            integrals.by_force[k] += -(more * turned[k]);
            integrals.by_load[k] += -(more * turned_by_load[k]);
        }
        integrals.squares += integrals.along * (T::from(1.0) / stretch - T::from(1.0));
        integrals.work += integrals.along * more;
    }

    fn stretch_integrals<T: Field>(&self, a: &[Vector<T>], b: &[Vector<T>]) -> StretchIntegrals<T> {
        let zero = [T::default(); 3];
        let mut sum = StretchIntegrals { turned: zero, turned_by_load: zero };
        for ((point, u), w) in self.points.iter().zip(a).zip(b) {
            let [h, v] = point.direction;
            let (along_u, along_w) = (u[0] * h + u[1] * v, w[0] * h + w[1] * v);
            let across = |of: &Vector<T>, along: T| [of[0] - along * h, of[1] - along * v, of[2]];
            let (across_u, across_w) = (across(u, along_u), across(w, along_w));
            let size = point.weight / point.tension;
            for k in 0..3 {
                let value = (across_w[k] * along_u + across_u[k] * along_w) * size;
                sum.turned[k] += value;
                sum.turned_by_load[k] += value * point.fraction;
            }
        }
        sum
    }

    /// Compliance of the stretch beyond 1/EA, `1/(EA h) − 1/EA` [1/N].
    fn more_compliance<T: Field>(&self, stretch: T) -> T {
        (T::from(1.0) / stretch - T::from(1.0)) * (1.0 / self.axial_stiffness)
    }

    /// Adds `factor` times the coefficients of the forces of a signal on the drive, over another motion, the first of
    /// `side`. The result is the force of the drum side on its entry point.
    pub(super) fn add_signal<T: Field>(
        &self,
        sum: &mut CableAdjoint<T>,
        (signal, servo): (DriveSignal, Option<&Servo>),
        (other, side): (&CableMotion<T>, &Sides<T>),
        (own_square, at): (T, &CableAt<T>),
        factor: T,
    ) -> T {
        let Inertia::Modes(vibrating) = &self.inertia else { return T::default() };
        let Some(VibratingEnd { form, .. }) = &vibrating.drive else { return T::default() };
        let frequency = at.of_drive(own_square);
        form.add_signal(sum, signal, (other.of_drive(), side), (&frequency, servo, at.by_damping), factor)
    }

    /// Adds the coefficients of the directions in which the far end moves: along the cable and sideways, by their
    /// places among its motions.
    fn add_turn<T: Field>(
        &self,
        sum: &mut CableAdjoint<T>,
        a: &CableMotion<T>,
        b: &CableMotion<T>,
        places: [Option<usize>; 2],
        factor: T,
    ) {
        let [force_a, force_b] = [a, b].map(|motion| self.world(&motion.far_force));
        for (first, place) in [end::TRAVEL, end::SIDEWAYS].into_iter().zip(places) {
            let Some(i) = place else { continue };
            for k in 0..3 {
                sum.end[first + k] += factor * (force_a[k] * b.end[i] + force_b[k] * a.end[i]);
            }
        }
    }

    /// Components of a vector in the axes of the cable.
    fn local<T: Field>(&self, of_w: &Vector<T>) -> Vector<T> {
        from_fn(|k| dot(of_w, &vector(&self.axes_w[k])))
    }

    /// World components of a vector in the axes of the cable.
    fn world<T: Field>(&self, local: &Vector<T>) -> Vector<T> {
        from_fn(|k| local[0] * self.axes_w[0][k] + local[1] * self.axes_w[1][k] + local[2] * self.axes_w[2][k])
    }
}

/// Curve of the cable; ideal cables have none.
fn hanging(state: &CableState) -> Result<&HangingCable, GradientError> {
    Ok(state.hanging.as_ref().ok_or(StaticDerivativeError::Ideal)?)
}
