//! Page about the winches that a robot needs: the winch that serves every cable, what asks for its numbers, that of
//! each cable, and the winches on offer.

use super::Shell;
use super::table::{PageTable, fixed, significant};
use crate::figures::{Size, of_winches};
use anyhow::Context as _;
use askama::Template;
use funicular_study::analyses::winches::{AskedRow, OfferRow, WinchRow, Winches};
use funicular_study::request::OfferedWinch;
use funicular_study::text::{NONE, with_unit};

const CONTENTS: &[(&str, &str)] = &[("needs", "Needs"), ("asked", "What asks for them"), ("repeat", "How to repeat")];
const WITH_OFFERS: &[(&str, &str)] =
    &[("needs", "Needs"), ("asked", "What asks for them"), ("offers", "Offers"), ("repeat", "How to repeat")];

/// Width of the figure on the page [mm].
const WIDTH_MM: f64 = 150.0;

#[derive(Template)]
#[template(path = "winches.html")]
struct WinchesPage<'a> {
    shell: Shell,
    found: &'a Winches,
    summary: String,
    bars: String,
    needs: PageTable,
    asked: PageTable,
    offers: Option<PageTable>,
    command_line: String,
}

/// Writes the page as HTML; `command_line` is the command that writes it again.
///
/// # Errors
/// A page that cannot be written.
pub fn page(found: &Winches, offered: &[OfferedWinch], command_line: String) -> anyhow::Result<String> {
    let offers = found.offers.as_ref().map(|rows| {
        let caption =
            "Winches on offer: the largest part that is needed of what each gives, above 1 for one too small.";
        PageTable::of("table-offers", caption, &OfferRow::columns(), rows)
    });
    let page = WinchesPage {
        shell: Shell::new(format!("{}: winches", found.robot), if offers.is_some() { WITH_OFFERS } else { CONTENTS }),
        found,
        summary: format!("{}. {} of {} poses hold every required load.", found.sentence(), found.held, found.poses),
        bars: of_winches(found, offered).svg(Size::of_page(WIDTH_MM)),
        needs: PageTable::of(
            "table-needs",
            "Winch that serves every cable, and the winch of each cable.",
            &WinchRow::columns(),
            &found.winches,
        ),
        asked: asked(&found.asked),
        offers,
        command_line,
    };
    page.render().context("the page could not be written as HTML")
}

/// Pose, load and velocity that ask for each number.
fn asked(rows: &[AskedRow]) -> PageTable {
    let caption = "Pose, required load in addition to the dead load, and velocity that ask for each number.";
    let is_any = |vector: [f64; 3]| vector.iter().any(|component| component.abs() > 0.0);
    let turns = rows.iter().any(|row| is_any(row.pose.roll_pitch_yaw_deg));
    let turning = rows.iter().filter_map(|row| row.angular_velocity_rad_s).any(is_any);
    let mut columns = vec!["<largest", "value", "<cable", "at|m"];
    columns.extend(turns.then_some("roll, pitch, yaw|°"));
    columns.extend(["force|N", "moment|N m", "velocity|m/s"]);
    columns.extend(turning.then_some("angular velocity|rad/s"));
    let mut table = PageTable::new("table-asked", caption, &columns);
    let three = |of: &[f64; 3], decimals: usize| of.map(|value| fixed(value, decimals)).join(", ");
    for row in rows {
        let moving = |of: &Option<[f64; 3]>| of.as_ref().map_or_else(|| NONE.to_owned(), |of| three(of, 2));
        let mut cells = vec![
            row.quantity.to_owned(),
            with_unit(&significant(row.value, 4), row.unit),
            row.cable.clone(),
            three(&row.pose.position_m, 2),
        ];
        cells.extend(turns.then(|| three(&row.pose.roll_pitch_yaw_deg, 1)));
        cells.extend([three(&row.force_n, 1), three(&row.moment_n_m, 1), moving(&row.velocity_m_s)]);
        cells.extend(turning.then(|| moving(&row.angular_velocity_rad_s)));
        table.row(cells);
    }
    table
}
