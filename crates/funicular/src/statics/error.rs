//! Reasons why an equilibrium cannot be given, and their messages.

use super::equilibrium::RESIDUAL_LIMIT;
use super::limits::{Limit, LimitViolation};
use super::loaded_cable::MAX_LENGTH_RATIO;
use super::model::StaticModel;
use super::obstacle::Obstacle;
use crate::robot::{OutOfPlane, Pose, Robot};
use thiserror::Error;

/// Reason why an equilibrium cannot be given.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StaticsError {
    /// Neither lengths nor a pose of the robot are known.
    #[error(
        "the robot has no state: its file gives neither an `unstrained_length_m` to every cable nor a [state] with \
         `position_m`"
    )]
    NoState,
    /// Tension rule for a robot without redundant cables.
    #[error(
        "a tension rule has nothing to choose: {cables} cables for {dof} degrees of freedom have one set of tensions \
         at a pose"
    )]
    NothingToChoose {
        /// Cables of the robot.
        cables: usize,
        /// Degrees of freedom of the platform.
        dof: usize,
    },
    /// Tension rule together with given lengths.
    #[error(
        "a tension rule has nothing to choose: the state is given by unstrained lengths, which determine the \
         tensions; give a pose"
    )]
    RuleOfLengths,
    /// The number of lengths differs from the number of cables.
    #[error(
        "{} given for {}: give one length per cable, in the order of the file",
        crate::counted(*given, "unstrained length"), crate::counted(*cables, "cable")
    )]
    LengthCount {
        /// Lengths given.
        given: usize,
        /// Cables of the robot.
        cables: usize,
    },
    /// A length is not positive and finite.
    #[error("unstrained length of cable \"{cable}\" is {value} m: it must be positive and finite")]
    Length {
        /// Name of the cable.
        cable: String,
        /// Value [m].
        value: f64,
    },
    /// More ideal cables than degrees of freedom.
    #[error(
        "{} for {dof} degrees of freedom: forward statics of `ideal` cables has no answer for more than {dof}; choose \
         the static model `spring` or `catenary`",
        crate::counted(*cables, "cable")
    )]
    CableCount {
        /// Cables of the robot.
        cables: usize,
        /// Degrees of freedom of the platform.
        dof: usize,
    },
    /// Fewer cables than degrees of freedom cannot hold a given pose.
    #[error(
        "{} for {dof} degrees of freedom cannot hold every pose: there is a nearest pose that they can hold",
        crate::counted(*cables, "cable")
    )]
    InverseCableCount {
        /// Cables of the robot.
        cables: usize,
        /// Degrees of freedom of the platform.
        dof: usize,
    },
    /// A planar platform cannot have this pose.
    #[error(transparent)]
    OutOfPlane(#[from] OutOfPlane),
    /// The ends of a cable coincide at this pose.
    #[error("cable \"{cable}\" has coinciding ends at this pose: move the platform away from its anchor")]
    CoincidingEnds {
        /// Name of the cable.
        cable: String,
    },
    /// The attachment of a cable is inside the wheel of its pulley.
    #[error(
        "cable \"{cable}\" ends inside the wheel of its pulley at this pose: its attachment is {distance:.4} m from \
         the wheel's centre, the radius is {radius} m; move the platform away, or check `radius_m` and `anchor_m`"
    )]
    InsidePulley {
        /// Name of the cable.
        cable: String,
        /// Distance of the attachment from the wheel's centre [m].
        distance: f64,
        /// Radius of the wheel [m].
        radius: f64,
    },
    /// The pose is singular: the cables do not span the degrees of freedom, and do not balance the load either.
    #[error(
        "the cables do not hold the platform at this pose: their directions are dependent (singular pose){}",
        because(obstacle.as_deref())
    )]
    Singular {
        /// Direction in which no cable pulls, if the load acts there.
        obstacle: Option<Box<Obstacle>>,
    },
    /// A straight cable would need negative tension.
    #[error(
        "no equilibrium with cables in tension: cable \"{cable}\" would need {} N at this pose{}; choose \
         another pose, mass or centre of mass",
        newtons(*tension),
        because(obstacle.as_deref())
    )]
    NegativeTension {
        /// Name of the cable with the most negative tension.
        cable: String,
        /// Tension of this cable [N], not positive.
        tension: f64,
        /// Direction in which no cable pulls.
        obstacle: Option<Box<Obstacle>>,
    },
    /// No tensions found for sagging cables at a pose where a straight one would need negative tension. This is no
    /// proof that there are none: the balance of sagging cables is not linear.
    #[error(
        "no tensions found that hold this pose: straight, cable \"{cable}\" would need {} N{}; sagging, \
         {}; choose another pose, mass or centre of mass",
        newtons(*tension),
        because(obstacle.as_deref()),
        searched(*starts, *residual, *max_tension)
    )]
    NotFound {
        /// Name of the straight cable with the most negative tension.
        cable: String,
        /// Tension of this cable if straight [N], not positive.
        tension: f64,
        /// Number of starts of the search; zero if only a cable longer than twice its chord could hold the pose.
        starts: usize,
        /// Minimum scaled residual reached.
        residual: f64,
        /// Maximum tension [N] of cables that do hold the pose, but with excessive tensions.
        max_tension: Option<f64>,
        /// Direction in which no straight cable pulls.
        obstacle: Option<Box<Obstacle>>,
    },
    /// Ideal cables of given lengths close at a pose where one of them would need negative tension.
    #[error(
        "no equilibrium with cables in tension: ideal cables of these lengths close at position ({x:.4}, {y:.4}, \
         {z:.4}) m, where cable \"{cable}\" would need {} N; choose other lengths, another mass or centre of \
         mass, or the static model `spring` or `catenary`, whose platform moves until all cables pull or are slack",
        newtons(*tension)
    )]
    LengthsPush {
        /// Name of the cable with the most negative tension.
        cable: String,
        /// Tension of this cable [N], negative.
        tension: f64,
        /// Position of the platform [m].
        x: f64,
        /// Position of the platform [m].
        y: f64,
        /// Position of the platform [m].
        z: f64,
    },
    /// No tensions within the limits hold the pose, which is proved.
    #[error("{}", beyond_limits(.0))]
    BeyondLimits(LimitViolation),
    /// No tensions within the limits were found, and there is no proof that there are none: the balance of sagging
    /// cables is not linear.
    #[error(
        "no tensions within their limits that hold this pose were found in a search from {starts} starts: the best \
         tensions violate the limits {miss}{}; choose another pose, mass or centre of mass, or widen the limits \
         (`minimum_tension_n`, `maximum_tension_n`)",
        because(miss.obstacle.as_deref())
    )]
    NotFoundWithinLimits {
        /// Violation of the limits by the best tensions found.
        miss: LimitViolation,
        /// Number of starts of the search.
        starts: usize,
    },
    /// The minimum of a tension is not below its maximum.
    #[error(
        "cable \"{cable}\": minimum tension {minimum} N is not below its maximum {maximum} N; give it a \
         `minimum_tension_n` below its maximum (the default is 2.5 times the cable's weight)"
    )]
    LimitsExclude {
        /// Name of the cable.
        cable: String,
        /// Minimum tension [N].
        minimum: f64,
        /// Maximum tension [N].
        maximum: f64,
    },
    /// No payload brings the tensions within their limits.
    #[error(
        "no payload was found with which tensions within their limits hold this pose; choose another pose or centre of \
         mass of the payload, or widen the limits (`minimum_tension_n`, `maximum_tension_n`)"
    )]
    NoPayload,
    /// No load is required besides the dead load.
    #[error(
        "no loads are required, so there is no load factor: add a [required] table to the robot file, or give \
         `required_force_n` or another required load"
    )]
    NothingRequired,
    /// No multiple of a required load was found to be within the limits, although the dead load is.
    #[error(
        "no multiple of a required load was found that tensions within their limits hold, although they hold the dead \
         load: its tensions are at their limits; choose another pose, or widen the limits (`minimum_tension_n`, \
         `maximum_tension_n`)"
    )]
    NoLoadFactor,
    /// The weight of a payload does not act on the cables.
    #[error(
        "a payload has no weight that the cables carry: there is no gravity, or only gravity out of the plane of the \
         platform"
    )]
    WeightlessPayload,
    /// The weight of a payload has a part along motions that no cable opposes.
    #[error(
        "no payload with this center of mass can be held: it would make the platform {motion}, and no cable opposes \
         this motion; choose a center of mass straight below or above the attachments"
    )]
    UnbalancedPayload {
        /// Motion that the payload would cause, in words.
        motion: String,
    },
    /// The rule needs a maximum tension.
    #[error(
        "the tension rule `{rule}` needs a maximum tension for every cable, and cable \"{cable}\" has none: give \
         `maximum_tension_n` or `breaking_load_n` in the robot file, or choose the rule `lowest` or `closest`"
    )]
    NeedsMaximum {
        /// Name of the first cable without a maximum.
        cable: String,
        /// Name of the rule.
        rule: &'static str,
    },
    /// The tensions have no room between their limits.
    #[error(
        "the tension rule `centre` needs tensions strictly between their limits, and at this pose that of cable \
         \"{cable}\" is at one: the best tensions leave a room of {room:.4} N; widen the limits of tension, choose the \
         rule `lowest` or `closest`, or a pose further inside"
    )]
    NoCentre {
        /// Name of the cable with the least room.
        cable: String,
        /// Distance in the tension parallel to the chord from the nearer limit [N].
        room: f64,
    },
    /// The number of target tensions is neither one nor the number of cables.
    #[error(
        "{} given for {}: give one for all cables, or one per cable in the order of the file",
        crate::counted(*given, "target tension"), crate::counted(*cables, "cable")
    )]
    TargetCount {
        /// Tensions given.
        given: usize,
        /// Cables of the robot.
        cables: usize,
    },
    /// A target tension is not finite or is negative.
    #[error("the target tension is {value} N: it must be finite and not negative")]
    TargetTension {
        /// Value [N].
        value: f64,
    },
    /// Ideal cables are rigid at any tension.
    #[error(
        "the tension rule `stiffest` has no answer for ideal cables, which are rigid: choose the static model `spring` \
         or `catenary`"
    )]
    StiffestNeedsElastic,
    /// The least stiff motion is one that no cable opposes.
    #[error(
        "the tension rule `stiffest` has nothing to raise: all cables end at one point or on one line of the platform, \
         and its least stiff motion about them does not depend on the tensions; choose the rule `middle`, `lowest` or \
         `closest`"
    )]
    StiffestNeedsSpread,
    /// More cables than the rule `stiffest` allows.
    #[error(
        "the tension rule `stiffest` is for up to {limit} cables, and the robot has {cables}: its time grows with the \
         cube of their number; choose the rule `middle`, `lowest` or `closest`"
    )]
    TooManyToStiffen {
        /// Cables of the robot.
        cables: usize,
        /// Maximum number of cables for the rule.
        limit: usize,
    },
    /// Ideal cables are rigid: their poses follow from a mechanism, not from an energy.
    #[error("a search for all equilibria needs cables that stretch: choose the static model `spring` or `catenary`")]
    NeedsElasticCables,
    /// The search for the nearest pose did not converge.
    #[error(
        "no nearest pose found in {iterations} iterations: the last pose, at position ({x:.4}, {y:.4}, {z:.4}) m, \
         could come nearer by {residual:.1e} of the robot's size (limit {limit:.0e}); request a pose nearer to one \
         that hangs freely"
    )]
    NotNearest {
        /// Iterations of forward statics taken.
        iterations: usize,
        /// Relative length by which the pose could come nearer along the equilibria, to first order.
        residual: f64,
        /// Limit of this length.
        limit: f64,
        /// Position reached [m].
        x: f64,
        /// Position reached [m].
        y: f64,
        /// Position reached [m].
        z: f64,
    },
    /// Every pose near the requested one needs tensions beyond their limits.
    #[error(
        "no nearest pose with tensions within their limits was found: at the last one, at position ({x:.4}, {y:.4}, \
         {z:.4}) m, cable \"{cable}\" has {tension:.4} N, and its {} is {value} N; request another pose, or widen the \
         limits (`minimum_tension_n`, `maximum_tension_n`)",
        limit.name()
    )]
    NearestBeyondLimits {
        /// Name of the cable.
        cable: String,
        /// Limit that is violated.
        limit: Limit,
        /// Tension [N].
        tension: f64,
        /// Value of the limit [N].
        value: f64,
        /// Position reached [m].
        x: f64,
        /// Position reached [m].
        y: f64,
        /// Position reached [m].
        z: f64,
    },
    /// Only the weight of a long loop of cable would hold the platform near the requested pose.
    #[error(
        "no nearest pose was found with cables up to {MAX_LENGTH_RATIO} times as long as their chords: at the last \
         one, at position ({x:.4}, {y:.4}, {z:.4}) m, cable \"{cable}\" hangs as a loop of {length:.3} m over a chord \
         of {chord:.3} m; request another pose, or give the cable a `minimum_tension_n`"
    )]
    NearestByLoop {
        /// Name of the cable.
        cable: String,
        /// Unstrained length of the free span [m].
        length: f64,
        /// Chord [m].
        chord: f64,
        /// Position reached [m].
        x: f64,
        /// Position reached [m].
        y: f64,
        /// Position reached [m].
        z: f64,
    },
    /// The tensions of a redundantly constrained robot did not converge.
    #[error(
        "no tensions found in {iterations} iterations at position ({x:.4}, {y:.4}, {z:.4}) m: {}, the scaled residual \
         is {residual:.3e}; raise the minimum tensions (`minimum_tension_n` in the robot file)",
        unrest(*change, *limit)
    )]
    TensionsNotConverged {
        /// Iterations taken.
        iterations: usize,
        /// Change of the tensions in the last step, over their size; infinite if no step was possible.
        change: f64,
        /// Limit of this change.
        limit: f64,
        /// Scaled residual reached.
        residual: f64,
        /// Position of the pose [m].
        x: f64,
        /// Position of the pose [m].
        y: f64,
        /// Position of the pose [m].
        z: f64,
    },
    /// The loads are so small that rounding of the cables' elastic forces hides them.
    #[error(
        "no equilibrium found in {iterations} iterations: the loads are too small for cables as stiff as these, whose \
         elastic forces are rounded by up to {rounding:.1e} N in all; at position ({x:.4}, {y:.4}, {z:.4}) m that \
         leaves a scaled residual of {residual:.1e} (limit {limit:.0e}); give the platform more mass or load, the \
         cables less stiffness, or no load at all"
    )]
    LostInRounding {
        /// Iterations taken.
        iterations: usize,
        /// Scaled residual reached.
        residual: f64,
        /// Limit of the scaled residual.
        limit: f64,
        /// Force that rounding may leave [N].
        rounding: f64,
        /// Position reached [m].
        x: f64,
        /// Position reached [m].
        y: f64,
        /// Position reached [m].
        z: f64,
    },
    /// The cables of a rope over sheaves are not in balance.
    #[error(
        "the rope of cable \"{cable}\" finds no rest on its sheaves: the pull of its cables differs by \
         {difference:.3e} N; give it another length (`unstrained_length_m`)"
    )]
    RopeUnbalanced {
        /// Name of the first cable of the rope.
        cable: String,
        /// Difference of ψ(T) + q·p between its cables [N].
        difference: f64,
    },
    /// A rope over sheaves in a case that is not computed.
    #[error("cable \"{cable}\" is part of a rope over sheaves: {reason}")]
    RopeOverSheaves {
        /// Name of the first cable of a rope.
        cable: String,
        /// Reason, and what to do.
        reason: RopeRefusal,
    },
    /// Ropes over sheaves do not hold a pose.
    #[error(
        "no tensions of the ropes hold this pose: a rope over sheaves has one tension in all of its cables; the best \
         tensions leave a scaled residual of {residual:.1e} (limit {RESIDUAL_LIMIT:.0e}); request another pose, or \
         give unstrained lengths"
    )]
    RopesDoNotHold {
        /// Scaled residual.
        residual: f64,
    },
    /// The search did not reach the tolerance.
    #[error(
        "no equilibrium found in {iterations} iterations: {} (limit {limit:.0e}) at position \
         ({x:.4}, {y:.4}, {z:.4}) m",
        remainder(*residual)
    )]
    NotConverged {
        /// Iterations taken.
        iterations: usize,
        /// Scaled residual reached.
        residual: f64,
        /// Limit of the scaled residual.
        limit: f64,
        /// Position reached [m].
        x: f64,
        /// Position reached [m].
        y: f64,
        /// Position reached [m].
        z: f64,
    },
}

