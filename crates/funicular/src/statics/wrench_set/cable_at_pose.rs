//! Cable between two given points as a function of one number, its tension parallel to the chord.

use crate::catenary::space::HangingCable;
use crate::catenary::{Catenary, Rope};
use crate::math::{Mat3, Mat6, Vec3, Vec6};
use crate::platform::{Coordinates, add_congruent, add_lever_term, wrench_of};
use crate::robot::{Pose, Robot};
use crate::statics::limits::{Limit, TensionRange};
use crate::statics::loaded_cable::LoadedCable;
use crate::statics::model::StaticModel;

/// Cable at the pose.
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
        }
    }

    /// Hangs the cable with another τ [N].
    pub(in crate::statics) fn set(&mut self, tau: f64) {
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

    /// Force on the platform and lever arm, world axes.
    pub(in crate::statics) fn force(&self) -> (Vec3, Vec3) {
        (self.hanging.force_on_start_w(), self.lever_w)
    }

    /// Derivative of the cable's wrench with respect to τ; moments over ℓ.
    pub(in crate::statics) fn column(&self) -> Vec6 {
        wrench_of(&(self.hanging.force_by_length_w() * self.length_rate), &(self.lever_w / self.coordinates.ell()))
    }

    /// Minimum tension anywhere in the cable.
    pub(in crate::statics) fn min_tension(&self) -> TensionByTau {
        let [lower, _] = self.ends();
        let cos = self.span / self.hanging.chord_w().norm();
        if self.lowest_between_ends() {
            TensionByTau { value: self.hanging.catenary.horizontal_force(), slope: cos }
        } else {
            lower
        }
    }

    /// Maximum tension anywhere in the cable.
    pub(in crate::statics) fn max_tension(&self) -> TensionByTau {
        self.ends()[1]
    }

    /// Tensions at the lower and at the upper end.
    fn ends(&self) -> [TensionByTau; 2] {
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
