//! The whole robot as a pencil whose lowest eigenvalue is sought: platform, and cables side by side.

use super::factor::Factor;
use super::{First, Kind, TAU};
use crate::cable::exact::abreast::{ACROSS, Abreast, IN_PLANE, Kept, LANES, Lane, MOST_DEGREES, place};
use crate::catenary::space::HangingCable;
use crate::dynamics::{self, Still};
use crate::math::{Mat6, Vec6};
use crate::robot::{Freedoms, Robot};
use crate::statics::{Equilibrium, wrench_of};
use std::array::from_fn;

/// How far a search goes.
struct Aim {
    /// Relative width in ω² between the shift at which nothing vibrates and the Rayleigh quotient.
    width: f64,
    /// Most steps of inverse iteration at one shift; they end when the quotient stands still within the width.
    steps: usize,
}

/// Rounding, which is the stiffest spring's over the softest motion's, comes to 1e-13 in usual robots.
const EXACT: Aim = Aim { width: 1e-9, steps: 2 };
/// Where a step costs little.
const NEAR: Aim = Aim { width: 0.1, steps: 10 };
/// Evaluations after which the slow way is faster. Seen: 2 to 5, some 12 where frequencies cluster.
const MOST_EVALUATIONS: usize = 40;

/// A robot about its equilibrium.
pub(super) struct Pencil {
    pub(super) freedoms: usize,
    motions: Freedoms,
    ell: f64,
    /// Stiffness of what has no frequency, and mass of the platform; scaled, in the platform's coordinates.
    pub(super) constant: Mat6,
    pub(super) mass: Mat6,
    pub(super) arms: Vec<Arm>,
    groups: Vec<Abreast>,
    cable_count: usize,
}

/// A cable that has mass, its axes as scaled vectors.
pub(super) struct Arm {
    cable: usize,
    pub(super) normal: Vec6,
    pub(super) along: Vec6,
    pub(super) out: Vec6,
}

impl Arm {
    /// How its platform end moves: n, e, b.
    pub(super) fn end(&self, platform: &Vec6) -> [f64; 3] {
        [self.normal.dot(platform), self.along.dot(platform), self.out.dot(platform)]
    }

    pub(super) fn wrench(&self, [n, e, b]: [f64; 3]) -> Vec6 {
        self.normal * n + self.along * e + self.out * b
    }
}

/// Motion of the platform, and of each arm's lowest bubbles in plane and out of plane.
#[derive(Clone)]
pub(super) struct Motion {
    pub(super) platform: Vec6,
    pub(super) bubbles: Vec<[f64; 2]>,
}

impl Motion {
    fn scale(&mut self, factor: f64) {
        self.platform *= factor;
        for bubbles in &mut self.bubbles {
            *bubbles = bubbles.map(|q| q * factor);
        }
    }

    fn dot(&self, other: &Self) -> f64 {
        let bubbles = self.bubbles.iter().zip(&other.bubbles);
        self.platform.dot(&other.platform) + bubbles.map(|(a, b)| a[0] * b[0] + a[1] * b[1]).sum::<f64>()
    }

    /// The kept unknowns of a group of arms.
    fn lanes(&self, arms: &[Arm], group: usize) -> ([Lane; IN_PLANE], [Lane; ACROSS]) {
        let (mut plane, mut across) = ([[0.0; LANES]; IN_PLANE], [[0.0; LANES]; ACROSS]);
        let range = group * LANES..arms.len().min((group + 1) * LANES);
        for (i, (arm, [q, p])) in arms[range.clone()].iter().zip(&self.bubbles[range]).enumerate() {
            let [n, e, b] = arm.end(&self.platform);
            (plane[0][i], plane[1][i], plane[2][i]) = (n, e, *q);
            (across[0][i], across[1][i]) = (b, *p);
        }
        (plane, across)
    }
}

/// K − xM of the kept unknowns of each group, and the mass of a motion that follows.
trait Cables {
    fn kept(&mut self, x: f64, into: &mut Vec<Kept>);

    /// Mass that moves with each arm of a group, at the x of the last call of `kept`.
    fn mass(&self, group: usize, plane: [Lane; IN_PLANE], across: [Lane; ACROSS]) -> Lane;
}

