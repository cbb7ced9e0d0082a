//! Static state that an analysis starts from, given by the request or else by the robot file.

use crate::error::with_warnings;
use crate::names::TensionRuleName;
use crate::request::{self, Load, Model, ResponsePoints, RobotText, Tensions, Terms};
use crate::signals::{Input, Output};
use anyhow::{Result, bail};
use funicular::cable::CableModel;
use funicular::cable_motion::CableMotionError;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::response::{Port, Signal};
use funicular::robot::{self, PlatformMotion, Pose, Robot, State, TensionLimits, Wind};
use funicular::statics::{self, Equilibrium, Solution, StaticModel, StaticsError, TensionRule};
use funicular::warnings;

/// Robot at an equilibrium.
#[derive(Debug, Clone)]
pub struct AtRest {
    /// Robot with all changes of the request.
    pub robot: Robot,
    /// Equilibrium of the robot.
    pub equilibrium: Equilibrium,
    /// Requested pose and its distance from the equilibrium's pose [m]. Present if the cables cannot hold the requested
    /// pose; the equilibrium then has the nearest pose that they can hold.
    pub requested_pose: Option<(Pose, f64)>,
    /// Rule that chose the tensions, if there was a choice.
    pub rule: Option<TensionRule>,
    /// Pose whose unstrained lengths are held, before the changes of the request; absent if no lengths are held.
    pub held_pose: Option<Pose>,
}

impl AtRest {
    /// This equilibrium with rigid supports where they are; `None` on a rigid frame.
    pub(crate) fn with_rigid_supports(&self) -> Option<Self> {
        self.robot.has_supports().then(|| Self {
            robot: self.equilibrium.settled(&self.robot).into_owned(),
            equilibrium: self.equilibrium.clone(),
            requested_pose: self.requested_pose,
            rule: self.rule.clone(),
            held_pose: self.held_pose,
        })
    }
}

/// Solves the static problem of a request. `source` is the text from which the robot was read.
///
/// # Errors
/// A request that contradicts itself or the robot, or a robot without such an equilibrium.
pub fn equilibrium(robot: Robot, source: &RobotText, state: &request::State, tensions: &Tensions) -> Result<AtRest> {
    let robot = with_limits(&with_state(robot, state)?, tensions)?;
    let rule = rule(tensions)?;
    let solution = if state.hold_lengths_of_pose {
        let holder = holder(source, state, tensions)?;
        refuse_no_pose(&holder)?;
        statics::solve_held(&holder, &robot, state.static_model, rule)
    } else {
        refuse_no_state(&robot)?;
        statics::solve(&robot, state.static_model, rule)
    };
    let solution = solution.map_err(|error| with_warnings(error, &robot))?;
    let Solution { equilibrium, requested_pose, rule, held_pose } = solution;
    Ok(AtRest { robot, equilibrium, requested_pose, rule, held_pose })
}

/// Robot whose unstrained lengths at a pose are held: the robot of the file without any change of the request, except
/// for its state and its tension limits.
///
/// # Errors
/// A file that is no robot without its changes, or a request that contradicts itself or the robot.
pub fn holder(source: &RobotText, state: &request::State, tensions: &Tensions) -> Result<Robot> {
    holder_of(holder_text(source).read()?.robot, state, tensions)
}

/// Text of the [`holder`]: only changes of `[state]` are made.
pub(crate) fn holder_text(source: &RobotText) -> RobotText {
    let set = source.set.iter().filter(|change| change.is_of_state()).cloned().collect();
    RobotText { set, ..source.clone() }
}

/// Holder from the robot of its text, with the pose and the tension limits of a request.
///
/// # Errors
/// A pose that the platform cannot have, or limits that exclude each other.
pub(crate) fn holder_of(robot: Robot, state: &request::State, tensions: &Tensions) -> Result<Robot> {
    let pose_alone = request::State { pose: state.pose, ..request::State::default() };
    with_limits(&with_state(robot, &pose_alone)?, tensions)
}

/// Refuses to hold the lengths of a pose if the robot has none.
///
/// # Errors
/// A message that says which value to give.
pub fn refuse_no_pose(robot: &Robot) -> Result<()> {
    match robot.state {
        State::Pose(_) => Ok(()),
        State::Lengths(_) | State::Unknown => {
            bail!("⟪hold_lengths_of_pose⟫ needs a pose: give ⟪pose⟫, or the robot file a [state] with `position_m`")
        }
    }
}

/// Refuses a robot with neither known lengths nor a known pose.
///
/// # Errors
/// [`StaticsError::NoState`].
pub fn refuse_no_state(robot: &Robot) -> Result<(), StaticsError> {
    if robot.state == State::Unknown { Err(StaticsError::NoState) } else { Ok(()) }
}

