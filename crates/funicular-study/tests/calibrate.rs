//! Calibration through a request: profiles, priors, proposals, and whether intervals hold the truth.

use funicular::math::DMat;
use funicular_study::analyses::calibrate::Calibrated;
use funicular_study::{Request, Results, Silent, run};
use serde_json::{Map, Value, json};

/// Anchors of a planar robot [m].
const ANCHORS: [[f64; 2]; 4] = [[0.0, 0.0], [4.0, 0.0], [3.9, 3.0], [-0.1, 2.9]];

/// Positions at which it is read [m].
const POSITIONS: [[f64; 2]; 7] = [[1.2, 1.0], [2.7, 0.9], [2.8, 2.1], [1.1, 2.0], [2.0, 0.6], [3.1, 1.5], [0.8, 1.5]];

/// Robot file with the anchors.
fn file() -> String {
    let cables = ANCHORS.iter().enumerate().map(|(i, [x, y])| {
        format!("[[cables]]\nname = \"{}\"\nmaterial = \"rope\"\nanchor_m = [{x}, {y}, 0.0]\n", i + 1)
    });
    format!(
        "name = \"plotter\"\n[platform]\nmass_kg = 1\ninertia_kg_m2 = [1, 1, 1]\nmotion = \"planar-xy\"\n\
         [materials.rope]\naxial_stiffness_n = 1e7\nmass_kg_per_m = 0.0\n{}",
        cables.map(|cable| cable + "attachment_m = [0, 0, 0]\n").collect::<String>()
    )
}

/// Random numbers of a fixed seed.
struct Draws(u64);

impl Draws {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Box and Muller.
    fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.uniform()).ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

/// Readings at the positions with noise [m].
fn readings(deviation: f64, draws: &mut Draws) -> Value {
    let column = |[x, y]: [f64; 2], draws: &mut Draws| -> Vec<f64> {
        POSITIONS.iter().map(|[px, py]| (px - x).hypot(py - y) + deviation * draws.normal()).collect()
    };
    let columns =
        ANCHORS.iter().enumerate().map(|(i, anchor)| (format!("length_{}_m", i + 1), json!(column(*anchor, draws))));
    Value::Object(columns.collect::<Map<_, _>>())
}

/// Calibration of the robot from readings, with further keys.
fn calibrated(readings: &Value, more: &Value) -> Calibrated {
    let mut request = json!({ "command": "calibrate", "robot": { "text": file() }, "readings": readings });
    request.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    match run(&Request::from_json(&request.to_string()).unwrap(), &mut Silent).unwrap() {
        Results::Calibrate(found) => *found,
        _ => panic!("calibrate was requested"),
    }
}

/// Truth of a value by its path.
fn truth(path: &str) -> f64 {
    let keys: Vec<&str> = path.split('.').collect();
    ANCHORS[keys[1].parse::<usize>().unwrap() - 1][usize::from(keys[3] == "y")]
}

#[test]
fn profiles_are_the_intervals_of_the_deviations_where_chi_squared_is_a_parabola() {
    // With noise of 10 µm everything is linear: the ends differ by their accuracy of 0.1 % and the curvature.
    let readings = readings(1e-5, &mut Draws(3));
    for (more, factor) in [(json!({ "length_std_m": 1e-5 }), 1.0), (json!({}), 1.0)] {
        let mut more = more;
        more["profile"] = json!(["anchors"]);
        let found = calibrated(&readings, &more);
        let profiled: Vec<_> = found.values.iter().filter(|row| row.profile.is_some()).collect();
        assert_eq!(profiled.len(), 5, "the frame holds three of eight coordinates");
        for row in profiled {
            let (profile, [from, to]) = (row.profile.as_ref().unwrap(), row.interval_95.unwrap());
            let half = factor * 0.5 * (to - from);
            assert!((profile.from.unwrap() - from).abs() < 3e-3 * half, "{}: {:?} {from}", row.path, profile.from);
            assert!((profile.to.unwrap() - to).abs() < 3e-3 * half, "{}: {:?} {to}", row.path, profile.to);
            assert!(!profile.falls && profile.points.len() > 6);
        }
    }
}

#[test]
fn profiles_hold_the_truth_where_chi_squared_is_curved() {
    // Noise of 2 cm leaves up to 20 cm: the linear intervals are not symmetric any more.
    let mut draws = Draws(17);
    let (mut held, mut count) = (0_u32, 0_u32);
    for _ in 0..60 {
        let readings = readings(0.02, &mut draws);
        let found = calibrated(&readings, &json!({ "length_std_m": 0.02, "profile": ["anchors"] }));
        for row in found.values.iter().filter(|row| !row.held) {
            // The frame is that of the truth: the second anchor is on the x axis through the first.
            let profile = row.profile.as_ref().unwrap();
            let is_within = profile.from.is_none_or(|from| from <= truth(&row.path))
                && profile.to.is_none_or(|to| truth(&row.path) <= to);
            held += u32::from(is_within);
            count += 1;
        }
    }
    let share = f64::from(held) / f64::from(count);
    // 300 intervals of correlated values: 95 % ± 3 deviations.
    assert!((0.90..=0.985).contains(&share), "{held} of {count}");
}

