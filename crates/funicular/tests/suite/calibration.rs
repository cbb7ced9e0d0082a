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
