//! Equilibria: others' numbers, identities, hard cases, random robots.

use crate::random::{Draw, any_robot};
use funicular::math::{Mat6, Vec3, Vec6};
use funicular::robot::{Pose, Robot, State};
use funicular::statics::{self, Stability, StaticModel, StaticsError};
use proptest::prelude::*;
use std::fmt::Write;

use crate::reference::{number, numbers, rows};

const YUAN_4MM: &str = funicular_robots::YUAN2014_4MM;
const YUAN_8MM: &str = funicular_robots::YUAN2014_8MM;
const COGIRO: &str = funicular_robots::COGIRO;

/// The file of the paper's robot that a row names.
fn paper_robot(row: &serde_json::Value) -> &'static str {
    match row["robot"].as_str() {
        Some("yuan2014-4mm") => YUAN_4MM,
        Some("yuan2014-8mm") => YUAN_8MM,
        other => panic!("{other:?} is no robot of the paper"),
    }
}

fn load(text: &str) -> (Robot, Vec<f64>) {
    let robot = Robot::from_toml(text).unwrap();
    let State::Lengths(lengths) = robot.state.clone() else { panic!("given by lengths") };
    (robot, lengths)
}

#[test]
fn the_papers_robot_rests_where_moorpy_finds_it() {
    assert_eq!(rows("paper_robot_equilibria").len(), 4);
    for row in rows("paper_robot_equilibria") {
        let (mass, position) = (number(row, "mass_kg"), numbers(row, "position_m"));
        let tensions: [f64; 6] = numbers(row, "tension_platform_n");
        let (robot, lengths) = load(paper_robot(row));
        let rest = statics::forward(&robot.with_mass(mass), &lengths, StaticModel::Catenary, None).unwrap();
        // Five decimals and 0.01 N are what the table prints.
        assert!((rest.pose.position_w - Vec3::from(position)).amax() < 6e-6);
        for (cable, theirs) in rest.cables.iter().zip(tensions) {
            // MoorPy's tolerance leaves 3e-6 of the tension; two decimals or one are printed.
            assert!((cable.tension_platform - theirs).abs() < 8e-3, "{} for {theirs}", cable.tension_platform);
        }
    }
}

#[test]
fn ideal_poses_close_the_lengths_of_tables_i_and_ii() {
    assert_eq!(rows("paper_robot_ideal_poses").len(), 2);
    for row in rows("paper_robot_ideal_poses") {
        let position = numbers(row, "position_m");
        let (robot, lengths) = load(paper_robot(row));
        let rest = statics::forward(&robot, &lengths, StaticModel::Ideal, None).unwrap();
        assert!((rest.pose.position_w - Vec3::from(position)).amax() < 6e-5);
        for (cable, length) in rest.cables.iter().zip(&lengths) {
            assert!((cable.chord() - length).abs() < 1e-12);
        }
        assert!(rest.residual < 1e-13 && rest.stability == Stability::Rigid);
    }
}

#[test]
fn every_mass_of_the_paper_has_a_stable_equilibrium_without_a_start() {
    for text in [YUAN_4MM, YUAN_8MM] {
        let (robot, lengths) = load(text);
        for step in 0..=400 {
            let mass = 10.55 + (86.35 - 10.55) * f64::from(step) / 400.0;
            for model in [StaticModel::Spring, StaticModel::Catenary] {
                let rest = statics::forward(&robot.with_mass(mass), &lengths, model, None).unwrap();
                assert!(rest.residual <= 1e-10, "{mass} kg, {model:?}");
                assert!(matches!(rest.stability, Stability::Stable { .. }), "{mass} kg, {model:?}");
            }
        }
    }
}

#[test]
fn cogiro_stands_with_all_eight_cables_taut() {
    let (robot, lengths) = load(COGIRO);
    for model in [StaticModel::Spring, StaticModel::Catenary] {
        let rest = statics::forward(&robot, &lengths, model, None).unwrap();
        assert!(rest.cables.iter().all(|c| c.tension_platform > 295.0 && c.tension_platform < 345.0));
        assert!((rest.pose.position_w - Vec3::new(0.0, 0.0, 1.5)).norm() < 2e-3, "{}", rest.pose.position_w);
        assert!(matches!(rest.stability, Stability::Stable { .. }));
    }
}

