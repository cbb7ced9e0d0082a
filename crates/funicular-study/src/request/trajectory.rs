//! Request of a robot that moves along a path.

use super::key::declared;
use super::parts::{NumberColumns, Pose, RobotText, State, Tensions};
use funicular::path::CourseForm;

declared! {
    /// Motion along a path: unstrained lengths with their rates, tensions with the inertia, torques and powers of the
    /// winches, and what limits the motion.
    ///
    /// The path is a table (⟪path⟫), a move (⟪move_to⟫) that may go through other poses (⟪via⟫) or lift and lower
    /// (⟪lift_m⟫), or a circle (⟪circle_center_m⟫). The cables are quasi-static; the inertia of the platform counts.
    pub struct TrajectoryRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Path: columns t_s [s], x_m, y_m, z_m [m] and, where the platform turns, roll_deg, pitch_deg, yaw_deg; a
        /// spline of the fifth degree passes the rows. Or a job: G-code (.nc, .gcode, .ngc, .tap), or rows with
        /// feed_m_s [m/s] instead of times, each a move at this speed; 0 is a rapid move, as fast as the limits of the
        /// course.
        path: Option<NumberColumns> = None => (Columns).under("Path").excludes(&["lengths_m"])
            .read_by(Reader::Columns, "the path");
        /// Place of the zero of a job, world axes [m].
        path_origin_m: Option<[f64; 3]> = None => (Vector).under("Path").needs("path")
            .otherwise("the zero of the world");
        /// Smooth the rows of ⟪path⟫ by less than this distance [m]: half a unit of their last digit takes their
        /// rounding out. Angles change by less than what moves the attachments as far.
        row_tolerance_m: Option<f64> = None => (Number(Positive)).under("Path")
            .otherwise("the path passes its rows");
        /// Pose x,y,z[,roll,pitch,yaw] [m, degrees] to which the platform moves from the pose of the state, from rest
        /// to rest.
        move_to: Option<Pose> = None => (Pose).under("Path");
        /// Poses on the way to ⟪move_to⟫: position [m] and roll, pitch, yaw [degrees].
        via: Option<Vec<[f64; 6]>> = None => (Poses).under("Path").needs("move_to")
            .read_by(Reader::Poses, "the poses");
        /// Pick and place: lift the platform by this height [m], carry it to ⟪move_to⟫, and lower it there.
        lift_m: Option<f64> = None => (Number(Positive)).under("Path").needs("move_to");
        /// Part of the time of slowing down by which the next move begins earlier, so that the path rounds the corner:
        /// 0 stops at every pose of the way, 1 rounds most.
        blend: f64 = 0.0 => (Number(NotNegative)).under("Path");
        /// Centre of a circle on which the platform moves from the pose of the state, from rest to rest [m].
        circle_center_m: Option<[f64; 3]> = None => (Vector).under("Path").excludes(&["move_to"]);
        /// Direction of the axis of the circle; positive turns go round it by the right-hand rule.
        circle_axis: [f64; 3] = [0.0, 0.0, 1.0] => (Vector).under("Path");
        /// Number of turns on the circle; negative turns go the other way.
        turns: f64 = 1.0 => (Number(Finite)).under("Path");
        /// Course over time.
        #[serde(flatten)]
        motion: MotionOptions = MotionOptions::default() => group;
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
    }
    examples {
        "funicular trajectory robots/cogiro.toml --pose 0,0,1.5 --move-to 4,2,1.5 --speed-m-s 2 --acceleration-m-s2 2 \
         --jerk-m-s3 20",
        "funicular trajectory robots/cogiro.toml --pose -3,0,1 --move-to 3,1,1 --lift-m 1 --blend 1 --speed-m-s 2 \
         \\\n    --acceleration-m-s2 2 --jerk-m-s3 20 -o motion.csv --lengths lengths.csv",
        "funicular trajectory robots/cogiro.toml --pose 2,0,1.5 --circle-center-m 0,0,1.5 --speed-m-s 3 \\\n    \
         --acceleration-m-s2 3 --jerk-m-s3 30 --max-tension-n 1500 --fastest",
        "funicular trajectory robots/cogiro.toml --path path.csv --sample-time-s 0.01 -o motion.html",
    }
}

declared! {
    /// Course of a motion over time.
    #[derive(Copy)]
    pub struct MotionOptions {
        /// Form of the course of every move.
        #[serde(with = "crate::names")]
        course: CourseForm = CourseForm::default() => (name::<CourseForm>()).form("COURSE").under("Course");
        /// Largest speed of the platform origin [m/s].
        speed_m_s: Option<f64> = None => (Number(Positive)).under("Course").otherwise("none");
        /// Largest acceleration of the origin [m/s²].
        acceleration_m_s2: Option<f64> = None => (Number(Positive)).under("Course").otherwise("none");
        /// Largest rate of the acceleration [m/s³].
        jerk_m_s3: Option<f64> = None => (Number(Positive)).under("Course")
            .otherwise("none: the acceleration and with it the tensions jump");
        /// Largest angular velocity of the platform [rad/s].
        angular_speed_rad_s: Option<f64> = None => (Number(Positive)).under("Course").otherwise("none");
        /// Largest angular acceleration [rad/s²].
        angular_acceleration_rad_s2: Option<f64> = None => (Number(Positive)).under("Course").otherwise("none");
        /// Largest rate of the angular acceleration [rad/s³].
        angular_jerk_rad_s3: Option<f64> = None => (Number(Positive)).under("Course").otherwise("none");
        /// Duration of the whole path [s]: all its times are multiplied by one factor. With the course `quintic` or
        /// `septic` it needs no limits: moves in a row then get times by their length, 1 rad like 1 m.
        duration_s: Option<f64> = None => (Number(Positive)).under("Course")
            .otherwise("that of the limits or of the table");
        /// Find the shortest duration that keeps all limits of tensions and winches, by one factor of all times.
        fastest: bool = false => (Switch).under("Course").excludes(&["duration_s"]);
        /// Add the inertia of the ropes across them, as of taut strings, to that of the platform.
        rope_inertia: bool = false => (Switch).under("Course");
        /// Time between the rows of the result [s]; the last step may be shorter. Largest values do not depend on it.
        sample_time_s: Option<f64> = None => (Number(Positive)).under("Course")
            .otherwise("the rows of the table, or a two-hundredth of the duration");
        /// Time between the lengths that a controller gets [s]; between them it changes the lengths in straight lines.
        station_time_s: Option<f64> = None => (Number(Positive)).under("Course").otherwise("that between the rows");
        /// Error of a length between two of them for which their number is listed [m].
        length_tolerance_m: f64 = LENGTH_TOLERANCE => (Number(Positive)).under("Course");
    }
}

/// Default of the error of a length between two stations of a controller [m].
const LENGTH_TOLERANCE: f64 = 1e-4;
