//! Calibration from lengths alone: published belts of a machine, synthetic sets of a separate program, derivatives against
//! differences, coverage of intervals, starts from nothing, and data that are wrong.

mod published;

use funicular::calibration::{
    Calibration, CalibrationFit, CalibrationFrame, CalibrationPrecision, CalibrationUnknown, CombinationPart,
    FrameChoice, MeasuredRow, ReadingDeviations, proposals, search,
};
use funicular::math::Vec3;
use funicular::robot::{Pose, Robot};
use published::*;

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
        text += &format!("[[cables]]\nname = \"{}\"\nmaterial = \"rope\"\nanchor_m = {anchor:?}\n{attachment}", i + 1);
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
    let anchors = (0..cables).flat_map(|cable| axes.iter().map(move |&axis| CalibrationUnknown::Anchor { cable, axis }));
    let offsets = (0..if offsets { cables } else { 0 }).map(|cable| CalibrationUnknown::Offset { cable });
    anchors.chain(offsets).collect()
}

fn rows<const N: usize>(readings: &[[f64; N]]) -> Vec<MeasuredRow> {
    readings.iter().map(|row| MeasuredRow::of_readings(row)).collect()
}

fn deviations(reading: f64) -> ReadingDeviations {
    ReadingDeviations { reading, position: 1.0 }
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
    Calibration::new(start, unknowns(4, &[0, 1], false), rows(&readings), deviations(1e-3)).unwrap()
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
    let step = |from: f64, to: f64, count: u32, k: u32| 1e-3 * (from + (to - from) * f64::from(k) / f64::from(count - 1));
    let candidates: Vec<Pose> = (0..9)
        .flat_map(|i| (0..8).map(move |j| Pose::new([step(400.0, 4200.0, 9, i), step(400.0, 3500.0, 8, j), 0.0], [0.0; 3])))
        .collect();
    let found = proposals(&of, &fit, &frame, &precision, &candidates, 4, &[1.0; 8]);
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
        println!("{k} {} {expected}", 1e3 * factor * inner[(k, k)].sqrt());
    }
}

fn plane_set() -> Calibration {
    let start = planar(&PLANE_START);
    Calibration::new(start, unknowns(4, &[0, 1], true), rows(&PLANE_READINGS), deviations(0.4e-3)).unwrap()
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
        let found = proposals(&of, &fit, &frame, &precision, &[pose], 1, &[1.0; 12]);
        assert!((found[0].total / expected - 1.0).abs() < 1e-3, "{} {expected}", found[0].total);
    }
}

fn rigid_set() -> Calibration {
    let start = robot("rigid", &RIGID_START, &RIGID_ATTACHMENTS);
    Calibration::new(start, unknowns(8, &[0, 1, 2], true), rows(&RIGID_READINGS), deviations(0.5e-3)).unwrap()
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
        let found = proposals(&of, &fit, &frame, &precision, &[pose], 1, &[1.0; 32]);
        assert!((found[0].total / expected - 1.0).abs() < 1e-3, "{} {expected}", found[0].total);
    }
    let walk = of.weak_walk(&fit, &frame, &precision, 1.0).unwrap();
    assert!(walk.is_parabola(), "{walk:?}");
}
