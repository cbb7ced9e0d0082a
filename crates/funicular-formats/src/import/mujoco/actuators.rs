//! Actuators of tendons in models of MuJoCo: springs whose rest length is commanded, and limits of forces.

use super::options::MujocoOptions;
use crate::import::draft::{DraftCable, listed};
use crate::import::xml::{Xml, children, tag};
use anyhow::Result;
use funicular_study::text::clean;
use roxmltree::Node;

/// Spring along a tendon.
#[derive(Debug, Clone, Copy)]
pub(super) struct TendonSpring {
    /// Stiffness [N/m].
    pub(super) stiffness: f64,
    /// Length of the tendon without tension [m].
    pub(super) rest_length: f64,
    /// Axial stiffness EA of the rope [N], where `funicular export` wrote it as the limit of the force.
    pub(super) axial_stiffness: Option<f64>,
}

/// Actuators of a tendon.
fn of_tendon<'n>(root: Node<'n, 'n>, tendon: &str) -> impl Iterator<Item = Node<'n, 'n>> {
    let all = children(root, "actuator").flat_map(|section| section.children().filter(Node::is_element));
    all.filter(move |of| of.attribute("tendon") == Some(tendon))
}

/// Spring of an actuator whose force is `k (L₀ + u − L)`.
pub(super) fn spring<'n>(xml: &'n Xml<'n>, options: &MujocoOptions<'n>, tendon: &str) -> Result<Option<TendonSpring>> {
    let root: Node<'n, 'n> = xml.root();
    for node in of_tendon(root, tendon).filter(|node| tag(*node) == "general") {
        let numbers = |name: &str| options.numbers(xml, node, "general", name);
        if options.attribute(node, "general", "biastype").map(|(_, text)| text) != Some("affine") {
            continue;
        }
        let (Some(gain), Some(bias)) = (numbers("gainprm")?, numbers("biasprm")?) else { continue };
        let ([stiffness, ..], [force, minus_stiffness, ..]) = (&gain[..], &bias[..]) else { continue };
        if *stiffness <= 0.0 || (stiffness + minus_stiffness).abs() > 1e-9 * stiffness || *force <= 0.0 {
            continue;
        }
        let is_ours = node.attribute("name").is_some_and(|name| name.strip_prefix("length:") == Some(tendon));
        let limit = numbers("forcerange")?.filter(|_| is_ours).and_then(|range| range.first().map(|low| -low));
        return Ok(Some(TendonSpring {
            stiffness: *stiffness,
            rest_length: force / stiffness,
            axial_stiffness: limit.filter(|stiffness| *stiffness > 0.0),
        }));
    }
    Ok(None)
}

/// Smallest and largest tension that an actuator of forces allows [N].
pub(super) fn limits<'n>(xml: &'n Xml<'n>, options: &MujocoOptions<'n>, tendon: &str) -> Result<[Option<f64>; 2]> {
    let root: Node<'n, 'n> = xml.root();
    for node in of_tendon(root, tendon) {
        let kind = tag(node);
        let numbers = |name: &str| options.numbers(xml, node, kind, name);
        let bias = options.attribute(node, kind, "biastype").map_or("none", |(_, text)| text);
        let gain = match kind {
            "motor" => 1.0,
            "general" if bias == "none" => numbers("gainprm")?.and_then(|gain| gain.first().copied()).unwrap_or(1.0),
            _ => continue,
        };
        let gear = numbers("gear")?.and_then(|gear| gear.first().copied()).unwrap_or(1.0);
        // A tendon pulls with a negative force.
        let tensions = |range: Option<Vec<f64>>, factor: f64| match range.as_deref() {
            Some([low, high]) if low < high => {
                let (a, b) = (-low * factor, -high * factor);
                Some([a.min(b), a.max(b)])
            }
            _ => None,
        };
        let ranges = [tensions(numbers("ctrlrange")?, gain * gear), tensions(numbers("forcerange")?, gear)];
        let low = ranges.iter().flatten().map(|range| range[0]).fold(0.0, f64::max);
        let high = ranges.iter().flatten().map(|range| range[1]).fold(f64::INFINITY, f64::min);
        return Ok([Some(low).filter(|low| *low > 0.0), Some(high).filter(|high| high.is_finite() && *high > 0.0)]);
    }
    Ok([None, None])
}

/// Actuators that do not act on a cable, such as dead loads.
pub(super) fn lost(root: Node, cables: &[DraftCable]) -> Option<String> {
    let all = children(root, "actuator").flat_map(|section| section.children().filter(Node::is_element));
    let acts =
        |node: &Node| node.attribute("tendon").is_some_and(|of| cables.iter().any(|cable| cable.name == clean(of)));
    let names: Vec<String> =
        all.filter(|node| !acts(node)).map(|node| clean(node.attribute("name").unwrap_or_else(|| tag(node)))).collect();
    (!names.is_empty()).then(|| format!("the actuators {}: loads or drives that are not cables", listed(&names)))
}
