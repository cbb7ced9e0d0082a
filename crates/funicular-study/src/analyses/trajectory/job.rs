//! Jobs: paths of moves and arcs, each with its own feed rate, in place of times.

use super::super::timed_rows::{FEED, POSE};
use super::KEY;
use crate::at_rest::check_pose;
use crate::request::{self, NumberColumns, TrajectoryRequest};
use crate::table_fault::TableFault;
use crate::values::{finite, not_negative};
use anyhow::Result;
use funicular::math::Vec3;
use funicular::path::{Leg, LegWay};
use funicular::robot::{PlatformMotion, Pose, Robot};

/// Ends of moves in the frame of the job, whose plane x, y is that of a planar platform.
const OWN_FRAME: [&str; 3] = ["job_x_m", "job_y_m", "job_z_m"];

/// Centre of an arc in the frame of the ends, and its angle about each axis.
const CENTER: [&str; 3] = ["center_x_m", "center_y_m", "center_z_m"];
const TURN: [&str; 3] = ["turn_x_deg", "turn_y_deg", "turn_z_deg"];

/// Maximum number of rows of a job: the statics is computed at some fifty times of each move.
const MAX_ROWS: usize = 20_001;

/// True for the table of a job.
pub(super) fn is_job(columns: &NumberColumns) -> bool {
    columns.contains_key(FEED)
}

/// Place of a job in the world.
#[derive(Debug, Default)]
pub(super) struct JobPlace {
    /// Zero of the job, world axes [m].
    origin: [f64; 3],
    /// Pose from which the platform starts; absent for that of the first row.
    start: Option<Pose>,
}

impl JobPlace {
    pub(super) fn of(request: &TrajectoryRequest) -> Result<Self> {
        let start = request.state.pose.map(request::Pose::to_robot).transpose()?;
        Ok(Self { origin: request.path_origin_m.unwrap_or_default(), start })
    }
}

/// Moves of a job in the world.
#[derive(Debug)]
pub(super) struct Job {
    /// Position [m] and angles [degrees] of the first row.
    pub(super) first_row: [f64; 6],
    /// Pose from which the platform starts: that of the first row, or another.
    pub(super) start: Pose,
    pub(super) legs: Vec<Leg>,
}

impl Job {
    /// Reads the table of a job.
    ///
    /// # Errors
    /// The first fault: a column that is missing or unknown, too many rows or fewer than two, a feed rate that is
    /// negative, or a pose or an arc that the platform cannot have.
    pub(super) fn read(columns: &NumberColumns, robot: &Robot, place: &JobPlace) -> Result<Self, TableFault> {
        let fault = |text: String| TableFault::of_table(KEY, text);
        let frame = Frame::of(columns, robot, place);
        let ends = if frame.is_own { OWN_FRAME.to_vec() } else { POSE.to_vec() };
        let known: Vec<String> =
            ends.iter().chain(&[FEED]).chain(&CENTER).chain(&TURN).map(|name| (*name).to_owned()).collect();
        let wanted = "a job has x_m, y_m, z_m, angles where the platform turns, and feed_m_s; of arcs center_x_m, \
                      center_y_m, center_z_m and one of turn_x_deg, turn_y_deg, turn_z_deg";
        TableFault::refuse_unknown(KEY, columns, &known, wanted)?;
        TableFault::refuse_uneven(KEY, columns)?;
        if let Some(missing) = ends[..3].iter().find(|name| !columns.contains_key(**name)) {
            return Err(fault(format!("there is no column `{missing}`: {wanted}")));
        }
        let count = columns[FEED].len();
        if !(2..=MAX_ROWS).contains(&count) {
            return Err(fault(format!("there are {count} rows: give at least two and at most {MAX_ROWS}")));
        }

        let rows = Rows { columns, frame: &frame, robot };
        let first_row = rows.pose(0)?;
        let start = place.start.unwrap_or_else(|| pose_of(&first_row));
        let mut from = start;
        check_pose(robot, &from).map_err(|error| Rows::fault(0, error.to_string()))?;
        let mut legs = Vec::new();
        for row in 1..count {
            let leg = rows.leg(row, &start)?;
            let is_move = leg.way != LegWay::Straight || leg.to != from;
            if is_move {
                legs.push(leg);
                from = leg.to;
            }
        }
        if legs.is_empty() {
            return Err(fault("no row of the job moves the platform".to_owned()));
        }
        Ok(Self { first_row, start, legs })
    }
}

fn pose_of([x, y, z, roll, pitch, yaw]: &[f64; 6]) -> Pose {
    Pose::new([*x, *y, *z], [*roll, *pitch, *yaw])
}

