//! Quadratic form `aᵀ D(ω) b` of the whole robot over two motions, and its coefficients over the state at rest.

use super::GradientError;
use super::adjoint::{Adjoint, CableAdjoint};
use super::cable_form::{CableAt, CableForm, CableMotion};
use super::drive_form::ControlAt;
use super::end_form::{EndAtRest, StretchAt};
use super::scalar::{Field, Vector, add, add_times, cross, dot, symmetric_outer, times, vector};
use super::support_form::{Carrier, SideForces, Sides, SupportForm};
use crate::cable::CableModel;
use crate::cable::catenary_dynamic::{DriveSignal, Family, MovingEnd};
use crate::drive::derivatives::end;
use crate::dynamics::{Assembly, Dynamics, Linearisation};
use crate::math::Vec3;
use crate::robot::{Cable, Robot, Servo};
use crate::statics::derivatives::StaticDerivativeError;
use crate::statics::{CableState, Equilibrium};

/// Quadratic form of a robot about an equilibrium.
pub(super) struct RobotForm {
    cables: Vec<AnyCable>,
    /// Force at the centre of mass and arm of that centre; force of the load and arm of its point.
    dead: [(Vec3, Vec3); 2],
    /// Force and lever arm of each cable.
    levers: Vec<(Vec3, Vec3)>,
    mass: f64,
    /// Position control of each motor that moves.
    servos: Vec<Option<Servo>>,
    /// Flexible supports; `None` on a rigid frame.
    pub(super) supports: Option<SupportForm>,
}

/// Form of one cable by its model.
enum AnyCable {
    /// Cable of the catenary models.
    Catenary(Box<CableForm>),
    /// Spring EA/L₀ along the chord, with its end at the pulley or the winch.
    Spring(Box<SpringForm>),
}

/// Spring along the chord of a cable.
struct SpringForm {
    chord_w: Vec3,
    lever_w: Vec3,
    /// EA and unstrained length L₀ of the free span.
    axial_stiffness: f64,
    length: f64,
    end: Option<EndAtRest>,
}

/// Motion of the whole robot, world axes.
pub(super) struct FormMotion<T> {
    v: Vector<T>,
    theta: Vector<T>,
    cables: Vec<Option<CableMotion<T>>>,
    /// Displacements of the supports.
    supports: Vec<Vector<T>>,
}

impl<T> FormMotion<T> {
    /// Motion of a cable; `None` for a spring.
    pub(super) fn cable(&self, i: usize) -> Option<&CableMotion<T>> {
        self.cables[i].as_ref()
    }
}

/// Amplitude of a clamped mode that does not follow from the platform: cable among those whose stiffness depends on
/// frequency, family, index, amplitude.
pub(super) type NearAmplitude<T> = (usize, Family, usize, T);

/// Complex frequency at which a form is evaluated.
pub(super) struct At<T> {
    /// Square ω².
    pub(super) square: T,
    /// Factor iω of the damping of the platform; zero for undamped motions.
    pub(super) rate: T,
    /// Factor of the losses 2ζ of the supports: i, or zero for undamped motions.
    pub(super) loss: T,
    /// The cables, in file order.
    pub(super) cables: Vec<CableAt<T>>,
}

/// Motions and forces that move the robot besides the platform: supports, given amplitudes of clamped modes, and forces
/// on the drive of one cable.
pub(super) struct Driven<'a, T> {
    /// Displacements of flexible supports; none on a rigid frame.
    pub(super) supports: &'a [Vector<T>],
    /// Amplitudes of clamped modes near the frequency.
    pub(super) near: &'a [NearAmplitude<T>],
    /// Cable with forces on the motions of its drive.
    pub(super) forces: Option<(usize, &'a [T])>,
}

