//! Responses of robots on supports: derivatives of forward statics, reciprocity, closed forms, and motions of the
//! frame.

use super::{Behind, at_rest, closed_form, cogiro, lengths, platform_responses, taut, with_servos};
use funicular::cable::CableModel;
use funicular::cable::catenary_dynamic::DriveSignal;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{CDMat, CMat3, Complex, Rotation, Vec3};
use funicular::response::{self, FrameInput, Port, Quantity, Signal};
use funicular::robot::Robot;
use funicular::statics::{self, CableState, Equilibrium, StaticModel};
use std::f64::consts::TAU;

/// Signals of drives and points of cables: at rest the derivatives of forward statics, and reciprocal at any frequency.
#[test]
fn responses_include_the_supports() {
    for behind in Behind::ALL {
        let robot = cogiro(behind);
        let rest = at_rest(&robot);
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 6.0).unwrap();
        let along = |direction_w: Vec3| Signal::Along { direction_w, point_p: Vec3::zeros() };
        let drive = |cable: usize, signal: DriveSignal| Signal::Drive { cable, signal };
        let responses = |hz: f64, inputs: &[Signal], outputs: &[Signal], loaded: bool| {
            let inputs = Port::all(&robot, &rest, &dynamics, inputs, loaded).unwrap();
            let outputs = Port::all(&robot, &rest, &dynamics, outputs, loaded).unwrap();
            let outputs: Vec<(Port, Quantity)> = outputs.into_iter().map(|p| (p, Quantity::Displacement)).collect();
            response::matrix(&dynamics, &[hz], &inputs, &outputs).unwrap().iter().map(|row| row[0]).collect::<Vec<_>>()
        };

        // A length that is paid out: motion of the platform, and tensions of cables on this support and others.
        let outputs = [
            along(Vec3::x()),
            along(Vec3::z()),
            drive(1, DriveSignal::Tension),
            drive(0, DriveSignal::DrumTension),
            drive(1, DriveSignal::DrumTension),
            drive(6, DriveSignal::Tension),
        ];
        let found = responses(1e-4, &[drive(0, DriveSignal::Length)], &outputs, false);
        let step = 1e-6;
        let [ahead, back] = [step, -step].map(|amount| {
            let mut lengths = lengths(&rest);
            lengths[0] += amount;
            statics::forward(&robot, &lengths, StaticModel::Catenary, Some(&rest.pose)).unwrap()
        });
        let measured = |at: &Equilibrium| {
            let (p, cables) = (at.pose.position_w, &at.cables);
            let tensions = [cables[1].tension_platform, cables[0].tension_drum(), cables[1].tension_drum()];
            [p.x, p.z, tensions[0], tensions[1], tensions[2], cables[6].tension_platform]
        };
        for (k, (found, (ahead, back))) in found.iter().zip(measured(&ahead).iter().zip(measured(&back))).enumerate() {
            let difference = (ahead - back) / (2.0 * step);
            // Rounding of the equilibria over the step; a bent cable adds its linearised turn to the tension.
            assert!(
                (found.re - difference).abs() < 2e-5 * difference.abs().max(1.0),
                "{behind:?}, {k}: {found} {difference}"
            );
        }

        // Reciprocity between the platform, points of cables on one support and on two, and lengths.
        let point = |cable: usize| Signal::OnCable { cable, fraction: 0.4, direction_w: Vec3::new(0.3, 0.2, 1.0) };
        let ports = [along(Vec3::y()), point(0), point(1), point(5)];
        let both = Port::all(&robot, &rest, &dynamics, &ports, true).unwrap();
        let outputs: Vec<(Port, Quantity)> = both.iter().map(|p| (p.clone(), Quantity::Displacement)).collect();
        let all = response::matrix(&dynamics, &[3.7], &both, &outputs).unwrap();
        for i in 0..4 {
            for j in 0..4 {
                let (one, other) = (all[4 * i + j][0], all[4 * j + i][0]);
                assert!((one - other).norm() < 1e-9 * one.norm(), "{behind:?}, {i} {j}: {one} {other}");
            }
        }
    }
}