#[test]
fn profiles_are_named_by_kinds_and_paths_and_other_names_are_refused() {
    let readings = readings(1e-3, &mut Draws(5));
    let found = calibrated(&readings, &json!({ "profile": ["cables.*.anchor_m.y"] }));
    let profiled: Vec<&str> =
        found.values.iter().filter(|row| row.profile.is_some()).map(|row| row.path.as_str()).collect();
    assert_eq!(profiled, ["cables.3.anchor_m.y", "cables.4.anchor_m.y"]);

    let request = json!({
        "command": "calibrate", "robot": { "text": file() }, "readings": readings, "profile": ["cables.9.anchor_m"],
    });
    let refused = run(&Request::from_json(&request.to_string()).unwrap(), &mut Silent).map(drop).unwrap_err();
    let text = refused.to_string();
    assert!(text.contains("no unknown is called `cables.9.anchor_m`"), "{text}");
}

#[test]
fn a_prior_is_a_datum_of_its_kind_or_path() {
    let readings = readings(1e-3, &mut Draws(9));
    let keys = |prior: Value| json!({ "unknowns": ["anchors", "offsets"], "length_std_m": 1e-3, "prior": prior });
    let without = calibrated(&readings, &keys(json!([])));
    let with = calibrated(&readings, &keys(json!([{ "path": "offsets", "prior": 0.0, "prior_std": 1e-3 }])));
    assert_eq!(with.degrees_of_freedom, without.degrees_of_freedom + 4);
    let deviation = |found: &Calibrated, path: &str| {
        found.values.iter().find(|row| row.path == path).and_then(|row| row.deviation).unwrap()
    };
    assert!(deviation(&with, "offset of cable 2") < 1e-3);
    assert!(deviation(&with, "cables.3.anchor_m.x") < 0.5 * deviation(&without, "cables.3.anchor_m.x"));

    let text = |prior: Value| {
        let request =
            json!({ "command": "calibrate", "robot": { "text": file() }, "readings": readings, "prior": prior });
        let read = Request::from_json(&request.to_string());
        read.and_then(|request| run(&request, &mut Silent).map(drop)).unwrap_err().to_string()
    };
    let unknown = text(json!([{ "path": "offsets", "prior_std": 0.1 }]));
    assert!(unknown.contains("no unknown is called `offsets`"), "{unknown}");
    let wrong = text(json!([{ "path": "anchors", "prior_std": -0.1 }]));
    assert!(wrong.contains("not positive") || wrong.contains("positive"), "{wrong}");
}

/// Tensions of the cables are limited: candidates near a side have none.
#[test]
fn candidates_without_tensions_within_the_limits_are_left_out() {
    let readings = readings(1e-3, &mut Draws(9));
    let grid = json!([{ "axis": "x", "values": [0.2, 2.0, 3.8] }, { "axis": "y", "values": [1.5, 3.4] }]);
    let keys = |more: Value| {
        let mut keys = json!({ "propose": 1, "grid": grid });
        keys.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        keys
    };
    let free = calibrated(&readings, &keys(json!({})));
    assert!(free.left_out.is_none() && (free.proposals[0].position_m[1] - 3.4).abs() < 1e-12);
    // A candidate above the upper anchors cannot be held by cables that pull.
    let limited = calibrated(&readings, &keys(json!({ "min_tension_n": 5.0, "max_tension_n": 100.0 })));
    let left_out = limited.left_out.unwrap();
    assert_eq!((left_out.candidates, left_out.by_tensions, left_out.by_clearance), (6, 3, 0));
    assert!((limited.proposals[0].position_m[1] - 1.5).abs() < 1e-12);
    assert!(limited.proposals[0].total_m > free.proposals[0].total_m);
}

