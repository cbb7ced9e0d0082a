//! `[supports.NAME]`: flexible supports that the anchors of cables refer to.

use super::key::{Absent, Key, KeyValue, Shape};
use super::range::Range;
use super::read::{Named, Reader, Section, Value};
use super::tensor;
use crate::math::Mat3;
use crate::robot::support::{DrumPlace, Support};
use std::collections::BTreeMap;
use toml::de::DeValue;

/// Damping ratio that must not be reached: a structure has 0.005 to 0.05.
const DAMPING_LIMIT: f64 = 1.0;

/// Keys of `[supports.NAME]`.
pub(super) const SUPPORT: &[Key] = &[
    Key::numeric(
        Shape::Tensor,
        "stiffness_n_per_m",
        "stiffness_n_per_m = [2e6, 2e6, 5e7]",
        "N/m",
        Range::Any,
        "stiffness against a displacement of its anchors, world axes: one number for all directions, three along x, y \
         and z, or three rows of three numbers",
    ),
    Key::numeric(
        Shape::Number,
        "mass_kg",
        "mass_kg = 40",
        "kg",
        Range::NotNegative,
        "mass that moves with its anchors: for a post about a quarter of its mass",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Number,
        "damping_ratio",
        "damping_ratio = 0.01",
        "1",
        Range::Below(DAMPING_LIMIT),
        "damping ratio of the support alone",
    )
    .or([0.0; 3]),
    Key::other(
        "drums",
        r#"drums = "on-support""#,
        KeyValue::Word(DrumPlace::WORDS),
        "place of the drums of its cables with a pulley and a drum side",
    )
    .without(Absent::DefaultWord("on-support")),
];

/// Reads all supports. `None` if the table as a whole was refused.
pub(super) fn read(reader: &mut Reader, root: &Section) -> Option<Named<Support>> {
    match root.get("supports") {
        Some(value) => reader.named_tables("supports", "support", value, SUPPORT, read_one),
        None => Some(BTreeMap::new()),
    }
}

fn read_one(reader: &mut Reader, name: &str, section: &Section) -> Option<Support> {
    let stiffness = reader.required(section, "stiffness_n_per_m").and_then(|value| stiffness(reader, value));
    let mass = reader.number_or_default(section, "mass_kg");
    let help = "it is a fraction of the critical damping, not per cent: structures have 0.005 to 0.05";
    let damping_ratio = match section.get("damping_ratio") {
        Some(value) => Some(reader.number_up_to_limit(section, "damping_ratio", value, help)?),
        None => Some(section.default("damping_ratio")[0]),
    };
    let drum = match reader.word(section, "drums")? {
        "on-ground" => DrumPlace::OnGround,
        _ => DrumPlace::OnSupport,
    };
    Some(Support { name: name.to_owned(), stiffness_w: stiffness?, mass: mass?, damping_ratio: damping_ratio?, drum })
}

/// Reads the stiffness, which must resist every displacement.
fn stiffness(reader: &mut Reader, value: &Value) -> Option<Mat3> {
    let key = "stiffness_n_per_m";
    if !matches!(value.get_ref(), DeValue::Array(_)) {
        return Some(Mat3::identity() * reader.number(&format!("`{key}`"), Range::Positive, value)?);
    }
    let tensor = tensor::read(reader, key, "N/m", value)?;
    let mut principal: [f64; 3] = tensor.symmetric_eigenvalues().into();
    principal.sort_by(f64::total_cmp);
    // Below 1e-12 of the largest value, the sign of the smallest is rounding.
    if principal[0] <= 1e-12 * principal[2].abs().max(1.0) {
        let [a, b, c] = principal.map(tensor::short);
        reader
            .issue(
                value.span(),
                format!("`{key}` is not positive definite: its principal values are {a}, {b} and {c} N/m"),
            )
            .help("a support has to resist displacements in all directions; a rigid direction has a large number");
        return None;
    }
    Some(tensor)
}
