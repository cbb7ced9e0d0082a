//! Boxes of poses proved inside or outside: random poses by the tension distribution, boxes, borders and volumes of
//! separate linear programs, and what changes a verdict.

use funicular::math::{Rotation, Vec3};
use funicular::proof::{BoxVerdict, PositionBox, ProofRefusal, ProofSearch, ProofStatement, Undecided};
use funicular::robot::{LoadShape, Pose, Robot, TensionLimits};
use funicular::statics::{StaticModel, TensionRule, distribute_tensions};
use std::fmt::Write as _;

type ReferenceBox = ([f64; 3], [f64; 3], &'static str, f64, f64);

/// Boxes of CoGiRo with straight cables between 100 N and 5000 N: middle [m], half widths [m], verdict, and the least
/// and greatest margin [N] at 21 × 21 × 21 points. Margins by a separate simplex method and by HiGHS.
const BOXES: [ReferenceBox; 15] = [
    ([4.921875, -2.40625, 2.3625], [0.234375, 0.34375, 0.3375], "inside", 46.221037, 129.247716),
    ([-1.640625, 1.890625, 4.21875], [0.234375, 0.171875, 0.16875], "inside", 714.005613, 1356.583069),
    ([5.859375, 3.609375, 3.54375], [0.234375, 0.171875, 0.16875], "inside", 80.982255, 210.377061),
    ([-4.453125, -2.40625, 0.3375], [0.234375, 0.34375, 0.3375], "inside", 6.324642, 39.924743),
    ([-5.771484375, -3.416015625, 1.8984375], [0.029296875, 0.021484375, 0.0421875], "inside", 0.20203, 6.660851),
    ([6.943359375, -0.98828125, 4.3453125], [0.029296875, 0.04296875, 0.0421875], "inside", 8.641569, 57.401942),
    ([-4.716796875, -3.458984375, 0.5484375], [0.029296875, 0.021484375, 0.0421875], "inside", 0.924662, 5.036879),
    ([5.15625, -5.15625, 0.3375], [0.46875, 0.34375, 0.3375], "outside", -128.161204, -74.675981),
    ([3.046875, -0.34375, 5.0625], [0.234375, 0.34375, 0.3375], "outside", -30294.692413, -1453.231915),
    ([7.265625, -1.890625, 5.23125], [0.234375, 0.171875, 0.16875], "outside", -6491.973639, -2132.095754),
    ([-2.900390625, -4.962890625, 4.0921875], [0.029296875, 0.021484375, 0.0421875], "outside", -36.092254, -10.497385),
    ([-0.322265625, -3.931640625, 1.4765625], [0.029296875, 0.021484375, 0.0421875], "outside", -7.455947, -1.8678),
    ([-4.833984375, 3.845703125, 1.4765625], [0.05859375, 0.04296875, 0.084375], "mixed", -7.683357, 3.609567),
    ([6.650390625, -0.408203125, 3.5859375], [0.05859375, 0.04296875, 0.084375], "mixed", -18.529953, 17.267639),
    ([-7.119140625, 1.095703125, 4.70390625], [0.05859375, 0.04296875, 0.0421875], "mixed", -2649.012679, 35.08943),
];

/// Positions of CoGiRo [m] with the greatest distance of tensions from their limits [N] by HiGHS.
const MARGINS: [([f64; 3], f64); 4] = [
    ([0.0, 0.0, 1.5], 204.542789273),
    ([0.0, 0.0, 3.0], 426.296464099),
    ([5.0, -2.0, 1.0], 16.123638348),
    ([-2.0, -2.0, 0.8], 84.580176122),
];

fn robot_of(text: &str) -> Robot {
    Robot::from_toml(text).unwrap()
}

fn cogiro() -> Robot {
    robot_of(funicular_robots::COGIRO)
}

fn upright(robot: &Robot, model: StaticModel) -> ProofStatement {
    ProofStatement::of(robot, &Pose::new([0.0; 3], [0.0; 3]), model, Vec3::zeros()).unwrap()
}

/// Divides a box until this many boxes were tried, so many at once.
fn searched(statement: &ProofStatement, region: PositionBox, boxes: usize, at_once: usize) -> ProofSearch {
    let mut search = ProofSearch::new(region);
    while search.tried() < boxes {
        let next = search.next(at_once.min(boxes - search.tried()));
        if next.is_empty() {
            break;
        }
        let proofs: Vec<_> = next.iter().map(|region| statement.prove(region)).collect();
        search.add(&proofs);
    }
    search
}

fn cogiro_box() -> PositionBox {
    PositionBox { lower: Vec3::new(-7.5, -5.5, 0.0), upper: Vec3::new(7.5, 5.5, 5.4) }
}

/// Numbers from 0 to 1, evenly spread in any number of dimensions: the fractions of multiples of irrational numbers.
struct EvenSpread(u32);

impl EvenSpread {
    fn next<const N: usize>(&mut self) -> [f64; N] {
        self.0 += 1;
        std::array::from_fn(|k| (f64::from(self.0) * [2.0_f64, 3.0, 5.0, 7.0, 11.0, 13.0][k].sqrt()).fract())
    }

    fn in_box(&mut self, region: &PositionBox) -> Vec3 {
        let at: [f64; 3] = self.next();
        Vec3::from_fn(|k, _| region.lower[k] + at[k] * (region.upper[k] - region.lower[k]))
    }
}

fn corner(region: &PositionBox, number: usize) -> Vec3 {
    Vec3::from_fn(|k, _| if number & (1 << k) == 0 { region.lower[k] } else { region.upper[k] })
}

#[test]
fn boxes_have_the_verdicts_of_separate_programs() {
    let statement = upright(&cogiro(), StaticModel::Spring);
    for (center, half, verdict, least, greatest) in BOXES {
        let region = PositionBox::about(&Vec3::from(center), &Vec3::from(half));
        match (verdict, statement.prove(&region).verdict) {
            // A bound is at most the least margin that was found, and loses little of it.
            ("inside", BoxVerdict::Inside(margin)) => {
                assert!(margin <= least + 1e-5 && margin > 0.0, "{center:?}: {margin} for {least}");
            }
            ("outside", BoxVerdict::Outside(missing)) => assert!(missing > 0.0 && greatest < 0.0, "{center:?}"),
            ("mixed", BoxVerdict::Undecided(Undecided::SmallMargin)) => assert!(least < 0.0 && greatest > 0.0),
            (_, other) => panic!("{center:?}: {verdict}, and not {other:?}"),
        }
    }
}

#[test]
fn the_margin_of_one_position_is_that_of_a_linear_program() {
    let margin_of = |robot: &Robot, position: [f64; 3]| {
        let region = PositionBox::about(&Vec3::from(position), &Vec3::zeros());
        match upright(robot, StaticModel::Spring).prove(&region).verdict {
            BoxVerdict::Inside(margin) => margin,
            other => panic!("{position:?}: {other:?}"),
        }
    };
    for (position, expected) in MARGINS {
        let margin = margin_of(&cogiro(), position);
        assert!((margin - expected).abs() < 1e-6 * expected, "{position:?}: {margin} for {expected}");

        // One percent of any input shows.
        let mut changed = [cogiro(), cogiro(), cogiro(), cogiro()];
        changed[0].platform.mass *= 1.01;
        changed[1] = changed[1].with_tension_limits(TensionLimits { minimum: Some(101.0), maximum: Some(5000.0) });
        changed[2].cables[1].attachment_p *= 1.01;
        changed[3].platform.center_of_mass_p.x += 0.01;
        for robot in &changed {
            let shift = (margin_of(robot, position) - expected).abs();
            assert!(shift > 1e-4 * expected, "{position:?}: {shift} of {expected}");
        }
    }
}

#[test]
fn proofs_along_lines_end_at_the_borders_of_linear_programs() {
    let statement = upright(&cogiro(), StaticModel::Spring);
    for (height, length, exit) in [(1.5, 6.0, 5.551_229_140_389_779), (3.0, 7.0, 6.341_300_795_465_967)] {
        let line = PositionBox { lower: Vec3::new(0.0, 0.0, height), upper: Vec3::new(length, 0.0, height) };
        let search = searched(&statement, line, 120, 8);
        let [mut inside, mut outside] = [0.0, length];
        for of in search.boxes() {
            match of.verdict {
                BoxVerdict::Inside(_) => inside = of.region.upper.x.max(inside),
                BoxVerdict::Outside(_) => outside = of.region.lower.x.min(outside),
                BoxVerdict::Undecided(_) => {}
            }
        }
        assert!(inside <= exit && exit <= outside && outside - inside < 5e-9, "{inside} {exit} {outside}");
    }
}

#[test]
fn the_volume_of_cogiro_is_between_the_proved_bounds() {
    let (straight, sagging) = (upright(&cogiro(), StaticModel::Spring), upright(&cogiro(), StaticModel::Catenary));
    for (statement, most) in [(&straight, 0.42), (&sagging, 0.42)] {
        let search = searched(statement, cogiro_box(), 10_000, 256);
        let volumes = search.volumes();
        // 200,000 samples by linear programs gave 479.8 m³ with a deviation of 1.0 m³.
        assert!(volumes.inside < 479.8 + 3.0 && volumes.whole - volumes.outside > 479.8 - 3.0, "{volumes:?}");
        assert!(volumes.undecided() / volumes.whole < most, "{volumes:?}");
        let mesh = search.surface();
        assert!((mesh.volume() - volumes.inside).abs() < 1e-9 * volumes.inside, "{}", mesh.volume());

        // The parts are those of one box at a time, and fill the box.
        let sum: f64 = search.boxes().map(|of| of.region.measure()).sum();
        assert!((sum - volumes.whole).abs() < 1e-9 * sum);
        let one_by_one = searched(statement, cogiro_box(), 500, 1).volumes();
        assert_eq!(one_by_one, searched(statement, cogiro_box(), 500, 77).volumes());
    }
}

/// Eight cables to the corners of a frame that is symmetric in both planes.
fn symmetric() -> Robot {
    let mut text = String::from(
        "name = \"symmetric\"\n[platform]\nmass_kg = 60.0\ninertia_kg_m2 = [2.0, 3.0, 2.6]\n[materials.rope]\n\
         youngs_modulus_pa = 100e9\narea_m2 = 5e-6\nmass_kg_per_m = 0.05\n",
    );
    for number in 0..8 {
        let sign = |bit: usize| if number & (1 << bit) == 0 { -1.0 } else { 1.0 };
        let (x, y, z) = (sign(0), sign(1), sign(2));
        let (anchor, attachment) = ([3.0 * x, 2.0 * y, 2.0 + 2.0 * z], [0.3 * x, -0.2 * y, -0.25 * z]);
        let _ = write!(
            text,
            "[[cables]]\nname = \"{number}\"\nmaterial = \"rope\"\nanchor_m = {anchor:?}\nattachment_m = \
             {attachment:?}\nminimum_tension_n = 50\nmaximum_tension_n = 3000\n"
        );
    }
    robot_of(&text)
}

/// Robots with boxes of positions and tension limits [N].
fn robots() -> Vec<(Robot, PositionBox)> {
    let planar = robot_of(funicular_robots::KNTU_PLANAR)
        .with_tension_limits(TensionLimits { minimum: Some(5.0), maximum: Some(60.0) });
    let planar_box = PositionBox { lower: Vec3::new(-1.0, -1.0, 0.0), upper: Vec3::new(1.0, 1.0, 0.0) };
    let camera = robot_of(funicular_robots::STADIUM_CAMERA);
    let [mut lower, mut upper] = [camera.cables[0].anchor.reference_w(); 2];
    for cable in &camera.cables {
        (lower, upper) = (lower.inf(&cable.anchor.reference_w()), upper.sup(&cable.anchor.reference_w()));
    }
    lower.z = 0.0;
    let symmetric_box = PositionBox { lower: Vec3::new(-3.6, -2.6, -0.6), upper: Vec3::new(3.6, 2.6, 4.6) };
    vec![
        (cogiro(), cogiro_box()),
        (symmetric(), symmetric_box),
        (planar, planar_box),
        (camera, PositionBox { lower, upper }),
    ]
}

#[test]
fn no_pose_contradicts_a_proof() {
    let mut spread = EvenSpread(0);
    for (robot, region) in robots() {
        for model in [StaticModel::Spring, StaticModel::Catenary] {
            let search = searched(&upright(&robot, model), region, 3000, 256);
            let (mut inside, mut outside) = (0, 0);
            // Every second box: a corner and a point of it.
            for (number, of) in search.boxes().enumerate().filter(|(number, _)| number % 2 == 0) {
                for position in [corner(&of.region, number / 2), spread.in_box(&of.region)] {
                    let pose = Pose::new(position.into(), [0.0; 3]);
                    let held = distribute_tensions(&robot, &pose, model, &TensionRule::Lowest).is_ok();
                    match of.verdict {
                        BoxVerdict::Inside(_) => {
                            assert!(held, "{} {model:?} {position:?} is inside", robot.name);
                            inside += 1;
                        }
                        BoxVerdict::Outside(_) => {
                            assert!(!held, "{} {model:?} {position:?} is outside", robot.name);
                            outside += 1;
                        }
                        BoxVerdict::Undecided(_) => {}
                    }
                }
            }
            println!("{} {model:?}: {inside} inside, {outside} outside, {:?}", robot.name, search.volumes());
            assert!(inside > 60 && outside > 10, "{} {model:?}: {inside} {outside}", robot.name);
        }
    }
}

#[test]
fn turned_poses_with_every_load_are_held_in_a_proved_box() {
    let mut robot = cogiro();
    robot.required.force_w = Vec3::new(20.0, 30.0, 40.0);
    let turns = Vec3::new(1.0, 1.0, 2.0).map(f64::to_radians);
    let start = Pose::new([0.0; 3], [0.0, 0.0, 5.0]);
    for model in [StaticModel::Spring, StaticModel::Catenary] {
        let statement = ProofStatement::of(&robot, &start, model, turns).unwrap();
        assert_eq!(statement.load_count(), 8);
        let mut spread = EvenSpread(7);
        let mut proved = 0;
        let middle = PositionBox { lower: Vec3::new(-3.0, -2.0, 1.0), upper: Vec3::new(3.0, 2.0, 3.0) };
        for of in searched(&statement, middle, 500, 64).boxes() {
            let BoxVerdict::Inside(_) = of.verdict else { continue };
            proved += 1;
            for _ in 0..4 {
                let sides: [f64; 6] = spread.next();
                let turn = Vec3::from_fn(|k, _| turns[k] * (2.0 * sides[k] - 1.0));
                let mut held = robot.clone();
                // Within the loads, and beyond none of them.
                held.load.force_w += Vec3::from_fn(|k, _| robot.required.force_w[k] * (2.0 * sides[3 + k] - 1.0));
                let rot_wp = Rotation::from_scaled_axis(turn) * start.rot_wp;
                let pose = Pose { position_w: spread.in_box(&of.region), rot_wp };
                let found = distribute_tensions(&held, &pose, model, &TensionRule::Lowest);
                assert!(found.is_ok(), "{model:?} {pose:?}");
            }
        }
        assert!(proved > 20, "{proved}");
    }
}

#[test]
fn what_no_bound_is_derived_for_is_refused() {
    let pose = Pose::new([0.0, 0.0, 1.5], [0.0; 3]);
    let of = |robot: &Robot, turns: Vec3| ProofStatement::of(robot, &pose, StaticModel::Catenary, turns).err();
    let refused = |change: &dyn Fn(&mut Robot)| {
        let mut robot = cogiro();
        change(&mut robot);
        of(&robot, Vec3::zeros())
    };
    let ball = refused(&|robot| {
        robot.required.force_w = Vec3::repeat(10.0);
        robot.required.shape = LoadShape::Ellipsoid;
    });
    assert_eq!(ball, Some(ProofRefusal::Ellipsoid));
    assert_eq!(refused(&|robot| robot.required.wind_speed = 5.0), Some(ProofRefusal::RequiredWind));
    let loaded = refused(&|robot| robot.cables[2].load_per_length_w = Vec3::x());
    assert_eq!(loaded, Some(ProofRefusal::LoadedCable("3".to_owned())));
    let few = refused(&|robot| robot.cables.truncate(5));
    assert_eq!(few, Some(ProofRefusal::FewCables));
    let slack = cogiro().with_tension_limits(TensionLimits { minimum: Some(0.0), maximum: Some(5000.0) });
    assert!(matches!(of(&slack, Vec3::zeros()), Some(ProofRefusal::SlackCable(_))));
    assert!(matches!(of(&cogiro(), Vec3::new(0.5, 0.0, 0.0)), Some(ProofRefusal::LargeTurn { .. })));
    let point = robot_of(funicular_robots::STADIUM_CAMERA);
    assert_eq!(of(&point, Vec3::new(0.01, 0.0, 0.0)), Some(ProofRefusal::NoTurn));
    let over_pulleys = of(&robot_of(funicular_robots::COGIRO_WINCHES), Vec3::zeros());
    assert_eq!(over_pulleys, Some(ProofRefusal::Pulley("1".to_owned())));
}

#[test]
fn an_anchor_in_the_box_and_dependent_cables_are_undecided() {
    let statement = upright(&cogiro(), StaticModel::Spring);
    let anchor = cogiro().cables[0].anchor.reference_w() - cogiro().cables[0].attachment_p;
    let about = PositionBox::about(&anchor, &Vec3::repeat(0.1));
    assert_eq!(statement.prove(&about).verdict, BoxVerdict::Undecided(Undecided::AnchorInBox));
}