#[test]
fn stiffness_is_symmetric_and_the_differenced_wrench() {
    for text in [YUAN_4MM, YUAN_8MM, COGIRO] {
        let (robot, lengths) = load(text);
        for model in [StaticModel::Spring, StaticModel::Catenary] {
            let rest = statics::forward(&robot, &lengths, model, None).unwrap();
            let k = statics::tangent_stiffness(&robot, &rest).unwrap();
            assert!((k - k.transpose()).amax() < 1e-12 * k.amax());
            // Central differences, extrapolated (Richardson): error of fourth order in the step.
            let along = |i: usize, step: f64| {
                let mut small = [0.0; 6];
                small[i] = step;
                let (translation, turn) =
                    (Vec3::new(small[0], small[1], small[2]), Vec3::new(small[3], small[4], small[5]));
                statics::wrench(&robot, &rest.pose.moved(&translation, &turn), &lengths, model).unwrap()
            };
            let mut differenced = Mat6::zeros();
            for i in 0..6 {
                let h = 2e-6;
                let column: Vec6 =
                    ((along(i, h) - along(i, -h)) * 8.0 - (along(i, 2.0 * h) - along(i, -2.0 * h))) / (-12.0 * h);
                differenced.set_column(i, &column);
            }
            let gap = (k - differenced).amax() / k.amax();
            assert!(gap < 1e-6, "{} {model:?}: {gap:e}", robot.name);
        }
    }
}

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
                    // Also where slack cables hold the pose by kilometres of rope; a hundred with steps in the tension alone.
                    assert!(rest.iterations <= 15, "{i}: {} iterations", rest.iterations);
                    let lengths: Vec<f64> = rest.cables.iter().map(|c| c.unstrained_length).collect();
                    let back = statics::forward(&robot, &lengths, model, Some(&pose)).unwrap();
                    if matches!(rest.stability, Stability::Stable { .. }) {
                        let gap = (back.pose.position_w - pose.position_w).norm();
                        assert!(gap < 1e-8, "{i} {model:?}: {gap:e}");
                    }
                }
                Err(StaticsError::WouldPush { tension, .. }) => {
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
    // By steps in tension alone the first; the second only with steps in the length of slack cables.
    for position in [[2.5, -1.4, 0.5], [3.0, 1.0, 0.5]] {
        let rest = statics::inverse(&robot, &Pose::new(position, [0.0; 3]), StaticModel::Catenary).unwrap();
        assert!(rest.residual <= statics::RESIDUAL_LIMIT && matches!(rest.stability, Stability::Stable { .. }));
        assert!(rest.cables.iter().all(|cable| cable.tension_platform > 0.0));
    }
}

/// The `index`-th random robot on six cables from above, a few of them also from below, that are up to a quarter longer than
/// their chords: a robot of ours, made up. Ropes from 1/3000 of the platform's weight to three times that.
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

/// A cable robot that rests must be held at the pose in which it rests: by the lengths it has, or by others.
#[test]
fn where_a_robot_rests_with_slack_cables_inverse_statics_finds_tensions() {
    let (mut rests, mut same) = (0, 0);
    // The first ones, and those that no iteration from straight cables finds.
    for index in (0..1200).chain(HARD) {
        let (robot, lengths) = slack_robot(index);
        let Ok(rest) = statics::forward(&robot, &lengths, StaticModel::Catenary, None) else { continue };
        if !matches!(rest.stability, Stability::Stable { .. }) {
            continue;
        }
        rests += 1;
        let held = statics::inverse(&robot, &rest.pose, StaticModel::Catenary);
        let held = held.unwrap_or_else(|error| panic!("robot {index}: {error}"));

        // The balance, by the lengths alone.
        let found: Vec<f64> = held.cables.iter().map(|cable| cable.unstrained_length).collect();
        let left = statics::wrench(&robot, &rest.pose, &found, StaticModel::Catenary).unwrap();
        let ell = robot.platform_length();
        let left = left.fixed_rows::<3>(0).norm().max(left.fixed_rows::<3>(3).norm() / ell);
        let forces: f64 = held.cables.iter().map(|cable| cable.tension_platform).sum();
        // Rounding of a length, in the stiffest rope, besides the limit of residuals.
        let stiffness = robot.cables.iter().fold(0.0, |most: f64, cable| most.max(cable.material.axial_stiffness));
        assert!(left <= 1e-9 * forces + 1e-14 * stiffness, "robot {index}: {left:e} of {forces}");
        same += usize::from(found.iter().zip(&lengths).all(|(a, b)| (a - b).abs() < 1e-5 * b));
    }
    // Nine in ten have the lengths they had; the balance of slack cables has several solutions.
    assert!(rests > 1190 && 10 * same > 8 * rests, "{rests} {same}");
}

/// Robots of the sequence that rest where iterations from straight cables find no tensions.
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
    assert!(error.is_no_solution() && error.code() == "would-push");

    // Beside poses that are held by slack ropes, their weight might do, and they are searched for.
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
        assert!(text.contains("left a scaled residual of") || text.contains("out of all proportion"), "{text}");
    }

    // Without weight straight cables decide.
    let mut massless = robot;
    massless.cables.iter_mut().for_each(|cable| cable.material.mass_per_length = 0.0);
    let error = statics::inverse(&massless, &far, StaticModel::Catenary).unwrap_err();
    assert!(matches!(error, StaticsError::WouldPush { tension, .. } if tension < 0.0), "{error}");
}

