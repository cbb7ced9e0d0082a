//! Bodies of a model of MuJoCo: what is fixed in the world, what moves, and the wheels that swivel.

use super::options::MujocoOptions;
use crate::import::draft::DraftMotion;
use crate::import::frames::{MassOfBody, attribute_array, attribute_numbers, attribute_vec, compose, identity};
use crate::import::xml::{Xml, children, tag};
use anyhow::{Result, bail};
use funicular::math::{Mat3, Vec3};
use funicular::robot::Pose;
use funicular_study::text::clean;
use roxmltree::Node;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// Density of a geometry without one [kg/m³].
const DENSITY: f64 = 1000.0;
/// Bodies within bodies.
const MAX_DEPTH: usize = 100;

/// Body to which a site or a geometry is fixed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Carrier {
    World,
    /// Place in the list of moving bodies.
    Moving(usize),
}

/// Point of a body.
#[derive(Debug, Clone, Copy)]
pub(super) struct MujocoSite {
    pub(super) carrier: Carrier,
    /// Place in the frame of the carrier [m].
    pub(super) point: Vec3,
    pub(super) point_w: Vec3,
}

/// Geometry that a tendon may wrap.
pub(super) struct MujocoGeom<'n> {
    pub(super) node: Node<'n, 'n>,
    pub(super) carrier: Carrier,
    pub(super) pose_w: Pose,
}

/// Body that moves, with all that is fixed to it.
pub(super) struct MovingBody<'n> {
    pub(super) node: Node<'n, 'n>,
    pub(super) pose: Pose,
    pub(super) joints: Vec<Node<'n, 'n>>,
    /// Moving body that carries this one, if it is not the world.
    pub(super) parent: Option<usize>,
    pub(super) mass: Option<MassOfBody>,
}

/// All bodies of a model.
pub(super) struct MujocoBodies<'n> {
    pub(super) moving: Vec<MovingBody<'n>>,
    pub(super) sites: BTreeMap<String, MujocoSite>,
    pub(super) geoms: BTreeMap<String, MujocoGeom<'n>>,
    /// Number of geometries that are fixed in the world.
    pub(super) geoms_of_world: usize,
}

/// Body on the way through the tree.
#[derive(Clone, Copy)]
struct At {
    carrier: Carrier,
    /// Pose in the frame of the carrier and in the world.
    pose: Pose,
    pose_w: Pose,
    depth: usize,
}

impl<'n> MujocoBodies<'n> {
    pub(super) fn read(xml: &'n Xml<'n>, options: &MujocoOptions) -> Result<Self> {
        let root: Node<'n, 'n> = xml.root();
        let mut bodies = Self { moving: Vec::new(), sites: BTreeMap::new(), geoms: BTreeMap::new(), geoms_of_world: 0 };
        let at = At { carrier: Carrier::World, pose: identity(), pose_w: identity(), depth: 0 };
        for world in children(root, "worldbody") {
            bodies.walk(xml, options, world, at)?;
        }
        Ok(bodies)
    }

    /// Takes the parts of a body and goes on to the bodies in it.
    fn walk(&mut self, xml: &'n Xml<'n>, options: &MujocoOptions, body: Node<'n, 'n>, at: At) -> Result<()> {
        if at.depth > MAX_DEPTH {
            bail!(xml.error(body, "bodies are nested too deeply"));
        }
        let mut of_geoms: Option<MassOfBody> = None;
        for node in body.children().filter(Node::is_element) {
            let point = attribute_vec(xml, node, "pos")?.unwrap_or_default();
            let name = node.attribute("name").unwrap_or_default().to_owned();
            match tag(node) {
                "site" => {
                    let (point_w, point) = (at.pose_w.point_w(&point), at.pose.point_w(&point));
                    self.sites.insert(name, MujocoSite { carrier: at.carrier, point, point_w });
                }
                "geom" => {
                    let own = Pose { position_w: point, rot_wp: options.orientation(xml, node)? };
                    if at.carrier == Carrier::World {
                        self.geoms_of_world += usize::from(node.attribute("type") != Some("plane"));
                    } else if let Some(mass) = mass_of_geom(xml, node)? {
                        let mass = mass.seen_from_outside(&own);
                        of_geoms = Some(of_geoms.map_or(mass, |sum| sum.with(&mass)));
                    }
                    let pose_w = compose(&at.pose_w, &own);
                    self.geoms.insert(name, MujocoGeom { node, carrier: at.carrier, pose_w });
                }
                "frame" | "replicate" | "composite" | "flexcomp" | "attach" => {
                    bail!(xml.error(node, format!("<{}> is not read; let MuJoCo write the model", tag(node))))
                }
                "body" => {
                    let own = Pose { position_w: point, rot_wp: options.orientation(xml, node)? };
                    let inside = self.enter(node, at, &own);
                    self.walk(xml, options, node, inside)?;
                }
                _ => {}
            }
        }

        let given = xml.optional(body, "inertial")?.map(|node| inertial(xml, options, node)).transpose()?;
        if let (Carrier::Moving(k), Some(mass)) = (at.carrier, given.or(of_geoms)) {
            let mass = mass.seen_from_outside(&at.pose);
            let body = &mut self.moving[k];
            body.mass = Some(body.mass.map_or(mass, |sum| sum.with(&mass)));
        }
        Ok(())
    }

