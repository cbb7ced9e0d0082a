//! All natural modes below a frequency, none missed.
//!
//! Between two neighbouring clamped frequencies of the cables (the poles of D) the eigenvalues of D(ω) fall with ω. So
//! the count J gives the number of natural frequencies there, and bisection on J separates them. An increase of J at a
//! pole itself means vibrations of cables with the platform at rest, which a search between the poles cannot find.

mod certificate;
mod command;
pub mod damped;
mod decay;
mod fundamental;
mod lowest;
mod mac;
mod omitted;
mod release;
mod rigid_cables;
mod signals;
mod stretch;
pub mod tracking;

pub use command::{CommandedMotion, CommandedMotions, LengthCommand};
pub use decay::{Decay, DecayError, DecayingMotion};
pub use fundamental::{First, FirstError, first, lowest_by_count};
pub use lowest::{LowestError, PlatformModeError, Search, Wanted, doubled, lowest, lowest_with_platform, until};
pub use mac::mac;
pub use omitted::{OmittedModes, OmittedMotion};
pub use release::{Release, ReleasedMotion};
pub use rigid_cables::{RigidCablesError, with_rigid_cables};
pub use stretch::{StretchOfMode, caveat_of_stretch, stretch_of_platform};

pub use certificate::{MAX_MODES, TooMany, check_count, damped_partners};

use crate::dynamics::{Dynamics, NullVector};
use crate::math::{Vec6, order, roots};
use std::f64::consts::TAU;

/// Kind of a mode by kinetic energy: vibration of the platform, of the cables, of their drives, or of several.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The platform has at least three quarters of the energy.
    Platform,
    /// The cables have at least three quarters of the energy.
    Cable,
    /// The drives of the cables, with flexible supports, have at least three quarters of the energy: wheels, drums,
    /// motors and posts.
    Drive,
    /// Neither the platform nor the cables nor the drives have three quarters of the energy.
    Mixed,
}

impl Kind {
    /// Minimum fraction of the kinetic energy for which a mode belongs to the platform or to the cables.
    pub const SHARE: f64 = 0.75;

    pub(crate) fn of(platform_fraction: f64, drive_fraction: f64) -> Self {
        if platform_fraction >= Self::SHARE {
            Self::Platform
        } else if drive_fraction >= Self::SHARE {
            Self::Drive
        } else if platform_fraction + drive_fraction <= 1.0 - Self::SHARE {
            Self::Cable
        } else {
            Self::Mixed
        }
    }

    /// Name of the kind in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Platform => "platform",
            Self::Cable => "cable",
            Self::Drive => "drive",
            Self::Mixed => "mixed",
        }
    }
}

/// Default of the minimum fraction of the kinetic energy in the platform for a mode that counts as a mode of the
/// platform: most of the energy. [`Kind`] is stricter, because it leaves room for mixed modes.
pub const PLATFORM_SHARE: f64 = 0.5;

/// Minimum fraction of the kinetic energy in the platform for a mode that moves it considerably. A motion that is split
/// over three modes has at least this share in one of them.
pub const CONSIDERABLE_SHARE: f64 = 0.2;

/// Natural mode. A frequency of multiplicity m appears m times.
#[derive(Debug, Clone, PartialEq)]
pub struct Mode {
    /// Natural frequency, undamped [Hz].
    pub frequency_hz: f64,
    /// Number of modes at this frequency.
    pub multiplicity: usize,
    /// Damping ratio to first order in the damping of cables, drives and platform.
    pub damping_ratio: f64,
    /// Kind of the mode: vibration of the platform, of the cables, of their drives, or of several.
    pub kind: Kind,
    /// Fraction of the kinetic energy that the platform has.
    pub platform_energy_fraction: f64,
    /// Fraction of the kinetic energy that each cable has, in the order of the file, without its drive.
    pub cable_energy_fractions: Vec<f64>,
    /// Fraction of the kinetic energy that the drive of each cable has: wheel, swivel, drum and motor. Empty if no
    /// drive has inertia.
    pub drive_energy_fractions: Vec<f64>,
    /// Fraction of the kinetic energy that each flexible support has, in the order of the robot. Empty on a rigid
    /// frame.
    pub support_energy_fractions: Vec<f64>,
    /// Share of the stretch of each cable in the energy of deformation: its loss factor η adds half of η times this
    /// share to the damping ratio. What the shares of all cables leave is geometric stiffness: tensions, sag and lever
    /// arms. Empty unless the strains are known: for ropes with loss, and by [`Dynamics::with_strains`].
    pub stretching_shares: Vec<f64>,
    /// Motion of the platform (δp [m], δθ [rad]) about its origin, world axes; its largest scaled component is 1. Zero
    /// if the platform is at rest.
    pub shape: [f64; 6],
    /// Modal mass of `shape` [kg], platform and cables: `Σ ∫ |u|² dm`. If the platform is at rest, the motion of the
    /// cables is scaled to 1 kg.
    pub modal_mass: f64,
    /// Residual |xᵀ D x| over ω² times the moving mass, dimensionless: twice the relative change of the frequency by
    /// another Newton step on the Rayleigh quotient.
    pub residual: f64,
    /// Motion with unit modal mass.
    pub(crate) motion: NullVector,
}

