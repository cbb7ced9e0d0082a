//! CASPR's file of cables, of which one set is read.

use crate::import::draft::{DraftCable, DraftPulley, DraftRope, listed};
use crate::import::xml::{Xml, children, tag};
use anyhow::{Result, bail};
use funicular::math::Vec3;
use funicular::suggest::nearest;
use funicular_study::text::clean;
use roxmltree::Node;

/// Set of cables.
pub(super) struct CableSet {
    pub(super) id: String,
    /// True if the file has no other set.
    pub(super) is_only: bool,
    pub(super) cables: Vec<DraftCable>,
    pub(super) lost: Vec<String>,
}

/// Reads the requested set, or the file's default set.
pub(super) fn read(xml: &Xml, requested: Option<&str>, center_of_mass_p: &Vec3) -> Result<CableSet> {
    let root = xml.root();
    let sets: Vec<Node> = children(root, "cable_set").collect();
    let ids: Vec<String> = sets.iter().map(|set| clean(id_of(set))).collect();
    let node = chosen(xml, &sets, &ids, requested)?;
    let id = clean(id_of(&node));

    let mut losses = CasprLosses::default();
    let mut cables = Vec::new();
    for cable in node.children().filter(Node::is_element) {
        cables.push(read_cable(xml, cable, center_of_mass_p, &mut losses)?);
    }
    if cables.is_empty() {
        bail!(xml.error(node, format!("cable set \"{id}\" has no cables")));
    }

    let mut lost = losses.lost();
    let others: Vec<String> = sets.iter().zip(ids).filter(|(set, _)| **set != node).map(|(_, id)| id).collect();
    if !others.is_empty() {
        lost.push(format!("the other cable sets, {}; ⟪cable_set⟫ chooses one", listed(&others)));
    }
    Ok(CableSet { is_only: sets.len() == 1, id, cables, lost })
}

/// Name of a set exactly as in the file.
fn id_of<'n>(set: &Node<'n, '_>) -> &'n str {
    set.attribute("id").unwrap_or_default()
}

/// Set to read: the requested one, or else the file's default.
fn chosen<'n, 'a>(
    xml: &Xml<'a>,
    sets: &[Node<'n, 'a>],
    ids: &[String],
    requested: Option<&str>,
) -> Result<Node<'n, 'a>> {
    let root = xml.root();
    let default = root.attribute("default_cable_set").map(str::trim).filter(|name| !name.is_empty());
    match (requested, default, sets) {
        (Some(name), ..) => of_name(xml, sets, ids, name, "⟪cable_set⟫"),
        (None, Some(name), _) => of_name(xml, sets, ids, name, "default_cable_set"),
        (None, None, [only]) => Ok(*only),
        (None, None, []) => bail!(xml.error(root, "<cables> has no <cable_set>")),
        (None, None, _) => bail!(xml.error(
            root,
            format!("the file has several sets and no default_cable_set; choose one with ⟪cable_set⟫: {}", listed(ids))
        )),
    }
}

/// Set with a name. `origin` says where the name was given.
fn of_name<'n, 'a>(
    xml: &Xml<'a>,
    sets: &[Node<'n, 'a>],
    ids: &[String],
    name: &str,
    origin: &str,
) -> Result<Node<'n, 'a>> {
    let root = xml.root();
    // Compare complete names: names in messages are cut off, and two long names may begin alike.
    let is_requested = |id: &str| id.split_whitespace().eq(name.split_whitespace());
    let mut found = sets.iter().filter(|set| is_requested(id_of(set))).copied();

    match (found.next(), found.next()) {
        (Some(set), None) => Ok(set),
        (Some(_), Some(second)) => bail!(xml.error(second, format!("a second set is called \"{}\"", clean(name)))),
        (None, _) if sets.is_empty() => bail!(xml.error(root, "<cables> has no <cable_set>")),
        (None, _) => {
            let near = nearest(name, ids.iter().map(String::as_str))
                .map(|id| format!("did you mean \"{id}\"? "))
                .unwrap_or_default();
            bail!(xml.error(
                root,
                format!(
                    "{origin} names the set \"{}\", which does not exist: {near}the file has {}",
                    clean(name),
                    listed(ids)
                )
            ))
        }
    }
}

