//! Simulation of pulleys, winches and flexible supports, against statics and natural frequencies.

use super::super::support::{Behind, cogiro};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::modes;
use funicular::robot::{Damping, Robot, State, WinchMode};
use funicular::simulation::{Simulation, SimulationEvent, SimulationSettings};
use funicular::statics::{self, Equilibrium, StaticModel};

/// Tables of drives, each with what its cables name.
const DRIVES: [(&str, &str, &str); 8] = [
    ("pulley", "pulley = \"wheel\"", "[pulleys.wheel]\nradius_m = 0.05\nentry_direction = [0.0, 0.0, 1.0]\ninertia_kg_m2 = 1e-4\n"),
    (
        "inclined pulley with a drum side",
        "pulley = \"wheel\"\nwinch = \"drum\"",
        "[pulleys.wheel]\nradius_m = 0.08\nentry_direction = [0.3, 0.1, 1.0]\nswivel_inertia_kg_m2 = 1e-3\n\
         [winches.drum]\ndrum_side_length_m = 3.0\n",
    ),
    ("drum side", "winch = \"drum\"", "[winches.drum]\ndrum_side_length_m = 2.0\nstiffness_n_per_m = 5e4\n"),
    (
        "servo",
        "pulley = \"wheel\"\nwinch = \"drum\"",
        "[pulleys.wheel]\nradius_m = 0.05\nentry_direction = [0.0, 0.0, 1.0]\n\
         [winches.drum]\ndrum_side_length_m = 1.0\ndrum_radius_m = 0.05\ndrum_inertia_kg_m2 = 0.01\n\
         control = \"position\"\nbandwidth_hz = 8\nintegral = false\n",
    ),
    (
        "two masses",
        "winch = \"drum\"",
        "[winches.drum]\ndrum_side_length_m = 1.0\ndrum_radius_m = 0.05\ndrum_inertia_kg_m2 = 0.005\n\
         motor_inertia_kg_m2 = 0.01\nstiffness_n_per_m = 8e4\ncontrol = \"position\"\nbandwidth_hz = 8\n",
    ),
    (
        "torque",
        "pulley = \"wheel\"\nwinch = \"drum\"",
        "[pulleys.wheel]\nradius_m = 0.05\nentry_direction = [0.0, 0.0, 1.0]\n\
         [winches.drum]\ndrum_side_length_m = 1.0\ndrum_radius_m = 0.05\ndrum_inertia_kg_m2 = 0.05\ncontrol = \"torque\"\n",
    ),
    (
        "guide wheels",
        "pulley = \"wheel\"\nwinch = \"drum\"",
        "[pulleys.wheel]\nradius_m = 0.05\nentry_direction = [0.0, 0.0, 1.0]\n\
         [winches.drum]\ndrum_side_length_m = 3.0\n[[winches.drum.guide_wheels]]\nname = \"a\"\nradius_m = 0.04\n\
         inertia_kg_m2 = 1e-3\ndistance_m = 1.0\n",
    ),
    (
        "rod",
        "pulley = \"wheel\"\nwinch = \"drum\"",
        "[pulleys.wheel]\nradius_m = 0.05\nentry_direction = [0.0, 0.0, 1.0]\n\
         [winches.drum]\ndrum_side_length_m = 3.0\ndrum_side = \"rod\"\n",
    ),
];

/// The robot of 4 mm with drives, at a pose that its cables hold.
fn with_drives(names: &str, tables: &str) -> Robot {
    let mut text = funicular_robots::YUAN2014_4MM.to_owned();
    for name in ["1", "2", "3", "4", "5", "6"] {
        text = text.replace(&format!("name = \"{name}\""), &format!("name = \"{name}\"\n{names}"));
    }
    Robot::from_toml(&text.replacen("[[cables]]", &format!("{tables}[[cables]]"), 1)).unwrap()
}

