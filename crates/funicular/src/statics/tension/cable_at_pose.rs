//! A cable between two given points as a function of one number, its tension parallel to the chord.

use crate::catenary::space::HangingCable;
use crate::catenary::{Catenary, Rope};
use crate::math::{Mat3, Mat6, Vec3, Vec6};
use crate::platform::{Coordinates, add_congruent, add_lever_term, wrench_of};
use crate::robot::{Pose, Robot};
use crate::statics::limits::TensionRange;
use crate::statics::loaded_cable::LoadedCable;
use crate::statics::model::StaticModel;

/// A cable at the pose.
///
/// At a given geometry the tension τ parallel to the chord, (10a), says everything: the horizontal force is τ cos α
/// exactly, the vertical one nearly linear in τ, and above [`Catenary::SLACKEST`] every tension in the cable grows
/// with τ, so that limits at the ends are limits of τ.
#[derive(Debug, Clone)]
pub(super) struct CableAtPose {
    pub hanging: HangingCable,
    lever_w: Vec3,
    coordinates: Coordinates,
    span: f64,
    rise: f64,
    /// Limits of its tension.
    pub range: TensionRange,
    /// Least τ that is considered at all [N].
    pub slackest: f64,
    tau: f64,
    /// dL0/dτ.
    length_rate: f64,
}

/// A tension somewhere in the cable and its derivative by τ.
#[derive(Debug, Clone, Copy)]
pub(super) struct TensionByTau {
    pub value: f64,
    pub slope: f64,
}

impl CableAtPose {
    /// Cable `i`, taut enough for its slope to be that of a taut cable; its ends must not coincide.
    pub(super) fn new(robot: &Robot, i: usize, pose: &Pose, model: StaticModel, coordinates: Coordinates) -> Self {
        let cable = LoadedCable::at(robot, i, pose, model);
        let attachment_w = pose.point_w(&cable.cable.attachment_p);
        let chord_w = cable.chord_w(pose);
        let range = TensionRange::of(robot, i, &chord_w);
        let slackest = Catenary::SLACKEST * cable.load.size * chord_w.norm();
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

    /// Hangs it with another τ [N].
    pub(super) fn set(&mut self, tau: f64) {
        let rope = self.hanging.catenary.rope();
        self.hanging.catenary = Catenary::with_parallel_tension(self.span, self.rise, rope, tau);
        self.length_rate = 1.0 / self.hanging.catenary.parallel_tension_by_length();
        self.tau = tau;
    }

    /// The τ at which the least tension is the minimum, or the slackest where that is above.
    pub(super) fn at_minimum(&mut self) -> f64 {
        let mut tau = self.range.minimum.max(self.slackest);
        // The least tension is nearly linear in τ; 2 or 3 passes. The rest is a guard.
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

    /// Hangs it with the τ at which the greatest tension is the maximum; without a maximum, with its axial stiffness,
    /// which stretches it to twice its length.
    pub(super) fn at_maximum(&mut self) {
        if self.range.maximum.is_infinite() {
            self.set(self.rope().axial_stiffness);
            return;
        }
        let mut tau = self.range.maximum.max(self.slackest);
        // As for the least tension.
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

    fn rope(&self) -> Rope {
        self.hanging.catenary.rope()
    }

    /// τ [N].
    pub(super) fn tau(&self) -> f64 {
        self.tau
    }

    /// The unstrained length [m] and its derivative by τ [m/N].
    pub(super) fn length(&self) -> [f64; 2] {
        [self.rope().unstrained_length, self.length_rate]
    }

    /// Load per unstrained length [N/m].
    pub(super) fn weight_per_length(&self) -> f64 {
        self.rope().weight_per_length
    }

    /// Sine of the chord's slope, positive if the anchor is above the platform.
    pub(super) fn sin(&self) -> f64 {
        self.rise / self.hanging.chord_w().norm()
    }

    /// Force on the platform and lever arm, world axes.
    pub(super) fn force(&self) -> (Vec3, Vec3) {
        (self.hanging.force_on_start_w(), self.lever_w)
    }

    /// Derivative of its wrench by τ; moments over ℓ.
    pub(super) fn column(&self) -> Vec6 {
        wrench_of(&(self.hanging.force_by_length_w() * self.length_rate), &(self.lever_w / self.coordinates.ell()))
    }

    /// The least tension anywhere in the cable.
    pub(super) fn min_tension(&self) -> TensionByTau {
        let [lower, _] = self.ends();
        let cos = self.span / self.hanging.chord_w().norm();
        let catenary = &self.hanging.catenary;
        if catenary.vertical_force_at_start() < 0.0 && catenary.vertical_force_at_end() > 0.0 {
            TensionByTau { value: catenary.horizontal_force(), slope: cos }
        } else {
            lower
        }
    }

    /// The greatest tension anywhere in the cable.
    pub(super) fn max_tension(&self) -> TensionByTau {
        self.ends()[1]
    }

    /// The tensions at the lower and at the upper end.
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
    pub(super) fn wrench(&self, force_w: &Vec3) -> Vec6 {
        wrench_of(force_w, &(self.lever_w / self.coordinates.ell()))
    }

    /// What a share of the stiffness makes of a scaled motion of the platform: the wrench, scaled, of its symmetric part.
    pub(super) fn applied(&self, share: &Share, motion: &Vec6) -> Vec6 {
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

    /// First and second derivative of its share by τ, by central differences.
    pub(super) fn rates(&self) -> Rates {
        // The error of the differences is its square, the rounding of the second ones over its square: they are alike.
        let step = 1e-4 * self.tau.abs().max(1e-9 * self.rope().axial_stiffness);
        let [less, more] = [-step, step].map(|step| Share::of(&self.hanging.at_parallel_tension(self.tau + step)));
        let (here, once, twice) = (Share::of(&self.hanging), 0.5 / step, 1.0 / (step * step));
        Rates {
            first: Share {
                stiffness_w: (more.stiffness_w - less.stiffness_w) * once,
                force_w: (more.force_w - less.force_w) * once,
            },
            second: Share {
                stiffness_w: (more.stiffness_w - here.stiffness_w * 2.0 + less.stiffness_w) * twice,
                force_w: (more.force_w - here.force_w * 2.0 + less.force_w) * twice,
            },
        }
    }

    /// Derivative of its share of the scaled stiffness of the platform by τ.
    pub(super) fn stiffness_by_tension(&self) -> Mat6 {
        let Share { stiffness_w, force_w } = self.rates().first;
        let mut total = Mat6::zeros();
        add_congruent(&mut total, &stiffness_w, &self.lever_w);
        add_lever_term(&mut total, &force_w, &self.lever_w);
        self.coordinates.scale_matrix(&total)
    }
}

/// What a cable adds to the platform's stiffness: the stiffness of its end and the force at its lever arm, world axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Share {
    pub stiffness_w: Mat3,
    pub force_w: Vec3,
}

impl Share {
    fn of(hanging: &HangingCable) -> Self {
        Self { stiffness_w: hanging.tangent_w(), force_w: hanging.force_on_start_w() }
    }
}

/// Derivatives of a [`Share`] by τ.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rates {
    pub first: Share,
    pub second: Share,
}
