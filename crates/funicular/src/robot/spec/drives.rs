//! `[pulleys.NAME]`: pulleys that cables refer to, and the anchor made of pulley, winch and guide wheels.

use super::guide_wheels;
use super::key::{Absent, Key, Shape};
use super::range::Range;
use super::read::{Named, Reader, Section, Value, is_zero};
use super::winches::{self, WINCH};
use crate::math::Vec3;
use crate::robot::{Anchor, Pulley, PulleyFriction, Winch};

/// Coefficient of friction that must not be reached. Ropes in grooves have 0.1 to 0.5, rubber on steel has about 1; a
/// value from 2 on is likely one in per cent.
const FRICTION_LIMIT: f64 = 2.0;

/// Keys of `[pulleys.NAME]`.
pub(super) const PULLEY: &[Key] = &[
    Key::numeric(
        Shape::Number,
        "radius_m",
        "radius_m = 0.05",
        "m",
        Range::Positive,
        "radius of the wheel, from its axle to the centre line of the cable",
    ),
    Key::numeric(
        Shape::Vector,
        "entry_direction",
        "entry_direction = [0.0, 0.0, 1.0]",
        "1",
        Range::Any,
        "direction in which the cable travels at its anchor towards the platform, and axis of the swivel, world axes; \
         of any length",
    )
    .without(Absent::Depends("required here, or for every cable over this pulley")),
    Key::numeric(
        Shape::Number,
        "inertia_kg_m2",
        "inertia_kg_m2 = 0.0002",
        "kg m²",
        Range::NotNegative,
        "moment of inertia of the wheel about its axle",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Number,
        "swivel_inertia_kg_m2",
        "swivel_inertia_kg_m2 = 0.001",
        "kg m²",
        Range::NotNegative,
        "moment of inertia of all that swivels, wheel included, about the swivel axis",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Number,
        "friction_coefficient",
        "friction_coefficient = 0.15",
        "1",
        Range::Below(FRICTION_LIMIT),
        "coefficient of friction of a cable that slides: the wheel does not turn, or is a fixed bar",
    )
    .without(Absent::Means(OTHER_FRICTION)),
    Key::numeric(
        Shape::Number,
        "efficiency",
        "efficiency = 0.96",
        "1",
        Range::UpTo(1.0),
        "efficiency of a wheel that turns, from a catalogue: smaller over larger tension while the cable runs",
    )
    .without(Absent::Means(OTHER_FRICTION)),
    Key::numeric(
        Shape::Number,
        "bearing_friction_coefficient",
        "bearing_friction_coefficient = 0.002",
        "1",
        Range::Below(FRICTION_LIMIT),
        "coefficient of friction in the bearing of a wheel that turns",
    )
    .without(Absent::Means(OTHER_FRICTION)),
    Key::numeric(
        Shape::Number,
        "bearing_radius_m",
        "bearing_radius_m = 0.006",
        "m",
        Range::Positive,
        "radius at which the friction of the bearing acts; half the bore of a rolling bearing; it serves \
         `bearing_friction_coefficient` alone",
    )
    .without(Absent::Depends("required with `bearing_friction_coefficient`")),
];

/// Effect of a missing kind of friction.
const OTHER_FRICTION: &str =
    "another of `friction_coefficient`, `efficiency` and `bearing_friction_coefficient`, else no friction";

/// Pulley of a file. Its direction may be left to the cables.
#[derive(Debug, Clone)]
pub(super) struct PulleyEntry {
    name: String,
    radius: f64,
    entry_direction_w: Option<Vec3>,
    inertia: f64,
    swivel_inertia: f64,
    friction: Option<PulleyFriction>,
}

/// Pulleys and winches of a file; `None` if the tables as a whole were refused.
pub(super) struct Drives {
    pulleys: Option<Named<PulleyEntry>>,
    winches: Option<Named<Winch>>,
}

/// Reads all pulleys and winches.
pub(super) fn read(reader: &mut Reader, root: &Section) -> Drives {
    let pulleys = match root.get("pulleys") {
        Some(value) => reader.named_tables("pulleys", "pulley", value, PULLEY, read_pulley),
        None => Some(Named::new()),
    };
    let mut winches = match root.get("winches") {
        Some(value) => reader.named_tables("winches", "winch", value, WINCH, winches::read),
        None => Some(Named::new()),
    };
    if let Some(value) = root.get("guide_wheels") {
        guide_wheels::read(reader, value, &mut winches);
    }
    Drives { pulleys, winches }
}

fn read_pulley(reader: &mut Reader, name: &str, section: &Section) -> Option<PulleyEntry> {
    let radius = reader.required(section, "radius_m").and_then(|value| reader.number_of(section, "radius_m", value));
    let direction = direction(reader, section);
    let [inertia, swivel_inertia] =
        ["inertia_kg_m2", "swivel_inertia_kg_m2"].map(|key| reader.number_or_default(section, key));
    let friction = read_friction(reader, section, radius);
    Some(PulleyEntry {
        name: name.to_owned(),
        radius: radius?,
        entry_direction_w: direction?,
        inertia: inertia?,
        swivel_inertia: swivel_inertia?,
        friction: friction?,
    })
}

