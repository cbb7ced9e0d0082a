//! Pose errors of the simpler static models: limits in which they vanish, and the minimum mass.

use funicular::pose_error::{PoseDifference, PoseErrorPoint, Threshold, threshold};
use funicular::robot::{Pose, Robot, State};

fn yuan() -> (Robot, Vec<f64>) {
    let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
    let State::Lengths(lengths) = robot.state.clone() else { panic!("given by lengths") };
    (robot, lengths)
}

fn distance(difference: Option<PoseDifference>) -> f64 {
    difference.expect("both models have an equilibrium").distance
}

#[test]
fn a_difference_has_a_distance_and_the_angle_of_the_turn_between_both() {
    let from = Pose::new([1.0, 2.0, 3.0], [10.0, 0.0, 0.0]);
    let to = Pose::new([1.0, -1.0, 7.0], [55.0, 0.0, 0.0]);
    let between = PoseDifference::between(&from, &to);
    let off = between.translation.iter().zip([0.0, -3.0, 4.0]).map(|(ours, hand)| (ours - hand).abs());
    assert!(off.fold(0.0, f64::max) < 1e-15, "{between:?}");
    assert!((between.distance - 5.0).abs() < 1e-15);
    assert!((between.angle.to_degrees() - 45.0).abs() < 1e-12);
}

#[test]
fn rigid_cables_leave_a_pose_that_no_mass_moves() {
    let (robot, lengths) = yuan();
    let [light, heavy] = [10.55, 86.35].map(|mass| PoseErrorPoint::at_mass(&robot, &lengths, mass).ideal.unwrap().pose);
    let between = PoseDifference::between(&light, &heavy);
    assert!(between.distance < 1e-12 && between.angle < 1e-12, "{between:?}");
}

#[test]
fn without_their_weight_catenaries_are_springs_and_stiff_springs_are_rigid() {
    let (mut robot, lengths) = yuan();
    robot.cables.iter_mut().for_each(|cable| cable.material.mass_per_length = 0.0);
    let stretched = |stiffer: f64| {
        let mut robot = robot.clone();
        robot.cables.iter_mut().for_each(|cable| cable.material.axial_stiffness *= stiffer);
        let point = PoseErrorPoint::at_mass(&robot, &lengths, 60.0);
        assert!(distance(point.spring_from_catenary()) < 1e-9);
        distance(point.spring_from_ideal())
    };

    // The stretch, and with it the displacement of the platform, is in proportion to the compliance.
    let (soft, stiff) = (stretched(100.0), stretched(10_000.0));
    assert!(stiff > 0.0 && (soft / stiff / 100.0 - 1.0).abs() < 0.02, "{soft:e} {stiff:e}");
}

#[test]
fn from_the_threshold_on_springs_are_good_enough_and_just_below_they_are_not() {
    let (robot, lengths) = yuan();
    let masses = (0..20).map(|k| 10.55 + (86.35 - 10.55) * f64::from(k) / 19.0);
    let points: Vec<PoseErrorPoint> = masses.map(|mass| PoseErrorPoint::at_mass(&robot, &lengths, mass)).collect();

    for tolerance in [0.002, 0.005] {
        let Threshold::From(mass) = threshold(&robot, &lengths, &points, tolerance) else { panic!("{tolerance}") };
        let at = |mass: f64| distance(PoseErrorPoint::at_mass(&robot, &lengths, mass).spring_from_catenary());
        // The bound: 1e-6 of the mass, and a distance that falls by less than a millimetre per kilogram.
        assert!((at(mass) - tolerance).abs() < 1e-7, "{mass} kg: {} for {tolerance}", at(mass));
        assert!(at(0.999 * mass) > tolerance && at(1.001 * mass) < tolerance, "{mass} kg");
        for point in &points {
            assert_eq!(point.mass >= mass, distance(point.spring_from_catenary()) <= tolerance, "{} kg", point.mass);
        }
    }

    assert_eq!(threshold(&robot, &lengths, &points, 1.0), Threshold::Everywhere);
    assert_eq!(threshold(&robot, &lengths, &points, 1e-9), Threshold::Nowhere);
}
