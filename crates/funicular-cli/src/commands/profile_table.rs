//! Table of profiles of χ², for `identify` and `calibrate`.

use crate::table::{NONE, Table, significant};
use funicular_study::analyses::identify::{OpenEnd, Profile};

/// Value with its profile.
pub(super) struct Profiled<'a> {
    pub(super) path: &'a str,
    pub(super) unit: &'a str,
    pub(super) value: f64,
    /// Number of digits of the value.
    pub(super) digits: usize,
    pub(super) profile: &'a Profile,
    /// Interval of the deviation, if χ² is a parabola.
    pub(super) parabola: Option<[f64; 2]>,
}

/// Table of the profiles; empty if there are none.
pub(super) fn profiles<'a>(rows: impl Iterator<Item = Profiled<'a>>) -> String {
    let profiled: Vec<Profiled> = rows.collect();
    if profiled.is_empty() {
        return String::new();
    }
    let mut table =
        Table::new(&["value", "unit", "identified", "profile 95 % from", "to", "below", "above", "deviations", ""])
            .text_columns(&[0, 1, 8]);

    for row in profiled {
        let ends = [row.profile.from, row.profile.to];
        let end = |k: usize| ends[k].map_or_else(|| NONE.to_owned(), |end| significant(end, row.digits));
        let away = |k: usize| ends[k].map_or_else(|| NONE.to_owned(), |end| significant((end - row.value).abs(), 3));
        let by_deviations = row.parabola.map_or_else(
            || NONE.to_owned(),
            |[low, high]| format!("{}, {}", significant(row.value - low, 3), significant(high - row.value, 3)),
        );
        let remark = [(row.profile.open_below, "below"), (row.profile.open_above, "above")].into_iter().filter_map(
            |(open, side)| {
                Some(match open? {
                    OpenEnd::Bound => format!("not limited {side} within its bound"),
                    OpenEnd::Flat => format!("not limited {side}"),
                    OpenEnd::NoEquilibrium => format!("no equilibrium {side}"),
                })
            },
        );
        table.row(vec![
            row.path.to_owned(),
            row.unit.to_owned(),
            significant(row.value, row.digits),
            end(0),
            end(1),
            away(0),
            away(1),
            by_deviations,
            remark.collect::<Vec<_>>().join(", "),
        ]);
    }

    format!("\n{table}\n")
}
