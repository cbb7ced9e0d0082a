//! The static state that an analysis starts from: as the robot file says, or as the options say.

use crate::args::{CableModelName, LoadArgs, ModelArgs, PointArgs, StateArgs, TensionArgs, TensionRuleName};
use anyhow::{Result, bail};
use funicular::cable::{CableModel, Sag};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::ports::{Input, OnCable, Output, PlaceError, Places, PortError};
use funicular::response::Direction;
use funicular::robot::{Freedoms, Load, Pose, Robot, State, TensionLimits, Wind};
use funicular::statics::{self, Equilibrium, Rest, StaticModel, TensionRule};
use funicular::validity;
use serde::Serialize;

/// A robot at rest.
pub(crate) struct AtRest {
    pub(crate) robot: Robot,
    pub(crate) equilibrium: Equilibrium,
    /// The pose asked where the cables cannot hold it and this is the nearest, and how far it is [m].
    pub(crate) instead_of: Option<(Pose, f64)>,
}

/// Finds the equilibrium that the options ask for.
pub(crate) fn equilibrium(robot: Robot, args: &StateArgs) -> Result<AtRest> {
    Ok(at_rest(with_options(robot, args)?, args, None)?.0)
}

/// The robot at its state.
fn at_rest(robot: Robot, args: &StateArgs, rule: Option<TensionRule>) -> Result<(AtRest, Option<TensionRule>)> {
    if robot.state == State::Unknown {
        // The core does not know the options' names.
        bail!(
            "the robot has no state: give --lengths-m or --pose, or give every cable of the robot file an \
             `unstrained_length_m`, or the file a [state] with `position_m`"
        );
    }
    let Rest { equilibrium, instead_of, rule } = statics::rest(&robot, args.static_model.into(), rule)?;
    Ok((AtRest { robot, equilibrium, instead_of }, rule))
}

/// As [`equilibrium`], the tensions of a pose as these options ask; with the rule they were chosen by, if there was a
/// choice.
pub(crate) fn equilibrium_with(
    robot: Robot,
    args: &StateArgs,
    tensions: &TensionArgs,
) -> Result<(AtRest, Option<TensionRule>)> {
    let robot = with_limits(&with_options(robot, args)?, tensions)?;
    at_rest(robot, args, rule(tensions)?)
}

/// The robot with the limits of tension that the options give.
pub(crate) fn with_limits(robot: &Robot, tensions: &TensionArgs) -> Result<Robot> {
    let limits = TensionLimits { minimum: tensions.min_tension_n, maximum: tensions.max_tension_n };
    let robot = robot.with_tension_limits(limits);
    for cable in &robot.cables {
        if let TensionLimits { minimum: Some(minimum), maximum: Some(maximum) } = cable.limits()
            && minimum >= maximum
        {
            bail!(
                "the least tension of cable \"{}\" is {minimum} N and its greatest {maximum} N: give --min-tension-n \
                 below --max-tension-n (what is not given is as the robot file says)",
                cable.name
            );
        }
    }
    Ok(robot)
}

/// The rule that the options name.
pub(crate) fn rule(tensions: &TensionArgs) -> Result<Option<TensionRule>> {
    let wanted = tensions.wanted_tension_n.as_ref().map(|wanted| wanted.0.clone());
    Ok(match (tensions.tension_rule, wanted) {
        (None | Some(TensionRuleName::Closest), Some(wanted)) => Some(TensionRule::Closest(wanted)),
        (Some(TensionRuleName::Closest), None) => bail!("--tension-rule closest needs --wanted-tension-n"),
        (Some(_), Some(_)) => bail!("--wanted-tension-n goes with --tension-rule closest only"),
        (Some(TensionRuleName::Lowest), None) => Some(TensionRule::Lowest),
        (Some(TensionRuleName::Middle), None) => Some(TensionRule::Middle),
        (Some(TensionRuleName::Stiffest), None) => Some(TensionRule::Stiffest),
        (None, None) => None,
    })
}

/// The robot with the state and the mass that the options give.
pub(crate) fn with_options(mut robot: Robot, args: &StateArgs) -> Result<Robot> {
    if let Some(lengths) = &args.lengths_m {
        robot.state = State::Lengths(lengths.0.clone());
    }
    if let Some(pose) = &args.pose {
        if robot.platform.freedoms == Freedoms::PointMass && pose.roll_pitch_yaw_deg.iter().any(|angle| *angle != 0.0) {
            bail!("a point mass has no orientation: give --pose x,y,z");
        }
        let pose = Pose::new(pose.position, pose.roll_pitch_yaw_deg);
        robot.platform.freedoms.check(&pose)?;
        robot.state = State::Pose(pose);
    }
    if let Some(mass) = args.mass_kg {
        robot.platform.mass = mass;
    }
    let LoadArgs { force_n, moment_n_m, load_point_m, wind_m_s, cable_load_n_per_m } = args.load;
    let of_file = robot.load;
    robot.load = Load {
        force_w: force_n.unwrap_or(of_file.force_w),
        moment_w: moment_n_m.unwrap_or(of_file.moment_w),
        point_p: load_point_m.unwrap_or(of_file.point_p),
    };
    if let Some(velocity_w) = wind_m_s {
        let speed = velocity_w.norm();
        if speed > Wind::FASTEST {
            bail!(
                "--wind-m-s is a wind of {speed} m/s, it must be at most {} m/s: faster air is compressed",
                Wind::FASTEST
            );
        }
        robot.wind.velocity_w = velocity_w;
    }
    if let Some(load) = cable_load_n_per_m {
        robot = robot.with_cable_load(load);
    }
    if load_point_m.is_some() && robot.load.force_w.norm() == 0.0 {
        bail!("--load-point-m is where a force acts, and there is none: give --force-n");
    }
    robot.load.check(&robot.platform.freedoms)?;
    Ok(robot)
}

