//! Loads that cables within their limits hold at a pose. Oracles: a linear problem per vertex against the facets, the
//! program's own tension distributions just inside and just outside, and random loads inside the required set.

use crate::random::Draw;
use funicular::math::{Vec3, Vec6};
use funicular::robot::{Load, LoadShape, Pose, RequiredPayload, Robot, TensionLimits};
use funicular::statics::{self, LoadCapacity, StaticModel, StaticsError};

fn cogiro() -> Robot {
    Robot::from_toml(funicular_robots::COGIRO).unwrap()
}

fn ipanema() -> Robot {
    let limits = TensionLimits { minimum: Some(100.0), maximum: Some(3000.0) };
    Robot::from_toml(funicular_robots::IPANEMA2).unwrap().with_tension_limits(limits)
}

/// Poses spread over a box, without a pattern (Weyl).
fn poses(count: usize, reach: [f64; 3], middle: [f64; 3]) -> Vec<Pose> {
    let part =
        |k: usize, i: usize| 2.0 * ((k as f64 + 1.0) * (i as f64 + 2.0).sqrt() * std::f64::consts::E).fract() - 1.0;
    let pose = |k: usize| {
        let position = std::array::from_fn(|i| middle[i] + reach[i] * part(k, i));
        Pose::new(position, std::array::from_fn(|i| 10.0 * part(k, i + 3)))
    };
    (0..count).map(pose).collect()
}

fn with_box(mut robot: Robot, force: f64, moment: f64) -> Robot {
    robot.required.force_w = Vec3::repeat(force);
    robot.required.moment_w = Vec3::repeat(moment);
    robot
}

fn load_of(wrench: &Vec6) -> Load {
    Load {
        force_w: wrench.fixed_rows::<3>(0).into_owned(),
        moment_w: wrench.fixed_rows::<3>(3).into_owned(),
        point_p: Vec3::zeros(),
    }
}

/// Robot that bears a multiple of a load, about its origin.
fn bearing(robot: &Robot, wrench: &Vec6, multiple: f64) -> Robot {
    robot.with_load(load_of(&(wrench * multiple)))
}

fn box_vertices(force: f64, moment: f64) -> Vec<Vec6> {
    let sign = |bits: usize, k: usize| if bits & (1 << k) == 0 { -1.0 } else { 1.0 };
    (0..64).map(|bits| Vec6::from_fn(|k, _| sign(bits, k) * if k < 3 { force } else { moment })).collect()
}

#[test]
fn the_load_factor_of_the_facets_is_the_smallest_of_one_linear_problem_per_vertex() {
    let robots = [
        (with_box(cogiro(), 150.0, 30.0), [3.0, 2.0, 1.0], [0.0, 0.0, 1.5], 12),
        (with_box(ipanema(), 200.0, 40.0), [2.0, 1.5, 0.8], [0.0, 0.0, 1.0], 12),
    ];
    let mut held = 0;
    for (robot, reach, middle, count) in robots {
        let (force, moment) = (robot.required.force_w.x, robot.required.moment_w.x);
        for pose in poses(count, reach, middle) {
            let capacity = LoadCapacity::at(&robot, &pose, StaticModel::Ideal, None).unwrap();
            let Ok(factor) = capacity.load_factor_value() else {
                assert!(capacity.margin().unwrap() < 0.0);
                continue;
            };
            held += 1;
            let single = |vertex: &Vec6| {
                let mut robot = robot.clone();
                robot.required =
                    funicular::robot::RequiredLoads { listed: vec![load_of(vertex)], ..Default::default() };
                let capacity = LoadCapacity::at(&robot, &pose, StaticModel::Ideal, None).unwrap();
                capacity.load_factor().unwrap().value
            };
            let least = box_vertices(force, moment).iter().map(single).fold(f64::INFINITY, f64::min);
            // Rounding of a linear problem with tensions of some hundred newtons.
            assert!((factor - least).abs() < 1e-12 * (1.0 + least), "{factor} {least}");
            assert_eq!(factor >= 1.0, capacity.margin().unwrap() >= 0.0);

            // An input that is off by one per cent shows.
            let other = with_box(robot.clone(), 1.01 * force, 1.01 * moment);
            let other = LoadCapacity::at(&other, &pose, StaticModel::Ideal, None).unwrap().load_factor_value().unwrap();
            assert!((1.01 * other - factor).abs() < 1e-11 * (1.0 + factor), "{other} {factor}");
        }
    }
    assert!(held >= 12, "{held}");
}

