//! Import of URDF: a robot of links whose cables are pairs of links, `anchor_NAME` on the frame and `attachment_NAME`
//! on the platform. URDF has no cables and no loops, so that it cannot say more about them.
//!
//! # References
//! URDF, <https://wiki.ros.org/urdf/XML>.

use super::draft::{Draft, DraftMotion, DraftPlatform, DraftState};
use super::frames::{MassOfBody, attribute_vec, compose, identity, turned};
use super::pairs::{self, PointOfPair};
use super::xml::{Xml, children, tag};
use anyhow::{Result, bail};
use funicular::math::{Mat3, Rotation, Vec3};
use funicular::robot::Pose;
use funicular_study::text::clean;
use roxmltree::Node;

/// Gravity [m/s²]. URDF files give none.
const GRAVITY: Vec3 = Vec3::new(0.0, 0.0, -9.81);
/// Links from the root to the last one.
const MAX_CHAIN: usize = 50;

/// Joint of the tree.
struct UrdfJoint<'n> {
    node: Node<'n, 'n>,
    kind: &'n str,
    parent: &'n str,
    child: &'n str,
    origin: Pose,
}

/// Reads the robot of a file.
///
/// # Errors
/// The line and the value at fault; or the feature of the robot that a robot file cannot hold.
pub(crate) fn read<'n>(xml: &'n Xml<'n>) -> Result<Draft> {
    let root: Node<'n, 'n> = xml.root();
    let joints = children(root, "joint").map(|node| joint(xml, node)).collect::<Result<Vec<_>>>()?;
    let link = |name: &str| children(root, "link").find(|link| link.attribute("name") == Some(name));

    let moving: Vec<&UrdfJoint> = joints.iter().filter(|joint| matches!(joint.kind, "floating" | "planar")).collect();
    let carrying = match moving[..] {
        [] => bail!(xml.error(
            root,
            "no joint is floating or planar: URDF describes a platform on cables as the child of such a joint"
        )),
        [only] => only,
        [_, second, ..] => {
            bail!(xml.error(second.node, "a second joint is floating or planar; a robot file has one platform"))
        }
    };
    let Some(platform) = link(carrying.child) else {
        bail!(xml.error(carrying.node, format!("the link `{}` is not there", clean(carrying.child))));
    };
    let pose = compose(&pose_of_link(xml, &joints, carrying.parent, None)?, &carrying.origin);
    let motion = motion(xml, carrying, &pose)?;

    let points = points(xml, &joints, carrying)?;
    let cables = pairs::cables(&points).map_err(|message| xml.error(root, message))?;
    if cables.is_empty() {
        bail!(xml.error(
            root,
            "the robot has no cables: no pairs of links `anchor_NAME` on the frame and `attachment_NAME` on the \
             platform"
        ));
    }

    let mass = mass(xml, platform)?;
    let name = clean(root.attribute("name").unwrap_or_default());
    Ok(Draft {
        name: if name.is_empty() { xml.file().stem() } else { name },
        source: format!("URDF, {}", xml.file().name()),
        gravity_w: GRAVITY,
        platform: DraftPlatform {
            mass: mass.map(|mass| mass.mass),
            inertia_p: mass.and_then(|mass| mass.inertia),
            center_of_mass_p: mass.map(|mass| mass.center),
            motion,
            place: xml.place(platform),
        },
        cables,
        state: DraftState::Pose(pose),
        payload: None,
        notes: vec![
            "Platform frame: that of the link. Pose: the origin of its joint. Gravity 9.81 m/s² along -z".to_owned(),
        ],
        assumed: Vec::new(),
        lost: lost(root),
    })
}

/// Elements that describe neither links nor joints.
fn lost(root: Node) -> Vec<String> {
    let others = root.children().filter(|of| of.is_element() && !matches!(tag(*of), "link" | "joint" | "material"));
    let name = |of: Node| of.attribute("name").map(|name| format!(" `{}`", clean(name))).unwrap_or_default();
    others.map(|of| format!("<{}>{}", clean(tag(of)), name(of))).collect()
}

fn joint<'n>(xml: &'n Xml<'n>, node: Node<'n, 'n>) -> Result<UrdfJoint<'n>> {
    let end = |name: &str| xml.attribute(xml.required(node, name)?, "link");
    Ok(UrdfJoint {
        node,
        kind: xml.attribute(node, "type")?,
        parent: end("parent")?,
        child: end("child")?,
        origin: origin(xml, node)?,
    })
}

