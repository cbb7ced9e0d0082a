//! Simulation in intervals: the same as one run, the same bits from a saved state, refused input.

use funicular::math::Vec3;
use funicular::robot::Robot;
use funicular::simulation::{
    CutAt, ElementMesh, LengthAtEnd, RobotSample, Simulation, SimulationEvent, SimulationSettings, StepError,
    StepInputs, SteppedSimulation, WrenchInput,
};
use funicular::statics::{self, Equilibrium, StaticModel};

fn robot() -> (Robot, Equilibrium) {
    let mut robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
    robot.platform.mass = 12.5;
    robot.wind.air_density = 1.2;
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    (robot, rest)
}

fn settings() -> SimulationSettings {
    SimulationSettings { tolerance: 1e-6, ..SimulationSettings::default() }
}

fn new() -> (SteppedSimulation, Vec<f64>) {
    let (robot, rest) = robot();
    let lengths = rest.cables.iter().map(|cable| cable.unstrained_length).collect();
    (SteppedSimulation::new(&robot, &rest, &[0], &settings()).unwrap(), lengths)
}

fn push(force: f64) -> SimulationEvent {
    SimulationEvent::Push {
        time: 0.0,
        duration: 0.05,
        rise: 0.0,
        force_w: Vec3::new(force, 0.0, 0.5 * force),
        moment_w: Vec3::zeros(),
        point_p: Vec3::new(0.0, 0.1, 0.0),
    }
}

fn force(x: f64) -> StepInputs {
    let wrench = WrenchInput { force_w: Vec3::new(x, 0.0, 0.0), ..WrenchInput::default() };
    StepInputs { wrench: Some(wrench), ..StepInputs::default() }
}

/// Lengths of a smooth course at a time, with rates and accelerations.
fn lengths(initial: &[f64], time: f64) -> StepInputs {
    let (omega, size) = (20.0, 0.001);
    let (sin, cos) = (omega * time).sin_cos();
    let command = |(i, length): (usize, &f64)| {
        let part = size * (1.0 - 0.3 * i as f64);
        Some(LengthAtEnd {
            length: length + part * (omega * time - sin),
            rate: Some(part * omega * (1.0 - cos)),
            acceleration: Some(part * omega * omega * sin),
        })
    };
    StepInputs { lengths: initial.iter().enumerate().map(command).collect(), ..StepInputs::default() }
}

/// Difference of positions [m] and largest difference of tensions [N].
fn differences(a: &RobotSample, b: &RobotSample) -> [f64; 2] {
    let tensions = a.cables.iter().zip(&b.cables).map(|(a, b)| (a.tension_platform - b.tension_platform).abs());
    [(a.pose.position_w - b.pose.position_w).norm(), tensions.fold(0.0, f64::max)]
}

/// Largest stiffness of a cable along itself [N/m].
fn stiffest(robot: &Robot, rest: &Equilibrium) -> f64 {
    let stiffness = rest.cables.iter().zip(&robot.cables);
    stiffness.map(|(state, cable)| cable.material.axial_stiffness / state.unstrained_length).fold(0.0, f64::max)
}

/// As long as inputs go on, the steps are those of a free run, to the last bit, wherever the intervals end.
#[test]
fn intervals_without_new_inputs_are_a_free_run() {
    let (robot, rest) = robot();
    let release = SimulationEvent::Release { time: 0.0, mass: 1.0, point_p: None };
    let events = [push(30.0), release.clone()];
    let mut free = Simulation::new(&robot, &rest, &events, 10.0, &settings()).unwrap();
    let mut stepped = SteppedSimulation::new(&robot, &rest, &[], &settings()).unwrap();
    for event in &events {
        stepped.happen(event).unwrap();
    }
    for k in 0..300 {
        let found = stepped.step([0.001, 0.000_37, 0.002_3][k % 3], &StepInputs::default()).unwrap();
        assert_eq!(found, free.at(stepped.time()).unwrap(), "{k}");
    }
    let counts = [stepped.run().counts(), free.counts()];
    assert_eq!(counts[0].accepted, counts[1].accepted);
    assert!(counts[0].evaluations - counts[1].evaluations < 10, "{counts:?}");
}

/// A force that is held from call to call is that of a push; its steps are as long as those of the free run.
#[test]
fn a_held_force_is_that_of_a_push() {
    let (robot, rest) = robot();
    let push = SimulationEvent::Push {
        time: 0.0,
        duration: 5.0,
        rise: 0.0,
        force_w: Vec3::new(20.0, 0.0, 0.0),
        moment_w: Vec3::zeros(),
        point_p: Vec3::zeros(),
    };
    let mut free = Simulation::new(&robot, &rest, &[push], 5.0, &settings()).unwrap();
    let (mut stepped, _) = new();
    for k in 0..200 {
        let found = stepped.step(0.001, &force(20.0)).unwrap();
        let wanted = free.at(stepped.time()).unwrap();
        // Other ends of steps: some tolerances for the place, and these over the stretch for the tensions.
        let [place, tension] = differences(&found, &wanted);
        assert!(place < 2e-6, "{k}: {place:e} {tension:e}");
        assert!(found.energy.defect().abs() < 1e-3 * found.energy.moved().max(1e-3), "{k}: {:?}", found.energy);
    }
    let steps = [stepped.run().counts().accepted, free.counts().accepted];
    assert!(steps[0] < steps[1] + 5, "{steps:?}");
}

