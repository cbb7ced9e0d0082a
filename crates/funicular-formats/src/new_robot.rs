//! Robot file with starting values, made from a number of cables or from a table of points.
//!
//! The comments of the file come from the table of keys. The state of the file is an equilibrium that the program has
//! computed and found stable.

mod file;
mod layout;
mod points;

use anyhow::{Result, anyhow, bail};
use file::{NewFile, Rope, breaking_load};
use funicular::math::{Vec3, rotation};
use funicular::robot::{Pose, Robot};
use funicular::statics::Stability;
use funicular_study::at_rest;
use funicular_study::request::{NewRequest, RobotText, State, Tensions, check};
use funicular_study::text::vector;
use funicular_study::values::{not_negative, positive};
use funicular_study::wording::{Words, worded};
use layout::Layout;
use points::CablePoints;

pub use funicular_study::names::{LengthUnit, NewMotion, RopeType};

/// Default mass of the platform [kg].
const MASS: f64 = 100.0;

/// Minimum diameter of the default rope [mm]: the thinnest stranded ropes in catalogues have about 0.3 mm.
const MIN_DIAMETER_MM: f64 = 0.3;

/// Maximum number of cables of a layout that the program makes.
pub(crate) const MAX_CABLES: usize = 64;

/// Minimum breaking load of the default rope, as a multiple of the platform's weight: 6 mm for 100 kg. With 5, the
/// usual factor between breaking load and working load, one cable could just carry the platform; 20 leaves room for a
/// payload and for shallow cables. With 80 the ropes of a small robot would be heavy beside its platform.
const STRENGTH: f64 = 20.0;

/// Acceleration of gravity for weights [m/s²].
const GRAVITY: f64 = 9.81;

/// Distance between the requested pose and the nearest pose that the cables can hold, above which the file gets the
/// latter [m].
const OTHER_POSE: f64 = 1e-3;

/// Minimum side of the box [m]: points are written with six decimals.
const MIN_SIDE: f64 = 1e-3;

/// Coordinate above which metres are unlikely [m]: no cable robot is larger than a kilometre.
const UNLIKELY_M: f64 = 1e3;

/// Robot file with starting values.
#[derive(Debug, Clone, PartialEq)]
pub struct NewRobot {
    /// Text of the robot file.
    pub text: String,
    /// Pose of the file's state.
    pub pose: Pose,
    /// Caveats, one sentence each; empty if the robot has a stable equilibrium in the state of the file.
    pub warnings: Vec<String>,
}

/// Makes a robot file. `words` names the options in messages as the front end writes them.
///
/// # Errors
/// A number out of its range, options that exclude each other, or a table of points that cannot be read, with its line.
pub fn run(request: &NewRequest, words: Words) -> Result<NewRobot> {
    check("mass_kg", request.mass_kg, positive)?;
    request.box_m.iter().flatten().try_for_each(|side| check("box_m", Some(*side), side_of_box))?;
    let mass = request.mass_kg.unwrap_or(MASS);
    let rope = rope(request, mass)?;

    let mut warnings = Vec::new();
    let layout = if let Some(csv) = &request.from_csv {
        if request.cables.is_some() {
            bail!("⟪cables⟫ and ⟪from_csv⟫ both give the number of cables: leave ⟪cables⟫ out");
        }
        let cables = points::read(csv, request.csv_unit, request.motion)?;
        warnings.extend(unlikely_unit(&cables));
        Layout::of_points(cables, request.motion, request.box_m)
    } else {
        if request.csv_unit.is_some() {
            bail!("⟪csv_unit⟫ is the unit of the table of ⟪from_csv⟫: give the table, or leave the unit out");
        }
        Layout::of_count(request.cables, request.motion, request.box_m)?
    };

    let poses = match request.pose {
        Some(pose) => vec![pose.to_robot()?],
        None => layout.heights.iter().map(|height| layout.pose_at(*height)).collect(),
    };
    // A pose of the user may be anywhere, for example in a pit.
    let floor = layout.floor.filter(|_| request.pose.is_none());
    let box_sides = request.box_m.unwrap_or(layout.sides);
    let file = NewFile { request, mass, rope, cables: &layout.cables, box_sides };

    let (text, pose, caveat) = with_stable_state(&file, &poses, floor)?;
    warnings.extend(caveat);
    let in_words = |texts: &[String]| texts.iter().map(|text| worded(text, words)).collect();
    Ok(NewRobot { text: worded(&text, words), pose, warnings: in_words(&warnings) })
}

