//! Random robots over the range of robots that are built, and beyond; the number of a robot is its seed.
//!
//! A robot starts from a pose. Then come sag ratios and tensions of straight cables that balance the platform, ropes
//! whose weight gives that sag at that tension, and last the unstrained lengths at which catenaries balance it too. So
//! the sag has the requested value, from taut to 15 % of the chord, and the equilibrium is known before the program is
//! used.

use funicular::catenary::{Catenary, Rope};
use funicular::math::{DMat, Rotation, Vec3, Vec6};
use funicular::robot::{Pose, Robot, State};
use funicular::statics::{self, StaticModel};
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng};
use std::f64::consts::TAU;
use std::fmt::Write;

/// Purpose of a robot in the collection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Purpose {
    /// Robot with modes.
    Proper,
    /// Rigid platform on 4 or 5 cables.
    TooFewCables,
    /// Robot with a slack cable: it has no mass and is longer than its chord.
    Slack,
    /// Robot whose frequency limit is up to a thousand times the limit of a list of modest length.
    FarTooHigh,
}

/// Arrangement of the cables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Arrangement {
    /// Rigid platform on six cables from above.
    Hanging,
    /// Rigid platform on 7 to 12 cables, some of them from below.
    Redundant,
    /// Rigid platform with cables that are mirrored or rotated images of each other, exactly or nearly.
    Symmetric,
    /// Point mass on 4 to 12 cables.
    PointMass,
}

/// Robot with its known properties.
#[derive(Debug, Clone)]
pub(crate) struct RandomRobot {
    pub(crate) index: u64,
    pub(crate) purpose: Purpose,
    pub(crate) arrangement: Arrangement,
    pub(crate) robot: Robot,
    pub(crate) lengths: Vec<f64>,
    /// Pose of equilibrium with these lengths; it may be unstable.
    pub(crate) pose: Pose,
    /// Approximate ratio of sag to chord of each cable.
    pub(crate) sag: Vec<f64>,
    /// Frequency limit of the list.
    pub(crate) below_hz: f64,
    /// Text of the robot file.
    pub(crate) text: String,
}

/// Robot of a number.
pub(crate) fn sample(index: u64) -> RandomRobot {
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&index.to_le_bytes());
    let mut draw = RobotGenerator(TestRng::from_seed(RngAlgorithm::ChaCha, &seed));
    let purpose = match draw.0.random_range(0..100) {
        0..4 => Purpose::TooFewCables,
        4..6 => Purpose::Slack,
        6..8 => Purpose::FarTooHigh,
        _ => Purpose::Proper,
    };
    let arrangement = match draw.0.random_range(0..100) {
        _ if purpose == Purpose::TooFewCables => Arrangement::Hanging,
        0..25 => Arrangement::Hanging,
        25..60 => Arrangement::Redundant,
        60..85 => Arrangement::Symmetric,
        _ => Arrangement::PointMass,
    };
    // Most arrangements hold no platform, or not with tension in all cables; then others are drawn.
    for _ in 0..100_000 {
        if let Some(sample) = draw.attempt(index, purpose, arrangement) {
            return sample;
        }
    }
    panic!("robot {index}: no {arrangement:?} of purpose {purpose:?} found");
}

struct RobotGenerator(TestRng);

/// Start and end of the cables, world axes from the pose's origin.
struct CableEnds {
    levers: Vec<Vec3>,
    anchors: Vec<Vec3>,
    symmetric: bool,
}

