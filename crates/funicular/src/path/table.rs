//! Smooth paths through the rows of a table: splines of the fifth degree with four continuous derivatives
//! (docs/theory.md, equations (40z9) and (40z10)).

use super::{PathError, PathPoint};
use crate::math::{DMat, Quaternion, Rotation, Vec3, Vec6};
use crate::robot::Pose;

/// Largest turn between two rows [degrees]. Beyond half a turn the other way round is shorter; the margin is for the
/// rounding of tables.
pub const MAX_TURN_DEG: f64 = 170.0;

/// Speed between two rows, over the median of those that move and over that of both neighbours, that is a jump.
const JUMP: [f64; 2] = [50.0, 10.0];

/// Number of intervals from which on a jump can be told from the usual speed.
const INTERVALS_FOR_USUAL: usize = 6;

/// Number of rows whose polynomial gives the motion at an end of the table.
const END_ROWS: usize = 6;

/// Coordinates of a row: position, quaternion.
const COUNT: usize = 7;
type RowNumbers = [f64; COUNT];

/// Spline through the rows of a table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PathTable {
    /// Times from the first row on [s].
    times: Vec<f64>,
    /// Coordinates with their first and second derivative at each row.
    rows: Vec<[RowNumbers; 3]>,
}

impl PathTable {
    pub(super) fn new(times: &[f64], poses: &[Pose]) -> Result<Self, PathError> {
        assert!(times.len() >= 2 && times.len() == poses.len(), "{} times, {} poses", times.len(), poses.len());
        check(times, poses)?;

        let times: Vec<f64> = times.iter().map(|time| time - times[0]).collect();
        let values = coordinates(poses);
        let rows = with_derivatives(&times, &values);
        Ok(Self { times, rows })
    }

    pub(super) fn duration(&self) -> f64 {
        self.times.last().copied().unwrap_or_default()
    }

    pub(super) fn at(&self, time: f64) -> PathPoint {
        let time = time.clamp(0.0, self.duration());
        let next = self.times.partition_point(|at| *at <= time).clamp(1, self.times.len() - 1);
        let (from, to) = (self.times[next - 1], self.times[next]);
        let [x, v, a, j] = hermite(&self.rows[next - 1], &self.rows[next], to - from, time - from);
        point([x, v, a, j])
    }
}

/// Refuses rows whose path is not known.
fn check(times: &[f64], poses: &[Pose]) -> Result<(), PathError> {
    for (row, pair) in (2..).zip(times.windows(2)) {
        if pair[1] <= pair[0] {
            return Err(PathError::TimesFall { row, time: pair[1], before: pair[0] });
        }
    }
    for (row, pair) in (2..).zip(poses.windows(2)) {
        let turn_deg = (pair[1].rot_wp * pair[0].rot_wp.inverse()).angle().to_degrees();
        if turn_deg > MAX_TURN_DEG {
            return Err(PathError::TurnsTooFar { row, turn_deg });
        }
    }

    let distances = poses.windows(2).map(|pair| (pair[1].position_w - pair[0].position_w).norm());
    let steps: Vec<(f64, f64)> = distances.zip(times.windows(2).map(|pair| pair[1] - pair[0])).collect();
    let speeds: Vec<f64> = steps.iter().map(|(distance, time)| distance / time).collect();
    let mut moving: Vec<f64> = speeds.iter().copied().filter(|speed| *speed > 0.0).collect();
    moving.sort_by(f64::total_cmp);
    if moving.len() < INTERVALS_FOR_USUAL {
        return Ok(());
    }
    let usual = moving[moving.len() / 2];
    for (k, speed) in speeds.iter().enumerate() {
        let around = [k.checked_sub(1), Some(k + 1)].into_iter().flatten().filter_map(|k| speeds.get(k));
        let fastest = around.copied().fold(0.0, f64::max);
        if *speed > JUMP[0] * usual && *speed > JUMP[1] * fastest {
            let (distance, time) = steps[k];
            return Err(PathError::Jump { row: k + 2, distance, time, ratio: speed / usual });
        }
    }
    Ok(())
}