#[test]
fn a_cable_cut_to_half_its_length_is_an_answer_not_an_accident() {
    for text in [YUAN_4MM, YUAN_8MM, COGIRO] {
        let (robot, lengths) = load(text);
        for cut in 0..lengths.len() {
            let mut short = lengths.clone();
            short[cut] *= 0.5;
            for model in [StaticModel::Spring, StaticModel::Catenary] {
                let rest = statics::forward(&robot, &short, model, None).unwrap();
                assert!(rest.residual <= 1e-10, "{} cable {cut} {model:?}", robot.name);
            }
        }
    }
}

#[test]
fn too_few_cables_and_lengths_that_do_not_fit_are_refused_with_numbers() {
    let (robot, lengths) = load(COGIRO);
    let text = |r: Result<_, StaticsError>| r.map(|_: statics::Equilibrium| ()).unwrap_err().to_string();
    assert_eq!(
        text(statics::forward(&robot, &lengths[..7], StaticModel::Catenary, None)),
        "7 unstrained lengths for 8 cables: give one a cable, in file order"
    );
    assert!(text(statics::forward(&robot, &lengths, StaticModel::Ideal, None)).contains("exactly 6"));
    let pose = Pose::new([0.0, 0.0, 1.5], [0.0; 3]);
    let mut few = robot.clone();
    few.cables.truncate(5);
    assert!(text(statics::inverse(&few, &pose, StaticModel::Catenary)).contains("5 cables for 6 freedoms"));
    let mut bad = lengths.clone();
    bad[2] = -1.0;
    assert!(text(statics::forward(&robot, &bad, StaticModel::Catenary, None)).contains("is -1 m"));
    let (yuan, _) = load(YUAN_4MM);
    let far = Pose::new([40.0, 0.0, 1.0], [0.0; 3]);
    assert!(text(statics::inverse(&yuan, &far, StaticModel::Spring)).contains("would need -"));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None, ..Default::default() })]

    #[test]
    fn random_robots_come_to_rest_stably((robot, lengths) in any_robot()) {
        for model in [StaticModel::Spring, StaticModel::Catenary] {
            let rest = statics::forward(&robot, &lengths, model, None);
            let rest = rest.map_err(|e| TestCaseError::fail(format!("{model:?}: {e}")))?;
            // Rounding of a chord, in the stiffest rope, under all forces: what no search gets below.
            let forces: f64 = rest.cables.iter().map(|c| c.tension_platform).sum::<f64>() + 9.81 * robot.platform.mass;
            let stiffness: f64 = robot.cables.iter().map(|c| c.material.axial_stiffness).sum();
            prop_assert!(rest.residual <= 1e-10f64.max(2e-15 * stiffness / forces));
            // Springs may leave a direction free where cables are slack; catenaries never do.
            if model == StaticModel::Catenary {
                prop_assert!(matches!(rest.stability, Stability::Stable { .. }), "{:?}", rest.stability);
            }
        }
    }
}

/// Three unit forces, two of them at an angle φ: the least singular value squared is 1 − cos φ.
#[test]
fn the_tension_gain_grows_towards_a_singular_pose_and_is_warned_of() {
    for (degrees, warned) in [(90.0_f64, false), (30.0, false), (2.0, true)] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        // Loaded so that all tensions are 10 N.
        let text = format!(
            "name = \"three\"\ngravity_m_s2 = [-10, {}, {}]\n[platform]\nmass_kg = 1\nfreedoms = \"point-mass\"\n\
             [materials.r]\naxial_stiffness_n = 1e6\nmass_kg_per_m = 0\n\
             [[cables]]\nname = \"1\"\nmaterial = \"r\"\nanchor_m = [5, 0, 0]\n\
             [[cables]]\nname = \"2\"\nmaterial = \"r\"\nanchor_m = [0, 0, 5]\n\
             [[cables]]\nname = \"3\"\nmaterial = \"r\"\nanchor_m = [0, {}, {}]\n",
            -10.0 * sin,
            -10.0 * (1.0 + cos),
            5.0 * sin,
            5.0 * cos
        );
        let robot = Robot::from_toml(&text).unwrap();
        let held = statics::inverse(&robot, &Pose::new([0.0; 3], [0.0; 3]), StaticModel::Catenary).unwrap();
        assert!(held.cables.iter().all(|cable| (cable.tension_platform - 10.0).abs() < 1e-9));
        let gain = statics::tension_gain(&robot, &held).unwrap();
        assert!((gain * (1.0 - cos).sqrt() - 1.0).abs() < 1e-9, "{gain}");
        let warnings: Vec<String> =
            funicular::validity::of_statics(&robot, &held).iter().map(ToString::to_string).collect();
        assert_eq!(
            warnings.iter().any(|warning| warning.starts_with("the pose is nearly singular")),
            warned,
            "{warnings:?}"
        );
    }
}

