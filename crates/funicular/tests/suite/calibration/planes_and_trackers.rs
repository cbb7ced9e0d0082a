//! Planes that lean, and poses that a tracker measures.

use super::more_unknowns::rigid_poses;
use super::*;
use funicular::math::Rotation;
use funicular::robot::{Plane, PlatformMotion};

/// Calibration of the same readings by a planar robot that is turned with its plane.
fn turned(of: &Calibration, turn: &Rotation, count: usize, offsets: bool) -> Calibration {
    let mut robot = of.robot.clone();
    let PlatformMotion::Planar(plane) = robot.platform.motion else { panic!("not planar") };
    robot.platform.motion = PlatformMotion::Planar(Plane::new(turn * plane.normal_w(), plane.offset()).unwrap());
    for cable in &mut robot.cables {
        cable.anchor.point_w = turn * cable.anchor.point_w;
        cable.attachment_p = turn * cable.attachment_p;
    }
    let mut all = unknowns(count, &[0, 1, 2], offsets);
    if of.unknowns.iter().any(|of| matches!(of, CalibrationUnknown::Attachment { .. })) {
        all.extend((0..count).flat_map(|cable| (0..3).map(move |axis| CalibrationUnknown::Attachment { cable, axis })));
    }
    let of_pose = |pose: Pose| Pose { position_w: turn * pose.position_w, rot_wp: turn * pose.rot_wp * turn.inverse() };
    let of_row = |row: &MeasuredRow| MeasuredRow { start: row.start.map(of_pose), ..row.clone() };
    let rows = of.rows.iter().map(of_row).collect();
    Calibration::new(robot, all, rows, of.deviations, StaticModel::Ideal).unwrap()
}

/// A plane that leans: the answers are those of the coordinate plane, turned.
#[test]
fn a_planar_robot_in_a_plane_that_leans_is_that_in_a_coordinate_plane() {
    let turns = [Rotation::from_euler_angles(0.25, 0.0, 0.0), Rotation::from_euler_angles(0.7, -0.4, 1.1)];
    let with_attachments = {
        let mut draws = Draws(41);
        let corners = [[-0.3, -0.2, 0.0], [0.3, -0.25, 0.0], [0.35, 0.2, 0.0], [-0.3, 0.3, 0.0]];
        let anchors = [[0.0, 0.0, 0.0], [4.4, 0.1, 0.0], [4.3, 3.7, 0.0], [-0.1, 3.8, 0.0]];
        let truth = robot("planar-xy", &anchors, &corners);
        let pose =
            |_| Pose::new([2.2 + draws.within(1.2), 1.9 + draws.within(1.1), 0.0], [0.0, 0.0, draws.within(35.0)]);
        let poses: Vec<Pose> = (0..40).map(pose).collect();
        let mut rows = readings(&truth, &poses, &[0.0; 4], 1e-3, &mut draws);
        for (row, pose) in rows.iter_mut().zip(&poses) {
            row.start = Some(*pose);
        }
        let mut all = unknowns(4, &[0, 1], false);
        all.extend((0..4).flat_map(|cable| (0..2).map(move |axis| CalibrationUnknown::Attachment { cable, axis })));
        Calibration::new(truth, all, rows, deviations(1e-3), StaticModel::Ideal).unwrap()
    };
    for (of, offsets) in [(machine(), false), (plane_set(), true), (with_attachments, false)] {
        let (flat, flat_frame, flat_precision) = fitted(&of);
        let distances = of.anchor_distances(&flat, &flat_precision);
        for turn in &turns {
            let leaning = turned(&of, turn, 4, offsets);
            let (fit, frame, precision) = fitted(&leaning);
            assert_eq!(
                (frame.motion_count(), frame.free_count()),
                (flat_frame.motion_count(), flat_frame.free_count())
            );
            assert_eq!((&frame.held, &frame.held_coordinates), (&flat_frame.held, &flat_frame.held_coordinates));
            assert!((fit.chi2 / flat.chi2 - 1.0).abs() < 1e-6, "{} {}", fit.chi2, flat.chi2);
            assert!((precision.total() / flat_precision.total() - 1.0).abs() < 1e-5);
            assert!((precision.weakest() / flat_precision.weakest() - 1.0).abs() < 1e-5);

            // Anchors stand where the turn puts them, and no deviation leaves the plane.
            let (flat_robot, robot) = (of.robot_at(&flat.values).robot, leaning.robot_at(&fit.values).robot);
            for (i, (expected, cable)) in flat_robot.cables.iter().zip(&robot.cables).enumerate() {
                assert!((turn * expected.anchor.point_w - cable.anchor.point_w).norm() < 2e-6, "{i}");
            }
            let normal = turn * Vec3::z();
            let across = frame.inner(&precision.covariance).view((0, 0), (3, 3)) * normal;
            assert!(across.norm() < 1e-12 * precision.total().powi(2), "{across}");

            let same = distances.iter().zip(leaning.anchor_distances(&fit, &precision));
            for (expected, found) in same {
                assert!((expected.distance - found.distance).abs() < 2e-6);
                assert!((expected.deviation / found.deviation - 1.0).abs() < 1e-5);
            }
            let weak = leaning.weak_combinations(&fit, &frame, &precision, 1);
            assert!(
                (weak[0].deviation / of.weak_combinations(&flat, &flat_frame, &flat_precision, 1)[0].deviation - 1.0)
                    .abs()
                    < 1e-5
            );
        }
    }
}

