//! Simulation of pulleys, winches and flexible supports, against statics and natural frequencies.

use super::super::support::{Behind, cogiro};
use super::small_motion::{Ring, rings_at_its_modes, swings_as_its_response};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::modes;
use funicular::robot::{Damping, Pose, Robot, State};
use funicular::simulation::{ElementMesh, Simulation, SimulationEvent, SimulationSettings};
use funicular::statics::{self, CableState, Equilibrium, StaticModel};

/// Tables of drives, each with what its cables name.
const DRIVES: [(&str, &str, &str); 16] = [
    (
        "pulley",
        "pulley = \"wheel\"",
        "[pulleys.wheel]\nradius_m = 0.05\nentry_direction = [0.0, 0.0, 1.0]\ninertia_kg_m2 = 1e-4\n",
    ),
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
         control = \"position\"\nbandwidth_hz = 8\nintegral_action = \"no\"\n",
    ),
    (
        "two masses",
        "winch = \"drum\"",
        "[winches.drum]\ndrum_side_length_m = 1.0\ndrum_radius_m = 0.05\ndrum_inertia_kg_m2 = 0.005\n\
         motor_inertia_kg_m2 = 0.01\nstiffness_n_per_m = 8e4\ncontrol = \"position\"\nbandwidth_hz = 8\n",
    ),
    (
        "delayed servo",
        "winch = \"drum\"",
        "[winches.drum]\ndrum_side_length_m = 1.0\ndrum_radius_m = 0.05\ndrum_inertia_kg_m2 = 0.01\n\
         control = \"position\"\nbandwidth_hz = 8\nintegral_action = \"no\"\ndelay_s = 0.003\n",
    ),
    (
        "torque",
        "pulley = \"wheel\"\nwinch = \"drum\"",
        "[pulleys.wheel]\nradius_m = 0.05\nentry_direction = [0.0, 0.0, 1.0]\n\
         [winches.drum]\ndrum_side_length_m = 1.0\ndrum_radius_m = 0.05\ndrum_inertia_kg_m2 = 0.05\n\
         control = \"torque\"\n",
    ),
    ("bare torque", "winch = \"drum\"", "[winches.drum]\ndrum_side_length_m = 0.0\ncontrol = \"torque\"\n"),
    (
        "position control, drum at the anchor",
        "winch = \"drum\"",
        "[winches.drum]\ndrum_radius_m = 0.05\ndrum_inertia_kg_m2 = 0.01\ncontrol = \"position\"\nbandwidth_hz = 8\n",
    ),
    (
        "position control on a shaft at the anchor",
        "winch = \"drum\"",
        "[winches.drum]\ndrum_radius_m = 0.05\ndrum_inertia_kg_m2 = 0.005\nmotor_inertia_kg_m2 = 0.01\n\
         stiffness_n_per_m = 8e4\ncontrol = \"position\"\nbandwidth_hz = 8\n",
    ),
    (
        "torque with its drum at the anchor",
        "winch = \"drum\"",
        "[winches.drum]\ndrum_radius_m = 0.05\ndrum_inertia_kg_m2 = 0.05\ncontrol = \"torque\"\n",
    ),
    (
        "shaft at the anchor",
        "winch = \"drum\"",
        "[winches.drum]\ndrum_radius_m = 0.05\ndrum_inertia_kg_m2 = 0.01\nstiffness_n_per_m = 5e4\n",
    ),
    (
        "bare torque behind a pulley",
        "pulley = \"wheel\"\nwinch = \"drum\"",
        "[pulleys.wheel]\nradius_m = 0.05\nentry_direction = [0.0, 0.0, 1.0]\n\
         [winches.drum]\ndrum_side_length_m = 1.0\ncontrol = \"torque\"\n",
    ),
    (
        "torque on a shaft",
        "winch = \"drum\"",
        "[winches.drum]\ndrum_side_length_m = 1.0\ndrum_radius_m = 0.05\ndrum_inertia_kg_m2 = 0.01\n\
         stiffness_n_per_m = 5e4\ncontrol = \"torque\"\n",
    ),
    (
        "guide wheels",
        "pulley = \"wheel\"\nwinch = \"drum\"",
        "[pulleys.wheel]\nradius_m = 0.05\nentry_direction = [0.0, 0.0, 1.0]\n\
         [winches.drum]\ndrum_side_length_m = 3.0\n[guide_wheels.a]\nwinch = \"drum\"\nradius_m = 0.04\n\
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

/// Robot with lengths that hold a pose, at rest.
fn at_rest(mut robot: Robot, pose: Pose) -> (Robot, Equilibrium) {
    robot.state = State::Pose(pose);
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    robot.state = State::Lengths(rest.cables.iter().map(|cable| cable.unstrained_length).collect());
    (robot, rest)
}

fn subjects() -> Vec<(String, Robot, Equilibrium)> {
    let plain = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
    let pose = statics::solve(&plain, StaticModel::Catenary, None).unwrap().equilibrium.pose;
    let mut all = Vec::new();
    let (robot, rest) = at_rest(plain, pose);
    all.push(("plain".to_owned(), robot, rest));
    for (name, names, tables) in DRIVES {
        let (robot, rest) = at_rest(with_drives(names, tables), pose);
        all.push((name.to_owned(), robot, rest));
    }
    for behind in [Behind::Nothing, Behind::DrumsOnSupports, Behind::DrumsOnGround] {
        let robot = cogiro(behind);
        let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
        all.push((format!("supports, {behind:?}"), robot, rest));
    }
    all
}

/// Drives whose winch has yielded at rest.
const YIELDING: [&str; 3] = ["servo", "delayed servo", "torque on a shaft"];

/// One rope that carries a mass, with every kind of drive, with and without a pulley, with one element and with many:
/// it begins at rest, and stays there.
#[test]
fn a_mass_on_one_rope_stays_at_rest_with_every_drive() {
    let text = |names: &str, tables: &str| {
        format!(
            "name = \"load\"\n[platform]\nmass_kg = 50.0\nmotion = \"point-mass\"\n[materials.rope]\n\
             axial_stiffness_n = 1e5\nmass_kg_per_m = 0.05\n{tables}[[cables]]\nname = \"1\"\n{names}\nmaterial = \
             \"rope\"\n\
             anchor_m = [0.0, 0.0, 5.0]\nunstrained_length_m = 7.0\n"
        )
    };
    for (name, names, tables) in DRIVES {
        let robot = Robot::from_toml(&text(names, tables)).unwrap_or_else(|e| panic!("{name}: {e}"));
        let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
        for (elements, degree) in [(1, 1), (1, 8), (3, 8), (20, 1)] {
            // One straight piece below a pulley turns with it, and nothing holds it there.
            if (elements, degree) == (1, 1) && names.contains("pulley") {
                continue;
            }
            let settings =
                SimulationSettings { mesh: ElementMesh { elements, degree }, ..SimulationSettings::default() };
            let mut simulation = Simulation::new(&robot, &rest, &[], 0.2, &settings)
                .unwrap_or_else(|e| panic!("{name}, {elements}, {degree}: {e}"));
            let [start, end] = [0.0, 0.2].map(|time| simulation.at(time).unwrap());
            let moved = (end.pose.position_w - start.pose.position_w).norm();
            let off = (start.pose.position_w - rest.pose.position_w).norm();
            assert!(moved < 1e-9 && off < 1e-6, "{name}, {elements} of degree {degree}: {moved:e} {off:e}");
            let tension = rest.cables[0].tension_anchor;
            assert!((end.cables[0].tension_anchor - tension).abs() < 1e-4 * tension, "{name}");
        }
    }
}

/// A winch that begins to hold the tension that it has changes nothing, whatever its drive.
#[test]
fn to_hold_the_present_tension_changes_nothing() {
    for (name, robot, rest) in subjects() {
        if name.starts_with("supports") {
            continue;
        }
        let tensions = rest.cables.iter().map(|cable| Some(cable.tension_drum())).collect();
        let hold = SimulationEvent::Tension { time: 0.05, duration: 0.05, tensions };
        let mut simulation = Simulation::new(&robot, &rest, &[hold], 0.2, &SimulationSettings::default()).unwrap();
        let [start, end] = [0.0, 0.2].map(|time| simulation.at(time).unwrap());
        let moved = (end.pose.position_w - start.pose.position_w).norm();
        assert!(moved < 1e-6, "{name}: {moved:e}");
    }
}

/// The start is the equilibrium of statics, and nothing moves.
#[test]
fn drives_at_rest_are_those_of_statics() {
    for (name, robot, rest) in subjects() {
        let mut simulation = Simulation::new(&robot, &rest, &[], 0.2, &SimulationSettings::default())
            .unwrap_or_else(|e| panic!("{name}: {e}"));
        let start = simulation.at(0.0).unwrap();
        let off = (start.pose.position_w - rest.pose.position_w).norm();
        assert!(off < 2e-9, "{name}: {off}");
        for (cable, state) in start.cables.iter().zip(&rest.cables) {
            let scale = state.tension_platform;
            assert!((cable.tension_platform - scale).abs() < 1e-6 * scale, "{name}");
            assert!((cable.tension_anchor - state.tension_anchor).abs() < 1e-6 * scale, "{name}");
            // A servo without integral action has paid out what it yields, and a motor with constant torque pulls a
            // drum that is behind its shaft.
            let yielded = state.drive.as_ref().filter(|_| YIELDING.contains(&name.as_str()));
            let paid_out = yielded.map_or(0.0, |drive| {
                drive.winch_yield / (1.0 + drive.tension_drum / robot.cables[0].material.axial_stiffness)
            });
            let off = cable.length.value - state.unstrained_length - paid_out;
            assert!(off.abs() < 1e-9 + 1e-5 * paid_out, "{name}: {off}");
        }
        let end = simulation.at(0.2).unwrap();
        let moved = (end.pose.position_w - start.pose.position_w).norm();
        assert!(moved < 1e-9, "{name}: {moved}");
    }
}

/// Robots that are rung, one of each kind of drive: with the size of the push, the number of cycles and the tolerance.
/// The robot on supports is eight times as heavy and stiff: a push as small as that of the others would drown in
/// rounding.
const RINGING: [(&str, f64, f64, f64); 6] = [
    ("pulley", 1.0, 60.0, 1e-12),
    ("inclined pulley with a drum side", 1.0, 60.0, 1e-12),
    ("torque on a shaft", 1.0, 60.0, 1e-12),
    ("guide wheels", 1.0, 60.0, 1e-12),
    ("supports, DrumsOnSupports", 300.0, 30.0, 1e-11),
    ("supports, DrumsOnGround", 300.0, 30.0, 1e-11),
];

/// A small push rings down at the natural frequencies of the program.
#[test]
fn a_small_push_rings_at_the_modes_of_drives() {
    for (name, mut robot, rest) in subjects() {
        let Some((_, size, cycles, tolerance)) = RINGING.into_iter().find(|of| of.0 == name) else { continue };
        for cable in &mut robot.cables {
            cable.material.damping = Damping::Viscous(0.01);
        }
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 8.0).unwrap();
        let first_hz = modes::below(&dynamics, 8.0).modes[0].frequency_hz;
        let of = Ring { cycles, tolerance, off: 2e-6, part: 0.03, least: 2, books: 1e-4 };
        let (force_w, moment_w) = (Vec3::new(4e-2, 3e-2, 6e-2), Vec3::new(6e-3, 8e-3, 8e-3));
        rings_at_its_modes(&(robot, rest), first_hz, force_w * size, moment_w * size, &of);
    }
}

