//! Motions of the base and of anchors as inputs, against forward statics of moved robots and against identities.

use super::{cogiro, lengths};
use funicular::cable::CableModel;
use funicular::cable::catenary_dynamic::DriveSignal;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Complex, Rotation, Vec3};
use funicular::response::{self, FrameInput, Port, Quantity, Signal};
use funicular::robot::{DrumSide, GuideWheel, Pose, Robot};
use funicular::statics::{self, CableState, Equilibrium, StaticModel, TensionRule};
use proptest::prelude::*;

/// CoGiRo with pulleys and winches at a pose, its swivel axes inclined by `incline`, with the lengths of that pose.
fn at_rest(incline: f64) -> (Robot, Equilibrium) {
    let mut robot = cogiro(0.06);
    for (i, cable) in robot.cables.iter_mut().enumerate() {
        let pulley = cable.anchor.pulley.as_mut().unwrap();
        pulley.entry_direction_w = Vec3::new(incline, -0.5 * incline * (i % 2) as f64, 1.0).normalize();
    }
    let pose = Pose::new([1.0, 2.0, 1.5], [2.0, -1.0, 5.0]);
    let held = statics::inverse(&robot, &pose, StaticModel::Catenary).unwrap();
    let rest = statics::forward(&robot, &lengths(&held), StaticModel::Catenary, Some(&held.pose)).unwrap();
    (robot, rest)
}

/// Motions of the platform along and about the axes of the world.
fn motions() -> Vec<Signal> {
    let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
    let along = axes.map(|direction_w| Signal::Along { direction_w, point_p: Vec3::zeros() });
    along.into_iter().chain(axes.map(|axis_w| Signal::About { axis_w })).collect()
}

/// Responses of `outputs` to motions of the frame at one frequency [Hz], by columns.
fn responses(
    robot: &Robot,
    rest: &Equilibrium,
    dynamics: &Dynamics,
    hz: f64,
    inputs: &[Signal],
    outputs: &[Signal],
) -> Vec<Vec<Complex>> {
    let inputs = Port::all(robot, rest, dynamics, inputs, false).unwrap();
    let outputs: Vec<(Port, Quantity)> = Port::all(robot, rest, dynamics, outputs, false)
        .unwrap()
        .into_iter()
        .map(|p| (p, Quantity::Displacement))
        .collect();
    let all = response::matrix(dynamics, &[hz], &inputs, &outputs).unwrap();
    (0..inputs.len()).map(|k| (0..outputs.len()).map(|o| all[o * inputs.len() + k][0]).collect()).collect()
}

/// Robot after a small motion of the frame: `amount` times the unit motion.
fn moved(robot: &Robot, input: &FrameInput, amount: f64) -> Robot {
    let mut robot = robot.clone();
    for (i, cable) in robot.cables.iter_mut().enumerate() {
        let anchor = &mut cable.anchor;
        match input {
            FrameInput::BaseAlong(direction_w) => anchor.point_w += direction_w * amount,
            FrameInput::BaseAbout(axis_w) => {
                let turn = Rotation::from_scaled_axis(axis_w * amount);
                anchor.point_w = turn * anchor.point_w;
                if let Some(pulley) = &mut anchor.pulley {
                    pulley.entry_direction_w = turn * pulley.entry_direction_w;
                }
            }
            FrameInput::Anchor { cable, direction_w } if *cable == i => {
                anchor.point_w += direction_w * amount;
                // A drum side that leads to the pulley gets longer; without one the end moves with the anchor.
                if let (Some(pulley), Some(winch)) = (&anchor.pulley, &mut anchor.winch) {
                    winch.drum_side_length += pulley.entry_direction_w.dot(direction_w) * amount;
                }
            }
            FrameInput::Anchor { .. } => {}
        }
    }
    robot
}

