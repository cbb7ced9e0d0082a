//! End of a cable at its exit point: the directions in which it can move, and its stiffness in them.

use super::arc::Beyond;
use crate::catenary::space::HangingCable;
use crate::math::dual::{Real, dot};
use crate::math::{Mat3, Vec3};
use crate::robot::{PulleyContact, Wheel};

/// Wrap angle [rad] below which the exit point is on the swivel axis and cannot move sideways. At 1e-8 its distance
/// from the axis is 1e-16 of the radius.
const MIN_WRAP: f64 = 1e-8;

/// Far end of the free span, at the exit point. It can move along the cable (σ, towards the platform) and sideways with
/// the swivelling wheel (v).
///
/// In the plane of the wheel, rolling has no effect of first order: the exit point is a pin that slides along the
/// cable. The forces of the end on a displacement (σ, v) are −S (σ, v).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnchorEnd {
    /// Direction of σ: along the cable towards the platform, unit vector, world axes; `None` if the end is held.
    pub along_w: Option<Vec3>,
    /// Direction of v: normal to the wheel, unit vector, world axes; `None` without a pulley.
    pub sideways_w: Option<Vec3>,
    /// Stiffness S for (σ, v) [N/m].
    pub stiffness: [[f64; 2]; 2],
    /// Force along the cable per unstrained length that is paid out, λ k_s [N/m].
    pub force_by_length: f64,
    /// Compliance Γ_r of arc and drum side: minus the derivative of their unstrained length by ψ [m/N].
    pub(crate) rope_compliance: f64,
    /// Stretch λ at the exit point, and λ_E between entry point and drum.
    pub(crate) stretch: f64,
    pub(crate) stretch_drum: f64,
    /// Stiffness along the cable by its weight, −q·t/λ [N/m]: σ lifts or lowers it.
    pub(crate) weight: f64,
    /// Direction of the cable at the exit point towards the platform, unit vector, world axes; direction of σ.
    pub(crate) travel_w: Vec3,
}

/// Drum side whose drum stays on the ground while its entry point moves.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DrumSideAtRest {
    /// Direction towards the platform, unit vector, world axes.
    pub(crate) direction_w: Vec3,
    /// Length [m].
    pub(crate) length: f64,
    /// Tension [N].
    pub(crate) tension: f64,
}

/// Static stiffness of a cable for a motion of its anchor, 3×3, world axes [N/m].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct OnSupport {
    /// Force on the platform per displacement of the anchor.
    pub(crate) force_w: Mat3,
    /// Resistance of the cable to a displacement of the anchor, symmetric.
    pub(crate) stiffness_w: Mat3,
}

impl OnSupport {
    /// Stiffness for a motion of the anchor with its whole drive, from the stiffness at the platform.
    pub(super) fn moving_together(total: Mat3) -> Self {
        Self { force_w: total, stiffness_w: total }
    }
}

/// Stiffness of an end, in numbers or in numbers with derivatives.
#[derive(Debug, Clone, Copy)]
pub(super) struct EndNumbers<T> {
    /// Stiffness along the cable by its weight, −q·t/λ [N/m].
    pub(super) weight: T,
    /// Stiffness k_s along the cable of all that lies behind the exit point [N/m]; `None` for a rigid drum there.
    pub(super) spring: Option<T>,
    /// Motion sideways; `None` if the end has none.
    pub(super) sideways: Option<SidewaysNumbers<T>>,
}

/// Stiffness of an end sideways.
#[derive(Debug, Clone, Copy)]
pub(super) struct SidewaysNumbers<T> {
    /// Stiffness between the motions along the cable and sideways [N/m].
    pub(super) coupling: T,
    /// Stiffness sideways [N/m].
    pub(super) stiffness: T,
    /// Distance of the exit point from the swivel axis [m].
    pub(super) distance: T,
}