/// Servos, one with a delay, follow a swing of their command as the frequency response says, in which a delay is exact.
/// There the rope that a winch pays out has the stretch of its present tension, here that with which it was wound: the
/// responses differ by the strain, which is a tenth of the usual one on these ropes.
#[test]
fn servos_follow_a_swing_as_their_frequency_response() {
    for (name, mut robot, rest) in subjects() {
        if !name.contains("servo") {
            continue;
        }
        for cable in &mut robot.cables {
            cable.material.axial_stiffness *= 10.0;
        }
        let (robot, rest) = at_rest(robot, rest.pose);
        let strain = |cable: &CableState| cable.tension_anchor / robot.cables[0].material.axial_stiffness;
        let most = rest.cables.iter().map(strain).fold(0.0, f64::max);
        swings_as_its_response(robot, 5e-6 + most);
    }
}

/// The books of the energy balance after a release; on a robot without drives they are as far off.
#[test]
fn the_energy_of_drives_balances() {
    for (name, robot, rest) in subjects() {
        let mass = 0.02 * robot.platform.mass;
        let release = SimulationEvent::Release { time: 0.0, mass, point_p: None };
        let settings = SimulationSettings { tolerance: 1e-8, ..SimulationSettings::default() };
        let mut simulation = Simulation::new(&robot, &rest, &[release], 0.5, &settings).unwrap();
        let (mut most, mut defect) = (0.0_f64, 0.0_f64);
        for k in 1..=20 {
            let sample = simulation.at(0.025 * f64::from(k)).unwrap();
            most = most.max(sample.energy.kinetic);
            defect = defect.max(sample.energy.defect().abs());
        }
        assert!(defect < 0.01 * most, "{name}: {defect:e} of {most:e}");
    }
}