#[test]
fn at_rest_the_platform_follows_the_frame_as_forward_statics_say() {
    let axes = [Vec3::x(), Vec3::y(), Vec3::z(), Vec3::new(0.6, 0.0, 0.8)];
    let inputs: Vec<FrameInput> = (axes.iter().map(|axis| FrameInput::BaseAlong(*axis)))
        .chain(axes.iter().map(|axis| FrameInput::BaseAbout(*axis)))
        .chain(axes.iter().map(|axis| FrameInput::Anchor { cable: 3, direction_w: *axis }))
        .collect();
    let signals: Vec<Signal> = inputs.iter().map(|input| Signal::Frame(*input)).collect();
    let tensions = [DriveSignal::Tension, DriveSignal::DrumTension].map(|signal| Signal::Drive { cable: 3, signal });

    // Differences over 2e-5 m are exact to 2e-6 here; with inclined axes the stiffness is exact to the square of the
    // kink.
    for (incline, tolerance) in [(0.0, 2e-6), (0.4, 2e-5)] {
        let (robot, rest) = at_rest(incline);
        for cable_model in [CableModel::CatenaryDynamic, CableModel::CatenaryStatic] {
            let dynamics =
                Dynamics::about(&robot, &rest, Linearisation { cable_model, ..Default::default() }, 1.0).unwrap();
            // Cables without vibration have no signals of drives.
            let tensions = if cable_model.is_dynamic() { &tensions[..] } else { &[] };
            let outputs = [&motions(), tensions].concat();
            let found = responses(&robot, &rest, &dynamics, 1e-5, &signals, &outputs);

            for (input, found) in inputs.iter().zip(&found) {
                let amount = 1e-5;
                let at = |amount: f64| {
                    let robot = moved(&robot, input, amount);
                    statics::forward(&robot, &lengths(&rest), StaticModel::Catenary, Some(&rest.pose)).unwrap()
                };
                let (more, less) = (at(amount), at(-amount));
                let (plus, minus) = (&more.pose, &less.pose);
                let along = (plus.position_w - minus.position_w) / (2.0 * amount);
                let turn = plus.rot_wp * minus.rot_wp.inverse();
                let about = turn.scaled_axis() / (2.0 * amount);
                let both = |cable: &CableState| [cable.tension_platform, cable.tension_drum()];
                let [plus, minus] = [both(&more.cables[3]), both(&less.cables[3])];
                let by_tension = [0, 1].map(|i| (plus[i] - minus[i]) / (2.0 * amount));

                // Motions by their largest, tensions by the stiffness of the cable.
                let motion: Vec<f64> = along.iter().chain(about.iter()).copied().collect();
                let size = motion.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
                let stiffness = rest.cables[3].tangent_w().unwrap().amax();
                let expected = motion.iter().map(|x| (*x, size)).chain(by_tension.map(|t| (t, size * stiffness)));
                for (found, (expected, size)) in found.iter().zip(expected) {
                    assert!(
                        (found.re - expected).abs() < tolerance * size && found.im.abs() < 1e-3 * size,
                        "{cable_model} {input:?}: {found} {expected}"
                    );
                }
            }
        }
    }
}

/// Numbers of a random frame under heavy ropes.
#[derive(Debug, Clone)]
struct Frame {
    radius: f64,
    mass_per_length: f64,
    axial_stiffness: f64,
    /// Stiffness of the winches [N/m]; rigid beyond 1e7.
    winch: f64,
    guides: usize,
    rod: bool,
    /// Cables without a winch, without a pulley.
    without: [usize; 2],
}

fn frames() -> impl Strategy<Value = Frame> {
    let rope = (-2.0..0.8_f64, 5.3..6.8_f64);
    (0.01..0.3_f64, rope, 4.5..7.5_f64, 0..3_usize, any::<bool>(), [0..8_usize, 0..8]).prop_map(
        |(radius, (mass, stiffness), winch, guides, rod, without)| Frame {
            radius,
            mass_per_length: 10_f64.powf(mass),
            axial_stiffness: 10_f64.powf(stiffness),
            winch: 10_f64.powf(winch),
            guides,
            rod,
            without,
        },
    )
}

