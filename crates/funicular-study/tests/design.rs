//! Design: optima against random designs, multipliers against wider bounds, demands, modes that cross, and refusals.

#[path = "design/goals.rs"]
mod goals;

use funicular_study::analyses::design::Designed;
use funicular_study::{Error, ErrorKind, Request, Results, Silent, Watch, run};
use serde_json::{Value, json};

fn cogiro() -> Value {
    json!({"text": funicular_robots::COGIRO})
}

/// Request with the keys of `more`.
fn request(more: &Value) -> Request {
    let mut request = json!({"command": "design", "robot": cogiro(), "target_tension_n": [350.0]});
    for (key, value) in more.as_object().unwrap() {
        request[key] = value.clone();
    }
    serde_json::from_value(request).unwrap()
}

fn designed(more: &Value) -> Result<Designed, Error> {
    let Results::Design(found) = run(&request(more), &mut Silent)? else { panic!("design was requested") };
    Ok(*found)
}

/// First frequency of the platform of a robot file at a pose, by `modes`.
fn platform_hz(text: &str, pose: [f64; 3]) -> f64 {
    platform_hz_by(text, pose, &json!({"target_tension_n": [350.0]}))
}

/// Gradients with tensions that follow a rule.
fn platform_hz_by(text: &str, pose: [f64; 3], rule: &Value) -> f64 {
    let mut request = json!({
        "command": "modes", "robot": {"text": text}, "pose": pose, "below_hz": 20.0, "cable_model": "catenary-static",
    });
    for (key, value) in rule.as_object().unwrap() {
        request[key] = value.clone();
    }
    let Ok(Results::Modes(found)) = run(&Request::from_json(&request.to_string()).unwrap(), &mut Silent) else {
        panic!("modes were requested")
    };
    found.modes[0].frequency_hz
}

/// Natural frequencies of the platform of a robot file at a pose, by `modes`.
fn frequencies(text: &str, pose: [f64; 3]) -> Vec<f64> {
    let request = json!({
        "command": "modes", "robot": {"text": text}, "pose": pose, "target_tension_n": [350.0], "below_hz": 20.0,
        "cable_model": "catenary-static",
    });
    let Ok(Results::Modes(modes)) = run(&Request::from_json(&request.to_string()).unwrap(), &mut Silent) else {
        panic!("modes were requested")
    };
    modes.modes.iter().map(|mode| mode.frequency_hz).collect()
}

/// Numbers in (−1, 1) without pattern.
fn spread(i: usize, k: usize) -> f64 {
    2.0 * ((i as f64 + 1.0) * (k as f64 + 2.0).sqrt() * std::f64::consts::E).fract() - 1.0
}

/// Robot with other attachment heights, as the designs below change them.
fn with_heights(heights: &[f64]) -> String {
    with_heights_of(funicular_robots::COGIRO, heights)
}

fn with_heights_of(text: &str, heights: &[f64]) -> String {
    let mut text = text.to_owned();
    let mut from = 0;
    for height in heights {
        let at = from + text[from..].find("attachment_m = [").unwrap();
        let end = at + text[at..].find(']').unwrap();
        let comma = text[at..end].rfind(',').unwrap() + at;
        text.replace_range(comma + 1..end, &format!(" {height}"));
        from = at + 10;
    }
    text
}

