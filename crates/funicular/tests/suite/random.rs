//! Random robots: those of property tests, and in `campaign` a suite over many robots and all modules.

pub(crate) mod campaign;

use funicular::math::Vec3;
use funicular::robot::{Robot, State};
use proptest::prelude::*;

/// Pseudo-random numbers from a seed (splitmix64).
pub(crate) struct Draw(pub(crate) u64);

impl Draw {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        bits ^= bits >> 31;
        (bits >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniformly distributed between two numbers.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// Uniformly distributed in the logarithm, between two powers of ten.
    pub(crate) fn decades(&mut self, low: f64, high: f64) -> f64 {
        10f64.powf(self.between(low, high))
    }

    /// Vector with three components up to a size.
    pub(crate) fn vector(&mut self, size: f64) -> [f64; 3] {
        std::array::from_fn(|_| size * self.between(-1.0, 1.0))
    }
}

/// Robots with 6 to 9 cables around and above (or also below) a platform, with lengths near those of a random pose.
pub(crate) fn any_robot() -> impl Strategy<Value = (Robot, Vec<f64>)> {
    let cable = (0.0f64..1.0, 0.6f64..1.4, 0.0f64..1.0, 0.05f64..0.5, -0.3f64..0.3, 0.985f64..1.02);
    let rope = (2.0f64..6.0, -3.0f64..0.0);
    (prop::collection::vec(cable, 6..=9), rope, 0.3f64..3.0, 0.0f64..0.4, any::<bool>()).prop_map(
        |(cables, (ea, m), mass, com, below)| {
            let mut text = format!(
                "name = \"random\"\n[platform]\nmass_kg = {}\ninertia_kg_m2 = [0.9, 1.0, 1.1]\n\
                 center_of_mass_m = [{}, {}, {}]\n[materials.rope]\naxial_stiffness_n = {}\nmass_kg_per_m = {}\n",
                10f64.powf(mass),
                0.3 * com,
                -0.2 * com,
                -com,
                10f64.powf(ea),
                10f64.powf(m),
            );
            let n = cables.len() as f64;
            for (i, (turn, out, height, radius, z, slack)) in cables.into_iter().enumerate() {
                let around = std::f64::consts::TAU * (i as f64 + 0.6 * turn) / n;
                let up = if below && i % 3 == 2 { -1.0 - 3.0 * height } else { 3.0 + 2.0 * height };
                let anchor = [6.0 * out * around.cos(), 5.0 * out * around.sin(), up];
                let inner = 2.7 * around;
                let attachment = [radius * inner.cos(), radius * inner.sin(), z];
                let chord = (Vec3::from(anchor) - Vec3::from(attachment)).norm();
                let cable = format!(
                    "[[cables]]\nname = \"{i}\"\nmaterial = \"rope\"\nanchor_m = {anchor:?}\nattachment_m = \
                     {attachment:?}\nunstrained_length_m = {}\n",
                    chord * slack
                );
                text.push_str(&cable);
            }
            let robot = Robot::from_toml(&text).unwrap();
            let State::Lengths(lengths) = robot.state.clone() else { unreachable!() };
            (robot, lengths)
        },
    )
}
