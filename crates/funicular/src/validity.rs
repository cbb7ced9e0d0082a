//! Where a model leaves its range: each warning says which cable, the number, the limit and what to do.

use crate::cable::{CableModel, SHALLOW_SAG_LIMIT, Sag};
use crate::robot::Robot;
use crate::statics::{Equilibrium, Limit, Stability, StaticModel, TensionMargin, TensionRange};
use std::fmt;

/// Something the user should know before trusting a result.
#[derive(Debug, Clone, PartialEq)]
pub enum Warning {
    /// A cable without force.
    Slack {
        /// Name of the cable.
        cable: String,
    },
    /// An ideal cable that would have to push.
    Pushing {
        /// Name of the cable.
        cable: String,
        /// Its tension [N], negative.
        tension: f64,
    },
    /// A rope beyond its breaking load.
    Breaks {
        /// Name of the cable.
        cable: String,
        /// Its greatest tension [N].
        tension: f64,
        /// What its rope breaks at [N].
        breaking_load: f64,
    },
    /// A tension beyond a limit that the robot file has.
    BeyondLimit {
        /// Name of the cable.
        cable: String,
        /// Its least or greatest tension [N].
        tension: f64,
        /// Which limit.
        limit: Limit,
        /// The limit [N].
        value: f64,
    },
    /// An equilibrium that the platform leaves by itself.
    Unstable {
        /// Directions that are not opposed.
        directions: usize,
        /// Least eigenvalue of the scaled stiffness [N/m].
        least_stiffness: f64,
    },
    /// A shallow-sag model on cables that sag deeper.
    DeepSag {
        /// Names of the cables and their sag over chord, file order.
        cables: Vec<(String, f64)>,
        /// The model.
        model: CableModel,
    },
    /// Frequencies near a cable's first axial resonance, which no model here contains.
    AxialWaves {
        /// Name of the cable with the lowest one.
        cable: String,
        /// First axial frequency [Hz].
        axial_hz: f64,
        /// Highest frequency asked [Hz].
        below_hz: f64,
    },
}

/// Part of the first axial frequency from which on axial inertia is warned of: the axial stiffness of a taut cable, which
/// is `φ cot φ` times the static one with φ = π/3 there, is then taken two thirds too stiff, and 4 % at a third of that.
pub const AXIAL_PART: f64 = 1.0 / 3.0;

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Slack { cable } => write!(
                f,
                "cable \"{cable}\" is slack: it carries no force and does not help to hold the platform; shorten it or \
                 choose the static model `catenary`, which knows its weight"
            ),
            Self::Pushing { cable, tension } => write!(
                f,
                "cable \"{cable}\" would have to push with {:.3} N: ideal cables cannot hold this pose; choose the \
                 static model `spring` or `catenary`, or another pose",
                -tension
            ),
            Self::Breaks { cable, tension, breaking_load } => write!(
                f,
                "cable \"{cable}\" has {tension:.1} N, and its rope breaks at {breaking_load} N: this state cannot be; \
                 choose a stronger rope, another pose or less load"
            ),
            Self::BeyondLimit { cable, tension, limit, value } => {
                let (most, side, name) = match limit {
                    Limit::Minimum => ("as little as", "less", "minimum_tension_n"),
                    Limit::Maximum => ("up to", "more", "maximum_tension_n"),
                };
                write!(
                    f,
                    "cable \"{cable}\" has {most} {tension:.1} N, {side} than its `{name}`, {value} N: choose another \
                     pose, load or lengths, or another limit"
                )
            }
            Self::Unstable { directions, least_stiffness } => write!(
                f,
                "the equilibrium is not stable: {directions} of its directions {} not opposed (least scaled stiffness \
                 {least_stiffness:.3e} N/m); the robot would leave it",
                if *directions == 1 { "is" } else { "are" }
            ),
            Self::DeepSag { cables, model } => write!(
                f,
                "cable {} of the chord, more than 1/20: the {model} model is outside its \
                 range, its first cable frequency is wrong by some 2 % at 0.05 and 7 % at 0.10 at 36° inclination, more \
                 where steeper; raise the tension or read its cable resonances with care",
                cables
                    .iter()
                    .map(|(name, ratio)| format!("\"{name}\" sags by {ratio:.4}"))
                    .collect::<Vec<_>>()
                    .join(", ")
            ),
            Self::AxialWaves { cable, axial_hz, below_hz } => write!(
                f,
                "{below_hz} Hz is more than a third of the first axial frequency {axial_hz:.1} Hz of cable \"{cable}\": \
                 axial waves, which this model leaves out, matter there; lower the limit"
            ),
        }
    }
}

