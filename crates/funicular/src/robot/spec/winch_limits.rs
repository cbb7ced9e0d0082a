//! Limits of `[winches.NAME]`: speed and acceleration of the cable, torque, power and torque–speed curve of the motor.

use super::read::{Reader, Section, Value};
use crate::robot::WinchLimits;
use toml::de::DeValue;

/// Keys of the torque–speed curve: speeds, and the torques at them.
const CURVE: [&str; 2] = ["torque_speed_rad_s", "torque_speed_n_m"];

/// Reads the limits of a winch.
pub(super) fn read(reader: &mut Reader, section: &Section) -> Option<WinchLimits> {
    let mut limit = |key: &str| match section.get(key) {
        Some(value) => reader.number_of(section, key, value),
        None => Some(f64::INFINITY),
    };
    let (speed, acceleration) = (limit("max_speed_m_s"), limit("max_acceleration_m_s2"));
    let (torque, power) = (limit("max_torque_n_m"), limit("max_power_w"));
    let brake_power = if section.get("max_brake_power_w").is_some() { limit("max_brake_power_w") } else { power };
    let torque_speed = torque_speed(reader, section);

    Some(WinchLimits {
        speed: speed?,
        acceleration: acceleration?,
        torque: torque?,
        power: power?,
        brake_power: brake_power?,
        torque_speed: torque_speed?,
    })
}

/// Corners of the torque–speed curve; empty if the file gives none.
fn torque_speed(reader: &mut Reader, section: &Section) -> Option<Vec<[f64; 2]>> {
    let (speed_value, torque_value) = match CURVE.map(|key| section.get(key)) {
        [None, None] => return Some(Vec::new()),
        [Some(speeds), Some(torques)] => (speeds, torques),
        [speeds, _] => {
            let (given, missing) = if speeds.is_some() { (CURVE[0], CURVE[1]) } else { (CURVE[1], CURVE[0]) };
            if !section.mistyped(&[missing]) {
                let message = format!("{} has `{given}`, but no `{missing}`", section.label());
                reader.issue(section.span.clone(), message).help(format!(
                    "add it: a torque–speed curve has as many speeds as torques, for example `{}`",
                    section.example(missing)
                ));
            }
            return None;
        }
    };
    let (speeds, torques) = (reader.list(section, CURVE[0], speed_value), reader.list(section, CURVE[1], torque_value));
    let (speeds, torques) = (speeds?, torques?);

    if speeds.len() != torques.len() {
        let message = format!("`{}` has {} numbers, `{}` {}", CURVE[1], torques.len(), CURVE[0], speeds.len());
        let issue = reader.issue(torque_value.span(), message);
        issue.context(speed_value.span(), "the speeds are here");
        issue.help("give one torque for each speed");
        return None;
    }
    check_speeds(reader, &speeds, speed_value)?;
    Some(speeds.into_iter().zip(torques).map(|(speed, torque)| [speed, torque]).collect())
}

/// Reports speeds of a curve that do not begin at rest or do not rise.
fn check_speeds(reader: &mut Reader, speeds: &[f64], value: &Value) -> Option<()> {
    let DeValue::Array(elements) = value.get_ref() else { return None };
    let span = |i: usize| elements.get(i).map_or_else(|| value.span(), toml::Spanned::span);

    if let Some(first) = speeds.first().filter(|first| **first != 0.0) {
        let message = format!("`{}` begins at {first} rad/s, it must begin at 0", CURVE[0]);
        reader.issue(span(0), message).help(format!("add the speed 0 and the torque at rest in `{}`", CURVE[1]));
        return None;
    }
    if let Some(i) = (1..speeds.len()).find(|i| speeds[*i] <= speeds[i - 1]) {
        let message = format!(
            "number {} of `{}` is {} rad/s, not above {} rad/s before it",
            i + 1,
            CURVE[0],
            speeds[i],
            speeds[i - 1]
        );
        reader.issue(span(i), message).help("order the corners by rising speed, each speed once");
        return None;
    }
    Some(())
}
