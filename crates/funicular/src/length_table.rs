//! Tables of unstrained lengths for controllers without statics: over a box of poses, polynomials that correct the
//! lengths of straight, unstretched cables.
//!
//! A firmware computes `|B − p − R a|`, the distance of a cable's ends. Sag, stretch, pulleys and flexible supports
//! change this length by a function of the pose that is smooth under a smooth rule of tensions, and small, so that a
//! polynomial of low degree follows it (docs/theory.md, (40z12)).

use crate::math::chebyshev::{ChebyshevBasis, chebyshev_point, even_point};
use crate::math::{Vec3, rotation};
use crate::robot::{Pose, Robot, State};
use crate::statics::{self, StaticModel, StaticsError, TensionRule};
use thiserror::Error;

/// Largest total degree of the polynomials: a function that needs more has a kink, or the box is too large.
pub const MAX_DEGREE: usize = 12;

/// Maximum number of coefficients per cable: six variables reach it at degree 6.
pub const MAX_COEFFICIENTS: usize = 1000;

/// Number of fitted poses per coefficient: errors are then those of a projection. With a quarter of them they are half
/// as large again.
const FITTED_PER_COEFFICIENT: usize = 16;

/// Number of poses inside the box at which the error is computed, besides its corners.
const TESTED: usize = 1000;

/// Number of cables whose largest error is followed to its maximum, and halvings of the step of this search.
const MAX_FOLLOWED: usize = 8;
const HALVINGS: usize = 6;

/// Part of the tolerance up to which products are left out.
const ROOM: f64 = 0.9;

/// Number of poses inside the box, besides its corners, at which the effect of another rope is computed.
const VARIED: usize = 50;

/// Factor of a number of the ropes whose effect is computed.
const VARIED_FACTOR: f64 = 1.1;

/// Box of poses: ranges of some coordinates of a pose, the others fixed.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseBox {
    base: Pose,
    angles_deg: [f64; 3],
    sides: Vec<BoxSide>,
}

/// Range of a coordinate: x, y, z [m], roll, pitch, yaw [degrees].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoxSide {
    /// Number of the coordinate, 0 to 5.
    pub axis: usize,
    /// First value.
    pub from: f64,
    /// Last value, above the first.
    pub to: f64,
}

impl PoseBox {
    /// Box around poses whose other coordinates are those of `base`; angles of `base` are taken as roll, pitch, yaw if
    /// one of them has a range.
    pub fn new(base: Pose, mut sides: Vec<BoxSide>) -> Self {
        sides.sort_by_key(|side| side.axis);
        Self { base, angles_deg: rotation::to_roll_pitch_yaw_deg(&base.rot_wp), sides }
    }

    /// Ranges in the order x, y, z, roll, pitch, yaw.
    pub fn sides(&self) -> &[BoxSide] {
        &self.sides
    }

    /// Pose with the fixed coordinates.
    pub fn base(&self) -> &Pose {
        &self.base
    }

    /// Fixed roll, pitch, yaw [degrees].
    pub fn angles_deg(&self) -> [f64; 3] {
        self.angles_deg
    }

    /// True if the orientation changes inside the box.
    pub fn turns(&self) -> bool {
        self.sides.iter().any(|side| side.axis >= 3)
    }

    /// Coordinates with a range [m, degrees], at a place from −1 to 1 along each of them.
    pub fn coordinates(&self, place: &[f64]) -> Vec<f64> {
        let at = |(side, place): (&BoxSide, &f64)| {
            let [middle, half] = side.middle_and_half();
            (middle + half * place).clamp(side.from, side.to)
        };
        self.sides.iter().zip(place).map(at).collect()
    }

    /// Place from −1 to 1 of coordinates with a range.
    pub fn place(&self, coordinates: &[f64]) -> Vec<f64> {
        let place = |(side, value): (&BoxSide, &f64)| {
            let [middle, half] = side.middle_and_half();
            ((value - middle) / half).clamp(-1.0, 1.0)
        };
        self.sides.iter().zip(coordinates).map(place).collect()
    }

