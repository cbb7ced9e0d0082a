//! Division of cables into elements, so that C is smooth on each.

use crate::cable::catenary_dynamic::{ellipse, has_tension};
use crate::catenary::Catenary;

/// Minimum size of the Bernstein ellipse of an element, see [`ellipse`]. The elements that [`GROWTH`] gives have larger
/// ones.
const SMOOTH_ENOUGH: f64 = 2.4;

/// Ratio of the length of an element to the distance of its nearer end from the singularity of C.
const GROWTH: f64 = 2.5;

/// Elements of a cable, which grow with the distance from its lowest point.
#[derive(Debug, Clone)]
pub(super) struct GradedMesh {
    /// Ends of the elements from start to end [m].
    pub(super) nodes: Vec<f64>,
    /// Components of the cable's axis e along the horizontal and up: along the chord, or vertical with several
    /// elements.
    pub(super) axis: [f64; 2],
    /// Number of the node with the lowest tension; 0 with one element.
    pub(super) kept: usize,
    /// Size of the smallest Bernstein ellipse.
    pub(super) size: f64,
}

impl GradedMesh {
    /// Elements of a cable; `None` if a point of it has no tension.
    pub(super) fn of(catenary: &Catenary) -> Option<Self> {
        if !has_tension(catenary) {
            return None;
        }
        let length = catenary.rope().unstrained_length;
        let size = ellipse(catenary, 0.5 * length, 0.5 * length);
        if size >= SMOOTH_ENOUGH {
            return Some(Self { nodes: vec![0.0, length], axis: catenary.chord_direction(), kept: 0, size });
        }
        let (nodes, kept) = graded_nodes(catenary);
        let of_element = |pair: &[f64]| ellipse(catenary, 0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
        let size = nodes.windows(2).map(of_element).fold(f64::INFINITY, f64::min);
        // The lowest point of a slack cable moves horizontally.
        Some(Self { nodes, axis: [0.0, 1.0], kept, size })
    }
}

/// Elements that grow to both sides of the point of lowest tension: all nodes from start to end [m], and the number of
/// the node at that point.
fn graded_nodes(catenary: &Catenary) -> (Vec<f64>, usize) {
    let rope = catenary.rope();
    let (length, w) = (rope.unstrained_length, rope.weight_per_length);
    // C is singular at lowest ± i depth.
    let (lowest, depth) = (-catenary.vertical_force_at_start() / w, catenary.horizontal_force() / w);

    let distance = |s: f64| (s - lowest).hypot(depth);

    // An element much shorter than this distance would only add stiffness, so the lowest point may lie inside the
    // outermost element.
    let outermost = |end: f64| if (0.0..length).contains(&lowest) { 2.0 * depth } else { GROWTH * distance(end) };
    let middle = if lowest < depth {
        outermost(0.0).min(0.5 * length)
    } else if length - lowest < depth {
        (length - outermost(length)).max(0.5 * length)
    } else {
        lowest
    };

    // Elements to both sides.
    let side = |total: f64, sign: f64| {
        let mut ends = Vec::new();
        let mut at = 0.0;
        while at < total {
            let next = at + GROWTH * distance(middle + sign * at);
            // A short last element is merged with the one before it.
            at = if next > 0.8 * total { total } else { next };
            ends.push(at);
        }
        ends
    };

    let [before, after] = [side(middle, -1.0), side(length - middle, 1.0)];
    let kept = before.len();
    let before = before.into_iter().rev().map(|distance| middle - distance);
    (before.chain([middle]).chain(after.into_iter().map(|distance| middle + distance)).collect(), kept)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catenary::Rope;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..Default::default() })]

        #[test]
        fn every_element_of_a_slack_cable_is_smooth(
            span in -8.0f64..0.5, rise in -6.0f64..6.0, slack in 1.001f64..3.0,
        ) {
            let span = 10f64.powf(span);
            let rope = Rope {
                unstrained_length: slack * span.hypot(rise).max(0.1),
                weight_per_length: 0.6,
                axial_stiffness: 1e5,
            };
            let catenary = Catenary::between(span, rise, rope).unwrap();
            let Some(GradedMesh { nodes, kept, .. }) = GradedMesh::of(&catenary) else { return Ok(()) };
            if kept == 0 {
                prop_assert_eq!(nodes.len(), 2);
                return Ok(());
            }

            prop_assert!(0 < kept && kept < nodes.len() - 1);
            prop_assert!(nodes[0].abs() < 1e-12 * rope.unstrained_length);
            prop_assert!((nodes[nodes.len() - 1] / rope.unstrained_length - 1.0).abs() < 1e-12);
            for pair in nodes.windows(2) {
                let size = ellipse(&catenary, 0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
                prop_assert!(size > 0.95 * SMOOTH_ENOUGH, "{size} at {pair:?}");
            }
        }
    }
}