/// Coordinates of the rows; each quaternion has the sign that is nearer to the one before.
fn coordinates(poses: &[Pose]) -> Vec<RowNumbers> {
    let mut last = *poses[0].rot_wp.quaternion();
    let row = |pose: &Pose| {
        let quaternion = *pose.rot_wp.quaternion();
        last = if quaternion.dot(&last) < 0.0 { -quaternion } else { quaternion };
        let ([x, y, z], q) = (<[f64; 3]>::from(pose.position_w), last);
        [x, y, z, q.w, q.i, q.j, q.k]
    };
    poses.iter().map(row).collect()
}

/// First and second derivatives at the rows: at inner rows the third and fourth derivatives are continuous, at the ends
/// those of the polynomial through the next rows.
fn with_derivatives(times: &[f64], values: &[RowNumbers]) -> Vec<[RowNumbers; 3]> {
    let count = times.len();
    let ends = [0, count - 1].map(|end| of_polynomial(times, values, end));

    // Two equations per inner row; the unknowns are velocity and acceleration of all rows. Blocks on three diagonals.
    let mut rows: Vec<[RowNumbers; 3]> = vec![[[0.0; COUNT]; 3]; count];
    for (row, value) in rows.iter_mut().zip(values) {
        row[0] = *value;
    }
    for (end, [velocity, acceleration]) in [0, count - 1].into_iter().zip(ends) {
        rows[end][1] = velocity;
        rows[end][2] = acceleration;
    }
    solve_inner(times, &mut rows);
    rows
}

/// 2×2 matrix.
type TwoByTwo = [[f64; 2]; 2];

/// Solves the continuity of the third and fourth derivatives for the inner rows, from the first to the last and back.
fn solve_inner(times: &[f64], rows: &mut [[RowNumbers; 3]]) {
    let count = rows.len();
    // For row i: unknown of i = right − factor · unknown of i + 1.
    let mut factors: Vec<TwoByTwo> = vec![[[0.0; 2]; 2]; count];
    let mut rights: Vec<[RowNumbers; 2]> = rows.iter().map(|row| [row[1], row[2]]).collect();
    for i in 1..count.saturating_sub(1) {
        let (left, right) = (times[i] - times[i - 1], times[i + 1] - times[i]);
        let [before, own, after] = continuity(left, right);
        let own = std::array::from_fn(|r| {
            std::array::from_fn(|c| own[r][c] - (0..2).map(|k| before[r][k] * factors[i - 1][k][c]).sum::<f64>())
        });
        let inverse = inverted(&own);

        let mut given = [[0.0; COUNT]; 2];
        for k in 0..COUNT {
            let (from, to) = (rows[i][0][k] - rows[i - 1][0][k], rows[i + 1][0][k] - rows[i][0][k]);
            let by_values = [
                60.0 * (to / right.powi(3) - from / left.powi(3)),
                -360.0 * (to / right.powi(4) + from / left.powi(4)),
            ];
            for r in 0..2 {
                given[r][k] = by_values[r] - (0..2).map(|c| before[r][c] * rights[i - 1][c][k]).sum::<f64>();
            }
        }
        factors[i] =
            std::array::from_fn(|r| std::array::from_fn(|c| (0..2).map(|k| inverse[r][k] * after[k][c]).sum()));
        rights[i] = std::array::from_fn(|r| std::array::from_fn(|k| (0..2).map(|c| inverse[r][c] * given[c][k]).sum()));
    }
    for i in (1..count.saturating_sub(1)).rev() {
        for r in 0..2 {
            rows[i][r + 1] = std::array::from_fn(|k| {
                rights[i][r][k] - (0..2).map(|c| factors[i][r][c] * rows[i + 1][c + 1][k]).sum::<f64>()
            });
        }
    }
}

/// Coefficients of velocity and acceleration of three rows in the continuity of the third and of the fourth derivative
/// at the middle one, whose neighbours are at these distances in time; on the other side stand the values.
fn continuity(left: f64, right: f64) -> [TwoByTwo; 3] {
    let ([l1, l2, l3], [r1, r2, r3]) = ([1, 2, 3].map(|k| left.powi(k)), [1, 2, 3].map(|k| right.powi(k)));
    [
        [[-24.0 / l2, -3.0 / l1], [-168.0 / l3, -24.0 / l2]],
        [[36.0 / r2 - 36.0 / l2, 9.0 / r1 + 9.0 / l1], [-192.0 / r3 - 192.0 / l3, 36.0 / l2 - 36.0 / r2]],
        [[24.0 / r2, -3.0 / r1], [-168.0 / r3, 24.0 / r2]],
    ]
}

