//! Vibration with ropes over sheaves.

use super::{BODY, Fall, HEAVY, LIGHT, POINT, hanging, robot_of, text_of};
use funicular::cable::CableModel;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::modes;
use funicular::robot::Robot;
use funicular::statics::{self, Equilibrium, StaticModel};
use std::f64::consts::{PI, TAU};

fn rest(robot: &Robot) -> Equilibrium {
    statics::solve(robot, StaticModel::Catenary, None).unwrap().equilibrium
}

fn dynamics(robot: &Robot, rest: &Equilibrium, cable_model: CableModel, up_to_hz: f64) -> Dynamics {
    Dynamics::about(robot, rest, Linearisation { cable_model, ..Linearisation::default() }, up_to_hz).unwrap()
}

/// A mass on a light rope moves on an ellipse whose foci are the anchors, and about the line through them: two
/// pendulums, ω² = g κ with the curvature κ of the ellipse, and ω² = g cos α/d.
#[test]
fn a_mass_on_a_light_rope_swings_on_an_ellipse() {
    let stiff = "axial_stiffness_n = 1e10\nmass_kg_per_m = 0.0";
    let robot = hanging(stiff, [4.0, 4.0]);
    let found = rest(&robot);
    let (a, b) = (Vec3::new(-3.0, 0.0, 1.0), Vec3::new(2.0, 0.0, -0.5));
    let p = found.pose.position_w;
    let (first, second) = ((p - a).norm(), (p - b).norm());
    let (half, focal) = (0.5 * (first + second), 0.5 * (b - a).norm());
    let curvature = half * (half * half - focal * focal).sqrt() / (first * second).powf(1.5);
    let axis = (b - a).normalize();
    let distance = (p - a).cross(&axis).norm();
    let level = (1.0 - axis.z * axis.z).sqrt();
    let mut expected = [(9.81 * curvature).sqrt() / TAU, (9.81 * level / distance).sqrt() / TAU];
    expected.sort_by(f64::total_cmp);

    for model in [CableModel::CatenaryStatic, CableModel::CatenaryDynamic] {
        let found = modes::below(&dynamics(&robot, &found, model, 2.0), 2.0).modes;
        assert_eq!(found.len(), 2, "{model}");
        for (mode, expected) in found.iter().zip(expected) {
            assert!((mode.frequency_hz - expected).abs() < 1e-6 * expected, "{model} {} {expected}", mode.frequency_hz);
        }
    }
}

/// The dynamic stiffness of all models with mass goes over into the static tangent, in which (92f) has been condensed.
#[test]
fn the_dynamic_stiffness_of_running_ropes_begins_at_the_static_one() {
    let falls = [
        Fall::of_body([-4.0, -3.0, 5.0], [-0.8, -0.6, 0.2], None, "winch = \"drum\""),
        Fall::of_body([-4.0, 3.0, 5.2], [-0.8, 0.6, 0.3], Some(0), ""),
        Fall::of_body([4.0, 3.0, 5.0], [0.8, 0.6, 0.2], None, "pulley = \"wheel\"\nwinch = \"drum\""),
        Fall::of_body([3.9, 2.0, 5.0], [0.8, 0.5, 0.2], Some(2), ""),
        Fall::of_body([4.0, -3.0, 5.0], [0.8, -0.6, 0.1], None, ""),
    ];
    let robot = robot_of(BODY, HEAVY, &falls);
    let found = rest(&robot);
    let tangent = statics::tangent_stiffness(&robot, &found).unwrap();
    for (model, tolerance) in [(CableModel::CatenaryStatic, 1e-9), (CableModel::CatenaryDynamic, 1e-6)] {
        let still = dynamics(&robot, &found, model, 20.0).stiffness(1e-4).map(|k| k.re);
        let error = (still - tangent).norm() / tangent.norm();
        assert!(error < tolerance, "{model} {error}");
    }
    let shallow = dynamics(&robot, &found, CableModel::ShallowDynamic, 20.0).stiffness(1e-4).map(|k| k.re);
    assert!((shallow - tangent).norm() < 0.02 * tangent.norm());

    // All modes are found and certified, and with damping, too.
    let text = text_of(BODY, &format!("{HEAVY}\ndamping_ratio = 0.01\naxial_loss_factor = 0.02"), &falls);
    let damped = Robot::from_toml(&text).unwrap();
    let whole = dynamics(&damped, &rest(&damped), CableModel::CatenaryDynamic, 25.0);
    let found = modes::below(&whole, 25.0);
    assert!(found.certified && found.modes.len() > 10);
    let (partners, caveats) = modes::damped_partners(&whole, &found);
    let partners = partners.unwrap();
    assert!(partners.certified && caveats.is_empty(), "{caveats:?}");
}