/// A robot whose motion dies away.
fn damped(robot: &mut Robot) {
    for cable in &mut robot.cables {
        cable.material.damping = Damping::Viscous(0.5);
        cable.material.stretch_loss.time = 1e-3;
    }
    robot.platform.translational_damping_p = Vec3::repeat(60.0);
    robot.platform.rotational_damping_p = Vec3::repeat(3.0);
}

/// After long moves of the winches, over which the wheels roll, the robot comes to rest where statics has it.
#[test]
fn after_a_move_the_robot_rests_where_statics_has_it() {
    for (name, mut robot, rest) in subjects() {
        if ["torque", "position control"].iter().any(|of| name.contains(of))
            || ["servo", "two masses"].contains(&name.as_str())
        {
            // Their lengths are not those of the command, or not before a slow integral has acted.
            continue;
        }
        damped(&mut robot);
        let changes: Vec<f64> = (0..robot.cables.len()).map(|i| [-0.10, -0.06, -0.08][i % 3]).collect();
        let ramp = SimulationEvent::Ramp { time: 0.0, duration: 2.0, changes: changes.clone() };
        let settings = SimulationSettings { tolerance: 1e-6, ..SimulationSettings::default() };
        let mut simulation = Simulation::new(&robot, &rest, &[ramp], 30.0, &settings).unwrap();
        let end = simulation.at(30.0).unwrap();

        let lengths = rest.cables.iter().zip(changes).map(|(cable, change)| cable.unstrained_length + change).collect();
        robot.state = State::Lengths(lengths);
        let after = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
        let off = (end.pose.position_w - after.pose.position_w).norm();
        assert!((after.pose.position_w - rest.pose.position_w).norm() > 0.02, "{name}");
        assert!(off < 1e-5, "{name}: {off:e}");
    }
}

