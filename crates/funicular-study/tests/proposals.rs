//! What `identify` proposes to measure next: the deviations that it promises are those of a fit with this measurement.

use funicular_study::analyses::identify::Identified;
use funicular_study::{Request, Results, Silent, run};
use serde_json::{Value, json};

const HALL: &str = include_str!("../../../docs/quick-start/hall.toml");

fn identified(experiments: &Value, more: &Value) -> Identified {
    let mut request = json!({
        "command": "identify", "robot": { "text": HALL }, "experiments": experiments,
        "fit": [{ "path": "platform.mass_kg" }, { "path": "materials.rope.youngs_modulus_pa" }],
    });
    request.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    match run(&Request::from_json(&request.to_string()).unwrap(), &mut Silent).unwrap() {
        Results::Identify(found) => *found,
        _ => panic!("identify was requested"),
    }
}

/// Three numbered frequencies of the robot of the quick start with 64 kg.
fn measured() -> Value {
    let frequencies = [(1.2459, "1"), (1.4446, "2"), (1.5195, "3")]
        .map(|(hz, label)| json!({ "frequency_hz": hz, "std_hz": 0.002 * hz, "label": label }));
    json!({ "hold_lengths_of_pose": true, "frequencies": frequencies })
}

#[test]
fn a_proposed_measurement_leaves_the_deviations_that_it_promises() {
    let grid = json!([{ "axis": "x", "values": [-2.0, 0.0, 2.0] }, { "axis": "z", "values": [2.0, 4.0] }]);
    let proposed = identified(&json!([measured()]), &json!({ "propose": 2, "grid": grid, "propose_modes": 4 }));
    let next = &proposed.proposals[0];
    assert_eq!((proposed.proposals.len(), next.number), (2, 1));

    // The same measurement with its predicted values: the minimum stays.
    let [x, y, z] = next.position_m;
    let frequencies: Vec<Value> = next
        .frequency_hz
        .iter()
        .enumerate()
        .map(|(k, hz)| json!({ "frequency_hz": hz, "label": (k + 1).to_string() }))
        .collect();
    assert_eq!((next.measured.as_str(), frequencies.len()), ("frequencies", 4));
    let second = json!({ "hold_lengths_of_pose": true, "pose": [x, y, z, 0.0, 0.0, 0.0], "frequencies": frequencies });
    let with = identified(&json!([measured(), second]), &json!({}));
    for ((before, after), promised) in proposed.values.iter().zip(&with.values).zip(&next.deviations) {
        assert!((after.value / before.value - 1.0).abs() < 1e-4, "{}: {} {}", before.path, before.value, after.value);
        let (after, promised) =
            (after.deviation.unwrap() / with.deviation_factor, promised / proposed.deviation_factor);
        assert!((after / promised - 1.0).abs() < 2e-3, "{}: {after} {promised}", before.path);
        assert!(promised < before.deviation.unwrap() / proposed.deviation_factor);
    }
    let largest = |number: usize| proposed.proposals[number].largest_percent.unwrap();
    assert!(largest(1) < largest(0));
}

#[test]
fn the_least_number_of_measurements_reaches_the_wanted_deviation() {
    let fit = json!([{ "path": "platform.mass_kg" }]);
    let before = identified(&json!([measured()]), &json!({ "fit": fit }));
    let percent = 100.0 * before.values[0].deviation.unwrap() / before.values[0].value;
    let grid = json!([{ "axis": "x", "values": [-2.0, 2.0] }]);
    let options = |wanted: f64| json!({ "fit": fit, "wanted_percent": wanted, "grid": grid });
    let wanted = 0.8 * percent;
    let found = identified(&json!([measured()]), &options(wanted));
    let needed = found.measurements_needed.unwrap();
    assert_eq!(found.proposals.len(), needed);
    assert!(needed > 1 && found.proposals[needed - 1].largest_percent.unwrap() <= wanted);
    assert!(found.proposals[needed - 2].largest_percent.unwrap() > wanted);
    // No number of them reaches everything, which is said.
    let out_of_reach = identified(&json!([measured()]), &options(1e-6));
    assert!(out_of_reach.measurements_needed.is_none());
    assert!(out_of_reach.warnings.iter().any(|text| text.contains("100 of the candidates do not reach")));

    let request = json!({
        "command": "identify", "robot": { "text": HALL }, "experiments": [measured()], "propose": 1,
        "fit": [{ "path": "platform.mass_kg" }], "grid": [{ "axis": "x", "values": [1.0] }],
        "propose_measuring": ["tension"],
    });
    let refused = run(&Request::from_json(&request.to_string()).unwrap(), &mut Silent).map(drop).unwrap_err();
    assert!(refused.to_string().contains("did you mean `tensions`?"), "{refused}");
}
