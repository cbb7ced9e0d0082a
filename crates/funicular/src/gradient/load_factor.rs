//! Gradient of the load factor.
//!
//! At the limit, tensions and multiple t solve `Σ Jᵢᵀfᵢ + e₀ + t v = 0`, with as many tensions at their limits as it
//! takes to determine the rest. Multipliers y of this balance with `y·v = −1`, which the free tensions do not change,
//! and one multiplier per limit give the derivative of t by everything else (docs/theory.md, equations (60u) and
//! (60v)).

use super::adjoint::Adjoint;
use super::at_limits::{AT_LIMIT, TensionBound, TensionsAtLimits};
use super::pullback::Pullback;
use super::{GradientError, Gradients, Hold};
use crate::math::{DMat, Mat3, Vec3, Vec6};
use crate::platform::Coordinates;
use crate::robot::{Pose, Robot, RobotChange};
use crate::statics::{Limit, LoadCapacity, LoadCoefficients, LoadFactor, required_wrench};

/// Maximum share of the multipliers in the wrench of a free tension, both of norm one. Rounding leaves 1e-12; the
/// search for tensions that bends of sagging cables limit ends at some 1e-9.
const MAX_SHARE: f64 = 1e-6;

/// Minimum ratio of a pivot to the largest one, below which the multipliers are not determined; of unit wrenches.
const MIN_PIVOT_RATIO: f64 = 1e-9;

/// Step of the differences of a required wrench, over the size of the number. Their error is of the fourth order,
/// 1e-12, and their rounding 1e-13.
const STEP: f64 = 1e-3;

/// Load factor of a pose with its gradient.
///
/// The gradient is that of the load and of the limits that bind. Where a second load or a further tension binds as
/// well, the load factor has a kink: it is the least of several smooth functions, and this is the gradient of one of
/// them.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadFactorGradient {
    /// Load factor.
    pub factor: LoadFactor,
    /// Derivatives by every number of the robot and by the coordinates of the pose; per SI unit of the number.
    pub gradient: RobotChange,
}

impl LoadFactorGradient {
    /// Gradient at a held pose: `position_w` has the derivatives by a motion of the platform along the axes of the
    /// world [1/m], `rotation_w` those by a turn about them [1/rad]. It needs one search, as the load factor alone.
    ///
    /// # Errors
    /// [`GradientError::LoadFactor`]; [`GradientError::UnlimitedLoadFactor`]; [`GradientError::LoadFactorAndSupports`];
    /// [`GradientError::LoadFactorInWind`];
    /// [`GradientError::OneSidedLoadFactor`]; ideal, slack or vertical cables.
    ///
    /// # Example
    /// ```
    /// use funicular::gradient::LoadFactorGradient;
    /// use funicular::{math::Vec3, robot::{Pose, Robot}, statics::{LoadCapacity, StaticModel}};
    ///
    /// let mut robot = Robot::from_toml(funicular_robots::COGIRO)?;
    /// robot.required.force_w = Vec3::repeat(150.0); // N
    /// let factor = |x: f64| LoadFactorGradient::of(&LoadCapacity::at(
    ///     &robot,
    ///     &Pose::new([x, 0.5, 1.5], [0.0; 3]),
    ///     StaticModel::Catenary,
    ///     None,
    /// )?);
    /// let by_x = factor(1.0)?.gradient.position_w.x; // 1/m
    /// let difference = (factor(1.001)?.factor.value - factor(0.999)?.factor.value) / 0.002;
    /// assert!((by_x - difference).abs() < 1e-5 * by_x.abs());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # References
    /// docs/theory.md, equations (60u) and (60v).
    pub fn of(capacity: &LoadCapacity<'_>) -> Result<Self, GradientError> {
        if capacity.has_wind_on_cables() {
            return Err(GradientError::LoadFactorInWind);
        }
        let (robot, factor) = (capacity.given(), capacity.load_factor()?);
        if let Some(cable) = robot.cables.iter().find(|cable| cable.anchor.support.is_some()) {
            return Err(GradientError::LoadFactorAndSupports { cable: cable.name.clone() });
        }
        let at_limit = capacity.at_limit(&factor).ok_or(GradientError::UnlimitedLoadFactor)?;
        let pullback = Pullback::new(robot, &at_limit, Hold::Pose, None)?;
        let tensions = pullback.parallel_tensions()?;
        let at = TensionsAtLimits::new(robot, &at_limit, pullback.partials(), &tensions);
        let held: Vec<Option<TensionBound>> = (0..tensions.len()).map(|i| at.reached(i)).collect();

        // The balance, in which free tensions have no coefficients.
        let coordinates = Coordinates::of(robot);
        let reduced = multipliers(&at, &coordinates, &held, &coordinates.reduce(&factor.load))?;
        let multiplier = coordinates.expand(&reduced);
        let mut total = Adjoint::zeros(tensions.len());
        pullback.add_balance(&mut total, &multiplier);
        add_limits(&at, &held, &mut total)?;
        let mut gradient = pullback.at_held_pose(&total);

        // The loads that are required.
        let y = Vec6::from_fn(|k, _| if k < 3 { multiplier[k] } else { multiplier[k] / coordinates.ell() });
        RequiredLoad { robot, pose: &at_limit.pose, y, multiple: factor.value, coefficients: &factor.coefficients }
            .add(&mut gradient);
        Ok(Self { factor, gradient })
    }
}