impl NewRobot {
    /// Sentence on the pose of the file's state, for a program that has written the file.
    #[must_use]
    pub fn pose_line(&self) -> String {
        let position: Vec<f64> = self.pose.position_w.iter().copied().collect();
        let angles: Vec<f64> = angles(&self.pose).iter().copied().collect();
        format!("start pose: position ({}) m, roll, pitch, yaw ({})°", vector(&position, 3), vector(&angles, 2))
    }
}

/// File with the first pose that is stable; without one the first pose and the reason why its cables do not hold it.
fn with_stable_state(file: &NewFile, poses: &[Pose], floor: Option<f64>) -> Result<(String, Pose, Option<String>)> {
    let mut first: Option<(String, Pose, String)> = None;
    for pose in poses {
        let text = file.text(pose)?;
        let robot = Robot::from_toml(&text).map_err(|error| {
            let issues: Vec<String> = error.issues().iter().map(|issue| issue.message.clone()).collect();
            anyhow!("a robot file cannot hold this robot: {}", issues.join("; "))
        })?;

        let source = RobotText { name: String::new(), text: text.clone(), set: Vec::new() };
        let reason = match at_rest::equilibrium(robot, &source, &State::default(), &Tensions::default()) {
            Ok(found) if !matches!(found.equilibrium.stability, Stability::Stable { .. }) => {
                "the equilibrium at the pose of the file is not stable".to_owned()
            }
            Ok(found) => {
                // With fewer cables than degrees of freedom the file gets the pose that the cables hold.
                let moved = found.requested_pose.is_some_and(|(_, distance)| distance > OTHER_POSE);
                let held = if moved { &found.equilibrium.pose } else { pose };
                if floor.is_none_or(|floor| file.lowest_point(held) > floor) {
                    let text = if moved { file.text(held)? } else { text };
                    return Ok((text, *held, None));
                }
                "the pose that the cables hold is below the floor, z = 0".to_owned()
            }
            Err(error) => format!("the cables do not hold the platform at the pose of the file: {error:#}"),
        };
        first.get_or_insert((text, *pose, reason));
    }

    let Some((text, pose, reason)) = first else { bail!("there is no pose to try: give ⟪pose⟫") };
    Ok((text, pose, Some(format!("{reason}; give another ⟪pose⟫, or change points, mass or rope in the file"))))
}

/// Checks a side of the box [m].
fn side_of_box(side: f64) -> Result<f64, String> {
    match positive(side)? {
        side if (MIN_SIDE..=UNLIKELY_M).contains(&side) => Ok(side),
        side => Err(format!("{side} is not between {MIN_SIDE} and {UNLIKELY_M} m")),
    }
}

/// Warning about points whose size no robot has.
fn unlikely_unit(cables: &[CablePoints]) -> Option<String> {
    let largest = cables.iter().flat_map(|cable| [cable.anchor.amax(), cable.attachment.amax()]).fold(0.0, f64::max);
    (largest > UNLIKELY_M).then(|| {
        format!(
            "the table has a coordinate of {largest} m; if the table is in millimetres or inches, give ⟪csv_unit⟫ mm \
             or in"
        )
    })
}

/// Rope of a request.
fn rope(request: &NewRequest, mass: f64) -> Result<Rope> {
    check("diameter_m", request.diameter_m, positive)?;
    check("axial_stiffness_n", request.axial_stiffness_n, positive)?;
    check("mass_kg_per_m", request.mass_kg_per_m, not_negative)?;

    match (request.axial_stiffness_n, request.mass_kg_per_m) {
        (Some(_), _) if request.diameter_m.is_some() => {
            bail!("⟪axial_stiffness_n⟫ is EA, which ⟪diameter_m⟫ also determines: leave one of them out")
        }
        (Some(axial_stiffness), Some(mass_per_length)) => Ok(Rope::Other { axial_stiffness, mass_per_length }),
        (Some(_), None) => bail!("⟪axial_stiffness_n⟫ needs the mass of the rope: give ⟪mass_kg_per_m⟫"),
        (None, Some(_)) => bail!("⟪mass_kg_per_m⟫ goes with ⟪axial_stiffness_n⟫: a ⟪rope⟫ has its own mass"),
        (None, None) => {
            let rope = request.rope;
            let diameter = request.diameter_m.unwrap_or_else(|| {
                let per_mm2 = breaking_load(rope, 1e-3);
                let needed = (STRENGTH * mass * GRAVITY / per_mm2).sqrt();
                // Whole millimetres, or tenths of thin ropes.
                let tenths = if needed > 1.0 { 10.0 * needed.ceil() } else { (10.0 * needed).ceil() };
                tenths.max(10.0 * MIN_DIAMETER_MM) * 1e-4
            });
            Ok(Rope::Type { rope, diameter })
        }
    }
}

