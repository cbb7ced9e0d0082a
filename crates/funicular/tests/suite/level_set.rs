//! Level sets against solids whose volumes, areas and sections have closed forms.

use funicular::level_set::{
    BoundaryMesh, FirstBorder, LevelSet, MAX_NODES, PointGrid, RaySet, RaysInBox, SearchEnd, Sphere, first_borders,
};
use funicular::math::{Rotation, Vec3};
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// Grid of a cube about the origin.
fn cube(half: f64, steps: usize) -> PointGrid {
    PointGrid::new(Vec3::repeat(-half), Vec3::repeat(half), [steps; 3]).unwrap()
}

fn find(grid: PointGrid, inside: impl Fn(&Vec3) -> Option<f64>) -> LevelSet {
    find_to(grid, 1e-9, inside)
}

fn find_to(grid: PointGrid, tolerance: f64, inside: impl Fn(&Vec3) -> Option<f64>) -> LevelSet {
    let mut evaluate = |points: &[Vec3]| Some(points.iter().map(&inside).collect());
    LevelSet::find(grid, tolerance, &mut evaluate).unwrap()
}

/// Every edge of a closed surface belongs to two triangles, which go along it in opposite directions.
fn is_closed(mesh: &BoundaryMesh) -> bool {
    let mut edges: BTreeMap<(usize, usize), i32> = BTreeMap::new();
    for [a, b, c] in mesh.triangles() {
        for (from, to) in [(*a, *b), (*b, *c), (*c, *a)] {
            *edges.entry((from, to)).or_default() += 1;
        }
    }
    edges.iter().all(|((from, to), count)| *count == 1 && edges.get(&(*to, *from)) == Some(&1))
}

#[expect(clippy::unnecessary_wraps, reason = "a function of a point may have no value")]
fn ball(point: &Vec3) -> Option<f64> {
    Some(1.0 - point.norm())
}

/// Ring about z with radii 1 and 0.4.
#[expect(clippy::unnecessary_wraps, reason = "a function of a point may have no value")]
fn ring(point: &Vec3) -> Option<f64> {
    Some(0.4 - (point.xy().norm() - 1.0).hypot(point.z))
}

#[test]
fn a_ball_has_its_volume_area_and_centroid() {
    let middle = Vec3::new(0.03, -0.02, 0.05);
    let volume = 4.0 / 3.0 * PI;
    let mut before = f64::INFINITY;
    for steps in [16, 32, 64] {
        let set = find(cube(1.2, steps), |point| ball(&(point - middle)));
        let mesh = set.boundary(1);
        assert!(is_closed(&mesh));

        // The vertices are on the ball, so the error is that of chords, of second order.
        assert!(mesh.vertices().iter().all(|vertex| ((vertex - middle).norm() - 1.0).abs() < 1e-9));
        let error = volume - mesh.volume();
        assert!(error > 0.0 && error < before / 3.5, "{steps}: {error}");
        before = error;
        assert!((mesh.area() - 4.0 * PI).abs() < 4.0 * error);
        assert!((mesh.centroid().unwrap() - middle).norm() < error);
        assert!((mesh.parts().len(), mesh.holes().len(), mesh.parts()[0].handles) == (1, 0, 0));
        assert_eq!((set.touches(), mesh.cut_area()), ([false; 6], 0.0));
    }
    assert!(before < 2e-3 * volume);
}

/// Function whose values that are not negative are a set.
type SetFunction = Box<dyn Fn(&Vec3) -> Option<f64>>;

/// Set of a known volume within a cube of half side 1.
struct KnownSet {
    name: &'static str,
    volume: f64,
    value: SetFunction,
}

