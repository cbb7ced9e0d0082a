//! Anchors that move: a base that accelerates is tilted gravity, books of the energy, tables, refused input.

use funicular::math::Vec3;
use funicular::robot::{Damping, Robot, State};
use funicular::simulation::{
    AnchorAtEnd, EventFault, LengthAtEnd, RobotSample, Simulation, SimulationError, SimulationEvent,
    SimulationSettings, StepError, StepInputs, SteppedSimulation, WrenchInput,
};
use funicular::statics::{self, Equilibrium, StaticModel};

fn robot() -> (Robot, Equilibrium) {
    let mut robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
    robot.platform.mass = 12.5;
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    (robot, rest)
}

fn damped() -> SimulationSettings {
    SimulationSettings { tolerance: 1e-6, stretch_damping_time: Some(0.01), ..SimulationSettings::default() }
}

/// Motion of all anchors by a displacement with its velocity.
fn base(robot: &Robot, moved_w: Vec3, velocity_w: Vec3) -> StepInputs {
    let anchor =
        |place_w: Vec3| AnchorAtEnd { place_w: place_w + moved_w, velocity_w: Some(velocity_w), acceleration_w: None };
    let anchors = robot.cables.iter().map(|cable| Some(anchor(cable.anchor.point_w))).collect();
    StepInputs { anchors, ..StepInputs::default() }
}

/// Statics knows nothing of a simulation: with gravity less the acceleration of the base it has the same tensions.
#[test]
fn a_base_that_accelerates_is_tilted_gravity() {
    let (robot, rest) = without_air(funicular_robots::IPANEMA2);
    let acceleration_w = Vec3::new(1.2, -0.8, 0.5);
    let mut simulation = SteppedSimulation::new(&robot, &rest, &[], &damped()).unwrap();
    let mut sample = simulation.now();
    for k in 1..=150 {
        let time = 0.02 * f64::from(k);
        let inputs = base(&robot, acceleration_w * (0.5 * time * time), acceleration_w * time);
        sample = simulation.step(0.02, &inputs).unwrap();
    }

    let mut tilted = robot.clone();
    tilted.gravity_w -= acceleration_w;
    let lengths = State::Lengths(rest.cables.iter().map(|cable| cable.unstrained_length).collect());
    let rule = statics::TensionRule::default();
    let expected = statics::solve_at(&tilted, &lengths, StaticModel::Catenary, &rule).unwrap().equilibrium;
    let moved_w = acceleration_w * (0.5 * sample.time * sample.time);
    let place_w = sample.pose.position_w - moved_w;
    let away = (expected.pose.position_w - rest.pose.position_w).norm();
    assert!((place_w - expected.pose.position_w).norm() < 2e-3 * away, "{place_w:?} {:?}", expected.pose.position_w);
    let mut differs = 0.0_f64;
    for ((found, expected), before) in sample.cables.iter().zip(&expected.cables).zip(&rest.cables) {
        let [platform, before] = [expected, before].map(|of| of.tension_platform);
        assert!((found.tension_platform - platform).abs() < 0.5, "{} {platform}", found.tension_platform);
        differs = differs.max((platform - before).abs());
    }
    assert!(differs > 5.0, "the acceleration matters: {differs}");
    assert!((sample.acceleration_w.fixed_rows::<3>(0) - acceleration_w).norm() < 0.05);

    // The base gives the kinetic energy and lifts the weight.
    let books = &sample.energy;
    assert!(books.defect().abs() < 1e-4 * books.moved(), "{books:?}");
    let masses: f64 = robot
        .cables
        .iter()
        .zip(&rest.cables)
        .map(|(cable, state)| cable.material.mass_per_length * state.unstrained_length)
        .sum();
    let velocity_w = acceleration_w * sample.time;
    let mass = robot.platform.mass + masses;
    let work = mass * (0.5 * velocity_w.norm_squared() - robot.gravity_w.dot(&moved_w));
    assert!((books.anchors - work).abs() < 0.01 * work, "{} {work}", books.anchors);
}

/// Robot without damping against the air, which rests when the base moves.
fn without_air(toml: &str) -> (Robot, Equilibrium) {
    let mut robot = Robot::from_toml(toml).unwrap();
    robot.platform.translational_damping_p = Vec3::zeros();
    for cable in &mut robot.cables {
        cable.material.damping = Damping::Viscous(0.0);
    }
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    (robot, rest)
}

