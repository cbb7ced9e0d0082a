//! Cable between two given points as a function of one number, its tension parallel to the chord.

use crate::catenary::space::HangingCable;
use crate::catenary::{Catenary, Rope};
use crate::math::{Mat3, Mat6, Vec3, Vec6};
use crate::platform::{Coordinates, add_congruent, add_lever_term, wrench_of};
use crate::robot::{Pose, Robot};
use crate::statics::limits::{Limit, TensionRange};
use crate::statics::loaded_cable::LoadedCable;
use crate::statics::model::StaticModel;

/// Cable at the pose; the first one of a rope over sheaves, with the others.
///
/// At a given geometry the tension τ parallel to the chord, (10a), determines the cable: the horizontal force is
/// exactly τ cos α, the vertical force is nearly linear in τ, and above [`Catenary::MIN_TENSION_TO_WEIGHT`] every
/// tension in the cable grows with τ. So limits at the ends are limits of τ.
#[derive(Debug, Clone)]
pub(in crate::statics) struct CableAtPose {
    pub hanging: HangingCable,
    lever_w: Vec3,
    coordinates: Coordinates,
    span: f64,
    rise: f64,
    /// Limits of the tension.
    pub range: TensionRange,
    /// Minimum τ that is considered [N].
    pub slackest: f64,
    tau: f64,
    /// Derivative dL0/dτ [m/N].
    length_rate: f64,
    /// Index of the cable in the robot.
    pub index: usize,
    /// Other cables of its rope, which hang with the same ψ(T) + q·p.
    pub others: Vec<CableAtPose>,
}

/// Place in a cable where its tension has its minimum or maximum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TensionPlace {
    /// End at the platform.
    Platform,
    /// End at the anchor.
    Anchor,
    /// Lowest point, between the ends.
    LowestPoint,
    /// Anywhere: a cable without load has the same tension everywhere.
    Anywhere,
}

impl TensionPlace {
    /// Name in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Platform => "platform",
            Self::Anchor => "anchor",
            Self::LowestPoint => "lowest point",
            Self::Anywhere => "anywhere",
        }
    }
}

/// Tension at a point of the cable and its derivative with respect to τ.
#[derive(Debug, Clone, Copy)]
pub(in crate::statics) struct TensionByTau {
    pub value: f64,
    pub slope: f64,
}

impl CableAtPose {
    /// Cable `i`, taut enough for its derivatives to be those of a taut cable; its ends must not coincide.
    pub(in crate::statics) fn new(
        robot: &Robot,
        i: usize,
        pose: &Pose,
        model: StaticModel,
        coordinates: Coordinates,
    ) -> Self {
        let cable = LoadedCable::at(robot, i, pose, model);
        let attachment_w = pose.point_w(&cable.cable.attachment_p);
        let chord_w = cable.chord_w(pose);
        let range = TensionRange::of(robot, i, &chord_w);
        let slackest = Catenary::MIN_TENSION_TO_WEIGHT * cable.load.size * chord_w.norm();
        let tau = range.minimum.max(6.0 * slackest);
        let hanging = cable.hang_with_tension(pose, tau);
        Self {
            lever_w: attachment_w - pose.position_w,
            coordinates,
            span: hanging.catenary.span(),
            rise: chord_w.dot(&cable.load.up_w),
            range,
            slackest,
            tau,
            length_rate: 1.0 / hanging.catenary.parallel_tension_by_length(),
            hanging,
            index: i,
            others: Vec::new(),
        }
    }

    /// First cable of a rope over sheaves with the others, each with the limits of all; without limits if `is_limited`
    /// is false. It hangs with the tension `tau` [N], or with the slackest one if that is higher.
    pub(in crate::statics) fn with_others(mut self, others: Vec<Self>, is_limited: bool, tau: f64) -> Self {
        let ranges = || std::iter::once(&self).chain(&others).map(|cable| cable.range);
        let range = if is_limited {
            TensionRange {
                minimum: ranges().map(|range| range.minimum).fold(0.0, f64::max),
                maximum: ranges().map(|range| range.maximum).fold(f64::INFINITY, f64::min),
            }
        } else {
            TensionRange { minimum: 0.0, maximum: f64::INFINITY }
        };
        self.range = range;

        // Every cable of the rope is at its slackest, or tauter.
        for mut other in others {
            other.range = range;
            other.set(other.slackest.max(f64::MIN_POSITIVE));
            let potential = other.potential(&self);
            self.set_tension(self.tension_of(potential));
            self.slackest = self.slackest.max(self.tau);
            self.others.push(other);
        }
        self.set(tau.max(self.slackest));
        self
    }