impl Frame {
    fn at_rest(&self) -> Option<(Robot, Equilibrium)> {
        let mut robot = cogiro(self.radius);
        robot.platform.mass = 600.0;
        for (i, cable) in robot.cables.iter_mut().enumerate() {
            cable.material.mass_per_length = self.mass_per_length;
            cable.material.axial_stiffness = self.axial_stiffness;
            let winch = cable.anchor.winch.as_mut()?;
            winch.stiffness = if self.winch < 1e7 { self.winch } else { f64::INFINITY };
            winch.drum_side = if self.rod { DrumSide::Rod } else { DrumSide::Massless };
            let wheel = |k: usize| GuideWheel { name: format!("{k}"), distance: 1.0 + 1.5 * k as f64, mass: 0.2 };
            winch.guide_wheels = (0..self.guides).map(wheel).collect();
            if self.without[0] == i {
                cable.anchor.winch = None;
            }
            if self.without[1] == i {
                (cable.anchor.pulley, cable.anchor.winch) = (None, None);
            }
        }
        let pose = Pose::new([1.0, 2.0, 1.5], [2.0, -1.0, 5.0]);
        let held =
            statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, &TensionRule::Closest(vec![2500.0]))
                .ok()?;
        let rest = statics::forward(&robot, &lengths(&held), StaticModel::Catenary, Some(&held.pose)).ok()?;
        (rest.residual < 1e-11).then_some((robot, rest))
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..Default::default() })]

    /// The platform follows slow motions of the frame as forward statics of the moved robot say, also with ropes whose
    /// weight on the wheels counts: motions, and the tensions of a cable. Vertical swivel axes, whose end stiffness is
    /// exact. The differences extrapolate the square of the step; forward statics leaves 1e-12 of the tensions.
    #[test]
    fn slow_motions_of_the_frame_are_those_of_statics(frame in frames(),
        axis in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0]) {
        let Some((robot, rest)) = frame.at_rest() else { return Err(TestCaseError::reject("no such rest")) };
        let axis = Vec3::from(axis).normalize();
        let of = |cable: usize| FrameInput::Anchor { cable, direction_w: axis };
        let inputs = [FrameInput::BaseAbout(axis), FrameInput::BaseAlong(axis), of(3), of(frame.without[0]),
            of(frame.without[1])];
        let signals: Vec<Signal> = inputs.iter().map(|input| Signal::Frame(*input)).collect();
        let tensions = [DriveSignal::Tension, DriveSignal::DrumTension].map(|signal| Signal::Drive { cable: 3,
            signal });

        for cable_model in [CableModel::CatenaryDynamic, CableModel::CatenaryStatic] {
            let Ok(dynamics) = Dynamics::about(&robot, &rest, Linearisation { cable_model, ..Default::default() }, 1.0)
            else { return Err(TestCaseError::reject("no such model")) };
            let has_tension = cable_model.is_dynamic() && !frame.without.contains(&3);
            let of_tension = tensions.into_iter().filter(|_| has_tension);
            let outputs: Vec<Signal> = motions().into_iter().chain(of_tension).collect();
            let found = responses(&robot, &rest, &dynamics, 1e-6, &signals, &outputs);

            for (input, found) in inputs.iter().zip(&found) {
                let at = |amount: f64| {
                    let moved = moved(&robot, input, amount);
                    statics::forward(&moved, &lengths(&rest), StaticModel::Catenary, Some(&rest.pose)).ok()
                };
                let difference = |amount: f64| -> Option<Vec<f64>> {
                    let (more, less) = (at(amount)?, at(-amount)?);
                    let along = more.pose.position_w - less.pose.position_w;
                    let about = (more.pose.rot_wp * less.pose.rot_wp.inverse()).scaled_axis();
                    let [more, less] = [more, less].map(|rest| [rest.cables[3].tension_platform,
                        rest.cables[3].tension_drum()]);
                    let all = along.iter().chain(about.iter()).copied().chain((0..2).map(|k| more[k] - less[k]));
                    Some(all.map(|change| change / (2.0 * amount)).collect())
                };
                let (Some(coarse), Some(fine)) = (difference(4e-4), difference(2e-4)) else { continue };
                let expected: Vec<f64> = coarse.iter().zip(&fine).map(|(coarse,
                    fine)| fine + (fine - coarse) / 3.0).collect();

                let size = expected[..6].iter().fold(0.0_f64, |size, x| size.max(x.abs()));
                let force = size * rest.cables[3].tangent_w().unwrap().amax();
                for (k, (found, expected)) in found.iter().zip(&expected).enumerate() {
                    let size = if k < 6 { size } else { force };
                    prop_assert!((found.re - expected).abs() < 1e-7 * size, "{cable_model} {input:?} {k}: {found} \
                        {expected} of {size}");
                }
            }
        }
    }
}

