//! First and second derivatives of the centre by time, along a motion of the platform and a change of its load.
//!
//! The conditions of the centre hold at all times. Numbers with derivatives give the rates of these conditions at
//! held tensions, and the matrix of Newton's step solves for those of the tensions, one order after the other
//! (docs/theory.md, (40b7) and (40b9)).

use super::along::{PlatformAlong, jets};
use super::curve::{ForceByTau, TauLimitKind};
use super::{CentreCable, CentreSearch, Potential, TensionCentre, TensionCurve};
use crate::math::dual::{Real, dot};
use crate::math::jet::Jet;
use crate::math::{Mat3, Mat6, Vec6};
use crate::platform::Coordinates;
use crate::robot::Robot;
use crate::statics::derivatives::StaticDerivativeError;

/// Maximum number of corrections. Each repeats the first order and makes the second one right; over pulleys the matrix
/// holds the second derivative at the exit point, and an order needs two of them.
const MAX_CORRECTIONS: usize = 5;

/// Change of the rates over their size that ends the corrections.
const LAST_CORRECTION: f64 = 1e-12;

/// τ over its limit within which the slackest cable of (37) is the limit.
const AT_SLACKEST: f64 = 1e-10;

/// Motion of the platform, and change of the load on it besides that of the robot file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CentreMotion {
    /// Velocity of the origin [m/s] and angular velocity [rad/s], world axes.
    pub velocity_w: Vec6,
    /// Acceleration of the origin [m/s²] and angular acceleration [rad/s²].
    pub acceleration_w: Vec6,
    /// First derivative by time of the force [N/s] and of the moment about the origin [N m/s].
    pub load_rate_w: Vec6,
    /// Second derivative of both.
    pub load_acceleration_w: Vec6,
}

/// First and second derivatives of a cable by time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CentreRates {
    /// Unstrained length to the drum [m/s, m/s²].
    pub length: [f64; 2],
    /// Tension at the platform [N/s, N/s²].
    pub tension_platform: [f64; 2],
    /// Tension τ parallel to the chord [N/s, N/s²].
    pub tension_parallel: [f64; 2],
}

/// Cable along a motion, in memory of the caller.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct RatesRow {
    /// Coefficients of both limits and of τ.
    limits: [[f64; 3]; 2],
    tau: [f64; 3],
    /// Inverse of the derivatives of the cable's own conditions.
    inverse: Mat3,
    /// Wrench by τ, reduced, and inverse curvature of the Lagrangian.
    column: Vec6,
    weight: f64,
    /// Coefficients of t and t² of the slope of the Lagrangian.
    residual: [f64; 2],
    /// Result.
    pub(crate) rates: CentreRates,
}

