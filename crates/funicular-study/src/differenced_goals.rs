//! Goals of designs that have no derivatives of their own: what they are at an equilibrium. A design takes differences
//! of the robot file's values.

use crate::error::NoSolution;
use anyhow::{Result, anyhow};
use funicular::clearance::{ClearancePair, Surroundings};
use funicular::robot::Robot;
use funicular::statics::{Equilibrium, TensionRule};
use funicular::winch_needs::{WinchNeed, WinchNeeds, WinchNeedsError};

/// Part of a goal, whose value is smooth; the worst part is the goal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum GoalPart {
    /// Pair of things whose distance counts.
    Pair(ClearancePair),
    /// Cable, by its index.
    Cable(usize),
}

/// Values of all parts of a goal at an equilibrium, whose tensions follow a rule.
type ValuesOfParts = fn(&Robot, &Equilibrium, &TensionRule) -> Result<Vec<(GoalPart, f64)>>;

/// Goal that a design follows by differences.
#[derive(Debug)]
pub struct DifferencedGoal {
    /// Name in requests.
    pub(crate) key: &'static str,
    /// Name in tables and messages.
    pub(crate) name: &'static str,
    pub(crate) unit: &'static str,
    /// Sign of an improvement.
    pub(crate) sign: f64,
    /// Meaning, for help texts.
    pub(crate) about: &'static str,
    /// Values of all parts.
    pub(crate) values: ValuesOfParts,
}

// The key is the name, which no other goal has.
impl PartialEq for DifferencedGoal {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

/// All goals, in the order of lists and messages.
pub(crate) static DIFFERENCED: [DifferencedGoal; 5] = [
    DifferencedGoal {
        key: "clearance",
        name: "least distance beyond the required one",
        unit: "m",
        sign: 1.0,
        about: "Largest distance, beyond the required one, of what comes nearest: cables, platform, obstacles",
        values: clearances,
    },
    DifferencedGoal {
        key: "winch-tension",
        name: "largest tension of a winch",
        unit: "N",
        sign: -1.0,
        about: "Least tension at a drum under everything that is required",
        values: |robot, rest, rule| winches(robot, rest, rule, WinchNeed::Tension),
    },
    DifferencedGoal {
        key: "winch-speed",
        name: "largest speed of a winch",
        unit: "m/s",
        sign: -1.0,
        about: "Least speed of a cable at its drum for the required velocities",
        values: |robot, rest, rule| winches(robot, rest, rule, WinchNeed::Speed),
    },
    DifferencedGoal {
        key: "winch-torque",
        name: "largest torque of a winch",
        unit: "N m",
        sign: -1.0,
        about: "Least torque of a motor under everything that is required",
        values: |robot, rest, rule| winches(robot, rest, rule, WinchNeed::Torque),
    },
    DifferencedGoal {
        key: "winch-power",
        name: "largest power of a winch",
        unit: "W",
        sign: -1.0,
        about: "Least mechanical power of a motor that drives, under everything that is required",
        values: |robot, rest, rule| winches(robot, rest, rule, WinchNeed::Power),
    },
];

fn clearances(robot: &Robot, rest: &Equilibrium, _: &TensionRule) -> Result<Vec<(GoalPart, f64)>> {
    let all = Surroundings::of(robot).clearances(rest, None);
    if all.is_empty() {
        return Err(anyhow!("the robot has no pair of cables, bodies or obstacles whose distance counts"));
    }
    Ok(all.iter().map(|of| (GoalPart::Pair(of.pair), of.margin())).collect())
}

fn winches(robot: &Robot, rest: &Equilibrium, rule: &TensionRule, need: WinchNeed) -> Result<Vec<(GoalPart, f64)>> {
    let needs = WinchNeeds::at(robot, &rest.pose, rest.model, rule).map_err(|error| match error {
        WinchNeedsError::NoRates(error) => anyhow!("{error}"),
        error @ WinchNeedsError::NotHeld { .. } => anyhow!(NoSolution(error.to_string())),
    })?;
    let of_cables = needs.cables.iter().enumerate();
    let parts: Vec<(GoalPart, f64)> =
        of_cables.filter_map(|(i, cable)| Some((GoalPart::Cable(i), cable.of(need)?.value))).collect();
    if parts.is_empty() {
        return Err(anyhow!("no winch of the robot file has a drum_radius_m, from which a torque follows"));
    }
    Ok(parts)
}
