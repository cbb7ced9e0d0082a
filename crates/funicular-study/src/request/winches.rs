//! Request for the winches that a robot needs.

use super::key::declared;
use super::loads::Requirements;
use super::parts::{Places, RobotText, State, Tensions};
use super::speeds::RequiredVelocities;
use serde::{Deserialize, Serialize};

/// Winch on offer, by what it bears or gives; what it does not say is not compared.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct OfferedWinch {
    /// Name.
    pub name: String,
    /// Tension at the drum [N].
    pub tension_n: Option<f64>,
    /// Speed of the rope at the drum [m/s].
    pub speed_m_s: Option<f64>,
    /// Acceleration of the rope at the drum [m/s²].
    pub acceleration_m_s2: Option<f64>,
    /// Torque of the motor [N m].
    pub torque_n_m: Option<f64>,
    /// Mechanical power of the motor while it drives [W].
    pub power_w: Option<f64>,
    /// Mechanical power that the motor takes while it brakes [W].
    pub brake_power_w: Option<f64>,
    /// Rope that the drum takes [m].
    pub rope_m: Option<f64>,
}

impl OfferedWinch {
    /// Keys of the numbers, in the order of [`Self::numbers`].
    pub(crate) const NUMBERS: [&str; 7] =
        ["tension_n", "speed_m_s", "acceleration_m_s2", "torque_n_m", "power_w", "brake_power_w", "rope_m"];

    /// Numbers that it bears or gives.
    pub(crate) fn numbers(&self) -> [Option<f64>; 7] {
        let Self { name: _, tension_n, speed_m_s, acceleration_m_s2, torque_n_m, power_w, brake_power_w, rope_m } =
            *self;
        [tension_n, speed_m_s, acceleration_m_s2, torque_n_m, power_w, brake_power_w, rope_m]
    }
}

declared! {
    /// Winches that a robot needs, over all poses and for everything that is required there: tension, speed,
    /// acceleration, torque, powers and rope of one winch that serves every cable, and of each.
    ///
    /// Tensions follow their rule under every required load, and the required velocities and accelerations act in every
    /// combination with the loads. Each number comes with the pose, the load and the velocity that ask for it.
    pub struct WinchesRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Poses.
        #[serde(flatten)]
        places: Places = Places::default() => group;
        /// Winches on offer, to be compared with the needs: `name`, and what each bears or gives, `tension_n`,
        /// `speed_m_s`, `acceleration_m_s2`, `torque_n_m`, `power_w`, `brake_power_w`, `rope_m`; what a winch does not
        /// say is not compared
        offers: Option<Vec<OfferedWinch>> = None => (Data(shape::objects))
            .read_by(Reader::Records, "the winches on offer");
        /// Width of the drums between their flanges [m], for the layers of rope.
        drum_width_m: Option<f64> = None => (Number(Positive));
        /// Required loads.
        #[serde(flatten)]
        required: Requirements = Requirements::default() => group;
        /// Required velocities.
        #[serde(flatten)]
        velocities: RequiredVelocities = RequiredVelocities::default() => group;
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
    }
    examples {
        "funicular winches robots/cogiro-winches.toml --grid x=-3:3:5 --grid y=-2:2:5 --grid z=1.5:2.5:3 \
         \\\n    --required-velocity-m-s 1,1,0.5 --required-acceleration-m-s2 2,2,1 --required-payload-max-kg 100",
        "funicular winches robots/cogiro-winches.toml --pose 1,1,1.5 --required-velocity-m-s 1,1,1 --offers \
         winches.csv --drum-width-m 0.3",
    }
}