/// Sets that are smooth, have edges, tips or a plateau at zero, or are thin, moved and turned a little.
fn known_sets(moved: Vec3, turned: f64) -> Vec<KnownSet> {
    let place = Rotation::from_scaled_axis(Vec3::new(0.7, -0.4, 0.9) * turned);
    let local = move |point: &Vec3| place.inverse() * (point - moved);
    let within = |half: Vec3| move |point: Vec3| (0..3).map(|k| half[k] - point[k].abs()).fold(f64::INFINITY, f64::min);
    let [box_, slab, wedge] = [[0.52, 0.43, 0.31], [0.6, 0.55, 0.06], [0.5, 0.5, 0.5]].map(Vec3::from).map(within);
    let [plateau, jump] = [Vec3::new(0.52, 0.43, 0.31), Vec3::new(0.41, 0.47, 0.53)].map(within);
    let (height, slope) = (1.1, 0.4);
    let cone = move |point: Vec3| {
        let below = 0.55 - point.z;
        (slope * below - point.xy().norm()).min(height - below)
    };
    let tetrahedron =
        |point: Vec3| point.iter().fold(f64::INFINITY, |least, at| least.min(at + 0.3)).min(0.4 - point.sum());
    let known = |name, volume, value: Box<dyn Fn(Vec3) -> Option<f64>>| KnownSet {
        name,
        volume,
        value: Box::new(move |point| value(local(point))),
    };
    vec![
        known("ball", 4.0 / 3.0 * PI * 0.7_f64.powi(3), Box::new(|point| Some(0.7 - point.norm()))),
        known("box", 8.0 * 0.52 * 0.43 * 0.31, Box::new(move |point| Some(box_(point)))),
        known("cone", PI / 3.0 * (slope * height).powi(2) * height, Box::new(move |point| Some(cone(point)))),
        known("tetrahedron", 1.3_f64.powi(3) / 6.0, Box::new(move |point| Some(tetrahedron(point)))),
        known("thin slab", 8.0 * 0.6 * 0.55 * 0.06, Box::new(move |point| Some(slab(point)))),
        known("wedge", 0.5, Box::new(move |point| Some(wedge(point).min(point.x - point.y)))),
        // Zero inside, and rounding about zero; negative outside.
        known("plateau", 8.0 * 0.52 * 0.43 * 0.31, Box::new(move |point| Some(plateau(point).min(0.0)))),
        known(
            "plateau without values beyond",
            8.0 * 0.41 * 0.47 * 0.53,
            Box::new(move |point| (jump(point) >= 0.0).then_some(0.0)),
        ),
        known(
            "jump",
            8.0 * 0.41 * 0.47 * 0.53,
            Box::new(move |point| Some(if jump(point) >= 0.0 { 1e-9 } else { -5.0 })),
        ),
    ]
}

#[test]
fn the_stated_error_of_a_volume_is_not_below_the_true_one() {
    for (moved, turned) in
        [(Vec3::zeros(), 0.0), (Vec3::new(0.05, -0.1, 0.2), 0.0), (Vec3::new(0.011, 0.023, -0.037), 1.0)]
    {
        for set in known_sets(moved, turned) {
            for steps in [16, 20, 32, 40] {
                let found = find_to(cube(1.0, steps), 0.02 / steps as f64, &set.value);
                let (volume, stated) = (found.boundary(1).volume(), found.volume_errors());
                let error = (volume - set.volume).abs();
                assert!(error <= stated[0], "{} with {steps} steps: {error} > {}", set.name, stated[0]);
                let coarse = (found.boundary(2).volume() - set.volume).abs();
                assert!(
                    coarse <= stated[1],
                    "{} with {steps} steps as {}: {coarse} > {}",
                    set.name,
                    steps / 2,
                    stated[1]
                );
            }
        }
    }
}