/// Lengths that are commanded every millisecond with rates and accelerations are those of a table in one run.
#[test]
fn commanded_lengths_are_those_of_a_table() {
    let (robot, rest) = robot();
    let (mut stepped, initial) = new();
    let times: Vec<f64> = (0..=314).map(|k| 0.001 * f64::from(k)).collect();
    let column = |i: usize| {
        let at = |time: &f64| lengths(&initial, *time).lengths[i].unwrap().length;
        Some(times.iter().map(at).collect())
    };
    let table = (0..initial.len()).map(column).collect();
    let follow = SimulationEvent::Follow { time: 0.0, times: times.clone(), lengths: table };
    let finer = SimulationSettings { tolerance: 1e-8, ..settings() };
    let mut one = Simulation::new(&robot, &rest, &[follow], 1.0, &finer).unwrap();
    for time in &times[1..300] {
        let found = stepped.step(0.001, &lengths(&initial, *time)).unwrap();
        let wanted = one.at(*time).unwrap();
        let [place, tension] = differences(&found, &wanted);
        assert!(place < 2e-5 && tension < 2e-5 * stiffest(&robot, &rest), "{time}: {place:e} {tension:e}");
        assert!((stepped.time() - time).abs() < 1e-12);
    }
    // One step an interval, each with the factor of the one before.
    let counts = stepped.run().counts();
    assert!(counts.accepted < 330 && counts.factored < 200, "{counts:?}");
}

/// Inputs and events of a lively course at interval `k`.
fn lively(simulation: &mut SteppedSimulation, initial: &[f64], k: usize) -> Result<RobotSample, StepError> {
    let time = simulation.time();
    match k {
        5 => simulation.happen(&SimulationEvent::Release { time, mass: 0.5, point_p: None })?,
        12 => simulation.happen(&SimulationEvent::Cut { cable: 2, at: CutAt::Time(time), place: 0.0 })?,
        15 => simulation.happen(&SimulationEvent::Cut { cable: 3, at: CutAt::Tension(400.0), place: 0.0 })?,
        18 => simulation.happen(&SimulationEvent::Pick { time, mass: 0.5, point_p: None, velocity_w: None })?,
        24 => {
            let mut tensions = vec![None; initial.len()];
            tensions[0] = Some(60.0);
            simulation.happen(&SimulationEvent::Tension { time, duration: 0.01, tensions })?;
        }
        30 => simulation.happen(&SimulationEvent::Stop { time, duration: 0.01, cables: vec![1, 4] })?,
        _ => {}
    }
    let inputs = match k {
        8..14 => force(10.0 * k as f64),
        20..24 => StepInputs { wind_w: Some(Vec3::new(0.0, 8.0, 0.0)), ..force(50.0) },
        26..30 => {
            let mut inputs = lengths(initial, 0.001 * (k - 25) as f64);
            inputs.lengths[0] = None;
            inputs
        }
        _ => StepInputs::default(),
    };
    simulation.step(0.001, &inputs)
}

/// Pulleys, drum sides and winches: a step that is taken again to an interval's end is as good as another one.
#[test]
fn a_robot_over_pulleys_is_saved_and_cut_short_as_well() {
    let robot = Robot::from_toml(funicular_robots::COGIRO_WINCHES).unwrap();
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let settings = SimulationSettings { mesh: ElementMesh { elements: 1, degree: 6 }, ..settings() };
    let new = || SteppedSimulation::new(&robot, &rest, &[], &settings).unwrap();
    let (mut plain, mut saving) = (new(), new());
    for k in 0..40 {
        let inputs = if k % 7 < 4 { force(300.0 * f64::from(k / 7)) } else { StepInputs::default() };
        let wanted = plain.step(0.001, &inputs).unwrap();
        let mut other = new();
        other.restore(&saving.save()).unwrap();
        assert_eq!(saving.step(0.001, &inputs).unwrap(), wanted, "{k}");
        assert_eq!(other.step(0.001, &inputs).unwrap(), wanted, "{k}");
        assert!(wanted.energy.defect().abs() < 1e-3 * wanted.energy.moved().max(1e-3), "{k}: {:?}", wanted.energy);
    }
}

