//! Distances between sagging cables, platform and obstacles.
//!
//! The free span of a cable is a plane convex curve. An arc of it stays within its sagitta of its chord, so distances
//! between chords enclose those between curves, and halving an arc quarters the sagitta (docs/theory.md, section 10a).
//! Every distance is certified: no other pair of points is nearer by more than [`TOLERANCE`].

mod arc;
mod between;
mod bounded;
mod cable_pair;
mod convex_overlap;
mod depth;
mod free_way;
mod moves;
mod segments;
mod solid;
mod span;

use crate::math::Vec3;
use crate::robot::{Body, Cable, Pose, RequiredClearance, Robot, vector};
use crate::statics::Equilibrium;
use parry3d_f64::shape::{ConvexPolyhedron, Segment, SharedShape, TriMesh};
use solid::PlacedBody;
use span::{FreeSpan, SpanEnd};
use std::sync::Arc;

pub use between::{BetweenPlaces, WayBetween};
pub use free_way::FreeWay;
pub use moves::{Crossing, OnTheWay, WAY_TOLERANCE, straight_crossings};

/// Bound of the error of a distance between two cables [m].
pub const TOLERANCE: f64 = 1e-10;

/// Bound of the error of a distance between a cable and a body [m].
pub const BODY_TOLERANCE: f64 = 1e-8;

/// Distance up to which things touch [m]: the error of a distance between a cable and a body.
const TOUCHING: f64 = BODY_TOLERANCE;

/// Name of the convex hull of the attachments, the body of a platform without other bodies.
pub const HULL: &str = "platform";

/// Pair of things whose distance counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClearancePair {
    /// Two cables, by their indices.
    Cables(usize, usize),
    /// Cable and body of the platform.
    CableAndPlatform {
        /// Index of the cable.
        cable: usize,
        /// Index of the body in [`Surroundings::platform_names`].
        body: usize,
    },
    /// Cable and obstacle.
    CableAndObstacle {
        /// Index of the cable.
        cable: usize,
        /// Index of the obstacle.
        obstacle: usize,
    },
    /// Body of the platform and obstacle.
    PlatformAndObstacle {
        /// Index of the body in [`Surroundings::platform_names`].
        body: usize,
        /// Index of the obstacle.
        obstacle: usize,
    },
}

/// Kind of a pair, with a required distance of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClearanceKind {
    /// Two cables.
    Cables,
    /// A cable and the platform.
    Platform,
    /// An obstacle, and a cable or the platform.
    Obstacles,
}

impl ClearanceKind {
    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cables => "cables",
            Self::Platform => "platform",
            Self::Obstacles => "obstacles",
        }
    }
}

impl ClearancePair {
    /// Sum of a number over the cables of the pair, by their indices.
    fn of_cables(self, number: impl Fn(usize) -> f64) -> f64 {
        match self {
            Self::Cables(i, j) => number(i) + number(j),
            Self::CableAndPlatform { cable, .. } | Self::CableAndObstacle { cable, .. } => number(cable),
            Self::PlatformAndObstacle { .. } => 0.0,
        }
    }

    /// Kind of the pair.
    pub fn kind(self) -> ClearanceKind {
        match self {
            Self::Cables(..) => ClearanceKind::Cables,
            Self::CableAndPlatform { .. } => ClearanceKind::Platform,
            Self::CableAndObstacle { .. } | Self::PlatformAndObstacle { .. } => ClearanceKind::Obstacles,
        }
    }
}

/// Distance of a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clearance {
    /// Pair.
    pub pair: ClearancePair,
    /// Distance between the surfaces [m]; negative by the depth where one is in the other. Centre lines of ropes that
    /// cross each other, and a body without inside, add the radii of the ropes alone.
    pub distance: f64,
    /// Required distance [m].
    pub required: f64,
    /// Nearest points, on the centre lines of cables, world axes [m].
    pub points_w: [Vec3; 2],
}

impl Clearance {
    /// Distance beyond the required one [m]; negative if the pair is too near, and where it touches, whatever is
    /// required.
    pub fn margin(&self) -> f64 {
        let beyond = self.distance - self.required;
        if self.touches() { beyond.min(-TOUCHING) } else { beyond }
    }

    /// True if the things of the pair touch or overlap.
    pub fn touches(&self) -> bool {
        self.distance <= TOUCHING
    }

    /// True if the pair does not touch and keeps its required distance.
    pub fn is_kept(&self) -> bool {
        self.margin() >= 0.0
    }
}

