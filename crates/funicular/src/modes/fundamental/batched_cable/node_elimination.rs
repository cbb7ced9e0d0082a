//! Cables of several elements: elements of all cables are computed side by side, nodes cable by cable.

use super::element::ElementBatch;
use super::element_integrals::place;
use super::end_elimination::CableEnd;
use super::mesh::GradedMesh;
use super::{IN_PLANE, KeptStiffness, OUT_OF_PLANE};
use crate::math::Matrix;
use crate::math::simd::{LANES, Lane, Lanes};

/// Elements of one cable, and the elimination of its nodes at the last frequency.
#[derive(Debug, Clone)]
pub(super) struct ElementChain {
    /// Number of its first element among those of all chains.
    first: usize,
    /// Number of its elements.
    elements: usize,
    /// Number of the node that is kept besides the platform end, which is node 0.
    kept: usize,
    in_plane: Nodes<2>,
    out_of_plane: Nodes<1>,
    /// Stiffness of the kept unknowns against the unknown e of the kept node, and the inverse of its pivot.
    level: ([f64; IN_PLANE], f64),
}

impl ElementChain {
    pub(super) fn new(mesh: &GradedMesh, first: usize) -> Self {
        Self {
            first,
            elements: mesh.nodes.len() - 1,
            kept: mesh.kept,
            in_plane: Nodes::default(),
            out_of_plane: Nodes::default(),
            level: ([0.0; IN_PLANE], 0.0),
        }
    }

    /// Eliminates the nodes between elements that are already condensed onto their ends, and sets a lane of `into`. The
    /// far end may move; its motions are eliminated first.
    fn condense(
        &mut self,
        (packs, min_pivots): (&[ElementBatch], &[Lane]),
        mut far_end: Option<&mut CableEnd>,
        x: f64,
        lane: usize,
        into: &mut KeptStiffness,
    ) {
        let mut min_pivot = self.of(min_pivots).fold(f64::INFINITY, f64::min);

        let entry = |factor: fn(&ElementBatch) -> &Lanes, e: usize, row: usize, column: usize| {
            let at = self.first + e;
            factor(&packs[at / LANES])[place(row.max(column), row.min(column))][at % LANES]
        };
        let in_plane = |e: usize, row: usize, column: usize| entry(|element| &element.in_plane_factor, e, row, column);
        let out_of_plane =
            |e: usize, row: usize, column: usize| entry(|element| &element.out_of_plane_factor, e, row, column);

        // The far end, onto the near end of the last element.
        let last = self.elements - 1;
        if let Some(end) = &mut far_end {
            let (plane, out) = end.families_mut();
            plane.condense(x, |row, column| in_plane(last, row, column), &mut min_pivot);
            out.condense(x, |row, column| out_of_plane(last, row, column), &mut min_pivot);
        }
        let families = far_end.as_deref().map(CableEnd::families);
        let in_plane = |e: usize, row: usize, column: usize| match families {
            Some((plane, _)) if e == last && row.max(column) < 2 => plane.at(row, column),
            _ => in_plane(e, row, column),
        };
        let out_of_plane = |e: usize, row: usize, column: usize| match families {
            Some((_, out)) if e == last && row.max(column) < 1 => out.at(row, column),
            _ => out_of_plane(e, row, column),
        };

        // In plane; the unknown e of the kept node is eliminated last.
        let [own, between, kept] = self.in_plane.eliminate(in_plane, self.elements, self.kept, &mut min_pivot);
        let pivot = kept[(1, 1)];
        min_pivot = if pivot < min_pivot { pivot } else { min_pivot };
        let level = [between[(0, 1)], between[(1, 1)], kept[(0, 1)]];
        self.level = (level, 1.0 / pivot);
        let all = [own[(0, 0)], own[(1, 0)], own[(1, 1)], between[(0, 0)], between[(1, 0)], kept[(0, 0)]];
        for row in 0..IN_PLANE {
            for column in 0..=row {
                let at = place(row, column);
                into.in_plane[at][lane] = all[at] - level[row] * level[column] / pivot;
            }
        }

        // Out of plane.
        let all = self.out_of_plane.eliminate(out_of_plane, self.elements, self.kept, &mut min_pivot);
        for (into, k) in into.out_of_plane.iter_mut().zip(all) {
            into[lane] = k[(0, 0)];
        }

        into.min_pivot[lane] = min_pivot;
    }