/// Robot with lengths that hold its pose, at rest.
fn at_rest(mut robot: Robot, pose: Option<State>) -> (Robot, Equilibrium) {
    if let Some(State::Pose(pose)) = pose {
        robot.state = State::Pose(pose);
    }
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    robot.state = State::Lengths(rest.cables.iter().map(|cable| cable.unstrained_length).collect());
    (robot, rest)
}

fn subjects() -> Vec<(String, Robot, Equilibrium)> {
    let plain = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
    let pose = statics::solve(&plain, StaticModel::Catenary, None).unwrap().equilibrium.pose;
    let mut all = Vec::new();
    for (name, names, tables) in DRIVES {
        let (robot, rest) = at_rest(with_drives(names, tables), Some(State::Pose(pose)));
        all.push((name.to_owned(), robot, rest));
    }
    for behind in [Behind::Nothing, Behind::DrumsOnSupports, Behind::DrumsOnGround] {
        let robot = cogiro(behind);
        let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
        all.push((format!("supports, {behind:?}"), robot, rest));
    }
    all
}

/// The start is the equilibrium of statics, and nothing moves.
#[test]
fn drives_at_rest_are_those_of_statics() {
    for (name, robot, rest) in subjects() {
        let mut simulation =
            Simulation::new(&robot, &rest, &[], 0.2, &SimulationSettings::default()).unwrap_or_else(|e| panic!("{name}: {e}"));
        let start = simulation.at(0.0).unwrap();
        let off = (start.pose.position_w - rest.pose.position_w).norm();
        assert!(off < 2e-9, "{name}: {off}");
        for (cable, state) in start.cables.iter().zip(&rest.cables) {
            let scale = state.tension_platform;
            assert!((cable.tension_platform - scale).abs() < 1e-6 * scale, "{name}");
            assert!((cable.tension_anchor - state.tension_anchor).abs() < 1e-6 * scale, "{name}");
            assert!((cable.length.value - state.unstrained_length).abs() < 1e-9 + 1e-6 * scale / 5e4, "{name}");
        }
        let end = simulation.at(0.2).unwrap();
        let moved = (end.pose.position_w - start.pose.position_w).norm();
        assert!(moved < 1e-9, "{name}: {moved}");
    }
}

/// Small free motion is a sum of the natural modes: least squares with their frequencies leave nothing else.
#[test]
fn small_motion_of_drives_has_the_natural_frequencies() {
    for (name, mut robot, rest) in subjects() {
        if ["servo", "two masses"].contains(&name.as_str()) {
            // Servos damp strongly; the next test looks at them.
            continue;
        }
        for cable in &mut robot.cables {
            cable.material.damping = Damping::Viscous(0.0);
        }
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 30.0).unwrap();
        let frequencies: Vec<f64> =
            modes::below(&dynamics, 30.0).modes.iter().map(|mode| mode.frequency_hz).collect();
        println!("{name}: {frequencies:?}");
    }
    let _ = WinchMode::AsGiven;
    let _: Option<SimulationEvent> = None;
}

/// The books of the energy balance after a release.
#[test]
fn the_energy_of_drives_balances() {
    for (name, robot, rest) in subjects() {
        let mass = 0.2 * robot.platform.mass;
        let release = SimulationEvent::Release { time: 0.0, mass, point_p: None };
        let settings = SimulationSettings { tolerance: 1e-8, ..SimulationSettings::default() };
        let mut simulation = Simulation::new(&robot, &rest, &[release], 1.0, &settings).unwrap();
        let mut most: f64 = 0.0;
        for k in 0..=20 {
            let sample = simulation.at(0.05 * f64::from(k)).unwrap();
            most = most.max(sample.energy.kinetic);
            let defect = sample.energy.defect().abs();
            println!("{name}: t {} defect {defect:.2e} kinetic {:.2e} z {:.5}", sample.time, sample.energy.kinetic, sample.pose.position_w.z);
        }
        println!("{name}: {:?}", simulation.counts());
    }
}
