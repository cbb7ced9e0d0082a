//! Spatial tendons of a model of MuJoCo as cables.

use super::actuators::{self, TendonSpring};
use super::bodies::{Carrier, MujocoBodies, MujocoSite};
use super::options::MujocoOptions;
use crate::import::draft::{DraftCable, DraftPulley, DraftRope, DraftWinch};
use crate::import::frames::{attribute_numbers, attribute_vec};
use crate::import::xml::{Xml, children, tag};
use anyhow::{Result, anyhow, bail};
use funicular::math::Vec3;
use funicular_study::text::clean;
use roxmltree::Node;

/// Deviation of a wheel from the swivel axis that it touches, in radii, and of a stiffness from that of its rope: well
/// above the rounding of a file that was written with all digits.
const MAX_ROUNDING: f64 = 1e-6;

/// Course of a tendon from the frame to the platform.
struct Course<'n> {
    anchor_w: Vec3,
    attachment_p: Vec3,
    platform: usize,
    pulley: Option<DraftPulley>,
    /// Length before the anchor, which does not change [m].
    before: f64,
    node: Node<'n, 'n>,
}

/// Cables, and the place of the platform in the list of moving bodies.
pub(super) fn cables<'n>(
    xml: &'n Xml<'n>,
    options: &MujocoOptions<'n>,
    bodies: &MujocoBodies<'n>,
) -> Result<(Vec<DraftCable>, usize)> {
    let root: Node<'n, 'n> = xml.root();
    let mut cables = Vec::new();
    let mut platform = None;
    for node in children(root, "tendon").flat_map(|section| section.children().filter(Node::is_element)) {
        if tag(node) != "spatial" {
            bail!(
                xml.error(node, format!("a tendon <{}> couples joints; only <spatial> tendons are cables", tag(node)))
            );
        }
        let course = course(xml, bodies, node)?;
        let known = *platform.get_or_insert(course.platform);
        if known != course.platform {
            bail!(xml.error(node, "the tendon ends on another body than the ones before; a robot has one platform"));
        }
        cables.push(cable(xml, options, &course)?);
    }
    let Some(platform) = platform else {
        bail!(xml.error(root, "the model has no <spatial> tendons: the robot has no cables"));
    };
    Ok((cables, platform))
}

fn cable<'n>(xml: &'n Xml<'n>, options: &MujocoOptions<'n>, course: &Course<'n>) -> Result<DraftCable> {
    let id = course.node.attribute("name").unwrap_or_default();
    let found = match actuators::spring(xml, options, id)? {
        Some(spring) => Some(spring),
        None => own_spring(xml, options, course.node)?,
    };
    let [minimum, mut maximum] = actuators::limits(xml, options, id)?;
    let mut rope = DraftRope::default();
    let mut winch = Vec::new();
    if course.before > 0.0 && course.pulley.is_none_or(|pulley| !is_two_radii(course.before, pulley.radius)) {
        winch.push(("drum_side_length_m", course.before));
    }

    let mut unstrained_length = None;
    if let Some(TendonSpring { stiffness, rest_length, axial_stiffness }) = found {
        // The two radii before a wheel without a drum side are not rope.
        let outside = if winch.is_empty() { course.before } else { 0.0 };
        let length = rest_length - outside;
        if length <= 0.0 {
            bail!(xml.error(course.node, format!("the rest length of the tendon is {rest_length} m, too short")));
        }
        rope.axial_stiffness = Some(axial_stiffness.unwrap_or(stiffness * length));
        unstrained_length = Some(length);
        let behind = axial_stiffness.map_or(0.0, |given| 1.0 / stiffness - length / given);
        if behind * stiffness > MAX_ROUNDING {
            winch.push(("stiffness_n_per_m", 1.0 / behind));
        }
        // Without a limit of the cable, `funicular export` writes EA.
        maximum = maximum.filter(|limit| Some(*limit) != axial_stiffness);
    }

    Ok(DraftCable {
        name: clean(id),
        anchor_w: course.anchor_w,
        attachment_p: course.attachment_p,
        rope,
        limits: [minimum, maximum],
        unstrained_length,
        pulley: course.pulley,
        winch: (!winch.is_empty()).then(|| DraftWinch { name: String::new(), values: winch }),
    })
}