/// Nine poses of CoGiRo, attachments within 5 cm: a separate program, with its own cables and a general linear solver,
/// has brought the worst first frequency from 1.587 Hz to 1.677 Hz, with the four corners equal.
#[test]
fn attachments_of_cogiro_raise_its_worst_frequency_as_a_separate_program_found() {
    let axis = |size: f64| [-size, 0.0, size];
    let poses: Vec<[f64; 6]> =
        axis(3.5).into_iter().flat_map(|x| axis(2.5).map(|y| [x, y, 1.0, 0.0, 0.0, 0.0])).collect();
    let change = json!([{"path": "cables.*.attachment_m", "plus_minus": 0.05}]);
    let found = designed(&json!({"poses": poses, "change": change})).unwrap();
    assert!(found.converged, "{}", found.ending);
    assert!(
        (found.before - 1.587).abs() < 5e-4 && (found.after - 1.677).abs() < 5e-4,
        "{} {}",
        found.before,
        found.after
    );
    let corners = [0, 2, 6, 8];
    for (i, row) in found.poses.iter().enumerate() {
        let is_corner = corners.contains(&i);
        assert_eq!(row.share > 1e-6, is_corner, "pose {}", i + 1);
        assert!(!is_corner || (row.after - found.after).abs() < 1e-3, "pose {}", i + 1);
    }
    assert!((found.poses.iter().map(|row| row.share).sum::<f64>() - 1.0).abs() < 1e-9);
    assert!(found.limits[0].contains("limited by poses 1, 3, 7, 9"), "{:?}", found.limits);
}

/// No random design within the bounds is better than the optimum, and the file that is written has its frequency.
#[test]
fn no_random_design_is_better_than_the_optimum() {
    let pose = [3.0, 2.0, 1.2];
    let change = json!([{"path": "cables.*.attachment_m.z", "plus_minus": 0.2}]);
    let found = designed(&json!({"pose": pose, "goal": "platform", "change": change})).unwrap();
    assert!((platform_hz(&found.robot_file, pose) / found.after - 1.0).abs() < 1e-9);
    assert!((platform_hz(funicular_robots::COGIRO, pose) / found.before - 1.0).abs() < 1e-9);
    let mut best = 0.0_f64;
    for i in 0..60 {
        let heights: Vec<f64> = (0..8)
            .map(|k| {
                let row = &found.values[k];
                // Half of the designs near the optimum, half anywhere.
                let (center, reach) = if i % 2 == 0 { (row.start, 0.2) } else { (row.value, 0.05) };
                (center + reach * spread(i, k)).clamp(row.minimum, row.maximum)
            })
            .collect();
        best = best.max(platform_hz(&with_heights(&heights), pose));
    }
    assert!(best <= found.after * (1.0 + 1e-5), "{best} {}", found.after);
    assert!(best > found.before, "{best} {}", found.before);
}

/// Load factor of a robot file at a pose, by `loads`.
fn load_factor(text: &str, pose: [f64; 3]) -> f64 {
    let request = json!({"command": "loads", "robot": {"text": text}, "pose": pose});
    let Ok(Results::Loads(found)) = run(&Request::from_json(&request.to_string()).unwrap(), &mut Silent) else {
        panic!("loads were requested")
    };
    found.required.unwrap().load_factor.unwrap()
}

/// The worst load factor of three poses rises as far as no random design does, and `loads` confirms it at each pose. A
/// heavier platform changes it.
#[test]
fn attachments_of_cogiro_hold_more_of_the_required_loads() {
    let text =
        format!("{}\n[required]\nforce_n = [200, 200, 300]\nmoment_n_m = [50, 50, 0]\n", funicular_robots::COGIRO);
    let poses = [[2.0, 1.0, 1.2], [0.0, 0.0, 1.5], [-2.0, -1.0, 2.0]];
    let worst = |text: &str| poses.iter().map(|pose| load_factor(text, *pose)).fold(f64::INFINITY, f64::min);
    let rows: Vec<[f64; 6]> = poses.iter().map(|[x, y, z]| [*x, *y, *z, 0.0, 0.0, 0.0]).collect();
    let change = json!([{"path": "cables.*.attachment_m.z", "plus_minus": 0.2}]);
    let request = json!({"robot": {"text": text}, "poses": rows, "goal": "load-factor", "change": change});
    let found = designed(&request).unwrap();

    assert!((worst(&text) / found.before - 1.0).abs() < 1e-9);
    assert!((worst(&found.robot_file) / found.after - 1.0).abs() < 1e-9);
    for (pose, row) in poses.iter().zip(&found.poses) {
        assert!((load_factor(&found.robot_file, *pose) / row.after - 1.0).abs() < 1e-9, "{pose:?}");
    }
    let best = (0..40)
        .map(|i| {
            let heights: Vec<f64> = (0..8)
                .map(|k| {
                    let row = &found.values[k];
                    let (center, reach) = if i % 2 == 0 { (row.start, 0.2) } else { (row.value, 0.05) };
                    (center + reach * spread(i, k)).clamp(row.minimum, row.maximum)
                })
                .collect();
            worst(&with_heights_of(&text, &heights))
        })
        .fold(0.0, f64::max);
    assert!(found.after > 1.02 * found.before, "{} {}", found.before, found.after);
    assert!(best <= found.after * (1.0 + 1e-5), "{best} {}", found.after);

    let heavier = found.robot_file.replacen("mass_kg = 91.058", "mass_kg = 91.97", 1);
    assert!((worst(&heavier) / found.after - 1.0).abs() > 1e-4);
}

