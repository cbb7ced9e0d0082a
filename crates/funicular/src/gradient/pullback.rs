//! From the coefficients of a scalar over the state at rest to its gradient over the numbers of the robot.
//!
//! Forces follow from chords, lengths, loads and stiffness by the partial derivatives of each cable, and arms and
//! tensors turn with the platform. The motion of the platform, or the change of the lengths, is then the only other
//! unknown. A multiplier λ of the balance Φ takes its place: the coefficients of λ·Φ are added (docs/theory.md,
//! equations (60c) to (60f)).

use super::adjoint::{Adjoint, CableAdjoint, DriveAdjoint};
use super::at_limits::TensionsAtLimits;
use super::parallel_tension::ParallelTension;
use super::rule::RuleFollower;
use super::scalar::add_real;
use super::supports::{Followed, SupportedFollower, SupportsAtRest};
use super::{GradientError, Hold};
use crate::drive::derivatives::{DriveDerivatives, OuterRow, place};
use crate::math::{DMat, DVec, Mat3, Mat6, Vec3, Vec6, inverse6};
use crate::platform::Coordinates;
use crate::robot::{Cable, CableChange, Constraint, GuideWheelChange, PulleyChange, Robot, RobotChange, WinchChange};
use crate::statics::derivatives::{
    CablePartials, DrivePartials, StaticDerivativeError, check_regular, jacobian_of, regular,
};
use crate::statics::{Equilibrium, TensionRule};

/// Equilibrium, with the quantities that adapt to a change of the robot.
pub(super) struct Pullback<'a> {
    pub(super) robot: &'a Robot,
    pub(super) equilibrium: &'a Equilibrium,
    coordinates: Coordinates,
    cables: Vec<CablePartials>,
    /// Flexible supports; `None` on a rigid frame.
    pub(super) supports: Option<SupportsAtRest>,
    follower: Follower,
}

/// Quantities that adapt to a change of the robot while the others are held.
enum Follower {
    /// The pose adapts: inverse of 𝒥, transposed, in reduced coordinates.
    Pose(Mat6),
    /// The lengths adapt.
    Lengths {
        /// Pseudoinverse of the wrenches by lengths or by parallel tensions, transposed; one column per cable.
        pseudoinverse: DMat,
        /// Wrenches by lengths or by parallel tensions, reduced; one column per cable.
        wrenches: DMat,
        /// Parallel tension of each cable, if the cables are more than the degrees of freedom.
        tensions: Option<Vec<ParallelTension>>,
        /// Rule that the tensions follow. Without a rule, the change of the parallel tensions is minimum.
        rule: Option<Box<RuleFollower>>,
    },
    /// The displacements of flexible supports adapt, with the pose or the lengths.
    Supported(Hold, Box<SupportedFollower>),
}

/// Gradient with the motion of the platform as further coefficients.
struct Pulled {
    gradient: RobotChange,
    translation_w: Vec3,
    rotation_w: Vec3,
    /// Displacements of the supports, three coordinates each; none on a rigid frame.
    supports: Vec<f64>,
}

impl<'a> Pullback<'a> {
    pub(super) fn new(
        robot: &'a Robot,
        equilibrium: &'a Equilibrium,
        hold: Hold,
        rule: Option<&TensionRule>,
    ) -> Result<Self, GradientError> {
        // The cables, of a robot on flexible supports where these have settled.
        let coordinates = Coordinates::of(robot);
        let supports = SupportsAtRest::of(robot, equilibrium);
        let settled = supports.as_ref().map_or(robot, |supports| &supports.settled);
        let cables = (0..robot.cables.len())
            .map(|i| CablePartials::new(settled, equilibrium, i))
            .collect::<Result<Vec<_>, _>>()?;
        if supports.is_some() {
            return Self::with_supports(robot, equilibrium, hold, (coordinates, cables, supports));
        }

        let follower = match hold {
            Hold::Lengths => {
                let jacobian = jacobian_of(robot, equilibrium, cables.iter());
                let regular = regular(&coordinates.reduce_matrix(&jacobian), &coordinates)?;
                Follower::Pose(inverse6(&regular).ok_or(StaticDerivativeError::Singular)?.transpose())
            }
            Hold::Pose | Hold::Rule => Follower::of_lengths(robot, equilibrium, &coordinates, &cables, rule)?,
        };
        Ok(Self { robot, equilibrium, coordinates, cables, supports, follower })
    }

