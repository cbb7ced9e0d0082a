//! Requests of `estimate` and `observability`: sensors with their noise, and what is known beforehand.

use super::key::declared;
use super::parts::{GappedColumns, Places, Pose, RobotText, State, Tensions};
use crate::names::SensorSet;

declared! {
    /// Noise of the sensors, their places on the platform, and what is known before the first reading.
    #[derive(Copy)]
    pub struct SensorModel {
        /// Place of the inertial unit, platform frame [m]; its axes are those of the platform.
        inertial_unit_m: [f64; 3] = [0.0; 3] => (Vector).under("Sensors");
        /// Tracked point, platform frame [m].
        tracked_point_m: [f64; 3] = [0.0; 3] => (Vector).under("Sensors");
        /// Standard deviation of a length between its readings [m].
        length_std_m: f64 = 2e-5 => (Number(Positive)).under("Sensors");
        /// Standard deviation of a tension [N].
        tension_std_n: f64 = 3.0 => (Number(Positive)).under("Sensors");
        /// Standard deviation of the direction of a cable [rad].
        cable_angle_std_rad: f64 = 1e-3 => (Number(Positive)).under("Sensors");
        /// Standard deviation of the gyroscope [rad/s].
        gyroscope_std_rad_s: f64 = 2e-3 => (Number(Positive)).under("Sensors");
        /// Standard deviation of the accelerometer [m/s²].
        accelerometer_std_m_s2: f64 = 0.03 => (Number(Positive)).under("Sensors");
        /// Standard deviation of each coordinate of the tracked point [m].
        tracker_std_m: f64 = 1e-3 => (Number(Positive)).under("Sensors");
        /// Payload beyond the platform of the file that is expected at the start [kg].
        payload_kg: f64 = 0.0 => (Number(NotNegative)).under("Prior knowledge");
        /// Standard deviation of this payload [kg].
        payload_std_kg: f64 = 20.0 => (Number(NotNegative)).under("Prior knowledge");
        /// Standard deviation of the payload's first moment about the platform origin, each component [kg m].
        first_moment_std_kg_m: f64 = 2.0 => (Number(NotNegative)).under("Prior knowledge");
        /// Standard deviation of an external force besides the loads of the file, each component [N].
        force_std_n: f64 = 3.0 => (Number(NotNegative)).under("Prior knowledge");
        /// Standard deviation of such a moment, each component [N m].
        moment_std_n_m: f64 = 0.5 => (Number(NotNegative)).under("Prior knowledge");
        /// Time in which the external force and moment change [s].
        force_time_s: f64 = 1.0 => (Number(Positive)).under("Prior knowledge");
        /// Standard deviation of the constant error of each length [m].
        offset_std_m: f64 = 1e-3 => (Number(NotNegative)).under("Prior knowledge");
        /// Standard deviation of the constant error of each tension [N].
        tension_bias_std_n: f64 = 5.0 => (Number(NotNegative)).under("Prior knowledge");
        /// Coefficient of friction between rope and load cell: the error of a tension wanders by twice this part of it
        /// within a centimetre of travel.
        friction: f64 = 0.0 => (Number(NotNegative)).form("COEFFICIENT").under("Prior knowledge");
    }
}

declared! {
    /// Pose, velocity, payload and tensions over time from the log of a machine, each with its deviation, and alarms.
    ///
    /// A Kalman filter of the platform on elastic catenaries takes the rows one after the other, as a controller would.
    /// The platform rests at the first row that has the lengths of all cables. The result says which numbers the
    /// sensors do not determine, and whether the readings fit their stated noise. docs/estimation.md explains columns,
    /// priors and alarms.
    pub struct EstimateRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Log, one row per time t_s [s], rising: unstrained lengths of all cables by the encoders as length_NAME_m;
        /// where they were measured, tensions at anchors or drums as tension_anchor_NAME_n, directions in which cables
        /// leave their anchors as azimuth_NAME_rad and elevation_NAME_rad, gyroscope_x_rad_s and accelerometer_x_m_s2
        /// (y, z) in platform axes, and tracker_x_m (y, z) in the world. A cell without a reading is empty.
        log: GappedColumns = GappedColumns::new() => (GappedColumns).required()
            .read_by(Reader::GappedColumns, "the log");
        /// Pose near which the platform is at the first row: x,y,z[,roll,pitch,yaw] [m, degrees].
        near_pose: Option<Pose> = None => (Pose).otherwise("an equilibrium that the program finds");
        /// Least time between rows of the result [s]; with 0 every row of the log has one.
        every_s: f64 = 0.0 => (Number(NotNegative));
        /// False alarms of the tests of the load cells that are accepted, per hour.
        false_alarms_per_hour: f64 = 0.1 => (Number(Positive));
        /// Noise of the sensors and prior knowledge.
        #[serde(flatten)]
        sensors: SensorModel = SensorModel::default() => group;
    }
    examples {
        "funicular estimate docs/estimation/robot.toml --log docs/estimation/run.csv \\\n    --payload-std-kg 0.5 \
         --first-moment-std-kg-m 0.05 --inertial-unit-m 0.1,0,0.5 --tracked-point-m 0,0,1",
        "funicular estimate robot.toml --log run.csv --tension-std-n 5 --every-s 0.1 -o states.csv --page run.html",
    }
}

declared! {
    /// Numbers that sensors determine at poses at rest, before any reading: the deviation of each, beside that without
    /// the sensors, and the sensor or the pose that would add most.
    ///
    /// The lengths of all cables are always read. The deviations are those of `estimate` for a platform that stands at
    /// these poses one after the other. docs/estimation.md explains them.
    pub struct ObservabilityRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Sensors besides the encoders of all cables, separated by commas; `none` for the encoders alone.
        sensors: Vec<String> = vec!["tensions".to_owned()] => (Texts).form("SENSORS")
            .one_of(SensorSet::names());
        /// Distance of the further poses that are tried, along each axis to both sides [m].
        further_pose_m: f64 = 0.3 => (Number(Positive));
        /// Poses.
        #[serde(flatten)]
        places: Places = Places::default() => group;
        /// Noise of the sensors and prior knowledge.
        #[serde(flatten)]
        model: SensorModel = SensorModel::default() => group;
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
    }
    examples {
        "funicular observability docs/estimation/robot.toml --sensors tensions,tracker",
        "funicular observability docs/estimation/robot.toml --sensors none --grid x=-1:1:3 --grid y=-1:1:3 \\\n    \
         --tension-std-n 5",
    }
}
