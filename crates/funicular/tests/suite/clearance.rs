//! Distances between cables, platform and obstacles. Oracles: dense samples of the curves, closed forms, one shape as
//! another, and the symmetry of hall and robot.

mod between;

use crate::random::Draw;
use funicular::clearance::{
    BODY_TOLERANCE, Clearance, ClearanceKind, ClearancePair, Surroundings, TOLERANCE, WAY_TOLERANCE, straight_crossings,
};
use funicular::math::Vec3;
use funicular::path::StraightMove;
use funicular::robot::{Body, Pose, RequiredClearance, Robot, Solid, State};
use funicular::statics::{self, CableState, Equilibrium, StaticModel};

fn cogiro() -> Robot {
    Robot::from_toml(funicular_robots::COGIRO).unwrap()
}

/// Robot at a pose with tensions by the rule `lowest`, from a minimum tension [N].
fn at_rest(robot: &Robot, pose: Pose, minimum: f64) -> (Robot, Equilibrium) {
    let limits = funicular::robot::TensionLimits { minimum: Some(minimum), maximum: Some(5000.0) };
    let posed = Robot { state: State::Pose(pose), ..robot.with_tension_limits(limits) };
    let rest = statics::solve(&posed, StaticModel::Catenary, None).unwrap().equilibrium;
    (posed, rest)
}

fn poses(draw: &mut Draw, count: usize) -> Vec<Pose> {
    let mut within = |reach: f64, middle: f64| middle + reach * draw.between(-1.0, 1.0);
    (0..count)
        .map(|_| {
            let position = [within(4.0, 0.0), within(3.0, 0.0), within(1.0, 1.8)];
            Pose::new(position, [within(5.0, 0.0), within(5.0, 0.0), within(15.0, 0.0)])
        })
        .collect()
}

/// Points of a cable at equal distances.
fn sampled(cable: &CableState, count: usize) -> Vec<Vec3> {
    let hanging = cable.hanging.as_ref().unwrap();
    let length = hanging.catenary.rope().unstrained_length;
    (0..=count).map(|k| hanging.point_w(length * k as f64 / count as f64)).collect()
}

fn of_pair(all: &[Clearance], pair: ClearancePair) -> Clearance {
    *all.iter().find(|of| of.pair == pair).unwrap()
}

fn without_ends(mut robot: Robot) -> Robot {
    robot.clearance = Some(RequiredClearance { from_end: Some(0.0), ..RequiredClearance::default() });
    robot
}

#[test]
fn no_sampled_points_of_two_cables_are_nearer_than_their_distance() {
    let robot = without_ends(cogiro());
    let mut draw = Draw(42);
    for minimum in [4.0, 100.0] {
        for pose in poses(&mut draw, 4) {
            let (robot, rest) = at_rest(&robot, pose, minimum);
            let found = Surroundings::of(&robot).clearances(&rest, None);
            let points: Vec<Vec<Vec3>> = rest.cables.iter().map(|cable| sampled(cable, 1500)).collect();
            for (i, j) in (0..8).flat_map(|i| (i + 1..8).map(move |j| (i, j))) {
                let radii = robot.cables[i].radius() + robot.cables[j].radius();
                let distance = of_pair(&found, ClearancePair::Cables(i, j)).distance + radii;
                let apart = |p: &Vec3| points[j].iter().map(|q| (p - q).norm_squared()).fold(f64::INFINITY, f64::min);
                let sampled = points[i].iter().map(apart).fold(f64::INFINITY, f64::min).sqrt();
                // The nearest samples are half a step away along both cables: across, that is of second order.
                let step = rest.cables[i].chord().max(rest.cables[j].chord()) / 1500.0;
                let coarse = step * step / distance + 1e-9;
                assert!(distance <= sampled + TOLERANCE, "{i} {j}: {distance} {sampled}");
                assert!(distance >= sampled - coarse, "{i} {j}: {distance} {sampled}");
            }
        }
    }
}