/// Robot with the bodies that its cables and its platform may touch, prepared once for many poses.
pub struct Surroundings<'a> {
    robot: &'a Robot,
    required: RequiredClearance,
    from_end: f64,
    platform: Vec<PlatformBody<'a>>,
    /// Obstacles in the world.
    obstacles: Vec<PlacedBody>,
}

/// Body of the platform.
enum PlatformBody<'a> {
    Given(&'a Body),
    /// Convex hull of the attachments, platform frame.
    Hull(SharedShape),
}

impl<'a> Surroundings<'a> {
    /// Surroundings of a robot.
    pub fn of(robot: &'a Robot) -> Self {
        let required = robot.clearance.unwrap_or_default();
        let platform = if robot.platform.bodies.is_empty() {
            hull_of_attachments(robot).map(PlatformBody::Hull).into_iter().collect()
        } else {
            robot.platform.bodies.iter().map(PlatformBody::Given).collect()
        };
        Self {
            robot,
            required,
            from_end: robot.clearance_from_end(),
            platform,
            obstacles: robot.obstacles.iter().map(PlacedBody::in_world).collect(),
        }
    }

    /// Names of the bodies of the platform.
    pub fn platform_names(&self) -> Vec<&'a str> {
        let name = |body: &PlatformBody<'a>| match body {
            PlatformBody::Given(body) => body.name.as_str(),
            PlatformBody::Hull(_) => HULL,
        };
        self.platform.iter().map(name).collect()
    }

    /// Things of a pair in words: `cables "1" and "3"`, `cable "2" and the obstacle "column"`.
    pub fn pair_text(&self, pair: ClearancePair) -> String {
        let cable = |i: usize| &self.robot.cables[i].name;
        let obstacle = |i: usize| &self.robot.obstacles[i].name;
        let body = |i: usize| match self.platform_names()[i] {
            HULL => "the platform".to_owned(),
            name => format!("the body \"{name}\" of the platform"),
        };
        match pair {
            ClearancePair::Cables(i, j) => format!("cables \"{}\" and \"{}\"", cable(i), cable(j)),
            ClearancePair::CableAndPlatform { cable: i, body: k } => format!("cable \"{}\" and {}", cable(i), body(k)),
            ClearancePair::CableAndObstacle { cable: i, obstacle: k } => {
                format!("cable \"{}\" and the obstacle \"{}\"", cable(i), obstacle(k))
            }
            ClearancePair::PlatformAndObstacle { body: k, obstacle: o } => {
                format!("{} and the obstacle \"{}\"", body(k), obstacle(o))
            }
        }
    }

    /// Distances of all pairs at an equilibrium, of one kind or of all. A pair whose cable is shorter than the ends
    /// that are left out has none.
    pub fn clearances(&self, rest: &Equilibrium, kind: Option<ClearanceKind>) -> Vec<Clearance> {
        let at = self.at(rest);
        at.pairs_of(kind).filter_map(|pair| at.clearance(pair, f64::INFINITY)).collect()
    }

    /// Pair with the least margin at an equilibrium, of one kind or of all; `None` without such a pair.
    pub fn least(&self, rest: &Equilibrium, kind: Option<ClearanceKind>) -> Option<Clearance> {
        self.at(rest).least(kind)
    }

    /// Pairs of cables that touch at an equilibrium: their centre lines cross, or pass each other nearer than the
    /// radii of their ropes. A pair without compared parts has none.
    pub fn crossing_cables(&self, rest: &Equilibrium) -> Vec<Clearance> {
        self.at(rest).crossing_cables()
    }

    /// Pairs of straight cables that touch at a pose, as [`Self::crossing_cables`]: for poses without an equilibrium.
    pub fn crossing_chords(&self, pose: &Pose) -> Vec<Clearance> {
        let ends = |cable: &Cable| [pose.point_w(&cable.attachment_p), cable.anchor.reference_w()];
        let ends: Vec<[Vec3; 2]> = self.robot.cables.iter().map(ends).collect();
        let spans = ends.iter().zip(&self.robot.cables);
        let spans = spans.map(|(ends_w, cable)| FreeSpan::through(ends_w, cable.radius(), self.from_end)).collect();
        self.placed(pose, spans).crossing_cables()
    }

    /// Pair with the least margin while cables are straight between points, from the platform to the anchor: those of a
    /// simulation. A cable without points has no pair.
    ///
    /// # Example
    /// ```
    /// use funicular::clearance::Surroundings;
    /// use funicular::robot::Robot;
    /// use funicular::simulation::{Simulation, SimulationSettings};
    /// use funicular::statics::{self, StaticModel};
    ///
    /// let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
    /// let rest = statics::solve(&robot, StaticModel::Catenary, None)?.equilibrium;
    /// let mut simulation = Simulation::new(&robot, &rest, &[], 0.1, &SimulationSettings::default())?;
    /// let surroundings = Surroundings::of(&robot);
    /// let moving = surroundings.least_through(&rest.pose, &simulation.curves_w(0.0)).unwrap();
    /// let resting = surroundings.least(&rest, None).unwrap();
    /// assert_eq!(moving.pair, resting.pair);
    /// assert!((moving.distance - resting.distance).abs() < 1e-4); // m
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn least_through(&self, pose: &Pose, curves_w: &[Vec<Vec3>]) -> Option<Clearance> {
        self.least_through_of(pose, curves_w, &|_| true)
    }

    /// Least margin as in [`least_through`](Self::least_through), of the pairs that `counts` chooses.
    pub fn least_through_of(
        &self,
        pose: &Pose,
        curves_w: &[Vec<Vec3>],
        counts: &dyn Fn(ClearancePair) -> bool,
    ) -> Option<Clearance> {
        let spans = curves_w.iter().zip(&self.robot.cables);
        let spans = spans.map(|(points_w, cable)| FreeSpan::through(points_w, cable.radius(), self.from_end)).collect();
        let placed = self.placed(pose, spans);
        placed.least_of(placed.pairs().into_iter().filter(|pair| counts(*pair)))
    }

    fn at<'s>(&'s self, rest: &'s Equilibrium) -> Placed<'s> {
        let spans = rest.cables.iter().zip(&self.robot.cables);
        let spans = spans.map(|(state, cable)| FreeSpan::of(state, cable.radius(), self.from_end));
        self.placed(&rest.pose, spans.collect())
    }

    fn placed<'s>(&'s self, pose: &Pose, spans: Vec<FreeSpan<'s>>) -> Placed<'s> {
        let platform = self.platform.iter().map(|body| match body {
            PlatformBody::Given(body) => PlacedBody::on_platform(body, pose),
            PlatformBody::Hull(shape) => PlacedBody::of_shape(shape.clone(), pose),
        });
        Placed { of: self, spans, platform: platform.collect(), tolerance: BODY_TOLERANCE }
    }

    fn required(&self, pair: ClearancePair) -> f64 {
        match pair.kind() {
            ClearanceKind::Cables => self.required.cables,
            ClearanceKind::Platform => self.required.platform,
            ClearanceKind::Obstacles => self.required.obstacles,
        }
    }
}