/// All modes below a frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// Modes, ascending in frequency.
    pub modes: Vec<Mode>,
    /// Frequency limit of the list [Hz].
    pub below_hz: f64,
    /// Number of natural frequencies below the limit by the Wittrick–Williams count J.
    pub count_below: usize,
    /// Number of unstable directions of the equilibrium; they are counted, but have no frequency.
    pub unstable_directions: usize,
    /// True if list and count agree, every residual is at most 1e-8, and catenary-dynamic cables are resolved up to the
    /// limit.
    pub certified: bool,
}

impl Modes {
    /// Index of the lowest mode that has at least the fraction `share` of its kinetic energy in the platform.
    pub fn first_platform(&self, share: f64) -> Option<usize> {
        self.modes.iter().position(|mode| mode.platform_energy_fraction >= share)
    }

    /// Indices of the modes below the first one of the platform that move it considerably, with at least
    /// [`CONSIDERABLE_SHARE`] of their kinetic energy: a motion of the platform that is split over several modes
    /// beside a resonance of a cable. All such modes if none has the fraction `share`.
    pub fn share_platform(&self, share: f64) -> Vec<usize> {
        let end = self.first_platform(share).unwrap_or(self.modes.len());
        (0..end).filter(|&i| self.modes[i].platform_energy_fraction >= CONSIDERABLE_SHARE).collect()
    }
}

/// Relative half width of the neighbourhood of a pole that counts as the pole. Modes inside are listed at the pole, so
/// this width bounds their error. Rounding moves a pole by up to 1e-15.
const POLE_WIDTH: f64 = 1e-12;
/// Relative width of an interval in which several modes are one multiple mode.
const MULTIPLE_WIDTH: f64 = 2e-13;
/// Residual above which a zero of the determinant is replaced by a search with the count. True zeros have residuals up
/// to 1e-13; false zeros that rounding makes near a pole have 1e-2.
const ZERO_RESIDUAL: f64 = 1e-11;
/// Maximum residual of a certified mode.
pub const RESIDUAL_LIMIT: f64 = 1e-8;

/// All natural modes below `below_hz` [Hz], undamped, with multiplicity.
///
/// # Example
/// ```
/// # use funicular::dynamics::{Dynamics, Linearisation};
/// # use funicular::{cable::CableModel, modes, robot::Robot, statics::{self, StaticModel}};
/// # let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
/// # let lengths = [6.863, 6.565, 6.756, 6.663, 6.801, 6.604];
/// let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
/// let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 20.0)?;
/// let found = modes::below(&dynamics, 20.0);
/// assert!(found.certified && found.modes.len() == found.count_below);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, section 7.
pub fn below(dynamics: &Dynamics, below_hz: f64) -> Modes {
    let limit = below_hz * TAU;
    let count_below = dynamics.modes_below(limit);
    let poles = dynamics.clamped_frequencies_below(limit);
    let first = poles.first().map_or(limit, |p| p.0);
    // Start so low that no frequency lies below: at a billionth of the lowest pole or of the limit.
    let lowest = 1e-9 * first.min(limit);
    let unstable_directions = dynamics.modes_below(lowest);

    let (modes, consistent) = in_interval(dynamics, (lowest, unstable_directions), (limit, count_below), &poles);
    let certified = consistent
        && dynamics.resolves(limit)
        && modes.len() + unstable_directions == count_below
        && modes.iter().all(|m| m.residual <= RESIDUAL_LIMIT);
    Modes { modes, below_hz, count_below, unstable_directions, certified }
}