/// The base moves with the feet of all supports: against the closed form of straight cables, and rigidly at rest.
#[test]
fn supports_stand_on_the_base() {
    let robot = taut("damping_ratio = 0.02\n");
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 60.0).unwrap();
    let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
    let inputs = axes.map(|axis| Signal::Frame(FrameInput::BaseAlong(axis)));
    let outputs = axes.map(|direction_w| Signal::Along { direction_w, point_p: Vec3::zeros() });
    for hz in [0.7, 4.1, 11.3, 23.7, 55.0] {
        let found = platform_responses(&robot, &rest, &dynamics, hz, &inputs, &outputs);
        let own = Complex::from((hz * TAU).powi(2));
        let square = own * Complex::new(1.0, -0.02);
        let all = closed_form(&robot, &rest, own, square, 1.0);

        // Forces by the feet: as if every anchor moved, less the forces of the supports' own stiffness.
        let mut forces = CDMat::from_element(9, 3, Complex::new(0.0, 0.0));
        let anchored = closed_form_of_anchors(&robot, &rest, square);
        for i in 0..3 {
            for j in 0..3 {
                forces[(i, j)] = -anchored[(i, j)];
                for (k, support) in robot.supports.iter().enumerate() {
                    let at = 3 + 3 * k;
                    let spring = support.stiffness_w[(i, j)] * Complex::new(1.0, 2.0 * support.damping_ratio);
                    forces[(at + i, j)] = spring - all[(at + i, at + j)];
                }
            }
        }
        let moved = all.lu().solve(&forces).unwrap();
        let size = moved.view((0, 0), (3, 3)).norm();
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            // The error of the cables' discretisation, near resonances.
            let gap = (found[3 * i + j] - moved[(i, j)]).norm();
            assert!(gap < 1e-7 * size, "{hz} Hz, {i} {j}: {} {}", found[3 * i + j], moved[(i, j)]);
        }
    }

    for behind in Behind::ALL {
        let robot = cogiro(behind);
        let rest = at_rest(&robot);
        for cable_model in [CableModel::CatenaryStatic, CableModel::CatenaryDynamic] {
            let linearisation = Linearisation { cable_model, ..Linearisation::default() };
            let dynamics = Dynamics::about(&robot, &rest, linearisation, 6.0).unwrap();
            let found = platform_responses(&robot, &rest, &dynamics, 1e-4, &inputs, &outputs);
            for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                let rigid = if i == j { 1.0 } else { 0.0 };
                let gap = (found[3 * i + j] - rigid).norm();
                assert!(gap < 1e-7, "{behind:?}, {cable_model}, {i} {j}: {}", found[3 * i + j]);
            }
        }
    }
}

/// Force on the platform of [`taut`] by a motion of all anchors at the square ω_c², less its sign.
fn closed_form_of_anchors(robot: &Robot, rest: &Equilibrium, square: Complex) -> CMat3 {
    let of_cable = |(cable, state): (&funicular::robot::Cable, &CableState)| {
        let (ea, m, length) = (cable.material.axial_stiffness, cable.material.mass_per_length, state.unstrained_length);
        let across = ea * state.tension_platform / (ea + state.tension_platform);
        let t = state.chord_w().normalize();
        let along = (t * t.transpose()).map(Complex::from);
        let far = |c: f64| {
            let kappa = (square * (m / c)).sqrt();
            -c * kappa / (kappa * length).sin()
        };
        along * far(ea) + (CMat3::identity() - along) * far(across)
    };
    robot.cables.iter().zip(&rest.cables).map(of_cable).sum()
}

