//! Results whose deviations are computed: their names, values and gradients.

use super::responses::Responses;
use crate::at_rest::AtRest;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::gradient::{GradientError, Gradients};
use funicular::modes;
use funicular::robot::{Pose, Robot, RobotChange};
use funicular::statics::{Equilibrium, Stability};

/// Result of a robot at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum ResultKind {
    /// Component of the pose: position, then rotation vector from the equilibrium of the undisturbed robot.
    Pose(usize),
    /// Unstrained length of a cable.
    Length(usize),
    /// Tension of a cable at the platform.
    TensionAtPlatform(usize),
    /// Tension of a cable at its anchor.
    TensionAtAnchor(usize),
    /// Minimum stiffness.
    MinStiffness,
    /// Natural frequency, by its number in the ascending list, from 0.
    Frequency(usize),
    /// Damping ratio of the mode with this number, from 0.
    Damping(usize),
    /// Magnitude of the response at this frequency [Hz], in decibels of its unit.
    Magnitude(f64),
    /// Phase of the response at this frequency [Hz], in degrees.
    Phase(f64),
}

/// Axes of the components of a pose.
const AXES: [&str; 3] = ["x", "y", "z"];

impl ResultKind {
    /// Name, as results of `gradient` have it.
    pub(crate) fn name(self, robot: &Robot) -> String {
        let cable = |i: usize| &robot.cables[i].name;
        match self {
            Self::Pose(k) if k < 3 => AXES[k].to_owned(),
            Self::Pose(k) => format!("rotation about {}", AXES[k - 3]),
            Self::Length(i) => format!("length of cable \"{}\"", cable(i)),
            Self::TensionAtPlatform(i) => format!("tension of cable \"{}\" at the platform", cable(i)),
            Self::TensionAtAnchor(i) => format!("tension of cable \"{}\" at the anchor", cable(i)),
            Self::MinStiffness => "minimum stiffness".to_owned(),
            Self::Frequency(k) => format!("frequency {}", k + 1),
            Self::Damping(k) => format!("damping ratio {}", k + 1),
            Self::Magnitude(hz) => format!("magnitude of the response at {hz} Hz"),
            Self::Phase(hz) => format!("phase of the response at {hz} Hz"),
        }
    }

    /// Name of a column with its unit, as in files of sweeps.
    pub(crate) fn column(self, robot: &Robot) -> String {
        let cable = |i: usize| &robot.cables[i].name;
        match self {
            Self::Pose(k) if k < 3 => format!("pose_{}_m", AXES[k]),
            Self::Pose(k) => format!("pose_rotation_{}_rad", AXES[k - 3]),
            Self::Length(i) => format!("unstrained_length_{}_m", cable(i)),
            Self::TensionAtPlatform(i) => format!("tension_platform_{}_n", cable(i)),
            Self::TensionAtAnchor(i) => format!("tension_anchor_{}_n", cable(i)),
            Self::MinStiffness => "stiffness_min_n_per_m".to_owned(),
            Self::Frequency(k) => format!("frequency_{}_hz", k + 1),
            Self::Damping(k) => format!("damping_ratio_{}", k + 1),
            Self::Magnitude(hz) => format!("response_at_{hz}_hz_db"),
            Self::Phase(hz) => format!("response_at_{hz}_hz_phase_deg"),
        }
    }