#[test]
fn a_plateau_at_zero_loses_nothing() {
    // The same box by its distance, by a plateau at zero, by one with rounding, and with no values outside.
    let half = Vec3::new(0.731, 0.577, 0.413);
    let distance = move |point: &Vec3| (0..3).map(|k| half[k] - point[k].abs()).fold(f64::INFINITY, f64::min);
    let rounding = |point: &Vec3| 1e-16 * (1.0 + (1e3 * point.x).sin());
    let kinds: [SetFunction; 4] = [
        Box::new(move |point| Some(distance(point).min(0.0))),
        Box::new(move |point| Some(if distance(point) >= 0.0 { rounding(point) } else { -1e3 })),
        Box::new(move |point| (distance(point) >= 0.0).then(|| rounding(point))),
        Box::new(move |point| Some(if distance(point) >= 0.0 { 0.0 } else { 10.0 * distance(point) - 0.1 })),
    ];
    for steps in [16, 24] {
        let volume = find(cube(1.0, steps), |point| Some(distance(point))).boundary(1).volume();
        for (i, kind) in kinds.iter().enumerate() {
            let set = find(cube(1.0, steps), kind);
            assert!((set.boundary(1).volume() - volume).abs() < 1e-7, "{i} {steps}: {volume}");
        }
    }
}

#[test]
fn only_the_neighbourhood_of_the_boundary_is_evaluated() {
    let set = find(cube(1.2, 96), ball);
    let vertices = set.boundary(1).vertices().len();
    let (nodes, all) = (set.evaluations() - 3 * vertices, 97_usize.pow(3));
    assert!(nodes < all / 5, "{nodes} of {all} nodes, {vertices} vertices");
}

#[test]
fn larger_steps_have_vertices_of_the_finest_ones() {
    // No node lies on the ball, where either of two zeros of an edge would do.
    let inside = |point: &Vec3| ball(&(point - Vec3::new(0.013, 0.021, -0.017)));
    let set = find(cube(1.2, 24), inside);
    assert_eq!(set.strides(), [1, 2, 4]);
    let fine = set.boundary(1);
    for stride in [2, 4] {
        let coarse = set.boundary(stride);
        assert!(is_closed(&coarse) && coarse.vertices().iter().all(|vertex| fine.vertices().contains(vertex)));
        assert!(coarse.volume() < fine.volume());
        let alone = find(cube(1.2, 24 / stride), inside).boundary(1);
        assert!((coarse.volume() - alone.volume()).abs() < 1e-8 * alone.volume(), "{stride}");
    }
    assert_eq!(find(cube(1.2, 30), ball).strides(), [1, 2]);
    assert_eq!(find(cube(1.2, 31), ball).strides(), [1]);
}

#[test]
fn a_slab_is_exact_and_cut_by_the_box() {
    // The function is linear, so only rounding is left.
    let normal = Vec3::new(0.3, 0.2, 1.0);
    let set = find(cube(1.0, 12), |point| Some(0.1 - normal.dot(point)));
    let mesh = set.boundary(1);
    assert!(is_closed(&mesh));
    assert!((mesh.volume() - 4.0 * 1.1).abs() < 1e-9, "{}", mesh.volume());
    assert!((mesh.area() - 4.0 * normal.norm()).abs() < 1e-9);
    assert!((mesh.cut_area() - (4.0 + 4.0 * 2.0 * 1.1)).abs() < 1e-9, "{}", mesh.cut_area());
    assert_eq!(set.touches(), [true, true, true, true, true, false]);

    // The whole box.
    let mesh = find(cube(1.0, 4), |_| Some(1.0)).boundary(1);
    assert!(is_closed(&mesh) && (mesh.volume() - 8.0).abs() < 1e-12 && mesh.area() == 0.0);
    assert!((mesh.cut_area() - 24.0).abs() < 1e-12);
    let nothing = find(cube(1.0, 4), |_| None);
    assert_eq!((nothing.boundary(1).volume(), nothing.inner_box(), nothing.boundary(1).centroid()), (0.0, None, None));
}

#[test]
fn a_box_that_fits_no_node_loses_only_its_edges() {
    let half = Vec3::new(0.731, 0.577, 0.413);
    let inside = |point: &Vec3| (0..3).map(|k| half[k] - point[k].abs()).reduce(f64::min);
    let volume = 8.0 * half.product();
    let mut before = f64::INFINITY;
    for steps in [16, 32, 64] {
        let error = volume - find(cube(1.0, steps), inside).boundary(1).volume();
        // An edge loses at most half a square of a step.
        let step = 2.0 / steps as f64;
        assert!(error.abs() < 8.0 * half.sum() * 0.5 * step * step && error.abs() < before, "{steps}: {error}");
        before = error.abs();
    }
}