/// The models behind a result, as JSON has them.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct Models {
    pub(crate) static_model: &'static str,
    pub(crate) cable_model: &'static str,
    pub(crate) assembly: &'static str,
    pub(crate) in_plane_only: bool,
}

impl Models {
    pub(crate) fn of(equilibrium: &Equilibrium, linearisation: Linearisation) -> Self {
        Self {
            static_model: equilibrium.model.name(),
            cable_model: linearisation.cable_model.name(),
            assembly: linearisation.assembly.name(),
            in_plane_only: linearisation.in_plane_only,
        }
    }

    /// One line for people.
    pub(crate) fn line(&self) -> String {
        let plane = if self.in_plane_only { ", in plane only" } else { "" };
        format!("{} statics, {} cables, {} assembly{plane}", self.static_model, self.cable_model, self.assembly)
    }
}

/// Numbers of a cable's sag, as JSON has them. They are absent for a cable without tension, the string frequency for one
/// without mass, too.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct SagNumbers {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) sag_ratio: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) lambda2: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) string_frequency_hz: Option<f64>,
}

impl SagNumbers {
    pub(crate) fn of(sag: &Sag) -> Self {
        let taut = sag.tension > 0.0;
        Self {
            sag_ratio: taut.then(|| sag.ratio()),
            lambda2: taut.then_some(sag.lambda2),
            string_frequency_hz: taut.then(|| sag.string_frequency_hz()).filter(|f| f.is_finite()),
        }
    }
}

/// The cable model that an option asks for; without a word on it the exact one, or, for cables that do not hang, the closed
/// form of those that hardly sag.
pub(crate) fn cable_model(asked: Option<CableModelName>, static_model: StaticModel) -> CableModel {
    match (asked, static_model) {
        (Some(name), _) => name.into(),
        (None, StaticModel::Catenary) => CableModel::Exact,
        (None, StaticModel::Ideal | StaticModel::Spring) => CableModel::ClosedForm,
    }
}

/// The linearisation that the options ask for.
pub(crate) fn linearisation(args: &ModelArgs, static_model: StaticModel) -> Linearisation {
    Linearisation {
        cable_model: cable_model(args.cable_model, static_model),
        assembly: args.terms.assembly.into(),
        in_plane_only: args.terms.in_plane_only,
    }
}

/// Input and output of a response, checked against what the robot can do.
pub(crate) fn directions(
    robot: &Robot,
    input: &Input,
    output: &Output,
    points: &PointArgs,
) -> Result<(Direction, Direction), PortError> {
    Ok((input.direction(robot, points.input_point_m)?, output.direction(robot, points.output_point_m)?))
}

impl AtRest {
    /// The points on cables where a response begins or ends.
    pub(crate) fn places(
        &self,
        dynamics: &Dynamics,
        input: Option<&OnCable>,
        output: Option<&OnCable>,
    ) -> Result<Places, PlaceError> {
        Places::new(&self.robot, &self.equilibrium, dynamics, input, output)
    }

    /// Linearises, with what there is to warn of for frequencies up to a limit [Hz].
    pub(crate) fn dynamics(&self, linearisation: Linearisation, up_to_hz: f64) -> Result<(Dynamics, Vec<String>)> {
        let dynamics = Dynamics::about(&self.robot, &self.equilibrium, linearisation, up_to_hz)?;
        Ok((dynamics, self.warnings(Some((linearisation.cable_model, up_to_hz)))))
    }

    /// What there is to warn of the statics and, if asked, of a cable model up to a frequency [Hz].
    pub(crate) fn warnings(&self, dynamics: Option<(CableModel, f64)>) -> Vec<String> {
        let mut warnings = validity::of_statics(&self.robot, &self.equilibrium);
        if let Some((model, up_to_hz)) = dynamics {
            warnings.extend(validity::of_dynamics(&self.robot, &self.equilibrium, model, up_to_hz));
        }
        let elsewhere = self
            .instead_of
            .and_then(|(asked, distance)| validity::of_pose(&self.robot, &self.equilibrium, &asked, distance));
        elsewhere.iter().chain(&warnings).map(ToString::to_string).collect()
    }
}