/// CoGiRo with its pulleys and winches at three poses, with every rule that has derivatives: the file that is written
/// has the frequencies that are told, and no random design within the bounds is better.
#[test]
fn a_redundant_robot_on_winches_has_designs_by_every_rule() {
    let text = funicular_robots::COGIRO_WINCHES;
    let poses = [[3.0, 2.0, 1.2], [0.0, 0.0, 1.5], [-3.0, 1.0, 2.0]];
    let rows: Vec<[f64; 6]> = poses.iter().map(|[x, y, z]| [*x, *y, *z, 0.0, 0.0, 0.0]).collect();
    let change = json!([{"path": "cables.*.attachment_m.z", "plus_minus": 0.1}]);
    for rule in [
        json!({"target_tension_n": [350.0]}),
        json!({"target_tension_n": null, "tension_rule": "lowest"}),
        json!({"target_tension_n": null, "tension_rule": "middle"}),
    ] {
        let mut more = json!({"robot": {"text": text}, "poses": rows, "goal": "platform", "change": change});
        for (key, value) in rule.as_object().unwrap() {
            more[key] = value.clone();
        }
        let found = designed(&more).unwrap();
        assert!(found.converged && found.after > 1.01 * found.before, "{rule}: {} {}", found.before, found.after);

        let worst =
            |text: &str| poses.iter().map(|pose| platform_hz_by(text, *pose, &rule)).fold(f64::INFINITY, f64::min);
        assert!((worst(&found.robot_file) / found.after - 1.0).abs() < 1e-9, "{rule}");
        let mut best = 0.0_f64;
        for i in 0..16 {
            let heights: Vec<f64> = (0..8)
                .map(|k| {
                    let row = &found.values[k];
                    // Half of the designs near the optimum, half anywhere.
                    let (center, reach) = if i % 2 == 0 { (row.start, 0.1) } else { (row.value, 0.02) };
                    (center + reach * spread(i, k)).clamp(row.minimum, row.maximum)
                })
                .collect();
            best = best.max(worst(&with_heights_of(text, &heights)));
        }
        assert!(best <= found.after * (1.0 + 1e-5) && best > found.before, "{rule}: {best} {}", found.after);
    }
}