/// Robot with the tension limits of a request.
///
/// # Errors
/// A maximum above the breaking load of a rope, or a minimum that is not below the maximum of a cable.
pub fn with_limits(robot: &Robot, tensions: &Tensions) -> Result<Robot> {
    tensions.check()?;
    refuse_above_breaking_load(robot, tensions)?;
    let limits = TensionLimits { minimum: tensions.min_tension_n, maximum: tensions.max_tension_n };
    let robot = robot.with_tension_limits(limits);
    for cable in &robot.cables {
        if let TensionLimits { minimum: Some(minimum), maximum: Some(maximum) } = cable.limits()
            && minimum >= maximum
        {
            bail!(
                "cable \"{}\": minimum tension {minimum} N is not below its maximum {maximum} N: give ⟪min_tension_n⟫ \
                 below ⟪max_tension_n⟫ (a limit that is not given comes from the robot file)",
                cable.name
            );
        }
    }
    Ok(robot)
}

/// Refuses a maximum above the breaking load of a rope, as the reader of robot files does. The message names a cable
/// with the lowest breaking load, so that the remedy holds for every cable.
///
/// # Errors
/// A maximum above the breaking load of a rope.
fn refuse_above_breaking_load(robot: &Robot, tensions: &Tensions) -> Result<()> {
    let Some(maximum) = tensions.max_tension_n else { return Ok(()) };
    let breaking = robot.cables.iter().filter_map(|cable| cable.material.breaking_load.map(|load| (cable, load)));
    let weakest = breaking.min_by(|(_, one), (_, other)| one.total_cmp(other));
    if let Some((cable, load)) = weakest.filter(|(_, load)| maximum > *load) {
        bail!(
            "cable \"{}\": maximum tension {maximum} N is above the breaking load {load} N of its rope \"{}\": give \
             ⟪max_tension_n⟫ of at most {load}, usually a fifth to a third of it, or change `breaking_load_n` in the robot \
             file",
            cable.name,
            cable.material.name
        );
    }
    Ok(())
}

/// Tension rule of a request. Target tensions without a rule stand for the rule `closest`.
///
/// # Errors
/// The rule `closest` without target tensions, or target tensions with another rule.
pub fn rule(tensions: &Tensions) -> Result<Option<TensionRule>> {
    Ok(match (tensions.tension_rule, tensions.target_tension_n.clone()) {
        (None | Some(TensionRuleName::Closest), Some(wanted)) => Some(TensionRule::Closest(wanted)),
        (Some(TensionRuleName::Closest), None) => bail!("⟪tension_rule⟫ closest needs ⟪target_tension_n⟫"),
        (Some(_), Some(_)) => {
            bail!("⟪target_tension_n⟫ is used by ⟪tension_rule⟫ closest only: leave out one of the two options")
        }
        (Some(TensionRuleName::Lowest), None) => Some(TensionRule::Lowest),
        (Some(TensionRuleName::Middle), None) => Some(TensionRule::Middle),
        (Some(TensionRuleName::Stiffest), None) => Some(TensionRule::Stiffest),
        (None, None) => None,
    })
}

/// Robot with the state, the mass and the loads of a request.
///
/// # Errors
/// A number out of its range, or a pose or load that the platform cannot have.
pub fn with_state(mut robot: Robot, state: &request::State) -> Result<Robot> {
    state.check()?;
    if state.lengths_m.is_some() && state.pose.is_some() {
        bail!("give ⟪pose⟫ or ⟪lengths_m⟫, not both: each follows from the other");
    }
    if state.lengths_m.is_some() && state.hold_lengths_of_pose {
        bail!("give ⟪lengths_m⟫ or ⟪hold_lengths_of_pose⟫, not both: both give the lengths");
    }
    if let Some(lengths) = &state.lengths_m {
        robot.state = State::Lengths(lengths.clone());
    }
    if let Some(requested) = state.pose {
        let pose = requested.to_robot()?;
        check_pose(&robot, &pose)?;
        robot.state = State::Pose(pose);
        robot.written_angles_deg = requested.written_angles_deg();
    }
    if let Some(mass) = state.mass_kg {
        robot.platform.mass = mass;
    }
    with_load(robot, &state.load)
}

/// Refuses a pose that the platform cannot have for any cables.
///
/// # Errors
/// An orientation of a point mass, or a pose out of the plane of a planar platform.
pub fn check_pose(robot: &Robot, pose: &Pose) -> Result<()> {
    if robot.platform.motion == PlatformMotion::PointMass && pose.rot_wp.angle() != 0.0 {
        bail!("a point mass has no orientation: give ⟪pose⟫ as x,y,z");
    }
    Ok(robot.platform.motion.check(pose)?)
}

/// Centre of mass of a payload that a request gives, platform frame [m].
///
/// # Errors
/// A number that is not finite, or a centre beside a point mass.
pub(crate) fn payload_center(robot: &Robot, center_m: Option<[f64; 3]>) -> Result<Option<Vec3>> {
    request::check_vector("payload_center_m", center_m)?;
    let center_p = center_m.map(Vec3::from);
    if robot.platform.motion == PlatformMotion::PointMass && center_p.is_some_and(|center| center.norm() > 0.0) {
        bail!("a point mass has no payload beside its origin: leave out ⟪payload_center_m⟫");
    }
    Ok(center_p)
}

