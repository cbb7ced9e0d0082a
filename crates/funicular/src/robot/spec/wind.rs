//! Keys of `[wind]`: the mean wind and its turbulence.

use super::key::{Absent, Key, KeyValue, Shape};
use super::range::Range;
use super::read::{Reader, Section};
use crate::math::Vec3;
use crate::robot::{Turbulence, TurbulenceSpectrum, Wind};

/// Keys of `[wind]`.
pub(super) const KEYS: &[Key] = &[
    Key::numeric(
        Shape::Vector,
        "velocity_m_s",
        "velocity_m_s = [8.0, 0.0, 0.0]",
        "m/s",
        Range::Magnitude(Wind::MAX_SPEED),
        "velocity of the air, world axes",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Number,
        "air_density_kg_m3",
        "air_density_kg_m3 = 1.225",
        "kg/m³",
        Range::Positive,
        "density of the air",
    )
    .or([Wind::AIR_DENSITY; 3]),
    Key::other(
        "turbulence",
        r#"turbulence = "kaimal""#,
        KeyValue::Word(TURBULENCE),
        "spectrum of the gusts, for `gust`",
    )
    .without(Absent::DefaultWord(NO_TURBULENCE)),
    Key::numeric(
        Shape::Vector,
        "intensity",
        "intensity = [0.15, 0.12, 0.075]",
        "1",
        Range::Below(Turbulence::MAX_INTENSITY),
        "standard deviation of the gusts along the mean wind, lateral and up, over the mean speed",
    )
    .without(Absent::Depends("required with `turbulence`, else refused")),
    Key::numeric(
        Shape::Vector,
        "length_scale_m",
        "length_scale_m = [85.0, 28.0, 6.9]",
        "m",
        Range::Positive,
        "length scales of the gusts along, lateral and up, each in the direction of the mean wind",
    )
    .without(Absent::Depends("required with `turbulence`, else refused")),
    Key::numeric(
        Shape::Vector,
        "coherence_decay",
        "coherence_decay = [0.0, 10.0, 10.0]",
        "1",
        Range::NotNegative,
        "decay of the coherence with the distance along the mean wind, lateral and up",
    )
    .or(Turbulence::COHERENCE_DECAY),
    Key::other(
        "frozen_turbulence",
        r#"frozen_turbulence = "yes""#,
        KeyValue::Word(FROZEN),
        "whether gusts travel with the mean wind",
    )
    .without(Absent::DefaultWord("yes")),
];

/// Word of a wind without turbulence.
const NO_TURBULENCE: &str = "none";

/// Values of `turbulence`, with their meanings.
const TURBULENCE: &[(&str, &str)] =
    &[(NO_TURBULENCE, "steady wind"), TurbulenceSpectrum::WORDS[0], TurbulenceSpectrum::WORDS[1]];

/// Values of `frozen_turbulence`, with their meanings.
const FROZEN: &[(&str, &str)] =
    &[("yes", "a place downstream meets the same gust later"), ("no", "all places along the wind meet it at once")];

/// Reads `[wind]`: the mean wind, and the turbulence about it. The outer `None` of each is a refused one.
#[expect(clippy::option_option, reason = "outside: refused, an issue is reported; inside: no turbulence")]
pub(super) fn read(reader: &mut Reader, root: &Section) -> (Option<Wind>, Option<Option<Turbulence>>) {
    let Some(value) = root.get("wind") else { return (Some(Wind::default()), Some(None)) };
    let Some(table) = reader.table("wind", "[wind]", value) else { return (None, None) };
    let section = reader.open("[wind]", value.span(), table, KEYS);
    let wind = read_mean_wind(reader, &section);
    let turbulence = read_turbulence(reader, &section, wind.as_ref());
    (wind, turbulence)
}

/// Reads velocity and density of `[wind]`.
fn read_mean_wind(reader: &mut Reader, section: &Section) -> Option<Wind> {
    let velocity = reader.vector_or_default(section, "velocity_m_s");
    if let (Some(velocity), Some(value)) = (velocity, section.get("velocity_m_s")) {
        let speed = Vec3::from(velocity).norm();
        if speed > Wind::MAX_SPEED {
            reader
                .issue(
                    value.span(),
                    format!("`velocity_m_s` is a wind of {speed} m/s, it must be at most {} m/s", Wind::MAX_SPEED),
                )
                .help("faster air is compressed, and drag no longer grows with its square");
            return None;
        }
    }

    let air_density = reader.number_or_default(section, "air_density_kg_m3");
    Some(Wind { velocity_w: Vec3::from(velocity?), air_density: air_density? })
}

/// Keys of `[wind]` that belong to its turbulence.
const OF_TURBULENCE: [&str; 4] = ["intensity", "length_scale_m", "coherence_decay", "frozen_turbulence"];

/// Reads the turbulence of `[wind]`; the outer `None` is a refused one, the inner one a steady wind.
#[expect(clippy::option_option, reason = "outside: refused, an issue is reported; inside: no turbulence")]
fn read_turbulence(reader: &mut Reader, section: &Section, mean: Option<&Wind>) -> Option<Option<Turbulence>> {
    let word = reader.word(section, "turbulence")?;
    let Some(spectrum) = TurbulenceSpectrum::of_word(word) else {
        if let Some((key, value)) = OF_TURBULENCE.iter().find_map(|key| Some((key, section.get(key)?))) {
            reader
                .issue(value.span(), format!("`{key}` belongs to a wind with turbulence, and this one has none"))
                .help("add `turbulence = \"kaimal\"` or `turbulence = \"von-karman\"`, or leave the key out");
            return None;
        }
        return Some(None);
    };
    if mean.is_some_and(|wind| wind.velocity_w == Vec3::zeros()) {
        let span = section.get("turbulence").map_or(section.span.clone(), toml::Spanned::span);
        reader
            .issue(span, "`turbulence` is given without a mean wind: gusts have no direction and no length in time")
            .help("add `velocity_m_s`, the mean wind; intensity times its speed is the size of the gusts");
        return None;
    }

    let intensity = read_intensity(reader, section);
    let length_scale =
        reader.required(section, "length_scale_m").and_then(|value| reader.vector(section, "length_scale_m", value));
    let coherence_decay = reader.vector_or_default(section, "coherence_decay");
    let is_frozen = reader.word(section, "frozen_turbulence").map(|word| word == "yes");
    Some(Some(Turbulence {
        spectrum,
        intensity: intensity?,
        length_scale: length_scale?,
        coherence_decay: coherence_decay?,
        is_frozen: is_frozen?,
        measured: None,
    }))
}

/// Reads the intensities, which are fractions.
fn read_intensity(reader: &mut Reader, section: &Section) -> Option<[f64; 3]> {
    let value = reader.required(section, "intensity")?;
    let intensity = reader.vector(section, "intensity", value)?;
    let Some(most) = intensity.iter().find(|part| **part >= Turbulence::MAX_INTENSITY) else { return Some(intensity) };
    reader
        .issue(value.span(), format!("`intensity` has {most}, it must be below {}", Turbulence::MAX_INTENSITY))
        .help("it is a fraction of the mean speed, not per cent: 15 % is 0.15");
    None
}
