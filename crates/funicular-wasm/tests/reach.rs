//! Answers for the live page besides frames: rays to the border of the workspace, tables, and data of a refit.

use funicular_study::request::Request;
use funicular_wasm::answer;
use funicular_wasm::frame::{FrameState, Session};
use serde_json::{Value, json};

fn session(text: &str, more: &Value) -> Session {
    let mut request = json!({ "command": "stiffness", "robot": { "text": text } });
    request.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    Session::new(Request::from_value(request).unwrap()).unwrap().0
}

const POSE: [f64; 7] = [1.0, 0.5, 1.5, 1.0, 0.0, 0.0, 0.0];

fn reached(of: &mut Session, pose: &[f64], level: usize) -> (Vec<f64>, Value) {
    let found = of.reach(&FrameState::of_numbers(1, pose).unwrap(), level).unwrap();
    (found.numbers, serde_json::from_str(&found.text).unwrap())
}

#[test]
fn rays_have_the_loads_and_limits_of_the_frames() {
    let mut plain = session(funicular_robots::COGIRO, &json!({}));
    let (numbers, about) = reached(&mut plain, &POSE, 0);
    assert_eq!((numbers.len(), &about["is_inside"], &about["is_in_box"]), (30, &json!(true), &json!(true)));
    let up = numbers[5 * 4..5 * 4 + 5].to_vec();
    assert_eq!(up[..2], POSE[..2]);
    assert!(up[4] > 0.5 && (up[2] - POSE[2] - up[3]).abs() < 1e-12, "{up:?}");

    // Higher up the cables pull harder: a lower limit of the tensions ends the way earlier.
    let mut limited = session(funicular_robots::COGIRO, &json!({ "max_tension_n": 1500.0 }));
    let lower = reached(&mut limited, &POSE, 0).0[5 * 4 + 3];
    assert!(lower < up[3] - 0.1, "{lower} {}", up[3]);

    let (none, outside) = reached(&mut plain, &[50.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0], 0);
    assert_eq!((none.len(), &outside["is_in_box"]), (0, &json!(false)));
}

#[test]
fn a_robot_whose_workspace_is_not_searched_says_why() {
    let mut few = session(funicular_robots::GRAB_3_CABLES, &json!({}));
    let refused = few.reach(&FrameState::of_numbers(1, &POSE).unwrap(), 0).unwrap_err().to_string();
    assert!(refused.contains("with fewer cables than degrees of freedom"), "{refused}");
    let lengths = FrameState::of_numbers(2, &[1.0]).unwrap();
    assert!(few.reach(&lengths, 0).unwrap_err().to_string().contains("rays go out from a pose"));
}

#[test]
fn a_calibration_has_the_data_of_a_refit() {
    let robot = include_str!("../../../docs/calibration/machine.toml");
    let text = include_str!("../../../docs/calibration/belts.csv");
    let columns = funicular_formats::number_columns::read_with_gaps("belts.csv", text.as_bytes()).unwrap().columns;
    let request = json!({ "command": "calibrate", "robot": { "text": robot }, "readings": columns, "leave_out": [2] });
    let (status, text) = answer(request.to_string().into_bytes());
    let found: Value = serde_json::from_slice(&text).unwrap();
    assert_eq!((status, &found["refit"]["rows"]), (0, &json!([1, 3, 4, 5, 6])));
    assert_eq!(found["refit"]["linear"]["rows"].as_array().unwrap().len(), 5);
}