/// Convex hull of the attachments, platform frame; `None` if all are at one point.
fn hull_of_attachments(robot: &Robot) -> Option<SharedShape> {
    let mut points: Vec<_> = robot.cables.iter().map(|cable| vector(&cable.attachment_p)).collect();
    points.sort_by(|a, b| a.to_array().partial_cmp(&b.to_array()).unwrap_or(std::cmp::Ordering::Equal));
    points.dedup();
    match points[..] {
        [] | [_] => None,
        [one, other] => Some(SharedShape(Arc::new(Segment::new(one, other)))),
        _ => {
            if let Some(hull) = solid_hull(&points) {
                return Some(SharedShape(Arc::new(hull)));
            }
            // Attachments in one plane: all triangles between them cover their hull.
            let n = points.len() as u32;
            let all = (0..n).flat_map(|i| (i + 1..n).flat_map(move |j| (j + 1..n).map(move |k| [i, j, k]))).collect();
            TriMesh::new(points, all).ok().map(|mesh| SharedShape(Arc::new(mesh)))
        }
    }
}

/// Thickness of a hull over its size below which it counts as flat: coordinates of attachments are rounded to this.
const FLAT: f64 = 1e-9;

/// Convex hull of points that do not lie in one plane.
fn solid_hull(points: &[parry3d_f64::math::Vector]) -> Option<ConvexPolyhedron> {
    // The farthest point from the line and the plane of those before it.
    let origin = points[0];
    let farthest = |measure: &dyn Fn(parry3d_f64::math::Vector) -> f64| {
        points.iter().map(|point| (*point - origin, measure(*point - origin))).max_by(|a, b| a.1.total_cmp(&b.1))
    };
    let (along, size) = farthest(&|offset| offset.length())?;
    let (across, _) = farthest(&|offset| offset.cross(along).length())?;
    let normal = along.cross(across).normalize_or_zero();
    let (_, thickness) = farthest(&|offset| offset.dot(normal).abs())?;
    if thickness <= FLAT * size { None } else { ConvexPolyhedron::from_convex_hull(points) }
}