    /// Unit.
    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::Pose(k) if k >= 3 => "rad",
            Self::Pose(_) | Self::Length(_) => "m",
            Self::TensionAtPlatform(_) | Self::TensionAtAnchor(_) => "N",
            Self::MinStiffness => "N/m",
            Self::Frequency(_) => "Hz",
            Self::Damping(_) => "1",
            Self::Magnitude(_) => "dB",
            Self::Phase(_) => "degrees",
        }
    }

    /// Frequency of a response [Hz].
    pub(crate) fn at_hz(self) -> Option<f64> {
        match self {
            Self::Magnitude(hz) | Self::Phase(hz) => Some(hz),
            _ => None,
        }
    }

    /// Number of the mode, from 0, for results of a mode.
    pub(crate) fn mode(self) -> Option<usize> {
        match self {
            Self::Frequency(k) | Self::Damping(k) => Some(k),
            _ => None,
        }
    }

    /// Results of the groups of a request at an equilibrium with `modes` modes, and responses at frequencies [Hz].
    pub(super) fn of_groups(of: &[&str], robot: &Robot, modes: usize, at_hz: &[f64]) -> Vec<Self> {
        let cables = 0..robot.cables.len();
        let mut kinds = Vec::new();
        if of.contains(&"pose") {
            kinds.extend(robot.platform.motion.components().into_iter().map(Self::Pose));
        }
        if of.contains(&"lengths") {
            kinds.extend(cables.clone().map(Self::Length));
        }
        if of.contains(&"tensions") {
            kinds.extend(cables.clone().map(Self::TensionAtPlatform));
            kinds.extend(cables.map(Self::TensionAtAnchor));
        }
        if of.contains(&"stiffness-min") {
            kinds.push(Self::MinStiffness);
        }

        if of.contains(&"frequencies") {
            kinds.extend((0..modes).map(Self::Frequency));
        }
        if of.contains(&"damping") {
            kinds.extend((0..modes).map(Self::Damping));
        }
        kinds.extend(at_hz.iter().copied().map(Self::Magnitude));
        kinds.extend(at_hz.iter().copied().map(Self::Phase));
        kinds
    }

    /// Value that needs no vibration; `None` for results of vibration.
    pub(super) fn static_value(self, rest: &Equilibrium, undisturbed: &Pose) -> Option<f64> {
        let cable = |i: usize| rest.cables.get(i);
        match self {
            Self::Pose(k) if k < 3 => Some(rest.pose.position_w[k]),
            Self::Pose(k) => Some((rest.pose.rot_wp * undisturbed.rot_wp.inverse()).scaled_axis()[k - 3]),
            Self::Length(i) => cable(i).map(|cable| cable.unstrained_length),
            Self::TensionAtPlatform(i) => cable(i).map(|cable| cable.tension_platform),
            Self::TensionAtAnchor(i) => cable(i).map(|cable| cable.tension_anchor),
            Self::MinStiffness => rest.stability.min_stiffness(),
            Self::Frequency(_) | Self::Damping(_) | Self::Magnitude(_) | Self::Phase(_) => None,
        }
    }
}

/// Values of all results of a sampled robot at rest; NaN for a value that does not exist.
pub(super) fn values(
    kinds: &[ResultKind],
    robot: &Robot,
    rest: &Equilibrium,
    undisturbed: &Pose,
    linearisation: Linearisation,
    responses: Option<&Responses>,
) -> Vec<f64> {
    let modes = kinds.iter().filter_map(|kind| kind.mode()).max().map_or(0, |last| last + 1);
    let is_unstable = matches!(rest.stability, Stability::Unstable { .. });
    let found = (modes > 0 && !is_unstable)
        .then(|| modes::lowest(robot, rest, linearisation, modes, crate::request::MAX_HZ).ok())
        .flatten();
    let needs_damping = kinds.iter().any(|kind| matches!(kind, ResultKind::Damping(_)));
    let damped = found
        .as_ref()
        .filter(|_| needs_damping)
        .map(|(dynamics, found)| modes::damped::damped_modes(dynamics, found).modes);

    let of_responses = responses.filter(|_| !is_unstable).and_then(|of| of.changes(robot, rest, linearisation));

    let value = |kind: &ResultKind| match *kind {
        ResultKind::Magnitude(hz) => {
            let place = responses?.place(hz)?;
            Some(responses?.decibels(place) + of_responses.as_ref()?.get(place)?.decibels())
        }
        ResultKind::Phase(hz) => {
            let place = responses?.place(hz)?;
            Some(responses?.degrees(place) + of_responses.as_ref()?.get(place)?.degrees())
        }
        ResultKind::Frequency(k) => found.as_ref()?.1.modes.get(k).map(|mode| mode.frequency_hz),
        ResultKind::Damping(k) => damped.as_ref()?.get(k).map(modes::damped::DampedMode::damping_ratio),
        other => other.static_value(rest, undisturbed),
    };
    kinds.iter().map(|kind| value(kind).unwrap_or(f64::NAN)).collect()
}