/// Case in which statics with ropes over sheaves is not computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum RopeRefusal {
    /// Rigid cables.
    #[error("rigid cables do not say how it divides its length; choose the static model `spring` or `catenary`")]
    Ideal,
    /// Wind that drags at the cables.
    #[error("the drag of the wind on it is not computed; leave out the wind or `drag_coefficient`")]
    Wind,
    /// Tension rule that is not known for ropes over sheaves.
    #[error("its tension is chosen by the rule `lowest` or `closest` alone")]
    Rule,
    /// Analysis that is not known for ropes over sheaves.
    #[error("this analysis knows cables of their own only; `statics`, `stiffness` and `modes` know ropes over sheaves")]
    Analysis,
}

impl StaticsError {
    /// Singular pose of a robot, with the direction in which no cable pulls.
    pub(super) fn singular(robot: &Robot, pose: &Pose, model: StaticModel) -> Self {
        Self::Singular { obstacle: Obstacle::at(robot, pose, model).map(Box::new) }
    }

    /// Short name that does not change between versions, for columns of tables.
    pub fn code(&self) -> &'static str {
        match self {
            Self::NoState => "no-state",
            Self::NothingToChoose { .. } | Self::RuleOfLengths => "nothing-to-choose",
            Self::LengthCount { .. } => "length-count",
            Self::Length { .. } => "length",
            Self::CableCount { .. } | Self::InverseCableCount { .. } => "cable-count",
            Self::OutOfPlane(_) => "out-of-plane",
            Self::CoincidingEnds { .. } => "coinciding-ends",
            Self::InsidePulley { .. } => "inside-pulley",
            Self::Singular { .. } => "singular",
            Self::NegativeTension { .. }
            | Self::NotFound { .. }
            | Self::LengthsPush { .. }
            | Self::RopesDoNotHold { .. } => "negative-tension",
            Self::BeyondLimits(_) | Self::NearestBeyondLimits { .. } | Self::NoCentre { .. } => "tension-limits",
            Self::NotFoundWithinLimits { .. } => "not-found",
            Self::LimitsExclude { .. } => "limits-exclude",
            Self::NoPayload => "no-payload",
            Self::NothingRequired | Self::NoLoadFactor => "required-load",
            Self::WeightlessPayload => "weightless-payload",
            Self::UnbalancedPayload { .. } => "unbalanced-payload",
            Self::NeedsMaximum { .. } => "needs-maximum",
            Self::TargetCount { .. } => "wanted-count",
            Self::TargetTension { .. } => "wanted",
            Self::StiffestNeedsElastic | Self::StiffestNeedsSpread => "nothing-to-stiffen",
            Self::TooManyToStiffen { .. } => "too-many-to-stiffen",
            Self::NeedsElasticCables => "one-ideal",
            Self::RopeOverSheaves { .. } => "rope-over-sheaves",
            Self::NotNearest { .. } | Self::NearestByLoop { .. } => "not-nearest",
            Self::NotConverged { .. }
            | Self::LostInRounding { .. }
            | Self::TensionsNotConverged { .. }
            | Self::RopeUnbalanced { .. } => "not-converged",
        }
    }

    /// Reason why no tensions of straight cables balance the platform at the pose, whatever their limits, if that is
    /// the cause of the error.
    pub fn obstacle(&self) -> Option<&Obstacle> {
        match self {
            Self::NegativeTension { obstacle, .. } | Self::NotFound { obstacle, .. } | Self::Singular { obstacle } => {
                obstacle.as_deref()
            }
            Self::BeyondLimits(miss) | Self::NotFoundWithinLimits { miss, .. } => miss.obstacle.as_deref(),
            _ => None,
        }
    }

    /// True if the input is valid, but the robot has no such equilibrium, or none was found.
    pub fn is_no_solution(&self) -> bool {
        matches!(
            self,
            Self::Singular { .. }
                | Self::NegativeTension { .. }
                | Self::NotFound { .. }
                | Self::LengthsPush { .. }
                | Self::BeyondLimits(_)
                | Self::NoCentre { .. }
                | Self::NotFoundWithinLimits { .. }
                | Self::NoPayload
                | Self::NoLoadFactor
                | Self::UnbalancedPayload { .. }
                | Self::NotNearest { .. }
                | Self::NearestBeyondLimits { .. }
                | Self::NearestByLoop { .. }
                | Self::NotConverged { .. }
                | Self::LostInRounding { .. }
                | Self::TensionsNotConverged { .. }
                | Self::RopeUnbalanced { .. }
                | Self::RopesDoNotHold { .. }
        )
    }
}

