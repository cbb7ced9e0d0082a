//! Static equilibrium: lengths to pose ([`forward`]), pose to lengths ([`inverse`]).

mod all;
mod drag;
mod energy;
mod forward;
mod inverse;
mod limits;
mod nearest;
mod rest;
mod start;
mod tension;

pub use all::{Candidate, Candidates, all, other_stable};
pub use drag::{antisymmetric_part, drag_effect, drag_stiffness, tangent_with_drag};
pub use energy::energy;
pub use forward::forward;
pub use inverse::inverse;
pub use limits::{Limit, TensionMargin, TensionRange};
pub use nearest::{Nearest, distance, nearest};
pub use rest::{Rest, rest};
pub use tension::{Miss, TensionRule, distribute};

use crate::catenary::Rope;
use crate::catenary::space::HangingCable;
use crate::math::{Mat3, Mat6, Vec3, Vec6, inertia, skew};
use crate::robot::{LineLoad, Load, OutOfPlane, Pose, Robot};
use thiserror::Error;

/// How a cable carries its static load.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StaticModel {
    /// Straight, massless, rigid in length; pulls as equilibrium asks, and has none where it would have to push.
    Ideal,
    /// Straight, massless, elastic; no force when slack.
    Spring,
    /// Elastic catenary under its own weight.
    #[default]
    Catenary,
}

impl StaticModel {
    /// All of them, simplest first.
    pub const ALL: [Self; 3] = [Self::Ideal, Self::Spring, Self::Catenary];

    /// Its name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ideal => "ideal",
            Self::Spring => "spring",
            Self::Catenary => "catenary",
        }
    }
}

/// One cable at equilibrium.
#[derive(Debug, Clone, PartialEq)]
pub struct CableState {
    /// Attachment in the world [m].
    pub attachment_w: Vec3,
    /// Lever arm from the platform origin to the attachment, world axes [m].
    pub lever_w: Vec3,
    /// Anchor in the world [m].
    pub anchor_w: Vec3,
    /// Unstrained length [m]; of an ideal cable its length.
    pub unstrained_length: f64,
    /// Force of the cable on the platform, world axes [N].
    pub force_on_platform_w: Vec3,
    /// Tension at the platform end [N].
    pub tension_platform: f64,
    /// Tension at the anchor [N].
    pub tension_anchor: f64,
    /// The curve; none for an ideal cable.
    pub hanging: Option<HangingCable>,
}

impl CableState {
    /// Chord, attachment to anchor, world axes [m].
    pub fn chord_w(&self) -> Vec3 {
        self.anchor_w - self.attachment_w
    }

    /// Length of the chord [m].
    pub fn chord(&self) -> f64 {
        self.chord_w().norm()
    }

    /// Static stiffness of the platform end, 3×3, world axes [N/m]; none for an ideal cable.
    pub fn tangent_w(&self) -> Option<Mat3> {
        self.hanging.as_ref().map(HangingCable::tangent_w)
    }

    /// No force between the ends: a massless cable longer than its chord, or one that hangs straight down as a loop.
    pub fn is_slack(&self) -> bool {
        let no_force = |h: &HangingCable| h.catenary.parallel_tension() <= 0.0;
        self.hanging.as_ref().map_or(self.tension_platform == 0.0, no_force)
    }
}

/// A static equilibrium of a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Equilibrium {
    /// Pose of the platform.
    pub pose: Pose,
    /// The model it was found with.
    pub model: StaticModel,
    /// The cables, in file order.
    pub cables: Vec<CableState>,
    /// What is left of the wrench: the larger of force and moment/ℓ over the sum of all tensions and the weight. Zero
    /// where no load acts and all tensions together are rounding, see [`carries_nothing`].
    pub residual: f64,
    /// Iterations taken.
    pub iterations: usize,
    /// Whether it is stable.
    pub stability: Stability,
}

/// What the static stiffness says of an equilibrium: the signs of the eigenvalues of its symmetric part, which is the work
/// that a small displacement takes. In wind it is the symmetric part of [`tangent_with_drag`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stability {
    /// Every small displacement is opposed; the least eigenvalue of the scaled stiffness S K S [N/m].
    Stable {
        /// Least eigenvalue [N/m].
        least_stiffness: f64,
    },
    /// Some displacement is not opposed.
    Unstable {
        /// Least eigenvalue [N/m]; negative, or exactly zero where it is rounding: then the equilibrium is indifferent.
        least_stiffness: f64,
        /// Number of directions that are not opposed.
        directions: usize,
    },
    /// An ideal robot is rigid; the question does not arise.
    Rigid,
}