impl Layout {
    /// Pose at a height, without rotation.
    fn pose_at(&self, height: f64) -> Pose {
        Pose::new([self.middle[0], self.middle[1], height], [0.0; 3])
    }
}

/// Roll, pitch and yaw of a pose in degrees, rounded for a file.
fn angles(pose: &Pose) -> Vec3 {
    Vec3::from(rotation::to_roll_pitch_yaw_deg(&pose.rot_wp)).map(layout::rounded)
}

#[cfg(test)]
mod tests {
    use super::*;
    use funicular::robot::spec::TABLES;
    use funicular_study::names::Named;
    use funicular_study::request::SourceFile;

    fn made(request: &NewRequest) -> (Robot, NewRobot) {
        let new = run(request, Words::Program).unwrap_or_else(|error| panic!("{request:?}: {error:#}"));
        (Robot::from_toml(&new.text).unwrap_or_else(|error| panic!("{error}\n{}", new.text)), new)
    }

    fn csv(text: &str) -> NewRequest {
        let file = SourceFile { path: "points.csv".to_owned(), text: text.to_owned(), guessed_encoding: None };
        NewRequest { from_csv: Some(file), ..NewRequest::default() }
    }

    /// Solves the statics of the file independently of the search inside `run`.
    fn is_stable(robot: Robot, new: &NewRobot) -> bool {
        let source = RobotText { name: String::new(), text: new.text.clone(), set: Vec::new() };
        let found = at_rest::equilibrium(robot, &source, &State::default(), &Tensions::default()).unwrap();
        // The pose of the file is held, to the digits that it is written with.
        let held = found.requested_pose.is_none_or(|(_, distance)| distance < 1e-3);
        held && found.warnings(None).is_empty() && matches!(found.equilibrium.stability, Stability::Stable { .. })
    }

    #[test]
    fn every_number_of_cables_makes_a_stable_robot_without_warnings() {
        for (motion, fewest) in [(NewMotion::Rigid, 2), (NewMotion::PointMass, 1), (NewMotion::PlanarXz, 1)] {
            for cables in (fewest..=16).chain([33, MAX_CABLES]) {
                let (robot, new) = made(&NewRequest { cables: Some(cables), motion, ..NewRequest::default() });
                assert_eq!((robot.cables.len(), new.warnings.len()), (cables, 0), "{motion:?} {:?}", new.warnings);
                assert!(is_stable(robot, &new), "{motion:?}, {cables} cables:\n{}", new.text);
            }
        }
        let (robot, _) = made(&NewRequest::default());
        assert_eq!((robot.cables.len(), robot.platform.mass), (8, 100.0));
    }

    #[test]
    fn sizes_and_masses_over_decades_make_stable_robots() {
        for (mass_kg, box_m) in [(0.05, [0.1, 0.1, 0.05]), (5.0, [0.4, 0.2, 0.1]), (4000.0, [6.0, 2.0, 1.5])] {
            for cables in [4, 8] {
                let request = NewRequest {
                    mass_kg: Some(mass_kg),
                    box_m: Some(box_m),
                    cables: Some(cables),
                    ..NewRequest::default()
                };
                let (robot, new) = made(&request);
                assert!(new.warnings.is_empty(), "{:?}", new.warnings);
                let [a, b, c] = box_m;
                let expected = Vec3::new(b * b + c * c, a * a + c * c, a * a + b * b) * (mass_kg / 12.0);
                // The file has four digits.
                assert!((robot.platform.inertia_p.diagonal() - expected).amax() < 1e-3 * expected.amax());
                assert!(is_stable(robot, &new), "{}", new.text);
            }
        }
    }

