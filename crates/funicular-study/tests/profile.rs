//! Profiles of identified values: the interval of a linear problem, and curved ones against fits with the value held.

use funicular_study::analyses::identify::{Identified, OpenEnd, ValueRow};
use funicular_study::{Request, Results, Silent, Watch, run};
use serde_json::{Value, json};

/// Rise of χ² at the ends of an interval of 95 %.
const LIMIT: f64 = 3.841_458_820_694_124;

const POSE: [f64; 6] = [0.0, 0.0, 0.5, 0.0, 0.0, 0.0];
const LENGTHS: [f64; 6] = [6.863, 6.565, 6.756, 6.663, 6.801, 6.604];
const MODULUS: &str = "materials.rope-4mm.youngs_modulus_pa";

fn results(request: &Value) -> Results {
    run(&Request::from_json(&request.to_string()).unwrap(), &mut Silent).unwrap()
}

fn identified(request: &Value) -> Identified {
    match results(request) {
        Results::Identify(found) => *found,
        _ => panic!("identify was requested"),
    }
}

fn row<'a>(found: &'a Identified, path: &str) -> &'a ValueRow {
    found.values.iter().find(|row| row.path == path).unwrap()
}

/// Pose and tensions of the robot with changes.
fn at_rest(set: &[(&str, f64)], more: &Value) -> (Value, Vec<f64>) {
    let mut request = json!({"command": "statics", "robot": robot(set)});
    request.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    let Results::Statics(found) = results(&request) else { panic!("statics was requested") };
    let pose = json!({"position_m": found.pose.position_m, "quaternion_wxyz": found.pose.quaternion_wxyz});
    (pose, found.cables.iter().map(|cable| cable.tension_platform_n).collect())
}

/// Six-cable robot on straight cables without mass, with a load and changes.
fn robot(set: &[(&str, f64)]) -> Value {
    let text = funicular_robots::YUAN2014_4MM.replace("mass_kg_per_m = 0.067", "mass_kg_per_m = 0.0");
    assert_ne!(text, funicular_robots::YUAN2014_4MM);
    let set: Vec<Value> = set.iter().map(|(path, value)| json!({"path": path, "value": value})).collect();
    json!({"text": format!("{text}\n[loads]\nforce_n = [5.0, 3.0, -20.0]\n"), "set": set})
}

#[test]
fn the_profile_of_a_linear_problem_is_the_interval_of_its_deviation() {
    // At a held pose the tensions of straight cables are linear in the load. Errors of about one deviation.
    let (_, tensions) = at_rest(&[], &json!({"pose": POSE}));
    let errors = [0.8, -1.1, 0.4, 1.3, -0.6, -0.9];
    let measured: Vec<f64> = tensions.iter().zip(errors).map(|(tension, error)| tension + 0.5 * error).collect();
    let found = identified(&json!({
        "command": "identify", "robot": robot(&[]), "starts": 1, "profile": ["loads.force_n"],
        "fit": [{"path": "loads.force_n.x"}, {"path": "loads.force_n.z"}, {"path": "platform.center_of_mass_m.x"}],
        "experiments": [{
            "pose": POSE, "measured_tensions_n": measured, "tension_std_n": 0.5,
        }],
    }));
    assert!(row(&found, "platform.center_of_mass_m.x").profile.is_none());
    for path in ["loads.force_n.x", "loads.force_n.z"] {
        let row = row(&found, path);
        let (profile, [low, high]) = (row.profile.as_ref().unwrap(), row.interval_95.unwrap());
        let half = 0.5 * (high - low);
        let [from, to] = [profile.from, profile.to].map(Option::unwrap);
        // An end is found to 1e-3 of the half width.
        assert!((from - low).abs() < 1.5e-3 * half && (to - high).abs() < 1.5e-3 * half, "{path}: {from} {to}");
        // The points are on the parabola.
        for point in &profile.points {
            let expected = LIMIT * ((point.value - row.value) / half).powi(2);
            assert!((point.chi2_rise - expected).abs() < 1e-4 * LIMIT, "{path}: {point:?} {expected}");
        }
        assert!(profile.points.is_sorted_by(|a, b| a.value < b.value) && !profile.falls);
    }
}