#[test]
fn with_sag_the_binding_load_is_held_just_inside_the_load_factor_and_refused_just_outside() {
    let heavy = {
        let mut robot = cogiro().with_tension_limits(TensionLimits { minimum: Some(60.0), maximum: None });
        robot.cables.iter_mut().for_each(|cable| cable.material.mass_per_length = 0.6);
        with_box(robot, 100.0, 20.0)
    };
    let robots = [
        (with_box(cogiro(), 150.0, 30.0), [2.0, 1.5, 0.5], [0.0, 0.0, 1.5]),
        (with_box(ipanema(), 200.0, 40.0), [2.0, 1.0, 0.5], [0.0, 0.0, 1.0]),
        (heavy, [2.0, 1.0, 0.5], [0.0, 0.0, 1.5]),
    ];
    let mut held = 0;
    for (robot, reach, middle) in robots {
        for pose in poses(4, reach, middle) {
            let capacity = LoadCapacity::at(&robot, &pose, StaticModel::Catenary, None).unwrap();
            let Ok(factor) = capacity.load_factor() else { continue };
            held += 1;
            assert!(factor.residual < statics::RESIDUAL_LIMIT && factor.upper_bound >= factor.value);
            let lower = factor.lower_bound.unwrap();
            assert!(lower <= factor.value && lower > 0.9 * factor.value, "{lower} {}", factor.value);
            let solve = |multiple: f64| {
                statics::inverse(&bearing(&robot, &factor.load, multiple), &pose, StaticModel::Catenary)
            };
            assert!(solve(0.999_999 * factor.value).is_ok(), "{}", factor.value);
            if factor.upper_bound < (1.0 + 1e-7) * factor.value {
                assert!(matches!(
                    solve(1.000_001 * factor.value),
                    Err(StaticsError::BeyondLimits(_) | StaticsError::NotFoundWithinLimits { .. })
                ));
            }
        }
    }
    assert!(held >= 6, "{held}");
}

/// Suspended robot with six sagging cables, as many as degrees of freedom, drawn at random.
fn random_with_six_cables(draw: &mut Draw) -> Robot {
    let mut text = format!(
        "name = \"six\"\n[platform]\nmass_kg = {}\ninertia_kg_m2 = [1.0, 1.0, 1.0]\n[materials.rope]\n\
         axial_stiffness_n = {}\nmass_kg_per_m = {}\nminimum_tension_n = {}\nmaximum_tension_n = {}\n",
        draw.between(40.0, 90.0),
        draw.between(2e4, 1e5),
        draw.between(0.3, 2.5),
        draw.between(0.5, 12.0),
        draw.between(500.0, 1500.0),
    );
    for k in 0..6 {
        let (around, out) = (f64::from(k) * 1.05 + draw.between(-0.3, 0.3), draw.between(1.5, 2.5));
        let on_platform = around + if k % 2 == 0 { 0.9 } else { -0.9 };
        let cable = format!(
            "[[cables]]\nname = \"{k}\"\nmaterial = \"rope\"\nanchor_m = [{}, {}, {}]\nattachment_m = [{}, {}, {}]\n",
            out * around.cos(),
            out * around.sin(),
            draw.between(1.8, 2.6),
            0.15 * on_platform.cos(),
            0.15 * on_platform.sin(),
            draw.between(-0.05, 0.08),
        );
        text.push_str(&cable);
    }
    Robot::from_toml(&text).unwrap()
}

