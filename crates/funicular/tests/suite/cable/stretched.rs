//! Rope with a large strain: without weight every model is the spring EA/L₀, and its string has the mass of the rope.

use funicular::cable::CableModel;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::modes;
use funicular::robot::{Damping, Robot};
use funicular::statics::{self, Equilibrium, StaticModel};
use std::f64::consts::TAU;

/// Point mass of 1 kg on a rope of 1 m.
fn tendon(axial_stiffness: f64, mass_per_length: f64) -> Robot {
    let text = format!(
        "name = \"tendon\"\n[platform]\nmass_kg = 1.0\nmotion = \"point-mass\"\n[materials.rope]\n\
         axial_stiffness_n = {axial_stiffness:?}\nmass_kg_per_m = {mass_per_length:?}\n[[cables]]\nname = \"1\"\n\
         material = \"rope\"\nanchor_m = [0.0, 0.0, 2.0]\n"
    );
    Robot::from_toml(&text).unwrap()
}

fn linearised(robot: &Robot, rest: &Equilibrium, cable_model: CableModel, limit_hz: f64) -> Dynamics {
    Dynamics::about(robot, rest, Linearisation { cable_model, ..Default::default() }, limit_hz).unwrap()
}

#[test]
fn without_weight_all_models_are_the_spring() {
    // Strains of 1 % and 10 %.
    for axial_stiffness in [1000.0, 100.0] {
        let robot = tendon(axial_stiffness, 0.0);
        for static_model in [StaticModel::Spring, StaticModel::Catenary] {
            let rest = statics::forward(&robot, &[1.0], static_model, None).unwrap();
            for cable_model in CableModel::ALL {
                let dynamics = linearised(&robot, &rest, cable_model, 20.0);
                let stiffness = dynamics.stiffness(TAU)[(2, 2)].re;
                assert!((stiffness / axial_stiffness - 1.0).abs() < 1e-12, "{cable_model}: {stiffness}");

                // 5.03292 Hz and 1.59155 Hz.
                let exact = axial_stiffness.sqrt() / TAU;
                let found = modes::below(&dynamics, 20.0).modes;
                let bounce = found.last().unwrap().frequency_hz;
                assert!((bounce / exact - 1.0).abs() < 1e-10, "{cable_model}: {bounce}");
            }
        }
    }
}

#[test]
fn a_stretched_string_has_the_mass_of_its_rope() {
    // Without gravity the string is straight. A strain of one half: 28.9 Hz, below the axial waves from 50 Hz on.
    let mut robot = tendon(100.0, 0.01);
    robot.gravity_w = Vec3::zeros();
    robot.load.force_w = Vec3::new(0.0, 0.0, -50.0);
    robot.cables[0].material.damping = Damping::Viscous(0.05);
    let rest = statics::forward(&robot, &[1.0], StaticModel::Catenary, None).unwrap();
    assert!((rest.cables[0].chord() - 1.5).abs() < 1e-9);

    let of = |cable_model: CableModel| modes::below(&linearised(&robot, &rest, cable_model, 40.0), 40.0).modes;
    let (shallow, exact) = (of(CableModel::ShallowDynamic), of(CableModel::CatenaryDynamic));
    assert_eq!((shallow.len(), exact.len()), (5, 5));
    for (k, (shallow, exact)) in shallow.iter().zip(&exact).enumerate() {
        // The third bounces; the shallow model leaves out a third of the rope's mass of 1 %.
        let tolerance = if k == 2 { 2e-3 } else { 1e-9 };
        let difference = shallow.frequency_hz / exact.frequency_hz - 1.0;
        assert!(difference.abs() < tolerance, "{k}: {} {}", shallow.frequency_hz, exact.frequency_hz);
        if k != 2 {
            let difference = shallow.damping_ratio / exact.damping_ratio - 1.0;
            assert!(difference.abs() < 1e-8, "{k}: {} {}", shallow.damping_ratio, exact.damping_ratio);
        }
    }
}