    /// Pose at coordinates with a range.
    pub fn pose(&self, coordinates: &[f64]) -> Pose {
        let mut pose = self.base;
        let mut angles = self.angles_deg;
        for (side, value) in self.sides.iter().zip(coordinates) {
            match side.axis {
                axis @ 0..3 => pose.position_w[axis] = *value,
                axis => angles[axis - 3] = *value,
            }
        }
        if self.turns() {
            pose.rot_wp = rotation::from_roll_pitch_yaw_deg(angles[0], angles[1], angles[2]);
        }
        pose
    }

    /// Corners and the middle of the box.
    fn corners(&self) -> Vec<Vec<f64>> {
        let n = self.sides.len();
        let corner = |i: usize| (0..n).map(|k| if i >> k & 1 == 0 { -1.0 } else { 1.0 }).collect();
        std::iter::once(vec![0.0; n]).chain((0..1 << n).map(corner)).collect()
    }
}

impl BoxSide {
    /// Middle of the range and half of its width.
    pub fn middle_and_half(&self) -> [f64; 2] {
        [0.5 * (self.from + self.to), 0.5 * (self.to - self.from)]
    }
}

/// Straight cable, whose length a table corrects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StraightLine {
    /// End on the frame, as the robot file gives it [m].
    pub anchor_w: Vec3,
    /// End on the platform, platform frame [m].
    pub attachment_p: Vec3,
}

/// Table of lengths over a box of poses.
#[derive(Debug, Clone, PartialEq)]
pub struct LengthTable {
    /// Box of poses.
    pub pose_box: PoseBox,
    /// Products of polynomials, of the variables of the box from −1 to 1.
    pub basis: ChebyshevBasis,
    /// Straight line of each cable.
    pub lines: Vec<StraightLine>,
    /// Coefficients of each cable [m], with [`LengthTable::DIGITS`] digits.
    pub coefficients: Vec<Vec<f64>>,
    /// Number of poses to which the polynomials were fitted.
    pub fitted: usize,
    /// Number of other poses, at which the error was computed.
    pub tested: usize,
    /// Largest error at these poses [m].
    pub error: f64,
    /// Index of the cable with this error, and coordinates of the pose [m, degrees].
    pub error_at: (usize, Vec<f64>),
    /// Least and greatest correction at all these poses [m].
    pub corrections: [f64; 2],
    /// Largest change of a length by 10 % more axial stiffness of all ropes [m]; `None` if tensions within the limits
    /// do not hold a pose of the box then.
    pub by_stiffness: Option<f64>,
    /// Largest change of a length by 10 % more mass per length of all ropes [m]; `None` as above.
    pub by_mass: Option<f64>,
}

/// Error of a table of lengths.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum LengthTableError {
    /// A pose of the box that the cables do not hold.
    #[error("the box is not wholly feasible: at {pose} {reason}")]
    NotHeld {
        /// Coordinates of the pose.
        pose: String,
        /// Reason.
        reason: Box<StaticsError>,
    },
    /// A pose of the box beside which fewer cables than degrees of freedom let the platform go.
    #[error(
        "the box is not wholly feasible: the cables are fewer than the degrees of freedom, and do not hold the \
         platform at {pose}"
    )]
    LetGo {
        /// Coordinates of the pose.
        pose: String,
    },
    /// A tolerance that no polynomial keeps.
    #[error(
        "polynomials of total degree {degree} leave an error of {} mm at {pose}, above the tolerance of {} mm: halve \
         the box along {axis} and write a table for each half, or allow more",
        1e3 * error, 1e3 * tolerance
    )]
    TooCoarse {
        /// Total degree that was tried last.
        degree: usize,
        /// Error of this degree [m].
        error: f64,
        /// Coordinates of the pose with this error.
        pose: String,
        /// Tolerance [m].
        tolerance: f64,
        /// Axis along which the polynomials converge worst.
        axis: &'static str,
    },
}

