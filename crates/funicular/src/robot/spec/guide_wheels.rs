//! `[guide_wheels.NAME]`: guide wheels with inertia between winches and entry points. Each refers to its winch.

use super::key::{Key, KeyValue, Shape};
use super::range::Range;
use super::read::{Named, Reader, Section, Value};
use crate::robot::{GuideWheel, Winch};

/// Keys of `[guide_wheels.NAME]`.
pub(super) const GUIDE_WHEEL: &[Key] = &[
    Key::other(
        "winch",
        r#"winch = "drum""#,
        KeyValue::Name,
        "winch whose cables run over the wheel; every cable has a wheel of its own",
    ),
    Key::numeric(
        Shape::Number,
        "distance_m",
        "distance_m = 1.2",
        "m",
        Range::Positive,
        "length of the cable from its anchor back to the wheel, below the `drum_side_length_m` of the winch",
    ),
    Key::numeric(
        Shape::Number,
        "radius_m",
        "radius_m = 0.04",
        "m",
        Range::Positive,
        "radius of the wheel, from its axle to the centre line of the cable",
    ),
    Key::numeric(
        Shape::Number,
        "inertia_kg_m2",
        "inertia_kg_m2 = 0.0002",
        "kg m²",
        Range::NotNegative,
        "moment of inertia of the wheel about its axle",
    ),
];

/// Guide wheel of a file, with the name of its winch and the place of its distance in the text.
#[derive(Debug, Clone)]
struct GuideWheelEntry {
    wheel: GuideWheel,
    winch: String,
    distance_at: std::ops::Range<usize>,
}

/// Reads all guide wheels and adds them to their winches; `winches` is `None` if these tables as a whole were refused.
pub(super) fn read(reader: &mut Reader, value: &Value, winches: &mut Option<Named<Winch>>) {
    let read_one =
        |reader: &mut Reader, name: &str, section: &Section| read_wheel(reader, name, section, winches.as_ref());
    let Some(wheels) = reader.named_tables("guide_wheels", "guide wheel", value, GUIDE_WHEEL, read_one) else { return };

    // The nearest to the entry point first.
    let mut wheels: Vec<GuideWheelEntry> = wheels.into_values().flatten().collect();
    wheels.sort_by(|a, b| a.wheel.distance.total_cmp(&b.wheel.distance));
    for GuideWheelEntry { wheel, winch, distance_at } in wheels {
        let Some(Some(winch)) = winches.as_mut().and_then(|winches| winches.get_mut(&winch)) else { continue };
        if let Some(other) = winch.guide_wheels.last().filter(|other| other.distance >= wheel.distance) {
            let written = reader.written(distance_at.clone());
            reader
                .issue(
                    distance_at,
                    format!(
                        "`distance_m` is {written}, where winch \"{}\" has the wheel \"{}\" already",
                        winch.name, other.name
                    ),
                )
                .help("give the wheels of a winch different distances, or add their inertias");
            continue;
        }
        winch.guide_wheels.push(wheel);
    }
}

/// Reads a guide wheel and checks that it lies on the drum side of its winch.
fn read_wheel(
    reader: &mut Reader,
    name: &str,
    section: &Section,
    winches: Option<&Named<Winch>>,
) -> Option<GuideWheelEntry> {
    // All values, so that each is checked even where another is wrong.
    let mut number = |key: &str| reader.required(section, key).and_then(|value| reader.number_of(section, key, value));
    let [distance, radius, inertia] = ["distance_m", "radius_m", "inertia_kg_m2"].map(&mut number);
    let winch = reader.required(section, "winch").and_then(|_| reader.reference(section, "winch", "winches", winches));

    let (winch, distance) = (winch??, distance?);
    let distance_at = section.get("distance_m").map_or(section.span.clone(), toml::Spanned::span);
    if distance >= winch.drum_side_length {
        let written = reader.written(distance_at.clone());
        let message = format!(
            "`distance_m` is {written}, it must be below the `drum_side_length_m` of winch \"{}\", which is {}",
            winch.name, winch.drum_side_length
        );
        reader.issue(distance_at, message).help(
            "the distance counts along the cable from its anchor, the length of the drum side from the anchor to the \
             drum",
        );
        return None;
    }
    let mass = inertia? / radius?.powi(2);
    let wheel = GuideWheel { name: name.to_owned(), distance, mass };
    Some(GuideWheelEntry { wheel, winch: winch.name, distance_at })
}
