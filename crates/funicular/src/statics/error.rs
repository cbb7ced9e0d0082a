//! Reasons why there is no equilibrium to give, and their texts.

use super::equilibrium::RESIDUAL_LIMIT;
use super::limits::LimitViolation;
use super::loaded_cable::LONGEST;
use crate::robot::OutOfPlane;
use thiserror::Error;

/// Why there is no equilibrium to give.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StaticsError {
    /// A robot of which neither lengths nor a pose are known.
    #[error(
        "the robot has no state: give unstrained lengths or a pose, or give every cable of the robot file an \
         `unstrained_length_m`, or the file a [state] with `position_m`"
    )]
    NoState,
    /// A tension rule for as many cables as degrees of freedom, or fewer.
    #[error(
        "a tension rule has nothing to choose: {cables} cables for {dof} degrees of freedom have one set of tensions at a \
         pose; leave out the tension rule and the wanted tensions"
    )]
    NothingToChoose {
        /// Cables of the robot.
        cables: usize,
        /// Degrees of freedom of the platform.
        dof: usize,
    },
    /// A tension rule for given lengths.
    #[error(
        "a tension rule has nothing to choose: the state is given by unstrained lengths, which determine the \
         tensions; give a pose"
    )]
    RuleOfLengths,
    /// A number of lengths that is not the number of cables.
    #[error("{given} unstrained lengths for {cables} cables: give one a cable, in file order")]
    LengthCount {
        /// Lengths given.
        given: usize,
        /// Cables of the robot.
        cables: usize,
    },
    /// A length that is not positive and finite.
    #[error("unstrained length of cable \"{cable}\" is {value} m: it must be positive and finite")]
    Length {
        /// Name of the cable.
        cable: String,
        /// Value [m].
        value: f64,
    },
    /// Ideal cables, not as many as degrees of freedom.
    #[error(
        "{} for {dof} degrees of freedom: forward statics of `ideal` cables needs exactly {dof}; `spring` \
         and `catenary` cables may be fewer or more",
        crate::counted(*cables, "cable")
    )]
    CableCount {
        /// Cables of the robot.
        cables: usize,
        /// Degrees of freedom of the platform.
        dof: usize,
    },
    /// Fewer cables than degrees of freedom hold no given pose.
    #[error(
        "{} for {dof} degrees of freedom can hold no given pose: with `spring` and `catenary` cables there is the nearest pose \
         that can be held, with `ideal` cables there is none",
        crate::counted(*cables, "cable")
    )]
    InverseCableCount {
        /// Cables of the robot.
        cables: usize,
        /// Degrees of freedom of the platform.
        dof: usize,
    },
    /// A pose that a planar platform cannot have.
    #[error(transparent)]
    OutOfPlane(#[from] OutOfPlane),
    /// A cable has no length between its ends at this pose.
    #[error("cable \"{cable}\" has coinciding ends at this pose: move the platform away from its anchor")]
    CoincidingEnds {
        /// Name of the cable.
        cable: String,
    },
    /// The pose is singular: the cables do not span the degrees of freedom.
    #[error("the cables do not hold the platform at this pose: their directions are dependent (singular pose)")]
    Singular,
    /// A straight cable would have to push.
    #[error(
        "no equilibrium with cables in tension: cable \"{cable}\" would need {tension:.4} N at this pose; choose \
         another pose, mass or centre of mass"
    )]
    NegativeTension {
        /// Name of the cable that lacks most.
        cable: String,
        /// Its tension [N], not positive.
        tension: f64,
    },
    /// No tensions found for sagging cables where a straight one would have to push. That is no proof that there are
    /// none: the balance of sagging cables is not linear.
    #[error(
        "no tensions found that hold this pose: straight, cable \"{cable}\" would need {tension:.4} N; sagging, {}; \
         choose another pose, mass or centre of mass",
        searched(*starts, *residual, *greatest)
    )]
    NotFound {
        /// Name of the cable that lacks most if straight.
        cable: String,
        /// Its tension if straight [N], not positive.
        tension: f64,
        /// Number of starts of the search; none where only a cable longer than twice its chord could hold the pose.
        starts: usize,
        /// Least scaled residual reached.
        residual: f64,
        /// Greatest tension [N] of cables that do hold the pose, but with tensions out of all proportion.
        greatest: Option<f64>,
    },
    /// Ideal cables of given lengths close at a pose where one of them would push.
    #[error(
        "no equilibrium with cables in tension: ideal cables of these lengths close at position ({x:.4}, {y:.4}, \
         {z:.4}) m, where cable \"{cable}\" would need {tension:.4} N; choose other lengths, another mass or centre of \
         mass, or the static model `spring` or `catenary`, whose platform moves until all cables pull or are slack"
    )]
    LengthsPush {
        /// Name of the cable that lacks most.
        cable: String,
        /// Its tension [N], negative.
        tension: f64,
        /// Position of the platform [m].
        x: f64,
        /// Position of the platform [m].
        y: f64,
        /// Position of the platform [m].
        z: f64,
    },
    /// No tensions within the limits hold the pose; proved.
    #[error(
        "no tensions within their limits hold this pose: the nearest miss the limits {0}; choose another pose, mass or \
         centre of mass, or widen the limits (`minimum_tension_n`, `maximum_tension_n`)"
    )]
    BeyondLimits(LimitViolation),
    /// No tensions within the limits were found, and no proof that there are none: the balance of sagging cables is not
    /// linear.
    #[error(
        "no tensions within their limits found that hold this pose, in a search from {starts} starts: the nearest miss \
         the limits {miss}; choose another pose, mass or centre of mass, or widen the limits (`minimum_tension_n`, \
         `maximum_tension_n`)"
    )]
    NotFoundWithinLimits {
        /// By how much the nearest tensions found miss the limits, and which.
        miss: LimitViolation,
        /// Number of starts of the search.
        starts: usize,
    },
    /// Limits between which there is nothing.
    #[error(
        "cable \"{cable}\" may have tensions from {minimum} N to {maximum} N, which is nothing: give it a \
         `minimum_tension_n` below its maximum (without one it is 2.5 times the cable's weight)"
    )]
    LimitsExclude {
        /// Name of the cable.
        cable: String,
        /// Least tension [N].
        minimum: f64,
        /// Greatest tension [N].
        maximum: f64,
    },
    /// A rule that needs a maximum.
    #[error(
        "the tension rule `{rule}` needs a greatest tension for every cable, and cable \"{cable}\" has none: give \
         `maximum_tension_n` or `breaking_load_n` in the robot file, or choose the rule `lowest` or `closest`"
    )]
    NeedsMaximum {
        /// Name of the first cable without one.
        cable: String,
        /// Name of the rule.
        rule: &'static str,
    },
    /// A number of wanted tensions that is not the number of cables.
    #[error("{given} wanted tensions for {cables} cables: give one for all, or one a cable, in file order")]
    WantedCount {
        /// Tensions given.
        given: usize,
        /// Cables of the robot.
        cables: usize,
    },
    /// A wanted tension that is not finite or negative.
    #[error("the wanted tension is {value} N: it must be finite and not negative")]
    Wanted {
        /// Value [N].
        value: f64,
    },
    /// Ideal cables are rigid whatever their tension.
    #[error(
        "the tension rule `stiffest` has no answer for ideal cables, which are rigid: choose the static model `spring` or `catenary`"
    )]
    StiffestNeedsElastic,
    /// More cables than the rule `stiffest` is made for.
    #[error(
        "the tension rule `stiffest` is for up to {limit} cables, and the robot has {cables}: its time grows with the cube \
         of their number; choose the rule `middle`, `lowest` or `closest`"
    )]
    TooManyToStiffen {
        /// Cables of the robot.
        cables: usize,
        /// Most that the rule takes.
        limit: usize,
    },
    /// Ideal cables are rigid: their poses are those of a mechanism, not of an energy.
    #[error("a search for all equilibria needs cables that stretch: choose the static model `spring` or `catenary`")]
    NeedsElasticCables,
    /// The search for the nearest pose did not end.
    #[error(
        "no nearest pose found in {iterations} iterations: the last, at position ({x:.4}, {y:.4}, {z:.4}) m, could come \
         nearer by {residual:.1e} of the robot's size (limit {limit:.0e}); ask for a pose nearer to one that hangs freely"
    )]
    NotNearest {
        /// Iterations of forward statics taken.
        iterations: usize,
        /// Relative length by which the pose could come nearer along the equilibria, to first order.
        residual: f64,
        /// What it has to be below.
        limit: f64,
        /// Position reached [m].
        x: f64,
        /// Position reached [m].
        y: f64,
        /// Position reached [m].
        z: f64,
    },
    /// The tensions of a robot with more cables than degrees of freedom do not come to rest.
    #[error(
        "no tensions found in {iterations} iterations at position ({x:.4}, {y:.4}, {z:.4}) m: {}, the scaled residual is \
         {residual:.3e}; raise the least tensions (`minimum_tension_n` in the robot file)",
        unrest(*change, *limit)
    )]
    TensionsNotConverged {
        /// Iterations taken.
        iterations: usize,
        /// Change of the tensions in the last step, over their size; infinite if no step could be made.
        change: f64,
        /// Change asked.
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
         elastic forces are rounded by up to {rounding:.1e} N in all; at position ({x:.4}, {y:.4}, {z:.4}) m that leaves \
         a scaled residual of {residual:.1e} (limit {limit:.0e}); give the platform more mass or load, the cables less \
         stiffness, or no load at all"
    )]
    LostInRounding {
        /// Iterations taken.
        iterations: usize,
        /// Scaled residual reached.
        residual: f64,
        /// Scaled residual asked.
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
    /// The search did not reach the tolerance.
    #[error(
        "no equilibrium found in {iterations} iterations: {} (limit {limit:.0e}) at position ({x:.4}, {y:.4}, {z:.4}) m",
        remainder(*residual)
    )]
    NotConverged {
        /// Iterations taken.
        iterations: usize,
        /// Scaled residual reached.
        residual: f64,
        /// Scaled residual asked.
        limit: f64,
        /// Position reached [m].
        x: f64,
        /// Position reached [m].
        y: f64,
        /// Position reached [m].
        z: f64,
    },
}

