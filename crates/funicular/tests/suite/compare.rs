//! Cable models side by side.

use funicular::cable::CableModel;
use funicular::cable::catenary_dynamic::CatenaryDynamicError;
use funicular::catenary::Rope;
use funicular::catenary::space::HangingCable;
use funicular::compare::{self, Criterion};
use funicular::dynamics::{Dynamics, DynamicsError, Linearisation};
use funicular::math::Vec3;
use funicular::modes;
use funicular::robot::{Robot, State};
use funicular::statics::{self, StaticModel};

#[test]
fn the_reference_is_shallow_dynamic_if_catenary_dynamic_cables_need_too_many_unknowns() {
    let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
    let State::Lengths(mut lengths) = robot.state.clone() else { panic!("given by lengths") };
    let reference = |lengths: &[f64], below_hz: f64| {
        let rest = statics::forward(&robot, lengths, StaticModel::Catenary, None).unwrap();
        compare::compare(&robot, &rest, below_hz, Linearisation::default(), Criterion::default()).unwrap()
    };
    let usual = reference(&lengths, 5.0);
    assert_eq!((usual.reference, usual.advice.model), (CableModel::CatenaryDynamic, CableModel::ShallowDynamic));
    // A rope of twice its length has hundreds of resonances below 60 Hz.
    lengths[0] = 14.0;
    let slack = reference(&lengths, 60.0);
    assert_eq!(slack.reference, CableModel::ShallowDynamic);
    let catenary_dynamic = slack.models.iter().find(|m| m.model == CableModel::CatenaryDynamic).unwrap();
    assert!(catenary_dynamic.modes.as_ref().unwrap_err().to_string().contains("unknowns for one cable"));
}

#[test]
fn a_cable_without_tension_is_reported_and_not_hidden_behind_another_reference() {
    let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
    let mut rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;

    // A loop that hangs straight down: its chord is 1 m high and 1 nm wide, its length 3 m. The horizontal force is
    // 1e-11 of the weight, and parallel to the chord there still is a tension, so that the shallow-dynamic model
    // exists.
    let rope = Rope { unstrained_length: 3.0, ..rest.cables[0].hanging.as_ref().unwrap().catenary.rope() };
    let start_w = rest.cables[0].attachment_w;
    let end_w = start_w + Vec3::new(1e-9, 0.0, 1.0);
    rest.cables[0].anchor_w = end_w;
    rest.cables[0].hanging = Some(HangingCable::new(start_w, end_w, Vec3::z(), rope).unwrap());
    let linearised = |cable_model| {
        Dynamics::about(&robot, &rest, Linearisation { cable_model, ..Linearisation::default() }, 1.0).map(|_| ())
    };
    assert_eq!(linearised(CableModel::ShallowDynamic), Ok(()));

    let refused = compare::compare(&robot, &rest, 1.0, Linearisation::default(), Criterion::default()).unwrap_err();
    let reason = CatenaryDynamicError::NoTension;
    assert_eq!(refused, DynamicsError::CatenaryDynamic { cable: robot.cables[0].name.clone(), reason });
    assert_eq!(linearised(CableModel::CatenaryDynamic), Err(refused));
}

/// Largest number of modes that the test compares.
const MAX_COMPARED: usize = 60;

/// The table, the verdict and the advice speak of the same pairs.
#[test]
fn a_model_within_a_tolerance_has_no_larger_difference() {
    for (name, robot, rest) in super::library::library() {
        for criterion in [
            Criterion::default(),
            Criterion { tolerance: 0.006, platform_share: None },
            Criterion { platform_share: Some(0.5), ..Criterion::default() },
        ] {
            for below_hz in [0.7, 1.5, 2.6, 4.9] {
                // Long cables have hundreds of modes there, which take long.
                let with = Linearisation { cable_model: CableModel::ShallowDynamic, ..Linearisation::default() };
                let Ok(shallow) = Dynamics::about(&robot, &rest, with, below_hz) else { continue };
                if modes::check_count(&shallow, below_hz, MAX_COMPARED).is_err() {
                    continue;
                }
                let Ok(found) = compare::compare(&robot, &rest, below_hz, Linearisation::default(), criterion) else {
                    continue;
                };
                for model in found.models.iter().filter(|model| model.modes.is_ok()) {
                    let says = format!("{name}, {} below {below_hz} Hz, {criterion:?}", model.model);
                    let near = |m: &&compare::Match| m.relative_difference.abs() <= criterion.tolerance;
                    if model.model == found.reference {
                        continue;
                    }
                    assert_eq!(model.within, model.matches.iter().filter(near).count(), "{says}");
                    assert_eq!(model.missed, found.compared.len() - model.matches.len(), "{says}");
                    let is_enough = model.within == found.compared.len();
                    assert_eq!(model.first_wrong_hz.is_none(), is_enough, "{says}");
                    if is_enough {
                        let largest = model.largest_difference.unwrap_or(0.0).abs();
                        assert!(largest <= criterion.tolerance, "{says}: {largest}");
                    }
                }
            }
        }
    }
}
