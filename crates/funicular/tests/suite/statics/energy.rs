//! Potential energy: an equilibrium is a minimum of it.

use super::crane;
use funicular::math::Vec3;
use funicular::robot::{Pose, Robot};
use funicular::statics::{self, Stability, StaticModel};

fn energy(robot: &Robot, pose: &Pose, lengths: &[f64]) -> f64 {
    let cables: f64 = (0..lengths.len())
        .map(|i| {
            let rope = funicular::catenary::Rope {
                unstrained_length: lengths[i],
                weight_per_length: robot.cables[i].material.mass_per_length * 9.81,
                axial_stiffness: robot.cables[i].material.axial_stiffness,
            };
            let start = pose.point_w(&robot.cables[i].attachment_p);
            let cable = funicular::catenary::space::HangingCable::new(
                start,
                robot.cables[i].anchor.exit_w(&start),
                Vec3::z(),
                rope,
            )
            .unwrap();
            cable.energy()
        })
        .sum();
    cables + robot.platform.mass * 9.81 * pose.point_w(&robot.platform.center_of_mass_p).z
}

#[test]
fn forward_statics_of_few_cables_is_a_minimum_of_the_energy() {
    for (cables, rope_mass) in [(2, 0.0), (2, 0.2), (3, 0.1), (4, 0.0), (4, 0.3)] {
        let robot = crane(cables, rope_mass);
        let lengths: Vec<f64> = [5.1, 5.3, 5.2, 5.0][..cables].to_vec();
        let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
        assert!(rest.residual <= 1e-10, "{cables}");
        assert!(matches!(rest.stability, Stability::Stable { .. }), "{cables}: {:?}", rest.stability);
        let least = energy(&robot, &rest.pose, &lengths);
        for k in 0..60 {
            let angle = f64::from(k) * 1.3;
            let size = 3e-3 * (1.0 + f64::from(k % 7));
            let shift = Vec3::new(angle.sin(), (1.7 * angle).cos(), (2.3 * angle).sin()) * size;
            let turn = Vec3::new((0.9 * angle).cos(), (1.1 * angle).sin(), (0.4 * angle).cos()) * size;
            assert!(energy(&robot, &rest.pose.moved(&shift, &turn), &lengths) > least, "{cables} {k}");
        }
        // Reach it from another start, displaced and rotated.
        let start = rest.pose.moved(&Vec3::new(0.3, -0.2, 0.3), &Vec3::new(0.2, 0.1, -0.2));
        let again = statics::forward(&robot, &lengths, StaticModel::Catenary, Some(&start)).unwrap();
        assert!(statics::pose_distance(&robot, &again.pose, &rest.pose) < 1e-7);
    }
}