#[test]
fn a_row_that_is_left_out_is_no_datum_and_the_others_keep_their_numbers() {
    let all = readings(1e-3, &mut Draws(5));
    let without = |gone: &[usize]| {
        let columns = all.as_object().unwrap().iter().map(|(name, values)| {
            let kept = values.as_array().unwrap().iter().enumerate().filter(|(j, _)| !gone.contains(j));
            (name.clone(), kept.map(|(_, value)| value.clone()).collect::<Vec<_>>().into())
        });
        Value::Object(columns.collect())
    };
    let found = calibrated(&all, &json!({ "leave_out": [2, 5] }));
    let shorter = calibrated(&without(&[1, 4]), &json!({}));
    let values = |of: &Calibrated| of.values.iter().map(|row| (row.value, row.deviation)).collect::<Vec<_>>();
    assert_eq!(values(&found), values(&shorter));
    assert_eq!(found.rows.iter().map(|row| row.row).collect::<Vec<_>>(), [1, 3, 4, 6, 7]);
    assert_eq!(found.refit_data()["rows"], json!([1, 3, 4, 6, 7]));

    let refused = |more: Value| {
        let mut request = json!({ "command": "calibrate", "robot": { "text": file() }, "readings": all });
        request.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        let read = Request::from_json(&request.to_string());
        read.and_then(|request| run(&request, &mut Silent)).err().unwrap().to_string()
    };
    let none = "there is no such row: give numbers from 1 to 7";
    for (wrong, reason) in [(8.0, none), (0.5, none), (-1.0, "`leave_out`, number 1: -1 is not positive")] {
        let told = refused(json!({ "leave_out": [wrong] }));
        assert!(told.contains(reason), "{told}");
    }
    assert!(refused(json!({ "leave_out": [1, 2, 3, 4, 5, 6, 7] })).contains("leaves no row of 7"));
}

#[test]
fn the_linear_equations_of_a_page_give_the_fit_without_a_row() {
    // Without noise in the other rows, a reading that is wrong by little moves the values linearly.
    let mut wrong = readings(0.0, &mut Draws(1));
    let reading = &mut wrong["length_2_m"][3];
    *reading = json!(reading.as_f64().unwrap() + 1e-5);
    let data = calibrated(&wrong, &json!({})).refit_data();
    let exact = calibrated(&wrong, &json!({ "leave_out": [4] }));

    // The page's own arithmetic: (N - WᵀW) step = Wᵀr of the row that goes.
    let list = |value: &Value| value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect::<Vec<_>>();
    let rows = |value: &Value| value.as_array().unwrap().iter().map(list).collect::<Vec<_>>();
    let linear = &data["linear"];
    let (information, free) = (rows(&linear["information"]), rows(&linear["free"]));
    let (by_free, residuals) = (rows(&linear["rows"][3]["by_free"]), list(&linear["rows"][3]["residuals"]));
    let n = information.len();
    let normal = DMat::from_fn(n, n, |a, b| information[a][b] - by_free.iter().map(|w| w[a] * w[b]).sum::<f64>());
    let right = DMat::from_fn(n, 1, |a, _| by_free.iter().zip(&residuals).map(|(w, r)| w[a] * r).sum());
    let step = normal.lu().solve(&right).unwrap();
    for (k, row) in exact.values.iter().enumerate() {
        let moved: f64 = free[k].iter().zip(step.iter()).map(|(of, by)| of * by).sum();
        let refitted = data["values"][k]["value"].as_f64().unwrap() + if row.held { 0.0 } else { moved };
        // The change is some 1e-5 m; what is left is of second order.
        assert!((refitted - row.value).abs() < 1e-8, "{}: {refitted} {}", row.path, row.value);
    }
}

/// Readings with two of them exchanged in one row.
fn with_exchange(readings: &Value, row: usize, [a, b]: [usize; 2]) -> Value {
    let mut wrong = readings.clone();
    let [of_a, of_b] = [a, b].map(|cable| readings[format!("length_{cable}_m")][row].clone());
    wrong[format!("length_{a}_m")][row] = of_b;
    wrong[format!("length_{b}_m")][row] = of_a;
    wrong
}

#[test]
fn a_row_with_exchanged_readings_is_blamed_and_no_other_one() {
    // With and without a given deviation, for every row and pairs of neighbours and of opposite corners.
    for row in 0..POSITIONS.len() {
        let cables = [[1, 2], [1, 3], [2, 3], [3, 4], [2, 4], [1, 4], [1, 2]][row];
        let readings = readings(1e-3, &mut Draws(row as u64 + 40));
        let [a, b] = cables.map(|cable| readings[format!("length_{cable}_m")][row].as_f64().unwrap());
        for more in [json!({ "length_std_m": 1e-3 }), json!({})] {
            // Readings that hardly differ cannot be told from each other.
            if (a - b).abs() < 0.2 {
                continue;
            }
            let found = calibrated(&with_exchange(&readings, row, cables), &more);
            let outliers: Vec<usize> = found.rows.iter().filter(|row| row.outlier).map(|row| row.row).collect();
            let says = format!("row {}, {cables:?}, {more}: {outliers:?} {:?}", row + 1, found.warnings);
            assert_eq!(outliers, [row + 1], "{says}");
            let told = format!("row {} does not agree with the others", row + 1);
            let pair = format!("with its readings of cables {} and {} exchanged it fits", cables[0], cables[1]);
            assert!(found.warnings.iter().any(|text| text.starts_with(&told) && text.ends_with(&pair)), "{says}");
            // Nothing else is blamed: neither columns nor encoders.
            assert!(!found.warnings.iter().any(|text| text.contains("columns") || text.contains("encoder")), "{says}");
        }
    }
}

