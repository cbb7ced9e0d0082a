//! Equilibria, one file per topic as in the sources, and robots shared by several of them.

mod capacity;
mod energy;
mod equilibria;
mod forward;
mod free_motion;
mod friction;
mod ideal;
mod inverse;
mod nearest_pose;
mod residual;
mod solve;
mod stiffness;
mod tension;
mod tension_gain;

use funicular::robot::{Robot, State};

const YUAN_4MM: &str = funicular_robots::YUAN2014_4MM;
const YUAN_8MM: &str = funicular_robots::YUAN2014_8MM;
const COGIRO: &str = funicular_robots::COGIRO;

fn load(text: &str) -> (Robot, Vec<f64>) {
    let robot = Robot::from_toml(text).unwrap();
    let State::Lengths(lengths) = robot.state.clone() else { panic!("given by lengths") };
    (robot, lengths)
}

/// Platform of a crane, 1 m by 0.6 m by 0.2 m, on `cables` of four cables to the corners of a hall.
pub(crate) fn crane(cables: usize, rope_mass: f64) -> Robot {
    let mut text = format!(
        "name = \"crane\"\n[platform]\nmass_kg = 60\ninertia_kg_m2 = [2.0, 5.2, 6.8]\ncenter_of_mass_m = [0.03, -0.02, \
         -0.1]\n\
         [materials.rope]\naxial_stiffness_n = 4e5\nmass_kg_per_m = {rope_mass}\n"
    );
    for (i, (x, y)) in [(1.0, 1.0), (-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0)].into_iter().enumerate().take(cables) {
        let cable = format!(
            "[[cables]]\nname = \"{i}\"\nmaterial = \"rope\"\nanchor_m = [{}, {}, 5.0]\nattachment_m = [{}, {}, 0.1]\n",
            4.0 * x,
            3.0 * y,
            0.5 * x,
            0.3 * y
        );
        text.push_str(&cable);
    }
    Robot::from_toml(&text).unwrap()
}