/// Tension that is not positive, with enough digits to be told from zero; rounding is zero.
fn newtons(tension: f64) -> String {
    match tension.abs() {
        size if size < 1e-9 => "0".to_owned(),
        size if size < 1e-3 => format!("{tension:.1e}"),
        _ => format!("{tension:.4}"),
    }
}

/// Reason of an error in brackets; empty if it is not known.
fn because(obstacle: Option<&Obstacle>) -> String {
    obstacle.map_or_else(String::new, |obstacle| match obstacle {
        Obstacle::OneSided { .. } => format!(" ({obstacle}; {})", obstacle.advice()),
        Obstacle::NotSpanned { .. } => format!(" ({obstacle})"),
    })
}

/// Message of tensions beyond their limits. If even tensions without limits do not balance the load, wider limits do
/// not help, and the message says so.
fn beyond_limits(miss: &LimitViolation) -> String {
    match &miss.obstacle {
        Some(obstacle) => {
            format!("no tensions hold this pose, whatever their limits: {obstacle}; {}", obstacle.advice())
        }
        None => format!(
            "no tensions within their limits hold this pose: the best tensions violate the limits {miss}; choose \
             another pose, mass or centre of mass, or widen the limits (`minimum_tension_n`, `maximum_tension_n`)"
        ),
    }
}

fn searched(starts: usize, residual: f64, max_tension: Option<f64>) -> String {
    if starts == 0 {
        return format!("one of them would have to be more than {MAX_LENGTH_RATIO} times as long as its chord");
    }
    let starts = crate::counted(starts, "start");
    max_tension.map_or_else(
        || format!("a search from {starts} left a scaled residual of {residual:.1e} (limit {RESIDUAL_LIMIT:.0e})"),
        |max_tension| format!("a search from {starts} found only excessive tensions, up to {max_tension:.3e} N"),
    )
}

fn unrest(change: f64, limit: f64) -> String {
    if change.is_finite() {
        format!("a step still changes them by {change:.3e} of their size (limit {limit:.0e})")
    } else {
        "no step from the tensions reached stays within the limits".to_owned()
    }
}

fn remainder(residual: f64) -> String {
    if residual.is_finite() { format!("scaled residual {residual:.3e}") } else { "no finite forces".to_owned() }
}
