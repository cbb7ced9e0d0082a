//! Results whose deviations are computed, and their values for a robot.

use super::responses::Responses;
use crate::at_rest::AtRest;
use crate::measure::{MEASURES, Measure, MeasureGroup, ResponsePart, TensionPlace};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::modes;
use funicular::robot::{Pose, Robot};
use funicular::statics::{Equilibrium, Stability};

/// Measures of the groups of a request at an equilibrium with `modes` modes, and responses at frequencies [Hz].
pub(super) fn of_groups(of: &[&MeasureGroup], robot: &Robot, modes: usize, at_hz: &[f64]) -> Vec<Measure> {
    let components: Vec<usize> = robot.platform.motion.components().into_iter().collect();
    let places = [TensionPlace::Platform, TensionPlace::Anchor];
    let mut all = Vec::new();
    for group in MEASURES.iter().filter(|group| of.contains(group)) {
        match group {
            MeasureGroup::Frequencies => all.extend((0..modes).map(Measure::Frequency)),
            MeasureGroup::Damping => all.extend((0..modes).map(Measure::Damping)),
            _ => all.extend(group.of_statics(robot, &components, &places)),
        }
    }
    for part in [ResponsePart::Magnitude, ResponsePart::Phase] {
        all.extend(at_hz.iter().map(|hz| Measure::Response(*hz, part)));
    }
    all
}

/// Values of all results of a sampled robot at rest; NaN for a value that does not exist.
pub(super) fn values(
    kinds: &[Measure],
    robot: &Robot,
    rest: &Equilibrium,
    undisturbed: &Pose,
    linearisation: Linearisation,
    responses: Option<&Responses>,
) -> Vec<f64> {
    let modes = kinds.iter().filter_map(|kind| kind.mode()).max().map_or(0, |last| last + 1);
    let is_unstable = matches!(rest.stability, Stability::Unstable { .. });
    let (stiffer, vibrating) = rest.with_dynamic_stiffness(robot);
    let found = (modes > 0 && !is_unstable)
        .then(|| modes::lowest(&stiffer, &vibrating, linearisation, modes, crate::request::MAX_HZ).ok())
        .flatten();
    let needs_damping = kinds.iter().any(|kind| matches!(kind, Measure::Damping(_)));
    let damped = found
        .as_ref()
        .filter(|_| needs_damping)
        .map(|(dynamics, found)| modes::damped::damped_modes(dynamics, found).modes);

    let of_responses =
        responses.filter(|_| !is_unstable).and_then(|of| of.changes(&stiffer, &vibrating, linearisation));

    let value = |kind: &Measure| match *kind {
        Measure::Response(hz, part) => {
            let place = responses?.place(hz)?;
            let change = of_responses.as_ref()?.get(place)?;
            Some(match part {
                ResponsePart::Phase => responses?.degrees(place) + change.degrees(),
                _ => responses?.decibels(place) + change.decibels(),
            })
        }
        Measure::Frequency(k) => found.as_ref()?.1.modes.get(k).map(|mode| mode.frequency_hz),
        Measure::Damping(k) => damped.as_ref()?.get(k).map(modes::damped::DampedMode::damping_ratio),
        other => other.static_value(robot, rest, undisturbed),
    };
    kinds.iter().map(|kind| value(kind).unwrap_or(f64::NAN)).collect()
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