/// Derivatives by time of the lengths and tensions of a centre, exact in both orders, along a motion of the platform.
///
/// # Errors
/// [`StaticDerivativeError`]: cables that do not span the degrees of freedom, ideal cables, and anchors on flexible
/// supports, whose displacements are not followed.
///
/// # Example
/// ```
/// use funicular::{math::Vec6, robot::{Pose, Robot}, statics::{self, CentreMotion, StaticModel}};
///
/// let robot = Robot::from_toml(funicular_robots::COGIRO)?;
/// let at = |x: f64| {
///     statics::tension_centre(&robot, &Pose::new([x, 0.5, 1.5], [0.0; 3]), StaticModel::Catenary, None)
/// };
/// let motion = CentreMotion {
///     velocity_w: Vec6::x(), // 1 m/s along x
///     acceleration_w: Vec6::zeros(),
///     load_rate_w: Vec6::zeros(),
///     load_acceleration_w: Vec6::zeros(),
/// };
/// let rates = statics::centre_rates(&robot, &at(0.0)?, &motion)?;
/// let length = |x: f64| at(x).map(|centre| centre.equilibrium.cables[0].unstrained_length);
/// let difference = (length(1e-4)? - length(-1e-4)?) / 2e-4;
/// assert!((rates[0].length[0] - difference).abs() < 1e-8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, equations (40b7) and (40b9).
pub fn centre_rates(
    robot: &Robot,
    centre: &TensionCentre,
    motion: &CentreMotion,
) -> Result<Vec<CentreRates>, StaticDerivativeError> {
    let (coordinates, pose) = (Coordinates::of(robot), &centre.equilibrium.pose);
    if let Some(cable) = robot.cables.iter().find(|cable| robot.has_supports() && cable.anchor.support.is_some()) {
        return Err(StaticDerivativeError::Support { cable: cable.name.clone() });
    }
    let curves: Option<Vec<_>> = centre
        .equilibrium
        .cables
        .iter()
        .enumerate()
        .map(|(i, state)| TensionCurve::of_state(robot, i, state))
        .collect();
    let curves = curves.ok_or(StaticDerivativeError::Ideal)?;
    let mut cables: Vec<CentreCable<'_>> = curves
        .into_iter()
        .zip(&centre.limits)
        .map(|(curve, limits)| CentreCable::within(curve, pose, coordinates, *limits))
        .collect();
    let mut rows = vec![super::CentreRow::default(); cables.len()];
    let load = super::CentreLoad { wrench: Vec6::zeros(), size: 0.0 };
    let mut search = CentreSearch::new(coordinates, &mut cables, &mut rows, load);
    search.multipliers = Vec6::from_fn(|k, _| centre.multipliers.get(k).copied().unwrap_or(0.0));

    let mut found = vec![RatesRow::default(); centre.limits.len()];
    let platform = PlatformAlong::new(pose, &motion.velocity_w, &motion.acceleration_w);
    let [first, second] = platform.dead_load(robot);
    let load = [first + motion.load_rate_w, second + motion.load_acceleration_w * 0.5];
    let load = load.map(|wrench| coordinates.reduce(&wrench));
    if !search.rates(&platform, &load, &mut found) {
        return Err(StaticDerivativeError::Singular);
    }
    Ok(found.into_iter().map(|row| row.rates).collect())
}

impl CentreSearch<'_, '_> {
    /// Derivatives of lengths and tensions by time, in one row per cable; false where they are not determined. `load`
    /// has the coefficients of t and t² of the load, reduced.
    pub(crate) fn rates(&self, platform: &PlatformAlong, load: &[Vec6; 2], rows: &mut [RatesRow]) -> bool {
        let mut matrix = Mat6::zeros();
        for (cable, row) in self.cables.iter().zip(&mut *rows) {
            let Some(()) = self.prepare(cable, platform, row) else { return false };
            matrix.ger(row.weight, &row.column, &row.column, 1.0);
        }

        // The first order, then both.
        let mut multipliers = [Vec6::zeros(); 2];
        for correction in 0..MAX_CORRECTIONS {
            let orders = if correction == 0 { 1 } else { 2 };
            let mut balance = *load;
            for (cable, row) in self.cables.iter().zip(&mut *rows) {
                let wrench = self.conditions(cable, platform, row, &multipliers);
                balance.iter_mut().zip(wrench).for_each(|(sum, part)| *sum += part);
            }
            let mut changed = 0.0_f64;
            for order in 0..orders {
                let Some(step) = self.rates_step(&matrix, &balance[order], order, rows) else { return false };
                multipliers[order] += step;
                for row in &mut *rows {
                    let change = row.weight * (row.column.dot(&step) - row.residual[order]);
                    row.tau[order + 1] += change;
                    if correction > 0 {
                        changed = changed.max(change.abs() / (row.tau[order + 1].abs() + row.tau[0]));
                    }
                }
            }
            let is_last = if self.has_moving_exits() { changed <= LAST_CORRECTION } else { true };
            if correction > 0 && is_last {
                break;
            }
        }

        for (cable, row) in self.cables.iter().zip(&mut *rows) {
            let at = cable.curve.along::<1>(platform);
            let length = cable.curve.span.catenary.rope().unstrained_length;
            let (span, free_length) = at.along(Jet::of_time(row.tau), length, &row.inverse, 2);
            let [_, rate, half] = (free_length + at.length_beyond(&span)).coefficients();
            let [_, tension, tension_half] = dot(&span.force_w, &span.force_w).sqrt().coefficients();
            row.rates = CentreRates {
                length: [rate, 2.0 * half],
                tension_platform: [tension, 2.0 * tension_half],
                tension_parallel: [row.tau[1], 2.0 * row.tau[2]],
            };
            let all = [row.rates.length, row.rates.tension_platform, row.rates.tension_parallel];
            if !all.iter().flatten().all(|number| number.is_finite()) {
                return false;
            }
        }
        true
    }