    /// Gradients of a robot on flexible supports.
    fn with_supports(
        robot: &'a Robot,
        equilibrium: &'a Equilibrium,
        hold: Hold,
        (coordinates, cables, supports): (Coordinates, Vec<CablePartials>, Option<SupportsAtRest>),
    ) -> Result<Self, GradientError> {
        let follower = Follower::Pose(Mat6::zeros());
        let mut all = Self { robot, equilibrium, coordinates, cables, supports, follower };
        let (count, degrees_of_freedom) = (all.cables.len(), all.coordinates.count());
        if hold == Hold::Rule && robot.constraint().is_redundant() {
            let is_carried = |cable: &&Cable| cable.anchor.support.is_some();
            let cable = robot.cables.iter().find(is_carried).map_or_else(String::new, |cable| cable.name.clone());
            return Err(GradientError::RuleAndSupports { cable });
        }
        if hold != Hold::Lengths && robot.constraint().is_under() {
            return Err(StaticDerivativeError::TooFewCables { cables: count, degrees_of_freedom }.into());
        }

        // Coefficients of the unknowns in the balances of platform and supports, with unit multipliers.
        let of_platform: Vec<Followed> = (0..degrees_of_freedom)
            .map(|k| {
                let mut scalar = Adjoint::zeros(count);
                let unit = Vec6::from_fn(|i, _| f64::from(u8::from(i == k)));
                all.add_balance(&mut scalar, &all.coordinates.expand(&unit));
                all.followed(&scalar, hold)
            })
            .collect();
        let units = all.supports.iter().flat_map(SupportsAtRest::units);
        let of_supports: Vec<Followed> = units.map(|scalar| all.followed(&scalar, hold)).collect();

        // With redundant cables the change of the parallel tensions is minimum.
        let tensions = if hold == Hold::Lengths || robot.constraint() == Constraint::Fully {
            None
        } else {
            let tensions = all.parallel_tensions()?;
            let followed = tensions.iter().enumerate().map(|(i, tension)| {
                let mut scalar = Adjoint::zeros(count);
                tension.add(&mut scalar.cables[i], 1.0);
                all.followed(&scalar, hold)
            });
            let followed = followed.collect();
            Some((tensions, followed))
        };
        all.follower =
            Follower::Supported(hold, Box::new(SupportedFollower::new(&of_platform, &of_supports, tensions)?));
        Ok(all)
    }

    /// Robot with rigid supports where they are at rest.
    pub(super) fn settled(&self) -> &Robot {
        self.supports.as_ref().map_or(self.robot, |supports| &supports.settled)
    }

    /// Coefficients of the quantities that adapt with this hold.
    fn followed(&self, scalar: &Adjoint<f64>, hold: Hold) -> Followed {
        let Pulled { gradient, translation_w, rotation_w, supports } = self.pulled(scalar);
        let first = if hold == Hold::Lengths {
            let reduced = self.coordinates.reduce(&six(&translation_w, &rotation_w));
            DVec::from_iterator(self.coordinates.count(), reduced.iter().copied().take(self.coordinates.count()))
        } else {
            DVec::from_iterator(self.cables.len(), gradient.cables.iter().map(|cable| cable.unstrained_length))
        };
        Followed { first, supports: DVec::from_vec(supports) }
    }

    /// Partial derivatives of each cable.
    pub(super) fn partials(&self) -> &[CablePartials] {
        &self.cables
    }

    /// Parallel tension of each cable.
    pub(super) fn parallel_tensions(&self) -> Result<Vec<ParallelTension>, GradientError> {
        parallel_tensions(self.settled(), self.equilibrium, &self.cables)
    }

