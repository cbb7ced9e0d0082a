//! Moves past bodies of many triangles, and what is passed between two known poses. Oracles: dense samples.

use super::*;
use funicular::clearance::{BetweenPlaces, WayBetween};

/// Ball of triangles.
fn mesh_of_ball(radius: f64, rings: u32) -> Solid {
    let at = |i: u32, j: u32| {
        let (polar, around) = (std::f64::consts::PI * f64::from(i) / f64::from(rings), std::f64::consts::TAU);
        let turn = around * f64::from(j % (2 * rings)) / f64::from(2 * rings);
        // All triangles meet in one point at the poles.
        let across = if i == 0 || i == rings { 0.0 } else { polar.sin() };
        Vec3::new(across * turn.cos(), across * turn.sin(), polar.cos()) * radius
    };
    let mut triangles = Vec::new();
    for (i, j) in (0..rings).flat_map(|i| (0..2 * rings).map(move |j| (i, j))) {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        if i + 1 < rings {
            triangles.push([a, b, c]);
        }
        if i > 0 {
            triangles.push([a, c, d]);
        }
    }
    Solid::Mesh(funicular::robot::ClosedMesh::of_triangles(&triangles).unwrap())
}

fn resting(robot: &Robot) -> impl Fn(&Pose) -> Result<Equilibrium, statics::StaticsError> + '_ {
    move |pose| {
        let limits = funicular::robot::TensionLimits { minimum: Some(50.0), maximum: Some(5000.0) };
        let posed = Robot { state: State::Pose(*pose), ..robot.with_tension_limits(limits) };
        statics::solve(&posed, StaticModel::Catenary, None).map(|found| found.equilibrium)
    }
}

#[test]
fn a_move_beside_balls_of_triangles_has_the_least_distances_of_samples() {
    let mut robot = cogiro();
    let ball = |k: u32| {
        let place = Pose::new([-4.0 + 2.0 * f64::from(k), if k.is_multiple_of(2) { 3.4 } else { -3.4 }, 0.8], [0.0; 3]);
        column("ball", place, mesh_of_ball(0.5, 8))
    };
    robot.obstacles = (0..3).map(ball).collect();
    let around = Surroundings::of(&robot);
    let [from, to] = [-4.0, 4.0].map(|x| Pose::new([x, 0.0, 1.3], [0.0; 3]));
    let straight = StraightMove::between(&from, &to);
    let found = around.on_the_way(&straight, resting(&robot)).unwrap();
    for k in 0..=40 {
        let rest = resting(&robot)(&straight.pose(f64::from(k) / 40.0)).unwrap();
        for clearance in around.clearances(&rest, None) {
            let least = found.iter().find(|of| of.least.pair == clearance.pair).unwrap().least;
            assert!(clearance.distance >= least.distance - WAY_TOLERANCE, "{k}: {clearance:?} {least:?}");
        }
    }
    // Distances that are told are those at their places.
    for of in found.iter().filter(|of| of.least.pair.kind() == ClearanceKind::Obstacles) {
        let rest = resting(&robot)(&straight.pose(of.fraction)).unwrap();
        let there = of_pair(&around.clearances(&rest, None), of.least.pair);
        assert!((there.distance - of.least.distance).abs() < 2.0 * BODY_TOLERANCE, "{of:?} {there:?}");
    }
}

/// Between two poses on both sides of a thin plate nothing is near it at either of them, and still the platform and its
/// cables pass it; beside the plate, and with the plate elsewhere, nothing is found.
#[test]
fn a_thin_plate_between_two_poses_is_found_and_one_elsewhere_is_not() {
    let mut robot = cogiro();
    robot.obstacles =
        vec![column("plate", Pose::new([0.3, 0.0, 1.6], [0.0; 3]), Solid::Box { half: Vec3::new(5e-4, 0.4, 0.3) })];
    let [from, to] = [-2.0, 2.0].map(|x| Pose::new([x, 0.0, 1.5], [0.0; 3]));
    let straight = StraightMove::between(&from, &to);
    let look = |robot: &Robot, parts: u32| {
        let around = Surroundings::of(robot);
        let rest = resting(robot);
        let known: Vec<(f64, Equilibrium)> = (0..=parts)
            .map(|k| f64::from(k) / f64::from(parts))
            .map(|place| (place, rest(&straight.pose(place)).unwrap()))
            .collect();
        let known: Vec<(f64, &Equilibrium)> = known.iter().map(|(place, rest)| (*place, rest)).collect();
        let way = |[a, b]: [f64; 2]| WayBetween { translation: 4.0 * (b - a), turn: 0.0 };
        let mut looks = 0;
        let found = around.too_near_between(&known, way, |place| {
            looks += 1;
            rest(&straight.pose(place))
        });
        (found.unwrap(), looks)
    };
    for parts in [1, 3, 20] {
        let (found, _) = look(&robot, parts);
        let BetweenPlaces::TooNear { place, clearance } = found else { panic!("{parts}: {found:?}") };
        // The platform is half a metre wide and reaches the plate before and after 0.575 of the way.
        assert!((place - 0.575).abs() < 0.35 && !clearance.is_kept(), "{parts}: {place} {clearance:?}");
    }

    // Without the plate in the way, few places are looked at, and none when the known ones are near each other.
    robot.obstacles[0].pose = Pose::new([0.3, 0.0, 6.5], [0.0; 3]);
    let (found, looks) = look(&robot, 1);
    assert!(found == BetweenPlaces::Free && looks < 400, "{looks}");
    let (found, fewer) = look(&robot, 100);
    assert!(found == BetweenPlaces::Free && fewer <= looks, "{fewer}");
}

