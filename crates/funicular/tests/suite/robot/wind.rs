//! Loads along the cables: weight replaced by an equal load, wind, and their effect on stiffness and vibration.

use funicular::cable::{CableModel, Sag};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Mat6, Vec3, Vec6};
use funicular::modes;
use funicular::robot::{Pose, Robot, State, Wind};
use funicular::statics::{self, Equilibrium, StaticModel, TensionRule};

const YUAN: &str = funicular_robots::YUAN2014_4MM;
const COGIRO: &str = funicular_robots::COGIRO;

/// Robot of the paper with a rope that has drag and a platform of a third of a square metre.
fn in_wind(velocity_w: Vec3) -> Robot {
    let text = YUAN
        .replace("damping_ratio = 0.003", "damping_ratio = 0.003\ndrag_coefficient = 1.2")
        .replace("center_of_mass_m", "drag_area_m2 = 0.3\ncenter_of_mass_m");
    let robot = Robot::from_toml(&text).unwrap();
    assert!((robot.cables[0].material.drag_width.unwrap() - 1.2 * 0.004).abs() < 1e-18);
    assert!((robot.platform.drag_area - 0.3).abs() < 1e-18);
    let air_density = robot.wind.air_density;
    robot.with_wind(Wind { velocity_w, air_density })
}

fn lengths(robot: &Robot) -> Vec<f64> {
    let State::Lengths(lengths) = &robot.state else { panic!("given by lengths") };
    lengths.clone()
}

fn frequencies(robot: &Robot, rest: &Equilibrium, cable_model: CableModel, below_hz: f64) -> Vec<f64> {
    let linearisation = Linearisation { cable_model, ..Default::default() };
    let found = modes::below(&Dynamics::about(robot, rest, linearisation, below_hz).unwrap(), below_hz);
    assert!(found.certified);
    found.modes.iter().map(|mode| mode.frequency_hz).collect()
}

/// The complete robot is rotated: gravity down becomes gravity sideways, and then a cable load sideways without
/// gravity. The dynamics must agree to the last digits, since only q counts (theory, section 2).
#[test]
fn a_load_along_the_cables_is_weight_by_another_name() {
    let robot = Robot::from_toml(YUAN).unwrap();
    let g = robot.gravity_w;
    let mut loaded = robot.with_cable_load(g * robot.cables[0].material.mass_per_length);
    loaded.gravity_w = Vec3::zeros();
    loaded.load.force_w = g * robot.platform.mass;
    loaded.load.point_p = robot.platform.center_of_mass_p;
    let lengths = lengths(&robot);
    let [a, b] = [&robot, &loaded].map(|r| statics::forward(r, &lengths, StaticModel::Catenary, None).unwrap());
    assert!(statics::pose_distance(&robot, &a.pose, &b.pose) < 1e-10);
    for (i, (x, y)) in a.cables.iter().zip(&b.cables).enumerate() {
        assert!((x.tension_anchor - y.tension_anchor).abs() < 1e-8);
        let (x, y) = (Sag::of(&robot, i, x), Sag::of(&loaded, i, y));
        assert!((x.lambda2 / y.lambda2 - 1.0).abs() < 1e-8 && x.ratio() > 0.0);
    }
    for model in [CableModel::ShallowDynamic, CableModel::CatenaryDynamic] {
        let [x, y] = [(&robot, &a), (&loaded, &b)].map(|(robot, rest)| frequencies(robot, rest, model, 8.0));
        assert_eq!(x.len(), y.len());
        assert!(x.iter().zip(&y).all(|(x, y)| (x / y - 1.0).abs() < 1e-8), "{model}");
    }
}