#[test]
fn parts_holes_and_handles_are_counted() {
    let two = |point: &Vec3| {
        let distances = [-0.7, 0.7].map(|x| (point - Vec3::new(x, 0.0, 0.0)).norm());
        Some(0.5 - distances[0].min(distances[1] + 0.2))
    };
    let mesh = find(cube(1.3, 40), two).boundary(1);
    let volumes: Vec<f64> = mesh.parts().iter().map(|part| part.volume).collect();
    assert!(volumes.len() == 2 && mesh.holes().is_empty());
    assert!((volumes[1] / volumes[0] - (0.3_f64 / 0.5).powi(3)).abs() < 5e-3, "{volumes:?}");

    let shell = |point: &Vec3| Some(0.3 - (point.norm() - 0.8).abs());
    let mesh = find(cube(1.3, 40), shell).boundary(1);
    assert!((mesh.parts().len(), mesh.holes().len()) == (1, 1));
    assert!((mesh.holes()[0].volume / (4.0 / 3.0 * PI * 0.125) - 1.0).abs() < 0.01);
    assert!((mesh.volume() / (4.0 / 3.0 * PI * (1.331 - 0.125)) - 1.0).abs() < 0.005);

    let mesh = find(cube(1.6, 48), ring).boundary(1);
    assert!((mesh.parts().len(), mesh.holes().len(), mesh.parts()[0].handles) == (1, 0, 1));
    assert!((mesh.volume() / (2.0 * PI * PI * 0.16) - 1.0).abs() < 0.01);
}

#[test]
fn a_missing_value_is_outside() {
    // Beyond z = 0.31 there is no value: the cap of the ball is missing.
    let height: f64 = 1.0 + 0.31;
    let cut = |point: &Vec3| ball(point).filter(|_| point.z <= 0.31);
    let mesh = find(cube(1.2, 48), cut).boundary(1);
    assert!(is_closed(&mesh));
    let volume = PI * height * height * (3.0 - height) / 3.0;
    assert!((mesh.volume() / volume - 1.0).abs() < 4e-3, "{}", mesh.volume() / volume);
    let [low, high] = mesh.bounds().unwrap();
    assert!((high.z - 0.31).abs() < 1e-9 && (low.z + 1.0).abs() < 2e-3);
}

#[test]
fn sections_have_the_areas_of_circles_and_of_a_ring_with_its_hole() {
    let mesh = find(cube(1.2, 64), ball).boundary(1);
    for (axis, at) in [(0, 0.0), (1, 0.5), (2, -0.71)] {
        let section = mesh.section(axis, at);
        assert!((section.area / (PI * (1.0 - at * at)) - 1.0).abs() < 3e-3 && section.polygons.len() == 1);
        assert!(section.polygons[0].iter().all(|point| (point[axis] - at).abs() < 1e-15));
    }
    assert!(mesh.section(2, 1.1).polygons.is_empty());

    let mesh = find(cube(1.6, 64), ring).boundary(1);
    let section = mesh.section(2, 0.0);
    assert!(section.polygons.len() == 2 && (section.area / (PI * (1.96 - 0.36)) - 1.0).abs() < 5e-3);
}