/// Robot with the loads of a request. Loads that the request does not give come from the robot file.
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
        if speed > Wind::MAX_SPEED {
            bail!(
                "⟪wind_m_s⟫ is a wind of {speed} m/s, it must be at most {} m/s: air is compressible at higher speeds",
                Wind::MAX_SPEED
            );
        }
        robot.wind.velocity_w = velocity_w;
    }
    if let Some(load) = cable_load_n_per_m {
        robot = robot.with_cable_load(load.into());
    }
    if load_point_m.is_some() && robot.load.force_w.norm() == 0.0 {
        bail!("⟪load_point_m⟫ is the point of a force, but there is no force: give ⟪force_n⟫");
    }
    robot.load.check(&robot.platform.motion)?;
    Ok(robot)
}

/// Cable model of a request. The default is the dynamic model with the same shape as the static model.
pub fn cable_model(requested: Option<CableModel>, static_model: StaticModel) -> CableModel {
    match (requested, static_model) {
        (Some(model), _) => model,
        (None, StaticModel::Catenary) => CableModel::CatenaryDynamic,
        (None, StaticModel::Ideal | StaticModel::Spring) => CableModel::ShallowDynamic,
    }
}

/// Linearisation of a request.
pub fn linearisation(model: &Model, static_model: StaticModel) -> Linearisation {
    let Terms { assembly, in_plane_only, winches } = model.terms;
    Linearisation { cable_model: cable_model(model.cable_model, static_model), assembly, in_plane_only, winches }
}

/// Input and output of a response, checked for this robot.
///
/// # Errors
/// A signal that does not exist on the robot, or a point that is not finite.
pub fn signals(robot: &Robot, input: &Input, output: &Output, points: &ResponsePoints) -> Result<[Signal; 2]> {
    points.check()?;
    input.on_platform_or_cable()?;
    output.on_platform_or_cable()?;
    let [from, to] = [points.input_point_m, points.output_point_m].map(|point| point.map(Vec3::from));
    Ok([input.signal(robot, from)?, output.signal(robot, to)?])
}

impl AtRest {
    /// Ports of the linearised robot for the input and the output of a response.
    ///
    /// # Errors
    /// [`CableMotionError`]: a cable model without motion along the cables.
    pub fn ports(&self, dynamics: &Dynamics, signals: [Signal; 2]) -> Result<[Port; 2], CableMotionError> {
        let all = Port::all(&self.robot, &self.equilibrium, dynamics, &signals, true)?;
        Ok(all.try_into().expect("there are as many ports as signals"))
    }

    /// Robot linearised about its equilibrium, with warnings for frequencies up to a limit [Hz].
    ///
    /// # Errors
    /// A cable model that has no stiffness at this equilibrium.
    pub fn dynamics(&self, linearisation: Linearisation, up_to_hz: f64) -> Result<(Dynamics, Vec<String>)> {
        let dynamics = Dynamics::about(&self.robot, &self.equilibrium, linearisation, up_to_hz)?;
        Ok((dynamics, self.warnings(Some((linearisation.cable_model, up_to_hz)))))
    }

    /// Robot linearised about its equilibrium as by [`dynamics`](Self::dynamics), for gradients of its vibrations.
    ///
    /// # Errors
    /// A cable model that has no stiffness at this equilibrium.
    pub fn dynamics_for_gradients(
        &self,
        linearisation: Linearisation,
        up_to_hz: f64,
    ) -> Result<(Dynamics, Vec<String>)> {
        let dynamics = Dynamics::for_gradients(&self.robot, &self.equilibrium, linearisation, up_to_hz)?;
        Ok((dynamics, self.warnings(Some((linearisation.cable_model, up_to_hz)))))
    }

    /// Warnings about implausible values, about the statics and, if given, about a cable model up to a frequency [Hz].
    pub fn warnings(&self, dynamics: Option<(CableModel, f64)>) -> Vec<String> {
        let mut warnings = warnings::of_statics(&self.robot, &self.equilibrium);
        if let Some((model, up_to_hz)) = dynamics {
            warnings.extend(warnings::of_dynamics(&self.robot, &self.equilibrium, model, up_to_hz));
        }
        let elsewhere = self
            .requested_pose
            .and_then(|(asked, distance)| warnings::of_pose(&self.robot, &self.equilibrium, &asked, distance));
        self.implausible().chain(elsewhere.iter().chain(&warnings).map(ToString::to_string)).collect()
    }

    /// Warnings about values of the robot and of its equilibrium that no usual robot has.
    pub fn implausible(&self) -> impl Iterator<Item = String> + use<> {
        let of_robot = warnings::of_robot(&self.robot).into_iter();
        let all = of_robot.chain(warnings::of_plausibility(&self.robot, &self.equilibrium));
        all.map(|warning| warning.to_string())
    }
}
