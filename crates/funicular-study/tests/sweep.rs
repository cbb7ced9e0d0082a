//! Tests of sweeps: rows depend on their own point alone, and columns equal the results of the functions behind them.
#![allow(missing_docs)]

use funicular::cable::CableModel;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::modes;
use funicular::robot::{Pose, Robot};
use funicular::statics::{self, Stability, StaticModel};
use funicular_study::request::Request;
use funicular_study::sweep::{CODES, Options, Plan, Poses, PreparedSweep, Quantity, Steps, SweepError};
use funicular_study::table::{Chunk, ColumnKind, Values};

fn yuan() -> Robot {
    Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap()
}

fn axes(given: &[(&str, Steps)]) -> Vec<(String, Steps)> {
    given.iter().map(|(axis, steps)| ((*axis).to_owned(), steps.clone())).collect()
}

fn grid(robot: &Robot, counts: [usize; 3]) -> Poses {
    let [x, y, z] = [(-1.5, 1.5), (-1.0, 1.0), (0.2, 1.4)].map(|(from, to)| (from, to));
    let steps = |(from, to), count| Steps::range(from, to, count).unwrap();
    let given = [("x", steps(x, counts[0])), ("y", steps(y, counts[1])), ("z", steps(z, counts[2]))];
    Poses::grid(robot.clone(), &axes(&given), None).unwrap()
}

fn quantities(names: &str) -> Vec<Quantity> {
    names.split(',').map(|name| name.parse().unwrap()).collect()
}

fn chunks(plan: &Plan) -> Vec<Chunk> {
    (0..plan.chunks()).map(|index| plan.evaluate(index, || false).unwrap()).collect()
}

/// Values of a column over all chunks.
fn reals(plan: &Plan, chunks: &[Chunk], name: &str) -> Vec<Option<f64>> {
    let at = plan.columns().iter().position(|column| column.name == name).unwrap_or_else(|| panic!("{name}"));
    let values = chunks.iter().map(|chunk| match &chunk.columns[at] {
        Values::Real(values) => values.clone(),
        other => panic!("{name}: {other:?}"),
    });
    values.flatten().collect()
}

#[test]
fn rows_are_the_same_bits_in_any_order_and_in_any_part() {
    let robot = yuan();
    let (points, options) = (grid(&robot, [9, 8, 7]), Options::default());
    let requested = quantities("tensions,stiffness,pose-error,condition,energy,lengths");
    let plan = Plan::new(&points, &robot, &requested, &options).unwrap();
    assert!(plan.chunks() > 50, "{}", plan.chunks());
    let alone = chunks(&plan);
    assert_eq!(alone.iter().map(Chunk::rows).sum::<usize>(), plan.rows());
    assert_eq!(plan.evaluate(1, || true), None);
    // No value is NaN, so equality means equality of bits. The order of evaluation does not matter.
    for index in [0, plan.chunks() / 2, plan.chunks() - 1] {
        assert_eq!(plan.evaluate(index, || false).as_ref(), Some(&alone[index]));
    }
    // A plan with a single row gives the same row.
    let single = Poses::list(robot.clone(), vec![[-1.5, -1.0, 0.2, 0.0, 0.0, 0.0]]);
    let plan = Plan::new(&single, &robot, &requested, &options).unwrap();
    let columns = chunks(&plan).remove(0).columns;
    for (one, all) in columns.iter().zip(&alone[0].columns) {
        match (one, all) {
            (Values::Real(one), Values::Real(all)) => assert_eq!(one[0], all[0]),
            (Values::Flag(one), Values::Flag(all)) => assert_eq!(one[0], all[0]),
            (Values::Text(one), Values::Text(all)) => assert_eq!(one[0], all[0]),
            _ => panic!("columns of two kinds"),
        }
    }
}