#[test]
fn anchor_and_drum_together_are_the_anchor_and_paid_out_length() {
    let (mut robot, rest) = at_rest(0.0);
    for drum_side in [DrumSide::Massless, DrumSide::Rod] {
        for cable in &mut robot.cables {
            let winch = cable.anchor.winch.as_mut().unwrap();
            (winch.drum_side, winch.stiffness) = (drum_side, f64::INFINITY);
        }
        let direction_w = Vec3::new(0.3, -0.5, 0.7).normalize();
        {
            let rest = statics::forward(&robot, &lengths(&rest), StaticModel::Catenary, Some(&rest.pose)).unwrap();
            let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 20.0).unwrap();
            let count = robot.cables.len();
            let anchors = (0..count).map(|cable| Signal::Frame(FrameInput::Anchor { cable, direction_w }));
            let lengths = (0..count).map(|cable| Signal::Drive { cable, signal: DriveSignal::Length });
            let base = Signal::Frame(FrameInput::BaseAlong(direction_w));
            let inputs: Vec<Signal> = anchors.chain(lengths).chain([base]).collect();
            let outputs: Vec<Signal> =
                motions().into_iter().chain([Signal::Drive { cable: 2, signal: DriveSignal::Tension }]).collect();

            for hz in [0.4, 3.1, 17.0] {
                let found = responses(&robot, &rest, &dynamics, hz, &inputs, &outputs);
                for (output, base) in found[2 * count].iter().enumerate() {
                    // A drum that follows its anchor towards the wheel pays that length out.
                    let sum: Complex = (0..count)
                        .map(|i| {
                            let stretch =
                                1.0 + rest.cables[i].tension_drum() / robot.cables[i].material.axial_stiffness;
                            let along =
                                robot.cables[i].anchor.pulley.as_ref().unwrap().entry_direction_w.dot(&direction_w);
                            found[i][output] + found[count + i][output] * (along / stretch)
                        })
                        .sum();
                    let size = (0..count).map(|i| found[i][output].norm()).sum::<f64>();
                    // The anchor moves the entry point, the length is paid out at the stretch of the drum side: these
                    // differ by the change of the stretch over the wheel, the weight of the length on it over EA.
                    assert!((sum - base).norm() < 1e-6 * size, "{drum_side:?} {hz} Hz {output}: {sum} {base}");
                }
            }
        }
    }
}