/// Matrices of each group about x = 0, the eliminated unknowns following the kept ones as at rest.
struct Reduced {
    stiffness: Vec<Kept>,
    mass: Vec<Kept>,
}

/// All unknowns, finer with each evaluation: so the last step of the iteration checks the discretisation, too.
struct Whole<'a> {
    groups: &'a mut [Abreast],
    degrees: Vec<usize>,
}

/// A motion and its Rayleigh quotient.
struct Found {
    square: f64,
    motion: Motion,
    /// Mass of platform and cables.
    mass: f64,
    /// The part of each arm.
    arms: Vec<f64>,
}

impl Pencil {
    /// None if a cable is none that this way knows.
    pub(super) fn new(robot: &Robot, equilibrium: &Equilibrium) -> Option<Self> {
        let Still { mut constant, mass, ell } = dynamics::still(robot, equilibrium);
        let motions = robot.platform.freedoms;
        let mut massive = Vec::with_capacity(equilibrium.cables.len());
        let mut curves = Vec::with_capacity(equilibrium.cables.len());
        for (i, state) in equilibrium.cables.iter().enumerate() {
            let hanging = state.hanging.as_ref()?;
            let mass_per_length = robot.cables[i].material.mass_per_length;
            if hanging.catenary.parallel_tension() <= 0.0 {
                return None;
            }
            if mass_per_length == 0.0 {
                constant += dynamics::constant_cable(robot, state, &hanging.tangent_w());
                continue;
            }
            massive.push((i, hanging));
            curves.push((&hanging.catenary, mass_per_length));
        }
        let groups = curves.chunks(LANES).map(Abreast::new).collect::<Option<Vec<_>>>()?;
        let arm = |(at, (cable, hanging)): (usize, (usize, &HangingCable))| {
            let (level_w, up_w) = hanging.axes_w();
            let [cos, sin] = groups[at / LANES].axis(at % LANES);
            let (e, n) = (level_w * cos + up_w * sin, up_w * cos - level_w * sin);
            let lever = equilibrium.cables[cable].lever_w / ell;
            let along = |u| motions.reduced(&wrench_of(&u, &lever));
            Arm { cable, normal: along(n), along: along(e), out: along(e.cross(&n)) }
        };
        let arms = massive.into_iter().enumerate().map(arm).collect();
        let (freedoms, cable_count) = (motions.count(), robot.cables.len());
        Some(Self { freedoms, motions, ell, constant, mass, arms, groups, cable_count })
    }

    /// None if the equilibrium is unstable, or the search does not end.
    pub(super) fn first(&mut self) -> Option<First> {
        let mut groups = std::mem::take(&mut self.groups);
        let mut start = Reduced::of(&mut groups);
        let motion = self.any_motion(&start.mass);
        let metric = start.mass.clone();
        let near = self.lowest(&mut start, &metric, 0.0, motion, &NEAR)?;
        let degrees = groups.iter().map(|group| degree_of_start(group) + 1).collect();
        let mut whole = Whole { groups: &mut groups, degrees };
        let found = self.lowest(&mut whole, &metric, near.square, near.motion, &EXACT)?;
        Some(self.report(&found))
    }

    /// Not at right angles to any mode that somebody built.
    fn any_motion(&self, masses: &[Kept]) -> Motion {
        let part = |i: usize| 1.0 - 0.618 * ((i as f64 * 0.754_877_666).fract());
        let platform = Vec6::from_fn(|i, _| if i < self.freedoms { part(i) } else { 0.0 });
        let bubbles = (0..self.arms.len())
            .map(|i| {
                let (mass, lane) = (&masses[i / LANES], i % LANES);
                let [q, p] = [mass.plane[5][lane], mass.across[2][lane]].map(|m| (self.mass[(0, 0)] / m).sqrt());
                [q * part(2 * i + 6), p * part(2 * i + 7)]
            })
            .collect();
        Motion { platform, bubbles }
    }

