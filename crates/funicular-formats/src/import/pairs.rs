//! Cables from points that are named in pairs: `anchor_NAME` on the frame and `attachment_NAME` on the platform.

use super::draft::{DraftCable, DraftRope};
use funicular::math::Vec3;
use funicular_study::text::clean;

/// Named point of a file of links.
pub(super) struct PointOfPair {
    pub(super) name: String,
    /// Place in the world for a point of the frame, in the platform frame for one of the platform [m].
    pub(super) position: Vec3,
    pub(super) is_on_platform: bool,
}

/// Name of the cable of a point, if its name begins with a word and a separator.
fn cable_of<'a>(name: &'a str, word: &str) -> Option<&'a str> {
    name.strip_prefix(word)?.strip_prefix(['_', ':', '-', '/']).filter(|rest| !rest.is_empty())
}

/// Cables in the order of their anchors.
///
/// # Errors
/// The name of a point without its partner.
pub(super) fn cables(points: &[PointOfPair]) -> Result<Vec<DraftCable>, String> {
    let of = |word: &'static str, is_on_platform: bool| {
        let named = points.iter().filter(move |point| point.is_on_platform == is_on_platform);
        named.filter_map(move |point| Some((cable_of(&point.name, word)?, point.position)))
    };
    for (word, is_on_platform, other) in [("anchor", false, "attachment"), ("attachment", true, "anchor")] {
        let alone = of(word, is_on_platform).find(|(name, _)| !of(other, !is_on_platform).any(|(of, _)| of == *name));
        if let Some((name, _)) = alone {
            let (name, side) = (clean(name), if is_on_platform { "the frame" } else { "the platform" });
            return Err(format!("`{word}_{name}` has no partner `{other}_{name}` on {side}"));
        }
    }
    let cable = |(name, anchor_w): (&str, Vec3)| {
        let (_, attachment_p) = of("attachment", true).find(|(other, _)| *other == name)?;
        Some(DraftCable {
            name: clean(name),
            anchor_w,
            attachment_p,
            rope: DraftRope::default(),
            limits: [None, None],
            unstrained_length: None,
            pulley: None,
            winch: None,
        })
    };
    Ok(of("anchor", false).filter_map(cable).collect())
}