/// Galilei: a robot that moves uniformly with its base does what it does at rest.
#[test]
fn a_base_in_uniform_motion_changes_nothing() {
    // Position [m] and tension [N]: the suspended robot still sways by 5e-6 m when the comparison begins.
    for (toml, bounds) in [(funicular_robots::IPANEMA2, [1e-6, 0.05]), (funicular_robots::COGIRO_WINCHES, [1e-5, 0.3])]
    {
        let (robot, rest) = without_air(toml);
        let velocity_w = Vec3::new(0.6, -0.4, 0.2);
        let settings = SimulationSettings { tolerance: 1e-7, ..damped() };
        let new = || SteppedSimulation::new(&robot, &rest, &[], &settings).unwrap();
        let (mut moving, mut resting) = (new(), new());
        // From rest to the velocity within two seconds, without a jump of the acceleration, and on.
        let mut moved_w = Vec3::zeros();
        for k in 1..=400 {
            let time = 0.02 * f64::from(k);
            let s = (0.5 * time).min(1.0);
            moved_w = velocity_w * (2.0 * s * s * s * (1.0 - 0.5 * s) + (time - 2.0 * s));
            let inputs = base(&robot, moved_w, velocity_w * (s * s * (3.0 - 2.0 * s)));
            moving.step(0.02, &inputs).unwrap();
        }
        let wrench = WrenchInput { force_w: Vec3::new(20.0, -30.0, 15.0), ..WrenchInput::default() };
        let mut moved = 0.0;
        for k in 1..=10 {
            let end = 0.01 * f64::from(k);
            let mut inputs = StepInputs { wrench: Some(wrench), ..StepInputs::default() };
            inputs.lengths = vec![None; robot.cables.len()];
            let length = rest.cables[0].unstrained_length + 0.5 * end * end;
            inputs.lengths[0] = Some(LengthAtEnd { length, rate: Some(end), acceleration: None });
            let [a, b] = [&mut moving, &mut resting].map(|of| of.step(0.01, &inputs).unwrap());
            let place_w = a.pose.position_w - moved_w - velocity_w * end - b.pose.position_w;
            let off = a.cables.iter().zip(&b.cables).map(|(a, b)| (a.tension_platform - b.tension_platform).abs());
            let off = off.fold(0.0, f64::max);
            moved = (b.pose.position_w - rest.pose.position_w).norm();
            assert!(place_w.norm() < bounds[0] && off < bounds[1], "{} {end} {place_w:?} {off}", robot.name);
        }
        assert!(moved > 20.0 * bounds[0], "{moved}");
    }
}

/// Part of the energy that has moved which the errors of steps may leave, as in one step.
const DEFECT: f64 = 1e-4;

/// Table of one anchor that goes to and fro.
fn table(robot: &Robot, cable: usize) -> SimulationEvent {
    let times: Vec<f64> = (0..=20).map(|k| 0.02 * f64::from(k)).collect();
    let at = |time: &f64| {
        let part = (std::f64::consts::PI * time / 0.4).sin().powi(2);
        robot.cables[cable].anchor.point_w + Vec3::new(0.01, -0.02, 0.015) * part
    };
    let places = times.iter().map(at).collect();
    let mut places_w = vec![None; robot.cables.len()];
    places_w[cable] = Some(places);
    SimulationEvent::Anchors { time: 0.1, times, places_w }
}

fn run(robot: &Robot, rest: &Equilibrium, events: &[SimulationEvent]) -> Result<RobotSample, SimulationError> {
    let settings = SimulationSettings { tolerance: 1e-8, ..SimulationSettings::default() };
    let mut simulation = Simulation::new(robot, rest, events, 0.6, &settings)?;
    simulation.at(0.6)
}

