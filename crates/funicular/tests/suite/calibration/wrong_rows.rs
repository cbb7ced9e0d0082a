//! Rows and columns with exchanged readings, mirror images of anchors, and factors among lengths.

use super::more_unknowns::rigid_poses;
use super::*;
use funicular::calibration::{WrongRow, wrong_rows};
use funicular::robot::State;
use funicular::statics::TensionRule;

/// Largest decrease of χ² that noise may give in a test with many rows.
const NOISE: f64 = 40.0;

/// Readings of two cables of a row that differ by more than this are worth exchanging [m].
const APART: f64 = 0.3;

/// Calibration of the anchors from rows at poses, with 0.5 mm of noise, from a file with errors.
fn of_rows(truth: &Robot, rows: Vec<MeasuredRow>, errors: f64, draws: &mut Draws) -> Calibration {
    let axes: &[usize] =
        if truth.cables.iter().all(|cable| cable.anchor.point_w.z == 0.0) { &[0, 1] } else { &[0, 1, 2] };
    let all = unknowns(truth.cables.len(), axes, false);
    Calibration::new(with_errors(truth, errors, draws), all, rows, deviations(0.5e-3), StaticModel::Ideal).unwrap()
}

/// Two cables of a row whose readings differ enough.
fn pair_of(row: &MeasuredRow, draws: &mut Draws) -> [usize; 2] {
    let count = row.readings.len();
    loop {
        let [a, b] = [0, 0].map(|_| (draws.uniform() * count as f64) as usize);
        if a < b && (row.readings[a].unwrap() - row.readings[b].unwrap()).abs() > APART {
            return [a, b];
        }
    }
}

fn found_wrong(of: &Calibration) -> Vec<WrongRow> {
    let frame = of.frame(&FrameChoice::Anchors(Vec::new())).unwrap();
    let found = search(of, &frame, 10, &mut |_, _| true).unwrap();
    wrong_rows(of, &found.best, &frame, 1.0, &|row| row.chi2_drop > NOISE)
}

/// Robots with their poses: in a plane, a point in space, and a rigid platform.
fn robots(draws: &mut Draws) -> [(Robot, Vec<Pose>); 3] {
    let plane = planar(&[[0.0, 0.0], [4.4, 0.0], [4.3, 3.7], [-0.1, 3.6]]);
    let in_plane =
        (0..12).map(|_| Pose::new([2.2 + draws.within(1.5), 1.8 + draws.within(1.2), 0.0], [0.0; 3])).collect();
    let rigid = robot("rigid", &RIGID_START, &RIGID_ATTACHMENTS);
    [(plane, in_plane), (camera(), camera_poses(14, draws)), (rigid, rigid_poses(20, 15.0, draws))]
}

/// The row drags the fit, whose linearisation blames others.
#[test]
fn a_row_with_two_exchanged_readings_is_named_with_its_cables() {
    for seed in [3, 14, 15] {
        let mut draws = Draws(seed);
        for (truth, poses) in robots(&mut draws) {
            let mut rows = readings(&truth, &poses, &vec![0.0; truth.cables.len()], 0.5e-3, &mut draws);
            let wrong = (draws.uniform() * rows.len() as f64) as usize;
            let cables = pair_of(&rows[wrong], &mut draws);
            rows[wrong].readings.swap(cables[0], cables[1]);
            let found = found_wrong(&of_rows(&truth, rows, 0.05, &mut draws));
            let says = format!("seed {seed}, {} cables, row {wrong}, {cables:?}: {found:?}", truth.cables.len());
            assert_eq!(found.len(), 1, "{says}");
            assert_eq!((found[0].row, found[0].exchange.map(|of| of.cables)), (wrong, Some(cables)), "{says}");
        }
    }
}

#[test]
fn two_wrong_rows_are_named_one_after_the_other() {
    let mut draws = Draws(26);
    let truth = camera();
    let mut rows = readings(&truth, &camera_poses(16, &mut draws), &[0.0; 6], 0.5e-3, &mut draws);
    let cables = pair_of(&rows[4], &mut draws);
    rows[4].readings.swap(cables[0], cables[1]);
    // One reading is a decimetre off, which no exchange explains.
    *rows[11].readings[2].as_mut().unwrap() += 0.1;
    let found = found_wrong(&of_rows(&truth, rows, 0.05, &mut draws));
    let mut named: Vec<_> = found.iter().map(|row| (row.row, row.exchange.map(|of| of.cables))).collect();
    named.sort_by_key(|(row, _)| *row);
    assert_eq!(named, [(4, Some(cables)), (11, None)], "{found:?}");
}

#[test]
fn sound_rows_are_not_blamed() {
    let mut draws = Draws(9);
    for (truth, poses) in robots(&mut draws) {
        let rows = readings(&truth, &poses, &vec![0.0; truth.cables.len()], 0.5e-3, &mut draws);
        let found = found_wrong(&of_rows(&truth, rows, 0.05, &mut draws));
        assert!(found.is_empty(), "{found:?}");
    }
}