/// Rows with the pose that a tracker measures, with noise on all three kinds of data.
fn tracked(truth: &Robot, poses: &[Pose], deviations: &ReadingDeviations, draws: &mut Draws) -> Vec<MeasuredRow> {
    let offsets = vec![0.01; truth.cables.len()];
    let mut rows = readings(truth, poses, &offsets, deviations.reading, draws);
    for (row, pose) in rows.iter_mut().zip(poses) {
        let (roll, pitch, yaw) = pose.rot_wp.euler_angles();
        row.position = [0, 1, 2].map(|axis| Some(pose.position_w[axis] + deviations.position * draws.normal()));
        row.angles = [roll, pitch, yaw].map(|angle| Some(angle + deviations.angle * draws.normal()));
        row.start = Some(*pose);
    }
    rows
}

/// Anchors, attachments and offsets of eight cables.
fn everything() -> Vec<CalibrationUnknown> {
    let mut all = unknowns(8, &[0, 1, 2], true);
    all.extend((0..8).flat_map(|cable| (0..3).map(move |axis| CalibrationUnknown::Attachment { cable, axis })));
    all
}

#[test]
fn a_tracker_fixes_the_frames_of_the_world_and_of_the_platform() {
    let mut draws = Draws(43);
    let truth = robot("rigid", &RIGID_START, &RIGID_ATTACHMENTS);
    let poses = rigid_poses(24, 40.0, &mut draws);
    let mut start = truth.clone();
    for cable in &mut start.cables {
        for axis in 0..3 {
            cable.anchor.point_w[axis] += draws.within(0.05);
            cable.attachment_p[axis] += draws.within(0.02);
        }
    }

    // Exact data: every search ends at them. The derivatives of angles are compared with motions in `tool`.
    let of_noise = ReadingDeviations { reading: 1e-3, position: 1e-3, angle: 1e-3, tension: 1.0, tension_prior: None };
    let exact = ReadingDeviations { reading: 0.0, position: 0.0, angle: 0.0, ..of_noise };
    let rows = tracked(&truth, &poses, &exact, &mut draws);
    let of = Calibration::new(start.clone(), everything(), rows.clone(), of_noise, StaticModel::Ideal).unwrap();
    let (fit, frame, precision) = fitted(&of);
    assert_eq!((frame.motion_count(), precision.degrees), (0, 24 * (8 + 6 - 6) - 56));
    assert!(fit.converged && fit.chi2 < 1e-9, "{}", fit.chi2);
    let found = of.robot_at(&fit.values).robot;
    for (cable, truth) in found.cables.iter().zip(&truth.cables) {
        assert!((cable.anchor.point_w - truth.anchor.point_w).norm() < 1e-6);
        assert!((cable.attachment_p - truth.attachment_p).norm() < 1e-6);
    }

    // Without angles the platform's own frame may turn.
    let without = rows.iter().map(|row| MeasuredRow { angles: [None; 3], ..row.clone() }).collect();
    let of = Calibration::new(start, everything(), without, of_noise, StaticModel::Ideal).unwrap();
    assert_eq!(of.frame(&FrameChoice::Anchors(Vec::new())).unwrap().motion_count(), 3);

    // Noise: intervals hold the truth, and χ² is that of its degrees of freedom.
    let (mut inside, mut count, mut chi2) = (0, 0, 0.0);
    for _ in 0..20 {
        let rows = tracked(&truth, &poses, &of_noise, &mut draws);
        let of = Calibration::new(truth.clone(), everything(), rows, of_noise, StaticModel::Ideal).unwrap();
        let (fit, _, precision) = fitted(&of);
        let truth =
            of.start().into_iter().enumerate().map(|(k, value)| value + if (24..32).contains(&k) { 0.01 } else { 0.0 });
        for ((value, truth), own) in fit.values.iter().zip(truth).zip(precision.deviations()) {
            count += 1;
            inside += usize::from((value - truth).abs() < 1.96 * own);
        }
        chi2 += fit.chi2 / 20.0;
    }
    // 1,120 values, correlated within a draw; χ² of 20 draws deviates by sqrt(2 · 136 / 20) = 3.7, four of them.
    let share = inside as f64 / f64::from(count);
    assert!((0.92..0.98).contains(&share), "{share}");
    assert!((chi2 - 136.0).abs() < 15.0, "{chi2}");
}

