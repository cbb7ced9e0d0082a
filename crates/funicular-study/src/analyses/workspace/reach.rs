//! Distances that the platform may go from where it is, along rays: without the whole set, so that a page shows it
//! while the platform moves.

use super::conditions::ConditionRow;
use super::places::{self, PlaneOfMotion};
use super::study::JudgedRobot;
use crate::request::WorkspaceRequest;
use crate::shared_ropes::refuse_ropes_over_sheaves;
use anyhow::Result;
use funicular::level_set::{RaysInBox, Sphere, first_borders};
use funicular::math::Vec3;
use funicular::robot::{Pose, Robot};
use std::f64::consts::TAU;

/// Highest level of rays: 258 in space, 64 in a plane. The next lower one leaves up to 34° between neighbours, too much
/// for the corners of a workspace; with 1026 rays a large robot takes seconds.
const MAX_LEVEL: usize = 3;

/// Number of rays of level 0 in a plane; each further level doubles it.
const IN_PLANE: usize = 8;

/// Number of rays in space up to each level.
const IN_SPACE: [usize; MAX_LEVEL + 1] = [6, 18, 66, 258];

/// Point at which a ray ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReachedPoint {
    /// Position of the platform origin [m].
    pub position_w: Vec3,
    /// Distance from where the ray begins [m].
    pub distance: f64,
    /// True if the conditions end there; otherwise the box of the search.
    pub is_border: bool,
}

/// Rays of a workspace that go out from the pose of the platform, ready to be followed.
pub struct WorkspaceReach {
    judged: JudgedRobot,
    bounds: [Vec3; 2],
    step: f64,
    tolerance: f64,
    directions: Vec<Vec3>,
    plane: Option<PlaneOfMotion>,
}

impl WorkspaceReach {
    /// Checks a request of `workspace` for a robot; its grid is the box of the search.
    ///
    /// # Errors
    /// A request that contradicts itself or the robot.
    pub fn new(robot: Robot, request: &WorkspaceRequest) -> Result<Self> {
        refuse_ropes_over_sheaves("workspace", &robot)?;
        places::check(request, &robot)?;
        let judged = JudgedRobot::new(robot, request)?;
        let (grid, plane) = places::grid(request, &judged.robot)?;
        let step = grid.step();
        let step =
            (0..3).filter(|k| plane.is_none_or(|plane| plane.axis != *k)).map(|k| step[k]).fold(f64::MAX, f64::min);
        let directions = match plane {
            Some(plane) => in_plane(plane.axis, IN_PLANE << MAX_LEVEL),
            None => Sphere::with_directions(IN_SPACE[MAX_LEVEL]).map_or_else(Vec::new, |all| all.directions().to_vec()),
        };
        Ok(Self { judged, bounds: [grid.lower(), grid.upper()], step, tolerance: 0.01 * step, directions, plane })
    }

    /// Conditions that are kept.
    pub fn conditions(&self) -> &[ConditionRow] {
        &self.judged.conditions.rows
    }

    /// Ends of the rays of a level that no lower level has, from a pose at its orientation. Empty if the conditions are
    /// not kept at the pose, `None` if it is beyond the box.
    pub fn from(&self, pose: &Pose, level: usize) -> Option<Vec<ReachedPoint>> {
        let center = self.plane.map_or(pose.position_w, |plane| plane.project(pose.position_w));
        let directions = self.of_level(level);
        let mut evaluate = |positions: &[Vec3]| {
            let at = |position: &Vec3| Pose { position_w: *position, rot_wp: pose.rot_wp };
            Some(positions.iter().map(|position| self.judged.margin(&at(position))).collect())
        };
        let search = RaysInBox { center, bounds: self.bounds, step: self.step, tolerance: self.tolerance };
        let ends = first_borders(directions, &search, &mut evaluate)?;
        let point = |(ray, end): (&Vec3, &funicular::level_set::FirstBorder)| ReachedPoint {
            position_w: center + ray * end.distance,
            distance: end.distance,
            is_border: end.is_border,
        };
        Some(directions.iter().zip(&ends).map(point).collect())
    }

    /// Triangles between the ends of all rays up to a level, in the order of the levels: the hull of the reach. In a
    /// plane they go out from the pose, whose number is that of the rays.
    pub fn triangles(&self, level: usize) -> Vec<[usize; 3]> {
        let level = level.min(MAX_LEVEL);
        if self.plane.is_none() {
            return Sphere::with_directions(IN_SPACE[level]).map_or_else(Vec::new, |all| all.triangles().to_vec());
        }
        let count = IN_PLANE << level;
        let mut ring: Vec<usize> = (0..IN_PLANE).collect();
        while ring.len() < count {
            let before = ring.len();
            ring = ring.into_iter().enumerate().flat_map(|(k, ray)| [ray, before + k]).collect();
        }
        (0..count).map(|k| [count, ring[k], ring[(k + 1) % count]]).collect()
    }