/// Frame of the ends of moves.
struct Frame {
    /// True for a job with a frame of its own.
    is_own: bool,
    origin: Vec3,
    /// Directions of its axes, world axes; zero for one that a planar platform does not have.
    axes: [Vec3; 3],
}

impl Frame {
    /// Frame of a job. In a plane, x and y of a job are the plane's horizontal and upward or second axis, and z, which
    /// lifts a tool, is none of the platform.
    fn of(columns: &NumberColumns, robot: &Robot, place: &JobPlace) -> Self {
        let is_own = OWN_FRAME.iter().any(|name| columns.contains_key(*name));
        let unit = |axis: usize| Vec3::ith(axis, 1.0);
        let mut frame = Self { is_own, origin: place.origin.into(), axes: [unit(0), unit(1), unit(2)] };
        if let (true, PlatformMotion::Planar(plane)) = (is_own, &robot.platform.motion) {
            let normal = plane.normal_w();
            // The plane's axes are those of the world next to them; the zero of the job is in the plane.
            let across = normal.iamax();
            let [first, second] = [[1, 2], [0, 2], [0, 1]][across];
            let inside = |axis: usize| (unit(axis) - normal * normal[axis]).normalize();
            let up = inside(second);
            let along = inside(first);
            let along = (along - up * along.dot(&up)).normalize();
            frame.axes = [along, up, Vec3::zeros()];
            frame.origin -= normal * plane.distance(&frame.origin);
        }
        frame
    }

    fn direction(&self, of: [f64; 3]) -> Vec3 {
        (0..3).map(|k| self.axes[k] * of[k]).sum()
    }

    fn point(&self, of: [f64; 3]) -> Vec3 {
        self.origin + self.direction(of)
    }
}

/// Rows of the table of a job.
struct Rows<'a> {
    columns: &'a NumberColumns,
    frame: &'a Frame,
    robot: &'a Robot,
}

impl Rows<'_> {
    fn fault(row: usize, text: String) -> TableFault {
        TableFault { key: KEY, row: Some(row), text }
    }

    fn three(&self, row: usize, names: [&str; 3]) -> Result<[f64; 3], TableFault> {
        let value = |name: &str| self.columns.get(name).map_or(0.0, |values| values[row]);
        for name in names {
            finite(value(name)).map_err(|reason| Self::fault(row, format!("`{name}`: {reason}")))?;
        }
        Ok(names.map(value))
    }

    /// Position [m] and angles [degrees] of a row; those of the start in a job with a frame of its own.
    fn pose(&self, row: usize) -> Result<[f64; 6], TableFault> {
        let [x, y, z, roll, pitch, yaw] = POSE;
        let (names, angles) =
            if self.frame.is_own { (OWN_FRAME, [0.0; 3]) } else { ([x, y, z], self.three(row, [roll, pitch, yaw])?) };
        let position: [f64; 3] = self.frame.point(self.three(row, names)?).into();
        Ok(std::array::from_fn(|k| if k < 3 { position[k] } else { angles[k - 3] }))
    }

    /// Move to a row.
    fn leg(&self, row: usize, start: &Pose) -> Result<Leg, TableFault> {
        let mut to = pose_of(&self.pose(row)?);
        if self.frame.is_own {
            to.rot_wp = start.rot_wp;
        }
        check_pose(self.robot, &to).map_err(|error| Self::fault(row, error.to_string()))?;
        let feed = self.columns[FEED][row];
        not_negative(feed).map_err(|reason| Self::fault(row, format!("`{FEED}`: {reason}")))?;

        let turns = self.three(row, TURN)?;
        let way = match (0..3).filter(|k| turns[*k] != 0.0).collect::<Vec<_>>()[..] {
            [] => LegWay::Straight,
            [axis] => {
                let [u, v] = [(axis + 1) % 3, (axis + 2) % 3].map(|k| self.frame.axes[k]);
                let axis_w = u.cross(&v);
                if axis_w.norm() == 0.0 {
                    return Err(Self::fault(row, "the arc leaves the plane in which the platform moves".to_owned()));
                }
                let center_w = self.frame.point(self.three(row, CENTER)?);
                LegWay::Arc { center_w, axis_w, angle: turns[axis].to_radians() }
            }
            _ => return Err(Self::fault(row, "an arc turns about one axis: leave the other angles zero".to_owned())),
        };
        Ok(Leg { to, way, speed: if feed > 0.0 { feed } else { f64::INFINITY } })
    }
}
