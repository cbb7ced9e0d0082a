//! Page that reproduces every figure and table of H. Yuan, E. Courteille, D. Deblaise, ICRA 2014, beside the published
//! values.

mod fig7;
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

/// Robot of the paper with either cable set, and in the dynamic test.
const FILES: [(&str, &str); 3] = [
    ("robots/yuan2014-4mm.toml", funicular_robots::YUAN2014_4MM),
    ("robots/yuan2014-8mm.toml", funicular_robots::YUAN2014_8MM),
    ("robots/yuan2014-dynamic-test.toml", funicular_robots::YUAN2014_DYNAMIC_TEST),
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
    along_z: [PageFigure; 2],
    by_axis: [PageFigure; 2],
    thresholds: PageTable,
    moorpy: PageTable,
    parameters: PageTable,
    fits: PageTable,
    fit_sentences: [String; 2],
    test_figure: PageFigure,
    lists: Vec<PageTable>,
    counts: PageTable,
    chance_text: String,
    sag_text: String,
    command_line: String,
}

/// Writes the page as HTML; `command_line` is the command that writes it again.
///
/// # Errors
/// A computation that fails, which the tests exclude.
pub fn paper(command_line: String) -> anyhow::Result<String> {
    let [small, large, test] = robots()?;
    let sweeps = [pose::Sweep::of(&small), pose::Sweep::of(&large)];
    let outcome = fig7::outcome(&test).context(FILES[2].0)?;
    let fits = fig7::Fits::of([&test, &large])?;

    let page = PaperPage {
        shell: Shell::new("Yuan, Courteille and Deblaise 2014: published and computed".to_owned(), CONTENTS),
        cable_figure: single_cable::figure(),
        cable_numbers: single_cable::numbers(),
        cable_elements: single_cable::against_elements(),
        geometry: pose::geometry(&sweeps),
        ideal_poses: pose::ideal_poses(&sweeps),
        along_z: [0, 1].map(|set| pose::error_figure(&sweeps, set)),
        by_axis: [0, 1].map(|set| pose::axes_figure(&sweeps, set)),
        thresholds: pose::thresholds(&sweeps),
        moorpy: pose::against_moorpy(&sweeps),
        parameters: fig7::parameters(&outcome),
        fits: fits.table(),
        fit_sentences: fits.sentences(),
        test_figure: outcome.figure(),
        lists: fig7::lists(&outcome),
        counts: fig7::counts(&outcome),
        chance_text: fig7::chance_text(&outcome),
        sag_text: fig7::sag_text(&outcome),
        command_line,
    };

    page.render().context("the page could not be written as HTML")
}

fn robots() -> anyhow::Result<[Robot; 3]> {
    let read = |(name, text): (&str, &str)| Robot::from_toml(text).with_context(|| name.to_owned());
    Ok([read(FILES[0])?, read(FILES[1])?, read(FILES[2])?])
}