#[test]
fn the_far_end_of_a_cable_moves_with_its_anchor() {
    let robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let direction_w = Vec3::new(0.3, -0.5, 0.7).normalize();
    let input = [Signal::Frame(FrameInput::BaseAlong(direction_w))];
    let point = |fraction: f64| Signal::OnCable { cable: 4, fraction, direction_w };
    for cable_model in [CableModel::CatenaryDynamic, CableModel::Spring] {
        let dynamics =
            Dynamics::about(&robot, &rest, Linearisation { cable_model, ..Default::default() }, 30.0).unwrap();
        for hz in [0.1, 4.0, 23.0] {
            let found = responses(&robot, &rest, &dynamics, hz, &input, &[point(1.0)]);
            assert!((found[0][0] - 1.0).norm() < 1e-9, "{cable_model} {hz}: {}", found[0][0]);
        }
        // Slow motion is that of a rigid body.
        let found = responses(&robot, &rest, &dynamics, 1e-4, &input, &[point(0.3)]);
        assert!((found[0][0] - 1.0).norm() < 1e-4, "{cable_model}: {}", found[0][0]);
    }
}

#[test]
fn shallow_cables_transmit_the_motion_of_the_base_as_catenaries_do() {
    let mut robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    // Light cables hardly sag.
    for cable in &mut robot.cables {
        cable.material.mass_per_length *= 0.2;
    }
    let pose = Pose::new([0.0, 0.0, 1.5], [0.0; 3]);
    let rest = statics::inverse(&robot, &pose, StaticModel::Catenary).unwrap();
    let inputs = [Vec3::x(), Vec3::y(), Vec3::z()].map(|axis| Signal::Frame(FrameInput::BaseAlong(axis)));
    let of = |cable_model: CableModel, hz: f64| {
        let dynamics =
            Dynamics::about(&robot, &rest, Linearisation { cable_model, ..Default::default() }, 30.0).unwrap();
        responses(&robot, &rest, &dynamics, hz, &inputs, &motions())
    };
    // The shallow model has no inertia along the chord, whose effect grows with the square of the frequency and with
    // the amplification: up to 1e-3 at 4 Hz, where the platform moves three times as far as the base.
    for (hz, tolerance) in [(0.5, 1e-3), (2.0, 1e-3), (4.0, 3e-3)] {
        let (shallow, exact) = (of(CableModel::ShallowDynamic, hz), of(CableModel::CatenaryDynamic, hz));
        let size = exact.iter().flatten().map(|x| x.norm()).fold(0.0, f64::max);
        for (shallow, exact) in shallow.iter().flatten().zip(exact.iter().flatten()) {
            assert!((shallow - exact).norm() < tolerance * size, "{hz} Hz: {shallow} {exact} of {size}");
        }
    }
}

#[test]
fn tensions_at_fixed_anchors_begin_at_the_derivative_of_statics() {
    let robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let drive = |signal: DriveSignal| Signal::Drive { cable: 3, signal };
    let push = Signal::Along { direction_w: Vec3::y(), point_p: Vec3::zeros() };
    let anchor = FrameInput::Anchor { cable: 3, direction_w: Vec3::new(0.0, 0.6, 0.8) };
    let inputs = [drive(DriveSignal::Length), push, Signal::Frame(anchor)];
    let outputs = [drive(DriveSignal::Tension), drive(DriveSignal::DrumTension)];
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 1.0).unwrap();
    let found = responses(&robot, &rest, &dynamics, 1e-5, &inputs, &outputs);

    for (input, found) in found.iter().enumerate() {
        let amount = [1e-5, 1e-2, 1e-5][input];
        let at = |amount: f64| {
            let (mut robot, mut lengths) = (robot.clone(), lengths(&rest));
            match input {
                0 => lengths[3] += amount,
                1 => robot.load.force_w.y += amount,
                _ => robot.cables[3].anchor.point_w += Vec3::new(0.0, 0.6, 0.8) * amount,
            }
            let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, Some(&rest.pose)).unwrap();
            [rest.cables[3].tension_platform, rest.cables[3].tension_anchor]
        };
        let (more, less) = (at(amount), at(-amount));
        for (i, found) in found.iter().enumerate() {
            let expected = (more[i] - less[i]) / (2.0 * amount);
            assert!((found.re / expected - 1.0).abs() < 1e-5, "{input} {i}: {found} {expected}");
        }
    }
}
