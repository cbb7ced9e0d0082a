//! Where cables are cut into elements, so that C is smooth on each.

use crate::cable::exact::mesh::{ellipse, has_tension};
use crate::catenary::Catenary;

/// Smallest Bernstein ellipse of an element: see [`ellipse`]. What [`GROWTH`] leaves is larger.
const SMOOTH_ENOUGH: f64 = 2.4;

/// Length of an element over the distance of its nearer end from where C is singular.
const GROWTH: f64 = 2.5;

/// Elements of cables side by side, as many of each.
pub(super) struct Mesh {
    /// Of each cable: ends of its elements from start to end [m].
    pub(super) nodes: Vec<Vec<f64>>,
    /// Components of its axis e along the horizontal and up.
    pub(super) axes: Vec<[f64; 2]>,
    /// Number of the node at which cables are slackest; 0 with one element.
    pub(super) kept: usize,
    /// The smallest Bernstein ellipse.
    pub(super) size: f64,
}

impl Mesh {
    /// None if a cable has no tension somewhere.
    pub(super) fn of(cables: &[(&Catenary, f64)]) -> Option<Self> {
        if !cables.iter().all(|(catenary, _)| has_tension(catenary)) {
            return None;
        }
        let ends = |catenary: &Catenary| vec![0.0, catenary.rope().unstrained_length];
        let mut mesh = Self {
            nodes: cables.iter().map(|(catenary, _)| ends(catenary)).collect(),
            axes: cables.iter().map(|(catenary, _)| catenary.chord_direction()).collect(),
            kept: 0,
            size: f64::INFINITY,
        };
        mesh.measure(cables);
        if mesh.size < SMOOTH_ENOUGH {
            let cuts: Vec<Cut> = cables.iter().map(|(catenary, _)| Cut::of(catenary)).collect();
            let counts = cuts.iter().map(Cut::counts).fold([0; 2], |a, b| [a[0].max(b[0]), a[1].max(b[1])]);
            // The lowest point of a slack cable swings level.
            for (axis, _) in mesh.axes.iter_mut().zip(&cuts).filter(|(_, cut)| cut.slack) {
                *axis = [0.0, 1.0];
            }
            mesh.nodes = cuts.into_iter().map(|cut| cut.refined(counts).nodes()).collect();
            mesh.kept = counts[0];
            mesh.measure(cables);
        }
        Some(mesh)
    }

    fn measure(&mut self, cables: &[(&Catenary, f64)]) {
        let of_element =
            |catenary: &Catenary, pair: &[f64]| ellipse(catenary, 0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
        let of_cable = |(nodes, (catenary, _)): (&Vec<f64>, &(&Catenary, f64))| {
            nodes.windows(2).map(|pair| of_element(catenary, pair)).fold(f64::INFINITY, f64::min)
        };
        self.size = self.nodes.iter().zip(cables).map(of_cable).fold(f64::INFINITY, f64::min);
    }
}

/// Two sides of a point at which the cable is slackest, each cut from there on.
#[derive(Debug, Clone)]
struct Cut {
    /// That point [m].
    middle: f64,
    /// Distances from it to the ends of elements on the side of the start and of the end, ascending [m].
    sides: [Vec<f64>; 2],
    /// Cut as its shape asks for; otherwise one element would do.
    slack: bool,
}

impl Cut {
    fn of(catenary: &Catenary) -> Self {
        let rope = catenary.rope();
        let (length, w) = (rope.unstrained_length, rope.weight_per_length);
        if ellipse(catenary, 0.5 * length, 0.5 * length) >= SMOOTH_ENOUGH {
            return Self { middle: 0.5 * length, sides: [vec![0.5 * length], vec![0.5 * length]], slack: false };
        }
        // C is singular at lowest ± i depth.
        let (lowest, depth) = (-catenary.vertical_force_at_start() / w, catenary.horizontal_force() / w);
        let distance = |s: f64| (s - lowest).hypot(depth);
        // An element much shorter than this distance would be stiff for nothing.
        let middle = if lowest < depth {
            (GROWTH * distance(0.0)).min(0.5 * length)
        } else if length - lowest < depth {
            (length - GROWTH * distance(length)).max(0.5 * length)
        } else {
            lowest
        };
        let side = |whole: f64, sign: f64| {
            let mut ends = Vec::new();
            let mut at = 0.0;
            while at < whole {
                let next = at + GROWTH * distance(middle + sign * at);
                // A short last element is as good as none.
                at = if next > 0.8 * whole { whole } else { next };
                ends.push(at);
            }
            ends
        };
        Self { middle, sides: [side(middle, -1.0), side(length - middle, 1.0)], slack: true }
    }

    /// Elements on each side.
    fn counts(&self) -> [usize; 2] {
        self.sides.each_ref().map(Vec::len)
    }

    /// With so many elements on each side, the longest being halved.
    fn refined(mut self, counts: [usize; 2]) -> Self {
        for (ends, count) in self.sides.iter_mut().zip(counts) {
            while ends.len() < count {
                let from = |k: usize| if k == 0 { 0.0 } else { ends[k - 1] };
                let longest = (0..ends.len()).max_by(|&i, &j| (ends[i] - from(i)).total_cmp(&(ends[j] - from(j))));
                let k = longest.expect("a side has an element");
                ends.insert(k, 0.5 * (from(k) + ends[k]));
            }
        }
        self
    }

    /// All nodes from start to end [m].
    fn nodes(&self) -> Vec<f64> {
        let [before, after] = &self.sides;
        let before = before.iter().rev().map(|distance| self.middle - distance);
        before.chain([self.middle]).chain(after.iter().map(|distance| self.middle + distance)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catenary::Rope;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_element_of_a_slack_cable_is_smooth(
            span in -8.0f64..0.5, rise in -6.0f64..6.0, slack in 1.001f64..3.0, more in prop::array::uniform2(0usize..4),
        ) {
            let span = 10f64.powf(span);
            let rope = Rope {
                unstrained_length: slack * span.hypot(rise).max(0.1),
                weight_per_length: 0.6,
                axial_stiffness: 1e5,
            };
            let catenary = Catenary::between(span, rise, rope).unwrap();
            let cut = Cut::of(&catenary);
            let counts = cut.counts();
            let nodes = cut.refined([counts[0] + more[0], counts[1] + more[1]]).nodes();
            prop_assert_eq!(nodes.len(), counts[0] + counts[1] + more[0] + more[1] + 1);
            prop_assert!(nodes[0].abs() < 1e-12 * rope.unstrained_length);
            prop_assert!((nodes[nodes.len() - 1] / rope.unstrained_length - 1.0).abs() < 1e-12);
            for pair in nodes.windows(2) {
                let size = ellipse(&catenary, 0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
                prop_assert!(size > 0.95 * SMOOTH_ENOUGH, "{size} at {pair:?}");
            }
        }
    }
}
