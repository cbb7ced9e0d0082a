//! Uncertainty: exact cases, linear deviations against samples, and the tests that choose between them.

use funicular_study::analyses::uncertainty::{UncertainResult, Uncertainties};
use funicular_study::{Request, Results, Silent, run};
use serde_json::{Value, json};

fn uncertainty(robot: &str, more: &Value) -> Uncertainties {
    let mut request = json!({"command": "uncertainty", "robot": {"text": robot}});
    request.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    let request = Request::from_json(&request.to_string()).unwrap();
    match run(&request, &mut Silent).unwrap() {
        Results::Uncertainty(found) => found,
        _ => panic!("uncertainty was requested"),
    }
}

fn results(of: &Uncertainties) -> &[UncertainResult] {
    &of.poses[0].results
}

/// Robot on straight cables without weight at a pose: tensions are proportional to the load.
fn straight() -> String {
    funicular_robots::YUAN2014_4MM.replace("mass_kg_per_m = 0.067", "mass_kg_per_m = 0.0")
}

#[test]
fn a_table_stands_for_all_its_numbers() {
    let found = uncertainty(
        &straight(),
        &json!({
            "pose": [0.0, 0.0, 0.5, 0.0, 0.0, 0.0], "hold": "pose", "of": ["tensions"], "method": "linear",
            "deviations": ["cables.1=1%", "cables.2.anchor_m.2=0.001"],
        }),
    );
    let of_group = |group: usize| found.inputs.iter().filter(move |input| input.group == group);
    assert!(of_group(0).count() > 5 && of_group(0).all(|input| input.path.starts_with("cables.1.")));
    assert_eq!(of_group(1).map(|input| &input.path).collect::<Vec<_>>(), ["cables.2.anchor_m.z"]);
}

#[test]
fn tensions_proportional_to_the_mass_have_its_relative_deviation_by_both_ways() {
    let held = json!({"pose": [0.0, 0.0, 0.5, 0.0, 0.0, 0.0], "hold": "pose", "of": ["tensions"]});
    let with = |more: Value| {
        let mut all = held.clone();
        all.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        uncertainty(&straight(), &all)
    };

    // Normal: deviation 2 % and interval ± 1.96 · 2 % of each tension.
    let linear = with(json!({"deviations": ["platform.mass_kg=2%"]}));
    let sampled = with(json!({"deviations": ["platform.mass_kg=2%"], "method": "sampled", "samples": 1000}));
    for (linear, sampled) in results(&linear).iter().zip(results(&sampled)) {
        assert_eq!((linear.method, sampled.method), ("linear", "sampled"));
        // The gradient has ten digits here.
        assert!((linear.deviation.unwrap() / linear.value - 0.02).abs() < 1e-10, "{linear:?}");
        // A Latin hypercube of one number has its deviation to 1/n and its quantiles to 1/(n · density).
        assert!((sampled.deviation.unwrap() / linear.value - 0.02).abs() < 5e-5, "{sampled:?}");
        assert!((sampled.mean.unwrap() / linear.value - 1.0).abs() < 1e-4, "{sampled:?}");
        let (one, other) = (linear.interval_95.unwrap(), sampled.interval_95.unwrap());
        for k in 0..2 {
            assert!((one[k] / linear.value - [0.960_800_7, 1.039_199_3][k]).abs() < 1e-7, "{linear:?}");
            assert!((other[k] - one[k]).abs() < 2e-4 * linear.value, "{sampled:?}");
        }
        assert_eq!(linear.group_shares, Some(vec![1.0]));
        assert!(linear.worst.is_none());
    }

    // Within a tolerance: deviation 2 %/√3, interval 95 % of the tolerance, corners at ± 2 %.
    let linear = with(json!({"tolerances": ["platform.mass_kg=2%"]}));
    for result in results(&linear) {
        let worst = result.worst.unwrap();
        assert!((result.deviation.unwrap() / result.value - 0.02 / 3.0_f64.sqrt()).abs() < 1e-10);
        // The interval is found on a grid of 4096 steps.
        assert!((result.interval_95.unwrap()[1] / result.value - 1.019).abs() < 2e-5, "{result:?}");
        for (change, expected) in [(worst.linear, 0.02), (worst.up.unwrap(), 0.02), (worst.down.unwrap(), -0.02)] {
            assert!((change / result.value - expected).abs() < 1e-9, "{result:?}");
        }
    }
}