#[test]
fn a_table_moves_one_anchor_with_its_winch_and_the_books_are_closed() {
    let (robot, rest) = robot();
    let ramp = SimulationEvent::Ramp { time: 0.1, duration: 0.4, changes: vec![0.0, 0.03, 0.0, 0.0, 0.0, 0.0] };
    let end = run(&robot, &rest, &[table(&robot, 1), ramp.clone()]).unwrap();
    let books = &end.energy;
    assert!(books.anchors.abs() > 1e-2 && books.defect().abs() < DEFECT * books.moved(), "{books:?}");
    let without = run(&robot, &rest, &[ramp]).unwrap();
    assert!(without.energy.anchors.abs() == 0.0);
    assert!((end.pose.position_w - without.pose.position_w).norm() > 1e-6);

    let winches = Robot::from_toml(funicular_robots::COGIRO_WINCHES).unwrap();
    let rest = statics::solve(&winches, StaticModel::Catenary, None).unwrap().equilibrium;
    let mut changes = vec![0.0; 8];
    changes[0] = 0.02;
    let ramp = SimulationEvent::Ramp { time: 0.1, duration: 0.4, changes };
    let books = run(&winches, &rest, &[table(&winches, 0), ramp]).unwrap().energy;
    assert!(books.anchors.abs() > 1.0 && books.defect().abs() < DEFECT * books.moved(), "{books:?}");
}

#[test]
fn a_saved_state_has_the_motion_of_the_anchors() {
    let (robot, rest) = robot();
    let new = || SteppedSimulation::new(&robot, &rest, &[], &damped()).unwrap();
    let (mut first, mut second) = (new(), new());
    let up = base(&robot, Vec3::new(0.0, 0.0, 1e-3), Vec3::new(0.0, 0.0, 0.2));
    first.step(0.01, &up).unwrap();
    second.restore(&first.save()).unwrap();
    for _ in 0..5 {
        // Left out, they go on with their velocity.
        let samples = [&mut first, &mut second].map(|of| of.step(0.01, &StepInputs::default()).unwrap());
        assert_eq!(samples[0], samples[1]);
    }
    let [place_w, velocity_w, _] = first.anchor_motion(2);
    let moved_w = place_w - robot.cables[2].anchor.point_w;
    assert!((moved_w - Vec3::new(0.0, 0.0, 0.011)).norm() < 1e-12 && (velocity_w.z - 0.2).abs() < 1e-12);
}

#[test]
fn refused_motions_of_anchors_change_nothing() {
    let (robot, rest) = robot();
    let mut simulation = SteppedSimulation::new(&robot, &rest, &[], &damped()).unwrap();
    let mut inputs = base(&robot, Vec3::new(0.0, 0.0, 1e-3), Vec3::zeros());
    let before = simulation.save();
    let change = |inputs: &mut StepInputs, change: &dyn Fn(&mut AnchorAtEnd)| {
        inputs.anchors.iter_mut().flatten().for_each(change);
    };
    change(&mut inputs, &|of| of.velocity_w = None);
    assert!(matches!(simulation.step(0.01, &inputs), Err(StepError::AnchorJump { .. })));
    change(&mut inputs, &|of| of.velocity_w = Some(Vec3::new(0.0, f64::NAN, 0.0)));
    assert!(matches!(simulation.step(0.01, &inputs), Err(StepError::NotFinite { key: "anchor_velocities_m_s" })));
    inputs.anchors.pop();
    assert!(matches!(simulation.step(0.01, &inputs), Err(StepError::Count { key: "anchors_m", given: 5, cables: 6 })));
    assert_eq!(simulation.happen(&table(&robot, 0)), Err(StepError::NotNow { event: 0.1, now: 0.0 }));
    assert_eq!(simulation.save(), before);

    let SimulationEvent::Anchors { times, mut places_w, .. } = table(&robot, 0) else { unreachable!() };
    let event =
        |places_w: Vec<Option<Vec<Vec3>>>| SimulationEvent::Anchors { time: 0.1, times: times.clone(), places_w };
    let fault = |event: SimulationEvent| match run(&robot, &rest, &[event]) {
        Err(SimulationError::Event { fault, .. }) => fault,
        other => panic!("{other:?}"),
    };
    assert_eq!(fault(event(vec![None; 6])), EventFault::NoAnchor);
    places_w[0].as_mut().unwrap()[0].x += 0.01;
    assert!(matches!(fault(event(places_w.clone())), EventFault::AnchorJump { .. }));
    places_w[0].as_mut().unwrap()[0].x = f64::NAN;
    assert!(matches!(fault(event(places_w)), EventFault::AnchorNotFinite { .. }));
}
