//! Unstrained lengths to a pose: no start needed, slack cables, refused input.

use super::{COGIRO, YUAN_4MM, YUAN_8MM, load};
use crate::library::independent_robots;
use crate::random::any_robot;
use funicular::math::Vec3;
use funicular::robot::Pose;
use funicular::statics::{self, Stability, StaticModel, StaticsError};
use proptest::prelude::*;

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
fn robots_of_the_independent_program_rest_stably_without_a_start() {
    for (id, robot, rest) in independent_robots() {
        assert!(rest.residual <= statics::RESIDUAL_LIMIT, "{id}: {}", rest.residual);
        assert!(matches!(rest.stability, Stability::Stable { .. }), "{id}: {:?}", rest.stability);
        assert_eq!(rest.cables.len(), robot.cables.len(), "{id}");
    }
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
        "7 unstrained lengths given for 8 cables: give one length per cable, in the order of the file"
    );
    assert!(text(statics::forward(&robot, &lengths, StaticModel::Ideal, None)).contains("no answer for more than 6"));
    let pose = Pose::new([0.0, 0.0, 1.5], [0.0; 3]);
    let mut few = robot.clone();
    few.cables.truncate(5);
    assert!(text(statics::inverse(&few, &pose, StaticModel::Catenary)).contains("5 cables for 6 degrees of freedom"));
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
            // Rounding of a chord in the stiffest rope, over all forces: no search can get below it.
            let forces: f64 = rest.cables.iter().map(|c| c.tension_platform).sum::<f64>() + 9.81 * robot.platform.mass;
            let stiffness: f64 = robot.cables.iter().map(|c| c.material.axial_stiffness).sum();
            prop_assert!(rest.residual <= 1e-10f64.max(2e-15 * stiffness / forces));
            // Springs may leave a direction free if cables are slack; catenaries never do.
            if model == StaticModel::Catenary {
                prop_assert!(matches!(rest.stability, Stability::Stable { .. }), "{:?}", rest.stability);
            }
        }
    }
}