/// Lines through many points of the cables are as far apart as the cables, and the few nodes of a simulation nearly so.
#[test]
fn lines_through_points_of_the_cables_have_their_least_margin() {
    const FROM_END: f64 = 0.05;
    let mut robot = cogiro();
    robot.clearance = Some(RequiredClearance { from_end: Some(FROM_END), ..RequiredClearance::default() });
    robot.obstacles.push(column(
        "column",
        Pose::new([3.0, 1.0, 1.0], [0.0; 3]),
        Solid::Box { half: Vec3::new(0.2, 0.3, 1.0) },
    ));
    let mut draw = Draw(17);
    for minimum in [4.0, 100.0] {
        for pose in poses(&mut draw, 4) {
            let (robot, rest) = at_rest(&robot, pose, minimum);
            let around = Surroundings::of(&robot);
            let exact = around.least(&rest, None).unwrap();
            for count in [24, 1500] {
                let points: Vec<Vec<Vec3>> = rest.cables.iter().map(|cable| sampled(cable, count)).collect();
                let found = around.least_through(&rest.pose, &points).unwrap();
                // A line leaves a curve by an eighth of the square of its step times the curvature w/H.
                let coarse = |cable: &CableState| {
                    let catenary = &cable.hanging.as_ref().unwrap().catenary;
                    let step = catenary.rope().unstrained_length / count as f64;
                    step * step / 8.0 * catenary.rope().weight_per_length / catenary.horizontal_force()
                };
                // The end that is left out is measured along the stretched line.
                let strain = |cable: &CableState| {
                    cable.tension_anchor / cable.hanging.as_ref().unwrap().catenary.rope().axial_stiffness
                };
                let cut = FROM_END * rest.cables.iter().map(strain).fold(0.0, f64::max);
                let bound = cut + 2.0 * rest.cables.iter().map(coarse).fold(0.0, f64::max) + BODY_TOLERANCE;
                assert!((found.margin() - exact.margin()).abs() <= bound, "{count}: {found:?} {exact:?}, {bound}");
            }
        }
    }
    let none = vec![Vec::new(); robot.cables.len()];
    let alone = Surroundings::of(&robot).least_through(&Pose::new([0.0, 0.0, 1.5], [0.0; 3]), &none).unwrap();
    assert!(matches!(alone.pair, ClearancePair::PlatformAndObstacle { .. }));
}

#[test]
fn two_ropes_in_one_vertical_plane_cross_where_a_sag_passes_a_chord() {
    // A slack rope between two points at 3 m and a tight one below its ends, in the same plane: the slack one sags
    // through it twice, so the distance is zero although the chords are 0.2 m apart.
    let (robot, mut rest) = at_rest(&without_ends(cogiro()), Pose::new([0.0, 0.0, 1.5], [0.0; 3]), 100.0);
    let rope = rest.cables[1].hanging.as_ref().unwrap().catenary.rope();
    let between = |from: Vec3, to: Vec3, unstrained_length: f64| {
        let rope = funicular::catenary::Rope { unstrained_length, ..rope };
        funicular::catenary::space::HangingCable::new(from, to, Vec3::z(), rope).unwrap()
    };
    let slack = between(Vec3::new(-4.0, 0.0, 3.0), Vec3::new(4.0, 0.0, 3.0), 8.2);
    let tight = between(Vec3::new(-3.9, 0.0, 2.8), Vec3::new(3.9, 0.0, 2.8), 7.79);
    for (cable, hanging) in rest.cables.iter_mut().zip([slack, tight]) {
        (cable.attachment_w, cable.anchor_w) = (hanging.start_w, hanging.end_w);
        cable.hanging = Some(hanging);
    }
    let found = of_pair(&Surroundings::of(&robot).clearances(&rest, None), ClearancePair::Cables(0, 1));
    assert!((found.distance + 2.0 * robot.cables[0].radius()).abs() < TOLERANCE, "{found:?}");
    assert!((found.points_w[0] - found.points_w[1]).norm() < TOLERANCE);
}

/// Two straight cables at rest between given points, for the distance of their centre lines.
fn straight(ends: [[Vec3; 2]; 2]) -> (Robot, Equilibrium) {
    let (robot, mut rest) = at_rest(&without_ends(cogiro()), Pose::new([0.0, 0.0, 1.5], [0.0; 3]), 100.0);
    for (cable, [attachment_w, anchor_w]) in rest.cables.iter_mut().zip(ends) {
        (cable.attachment_w, cable.anchor_w, cable.hanging) = (attachment_w, anchor_w, None);
    }
    (robot, rest)
}