/// Numbers of pulleys and winches can be chosen, too, and the gain of a bound is that of more room.
#[test]
fn pulleys_and_winches_are_values_of_a_design() {
    let design = |more: f64| {
        let change = json!([
            {"path": "pulleys.*.radius_m", "minimum": 0.04, "maximum": 0.06 + more},
            {"path": "winches.*.drum_side_length_m", "minimum": 4.9, "maximum": 5.9},
        ]);
        let robot = json!({"text": funicular_robots::COGIRO_WINCHES});
        let rule = json!({"robot": robot, "pose": [2.0, 1.0, 1.5], "goal": "platform", "change": change});
        designed(&rule).unwrap()
    };
    let (found, wider) = (design(0.0), design(0.001));
    let row = &found.values[0];
    assert!(row.at_bound == Some("maximum") && row.gain_per_unit > 0.0, "{}", row.gain_per_unit);
    let gained = (wider.after - found.after) / 0.001;
    // Over 1 mm the slope changes by a per cent or so; the search ends at 1e-5 of the frequency.
    let allowed = 0.02 * gained + 1e-5 * found.after / 0.001;
    assert!((gained - row.gain_per_unit).abs() < allowed, "{gained} {}", row.gain_per_unit);
}

/// The gain of a bound is the gain of a design with more room there.
#[test]
fn gains_of_bounds_are_those_of_designs_with_more_room() {
    let design = |more: f64| {
        let change = json!([
            {"path": "cables.1.attachment_m.z", "minimum": -0.05 - more, "maximum": 0.05 + more},
            {"path": "cables.*.anchor_m.z", "minimum": 5.3, "maximum": 5.5},
        ]);
        designed(&json!({"pose": [2.0, 1.0, 1.5], "goal": "platform", "change": change})).unwrap()
    };
    let (found, wider) = (design(0.0), design(0.005));
    let row = &found.values[0];
    assert!(row.at_bound.is_some() && row.gain_per_unit > 0.0, "{}", row.gain_per_unit);
    let gained = (wider.after - found.after) / 0.005;
    // Over 5 mm the slope changes by some per cent; the search ends at 1e-5 of the frequency.
    let allowed = 0.1 * gained + 1e-5 * found.after / 0.005;
    assert!((gained - row.gain_per_unit).abs() < allowed, "{gained} {}", row.gain_per_unit);
}

/// The least rope under a stiffness: the demand holds, costs what its multiplier says, and without it the ropes are
/// shorter.
#[test]
fn demands_are_met_and_their_multipliers_are_their_cost() {
    let design = |stiffness: Option<f64>| {
        let change = json!([{"path": "cables.*.anchor_m", "plus_minus": 0.5}]);
        let mut more = json!({"pose": [1.0, 0.5, 1.5], "goal": "rope-mass", "change": change});
        if let Some(limit) = stiffness {
            more["min_stiffness_n_per_m"] = json!(limit);
        }
        designed(&more).unwrap()
    };
    let free = design(None);
    assert!(free.after < free.before && free.values.iter().all(|row| row.at_bound.is_some()));
    let stiff = design(Some(62_000.0));
    let row = &stiff.demands[0];
    assert!(row.after >= 62_000.0 * (1.0 - 1e-6), "{} {}", row.before, row.after);
    assert!(stiff.after > free.after && row.gain_per_unit > 0.0, "{} {}", stiff.after, free.after);
    let relaxed = design(Some(61_500.0));
    let gained = (stiff.after - relaxed.after) / 500.0;
    assert!((gained - row.gain_per_unit).abs() < 0.2 * gained, "{gained} {}", row.gain_per_unit);
}

/// All frequencies leave a band, to the sides on which they are.
#[test]
fn frequencies_leave_a_band() {
    let change = json!([{"path": "cables.*.attachment_m", "plus_minus": 0.1}]);
    let more = json!({
        "pose": [3.0, 2.0, 1.2], "goal": "stiffness-min", "change": change, "cable_model": "catenary-static",
        "avoid_hz": [4.95, 5.1],
    });
    let found = designed(&more).unwrap();
    let row = &found.demands[0];
    assert!(row.before > 4.95 && row.before < 5.1, "{}", row.before);
    let hz = frequencies(&found.robot_file, [3.0, 2.0, 1.2]);
    assert_eq!(hz.iter().filter(|hz| **hz > 4.9501 && **hz < 5.0999).count(), 0, "{hz:?}");
    // The band does not limit the result: no other sides are tried.
    assert!(found.band_sides.is_empty(), "{:?}", found.band_sides);
}

