//! Accuracy of the tool: motions of the platform against readings that are held while a value changes, and deviations
//! against many calibrations with noise.

use super::more_unknowns::rigid_poses;
use super::*;
use funicular::calibration::CalibratedRobot;
use funicular::math::DMat;
use funicular::math::rotation::to_roll_pitch_yaw_deg;

/// Pose of straight rigid cables with these readings, near a pose: Newton's method on the lengths with derivatives by
/// differences. What the cables contradict is shared by least squares.
fn pose_of(at: &CalibratedRobot, readings: &[f64], near: &Pose, turns: bool) -> Pose {
    let misfit = |pose: &Pose| -> Vec<f64> {
        let cables = at.robot.cables.iter().zip(&at.offsets).zip(readings);
        cables.map(|((cable, offset), reading)| cable.straight_length(pose) - offset - at.scale * reading).collect()
    };
    // A coordinate that no length sees, as that across a plane, stays where it is.
    let count = if turns { 6 } else { 3 };
    let moved = |pose: &Pose, k: usize, step: f64| {
        if k < 3 {
            pose.moved(&Vec3::ith(k, step), &Vec3::zeros())
        } else {
            pose.moved(&Vec3::zeros(), &Vec3::ith(k - 3, step))
        }
    };
    let mut pose = *near;
    for _ in 0..8 {
        let step = 1e-5;
        let columns: Vec<Vec<f64>> = (0..count)
            .map(|k| {
                let (up, down) = (misfit(&moved(&pose, k, step)), misfit(&moved(&pose, k, -step)));
                up.iter().zip(down).map(|(up, down)| (up - down) / (2.0 * step)).collect()
            })
            .collect();
        let jacobian = DMat::from_fn(readings.len(), count, |i, k| columns[k][i]);
        let rest = DMat::from_column_slice(readings.len(), 1, &misfit(&pose));
        let step = jacobian.svd(true, true).solve(&rest, 1e-6).unwrap();
        for k in 0..count {
            pose = moved(&pose, k, -step[(k, 0)]);
        }
    }
    pose
}

/// Readings of all cables at a pose.
fn readings_at(at: &CalibratedRobot, lengths: &[f64]) -> Vec<f64> {
    lengths.iter().zip(&at.offsets).map(|(length, offset)| (length - offset) / at.scale).collect()
}

#[test]
fn motions_of_a_rigid_platform_are_those_of_readings_that_are_held() {
    let of = rigid_set();
    let values = of.start();
    let at = of.robot_at(&values);
    for pose in rigid_poses(4, 0.2, &mut Draws(5)) {
        let rows = of.tool_rows(&at, &pose, &[]).unwrap();
        let lengths: Vec<f64> = at.robot.cables.iter().map(|cable| cable.straight_length(&pose)).collect();
        let readings = readings_at(&at, &lengths);
        for k in 0..values.len() {
            let step = 1e-4;
            let end = |sign: f64| {
                let mut moved = values.clone();
                moved[k] += sign * step;
                pose_of(&of.robot_at(&moved), &readings, &pose, true)
            };
            let (up, down) = (end(1.0), end(-1.0));
            let rates = (up.position_w - down.position_w) / (2.0 * step);
            let angles = [up, down].map(|pose| to_roll_pitch_yaw_deg(&pose.rot_wp).map(f64::to_radians));
            for c in 0..3 {
                // Differences of steps of 0.1 mm: curvature of 1e-8 per metre, rounding of 1e-11.
                assert!((rows.position[(c, k)] - rates[c]).abs() < 1e-6, "{k} {c}");
                let rate = (angles[0][c] - angles[1][c]) / (2.0 * step);
                assert!((rows.angles[(c, k)] - rate).abs() < 1e-6, "{k} {c}: {} {rate}", rows.angles[(c, k)]);
            }
        }
    }
}

