//! Damped natural frequencies: one for each undamped mode, none lost.
//!
//! With damping D(ω) is complex and its zeros ω leave the real axis. The motion is e^{iωt}, so `λ = iω`, and decay is
//! Im ω > 0. All zeros are sought at once. Each search starts at an undamped frequency with its damping of first order.
//! Each Newton step on det D divides out all the other zeros (Aberth), so that no two searches end at the same zero.
//!
//! Afterwards the zeros inside a contour are counted, by the phase of det D with damping over det D without. Its total
//! change along the contour is the difference between the numbers of damped and undamped zeros in the region, in full
//! turns; the number of the undamped ones is known from the Wittrick–Williams count. With weak damping both numbers are
//! equal. Strong damping, as of a servo, may move a zero out of the region or into it.

mod pairing;

use super::{Mode, Modes};
use crate::dynamics::Dynamics;
use crate::math::{Complex, order};
use pairing::{FollowedMode, Pairs};
use std::f64::consts::TAU;

/// Damped natural frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DampedMode {
    /// Complex angular frequency ω [rad/s], motion e^{iωt}; λ = iω.
    pub omega: Complex,
    /// Relative size of the last step of its search, an estimate of its error.
    pub error: f64,
}

impl DampedMode {
    /// Natural frequency |ω|/2π [Hz] of an oscillator with this eigenvalue.
    pub fn frequency_hz(&self) -> f64 {
        self.omega.norm() / TAU
    }

    /// Frequency of the decaying vibration, Re ω/2π [Hz]: `√(1 − ζ²)` times the natural frequency.
    pub fn ringing_hz(&self) -> f64 {
        self.omega.re / TAU
    }

    /// Damping ratio ζ = Im ω/|ω|.
    pub fn damping_ratio(&self) -> f64 {
        self.omega.im / self.omega.norm()
    }

    /// Time in which its amplitude falls to the fraction `remaining` [s]; infinite for a mode that does not decay.
    pub fn decay_time(&self, remaining: f64) -> f64 {
        decay_time(self.omega.im, remaining)
    }

    /// Eigenvalue λ = iω = −ζ|ω| + i|ω|√(1 − ζ²) [1/s].
    pub fn eigenvalue(&self) -> Complex {
        Complex::new(-self.omega.im, self.omega.re)
    }
}

/// Default of the percentage of the amplitude to which a mode decays in the time that is listed: what remains is small
/// against the motion, and the time is the settling time of control engineering.
pub const DECAY_PERCENT: f64 = 5.0;

/// Time in which an amplitude falls to the fraction `remaining` at a rate of decay, ζω [1/s]; infinite without decay.
pub fn decay_time(rate: f64, remaining: f64) -> f64 {
    if rate > 0.0 { -remaining.ln() / rate } else { f64::INFINITY }
}

/// Damped partners of undamped modes.
#[derive(Debug, Clone, PartialEq)]
pub struct DampedModes {
    /// Damped mode per undamped mode, in the same order.
    pub modes: Vec<DampedMode>,
    /// Number of modes so strongly damped that they do not vibrate. Their ω is one of their two decay rates, and no
    /// count confirms them.
    pub overdamped: usize,
    /// Damped modes below the limit whose undamped partners lie above it, which strong damping can make.
    pub others: Vec<DampedMode>,
    /// Undamped modes for which it is not clear which damped mode is theirs, by their indices: while the damping grows,
    /// they come so near to another one that both change their motions.
    pub unclear: Vec<usize>,
    /// True if the undamped list is certified, every search has converged, and the region holds as many zeros as are
    /// listed.
    pub certified: bool,
}

