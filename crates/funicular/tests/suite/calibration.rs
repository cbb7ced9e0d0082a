//! Calibration from lengths alone: published belts of a machine, synthetic sets of a separate program, derivatives
//! against differences, coverage of intervals, starts from nothing, and data that are wrong.

mod more_unknowns;
mod planes_and_trackers;
mod published;
mod starts;
mod tool;
mod wrong_rows;

use funicular::calibration::{
    Calibration, CalibrationError, CalibrationFit, CalibrationFrame, CalibrationPrecision, CalibrationUnknown,
    CandidatePose, CombinationPart, FrameChoice, MeasuredRow, ProposalAim, ReadingDeviations, cable_exchange,
    encoder_of_other_sign, proposals, search,
};
use funicular::math::Vec3;
use funicular::math::chosen_rows::RowCriterion;
use funicular::robot::{Pose, Robot};
use funicular::statics::{self, StaticModel};
use published::*;
use std::fmt::Write as _;

/// Robot file of a platform with these anchors and attachments.
fn robot(motion: &str, anchors: &[[f64; 3]], attachments: &[[f64; 3]]) -> Robot {
    let inertia = if motion == "point-mass" { "" } else { "inertia_kg_m2 = [1, 1, 1]\n" };
    let mut text = format!(
        "name = \"robot\"\n[platform]\nmass_kg = 10\n{inertia}motion = \"{motion}\"\n[materials.rope]\n\
         axial_stiffness_n = 1e6\nmass_kg_per_m = 0.0\n"
    );
    for (i, (anchor, attachment)) in anchors.iter().zip(attachments).enumerate() {
        let attachment =
            if motion == "point-mass" { String::new() } else { format!("attachment_m = {attachment:?}\n") };
        let name = i + 1;
        let _ = write!(text, "[[cables]]\nname = \"{name}\"\nmaterial = \"rope\"\nanchor_m = {anchor:?}\n{attachment}");
    }
    Robot::from_toml(&text).unwrap()
}

/// Planar robot whose cables end in one point.
fn planar(anchors: &[[f64; 2]]) -> Robot {
    let anchors: Vec<[f64; 3]> = anchors.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
    robot("planar-xy", &anchors, &vec![[0.0; 3]; anchors.len()])
}

/// All coordinates of the anchors along axes, and the offsets.
fn unknowns(cables: usize, axes: &[usize], offsets: bool) -> Vec<CalibrationUnknown> {
    let anchors =
        (0..cables).flat_map(|cable| axes.iter().map(move |&axis| CalibrationUnknown::Anchor { cable, axis }));
    let offsets = (0..if offsets { cables } else { 0 }).map(|cable| CalibrationUnknown::Offset { cable });
    anchors.chain(offsets).collect()
}

fn rows<const N: usize>(readings: &[[f64; N]]) -> Vec<MeasuredRow> {
    readings.iter().map(|row| MeasuredRow::of_readings(row)).collect()
}

fn deviations(reading: f64) -> ReadingDeviations {
    ReadingDeviations { reading, position: 1.0, angle: 1.0, tension: 1.0, tension_prior: None }
}

fn as_candidates(poses: &[Pose]) -> Vec<CandidatePose> {
    poses.iter().copied().map(CandidatePose::from).collect()
}

/// Best fit with its frame and precision.
fn fitted(of: &Calibration) -> (CalibrationFit, CalibrationFrame, CalibrationPrecision) {
    let frame = of.frame(&FrameChoice::Anchors(Vec::new())).unwrap();
    of.check_count(&frame).unwrap();
    let found = search(of, &frame, 10, &mut |_, _| true).unwrap();
    let frame = of.frame_about(&frame, &found.best);
    let precision = of.precision(&found.best, &frame);
    (found.best, frame, precision)
}

/// Machine with belts bl, br, tr, tl, started from a rectangle [m].
fn machine() -> Calibration {
    let start = planar(&[[0.0, 0.0], [4.4, 0.0], [4.4, 3.7], [0.0, 3.7]]);
    let readings = MACHINE_LENGTHS_MM.map(|row| row.map(|length| length * 1e-3));
    Calibration::new(start, unknowns(4, &[0, 1], false), rows(&readings), deviations(1e-3), StaticModel::Ideal).unwrap()
}

