//! The whole robot as a pencil whose lowest eigenvalue is sought: platform, and cables side by side.

use super::cables::{Reduced, Whole, degree_of_start};
use super::search::{EXACT, Found, NEAR, ROUGH, lowest};
use super::{First, Kind, TAU};
use crate::cable::exact::abreast::{ACROSS, Abreast, IN_PLANE, Kept, LANES, Lane};
use crate::catenary::space::HangingCable;
use crate::dynamics::{self, Still};
use crate::math::{Mat6, Vec6};
use crate::robot::{Freedoms, Robot};
use crate::statics::{Equilibrium, wrench_of};
use std::array::from_fn;

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
    /// Where its matrices are.
    pub(super) group: usize,
    pub(super) lane: usize,
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
    pub(super) fn scale(&mut self, factor: f64) {
        self.platform *= factor;
        for bubbles in &mut self.bubbles {
            *bubbles = bubbles.map(|q| q * factor);
        }
    }

    pub(super) fn add(&mut self, factor: f64, other: &Self) {
        self.platform += other.platform * factor;
        for (a, b) in self.bubbles.iter_mut().zip(&other.bubbles) {
            *a = [a[0] + factor * b[0], a[1] + factor * b[1]];
        }
    }

    pub(super) fn dot(&self, other: &Self) -> f64 {
        let bubbles = self.bubbles.iter().zip(&other.bubbles);
        self.platform.dot(&other.platform) + bubbles.map(|(a, b)| a[0] * b[0] + a[1] * b[1]).sum::<f64>()
    }

    /// The kept unknowns of a group of arms.
    pub(super) fn lanes(&self, arms: &[Arm], group: usize) -> ([Lane; IN_PLANE], [Lane; ACROSS]) {
        let (mut plane, mut across) = ([[0.0; LANES]; IN_PLANE], [[0.0; LANES]; ACROSS]);
        for (arm, [q, p]) in arms.iter().zip(&self.bubbles).filter(|(arm, _)| arm.group == group) {
            let ([n, e, b], i) = (arm.end(&self.platform), arm.lane);
            (plane[0][i], plane[1][i], plane[2][i]) = (n, e, *q);
            (across[0][i], across[1][i]) = (b, *p);
        }
        (plane, across)
    }
}

/// Tangents that are drawn before all unknowns are looked at, and the relative change of x that ends it.
const MOST_TANGENTS: usize = 3;
const CLOSE_ENOUGH: f64 = 0.2;

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
        let groups = Abreast::groups(&curves)?;
        let arm = |group: usize, lane: usize| {
            let (cable, hanging): (usize, &HangingCable) = massive[groups[group].members()[lane]];
            let (level_w, up_w) = hanging.axes_w();
            let [cos, sin] = groups[group].axis(lane);
            let (e, n) = (level_w * cos + up_w * sin, up_w * cos - level_w * sin);
            let lever = equilibrium.cables[cable].lever_w / ell;
            let along = |u| motions.reduced(&wrench_of(&u, &lever));
            Arm { cable, group, lane, normal: along(n), along: along(e), out: along(e.cross(&n)) }
        };
        let places = |group: usize| (0..groups[group].members().len()).map(move |lane| (group, lane));
        let arms = (0..groups.len()).flat_map(places).map(|(group, lane)| arm(group, lane)).collect();
        let (freedoms, cable_count) = (motions.count(), robot.cables.len());
        Some(Self { freedoms, motions, ell, constant, mass, arms, groups, cable_count })
    }

    /// None if the equilibrium is unstable, or the search does not end.
    pub(super) fn first(&mut self) -> Option<First> {
        let mut groups = std::mem::take(&mut self.groups);
        let cut = groups.iter().any(Abreast::is_cut);
        let mut start = Reduced::of(&mut groups);
        let metric = start.mass.clone();
        let motion = self.any_motion(&metric, 0);
        let mut near = lowest(self, &mut start, &metric, 0.0, vec![motion], if cut { &ROUGH } else { &NEAR })?;
        if cut {
            near = self.nearer(near, &mut start, &mut groups)?;
        }
        let degrees = groups.iter().map(|group| degree_of_start(group) + 1).collect();
        let mut whole = Whole { groups: &mut groups, degrees };
        // Below rather than above, where another motion may be the nearest.
        let x = if cut { 0.95 * near.square } else { near.square };
        near.motions.truncate(1);
        let found = lowest(self, &mut whole, &start.mass, x, near.motions, &EXACT)?;
        Some(self.report(&found))
    }

    /// A better start where cables are cut: at rest, what has been eliminated moves otherwise than at the frequency, which
    /// comes out far too high.
    fn nearer(&self, mut near: Found, start: &mut Reduced, groups: &mut [Abreast]) -> Option<Found> {
        let mut x = 0.7 * near.square;
        for _ in 0..MOST_TANGENTS {
            if start.follow(groups, x) {
                let metric = start.mass.clone();
                near.motions.truncate(1);
                near = lowest(self, start, &metric, 0.75 * x, near.motions, &ROUGH)?;
                if (near.square - x).abs() < CLOSE_ENOUGH * x {
                    break;
                }
                x = near.square;
            } else {
                x *= 0.7;
            }
        }
        Some(near)
    }

    /// Not at right angles to any mode that somebody built; another one for each number.
    pub(super) fn any_motion(&self, masses: &[Kept], number: usize) -> Motion {
        // Even over its range, and of either sign but for the first.
        let part = |i: usize| {
            let even = ((i + 97 * number) as f64 * 0.754_877_666).fract();
            if number == 0 { 1.0 - 0.618 * even } else { 1.0 - 2.0 * even }
        };
        let platform = Vec6::from_fn(|i, _| if i < self.freedoms { part(i) } else { 0.0 });
        let bubbles = self
            .arms
            .iter()
            .enumerate()
            .map(|(i, arm)| {
                let (mass, lane) = (&masses[arm.group], arm.lane);
                let [q, p] = [mass.plane[5][lane], mass.across[2][lane]].map(|m| (self.mass[(0, 0)] / m).sqrt());
                [q * part(2 * i + 6), p * part(2 * i + 7)]
            })
            .collect();
        Motion { platform, bubbles }
    }

    /// B y with the masses about x = 0, which inverse iteration goes by: any positive definite B serves it.
    pub(super) fn inertia(&self, masses: &[Kept], y: &Motion) -> Motion {
        let mut platform = self.mass * y.platform;
        let bubbles = self
            .arms
            .iter()
            .zip(&y.bubbles)
            .map(|(arm, [q, p])| {
                let ([nn, en, ee, qn, qe, qq], [oo, bo, bb]) = masses[arm.group].of(arm.lane);
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
        let platform = &found.motions[0].platform;
        let platform_energy_fraction = platform.dot(&(self.mass * platform)) / found.mass;
        let motion_w = self.motions.expanded(platform);
        let largest = motion_w[motion_w.iamax()];
        // What moves a platform at rest is rounding.
        let at_rest = platform_energy_fraction < 1e-15;
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