/// Part of the kinetic energy of a mode up to which platform or cable are at rest in it: the square of the rounding of
/// their amplitudes. Null vectors of symmetric robots had 1e-27.
pub(super) const AT_REST: f64 = 1e-20;
/// Relative distance up to which the zeros of cables in symmetric places are one, but for rounding.
const SAME_ZERO: f64 = 1e-13;
/// Maximum error of a certified zero.
const WANTED_ERROR: f64 = 1e-9;
/// Maximum relative spread, from the second moment, of zeros that count as one multiple zero.
const ONE_ZERO: f64 = 1e-8;
/// Maximum damping ratio added in one step: strong damping is added in steps, and each zero starts from its last place.
const STEP_OF_DAMPING: f64 = 0.1;
/// Relative step below which a zero is near enough to be followed in the next step of damping: Newton's method leaves
/// the square of it.
const FOLLOWED: f64 = 1e-5;
/// Maximum number of these steps.
const MAX_STEPS: f64 = 20.0;
/// Maximum number of times that lost zeros are sought again, and of those among them that start near a mode. The others
/// start anywhere in the region: strong damping, as of a servo, moves zeros far from their undamped frequencies.
const MAX_ROUNDS: usize = 60;
const ROUNDS_AT_MODES: usize = 5;
/// Maximum damping ratio of starts anywhere in the region, and the steps of their sequence, which fills the region
/// evenly (powers of the inverse of the plastic number, 1.3247…, as an additive sequence in two dimensions).
const MAX_START_RATIO: f64 = 0.9;
const SPREAD: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053_3];
/// Relative step below which the search of a zero has converged.
const CONVERGED: f64 = 4e-15;
/// Maximum relative step that may be rounding: eliminated drives lose two digits of the slope, and clusters more.
const MAX_ROUNDING: f64 = 1e-12;
/// Maximum step over the distance of the nearest other zero at which a search may end early. Beside another zero steps
/// are small, too, because it is divided out: they are then as long as the distance.
const APART: f64 = 0.1;
/// Maximum number of rounds of Newton steps. Four are usual; the maximum is a guard for clusters, where convergence is
/// linear at first.
const MAX_NEWTON_ROUNDS: usize = 60;
/// Ratio of Re ω to |ω| up to which a motion counts as decaying without oscillation: its damping ratio is then within
/// 5e-7 of one. With viscous damping alone its ω is imaginary, except for an error of at most [`WANTED_ERROR`]; the
/// constant damping ratio of cables moves it off the axis, by 1e-5 for servos with three times the critical damping.
const IMAGINARY: f64 = 1e-3;
/// Distance of the starts of modes that share an undamped zero from their mean, over the damping ratio, and the angle
/// of the first of them in units of the angle between them. The distance is below one, so that no start crosses the
/// real axis; the angle is none at which starts lie symmetric to an axis, on which searches would move alike.
const START_DISTANCE: f64 = 0.3;
const FIRST_ANGLE: f64 = 0.3;
/// Relative distance of a new start from the place of another zero: far more than the spread of a multiple zero
/// ([`ONE_ZERO`]) and far less than [`MAX_STEP`]. Angle of that start [rad]: on no axis.
const BESIDE: f64 = 1e-3;
const BESIDE_ANGLE: f64 = 0.7;
/// Number of evaluations of the determinant per mode: steps of its search and points on the boundary of the region.
const EVALUATIONS_PER_MODE: usize = 8;
/// Ratio to the frequency limit up to which poles are divided out of det D, so that no remaining pole is near a zero.
const POLES_BEYOND: f64 = 1.3;