/// Distance of a point from a segment.
fn from_segment(point: &Vec3, [from, to]: &[Vec3; 2]) -> f64 {
    let along = to - from;
    let place = ((point - from).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (from + along * place - point).norm()
}

#[test]
fn nearly_parallel_cables_are_as_near_as_a_search_over_one_of_them_finds() {
    let mut draw = Draw(23);
    for k in 0..300 {
        // Lines of 8 m that cross each other, or pass at 1e-9 m to 0.1 m, under angles from 1e-2 to 1e-12 rad.
        let angle = 10f64.powf(-2.0 - f64::from(k % 11));
        let gap = if k % 3 == 0 { 0.0 } else { 10f64.powf(draw.between(-9.0, -1.0)) };
        let crossing = draw.between(-4.0, 4.0);
        let own = [Vec3::new(0.0, 0.0, 2.0), Vec3::new(8.0, 0.0, 2.0)];
        let others = [-1.0, 6.0].map(|x| Vec3::new(x, angle * (x - crossing), 2.0 + gap));

        // The distance from the second cable is convex along the first: sections by thirds.
        let at = |place: f64| from_segment(&(own[0] + (own[1] - own[0]) * place), &others);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..200 {
            let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
            if at(a) <= at(b) { high = b } else { low = a }
        }
        let expected = at(0.5 * (low + high)).min(at(0.0)).min(at(1.0));

        let (robot, rest) = straight([own, others]);
        let found = of_pair(&Surroundings::of(&robot).clearances(&rest, None), ClearancePair::Cables(0, 1));
        let distance = found.distance + 2.0 * robot.cables[0].radius();
        assert!((distance - expected).abs() < 0.1 * TOLERANCE, "{angle} {gap}: {distance} {expected}");
    }
}

#[test]
fn parallel_sagging_cables_are_as_far_apart_as_they_are_shifted() {
    let (robot, mut rest) = at_rest(&without_ends(cogiro()), Pose::new([0.0, 0.0, 1.5], [0.0; 3]), 100.0);
    let rope = rest.cables[1].hanging.as_ref().unwrap().catenary.rope();
    let rope = funicular::catenary::Rope { unstrained_length: 8.2, ..rope };
    let from = Vec3::new(-4.0, 0.0, 3.0);
    let aside = Vec3::new(0.0, 0.3, 0.0);
    for (cable, shift) in rest.cables.iter_mut().zip([Vec3::zeros(), aside]) {
        let (start, end) = (from + shift, from + shift + Vec3::new(8.0, 0.0, 0.5));
        let hanging = funicular::catenary::space::HangingCable::new(start, end, Vec3::z(), rope).unwrap();
        (cable.attachment_w, cable.anchor_w, cable.hanging) = (start, end, Some(hanging));
    }
    let found = of_pair(&Surroundings::of(&robot).clearances(&rest, None), ClearancePair::Cables(0, 1));
    let distance = found.distance + 2.0 * robot.cables[0].radius();
    assert!((distance - aside.norm()).abs() < TOLERANCE, "{distance}");
}

/// A copied cable lies on the other one: both touch everywhere, which is found without dividing them into short arcs.
#[test]
fn two_cables_on_one_line_touch() {
    let (robot, mut rest) = at_rest(&cogiro(), Pose::new([0.0, 0.0, 1.5], [0.0; 3]), 100.0);
    rest.cables[1] = CableState { lever_w: rest.cables[1].lever_w, ..rest.cables[0].clone() };
    let started = std::time::Instant::now();
    let found = of_pair(&Surroundings::of(&robot).clearances(&rest, None), ClearancePair::Cables(0, 1));
    let distance = found.distance + 2.0 * robot.cables[0].radius();
    assert!(distance.abs() < TOLERANCE && started.elapsed().as_secs() < 2, "{distance} {:?}", started.elapsed());
}

/// Box of the triangles of its surface.
fn mesh_of_box(half: [f64; 3]) -> Solid {
    let corner = |bits: usize| Vec3::from_fn(|k, _| if bits & (1 << k) == 0 { -half[k] } else { half[k] });
    let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let triangles: Vec<[Vec3; 3]> =
        faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).map(|face| face.map(corner)).collect();
    Solid::Mesh(funicular::robot::ClosedMesh::of_triangles(&triangles).unwrap())
}

fn column(name: &str, pose: Pose, solid: Solid) -> Body {
    Body { name: name.to_owned(), pose, solid }
}

#[test]
fn a_box_is_as_far_as_the_mesh_of_its_surface_and_as_samples_say() {
    let half = [0.3, 0.4, 1.5];
    let mut draw = Draw(7);
    for pose in poses(&mut draw, 6) {
        let mut robot = cogiro();
        let place = Pose::new([draw.between(-6.0, 6.0), draw.between(-4.0, 4.0), 1.5], [5.0, -8.0, 30.0]);
        robot.obstacles =
            vec![column("box", place, Solid::Box { half: half.into() }), column("mesh", place, mesh_of_box(half))];
        let (robot, rest) = at_rest(&robot, pose, 100.0);
        let found = Surroundings::of(&robot).clearances(&rest, None);
        for i in 0..8 {
            let [of_box, of_mesh] =
                [0, 1].map(|obstacle| of_pair(&found, ClearancePair::CableAndObstacle { cable: i, obstacle }).distance);
            assert!((of_box - of_mesh).abs() < 2.0 * BODY_TOLERANCE, "{of_box} {of_mesh}");

            // The points are as far apart as the distance says.
            let near = of_pair(&found, ClearancePair::CableAndObstacle { cable: i, obstacle: 0 });
            let apart = (near.points_w[0] - near.points_w[1]).norm();
            assert!((apart - near.distance - robot.cables[i].radius()).abs() < 2.0 * BODY_TOLERANCE, "{near:?}");

            // Distance of a point from a box in closed form.
            let outside = |point_w: &Vec3| {
                let local = place.rot_wp.inverse() * (point_w - place.position_w);
                Vec3::from_fn(|k, _| (local[k].abs() - half[k]).max(0.0)).norm()
            };
            let sampled = sampled(&rest.cables[i], 20_000).iter().map(outside).fold(f64::INFINITY, f64::min);
            let distance = of_box + robot.cables[i].radius();
            assert!(distance <= sampled + BODY_TOLERANCE && distance > sampled - 1e-3, "{distance} {sampled}");
        }
    }
}