/// Why there is no equilibrium to give.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StaticsError {
    /// A robot of which neither lengths nor a pose are known.
    #[error(
        "the robot has no state: give unstrained lengths or a pose, or give every cable of the robot file an \
         `unstrained_length_m`, or the file a [state] with `position_m`"
    )]
    NoState,
    /// A tension rule for as many cables as freedoms, or fewer.
    #[error(
        "a tension rule has nothing to choose: {cables} cables for {freedoms} freedoms have one set of tensions at a \
         pose; leave out the tension rule and the wanted tensions"
    )]
    NothingToChoose {
        /// Cables of the robot.
        cables: usize,
        /// Freedoms of the platform.
        freedoms: usize,
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
    /// Ideal cables, not as many as freedoms.
    #[error(
        "{} for {freedoms} freedoms: forward statics of `ideal` cables needs exactly {freedoms}; `spring` \
         and `catenary` cables may be fewer or more",
        crate::counted(*cables, "cable")
    )]
    CableCount {
        /// Cables of the robot.
        cables: usize,
        /// Freedoms of the platform.
        freedoms: usize,
    },
    /// Fewer cables than freedoms hold no given pose.
    #[error(
        "{} for {freedoms} freedoms can hold no given pose: with `spring` and `catenary` cables there is the nearest pose \
         that can be held, with `ideal` cables there is none",
        crate::counted(*cables, "cable")
    )]
    InverseCableCount {
        /// Cables of the robot.
        cables: usize,
        /// Freedoms of the platform.
        freedoms: usize,
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
    /// The pose is singular: the cables do not span the freedoms.
    #[error("the cables do not hold the platform at this pose: their directions are dependent (singular pose)")]
    Singular,
    /// A straight cable would have to push.
    #[error(
        "no equilibrium with cables in tension: cable \"{cable}\" would need {tension:.4} N at this pose; choose \
         another pose, mass or centre of mass"
    )]
    WouldPush {
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
    BeyondLimits(Miss),
    /// No tensions within the limits were found, and no proof that there are none: the balance of sagging cables is not
    /// linear.
    #[error(
        "no tensions within their limits found that hold this pose, in a search from {starts} starts: the nearest miss \
         the limits {miss}; choose another pose, mass or centre of mass, or widen the limits (`minimum_tension_n`, \
         `maximum_tension_n`)"
    )]
    NotFoundWithinLimits {
        /// By how much the nearest tensions found miss the limits, and which.
        miss: Miss,
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
    NothingToStiffen,
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
    OneIdeal,
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
    /// The tensions of a robot with more cables than freedoms do not come to rest.
    #[error(
        "no tensions found in {iterations} iterations at position ({x:.4}, {y:.4}, {z:.4}) m: {}, the scaled residual is \
         {residual:.3e}; raise the least tensions (`minimum_tension_n`, `--min-tension-n`)",
        unrest(*change, *limit)
    )]
    Unsettled {
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

fn searched(starts: usize, residual: f64, greatest: Option<f64>) -> String {
    if starts == 0 {
        return format!("one of them would have to be more than {} times as long as its chord", inverse::LONGEST);
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
            Self::WouldPush { .. } | Self::NotFound { .. } | Self::LengthsPush { .. } => "would-push",
            Self::BeyondLimits(_) => "beyond-limits",
            Self::NotFoundWithinLimits { .. } => "not-found",
            Self::LimitsExclude { .. } => "limits-exclude",
            Self::NeedsMaximum { .. } => "needs-maximum",
            Self::WantedCount { .. } => "wanted-count",
            Self::Wanted { .. } => "wanted",
            Self::NothingToStiffen => "nothing-to-stiffen",
            Self::TooManyToStiffen { .. } => "too-many-to-stiffen",
            Self::OneIdeal => "one-ideal",
            Self::NotNearest { .. } => "not-nearest",
            Self::NotConverged { .. } | Self::LostInRounding { .. } | Self::Unsettled { .. } => "not-converged",
        }
    }

    /// Whether nothing is wrong with what was asked: the robot has no such equilibrium, or none was found.
    pub fn is_no_solution(&self) -> bool {
        matches!(
            self,
            Self::Singular
                | Self::WouldPush { .. }
                | Self::NotFound { .. }
                | Self::LengthsPush { .. }
                | Self::BeyondLimits(_)
                | Self::NotFoundWithinLimits { .. }
                | Self::NotNearest { .. }
                | Self::NotConverged { .. }
                | Self::LostInRounding { .. }
                | Self::Unsettled { .. }
        )
    }
}