#[test]
fn exchanged_columns_are_named_from_a_rough_start() {
    for (seed, errors) in [(5, 0.15), (6, 0.3)] {
        let mut draws = Draws(seed);
        let truth = robot("rigid", &RIGID_START, &RIGID_ATTACHMENTS);
        let mut rows = readings(&truth, &rigid_poses(20, 15.0, &mut draws), &[0.0; 8], 0.5e-3, &mut draws);
        let cables = pair_of(&rows[0], &mut draws);
        for row in &mut rows {
            row.readings.swap(cables[0], cables[1]);
        }
        let of = of_rows(&truth, rows, errors, &mut draws);
        let frame = of.frame(&FrameChoice::Anchors(Vec::new())).unwrap();
        let found = search(&of, &frame, 5, &mut |_, _| true).unwrap();
        let exchange = cable_exchange(&of, &found.best, &frame).unwrap();
        // 160 readings less 18 and 120 unknowns: 22 ± 7.
        assert!(exchange.cables == cables && exchange.chi2 < 60.0, "seed {seed}, {cables:?}: {exchange:?}");
    }
}

/// Rows on a line of a planar robot, or in a plane of a point in space: each anchor may stand on the other side.
#[test]
fn mirror_images_of_anchors_are_found_and_a_row_tells_them_apart() {
    for seed in [31, 32, 33] {
        let mut draws = Draws(seed);
        let plane = planar(&[[0.0, 0.0], [4.4, 0.0], [4.3, 3.7], [-0.1, 3.6]]);
        let on_line: Vec<Pose> = (0..12)
            .map(|_| {
                let along = draws.within(1.5);
                Pose::new([2.2 + along, 1.6 + 0.2 * along, 0.0], [0.0; 3])
            })
            .collect();
        let mut in_plane = camera_poses(24, &mut draws);
        for pose in &mut in_plane {
            pose.position_w.z = 2.0;
        }

        for (truth, poses) in [(plane, on_line), (camera(), in_plane)] {
            let mut rows = readings(&truth, &poses, &vec![0.0; truth.cables.len()], 0.5e-3, &mut draws);
            let of = of_rows(&truth, rows.clone(), 0.02, &mut draws);
            let frame = of.frame(&FrameChoice::Anchors(Vec::new())).unwrap();
            let found = search(&of, &frame, 10, &mut |_, _| true).unwrap();
            let images: Vec<_> = found.others.iter().filter(|other| !other.mirrored.is_empty()).collect();
            let says = format!("seed {seed}, {} cables: {} images", truth.cables.len(), images.len());
            assert!(!images.is_empty(), "{says}");

            // The named row leaves one minimum, that of the truth.
            let telling = of.telling_row(&found.best, &images[0].fit).expect(&says);
            assert!(telling.difference > 0.01, "{says}: {telling:?}");
            let further =
                [telling.pose, Pose { position_w: telling.pose.position_w + Vec3::new(0.3, 0.1, 0.0), ..telling.pose }];
            rows.extend(readings(&truth, &further, &vec![0.0; truth.cables.len()], 0.5e-3, &mut draws));
            let of = of_rows(&truth, rows, 0.02, &mut draws);
            let found = search(&of, &frame, 10, &mut |_, _| true).unwrap();
            assert!(found.others.iter().all(|other| other.mirrored.is_empty()), "{says}");
            let precision = of.precision(&found.best, &of.frame_about(&frame, &found.best));
            for pair in of.anchor_distances(&found.best, &precision) {
                let [a, b] = pair.cables.map(|cable| truth.cables[cable].anchor.point_w);
                assert!((pair.distance - (a - b).norm()).abs() < 5.0 * pair.deviation, "{says}: {pair:?}");
            }
        }
    }
}

#[test]
fn rows_that_fill_the_room_have_no_mirror_images() {
    let mut draws = Draws(77);
    for (truth, poses) in robots(&mut draws) {
        let rows = readings(&truth, &poses, &vec![0.0; truth.cables.len()], 0.5e-3, &mut draws);
        let of = of_rows(&truth, rows, 0.02, &mut draws);
        let frame = of.frame(&FrameChoice::Anchors(Vec::new())).unwrap();
        let found = search(&of, &frame, 10, &mut |_, _| true).unwrap();
        assert!(found.others.iter().all(|other| other.mirrored.is_empty()), "{} cables", truth.cables.len());
    }
}

