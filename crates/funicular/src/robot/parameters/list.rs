//! Numbers of a parsed robot file: the list of its parameters, and a copy of its values without the text.

use super::{Parameter, RobotPart};
use crate::robot::spec::key::{Component, Key, KeyValue, Shape};
use crate::robot::spec::{TABLES, TOP, parsed};
use crate::robot::{PlatformMotion, Robot};
use std::borrow::Cow;
use toml::Spanned;
use toml::de::{DeArray, DeFloat, DeTable, DeValue};

/// Copy of a value without borrowed text. Its numbers go to the list `numbers` (first byte, number), and placeholders
/// take their places.
fn owned(value: &Spanned<DeValue<'_>>, numbers: &mut Vec<(usize, f64)>) -> Spanned<DeValue<'static>> {
    let place = value.span();
    let inner = match value.get_ref() {
        DeValue::String(text) => DeValue::String(Cow::Owned(text.to_string())),
        DeValue::Integer(_) | DeValue::Float(_) => {
            // Only digits beyond `i128` cannot be parsed; the reader has refused them.
            numbers.push((place.start, parsed(value.get_ref()).unwrap_or(f64::INFINITY)));
            DeValue::Float(DeFloat::default())
        }
        DeValue::Boolean(truth) => DeValue::Boolean(*truth),
        DeValue::Datetime(date) => DeValue::Datetime(*date),
        DeValue::Array(array) => {
            let mut copy = DeArray::new();
            array.iter().for_each(|element| copy.push(owned(element, numbers)));
            DeValue::Array(copy)
        }
        DeValue::Table(table) => DeValue::Table(owned_table(table, numbers)),
    };
    Spanned::new(place, inner)
}

/// Copy of a table without borrowed text, see [`owned`].
pub(super) fn owned_table(table: &DeTable<'_>, numbers: &mut Vec<(usize, f64)>) -> DeTable<'static> {
    let mut copy = DeTable::new();
    for (key, value) in table {
        let name = Cow::Owned(key.get_ref().to_string());
        copy.insert(Spanned::new(key.span(), name), owned(value, numbers));
    }
    copy
}

/// All numbers of a file that has been read without issues.
pub(super) fn list_of(root: &DeTable, robot: &Robot) -> Vec<Parameter> {
    let mut list = Vec::new();
    let mut table = |part: RobotPart, header: &str, path: &[&str], table: &DeTable| {
        add_table(&mut list, robot, part, (header, path), table);
    };

    // The robot and its platform.
    table(RobotPart::Robot, TOP, &[], root);
    if let Some(DeValue::Table(platform)) = root.get("platform").map(Spanned::get_ref) {
        table(RobotPart::Platform, "[platform]", &["platform"], platform);
    }

    // Tables with names.
    let named = [
        ("materials", RobotPart::Material),
        ("pulleys", RobotPart::Pulley),
        ("winches", RobotPart::Winch),
        ("guide_wheels", RobotPart::GuideWheel),
        ("supports", RobotPart::Support),
        ("platform_bodies", RobotPart::Body),
        ("obstacles", RobotPart::Body),
    ];
    for (kind, part) in named {
        let Some(DeValue::Table(tables)) = root.get(kind).map(Spanned::get_ref) else { continue };
        for (name, entry) in tables {
            if let DeValue::Table(entry) = entry.get_ref() {
                table(part, &format!("[{kind}.NAME]"), &[kind, name.get_ref()], entry);
            }
        }
    }

    // The cables.
    if let Some(DeValue::Array(cables)) = root.get("cables").map(Spanned::get_ref) {
        for (i, (entry, cable)) in cables.iter().zip(&robot.cables).enumerate() {
            if let DeValue::Table(entry) = entry.get_ref() {
                table(RobotPart::Cable(i), "[[cables]]", &["cables", &cable.name], entry);
            }
        }
    }

    // Tables that may be absent, whose defaults count.
    let absent = DeTable::new();
    let optional = [
        (RobotPart::Load, "loads"),
        (RobotPart::Required, "required"),
        (RobotPart::Clearance, "clearance"),
        (RobotPart::Wind, "wind"),
        (RobotPart::State, "state"),
    ];
    for (part, name) in optional {
        match root.get(name).map(Spanned::get_ref) {
            Some(DeValue::Table(entry)) => table(part, &format!("[{name}]"), &[name], entry),
            // Without a pose, the orientation has no meaning either, and most robots have no requirements.
            _ if matches!(part, RobotPart::State | RobotPart::Required | RobotPart::Clearance) => {}
            _ => table(part, &format!("[{name}]"), &[name], &absent),
        }
    }
    list
}

/// Adds all numbers of a table with a header, at a path of keys.
fn add_table(
    list: &mut Vec<Parameter>,
    robot: &Robot,
    part: RobotPart,
    (header, path): (&str, &[&str]),
    table: &DeTable,
) {
    let keys = TABLES.iter().find(|table| table.header == header).map_or(&[][..], |table| table.keys);
    for key in keys {
        let KeyValue::Numbers(numbers) = &key.value else { continue };
        let found = match table.get(key.name) {
            Some(value) => numbers_at(value.get_ref(), &value.span(), numbers.shape),
            None => defaults(key, numbers.shape, table, robot),
        };
        for (component, value, places) in found {
            let names = path.iter().copied().chain([key.name]).chain(component);
            list.push(Parameter {
                keys: names.map(str::to_owned).collect(),
                part,
                key: key.name,
                component,
                value,
                unit: numbers.unit,
                range: numbers.range,
                about: key.about,
                given: !places.is_empty(),
                places,
            });
        }
    }
}

/// Number of a key: name of its component, value, first byte at each place where it stands.
type KeyNumber = (Option<&'static str>, f64, Vec<usize>);

/// Numbers that the file gives for a key.
fn numbers_at(value: &DeValue, span: &std::ops::Range<usize>, shape: Shape) -> Vec<KeyNumber> {
    if let Some(number) = parsed(value) {
        return vec![(None, number, vec![span.start])];
    }

    let DeValue::Array(rows) = value else { return Vec::new() };
    let element = |row: usize, column: Option<usize>| {
        let value = rows.get(row)?;
        let value = match (value.get_ref(), column) {
            (DeValue::Array(columns), Some(column)) => columns.get(column)?,
            // Three principal moments have no off-diagonal entries.
            (_, Some(column)) if column != row => return None,
            _ => value,
        };
        Some((parsed(value.get_ref())?, value.span().start))
    };

    let components = shape.components().iter();
    components
        .filter_map(|(name, component)| match *component {
            Component::Element(i) => element(i, None).map(|(value, at)| (Some(*name), value, vec![at])),
            Component::Entry(i, j) => {
                let (value, at) = element(i, Some(j))?;
                let (_, mirror) = element(j, Some(i))?;
                Some((Some(*name), value, if mirror == at { vec![at] } else { vec![at, mirror] }))
            }
        })
        .collect()
}

/// Default numbers of a key that the file leaves out, if they have a meaning for this robot.
fn defaults(key: &Key, shape: Shape, table: &DeTable, robot: &Robot) -> Vec<KeyNumber> {
    let motion = &robot.platform.motion;
    let means_something = match key.name {
        // A body between two points has its place.
        "position_m" | "roll_pitch_yaw_deg" if table.contains_key("from_m") => false,
        "plane_offset_m" => matches!(motion, PlatformMotion::Planar(_)),
        "center_of_mass_m" | "rotational_damping_n_m_s" | "moment_n_m" | "point_m" | "roll_pitch_yaw_deg" => {
            *motion != PlatformMotion::PointMass
        }
        "damping_ratio" => !table.contains_key("viscous_damping_n_s_m2"),
        "coherence_decay" => robot.turbulence.is_some(),
        _ => true,
    };
    let Some(default) = key.default_numbers().filter(|_| means_something) else { return Vec::new() };
    match shape.components() {
        [] => vec![(None, default[0], Vec::new())],
        components => {
            components.iter().zip(default).map(|((name, _), value)| (Some(*name), value, Vec::new())).collect()
        }
    }
}