#[test]
fn the_anchors_of_a_measured_machine_are_those_of_the_separate_program() {
    let of = machine();
    let (fit, frame, precision) = fitted(&of);
    // bl and the height of br are held.
    assert_eq!((frame.held.clone(), frame.held_coordinates.clone()), (vec![0, 1], vec![2, 1]));
    let expected = [0.0, 0.0, 4654.596, 0.0, 4629.124, 3854.9, -167.129, 3897.353];
    for (value, expected) in fit.values.iter().zip(expected) {
        // Printed digits: 1 µm.
        assert!((1e3 * value - expected).abs() < 1e-3, "{value} {expected}");
    }

    // Residuals and the deviations that they give.
    let rms = 1e3 * (fit.chi2 * 1e-6 / 24.0).sqrt();
    assert!((rms - 0.279_623_106_050_770_5).abs() < 1e-9, "{rms}");
    assert_eq!(precision.degrees, 7);
    let factor = (fit.chi2 / 7.0).sqrt();
    let found = precision.deviations();
    for (k, expected) in [(6, 7.9646), (7, 58.3574), (4, 52.7678), (5, 63.5492), (2, 52.1068)] {
        assert!((1e3 * factor * found[k] - expected).abs() < 1e-3, "{} {expected}", 1e3 * factor * found[k]);
    }
    assert!((1e3 * factor * precision.total() - 114.048_610_188_498_3).abs() < 1e-4);
    assert!((1e3 * factor * precision.weakest() - 113.5018).abs() < 1e-3);

    // The weakest combination is a narrower and higher figure.
    let weak = &of.weak_combinations(&fit, &frame, &precision, 1)[0];
    let stretches: Vec<_> = weak.parts.iter().map(|(part, amount)| (*part, amount.signum())).collect();
    assert_eq!(stretches.len(), 2);
    assert!(stretches.iter().all(|(part, _)| matches!(part, CombinationPart::Stretch { .. })) && weak.share > 0.99);
    assert!((stretches[0].1 + stretches[1].1).abs() < 0.5);
    let walk = of.weak_walk(&fit, &frame, &precision, factor).unwrap();
    assert!(walk.is_parabola(), "{walk:?}");
}

#[test]
fn the_best_seventh_waypoint_of_the_machine_is_that_of_the_separate_program() {
    let of = machine();
    let (fit, frame, precision) = fitted(&of);
    let factor = (fit.chi2 / 7.0).sqrt();
    let step =
        |from: f64, to: f64, count: u32, k: u32| 1e-3 * (from + (to - from) * f64::from(k) / f64::from(count - 1));
    let candidates: Vec<Pose> = (0..9)
        .flat_map(|i| {
            (0..8).map(move |j| Pose::new([step(400.0, 4200.0, 9, i), step(400.0, 3500.0, 8, j), 0.0], [0.0; 3]))
        })
        .collect();
    let found = proposals(
        &of,
        &fit,
        (&frame, &precision),
        &as_candidates(&candidates),
        (4, RowCriterion::Variances),
        ProposalAim::Unknowns(&[1.0; 8]),
    );
    let expected = [10.789284728505201, 2.8840135312273465, 2.101212252099524, 1.6298456577935716];
    for (pose, expected) in found.iter().zip(expected) {
        // The separate program agrees with its own dense refit to 5e-5; both solve the same linear problem.
        assert!((1e3 * factor * pose.total / expected - 1.0).abs() < 1e-6, "{} {expected}", 1e3 * factor * pose.total);
    }
    let best = candidates[found[0].candidate].position_w;
    assert!((best - Vec3::new(3.725, 3.5, 0.0)).norm() < 1e-12, "{best}");

    // Rows left out, in the variance of the residuals.
    let expected = [0.1414, 4.304, 3.216, 2.808, 0.0214, 0.431];
    for (row, expected) in precision.rows_left_out(&frame).iter().zip(expected) {
        let drop = row.chi2_drop.unwrap() / (factor * factor);
        // Printed digits.
        assert!((drop - expected).abs() < 1e-3, "{drop} {expected}");
    }
    // Inner conditions: the deviations that the least trace gives.
    let inner = frame.inner(&precision.covariance);
    for (k, expected) in [26.6, 29.46, 25.51, 31.52, 24.49, 32.04, 23.41, 28.95].into_iter().enumerate() {
        // Printed digits.
        assert!((1e3 * factor * inner[(k, k)].sqrt() - expected).abs() < 0.006, "{k}");
    }
}

