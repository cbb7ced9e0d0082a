//! First natural frequency alone against the first mode of the complete list.

mod with_drives;

use crate::library::library;
use crate::random::campaign::robots::{self, Purpose};
use funicular::dynamics::{Dynamics, DynamicsError, Linearisation};
use funicular::modes::{self, First, FirstError};
use funicular::robot::{Cable, Pose, Robot};
use funicular::statics::{self, Equilibrium, Stability, StaticModel};
use proptest::prelude::*;
use std::f64::consts::TAU;

const YUAN: &str = funicular_robots::YUAN2014_4MM;

/// Fault of the first mode of a robot, compared with the list up to a tenth above it; energies with the usual accuracy.
fn fault(robot: &Robot, rest: &Equilibrium, first: &First) -> Option<String> {
    fault_beyond(robot, rest, first, &ErrorBounds { energy: |_| 1e-6, stiffest: 0.0 })
}

/// Maximum errors of a first mode.
struct ErrorBounds {
    /// Error of the energies as a function of the relative distance to the next frequency.
    energy: fn(f64) -> f64,
    /// Stiffness of the stiffest spring [N/m], whose rounding changes the frequency; 0 to leave it out.
    stiffest: f64,
}

/// Rounding of a soft motion's stiffness over the stiffest spring: the elimination of some fifty unknowns, twice. A
/// drum of 1 kg at constant torque behind 14 cm of a steel rope of 2e7 N leaves 140 units in the last place, found by
/// comparison with longer ropes.
const STIFFNESS_ROUNDING: f64 = 128.0 * f64::EPSILON;

/// Fault of the first mode beyond some bounds.
fn fault_beyond(robot: &Robot, rest: &Equilibrium, first: &First, bounds: &ErrorBounds) -> Option<String> {
    let limit = 1.1 * first.frequency_hz;
    let all = modes::below(&Dynamics::about(robot, rest, Linearisation::default(), limit).unwrap(), limit);
    let Some(mode) = all.modes.first() else { return Some(format!("none below {limit} Hz")) };
    let off = (first.frequency_hz / mode.frequency_hz - 1.0).abs();
    let modal_stiffness = (TAU * mode.frequency_hz).powi(2) * mode.modal_mass;
    if !first.certified || off > 1e-9 + STIFFNESS_ROUNDING * bounds.stiffest / modal_stiffness {
        return Some(format!("{} Hz is {off:e} off", first.frequency_hz));
    }
    let of_drives: f64 = first.drive_energy_fractions.iter().sum();
    let total = first.platform_energy_fraction + first.cable_energy_fractions.iter().sum::<f64>() + of_drives;
    if (total - 1.0).abs() > 1e-12 {
        return Some(format!("energies sum to {total}"));
    }
    // If two modes are near each other, the first may be any mixture of both.
    let apart = all.modes.get(1).map_or(1.0, |next| next.frequency_hz / mode.frequency_hz - 1.0);
    if apart < 1e-3 {
        return None;
    }
    let drives = (of_drives - mode.drive_energy_fractions.iter().sum::<f64>()).abs();
    let energy = (first.platform_energy_fraction - mode.platform_energy_fraction).abs().max(drives);
    let shape = first.shape.iter().zip(&mode.shape).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let size = mode.shape.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
    // In a mode of a cable alone the platform hardly moves, and another of its components may be the largest.
    let moves = mode.platform_energy_fraction > 1e-6;
    (energy > (bounds.energy)(apart) || first.kind != mode.kind || (moves && shape > 1e-4 * size))
        .then(|| format!("energy {energy:e}, shape {shape:e} off, {apart:e} from the next mode"))
}

#[test]
fn the_first_frequency_of_every_robot_of_the_library_is_that_of_the_whole_list() {
    for (name, robot, rest) in library() {
        let first = modes::first(&robot, &rest).unwrap();
        assert_eq!(fault(&robot, &rest, &first), None, "{name}");
    }
}

