//! Warnings about results outside the range of a model or a limit: each names the cable, the value, the limit and a
//! remedy.

pub mod plausibility;

use plausibility::Implausible;

use crate::cable::catenary_dynamic::CatenaryDynamic;
use crate::cable::shallow_dynamic::ShallowDynamic;
use crate::cable::{CableModel, LocalAxes, SHALLOW_SAG_LIMIT, Sag, shallow_static};
use crate::clearance::{Clearance, ClearancePair, Surroundings};
use crate::robot::{Cable, Pose, Robot, RopeSection};
use crate::statics::{self, CableState, Equilibrium, Limit, Stability, StaticModel, TensionRange};
use std::f64::consts::TAU;
use std::fmt;

/// Caveat that the user should know before using a result.
#[derive(Debug, Clone, PartialEq)]
pub enum Warning {
    /// A value that no usual robot has.
    Implausible(Implausible),
    /// A cable carries no force.
    Slack {
        /// Name of the cable.
        cable: String,
    },
    /// A cable wraps more than half around its pulley.
    Wrap {
        /// Name of the cable.
        cable: String,
        /// Wrap angle [degrees].
        wrap_deg: f64,
    },
    /// A cable would have to push at its entry point to the pulley.
    SlackAtDrum {
        /// Name of the cable.
        cable: String,
        /// Tension at the drum [N], negative.
        tension: f64,
    },
    /// A tension is above the breaking load of the rope.
    Breaks {
        /// Name of the cable.
        cable: String,
        /// Maximum tension of the cable [N].
        tension: f64,
        /// Breaking load of the rope [N].
        breaking_load: f64,
    },
    /// A tension is beyond a limit of the robot file.
    BeyondLimit {
        /// Name of the cable.
        cable: String,
        /// Minimum or maximum tension of the cable [N].
        tension: f64,
        /// Limit that is violated.
        limit: Limit,
        /// Value of the limit [N].
        value: f64,
    },
    /// Cables, platform and obstacles are nearer to each other than the file allows.
    Interference {
        /// Nearest pair in words.
        pair: String,
        /// Distance between its surfaces [m].
        distance: f64,
        /// Required distance [m].
        required: f64,
    },
    /// Cables cross each other.
    Crossing {
        /// Pairs of cables by their names.
        pairs: Vec<[String; 2]>,
    },
    /// Distances of ropes count, but the file gives no diameter of some.
    NoDiameter {
        /// Names of the ropes.
        ropes: Vec<String>,
    },
    /// Distances of ropes count, but the file gives only the cross-section of the metal of some.
    MetalDiameter {
        /// Names of the ropes, each with the diameter of a circle of this area [m].
        ropes: Vec<(String, f64)>,
    },
    /// There is wind, but the file gives no drag coefficient of some ropes.
    NoDrag {
        /// Names of the ropes.
        ropes: Vec<String>,
    },
    /// The pose is near a singular pose, at which the cables cannot resist a force in some direction.
    NearlySingular {
        /// Largest tension needed per unit wrench, [`crate::statics::tension_gain`]; infinite at a singular pose.
        gain: f64,
    },
    /// The equilibrium is not stable.
    Unstable {
        /// Number of directions without a restoring force.
        directions: usize,
        /// Minimum eigenvalue of the scaled stiffness [N/m].
        min_stiffness: f64,
    },
    /// The cables, fewer than the degrees of freedom, cannot hold the requested pose.
    Elsewhere {
        /// Number of cables.
        cables: usize,
        /// Number of degrees of freedom of the platform.
        dof: usize,
        /// Distance of the platform from the requested position [m].
        translation: f64,
        /// Angle between the platform and the requested orientation [degrees].
        turn_deg: f64,
        /// Distance from the requested pose, translation and rotation together [m], [`crate::statics::pose_distance`].
        distance: f64,
    },
    /// No number of the robot file damps vibration.
    NoDamping,
    /// Cables sag deeper than a shallow-sag model allows.
    DeepSag {
        /// Cables that sag too deep, in the order of the file.
        cables: Vec<DeepSag>,
        /// Shallow-sag model.
        model: CableModel,
    },
    /// The drag of the wind turns with the cables, which the symmetric stiffness of vibration leaves out.
    DragTurns {
        /// Maximum relative change of the static displacement under a small load, [`crate::statics::drag_effect`].
        effect: f64,
    },
    /// Frequencies are near a cable's first axial resonance, which the model leaves out.
    AxialWaves {
        /// Name of the cable with the lowest axial frequency.
        cable: String,
        /// First axial frequency [Hz].
        axial_hz: f64,
        /// Highest requested frequency [Hz].
        below_hz: f64,
    },
}