/// Damped partner of every mode of a list.
///
/// # Example
/// ```
/// # use funicular::{dynamics::{Dynamics, Linearisation}, modes, robot::Robot, statics::{self, StaticModel}};
/// # let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
/// # let lengths = [6.863, 6.565, 6.756, 6.663, 6.801, 6.604];
/// let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
/// let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 5.0)?;
/// let undamped = modes::below(&dynamics, 5.0);
/// let damped = modes::damped::damped_modes(&dynamics, &undamped);
/// assert!(damped.certified && damped.modes.len() == undamped.modes.len());
/// // Its ropes have ξ = 0.003, which is the damping ratio of a mode of the cables alone.
/// assert!(damped.modes.iter().all(|mode| mode.damping_ratio() > 0.0 && mode.damping_ratio() < 0.003_001));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// O. Aberth, Math. Comp. 27(122), 1973; D. A. Bini, V. Noferini, Linear Algebra Appl. 439(4), 2013; docs/theory.md,
/// section 12.
pub fn damped_modes(dynamics: &Dynamics, undamped: &Modes) -> DampedModes {
    let limit = undamped.below_hz * TAU;
    // The region of the count ends in a gap between modes; those between limit and gap are sought, too.
    let right = free_of_modes(dynamics, limit);
    let mut sought = undamped.modes.clone();
    if dynamics.modes_below(right) > undamped.count_below {
        sought.extend(super::within(dynamics, undamped.below_hz, right / TAU));
    }
    let strongest = sought.iter().map(|mode| mode.damping_ratio).fold(0.0, f64::max);
    let steps = (strongest / STEP_OF_DAMPING).ceil().clamp(1.0, MAX_STEPS);
    dynamics.find_lossy_poles(EVALUATIONS_PER_MODE * sought.len());
    let mut search = ZeroSearch {
        dynamics,
        losses: 1.0 / steps,
        poles_below: POLES_BEYOND * limit,
        foreign: Vec::new(),
        may_grow: dynamics.has_delays(),
    };

    // All zeros at once; the damping is added in steps.
    let mut zeros = search.starts(&sought);
    search.converge(&mut zeros);
    while search.losses < 1.0 {
        search.losses = (search.losses + 1.0 / steps).min(1.0);
        search.follow(&mut zeros, &sought);
    }

    // Separate zeros that a multiple mode shares, and search again for lost zeros.
    search.separate(&mut zeros, &sought);
    search.bring_back(&mut zeros, &sought, right);

    let mut modes = vec![DampedMode { omega: Complex::new(0.0, 0.0), error: 0.0 }; sought.len()];
    for zero in &zeros {
        for member in &zero.members {
            modes[*member] = DampedMode { omega: zero.omega, error: zero.error };
        }
    }

    // Motions without oscillation lie on the imaginary axis, where no zeros are counted.
    let is_still = |mode: &DampedMode| mode.omega.re.abs() <= IMAGINARY * mode.omega.norm();
    let overdamped = modes[..undamped.modes.len()].iter().filter(|mode| is_still(mode)).count();
    let settled = undamped.certified
        && modes.iter().all(|mode| mode.error <= WANTED_ERROR && mode.omega.re > 0.0 && !is_still(mode));
    let unlisted = if settled { search.unlisted(&modes, limit, right) } else { None };
    let others = unlisted.and_then(|(count, left)| search.others(&mut zeros, count, (left, right)));
    let certified = others.is_some();
    let all: Vec<DampedMode> = modes.iter().copied().chain(others.unwrap_or_default()).collect();

    // Each mode has the zero to which its damping leads it.
    let followed = FollowedMode { dynamics, poles_below: POLES_BEYOND * limit };
    let is_known = |k: usize| search.of_cables_alone(&sought[k]).is_some() || is_still(&modes[k]);
    let Pairs { modes, mut unclear, mut others } = followed.paired(&sought, &all, is_known);
    let listed = undamped.modes.len();
    unclear.retain(|k| *k < listed);
    others.extend_from_slice(&modes[listed..]);
    others.retain(|mode| mode.omega.re < limit);
    DampedModes { modes: modes[..listed].to_vec(), overdamped, others, unclear, certified }
}

/// Search for the damped zeros.
struct ZeroSearch<'a> {
    dynamics: &'a Dynamics,
    /// Fraction of the damping that acts in the present step.
    losses: f64,
    /// Frequency up to which the clamped modes of the cables are divided out [rad/s].
    poles_below: f64,
    /// Zeros outside the region at which a search has ended; they are divided out, too.
    foreign: Vec<Complex>,
    /// True if a motion may grow, because the control of a motor has a delay. Otherwise every motion decays.
    may_grow: bool,
}

/// Zero with the undamped modes that share it.
struct DampedZero {
    omega: Complex,
    error: f64,
    members: Vec<usize>,
}

