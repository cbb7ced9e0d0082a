//! Rigid cables without weight: lengths to pose and back, and poses that they cannot hold.

use super::{COGIRO, YUAN_4MM, YUAN_8MM, crane, load};
use funicular::robot::Pose;
use funicular::statics::{self, Stability, StaticModel, StaticsError};

#[test]
fn rigid_cables_leave_a_pose_that_closes_the_lengths_and_balances() {
    for text in [YUAN_4MM, YUAN_8MM] {
        let (robot, lengths) = load(text);
        let rest = statics::forward(&robot, &lengths, StaticModel::Ideal, None).unwrap();
        for (cable, length) in rest.cables.iter().zip(&lengths) {
            assert!((cable.chord() - length).abs() < 1e-12);
        }
        assert!(rest.residual < 1e-13 && rest.stability == Stability::Rigid);
    }
}

/// Forward statics of ideal cables: the lengths close at a pose, which is no equilibrium if a tension would be
/// negative.
#[test]
fn ideal_cables_of_lengths_that_would_have_to_push_are_refused() {
    let (robot, _) = load(YUAN_4MM);
    let pose = Pose::new([0.0, 3.0, 0.6], [0.0; 3]);
    let Err(StaticsError::NegativeTension { cable, tension, .. }) = statics::inverse(&robot, &pose, StaticModel::Ideal)
    else {
        panic!("too near to the edge")
    };
    let lengths: Vec<f64> = robot.cables.iter().map(|cable| cable.chord_w(&pose).norm()).collect();
    let error = statics::forward(&robot, &lengths, StaticModel::Ideal, Some(&pose)).unwrap_err();
    let StaticsError::LengthsPush { cable: by_lengths, tension: its, x, .. } = &error else { panic!("{error}") };
    assert!(*by_lengths == cable && (its - tension).abs() < 1e-6 * tension.abs() && x.abs() < 1e-9, "{error}");
    assert!(
        error.is_no_solution()
            && error.code() == "negative-tension"
            && error.to_string().contains("choose other lengths")
    );

    let point = funicular::pose_error::PoseErrorPoint::at_mass(&robot, &lengths, robot.platform.mass);
    if let Err(error) = &point.ideal {
        assert!(point.spring_from_ideal().is_none() && !error.to_string().is_empty());
    }
}

#[test]
fn few_cables_are_refused_a_pose_and_more_ideal_cables_than_degrees_of_freedom_their_lengths() {
    let pose = Pose::new([0.0, 0.0, 1.0], [0.0; 3]);
    let error = statics::inverse(&crane(4, 0.0), &pose, StaticModel::Catenary).unwrap_err();
    assert!(matches!(error, StaticsError::InverseCableCount { cables: 4, dof: 6 }));

    let (robot, lengths) = load(COGIRO);
    for error in [
        statics::forward(&robot, &lengths, StaticModel::Ideal, None).unwrap_err(),
        statics::nearest_equilibrium(&robot, &pose, StaticModel::Ideal).unwrap_err(),
    ] {
        assert!(error.to_string().contains("no answer for more than 6"), "{error}");
    }
}
