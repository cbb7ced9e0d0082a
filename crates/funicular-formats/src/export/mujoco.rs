//! Export to a model of MuJoCo (MJCF): the platform with its mass, one spatial tendon per cable, and two actuators per
//! cable, which command its unstrained length or its tension. On request a cable is a chain of bars with its mass, and
//! the tendon its last piece.
//!
//! The spring of a cable is in the actuator of its length, because the rest length of a tendon's own spring cannot be
//! commanded: the force is `k (L₀ + u − L) − c L'`, limited to tension, with the command u of zero at rest.
//!
//! A pulley is a body that swivels about its entry direction, with a cylinder that the tendon wraps. The tendon begins
//! on the swivel axis, so that it touches the wheel at the entry point. On MuJoCo's smooth cylinder it would slip
//! sideways and push the wheel away; a point of the rim that it passes holds it as the groove does.
//!
//! # References
//! XML reference of MuJoCo, <https://mujoco.readthedocs.io/en/stable/XMLreference.html>.

mod rope;

use super::chain::Chain;
use super::springs::{SpringRobot, in_plane, is_loaded};
use super::xml_text::{in_comment, names};
use super::{first_frequencies, one_line};
use anyhow::{Result, bail};
use askama::Template;
use funicular::math::{Mat3, Vec3};
use funicular::robot::{Cable, PlatformMotion, PulleyContact, Robot};
use funicular::statics::{Equilibrium, Stability};
use funicular_study::at_rest::AtRest;
use rope::ChainedRope;
use std::f64::consts::{PI, TAU};

/// Largest time step [s], and largest angle by which the fastest motion of the platform turns per step: its error is a
/// twenty-fourth of the angle's square, relative to the frequency.
const MAX_STEP_S: f64 = 1e-3;
const MAX_ANGLE_PER_STEP: f64 = 0.1;
/// Largest angle by which the fastest motion of a chain turns per step. The integration is stable up to two: it stays
/// so under sixteen times the tension.
const MAX_ANGLE_OF_CHAINS: f64 = 0.5;
/// Number of natural frequencies that the file of chains lists.
const FREQUENCIES: usize = 10;
/// Frequency of a swivel without a given inertia, over the highest one of the platform: so fast that the swivel follows
/// the platform, and slow enough for the time step.
const SWIVEL_FREQUENCY: f64 = 4.0;
/// Part of the mean tension that a cable has at least for this inertia, so that a cable that is nearly slack at rest
/// does not get a swivel that is too fast for the time step when it is taut.
const MIN_TENSION_SHARE: f64 = 0.1;
/// Smallest inertia of a swivel [kg m²], above the 1e-15 that MuJoCo refuses.
const MIN_SWIVEL_INERTIA: f64 = 1e-9;
/// Distance of the point that selects the side of the wheel from its centre, in radii.
const SIDE: f64 = 1.5;
/// Angle of the point that holds the cable in its groove, in wrap angles at rest: so near to the exit point that the
/// swivel is stable, and so far from it that the cable still reaches the point where it wraps less.
const GROOVE: f64 = 0.75;
/// Distance of this point from the rim, in radii: MuJoCo wraps nothing from a point on the rim itself. The length has
/// an error of the power 3/2 of it.
const OFF_RIM: f64 = 1e-8;
/// Size of the drawn points, and radius of drawn cables, in sizes of the platform.
const POINT_SIZE: f64 = 0.03;
const CABLE_SIZE: f64 = 0.005;

#[derive(Template)]
#[template(path = "mujoco.xml", escape = "html")]
struct MujocoModel {
    name: String,
    comment_name: String,
    comment_source: String,
    lost: Vec<String>,
    has_chains: bool,
    frequencies: String,
    step: f64,
    gravity: String,
    point_size: f64,
    cable_size: f64,
    platform: PlatformBody,
    cables: Vec<CableTendon>,
    loads: Vec<DeadForce>,
    zeros: String,
    tensions: String,
    no_lengths: String,
}

struct PlatformBody {
    position: String,
    quaternion: String,
    /// Slides and hinge of a guided platform, as attributes; a rigid platform is free.
    joints: Vec<String>,
    mass: f64,
    center: String,
    /// Attribute of the inertia tensor.
    inertia: String,
    box_center: String,
    box_half: String,
}