    /// Gradient of the scalar with these coefficients.
    pub(super) fn gradient(&self, scalar: &Adjoint<f64>) -> RobotChange {
        match &self.follower {
            Follower::Pose(inverse) => {
                let direct = self.pulled(scalar);
                let motion = six(&direct.translation_w, &direct.rotation_w);
                let multiplier = self.coordinates.expand(&(inverse * self.coordinates.reduce(&motion)));
                let mut total = scalar.clone();
                self.add_balance(&mut total, &multiplier);
                self.pulled(&total).gradient
            }
            Follower::Lengths { pseudoinverse, wrenches, tensions, rule } => {
                let direct = self.pulled(scalar);
                let n = self.coordinates.count();

                // Coefficients of the lengths, or of the parallel tensions that stand for them.
                let mut of_lengths = DMat::zeros(self.cables.len(), 1);
                for (i, cable) in direct.gradient.cables.iter().enumerate() {
                    let per_unknown = tensions.as_ref().map_or(1.0, |tensions| tensions[i].by_length);
                    of_lengths[(i, 0)] = cable.unstrained_length / per_unknown;
                }
                let mut total = scalar.clone();
                let reduced = if let Some(rule) = rule {
                    rule.follow(&mut total, &of_lengths)
                } else {
                    let solved = pseudoinverse * &of_lengths;
                    let reduced = Vec6::from_fn(|k, _| if k < n { -solved[(k, 0)] } else { 0.0 });

                    // With redundant cables the change of the parallel tensions is minimum: the part of the
                    // coefficients that the balance does not take away belongs to them.
                    if let Some(tensions) = tensions {
                        let left = -(wrenches.transpose() * -solved + &of_lengths);
                        for ((cable, tension), left) in total.cables.iter_mut().zip(tensions).zip(left.iter()) {
                            tension.add(cable, *left);
                        }
                    }
                    reduced
                };
                self.add_balance(&mut total, &self.coordinates.expand(&reduced));
                self.at_held_pose(&total)
            }
            Follower::Supported(hold, follower) => {
                let multipliers = follower.multipliers(self.followed(scalar, *hold));
                let mut total = scalar.clone();
                let n = self.coordinates.count();
                let reduced = Vec6::from_fn(|k, _| if k < n { multipliers.platform[k] } else { 0.0 });
                self.add_balance(&mut total, &self.coordinates.expand(&reduced));
                if let Some(supports) = &self.supports {
                    follower.add(&mut total, supports, &multipliers);
                }
                if *hold == Hold::Lengths { self.pulled(&total).gradient } else { self.at_held_pose(&total) }
            }
        }
    }

    /// Gradient by coefficients that contain the multipliers of a held pose.
    pub(super) fn at_held_pose(&self, total: &Adjoint<f64>) -> RobotChange {
        let Pulled { mut gradient, translation_w, rotation_w, .. } = self.pulled(total);
        for (cable, partials) in gradient.cables.iter_mut().zip(&self.cables) {
            // The coefficients of the lengths are zero but for rounding. A stiffer rope has the same effect as a longer
            // one, so the derivative with respect to the stiffness, which is small here, has the same rounding. It is
            // subtracted from both, because the derivative would have few digits otherwise.
            let (by_stiffness, by_length) = (partials.force_by_stiffness_w, partials.force_by_length_w);
            let as_length = by_stiffness.dot(&by_length) / by_length.norm_squared();
            cable.axial_stiffness -= as_length * cable.unstrained_length;
            cable.unstrained_length = 0.0;
        }
        let motion = self.robot.platform.motion.allowed(&six(&translation_w, &rotation_w));
        gradient.position_w = Vec3::new(motion[0], motion[1], motion[2]);
        gradient.rotation_w = Vec3::new(motion[3], motion[4], motion[5]);
        gradient
    }

    /// Adds the coefficients of λ·Φ, the product of a multiplier (moments over ℓ) with the wrench on the platform.
    pub(super) fn add_balance(&self, total: &mut Adjoint<f64>, multiplier: &Vec6) {
        let v = Vec3::new(multiplier[0], multiplier[1], multiplier[2]);
        let theta = Vec3::new(multiplier[3], multiplier[4], multiplier[5]) / self.coordinates.ell();
        let rot = &self.equilibrium.pose.rot_wp;
        let (platform, load) = (&self.robot.platform, &self.robot.load);

        add_real(&mut total.weight, v + theta.cross(&(rot * platform.center_of_mass_p)));
        add_real(&mut total.center, self.robot.force_at_mass_centre_w().cross(&theta));
        add_real(&mut total.force, v + theta.cross(&(rot * load.point_p)));
        add_real(&mut total.point, load.force_w.cross(&theta));
        add_real(&mut total.moment, theta);
        for (cable, state) in total.cables.iter_mut().zip(&self.equilibrium.cables) {
            add_real(&mut cable.force, v + theta.cross(&state.lever_w));
            add_real(&mut cable.lever, state.force_on_platform_w.cross(&theta));
        }
    }

