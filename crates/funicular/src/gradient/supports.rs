//! Flexible supports in gradients of an equilibrium.
//!
//! The robot at rest is one with rigid supports where its own have been displaced by e. The balance of every support,
//! `Ψ = Σ (L' q − f − T_E â) − K_t e = 0`, stands beside that of the platform. So a scalar gets a second multiplier μ
//! per support, and the displacements are further unknowns (docs/theory.md, equations (60n) to (60p)).

use super::GradientError;
use super::adjoint::Adjoint;
use super::parallel_tension::ParallelTension;
use super::scalar::{add_real, add_times, symmetric_outer};
use crate::drive::derivatives::end;
use crate::math::{DMat, DVec, Mat3, Vec3};
use crate::robot::{Robot, RobotChange, SupportChange};
use crate::statics::Equilibrium;
use crate::statics::derivatives::{StaticDerivativeError, check_regular, load_of};

/// Supports of a robot at rest.
pub(super) struct SupportsAtRest {
    /// Robot with rigid supports at their displaced places.
    pub(super) settled: Robot,
    /// Stiffness and displacement of each support.
    supports: Vec<(Mat3, Vec3)>,
    /// Cables on supports, in file order; `None` for a rigid anchor.
    cables: Vec<Option<CarriedCable>>,
}

/// Cable on a support, at rest.
struct CarriedCable {
    /// Index of its support.
    support: usize,
    /// Load per unstrained length, and the length whose weight the support carries.
    load_w: Vec3,
    carried_length: f64,
    /// Direction of travel at the entry point of its pulley; zero without one.
    entry_direction_w: Vec3,
    /// Drum side, if the drum is on the ground.
    side: Option<GroundSide>,
}

/// Drum side from a drum on the ground to a displaced support.
struct GroundSide {
    /// Length that the file gives.
    given_length: f64,
    /// Direction and length at rest, and the tension.
    direction_w: Vec3,
    length: f64,
    tension: f64,
}

impl SupportsAtRest {
    /// Supports of a robot at this equilibrium; `None` if its anchors are rigid.
    pub(super) fn of(robot: &Robot, equilibrium: &Equilibrium) -> Option<Self> {
        if !robot.has_supports() {
            return None;
        }
        let displacements_w = equilibrium.support_displacements(robot);
        let supports = robot.supports.iter().map(|support| support.stiffness_w).zip(displacements_w).collect();

        let cables = robot.cables.iter().zip(&equilibrium.cables).map(|(cable, state)| {
            let (anchor, support) = (&cable.anchor, cable.anchor.support?);
            let side = robot.supports[support].drum_side_from_ground(anchor).map(|given_direction_w| {
                let given_length = anchor.drum_side_length();
                let side_w = given_direction_w * given_length + state.displacement_w;
                let length = side_w.norm();
                let tension = state.drive.as_ref().map_or(0.0, |drive| drive.tension_drum);
                GroundSide { given_length, direction_w: side_w / length, length, tension }
            });
            let carried_length = state.unstrained_length - side.as_ref().map_or(0.0, |side| side.given_length);
            let entry_direction_w = anchor.pulley.as_ref().map_or_else(Vec3::zeros, |pulley| pulley.entry_direction_w);
            Some(CarriedCable { support, load_w: load_of(state), carried_length, entry_direction_w, side })
        });
        let cables = cables.collect();
        Some(Self { settled: equilibrium.settled(robot).into_owned(), supports, cables })
    }

    /// Number of coordinates: three per support.
    fn count(&self) -> usize {
        3 * self.supports.len()
    }

