//! Priors, pulley radii, winches and flexible supports in calibrations whose truth is known.

use super::*;
use funicular::math::DMat;
use funicular::robot::{Pulley, State, Support};

/// Rigid platform with eight cables over swivelling pulleys, each with its drum below.
fn with_pulleys(radius: f64) -> Robot {
    let mut robot = robot("rigid", &RIGID_START, &RIGID_ATTACHMENTS);
    for (i, cable) in robot.cables.iter_mut().enumerate() {
        let up = if cable.anchor.point_w.z > 1.0 { 1.0 } else { -1.0 };
        let name = if i < 4 { "low" } else { "high" };
        cable.anchor.pulley = Some(Pulley::new(name, radius, Vec3::new(0.0, 0.0, up)));
    }
    robot
}

/// Poses in the room of the rigid platform, turned by up to `turn` degrees.
pub(super) fn rigid_poses(count: usize, turn: f64, draws: &mut Draws) -> Vec<Pose> {
    let pose = |_| {
        let place = [3.0 + draws.within(1.2), 2.5 + draws.within(1.0), 1.6 + draws.within(0.7)];
        Pose::new(place, [draws.within(turn), draws.within(turn), draws.within(turn)])
    };
    (0..count).map(pose).collect()
}

#[test]
fn radii_of_pulleys_are_found_from_exact_lengths() {
    let mut draws = Draws(5);
    let mut truth = with_pulleys(0.08);
    for cable in &mut truth.cables[4..] {
        cable.anchor.pulley.as_mut().unwrap().radius = 0.05;
    }
    let poses = rigid_poses(40, 15.0, &mut draws);
    let mut rows = readings(&truth, &poses, &[0.0; 8], 0.0, &mut draws);
    for (row, pose) in rows.iter_mut().zip(&poses) {
        row.start = Some(*pose);
    }
    let mut all = unknowns(8, &[0, 1, 2], false);
    all.extend([CalibrationUnknown::PulleyRadius { cable: 0 }, CalibrationUnknown::PulleyRadius { cable: 4 }]);
    let mut start = with_errors(&truth, 0.02, &mut draws);
    for cable in &mut start.cables {
        cable.anchor.pulley.as_mut().unwrap().radius = 0.065;
    }
    let of = Calibration::new(start, all, rows, deviations(1e-3), StaticModel::Ideal).unwrap();
    let (fit, frame, precision) = fitted(&of);
    // Axes of the pulleys stand in the world: the frame keeps its shifts and its turn about them. A derivative that is
    // 1 % off would not arrive at the truth of exact readings quadratically.
    assert_eq!(frame.motion_count(), 4);
    assert!(fit.converged && fit.chi2 < 1e-9, "{}", fit.chi2);
    let radii = &fit.values[24..];
    assert!((radii[0] - 0.08).abs() < 1e-5 && (radii[1] - 0.05).abs() < 1e-5, "{radii:?}");
    assert!(precision.lost.is_empty());
}

#[test]
fn derivatives_by_radii_are_those_of_differences() {
    let robot = with_pulleys(0.07);
    let pose = Pose::new([3.4, 2.1, 1.3], [8.0, -5.0, 20.0]);
    let length = |radius: f64, cable: usize| with_pulleys(radius).cables[cable].straight_length(&pose);
    for cable in 0..8 {
        let by_difference = (length(0.07 + 1e-5, cable) - length(0.07 - 1e-5, cable)) / 2e-5;
        let anchor = &robot.cables[cable].anchor;
        let attachment = pose.point_w(&robot.cables[cable].attachment_p);
        let contact = anchor.contact(&attachment).unwrap();
        let chord = robot.cables[cable].chord_w(&pose).normalize();
        let exact = contact.wrap + chord.dot(&contact.exit_offset_w()) / contact.radius;
        // Curvature of the length over 1e-5 m.
        assert!((by_difference - exact).abs() < 1e-7, "{cable}: {by_difference} {exact}");
    }
}

