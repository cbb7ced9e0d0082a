//! Balance over a box: wrenches of the cables as functions that are linear in the coordinates of the box, with bounds
//! of what is left.

use super::sag::{ChordRange, SagBound};
use super::statement::{CableOfStatement, ProofStatement};
use super::{PositionBox, Undecided};
use crate::math::{Mat6, Vec3, Vec6, inverse6};
use crate::platform::{Coordinates, wrench_of};

/// Rounding of a point in space over the sizes of its coordinates: sums of a few numbers.
const POINT_ROUNDING: f64 = 1e-15;

/// Balance of the platform over a box of positions with turns. The coordinates ξ of the box are from −1 to 1.
pub(super) struct BoxFrame<'a> {
    pub(super) statement: &'a ProofStatement,
    /// Steps of the platform along the coordinates: translation [m], rotation [rad].
    pub(super) steps: Vec<[Vec3; 2]>,
    pub(super) cables: Vec<CableFrame>,
    pub(super) corners: Vec<Vec3>,
    /// Right inverse Y of the wrenches at the centre, one row per cable.
    pub(super) inverse: Vec<Vec6>,
    /// Orthonormal null space N of the wrenches at the centre, one row per cable.
    pub(super) null_space: Vec<Vec<f64>>,
    /// Weight of the sagging cables on the platform: at the centre, by each coordinate, and the bound of what is left,
    /// reduced [N].
    pub(super) hanging: Affine,
}

/// Wrench that is linear in the coordinates of a box, reduced [N].
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Affine {
    pub(super) center: Vec6,
    pub(super) by: Vec<Vec6>,
    /// Bound of what is left, by component.
    pub(super) rest: Vec6,
}

/// Cable over a box. Its unknown is the tension times centre length over length, `t = q l_0` [N].
pub(super) struct CableFrame {
    /// Length at the centre [m].
    pub(super) length: f64,
    /// Least length in the box [m].
    pub(super) shortest: f64,
    /// Wrench of the unknown at the centre, by each coordinate, and the bound of what is left, reduced.
    pub(super) column: Affine,
    /// Change of `l_0/l` by each coordinate, to first order.
    pub(super) nearer: Vec<f64>,
    /// Bounds of what is left of `l_0/l` above and below.
    pub(super) curved: [f64; 2],
    /// Greatest motions of the chord, by translations and by all coordinates [m].
    pub(super) moves: [f64; 2],
    /// Limits of the chord tension [N] for a proof that it is within them.
    pub(super) within: [f64; 2],
    /// Chords of a cable that sags, and its bounds.
    pub(super) sag: Option<SagOverBox>,
    /// Rounding of its ends [m].
    pub(super) rounding: f64,
    /// Bound of the components of its wrenches over the box, at least 1.
    pub(super) size: f64,
    /// Wrench of a unit force upwards at the attachment, reduced.
    pub(super) lift: Vec6,
    /// Greatest change of it by turns, and what is left of the change after its first order.
    pub(super) lift_turns: [f64; 2],
}

/// Sag of a cable over a box.
#[derive(Clone, Copy)]
pub(super) struct SagOverBox {
    pub(super) chords: ChordRange,
    /// Chord tensions to which the bounds belong [N].
    pub(super) tensions: [f64; 2],
    pub(super) bound: SagBound,
}

/// Largest ratio of the chord tension of a sagging cable to its minimum for which its bounds are made.
const MAX_TENSION_RATIO: f64 = 1e3;

impl<'a> BoxFrame<'a> {
    /// Balance over a box.
    ///
    /// # Errors
    /// An anchor in the box, or dependent wrenches at its centre.
    pub(super) fn of(statement: &'a ProofStatement, region: &PositionBox) -> Result<Self, Undecided> {
        let (center, half) = (region.center(), region.half_widths());
        let axis = |k: usize| Vec3::from_fn(|i, _| f64::from(u8::from(i == k)));
        let moves = (0..3).filter(|k| half[*k] > 0.0).map(|k| [axis(k) * half[k], Vec3::zeros()]);
        let turns = &statement.turns;
        let turning = (0..3).filter(|k| turns[*k] > 0.0).map(|k| [Vec3::zeros(), axis(k) * turns[k]]);
        let steps: Vec<[Vec3; 2]> = moves.chain(turning).collect();

        let place = PlaceInBox { statement, center, half, steps: &steps };
        let cables = statement.cables.iter().map(|cable| place.cable(cable)).collect::<Result<Vec<_>, _>>()?;
        let hanging = place.hanging(&cables);
        let inverse = right_inverse(&cables, statement.coordinates.count()).ok_or(Undecided::NearSingular)?;
        let null_space = null_space(&cables, &inverse, statement.coordinates.count());
        let corners = corners_of(&center, &half);
        Ok(Self { statement, steps, cables, corners, inverse, null_space, hanging })
    }