fn read_cable(xml: &Xml, node: Node, center_of_mass_p: &Vec3, losses: &mut CasprLosses) -> Result<DraftCable> {
    let name = clean(node.attribute("name").unwrap_or_default());
    let is_spring = is_spring(xml, node, &name)?;
    let from_center = is_attached_from_center(xml, node, &name)?;

    let mut limits = [None; 2];
    if let Some(properties) = xml.optional(node, "properties")? {
        limits = [limit(xml, properties, "force_min")?, limit(xml, properties, "force_max")?];
        losses.diameters |= xml.optional(properties, "diameter")?.is_some();
    }
    let mut rope = DraftRope::default();
    if is_spring {
        // K is EA: CASPR divides it by the cable's length to get a stiffness in N/m.
        let stiffness = xml.required(xml.required(node, "properties")?, "K")?;
        let value = xml.number(stiffness)?;
        if value <= 0.0 {
            bail!(xml.error(stiffness, format!("<K> of cable \"{name}\" is {value} N, it must be positive")));
        }
        rope.axial_stiffness = Some(value);
    }

    let Ends { anchor_w, pulley, attachment_p } = ends(xml, xml.required(node, "attachments")?, &name, losses)?;
    let attachment_p = if from_center { attachment_p + center_of_mass_p } else { attachment_p };
    Ok(DraftCable { name, anchor_w, attachment_p, rope, limits, unstrained_length: None, pulley, winch: None })
}

/// True for a cable with stiffness, false for an ideal one. Other kinds are refused.
fn is_spring(xml: &Xml, node: Node, cable: &str) -> Result<bool> {
    let kind = tag(node);
    let why = match kind {
        "cable_ideal" => return Ok(false),
        "cable_linear_spring" => return Ok(true),
        "cable_passive_linear_spring" => "a passive spring, which a robot file cannot hold",
        "cable_vsd_torsion_spring" | "cable_vsd_flexure_linear" | "cable_vsd_polynomial" => {
            "a cable in series with a device of variable stiffness, which a robot file cannot hold"
        }
        "muscle_hill_type" | "pneumatic_artificial_muscle" => "a muscle, which a robot file cannot hold",
        _ => "of an unknown kind",
    };
    bail!(xml.error(node, format!("<{kind}> \"{cable}\" is {why}; cables are <cable_ideal> and <cable_linear_spring>")))
}

/// True if the attachment is given from the centre of mass, false if it is given from the joint.
fn is_attached_from_center(xml: &Xml, node: Node, cable: &str) -> Result<bool> {
    match node.attribute("attachment_reference").map(str::trim) {
        Some("joint") => Ok(false),
        Some("com") => Ok(true),
        Some(other) => bail!(xml.error(
            node,
            format!(
                "attribute `attachment_reference` of cable \"{cable}\" is `{}`, it must be joint or com",
                clean(other)
            )
        )),
        None => bail!(xml.error(
            node,
            format!("cable \"{cable}\" has no attribute `attachment_reference`, it must be joint or com")
        )),
    }
}

/// Tension limit; an infinite one counts as none.
fn limit(xml: &Xml, properties: Node, name: &str) -> Result<Option<f64>> {
    let Some(node) = xml.optional(properties, name)? else { return Ok(None) };
    let infinite = node.text().is_some_and(|text| text.trim().parse::<f64>().is_ok_and(f64::is_infinite));
    if infinite { Ok(None) } else { xml.number(node).map(Some) }
}

/// Ends of a cable.
struct Ends {
    /// Anchor, world frame.
    anchor_w: Vec3,
    /// Pulley at the anchor.
    pulley: Option<DraftPulley>,
    /// Attachment, platform frame.
    attachment_p: Vec3,
}

/// Anchor of a cable in world axes with its pulley, and its attachment in platform axes.
fn ends(xml: &Xml, attachments: Node, cable: &str, losses: &mut CasprLosses) -> Result<Ends> {
    let points: Vec<Node> = attachments.children().filter(Node::is_element).collect();
    let [first, second] = points[..] else {
        let count = points.len();
        let why = if count < 2 {
            "it needs two"
        } else {
            "a cable of a robot file runs straight from its anchor to the platform and cannot be led over further \
             points"
        };
        bail!(xml.error(attachments, format!("cable \"{cable}\" has {count} attachments; {why}")));
    };

    let (mut base, mut platform, mut pulley) = (None, None, None);
    for node in [first, second] {
        let end = end(xml, node, cable, losses)?;
        pulley = end.pulley.or(pulley);
        let place = if end.is_platform { &mut platform } else { &mut base };
        if place.replace(end.point).is_some() {
            let both = if end.is_platform { "the platform" } else { "the base" };
            bail!(xml.error(
                node,
                format!(
                    "cable \"{cable}\" has both ends on {both}; it needs one end on the base and one on the platform"
                )
            ));
        }
    }

    let (Some(anchor_w), Some(attachment_p)) = (base, platform) else {
        bail!(xml.error(attachments, format!("cable \"{cable}\" does not run from the base to the platform")));
    };
    Ok(Ends { anchor_w, pulley, attachment_p })
}

