//! Data of grids with two or more axes, from which the page's script draws slices, statuses and points.

use super::rows::{NOT_COMPUTED, Rows, label, with_unit};
use super::{axis_title, status};
use crate::pages::figure::colour;
use crate::pages::packed;
use askama::Template;
use funicular_study::sweep::CODES;
use serde_json::json;

/// Part of the page with a choice of quantity and slice.
#[derive(Template)]
#[template(path = "slices.html")]
pub(super) struct Slices {
    packed: String,
    /// Names of the quantities.
    quantities: Vec<String>,
    /// Pairs of axes that a slice can have, with their numbers.
    planes: Vec<(String, usize)>,
    /// Titles of the axes; the script hides the two axes of the slice.
    axes: Vec<String>,
    in_space: bool,
    points: usize,
}

impl Slices {
    /// Packs the data of rows on a grid.
    pub(super) fn new(rows: &Rows, is_sweep: bool) -> Self {
        let axes = &rows.axes;
        let title = |i: usize| axis_title(&axes[i].name, &axes[i].unit);

        // Pairs of axes, the pair with most cells first; within a pair in the order of the file.
        let mut pairs: Vec<(usize, usize)> =
            (0..axes.len()).flat_map(|i| (i + 1..axes.len()).map(move |j| (i, j))).collect();
        pairs.sort_by_key(|(i, j)| std::cmp::Reverse(axes[*i].kept() * axes[*j].kept()));

        let position = |name: &str| axes.iter().position(|axis| axis.name == name);
        let space = if is_sweep { None } else { position("x").zip(position("y")).zip(position("z")) };
        let space = space.map(|((x, y), z)| [x, y, z]);

        let header = json!({
            "axes": (0..axes.len()).map(|i| json!({
                "name": axes[i].name, "title": title(i), "unit": axes[i].unit, "values": axes[i].values(),
            })).collect::<Vec<_>>(),
            "pairs": pairs,
            "space": space,
            "quantities": rows.series.iter().map(|series| json!({
                "name": label(&series.name), "title": with_unit(&label(&series.name), &series.unit),
                "unit": series.unit,
                "count": series.count, "bins": series.bins.to_vec(),
                "min": if series.count > 0 { series.min.0 } else { 0.0 },
                "max": if series.count > 0 { series.max.0 } else { 0.0 },
            })).collect::<Vec<_>>(),
            "statuses": rows.counts.iter().map(|count| json!({
                "code": count.code, "name": status(count.code).0, "rows": count.rows, "colour": colour_of(count.code),
            })).collect::<Vec<_>>(),
            "feasible": CODES
                .iter()
                .filter(|code| !code.1.starts_with("infeasible"))
                .map(|code| code.0)
                .collect::<Vec<_>>(),
        });

        // Format: length of the header, the header, the status of every cell, then all values of one quantity after
        // another.
        let header = header.to_string();
        let mut bytes = u32::try_from(header.len()).unwrap_or(u32::MAX).to_le_bytes().to_vec();
        bytes.extend(header.as_bytes());
        bytes.extend(&rows.status);
        // Seven digits (single precision) are more than a figure shows.
        bytes.extend(
            rows.series.iter().flat_map(|series| &series.values).flat_map(|value| (*value as f32).to_le_bytes()),
        );

        Self {
            packed: packed(&bytes),
            quantities: rows.series.iter().map(|series| label(&series.name)).collect(),
            planes: pairs
                .iter()
                .enumerate()
                .map(|(k, (i, j))| (format!("{}, {}", axes[*i].name, axes[*j].name), k))
                .collect(),
            axes: (0..axes.len()).map(title).collect(),
            in_space: space.is_some(),
            points: rows.status.iter().filter(|code| **code != NOT_COMPUTED).count(),
        }
    }
}

/// Colour of a status, equal on every page: light for feasible, strong for infeasible.
fn colour_of(code: u8) -> &'static str {
    match super::status(code).0 {
        "ok" => "#cfe8f7",
        "slack" => "#8fcdf0",
        "unstable" => "#a6dcc8",
        "no-frequency" => "#f5d9a0",
        "not-certified" => "#faecc9",
        "no-decay" => "#e8cfb8",
        "no-comparison" => "#e3d9ee",
        "unlimited" => "#d3efd0",
        "no-payload" => "#efd3dc",
        "no-derivative" => "#d9d9c3",
        "dead-load" => "#c9c4e8",
        "required-load" => "#cfe6df",
        "interference" => "#e8b4a0",
        "no-speed" => "#c4d8d8",
        "no-torque" => "#dcd3c4",
        "no-gusts" => "#d9d6ec",
        "negative-tension" => colour::VERMILION,
        "tension-limits" => colour::PURPLE,
        "not-found" => "#8b2f6b",
        "not-converged" => colour::BLACK,
        "singular" => colour::BLUE,
        "out-of-plane" => colour::GREEN,
        "coinciding-ends" => colour::ORANGE,
        "invalid-robot" => "#7a4b1e",
        _ => colour::GREY,
    }
}

/// Script that draws the slices.
pub(super) const SCRIPT: &str = include_str!("../../../templates/plot.js");

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_status_has_its_own_colour() {
        let colours: Vec<&str> = (0..CODES.len()).map(|code| colour_of(u8::try_from(code).unwrap())).collect();
        for (i, colour) in colours.iter().enumerate() {
            assert!(!colours[..i].contains(colour), "{}: {colour}", CODES[i].0);
        }
    }
}
