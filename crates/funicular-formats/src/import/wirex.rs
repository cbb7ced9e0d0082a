//! Import of WireX files (`.wcrfx`): a robot with its cables and winches.
//!
//! # References
//!
//! A. Pott, Cable-Driven Parallel Robots, Springer 2018. The attributes have the meaning that WireX itself gives
//! them (WireLib of 2019: CRobotData, CCableParameter, CWinchParameter, CStructureMatrix).

use super::draft::{
    Draft, DraftCable, DraftMotion, DraftPlatform, DraftPulley, DraftRope, DraftState, DraftWinch, listed,
};
use super::xml::{Xml, children, tag};
use anyhow::{Result, bail};
use funicular::math::{Mat3, Vec3};
use funicular_study::text::clean;
use roxmltree::Node;

/// Gravity [m/s²]. WireX files give none; WireX computes rope weights with this value.
const GRAVITY: Vec3 = Vec3::new(0.0, 0.0, -9.81);

/// Moments of inertia that WireX uses if a file has no complete tensor [kg m²].
const DEFAULT_MOMENTS: Vec3 = Vec3::new(2.0, 3.0, 4.0);

/// Centre of gravity that WireX writes for a robot whose centre is unknown [m].
const DEFAULT_CENTER: Vec3 = Vec3::new(0.0, 1.0, 0.2);

/// Radius that WireX gives pulleys of unknown size [m].
const DEFAULT_PULLEY_RADIUS: f64 = 0.1;

/// Plausible densities of a rope: mass per volume of the enclosing cylinder [kg/m³]. A loose fibre rope has 500, a
/// steel strand 6000, solid steel 7850. A value outside means that mass or diameter has another meaning.
const DENSITIES: std::ops::Range<f64> = 400.0..9000.0;

/// Reads the robot of a file.
///
/// # Errors
///
/// The line and the value at fault; or the feature of the robot that a robot file cannot hold.
pub(crate) fn read(xml: &Xml) -> Result<Draft> {
    let root = xml.root();
    let robots: Vec<Node> = children(root, "robot").collect();
    let Some(&robot) = robots.first() else {
        let old = children(root, "wireRobot").next();
        match old {
            Some(old) => {
                bail!(
                    xml.error(
                        old,
                        "<wireRobot> is the old format of WireX; open the file in WireX and save it as .wcrfx"
                    )
                )
            }
            None => bail!(xml.error(root, "<models> has no <robot>")),
        }
    };

    let mut assumed = Vec::new();
    let mut lost = Vec::new();
    if robots.len() > 1 {
        lost.push(format!("{} more robots of the file: only the first is read, as in WireX", robots.len() - 1));
    }

    let motion = motion(xml, robot)?;
    let rope = rope(xml, root, &mut assumed, &mut lost)?;
    let cables = cables(xml, root, robot, &rope, &mut assumed, &mut lost)?;
    let platform = platform(xml, robot, motion, &mut assumed)?;

    let payload = payload(xml, robot, &mut lost)?;
    if cables.iter().any(|cable| cable.winch.is_some()) {
        assumed.push(
            "that the drums are at the pulleys, and that winches are rigid: the file does not say how far the drums \
             are; `drum_side_length_m` and `stiffness_n_per_m` of [winches] give other values"
                .to_owned(),
        );
    }

    let name = clean(robot.attribute("name").unwrap_or_default());

    Ok(Draft {
        name: if name.is_empty() { xml.file().stem() } else { name },
        source: source(xml, robot),
        gravity_w: GRAVITY,
        platform,
        cables,
        state: DraftState::Unknown,
        payload,
        notes: vec![
            "The file has no pose: give ⟪pose⟫ to import or to an analysis. Gravity 9.81 m/s² along -z".to_owned(),
        ],
        assumed,
        lost,
    })
}

fn source(xml: &Xml, robot: Node) -> String {
    let mut source = format!("WireX model, {}", xml.file().name());
    for key in ["author", "description"] {
        let text = clean(robot.attribute(key).unwrap_or_default());
        if !text.is_empty() {
            source.push_str("; ");
            source.push_str(&text);
        }
    }
    source
}

