//! Table of all quantities.

use super::{Definition, Parameter, ParameterKind, Quantity, RequiredModel, twist_axes};
use crate::sweep::points::AXES;
use crate::sweep::status::Status;
use crate::table::{Column, ColumnKind, Value};
use funicular::cable::{CableModel, Sag};
use funicular::math::{Vec6, rotation};
use funicular::robot::{Constraint, Pose, Robot};
use funicular::speeds::WinchSpeeds;
use funicular::statics::{self, TensionRange};
use funicular::winch_needs::WinchNeed;

/// Reason why the cables have no margin.
const NO_FACETS: &str = "no maximum tension limits the loads, or the cables do not span all degrees of freedom";

/// Every quantity that is no [`measure`](crate::measure) of the robot at rest, in the order of the documentation.
pub(super) static TABLE: &[Definition] = &[
    Definition {
        name: "first-frequency",
        about: "lowest natural frequency",
        documentation: "`first_frequency_hz`: lowest natural frequency, undamped, with the requested cable model",
        frequencies: |_| 1,
        columns: |_, _| one("first_frequency_hz", "Hz", "lowest natural frequency, undamped"),
        values: |row, _, out| row.frequencies(1, out),
        ..Definition::PLAIN
    },
    Definition {
        name: "first-platform-frequency",
        about: "lowest natural frequency of a mode of the platform; it jumps from pose to pose where modes of cables \
            are near",
        documentation: "`first_platform_frequency_hz`: lowest natural frequency of a mode with at least \
                        `⟪platform_share⟫` (0.5 if not given) of its kinetic energy in the platform, with the \
                        requested cable model; the modes below it are all found, however many they are. It \
                        jumps between neighbouring points where a mode of the cables is near and takes over half of \
                        the energy: `platform-frequency` is smooth",
        columns: |_, _| {
            let about = "lowest natural frequency of a mode of the platform, undamped; it jumps where a mode of the \
                         cables is near and shares the energy: platform-frequency is smooth";
            one("first_platform_frequency_hz", "Hz", about)
        },
        values: |row, _, out| {
            let first = row.first_platform_frequency();
            row.push(Some(first), out);
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "platform-frequency",
        about: "lowest frequency of the platform on cables that follow it as at rest; smooth from pose to pose",
        documentation: "`platform_frequency_hz`: lowest frequency of the platform if each cable follows it in the \
                        shape of slow motion, with the share of its mass that then moves. It is smooth from pose to \
                        pose. Its square is the mean of the squares of all natural frequencies, weighted by the \
                        kinetic energy that each mode has in this motion: beside a mode of the cables it lies between \
                        the frequencies of the pair (theory, equations (35d) and (35e))",
        needs: RequiredModel::Elastic,
        columns: |_, _| {
            let about = "lowest frequency of the platform on cables that follow it as at rest";
            one("platform_frequency_hz", "Hz", about)
        },
        values: |row, _, out| {
            let found = row.platform_frequency();
            row.push(Some(found), out);
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "damping",
        about: "damping ratio of the first mode of the platform",
        documentation: "`platform_damping_ratio`: damping ratio of the damped partner of the first mode with at least \
                        `--platform-share` (0.5 if not given) of its kinetic energy in the platform, with the \
                        requested cable model; it takes the time of a complete damped list per point",
        columns: |_, _| one("platform_damping_ratio", "1", "damping ratio of the first mode of the platform"),
        values: |row, _, out| {
            let found = row.platform_damping().map(|(ratio, _)| ratio);
            row.push(Some(found), out);
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "decay-time",
        about: "time in which the first mode of the platform decays to 5 % of its amplitude",
        documentation: "`platform_decay_time_s`: time in which the mode of `damping` decays to 5 % of its amplitude",
        columns: |_, _| {
            let about = "time in which the first mode of the platform decays to 5 % of its amplitude";
            one("platform_decay_time_s", "s", about)
        },
        values: |row, _, out| {
            let found = row.platform_damping().map(|(_, time)| time);
            row.push(Some(found), out);
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "first-kind",
        about: "kind of the first mode: platform, cable or mixed",
        documentation: "`first_kind`: kind of the first mode by kinetic energy: platform, cable or mixed",
        frequencies: |_| 1,
        columns: |_, _| {
            let about = "kind of the first mode by kinetic energy: platform, cable or mixed";
            vec![Column { kind: ColumnKind::Text, ..column("first_kind".to_owned(), "", about) }]
        },
        values: |row, _, out| {
            let kind = row.modes().and_then(|modes| modes.first().map(|mode| mode.1));
            out.push(kind.map_or(Value::Nothing, |kind| Value::Text(kind.name().into())));
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "frequencies:N",
        about: "lowest N natural frequencies",
        documentation: "`frequency_1_hz` …: lowest N natural frequencies, ascending, undamped",
        takes: ParameterKind::Count,
        frequencies: Parameter::count,
        columns: |_, parameter| {
            let about = "natural frequency, ascending, undamped";
            (1..=parameter.count()).map(|i| column(format!("frequency_{i}_hz"), "Hz", about)).collect()
        },
        values: |row, parameter, out| row.frequencies(parameter.count(), out),
        ..Definition::PLAIN
    },
    Definition {
        name: "tension-max",
        about: "maximum tension anywhere in a cable",
        documentation: "`tension_max_n`: maximum tension anywhere in any cable",
        columns: |_, _| one("tension_max_n", "N", "maximum tension anywhere in a cable"),
        values: |row, _, out| out.push(Value::real(row.tensions().map(|(_, max)| max).reduce(f64::max))),
        ..Definition::PLAIN
    },
    Definition {
        name: "tension-max-cable",
        about: "name of the cable with the maximum tension",
        documentation: "`tension_max_cable`: name of the cable with the maximum tension; text",
        columns: |_, _| {
            let about = "name of the cable with the maximum tension anywhere";
            vec![Column { kind: ColumnKind::Text, ..column("tension_max_cable".to_owned(), "", about) }]
        },
        values: |row, _, out| {
            let mut tensions = row.tensions().map(|(_, max)| max).enumerate();
            let first = tensions.next();
            let tightest = first.map(|first| tensions.fold(first, |most, of| if of.1 > most.1 { of } else { most }));
            let name = tightest.map(|(i, _)| Value::Text(row.robot.cables[i].name.clone().into()));
            out.push(name.unwrap_or(Value::Nothing));
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "tension-min",
        about: "minimum tension anywhere in a cable",
        documentation: "`tension_min_n`: minimum tension anywhere in any cable",
        columns: |_, _| one("tension_min_n", "N", "minimum tension anywhere in a cable"),
        values: |row, _, out| out.push(Value::real(row.tensions().map(|(min, _)| min).reduce(f64::min))),
        ..Definition::PLAIN
    },
    Definition {
        name: "wrap-max",
        about: "maximum wrap angle on a pulley",
        documentation: "`wrap_max_deg`: maximum wrap angle of a cable on its pulley; empty without pulleys and with \
                        `ideal` cables",
        columns: |_, _| one("wrap_max_deg", "degrees", "maximum wrap angle on a pulley"),
        values: |row, _, out| {
            let wraps = row.rest.cables.iter().filter_map(|cable| cable.drive.as_ref()?.contact);
            out.push(Value::real(wraps.map(|contact| contact.wrap.to_degrees()).reduce(f64::max)));
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "tension-margin",
        about: "minimum distance of a tension from its limits, negative beyond them",
        documentation: "`tension_margin_n`: minimum distance of a tension from its limits (the limits that \
                        `⟪tension_rule⟫` uses), negative beyond them",
        columns: |_, _| one("tension_margin_n", "N", "minimum distance of a tension from its limits"),
        values: |row, _, out| {
            let cables = row.rest.cables.iter().enumerate();
            let margins =
                cables.map(|(i, cable)| TensionRange::of(row.robot, i, &cable.chord_w()).margin(cable).distance());
            out.push(Value::real(margins.reduce(f64::min)));
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "payload-max",
        about: "maximum payload with tensions within their limits, and the limits that bind",
        documentation: "`payload_max_kg`: maximum mass in addition to the platform, with its centre at \
                        `⟪payload_center_m⟫`, over all tensions within their limits, whatever the rule; \
                        `payload_limits`: cables at their limits then, as `1 maximum at anchor`",
        needs: RequiredModel::HeldPose,
        columns: |_, _| {
            let about = "cables at their limits with the maximum payload";
            vec![
                column("payload_max_kg".to_owned(), "kg", "maximum mass in addition to the platform"),
                Column { kind: ColumnKind::Text, ..column("payload_limits".to_owned(), "", about) },
            ]
        },
        values: |row, _, out| row.payload(out),
        ..Definition::PLAIN
    },
    Definition {
        name: "clearance",
        about: "least distance between cables, platform and obstacles, and the pair",
        documentation: "`clearance_m`: distance between the surfaces of the pair of cables, platform and obstacles \
                        that is nearest to its required distance or below it; `clearance_margin_m`: distance beyond \
                        the required one; `clearance_pair`: the pair in words",
        columns: |_, _| {
            let about = "pair of cables, platform and obstacles with the least margin";
            vec![
                column("clearance_m".to_owned(), "m", "distance of the pair with the least margin"),
                column("clearance_margin_m".to_owned(), "m", "its distance beyond the required one"),
                Column { kind: ColumnKind::Text, ..column("clearance_pair".to_owned(), "", about) },
            ]
        },
        values: |row, _, out| row.clearance(out),
        ..Definition::PLAIN
    },
    Definition {
        name: "closure",
        about: "1 if straight cables could balance every load with tensions that are high enough, otherwise 0",
        documentation: "`closure`: 1 if straight cables could balance every load with tensions that are high enough \
                        (wrench closure), otherwise 0; sag does not change it",
        columns: |_, _| one("closure", "1", "1 if straight cables could balance every load, otherwise 0"),
        values: |row, _, out| out.push(Value::real(Some(closure(row.robot, &row.rest.pose)))),
        at_pose: Some(closure),
        ..Definition::PLAIN
    },
    Definition {
        name: "tension-factor",
        about: "largest ratio of minimum to maximum tension with which straight cables balance each other without a \
                load",
        documentation: "`tension_factor`: largest ratio of the minimum to the maximum tension with which straight \
                        cables balance each other without a load, from 0 to 1",
        columns: |_, _| one("tension_factor", "1", "largest ratio of minimum to maximum tension without a load"),
        values: |row, _, out| out.push(Value::real(Some(tension_factor(row.robot, &row.rest.pose)))),
        at_pose: Some(tension_factor),
        ..Definition::PLAIN
    },
    Definition {
        name: "load-factor",
        about: "largest multiple of the required loads that tensions within their limits hold",
        documentation: "`load_factor`: largest multiple of the required loads (`[required]`, or options `required_…`) \
                        that tensions within their limits hold in every combination, whatever the rule; all are held \
                        if it is at least 1",
        needs: RequiredModel::HeldPose,
        columns: |_, _| one("load_factor", "1", "largest multiple of the required loads that is held"),
        values: |row, _, out| {
            let found = row.of_capacity(
                |capacity| capacity.load_factor_value().map(Some),
                "no maximum tension limits the required loads",
            );
            row.push(Some(found), out);
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "capacity-margin",
        about: "radius of the largest ball of loads that can be added to every required load, negative outside",
        documentation: "`capacity_margin_n`: radius of the largest ball of loads, moments over the platform's size, \
                        that can be added to every required load; negative if one is not held",
        needs: RequiredModel::HeldPose,
        columns: |_, _| one("capacity_margin_n", "N", "radius of the largest ball of loads that can be added"),
        values: |row, _, out| {
            let found = row.of_capacity(|capacity| Ok(capacity.margin()), NO_FACETS);
            row.push(Some(found), out);
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "closed-form-margin",
        about: "distance of the closed-form tensions of straight cables from their limits: a sufficient test only",
        documentation: "`closed_form_margin_n`: distance of the tensions nearest to the middles of their limits from \
                        these limits, with straight cables; positive is sufficient for a feasible pose, but not \
                        necessary (theory, equation (40z)); for comparison with programs that use it",
        needs: RequiredModel::HeldPose,
        columns: |_, _| {
            one("closed_form_margin_n", "N", "distance of the closed-form tensions from their limits: sufficient only")
        },
        values: |row, _, out| {
            let found = statics::closed_form_margin(row.robot, &row.rest.pose);
            let none = || Status::new("required-load", NO_FACETS);
            row.push(Some(found.ok_or_else(none)), out);
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "acceleration-max",
        about: "largest acceleration in every direction from rest, angular ones times the platform's size",
        documentation: "`acceleration_max_m_s2`: largest acceleration of the platform in every direction from rest, \
                        angular accelerations times the platform's size, with the dead load alone",
        needs: RequiredModel::HeldPose,
        columns: |_, _| one("acceleration_max_m_s2", "m/s²", "largest acceleration in every direction from rest"),
        values: |row, _, out| {
            let found = row.of_capacity(|capacity| Ok(capacity.largest_acceleration()), NO_FACETS);
            row.push(Some(found), out);
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "speed-factor",
        about: "largest multiple of the required velocities with which every winch stays within its limits",
        documentation: "`speed_factor`: largest multiple of the required velocities (`[required]`, or options \
                        `required_velocity_m_s`, `required_angular_velocity_rad_s`) with which every winch stays \
                        within its limits of speed, torque and power; all are reached if it is at least 1",
        needs: RequiredModel::HeldPose,
        columns: |_, _| one("speed_factor", "1", "largest multiple of the required velocities that the winches allow"),
        values: |row, _, out| {
            let found = row.of_required_speeds(|speeds, twists| speeds.factor(twists).value);
            row.push(Some(found), out);
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "speed-max:AXIS",
        about: "largest speed of the platform along or about an axis, both ways",
        documentation: "`speed_max_x_m_s` … `speed_max_rz_rad_s`: largest speed of the platform along x, y or z, or \
                        about one of these axes (rx, ry, rz), that the winches allow both ways",
        takes: ParameterKind::Axis,
        needs: RequiredModel::HeldPose,
        columns: |_, parameter| {
            let axis = parameter.axis();
            let (suffix, unit) = if axis < 3 { ("m_s", "m/s") } else { ("rad_s", "rad/s") };
            let about = "largest speed along or about this axis that the winches allow both ways";
            vec![column(format!("speed_max_{}_{suffix}", twist_axes()[axis]), unit, about)]
        },
        values: |row, parameter, out| {
            let unit_w = Vec6::ith(parameter.axis(), 1.0);
            let is_possible = row.robot.platform.motion.can_follow(&unit_w);
            let both = |speeds: &WinchSpeeds| speeds.along(&unit_w).value.min(speeds.along(&-unit_w).value);
            let none = if is_possible { "no winch limits this motion" } else { "the platform cannot make this motion" };
            let found = row.of_speeds(|speeds| is_possible.then(|| both(speeds)), none);
            row.push(Some(found), out);
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "motor-power",
        about: "power of all motors that drive, at the worst of the required velocities",
        documentation: "`motor_power_w`: sum of the mechanical powers of all motors that drive, at the worst corner of \
                        the required velocities",
        needs: RequiredModel::HeldPose,
        columns: |_, _| one("motor_power_w", "W", "power of all motors that drive, at the worst required velocity"),
        values: |row, _, out| {
            let found = row.of_required_speeds(|speeds, twists| speeds.powers(twists).driving);
            row.push(Some(found), out);
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "brake-power",
        about: "power of all motors that brake, at the worst of the required velocities",
        documentation: "`brake_power_w`: sum of the mechanical powers of all motors that brake, at the worst corner of \
                        the required velocities",
        needs: RequiredModel::HeldPose,
        columns: |_, _| one("brake_power_w", "W", "power of all motors that brake, at the worst required velocity"),
        values: |row, _, out| {
            let found = row.of_required_speeds(|speeds, twists| speeds.powers(twists).braking);
            row.push(Some(found), out);
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "winch-tension",
        about: "largest tension at a drum for everything that is required",
        documentation: "`winch_tension_n`: largest tension at the drum of any cable, over every required load, with \
                        tensions by their rule",
        needs: RequiredModel::HeldPose,
        columns: |_, _| one("winch_tension_n", "N", "largest tension at a drum for everything that is required"),
        values: |row, _, out| row.winch_need(WinchNeed::Tension, out),
        ..Definition::PLAIN
    },
    Definition {
        name: "winch-speed",
        about: "largest speed of a cable at its drum for the required velocities",
        documentation: "`winch_speed_m_s`: largest speed of any cable at its drum for the required velocities, over \
                        every required load",
        needs: RequiredModel::HeldPose,
        columns: |_, _| {
            one("winch_speed_m_s", "m/s", "largest speed of a cable at its drum for the required velocities")
        },
        values: |row, _, out| row.winch_need(WinchNeed::Speed, out),
        ..Definition::PLAIN
    },
    Definition {
        name: "winch-acceleration",
        about: "largest acceleration of a cable at its drum for the required motions",
        documentation: "`winch_acceleration_m_s2`: largest acceleration of any cable at its drum for the required \
                        accelerations and velocities",
        needs: RequiredModel::HeldPose,
        columns: |_, _| {
            one(
                "winch_acceleration_m_s2",
                "m/s²",
                "largest acceleration of a cable at its drum for the required motions",
            )
        },
        values: |row, _, out| row.winch_need(WinchNeed::Acceleration, out),
        ..Definition::PLAIN
    },
    Definition {
        name: "winch-torque",
        about: "largest torque of a motor for everything that is required",
        documentation: "`winch_torque_n_m`: largest torque of any motor for everything that is required; empty \
                        without a radius of a drum",
        needs: RequiredModel::HeldPose,
        columns: |_, _| one("winch_torque_n_m", "N m", "largest torque of a motor for everything that is required"),
        values: |row, _, out| row.winch_need(WinchNeed::Torque, out),
        ..Definition::PLAIN
    },
    Definition {
        name: "winch-power",
        about: "largest power of a motor that drives, for everything that is required",
        documentation: "`winch_power_w`: largest mechanical power of any motor that drives, for everything that is \
                        required, as `winches` computes it",
        needs: RequiredModel::HeldPose,
        columns: |_, _| {
            one("winch_power_w", "W", "largest power of a motor that drives, for everything that is required")
        },
        values: |row, _, out| row.winch_need(WinchNeed::Power, out),
        ..Definition::PLAIN
    },
    Definition {
        name: "winch-brake-power",
        about: "largest power of a motor that brakes, for everything that is required",
        documentation: "`winch_brake_power_w`: largest mechanical power of any motor that brakes, for everything \
                        that is required",
        needs: RequiredModel::HeldPose,
        columns: |_, _| {
            one("winch_brake_power_w", "W", "largest power of a motor that brakes, for everything that is required")
        },
        values: |row, _, out| row.winch_need(WinchNeed::BrakePower, out),
        ..Definition::PLAIN
    },
    Definition {
        name: "gust-rms",
        about: "r.m.s. distance of the platform origin from its mean place in gusts",
        documentation: "`gust_rms_m`: r.m.s. distance of the platform origin from its mean place in the gusts of the \
                        robot file (`turbulence` in `[wind]`), as `gust` computes it",
        columns: |_, _| one("gust_rms_m", "m", "r.m.s. distance of the platform origin from its mean place in gusts"),
        values: |row, _, out| {
            let found = row.of_gusts(|of| Some(of.rms));
            row.push(Some(found), out);
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "gust-peak",
        about: "largest expected peak of the platform origin along x, y or z in gusts, within ten minutes",
        documentation: "`gust_peak_m`: largest of the expected peaks of the platform origin along x, y and z in these \
                        gusts, within ten minutes",
        columns: |_, _| {
            one(
                "gust_peak_m",
                "m",
                "largest expected peak of the platform origin along x, y or z in gusts, within ten minutes",
            )
        },
        values: |row, _, out| {
            let found = row.of_gusts(|of| of.peak);
            row.push(Some(found), out);
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "gust-tension-min",
        about: "smallest expected tension of a cable at the platform in gusts, within ten minutes",
        documentation: "`gust_tension_min_n`: smallest expected tension of a cable at its platform end in these gusts, \
                        within ten minutes; negative if a cable becomes slack",
        columns: |_, _| {
            one(
                "gust_tension_min_n",
                "N",
                "smallest expected tension of a cable at the platform in gusts, within ten minutes",
            )
        },
        values: |row, _, out| {
            let found = row.of_gusts(|of| of.tension_min);
            row.push(Some(found), out);
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "gust-slack",
        about: "largest probability that a cable becomes slack in gusts, within ten minutes",
        documentation: "`gust_slack_probability`: largest probability that the tension of a cable falls to zero in \
                        these gusts, within ten minutes",
        columns: |_, _| {
            one(
                "gust_slack_probability",
                "1",
                "largest probability that a cable becomes slack in gusts, within ten minutes",
            )
        },
        values: |row, _, out| {
            let found = row.of_gusts(|of| Some(of.slack_probability));
            row.push(Some(found), out);
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "stiffness",
        about: "static stiffness along every coordinate, with the other coordinates free",
        documentation: "`stiffness_x_n_per_m` … `stiffness_rz_n_m_per_rad`: static stiffness along one coordinate \
                        while the platform is free to move along the others: 1/(K⁻¹)_ii of the 6×6 stiffness K, not \
                        its entry K_ii; in wind the drag turns with the cables",
        needs: RequiredModel::Elastic,
        columns: |robot, _| stiffness_columns(robot),
        values: |row, _, out| {
            let found = statics::stiffness_along_coordinates(row.robot, row.rest);
            let along = |k: usize| found.as_ref().map(|stiffness| stiffness[k]);
            out.extend((0..row.robot.platform.motion.count()).map(|k| Value::real(along(k))));
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "pose-error",
        about: "distances between the poses of ideal, spring and catenary cables with the same lengths",
        documentation: "`spring_from_ideal_distance_m`, `catenary_from_ideal_distance_m`, \
                        `spring_from_catenary_distance_m`: distances between the equilibrium positions of two static \
                        models. All models get the unstrained lengths of the catenaries. The first two columns need as \
                        many cables as degrees of freedom. A distance is empty if the other model has no equilibrium \
                        nearby, for example if all springs are slack",
        needs: RequiredModel::Catenary,
        columns: |robot, _| pose_error_columns(robot),
        values: |row, _, out| row.pose_error(out),
        ..Definition::PLAIN
    },
    Definition {
        name: "sag-max",
        about: "maximum ratio of sag to chord",
        documentation: "`sag_ratio_max`: maximum ratio of sag to chord",
        columns: |_, _| one("sag_ratio_max", "1", "maximum ratio of sag to chord"),
        values: |row, _, out| {
            let sags = row.rest.cables.iter().enumerate().map(|(i, cable)| Sag::of(row.robot, i, cable));
            let ratios = sags.map(|sag| if sag.tension > 0.0 { sag.ratio() } else { f64::INFINITY });
            out.push(Value::real(ratios.reduce(f64::max)));
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "model-error:MODEL",
        about: "relative error of the first frequency with a simpler cable model",
        documentation: "`model_error_MODEL`: first frequency with a simpler cable model divided by the one with \
                        `catenary-dynamic`, minus one; without MODEL `shallow-dynamic`",
        takes: ParameterKind::Model(CableModel::ShallowDynamic),
        needs: RequiredModel::Catenary,
        columns: |_, parameter| {
            let about = "first frequency with this cable model divided by the one with catenary-dynamic, minus one";
            vec![column(format!("model_error_{}", parameter.underscored()), "1", about)]
        },
        values: |row, parameter, out| {
            let error = parameter.model().map(|model| row.model_error(model));
            row.push(error, out);
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "stiffness-error:MODEL",
        about: "relative error of the minimum stiffness with a simpler cable model",
        documentation: "`stiffness_error_MODEL`: minimum static stiffness with a simpler cable model divided by the \
                        one with `catenary-static`, minus one; without MODEL `spring`",
        takes: ParameterKind::Model(CableModel::Spring),
        needs: RequiredModel::Catenary,
        columns: |_, parameter| {
            let about =
                "minimum static stiffness with this cable model divided by the one with catenary-static, minus one";
            vec![column(format!("stiffness_error_{}", parameter.underscored()), "1", about)]
        },
        values: |row, parameter, out| {
            let error = parameter.model().map(|model| row.stiffness_error(model));
            row.push(error, out);
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "sensitivity:RESULT:PATH",
        about: "derivative of a result by a number of the robot file",
        documentation: "`first_frequency_hz_by_PATH`, `load_factor_by_PATH`, `tension_platform_NAME_n_by_PATH` …: \
                        derivative of `first-frequency`, `stiffness-min`, `load-factor`, `rope-length`, `rope-mass`, \
                        `lengths` or a tension (`tensions`, `exit-tensions`, `drum-tensions`) by a number of the robot \
                        file, as in \
                        `sensitivity:first-frequency:platform.mass_kg`, in the unit of the result over that of the \
                        number. The lengths are held if the state gives them and with `⟪hold_lengths_of_pose⟫`; \
                        otherwise the pose is held, and the tensions follow their rule",
        takes: ParameterKind::Sensitivity,
        needs: RequiredModel::Elastic,
        columns: |robot, parameter| {
            parameter.sensitivity().map_or_else(Vec::new, |of| of.columns(&columns_of(of.result(), robot)))
        },
        values: |row, parameter, out| {
            if let Some(of) = parameter.sensitivity() {
                of.values(row, out);
            }
        },
        ..Definition::PLAIN
    },
    Definition {
        name: "condition",
        about: "inverse condition number of the cables' directions: 0 at a singular pose, at most 1",
        documentation: "`inverse_condition`: minimum divided by maximum singular value of the cables' directions \
                        (moments divided by the platform's size); 0 at a singular pose",
        columns: |_, _| {
            one("inverse_condition", "1", "minimum divided by maximum singular value of the cables' scaled directions")
        },
        values: |row, _, out| out.push(Value::real(Some(statics::inverse_condition(row.robot, row.rest)))),
        ..Definition::PLAIN
    },
    Definition {
        name: "energy",
        about: "potential energy of platform, load and cables",
        documentation: "`potential_energy_j`: potential energy of platform, load and cables, heights from the world's \
                        origin",
        columns: |_, _| one("potential_energy_j", "J", "potential energy of platform, load and cables"),
        values: |row, _, out| out.push(Value::real(Some(statics::energy(row.robot, row.rest)))),
        ..Definition::PLAIN
    },
    Definition {
        name: "pose",
        about: "pose of the equilibrium",
        documentation: "`pose_x_m` … `pose_yaw_deg`: pose of the equilibrium, which a `sweep` from lengths computes",
        columns: |_, _| {
            let axes = AXES.iter().enumerate().map(|(i, axis)| (axis, if i < 3 { "m" } else { "deg" }));
            let about = "coordinate of the equilibrium pose, world axes, R = Rz Ry Rx";
            axes.map(|(axis, unit)| column(format!("pose_{axis}_{unit}"), unit, about)).collect()
        },
        values: |row, _, out| {
            let pose = &row.rest.pose;
            let angles = rotation::to_roll_pitch_yaw_deg(&pose.rot_wp);
            out.extend(pose.position_w.iter().chain(&angles).map(|value| Value::real(Some(*value))));
        },
        ..Definition::PLAIN
    },
];

/// Columns of the quantity with this name.
fn columns_of(name: &str, robot: &Robot) -> Vec<Column> {
    let quantity = name.parse::<Quantity>();
    quantity.map_or_else(|_| Vec::new(), |quantity| quantity.columns(robot))
}

/// Column of numbers.
pub(super) fn column(name: String, unit: &'static str, about: &str) -> Column {
    Column { name, unit: unit.into(), about: about.to_owned(), kind: ColumnKind::Real }
}

/// Single column of numbers.
fn one(name: &str, unit: &'static str, about: &str) -> Vec<Column> {
    vec![column(name.to_owned(), unit, about)]
}

fn stiffness_columns(robot: &Robot) -> Vec<Column> {
    let motion = &robot.platform.motion;
    let about = "load along this coordinate divided by the motion along it, with all other coordinates free";
    let names = motion.coordinate_names().iter().enumerate();
    names
        .map(|(k, name)| {
            let (suffix, unit) = if motion.is_rotation(k) { ("n_m_per_rad", "N m/rad") } else { ("n_per_m", "N/m") };
            column(format!("stiffness_{name}_{suffix}"), unit, about)
        })
        .collect()
}

fn pose_error_columns(robot: &Robot) -> Vec<Column> {
    let pairs: &[&str] = if robot.constraint() == Constraint::Fully {
        &["spring_from_ideal", "catenary_from_ideal", "spring_from_catenary"]
    } else {
        &["spring_from_catenary"]
    };
    let about = "distance between the platform origins of two static models at the same lengths";
    pairs.iter().map(|pair| column(format!("{pair}_distance_m"), "m", about)).collect()
}

/// One if straight cables could balance every load at a pose, otherwise zero.
fn closure(robot: &Robot, pose: &Pose) -> f64 {
    f64::from(u8::from(statics::wrench_closure(robot, pose).is_closed()))
}

/// Largest ratio of minimum to maximum tension at a pose without a load.
fn tension_factor(robot: &Robot, pose: &Pose) -> f64 {
    statics::wrench_closure(robot, pose).tension_factor
}