/// As many cables as degrees of freedom have the tensions of their equilibrium, however deep the cables hang. The
/// binding load is within the limits just inside the load factor and not just outside, and what is proved is so.
#[test]
fn six_sagging_cables_hold_the_binding_load_just_inside_the_load_factor_and_not_just_outside() {
    let mut draw = Draw(61);
    let (mut checked, mut slacker, mut negative) = (0, 0, 0);
    for _ in 0..120 {
        let mut robot = random_with_six_cables(&mut draw);
        let force = draw.between(5.0, 60.0);
        robot.required.force_w = Vec3::repeat(force);
        robot.required.shape = if draw.between(0.0, 1.0) < 0.5 { LoadShape::Box } else { LoadShape::Ellipsoid };
        let position = [draw.between(-0.3, 0.3), draw.between(-0.3, 0.3), draw.between(0.2, 0.6)];
        let turns = std::array::from_fn(|_| draw.between(-20.0, 20.0));
        let pose = Pose::new(position, turns);
        let capacity = LoadCapacity::at(&robot, &pose, StaticModel::Catenary, None).unwrap();
        let held = |multiple: f64, load: &Vec6| {
            let loaded = bearing(&robot, load, multiple);
            let rest = statics::inverse(&loaded, &pose, StaticModel::Catenary);
            rest.is_ok_and(|rest| {
                let margin = |(i, cable): (usize, &statics::CableState)| {
                    statics::TensionRange::of(&loaded, i, &cable.chord_w()).margin(cable).distance()
                };
                rest.cables.iter().enumerate().map(margin).fold(f64::INFINITY, f64::min) >= 0.0
            })
        };

        // The margin has the sign of the verdict.
        let margin = capacity.margin();
        let Ok(factor) = capacity.load_factor() else {
            assert!(margin.is_none_or(|margin| margin < 0.0), "{margin:?}");
            negative += 1;
            continue;
        };
        assert!(margin.is_none_or(|margin| (margin >= 0.0) == (factor.value >= 1.0)), "{margin:?} {}", factor.value);
        if factor.value.is_infinite() || factor.value < 1e-3 {
            continue;
        }
        checked += 1;
        slacker += usize::from(capacity.counts_slacker_cables(&factor));
        assert!(held(0.9999 * factor.value, &factor.load), "{}", factor.value);
        assert!(!held(1.0001 * factor.value, &factor.load), "{}", factor.value);
        for beyond in [1.0, 1.001, 1.1, 1.5, 2.0] {
            let proved = beyond * factor.upper_bound * (1.0 + 1e-6);
            assert!(proved.is_infinite() || !held(proved, &factor.load), "{} {proved}", factor.value);
        }
        // No required load beats the one that binds.
        for _ in 0..10 {
            let side = Vec3::from_fn(|_, _| draw.between(-1.0, 1.0));
            let side = if robot.required.shape == LoadShape::Box { side } else { side.normalize() };
            let load = Vec6::from_iterator((side * force).iter().copied().chain([0.0; 3]));
            assert!(held(0.99 * factor.value, &load), "{} {side:?}", factor.value);
        }
    }
    assert!(checked >= 20 && slacker >= 3 && negative >= 3, "{checked} {slacker} {negative}");
}

#[test]
fn required_loads_that_the_platform_does_not_feel_are_held_without_limit() {
    let mut robot = Robot::from_toml(funicular_robots::KNTU_PLANAR).unwrap();
    robot.required.payload = RequiredPayload { max_mass: 5.0, ..RequiredPayload::default() };
    let center = Pose::new([0.0; 3], [0.0; 3]);
    let capacity = LoadCapacity::at(&robot, &center, StaticModel::Catenary, None).unwrap();
    let factor = capacity.load_factor().unwrap();
    assert!(factor.value.is_infinite() && factor.load == Vec6::zeros() && factor.cables.is_empty());
}

