//! Statements that hold at every pose of a box, not at samples of it: proved inside, proved outside, or undecided.
//!
//! Statement: at every position of a box, with every turn of the platform within given limits, and for every required
//! load, tensions within the limits of the cables balance the platform. Cables are straight, or elastic catenaries.
//!
//! A search proposes tensions that change linearly over the box, or one direction of wrenches along which the cables
//! fall short everywhere in it. Proofs test the proposal with a few inequalities, enlarged by all that rounding can do;
//! a second program can test them as well, without solving anything.

mod certificate;
mod cutting;
mod frame;
mod inside;
mod outside;
mod sag;
mod search;
mod statement;
mod surface;

pub use certificate::{BoxCertificate, CableOfCertificate};
pub use search::{ProofSearch, ProvedBox, SearchedVolumes};
pub use statement::{ProofRefusal, ProofStatement};
pub use surface::FaceMesh;

use crate::math::{Vec3, Vec6};
use frame::BoxFrame;
use inside::{NotHeld, Witness};

/// Box of positions of the platform origin, world axes [m].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionBox {
    /// Corner with the least coordinates.
    pub lower: Vec3,
    /// Corner with the greatest coordinates.
    pub upper: Vec3,
}

impl PositionBox {
    /// Box about a position with these half widths, not negative.
    pub fn about(center: &Vec3, half_widths: &Vec3) -> Self {
        Self { lower: center - half_widths, upper: center + half_widths }
    }

    /// Middle of the box.
    pub fn center(&self) -> Vec3 {
        (self.lower + self.upper) * 0.5
    }

    /// Half widths about [`Self::center`] that reach both corners.
    pub fn half_widths(&self) -> Vec3 {
        let center = self.center();
        (self.upper - center).sup(&(center - self.lower)).map(|of| if of > 0.0 { of.next_up() } else { 0.0 })
    }

    /// Product of the sides that are not zero: a volume [m³], an area [m²] or a length [m].
    pub fn measure(&self) -> f64 {
        (self.upper - self.lower).iter().filter(|side| **side > 0.0).product()
    }

    /// Both halves, divided across the longest side, and the axis of this side.
    pub fn halves(&self) -> ([Self; 2], usize) {
        let axis = (self.upper - self.lower).imax();
        let mut halves = [*self; 2];
        let middle = self.center()[axis];
        halves[0].upper[axis] = middle;
        halves[1].lower[axis] = middle;
        (halves, axis)
    }
}

/// Verdict about a box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BoxVerdict {
    /// Every required load is held at every pose; the least distance of a tension from its limits [N].
    Inside(f64),
    /// At every position some required load is not held without a turn; the least wrench that is missing [N].
    Outside(f64),
    /// Neither was proved.
    Undecided(Undecided),
}

/// Reason why a box is undecided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Undecided {
    /// An anchor may coincide with an attachment within the box.
    AnchorInBox,
    /// The wrenches of the cables come too near to losing a degree of freedom.
    NearSingular,
    /// The bound of what sag does to the end forces is larger than what a smaller box would gain.
    SagBound,
    /// The distance from the limits changes its sign in the box, or is smaller than the bounds.
    SmallMargin,
}

impl Undecided {
    /// Name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::AnchorInBox => "anchor-in-box",
            Self::NearSingular => "near-singular",
            Self::SagBound => "sag-bound",
            Self::SmallMargin => "small-margin",
        }
    }
}

/// Verdict about a box with what proves it.
#[derive(Debug, Clone, PartialEq)]
pub struct BoxProof {
    /// Verdict.
    pub verdict: BoxVerdict,
    /// Tensions for every required load, if the box is inside.
    pub(crate) witnesses: Vec<Witness>,
    /// Number of the load and direction of wrenches, reduced, if the box is outside.
    pub(crate) missing: Option<(usize, Vec6)>,
}

impl BoxProof {
    fn undecided(reason: Undecided) -> Self {
        Self { verdict: BoxVerdict::Undecided(reason), witnesses: Vec::new(), missing: None }
    }
}

impl ProofStatement {
    /// Proves or disproves the statement for a box of positions.
    ///
    /// # Example
    /// ```
    /// # use funicular::{math::Vec3, proof::{BoxVerdict, PositionBox, ProofStatement}};
    /// # use funicular::{robot::{Pose, Robot}, statics::StaticModel};
    /// let robot = Robot::from_toml(funicular_robots::COGIRO)?;
    /// let pose = Pose::new([0.0, 0.0, 1.5], [0.0; 3]);
    /// let statement = ProofStatement::of(&robot, &pose, StaticModel::Catenary, Vec3::zeros())?;
    /// let held = statement.prove(&PositionBox::about(&pose.position_w, &Vec3::repeat(0.5)));
    /// assert!(matches!(held.verdict, BoxVerdict::Inside(margin) if margin > 50.0)); // N
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # References
    /// docs/theory.md, equations (42a) to (42h).
    pub fn prove(&self, region: &PositionBox) -> BoxProof {
        let frame = match BoxFrame::of(self, region) {
            Ok(frame) => frame,
            Err(reason) => return BoxProof::undecided(reason),
        };

        let (load, reason) = match frame.held() {
            Ok(held) => {
                let verdict = BoxVerdict::Inside(held.margin);
                return BoxProof { verdict, witnesses: held.witnesses, missing: None };
            }
            Err(NotHeld { load, reason }) => (load, reason),
        };

        // A load that no tensions hold anywhere in the box.
        for other in std::iter::once(load).chain((0..self.loads.len()).filter(|other| *other > load)) {
            if let Some(missing) = frame.missing(other) {
                let verdict = BoxVerdict::Outside(missing.by);
                return BoxProof { verdict, witnesses: Vec::new(), missing: Some((other, missing.direction)) };
            }
        }
        BoxProof::undecided(reason)
    }
}