struct CableTendon {
    name: String,
    attachment: String,
    anchor: String,
    pulley: Option<SwivellingPulley>,
    rope: Option<ChainedRope>,
    stiffness: f64,
    /// Tendon length at which the spring has no force [m].
    rest_length: f64,
    damping: f64,
    axial_stiffness: f64,
    max_tension: f64,
    unstrained_length: f64,
    tension: f64,
}

struct SwivellingPulley {
    entry: String,
    /// Axes x (to the wheel's centre) and y (normal to the wheel).
    axes: String,
    radius: f64,
    half_width: f64,
    /// Point of the rim that the cable passes, and the sides of the wheel on which it lies before and behind.
    groove: String,
    sides: [String; 2],
    inertia: f64,
    damping: f64,
    /// Point of the tendon before the wheel, on the swivel axis, in the world.
    before: String,
}

struct DeadForce {
    at: String,
    force: String,
}

/// Writes the model of a robot at rest on straight cables; `given` is the equilibrium that it was made of.
///
/// # Errors
/// A cable that wraps half of its wheel or more.
pub(super) fn model(at_rest: &AtRest, given: &Equilibrium, warnings: &mut Vec<String>) -> Result<String> {
    written(SpringRobot::of(at_rest, given, warnings), None, warnings)
}

/// Writes the model of a robot at rest on sagging cables, each of them a chain of `pieces`.
///
/// # Errors
/// A load along a cable, a slack cable, or one that wraps half of its wheel or more.
pub(super) fn model_of_chains(at_rest: &AtRest, pieces: usize, warnings: &mut Vec<String>) -> Result<String> {
    let robot = &at_rest.robot;
    if let Some(cable) = robot.cables.iter().find(|cable| is_loaded(robot, cable)) {
        bail!(
            "cable \"{}\" has wind or another load along it, which the bars of a chain in MuJoCo do not have: leave it \
             out, or leave out ⟪cable_pieces⟫",
            cable.name
        );
    }
    let has_mass = |cable: &Cable| cable.material.mass_per_length > 0.0;
    if !robot.cables.iter().any(has_mass) {
        bail!(
            "no cable has mass, so that a chain would be one piece: leave out ⟪cable_pieces⟫, or give `mass_kg_per_m`"
        );
    }
    let chains = (0..robot.cables.len())
        .map(|i| Chain::of(robot, &at_rest.equilibrium, i, pieces))
        .collect::<Result<Vec<_>>>()?;

    let mut springs = SpringRobot::of_chains(at_rest, warnings);
    springs.lose(|cable| !has_mass(cable), "they have no mass: each is one straight piece");
    springs.lost.push(
        "waves along the ropes are left out; a winch takes in rope and lets it out without mass, in the piece at the \
         anchor"
            .to_owned(),
    );
    let listed_hz = first_frequencies(at_rest, FREQUENCIES, &mut springs.lost)?;
    written(springs, Some((&chains, listed_hz)), warnings)
}

/// Text of the model; of chains with the frequencies that it lists [Hz].
fn written(
    mut springs: SpringRobot,
    chained: Option<(&[Chain], Vec<f64>)>,
    warnings: &mut Vec<String>,
) -> Result<String> {
    if let Stability::Unstable { directions, .. } = springs.equilibrium.stability {
        let text = format!("the equilibrium is not stable in {directions} direction(s): the simulation leaves it");
        springs.lost.push(text);
    }
    let frequencies = springs.frequencies()?;
    let (chains, listed_hz) = chained.unzip();

    let mut changed = Vec::new();
    let cable_names = names("cable", springs.robot.cables.iter().map(|cable| cable.name.as_str()), &[], &mut changed);
    springs.lost.extend(changed);
    let cables = (cable_names.into_iter().enumerate())
        .map(|(i, name)| tendon(&springs, i, name, chains.map(|chains| &chains[i]), &frequencies))
        .collect::<Result<Vec<_>>>()?;
    let loads = dead_forces(&springs);

    let robot = springs.robot;
    let size = robot.platform_length().min(springs.shown_box()[1].amax() * 2.0);
    let listed = |values: &mut dyn Iterator<Item = f64>| values.map(|x| x.to_string()).collect::<Vec<_>>().join(" ");
    let zeros = |count| vec!["0"; count].join(" ");
    let text = MujocoModel {
        name: one_line(&robot.name).chars().map(|c| if c.is_control() { '_' } else { c }).collect(),
        comment_name: in_comment(&robot.name),
        comment_source: in_comment(&robot.source),
        lost: springs.lost.iter().map(|text| in_comment(text)).collect(),
        has_chains: chains.is_some(),
        step: time_step(&frequencies, &cables),
        frequencies: listed_hz
            .unwrap_or(frequencies)
            .iter()
            .map(|hz| format!("{hz:.4}"))
            .collect::<Vec<_>>()
            .join(", "),
        gravity: vector(&robot.gravity_w),
        point_size: POINT_SIZE * size,
        cable_size: CABLE_SIZE * size,
        platform: platform(&springs),
        zeros: zeros(2 * cables.len() + loads.len()),
        no_lengths: zeros(cables.len()),
        tensions: listed(&mut cables.iter().map(|cable| cable.tension).chain(loads.iter().map(|_| 0.0))),
        cables,
        loads,
    }
    .render()?;
    *warnings = springs.lost;
    Ok(text + "\n")
}