fn plane_set() -> Calibration {
    let start = planar(&PLANE_START);
    Calibration::new(start, unknowns(4, &[0, 1], true), rows(&PLANE_READINGS), deviations(0.4e-3), StaticModel::Ideal)
        .unwrap()
}

/// Compares values and deviations with published ones; `held` are the unknowns that the frame holds.
fn compare(fit: &CalibrationFit, precision: &CalibrationPrecision, held: &[usize], values: &[f64], expected: &[f64]) {
    let deviations = precision.deviations();
    let free: Vec<usize> = (0..fit.values.len()).filter(|k| !held.contains(k)).collect();
    assert_eq!(free.len(), values.len());
    for (n, &k) in free.iter().enumerate() {
        assert!((fit.values[k] - values[n]).abs() < 1e-4 * expected[n], "{n}: {} {}", fit.values[k], values[n]);
        assert!((deviations[k] / expected[n] - 1.0).abs() < 1e-4, "{n}: {} {}", deviations[k], expected[n]);
    }
}

#[test]
fn a_planar_set_with_offsets_agrees_with_the_separate_program() {
    let of = plane_set();
    let (fit, frame, precision) = fitted(&of);
    compare(&fit, &precision, &[0, 1, 3], &PLANE_VALUES, &PLANE_DEVIATIONS);
    assert!((fit.chi2 - 4.3091526).abs() < 1e-4 && precision.degrees == 9);
    for (row, expected) in precision.rows_left_out(&frame).iter().zip(PLANE_LEFT_OUT) {
        assert!((row.chi2_drop.unwrap() - expected).abs() < 1e-3 * (1.0 + expected));
    }
    for (candidate, expected) in PLANE_CANDIDATES.iter().zip(PLANE_AFTER_CANDIDATE) {
        let pose = Pose::new([candidate[0], candidate[1], 0.0], [0.0; 3]);
        let found = proposals(
            &of,
            &fit,
            (&frame, &precision),
            &[pose.into()],
            (1, RowCriterion::Variances),
            ProposalAim::Unknowns(&[1.0; 12]),
        );
        assert!((found[0].total / expected - 1.0).abs() < 1e-3, "{} {expected}", found[0].total);
    }
}

fn rigid_set() -> Calibration {
    let start = robot("rigid", &RIGID_START, &RIGID_ATTACHMENTS);
    Calibration::new(
        start,
        unknowns(8, &[0, 1, 2], true),
        rows(&RIGID_READINGS),
        deviations(0.5e-3),
        StaticModel::Ideal,
    )
    .unwrap()
}

#[test]
fn a_rigid_platform_with_eight_cables_agrees_with_the_separate_program() {
    let of = rigid_set();
    let (fit, frame, precision) = fitted(&of);
    // Anchor 1, y and z of anchor 2, z of anchor 3.
    compare(&fit, &precision, &[0, 1, 2, 4, 5, 8], &RIGID_VALUES, &RIGID_DEVIATIONS);
    assert!((fit.chi2 - 28.180715).abs() < 1e-4 && precision.degrees == 38, "{}", fit.chi2);
    for (row, expected) in precision.rows_left_out(&frame).iter().zip(RIGID_LEFT_OUT) {
        assert!((row.chi2_drop.unwrap() - expected).abs() < 2e-3 * (1.0 + expected));
    }
    for (k, expected) in RIGID_AFTER_CANDIDATE.iter().enumerate() {
        let [x, y, z] = RIGID_TURNS_DEG[k].map(f64::to_radians);
        let pose = Pose::new(RIGID_CANDIDATES[k], [0.0; 3]).moved(&Vec3::zeros(), &Vec3::new(x, y, z));
        let found = proposals(
            &of,
            &fit,
            (&frame, &precision),
            &[pose.into()],
            (1, RowCriterion::Variances),
            ProposalAim::Unknowns(&[1.0; 32]),
        );
        assert!((found[0].total / expected - 1.0).abs() < 1e-3, "{} {expected}", found[0].total);
    }
    let walk = of.weak_walk(&fit, &frame, &precision, 1.0).unwrap();
    assert!(walk.is_parabola(), "{walk:?}");
}

/// Random numbers of a fixed seed.
struct Draws(u64);

