//! Starts of the search: from nothing but lengths, and from anchors that are far off.

use super::*;

/// True if a point robot in space is found from nothing but lengths: χ² is that of noise, and the distances between
/// anchors are the true ones within 5 deviations.
fn space_is_found(draws: &mut Draws) -> bool {
    let truth = with_errors(&camera(), 0.8, draws);
    let poses = camera_poses(14, draws);
    let rows = readings(&truth, &poses, &[0.0; 6], 1e-3, draws);
    // 84 lengths less 12 and 42 unknowns: 30 ± 7.7, four deviations.
    from_nothing(camera(), &truth, unknowns(6, &[0, 1, 2], false), rows, (6, 62.0))
}

/// True if a planar robot with four cables is found from nothing but lengths, likewise.
fn plane_is_found(draws: &mut Draws) -> bool {
    let file = planar(&[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]);
    let truth = with_errors(&file, 0.5, draws);
    let poses: Vec<Pose> =
        (0..12).map(|_| Pose::new([2.0 + draws.within(1.4), 1.5 + draws.within(1.0), 0.0], [0.0; 3])).collect();
    let rows = readings(&truth, &poses, &[0.0; 4], 1e-3, draws);
    // 48 lengths less 5 and 24 unknowns: 19 ± 6.2, four deviations.
    from_nothing(file, &truth, unknowns(4, &[0, 1], false), rows, (3, 44.0))
}

fn from_nothing(
    file: Robot,
    truth: &Robot,
    all: Vec<CalibrationUnknown>,
    rows: Vec<MeasuredRow>,
    (motions, largest): (usize, f64),
) -> bool {
    let of = Calibration::new(file, all, rows, deviations(1e-3), StaticModel::Ideal).unwrap();
    let frame = of.frame(&FrameChoice::Anchors(Vec::new())).unwrap();
    let found = search(&of, &frame, 10, &mut |_, _| true).unwrap();
    assert!(found.from_nothing && frame.motion_count() == motions);
    let precision = of.precision(&found.best, &of.frame_about(&frame, &found.best));
    found.best.chi2 < largest
        && of.anchor_distances(&found.best, &precision).iter().all(|pair| {
            let [a, b] = pair.cables.map(|cable| truth.cables[cable].anchor.point_w);
            (pair.distance - (a - b).norm()).abs() < 5.0 * pair.deviation
        })
}

/// True if a rigid platform is found from anchors that are up to 0.3 m off along each axis.
fn rigid_is_found(draws: &mut Draws) -> bool {
    let truth = robot("rigid", &RIGID_START, &RIGID_ATTACHMENTS);
    let poses: Vec<Pose> = (0..24)
        .map(|_| {
            let place = [3.0 + draws.within(1.2), 2.5 + draws.within(1.0), 1.6 + draws.within(0.7)];
            Pose::new(place, [draws.within(15.0), draws.within(15.0), draws.within(15.0)])
        })
        .collect();
    let rows = readings(&truth, &poses, &[0.0; 8], 0.5e-3, draws);
    let start = with_errors(&truth, 0.3, draws);
    let of =
        Calibration::new(start, unknowns(8, &[0, 1, 2], false), rows, deviations(0.5e-3), StaticModel::Ideal).unwrap();
    let frame = of.frame(&FrameChoice::Anchors(Vec::new())).unwrap();
    let found = search(&of, &frame, 10, &mut |_, _| true).unwrap();
    // 192 readings less 18 and 144 unknowns: 30 ± 7.7, four deviations.
    found.best.chi2 < 62.0
}

fn arrivals(count: usize, seed: u64, is_found: fn(&mut Draws) -> bool) -> usize {
    let mut draws = Draws(seed);
    (0..count).filter(|_| is_found(&mut draws)).count()
}

#[test]
fn robots_are_found_from_nothing_but_lengths_and_from_anchors_that_are_off() {
    for (is_found, seed) in [(space_is_found as fn(&mut Draws) -> bool, 77), (plane_is_found, 78), (rigid_is_found, 3)]
    {
        assert_eq!(arrivals(10, seed, is_found), 10);
    }
}

/// The numbers of docs/calibration.md; a minute.
#[test]
#[ignore = "a hundred searches of each kind"]
fn at_least_95_of_100_searches_arrive() {
    for (name, is_found, seed) in [
        ("space from nothing", space_is_found as fn(&mut Draws) -> bool, 101),
        ("plane from nothing", plane_is_found, 102),
        ("rigid platform from 0.3 m", rigid_is_found, 103),
    ] {
        let found = arrivals(100, seed, is_found);
        println!("{name}: {found} of 100");
        assert!(found >= 95, "{name}: {found}");
    }
}