/// A winch that holds a tension holds it, also while the platform moves, and its books balance. At the exit point the
/// tension differs from that at the drum by the waves of the rope and by its weight on the wheel, together below 2 %.
#[test]
fn winches_hold_tensions() {
    for (name, robot, rest) in subjects().into_iter().take(2) {
        let tension = 1.1 * rest.cables[1].tension_drum();
        let mut tensions = vec![None; robot.cables.len()];
        tensions[1] = Some(tension);
        let hold = SimulationEvent::Tension { time: 0.4, duration: 0.3, tensions };
        // The length of the same winch is commanded before.
        let mut changes = vec![0.0; robot.cables.len()];
        changes[1] = -2e-3;
        let ramp = SimulationEvent::Ramp { time: 0.0, duration: 0.3, changes };
        let settings = SimulationSettings { tolerance: 1e-8, ..SimulationSettings::default() };
        let mut simulation = Simulation::new(&robot, &rest, &[ramp, hold], 1.5, &settings).unwrap();
        let moved = simulation.at(0.35).unwrap().energy;
        assert!(moved.winches > 0.01 && moved.defect().abs() < 0.01 * moved.winches, "{name}: {moved:?}");
        let mut pulled_in: f64 = 0.0;
        for k in 15..=30 {
            let sample = simulation.at(0.05 * f64::from(k)).unwrap();
            let at_anchor = sample.cables[1].tension_anchor;
            assert!((at_anchor / tension - 1.0).abs() < 0.02, "{name}: {at_anchor} of {tension}");
            pulled_in = rest.cables[1].unstrained_length - sample.cables[1].length.value;
            let (defect, work) = (sample.energy.defect(), sample.energy.winches);
            assert!(defect.abs() < 0.01 * work.abs(), "{name}: {defect:e} of {work:e}");
        }
        assert!(pulled_in > 1e-3, "{name}: {pulled_in}");
    }
}
