//! Cables that fail at a place: both halves beside ropes of their own, symmetry, waves, books of the energy.

use super::pendulum;
use funicular::math::Vec3;
use funicular::robot::{Load, Robot, State};
use funicular::simulation::{CutAt, Simulation, SimulationEvent, SimulationSettings};
use funicular::statics::{self, Equilibrium, StaticModel};

fn at_rest(robot: &Robot) -> Equilibrium {
    statics::solve(robot, StaticModel::Catenary, None).unwrap().equilibrium
}

fn cut(cable: usize, time: f64, place: f64) -> SimulationEvent {
    SimulationEvent::Cut { cable, at: CutAt::Time(time), place }
}

fn held() -> SimulationSettings {
    SimulationSettings { platform_is_held: true, ..SimulationSettings::default() }
}

/// Rope that sags, and a stiff one that holds what the first one leaves.
fn sagging() -> Robot {
    let mut robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
    for cable in &mut robot.cables {
        cable.material.mass_per_length = 0.5;
        cable.material.stretch_loss.time = 1e-3;
    }
    robot.state = State::Lengths(at_rest(&robot).cables.iter().map(|cable| cable.unstrained_length).collect());
    robot
}

/// The half at the anchor knows nothing of the other half. It moves as a shorter rope that ends at the place of the
/// failure on a held platform and is cut there; a load stands for the weight of the rope that this robot lacks.
#[test]
fn the_half_at_the_anchor_moves_as_a_shorter_rope_that_is_cut_at_its_end() {
    const CABLE: usize = 2;
    let robot = sagging();
    let rest = at_rest(&robot);
    let hanging = rest.cables[CABLE].hanging.as_ref().unwrap();
    let (length, place) = (rest.cables[CABLE].unstrained_length, 0.4 * rest.cables[CABLE].unstrained_length);

    let mut shorter = robot.clone();
    let in_platform = |point_w: Vec3| rest.pose.rot_wp.inverse() * (point_w - rest.pose.position_w);
    shorter.cables[CABLE].attachment_p = in_platform(hanging.point_w(place));
    if let State::Lengths(lengths) = &mut shorter.state {
        lengths[CABLE] = length - place;
    }
    // Centre of mass of the missing half, by Simpson's rule.
    let weight_of = |k: usize| {
        if k == 0 || k == 200 {
            1.0
        } else if k % 2 == 1 {
            4.0
        } else {
            2.0
        }
    };
    let sum: Vec3 = (0..=200).map(|k| hanging.point_w(place * k as f64 / 200.0) * weight_of(k)).sum();
    let missing = robot.gravity_w * (robot.cables[CABLE].material.mass_per_length * place);
    shorter.load = Load { force_w: missing, moment_w: Vec3::zeros(), point_p: in_platform(sum / 600.0) };
    let rest_of_shorter = at_rest(&shorter);
    assert!((rest_of_shorter.pose.position_w - rest.pose.position_w).norm() < 1e-6);

    let mut whole = Simulation::new(&robot, &rest, &[cut(CABLE, 0.01, place)], 0.3, &held()).unwrap();
    let mut half = Simulation::new(&shorter, &rest_of_shorter, &[cut(CABLE, 0.01, 0.0)], 0.3, &held()).unwrap();
    for k in 1..=30 {
        let time = 0.01 * f64::from(k);
        let (of_whole, of_half) = (whole.at(time).unwrap(), half.at(time).unwrap());
        let (one, other) = (&whole.curves_w(time)[CABLE], &half.curves_w(time)[CABLE]);
        let apart = one.iter().zip(other).map(|(p, q)| (p - q).norm()).fold(0.0, f64::max);
        assert!(apart < 2e-3 * length, "{time}: {apart}");
        assert!(of_whole.cables[CABLE].is_cut || k == 1, "{time}");
        let [a, b] = [of_whole, of_half].map(|found| found.cables[CABLE].length.value);
        assert!((a - b).abs() < 1e-9 || k == 1, "{time} {a} {b}");
    }
    // They have moved: the loose end has fallen by most of a free fall of 0.29 s.
    let fallen = hanging.point_w(place).z - whole.curves_w(0.3)[CABLE][0].z;
    assert!(fallen > 0.2, "{fallen}");
}

/// Without gravity a straight rope that fails in its middle is its own mirror image, and both ends hear of it when the
/// wave in the stretch has run half of the rope.
#[test]
fn a_rope_that_fails_in_its_middle_is_symmetric() {
    let mut robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
    let rest = at_rest(&robot);
    robot.gravity_w = Vec3::zeros();
    robot.load = Load { force_w: Vec3::new(0.0, 0.0, -9.81 * robot.platform.mass), ..Load::default() };
    for cable in &mut robot.cables {
        cable.material.stretch_loss.time = 2e-5;
    }
    robot.state = State::Lengths(rest.cables.iter().map(|cable| cable.unstrained_length).collect());
    let rest = at_rest(&robot);
    let (length, before) = (rest.cables[0].unstrained_length, rest.cables[0].tension_platform);
    let rope = &robot.cables[0].material;
    let arrival = 0.5 * length / (rope.axial_stiffness / rope.mass_per_length).sqrt();

    let settings = SimulationSettings { tolerance: 1e-8, ..held() };
    let mut simulation =
        Simulation::new(&robot, &rest, &[cut(0, 0.0, 0.5 * length)], 8.0 * arrival, &settings).unwrap();
    for k in 1..=32 {
        let found = simulation.at(0.25 * arrival * f64::from(k)).unwrap().cables[0];
        let apart = (found.tension_platform - found.tension_anchor).abs();
        assert!(apart < 1e-3 * before, "{k} {apart}");
        if k <= 2 {
            assert!((found.tension_platform - before).abs() < 0.1 * before, "{k} {found:?}");
        }
        if k == 8 {
            assert!(found.tension_platform < 0.5 * before, "{found:?}");
        }
    }
}

