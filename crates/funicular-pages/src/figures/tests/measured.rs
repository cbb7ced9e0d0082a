//! Figure of docs/validation.md: the measured natural frequencies of its section, beside those of the model.

use crate::figures::axis::ChartAxis;
use crate::figures::chart::{Chart, Entry, Layer, Panel, Sample};
use crate::figures::drawing::{BLACK, Stroke};
use crate::figures::style::{BLUE, GREEN, GREY, Symbol, SymbolShape, VERMILION};
use crate::figures::{Figure, FigureContent, Size};
use funicular_study::request::ValidateRequest;
use funicular_validation::Comparison;

/// Highest frequency of the figure [Hz].
const HIGHEST_HZ: f64 = 4.0;

/// Comparisons of measured frequencies with those of the model, one per pose of the robot.
fn measured() -> Vec<Comparison> {
    let request = ValidateRequest { only: vec!["few-cables".to_owned()], ..ValidateRequest::default() };
    let rows = funicular_validation::run(&request).unwrap().sections.into_iter().flat_map(|section| section.rows);
    rows.filter(|row| row.quantity == "measured frequencies [Hz], relative to the model").collect()
}

/// Differences of all measured frequencies from those of the model, over the frequency of the model.
fn figure() -> Figure {
    let rows = measured();
    let edge = 100.0 * rows[0].tolerance;
    let line = |y: f64| vec![(0.0, y), (HIGHEST_HZ, y)];
    let window = Stroke { colour: GREY, width: 0.7, dashes: vec![2.5, 1.8] };
    let mut layers = vec![Layer::Line { points: line(0.0), stroke: Stroke::solid(BLACK, 0.5) }];
    layers.extend([edge, -edge].map(|y| Layer::Line { points: line(y), stroke: window.clone() }));

    let mut legend = Vec::new();
    for (cables, shape, colour) in
        [(2, SymbolShape::Circle, BLUE), (3, SymbolShape::Square, VERMILION), (4, SymbolShape::Triangle, GREEN)]
    {
        let of_robot = rows.iter().filter(|row| row.case.starts_with(&format!("{cables} cables, ")));
        let pairs = of_robot.flat_map(|row| row.ours.iter().zip(&row.theirs));
        let points = pairs.map(|(ours, theirs)| (*ours, 100.0 * (theirs / ours - 1.0))).collect();
        let symbol = Symbol { shape, colour };
        layers.push(Layer::Symbols { points, symbol });
        legend.push(Entry { text: format!("{cables} cables"), sample: Sample::Symbol(symbol) });
    }
    legend.push(Entry { text: "window of the peaks".to_owned(), sample: Sample::Line(window) });

    let panel = Panel::new(ChartAxis::linear("measured − computed [%]", -8.0, 8.0), 0.5, layers);
    Figure(FigureContent::Chart(Chart {
        title: "Measured natural frequencies of the GRAB prototype".to_owned(),
        x: ChartAxis::linear("computed natural frequency [Hz]", 0.0, HIGHEST_HZ),
        panels: vec![panel],
        legend,
        colour_bar: None,
    }))
}

#[test]
fn the_committed_figure_is_the_generated_one() {
    let generated = figure().svg(Size::new(Some(140.0), None).unwrap());
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/figures/measured.svg");
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(file, &generated).unwrap();
    }
    assert!(
        generated == std::fs::read_to_string(file).unwrap(),
        "docs/figures/measured.svg differs; `UPDATE_DOCS=1 cargo test -p funicular-pages measured` writes it"
    );
}