    /// Adds the coefficients of μ·Ψ, the product of multipliers, three per support, with the forces on the supports.
    fn add_balance(&self, total: &mut Adjoint<f64>, multipliers: &DVec) {
        let of_support = |k: usize| Vec3::new(multipliers[3 * k], multipliers[3 * k + 1], multipliers[3 * k + 2]);

        for (cable, carried) in total.cables.iter_mut().zip(&self.cables) {
            let Some(carried) = carried else { continue };
            let mu = of_support(carried.support);
            add_real(&mut cable.force, -mu);
            add_real(&mut cable.load, mu * carried.carried_length);
            let by_length = carried.load_w.dot(&mu);
            cable.length += by_length;
            if let Some(side) = &carried.side {
                cable.side.given_length -= by_length;
                cable.end[end::TENSION_DRUM] -= side.direction_w.dot(&mu);
                add_real(&mut cable.side.vector, side.across(&mu) * (-side.tension / side.length));
            }
        }

        for (k, (stiffness_w, displacement_w)) in self.supports.iter().enumerate() {
            let (mu, support) = (of_support(k), total.support(k));
            add_real(&mut support.displacement, -(stiffness_w * mu));
            for (sum, row) in support.stiffness.iter_mut().zip(symmetric_outer(&mu.into(), &(*displacement_w).into())) {
                add_times(sum, &row, -1.0);
            }
        }
    }

    /// Follows the coefficients of displaced anchors and drum sides, which `gradient` has so far, to the numbers of the
    /// robot. The result are the coefficients of the displacements.
    pub(super) fn pulled(&self, scalar: &Adjoint<f64>, gradient: &mut RobotChange) -> Vec<f64> {
        let mut motions = vec![0.0; self.count()];
        let mut add = |support: usize, value: Vec3| (0..3).for_each(|k| motions[3 * support + k] += value[k]);
        for ((carried, of_cable), change) in self.cables.iter().zip(&scalar.cables).zip(&mut gradient.cables) {
            let Some(carried) = carried else { continue };
            add(carried.support, change.anchor_w);
            let (a, by_direction) = (&carried.entry_direction_w, Vec3::from(of_cable.side.entry_direction));
            change.pulley.entry_direction_w += by_direction - a * a.dot(&by_direction);
            let Some(side) = &carried.side else { continue };

            // The vector along the drum side is ℓ_d a + e.
            let side_w = Vec3::from(of_cable.side.vector) + side.direction_w * change.winch.drum_side_length;
            add(carried.support, side_w);
            change.winch.drum_side_length = a.dot(&side_w) + of_cable.side.given_length;
            change.pulley.entry_direction_w += (side_w - a * a.dot(&side_w)) * side.given_length;
        }

        gradient.supports.resize(self.supports.len(), SupportChange::default());
        for (k, (of_support, change)) in scalar.supports.iter().zip(&mut gradient.supports).enumerate() {
            add(k, of_support.displacement.into());
            change.stiffness_w = Mat3::from_fn(|i, j| of_support.stiffness[i][j]);
            change.mass = of_support.mass;
            change.damping_ratio = of_support.damping_ratio;
        }
        motions
    }
}

impl GroundSide {
    /// Part of a vector normal to the drum side.
    fn across(&self, vector: &Vec3) -> Vec3 {
        vector - self.direction_w * self.direction_w.dot(vector)
    }
}

/// Coefficients of the quantities that adapt to a change of the robot.
pub(super) struct Followed {
    /// Coefficients of the motion of the platform, reduced, or of the unstrained lengths.
    pub(super) first: DVec,
    /// Coefficients of the displacements of the supports, three per support.
    pub(super) supports: DVec,
}

/// Quantities that adapt to a change of a robot on supports: displacements of the supports, with the pose or the
/// lengths.
pub(super) struct SupportedFollower {
    /// Coefficients of the displacements per multiplier of the platform's balance.
    by_platform: DMat,
    /// Inverse of the coefficients of the displacements per multiplier of the supports' balance.
    inverse_own: DMat,
    /// Coefficients of pose or lengths per multiplier of the supports' balance.
    first_by_supports: DMat,
    /// Coefficients of pose or lengths per multiplier of the platform's balance while the displacements adapt.
    first_by_platform: DMat,
    /// Inverse or pseudoinverse of these.
    pseudoinverse: DMat,
    /// Parallel tension of each cable, and the coefficients of the displacements per tension; if the change of the
    /// parallel tensions is minimum.
    tensions: Option<(Vec<ParallelTension>, DMat)>,
}

