//! Nearness to a singular pose.

use funicular::robot::{Pose, Robot};
use funicular::statics::{self, StaticModel};

/// Three unit forces, two of them at an angle φ: the smallest singular value squared is 1 − cos φ.
#[test]
fn the_tension_gain_grows_towards_a_singular_pose_and_is_warned_of() {
    for (degrees, warned) in [(90.0_f64, false), (30.0, false), (2.0, true)] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        // Loaded such that all tensions are 10 N.
        let text = format!(
            "name = \"three\"\ngravity_m_s2 = [-10, {}, {}]\n[platform]\nmass_kg = 1\nmotion = \"point-mass\"\n\
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
            funicular::warnings::of_statics(&robot, &held).iter().map(ToString::to_string).collect();
        assert_eq!(
            warnings.iter().any(|warning| warning.starts_with("the pose is nearly singular")),
            warned,
            "{warnings:?}"
        );
    }
}

/// A platform that hangs with its attachments below the anchors, turned by a small angle: nothing resists yaw at zero.
#[test]
fn an_inverse_condition_of_a_two_hundredth_is_warned_of() {
    let mut found = Vec::new();
    for twist in [0.3_f64, 0.004] {
        let mut text = "name = \"parallel\"\n[platform]\nmass_kg = 60.0\ninertia_kg_m2 = [4.45, 6.25, 8.2]\n\
             center_of_mass_m = [0.0, 0.0, 0.0]\n[materials.r]\naxial_stiffness_n = 1.4e6\nmass_kg_per_m = 0.13\n"
            .to_owned();
        for i in 0..8 {
            // Upper and lower corners turn to opposite sides, little: then hardly anything resists a rotation.
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            let angle = f64::from(i / 2) * std::f64::consts::FRAC_PI_2 + side * twist;
            let corner = f64::from(i / 2) * std::f64::consts::FRAC_PI_2;
            let cable = format!(
                "[[cables]]\nname = \"{i}\"\nmaterial = \"r\"\nanchor_m = [{}, {}, {}]\nattachment_m = [{}, {}, {}]\n",
                9.0 * corner.cos(),
                9.0 * corner.sin(),
                7.5 + 0.5 * side,
                0.6 * angle.cos(),
                0.6 * angle.sin(),
                -0.25 * side,
            );
            text.push_str(&cable);
        }
        let robot = Robot::from_toml(&text).unwrap();
        let held = statics::inverse(&robot, &Pose::new([0.0, 0.0, 3.0], [0.0; 3]), StaticModel::Catenary).unwrap();
        let warned = funicular::warnings::of_statics(&robot, &held)
            .iter()
            .any(|warning| warning.to_string().starts_with("the pose is nearly singular"));
        found.push((statics::inverse_condition(&robot, &held), warned));
    }
    assert!(found[0].0 > 0.05 && !found[0].1, "{found:?}");
    assert!((0.0045..0.0055).contains(&found[1].0) && found[1].1, "{found:?}");
}
