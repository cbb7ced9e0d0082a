//! `[pulleys.NAME]`: pulleys that cables refer to, and the anchor made of pulley and winch.

use super::key::{Absent, Key, Shape};
use super::range::Range;
use super::read::{Named, Reader, Section, is_zero};
use super::winches::{self, WINCH};
use crate::math::Vec3;
use crate::robot::{Anchor, Pulley, Winch};

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
        "direction in which the cable travels at its anchor towards the platform, and axis of the swivel, world axes; of \
         any length",
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
];

/// Pulley of a file. Its direction may be left to the cables.
#[derive(Debug, Clone)]
pub(super) struct PulleyEntry {
    name: String,
    radius: f64,
    entry_direction_w: Option<Vec3>,
    inertia: f64,
    swivel_inertia: f64,
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
    let winches = match root.get("winches") {
        Some(value) => reader.named_tables("winches", "winch", value, WINCH, winches::read),
        None => Some(Named::new()),
    };
    Drives { pulleys, winches }
}

fn read_pulley(reader: &mut Reader, name: &str, section: &Section) -> Option<PulleyEntry> {
    let radius = reader.required(section, "radius_m").and_then(|value| reader.number_of(section, "radius_m", value));
    let direction = direction(reader, section);
    let [inertia, swivel_inertia] =
        ["inertia_kg_m2", "swivel_inertia_kg_m2"].map(|key| reader.number_or_default(section, key));
    Some(PulleyEntry {
        name: name.to_owned(),
        radius: radius?,
        entry_direction_w: direction?,
        inertia: inertia?,
        swivel_inertia: swivel_inertia?,
    })
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
                    "give one of them the direction in which the cable comes to the wheel: `[0.0, 0.0, 1.0]` for a winch \
                     on the ground below",
                );
                return None;
            };
            let PulleyEntry { name, radius, inertia, swivel_inertia, .. } = pulley;
            Some(Pulley { name, radius, entry_direction_w, inertia, swivel_inertia })
        }
    };
    Some(Anchor { point_w: Vec3::from(point?), pulley, winch: winch? })
}
