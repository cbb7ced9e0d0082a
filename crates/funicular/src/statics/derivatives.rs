//! Derivatives of an equilibrium (pose, forces and lengths) with respect to a number of the robot, by implicit
//! differentiation of the solved balance.
//!
//! The wrench Φ on the platform depends on its pose x, the unstrained lengths L and a parameter p. At an equilibrium,
//! Φ = 0. So `𝒥 dx/dp = ∂Φ/∂p` with `𝒥 = −∂Φ/∂x` if the lengths are held, and `(∂Φ/∂L) dL/dp = −∂Φ/∂p` if the pose is
//! held: one linear system for each parameter.

use super::drag::tangent_with_drag;
use super::equilibrium::{CableState, Equilibrium};
use super::model::StaticModel;
use super::stiffness::assembled;
use crate::drive::derivatives::{DriveDerivatives, OuterRow, place, straight_chord};
use crate::math::{Mat3, Mat6, Vec3, Vec6, skew};
use crate::platform::{Coordinates, wrench_of};
use crate::robot::{CableChange, Constraint, Control, Load, Robot, RobotChange};
use thiserror::Error;

/// Maximum ratio of the minimum to the maximum singular value of a matrix that counts as singular. Below it a
/// derivative has no correct digits.
const MAX_SINGULAR_RATIO: f64 = 1e-12;

/// Reason why an equilibrium has no derivative.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StaticDerivativeError {
    /// Ideal cables have no finite stiffness.
    #[error("ideal cables are rigid: derivatives of an equilibrium need elastic cables")]
    Ideal,
    /// A slack cable without weight pulls or stays slack, depending on the direction of the change.
    #[error("cable \"{cable}\" has no tension: at the edge of being slack an equilibrium has no derivative")]
    Slack {
        /// Name of the cable.
        cable: String,
    },
    /// Cable whose anchor is on a flexible support.
    #[error(
        "the anchor of cable \"{cable}\" is on a flexible support: derivatives along one direction exist for anchors \
         on a rigid frame; take the gradients of the results"
    )]
    Support {
        /// Name of the cable.
        cable: String,
    },
    /// Equilibrium in which some motion meets no resistance, or some wrench cannot be balanced by a change of the
    /// lengths.
    #[error("the equilibrium is indifferent: some small change of the robot moves it without limit")]
    Singular,
    /// Derivative along one direction with the pose held, of a robot whose number of cables differs from its number of
    /// degrees of freedom.
    #[error(
        "derivatives along one direction with the pose held need as many cables as degrees of freedom, not {cables} \
         cables for {degrees_of_freedom}: hold the lengths, or take the gradients of the results"
    )]
    CableCount {
        /// Number of cables.
        cables: usize,
        /// Degrees of freedom of the platform.
        degrees_of_freedom: usize,
    },
    /// Pose held, but the cables are fewer than the degrees of freedom.
    #[error(
        "{cables} cables cannot hold the pose of a platform with {degrees_of_freedom} degrees of freedom by their \
         lengths: hold the lengths instead"
    )]
    TooFewCables {
        /// Number of cables.
        cables: usize,
        /// Degrees of freedom of the platform.
        degrees_of_freedom: usize,
    },
}

/// Derivative of an equilibrium with respect to a parameter. The units given are divided by the unit of the parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct EquilibriumDerivative {
    /// Motion of the platform origin, world axes [m].
    pub translation_w: Vec3,
    /// Rotation vector of the platform, world axes [rad].
    pub rotation_w: Vec3,
    /// The cables, in file order.
    pub cables: Vec<CableDerivative>,
}

/// Derivative of one cable's state with respect to a parameter. The units given are divided by the unit of the
/// parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CableDerivative {
    /// Force on the platform, world axes [N].
    pub force_on_platform_w: Vec3,
    /// Tension at the platform end [N].
    pub tension_platform: f64,
    /// Tension at the anchor [N].
    pub tension_anchor: f64,
    /// Unstrained length [m].
    pub unstrained_length: f64,
    /// Lever arm from the platform origin to the attachment, world axes [m].
    pub lever_w: Vec3,
    /// Load per unstrained length, world axes [N/m].
    pub load_w: Vec3,
}