    /// Follows the coefficients to the numbers of the robot and to the motion of the platform.
    fn pulled(&self, scalar: &Adjoint<f64>) -> Pulled {
        let (robot, rot) = (self.robot, &self.equilibrium.pose.rot_wp);
        let (platform, wind) = (&robot.platform, &robot.wind);
        let mut gradient = RobotChange::none(robot.cables.len());
        let mut translation_w = Vec3::from(scalar.translation);
        let mut rotation_w = Vec3::from(scalar.rotation);

        for (i, (cable, partials)) in scalar.cables.iter().zip(&self.cables).enumerate() {
            let state = &self.equilibrium.cables[i];
            let (of_cable, chord_w, lever_w) = cable_pulled(cable, partials, &mut gradient);
            translation_w -= chord_w;
            rotation_w += state.lever_w.cross(&lever_w);
            gradient.cables[i] = CableChange { attachment_p: rot.inverse() * lever_w, ..of_cable };
        }

        // The mean distance of the attachments, by which rotations are scaled.
        if scalar.ell != 0.0 {
            let count = robot.cables.len() as f64;
            for (cable, of_cable) in robot.cables.iter().zip(&mut gradient.cables) {
                let outwards_p = cable.attachment_p.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
                of_cable.attachment_p += outwards_p * (scalar.ell / count);
            }
        }

        // Weight and wind at the centre of mass, then the load.
        let (weight, center) = (Vec3::from(scalar.weight), Vec3::from(scalar.center));
        gradient.mass += scalar.mass + robot.gravity_w.dot(&weight);
        gradient.gravity_w += weight * platform.mass + Vec3::from(scalar.gravity);
        gradient.drag_area += wind.pressure_w().dot(&weight);
        gradient.wind_velocity_w += wind.pressure_by_velocity_w() * weight * platform.drag_area;
        gradient.air_density += wind.at_unit_density().pressure_w().dot(&weight) * platform.drag_area;
        gradient.center_of_mass_p = rot.inverse() * center;
        rotation_w += (rot * platform.center_of_mass_p).cross(&center);

        let point = Vec3::from(scalar.point);
        gradient.force_w = scalar.force.into();
        gradient.moment_w = scalar.moment.into();
        gradient.point_p = rot.inverse() * point;
        rotation_w += (rot * robot.load.point_p).cross(&point);

        self.add_tensors(scalar, &mut gradient, &mut rotation_w);
        let supports = self.supports.as_ref().map_or_else(Vec::new, |supports| supports.pulled(scalar, &mut gradient));
        Pulled { gradient, translation_w, rotation_w, supports }
    }

    /// Follows the coefficients of the tensors of the platform, which turn with it.
    fn add_tensors(&self, scalar: &Adjoint<f64>, gradient: &mut RobotChange, rotation_w: &mut Vec3) {
        let platform = &self.robot.platform;
        let matrix = self.equilibrium.pose.rot_wp.to_rotation_matrix();
        let mut tensor = |adjoint: &[[f64; 3]; 3], tensor_p: &Mat3| {
            let adjoint = Mat3::from_fn(|i, j| adjoint[i][j]);
            let tensor_w = matrix.matrix() * tensor_p * matrix.matrix().transpose();
            let turning = tensor_w * adjoint - adjoint * tensor_w;
            *rotation_w += Vec3::new(
                turning[(1, 2)] - turning[(2, 1)],
                turning[(2, 0)] - turning[(0, 2)],
                turning[(0, 1)] - turning[(1, 0)],
            );
            matrix.matrix().transpose() * adjoint * matrix.matrix()
        };

        gradient.inertia_p = tensor(&scalar.inertia, &platform.inertia_p);
        let translational = Mat3::from_diagonal(&platform.translational_damping_p);
        let rotational = Mat3::from_diagonal(&platform.rotational_damping_p);
        gradient.translational_damping_p = tensor(&scalar.translational_damping, &translational).diagonal();
        gradient.rotational_damping_p = tensor(&scalar.rotational_damping, &rotational).diagonal();
    }
}