impl RobotForm {
    /// Form of the dynamic stiffness. `settled` is the robot with rigid supports where they are at rest.
    pub(super) fn of_dynamics(
        (robot, settled): (&Robot, &Robot),
        equilibrium: &Equilibrium,
        dynamics: &Dynamics,
    ) -> Result<Self, GradientError> {
        let Linearisation { cable_model, assembly, in_plane_only, winches, .. } = dynamics.linearisation;
        if assembly != Assembly::Consistent || in_plane_only {
            return Err(GradientError::Terms);
        }

        let mut cables = Vec::with_capacity(robot.cables.len());
        let mut servos = vec![None; robot.cables.len()];
        for (i, state) in equilibrium.cables.iter().enumerate() {
            let cable = &settled.cables[i];
            let term = dynamics.terms().iter().position(|term| term.cable() == i && !dynamics.is_at_rest(i));
            cables.push(match (cable_model, term.and_then(|term| dynamics.terms()[term].form().by_poles())) {
                (CableModel::Spring, _) => AnyCable::Spring(Box::new(SpringForm::of(cable, state)?)),
                (CableModel::CatenaryStatic, _) => {
                    AnyCable::Catenary(Box::new(CableForm::at_rest(&cable.anchor, state, false)?))
                }
                (CableModel::CatenaryDynamic, Some(end)) => {
                    servos[i] = end.cable.end.as_ref().and_then(MovingEnd::chain).and_then(|chain| chain.motor?.servo);
                    let both = dynamics.supports().and_then(|supports| supports.both_ends(term?));
                    AnyCable::Catenary(Box::new(CableForm::vibrating(cable, state, (end, both), winches)?))
                }
                (CableModel::CatenaryDynamic, _) => {
                    AnyCable::Catenary(Box::new(CableForm::at_rest(&cable.anchor, state, true)?))
                }
                (CableModel::ShallowStatic | CableModel::ShallowDynamic, _) => {
                    return Err(GradientError::Model(cable_model));
                }
            });
        }
        let has_rods = cable_model == CableModel::CatenaryDynamic;
        Ok(Self { servos, ..Self::with_cables((robot, settled), equilibrium, cables, has_rods) })
    }

    /// Form of the static stiffness. `settled` is the robot with rigid supports where they are at rest.
    pub(super) fn of_statics(
        (robot, settled): (&Robot, &Robot),
        equilibrium: &Equilibrium,
    ) -> Result<Self, GradientError> {
        let cables = (equilibrium.cables.iter().enumerate())
            .map(|(i, state)| {
                Ok(AnyCable::Catenary(Box::new(CableForm::at_rest(&settled.cables[i].anchor, state, false)?)))
            })
            .collect::<Result<_, GradientError>>()?;
        Ok(Self::with_cables((robot, settled), equilibrium, cables, false))
    }

    fn with_cables(
        (robot, settled): (&Robot, &Robot),
        equilibrium: &Equilibrium,
        cables: Vec<AnyCable>,
        has_rods: bool,
    ) -> Self {
        let (rot, platform, load) = (&equilibrium.pose.rot_wp, &robot.platform, &robot.load);
        let center = (robot.force_at_mass_centre_w(), rot * platform.center_of_mass_p);
        let of_cable = |state: &CableState| (state.force_on_platform_w, state.lever_w);
        Self {
            cables,
            dead: [center, (load.force_w, rot * load.point_p)],
            levers: equilibrium.cables.iter().map(of_cable).collect(),
            mass: platform.mass,
            servos: vec![None; settled.cables.len()],
            supports: SupportForm::of(robot, equilibrium, has_rods),
        }
    }

    /// Undamped frequency [rad/s].
    pub(super) fn undamped(&self, omega: f64) -> At<f64> {
        let square = omega * omega;
        let cable = |servo: &Option<Servo>| CableAt {
            square,
            control: ControlAt::undamped(servo.as_ref()),
            ..CableAt::default()
        };
        At { square, rate: 0.0, loss: 0.0, cables: self.servos.iter().map(cable).collect() }
    }

    /// Motion with the platform: translation of its origin and rotation, world axes. `terms` are the cables whose
    /// stiffness depends on frequency.
    pub(super) fn motion<T: Field>(
        &self,
        v: Vector<T>,
        theta: Vector<T>,
        at: &At<T>,
        terms: &[usize],
        driven: &Driven<T>,
    ) -> FormMotion<T> {
        let of_cable = |(i, cable): (usize, &AnyCable)| match cable {
            AnyCable::Spring(_) => None,
            AnyCable::Catenary(form) => {
                let own: Vec<(Family, usize, T)> = (driven.near.iter())
                    .filter(|(term, ..)| terms.get(*term) == Some(&i))
                    .map(|(_, family, index, amplitude)| (*family, *index, *amplitude))
                    .collect();
                let forces = driven.forces.filter(|(cable, _)| *cable == i).map_or(&[][..], |(_, forces)| forces);
                let carrier = self.supports.as_ref().and_then(|supports| supports.carrier(i, driven.supports));
                Some(form.motion((&v, &theta), carrier.as_ref(), &at.cables[i], &own, forces))
            }
        };

        let cables = self.cables.iter().enumerate().map(of_cable).collect();
        FormMotion { v, theta, cables, supports: driven.supports.to_vec() }
    }