/// A factor of stiffness has no length: neither the weakest combination nor the proposals serve it alone.
#[test]
fn a_factor_counts_among_lengths_as_one_of_them() {
    let of = sagging(true).unwrap();
    let (fit, frame, precision) = fitted(&of);
    let factor = of.position_of(&CalibrationUnknown::AxialStiffness).unwrap();
    assert!(!of.is_length(factor) && (0..factor).all(|k| of.is_length(k)));

    // All lengths together, and no combination of them is known worse.
    let own = precision.deviations();
    let total = own[..factor].iter().map(|deviation| deviation * deviation).sum::<f64>().sqrt();
    assert!((of.total_of_lengths(&precision.covariance) / total - 1.0).abs() < 1e-12);
    let weakest = of.weakest_of_lengths(&precision.covariance);
    assert!(weakest < total && weakest > 0.2 * total);
    let weak = of.weak_combinations(&fit, &frame, &precision, 3);
    let is_factor = |part: &CombinationPart| matches!(part, CombinationPart::Factor { .. });
    let of_inner = of.total_of_lengths(&frame.inner(&precision.covariance));
    for combination in &weak {
        assert!(combination.deviation <= of_inner, "{combination:?}");
        // Relative changes: within ten deviations of the factor.
        for (part, amount) in combination.parts.iter().filter(|(part, _)| is_factor(part)) {
            let [value, rate] = of.meaning(factor, fit.values[factor]);
            assert!(amount.abs() < 10.0 * own[factor] * rate / value, "{part:?} {amount}");
        }
    }
    assert!(!weak[0].parts.iter().all(|(part, _)| is_factor(part)), "{:?}", weak[0].parts);
}

/// Tensions of elastic cables and the deviation with which they are measured [N].
#[derive(Clone, Copy)]
struct MeasuredTensions {
    mean: f64,
    deviation: f64,
}

const TAUT: MeasuredTensions = MeasuredTensions { mean: 150.0, deviation: 2.0 };

/// Point on six elastic cables at rest at poses, whose lengths and tensions are read with noise, 0.5 mm of a length.
fn elastic(poses: &[Pose], tensions: MeasuredTensions, draws: &mut Draws) -> (Robot, Vec<MeasuredRow>) {
    let mut truth = camera();
    truth.gravity_w = Vec3::new(0.0, 0.0, -9.81);
    truth.platform.mass = tensions.mean / 40.0;
    for cable in &mut truth.cables {
        cable.material.axial_stiffness = 2e5;
        cable.material.mass_per_length = 1e-3;
    }
    let mut rows = Vec::new();
    for pose in poses {
        let rule = TensionRule::Closest(vec![tensions.mean * (1.0 + draws.within(0.5))]);
        let at_pose = statics::solve_at(&truth, &State::Pose(*pose), StaticModel::Catenary, &rule);
        let Ok(rest) = at_pose.map(|found| found.equilibrium) else { continue };
        let lengths = rest.cables.iter().map(|cable| cable.unstrained_length);
        let readings: Vec<f64> = lengths.map(|length| length + 0.5e-3 * draws.normal()).collect();
        let measured =
            rest.cables.iter().map(|cable| Some(cable.tension_anchor + tensions.deviation * draws.normal())).collect();
        rows.push(MeasuredRow { tensions: measured, start: Some(*pose), ..MeasuredRow::of_readings(&readings) });
    }
    (truth, rows)
}

fn of_elastic_rows(
    truth: &Robot,
    rows: Vec<MeasuredRow>,
    tensions: MeasuredTensions,
    draws: &mut Draws,
) -> Calibration {
    let all = unknowns(truth.cables.len(), &[0, 1, 2], false);
    let deviations = ReadingDeviations { tension: tensions.deviation, ..deviations(0.5e-3) };
    Calibration::new(with_errors(truth, 0.02, draws), all, rows, deviations, StaticModel::Catenary).unwrap()
}

#[test]
fn a_row_of_elastic_cables_with_two_exchanged_readings_is_named() {
    let mut draws = Draws(5);
    let poses = camera_poses(16, &mut draws);
    let (truth, mut rows) = elastic(&poses, TAUT, &mut draws);
    assert!(rows.len() > 10, "{}", rows.len());
    let wrong = 4;
    let cables = pair_of(&rows[wrong], &mut draws);
    rows[wrong].readings.swap(cables[0], cables[1]);
    let of = of_elastic_rows(&truth, rows, TAUT, &mut draws);
    let found = found_wrong(&of);
    assert_eq!(found.iter().map(|row| row.row).collect::<Vec<_>>(), [wrong], "{found:?}");
    assert_eq!(found[0].exchange.map(|of| of.cables), Some(cables), "{found:?}");
}

/// Points in a plane leave straight cables mirror images. Elastic cables in balance would have to pull towards the
/// other side: their images are fitted, and do not fit.
#[test]
fn mirror_images_of_straight_cables_do_not_fit_cables_in_balance() {
    let mut draws = Draws(8);
    let mut flat = camera_poses(20, &mut draws);
    for pose in &mut flat {
        pose.position_w.z = 2.0;
    }
    let (truth, rows) = elastic(&flat, TAUT, &mut draws);
    assert!(rows.len() > 12, "{}", rows.len());
    let of = of_elastic_rows(&truth, rows, TAUT, &mut draws);
    let frame = of.frame(&FrameChoice::Anchors(Vec::new())).unwrap();
    let found = search(&of, &frame, 1, &mut |_, _| true).unwrap();
    assert!(found.best.converged && found.others.is_empty(), "{}", found.others.len());
}