#[test]
fn a_cylinder_and_a_half_space_are_as_far_as_their_closed_forms_say() {
    let mut draw = Draw(11);
    for pose in poses(&mut draw, 4) {
        let mut robot = cogiro();
        let place = Pose::new([draw.between(-6.0, 6.0), draw.between(-4.0, 4.0), 1.0], [20.0, 10.0, 0.0]);
        let floor = Pose::new([0.0, 0.0, -0.5], [0.0, 0.0, 0.0]);
        robot.obstacles = vec![
            column("tube", place, Solid::Cylinder { radius: 0.2, half_length: 0.8 }),
            column("floor", floor, Solid::HalfSpace),
        ];
        let (robot, rest) = at_rest(&robot, pose, 4.0);
        let found = Surroundings::of(&robot).clearances(&rest, None);
        for i in 0..8 {
            let distance = |obstacle: usize| {
                of_pair(&found, ClearancePair::CableAndObstacle { cable: i, obstacle }).distance
                    + robot.cables[i].radius()
            };
            let points = sampled(&rest.cables[i], 20_000);
            let to_tube = |point_w: &Vec3| {
                let local = place.rot_wp.inverse() * (point_w - place.position_w);
                let across = (local.x.hypot(local.y) - 0.2).max(0.0);
                across.hypot((local.z.abs() - 0.8).max(0.0))
            };
            let sampled = points.iter().map(to_tube).fold(f64::INFINITY, f64::min);
            assert!(distance(0) <= sampled + BODY_TOLERANCE && distance(0) > sampled - 1e-3);
            let lowest = points.iter().map(|point| point.z + 0.5).fold(f64::INFINITY, f64::min);
            assert!((distance(1) - lowest).abs() < 1e-6, "{} {lowest}", distance(1));
        }
        let platform = of_pair(&found, ClearancePair::PlatformAndObstacle { body: 0, obstacle: 1 });
        let attachments = robot.cables.iter().map(|cable| pose.point_w(&cable.attachment_p).z + 0.5);
        assert!((platform.distance - attachments.fold(f64::INFINITY, f64::min)).abs() < 1e-12);
    }
}

#[test]
fn the_least_margin_is_that_of_all_pairs_and_moves_with_the_required_distance() {
    let mut robot = cogiro();
    robot.obstacles = vec![column(
        "column",
        Pose::new([3.0, 0.5, 1.5], [0.0; 3]),
        Solid::Cylinder { radius: 0.15, half_length: 1.5 },
    )];
    robot.clearance = Some(RequiredClearance { cables: 0.01, platform: 0.02, obstacles: 0.03, from_end: Some(0.05) });
    let mut draw = Draw(3);
    for pose in poses(&mut draw, 8) {
        let (robot, rest) = at_rest(&robot, pose, 100.0);
        let around = Surroundings::of(&robot);
        let all = around.clearances(&rest, None);
        for kind in [None, Some(ClearanceKind::Cables), Some(ClearanceKind::Platform), Some(ClearanceKind::Obstacles)] {
            let of_kind = all.iter().filter(|of| kind.is_none_or(|kind| of.pair.kind() == kind));
            let least = of_kind.map(Clearance::margin).fold(f64::INFINITY, f64::min);
            let found = around.least(&rest, kind).unwrap();
            assert!((found.margin() - least).abs() < 2.0 * BODY_TOLERANCE, "{kind:?}: {} {least}", found.margin());
        }
    }
}

#[test]
fn a_cable_through_a_closed_mesh_and_one_inside_it_touch_it() {
    let mut robot = cogiro();
    // A hall of 40 m about everything: all cables are inside, none touches a wall.
    robot.obstacles = vec![column("hall", Pose::new([0.0; 3], [0.0; 3]), mesh_of_box([20.0, 20.0, 20.0]))];
    let (robot, rest) = at_rest(&robot, Pose::new([0.0, 0.0, 1.5], [0.0; 3]), 100.0);
    let found = Surroundings::of(&robot).clearances(&rest, None);
    for cable in 0..8 {
        let inside = of_pair(&found, ClearancePair::CableAndObstacle { cable, obstacle: 0 });
        assert!(inside.distance <= 0.0, "{inside:?}");
    }
    assert!(of_pair(&found, ClearancePair::PlatformAndObstacle { body: 0, obstacle: 0 }).distance <= 0.0);
}

/// Height of a point over the surface of a box with edges of 2 cm, as a mesh or not, or of a cylinder, negative inside.
fn height(body: &Body, point_w: &Vec3) -> f64 {
    let local = body.pose.rot_wp.inverse() * (point_w - body.pose.position_w);
    let over = match &body.solid {
        Solid::Cylinder { radius, half_length } => vec![local.x.hypot(local.y) - radius, local.z.abs() - half_length],
        _ => local.iter().map(|x| x.abs() - 0.01).collect(),
    };
    let outside = over.iter().map(|over| over.max(0.0).powi(2)).sum::<f64>().sqrt();
    outside + over.into_iter().fold(f64::NEG_INFINITY, f64::max).min(0.0)
}

/// Robot whose ropes have no diameter and whose file requires no distances.
fn without_diameter() -> Robot {
    let mut robot = cogiro();
    for cable in &mut robot.cables {
        cable.material.dimensions = funicular::robot::RopeDimensions::default();
    }
    robot
}

