//! Simulation: histories of independent methods, closed forms, orders of convergence, books of the energy.

mod anchors;
mod drives;
mod parted;
mod scenarios;
mod small_motion;
mod stepping;

use funicular::math::{Mat3, Vec3};
use funicular::robot::{Damping, Robot, State};
use funicular::simulation::{CutAt, ElementMesh, Simulation, SimulationEvent, SimulationSettings};
use funicular::statics::{self, Equilibrium, StaticModel};
use serde_json::Value;

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

fn vector(value: &Value) -> Vec3 {
    Vec3::from_column_slice(&numbers(value))
}

/// Case of reference/time_histories.json.
fn case(id: &str) -> Value {
    let all: Value =
        serde_json::from_str(include_str!("../../../funicular-validation/reference/time_histories.json")).unwrap();
    all["cases"].as_array().unwrap().iter().find(|case| case["id"] == id).unwrap().clone()
}

/// Robot of a case before its release, at rest, and the settings of its ropes.
fn robot_of(case: &Value) -> (Robot, Equilibrium, SimulationSettings) {
    let mut robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
    robot.gravity_w = vector(&case["gravity_m_s2"]);
    robot.platform.mass = case["platform"]["mass_before_kg"].as_f64().unwrap();
    let inertia: Vec<f64> = case["platform"]["inertia_kg_m2"].as_array().unwrap().iter().flat_map(numbers).collect();
    robot.platform.inertia_p = Mat3::from_row_slice(&inertia);
    let mut lengths = Vec::new();
    for (cable, of) in robot.cables.iter_mut().zip(case["cables"].as_array().unwrap()) {
        cable.anchor.point_w = vector(&of["anchor_m"]);
        cable.attachment_p = vector(&of["attachment_m"]);
        cable.material.axial_stiffness = of["axial_stiffness_n"].as_f64().unwrap();
        cable.material.mass_per_length = of["mass_kg_per_m"].as_f64().unwrap();
        cable.material.damping = Damping::Viscous(case["cv_n_s_m2"].as_f64().unwrap());
        cable.material.stretch_loss.time = case["tau_s"].as_f64().unwrap();
        lengths.push(of["unstrained_length_m"].as_f64().unwrap());
    }
    robot.state = State::Lengths(lengths);
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    (robot, rest, SimulationSettings::default())
}

fn release_of(case: &Value) -> Vec<SimulationEvent> {
    let mass = |key: &str| case["platform"][key].as_f64().unwrap();
    let lost = mass("mass_before_kg") - mass("mass_after_kg");
    if lost > 0.0 { vec![SimulationEvent::Release { time: 0.0, mass: lost, point_p: None }] } else { Vec::new() }
}

fn ramp_of(case: &Value) -> SimulationEvent {
    let rows: Vec<Vec<f64>> = case["length_ramps"]["t0_t1_dl"].as_array().unwrap().iter().map(numbers).collect();
    let changes = rows.iter().map(|row| row[2]).collect();
    SimulationEvent::Ramp { time: rows[0][0], duration: rows[0][1] - rows[0][0], changes }
}

/// Largest differences from the samples of a case, over their bounds: positions, tensions.
fn compare(case: &Value, simulation: &mut Simulation, until: f64) -> [f64; 2] {
    let mut worst = [0.0_f64; 2];
    for sample in case["samples"].as_array().unwrap() {
        let time = sample["t_s"].as_f64().unwrap();
        if time > until {
            break;
        }
        let found = simulation.at(time).unwrap();
        let position = (found.pose.position_w - vector(&sample["position_m"])).norm();
        worst[0] = worst[0].max(position / sample["bound_position_m"].as_f64().unwrap());
        let (tensions, bounds) = (numbers(&sample["tension_platform_n"]), numbers(&sample["bound_tension_n"]));
        for ((cable, tension), bound) in found.cables.iter().zip(tensions).zip(bounds) {
            worst[1] = worst[1].max((cable.tension_platform - tension).abs() / bound);
        }
    }
    worst
}

