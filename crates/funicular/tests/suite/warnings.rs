//! Warnings about results outside the range of a model.

mod plausibility;

use crate::library::at_rest;
use funicular::cable::{CableModel, EndStiffness};
use funicular::math::Vec3;
use funicular::robot::{Robot, WinchMode};
use funicular::statics::StaticModel;
use funicular::warnings::{self, Warning};
use std::f64::consts::TAU;

#[test]
fn cables_are_warned_about_outside_the_models_range() {
    let robot = Robot::from_toml(funicular_robots::YUAN2014_8MM).unwrap();
    let rest = at_rest(&robot);
    let warnings = warnings::of_dynamics(&robot, &rest, CableModel::ShallowDynamic, 20.0);
    let [Warning::DeepSag { cables, .. }] = &warnings[..] else { panic!("{warnings:?}") };
    assert!(cables.iter().all(|deep| deep.ratio > 0.05 && deep.ratio < 0.07));
    for deep in cables {
        // The error measured here: first clamped frequency in plane of both models.
        let i = robot.cables.iter().position(|cable| cable.name == deep.cable).unwrap();
        let first = |cable_model| {
            let one =
                EndStiffness::new(&robot, i, &rest.cables[i], cable_model, true, WinchMode::AsGiven, 5.0).unwrap();
            let EndStiffness::Dynamic(form) = one else { panic!("it vibrates") };
            form.clamped_frequencies_below(5.0 * TAU)[0]
        };
        let error = first(CableModel::ShallowDynamic) / first(CableModel::CatenaryDynamic) - 1.0;
        assert!((deep.error.unwrap() - error).abs() < 1e-9 && error.abs() > 0.01, "{deep:?}");
        assert!(warnings[0].to_string().contains(&format!("first frequency off by {:+.1} %", 100.0 * error)));
    }
    let names: Vec<&str> = cables.iter().map(|deep| deep.cable.as_str()).collect();
    assert_eq!(names, ["5", "6"], "the long cables sag by some 6 % of the chord");
    assert!(warnings[0].to_string().contains("the limit is 1/20"));
    assert!(warnings::of_dynamics(&robot, &rest, CableModel::CatenaryStatic, 20.0).is_empty());
    let axial = warnings::of_dynamics(&robot, &rest, CableModel::Spring, 60.0);
    assert!(matches!(&axial[..], [Warning::AxialWaves { .. }]), "{axial:?}");
}

#[test]
fn warnings_about_one_cable_are_those_of_the_robot_that_name_it() {
    let robot = Robot::from_toml(funicular_robots::YUAN2014_8MM).unwrap();
    for (model, below_hz) in [(CableModel::ShallowDynamic, 20.0), (CableModel::Spring, 60.0)] {
        let rest = at_rest(&robot);
        let of_robot = warnings::of_dynamics(&robot, &rest, model, below_hz);
        let of_cables: Vec<Vec<Warning>> =
            (0..robot.cables.len()).map(|i| warnings::of_cable(&robot, &rest, i, model, below_hz)).collect();
        assert!(!of_robot.is_empty());
        for warning in &of_robot {
            match warning {
                Warning::DeepSag { cables, .. } => {
                    let single = of_cables.iter().flatten().filter_map(|warning| match warning {
                        Warning::DeepSag { cables, .. } => Some(cables.clone()),
                        _ => None,
                    });
                    assert_eq!(&single.flatten().collect::<Vec<_>>(), cables);
                }
                Warning::AxialWaves { .. } => assert!(of_cables.iter().flatten().any(|single| single == warning)),
                other => panic!("{other}"),
            }
        }
    }

    // A cable without force. The remedy, its own weight, is one that ideal cables do not have.
    for (model, warned) in [(StaticModel::Spring, true), (StaticModel::Ideal, false)] {
        let mut rest = at_rest(&robot);
        rest.model = model;
        (rest.cables[2].hanging, rest.cables[2].tension_platform, rest.cables[2].tension_anchor) = (None, 0.0, 0.0);
        rest.cables[2].force_on_platform_w = Vec3::zeros();
        let slack = Warning::Slack { cable: robot.cables[2].name.clone() };
        assert_eq!(warnings::of_cable(&robot, &rest, 2, CableModel::Spring, 1.0).contains(&slack), warned, "{model:?}");
        assert_eq!(warnings::of_statics(&robot, &rest).contains(&slack), warned, "{model:?}");
    }
}