    /// The lowest eigenvalue within a relative `width`, from a shift x and a motion near it.
    ///
    /// Inverse iteration at each shift; the next shift is half the width below the Rayleigh quotient, so that the search
    /// ends with the first one that is positive definite. If the quotient belongs to a higher mode, shifts are halved
    /// between what is known.
    fn lowest(
        &self,
        cables: &mut impl Cables,
        metric: &[Kept],
        mut x: f64,
        mut motion: Motion,
        aim: &Aim,
    ) -> Option<Found> {
        let width = aim.width;
        let (mut low, mut high) = (0.0_f64, f64::INFINITY);
        let mut kept = Vec::with_capacity(self.arms.len().div_ceil(LANES));
        let mut patience = 1;
        for evaluation in 0..MOST_EVALUATIONS {
            cables.kept(x, &mut kept);
            let factor = Factor::of(self, &kept, x);
            if factor.negative == 0 {
                low = x;
            } else if x == 0.0 {
                return None;
            } else {
                high = high.min(x);
            }
            let found = self.improved(cables, metric, &factor, x, motion, aim);
            let quotient = found.square;
            if !quotient.is_finite() {
                return None;
            }
            if factor.negative == 0 && quotient - x <= width * quotient && evaluation > 0 {
                return Some(found);
            }
            motion = found.motion;
            let leads = quotient > 0.0 && quotient <= high && (factor.negative < 2 || patience > 0);
            if factor.negative >= 2 {
                patience -= 1;
            }
            if quotient > 0.0 {
                high = high.min(quotient);
            }
            // A lower bound of a coarser discretisation may lie above.
            low = if low < high { low } else { 0.9 * high };
            let next = quotient * (1.0 - 0.5 * width);
            x = if leads && next > low {
                next
            } else if low > 0.0 {
                0.5 * (low + high)
            } else {
                0.25 * high
            };
        }
        None
    }

    /// Inverse iteration at a shift.
    fn improved(
        &self,
        cables: &impl Cables,
        metric: &[Kept],
        factor: &Factor,
        x: f64,
        mut motion: Motion,
        aim: &Aim,
    ) -> Found {
        let mut force = self.inertia(metric, &motion);
        let (mut work, mut before) = (0.0, f64::INFINITY);
        for _ in 0..aim.steps {
            motion = factor.solve(self, &force);
            // A z = B y, so zᵀ A z without another product.
            work = motion.dot(&force);
            force = self.inertia(metric, &motion);
            let square = motion.dot(&force);
            motion.scale(1.0 / square.sqrt());
            force.scale(1.0 / square.sqrt());
            work /= square;
            if (work - before).abs() <= 0.1 * aim.width * (x + work).abs() {
                break;
            }
            before = work;
        }
        let mut arms = Vec::with_capacity(self.arms.len());
        for group in 0..self.arms.len().div_ceil(LANES) {
            let (plane, across) = motion.lanes(&self.arms, group);
            let masses = cables.mass(group, plane, across);
            arms.extend_from_slice(&masses[..LANES.min(self.arms.len() - group * LANES)]);
        }
        let mass = motion.platform.dot(&(self.mass * motion.platform)) + arms.iter().sum::<f64>();
        Found { square: x + work / mass, motion, mass, arms }
    }

    /// B y with the masses about x = 0, which inverse iteration goes by: any positive definite B serves it.
    fn inertia(&self, masses: &[Kept], y: &Motion) -> Motion {
        let mut platform = self.mass * y.platform;
        let bubbles = self
            .arms
            .iter()
            .zip(&y.bubbles)
            .enumerate()
            .map(|(i, (arm, [q, p]))| {
                let ([nn, en, ee, qn, qe, qq], [oo, bo, bb]) = masses[i / LANES].of(i % LANES);
                let [n, e, b] = arm.end(&y.platform);
                platform += arm.wrench([nn * n + en * e + qn * q, en * n + ee * e + qe * q, oo * b + bo * p]);
                [qn * n + qe * e + qq * q, bo * b + bb * p]
            })
            .collect();
        Motion { platform, bubbles }
    }