fn motion(xml: &Xml, robot: Node) -> Result<DraftMotion> {
    match robot.attribute("motionpattern").map_or("3R3T", str::trim) {
        "3R3T" => Ok(DraftMotion::Rigid),
        "3T" => Ok(DraftMotion::PointMass),
        "1R2T" => Ok(DraftMotion::Planar { plane: "xy" }),
        pattern @ ("1T" | "2T" | "2R3T") => bail!(xml.error(
            robot,
            format!(
                "a robot file cannot hold the motion pattern {pattern}; it can hold 3R3T (rigid platform), 3T (point \
                 mass) and 1R2T (planar)"
            )
        )),
        other => bail!(xml.error(
            robot,
            format!("attribute `motionpattern` is `{}`; WireX knows 1T, 2T, 3T, 1R2T, 2R3T and 3R3T", clean(other))
        )),
    }
}

fn platform(xml: &Xml, robot: Node, motion: DraftMotion, assumed: &mut Vec<String>) -> Result<DraftPlatform> {
    let Some(node) = xml.optional(robot, "platform")? else {
        return Ok(DraftPlatform {
            mass: None,
            inertia_p: None,
            center_of_mass_p: None,
            motion,
            place: xml.place(robot),
        });
    };

    let mass = xml.optional_attribute_number(node, "mass")?;
    if let Some(mass) = mass.filter(|mass| *mass < 0.0) {
        bail!(xml.error(node, format!("attribute `mass` is {mass} kg, it must be positive")));
    }

    let center = xml.optional(node, "centerofgravity")?.map(|center| xml.attribute_vector(center)).transpose()?;
    let tensor = xml.optional(node, "inertiatensor")?.map(|tensor| inertia(xml, tensor)).transpose()?.flatten();

    if motion != DraftMotion::PointMass {
        if center == Some(DEFAULT_CENTER) {
            assumed.push(
                "the centre of gravity (0, 1, 0.2) m: it is in the file, but WireX writes it for robots whose centre \
                 is unknown; ⟪center_of_mass_m⟫ X,Y,Z gives another"
                    .to_owned(),
            );
        }
        if tensor.is_none() {
            assumed.push(
                "the inertia tensor diag(2, 3, 4) kg m²: the file has no complete tensor, and WireX uses this one \
                 instead. Statics does not depend on it, natural frequencies do; ⟪inertia_kg_m2⟫ XX,YY,ZZ gives another"
                    .to_owned(),
            );
        }
    }

    Ok(DraftPlatform {
        mass: mass.filter(|mass| *mass > 0.0),
        inertia_p: Some(tensor.unwrap_or(Mat3::from_diagonal(&DEFAULT_MOMENTS))),
        center_of_mass_p: center,
        motion,
        place: xml.place(node),
    })
}

/// Inertia tensor about the centre of gravity; `None` unless all nine entries are given.
fn inertia(xml: &Xml, node: Node) -> Result<Option<Mat3>> {
    let mut tensor = Mat3::zeros();
    let mut complete = true;
    for (i, row) in ["x", "y", "z"].into_iter().enumerate() {
        for (j, column) in ["x", "y", "z"].into_iter().enumerate() {
            match xml.optional_attribute_number(node, &format!("I{row}{column}"))? {
                Some(value) => tensor[(i, j)] = value,
                None => complete = false,
            }
        }
    }
    Ok(complete.then_some(tensor))
}

