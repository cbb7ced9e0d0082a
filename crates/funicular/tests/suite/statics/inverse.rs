//! Pose to unstrained lengths with as many cables as degrees of freedom, slack ones included.

use super::{YUAN_4MM, load};
use crate::random::Draw;
use funicular::math::Vec3;
use funicular::robot::{Pose, Robot};
use funicular::statics::{self, Stability, StaticModel, StaticsError};
use std::fmt::Write;

#[test]
fn pose_to_lengths_and_back_is_the_identity() {
    let (robot, _) = load(YUAN_4MM);
    let mut held = 0;
    for i in 0..400 {
        let t = f64::from(i);
        let pose = Pose::new(
            [2.0 * (0.7 * t).sin(), 0.8 * (1.1 * t).cos(), 1.0 + 0.8 * (0.3 * t).sin()],
            [4.0 * (0.9 * t).sin(), 4.0 * (0.5 * t).cos(), 3.0 * (1.3 * t).sin()],
        );
        for model in [StaticModel::Spring, StaticModel::Catenary] {
            match statics::inverse(&robot, &pose, model) {
                Ok(rest) => {
                    held += 1;
                    assert!(rest.residual <= statics::RESIDUAL_LIMIT);
                    // Also if slack cables hold the pose with kilometres of rope; with steps in the tension alone it
                    // takes a hundred iterations.
                    assert!(rest.iterations <= 15, "{i}: {} iterations", rest.iterations);
                    let lengths: Vec<f64> = rest.cables.iter().map(|c| c.unstrained_length).collect();
                    let back = statics::forward(&robot, &lengths, model, Some(&pose)).unwrap();
                    if matches!(rest.stability, Stability::Stable { .. }) {
                        let gap = (back.pose.position_w - pose.position_w).norm();
                        assert!(gap < 1e-8, "{i} {model:?}: {gap:e}");
                    }
                }
                Err(StaticsError::NegativeTension { tension, .. }) => {
                    assert!(tension <= 0.0 && model == StaticModel::Spring, "of sagging cables that is no proof");
                }
                Err(StaticsError::NotFound { tension, starts, residual, .. }) => {
                    assert!(tension <= 0.0 && model == StaticModel::Catenary);
                    assert!(starts != 1 && residual > 0.0, "{starts} {residual}");
                }
                Err(other) => panic!("{i} {model:?}: {other}"),
            }
        }
    }
    assert!(held > 50, "{held} of 800 poses are held");
}

#[test]
fn poses_that_only_one_way_of_steps_finds_are_held() {
    let (mut robot, _) = load(YUAN_4MM);
    robot.platform.mass = 20.0;
    // Steps in tension alone find the first; only steps in the length of slack cables find the second.
    for position in [[2.5, -1.4, 0.5], [3.0, 1.0, 0.5]] {
        let rest = statics::inverse(&robot, &Pose::new(position, [0.0; 3]), StaticModel::Catenary).unwrap();
        assert!(rest.residual <= statics::RESIDUAL_LIMIT && matches!(rest.stability, Stability::Stable { .. }));
        assert!(rest.cables.iter().all(|cable| cable.tension_platform > 0.0));
    }
}

/// Random robot number `index` on six cables from above, a few of them also from below, up to a quarter longer than
/// their chords: an invented robot. Ropes weigh from 1/3000 of the platform to three times as much.
fn slack_robot(index: u64) -> (Robot, Vec<f64>) {
    let mut draw = Draw(index.wrapping_mul(7919) + 1);
    let size = draw.decades(0.0, 1.5);
    let mass = draw.decades(-1.0, 2.0);
    let ropes = draw.decades(-3.5, 0.5);
    let stiffness = draw.decades(2.0, 5.0);
    let radius = size * draw.between(0.05, 0.3);
    let com = draw.vector(0.3 * radius);
    let mut text = format!(
        "name = \"slack {index}\"\n[platform]\nmass_kg = {mass:?}\ninertia_kg_m2 = [1.0, 1.0, 1.0]\n\
         center_of_mass_m = {com:?}\n"
    );
    for k in 0..2 {
        let per_length = mass * ropes * draw.between(0.5, 1.5) / (6.0 * size);
        let axial = mass * 9.81 * stiffness * draw.between(0.5, 2.0);
        write!(text, "[materials.m{k}]\naxial_stiffness_n = {axial:?}\nmass_kg_per_m = {per_length:?}\n").unwrap();
    }
    let below = draw.between(0.0, 1.0) < 0.15;
    let slackest = draw.between(0.01, 0.25);
    for i in 0..6 {
        let around = std::f64::consts::TAU * (f64::from(i) + draw.between(0.0, 1.0)) / 6.0;
        let out = size * draw.between(0.6, 1.3);
        let up = if below && i % 3 == 2 { -0.5 } else { 1.0 } * size * draw.between(0.4, 1.2);
        let anchor = [out * around.cos(), out * around.sin(), up];
        let turn = around + draw.between(-2.5, 2.5);
        let arm = radius * draw.between(0.3, 1.0);
        let attachment = [arm * turn.cos(), arm * turn.sin(), radius * draw.between(-0.5, 0.5)];
        let chord = (Vec3::from(anchor) - Vec3::from(attachment)).norm();
        let length = chord * (1.0 + draw.between(-0.02, slackest));
        let material = u8::from(draw.between(0.0, 1.0) >= 0.5);
        write!(
            text,
            "[[cables]]\nname = \"c{i}\"\nmaterial = \"m{material}\"\nanchor_m = {anchor:?}\n\
             attachment_m = {attachment:?}\nunstrained_length_m = {length:?}\n"
        )
        .unwrap();
    }
    if draw.between(0.0, 1.0) < 0.4 {
        let weight = mass * 9.81;
        let (force, point) = (draw.vector(0.3 * weight), draw.vector(radius));
        let moment = draw.vector(0.1 * weight * radius);
        write!(text, "[loads]\nforce_n = {force:?}\npoint_m = {point:?}\nmoment_n_m = {moment:?}\n").unwrap();
    }
    load(&text)
}