    fn report(&self, found: &Found) -> First {
        let mut cable_energy_fractions = vec![0.0; self.cable_count];
        for (arm, mass) in self.arms.iter().zip(&found.arms) {
            cable_energy_fractions[arm.cable] = mass / found.mass;
        }
        let platform = &found.motion.platform;
        let platform_energy_fraction = platform.dot(&(self.mass * platform)) / found.mass;
        let motion_w = self.motions.expanded(platform);
        let largest = motion_w[motion_w.iamax()];
        // What moves a platform at rest is rounding.
        let at_rest = platform_energy_fraction < 1e-20;
        let shape = from_fn(|i| match i {
            _ if at_rest => 0.0,
            0..3 => motion_w[i] / largest,
            _ => motion_w[i] / largest / self.ell,
        });
        First {
            frequency_hz: found.square.sqrt() / TAU,
            kind: Kind::of(platform_energy_fraction),
            platform_energy_fraction,
            cable_energy_fractions,
            shape,
            unstable_directions: 0,
            certified: true,
        }
    }
}

/// Two digits of half a wave, more where C varies; three degrees more give nine digits.
fn degree_of_start(group: &Abreast) -> usize {
    4 + group.terms() / 8
}

impl Reduced {
    fn of(groups: &mut [Abreast]) -> Self {
        let (mut stiffness, mut mass) = (Vec::with_capacity(groups.len()), Vec::with_capacity(groups.len()));
        for group in groups {
            stiffness.push(group.kept(0.0, degree_of_start(group)));
            let unit = |k: usize| {
                let one = |j: usize| if j == k { [1.0; LANES] } else { [0.0; LANES] };
                group.moved(from_fn(one), from_fn(one))
            };
            let units = [unit(0), unit(1), unit(2)];
            let mut masses = Kept {
                plane: [[0.0; LANES]; 6],
                across: [[0.0; LANES]; 3],
                least_pivot: [f64::INFINITY; LANES],
            };
            for row in 0..IN_PLANE {
                for column in 0..=row {
                    let [plane, across] = group.mass(&units[row], &units[column]);
                    masses.plane[place(row, column)] = plane;
                    if row < ACROSS {
                        masses.across[place(row, column)] = across;
                    }
                }
            }
            mass.push(masses);
        }
        Self { stiffness, mass }
    }
}

impl Cables for Reduced {
    fn kept(&mut self, x: f64, into: &mut Vec<Kept>) {
        into.clear();
        into.extend(self.stiffness.iter().zip(&self.mass).map(|(k, m)| Kept {
            plane: from_fn(|entry| from_fn(|i| k.plane[entry][i] - x * m.plane[entry][i])),
            across: from_fn(|entry| from_fn(|i| k.across[entry][i] - x * m.across[entry][i])),
            least_pivot: k.least_pivot,
        }));
    }

    fn mass(&self, group: usize, plane: [Lane; IN_PLANE], across: [Lane; ACROSS]) -> Lane {
        let m = &self.mass[group];
        let mut sums = [0.0; LANES];
        let mut add = |entry: &Lane, a: &Lane, b: &Lane, times: f64| {
            for i in 0..LANES {
                sums[i] += times * entry[i] * a[i] * b[i];
            }
        };
        for row in 0..IN_PLANE {
            for column in 0..=row {
                let times = if row == column { 1.0 } else { 2.0 };
                add(&m.plane[place(row, column)], &plane[row], &plane[column], times);
                if row < ACROSS {
                    add(&m.across[place(row, column)], &across[row], &across[column], times);
                }
            }
        }
        sums
    }
}

impl Cables for Whole<'_> {
    fn kept(&mut self, x: f64, into: &mut Vec<Kept>) {
        into.clear();
        for (group, degree) in self.groups.iter_mut().zip(&mut self.degrees) {
            into.push(group.kept(x, *degree));
            *degree = (*degree + 2).min(MOST_DEGREES);
        }
    }

    fn mass(&self, group: usize, plane: [Lane; IN_PLANE], across: [Lane; ACROSS]) -> Lane {
        let group = &self.groups[group];
        let motion = group.moved(plane, across);
        let [plane, across] = group.mass(&motion, &motion);
        from_fn(|i| plane[i] + across[i])
    }
}
