//! Model of a hanging cable as a chain of equal straight elastic bars with its weight in the joints.
//!
//! A chain with the cable's own length and weight pulls at the platform with another force than the cable: its bars cut
//! corners, and its weight is concentrated in the joints. Both errors fall with the square of the number of bars, and
//! both can be corrected: the bars are shortened and the weight is changed (by about 1e-5 of it for twenty bars), so
//! that the force on the platform equals the force of the catenary.

use anyhow::{Result, bail};
use funicular::math::Vec3;
use funicular::robot::Robot;
use funicular::statics::Equilibrium;

/// Chain of bars that replaces a cable.
#[derive(Debug, Clone)]
pub(crate) struct Chain {
    /// Unstrained length of each bar [m].
    pub(crate) bar_length: f64,
    /// Ratio of the chain's weight (and other load along it) to the cable's.
    pub(crate) weight_factor: f64,
    /// Joints in equilibrium from the platform to the anchor, ends included, world axes [m].
    pub(crate) nodes_w: Vec<Vec3>,
    /// Tension of each bar in the same order [N].
    pub(crate) tensions: Vec<f64>,
}

/// Cable that a chain replaces.
struct HangingCable {
    chord_w: Vec3,
    /// Force on the platform [N].
    force_w: Vec3,
    /// Weight and any other load along the cable [N].
    weight_w: Vec3,
    axial_stiffness: f64,
}

impl Chain {
    /// Replaces cable `i` of a robot at equilibrium by a chain of `count` bars, or by one bar if the cable has no mass.
    ///
    /// # Errors
    /// A slack cable, because nothing keeps a chain of bars in its place.
    pub(crate) fn of(robot: &Robot, equilibrium: &Equilibrium, i: usize, count: usize) -> Result<Self> {
        let (cable, state) = (&robot.cables[i], &equilibrium.cables[i]);
        let mass = cable.material.mass_per_length * state.free_length();
        let weight_w = robot.line_load(i, &state.chord_w()).vector_w() * state.free_length();
        if mass == 0.0 && weight_w != Vec3::zeros() {
            bail!(
                "cable \"{}\" has a load but no mass: the joints of its bars need mass, so give its material a \
                 `mass_kg_per_m`",
                cable.name
            );
        }

        let count = if mass > 0.0 { count } else { 1 };
        let cable_data = HangingCable {
            chord_w: state.anchor_w - state.attachment_w,
            force_w: state.force_on_platform_w,
            weight_w,
            axial_stiffness: cable.material.axial_stiffness,
        };

        match cable_data.chain(state.attachment_w, count) {
            Some(chain) if !state.is_slack() => Ok(chain),
            _ => bail!(
                "cable \"{}\" is slack or hangs as a loop, and a chain of {count} bars cannot replace it: shorten it, \
                 or give another pose",
                cable.name
            ),
        }
    }
}

impl HangingCable {
    fn chain(&self, start_w: Vec3, count: usize) -> Option<Chain> {
        // Newton's method converges in a few steps; the limit only stops a search that finds nothing.
        const MAX_STEPS: usize = 50;
        let chord = self.chord_w.norm();
        let along = self.chord_w / chord;
        // Direction normal to the chord in which weight acts; zero for a vertical cable.
        let across = self.weight_w - along * along.dot(&self.weight_w);
        let across = across.try_normalize(1e-9 * self.weight_w.norm()).unwrap_or_default();

        let mut factor = 1.0;
        for _ in 0..MAX_STEPS {
            // Newton step for the weight factor: the chain's end has to lie on the chord.
            let (mut off, mut slope, mut scale) = (0.0, 0.0, 0.0);
            for (force, by_factor) in self.forces(factor, count) {
                let (compliance, part) = (self.compliance(&force), force.dot(&across));
                off += compliance * part;
                slope += compliance * by_factor.dot(&across) - part * force.dot(&by_factor) / force.norm().powi(3);
                scale += compliance * force.norm();
            }
            if slope == 0.0 || off.abs() <= 1e-15 * scale {
                break;
            }
            factor -= off / slope;
        }

        // Joints from the platform to the anchor.
        let steps: Vec<Vec3> = self.forces(factor, count).map(|(force, _)| force * self.compliance(&force)).collect();
        let bar_length = chord / steps.iter().sum::<Vec3>().dot(&along);
        let mut nodes_w = vec![start_w];
        for step in &steps[..count - 1] {
            nodes_w.push(nodes_w[nodes_w.len() - 1] + step * bar_length);
        }
        nodes_w.push(start_w + self.chord_w);

        let last = nodes_w[count - 1] + steps[count - 1] * bar_length;
        let ends_there = (last - nodes_w[count]).norm() <= 1e-9 * chord;
        (bar_length > 0.0 && bar_length.is_finite() && ends_there).then_some(Chain {
            bar_length,
            weight_factor: factor,
            nodes_w,
            tensions: self.forces(factor, count).map(|(force, _)| force.norm()).collect(),
        })
    }