/// Friction of a pulley whose wheel has this radius [m], if the table gives one kind of it.
#[expect(clippy::option_option, reason = "outside: refused, an issue is reported; inside: not given")]
fn read_friction(reader: &mut Reader, section: &Section, wheel: Option<f64>) -> Option<Option<PulleyFriction>> {
    // Check every number, also one that is refused beside another.
    let keys = ["friction_coefficient", "efficiency", "bearing_friction_coefficient"];
    let mut number = |key: &str| section.get(key).map(|value| friction_number(reader, section, key, value));
    let [sliding, efficiency, bearing] = keys.map(&mut number);
    let radius = section.get("bearing_radius_m").map(|value| bearing_radius(reader, section, value, wheel));

    // Refuse two kinds.
    let mut given = keys.into_iter().filter_map(|key| section.get(key).map(|value| (key, value)));
    if let (Some((first, at_first)), Some((second, at_second))) = (given.next(), given.next()) {
        reader
            .issue(at_second.span(), format!("`{second}` does not go with `{first}`"))
            .context(at_first.span(), "already given here")
            .help(
                "give one of the three: the friction of a cable that slides, the efficiency of the wheel, or the \
                 friction of its bearing",
            );
        return None;
    }

    let friction = if let Some(coefficient) = sliding {
        Some(PulleyFriction::Sliding { coefficient: coefficient? })
    } else if let Some(efficiency) = efficiency {
        Some(PulleyFriction::Efficiency(efficiency?))
    } else if let Some(coefficient) = bearing {
        let Some(radius) = radius else {
            reader
                .issue(
                    section.span.clone(),
                    format!("{} has `bearing_friction_coefficient`, but no `bearing_radius_m`", section.label()),
                )
                .help("add it, for example `bearing_radius_m = 0.006`: half the bore of a rolling bearing");
            return None;
        };
        return Some(Some(PulleyFriction::Bearing { coefficient: coefficient?, radius: radius? }));
    } else {
        None
    };
    // The number is checked even where no friction refers to it.
    radius.map_or(Some(0.0), |radius| radius)?;
    Some(friction)
}

/// Coefficient or efficiency, within its range.
fn friction_number(reader: &mut Reader, section: &Section, key: &str, value: &Value) -> Option<f64> {
    reader.number_up_to_limit(section, key, value, "it is a fraction, not per cent")
}

/// Radius of a bearing [m], which lies inside the wheel.
fn bearing_radius(reader: &mut Reader, section: &Section, value: &Value, wheel: Option<f64>) -> Option<f64> {
    let radius = reader.number_of(section, "bearing_radius_m", value)?;
    if let Some(wheel) = wheel.filter(|wheel| radius >= *wheel) {
        let written = reader.written(value.span());
        reader
            .issue(value.span(), format!("`bearing_radius_m` is {written}, it must be below the `radius_m` {wheel}"))
            .help("it is half the bore of a rolling bearing");
        return None;
    }
    Some(radius)
}

/// Unit vector of `entry_direction`, if the table gives one.
#[expect(clippy::option_option, reason = "outside: refused, an issue is reported; inside: not given")]
fn direction(reader: &mut Reader, section: &Section) -> Option<Option<Vec3>> {
    let Some(value) = section.get("entry_direction") else { return Some(None) };
    let vector = reader.vector(section, "entry_direction", value)?;
    if is_zero(&vector) {
        reader.issue(value.span(), "`entry_direction` has no length").help("up is `[0.0, 0.0, 1.0]`");
        return None;
    }
    Some(Some(Vec3::from(vector).normalize()))
}

/// Anchor of a cable: its point, its pulley and its winch.
pub(super) fn anchor(reader: &mut Reader, cable: &Section, drives: &Drives) -> Option<Anchor> {
    let point = reader.required(cable, "anchor_m").and_then(|value| reader.vector(cable, "anchor_m", value));
    let pulley = reader.reference(cable, "pulley", "pulleys", drives.pulleys.as_ref());
    let winch = reader.reference(cable, "winch", "winches", drives.winches.as_ref());
    let own_direction = direction(reader, cable);

    let pulley = match (pulley?, own_direction?) {
        (None, None) => None,
        (None, Some(_)) => {
            let span = cable.get("entry_direction").map_or(cable.span.clone(), toml::Spanned::span);
            reader
                .issue(span, format!("{} has `entry_direction`, but no `pulley`", cable.label()))
                .help("add `pulley = \"NAME\"` and a table [pulleys.NAME], or remove the line");
            return None;
        }
        (Some(pulley), own) => {
            let Some(entry_direction_w) = own.or(pulley.entry_direction_w) else {
                let span = cable.get("pulley").map_or(cable.span.clone(), toml::Spanned::span);
                let message =
                    format!("neither {} nor [pulleys.{}] has an `entry_direction`", cable.label(), pulley.name);
                reader.issue(span, message).help(
                    "give one of them the direction in which the cable comes to the wheel: `[0.0, 0.0, 1.0]` for a \
                     winch on the ground below",
                );
                return None;
            };
            let PulleyEntry { name, radius, inertia, swivel_inertia, friction, .. } = pulley;
            Some(Pulley { name, radius, entry_direction_w, inertia, swivel_inertia, friction })
        }
    };
    Some(Anchor { point_w: Vec3::from(point?), pulley, winch: winch?, support: None })
}