#[test]
fn a_rope_without_diameter_in_a_solid_is_never_free_whatever_is_required() {
    let robot = without_diameter();
    let (mut robot, rest) = at_rest(&robot, Pose::new([1.0, 0.5, 1.5], [0.0; 3]), 100.0);
    let cable = &rest.cables[2];
    let middle = cable.hanging.as_ref().unwrap().point_w(0.5 * cable.unstrained_length);
    let place = Pose::new(middle.into(), [10.0, 20.0, 30.0]);
    let solids = [
        Solid::Box { half: Vec3::new(0.2, 0.3, 0.1) },
        Solid::Cylinder { radius: 0.1, half_length: 0.3 },
        Solid::HalfSpace,
        mesh_of_box([0.2, 0.3, 0.1]),
    ];
    for solid in solids {
        robot.obstacles = vec![column("post", place, solid.clone())];
        for distance in [0.0, 0.05] {
            robot.clearance = Some(RequiredClearance { obstacles: distance, ..RequiredClearance::default() });
            let around = Surroundings::of(&robot);
            let pair = ClearancePair::CableAndObstacle { cable: 2, obstacle: 0 };
            let found = of_pair(&around.clearances(&rest, None), pair);
            assert!(found.touches() && !found.is_kept() && found.margin() < -0.03 - distance, "{solid:?} {found:?}");
        }

        // A file that says nothing about distances is judged by its obstacle all the same.
        robot.clearance = None;
        let around = Surroundings::of(&robot);
        assert!(!around.least(&rest, None).unwrap().is_kept(), "{solid:?}");
        let warned = funicular::warnings::of_statics(&robot, &rest);
        assert!(warned.iter().any(|of| of.to_string().contains("touch and overlap by")), "{solid:?} {warned:?}");
        assert!(warned.iter().any(|of| of.to_string().contains("have no diameter")), "{warned:?}");
    }
}

/// Two boxes along the axes overlap by the least overlap along an axis, and a body in another one is deeper than that.
#[test]
fn bodies_in_obstacles_have_the_depth_of_the_way_out() {
    let mut robot = without_diameter();
    let pose = Pose::new([0.5, -0.3, 1.5], [0.0; 3]);
    let half = [0.2, 0.15, 0.1];
    robot.platform.bodies = vec![column("case", Pose::new([0.0; 3], [0.0; 3]), Solid::Box { half: half.into() })];
    let others = [0.4, 0.5, 0.3];
    for shift in [[0.55, 0.0, 0.0], [0.0, -0.6, 0.1], [0.1, 0.1, 0.35], [0.0, 0.0, 0.0], [0.02, 0.0, 0.05]] {
        let place = Pose::new([0.5 + shift[0], -0.3 + shift[1], 1.5 + shift[2]], [0.0; 3]);
        let overlap = |k: usize| half[k] + others[k] - f64::abs(shift[k]);
        let expected = (0..3).map(overlap).fold(f64::INFINITY, f64::min);
        for (solid, is_exact) in [(Solid::Box { half: others.into() }, true), (mesh_of_box(others), false)] {
            robot.obstacles = vec![column("table", place, solid)];
            let (robot, rest) = at_rest(&robot, pose, 100.0);
            let pair = ClearancePair::PlatformAndObstacle { body: 0, obstacle: 0 };
            let found = of_pair(&Surroundings::of(&robot).clearances(&rest, None), pair);
            assert!(!found.is_kept(), "{shift:?} {found:?}");
            if is_exact {
                assert!((found.distance + expected).abs() < 1e-6, "{shift:?} {found:?} {expected}");
            } else {
                // The deepest point of the case is no deeper than the way out.
                assert!(found.distance < -0.04 && found.distance >= -expected - 1e-9, "{shift:?} {found:?} {expected}");
            }
        }
    }

    // Faces that touch, and a gap.
    for (gap, kept) in [(0.0, false), (1e-6, true)] {
        let place = Pose::new([0.5 + half[0] + others[0] + gap, -0.3, 1.5], [0.0; 3]);
        robot.obstacles = vec![column("table", place, Solid::Box { half: others.into() })];
        let (robot, rest) = at_rest(&robot, pose, 100.0);
        let pair = ClearancePair::PlatformAndObstacle { body: 0, obstacle: 0 };
        let found = of_pair(&Surroundings::of(&robot).clearances(&rest, None), pair);
        assert_eq!(found.is_kept(), kept, "{found:?}");
    }
}

