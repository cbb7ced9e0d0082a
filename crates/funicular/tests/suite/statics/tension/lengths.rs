//! The computed lengths hold the platform at the requested pose.

use super::{cogiro, cogiro_pose, seven_cables, seven_pose};
use funicular::math::Vec6;
use funicular::robot::Pose;
use funicular::statics::{self, Stability, StaticModel, TensionRule};

#[test]
fn lengths_found_put_the_platform_back() {
    let mut stable = 0;
    let robots = [
        (cogiro(0.064, 50.0, 1500.0), cogiro_pose as fn(usize) -> Pose),
        (seven_cables(0.02, 20.0, 1500.0), seven_pose),
    ];
    for (robot, pose) in robots {
        for i in 0..150 {
            for rule in [TensionRule::Lowest, TensionRule::Middle] {
                let Ok(held) = statics::distribute_tensions(&robot, &pose(i), StaticModel::Catenary, &rule) else {
                    continue;
                };
                let Stability::Stable { min_stiffness } = held.stability else { continue };
                let lengths: Vec<f64> = held.cables.iter().map(|c| c.unstrained_length).collect();
                let back = statics::forward(&robot, &lengths, StaticModel::Catenary, Some(&pose(i))).unwrap();
                let gap = (back.pose.position_w - held.pose.position_w).norm();
                assert!(gap < 1e-9, "{}: {gap:e}, least stiffness {min_stiffness}", robot.name);
                stable += 1;
            }
        }
    }
    assert!(stable > 200, "{stable}");
}

/// The type of the wrench is part of the interface by which other programs compute the balance.
#[test]
fn lengths_found_balance_the_platform_as_the_public_wrench_sees_it() {
    let robot = cogiro(0.064, 50.0, 1500.0);
    let pose = Pose::new([1.0, 2.0, 1.5], [0.0, 3.0, 5.0]);
    let held = statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, &TensionRule::Middle).unwrap();
    let lengths: Vec<f64> = held.cables.iter().map(|c| c.unstrained_length).collect();
    let left: Vec6 = statics::wrench(&robot, &pose, &lengths, StaticModel::Catenary).unwrap();
    // Last digit of the lengths, 1e-15 m, in eight ropes of 820 kN.
    assert!(left.amax() < 1e-8, "{left}");
}