/// Two vertical falls of one rope: in the modes in which the platform is at rest the rope runs over the sheave like a
/// bar between its ends, k cot(k l) = −q/(λ EA), k = ω √(m/EA).
fn falls(more: &str) -> (Robot, f64) {
    let rope = format!("axial_stiffness_n = 2e5\nmass_kg_per_m = 0.8\n{more}");
    let two = [Fall::new([0.0; 3], Some(6.0), None), Fall::new([0.0; 3], Some(4.0), Some(0))];
    let robot = robot_of(POINT, &rope, &two);
    let found = rest(&robot);
    assert!((found.cables[0].unstrained_length - 5.0).abs() < 1e-9);
    let (load, stiffness, length) = (0.8 * 9.81, 2e5, 5.0);
    let right = -load / ((1.0 + found.cables[0].tension_platform / stiffness) * stiffness);
    let mut k: f64 = 0.5 * PI / length;
    for _ in 0..50 {
        let (sin, cos) = (k * length).sin_cos();
        let value = k * cos / sin - right;
        let slope = cos / sin - k * length / (sin * sin);
        k -= value / slope;
    }
    (robot, k * (stiffness / 0.8_f64).sqrt() / TAU)
}

#[test]
fn a_rope_runs_over_its_sheave_like_a_bar_between_its_ends() {
    let (robot, expected) = falls("damping_ratio = 0.0");
    let found = rest(&robot);
    let whole = dynamics(&robot, &found, CableModel::CatenaryDynamic, 1.5 * expected);
    let all = modes::below(&whole, 1.2 * expected);
    assert!(all.certified);
    let nearest = all
        .modes
        .iter()
        .min_by(|a, b| (a.frequency_hz - expected).abs().total_cmp(&(b.frequency_hz - expected).abs()))
        .unwrap();
    assert!((nearest.frequency_hz - expected).abs() < 1e-6 * expected, "{} {expected}", nearest.frequency_hz);
    assert!(nearest.platform_energy_fraction < 1e-9);
    assert!((nearest.cable_energy_fractions[0] - 0.5).abs() < 1e-6);

    // A sheave with friction stays at rest: separate ropes, without this mode.
    let mut stuck = robot.clone();
    stuck.ropes[0].efficiencies[0] = 0.97;
    let separate = Robot { ropes: Vec::new(), ..robot.clone() };
    let frequencies = |robot: &Robot| -> Vec<f64> {
        let whole = dynamics(robot, &found, CableModel::CatenaryDynamic, 1.5 * expected);
        modes::below(&whole, 1.2 * expected).modes.iter().map(|mode| mode.frequency_hz).collect()
    };
    assert_eq!(frequencies(&stuck), frequencies(&separate));
    assert_eq!(frequencies(&robot).len(), frequencies(&separate).len() + 1);

    // Its stretch alone loses energy: half of the loss factor.
    let (lossy, expected) = falls("damping_ratio = 0.0\naxial_loss_factor = 0.02");
    let whole = dynamics(&lossy, &rest(&lossy), CableModel::CatenaryDynamic, 1.5 * expected);
    let all = modes::below(&whole, 1.2 * expected);
    let (partners, _) = modes::damped_partners(&whole, &all);
    let ratio = |hz: f64| {
        let of = partners.as_ref().unwrap().modes.iter();
        let near = of.min_by(|a, b| (a.frequency_hz() - hz).abs().total_cmp(&(b.frequency_hz() - hz).abs())).unwrap();
        near.omega.im / near.omega.norm()
    };
    assert!((ratio(expected) - 0.01).abs() < 1e-4, "{}", ratio(expected));
}

#[test]
fn what_is_not_known_of_running_ropes_is_refused() {
    let three = [
        Fall::new([0.0; 3], Some(5.0), None),
        Fall::new([0.2, 0.0, 0.0], Some(5.0), Some(0)),
        Fall::new([0.4, 0.0, 0.0], Some(5.0), Some(1)),
    ];
    let robot = robot_of(POINT, HEAVY, &three);
    let found = rest(&robot);
    let about = |robot: &Robot, cable_model, in_plane_only| {
        let linearisation = Linearisation { cable_model, in_plane_only, ..Linearisation::default() };
        Dynamics::about(robot, &found, linearisation, 5.0).map(|_| ()).map_err(|error| error.to_string())
    };
    let error = about(&robot, CableModel::CatenaryDynamic, false).unwrap_err();
    assert!(error.contains("a sheave of the frame"), "{error}");
    assert!(about(&robot, CableModel::CatenaryStatic, false).is_ok());
    assert!(about(&robot, CableModel::CatenaryStatic, true).unwrap_err().contains("out of plane"));
    let light = robot_of(POINT, LIGHT, &three);
    assert!(about(&light, CableModel::CatenaryDynamic, false).is_ok());
}