    /// Limits along the motion, and the cable's part of the matrix of Newton's step.
    fn prepare(&self, cable: &CentreCable<'_>, platform: &PlatformAlong, row: &mut RatesRow) -> Option<()> {
        let by_tension = {
            let length = cable.curve.span.catenary.rope().unstrained_length;
            cable.curve.at_tension().by_tension(cable.curve.tau(), length)?
        };
        let ForceByTau { second_up, .. } = cable.curve.force_by_tau(false);
        row.tau = [cable.curve.tau(), 0.0, 0.0];
        row.inverse = by_tension.inverse;
        row.column = self.wrench(cable, &by_tension.force_w);
        row.limits = [[cable.lower, 0.0, 0.0], [cable.upper, 0.0, 0.0]];
        let [_, curvature] = self.potential.derivatives(cable);
        if self.potential == Potential::None {
            row.weight = curvature;
            return Some(());
        }
        let bend = self.multipliers.dot(&self.wrench(cable, &cable.curve.span.axes_w().1)) * second_up;
        row.weight = 1.0 / (curvature - bend);

        let mut limit = cable.curve.clone();
        limit.set(cable.lower);
        let kind = if cable.lower <= limit.slackest() * (1.0 + AT_SLACKEST) {
            TauLimitKind::Slackest
        } else {
            TauLimitKind::Minimum(limit.minimum_kind())
        };
        row.limits[0] = limit.limit_along(kind, platform)?;
        limit.set(cable.upper);
        row.limits[1] = limit.limit_along(TauLimitKind::Maximum, platform)?;
        Some(())
    }

    /// Coefficients of t and t² of a cable's wrench, reduced, and in the row those of the slope of the Lagrangian.
    fn conditions(
        &self,
        cable: &CentreCable<'_>,
        platform: &PlatformAlong,
        row: &mut RatesRow,
        multipliers: &[Vec6; 2],
    ) -> [Vec6; 2] {
        let (curve, length) = (&cable.curve, cable.curve.span.catenary.rope().unstrained_length);
        let tau = Jet::<2> { rows: [row.tau, [1.0, 0.0, 0.0]] };
        let (span, _) = curve.along::<2>(platform).along(tau, length, &row.inverse, 3);
        let lever = jets::<2>(&platform.vector(&curve.cable().attachment_p))
            .map(|component| component * (1.0 / self.coordinates.ell()));

        // Wrench of the cable, and its derivative by τ.
        let f = &span.force_w;
        let wrench = [
            f[0],
            f[1],
            f[2],
            lever[1] * f[2] - lever[2] * f[1],
            lever[2] * f[0] - lever[0] * f[2],
            lever[0] * f[1] - lever[1] * f[0],
        ];
        let motion = self.coordinates.motion();
        let part = |of: usize, k: usize| motion.reduced(&Vec6::from_fn(|j, _| wrench[j].rows[of][k]));
        let columns = [0, 1, 2].map(|k| part(1, k));

        // Slope of the logarithms less the column times the multipliers.
        let slope = self.potential.slope(&row.limits.map(Jet::<1>::of_time), Jet::of_time(row.tau)).coefficients();
        let along = [self.multipliers, multipliers[0], multipliers[1]];
        row.residual = [
            slope[1] - columns[1].dot(&along[0]) - columns[0].dot(&along[1]),
            slope[2] - columns[2].dot(&along[0]) - columns[1].dot(&along[1]) - columns[0].dot(&along[2]),
        ];
        [part(0, 1), part(0, 2)]
    }

    /// Step of the multipliers of an order; with as many cables as degrees of freedom the step of the tensions, in the
    /// residuals of the rows.
    fn rates_step(&self, matrix: &Mat6, balance: &Vec6, order: usize, rows: &mut [RatesRow]) -> Option<Vec6> {
        if self.potential == Potential::None {
            let mut columns = Mat6::identity();
            for (i, row) in rows.iter().enumerate().take(6) {
                columns.set_column(i, &row.column);
            }
            let step = columns.lu().solve(&-balance)?;
            for (row, step) in rows.iter_mut().zip(step.iter()) {
                row.residual[order] = -step / row.weight;
            }
            return Some(Vec6::zeros());
        }
        let right: Vec6 = rows.iter().map(|row| row.column * (row.weight * row.residual[order])).sum();
        self.solved(matrix, &(right - balance))
    }
}