/// End of a cable on the base, world frame, or on the platform, platform frame.
struct CasprEnd {
    is_platform: bool,
    point: Vec3,
    pulley: Option<DraftPulley>,
}

/// Reads one end of a cable.
fn end(xml: &Xml, node: Node, cable: &str, losses: &mut CasprLosses) -> Result<CasprEnd> {
    let on_base = |point: Vec3, pulley| CasprEnd { is_platform: false, point, pulley };
    Ok(match tag(node) {
        "attachment" => {
            let is_platform = is_on_platform(xml, node, cable)?;
            CasprEnd { is_platform, point: xml.child_vector(node, "location")?, pulley: None }
        }
        "base_rotating_pulley" => match rotating_pulley(xml, node)? {
            Some(pulley) => on_base(xml.child_vector(node, "fixed_location")?, Some(pulley)),
            None => on_base(losses.pulley(xml, node, cable, "fixed_location")?, None),
        },
        "screw_base_rotating_pulley" => on_base(losses.pulley(xml, node, cable, "constant_winch_point")?, None),
        other => bail!(xml.error(node, format!("<{other}> of cable \"{cable}\" is an unknown kind of attachment"))),
    })
}

/// True for an attachment at the only link, false for one at the base.
fn is_on_platform(xml: &Xml, attachment: Node, cable: &str) -> Result<bool> {
    let link = xml.required(attachment, "link")?;
    match link.text().unwrap_or_default().trim() {
        "0" => Ok(false),
        "1" => Ok(true),
        number => bail!(xml.error(
            link,
            format!("<link> of cable \"{cable}\" is `{}`; 0 is the base and 1 the only link", clean(number))
        )),
    }
}

/// Swivelling pulley at the base; `None` without a radius, or without the vector along which the cable enters.
fn rotating_pulley(xml: &Xml, node: Node) -> Result<Option<DraftPulley>> {
    let (Some(radius), Some(_)) = (xml.optional(node, "pulley_radius")?, xml.optional(node, "cable_entry_vector")?)
    else {
        return Ok(None);
    };
    let value = xml.number(radius)?;
    let entry_direction_w = xml.child_vector(node, "cable_entry_vector")?;
    if value <= 0.0 {
        bail!(xml.error(radius, format!("<pulley_radius> is {value} m, it must be positive")));
    }
    if entry_direction_w == Vec3::zeros() {
        bail!(xml.error(node, "<cable_entry_vector> has no length".to_owned()));
    }
    Ok(Some(DraftPulley { radius: value, entry_direction_w }))
}

/// Data of the cables that are not read, collected so that each kind is reported once. Only the fixed point of a pulley
/// with a screw is read.
#[derive(Default)]
struct CasprLosses {
    /// Names of cables that run over pulleys.
    cables: Vec<String>,
    radii: Vec<f64>,
    /// True if a cable has a `<diameter>`. Its unit is not documented, and files have values such as 0.367.
    diameters: bool,
}

impl CasprLosses {
    fn pulley(&mut self, xml: &Xml, node: Node, cable: &str, point: &str) -> Result<Vec3> {
        self.cables.push(cable.to_owned());
        if let Some(radius) = xml.optional(node, "pulley_radius")? {
            let radius = xml.number(radius)?;
            if !self.radii.contains(&radius) {
                self.radii.push(radius);
            }
        }
        xml.child_vector(node, point)
    }

    fn lost(&self) -> Vec<String> {
        let mut lost = Vec::new();
        if !self.cables.is_empty() {
            let radii: Vec<String> = self.radii.iter().map(f64::to_string).collect();
            lost.push(format!(
                "the pulleys at the base, of radius {} m, of the cables {}: each anchor is the pulley's fixed point",
                if radii.is_empty() { "unknown".to_owned() } else { radii.join(", ") },
                listed(&self.cables)
            ));
        }
        if self.diameters {
            lost.push("<diameter> of the cables: its unit is not stated".to_owned());
        }
        lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use funicular_study::request::SourceFile;

    #[test]
    fn an_infinite_limit_counts_as_none() {
        let file = SourceFile::decode("a.xml".into(), b"<p><a>Inf</a><b>-inf</b><c>5</c><d>x</d></p>").unwrap();
        let xml = Xml::parse(&file).unwrap();
        let of = |name| limit(&xml, xml.root(), name);
        assert_eq!(
            (of("a").unwrap(), of("b").unwrap(), of("c").unwrap(), of("e").unwrap()),
            (None, None, Some(5.0), None)
        );
        assert!(of("d").unwrap_err().to_string().contains("a.xml:1:33: <d> is `x`, which is not a number"));
    }
}