#[test]
fn every_column_is_what_the_function_it_stands_for_gives() {
    let robot = yuan();
    // The poses are around the middle, where no cable is nearly slack: a nearly slack cable cannot be resolved far
    // above its first frequency.
    let near = |to: f64, count| Steps::range(-to, to, count).unwrap();
    let given = axes(&[("x", near(0.4, 3)), ("y", near(0.3, 2)), ("z", Steps::range(0.3, 0.9, 2).unwrap())]);
    let points = Poses::grid(robot.clone(), &given, None).unwrap();
    let options = Options::default();
    let requested = quantities(
        "frequencies:3,first-frequency,tension-max,tensions,lengths,stiffness-min,stiffness,energy,model-error:spring,\
         pose-error",
    );
    let plan = Plan::new(&points, &robot, &requested, &options).unwrap();
    let all = chunks(&plan);
    let of = |name: &str| reals(&plan, &all, name);
    let (xs, ys, zs) = (of("x_m"), of("y_m"), of("z_m"));
    let mut feasible = 0;
    for row in 0..plan.rows() {
        let pose = Pose::new([xs[row].unwrap(), ys[row].unwrap(), zs[row].unwrap()], [0.0; 3]);
        let Ok(rest) = statics::inverse(&robot, &pose, StaticModel::Catenary) else {
            assert_eq!(of("tension_platform_1_n")[row], None);
            continue;
        };
        feasible += 1;
        assert_eq!(of("tension_platform_2_n")[row], Some(rest.cables[1].tension_platform));
        assert_eq!(of("unstrained_length_6_m")[row], Some(rest.cables[5].unstrained_length));
        let max_tension = rest.cables.iter().map(|c| c.tension_anchor.max(c.tension_platform)).fold(0.0, f64::max);
        assert_eq!(of("tension_max_n")[row], Some(max_tension), "all anchors are above the platform");
        assert_eq!(of("potential_energy_j")[row], Some(statics::energy(&robot, &rest)));
        let Stability::Stable { min_stiffness } = rest.stability else { continue };
        assert_eq!(of("stiffness_min_n_per_m")[row], Some(min_stiffness));
        let compliance = statics::tangent_stiffness(&robot, &rest).unwrap().try_inverse().unwrap();
        let x = of("stiffness_x_n_per_m")[row].unwrap();
        assert!((x * compliance[(0, 0)] - 1.0).abs() < 1e-9);
        let first = |cable_model| {
            let requested = Linearisation { cable_model, ..Linearisation::default() };
            let dynamics = Dynamics::about(&robot, &rest, requested, 15.0).unwrap();
            modes::below(&dynamics, 15.0).modes.iter().map(|mode| mode.frequency_hz).collect::<Vec<_>>()
        };
        let exact = first(CableModel::CatenaryDynamic);
        let near = |name: &str, expected: f64| {
            let found = of(name)[row].unwrap();
            // The mesh of a catenary-dynamic cable depends on the frequency limit, which differs here. The tolerance is
            // the tolerance of the mesh.
            assert!((found / expected - 1.0).abs() < 2e-9, "{name}: {found} for {expected}");
        };
        near("first_frequency_hz", exact[0]);
        near("frequency_3_hz", exact[2]);
        let spring = first(CableModel::Spring)[0] / exact[0] - 1.0;
        let found = of("model_error_spring")[row].unwrap();
        assert!((found - spring).abs() < 1e-8 * (1.0 + spring.abs()), "{found} for {spring}");
        let lengths: Vec<f64> = rest.cables.iter().map(|cable| cable.unstrained_length).collect();
        let straight = statics::forward(&robot, &lengths, StaticModel::Spring, Some(&pose)).unwrap();
        let gap = (straight.pose.position_w - pose.position_w).norm();
        assert!((of("spring_from_catenary_distance_m")[row].unwrap() - gap).abs() < 1e-15);
    }
    assert!(feasible >= 4, "{feasible}");
}