/// Derivative of an equilibrium with the unstrained lengths held, apart from their own change: motion of the platform
/// and changes of the forces.
///
/// # Errors
/// [`StaticDerivativeError`].
///
/// # Example
/// ```
/// use funicular::robot::{Robot, RobotChange};
/// use funicular::statics::{self, StaticModel, derivatives};
///
/// let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
/// let lengths = [6.863, 6.565, 6.756, 6.663, 6.801, 6.604];
/// let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
/// let by_mass = derivatives::at_held_lengths(&robot, &rest, &RobotChange::of_mass(&robot))?;
///
/// let heavier = robot.with_mass(robot.platform.mass + 1e-3);
/// let heavier = statics::forward(&heavier, &lengths, StaticModel::Catenary, None)?;
/// let moved = (heavier.pose.position_w - rest.pose.position_w) / 1e-3; // m/kg
/// assert!((moved - by_mass.translation_w).norm() < 1e-3 * moved.norm());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, equations (52) to (54).
pub fn at_held_lengths(
    robot: &Robot,
    equilibrium: &Equilibrium,
    change: &RobotChange,
) -> Result<EquilibriumDerivative, StaticDerivativeError> {
    let direct = Direct::new(robot, equilibrium, change)?;
    let coordinates = Coordinates::of(robot);

    let jacobian = direct.jacobian(robot, equilibrium);
    let motion = solve(&coordinates.reduce_matrix(&jacobian), &coordinates, &direct.wrench)?;
    let motion = coordinates.expand(&motion);
    let translation_w = Vec3::new(motion[0], motion[1], motion[2]);
    let rotation_w = Vec3::new(motion[3], motion[4], motion[5]) / coordinates.ell();
    Ok(direct.moved(equilibrium, translation_w, rotation_w))
}

/// Derivative of an equilibrium with the pose held: the changes of the unstrained lengths that keep the pose. They
/// replace the lengths' own change. For robots with as many cables as degrees of freedom.
///
/// # Errors
/// [`StaticDerivativeError`].
///
/// # References
/// docs/theory.md, equation (55).
pub fn at_held_pose(
    robot: &Robot,
    equilibrium: &Equilibrium,
    change: &RobotChange,
) -> Result<EquilibriumDerivative, StaticDerivativeError> {
    let coordinates = Coordinates::of(robot);
    if robot.constraint() != Constraint::Fully {
        let (cables, degrees_of_freedom) = (robot.cables.len(), coordinates.count());
        return Err(StaticDerivativeError::CableCount { cables, degrees_of_freedom });
    }
    let mut change = change.clone();
    change.cables.iter_mut().for_each(|cable| cable.unstrained_length = 0.0);
    let mut direct = Direct::new(robot, equilibrium, &change)?;

    // The wrench by the change, and by the motion from the pose to a changed one.
    let (translation_w, rotation_w) = (change.position_w, change.rotation_w);
    let motion = Vec6::from_iterator(translation_w.iter().chain(rotation_w.iter()).copied());
    let jacobian = direct.jacobian(robot, equilibrium);
    let wrench = direct.wrench - jacobian * motion;

    let mut by_lengths = Mat6::zeros();
    for (i, (cable, state)) in direct.cables.iter().zip(&equilibrium.cables).enumerate() {
        by_lengths.set_column(i, &coordinates.reduce_force(&cable.partials.force_by_length_w, &state.lever_w));
    }
    // The solution contains lengths, not coordinates of the platform; only their numbers are equal.
    let lengths = solve(&by_lengths, &coordinates, &-wrench)?;
    for (cable, length) in direct.cables.iter_mut().zip(lengths.iter()) {
        cable.force_w += cable.partials.force_by_length_w * *length;
        cable.unstrained_length = *length;
    }
    Ok(direct.moved(equilibrium, translation_w, rotation_w))
}