impl Gradients<'_> {
    /// Load factor at the pose of the equilibrium, with its gradient. It depends on pose and robot alone: with the
    /// lengths held, the pose follows a change of the robot, and the load factor with it.
    ///
    /// # Errors
    /// As [`LoadFactorGradient::of`].
    pub fn load_factor(&self) -> Result<LoadFactorGradient, GradientError> {
        let rest = self.equilibrium();
        let capacity = LoadCapacity::at(self.robot(), &rest.pose, rest.model, None)?;
        let mut found = LoadFactorGradient::of(&capacity)?;
        let by_pose = [&mut found.gradient.position_w, &mut found.gradient.rotation_w].map(std::mem::take);
        found.gradient.add(&self.of(|scalar| {
            [scalar.translation, scalar.rotation] = by_pose.map(Into::into);
        }));
        Ok(found)
    }
}

/// Multipliers of the balance, reduced: no free tension changes `y·Φ`, and `y·v = −1` for the load that binds.
fn multipliers(
    at: &TensionsAtLimits<'_>,
    coordinates: &Coordinates,
    held: &[Option<TensionBound>],
    load: &Vec6,
) -> Result<Vec6, GradientError> {
    let n = coordinates.count();
    let free = held.iter().enumerate().filter(|(_, bound)| bound.is_none());
    let wrenches = free.map(|(i, _)| {
        let force_w = at.partials[i].force_by_length_w;
        coordinates.reduce_force(&force_w, &at.state(i).lever_w).normalize()
    });
    let rows: Vec<Vec6> = wrenches.chain([load.normalize()]).collect();
    let several = || one_sided(at, held, held.iter().position(Option::is_some).unwrap_or(0));
    if rows.len() < n {
        return Err(several());
    }

    let matrix = DMat::from_fn(rows.len(), n, |row, k| rows[row][k]);
    let mut right = DMat::zeros(rows.len(), 1);
    right[(rows.len() - 1, 0)] = -1.0 / load.norm();
    let factors = matrix.qr();
    let pivots = factors.r().diagonal().map(f64::abs);
    if pivots.min() <= MIN_PIVOT_RATIO * pivots.max() {
        return Err(several());
    }
    let solved = factors.r().solve_upper_triangular(&(factors.q().transpose() * right)).ok_or_else(several)?;
    let y = Vec6::from_fn(|k, _| if k < n { solved[(k, 0)] } else { 0.0 });

    // More free tensions than the balance determines are at an optimum, of which y is the normal.
    let shares = rows[..rows.len() - 1].iter().map(|wrench| wrench.dot(&y).abs());
    if shares.fold(0.0, f64::max) > MAX_SHARE * y.norm() { Err(several()) } else { Ok(y) }
}