#[test]
fn every_robot_of_the_library_has_rows_with_numbers_or_a_reason() {
    let all = "first-frequency,first-kind,tension-max,tension-min,tensions,lengths,tension-margin,stiffness-min,\
               stiffness,pose-error,sag-max,model-error,stiffness-error,condition,energy,pose";
    let mut seen = 0;
    for (name, text) in funicular_robots::ALL {
        let robot = Robot::from_toml(text).unwrap();
        let rest = match &robot.state {
            funicular::robot::State::Pose(pose) => *pose,
            funicular::robot::State::Lengths(lengths) => {
                statics::forward(&robot, lengths, StaticModel::Catenary, None).unwrap().pose
            }
            funicular::robot::State::Unknown => continue,
        };
        let reach = (robot.cables[0].anchor.reference_w() - rest.position_w).norm();
        // A pose of the workspace, and a pose so far away that no cables hold it.
        let x = rest.position_w.x;
        let steps = Steps::List(vec![x, x + 0.01 * reach, x + 40.0 * reach]);
        let points = Poses::grid(robot.clone(), &axes(&[("x", steps)]), Some(&rest)).unwrap();
        let (requested, options) = (quantities(all), Options::default());
        let plan = Plan::new(&points, &robot, &requested, &options).unwrap();
        let chunks = chunks(&plan);
        let feasible_at = plan.columns().iter().position(|column| column.name == "feasible").unwrap();
        for chunk in &chunks {
            let [Values::Flag(feasible), Values::Text(status), Values::Text(reason)] =
                &chunk.columns[feasible_at..feasible_at + 3]
            else {
                panic!("three columns")
            };
            for row in 0..chunk.rows() {
                let code = status[row].as_deref().unwrap();
                assert!(CODES.iter().any(|known| known.0 == code), "{code}");
                assert_eq!(reason[row].is_none(), code == "ok", "{name}: {code}");
                for (column, values) in plan.columns().iter().zip(&chunk.columns).skip(feasible_at + 3) {
                    if let Values::Real(values) = values {
                        assert!(values[row].is_none_or(f64::is_finite), "{name}: {}", column.name);
                        assert!(feasible[row] || values[row].is_none(), "{name}: {}", column.name);
                        assert!(code != "ok" || values[row].is_some(), "{name}: {}", column.name);
                    }
                }
            }
        }
        let Values::Flag(home) = &chunks[0].columns[feasible_at] else { panic!("a flag") };
        assert!(home[0], "{name}: at home");
        let Values::Flag(away) = &chunks[2].columns[feasible_at] else { panic!("a flag") };
        // Few cables hold the nearest pose that they can.
        let is_few = robot.cables.len() < robot.platform.motion.count();
        assert!(!away[0] || is_few, "{name}: far away");
        seen += 1;
    }
    assert!(seen >= 9, "{seen}");
}

#[test]
fn plans_that_cannot_be_are_refused_with_what_is_wrong() {
    let robot = yuan();
    let one = || Steps::List(vec![0.5]);
    let refused = |given: &[(&str, Steps)], robot: &Robot| Poses::grid(robot.clone(), &axes(given), None).unwrap_err();
    assert_eq!(refused(&[("x", one()), ("y", one())], &robot), SweepError::NoPosition { axis: "z" });
    assert!(matches!(refused(&[("w", one())], &robot), SweepError::UnknownAxis { .. }));
    assert!(matches!(refused(&[("x", one()), ("x", one())], &robot), SweepError::RepeatedAxis { .. }));
    let camera = Robot::from_toml(funicular_robots::STADIUM_CAMERA).unwrap();
    let message = refused(&[("yaw", one())], &camera).to_string();
    assert!(message.contains("along the axis `yaw`") && message.contains("with the axes x, y, z"), "{message}");

    let plan = |points: &Poses, names: &str, options: &Options| {
        Plan::new(points, &robot, &quantities(names), options).map(|_| ()).unwrap_err()
    };
    let long = || Steps::range(0.0, 1.0, 10_000).unwrap();
    let huge = Poses::grid(robot.clone(), &axes(&[("x", long()), ("y", long()), ("z", long())]), None).unwrap();
    let message = plan(&huge, "energy", &Options::default()).to_string();
    assert!(message.starts_with("1000000000000 points are more than the 100000000"), "{message}");
    let small = grid(&robot, [2, 2, 2]);
    assert!(matches!(plan(&small, "energy,pose,energy", &Options::default()), SweepError::RepeatedColumn { .. }));
    let ideal = Options { static_model: StaticModel::Ideal, ..Options::default() };
    assert!(matches!(plan(&small, "stiffness-min", &ideal), SweepError::NotWithModel { .. }));
    assert_eq!(plan(&Poses::list(robot.clone(), Vec::new()), "energy", &Options::default()), SweepError::NoPoints);
}