#[test]
fn the_load_factor_of_light_ropes_tends_to_that_of_straight_ones() {
    let pose = Pose::new([0.5, -0.4, 1.4], [2.0, -3.0, 5.0]);
    let factor = |mass_per_length: f64, model| {
        let mut robot = with_box(cogiro(), 150.0, 30.0);
        robot.cables.iter_mut().for_each(|cable| cable.material.mass_per_length = mass_per_length);
        LoadCapacity::at(&robot, &pose, model, None).unwrap().load_factor().unwrap().value
    };
    let straight = factor(0.0, StaticModel::Ideal);
    // Elastic ropes without weight are straight.
    assert!((factor(0.0, StaticModel::Catenary) / straight - 1.0).abs() < 1e-12);
    let errors = [0.064, 0.0064, 0.00064].map(|mass| (factor(mass, StaticModel::Catenary) - straight).abs());
    assert!(errors[0] > 1e-3 && errors[1] < 0.2 * errors[0] && errors[2] < 0.2 * errors[1], "{errors:?}");
}

#[test]
fn the_margin_is_the_radius_of_the_largest_ball_of_loads_that_can_be_added() {
    let robot = with_box(cogiro(), 50.0, 10.0);
    let pose = Pose::new([0.5, -0.4, 1.4], [2.0, -3.0, 5.0]);
    let margin = LoadCapacity::at(&robot, &pose, StaticModel::Ideal, None).unwrap().margin().unwrap();
    assert!(margin > 1.0, "{margin}");
    let ell = robot.platform_length();
    let scaled = |unit: [f64; 6]| Vec6::from_fn(|k, _| if k < 3 { unit[k] } else { ell * unit[k] });
    let factor = |radius: f64, shape| {
        let mut robot = robot.clone();
        let own = robot.required.clone();
        robot.required = funicular::robot::RequiredLoads { shape, ..Default::default() };
        robot.required.force_w = Vec3::repeat(radius);
        robot.required.moment_w = Vec3::repeat(radius * ell);
        robot.required.listed = box_vertices(own.force_w.x, own.moment_w.x).iter().map(load_of).collect();
        LoadCapacity::at(&robot, &pose, StaticModel::Ideal, None).unwrap().load_factor().unwrap().value
    };
    // Vertices and a ball of this radius are just held together, and a box about the ball is not.
    assert!((factor(margin, LoadShape::Ellipsoid) - 1.0).abs() < 1e-9);
    assert!(factor(margin, LoadShape::Box) < 0.999);
    let unit = scaled([1.0, 0.0, 0.0, 0.0, 0.0, 0.0]) * (0.999 * margin);
    assert!(statics::inverse(&bearing(&robot, &unit, 1.0), &pose, StaticModel::Ideal).is_ok());
}