/// A rope without a radius that passes a thin plate between two poses touches it, however few poses are known.
#[test]
fn a_rope_without_a_radius_does_not_pass_a_plate_unseen() {
    let mut robot = cogiro();
    for cable in &mut robot.cables {
        cable.material.dimensions = funicular::robot::RopeDimensions::default();
    }
    let rest = resting(&robot)(&Pose::new([0.0, 0.0, 1.5], [0.0; 3])).unwrap();
    let ends = &rest.cables[0];
    let middle = ends.attachment_w * 0.5 + ends.anchor_w * 0.5;
    // A plate of 2 µm across the way of the rope, farther along x than the rope is at first.
    let place = Pose::new([middle.x + 0.6, middle.y, middle.z], [0.0; 3]);
    robot.obstacles = vec![column("plate", place, Solid::Box { half: Vec3::new(1e-6, 0.2, 0.2) })];
    let around = Surroundings::of(&robot);
    let from = Pose::new([0.0, 0.0, 1.5], [0.0; 3]);
    let to = Pose::new([3.0, 0.0, 1.5], [0.0; 3]);
    let straight = StraightMove::between(&from, &to);
    let [first, last] = [from, to].map(|pose| resting(&robot)(&pose).unwrap());
    let way = |[a, b]: [f64; 2]| WayBetween { translation: 3.0 * (b - a), turn: 0.0 };
    let found = around
        .too_near_between(&[(0.0, &first), (1.0, &last)], way, |place| resting(&robot)(&straight.pose(place)))
        .unwrap();
    assert!(matches!(found, BetweenPlaces::TooNear { .. }), "{found:?}");
}

/// Cylinders in symmetric places, in which libraries miss contacts, overlap by the shortest way out.
#[test]
fn cylinders_in_symmetric_places_have_the_depth_of_the_way_out() {
    let cylinder = |radius: f64, half_length: f64| Solid::Cylinder { radius, half_length };
    let upright = |at: [f64; 3]| Pose::new(at, [0.0; 3]);
    let lying = |at: [f64; 3]| Pose::new(at, [90.0, 0.0, 0.0]);
    let cases = [
        // One of them along y ends at the far side of an upright one.
        (cylinder(0.05, 0.25), lying([0.0, -0.2, -0.1]), cylinder(0.05, 0.5), upright([0.0; 3]), 0.1),
        // Both upright, side by side, one within the other, and one above the other.
        (cylinder(0.2, 0.5), upright([0.3, 0.0, 0.0]), cylinder(0.2, 0.5), upright([0.0; 3]), 0.1),
        (cylinder(0.1, 0.1), upright([0.0; 3]), cylinder(0.3, 2.0), upright([0.0; 3]), 0.4),
        (cylinder(0.2, 0.5), upright([0.0, 0.0, 0.9]), cylinder(0.2, 0.5), upright([0.0; 3]), 0.1),
        // In boxes: through a plate, and in the middle of a cube.
        (
            cylinder(0.05, 1.0),
            upright([0.0; 3]),
            Solid::Box { half: Vec3::new(1.0, 1.0, 0.02) },
            upright([0.0; 3]),
            1.02,
        ),
        (
            cylinder(0.05, 1.0),
            upright([0.98, 0.0, 0.0]),
            Solid::Box { half: Vec3::repeat(1.0) },
            upright([0.0; 3]),
            0.07,
        ),
        (cylinder(0.2, 0.3), lying([0.0; 3]), Solid::Box { half: Vec3::repeat(0.5) }, upright([0.0; 3]), 0.7),
        (Solid::Box { half: Vec3::repeat(0.1) }, upright([0.0; 3]), cylinder(0.1, 0.1), upright([0.0; 3]), 0.2),
    ];
    for (own, place, other, at, expected) in cases {
        let mut robot = without_diameter();
        let pose = Pose::new([0.5, -0.3, 1.5], [0.0; 3]);
        let at = Pose { position_w: at.position_w + pose.position_w, ..at };
        robot.platform.bodies = vec![column("case", place, own.clone())];
        robot.obstacles = vec![column("post", at, other.clone())];
        let (robot, rest) = at_rest(&robot, pose, 100.0);
        let pair = ClearancePair::PlatformAndObstacle { body: 0, obstacle: 0 };
        let found = of_pair(&Surroundings::of(&robot).clearances(&rest, None), pair);
        assert!((found.distance + expected).abs() < 2e-5, "{own:?} {other:?}: {found:?} {expected}");
        let between = found.points_w[0].metric_distance(&found.points_w[1]);
        assert!((between - expected).abs() < 2e-5, "{own:?} {other:?}: {found:?}");
    }
}
