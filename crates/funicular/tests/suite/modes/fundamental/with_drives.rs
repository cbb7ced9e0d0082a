//! First natural frequency of robots with pulleys and winches against the first mode of the complete list.

use super::{ErrorBounds, fault, fault_beyond};
use crate::random::campaign::robots::{self, Arrangement, Purpose};
use funicular::dynamics::{Dynamics, DynamicsError, Linearisation};
use funicular::math::Vec3;
use funicular::modes::{self, FirstError};
use funicular::robot::{Control, DrumSide, GuideWheel, Pose, Pulley, Robot, Servo, Winch, WinchLimits};
use funicular::statics::{self, Equilibrium, Stability, StaticModel};
use proptest::prelude::*;

/// CoGiRo, whose cables come up to pulleys of 5 cm from winches below, with motors that hold their angles.
const COGIRO: &str = funicular_robots::COGIRO_WINCHES;

const RIGID: Winch = Winch {
    name: String::new(),
    drum_radius: None,
    gear_ratio: 1.0,
    gear_efficiency: 1.0,
    drum_side_length: 5.0,
    drum_side: DrumSide::Massless,
    guide_wheels: Vec::new(),
    stiffness: f64::INFINITY,
    drum_mass: 0.0,
    motor_mass: 0.0,
    damping: 0.0,
    control: Control::Ideal,
    limits: WinchLimits::NONE,
};

fn servo(position_gain: f64) -> Control {
    Control::Position(Servo { position_gain, speed_gain: 100.0, integral: true, delay: 0.0 })
}

/// CoGiRo with this winch, and with wheels and swivels of these inertias [kg m²].
fn cogiro(winch: Option<&Winch>, inertia: f64, swivel_inertia: f64) -> Robot {
    let mut robot = Robot::from_toml(COGIRO).unwrap();
    for cable in &mut robot.cables {
        cable.anchor.winch = winch.cloned();
        let pulley = cable.anchor.pulley.as_mut().unwrap();
        (pulley.inertia, pulley.swivel_inertia) = (inertia, swivel_inertia);
    }
    robot
}

/// Maximum errors of the first mode: of its energies by the width of the frequency, 5e-10, and by the rounding of the
/// stiffest spring, the shortest piece of cable, against which motors at constant torque are soft.
fn bounds(robot: &Robot) -> ErrorBounds {
    let stiffest = robot.cables.iter().map(|cable| {
        let side = cable.anchor.winch.as_ref().map_or(f64::INFINITY, |winch| winch.drum_side_length);
        let shortest = if side > 0.0 { side.min(1.0) } else { 1.0 };
        cable.material.axial_stiffness / shortest
    });
    ErrorBounds { energy: |apart| 1e-6_f64.max(2.0 * (5e-10 / apart).sqrt()), stiffest: stiffest.fold(0.0, f64::max) }
}

fn at(robot: &Robot, position: [f64; 3]) -> Equilibrium {
    statics::inverse(robot, &Pose::new(position, [0.0, 0.0, 2.0]), StaticModel::Catenary).unwrap()
}

/// Two guide wheels of this mass [kg] on the drum side.
fn guides(mass: f64) -> Vec<GuideWheel> {
    [1.2, 4.0].map(|distance| GuideWheel { name: String::new(), distance, mass }).to_vec()
}