/// Gradients of the results of an equilibrium that belong to no vibration.
pub(super) fn static_gradients(
    kinds: &[ResultKind],
    gradients: &Gradients,
) -> Vec<Option<Result<RobotChange, GradientError>>> {
    let pose = gradients.pose();
    let has = |wanted: fn(&ResultKind) -> bool| kinds.iter().any(wanted);
    let of_cables = |is_wanted: bool, all: &dyn Fn() -> Vec<RobotChange>| if is_wanted { all() } else { Vec::new() };
    let lengths = of_cables(has(|kind| matches!(kind, ResultKind::Length(_))), &|| gradients.lengths());
    let anchors =
        of_cables(has(|kind| matches!(kind, ResultKind::TensionAtAnchor(_))), &|| gradients.tensions_anchor());
    let platform =
        of_cables(has(|kind| matches!(kind, ResultKind::TensionAtPlatform(_))), &|| gradients.tensions_platform());
    let gradient = |kind: &ResultKind| match *kind {
        ResultKind::Pose(k) => Some(Ok(pose[k].clone())),
        ResultKind::Length(i) => Some(Ok(lengths[i].clone())),
        ResultKind::TensionAtPlatform(i) => Some(Ok(platform[i].clone())),
        ResultKind::TensionAtAnchor(i) => Some(Ok(anchors[i].clone())),
        ResultKind::MinStiffness => Some(gradients.min_stiffness()),
        ResultKind::Frequency(_) | ResultKind::Damping(_) | ResultKind::Magnitude(_) | ResultKind::Phase(_) => None,
    };
    kinds.iter().map(gradient).collect()
}

/// Modes of the undisturbed robot.
pub(super) struct NominalModes {
    /// Linearised robot.
    pub(super) dynamics: Dynamics,
    /// Modes up to somewhat beyond the limit of the request.
    pub(super) found: modes::Modes,
    /// Damped modes, if a request wants damping ratios.
    pub(super) damped: Vec<modes::damped::DampedMode>,
    /// Number of modes below the limit of the request.
    pub(super) count: usize,
    /// Warnings about the cable model.
    pub(super) warnings: Vec<String>,
}

/// Ratio of the limit of the list of modes to the limit of the request: the list has to contain the neighbour of the
/// last mode.
const BEYOND: f64 = 1.25;

impl NominalModes {
    /// Modes below a limit [Hz], or up to the highest frequency of a response if that is more, and somewhat beyond.
    ///
    /// # Errors
    /// A cable model that has no stiffness at this equilibrium.
    pub(super) fn new(
        at_rest: &AtRest,
        linearisation: Linearisation,
        below_hz: f64,
        needs_damping: bool,
        at_hz: &[f64],
    ) -> anyhow::Result<Self> {
        let limit_hz = BEYOND * at_hz.iter().copied().fold(below_hz, f64::max);
        let (dynamics, warnings) = at_rest.dynamics(linearisation, limit_hz)?;
        let found = modes::below(&dynamics, limit_hz);
        let count = found.modes.iter().filter(|mode| mode.frequency_hz < below_hz).count();
        let damped = if needs_damping { modes::damped::damped_modes(&dynamics, &found).modes } else { Vec::new() };
        Ok(Self { dynamics, found, damped, count, warnings })
    }
}