/// Names of the coordinates of a pose.
const AXES: [&str; 6] = ["x", "y", "z", "roll", "pitch", "yaw"];

impl LengthTable {
    /// Number of significant digits of the coefficients.
    pub const DIGITS: usize = 12;

    /// Correction of the length of a cable at coordinates of the box [m].
    pub fn correction(&self, cable: usize, coordinates: &[f64]) -> f64 {
        let values = self.basis.values(&self.pose_box.place(coordinates));
        sum(&self.coefficients[cable], &values)
    }

    /// Unstrained length of a cable at coordinates of the box [m].
    pub fn length(&self, cable: usize, coordinates: &[f64]) -> f64 {
        let pose = self.pose_box.pose(coordinates);
        self.lines[cable].length(&pose) + self.correction(cable, coordinates)
    }
}

impl StraightLine {
    /// Distance of the ends at a pose [m].
    pub fn length(&self, pose: &Pose) -> f64 {
        (self.anchor_w - pose.point_w(&self.attachment_p)).norm()
    }
}

/// Table of the unstrained lengths with which a robot rests at the poses of a box, with an error of at most `tolerance`
/// [m] at all poses that were tried. The total degree is the least that keeps it, and products that are not needed for
/// it are left out.
///
/// No finite number of poses proves the error elsewhere in the box: the table says how many they were. From the worst
/// of them the error is followed to its maximum.
///
/// # Errors
/// [`LengthTableError`].
///
/// # Example
/// ```
/// use funicular::length_table::{BoxSide, PoseBox, length_table};
/// use funicular::robot::{Pose, Robot};
/// use funicular::statics::{StaticModel, TensionRule};
///
/// let robot = Robot::from_toml(funicular_robots::COGIRO)?;
/// let sides = [(0, -3.0, 3.0), (1, -2.0, 2.0), (2, 0.5, 2.5)].map(|(axis, from, to)| BoxSide { axis, from, to });
/// let poses = PoseBox::new(Pose::new([0.0; 3], [0.0; 3]), sides.to_vec());
/// let table = length_table(&robot, &poses, StaticModel::Catenary, &TensionRule::Centre, 5e-4)?;
/// assert!(table.error <= 5e-4 && table.basis.degree() <= 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, equations (40z12) and (40z13).
pub fn length_table(
    robot: &Robot,
    pose_box: &PoseBox,
    model: StaticModel,
    rule: &TensionRule,
    tolerance: f64,
) -> Result<LengthTable, LengthTableError> {
    let sampled = Sampled { robot, pose_box, model, rule };
    let tested = sampled.tested()?;
    let mut fitted = FittedPoses::default();
    let mut best: Option<LengthTable> = None;
    for degree in 0..=MAX_DEGREE {
        if ChebyshevBasis::count(pose_box.sides.len(), degree) > MAX_COEFFICIENTS {
            break;
        }
        let Some(mut table) = sampled.of_degree(degree, &mut fitted, &tested)? else { break };
        if table.error <= tolerance {
            sampled.follow(&mut table, &tested)?;
        }
        if table.error <= tolerance {
            let mut table = sampled.shortened(table, &tested, tolerance)?;
            table.by_stiffness = sampled.effect(&tested, |cable| cable.material.axial_stiffness *= VARIED_FACTOR);
            table.by_mass = sampled.effect(&tested, |cable| cable.material.mass_per_length *= VARIED_FACTOR);
            return Ok(table);
        }
        best = Some(table);
    }
    Err(too_coarse(pose_box, best.as_ref(), tolerance))
}