#[test]
fn the_first_frequency_of_random_robots_is_that_of_the_whole_list() {
    let mut compared = 0;
    for index in 0..200 {
        let sample = robots::sample(index);
        if sample.purpose != Purpose::Proper {
            continue;
        }
        let start = Some(&sample.pose);
        let Ok(rest) = statics::forward(&sample.robot, &sample.lengths, StaticModel::Catenary, start) else { continue };
        if !matches!(rest.stability, Stability::Stable { .. }) {
            continue;
        }
        match modes::first(&sample.robot, &rest) {
            Ok(first) => {
                assert_eq!(fault(&sample.robot, &rest, &first), None, "robot {index} ({:?})", sample.arrangement);
                compared += 1;
            }
            Err(refused) => {
                let all = Dynamics::about(&sample.robot, &rest, Linearisation::default(), sample.below_hz);
                assert_eq!(refused, FirstError::Dynamics(all.unwrap_err()), "robot {index}");
            }
        }
    }
    assert!(compared > 150, "{compared}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..Default::default() })]

    /// At half of these poses a cable hangs nearly without tension in a loop, which has the first frequency.
    #[test]
    fn the_first_frequency_of_the_papers_robot_is_that_of_the_whole_list_at_any_pose(
        x in -3.0f64..3.0, y in -1.2f64..1.2, z in 0.0f64..2.4, turn in prop::array::uniform3(-3.0f64..3.0),
    ) {
        let robot = Robot::from_toml(YUAN).unwrap();
        let held = statics::inverse(&robot, &Pose::new([x, y, z], turn), StaticModel::Catenary);
        prop_assume!(held.is_ok());
        let rest = held.unwrap();
        prop_assume!(matches!(rest.stability, Stability::Stable { .. }));
        let first = modes::first(&robot, &rest).unwrap();
        // The bound that follows from the frequency's width of 5e-10.
        let bounds = ErrorBounds { energy: |apart| 2.0 * (5e-10 / apart).sqrt(), stiffest: 0.0 };
        prop_assert_eq!(fault_beyond(&robot, &rest, &first, &bounds), None);
    }
}

/// Plate in the xz plane on four cables that cross each other, two of them from below, and its equilibrium.
fn plate(rope_mass: f64) -> (Robot, Equilibrium) {
    let robot = Robot::from_toml(&format!(
        "name = \"plate\"\n[platform]\nmotion = \"planar-xz\"\nmass_kg = 8.0\ninertia_kg_m2 = 0.3\n\
         [materials.rope]\naxial_stiffness_n = 5e4\nmass_kg_per_m = {rope_mass}\n\
         [[cables]]\nname = \"1\"\nmaterial = \"rope\"\nanchor_m = [-2.0, 0.0, 3.0]\nattachment_m = [-0.3, 0.0, -0.2]\n\
         [[cables]]\nname = \"2\"\nmaterial = \"rope\"\nanchor_m = [2.5, 0.0, 3.2]\nattachment_m = [0.3, 0.0, -0.2]\n\
         [[cables]]\nname = \"3\"\nmaterial = \"rope\"\nanchor_m = [-2.0, 0.0, -2.0]\nattachment_m = [-0.3, 0.0, 0.2]\n\
         [[cables]]\nname = \"4\"\nmaterial = \"rope\"\nanchor_m = [2.5, 0.0, -2.0]\nattachment_m = [0.3, 0.0, 0.2]\n"
    ))
    .unwrap();
    let pose = Pose::new([0.1, 0.0, 0.4], [0.0; 3]);
    let chord = |cable: &Cable| cable.chord_w(&pose).norm();
    let lengths: Vec<f64> = robot.cables.iter().map(|cable| 0.998 * chord(cable)).collect();
    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, Some(&pose)).unwrap();
    (robot, rest)
}

#[test]
fn a_planar_platform_may_have_its_first_frequency_in_a_cable_that_swings_out_of_the_plane() {
    let (robot, rest) = plate(0.3);
    let first = modes::first(&robot, &rest).unwrap();
    assert_eq!(fault(&robot, &rest, &first), None);
    assert!(first.platform_energy_fraction < 1e-12, "{first:?}");
    assert!(first.shape.iter().all(|part| *part == 0.0), "{first:?}");
}

#[test]
fn with_massless_cables_the_platform_alone_vibrates() {
    let (robot, rest) = plate(0.0);
    let first = modes::first(&robot, &rest).unwrap();
    assert_eq!(fault(&robot, &rest, &first), None);
    assert_eq!(first.kind, modes::Kind::Platform);
}

#[test]
fn an_unstable_equilibrium_has_the_first_frequency_of_the_list_and_says_so() {
    let robot = Robot::from_toml(&YUAN.replace("center_of_mass_m = [0.0, 0.0, 0.0]", "center_of_mass_m = [0, 0, 8]"));
    let pose = Pose::new([0.3, -0.2, 0.7], [0.0; 3]);
    let (robot, model) = (robot.unwrap(), StaticModel::Catenary);
    let rest = statics::inverse(&robot, &pose, model).unwrap();
    assert!(matches!(rest.stability, Stability::Unstable { .. }), "{:?}", rest.stability);
    let first = modes::first(&robot, &rest).unwrap();
    let limit = 1.1 * first.frequency_hz;
    let all = modes::below(&Dynamics::about(&robot, &rest, Linearisation::default(), limit).unwrap(), limit);
    assert!(first.unstable_directions > 0);
    assert_eq!(first.unstable_directions, all.unstable_directions);
    assert!((first.frequency_hz / all.modes[0].frequency_hz - 1.0).abs() < 1e-12);
}

#[test]
fn a_cable_without_tension_is_named() {
    let robot = Robot::from_toml(&YUAN.replacen("mass_kg_per_m = 0.067", "mass_kg_per_m = 0.0", 1)).unwrap();
    let pose = Pose::new([0.3, -0.2, 0.7], [0.0; 3]);
    let mut rest = statics::inverse(&robot, &pose, StaticModel::Spring).unwrap();
    let lengths: Vec<f64> =
        rest.cables.iter().enumerate().map(|(i, c)| c.unstrained_length + if i == 2 { 2.0 } else { 0.0 }).collect();
    rest = statics::forward(&robot, &lengths, StaticModel::Spring, Some(&pose)).unwrap();
    let refused = modes::first(&robot, &rest).unwrap_err();
    assert!(
        matches!(refused, FirstError::Dynamics(DynamicsError::NoTension { ref cable, .. }) if cable == "3"),
        "{refused}"
    );
}

#[test]
fn ideal_cables_have_no_first_frequency() {
    let robot = Robot::from_toml(YUAN).unwrap();
    let rest = statics::inverse(&robot, &Pose::new([0.3, -0.2, 0.7], [0.0; 3]), StaticModel::Ideal).unwrap();
    assert_eq!(modes::first(&robot, &rest), Err(FirstError::Dynamics(DynamicsError::Rigid)));
}