impl RobotGenerator {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0.random_range(low..high)
    }

    /// Uniformly distributed in the logarithm.
    fn decades(&mut self, low: f64, high: f64) -> f64 {
        10f64.powf(self.between(low, high))
    }

    fn chance(&mut self, part: f64) -> bool {
        self.0.random_bool(part)
    }

    /// Random robot; `None` if the cables cannot hold the platform.
    fn attempt(&mut self, index: u64, purpose: Purpose, arrangement: Arrangement) -> Option<RandomRobot> {
        let size = self.decades(-0.3, 1.0);
        let mut places = match arrangement {
            Arrangement::Symmetric => self.symmetric(size),
            _ => self.scattered(purpose, arrangement, size),
        };
        let n = places.levers.len();
        let symmetric = places.symmetric;
        if symmetric && self.chance(0.5) {
            // Nearly symmetric: multiple frequencies separate, some by as little as rounding.
            let off = size * self.decades(-10.0, -2.0);
            for anchor in &mut places.anchors {
                *anchor += Vec3::from_fn(|_, _| off * self.between(-1.0, 1.0));
            }
        }
        let tilt = if !symmetric && self.chance(0.3) { self.between(0.05, 0.7) } else { 0.0 };
        let turn = self.between(0.0, TAU);
        let up = Vec3::new(tilt.sin() * turn.cos(), tilt.sin() * turn.sin(), tilt.cos());
        let mass = self.decades(0.0, 3.0);
        let radius = places.levers.iter().map(Vec3::norm).sum::<f64>() / n as f64;
        let com = match arrangement {
            Arrangement::PointMass => Vec3::zeros(),
            _ if symmetric => Vec3::z() * (radius * self.between(-1.0, 0.3)),
            _ => Vec3::new(self.between(-0.3, 0.3), self.between(-0.3, 0.3), self.between(-1.0, 0.3)) * radius,
        };
        let sag = self.sags(index, n, symmetric);
        let weight = mass * G;
        let cables = self.cables(&places, arrangement, &up, &com, weight, &sag)?;
        let inertia =
            if arrangement == Arrangement::PointMass { None } else { Some(self.inertia(mass, radius, symmetric)) };
        // The platform's frame is rotated against the world's, because levers are given in world axes.
        let angles: [f64; 3] =
            std::array::from_fn(|_| if symmetric || inertia.is_none() { 0.0 } else { self.between(-40.0, 40.0) });
        let position: [f64; 3] = std::array::from_fn(|_| if symmetric { 0.0 } else { size * self.between(-1.0, 1.0) });
        let pose = Pose::new(position, angles);
        let damping: Vec<f64> = {
            let one = self.decades(-2.52, -1.52);
            let alike = symmetric || self.chance(0.5);
            (0..n).map(|_| if alike { one } else { self.decades(-2.52, -1.52) }).collect()
        };
        let mut text = head(index, &up, mass, &com, inertia, &pose.rot_wp);
        for (i, cable) in cables.iter().enumerate() {
            let anchor = position_of(&(pose.position_w + places.anchors[i]));
            let Fit { axial_stiffness, mass_per_length, .. } = cable;
            write!(
                text,
                "[materials.rope{i}]\naxial_stiffness_n = {axial_stiffness:?}\nmass_kg_per_m = {mass_per_length:?}\n\
                 damping_ratio = {:?}\n[[cables]]\nname = \"{i}\"\nmaterial = \"rope{i}\"\nanchor_m = {anchor:?}\n",
                damping[i]
            )
            .unwrap();
            if inertia.is_some() {
                let attachment = position_of(&(pose.rot_wp.inverse() * places.levers[i]));
                writeln!(text, "attachment_m = {attachment:?}").unwrap();
            }
        }
        let robot = Robot::from_toml(&text).unwrap_or_else(|refused| panic!("robot {index}: {refused}\n{text}"));
        let mut lengths = if purpose == Purpose::TooFewCables {
            cables.iter().map(|cable| cable.chord).collect()
        } else {
            balanced(&robot, &pose, &cables)?
        };
        if purpose == Purpose::Slack {
            // This cable has no mass and is slightly longer than its chord at the pose where the others hold the
            // platform.
            let i = self.0.random_range(0..n);
            let rope = |mass: f64| {
                format!(
                    "[materials.rope{i}]\naxial_stiffness_n = {:?}\nmass_kg_per_m = {mass:?}\n",
                    cables[i].axial_stiffness
                )
            };
            text = text.replacen(&rope(cables[i].mass_per_length), &rope(0.0), 1);
            lengths[i] = 3.0 * cables[i].chord;
        }
        let text = with_lengths(&text, &lengths);
        let robot = Robot::from_toml(&text).unwrap_or_else(|refused| panic!("robot {index}: {refused}\n{text}"));
        let below_hz = self.limit(&cables) * if purpose == Purpose::FarTooHigh { 1000.0 } else { 1.0 };
        Some(RandomRobot { index, purpose, arrangement, robot, lengths, pose, sag, below_hz, text })
    }

    /// Cables around and above the platform, some from below, some nearly vertical.
    fn scattered(&mut self, purpose: Purpose, arrangement: Arrangement, size: f64) -> CableEnds {
        let n = match (purpose, arrangement) {
            (Purpose::TooFewCables, _) => self.0.random_range(4..=5),
            (_, Arrangement::Hanging) => 6,
            (_, Arrangement::Redundant) => self.0.random_range(7..=12),
            _ => self.0.random_range(4..=12),
        };
        let below = if arrangement == Arrangement::Hanging { 0.0 } else { self.between(0.0, 0.5) };
        let twist = self.between(-2.5, 2.5);
        let radius = self.between(0.05, 0.3);
        let vertical = if self.chance(0.3) { 0.3 } else { 0.0 };
        let (mut levers, mut anchors) = (Vec::new(), Vec::new());
        for i in 0..n {
            let around = TAU * (f64::from(i) + self.between(0.0, 1.0)) / f64::from(n);
            let inner = around + twist * if i % 2 == 0 { 1.0 } else { -1.0 } + self.between(-0.4, 0.4);
            let lever = match arrangement {
                Arrangement::PointMass => Vec3::zeros(),
                _ => Vec3::new(radius * inner.cos(), radius * inner.sin(), self.between(-0.15, 0.15)) * size,
            };
            let height = self.between(0.25, 1.2) * if self.chance(below) { -1.0 } else { 1.0 };
            let out = self.between(0.4, 1.3);
            let place = Vec3::new(out * around.cos(), out * around.sin(), height) * size;
            let upright = self.chance(vertical);
            let nearly = self.decades(-6.0, -1.0);
            anchors.push(if upright {
                lever + Vec3::new(nearly * around.cos(), nearly * around.sin(), 1.2 * height) * size
            } else {
                place
            });
            levers.push(lever);
        }
        CableEnds { levers, anchors, symmetric: false }
    }

    /// Two or three families of cables that a symmetry maps onto themselves: mirrored in two planes, which is exact to
    /// rounding, or rotated about the vertical and mirrored.
    fn symmetric(&mut self, size: f64) -> CableEnds {
        let (mut levers, mut anchors) = (Vec::new(), Vec::new());
        let two_planes = self.chance(0.5);
        let turns = self.0.random_range(3..=6);
        let families = if two_planes {
            self.0.random_range(2..=3)
        } else if turns == 3 {
            self.0.random_range(1..=2)
        } else {
            1
        };
        for family in 0..families {
            let around: f64 = self.between(0.0, TAU);
            let inner: f64 = around + self.between(-2.5, 2.5);
            let (out, radius) = (self.between(0.4, 1.3), self.between(0.05, 0.3));
            let height = if family > 0 && self.chance(0.6) { -1.0 } else { 1.0 } * self.between(0.25, 1.2);
            let anchor = Vec3::new(out * around.cos(), out * around.sin(), height) * size;
            let lever = Vec3::new(radius * inner.cos(), radius * inner.sin(), self.between(-0.15, 0.15)) * size;
            if two_planes {
                for (x, y) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
                    let image = |v: &Vec3| Vec3::new(x * v.x, y * v.y, v.z);
                    levers.push(image(&lever));
                    anchors.push(image(&anchor));
                }
            } else {
                for k in 0..2 * turns {
                    let turn = Rotation::from_axis_angle(&Vec3::z_axis(), TAU * f64::from(k / 2) / f64::from(turns));
                    let image = |v: &Vec3| turn * Vec3::new(v.x, if k % 2 == 0 { v.y } else { -v.y }, v.z);
                    levers.push(image(&lever));
                    anchors.push(image(&anchor));
                }
            }
        }
        CableEnds { levers, anchors, symmetric: true }
    }

    /// Sag ratios. The level of a robot is evenly distributed with its number. Cables that all sag by 12.5 % or more
    /// pull down with any slope and hold no platform (a cable's end is horizontal if sin α cos α = 4 d/l).
    fn sags(&mut self, index: u64, n: usize, alike: bool) -> Vec<f64> {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let level = 0.1 * (index as f64 * GOLDEN).fract();
        let way = self.0.random_range(0..3);
        (0..n)
            .map(|_| match way {
                _ if alike => level,
                0 => level,
                1 => self.between(0.0, MAX_SAG),
                _ => MAX_SAG * self.decades(-3.0, 0.0),
            })
            .collect()
    }

    /// Ropes and tensions: at sag r a cable with the tension τ along its chord weighs 8 τ r/cos α, half of which the
    /// platform carries, so that the balance is linear in τ.
    fn cables(
        &mut self,
        places: &CableEnds,
        arrangement: Arrangement,
        up: &Vec3,
        com: &Vec3,
        weight: f64,
        sag: &[f64],
    ) -> Option<Vec<Fit>> {
        let n = sag.len();
        let massless = !places.symmetric && self.chance(0.12);
        let rows = if arrangement == Arrangement::PointMass { 3 } else { 6 };
        let mut columns = DMat::zeros(rows, n);
        let mut weights = Vec::with_capacity(n);
        let radius = places.levers.iter().map(Vec3::norm).fold(0.0, f64::max).max(1e-3);
        let mut chords = Vec::with_capacity(n);
        for (i, sag) in sag.iter().enumerate() {
            let chord = places.anchors[i] - places.levers[i];
            let length = chord.norm();
            let e = chord / length;
            let level = (e - up * e.dot(up)).norm();
            // A steep cable of that sag would hang down to twice its chord: it gets what a cable at 70° has.
            let own = if massless && self.chance(0.3) { 0.0 } else { 8.0 * sag / level.max(0.34) };
            let column = wrench(&(e - up * (0.5 * own)), &places.levers[i], radius);
            columns.column_mut(i).copy_from(&column.rows(0, rows));
            weights.push(own);
            chords.push(length);
        }
        let load = wrench(&(up * -weight), com, radius);
        let load = DMat::from_fn(columns.nrows(), 1, |i, _| -load[i]);
        let wanted = self.decades(-0.5, 0.7) * weight;
        let start = DMat::from_fn(n, 1, |_, _| wanted * if places.symmetric { 0.5 } else { self.between(0.2, 1.0) });
        // Fewer cables than degrees of freedom do not balance an arbitrary pose.
        let tensions = if n < rows {
            start
        } else {
            let tensions = &start + inverse(&columns)? * (&load - &columns * &start);
            let (largest, least) = (tensions.max(), tensions.min());
            let balanced = (&columns * &tensions - &load).amax() <= 1e-9 * largest;
            (balanced && least >= 0.03 * largest).then_some(tensions)?
        };
        let strain = self.decades(-5.0, -2.3);
        let one_rope = places.symmetric || self.chance(0.3);
        Some(
            (0..n)
                .map(|i| {
                    let tension = tensions[i];
                    let strain = if one_rope { strain } else { self.decades(-5.0, -2.3) };
                    let mass_per_length = weights[i] * tension / (G * chords[i]);
                    Fit { chord: chords[i], tension, axial_stiffness: tension / strain, mass_per_length }
                })
                .collect(),
        )
    }

    /// Three principal moments of a body with about the radius of the attachments.
    fn inertia(&mut self, mass: f64, radius: f64, symmetric: bool) -> [f64; 3] {
        let square = |draw: &mut Self| draw.between(0.05, 0.5) * radius * radius;
        let (x, y, z) = (square(self), square(self), square(self));
        let y = if symmetric { x } else { y };
        [mass * (y + z), mass * (x + z), mass * (x + y)]
    }

    /// Limit [Hz] below which the cables alone have a dozen to 150 modes.
    fn limit(&mut self, cables: &[Fit]) -> f64 {
        let modes = self.decades(1.1, 2.2);
        let per_hz: f64 =
            cables.iter().map(|cable| 4.0 * cable.chord * (cable.mass_per_length / cable.tension).sqrt()).sum();
        if per_hz > 0.0 { modes / per_hz } else { 100.0 }
    }
}