/// Table by [`length_table`] with all polynomials up to a total degree, whatever their error is: for a memory that is
/// given. The error is not followed beyond the tested poses.
///
/// # Errors
/// [`LengthTableError::NotHeld`], [`LengthTableError::LetGo`].
pub fn length_table_of_degree(
    robot: &Robot,
    pose_box: &PoseBox,
    model: StaticModel,
    rule: &TensionRule,
    degree: usize,
) -> Result<Option<LengthTable>, LengthTableError> {
    let sampled = Sampled { robot, pose_box, model, rule };
    let tested = sampled.tested()?;
    sampled.of_degree(degree, &mut FittedPoses::default(), &tested)
}

/// Error of a box whose polynomials of the highest degree are not good enough.
fn too_coarse(pose_box: &PoseBox, best: Option<&LengthTable>, tolerance: f64) -> LengthTableError {
    let degree = best.map_or(0, |table| table.basis.degree());
    let error = best.map_or(f64::INFINITY, |table| table.error);
    let pose = best.map_or_else(String::new, |table| described(pose_box, &table.error_at.1));

    // Along the axis that the products of the highest degree need most.
    let mut shares = vec![0.0; pose_box.sides.len()];
    if let Some(table) = best {
        for (k, exponents) in table.basis.exponents().iter().enumerate() {
            let size: f64 = table.coefficients.iter().map(|of_cable| of_cable[k].abs()).sum();
            if exponents.iter().sum::<usize>() == degree {
                shares.iter_mut().zip(exponents).for_each(|(share, power)| *share += size * *power as f64);
            }
        }
    }
    let worst = (0..shares.len()).max_by(|a, b| shares[*a].total_cmp(&shares[*b])).unwrap_or(0);
    let axis = pose_box.sides.get(worst).map_or("x", |side| AXES[side.axis]);
    LengthTableError::TooCoarse { degree, error, pose, tolerance, axis }
}

/// Coordinates of a pose of a box in words.
fn described(pose_box: &PoseBox, coordinates: &[f64]) -> String {
    let value = |(side, value): (&BoxSide, &f64)| {
        let unit = if side.axis < 3 { "m" } else { "degrees" };
        // Without the rounding of a place in the box.
        format!("{} = {} {unit}", AXES[side.axis], (1e6 * value).round() / 1e6 + 0.0)
    };
    pose_box.sides.iter().zip(coordinates).map(value).collect::<Vec<_>>().join(", ")
}

/// Places of the box with the corrections of all cables there.
#[derive(Default)]
struct FittedPoses {
    places: Vec<Vec<f64>>,
    corrections: Vec<Vec<f64>>,
}

impl FittedPoses {
    fn extend(&mut self, other: Self) {
        self.places.extend(other.places);
        self.corrections.extend(other.corrections);
    }
}

/// Robot whose lengths are computed at places of a box.
struct Sampled<'a> {
    robot: &'a Robot,
    pose_box: &'a PoseBox,
    model: StaticModel,
    rule: &'a TensionRule,
}