/// Independent balance of the sum of all forces on robot and cables: the anchors carry weight, wind on the platform and
/// drag, and nothing else. (The catenary is finite already, so no chain of bars is needed.)
#[test]
fn the_anchors_carry_weight_and_drag() {
    let velocity = Vec3::new(9.0, 4.0, -1.0);
    let robot = in_wind(velocity);
    let rest = statics::forward(&robot, &lengths(&robot), StaticModel::Catenary, None).unwrap();
    let pressure = |u: Vec3| u * (0.5 * 1.225 * u.norm());
    let mut outside = robot.gravity_w * robot.platform.mass + pressure(velocity) * 0.3;
    let mut held = Vec3::zeros();
    for (cable, state) in robot.cables.iter().zip(&rest.cables) {
        let e = state.chord_w().normalize();
        let drag = pressure(velocity - e * e.dot(&velocity)) * (1.2 * 0.004);
        let per_metre = robot.gravity_w * cable.material.mass_per_length + drag;
        outside += per_metre * state.unstrained_length;
        // End force of the curve at the anchor, from its horizontal and vertical parts.
        let hanging = state.hanging.as_ref().unwrap();
        let (along, up) = hanging.axes_w();
        held -= along * -hanging.catenary.horizontal_force() - up * hanging.catenary.vertical_force_at_end();
        assert!((up + per_metre.normalize()).norm() < 1e-14, "up is against the whole load");
    }
    assert!((outside + held).norm() < 1e-8 * outside.norm(), "{outside} {held}");
    // A wind of 9.9 m/s pushes the platform with 18 N. It has 10 kg and hangs from cables 5 m long: it moves with the
    // wind.
    let calm = in_wind(Vec3::zeros());
    let still = statics::forward(&calm, &lengths(&calm), StaticModel::Catenary, None).unwrap();
    let moved = rest.pose.position_w - still.pose.position_w;
    assert!(moved.dot(&velocity) > 0.0 && moved.norm() > 1e-3, "{moved}");
}

#[test]
fn inverse_statics_in_wind_is_the_way_back() {
    let robot = in_wind(Vec3::new(0.0, 6.0, 0.0));
    let pose = Pose::new([0.3, -0.1, 0.6], [1.0, -2.0, 3.0]);
    let held = statics::inverse(&robot, &pose, StaticModel::Catenary).unwrap();
    let lengths: Vec<f64> = held.cables.iter().map(|cable| cable.unstrained_length).collect();
    let back = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
    assert!(statics::pose_distance(&robot, &back.pose, &pose) < 1e-8);
    assert!(back.residual <= statics::RESIDUAL_LIMIT);

    let text = COGIRO.replacen("mass_kg_per_m", "drag_coefficient = 1.1\ndrag_diameter_m = 0.004\nmass_kg_per_m", 1);
    let wind = Wind { velocity_w: Vec3::new(12.0, 0.0, 0.0), ..Wind::default() };
    let robot = Robot::from_toml(&text).unwrap().with_wind(wind);
    let pose = Pose::new([1.0, -2.0, 1.5], [0.0, 0.0, 5.0]);
    let held = statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, &TensionRule::Lowest).unwrap();
    let still = statics::distribute_tensions(
        &Robot::from_toml(COGIRO).unwrap(),
        &pose,
        StaticModel::Catenary,
        &TensionRule::Lowest,
    );
    assert!((held.cables[0].tension_platform - still.unwrap().cables[0].tension_platform).abs() > 0.1);
    let lengths: Vec<f64> = held.cables.iter().map(|cable| cable.unstrained_length).collect();
    let back = statics::forward(&robot, &lengths, StaticModel::Catenary, Some(&pose)).unwrap();
    assert!(statics::pose_distance(&robot, &back.pose, &pose) < 1e-8);
}

/// The tangent belongs to loads that keep their direction. With the loads held at one pose it must be minus the
/// derivative of the wrench.
#[test]
fn the_stiffness_in_wind_is_symmetric_and_that_of_dead_loads() {
    let robot = in_wind(Vec3::new(15.0, -5.0, 2.0));
    let lengths = lengths(&robot);
    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
    let stiffness = statics::tangent_stiffness(&robot, &rest).unwrap();
    assert!((stiffness - stiffness.transpose()).amax() < 1e-9 * stiffness.amax());
    // Equal loads given as dead loads, and still air apart from the force on the platform.
    let mut dead = robot.with_wind(Wind::default());
    for (i, state) in rest.cables.iter().enumerate() {
        dead.cables[i].load_per_length_w = robot.line_load(i, &state.chord_w()).vector_w()
            - robot.gravity_w * robot.cables[i].material.mass_per_length;
    }
    dead.load.force_w = robot.force_at_mass_centre_w() - robot.gravity_w * robot.platform.mass;
    dead.load.point_p = robot.platform.center_of_mass_p;
    let again = statics::forward(&dead, &lengths, StaticModel::Catenary, Some(&rest.pose)).unwrap();
    assert!(statics::pose_distance(&robot, &again.pose, &rest.pose) < 1e-9);
    // Sag curves the wrench within millimetres; a larger step leaves its square.
    let step = 1e-6;
    let by = |k: usize| {
        let wrench = |sign: f64| {
            let displacement = Vec6::ith(k, sign * step);
            let pose =
                rest.pose.moved(&displacement.fixed_rows::<3>(0).into(), &displacement.fixed_rows::<3>(3).into());
            statics::wrench(&dead, &pose, &lengths, StaticModel::Catenary).unwrap()
        };
        (wrench(-1.0) - wrench(1.0)) / (2.0 * step)
    };
    let differences = Mat6::from_columns(&std::array::from_fn::<_, 6, _>(by));
    // At an equilibrium the moment about the moved origin differs from the tangent's by the residual only.
    assert!((differences - stiffness).amax() < 1e-6 * stiffness.amax(), "{}", differences - stiffness);
}