/// Scaled residual below which an equilibrium counts as found; rounding leaves 1e-15 to 1e-12.
pub const RESIDUAL_LIMIT: f64 = 1e-10;

/// Largest scaled residual that rounding excuses. Very stiff cables under a very small load have a residual that no pose
/// in floating point brings below [`RESIDUAL_LIMIT`]; up to this one the tensions are right to six digits, which is more
/// than any input has. Beyond it rounding would soon be all there is, and the place no more than a guess.
pub const MAX_RESIDUAL_OF_ROUNDING: f64 = 1e-6;

/// Relative rounding of a chord, in units of [`f64::EPSILON`]: coordinates of some chords' length, a few operations.
const CHORD_ROUNDING: f64 = 8.0;

/// Force that rounding of all chords leaves in the balance [N]: strains of [`CHORD_ROUNDING`] in all cables.
fn elastic_rounding(robot: &Robot) -> f64 {
    let stiffness: f64 = robot.cables.iter().map(|cable| cable.material.axial_stiffness).sum();
    CHORD_ROUNDING * f64::EPSILON * stiffness
}

/// Whether nothing is there to be balanced: nothing acts on the platform or its cables, and all tensions together are no
/// more than rounding of the cables' elastic forces. A residual relative to them would be nothing over nothing.
///
/// # Example
/// ```
/// # use funicular::{math::Vec3, robot::Robot, statics::{self, StaticModel}};
/// # let mut robot = Robot::from_toml(include_str!("../../../robots/yuan2014-4mm.toml"))?;
/// let lengths = [6.863, 6.565, 6.756, 6.663, 6.801, 6.604];
/// robot.gravity_w = Vec3::zeros();
/// let afloat = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
/// assert!(statics::carries_nothing(&robot, &afloat) && afloat.residual == 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn carries_nothing(robot: &Robot, equilibrium: &Equilibrium) -> bool {
    let tensions: f64 = equilibrium.cables.iter().map(|cable| cable.force_on_platform_w.norm()).sum();
    let loads = LoadedCable::all(robot, &equilibrium.pose, equilibrium.model);
    load_size(robot) == 0.0 && loads.iter().all(|cable| cable.load.size == 0.0) && tensions <= elastic_rounding(robot)
}

/// A cable without its length: where its anchor is, what it is made of and what acts on it.
#[derive(Debug, Clone, Copy)]
struct LoadedCable {
    attachment_p: Vec3,
    anchor_w: Vec3,
    axial_stiffness: f64,
    /// The load, which of a straight model counts nothing.
    load: LineLoad,
}

impl LoadedCable {
    /// Cable `i` as a static model sees it, with the load that it has at a pose.
    fn at(robot: &Robot, i: usize, pose: &Pose, model: StaticModel) -> Self {
        let cable = &robot.cables[i];
        let mut load = robot.line_load(i, &(cable.anchor_w - pose.point_w(&cable.attachment_p)));
        if model != StaticModel::Catenary {
            load.size = 0.0;
        }
        let axial_stiffness = cable.material.axial_stiffness;
        Self { attachment_p: cable.attachment_p, anchor_w: cable.anchor_w, axial_stiffness, load }
    }

    /// All cables.
    fn all(robot: &Robot, pose: &Pose, model: StaticModel) -> Vec<Self> {
        (0..robot.cables.len()).map(|i| Self::at(robot, i, pose, model)).collect()
    }