/// Time step [s] for the frequencies of the platform [Hz] and the chains.
fn time_step(frequencies: &[f64], cables: &[CableTendon]) -> f64 {
    let of_platform = MAX_ANGLE_PER_STEP / (TAU * frequencies.last().copied().unwrap_or(1.0 / MAX_STEP_S));
    let of_chains =
        cables.iter().filter_map(|cable| cable.rope.as_ref()).map(|rope| MAX_ANGLE_OF_CHAINS / rope.fastest);
    of_chains.fold(MAX_STEP_S.min(of_platform), f64::min)
}

/// Numbers of a vector with all digits.
pub(super) fn vector(of: &Vec3) -> String {
    format!("{} {} {}", of.x + 0.0, of.y + 0.0, of.z + 0.0)
}

/// Moments and products of inertia in the order of MuJoCo.
fn tensor(of: &Mat3) -> String {
    let six = [of[(0, 0)], of[(1, 1)], of[(2, 2)], of[(0, 1)], of[(0, 2)], of[(1, 2)]];
    six.map(|x| x.to_string()).join(" ")
}

fn platform(springs: &SpringRobot) -> PlatformBody {
    let (platform, pose) = (&springs.robot.platform, &springs.equilibrium.pose);
    let to_platform = pose.rot_wp.inverse();
    let slide = |axis: &Vec3| format!("type=\"slide\" axis=\"{}\"", vector(&(to_platform * axis)));
    let [box_center, box_half] = springs.shown_box();

    let (joints, inertia) = match platform.motion {
        PlatformMotion::Rigid => (Vec::new(), format!("fullinertia=\"{}\"", tensor(&platform.inertia_p))),
        PlatformMotion::PointMass => {
            // A body that does not turn needs some inertia all the same.
            let any = platform.mass * box_half.amax().powi(2);
            (
                [Vec3::x(), Vec3::y(), Vec3::z()].iter().map(slide).collect(),
                format!("diaginertia=\"{any} {any} {any}\""),
            )
        }
        PlatformMotion::Planar(plane) => {
            let normal_p = to_platform * plane.normal_w();
            let mut joints: Vec<String> = in_plane(&plane.normal_w()).iter().map(slide).collect();
            joints.push(format!("type=\"hinge\" axis=\"{}\"", vector(&normal_p)));
            // Only the moment about the normal counts; a sphere has it about every axis.
            let about = normal_p.dot(&(platform.inertia_p * normal_p));
            (joints, format!("diaginertia=\"{about} {about} {about}\""))
        }
    };

    let q = &pose.rot_wp;
    PlatformBody {
        position: vector(&pose.position_w),
        quaternion: format!("{} {} {} {}", q.w, q.i, q.j, q.k),
        joints,
        mass: platform.mass,
        center: vector(&platform.center_of_mass_p),
        inertia,
        box_center: vector(&box_center),
        box_half: vector(&box_half),
    }
}