impl Draws {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, reach: f64) -> f64 {
        reach * (2.0 * self.uniform() - 1.0)
    }

    /// Box and Muller.
    fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.uniform()).ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

/// Readings of a robot at poses, with offsets and noise.
fn readings(of: &Robot, poses: &[Pose], offsets: &[f64], deviation: f64, draws: &mut Draws) -> Vec<MeasuredRow> {
    poses
        .iter()
        .map(|pose| {
            let cables = of.cables.iter().zip(offsets);
            let row: Vec<f64> = cables
                .map(|(cable, offset)| cable.straight_length(pose) - offset + deviation * draws.normal())
                .collect();
            MeasuredRow::of_readings(&row)
        })
        .collect()
}

/// Robot whose anchors are moved at random, as a file with errors has them; the first anchors keep the frame.
fn with_errors(of: &Robot, reach: f64, draws: &mut Draws) -> Robot {
    let mut robot = of.clone();
    let axes: &[usize] = if of.platform.motion.count() == 3 && of.cables.iter().all(|c| c.anchor.point_w.z == 0.0) {
        &[0, 1]
    } else {
        &[0, 1, 2]
    };
    for (i, cable) in robot.cables.iter_mut().enumerate() {
        // The first anchor stays, the second on the line and the third in the plane of the file.
        for &axis in axes.iter().filter(|axis| i > 2 || (i == 2 && **axis < 2) || (i == 1 && **axis < 1)) {
            cable.anchor.point_w[axis] += draws.within(reach);
        }
    }
    robot
}

/// Robot in space with five cables that end in one point; anchors at different heights.
fn camera() -> Robot {
    let anchors =
        [[0.0, 0.0, 0.0], [9.0, 0.0, 0.0], [8.5, 7.0, 0.0], [-0.3, 6.8, 1.4], [4.0, 3.0, 5.5], [1.0, 6.0, 4.0]];
    robot("point-mass", &anchors, &[[0.0; 3]; 6])
}

/// Poses about the middle of the camera's room.
fn camera_poses(count: usize, draws: &mut Draws) -> Vec<Pose> {
    let position = |draws: &mut Draws| [4.3 + draws.within(3.0), 3.4 + draws.within(2.5), 2.0 + draws.within(1.8)];
    (0..count).map(|_| Pose::new(position(draws), [0.0; 3])).collect()
}

#[test]
fn derivatives_are_those_of_differences() {
    // χ² of a calibration along each unknown, against the exact step of the undamped fit: a fit of exact readings from
    // a start that is off arrives at the truth only with true derivatives, and quadratically.
    let mut draws = Draws(11);
    let truth = robot("rigid", &RIGID_START, &RIGID_ATTACHMENTS);
    let poses: Vec<Pose> = (0..32)
        .map(|_| {
            let place = [3.0 + draws.within(1.2), 2.5 + draws.within(1.0), 1.6 + draws.within(0.7)];
            Pose::new(place, [draws.within(15.0), draws.within(15.0), draws.within(20.0)])
        })
        .collect();
    let rows = readings(&truth, &poses, &[0.01; 8], 0.0, &mut draws);
    let mut all = unknowns(8, &[0, 1, 2], true);
    all.extend((3..8).flat_map(|cable| (0..3).map(move |axis| CalibrationUnknown::Attachment { cable, axis })));
    all.push(CalibrationUnknown::Scale);
    let mut start = with_errors(&truth, 0.02, &mut draws);
    for cable in &mut start.cables[3..] {
        cable.attachment_p.x += draws.within(0.005);
    }
    let of = Calibration::new(start, all, rows, deviations(1e-3), StaticModel::Ideal).unwrap();
    let (fit, ..) = fitted(&of);
    // A wrong derivative of 1 % would leave some 1e-2 of the starting error; rounding times the condition leaves 1e-9.
    assert!(fit.converged && fit.chi2 < 1e-9, "{}", fit.chi2);
    let found = of.robot_at(&fit.values);
    for (cable, truth) in found.robot.cables.iter().zip(&truth.cables) {
        assert!((cable.anchor.point_w - truth.anchor.point_w).norm() < 1e-5);
        assert!((cable.attachment_p - truth.attachment_p).norm() < 1e-5);
    }
    assert!((found.scale - 1.0).abs() < 1e-5 && found.offsets.iter().all(|offset| (offset - 0.01).abs() < 1e-5));
}