#[test]
fn a_wind_along_a_cable_does_not_pull_at_it_and_drag_grows_with_the_square() {
    let wind = Wind { velocity_w: Vec3::new(10.0, 0.0, 0.0), ..Wind::default() };
    assert_eq!(wind.cross_pressure_w(&Vec3::x()), Vec3::zeros());
    // ½ 1.225 100 N/m²; at 45° half of it, normal to the cable.
    assert!((wind.cross_pressure_w(&Vec3::y()) - Vec3::x() * 61.25).norm() < 1e-12);
    let slanted = wind.cross_pressure_w(&Vec3::new(1.0, 0.0, 1.0).normalize());
    assert!((slanted.norm() - 30.625).abs() < 1e-12 && (slanted.x + slanted.z).abs() < 1e-12);
    let robot = in_wind(Vec3::new(10.0, 0.0, 0.0));
    let chord = Vec3::new(0.0, 4.0, 0.0);
    let load = robot.line_load(0, &chord);
    let expected = Vec3::new(61.25 * 1.2 * 0.004, 0.0, -9.81 * 0.067);
    assert!((load.vector_w() - expected).norm() < 1e-14);
}

#[test]
fn a_massless_rope_in_wind_bows_with_it() {
    let text = YUAN.replace("mass_kg_per_m = 0.067", "mass_kg_per_m = 0\ndrag_coefficient = 1.2");
    let robot =
        Robot::from_toml(&text).unwrap().with_wind(Wind { velocity_w: Vec3::new(0.0, 10.0, 0.0), ..Wind::default() });
    let rest = statics::forward(&robot, &lengths(&robot), StaticModel::Catenary, None).unwrap();
    let state = &rest.cables[0];
    let hanging = state.hanging.as_ref().unwrap();
    let middle = hanging.point_w(0.5 * state.unstrained_length) - (state.attachment_w + state.anchor_w) * 0.5;
    let e = state.chord_w().normalize();
    let across = (Vec3::y() - e * e.y).normalize();
    assert!(middle.dot(&across) > 0.0 && middle.cross(&across).norm() < 0.05 * middle.norm(), "{middle}");
    // The cable has no vibrations of its own here, but the platform has six on its bowed ropes.
    assert_eq!(frequencies(&robot, &rest, CableModel::CatenaryDynamic, 200.0).len(), 6);
}