    /// Sum ψ(T) + q·p at the platform end, heights counted from that end of the cable `from` [N].
    fn potential(&self, from: &Self) -> f64 {
        let tension = self.start_tension().value;
        let lifted = self.hanging.load_w().dot(&(self.hanging.start_w - from.hanging.start_w));
        tension * (1.0 + 0.5 * tension / self.axial_stiffness()) + lifted
    }

    /// Tension with ψ(T) equal to this value [N]; zero if it is negative.
    fn tension_of(&self, potential: f64) -> f64 {
        let potential = potential.max(0.0);
        2.0 * potential / (1.0 + (1.0 + 2.0 * potential / self.axial_stiffness()).sqrt())
    }

    /// Hangs the cable alone with this tension at the platform [N], or as slack as it may be.
    fn set_tension(&mut self, tension: f64) {
        let least = self.slackest.max(f64::MIN_POSITIVE);
        let mut tau = self.tau.max(least);
        // The tension at the end is nearly linear in τ: 2 to 4 passes. The limit is a guard.
        for _ in 0..30 {
            self.set_alone(tau);
            let here = self.start_tension();
            let next = (tau + (tension - here.value) / here.slope).max(least);
            if (next - tau).abs() <= 2.0 * f64::EPSILON * next {
                break;
            }
            tau = next;
        }
        self.set_alone(tau);
    }

    /// Tension at the platform end.
    fn start_tension(&self) -> TensionByTau {
        let [lower, upper] = self.own_ends();
        if self.rise > 0.0 { lower } else { upper }
    }

    /// Change of the τ of another cable of the rope per change of τ.
    fn rate_of(&self, other: &Self) -> f64 {
        let by_tau = |cable: &Self| {
            let tension = cable.start_tension();
            (1.0 + tension.value / cable.axial_stiffness()) * tension.slope
        };
        by_tau(self) / by_tau(other)
    }

    /// Cables of its rope, the others after it.
    pub(in crate::statics) fn all(&self) -> impl Iterator<Item = &Self> {
        std::iter::once(self).chain(&self.others)
    }

    /// Hangs the cable, and with it the others of its rope, with another τ [N].
    pub(in crate::statics) fn set(&mut self, tau: f64) {
        self.set_alone(tau);
        let mut others = std::mem::take(&mut self.others);
        for other in &mut others {
            let lifted = other.hanging.load_w().dot(&(other.hanging.start_w - self.hanging.start_w));
            other.set_tension(other.tension_of(self.potential(self) - lifted));
        }
        self.others = others;
    }

    fn set_alone(&mut self, tau: f64) {
        let rope = self.hanging.catenary.rope();
        self.hanging.catenary = Catenary::with_parallel_tension(self.span, self.rise, rope, tau);
        self.length_rate = 1.0 / self.hanging.catenary.parallel_tension_by_length();
        self.tau = tau;
    }

    /// Value of τ at which the minimum tension in the cable is at its limit, or the slackest τ if that is higher. Hangs
    /// the cable with it.
    pub(in crate::statics) fn at_minimum(&mut self) -> f64 {
        let mut tau = self.range.minimum.max(self.slackest);
        // The minimum tension is nearly linear in τ: 2 or 3 passes. The limit is a guard.
        for _ in 0..30 {
            self.set(tau);
            let min = self.min_tension();
            let next = (tau + (self.range.minimum - min.value) / min.slope).max(self.slackest);
            if (next - tau).abs() <= 1e-12 * next {
                break;
            }
            tau = next;
        }
        tau
    }

