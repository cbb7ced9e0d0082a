//! Payload without extent on the platform: the robot that carries it, and changes of that robot.

use funicular::math::{Mat3, Vec3};
use funicular::robot::{Robot, RobotChange};

/// Robot whose platform carries a payload [kg] with its centre of mass at a point of the platform [m].
pub(crate) fn carrying(robot: &Robot, mass: f64, center_p: Vec3) -> Robot {
    let mut robot = robot.clone();
    let platform = &mut robot.platform;
    let (own, arm) = (platform.mass, center_p - platform.center_of_mass_p);
    let both = own + mass;
    platform.mass = both;
    platform.center_of_mass_p += arm * (mass / both);
    // Two point masses about their common centre.
    platform.inertia_p += about_center(&arm) * (own * mass / both);
    robot
}

/// Change of the robot that carries a payload, along a change of the robot without it; the payload stays as it is.
pub(crate) fn change_carrying(mut change: RobotChange, robot: &Robot, mass: f64, center_p: Vec3) -> RobotChange {
    let platform = &robot.platform;
    let (own, arm) = (platform.mass, center_p - platform.center_of_mass_p);
    let both = own + mass;
    let moved = change.center_of_mass_p;

    // Rates of the factors m/(M + m) and M m/(M + m).
    let (of_share, of_reduced) = (-mass / (both * both) * change.mass, (mass / both).powi(2) * change.mass);
    change.center_of_mass_p = moved * (own / both) + arm * of_share;
    let turned = Mat3::identity() * (-2.0 * arm.dot(&moved)) + moved * arm.transpose() + arm * moved.transpose();
    change.inertia_p += about_center(&arm) * of_reduced + turned * (own * mass / both);
    change
}

/// Inertia of a unit mass about a point that is `arm` away.
fn about_center(arm: &Vec3) -> Mat3 {
    Mat3::identity() * arm.norm_squared() - arm * arm.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn robot() -> Robot {
        Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap()
    }

    /// The kinetic energy of platform and payload, with a velocity and an angular velocity of the platform origin.
    #[test]
    fn a_payload_adds_the_energy_of_its_mass() {
        let center_p = Vec3::new(0.3, -0.2, 0.1);
        let (velocity, turning) = (Vec3::new(0.4, 0.7, -0.2), Vec3::new(1.0, -2.0, 0.5));
        let energy = |robot: &Robot| {
            let platform = &robot.platform;
            let at_center = velocity + turning.cross(&platform.center_of_mass_p);
            0.5 * platform.mass * at_center.norm_squared() + 0.5 * turning.dot(&(platform.inertia_p * turning))
        };
        let at_payload = velocity + turning.cross(&center_p);
        let expected = energy(&robot()) + 0.5 * 5.0 * at_payload.norm_squared();
        assert!((energy(&carrying(&robot(), 5.0, center_p)) / expected - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_change_with_a_payload_is_that_of_the_robot_that_carries_it() {
        const STEP: f64 = 1e-6;

        let center_p = Vec3::new(0.3, -0.2, 0.1);
        let change = RobotChange {
            mass: 1.3,
            center_of_mass_p: Vec3::new(0.2, 0.5, -0.4),
            inertia_p: Mat3::identity() * 0.7,
            ..RobotChange::default()
        };
        let after = |step: f64| {
            let mut robot = robot();
            robot.platform.mass += step * change.mass;
            robot.platform.center_of_mass_p += change.center_of_mass_p * step;
            robot.platform.inertia_p += change.inertia_p * step;
            carrying(&robot, 5.0, center_p).platform
        };
        let (low, high) = (after(-STEP), after(STEP));
        let found = change_carrying(change.clone(), &robot(), 5.0, center_p);
        assert!((found.mass - (high.mass - low.mass) / (2.0 * STEP)).abs() < 1e-8);
        let moved = (high.center_of_mass_p - low.center_of_mass_p) / (2.0 * STEP);
        assert!((found.center_of_mass_p - moved).norm() < 1e-8, "{} {moved}", found.center_of_mass_p);
        let turned = (high.inertia_p - low.inertia_p) / (2.0 * STEP);
        assert!((found.inertia_p - turned).norm() < 1e-8, "{} {turned}", found.inertia_p);
    }
}