    #[test]
    fn a_wire_rope_has_the_stiffness_of_its_metal_and_the_mass_of_the_norm() {
        for (rope, area, mass) in [(RopeType::SixTimes19, 0.449, 0.400), (RopeType::SevenTimes7, 0.432, 0.384)] {
            let (robot, _) = made(&NewRequest { rope, diameter_m: Some(0.01), ..NewRequest::default() });
            let material = &robot.cables[0].material;
            // 100 GPa on C d², W d² kg per 100 m with d in mm.
            assert!((material.axial_stiffness / (100e9 * area * 1e-4) - 1.0).abs() < 1e-9);
            assert!((material.mass_per_length / mass - 1.0).abs() < 1e-9);
        }
        // 6 mm for 100 kg; a heavy platform gets a thicker rope.
        let (robot, _) = made(&NewRequest::default());
        assert!((robot.cables[0].material.mass_per_length - 0.400 * 0.36).abs() < 1e-9);
        let (heavy, _) = made(&NewRequest { mass_kg: Some(5000.0), ..NewRequest::default() });
        assert!(heavy.cables[0].material.breaking_load.unwrap() > 20.0 * 5000.0 * 9.81);
    }

    #[test]
    fn a_fibre_rope_is_lighter_and_softer_than_a_wire_rope_and_states_its_sources() {
        let of = |rope| made(&NewRequest { rope, diameter_m: Some(0.01), ..NewRequest::default() });
        let ((fibre, new), (wire, _)) = (of(RopeType::Hmpe), of(RopeType::SixTimes19));
        assert!(new.warnings.is_empty() && is_stable(fibre.clone(), &new), "{:?}\n{}", new.warnings, new.text);
        let (fibre, wire) = (&fibre.cables[0].material, &wire.cables[0].material);
        assert!(fibre.mass_per_length < 0.15 * wire.mass_per_length);
        assert!((fibre.mass_per_length - 0.0496).abs() < 1e-9);
        assert_eq!(fibre.breaking_load, Some(58e3));

        // Below the EA of ropes in service, 56 breaking loads, and below that of the fibres alone, 109 GPa on their
        // area.
        assert!((fibre.axial_stiffness - 25.0 * 58e3).abs() < 1.0, "{}", fibre.axial_stiffness);
        assert!(fibre.axial_stiffness < 0.5 * 109e9 * fibre.mass_per_length / 970.0);
        for says in ["MoorPy", "CIS YA100", "cautious", "no measurement of such a rope"] {
            assert!(new.text.contains(says), "{says}: {}", new.text);
        }

        // The default diameter follows from the breaking load of the type.
        let (heavy, _) = made(&NewRequest { rope: RopeType::Hmpe, mass_kg: Some(5000.0), ..NewRequest::default() });
        assert!(heavy.cables[0].material.breaking_load.unwrap() > 20.0 * 5000.0 * 9.81);
    }

    #[test]
    fn every_commented_key_is_valid_when_it_is_given() {
        for motion in NewMotion::ALL {
            let (_, new) = made(&NewRequest { motion: *motion, ..NewRequest::default() });
            let keys = || TABLES.iter().flat_map(|table| table.keys);
            let mut commented = 0;
            for line in new.text.lines() {
                let Some(rest) = line.strip_prefix("# ") else { continue };
                let Some(key) = keys().find(|key| rest.starts_with(&format!("{} = ", key.name))) else { continue };
                commented += 1;
                let given = new.text.replacen(line, rest, 1);
                let of_gusts = ["turbulence", "intensity", "length_scale_m", "coherence_decay", "frozen_turbulence"];
                let of_ropes = ["shares_rope_with", "sheave_efficiency"];
                let excluding = ["viscous_damping_n_s_m2", "unstrained_length_m"];
                if of_gusts.iter().chain(&of_ropes).chain(&excluding).any(|of| *of == key.name) {
                    // It excludes a value that the file has, or needs others.
                    assert!(Robot::from_toml(&given).is_err());
                } else {
                    Robot::from_toml(&given).unwrap_or_else(|error| panic!("{line}: {error}"));
                }
            }
            assert!(commented > 12, "{motion:?}: {commented}\n{}", new.text);
            assert!(new.text.lines().all(|line| line.chars().count() <= 120), "{}", new.text);
        }
    }

