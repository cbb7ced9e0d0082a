//! Pose nearest to a requested one that fewer cables than degrees of freedom can hold.
//!
//! With m cables the equilibria form a surface of m dimensions in the space of poses and lengths. A step along it
//! satisfies `K dx = B dL`, B being the derivative of the wrench with respect to the lengths. Each iteration takes the
//! step that comes nearest to the requested pose; then forward statics brings the platform back to the surface, to a
//! stable equilibrium of the new lengths. The curvature of the surface is learnt from the steps (Broyden, Fletcher,
//! Goldfarb, Shanno); the first step assumes a flat surface. Limits of tensions and lengths are linearised at each step
//! (sequential quadratic programming); a merit of distance and violation decides whether the step is taken.

mod bounds;

use super::collect::with_stability;
use super::drag::tangent_with_drag;
use super::equilibrium::{CableState, Equilibrium};
use super::error::{RopeRefusal, StaticsError};
use super::forward::forward;
use super::ideal;
use super::limits::TensionRange;
use super::loaded_cable::LoadedCable;
use super::model::StaticModel;
use super::ropes;
use super::supports;
use crate::math::{DMat, Mat6, Vec6};
use crate::platform::{Coordinates, StraightCable, load_wrench, wrench_of};
use crate::robot::{Cable, Pose, Robot};
use bounds::{Bound, Quadratic, excess};

/// Equilibrium near a requested pose.
#[derive(Debug, Clone, PartialEq)]
pub struct NearestEquilibrium {
    /// Equilibrium, stable or indifferent; its pose differs from the requested one.
    pub equilibrium: Equilibrium,
    /// Distance of its pose from the requested one [m], see [`pose_distance`].
    pub distance: f64,
}

/// Maximum number of steps; 3 to 30 are observed.
const MAX_STEPS: usize = 300;

/// Iterations of forward statics in all after which no further step is made. Searches that end take up to some
/// thousands; one without an end took ten thousand.
const MAX_ITERATIONS: usize = 20_000;

/// Remaining approach along the surface, over the size of the robot, at which the pose counts as nearest; and the value
/// that is accepted if rounding allows no further approach.
const MAX_APPROACH: f64 = 1e-11;
const NEAR: f64 = 1e-6;

/// Minimum ratio of a cable's length after a step to its length before. At zero a step could take a cable away; near 1
/// a pose that needs a much shorter cable would take many steps.
const MIN_SHORTENED: f64 = 0.2;

/// Ratio of the remaining approach to the remaining distance below which a step may be taken for its direction alone.
/// The distance falls with the square of this ratio, so it drowns in rounding below 1e-8; above 1e-2 the distance
/// decides well.
const NEARLY_SQUARE: f64 = 1e-4;

/// Maximum ratio of the remaining approach after such a step to that before. Nearer to 1, rounding counts as progress;
/// far below, the last steps along a strongly curved surface are refused.
const MAX_APPROACH_RATIO: f64 = 0.9;

/// Damping of the step: its first value, its factor after each refused step (its inverse after each step taken), the
/// value below which it is zero, and the value at which the search ends. The reference is the curvature of the surface,
/// which starts as 1. A first value far below 0.1 would hardly change the step that has just been refused; far above,
/// the search would creep along curved surfaces. At the last value a step is a millionth of a millionth of the
/// remaining distance.
const FIRST_DAMPING: f64 = 0.1;
const DAMPING_FACTOR: f64 = 10.0;
const NO_DAMPING: f64 = 1e-3;
const MAX_DAMPING: f64 = 1e12;

/// Singular values of the unit wrenches, relative to one, below which they are left out of the first guess of tensions.
/// With a smaller limit, nearly parallel cables would share a load by excessive tensions; cables at more than a
/// billionth of a radian to each other do share a load.
const PARALLEL: f64 = 1e-9;

/// Minimum tension of a first guess over the weight of a cable as long as its chord. At a quarter, a level cable is 1.8
/// chords long. With less, the guess is all sag; well above it, light platforms are lifted by their cables.
const MIN_GUESS: f64 = 0.25;

/// Weight of the largest violation in the merit over the sum of the multipliers: above 1, so that each step within the
/// limits is a gain.
const PENALTY: f64 = 2.0;

/// Curvature of a change of the tensions alone, beside 1 for motions: such changes are made only where limits demand
/// it.
const TENSION_ALONE: f64 = 1e-3;

