//! Platforms that move in a plane: hand formulas, mirrored copies, and a rigid robot restricted to a plane.

use crate::random::any_robot;
use funicular::cable::CableModel;
use funicular::dynamics::{Assembly, Dynamics, Linearisation};
use funicular::math::{DMat, Mat3, Mat6, Vec3, Vec6};
use funicular::modes::{self, Mode};
use funicular::response::{self, Quantity};
use funicular::robot::{Plane, PlatformMotion, Pose, Robot};
use funicular::statics::{self, Stability, StaticModel, TensionRange, TensionRule};
use proptest::prelude::*;
use std::f64::consts::TAU;

const YUAN: &str = funicular_robots::YUAN2014_4MM;

/// Robot whose platform moves in the plane through a pose.
fn in_plane(robot: &Robot, normal: Vec3, pose: &Pose) -> Robot {
    let mut planar = robot.clone();
    let offset = normal.normalize().dot(&pose.position_w);
    planar.platform.motion = PlatformMotion::Planar(Plane::new(normal, offset).unwrap());
    planar
}

/// Plate in the xz plane on two cables of mass `rope_mass` [kg/m].
fn plate(rope_mass: f64) -> String {
    format!(
        "name = \"plate\"\n[platform]\nmotion = \"planar-xz\"\nmass_kg = 8.0\ninertia_kg_m2 = 0.3\n\
         center_of_mass_m = [0.02, 0.0, -0.05]\n[materials.rope]\naxial_stiffness_n = 5e4\nmass_kg_per_m = \
         {rope_mass}\n\
         [[cables]]\nname = \"1\"\nmaterial = \"rope\"\nanchor_m = [-2.0, 0.0, 3.0]\nattachment_m = [-0.3, 0.0, 0.1]\n\
         [[cables]]\nname = \"2\"\nmaterial = \"rope\"\nanchor_m = [2.5, 0.0, 3.2]\nattachment_m = [0.3, 0.0, 0.1]\n\
         [[cables]]\nname = \"3\"\nmaterial = \"rope\"\nanchor_m = [0.4, 0.0, -2.0]\nattachment_m = [0.05, 0.0, -0.1]\n"
    )
}

/// Rigid body made of two such plates, one at y = ±b.
fn two_plates(rope_mass: f64, b: f64) -> Robot {
    let mut text = plate(rope_mass)
        .replace("motion = \"planar-xz\"\n", "")
        .replace("mass_kg = 8.0", "mass_kg = 16.0")
        .replace("inertia_kg_m2 = 0.3", "inertia_kg_m2 = [2.0, 0.6, 2.1]");
    let cables: Vec<String> = text.split("[[cables]]\n").skip(1).map(str::to_owned).collect();
    text = text.split("[[cables]]\n").next().unwrap().to_owned();
    for (side, y) in [("l", -b), ("r", b)] {
        for cable in &cables {
            let cable =
                cable.replace("name = \"", &format!("name = \"{side}")).replace(", 0.0, ", &format!(", {y:?}, "));
            text.push_str("[[cables]]\n");
            text.push_str(&cable);
        }
    }
    Robot::from_toml(&text).unwrap()
}

#[test]
fn a_plate_on_two_upright_springs_has_the_frequencies_of_the_hand_formula() {
    let (mass, inertia, a, length, stiffness) = (6.0, 0.35, 0.4, 2.0, 3e4);
    let text = format!(
        "name = \"swing\"\n[platform]\nmotion = \"planar-xz\"\nmass_kg = {mass}\ninertia_kg_m2 = {inertia}\n\
         [materials.rope]\naxial_stiffness_n = {stiffness}\nmass_kg_per_m = 0\n\
         [[cables]]\nname = \"1\"\nmaterial = \"rope\"\nanchor_m = [-0.4, 0, {length}]\nattachment_m = [-0.4, 0, 0]\n\
         [[cables]]\nname = \"2\"\nmaterial = \"rope\"\nanchor_m = [0.4, 0, {length}]\nattachment_m = [0.4, 0, 0]\n"
    );
    let robot = Robot::from_toml(&text).unwrap();
    let tension = mass * 9.81 / 2.0;
    let unstrained = length / (1.0 + tension / stiffness);
    // Two cables, three degrees of freedom: the lengths alone determine the pose.
    let rest = statics::forward(&robot, &[unstrained; 2], StaticModel::Spring, None).unwrap();
    assert!(rest.pose.position_w.norm() < 1e-9, "{}", rest.pose.position_w);
    let linearisation = Linearisation { cable_model: CableModel::CatenaryStatic, ..Default::default() };
    let found = modes::below(&Dynamics::about(&robot, &rest, linearisation, 100.0).unwrap(), 100.0);
    let axial = stiffness / unstrained;
    let expected = [2.0 * tension / (length * mass), 2.0 * axial / mass, 2.0 * axial * a * a / inertia]
        .map(|x: f64| x.sqrt() / TAU);
    assert!(found.certified && found.modes.len() == 3, "{found:?}");
    for (mode, expected) in found.modes.iter().zip(expected) {
        assert!((mode.frequency_hz / expected - 1.0).abs() < 1e-9, "{} {expected}", mode.frequency_hz);
        assert!([1, 3, 5].iter().all(|&i| mode.shape[i] == 0.0), "{:?}", mode.shape);
    }
}