#[test]
fn rows_on_a_line_leave_mirror_images_and_the_warning_says_what_tells_them_apart() {
    let mut draws = Draws(8);
    let on_line: Vec<[f64; 2]> = (0..9).map(|k| [0.6 + 0.3 * f64::from(k), 1.1 + 0.1 * f64::from(k)]).collect();
    let columns = ANCHORS.iter().enumerate().map(|(i, [x, y])| {
        let column: Vec<f64> = on_line.iter().map(|[px, py]| (px - x).hypot(py - y) + 5e-4 * draws.normal()).collect();
        (format!("length_{}_m", i + 1), json!(column))
    });
    let readings = Value::Object(columns.collect::<Map<_, _>>());
    let found = calibrated(&readings, &json!({ "length_std_m": 5e-4 }));
    assert!(!found.is_determined && found.determined.starts_with("Other values fit"), "{}", found.determined);
    assert!(found.minima.iter().any(|minimum| !minimum.mirrored.is_empty()));
    let told = found.warnings.iter().find(|text| text.contains("sets of values fit the readings")).unwrap();
    assert!(told.contains("on the other side of the line on which the rows lie"), "{told}");
    assert!(told.contains("tells them apart: the readings of the two differ there by"), "{told}");
    assert!(found.values.iter().all(|value| value.interval_95.is_none()));
    // The image near the robot file is shown.
    assert!(found.values.iter().all(|value| (value.value - value.start).abs() < 0.1));
}

#[test]
fn the_covariance_of_a_calibration_gives_uncertainty_the_accuracy_of_the_tool() {
    // Anchors and offsets are strongly correlated here: with a wrong sign between them the deviations are several times
    // as large.
    let at = [[1.95, 1.47, 0.0, 0.0, 0.0, 0.0], [2.4, 1.1, 0.0, 0.0, 0.0, 0.0]];
    let found = calibrated(
        &readings(1e-4, &mut Draws(5)),
        &json!({
            "unknowns": ["anchors", "offsets"], "length_std_m": 1e-4, "accuracy_poses": at,
            "prior": [{ "path": "offsets", "prior": 0.0, "prior_std": 2e-3 }],
        }),
    );
    let tool = found.accuracy.as_ref().unwrap();
    let covariance: Vec<Value> = found
        .covariance
        .iter()
        .map(|row| json!({ "first": row.first, "second": row.second, "covariance": row.covariance }))
        .collect();
    assert!(found.covariance.iter().any(|row| row.second == "cables.4.unstrained_length_m"));
    let deviations = |covariance: &[Value]| -> Vec<f64> {
        let request = json!({
            "command": "uncertainty", "robot": { "text": found.robot_file }, "of": ["pose"], "poses": at,
            "covariance": covariance, "samples": 4000,
        });
        match run(&Request::from_json(&request.to_string()).unwrap(), &mut Silent).unwrap() {
            Results::Uncertainty(found) => found.poses.iter().map(|pose| pose.position.unwrap().deviation_m).collect(),
            _ => panic!("uncertainty was requested"),
        }
    };
    let (ours, theirs) = (deviations(&covariance), &tool.poses);
    for (deviation, row) in ours.iter().zip(theirs) {
        // Elastic cables share what they contradict by EA/L, the tool by least squares; 4000 robots tell 1.1 %.
        let ratio = deviation / row.deviation_m;
        assert!((ratio - 1.0).abs() < 0.04, "{deviation} and {}", row.deviation_m);
    }
    let of_offsets = |row: &Value| row["second"].as_str().unwrap().contains("unstrained");
    let turned: Vec<Value> = covariance
        .iter()
        .cloned()
        .map(|mut row| {
            let is_mixed = of_offsets(&row) && row["first"].as_str().unwrap().contains("anchor");
            row["covariance"] = json!(if is_mixed { -1.0 } else { 1.0 } * row["covariance"].as_f64().unwrap());
            row
        })
        .collect();
    let wrong = deviations(&turned);
    assert!(wrong[0] > 1.5 * ours[0], "{wrong:?} {ours:?}");
}