impl<T: Real> EndNumbers<T> {
    /// Stiffness of an end whose cable travels along `travel_w`, with the load per unstrained length `load_w`.
    ///
    /// # References
    /// docs/theory.md, equations (68) and (69).
    pub(super) fn at(travel_w: &[T; 3], load_w: &[T; 3], wheel: Option<&Wheel<T>>, beyond: &Beyond<T>) -> Self {
        let stretch = beyond.stretch;
        let mut numbers = Self { weight: -dot(load_w, travel_w) / stretch, spring: None, sideways: None };
        if beyond.compliance.value() <= 0.0 {
            return numbers;
        }
        numbers.spring = Some(T::from(1.0) / (stretch * stretch * beyond.compliance));

        // A cable without tension does not hold the swivel.
        if let Some(wheel) = wheel.filter(|wheel| wheel.wrap.value() > MIN_WRAP && beyond.tension.value() > 0.0) {
            let distance = wheel.distance_from_axis();
            let swivel = beyond.tension / (wheel.radius * (wheel.wrap * 0.5).tan());
            let coupling = -dot(load_w, &wheel.sideways_w) / stretch - beyond.kink * swivel;
            let lifted = dot(load_w, &wheel.center_w) * beyond.moment / (distance * distance);
            numbers.sideways = Some(SidewaysNumbers { coupling, stiffness: swivel + lifted, distance });
        }
        numbers
    }
}

impl AnchorEnd {
    /// End of a span.
    ///
    /// # References
    /// docs/theory.md, equations (68) and (69).
    pub(super) fn of(span: &HangingCable, contact: Option<&PulleyContact>, beyond: &Beyond) -> Self {
        let travel_w = contact.map_or_else(|| towards_platform(span, beyond), PulleyContact::exit_direction_w);
        let wheel = contact.map(PulleyContact::wheel);
        let numbers = EndNumbers::at(&travel_w.into(), &span.load_w().into(), wheel.as_ref(), beyond);
        let mut end = Self {
            along_w: None,
            sideways_w: None,
            stiffness: [[0.0; 2]; 2],
            force_by_length: 0.0,
            rope_compliance: beyond.rope_compliance,
            stretch: beyond.stretch,
            stretch_drum: beyond.stretch_entry,
            weight: numbers.weight,
            travel_w,
        };

        // A rigid drum at the exit point holds the cable.
        let Some(spring) = numbers.spring else { return end };
        end.along_w = Some(travel_w);
        end.stiffness[0][0] = spring + end.weight;
        end.force_by_length = beyond.stretch * spring;
        if let Some(SidewaysNumbers { coupling, stiffness, .. }) = numbers.sideways {
            end.stiffness[0][1] = coupling;
            end.stiffness[1] = [coupling, stiffness];
            end.sideways_w = contact.map(|contact| contact.sideways_w);
        }

        end
    }

    /// Stiffness k_r of arc and drum side along the cable [N/m]; `None` without them.
    pub(crate) fn rope_spring(&self) -> Option<f64> {
        (self.rope_compliance > 0.0).then(|| 1.0 / (self.stretch * self.stretch * self.rope_compliance))
    }

    /// Stiffness of a span, whose end would be held, in series with this end; 3×3, world axes [N/m].
    ///
    /// # References
    /// docs/theory.md, equation (70).
    pub(crate) fn in_series_with(&self, held: &Mat3) -> Mat3 {
        let Some(along) = self.along_w.map(|direction| held * direction) else { return *held };
        let [[a, b], [_, c]] = self.inverse(held);
        let mut total = held - along * along.transpose() * a;
        if let Some(sideways) = self.sideways_w.map(|direction| held * direction) {
            let mixed = along * sideways.transpose();
            total -= (mixed + mixed.transpose()) * b + sideways * sideways.transpose() * c;
        }
        total
    }

    /// Motions (σ, v) of the end per displacement of the start of the span, world axes.
    pub(crate) fn motion_by_start(&self, held: &Mat3) -> [Vec3; 2] {
        let [[a, b], [_, c]] = self.inverse(held);
        let [along, sideways] =
            [self.along_w, self.sideways_w].map(|direction| direction.map_or_else(Vec3::zeros, |of| held * of));
        [along * a + sideways * b, along * b + sideways * c]
    }

    /// Motions (σ, v) of the end per motion of the entry point along a drum side from the ground, both ends of the span
    /// held.
    pub(crate) fn motion_by_drum_side(&self, held: &Mat3) -> [f64; 2] {
        let [[sigma, mixed], _] = self.inverse(held);
        let pull = self.force_by_length / self.stretch_drum;
        [-pull * sigma, -pull * mixed]
    }

