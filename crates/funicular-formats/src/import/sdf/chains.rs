//! Cables that a model of SDF builds of links: a chain of joints from the frame to the platform, of which one slides.

use super::model::{SdfJoint, SdfModel};
use crate::import::draft::{DraftCable, DraftRope};
use crate::import::frames::inverse;
use anyhow::{Result, bail};
use funicular::math::Vec3;
use funicular_study::text::clean;
use std::collections::BTreeSet;

/// Cables in the order of their sliding joints. The anchor is where the chain's first joint is, the attachment where
/// its last one is.
pub(super) fn cables(model: &SdfModel) -> Result<Vec<DraftCable>> {
    let to_platform = inverse(&model.platform.pose);
    let mut cables = Vec::new();
    for slide in model.joints.iter().filter(|joint| joint.kind == "prismatic") {
        let chain = chain_of(model, slide);
        let end = |is_end: &dyn Fn(&str) -> bool| -> Vec<Vec3> {
            let joins = |joint: &&SdfJoint| {
                let pair = [(&joint.parent, &joint.child), (&joint.child, &joint.parent)];
                pair.iter().any(|(a, b)| is_end(a) && chain.contains(*b))
            };
            let mut places: Vec<Vec3> = model.joints.iter().filter(joins).map(|joint| joint.position_w).collect();
            places.dedup_by(|a, b| (*a - *b).norm() < 1e-9);
            places
        };
        let (anchors, attachments) = (end(&|link| model.is_fixed(link)), end(&|link| link == model.platform.name));
        let ([anchor_w], [attachment_w]) = (&anchors[..], &attachments[..]) else {
            bail!(model.xml.error(
                model.node,
                format!(
                    "the chain of the prismatic joint `{}` has {} ends on the frame and {} on the platform; a cable \
                     has one of each",
                    clean(&slide.name),
                    anchors.len(),
                    attachments.len()
                )
            ));
        };
        cables.push(DraftCable {
            name: clean(&slide.name),
            anchor_w: *anchor_w,
            attachment_p: to_platform.point_w(attachment_w),
            rope: DraftRope::default(),
            limits: [None, None],
            unstrained_length: None,
            pulley: None,
            winch: None,
        });
    }
    Ok(cables)
}

/// Links that joints connect with a sliding joint, without the frame and the platform.
fn chain_of(model: &SdfModel, slide: &SdfJoint) -> BTreeSet<String> {
    let is_end = |link: &str| model.is_fixed(link) || link == model.platform.name;
    let mut chain = BTreeSet::new();
    let mut open = vec![slide.parent.clone(), slide.child.clone()];
    while let Some(link) = open.pop() {
        if is_end(&link) || !chain.insert(link.clone()) {
            continue;
        }
        for joint in &model.joints {
            if joint.parent == link {
                open.push(joint.child.clone());
            } else if joint.child == link {
                open.push(joint.parent.clone());
            }
        }
    }
    chain
}