#[test]
fn a_planar_platform_has_a_plane_and_one_moment_of_inertia() {
    let file = plate(0.4);
    let robot = Robot::from_toml(&file.replace("planar-xz\"", "planar-xz\"\nplane_offset_m = 0.25")).unwrap();
    let PlatformMotion::Planar(plane) = robot.platform.motion else { panic!("planar") };
    assert_eq!((plane.normal_w(), plane.offset()), (Vec3::y(), 0.25));
    assert_eq!(robot.platform.inertia_p, Mat3::from_diagonal(&Vec3::new(0.0, 0.3, 0.0)));
    let any = file.replace("\"planar-xz\"", "\"planar\"\nplane_normal = [0, 3, 4]");
    let PlatformMotion::Planar(plane) = Robot::from_toml(&any).unwrap().platform.motion else { panic!("planar") };
    assert!((plane.normal_w() - Vec3::new(0.0, 0.6, 0.8)).norm() < 1e-15);
    assert!(Robot::from_toml(&file.replace("m2 = 0.3", "m2 = [0.3, 0.4, 0.5]")).is_ok());
    for (from, to, said, line) in [
        ("\"planar-xz\"", "\"planar\"", "needs the normal of its plane", 3),
        ("\"planar-xz\"", "\"planar-xz\"\nplane_normal = [0, 1, 0]", "`plane_normal` goes with `motion", 4),
        ("\"planar-xz\"", "\"planar\"\nplane_normal = [0, 0, 0]", "has no direction", 4),
        ("\"planar-xz\"", "\"rigid\"\nplane_offset_m = 1", "`plane_offset_m` is for a planar platform only", 4),
        ("\"planar-xz\"", "\"planar-zx\"", "`motion` is \"planar-zx\", which is unknown", 3),
        ("m2 = 0.3", "m2 = -0.3", "`inertia_kg_m2` is -0.3, it must be positive", 5),
        ("attachment_m = [-0.3, 0.0, 0.1]\n", "", "has no `attachment_m`", 10),
    ] {
        let error = Robot::from_toml(&file.replace(from, to)).unwrap_err().to_string();
        assert!(error.contains(said) && error.contains(&format!("line {line},")), "{error}");
    }
    for (state, said) in [
        ("position_m = [0, 1, 0]", "1 m off the plane"),
        ("position_m = [0, 0, 0]\nroll_pitch_yaw_deg = [0, 0, 2]", "tilted out of its plane by 2"),
    ] {
        let error = Robot::from_toml(&format!("{file}[state]\n{state}\n")).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
    assert!(
        Robot::from_toml(&format!("{file}[state]\nposition_m = [1, 0, 1]\nroll_pitch_yaw_deg = [0, 8, 0]\n")).is_ok()
    );
}

/// Modes with a moving platform.
fn moving(modes: &[Mode]) -> Vec<&Mode> {
    modes.iter().filter(|mode| mode.shape.iter().any(|x| *x != 0.0)).collect()
}

#[test]
fn a_plate_is_the_symmetric_half_of_two_rigidly_joined_ones() {
    for (rope_mass, model) in
        [(0.4, CableModel::CatenaryDynamic), (0.05, CableModel::ShallowDynamic), (0.4, CableModel::ShallowStatic)]
    {
        let robot = Robot::from_toml(&plate(rope_mass)).unwrap();
        let pose = Pose::new([0.1, 0.0, 0.4], [0.0, 5.0, 0.0]);
        let held = statics::inverse(&robot, &pose, StaticModel::Catenary).unwrap();
        let lengths: Vec<f64> = held.cables.iter().map(|c| c.unstrained_length).collect();
        let back = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
        assert!(statics::pose_distance(&robot, &pose, &back.pose) < 1e-9);

        let joined = two_plates(rope_mass, 0.25);
        let twice = [lengths.clone(), lengths].concat();
        let rest = statics::forward(&joined, &twice, StaticModel::Catenary, None).unwrap();
        assert!(statics::pose_distance(&joined, &pose, &rest.pose) < 1e-8);

        let linearisation = Linearisation { cable_model: model, ..Default::default() };
        let (below, about) = (25.0, Dynamics::about);
        let half = modes::below(&about(&robot, &held, linearisation, below).unwrap(), below);
        let whole = modes::below(&about(&joined, &rest, linearisation, below).unwrap(), below);
        assert!(half.certified && whole.certified, "{model}");
        // Near a cable's own frequency, symmetric and antisymmetric modes of the joined plates may mix.
        let counts = |mode: &&Mode| mode.platform_energy_fraction > 1e-3;
        let symmetric = |mode: &Mode| [1, 3, 5].iter().all(|&i| mode.shape[i].abs() < 1e-6);
        let ours: Vec<&Mode> = moving(&half.modes).into_iter().filter(counts).collect();
        let theirs: Vec<&Mode> = moving(&whole.modes).into_iter().filter(|m| counts(m) && symmetric(m)).collect();
        assert!(ours.len() >= 3 && ours.len() == theirs.len(), "{model}: {} {}", ours.len(), theirs.len());
        for (half, whole) in ours.iter().zip(theirs) {
            assert!((half.frequency_hz / whole.frequency_hz - 1.0).abs() < 1e-8, "{model}");
            assert!((half.damping_ratio - whole.damping_ratio).abs() < 1e-9);
            // Each robot has its own ℓ, so their shapes may be scaled differently.
            let k = [0, 2, 4].into_iter().max_by(|&i, &j| half.shape[i].abs().total_cmp(&half.shape[j].abs())).unwrap();
            let masses = half.modal_mass / whole.modal_mass * 2.0 * (whole.shape[k] / half.shape[k]).powi(2);
            assert!((masses - 1.0).abs() < 1e-5, "{model}: {masses} at {} Hz", half.frequency_hz);
        }
    }
}

#[test]
fn cables_in_the_plane_vibrate_across_it_with_the_platform_at_rest() {
    let robot = Robot::from_toml(&plate(0.02)).unwrap();
    let pose = Pose::new([0.1, 0.0, 0.4], [0.0, 5.0, 0.0]);
    let held = statics::inverse(&robot, &pose, StaticModel::Catenary).unwrap();
    let linearisation = Linearisation { cable_model: CableModel::CatenaryDynamic, ..Default::default() };
    let found = modes::below(&Dynamics::about(&robot, &held, linearisation, 30.0).unwrap(), 30.0);
    assert!(found.certified && found.modes.len() == found.count_below);
    let resting: Vec<f64> =
        found.modes.iter().filter(|m| m.shape.iter().all(|x| *x == 0.0)).map(|m| m.frequency_hz).collect();
    // Frequencies of the string, k √(τ/m)/(2 l), which a sagging cable keeps out of its plane to the order of its sag
    // squared.
    let mut strings: Vec<f64> = (0..3)
        .flat_map(|i| {
            let first = funicular::cable::Sag::of(&robot, i, &held.cables[i]).string_frequency_hz();
            (1..).map(move |k| f64::from(k) * first).take_while(|f| *f < 30.0)
        })
        .collect();
    strings.sort_by(f64::total_cmp);
    assert!(strings.len() >= 3 && resting.len() == strings.len(), "{resting:?} {strings:?}");
    for (ours, string) in resting.iter().zip(&strings) {
        assert!((ours / string - 1.0).abs() < 2e-3, "{ours} {string}");
    }
    // These modes are out of the plane; restricted to the plane they do not exist.
    let only = Linearisation { in_plane_only: true, ..linearisation };
    let found = modes::below(&Dynamics::about(&robot, &held, only, 30.0).unwrap(), 30.0);
    assert!(found.certified && moving(&found.modes).len() == found.modes.len());
}

/// Columns of a plane's motions, written out: two directions and the rotation.
fn motions(first: Vec3, second: Vec3) -> DMat {
    let mut columns = DMat::zeros(6, 3);
    for i in 0..3 {
        columns[(i, 0)] = first[i];
        columns[(i, 1)] = second[i];
        columns[(3 + i, 2)] = first.cross(&second)[i];
    }
    columns
}

fn dynamic(matrix: &Mat6) -> DMat {
    DMat::from_fn(6, 6, |i, j| matrix[(i, j)])
}

#[test]
fn the_papers_robot_restricted_to_a_plane_is_a_block_of_the_rigid_one() {
    let robot = Robot::from_toml(YUAN).unwrap();
    let pose = Pose::new([0.4, 0.1, 0.55], [0.0; 3]);
    let held = statics::inverse(&robot, &pose, StaticModel::Catenary).unwrap();
    let skew = Vec3::new(1.0, -2.0, 0.5).normalize();
    let aside = skew.cross(&Vec3::z()).normalize();
    for (first, second) in
        [(Vec3::x(), Vec3::z()), (Vec3::x(), Vec3::y()), (Vec3::y(), Vec3::z()), (aside, skew.cross(&aside))]
    {
        let planar = in_plane(&robot, first.cross(&second), &pose);
        let b = motions(first, second);
        let linearisation = Linearisation { assembly: Assembly::Consistent, ..Default::default() };
        let rigid = Dynamics::about(&robot, &held, linearisation, 10.0).unwrap();
        let guided = Dynamics::about(&planar, &held, linearisation, 10.0).unwrap();
        let mass = b.transpose() * dynamic(&rigid.mass()) * &b;
        assert!((b.transpose() * dynamic(&guided.mass()) * &b - &mass).amax() < 1e-12 * mass.amax());
        let f = 2.3;
        let stiffness = rigid.stiffness(f * TAU);
        let whole = funicular::math::CDMat::from_fn(6, 6, |i, j| stiffness[(i, j)]);
        let complex = b.map(funicular::math::Complex::from);
        let block = complex.transpose() * whole * &complex;
        let d = &block - mass.map(funicular::math::Complex::from) * funicular::math::Complex::from((f * TAU).powi(2));
        let receptance = &complex * d.try_inverse().unwrap() * complex.transpose();
        let ours = response::receptances(&guided, &[f; 9]).unwrap()[4];
        let plain = response::receptance(&guided, f * TAU);
        for i in 0..6 {
            for j in 0..6 {
                for x in [ours, plain] {
                    assert!((x[(i, j)] - receptance[(i, j)]).norm() < 1e-11 * receptance.norm(), "{i} {j}");
                }
            }
        }
        let u = response::along(&Vec3::new(1.0, 2.0, 3.0), &Vec3::new(0.1, 0.0, 0.2), &pose);
        let v = response::about(&Vec3::new(0.0, 1.0, 1.0));
        let one = response::frf(&guided, &[f], &u, &v, Quantity::Displacement).unwrap()[0];
        let expected: funicular::math::Complex =
            (0..36).map(|k| receptance[(k / 6, k % 6)] * v[k / 6] * u[k % 6]).sum();
        assert!((one - expected).norm() < 1e-11 * receptance.norm());
    }
}

#[test]
fn tensions_of_a_planar_robot_with_four_cables_are_chosen_within_limits() {
    let text = plate(0.05)
        + "[[cables]]\nname = \"4\"\nmaterial = \"rope\"\nanchor_m = [-1.5, 0.0, -2.0]\nattachment_m = [-0.1, 0.0, \
            -0.1]\n";
    let mut robot = Robot::from_toml(&text).unwrap();
    for cable in &mut robot.cables {
        cable.tension_limits.maximum = Some(400.0);
        cable.tension_limits.minimum = Some(20.0);
    }
    let pose = Pose::new([0.1, 0.0, 0.4], [0.0, 5.0, 0.0]);
    for rule in [TensionRule::Lowest, TensionRule::Closest(vec![90.0]), TensionRule::Middle, TensionRule::Stiffest] {
        let held = statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, &rule).unwrap();
        let lengths: Vec<f64> = held.cables.iter().map(|c| c.unstrained_length).collect();
        let wrench = statics::wrench(&robot, &pose, &lengths, StaticModel::Catenary).unwrap();
        assert!([0, 2, 4].iter().all(|&i| wrench[i].abs() < 1e-7), "{wrench}");
        for (i, cable) in held.cables.iter().enumerate() {
            assert!(TensionRange::of(&robot, i, &cable.chord_w()).margin(cable).distance() > -1e-6 * 400.0);
        }
        let back = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
        assert!(statics::pose_distance(&robot, &pose, &back.pose) < 1e-8, "{}", rule.name());
    }
}