/// Minimum cosine between a step and the change of slope along it at which the surface's curvature is updated. Below,
/// the quotient is rounding, or the curvature has the other sign.
const MIN_CURVATURE: f64 = 1e-3;

/// Ratio to the largest singular value below which a singular value counts as zero.
const ZERO: f64 = 1e-12;

/// Minimum motion per unit step along the surface that counts: a smaller motion is a change of tensions alone.
const ALONG: f64 = 1e-9;

/// Distance between two poses [m]: root of the sum of squares of the translation and of ℓ times the angle between them,
/// ℓ being [`Robot::platform_length`].
pub fn pose_distance(robot: &Robot, from: &Pose, to: &Pose) -> f64 {
    gap(robot, from, to).norm()
}

/// Scaled motion from one pose to another, in the platform's coordinates.
pub(super) fn gap(robot: &Robot, from: &Pose, to: &Pose) -> Vec6 {
    let p = to.position_w - from.position_w;
    let turn = (to.rot_wp * from.rot_wp.inverse()).scaled_axis() * robot.platform_length();
    robot.platform.motion.reduced(&Vec6::new(p.x, p.y, p.z, turn.x, turn.y, turn.z))
}

/// Nearest pose that the cables can hold with some lengths, for robots with fewer cables than degrees of freedom. It is
/// nearest by [`pose_distance`], among the poses around the one reached from the first guess of lengths. The tensions
/// keep the limits of the robot file; a cable with weight is at most 1.25 times as long as its chord if the platform
/// can be held so, and at most twice as long.
///
/// # Errors
/// [`StaticsError`]: more ideal cables than degrees of freedom, a pose out of a planar platform's plane,
/// coinciding ends, no pose within the limits, or no convergence.
///
/// # Example
/// ```
/// # use funicular::{robot::{Pose, Robot}, statics::{self, StaticModel}};
/// // A body on one cable hangs straight below the anchor; this is also the nearest pose to one beside it.
/// let text = r#"
///     name = "pendulum"
///     [platform]
///     mass_kg = 2.0
///     motion = "point-mass"
///     [materials.cord]
///     axial_stiffness_n = 1e6
///     mass_kg_per_m = 0.0
///     [[cables]]
///     name = "only"
///     material = "cord"
///     anchor_m = [0.0, 0.0, 3.0]
/// "#;
/// let robot = Robot::from_toml(text)?;
/// let found = statics::nearest_equilibrium(&robot, &Pose::new([0.3, 0.0, 1.0], [0.0; 3]), StaticModel::Catenary)?;
/// assert!((found.distance - 0.3).abs() < 1e-9);
/// assert!((found.equilibrium.pose.position_w.z - 1.0).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn nearest_equilibrium(
    robot: &Robot,
    requested: &Pose,
    model: StaticModel,
) -> Result<NearestEquilibrium, StaticsError> {
    ropes::refuse(robot, RopeRefusal::Analysis)?;
    if robot.has_supports() {
        let solve = |rigid: &Robot| nearest_equilibrium(rigid, requested, model);
        let mut found = supports::on_flexible_supports(
            robot,
            solve,
            |found: &mut NearestEquilibrium| &mut found.equilibrium.cables,
            &[],
        )?;
        found.equilibrium = with_stability(robot, found.equilibrium);
        return Ok(found);
    }

    if model == StaticModel::Ideal {
        if robot.constraint().is_redundant() {
            let (cables, dof) = (robot.cables.len(), robot.platform.motion.count());
            return Err(StaticsError::CableCount { cables, dof });
        }
        // Straight cables hold the same poses with the same tensions, whether they stretch or not.
        let NearestEquilibrium { equilibrium, distance } = nearest_equilibrium(robot, requested, StaticModel::Spring)?;
        let tensions: Vec<f64> = equilibrium.cables.iter().map(|cable| cable.tension_platform).collect();
        let equilibrium = ideal::collect(robot, equilibrium.pose, &tensions, equilibrium.iterations);
        return Ok(NearestEquilibrium { equilibrium, distance });
    }
    robot.platform.motion.check(requested)?;

    // Reach the surface by a first guess of the lengths, then move along it.
    let mut search = SurfaceSearch::new(robot, requested, model)?;
    let size = search.size;
    for _ in 0..MAX_STEPS {
        if search.could_move() <= MAX_APPROACH * size && search.violation() <= MAX_APPROACH {
            break;
        }
        if search.iterations > MAX_ITERATIONS {
            break;
        }
        if !search.step() && !search.shorten() {
            break;
        }
    }

    let could = search.could_move();
    let SurfaceSearch { mut here, missing, iterations, .. } = search;
    if could > NEAR * size {
        let p = here.pose.position_w;
        let (residual, limit) = (could / size, NEAR);
        return Err(StaticsError::NotNearest { iterations, residual, limit, x: p.x, y: p.y, z: p.z });
    }

    // Only ropes of zero length come near a pose on the line between their anchors.
    let torn = |(cable, state): (&Cable, &CableState)| state.tension_platform > cable.material.axial_stiffness;
    if robot.cables.iter().zip(&here.cables).any(torn) {
        return Err(StaticsError::Singular { obstacle: None });
    }

    here.iterations = iterations;
    bounds::check(robot, &here)?;
    Ok(NearestEquilibrium { equilibrium: here, distance: missing.norm() })
}

