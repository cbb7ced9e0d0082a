//! Winches of a robot: one for every cable against those of each, what asks for them, layers by hand, offers, poses
//! that are not held, refusals.
#![allow(missing_docs)]
// Numbers of one run are compared bit for bit.
#![allow(clippy::float_cmp)]

use funicular_study::analyses::winches::{WinchRow, Winches};
use funicular_study::{Error, ErrorKind, Request, Results, Silent, Watch, run};
use serde_json::{Value, json};
use std::f64::consts::PI;

fn request(more: &Value) -> Value {
    let mut request = json!({
        "command": "winches", "robot": {"text": funicular_robots::COGIRO_WINCHES},
        "grid": [{"axis": "x", "values": [-3.0, 0.0, 3.0]}, {"axis": "y", "values": [-2.0, 2.0]},
                 {"axis": "z", "values": [1.5]}],
        "required_velocity_m_s": [1.0, 0.8, 0.5], "required_acceleration_m_s2": [1.0, 1.0, 0.5],
        "required_payload_max_kg": 40.0,
    });
    for (key, value) in more.as_object().unwrap() {
        request[key] = value.clone();
    }
    request
}

fn winches_watched(more: &Value, watch: &mut dyn Watch) -> Result<Winches, Error> {
    let request = Request::from_json(&request(more).to_string())?;
    let Results::Winches(found) = run(&request, watch)? else { panic!("winches were requested") };
    Ok(found)
}

fn winches(more: &Value) -> Result<Winches, Error> {
    winches_watched(more, &mut Silent)
}

#[test]
fn one_winch_for_every_cable_is_the_largest_of_all() {
    let found = winches(&json!({})).unwrap();
    assert_eq!((found.poses, found.held, found.winches.len()), (6, 6, 9));
    let (every, cables) = found.winches.split_first().unwrap();
    for of in [
        (|row: &WinchRow| row.tension_n) as fn(&WinchRow) -> f64,
        |row| row.speed_m_s,
        |row| row.acceleration_m_s2,
        |row| row.torque_n_m.unwrap(),
        |row| row.power_w,
        |row| row.brake_power_w,
        |row| row.rope_m,
        |row| row.length_max_m,
    ] {
        assert_eq!(of(every), cables.iter().map(of).fold(f64::NEG_INFINITY, f64::max));
    }
    assert_eq!(found.asked.len(), 6);
    for asked in &found.asked {
        let row = cables.iter().find(|row| row.name == asked.cable).unwrap();
        let value = match asked.quantity {
            "tension" => row.tension_n,
            "speed" => row.speed_m_s,
            "acceleration" => row.acceleration_m_s2,
            "torque" => row.torque_n_m.unwrap(),
            "power" => row.power_w,
            _ => row.brake_power_w,
        };
        assert_eq!(value, asked.value, "{}", asked.quantity);
    }
    // The heaviest payload asks for the largest tension.
    let tension = &found.asked[0];
    assert!(tension.force_n[2] < -40.0 * 9.8 && tension.velocity_m_s.is_none(), "{:?}", tension.force_n);
    assert!(found.sentence().starts_with("Each winch: "), "{}", found.sentence());

    // More is asked of them by one per cent more mass.
    let heavier = winches(&json!({"mass_kg": 1.01 * 91.058})).unwrap();
    assert!(heavier.winches[0].tension_n > 1.003 * every.tension_n);

    // A map shows the same numbers pose by pose.
    let single = winches(&json!({"grid": [], "pose": [3.0, 2.0, 1.5]})).unwrap();
    assert_eq!(single.poses, 1);
    assert!(single.winches[0].power_w <= every.power_w && single.winches[0].rope_m < every.rope_m);
    assert!(found.sentence().ends_with(" m of rope") && !single.sentence().contains("of rope"));
}

#[test]
fn layers_are_those_of_a_hand_calculation() {
    let text = funicular_robots::COGIRO_WINCHES;
    let area = text.lines().find(|line| line.starts_with("area_m2 = 8.2051e-6")).unwrap();
    let text = text.replacen(area, "diameter_m = 0.004", 1);
    // Ten turns per layer.
    let found = winches(&json!({"robot": {"text": text}, "drum_width_m": 0.04})).unwrap();
    let radius = 0.0675;
    assert!(text.contains(&format!("drum_radius_m = {radius}")), "{text}");
    for row in &found.winches[1..] {
        let (mut taken, mut layers) = (0.0, 0);
        while taken < row.rope_m + 3.0 * 2.0 * PI * radius {
            taken += 10.0 * 2.0 * PI * (radius + f64::from(layers) * 0.866 * 0.004);
            layers += 1;
        }
        assert_eq!(row.layers, usize::try_from(layers).ok(), "{}", row.name);
    }
    // The area of a wire rope tells no diameter, and a drum narrower than the rope takes none.
    assert_eq!(winches(&json!({"drum_width_m": 0.04})).unwrap().winches[0].layers, None);
    let narrow = winches(&json!({"robot": {"text": text}, "drum_width_m": 0.003})).unwrap();
    assert_eq!(narrow.winches[0].layers, None);
}