    /// Place inside a body, which moves if it has joints.
    fn enter(&mut self, node: Node<'n, 'n>, at: At, own: &Pose) -> At {
        let pose_w = compose(&at.pose_w, own);
        let joints: Vec<_> =
            node.children().filter(|of| matches!(of.tag_name().name(), "joint" | "freejoint")).collect();
        if joints.is_empty() {
            return At { carrier: at.carrier, pose: compose(&at.pose, own), pose_w, depth: at.depth + 1 };
        }
        let parent = match at.carrier {
            Carrier::World => None,
            Carrier::Moving(k) => Some(k),
        };
        self.moving.push(MovingBody { node, pose: pose_w, joints, parent, mass: None });
        At { carrier: Carrier::Moving(self.moving.len() - 1), pose: identity(), pose_w, depth: at.depth + 1 }
    }
}

impl MovingBody<'_> {
    /// Motion that the joints allow.
    pub(super) fn motion(&self, xml: &Xml) -> Result<DraftMotion> {
        let kinds: Vec<&str> = self
            .joints
            .iter()
            .map(|joint| if tag(*joint) == "freejoint" { "free" } else { joint.attribute("type").unwrap_or("hinge") })
            .collect();
        let count = |kind: &str| kinds.iter().filter(|of| **of == kind).count();
        match (count("free"), count("slide"), count("hinge"), kinds.len()) {
            (1, 0, 0, 1) => Ok(DraftMotion::Rigid),
            (0, 3, 0, 3) => Ok(DraftMotion::PointMass),
            (0, 2, 1, 3) => {
                let hinge = self.joints.iter().zip(&kinds).find(|(_, kind)| **kind == "hinge").map(|(joint, _)| *joint);
                let axis = hinge.map(|hinge| attribute_vec(xml, hinge, "axis")).transpose()?.flatten();
                DraftMotion::with_normal(&(self.pose.rot_wp * axis.unwrap_or_else(Vec3::z))).ok_or_else(|| {
                    xml.error(self.node, "the hinge of the platform is not about a coordinate axis x, y or z")
                })
            }
            _ => bail!(xml.error(
                self.node,
                format!(
                    "the joints of the body `{}` are {}; a platform has a free joint, three slides, or two slides \
                     and a hinge",
                    clean(self.node.attribute("name").unwrap_or_default()),
                    clean(&kinds.join(", "))
                )
            )),
        }
    }
}

/// Mass in the element `<inertial>`.
fn inertial(xml: &Xml, options: &MujocoOptions, node: Node) -> Result<MassOfBody> {
    let mass = positive(xml, node, "mass")?;
    let center = attribute_vec(xml, node, "pos")?.unwrap_or_default();
    let inertia = if let Some([xx, yy, zz, xy, xz, yz]) = attribute_array(xml, node, "fullinertia")? {
        Some(Mat3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz))
    } else if let Some(moments) = attribute_vec(xml, node, "diaginertia")? {
        Some(super::super::frames::turned(&Mat3::from_diagonal(&moments), &options.orientation(xml, node)?))
    } else {
        None
    };
    Ok(MassOfBody { mass, center, inertia })
}

fn positive(xml: &Xml, node: Node, name: &str) -> Result<f64> {
    let Some(value) = xml.optional_attribute_number(node, name)? else {
        bail!(xml.error(node, format!("<{}> has no attribute `{name}`", tag(node))))
    };
    if value <= 0.0 {
        bail!(xml.error(node, format!("attribute `{name}` of <{}> is {value}, it must be positive", tag(node))));
    }
    Ok(value)
}

/// Mass of a geometry in its frame; `None` for one without mass or of a kind that is not read.
fn mass_of_geom(xml: &Xml, node: Node) -> Result<Option<MassOfBody>> {
    let sizes = attribute_numbers(xml, node, "size")?.unwrap_or_default();
    // Volume, and moments of inertia of unit mass.
    let ball = |a: f64, b: f64, c: f64| {
        (4.0 / 3.0 * PI * a * b * c, [(b, c), (a, c), (a, b)].map(|(p, q)| (p * p + q * q) / 5.0))
    };
    let (volume, moments) = match (node.attribute("type").unwrap_or("sphere"), &sizes[..]) {
        ("sphere", [r, ..]) => ball(*r, *r, *r),
        ("ellipsoid", [a, b, c]) => ball(*a, *b, *c),
        ("box", [a, b, c]) => (8.0 * a * b * c, [(b, c), (a, c), (a, b)].map(|(p, q)| (p * p + q * q) / 3.0)),
        ("cylinder", [r, h]) => {
            let across = r * r / 4.0 + h * h / 3.0;
            (2.0 * PI * r * r * h, [across, across, r * r / 2.0])
        }
        _ => return Ok(None),
    };
    let mass = match xml.optional_attribute_number(node, "mass")? {
        Some(mass) => mass,
        None => volume * xml.optional_attribute_number(node, "density")?.unwrap_or(DENSITY),
    };
    let inertia = Mat3::from_diagonal(&Vec3::from(moments)) * mass;
    Ok((mass > 0.0).then_some(MassOfBody { mass, center: Vec3::zeros(), inertia: Some(inertia) }))
}