/// Deviations of the position [m] that limit the stiffness on both sides, and from below alone.
const NARROW: f64 = 1e-3;
const WIDE: f64 = 8e-3;

/// Request of stiffness and mass from the pose, in which the ropes are some millimetres longer under load, and from
/// tensions.
fn stiffness(position_std_m: f64, more: &Value) -> Value {
    let (pose, tensions) = at_rest(&[], &json!({"lengths_m": LENGTHS}));
    let errors = [0.3, -0.4, 0.5, 0.2, -0.6, 0.1];
    let measured: Vec<f64> = tensions.iter().zip(errors).map(|(tension, error)| tension + 10.0 * error).collect();
    let mut request = json!({
        "command": "identify", "robot": robot(&[(MODULUS, 1.6e10)]), "starts": 1,
        "fit": [{"path": MODULUS}, {"path": "platform.mass_kg"}],
        "experiments": [{
            "lengths_m": LENGTHS, "measured_pose": pose, "position_std_m": position_std_m,
            "rotation_std_deg": 200.0 * position_std_m,
            "measured_tensions_n": measured, "tension_std_n": 5.0,
        }],
    });
    request.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    request
}

#[test]
fn a_curved_profile_is_asymmetric_and_agrees_with_fits_at_held_values() {
    let found = identified(&stiffness(NARROW, &json!({"profile": ["materials.*"]})));
    let row = row(&found, MODULUS);
    let profile = row.profile.as_ref().unwrap();
    let [from, to] = [profile.from, profile.to].map(Option::unwrap);
    // Sag is proportional to the inverse stiffness: the logarithm reaches farther up than down.
    let (down, up) = ((row.value / from).ln(), (to / row.value).ln());
    assert!(up > 1.3 * down, "{down} {up}");
    let [low, high] = row.interval_95.unwrap();
    assert!(((row.value / low).ln() - (high / row.value).ln()).abs() < 1e-9, "the deviation is symmetric");

    // A robot with this stiffness in its file, and the mass fitted alone.
    let factor = found.deviation_factor.powi(2);
    let rise = |value: f64| {
        let fit = json!([{"path": "platform.mass_kg"}]);
        let mut request = stiffness(NARROW, &json!({"fit": fit}));
        request["robot"] = robot(&[(MODULUS, value)]);
        (identified(&request).chi2 - found.chi2) / factor
    };
    for end in [from, to] {
        // The root of the rise is accurate to 1e-3.
        assert!((rise(end) / LIMIT - 1.0).abs() < 3e-3, "{end}: {}", rise(end));
    }
    assert!(profile.points.len() >= 9, "{:?}", profile.points);
    for point in &profile.points {
        assert!((rise(point.value) - point.chi2_rise).abs() < 1e-5 * LIMIT, "{point:?} {}", rise(point.value));
    }
}

#[test]
fn a_value_without_a_limit_on_one_side_is_said_to_be_open() {
    // With this deviation no stiffness is too large.
    let found = identified(&stiffness(WIDE, &json!({"profile": [MODULUS]})));
    let profile = row(&found, MODULUS).profile.as_ref().unwrap();
    assert!(profile.from.is_some() && profile.to.is_none(), "{profile:?}");
    assert!(profile.open_below.is_none() && profile.open_above.is_some(), "{profile:?}");

    // Within bounds that are nearer than the limit.
    let best = row(&identified(&stiffness(NARROW, &json!({}))), MODULUS).value;
    let fit = json!([{"path": MODULUS, "minimum": 0.9 * best, "maximum": 1.1 * best}, {"path": "platform.mass_kg"}]);
    let start = robot(&[(MODULUS, best)]);
    let found = identified(&stiffness(NARROW, &json!({"profile": [MODULUS], "fit": fit, "robot": start})));
    let profile = row(&found, MODULUS).profile.as_ref().unwrap();
    assert_eq!((profile.from, profile.to), (None, None));
    assert_eq!([profile.open_below, profile.open_above], [Some(OpenEnd::Bound); 2]);
    let ends = [profile.points[0].value, profile.points[profile.points.len() - 1].value];
    assert!((ends[0] / best - 0.9).abs() < 1e-9 && (ends[1] / best - 1.1).abs() < 1e-9, "{ends:?}");
}