/// Intervals of calibrations with priors whose values are drawn as well: truth within ±1.96 deviations.
#[test]
fn priors_move_values_as_their_covariance_says() {
    // Nearly linear: the identity of a further datum, θ' = θ − S e (θ_k − θ₀)/(σ₀² + S_kk).
    let mut draws = Draws(23);
    let truth = planar(&[[0.0, 0.0], [4.0, 0.0], [3.9, 3.0], [-0.1, 2.9]]);
    let poses: Vec<Pose> =
        (0..9).map(|_| Pose::new([2.0 + draws.within(1.2), 1.5 + draws.within(1.0), 0.0], [0.0; 3])).collect();
    let rows = readings(&truth, &poses, &[0.0; 4], 1e-5, &mut draws);
    let held: Vec<CalibrationUnknown> = unknowns(4, &[0, 1], true)
        .into_iter()
        .filter(|of| of.cable() != Some(0) || matches!(of, CalibrationUnknown::Offset { .. }))
        .collect();
    let held: Vec<CalibrationUnknown> =
        held.into_iter().filter(|of| *of != CalibrationUnknown::Anchor { cable: 1, axis: 1 }).collect();
    let of = Calibration::new(truth, held, rows, deviations(1e-5), StaticModel::Ideal).unwrap();
    let (fit, _, precision) = fitted(&of);
    let offset = of.position_of(&CalibrationUnknown::Offset { cable: 2 }).unwrap();
    let variance = precision.covariance[(offset, offset)];
    let (known, deviation) = (fit.values[offset] + 2.0 * variance.sqrt(), 0.7 * variance.sqrt());

    let with = of.with_priors(&[(offset, known, deviation)]);
    let (with_fit, _, with_precision) = fitted(&with);
    let column = precision.covariance.column(offset).into_owned();
    let sum = variance + deviation * deviation;
    let expected: Vec<f64> = (fit.values.iter().zip(column.iter()))
        .map(|(value, seen)| value - seen * (fit.values[offset] - known) / sum)
        .collect();
    let covariance: DMat = &precision.covariance - &column * column.transpose() / sum;
    for k in 0..fit.values.len() {
        let own = covariance[(k, k)].sqrt();
        assert!((with_fit.values[k] - expected[k]).abs() < 0.01 * own, "{k}");
        assert!((with_precision.covariance[(k, k)].sqrt() / own - 1.0).abs() < 0.01, "{k}");
    }
    // The prior counts as a datum, and χ² rises by its distance.
    assert_eq!(with_precision.degrees, precision.degrees + 1);
    let rise = (fit.values[offset] - known).powi(2) / sum;
    assert!((with_fit.chi2 - fit.chi2 - rise).abs() < 0.01 * rise);
}

/// Six elastic cables without weight around a point, whose lengths are those of equilibria between 100 and 200 N.
fn tightened(axial_stiffness: f64, draws: &mut Draws) -> (Robot, Vec<MeasuredRow>) {
    let mut truth = camera();
    truth.gravity_w = Vec3::new(0.0, 0.0, -9.81);
    truth.platform.mass = 2.0;
    for cable in &mut truth.cables {
        cable.material.axial_stiffness = axial_stiffness;
        cable.material.mass_per_length = 0.0;
    }
    let mut rows = Vec::new();
    while rows.len() < 16 {
        let pose = camera_poses(1, draws)[0];
        let stretch = 150.0 / axial_stiffness;
        let lengths: Vec<f64> = truth
            .cables
            .iter()
            .map(|cable| cable.straight_length(&pose) * (1.0 - stretch * (1.0 + draws.within(0.3))))
            .collect();
        let Ok(rest) = statics::forward(&truth, &lengths, StaticModel::Catenary, Some(&pose)) else { continue };
        if rest.cables.iter().any(|cable| !(5.0..=400.0).contains(&cable.tension_anchor)) {
            continue;
        }
        let readings: Vec<f64> = lengths.iter().map(|length| length + 1e-3 * draws.normal()).collect();
        rows.push(MeasuredRow { start: Some(rest.pose), ..MeasuredRow::of_readings(&readings) });
    }
    (truth, rows)
}

#[test]
fn a_prior_of_tensions_makes_data_of_the_lengths_of_elastic_cables() {
    let total = |axial_stiffness: f64| {
        let (truth, rows) = tightened(axial_stiffness, &mut Draws(31));
        let all = unknowns(6, &[0, 1, 2], false);
        let with = |model: StaticModel, tension_prior: Option<(f64, f64)>| {
            let deviations = ReadingDeviations { tension_prior, ..deviations(1e-3) };
            Calibration::new(truth.clone(), all.clone(), rows.clone(), deviations, model)
        };
        assert_eq!(with(StaticModel::Catenary, None).unwrap_err(), CalibrationError::ElasticLengthsAlone);
        let of = with(StaticModel::Catenary, Some((150.0, 100.0))).unwrap();
        let (fit, frame, precision) = fitted(&of);
        let distances = of.anchor_distances(&fit, &precision);
        for pair in &distances {
            let [a, b] = pair.cables.map(|cable| truth.cables[cable].anchor.point_w);
            assert!((pair.distance - (a - b).norm()).abs() < 4.5 * pair.deviation, "{axial_stiffness} {pair:?}");
        }
        assert_eq!(frame.motion_count(), 4);
        distances.iter().map(|pair| pair.deviation * pair.deviation).sum::<f64>().sqrt()
    };
    // 100 N stretch 5 m by 0.28 mm, 2.8 mm and 28 mm, beside 1 mm of the readings.
    let [stiff, middle, soft] = [1.8e6, 180e3, 18e3].map(total);
    assert!(stiff < 1.3 * middle && middle > 1.5 * stiff && soft > 4.0 * middle, "{stiff} {middle} {soft}");
}