impl ZeroSearch<'_> {
    /// Start of each search: one per mode, or per multiple mode. Modes with the platform at rest have a closed form.
    fn starts(&self, modes: &[Mode]) -> Vec<DampedZero> {
        let mut zeros: Vec<DampedZero> = Vec::with_capacity(modes.len());
        let mut next = 0;
        while next < modes.len() {
            let mode = &modes[next];
            let members: Vec<usize> = (next..modes.len().min(next + mode.multiplicity)).collect();
            next += members.len();
            let undamped = mode.frequency_hz * TAU;
            zeros.push(if let Some(omega) = self.of_cables_alone(mode) {
                DampedZero { omega, error: 0.0, members }
            } else {
                let sum: f64 = members.iter().map(|i| modes[*i].damping_ratio).sum();
                let zeta = self.losses * sum / members.len() as f64;
                DampedZero { omega: undamped * Complex::new(1.0, zeta), error: f64::INFINITY, members }
            });
        }
        zeros
    }

    /// Complex frequency of a mode with the platform at rest whose cables have the same damping and no drive with
    /// losses.
    fn of_cables_alone(&self, mode: &Mode) -> Option<Complex> {
        if mode.platform_energy_fraction > AT_REST {
            return None;
        }
        let moving = mode.cable_energy_fractions.iter().enumerate().filter(|(_, fraction)| **fraction > AT_REST);
        if moving.clone().any(|(i, _)| self.dynamics.has_drive_losses(i)) {
            return None;
        }
        let mut damped = moving.map(|(i, _)| self.dynamics.cable_zero(i, mode.frequency_hz * TAU, self.losses));
        let first = damped.next()?;
        damped.all(|omega| (omega - first).norm() <= SAME_ZERO * first.norm()).then_some(first)
    }

    /// Moves the zeros from their places with less damping to those with the present damping.
    fn follow(&self, zeros: &mut [DampedZero], modes: &[Mode]) {
        for zero in &mut *zeros {
            match self.of_cables_alone(&modes[zero.members[0]]) {
                Some(omega) => zero.omega = omega,
                None => zero.error = f64::INFINITY,
            }
        }
        self.converge(zeros);
    }

    /// Takes Newton steps on f, divided by all the other zeros, until no zero moves.
    fn converge(&self, zeros: &mut [DampedZero]) {
        let mut settled = vec![false; zeros.len()];
        for _ in 0..MAX_NEWTON_ROUNDS {
            let mut moved = false;
            for i in 0..zeros.len() {
                if zeros[i].error <= CONVERGED || settled[i] {
                    continue;
                }

                // Newton step, with the other zeros divided out.
                let omega = zeros[i].omega;
                let others: Complex = zeros
                    .iter()
                    .filter(|other| other.omega != omega)
                    .map(|other| other.members.len() as f64 / (omega - other.omega))
                    .sum();
                let foreign: Complex = self.foreign.iter().map(|zero| 1.0 / (omega - zero)).sum();
                let slope = self.dynamics.logarithmic_slope(omega, self.losses, self.poles_below) - others - foreign;
                let step = zeros[i].members.len() as f64 / slope;

                if !(step.re.is_finite() && step.im.is_finite()) {
                    // At a zero, to rounding.
                    zeros[i].error = 0.0;
                    continue;
                }

                // Limit the step, so that a flat region of f does not move a search far away.
                let size = step.norm() / omega.norm();
                let step = if size > MAX_STEP { step * (MAX_STEP / size) } else { step };

                // End at rounding, where a small step is hardly smaller than the last one, or before all damping acts.
                let is_rounding = size <= MAX_ROUNDING && size > 0.25 * zeros[i].error;
                if is_rounding || (self.losses < 1.0 && size <= FOLLOWED) {
                    let others = zeros.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, other)| other.omega);
                    let distances = others.chain(self.foreign.iter().copied()).map(|other| (omega - other).norm());
                    settled[i] = step.norm() <= APART * distances.fold(f64::INFINITY, f64::min);
                }
                zeros[i].omega -= step;
                zeros[i].error = size;
                moved = true;
            }
            if !moved {
                break;
            }
        }
    }

    /// Splits zeros that several modes share if damping has separated them.
    fn separate(&self, zeros: &mut Vec<DampedZero>, modes: &[Mode]) {
        let (apart, mut all): (Vec<DampedZero>, Vec<DampedZero>) =
            zeros.drain(..).partition(|zero| zero.members.len() > 1 && zero.error > 0.0 && !self.is_one(zero));
        let any = !apart.is_empty();
        for zero in apart {
            for (k, &member) in zero.members.iter().enumerate() {
                // Separate starts around the undamped zero, at a distance in proportion to the damping.
                let mode = &modes[member];
                let turn = Complex::from_polar(
                    START_DISTANCE * mode.damping_ratio,
                    TAU * (k as f64 + FIRST_ANGLE) / zero.members.len() as f64,
                );
                let omega = mode.frequency_hz * TAU * (Complex::new(1.0, mode.damping_ratio) + turn);
                all.push(DampedZero { omega, error: f64::INFINITY, members: vec![member] });
            }
        }
        *zeros = all;
        if any {
            self.converge(zeros);
        }
    }

    /// Searches again for zeros that have left their region: from their own start, and from the starts of the zeros
    /// that have moved farthest, because one of these may have taken the zero of another, then from anywhere in the
    /// region. All others stay divided out.
    fn bring_back(&mut self, zeros: &mut [DampedZero], modes: &[Mode], right: f64) {
        let start = |zero: &DampedZero| {
            let mode = &modes[zero.members[0]];
            mode.frequency_hz * TAU * Complex::new(1.0, mode.damping_ratio)
        };
        // Zeros without damping lie on the real axis, except for rounding.
        let minimum = |zero: &DampedZero| -WANTED_ERROR * zero.omega.norm();
        let may_grow = self.may_grow;
        let is_outside = |zero: &DampedZero| {
            let grows = !may_grow && zero.omega.im < minimum(zero);
            grows || zero.omega.re < minimum(zero) || zero.omega.re > right
        };
        // A mode that its damping leads beyond the right edge is not lost, and needs no search.
        let followed = FollowedMode { dynamics: self.dynamics, poles_below: self.poles_below };
        let leaves = |zero: &DampedZero| match zero.members[..] {
            [member] if zero.error <= WANTED_ERROR && zero.omega.re > right => {
                followed.follow(&modes[member]).is_some_and(|of| of.omega.re > right)
            }
            _ => false,
        };
        let gone: Vec<usize> = (0..zeros.len()).filter(|i| leaves(&zeros[*i])).collect();
        for &i in &gone {
            if let Some(zero) = followed.follow(&modes[zeros[i].members[0]]) {
                (zeros[i].omega, zeros[i].error) = (zero.omega, zero.error);
            }
        }
        let is_lost =
            |(i, zero): (usize, &DampedZero)| !gone.contains(&i) && (zero.error > WANTED_ERROR || is_outside(zero));

        let mut outside: Vec<(usize, Complex)> = Vec::new();
        for round in 0..MAX_ROUNDS {
            let lost: Vec<usize> = (0..zeros.len()).filter(|i| is_lost((*i, &zeros[*i]))).collect();
            if lost.is_empty() {
                return;
            }

            // Starts: the zero's own, then those of the zeros that have moved farthest.
            let moved = |zero: &DampedZero| (zero.omega - start(zero)).norm() / zero.omega.norm();
            let mut places: Vec<usize> = (0..zeros.len()).filter(|i| !is_lost((*i, &zeros[*i]))).collect();
            order::sort_descending(&mut places, |i| moved(&zeros[*i]));

            for (k, i) in lost.into_iter().enumerate() {
                if zeros[i].error <= WANTED_ERROR {
                    self.foreign.push(zeros[i].omega);
                    outside.push((i, zeros[i].omega));
                }
                zeros[i].omega = if round < ROUNDS_AT_MODES {
                    let at = if round == 0 { i } else { places.get(round - 1 + k).copied().unwrap_or(i) };
                    // Start beside that place, because the zero there may belong to another mode.
                    let beside = Complex::from_polar(BESIDE, BESIDE_ANGLE + k as f64);
                    start(&zeros[at]) * (1.0 + beside)
                } else {
                    self.anywhere(round * (1 + k), right)
                };
                zeros[i].error = f64::INFINITY;
            }
            self.converge(zeros);
        }

        // A zero that is nowhere in the region is beyond its right edge: the first place there to which it came.
        for i in (0..zeros.len()).filter(|i| is_lost((*i, &zeros[*i]))).collect::<Vec<_>>() {
            let beyond =
                outside.iter().find(|(of, omega)| *of == i && omega.re > right && (may_grow || omega.im > 0.0));
            if let Some((_, omega)) = beyond {
                (zeros[i].omega, zeros[i].error) = (*omega, 0.0);
            }
        }
    }

    /// True if all modes that share a zero really have one multiple zero. The logarithmic slope on a small circle
    /// around it gives the number of zeros inside and the moments of their places.
    fn is_one(&self, zero: &DampedZero) -> bool {
        /// Points on the circle. The rule is exact for moments as high as the number of points allows: a single zero
        /// at a distance d from the centre leaves an error of (d/radius)^8.
        const POINTS: usize = 8;
        /// Radius of the circle, relative to |ω|: ten thousand times [`ONE_ZERO`]. Another zero inside changes the
        /// number, and the zeros are then sought one by one.
        const RADIUS: f64 = 1e-4;

        /// Maximum difference of the number of zeros inside from a whole number; anything well below a half would do.
        const WHOLE: f64 = 0.1;

        let radius = RADIUS * zero.omega.norm();
        let mut moments = [Complex::new(0.0, 0.0); 3];
        for k in 0..POINTS {
            let at = Complex::from_polar(radius, TAU * k as f64 / POINTS as f64);
            let mut power =
                self.dynamics.logarithmic_slope(zero.omega + at, self.losses, self.poles_below) * at / POINTS as f64;
            for moment in &mut moments {
                *moment += power;
                power *= at;
            }
        }

        let many = zero.members.len() as f64;
        let [count, first, second] = moments;
        let mean = first / many;
        let variance = second / many - mean * mean;
        (count - many).norm() < WHOLE && variance.norm().sqrt() <= ONE_ZERO * zero.omega.norm()
    }

    /// Number of zeros in the region that are not listed: those of the undamped robot and the turns of the phase of the
    /// quotient of both determinants along the boundary, less the listed ones; with the left edge of the region
    /// [rad/s]. `None` if they are fewer than listed, or not countable.
    fn unlisted(&self, modes: &[DampedMode], limit: f64, right: f64) -> Option<(usize, f64)> {
        let Some(min_re) = modes.iter().map(|mode| mode.omega.re).reduce(f64::min) else { return Some((0, right)) };
        let left = 0.5 * min_re;
        let undamped = self.dynamics.modes_below(right) as f64 - self.dynamics.modes_below(left) as f64;
        let listed = modes.iter().filter(|mode| mode.omega.re < right).count() as f64;
        let unlisted = (undamped + self.turns(modes, (left, right), limit)? / TAU - listed).round();
        (unlisted >= 0.0).then_some((unlisted as usize, left))
    }

    /// Further zeros between two real parts, of this number; `None` if they are not all found.
    fn others(
        &mut self,
        zeros: &mut Vec<DampedZero>,
        count: usize,
        (left, right): (f64, f64),
    ) -> Option<Vec<DampedMode>> {
        let mut found = Vec::with_capacity(count);
        for number in 0..MAX_ROUNDS {
            if found.len() == count {
                break;
            }
            let omega = self.anywhere(number, right);
            zeros.push(DampedZero { omega, error: f64::INFINITY, members: vec![0] });
            self.converge(zeros);
            let last = zeros.last()?;
            let (omega, error) = (last.omega, last.error);
            let settled = error <= WANTED_ERROR;
            if settled && omega.re > left && omega.re < right && (self.may_grow || omega.im >= 0.0) {
                found.push(DampedMode { omega, error });
                continue;
            }
            if settled {
                self.foreign.push(omega);
            }
            zeros.pop();
        }

        (found.len() == count).then_some(found)
    }

    /// Start of a search anywhere in the region below a frequency [rad/s]; the starts of all numbers fill it evenly.
    fn anywhere(&self, number: usize, right: f64) -> Complex {
        let [along, damped] = SPREAD.map(|step| ((number + 1) as f64 * step).fract());
        let ratio = if self.may_grow { 2.0 * damped - 1.0 } else { damped };
        right * along * Complex::new(1.0, MAX_START_RATIO * ratio)
    }

    /// Total change of the phase of the quotient of both determinants along the boundary of the region between two real
    /// parts [rad]; `None` if the boundary passes too near to a zero.
    fn turns(&self, modes: &[DampedMode], (left, right): (f64, f64), limit: f64) -> Option<f64> {
        let max_im = modes.iter().map(|mode| mode.omega.im).fold(0.0, f64::max);
        let min_im = modes.iter().map(|mode| mode.omega.im).fold(0.0, f64::min);

        // Corners of the region, so far from all zeros that the phase changes slowly.
        let margin = (MARGIN * max_im.max(-min_im)).max(MIN_MARGIN * limit);
        let corner = |re, im| Complex::new(re, im);
        let corners = [
            corner(left, min_im - margin),
            corner(right, min_im - margin),
            corner(right, max_im + margin),
            corner(left, max_im + margin),
        ];

        // Total change of the phase along the boundary.
        let phase = |omega: Complex| {
            self.dynamics.phase(omega, 1.0, self.poles_below) - self.dynamics.phase(omega, 0.0, self.poles_below)
        };
        let mut turned = 0.0;
        for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            let mut last = (*from, phase(*from));
            // The phase changes over distances like those to the zeros; a longer piece might miss a full turn at a
            // cluster.
            let pieces = ((to - from).norm() / (MAX_PIECE * margin)).ceil() as usize;
            for piece in 1..=pieces {
                let point = from + (to - from) * (piece as f64 / pieces as f64);
                let next = (point, phase(point));
                turned += turn_between(&phase, last, next, 0)?;
                last = next;
            }
        }

        Some(turned)
    }
}

