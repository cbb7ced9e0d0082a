//! Typical jobs of a user, one bench per job, on one core. The robot is robots/yuan2014-4mm.toml at 10.55 kg.
#![allow(missing_docs)]

use criterion::{Criterion, criterion_group, criterion_main};
use funicular::cable::CableModel;
use funicular::catenary::{Catenary, Rope};
use funicular::clearance::{ClearanceKind, Surroundings};
use funicular::control_loop::{ControlLoop, LoopInput, LoopModel, LoopState};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::gradient::{Gradients, Hold};
use funicular::math::Vec3;
use funicular::path::{CourseForm, MotionLimits, PathPoint, PlatformPath};
use funicular::response::{self, Quantity, Signal};
use funicular::robot::parameters::Parameters;
use funicular::robot::{Robot, RobotChange, State, TensionLimits};
use funicular::simulation::{Simulation, SimulationEvent, SimulationSettings};
use funicular::statics::{self, Equilibrium, LoadCapacity, StaticModel, TensionCentre, TensionRule};
use funicular::trajectory::AlongPath;
use funicular::{modes, robot::Pose};
use std::hint::black_box;
use std::time::Duration;

fn robot() -> (Robot, Vec<f64>) {
    let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).expect("the library's robot");
    let State::Lengths(lengths) = robot.state.clone() else { panic!("its state is given by lengths") };
    (robot, lengths)
}

fn one_catenary(c: &mut Criterion) {
    // Sixteen cables from taut to deep sag, so that the branch predictor cannot learn one of them.
    let ropes: Vec<(f64, f64, Rope)> = (0..16)
        .map(|i| {
            let rope = Rope {
                unstrained_length: 6.7 + 0.03 * f64::from(i),
                weight_per_length: 0.657_27,
                axial_stiffness: 251_327.4,
            };
            (5.54 - 0.02 * f64::from(i), 4.025 - 0.01 * f64::from(i), rope)
        })
        .collect();
    let mut i = 0;
    c.bench_function("catenary: one cable, end forces", |b| {
        b.iter(|| {
            i = (i + 1) & 15;
            let (span, rise, rope) = black_box(ropes[i]);
            Catenary::between(span, rise, rope).expect("valid").horizontal_force()
        });
    });
}

fn statics_both_ways(c: &mut Criterion) {
    let (robot, lengths) = robot();
    c.bench_function("statics: lengths to pose, no start", |b| {
        b.iter(|| statics::forward(&robot, black_box(&lengths), StaticModel::Catenary, None).expect("converges"));
    });
    let pose = Pose::new([0.3, -0.2, 0.7], [1.0, 2.0, 3.0]);
    c.bench_function("statics: pose to lengths", |b| {
        b.iter(|| statics::inverse(&robot, black_box(&pose), StaticModel::Catenary).expect("converges"));
    });
}

/// One pose per iteration, from a thousand wrench-feasible poses all over the workspace of CoGiRo.
fn tension_distribution(c: &mut Criterion) {
    let robot = Robot::from_toml(funicular_robots::COGIRO).expect("the library's robot");
    let robot = robot.with_tension_limits(TensionLimits { minimum: Some(50.0), maximum: Some(1500.0) });
    let possible =
        |pose: &Pose| statics::distribute_tensions(&robot, pose, StaticModel::Catenary, &TensionRule::Lowest).is_ok();
    let entry = |i: u32, root: f64| (f64::from(i + 1) * root).fract() * 2.0 - 1.0;
    let poses: Vec<Pose> = (0..4000)
        .map(|i| {
            let (x, y, z) = (entry(i, 2f64.sqrt()), entry(i, 3f64.sqrt()), entry(i, 5f64.sqrt()));
            let turn = [7.0, 11.0, 13.0].map(|square: f64| 10.0 * entry(i, square.sqrt()));
            Pose::new([6.0 * x, 4.0 * y, 2.0 + 1.5 * z], turn)
        })
        .filter(possible)
        .take(1000)
        .collect();
    let wanted = TensionRule::Closest(vec![500.0]);
    for rule in [TensionRule::Lowest, wanted, TensionRule::Middle, TensionRule::Centre, TensionRule::Stiffest] {
        let mut i = 0;
        c.bench_function(&format!("tension_distribution: {}", rule.name()), |b| {
            b.iter(|| {
                i = (i + 1) % poses.len();
                statics::distribute_tensions(&robot, black_box(&poses[i]), StaticModel::Catenary, &rule)
                    .expect("possible")
            });
        });
    }
}