    /// Load of a number together with the weight of sagging cables, over the box.
    pub(super) fn load(&self, number: usize) -> Affine {
        let Self { statement, hanging, .. } = self;
        let mut load = hanging.clone();
        load.center += statement.loads[number];
        let (turn, ell) = (statement.turns.norm(), statement.coordinates.ell());
        for [force, arm] in &statement.turning {
            for (by, [_, step]) in load.by.iter_mut().zip(&self.steps) {
                *by +=
                    statement.coordinates.reduce(&wrench_of(force, &step.cross(arm))) - moment_free(force, statement);
            }
            load.rest += uniform(0.5 * turn * turn * arm.norm() * force.norm() / ell, statement.coordinates.count());
        }
        load
    }
}

/// Reduced wrench of a force at the origin: the part of a load that does not turn.
fn moment_free(force: &Vec3, statement: &ProofStatement) -> Vec6 {
    statement.coordinates.reduce(&wrench_of(force, &Vec3::zeros()))
}

/// Bound that is the same for every component in use.
pub(super) fn uniform(bound: f64, count: usize) -> Vec6 {
    Vec6::from_fn(|i, _| if i < count { bound } else { 0.0 })
}

/// Corners of a box; a width of zero does not double them.
fn corners_of(center: &Vec3, half: &Vec3) -> Vec<Vec3> {
    let mut corners = vec![*center];
    for k in (0..3).filter(|k| half[*k] > 0.0) {
        let shifted = |side: f64| {
            corners.iter().map(move |corner| {
                let mut corner = *corner;
                corner[k] += side * half[k];
                corner
            })
        };
        corners = shifted(-1.0).chain(shifted(1.0)).collect();
    }
    corners
}

/// Where the platform is in a box.
struct PlaceInBox<'a> {
    statement: &'a ProofStatement,
    center: Vec3,
    half: Vec3,
    steps: &'a [[Vec3; 2]],
}

impl PlaceInBox<'_> {
    fn cable(&self, cable: &CableOfStatement) -> Result<CableFrame, Undecided> {
        let ProofStatement { coordinates, turns, up_w, .. } = self.statement;
        let arm = &cable.arm_w;
        let (reach, turn, shift) = (arm.norm(), turns.norm(), self.half.norm());
        let ell = coordinates.ell();
        let second = 0.5 * turn * turn * reach;

        // Chord: at the centre, its motion, and its least length in the box.
        let from_origin = cable.anchor_w - self.center;
        let chord = from_origin - arm;
        let length = chord.norm();
        let rounding = POINT_ROUNDING * (cable.anchor_w.amax() + self.center.amax() + arm.amax());
        let first = turn * reach;
        let apart = chord.abs() - self.half;
        let shortest = apart.map(|of| of.max(0.0)).norm() - first - second - rounding;
        let moves = [shift, shift + first + second];
        if shortest <= 1e-3 * length || shortest < 2.0 * rounding {
            return Err(Undecided::AnchorInBox);
        }

        // Wrench of t = q l_0. The moment is r × (B − p), bilinear in turn and position.
        let unit = chord / length;
        let column = coordinates.reduce_force(&unit, arm);
        let by = self.steps.iter().map(|[step, turn]| {
            let turned = turn.cross(arm);
            let force = -(step + turned);
            let moment = turned.cross(&from_origin) - arm.cross(step);
            reduced(coordinates, &force, &moment) / length
        });
        let force_rest = second + rounding;
        let moment_rest = (second + rounding) * (from_origin.norm() + shift) + shift * first + rounding * reach;
        let rest = uniform(force_rest.max(moment_rest / ell) / length, coordinates.count());
        let column = Affine { center: column, by: by.collect(), rest };

        // l_0/l by the Hessian of 1/l, whose eigenvalues are 2/l³ and −1/l³.
        let approaches = self.steps.iter().map(|[step, turn]| unit.dot(&(step + turn.cross(arm))) / length);
        let curve = moves[1].powi(2) * length / shortest.powi(3);
        let beside = (second + rounding) / length;
        let curved = [curve + beside, 0.5 * curve + beside];

        let chords = self.chords(&chord, (length, shortest), moves[1]);
        let sag = sag_over_box(cable, chords)?;
        let within = sag.map_or([cable.least.at(chords.longest), cable.greatest], |sag| {
            [sag.tensions[0] + sag.bound.below, cable.greatest - sag.bound.above]
        });
        let lift = coordinates.reduce_force(up_w, arm);
        let lift_turns = [(first + second) / ell, second / ell];
        let nearer = approaches.collect();
        let size = column.by.iter().fold(column.center.abs(), |sum, of| sum + of.abs()).amax().max(1.0);
        Ok(CableFrame {
            length,
            shortest,
            column,
            nearer,
            curved,
            moves,
            within,
            sag,
            rounding,
            size,
            lift,
            lift_turns,
        })
    }

    /// Range of the chords of a cable.
    fn chords(&self, chord: &Vec3, (length, shortest): (f64, f64), moves: f64) -> ChordRange {
        let rise = chord.dot(&self.statement.up_w).abs();
        let lifts: f64 = self.half.dot(&self.statement.up_w.abs()) + moves - self.half.norm();
        let (steepest, flattest) = (rise + lifts, (rise - lifts).max(0.0));
        ChordRange { longest: length + moves, steepest, flattest, sine: (steepest / shortest).min(1.0) }
    }

    /// Weight of the sagging cables on the platform: half of each, as if along its chord.
    fn hanging(&self, cables: &[CableFrame]) -> Affine {
        let ProofStatement { coordinates, up_w, .. } = self.statement;
        let count = coordinates.count();
        let mut load = Affine { center: Vec6::zeros(), by: vec![Vec6::zeros(); self.steps.len()], rest: Vec6::zeros() };
        for (cable, of) in cables.iter().zip(&self.statement.cables) {
            let Some(sag) = of.sag else { continue };
            let half = 0.5 * sag.weight;
            load.center -= cable.lift * (half * cable.length);
            for ((by, [_, turn]), nearer) in load.by.iter_mut().zip(self.steps).zip(&cable.nearer) {
                // The length grows as l_0/l falls.
                *by += cable.lift * (half * cable.length * nearer);
                let turned = reduced(coordinates, &Vec3::zeros(), &turn.cross(&of.arm_w).cross(up_w));
                *by -= turned * (half * cable.length);
            }
            let moves = cable.moves[1];
            let [change, left] = cable.lift_turns;
            let longer = 0.5 * moves * moves / cable.shortest + left * coordinates.ell() + 1e-15 * cable.length;
            load.rest += cable.lift.abs() * (half * longer * 1.01);
            let turned = (cable.length + moves) * left + moves * change;
            load.rest += uniform(half * turned, count);
        }
        load
    }
}

