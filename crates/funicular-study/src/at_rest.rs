//! The static state that an analysis starts from: as the robot file says, or as the request says.

use crate::names::TensionRuleName;
use crate::request::{self, Load, Model, Points, Tensions, Terms};
use crate::signals::{Input, Output};
use anyhow::{Result, bail};
use funicular::cable::CableModel;
use funicular::cable_motion::CableMotionError;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::response::{Port, Signal};
use funicular::robot::{self, PlatformMotion, Pose, Robot, State, TensionLimits, Wind};
use funicular::statics::{self, Equilibrium, Solution, StaticModel, TensionRule};
use funicular::warnings;

/// A robot at rest.
#[derive(Debug, Clone)]
pub struct AtRest {
    /// The robot with everything that the request changes.
    pub robot: Robot,
    /// Its equilibrium.
    pub equilibrium: Equilibrium,
    /// The requested pose where the cables cannot hold it and this is the nearest, and how far it is [m].
    pub requested_pose: Option<(Pose, f64)>,
    /// The rule that chose the tensions, where there was a choice.
    pub rule: Option<TensionRule>,
}

/// Solves the static problem that a request poses.
///
/// # Errors
/// A request that contradicts itself or the robot, or a robot without that equilibrium.
pub fn equilibrium(robot: Robot, state: &request::State, tensions: &Tensions) -> Result<AtRest> {
    let robot = with_limits(&with_state(robot, state)?, tensions)?;
    refuse_no_state(&robot)?;
    let Solution { equilibrium, requested_pose, rule } = statics::solve(&robot, state.static_model, rule(tensions)?)?;
    Ok(AtRest { robot, equilibrium, requested_pose, rule })
}

/// Refuses a robot of which neither lengths nor a pose are known.
///
/// # Errors
/// What to give.
pub fn refuse_no_state(robot: &Robot) -> Result<()> {
    if robot.state == State::Unknown {
        bail!(
            "the robot has no state: give ⟪lengths_m⟫ or ⟪pose⟫, or give every cable of the robot file an \
             `unstrained_length_m`, or the file a [state] with `position_m`"
        );
    }
    Ok(())
}

/// The robot with the limits of tension that a request gives.
///
/// # Errors
/// A minimum that is not below the maximum of a cable.
pub fn with_limits(robot: &Robot, tensions: &Tensions) -> Result<Robot> {
    tensions.check()?;
    let limits = TensionLimits { minimum: tensions.min_tension_n, maximum: tensions.max_tension_n };
    let robot = robot.with_tension_limits(limits);
    for cable in &robot.cables {
        if let TensionLimits { minimum: Some(minimum), maximum: Some(maximum) } = cable.limits()
            && minimum >= maximum
        {
            bail!(
                "the least tension of cable \"{}\" is {minimum} N and its greatest {maximum} N: give ⟪min_tension_n⟫ \
                 below ⟪max_tension_n⟫ (what is not given is as the robot file says)",
                cable.name
            );
        }
    }
    Ok(robot)
}

/// The tension rule that a request names; wanted tensions alone name `closest`.
///
/// # Errors
/// A rule without what it needs, or with what it does not.
pub fn rule(tensions: &Tensions) -> Result<Option<TensionRule>> {
    Ok(match (tensions.tension_rule, tensions.target_tension_n.clone()) {
        (None | Some(TensionRuleName::Closest), Some(wanted)) => Some(TensionRule::Closest(wanted)),
        (Some(TensionRuleName::Closest), None) => bail!("⟪tension_rule⟫ closest needs ⟪target_tension_n⟫"),
        (Some(_), Some(_)) => bail!("⟪target_tension_n⟫ goes with ⟪tension_rule⟫ closest only"),
        (Some(TensionRuleName::Lowest), None) => Some(TensionRule::Lowest),
        (Some(TensionRuleName::Middle), None) => Some(TensionRule::Middle),
        (Some(TensionRuleName::Stiffest), None) => Some(TensionRule::Stiffest),
        (None, None) => None,
    })
}

/// The robot with the state, the mass and the loads that a request gives.
///
/// # Errors
/// A number out of its range, a pose or load that the platform cannot have.
pub fn with_state(mut robot: Robot, state: &request::State) -> Result<Robot> {
    state.check()?;
    if state.lengths_m.is_some() && state.pose.is_some() {
        bail!("give ⟪pose⟫ or ⟪lengths_m⟫, not both: each follows from the other");
    }
    if let Some(lengths) = &state.lengths_m {
        robot.state = State::Lengths(lengths.clone());
    }
    if let Some(pose) = &state.pose {
        let pose = pose.to_robot()?;
        check_pose(&robot, &pose)?;
        robot.state = State::Pose(pose);
    }
    if let Some(mass) = state.mass_kg {
        robot.platform.mass = mass;
    }
    with_load(robot, &state.load)
}