#[test]
fn a_cable_that_pierces_a_small_body_touches_it_straight_or_sagging() {
    let pose = Pose::new([1.0, 0.5, 1.5], [0.0; 3]);
    for model in [StaticModel::Ideal, StaticModel::Catenary] {
        for along in [0.21, 0.5, 0.83] {
            let (mut robot, rest) = at_rest(&cogiro(), pose, 100.0);
            let cable = &rest.cables[2];
            let hanging = cable.hanging.as_ref().unwrap();
            let place = match model {
                StaticModel::Ideal => cable.attachment_w + cable.chord_w() * along,
                _ => hanging.point_w(along * hanging.catenary.rope().unstrained_length),
            };
            // The cable passes 3 mm beside the middle of bodies of 2 cm.
            let place = Pose::new((place + Vec3::new(0.002, -0.002, 0.001)).into(), [10.0, 20.0, 30.0]);
            robot.obstacles = vec![
                column("box", place, Solid::Box { half: Vec3::repeat(0.01) }),
                column("mesh", place, mesh_of_box([0.01; 3])),
                column("tube", place, Solid::Cylinder { radius: 0.01, half_length: 0.01 }),
            ];
            let mut rest = rest.clone();
            if model == StaticModel::Ideal {
                rest.cables.iter_mut().for_each(|cable| cable.hanging = None);
            }
            let around = Surroundings::of(&robot);
            let found = around.clearances(&rest, None);
            let points = match model {
                StaticModel::Ideal => {
                    let cable = &rest.cables[2];
                    let at = |k: usize| cable.attachment_w + cable.chord_w() * (k as f64 / 200_000.0);
                    (0..=200_000).map(at).collect()
                }
                _ => sampled(&rest.cables[2], 200_000),
            };
            for (obstacle, body) in robot.obstacles.iter().enumerate() {
                let pierced = of_pair(&found, ClearancePair::CableAndObstacle { cable: 2, obstacle });
                let depth = pierced.distance + robot.cables[2].radius();
                let sampled = points.iter().map(|point_w| height(body, point_w)).fold(f64::INFINITY, f64::min);
                assert!(
                    depth <= sampled + BODY_TOLERANCE && depth > sampled - 2e-4,
                    "{model:?} {along} {depth} {sampled}"
                );
                assert!(depth < -4e-3 && !pierced.is_kept());
                let apart = (pierced.points_w[0] - pierced.points_w[1]).norm();
                assert!((apart + depth).abs() < 2.0 * BODY_TOLERANCE, "{pierced:?}");
            }
            assert!(around.least(&rest, Some(ClearanceKind::Obstacles)).unwrap().margin() < -4e-3);
        }
    }
}

#[test]
fn flat_and_small_platforms_have_the_hull_that_they_can_have() {
    for text in [funicular_robots::STADIUM_CAMERA, funicular_robots::YUAN2014_4MM] {
        let robot = Robot::from_toml(text).unwrap();
        let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
        let around = Surroundings::of(&robot);
        let found = around.clearances(&rest, None);
        assert!(!found.is_empty());
        assert!(found.iter().all(|of| of.distance.is_finite()), "{found:?}");
    }
}

/// Robot IPAnema 3 of WireX with ropes; its unit tests give the moves (github.com/gldkhoward/WireX, wcUnitTest.py and
/// GeometryGenerator.cpp).
fn ipanema3() -> Robot {
    let upper = [[-3.8, 1.75, 3.25], [3.8, 1.75, 3.25], [3.8, -1.75, 3.25], [-3.8, -1.75, 3.25]];
    let lower = [[-4.0, 1.5, 0.25], [4.0, 1.5, 0.25], [4.0, -1.5, 0.25], [-4.0, -1.5, 0.25]];
    let below = [[-0.55, 0.25, 0.0], [0.55, 0.25, 0.0], [0.55, -0.25, 0.0], [-0.55, -0.25, 0.0]];
    let above = [[-0.75, 0.15, 0.5], [0.75, 0.15, 0.5], [0.75, -0.15, 0.5], [-0.75, -0.15, 0.5]];
    let head = "name = \"IPAnema 3\"\n[platform]\nmass_kg = 20\ninertia_kg_m2 = [1, 1, 1]\n[materials.rope]\n\
                    axial_stiffness_n = 4e5\nmass_kg_per_m = 0.02\ndrag_diameter_m = 0.006\ndrag_coefficient = 1.2\n\
                    minimum_tension_n = 100\nmaximum_tension_n = 3000\n";
    let ends = upper.iter().chain(&lower).zip(below.iter().chain(&above)).enumerate();
    let cables = ends.map(|(k, (anchor, attachment))| {
        format!(
            "[[cables]]\nname = \"{}\"\nmaterial = \"rope\"\nanchor_m = {anchor:?}\nattachment_m = {attachment:?}\n",
            k + 1
        )
    });
    Robot::from_toml(&format!("{head}{}", cables.collect::<String>())).unwrap()
}

