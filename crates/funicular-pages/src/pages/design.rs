//! Page about a design: poses before and after, moved points, gains of more room, course of the search.

use super::Shell;
use super::figure::{PageFigure, axis, colour, line, plain, points, with};
use super::table::{PageTable, fixed, significant};
use anyhow::Context as _;
use askama::Template;
use funicular_study::analyses::design::{ChosenValue, DemandRow, Designed};
use funicular_study::text::{titled, with_unit};
use serde_json::{Value, json};

const CONTENTS: &[(&str, &str)] =
    &[("poses", "Poses"), ("values", "Values"), ("search", "Search"), ("repeat", "How to repeat")];

#[derive(Template)]
#[template(path = "design.html")]
struct DesignPage<'a> {
    shell: Shell,
    found: &'a Designed,
    summary: String,
    poses_figure: PageFigure,
    poses: PageTable,
    demands: Option<PageTable>,
    points: Option<PageFigure>,
    room: PageFigure,
    values: PageTable,
    history: PageFigure,
    command_line: String,
}

/// Writes the page as HTML; `command_line` is the command that writes it again.
///
/// # Errors
/// A page that cannot be written.
pub fn page(found: &Designed, command_line: String) -> anyhow::Result<String> {
    let page = DesignPage {
        shell: Shell::new(format!("{}: design", found.robot), CONTENTS),
        found,
        summary: format!(
            "{} from {} to {}",
            found.goal_means,
            significant(found.before, 5),
            with_unit(&significant(found.after, 5), found.unit)
        ),
        poses_figure: poses_figure(found),
        poses: poses(found),
        demands: (!found.demands.is_empty()).then(|| demands(found)),
        points: moved_points(found),
        room: room(found),
        values: values(found),
        history: history(found),
        command_line,
    };
    page.render().context("the page could not be written as HTML")
}

/// Figure of the goal at every pose, before and after.
fn poses_figure(found: &Designed) -> PageFigure {
    let x: Vec<f64> = (1..=found.poses.len()).map(|pose| pose as f64).collect();
    let of = |value: fn(&funicular_study::analyses::design::DesignPose) -> f64| {
        found.poses.iter().map(value).collect::<Vec<f64>>()
    };
    let data = [
        points("before", &x, &of(|row| row.before), colour::ORANGE, "circle-open"),
        points("after", &x, &of(|row| row.after), colour::BLUE, "circle"),
    ];
    PageFigure::new(
        "figure-poses",
        340,
        format!(
            "{} at every pose, with the values of the file and with the chosen values.",
            capital(&found.goal_means)
        ),
        &data,
        json!({
            "xaxis": axis("pose", json!({"dtick": 1})),
            "yaxis": axis(&titled("goal", found.unit), json!({})),
        }),
    )
}

/// Text with a capital letter at its beginning.
fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn poses(found: &Designed) -> PageTable {
    let mut table = PageTable::new(
        "table-poses",
        "Goal at every pose. The share is the gain of the goal if this pose alone gains one.",
        &["pose", "x|m", "y|m", "z|m", "roll|°", "pitch|°", "yaw|°", "before", "after", "share"],
    );
    for (number, row) in (1..).zip(&found.poses) {
        let mut cells = vec![number.to_string()];
        cells.extend(row.position_m.iter().map(|value| fixed(*value, 3)));
        cells.extend(row.roll_pitch_yaw_deg.iter().map(|value| fixed(*value, 2)));
        cells.extend([significant(row.before, 5), significant(row.after, 5), fixed(row.share, 3)]);
        table.row(cells);
    }
    table
}

fn demands(found: &Designed) -> PageTable {
    let caption = "Demands, each at the pose where it is met least.";
    PageTable::of("table-demands", caption, &DemandRow::columns(), &found.demands)
}

/// Components x, y, z of a point of a cable that has changed: start and value.
struct MovedPoint {
    /// Path without the component.
    path: String,
    start: [Option<f64>; 3],
    value: [Option<f64>; 3],
}

/// Points of the cables among the values.
fn points_before_and_after(values: &[ChosenValue]) -> Vec<MovedPoint> {
    let mut found: Vec<MovedPoint> = Vec::new();
    for row in values {
        let Some((path, component)) = row.path.rsplit_once('.') else { continue };
        let is_point = path.ends_with(".attachment_m") || path.ends_with(".anchor_m");
        let Some(k) = ["x", "y", "z"].iter().position(|name| *name == component).filter(|_| is_point) else { continue };
        let at = found.iter().position(|point| point.path == path).unwrap_or_else(|| {
            found.push(MovedPoint { path: path.to_owned(), start: [None; 3], value: [None; 3] });
            found.len() - 1
        });
        (found[at].start[k], found[at].value[k]) = (Some(row.start), Some(row.value));
    }
    found
}