/// Multipliers with which the coefficients of the quantities that adapt become zero.
pub(super) struct Multipliers {
    /// Multipliers of the platform's balance, reduced.
    pub(super) platform: DVec,
    /// Multipliers of the supports' balance, three per support.
    pub(super) supports: DVec,
    /// Multipliers of the parallel tensions, one per cable.
    pub(super) tensions: Option<DVec>,
}

impl SupportedFollower {
    /// Follower from the coefficients for every unit multiplier: of the platform's balance, of the supports' balance
    /// and, if their change is minimum, of the parallel tensions.
    pub(super) fn new(
        platform: &[Followed],
        supports: &[Followed],
        tensions: Option<(Vec<ParallelTension>, Vec<Followed>)>,
    ) -> Result<Self, GradientError> {
        let first = |of: &[Followed]| DMat::from_columns(&of.iter().map(|of| of.first.clone()).collect::<Vec<_>>());
        let displaced =
            |of: &[Followed]| DMat::from_columns(&of.iter().map(|of| of.supports.clone()).collect::<Vec<_>>());
        let [mut platform_first, mut supports_first] = [platform, supports].map(first);
        let [mut by_platform, mut own] = [platform, supports].map(displaced);

        // Parallel tensions stand for the lengths.
        let tensions = tensions.map(|(tensions, followed)| {
            let by_displacements = displaced(&followed);
            for (i, tension) in tensions.iter().enumerate() {
                platform_first.row_mut(i).unscale_mut(tension.by_length);
                supports_first.row_mut(i).unscale_mut(tension.by_length);
            }
            by_platform -= &by_displacements * &platform_first;
            own -= &by_displacements * &supports_first;
            (tensions, by_displacements)
        });

        // The supports follow.
        let inverse_own = own.try_inverse().ok_or(StaticDerivativeError::Singular)?;
        let first_by_platform = platform_first - &supports_first * (&inverse_own * &by_platform);

        // Pseudoinverse from the orthogonal factors; it is the inverse of a square matrix.
        let values = first_by_platform.singular_values();
        check_regular(values.min(), values.max())?;
        let factors = first_by_platform.clone().qr();
        let solved = factors.r().solve_upper_triangular(&factors.q().transpose());
        let pseudoinverse = solved.ok_or(StaticDerivativeError::Singular)?;
        Ok(Self {
            by_platform,
            inverse_own,
            first_by_supports: supports_first,
            first_by_platform,
            pseudoinverse,
            tensions,
        })
    }

    /// Multipliers for a scalar with these coefficients of the quantities that adapt.
    pub(super) fn multipliers(&self, Followed { mut first, mut supports }: Followed) -> Multipliers {
        if let Some((tensions, by_displacements)) = &self.tensions {
            first.iter_mut().zip(tensions).for_each(|(of, tension)| *of /= tension.by_length);
            supports -= by_displacements * &first;
        }
        let first = first - &self.first_by_supports * (&self.inverse_own * &supports);
        let platform = -(&self.pseudoinverse * &first);
        let tensions = self.tensions.as_ref().map(|_| -(first + &self.first_by_platform * &platform));
        let supports = -(&self.inverse_own * (supports + &self.by_platform * &platform));
        Multipliers { platform, supports, tensions }
    }

    /// Adds the coefficients of the supports' balance and of the parallel tensions.
    pub(super) fn add(&self, total: &mut Adjoint<f64>, at_rest: &SupportsAtRest, multipliers: &Multipliers) {
        at_rest.add_balance(total, &multipliers.supports);
        if let (Some((tensions, _)), Some(factors)) = (&self.tensions, &multipliers.tensions) {
            for ((cable, tension), factor) in total.cables.iter_mut().zip(tensions).zip(factors.iter()) {
                tension.add(cable, *factor);
            }
        }
    }
}

impl SupportsAtRest {
    /// Coefficients of the balance of the supports for each unit multiplier, of a robot with this number of cables.
    pub(super) fn units(&self) -> impl Iterator<Item = Adjoint<f64>> {
        let count = self.count();
        (0..count).map(move |k| {
            let mut unit = DVec::zeros(count);
            unit[k] = 1.0;
            let mut scalar = Adjoint::zeros(self.cables.len());
            self.add_balance(&mut scalar, &unit);
            scalar
        })
    }
}