#[test]
fn straight_cables_cross_on_the_moves_of_wirex_where_a_bisection_finds_it() {
    // Fractions by the independent program of the reference: sign changes of the triple product, bisected.
    // The turn of the unit test; its matrix has these elements.
    let turn = [0.0, 0.0, 0.717_356_090_899_522_8_f64.atan2(0.696_706_709_347_165_4).to_degrees()];
    let centre = Pose::new([0.0, 0.0, 1.5], turn);
    let crossings = |to: [f64; 3]| {
        straight_crossings(&ipanema3(), &StraightMove::between(&centre, &Pose::new(to, turn)))
            .into_iter()
            .map(|of| ([of.cables[0] + 1, of.cables[1] + 1], of.fraction, of.along))
            .collect::<Vec<_>>()
    };
    let expected = [
        (
            [-4.0, -2.0, 0.0],
            vec![
                ([4, 8], 0.339_464_721_471_864_57, [0.823_855_421_086_043_9, 0.917_751_095_030_903]),
                ([1, 8], 0.848_101_673_582_894_5, [0.949_230_911_120_501, 0.274_730_791_481_393_8]),
            ],
        ),
        (
            [-4.0, -2.0, 1.2],
            vec![([4, 8], 0.364_447_237_965_447_65, [0.811_091_710_982_063_6, 0.909_331_711_323_446_5])],
        ),
    ];
    for (to, expected) in expected {
        let found = crossings(to);
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (found, expected) in found.iter().zip(&expected) {
            assert_eq!(found.0, expected.0);
            assert!((found.1 - expected.1).abs() < 1e-12, "{found:?} {expected:?}");
            assert!(
                (found.2[0] - expected.2[0]).abs() < 1e-9 && (found.2[1] - expected.2[1]).abs() < 1e-9,
                "{found:?}"
            );
        }
    }
}

#[test]
fn crossings_of_a_turning_move_are_all_sign_changes_of_dense_stations() {
    let robot = ipanema3();
    let mut draw = Draw(5);
    let mut met = 0;
    for _ in 0..40 {
        let mut pose = || {
            let position = [draw.between(-3.0, 3.0), draw.between(-1.4, 1.4), draw.between(0.4, 2.4)];
            Pose::new(position, [draw.between(-20.0, 20.0), draw.between(-20.0, 20.0), draw.between(-60.0, 60.0)])
        };
        let straight = StraightMove::between(&pose(), &pose());
        let found = straight_crossings(&robot, &straight);
        met += found.len();
        // Gap of the segments from station to station: zero where they cross.
        for crossing in &found {
            let pose = straight.pose(crossing.fraction);
            let place = |k: usize| {
                let cable = &robot.cables[crossing.cables[k]];
                let end = pose.point_w(&cable.attachment_p);
                cable.anchor.point_w + (end - cable.anchor.point_w) * crossing.along[k]
            };
            assert!((place(0) - place(1)).norm() < 1e-9, "{crossing:?}");
        }
        for (i, j) in (0..8).flat_map(|i| (i + 1..8).map(move |j| (i, j))) {
            let side = |fraction: f64| {
                let pose = straight.pose(fraction);
                let line = |k: usize| {
                    let cable = &robot.cables[k];
                    (cable.anchor.point_w, pose.point_w(&cable.attachment_p) - cable.anchor.point_w)
                };
                let ((a, d), (b, e)) = (line(i), line(j));
                let normal = d.cross(&e);
                let (s, t) = ((b - a).cross(&e).dot(&normal), (b - a).cross(&d).dot(&normal));
                let inside = [s, t].iter().all(|place| (0.0..normal.norm_squared()).contains(place));
                ((b - a).dot(&normal), inside)
            };
            let values: Vec<(f64, bool)> = (0..=2000).map(|k| side(f64::from(k) / 2000.0)).collect();
            let changes = values.windows(2).filter(|two| two[0].0 * two[1].0 < 0.0 && two[0].1 && two[1].1).count();
            let ours = found.iter().filter(|of| of.cables == [i, j]).count();
            assert!(ours >= changes, "{i} {j}: {ours} {changes}");
        }
    }
    assert!(met > 5, "{met}");
}

#[test]
fn sagging_cables_cross_near_the_straight_ones_and_nothing_is_nearer_than_found() {
    // Wide limits: cables cross where the robot is weak.
    let limits = funicular::robot::TensionLimits { minimum: Some(5.0), maximum: Some(1e5) };
    let robot = without_ends(ipanema3().with_tension_limits(limits));
    let rest_at = |pose: &Pose| {
        statics::solve_at(&robot, &State::Pose(*pose), StaticModel::Catenary, &statics::TensionRule::Lowest)
            .map(|found| found.equilibrium)
    };
    let around = Surroundings::of(&robot);

    // Random moves on which cables cross and which the cables hold from end to end.
    let mut draw = Draw(17);
    let mut moves = Vec::new();
    for _ in 0..4000 {
        let mut pose = || {
            let position = [draw.between(-3.0, 3.0), draw.between(-1.2, 1.2), draw.between(0.5, 2.2)];
            Pose::new(position, [draw.between(-25.0, 25.0), draw.between(-25.0, 25.0), draw.between(-45.0, 45.0)])
        };
        let straight = StraightMove::between(&pose(), &pose());
        let expected = straight_crossings(&robot, &straight);
        let held = || (0..=10).all(|k| rest_at(&straight.pose(f64::from(k) / 10.0)).is_ok());
        if !expected.is_empty()
            && held()
            && let Ok(found) = around.on_the_way(&straight, rest_at)
        {
            moves.push((straight, expected, found));
        }
        if moves.len() == 3 {
            break;
        }
    }
    assert!(!moves.is_empty());

    for (straight, expected, found) in moves {
        let crossing: Vec<_> = found.iter().filter(|of| !of.crossings.is_empty()).collect();
        assert_eq!(crossing.iter().map(|of| of.crossings.len()).sum::<usize>(), expected.len(), "{crossing:?}");
        for expected in &expected {
            let of_pair = crossing
                .iter()
                .find(|of| matches!(of.least.pair, ClearancePair::Cables(i, j) if [i, j] == expected.cables));
            let of_pair = of_pair.unwrap();
            // Sag of millimetres moves the crossing by a small part of the way.
            assert!(
                of_pair.crossings.iter().any(|at| (at - expected.fraction).abs() < 0.05),
                "{of_pair:?} {expected:?}"
            );
            assert!(of_pair.least.distance < 0.0);
        }
        for k in 0..=300 {
            let Ok(rest) = rest_at(&straight.pose(f64::from(k) / 300.0)) else { continue };
            for clearance in around.clearances(&rest, None) {
                let least = found.iter().find(|of| of.least.pair == clearance.pair).unwrap().least;
                assert!(clearance.distance >= least.distance - WAY_TOLERANCE, "{k}: {clearance:?} {least:?}");
            }
        }
    }
}