/// With ends and length held, the force is a function of the load alone: its derivative compared with central
/// differences of fourth order, in slack, taut, steep and nearly massless cables.
#[test]
fn the_end_force_follows_the_load_as_its_derivative_says() {
    use funicular::catenary::{Rope, space::HangingCable};
    let start = Vec3::new(0.3, -0.2, 0.1);
    let load = Vec3::new(0.11, -0.07, -0.63);
    for (end, unstrained_length) in [
        (Vec3::new(6.0, 1.0, 4.0), 7.1),
        (Vec3::new(6.0, 1.0, 4.0), 7.05),
        (Vec3::new(6.0, 1.0, -4.0), 7.5),
        (Vec3::new(-3.0, 5.0, 0.1), 9.0),
        (Vec3::new(0.5, -0.3, 8.0), 14.0),
        (start + load * 9.0, 5.7),
    ] {
        let hang = |q: Vec3| {
            let rope = Rope { unstrained_length, weight_per_length: q.norm(), axial_stiffness: 8e4 };
            HangingCable::new(start, end, -q, rope).unwrap()
        };
        let derivative = hang(load).force_by_load_w();
        let step = 1e-3;
        let differences = funicular::math::Mat3::from_columns(&std::array::from_fn::<_, 3, _>(|k| {
            let at = |n: f64| hang(load + Vec3::ith(k, n * step)).force_on_start_w();
            ((at(1.0) - at(-1.0)) * 8.0 - (at(2.0) - at(-2.0))) / (12.0 * step)
        }));
        // The fourth order leaves (step/load)⁴ = 6e-12; the chord is rounded by some epsilons, which EA turns into a
        // force.
        let tolerance = 1e-8 * derivative.amax() + 20.0 * f64::EPSILON * 8e4 / step;
        let error = (derivative - differences).amax();
        assert!(error < tolerance, "{end} {error:e} {tolerance:e} {derivative} {differences}");
    }
}

/// Minus the derivative of the total wrench with respect to the pose at held lengths, with the drag of every pose, by
/// central differences of fourth order; in the platform's coordinates.
fn by_differences(robot: &Robot, rest: &Equilibrium, step: f64) -> Mat6 {
    let lengths: Vec<f64> = rest.cables.iter().map(|cable| cable.unstrained_length).collect();
    let motion = &robot.platform.motion;
    let by = |k: usize| {
        if k >= motion.count() {
            return Vec6::zeros();
        }
        let wrench = |n: f64| {
            let displacement = motion.expanded(&Vec6::ith(k, n * step));
            let pose =
                rest.pose.moved(&displacement.fixed_rows::<3>(0).into(), &displacement.fixed_rows::<3>(3).into());
            motion.reduced(&statics::wrench(robot, &pose, &lengths, rest.model).unwrap())
        };
        ((wrench(-1.0) - wrench(1.0)) * 8.0 - (wrench(-2.0) - wrench(2.0))) / (12.0 * step)
    };
    motion.expanded_matrix(&Mat6::from_columns(&std::array::from_fn::<_, 6, _>(by)))
}

/// Text of a robot whose ropes have drag: a drag coefficient after every line that gives a rope's mass.
fn with_drag(text: &str) -> Robot {
    let lines = text.lines().flat_map(|line| {
        let drag = line.starts_with("mass_kg_per_m").then_some("drag_coefficient = 1.2\ndrag_diameter_m = 0.008");
        [Some(line), drag].into_iter().flatten()
    });
    Robot::from_toml(&lines.collect::<Vec<_>>().join("\n")).unwrap()
}

/// Robots of the library and one of them with long slack ropes, as a rigid body, a point mass and in a plane, each in
/// three winds: the tangent with the turning drag is the derivative of the wrench, the tangent with held drag is not.
#[test]
fn the_tangent_with_drag_is_the_derivative_of_the_wrench() {
    let velocities = [Vec3::new(15.0, -5.0, 2.0), Vec3::new(0.0, 25.0, 0.0), Vec3::new(-8.0, 8.0, -3.0)];
    let mut off: f64 = 0.0;
    for (name, robot, lengthened) in windy_robots() {
        for velocity_w in velocities {
            let robot = robot.with_wind(Wind { velocity_w, ..Wind::default() });
            let first = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
            let lengths: Vec<f64> = first.cables.iter().map(|c| c.unstrained_length * lengthened).collect();
            let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, Some(&first.pose)).unwrap();
            let whole = statics::tangent_with_drag(&robot, &rest).unwrap();
            let held = statics::tangent_stiffness(&robot, &rest).unwrap();
            let differences = by_differences(&robot, &rest, 1e-5);
            let scale = whole.amax();
            let error = (whole - differences).amax() / scale;
            // Errors of the differences: the fourth order of the step over some centimetres of sag, and rounding over
            // the step. The residual of 1e-10 leaves less in the lever terms.
            assert!(error < 2e-7, "{name} {velocity_w}: {error:e} {}", whole - differences);
            let missed = (held - differences).amax() / scale;
            assert!(missed > 10.0 * error, "{name}: the drag's turn is seen, {missed:e} {error:e}");
            off = off.max(missed);
        }
    }
    assert!(off > 0.02, "some robot shows the turn of the drag by per cents: {off}");
}