    /// Hung from the platform at a pose with an unstrained length [m].
    fn hang(&self, pose: &Pose, unstrained_length: f64) -> HangingCable {
        let (weight_per_length, axial_stiffness) = (self.load.size, self.axial_stiffness);
        let rope = Rope { unstrained_length, weight_per_length, axial_stiffness };
        HangingCable::between(pose.point_w(&self.attachment_p), self.anchor_w, self.load.up_w, rope)
    }

    /// Hung so that the tension parallel to its chord is this [N]; not far slacker than its weight has it.
    fn hang_with_tension(&self, pose: &Pose, tension: f64) -> HangingCable {
        let start_w = pose.point_w(&self.attachment_p);
        let rope = Rope {
            // The tension fixes the length; this one is where the search for it begins.
            unstrained_length: (self.anchor_w - start_w).norm(),
            weight_per_length: self.load.size,
            axial_stiffness: self.axial_stiffness,
        };
        HangingCable::with_parallel_tension(start_w, self.anchor_w, self.load.up_w, rope, tension)
    }
}

/// Wrench (force, moment about the platform origin) of a force at a lever arm.
pub(crate) fn wrench_of(force: &Vec3, lever: &Vec3) -> Vec6 {
    let moment = lever.cross(force);
    Vec6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
}

/// Wrench of gravity, wind and load on the platform about its origin, at a pose.
fn load_wrench(robot: &Robot, pose: &Pose) -> Vec6 {
    let Load { force_w, moment_w, point_p } = &robot.load;
    wrench_of(&robot.force_at_mass_centre_w(), &(pose.rot_wp * robot.platform.center_of_mass_p))
        + wrench_of(force_w, &(pose.rot_wp * point_p))
        + Vec6::new(0.0, 0.0, 0.0, moment_w.x, moment_w.y, moment_w.z)
}

/// The size of what acts on the platform [N]: weight, force, and moment over ℓ.
fn load_size(robot: &Robot) -> f64 {
    let Load { force_w, moment_w, .. } = &robot.load;
    robot.force_at_mass_centre_w().norm() + force_w.norm() + moment_w.norm() / robot.platform_length()
}

/// A wrench with its moments divided by ℓ: one unit throughout.
fn scaled_wrench(wrench: &Vec6, ell: f64) -> Vec6 {
    Vec6::from_fn(|i, _| if i < 3 { wrench[i] } else { wrench[i] / ell })
}

/// Adds `Jᵀ K J` of a 3×3 stiffness at a lever arm, `J = [I, −[r]×]`.
pub(crate) fn add_congruent(total: &mut Mat6, stiffness: &Mat3, lever: &Vec3) {
    let cross = skew(lever);
    let coupling = stiffness * cross;
    let mut add = |row: usize, column: usize, block: &Mat3| {
        let mut view = total.fixed_view_mut::<3, 3>(row, column);
        view += block;
    };
    add(0, 0, stiffness);
    add(0, 3, &-coupling);
    add(3, 0, &(cross * stiffness));
    add(3, 3, &-(cross * coupling));
}

/// Adds the stiffness of a dead force at a lever arm, `−[f]×[r]×` in the rotation block (theory, section 3).
pub(crate) fn add_lever_term(total: &mut Mat6, force: &Vec3, lever: &Vec3) {
    let mut view = total.fixed_view_mut::<3, 3>(3, 3);
    view -= skew(force) * skew(lever);
}

/// Adds the stiffness of weight and load at a pose: those of dead forces, and half the moment, `½[m]×` in the rotation
/// block, which makes the whole symmetric (theory, section 14).
pub(crate) fn add_load_terms(total: &mut Mat6, robot: &Robot, pose: &Pose) {
    let Load { force_w, moment_w, point_p } = &robot.load;
    add_lever_term(total, &robot.force_at_mass_centre_w(), &(pose.rot_wp * robot.platform.center_of_mass_p));
    add_lever_term(total, force_w, &(pose.rot_wp * point_p));
    let mut view = total.fixed_view_mut::<3, 3>(3, 3);
    view += skew(moment_w) * 0.5;
}

/// `S M S` with `S = diag(1, 1, 1, 1/ℓ, 1/ℓ, 1/ℓ)`: one unit throughout.
pub(crate) fn scaled(matrix: &Mat6, platform_length: f64) -> Mat6 {
    let scale = |i: usize| if i < 3 { 1.0 } else { 1.0 / platform_length };
    Mat6::from_fn(|i, j| matrix[(i, j)] * scale(i) * scale(j))
}