/// Adds multiples of the limits that are reached, so that their tensions have no coefficients.
///
/// # Errors
/// A limit that does not press: then it may or may not bind after a change.
fn add_limits(
    at: &TensionsAtLimits<'_>,
    held: &[Option<TensionBound>],
    total: &mut Adjoint<f64>,
) -> Result<(), GradientError> {
    let mut pressures = Vec::new();
    for (i, bound) in held.iter().enumerate() {
        let Some(bound) = *bound else { continue };
        let condition = at.at_bound(i, bound, 1.0, None)?;
        let pressure = at.by_tension(i, &total.cables[i]) / at.by_tension(i, &condition.coefficients);
        condition.add(total, -pressure);
        pressures.push((i, if bound == TensionBound::Maximum { pressure } else { -pressure }));
    }

    let strongest = pressures.iter().fold(0.0, |most: f64, (_, pressure)| most.max(pressure.abs()));
    match pressures.iter().find(|(_, pressure)| *pressure <= AT_LIMIT * strongest) {
        Some((i, _)) => Err(one_sided(at, held, *i)),
        None => Ok(()),
    }
}

fn one_sided(at: &TensionsAtLimits<'_>, held: &[Option<TensionBound>], i: usize) -> GradientError {
    let limit = held[i].map(|bound| if bound == TensionBound::Maximum { Limit::Maximum } else { Limit::Minimum });
    GradientError::OneSidedLoadFactor { cable: at.name(i), limit }
}

/// Product of multipliers with the loads that are required of a robot at a pose.
struct RequiredLoad<'a> {
    robot: &'a Robot,
    pose: &'a Pose,
    /// Multipliers, about the platform origin in world axes.
    y: Vec6,
    multiple: f64,
    coefficients: &'a LoadCoefficients,
}

impl RequiredLoad<'_> {
    fn product(&self, robot: &Robot, pose: &Pose) -> f64 {
        self.y.dot(&required_wrench(robot, pose, self.multiple, self.coefficients))
    }

    /// Adds the derivatives of the product. It is of second order at most in every number but gravity, which also turns
    /// the plane of the wind, and the rotation.
    fn add(&self, gradient: &mut RobotChange) {
        let required = &self.robot.required;
        let is_constant = required.listed.is_empty()
            && required.payload.max_mass == 0.0
            && required.wind_speed == 0.0
            && [required.acceleration_w, required.angular_acceleration_w] == [Vec3::zeros(); 2];
        if is_constant {
            return;
        }

        let none = || RobotChange::none(self.robot.cables.len());
        let by = |change: RobotChange, size: f64| {
            derivative(|step| self.product(&self.robot.changed(&change, step), self.pose), STEP * size.max(1.0))
        };
        let platform = &self.robot.platform;
        gradient.mass += by(RobotChange { mass: 1.0, ..none() }, platform.mass);
        gradient.drag_area += by(RobotChange { drag_area: 1.0, ..none() }, platform.drag_area);
        gradient.air_density += by(RobotChange { air_density: 1.0, ..none() }, 1.0);
        for i in 0..3 {
            let axis = Vec3::ith(i, 1.0);
            gradient.center_of_mass_p[i] += by(RobotChange { center_of_mass_p: axis, ..none() }, 1.0);
            gradient.gravity_w[i] += by(RobotChange { gravity_w: axis, ..none() }, self.robot.gravity_w.norm());
            let turned = |step: f64| self.product(self.robot, &self.pose.moved(&Vec3::zeros(), &(axis * step)));
            gradient.rotation_w[i] += derivative(turned, STEP);
            for j in 0..=i {
                let inertia_p = Mat3::from_fn(|a, b| f64::from(u8::from((a, b) == (i, j) || (a, b) == (j, i))));
                let both = by(RobotChange { inertia_p, ..none() }, platform.inertia_p.amax());
                gradient.inertia_p += inertia_p * (both / inertia_p.sum());
            }
        }
        let turn = [gradient.position_w, gradient.rotation_w];
        let allowed = platform.motion.allowed(&super::pullback::six(&turn[0], &turn[1]));
        gradient.rotation_w = Vec3::new(allowed[3], allowed[4], allowed[5]);
    }
}

/// Derivative of a function at zero, by central differences of fourth order.
fn derivative(of: impl Fn(f64) -> f64, step: f64) -> f64 {
    (8.0 * (of(step) - of(-step)) - (of(2.0 * step) - of(-2.0 * step))) / (12.0 * step)
}