#[test]
fn no_payload_and_acceleration_inside_their_ranges_is_harder_to_hold_than_the_corners() {
    for angular in [0.0, 0.8] {
        let mut robot = cogiro();
        robot.required.payload = RequiredPayload {
            min_mass: 5.0,
            max_mass: 40.0,
            center_p: Vec3::new(0.0, 0.1, 0.2),
            center_reach_p: Vec3::new(0.1, 0.2, 0.05),
        };
        robot.required.acceleration_w = Vec3::new(0.3, 0.4, 0.5);
        robot.required.angular_acceleration_w = Vec3::repeat(angular);
        let pose = Pose::new([0.3, -0.2, 1.4], [4.0, -3.0, 10.0]);
        let margin = LoadCapacity::at(&robot, &pose, StaticModel::Ideal, None).unwrap().margin().unwrap();

        let mut tightest = f64::INFINITY;
        let mut draw = Draw(20_140_531);
        for _ in 0..60 {
            let mut axis = |middle: &Vec3, half: &Vec3| {
                Vec3::from_fn(|j, _| draw.between(middle[j] - half[j], middle[j] + half[j]))
            };
            let payload = robot.required.payload;
            let center_w = pose.rot_wp * axis(&payload.center_p, &payload.center_reach_p);
            let a_w = axis(&Vec3::zeros(), &robot.required.acceleration_w);
            let alpha_w = axis(&Vec3::zeros(), &robot.required.angular_acceleration_w);
            let mass = draw.between(payload.min_mass, payload.max_mass);

            // Newton and Euler, body by body.
            let own_w = pose.rot_wp * robot.platform.center_of_mass_p;
            let turned = pose.rot_wp.to_rotation_matrix()
                * robot.platform.inertia_p
                * pose.rot_wp.to_rotation_matrix().transpose();
            let payload_w = (robot.gravity_w - a_w - alpha_w.cross(&center_w)) * mass;
            let inertia_w = -(a_w + alpha_w.cross(&own_w)) * robot.platform.mass;
            let force = payload_w + inertia_w;
            let moment = center_w.cross(&payload_w) + own_w.cross(&inertia_w) - turned * alpha_w;
            let mut loaded = robot.clone();
            loaded.required = funicular::robot::RequiredLoads::default();
            loaded.load = Load { force_w: force, moment_w: moment, point_p: Vec3::zeros() };
            tightest =
                tightest.min(LoadCapacity::at(&loaded, &pose, StaticModel::Ideal, None).unwrap().margin().unwrap());
        }
        assert!(tightest >= margin - 1e-9, "{tightest} {margin}");
    }
}

#[test]
fn a_dead_load_beyond_the_limits_has_no_load_factor_and_its_reason_is_given() {
    let robot = with_box(cogiro(), 150.0, 30.0);
    let pose = Pose::new([5.5, 4.0, 1.5], [0.0; 3]);
    let capacity = LoadCapacity::at(&robot, &pose, StaticModel::Catenary, None).unwrap();
    assert!(matches!(capacity.load_factor(), Err(StaticsError::BeyondLimits(_))));
    assert!(
        capacity.dead_load().is_err() && capacity.margin().unwrap() < 0.0 && capacity.largest_acceleration().is_none()
    );
    let nothing = cogiro();
    let capacity =
        LoadCapacity::at(&nothing, &Pose::new([0.0, 0.0, 1.5], [0.0; 3]), StaticModel::Catenary, None).unwrap();
    assert_eq!(capacity.load_factor(), Err(StaticsError::NothingRequired));
    assert!(capacity.requires_nothing() && capacity.margin().unwrap() > 0.0);
}

#[test]
fn all_accelerations_up_to_the_largest_one_are_held_and_one_of_a_larger_one_is_not() {
    let robot = cogiro();
    let pose = Pose::new([0.5, -0.4, 1.4], [2.0, -3.0, 5.0]);
    let most = LoadCapacity::at(&robot, &pose, StaticModel::Ideal, None).unwrap().largest_acceleration().unwrap();
    let ell = robot.platform_length();
    let factor = |accelerations: [f64; 2]| {
        let mut robot = robot.clone();
        robot.required.acceleration_w = Vec3::repeat(accelerations[0]);
        robot.required.angular_acceleration_w = Vec3::repeat(accelerations[1] / ell);
        LoadCapacity::at(&robot, &pose, StaticModel::Ideal, None).unwrap().load_factor().unwrap().value
    };
    // A box inside the ball, and the box about it.
    let half = most / 6.0_f64.sqrt();
    assert!(factor([half, half]) >= 1.0 && factor([most, most]) < 1.0);
}