/// A failure near the platform is one at the platform, but for the little rope that stays on it.
#[test]
fn a_failure_near_the_platform_is_one_at_the_platform() {
    let robot = sagging();
    let rest = at_rest(&robot);
    let length = rest.cables[1].unstrained_length;
    let run = |place: f64| {
        let events = [cut(1, 0.02, place)];
        let mut simulation = Simulation::new(&robot, &rest, &events, 0.3, &SimulationSettings::default()).unwrap();
        simulation.at(0.3).unwrap().pose.position_w
    };
    let at_platform = run(0.0);
    let moved = (at_platform - rest.pose.position_w).norm();
    let [near, far] = [0.02, 0.04].map(|share| (run(share * length) - at_platform).norm());
    // What stays hangs on the platform with its weight: the difference grows with it.
    assert!(near < 0.05 * moved && far > 1.2 * near && far < 3.0 * near, "{near} {far} {moved}");
}

/// Books of the energy close while the winch of the failing cable pays out, with a mesh that is fine enough for both.
#[test]
fn the_books_close_over_a_failure_of_a_rope_that_is_paid_out() {
    let robot = sagging();
    let rest = at_rest(&robot);
    let length = rest.cables[3].unstrained_length;
    let mut changes = vec![0.0; 6];
    changes[3] = 0.04;
    let ramp = SimulationEvent::Ramp { time: 0.0, duration: 0.4, changes };
    for place in [0.3, 0.9] {
        let events = [ramp.clone(), cut(3, 0.2, place * length)];
        let mut simulation = Simulation::new(&robot, &rest, &events, 0.5, &SimulationSettings::default()).unwrap();
        let before = simulation.at(0.2 - 1e-9).unwrap();
        let after = simulation.at(0.2 + 1e-9).unwrap();
        let jump = (after.energy.total() - before.energy.total()).abs();
        assert!(jump < 1e-3 * (before.energy.strain + before.energy.kinetic), "{place}: {jump}");
        // The whole cable counts before, the half at the winch after.
        let [whole, half] = [&before, &after].map(|found| found.cables[3].length);
        assert!((whole.value - half.value - place * length).abs() < 1e-6, "{whole:?} {half:?}");
        assert!((whole.rate - half.rate).abs() < 1e-6 && whole.rate > 0.05, "{whole:?} {half:?}");
        let end = simulation.at(0.5).unwrap().energy;
        assert!(end.defect().abs() < 1e-2 * end.moved(), "{place}: {end:?}");
    }
}

/// A rope without mass takes its energy along, whether it fails at a time or at a tension, and wherever.
#[test]
fn a_rope_without_mass_takes_its_energy_along() {
    let mut robot = pendulum(0.0);
    let mut second = robot.cables[0].clone();
    second.name = "2".to_owned();
    second.anchor.point_w.x = 1.0;
    robot.cables.push(second);
    robot.state = State::Lengths(vec![4.0, 4.1]);
    let rest = at_rest(&robot);
    let tension = rest.cables[1].tension_platform;
    let push = SimulationEvent::Push {
        time: 0.0,
        duration: 0.4,
        rise: 0.1,
        force_w: Vec3::new(-30.0, 0.0, 0.0),
        moment_w: Vec3::zeros(),
        point_p: Vec3::zeros(),
    };
    for at in [CutAt::Time(0.2), CutAt::Tension(1.2 * tension)] {
        let events = [push.clone(), SimulationEvent::Cut { cable: 1, at, place: 1.5 }];
        let mut simulation = Simulation::new(&robot, &rest, &events, 0.6, &SimulationSettings::default()).unwrap();
        let found = simulation.at(0.6).unwrap();
        assert_eq!(simulation.cuts().len(), 1, "{at:?}");
        assert!(found.energy.payloads < 0.0 && found.energy.defect().abs() < 1e-4 * found.energy.moved(), "{found:?}");
    }
}

/// Places that a cable does not have are refused before anything is simulated, or when the cable fails.
#[test]
fn places_outside_a_cable_are_refused() {
    let robot = sagging();
    let rest = at_rest(&robot);
    let length = rest.cables[0].unstrained_length;
    let tries = |events: &[SimulationEvent]| {
        let simulation = Simulation::new(&robot, &rest, events, 0.3, &SimulationSettings::default());
        simulation.and_then(|mut simulation| simulation.at(0.3)).err().map(|error| error.to_string())
    };
    for place in [0.01 * length, 0.99 * length, 2.0 * length] {
        assert!(tries(&[cut(0, 0.1, place)]).unwrap().contains("0 for a failure at the platform"), "{place}");
    }
    assert!(tries(&[cut(0, 0.1, -1.0)]).unwrap().contains("give 0 or more"));
    // What is left is wound in.
    let mut changes = vec![0.0; 6];
    changes[0] = -0.3 * length;
    let ramp = SimulationEvent::Ramp { time: 0.15, duration: 0.1, changes };
    assert!(tries(&[cut(0, 0.1, 0.8 * length), ramp.clone()]).unwrap().contains("must stay above"));
    assert_eq!(tries(&[cut(0, 0.1, 0.2 * length), ramp]), None);
    // Its tension at the start is below.
    let never = SimulationEvent::Cut { cable: 0, at: CutAt::Tension(1e6), place: 2.0 * length };
    assert_eq!(tries(&[never]), None);
}
