//! CASPR's file of cables, of which one set is read.

use crate::import::draft::{DraftCable, DraftPulley, DraftRope, listed};
use crate::import::xml::{Xml, children, tag};
use crate::text::clean;
use anyhow::{Result, bail};
use funicular::math::Vec3;
use funicular::suggest::nearest;
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

/// Chooses the set to read.
fn chosen<'n, 'a>(
    xml: &Xml<'a>,
    sets: &[Node<'n, 'a>],
    ids: &[String],
    requested: Option<&str>,
) -> Result<Node<'n, 'a>> {
    let root = xml.root();
    let (name, whose) = match (requested, root.attribute("default_cable_set").map(str::trim)) {
        (Some(name), _) => (name, "⟪cable_set⟫"),
        (None, Some(name)) if !name.is_empty() => (name, "default_cable_set"),
        _ => match sets {
            [only] => return Ok(*only),
            [] => bail!(xml.error(root, "<cables> has no <cable_set>")),
            _ => bail!(xml.error(
                root,
                format!(
                    "the file has several sets and no default_cable_set; choose one with ⟪cable_set⟫: {}",
                    listed(ids)
                )
            )),
        },
    };
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
                    "{whose} names the set \"{}\", which does not exist: {near}the file has {}",
                    clean(name),
                    listed(ids)
                )
            ))
        }
    }
}

fn read_cable(xml: &Xml, node: Node, center_of_mass_p: &Vec3, losses: &mut CasprLosses) -> Result<DraftCable> {
    let name = clean(node.attribute("name").unwrap_or_default());
    let has_stiffness = match tag(node) {
        "cable_ideal" => false,
        "cable_linear_spring" => true,
        other => {
            let why = match other {
                "cable_passive_linear_spring" => "a passive spring, which a robot file cannot hold",
                "cable_vsd_torsion_spring" | "cable_vsd_flexure_linear" | "cable_vsd_polynomial" => {
                    "a cable in series with a device of variable stiffness, which a robot file cannot hold"
                }
                "muscle_hill_type" | "pneumatic_artificial_muscle" => "a muscle, which a robot file cannot hold",
                _ => "of an unknown kind",
            };
            bail!(xml.error(
                node,
                format!("<{other}> \"{name}\" is {why}; cables are <cable_ideal> and <cable_linear_spring>")
            ));
        }
    };
    let from_center =
        match node.attribute("attachment_reference").map(str::trim) {
            Some("joint") => false,
            Some("com") => true,
            Some(other) => bail!(xml.error(
                node,
                format!(
                    "attribute `attachment_reference` of cable \"{name}\" is `{}`, it must be joint or com",
                    clean(other)
                )
            )),
            None => bail!(xml.error(
                node,
                format!("cable \"{name}\" has no attribute `attachment_reference`, it must be joint or com")
            )),
        };
    let mut rope = DraftRope::default();
    let mut limits = [None; 2];
    if let Some(properties) = xml.optional(node, "properties")? {
        limits = [limit(xml, properties, "force_min")?, limit(xml, properties, "force_max")?];
        losses.diameters |= xml.optional(properties, "diameter")?.is_some();
    }
    if has_stiffness {
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
    Ok(DraftCable { name, anchor_w, attachment_p, rope, limits, unstrained_length: None, pulley })
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
    let mut base = None;
    let mut platform = None;
    let mut pulley = None;
    for node in [first, second] {
        let (is_platform, point) = match tag(node) {
            "attachment" => {
                let link = xml.required(node, "link")?;
                let number = link.text().unwrap_or_default().trim();
                let Some(is_platform) = (match number {
                    "0" => Some(false),
                    "1" => Some(true),
                    _ => None,
                }) else {
                    let shown = clean(number);
                    let message =
                        format!("<link> of cable \"{cable}\" is `{shown}`; 0 is the base and 1 the only link");
                    bail!(xml.error(link, message));
                };
                (is_platform, xml.child_vector(node, "location")?)
            }
            "base_rotating_pulley" => {
                pulley = rotating_pulley(xml, node)?;
                let point = match pulley {
                    Some(_) => xml.child_vector(node, "fixed_location")?,
                    None => losses.pulley(xml, node, cable, "fixed_location")?,
                };
                (false, point)
            }
            "screw_base_rotating_pulley" => (false, losses.pulley(xml, node, cable, "constant_winch_point")?),
            other => bail!(xml.error(node, format!("<{other}> of cable \"{cable}\" is an unknown kind of attachment"))),
        };
        let end = if is_platform { &mut platform } else { &mut base };
        if end.replace(point).is_some() {
            let both = if is_platform { "the platform" } else { "the base" };
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
    use crate::request::SourceFile;

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
