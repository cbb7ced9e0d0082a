//! Fields that the tables of several commands share.

use super::shared::LimitNumbers;
pub(crate) use super::shared::{ANGLES, AXES};
use crate::columns::{Field, column, parts};

/// Name of the cable of a row.
pub(crate) fn cable_name<R>(name: impl Fn(&R) -> String + 'static) -> Field<R> {
    column("name", "", "name of the cable", name).plain("cable")
}

/// Tensions at the platform and at the anchor [N].
pub(crate) fn tensions<R>(of: impl Fn(&R) -> [f64; 2] + Copy + 'static) -> [Field<R>; 2] {
    [
        column("tension_platform_n", "N", "tension at the platform", move |row| of(row)[0]).decimals("T platform", 3),
        column("tension_anchor_n", "N", "tension at the anchor", move |row| of(row)[1]).decimals("T anchor", 3),
    ]
}

/// Limits of a tension, its distance from them, and the limit that it has reached; empty for a row without limits.
pub(crate) fn limits<R>(of: impl Fn(&R) -> Option<&LimitNumbers> + Copy + 'static) -> [Field<R>; 3] {
    [
        parts("{}_tension_n", ["minimum", "maximum"], "N", "{} tension that is allowed", move |row| {
            of(row).map_or([None; 2], |limits| [Some(limits.minimum_tension_n), limits.maximum_tension_n])
        })
        .shown("limits", "N", move |row, style| of(row).map_or_else(String::new, |limits| limits.range(style))),
        column("tension_margin_n", "N", "distance of the tension from the nearer limit", move |row| {
            of(row).map(|limits| limits.tension_margin_n)
        })
        .shown("margin", "N", move |row, style| of(row).map_or_else(String::new, |limits| limits.margin(style))),
        column("limit_reached", "", "limit that the tension has reached", move |row| {
            of(row).and_then(|limits| limits.limit_reached)
        }),
    ]
}

/// Position of the platform origin [m], and roll, pitch, yaw [degrees]; empty for a row without them.
pub(crate) fn pose<R>(
    position_m: impl Fn(&R) -> Option<[f64; 3]> + 'static,
    roll_pitch_yaw_deg: impl Fn(&R) -> Option<[f64; 3]> + 'static,
) -> [Field<R>; 2] {
    let parts_of = |three: Option<[f64; 3]>| three.map_or([None; 3], |three| three.map(Some));
    [
        parts("{}_m", AXES, "m", "position of the platform origin, {}", move |row| parts_of(position_m(row))),
        parts("{}_deg", ANGLES, "deg", "{} of the platform", move |row| parts_of(roll_pitch_yaw_deg(row))),
    ]
}

/// Ends of the interval that holds something with 95 %, with the digits of its value; empty for a row without it.
pub(crate) fn interval_95<R>(
    of: impl Fn(&R) -> Option<[f64; 2]> + Copy + 'static,
    digits: impl Fn(&R) -> usize + Copy + 'static,
    holds: &str,
) -> [Field<R>; 2] {
    let end = move |row: &R, k: usize| of(row).map(|interval| interval[k]);
    let about = [format!("lower end of the interval that holds {holds}"), "upper end of this interval".to_owned()];
    let [lower, upper] = about;
    [
        column("interval_95_from", "", lower, move |row| end(row, 0))
            .shown("95 % from", "", move |row, style| style.significant(end(row, 0), digits(row))),
        column("interval_95_to", "", upper, move |row| end(row, 1))
            .shown("to", "", move |row, style| style.significant(end(row, 1), digits(row))),
    ]
}