/// Derivative 𝒥 = −∂Φ/∂x of the balance; 6×6, about the platform origin, world axes [N/m, N, N·m]. `None` for ideal
/// cables.
pub(crate) fn balance_jacobian(robot: &Robot, equilibrium: &Equilibrium) -> Option<Mat6> {
    Some(without_moment(robot, tangent_with_drag(robot, equilibrium)?))
}

/// Derivative 𝒥 of the balance from the partial derivatives of all cables: exact also over inclined pulleys, for which
/// [`balance_jacobian`] leaves out the square of the kink.
pub(crate) fn jacobian_of<'a>(
    robot: &Robot,
    equilibrium: &Equilibrium,
    partials: impl Iterator<Item = &'a CablePartials>,
) -> Mat6 {
    let cables = equilibrium.cables.iter().zip(partials).map(|(state, partials)| {
        let stiffness_w = partials.stiffness_w + partials.force_by_load_w * partials.load_by_chord_w;
        (stiffness_w, state.force_on_platform_w, state.lever_w)
    });
    let whole = assembled(robot, &equilibrium.pose, cables);
    without_moment(robot, Coordinates::of(robot).allowed_matrix(&whole))
}

/// Stiffness without one half of the moment of the load, which is fixed in the world. The tangent contains this half,
/// so that it is symmetric; the balance does not.
fn without_moment(robot: &Robot, mut stiffness: Mat6) -> Mat6 {
    let mut turns = stiffness.fixed_view_mut::<3, 3>(3, 3);
    turns -= skew(&robot.load.moment_w) * 0.5;
    stiffness
}

/// Solves for the reduced unknowns; `wrench` is not yet reduced.
pub(super) fn solve(matrix: &Mat6, coordinates: &Coordinates, wrench: &Vec6) -> Result<Vec6, StaticDerivativeError> {
    let matrix = regular(matrix, coordinates)?;
    matrix.lu().solve(&coordinates.reduce(wrench)).ok_or(StaticDerivativeError::Singular)
}

/// Reduced matrix, completed with a diagonal beyond the coordinates so that it is regular.
pub(crate) fn regular(matrix: &Mat6, coordinates: &Coordinates) -> Result<Mat6, StaticDerivativeError> {
    let mut matrix = *matrix;
    let scale = matrix.amax();
    (coordinates.count()..6).for_each(|k| matrix[(k, k)] = scale);
    let singular = matrix.singular_values();
    check_regular(singular.min(), singular.max())?;
    Ok(matrix)
}

/// Checks that a matrix is regular, by its minimum and maximum singular value, or by pivots that stand for them.
pub(crate) fn check_regular(minimum: f64, maximum: f64) -> Result<(), StaticDerivativeError> {
    if minimum.is_nan() || minimum <= MAX_SINGULAR_RATIO * maximum {
        return Err(StaticDerivativeError::Singular);
    }
    Ok(())
}

/// Effect of a change while the platform stays in place.
struct Direct {
    /// Wrench on the platform.
    wrench: Vec6,
    cables: Vec<DirectCable>,
}

/// Effect of a change on one cable while the platform stays in place.
struct DirectCable {
    partials: CablePartials,
    /// Outer variables of the drive, with chord and load.
    outer: OuterRow,
    force_w: Vec3,
    lever_w: Vec3,
    load_w: Vec3,
    unstrained_length: f64,
}