/// Winches of all kinds, each with the kind of its first mode at the centre of the workspace.
#[test]
fn every_kind_of_drive_has_the_first_frequency_of_the_whole_list() {
    let heavy = Winch { drum_mass: 20.0, motor_mass: 40.0, ..RIGID };
    let rod = DrumSide::Rod;
    let winches = [
        ("no winch", None),
        ("held", Some(RIGID)),
        ("held, rod", Some(Winch { drum_side: rod, ..RIGID })),
        ("shaft", Some(Winch { stiffness: 5e4, ..RIGID })),
        ("shaft and drum", Some(Winch { stiffness: 5e4, drum_mass: 20.0, ..RIGID })),
        ("servo", Some(Winch { control: servo(5e4), ..heavy.clone() })),
        ("servo without mass", Some(Winch { control: servo(5e4), ..RIGID })),
        ("soft servo", Some(Winch { control: servo(1e3), ..heavy.clone() })),
        ("stiff servo, rod", Some(Winch { control: servo(1e9), drum_side: rod, ..heavy.clone() })),
        ("torque", Some(Winch { control: Control::Torque, ..heavy.clone() })),
        ("torque without mass", Some(Winch { control: Control::Torque, ..RIGID })),
        (
            "torque, shaft, rod",
            Some(Winch { control: Control::Torque, stiffness: 1e6, drum_side: rod, ..heavy.clone() }),
        ),
        ("very heavy drum", Some(Winch { stiffness: 2e5, drum_mass: 1e5, ..RIGID })),
        (
            "very heavy motor",
            Some(Winch { control: servo(1e4), stiffness: 1e6, drum_mass: 5.0, motor_mass: 1e4, ..RIGID }),
        ),
        ("guide wheels", Some(Winch { guide_wheels: guides(2.0), ..RIGID })),
        (
            "heavy guide wheels, torque, rod",
            Some(Winch { control: Control::Torque, drum_side: rod, guide_wheels: guides(500.0), ..heavy.clone() }),
        ),
        ("drum at the pulley", Some(Winch { control: servo(5e4), drum_side_length: 0.0, ..heavy })),
    ];
    let wheels = [(0.0, 0.0), (5e-4, 3e-3), (2.0, 0.0), (0.0, 5.0)];

    for (name, winch) in &winches {
        for (inertia, swivel_inertia) in wheels {
            let robot = cogiro(winch.as_ref(), inertia, swivel_inertia);
            for position in [[0.0, 0.0, 1.5], [-4.0, 2.5, 1.0]] {
                let rest = at(&robot, position);
                let label = format!("{name}, wheel {inertia}, swivel {swivel_inertia}, at {position:?}");
                match modes::first(&robot, &rest) {
                    Ok(first) if first.unstable_directions == 0 => {
                        assert_eq!(fault_beyond(&robot, &rest, &first, &bounds(&robot)), None, "{label}");
                    }
                    // With constant torque and without mass, nothing but the cable's weight holds a motor.
                    other => assert!(name.starts_with("torque without"), "{label}: {other:?}"),
                }
            }
        }
    }
}

#[test]
fn the_drives_of_heavy_drums_have_the_first_mode() {
    let winch = Winch { stiffness: 2e5, drum_mass: 1e5, ..RIGID };
    let robot = cogiro(Some(&winch), 0.0, 0.0);
    let first = modes::first(&robot, &at(&robot, [0.0, 0.0, 1.5])).unwrap();
    assert_eq!(first.kind, modes::Kind::Drive);
    // Drums on their shafts: eight of them can move six degrees of freedom of the platform without stretching a cable.
    let alone = (2e5_f64 / 1e5).sqrt() / std::f64::consts::TAU;
    assert!((first.frequency_hz / alone - 1.0).abs() < 1e-3, "{}", first.frequency_hz);
}

/// Plate in space on six cables without mass, each to a winch with a motor.
#[test]
fn cables_without_mass_have_the_modes_of_their_drives() {
    let text = COGIRO.replace("mass_kg_per_m = 0.064", "mass_kg_per_m = 0.0");
    let mut robot = Robot::from_toml(&text).unwrap();
    for winch in [
        RIGID,
        Winch { motor_mass: 40.0, control: servo(5e4), ..RIGID },
        Winch { stiffness: 1e5, drum_mass: 300.0, ..RIGID },
    ] {
        for swivel_inertia in [0.0, 3e-3] {
            for cable in &mut robot.cables {
                cable.anchor.winch = Some(winch.clone());
                cable.anchor.pulley.as_mut().unwrap().swivel_inertia = swivel_inertia;
            }
            let rest = at(&robot, [1.0, 1.0, 1.5]);
            let first = modes::first(&robot, &rest).unwrap();
            assert_eq!(fault(&robot, &rest, &first), None, "{winch:?}, swivel {swivel_inertia}");
        }
    }
}

/// Some cables with drives, some without, one of them without mass.
#[test]
fn cables_with_and_without_drives_share_a_robot() {
    let mut robot = cogiro(Some(&Winch { motor_mass: 40.0, control: servo(5e4), ..RIGID }), 5e-4, 3e-3);
    for (i, cable) in robot.cables.iter_mut().enumerate() {
        match i {
            0 | 3 => (cable.anchor.pulley, cable.anchor.winch) = (None, None),
            1 => cable.anchor.pulley = None,
            2 => cable.anchor.winch = None,
            5 => cable.material.mass_per_length = 0.0,
            _ => {}
        }
    }
    let rest = at(&robot, [-1.0, 1.0, 1.5]);
    let first = modes::first(&robot, &rest).unwrap();
    assert_eq!(fault(&robot, &rest, &first), None);
    assert!(first.drive_energy_fractions.len() == 8 && first.drive_energy_fractions[0] == 0.0, "{first:?}");
}

/// The end of the cable couples its motions in plane and out of plane.
#[test]
fn pulleys_that_do_not_swivel_about_the_load_have_the_first_frequency_of_the_whole_list() {
    let mut robot = cogiro(Some(&RIGID), 0.0, 3e-3);
    robot.gravity_w = Vec3::new(1.0, 0.0, -9.0);
    let rest = at(&robot, [0.0, 0.0, 1.5]);
    let first = modes::first(&robot, &rest).unwrap();
    assert_eq!(fault(&robot, &rest, &first), None);
}