/// Cable that sags deeper than a shallow-sag model allows.
#[derive(Debug, Clone, PartialEq)]
pub struct DeepSag {
    /// Name of the cable.
    pub cable: String,
    /// Ratio of sag to chord.
    pub ratio: f64,
    /// Relative error of the model at this cable: of the first clamped frequency in plane against the catenary-dynamic
    /// model, or of the static stiffness along the chord against the catenary. `None` if the comparison is not
    /// possible.
    pub error: Option<f64>,
}

impl DeepSag {
    /// Sag and error of cable `i` at an equilibrium, if it sags too deep for the model.
    pub fn of(robot: &Robot, i: usize, state: &CableState, model: CableModel) -> Option<Self> {
        let sag = Sag::of(robot, i, state);
        (model.is_shallow() && sag.tension > 0.0 && sag.ratio() > SHALLOW_SAG_LIMIT).then(|| Self {
            cable: robot.cables[i].name.clone(),
            ratio: sag.ratio(),
            error: measured(robot, i, state, sag, model),
        })
    }
}

/// Relative error of a shallow-sag model at one cable.
fn measured(robot: &Robot, i: usize, state: &CableState, sag: Sag, model: CableModel) -> Option<f64> {
    let hanging = state.hanging.as_ref().filter(|hanging| hanging.catenary.rope().weight_per_length > 0.0)?;
    if !model.is_dynamic() {
        let e = hanging.chord_w().normalize();
        return Some(shallow_static::stiffness(&sag).axial / e.dot(&(hanging.tangent_w() * e)) - 1.0);
    }
    let m = robot.cables[i].material.mass_per_length;
    let axes = LocalAxes::of_cable(robot, i, state);

    // The first frequency of the sagging string lies below the third of the straight one.
    let highest = TAU * 3.0 * sag.string_frequency_hz();
    let shallow = ShallowDynamic::new(sag, axes, robot.cables[i].material.damping, true);
    let first = *shallow.clamped_frequencies_below(highest).first()?;
    let catenary = CatenaryDynamic::new(&hanging.catenary, m, highest).ok()?;
    Some(first / catenary.in_plane.poles.first()?.sqrt() - 1.0)
}

/// Tension per unit wrench above which a pose counts as nearly singular: ten times the largest value at the poses of
/// the library's robots, which have 0.9 to 3.1. Eight cables with an inverse condition of 0.005, whose platform turns
/// at 0.2 Hz, have about 100.
const SINGULAR_GAIN: f64 = 30.0;

/// Relative change of static displacements above which the turning drag causes a warning; a drag coefficient is hardly
/// known to one per cent.
pub const DRAG_TURN_LIMIT: f64 = 0.01;

