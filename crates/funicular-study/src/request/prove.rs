//! Request about statements that hold at every pose of a box.

use super::key::declared;
use super::loads::Requirements;
use super::parts::{RobotText, State, Tensions, check};
use crate::values::{not_negative, positive};
use anyhow::{Result, bail};

/// Number of boxes of a division, if nothing else ends it.
pub const BOXES: usize = 20_000;

/// Maximum number of boxes of a division: each takes some 200 bytes.
const MAX_BOXES: u64 = 10_000_000;

declared! {
    /// End of the division of a box; the first that is reached ends it.
    #[derive(Copy)]
    pub struct Division {
        /// Maximum number of boxes into which the box is divided.
        boxes: Option<usize> = None => (Count(1..=MAX_BOXES)).under("Proof").otherwise("1 for `prove`, or 20000");
        /// Share of the set that may be undecided: undecided volume over the volume that is not proved outside.
        undecided: Option<f64> = None => (Number(Fraction)).under("Proof");
        /// Time after which the division ends [s].
        time_s: Option<f64> = None => (Number(Positive)).under("Proof");
    }
}

impl Division {
    /// True if a key is given.
    pub fn is_given(&self) -> bool {
        self.boxes.is_some() || self.undecided.is_some() || self.time_s.is_some()
    }

    /// Maximum number of boxes.
    pub fn most_boxes(&self, alone: usize) -> usize {
        self.boxes.unwrap_or(match (self.undecided, self.time_s) {
            (None, None) => alone,
            _ => MAX_BOXES as usize,
        })
    }

    /// Checks the numbers.
    pub(crate) fn check(&self) -> Result<()> {
        if self.boxes.is_some_and(|boxes| !(1..=MAX_BOXES).contains(&(boxes as u64))) {
            bail!("⟪boxes⟫: give a whole number from 1 to {MAX_BOXES}");
        }
        check("undecided", self.undecided, crate::values::fraction)?;
        check("time_s", self.time_s, positive)
    }
}

declared! {
    /// Proof that required loads are held within the tension limits at every pose of a box, not only at samples of it:
    /// proved inside, proved outside, or undecided with the reason.
    ///
    /// The statement: at every position within ⟪within_m⟫ of the pose, with every turn within ⟪within_deg⟫ of its
    /// orientation, and for every required load, there are tensions within the limits that balance the platform.
    pub struct ProveRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Half widths of the box of positions about the pose, world axes [m].
        within_m: Option<[f64; 3]> = None => (Vector).under("Proof").otherwise("0,0,0: the pose alone");
        /// Largest turn from the orientation of the pose about each world axis [degrees]; all turns belong to the
        /// statement at every position.
        within_deg: Option<[f64; 3]> = None => (Vector).under("Proof").otherwise("0,0,0: no turn");
        /// End of the division of the box.
        #[serde(flatten)]
        division: Division = Division::default() => group;
        /// Required loads.
        #[serde(flatten)]
        required: Requirements = Requirements::default() => group;
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => (group without ["lengths_m", "hold_lengths_of_pose"]);
        /// Limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => (group without ["tension_rule", "target_tension_n"]);
    }
    examples {
        "funicular prove robots/cogiro.toml --pose 0,0,1.5 --within-m 0.5,0.5,0.3 --within-deg 1,1,1",
        "funicular prove robots/cogiro.toml --pose 0,0,2.7 --within-m 7.5,5.5,2.7 --boxes 100000 -o cogiro.html",
        "funicular prove robots/cogiro.toml --pose 0,0,1.5 --within-m 1,1,0.5 --boxes 100 --required-force-n \
         150,150,150 --certificate cogiro.jsonl",
    }
}

impl ProveRequest {
    /// Checks the numbers.
    pub(crate) fn check(&self) -> Result<()> {
        for (key, widths) in [("within_m", self.within_m), ("within_deg", self.within_deg)] {
            widths.iter().flatten().try_for_each(|width| check(key, Some(*width), not_negative))?;
        }
        self.division.check()
    }
}
