//! Conditions that hold the tensions of a rule. Where they change along a path, tensions and lengths go on and their
//! rates jump.

use super::TensionRule;
use crate::math::{Mat3, Vec3, Vec6, symmetric, symmetric_part};
use crate::platform::Coordinates;
use crate::robot::Robot;
use crate::statics::stiffness::assembled;
use crate::statics::{Equilibrium, Limit, TensionMargin, TensionRange};

/// Distance of a tension from its limit, over the limit, within which the limit is reached; and difference of two
/// distances, over the largest tension, within which both hold the rule `middle`. The searches keep 1e-9.
const AT_LIMIT: f64 = 1e-6;

/// Difference of two eigenvalues over the smaller one within which they have met: on a move of CoGiRo the search leaves
/// 1e-8 and less where they meet, and 2e-5 is the least of 9,000 differences where they do not.
const MET: f64 = 1e-6;

/// Cosine of the angle between the softest motions at two times above which they are one motion that turns.
const ONE_MOTION: f64 = 0.7;

/// Conditions that hold the tensions of a rule.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldTensions {
    /// Limit of its tension that each cable has reached.
    pub at_limit: Vec<Option<Limit>>,
    /// Rule `middle`: minimum and maximum of each cable that are as near, for their range, as the nearest of all.
    nearest: Vec<[bool; 2]>,
    /// Rule `stiffest`: motions of the platform whose stiffnesses meet at the smallest.
    softest: Vec<Vec6>,
}

impl HeldTensions {
    /// Conditions at the tensions of a rule, and the distance from each further one, in its unit: tensions from their
    /// limits [N], those of the rule `middle` from being the nearest [N], eigenvalues from the smallest. The distance
    /// from a condition that holds them is infinite.
    pub fn of(robot: &Robot, equilibrium: &Equilibrium, rule: &TensionRule) -> (Self, Vec<f64>) {
        let margins = tension_margins(robot, equilibrium);
        let at_limit: Vec<Option<Limit>> = margins.iter().map(limit_of).collect();
        let free = at_limit.iter().zip(&margins).filter(|(limit, _)| limit.is_none());
        let mut distances: Vec<f64> = match rule {
            TensionRule::Middle => Vec::new(),
            _ => free.flat_map(|(_, margin)| from_limits(margin)).collect(),
        };

        let (mut nearest, mut softest) = (Vec::new(), Vec::new());
        match rule {
            TensionRule::Middle => {
                let size = equilibrium.cables.iter().fold(0.0, |most: f64, cable| most.max(cable.tension_platform));
                let further = from_nearest(&margins);
                nearest = further.iter().map(|of| of.map(|at| at <= AT_LIMIT * size)).collect();
                distances = further.into_iter().flatten().collect();
                distances.iter_mut().filter(|at| **at <= AT_LIMIT * size).for_each(|at| *at = f64::INFINITY);
            }
            TensionRule::Stiffest => {
                let (values, motions) = stiffnesses(robot, equilibrium);
                let gaps = values.iter().map(|value| (value - values[0]) / values[0].abs());
                let (met, apart): (Vec<f64>, Vec<f64>) = gaps.partition(|gap| *gap <= MET);
                softest = motions.into_iter().take(met.len()).collect();
                distances.extend(apart);
            }
            _ => {}
        }
        (Self { at_limit, nearest, softest }, distances)
    }

    /// True if the same conditions hold both, so that tensions and their rates go on between them. A softest motion may
    /// turn, and not become another one: where two stiffnesses pass each other the tensions bend.
    pub fn are_alike(&self, other: &Self) -> bool {
        let is_one_motion = match (&self.softest[..], &other.softest[..]) {
            ([one], [other]) => one.dot(other).abs() > ONE_MOTION,
            (some, others) => some.len() == others.len(),
        };
        self.at_limit == other.at_limit && self.nearest == other.nearest && is_one_motion
    }
}

/// Margins of the tensions of all cables.
pub(crate) fn tension_margins(robot: &Robot, equilibrium: &Equilibrium) -> Vec<TensionMargin> {
    let cables = equilibrium.cables.iter().enumerate();
    cables.map(|(i, cable)| TensionRange::of(robot, i, &cable.chord_w()).margin(cable)).collect()
}

/// Limit that the tensions of a cable have reached.
fn limit_of(margin: &TensionMargin) -> Option<Limit> {
    if margin.max >= margin.range.maximum * (1.0 - AT_LIMIT) {
        Some(Limit::Maximum)
    } else if margin.min <= margin.range.minimum * (1.0 + AT_LIMIT) {
        Some(Limit::Minimum)
    } else {
        None
    }
}

/// Distances of the tensions of a cable from its minimum and from its maximum [N].
fn from_limits(margin: &TensionMargin) -> [f64; 2] {
    [margin.min - margin.range.minimum, margin.range.maximum - margin.max]
}

/// Distances of the tensions of each cable from where they would be as near to a limit, for its range, as the nearest
/// of all [N].
fn from_nearest(margins: &[TensionMargin]) -> Vec<[f64; 2]> {
    let width = |of: &TensionMargin| of.range.maximum - of.range.minimum;
    let each = margins.iter().flat_map(|of| from_limits(of).map(|at| at / width(of)));
    let smallest = each.fold(f64::INFINITY, f64::min);
    margins.iter().map(|of| from_limits(of).map(|at| at - smallest * width(of))).collect()
}

/// Eigenvalues of the stiffness that the rule `stiffest` compares, ascending, with their motions; none of ideal cables.
fn stiffnesses(robot: &Robot, equilibrium: &Equilibrium) -> (Vec<f64>, Vec<Vec6>) {
    let motion = robot.platform.motion;
    let parts: Option<Vec<(Mat3, Vec3, Vec3)>> = equilibrium
        .cables
        .iter()
        .map(|cable| Some((cable.hanging.as_ref()?.tangent_w(), cable.force_on_platform_w, cable.lever_w)))
        .collect();
    let Some(parts) = parts else { return Default::default() };

    let whole = Coordinates::of(robot).scale_matrix(&assembled(robot, &equilibrium.pose, parts.into_iter()));
    symmetric::eigen(&motion.reduced_matrix(&symmetric_part(&whole)), motion.count())
}