#[test]
fn columns_have_units_in_their_names() {
    let robot = yuan();
    let requested = quantities("first-frequency,tensions,stiffness,sag-max,energy,pose");
    for column in requested.iter().flat_map(|quantity| quantity.columns(&robot)) {
        let ending = match column.unit.as_ref() {
            "Hz" => "_hz",
            "N" => "_n",
            "m" => "_m",
            "J" => "_j",
            "deg" => "_deg",
            "N/m" => "_n_per_m",
            "N m/rad" => "_n_m_per_rad",
            _ => "",
        };
        assert!(
            column.kind == ColumnKind::Real && column.name.ends_with(ending) && !column.about.is_empty(),
            "{column:?}"
        );
    }
}

/// Lengths of the file are held while its changes act. The file of a sweep therefore keeps both robots.
#[test]
fn a_sweep_at_held_lengths_is_restored_from_its_record() {
    let set = serde_json::json!([{ "path": "platform.mass_kg", "value": 250.0 }]);
    let robot = serde_json::json!({ "text": funicular_robots::COGIRO, "set": set });
    let both = serde_json::json!({
        "robot": robot, "pose": [1.0, 2.0, 1.5], "hold_lengths_of_pose": true, "quantities": ["pose", "lengths"],
    });
    for own in [
        serde_json::json!({ "command": "map", "grid": [{ "axis": "x", "values": [0.0, 1.0] }] }),
        serde_json::json!({ "command": "sweep", "vary": [{ "axis": "cables.1.anchor_m.z", "values": [5.3, 5.4] }] }),
    ] {
        let mut request = both.clone();
        request.as_object_mut().unwrap().extend(own.as_object().unwrap().clone());
        let prepared = PreparedSweep::new(&Request::from_value(request.clone()).unwrap()).unwrap();
        let plan = prepared.plan().unwrap();
        let record = prepared.record(&plan, None);
        let again = PreparedSweep::of_record(&record).unwrap();
        assert_eq!(chunks(&again.plan().unwrap()), chunks(&plan));

        // The lengths are those of the file, with the mass that the file gives.
        request["robot"]["set"] = serde_json::json!([]);
        request["vary"] = serde_json::json!([{ "axis": "platform.mass_kg", "values": [91.058, 250.0] }]);
        request["command"] = "sweep".into();
        request.as_object_mut().unwrap().remove("grid");
        let unchanged = PreparedSweep::new(&Request::from_value(request).unwrap()).unwrap();
        let of_file = unchanged.plan().unwrap();
        let column = |plan: &Plan, row: usize| reals(plan, &chunks(plan), "unstrained_length_1_m")[row];
        assert_eq!(column(&of_file, 0), column(&of_file, 1));
        assert_eq!(column(&plan, 1), column(&of_file, 0));
        let z = |plan: &Plan, row: usize| reals(plan, &chunks(plan), "pose_z_m")[row].unwrap();
        assert!(z(&plan, 1) < 1.49 && (z(&of_file, 0) - 1.5).abs() < 1e-9, "{} {}", z(&plan, 1), z(&of_file, 0));
    }
}