/// Frequency at or slightly above the limit [rad/s], in the widest gap between undamped modes. Damping shifts the
/// frequencies, and none may cross the edge of the region in which they are counted.
fn free_of_modes(dynamics: &Dynamics, limit: f64) -> f64 {
    let at = |k: usize| limit * (1.0 + GAP_RANGE * k as f64 / GAP_POINTS as f64);
    let (mut widest, mut first) = (0..0, 0);
    let mut count = dynamics.modes_below(at(0));
    for k in 1..=GAP_POINTS {
        let next = dynamics.modes_below(at(k));
        if next != count {
            (first, count) = (k, next);
        } else if k - first > widest.len() {
            widest = first..k;
        }
    }
    0.5 * (at(widest.start) + at(widest.end))
}

/// Width of the range above the limit in which a gap between modes is sought, relative to the limit.
const GAP_RANGE: f64 = 0.05;
/// Number of points of this range at which modes are counted.
const GAP_POINTS: usize = 64;

/// Distance of the boundary of the counted region from the zeros: over the largest imaginary part of a zero, and its
/// minimum over the frequency limit. Not tuned: the nearer the boundary, the more points its phase needs.
const MARGIN: f64 = 2.0;
const MIN_MARGIN: f64 = 0.01;
/// Maximum length of a piece of the boundary, over its distance from the zeros: within each of its halves, which are
/// compared, the phase of one zero changes by less than half a radian.
const MAX_PIECE: f64 = 1.0;

