//! Several equilibria for the same lengths, compared with Morse's count, a scan of all angles, and other starts.

use funicular::math::Vec3;
use funicular::robot::{Plane, PlatformMotion, Pose, Robot, State};
use funicular::statics::{self, StaticModel};
use std::f64::consts::TAU;

const ROBOTS: [(&str, &str); 5] = [
    ("yuan2014-4mm", funicular_robots::YUAN2014_4MM),
    ("yuan2014-8mm", funicular_robots::YUAN2014_8MM),
    ("ipanema2", funicular_robots::IPANEMA2),
    ("fast", funicular_robots::FAST),
    ("stadium-camera", funicular_robots::STADIUM_CAMERA),
];

fn lengths_of(robot: &Robot) -> (Vec<f64>, Option<Pose>) {
    match &robot.state {
        State::Lengths(lengths) => (lengths.clone(), None),
        State::Pose(pose) => {
            let held = statics::inverse(robot, pose, StaticModel::Catenary).unwrap();
            (held.cables.iter().map(|cable| cable.unstrained_length).collect(), Some(*pose))
        }
        State::Unknown => panic!("the library's robots have a state"),
    }
}

#[test]
fn lists_of_equilibria_have_the_sum_that_they_must_have() {
    for (name, text) in ROBOTS {
        let robot = Robot::from_toml(text).unwrap();
        let (lengths, pose) = lengths_of(&robot);
        let all = statics::all_equilibria(&robot, &lengths, StaticModel::Catenary, pose.as_ref()).unwrap();
        assert_eq!(Some(all.index_sum), all.expected_index_sum, "{name}");
        assert!(!all.lacks_some());
        assert!(all.found[0].is_stable() && all.found[0].energy == Some(0.0), "the lowest of all is stable");
        assert!(all.found.iter().any(|one| one.is_stable() && one.distance < 1e-6), "{name}: the one asked");
        for one in &all.found {
            assert!(one.equilibrium.residual <= statics::RESIDUAL_LIMIT, "{name}");
            // Wrench there, by the function that does not belong to the search.
            let wrench = statics::wrench(&robot, &one.equilibrium.pose, &lengths, StaticModel::Catenary).unwrap();
            let size: f64 = one.equilibrium.cables.iter().map(|cable| cable.tension_platform).sum();
            let force = robot.platform.motion.allowed(&wrench);
            assert!(force.fixed_rows::<3>(0).norm() < 1e-9 * size, "{name}: {wrench}");
            // From a pose near it the platform moves back, or away.
            let aside =
                one.equilibrium.pose.moved(&(Vec3::new(1.0, -2.0, 0.5) * 1e-3), &(Vec3::new(0.5, 1.0, -1.0) * 1e-3));
            let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, Some(&aside)).unwrap();
            let back = statics::pose_distance(&robot, &rest.pose, &one.equilibrium.pose) < 1e-6;
            assert_eq!(back, one.is_stable(), "{name}");
        }
    }
}

/// Bar on three cables in a plane. For every angle it has one equilibrium position; if the moment vanishes there, it is
/// an equilibrium. The position is found by a robot that cannot rotate: a point whose anchors are shifted by the arms.
#[test]
fn a_planar_robot_has_the_equilibria_that_a_scan_of_all_angles_shows() {
    // Anchor (x, z), attachment (x, z), unstrained length.
    let hanging = [([-2.0, 3.0], [-0.4, 0.1], 2.9), ([2.5, 3.2], [0.5, 0.05], 3.0), ([0.3, 3.5], [0.1, -0.2], 2.6)];
    assert_eq!(compare_with_a_scan(&hanging), 2);
    // Two of the cables pull the bar in opposite directions: it has an equilibrium either way up.
    let crossed = [([-2.1, 2.6], [-0.3, 0.3], 3.29), ([2.7, 2.8], [0.1, 0.0], 3.74), ([2.7, 3.7], [-1.4, -0.2], 5.64)];
    assert!(compare_with_a_scan(&crossed) >= 4);
}