/// Sag of a cable whose chords have a range, from the least tension on for which it has a bound.
fn sag_over_box(cable: &CableOfStatement, chords: ChordRange) -> Result<Option<SagOverBox>, Undecided> {
    let Some(of) = cable.sag else { return Ok(None) };
    // A cable that is too slack for a bound is asked for more tension.
    let found = (0..12).find_map(|k| {
        let least = cable.least.at(chords.longest) * 1.15_f64.powi(k);
        let tensions = [least, cable.greatest.min(MAX_TENSION_RATIO * least)];
        of.bound(&chords, tensions).map(|bound| SagOverBox { chords, tensions, bound })
    });
    found.map(Some).ok_or(Undecided::SagBound)
}

/// Reduced wrench of a force and a moment about the platform origin.
fn reduced(coordinates: &Coordinates, force: &Vec3, moment: &Vec3) -> Vec6 {
    coordinates.reduce(&Vec6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z))
}

/// Rows of the right inverse Mᵀ(MMᵀ)⁻¹ of the wrenches at the centre; `None` if these are dependent.
fn right_inverse(cables: &[CableFrame], count: usize) -> Option<Vec<Vec6>> {
    let mut gram = Mat6::zeros();
    for cable in cables {
        gram += cable.column.center * cable.column.center.transpose();
    }
    for k in count..6 {
        gram[(k, k)] = 1.0;
    }
    let inverse = inverse6(&gram)?;
    let rows: Vec<Vec6> = cables.iter().map(|cable| inverse * cable.column.center).collect();
    rows.iter().all(|row| row.iter().all(|of| of.is_finite())).then_some(rows)
}

/// Orthonormal columns that the wrenches at the centre take to zero, by rows.
fn null_space(cables: &[CableFrame], inverse: &[Vec6], count: usize) -> Vec<Vec<f64>> {
    let m = cables.len();
    let free = m - count;
    // Columns of the projection 1 − Y M, the longest first.
    let mut left: Vec<Vec<f64>> = (0..m)
        .map(|j| (0..m).map(|i| f64::from(u8::from(i == j)) - inverse[i].dot(&cables[j].column.center)).collect())
        .collect();
    let mut rows = vec![Vec::with_capacity(free); m];
    for _ in 0..free {
        let size = |of: &Vec<f64>| of.iter().map(|x| x * x).sum::<f64>();
        let Some(longest) = (0..m).max_by(|a, b| size(&left[*a]).total_cmp(&size(&left[*b]))) else { break };
        let length = size(&left[longest]).sqrt();
        let unit: Vec<f64> = left[longest].iter().map(|x| x / length).collect();
        for column in &mut left {
            let along: f64 = column.iter().zip(&unit).map(|(x, u)| x * u).sum();
            column.iter_mut().zip(&unit).for_each(|(x, u)| *x -= along * u);
        }
        rows.iter_mut().zip(&unit).for_each(|(row, u)| row.push(*u));
    }
    rows
}