/// Fits 100 noise draws; compares the share of 95 % intervals that hold the truth, and the mean of χ².
fn cover(truth: &Robot, poses: &[Pose], all: &[CalibrationUnknown], deviation: f64, draws: &mut Draws) {
    let (mut held, mut count, mut chi2, mut degrees) = (0.0, 0.0, 0.0, 0.0);
    for _ in 0..100 {
        let offsets = vec![0.0; truth.cables.len()];
        let rows = readings(truth, poses, &offsets, deviation, draws);
        let of =
            Calibration::new(truth.clone(), all.to_vec(), rows, deviations(deviation), StaticModel::Ideal).unwrap();
        let (fit, frame, precision) = fitted(&of);
        chi2 += fit.chi2 / 100.0;
        degrees = precision.degrees as f64;
        for (k, (value, own)) in fit.values.iter().zip(precision.deviations()).enumerate() {
            if !frame.holds(k) {
                count += 1.0;
                held += if (value - of.start()[k]).abs() < 1.96 * own { 1.0 } else { 0.0 };
            }
        }
    }
    // Values of one draw are correlated: 100 independent ones, 95 % ± 2.2 %, three deviations to either side.
    assert!(held / count > 0.885, "{held} of {count}");
    // The mean of 100 draws has a tenth of the deviation of χ²; three of them to either side.
    assert!((chi2 - degrees).abs() < 0.3 * (2.0 * degrees).sqrt(), "{chi2} {degrees}");
}

#[test]
fn intervals_hold_the_truth_and_chi_squared_is_that_of_noise() {
    let mut draws = Draws(5);
    let plane = planar(&[[0.0, 0.0], [3.6, 0.0], [3.5, 2.5], [0.1, 2.3]]);
    let poses: Vec<Pose> =
        (0..12).map(|_| Pose::new([1.8 + draws.within(1.4), 1.2 + draws.within(0.9), 0.0], [0.0; 3])).collect();
    cover(&plane, &poses, &unknowns(4, &[0, 1], false), 0.5e-3, &mut draws);

    let poses = camera_poses(20, &mut draws);
    cover(&camera(), &poses, &unknowns(6, &[0, 1, 2], true), 1e-3, &mut draws);
}

#[test]
fn a_reading_that_is_one_per_cent_off_is_found_and_named() {
    let mut readings = PLANE_READINGS;
    readings[4][2] *= 1.01;
    let start = planar(&PLANE_START);
    let of =
        Calibration::new(start, unknowns(4, &[0, 1], true), rows(&readings), deviations(0.4e-3), StaticModel::Ideal)
            .unwrap();
    let (fit, frame, precision) = fitted(&of);
    // 14 mm are 34 deviations, of which offsets and anchors take most; noise gives 9 ± 4.2, four deviations up to 26.
    assert!(fit.chi2 > 26.0, "{}", fit.chi2);
    let left_out = precision.rows_left_out(&frame);
    let worst = (0..9).max_by(|a, b| {
        let drop = |row: &usize| left_out[*row].chi2_drop.unwrap_or_default();
        drop(a).total_cmp(&drop(b))
    });
    assert_eq!(worst, Some(4));
}