/// Fraction of the first axial frequency above which axial inertia causes a warning. The axial stiffness of a taut
/// cable is `φ cot φ` times the static one. At this frequency φ = π/3, so that the static one is two thirds too stiff;
/// at a third of it the error is 4 %.
const AXIAL_FRACTION: f64 = 1.0 / 3.0;

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Implausible(value) => write!(f, "{value}"),
            Self::Slack { cable } => write!(
                f,
                "cable \"{cable}\" is slack: it carries no force and does not help to hold the platform; shorten it or \
                 choose the static model `catenary`, which includes its weight"
            ),
            Self::Wrap { cable, wrap_deg } => write!(
                f,
                "cable \"{cable}\" wraps {wrap_deg:.1}° around its pulley: beyond 180° the swivel is unstable, and the \
                 wheel turns away from the cable; choose another pose, or another `entry_direction`"
            ),
            Self::SlackAtDrum { cable, tension } => write!(
                f,
                "cable \"{cable}\" has a tension of {tension:.2} N at its drum: it would lift off its pulley; raise \
                 the tension"
            ),
            Self::Breaks { cable, tension, breaking_load } => write!(
                f,
                "cable \"{cable}\" has a tension of {tension:.1} N, but its rope breaks at {breaking_load} N: choose a \
                 stronger rope, another pose or less load"
            ),
            Self::BeyondLimit { cable, tension, limit, value } => {
                f.write_str(&beyond_limit(cable, *tension, *limit, *value))
            }
            Self::Interference { pair, distance, required } => f.write_str(&too_near(pair, *distance, *required)),
            Self::Crossing { pairs } => {
                let pairs: Vec<String> =
                    pairs.iter().map(|[one, other]| format!("\"{one}\" and \"{other}\"")).collect();
                write!(
                    f,
                    "cables {} cross: their ropes touch at this pose; choose other attachments or anchors, for example \
                     the upper and the lower cable of a corner to different sides of the platform; `clearance` shows \
                     all distances",
                    pairs.join(", ")
                )
            }
            Self::NoDiameter { ropes } => write!(
                f,
                "cables of {} have no diameter, so that their distances are those of their centre lines: give \
                 `drag_diameter_m` with a `drag_coefficient`, or `diameter_m` with `youngs_modulus_pa`",
                quoted(ropes)
            ),
            Self::MetalDiameter { ropes } => {
                let with_diameter = |(rope, diameter): &(String, f64)| format!("\"{rope}\" ({:.2} mm)", 1e3 * diameter);
                write!(
                    f,
                    "distances of cables of {} are those of a circle with `area_m2`; the metal of a wire rope fills \
                     half to two thirds of its circle: give its outer diameter as `drag_diameter_m` with a \
                     `drag_coefficient`",
                    ropes.iter().map(with_diameter).collect::<Vec<_>>().join(", ")
                )
            }
            Self::NoDrag { ropes } => write!(
                f,
                "the wind does not act on cables of {}: give a `drag_coefficient` in the robot file (a round rope has \
                 1.0 to 1.2), or 0 for none",
                quoted(ropes)
            ),
            Self::NearlySingular { gain } => f.write_str(&nearly_singular(*gain)),
            Self::Unstable { directions, min_stiffness } => f.write_str(&unstable(*directions, *min_stiffness)),
            Self::Elsewhere { cables, dof, translation, turn_deg, distance } => write!(
                f,
                "{} for {dof} degrees of freedom cannot hold the requested pose with any lengths: this is the nearest \
                 pose that they can hold, {:.3} mm and {turn_deg:.4}° away (nearest_pose_distance_m {distance:.6})",
                crate::counted(*cables, "cable"),
                1e3 * translation
            ),
            Self::NoDamping => f.write_str(
                "nothing in the robot file damps vibration: damping ratios are zero, and responses have no bound at \
                 their resonances; give the ropes a `damping_ratio` (wire rope has about 0.003) and an \
                 `axial_loss_factor`, or the platform `translational_damping_n_s_m`",
            ),
            Self::DeepSag { cables, model } => f.write_str(&too_deep(cables, *model)),
            Self::DragTurns { effect } => write!(
                f,
                "the drag of the wind turns with the cables and changes the static displacement under a small load by \
                 up to {:.1} % (rotations times the platform's size); the symmetric stiffness used here leaves this \
                 out: take static displacements from `stiffness` at 0 Hz without a cable model, which includes it",
                100.0 * effect
            ),
            Self::AxialWaves { cable, axial_hz, below_hz } => write!(
                f,
                "{below_hz} Hz is more than a third of the first axial frequency {axial_hz:.1} Hz of cable \
                 \"{cable}\": axial waves, which this model leaves out, matter there; lower the limit, or use the \
                 cable model `catenary-dynamic`"
            ),
        }
    }
}

/// Names in quotes, with commas.
fn quoted(names: &[String]) -> String {
    names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ")
}

/// Text about a tension beyond a limit of the file.
fn beyond_limit(cable: &str, tension: f64, limit: Limit, value: f64) -> String {
    let (range, side, name) = match limit {
        Limit::Minimum => ("only", "below", "minimum_tension_n"),
        Limit::Maximum => ("up to", "above", "maximum_tension_n"),
    };
    format!(
        "cable \"{cable}\" has a tension of {range} {tension:.1} N, {side} its `{name}` of {value} N: choose another \
         pose, load or lengths, or another limit"
    )
}

/// Distance below which four decimals show a zero [m].
const LEAST_SHOWN: f64 = 5e-5;