impl Direct {
    fn new(robot: &Robot, equilibrium: &Equilibrium, change: &RobotChange) -> Result<Self, StaticDerivativeError> {
        if let Some(cable) = robot.cables.iter().find(|cable| cable.anchor.support.is_some()) {
            return Err(StaticDerivativeError::Support { cable: cable.name.clone() });
        }
        let rot = &equilibrium.pose.rot_wp;
        let (platform, wind) = (&robot.platform, &robot.wind);

        // Weight and wind at the centre of mass, then the load.
        let centre_w = rot * platform.center_of_mass_p;
        let at_centre_w = robot.force_at_mass_centre_w();
        let pressure_w = wind.pressure_by_velocity_w() * change.wind_velocity_w
            + wind.at_unit_density().pressure_w() * change.air_density;
        let weight_w = robot.gravity_w * change.mass
            + change.gravity_w * platform.mass
            + wind.pressure_w() * change.drag_area
            + pressure_w * platform.drag_area;
        let mut wrench = wrench_of(&weight_w, &centre_w) + moment(&at_centre_w, &(rot * change.center_of_mass_p));
        let Load { force_w, point_p, .. } = &robot.load;
        wrench += wrench_of(&change.force_w, &(rot * point_p)) + moment(force_w, &(rot * change.point_p));
        wrench += Vec6::new(0.0, 0.0, 0.0, change.moment_w.x, change.moment_w.y, change.moment_w.z);

        let mut cables = Vec::with_capacity(robot.cables.len());
        for (i, (state, of_cable)) in equilibrium.cables.iter().zip(&change.cables).enumerate() {
            let lever_w = rot * of_cable.attachment_p;
            let partials = CablePartials::new(robot, equilibrium, i)?;
            let chord_w = of_cable.anchor_w - lever_w;
            let load_w = partials.load(change, of_cable, &chord_w);
            let outer = partials.outer(of_cable, &chord_w, &load_w);
            let force_w = partials.force(&outer);
            wrench += wrench_of(&force_w, &state.lever_w) + moment(&state.force_on_platform_w, &lever_w);
            cables.push(DirectCable {
                partials,
                outer,
                force_w,
                lever_w,
                load_w,
                unstrained_length: of_cable.unstrained_length,
            });
        }
        Ok(Self { wrench, cables })
    }

    /// Derivative 𝒥 of the balance.
    fn jacobian(&self, robot: &Robot, equilibrium: &Equilibrium) -> Mat6 {
        jacobian_of(robot, equilibrium, self.cables.iter().map(|cable| &cable.partials))
    }

    /// Derivative including the platform's motion.
    fn moved(self, equilibrium: &Equilibrium, translation_w: Vec3, rotation_w: Vec3) -> EquilibriumDerivative {
        let cables = self.cables.into_iter().zip(&equilibrium.cables).map(|(cable, state)| {
            let partials = &cable.partials;
            let chord_w = -(translation_w + rotation_w.cross(&state.lever_w));
            let turned_w = partials.load_by_chord_w * chord_w;
            let force_w = cable.force_w + partials.stiffness_w * chord_w + partials.force_by_load_w * turned_w;
            let load_w = cable.load_w + turned_w;

            // The tension at the anchor, or at the exit point, is the magnitude of N = f − S q, q being the load per
            // length and S the length of the free span.
            let at_anchor_w = force_at_anchor(state);
            let mut outer = cable.outer;
            for k in 0..3 {
                outer[place::REACH + k] += chord_w[k];
                outer[place::LOAD + k] += turned_w[k];
            }
            outer[place::LENGTH] = cable.unstrained_length;
            let longer = partials.free_length(&outer);
            let change_at_anchor_w = force_w - load_w * state.free_length() - load_of(state) * longer;
            let along = |force_w: &Vec3, change_w: &Vec3| force_w.normalize().dot(change_w);
            CableDerivative {
                force_on_platform_w: force_w,
                tension_platform: along(&state.force_on_platform_w, &force_w),
                tension_anchor: along(&at_anchor_w, &change_at_anchor_w),
                unstrained_length: cable.unstrained_length,
                lever_w: cable.lever_w + rotation_w.cross(&state.lever_w),
                load_w,
            }
        });
        EquilibriumDerivative { translation_w, rotation_w, cables: cables.collect() }
    }
}