/// Search for the nearest pose: steps along the surface of the poses that the cables can hold.
struct SurfaceSearch<'a> {
    robot: &'a Robot,
    requested: &'a Pose,
    model: StaticModel,
    coordinates: Coordinates,
    /// Reference for distances: size of the platform plus the longest cable [m].
    size: f64,
    /// Last equilibrium, with its lengths [m].
    here: Equilibrium,
    lengths: Vec<f64>,
    surface: Surface,
    /// Limits about there.
    bounds: Vec<Bound>,
    /// Weight of the violation of limits in the merit [m²].
    penalty: f64,
    /// Scaled motion from there to the requested pose.
    missing: Vec6,
    /// Curvature of the surface, learnt from the steps.
    bend: Mat6,
    /// Damping that shortens steps; zero while they succeed.
    damping: f64,
    /// Iterations of forward statics so far.
    iterations: usize,
}

impl<'a> SurfaceSearch<'a> {
    fn new(robot: &'a Robot, requested: &'a Pose, model: StaticModel) -> Result<Self, StaticsError> {
        let coordinates = Coordinates::of(robot);
        let lengths = first_lengths(robot, requested, model)?;
        let here = forward(robot, &lengths, model, Some(requested))?;
        let size = coordinates.ell() + lengths.iter().copied().fold(0.0, f64::max);
        let surface = Surface::at(robot, &here);
        let bounds = bounds::about(robot, &here, &surface.directions, &surface.lengths);
        let missing = gap(robot, &here.pose, requested);
        let iterations = here.iterations;
        let (bend, damping) = (Mat6::identity(), 0.0);

        Ok(Self {
            robot,
            requested,
            model,
            coordinates,
            size,
            here,
            lengths,
            surface,
            bounds,
            penalty: 0.0,
            missing,
            bend,
            damping,
            iterations,
        })
    }

    /// Part of the missing motion that the surface and the limits allow; zero at the nearest pose [m].
    fn could_move(&self) -> f64 {
        could_move(&self.surface, &self.bounds, &self.missing)
    }

    /// Violation of the limits, relative to them.
    fn violation(&self) -> f64 {
        excess(&self.bounds)
    }

    /// Steps along the surface and back to it. True if the step is a gain and was taken.
    fn step(&mut self) -> bool {
        let could = self.could_move();
        let Some(StepOnSurface { motion, by_length, pressure }) =
            self.surface.step(&self.missing, &self.bend, self.damping, &self.bounds)
        else {
            return false;
        };
        self.penalty = self.penalty.max(PENALTY * pressure.iter().sum::<f64>());
        let lengths = self.lengths.iter().zip(&by_length).map(|(l, d)| (l + d).max(MIN_SHORTENED * l));
        let lengths: Vec<f64> = lengths.collect();
        let start = self.coordinates.moved(&self.here.pose, &motion);
        let next = match forward(self.robot, &lengths, self.model, Some(&start)) {
            Ok(next) => next,
            Err(error) => {
                if let StaticsError::NotConverged { iterations, .. } = error {
                    self.iterations += iterations;
                }
                return false;
            }
        };

        self.iterations += next.iterations;
        let missing = gap(self.robot, &next.pose, self.requested);
        let surface = Surface::at(self.robot, &next);
        let bounds = bounds::about(self.robot, &next, &surface.directions, &surface.lengths);
        let next_could = could_move(&surface, &bounds, &missing);

        // Near the end the distance drowns in rounding; then the direction decides.
        let merit = |missing: &Vec6, bounds: &[Bound]| 0.5 * missing.norm_squared() + self.penalty * excess(bounds);
        let nearer = merit(&missing, &bounds) < merit(&self.missing, &self.bounds);
        let straighter = could < NEARLY_SQUARE * self.missing.norm()
            && next_could < MAX_APPROACH_RATIO * could
            && excess(&bounds) <= excess(&self.bounds).max(NEARLY_SQUARE);
        if !nearer && !straighter {
            return false;
        }

        // Slope of the merit's smooth part, with the pressure of the limits.
        let slope = |surface: &Surface, missing: &Vec6, bounds: &[Bound]| {
            let pressed =
                bounds.iter().zip(&pressure).map(|(bound, pressure)| surface.motion(&bound.slope) * *pressure);
            surface.along(missing) + pressed.sum::<Vec6>()
        };
        let moved = gap(self.robot, &self.here.pose, &next.pose);
        let turned = slope(&self.surface, &self.missing, &self.bounds) - slope(&surface, &missing, &bounds);
        update(&mut self.bend, &surface.along(&moved), &turned);
        (self.here, self.lengths, self.missing, self.surface) = (next, lengths, missing, surface);
        self.bounds = bounds;
        self.damping = if self.damping < NO_DAMPING { 0.0 } else { self.damping * (1.0 / DAMPING_FACTOR) };
        true
    }