fn is_two_radii(length: f64, radius: f64) -> bool {
    (length - 2.0 * radius).abs() < MAX_ROUNDING * radius
}

/// Spring of the tendon itself; `None` for a tendon without one, or with a length that the model does not give.
fn own_spring<'n>(xml: &'n Xml<'n>, options: &MujocoOptions<'n>, node: Node<'n, 'n>) -> Result<Option<TendonSpring>> {
    let numbers = |name: &str| options.numbers(xml, node, "tendon", name);
    let first = |name: &str| -> Result<Option<f64>> { Ok(numbers(name)?.and_then(|of| of.first().copied())) };
    let Some(stiffness) = first("stiffness")?.filter(|stiffness| *stiffness != 0.0) else { return Ok(None) };
    if stiffness < 0.0 {
        bail!(xml.error(node, format!("attribute `stiffness` is {stiffness} N/m, it must be positive")));
    }
    // The spring pulls beyond the second of two lengths.
    let rest = numbers("springlength")?.and_then(|lengths| lengths.last().copied()).filter(|length| *length > 0.0);
    match rest {
        Some(rest_length) => Ok(Some(TendonSpring { stiffness, rest_length, axial_stiffness: None })),
        None => bail!(xml.error(
            node,
            "the tendon has a stiffness and no `springlength`: without tension where it stands, it carries nothing; \
             give its `springlength`"
        )),
    }
}

/// Sites and wheels of a tendon, from the frame to the platform.
fn course<'n>(xml: &Xml, bodies: &MujocoBodies<'n>, node: Node<'n, 'n>) -> Result<Course<'n>> {
    let mut parts: Vec<Node> = node.children().filter(Node::is_element).collect();
    if let Some(pulley) = parts.iter().find(|part| tag(**part) == "pulley") {
        bail!(xml.error(
            *pulley,
            "the tendon has a <pulley>, a tackle of several falls; a robot file has cables with one fall each"
        ));
    }
    let site = |part: Node| -> Result<MujocoSite> {
        let name = part.attribute("site").unwrap_or_default();
        bodies
            .sites
            .get(name)
            .copied()
            .ok_or_else(|| anyhow!("{}: the site `{}` of the tendon is not there", xml.place(part), clean(name)))
    };
    if parts.iter().filter(|part| tag(**part) == "site").count() < 2 {
        bail!(xml.error(node, "the tendon has fewer than two sites"));
    }
    if let Some(first) = parts.first().filter(|first| tag(**first) == "site")
        && site(*first)?.carrier != Carrier::World
    {
        parts.reverse();
    }

    let Some((last, before)) = parts.split_last() else { bail!(xml.error(node, "the tendon is empty")) };
    let wraps = before.iter().any(|part| tag(*part) == "geom");
    let end = if tag(*last) == "site" { site(*last)? } else { bail!(xml.error(*last, "a tendon must end at a site")) };
    let platform = platform_of(xml, bodies, node, &end)?;
    let sites =
        before.iter().filter(|part| tag(**part) == "site").map(|part| site(*part)).collect::<Result<Vec<_>>>()?;
    let fixed: Vec<Vec3> =
        sites.iter().take_while(|site| site.carrier == Carrier::World).map(|site| site.point_w).collect();
    let Some(&anchor_w) = fixed.last() else { bail!(xml.error(node, "the tendon does not begin on the frame")) };
    if !wraps {
        if fixed.len() < sites.len() {
            bail!(
                xml.error(node, "the tendon runs over a moving body; a cable ends at the first point of the platform")
            );
        }
        let before = fixed.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
        return Ok(Course { anchor_w, attachment_p: end.point, platform, pulley: None, before, node });
    }

    let wheels: Vec<&Node> = before.iter().filter(|part| tag(**part) == "geom").collect();
    let (entry_w, pulley) = wheel(xml, bodies, *wheels[0], &anchor_w)?;
    let name = wheels[0].attribute("geom");
    if wheels.iter().any(|other| other.attribute("geom") != name) || fixed.len() > 1 {
        bail!(
            xml.error(node, "the tendon runs over more than one wheel or guide; a robot file has one pulley per cable")
        );
    }
    let before = (entry_w - anchor_w).norm();
    Ok(Course { anchor_w: entry_w, attachment_p: end.point, platform, pulley: Some(pulley), before, node })
}