#[test]
fn measured_poses_calibrate_elastic_cables_without_tensions() {
    let mut draws = Draws(47);
    let truth = on_ropes();
    let mut rows = Vec::new();
    for pose in rigid_poses(60, 10.0, &mut draws) {
        let lengths: Vec<f64> =
            truth.cables.iter().map(|cable| cable.straight_length(&pose) * (0.998 + draws.within(0.002))).collect();
        let Ok(rest) = statics::forward(&truth, &lengths, StaticModel::Catenary, Some(&pose)) else { continue };
        let (roll, pitch, yaw) = rest.pose.rot_wp.euler_angles();
        rows.push(MeasuredRow {
            position: [0, 1, 2].map(|axis| Some(rest.pose.position_w[axis])),
            angles: [roll, pitch, yaw].map(Some),
            start: Some(rest.pose),
            ..MeasuredRow::of_readings(&lengths)
        });
    }
    assert!(rows.len() > 30, "{}", rows.len());

    let start = with_errors(&truth, 0.01, &mut draws);
    let deviations =
        ReadingDeviations { reading: 1e-3, position: 1e-3, angle: 1e-3, tension: 1.0, tension_prior: None };
    let of = Calibration::new(start, unknowns(8, &[0, 1, 2], false), rows, deviations, StaticModel::Catenary).unwrap();
    let (fit, frame, _) = fitted(&of);
    assert!(frame.motion_count() == 0 && fit.chi2 < 1e-6, "{} {}", frame.motion_count(), fit.chi2);
    let found = of.robot_at(&fit.values).robot;
    for (cable, truth) in found.cables.iter().zip(&truth.cables) {
        assert!((cable.anchor.point_w - truth.anchor.point_w).norm() < 1e-5);
    }
}

#[test]
fn a_plane_gives_the_coordinate_that_is_missing() {
    let leaning = Plane::new(Vec3::new(0.0, -3.0, 4.0), 0.5).unwrap();
    let point = leaning.point_with([Some(1.0), None, Some(2.0)]).unwrap();
    // −0.6 y + 0.8 · 2 = 0.5.
    assert!((point - Vec3::new(1.0, 1.1 / 0.6, 2.0)).norm() < 1e-14, "{point}");
    // The plane contains the x axis: nothing tells x; two coordinates are too many.
    assert_eq!(leaning.point_with([None, Some(1.0), Some(2.0)]), None);
    assert_eq!(leaning.point_with([Some(1.0), None, None]), None);
    let given = [Some(1.0), Some(2.0), Some(3.0)];
    assert_eq!(leaning.point_with(given), Some(Vec3::new(1.0, 2.0, 3.0)));
}