/// A robot in equilibrium must be held at its pose: by its own lengths, or by others.
#[test]
fn where_a_robot_rests_with_slack_cables_inverse_statics_finds_tensions() {
    let (mut rests, mut same) = (0, 0);
    // The first robots, and those for which no iteration from straight cables converges.
    for index in (0..1200).chain(HARD) {
        let (robot, lengths) = slack_robot(index);
        let Ok(rest) = statics::forward(&robot, &lengths, StaticModel::Catenary, None) else { continue };
        if !matches!(rest.stability, Stability::Stable { .. }) {
            continue;
        }
        rests += 1;
        let held = statics::inverse(&robot, &rest.pose, StaticModel::Catenary);
        let held = held.unwrap_or_else(|error| panic!("robot {index}: {error}"));

        // Balance, computed from the lengths alone.
        let found: Vec<f64> = held.cables.iter().map(|cable| cable.unstrained_length).collect();
        let left = statics::wrench(&robot, &rest.pose, &found, StaticModel::Catenary).unwrap();
        let ell = robot.platform_length();
        let left = left.fixed_rows::<3>(0).norm().max(left.fixed_rows::<3>(3).norm() / ell);
        let forces: f64 = held.cables.iter().map(|cable| cable.tension_platform).sum();
        // Rounding of a length in the stiffest rope, besides the limit of residuals.
        let stiffness = robot.cables.iter().fold(0.0, |most: f64, cable| most.max(cable.material.axial_stiffness));
        assert!(left <= 1e-9 * forces + 1e-14 * stiffness, "robot {index}: {left:e} of {forces}");
        same += usize::from(found.iter().zip(&lengths).all(|(a, b)| (a - b).abs() < 1e-5 * b));
    }
    // Nine in ten get their original lengths; the balance of slack cables has several solutions.
    assert!(rests > 1190 && 10 * same > 8 * rests, "{rests} {same}");
}

/// Robots of the sequence in equilibria for which iterations from straight cables find no tensions.
const HARD: [u64; 16] =
    [1641, 2170, 2174, 2918, 3664, 4541, 5288, 5453, 6398, 6423, 6464, 6839, 7163, 7188, 7646, 7802];

#[test]
fn what_is_not_found_for_sagging_cables_is_not_said_to_be_impossible() {
    let (robot, _) = load(YUAN_4MM);
    let far = Pose::new([40.0, 0.0, 1.0], [0.0; 3]);
    let error = statics::inverse(&robot, &far, StaticModel::Catenary).unwrap_err();
    let text = error.to_string();
    assert!(text.starts_with("no tensions found that hold this pose: straight, cable \""), "{text}");
    assert!(text.contains(" would need -") && text.contains("more than 2 times as long as its chord"), "{text}");
    assert!(error.is_no_solution() && error.code() == "negative-tension");

    // Near poses that slack ropes hold, the weight of the ropes might suffice, so they are searched.
    let beside = (0..100).flat_map(|index| (1..20).map(move |step| (index, step)));
    let searched = beside.filter_map(|(index, step)| {
        let (robot, lengths) = slack_robot(index);
        let mut pose = statics::forward(&robot, &lengths, StaticModel::Catenary, None).ok()?.pose;
        pose.position_w.z += 0.01 * f64::from(step) * robot.platform_length();
        let error = statics::inverse(&robot, &pose, StaticModel::Catenary).err()?;
        matches!(error, StaticsError::NotFound { starts, .. } if starts > 1).then(|| error.to_string())
    });
    let searched: Vec<String> = searched.collect();
    assert!(!searched.is_empty());
    for text in searched {
        assert!(text.contains("sagging, a search from "), "{text}");
        assert!(text.contains("left a scaled residual of") || text.contains("excessive tensions"), "{text}");
    }

    // Without weight, straight cables decide.
    let mut massless = robot;
    massless.cables.iter_mut().for_each(|cable| cable.material.mass_per_length = 0.0);
    let error = statics::inverse(&massless, &far, StaticModel::Catenary).unwrap_err();
    assert!(matches!(error, StaticsError::NegativeTension { tension, .. } if tension < 0.0), "{error}");
}