/// Tangent stiffness `−∂wrench/∂(δp, δθ)` of cables, platform weight and load at an equilibrium, about the platform
/// origin, world axes [N/m, N, N·m]. This is the `Consistent` static stiffness; symmetric at an equilibrium.
///
/// Every load keeps its direction: in wind this is the stiffness under the drag of the equilibrium, held. The stiffness with
/// a drag that turns with the cables is [`tangent_with_drag`].
///
/// `None` for ideal cables, which have no finite stiffness. Zero for motions that the platform does not have. Of a moment
/// the antisymmetric half is left out: such a moment has no energy.
///
/// # References
/// docs/theory.md, equation (14).
pub fn tangent_stiffness(robot: &Robot, equilibrium: &Equilibrium) -> Option<Mat6> {
    let parts: Option<Vec<_>> = equilibrium
        .cables
        .iter()
        .map(|cable| Some((cable.tangent_w()?, cable.force_on_platform_w, cable.lever_w)))
        .collect();
    let freedoms = &robot.platform.freedoms;
    let whole = assembled(robot, &equilibrium.pose, parts?.into_iter());
    Some(freedoms.expanded_matrix(&freedoms.reduced_matrix(&whole)))
}

/// Stiffness of cables (3×3, force on the platform, lever arm) and of weight and load at a pose.
fn assembled(robot: &Robot, pose: &Pose, cables: impl Iterator<Item = (Mat3, Vec3, Vec3)>) -> Mat6 {
    let mut total = Mat6::zeros();
    for (stiffness, force, lever) in cables {
        add_congruent(&mut total, &stiffness, &lever);
        add_lever_term(&mut total, &force, &lever);
    }
    add_load_terms(&mut total, robot, pose);
    total
}

/// How much tension a load may take at most: the least norm of the tensions [N] that balance the worst wrench of size one
/// (a force of 1 N, a moment of ℓ N m, or both in part), 1 over the least singular value of the scaled unit wrenches. The
/// nearer to a singular pose, the larger.
///
/// Slack cables balance nothing. `None` where the others are fewer than the freedoms, infinite at a singular pose.
pub fn tension_gain(robot: &Robot, equilibrium: &Equilibrium) -> Option<f64> {
    let n = robot.platform.freedoms.count();
    let (values, _) = inertia::eigen(&wrench_gram(robot, equilibrium)?, n);
    // Squares below the rounding of their sum are none.
    let least = if values[0] > 1e-14 * values[n - 1] { values[0] } else { 0.0 };
    Some(1.0 / least.sqrt())
}

/// Whether [`tension_gain`] is above a limit; in a fraction of its time.
pub(crate) fn tension_gain_exceeds(robot: &Robot, equilibrium: &Equilibrium, limit: f64) -> bool {
    let Some(mut gram) = wrench_gram(robot, equilibrium) else { return false };
    let n = robot.platform.freedoms.count();
    for k in 0..6 {
        gram[(k, k)] += if k < n { -1.0 / (limit * limit) } else { 1.0 };
    }
    gram.cholesky().is_none()
}

/// Sum of the squares of the scaled unit wrenches of all cables that are not slack, in the platform's coordinates; `None`
/// where they are fewer than the freedoms.
fn wrench_gram(robot: &Robot, equilibrium: &Equilibrium) -> Option<Mat6> {
    let ell = robot.platform_length();
    let freedoms = &robot.platform.freedoms;
    let (mut gram, mut pulling) = (Mat6::zeros(), 0);
    for cable in equilibrium.cables.iter().filter(|cable| !cable.is_slack()) {
        let force = cable.force_on_platform_w.try_normalize(0.0).unwrap_or_else(|| cable.chord_w().normalize());
        let unit = freedoms.reduced(&wrench_of(&force, &(cable.lever_w / ell)));
        gram += unit * unit.transpose();
        pulling += 1;
    }
    (pulling >= freedoms.count()).then_some(gram)
}

