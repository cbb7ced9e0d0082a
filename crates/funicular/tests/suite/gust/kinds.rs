//! Gusts on robots with posts, winches and planar platforms: against the frequency response of the damped robot, and,
//! for slow gusts, against forward statics in another wind. The tension of a cable that sags out of the plane of a
//! planar platform is refused.

use super::{along, tension};
use crate::support::{self, Behind};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::gust::Gusts;
use funicular::math::Vec3;
use funicular::response::{self, Quantity, Signal};
use funicular::robot::{Pose, Robot, State, Turbulence, TurbulenceSpectrum, WinchMode, Wind};
use funicular::statics::{self, Equilibrium, StaticModel, TensionRule};

/// Mean wind of these tests [m/s].
const SPEED: f64 = 10.0;

/// Upper limit of the frequencies of these tests [Hz].
const UP_TO_HZ: f64 = 6.0;

/// Robots with their poses and their names: posts, posts with drives, winches, and a platform in a plane.
fn robots() -> [(&'static str, Robot, Pose); 4] {
    let pose = Pose::new([0.0, 0.0, 1.5], [0.0; 3]);
    let of = |text: &str| Robot::from_toml(text).unwrap();
    [
        ("posts", support::cogiro(Behind::Nothing), pose),
        ("posts with drums", support::cogiro(Behind::DrumsOnGround), pose),
        ("winches", of(funicular_robots::COGIRO_WINCHES), pose),
        ("planar", of(funicular_robots::KNTU_PLANAR), Pose::new([0.1, 0.2, 0.0], [0.0; 3])),
    ]
}

/// Robot in gusts along x, which agree everywhere, at rest in its mean wind.
fn in_wind(mut robot: Robot, pose: Pose, drag_width: f64, drag_area: f64) -> (Robot, Equilibrium) {
    for cable in &mut robot.cables {
        cable.material.drag_width = (drag_width > 0.0).then_some(drag_width);
    }
    robot.platform.drag_area = drag_area;
    robot.wind = Wind { velocity_w: Vec3::new(SPEED, 0.0, 0.0), ..Wind::default() };
    robot.turbulence = Some(Turbulence {
        spectrum: TurbulenceSpectrum::Kaimal,
        intensity: [0.15, 0.0, 0.0],
        length_scale: [80.0, 30.0, 10.0],
        coherence_decay: [0.0; 3],
        is_frozen: false,
        measured: None,
    });
    let found = statics::solve_at(&robot, &State::Pose(pose), StaticModel::Catenary, &TensionRule::default());
    (robot, found.unwrap().equilibrium)
}

/// Outputs of a robot: two motions and a tension; the cables of the planar robot sag out of its plane.
fn outputs(name: &str) -> Vec<(Signal, Quantity)> {
    let motions = vec![along(Vec3::x()), along(Vec3::y())];
    if name == "planar" { motions } else { [motions, vec![tension(1)]].concat() }
}

/// Oracle: the gust on the platform is a force, and its damping a damper of the platform, in the frequency response of
/// the whole robot with its posts, wheels and motors.
#[test]
fn every_kind_of_robot_has_the_response_of_the_damped_robot() {
    for (name, mut robot, pose) in robots() {
        robot.platform.center_of_mass_p = Vec3::zeros();
        let (robot, rest) = in_wind(robot, pose, 0.0, 1.2);
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), UP_TO_HZ).unwrap();
        let outputs = outputs(name);
        let gusts = Gusts::new(&robot, &rest, &dynamics, &outputs, UP_TO_HZ).unwrap();

        // ½ρ c_d A U, twice along the wind.
        let across = 0.5 * robot.wind.air_density * 1.2 * SPEED;
        let mut damped = robot.clone();
        damped.platform.translational_damping_p += Vec3::new(2.0 * across, across, across);
        let damped = Dynamics::about(&damped, &rest, Linearisation::default(), UP_TO_HZ).unwrap();
        let signals: Vec<Signal> = [along(Vec3::x())].iter().chain(&outputs).map(|of| of.0).collect();
        let mut ports = response::Port::all(&robot, &rest, &damped, &signals, false).unwrap();
        let measured: Vec<_> = ports.split_off(1).into_iter().map(|port| (port, Quantity::Displacement)).collect();
        for hz in [0.01, 0.7, 1.9, 4.3] {
            let responses = response::matrix(&damped, &[hz], &ports, &measured).unwrap();
            let found = gusts.densities(hz).unwrap();
            let gust = robot.turbulence.as_ref().unwrap().density(0, hz, SPEED);
            for (k, found) in found.total.iter().enumerate() {
                let expected = responses[k][0].norm_sqr() * (2.0 * across).powi(2) * gust;
                let largest = responses.iter().map(|of| of[0].norm_sqr()).fold(0.0, f64::max);
                // The clamped modes far above are replaced by a few; an output that symmetry forbids is rounding.
                let rounding = 1e-18 * largest * (2.0 * across).powi(2) * gust;
                assert!((found - expected).abs() < 1e-4 * expected + rounding, "{name} {hz} {k}: {found} {expected}");
            }
        }
    }
}

