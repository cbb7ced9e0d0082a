//! Warnings about results outside the range of a model.

use crate::library::at_rest;
use funicular::cable::{CableModel, EndStiffness};
use funicular::robot::Robot;
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
            let one = EndStiffness::new(&robot, i, &rest.cables[i], cable_model, true, 5.0).unwrap();
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