    /// Sets the motion of the elements' ends from the motion of the kept unknowns, which all nodes follow, and appends
    /// the motion of the unknowns at the far end.
    fn spread(
        &self,
        in_plane: [f64; IN_PLANE],
        out_of_plane: [f64; OUT_OF_PLANE],
        ends: &mut [ElementEnds],
        far_end: Option<(&CableEnd, &mut Vec<f64>)>,
    ) {
        let [n, e, q] = in_plane;
        let (level, inverse) = self.level;
        let level = -inverse * (level[0] * n + level[1] * e + level[2] * q);
        let in_plane = self.in_plane.follow([n, e].into(), [q, level].into(), self.elements, self.kept);
        let out_of_plane =
            self.out_of_plane.follow([out_of_plane[0]].into(), [out_of_plane[1]].into(), self.elements, self.kept);
        for (node, (in_plane, out_of_plane)) in in_plane.iter().zip(&out_of_plane).enumerate() {
            // A node is the second end of one element and the first end of the next.
            for (element, side) in [(node.checked_sub(1), 1), (Some(node), 0)] {
                let Some(element) = element else { continue };
                self.set(element, side, [in_plane[0], in_plane[1], out_of_plane[0]], ends);
            }
        }

        // An anchor does not move, unless it is the end at a drive.
        if let (Some((end, unknowns)), Some(in_plane), Some(out_of_plane)) =
            (far_end, in_plane.last(), out_of_plane.last())
        {
            let moved = end.follow_node([in_plane[0], in_plane[1]], [out_of_plane[0]], unknowns);
            self.set(self.elements - 1, 1, moved, ends);
        }
    }

    /// Sets the motion (n, e, b) of one side of an element.
    fn set(&self, element: usize, side: usize, [n, e, b]: [f64; 3], ends: &mut [ElementEnds]) {
        let at = self.first + element;
        let ends = &mut ends[at / LANES];
        ends.in_plane[2 * side][at % LANES] = n;
        ends.in_plane[2 * side + 1][at % LANES] = e;
        ends.out_of_plane[side][at % LANES] = b;
    }

    /// Values of the chain's elements, from the values of all packs.
    fn of(&self, packs: &[Lane]) -> impl Iterator<Item = f64> {
        (self.first..self.first + self.elements).map(|at| packs[at / LANES][at % LANES])
    }
}

/// Motion of both ends of elements side by side.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ElementEnds {
    pub(super) in_plane: [Lane; 4],
    pub(super) out_of_plane: [Lane; 2],
}

/// Elimination of all nodes of a chain except two, with D unknowns per node.
#[derive(Debug, Clone, Default)]
struct Nodes<const D: usize> {
    /// Inverse pivot of each eliminated node.
    inverse: Vec<Block<D>>,
    /// Stiffness of each node (rows) against the next (columns).
    next: Vec<Block<D>>,
    /// Stiffness of the platform end against each node up to the kept one.
    end: Vec<Block<D>>,
}

type Block<const D: usize> = Matrix<D, D>;
type Column<const D: usize> = Matrix<D, 1>;

impl<const D: usize> Nodes<D> {
    /// Eliminates the nodes from the stiffness `entry(element, row, column)` of condensed elements. The results are the
    /// blocks of the platform end, of the platform end against the kept node, and of the kept node.
    fn eliminate(
        &mut self,
        entry: impl Fn(usize, usize, usize) -> f64,
        elements: usize,
        kept: usize,
        min_pivot: &mut f64,
    ) -> [Block<D>; 3] {
        let block =
            |e: usize, row: usize, column: usize| Block::<D>::from_fn(|i, j| entry(e, row * D + i, column * D + j));

        // Block tridiagonal matrix of the chain: nodes on the diagonal, neighbours beside it.
        let Self { inverse, next, end } = self;
        let mut own: Vec<Block<D>> = (0..elements).map(|e| block(e, 0, 0)).collect();
        for (e, own) in own.iter_mut().enumerate().skip(1) {
            *own += block(e - 1, 1, 1);
        }
        next.clear();
        next.extend((0..elements - 1).map(|e| block(e, 0, 1)));

        inverse.clear();
        inverse.resize(elements, Block::zeros());

        // From the anchor towards the kept node.
        for node in (kept + 1..elements).rev() {
            inverse[node] = inverted(&own[node], min_pivot);
            let before = next[node - 1];
            own[node - 1] -= before * inverse[node] * before.transpose();
        }

        // From the platform towards the kept node.
        end.clear();
        end.extend([Block::zeros(), next[0]]);
        for node in 1..kept {
            inverse[node] = inverted(&own[node], min_pivot);
            let (to_end, to_next) = (end[node] * inverse[node], next[node].transpose() * inverse[node]);
            own[0] -= to_end * end[node].transpose();
            own[node + 1] -= to_next * next[node];
            end.push(-to_end * next[node]);
        }
        [own[0], end[kept], own[kept]]
    }

