//! Limits of supports: stiff ones, masts in closed form, and input that is refused.

use super::{Behind, at_rest, cogiro, lengths};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::Mat3;
use funicular::modes;
use funicular::robot::{Pose, Robot};
use funicular::statics::{self, StaticModel};
use std::f64::consts::TAU;

#[test]
fn stiff_supports_are_rigid_ones() {
    for behind in Behind::ALL {
        let mut robot = cogiro(behind);
        let gap = |robot: &mut Robot, stiffness: f64| {
            robot.supports.iter_mut().for_each(|support| support.stiffness_w = Mat3::identity() * stiffness);
            let pose = Pose::new([1.0, 2.0, 1.5], [2.0, 1.0, 5.0]);
            let mut stiff = robot.clone();
            stiff.supports.clear();
            stiff.cables.iter_mut().for_each(|cable| cable.anchor.support = None);
            let held = statics::inverse(&stiff, &pose, StaticModel::Catenary).unwrap();
            let rest = statics::forward(robot, &lengths(&held), StaticModel::Catenary, Some(&pose)).unwrap();
            statics::pose_distance(robot, &rest.pose, &pose)
        };
        let [soft, stiff] = [1e7, 1e9].map(|stiffness| gap(&mut robot, stiffness));
        assert!(stiff < 1e-5 && (soft / stiff - 100.0).abs() < 5.0, "{behind:?}: {soft:e}, {stiff:e}");
    }
}

/// A mast with one massless cable: everything in closed form.
#[test]
fn a_mast_bends_to_a_hanging_weight() {
    let robot = Robot::from_toml(
        "name = \"mast\"\n[platform]\nmass_kg = 10.0\nmotion = \"point-mass\"\n[materials.rope]\n\
         axial_stiffness_n = 1e5\nmass_kg_per_m = 0.0\n[supports.mast]\nstiffness_n_per_m = 2e4\n[[cables]]\nname = \
         \"1\"\n\
         material = \"rope\"\nsupport = \"mast\"\nanchor_m = [0, 0, 3]\nunstrained_length_m = 2.0\n",
    )
    .unwrap();
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let (weight, ea, k) = (98.1, 1e5, 2e4);
    assert!((rest.support_displacements(&robot)[0].z + weight / k).abs() < 1e-12);
    assert!((rest.pose.position_w.z - (3.0 - weight / k - 2.0 * (1.0 + weight / ea))).abs() < 1e-12);

    // Vertical stiffness of cable and mast in series; sideways the pendulum and the mast.
    let stiffness = statics::tangent_stiffness(&robot, &rest).unwrap();
    let chord = 2.0 * (1.0 + weight / ea);
    let series = |a: f64, b: f64| a * b / (a + b);
    assert!((stiffness[(2, 2)] / series(ea / 2.0, k) - 1.0).abs() < 1e-9);
    assert!((stiffness[(0, 0)] / series(weight / chord, k) - 1.0).abs() < 1e-9);
}

#[test]
fn the_paper_has_no_supports() {
    let robot = cogiro(Behind::Nothing);
    let rest = at_rest(&robot);
    let in_plane = Linearisation { in_plane_only: true, ..Linearisation::default() };
    assert_eq!(
        Dynamics::about(&robot, &rest, in_plane, 5.0).unwrap_err().to_string(),
        "the anchor of cable \"1\" is on a flexible support, which moves in all directions: include the \
         stiffness out of plane"
    );
}

#[test]
fn the_reader_says_what_is_wrong_with_a_support() {
    let file = |support: &str, reference: &str| {
        format!(
            "name = \"mast\"\n[platform]\nmass_kg = 10.0\nmotion = \"point-mass\"\n[materials.rope]\naxial_stiffness_n \
             = 1e5\nmass_kg_per_m = 0.0\n[supports.mast]\n{support}\n[[cables]]\nname = \"1\"\nmaterial = \
             \"rope\"\nsupport = \"{reference}\"\nanchor_m = [0, 0, 3]\nunstrained_length_m = 2.0\n"
        )
    };
    let message = |support: &str, reference: &str| {
        let error = Robot::from_toml(&file(support, reference)).unwrap_err();
        let help = error.issues()[0].help.clone().unwrap_or_default();
        format!("{}; {help}", error.issues()[0].message)
    };
    let good = "stiffness_n_per_m = [1e5, 2e5, 3e5]";
    assert!(message("mass_kg = 2", "mast").contains("has no `stiffness_n_per_m`"));
    assert!(message("stiffness_n_per_m = -1e5", "mast").contains("must be positive"));
    assert_eq!(
        message("stiffness_n_per_m = [[1e5, 2e5, 0], [2e5, 1e5, 0], [0, 0, 1e5]]", "mast"),
        "`stiffness_n_per_m` is not positive definite: its principal values are -100000, 100000 and 300000 N/m; a \
         support has to resist displacements in all directions; a rigid direction has a large number"
    );
    assert!(message("stiffness_n_per_m = [[1e5, 1, 0], [0, 1e5, 0], [0, 0, 1e5]]", "mast").contains("not symmetric"));
    assert!(message(&format!("{good}\nmass_kg = -1"), "mast").contains("must not be negative"));
    assert_eq!(
        message(&format!("{good}\ndamping_ratio = 2"), "mast"),
        "`damping_ratio` is 2, it must be below 1; it is a fraction of the critical damping, not per cent: structures \
         have 0.005 to 0.05"
    );
    assert!(message(&format!("{good}\ndrums = \"on-grund\""), "mast").contains("did you mean \"on-ground\"?"));
    assert_eq!(message(good, "mats"), "there is no support \"mats\"; did you mean \"mast\"? the file has \"mast\"");
    assert!(Robot::from_toml(&file(good, "mast")).unwrap().has_supports());
}

/// Supports and cables without mass are springs: the mast of a massless rope swings with the platform alone.
#[test]
fn a_mast_without_mass_is_a_spring() {
    let robot = Robot::from_toml(
        "name = \"mast\"\n[platform]\nmass_kg = 10.0\nmotion = \"point-mass\"\n[materials.rope]\naxial_stiffness_n = \
         1e5\n\
         mass_kg_per_m = 0.0\n[supports.mast]\nstiffness_n_per_m = 2e4\n[[cables]]\nname = \"1\"\nmaterial = \"rope\"\n\
         support = \"mast\"\nanchor_m = [0, 0, 3]\nunstrained_length_m = 2.0\n",
    )
    .unwrap();
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 20.0).unwrap();
    let found = modes::below(&dynamics, 20.0);
    assert!(found.certified && found.modes.len() == 3);
    let (weight, ea, k) = (98.1_f64, 1e5, 2e4);
    let chord = 2.0 * (1.0 + weight / ea);
    let series = |a: f64, b: f64| a * b / (a + b);
    let hz = |stiffness: f64| (stiffness / 10.0).sqrt() / TAU;
    for (mode, exact) in
        found.modes.iter().zip([series(weight / chord, k), series(weight / chord, k), series(ea / 2.0, k)])
    {
        assert!((mode.frequency_hz / hz(exact) - 1.0).abs() < 1e-9, "{} {}", mode.frequency_hz, hz(exact));
        assert_eq!(mode.support_energy_fractions, [0.0]);
    }
}