/// Figure of the moves of points, from above and from the side; `None` if no point with x has moved.
fn moved_points(found: &Designed) -> Option<PageFigure> {
    let points_moved = points_before_and_after(&found.values);
    let full: Vec<&MovedPoint> = points_moved.iter().filter(|point| point.start.iter().all(Option::is_some)).collect();
    if full.is_empty() {
        return None;
    }

    let mut data: Vec<Value> = Vec::new();
    for (k, second) in [("x", "y"), ("x2", "y2")].into_iter().zip([1, 2]) {
        let axes = json!({"xaxis": k.0, "yaxis": k.1, "showlegend": second == 1});

        let of = |component: usize, start: bool| -> Vec<f64> {
            full.iter()
                .filter_map(|point| if start { point.start[component] } else { point.value[component] })
                .collect()
        };

        for point in &full {
            let ends = |component: usize| -> Vec<f64> {
                [point.start[component], point.value[component]].into_iter().flatten().collect()
            };
            let segment = line("", &ends(0), &ends(second), colour::GREY, "solid");
            data.push(with(with(segment, axes.clone()), json!({"showlegend": false, "hoverinfo": "skip"})));
        }

        let named = |values: Value, colour_of: &str| {
            let names: Vec<String> = full.iter().map(|point| plain(&point.path)).collect();
            with(with(values, axes.clone()), json!({"text": names, "marker": {"color": colour_of, "size": 7}}))
        };
        data.push(named(
            points("before", &of(0, true), &of(second, true), colour::ORANGE, "circle-open"),
            colour::ORANGE,
        ));
        data.push(named(points("after", &of(0, false), &of(second, false), colour::BLUE, "circle"), colour::BLUE));
    }

    Some(PageFigure::new(
        "figure-points",
        520,
        "Points of the cables before and after: from above (left) and from the side (right).".to_owned(),
        &data,
        json!({
            "xaxis": axis("x [m]", json!({"domain": [0.0, 0.46]})),
            "yaxis": axis("y [m]", json!({"scaleanchor": "x"})),
            "xaxis2": axis("x [m]", json!({"domain": [0.56, 1.0], "anchor": "y2"})),
            "yaxis2": axis("z [m]", json!({"anchor": "x2", "scaleanchor": "x2"})),
        }),
    ))
}

/// Figure of the gains of more room at the bounds.
fn room(found: &Designed) -> PageFigure {
    let mut rows: Vec<&ChosenValue> = found.values.iter().filter(|row| row.gain_per_unit > 0.0).collect();
    let gain = |row: &ChosenValue| row.gain_per_unit * 0.1 * (row.maximum - row.minimum);
    rows.sort_by(|a, b| gain(a).total_cmp(&gain(b)));
    let names: Vec<String> = rows.iter().map(|row| plain(&row.path)).collect();
    let gains: Vec<f64> = rows.iter().map(|row| gain(row)).collect();
    let data = [json!({
        "type": "bar", "orientation": "h", "x": gains, "y": names, "marker": {"color": colour::BLUE},
        "hovertemplate": "%{y}<br>%{x:.4g}<extra></extra>",
    })];
    PageFigure::new(
        "figure-room",
        120 + 22 * rows.len(),
        "Gain of the goal if the bound at which a value is moves outwards by a tenth of the distance of its bounds, by \
         the multipliers of the last linear problem."
            .to_owned(),
        &data,
        json!({
            "margin": {"l": 210},
            "xaxis": axis(&titled("gain", found.unit), json!({"exponentformat": "power"})),
        }),
    )
}

fn values(found: &Designed) -> PageTable {
    let caption =
        "Chosen values with their bounds. The gain is per unit of the value by which its bound moves outwards.";
    PageTable::of("table-values", caption, &ChosenValue::columns(), &found.values)
}

/// Figure of the goal after every iteration.
fn history(found: &Designed) -> PageFigure {
    let y: Vec<f64> = std::iter::once(found.before).chain(found.history.iter().copied()).collect();
    let x: Vec<f64> = (0..y.len()).map(|step| step as f64).collect();
    let course =
        with(line("goal", &x, &y, colour::BLUE, "solid"), json!({"mode": "lines+markers", "showlegend": false}));
    PageFigure::new(
        "figure-history",
        300,
        format!("Goal after every step that improved it; {} points were computed.", found.evaluations),
        &[course],
        json!({"xaxis": axis("step", json!({})), "yaxis": axis(&titled("goal", found.unit), json!({}))}),
    )
}