#[test]
fn a_pose_off_the_plane_is_refused_and_gravity_across_it_is_the_guides() {
    let robot = Robot::from_toml(&plate(0.4)).unwrap();
    let refused = |pose: Pose| statics::inverse(&robot, &pose, StaticModel::Catenary).unwrap_err().to_string();
    assert!(refused(Pose::new([0.0, 0.1, 0.4], [0.0; 3])).contains("0.1 m off the plane"));
    assert!(refused(Pose::new([0.0, 0.0, 0.4], [3.0, 0.0, 0.0])).contains("tilted out of its plane by 3"));
    let start = Pose::new([0.0, 0.0, 0.4], [0.0, 0.0, 1.0]);
    assert!(statics::forward(&robot, &[3.0; 3], StaticModel::Catenary, Some(&start)).is_err());
    // On a table: the cables sag out of the plane, but the platform stays in it.
    let mut table = in_plane(&robot, Vec3::y(), &Pose::new([0.0; 3], [0.0; 3]));
    table.gravity_w = Vec3::new(0.0, -9.81, 0.0);
    for cable in &mut table.cables {
        cable.tension_limits.maximum = Some(1e4);
    }
    let rest = statics::forward(&table, &[2.9, 3.1, 2.0], StaticModel::Catenary, None).unwrap();
    assert!(rest.pose.position_w.y.abs() < 1e-15 && rest.residual < 1e-10);
    assert!(matches!(rest.stability, Stability::Stable { .. }));
    let wrench = statics::wrench(&table, &rest.pose, &[2.9, 3.1, 2.0], StaticModel::Catenary).unwrap();
    assert!(wrench[1] < -8.0 * 9.81, "the guide carries the platform and a share of the cables: {wrench}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..Default::default() })]

    /// Spatial robot in a guide of any plane: its static stiffness is the derivative of the wrench, its list of modes
    /// is complete, and an inverse solution leads back.
    #[test]
    fn any_robot_in_any_plane_is_consistent(
        (robot, lengths) in any_robot(), normal in prop::array::uniform3(-1.0f64..1.0), redundant in any::<bool>(),
    ) {
        let normal = Vec3::from(normal);
        prop_assume!(normal.norm() > 0.1);
        let mut planar = in_plane(&robot, normal, &Pose::new([0.0; 3], [0.0; 3]));
        if !redundant {
            planar.cables.truncate(3);
        }
        let lengths = &lengths[..planar.cables.len()];
        let rest = statics::forward(&planar, lengths, StaticModel::Catenary, None);
        // Slack robots on a slope may have no minimum within reach of the search; another test treats that.
        prop_assume!(rest.is_ok());
        let rest = rest.unwrap();
        prop_assert!(planar.platform.motion.check(&rest.pose).is_ok());
        let motion = planar.platform.motion;
        let wrench = statics::wrench(&planar, &rest.pose, lengths, StaticModel::Catenary).unwrap();
        let force: f64 = rest.cables.iter().map(|c| c.tension_platform).sum::<f64>() + planar.platform.mass * 9.81;
        prop_assert!(motion.allowed(&wrench).amax() < 1e-9 * force);
        let stiffness = statics::tangent_stiffness(&planar, &rest).unwrap();
        for k in 0..3 {
            let unit = motion.expanded(&Vec6::ith(k, 1.0));
            let h = 1e-6;
            let at = |step: f64| {
                let d = unit * step;
                let pose = rest.pose.moved(&Vec3::new(d[0], d[1], d[2]), &Vec3::new(d[3], d[4], d[5]));
                statics::wrench(&planar, &pose, lengths, StaticModel::Catenary).unwrap()
            };
            let slope = motion.reduced(&((at(-h) - at(h)) / (2.0 * h)));
            let exact = motion.reduced(&(stiffness * unit));
            prop_assert!((slope - exact).amax() < 2e-4 * stiffness.amax().max(force), "{slope} {exact}");
        }
        if matches!(rest.stability, Stability::Stable { .. }) {
            let linearisation = Linearisation { cable_model: CableModel::CatenaryDynamic, ..Default::default() };
            if let Ok(dynamics) = Dynamics::about(&planar, &rest, linearisation, 8.0) {
                let found = modes::below(&dynamics, 8.0);
                prop_assert_eq!(found.modes.len(), found.count_below);
                for mode in &found.modes {
                    let shape = Vec6::from(mode.shape);
                    prop_assert!((motion.allowed(&shape) - shape).amax() < 1e-12 * shape.amax().max(1.0));
                }
            }
        }
    }
}