#[test]
fn closed_form_tensions_are_sufficient_and_balance_the_load() {
    let robot = ipanema();
    let (mut sufficient, mut feasible) = (0, 0);
    for pose in poses(200, [3.0, 2.0, 1.5], [0.0, 0.0, 2.0]) {
        let capacity = LoadCapacity::at(&robot, &pose, StaticModel::Ideal, None).unwrap();
        let is_held = capacity.dead_load().is_ok();
        let margin = statics::closed_form_margin(&robot, &pose).unwrap();
        assert!(margin <= 0.0 || is_held, "{pose:?}: {margin} N");
        sufficient += usize::from(margin > 0.0);
        feasible += usize::from(is_held);
    }
    assert!(0 < sufficient && sufficient < feasible, "{sufficient} of {feasible}");

    // As many cables as degrees of freedom leave no choice: the closed form is the only distribution.
    let mut six = ipanema();
    six.cables.truncate(6);
    for pose in poses(20, [2.0, 1.0, 1.0], [0.0, 0.0, 2.0]) {
        let Some(margin) = statics::closed_form_margin(&six, &pose) else { continue };
        let is_held = LoadCapacity::at(&six, &pose, StaticModel::Ideal, None).unwrap().dead_load().is_ok();
        assert_eq!(margin >= 0.0, is_held, "{pose:?}: {margin} N");
    }
}

#[test]
fn bounds_of_the_load_factor_from_facets_alone_enclose_it() {
    let limited =
        |minimum: f64| cogiro().with_tension_limits(TensionLimits { minimum: Some(minimum), maximum: Some(5000.0) });
    let mut heavy = limited(60.0);
    heavy.cables.iter_mut().for_each(|cable| cable.material.mass_per_length = 0.6);
    let mut loaded = with_box(limited(100.0), 150.0, 30.0);
    loaded.required.payload = RequiredPayload { min_mass: 50.0, max_mass: 80.0, ..RequiredPayload::default() };
    for (robot, widest) in
        [(with_box(limited(100.0), 150.0, 30.0), 1e-2), (with_box(heavy, 100.0, 20.0), 0.5), (loaded, 1e-2)]
    {
        let mut compared = 0;
        for pose in poses(60, [5.0, 3.5, 2.0], [0.0, 0.0, 2.0]) {
            let bounds = statics::load_factor_bounds(&robot, &pose, StaticModel::Catenary).unwrap();
            let [lower, upper] = bounds.expect("the cables span all degrees of freedom");
            let capacity = LoadCapacity::at(&robot, &pose, StaticModel::Catenary, None).unwrap();
            let Ok(value) = capacity.load_factor_value() else {
                assert!(lower <= 0.0, "{pose:?}: the dead load is not held, but {lower} times the loads");
                continue;
            };
            compared += 1;
            assert!(lower <= value + 1e-9 && value <= upper + 1e-9, "{pose:?}: {lower} {value} {upper}");
            assert!(upper - lower < widest, "{pose:?}: {lower} {upper}");
        }
        assert!(compared > 10);
    }
    let nothing = statics::load_factor_bounds(&cogiro(), &poses(1, [1.0; 3], [0.0; 3])[0], StaticModel::Ideal);
    assert!(nothing.unwrap().is_none());
}

/// CoGiRo with ropes and a platform that the wind meets.
fn in_the_open(drag_width: f64) -> Robot {
    let mut robot = with_box(cogiro(), 60.0, 10.0);
    robot.required.wind_speed = 20.0;
    robot.platform.drag_area = 0.5;
    robot.cables.iter_mut().for_each(|cable| cable.material.drag_width = Some(drag_width));
    robot
}