    /// Makes the next step shorter; false if it is short enough to give up. The learnt curvature may be wrong.
    fn shorten(&mut self) -> bool {
        if self.damping == 0.0 {
            self.bend = Mat6::identity();
        }
        self.damping = (DAMPING_FACTOR * self.damping).max(FIRST_DAMPING);
        self.damping <= MAX_DAMPING
    }
}

/// Lengths of cables whose tensions balance the platform's load as well as straight cables can, none below its minimum.
fn first_lengths(robot: &Robot, pose: &Pose, model: StaticModel) -> Result<Vec<f64>, StaticsError> {
    let coordinates = Coordinates::of(robot);
    let n = robot.cables.len();

    // Load with half of each cable's load, and the unit wrenches.
    let mut load = load_wrench(robot, pose);
    let mut columns = DMat::zeros(6, n);
    let mut loaded = Vec::with_capacity(n);
    for (i, cable) in robot.cables.iter().enumerate() {
        let straight = StraightCable::at(cable, pose);
        let chord = straight.chord_w.norm();
        if chord == 0.0 {
            return Err(StaticsError::CoincidingEnds { cable: cable.name.clone() });
        }
        let cable = LoadedCable::at(robot, i, pose, model);
        load += wrench_of(&(cable.load.vector_w() * (0.5 * chord)), &straight.lever_w);
        columns.set_column(i, &straight.unit_wrench(&coordinates));
        loaded.push((cable, straight.chord_w));
    }

    // Tensions that balance it best, and the corresponding lengths.
    let right = -coordinates.reduce(&load);
    let balanced = columns.svd(true, true).solve(&right, PARALLEL).unwrap_or_else(|_| Vec6::zeros().rows(0, n).into());
    let lengths = (0..n).map(|i| {
        let (cable, chord_w) = &loaded[i];
        let chord = chord_w.norm();
        // Limit the slackness, so that the length is not all sag.
        let least = TensionRange::of(robot, i, chord_w).minimum.max(MIN_GUESS * cable.load.size * chord);
        let most = robot.cables[i].limits().maximum.unwrap_or(f64::INFINITY);
        cable.length_with_tension(pose, balanced[i].max(least).min(most))
    });
    Ok(lengths.collect())
}

/// Updates the curvature from a step: the change of the slope of half the squared distance along it. The matrix stays
/// positive definite.
fn update(bend: &mut Mat6, moved: &Vec6, slope: &Vec6) {
    let (by, bent) = (moved.dot(slope), *bend * moved);
    let along = moved.dot(&bent);
    if by > MIN_CURVATURE * moved.norm() * slope.norm() && along > 0.0 {
        *bend += slope * slope.transpose() / by - bent * bent.transpose() / along;
    }
}

/// Part of the missing motion that surface and limits allow [m].
fn could_move(surface: &Surface, bounds: &[Bound], missing: &Vec6) -> f64 {
    // Limits that no step reaches leave the free approach.
    let step = surface.step(missing, &Mat6::identity(), 0.0, bounds);
    step.map_or_else(|| surface.along(missing).norm(), |step| step.motion.norm())
}

/// Step along the surface.
struct StepOnSurface {
    /// Motion, reduced.
    motion: Vec6,
    /// Change of the lengths [m].
    by_length: Vec<f64>,
    /// Multiplier of each limit, per unit of its relative violation [m²].
    pressure: Vec<f64>,
}