/// Turning motion of the base and motion of the foot of one support, at any frequency: against the closed form of
/// straight cables. A base that turns moves every anchor differently; the mass of a support is in the middle of its
/// anchors.
#[test]
fn a_turning_base_and_a_moving_foot_have_their_closed_form() {
    let robot = taut("damping_ratio = 0.02\n");
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 60.0).unwrap();
    let outputs =
        [Vec3::x(), Vec3::y(), Vec3::z()].map(|direction_w| Signal::Along { direction_w, point_p: Vec3::zeros() });
    let axis_w = Vec3::new(0.3, -0.5, 0.8);
    let foot_w = Vec3::new(0.6, 0.7, -0.2);
    let post = robot.cables[0].anchor.support.unwrap();
    let inputs = [
        Signal::Frame(FrameInput::BaseAbout(axis_w)),
        Signal::Frame(FrameInput::Anchor { cable: 1, direction_w: foot_w }),
    ];

    for hz in [0.7, 4.1, 11.3, 23.7, 55.0] {
        let found = platform_responses(&robot, &rest, &dynamics, hz, &inputs, &outputs);
        let own = Complex::from((hz * TAU).powi(2));
        let square = own * Complex::new(1.0, -0.02);
        let all = closed_form(&robot, &rest, own, square, 1.0);
        let mut forces = CDMat::from_element(9, 2, Complex::new(0.0, 0.0));

        // The spring of the post pulls at it by the motion of its foot.
        let of_post = &robot.supports[post];
        let pull = of_post.stiffness_w * foot_w.normalize();
        for k in 0..3 {
            forces[(3 + 3 * post + k, 1)] = pull[k] * Complex::new(1.0, 2.0 * of_post.damping_ratio);
        }

        // The base turns every anchor about the origin, and the forces on a support with it.
        let turn_w = axis_w.normalize();
        let anchored = closed_form_by_cable(&robot, &rest, square);
        for (i, (cable, state)) in robot.cables.iter().zip(&rest.cables).enumerate() {
            let moved_w = turn_w.cross(&state.anchor_w).map(Complex::from);
            let [near, far] = &anchored[i];
            for k in 0..3 {
                forces[(k, 0)] -= (far * moved_w)[k];
            }
            if let Some(support) = cable.anchor.support {
                let turned = turn_w.cross(&state.force_on_platform_w);
                for k in 0..3 {
                    forces[(3 + 3 * support + k, 0)] += -(near * moved_w)[k] + turned[k];
                }
            }
        }
        let mut places = [Vec3::zeros(); 2];
        for (support, place_w) in places.iter_mut().enumerate() {
            let of: Vec<Vec3> = (robot.cables.iter().zip(&rest.cables))
                .filter(|(cable, _)| cable.anchor.support == Some(support))
                .map(|(_, state)| state.anchor_w)
                .collect();
            *place_w = of.iter().sum::<Vec3>() / of.len() as f64;
            for k in 0..3 {
                forces[(3 + 3 * support + k, 0)] += own * robot.supports[support].mass * turn_w.cross(place_w)[k];
            }
        }

        let moved = all.lu().solve(&forces).unwrap();
        for j in 0..2 {
            let size = moved.view((0, j), (3, 1)).norm();
            for i in 0..3 {
                // The error of the cables' discretisation, near resonances.
                let gap = (found[2 * i + j] - moved[(i, j)]).norm();
                assert!(gap < 1e-7 * size, "{hz} Hz, {i} {j}: {} {}", found[2 * i + j], moved[(i, j)]);
            }
        }
    }
}

/// Stiffness of each cable of [`taut`] at the square ω_c²: of an end by its own motion, and by that of the other end.
fn closed_form_by_cable(robot: &Robot, rest: &Equilibrium, square: Complex) -> Vec<[CMat3; 2]> {
    let of_cable = |(cable, state): (&funicular::robot::Cable, &CableState)| {
        let (ea, m, length) = (cable.material.axial_stiffness, cable.material.mass_per_length, state.unstrained_length);
        let across = ea * state.tension_platform / (ea + state.tension_platform);
        let t = state.chord_w().normalize();
        let along = (t * t.transpose()).map(Complex::from);
        let wave = |c: f64| {
            let kappa = (square * (m / c)).sqrt();
            let phase = kappa * length;
            [c * kappa * phase.cos() / phase.sin(), -c * kappa / phase.sin()]
        };
        let (axial, transverse) = (wave(ea), wave(across));
        [0, 1].map(|k| along * axial[k] + (CMat3::identity() - along) * transverse[k])
    };
    robot.cables.iter().zip(&rest.cables).map(of_cable).collect()
}