impl Sampled<'_> {
    fn lines(&self) -> Vec<StraightLine> {
        let line = |cable: &crate::robot::Cable| StraightLine {
            anchor_w: cable.anchor.reference_w(),
            attachment_p: cable.attachment_p,
        };
        self.robot.cables.iter().map(line).collect()
    }

    /// Corrections of all cables at a place.
    fn corrections(&self, place: &[f64]) -> Result<Vec<f64>, LengthTableError> {
        let coordinates = self.pose_box.coordinates(place);
        let pose = self.pose_box.pose(&coordinates);
        let found = statics::solve_at(self.robot, &State::Pose(pose), self.model, self.rule).map_err(|reason| {
            LengthTableError::NotHeld { pose: described(self.pose_box, &coordinates), reason: Box::new(reason) }
        })?;
        if found.requested_pose.is_some_and(|(_, distance)| distance > 0.0) {
            return Err(LengthTableError::LetGo { pose: described(self.pose_box, &coordinates) });
        }
        let of_cable =
            |(state, line): (&statics::CableState, &StraightLine)| state.unstrained_length - line.length(&pose);
        Ok(found.equilibrium.cables.iter().zip(&self.lines()).map(of_cable).collect())
    }

    fn poses(&self, places: impl Iterator<Item = Vec<f64>>) -> Result<FittedPoses, LengthTableError> {
        let mut poses = FittedPoses::default();
        for place in places {
            poses.corrections.push(self.corrections(&place)?);
            poses.places.push(place);
        }
        Ok(poses)
    }

    /// Poses at which errors are computed. Corners come first: a box that is too large fails there.
    fn tested(&self) -> Result<FittedPoses, LengthTableError> {
        let n = self.pose_box.sides.len();
        let mut tested = self.poses(self.pose_box.corners().into_iter())?;
        tested.extend(self.poses((0..TESTED).map(|i| even_point(n, i)))?);
        Ok(tested)
    }

    /// Table of a degree; poses to which it is fitted are added. `None` if they do not determine it.
    fn of_degree(
        &self,
        degree: usize,
        fitted: &mut FittedPoses,
        tested: &FittedPoses,
    ) -> Result<Option<LengthTable>, LengthTableError> {
        let n = self.pose_box.sides.len();
        let wanted = FITTED_PER_COEFFICIENT * ChebyshevBasis::count(n, degree);
        fitted.extend(self.poses((fitted.places.len()..wanted).map(|i| chebyshev_point(n, i)))?);
        Ok(self.fitted(degree, fitted, tested))
    }

    /// Table with its error at the tested poses, without the products that it needs least: as long as it keeps the
    /// tolerance. Half of them come back until it does everywhere.
    fn shortened(
        &self,
        table: LengthTable,
        tested: &FittedPoses,
        tolerance: f64,
    ) -> Result<LengthTable, LengthTableError> {
        let count = table.basis.exponents().len();
        let size = |k: usize| table.coefficients.iter().map(|row| row[k].abs()).fold(0.0, f64::max);
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|a, b| size(*a).total_cmp(&size(*b)));

        // One after the other, the smallest first, with room for poses between the tested ones.
        let at = |(place, corrections): (&Vec<f64>, &Vec<f64>)| {
            let values = table.basis.values(place);
            let of_cable = |(row, correction): (&Vec<f64>, &f64)| sum(row, &values) - correction;
            (table.coefficients.iter().zip(corrections).map(of_cable).collect(), values)
        };
        let mut errors: Vec<(Vec<f64>, Vec<f64>)> = tested.places.iter().zip(&tested.corrections).map(at).collect();
        let mut without = 0;
        while without + 1 < count {
            let k = order[without];
            let mut largest = 0.0_f64;
            for (of_cables, values) in &mut errors {
                for (error, row) in of_cables.iter_mut().zip(&table.coefficients) {
                    *error -= row[k] * values[k];
                    largest = largest.max(error.abs());
                }
            }
            if largest > ROOM * tolerance {
                break;
            }
            without += 1;
        }

        while without > 0 {
            let mut kept = order[without..].to_vec();
            kept.sort_unstable();
            let rows = table.coefficients.iter().map(|row| kept.iter().map(|k| row[*k]).collect()).collect();
            let mut short = LengthTable { basis: table.basis.kept(&kept), coefficients: rows, ..table.clone() };
            (short.error, short.tested) = (0.0, tested.places.len());
            for (place, corrections) in tested.places.iter().zip(&tested.corrections) {
                self.note_errors(&mut short, place, corrections);
            }
            self.follow(&mut short, tested)?;
            if short.error <= tolerance {
                return Ok(short);
            }
            without /= 2;
        }
        Ok(table)
    }

    /// Table of a degree with its error at the tested poses; `None` if the poses do not determine it.
    fn fitted(&self, degree: usize, fitted: &FittedPoses, tested: &FittedPoses) -> Option<LengthTable> {
        let basis = ChebyshevBasis::new(self.pose_box.sides.len(), degree);
        let coefficients = basis.fitted(&fitted.places, &fitted.corrections)?;
        let coefficients =
            coefficients.into_iter().map(|of_cable| of_cable.into_iter().map(rounded).collect()).collect();
        let all = || fitted.corrections.iter().chain(&tested.corrections).flatten().copied();
        let mut table = LengthTable {
            pose_box: self.pose_box.clone(),
            basis,
            lines: self.lines(),
            coefficients,
            fitted: fitted.places.len(),
            tested: tested.places.len(),
            error: 0.0,
            error_at: (0, self.pose_box.coordinates(&vec![0.0; self.pose_box.sides.len()])),
            corrections: [all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max)],
            by_stiffness: None,
            by_mass: None,
        };
        for (place, corrections) in tested.places.iter().zip(&tested.corrections) {
            self.note_errors(&mut table, place, corrections);
        }
        Some(table)
    }

    /// Notes the errors of a table at a place.
    fn note_errors(&self, table: &mut LengthTable, place: &[f64], corrections: &[f64]) {
        for (cable, error) in errors(table, place, corrections).into_iter().enumerate() {
            if error > table.error {
                table.error = error;
                table.error_at = (cable, self.pose_box.coordinates(place));
            }
        }
    }

    /// Follows the largest errors of some cables to their maxima in the box.
    fn follow(&self, table: &mut LengthTable, tested: &FittedPoses) -> Result<(), LengthTableError> {
        let mut worst: Vec<(f64, usize, usize)> = vec![(0.0, 0, 0); table.lines.len()];
        for (i, (place, corrections)) in tested.places.iter().zip(&tested.corrections).enumerate() {
            for (cable, error) in errors(table, place, corrections).into_iter().enumerate() {
                if error >= worst[cable].0 {
                    worst[cable] = (error, cable, i);
                }
            }
        }
        worst.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (mut error, cable, i) in worst.into_iter().take(MAX_FOLLOWED) {
            let mut at = tested.places[i].clone();
            let mut step = 0.25;
            for _ in 0..HALVINGS {
                for k in 0..2 * at.len() {
                    let mut place = at.clone();
                    let moved = place[k / 2] + if k % 2 == 0 { step } else { -step };
                    place[k / 2] = moved.clamp(-1.0, 1.0);
                    let corrections = self.corrections(&place)?;
                    table.tested += 1;
                    self.note_errors(table, &place, &corrections);
                    let there = errors(table, &place, &corrections)[cable];
                    if there > error {
                        (error, at) = (there, place);
                    }
                }
                step *= 0.5;
            }
        }
        Ok(())
    }

    /// Largest change of a length by a change of all cables [m]; `None` if tensions within the limits do not hold a
    /// pose then.
    fn effect(&self, tested: &FittedPoses, change: impl Fn(&mut crate::robot::Cable)) -> Option<f64> {
        let mut robot = self.robot.clone();
        robot.cables.iter_mut().for_each(change);
        let changed = Sampled { robot: &robot, ..*self };
        let corners = 1 + (1 << self.pose_box.sides.len());
        let mut largest = 0.0_f64;
        for (place, before) in tested.places.iter().zip(&tested.corrections).take(corners + VARIED) {
            let after = changed.corrections(place).ok()?;
            largest = after.iter().zip(before).map(|(after, before)| (after - before).abs()).fold(largest, f64::max);
        }
        Some(largest)
    }
}

/// Errors of all cables at a place [m].
fn errors(table: &LengthTable, place: &[f64], corrections: &[f64]) -> Vec<f64> {
    let values = table.basis.values(place);
    let error = |(coefficients, correction): (&Vec<f64>, &f64)| (sum(coefficients, &values) - correction).abs();
    table.coefficients.iter().zip(corrections).map(error).collect()
}

fn sum(coefficients: &[f64], values: &[f64]) -> f64 {
    coefficients.iter().zip(values).map(|(coefficient, value)| coefficient * value).sum()
}

/// Number with the digits that a table is written with.
fn rounded(value: f64) -> f64 {
    format!("{:.*e}", LengthTable::DIGITS - 1, value).parse().unwrap_or(value)
}