/// Oracle: slow gusts are another mean wind, in which forward statics holds the lengths. What the linear drag leaves
/// out is its turn with the cable, of the size of the motion over the length; 4e-4 of the tension on posts with drums.
#[test]
fn slow_gusts_on_every_kind_of_robot_are_another_wind() {
    for (name, robot, pose) in robots() {
        // The planar robot has little tension: with a tenth of the drag its turn is as small as that of the others.
        // With the whole drag it is 0.9 % of the motion.
        let drag_width = if name == "planar" { 0.0005 } else { 0.005 };
        let (robot, rest) = in_wind(robot, pose, drag_width, 0.5);
        let winches = WinchMode::Clamped;
        let linearisation = Linearisation { winches, ..Linearisation::default() };
        let dynamics = Dynamics::about(&robot, &rest, linearisation, UP_TO_HZ).unwrap();
        let outputs = outputs(name);
        let gusts = Gusts::new(&robot, &rest, &dynamics, &outputs, UP_TO_HZ).unwrap();
        let gust = robot.turbulence.as_ref().unwrap().density(0, 1e-3, SPEED);
        let found: Vec<f64> = gusts.densities(1e-3).unwrap().total.iter().map(|of| (of / gust).sqrt()).collect();

        let lengths: Vec<f64> = rest.cables.iter().map(|cable| cable.unstrained_length).collect();
        let step = 0.02;
        let [ahead, back] = [step, -step].map(|more| {
            let mut windy = robot.clone();
            windy.wind.velocity_w.x += more;
            let at = statics::forward(&windy, &lengths, StaticModel::Catenary, Some(&rest.pose)).unwrap();
            [at.pose.position_w.x, at.pose.position_w.y, at.cables[1].tension_platform]
        });
        let expected: Vec<f64> =
            ahead.iter().zip(back).map(|(ahead, back)| ((ahead - back) / (2.0 * step)).abs()).collect();
        for (k, found) in found.iter().enumerate() {
            // A motion across the wind is small beside that along it.
            let size = if k < 2 { expected[0].hypot(expected[1]) } else { expected[k] };
            assert!((found - expected[k]).abs() < 1e-3 * size, "{name} {k}: {found} {}", expected[k]);
        }
    }
}

#[test]
fn a_tension_out_of_the_plane_of_the_platform_is_refused() {
    let [.., (_, robot, pose)] = robots();
    let (robot, rest) = in_wind(robot, pose, 0.005, 0.5);
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), UP_TO_HZ).unwrap();
    let refused = Gusts::new(&robot, &rest, &dynamics, &[tension(1)], UP_TO_HZ).err().unwrap();
    assert!(refused.to_string().contains("out of the plane of the platform"), "{refused}");
}