/// A frequency a little below the middle of a band leaves it upwards if the robot is better so; all choices are told.
/// The result is that of the search with this choice, and no frequency is in the band.
#[test]
fn frequencies_leave_a_band_to_the_farther_side_if_that_is_better() {
    let change = json!([{"path": "cables.*.attachment_m", "plus_minus": 0.1}]);
    let more = json!({
        "pose": [3.0, 2.0, 1.2], "goal": "stiffness-min", "change": change, "cable_model": "catenary-static",
        "avoid_hz": [4.9, 5.2],
    });
    let found = designed(&more).unwrap();
    let before = found.poses[0].beside_band_before_hz.unwrap();
    assert!(before > 4.9 && before < 5.05, "{before}");
    let [nearer, others @ ..] = found.band_sides.as_slice() else { panic!("choices of the sides") };
    let other = others.iter().find(|tried| tried.is_chosen).expect("another choice");
    assert_eq!(other.below[0] + 1, nearer.below[0]);
    assert!(other.after.unwrap() > nearer.after.unwrap() && !nearer.is_chosen, "{:?}", found.band_sides);
    assert!((other.after.unwrap() / found.after - 1.0).abs() < 1e-6, "{:?}", found.band_sides);
    assert!(found.limits.iter().any(|sentence| sentence.contains("below the band")), "{:?}", found.limits);
    let hz = frequencies(&found.robot_file, [3.0, 2.0, 1.2]);
    assert_eq!(hz.iter().filter(|hz| **hz > 4.9001 && **hz < 5.1999).count(), 0, "{hz:?}");
    assert_eq!(hz.iter().filter(|hz| **hz < 5.0).count(), other.below[0], "{hz:?}");
}

#[test]
fn demands_that_no_values_meet_are_no_solution_with_what_was_reached() {
    let change = json!([{"path": "cables.1.attachment_m", "plus_minus": 0.01}]);
    let more = json!({"pose": [0.0, 0.0, 1.5], "goal": "rope-length", "change": change, "min_frequency_hz": 20.0});
    let error = designed(&more).err().unwrap();
    assert_eq!(error.kind(), ErrorKind::NoSolution);
    let message = error.message(funicular_study::wording::Words::Program);
    assert!(message.contains("no values within the bounds of --change meet all demands"), "{message}");
    assert!(message.contains("first natural frequency at least 20") && message.contains("at pose 1"), "{message}");
}

/// Observer that stops the search after an iteration.
struct Impatient(usize);

impl Watch for Impatient {
    fn progress(&mut self, done: usize, _: usize, _: &'static str) {
        self.0 = done;
    }

    fn is_cancelled(&self) -> bool {
        self.0 > 0
    }
}

#[test]
fn a_search_that_is_stopped_keeps_its_best_values() {
    let change = json!([{"path": "cables.*.attachment_m", "plus_minus": 0.05}]);
    let request = request(&json!({"pose": [3.0, 2.0, 1.2], "goal": "platform", "change": change}));
    let Ok(Results::Design(found)) = run(&request, &mut Impatient(0)) else { panic!("a design") };
    assert!(!found.converged && found.iterations == 1 && found.after > found.before);
    assert!(found.ending.contains("stopped after 1 iteration"), "{}", found.ending);
}

#[test]
fn a_mean_of_poses_weighs_them() {
    let change = json!([{"path": "cables.*.attachment_m.z", "plus_minus": 0.1}]);
    let poses = [[3.0, 2.0, 1.2, 0.0, 0.0, 0.0], [0.0, 0.0, 1.5, 0.0, 0.0, 0.0]];
    let design = |weights: [f64; 2]| {
        designed(&json!({"poses": poses, "weights": weights, "goal": "platform", "change": change})).unwrap()
    };
    let (first, second) = (design([10.0, 1.0]), design([1.0, 10.0]));
    assert!(first.poses[0].after > second.poses[0].after && first.poses[1].after < second.poses[1].after);
    let mean = (10.0 * first.poses[0].after + first.poses[1].after) / 11.0;
    assert!((first.after - mean).abs() < 1e-12);
}

