//! Loads that rounding hides, and no loads at all.

use super::{YUAN_4MM, YUAN_8MM, load};
use funicular::math::Vec3;
use funicular::statics::{self, StaticModel, StaticsError};

/// A load below the rounding of the cables' elastic forces has no equilibrium that floating point can resolve, and none
/// is reported.
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
        assert_eq!(statics::all_equilibria(&robot, &lengths, model, None).unwrap_err().code(), "not-converged");
    }
}

/// As the load falls, each result is either an equilibrium of the promised accuracy or an error. Check independent of
/// the residual: the tensions are proportional to those of the full load, up to the curvature caused by stretch.
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

/// Zero over zero is not a residual of one.
#[test]
fn without_load_and_tension_there_is_nothing_to_balance() {
    for text in [YUAN_4MM, YUAN_8MM] {
        let (mut robot, lengths) = load(text);
        robot.gravity_w = Vec3::zeros();
        for model in [StaticModel::Spring, StaticModel::Catenary, StaticModel::Ideal] {
            let rest = statics::forward(&robot, &lengths, model, None).unwrap();
            assert!(rest.residual == 0.0 && statics::is_unloaded(&robot, &rest), "{model:?} {:e}", rest.residual);
        }
        robot.load.force_w.z = -1.0;
        let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
        assert!(!statics::is_unloaded(&robot, &rest) && rest.residual > 0.0);
    }
}