/// The columns of the payload and of the first platform mode equal the functions of the core.
#[test]
fn payload_and_first_platform_mode_of_a_row_are_those_of_the_core() {
    let robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    let options = Options::default();
    let poses = Poses::list(robot.clone(), vec![[1.0, 2.0, 1.5, 0.0, 0.0, 0.0], [-4.0, 1.0, 3.0, 0.0, 0.0, 5.0]]);
    let requested = quantities("payload-max,first-platform-frequency,tension-max-cable");
    let plan = Plan::new(&poses, &robot, &requested, &options).unwrap();
    let rows = chunks(&plan);
    for (row, pose) in
        [Pose::new([1.0, 2.0, 1.5], [0.0; 3]), Pose::new([-4.0, 1.0, 3.0], [0.0, 0.0, 5.0])].iter().enumerate()
    {
        let rest = statics::inverse(&robot, pose, StaticModel::Catenary).unwrap();
        let center_p = robot.platform.center_of_mass_p;
        let wanted = statics::RequestedPayload { center_p, side: statics::PayloadSide::Maximum, prove: false };
        // From low tensions instead of those of the row.
        let bound = statics::payload_bound(&robot, pose, StaticModel::Catenary, wanted, None).unwrap();
        let found = reals(&plan, &rows, "payload_max_kg")[row].unwrap();
        assert!((found - bound.mass).abs() < 1e-8 * bound.mass, "{found} {}", bound.mass);

        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 60.0).unwrap();
        let list = modes::below(&dynamics, 60.0);
        let first = list.modes.iter().find(|mode| mode.platform_energy_fraction >= 0.5).unwrap();
        let found = reals(&plan, &rows, "first_platform_frequency_hz")[row].unwrap();
        assert!((found - first.frequency_hz).abs() < 1e-9 * found, "{found} {}", first.frequency_hz);
    }

    // Fewer cables than degrees of freedom do not hold a pose.
    let mut few = robot.clone();
    few.cables.truncate(5);
    let poses = Poses::list(few.clone(), vec![[1.0, 2.0, 1.5, 0.0, 0.0, 0.0]]);
    assert!(matches!(Plan::new(&poses, &few, &requested, &options), Err(SweepError::TooFewCables { .. })));
}

/// Rows of a request of `sweep` or `map`: values of each column.
fn rows_of(request: &serde_json::Value) -> (Vec<funicular_study::table::Column>, Vec<Chunk>) {
    let prepared = PreparedSweep::new(&Request::from_json(&request.to_string()).unwrap()).unwrap();
    let plan = prepared.plan().unwrap();
    (plan.columns().to_vec(), chunks(&plan))
}