/// Total wrench on the platform at any pose, cables, weight and load, about the platform origin [N, N·m]; the residual of
/// equilibrium.
///
/// # Errors
/// A number of lengths that is not that of the cables, or a length that is not positive.
pub fn wrench(robot: &Robot, pose: &Pose, lengths: &[f64], model: StaticModel) -> Result<Vec6, StaticsError> {
    check_lengths(robot, lengths)?;
    let forces = lengths.iter().enumerate().map(|(i, &length)| {
        let cable = LoadedCable::at(robot, i, pose, model).hang(pose, length);
        (cable.force_on_start_w(), cable.start_w - pose.position_w)
    });
    Ok(balance(robot, pose, forces).0)
}

fn check_lengths(robot: &Robot, lengths: &[f64]) -> Result<(), StaticsError> {
    if lengths.len() != robot.cables.len() {
        return Err(StaticsError::LengthCount { given: lengths.len(), cables: robot.cables.len() });
    }
    match lengths.iter().position(|length| !(*length > 0.0 && length.is_finite())) {
        Some(i) => Err(StaticsError::Length { cable: robot.cables[i].name.clone(), value: lengths[i] }),
        None => Ok(()),
    }
}

/// The larger of force and moment/ℓ, over all tensions and the weight; what the platform cannot do is not counted.
fn scaled_residual(robot: &Robot, wrench: &Vec6, force_scale: f64) -> f64 {
    let wrench = robot.platform.freedoms.allowed(wrench);
    let force = wrench.fixed_rows::<3>(0).norm();
    let moment = wrench.fixed_rows::<3>(3).norm() / robot.platform_length();
    if force_scale > 0.0 { force.max(moment) / force_scale } else { force.max(moment) }
}

/// Collects an equilibrium from cables that hang at a pose.
fn collect(
    robot: &Robot,
    pose: Pose,
    model: StaticModel,
    hanging: Vec<HangingCable>,
    unstrained_lengths: &[f64],
    iterations: usize,
) -> Equilibrium {
    let cables: Vec<CableState> = hanging
        .into_iter()
        .zip(unstrained_lengths)
        .map(|(cable, &unstrained_length)| CableState {
            attachment_w: cable.start_w,
            lever_w: cable.start_w - pose.position_w,
            anchor_w: cable.end_w,
            unstrained_length,
            force_on_platform_w: cable.force_on_start_w(),
            tension_platform: cable.catenary.tension_at_start(),
            tension_anchor: cable.catenary.tension_at_end(),
            hanging: Some(cable),
        })
        .collect();
    let residual = residual_of(robot, &pose, &cables);
    let mut equilibrium = Equilibrium { pose, model, cables, residual, iterations, stability: Stability::Rigid };
    if let Some(stiffness) = tangent_with_drag(robot, &equilibrium) {
        equilibrium.stability = stability(robot, &stiffness);
    }
    equilibrium
}

/// Scaled residual of a set of cable states at a pose.
fn residual_of(robot: &Robot, pose: &Pose, cables: &[CableState]) -> f64 {
    let (wrench, scale) = balance(robot, pose, cables.iter().map(|c| (c.force_on_platform_w, c.lever_w)));
    scaled_residual(robot, &wrench, scale)
}

/// Sum of the platform's weight and load and of cable forces at their lever arms, as a wrench about the platform origin; and the
/// sum of the sizes of all these forces [N], which residuals are measured by.
fn balance(robot: &Robot, pose: &Pose, forces: impl Iterator<Item = (Vec3, Vec3)>) -> (Vec6, f64) {
    forces.fold((load_wrench(robot, pose), load_size(robot)), |(wrench, scale), (force, lever)| {
        (wrench + wrench_of(&force, &lever), scale + force.norm())
    })
}

fn stability(robot: &Robot, stiffness: &Mat6) -> Stability {
    let n = robot.platform.freedoms.count();
    let scaled = scaled(&((stiffness + stiffness.transpose()) * 0.5), robot.platform_length());
    let values = inertia::eigenvalues(&robot.platform.freedoms.reduced_matrix(&scaled), n);
    // Rounding in the sum of the cables' stiffnesses; seen: 1e-16 of the largest.
    let zero = 1e-12 * values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let directions = values.iter().filter(|v| **v <= zero).count();
    match directions {
        0 => Stability::Stable { least_stiffness: values[0] },
        _ => Stability::Unstable { least_stiffness: if values[0] < -zero { values[0] } else { 0.0 }, directions },
    }
}