/// A move is free if and only if no pair has a negative margin on it, by the search for the least margins.
#[test]
fn a_move_is_free_as_its_least_margins_say() {
    let mut robot = cogiro();
    robot.clearance = Some(RequiredClearance { cables: 0.25, platform: 0.0, obstacles: 0.2, from_end: Some(0.1) });
    robot.obstacles = vec![column("post", Pose::new([1.0, 0.5, 1.0], [0.0; 3]), mesh_of_box([0.6, 0.6, 1.0]))];
    let around = Surroundings::of(&robot);
    let mut draw = Draw(7);
    let mut counts = [0, 0];
    for pair in poses(&mut draw, 60).chunks(2) {
        let mut rest_at = |pose: &Pose| {
            let limits = funicular::robot::TensionLimits { minimum: Some(50.0), maximum: Some(5000.0) };
            let posed = Robot { state: State::Pose(*pose), ..robot.with_tension_limits(limits) };
            statics::solve(&posed, StaticModel::Catenary, None).map(|found| found.equilibrium)
        };
        let straight = StraightMove::between(&pair[0], &pair[1]);
        let Ok(found) = around.on_the_way(&straight, &mut rest_at) else { continue };
        let least = found.iter().map(|of| of.least.margin()).fold(f64::INFINITY, f64::min);
        let is_free = around.is_free_way(&straight, &mut rest_at);
        // The least margin is known to this tolerance.
        if least.abs() < WAY_TOLERANCE {
            continue;
        }
        assert_eq!(is_free, least >= 0.0, "{least}");
        counts[usize::from(is_free)] += 1;
    }
    assert!(counts.iter().all(|count| *count > 2), "{counts:?}");
}

/// Where a column stands on the straight move, a way leads around it, and all its moves are free.
#[test]
fn a_way_leads_around_a_column() {
    let mut robot = cogiro();
    robot.obstacles = vec![column("post", Pose::new([0.0, 0.0, 0.8], [0.0; 3]), mesh_of_box([0.15, 0.15, 0.8]))];
    let around = Surroundings::of(&robot);
    let mut rest_at = |pose: &Pose| {
        let limits = funicular::robot::TensionLimits { minimum: Some(50.0), maximum: Some(5000.0) };
        let posed = Robot { state: State::Pose(*pose), ..robot.with_tension_limits(limits) };
        statics::solve(&posed, StaticModel::Catenary, None).map(|found| found.equilibrium)
    };
    let [from, to] = [-2.5, 2.5].map(|x| Pose::new([x, 0.0, 1.2], [0.0; 3]));
    assert!(!around.is_free_way(&StraightMove::between(&from, &to), &mut rest_at));
    let candidates: Vec<Pose> = (0..27)
        .map(|n| {
            Pose::new(
                [f64::from(n % 3 - 1) * 2.0, f64::from(n / 3 % 3 - 1) * 2.0, 1.0 + 0.8 * f64::from(n / 9)],
                [0.0; 3],
            )
        })
        .collect();
    let found = around.free_way([&from, &to], &candidates, 500, &mut rest_at);
    let way = found.through.unwrap();
    assert!((1..=2).contains(&way.len()) && found.moves > 1);
    let all: Vec<Pose> = [vec![from], way, vec![to]].concat();
    for leg in all.windows(2) {
        let found = around.on_the_way(&StraightMove::between(&leg[0], &leg[1]), &mut rest_at).unwrap();
        assert!(found.iter().all(|of| of.least.margin() >= 0.0 && of.crossings.is_empty()), "{leg:?}");
    }

    // Nothing is found where the search may not look.
    let none = around.free_way([&from, &to], &candidates, 1, &mut rest_at);
    assert_eq!((none.through, none.moves), (None, 1));
}