/// One pose per iteration, 4 mm on along a line through the workspace of CoGiRo, from the centre of the last one.
fn centre_along_a_line(c: &mut Criterion) {
    let robot = Robot::from_toml(funicular_robots::COGIRO).expect("the library's robot");
    let at = |i: usize| {
        let part = 0.004 * (i as f64 - 750.0);
        Pose::new([part, 2.0 / 3.0 * part, 1.75 + 0.25 * part], [0.0; 3])
    };
    let centre = |pose: &Pose, last: Option<&TensionCentre>| {
        statics::tension_centre(&robot, pose, StaticModel::Catenary, last).expect("possible")
    };
    let (mut i, mut last) = (0, centre(&at(0), None));
    c.bench_function("tension_distribution: centre, 4 mm from the last", |b| {
        b.iter(|| {
            i += 1;
            // To and fro, so that every pose is a neighbour of the last one.
            let station = i % 3000;
            last = centre(black_box(&at(station.min(3000 - station))), Some(&last));
            last.tensions[0]
        });
    });
}

/// Two sets of a thousand poses of the paper's robot. In the first the platform is nearly level, and no cable sags by
/// more than a quarter of its chord. The second fills a box; at more than half of its poses a cable has little tension.
fn first_frequencies(c: &mut Criterion) {
    let (robot, _) = robot();
    let entry = |i: u32, root: f64| (f64::from(i + 1) * root).fract() * 2.0 - 1.0;
    let held = |size: [f64; 3], turn: f64, steepest: f64| -> Vec<Pose> {
        let pose = |i: u32| {
            let along = [2f64, 3.0, 5.0].map(|square| entry(i, square.sqrt()));
            let turns = [7f64, 11.0, 13.0].map(|square| turn * entry(i, square.sqrt()));
            Pose::new([size[0] * along[0], size[1] * along[1], 1.0 + size[2] * along[2]], turns)
        };
        let taut = |state: &statics::CableState| {
            let catenary = &state.hanging.as_ref().expect("it hangs").catenary;
            catenary.weight() < steepest * catenary.horizontal_force()
        };
        let possible = |pose: &Pose| {
            let held = statics::inverse(&robot, pose, StaticModel::Catenary);
            held.is_ok_and(|rest| rest.cables.iter().all(taut) && modes::first(&robot, &rest).is_ok())
        };
        (0..8000).map(pose).filter(possible).take(1000).collect()
    };
    let sets =
        [("", held([2.0, 1.0, 0.8], 1.0, 2.0)), (", slack cables too", held([3.0, 1.2, 1.0], 3.0, f64::INFINITY))];
    for (name, poses) in sets {
        assert_eq!(poses.len(), 1000);
        c.bench_function(&format!("1,000 poses: statics, tensions, first frequency{name}"), |b| {
            b.iter(|| {
                let first = |pose: &Pose| {
                    let rest = statics::inverse(&robot, pose, StaticModel::Catenary).expect("possible");
                    modes::first(&robot, &rest).expect("possible").frequency_hz
                };
                black_box(&poses).iter().map(first).sum::<f64>()
            });
        });
    }
}

/// A thousand poses all over the workspace of CoGiRo, eight cables: from fixed points, and over pulleys from winches
/// whose wheels, swivels and motors have inertia, under position control.
fn first_frequencies_of_eight_cables(c: &mut Criterion) {
    let with_control = "gear_ratio = 3\ncontrol = \"position\"\nbandwidth_hz = 5\n";
    let with_inertia = "radius_m = 0.05\ninertia_kg_m2 = 5e-4\nswivel_inertia_kg_m2 = 3e-3\n";
    let driven = funicular_robots::COGIRO_WINCHES.replacen("gear_ratio = 3\n", with_control, 1).replacen(
        "radius_m = 0.05\n",
        with_inertia,
        1,
    );
    let entry = |i: u32, root: f64| (f64::from(i + 1) * root).fract() * 2.0 - 1.0;
    for (name, text) in [("", funicular_robots::COGIRO), (", pulleys and winches with inertia", &driven)] {
        let robot = Robot::from_toml(text).expect("the library's robot");
        let pose = |i: u32| {
            let along = [2f64, 3.0, 5.0].map(|square| entry(i, square.sqrt()));
            let turns = [7f64, 11.0, 13.0].map(|square| 5.0 * entry(i, square.sqrt()));
            Pose::new([5.0 * along[0], 3.0 * along[1], 2.0 + 1.5 * along[2]], turns)
        };
        let possible = |pose: &Pose| {
            let held = statics::inverse(&robot, pose, StaticModel::Catenary);
            held.is_ok_and(|rest| modes::first(&robot, &rest).is_ok_and(|first| first.unstable_directions == 0))
        };
        let poses: Vec<Pose> = (0..20_000).map(pose).filter(possible).take(1000).collect();
        assert_eq!(poses.len(), 1000);
        c.bench_function(&format!("1,000 poses of eight cables: statics, tensions, first frequency{name}"), |b| {
            b.iter(|| {
                let first = |pose: &Pose| {
                    let rest = statics::inverse(&robot, pose, StaticModel::Catenary).expect("possible");
                    modes::first(&robot, &rest).expect("possible").frequency_hz
                };
                black_box(&poses).iter().map(first).sum::<f64>()
            });
        });
    }
}