/// Natural modes in a range of frequencies [Hz], undamped, with multiplicity, ascending: a part of the list of
/// [`below`] without its certificate, in time that does not depend on the number of modes below the range.
pub fn within(dynamics: &Dynamics, from_hz: f64, to_hz: f64) -> Vec<Mode> {
    let limit = to_hz * TAU;
    let poles = dynamics.clamped_frequencies_below(limit);
    let lowest = 1e-9 * poles.first().map_or(limit, |p| p.0).min(limit);
    let from = (from_hz * TAU).max(lowest);
    let above: Vec<(f64, usize)> = poles.into_iter().filter(|p| p.0 > from * (1.0 + 2.0 * POLE_WIDTH)).collect();
    let counts = [from, limit].map(|omega| dynamics.modes_below(omega));
    in_interval(dynamics, (from, counts[0]), (limit, counts[1]), &above).0
}

/// Number of natural modes in a range of frequencies [Hz], by the Wittrick–Williams count.
pub fn count_within(dynamics: &Dynamics, from_hz: f64, to_hz: f64) -> usize {
    dynamics.modes_below(to_hz * TAU).saturating_sub(dynamics.modes_below(from_hz * TAU))
}

/// Modes between two angular frequencies with known counts, ascending; `poles` are all clamped frequencies between
/// them. The flag is true if the count has not decreased anywhere.
fn in_interval(
    dynamics: &Dynamics,
    (mut from, mut count): (f64, usize),
    (limit, count_limit): (f64, usize),
    poles: &[(f64, usize)],
) -> (Vec<Mode>, bool) {
    let mut list = List { dynamics, modes: Vec::with_capacity(count_limit.saturating_sub(count)), consistent: true };
    let mut next = 0;
    while next < poles.len() {
        // Poles that coincide form one cluster.
        let mut last = next;
        while last + 1 < poles.len() && poles[last + 1].0 <= poles[last].0 * (1.0 + 4.0 * POLE_WIDTH) {
            last += 1;
        }
        let cluster = &poles[next..=last];
        let (left, right) = (cluster[0].0 * (1.0 - POLE_WIDTH), cluster[cluster.len() - 1].0 * (1.0 + POLE_WIDTH));
        let right = right.min(limit);

        // Modes between the cluster before and this one, then modes at this one.
        let (at_left, at_right) = (dynamics.modes_below(left), dynamics.modes_below(right));
        list.between(from, count, left, at_left);
        list.at_pole(cluster, at_left, at_right);
        (from, count) = (right, at_right);
        next = last + 1;
    }
    list.between(from, count, limit, count_limit);

    let List { mut modes, consistent, .. } = list;
    order::sort_ascending(&mut modes, |mode| mode.frequency_hz);
    (modes, consistent)
}

/// List of modes under construction.
struct List<'a> {
    dynamics: &'a Dynamics,
    modes: Vec<Mode>,
    /// True as long as the count has not decreased with the frequency.
    consistent: bool,
}