#[test]
fn sections_at_faces_have_the_area_of_the_set() {
    // On every face of the box, for a set that the box cuts, and for one that just touches faces of the grid.
    let mesh = find(cube(1.0, 12), |point| Some(1.2 - point.norm())).boundary(1);
    let cap = mesh.cut_area() / 6.0;
    for (axis, at) in (0..3).flat_map(|axis| [(axis, -1.0), (axis, 1.0)]) {
        let section = mesh.section(axis, at);
        assert!((section.area - cap).abs() < 1e-9 && section.polygons.len() == 1, "{axis} {at}: {}", section.area);
        let near = mesh.section(axis, at * (1.0 - 1e-7));
        assert!((section.area - near.area).abs() < 1e-5 * cap);
    }

    // Two boxes, one above and one below the plane z = 0, whose faces lie on nodes.
    let boxes = |point: &Vec3| {
        let of = |x: f64, z: f64| 0.25 - (point.x - x).abs().max(point.y.abs()).max((point.z - z).abs());
        Some(of(-0.5, 0.25).max(of(0.5, -0.25)))
    };
    let mesh = find(cube(1.0, 16), boxes).boundary(1);
    let section = mesh.section(2, 0.0);
    assert!((section.area - 0.5).abs() < 1e-9 && section.polygons.len() == 2, "{}", section.area);
    assert!((mesh.section(2, 0.1).area - 0.25).abs() < 1e-9 && mesh.section(2, 0.6).polygons.is_empty());
}

#[test]
fn the_inner_box_of_a_ball_is_its_cube_within_a_step() {
    let set = find(cube(1.2, 48), ball);
    let [low, high] = set.inner_box().unwrap();
    let corners = (0..8).map(|i| Vec3::from_fn(|k, _| if i >> k & 1 == 1 { high[k] } else { low[k] }));
    assert!(corners.into_iter().all(|corner| corner.norm() <= 1.0));
    let largest = (2.0 / 3.0_f64.sqrt()).powi(3);
    let volume = (high - low).product();
    assert!(volume < largest && volume > largest - 6.0 * 0.05 * largest.powf(2.0 / 3.0), "{volume} of {largest}");
}

#[test]
fn spheres_cover_all_directions() {
    assert_eq!(Sphere::numbers()[..8], [6, 12, 18, 42, 66, 162, 258, 642]);
    for count in Sphere::numbers().into_iter().take(8) {
        let sphere = Sphere::with_directions(count).unwrap();
        assert_eq!(sphere.directions().len(), count);
        assert!((sphere.solid_angles().iter().sum::<f64>() - 4.0 * PI).abs() < 1e-12, "{count}");
        assert!(sphere.directions().iter().sum::<Vec3>().norm() < 1e-12);
    }
    assert!(Sphere::with_directions(100).is_none() && Sphere::with_directions(0).is_none());
}

fn along_rays(count: usize, step: f64, inside: impl Fn(&Vec3) -> Option<f64>) -> RaySet {
    let search =
        RaysInBox { center: Vec3::zeros(), bounds: [Vec3::repeat(-1.5), Vec3::repeat(1.5)], step, tolerance: 1e-11 };
    let mut evaluate = |points: &[Vec3]| Some(points.iter().map(&inside).collect());
    RaySet::find(Sphere::with_directions(count).unwrap(), &search, &mut evaluate).unwrap()
}

#[test]
fn rays_find_every_interval() {
    let set = along_rays(162, 0.1, ball);
    assert!((set.volume() - 4.0 / 3.0 * PI).abs() < 1e-9);
    assert!(set.rays().iter().all(|ray| ray.intervals.len() == 1 && !ray.is_cut()));
    let hull = set.hull().unwrap();
    assert!(is_closed(&hull) && hull.volume() < set.volume() && hull.volume() > 0.95 * set.volume());

    // A ball within a shell: two intervals on each ray, and the hull is the ball.
    let both = |point: &Vec3| Some((0.4 - point.norm()).max(0.2 - (point.norm() - 1.0).abs()));
    let set = along_rays(42, 0.05, both);
    let volume = 4.0 / 3.0 * PI * (0.064 + 1.728 - 0.512);
    assert!((set.volume() - volume).abs() < 1e-9 && set.rays().iter().all(|ray| ray.intervals.len() == 2));
    assert!(set.hull().unwrap().volume() < 4.0 / 3.0 * PI * 0.064);

    // A centre outside the set, and a set that goes on behind the box.
    let set = along_rays(12, 0.05, |point| Some(point.norm() - 0.5));
    assert!(
        set.hull().is_none() && set.rays().iter().all(|ray| ray.is_cut() && (ray.intervals[0][0] - 0.5).abs() < 1e-9)
    );
}