/// Gravity [m/s²].
const G: f64 = 9.81;
/// Maximum ratio of sag to chord.
const MAX_SAG: f64 = 0.15;

/// Intended data of a cable.
struct Fit {
    chord: f64,
    tension: f64,
    axial_stiffness: f64,
    mass_per_length: f64,
}

fn wrench(force: &Vec3, lever: &Vec3, radius: f64) -> Vec6 {
    let moment = lever.cross(force) / radius;
    Vec6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
}

/// Pseudoinverse `Aᵀ (A Aᵀ)⁻¹`, for the smallest change of tensions that gives a change of wrench; `None` if the cables
/// do not span all wrenches.
fn inverse(columns: &DMat) -> Option<DMat> {
    Some(columns.transpose() * (columns * columns.transpose()).cholesky()?.inverse())
}

fn position_of(v: &Vec3) -> [f64; 3] {
    [v.x, v.y, v.z]
}

fn head(index: u64, up: &Vec3, mass: f64, com: &Vec3, inertia: Option<[f64; 3]>, rot: &Rotation) -> String {
    let gravity = position_of(&(up * -G));
    let mut text = format!("name = \"random {index}\"\ngravity_m_s2 = {gravity:?}\n[platform]\nmass_kg = {mass:?}\n");
    match inertia {
        Some(inertia) => {
            let com = position_of(&(rot.inverse() * com));
            writeln!(text, "inertia_kg_m2 = {inertia:?}\ncenter_of_mass_m = {com:?}").unwrap();
        }
        None => text.push_str("motion = \"point-mass\"\n"),
    }
    text
}

