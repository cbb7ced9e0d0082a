//! CASPR's file of bodies: one link with its joint, inertia and pose.

use crate::import::draft::{DraftMotion, rotation_xyz};
use crate::import::text;
use crate::import::xml::{Xml, children, tag};
use anyhow::{Result, bail};
use funicular::math::{Mat3, Rotation, Vec3};
use funicular::robot::Pose;
use funicular_study::text::clean;
use roxmltree::Node;

/// Link of a CASPR model: the only body that moves.
pub(super) struct CasprLink {
    pub(super) name: String,
    pub(super) mass: Option<f64>,
    pub(super) inertia_p: Option<Mat3>,
    /// Centre of mass relative to the joint, body axes [m].
    pub(super) center_of_mass_p: Vec3,
    pub(super) motion: DraftMotion,
    /// Pose; `None` if the file has no coordinates of the joint.
    pub(super) pose: Option<Pose>,
    pub(super) place: String,
    pub(super) assumed: Vec<String>,
    pub(super) lost: Vec<String>,
}

/// Kind of joint: motion of the body, and its place as a function of the joint's coordinates.
pub(super) struct Joint {
    pub(super) motion: DraftMotion,
    /// Number of coordinates.
    pub(super) count: usize,
    /// Translation [m] and rotation relative to the base.
    pub(super) place: fn(&[f64]) -> (Vec3, Rotation),
}

impl Joint {
    /// True if the coordinates hold a quaternion.
    pub(super) fn has_quaternion(&self) -> bool {
        self.count == 7
    }
}

/// Joint of a platform by its name in CASPR, old names included; `None` for other joints.
fn joint_of(kind: &str) -> Option<Joint> {
    let planar = |plane| DraftMotion::Planar { plane };
    Some(match kind {
        "SPATIAL_EULER_XYZ" => Joint {
            motion: DraftMotion::Rigid,
            count: 6,
            place: |q| (Vec3::new(q[0], q[1], q[2]), rotation_xyz(q[3], q[4], q[5])),
        },
        "SPATIAL_QUATERNION" | "SPATIAL" => Joint {
            motion: DraftMotion::Rigid,
            count: 7,
            place: |q| (Vec3::new(q[0], q[1], q[2]), from_quaternion(q[3], &Vec3::new(q[4], q[5], q[6]))),
        },
        "T_XYZ" => Joint {
            motion: DraftMotion::PointMass,
            count: 3,
            place: |q| (Vec3::new(q[0], q[1], q[2]), Rotation::identity()),
        },
        "PLANAR_XY" => Joint {
            motion: planar("xy"),
            count: 3,
            place: |q| (Vec3::new(q[0], q[1], 0.0), rotation_xyz(0.0, 0.0, q[2])),
        },
        "PLANAR_XZ" => Joint {
            motion: planar("xz"),
            count: 3,
            place: |q| (Vec3::new(q[0], 0.0, q[1]), rotation_xyz(0.0, q[2], 0.0)),
        },
        "PLANAR_YZ" => Joint {
            motion: planar("yz"),
            count: 3,
            place: |q| (Vec3::new(0.0, q[0], q[1]), rotation_xyz(q[2], 0.0, 0.0)),
        },
        _ => return None,
    })
}

/// Rotation of a quaternion, which need not be normalized but must not be zero.
fn from_quaternion(w: f64, v: &Vec3) -> Rotation {
    let sine = v.norm();
    if sine == 0.0 { Rotation::identity() } else { Rotation::from_scaled_axis(v * (2.0 * sine.atan2(w) / sine)) }
}

