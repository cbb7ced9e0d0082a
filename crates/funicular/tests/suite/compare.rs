//! Cable models side by side.

use funicular::cable::CableModel;
use funicular::compare::{self, Criterion};
use funicular::dynamics::Linearisation;
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