/// Rope of all chains: the first `<cable>` of the file, as in WireX.
fn rope(xml: &Xml, root: Node, assumed: &mut Vec<String>, lost: &mut Vec<String>) -> Result<DraftRope> {
    let all: Vec<Node> = children(root, "cable").collect();
    let Some(&node) = all.first() else { return Ok(DraftRope::default()) };

    if all.len() > 1 {
        let names: Vec<String> =
            all[1..].iter().map(|n| clean(n.attribute("name").unwrap_or("without name"))).collect();
        lost.push(format!("<cable> {}: only the first <cable> is read, for all chains, as in WireX", listed(&names)));
    }

    let quantity = |name| -> Result<Option<f64>> {
        let value = xml.optional_attribute_number(node, name)?;
        match value.filter(|value| *value < 0.0) {
            Some(value) => {
                bail!(xml.error(node, format!("attribute `{name}` of <cable> is {value}, it cannot be negative")))
            }
            None => Ok(value),
        }
    };

    let rope = DraftRope {
        name: clean(node.attribute("name").unwrap_or_default()),
        mass_per_length: quantity("weight")?,
        axial_stiffness: None,
        youngs_modulus: quantity("elasticity")?.filter(|modulus| *modulus > 0.0),
        diameter: quantity("radius")?.filter(|radius| *radius > 0.0).map(|radius| 2.0 * radius),
        breaking_load: quantity("breaking_load")?.filter(|load| *load > 0.0),
    };

    if let (Some(mass), Some(diameter)) = (rope.mass_per_length.filter(|mass| *mass > 0.0), rope.diameter) {
        let density = mass / (std::f64::consts::FRAC_PI_4 * diameter * diameter);
        if !DENSITIES.contains(&density) {
            assumed.push(format!(
                "that `radius` is the radius: with `weight` it gives a density of {density:.0} kg/m³, which no rope \
                 has; if it is the diameter, give ⟪diameter_m⟫ {}",
                diameter / 2.0
            ));
        }
    }

    for (name, what) in [
        ("damping", "a damping per length of unknown unit"),
        ("max_length", "the maximum length [m]"),
        ("min_length", "the minimum length [m]"),
    ] {
        if let Some(value) = xml.optional_attribute_number(node, name)?.filter(|value| *value != 0.0) {
            lost.push(format!("`{name}` {value} of <cable>, {what}"));
        }
    }

    Ok(rope)
}

/// Mass of the load of the application [kg].
fn payload(xml: &Xml, robot: Node, lost: &mut Vec<String>) -> Result<Option<f64>> {
    let Some(application) = children(robot, "application").next() else { return Ok(None) };
    if let Some(moment) = xml.optional_attribute_number(application, "load_moment")?.filter(|moment| *moment != 0.0) {
        lost.push(format!("`load_moment` {moment} of <application>, whose axis the file does not say"));
    }
    Ok(xml.optional_attribute_number(application, "load_mass")?.filter(|mass| *mass > 0.0))
}

/// Values of a winch that a robot file holds: the element and attribute of WireX, and the key. Zero stands for unknown.
/// Older files write the shorter names.
const WINCH_VALUES: [(&str, &str, &str); 8] = [
    ("cable", "max_velocity", "max_speed_m_s"),
    ("cable", "v", "max_speed_m_s"),
    ("cable", "max_acceleration", "max_acceleration_m_s2"),
    ("cable", "a", "max_acceleration_m_s2"),
    ("drum", "r_drum", "drum_radius_m"),
    ("motor", "gear_ratio", "gear_ratio"),
    ("motor", "inertia", "motor_inertia_kg_m2"),
    ("motor", "max_power", "max_power_w"),
];

/// Winch of a chain; `None` if the file says none of its limits.
fn winch(xml: &Xml, root: Node, chain: Node) -> Result<Option<DraftWinch>> {
    let Some(node) = winch_node(root, chain) else { return Ok(None) };
    let mut values: Vec<(&'static str, f64)> = Vec::new();
    for (element, attribute, key) in WINCH_VALUES {
        let Some(part) = children(node, element).next() else { continue };
        let Some(value) = xml.optional_attribute_number(part, attribute)?.filter(|value| *value != 0.0) else {
            continue;
        };
        if value < 0.0 {
            bail!(xml.error(part, format!("attribute `{attribute}` of <{element}> is {value}, it must be positive")));
        }
        if values.iter().all(|(known, _)| *known != key) {
            values.push((key, value));
        }
    }
    let name = clean(node.attribute("name").unwrap_or_default());
    Ok(values.iter().any(|(key, _)| key.starts_with("max_")).then_some(DraftWinch { name, values }))
}

/// Winch that a chain names.
fn winch_node<'n>(root: Node<'n, 'n>, chain: Node) -> Option<Node<'n, 'n>> {
    let kind = chain.attribute("winchtype")?;
    children(root, "winch").find(|winch| winch.attribute("name") == Some(kind))
}