fn windy_robots() -> Vec<(&'static str, Robot, f64)> {
    let plane = funicular_robots::KNTU_PLANAR;
    let camera = funicular_robots::STADIUM_CAMERA;
    vec![
        ("yuan", with_drag(YUAN), 1.0),
        ("yuan, paid out", with_drag(YUAN), 1.15),
        ("cogiro", with_drag(COGIRO), 1.0),
        ("planar", with_drag(plane), 1.0),
        ("point mass", with_drag(camera), 1.0),
        ("point mass, paid out", with_drag(camera), 1.05),
    ]
}

/// No drag turns without wind, with ropes without drag, or with cables that carry no load along them.
#[test]
fn without_a_drag_that_turns_the_tangent_is_the_symmetric_one_to_the_bit() {
    let still = in_wind(Vec3::zeros());
    let robots = [
        (still.clone(), StaticModel::Catenary),
        (
            Robot::from_toml(YUAN).unwrap().with_wind(Wind { velocity_w: Vec3::x() * 9.0, ..Wind::default() }),
            StaticModel::Catenary,
        ),
        (in_wind(Vec3::x() * 9.0), StaticModel::Spring),
    ];
    for (robot, model) in robots {
        let rest = statics::forward(&robot, &lengths(&robot), model, None).unwrap();
        assert_eq!(statics::tangent_with_drag(&robot, &rest), statics::tangent_stiffness(&robot, &rest));
        assert_eq!((statics::drag_stiffness(&robot, &rest), statics::drag_effect(&robot, &rest)), (None, None));
    }
    let blowing = in_wind(Vec3::x() * 9.0);
    let rest = statics::forward(&blowing, &lengths(&blowing), StaticModel::Catenary, None).unwrap();
    assert_ne!(statics::tangent_with_drag(&blowing, &rest), statics::tangent_stiffness(&blowing, &rest));
}

/// The number in the warning bounds the change of every displacement, is reached for some load, and grows with the
/// wind; the warning appears above one per cent and not below.
#[test]
fn the_effect_of_the_turning_drag_bounds_displacements_and_is_warned_of_from_one_per_cent() {
    use funicular::warnings::{self, Warning};
    let (mut seen, mut unseen) = (0, 0);
    for (name, robot, _) in windy_robots() {
        let mut last = 0.0;
        for speed in [0.5, 5.0, 25.0] {
            let robot = robot.with_wind(Wind { velocity_w: Vec3::new(0.6, 0.8, 0.0) * speed, ..Wind::default() });
            let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
            let effect = statics::drag_effect(&robot, &rest).unwrap();
            assert!(effect > last, "{name} {speed}: {effect} {last}");
            last = effect;
            let warned = warnings::of_dynamics(&robot, &rest, CableModel::CatenaryDynamic, 1.0)
                .contains(&Warning::DragTurns { effect });
            assert_eq!(warned, effect > warnings::DRAG_TURN_LIMIT, "{name} {speed}: {effect}");
            *(if warned { &mut seen } else { &mut unseen }) += 1;

            // Displacements under unit loads, computed in both ways; the unit diagonal stands for motions that the
            // platform does not have.
            let (n, ell) = (robot.platform.motion.count(), robot.platform_length());
            let [held, whole] = [statics::tangent_stiffness(&robot, &rest), statics::tangent_with_drag(&robot, &rest)]
                .map(|k| robot.platform.motion.reduced_matrix(&k.unwrap()))
                .map(|mut k| {
                    (n..6).for_each(|i| k[(i, i)] = 1.0);
                    k.try_inverse().unwrap()
                });
            let size = |x: Vec6| {
                let turns = |k: usize| robot.platform.motion.is_rotation(k);
                Vec6::from_fn(|k, _| if turns(k) { ell * x[k] } else { x[k] }).norm()
            };
            for k in 0..n {
                let load = Vec6::ith(k, 1.0);
                let change = size((whole - held) * load) / size(held * load);
                assert!(change <= effect * (1.0 + 1e-6), "{name} {speed} {k}: {change} {effect}");
            }
        }
    }
    assert!(seen > 0 && unseen > 0, "{seen} {unseen}");
}
