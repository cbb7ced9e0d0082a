//! Quadratic form `aᵀ D(ω) b` of the whole robot over two motions, and its coefficients over the state at rest.

use super::GradientError;
use super::adjoint::Adjoint;
use super::cable_form::{CableForm, CableMotion};
use super::scalar::{Field, Vector, add, add_times, cross, dot, outer, times, vector};
use crate::cable::catenary_dynamic::Family;
use crate::cable::{CableModel, DynamicCable};
use crate::dynamics::{Assembly, DynamicCableAt, Dynamics, Linearisation};
use crate::math::Vec3;
use crate::robot::Robot;
use crate::statics::{CableState, Equilibrium};

/// Robot about an equilibrium, with what its form needs.
pub(super) struct RobotForm {
    cables: Vec<AnyCable>,
    /// Force at the centre of mass and arm of that centre; force of the load and arm of its point.
    dead: [(Vec3, Vec3); 2],
    /// Force and lever arm of each cable.
    levers: Vec<(Vec3, Vec3)>,
    mass: f64,
}

/// Form of one cable by its model.
enum AnyCable {
    /// Cable of the catenary models.
    Catenary(Box<CableForm>),
    /// Spring EA/l along the chord.
    Spring { chord_w: Vec3, lever_w: Vec3, axial_stiffness: f64 },
}

/// Motion of the whole robot, world axes.
pub(super) struct RobotMotion<T> {
    v: Vector<T>,
    theta: Vector<T>,
    cables: Vec<Option<CableMotion<T>>>,
}

/// Amplitude of a clamped mode that does not follow from the platform: cable among those whose stiffness depends on
/// frequency, family, index, amplitude.
pub(super) type NearAmplitude<T> = (usize, Family, usize, T);

/// Complex frequency at which a form is taken.
pub(super) struct At<T> {
    /// Square ω².
    pub(super) square: T,
    /// Factor iω of the damping of the platform; zero for undamped motions.
    pub(super) rate: T,
    /// Square ω_c² of each cable.
    pub(super) of_cables: Vec<T>,
    /// Derivatives of ω_c² of each cable by mass per length and by damping.
    pub(super) by_damping: Vec<[T; 2]>,
}

impl<T: Field> At<T> {
    /// Undamped frequency [rad/s].
    pub(super) fn undamped(omega: f64, cables: usize) -> Self {
        let square = T::from(omega * omega);
        let zero = T::default();
        Self { square, rate: zero, of_cables: vec![square; cables], by_damping: vec![[zero; 2]; cables] }
    }
}

impl RobotForm {
    /// Form of the dynamic stiffness.
    pub(super) fn of_dynamics(
        robot: &Robot,
        equilibrium: &Equilibrium,
        dynamics: &Dynamics,
    ) -> Result<Self, GradientError> {
        let Linearisation { cable_model, assembly, in_plane_only, .. } = dynamics.linearisation;
        if assembly != Assembly::Consistent || in_plane_only {
            return Err(GradientError::Terms);
        }

        let mut cables = Vec::with_capacity(robot.cables.len());
        for (i, state) in equilibrium.cables.iter().enumerate() {
            let term = dynamics.terms().iter().find(|term| term.cable() == i);
            if state.drive.is_some() && cable_model != CableModel::CatenaryStatic {
                return Err(GradientError::Drive { cable: robot.cables[i].name.clone() });
            }
            cables.push(match (cable_model, term.map(DynamicCableAt::form)) {
                (CableModel::Spring, _) => AnyCable::Spring {
                    chord_w: state.chord_w(),
                    lever_w: state.lever_w,
                    axial_stiffness: robot.cables[i].material.axial_stiffness,
                },
                (CableModel::CatenaryStatic, _) => {
                    AnyCable::Catenary(Box::new(CableForm::at_rest(&robot.cables[i].anchor, state, false)?))
                }
                (CableModel::CatenaryDynamic, Some(DynamicCable::CatenaryDynamic(end))) => {
                    let name = &robot.cables[i].name;
                    AnyCable::Catenary(Box::new(CableForm::vibrating(state, end, name)?))
                }
                (CableModel::CatenaryDynamic, _) => {
                    AnyCable::Catenary(Box::new(CableForm::at_rest(&robot.cables[i].anchor, state, true)?))
                }
                (CableModel::ShallowStatic | CableModel::ShallowDynamic, _) => {
                    return Err(GradientError::Model(cable_model));
                }
            });
        }
        Ok(Self::with_cables(robot, equilibrium, cables))
    }

