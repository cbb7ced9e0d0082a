//! Proof that no tensions within the limits balance the platform: a wrench direction in which they cannot reach it.
//!
//! For any direction y, balance needs `y·e + Σ y·w_i(τ_i) = 0`, e being the load and w_i the wrench of a cable. If the sum
//! of the load's share and the greatest share that every cable can have within its limits is negative, no tensions
//! within the limits balance the platform, however the cables sag: (39b). The greatest shares are each a search in one
//! variable, along the true curve of the cable.

use super::line::Line;
use super::polyhedron::Polyhedron;
use crate::math::Vec6;
use crate::robot::Freedoms;

/// Limit of intervals that are halved for one direction; 0 in nine of ten proofs, up to 20 where heavy ropes miss their
/// limits by little.
const MAX_HALVINGS: usize = 100;

/// Limit of directions that are tried after the first.
const MAX_CUTS: usize = 60;

/// Rounding of the sum of all shares, in parts of their sizes.
const ROUNDING: f64 = 1e-12;

/// Where a cable's tension may be.
#[derive(Debug, Clone)]
pub(super) struct Reach {
    /// The cable at the least τ within its limits, not slacker than (37), and at the greatest.
    ends: [Line; 2],
}

impl Reach {
    /// From a cable in any state; `minimum` is its [`Line::at_minimum`].
    pub(super) fn of(line: &Line, minimum: f64) -> Self {
        let mut ends = [line.clone(), line.clone()];
        ends[0].set(minimum);
        ends[1].at_maximum();
        // Limits that are no wider than the bend of a heavy rope.
        if ends[1].tau() < minimum {
            ends[1].set(minimum);
        }
        Self { ends }
    }

    /// The least and the greatest τ [N].
    pub(super) fn limits(&self) -> [f64; 2] {
        [self.ends[0].tau(), self.ends[1].tau()]
    }
}

/// A point of a cable's share `y·w(τ)`.
#[derive(Debug, Clone, Copy)]
struct Point {
    tau: f64,
    /// The cable's wrench, scaled, in the platform's coordinates.
    wrench: Vec6,
    share: f64,
    slope: f64,
}

impl Point {
    fn of(line: &Line, y: &Vec6, freedoms: &Freedoms) -> Self {
        let wrench = freedoms.reduced(&line.wrench(&line.force().0));
        Self { tau: line.tau(), wrench, share: y.dot(&wrench), slope: y.dot(&freedoms.reduced(&line.column())) }
    }
}

/// A part of a cable's reach.
#[derive(Debug, Clone, Copy)]
struct Part {
    cable: usize,
    ends: [Point; 2],
}

impl Part {
    /// Nothing between the ends is above. The share's second derivative changes its sign at most once (the bend of a
    /// cable's vertical force does: a property test): where it is concave, the tangents at the outer end are above it;
    /// where it is convex, its own ends are.
    fn bound(&self) -> f64 {
        let [from, to] = &self.ends;
        let width = to.tau - from.tau;
        (from.share + from.slope.max(0.0) * width).max(to.share + (-to.slope).max(0.0) * width)
    }

    fn best(&self) -> Point {
        let [from, to] = self.ends;
        if from.share > to.share { from } else { to }
    }
}

/// What the directions that were tried say.
pub(super) struct Verdict {
    /// No tensions within the limits balance the platform.
    pub proved: bool,
    /// The tensions with the greatest shares in the first direction [N].
    pub farthest: Vec<f64>,
}

/// A load that cables are to balance, within their reaches; in the platform's coordinates, scaled.
pub(super) struct Claim<'a> {
    pub reaches: &'a [Reach],
    pub load: Vec6,
    pub freedoms: Freedoms,
}

impl Claim<'_> {
    /// Whether a direction proves that the load is not balanced: the first one, or one of those that follow from it.
    ///
    /// Every direction that proves nothing has a set of tensions within the limits on the wrong side of its plane. The
    /// next direction has all of these sets on the right side, with the widest least angle (cutting planes). There is
    /// none if the load lies in the convex hull of what these tensions balance; then no direction is a proof.
    pub(super) fn refuted(&self, first: &Vec6) -> Verdict {
        let n = self.freedoms.count();
        let mut seen: Vec<[f64; 6]> = Vec::new();
        let mut y = *first;
        let mut verdict = Verdict { proved: false, farthest: Vec::new() };
        for _ in 0..=MAX_CUTS {
            let (proved, farthest) = self.examine(&y);
            if seen.is_empty() {
                verdict.farthest = farthest.iter().map(|point| point.tau).collect();
            }
            if proved {
                verdict.proved = true;
                break;
            }
            let wrench = farthest.iter().fold(self.load, |sum, point| sum + point.wrench);
            let Some(unit) = wrench.try_normalize(0.0) else { break };
            seen.push(std::array::from_fn(|k| unit[k]));

            let mut sides = Polyhedron::new(n);
            seen.iter().for_each(|unit| sides.add(unit[..n].iter(), -1.0, None, 1.0));
            let mut next = [0.0; 6];
            if sides.nearest(&mut next[..n], 1e-9).is_none() {
                break;
            }
            let next = Vec6::from(next).normalize();
            // Where the last direction comes again, rounding decides.
            if (next - y).amax() < 1e-12 {
                break;
            }
            y = next;
        }
        verdict
    }

    /// Whether one direction proves it, and the points of the cables with the greatest shares in it.
    fn examine(&self, y: &Vec6) -> (bool, Vec<Point>) {
        let mut parts: Vec<Part> = Vec::with_capacity(self.reaches.len());
        for (cable, reach) in self.reaches.iter().enumerate() {
            parts.push(Part { cable, ends: [0, 1].map(|k| Point::of(&reach.ends[k], y, &self.freedoms)) });
        }
        let mut best: Vec<Point> = parts.iter().map(Part::best).collect();
        let own = y.dot(&self.load);
        let size = own.abs() + best.iter().map(|point| point.share.abs()).sum::<f64>();

        for _ in 0..=MAX_HALVINGS {
            // The sum of all bounds decides, …
            let mut bounds: Vec<f64> = best.iter().map(|point| point.share).collect();
            parts.iter().for_each(|part| bounds[part.cable] = bounds[part.cable].max(part.bound()));
            if own + bounds.iter().sum::<f64>() < -ROUNDING * size {
                return (true, best);
            }

            // … or that of shares that the cables do have.
            if own + best.iter().map(|point| point.share).sum::<f64>() >= -ROUNDING * size {
                break;
            }

            // Between both the part that is least known is halved.
            let excess = |part: &Part| part.bound() - best[part.cable].share;
            let widest = (0..parts.len()).max_by(|&a, &b| excess(&parts[a]).total_cmp(&excess(&parts[b])));
            let Some(widest) = widest else { break };
            let Part { cable, ends: [from, to] } = parts[widest];
            let mut line = self.reaches[cable].ends[0].clone();
            line.set((from.tau * to.tau).sqrt());
            let middle = Point::of(&line, y, &self.freedoms);
            if middle.share > best[cable].share {
                best[cable] = middle;
            }
            parts[widest].ends = [from, middle];
            parts.push(Part { cable, ends: [middle, to] });
        }
        (false, best)
    }
}