#[test]
fn motions_on_sagging_cables_are_those_of_equilibria_at_readings_that_are_held() {
    let of = sagging(true).unwrap();
    let values = of.start();
    let at = of.robot_at(&values);
    let pose = Pose::new([2.0, 4.5, -2.0], [0.0; 3]);
    let lengths: Vec<f64> = at.robot.cables.iter().map(|cable| 0.9995 * cable.straight_length(&pose)).collect();
    let rest = statics::forward(&at.robot, &lengths, StaticModel::Catenary, Some(&pose)).unwrap();
    let readings = readings_at(&at, &lengths);
    let rows = of.tool_rows(&at, &rest.pose, &lengths).unwrap();
    for k in 0..values.len() {
        let step = 1e-5;
        let end = |sign: f64| {
            let mut moved = values.clone();
            moved[k] += sign * step;
            let with = of.robot_at(&moved);
            let lengths: Vec<f64> =
                readings.iter().zip(&with.offsets).map(|(reading, offset)| offset + with.scale * reading).collect();
            statics::forward(&with.robot, &lengths, StaticModel::Catenary, Some(&rest.pose)).unwrap().pose.position_w
        };
        let rates = (end(1.0) - end(-1.0)) / (2.0 * step);
        for c in 0..3 {
            // Curvature along the step, and equilibria to 1e-12 m.
            assert!((rows.position[(c, k)] - rates[c]).abs() < 1e-5, "{k} {c}: {} {}", rows.position[(c, k)], rates[c]);
        }
    }
}

#[test]
fn deviations_of_the_tool_are_those_of_400_noisy_calibrations() {
    let truth = planar(&[[0.0, 0.0], [4.4, 0.0], [4.4, 3.7], [0.0, 3.7]]);
    let noise = 0.3e-3;
    let place = |k: usize| [0.8 + 0.9 * (k % 4) as f64, 0.7 + 1.0 * (k / 4) as f64, 0.0];
    let poses: Vec<Pose> = (0..12).map(|k| Pose::new(place(k), [0.0; 3])).collect();
    let tool = [[2.2, 1.85, 0.0], [0.3, 0.3, 0.0], [4.1, 3.4, 0.0]].map(|place| Pose::new(place, [0.0; 3]));
    let mut draws = Draws(2026);

    let mut of = Calibration::new(
        truth.clone(),
        unknowns(4, &[0, 1], false),
        readings(&truth, &poses, &[0.0; 4], noise, &mut draws),
        deviations(noise),
        StaticModel::Ideal,
    )
    .unwrap();
    let (fit, _, precision) = fitted(&of);
    let at = of.robot_at(&fit.values);
    let predicted = tool.map(|pose| of.tool_rows(&at, &pose, &[]).unwrap().deviation(&precision.covariance));
    let middle = predicted[0].position;
    assert!(predicted[1].position > 1.1 * middle, "a corner is less exact than the middle: {predicted:?}");

    // The machine goes where the readings of each calibration lead it.
    let truth_at = of.robot_at(&of.start());
    let count = 400;
    let mut squares = [0.0; 3];
    for _ in 0..count {
        of.rows = readings(&truth, &poses, &[0.0; 4], noise, &mut draws);
        let (fit, ..) = fitted(&of);
        let calibrated = of.robot_at(&fit.values);
        for (j, pose) in tool.iter().enumerate() {
            let lengths: Vec<f64> = calibrated.robot.cables.iter().map(|cable| cable.straight_length(pose)).collect();
            let there = pose_of(&truth_at, &lengths, pose, false);
            squares[j] += (there.position_w - pose.position_w).dot(&predicted[j].direction_w).powi(2);
        }
    }
    for (found, predicted) in squares.iter().zip(&predicted) {
        // 400 draws tell a deviation to 3.5 %; 10 % is three of these.
        let sampled = (found / f64::from(count)).sqrt();
        assert!((sampled / predicted.position - 1.0).abs() < 0.1, "{sampled} {}", predicted.position);
    }
}
