//! Page that reproduces every figure and table of H. Yuan, E. Courteille, D. Deblaise, ICRA 2014, beside the published
//! values.

mod dynamic_test;
mod fit;
mod matching;
mod pose;
mod published;
mod single_cable;

use super::Shell;
use super::figure::PageFigure;
use super::table::PageTable;
use anyhow::Context as _;
use askama::Template;
use funicular::robot::Robot;

/// Robot of the paper with either cable set.
const FILES: [(&str, &str); 2] = [
    ("robots/yuan2014-4mm.toml", funicular_robots::YUAN2014_4MM),
    ("robots/yuan2014-8mm.toml", funicular_robots::YUAN2014_8MM),
];

pub(crate) const CONTENTS: &[(&str, &str)] = &[
    ("single-cable", "Fig. 2: one cable"),
    ("geometry", "Tables I and II: the robot"),
    ("pose-error", "Fig. 6: pose error"),
    ("dynamic-test", "Fig. 7 and Table III: dynamic test"),
    ("identifiability", "Conclusions"),
    ("repeat", "How to repeat"),
];

#[derive(Template)]
#[template(path = "paper.html")]
struct PaperPage {
    shell: Shell,
    cable_figure: PageFigure,
    cable_numbers: PageTable,
    cable_elements: PageTable,
    geometry: PageTable,
    ideal_poses: PageTable,
    distances: [PageFigure; 2],
    by_axis: [PageFigure; 2],
    thresholds: PageTable,
    moorpy: PageTable,
    parameters: PageTable,
    fits: PageTable,
    fit_sentences: [String; 2],
    test_figures: Vec<PageFigure>,
    lists: Vec<PageTable>,
    counts: PageTable,
    sag_text: String,
    command_line: String,
}

/// Writes the page as HTML; `command_line` is the command that writes it again.
///
/// # Errors
/// A computation that fails, which the tests exclude.
pub fn paper(command_line: String) -> anyhow::Result<String> {
    let [small, large] = robots()?;
    let sweeps = [pose::Sweep::of(&small), pose::Sweep::of(&large)];
    let outcomes = dynamic_test::outcomes([&small, &large])?;
    let fits = dynamic_test::Fits::of([&small, &large])?;

    let page = PaperPage {
        shell: Shell::new("Yuan, Courteille and Deblaise 2014: published and computed".to_owned(), CONTENTS),
        cable_figure: single_cable::figure(),
        cable_numbers: single_cable::numbers(),
        cable_elements: single_cable::against_elements(),
        geometry: pose::geometry(&sweeps),
        ideal_poses: pose::ideal_poses(&sweeps),
        distances: [0, 1].map(|set| pose::distance_figure(&sweeps, set)),
        by_axis: [0, 1].map(|set| pose::axes_figure(&sweeps, set)),
        thresholds: pose::thresholds(&sweeps),
        moorpy: pose::against_moorpy(&sweeps),
        parameters: dynamic_test::parameters(&outcomes),
        fits: fits.table(),
        fit_sentences: fits.sentences(),
        test_figures: outcomes.iter().map(dynamic_test::Outcome::figure).collect(),
        lists: dynamic_test::lists(&outcomes),
        counts: dynamic_test::counts(&outcomes),
        sag_text: dynamic_test::sag_text(&outcomes),
        command_line,
    };

    page.render().context("the page could not be written as HTML")
}

fn robots() -> anyhow::Result<[Robot; 2]> {
    let read = |(name, text): (&str, &str)| Robot::from_toml(text).with_context(|| name.to_owned());
    Ok([read(FILES[0])?, read(FILES[1])?])
}