/// Text about things that are too near to each other.
fn too_near(pair: &str, distance: f64, required: f64) -> String {
    let apart = if distance >= LEAST_SHOWN {
        format!("are {distance:.4} m apart, {required} m are required")
    } else if distance <= -LEAST_SHOWN {
        format!("touch and overlap by {:.4} m", -distance)
    } else {
        "touch".to_owned()
    };
    format!("{pair} {apart}: choose another pose, or other attachments and anchors; `clearance` shows all pairs")
}

/// Text about a pose at or near a singular one.
fn nearly_singular(gain: f64) -> String {
    if gain.is_infinite() {
        return "the pose is singular: in some direction the cables cannot resist a force; choose a pose from which the \
                cables pull in more directions"
            .to_owned();
    }
    format!(
        "the pose is nearly singular: in its weakest direction a force of 1 N needs {gain:.0} N of tension (limit \
         {SINGULAR_GAIN} N); choose a pose from which the cables pull in more directions"
    )
}

/// Text about an equilibrium that is indifferent or not stable.
fn unstable(directions: usize, min_stiffness: f64) -> String {
    let directions = crate::counted(directions, "direction");
    if min_stiffness == 0.0 {
        return format!(
            "the equilibrium is indifferent: in {directions} nothing holds the platform, and its natural frequency \
             there is zero; add a cable, or another attachment point"
        );
    }
    format!(
        "the equilibrium is not stable: {directions} without a restoring force (minimum scaled stiffness \
         {min_stiffness:.3e} N/m); the robot would leave this pose"
    )
}

/// Text about cables that sag too deep for a model.
fn too_deep(cables: &[DeepSag], model: CableModel) -> String {
    let what = if model.is_dynamic() { "first frequency" } else { "stiffness along the chord" };
    let one = |DeepSag { cable, ratio, error }: &DeepSag| {
        let error = error.map_or(String::new(), |error| format!(" ({what} off by {:+.1} %)", 100.0 * error));
        format!("\"{cable}\" sags by {ratio:.4} of its chord{error}")
    };
    format!(
        "cable {}, the limit is 1/20: the {model} model is outside its range; use the model `catenary-dynamic`, or \
         raise the tension",
        cables.iter().map(one).collect::<Vec<_>>().join(", ")
    )
}

/// Warning about cable `i` beyond the breaking load of its rope or beyond a limit of the file; only the most serious
/// one.
pub fn of_tension(robot: &Robot, equilibrium: &Equilibrium, i: usize) -> Option<Warning> {
    let state = &equilibrium.cables[i];
    let margin = TensionRange::of(robot, i, &state.chord_w()).margin(state);
    let (cable, limits) = (&robot.cables[i], robot.cables[i].limits());
    let name = cable.name.clone();
    if let Some(breaking_load) = cable.material.breaking_load.filter(|load| margin.max > *load * (1.0 + 1e-6)) {
        return Some(Warning::Breaks { cable: name, tension: margin.max, breaking_load });
    }
    // The tolerance of a millionth is the accuracy of the tensions.
    if let Some(value) = limits.maximum.filter(|max| margin.max > *max * (1.0 + 1e-6)) {
        return Some(Warning::BeyondLimit { cable: name, tension: margin.max, limit: Limit::Maximum, value });
    }
    let value = limits.minimum.filter(|min| margin.min < *min * (1.0 - 1e-6))?;
    Some(Warning::BeyondLimit { cable: name, tension: margin.min, limit: Limit::Minimum, value })
}

/// Warning about the place of a cable on its pulley.
fn of_drive(cable: &Cable, state: &CableState) -> Option<Warning> {
    let drive = state.drive.as_deref()?;
    let name = cable.name.clone();
    if drive.tension_drum < 0.0 {
        return Some(Warning::SlackAtDrum { cable: name, tension: drive.tension_drum });
    }
    let wrap = drive.contact.map(|contact| contact.wrap).filter(|wrap| *wrap > std::f64::consts::PI)?;
    Some(Warning::Wrap { cable: name, wrap_deg: wrap.to_degrees() })
}

/// Maximum distance from the requested pose, over the size of the platform, at which the pose counts as reached; the
/// error of forward statics is smaller.
const HELD: f64 = 1e-7;

