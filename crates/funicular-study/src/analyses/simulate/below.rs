//! Ropes and platform behind the surfaces of half spaces during a simulation, such as below a floor. No contact is
//! simulated: what falls goes on falling, and is told.

use crate::rows::rows;
use crate::text::significant;
use funicular::math::Vec3;
use funicular::robot::{Pose, Robot, Solid};

rows! {
    /// Part of the robot behind the surface of a half space.
    pub struct BelowRow {
        /// Name of the half space.
        pub obstacle: String;
        /// Part of the robot in words: a cable, a half of one, or the platform.
        pub part: String;
        /// True if the surface is a floor: it faces up within 60°.
        pub is_floor: bool;
        /// Time of the first row in which it is there.
        pub first_s: f64;
        /// Largest depth of all rows.
        pub deepest_m: f64;
        /// Time of this row.
        pub deepest_s: f64;
    }
}

impl BelowRow {
    /// Sentence on it.
    pub fn in_words(&self) -> String {
        let word = if self.is_floor { "below" } else { "behind" };
        let [first, deepest, time] = [(self.first_s, 4), (self.deepest_m, 3), (self.deepest_s, 4)]
            .map(|(value, digits)| significant(value, digits));
        let (initial, rest) = self.part.split_at(1);
        format!(
            "{}{rest} is {word} the surface of \"{}\" from {first} s on, by up to {deepest} m at {time} s.",
            initial.to_uppercase(),
            self.obstacle
        )
    }
}

/// Warning about everything that falls; `None` if nothing does.
pub(super) fn warning(below: &[BelowRow]) -> Option<String> {
    let told: Vec<String> = below.iter().map(BelowRow::in_words).collect();
    let sentence = || format!("contact is not simulated, so that nothing stops what falls: {}", told.join(" "));
    (!told.is_empty()).then(sentence)
}

/// Depth that counts as below: ropes and platforms that lie on a floor at the start are off it by rounding [m].
const MIN_DEPTH: f64 = 1e-6;

/// Half spaces of a robot, and what was behind them so far.
pub(super) struct BelowGround<'a> {
    robot: &'a Robot,
    /// Cables whose halves at the platform follow the cables in the curves.
    parted: Vec<usize>,
    rows: Vec<BelowRow>,
}

impl<'a> BelowGround<'a> {
    pub(super) fn new(robot: &'a Robot, parted: &[usize]) -> Self {
        Self { robot, parted: parted.to_vec(), rows: Vec::new() }
    }

    /// Looks at the robot at one time. `curves_w` are points of the ropes, first those of the cables.
    pub(super) fn look(&mut self, time: f64, pose: &Pose, curves_w: &[Vec<Vec3>]) {
        let robot = self.robot;
        for obstacle in robot.obstacles.iter().filter(|body| body.solid == Solid::HalfSpace) {
            let outward_w = obstacle.pose.rot_wp * Vec3::z();
            let depth = |point_w: &Vec3| outward_w.dot(&(obstacle.pose.position_w - point_w));
            let deepest = |points_w: &[Vec3]| points_w.iter().map(depth).fold(f64::NEG_INFINITY, f64::max);
            let up_w = robot.gravity_w.try_normalize(0.0).map_or(Vec3::z(), |down_w| -down_w);
            let is_floor = outward_w.dot(&up_w) > 0.5;

            for (k, points_w) in curves_w.iter().enumerate() {
                let part = match k.checked_sub(robot.cables.len()) {
                    None => format!("cable \"{}\"", robot.cables[k].name),
                    Some(half) => {
                        format!("the half of cable \"{}\" at the platform", robot.cables[self.parted[half]].name)
                    }
                };
                self.note(time, (&obstacle.name, is_floor), part, deepest(points_w));
            }
            self.note(time, (&obstacle.name, is_floor), "the platform".to_owned(), deepest(&corners(robot, pose)));
        }
    }

    fn note(&mut self, time: f64, (obstacle, is_floor): (&str, bool), part: String, depth: f64) {
        if depth <= MIN_DEPTH {
            return;
        }
        let known = self.rows.iter_mut().find(|row| row.obstacle == obstacle && row.part == part);
        match known {
            Some(row) if depth > row.deepest_m => (row.deepest_m, row.deepest_s) = (depth, time),
            Some(_) => {}
            None => self.rows.push(BelowRow {
                obstacle: obstacle.to_owned(),
                part,
                is_floor,
                first_s: time,
                deepest_m: depth,
                deepest_s: time,
            }),
        }
    }

    pub(super) fn rows(self) -> Vec<BelowRow> {
        self.rows
    }
}

/// Corners of the platform: of its bodies, or else its attachments [m].
fn corners(robot: &Robot, pose: &Pose) -> Vec<Vec3> {
    let bodies = &robot.platform.bodies;
    if bodies.is_empty() {
        return robot.cables.iter().map(|cable| pose.point_w(&cable.attachment_p)).collect();
    }
    bodies
        .iter()
        .flat_map(|body| body.triangles().into_iter().flatten())
        .map(|point_p| pose.point_w(&point_p))
        .collect()
}