    #[test]
    fn a_table_of_points_with_and_without_header_in_metres_and_millimetres_is_the_same_robot() {
        let rows = [
            ("a", [-4.0, -4.0, 6.0, -0.5, -0.5, 0.25]),
            ("b", [4.0, -4.0, 6.0, 0.5, -0.5, 0.25]),
            ("c", [4.0, 4.0, 6.0, 0.5, 0.5, 0.25]),
            ("d", [-4.0, 4.0, 6.0, -0.5, 0.5, 0.25]),
        ];
        let table = |named: bool, scale: f64| -> String {
            let line = |(name, numbers): &(&str, [f64; 6])| {
                let numbers: Vec<String> = numbers.iter().map(|number| format!("{}", number * scale)).collect();
                let name = if named { format!("{name}, ") } else { String::new() };
                format!("{name}{}", numbers.join(", "))
            };
            rows.iter().map(line).collect::<Vec<_>>().join("\n") + "\n"
        };
        let header = |unit: &str| {
            let column = |of: &str| ["x", "y", "z"].map(|axis| format!("{of}_{axis}{unit}")).join(",");
            format!("name,{},{}\n", column("anchor"), column("attachment"))
        };

        let (robot, new) = made(&csv(&table(true, 1.0)));
        assert!(new.warnings.is_empty() && is_stable(robot.clone(), &new), "{:?}\n{}", new.warnings, new.text);
        let names: Vec<&str> = robot.cables.iter().map(|cable| cable.name.as_str()).collect();
        assert_eq!(names, ["a", "b", "c", "d"]);
        assert_eq!(robot.cables[1].attachment_p, Vec3::new(0.5, -0.5, 0.25));

        for text in [
            header("") + &table(true, 1.0),
            header("_m") + "\n" + &table(true, 1.0),
            header("_mm") + &table(true, 1e3),
            // Columns in another order, found by their names.
            "attachment_z,name,anchor_x,anchor_y,anchor_z,attachment_x,attachment_y\n".to_owned()
                + &rows.map(|(name, [x, y, z, u, v, w])| format!("{w},{name},{x},{y},{z},{u},{v}")).join("\n"),
        ] {
            assert_eq!(made(&csv(&text)).0, robot, "{text}");
        }
        let in_millimetres = NewRequest { csv_unit: Some(LengthUnit::Millimetre), ..csv(&table(true, 1e3)) };
        assert_eq!(made(&in_millimetres).0, robot);
        let (numbered, _) = made(&csv(&table(false, 1.0)));
        assert_eq!(numbered.cables[3].name, "4");
        assert_eq!(numbered.cables[3].anchor, robot.cables[3].anchor);
    }

    #[test]
    fn the_whole_platform_starts_above_the_floor_of_its_anchors() {
        // Anchors of one height: far below them would be under the floor, z = 0.
        let table = |z: f64, below: f64| {
            let corner = |x: f64, y: f64| format!("{},{},{z},{},{},{below}\n", 4.0 * x, 4.0 * y, 0.5 * x, 0.5 * y);
            csv(&[corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)].concat())
        };
        for (z, below, box_m) in [
            (3.0, 0.0, Some([1.0, 1.0, 0.5])),
            (1.5, -1.0, None),
            (6.0, -0.5, None),
            (2.0, 0.25, Some([1.0, 1.0, 1.8])),
            (0.4, 0.0, Some([1.0, 1.0, 0.2])),
        ] {
            let (robot, new) = made(&NewRequest { box_m, mass_kg: Some(5.0), ..table(z, below) });
            assert!(new.warnings.is_empty() && is_stable(robot.clone(), &new), "{z} {below}: {:?}", new.warnings);
            let low = f64::min(below, -0.5 * box_m.map_or(0.0, |sides| sides[2]));
            assert!(new.pose.position_w.z + low > 0.0, "{z} {below}: {}\n{}", new.pose_line(), new.text);
        }

