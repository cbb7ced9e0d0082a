//! Keys and reading of `[required]` and `[[required_loads]]`: loads that the robot has to bear.

use super::key::{Absent, Key, KeyValue, Shape};
use super::range::Range;
use super::read::{Reader, Section, shortened};
use crate::math::Vec3;
use crate::robot::{Load, LoadShape, PlatformMotion, RequiredLoads, RequiredLoadsError, RequiredPayload, Wind};
use toml::de::DeValue;

/// Words of `shape`.
const SHAPES: &[(&str, &str)] = &[
    ("box", "every component varies by itself"),
    ("ellipsoid", "ellipsoid with these half axes; a ball if they are equal"),
];

/// Words of `velocity_shape`.
const VELOCITY_SHAPES: &[(&str, &str)] = &[
    ("box", "largest along all axes at once"),
    ("ellipsoid", "half axes of an ellipsoid; every direction up to one speed if they are equal"),
];

/// Keys of `[required]`.
pub(super) const REQUIRED: &[Key] = &[
    Key::numeric(
        Shape::Vector,
        "force_n",
        "force_n = [150.0, 150.0, 150.0]",
        "N",
        Range::NotNegative,
        "largest required force, both ways along each world axis",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Vector,
        "moment_n_m",
        "moment_n_m = [30.0, 30.0, 30.0]",
        "N m",
        Range::NotNegative,
        "largest required moment about the platform origin, both ways about each world axis",
    )
    .or([0.0; 3]),
    Key::other("shape", "shape = \"box\"", KeyValue::Word(SHAPES), "shape of the set of forces and moments")
        .without(Absent::DefaultWord("box")),
    Key::numeric(
        Shape::Number,
        "payload_min_kg",
        "payload_min_kg = 0.0",
        "kg",
        Range::NotNegative,
        "minimum payload, which is always carried",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Number,
        "payload_max_kg",
        "payload_max_kg = 300.0",
        "kg",
        Range::NotNegative,
        "maximum payload",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Vector,
        "payload_center_m",
        "payload_center_m = [0.0, 0.0, -0.2]",
        "m",
        Range::Any,
        "middle of the centres of mass of the payload, platform frame",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Vector,
        "payload_center_reach_m",
        "payload_center_reach_m = [0.1, 0.1, 0.0]",
        "m",
        Range::NotNegative,
        "largest distance of the centre of mass of the payload from this middle, both ways along each axis of the \
         platform",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Vector,
        "acceleration_m_s2",
        "acceleration_m_s2 = [1.0, 1.0, 1.0]",
        "m/s²",
        Range::NotNegative,
        "largest required acceleration of the platform origin from rest, both ways along each world axis",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Vector,
        "angular_acceleration_rad_s2",
        "angular_acceleration_rad_s2 = [0.5, 0.5, 0.5]",
        "rad/s²",
        Range::NotNegative,
        "largest required angular acceleration from rest, both ways about each world axis",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Number,
        "wind_speed_m_s",
        "wind_speed_m_s = 12.0",
        "m/s",
        Range::NotNegative,
        "wind from every horizontal direction, in addition to [wind], on the platform with its `drag_area_m2` and on \
         sagging ropes with a `drag_coefficient`",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Vector,
        "velocity_m_s",
        "velocity_m_s = [1.0, 1.0, 0.5]",
        "m/s",
        Range::NotNegative,
        "largest required velocity of the platform origin, both ways along each world axis; for `speeds`, it is no \
         load",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Vector,
        "angular_velocity_rad_s",
        "angular_velocity_rad_s = [0.2, 0.2, 0.2]",
        "rad/s",
        Range::NotNegative,
        "largest required angular velocity, both ways about each world axis; for `speeds`, it is no load",
    )
    .or([0.0; 3]),
    Key::other(
        "velocity_shape",
        "velocity_shape = \"box\"",
        KeyValue::Word(VELOCITY_SHAPES),
        "shape of the set of velocities, and of that of angular velocities",
    )
    .without(Absent::DefaultWord("box")),
];