fn tendon(
    springs: &SpringRobot,
    i: usize,
    name: String,
    chain: Option<&Chain>,
    frequencies: &[f64],
) -> Result<CableTendon> {
    let (cable, state) = (&springs.robot.cables[i], &springs.equilibrium.cables[i]);
    let whole = springs.spring(i, frequencies.first().copied());
    // A cable without mass is one bar.
    let chain = chain.filter(|chain| chain.tensions.len() > 1);
    let (rope, span, spring) = match chain {
        None => (None, state.chord(), whole),
        Some(chain) => {
            let rope = ChainedRope::of(springs, i, chain, &whole);
            let spring = rope.anchor_spring(&whole, chain);
            let span = rope.span;
            (Some(rope), span, spring)
        }
    };
    let contact = state.drive.as_ref().and_then(|drive| drive.contact);
    if contact.is_some_and(|contact| contact.wrap >= PI) {
        bail!(
            "cable \"{}\" wraps half of its wheel or more, whose swivel is then unstable: a simulation leaves this \
             state; choose another pose or another `entry_direction`",
            cable.name
        );
    }

    // The tendon begins on the swivel axis before the wheel, on the drum side if the file gives its length.
    let drum_side = cable.anchor.drum_side_length();
    let before = contact.map_or(0.0, |contact| if drum_side > 0.0 { drum_side } else { 2.0 * contact.radius });
    let length = span + contact.map_or(0.0, |contact| contact.arc()) + before;
    let rest_length = if spring.tension > 0.0 {
        length - spring.tension / spring.stiffness
    } else {
        state.unstrained_length - drum_side + before
    };

    Ok(CableTendon {
        attachment: vector(&cable.attachment_p),
        anchor: vector(&cable.anchor.point_w),
        pulley: contact.map(|contact| pulley(springs, i, &contact, before, frequencies)),
        rope,
        stiffness: spring.stiffness,
        rest_length,
        damping: spring.damping,
        axial_stiffness: cable.material.axial_stiffness,
        max_tension: cable.limits().maximum.unwrap_or(cable.material.axial_stiffness),
        unstrained_length: state.unstrained_length,
        tension: spring.tension,
        name,
    })
}

fn pulley(
    springs: &SpringRobot,
    i: usize,
    contact: &PulleyContact,
    before: f64,
    frequencies: &[f64],
) -> SwivellingPulley {
    let Robot { cables, .. } = springs.robot;
    let anchor = &cables[i].anchor;
    let given = anchor.pulley.as_ref().map_or(0.0, |pulley| pulley.swivel_inertia);

    // The cable pulls the wheel into its plane with its tension times the distance of the exit point per angle.
    let mean = springs.equilibrium.cables.iter().map(|cable| cable.tension_platform).sum::<f64>() / cables.len() as f64;
    let tension = springs.equilibrium.cables[i].tension_platform.max(MIN_TENSION_SHARE * mean);
    let righting = tension * contact.distance_from_axis();
    let fast = SWIVEL_FREQUENCY * TAU * frequencies.last().copied().unwrap_or(1.0);
    let inertia = if given > 0.0 { given } else { (righting / (fast * fast)).max(MIN_SWIVEL_INERTIA) };

    let r = contact.radius;
    // A point in the plane of the wheel, at an angle from the entry point and a distance from the centre.
    let point = |angle: f64, radii: f64| {
        let from_center = (contact.offset_w(angle) - contact.center_w * r) * radii;
        vector(&Vec3::new(r + from_center.dot(&contact.center_w), 0.0, from_center.dot(&contact.axis_w)))
    };
    let groove = GROOVE * contact.wrap;
    SwivellingPulley {
        entry: vector(&anchor.point_w),
        axes: format!("{} {}", vector(&contact.center_w), vector(&contact.sideways_w)),
        radius: r,
        half_width: 0.2 * r,
        groove: point(groove, 1.0 + OFF_RIM),
        sides: [point(0.5 * groove, SIDE), point(0.5 * (groove + contact.wrap), SIDE)],
        inertia,
        damping: 2.0 * (righting * inertia).sqrt(),
        before: vector(&(anchor.point_w - contact.axis_w * before)),
    }
}

fn dead_forces(springs: &SpringRobot) -> Vec<DeadForce> {
    let written = |(at, force): &(Vec3, Vec3)| DeadForce { at: vector(at), force: vector(force) };
    springs.dead_forces().iter().map(written).collect()
}
