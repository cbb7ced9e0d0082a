//! Proposals of `identify` for the next measurement: the deviations that it promises are those of a fit with this
//! measurement.

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
    let frequencies = [(1.4638, "1"), (1.5331, "2"), (1.5535, "3")]
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

/// Normally distributed numbers: xorshift and the method of Box and Muller.
struct Normal(u64);

impl Normal {
    fn next(&mut self) -> f64 {
        let mut uniform = || {
            for shift in [13, -7, 17_i32] {
                self.0 ^= if shift > 0 { self.0 << shift } else { self.0 >> -shift };
            }
            ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
        };
        let (a, b) = (uniform(), uniform());
        (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
    }
}

/// Frequencies with noise of a relative deviation, and this deviation as theirs.
fn noisy(frequency_hz: &[f64], noise: f64, normal: &mut Normal) -> Value {
    let row = |(k, hz): (usize, &f64)| {
        let seen = hz * (1.0 + noise * normal.next());
        json!({ "frequency_hz": seen, "std_hz": noise * hz, "label": (k + 1).to_string() })
    };
    frequency_hz.iter().enumerate().map(row).collect()
}

#[test]
fn a_payload_tells_more_and_noisy_measurements_with_it_scatter_as_promised() {
    const DRAWS: usize = 24;
    const CENTER_M: [f64; 3] = [0.2, 0.0, -0.4];

    // The robot has the values of its file and 64 kg, to the digits of the measured frequencies.
    let grid = json!([{ "axis": "x", "values": [0.0, 2.0] }]);
    let candidates = json!({
        "propose": 1, "grid": grid, "propose_modes": 4, "propose_payloads_kg": [0.0, 20.0], "starts": 1,
    });
    let mut first = measured();
    first["payload_center_m"] = json!(CENTER_M);
    let proposed = identified(&json!([first]), &candidates);
    let next = &proposed.proposals[0];
    assert_eq!((next.payload_kg, next.measured.as_str()), (Some(20.0), "frequencies"));
    let without = identified(&json!([measured()]), &json!({ "propose": 1, "grid": grid, "propose_modes": 4 }));
    assert_eq!(without.proposals[0].payload_kg, None);
    assert!(next.largest_percent.unwrap() < without.proposals[0].largest_percent.unwrap());

    let [x, y, z] = next.position_m;
    let truth = [proposed.values[0].value, proposed.values[1].value];
    let of_first: Vec<f64> =
        measured()["frequencies"].as_array().unwrap().iter().map(|of| of["frequency_hz"].as_f64().unwrap()).collect();
    let mut normal = Normal(20_140_531);
    let mut squares = [0.0; 2];
    for _ in 0..DRAWS {
        let before = json!({ "hold_lengths_of_pose": true, "frequencies": noisy(&of_first, 0.002, &mut normal) });
        let after = json!({
            "hold_lengths_of_pose": true, "pose": [x, y, z, 0.0, 0.0, 0.0], "payload_kg": 20.0,
            "payload_center_m": CENTER_M, "frequencies": noisy(&next.frequency_hz, 0.01, &mut normal),
        });
        let found = identified(&json!([before, after]), &json!({ "starts": 1 }));
        for (k, square) in squares.iter_mut().enumerate() {
            let promised = next.deviations[k] / proposed.deviation_factor;
            *square += ((found.values[k].value - truth[k]) / promised).powi(2);
        }
    }

    // Sums of as many squares of a normal distribution are between these limits with 99.9 %.
    assert!(squares.iter().all(|sum| (7.5..54.0).contains(sum)), "{squares:?}");
}

#[test]
fn a_payload_of_a_proposal_needs_a_proposal_and_a_mass_of_the_platform() {
    let refused = |more: Value, state: Value| {
        let mut first = measured();
        first.as_object_mut().unwrap().extend(state.as_object().unwrap().clone());
        let mut request = json!({
            "command": "identify", "robot": { "text": HALL }, "experiments": [first],
            "fit": [{ "path": "materials.rope.youngs_modulus_pa" }],
        });
        request.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        run(&Request::from_json(&request.to_string()).unwrap(), &mut Silent).map(drop).unwrap_err().to_string()
    };
    let alone = refused(json!({ "propose_payloads_kg": [1.0] }), json!({}));
    assert!(alone.contains("are payloads of a proposal"), "{alone}");
    let twice = refused(json!({}), json!({ "mass_kg": 60.0, "payload_kg": 1.0 }));
    assert!(twice.contains("is the mass of platform and payload together"), "{twice}");
    let grid = json!([{ "axis": "x", "values": [0.0] }]);
    let replaced =
        refused(json!({ "propose": 1, "grid": grid, "propose_payloads_kg": [1.0] }), json!({ "mass_kg": 60.0 }));
    assert!(replaced.contains("is the mass of platform and payload together"), "{replaced}");
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