/// Six-cable robot with example winches.
fn winches() -> String {
    std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/pulleys/winches.toml")).unwrap()
}

/// Natural frequencies 1 to 16 of the robot with example winches, with a modulus of 1.85e10 Pa and noise of 0.3 %,
/// which makes the springs of the drums best if they are rigid: springs and ropes are in series.
const RIDGE: [f64; 16] = [
    0.9983, 1.1862, 1.2230, 1.2675, 1.3472, 1.8090, 1.8251, 1.8889, 2.0220, 2.0592, 2.1281, 2.1371, 2.3670, 2.4138,
    2.4444, 2.4619,
];

#[test]
fn a_value_on_a_ridge_has_the_interval_of_its_profile() {
    const STIFFNESS: &str = "winches.drum.stiffness_n_per_m";
    let request = |set: Value, fit: Value| {
        let measured: Vec<Value> = (RIDGE.iter().enumerate())
            .map(|(i, hz)| json!({"frequency_hz": hz, "std_hz": 0.003 * hz, "label": format!("{}", i + 1)}))
            .collect();
        let text = winches();
        json!({
            "command": "identify", "robot": {"text": text, "set": set}, "fit": fit, "starts": 1,
            "experiments": [{"frequencies": measured}],
        })
    };
    let others = json!([
        {"path": "platform.mass_kg", "prior": 11.2, "prior_std": 0.2}, {"path": "materials.rope-4mm.mass_kg_per_m"},
        {"path": MODULUS},
    ]);
    let mut all = others.clone();
    all.as_array_mut().unwrap().push(json!({"path": STIFFNESS}));
    let found = identified(&request(json!([]), all));

    let (modulus, stiffness) = (row(&found, MODULUS), row(&found, STIFFNESS));
    assert!(stiffness.deviation.is_none() && stiffness.value > 1e7, "{}", stiffness.value);
    assert_eq!(modulus.moves_with, [STIFFNESS]);
    assert_eq!((modulus.deviation, modulus.interval_95), (None, None));
    assert!(found.warnings.iter().any(|text| text.contains("moves with winches.drum.stiffness_n_per_m")));
    let profile = modulus.profile.as_ref().unwrap();
    assert!(profile.from.unwrap() < 1.85e10 && profile.to.is_none(), "{profile:?}");

    // Fits with the springs of the drums held, which the measurements do not contradict.
    for held in [30e3, 100e3] {
        let held = identified(&request(json!([{"path": STIFFNESS, "value": held}]), others.clone()));
        assert!((held.chi2 - found.chi2) / found.deviation_factor.powi(2) < LIMIT);
        let value = row(&held, MODULUS).value;
        assert!(value > profile.from.unwrap(), "{value}");
    }
    // Mass and weight of the rope have their deviations as before.
    assert!(row(&found, "platform.mass_kg").deviation.is_some() && row(&found, "platform.mass_kg").profile.is_none());
}

/// Stops the work in the profiles.
struct Stopping(bool, usize);

impl Watch for Stopping {
    fn progress(&mut self, done: usize, total: usize, what: &'static str) {
        assert!(done <= total, "{done} {total}");
        if what == "fits of profiles" {
            self.0 = done >= 2;
            self.1 += 1;
        }
    }

    fn is_cancelled(&self) -> bool {
        self.0
    }
}

#[test]
fn profiles_stop_and_refuse_paths_that_are_not_fitted() {
    let request = |profile: &str| Request::from_json(&stiffness(NARROW, &json!({"profile": [profile]})).to_string());
    let mut watch = Stopping(false, 0);
    let Err(error) = run(&request("*").unwrap(), &mut watch) else { panic!("it was stopped") };
    assert!(error.to_string().contains("stopped") && watch.1 <= 4, "{error} after {}", watch.1);

    for (path, message) in [
        ("platform.mass", "`profile` platform.mass: no fitted value has this path; did you mean `platform.mass_kg`?"),
        ("platform.inertia_kg_m2", "no fitted value has this path"),
        ("", "`profile`"),
    ] {
        let Err(error) = run(&request(path).unwrap(), &mut Silent) else { panic!("{path} is refused") };
        assert!(error.to_string().contains(message), "{error}");
    }
}