fn linearised(robot: &Robot, lengths: &[f64]) -> (Dynamics, Pose) {
    let rest = statics::forward(robot, lengths, StaticModel::Catenary, None).expect("converges");
    let shallow_dynamic = Linearisation { cable_model: CableModel::ShallowDynamic, ..Default::default() };
    (Dynamics::about(robot, &rest, shallow_dynamic, 20.0).expect("taut"), rest.pose)
}

fn responses(c: &mut Criterion) {
    let (robot, lengths) = robot();
    let (dynamics, pose) = linearised(&robot, &lengths);
    let frequencies: Vec<f64> = (0..10_000).map(|i| 0.002 * f64::from(i + 1)).collect();
    let along = |direction_w| response::along(&direction_w, &Vec3::zeros(), &pose);
    let (input, output) = (along(Vec3::z()), along(Vec3::y()));
    c.bench_function("frf: 10,000 frequencies, one input, one output", |b| {
        b.iter(|| response::frf(&dynamics, black_box(&frequencies), &input, &output, Quantity::Acceleration));
    });
    c.bench_function("frf: 10,000 frequencies, all 36 entries", |b| {
        b.iter(|| response::receptances(&dynamics, black_box(&frequencies)));
    });
}

fn natural_frequencies(c: &mut Criterion) {
    let (robot, lengths) = robot();
    let (dynamics, _) = linearised(&robot, &lengths);
    c.bench_function("shallow-dynamic: all modes below 20 Hz, certified", |b| {
        b.iter(|| {
            let found = modes::below(black_box(&dynamics), 20.0);
            assert!(found.certified);
            found.modes.len()
        });
    });
}

fn catenary_dynamic_cables(c: &mut Criterion) {
    let (robot, lengths) = robot();
    let linearised = |up_to_hz| {
        let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).expect("converges");
        (Dynamics::about(&robot, &rest, Linearisation::default(), up_to_hz).expect("taut"), rest.pose)
    };
    c.bench_function("catenary-dynamic: statics and set-up below 20 Hz", |b| b.iter(|| linearised(black_box(20.0))));
    c.bench_function("catenary-dynamic: statics, set-up and all modes below 20 Hz, certified", |b| {
        b.iter(|| {
            let (dynamics, _) = linearised(black_box(20.0));
            let found = modes::below(&dynamics, 20.0);
            assert!(found.certified);
            found.modes.len()
        });
    });
    let (dynamics, _) = linearised(20.0);
    let undamped = modes::below(&dynamics, 20.0);
    c.bench_function("catenary-dynamic: damped partners of all modes below 20 Hz, certified", |b| {
        b.iter(|| {
            let found = modes::damped::damped_modes(black_box(&dynamics), &undamped);
            assert!(found.certified);
            found.modes.len()
        });
    });
    let frequencies: Vec<f64> = (0..10_000).map(|i| 0.002 * f64::from(i + 1)).collect();
    c.bench_function("catenary-dynamic: set-up and frf of 10,000 frequencies, all 36 entries", |b| {
        b.iter(|| {
            let (dynamics, _) = linearised(black_box(20.0));
            response::receptances(&dynamics, &frequencies)
        });
    });
}