/// Warning that an equilibrium is not at the requested pose, but at the nearest pose that the cables can hold
/// ([`Solution::requested_pose`](crate::statics::Solution::requested_pose)).
pub fn of_pose(robot: &Robot, equilibrium: &Equilibrium, requested: &Pose, distance: f64) -> Option<Warning> {
    let found = &equilibrium.pose;
    (distance > HELD * robot.platform_length()).then(|| Warning::Elsewhere {
        cables: robot.cables.len(),
        dof: robot.platform.motion.count(),
        translation: (found.position_w - requested.position_w).norm(),
        turn_deg: found.rot_wp.angle_to(&requested.rot_wp).to_degrees(),
        distance,
    })
}

/// Warnings about the values of a robot that no usual robot has; mostly slips of a unit or of a sign
/// ([`plausibility::of_robot`]).
pub fn of_robot(robot: &Robot) -> Vec<Warning> {
    plausibility::of_robot(robot).into_iter().map(Warning::Implausible).collect()
}

/// Warning about a robot file without any damping, for results of vibration.
pub fn of_damping(robot: &Robot) -> Option<Warning> {
    (!robot.is_damped()).then_some(Warning::NoDamping)
}

/// Warnings about values of an equilibrium that no usual robot has ([`plausibility::of_equilibrium`]).
pub fn of_plausibility(robot: &Robot, equilibrium: &Equilibrium) -> Vec<Warning> {
    plausibility::of_equilibrium(robot, equilibrium).into_iter().map(Warning::Implausible).collect()
}

/// Warnings about an equilibrium.
pub fn of_statics(robot: &Robot, equilibrium: &Equilibrium) -> Vec<Warning> {
    let mut warnings = Vec::new();

    // Tensions of the cables.
    for (i, state) in equilibrium.cables.iter().enumerate() {
        warnings.extend(of_slack(robot, equilibrium, i));
        warnings.extend(of_drive(&robot.cables[i], state));
        warnings.extend(of_tension(robot, equilibrium, i));
    }

    warnings.extend(of_crossings(robot, equilibrium));
    warnings.extend(of_clearance(robot, equilibrium));
    warnings.extend(of_diameters(robot));

    // Wind on ropes without a drag coefficient.
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

    // Singularity and stability.
    if statics::tension_gain_exceeds(robot, equilibrium, SINGULAR_GAIN)
        && let Some(gain) = statics::tension_gain(robot, equilibrium)
    {
        warnings.push(Warning::NearlySingular { gain });
    }
    warnings.extend(of_stability(equilibrium));
    warnings
}

/// Warning about an equilibrium that is not stable.
pub fn of_stability(equilibrium: &Equilibrium) -> Option<Warning> {
    let Stability::Unstable { min_stiffness, directions } = equilibrium.stability else { return None };
    Some(Warning::Unstable { directions, min_stiffness })
}

/// Warning that cables cross at an equilibrium, also for a robot whose file says nothing about distances.
pub fn of_crossings(robot: &Robot, equilibrium: &Equilibrium) -> Option<Warning> {
    crossing(robot, &Surroundings::of(robot).crossing_cables(equilibrium))
}

/// Warning that cables cross at a pose if they are straight, for a pose without an equilibrium.
pub fn of_crossing_chords(robot: &Robot, pose: &Pose) -> Option<Warning> {
    crossing(robot, &Surroundings::of(robot).crossing_chords(pose))
}

fn crossing(robot: &Robot, touching: &[Clearance]) -> Option<Warning> {
    let name = |i: usize| robot.cables[i].name.clone();
    // Falls of one rope lie beside each other on its sheaves.
    let is_one_rope =
        |i: usize, j: usize| robot.ropes.iter().any(|rope| [i, j].iter().all(|k| rope.cables.contains(k)));
    let pairs = touching.iter().filter_map(|of| match of.pair {
        ClearancePair::Cables(i, j) if !is_one_rope(i, j) => Some([name(i), name(j)]),
        _ => None,
    });
    let pairs: Vec<[String; 2]> = pairs.collect();
    (!pairs.is_empty()).then_some(Warning::Crossing { pairs })
}

/// Warning that cables, platform and obstacles are nearer to each other than the file allows. A file that says nothing
/// about distances is not judged.
fn of_clearance(robot: &Robot, equilibrium: &Equilibrium) -> Option<Warning> {
    if !robot.judges_clearance() {
        return None;
    }
    let around = Surroundings::of(robot);
    let least = around.least(equilibrium, None)?;
    // Cables that touch have a warning of their own.
    if matches!(least.pair, ClearancePair::Cables(..)) && least.touches() {
        return None;
    }
    of_nearest(&around.pair_text(least.pair), &least)
}