    /// Form of the static stiffness.
    pub(super) fn of_statics(robot: &Robot, equilibrium: &Equilibrium) -> Result<Self, GradientError> {
        let cables = (equilibrium.cables.iter().enumerate())
            .map(|(i, state)| {
                Ok(AnyCable::Catenary(Box::new(CableForm::at_rest(&robot.cables[i].anchor, state, false)?)))
            })
            .collect::<Result<_, GradientError>>()?;
        Ok(Self::with_cables(robot, equilibrium, cables))
    }

    fn with_cables(robot: &Robot, equilibrium: &Equilibrium, cables: Vec<AnyCable>) -> Self {
        let (rot, platform, load) = (&equilibrium.pose.rot_wp, &robot.platform, &robot.load);
        let center = (robot.force_at_mass_centre_w(), rot * platform.center_of_mass_p);
        let of_cable = |state: &CableState| (state.force_on_platform_w, state.lever_w);
        Self {
            cables,
            dead: [center, (load.force_w, rot * load.point_p)],
            levers: equilibrium.cables.iter().map(of_cable).collect(),
            mass: platform.mass,
        }
    }

    /// Motion with the platform: translation of its origin and rotation, world axes. `terms` are the cables whose stiffness
    /// depends on frequency.
    pub(super) fn motion<T: Field>(
        &self,
        v: Vector<T>,
        theta: Vector<T>,
        at: &At<T>,
        terms: &[usize],
        near: &[NearAmplitude<T>],
    ) -> RobotMotion<T> {
        let of_cable = |(i, cable): (usize, &AnyCable)| match cable {
            AnyCable::Spring { .. } => None,
            AnyCable::Catenary(form) => {
                let own: Vec<(bool, usize, T)> = (near.iter())
                    .filter(|(term, ..)| terms.get(*term) == Some(&i))
                    .map(|(_, family, index, amplitude)| (*family == Family::InPlane, *index, *amplitude))
                    .collect();
                Some(form.motion(&v, &theta, at.of_cables[i], &own))
            }
        };
        RobotMotion { v, theta, cables: self.cables.iter().enumerate().map(of_cable).collect() }
    }

    /// Adds `factor` times the coefficients of the form over two motions.
    pub(super) fn add<T: Field>(
        &self,
        sum: &mut Adjoint<T>,
        a: &RobotMotion<T>,
        b: &RobotMotion<T>,
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
            for (sum, row) in sum.iter_mut().zip(outer(a, b)) {
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

        for (i, cable) in self.cables.iter().enumerate() {
            let of_cable = &mut sum.cables[i];
            let (f, r) = &self.levers[i];
            let (force, lever) = lever_coefficients(&vector(f), &vector(r), &a.theta, &b.theta);
            add_times(&mut of_cable.force, &force, factor);
            add_times(&mut of_cable.lever, &lever, factor);
            match (cable, &a.cables[i], &b.cables[i]) {
                (AnyCable::Catenary(form), Some(a), Some(b)) => {
                    form.add(of_cable, a, b, at.of_cables[i], at.by_damping[i], factor);
                }
                (AnyCable::Spring { chord_w, lever_w, axial_stiffness }, ..) => {
                    let (chord, lever) = (vector(chord_w), vector(lever_w));
                    let [end_a, end_b] = [a, b].map(|motion| add(&motion.v, &cross(&motion.theta, &lever)));
                    // (EA/l³)(u_a·d)(u_b·d): by the chord, by the arm of the ends, by EA.
                    let (l, ea) = (chord_w.norm(), *axial_stiffness);
                    let [along_a, along_b] = [dot(&end_a, &chord), dot(&end_b, &chord)];
                    let size = factor * (ea / l.powi(3));
                    let mut by_chord = add(&times(&end_a, along_b), &times(&end_b, along_a));
                    add_times(&mut by_chord, &chord, -(along_a * along_b * (3.0 / (l * l))));
                    add_times(&mut of_cable.chord, &by_chord, size);
                    let by_end =
                        add(&times(&cross(&chord, &a.theta), along_b), &times(&cross(&chord, &b.theta), along_a));
                    add_times(&mut of_cable.lever, &by_end, size);
                    of_cable.stiffness += factor * along_a * along_b * l.powi(-3);
                }
                _ => unreachable!("every catenary has its motion"),
            }
        }
    }
}

/// Coefficients of the geometric stiffness `(f·r)(θa·θb) − ½[(θa·r)(f·θb) + (θa·f)(r·θb)]` of a force on its lever arm, by
/// the force and by the arm. It is symmetrised, which at an equilibrium changes nothing.
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