fn with_lengths(text: &str, lengths: &[f64]) -> String {
    let mut parts = text.split("[[cables]]\n");
    let mut whole = parts.next().unwrap_or_default().to_owned();
    for (part, length) in parts.zip(lengths) {
        write!(whole, "[[cables]]\nunstrained_length_m = {length:?}\n{part}").unwrap();
    }
    whole
}

/// Unstrained lengths with which the catenaries balance the platform at the pose, near the intended tensions.
fn balanced(robot: &Robot, pose: &Pose, cables: &[Fit]) -> Option<Vec<f64>> {
    let n = cables.len();
    let rows = robot.platform.motion.count();
    let radius = robot.platform_length();
    let up = robot.up_w();
    let mut columns = DMat::zeros(rows, n);
    let mut chords = Vec::with_capacity(n);
    for (i, cable) in robot.cables.iter().enumerate() {
        let lever = pose.rot_wp * cable.attachment_p;
        let chord = cable.anchor.reference_w() - pose.position_w - lever;
        columns.column_mut(i).copy_from(&wrench(&chord.normalize(), &lever, radius).rows(0, rows));
        chords.push(chord);
    }
    let inverse = inverse(&columns)?;
    let mut tensions: Vec<f64> = cables.iter().map(|cable| cable.tension).collect();
    let scale = tensions.iter().sum::<f64>();
    let mut last = f64::INFINITY;
    loop {
        let lengths: Vec<f64> = (0..n)
            .map(|i| {
                let rise = chords[i].dot(&up);
                let span = (chords[i] - up * rise).norm();
                let material = &robot.cables[i].material;
                length_for(span, rise, material.mass_per_length * G, material.axial_stiffness, tensions[i])
            })
            .collect();
        let left = statics::wrench(robot, pose, &lengths, StaticModel::Catenary).unwrap();
        let left = DMat::from_fn(rows, 1, |i, _| if i < 3 { left[i] } else { left[i] / radius });
        let size = left.amax() / scale;
        if size < 1e-14 || (size < 1e-11 && size > 0.5 * last) {
            return Some(lengths);
        }
        if size > 0.9 * last {
            return None;
        }
        last = size;
        // The direction of a cable's force hardly depends on its tension: about ten rounds are enough.
        let change = &inverse * left;
        for (tension, change) in tensions.iter_mut().zip(change.iter()) {
            *tension -= change;
        }
        if tensions.iter().zip(cables).any(|(tension, cable)| *tension < 0.5 * cable.tension) {
            return None;
        }
    }
}