    /// Adds `factor` times the coefficients of the forces of a drive's signal, over another motion.
    pub(super) fn add_signal<T: Field>(
        &self,
        sum: &mut Adjoint<T>,
        (i, signal): (usize, DriveSignal),
        other: &FormMotion<T>,
        at: &At<T>,
        factor: T,
    ) {
        if let (AnyCable::Catenary(form), Some(motion)) = (&self.cables[i], other.cable(i)) {
            let signal = (signal, self.servos[i].as_ref());
            let side = match &self.supports {
                Some(supports) => supports.sides(i, &other.supports, &other.supports),
                None => Sides::still(),
            };
            let of_cable = &mut sum.cables[i];
            let force = form.add_signal(of_cable, signal, (motion, &side), (at.square, &at.cables[i]), factor);
            if let Some(supports) = &self.supports {
                supports.add_side_force(of_cable, i, &other.supports, factor * force);
            }
        }
    }

    /// Adds `factor` times the coefficients of the form over two motions.
    pub(super) fn add<T: Field>(
        &self,
        sum: &mut Adjoint<T>,
        a: &FormMotion<T>,
        b: &FormMotion<T>,
        at: &At<T>,
        factor: T,
    ) {
        self.add_platform(sum, a, b, at, factor);
        for (i, cable) in self.cables.iter().enumerate() {
            let of_cable = &mut sum.cables[i];
            let (f, r) = &self.levers[i];
            let (force, lever) = lever_coefficients(&vector(f), &vector(r), &a.theta, &b.theta);
            add_times(&mut of_cable.force, &force, factor);
            add_times(&mut of_cable.lever, &lever, factor);

            let sides = match &self.supports {
                Some(supports) => supports.sides(i, &a.supports, &b.supports),
                None => Sides::still(),
            };
            let on_side = match (cable, &a.cables[i], &b.cables[i]) {
                (AnyCable::Catenary(form), Some(a), Some(b)) => {
                    form.add_beside(of_cable, a, b, &sides, (at.square, &at.cables[i]), factor)
                }
                (AnyCable::Spring(spring), ..) => {
                    let carriers = [a, b].map(|of| self.supports.as_ref()?.carrier(i, &of.supports));
                    let stretch = (at.cables[i].stretch, at.cables[i].by_loss);
                    spring.add(of_cable, (&a.v, &a.theta), (&b.v, &b.theta), (&carriers, stretch), factor)
                }
                _ => unreachable!("every catenary has its motion"),
            };
            if let Some(supports) = &self.supports {
                supports.add_cable(of_cable, i, (&a.supports, &b.supports), &on_side, (at.square, factor));
            }
        }
        if let Some(supports) = &self.supports {
            supports.add_own(sum, (&a.supports, &b.supports), (at.square, at.loss), factor);
        }
    }

    /// Adds `factor` times the coefficients of the platform and of the dead forces on it.
    fn add_platform<T: Field>(
        &self,
        sum: &mut Adjoint<T>,
        a: &FormMotion<T>,
        b: &FormMotion<T>,
        at: &At<T>,
        factor: T,
    ) {
        // Inertia of the platform.
        let center: Vector<T> = vector(&self.dead[0].1);
        let [u_a, u_b] = [a, b].map(|motion| add(&motion.v, &cross(&motion.theta, &center)));
        let by_inertia = -(factor * at.square);
        sum.mass += by_inertia * dot(&u_a, &u_b);
        let turned = add(&cross(&u_a, &b.theta), &cross(&u_b, &a.theta));
        add_times(&mut sum.center, &turned, by_inertia * self.mass);
        let add_outer = |sum: &mut [Vector<T>; 3], a: &Vector<T>, b: &Vector<T>, factor: T| {
            for (sum, row) in sum.iter_mut().zip(symmetric_outer(a, b)) {
                add_times(sum, &row, factor);
            }
        };
        add_outer(&mut sum.inertia, &a.theta, &b.theta, by_inertia);

        // Damping of the platform.
        add_outer(&mut sum.translational_damping, &a.v, &b.v, factor * at.rate);
        add_outer(&mut sum.rotational_damping, &a.theta, &b.theta, factor * at.rate);

        // Dead forces on their arms.
        let [(weight, center), (force, point)] =
            self.dead.map(|(force, arm)| lever_coefficients(&vector(&force), &vector(&arm), &a.theta, &b.theta));
        add_times(&mut sum.weight, &weight, factor);
        add_times(&mut sum.center, &center, factor);
        add_times(&mut sum.force, &force, factor);
        add_times(&mut sum.point, &point, factor);
    }
}

impl SpringForm {
    fn of(cable: &Cable, state: &CableState) -> Result<Self, GradientError> {
        let (chord_w, axial_stiffness) = (state.chord_w(), cable.material.axial_stiffness);
        let hanging = state.hanging.as_ref().ok_or(StaticDerivativeError::Ideal)?;
        let length = hanging.catenary.rope().unstrained_length;
        let held = chord_w * chord_w.transpose() * (axial_stiffness / (length * chord_w.norm_squared()));
        let end = EndAtRest::of(&cable.anchor, state.drive.as_deref(), &held);
        Ok(Self { chord_w, lever_w: state.lever_w, axial_stiffness, length, end })
    }