    /// Directions of a level that no lower level has.
    fn of_level(&self, level: usize) -> &[Vec3] {
        let count = |level: usize| if self.plane.is_some() { IN_PLANE << level } else { IN_SPACE[level] };
        let level = level.min(MAX_LEVEL);
        let before = if level == 0 { 0 } else { count(level - 1) };
        &self.directions[before..count(level)]
    }
}

/// Directions at right angles to an axis, those of each level before those between them.
fn in_plane(axis: usize, count: usize) -> Vec<Vec3> {
    let at = |turn: f64| {
        let mut direction = Vec3::zeros();
        (direction[(axis + 1) % 3], direction[(axis + 2) % 3]) = ((TAU * turn).cos(), (TAU * turn).sin());
        direction
    };
    let mut directions: Vec<Vec3> = (0..IN_PLANE).map(|k| at(k as f64 / IN_PLANE as f64)).collect();
    while directions.len() < count {
        let between = directions.len();
        directions.extend((0..between).map(|k| at((k as f64 + 0.5) / between as f64)));
    }
    directions
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analyses::workspace::{SearchedSet, WorkspaceStudy};
    use crate::request::RobotText;

    fn reach(text: &str) -> (WorkspaceReach, WorkspaceStudy) {
        let request =
            WorkspaceRequest { robot: RobotText { text: text.to_owned(), ..Default::default() }, ..Default::default() };
        let robot = || Robot::from_toml(text).unwrap();
        (WorkspaceReach::new(robot(), &request).unwrap(), WorkspaceStudy::new(robot(), &request).unwrap())
    }

    #[test]
    fn rays_end_where_the_conditions_of_the_workspace_end() {
        let (reach, study) = reach(funicular_robots::COGIRO);
        let pose = Pose::new([1.0, 0.5, 1.5], [0.0; 3]);
        let counts: Vec<usize> = (0..=MAX_LEVEL).map(|level| reach.from(&pose, level).unwrap().len()).collect();
        assert_eq!(counts, [6, 12, 48, 192]);
        let ends: Vec<ReachedPoint> = (0..2).flat_map(|level| reach.from(&pose, level).unwrap()).collect();
        let value = |at: Vec3| study.value(SearchedSet::Own, &at);
        for end in ends.iter().filter(|end| end.is_border) {
            let ray = (end.position_w - pose.position_w) / end.distance;
            let at = |more: f64| value(pose.position_w + ray * (end.distance + more));
            assert!(at(-2.0 * reach.tolerance).unwrap() >= 0.0, "{end:?}");
            assert!(at(2.0 * reach.tolerance).is_none_or(|value| value < 0.0), "{end:?}");
        }
        assert!(ends.iter().any(|end| end.is_border) && ends.iter().any(|end| !end.is_border));
        // The triangles of a level name the rays up to it: neighbours, so that they cover the sphere.
        assert_eq!(reach.triangles(1).len(), 2 * ends.len() - 4);
        let apart = |[a, b, _]: &[usize; 3]| reach.directions[*a].angle(&reach.directions[*b]);
        // Corners of an octahedron are 90° apart; the levels bring neighbours to at most 60°, 33.6° and 17.4°.
        assert!(reach.triangles(MAX_LEVEL).iter().all(|corners| apart(corners).to_degrees() < 17.4));

        // Where the platform cannot be there are no rays, and beyond the box nothing is known.
        assert_eq!(reach.from(&Pose::new([7.0, 5.0, 5.2], [0.0; 3]), 0), Some(Vec::new()));
        assert_eq!(reach.from(&Pose::new([50.0, 0.0, 1.0], [0.0; 3]), 0), None);
    }

    #[test]
    fn rays_of_a_planar_platform_stay_in_its_plane() {
        let (reach, _) = reach(funicular_robots::KNTU_PLANAR);
        let plane = reach.plane.unwrap();
        let center = (reach.bounds[0] + reach.bounds[1]) * 0.5;
        let pose = Pose { position_w: plane.project(center), rot_wp: funicular::math::Rotation::identity() };
        let mut directions = Vec::new();
        for level in 0..=MAX_LEVEL {
            for end in reach.from(&pose, level).unwrap() {
                assert!((end.position_w[plane.axis] - plane.at).abs() < 1e-12, "{end:?}");
                directions.push((end.position_w - pose.position_w) / end.distance);
            }
        }
        // The fan goes once around the pose, by equal angles.
        for [center, a, b] in reach.triangles(MAX_LEVEL) {
            let turn = directions[a].cross(&directions[b])[plane.axis].asin();
            assert!(center == 64 && (turn - TAU / 64.0).abs() < 1e-9, "{turn}");
        }

        // All directions differ, and they are evenly spaced.
        assert_eq!(directions.len(), IN_PLANE << MAX_LEVEL);
        let apart = (TAU / 64.0).cos();
        for (i, a) in directions.iter().enumerate() {
            let nearest = directions.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, b)| a.dot(b));
            assert!((nearest.fold(-1.0, f64::max) - apart).abs() < 1e-9);
        }
    }
}