#[test]
fn a_ceiling_and_a_floor_do_not_determine_the_anchors() {
    let mut draws = Draws(9);
    let truth = robot(
        "point-mass",
        &[[0.0, 0.0, 4.0], [7.0, 0.0, 4.0], [7.2, 5.0, 4.0], [0.1, 5.2, 4.0], [3.0, 6.0, 4.0], [5.0, -1.0, 4.0]],
        &[[0.0; 3]; 6],
    );
    let poses: Vec<Pose> =
        (0..30).map(|_| Pose::new([3.5 + draws.within(2.5), 2.5 + draws.within(2.0), 1.0], [0.0; 3])).collect();
    // Without noise three combinations are lost.
    let exact = readings(&truth, &poses, &[0.0; 6], 0.0, &mut draws);
    let of =
        Calibration::new(truth.clone(), unknowns(6, &[0, 1, 2], false), exact, deviations(1e-3), StaticModel::Ideal)
            .unwrap();
    let frame = of.frame(&FrameChoice::Anchors(Vec::new())).unwrap();
    let fit = CalibrationFit {
        values: of.start(),
        poses: poses.clone(),
        lengths: Vec::new(),
        chi2: 0.0,
        iterations: 0,
        converged: true,
    };
    let precision = of.precision(&fit, &frame);
    assert_eq!(precision.lost.len(), 3);
    // A pose off the plane has three net rows, which give what is lost; poses in the plane never do.
    let candidates: Vec<Pose> = (0..12)
        .map(|k| Pose::new([1.0 + 0.5 * f64::from(k), 0.7 + f64::from(k % 4), if k < 6 { 1.0 } else { 2.5 }], [0.0; 3]))
        .collect();
    let found = proposals(
        &of,
        &fit,
        (&frame, &precision),
        &as_candidates(&candidates),
        (1, RowCriterion::Variances),
        ProposalAim::Unknowns(&[1.0; 18]),
    );
    assert!(found[0].candidate >= 6 && found[0].total < 0.2, "{found:?}");
    let in_plane = proposals(
        &of,
        &fit,
        (&frame, &precision),
        &as_candidates(&candidates[..6]),
        (3, RowCriterion::Variances),
        ProposalAim::Unknowns(&[1.0; 18]),
    );
    assert!(in_plane[2].total > 1.0, "{in_plane:?}");

    // Noise hides them from the linearisation, but not from the walk.
    let noisy = readings(&truth, &poses, &[0.0; 6], 1e-3, &mut draws);
    let of =
        Calibration::new(truth, unknowns(6, &[0, 1, 2], false), noisy, deviations(1e-3), StaticModel::Ideal).unwrap();
    let frame = of.frame(&FrameChoice::Anchors(Vec::new())).unwrap();
    let found = search(&of, &frame, 10, &mut |_, _| true).unwrap();
    // Either several figures fit, or one whose walk is no parabola.
    let is_sound = |fit: &CalibrationFit| {
        let frame = of.frame_about(&frame, fit);
        let precision = of.precision(fit, &frame);
        precision.lost.is_empty() && of.weak_walk(fit, &frame, &precision, 1.0).unwrap().is_parabola()
    };
    assert!(!found.others.is_empty() || !is_sound(&found.best));
}

#[test]
fn data_that_cannot_calibrate_are_refused_with_their_remedy() {
    // 24 lengths of two rows fewer: 16 lengths for 5 and 8 unknowns suffice, 8 for 5 and 4 do not.
    let start = planar(&PLANE_START);
    let of = |rows: Vec<MeasuredRow>, all: Vec<CalibrationUnknown>| {
        let of = Calibration::new(start.clone(), all, rows, deviations(1e-3), StaticModel::Ideal)?;
        let frame = of.frame(&FrameChoice::Anchors(Vec::new()))?;
        of.check_count(&frame)
    };
    let error = of(rows(&PLANE_READINGS[..2]), unknowns(4, &[0, 1], false)).unwrap_err().to_string();
    assert_eq!(
        error,
        "8 data cannot give 5 unknowns of the robot and 4 of the poses: measure at least 3 rows with all cables"
    );
    let mut all = unknowns(4, &[0, 1], false);
    all.push(CalibrationUnknown::Scale);
    let error = of(rows(&PLANE_READINGS), all).unwrap_err().to_string();
    assert!(error.contains("say nothing about the size of the robot"), "{error}");
    let mut few = rows(&PLANE_READINGS);
    few[3].readings = vec![Some(1.0), None, None, None];
    let error = of(few, unknowns(4, &[0, 1], false)).unwrap_err().to_string();
    assert!(error.starts_with("the data of row 4 do not fix its pose (1 data, 2 coordinates)"), "{error}");
}

#[test]
fn exchanged_cables_are_named() {
    let mut draws = Draws(21);
    let truth = robot("rigid", &RIGID_START, &RIGID_ATTACHMENTS);
    let poses: Vec<Pose> = (0..20)
        .map(|_| {
            let place = [3.0 + draws.within(1.2), 2.5 + draws.within(1.0), 1.6 + draws.within(0.7)];
            Pose::new(place, [draws.within(15.0), draws.within(15.0), draws.within(15.0)])
        })
        .collect();
    let mut rows = readings(&truth, &poses, &[0.0; 8], 0.5e-3, &mut draws);
    for row in &mut rows {
        row.readings.swap(2, 5);
    }
    let start = with_errors(&truth, 0.05, &mut draws);
    let of = |rows| {
        Calibration::new(start.clone(), unknowns(8, &[0, 1, 2], false), rows, deviations(0.5e-3), StaticModel::Ideal)
            .unwrap()
    };
    let all = of(rows);
    let frame = all.frame(&FrameChoice::Anchors(Vec::new())).unwrap();
    let found = search(&all, &frame, 2, &mut |_, _| true).unwrap();
    assert_eq!(cable_exchange(&all, &found.best, &frame).unwrap().cables, [2, 5]);
}