impl List<'_> {
    /// Adds the modes in an interval without poles, whose counts at both ends are known.
    fn between(&mut self, low: f64, count_low: usize, high: f64, count_high: usize) {
        if count_high < count_low {
            self.consistent = false;
            return;
        }
        match count_high - count_low {
            0 => {}
            1 => self.single(low, high),
            several if high - low <= MULTIPLE_WIDTH * high => self.multiple(0.5 * (low + high), several),
            _ => {
                // The geometric mean in wide intervals, because all frequencies need the same relative accuracy.
                let middle = if low > 0.0 && high > 4.0 * low { (low * high).sqrt() } else { 0.5 * (low + high) };
                let count = self.dynamics.modes_below(middle);
                self.between(low, count_low, middle, count.clamp(count_low, count_high));
                self.between(middle, count.clamp(count_low, count_high), high, count_high);
            }
        }
    }

    /// Adds a single mode: the zero of det D, which changes its sign once between neighbouring poles.
    fn single(&mut self, low: f64, high: f64) {
        let determinant = |omega: f64| self.dynamics.determinant(omega);
        let (at_low, at_high) = (determinant(low), determinant(high));
        let mut omega = 0.5 * (low + high);
        let mut motions = Vec::new();
        if at_low * at_high.signum() < 0.0 {
            omega = roots::brent(low, at_low, high, at_high, determinant);
            motions = self.dynamics.null_vectors(omega, 1);
        }
        // Near a pole rounding hides the sign or makes false zeros; the count is not affected.
        if motions.iter().all(|motion| motion.residual > ZERO_RESIDUAL) {
            omega = self.by_count(low, high);
            motions = self.dynamics.null_vectors(omega, 1);
        }
        self.add_all(omega, motions);
    }

    /// Frequency at which the count grows, by bisection.
    fn by_count(&self, mut low: f64, mut high: f64) -> f64 {
        let count_low = self.dynamics.modes_below(low);
        while high - low > 4.0 * f64::EPSILON * high {
            let middle = 0.5 * (low + high);
            if self.dynamics.modes_below(middle) > count_low {
                high = middle;
            } else {
                low = middle;
            }
        }
        0.5 * (low + high)
    }

    /// Adds `several` modes at ω.
    fn multiple(&mut self, omega: f64, several: usize) {
        self.add_all(omega, self.dynamics.null_vectors(omega, several));
    }

    /// Adds modes that share ω.
    fn add_all(&mut self, omega: f64, motions: Vec<NullVector>) {
        let several = motions.len();
        for motion in motions {
            let motion_w = self.dynamics.coordinates().expand(&motion.platform);
            let largest = motion_w[motion_w.iamax()];
            let ell = self.dynamics.coordinates().ell();
            let shape = std::array::from_fn(|i| motion_w[i] / largest / if i < 3 { 1.0 } else { ell });
            self.add(omega, several, motion, shape, (1.0 / largest).powi(2));
        }
    }

    /// Adds one mode from its `motion` with unit modal mass. `shape` is the platform's motion with `modal_mass`.
    fn add(&mut self, omega: f64, several: usize, motion: NullVector, shape: [f64; 6], modal_mass: f64) {
        let NullVector {
            platform_energy, ref cable_energies, ref drive_energies, ref support_energies, residual, ..
        } = motion;
        let beside: f64 = drive_energies.iter().chain(support_energies).sum();
        let by_cables: f64 = (cable_energies.iter().enumerate())
            .map(|(i, fraction)| fraction * self.dynamics.cable_damping_ratio(i, omega))
            .sum();
        let by_platform = self.dynamics.platform_damping_along(&motion.platform) / (2.0 * omega);

        self.modes.push(Mode {
            frequency_hz: omega / TAU,
            multiplicity: several,
            damping_ratio: by_cables + by_platform + motion.drive_damping,
            kind: Kind::of(platform_energy, beside),
            platform_energy_fraction: platform_energy,
            cable_energy_fractions: cable_energies.clone(),
            drive_energy_fractions: drive_energies.clone(),
            support_energy_fractions: support_energies.clone(),
            stretching_shares: motion.stretching.clone(),
            shape,
            modal_mass,
            residual,
            motion,
        });
    }

    /// Adds the modes with the platform at rest: the increase of the count at a cluster of coinciding poles.
    fn at_pole(&mut self, cluster: &[(f64, usize)], count_left: usize, count_right: usize) {
        if count_right < count_left {
            self.consistent = false;
            return;
        }
        let several = count_right - count_left;
        if several == 0 {
            return;
        }

        let omega = cluster.iter().map(|p| p.0).sum::<f64>() / cluster.len() as f64;
        let mut motions = self.dynamics.null_vectors(omega, several);
        if motions.iter().all(|motion| motion.near.is_empty()) {
            // The shallow-dynamic model has no amplitudes for its poles: the cables of the cluster share the energy.
            let mut cable_energies = vec![0.0; self.dynamics.cable_count()];
            for (_, cable) in cluster {
                cable_energies[*cable] += 1.0 / cluster.len() as f64;
            }
            let still = NullVector {
                platform: Vec6::zeros(),
                near: Vec::new(),
                supports: Vec::new(),
                support_energies: Vec::new(),
                platform_energy: 0.0,
                cable_energies,
                drive_energies: Vec::new(),
                stretching: Vec::new(),
                drive_damping: 0.0,
                residual: 0.0,
            };
            motions = vec![still; several];
        }

        for motion in motions {
            let supports = vec![0.0; motion.supports.len()];
            self.add(omega, several, NullVector { platform: Vec6::zeros(), supports, ..motion }, [0.0; 6], 1.0);
        }
    }
}