/// Partial derivatives of the force of a cable on the platform, and of its load per length, world axes. Derivatives
/// along a direction sum them, gradients sum their transposes.
#[derive(Debug, Clone)]
pub(crate) struct CablePartials {
    /// Force by the chord, at a load held: the static stiffness [N/m].
    pub(crate) stiffness_w: Mat3,
    /// Force by the load per length [m]; zero for a straight cable, which carries no load along it.
    pub(crate) force_by_load_w: Mat3,
    /// Force by the unstrained length [N/m].
    pub(crate) force_by_length_w: Vec3,
    /// Force by the axial stiffness [-].
    pub(crate) force_by_stiffness_w: Vec3,
    /// Load per length by the chord: the turn of the wind's drag [N/m²].
    pub(crate) load_by_chord_w: Mat3,
    /// Load per length by the velocity of the wind [N s/m²].
    pub(crate) load_by_wind_w: Mat3,
    /// Load per length by the density of the air [N m²/kg].
    pub(crate) load_by_density_w: Vec3,
    /// Load per length by drag coefficient times diameter [N/m²].
    pub(crate) load_by_drag_width_w: Vec3,
    /// Load per length by the mass per length, gravity [m/s²]; zero for a straight cable.
    pub(crate) load_by_mass_w: Vec3,
    /// Load per length by gravity: the mass per length [kg/m]; zero for a straight cable.
    pub(crate) load_by_gravity: f64,
    /// Load per length by the load that the file gives: 1, or 0 for a straight cable.
    pub(crate) load_by_own: f64,
    /// Cable over a pulley or to a winch; `None` for one that ends at its anchor.
    pub(crate) drive: Option<Box<DrivePartials>>,
}

/// Partial derivatives of a cable over a pulley or to a winch. The chord of [`CablePartials`] then goes to the anchor's
/// point.
#[derive(Debug, Clone)]
pub(crate) struct DrivePartials {
    /// State of the cable and of its end by the outer variables.
    pub(crate) by_outer: DriveDerivatives,
    /// Load per length by the radius of the wheel and by the rotation of the pulley: the drag of the wind sees the
    /// chord to the exit point.
    pub(crate) load_by_radius_w: Vec3,
    pub(crate) load_by_turn_w: Mat3,
    /// Direction of travel at the entry point.
    pub(crate) entry_direction_w: Vec3,
    /// Length that the winch pays out per tension, by its stiffness and by its position gain.
    pub(crate) compliance_by_stiffness: f64,
    pub(crate) compliance_by_gain: f64,
}

impl DrivePartials {
    fn new(robot: &Robot, equilibrium: &Equilibrium, i: usize) -> Result<Option<Box<Self>>, StaticDerivativeError> {
        let (state, anchor) = (&equilibrium.cables[i], &robot.cables[i].anchor);
        let (Some(span), Some(drive)) = (&state.hanging, &state.drive) else { return Ok(None) };
        let contact = drive.contact.as_ref();
        let by_outer = DriveDerivatives::of(span, anchor, contact).ok_or(StaticDerivativeError::Singular)?;
        let mut partials = Self {
            by_outer,
            load_by_radius_w: Vec3::zeros(),
            load_by_turn_w: Mat3::zeros(),
            entry_direction_w: anchor.pulley.as_ref().map_or_else(Vec3::zeros, |pulley| pulley.entry_direction_w),
            compliance_by_stiffness: 0.0,
            compliance_by_gain: 0.0,
        };
        if let Some(winch) = &anchor.winch {
            partials.compliance_by_stiffness = -winch.stiffness.powi(-2);
            if let Control::Position(servo) = winch.control {
                partials.compliance_by_gain = if servo.integral { 0.0 } else { -servo.position_gain.powi(-2) };
            }
        }
        Ok(Some(Box::new(partials)))
    }

    /// Outer variables of the pulley and the winch by the change of a cable.
    fn outer(&self, of_cable: &CableChange, outer: &mut OuterRow) {
        let turn_w = self.entry_direction_w.cross(&of_cable.pulley.entry_direction_w);
        outer[place::RADIUS] = of_cable.pulley.radius;
        outer[place::TURN..place::DRUM_SIDE].copy_from_slice(turn_w.as_slice());
        outer[place::DRUM_SIDE] = of_cable.winch.drum_side_length;
        outer[place::COMPLIANCE] = self.compliance_by_stiffness * of_cable.winch.stiffness
            + self.compliance_by_gain * of_cable.winch.position_gain;
    }
}