    /// Force in each bar towards the anchor [N], and its derivative with respect to the weight factor. Half of a bar's
    /// weight acts at each of its ends.
    fn forces(&self, factor: f64, count: usize) -> impl Iterator<Item = (Vec3, Vec3)> {
        let per_bar = self.weight_w / count as f64;
        (0..count).map(move |i| {
            let by_factor = -per_bar * (i as f64 + 0.5);
            (self.force_w + by_factor * factor, by_factor)
        })
    }

    /// Length of a bar per unstrained length and force [1/N].
    fn compliance(&self, force: &Vec3) -> f64 {
        1.0 / force.norm() + 1.0 / self.axial_stiffness
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use funicular::statics::{self, StaticModel};

    fn rest() -> (Robot, Equilibrium) {
        let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
        let lengths = [6.863, 6.565, 6.756, 6.663, 6.801, 6.604];
        let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
        (robot, rest)
    }

    #[test]
    fn a_chain_begins_and_ends_where_its_cable_does_and_its_joints_are_near_it() {
        let (robot, rest) = rest();
        for (i, state) in rest.cables.iter().enumerate() {
            let chain = Chain::of(&robot, &rest, i, 20).unwrap();
            assert_eq!(chain.nodes_w.len(), 21);
            assert_eq!(chain.nodes_w[0], state.attachment_w);
            assert!((chain.nodes_w[20] - state.anchor_w).norm() < 1e-12);
            let hanging = state.hanging.as_ref().unwrap();
            for (k, node) in chain.nodes_w.iter().enumerate() {
                let point = hanging.point_w(state.free_length() * k as f64 / 20.0);
                assert!((node - point).norm() < 1e-3 * state.chord() / 20.0, "{k}");
            }
        }
    }

    #[test]
    fn the_shortening_of_bars_falls_with_the_square_of_their_number() {
        let (robot, rest) = rest();
        for (i, state) in rest.cables.iter().enumerate() {
            let less = |count: usize| {
                let chain = Chain::of(&robot, &rest, i, count).unwrap();
                state.free_length() - count as f64 * chain.bar_length
            };
            let weight = |count: usize| Chain::of(&robot, &rest, i, count).unwrap().weight_factor - 1.0;
            assert!(weight(20).abs() < 1e-3 && (weight(20) / weight(40) - 4.0).abs() < 0.01);
            let ratio = less(20) / less(40);
            assert!(less(20) > 0.0 && (ratio - 4.0).abs() < 0.01, "{ratio}");
        }
    }

    #[test]
    fn every_joint_of_a_chain_is_in_equilibrium() {
        let (robot, rest) = rest();
        for i in 0..6 {
            let chain = Chain::of(&robot, &rest, i, 7).unwrap();
            let material = &robot.cables[i].material;
            let force = |k: usize| {
                let bar = chain.nodes_w[k + 1] - chain.nodes_w[k];
                let strain = bar.norm() / chain.bar_length - 1.0;
                bar.normalize() * (material.axial_stiffness * strain)
            };
            let weight =
                robot.gravity_w * chain.weight_factor * (material.mass_per_length * rest.cables[i].free_length() / 7.0);
            let on_platform = force(0) + weight * 0.5;
            assert!((on_platform - rest.cables[i].force_on_platform_w).norm() < 1e-6, "{i}");
            for k in 1..7 {
                assert!((force(k) - force(k - 1) + weight).norm() < 1e-6, "{i} {k}");
            }
        }
    }

    #[test]
    fn a_vertical_cable_is_a_straight_chain() {
        let text = "name = \"v\"\n[platform]\nmass_kg = 2.0\nmotion = \"point-mass\"\n[materials.r]\n\
                    axial_stiffness_n = 1e4\n\
                    mass_kg_per_m = 0.1\n[[cables]]\nname = \"1\"\nmaterial = \"r\"\nanchor_m = [0.0, 0.0, 3.0]\n\
                    [[cables]]\nname = \"2\"\nmaterial = \"r\"\nanchor_m = [1.0, 0.0, 3.0]\n\
                    [[cables]]\nname = \"3\"\nmaterial = \"r\"\nanchor_m = [0.0, 1.0, 3.0]\n";
        let robot = Robot::from_toml(text).unwrap();
        let rest = statics::forward(&robot, &[2.0, 2.4, 2.4], StaticModel::Catenary, None).unwrap();
        let mut upright = rest.clone();
        let state = &mut upright.cables[0];
        (state.attachment_w.x, state.attachment_w.y) = (0.0, 0.0);
        state.force_on_platform_w = Vec3::new(0.0, 0.0, 19.0);
        let chain = Chain::of(&robot, &upright, 0, 5).unwrap();
        assert!(chain.nodes_w.iter().all(|node| node.x == 0.0 && node.y == 0.0));
        assert!(chain.nodes_w.windows(2).all(|pair| pair[1].z > pair[0].z));
    }
}