/// A simulation that is restored in the middle of an event-rich run goes on with the same bits.
#[test]
fn a_restored_simulation_goes_on_exactly() {
    let mut robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
    robot.platform.mass = 12.5;
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let events = [
        SimulationEvent::Release { time: 0.05, mass: 1.0, point_p: None },
        SimulationEvent::Ramp { time: 0.02, duration: 0.2, changes: vec![-0.01, 0.0, 0.0, 0.0, 0.0, 0.0] },
        SimulationEvent::Cut { cable: 1, at: CutAt::Time(0.1), place: 2.5 },
        SimulationEvent::Cut { cable: 2, at: CutAt::Tension(80.0), place: 0.0 },
    ];
    let settings = SimulationSettings { tolerance: 1e-6, ..SimulationSettings::default() };
    let new = || Simulation::new(&robot, &rest, &events, 0.3, &settings).unwrap();
    for stop in [0.03, 0.07, 0.12, 0.2] {
        let (mut first, mut second) = (new(), new());
        first.at(stop).unwrap();
        let state = first.state();
        assert!(second.restore(&state));
        for time in [stop + 1e-4, stop + 0.03, 0.3] {
            assert_eq!(first.at(time).unwrap(), second.at(time).unwrap(), "{stop} {time}");
        }
        assert_eq!((first.cuts(), first.slack(), first.counts()), (second.cuts(), second.slack(), second.counts()));
        assert!(!new().restore(&state[1..]));
    }
}

/// A payload is released and all cables stay taut.
#[test]
fn a_taut_release_is_that_of_two_independent_methods() {
    let case = case("release-taut-4mm");
    let (robot, rest, mut settings) = robot_of(&case);
    settings.mesh = ElementMesh { elements: 6, degree: 10 };
    settings.tolerance = 3e-10;
    let mut simulation = Simulation::new(&robot, &rest, &release_of(&case), 1.0, &settings).unwrap();
    let worst = compare(&case, &mut simulation, 1.0);
    assert!(worst[0] < 1.0 && worst[1] < 1.0, "{worst:?}");
    assert!(simulation.slack().iter().all(|cable| cable.first.is_none()));
}

/// All winches change their lengths.
#[test]
fn a_move_of_winches_is_that_of_a_chain_of_material_nodes() {
    let case = case("winch-4mm");
    let (robot, rest, mut settings) = robot_of(&case);
    settings.mesh = ElementMesh { elements: 6, degree: 8 };
    settings.tolerance = 1e-8;
    let mut simulation = Simulation::new(&robot, &rest, &[ramp_of(&case)], 2.0, &settings).unwrap();
    let worst = compare(&case, &mut simulation, 2.0);
    assert!(worst[0] < 1.0 && worst[1] < 1.0, "{worst:?}");
    assert!(simulation.at(2.0).unwrap().energy.defect().abs() < 2e-4);
}

/// The platform flies and all cables go slack; times and top of the flight are those of two methods.
#[test]
fn a_release_with_slack_cables_is_right_until_they_are_taut_again() {
    let case = case("release-slack-4mm");
    let (robot, rest, settings) = robot_of(&case);
    let mut simulation = Simulation::new(&robot, &rest, &release_of(&case), 0.2, &settings).unwrap();
    let slack = &case["slack"];
    let top = (0..30)
        .map(|k| simulation.at(0.11 + 1e-3 * f64::from(k)).unwrap().pose.position_w.z)
        .fold(f64::NEG_INFINITY, f64::max);
    assert!(
        (top - slack["top_of_flight_z_m"].as_f64().unwrap()).abs() < slack["top_of_flight_bound_m"].as_f64().unwrap()
    );
    for (cable, first) in simulation.slack().iter().zip(numbers(&slack["first_below_half_newton_s"])) {
        let bound = slack["first_slack_bound_s"].as_f64().unwrap();
        assert!((cable.first.unwrap() - first).abs() < bound, "{cable:?} {first}");
    }
}

