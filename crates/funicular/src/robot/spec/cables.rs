//! `[[cables]]`: each cable, and the conditions between cables.

use super::drives::{self, Drives};
use super::key::{Absent, Key, KeyValue, Shape};
use super::limits;
use super::materials::Materials;
use super::read::{Named, Reader, Section, is_zero, shortened};
use crate::math::Vec3;
use crate::robot::parameters::Range as Limits;
use crate::robot::{Cable, PlatformMotion, Pose, Support};
use std::collections::BTreeMap;
use std::ops::Range;
use toml::de::DeValue;

/// Distance of two points, relative to their distances from the origins, below which they count as one point: no cable
/// is as short as a billionth of the robot, and rounding is a millionth of that.
const COINCIDENT: f64 = 1e-9;

/// Keys of `[[cables]]`.
pub(super) const KEYS: &[Key] = &[
    Key::other("name", r#"name = "1""#, KeyValue::Name, "name of the cable, unique"),
    Key::other("material", r#"material = "rope""#, KeyValue::Name, "rope of the cable: a NAME of `[materials.NAME]`"),
    Key::numeric(
        Shape::Vector,
        "anchor_m",
        "anchor_m = [5.0, 2.0, 4.0]",
        "m",
        Limits::Any,
        "exit point of the cable, world frame; with a pulley the entry point, at which the cable coming from the winch \
         touches the wheel",
    ),
    Key::numeric(
        Shape::Vector,
        "attachment_m",
        "attachment_m = [0.1, 0.1, 0.0]",
        "m",
        Limits::Any,
        "attachment of the cable, platform frame",
    )
    .without(Absent::Depends("required, except for a point mass, for which it is zero")),
    Key::other("pulley", r#"pulley = "wheel""#, KeyValue::Name, "pulley at the anchor: a NAME of `[pulleys.NAME]`")
        .without(Absent::Means("no pulley: the cable turns about its anchor point")),
    Key::numeric(
        Shape::Vector,
        "entry_direction",
        "entry_direction = [0.0, 0.0, 1.0]",
        "1",
        Limits::Any,
        "direction in which the cable travels at its anchor towards the platform, and axis of the swivel, world axes; \
         of any length",
    )
    .without(Absent::Means("that of its pulley")),
    Key::other("winch", r#"winch = "drum""#, KeyValue::Name, "winch of the cable: a NAME of `[winches.NAME]`")
        .without(Absent::Means("no winch: the cable ends at its anchor, or on a rigid drum beside it")),
    Key::other(
        "support",
        r#"support = "post""#,
        KeyValue::Name,
        "flexible support of the anchor: a NAME of `[supports.NAME]`; `anchor_m` is then its place without forces",
    )
    .without(Absent::Means("a fixed anchor")),
    Key::numeric(
        Shape::Number,
        "minimum_tension_n",
        "minimum_tension_n = 50",
        "N",
        Limits::NotNegative,
        "minimum tension of the cable, before that of its rope",
    )
    .without(Absent::Means("that of its rope")),
    Key::numeric(
        Shape::Number,
        "maximum_tension_n",
        "maximum_tension_n = 5000",
        "N",
        Limits::Positive,
        "maximum tension of the cable, before that of its rope",
    )
    .without(Absent::Means("that of its rope")),
    Key::numeric(
        Shape::Vector,
        "load_n_per_m",
        "load_n_per_m = [0.0, 0.5, 0.0]",
        "N/m",
        Limits::Any,
        "dead load per unstrained length, in place of that of its rope, world axes",
    )
    .without(Absent::Means("that of its rope")),
    Key::numeric(
        Shape::Number,
        "unstrained_length_m",
        "unstrained_length_m = 6.5",
        "m",
        Limits::Positive,
        "unstrained length of the cable from its attachment to its anchor; with a pulley or a winch to the drum, the \
         arc on the wheel and the drum side included",
    )
    .without(Absent::Means("no length; all cables have one, or none has")),
    Key::other(
        "shares_rope_with",
        r#"shares_rope_with = "1""#,
        KeyValue::Name,
        "cable whose rope continues in this one over a sheave, on the platform where both are attached, or on the \
         frame between their anchors; the sum of the `unstrained_length_m` of a rope is held, and the rope divides it",
    )
    .without(Absent::Means("a rope of its own")),
    Key::numeric(
        Shape::Number,
        "sheave_efficiency",
        "sheave_efficiency = 0.97",
        "1",
        Limits::UpTo(1.0),
        "efficiency of that sheave: smaller over larger tension of the two cables while the rope runs; below 1 small \
         motions leave the sheave at rest",
    )
    .without(Absent::Means("no friction")),
];

/// A cable and the places of its values.
pub(super) struct CableEntry {
    /// `None` if a value was refused; the issue has been reported.
    pub cable: Option<Cable>,
    /// Name of the support of its anchor.
    pub support: Option<String>,
    /// Place of its length, valid or not.
    pub length_span: Option<Range<usize>>,
    /// Name of the cable whose rope it continues, with its place.
    pub shares: Option<(String, Range<usize>)>,
    /// Efficiency of the sheave between both.
    pub efficiency: f64,
    /// Place of `support`.
    pub support_span: Option<Range<usize>>,
    label: String,
    header: Range<usize>,
    anchor_span: Range<usize>,
    length: Option<f64>,
    length_mistyped: bool,
}

/// Reads all cables.
pub(super) fn read(
    reader: &mut Reader,
    root: &Section,
    materials: Option<&Materials>,
    parts: (&Drives, Option<&Named<Support>>),
    motion: Option<PlatformMotion>,
) -> Option<Vec<CableEntry>> {
    let value = reader.required(root, "cables")?;
    let DeValue::Array(array) = value.get_ref() else {
        reader
            .wrong_type("`cables`", "an array of tables", value)
            .help("begin every cable with [[cables]], in double brackets");
        return None;
    };
    if array.is_empty() {
        reader.issue(value.span(), "there is no cable").help("begin every cable with [[cables]]");
        return None;
    }

    let mut names: BTreeMap<String, Range<usize>> = BTreeMap::new();
    let mut entries = Vec::with_capacity(array.len());
    for (i, value) in array.iter().enumerate() {
        let DeValue::Table(table) = value.get_ref() else {
            let label = format!("number {} of `cables`", i + 1);
            reader.wrong_type(&label, "a table", value).help("begin every cable with [[cables]]");
            continue;
        };
        let label = match table.get("name").map(toml::Spanned::get_ref) {
            Some(DeValue::String(name)) if !name.trim().is_empty() => {
                format!("cable \"{}\"", shortened(name))
            }
            _ => format!("[[cables]] number {}", i + 1),
        };
        let section = reader.open(label, value.span(), table, KEYS);
        entries.push(read_one(reader, &section, materials, parts, motion, &mut names));
    }

    (entries.len() == array.len()).then_some(entries)
}

fn read_one(
    reader: &mut Reader,
    section: &Section,
    materials: Option<&Materials>,
    (drives, supports): (&Drives, Option<&Named<Support>>),
    motion: Option<PlatformMotion>,
    names: &mut BTreeMap<String, Range<usize>>,
) -> CableEntry {
    let name = unique_name(reader, section, names);
    let material = reader.required(section, "material").and_then(|_| {
        // Without [materials] every cable would repeat an issue that has been reported once.
        reader.reference(section, "material", "materials", materials).flatten()
    });

    let support = reader.reference(section, "support", "supports", supports);
    // The cable is refused with its support.
    let anchor = drives::anchor(reader, section, drives).filter(|_| support.is_some());
    let attachment = attachment(reader, section, motion);

    let own_limits = limits::read(reader, section);
    if let (Some(own), Some(material)) = (own_limits, &material) {
        // Together with the rope's limits: each may be valid alone and both together not.
        limits::check(reader, section, own.or(material.tension_limits), material.breaking_load);
    }

    let own_load = section.get("load_n_per_m").map(|value| reader.vector(section, "load_n_per_m", value));
    let length_value = section.get("unstrained_length_m");
    let length = length_value.and_then(|value| reader.number_of(section, "unstrained_length_m", value));
    let load = own_load.map_or_else(|| material.as_ref().map(|m| m.load_per_length_w), |own| own.map(Vec3::from));

    let (shares, efficiency) = shared_rope(reader, section);

    let cable = name.zip(material).zip(anchor.zip(attachment)).zip(own_limits.zip(load)).map(
        |(((name, material), (anchor, attachment)), (tension_limits, load_per_length_w))| Cable {
            load_per_length_w,
            name,
            material,
            anchor,
            attachment_p: Vec3::from(attachment),
            tension_limits,
        },
    );

    CableEntry {
        cable,
        support: support.flatten().map(|support| support.name),
        shares,
        efficiency,
        support_span: section.get("support").map(toml::Spanned::span),
        label: section.label().to_owned(),
        header: section.span.clone(),
        anchor_span: section.get("anchor_m").map_or(section.span.clone(), toml::Spanned::span),
        length_span: length_value.map(toml::Spanned::span),
        length,
        length_mistyped: section.mistyped(&["unstrained_length_m"]),
    }
}

/// Reads the name of the cable whose rope a cable continues, with its place, and the efficiency of the sheave between
/// them.
fn shared_rope(reader: &mut Reader, section: &Section) -> (Option<(String, Range<usize>)>, f64) {
    let before = section.get("shares_rope_with");
    let shares = before.and_then(|value| Some((reader.text("shares_rope_with", value)?, value.span())));
    let given = section.get("sheave_efficiency");
    let efficiency = given.and_then(|value| reader.fraction(section, "sheave_efficiency", value));
    if let (None, Some(value)) = (before, given) {
        reader
            .issue(value.span(), "`sheave_efficiency` is that of a sheave between two cables of one rope")
            .help("add `shares_rope_with`, or remove the line; a pulley at the anchor has its own `efficiency`");
    }
    (shares, efficiency.unwrap_or(1.0))
}

/// Reads the name of a cable, which none of the cables before it has; `names` are their names with their places.
fn unique_name(reader: &mut Reader, section: &Section, names: &mut BTreeMap<String, Range<usize>>) -> Option<String> {
    let value = reader.required(section, "name")?;
    let name = reader.name("name", value)?;
    if let Some(first) = names.get(&name) {
        reader
            .issue(value.span(), format!("two cables are called \"{}\"", shortened(&name)))
            .context(first.clone(), "the first is here")
            .help("results are listed by name: give every cable its own");
        return None;
    }
    names.insert(name.clone(), value.span());
    Some(name)
}

/// Reads the attachment; it is the origin for a point mass.
fn attachment(reader: &mut Reader, section: &Section, motion: Option<PlatformMotion>) -> Option<[f64; 3]> {
    let value = match motion {
        Some(PlatformMotion::Rigid | PlatformMotion::Planar(_)) => reader.required(section, "attachment_m")?,
        _ => match section.get("attachment_m") {
            Some(value) => value,
            None => return Some([0.0; 3]),
        },
    };
    let attachment = reader.vector(section, "attachment_m", value)?;
    if motion == Some(PlatformMotion::PointMass) && !is_zero(&attachment) {
        reader
            .issue(value.span(), "all cables of a point mass end in one point, `attachment_m` must be zero or absent")
            .help("remove the line, or set `motion = \"rigid\"` in [platform]");
        return None;
    }
    Some(attachment)
}

/// Unstrained lengths of all cables [m], or an empty list if no cable has one.
pub(super) fn lengths(reader: &mut Reader, cables: &[CableEntry]) -> Option<Vec<f64>> {
    let Some(first) = cables.iter().find_map(|cable| cable.length_span.clone()) else {
        return (!cables.iter().any(|cable| cable.length_mistyped)).then(Vec::new);
    };
    let without: Vec<_> = cables.iter().filter(|c| c.length_span.is_none() && !c.length_mistyped).collect();
    if let Some(cable) = without.first() {
        let others = match without.len() {
            1 => String::new(),
            n => format!(", like {} other{}", n - 1, if n == 2 { "" } else { "s" }),
        };
        reader
            .issue(cable.header.clone(), format!("{} has no `unstrained_length_m`{others}", cable.label))
            .context(first, "but a length is given here")
            .help("give every cable a length, or none");
        return None;
    }
    cables.iter().map(|cable| cable.length).collect()
}

/// Refuses a cable with coinciding ends: it has no direction.
pub(super) fn refuse_coincident_ends(reader: &mut Reader, cables: &[CableEntry], pose: &Pose) {
    for entry in cables {
        let Some(cable) = &entry.cable else { continue };
        let chord = cable.chord_w(pose).norm();
        if let Some(pulley) = &cable.anchor.pulley {
            let distance = pulley.distance_from_center(&(pose.point_w(&cable.attachment_p) - cable.anchor.point_w));
            if distance < pulley.radius {
                let message = format!(
                    "{} ends inside the wheel of its pulley at this pose: {distance:.4} m from the wheel's centre, the \
                     radius is {} m",
                    entry.label, pulley.radius
                );
                reader.issue(entry.anchor_span.clone(), message).help(
                    "check `radius_m` in [pulleys.NAME]; or move the anchor, the attachment or `position_m` in [state]",
                );
                continue;
            }
        }
        let size = cable.anchor.reference_w().norm() + pose.position_w.norm() + cable.attachment_p.norm();
        if chord <= COINCIDENT * size {
            reader
                .issue(
                    entry.anchor_span.clone(),
                    format!("{} has no length: both ends are here at this pose", entry.label),
                )
                .help("move the anchor, the attachment or `position_m` in [state]");
        }
    }
}