/// Warnings about ropes whose diameters the file does not give, where distances count.
fn of_diameters(robot: &Robot) -> Vec<Warning> {
    if !robot.judges_clearance() {
        return Vec::new();
    }
    let (mut none, mut metal): (Vec<String>, Vec<(String, f64)>) = Default::default();
    for cable in &robot.cables {
        let (rope, name) = (&cable.material.dimensions, &cable.material.name);
        if rope.drag_diameter.is_some() {
            continue;
        }
        match rope.section {
            Some(RopeSection::Area(_)) if !metal.iter().any(|(known, _)| known == name) => {
                metal.push((name.clone(), 2.0 * cable.radius()));
            }
            None if !none.contains(name) => none.push(name.clone()),
            _ => {}
        }
    }
    let none = (!none.is_empty()).then_some(Warning::NoDiameter { ropes: none });
    let metal = (!metal.is_empty()).then_some(Warning::MetalDiameter { ropes: metal });
    none.into_iter().chain(metal).collect()
}

/// Warning about the nearest pair, in words, if it is nearer than required.
pub fn of_nearest(pair: &str, least: &Clearance) -> Option<Warning> {
    let Clearance { distance, required, .. } = *least;
    (!least.is_kept()).then(|| Warning::Interference { pair: pair.to_owned(), distance, required })
}

/// Warnings about a cable model at an equilibrium for frequencies up to `below_hz` [Hz].
pub fn of_dynamics(robot: &Robot, equilibrium: &Equilibrium, model: CableModel, below_hz: f64) -> Vec<Warning> {
    let cables: Vec<usize> = (0..equilibrium.cables.len()).collect();
    let turns = statics::drag_effect(robot, equilibrium).filter(|effect| *effect > DRAG_TURN_LIMIT);

    let mut warnings = Vec::new();
    warnings.extend(deep_sag(robot, equilibrium, &cables, model));
    warnings.extend(turns.map(|effect| Warning::DragTurns { effect }));
    warnings.extend(axial_waves(robot, equilibrium, &cables, model, below_hz));
    warnings
}

/// Warnings about cable `i` alone, with a cable model for frequencies up to `below_hz` [Hz]: the cable is slack, sags
/// beyond the range of the model, or has axial waves that the model leaves out.
pub fn of_cable(robot: &Robot, equilibrium: &Equilibrium, i: usize, model: CableModel, below_hz: f64) -> Vec<Warning> {
    let mut warnings = Vec::new();
    warnings.extend(of_slack(robot, equilibrium, i));
    warnings.extend(deep_sag(robot, equilibrium, &[i], model));
    warnings.extend(axial_waves(robot, equilibrium, &[i], model, below_hz));
    warnings
}

/// Warning that cable `i` is slack. Ideal cables have no weight that could keep them taut, and no warning.
pub fn of_slack(robot: &Robot, equilibrium: &Equilibrium, i: usize) -> Option<Warning> {
    let warned = equilibrium.model != StaticModel::Ideal && equilibrium.cables[i].is_slack();
    warned.then(|| Warning::Slack { cable: robot.cables[i].name.clone() })
}

/// Warning about those of the given cables that sag beyond the range of the model.
fn deep_sag(robot: &Robot, equilibrium: &Equilibrium, cables: &[usize], model: CableModel) -> Option<Warning> {
    let cables: Vec<DeepSag> =
        cables.iter().filter_map(|&i| DeepSag::of(robot, i, &equilibrium.cables[i], model)).collect();
    (!cables.is_empty()).then_some(Warning::DeepSag { cables, model })
}

/// Warning about axial waves in the one of the given cables that has the lowest first axial frequency.
fn axial_waves(
    robot: &Robot,
    equilibrium: &Equilibrium,
    cables: &[usize],
    model: CableModel,
    below_hz: f64,
) -> Option<Warning> {
    let frequencies = cables.iter().map(|&i| (i, Sag::of(robot, i, &equilibrium.cables[i]).axial_frequency_hz()));
    let (i, axial_hz) = frequencies.min_by(|(_, one), (_, other)| one.total_cmp(other))?;
    let matter = !model.entry().has_axial_waves && below_hz > AXIAL_FRACTION * axial_hz;
    matter.then(|| Warning::AxialWaves { cable: robot.cables[i].name.clone(), axial_hz, below_hz })
}