impl CablePartials {
    /// Partial derivatives of cable `i`; of a robot on flexible supports where these have settled.
    pub(crate) fn new(robot: &Robot, equilibrium: &Equilibrium, i: usize) -> Result<Self, StaticDerivativeError> {
        let (state, cable) = (&equilibrium.cables[i], &robot.cables[i]);
        let hanging = state.hanging.as_ref().ok_or(StaticDerivativeError::Ideal)?;
        if state.is_slack() {
            return Err(StaticDerivativeError::Slack { cable: cable.name.clone() });
        }

        // A stiffer rope is strained less; its mean tension is f − ½ L q.
        let material = &cable.material;
        let (stiffness_w, length) = (hanging.tangent_w(), state.unstrained_length);
        let mean_w = state.force_on_platform_w - load_of(state) * (0.5 * length);
        let mut partials = Self {
            stiffness_w,
            force_by_load_w: Mat3::zeros(),
            force_by_length_w: hanging.force_by_length_w(),
            force_by_stiffness_w: stiffness_w * mean_w * (length / material.axial_stiffness.powi(2)),
            load_by_chord_w: Mat3::zeros(),
            load_by_wind_w: Mat3::zeros(),
            load_by_density_w: Vec3::zeros(),
            load_by_drag_width_w: Vec3::zeros(),
            load_by_mass_w: Vec3::zeros(),
            load_by_gravity: 0.0,
            load_by_own: 0.0,
            drive: DrivePartials::new(robot, equilibrium, i)?,
        };
        if let Some(drive) = &partials.drive {
            let rows = &drive.by_outer.force_w;
            partials.stiffness_w = block(rows, place::REACH);
            partials.force_by_length_w = column(rows, place::LENGTH);
            partials.force_by_stiffness_w = column(rows, place::AXIAL_STIFFNESS);
        }

        // Straight cables carry no load along them.
        if equilibrium.model == StaticModel::Catenary {
            // The drag is that of a straight cable.
            let chord_w = cable.anchor.exit_w(&state.attachment_w) - state.attachment_w;
            let (axis_w, wind) = (chord_w.normalize(), &robot.wind);
            let width = material.drag_width.unwrap_or(0.0);
            partials.force_by_load_w = hanging.force_by_load_w();
            partials.load_by_chord_w = robot.line_load_by_chord(i, &chord_w).unwrap_or_else(Mat3::zeros);
            if let Some(drive) = &mut partials.drive {
                partials.force_by_load_w = block(&drive.by_outer.force_w, place::LOAD);
                if let (Some(pulley), true) = (&cable.anchor.pulley, partials.load_by_chord_w != Mat3::zeros()) {
                    let reach_w = cable.anchor.point_w - state.attachment_w;
                    let chord = straight_chord(pulley, &reach_w).ok_or(StaticDerivativeError::Singular)?;
                    drive.load_by_radius_w = partials.load_by_chord_w * column(&chord, place::RADIUS);
                    drive.load_by_turn_w = partials.load_by_chord_w * block(&chord, place::TURN);
                    partials.load_by_chord_w *= block(&chord, place::REACH);
                }
            }
            partials.load_by_wind_w = wind.cross_pressure_by_velocity_w(&axis_w) * width;
            partials.load_by_density_w = wind.at_unit_density().cross_pressure_w(&axis_w) * width;
            partials.load_by_drag_width_w = wind.cross_pressure_w(&axis_w);
            partials.load_by_mass_w = robot.gravity_w;
            partials.load_by_gravity = material.mass_per_length;
            partials.load_by_own = 1.0;
        }
        Ok(partials)
    }