/// Follows the coefficients of one cable to its numbers, and to gravity and wind. The result also has the coefficients
/// of the chord and of the lever arm; those of the lever arm contain those of the chord.
fn cable_pulled(
    cable: &CableAdjoint<f64>,
    partials: &CablePartials,
    gradient: &mut RobotChange,
) -> (CableChange, Vec3, Vec3) {
    let force = Vec3::from(cable.force);

    // To chord, load, EA and length, and to the numbers of the drive.
    let outer = match &partials.drive {
        Some(drive) => drive_pulled(cable, &drive.by_outer),
        None => Outer {
            reach_w: Vec3::from(cable.chord) + partials.stiffness_w * force,
            load_w: partials.force_by_load_w.transpose() * force,
            axial_stiffness: partials.force_by_stiffness_w.dot(&force),
            length: cable.free_length + partials.force_by_length_w.dot(&force),
            ..Outer::default()
        },
    };
    let load = Vec3::from(cable.load) + outer.load_w;
    let chord_w = outer.reach_w + partials.load_by_chord_w.transpose() * load;
    let lever_w = Vec3::from(cable.lever) - chord_w;

    gradient.gravity_w += load * partials.load_by_gravity;
    gradient.wind_velocity_w += partials.load_by_wind_w.transpose() * load;
    gradient.air_density += partials.load_by_density_w.dot(&load);
    let drive = partials.drive.as_ref();
    let (pulley, winch) =
        drive.map_or_else(Default::default, |drive| pulley_and_winch(&cable.drive, drive, &outer, &load));
    let of_cable = CableChange {
        anchor_w: chord_w,
        attachment_p: Vec3::zeros(),
        unstrained_length: cable.length + outer.length,
        axial_stiffness: cable.stiffness + outer.axial_stiffness,
        mass_per_length: cable.mass + partials.load_by_mass_w.dot(&load),
        load_per_length_w: load * partials.load_by_own,
        drag_width: partials.load_by_drag_width_w.dot(&load),
        damping: cable.damping,
        loss_factor: cable.stretch_loss[0],
        damping_time: cable.stretch_loss[1],
        pulley,
        winch,
        guide_wheels: cable
            .guides
            .iter()
            .map(|[distance, mass]| GuideWheelChange { distance: *distance, mass: *mass })
            .collect(),
    };
    (of_cable, chord_w, lever_w)
}

/// Follows the coefficients of a drive to the numbers of its pulley and of its winch.
fn pulley_and_winch(
    of_drive: &DriveAdjoint<f64>,
    drive: &DrivePartials,
    outer: &Outer,
    load: &Vec3,
) -> (PulleyChange, WinchChange) {
    let turn_w = outer.turn_w + drive.load_by_turn_w.transpose() * load;
    let compliance = of_drive.compliance + outer.compliance;

    let pulley = PulleyChange {
        radius: of_drive.radius + outer.radius + drive.load_by_radius_w.dot(load),
        entry_direction_w: turn_w.cross(&drive.entry_direction_w),
        inertia: of_drive.inertia,
        swivel_inertia: of_drive.swivel_inertia,
    };
    let winch = WinchChange {
        drum_side_length: of_drive.drum_side_length + outer.drum_side_length,
        stiffness: of_drive.stiffness + compliance * drive.compliance_by_stiffness,
        drum_mass: of_drive.drum_mass,
        motor_mass: of_drive.motor_mass,
        damping: of_drive.damping,
        position_gain: of_drive.position_gain + compliance * drive.compliance_by_gain,
        speed_gain: of_drive.speed_gain,
        delay: of_drive.delay,
    };
    (pulley, winch)
}

/// Coefficients of the numbers on which a cable at rest depends.
#[derive(Default)]
struct Outer {
    reach_w: Vec3,
    load_w: Vec3,
    axial_stiffness: f64,
    length: f64,
    radius: f64,
    turn_w: Vec3,
    drum_side_length: f64,
    compliance: f64,
}