/// Surroundings at one pose.
struct Placed<'a> {
    of: &'a Surroundings<'a>,
    spans: Vec<FreeSpan<'a>>,
    platform: Vec<PlacedBody>,
    /// Error of the distance of a cable from a body, by which it is too large at most [m].
    tolerance: f64,
}

impl Placed<'_> {
    /// Pairs of one kind or of all.
    fn pairs_of(&self, kind: Option<ClearanceKind>) -> impl Iterator<Item = ClearancePair> {
        self.pairs().into_iter().filter(move |pair| kind.is_none_or(|kind| pair.kind() == kind))
    }

    /// All pairs: cables, then cables and platform, then obstacles.
    fn pairs(&self) -> Vec<ClearancePair> {
        let (cables, bodies, obstacles) = (self.spans.len(), self.platform.len(), self.of.obstacles.len());
        let mut pairs = Vec::with_capacity(cables * (cables / 2 + bodies + obstacles) + bodies * obstacles);
        pairs.extend((0..cables).flat_map(|i| (i + 1..cables).map(move |j| ClearancePair::Cables(i, j))));
        let with_platform = |cable| (0..bodies).map(move |body| ClearancePair::CableAndPlatform { cable, body });
        pairs.extend((0..cables).flat_map(with_platform));
        let with_obstacle =
            |cable| (0..obstacles).map(move |obstacle| ClearancePair::CableAndObstacle { cable, obstacle });
        pairs.extend((0..cables).flat_map(with_obstacle));
        let between = |body| (0..obstacles).map(move |obstacle| ClearancePair::PlatformAndObstacle { body, obstacle });
        pairs.extend((0..bodies).flat_map(between));
        pairs
    }

    /// Pairs of cables that touch.
    fn crossing_cables(&self) -> Vec<Clearance> {
        let touching = self.pairs_of(Some(ClearanceKind::Cables)).filter_map(|pair| {
            // Pairs that are surely farther apart need no exact distance.
            self.clearance(pair, TOUCHING - self.of.required(pair)).filter(Clearance::touches)
        });
        touching.collect()
    }

    /// Pair with the least margin, of one kind or of all.
    fn least(&self, kind: Option<ClearanceKind>) -> Option<Clearance> {
        self.least_of(self.pairs_of(kind))
    }

    /// Pair with the least margin of some pairs.
    fn least_of(&self, pairs: impl Iterator<Item = ClearancePair>) -> Option<Clearance> {
        let mut least: Option<Clearance> = None;
        for pair in pairs {
            // Pairs that are surely farther apart need no exact distance.
            let enough = least.map_or(f64::INFINITY, |least| least.margin());
            let found = self.clearance(pair, enough);
            if let Some(found) = found.filter(|found| found.margin() < enough) {
                least = Some(found);
            }
        }
        least
    }

    /// Distance of a pair; `None` if there is none, or if its margin is surely above `enough`.
    fn clearance(&self, pair: ClearancePair, enough: f64) -> Option<Clearance> {
        let required = self.of.required(pair);
        let (distance, points_w) = match pair {
            ClearancePair::Cables(i, j) => {
                let (one, other) = (&self.spans[i], &self.spans[j]);
                let radii = one.radius + other.radius;
                let near = cable_pair::nearest(one, other, enough + required + radii)?;
                (near.distance - radii, near.points_w)
            }
            ClearancePair::CableAndPlatform { cable, body } => self.spans[cable].nearest_on(
                &self.platform[body],
                SpanEnd::Platform,
                enough + required,
                self.tolerance,
            )?,
            ClearancePair::CableAndObstacle { cable, obstacle } => self.spans[cable].nearest_on(
                &self.of.obstacles[obstacle],
                SpanEnd::Anchor,
                enough + required,
                self.tolerance,
            )?,
            ClearancePair::PlatformAndObstacle { body, obstacle } => {
                let (own, other) = (&self.platform[body], &self.of.obstacles[obstacle]);
                if own.lower_bound_to(other) > enough + required {
                    return None;
                }
                own.nearest_to(other)
            }
        };
        Some(Clearance { pair, distance, required, points_w })
    }
}