#[test]
fn a_table_stands_for_its_numbers_that_the_file_gives() {
    let with = |path: &str| {
        designed(&json!({
            "pose": [1.0, 0.5, 1.5], "goal": "rope-length", "max_iterations": 1,
            "change": [{"path": path, "plus_minus": 0.01}],
        }))
    };
    let paths = |found: &Designed| found.values.iter().map(|value| value.path.clone()).collect::<Vec<_>>();
    // A mass, a tensor with six numbers, and a point; not the drag area, which the file leaves out.
    let table = paths(&with("platform").unwrap());
    assert!(table.len() == 10 && table.iter().all(|path| path.starts_with("platform.")), "{table:?}");
    assert!(!table.iter().any(|path| path.contains("drag")), "{table:?}");
    assert_eq!(paths(&with("cables.1.anchor_m.2").unwrap()), ["cables.1.anchor_m.z"]);
}

#[test]
fn wrong_designs_are_refused_with_the_reason() {
    let z = json!([{"path": "cables.*.attachment_m.z", "plus_minus": 0.1}]);
    for (more, expected) in [
        (json!({"change": []}), "--change is empty"),
        (json!({"change": [{"path": "cables.*.atachment_m", "plus_minus": 0.1}]}), "no such number; did you mean"),
        (
            json!({"change": [{"path": "platform.mass_kg", "minimum": 100.0, "maximum": 90.0}]}),
            "is not below the maximum",
        ),
        (json!({"change": [{"path": "platform.mass_kg", "minimum": 95.0, "maximum": 99.0}]}), "not between the bounds"),
        (json!({"change": [{"path": "platform.mass_kg"}]}), "both bounds are needed"),
        (json!({"change": [{"path": "platform.mass_kg", "plus_minus": 0.0}]}), "leaves no room"),
        (
            json!({"change": [{"path": "cables.1.unstrained_length_m", "plus_minus": 0.1}]}),
            "the lengths follow from them",
        ),
        (
            json!({"change": [{"path": "materials.*.breaking_load_n", "plus_minus": 100.0}]}),
            "results have no derivatives by this value",
        ),
        (json!({"change": z, "poses": [[0, 0, 1.5, 0, 0, 0]], "weights": [1.0, 2.0]}), "give one per pose"),
        (json!({"change": z, "pose": [0, 0, 1.5], "avoid_hz": [3.0, 2.0]}), "is not below the last one"),
        (json!({"change": z, "pose": [0, 0, 1.5], "tension_rule": "stiffest", "target_tension_n": null}), "`stiffest`"),
        (json!({"change": z}), "give a pose"),
        (json!({"change": z, "target_tension_n": null}), "a design holds its poses: give --poses, --grid or --pose"),
        (json!({"change": z, "pose": [0, 0, 1.5], "max_iterations": 0}), "give a whole number from 1"),
    ] {
        let error = designed(&more).err().unwrap_or_else(|| panic!("{more}"));
        let message = error.message(funicular_study::wording::Words::Program);
        assert!(message.contains(expected), "{more}: {message}");
        assert_eq!(error.kind(), ErrorKind::Input, "{more}: {message}");
    }

    // A pose without tensions is no solution, and is named.
    let poses = [[0.0, 0.0, 1.5, 0.0, 0.0, 0.0], [30.0, 0.0, 1.0, 0.0, 0.0, 0.0]];
    let error = designed(&json!({"change": z, "poses": poses})).err().unwrap();
    assert_eq!(error.kind(), ErrorKind::NoSolution);
    let message = error.message(funicular_study::wording::Words::Program);
    assert!(message.contains("pose 2, (30, 0, 1) m"), "{message}");
}