/// Gradients of all modes and of a response by every number of the robot file, and by ten of them.
fn gradients(c: &mut Criterion) {
    let parameters = Parameters::from_toml(funicular_robots::YUAN2014_4MM).expect("the library's robot");
    let (robot, lengths) = robot();
    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).expect("converges");
    let prepared = || Dynamics::for_gradients(&robot, &rest, Linearisation::default(), black_box(20.0)).expect("taut");
    c.bench_function("gradients: set-up below 20 Hz with the shapes of the cables", |b| b.iter(prepared));
    let dynamics = prepared();
    let found = modes::below(&dynamics, 20.0).modes;
    let changes: Vec<RobotChange> = (0..parameters.list().len()).filter_map(|i| parameters.change(i)).collect();

    c.bench_function("gradients: 147 modes by every number of the file", |b| {
        b.iter(|| {
            let gradients = Gradients::new(&robot, &rest, Hold::Lengths).expect("taut");
            let vibration = gradients.vibration(black_box(&dynamics)).expect("catenaries");
            let all = found.iter().map(|mode| vibration.frequency(mode).expect("simple"));
            all.map(|gradient| changes.iter().map(|change| gradient.dot(change)).sum::<f64>()).sum::<f64>()
        });
    });

    let frequencies: Vec<f64> = (0..100).map(|i| 0.2 * f64::from(i + 1)).collect();
    let z = Signal::Along { direction_w: Vec3::z(), point_p: Vec3::zeros() };
    let gradients = Gradients::new(&robot, &rest, Hold::Lengths).expect("taut");
    let vibration = gradients.vibration(&dynamics).expect("catenaries");
    c.bench_function("gradients: response at 100 frequencies by 10 numbers", |b| {
        b.iter(|| {
            vibration
                .responses(&[z], &[(z, Quantity::Acceleration)], black_box(&frequencies), &changes[..10])
                .expect("damped")
        });
    });
}

/// Distances of all pairs of the eight cables of CoGiRo and of the pair with the least one, one pose per iteration.
fn distances(c: &mut Criterion) {
    let robot = Robot::from_toml(funicular_robots::COGIRO).expect("the library's robot");
    let rests: Vec<Equilibrium> = (0..64)
        .filter_map(|k| {
            let turn = 2.4 * f64::from(k);
            let reach = 0.4 * f64::from(k).sqrt();
            let pose = Pose::new([reach * turn.cos(), 0.7 * reach * turn.sin(), 1.5], [0.0, 0.0, 5.0 * turn.sin()]);
            statics::inverse(&robot, &pose, StaticModel::Catenary).ok()
        })
        .collect();
    let around = Surroundings::of(&robot);
    let mut i = 0;
    let mut next = || {
        i = (i + 1) % rests.len();
        black_box(&rests[i])
    };
    c.bench_function("distances: all pairs of eight cables", |b| {
        b.iter(|| around.clearances(next(), Some(ClearanceKind::Cables)));
    });
    c.bench_function("distances: the least between cables", |b| {
        b.iter(|| around.least(next(), Some(ClearanceKind::Cables)));
    });
}

/// Calls of a control loop at 1 kHz: CoGiRo with fixed anchors and over pulleys, 1 mm on per call.
fn control_loops(c: &mut Criterion) {
    for (name, text) in [("", funicular_robots::COGIRO), (", pulleys", funicular_robots::COGIRO_WINCHES)] {
        let model = LoopModel::new(Robot::from_toml(text).expect("the library's robot")).expect("limited");
        let input = |tick: u32| {
            let x = f64::from(tick.min(4000 - tick)) * 1e-3 - 1.0;
            let mut motion = PathPoint::at_rest(&Pose::new([x, -0.5 * x, 1.5 + 0.2 * x], [0.0, 0.0, 5.0]));
            motion.velocity_w[0] = 1.0;
            LoopInput::moving(motion)
        };
        let (mut control, mut tick) = (ControlLoop::new(), 0);
        for (job, with_rates, is_cold) in
            [("cold", false, true), ("warm", false, false), ("warm, with rates", true, false)]
        {
            c.bench_function(&format!("control loop: pose to lengths, {job}{name}"), |b| {
                b.iter(|| {
                    tick = (tick + 1) % 4000;
                    if is_cold {
                        control.reset();
                    }
                    control.inverse(&model, black_box(&input(tick)), with_rates).expect("held")
                });
            });
        }

        let found: Vec<LoopState> =
            (0..4000).map(|tick| control.inverse(&model, &input(tick), false).expect("held")).collect();
        let lengths: Vec<[f64; 8]> =
            found.iter().map(|state| std::array::from_fn(|i| state.cables[i].length)).collect();
        control.forward(&model, &lengths[0], None, Some(&input(0).motion.pose)).expect("found");
        tick = 0;
        c.bench_function(&format!("control loop: lengths to pose, warm{name}"), |b| {
            b.iter(|| {
                tick = (tick + 1) % 4000;
                control.forward(&model, black_box(&lengths[tick as usize]), None, None).expect("found")
            });
        });
        let tensions: [f64; 8] = std::array::from_fn(|i| found[0].cables[i].tension_drum);
        c.bench_function(&format!("control loop: tensions to load{name}"), |b| {
            b.iter(|| control.load(&model, &input(0), black_box(&tensions)).expect("taut"));
        });
    }
}