/// Unstrained length at which a cable has a given tension along its chord; the tension falls as the length grows.
fn length_for(span: f64, rise: f64, weight_per_length: f64, axial_stiffness: f64, tension: f64) -> f64 {
    let chord = span.hypot(rise);
    let (mut low, mut high) = (0.5 * chord, 10.0 * chord);
    let mut length = chord;
    // Three to six steps are usual; the others are bisections at the limit of rounding.
    for _ in 0..100 {
        let rope = Rope { unstrained_length: length, weight_per_length, axial_stiffness };
        let cable = Catenary::between(span, rise, rope).unwrap();
        let (now, slope) = (cable.parallel_tension(), cable.parallel_tension_by_length());
        if now > tension {
            low = length;
        } else {
            high = length;
        }
        let next = length - (now - tension) / slope;
        if (next - length).abs() <= 2.0 * f64::EPSILON * chord {
            return next;
        }
        length = if next > low && next < high { next } else { 0.5 * (low + high) };
    }
    length
}

#[test]
fn a_number_always_gives_the_same_robot_with_the_sag_asked_for() {
    let (mut deep, mut taut) = (0, 0);
    for index in 0..60 {
        let one = sample(index);
        assert_eq!(one.text, sample(index).text);
        assert!((4..=12).contains(&one.robot.cables.len()));
        let State::Lengths(lengths) = &one.robot.state else { panic!("lengths") };
        assert_eq!(*lengths, one.lengths);
        if one.purpose == Purpose::Proper {
            let left = statics::wrench(&one.robot, &one.pose, &one.lengths, StaticModel::Catenary).unwrap();
            assert!(left.norm() < 1e-9 * one.robot.platform.mass * G * 100.0, "robot {index}: {left}");
        }
        deep += one.sag.iter().filter(|sag| **sag > 0.1).count();
        taut += one.sag.iter().filter(|sag| **sag < 0.03).count();
    }
    assert!(deep > 20 && taut > 100, "{deep} {taut}");
}
