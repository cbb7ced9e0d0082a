//! Requests about the robot file and the robot at rest.

use super::key::declared;
use super::parts::{Model, Pose, RobotText, State, Tensions};

declared! {
    /// Read and check a robot file, and describe the robot.
    pub struct CheckRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
    }
    examples {
        "funicular check robots/yuan2014-4mm.toml",
        "funicular check robots/cogiro.toml --set platform.mass_kg=300 --format json",
    }
}

declared! {
    /// List every number of a robot file: path, value, unit, range, meaning.
    ///
    /// The paths can be used in `--set` and in `sweep --vary`. One number of a vector is named by its axis or by its
    /// index from 0: `anchor_m.z` is `anchor_m.2`. A number that the file leaves out is listed with its default.
    pub struct ParametersRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
    }
    examples {
        "funicular parameters robots/yuan2014-4mm.toml",
        "funicular parameters robots/cogiro.toml --set cables.1.anchor_m.z=5.5 --format csv",
        "funicular parameters robots/cogiro.toml --set loads.force_n.2=-50",
    }
}

declared! {
    /// Equilibrium: pose, tensions, sag.
    pub struct StaticsRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Search for all equilibria of the unstrained lengths, including unstable ones.
        all: bool = false => (Switch);
        /// Compute the interval in which friction of pulleys leaves pose and tensions.
        ///
        /// The interval is that of every cable having last run towards the platform or towards its drum. With lengths
        /// given, or with ⟪hold_lengths_of_pose⟫, pose and tensions vary. With a pose given, the tensions at the drums
        /// and the lengths vary. Friction is given in [pulleys.NAME] by `friction_coefficient`, `efficiency` or
        /// `bearing_friction_coefficient`.
        friction_interval: bool = false => (Switch);
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
    }
    examples {
        "funicular statics robots/yuan2014-4mm.toml",
        "funicular statics robots/yuan2014-4mm.toml --pose 0,0,0.5 --mass-kg 20",
        "funicular statics robots/yuan2014-4mm.toml --lengths-m 6.9,6.6,6.8,6.7,6.8,6.6",
        "funicular statics robots/cogiro.toml --pose 1,2,1.5 --hold-lengths-of-pose --mass-kg 250",
        "funicular statics robots/cogiro.toml --pose 1,2,1.5 --tension-rule middle --max-tension-n 1200",
        "funicular statics docs/pulleys/winches.toml --friction-interval",
        "funicular statics robots/cogiro.toml -o robot.pdf",
    }
}

declared! {
    /// Distances between the sagging cables, the platform and obstacles: what is nearest, where, and what is too near.
    ///
    /// Obstacles, bodies of the platform and required distances are given in the robot file.
    pub struct ClearanceRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Pose x,y,z[,roll,pitch,yaw] [m, degrees] to which the platform moves, straight and with one turn; the
        /// distances are then the least on the way, and cables that cross each other are shown.
        move_to: Option<Pose> = None => (Pose);
        /// Search a way to the end of the move through one or two other poses if something is too near on the straight
        /// one.
        find_way: bool = false => (Switch).needs("move_to");
        /// Enlarge every required distance by the expected largest motions of both within ten minutes in the gusts of
        /// the robot file.
        in_gusts: bool = false => (Switch);
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
    }
    examples {
        "funicular clearance robots/cogiro.toml --pose 2,1,1.5",
        "funicular clearance robots/cogiro.toml --pose 0,0,1.5 --move-to 5,3,1.5,0,0,30",
        "funicular clearance robots/cogiro.toml --pose 0,0,1.5 --move-to 5,3,1.5,0,0,30 --find-way",
        "funicular clearance robots/cogiro.toml --pose 2,1,1.5,0,0,20 --set clearance.cables_m=0.05 --format csv",
        "funicular map robots/cogiro.toml --grid x=-6:6:25 --grid y=-4:4:17 --grid z=1.5 --quantity clearance -o \
         free.parquet",
    }
}

declared! {
    /// 6×6 stiffness at one frequency, static at 0 Hz.
    pub struct StiffnessRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Frequency of the stiffness [Hz]; at 0 Hz the tangent of the static model, unless ⟪cable_model⟫ is given.
        at_hz: f64 = 0.0 => (Number(NotNegative));
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
        /// Linearisation.
        #[serde(flatten)]
        model: Model = Model::default() => group;
    }
    examples {
        "funicular stiffness robots/yuan2014-4mm.toml",
        "funicular stiffness robots/yuan2014-4mm.toml --at-hz 3.5 --format json",
    }
}

declared! {
    /// Minimum and maximum payload at a pose, with the cables and ends whose tension limits bind.
    ///
    /// The payload is held by any tensions within the limits, not only by those of a tension rule.
    pub struct PayloadRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Centre of mass of the payload, platform frame [m].
        payload_center_m: Option<[f64; 3]> = None => (Vector).otherwise("that of the platform");
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
    }
    examples {
        "funicular payload robots/cogiro.toml --pose 1,2,1.5",
        "funicular payload robots/cogiro.toml --pose 1,2,1.5 --payload-center-m 0,0,-0.5 --max-tension-n 3000",
        "funicular map robots/cogiro.toml --grid x=-6:6:25 --grid y=-4:4:17 --grid z=1.5 --quantity payload-max -o \
         cogiro.parquet",
    }
}

declared! {
    /// Distances between the poses of ideal, spring and catenary cables over platform mass.
    pub struct PoseErrorRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Platform masses [kg]: N masses from A to B in equal steps, as in 10:90:81.
        mass_kg: (f64, f64, usize) = (0.0, 0.0, 0) => (Written(ProgramForm::MassRange)).form("A:B:N").required();
        /// Unstrained lengths [m], one per cable in the order of the file.
        lengths_m: Option<Vec<f64>> = None =>
            (PerCable(Positive)).form("L1,L2,…").excludes(&["pose"]).otherwise("from the robot file");
        /// Pose x,y,z[,roll,pitch,yaw] [m, degrees]: hold the unstrained lengths with which the robot of the file,
        /// without ⟪set⟫, rests there.
        pose: Option<Pose> = None => (Pose).otherwise("the [state] of the robot file");
        /// Rule and limits of the tensions at this pose.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
        /// Maximum distance between spring pose and catenary pose at which springs are good enough [mm]; reports the
        /// masses where they are.
        tolerance_mm: Option<f64> = None => (Number(Positive));
    }
    examples {
        "funicular pose-error robots/yuan2014-4mm.toml --mass-kg 10.55:86.35:100",
        "funicular pose-error robots/yuan2014-8mm.toml --mass-kg 10:90:81 --tolerance-mm 5 --format csv",
        "funicular pose-error robots/cogiro.toml --pose 1,2,1.5 --mass-kg 80:400:33",
    }
}
