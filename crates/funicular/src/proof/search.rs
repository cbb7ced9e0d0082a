//! Division of a box, breadth first: the largest undecided boxes are divided next.

use super::{BoxProof, BoxVerdict, PositionBox, Undecided};
use std::collections::VecDeque;

/// Division of a box of positions into boxes that are inside, outside or undecided.
///
/// [`Self::next`] gives boxes to prove, which any number of threads can do; [`Self::add`] takes their verdicts in the
/// same order. The result does not depend on how many are taken at once.
#[derive(Debug, Clone)]
pub struct ProofSearch {
    nodes: Vec<Node>,
    /// Numbers of the boxes that wait for a proof, the largest first.
    waiting: VecDeque<usize>,
    /// Numbers of the boxes that are being proved, in their order.
    taken: VecDeque<usize>,
    volumes: SearchedVolumes,
    proved: usize,
}

/// Box of a division.
#[derive(Debug, Clone)]
struct Node {
    region: PositionBox,
    verdict: Option<BoxVerdict>,
    /// Number of the first half, which the second follows.
    halves: Option<usize>,
}

/// Box of a division with its verdict.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProvedBox {
    /// Positions.
    pub region: PositionBox,
    /// Verdict.
    pub verdict: BoxVerdict,
}

/// Volumes of a division: in m³, or m² and m if the box has no width along one or two axes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SearchedVolumes {
    /// Volume proved inside.
    pub inside: f64,
    /// Volume proved outside.
    pub outside: f64,
    /// Volume of the box.
    pub whole: f64,
}

impl SearchedVolumes {
    /// Volume that is neither proved inside nor outside.
    pub fn undecided(&self) -> f64 {
        (self.whole - self.inside - self.outside).max(0.0)
    }

    /// Undecided volume over the volume that may be inside; zero if nothing may be.
    pub fn undecided_share(&self) -> f64 {
        let may_be_inside = self.whole - self.outside;
        if may_be_inside > 1e-12 * self.whole { self.undecided() / may_be_inside } else { 0.0 }
    }
}

impl ProofSearch {
    /// Search in a box.
    pub fn new(region: PositionBox) -> Self {
        let volumes = SearchedVolumes { whole: region.measure(), ..SearchedVolumes::default() };
        let node = Node { region, verdict: None, halves: None };
        Self { nodes: vec![node], waiting: VecDeque::from([0]), taken: VecDeque::new(), volumes, proved: 0 }
    }

    /// Boxes to prove next, at most this many; none if every box is decided or is not worth a division.
    pub fn next(&mut self, most: usize) -> Vec<PositionBox> {
        let count = most.min(self.waiting.len());
        let taken: Vec<usize> = self.waiting.drain(..count).collect();
        self.taken.extend(&taken);
        taken.iter().map(|number| self.nodes[*number].region).collect()
    }

    /// Takes the verdicts of boxes in the order of [`Self::next`].
    pub fn add(&mut self, proofs: &[BoxProof]) {
        for proof in proofs {
            let Some(number) = self.taken.pop_front() else { return };
            let region = self.nodes[number].region;
            self.nodes[number].verdict = Some(proof.verdict);
            self.proved += 1;
            match proof.verdict {
                BoxVerdict::Inside(_) => self.volumes.inside += region.measure(),
                BoxVerdict::Outside(_) => self.volumes.outside += region.measure(),
                // Smaller boxes would not be decided either.
                BoxVerdict::Undecided(Undecided::SagBound) if self.is_small(&region) => {}
                BoxVerdict::Undecided(_) => self.divide(number, &region),
            }
        }
    }

    /// True for a box small enough that its sag bound is not what its size makes of it.
    fn is_small(&self, region: &PositionBox) -> bool {
        region.measure() < 1e-5 * self.volumes.whole
    }

    fn divide(&mut self, number: usize, region: &PositionBox) {
        let (halves, axis) = region.halves();
        if halves[0].upper[axis] <= region.lower[axis] || halves[0].upper[axis] >= region.upper[axis] {
            return;
        }
        let first = self.nodes.len();
        self.nodes[number].halves = Some(first);
        self.nodes.extend(halves.map(|region| Node { region, verdict: None, halves: None }));
        self.waiting.extend([first, first + 1]);
    }

    /// Number of boxes that were proved or tried.
    pub fn tried(&self) -> usize {
        self.proved
    }

    /// Volumes so far.
    pub fn volumes(&self) -> SearchedVolumes {
        self.volumes
    }

    /// Boxes of the division that are not divided further, in the order of their making; a box that waits for its proof
    /// stands for its undecided parent.
    pub fn boxes(&self) -> impl Iterator<Item = ProvedBox> + '_ {
        let of = |node: &Node| ProvedBox {
            region: node.region,
            verdict: node.verdict.unwrap_or(BoxVerdict::Undecided(Undecided::SmallMargin)),
        };
        self.nodes.iter().filter(|node| node.halves.is_none()).map(of)
    }

    /// Parts of a face of a box beyond which nothing is proved inside. `axis` is normal to the face.
    pub(super) fn bare_parts(&self, face: &PositionBox, axis: usize, is_upper: bool) -> Vec<PositionBox> {
        let mut bare = Vec::new();
        let at = face.lower[axis];
        let root = &self.nodes[0].region;
        if (is_upper && at >= root.upper[axis]) || (!is_upper && at <= root.lower[axis]) {
            return vec![*face];
        }
        let mut open = vec![(0, *face)];
        while let Some((number, part)) = open.pop() {
            let node = &self.nodes[number];
            match node.halves {
                None if matches!(node.verdict, Some(BoxVerdict::Inside(_))) => {}
                None => bare.push(part),
                Some(first) => {
                    for half in [first, first + 1] {
                        let region = &self.nodes[half].region;
                        let is_beside = if is_upper {
                            region.lower[axis] <= at && at < region.upper[axis]
                        } else {
                            region.lower[axis] < at && at <= region.upper[axis]
                        };
                        let mut common =
                            PositionBox { lower: part.lower.sup(&region.lower), upper: part.upper.inf(&region.upper) };
                        (common.lower[axis], common.upper[axis]) = (at, at);
                        let across = (0..3).filter(|k| *k != axis).all(|k| common.lower[k] < common.upper[k]);
                        if is_beside && across {
                            open.push((half, common));
                        }
                    }
                }
            }
        }
        bare
    }
}
