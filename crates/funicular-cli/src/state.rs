//! The static state that an analysis starts from: as the robot file says, or as the options say.

use crate::args::{CableModelName, LoadArgs, ModelArgs, StateArgs, TensionArgs, TensionRuleName};
use crate::table::short;
use anyhow::{Result, bail};
use funicular::cable::{CableModel, Sag};
use funicular::dynamics::{Assembly, Dynamics, Linearisation};
use funicular::robot::{Freedoms, Load, Pose, Robot, State, TensionLimits, Wind};
use funicular::statics::{self, Equilibrium, StaticModel, TensionRule};
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
    let robot = with_options(robot, args)?;
    let model = args.static_model.into();
    let mut instead_of = None;
    let equilibrium = match &robot.state {
        State::Lengths(lengths) => statics::forward(&robot, lengths, model, None)?,
        State::Pose(pose) if robot.cables.len() < robot.platform.freedoms.count() => {
            let nearest = statics::nearest(&robot, pose, model)?;
            instead_of = Some((*pose, nearest.distance));
            nearest.equilibrium
        }
        State::Pose(pose) => statics::inverse(&robot, pose, model)?,
        State::Unknown => bail!(
            "the robot has no state: give --lengths-m or --pose, or give every cable of the robot file an \
             `unstrained_length_m`, or the file a [state] with `position_m`"
        ),
    };
    Ok(AtRest { robot, equilibrium, instead_of })
}

/// As [`equilibrium`], the tensions of a pose as these options ask; with the rule they were chosen by, if there was a
/// choice.
pub(crate) fn equilibrium_with(
    robot: Robot,
    args: &StateArgs,
    tensions: &TensionArgs,
) -> Result<(AtRest, Option<TensionRule>)> {
    let robot = with_limits(&with_options(robot, args)?, tensions)?;
    let asked = rule(tensions)?;
    let (cables, freedoms) = (robot.cables.len(), robot.platform.freedoms.count());
    match &robot.state {
        State::Pose(pose) if cables > freedoms => {
            let rule = asked.unwrap_or_default();
            let equilibrium = statics::distribute(&robot, pose, args.static_model.into(), &rule)?;
            Ok((AtRest { robot, equilibrium, instead_of: None }, Some(rule)))
        }
        State::Pose(_) if asked.is_some() => bail!(
            "a tension rule has nothing to choose: {cables} cables for {freedoms} freedoms have one set of tensions at a \
             pose; leave out --tension-rule and --wanted-tension-n"
        ),
        State::Lengths(_) if asked.is_some() => bail!(
            "a tension rule has nothing to choose: the state is given by unstrained lengths, which determine the \
             tensions; give --pose"
        ),
        // The limits are in the robot now, for warnings to compare with.
        _ => Ok((equilibrium(robot, &StateArgs { lengths_m: None, pose: None, mass_kg: None, ..*args })?, None)),
    }
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
    if robot.platform.freedoms == Freedoms::PointMass {
        if robot.load.moment_w.norm() > 0.0 {
            bail!("a point mass does not turn: remove --moment-n-m");
        }
        if robot.load.point_p.norm() > 0.0 {
            bail!("a point mass has no points but its origin: remove --load-point-m");
        }
    }
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
            static_model: static_model_name(equilibrium.model),
            cable_model: linearisation.cable_model.name(),
            assembly: assembly_name(linearisation.assembly),
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

impl AtRest {
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
        self.instead().into_iter().chain(warnings.iter().map(ToString::to_string)).collect()
    }

    /// That the pose is not the one asked, and how far it is from it.
    fn instead(&self) -> Option<String> {
        let (asked, distance) = self.instead_of?;
        let AtRest { robot, equilibrium, .. } = self;
        if distance <= HELD * robot.platform_length() {
            return None;
        }
        let found = &equilibrium.pose;
        let (cables, freedoms) = (robot.cables.len(), robot.platform.freedoms.count());
        Some(format!(
            "{cables} cables for {freedoms} freedoms cannot hold the pose asked by any lengths: this is the nearest that they \
             can, {} mm and {}° away (nearest_pose_distance_m {})",
            short(1e3 * (found.position_w - asked.position_w).norm(), 4),
            short(found.rot_wp.angle_to(&asked.rot_wp).to_degrees(), 4),
            short(distance, 4)
        ))
    }
}

/// Distance from the pose asked, over the size of the platform, up to which it is that pose: what forward statics leaves.
const HELD: f64 = 1e-7;

/// Name of a static model on the command line and in files.
pub(crate) fn static_model_name(model: StaticModel) -> &'static str {
    match model {
        StaticModel::Ideal => "ideal",
        StaticModel::Spring => "spring",
        StaticModel::Catenary => "catenary",
    }
}

/// Name of an assembly on the command line and in files.
pub(crate) fn assembly_name(assembly: Assembly) -> &'static str {
    match assembly {
        Assembly::Consistent => "consistent",
        Assembly::Paper => "paper",
    }
}