/// Refuses a pose that the platform cannot have, whatever its cables do.
///
/// # Errors
/// An orientation of a point mass, or a pose that a plane excludes.
pub fn check_pose(robot: &Robot, pose: &Pose) -> Result<()> {
    if robot.platform.motion == PlatformMotion::PointMass && pose.rot_wp.angle() != 0.0 {
        bail!("a point mass has no orientation: give ⟪pose⟫ as x,y,z");
    }
    Ok(robot.platform.motion.check(pose)?)
}

/// The robot with the loads that a request gives; others stay as the robot file has them.
fn with_load(mut robot: Robot, load: &Load) -> Result<Robot> {
    let Load { force_n, moment_n_m, load_point_m, wind_m_s, cable_load_n_per_m } = *load;
    let or = |given: Option<[f64; 3]>, of_file: Vec3| given.map_or(of_file, Vec3::from);
    robot.load = robot::Load {
        force_w: or(force_n, robot.load.force_w),
        moment_w: or(moment_n_m, robot.load.moment_w),
        point_p: or(load_point_m, robot.load.point_p),
    };
    if let Some(velocity_w) = wind_m_s.map(Vec3::from) {
        let speed = velocity_w.norm();
        if speed > Wind::FASTEST {
            bail!(
                "⟪wind_m_s⟫ is a wind of {speed} m/s, it must be at most {} m/s: faster air is compressed",
                Wind::FASTEST
            );
        }
        robot.wind.velocity_w = velocity_w;
    }
    if let Some(load) = cable_load_n_per_m {
        robot = robot.with_cable_load(load.into());
    }
    if load_point_m.is_some() && robot.load.force_w.norm() == 0.0 {
        bail!("⟪load_point_m⟫ is where a force acts, and there is none: give ⟪force_n⟫");
    }
    robot.load.check(&robot.platform.motion)?;
    Ok(robot)
}

/// The cable model of a request; by default the dynamic one of the same shape as the static model.
pub fn cable_model(requested: Option<CableModel>, static_model: StaticModel) -> CableModel {
    match (requested, static_model) {
        (Some(model), _) => model,
        (None, StaticModel::Catenary) => CableModel::CatenaryDynamic,
        (None, StaticModel::Ideal | StaticModel::Spring) => CableModel::ShallowDynamic,
    }
}

/// The linearisation of a request.
pub fn linearisation(model: &Model, static_model: StaticModel) -> Linearisation {
    let Terms { assembly, in_plane_only } = model.terms;
    Linearisation { cable_model: cable_model(model.cable_model, static_model), assembly, in_plane_only }
}

/// Input and output of a response, checked against what the robot can do.
///
/// # Errors
/// A signal that means nothing on the robot, or a point that is none.
pub fn signals(robot: &Robot, input: &Input, output: &Output, points: &Points) -> Result<[Signal; 2]> {
    points.check()?;
    let [from, to] = [points.input_point_m, points.output_point_m].map(|point| point.map(Vec3::from));
    Ok([input.signal(robot, from)?, output.signal(robot, to)?])
}

impl AtRest {
    /// Input and output of a response on the linearised robot; forces may act on both.
    ///
    /// # Errors
    /// [`CableMotionError`]: a model without motion along its cables.
    pub fn ports(&self, dynamics: &Dynamics, signals: [Signal; 2]) -> Result<[Port; 2], CableMotionError> {
        let all = Port::all(&self.robot, &self.equilibrium, dynamics, &signals, true)?;
        Ok(all.try_into().expect("as many ports as signals"))
    }

    /// The robot linearised about its equilibrium, with warnings for frequencies up to a limit [Hz].
    ///
    /// # Errors
    /// A cable model that has no stiffness at this equilibrium.
    pub fn dynamics(&self, linearisation: Linearisation, up_to_hz: f64) -> Result<(Dynamics, Vec<String>)> {
        let dynamics = Dynamics::about(&self.robot, &self.equilibrium, linearisation, up_to_hz)?;
        Ok((dynamics, self.warnings(Some((linearisation.cable_model, up_to_hz)))))
    }

    /// Warnings about the statics and, if given, about a cable model up to a frequency [Hz].
    pub fn warnings(&self, dynamics: Option<(CableModel, f64)>) -> Vec<String> {
        let mut warnings = warnings::of_statics(&self.robot, &self.equilibrium);
        if let Some((model, up_to_hz)) = dynamics {
            warnings.extend(warnings::of_dynamics(&self.robot, &self.equilibrium, model, up_to_hz));
        }
        let elsewhere = self
            .requested_pose
            .and_then(|(asked, distance)| warnings::of_pose(&self.robot, &self.equilibrium, &asked, distance));
        elsewhere.iter().chain(&warnings).map(ToString::to_string).collect()
    }
}
