//! `[winches.NAME]`: winches that cables refer to.

use super::key::{Absent, Key, KeyValue, Shape};
use super::range::Range;
use super::read::{Reader, Section};
use super::winch_limits;
use crate::robot::{Control, DrumSide, Servo, Winch};

/// Keys of `[winches.NAME]`.
pub(super) const WINCH: &[Key] = &[
    Key::numeric(
        Shape::Number,
        "drum_side_length_m",
        "drum_side_length_m = 3.0",
        "m",
        Range::NotNegative,
        "length of the cable from the drum to its anchor, guide wheels included",
    )
    .or([0.0; 3]),
    Key::other(
        "drum_side",
        r#"drum_side = "massless""#,
        KeyValue::Word(DRUM_SIDES),
        "vibration of the cable between drum and exit point; no difference at rest",
    )
    .without(Absent::DefaultWord("massless")),
    Key::numeric(
        Shape::Number,
        "drum_radius_m",
        "drum_radius_m = 0.0675",
        "m",
        Range::Positive,
        "radius of the drum, from its axis to the centre line of the cable",
    )
    .without(Absent::Depends("required with a shaft stiffness, an inertia, a torque, or a damping or gain per radian")),
    Key::numeric(
        Shape::Number,
        "stiffness_n_per_m",
        "stiffness_n_per_m = 200e3",
        "N/m",
        Range::Positive,
        "stiffness of drum, shaft and gear at the cable",
    )
    .without(Absent::Means("the `shaft_stiffness_n_m_per_rad` if it is given, else a rigid winch")),
    Key::numeric(
        Shape::Number,
        "shaft_stiffness_n_m_per_rad",
        "shaft_stiffness_n_m_per_rad = 800",
        "N m/rad",
        Range::Positive,
        "torsional stiffness of shaft and gear at the drum",
    )
    .without(Absent::Means("the `stiffness_n_per_m` if it is given, else a rigid winch")),
    Key::numeric(
        Shape::Number,
        "drum_inertia_kg_m2",
        "drum_inertia_kg_m2 = 0.27",
        "kg m²",
        Range::NotNegative,
        "moment of inertia of the drum about its axis, with all that turns rigidly with it",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Number,
        "motor_inertia_kg_m2",
        "motor_inertia_kg_m2 = 0.0012",
        "kg m²",
        Range::NotNegative,
        "moment of inertia of the motor about its own axis, in front of the gear",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Number,
        "gear_ratio",
        "gear_ratio = 5",
        "1",
        Range::Positive,
        "turns of the motor per turn of the drum",
    )
    .or([1.0, 0.0, 0.0]),
    Key::numeric(
        Shape::Number,
        "damping_n_m_s_per_rad",
        "damping_n_m_s_per_rad = 0.8",
        "N m s/rad",
        Range::NotNegative,
        "viscous damping of motor and bearings, at the drum",
    )
    .or([0.0; 3]),
    Key::other("control", r#"control = "position""#, KeyValue::Word(CONTROLS), "control of the motor")
        .without(Absent::DefaultWord("ideal")),
    Key::numeric(
        Shape::Number,
        "bandwidth_hz",
        "bandwidth_hz = 5",
        "Hz",
        Range::Positive,
        "bandwidth f of a position control: position gain M (2πf)², M being the mass of drum and motor at the cable",
    )
    .without(Absent::Depends("a position control needs it or `position_gain_n_m_per_rad`")),
    Key::numeric(
        Shape::Number,
        "control_damping_ratio",
        "control_damping_ratio = 0.7",
        "1",
        Range::NotNegative,
        "damping ratio ζ of a position control with `bandwidth_hz`: speed gain 2ζ M 2πf",
    )
    .or([0.7, 0.0, 0.0]),
    Key::numeric(
        Shape::Number,
        "position_gain_n_m_per_rad",
        "position_gain_n_m_per_rad = 266",
        "N m/rad",
        Range::Positive,
        "position gain at the drum: torque per error of its angle",
    )
    .without(Absent::Depends("a position control needs it or `bandwidth_hz`")),
    Key::numeric(
        Shape::Number,
        "speed_gain_n_m_s_per_rad",
        "speed_gain_n_m_s_per_rad = 12",
        "N m s/rad",
        Range::NotNegative,
        "speed gain at the drum, with `position_gain_n_m_per_rad`: torque per error of its angular velocity",
    )
    .or([0.0; 3]),
    Key::other(
        "integral_action",
        r#"integral_action = "yes""#,
        KeyValue::Word(INTEGRAL_ACTION),
        "slow integral action of a position control",
    )
    .without(Absent::DefaultWord("yes")),
    Key::numeric(
        Shape::Number,
        "delay_s",
        "delay_s = 0.002",
        "s",
        Range::NotNegative,
        "delay of a position control; it changes the damped vibration alone",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Number,
        "gear_efficiency",
        "gear_efficiency = 0.9",
        "1",
        Range::UpTo(1.0),
        "efficiency of the gear: a motor that drives gives its power times this to the drum, one that brakes receives \
         the power of the drum times this",
    )
    .or([1.0, 0.0, 0.0]),
    Key::numeric(
        Shape::Number,
        "max_speed_m_s",
        "max_speed_m_s = 3.0",
        "m/s",
        Range::Positive,
        "largest speed of the cable at the drum, both ways",
    )
    .without(NO_LIMIT),
    Key::numeric(
        Shape::Number,
        "max_acceleration_m_s2",
        "max_acceleration_m_s2 = 10.0",
        "m/s²",
        Range::Positive,
        "largest acceleration of the cable at the drum, both ways",
    )
    .without(NO_LIMIT),
    Key::numeric(
        Shape::Number,
        "max_torque_n_m",
        "max_torque_n_m = 60.0",
        "N m",
        Range::Positive,
        "largest torque of the motor at its own shaft, both ways",
    )
    .without(NO_LIMIT),
    Key::numeric(
        Shape::Number,
        "max_power_w",
        "max_power_w = 3000.0",
        "W",
        Range::Positive,
        "largest mechanical power of the motor while it drives",
    )
    .without(NO_LIMIT),
    Key::numeric(
        Shape::Number,
        "max_brake_power_w",
        "max_brake_power_w = 1000.0",
        "W",
        Range::Positive,
        "largest mechanical power that the motor takes while it brakes",
    )
    .without(Absent::Means("the `max_power_w` if it is given, else no limit")),
    Key::list(
        "torque_speed_rad_s",
        "torque_speed_rad_s = [0.0, 200.0, 400.0]",
        "rad/s",
        Range::NotNegative,
        "torque–speed curve of the motor at its own shaft: speeds of its corners, from 0, with the torques in \
         `torque_speed_n_m`; the curve is straight between corners, and beyond the last one there is no torque",
    )
    .without(NO_LIMIT),
    Key::list(
        "torque_speed_n_m",
        "torque_speed_n_m = [60.0, 60.0, 20.0]",
        "N m",
        Range::NotNegative,
        "largest torques at the speeds of `torque_speed_rad_s`, both ways",
    )
    .without(NO_LIMIT),
];

/// Effect of a limit that the file leaves out.
const NO_LIMIT: Absent = Absent::Means("no limit");

/// Values of `drum_side`, with their meanings.
const DRUM_SIDES: &[(&str, &str)] =
    &[("massless", "a spring without mass"), ("rod", "an elastic rod with the mass of the cable")];

/// Values of `control`, with their meanings.
const CONTROLS: &[(&str, &str)] = &[
    ("ideal", "the motor holds its angle exactly"),
    ("position", "a controller holds the angle, with `bandwidth_hz` or gains"),
    ("torque", "the torque of the motor is constant"),
];

/// Values of `integral_action`, with their meanings.
const INTEGRAL_ACTION: &[(&str, &str)] = &[
    ("yes", "the winch does not yield at rest"),
    ("no", "the winch yields at rest by the tension over the position gain"),
];

/// Keys that a position control alone has.
const OF_POSITION_CONTROL: [&str; 6] = [
    "bandwidth_hz",
    "control_damping_ratio",
    "position_gain_n_m_per_rad",
    "speed_gain_n_m_s_per_rad",
    "integral_action",
    "delay_s",
];

/// Reads a winch.
pub(super) fn read(reader: &mut Reader, name: &str, section: &Section) -> Option<Winch> {
    // All numbers, so that each is checked even where another is wrong.
    let drum_side_length = reader.number_or_default(section, "drum_side_length_m");
    let [drum, motor, ratio, damping] =
        ["drum_inertia_kg_m2", "motor_inertia_kg_m2", "gear_ratio", "damping_n_m_s_per_rad"]
            .map(|key| reader.number_or_default(section, key));
    let efficiency = match section.get("gear_efficiency") {
        Some(value) => reader.fraction(section, "gear_efficiency", value),
        None => Some(section.default("gear_efficiency")[0]),
    };
    let limits = winch_limits::read(reader, section);
    let radius = radius(reader, section)?;
    let drum_side = reader.word(section, "drum_side");

    // At the cable: divided by the square of the radius.
    let by_radius = |number: f64| radius.map_or(0.0, |radius| number / (radius * radius));
    let stiffness = stiffness(reader, section, radius);
    let (drum_mass, motor_mass) = (by_radius(drum?), by_radius(motor? * ratio? * ratio?));
    let control = control(reader, section, drum_mass + motor_mass, by_radius)?;

    Some(Winch {
        name: name.to_owned(),
        drum_radius: radius,
        gear_ratio: ratio?,
        gear_efficiency: efficiency?,
        drum_side_length: drum_side_length?,
        drum_side: if drum_side? == "rod" { DrumSide::Rod } else { DrumSide::Massless },
        // Tables of their own refer to the winch.
        guide_wheels: Vec::new(),
        stiffness: stiffness?,
        drum_mass,
        motor_mass,
        damping: by_radius(damping?),
        control,
        limits: limits?,
    })
}

/// Radius of the drum. The outer `None` is a refused value; the inner one is a winch without any number that refers to
/// the drum's axis.
#[expect(clippy::option_option, reason = "outside: refused, an issue is reported; inside: not given")]
fn radius(reader: &mut Reader, section: &Section) -> Option<Option<f64>> {
    if let Some(value) = section.get("drum_radius_m") {
        return reader.number_of(section, "drum_radius_m", value).map(Some);
    }

    let about_the_axis = [
        "shaft_stiffness_n_m_per_rad",
        "drum_inertia_kg_m2",
        "motor_inertia_kg_m2",
        "damping_n_m_s_per_rad",
        "bandwidth_hz",
        "position_gain_n_m_per_rad",
        "speed_gain_n_m_s_per_rad",
        "max_torque_n_m",
        "torque_speed_rad_s",
        "torque_speed_n_m",
    ];

    // Two stiffnesses are an error of their own.
    let about_the_axis = about_the_axis.into_iter().skip(usize::from(section.get("stiffness_n_per_m").is_some()));
    let Some(key) = about_the_axis.into_iter().find(|key| section.get(key).is_some()) else { return Some(None) };
    if !section.mistyped(&["drum_radius_m"]) {
        reader.issue(section.span.clone(), format!("{} has `{key}`, but no `drum_radius_m`", section.label())).help(
            "add it, for example `drum_radius_m = 0.0675`; a stiffness, an inertia or a damping counts at the cable \
                 by its square, a torque by the radius",
        );
    }

    None
}

/// Stiffness at the cable [N/m]; infinite for a rigid winch.
fn stiffness(reader: &mut Reader, section: &Section, radius: Option<f64>) -> Option<f64> {
    let mut number = |key: &str| section.get(key).map(|value| reader.number_of(section, key, value));
    match ["stiffness_n_per_m", "shaft_stiffness_n_m_per_rad"].map(&mut number) {
        [None, None] => Some(f64::INFINITY),
        [Some(at_cable), None] => at_cable,
        [None, Some(at_shaft)] => Some(at_shaft? / radius?.powi(2)),
        [Some(_), Some(_)] => {
            let span = section.get("shaft_stiffness_n_m_per_rad").map_or(section.span.clone(), toml::Spanned::span);
            let issue = reader.issue(span, "`shaft_stiffness_n_m_per_rad` does not go with `stiffness_n_per_m`");
            if let Some(first) = section.get("stiffness_n_per_m") {
                issue.context(first.span(), "already given here");
            }
            issue.help("give one of the two: the stiffness at the cable, or that of the shaft with `drum_radius_m`");
            None
        }
    }
}

/// Control of the motor, which moves this mass at the cable [kg].
fn control(reader: &mut Reader, section: &Section, mass: f64, by_radius: impl Fn(f64) -> f64) -> Option<Control> {
    let word = reader.word(section, "control")?;
    if word != "position" {
        if let Some((key, value)) = OF_POSITION_CONTROL.iter().find_map(|key| Some((key, section.get(key)?))) {
            reader
                .issue(value.span(), format!("`{key}` goes with `control = \"position\"`, not \"{word}\""))
                .help("set `control = \"position\"`, or remove the line");
            return None;
        }
        return Some(if word == "torque" { Control::Torque } else { Control::Ideal });
    }

    let integral = reader.word(section, "integral_action")? == "yes";
    let delay = reader.number_or_default(section, "delay_s")?;
    let mut number = |key: &str| section.get(key).map(|value| reader.number_of(section, key, value));
    let servo = match ["bandwidth_hz", "position_gain_n_m_per_rad"].map(&mut number) {
        [Some(bandwidth), None] => {
            let damping_ratio = damping_ratio_with_bandwidth(reader, section, mass)?;
            Servo::of_bandwidth(mass, bandwidth?, damping_ratio, integral, delay)
        }
        [None, Some(gain)] => {
            if let Some(value) = section.get("control_damping_ratio") {
                reader
                    .issue(value.span(), "`control_damping_ratio` does not go with `position_gain_n_m_per_rad`")
                    .help("give `speed_gain_n_m_s_per_rad`, or `bandwidth_hz` with the damping ratio");
                return None;
            }
            let speed_gain = reader.number_or_default(section, "speed_gain_n_m_s_per_rad")?;
            Servo { position_gain: by_radius(gain?), speed_gain: by_radius(speed_gain), integral, delay }
        }
        [None, None] => {
            if !section.mistyped(&["bandwidth_hz", "position_gain_n_m_per_rad"]) {
                reader
                    .issue(
                        section.span.clone(),
                        format!("{} has a position control without a bandwidth", section.label()),
                    )
                    .help("add `bandwidth_hz = 5`, or `position_gain_n_m_per_rad` and `speed_gain_n_m_s_per_rad`");
            }
            return None;
        }
        [Some(_), Some(_)] => {
            let span = section.get("position_gain_n_m_per_rad").map_or(section.span.clone(), toml::Spanned::span);
            reader
                .issue(span, "`position_gain_n_m_per_rad` does not go with `bandwidth_hz`")
                .help("give one of the two: the bandwidth with its damping ratio, or the gains");
            return None;
        }
    };
    Some(Control::Position(servo))
}

/// Damping ratio of a position control that has a bandwidth; `None` if the file gives a value that does not go with a
/// bandwidth, or a winch without mass.
fn damping_ratio_with_bandwidth(reader: &mut Reader, section: &Section, mass: f64) -> Option<f64> {
    if let Some(value) = section.get("speed_gain_n_m_s_per_rad") {
        reader
            .issue(value.span(), "`speed_gain_n_m_s_per_rad` does not go with `bandwidth_hz`")
            .help("give `control_damping_ratio` with the bandwidth, or both gains");
        return None;
    }
    if mass == 0.0 {
        reader
            .issue(section.span.clone(), format!("{} has `bandwidth_hz`, but no inertia", section.label()))
            .help("add `drum_inertia_kg_m2` or `motor_inertia_kg_m2`, or give `position_gain_n_m_per_rad`");
        return None;
    }
    reader.number_or_default(section, "control_damping_ratio")
}