    /// Motion of all nodes from that of the platform end and the kept node.
    fn follow(&self, platform: Column<D>, at_kept: Column<D>, elements: usize, kept: usize) -> Vec<Column<D>> {
        let mut all = vec![Column::zeros(); elements];
        (all[0], all[kept]) = (platform, at_kept);
        for node in (1..kept).rev() {
            all[node] = -self.inverse[node] * (self.end[node].transpose() * platform + self.next[node] * all[node + 1]);
        }
        for node in kept + 1..elements {
            all[node] = -self.inverse[node] * self.next[node - 1].transpose() * all[node - 1];
        }
        all
    }
}

/// Inverse of a symmetric block with one or two rows, by elimination of the last unknown and then the first.
fn inverted<const D: usize>(block: &Block<D>, min_pivot: &mut f64) -> Block<D> {
    let mut note = |pivot: f64| {
        *min_pivot = if pivot < *min_pivot { pivot } else { *min_pivot };
        1.0 / pivot
    };
    let last = D - 1;
    let inverse = note(block[(last, last)]);
    if D == 1 {
        return Block::repeat(inverse);
    }
    let factor = block[(0, last)] * inverse;
    let first = note(block[(0, 0)] - factor * block[(0, last)]);
    Block::from_fn(|i, j| match i + j {
        0 => first,
        1 => -factor * first,
        _ => inverse + factor * factor * first,
    })
}

/// Stiffness of the kept unknowns of chains whose elements are condensed onto their ends, at x = ω². `far_ends` is
/// empty if all of them are held.
pub(super) fn condense(
    chains: &mut [ElementChain],
    far_ends: &mut [CableEnd],
    packs: &[ElementBatch],
    x: f64,
    min_pivots: &[Lane],
) -> KeptStiffness {
    let mut kept = KeptStiffness::default();
    // In lanes without a cable the pivots must not be zero.
    (kept.in_plane[5], kept.out_of_plane[2]) = ([1.0; LANES], [1.0; LANES]);
    for (lane, chain) in chains.iter_mut().enumerate() {
        chain.condense((packs, min_pivots), far_ends.get_mut(lane), x, lane, &mut kept);
    }
    kept
}

/// Motions of the ends of packs of elements, which follow those of the kept unknowns of chains, and motions of the
/// unknowns at their far ends.
pub(super) fn ends(
    chains: &[ElementChain],
    far_ends: &[CableEnd],
    packs: usize,
    in_plane: &[Lane; IN_PLANE],
    out_of_plane: &[Lane; OUT_OF_PLANE],
) -> (Vec<ElementEnds>, Vec<f64>) {
    let (mut ends, mut unknowns) = (vec![ElementEnds::default(); packs], Vec::new());
    for (lane, chain) in chains.iter().enumerate() {
        let (in_plane, out_of_plane) = (in_plane.map(|values| values[lane]), out_of_plane.map(|values| values[lane]));
        let far_end = far_ends.get(lane).map(|end| (end, &mut unknowns));
        chain.spread(in_plane, out_of_plane, &mut ends, far_end);
    }
    (ends, unknowns)
}

/// Sums over the elements of each chain, from the values of all packs.
pub(super) fn sums(chains: &[ElementChain], of_packs: &[[Lane; 2]]) -> [Lane; 2] {
    let mut sums = [[0.0; LANES]; 2];
    for (component, sums) in sums.iter_mut().enumerate() {
        let of_packs: Vec<Lane> = of_packs.iter().map(|both| both[component]).collect();
        for (sum, chain) in sums.iter_mut().zip(chains) {
            *sum = chain.of(&of_packs).sum();
        }
    }
    sums
}
