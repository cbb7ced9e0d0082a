//! Where a model leaves its range: each warning says which cable, the number, the limit and what to do.

use crate::cable::catenary_dynamic::CatenaryDynamic;
use crate::cable::shallow_dynamic::ShallowDynamic;
use crate::cable::{CableModel, LocalAxes, SHALLOW_SAG_LIMIT, Sag, shallow_static};
use crate::robot::{Pose, Robot};
use crate::statics::{self, CableState, Equilibrium, Limit, Stability, StaticModel, TensionMargin, TensionRange};
use std::f64::consts::TAU;
use std::fmt;

/// Something the user should know before trusting a result.
#[derive(Debug, Clone, PartialEq)]
pub enum Warning {
    /// A cable without force.
    Slack {
        /// Name of the cable.
        cable: String,
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
    /// Wind, and ropes of which the file does not say how it pulls at them.
    NoDrag {
        /// Names of the ropes.
        ropes: Vec<String>,
    },
    /// A pose near one at which the cables do not hold the platform.
    NearlySingular {
        /// Tension per worst unit wrench, [`crate::statics::tension_gain`]; infinite at a singular pose.
        gain: f64,
    },
    /// An equilibrium that the platform leaves by itself.
    Unstable {
        /// Directions that are not opposed.
        directions: usize,
        /// Least eigenvalue of the scaled stiffness [N/m].
        min_stiffness: f64,
    },
    /// A pose asked that fewer cables than degrees of freedom cannot hold.
    Elsewhere {
        /// Cables of the robot.
        cables: usize,
        /// Degrees of freedom of the platform.
        dof: usize,
        /// How far the platform is from where it was asked to be [m].
        translation: f64,
        /// How far it is turned from what was asked [degrees].
        turn_deg: f64,
        /// Both together [m], [`crate::statics::pose_distance`].
        distance: f64,
    },
    /// A shallow-sag model on cables that sag deeper.
    DeepSag {
        /// The cables, file order.
        cables: Vec<DeepSag>,
        /// The model.
        model: CableModel,
    },
    /// Wind whose drag turns with the cables, which the symmetric stiffness of vibration leaves out.
    DragTurns {
        /// Largest relative change of the static displacement under a small load, [`crate::statics::drag_effect`].
        effect: f64,
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

/// A cable that sags deeper than a shallow-sag model allows.
#[derive(Debug, Clone, PartialEq)]
pub struct DeepSag {
    /// Name of the cable.
    pub cable: String,
    /// Sag over chord.
    pub ratio: f64,
    /// How far the model is off at this cable, against the exact one: its first clamped frequency in plane if it has
    /// frequencies, or its stiffness along the chord at rest. `None` where there is no exact one.
    pub error: Option<f64>,
}

impl DeepSag {
    /// Of cable `i` at a static state, if it sags too deep for the model.
    pub fn of(robot: &Robot, i: usize, state: &CableState, model: CableModel) -> Option<Self> {
        let sag = Sag::of(robot, i, state);
        let shallow = matches!(model, CableModel::ShallowStatic | CableModel::ShallowDynamic);
        (shallow && sag.tension > 0.0 && sag.ratio() > SHALLOW_SAG_LIMIT).then(|| Self {
            cable: robot.cables[i].name.clone(),
            ratio: sag.ratio(),
            error: measured(robot, i, state, sag, model),
        })
    }
}

/// Relative error of a shallow-sag model at one cable.
fn measured(robot: &Robot, i: usize, state: &CableState, sag: Sag, model: CableModel) -> Option<f64> {
    let hanging = state.hanging.as_ref().filter(|hanging| hanging.catenary.rope().weight_per_length > 0.0)?;
    if model == CableModel::ShallowStatic {
        let e = hanging.chord_w().normalize();
        return Some(shallow_static::stiffness(&sag).axial / e.dot(&(hanging.tangent_w() * e)) - 1.0);
    }
    let m = sag.mass_per_length;
    let axes = LocalAxes::of_cable(robot, i, state);
    // The first root of the sagging string lies below its third, 3π/l.
    let highest = TAU * 3.0 * sag.string_frequency_hz();
    let closed = ShallowDynamic::new(sag, axes, robot.cables[i].material.damping, true);
    let first = *closed.clamped_frequencies_below(highest).first()?;
    let exact = CatenaryDynamic::new(&hanging.catenary, m, highest).ok()?;
    Some(first / exact.in_plane.poles.first()?.sqrt() - 1.0)
}

/// Tension per worst unit wrench from which a pose is called nearly singular: ten times the largest at the poses of the
/// library's robots, which have 0.9 to 3.1.
pub const SINGULAR_GAIN: f64 = 30.0;

/// Relative change of static displacements from which the turn of the drag is warned of; a drag coefficient is hardly known
/// to one per cent.
pub const DRAG_TURN_LIMIT: f64 = 0.01;

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
            Self::NoDrag { ropes } => {
                let ropes: Vec<String> = ropes.iter().map(|rope| format!("\"{rope}\"")).collect();
                write!(
                    f,
                    "the wind does not act on cables of {}: give a `drag_coefficient` in the robot file (a round rope has \
                     1.0 to 1.2), or 0 for none",
                    ropes.join(", ")
                )
            }
            Self::NearlySingular { gain } if gain.is_infinite() => write!(
                f,
                "the pose is singular: in some direction no tensions of the cables resist a force; choose a pose from \
                 which the cables pull in more directions"
            ),
            Self::NearlySingular { gain } => write!(
                f,
                "the pose is nearly singular: in its weakest direction a force of 1 N takes {gain:.0} N of tension (warned \
                 of from {SINGULAR_GAIN}); choose a pose from which the cables pull in more directions"
            ),
            Self::Unstable { directions, min_stiffness: 0.0 } => write!(
                f,
                "the equilibrium is indifferent: in {directions} of its directions nothing holds the platform, which has \
                 natural frequencies of zero there; add a cable, or another point to pull at"
            ),
            Self::Unstable { directions, min_stiffness } => write!(
                f,
                "the equilibrium is not stable: {directions} of its directions {} not opposed (least scaled stiffness \
                 {min_stiffness:.3e} N/m); the robot would leave it",
                if *directions == 1 { "is" } else { "are" }
            ),
            Self::Elsewhere { cables, dof, translation, turn_deg, distance } => write!(
                f,
                "{} for {dof} degrees of freedom cannot hold the pose asked by any lengths: this is the nearest \
                 that can be held, {:.3} mm and {turn_deg:.4}° away (nearest_pose_distance_m {distance:.6})",
                crate::counted(*cables, "cable"),
                1e3 * translation
            ),
            Self::DeepSag { cables, model } => {
                let what =
                    if *model == CableModel::ShallowStatic { "stiffness along the chord" } else { "first frequency" };
                let one = |DeepSag { cable, ratio, error }: &DeepSag| {
                    let error =
                        error.map_or(String::new(), |error| format!(" ({what} off by {:+.1} %)", 100.0 * error));
                    format!("\"{cable}\" sags by {ratio:.4}{error}")
                };
                write!(
                    f,
                    "cable {} of the chord, more than 1/20: the {model} model is outside its range; use the model \
                     `catenary-dynamic`, or raise the tension",
                    cables.iter().map(one).collect::<Vec<_>>().join(", ")
                )
            }
            Self::DragTurns { effect } => write!(
                f,
                "the drag of the wind turns with the cables and changes the static displacement under a small load by up \
                 to {:.1} % (rotations times the platform's size); this stiffness, symmetric and with the drag held, leaves \
                 it out: take static displacements from `stiffness` at 0 Hz without a cable model, which has it",
                100.0 * effect
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
    if let Some(breaking_load) = cable.material.breaking_load.filter(|load| margin.max > *load * (1.0 + 1e-6)) {
        return Some(Warning::Breaks { cable: name, tension: margin.max, breaking_load });
    }
    // Within a millionth is within: that is what tensions are found to.
    if let Some(value) = limits.maximum.filter(|most| margin.max > *most * (1.0 + 1e-6)) {
        return Some(Warning::BeyondLimit { cable: name, tension: margin.max, limit: Limit::Maximum, value });
    }
    let value = limits.minimum.filter(|min| margin.min < *min * (1.0 - 1e-6))?;
    Some(Warning::BeyondLimit { cable: name, tension: margin.min, limit: Limit::Minimum, value })
}

/// Distance from the pose asked, over the size of the platform, up to which it is that pose: what forward statics leaves.
const HELD: f64 = 1e-7;

/// That an equilibrium is not at the pose asked, where it is the nearest that the cables hold
/// ([`Solution::requested_pose`](crate::statics::Solution::requested_pose)).
pub fn of_pose(robot: &Robot, equilibrium: &Equilibrium, asked: &Pose, distance: f64) -> Option<Warning> {
    let found = &equilibrium.pose;
    (distance > HELD * robot.platform_length()).then(|| Warning::Elsewhere {
        cables: robot.cables.len(),
        dof: robot.platform.motion.count(),
        translation: (found.position_w - asked.position_w).norm(),
        turn_deg: found.rot_wp.angle_to(&asked.rot_wp).to_degrees(),
        distance,
    })
}

/// Warnings about a static state.
pub fn of_statics(robot: &Robot, equilibrium: &Equilibrium) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for (i, (cable, state)) in robot.cables.iter().zip(&equilibrium.cables).enumerate() {
        if equilibrium.model != StaticModel::Ideal && state.is_slack() {
            warnings.push(Warning::Slack { cable: cable.name.clone() });
        }
        warnings.extend(of_tension(robot, i, &TensionRange::of(robot, i, &state.chord_w()).margin(state)));
    }
    if robot.wind.velocity_w.norm() > 0.0 {
        let mut ropes: Vec<String> = Vec::new();
        for material in robot.cables.iter().map(|cable| &cable.material).filter(|rope| rope.drag_width.is_none()) {
            if !ropes.contains(&material.name) {
                ropes.push(material.name.clone());
            }
        }
        if !ropes.is_empty() {
            warnings.push(Warning::NoDrag { ropes });
        }
    }
    if statics::tension_gain_exceeds(robot, equilibrium, SINGULAR_GAIN)
        && let Some(gain) = statics::tension_gain(robot, equilibrium)
    {
        warnings.push(Warning::NearlySingular { gain });
    }
    if let Stability::Unstable { min_stiffness, directions } = equilibrium.stability {
        warnings.push(Warning::Unstable { directions, min_stiffness });
    }
    warnings
}

/// Warnings about a cable model at a static state for frequencies up to `below_hz` [Hz].
pub fn of_dynamics(robot: &Robot, equilibrium: &Equilibrium, model: CableModel, below_hz: f64) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let sags: Vec<Sag> = equilibrium.cables.iter().enumerate().map(|(i, state)| Sag::of(robot, i, state)).collect();
    let states = equilibrium.cables.iter().enumerate();
    let cables: Vec<DeepSag> = states.filter_map(|(i, state)| DeepSag::of(robot, i, state, model)).collect();
    if !cables.is_empty() {
        warnings.push(Warning::DeepSag { cables, model });
    }
    if let Some(effect) = statics::drag_effect(robot, equilibrium).filter(|effect| *effect > DRAG_TURN_LIMIT) {
        warnings.push(Warning::DragTurns { effect });
    }
    let lowest = (0..sags.len()).min_by(|&i, &j| sags[i].axial_frequency_hz().total_cmp(&sags[j].axial_frequency_hz()));
    if let Some(i) = lowest {
        let axial_hz = sags[i].axial_frequency_hz();
        if model != CableModel::CatenaryDynamic && below_hz > AXIAL_PART * axial_hz {
            warnings.push(Warning::AxialWaves { cable: robot.cables[i].name.clone(), axial_hz, below_hz });
        }
    }
    warnings
}
