//! Names of faults, and sentences about them.

use crate::text::significant;
use funicular::estimation::{FaultHypothesis, FaultKind};

/// Name of a kind of fault.
pub(super) fn fault_name(kind: FaultKind) -> &'static str {
    match kind {
        FaultKind::Slip => "slip",
        FaultKind::LoadCell => "load-cell",
        FaultKind::Payload => "payload",
        FaultKind::Wrench => "force",
        FaultKind::Cut => "cut",
        FaultKind::Stuck => "stuck",
    }
}

/// Sentence about a fault.
pub(super) fn fault<'a>(of: &FaultHypothesis, name: impl Fn(usize) -> &'a str) -> String {
    let cable = of.cable.map_or("", name);
    let sized = |factor: f64, unit: &str| {
        format!("{} ± {} {unit}", significant(factor * of.size, 3), significant(factor * of.std, 2))
    };
    match of.kind {
        FaultKind::Slip => {
            format!("cable {cable} became longer unseen, a slipped drum or encoder: {}", sized(1e3, "mm"))
        }
        FaultKind::LoadCell => format!("the load cell of cable {cable} stepped by {}", sized(1.0, "N")),
        FaultKind::Payload => format!("the payload changed by {}", sized(1.0, "kg")),
        FaultKind::Wrench => format!("an external force changed, along z by {}", sized(1.0, "N")),
        FaultKind::Cut => {
            format!("cable {cable} has no tension any more: cut, or slipped by {} or more", sized(1e3, "mm"))
        }
        FaultKind::Stuck => format!("the load cell of cable {cable} repeats one reading"),
    }
}
