//! Tests of requests in JSON: a request that is written is read as the same request, for all commands and keys.

use funicular_study::Request;
use funicular_study::request::commands;
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// Robot file with changes of every kind of value.
fn robot() -> Value {
    json!({
        "name": "robots/cogiro.toml",
        "text": "name = \"é \\\"quoted\\\"\"\n",
        "set": [
            {"path": "platform.mass_kg", "value": 300},
            {"path": "cables.\"a.b\".anchor_m", "value": [0.1, -2.0, 1e-7]},
            {"path": "platform.motion", "value": "point-mass"},
        ],
    })
}

/// Object with the keys of all given parts.
fn joined(parts: &[&Value]) -> Value {
    let keys = parts.iter().filter_map(|part| part.as_object()).flatten();
    Value::Object(keys.map(|(key, value)| (key.clone(), value.clone())).collect())
}

/// Requests of every command, each with all of its keys.
#[expect(clippy::too_many_lines, reason = "a table")]
fn requests() -> Vec<Value> {
    let robot = json!({ "robot": robot() });
    let loads = json!({
        "mass_kg": 0.1, "static_model": "spring", "force_n": [1.0, -0.0, 1e-300], "moment_n_m": [0.1, 0.2, 0.3],
        "load_point_m": [0.0, 0.0, 0.1], "wind_m_s": [5.0, 0.0, 0.0], "cable_load_n_per_m": [0.0, 0.0, -0.1],
    });
    let state =
        joined(&[&loads, &json!({ "pose": [1.0, 2.0, 1.5, 0.0, 3.0, 1.0 / 3.0], "hold_lengths_of_pose": true })]);
    let lengths = joined(&[&loads, &json!({ "lengths_m": [6.9, 0.1 + 0.2, 6.8], "hold_lengths_of_pose": false })]);
    let share = json!({ "platform_share": 0.7 });
    let center = json!({ "payload_center_m": [0.0, 0.1, -0.2] });
    let required = json!({
        "required_shape": "ellipsoid", "required_force_n": [100.0, 100.0, 50.0],
        "required_moment_n_m": [10.0, 10.0, 5.0],
        "required_payload_min_kg": 1.0, "required_payload_max_kg": 30.0, "required_payload_center_m": [0.0, 0.0, -0.3],
        "required_payload_center_reach_m": [0.05, 0.05, 0.1], "required_acceleration_m_s2": [1.0, 1.0, 0.5],
        "required_angular_acceleration_rad_s2": [0.1, 0.1, 0.2], "required_wind_speed_m_s": 8.0,
    });
    let velocities = json!({
        "required_velocity_m_s": [1.0, 1.0, 0.5], "required_angular_velocity_rad_s": [0.1, 0.1, 0.2],
        "required_velocity_shape": "ellipsoid",
    });
    let motion = json!({
        "path": { "t_s": [0.0, 1.0], "x_m": [0.0, 1.0], "y_m": [0.0, 0.5], "z_m": [1.5, 1.5] },
        "move_to": [1.0, 0.0, 1.5, 0.0, 0.0, 5.0], "via": [[0.5, 0.0, 1.6, 0.0, 0.0, 0.0]], "lift_m": 0.2, "blend": 0.5,
        "row_tolerance_m": 1e-4, "path_origin_m": [0.1, 0.0, 0.0],
        "circle_center_m": [0.0, 0.0, 1.0], "circle_axis": [0.0, 0.1, 1.0], "turns": 2.0, "course": "quintic",
        "speed_m_s": 1.0, "acceleration_m_s2": 2.0, "jerk_m_s3": 20.0, "angular_speed_rad_s": 0.5,
        "angular_acceleration_rad_s2": 1.0, "angular_jerk_rad_s3": 9.0, "duration_s": 3.0, "fastest": true,
        "rope_inertia": true, "sample_time_s": 0.1, "station_time_s": 0.05, "length_tolerance_m": 1e-3,
    });
    let turned = json!({
        "pose": { "position_m": [1.0, 2.0, 1.5], "quaternion_wxyz": [0.6, 0.0, 0.0, 0.8] },
        "hold_lengths_of_pose": true,
    });
    let tensions = json!({
        "tension_rule": "closest", "target_tension_n": [900.0], "min_tension_n": 5.0, "max_tension_n": 4000.0,
    });
    let model = json!({
        "cable_model": "shallow-static", "assembly": "without-geometric-stiffness", "in_plane_only": true,
        "winches": "torque",
    });
    let points = json!({ "input_point_m": [0.1, 0.0, 0.0], "output_point_m": [0.0, 0.0, 0.1] });
    let range = json!({ "from_hz": 0.1, "to_hz": 10.0, "points": 7, "log": true });
    let signals = json!({ "input": "f:1,0,1", "output": "cable:3@0.5:az" });
    let point = joined(&[
        &state,
        &tensions,
        &model,
        &share,
        &center,
        &json!({ "quantities": ["frequencies:2", "pose"], "up_to_hz": 50.0 }),
    ]);
    let files = json!({ "files": [{ "path": "a.xml", "text": "<a/>", "guessed_encoding": "windows-1252" }] });
    let ropes = json!({
        "mass_kg_per_m": 0.05, "axial_stiffness_n": 1e6, "youngs_modulus_pa": 1e11, "diameter_m": 0.005,
        "inertia_kg_m2": [1.0, 1.0, 1.0, 0.0, 0.0, 0.1], "center_of_mass_m": [0.0, 0.0, 0.1], "mass_kg": 7.0,
        "cable_set": "springs", "pose": [0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
    });
    let grid =
        json!([{ "axis": "x", "from": -6.0, "to": 6.0, "count": 25 }, { "axis": "z", "values": [0.5, 1.0, 0.1] }]);
    let of = |command: &str, parts: &[&Value]| joined(&[&[&json!({ "command": command })], parts].concat());
    vec![
        of("check", &[&robot]),
        of("statics", &[&robot, &state, &tensions, &json!({ "all": false, "friction_interval": true })]),
        of("statics", &[&robot, &lengths, &json!({ "all": true, "friction_interval": false })]),
        of("statics", &[&robot, &loads, &turned, &json!({ "all": false, "friction_interval": false })]),
        of("stiffness", &[&robot, &state, &tensions, &model, &json!({ "at_hz": 3.5 })]),
        of(
            "modes",
            &[
                &robot,
                &state,
                &tensions,
                &model,
                &points,
                &signals,
                &share,
                &json!({ "below_hz": 20.0, "stations": 21, "damped": false, "rigid_cables": true,
                    "decay_percent": 10.0 }),
            ],
        ),
        of(
            "frf",
            &[
                &robot,
                &state,
                &tensions,
                &model,
                &points,
                &signals,
                &range,
                &json!({ "prominence_db": 3.0, "adaptive": false }),
            ],
        ),
        of(
            "frf",
            &[
                &robot,
                &lengths,
                &model,
                &json!({
                    "from_hz": 0.1, "to_hz": 10.0, "log": false, "adaptive": true, "prominence_db": 1.0,
                    "input": ["fx", "mz"], "output": ["x", "cable:3@0.5:az"],
                }),
            ],
        ),
        of(
            "gust",
            &[
                &robot,
                &state,
                &tensions,
                &model,
                &json!({
                    "output": ["z", "tension:1"], "output_point_m": [0.1, 0.0, 0.0], "duration_s": 300.0,
                    "below_hz": 5.0,
                    "turbulence": "kaimal", "intensity": [0.15, 0.12, 0.075], "length_scale_m": [85.0, 28.0, 6.9],
                    "coherence_decay": [3.0, 8.0, 8.0],
                    "spectrum": {
                        "frequency_hz": [0.01, 1.0], "along_m2_s": [40.0, 0.2], "lateral_m2_s": [20.0, 0.2],
                        "up_m2_s": [10.0, 0.1],
                    },
                }),
            ],
        ),
        of(
            "settle",
            &[
                &robot,
                &state,
                &tensions,
                &model,
                &points,
                &json!({
                    "release_n": [0.0, 0.0, -20.0], "release_n_m": [0.5, 0.0, 0.0], "tolerance_m": 1e-4,
                    "below_hz": 20.0,
                    "stop_m_s": [0.1, 0.0, 0.0], "stop_rad_s": [0.0, 0.0, 0.2], "move_m": [0.0, 0.05, 0.0],
                    "move_deg": [0.0, 1.0, 0.0], "profile_s": [1.2, 0.3, 0.1], "shaper": "ei:0.05",
                    "shape_modes_hz": [1.02, 1.36], "sample_time_s": 0.01,
                    "trajectory": { "t_s": [0.0, 1.0], "x_m": [0.0, 0.1], "y_m": [0.0, 0.0], "z_m": [0.5, 0.5] },
                    "robust_payload_kg": [0.5, 1.0],
                }),
            ],
        ),
        of(
            "compare",
            &[
                &robot,
                &state,
                &tensions,
                &share,
                &json!({
                    "below_hz": 2.0, "assembly": "consistent", "in_plane_only": false, "winches": "clamped",
                    "platform": true,
                    "tolerance": 0.1,
                }),
            ],
        ),
        of("payload", &[&robot, &state, &tensions, &center]),
        of("loads", &[&robot, &state, &tensions, &required]),
        of("speeds", &[&robot, &state, &tensions, &velocities]),
        of(
            "winches",
            &[
                &robot,
                &state,
                &tensions,
                &required,
                &velocities,
                &json!({
                    "grid": [{"axis": "x", "values": [0.0]}], "drum_width_m": 0.3,
                    "offers": [{"name": "large", "tension_n": 3000.0}],
                }),
            ],
        ),
        of("trajectory", &[&robot, &state, &tensions, &motion]),
        of(
            "workspace",
            &[
                &robot,
                &state,
                &tensions,
                &model,
                &required,
                &share,
                &center,
                &json!({
                    "at_least": [{ "quantity": "load-factor", "value": 1.0 }],
                    "at_most": [{ "quantity": "tension_max_n", "value": 3e3 }],
                    "grid": [{ "axis": "x", "from": -1.0, "to": 1.0, "count": 9 },
                        { "axis": "yaw", "values": [-5.0, 5.0] }],
                    "step_m": 0.3, "orientations": "some", "vertex_tolerance_m": 1e-5, "rays": 66,
                    "center_m": [0.0, 0.1, 1.0], "compare": robot["robot"],
                    "section": [{ "axis": "z", "values": [1.5] }], "up_to_hz": 50.0,
                    "prove": true, "boxes": 200, "undecided": 0.1, "time_s": 5.0,
                }),
            ],
        ),
        of(
            "prove",
            &[
                &robot,
                &state,
                &tensions,
                &required,
                &json!({
                    "within_m": [0.5, 0.4, 0.3], "within_deg": [1.0, 0.0, 2.0], "boxes": 200, "undecided": 0.1,
                    "time_s": 5.0,
                }),
            ],
        ),
        of(
            "clearance",
            &[
                &robot,
                &state,
                &tensions,
                &json!({ "move_to": [0.1, 0.0, 0.5, 0.0, 0.0, 5.0], "find_way": true, "in_gusts": true }),
            ],
        ),
        of(
            "gradient",
            &[
                &robot,
                &state,
                &tensions,
                &model,
                &points,
                &json!({
                    "of": ["frequencies", "response"], "by": ["platform", "cables.*.anchor_m"], "hold": "pose",
                    "per": "tolerance", "tolerances": ["platform.mass_kg=1%"], "below_hz": 5.0, "at_hz": 1.2,
                    "input": "fz",
                    "output": "az",
                }),
            ],
        ),
        of(
            "uncertainty",
            &[
                &robot,
                &state,
                &tensions,
                &model,
                &json!({
                    "at_hz": [1.0, 2.5], "input": "fz", "output": "az", "input_point_m": [0.1, 0.0, 0.0],
                    "output_point_m": [0.0, 0.1, 0.0],
                    "of": ["pose", "frequencies", "response"], "deviations": ["platform.mass_kg=1%"],
                    "tolerances": ["cables.*.anchor_m=0.001"], "hold": "pose", "method": "sampled", "samples": 50,
                    "seed": 3, "below_hz": 5.0, "poses": [[0.0, 0.0, 0.5, 0.0, 0.0, 0.0]],
                    "grid": [{ "axis": "z", "values": [1.0, 2.0] }],
                    "covariance": [{ "first": "platform.mass_kg", "second": "platform.mass_kg", "covariance": 0.5 }],
                }),
            ],
        ),
        of(
            "pose-error",
            &[&robot, &tensions, &json!({ "mass_kg": [10.55, 86.35, 100], "pose": [1.0, 2.0, 1.5, 0.0, 3.0, 0.5] })],
        ),
        of(
            "frf",
            &[
                &robot,
                &state,
                &tensions,
                &model,
                &points,
                &signals,
                &range,
                &json!({ "prominence_db": 3.0, "adaptive": false }),
            ],
        ),
        of(
            "frf",
            &[
                &robot,
                &lengths,
                &tensions,
                &model,
                &json!({
                    "from_hz": 0.1, "to_hz": 10.0, "log": false, "adaptive": true, "prominence_db": 1.0,
                    "input": ["fx", "mz"], "output": ["x", "cable:3@0.5:az"],
                }),
            ],
        ),
        of(
            "pose-error",
            &[&robot, &json!({ "mass_kg": [10.55, 86.35, 100], "lengths_m": [6.9, 6.6], "tolerance_mm": 5.0 })],
        ),
        of(
            "cable",
            &[
                &robot,
                &lengths,
                &tensions,
                &range,
                &json!({ "name": "3", "cable_model": "catenary-dynamic", "in_plane_only": true, "winches": "stuck" }),
            ],
        ),
        of(
            "reduce",
            &[
                &robot,
                &state,
                &tensions,
                &model,
                &points,
                &json!({
                    "below_hz": 5.0, "input": ["fx", "mz"], "output": [], "form": "second-order", "tolerance": 1e-3,
                    "damping_at_hz": 1.0
                }),
            ],
        ),
        of(
            "reduce",
            &[
                &robot,
                &state,
                &model,
                &points,
                &json!({ "below_hz": 5.0, "input": [], "output": ["az"], "form": "state-space", "order": 8 }),
            ],
        ),
        of("map", &[&robot, &point, &json!({ "grid": grid })]),
        of("map", &[&robot, &point, &json!({ "grid": [], "poses": [[0.1, 0.2, 0.3, 1.0, 2.0, 3.0]] })]),
        of("sweep", &[&robot, &point, &json!({ "vary": grid })]),
        of(
            "simulate",
            &[
                &robot,
                &state,
                &tensions,
                &json!({
                    "point": [{ "name": "hook", "point_m": [0.0, 0.1, -0.5] }],
                    "scenario": {
                        "release": [{ "at_s": 0.1, "mass_kg": 1.0, "point_m": [0.0, 0.0, 0.1] }],
                        "pick": [{ "at_s": 0.2, "mass_kg": 1.0, "velocity_m_s": [0.1, 0.0, 0.0] }],
                        "lengths": [{ "at_s": 0.0, "duration_s": 1.0, "change_m": { "1": -0.1 } }],
                        "tension": [{ "at_s": 0.4, "duration_s": 0.1, "tension_n": { "2": 300.0 } }],
                        "stop": [{ "at_s": 0.5, "duration_s": 0.1, "cables": ["1"] }],
                        "push": [{
                            "at_s": 0.0, "duration_s": 0.2, "rise_s": 0.05, "force_n": [1.0, 0.0, 0.0],
                            "moment_n_m": [0.0, 0.0, 0.0], "point_m": [0.0, 0.0, 0.0],
                        }],
                        "anchor": [{
                            "at_s": 0.0, "cables": ["1", "3"],
                            "table": { "t_s": [0.0, 0.5], "x_m": [0.0, 0.0], "y_m": [0.0, 0.0], "z_m": [0.0, 0.01] },
                        }],
                        "cut": [{ "cable": "2", "at_tension_n": 300.0, "place_m": 1.5 }],
                    },
                    "duration_s": 1.0, "sample_time_s": 0.01, "tolerance_m": 1e-6, "elements": 2, "degree": 6,
                    "once": true,
                    "damping_frequency_hz": 1.2, "stretch_damping_time_s": 1e-4, "hold_platform": false, "gust_seed": 1,
                }),
            ],
        ),
        of(
            "calibrate",
            &[
                &robot,
                &tensions,
                &json!({
                    "readings": { "length_1_m": [1.0, null], "x_m": [0.0, 0.1], "y_m": [0.0, 0.0], "z_m": [0.5, 0.5] },
                    "unknowns": ["anchors", "offsets"], "hold_anchors": ["2"], "frame": ["1", "3"], "leave_out": [2.0],
                    "length_std_m": 5e-4, "position_std_m": 0.01, "rotation_std_deg": 0.5, "tension_std_n": 2.0,
                    "tension_range_n": [20.0, 120.0],
                    "prior": [{ "path": "offsets", "prior": 0.0, "prior_std": 0.02 },
                        { "path": "cables.1.anchor_m", "prior_std": 0.05 }],
                    "profile": ["anchors"], "static_model": "catenary", "starts": 4, "propose": 2,
                    "accuracy_grid": [{ "axis": "y", "values": [0.5, 1.0] }],
                    "accuracy_poses": [[0.0, 0.0, 1.0, 0.0, 0.0, 0.0]],
                    "grid": [{ "axis": "x", "from": -1.0, "to": 1.0, "count": 9 },
                        { "axis": "yaw", "values": [-5.0, 5.0] }],
                    "poses": [[0.0, 0.0, 0.5, 0.0, 0.0, 0.0]], "propose_for": ["anchors"], "propose_by": "determinant",
                    "wanted_std_m": 0.005,
                }),
            ],
        ),
        of(
            "observability",
            &[
                &robot,
                &state,
                &tensions,
                &json!({
                    "grid": [{"axis": "x", "values": [0.0]}], "sensors": ["tensions", "tracker"], "further_pose_m": 0.2,
                    "inertial_unit_m": [0.1, 0.0, 0.5], "tracked_point_m": [0.0, 0.0, 1.0], "length_std_m": 1e-5,
                    "tension_std_n": 2.0, "cable_angle_std_rad": 2e-3, "gyroscope_std_rad_s": 1e-3,
                    "accelerometer_std_m_s2": 0.02, "tracker_std_m": 5e-4, "payload_kg": 10.0, "payload_std_kg": 5.0,
                    "first_moment_std_kg_m": 0.5, "force_std_n": 2.0, "moment_std_n_m": 0.4, "force_time_s": 2.0,
                    "offset_std_m": 2e-3, "tension_bias_std_n": 6.0, "friction": 0.01,
                }),
            ],
        ),
        of(
            "estimate",
            &[
                &robot,
                &json!({
                    "log": { "t_s": [0.0, 0.01], "length_1_m": [1.0, null], "tension_anchor_1_n": [null, 300.0] },
                    "near_pose": [0.0, 0.0, 1.0, 0.0, 0.0, 0.0], "every_s": 0.1, "false_alarms_per_hour": 1.0,
                    "inertial_unit_m": [0.1, 0.0, 0.5], "tracked_point_m": [0.0, 0.0, 1.0], "length_std_m": 1e-5,
                    "tension_std_n": 2.0, "cable_angle_std_rad": 2e-3, "gyroscope_std_rad_s": 1e-3,
                    "accelerometer_std_m_s2": 0.02, "tracker_std_m": 5e-4, "payload_kg": 10.0, "payload_std_kg": 5.0,
                    "first_moment_std_kg_m": 1.0, "force_std_n": 2.0, "moment_std_n_m": 0.2, "force_time_s": 2.0,
                    "offset_std_m": 5e-4, "tension_bias_std_n": 3.0, "friction": 0.02,
                }),
            ],
        ),
        of(
            "design",
            &[
                &robot,
                &state,
                &tensions,
                &model,
                &json!({
                    "change": [
                        { "path": "platform.mass_kg", "minimum": 1.0, "maximum": 30.0 },
                        { "path": "cables.*.anchor_m", "plus_minus": 0.1 },
                    ],
                    "grid": [{ "axis": "x", "from": -1.0, "to": 1.0, "count": 3 }],
                    "ropes": [{ "name": "thin", "axial_stiffness_n": 3e5, "mass_kg_per_m": 0.05, "diameter_m": 0.004,
                        "minimum_tension_n": 20.0, "maximum_tension_n": 900.0, "breaking_load_n": 4000.0 }],
                    "reconnect": true,
                    "goal": "rope-mass", "poses": [[0.1, 0.2, 0.3, 1.0, 2.0, 3.0]], "weights": [2.0],
                    "min_frequency_hz": 1.5, "min_stiffness_n_per_m": 2e4, "avoid_hz": [2.5, 3.2], "max_iterations": 7,
                }),
            ],
        ),
        of(
            "identify",
            &[
                &robot,
                &tensions,
                &model,
                &json!({
                    "profile": ["platform.*"], "propose": 2, "grid": grid, "poses": [[0.0, 0.0, 0.5, 0.0, 0.0, 0.0]],
                    "propose_measuring": ["tensions", "pose"], "propose_payloads_kg": [0.0, 2.0], "propose_modes": 4,
                    "propose_for": ["platform.mass_kg"],
                    "propose_by": "determinant", "wanted_percent": 2.0,
                    "fit": [
                        { "path": "platform.mass_kg", "minimum": 1.0, "maximum": 30.0 },
                        { "path": "platform.center_of_mass_m.x", "prior": 0.0, "prior_std": 0.03 },
                    ],
                    "experiments": [joined(&[
                        &state,
                        &json!({
                            "name": "empty", "cables": ["1", "2"], "position_std_m": 0.002, "rotation_std_deg": 0.2,
                            "measured_pose": [0.1, 0.2, 0.3, 1.0, 2.0, 3.0], "measured_tensions_n": [1.0, 0.1 + 0.2],
                            "tension_std_n": 0.5, "measured_lengths_m": [6.9, 6.8], "length_std_m": 1e-3,
                            "frequencies": [
                                { "frequency_hz": 1.2, "damping_ratio": 0.01, "damping_std": 0.001, "std_hz": 0.1,
                                    "weight": 2.0, "label": "1" },
                            ],
                            "histories": [{
                                "name": "push", "time_s": [0.0, 0.1], "channels": [{
                                    "name": "a", "output": "az", "output_point_m": [0.0, 0.1, 0.0],
                                    "values": [0.5, 0.4], "std": 0.01,
                                }],
                            }],
                            "responses": [{
                                "name": "a1", "input": "fz", "input_point_m": [0.1, 0.0, 0.0], "output": "az",
                                "output_point_m": [0.0, 0.1, 0.0], "frequency_hz": [1.0, 2.0], "real": [0.1, -0.0],
                                "imag": [1e-300, 3.0], "std": [0.1, 0.2],
                            }],
                        }),
                    ])],
                    "from_hz": 0.5, "to_hz": 9.5, "starts": 3, "response_noise": 0.05, "frequency_noise": 0.02,
                    "damping_noise": 0.2, "history_kind": "ambient", "history_from_s": 0.5, "history_to_s": 60.0,
                    "history_poles": 3, "rigid_cables": true,
                }),
            ],
        ),
        of("merge", &[&json!({ "parts": ["1.parquet", "2.parquet"] })]),
        of("plot", &[&json!({ "file": "map.parquet" })]),
        of(
            "report",
            &[
                &robot,
                &state,
                &tensions,
                &model,
                &points,
                &signals,
                &share,
                &json!({ "below_hz": 20.0, "summary": true }),
            ],
        ),
        of("live", &[&robot, &state, &tensions, &model]),
        of("paper", &[]),
        of("import", &[&files, &ropes, &json!({ "trajectory": "lift" })]),
        of(
            "new",
            &[&json!({
                "name": "rig", "cables": 6, "motion": "planar-xz", "csv_unit": "mm", "mass_kg": 20.0,
                "from_csv": { "path": "a.csv", "text": "1,2,3,4,5,6" }, "box_m": [0.4, 0.3, 0.2], "rope": "7x7",
                "diameter_m": 0.003, "axial_stiffness_n": 1e6, "mass_kg_per_m": 0.1,
                "pose": [0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
            })],
        ),
        of("schema", &[&json!({ "of": "request" })]),
        of(
            "export",
            &[
                &robot,
                &state,
                &tensions,
                &json!({
                    "to": "vtk", "segments": 5, "cable_pieces": 4, "modes_below_hz": 10.0, "duration_s": 2.0,
                    "scenario": { "release": [{ "at_s": 0.1, "mass_kg": 1.0 }] },
                    "within": [{ "axis": "x", "values": [-0.5, 0.5] }], "tolerance_m": 1e-3, "prefix": "table",
                }),
            ],
        ),
        of("validate", &[&json!({ "only": ["catenary/michalos-1962"], "level": "published", "controls": true })]),
    ]
}

#[test]
fn a_request_that_is_written_is_read_as_it_was() {
    for value in requests() {
        let request =
            serde_json::from_value::<Request>(value.clone()).unwrap_or_else(|error| panic!("{value}: {error}"));
        let written = request.to_value();
        assert_eq!(written["schema"], "funicular-request/1");
        // Nothing is lost, added or changed, except the schema.
        let mut keys = written.clone();
        keys.as_object_mut().unwrap().remove("schema");
        assert_eq!(keys, value);
        // Some of these keys exclude each other, which is another test.
        assert_eq!(serde_json::from_str::<Request>(&keys.to_string()).unwrap(), request);
        assert_eq!(serde_json::from_str::<Request>(&serde_json::to_string_pretty(&keys).unwrap()).unwrap(), request);
    }
}

#[test]
fn every_command_and_every_key_is_in_a_request_here() {
    let requests = requests();
    let used: BTreeSet<&String> = requests.iter().filter_map(Value::as_object).flat_map(|keys| keys.keys()).collect();
    let keys = commands().iter().flat_map(|command| &command.keys).map(|key| key.name.to_owned());
    let known: BTreeSet<String> = keys.chain(["command".to_owned()]).collect();
    assert_eq!(used, known.iter().collect());
}

#[test]
fn defaults_of_a_request_are_written_and_read_as_they_are() {
    for value in requests() {
        // Optional keys are left out one by one, as long as the request can be read.
        let Value::Object(mut keys) = value else { panic!("an object") };
        for key in keys.keys().cloned().collect::<Vec<_>>() {
            let mut fewer = keys.clone();
            fewer.remove(&key);
            if serde_json::from_value::<Request>(Value::Object(fewer.clone())).is_ok() {
                keys = fewer;
            }
        }
        let request = serde_json::from_value::<Request>(Value::Object(keys)).unwrap();
        let written = request.to_value();
        assert_eq!(serde_json::from_value::<Request>(written.clone()).unwrap(), request);
        assert_eq!(serde_json::from_value::<Request>(written.clone()).unwrap().to_value(), written);
    }
}

#[test]
fn every_digit_of_a_number_survives() {
    let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
    for _ in 0..2000 {
        // A linear congruential generator makes arbitrary numbers.
        bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let number = f64::from_bits(bits);
        if !number.is_finite() {
            continue;
        }
        let value = json!({ "command": "stiffness", "robot": { "text": "" }, "at_hz": number });
        let text = serde_json::from_value::<Request>(value).unwrap().to_value().to_string();
        let Request::Stiffness(again) = serde_json::from_str::<Request>(&text).unwrap() else { panic!("a stiffness") };
        assert_eq!(again.at_hz.to_bits(), number.to_bits(), "{text}");
    }
}

#[test]
fn a_key_that_a_command_does_not_have_is_refused_in_every_command() {
    for value in requests() {
        let Value::Object(mut keys) = value else { panic!("an object") };
        keys.insert("poze".to_owned(), json!(1));
        let error = Request::from_value(Value::Object(keys)).unwrap_err().to_string();
        assert!(error.contains("has no key `poze`; did you mean `pose`?"), "{error}");
    }
}

/// Robots whose numbers other programs computed, random ones among them: none of them has an implausible value.
#[test]
fn no_reference_robot_is_implausible() {
    use funicular::robot::Robot;
    use funicular::statics::{self, StaticModel};
    use funicular::warnings;

    let reference: Value =
        serde_json::from_str(include_str!("../../funicular-validation/reference/independent.json")).unwrap();
    let cases = reference["cases"].as_array().unwrap();
    assert!(cases.len() > 10);
    for case in cases {
        let robot = Robot::from_toml(case["toml"].as_str().unwrap()).unwrap();
        let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
        let mut warned = warnings::of_robot(&robot);
        warned.extend(warnings::of_plausibility(&robot, &rest));
        let warned: Vec<String> = warned.iter().map(ToString::to_string).collect();
        assert_eq!(warned, Vec::<String>::new(), "{}", robot.name);
        assert_eq!(warnings::plausibility::notes(&robot), Vec::<String>::new(), "{}", robot.name);
    }
}
