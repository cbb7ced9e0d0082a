//! Links, joints and frames of a model of SDF, with their poses in the world.

use crate::import::frames::{MassOfBody, compose, identity, turned};
use crate::import::text;
use crate::import::xml::{Xml, children, content, tag};
use anyhow::{Result, bail};
use funicular::math::{Mat3, Quaternion, Rotation, Vec3};
use funicular::robot::Pose;
use funicular_study::text::clean;
use roxmltree::Node;

/// Names that the frame of a robot has where no joint fixes it to the world.
const FRAME_NAMES: [&str; 4] = ["world", "frame", "base", "base_link"];
/// Frames that stand within one another.
const MAX_CHAIN: usize = 50;

/// Link, joint or frame of a model.
pub(super) struct SdfFrame<'n> {
    pub(super) name: String,
    pub(super) node: Node<'n, 'n>,
    pub(super) pose: Pose,
}

/// Joint between two links.
pub(super) struct SdfJoint {
    pub(super) name: String,
    pub(super) kind: String,
    pub(super) parent: String,
    pub(super) child: String,
    /// Place of the joint in the world [m].
    pub(super) position_w: Vec3,
}

/// Model with its platform.
pub(super) struct SdfModel<'n> {
    pub(super) xml: &'n Xml<'n>,
    pub(super) node: Node<'n, 'n>,
    pub(super) links: Vec<SdfFrame<'n>>,
    pub(super) joints: Vec<SdfJoint>,
    pub(super) frames: Vec<SdfFrame<'n>>,
    pub(super) platform: SdfFrame<'n>,
    fixed: Vec<String>,
}

impl<'n> SdfModel<'n> {
    /// True if a model has a link that is called platform.
    pub(super) fn has_platform(model: Node) -> bool {
        children(model, "link").any(|link| link.attribute("name") == Some("platform"))
    }

    pub(super) fn read(xml: &'n Xml<'n>, node: Node<'n, 'n>) -> Result<Self> {
        let all: Vec<Node> = node.children().filter(|of| matches!(of.tag_name().name(), "link" | "frame")).collect();
        let named = |of: &Node| of.attribute("name").unwrap_or_default().to_owned();
        let mut links = Vec::new();
        let mut frames = Vec::new();
        for of in &all {
            let pose = pose_in_world(xml, node, &all, *of)?;
            let frame = SdfFrame { name: named(of), node: *of, pose };
            if tag(*of) == "link" { links.push(frame) } else { frames.push(frame) }
        }
        let joints = joints(xml, node, &links)?;
        let fixed = fixed_links(&joints);

        let Some(at) = links.iter().position(|link| link.name == "platform") else {
            bail!(xml.error(node, "the model has no link called `platform`; rename the link that the cables carry"));
        };
        let platform = links.remove(at);
        Ok(Self { xml, node, links, joints, frames, platform, fixed })
    }

    /// True for a link that does not move.
    pub(super) fn is_fixed(&self, link: &str) -> bool {
        self.fixed.iter().any(|fixed| fixed == link)
    }

    /// Point of a link in the world; of the world for an unknown link.
    pub(super) fn point_of(&self, link: &str, point: &Vec3) -> Vec3 {
        let found = self.links.iter().find(|of| of.name == link);
        found.map_or(*point, |of| of.pose.point_w(point))
    }

    /// Link that a frame is attached to; `None` if it is attached to the model itself.
    pub(super) fn body_under(&self, frame: &str) -> Result<Option<String>> {
        let mut name = frame.to_owned();
        for _ in 0..MAX_CHAIN {
            let Some(found) = self.frames.iter().find(|of| of.name == name) else { return Ok(Some(name)) };
            match found.node.attribute("attached_to") {
                Some(next) if !next.is_empty() => next.clone_into(&mut name),
                _ => return Ok(None),
            }
        }
        bail!(self.xml.error(self.node, format!("the frame `{}` is attached to itself", clean(frame))))
    }

    /// Mass of the platform in its frame; `None` if the file has none.
    pub(super) fn mass_of_platform(&self) -> Result<Option<MassOfBody>> {
        let xml = self.xml;
        let Some(inertial) = xml.optional(self.platform.node, "inertial")? else { return Ok(None) };
        let Some(mass) = xml.optional(inertial, "mass")?.map(|of| xml.number(of)).transpose()? else { return Ok(None) };
        if mass <= 0.0 {
            bail!(xml.error(inertial, format!("the mass of the platform is {mass} kg, it must be positive")));
        }
        let pose = pose_of(xml, inertial)?.unwrap_or_else(identity);
        let inertia = match xml.optional(inertial, "inertia")? {
            Some(node) => {
                let of = |name: &str, other: f64| -> Result<f64> {
                    Ok(xml.optional(node, name)?.map(|value| xml.number(value)).transpose()?.unwrap_or(other))
                };
                let [xx, yy, zz] = [of("ixx", 1.0)?, of("iyy", 1.0)?, of("izz", 1.0)?];
                let [xy, xz, yz] = [of("ixy", 0.0)?, of("ixz", 0.0)?, of("iyz", 0.0)?];
                Some(turned(&Mat3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz), &pose.rot_wp))
            }
            None => None,
        };
        Ok(Some(MassOfBody { mass, center: pose.position_w, inertia }))
    }
}