/// Compares the equilibria and returns their number.
fn compare_with_a_scan(of: &[([f64; 2], [f64; 2], f64)]) -> usize {
    let cables: Vec<_> = of.iter().map(|([x, z], [a, c], length)| ([*x, 0.0, *z], [*a, 0.0, *c], *length)).collect();
    let text = |dof: &str, inertia: &str| {
        let head = format!(
            "name = \"bar\"\n[platform]\nmotion = \"{dof}\"\nmass_kg = 4\n{inertia}\n[materials.r]\n\
             axial_stiffness_n = 3e4\nmass_kg_per_m = 0.2\n"
        );
        cables.iter().enumerate().fold(head, |text, (i, (anchor, attachment, length))| {
            let attachment =
                if dof == "point-mass" { String::new() } else { format!("attachment_m = {attachment:?}\n") };
            format!(
                "{text}[[cables]]\nname = \"{i}\"\nmaterial = \"r\"\nanchor_m = \
                {anchor:?}\n{attachment}unstrained_length_m = {length}\n"
            )
        })
    };
    let robot =
        Robot::from_toml(&text("planar-xz", "inertia_kg_m2 = 0.3\ncenter_of_mass_m = [0.05, 0, -0.1]")).unwrap();
    assert_eq!(robot.platform.motion, PlatformMotion::Planar(Plane::new(Vec3::y(), 0.0).unwrap()));
    let point = Robot::from_toml(&text("point-mass", "")).unwrap();
    let lengths: Vec<f64> = cables.iter().map(|(_, _, length)| *length).collect();
    let moment = |angle: f64| {
        let mut held = point.clone();
        let turned = Pose::new([0.0; 3], [0.0, angle.to_degrees(), 0.0]);
        for (cable, (anchor, attachment, _)) in held.cables.iter_mut().zip(&cables) {
            cable.anchor = (Vec3::from(*anchor) - turned.rot_wp * Vec3::from(*attachment)).into();
        }
        let rest = statics::forward(&held, &lengths, StaticModel::Catenary, None).unwrap();
        let center = turned.rot_wp * robot.platform.center_of_mass_p;
        let of_weight = center.cross(&(robot.gravity_w * robot.platform.mass));
        let of_cables = rest.cables.iter().zip(&cables).map(|(state, (_, attachment, _))| {
            (turned.rot_wp * Vec3::from(*attachment)).cross(&state.force_on_platform_w)
        });
        of_cables.sum::<Vec3>().y + of_weight.y
    };
    let angles: Vec<f64> = (0..=1440).map(|k| f64::from(k) * TAU / 1440.0).collect();
    let moments: Vec<f64> = angles.iter().map(|angle| moment(*angle)).collect();
    let crossings: Vec<(f64, bool)> = moments
        .windows(2)
        .zip(&angles)
        .filter(|(pair, _)| pair[0] * pair[1] < 0.0)
        .map(|(pair, angle)| (angle + TAU / 1440.0 * pair[0] / (pair[0] - pair[1]), pair[0] > 0.0))
        .collect();
    let all = statics::all_equilibria(&robot, &lengths, StaticModel::Catenary, None).unwrap();
    assert_eq!(all.found.len(), crossings.len(), "{crossings:?}");
    for (angle, stable) in crossings {
        let turned = Pose::new([0.0; 3], [0.0, angle.to_degrees(), 0.0]).rot_wp;
        let nearest = all.found.iter().min_by(|a, b| {
            a.equilibrium.pose.rot_wp.angle_to(&turned).total_cmp(&b.equilibrium.pose.rot_wp.angle_to(&turned))
        });
        let nearest = nearest.unwrap();
        assert!(nearest.equilibrium.pose.rot_wp.angle_to(&turned) < 1e-3);
        assert_eq!(nearest.is_stable(), stable, "{angle}");
    }
    all.found.len()
}

#[test]
fn a_body_on_one_cable_is_one_family_and_a_twisted_platform_is_another() {
    let text = "name = \"plumb\"\n[platform]\nmass_kg = 2\ninertia_kg_m2 = [0.1, 0.1, 0.1]\n[materials.r]\n\
                axial_stiffness_n = 1e5\nmass_kg_per_m = 0.01\n[[cables]]\nname = \"1\"\nmaterial = \"r\"\n\
                anchor_m = [0, 0, 3]\nattachment_m = [0, 0, 0.2]\nunstrained_length_m = 1\n";
    let robot = Robot::from_toml(text).unwrap();
    let all = statics::all_equilibria(&robot, &[1.0], StaticModel::Catenary, None).unwrap();
    // Hanging, and standing on its cable: both can turn about the vertical.
    assert_eq!(all.found.iter().map(|one| (one.falling, one.indifferent)).collect::<Vec<_>>(), [(0, 1), (2, 1)]);
    assert_eq!(all.expected_index_sum, None);
    // Twice the lever of the centre of mass, and the stretch: m g 2 r = 7.8 J.
    assert!((all.found[1].energy.unwrap() - 2.0 * 9.81 * 0.4).abs() < 0.1, "{:?}", all.found[1].energy);
    assert!(statics::another_stable_equilibrium(&robot, &all.found[0].equilibrium).is_none());

    let robot = Robot::from_toml(ROBOTS[0].1).unwrap();
    let (lengths, _) = lengths_of(&robot);
    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
    let (other, energy) = statics::another_stable_equilibrium(&robot, &rest).unwrap();
    let again = statics::forward(&robot, &lengths, StaticModel::Catenary, Some(&other.equilibrium.pose)).unwrap();
    assert!(statics::pose_distance(&robot, &again.pose, &other.equilibrium.pose) < 1e-8 && energy.unwrap() > 1.0);
    assert!(
        statics::another_stable_equilibrium(&robot, &other.equilibrium).unwrap().1.unwrap() < -1.0,
        "the first is lower"
    );
}

#[test]
fn ideal_cables_have_no_energy_to_search() {
    let robot = Robot::from_toml(ROBOTS[0].1).unwrap();
    let (lengths, _) = lengths_of(&robot);
    let error = statics::all_equilibria(&robot, &lengths, StaticModel::Ideal, None).unwrap_err();
    assert!(error.to_string().contains("choose the static model `spring` or `catenary`"), "{error}");
}