/// Point mass on four masts that give way.
fn on_masts() -> Robot {
    let mut robot = robot("point-mass", &SAG_START, &[[0.0; 3]; 4]);
    robot.gravity_w = Vec3::new(0.0, 0.0, -9.81);
    robot.platform.mass = 20.0;
    for (i, cable) in robot.cables.iter_mut().enumerate() {
        cable.material.axial_stiffness = 130e3;
        cable.material.mass_per_length = 0.12;
        cable.anchor.support = Some(i);
    }
    robot.supports = (0..4)
        .map(|i| Support {
            name: format!("mast-{i}"),
            stiffness_w: funicular::math::Mat3::identity() * 2e4,
            mass: 0.0,
            damping_ratio: 0.0,
            drum: funicular::robot::DrumPlace::OnSupport,
        })
        .collect();
    robot.state = State::Unknown;
    robot
}

#[test]
fn the_stiffness_of_supports_is_found_with_tensions_and_positions() {
    let mut draws = Draws(61);
    let truth = on_masts();
    let mut rows = Vec::new();
    while rows.len() < 20 {
        let place = [4.0 + draws.within(2.0), 3.0 + draws.within(1.5), -2.5 + draws.within(1.0)];
        let pose = Pose::new(place, [0.0; 3]);
        let lengths: Vec<f64> =
            truth.cables.iter().map(|cable| cable.straight_length(&pose) * (0.999 + draws.within(0.003))).collect();
        let Ok(rest) = statics::forward(&truth, &lengths, StaticModel::Catenary, Some(&pose)) else { continue };
        let readings: Vec<f64> = lengths.iter().map(|length| length + 5e-4 * draws.normal()).collect();
        rows.push(MeasuredRow {
            position: [0, 1, 2].map(|axis| Some(rest.pose.position_w[axis] + 5e-4 * draws.normal())),
            tensions: rest.cables.iter().map(|cable| Some(cable.tension_anchor + draws.normal())).collect(),
            start: Some(rest.pose),
            ..MeasuredRow::of_readings(&readings)
        });
    }
    let mut all = unknowns(4, &[0, 1, 2], false);
    all.push(CalibrationUnknown::SupportStiffness);
    let mut start = truth.clone();
    for support in &mut start.supports {
        support.stiffness_w *= 1.5;
    }
    let deviations = ReadingDeviations { reading: 5e-4, position: 5e-4, angle: 1.0, tension: 1.0, tension_prior: None };
    let of = Calibration::new(start, all, rows, deviations, StaticModel::Catenary).unwrap();
    let (fit, _, precision) = fitted(&of);
    let [factor, rate] = of.meaning(12, fit.values[12]);
    let deviation = rate * precision.deviations()[12];
    // The file has 1.5 times the true stiffness.
    assert!((factor - 1.0 / 1.5).abs() < 4.0 * deviation && deviation < 0.05, "{factor} ± {deviation}");
    // 220 data less 80 lengths and 13 unknowns: 127 ± 16, four deviations.
    assert!((fit.chi2 - 127.0).abs() < 64.0 && precision.degrees == 127, "{} {}", fit.chi2, precision.degrees);
}

#[test]
fn a_proposed_pose_of_elastic_cables_leaves_what_a_row_there_leaves() {
    let of = sagging(true).unwrap();
    let (fit, frame, precision) = fitted(&of);
    let robot = of.robot_at(&fit.values);
    let pose = Pose::new([2.0, 4.5, -2.0], [0.0; 3]);
    let lengths: Vec<f64> = robot
        .robot
        .cables
        .iter()
        .zip([0.999, 1.001, 1.0, 1.0])
        .map(|(cable, factor)| cable.straight_length(&pose) * factor)
        .collect();
    let rest = statics::forward(&robot.robot, &lengths, StaticModel::Catenary, Some(&pose)).unwrap();
    let candidate = CandidatePose { pose: rest.pose, lengths };
    let weights = vec![1.0; fit.values.len()];
    let proposed = proposals(
        &of,
        &fit,
        (&frame, &precision),
        &[candidate],
        (1, RowCriterion::Variances),
        ProposalAim::Unknowns(&weights),
    )
    .remove(0);

    // The same readings and tensions as a row: the minimum stays, and its covariance is that of the proposal.
    let mut with = of.clone();
    with.rows.push(MeasuredRow {
        tensions: rest.cables.iter().map(|cable| Some(cable.tension_anchor)).collect(),
        start: Some(rest.pose),
        ..MeasuredRow::of_readings(&proposed.readings)
    });
    let (with_fit, _, with_precision) = fitted(&with);
    assert!((with_fit.chi2 - fit.chi2).abs() < 1e-6, "{} {}", with_fit.chi2, fit.chi2);
    let after = with.total_of_lengths(&with_precision.covariance);
    assert!((proposed.total / after - 1.0).abs() < 1e-6, "{} {after}", proposed.total);
    assert!(proposed.total < 0.999 * of.total_of_lengths(&precision.covariance));
}