#[test]
fn eight_cables_with_sixty_rows_are_calibrated_in_a_moment() {
    let mut draws = Draws(8);
    let truth = robot("rigid", &RIGID_START, &RIGID_ATTACHMENTS);
    let poses: Vec<Pose> = (0..60)
        .map(|_| {
            let place = [3.0 + draws.within(1.2), 2.5 + draws.within(1.0), 1.6 + draws.within(0.7)];
            Pose::new(place, [draws.within(15.0), draws.within(15.0), draws.within(20.0)])
        })
        .collect();
    let rows = readings(&truth, &poses, &[0.004; 8], 0.5e-3, &mut draws);
    let start = with_errors(&truth, 0.1, &mut draws);
    let of =
        Calibration::new(start, unknowns(8, &[0, 1, 2], true), rows, deviations(0.5e-3), StaticModel::Ideal).unwrap();
    let begun = std::time::Instant::now();
    let (fit, frame, precision) = fitted(&of);
    let walk = of.weak_walk(&fit, &frame, &precision, 1.0).unwrap();
    let seconds = begun.elapsed().as_secs_f64();
    // Measured: 0.6 s in this profile on two busy cores.
    assert!(seconds < 10.0, "{seconds} s");
    // 480 readings less 26 and 360 unknowns: 94 ± 14, four deviations.
    assert!(walk.is_parabola() && precision.degrees == 94 && fit.chi2 < 150.0, "{} {walk:?}", fit.chi2);
}

/// Point mass on four elastic catenaries, with measured tensions.
fn sagging(tensions: bool) -> Result<Calibration, CalibrationError> {
    let mut robot = robot("point-mass", &SAG_START, &[[0.0; 3]; 4]);
    robot.gravity_w = Vec3::new(0.0, 0.0, -9.81);
    robot.platform.mass = 196.2 / 9.81;
    for cable in &mut robot.cables {
        cable.material.axial_stiffness = 130e3;
        cable.material.mass_per_length = 1.18 / 9.81;
    }
    let row = |(readings, measured): (&[f64; 4], &[f64; 4])| MeasuredRow {
        tensions: if tensions { measured.iter().copied().map(Some).collect() } else { Vec::new() },
        ..MeasuredRow::of_readings(readings)
    };
    let rows = SAG_READINGS.iter().zip(&SAG_TENSIONS).map(row).collect();
    let mut all = unknowns(4, &[0, 1, 2], true);
    all.push(CalibrationUnknown::AxialStiffness);
    let deviations = ReadingDeviations { reading: 1e-3, position: 1.0, angle: 1.0, tension: 3.0, tension_prior: None };
    Calibration::new(robot, all, rows, deviations, StaticModel::Catenary)
}

#[test]
fn sagging_cables_with_tensions_agree_with_the_separate_program() {
    let of = sagging(true).unwrap();
    let frame = of.frame(&FrameChoice::Anchors(Vec::new())).unwrap();
    // Gravity leaves three shifts and a turn about the vertical.
    assert_eq!((frame.motion_count(), frame.held_coordinates.clone()), (4, vec![3, 1]));
    let found = search(&of, &frame, 2, &mut |_, _| true).unwrap();
    let (fit, frame) = (&found.best, of.frame_about(&frame, &found.best));
    let precision = of.precision(fit, &frame);
    // The separate program: values within 5e-3 deviations and deviations within 1e-3, the noise of its differences.
    assert!((fit.chi2 - 87.273307).abs() < 1e-3 && precision.degrees == 83, "{} {}", fit.chi2, precision.degrees);
    let free: Vec<usize> = (0..17).filter(|k| !frame.holds(*k)).collect();
    let deviations = precision.deviations();
    for ((&k, expected), deviation) in free.iter().zip(SAG_VALUES).zip(SAG_DEVIATIONS) {
        let [value, rate] = of.meaning(k, fit.values[k]);
        let (value, own) =
            if k == 16 { ((130e3 * value).ln(), deviations[k] * rate / value) } else { (value, deviations[k]) };
        assert!((value - expected).abs() < 5e-3 * deviation, "{k} {value} {expected}");
        assert!((own / deviation - 1.0).abs() < 1e-3, "{k} {own} {deviation}");
    }
}