/// A point mass on one rope without mass: an elastic pendulum, against its equation of motion by small steps.
#[test]
fn a_mass_on_a_light_rope_is_an_elastic_pendulum() {
    let robot = pendulum(0.0);
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let push = SimulationEvent::Push {
        time: 0.0,
        duration: 0.4,
        rise: 0.1,
        force_w: Vec3::new(30.0, 0.0, 0.0),
        moment_w: Vec3::zeros(),
        point_p: Vec3::zeros(),
    };
    let settings = SimulationSettings { tolerance: 1e-10, ..SimulationSettings::default() };
    let mut simulation = Simulation::new(&robot, &rest, &[push], 3.0, &settings).unwrap();

    let smooth = |x: f64| {
        let x = x.clamp(0.0, 1.0);
        x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x)
    };
    let force = |time: f64| 30.0 * smooth(time / 0.1).min(smooth((0.4 - time) / 0.1));
    let rate = |time: f64, y: &[f64; 4]| {
        let (x, z) = (y[0], y[1] - 5.0);
        let length = x.hypot(z);
        let tension = 2000.0 * (length / 4.0 - 1.0).max(0.0);
        [y[2], y[3], (force(time) - tension * x / length) / 5.0, -tension * z / length / 5.0 - 9.81]
    };
    let mut y = [rest.pose.position_w.x, rest.pose.position_w.z, 0.0, 0.0];
    let h = 1e-4;
    for step in 0..30000 {
        let time = f64::from(step) * h;
        let plus = |y: &[f64; 4], k: &[f64; 4], h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
        let k1 = rate(time, &y);
        let k2 = rate(time + 0.5 * h, &plus(&y, &k1, 0.5 * h));
        let k3 = rate(time + 0.5 * h, &plus(&y, &k2, 0.5 * h));
        let k4 = rate(time + h, &plus(&y, &k3, h));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    let found = simulation.at(3.0).unwrap();
    let off = (found.pose.position_w.x - y[0]).hypot(found.pose.position_w.z - y[1]);
    assert!(off < 1e-7, "{off}");
    assert!(found.energy.defect().abs() < 1e-6, "{}", found.energy.defect());
}

/// Point mass on one rope of a mass per length.
fn pendulum(mass_per_length: f64) -> Robot {
    let text = format!(
        "name = \"pendulum\"\nsource = \"test\"\n[platform]\nmotion = \"point-mass\"\nmass_kg = 5.0\n\
         [materials.rope]\naxial_stiffness_n = 2000.0\nmass_kg_per_m = {mass_per_length}\ndamping_ratio = 0.0\n\
         [[cables]]\nname = \"1\"\nmaterial = \"rope\"\nanchor_m = [0.0, 0.0, 5.0]\nattachment_m = [0.0, 0.0, 0.0]\n\
         unstrained_length_m = 4.0\n"
    );
    Robot::from_toml(&text).unwrap()
}

/// Hoisting on a heavy rope: the tension is that of the masses that are accelerated; momentum that passes the anchor is
/// part of it.
#[test]
fn a_hoisted_mass_has_the_tension_of_its_acceleration() {
    let mut robot = pendulum(1.0);
    robot.cables[0].material.axial_stiffness = 1e6;
    robot.cables[0].material.stretch_loss.time = 1e-3;
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let ramp = SimulationEvent::Ramp { time: 0.0, duration: 2.0, changes: vec![-2.0] };
    let mut simulation = Simulation::new(&robot, &rest, &[ramp], 2.5, &SimulationSettings::default()).unwrap();
    for k in 1..20 {
        let found = simulation.at(0.1 * f64::from(k)).unwrap();
        let cable = found.cables[0];
        let (length, acceleration) = (cable.length.value, 9.81 - cable.length.acceleration);
        assert!((cable.tension_anchor / ((5.0 + length) * acceleration) - 1.0).abs() < 0.02, "{k} {cable:?}");
        assert!((cable.tension_platform / (5.0 * acceleration) - 1.0).abs() < 0.03, "{k} {cable:?}");
    }
    let books = simulation.at(2.5).unwrap().energy;
    assert!(books.winches > 50.0 && books.defect().abs() < 1e-3 * books.winches, "{books:?}");
}