/// Reads `[required]` and `[[required_loads]]`.
pub(super) fn read(
    reader: &mut Reader,
    root: &Section,
    motion: Option<PlatformMotion>,
    load_keys: &'static [Key],
) -> Option<RequiredLoads> {
    let listed = read_listed(reader, root, motion, load_keys);
    let Some(value) = root.get("required") else {
        return Some(RequiredLoads { listed: listed?, ..Default::default() });
    };
    let table = reader.table("required", "[required]", value)?;
    let section = reader.open("[required]", value.span(), table, REQUIRED);

    let [shape, velocity_shape] = ["shape", "velocity_shape"].map(|key| reader.word(&section, key));
    let shape_of = |word| if word == "ellipsoid" { LoadShape::Ellipsoid } else { LoadShape::Box };
    let mut vector = |key: &str| reader.vector_or_default(&section, key).map(Vec3::from);
    let (force_w, moment_w) = (vector("force_n"), vector("moment_n_m"));
    let (center_p, center_reach_p) = (vector("payload_center_m"), vector("payload_center_reach_m"));
    let (acceleration_w, angular_w) = (vector("acceleration_m_s2"), vector("angular_acceleration_rad_s2"));
    let (velocity_w, angular_velocity_w) = (vector("velocity_m_s"), vector("angular_velocity_rad_s"));
    let mut number = |key: &str| reader.number_or_default(&section, key);
    let (min_mass, max_mass, speed) = (number("payload_min_kg"), number("payload_max_kg"), number("wind_speed_m_s"));

    let payload = RequiredPayload {
        min_mass: min_mass?,
        max_mass: max_mass?,
        center_p: center_p?,
        center_reach_p: center_reach_p?,
    };
    let required = RequiredLoads {
        shape: shape_of(shape?),
        force_w: force_w?,
        moment_w: moment_w?,
        listed: listed?,
        payload,
        acceleration_w: acceleration_w?,
        angular_acceleration_w: angular_w?,
        wind_speed: speed?,
        velocity_w: velocity_w?,
        angular_velocity_w: angular_velocity_w?,
        velocity_shape: shape_of(velocity_shape?),
    };

    // Numbers that are right by themselves, but not together.
    if required.wind_speed > Wind::MAX_SPEED {
        let span = section.get("wind_speed_m_s").map_or_else(|| value.span(), toml::Spanned::span);
        let message =
            format!("`wind_speed_m_s` is {} m/s, it must be at most {} m/s", required.wind_speed, Wind::MAX_SPEED);
        reader.issue(span, message).help("faster air is compressed, and drag no longer grows with its square");
        return None;
    }
    if let Err(error) = required.check(&motion?) {
        let key =
            if matches!(error, RequiredLoadsError::PayloadReversed { .. }) { "payload_min_kg" } else { "moment_n_m" };
        let span = section.get(key).map_or_else(|| value.span(), toml::Spanned::span);
        reader.issue(span, error.to_string());
        return None;
    }
    Some(required)
}

/// Reads `[[required_loads]]`.
fn read_listed(
    reader: &mut Reader,
    root: &Section,
    motion: Option<PlatformMotion>,
    keys: &'static [Key],
) -> Option<Vec<Load>> {
    let Some(value) = root.get("required_loads") else { return Some(Vec::new()) };
    let DeValue::Array(array) = value.get_ref() else {
        let issue = reader.wrong_type("`required_loads`", "an array of tables", value);
        issue.help("begin every load with [[required_loads]], in double brackets");
        return None;
    };

    let mut loads = Vec::with_capacity(array.len());
    for (i, value) in array.iter().enumerate() {
        let label = format!("number {} of `required_loads`", i + 1);
        let DeValue::Table(table) = value.get_ref() else {
            reader.wrong_type(&shortened(&label), "a table", value).help("begin every load with [[required_loads]]");
            return None;
        };
        let section = reader.open(label, value.span(), table, keys);
        let mut vector = |key: &str| reader.vector_or_default(&section, key).map(Vec3::from);
        let (force, moment, point) = (vector("force_n"), vector("moment_n_m"), vector("point_m"));
        let load = Load { force_w: force?, moment_w: moment?, point_p: point? };
        if let Err(error) = load.check(&motion?) {
            reader.issue(value.span(), error.to_string());
            return None;
        }
        loads.push(load);
    }
    Some(loads)
}