/// Verdict, load factor and margin of a box of loads, one pose per iteration, from poses of CoGiRo whose dead load is
/// held.
fn load_factors(c: &mut Criterion) {
    let limits = TensionLimits { minimum: Some(50.0), maximum: Some(1500.0) };
    let mut robot =
        Robot::from_toml(funicular_robots::COGIRO).expect("the library's robot").with_tension_limits(limits);
    robot.required.force_w = Vec3::repeat(50.0);
    robot.required.moment_w = Vec3::repeat(10.0);
    let entry = |i: u32, root: f64| (f64::from(i + 1) * root).fract() * 2.0 - 1.0;
    let pose = |i: u32| Pose::new([2.0 * entry(i, 2f64.sqrt()), entry(i, 3f64.sqrt()), 1.5], [0.0; 3]);
    for model in [StaticModel::Ideal, StaticModel::Catenary] {
        let held = |pose: Pose| Some((pose, statics::inverse(&robot, &pose, model).ok()?));
        let poses: Vec<_> = (0..200).map(pose).filter_map(held).collect();
        let mut i = 0;
        c.bench_function(&format!("load factor: {}", model.name()), |b| {
            b.iter(|| {
                i = (i + 1) % poses.len();
                let (pose, rest) = black_box(&poses[i]);
                LoadCapacity::at(&robot, pose, model, Some(rest)).expect("a pose").load_factor_value().expect("held")
            });
        });
    }
}

/// One time of a move of CoGiRo per iteration: tensions with the inertia, lengths and their rates; with and without the
/// first frequency.
fn trajectory(c: &mut Criterion) {
    let robot = Robot::from_toml(funicular_robots::COGIRO).expect("the library's robot");
    let limits = MotionLimits { speed: 2.0, acceleration: 2.0, jerk: 20.0, ..MotionLimits::default() };
    let poses = [Pose::new([-2.0, -1.0, 1.2], [0.0; 3]), Pose::new([3.0, 1.5, 2.0], [0.0; 3])];
    let path = PlatformPath::through(&poses, &limits, CourseForm::JerkLimited, 0.0).expect("a path");
    let mut along = AlongPath::new(&robot, StaticModel::Catenary, TensionRule::Lowest, false);

    let mut k = 0;
    let mut next = || {
        k = (k + 1) % 997;
        path.at(path.duration() * f64::from(k) / 997.0)
    };
    c.bench_function("trajectory: one time of CoGiRo", |b| {
        b.iter(|| along.at(black_box(&next())).expect("held").length_rates);
    });
    c.bench_function("trajectory: one time of CoGiRo with first frequency", |b| {
        b.iter(|| {
            let motion = along.at(black_box(&next())).expect("held");
            modes::first(&robot, &motion.equilibrium).expect("vibrates").frequency_hz
        });
    });
}

/// Large motion of the robot: a release that keeps all cables taut, a move of all winches, and a drop after which the
/// cables are slack again and again.
fn simulations(c: &mut Criterion) {
    let (mut robot, lengths) = robot();
    for cable in &mut robot.cables {
        cable.material.stretch_loss.time = 1e-4;
    }
    let mut group = c.benchmark_group("simulate");
    group.sample_size(10);
    let release = |mass| SimulationEvent::Release { time: 0.0, mass, point_p: None };
    let changes = vec![-0.12, 0.1, -0.1, 0.12, 0.15, -0.1];
    let ramp = SimulationEvent::Ramp { time: 0.0, duration: 4.0, changes };
    let cases = [
        ("taut release, 20 s", 12.5, release(1.95), 20.0),
        ("move of six winches, 5 s", 10.55, ramp, 5.0),
        ("drop with slack cables, 20 s", 86.35, release(75.8), 20.0),
    ];
    for (name, mass, event, seconds) in cases {
        robot.platform.mass = mass;
        let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).expect("converges");
        let settings = SimulationSettings::default();
        group.bench_function(name, |b| {
            b.iter(|| {
                let events = std::slice::from_ref(black_box(&event));
                let mut simulation = Simulation::new(&robot, &rest, events, seconds, &settings).expect("begins");
                simulation.at(seconds).expect("goes on").pose
            });
        });
    }
    group.finish();
}

criterion_group! {
    name = jobs;
    config = Criterion::default()
        .warm_up_time(Duration::from_secs(1))
        .measurement_time(Duration::from_secs(3))
        .sample_size(30);
    targets = one_catenary, statics_both_ways, tension_distribution, centre_along_a_line, control_loops, load_factors,
    distances, trajectory, first_frequencies, first_frequencies_of_eight_cables, responses, natural_frequencies,
    catenary_dynamic_cables, gradients, simulations
}
criterion_main!(jobs);