    /// Derivative of the force on the platform with respect to the unstrained length [N/m]; `None` if the end is held:
    /// then it is the derivative of the span.
    pub(crate) fn force_by_length_w(&self, held: &Mat3) -> Option<Vec3> {
        let along = held * self.along_w?;
        let [[a, b], _] = self.inverse(held);
        let sideways = self.sideways_w.map_or_else(Vec3::zeros, |direction| held * direction);
        Some((along * a + sideways * b) * self.force_by_length)
    }

    /// Force on the platform by forces on the motions of the end [N].
    pub(crate) fn force_by_end_w(&self, held: &Mat3, on_end: [f64; 2]) -> Vec3 {
        let Some(along_w) = self.along_w else { return Vec3::zeros() };
        let [slip, swivel] = self.motion_by_forces(held, on_end);
        held * (along_w * slip + self.sideways_w.map_or_else(Vec3::zeros, |sideways_w| sideways_w * swivel))
    }

    /// Motions (σ, v) of the end by forces on them, both ends of the span held.
    fn motion_by_forces(&self, held: &Mat3, [on_slip, on_swivel]: [f64; 2]) -> [f64; 2] {
        let [[a, b], [_, c]] = self.inverse(held);
        [a * on_slip + b * on_swivel, b * on_slip + c * on_swivel]
    }

    /// Change of the tension of a drum side, as a force on its entry point along it, by a given motion [N]: the exit
    /// point moves with the anchor by `exit_w`, forces act on the motions of the end, and the entry point moves along a
    /// drum side from the ground by `stretched`. The platform is held; zero if the end is held.
    pub(crate) fn drum_side_tension(&self, held: &Mat3, exit_w: &Vec3, on_end: [f64; 2], stretched: f64) -> f64 {
        let Some(by_length_w) = self.force_by_length_w(held) else { return 0.0 };
        let [[sigma, _], _] = self.inverse(held);
        let pull = self.force_by_length / self.stretch_drum;
        let own = pull * self.stretch / self.stretch_drum - pull * pull * sigma;
        let [slip, _] = self.motion_by_forces(held, on_end);
        own * stretched - by_length_w.dot(exit_w) / self.stretch_drum + pull * slip
    }

    /// Stiffness of a cable between platform and anchor for a motion of the anchor whose drum stays on the ground.
    /// `held` is the stiffness of the span.
    ///
    /// # References
    /// docs/theory.md, equation (91).
    pub(super) fn with_drum_on_ground(&self, held: &Mat3, side: &DrumSideAtRest) -> OnSupport {
        let total = self.in_series_with(held);
        let Some(by_length_w) = self.force_by_length_w(held) else { return OnSupport::moving_together(total) };
        let by_drum_side_w = by_length_w / self.stretch_drum;

        // Change of the tension at the drum with the length of the drum side, the platform held.
        let pull = self.force_by_length / self.stretch_drum;
        let [[sigma, _], _] = self.inverse(held);
        let own = pull * self.stretch / self.stretch_drum - pull * pull * sigma;

        let DrumSideAtRest { direction_w, length, tension } = side;
        let mixed = by_drum_side_w * direction_w.transpose();
        let across = Mat3::identity() - direction_w * direction_w.transpose();
        OnSupport {
            force_w: total - mixed,
            stiffness_w: total - mixed - mixed.transpose()
                + direction_w * direction_w.transpose() * own
                + across * (tension / length),
        }
    }

    /// Inverse of `S + Wᵀ K W`, K being the stiffness of the span and W the directions.
    fn inverse(&self, held: &Mat3) -> [[f64; 2]; 2] {
        let Some(along) = self.along_w else { return [[0.0; 2]; 2] };
        let [[mut a, mut b], [_, mut c]] = self.stiffness;
        let pulled = held * along;
        a += along.dot(&pulled);
        let Some(sideways) = self.sideways_w else { return [[1.0 / a, 0.0], [0.0; 2]] };
        b += sideways.dot(&pulled);
        c += sideways.dot(&(held * sideways));
        let determinant = a * c - b * b;
        [[c / determinant, -b / determinant], [-b / determinant, a / determinant]]
    }
}

/// Direction of the cable at its end towards the platform.
fn towards_platform(span: &HangingCable, beyond: &Beyond) -> Vec3 {
    Vec3::from(beyond.force_w).try_normalize(0.0).unwrap_or_else(|| -span.chord_w().normalize())
}