/// Three robots, what deviates, and the number of results.
fn cases() -> [(&'static str, Value, usize); 4] {
    [
        (
            funicular_robots::YUAN2014_4MM,
            json!({
                "deviations": ["platform.mass_kg=1%", "platform.center_of_mass_m=0.001"],
                "tolerances": ["cables.*.anchor_m=0.002"],
            }),
            18,
        ),
        (
            funicular_robots::COGIRO,
            json!({
                "deviations": ["platform.mass_kg=1%", "materials.*.youngs_modulus_pa=5%"],
                "tolerances": ["cables.*.unstrained_length_m=0.0005"],
            }),
            22,
        ),
        (
            funicular_robots::COGIRO,
            json!({
                "pose": [1.0, 2.0, 1.5, 0.0, 0.0, 0.0], "max_tension_n": 5000.0, "tension_rule": "middle",
                "hold": "pose",
                "of": ["lengths", "tensions"], "deviations": ["cables.*.attachment_m=0.002", "platform.mass_kg=2%"],
                "tolerances": ["state.position_m=0.01"],
            }),
            24,
        ),
        (
            funicular_robots::COGIRO,
            json!({
                "pose": [1.0, 2.0, 1.5, 0.0, 0.0, 0.0], "hold": "rule", "tension_rule": "closest",
                "target_tension_n": [400.0], "of": ["lengths", "tensions", "stiffness-min"],
                "deviations": ["cables.*.attachment_m=0.002", "platform.mass_kg=2%"],
                "tolerances": ["state.position_m=0.01"],
            }),
            25,
        ),
    ]
}

#[test]
fn linear_deviations_are_those_of_samples_where_the_tests_allow_them() {
    const SAMPLES: usize = 400;
    for (robot, request, count) in cases() {
        let linear = uncertainty(robot, &request);
        let mut request = request;
        request["method"] = json!("sampled");
        request["samples"] = json!(SAMPLES);
        let sampled = uncertainty(robot, &request);
        assert_eq!(results(&linear).len(), count);
        for (linear, sampled) in results(&linear).iter().zip(results(&sampled)) {
            assert_eq!((linear.method, &linear.sampling_reason), ("linear", &None), "{linear:?}");
            // 400 robots: deviation to 3.5 %, so 10 % is nearly three of these.
            let ratio = linear.deviation.unwrap() / sampled.deviation.unwrap();
            assert!((0.9..1.1).contains(&ratio), "{}: {ratio}", linear.name);
            for k in 0..2 {
                // An end of the interval has 2.5 % of 400 robots beyond it: 10 ± 3, which is 0.13 deviations.
                let apart = (linear.interval_95.unwrap()[k] - sampled.interval_95.unwrap()[k]).abs();
                assert!(apart < 0.4 * sampled.deviation.unwrap(), "{}: {apart}", linear.name);
            }
            // Total shares of a nearly linear result are its shares. The sampled variance, to 7 %, divides them.
            let ratio = (sampled.deviation.unwrap() / linear.deviation.unwrap()).powi(2);
            for (one, other) in linear.group_shares.iter().flatten().zip(sampled.group_shares.iter().flatten()) {
                assert!((one - other * ratio).abs() < 0.03, "{}: {one} {other} {ratio}", linear.name);
            }
            assert_eq!(sampled.linear_deviation, linear.deviation);
        }
    }
}

/// Six-cable robot with example winches.
fn winches() -> String {
    std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/pulleys/winches.toml")).unwrap()
}

#[test]
fn modes_that_come_near_and_mix_are_sampled() {
    // The four lowest frequencies lie within 6 %: they turn away from each other before they meet.
    const ANCHORS: f64 = 0.0015;
    let robot = winches();
    let with = |deviation: f64, method: &str| {
        uncertainty(
            &robot,
            &json!({
                "of": ["frequencies"], "below_hz": 1.3, "deviations": [format!("cables.*.anchor_m={deviation}")],
                "method": method, "samples": 100,
            }),
        )
    };
    let found = with(ANCHORS, "automatic");
    let [first, .., fourth] = results(&found) else { panic!("four frequencies") };
    for one in [first, fourth] {
        assert_eq!(one.method, "sampled", "{one:?}");
        assert!(one.sampling_reason.as_ref().unwrap().contains("come near each other and mix"), "{one:?}");
    }
    // The lowest frequency has hardly a derivative here, and changes by what pushes it from those above.
    let ratio = first.deviation.unwrap() / first.linear_deviation.unwrap();
    assert!(ratio > 1.3, "{ratio}");

    // Where deviations are small, everything is linear, and agrees with a sample: 100 robots have a deviation to 7 %.
    let (linear, sampled) = (with(0.01 * ANCHORS, "automatic"), with(0.01 * ANCHORS, "sampled"));
    for (linear, sampled) in results(&linear).iter().zip(results(&sampled)) {
        assert_eq!(linear.method, "linear", "{linear:?}");
        let ratio = linear.deviation.unwrap() / sampled.deviation.unwrap();
        assert!((0.8..1.2).contains(&ratio), "{linear:?} {ratio}");
    }
}

#[test]
fn robots_without_gradients_are_sampled() {
    let found = uncertainty(
        funicular_robots::YUAN2014_4MM,
        &json!({
            "static_model": "ideal", "deviations": ["platform.mass_kg=1%"], "samples": 20, "of": ["tensions"],
        }),
    );
    for result in results(&found) {
        assert_eq!(result.method, "sampled");
        assert!(result.deviation.unwrap() > 0.0 && result.interval_95.unwrap()[0] < result.value, "{result:?}");
    }

    // Values out of their range and poses without equilibrium are counted, and leave the rest as it is.
    let found = uncertainty(
        funicular_robots::YUAN2014_4MM,
        &json!({"deviations": ["platform.mass_kg=60%"], "samples": 100, "of": ["pose"]}),
    );
    let failed = found.poses[0].failed.as_ref().unwrap();
    // Φ(−1/0.6) = 4.8 % of all masses are negative.
    assert!((4..=5).contains(&failed.count) && failed.reason.contains("it must be positive"), "{failed:?}");
    assert!(results(&found)[2].deviation.is_some());
}

#[test]
fn numbers_of_the_request_and_numbers_that_the_file_leaves_out_deviate_too() {
    // Without a [loads] table; the mass is that of the request.
    let found = uncertainty(
        funicular_robots::YUAN2014_4MM,
        &json!({
            "mass_kg": 20.0, "force_n": [0.0, 0.0, -10.0], "deviations": ["platform.mass_kg=1%", "loads.force_n.z=1"],
            "of": ["tensions"], "method": "sampled", "samples": 10,
        }),
    );
    assert_eq!(found.inputs.iter().map(|input| input.value.unwrap()).collect::<Vec<_>>(), [20.0, -10.0]);
    assert_eq!(found.inputs.iter().map(|input| input.deviation.unwrap()).collect::<Vec<_>>(), [0.2, 1.0]);
    // The middle of the sample is the undisturbed robot.
    for result in results(&found) {
        assert!((result.mean.unwrap() - result.value).abs() < 0.1 * result.deviation.unwrap(), "{result:?}");
    }
}

#[test]
fn a_force_that_the_file_leaves_out_deviates_like_the_weight() {
    // At the centre of mass 9.81 N more downwards is 1 kg more.
    let text = funicular_robots::COGIRO.replace("[-0.034, -0.013, 0.264]", "[0.0, 0.0, 0.0]");
    assert!(!text.contains("[loads]") && !text.contains("[wind]"));
    let held = json!({
        "pose": [1.0, 2.0, 1.5, 0.0, 0.0, 0.0], "hold": "pose", "of": ["lengths"], "wind_m_s": [0.0, 0.0, 0.0],
        "cable_load_n_per_m": [0.0, 0.0, -0.1],
    });
    let with = |deviation: &str| {
        let mut all = held.clone();
        all.as_object_mut().unwrap().insert("deviations".to_owned(), json!([deviation]));
        uncertainty(&text, &all)
    };
    let (force, mass) = (with("loads.force_n.z=9.81"), with("platform.mass_kg=1"));
    for (force, mass) in results(&force).iter().zip(results(&mass)) {
        let (force, mass) = (force.deviation.unwrap(), mass.deviation.unwrap());
        // Rounding of the gradients.
        assert!(mass > 0.0 && (force / mass - 1.0).abs() < 1e-9, "{force} {mass}");
    }
}

/// Response of the six-cable robot, whose natural frequencies below 3 Hz are 1.08 to 2.1 Hz.
fn response(more: &Value) -> Uncertainties {
    let mut request = json!({
        "of": ["response"], "input": "fz", "output": "az", "at_hz": [0.5, 0.9, 1.0, 1.2, 1.3, 2.0, 3.0, 6.0],
        "deviations": ["platform.mass_kg=0.5%"], "tolerances": ["cables.*.anchor_m=0.0002"],
    });
    request.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    uncertainty(funicular_robots::YUAN2014_4MM, &request)
}

#[test]
fn linear_deviations_of_responses_are_those_of_samples() {
    const SAMPLES: usize = 400;
    let found = response(&json!({"samples": 10}));
    let sampled = response(&json!({"method": "sampled", "samples": SAMPLES}));
    assert_eq!(found.response.as_ref().unwrap().unit, "(m/s²)/N");
    let linear: Vec<_> =
        results(&found).iter().zip(results(&sampled)).filter(|(one, _)| one.method == "linear").collect();
    assert!(linear.len() >= 6, "{}", linear.len());
    assert!(linear.iter().any(|(one, _)| one.unit == "degrees") && linear.iter().any(|(one, _)| one.unit == "dB"));
    for (linear, sampled) in linear {
        // 400 robots: deviation to 3.5 %, so 10 % is nearly three of these. The bend adds 1 %.
        let ratio = linear.deviation.unwrap() / sampled.deviation.unwrap();
        assert!((0.9..1.1).contains(&ratio), "{}: {ratio}", linear.name);
        for k in 0..2 {
            let apart = (linear.interval_95.unwrap()[k] - sampled.interval_95.unwrap()[k]).abs();
            assert!(apart < 0.4 * sampled.deviation.unwrap(), "{}: {apart}", linear.name);
        }
        let mean = (sampled.mean.unwrap() - linear.value) / sampled.deviation.unwrap();
        assert!(mean.abs() < 0.25, "{}: {mean}", linear.name);
    }

    // Beside the peaks the response bends, and the linear deviation is another one.
    let beside = results(&found).iter().zip(results(&sampled)).filter(|(one, _)| one.at_hz == Some(2.0));
    for (one, sampled) in beside {
        assert_eq!(one.method, "sampled", "{one:?}");
        let ratio = one.linear_deviation.unwrap() / sampled.deviation.unwrap();
        assert!(!(0.9..1.1).contains(&ratio), "{}: {ratio}", one.name);
    }
}

#[test]
fn a_response_that_is_proportional_to_one_number_has_its_deviation() {
    // Far above all natural frequencies of a robot on springs, the acceleration per force is that of a free body.
    let robot = straight();
    let with = |method: &str| {
        uncertainty(
            &robot,
            &json!({
                "of": ["response"], "input": "fz", "output": "az", "at_hz": 500.0, "method": method, "samples": 1000,
                "static_model": "spring", "cable_model": "spring", "deviations": ["platform.mass_kg=2%"],
                "input_point_m": [0.0, 0.0, 0.0], "output_point_m": [0.0, 0.0, 0.0],
            }),
        )
    };
    let [linear, sampled] = ["automatic", "sampled"].map(with);
    let (linear, sampled) = (&results(&linear)[0], &results(&sampled)[0]);
    assert_eq!((linear.method, linear.unit), ("linear", "dB"));
    // A free body has 1/m + κ, κ from the lever of the force about the centre of mass: 2 % of the mass change the part
    // 1/m. The springs, whose highest frequency is 15 Hz, add (15/500)² to the response.
    let mass = funicular::robot::Robot::from_toml(&robot).unwrap().platform.mass;
    let share = 1.0 / mass / 10_f64.powf(linear.value / 20.0);
    let expected = 0.02 * share * 20.0 / std::f64::consts::LN_10;
    assert!((linear.deviation.unwrap() / expected - 1.0).abs() < 3e-3, "{linear:?} {expected}");
    assert!((sampled.deviation.unwrap() / linear.deviation.unwrap() - 1.0).abs() < 5e-3, "{sampled:?}");
}

#[test]
fn responses_without_gradients_are_sampled_and_wrong_ones_refused() {
    let found = response(&json!({"output": "cable:3@0.5:az", "at_hz": [0.5], "samples": 20}));
    for result in results(&found) {
        assert_eq!(result.method, "sampled", "{result:?}");
        assert!(result.deviation.unwrap() > 0.0, "{result:?}");
    }

    for (more, message) in [
        (json!({"at_hz": [0.0]}), "`at_hz`: at 0 Hz nothing moves"),
        (json!({"at_hz": [1.0, 2.0, 1.0]}), "`at_hz`: 1 Hz is there twice"),
        (json!({"at_hz": []}), "`response` needs `at_hz`"),
        (json!({"at_hz": -1.0}), "`at_hz`: -1 is negative"),
        (json!({"input": null}), "`response` needs `input`"),
        (json!({"output": "cable:9@0.5:az"}), "9"),
    ] {
        let mut request = json!({
            "command": "uncertainty", "robot": {"text": funicular_robots::YUAN2014_4MM}, "of": ["response"],
            "input": "fz", "output": "az", "at_hz": [1.0], "deviations": ["platform.mass_kg=1%"],
        });
        request.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        let read = Request::from_json(&request.to_string());
        let Err(error) = read.and_then(|request| run(&request, &mut Silent)) else { panic!("{more} is refused") };
        assert!(format!("{error:#}").contains(message), "{error:#}");
    }
}

/// Damping ratio of a mode that lives on the stretch of its ropes: proportional to the loss factor, whose deviation it
/// has to the share of the stretch.
#[test]
fn a_loss_factor_deviates_by_both_ways() {
    let robot = funicular_robots::COGIRO
        .replace("[materials.wire-rope-4mm]", "[materials.wire-rope-4mm]\naxial_loss_factor = 0.02")
        .replace("damping_ratio = 0.003", "damping_ratio = 0.0");
    let with = |method: &str| {
        uncertainty(
            &robot,
            &json!({
                "pose": [0.0, 0.0, 1.5, 0.0, 0.0, 0.0], "hold": "pose", "of": ["damping"], "below_hz": 20.0,
                "cable_model": "spring", "deviations": ["materials.*.axial_loss_factor=10%"], "method": method,
                "samples": 100,
            }),
        )
    };
    let (linear, sampled) = (with("linear"), with("sampled"));
    assert!(results(&linear).len() >= 3, "{}", results(&linear).len());
    for (linear, sampled) in results(&linear).iter().zip(results(&sampled)) {
        assert!((linear.deviation.unwrap() / linear.value - 0.1).abs() < 1e-3, "{linear:?}");
        assert!((sampled.deviation.unwrap() / linear.deviation.unwrap() - 1.0).abs() < 0.02, "{sampled:?}");
    }
}

/// Covariance of the anchors of all cables that move together: deviations along x and y with a correlation [m].
fn moving_anchors(cables: usize, [x, y]: [f64; 2], correlation: f64) -> Value {
    let numbers: Vec<(String, usize)> = (1..=cables)
        .flat_map(|cable| [0, 1].map(|k| (format!("cables.{cable}.anchor_m.{}", ["x", "y"][k]), k)))
        .collect();
    let entry = |(first, i): &(String, usize), (second, j): &(String, usize)| {
        let size = [x, y][*i] * [x, y][*j];
        json!({ "first": first, "second": second, "covariance": if i == j { size } else { correlation * size } })
    };
    let entries = numbers.iter().enumerate().flat_map(|(n, first)| {
        let entry = &entry;
        numbers[n..].iter().map(move |second| entry(first, second))
    });
    Value::Array(entries.collect())
}

#[test]
fn anchors_that_move_together_carry_the_platform_with_them() {
    // Independent anchors would move it by less in most directions; together they translate the whole robot.
    let deviations = [0.002, 0.001];
    for (file, cables, pose) in [
        (funicular_robots::YUAN2014_4MM.to_owned(), 6, json!([0.1, 0.0, 0.5, 0.0, 0.0, 0.0])),
        (straight(), 6, json!([0.0, 0.0, 0.5, 0.0, 0.0, 0.0])),
        (funicular_robots::COGIRO.to_owned(), 8, json!([1.0, 2.0, 1.5, 0.0, 0.0, 0.0])),
    ] {
        let found = uncertainty(
            &file,
            &json!({ "pose": pose, "covariance": moving_anchors(cables, deviations, 0.6), "of": ["pose"] }),
        );
        assert_eq!(found.inputs.len(), 2, "two combinations of {} numbers", 2 * cables);
        let of = |name: &str| results(&found).iter().find(|result| result.name == name).unwrap().deviation.unwrap();
        for (name, expected) in [("x", 0.002), ("y", 0.001), ("z", 0.0), ("rotation about z", 0.0)] {
            // Sums of gradients to nine digits.
            assert!((of(name) - expected).abs() < 1e-9, "{name}: {} and {expected}", of(name));
        }

        // The larger eigenvalue of [4, 1.2; 1.2, 1] mm².
        let position = found.poses[0].position.unwrap();
        let variance = 2.5 + (1.5_f64.powi(2) + 1.2_f64.powi(2)).sqrt();
        assert!((1e3 * position.deviation_m - variance.sqrt()).abs() < 1e-6, "{position:?}");
        let expected = [1.2, variance - 4.0].map(|part| part / 1.2_f64.hypot(variance - 4.0));
        assert!((0..2).all(|k| (position.direction[k] - expected[k]).abs() < 1e-6), "{position:?}");
    }
}

#[test]
fn a_covariance_without_pairs_is_one_of_independent_deviations() {
    let entry = |path: &str, deviation: f64| json!({ "first": path, "second": path, "covariance": deviation.powi(2) });
    let (mass, anchor) = ("platform.mass_kg", "cables.3.anchor_m.z");
    let at = json!({ "pose": [0.0, 0.0, 0.5, 0.0, 0.0, 0.0], "of": ["pose", "tensions"] });
    let with = |more: Value| {
        let mut all = at.clone();
        all.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        uncertainty(funicular_robots::YUAN2014_4MM, &all)
    };
    let together = with(json!({ "covariance": [entry(mass, 0.5), entry(anchor, 0.001)] }));
    let alone = with(json!({ "deviations": ["platform.mass_kg=0.5", "cables.3.anchor_m.z=0.001"] }));
    for (a, b) in results(&together).iter().zip(results(&alone)) {
        let (one, other) = (a.deviation.unwrap(), b.deviation.unwrap());
        assert!((one - other).abs() <= 1e-12 * other, "{}: {one} and {other}", a.name);
    }
}

#[test]
fn covariances_that_no_numbers_have_are_refused_with_their_row() {
    let row = |first: &str, second: &str, covariance: f64| -> Value {
        json!({ "first": first, "second": second, "covariance": covariance })
    };
    let (x, y) = ("cables.1.anchor_m.x", "cables.1.anchor_m.y");
    for (rows, part) in [
        (json!([row(x, x, 1.0), row(y, y, 1.0), row(x, y, 1.1)]), "no random numbers have these covariances"),
        (json!([row(x, x, 1.0), row(x, y, 0.1)]), "has no variance and still covariances"),
        (json!([row(x, x, -1.0)]), "variance"),
        (json!([row(x, x, 1.0), row(x, x, 2.0)]), "row 2"),
        (json!([row(x, x, 1.0), row("cables.1.anchor_m.w", x, 0.0)]), "row 2: the robot has no number"),
        (json!([row(x, x, 1e-6)]), "leave out one of them"),
    ] {
        let mut request = json!({
            "command": "uncertainty", "robot": { "text": funicular_robots::YUAN2014_4MM }, "of": ["pose"],
            "pose": [0.0, 0.0, 0.5, 0.0, 0.0, 0.0], "covariance": rows,
        });
        if part == "leave out one of them" {
            request["deviations"] = json!(["cables.1.anchor_m.x=0.001"]);
        }
        let text = Request::from_json(&request.to_string())
            .and_then(|request| run(&request, &mut Silent).map(drop))
            .map_or_else(|error| error.to_string(), |()| "no error".to_owned());
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn a_grid_is_the_list_of_its_poses() {
    let common = json!({ "deviations": ["cables.*.anchor_m=0.002"], "of": ["pose"] });
    let with = |more: Value| {
        let mut all = common.clone();
        all.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        uncertainty(funicular_robots::COGIRO, &all)
    };
    let grid = with(json!({
        "pose": [0.0, 1.0, 1.5, 0.0, 0.0, 5.0],
        "grid": [{ "axis": "x", "values": [-1.0, 2.0] }, { "axis": "z", "values": [1.0, 2.0] }],
    }));
    let rows = [[-1.0, 1.0], [-1.0, 2.0], [2.0, 1.0], [2.0, 2.0]].map(|[x, z]| [x, 1.0, z, 0.0, 0.0, 5.0]);
    let list = with(json!({ "poses": rows }));
    assert_eq!(grid.poses.len(), 4);
    for (a, b) in grid.poses.iter().zip(&list.poses) {
        for (one, other) in a.results.iter().zip(&b.results) {
            let (one, other) = (one.deviation.unwrap(), other.deviation.unwrap());
            assert!((one - other).abs() <= 1e-9 * other.abs().max(1e-6), "{one} and {other}");
        }
    }
    assert!(grid.notes.iter().any(|note| note.starts_with("Position: from")), "{:?}", grid.notes);
}