impl StaticsError {
    /// A short name that does not change, for columns of tables.
    pub fn code(&self) -> &'static str {
        match self {
            Self::NoState => "no-state",
            Self::NothingToChoose { .. } | Self::RuleOfLengths => "nothing-to-choose",
            Self::LengthCount { .. } => "length-count",
            Self::Length { .. } => "length",
            Self::CableCount { .. } | Self::InverseCableCount { .. } => "cable-count",
            Self::OutOfPlane(_) => "out-of-plane",
            Self::CoincidingEnds { .. } => "coinciding-ends",
            Self::Singular => "singular",
            Self::NegativeTension { .. } | Self::NotFound { .. } | Self::LengthsPush { .. } => "negative-tension",
            Self::BeyondLimits(_) => "tension-limits",
            Self::NotFoundWithinLimits { .. } => "not-found",
            Self::LimitsExclude { .. } => "limits-exclude",
            Self::NeedsMaximum { .. } => "needs-maximum",
            Self::WantedCount { .. } => "wanted-count",
            Self::Wanted { .. } => "wanted",
            Self::StiffestNeedsElastic => "nothing-to-stiffen",
            Self::TooManyToStiffen { .. } => "too-many-to-stiffen",
            Self::NeedsElasticCables => "one-ideal",
            Self::NotNearest { .. } => "not-nearest",
            Self::NotConverged { .. } | Self::LostInRounding { .. } | Self::TensionsNotConverged { .. } => {
                "not-converged"
            }
        }
    }

    /// Whether nothing is wrong with what was asked: the robot has no such equilibrium, or none was found.
    pub fn is_no_solution(&self) -> bool {
        matches!(
            self,
            Self::Singular
                | Self::NegativeTension { .. }
                | Self::NotFound { .. }
                | Self::LengthsPush { .. }
                | Self::BeyondLimits(_)
                | Self::NotFoundWithinLimits { .. }
                | Self::NotNearest { .. }
                | Self::NotConverged { .. }
                | Self::LostInRounding { .. }
                | Self::TensionsNotConverged { .. }
        )
    }
}

fn searched(starts: usize, residual: f64, greatest: Option<f64>) -> String {
    if starts == 0 {
        return format!("one of them would have to be more than {LONGEST} times as long as its chord");
    }
    let starts = crate::counted(starts, "start");
    greatest.map_or_else(
        || format!("a search from {starts} left a scaled residual of {residual:.1e} (limit {RESIDUAL_LIMIT:.0e})"),
        |greatest| format!("a search from {starts} found only tensions up to {greatest:.3e} N, out of all proportion"),
    )
}

fn unrest(change: f64, limit: f64) -> String {
    if change.is_finite() {
        format!("a step still changes them by {change:.3e} of their size (limit {limit:.0e})")
    } else {
        "from those that were reached there is no step within the limits".to_owned()
    }
}

fn remainder(residual: f64) -> String {
    if residual.is_finite() { format!("scaled residual {residual:.3e}") } else { "no finite forces".to_owned() }
}