/// Directions in which an equilibrium can move by changes of the lengths.
struct Surface {
    /// Orthonormal motions; zero for changes of the tensions alone, which come last.
    directions: Vec<Vec6>,
    /// Changes of the lengths for each direction [m/m].
    lengths: Vec<Vec<f64>>,
}

impl Surface {
    fn at(robot: &Robot, equilibrium: &Equilibrium) -> Self {
        let coordinates = Coordinates::of(robot);
        let (n, m) = (coordinates.count(), equilibrium.cables.len());
        let stiffness = tangent_with_drag(robot, equilibrium).expect("the cables are elastic");
        let stiffness = coordinates.reduce_matrix(&stiffness);
        // Zero rows make it square, so that all right singular vectors are computed.
        let mut equations = DMat::zeros(n + m, n + m);
        equations.view_mut((0, 0), (n, n)).copy_from(&stiffness.view((0, 0), (n, n)));
        for (i, cable) in equilibrium.cables.iter().enumerate() {
            let by_length = cable.force_by_length_w().expect("an elastic cable hangs");
            let column = coordinates.reduce_force(&by_length, &cable.lever_w);
            equations.view_mut((0, n + i), (n, 1)).copy_from(&-column.rows(0, n));
        }

        // Motions with the changes of length that cause them: the null space of both.
        let svd = equations.svd(false, true);
        let rows = svd.v_t.expect("requested above");
        let largest = svd.singular_values.max();
        let free: Vec<usize> = (0..n + m).filter(|&k| svd.singular_values[k] <= ZERO * largest).collect();

        // Orthonormal basis of these motions; a vector that moves nothing is a change of tensions alone.
        let motions = DMat::from_fn(6, free.len(), |i, k| if i < n { rows[(free[k], i)] } else { 0.0 });
        let svd = motions.svd(true, true);
        let (u, v_t) = (svd.u.expect("requested above"), svd.v_t.expect("requested above"));
        let (kept, still): (Vec<usize>, Vec<usize>) =
            (0..svd.singular_values.len()).partition(|&k| svd.singular_values[k] > ALONG);
        let changes = |k: usize, size: f64| -> Vec<f64> {
            let of = |i: usize| free.iter().enumerate().map(|(j, &row)| v_t[(k, j)] * rows[(row, n + i)]).sum::<f64>();
            (0..m).map(|i| of(i) / size).collect()
        };
        let moving = kept.iter().map(|&k| changes(k, svd.singular_values[k]));
        let lengths = moving.chain(still.iter().map(|&k| changes(k, 1.0))).collect();
        let motions = kept.iter().map(|&k| Vec6::from_fn(|i, _| u[(i, k)]));
        Self { lengths, directions: motions.chain(still.iter().map(|_| Vec6::zeros())).collect() }
    }

    /// Motion with these components along the directions.
    fn motion(&self, components: &[f64]) -> Vec6 {
        self.directions.iter().zip(components).map(|(direction, part)| direction * *part).sum()
    }

    /// Projection of a motion on the surface.
    fn along(&self, motion: &Vec6) -> Vec6 {
        self.directions.iter().map(|direction| direction * direction.dot(motion)).sum()
    }

    /// Step along the surface that comes nearest to a given motion for this curvature and damping, within the limits;
    /// `None` if there is none.
    fn step(&self, motion: &Vec6, bend: &Mat6, damping: f64, bounds: &[Bound]) -> Option<StepOnSurface> {
        let (r, u) = (self.directions.len(), &self.directions);
        let own = |i: usize| if u[i] == Vec6::zeros() { TENSION_ALONE } else { damping };
        let matrix = DMat::from_fn(r, r, |i, j| u[i].dot(&(bend * u[j])) + if i == j { own(i) } else { 0.0 });
        let right: Vec<f64> = u.iter().map(|direction| direction.dot(motion)).collect();
        let (parts, pressure) = Quadratic { matrix, right }.within(bounds, 1.0 / (1.0 + damping))?;

        let mut by_length = vec![0.0; self.lengths.first().map_or(0, Vec::len)];
        for (part, lengths) in parts.iter().zip(&self.lengths) {
            by_length.iter_mut().zip(lengths).for_each(|(sum, length)| *sum += part * length);
        }
        Some(StepOnSurface { motion: self.motion(&parts), by_length, pressure })
    }
}