fn inverted([[a, b], [c, d]]: &TwoByTwo) -> TwoByTwo {
    let determinant = a * d - b * c;
    [[d / determinant, -b / determinant], [-c / determinant, a / determinant]]
}

/// First and second derivative at one end of the polynomial through the rows next to it.
fn of_polynomial(times: &[f64], values: &[RowNumbers], end: usize) -> [RowNumbers; 2] {
    let count = times.len().min(END_ROWS);
    let first = if end == 0 { 0 } else { times.len() - count };
    let near = first..first + count;

    // In units of the span of these rows, so that the powers are of one size.
    let span = times[near.end - 1] - times[near.start];
    let power = |i: usize, j: usize| std::iter::repeat_n((times[first + i] - times[end]) / span, j).product();
    let powers = DMat::from_fn(count, count, power);
    let given = DMat::from_fn(count, COUNT, |i, k| values[first + i][k]);
    let solved = powers.lu().solve(&given).unwrap_or_else(|| DMat::zeros(count, COUNT));
    let of = |order: usize, k: usize| if order < count { solved[(order, k)] } else { 0.0 };
    [std::array::from_fn(|k| of(1, k) / span), std::array::from_fn(|k| 2.0 * of(2, k) / (span * span))]
}

/// Value and three derivatives, at a time after the first row, of the polynomial that has values and two derivatives of
/// both rows.
fn hermite(from: &[RowNumbers; 3], to: &[RowNumbers; 3], span: f64, time: f64) -> [RowNumbers; 4] {
    let s = time / span;
    let mut found = [[0.0; COUNT]; 4];
    for k in 0..COUNT {
        let by = to[0][k] - from[0][k];
        let (v0, v1) = (from[1][k] * span, to[1][k] * span);
        let (a0, a1) = (from[2][k] * span * span, to[2][k] * span * span);
        let third = 10.0 * by - 6.0 * v0 - 4.0 * v1 - 1.5 * a0 + 0.5 * a1;
        let fourth = -15.0 * by + 8.0 * v0 + 7.0 * v1 + 1.5 * a0 - a1;
        let fifth = 6.0 * by - 3.0 * (v0 + v1) - 0.5 * (a0 - a1);

        found[0][k] = from[0][k] + s * (v0 + s * (0.5 * a0 + s * (third + s * (fourth + s * fifth))));
        found[1][k] = (v0 + s * (a0 + s * (3.0 * third + s * (4.0 * fourth + s * 5.0 * fifth)))) / span;
        found[2][k] = (a0 + s * (6.0 * third + s * (12.0 * fourth + s * 20.0 * fifth))) / span.powi(2);
        found[3][k] = (6.0 * third + s * (24.0 * fourth + s * 60.0 * fifth)) / span.powi(3);
    }
    found
}

/// Motion by coordinates and their derivatives; the quaternion need not have unit length.
fn point([x, v, a, j]: [RowNumbers; 4]) -> PathPoint {
    let quaternion = |of: &RowNumbers| Quaternion::new(of[3], of[4], of[5], of[6]);
    let [q, q1, q2, q3] = [quaternion(&x), quaternion(&v), quaternion(&a), quaternion(&j)];
    let conjugate = q.conjugate();

    // ω |q|²/2 is the vector part of q̇ q*, (40z10).
    let square = q.norm_squared();
    let first = 2.0 * q.dot(&q1);
    let second = 2.0 * (q.dot(&q2) + q1.dot(&q1));
    let vector = |of: Quaternion| of.vector().into_owned() * 2.0;
    let omega = vector(q1 * conjugate) / square;
    let alpha = (vector(q2 * conjugate) - omega * first) / square;
    let third = vector(q3 * conjugate) + vector(q2 * q1.conjugate());
    let beta = (third - alpha * (2.0 * first) - omega * second) / square;

    let six = |of: &RowNumbers, turn: Vec3| Vec6::new(of[0], of[1], of[2], turn.x, turn.y, turn.z);
    PathPoint {
        pose: Pose { position_w: Vec3::new(x[0], x[1], x[2]), rot_wp: Rotation::new_normalize(q) },
        velocity_w: six(&v, omega),
        acceleration_w: six(&a, alpha),
        jerk_w: six(&j, beta),
    }
}