#[test]
fn offers_are_compared_with_what_they_say() {
    let needed = winches(&json!({})).unwrap().winches.swap_remove(0);
    let offers = json!([
        {"name": "just", "tension_n": needed.tension_n, "power_w": 2.0 * needed.power_w},
        {"name": "small", "speed_m_s": needed.speed_m_s / 1.25, "rope_m": 100.0},
        {"name": "short", "rope_m": needed.rope_m / 2.0},
        {"name": "silent"},
    ]);
    let found = winches(&json!({"offers": offers})).unwrap();
    let rows: Vec<_> = found.offers.unwrap().into_iter().map(|row| (row.name, row.fits, row.used, row.by)).collect();
    assert_eq!(rows[0], ("just".to_owned(), true, Some(1.0), Some("tension")));
    assert!(!rows[1].1 && (rows[1].2.unwrap() - 1.25).abs() < 1e-12 && rows[1].3 == Some("speed"));
    assert_eq!(rows[2], ("short".to_owned(), false, Some(2.0), Some("rope")));
    assert_eq!(rows[3], ("silent".to_owned(), false, None, None));
}

#[test]
fn poses_that_are_not_held_ask_for_nothing_and_are_told() {
    let grid =
        json!([{"axis": "x", "values": [0.0, 40.0]}, {"axis": "y", "values": [0.0]}, {"axis": "z", "values": [1.5]}]);
    let found = winches(&json!({"grid": grid})).unwrap();
    assert_eq!((found.poses, found.held), (2, 1));
    assert_eq!(found.not_held.unwrap().pose.position_m, [40.0, 0.0, 1.5]);
    assert!(found.warnings.iter().any(|warning| warning.starts_with("1 of 2 poses")), "{:?}", found.warnings);

    let error = winches(&json!({"grid": [], "pose": [0.0, 0.0, 1.5], "required_payload_max_kg": 1e5})).err().unwrap();
    assert_eq!(error.kind(), ErrorKind::NoSolution);
}

/// Stops after some poses.
struct After(usize);

impl Watch for After {
    fn progress(&mut self, done: usize, _: usize, _: &'static str) {
        self.0 -= usize::from(done > 0).min(self.0);
    }

    fn is_cancelled(&self) -> bool {
        self.0 == 0
    }
}

#[test]
fn what_was_found_before_a_stop_is_kept() {
    let found = winches_watched(&json!({}), &mut After(2)).unwrap();
    assert_eq!(found.poses, 2);
    assert!(found.warnings.iter().any(|warning| warning.starts_with("stopped after 2 of 6 poses")));
    assert_eq!(winches_watched(&json!({}), &mut After(0)).err().unwrap().kind(), ErrorKind::Cancelled);
}

#[test]
fn wrong_requests_are_refused_with_the_reason() {
    let offers = |offer: Value| json!({"offers": [offer]});
    for (more, expected) in [
        (offers(json!({"name": "a", "tension_N": 3})), "did you mean `tension_n`?"),
        (offers(json!({"name": "a", "speed_m_s": "fast"})), "`speed_m_s`"),
        (offers(json!({"name": "a", "speed_m_s": -1})), "`speed_m_s`"),
        (json!({"offers": []}), "has no winches: give at least one"),
        (json!({"drum_width_m": 0.0}), "`drum_width_m`"),
        (json!({"grid": [{"axis": "w", "values": [0.0]}]}), "there is no axis `w`"),
        (json!({"hold_lengths_of_pose": true}), "leave out `hold_lengths_of_pose`"),
        (
            json!({"robot": {"text": funicular_robots::GRAB_3_CABLES}, "grid": [], "pose": [0, 0, 1]}),
            "`winches` needs at least as many cables as degrees of freedom",
        ),
    ] {
        let error = winches(&more).err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains(expected), "{more}: {error}");
    }
}