/// Pose in the element `<origin>`; R = Rz Ry Rx.
fn origin(xml: &Xml, node: Node) -> Result<Pose> {
    let Some(origin) = xml.optional(node, "origin")? else { return Ok(identity()) };
    let angles = attribute_vec(xml, origin, "rpy")?.unwrap_or_default();
    Ok(Pose {
        position_w: attribute_vec(xml, origin, "xyz")?.unwrap_or_default(),
        rot_wp: Rotation::from_euler_angles(angles.x, angles.y, angles.z),
    })
}

/// Pose of a link in the frame of the root or, within the platform, of the platform.
fn pose_of_link(xml: &Xml, joints: &[UrdfJoint], link: &str, platform: Option<&str>) -> Result<Pose> {
    let mut pose = identity();
    let mut at = link;
    for _ in 0..MAX_CHAIN {
        if Some(at) == platform {
            return Ok(pose);
        }
        let Some(joint) = joints.iter().find(|joint| joint.child == at) else { return Ok(pose) };
        if joint.kind != "fixed" {
            bail!(xml.error(
                joint.node,
                format!("the joint is `{}`; beside the platform's own all joints must be fixed", clean(joint.kind))
            ));
        }
        pose = compose(&joint.origin, &pose);
        at = joint.parent;
    }
    bail!(xml.error(xml.root(), format!("the link `{}` is its own ancestor", clean(link))))
}

/// Named links on the frame and on the platform.
fn points(xml: &Xml, joints: &[UrdfJoint], carrying: &UrdfJoint) -> Result<Vec<PointOfPair>> {
    let mut points = Vec::new();
    for joint in joints.iter().filter(|joint| joint.child != carrying.child) {
        if !["anchor", "attachment"].iter().any(|word| joint.child.starts_with(word)) {
            continue;
        }
        let is_on_platform = is_under(joints, joint.child, carrying.child);
        let pose = pose_of_link(xml, joints, joint.child, is_on_platform.then_some(carrying.child))?;
        points.push(PointOfPair { name: joint.child.to_owned(), position: pose.position_w, is_on_platform });
    }
    Ok(points)
}

/// True if a link hangs on another one.
fn is_under(joints: &[UrdfJoint], link: &str, top: &str) -> bool {
    let mut at = link;
    for _ in 0..MAX_CHAIN {
        if at == top {
            return true;
        }
        let Some(joint) = joints.iter().find(|joint| joint.child == at) else { return false };
        at = joint.parent;
    }
    false
}

/// Motion of the platform. The axis of a planar joint is normal to its plane.
fn motion(xml: &Xml, joint: &UrdfJoint, pose: &Pose) -> Result<DraftMotion> {
    if joint.kind == "floating" {
        return Ok(DraftMotion::Rigid);
    }
    let axis = match xml.optional(joint.node, "axis")? {
        Some(axis) => attribute_vec(xml, axis, "xyz")?,
        None => None,
    };
    DraftMotion::with_normal(&(pose.rot_wp * axis.unwrap_or_else(Vec3::x)))
        .ok_or_else(|| xml.error(joint.node, "the plane of the planar joint is not a coordinate plane, xy, xz or yz"))
}

/// Mass of a link in its frame; `None` if the file has none.
fn mass(xml: &Xml, link: Node) -> Result<Option<MassOfBody>> {
    let Some(inertial) = xml.optional(link, "inertial")? else { return Ok(None) };
    let Some(node) = xml.optional(inertial, "mass")? else { return Ok(None) };
    let mass = xml.optional_attribute_number(node, "value")?.unwrap_or_default();
    if mass <= 0.0 {
        bail!(xml.error(node, format!("the mass is {mass} kg, it must be positive")));
    }
    let pose = origin(xml, inertial)?;
    let inertia = match xml.optional(inertial, "inertia")? {
        Some(node) => {
            let of = |name: &str| -> Result<f64> { Ok(xml.optional_attribute_number(node, name)?.unwrap_or_default()) };
            let [xx, yy, zz] = [of("ixx")?, of("iyy")?, of("izz")?];
            let [xy, xz, yz] = [of("ixy")?, of("ixz")?, of("iyz")?];
            Some(turned(&Mat3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz), &pose.rot_wp))
        }
        None => None,
    };
    Ok(Some(MassOfBody { mass, center: pose.position_w, inertia }))
}