#[test]
fn sensitivities_are_differences_of_sweeps() {
    use serde_json::json;
    const RESULTS: [&str; 6] = ["first-frequency", "stiffness-min", "tensions", "lengths", "rope-length", "rope-mass"];
    let quantities = |path: &str| {
        let names = RESULTS.iter().flat_map(|name| [(*name).to_owned(), format!("sensitivity:{name}:{path}")]);
        names.collect::<Vec<_>>()
    };

    for (path, from, step, more) in [
        // Six cables at a pose: the lengths follow. Then at lengths: the pose follows.
        ("platform.mass_kg", 17.95, 1e-3, json!({"pose": [0.1, 0.2, 0.5, 0.0, 2.0, 0.0]})),
        ("materials.rope-4mm.diameter_m", 0.004, 1e-7, json!({"pose": [0.1, 0.2, 0.5, 0.0, 2.0, 0.0]})),
        ("cables.2.anchor_m.z", 5.9, 1e-5, json!({"pose": [0.1, 0.2, 0.5, 0.0, 2.0, 0.0]})),
        ("platform.mass_kg", 17.95, 1e-3, json!({"lengths_m": [6.863, 6.565, 6.756, 6.663, 6.801, 6.604]})),
        ("platform.center_of_mass_m.x", 0.01, 1e-5, json!({})),
        (
            "platform.mass_kg",
            17.95,
            1e-3,
            json!({"pose": [0.1, 0.2, 0.5, 0.0, 2.0, 0.0], "hold_lengths_of_pose": true}),
        ),
    ] {
        let mut request = json!({
            "command": "sweep", "robot": {"text": funicular_robots::YUAN2014_4MM}, "quantities": quantities(path),
            "vary": [{"axis": path, "values": [from - step, from, from + step]}],
        });
        request.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        let (columns, chunks) = rows_of(&request);
        let mut rows: Vec<Vec<Option<f64>>> = Vec::new();
        for chunk in &chunks {
            for i in 0..chunk.rows() {
                rows.push(
                    chunk.columns.iter().map(|of| if let Values::Real(of) = of { of[i] } else { None }).collect(),
                );
            }
        }

        let mut compared = 0;
        let mut largest = std::collections::BTreeMap::<String, f64>::new();
        for (at, column) in columns.iter().enumerate().filter(|(_, column)| column.name.contains("_by_")) {
            let entry = largest.entry(column.unit.to_string()).or_default();
            *entry = entry.max(rows[1][at].unwrap().abs());
        }
        for (at, column) in columns.iter().enumerate() {
            let Some((result, of)) = column.name.split_once("_by_") else { continue };
            assert_eq!(of, path);
            let value = columns.iter().position(|other| other.name == result).unwrap();
            let difference = (rows[2][value].unwrap() - rows[0][value].unwrap()) / (2.0 * step);
            let derivative = rows[1][at].unwrap();
            // Differences of second order, beside the rounding of frequencies of 1e-9 over the step.
            let tolerance = 2e-5 * derivative.abs().max(largest[column.unit.as_ref()]) + 1e-9 / step * 1e-2;
            assert!((derivative - difference).abs() < tolerance, "{}: {derivative} {difference}", column.name);
            compared += 1;
        }
        assert_eq!(compared, if more["robot"].is_null() { 16 } else { 20 }, "{path}");
    }

    // The load factor needs required loads.
    let text = format!("{}\n[required]\nforce_n = [150.0, 150.0, 150.0]\n", funicular_robots::COGIRO);
    let mass = Robot::from_toml(&text).unwrap().platform.mass;
    let (columns, chunks) = rows_of(&json!({
        "command": "sweep", "robot": {"text": text}, "pose": [1.0, 0.5, 1.5, 0.0, 0.0, 0.0],
        "quantities": ["load-factor", "sensitivity:load-factor:platform.mass_kg"],
        "vary": [{"axis": "platform.mass_kg", "values": [mass - 0.1, mass, mass + 0.1]}],
    }));
    let values = |name: &str| -> Vec<f64> {
        let at = columns.iter().position(|column| column.name == name).unwrap();
        let value = |chunk: &Chunk| match &chunk.columns[at] {
            Values::Real(of) => of.iter().map(|value| value.unwrap()).collect::<Vec<_>>(),
            _ => panic!("{name} is a number"),
        };
        chunks.iter().flat_map(value).collect()
    };
    let factors = values("load_factor");
    let (derivative, difference) = (values("load_factor_by_platform.mass_kg")[1], (factors[2] - factors[0]) / 0.2);
    assert!((derivative - difference).abs() < 1e-6 * difference.abs(), "{derivative} {difference}");

    // Units in the columns; a status for poses without derivatives; paths that no number has.
    let request = |quantity: &str| {
        json!({
            "command": "map", "robot": {"text": funicular_robots::COGIRO_WINCHES}, "quantities": [quantity],
            "poses": [[0.0, 0.0, 1.5, 0.0, 0.0, 0.0]],
        })
    };
    let (columns, chunks) = rows_of(&request("sensitivity:stiffness-min:platform.mass_kg"));
    let column = columns.last().unwrap();
    assert_eq!((column.name.as_str(), column.unit.as_ref()), ("stiffness_min_n_per_m_by_platform.mass_kg", "(N/m)/kg"));
    let Values::Text(status) = &chunks[0].columns[columns.iter().position(|of| of.name == "status").unwrap()] else {
        panic!("a status is a text")
    };
    assert!(["ok", "no-derivative"].contains(&status[0].as_deref().unwrap()), "{status:?}");
    let wrong = Request::from_json(&request("sensitivity:stiffness-min:platform.mas_kg").to_string()).unwrap();
    let error = PreparedSweep::new(&wrong).err().unwrap().to_string();
    assert!(error.contains("did you mean `platform.mass_kg`?"), "{error}");
}