/// Number of the moving body on which a tendon ends.
fn platform_of(xml: &Xml, bodies: &MujocoBodies, node: Node, end: &MujocoSite) -> Result<usize> {
    let Carrier::Moving(platform) = end.carrier else {
        bail!(xml.error(node, "the tendon has both ends on the frame: its falls over the platform are not read"))
    };
    let body = &bodies.moving[platform];
    if body.parent.is_some() {
        bail!(xml.error(
            node,
            format!(
                "the tendon ends on the body `{}`, which hangs on another one, as ropes of several pieces do; export \
                 the robot without ⟪cable_pieces⟫",
                clean(body.node.attribute("name").unwrap_or_default())
            )
        ));
    }
    Ok(platform)
}

/// Entry point and data of a wheel that swivels about the axis along which the cable comes to it.
fn wheel(xml: &Xml, bodies: &MujocoBodies, part: Node, before_w: &Vec3) -> Result<(Vec3, DraftPulley)> {
    let name = part.attribute("geom").unwrap_or_default();
    let Some(geom) = bodies.geoms.get(name) else {
        bail!(xml.error(part, format!("the geometry `{}` of the tendon is not there", clean(name))));
    };
    let radius = attribute_numbers(xml, geom.node, "size")?.and_then(|sizes| sizes.first().copied()).unwrap_or(0.0);
    let Carrier::Moving(k) = geom.carrier else {
        bail!(xml.error(part, "the tendon wraps a geometry that does not swivel; a robot file has swivelling wheels"))
    };
    let body = &bodies.moving[k];
    let [joint] = body.joints[..] else {
        bail!(xml.error(body.node, "a wheel that a tendon wraps must have one hinge, about which it swivels"))
    };
    if joint.attribute("type").unwrap_or("hinge") != "hinge" || geom.node.attribute("type") != Some("cylinder") {
        bail!(xml.error(body.node, "a wheel that a tendon wraps must be a cylinder on a body with one hinge"));
    }
    let axis = attribute_vec(xml, joint, "axis")?.unwrap_or_else(Vec3::z);
    let at = body.pose.point_w(&attribute_vec(xml, joint, "pos")?.unwrap_or_default());
    let Some(axis_w) = (body.pose.rot_wp * axis).try_normalize(0.0) else {
        bail!(xml.error(joint, "the axis of the hinge has no length"))
    };

    let center = geom.pose_w.position_w - at;
    let along = axis_w * axis_w.dot(&center);
    let offset = (center - along).norm();
    let entry_w = at + along;
    let off_axis = (before_w - entry_w) - axis_w * axis_w.dot(&(before_w - entry_w));
    if radius <= 0.0 || (offset - radius).abs() > MAX_ROUNDING * radius || off_axis.norm() > MAX_ROUNDING * radius {
        bail!(xml.error(
            geom.node,
            format!(
                "the wheel of radius {radius} m is {offset} m from its swivel axis, or the tendon does not come along \
                 this axis; the cable must come to the wheel along the axis about which it swivels"
            )
        ));
    }
    let forward = axis_w.dot(&(entry_w - before_w)) >= 0.0;
    Ok((entry_w, DraftPulley { radius, entry_direction_w: if forward { axis_w } else { -axis_w } }))
}