    /// Hangs the cable with the τ at which its maximum tension is at the limit; without a limit, with a τ equal to its
    /// axial stiffness, which stretches it to twice its length.
    pub(in crate::statics) fn at_maximum(&mut self) {
        if self.range.maximum.is_infinite() {
            self.set(self.rope().axial_stiffness);
            return;
        }
        let mut tau = self.range.maximum.max(self.slackest);
        // As for the minimum tension.
        for _ in 0..30 {
            self.set(tau);
            let max = self.max_tension();
            let next = (tau + (self.range.maximum - max.value) / max.slope).max(self.slackest);
            if (next - tau).abs() <= 1e-12 * next {
                break;
            }
            tau = next;
        }
    }

    /// Place where the tension is at its minimum or maximum.
    pub(in crate::statics) fn place(&self, limit: Limit) -> TensionPlace {
        if self.rope().weight_per_length == 0.0 {
            return TensionPlace::Anywhere;
        }
        match (limit, self.rise > 0.0) {
            (Limit::Minimum, _) if self.lowest_between_ends() => TensionPlace::LowestPoint,
            (Limit::Minimum, true) | (Limit::Maximum, false) => TensionPlace::Platform,
            (Limit::Minimum, false) | (Limit::Maximum, true) => TensionPlace::Anchor,
        }
    }

    /// True if the lowest point of the cable is between its ends.
    fn lowest_between_ends(&self) -> bool {
        let catenary = &self.hanging.catenary;
        catenary.vertical_force_at_start() < 0.0 && catenary.vertical_force_at_end() > 0.0
    }

    /// Axial stiffness EA [N].
    pub(in crate::statics) fn axial_stiffness(&self) -> f64 {
        self.rope().axial_stiffness
    }

    fn rope(&self) -> Rope {
        self.hanging.catenary.rope()
    }

    /// Parallel tension τ [N].
    pub(in crate::statics) fn tau(&self) -> f64 {
        self.tau
    }

    /// Unstrained length [m] and its derivative with respect to τ [m/N].
    pub(in crate::statics) fn length(&self) -> [f64; 2] {
        [self.rope().unstrained_length, self.length_rate]
    }

    /// Load per unstrained length [N/m].
    pub(in crate::statics) fn weight_per_length(&self) -> f64 {
        self.rope().weight_per_length
    }

    /// Sine of the chord's inclination, positive if the anchor is above the platform.
    pub(in crate::statics) fn sin(&self) -> f64 {
        self.rise / self.hanging.chord_w().norm()
    }

    /// Forces of all cables of its rope on the platform with their lever arms, world axes.
    pub(in crate::statics) fn forces(&self) -> impl Iterator<Item = (Vec3, Vec3)> {
        self.all().map(Self::force)
    }

    /// Force on the platform and lever arm, world axes.
    pub(in crate::statics) fn force(&self) -> (Vec3, Vec3) {
        (self.hanging.force_on_start_w(), self.lever_w)
    }

    /// Derivative of the wrench of its rope with respect to τ; moments over ℓ.
    pub(in crate::statics) fn column(&self) -> Vec6 {
        self.others.iter().fold(self.own_column(), |sum, other| sum + other.own_column() * self.rate_of(other))
    }

    fn own_column(&self) -> Vec6 {
        wrench_of(&(self.hanging.force_by_length_w() * self.length_rate), &(self.lever_w / self.coordinates.ell()))
    }

    /// Minimum tension anywhere in its rope.
    pub(in crate::statics) fn min_tension(&self) -> TensionByTau {
        self.others.iter().fold(self.own_min_tension(), |least, other| {
            let TensionByTau { value, slope } = other.own_min_tension();
            if value < least.value { TensionByTau { value, slope: slope * self.rate_of(other) } } else { least }
        })
    }

    fn own_min_tension(&self) -> TensionByTau {
        let [lower, _] = self.own_ends();
        let cos = self.span / self.hanging.chord_w().norm();
        if self.lowest_between_ends() {
            TensionByTau { value: self.hanging.catenary.horizontal_force(), slope: cos }
        } else {
            lower
        }
    }

    /// Maximum tension anywhere in its rope.
    pub(in crate::statics) fn max_tension(&self) -> TensionByTau {
        self.others.iter().fold(self.own_ends()[1], |most, other| {
            let TensionByTau { value, slope } = other.own_ends()[1];
            if value > most.value { TensionByTau { value, slope: slope * self.rate_of(other) } } else { most }
        })
    }