/// Links that joints fix to the world, and the world itself. Without such a joint a link called frame or base is fixed.
fn fixed_links(joints: &[SdfJoint]) -> Vec<String> {
    let mut fixed: Vec<String> = FRAME_NAMES.iter().map(|name| (*name).to_owned()).collect();
    for _ in 0..joints.len() {
        for joint in joints.iter().filter(|joint| joint.kind == "fixed") {
            for (a, b) in [(&joint.parent, &joint.child), (&joint.child, &joint.parent)] {
                if fixed.contains(a) && !fixed.contains(b) {
                    fixed.push(b.clone());
                }
            }
        }
    }
    fixed
}

fn joints(xml: &Xml, model: Node, links: &[SdfFrame]) -> Result<Vec<SdfJoint>> {
    let mut joints = Vec::new();
    for node in children(model, "joint") {
        let part = |name: &str| -> Result<String> { Ok(content(xml.required(node, name)?).trim().to_owned()) };
        let child = part("child")?;
        let frame = links.iter().find(|link| link.name == child).map_or_else(identity, |link| link.pose);
        let own = pose_of(xml, node)?.unwrap_or_else(identity);
        joints.push(SdfJoint {
            name: node.attribute("name").unwrap_or_default().to_owned(),
            kind: node.attribute("type").unwrap_or_default().to_owned(),
            parent: part("parent")?,
            child,
            position_w: frame.point_w(&own.position_w),
        });
    }
    Ok(joints)
}

/// Pose in the element `<pose>` of an element; `None` if there is none.
fn pose_of(xml: &Xml, node: Node) -> Result<Option<Pose>> {
    let Some(pose) = xml.optional(node, "pose")? else { return Ok(None) };
    let numbers = text::numbers(&content(pose)).map_err(|wrong| xml.error(pose, format!("<pose> holds {wrong}")))?;
    let unit = if pose.attribute("degrees") == Some("true") { 1.0_f64.to_radians() } else { 1.0 };
    match (pose.attribute("rotation_format").unwrap_or("euler_rpy"), &numbers[..]) {
        (_, []) => Ok(None),
        ("euler_rpy", [x, y, z, roll, pitch, yaw]) => Ok(Some(Pose {
            position_w: Vec3::new(*x, *y, *z),
            rot_wp: Rotation::from_euler_angles(roll * unit, pitch * unit, yaw * unit),
        })),
        ("quat_xyzw", [x, y, z, i, j, k, w]) if Vec3::new(*i, *j, *k).norm() + w.abs() > 0.0 => Ok(Some(Pose {
            position_w: Vec3::new(*x, *y, *z),
            rot_wp: Rotation::new_normalize(Quaternion::new(*w, *i, *j, *k)),
        })),
        _ => bail!(xml.error(
            pose,
            "<pose> must hold six numbers, x y z roll pitch yaw, or with rotation_format=\"quat_xyzw\" seven"
        )),
    }
}

/// Pose of a link or frame in the world, through the frames that it is given in.
fn pose_in_world(xml: &Xml, model: Node, all: &[Node], node: Node) -> Result<Pose> {
    let mut total = pose_of(xml, node)?.unwrap_or_else(identity);
    let mut at = node;
    for _ in 0..MAX_CHAIN {
        let pose = children(at, "pose").next();
        let relative = pose.and_then(|pose| pose.attribute("relative_to").or_else(|| pose.attribute("frame")));
        let next = relative.filter(|name| !name.is_empty()).or_else(|| at.attribute("attached_to"));
        let model_pose = || -> Result<Pose> {
            let own = pose_of(xml, model)?.unwrap_or_else(identity);
            Ok(compose(&own, &total))
        };
        match next {
            None | Some("__model__") => return model_pose(),
            Some("world") => return Ok(total),
            Some(name) => {
                let Some(found) = all.iter().find(|of| of.attribute("name") == Some(name)) else {
                    bail!(xml.error(at, format!("the frame `{}`, in which it is given, is not there", clean(name))));
                };
                total = compose(&pose_of(xml, *found)?.unwrap_or_else(identity), &total);
                at = *found;
            }
        }
    }
    bail!(xml.error(node, "its pose is given in itself"))
}
