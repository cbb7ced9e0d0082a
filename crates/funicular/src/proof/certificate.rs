//! Numbers with which a second program checks a proof without solving anything.

use super::{BoxProof, ProofStatement};
use crate::math::{Vec3, Vec6};

/// Cable of a statement as numbers. World axes.
#[derive(Debug, Clone, PartialEq)]
pub struct CableOfCertificate {
    /// Name.
    pub name: String,
    /// Anchor [m].
    pub anchor_w: Vec3,
    /// Attachment from the platform origin in the orientation of the statement [m].
    pub arm_w: Vec3,
    /// Minimum tension [N] and its multiple of the length of the chord [N/m]: the larger one holds.
    pub least: [f64; 2],
    /// Maximum tension [N]; infinite without one.
    pub greatest: f64,
    /// Weight per unstrained length [N/m] and axial stiffness [N] of a cable that sags.
    pub sag: Option<[f64; 2]>,
}

/// Numbers of the proof of a box.
#[derive(Debug, Clone, PartialEq)]
pub enum BoxCertificate {
    /// Tensions for every load: `t = q l_0` of each cable at the centre, then by each coordinate of the box [N].
    Inside(Vec<Vec<Vec<f64>>>),
    /// Number of the load and direction of wrenches in the coordinates of the platform.
    Outside(usize, Vec6),
    /// Nothing is proved.
    Undecided,
}

impl BoxProof {
    /// Numbers of the proof.
    pub fn certificate(&self) -> BoxCertificate {
        match (&self.missing, self.witnesses.is_empty()) {
            (Some((load, direction)), _) => BoxCertificate::Outside(*load, *direction),
            (None, true) => BoxCertificate::Undecided,
            (None, false) => {
                let tensions = self.witnesses.iter();
                let of = tensions.map(|of| [std::slice::from_ref(&of.center), &of.by].concat());
                BoxCertificate::Inside(of.collect())
            }
        }
    }
}

impl ProofStatement {
    /// Cables of the statement.
    pub fn cables(&self) -> impl Iterator<Item = CableOfCertificate> + '_ {
        self.cables.iter().map(|cable| CableOfCertificate {
            name: cable.name.clone(),
            anchor_w: cable.anchor_w,
            arm_w: cable.arm_w,
            least: cable.least.numbers(),
            greatest: cable.greatest,
            sag: cable.sag.map(|sag| [sag.weight, sag.axial_stiffness]),
        })
    }

    /// Loads of the statement in the coordinates of the platform, moments over the length of the platform [N].
    pub fn loads(&self) -> &[Vec6] {
        &self.loads
    }

    /// Rows that take a wrench in world axes about the platform origin (N, N m) to the coordinates of the platform, one
    /// row for each of them.
    pub fn rows(&self) -> Vec<Vec6> {
        let unit = |i: usize| self.coordinates.reduce(&Vec6::from_fn(|k, _| f64::from(u8::from(i == k))));
        let columns: Vec<Vec6> = (0..6).map(unit).collect();
        (0..self.coordinates.count()).map(|row| Vec6::from_fn(|k, _| columns[k][row])).collect()
    }

    /// Forces of the dead load that turn with the platform: force [N], and lever arm in world axes [m].
    pub fn turning_forces(&self) -> &[[Vec3; 2]] {
        &self.turning
    }

    /// Largest turns about the world axes [rad], and the direction against gravity.
    pub fn turns_and_up(&self) -> [Vec3; 2] {
        [self.turns, self.up_w]
    }
}
