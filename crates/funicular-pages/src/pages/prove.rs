//! Page about a proof: what is proved and what is not, the proved set in space, a section with the three sets.

use super::Shell;
use super::figure::robot::proved_in_space;
use super::figure::{PageFigure, axis, colour};
use super::table::{PageTable, significant};
use crate::figures::proved::{SETS, SectionPlane};
use anyhow::Context as _;
use askama::Template;
use funicular_study::analyses::prove::{BoxRow, Proved};
use funicular_study::text::{counted, short, vector};
use serde_json::{Value, json};

const CONTENTS: &[(&str, &str)] = &[("said", "What is proved"), ("sets", "Sets"), ("repeat", "How to repeat")];

#[derive(Template)]
#[template(path = "prove.html")]
struct ProvePage<'a> {
    shell: Shell,
    found: &'a Proved,
    sentences: Vec<String>,
    volumes: PageTable,
    worst: Option<PageTable>,
    surface: Option<PageFigure>,
    section: Option<PageFigure>,
    command_line: String,
}

/// Writes the page as HTML; `command_line` is the command that writes it again.
///
/// # Errors
/// A page that cannot be written.
pub fn page(found: &Proved, command_line: String) -> anyhow::Result<String> {
    let page = ProvePage {
        shell: Shell::new(format!("{}: proof", found.robot), CONTENTS),
        found,
        sentences: sentences(found),
        volumes: volumes(found),
        worst: worst(found),
        surface: surface(found),
        section: section(found),
        command_line,
    };
    page.render().context("the page could not be written as HTML")
}

/// Sentences about what is proved and what is not.
pub(super) fn sentences(found: &Proved) -> Vec<String> {
    let turn = if found.within_deg.iter().any(|of| *of > 0.0) {
        format!(" and with every turn up to ({})° about the axes of the world", vector(&found.within_deg, 3))
    } else {
        String::new()
    };
    let unit = found.volume_unit;
    let mut said = vec![
        format!(
            "Proved inside: at every position{turn}, not only at samples, there are tensions within the limits with \
             which {} cables balance the platform under every required load.",
            found.static_model
        ),
        "Proved outside: at every position there is no such choice of tensions for one of the loads. Undecided: \
         nothing is proved; such a place may be held or not."
            .to_owned(),
        "Not proved: that a rule or a controller chooses these tensions, that lengths or anchors are those of the \
         file, distances between cables, stiffness, motion."
            .to_owned(),
    ];
    if !unit.is_empty() {
        let [low, high] = [found.inside, found.whole - found.outside].map(|of| significant(of, 5));
        said.push(format!("The set has at least {low} {unit} and at most {high} {unit} of the box."));
    }
    said
}

pub(super) fn volumes(found: &Proved) -> PageTable {
    let unit = found.volume_unit;
    let caption = format!("Sets of the box, by {} boxes; the division ended by: {}.", found.tried, found.end);
    let mut table = PageTable::new("table-sets", caption, &["set", "size", "part|%"]);
    let sets = [("inside", found.inside), ("undecided", found.undecided), ("outside", found.outside)];
    for (name, size) in sets {
        let (_, text, _) = SETS.into_iter().find(|(verdict, ..)| *verdict == name).unwrap_or(SETS[0]);
        let part = if found.whole > 0.0 { 100.0 * size / found.whole } else { 0.0 };
        table.row(vec![text.to_owned(), format!("{} {unit}", significant(size, 5)), significant(part, 4)]);
    }
    table
}

fn worst(found: &Proved) -> Option<PageTable> {
    let caption = "Largest undecided boxes. A small margin: the distance from the limits changes its sign there, or is \
                   smaller than the bounds. A sag bound: smaller boxes would not help.";
    (!found.worst.is_empty()).then(|| PageTable::of("table-worst", caption, &BoxRow::columns(), &found.worst))
}

fn surface(found: &Proved) -> Option<PageFigure> {
    (!found.surface.triangles.is_empty()).then(|| proved_in_space(found))
}

/// Section with the three sets; none for a box without an area.
fn section(found: &Proved) -> Option<PageFigure> {
    let plane = SectionPlane::of(found).ok()?;
    let colours = [colour::BLUE, colour::ORANGE, colour::GREY];
    let data = SETS.iter().zip(colours).map(|((verdict, text, _), colour)| {
        let (mut x, mut y): (Vec<Value>, Vec<Value>) = (Vec::new(), Vec::new());
        for [[left, low], [right, high]] in plane.cut(found, verdict) {
            x.extend([left, right, right, left, left].map(Value::from));
            y.extend([low, low, high, high, low].map(Value::from));
            x.push(Value::Null);
            y.push(Value::Null);
        }
        json!({
            "type": "scatter", "mode": "lines", "fill": "toself", "name": text, "x": x, "y": y,
            "line": {"color": colour, "width": 0.5}, "fillcolor": colour, "hoverinfo": "name",
        })
    });
    let [x, y] = plane.titles();
    let layout = json!({"xaxis": axis(&x, json!({})), "yaxis": axis(&y, json!({"scaleanchor": "x"}))});
    let caption = format!("Section {} through the middle of the box.", plane.in_words());
    Some(PageFigure::new("figure-section", 460, caption, &data.collect::<Vec<_>>(), layout))
}

impl ProvePage<'_> {
    fn place(&self) -> String {
        let [position, within] = [&self.found.pose.position_m, &self.found.within_m].map(|of| vector(of, 4));
        format!("Positions within ({within}) m of ({position}) m, {}", counted(self.found.loads, "load"))
    }

    fn margin(&self) -> String {
        let number = |of: f64| format!("{} N", short(of, 4));
        self.found.margin_n.map_or_else(String::new, |margin| format!(", margin {}", number(margin)))
    }
}