/// A load below the rounding of the cables' elastic forces has no equilibrium that floating point can tell, and it is
/// not given as one.
#[test]
fn a_load_that_rounding_hides_is_refused() {
    let (mut robot, lengths) = load(YUAN_4MM);
    robot.gravity_w = Vec3::new(0.0, 0.0, -1e-12);
    for model in [StaticModel::Spring, StaticModel::Catenary] {
        let error = statics::forward(&robot, &lengths, model, None).unwrap_err();
        assert!(
            matches!(error, StaticsError::LostInRounding { residual, limit: 1e-6, .. } if residual > 1e-6),
            "{error}"
        );
        assert!(error.is_no_solution() && error.code() == "not-converged");
        let text = error.to_string();
        assert!(text.contains("loads are too small") && text.contains("give the platform more mass"), "{text}");
        assert_eq!(statics::all(&robot, &lengths, model, None).unwrap_err().code(), "not-converged");
    }
}

/// As the load falls, each answer is either an equilibrium as good as promised or none. Independent of the residual:
/// the tensions are those of the full load in proportion, up to the bend that stretch makes of it.
#[test]
fn equilibria_of_small_loads_are_right_or_refused() {
    let (robot, lengths) = load(YUAN_4MM);
    let (mut held, mut refused) = (0, 0);
    for exponent in 0..14 {
        let mut light = robot.clone();
        light.gravity_w *= 10f64.powi(-exponent);
        match statics::forward(&light, &lengths, StaticModel::Spring, None) {
            Ok(rest) => {
                held += 1;
                assert!(rest.residual <= statics::MAX_RESIDUAL_OF_ROUNDING, "{exponent}: {:e}", rest.residual);
                let up: f64 = rest.cables.iter().map(|cable| cable.force_on_platform_w.z).sum();
                let weight = light.force_at_mass_centre_w().norm();
                let tensions: f64 = rest.cables.iter().map(|cable| cable.tension_platform).sum();
                assert!((up - weight).abs() <= 1e-6 * (weight + tensions), "{exponent}: {up} for {weight}");
            }
            Err(StaticsError::LostInRounding { .. }) => refused += 1,
            Err(other) => panic!("{other}"),
        }
    }
    assert!(held >= 4 && refused >= 3, "{held} {refused}");
}

/// Nothing over nothing is no residual of one.
#[test]
fn without_load_and_tension_there_is_nothing_to_balance() {
    for text in [YUAN_4MM, YUAN_8MM] {
        let (mut robot, lengths) = load(text);
        robot.gravity_w = Vec3::zeros();
        for model in [StaticModel::Spring, StaticModel::Catenary, StaticModel::Ideal] {
            let rest = statics::forward(&robot, &lengths, model, None).unwrap();
            assert!(rest.residual == 0.0 && statics::carries_nothing(&robot, &rest), "{model:?} {:e}", rest.residual);
        }
        robot.load.force_w.z = -1.0;
        let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
        assert!(!statics::carries_nothing(&robot, &rest) && rest.residual > 0.0);
    }
}

/// Forward statics of ideal cables: the closure has a pose, which is no equilibrium where a cable would push.
#[test]
fn ideal_cables_of_lengths_that_would_have_to_push_are_refused() {
    let (robot, _) = load(YUAN_4MM);
    let pose = Pose::new([0.0, 3.0, 0.6], [0.0; 3]);
    let Err(StaticsError::WouldPush { cable, tension }) = statics::inverse(&robot, &pose, StaticModel::Ideal) else {
        panic!("too near to the edge")
    };
    let lengths: Vec<f64> =
        robot.cables.iter().map(|cable| (cable.anchor_w - pose.point_w(&cable.attachment_p)).norm()).collect();
    let error = statics::forward(&robot, &lengths, StaticModel::Ideal, Some(&pose)).unwrap_err();
    let StaticsError::LengthsPush { cable: by_lengths, tension: its, x, .. } = &error else { panic!("{error}") };
    assert!(*by_lengths == cable && (its - tension).abs() < 1e-6 * tension.abs() && x.abs() < 1e-9, "{error}");
    assert!(
        error.is_no_solution() && error.code() == "would-push" && error.to_string().contains("choose other lengths")
    );

    let point = funicular::pose_error::PoseErrorPoint::at_mass(&robot, &lengths, robot.platform.mass);
    if let Err(error) = &point.ideal {
        assert!(point.spring_from_ideal().is_none() && !error.to_string().is_empty());
    }
}