/// Towards zero frequency, motions of the frame are forward statics of the moved robot: a base that turns with anchors,
/// swivel axes and springs of the supports, and the foot of a support. A drum on the ground stays there while the foot
/// moves.
#[test]
fn slow_motions_of_the_frame_are_statics_of_the_moved_robot() {
    let outputs = [Vec3::x(), Vec3::y(), Vec3::z()];
    let along = outputs.map(|direction_w| Signal::Along { direction_w, point_p: Vec3::zeros() });
    let about = outputs.map(|axis_w| Signal::About { axis_w });
    let signals: Vec<Signal> = along.into_iter().chain(about).collect();
    for behind in Behind::ALL {
        let robot = cogiro(behind);
        let rest = at_rest(&robot);
        let axis_w = Vec3::new(0.4, 1.0, -0.3).normalize();
        let foot_w = match behind {
            Behind::DrumsOnGround => robot.cables[2].anchor.pulley.as_ref().unwrap().entry_direction_w,
            _ => Vec3::new(0.5, -0.4, 1.0).normalize(),
        };
        let inputs = [
            Signal::Frame(FrameInput::BaseAbout(axis_w)),
            Signal::Frame(FrameInput::Anchor { cable: 2, direction_w: foot_w }),
        ];

        // Forward statics of moved robots.
        let turned = |angle: f64| {
            let turn = Rotation::from_scaled_axis(axis_w * angle).to_rotation_matrix().into_inner();
            let mut moved = robot.clone();
            for cable in &mut moved.cables {
                cable.anchor.point_w = turn * cable.anchor.point_w;
                if let Some(pulley) = &mut cable.anchor.pulley {
                    pulley.entry_direction_w = turn * pulley.entry_direction_w;
                }
            }
            for support in &mut moved.supports {
                support.stiffness_w = turn * support.stiffness_w * turn.transpose();
            }
            moved
        };
        let shifted = |amount: f64| {
            let mut moved = robot.clone();
            let support = robot.cables[2].anchor.support;
            for cable in moved.cables.iter_mut().filter(|cable| cable.anchor.support == support) {
                cable.anchor.point_w += foot_w * amount;
                if let (Behind::DrumsOnGround, Some(winch)) = (behind, &mut cable.anchor.winch) {
                    winch.drum_side_length += amount;
                }
            }
            moved
        };
        let difference = |moved: &dyn Fn(f64) -> Robot| {
            let step = 1e-5;
            let [ahead, back] = [step, -step].map(|amount| {
                let found = statics::forward(&moved(amount), &lengths(&rest), StaticModel::Catenary, Some(&rest.pose));
                found.unwrap().pose
            });
            let turn = (ahead.rot_wp * back.rot_wp.inverse()).scaled_axis();
            let move_w = (ahead.position_w - back.position_w) / (2.0 * step);
            (turn / (2.0 * step), move_w)
        };
        let exact = [difference(&turned), difference(&shifted)];

        for cable_model in [CableModel::CatenaryStatic, CableModel::CatenaryDynamic] {
            let linearisation = Linearisation { cable_model, ..Linearisation::default() };
            let dynamics = Dynamics::about(&robot, &rest, linearisation, 6.0).unwrap();
            let found = platform_responses(&robot, &rest, &dynamics, 1e-4, &inputs, &signals);
            for (j, (turn, moved)) in exact.iter().enumerate() {
                let size = moved.norm();
                for i in 0..3 {
                    // The square of the step, and rounding of the equilibria over it.
                    let (translation, rotation) = (found[2 * i + j].re, found[2 * (3 + i) + j].re);
                    assert!(
                        (translation - moved[i]).abs() < 2e-6 * size && (rotation - turn[i]).abs() < 2e-6 * size,
                        "{behind:?}, {cable_model}, {j} {i}: {translation} {}, {rotation} {}",
                        moved[i],
                        turn[i]
                    );
                }
            }
        }
    }
}

/// The base moves all feet, so that its response is the sum of those to the feet if the drums are on the supports: with
/// servos, and with drum sides that have mass.
#[test]
fn the_base_is_the_sum_of_the_feet() {
    for behind in [Behind::Nothing, Behind::DrumsOnSupports] {
        let robot = with_servos(cogiro(behind));
        let rest = at_rest(&robot);
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 4.0).unwrap();
        let direction_w = Vec3::new(0.5, -0.7, 0.3);
        let base = Signal::Frame(FrameInput::BaseAlong(direction_w));
        let foot = |cable: usize| Signal::Frame(FrameInput::Anchor { cable, direction_w });
        let outputs = [
            Signal::Along { direction_w: Vec3::x(), point_p: Vec3::zeros() },
            Signal::About { axis_w: Vec3::y() },
            Signal::OnCable { cable: 3, fraction: 0.3, direction_w: Vec3::z() },
            Signal::Drive { cable: 3, signal: DriveSignal::Tension },
            Signal::Drive { cable: 3, signal: DriveSignal::DrumTension },
        ];
        for hz in [0.6, 2.3, 3.7] {
            let one = platform_responses(&robot, &rest, &dynamics, hz, &[base], &outputs);
            // Each post has two cables.
            let feet: Vec<Signal> = [0, 3, 4, 7].map(foot).into();
            let four = platform_responses(&robot, &rest, &dynamics, hz, &feet, &outputs);
            for (i, one) in one.iter().enumerate() {
                let sum: Complex = four[4 * i..4 * i + 4].iter().sum();
                let size: f64 = four[4 * i..4 * i + 4].iter().map(|part| part.norm()).sum();
                assert!((one - sum).norm() < 1e-8 * size, "{behind:?}, {hz} Hz, {i}: {one} {sum}");
            }
        }
    }
}