/// Reads the body of a file.
pub(super) fn read(xml: &Xml) -> Result<CasprLink> {
    let link = link(xml)?;
    let parent = xml.required(link, "parent")?;
    let parent_link = xml.child_number(parent, "num")?;
    if parent_link != 0.0 {
        bail!(
            xml.error(
                parent,
                format!("<num> is {parent_link}; the parent of the only link has to be the base, link 0")
            )
        );
    }

    let joint_node = xml.required(link, "joint")?;
    let (motion, place) = joint(xml, joint_node)?;
    let location = xml.child_vector(parent, "location")?;
    let physical = xml.required(link, "physical")?;
    let center_of_mass_p = xml.child_vector(physical, "com_location")?;
    let mass = mass(xml, physical)?;

    let mut assumed = Vec::new();
    let mut lost = Vec::new();
    let inertia_node = xml.required(physical, "inertia")?;
    let inertia_p = inertia(xml, inertia_node, mass, &center_of_mass_p, &mut assumed)?;
    if let Some(end) = xml.optional(physical, "end_location")? {
        let end_p = xml.vector(end)?;
        if end_p != Vec3::zeros() {
            lost.push(format!("<end_location> ({}, {}, {}) m of the platform", end_p.x, end_p.y, end_p.z));
        }
    }
    if joint_node.has_attribute("q_min") || joint_node.has_attribute("q_max") {
        let limits = ["q_min", "q_max"].map(|name| clean(joint_node.attribute(name).unwrap_or("none")));
        let [least, most] = limits;
        lost.push(format!(
            "the limits of the platform's motion, q_min {least} and q_max {most}: as a grid they limit a map or a \
             workspace"
        ));
    }
    if children(xml.root(), "operational_spaces").next().is_some() {
        lost.push("<operational_spaces>".to_owned());
    }

    Ok(CasprLink {
        name: clean(link.attribute("name").unwrap_or_default()),
        mass,
        inertia_p,
        center_of_mass_p,
        motion,
        pose: place.map(|(translation, rot_wp)| Pose { position_w: location + translation, rot_wp }),
        place: xml.place(physical),
        assumed,
        lost,
    })
}

/// Moving body of the robot.
fn link<'n>(xml: &'n Xml<'_>) -> Result<Node<'n, 'n>> {
    let root = xml.root();
    let links = if tag(root) == "links" { root } else { xml.required(root, "links")? };
    let all: Vec<Node> = links.children().filter(Node::is_element).collect();
    let link = match all[..] {
        [link] => link,
        [] => bail!(xml.error(links, "<links> has no <link_rigid>: the robot has no moving body")),
        [_, second, ..] => bail!(xml.error(
            second,
            format!(
                "the robot has {} links; only robots with one moving platform are supported, no chains of links",
                all.len()
            )
        )),
    };
    if tag(link) != "link_rigid" {
        bail!(xml.error(link, format!("<{}> is not known; a platform is a <link_rigid>", tag(link))));
    }
    Ok(link)
}

/// Joint of the body of a file, and the place of its base [m].
pub(super) fn joint_on_base(xml: &Xml) -> Result<(Joint, Vec3)> {
    let link = link(xml)?;
    let joint = known_joint(xml, xml.required(link, "joint")?)?;
    Ok((joint, xml.child_vector(xml.required(link, "parent")?, "location")?))
}

/// Joint of a node.
fn known_joint(xml: &Xml, node: Node) -> Result<Joint> {
    let kind = kind_of(node);
    let Some(joint) = joint_of(kind) else {
        let which = match kind.split('_').next().unwrap_or_default() {
            "" => bail!(xml.error(node, "<joint> has no attribute `type`")),
            "P" => "a platform that translates along fewer than three axes and cannot rotate",
            "R" | "U" | "S" => "a link that only rotates about a fixed point",
            _ => "of an unknown kind",
        };
        bail!(xml.error(
            node,
            format!(
                "joint `{}` is {which}; platforms are SPATIAL_EULER_XYZ, SPATIAL_QUATERNION, T_XYZ (point mass), \
                 PLANAR_XY, PLANAR_XZ and PLANAR_YZ",
                clean(kind)
            )
        ));
    };
    Ok(joint)
}

/// Name of the kind of a joint.
fn kind_of<'n>(node: Node<'n, '_>) -> &'n str {
    node.attribute("type").unwrap_or_default().trim()
}