    /// Adds `factor` times the coefficients of `(EA/L₀)(u_a·e)(u_b·e)` over two motions (translation, rotation) of the
    /// platform: by the chord, by the arm of the ends, by EA, by L₀; u is the motion of the platform end less that of
    /// the far end, e the direction of the chord. The result are the forces of a drum side from the ground on its entry
    /// point, which flexible supports move.
    fn add<T: Field>(
        &self,
        sum: &mut CableAdjoint<T>,
        a: (&Vector<T>, &Vector<T>),
        b: (&Vector<T>, &Vector<T>),
        (carriers, (stretch, by_loss)): (&[Option<Carrier<T>>; 2], StretchAt<T>),
        factor: T,
    ) -> SideForces<T> {
        let (chord, lever) = (vector(&self.chord_w), vector(&self.lever_w));
        let [end_a, end_b] = [a, b].map(|(v, theta)| add(v, &cross(theta, &lever)));
        let per_stiffness = 1.0 / (self.length * self.chord_w.norm_squared());
        let pull = |moved: &Vector<T>| {
            let force = dot(moved, &chord) * (self.axial_stiffness * per_stiffness);
            times(&chord, stretch.map_or(force, |stretch| force * stretch))
        };
        let followed = |start: &Vector<T>, carrier: &Option<Carrier<T>>| -> ([T; 2], Vector<T>) {
            let (far, along) = carrier.map_or_else(Default::default, |of| (of.displacement_w, of.along));
            let start: Vector<T> = std::array::from_fn(|k| start[k] - far[k]);
            let at_end = self.end.as_ref().map_or_else(Default::default, |of| of.motion(&start, along, stretch, pull));
            let moved = self.end.as_ref().map_or_else(Default::default, |of| of.displacement(&at_end));
            (at_end, std::array::from_fn(|k| start[k] - moved[k]))
        };
        let [(far_a, u_a), (far_b, u_b)] = [followed(&end_a, &carriers[0]), followed(&end_b, &carriers[1])];

        let squared = self.chord_w.norm_squared();
        let [along_a, along_b] = [dot(&u_a, &chord), dot(&u_b, &chord)];
        let by_factor = factor * along_a * along_b * (self.axial_stiffness * per_stiffness);
        sum.stretch_loss.iter_mut().zip(by_loss).for_each(|(sum, by)| *sum += by_factor * by);
        let stretched = stretch.map_or(factor, |stretch| factor * stretch);
        let size = stretched * (self.axial_stiffness * per_stiffness);
        let mut by_chord = add(&times(&u_a, along_b), &times(&u_b, along_a));
        add_times(&mut by_chord, &chord, -(along_a * along_b * (2.0 / squared)));
        add_times(&mut sum.chord, &by_chord, size);
        let by_end = add(&times(&cross(&chord, a.1), along_b), &times(&cross(&chord, b.1), along_a));
        add_times(&mut sum.lever, &by_end, size);
        sum.stiffness += stretched * along_a * along_b * per_stiffness;
        sum.free_length += -(size * along_a * along_b * (1.0 / self.length));

        let mut on_side = [T::default(); 2];
        if let Some(end) = &self.end {
            let sides = carriers.map(|carrier| carrier.map_or_else(T::default, |of| of.along));
            on_side = end.add(sum, (&far_a, &far_b), &sides, (stretch, by_loss), factor);
            for (first, i) in [(end::TRAVEL, 0), (end::SIDEWAYS, 1)] {
                for (sum, chord) in sum.end[first..].iter_mut().zip(chord) {
                    *sum += -(size * chord * (along_a * far_b[i] + along_b * far_a[i]));
                }
            }
        }
        on_side
    }
}

/// Coefficients of the geometric stiffness `(f·r)(θa·θb) − ½[(θa·r)(f·θb) + (θa·f)(r·θb)]` of a force on its lever arm,
/// by the force and by the arm. It is symmetrised, which at an equilibrium changes nothing.
fn lever_coefficients<T: Field>(
    f: &Vector<T>,
    r: &Vector<T>,
    theta_a: &Vector<T>,
    theta_b: &Vector<T>,
) -> (Vector<T>, Vector<T>) {
    let both = dot(theta_a, theta_b);
    let of = |other: &Vector<T>| {
        let mut sum = times(other, both);
        add_times(&mut sum, theta_a, dot(other, theta_b) * -0.5);
        add_times(&mut sum, theta_b, dot(other, theta_a) * -0.5);
        sum
    };
    (of(r), of(f))
}