#[test]
fn the_first_border_of_a_ray_is_the_end_of_its_first_interval() {
    let sphere = Sphere::with_directions(42).unwrap();
    let center = Vec3::new(0.05, -0.1, 0.02);
    let bounds = [Vec3::repeat(-1.5), Vec3::repeat(1.5)];
    let search = RaysInBox { center, bounds, step: 0.05, tolerance: 1e-11 };
    let borders = |inside: &dyn Fn(&Vec3) -> Option<f64>| {
        let mut count = 0;
        let mut evaluate = |points: &[Vec3]| {
            count += points.len();
            Some(points.iter().map(inside).collect())
        };
        let ends = first_borders(sphere.directions(), &search, &mut evaluate).unwrap();
        (ends, count)
    };

    // A ball within a shell, whose outer interval does not count and is not computed; without values outside of it.
    let both = |point: &Vec3| {
        let value = (0.4 - point.norm()).max(0.2 - (point.norm() - 1.0).abs());
        (value >= 0.0 || point.z > 0.0).then_some(value)
    };
    let set = RaySet::find(sphere.clone(), &search, &mut |points| Some(points.iter().map(both).collect())).unwrap();
    let (ends, count) = borders(&both);
    assert!(count < set.evaluations() / 2, "{count} of {}", set.evaluations());
    for (end, ray) in ends.iter().zip(set.rays()) {
        assert!(end.is_border && (end.distance - ray.intervals[0][1]).abs() < 1e-10, "{end:?} {ray:?}");
    }

    // A set that goes on behind the box, a centre outside the set, and one outside the box.
    let (ends, _) = borders(&|_| Some(1.0));
    let box_ends = set.rays().iter().map(|ray| FirstBorder { distance: ray.end, is_border: false });
    assert_eq!(ends, box_ends.collect::<Vec<_>>());
    assert_eq!(borders(&|_| None), (Vec::new(), 1));
    let outside = RaysInBox { center: Vec3::repeat(2.0), ..search };
    assert_eq!(first_borders(sphere.directions(), &outside, &mut |_| None), None);
}

#[test]
fn work_that_is_stopped_leaves_what_there_is() {
    let stopped_after = |calls: usize| {
        let mut left = calls;
        let mut evaluate = |points: &[Vec3]| {
            left = left.checked_sub(1)?;
            Some(points.iter().map(ball).collect())
        };
        LevelSet::find(cube(1.2, 32), 1e-9, &mut evaluate)
    };
    assert!(stopped_after(0).is_none());
    let volume = 4.0 / 3.0 * PI;
    let mut ends = Vec::new();
    for calls in 1..30 {
        let set = stopped_after(calls).unwrap();
        let mesh = set.boundary(1);
        // Before the first steps of four cells the set is rough.
        let most = if set.strides()[0] > 4 { 0.9 } else { 0.1 };
        assert!(is_closed(&mesh) && (mesh.volume() / volume - 1.0).abs() < most, "{calls}");
        ends.push(set.end());
    }
    ends.dedup();
    assert_eq!(ends, [SearchEnd::Coarse, SearchEnd::Unpolished, SearchEnd::Complete]);
}

#[test]
fn a_set_smaller_than_the_first_steps_is_found_with_the_steps_of_the_grid() {
    let middle = Vec3::repeat(0.45);
    let set = find(cube(1.2, 32), |point| Some(0.15 - (point - middle).norm()));
    let volume = 4.0 / 3.0 * PI * 0.15_f64.powi(3);
    assert!((set.boundary(1).volume() / volume - 1.0).abs() < 0.15 && set.boundary(4).volume() == 0.0);
}