#[test]
fn lengths_of_elastic_cables_alone_say_nothing() {
    let error = sagging(false).unwrap_err();
    assert_eq!(error, CalibrationError::ElasticLengthsAlone);
    assert!(error.to_string().contains("measure tensions too"));
}

#[test]
fn an_encoder_that_counts_down_is_named() {
    let mut readings = PLANE_READINGS;
    // Zero at 2 m, and down from there.
    for row in &mut readings {
        row[1] = 2.0 - row[1];
    }
    let start = planar(&PLANE_START);
    let of =
        Calibration::new(start, unknowns(4, &[0, 1], true), rows(&readings), deviations(0.4e-3), StaticModel::Ideal)
            .unwrap();
    let frame = of.frame(&FrameChoice::Anchors(Vec::new())).unwrap();
    let found = search(&of, &frame, 3, &mut |_, _| true).unwrap();
    let (cable, chi2) = encoder_of_other_sign(&of, &found.best, &frame).unwrap();
    // χ² of the set as it is.
    assert!(cable == 1 && (chi2 - 4.3091526).abs() < 1e-3, "{cable} {chi2}");
}

/// Rigid platform on eight elastic, sagging cables.
fn on_ropes() -> Robot {
    let mut made = robot("rigid", &RIGID_START, &RIGID_ATTACHMENTS);
    made.platform.mass = 40.0;
    for cable in &mut made.cables {
        cable.material.axial_stiffness = 2e5;
        cable.material.mass_per_length = 0.05;
    }
    made
}

/// Eight elastic cables around a rigid platform, whose lengths and tensions are those of equilibria with noise.
#[test]
fn a_rigid_platform_on_elastic_cables_is_calibrated_with_tensions() {
    let mut draws = Draws(41);
    let truth = on_ropes();
    let mut rows = Vec::new();
    while rows.len() < 60 {
        let place = [3.0 + draws.within(1.2), 2.5 + draws.within(1.0), 1.6 + draws.within(0.7)];
        let pose = Pose::new(place, [draws.within(10.0), draws.within(10.0), draws.within(10.0)]);
        // Shortened by up to 4 ‰, each by itself, so that the tensions differ.
        let lengths: Vec<f64> =
            truth.cables.iter().map(|cable| cable.straight_length(&pose) * (0.998 + draws.within(0.002))).collect();
        let Ok(rest) = statics::forward(&truth, &lengths, StaticModel::Catenary, Some(&pose)) else { continue };
        let readings: Vec<f64> = lengths.iter().map(|length| length - 0.01 + 1e-3 * draws.normal()).collect();
        let tensions = rest.cables.iter().map(|cable| Some(cable.tension_anchor + 3.0 * draws.normal())).collect();
        rows.push(MeasuredRow { tensions, start: Some(pose), ..MeasuredRow::of_readings(&readings) });
    }

    let start = with_errors(&truth, 0.05, &mut draws);
    let deviations = ReadingDeviations { reading: 1e-3, position: 1.0, angle: 1.0, tension: 3.0, tension_prior: None };
    let of = Calibration::new(start, unknowns(8, &[0, 1, 2], true), rows, deviations, StaticModel::Catenary).unwrap();
    let begun = std::time::Instant::now();
    let (fit, frame, precision) = fitted(&of);
    let seconds = begun.elapsed().as_secs_f64();
    println!("{seconds} s, {} iterations, {}", fit.iterations, fit.chi2);
    // Gravity leaves four motions: 960 data less 28 and 480 unknowns, 452 ± 30, four deviations.
    assert!(frame.motion_count() == 4 && precision.degrees == 452 && (fit.chi2 - 452.0).abs() < 120.0, "{}", fit.chi2);
    for of_pair in of.anchor_distances(&fit, &precision) {
        let [a, b] = of_pair.cables.map(|cable| truth.cables[cable].anchor.point_w);
        assert!((of_pair.distance - (a - b).norm()).abs() < 4.5 * of_pair.deviation, "{of_pair:?}");
    }
}