    /// Change of the load per length with the change of a robot, of this cable, and of its chord.
    fn load(&self, change: &RobotChange, of_cable: &CableChange, chord_w: &Vec3) -> Vec3 {
        self.load_by_mass_w * of_cable.mass_per_length
            + change.gravity_w * self.load_by_gravity
            + of_cable.load_per_length_w * self.load_by_own
            + self.load_by_chord_w * chord_w
            + self.load_by_wind_w * change.wind_velocity_w
            + self.load_by_density_w * change.air_density
            + self.load_by_drag_width_w * of_cable.drag_width
            + self.load_of_drive(of_cable)
    }

    /// Change of the load per length with the numbers of the pulley.
    fn load_of_drive(&self, of_cable: &CableChange) -> Vec3 {
        self.drive.as_ref().map_or_else(Vec3::zeros, |drive| {
            let turn_w = drive.entry_direction_w.cross(&of_cable.pulley.entry_direction_w);
            drive.load_by_radius_w * of_cable.pulley.radius + drive.load_by_turn_w * turn_w
        })
    }

    /// Outer variables by the change of a cable, of its chord to the anchor's point and of its load.
    fn outer(&self, of_cable: &CableChange, chord_w: &Vec3, load_w: &Vec3) -> OuterRow {
        let mut outer = OuterRow::default();
        outer[place::REACH..place::LOAD].copy_from_slice(chord_w.as_slice());
        outer[place::LOAD..place::AXIAL_STIFFNESS].copy_from_slice(load_w.as_slice());
        outer[place::AXIAL_STIFFNESS] = of_cable.axial_stiffness;
        outer[place::LENGTH] = of_cable.unstrained_length;
        if let Some(drive) = &self.drive {
            drive.outer(of_cable, &mut outer);
        }
        outer
    }

    /// Change of the force on the platform with the outer variables.
    fn force(&self, outer: &OuterRow) -> Vec3 {
        if let Some(drive) = &self.drive {
            return Vec3::from(drive.by_outer.force_w.map(|row| along(&row, outer)));
        }
        let part = |first: usize| Vec3::from_column_slice(&outer[first..first + 3]);
        self.stiffness_w * part(place::REACH)
            + self.force_by_load_w * part(place::LOAD)
            + self.force_by_length_w * outer[place::LENGTH]
            + self.force_by_stiffness_w * outer[place::AXIAL_STIFFNESS]
    }

    /// Change of the unstrained length of the free span with the outer variables.
    fn free_length(&self, outer: &OuterRow) -> f64 {
        self.drive.as_ref().map_or(outer[place::LENGTH], |drive| along(&drive.by_outer.free_length, outer))
    }
}

/// Three columns of three rows from `first` on.
fn block(rows: &[OuterRow; 3], first: usize) -> Mat3 {
    Mat3::from_fn(|i, j| rows[i][first + j])
}

/// Column of three rows.
fn column(rows: &[OuterRow; 3], variable: usize) -> Vec3 {
    Vec3::from_fn(|i, _| rows[i][variable])
}

/// Derivative along a change of the outer variables.
fn along(row: &OuterRow, outer: &OuterRow) -> f64 {
    row.iter().zip(outer).map(|(by, change)| by * change).sum()
}

/// Tension vector at the anchor, or at the exit point, `N = f − S q`, S being the unstrained length of the free span;
/// world axes [N].
pub(crate) fn force_at_anchor(state: &CableState) -> Vec3 {
    state.force_on_platform_w - load_of(state) * state.free_length()
}

/// Load per unstrained length of a hanging cable, world axes [N/m]; zero for a straight cable.
pub(crate) fn load_of(state: &CableState) -> Vec3 {
    state.hanging.as_ref().map_or_else(Vec3::zeros, |hanging| {
        let (_, up_w) = hanging.axes_w();
        up_w * -hanging.catenary.rope().weight_per_length
    })
}

/// Wrench of a force at a lever arm with the moment only, without the force.
fn moment(force: &Vec3, lever: &Vec3) -> Vec6 {
    let moment = lever.cross(force);
    Vec6::new(0.0, 0.0, 0.0, moment.x, moment.y, moment.z)
}