/// A state that is saved anywhere gives the same bits, in a new simulation and in the same one, and saving does not
/// change what comes.
#[test]
fn a_saved_state_goes_on_with_the_same_bits() {
    let (mut plain, initial) = new();
    let wanted: Vec<RobotSample> = (0..40).map(|k| lively(&mut plain, &initial, k).unwrap()).collect();
    let (mut saving, _) = new();
    for k in 0..40 {
        let saved = saving.save();
        let (mut other, _) = new();
        if k % 5 == 0 {
            lively(&mut other, &initial, 0).unwrap();
        }
        other.restore(&saved).unwrap();
        assert_eq!(other.save(), saved, "{k}");
        let mut cloned = saving.clone();
        for (later, wanted) in wanted.iter().enumerate().skip(k).take(3) {
            assert_eq!(lively(&mut other, &initial, later).unwrap(), *wanted, "{k} {later}");
            assert_eq!(lively(&mut cloned, &initial, later).unwrap(), *wanted, "{k} {later}");
        }
        assert_eq!(lively(&mut saving, &initial, k).unwrap(), wanted[k], "{k}");
    }
    assert_eq!(saving.run().cuts(), plain.run().cuts());
    assert_eq!(saving.run().slack(), plain.run().slack());
}

#[test]
fn refused_input_changes_nothing() {
    let (mut simulation, initial) = new();
    for k in 0..3 {
        lively(&mut simulation, &initial, k).unwrap();
    }
    let saved = simulation.save();
    let time = simulation.time();
    for interval in [0.0, -0.001, 10.0, f64::NAN, f64::INFINITY, 1e-9] {
        let refused = simulation.step(interval, &StepInputs::default());
        assert!(matches!(refused, Err(StepError::Interval { .. })), "{interval}: {refused:?}");
    }
    let command = |length: f64, rate: Option<f64>| {
        let mut inputs = StepInputs { lengths: vec![None; initial.len()], ..StepInputs::default() };
        inputs.lengths[1] = Some(LengthAtEnd { length, rate, acceleration: None });
        inputs
    };
    let few = StepInputs { lengths: vec![None], ..StepInputs::default() };
    let inputs = [
        (force(f64::NAN), "not finite"),
        (force(1e200), "not finite"),
        (few, "has 1 values, and the robot has 6 cables"),
        (command(f64::NAN, None), "not finite"),
        (command(initial[1], Some(f64::INFINITY)), "not finite"),
        (command(initial[1] + 0.01, None), "which is a jump"),
        (command(initial[1] + 0.01, Some(0.0)), "which is a jump"),
        (command(1e-3 * initial[1], Some(0.0)), "give at least"),
        (StepInputs { wind_w: Some(Vec3::new(f64::NAN, 0.0, 0.0)), ..StepInputs::default() }, "not finite"),
    ];
    for (inputs, text) in inputs {
        let refused = simulation.step(0.001, &inputs).unwrap_err().to_string();
        assert!(refused.contains(text), "{refused}");
    }
    let events = [
        (SimulationEvent::Cut { cable: 9, at: CutAt::Time(time), place: 0.0 }, "there is no cable 9"),
        (SimulationEvent::Cut { cable: 1, at: CutAt::Time(time), place: 1.0 }, "fails at the platform"),
        (SimulationEvent::Cut { cable: 1, at: CutAt::Time(0.0), place: 0.0 }, "happens at the present time"),
        (SimulationEvent::Cut { cable: 1, at: CutAt::Tension(1.0), place: 0.0 }, "at the start"),
        (SimulationEvent::Release { time, mass: 99.0, point_p: None }, "99"),
        (SimulationEvent::Tension { time, duration: 0.1, tensions: vec![Some(9.0); 6] }, "tension_control"),
        (SimulationEvent::Follow { time, times: vec![0.0, 1.0], lengths: vec![None; 6] }, "a table"),
    ];
    for (event, text) in events {
        let refused = simulation.happen(&event).unwrap_err().to_string();
        assert!(refused.contains(text), "{refused}");
    }
    assert_eq!(simulation.save(), saved);

    // States that are none, are damaged, or belong to another robot.
    let mut damaged = saved.clone();
    damaged[200] ^= 1;
    let (mut robot, rest) = robot();
    robot.platform.mass = 13.0;
    let mut other = SteppedSimulation::new(&robot, &rest, &[0], &settings()).unwrap();
    let refused = [
        (simulation.restore(b"state"), StepError::NotSaved),
        (simulation.restore(&damaged), StepError::Damaged),
        (simulation.restore(&saved[..saved.len() - 8]), StepError::Damaged),
        (other.restore(&saved), StepError::OtherRobot),
    ];
    for (found, wanted) in refused {
        assert_eq!(found, Err(wanted));
    }
    assert_eq!(simulation.save(), saved);
}

/// A step that fails leaves the simulation as it was before.
#[test]
fn a_step_that_fails_changes_nothing() {
    let (robot, rest) = robot();
    let mut simulation = SteppedSimulation::new(&robot, &rest, &[], &settings()).unwrap();
    simulation.step(0.003, &force(5.0)).unwrap();
    let saved = simulation.save();
    // No step follows such a force.
    let failed = simulation.step(0.01, &force(1e120));
    assert!(matches!(failed, Err(StepError::Failed(_))), "{failed:?}");
    assert_eq!(simulation.save(), saved);
    assert!(simulation.step(0.001, &force(5.0)).is_ok());
}