/// Maximum step of a search, relative to its frequency.
const MAX_STEP: f64 = 0.1;

/// Change of a phase, reduced to −π to π.
fn wrapped(phase: f64) -> f64 {
    phase - TAU * (phase / TAU).round()
}

/// Change of phase between two points. The interval is halved until the change is small and both halves agree with the
/// total and with each other.
fn turn_between(
    phase: &impl Fn(Complex) -> f64,
    from: (Complex, f64),
    to: (Complex, f64),
    depth: usize,
) -> Option<f64> {
    // Maximum number of halvings: a zero on the path itself would need infinitely many.
    const MAX_DEPTH: usize = 30;
    // Maximum change of phase over an interval [rad]: a third of the half turn from which on it would be ambiguous.
    const MAX_CHANGE: f64 = 1.0;

    // Maximum difference between the change over the interval and the sum of its halves, which is zero or a full turn
    // except for rounding.
    const MAX_LOSS: f64 = 0.1;

    // Maximum difference between the changes over the two halves: beyond it the phase bends within the interval.
    const MAX_BEND: f64 = 0.5;

    let middle = 0.5 * (from.0 + to.0);
    let middle = (middle, phase(middle));
    let whole = wrapped(to.1 - from.1);
    let (first, second) = (wrapped(middle.1 - from.1), wrapped(to.1 - middle.1));
    if !(whole.is_finite() && first.is_finite()) || depth > MAX_DEPTH {
        return None;
    }

    if whole.abs() < MAX_CHANGE && (first + second - whole).abs() < MAX_LOSS && (first - second).abs() < MAX_BEND {
        return Some(whole);
    }

    Some(turn_between(phase, from, middle, depth + 1)? + turn_between(phase, middle, to, depth + 1)?)
}
