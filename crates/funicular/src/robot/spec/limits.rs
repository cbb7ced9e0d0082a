//! Tension limits, which a rope and a cable may both have.

use super::read::{Reader, Section};
use crate::robot::TensionLimits;

/// Reads the limits of a table; either may be absent.
pub(super) fn read(reader: &mut Reader, section: &Section) -> Option<TensionLimits> {
    let minimum = optional(reader, section, "minimum_tension_n");
    let maximum = optional(reader, section, "maximum_tension_n");
    Some(TensionLimits { minimum: minimum?, maximum: maximum? })
}

/// Reads the breaking load, which may be absent.
#[expect(clippy::option_option, reason = "outside: refused, an issue is reported; inside: not given")]
pub(super) fn breaking_load(reader: &mut Reader, section: &Section) -> Option<Option<f64>> {
    optional(reader, section, "breaking_load_n")
}

/// Reads a number that may be absent.
#[expect(clippy::option_option, reason = "outside: refused, an issue is reported; inside: not given")]
pub(super) fn optional(reader: &mut Reader, section: &Section, key: &str) -> Option<Option<f64>> {
    match section.get(key) {
        Some(value) => reader.number_of(section, key, value).map(Some),
        None => Some(None),
    }
}

/// Refuses a minimum that is not below the maximum, and limits above the breaking load. The issue points at a value of
/// this table; an issue of the rope's own limits is reported at the rope only.
pub(super) fn check(reader: &mut Reader, section: &Section, limits: TensionLimits, breaking_load: Option<f64>) {
    let span_of = |key: &str| section.get(key).map(toml::Spanned::span);
    let (minimum_span, maximum_span) = (span_of("minimum_tension_n"), span_of("maximum_tension_n"));

    if let (Some(minimum), Some(maximum)) = (limits.minimum, limits.maximum)
        && minimum >= maximum
    {
        if let Some(span) = minimum_span.or(maximum_span) {
            let what = "it must be below `maximum_tension_n`, which is";
            reader
                .issue(span, format!("`minimum_tension_n` is {minimum}, {what} {maximum}"))
                .help("a cable has the limits of its material where it gives none of its own");
        }
        return;
    }

    let Some(breaking_load) = breaking_load else { return };
    let limits =
        [("minimum_tension_n", limits.minimum, minimum_span), ("maximum_tension_n", limits.maximum, maximum_span)];
    for (key, limit, span) in limits {
        if let (Some(limit), Some(span)) = (limit, span)
            && limit > breaking_load
        {
            let what = "it must not be above `breaking_load_n`, which is";
            reader
                .issue(span, format!("`{key}` is {limit}, {what} {breaking_load}"))
                .help("give the tension that may occur in use, a fifth to a third of what the rope breaks at");
            return;
        }
    }
}