        // A coordinate below zero says that z = 0 is not the floor, and so do anchors without room below them.
        for z in [-1.0, 0.0] {
            let (_, new) = made(&table(z, 0.0));
            assert!(new.warnings.is_empty() && new.pose.position_w.z < z, "{:?}", new.warnings);
        }
        // The user's own pose is taken as it is.
        let pose = Some(funicular_study::request::Pose::Angles([0.0, 0.0, -1.0, 0.0, 0.0, 0.0]));
        let (_, new) = made(&NewRequest { pose, ..table(3.0, 0.0) });
        assert_eq!(
            new.pose_line(),
            "start pose: position (0.000, 0.000, -1.000) m, roll, pitch, yaw (0.00, 0.00, 0.00)°"
        );
    }

    #[test]
    fn a_table_that_cannot_be_read_is_refused_at_its_line() {
        let good = "1,4,4,6,1,1,0\n2,-4,4,6,-1,1,0\n";

        for (text, says) in [
            ("", "points.csv has no cables"),
            ("name,anchor_x\n", "points.csv, line 1: there is no column `anchor_y`"),
            ("1,2,3\n", "points.csv, line 1: 3 values"),
            (&(good.to_owned() + "3,0,-4,6,0,-1\n"), "points.csv, line 3: 6 values, but 7 in the first line"),
            (&(good.to_owned() + "\n3,0,-4,6,0,-1,\n"), "points.csv, line 4, attachment z: a number is missing"),
            (&(good.to_owned() + "3,0,-4,6 m,0,-1,0\n"), "points.csv, line 3, anchor z: `6 m` is not a number"),
            (&(good.to_owned() + "2,0,-4,6,0,-1,0\n"), "points.csv, line 3: a second cable \"2\""),
            ("1;4,0;4,0;6,0\n", "4 values, but at least 6 are needed"),
            (
                "name,anchor_x,anchor_y,anchor_z,attachment_x,attachment_y,attachement_z\n1,0,0,1,0,0,0\n",
                "did you mean `attachment_z`?",
            ),
            ("anchor_x_mm,anchor_y,anchor_z,attachment_x,attachment_y,attachment_z\n", "have different units"),
            ("1,4,4,6,0,0,0\n2,-4,4,6,0,0,0\n", "the attachments span no box"),
        ] {
            let error = run(&csv(text), Words::Program).unwrap_err().to_string();
            assert!(error.contains(says), "{text:?}: {error}");
        }

        let contrary = "anchor_x_m,anchor_y_m,anchor_z_m,attachment_x_m,attachment_y_m,attachment_z_m\n0,0,1,0,0,0\n";
        let request = NewRequest { csv_unit: Some(LengthUnit::Millimetre), ..csv(contrary) };
        let error = worded(&run(&request, Words::Program).unwrap_err().to_string(), Words::Program);
        assert!(error.contains("--csv-unit is mm, but the columns are in m"), "{error}");
    }

    #[test]
    fn a_robot_that_its_cables_do_not_hold_is_written_with_a_warning() {
        // All anchors are far below every pose that is tried.
        let request = NewRequest {
            pose: Some(funicular_study::request::Pose::Angles([0.0, 0.0, 9.0, 0.0, 0.0, 0.0])),
            ..NewRequest::default()
        };
        let (_, new) = made(&request);
        assert!(new.warnings[0].contains("give another --pose"), "{:?}", new.warnings);

        let (_, new) = made(&csv("4000,4000,6000,500,500,0\n-4000,4000,6000,-500,500,0\n0,-4000,6000,0,-500,0\n"));
        assert!(new.warnings[0].contains("--csv-unit mm"), "{:?}", new.warnings);
    }

    #[test]
    fn options_that_exclude_each_other_and_numbers_out_of_range_are_refused() {
        let new = NewRequest::default;

        for (request, says) in [
            (NewRequest { cables: Some(1), ..new() }, "--cables 1: one cable does not keep"),
            (NewRequest { cables: Some(0), ..new() }, "--cables 0: give 2 to 64 cables"),
            (NewRequest { cables: Some(65), motion: NewMotion::PlanarXz, ..new() }, "--cables 65: give 1 to 64 cables"),
            (NewRequest { cables: Some(3), ..csv("1,2,3,4,5,6\n") }, "leave --cables out"),
            (NewRequest { csv_unit: Some(LengthUnit::Metre), ..new() }, "--csv-unit is the unit of the table"),
            (NewRequest { axial_stiffness_n: Some(1e6), ..new() }, "give --mass-kg-per-m"),
            (NewRequest { mass_kg_per_m: Some(0.1), ..new() }, "goes with --axial-stiffness-n"),
            (NewRequest { axial_stiffness_n: Some(1e6), diameter_m: Some(0.01), ..new() }, "leave one of them out"),
            (NewRequest { mass_kg: Some(-1.0), ..new() }, "--mass-kg: -1 is not positive"),
            (NewRequest { box_m: Some([1.0, 0.0, 1.0]), ..new() }, "--box-m: 0 is not positive"),
            (NewRequest { box_m: Some([1.0, 1e4, 1.0]), ..new() }, "--box-m: 10000 is not between 0.001 and 1000 m"),
            (
                NewRequest { box_m: Some([1.0, 1.0, 1.0]), motion: NewMotion::PointMass, ..new() },
                "a point mass has no box",
            ),
        ] {
            let error = run(&request, Words::Program).map_err(|error| worded(&error.to_string(), Words::Program));
            let error = error.unwrap_err();
            assert!(error.contains(says), "{request:?}: {error}");
        }
    }
}