/// Swivelling pulley of a `<base>`; `None` without a radius. The swivel axis is the z axis of the frame of the base,
/// and the cable enters along it. WireX counts lengths from the point of the base.
fn pulley(xml: &Xml, base: Node) -> Result<Option<DraftPulley>> {
    let Some(radius) = xml.optional_attribute_number(base, "radius")?.filter(|radius| *radius != 0.0) else {
        return Ok(None);
    };
    if radius < 0.0 {
        bail!(xml.error(base, format!("attribute `radius` of <base> is {radius} m, it must be positive")));
    }

    // Without a complete third column the frame is that of the world, as in WireX.
    let column = ["a13", "a23", "a33"].map(|name| xml.optional_attribute_number(base, name));
    let [x, y, z] = column;
    let entry_direction_w = match (x?, y?, z?) {
        (Some(x), Some(y), Some(z)) => Vec3::new(x, y, z),
        _ => Vec3::z(),
    };
    if entry_direction_w == Vec3::zeros() {
        bail!(xml.error(base, "the z axis of <base>, `a13` `a23` `a33`, has no length".to_owned()));
    }
    Ok(Some(DraftPulley { radius, entry_direction_w }))
}

fn cables(
    xml: &Xml,
    root: Node,
    robot: Node,
    rope: &DraftRope,
    assumed: &mut Vec<String>,
    lost: &mut Vec<String>,
) -> Result<Vec<DraftCable>> {
    let geometry = xml.required(robot, "geometry")?;
    let minimum = children(root, "cable").next().map(|node| xml.optional_attribute_number(node, "minimum_load"));
    let minimum = minimum.transpose()?.flatten().filter(|limit| *limit > 0.0);

    let mut cables = Vec::new();
    for chain in geometry.children().filter(Node::is_element) {
        if tag(chain) != "chain" {
            // WireX ignores it, too.
            lost.push(format!("<{}> in <geometry>, an unknown element", tag(chain)));
            continue;
        }

        let base = xml.required(chain, "base")?;
        cables.push(DraftCable {
            name: clean(chain.attribute("id").unwrap_or_default()),
            anchor_w: xml.attribute_vector(base)?,
            attachment_p: xml.attribute_vector(xml.required(chain, "platform")?)?,
            rope: rope.clone(),
            limits: [minimum, max_force(xml, root, chain)?],
            unstrained_length: None,
            pulley: pulley(xml, base)?,
            winch: winch(xml, root, chain)?,
        });
    }

    if cables.is_empty() {
        bail!(xml.error(geometry, "<geometry> has no <chain>: the robot has no cables"));
    }

    if cables.iter().any(|cable| cable.pulley.is_some_and(|pulley| pulley.radius == DEFAULT_PULLEY_RADIUS)) {
        assumed.push(format!(
            "the pulleys of radius {DEFAULT_PULLEY_RADIUS} m: the radius is in the file, but WireX writes it for \
             pulleys of unknown size; `radius_m` of [pulleys] gives another"
        ));
    }

    Ok(cables)
}

/// Maximum force of the winch of a chain [N]; `None` if the file does not give it.
fn max_force(xml: &Xml, root: Node, chain: Node) -> Result<Option<f64>> {
    let Some(winch) = winch_node(root, chain) else { return Ok(None) };
    let Some(cable) = children(winch, "cable").next() else { return Ok(None) };
    Ok(xml.optional_attribute_number(cable, "f_max")?.filter(|force| *force > 0.0))
}