/// Follows the coefficients of a cable with a drive to the numbers on which it depends.
fn drive_pulled(cable: &CableAdjoint<f64>, by_outer: &DriveDerivatives) -> Outer {
    let mut sum: OuterRow = cable.outer;
    let mut add = |coefficient: f64, row: &OuterRow| {
        if coefficient != 0.0 {
            sum.iter_mut().zip(row).for_each(|(sum, by)| *sum += coefficient * by);
        }
    };
    for k in 0..3 {
        add(cable.force[k], &by_outer.force_w[k]);
        add(cable.chord[k], &by_outer.chord_w[k]);
    }
    add(cable.free_length, &by_outer.free_length);
    cable.end.iter().zip(&by_outer.end).for_each(|(coefficient, row)| add(*coefficient, row));

    let three = |first: usize| Vec3::new(sum[first], sum[first + 1], sum[first + 2]);
    Outer {
        reach_w: three(place::REACH),
        load_w: three(place::LOAD),
        axial_stiffness: sum[place::AXIAL_STIFFNESS],
        length: sum[place::LENGTH],
        radius: sum[place::RADIUS],
        turn_w: three(place::TURN),
        drum_side_length: sum[place::DRUM_SIDE],
        compliance: sum[place::COMPLIANCE],
    }
}

impl Follower {
    /// Lengths that adapt at a held pose.
    fn of_lengths(
        robot: &Robot,
        equilibrium: &Equilibrium,
        coordinates: &Coordinates,
        partials: &[CablePartials],
        rule: Option<&TensionRule>,
    ) -> Result<Self, GradientError> {
        let (cables, degrees_of_freedom) = (partials.len(), coordinates.count());
        let tensions = match robot.constraint() {
            Constraint::Under(_) => {
                return Err(StaticDerivativeError::TooFewCables { cables, degrees_of_freedom }.into());
            }
            Constraint::Fully => None,
            Constraint::Redundantly(_) => Some(parallel_tensions(robot, equilibrium, partials)?),
        };

        let mut wrenches = DMat::zeros(degrees_of_freedom, cables);
        for (i, (partials, state)) in partials.iter().zip(&equilibrium.cables).enumerate() {
            let per_unknown = tensions.as_ref().map_or(1.0, |tensions| tensions[i].by_length);
            let column = coordinates.reduce_force(&(partials.force_by_length_w / per_unknown), &state.lever_w);
            (0..degrees_of_freedom).for_each(|k| wrenches[(k, i)] = column[k]);
        }

        // The pseudoinverse, from the orthogonal factors of the transpose.
        let factors = wrenches.transpose().qr();
        let (q, r) = (factors.q(), factors.r());
        let diagonal = (0..degrees_of_freedom).map(|k| r[(k, k)].abs());
        let (smallest, largest) = diagonal.fold((f64::INFINITY, 0.0_f64), |(low, high), d| (low.min(d), high.max(d)));
        check_regular(smallest, largest)?;
        let pseudoinverse = r.solve_upper_triangular(&q.transpose()).ok_or(StaticDerivativeError::Singular)?;

        let rule = match (rule, &tensions) {
            (Some(rule), Some(tensions)) => {
                let at = TensionsAtLimits::new(robot, equilibrium, partials, tensions);
                Some(Box::new(RuleFollower::new(at, coordinates, &wrenches, rule)?))
            }
            _ => None,
        };
        Ok(Self::Lengths { pseudoinverse, wrenches, tensions, rule })
    }
}

/// Parallel tension of each cable of a robot on rigid supports.
fn parallel_tensions(
    robot: &Robot,
    equilibrium: &Equilibrium,
    partials: &[CablePartials],
) -> Result<Vec<ParallelTension>, GradientError> {
    let states = equilibrium.cables.iter().zip(partials).enumerate();
    states.map(|(i, (state, partials))| ParallelTension::of(robot, i, state, partials)).collect()
}

/// Translation and rotation in one vector.
pub(super) fn six(translation: &Vec3, rotation: &Vec3) -> Vec6 {
    Vec6::new(translation.x, translation.y, translation.z, rotation.x, rotation.y, rotation.z)
}