    /// Tensions at the lower and at the upper end.
    fn own_ends(&self) -> [TensionByTau; 2] {
        let catenary = &self.hanging.catenary;
        if self.rope().weight_per_length == 0.0 {
            return [TensionByTau { value: self.tau, slope: 1.0 }; 2];
        }
        let [h_by_length, v_by_length] = catenary.start_force_by_length();
        let tension = |vertical: f64, by_length: f64| {
            let horizontal = catenary.horizontal_force();
            let value = (horizontal * horizontal + vertical * vertical).sqrt();
            let slope = (horizontal * h_by_length + vertical * by_length) * self.length_rate / value;
            TensionByTau { value, slope }
        };
        let start = tension(catenary.vertical_force_at_start(), v_by_length);
        let end = tension(catenary.vertical_force_at_end(), v_by_length + self.rope().weight_per_length);
        if self.rise > 0.0 { [start, end] } else { [end, start] }
    }

    /// Wrench of a force on the platform at its attachment; moments over ℓ.
    pub(in crate::statics) fn wrench(&self, force_w: &Vec3) -> Vec6 {
        wrench_of(force_w, &(self.lever_w / self.coordinates.ell()))
    }

    /// Wrench, scaled, that the symmetric part of a stiffness contribution gives for a scaled motion of the platform.
    pub(in crate::statics) fn applied(&self, share: &StiffnessContribution, motion: &Vec6) -> Vec6 {
        let lever = self.lever_w / self.coordinates.ell();
        let turn: Vec3 = motion.fixed_rows::<3>(3).into();
        let moved = motion.fixed_rows::<3>(0) + turn.cross(&lever);
        let mut wrench = self.wrench(&(share.stiffness_w * moved));
        let force = share.force_w;
        let moment =
            (force.cross(&lever.cross(&turn)) + lever.cross(&force.cross(&turn))) * (0.5 / self.coordinates.ell());
        let mut view = wrench.fixed_rows_mut::<3>(3);
        view -= moment;
        wrench
    }

    /// First and second derivative of the cable's stiffness contribution with respect to τ, by central differences.
    pub(in crate::statics) fn rates(&self) -> Rates {
        // The error of the differences grows with the square of the step, the rounding of the second ones with its
        // inverse square: here they are about equal.
        let step = 1e-4 * self.tau.abs().max(1e-9 * self.rope().axial_stiffness);
        let [less, more] =
            [-step, step].map(|step| StiffnessContribution::of(&self.hanging.at_parallel_tension(self.tau + step)));
        let (here, once, twice) = (StiffnessContribution::of(&self.hanging), 0.5 / step, 1.0 / (step * step));
        Rates {
            first: StiffnessContribution {
                stiffness_w: (more.stiffness_w - less.stiffness_w) * once,
                force_w: (more.force_w - less.force_w) * once,
            },
            second: StiffnessContribution {
                stiffness_w: (more.stiffness_w - here.stiffness_w * 2.0 + less.stiffness_w) * twice,
                force_w: (more.force_w - here.force_w * 2.0 + less.force_w) * twice,
            },
        }
    }

    /// Derivative of the cable's contribution to the scaled stiffness of the platform with respect to τ.
    pub(in crate::statics) fn stiffness_by_tension(&self) -> Mat6 {
        let StiffnessContribution { stiffness_w, force_w } = self.rates().first;
        let mut total = Mat6::zeros();
        add_congruent(&mut total, &stiffness_w, &self.lever_w);
        add_lever_term(&mut total, &force_w, &self.lever_w);
        self.coordinates.scale_matrix(&total)
    }
}

/// Stiffness contribution of a cable to the platform: the stiffness of its end and the force at its lever arm, world
/// axes.
#[derive(Debug, Clone, Copy)]
pub(in crate::statics) struct StiffnessContribution {
    pub stiffness_w: Mat3,
    pub force_w: Vec3,
}

impl StiffnessContribution {
    fn of(hanging: &HangingCable) -> Self {
        Self { stiffness_w: hanging.tangent_w(), force_w: hanging.force_on_start_w() }
    }
}

/// Derivatives of a [`StiffnessContribution`] with respect to τ.
#[derive(Debug, Clone, Copy)]
pub(in crate::statics) struct Rates {
    pub first: StiffnessContribution,
    pub second: StiffnessContribution,
}