#[test]
fn grids_without_a_volume_or_with_too_many_nodes_are_refused() {
    let [low, high] = [Vec3::zeros(), Vec3::repeat(1.0)];
    assert!(PointGrid::new(low, high, [1; 3]).is_some());
    assert!(PointGrid::new(low, Vec3::new(1.0, 0.0, 1.0), [1; 3]).is_none());
    assert!(PointGrid::new(low, high, [1, 0, 1]).is_none());
    assert!(PointGrid::new(low, Vec3::repeat(f64::NAN), [1; 3]).is_none());
    assert!(PointGrid::new(low, high, [MAX_NODES, 1, 1]).is_none());
    assert!(PointGrid::new(low, high, [usize::MAX; 3]).is_none());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_boundary_of_any_function_is_closed(
        signs in proptest::collection::vec(any::<Option<bool>>(), 5 * 5 * 5),
    ) {
        // Values at the nodes alone decide; between them the nearest node counts.
        let value = |point: &Vec3| {
            let [i, j, k] = [point.x, point.y, point.z].map(|at| (at + 2.0).round() as usize);
            signs[i + 5 * j + 25 * k].map(|inside| if inside { 1.0 } else { -1.0 })
        };
        let set = find(cube(2.0, 4), value);
        for stride in set.strides() {
            let mesh = set.boundary(stride);
            prop_assert!(is_closed(&mesh));
            prop_assert!((-1e-12..=64.0 + 1e-12).contains(&mesh.volume()));
            let pieces: f64 = mesh.parts().iter().map(|part| part.volume).sum::<f64>()
                - mesh.holes().iter().map(|hole| hole.volume).sum::<f64>();
            prop_assert!((pieces - mesh.volume()).abs() < 1e-9);
        }
    }
}

/// A search that is stopped early has a set from larger steps than those of its grid, and asks the same points as one
/// that is not stopped, if it goes on.
#[test]
fn a_stopped_search_has_a_coarse_set_of_all_the_box() {
    let volume = 4.0 / 3.0 * PI;
    let mut last = 0.0;
    // 64 steps: looks at 2, 4, 8 and 16 cells before its own grid.
    for most in [60, 400, 1200, 6000] {
        let mut asked = 0;
        let mut evaluate = |points: &[Vec3]| {
            asked += points.len();
            (asked <= most).then(|| points.iter().map(ball).collect())
        };
        let set = LevelSet::find(cube(1.2, 64), 1e-9, &mut evaluate).unwrap();
        assert_ne!(set.end(), SearchEnd::Complete);
        let mesh = set.boundary(1);
        assert!(is_closed(&mesh) && set.strides()[0] > 1 && set.volume_errors().len() == set.strides().len());
        let error = (mesh.volume() / volume - 1.0).abs();
        println!("{most}: strides {:?}, {error}", set.strides());
        assert!(mesh.volume() > last && error < 0.9, "{most}: {error}");
        last = mesh.volume();
    }

    // Nothing before the first eight cells.
    let mut evaluate = |_: &[Vec3]| None;
    assert!(LevelSet::find(cube(1.2, 64), 1e-9, &mut evaluate).is_none());
}

/// Every point of the grid is asked at most once, and the first ones are spread over the box.
#[test]
fn the_first_points_are_spread_over_the_box() {
    // 15 steps have no larger ones: all nodes are asked at once.
    let mut first: Vec<Vec3> = Vec::new();
    let mut evaluate = |points: &[Vec3]| {
        if first.is_empty() {
            first = points.to_vec();
        }
        Some(points.iter().map(ball).collect())
    };
    LevelSet::find(cube(1.2, 15), 1e-9, &mut evaluate).unwrap();
    assert_eq!(first.len(), 16_usize.pow(3));
    let all: std::collections::HashSet<[u64; 3]> =
        first.iter().map(|point| [point.x, point.y, point.z].map(f64::to_bits)).collect();
    assert_eq!(all.len(), first.len());
    let early = &first[..200];
    for k in 0..3 {
        let mean = early.iter().map(|point| point[k]).sum::<f64>() / early.len() as f64;
        assert!(mean.abs() < 0.15, "axis {k}: {mean}");
        assert!(early.iter().any(|point| point[k] < -0.9) && early.iter().any(|point| point[k] > 0.9));
    }
}