/// Where a cable is beyond the limits that the file has, or beyond what its rope bears; the worst only.
fn of_tension(robot: &Robot, i: usize, margin: &TensionMargin) -> Option<Warning> {
    let (cable, limits) = (&robot.cables[i], robot.cables[i].limits());
    let name = cable.name.clone();
    if let Some(breaking_load) = cable.material.breaking_load.filter(|load| margin.greatest > *load * (1.0 + 1e-6)) {
        return Some(Warning::Breaks { cable: name, tension: margin.greatest, breaking_load });
    }
    // Within a millionth is within: that is what tensions are found to.
    if let Some(value) = limits.maximum.filter(|most| margin.greatest > *most * (1.0 + 1e-6)) {
        return Some(Warning::BeyondLimit { cable: name, tension: margin.greatest, limit: Limit::Maximum, value });
    }
    let value = limits.minimum.filter(|least| margin.least < *least * (1.0 - 1e-6))?;
    Some(Warning::BeyondLimit { cable: name, tension: margin.least, limit: Limit::Minimum, value })
}

/// Warnings about a static state.
pub fn of_statics(robot: &Robot, equilibrium: &Equilibrium) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for (i, (cable, state)) in robot.cables.iter().zip(&equilibrium.cables).enumerate() {
        if equilibrium.model == StaticModel::Ideal {
            if state.tension_platform < 0.0 {
                let (cable, tension) = (cable.name.clone(), state.tension_platform);
                warnings.push(Warning::Pushing { cable, tension });
            }
        } else if state.is_slack() {
            warnings.push(Warning::Slack { cable: cable.name.clone() });
        }
        warnings.extend(of_tension(robot, i, &TensionRange::of(robot, i, state.chord()).margin(state)));
    }
    if let Stability::Unstable { least_stiffness, directions } = equilibrium.stability {
        warnings.push(Warning::Unstable { directions, least_stiffness });
    }
    warnings
}

/// Warnings about a cable model at a static state for frequencies up to `below_hz` [Hz].
pub fn of_dynamics(robot: &Robot, equilibrium: &Equilibrium, model: CableModel, below_hz: f64) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let sags: Vec<Sag> = equilibrium.cables.iter().enumerate().map(|(i, state)| Sag::of(robot, i, state)).collect();
    if matches!(model, CableModel::StaticSag | CableModel::ClosedForm) {
        let deep = |sag: &Sag| sag.tension > 0.0 && sag.ratio() > SHALLOW_SAG_LIMIT;
        let cables: Vec<(String, f64)> = robot
            .cables
            .iter()
            .zip(&sags)
            .filter(|(_, sag)| deep(sag))
            .map(|(cable, sag)| (cable.name.clone(), sag.ratio()))
            .collect();
        if !cables.is_empty() {
            warnings.push(Warning::DeepSag { cables, model });
        }
    }
    let lowest = (0..sags.len()).min_by(|&i, &j| sags[i].axial_frequency_hz().total_cmp(&sags[j].axial_frequency_hz()));
    if let Some(i) = lowest {
        let axial_hz = sags[i].axial_frequency_hz();
        if model != CableModel::Exact && below_hz > AXIAL_PART * axial_hz {
            warnings.push(Warning::AxialWaves { cable: robot.cables[i].name.clone(), axial_hz, below_hz });
        }
    }
    warnings
}