/// Errors of the position after a release fall with the fourth power of the step, and with a high power of the mesh.
#[test]
fn errors_fall_with_the_order_of_the_method() {
    let case = case("release-taut-4mm");
    let (robot, rest, settings) = robot_of(&case);
    let run = |mesh: ElementMesh, tolerance: f64| {
        let settings = SimulationSettings { mesh, tolerance, ..settings.clone() };
        let mut simulation = Simulation::new(&robot, &rest, &release_of(&case), 0.5, &settings).unwrap();
        let position = simulation.at(0.5).unwrap().pose.position_w;
        (position, simulation.counts().accepted as f64)
    };
    let coarse = ElementMesh { elements: 2, degree: 4 };
    let exact = run(coarse, 1e-12).0;
    let [(first, few), (second, many)] = [1e-7, 1e-10].map(|tolerance| run(coarse, tolerance));
    let order = ((first - exact).norm() / (second - exact).norm()).ln() / (many / few).ln();
    assert!(order > 3.5, "order {order}, steps {few} and {many}");
}

/// Errors of the position after a smooth move fall with a high power of the mesh.
#[test]
fn errors_of_a_smooth_move_fall_fast_with_the_mesh() {
    let case = case("winch-4mm");
    let (robot, rest, settings) = robot_of(&case);
    let run = |elements, degree| {
        let settings =
            SimulationSettings { mesh: ElementMesh { elements, degree }, tolerance: 1e-9, ..settings.clone() };
        let mut simulation = Simulation::new(&robot, &rest, &[ramp_of(&case)], 1.0, &settings).unwrap();
        simulation.at(1.0).unwrap().pose.position_w
    };
    let exact = run(12, 4);
    let off = [1, 2, 4, 8].map(|elements| (run(elements, 2) - exact).norm());
    assert!(off.windows(2).all(|pair| pair[0] > 8.0 * pair[1]), "{off:?}");
}

/// A cable fails when its tension reaches a value; the last cable cannot be cut.
#[test]
fn a_cable_fails_at_its_tension() {
    let case = case("release-taut-4mm");
    let (robot, rest, settings) = robot_of(&case);
    let cut = |cable, at| SimulationEvent::Cut { cable, at, place: 0.0 };
    let events = [cut(0, CutAt::Time(0.1)), cut(2, CutAt::Tension(52.0))];
    let mut simulation = Simulation::new(&robot, &rest, &events, 0.4, &settings).unwrap();
    let found = simulation.at(0.4).unwrap();
    assert_eq!(simulation.cuts().iter().map(|cut| cut.0).collect::<Vec<_>>(), [0, 2]);
    assert!(simulation.cuts()[1].1 > 0.1 && found.cables[0].is_cut && found.cables[2].is_cut);
    // No energy comes from nowhere, and only damping takes some.
    assert!(found.energy.defect().abs() < 1e-2 * found.energy.kinetic, "{:?}", found.energy);

    let all: Vec<_> = (0..6).map(|cable| cut(cable, CutAt::Time(0.1))).collect();
    let error = Simulation::new(&robot, &rest, &all, 0.4, &settings).err().unwrap().to_string();
    assert!(error.contains("last one that holds"), "{error}");
}

/// A payload that is picked up at rest takes part of the momentum; nothing else changes at once.
#[test]
fn a_pick_up_keeps_the_momentum() {
    let robot = pendulum(0.0);
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let push = SimulationEvent::Push {
        time: 0.0,
        duration: 0.3,
        rise: 0.1,
        force_w: Vec3::new(20.0, 0.0, 0.0),
        moment_w: Vec3::zeros(),
        point_p: Vec3::zeros(),
    };
    let pick = SimulationEvent::Pick { time: 0.3, mass: 3.0, point_p: None, velocity_w: Some(Vec3::zeros()) };
    let settings = SimulationSettings::default();
    let mut simulation = Simulation::new(&robot, &rest, &[push, pick], 1.0, &settings).unwrap();
    let before = simulation.at(0.3 - 1e-9).unwrap().velocity_w;
    let after = simulation.at(0.3).unwrap().velocity_w;
    assert!((before * 5.0 - after * 8.0).norm() < 1e-5 * before.norm(), "{before} {after}");
    assert!(simulation.at(1.0).unwrap().energy.defect().abs() < 1e-5);
}