#[test]
fn required_wind_on_the_ropes_is_held_just_inside_the_load_factor_and_refused_just_outside() {
    let robot = in_the_open(0.03);
    for pose in poses(3, [2.0, 1.0, 0.4], [0.0, 0.0, 1.4]) {
        let capacity = LoadCapacity::at(&robot, &pose, StaticModel::Catenary, None).unwrap();
        let factor = capacity.load_factor().unwrap();
        // The steady wind of the file on the ropes; the load that binds has that on the platform.
        let solve = |multiple: f64, velocity_w: Vec3, load: &Vec6| {
            let mut windy = bearing(&robot, load, multiple);
            windy.platform.drag_area = 0.0;
            windy.wind.velocity_w = velocity_w * multiple.sqrt();
            statics::inverse(&windy, &pose, StaticModel::Catenary)
        };
        assert!((factor.wind_w.norm() - 20.0).abs() < 1e-12, "{}", factor.wind_w);
        assert!(solve(0.999_999 * factor.value, factor.wind_w, &factor.load).is_ok(), "{}", factor.value);
        assert!(solve(1.000_01 * factor.value, factor.wind_w, &factor.load).is_err(), "{}", factor.value);

        // Every corner of the box in wind from other directions is held as well.
        let multiple = 0.999_99 * factor.value;
        for k in 0..7 {
            let (sin, cos) = (0.4 + 0.9 * f64::from(k)).sin_cos();
            let velocity_w = Vec3::new(cos, sin, 0.0) * 20.0;
            let pressure = 0.5 * robot.wind.air_density * 20.0 * robot.platform.drag_area;
            let arm_w = pose.rot_wp * robot.platform.center_of_mass_p;
            let (force_w, corner) = (velocity_w * pressure, box_vertices(60.0, 10.0)[(11 * k as usize) % 64]);
            let moment_w = arm_w.cross(&force_w);
            let on_platform = Vec6::new(force_w.x, force_w.y, force_w.z, moment_w.x, moment_w.y, moment_w.z);
            assert!(solve(multiple, velocity_w, &(corner + on_platform)).is_ok(), "{k}");
        }

        // One per cent more drag of the ropes is seen, and thin ropes have the load factor without wind on them.
        let value = |width: f64| {
            let robot = in_the_open(width);
            LoadCapacity::at(&robot, &pose, StaticModel::Catenary, None).unwrap().load_factor_value().unwrap()
        };
        assert!(value(0.0303) < (1.0 - 1e-5) * factor.value, "{} {}", value(0.0303), factor.value);
        let (still, thin) = (value(0.0), value(1e-7));
        assert!((thin / still - 1.0).abs() < 1e-5 && factor.value < still, "{thin} {still}");
        assert!(capacity.margin().unwrap() * (factor.value - 1.0) > 0.0);
    }
}

/// The verdict in wind is on the side of the load factor, for multiples near it and far from it, on both sides.
#[test]
fn the_verdict_in_wind_is_on_the_side_of_the_load_factor() {
    let (mut counts, mut near) = ([0, 0], 0);
    for robot in [in_the_open(0.03), in_the_open(0.15)] {
        for pose in poses(3, [2.5, 1.5, 0.4], [0.0, 0.0, 1.4]) {
            let capacity = LoadCapacity::at(&robot, &pose, StaticModel::Catenary, None).unwrap();
            let verdict =
                |multiple: f64| statics::load_factor_verdict_in_wind(&robot, &pose, StaticModel::Catenary, multiple);
            let Ok(factor) = capacity.load_factor_value() else {
                assert!(!verdict(1.0).is_ok_and(|value| value.is_some_and(|value| value >= 1.0)));
                continue;
            };
            for part in [0.3, 0.9, 0.999, 1.0 - 1e-6, 1.0 + 1e-6, 1.001, 1.1, 2.0] {
                let multiple = part * factor;
                let is_held = verdict(multiple).is_ok_and(|value| value.unwrap() >= multiple);
                assert_eq!(is_held, part < 1.0, "{part} of {factor}");
                counts[usize::from(is_held)] += 1;
            }
            // At the load factor itself, the verdict is the load factor.
            if let Ok(Some(value)) = verdict(factor) {
                assert!((value / factor - 1.0).abs() < 1e-3, "{value} {factor}");
                near += 1;
            }
        }
    }
    assert!(counts.iter().all(|count| *count > 8) && near > 2, "{counts:?} {near}");
    let calm = statics::load_factor_verdict_in_wind(
        &in_the_open(0.0),
        &Pose::new([0.0, 0.0, 1.4], [0.0; 3]),
        StaticModel::Catenary,
        1.0,
    );
    assert_eq!(calm.unwrap(), None);
}