/// Motion of a joint, and its place if the file gives the joint's coordinates.
fn joint(xml: &Xml, node: Node) -> Result<(DraftMotion, Option<(Vec3, Rotation)>)> {
    let (joint, kind) = (known_joint(xml, node)?, kind_of(node));
    if node.attribute("actuated").is_some_and(|text| text.trim() == "true") {
        bail!(xml.error(
            node,
            "the joint is actuated: other forces than those of cables hold the platform, which a robot file cannot \
             describe"
        ));
    }

    let text = node.attribute("q_initial").map(str::trim).filter(|text| !text.is_empty());
    // Models from before 2017 have no coordinates.
    let Some(text) = text else { return Ok((joint.motion, None)) };

    let q = text::numbers(text).map_err(|wrong| xml.error(node, format!("attribute `q_initial` holds {wrong}")))?;
    if q.len() != joint.count {
        let count = joint.count;
        bail!(xml.error(node, format!("attribute `q_initial` holds {} numbers, {kind} needs {count}", q.len())));
    }
    if joint.has_quaternion() && q[3..].iter().all(|part| *part == 0.0) {
        bail!(xml.error(node, "attribute `q_initial` holds the quaternion zero, which is no orientation"));
    }

    Ok((joint.motion, Some((joint.place)(&q))))
}

/// Mass of the body; zero, a placeholder in incomplete files, counts as missing.
fn mass(xml: &Xml, physical: Node) -> Result<Option<f64>> {
    let node = xml.required(physical, "mass")?;
    let mass = xml.number(node)?;
    if mass < 0.0 {
        bail!(xml.error(node, format!("<mass> is {mass} kg, it must be positive")));
    }
    Ok((mass > 0.0).then_some(mass))
}

/// Inertia tensor about the centre of mass; `None` if all entries are zero.
fn inertia(
    xml: &Xml,
    node: Node,
    mass: Option<f64>,
    center_p: &Vec3,
    assumed: &mut Vec<String>,
) -> Result<Option<Mat3>> {
    let entry = |name| xml.number(xml.required(node, name)?);
    let [xx, yy, zz] = [entry("Ixx")?, entry("Iyy")?, entry("Izz")?];
    let [xy, xz, yz] = [entry("Ixy")?, entry("Ixz")?, entry("Iyz")?];

    let tensor = Mat3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    if tensor == Mat3::zeros() {
        return Ok(None);
    }

    if [xy, xz, yz].iter().any(|product| *product != 0.0) {
        assumed.push(
            "Ixy, Ixz and Iyz are entries of the tensor, as in CASPR; if they are products of inertia, the integrals \
             of xy dm, xz dm and yz dm, change their signs"
                .to_owned(),
        );
    }

    // Models from before 2017 write CoM.
    match node.attribute("ref").map(|text| text.trim().to_ascii_lowercase()).as_deref() {
        Some("com") => Ok(Some(tensor)),
        Some("joint") => {
            // Without the mass the tensor cannot be shifted to the centre of mass.
            let Some(mass) = mass else { return Ok(None) };
            let shift = Mat3::identity() * center_p.norm_squared() - center_p * center_p.transpose();
            Ok(Some(tensor - shift * mass))
        }
        Some(other) => {
            bail!(
                xml.error(node, format!("attribute `ref` of <inertia> is `{}`, it must be com or joint", clean(other)))
            )
        }
        None => bail!(xml.error(node, "<inertia> has no attribute `ref`, it must be com or joint")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quaternion_of_any_length_gives_the_rotation_of_its_axis_and_angle() {
        let (s, c) = (0.35_f64.sin(), 0.35_f64.cos());
        let turned = from_quaternion(2.0 * c, &Vec3::new(0.0, 0.0, 2.0 * s)) * Vec3::x();
        assert!((turned - Vec3::new(0.7_f64.cos(), 0.7_f64.sin(), 0.0)).norm() < 1e-15, "{turned}");
        assert_eq!(from_quaternion(-1.0, &Vec3::zeros()), Rotation::identity());
    }

    #[test]
    fn planar_joints_turn_about_the_normal_of_their_plane() {
        for (kind, translation, axis) in [
            ("PLANAR_XY", Vec3::new(1.0, 2.0, 0.0), Vec3::z()),
            ("PLANAR_XZ", Vec3::new(1.0, 0.0, 2.0), Vec3::y()),
            ("PLANAR_YZ", Vec3::new(0.0, 1.0, 2.0), Vec3::x()),
        ] {
            let (moved, turned) = (joint_of(kind).unwrap().place)(&[1.0, 2.0, 0.3]);
            assert_eq!(moved, translation, "{kind}");
            assert!((turned.scaled_axis() - axis * 0.3).norm() < 1e-15, "{kind}");
        }
    }
}