/// Number in a range, uniformly distributed in the logarithm.
fn decades(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..high).prop_map(|exponent| 10f64.powf(exponent))
}

prop_compose! {
    /// Winch over the whole range of its numbers, zero included.
    fn any_winch()(
        side in decades(-1.0, 1.0), is_rod: bool, shaft in prop::option::of(decades(3.0, 7.0)),
        drum in prop::option::of(decades(-1.0, 3.0)), motor in prop::option::of(decades(-1.0, 3.0)),
        control in prop_oneof![Just(Control::Ideal), Just(Control::Torque), decades(3.0, 7.0).prop_map(servo)],
    ) -> Winch {
        Winch {
            drum_side_length: side,
            drum_side: if is_rod { DrumSide::Rod } else { DrumSide::Massless },
            stiffness: shaft.unwrap_or(f64::INFINITY),
            drum_mass: drum.unwrap_or(0.0),
            motor_mass: motor.unwrap_or(0.0),
            control,
            ..RIGID
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 80, failure_persistence: None, max_global_rejects: 100_000,
        ..Default::default() })]

    #[test]
    fn the_first_frequency_of_random_robots_with_drives_is_that_of_the_whole_list(
        index in 0u64..2000, winches in prop::collection::vec(prop::option::of(any_winch()), 3),
        size in decades(-3.0, -1.5),
        inertia in prop::option::of(decades(-6.0, 0.0)), swivel in prop::option::of(decades(-6.0, 0.0)),
        pulleys in 1usize..8,
    ) {
        let sample = robots::sample(index);
        prop_assume!(sample.purpose == Purpose::Proper);
        let mut robot = sample.robot;
        let up_w = -robot.gravity_w.normalize();
        let (count, extent) = (robot.cables.len(), robot.cables[0].chord_w(&sample.pose).norm());
        for (i, cable) in robot.cables.iter_mut().enumerate() {
            // Mirrored cables get the same drive, so that frequencies stay multiple.
            let kind = if sample.arrangement == Arrangement::Symmetric { 0 } else { i };
            cable.anchor.winch = winches[kind % winches.len()].clone();
            cable.anchor.pulley = (pulleys >> (kind % 3) & 1 == 1).then(|| Pulley {
                name: String::new(),
                radius: size * extent,
                entry_direction_w: up_w,
                inertia: inertia.unwrap_or(0.0),
                swivel_inertia: swivel.unwrap_or(0.0),
                friction: None,
            });
        }
        let held = statics::inverse(&robot, &sample.pose, StaticModel::Catenary);
        prop_assume!(held.is_ok());
        let rest = held.unwrap();
        prop_assume!(matches!(rest.stability, Stability::Stable { .. }));
        let context = || format!("robot {index} ({:?}) with {count} cables", sample.arrangement);

        match modes::first(&robot, &rest) {
            Ok(first) => {
                prop_assume!(first.unstable_directions == 0);
                prop_assert_eq!(fault_beyond(&robot, &rest, &first, &bounds(&robot)), None, "{}", context());
            }
            Err(FirstError::Dynamics(refused)) => {
                let all = Dynamics::about(&robot, &rest, Linearisation::default(), sample.below_hz);
                prop_assert_eq!(refused, all.err().unwrap_or(DynamicsError::Rigid), "{}", context());
            }
            Err(none) => prop_assert!(false, "{}: {none}", context()),
        }
    }

    /// Poses at which cables of the paper's robot hang in loops over their pulleys.
    #[test]
    fn slack_cables_over_pulleys_have_the_first_frequency_of_the_whole_list(
        x in -3.0f64..3.0, y in -1.2f64..1.2, z in 0.0f64..2.4, turn in prop::array::uniform3(-3.0f64..3.0),
        winch in any_winch(),
        swivel in prop::option::of(decades(-5.0, -2.0)),
    ) {
        let mut robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
        for cable in &mut robot.cables {
            cable.anchor.winch = Some(winch.clone());
            cable.anchor.pulley = Some(Pulley {
                name: String::new(),
                radius: 0.05,
                entry_direction_w: Vec3::z(),
                inertia: 1e-4,
                swivel_inertia: swivel.unwrap_or(0.0),
                friction: None,
            });
        }
        let held = statics::inverse(&robot, &Pose::new([x, y, z], turn), StaticModel::Catenary);
        prop_assume!(held.is_ok());
        let rest = held.unwrap();
        prop_assume!(matches!(rest.stability, Stability::Stable { .. }));
        if let Ok(first) = modes::first(&robot, &rest) {
            prop_assume!(first.unstable_directions == 0);
            prop_assert_eq!(fault_beyond(&robot, &rest, &first, &bounds(&robot)), None);
        }
    }
}
